"""What is right: CGAL's simplices of points, and orientations in exact arithmetic."""
import itertools
import subprocess

import numpy as np


class Failed(Exception):
    """A finding. `sort` stays the same while a case is shrunk."""

    def __init__(self, sort, text=""):
        super().__init__(f"{sort}: {text}" if text else sort)
        self.sort = sort
        self.text = text


def sorted_rows(rows):
    rows = np.sort(rows, axis=1)
    return rows[np.lexsort(rows.T[::-1])]


def simplices_of(cgal, points):
    """Rows of sorted numbers of points, which are distinct; the rows sorted."""
    dim = points.shape[1]
    done = subprocess.run([cgal, str(dim)], input=np.ascontiguousarray(points).tobytes(),
                          capture_output=True, timeout=300)
    if done.returncode != 0:
        raise RuntimeError(f"cgal_mesh ended with {done.returncode}: {done.stderr.decode()}")
    return np.frombuffer(done.stdout, dtype=np.uint32).reshape(-1, dim + 1).astype(np.int64)


def determinant(rows):
    if len(rows) == 1:
        return rows[0][0]
    return sum((-1) ** i * row[0] * determinant([r[1:] for j, r in enumerate(rows) if j != i])
               for i, row in enumerate(rows) if row[0])


def exact(points):
    """Whole numbers in place of doubles: all times one power of two."""
    ratios = [[float(v).as_integer_ratio() for v in point] for point in points]
    unit = max(below for point in ratios for _, below in point)
    return [[above * (unit // below) for above, below in point] for point in ratios]


def exact_orientation(corners):
    first, *others = exact(corners)
    value = determinant([[a - b for a, b in zip(corner, first)] for corner in others])
    return (value > 0) - (value < 0)


def orientations(points, simplices, most_exact=2000):
    """+1, 0 or -1 of each simplex; those that doubles do not tell are reckoned exactly, and all
    beyond `most_exact` of these are taken for positive."""
    corners = points[simplices]
    with np.errstate(all="ignore"):
        edges = corners[:, 1:] - corners[:, :1]
        lengths = np.abs(edges).max(axis=2)
        usual = (lengths.min(axis=1) > 1e-60) & (lengths.max(axis=1) < 1e60)
        value = np.zeros(len(corners))
        value[usual] = np.linalg.det(edges[usual] / lengths[usual][:, :, None])
        sure = np.abs(value) > 1e-10
    signs = np.where(sure, np.sign(value), 1).astype(int)
    for number in np.flatnonzero(~sure)[:most_exact]:
        signs[number] = exact_orientation(corners[number])
    return signs


def exact_in_sphere(corners, query):
    """Greater than 0 if the query is inside of the sphere of a positively oriented simplex."""
    *corners, origin = exact([*corners, query])
    rows = []
    for corner in corners:
        row = [a - b for a, b in zip(corner, origin)]
        rows.append(row + [sum(v * v for v in row)])
    value = determinant(rows)
    return value if len(origin) % 2 == 0 else -value


def facets(simplices):
    """Each facet's sorted corners, and how many simplices have it."""
    count = simplices.shape[1]
    rows = np.vstack([np.delete(simplices, corner, axis=1) for corner in range(count)])
    return np.unique(np.sort(rows, axis=1), axis=0, return_counts=True)


def numbers_of(points, vertices):
    """The number among `points`, which are distinct, of each vertex; -1 of those that are none."""
    both = np.vstack([points, vertices]) + 0.0
    _, inverse = np.unique(both, axis=0, return_inverse=True)
    inverse = inverse.reshape(-1)
    number = np.full(inverse.max() + 1 if len(inverse) else 0, -1)
    number[inverse[:len(points)]] = np.arange(len(points))
    return number[inverse[len(points):]]


def described(points, simplex):
    return " ".join("(" + ", ".join(repr(float(v)) for v in points[corner]) + ")"
                    for corner in simplex)


def compare_sets(points, expected, found):
    """Both are rows of sorted numbers of points."""
    if expected.shape == found.shape and np.array_equal(expected, found):
        return
    wanted = set(map(tuple, expected.tolist()))
    got = set(map(tuple, found.tolist()))
    missing, more = sorted(wanted - got), sorted(got - wanted)
    text = f"{len(missing)} missing, {len(more)} too many, {len(found)} of {len(expected)}"
    for what, rows in (("missing", missing), ("too many", more)):
        for row in itertools.islice(rows, 2):
            text += f"; {what}: {described(points, row)}"
    raise Failed("another set of simplices", text)
