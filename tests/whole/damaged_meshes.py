"""Makes a mesh, damages it, and asks `check` for its verdict, as a file and as a stream."""
import copy
import os
import subprocess
import time

import numpy as np

import families
import mesh_files
import mutations
import oracle
import point_files
import runs
import shrink
from oracle import Failed

FORMATS = ["npy", "ply", "ply-ascii", "obj", "sma"]
IN_SPACE = ["npy", "ply", "ply-ascii"]
OFF_LATTICE = "a vertex is not on the lattice"


class Damaged:
    """Points, and a mesh of them that is damaged; what is done to it follows from the seed."""

    def __init__(self, seed, dim, family, points):
        """`points` is a file of them (point_files.Input)."""
        self.rng = np.random.default_rng([seed, 2])
        self.dim = dim
        self.family = family
        self.points = points
        # npy tells no lattice, so `check` needs the points to prove it.
        known = FORMATS if dim == 2 else IN_SPACE
        self.form = str(self.rng.choice(known if points.scale is None else known[1:]))
        self.mesh = None
        self.mutation = ""

    def make(self, binary):
        """False if there is no mesh of these points."""
        self.points.write(binary, 0)
        done = subprocess.run([binary, "triangulate", self.points.name(0), "-o", "right.npy", "-q", "--dim",
                               str(self.dim), "--leaf-points", "10"], capture_output=True, text=True)
        if done.returncode != 0:
            if runs.NO_SIMPLEX.search(done.stderr):
                return False
            raise Failed(f"triangulate ends with {done.returncode}", done.stderr)
        self.mesh = mesh_files.read_npy("right")
        if self.points.scale is not None:
            self.mesh.lattice = (self.points.scale, self.points.offset)
        times = 2 if self.rng.random() < 0.1 else 1
        for kind in self.rng.choice(len(mutations.MUTATIONS), times):
            if self.mesh.simplices.max(initial=-1) not in range(len(self.mesh.vertices)):
                break  # no simplices, or no such vertex
            mutate = mutations.MUTATIONS[kind]
            mutate(self.rng, self.mesh, self.dim)
            self.mutation += ("+" if self.mutation else "") + mutate.__name__
        return True


def random_points(seed, binary, folder, most):
    rng = np.random.default_rng([seed, 1])
    dim = int(rng.choice([2, 2, 3]))
    largest = min(most, 20000 if dim == 2 else 2000) if rng.random() < 0.03 else 60
    count = int(np.exp(rng.uniform(np.log(4), np.log(largest))))
    family, points = families.random_points(rng, binary, dim, count, folder)
    if dim == 2:
        points = np.hstack([points, rng.integers(0, 9, (len(points), 1))])
    if np.all(points == np.rint(points)) and np.max(np.abs(points)) < 2 ** 31 and rng.random() < 0.7:
        scale = np.full(3, float(rng.choice([1, 0.01, 0.001, 1e-7])))
        offset = rng.choice([0.0, 100, 500000], 3)
        return dim, family, point_files.Input("las", points, scale, offset)
    return dim, family, point_files.Input("npy", points)


class Fault:
    """Why a mesh is not the canonical Delaunay triangulation of its vertices, which it is if `text`
    is empty; `ties`: whether it may be another one, by the ties of cospherical vertices."""

    def __init__(self, text="", ties=False):
        self.text = text
        self.ties = ties


def fault_of(mesh, dim, cgal):
    vertices, simplices = mesh.vertices[:, :dim] + 0.0, mesh.simplices
    if not np.all(np.isfinite(mesh.vertices)):
        return Fault("a coordinate is not finite")
    if mesh.lattice is not None:
        scale, offset = (part[:dim] for part in mesh.lattice)
        whole = np.rint((vertices - offset) / scale) + 0.0
        if not np.array_equal(whole * scale + offset, vertices):
            return Fault(OFF_LATTICE)
        vertices = whole
    if len(simplices) == 0:
        return Fault("no simplices")
    if simplices.min() < 0 or simplices.max() >= len(vertices):
        return Fault("no such vertex")
    if len(np.unique(simplices)) != len(vertices):
        return Fault("a vertex is not used")
    points = np.unique(vertices, axis=0)
    if len(points) != len(vertices):
        return Fault("equal vertices")
    if any(len(set(row)) != dim + 1 for row in simplices.tolist()):
        return Fault("a simplex with a corner twice")
    numbers = oracle.numbers_of(points, vertices)
    if np.any(oracle.orientations(points, numbers[simplices], len(simplices)) < 1):
        return Fault("a wrong orientation")
    found = oracle.sorted_rows(numbers[simplices])
    right = oracle.simplices_of(cgal, points)
    if np.array_equal(found, right):
        return Fault()
    return Fault("other simplices", may_be_ties(points, mesh, numbers, found, right))


def may_be_ties(points, mesh, numbers, found, right):
    """Not if there is another reason: simplices that are missing or there twice alone, or one with
    a point inside of its sphere. Of many simplices only the first are looked at."""
    known = set(map(tuple, right.tolist()))
    strange = [row for row in numbers[mesh.simplices].tolist() if tuple(sorted(row)) not in known]
    if not strange or len(np.unique(found, axis=0)) != len(found):
        return False
    for row in strange[:20]:
        for query in range(min(len(points), 200)):
            if query not in row and oracle.exact_in_sphere(points[row], points[query]) > 0:
                return False
    return bool(np.all(oracle.facets(found)[1] <= 2))


