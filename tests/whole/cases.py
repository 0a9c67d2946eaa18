"""Random cases: files of points, filters, options, ways in and out."""
import functools
import subprocess

import numpy as np

import cut_meshes
import families
import filters
import point_files

FORMATS = ["spm", "spm", "npy", "ply", "ply-ascii", "obj", "off", "vtu", "sma", "landxml"]
IN_SPACE = ["spm", "npy", "ply", "ply-ascii", "vtu"]
OF_MORE = ["spm", "npy"]
NO_PIPE = {"npy"}
SURE_IN_4 = {"uniform", "normal", "bubbles", "utm", "haloes"}  # no ties, which CGAL breaks not


class Case:
    """All that a run depends on. The driver shrinks copies of it."""

    def __init__(self, seed, dim, family):
        self.seed = seed
        self.dim = dim
        self.family = family
        self.inputs = []
        self.filters = []
        self.options = []      # lists of arguments, each of which may be left out
        self.form = "npy"
        self.pipe_in = False
        self.pipe_out = False
        self.ranks = 0         # 0: no mpirun
        self.proves = False    # whether `check` is run, too

    def copy(self):
        other = Case(self.seed, self.dim, self.family)
        other.__dict__.update(self.__dict__)
        other.inputs = list(self.inputs)
        return other

    def points(self):
        return sum(len(one.points) for one in self.inputs)

    def option(self, name):
        return next((option for option in self.options if option[0] == name), None)


def log_uniform(rng, low, high):
    return int(round(np.exp(rng.uniform(np.log(low), np.log(high + 0.5)))))


def random_size(rng, dim, most):
    largest = {2: most, 3: most / 4, 4: min(most / 40, 60)}[dim]
    if dim == 2 and most >= 500_000 and rng.random() < 0.1:
        return most  # more than 32M hold
    least = 1 if rng.random() < 0.1 else 3 * dim
    return log_uniform(rng, least, largest if rng.random() < 0.2 else min(300, largest))


def plain_inputs(rng, dim, points):
    rows = points
    if dim == 2 and rng.random() < 0.7:
        z = rng.random(len(points)) if rng.random() < 0.5 else rng.integers(0, 5, len(points))
        rows = np.hstack([points, z[:, None]])
    known = [f for f in point_files.PLAIN
             if not (rows.shape[1] == 2 and f in ("ply", "ply-ascii", "pcd", "pcd-ascii", "sorted-spp"))
             and not (dim > 3 and f in ("npy-float32", "sorted-spp", "npy-columns"))]
    if np.max(np.abs(rows), initial=0) > 3e38:
        known = [f for f in known if f != "npy-float32"]
    if dim > 3 and len(rows) < 120:  # a part of few rows may look like one point a column
        known = [f for f in known if f not in ("npy", "npy-big")]
    return [point_files.Input(str(rng.choice(known)), part) for part in parts_of(rng, rows)]


def parts_of(rng, rows):
    """One or more parts, by their order or by strips, as files of a survey are."""
    count = int(rng.choice([1, 1, 1, 1, 2, 2, 4, 4, 12])) if len(rows) >= 12 else 1
    if count > 1 and rng.random() < 0.6:
        rows = rows[np.argsort(rows[:, int(rng.integers(0, 2))], kind="stable")]
    return [part for part in np.array_split(rows, count) if len(part)]


def survey_of(rng, rows):
    """Tiles of a survey, from side to side; a few points are in the file of another tile."""
    columns, rows_of_tiles = rng.integers(2, 6, 2)
    tiles = [tile for strip in np.array_split(rows[np.argsort(rows[:, 0], kind="stable")], columns)
             for tile in np.array_split(strip[np.argsort(strip[:, 1], kind="stable")], rows_of_tiles)]
    number = np.repeat(np.arange(len(tiles)), [len(tile) for tile in tiles])
    together = np.vstack(tiles)
    if rng.random() < 0.5:
        moved = rng.random(len(number)) < 0.03
        number = np.where(moved, rng.integers(0, len(tiles), len(number)), number)
    parts = [together[number == tile] for tile in rng.permutation(len(tiles))]
    return [part for part in parts if len(part)]


def lattice_inputs(rng, dim, points, forms=tuple(point_files.LATTICE)):
    """Integers of 32 bits, in files of one lattice."""
    rows = points
    if dim == 2:
        rows = np.hstack([points, rng.integers(-5, 50, (len(points), 1))])
    scale = np.full(3, float(rng.choice([1, 0.01, 0.001, 0.25, 1e-7])))
    offset = np.floor(rng.choice([0, 0, 100, 500000], 3)).astype(float)
    whole = np.max(np.abs(rows), initial=0) < 2 ** 30
    files = []
    survey = len(rows) >= 60 and rng.random() < 0.5
    for part in survey_of(rng, rows) if survey else parts_of(rng, rows):
        steps = rng.integers(-4, 5, 3) * 100 if whole and rng.random() < 0.2 else np.zeros(3)
        # Whole units: the same lattice, from another offset.
        units = steps * (1 if scale[0] >= 0.001 else 0)
        inner = part - np.rint(units / scale)
        if np.max(np.abs(inner), initial=0) >= 2 ** 31 - 1:
            units, inner = np.zeros(3), part
        files.append(point_files.Input(str(rng.choice(forms)), inner, scale,
                                       offset + units, bool(rng.random() < 0.05)))
    return files


