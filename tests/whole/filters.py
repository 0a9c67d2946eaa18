"""Filters of points: options of the command, and what they keep by the driver's own reckoning."""
import json
from fractions import Fraction

import numpy as np

from point_files import attributes_of


class Filter:
    """`arguments` of the command; `keep(world, numbers, counts)` gives those of the numbered points
    that are kept, in the order in which they come, of inputs with `counts` records each."""

    def __init__(self, arguments, keep, files=None):
        self.arguments = arguments
        self.keep = keep
        self.files = files or {}  # texts by names, which the command reads


def every(rng, world, exact):
    step = int(rng.integers(2, 5))

    def keep(points, numbers, counts):
        firsts = np.repeat(np.cumsum([0, *counts[:-1]]), counts)
        record = numbers - firsts[numbers]
        return numbers[record % step == 0]

    return Filter(["--every", str(step)], keep)


def two_values(rng, column, exact):
    """A range within a column; its ends are values of points if these are exact."""
    if exact:
        low, high = np.sort(rng.choice(column, 2))
    else:
        low, high = np.sort(rng.uniform(0, 1, 2))
        span = column.max() / 2 - column.min() / 2
        low, high = (column.min() + 2 * (v * span) for v in (low, high))
    return float(low), float(high)


def bounds(rng, world, exact):
    sides = [two_values(rng, world[:, axis], exact) for axis in range(min(3, world.shape[1]))]
    if len(sides) == 2 or rng.random() < 0.5:
        sides = sides[:2]

    def keep(points, numbers, counts):
        inside = np.ones(len(numbers), bool)
        for axis, (low, high) in enumerate(sides):
            inside &= (points[numbers, axis] >= low) & (points[numbers, axis] <= high)
        return numbers[inside]

    box = [repr(side[0]) for side in sides] + [repr(side[1]) for side in sides]
    return Filter([f"--bounds={','.join(box)}"], keep)


def z_range(rng, world, exact):
    low, high = two_values(rng, world[:, 2], exact)

    def keep(points, numbers, counts):
        z = points[numbers, 2]
        return numbers[(z >= low) & (z <= high)]

    return Filter([f"--z-range={low!r},{high!r}"], keep)


def where(rng, world, exact):
    first, _ = two_values(rng, world[:, 0], exact)
    second, _ = two_values(rng, world[:, 1], exact)
    kind = rng.integers(0, 3)
    text = [f"x >= {first!r}", f"x > {first!r} or y < {second!r}",
            f"not (x < {first!r} and y <= {second!r})"][kind]

    def keep(points, numbers, counts):
        x, y = points[numbers, 0], points[numbers, 1]
        return numbers[[x >= first, (x > first) | (y < second),
                        ~((x < first) & (y <= second))][kind]]

    return Filter(["--where", text], keep)


def classes(rng, world, exact):
    first, second = (int(one) for one in np.sort(rng.choice(7, 2, replace=False)))
    which = str(rng.choice(["--keep-class", "--drop-class"]))

    def keep(points, numbers, counts):
        of_points, _, _ = attributes_of(points[numbers])
        within = (of_points >= first) & (of_points <= second)
        return numbers[within if which == "--keep-class" else ~within]

    return Filter([which, f"{first}-{second}"], keep)


def returns(rng, world, exact):
    which = str(rng.choice(["first", "last", "single", "2", "1,3"]))

    def keep(points, numbers, counts):
        _, number, of_pulse = attributes_of(points[numbers])
        return numbers[{"first": number == 1, "last": number == of_pulse, "single": of_pulse == 1,
                        "2": number == 2, "1,3": number != 2}[which]]

    return Filter(["--returns", which], keep)


