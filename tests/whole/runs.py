"""Runs a case, and compares what it made with CGAL and with the driver's own reckoning."""
import json
import os
import re
import shlex
import shutil
import subprocess

import numpy as np

import filters
import mesh_files
import oracle
from oracle import Failed

MPIRUN = ["mpirun", "--oversubscribe", "--bind-to", "none"]
SECONDS = 120

# Errors that are right for points without a simplex.
NO_SIMPLEX = re.compile(r"the filters leave no points|the input has (no|only \d+ distinct) points?|"
                        r"lie (on one line|in one plane|in one space of fewer dimensions)")


class Outcome:
    def __init__(self, what):
        self.what = what


def fresh_folder(folder):
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(f"{folder}/out")
    os.makedirs(f"{folder}/scratch")
    os.chdir(folder)


def command_of(case, binary):
    """The arguments of the run, in its folder."""
    names = ["-"] if case.pipe_in else [one.name(i) for i, one in enumerate(case.inputs)]
    arguments = [*(MPIRUN + ["-n", str(case.ranks)] if case.ranks else []), binary, "triangulate",
                 *names, "-o", "-" if case.pipe_out else f"out/mesh.{mesh_files.end_of(case.form)}",
                 "--output-format", case.form, "--dim", str(case.dim), "--scratch-folder", "scratch",
                 "--progress", "none"]
    if not case.pipe_out:
        arguments += ["--stats", "out/stats.json"]
    if case.pipe_in and case.inputs[0].form in ("text", "csv", "text-gz"):
        arguments += ["--input-format", "text"]
    for one in case.filters:
        arguments += one.arguments
    for option in case.options:
        arguments += option
    return arguments


def shown(case, binary):
    """The command as a line of the shell."""
    line = shlex.join(command_of(case, binary))
    if case.pipe_in:
        line = f"cat {case.inputs[0].name(0)} | {line}"
    return line + (f" > out/mesh.{mesh_files.end_of(case.form)}" if case.pipe_out else "")


def call(arguments, case):
    stdin = subprocess.DEVNULL
    feeder = None
    if case.pipe_in:
        feeder = subprocess.Popen(["cat", case.inputs[0].name(0)], stdout=subprocess.PIPE,
                                  stderr=subprocess.DEVNULL)
        stdin = feeder.stdout
    environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    if not case.ranks:
        environment["TMPDIR"] = os.path.abspath("scratch")
    try:
        done = subprocess.run(arguments, stdin=stdin, capture_output=True, timeout=SECONDS,
                              env=environment)
    except subprocess.TimeoutExpired:
        raise Failed("no end", f"after {SECONDS} seconds") from None
    finally:
        if feeder:
            feeder.stdout.close()
            feeder.kill()
            feeder.wait()
    return done


class Expected:
    """What the mesh of a case must be."""

    def __init__(self, case, cgal):
        world = np.vstack([one.world() for one in case.inputs])
        counts = [len(one.points) for one in case.inputs]
        self.kept = filters.kept(case.filters, world, counts)
        self.records = len(world)
        self.world = world[self.kept] + 0.0
        self.lattice = self.common_lattice(case)
        self.keys = self.key(self.world)[:, :case.dim]
        if len(self.keys) == 0:
            self.points = self.keys
            self.simplices = np.zeros((0, case.dim + 1), np.int64)
            return
        self.points, self.first, self.inverse = np.unique(
            self.keys, axis=0, return_index=True, return_inverse=True)
        self.inverse = self.inverse.reshape(-1)
        self.simplices = oracle.simplices_of(cgal, self.points)

    @staticmethod
    def common_lattice(case):
        """Scale and offset, if all inputs are on one lattice."""
        if any(one.scale is None for one in case.inputs):
            return None
        return case.inputs[0].scale, np.min([one.offset for one in case.inputs], axis=0)

    def key(self, world):
        """Numbers that are triangulated: integers if there is a lattice."""
        if self.lattice is None:
            return world + 0.0
        scale, offset = self.lattice
        return np.rint((world - offset) / scale) + 0.0


def check_clean(case):
    left = os.listdir("scratch")
    if left:
        raise Failed("temporary files are left", ", ".join(left))
    unfinished = [name for name in os.listdir("out") if name.endswith((".part", ".resume"))]
    if unfinished:
        raise Failed("unfinished files are left", ", ".join(unfinished))


def check_error(case, expected, done):
    """The outcome of a run that ended with an error, if that is a right one."""
    message = done.stderr.decode(errors="replace").strip()
    code = done.returncode
    if code < 0 or (code > 2 and not case.ranks) or code == 2:
        raise Failed(f"exit code {code}", message[-600:])
    if "spillway: error: " not in message:
        raise Failed("an error without a message", f"exit code {code}: {message[-600:]}")
    meshes = [name for name in os.listdir("out")]
    if meshes:
        raise Failed("a failed run has left an output", ", ".join(meshes))
    if NO_SIMPLEX.search(message):
        if len(expected.simplices):
            raise Failed("refused points that have a triangulation", message[-600:])
        return Outcome("no simplex")
    raise Failed("an error that is not expected", message[-600:])


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
    with open("out/stats.json", encoding="utf-8") as file:
        stats = json.load(file)
    wanted = {"points": len(expected.kept), "vertices": len(expected.points),
              "duplicates": len(expected.kept) - len(expected.points),
              "simplices": len(expected.simplices), "dimension": case.dim,
              "on_lattice": expected.lattice is not None}
    for key, value in wanted.items():
        if stats[key] != value:
            raise Failed(f"--stats has another {key}", f"{stats[key]}, not {value}")


def check_proof(case, binary, path):
    if case.pipe_in or not case.proves:
        return
    arguments = [binary, "check", path, "-q", "--mesh-format", case.form, "--points",
                 *[one.name(i) for i, one in enumerate(case.inputs)]]
    for one in case.filters:
        arguments += one.arguments
    if case.dim < 3 and case.form == "spm" and not case.filters:
        arguments = arguments[:arguments.index("--points")]
    done = subprocess.run(arguments, capture_output=True, timeout=SECONDS)
    if done.returncode != 0:
        text = done.stdout + done.stderr
        raise Failed("check refuses a right mesh",
                     f"exit code {done.returncode}: {text.decode(errors='replace')[-600:]}")


def run_case(case, binary, cgal, folder):
    """Raises Failed if the run does not do what it should."""
    fresh_folder(folder)
    case = case.copy()
    case.inputs = [one.take(slice(None)) for one in case.inputs]
    for number, one in enumerate(case.inputs):
        one.write(binary, number)
    expected = Expected(case, cgal)
    done = call(command_of(case, binary), case)
    check_clean(case)
    if done.returncode != 0:
        return check_error(case, expected, done)
    path = f"out/mesh.{mesh_files.end_of(case.form)}"
    if case.pipe_out:
        with open(path, "wb") as file:
            file.write(done.stdout)
    if not len(expected.simplices):
        raise Failed("a mesh of points without simplices")
    mesh = mesh_files.read_mesh(binary, path, case.form, case.dim)
    numbers = check_vertices(case, expected, mesh)
    oracle.compare_sets(expected.points, expected.simplices, oracle.sorted_rows(numbers[mesh.simplices]))
    signs = oracle.orientations(expected.points, numbers[mesh.simplices])
    if np.any(signs <= 0):
        raise Failed("a simplex that is not positively oriented")
    check_heights(case, expected, mesh, numbers)
    check_index(case, expected, mesh, numbers)
    if not case.pipe_out:
        check_stats(case, expected)
    check_proof(case, binary, path)
    return Outcome("the same")