def large_survey(rng, dim, most):
    """Files that tell their boxes, so many that tiles are complete before all have been read."""
    n = log_uniform(rng, 1000, max(1000, min(most, 3000 if dim == 3 else 30000)))
    side = float(rng.choice([30, 1000, 2 ** 30]))
    points = np.rint((2 * rng.random((n, dim)) - 1) * side)
    if rng.random() < 0.3:
        points = np.rint(rng.normal(size=(n, dim)) * side / 6)
    return "survey", points, lattice_inputs(rng, dim, points, SURVEY_FORMS)


def random_inputs(rng, case, points):
    name = case.family.split("+")[0]
    integers = np.all(points == np.rint(points)) and np.max(np.abs(points), initial=0) < 2 ** 31
    if case.dim < 4 and integers and (name in families.INTEGERS or rng.random() < 0.5):
        inputs = lattice_inputs(rng, case.dim, points)
        if rng.random() < 0.2:  # one file of doubles, so there is no common lattice
            which = int(rng.integers(0, len(inputs)))
            inputs[which] = point_files.Input("npy", inputs[which].world())
        return inputs
    return plain_inputs(rng, case.dim, points)


def random_options(rng, case):
    n = max(1, case.points())
    chosen = []

    def maybe(share, *arguments):
        if rng.random() < share:
            chosen.append([str(argument) for argument in arguments])

    maybe(0.7, "--leaf-points", log_uniform(rng, 1, n))
    survey = len(case.inputs) > 4  # whose tiles may be triangulated while points are read
    most = max(1, n // 20 if survey else 2 * n)
    maybe(0.9 if survey else 0.7, "--tile-points", log_uniform(rng, min(most, max(1, n // 100)), most))
    if not case.ranks or rng.random() < 0.3:
        maybe(0.6, "--threads", rng.integers(1, 5))
    maybe(0.3, "--children", rng.choice([2, 3, 4, 8, 1024]))
    maybe(0.3, "--division", rng.choice(["least-border", "longest", "cycling", "constant"]))
    maybe(0.1, "--kernel", rng.choice(["spillway", "cgal"]) if case.dim < 4 else "spillway")
    maybe(0.2, "--no-trust-headers")
    if case.ranks and not case.pipe_out and case.form in cut_meshes.IN_PARTS:
        maybe(0.4, "--parts")
    elif not (case.ranks or case.pipe_out) and case.dim < 4:
        side = cut_meshes.random_side(rng, case)
        maybe(0.15 if side else 0, "--tiles", side)
    is_tiled = any(option[0] == "--tiles" for option in chosen)
    least = {2: "40M", 3: "112M"} if is_tiled else {2: "32M", 3: "96M", 4: "128M"}
    maybe(0.5 if n < 500_000 else 1, "--memory", least[case.dim])
    if not (case.pipe_in or case.pipe_out or is_tiled):
        maybe(0.1, "--resume", "state", "--checkpoint-every", "0.001")
    if case.form in ("spm", "npy", "ply", "ply-ascii", "vtu"):
        maybe(0.2, "--id")
    extent = max((np.ptp(one.world()[:, :case.dim]) for one in case.inputs), default=0)
    if 1e-100 < extent < 1e100 and not is_tiled:  # which leave out vertices without a simplex
        maybe(0.1, "--max-edge", repr(float(extent * 3 * rng.random() / n ** (1 / case.dim) + 1e-200)))
    if case.dim == 2 and all(one.world().shape[1] > 2 for one in case.inputs):
        maybe(0.3, "--heights", rng.choice(["first", "lowest", "highest", "mean"]))
    return chosen


def random_set(rng, command, folder, dim, most):
    size = random_size(rng, dim, most)
    family, points = families.random_points(rng, command, dim, size, folder)
    if dim == 4 and family not in SURE_IN_4:
        family, points = "normal", rng.normal(size=(min(size, 60), 4))
    if dim == 4:
        points = points[np.sort(rng.permutation(len(points))[:60])]
    return family, points, None


@functools.cache
def reads_polygons(command):
    """Whether the command was built with GDAL."""
    told = subprocess.run([command, "--version"], capture_output=True, text=True, check=True).stdout
    return "without GDAL" not in told


SURVEY_FORMS = ("las", "las", "las", "laz", "copc")


def random_case(seed, command, folder, kind="runs", most=20000):
    rng = np.random.default_rng(seed)
    dim = int(rng.choice([2, 2, 2, 2, 3, 3, 3, 4]))
    if dim < 4 and rng.random() < 0.12:
        family, points, inputs = large_survey(rng, dim, most)
    else:
        family, points, inputs = random_set(rng, command, folder, dim, most)
    case = Case(seed, dim, family)
    case.inputs = inputs or random_inputs(rng, case, points)
    if kind == "ranks":
        case.ranks = int(rng.integers(1, 5))
    world = np.vstack([one.world() for one in case.inputs]) if same_width(case) else None
    offsets = {tuple(one.offset) for one in case.inputs if one.offset is not None}
    if world is not None:
        case.filters = filters.random_filters(rng, world, dim, len(offsets) < 2,
                                              all(one.scale is not None for one in case.inputs),
                                              reads_polygons(command))
    case.form = str(rng.choice({2: FORMATS, 3: IN_SPACE}.get(dim, OF_MORE)))
    lies = any(one.lies and one.form in ("las", "laz") for one in case.inputs)
    if len(case.inputs) == 1 and case.inputs[0].form not in point_files.NOT_PIPED and not lies:
        case.pipe_in = bool(rng.random() < 0.2)
    case.pipe_out = bool(case.form not in NO_PIPE and not lies and rng.random() < 0.2)
    case.options = random_options(rng, case)
    case.proves = bool(rng.random() < 0.4)
    return case


def same_width(case):
    return len({one.world().shape[1] for one in case.inputs}) == 1
