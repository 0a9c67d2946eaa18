"""Families of random points: each a function of a random generator, a dimension and a number."""
import subprocess

import numpy as np

ULP = 2.0 ** -52


def uniform(rng, dim, n):
    return rng.random((n, dim))


def normal(rng, dim, n):
    return rng.normal(size=(n, dim))


def small_grid(rng, dim, n):
    """Random points of a small grid: many are equal, and very many cocircular."""
    side = int(rng.integers(2, max(3, int(2 * n ** (1 / dim)))))
    return rng.integers(0, side, (n, dim)).astype(float)


def whole_grid(rng, dim, n):
    side = max(2, round(n ** (1 / dim)))
    axes = np.meshgrid(*[np.arange(side)] * dim, indexing="ij")
    points = np.stack(axes, -1).reshape(-1, dim).astype(float)
    step = float(rng.choice([1, 0.1, 1 / 3, 2.0 ** -30, 1e-5]))
    return points * step + float(rng.choice([0, 0.1, 1e6]))


def trembling_grid(rng, dim, n):
    """A grid whose points are off their places by a few units in the last place."""
    points = whole_grid(rng, dim, n) + 1
    return points * (1 + ULP * rng.integers(-2, 3, points.shape))


def integer_circle(rng, dim, n):
    """Exactly cocircular (cospherical) integer points, some of them moved by one step."""
    radius = int(rng.choice([25, 65, 325, 1105, 5525]))
    legs = np.arange(-radius, radius + 1)
    other = np.sqrt(radius ** 2 - legs.astype(float) ** 2).round().astype(int)
    legs, other = (a[legs ** 2 + other ** 2 == radius ** 2] for a in (legs, other))
    circle = np.concatenate([np.stack([legs, other], 1), np.stack([legs, -other], 1)])
    a = circle[rng.integers(0, len(circle), n)]
    if dim > 2:
        b = circle[rng.integers(0, len(circle), n)]
        a = np.stack([a[:, 0] * b[:, 0], a[:, 0] * b[:, 1], a[:, 1] * radius], 1)
    moved = rng.random(n) < rng.choice([0, 0.1])
    a = a + np.where(moved[:, None], rng.integers(-1, 2, a.shape), 0)
    return padded(rng, a.astype(float), dim) + rng.integers(-5, 6)


def rounded_circle(rng, dim, n):
    """On a circle or sphere, but for rounding."""
    points = rng.normal(size=(n, dim))
    points /= np.linalg.norm(points, axis=1)[:, None] + 1e-300
    return points * float(rng.choice([1, 1000, 1e-9])) + float(rng.choice([0, 7, 1e5]))


def near_line(rng, dim, n):
    """On a line, but for rounding or a few that lie beside it."""
    direction = rng.integers(-9, 10, dim).astype(float)
    points = rng.random((n, 1)) * direction + float(rng.choice([0, 0.1, 1e4]))
    beside = rng.random(n) < rng.choice([0, 0.05, 0.5])
    return points + np.where(beside[:, None], ULP * rng.integers(-9, 10, points.shape), 0)


def on_line(rng, dim, n):
    """Exactly on a line, with at most a few points beside it."""
    points = rng.integers(-n, n + 1, (n, 1)) * rng.integers(-4, 5, dim)
    beside = rng.integers(0, 4)
    points[:beside] += rng.integers(-3, 4, (len(points[:beside]), dim))
    return points.astype(float)


def near_plane(rng, dim, n):
    """In space: in a plane, exactly or nearly; in the plane on two lines."""
    points = rng.integers(-20, 21, (n, dim)).astype(float)
    if rng.random() < 0.5:
        points = rng.random((n, dim))
    points[:, -1] = points[:, 0] * 2 + 1 if dim > 2 else rng.integers(0, 2, n)
    beside = rng.random(n) < rng.choice([0, 0.02, 0.3])
    points[:, -1] += np.where(beside, ULP * rng.integers(-9, 10, n), 0)
    return points


def on_boundaries(rng, dim, n):
    """Few different values on each axis, so that cuts go through points."""
    points = rng.random((n, dim))
    for axis in range(dim):
        values = rng.random(int(rng.integers(1, 12)))
        shared = rng.random(n) < rng.choice([0.3, 0.9, 1])
        points[:, axis] = np.where(shared, values[rng.integers(0, len(values), n)], points[:, axis])
    return points


def clusters(rng, dim, n):
    centres = rng.random((int(rng.integers(1, 9)), dim)) * 10.0 ** rng.integers(0, 9)
    return centres[rng.integers(0, len(centres), n)] + rng.normal(size=(n, dim))


