"""From files and arrays to files: `triangulate`, `convert`, `generate`, `info` and `check`."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any, Iterable, Sequence, overload

import numpy as np
from numpy.typing import NDArray

from . import _spillway
from ._arrays import Floats, attributes_of
from ._inputs import (
    as_dimension,
    as_inputs,
    check_array,
    check_mesh_options,
    is_mesh,
    points_origin,
)
from ._messages import warn_of_tiles
from ._options import (
    CheckOptions,
    ConvertOptions,
    InfoOptions,
    PathLike,
    RepeatingOptions,
    RunOptions,
    as_names,
    as_path,
    as_reals,
    as_word,
    attribute,
    make_run,
    mesh_file_options,
    mesh_options,
    move_clip,
    names_for_points_alone,
    point_options,
    put,
    put_all,
    refuse,
    takes,
)
from ._reports import CheckReport, ConvertReport, GenerateReport, MeshInfo, PointsInfo, RunReport
from .errors import InvalidArgumentError

if TYPE_CHECKING:
    from typing_extensions import Unpack


@takes(RepeatingOptions)
def triangulate(
    inputs: Any,
    output: PathLike,
    *,
    dim: int = 2,
    id: bool = False,
    attributes: str | Sequence[str] | None = None,
    output_format: str | None = None,
    tiles: float | PathLike | None = None,
    clip_simplices: bool = False,
    **options: Unpack[RepeatingOptions],
) -> RunReport:
    """Triangulate points of any number, through bounded memory, to a file.

    As ``spillway triangulate``. The file gets its name when it is complete; after an error or
    Ctrl-C nothing is left.

    Parameters
    ----------
    inputs : path, sequence of paths, or array_like of shape (n, 2) to (n, 6)
        Point files, folders (their point files), patterns (``"tiles/*.laz"``), ``"@list"`` for a
        file that lists such, ``"-"`` for standard input; or coordinates, which must not change
        meanwhile.
    output : path
        The mesh, in the format of its extension.
    dim : {2, 3, 4, 5, 6}, optional
        2: triangles over x and y, z is carried along, also that of an array. 3: tetrahedra. Beyond:
        simplices, of an array with so many columns, of files of such, or of points with attributes
        called x4, x5 and x6. Meshes of these are spm and npy.
    id : bool, optional
        Write each vertex's index in the input.
    attributes : str or sequence of str, optional
        Names of what points carry and vertices keep, or "all"; an empty sequence for none. By
        default none, but the colour of points in PLY. Of an array with fields, or a dict of arrays,
        it is all but x, y and z.
    output_format : str, optional
        The format, where the name does not tell, as ``"ply"`` or ``"spm"``.
    tiles : float or path, optional
        A file for each square of this side, with ``{x}`` and ``{y}`` in `output`, or for each
        polygon of this vector file, with its fields in braces. A simplex goes whole to where its
        centroid lies.
    clip_simplices : bool, optional
        Use all points, and let `clip` leave out simplices whose centroids lie elsewhere.
    {options}

    Returns
    -------
    RunReport
        Counts, the canonical hash and what the run took.

    Raises
    ------
    spillway.Error
        With the attribute `code`: ``"bad input"`` for a file that is not what it should be,
        ``"input or output"`` for what the system refuses, ``"invalid argument"``,
        ``"degenerate input"``, ``"out of budget"`` for a limit that does not suffice.
    KeyboardInterrupt
        On Ctrl-C, as soon as the parts of the work that have been begun are done.

    Warns
    -----
    spillway.Warning
        Of what a run finds worth one. What explains how it goes is logged by the logger
        ``"spillway"`` at the level INFO.
    """
    source = as_inputs(inputs)
    carried = attributes_of(inputs, "inputs")
    path = as_path(output, "output")
    how = mesh_file_options(output_format, attributes, tiles, options)
    if clip_simplices:
        options = move_clip(how, options)  # type: ignore[assignment]
    origin = points_origin(source, as_dimension(dim, source), options, id, carried)
    return warn_of_tiles(RunReport(**_spillway.mesh(make_run(options), origin, path, how)))


@takes(ConvertOptions)
def convert(
    inputs: Any,
    output: PathLike,
    *,
    output_format: str | None = None,
    mesh_format: str | None = None,
    las_version: str | None = None,
    scale: float | Sequence[float] | None = None,
    offset: float | Sequence[float] | None = None,
    attributes: str | Sequence[str] | None = None,
    force: bool = False,
    sorted: bool = False,
    cell_points: int | None = None,
    dim: int | None = None,
    tiles: float | PathLike | None = None,
    **options: Unpack[ConvertOptions],
) -> ConvertReport | RunReport:
    """Write points or a mesh in another format.

    As ``spillway convert``. Content and name tell whether the input is points or a mesh.

    Parameters
    ----------
    inputs : path, sequence of paths, or array_like of shape (n, 2) or (n, 3)
        Points, as `triangulate` takes them, or one file of a mesh. A structured array, or a dict of
        arrays, has x, y and, where there are heights, z; all else is what points carry.
    output : path
        In the format of its extension.
    output_format : str, optional
        The format of the output, where the name does not tell.
    mesh_format : str, optional
        The input is a mesh of this format, which neither first bytes nor name tell.
    las_version : {"1.2", "1.4"}, optional
        Of LAS and LAZ. By default what the points need.
    scale : float or sequence of 3 floats, optional
        Round coordinates of points to multiples of this.
    offset : float or sequence of 3 floats, optional
        Where these multiples are counted from.
    attributes : str or sequence of str, optional
        Names of the attributes that are written, or "all"; an empty sequence for none. By default
        all that the format holds, but of points none in text, unless it is CSV.
    force : bool, optional
        Replace a file that is an input also by one that holds less than it.
    sorted : bool, optional
        Write points cell by cell; spp only.
    cell_points : int, optional
        Most points of a cell.
    dim : {2, 3}, optional
        Cells divide the plane (by default), or space.
    tiles : float or path, optional
        Of a mesh, as `triangulate` has them.
    {options}

    Returns
    -------
    ConvertReport or RunReport
        Of points, or of a mesh.

    Raises
    ------
    spillway.Error
        As `triangulate`.
    """
    source = as_inputs(inputs)
    path = as_path(output, "output")
    cells = {"cell_points": cell_points, "dim": dim}
    of_points = {
        "las_version": las_version,
        "scale": scale,
        "offset": offset,
        "force": force,
        "sorted": sorted,
    }
    run = make_run(options)
    if is_mesh(run, source, mesh_format, options):
        written = mesh_file_options(output_format, attributes, tiles, options)
        if options.get("clip") is not None:
            options = move_clip(written, options)  # type: ignore[assignment]
        check_mesh_options(options)
        refuse({**of_points, **cells}, [*of_points, *cells], "on a mesh")
        assert isinstance(source, list)
        origin = _spillway.MeshOrigin(source[0], mesh_options(options, mesh_format))
        return warn_of_tiles(RunReport(**_spillway.mesh(run, origin, path, written)))
    refuse({"tiles": tiles}, ["tiles"], "on points: a mesh is cut into tiles")
    check_array(source, options)
    how = _spillway.PointFileOptions()
    put_all(how, {"output_format": output_format, "las_version": las_version})
    put(how, "scale", scale, attribute("scale", _as_axes))
    put(how, "offset", offset, attribute("offset", _as_axes))
    if attributes is not None:
        how.attributes = as_names(attributes, "attributes")
    how.force = bool(force)
    if sorted:
        dimension = as_dimension(2 if dim is None else dim, source, most=3)
        put(how, "cell_points", cell_points or 0, functools.partial(_put_sorted, dimension))
    else:
        refuse(cells, cells, "without sorted=True")
    which = point_options(options, 2 if sorted else 0)
    which.metadata = True
    carried = attributes_of(inputs, "inputs")
    return ConvertReport(**_spillway.convert_points(run, source, which, path, how, carried))


@takes(ConvertOptions)
def read_points(
    inputs: Any,
    *,
    attributes: str | Sequence[str] | None = None,
    **options: Unpack[ConvertOptions],
) -> NDArray[Any]:
    """Read points into memory, and what they carry.

    Parameters
    ----------
    inputs : path or sequence of paths
        Points, as `triangulate` takes them.
    attributes : str or sequence of str, optional
        Names of attributes that are wanted, as ``"intensity"``, or "all". By default none.
    {options}

    Returns
    -------
    ndarray
        Without `attributes` float64 of shape (n, 2) or (n, 3). With them a structured array of
        shape (n,): the fields x, y and, if there are heights, z, and a field for each attribute, in
        its type, or float64 where that is scaled. `convert` takes it, too.

    Raises
    ------
    spillway.Error
        As `triangulate`; ``"invalid argument"`` for an attribute that no file has.

    Examples
    --------
    >>> import spillway
    >>> report = spillway.generate("terrain", 1000, "hills.las")
    >>> points = spillway.read_points("hills.las", attributes="intensity")
    >>> points.dtype.names
    ('x', 'y', 'z', 'intensity')
    """
    source = as_inputs(inputs)
    if not isinstance(source, list):
        raise InvalidArgumentError("inputs are points in memory already; give paths")
    which = point_options(options, 0)
    which.attributes = as_names(attributes, "attributes")
    rows, carried = _spillway.read_points(make_run(options), source, which)
    if attributes is None:
        return rows
    columns = {**dict(zip("xyz", rows.T)), **carried}
    fields = [(name, numbers.dtype, numbers.shape[1:]) for name, numbers in columns.items()]
    points = np.empty(len(rows), fields)
    for name, numbers in columns.items():
        points[name] = numbers
    return points


@overload
def generate(
    family: str,
    count: int,
    output: None = None,
    *,
    dim: int | None = None,
    seed: int | None = None,
    **options: Unpack[RunOptions],
) -> Floats:
    ...


@overload
def generate(
    family: str,
    count: int,
    output: PathLike,
    *,
    dim: int | None = None,
    seed: int | None = None,
    grid: tuple[int, int] | None = None,
    overlap: float | None = None,
    output_format: str | None = None,
    las_version: str | None = None,
    **options: Unpack[RunOptions],
) -> GenerateReport:
    ...


@takes(RunOptions)
def generate(
    family: str,
    count: int,
    output: PathLike | None = None,
    *,
    dim: int | None = None,
    seed: int | None = None,
    grid: tuple[int, int] | None = None,
    overlap: float | None = None,
    output_format: str | None = None,
    las_version: str | None = None,
    **options: Unpack[RunOptions],
) -> Floats | GenerateReport:
    """Make points to try things with, as an array or as files.

    As ``spillway generate``. The same arguments give the same points on every machine.

    Parameters
    ----------
    family : str
        What they look like: ``"uniform"``, ``"terrain"``, ``"circle"``, ...
    count : int
        How many.
    output : path, optional
        A point file, in the format of its extension. By default an array is made.
    dim : {2, 3, 4, 5, 6}, optional
        2 by default. Not for ``"terrain"``, which always has z; ``"scan"`` has z with 2 and 3, and
        no more; nor has ``"packing"``.
    seed : int, optional
        Another seed, other points; 1 by default.
    grid : (int, int), optional
        Columns and rows of a survey: a file for each tile; `output` has a ``#`` for column and row.
    overlap : float, optional
        With a grid, by how much tiles overlap, in their sides: 0 to 0.4, 0.05 by default.
    output_format : str, optional
        The format, where the name does not tell.
    las_version : {"1.2", "1.4"}, optional
        Of LAS and LAZ.
    {options}

    Returns
    -------
    ndarray of float64, shape (count, 2) or (count, 3), or GenerateReport
        The points, or what was written.

    Raises
    ------
    spillway.Error
        As `triangulate`.
    """
    of_files = {"output_format": output_format, "las_version": las_version}
    of_grid = {"grid": grid, "overlap": overlap}
    if family == "terrain":
        refuse({"dim": dim}, ["dim"], 'on "terrain", which always has z')
    points = _spillway.GenerateOptions()
    put_all(points, {"family": family, "dim": dim, "seed": seed})
    put(points, "count", count, attribute("count"))
    run = make_run(options)
    if output is None:
        refuse({**of_files, **of_grid}, [*of_files, *of_grid], "without an output")
        return _spillway.generate_in_memory(run, points)
    path = as_path(output, "output")
    if grid is None:
        refuse(of_grid, ["overlap"], "without a grid")
        how = _spillway.PointFileOptions()
        how.exact = True
        put_all(how, {"output_format": output_format, "las_version": las_version})
        return GenerateReport(**_spillway.generate(run, points, path, how))
    survey = _spillway.GridOptions()
    put(survey, "grid", grid, _put_grid)
    put_all(survey, {"overlap": overlap})
    put_all(survey, {"output_format": output_format, "las_version": las_version})
    return GenerateReport(**_spillway.generate_survey(run, points, path, survey))


@takes(InfoOptions)
def info(
    file: PathLike, *, fast: bool = False, **options: Unpack[InfoOptions]
) -> PointsInfo | MeshInfo:
    """Tell what a file of points or of a mesh holds.

    As ``spillway info``. All of it is read, so counts and extent are exact, whatever a header says.

    Parameters
    ----------
    file : path
        One file; its first bytes and its name tell whether it holds points or a mesh.
    fast : bool, optional
        Of points, tell what the header tells, and read no points: their number and extent are the
        header's then.
    {options}

    Returns
    -------
    PointsInfo or MeshInfo

    Raises
    ------
    spillway.Error
        As `triangulate`.
    """
    paths = [as_path(file, "file")]
    run = make_run(options)
    if is_mesh(run, paths, None, options):
        refuse(options, names_for_points_alone(), "on a mesh")
        return MeshInfo(**_spillway.mesh_info(run, paths[0], mesh_options(options, None)))
    return PointsInfo(**_spillway.points_info(run, paths[0], point_options(options, 2), fast))


@takes(CheckOptions)
def check(
    mesh: PathLike,
    *,
    points: Any = None,
    any_delaunay: bool = False,
    mesh_format: str | None = None,
    **options: Unpack[CheckOptions],
) -> CheckReport:
    """Prove that a mesh is the Delaunay triangulation of its vertices, or refute it.

    As ``spillway check``: by exact predicates, and by nothing else of what has made the mesh.

    Parameters
    ----------
    mesh : path
        A file of a mesh.
    points : path, sequence of paths, or array_like of shape (n, 2) to (n, 6), optional
        Prove, too, that the vertices are exactly the distinct ones of these points.
    any_delaunay : bool, optional
        Accept either way of splitting cocircular facets, for meshes of other programs.
    mesh_format : str, optional
        The format of the mesh, where neither first bytes nor name tell.
    {options}

    Returns
    -------
    CheckReport
        True where the mesh is proved; with the properties that hold, and the first faults.

    Raises
    ------
    spillway.Error
        As `triangulate`. A mesh that is refuted is no error.
    """
    path = as_path(mesh, "mesh")
    source = None
    if points is None:
        refuse(options, names_for_points_alone(), "without points")
    else:
        source = as_inputs(points, "points")
        check_array(source, options, keeps=("max_expansion",))
    run = make_run(options)
    how = mesh_options({"max_expansion": options.get("max_expansion")}, mesh_format)
    which = point_options(options, 2)
    return CheckReport(**_spillway.check(run, path, how, bool(any_delaunay), source, which))


def _put_sorted(dim: int, target: _spillway.PointFileOptions, cell_points: int) -> None:
    target.set_sorted(dim, cell_points)


def _put_grid(target: _spillway.GridOptions, value: tuple[int, int]) -> None:
    columns, rows = value
    target.set_grid(columns, rows)


def _as_axes(values: Any) -> list[float]:
    """No number, one for all axes, or three."""
    if values is None:
        return []
    axes = as_reals(values if isinstance(values, Iterable) else [values])
    if len(axes) not in (1, 3):
        raise InvalidArgumentError(f"{values} has {len(axes)} numbers; give 1 or 3")
    return axes
