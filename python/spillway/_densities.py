"""How densely points lie: `density`."""

from __future__ import annotations

import operator
import os
import tempfile
from typing import TYPE_CHECKING, Any, Sequence, overload

import numpy as np
from numpy.typing import NDArray

from . import _spillway
from ._arrays import attributes_of
from ._inputs import as_dimension, as_inputs, points_origin
from ._options import (
    PathLike,
    RepeatingOptions,
    as_path,
    as_reals,
    as_word,
    make_run,
    put,
    refuse,
    takes,
)
from ._reports import DensityReport
from .errors import InvalidArgumentError, make_error

if TYPE_CHECKING:
    from typing_extensions import Unpack

_MOST_CELLS = 1_000_000


@overload
def density(
    points: Any,
    path: None = None,
    *,
    dim: int = 2,
    weight: str | None = None,
    grid: Sequence[int] | None = None,
    grid_box: Any = None,
    **options: Unpack[RepeatingOptions],
) -> NDArray[Any]:
    ...


@overload
def density(
    points: Any,
    path: PathLike,
    *,
    dim: int = 2,
    weight: str | None = None,
    grid: Sequence[int] | None = None,
    grid_box: Any = None,
    **options: Unpack[RepeatingOptions],
) -> DensityReport:
    ...


@takes(RepeatingOptions)
def density(
    points: Any,
    path: PathLike | None = None,
    *,
    dim: int = 2,
    weight: str | None = None,
    grid: Sequence[int] | None = None,
    grid_box: Any = None,
    **options: Unpack[RepeatingOptions],
) -> NDArray[Any] | DensityReport:
    """Tell how densely points lie: by area in the plane, by volume in space.

    As ``spillway density``: the Delaunay tessellation field estimator. At a vertex the density is
    (dim + 1) times its mass over the volume of the simplices around it; in between it is linear.
    `max_edge`, `heights` and `resume` have no effect on densities, and are errors.

    Parameters
    ----------
    points : path, sequence of paths, or array_like of shape (n, 2) or (n, 3)
        Points, as `triangulate` takes them.
    path : path, optional
        Of vertices a table (``.npy``), or a mesh whose vertices carry `density` (``.vtu``,
        ``.spm``, ``.ply``); of a grid ``.npy``, or in the plane ``.tif``. By default an array is
        returned.
    dim : {2, 3}, optional
        2: points by area, of x and y. 3: by volume.
    weight : str, optional
        What points carry that is their mass. By default each has 1.
    grid : sequence of int, optional
        Interpolate at the centers of so many cells along each axis, as ``(256, 256)``.
    grid_box : box, optional
        Where the grid lies: xmin, ymin, xmax, ymax or xmin, ymin, zmin, xmax, ymax, zmax, or these
        two corners. By default the periodic box, along open axes the box of the points.
    {options}

    Returns
    -------
    ndarray or DensityReport
        Without `path` of vertices a structured array with the fields x, y, where there are heights
        or three dimensions z, and density; of a grid float64 with its shape, x first, not a number
        outside of the hull. The array comes by way of a ``.npy`` file in a temporary folder in
        `scratch_folder`, and lies beyond what `memory` and `max_tmp` limit. With `path` the mass,
        which is the integral of the density, the volume, the least and the most density at a
        vertex, and what the run was like.

    Raises
    ------
    spillway.Error
        As `triangulate`; ``"invalid argument"`` for a weight that the points do not carry.

    Examples
    --------
    >>> import numpy as np, spillway
    >>> points = np.random.default_rng(1).random((1000, 2))
    >>> cells = spillway.density(points, periodic=1, grid=(100, 100))
    >>> cells.shape
    (100, 100)
    """
    refused = ["max_edge", "heights", "resume"]
    refuse(options, refused, "on densities, which all simplices around a point make")
    source = as_inputs(points, "points")
    carried = attributes_of(points, "points")
    dim = as_dimension(dim, source, most=3, name="points")
    how = _spillway.DensityOptions()
    how.weight = as_word(weight, "weight")
    if grid is None:
        refuse({"grid_box": grid_box}, ["grid_box"], "without grid")
    else:
        put(how, "grid", grid, lambda made, cells: _put_cells(made, cells, dim))
    if grid_box is not None:
        put(how, "grid_box", grid_box, lambda made, box: _put_box(made, box, dim))
    origin = points_origin(source, dim, options, False, carried)
    run = make_run(options)
    if path is not None:
        return DensityReport(**_spillway.density(run, origin, as_path(path, "path"), how))
    with _temporary_folder(options.get("scratch_folder")) as folder:
        made = os.path.join(folder, "density.npy")
        _spillway.density(run, origin, as_path(made, "path"), how)
        values: NDArray[Any] = np.load(made)
    return values


def _temporary_folder(parent: PathLike | None) -> tempfile.TemporaryDirectory[str]:
    place = None if parent is None else os.fsdecode(parent)
    try:
        return tempfile.TemporaryDirectory(prefix="spillway-", dir=place)
    except OSError as fault:
        text = f"cannot create a temporary folder in {place or '$TMPDIR'}: {fault.strerror}"
        raise make_error(
            "input or output", text, place or "", system_error=fault.errno or 0
        ) from fault


def _put_cells(target: _spillway.DensityOptions, grid: Any, dim: int) -> None:
    cells = [operator.index(count) for count in np.atleast_1d(grid)]
    if len(cells) != dim:
        raise InvalidArgumentError(f"grid has {len(cells)} axes, and the densities {dim}")
    if not all(1 <= count <= _MOST_CELLS for count in cells):
        raise InvalidArgumentError(
            f"grid is {grid!r}; give its cells along each axis, from 1 to {_MOST_CELLS}"
        )
    target.cells = cells + [0] * (3 - dim)


def _put_box(target: _spillway.DensityOptions, box: Any, dim: int) -> None:
    sides = as_reals(np.ravel(box))
    if len(sides) != 2 * dim:
        raise InvalidArgumentError(
            f"grid_box has {len(sides)} numbers; give the {dim} least coordinates and the {dim} "
            "most"
        )
    low, high = sides[:dim], sides[dim:]
    if not (np.isfinite(sides).all() and all(least < most for least, most in zip(low, high))):
        raise InvalidArgumentError(f"grid_box is {box!r}, which has no length along some axis")
    rest = [0.0] * (3 - dim)
    target.set_grid_box(low + rest, high + rest)