def huge(rng, dim, n):
    return (2 * rng.random((n, dim)) - 1) * float(rng.choice([1e100, 1e150, 1e200, 1e300, 1.79e308]))


def subnormal(rng, dim, n):
    most = int(rng.choice([4, 30, 1000, 2 ** 40]))
    return rng.integers(-most, most + 1, (n, dim)) * 5e-324


def magnitudes(rng, dim, n):
    """Each coordinate of a magnitude of its own."""
    most = int(rng.choice([3, 30, 300]))
    signs = rng.choice([-1.0, 1.0], (n, dim))
    return signs * rng.random((n, dim)) * 10.0 ** rng.integers(-most, most + 1, (n, dim))


def full_lattice(rng, dim, n):
    """Integers of all 32 bits, with the extreme ones among them."""
    low, high = -2 ** 31, 2 ** 31 - 1
    points = rng.integers(low, high + 1, (n, dim))
    ends = rng.random((n, dim)) < rng.choice([0.02, 0.3])
    return np.where(ends, rng.choice([low, low + 1, -1, 0, 1, high - 1, high], (n, dim)),
                    points).astype(float)


def columns(rng, dim, n):
    """Few places in the plane, and many heights above each."""
    points = rng.random((n, dim))
    places = rng.random((max(3, n // 10), 2))
    points[:, :2] = places[rng.integers(0, len(places), n)]
    return points


def skew_lines(rng, dim, n):
    """Two lines that do not meet: in space as many tetrahedra as pairs of segments."""
    n = min(n, 120) if dim > 2 else n
    t = rng.random(n)
    first = np.arange(n) % 2 == 0
    points = np.zeros((n, dim))
    points[:, 0] = np.where(first, t, 0.5)
    points[:, 1] = np.where(first, 0, t)
    points[:, -1] += np.where(first, 0, 1)
    return points


def one_point(rng, dim, n):
    return np.repeat(rng.random((1, dim)), n, axis=0)


FAMILIES = [uniform, normal, small_grid, whole_grid, trembling_grid, integer_circle, rounded_circle,
            near_line, on_line, near_plane, on_boundaries, clusters, huge, subnormal, magnitudes,
            full_lattice, columns, skew_lines, one_point]
INTEGERS = {"small_grid", "integer_circle", "on_line", "full_lattice"}  # that fit 32 bits

GENERATED = ["uniform", "normal", "bubbles", "ellipsoid", "lines", "lattice", "circle", "clusters",
             "duplicates", "collinear", "coplanar", "utm", "haloes", "terrain", "packing", "scan"]


ONLY_IN_SPACE = {"haloes", "terrain", "packing", "scan"}  # and in the plane


def padded(rng, points, dim):
    """As many coordinates as asked for, the further ones random."""
    more = dim - points.shape[1]
    return np.hstack([points, rng.integers(0, 9, (len(points), more))]) if more > 0 else points[:, :dim]


def generated(rng, command, dim, n, folder):
    """Points of a generator of the command: its name, and an array."""
    names = GENERATED if dim < 4 else [f for f in GENERATED if f not in ONLY_IN_SPACE]
    name = str(rng.choice(names))
    n = min(n, 150) if name == "lines" and dim > 2 else n
    path = f"{folder}/generated.npy"
    seed = [] if name == "lattice" else ["--seed", str(rng.integers(1, 10 ** 6))]
    dimension = [] if name == "terrain" else ["--dim", str(dim)]
    subprocess.run([command, "generate", name, "-n", str(n), *dimension, *seed, "-o", path, "-q"],
                   check=True)
    return name, np.load(path)


def random_points(rng, command, dim, n, folder):
    """The name of a family, or of two that were put together, and points with `dim` coordinates."""
    if rng.random() < 0.3:
        name, points = generated(rng, command, dim, n, folder)
        points = np.ascontiguousarray(points[:, :dim])
    else:
        family = FAMILIES[rng.integers(0, len(FAMILIES))]
        name, points = family.__name__, family(rng, dim, n)
        if rng.random() < 0.1 and name not in ("huge", "magnitudes", "full_lattice"):
            other = FAMILIES[rng.integers(0, len(FAMILIES))]
            points = np.vstack([points, other(rng, dim, max(1, n // 4))])
            name += "+" + other.__name__
    order = rng.integers(0, 4)
    if order == 0:
        points = points[rng.permutation(len(points))]
    elif order == 1:
        points = points[np.lexsort(points.T[::-1])]
    if rng.random() < 0.1:  # some points once more
        points = np.vstack([points, points[rng.integers(0, len(points), max(1, len(points) // 5))]])
    return name, points
