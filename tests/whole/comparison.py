"""Compares a mesh, and what was told of it, with what is expected."""
import json
import subprocess

import numpy as np

import oracle
from oracle import Failed


def check_vertices(case, expected, mesh):
    """The number of the point of each vertex."""
    dim = case.dim
    if case.dim > 3:
        keys = mesh.vertices[:, :dim]
    else:
        keys = expected.key(mesh.vertices)[:, :dim]
        one_offset = len({tuple(one.offset) for one in case.inputs}) == 1 if expected.lattice else True
        if expected.lattice and one_offset:
            scale, offset = expected.lattice
            if not np.array_equal((keys * scale[:dim] + offset[:dim]), mesh.vertices[:, :dim]):
                raise Failed("a vertex that is not the image of integers")
    numbers = oracle.numbers_of(expected.points, keys)
    if np.any(numbers < 0):
        raise Failed("a vertex that is no point", str(mesh.vertices[np.argmin(numbers)]))
    if len(numbers) != len(expected.points) or len(np.unique(numbers)) != len(numbers):
        raise Failed("vertices are not the distinct points",
                     f"{len(numbers)} vertices, {len(np.unique(numbers))} of them distinct, "
                     f"{len(expected.points)} distinct points")
    return numbers


def check_heights(case, expected, mesh, numbers):
    if case.dim != 2:
        return
    count = len(expected.points)
    given = expected.world[:, 2] if expected.world.shape[1] > 2 else np.zeros(len(expected.world))
    found = np.empty(count)
    found[numbers] = mesh.vertices[:, 2]
    lowest, highest = np.full(count, np.inf), np.full(count, -np.inf)
    np.minimum.at(lowest, expected.inverse, given)
    np.maximum.at(highest, expected.inverse, given)
    rule = (case.option("--heights") or ["", "first"])[1]
    wanted = {"first": given[expected.first], "lowest": lowest, "highest": highest}.get(rule)
    # Offsets of a common lattice may round in another way.
    slack = 1e-9 * (1 + np.abs(highest)) if expected.lattice else np.zeros(count)
    if wanted is None:
        wrong = (found < lowest - slack) | (found > highest + slack)
    else:
        wrong = np.abs(found - wanted) > slack
    if np.any(wrong):
        i = int(np.argmax(wrong))
        raise Failed("a wrong height", f"{found[i]!r} at {expected.points[i]}, of {lowest[i]!r} to "
                     f"{highest[i]!r}, rule {rule}")


def check_index(case, expected, mesh, numbers):
    if case.option("--id") is None:
        return
    if mesh.index is None:
        raise Failed("no input index")
    index = mesh.index.astype(np.int64)
    place = np.full(expected.records, -1)
    place[expected.kept] = np.arange(len(expected.kept))
    if np.any((index < 0) | (index >= expected.records)) or np.any(place[index] < 0):
        raise Failed("an input index of no kept point")
    rows = place[index]
    if not np.array_equal(expected.inverse[rows], numbers):
        raise Failed("an input index of another point")
    rule = (case.option("--heights") or ["", "first"])[1]
    if rule == "first" and not np.array_equal(rows, expected.first[numbers]):
        raise Failed("an input index that is not that of the first of equal points")


def check_stats(case, expected):
    """Which ways the run went, for the driver's summary."""
    with open("out/stats.json", encoding="utf-8") as file:
        stats = json.load(file)
    wanted = {"points": len(expected.kept), "vertices": len(expected.points),
              "duplicates": len(expected.kept) - len(expected.points),
              "simplices": len(expected.simplices), "dimension": case.dim,
              "left_out": expected.left_out,
              "on_lattice": expected.lattice is not None}
    for key, value in wanted.items():
        if stats[key] != value:
            raise Failed(f"--stats has another {key}", f"{stats[key]}, not {value}")
    told = ["spilled"] if stats["spilled_points"] else []
    if (stats["first_block_read_points"] or 0) < stats["points"]:
        told.append("begun while reading")
    return told


def check_proof(case, binary, path):
    if case.pipe_in or not case.proves or case.option("--max-edge"):
        return
    arguments = [binary, "check", path, "-q", "--mesh-format", case.form, "--points",
                 *[one.name(i) for i, one in enumerate(case.inputs)]]
    for one in case.filters:
        arguments += one.arguments
    if case.dim < 3 and case.form == "spm" and not case.filters:
        arguments = arguments[:arguments.index("--points")]
    done = subprocess.run(arguments, capture_output=True, timeout=120)
    if done.returncode != 0:
        text = done.stdout + done.stderr
        raise Failed("check refuses a right mesh",
                     f"exit code {done.returncode}: {text.decode(errors='replace')[-600:]}")


def check_mesh(case, expected, mesh):
    numbers = check_vertices(case, expected, mesh)
    corners = numbers[mesh.simplices]
    oracle.compare_sets(expected.points, expected.simplices, oracle.sorted_rows(corners))
    if np.any(oracle.orientations(expected.points, corners) <= 0):
        raise Failed("a simplex that is not positively oriented")
    check_heights(case, expected, mesh, numbers)
    check_index(case, expected, mesh, numbers)
