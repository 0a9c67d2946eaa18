"""Heights of points above a triangulated ground: `height`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Iterable, Sequence, overload

import numpy as np
from numpy.typing import NDArray

from . import _spillway
from ._arrays import attributes_of
from ._inputs import as_inputs, check_array, is_mesh
from ._messages import tell
from ._options import (
    PathLike,
    TriangulateOptions,
    as_names,
    as_path,
    make_run,
    mesh_options,
    names_for,
    point_options,
    put,
    put_all,
    put_classes,
    refuse,
    takes,
    triangulate_options,
)
from ._reports import HeightReport
from .errors import InvalidArgumentError

if TYPE_CHECKING:
    from typing_extensions import Unpack


@overload
def height(
    inputs: Any,
    output: None = None,
    *,
    ground: Any = None,
    ground_class: int | Iterable[int] | None = None,
    mesh_format: str | None = None,
    **options: Unpack[TriangulateOptions],
) -> NDArray[np.float64]:
    ...


@overload
def height(
    inputs: Any,
    output: PathLike,
    *,
    ground: Any = None,
    ground_class: int | Iterable[int] | None = None,
    replace_z: bool = False,
    min_height: float | None = None,
    max_height: float | None = None,
    nodata: float | None = None,
    output_format: str | None = None,
    las_version: str | None = None,
    attributes: str | Sequence[str] | None = None,
    force: bool = False,
    mesh_format: str | None = None,
    **options: Unpack[TriangulateOptions],
) -> HeightReport:
    ...


@takes(TriangulateOptions)
def height(
    inputs: Any,
    output: PathLike | None = None,
    *,
    ground: Any = None,
    ground_class: int | Iterable[int] | None = None,
    replace_z: bool = False,
    min_height: float | None = None,
    max_height: float | None = None,
    nodata: float | None = None,
    output_format: str | None = None,
    las_version: str | None = None,
    attributes: str | Sequence[str] | None = None,
    force: bool = False,
    mesh_format: str | None = None,
    **options: Unpack[TriangulateOptions],
) -> NDArray[np.float64] | HeightReport:
    """Measure how high points are above a triangulated ground.

    As ``spillway height``: linear within the triangles of the ground, one of `ground` and
    `ground_class` at least. Filters choose points of `inputs`, and leave the ground as it is.

    Parameters
    ----------
    inputs : path, sequence of paths, or array_like of shape (n, 3)
        Points, as `triangulate` takes them.
    output : path, optional
        A file of points in the format of its extension. By default an array is made.
    ground : path, sequence of paths, or array_like of shape (n, 3), optional
        Other points that are the ground, or one file of a mesh of triangles.
    ground_class : int or sequence of int, optional
        Points of these classes are the ground: of `ground`, or of `inputs`, which are files then.
    replace_z : bool, optional
        Write heights in place of z, not as the attribute ``HeightAboveGround``.
    min_height, max_height : float, optional
        Write points of these heights only.
    nodata : float, optional
        Of a file, the height of points that lie over no triangle; -9999 by default.
    output_format : str, optional
        The format of the output, where the name does not tell.
    las_version : {"1.2", "1.4"}, optional
        Of LAS and LAZ. By default what the points need.
    attributes : str or sequence of str, optional
        Names of the attributes that are written besides, or "all"; an empty sequence for none.
    force : bool, optional
        Replace a file that is an input also by one that holds less than it.
    mesh_format : str, optional
        Format of a ground that is a mesh, where neither first bytes nor name tell.
    {options}

    Returns
    -------
    ndarray or HeightReport
        Without `output` heights, float64 of shape (n,), in the order of the points that are used;
        not a number where a point lies over no triangle. With `output` the report.

    Raises
    ------
    spillway.Error
        As `triangulate`.
    """
    if ground is None and ground_class is None:
        raise InvalidArgumentError("what is the ground? Give ground_class, or ground")
    source = as_inputs(inputs)
    check_array(source, options, keeps=() if ground is None else ("max_expansion",))
    run = make_run(options)
    below = _ground(run, source, ground, ground_class, mesh_format, options)
    which = point_options(options, 0)
    how = _spillway.HeightOptions()
    how.foreign_crs = bool(options.get("force_crs"))
    of_files = {
        "replace_z": replace_z,
        "min_height": min_height,
        "max_height": max_height,
        "nodata": nodata,
        "output_format": output_format,
        "las_version": las_version,
        "attributes": attributes,
        "force": force,
    }
    if output is None:
        refuse(of_files, of_files, "without an output")
        how.nodata = float("nan")
        figures, heights = _spillway.heights_in_memory(run, source, which, below, how)
        _warn_of_no_ground(HeightReport(**figures))
        return heights
    put_all(how, {"replace_z": replace_z, "min_height": min_height})
    put_all(how, {"max_height": max_height, "nodata": nodata})
    written = _spillway.PointFileOptions()
    put_all(written, {"output_format": output_format, "las_version": las_version})
    written.force = bool(force)
    if attributes is not None:
        written.attributes = as_names(attributes, "attributes")
    which.metadata = True
    report = HeightReport(
        **_spillway.heights(
            run,
            source,
            which,
            attributes_of(inputs, "inputs"),
            below,
            how,
            as_path(output, "output"),
            written,
        )
    )
    _warn_of_no_ground(report)
    return report


def _ground(
    run: _spillway.Run,
    source: Any,
    ground: Any,
    ground_class: int | Iterable[int] | None,
    mesh_format: str | None,
    options: Any,
) -> _spillway.MeshOrigin:
    """What the ground comes from."""
    points = source if ground is None else as_inputs(ground, "ground")
    if ground is None and not isinstance(source, list):
        raise InvalidArgumentError("ground_class chooses points of files; of an array give ground")
    of_points = {"ground_class": ground_class}
    joined = {name: options.get(name) for name in ("crs", "force_crs", "max_expansion")}
    if ground is not None and is_mesh(run, points, mesh_format, {}):
        of_points.update(options)
        kept = ("crs", "force_crs", *names_for("points"), *names_for("run"))
        where = "where the ground is a mesh"
        refuse(of_points, [name for name in of_points if name not in kept], where)
        return _spillway.MeshOrigin(points[0], mesh_options(joined, mesh_format))
    how_read = ["skip_invalid", "salvage", "keep_withheld", "skip_broken"]
    if ground is None:
        how_read += ["input_format", "columns"]
    joined.update({name: options.get(name) for name in how_read if options.get(name)})
    which = point_options(joined, 2)
    if ground_class is not None:
        put(which, "ground_class", ground_class, put_classes)
    carried = {} if ground is None else attributes_of(ground, "ground")
    return _spillway.MeshOrigin(points, which, triangulate_options(options, 2), carried)


def _warn_of_no_ground(report: HeightReport) -> None:
    if report.without_ground > 0:
        points = "1 point lies" if report.without_ground == 1 else f"{report.without_ground} points lie"
        tell(True, f"{points} over no triangle of the ground")
