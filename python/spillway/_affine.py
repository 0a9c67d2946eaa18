"""Arrays of a triangulation that SciPy has for its own queries."""

from __future__ import annotations

import numpy as np

from ._arrays import Floats

_LEAST_CONDITION = 1000 * np.finfo(float).eps


def barycentric_transform(corners: Floats) -> Floats:
    """For each simplex the inverse of its edges from the last vertex, and that vertex.

    Where the inverse would be all rounding error, it is not a number, as in SciPy.
    Shapes: corners (m, D+1, D), result (m, D+1, D).
    """
    last = corners[:, -1]
    with np.errstate(all="ignore"):
        edges = corners[:, :-1] - last[:, None]
        size = np.abs(edges).max(axis=(1, 2))
        inverse = _inverse(np.swapaxes(edges / size[:, None, None], 1, 2))
        condition = _one_norm(inverse) * _one_norm(np.swapaxes(edges, 1, 2)) / size
        inverse /= size[:, None, None]
    inverse[~(condition * _LEAST_CONDITION <= 1)] = np.nan
    transform = np.empty(corners.shape)
    transform[:, :-1] = inverse
    transform[:, -1] = last
    return transform


def lifted_planes(corners: Floats, centres: Floats) -> Floats:
    """The hyperplanes of the simplices on the paraboloid z = |x|^2, as downward unit normals and
    offsets.

    That of a simplex with circumcentre c is z = 2 c x - (2 c v - |v|^2), for each vertex v.
    Shapes: corners (m, D+1, D), centres (m, D), result (m, D+2).
    """
    vertex = corners[:, 0]
    with np.errstate(all="ignore"):
        offset = (vertex * vertex).sum(axis=1) - 2 * (centres * vertex).sum(axis=1)
        planes = np.column_stack([2 * centres, np.full(len(centres), -1.0), offset])
        units: Floats = planes / np.linalg.norm(planes[:, :-1], axis=1)[:, None]
    return units


def _inverse(matrices: Floats) -> Floats:
    if matrices.shape[1] == 2:
        (a, b), (c, d) = np.moveaxis(matrices, 0, -1)
        rows = np.array([[d, -b], [-c, a]]) / (a * d - b * c)
        return np.moveaxis(rows, -1, 0)
    if matrices.shape[1] > 3:
        return _general_inverse(matrices)
    a, b, c = np.moveaxis(matrices, 2, 0)
    rows = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=1)
    inverse: Floats = rows / (a * rows[:, 0]).sum(axis=1)[:, None, None]
    return inverse


def _general_inverse(matrices: Floats) -> Floats:
    """By elimination; not a number where a matrix is singular."""
    inverse = np.full(matrices.shape, np.nan)
    determinant = np.linalg.det(matrices)
    regular = np.isfinite(determinant) & (determinant != 0)
    inverse[regular] = np.linalg.inv(matrices[regular])
    return inverse


def _one_norm(matrices: Floats) -> Floats:
    norm: Floats = np.abs(matrices).sum(axis=1).max(axis=1)
    return norm