def verdict(binary, arguments, stdin=None):
    """Whether check proves it. All but a proof and a refusal is a finding."""
    done = subprocess.run([binary, "check", *arguments, "-q"], stdin=stdin, capture_output=True,
                          timeout=runs.SECONDS)
    text = (done.stdout + done.stderr).decode(errors="replace")
    if done.returncode not in (0, 1) or (done.returncode == 1 and not text.strip()):
        raise Failed(f"check ends with {done.returncode}", text[-500:])
    return done.returncode == 0, text[-300:]


def expect(right, answer, how, why):
    proved, text = answer
    if proved and not right:
        raise Failed("check accepts a wrong mesh", f"{how}: {why}; it says: {text}")
    if not proved and right:
        raise Failed("check refuses a right mesh", f"{how}: {text}")


def piped(binary, path, *arguments):
    with open(path, "rb") as file, subprocess.Popen(["cat"], stdin=file, stdout=subprocess.PIPE) as cat:
        answer = verdict(binary, ["-", *arguments], cat.stdout)
        cat.stdout.close()
    return answer


def check_all_ways(damaged, binary, cgal):
    """The fault that the mesh has."""
    mesh, form = damaged.mesh, damaged.form
    fault = fault_of(mesh, damaged.dim, cgal)
    right, why = not fault.text, fault.text
    path = mesh_files.write_mesh(mesh, "wrong", form)
    expect(right, verdict(binary, [path, "--mesh-format", form]), f"{form} file", why)
    if not fault.ties:
        expect(right, verdict(binary, [path, "--any-delaunay"]), f"{form} file, any Delaunay", why)
    if form != "npy":
        expect(right, piped(binary, path, "--mesh-format", form), f"{form} stream", why)
    check_streams(damaged, binary, cgal, path, fault)
    check_points(damaged, binary, path, why)
    return why


def check_streams(damaged, binary, cgal, path, fault):
    """As spm and sma. What is not on its lattice is converted without one."""
    if fault.text == OFF_LATTICE and damaged.form != "sma":
        plain = copy.copy(damaged.mesh)
        plain.lattice = None
        fault = fault_of(plain, damaged.dim, cgal)
    right, why = not fault.text, fault.text
    for stream in ["spm", "sma"] if damaged.dim == 2 else ["spm"]:
        done = subprocess.run([binary, "convert", path, "-o", f"stream.{stream}", "-q"],
                              capture_output=True, text=True)
        if done.returncode not in (0, 1) or (done.returncode == 1 and right):
            raise Failed(f"convert ends with {done.returncode}", done.stderr)
        if done.returncode == 0:
            how = f"{stream} of a {damaged.form} file"
            expect(right, verdict(binary, [f"stream.{stream}"]), how, why)
            expect(right, piped(binary, f"stream.{stream}", "--mesh-format", stream), f"piped {how}", why)


def check_points(damaged, binary, path, fault):
    """With --points also the vertices must be those of the input, and heights between theirs."""
    if fault:
        expect(False, verdict(binary, [path, "--points", damaged.points.name(0)]), "with points", fault)
        return
    dim, mesh = damaged.dim, damaged.mesh
    world = damaged.points.world()
    points = np.unique(world[:, :dim] + 0.0, axis=0)
    numbers = oracle.numbers_of(points, mesh.vertices[:, :dim])
    same = len(numbers) == len(points) and np.all(numbers >= 0)
    if same and dim == 2:
        at = oracle.numbers_of(points, world[:, :2])
        lowest, highest = np.full(len(points), np.inf), np.full(len(points), -np.inf)
        np.minimum.at(lowest, at, world[:, 2])
        np.maximum.at(highest, at, world[:, 2])
        z = mesh.vertices[:, 2]
        same = bool(np.all((lowest[numbers] <= z) & (z <= highest[numbers])))
    expect(same, verdict(binary, [path, "--points", damaged.points.name(0)]), "with points", "other points")


def text_of(mesh):
    lines = ["v " + " ".join(repr(float(v)) for v in row) for row in mesh.vertices[:40]]
    lines += ["s " + " ".join(str(int(v)) for v in row) for row in mesh.simplices[:60]]
    return "\n".join("    " + line for line in lines)


def run_damaged(damaged, binary, cgal, folder):
    runs.fresh_folder(folder)
    if not damaged.make(binary):
        return "no mesh to damage"
    fault = check_all_ways(damaged, binary, cgal)
    if os.listdir("scratch"):
        raise Failed("temporary files are left")
    return "wrong meshes refused" if fault else "right meshes proved"


def run(seed, binary, cgal, folder, options):
    """What came of the case; raises Failed, with a small mesh in its text."""
    runs.fresh_folder(folder)
    dim, family, points = random_points(seed, binary, folder, options.most)

    def failure_of(rows):
        damaged = Damaged(seed, dim, family, points.take(rows))
        try:
            return run_damaged(damaged, binary, cgal, folder), None, damaged
        except Failed as failure:
            return "", failure, damaged

    what, failure, _ = failure_of(slice(None))
    if failure is None:
        return what

    def fails(rows):
        other = failure_of(rows)[1]
        return other is not None and other.sort == failure.sort

    rows = shrink.fewer(len(points.points), fails, time.monotonic() + options.shrink)
    _, small, damaged = failure_of(rows)
    small = small or failure
    raise Failed(small.sort, f"{small.text} ({family}, {damaged.mutation}, {damaged.form}; wrong.* and "
                 f"stream.* are the mesh)\n{text_of(damaged.mesh)}")