def is_left(a, b, points):
    """Whether the points lie to the left of the line from a to b, which goes up, and not on it."""
    edge, way = np.subtract(b, a), points - a
    products = edge[0] * way[:, 1], edge[1] * way[:, 0]
    value = products[0] - products[1]
    left = value > 0
    for number in np.flatnonzero(np.abs(value) <= 1e-9 * (np.abs(products[0]) + np.abs(products[1]))):
        ax, ay, bx, by, x, y = map(Fraction, map(float, (*a, *b, *points[number])))
        left[number] = (bx - ax) * (y - ay) > (by - ay) * (x - ax)
    return left


def is_within(ring, points):
    """Of a point on an edge: whether what is east of that is within, or north of a level one."""
    within = np.zeros(len(points), bool)
    for a, b in zip(ring, np.roll(ring, -1, axis=0)):
        low, high = (a, b) if a[1] < b[1] else (b, a)
        beside = (low[1] <= points[:, 1]) & (points[:, 1] < high[1])
        within[beside] ^= ~is_left(low, high, points[beside])
    return within


def clip(rng, world, exact):
    """A box, or a polygon of three to five corners that may cross itself; its corners have coordinates
    of points if these are exact."""
    sides = [two_values(rng, world[:, axis], exact) for axis in (0, 1)]
    count = int(rng.integers(3, 6))
    if rng.random() < 0.3:
        ring = np.array([[sides[0][i in (1, 2)], sides[1][i > 1]] for i in range(4)])
    elif exact:
        ring = world[rng.integers(0, len(world), count), :2]
    else:
        ring = np.array([[rng.uniform(*side) for side in sides] for _ in range(count)])
    outside = bool(rng.random() < 0.3)

    def keep(points, numbers, counts):
        return numbers[is_within(ring, points[numbers, :2]) != outside]

    # GeoJSON is of longitude and latitude, unless that is overruled.
    rows = [[float(v) for v in corner] for corner in [*ring, ring[0]]]
    text = json.dumps({"type": "Polygon", "coordinates": [rows]})
    return Filter(["--clip", "clip.geojson", "--force-crs"] + ["--clip-outside"] * outside, keep,
                  {"clip.geojson": text})


def thin(rng, world, exact):
    """Cells whose sides are powers of two, so that their numbers are exact."""
    span = max(float(np.max(np.abs(world[:, :2]))), 1e-300)
    side = 2.0 ** (np.floor(np.log2(span)) - int(rng.integers(0, 8)))
    which = str(rng.choice(["first", "lowest", "highest"])) if world.shape[1] > 2 else "first"
    axes = 2

    def keep(points, numbers, counts):
        cells = {}
        for number in numbers:
            cell = tuple(np.floor(points[number, :axes] / side))
            best = cells.get(cell)
            if best is None:
                cells[cell] = number
            elif which != "first":
                z, other = points[number, 2], points[best, 2]
                if (z < other) if which == "lowest" else (z > other):
                    cells[cell] = number
        return np.array(list(cells.values()), dtype=np.int64)

    return Filter(["--thin", f"{side!r}:{which}"], keep)


def random_filters(rng, world, dim, exact, attributes, polygons):
    """In the order in which the command applies them. `exact`: bounds may be those of points;
    `attributes`: points have classes and returns; `polygons`: the command can read them."""
    if len(world) < 2 or rng.random() < 0.7:
        return []
    known = [every, where, bounds]
    if attributes:
        known += [classes, returns]
    if world.shape[1] > 2:
        known.append(z_range)
    if polygons and np.max(np.abs(world)) < 1e15:
        known.append(clip)
    if dim == 2 and np.all(np.isfinite(world)) and np.max(np.abs(world)) < 1e12:
        known.append(thin)
    chosen = [make(rng, world, exact) for make in known if rng.random() < 1.3 / len(known)]
    # Ranges of height without a common one are wrong usage.
    boxes = [one for one in chosen if one.arguments[0].count(",") == 5]
    return [one for one in chosen if not boxes or not one.arguments[0].startswith("--z-range")]


def kept(filters, world, counts):
    """Numbers of the points that all filters keep, in the order in which the command has them."""
    numbers = np.arange(len(world))
    for one in filters:
        numbers = one.keep(world, numbers, counts)
    return numbers
