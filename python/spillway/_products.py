"""What is made of a terrain while its triangles pass by: `dem`, `contour` and `render`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Iterable, NamedTuple, Sequence, overload

import numpy as np
from numpy.typing import NDArray

from . import _spillway
from ._inputs import as_inputs, mesh_origin
from ._messages import tell, warn_of_tiles
from ._options import (
    DemOptions,
    PathLike,
    TriangulateOptions,
    as_path,
    make_run,
    move_clip,
    point_options,
    put,
    put_all,
    put_classes,
    put_tiles,
    refuse,
    takes,
    triangulate_options,
)
from ._reports import ContourReport, PictureReport, RasterReport
from .errors import InvalidArgumentError

if TYPE_CHECKING:
    from typing_extensions import Unpack


class Raster(NamedTuple):
    """A raster in memory."""

    values: NDArray[np.float32]
    """Shape (rows, columns), or (bands, rows, columns); row 0 is the northernmost; not a number
    where there is no data."""
    geotransform: tuple[float, float, float, float, float, float]
    """As GDAL has it: west, width of a pixel, 0, north, 0, minus the height of a pixel."""
    crs: str | None
    """The coordinate system as WKT or ``"EPSG:n"``, where it is known."""
    report: RasterReport
    """What the run was like."""

    def __repr__(self) -> str:
        return f"<spillway.Raster: {self.report._summary()}>"


@overload
def dem(
    inputs: Any,
    output: None = None,
    *,
    resolution: float | None = None,
    bounds: Sequence[float] | None = None,
    force_size: bool = False,
    align: bool = False,
    like: PathLike | None = None,
    product: str | Sequence[str] = "height",
    ground_class: int | Iterable[int] | None = None,
    azimuth: float | None = None,
    altitude: float | None = None,
    z_factor: float | None = None,
    gradient: str | None = None,
    compute_edges: bool = False,
    fill_voids: bool = False,
    clip_pixels: bool = False,
    mesh_format: str | None = None,
    **options: Unpack[DemOptions],
) -> Raster:
    ...


@overload
def dem(
    inputs: Any,
    output: PathLike,
    *,
    resolution: float | None = None,
    bounds: Sequence[float] | None = None,
    force_size: bool = False,
    align: bool = False,
    like: PathLike | None = None,
    product: str | Sequence[str] = "height",
    ground_class: int | Iterable[int] | None = None,
    azimuth: float | None = None,
    altitude: float | None = None,
    z_factor: float | None = None,
    gradient: str | None = None,
    compute_edges: bool = False,
    fill_voids: bool = False,
    clip_pixels: bool = False,
    tiles: float | PathLike | None = None,
    vrt: PathLike | None = None,
    nodata: float | None = None,
    type: str | None = None,
    compress: str | None = None,
    cog: bool = False,
    mesh_format: str | None = None,
    **options: Unpack[DemOptions],
) -> RasterReport:
    ...


@takes(DemOptions)
def dem(
    inputs: Any,
    output: PathLike | None = None,
    *,
    resolution: float | None = None,
    bounds: Sequence[float] | None = None,
    force_size: bool = False,
    align: bool = False,
    like: PathLike | None = None,
    product: str | Sequence[str] = "height",
    ground_class: int | Iterable[int] | None = None,
    azimuth: float | None = None,
    altitude: float | None = None,
    z_factor: float | None = None,
    gradient: str | None = None,
    compute_edges: bool = False,
    fill_voids: bool = False,
    clip_pixels: bool = False,
    tiles: float | PathLike | None = None,
    vrt: PathLike | None = None,
    nodata: float | None = None,
    type: str | None = None,
    compress: str | None = None,
    cog: bool = False,
    mesh_format: str | None = None,
    **options: Unpack[DemOptions],
) -> Raster | RasterReport:
    """Make a raster of heights, slopes or shades, as a GeoTIFF or as an array.

    As ``spillway dem``: interpolated linearly within the triangles of the points.

    Parameters
    ----------
    inputs : path, sequence of paths, or array_like of shape (n, 3)
        Points, as `triangulate` takes them, or one file of a mesh of triangles.
    output : path, optional
        A GeoTIFF; of `tiles` a pattern, like ``"dtm_{x}_{y}.tif"``. By default an array is made,
        beyond the memory that `memory` limits.
    resolution : float
        Side of a pixel, in units of x and y. Not with `like`.
    bounds : (float, float, float, float), optional
        Cover xmin, ymin, xmax, ymax. By default all points.
    force_size : bool, optional
        Cover all points, even if outliers make the raster very large.
    align : bool, optional
        Put edges of pixels on multiples of the resolution.
    like : path, optional
        Put pixels where this raster has them.
    product : str or sequence of str, optional
        ``"height"``, ``"slope"``, ``"aspect"``, ``"hillshade"``, ``"multi-hillshade"``,
        ``"roughness"``, ``"tri"``, ``"tpi"``, ``"curvature"``, ``"profile-curvature"``,
        ``"plan-curvature"``, ``"facet-slope"``, ``"facet-aspect"``, ``"facet-hillshade"`` or
        ``"density"``; of all points in a pixel ``"min"``, ``"max"``, ``"mean"``, ``"count"``,
        ``"stddev"`` or a percentile, ``"p0"`` to ``"p100"``; several are bands.
    ground_class : int or sequence of int, optional
        Of ``product="chm"``, heights above the ground: points of these classes are the ground; 2 by
        default.
    azimuth, altitude : float, optional
        Where a hillshade's light comes from, and its height above the horizon, in degrees; 315 and
        45 by default.
    z_factor : float, optional
        Multiply heights by this for slopes, shades and curvatures. By default as units tell.
    gradient : {"horn", "zevenbergen-thorne"}, optional
        How slope, aspect and hillshade come from a pixel's neighbours.
    compute_edges : bool, optional
        Make slopes and the like also where neighbours have no data.
    fill_voids : bool, optional
        Give min, max, mean and percentiles of pixels without points the height of the triangle at
        the centre, where there is one (`max_edge`).
    clip_pixels : bool, optional
        Use all points, and let `clip` leave pixels without data whose centres lie elsewhere.
    tiles : float or path, optional
        Cut the raster into files: squares of this side, with ``{x}`` and ``{y}`` in their names, or
        by the polygons of this vector file, with fields of theirs in braces.
    vrt : path, optional
        Of tiles, the file that puts them together. By default as `output`, without braces.
    nodata : float, optional
        Of a file, the value of pixels without data; -9999 by default.
    type : {"float32", "byte"}, optional
        Of a file's pixels; bytes are for hillshades, with 0 for no data.
    compress : {"deflate", "zstd", "none"}, optional
        Compression of a file.
    cog : bool, optional
        Make a file cloud optimized, with overviews.
    mesh_format : str, optional
        Format of a mesh, where neither first bytes nor name tell.
    {options}

    Returns
    -------
    Raster or RasterReport
        Without `output` ``(values, geotransform, crs, report)``: values are an ndarray of float32
        of shape (rows, columns), of a sequence of products (bands, rows, columns), not a number
        where there is no data. With `output` the report.

    Raises
    ------
    spillway.Error
        As `triangulate`; ``"too large"`` for a raster that is large because of points far away.
    """
    how = _spillway.DemOptions()
    is_canopy = isinstance(product, str) and product == _CANOPY
    put(how, "product", "height" if is_canopy else product, _put_products)
    if not is_canopy:
        refuse({"ground_class": ground_class}, ["ground_class"], 'without product="chm"')
    products = how.products
    surface = {
        "azimuth": azimuth,
        "altitude": altitude,
        "z_factor": z_factor,
        "gradient": gradient,
        "compute_edges": compute_edges,
        "fill_voids": fill_voids,
    }
    _check_products(how, surface, options)
    if like is None:
        if resolution is None:
            raise InvalidArgumentError("resolution, the side of a pixel, is missing (or like)")
        if bounds is not None:
            refuse({"force_size": force_size}, ["force_size"], "with bounds")
        put_all(how, {"resolution": resolution, "bounds": bounds, "align": align})
        put_all(how, {"force_size": force_size})
    else:
        places = {"resolution": resolution, "bounds": bounds, "align": align}
        refuse(
            {**places, "force_size": force_size},
            [*places, "force_size"],
            "with like, which tells where all pixels lie",
        )
        how.like = as_path(like, "like")
        how.foreign_crs = bool(options.get("force_crs"))
    put_all(how, surface)
    put_all(how, {"max_edge": options.get("max_edge")})
    if clip_pixels:
        options = move_clip(how, options)  # type: ignore[assignment]
    of_files = {"nodata": nodata, "type": type, "compress": compress, "cog": cog}
    run = make_run(options)
    if is_canopy:
        origin = _canopy_origin(run, inputs, ground_class, mesh_format, options)
    else:
        origin = mesh_origin(run, inputs, 2, mesh_format, options)
    if output is not None:
        if type == "byte":
            refuse(of_files, ["nodata"], "on bytes, in which 0 is no data")
        put_all(how, of_files)
        _put_tiles(how, tiles, vrt, align, bool(options.get("force_crs")))
        report = RasterReport(**_spillway.dem(run, origin, as_path(output, "output"), how))
        _warn_of_empty(report)
        warn_of_tiles(report)
        return report
    of_files |= {"tiles": tiles, "vrt": vrt}
    refuse(of_files, of_files, "without an output")
    how.nodata = float("nan")
    figures, values, crs = _spillway.dem_in_memory(run, origin, how)
    report = RasterReport(**figures)
    _warn_of_empty(report)
    values = values.reshape(len(products), report.rows, report.columns)
    side = report.resolution
    return Raster(
        values[0] if isinstance(product, str) else values,
        (report.west, side, 0.0, report.north, 0.0, -side),
        crs or None,
        report,
    )


@takes(TriangulateOptions)
def contour(
    inputs: Any,
    output: PathLike,
    *,
    interval: float | None = None,
    base: float | None = None,
    levels: Sequence[float] | None = None,
    index: int | None = None,
    min_length: float | None = None,
    smooth: float | None = None,
    simplify: float | None = None,
    bands: bool = False,
    tiles: float | PathLike | None = None,
    mesh_format: str | None = None,
    **options: Unpack[TriangulateOptions],
) -> ContourReport:
    """Draw lines of equal height to a vector file.

    As ``spillway contour``: lines run with higher ground to their left.

    Parameters
    ----------
    inputs : path, sequence of paths, or array_like of shape (n, 3)
        Points, as `triangulate` takes them, or one file of a mesh of triangles.
    output : path
        A file in the format of its extension: ``.gpkg``, ``.shp``, ``.geojson``, ``.json``
        or ``.dxf``.
    interval : float
        Height between two lines. Not with `levels`.
    base : float, optional
        A height that intervals are counted from; 0 by default.
    levels : sequence of float, optional
        Heights of lines, instead of an interval.
    index : int, optional
        Every so many-th line from the base is an index contour; 5 by default. Not with `levels`.
    min_length : float, optional
        Leave out lines that are shorter, in units of x and y.
    smooth : float, optional
        Smooth lines, moving them by at most this. Lines of different heights do not meet.
    simplify : float, optional
        Leave out points of lines, moving these by at most this, likewise.
    bands : bool, optional
        Polygons of what lies between neighbouring levels, instead of lines. Not with `index`
        and `min_length`.
    tiles : float or path, optional
        Cut lines, or bands, into files: squares of this side with ``{x}`` and ``{y}`` in their
        names, or the polygons of this vector file with its fields in braces.
    mesh_format : str, optional
        Format of a mesh, where neither first bytes nor name tell.
    {options}

    Returns
    -------
    ContourReport
        How many lines there are, and what the run was like.

    Raises
    ------
    spillway.Error
        As `triangulate`.
    """
    how = _spillway.ContourOptions()
    if levels is not None:
        spacing = {"interval": interval, "base": base, "index": index}
        refuse(spacing, spacing, "with levels, which names all heights")
        if np.size(levels) == 0:
            raise InvalidArgumentError("levels is empty; give heights, or an interval")
    elif interval is None:
        raise InvalidArgumentError("interval, the height between two lines, is missing (or levels)")
    put_all(how, {"interval": interval, "base": base, "levels": levels})
    put_all(how, {"index": index, "min_length": min_length})
    put_all(how, {"smooth": smooth, "simplify": simplify})
    put_tiles(how, tiles)
    if bands:
        of_lines = {"index": index, "min_length": min_length}
        refuse(of_lines, of_lines, "with bands, which are no lines")
    how.bands = bands
    put_all(how, {"max_edge": options.get("max_edge")})
    how.foreign_crs = bool(options.get("force_crs"))
    run = make_run(options)
    origin = mesh_origin(run, inputs, 2, mesh_format, options)
    report = ContourReport(**_spillway.contours(run, origin, as_path(output, "output"), how))
    warn_of_tiles(report)
    if report.lines == 0 and report.short_lines > 0:
        tell(True, f"no lines: {report.short_lines} lines left out: shorter than min_length")
    elif report.lines == 0 and not bands:
        tell(
            True,
            f"no lines: no level lies above the lowest height, {report.lowest:g}, and up to the "
            f"highest, {report.highest:g}",
        )
    return report


@takes(TriangulateOptions)
def render(
    inputs: Any,
    output: PathLike,
    *,
    dim: int = 2,
    size: int | None = None,
    triangles: int | None = None,
    zoom: Sequence[float] | None = None,
    color: str | None = None,
    ramp: str | None = None,
    legend: bool = False,
    scale_bar: bool = False,
    world_file: bool = False,
    wireframe: bool = False,
    exaggerate: float | None = None,
    view: tuple[float, float] | None = None,
    light: tuple[float, float] | None = None,
    shadows: bool = False,
    slice: tuple[str, float] | None = None,
    transparent: bool = False,
    mesh_format: str | None = None,
    **options: Unpack[TriangulateOptions],
) -> PictureReport:
    """Draw a picture: a terrain as a relief or a page, tetrahedra as their hull or a slice.

    As ``spillway render``.

    Parameters
    ----------
    inputs : path, sequence of paths, or array_like of shape (n, 3)
        Points, as `triangulate` takes them, or one file of a mesh.
    output : path
        A PNG; FILE.tif, a GeoTIFF; or FILE.html, a page that shows a terrain in three dimensions in any browser.
    dim : {2, 3}, optional
        How points are triangulated: 2, a terrain, or 3, tetrahedra.
    size : int, optional
        Pixels of a PNG's longer side; 1200 by default.
    triangles : int, optional
        Triangles that a page shows at most; 500,000 by default.
    zoom : (float, float, float, float), optional
        Show xmin, ymin, xmax, ymax only.
    color : {"height", "class", "intensity", "return", "rgb"}, optional
        What the colours of a terrain stand for: its heights, or attributes of its points.
    ramp : {"relief", "grey", "viridis", "magma", "cividis", "turbo"}, optional
        Colours of heights or intensities; "relief" and "grey" by default.
    legend : bool, optional
        Tell below a PNG of a terrain what its colours stand for.
    scale_bar : bool, optional
        Draw below it how long a bar is.
    world_file : bool, optional
        Write a world file beside it, FILE.pgw for FILE.png.
    wireframe : bool, optional
        Draw the edges of triangles.
    exaggerate : float, optional
        Show a terrain as if it were so many times as high. By default such that slopes are seen.
    view : (float, float), optional
        Look from this azimuth and elevation, in degrees: by default at a terrain from above, at
        tetrahedra from 30 and 25, at a page from 200 and 40.
    light : (float, float), optional
        Light a terrain from this azimuth and altitude, in degrees; 315 and 45 by default.
    shadows : bool, optional
        Let a terrain cast shadows.
    slice : (str, float), optional
        Cut tetrahedra by a plane, as ``("z", 0.5)``.
    transparent : bool, optional
        Leave the background transparent, not white.
    mesh_format : str, optional
        Format of a mesh, where neither first bytes nor name tell.
    {options}

    Returns
    -------
    PictureReport
        What the picture shows, and what the run was like.

    Raises
    ------
    spillway.Error
        As `triangulate`.
    """
    how = _spillway.PictureOptions()
    put_all(how, {"size": size, "triangles": triangles, "zoom": zoom, "ramp": ramp})
    put_all(how, {"color": color, "legend": legend, "scale_bar": scale_bar})
    put_all(how, {"world_file": world_file, "wireframe": wireframe, "view": view})
    put_all(how, {"light": light, "shadows": shadows})
    put_all(how, {"exaggerate": exaggerate, "transparent": transparent})
    put_all(how, {"max_edge": options.get("max_edge")})
    if slice is not None:
        put(how, "slice", slice, _put_slice)
    run = make_run(options)
    origin = mesh_origin(run, inputs, dim, mesh_format, options)
    return PictureReport(**_spillway.picture(run, origin, as_path(output, "output"), how))


def _put_slice(target: _spillway.PictureOptions, value: tuple[str, float]) -> None:
    axis, place = value
    target.set_slice(axis, place)


_CANOPY = "chm"


def _canopy_origin(
    run: _spillway.Run,
    inputs: Any,
    ground_class: int | Iterable[int] | None,
    mesh_format: str | None,
    options: Any,
) -> _spillway.MeshOrigin:
    """Triangles of points of files whose z is their height above the ground."""
    source = as_inputs(inputs)
    if not isinstance(source, list):
        raise InvalidArgumentError("chm is made of files of points, which have classes")
    refuse({"mesh_format": mesh_format}, ["mesh_format"], "with chm, which is made of points")
    refuse(options, ["resume", "checkpoint_every"], "with chm, which takes two runs")
    ground = _spillway.PointOptions()
    put(ground, "ground_class", 2 if ground_class is None else ground_class, put_classes)
    heights = options.get("heights") or "highest"
    how = triangulate_options({**options, "heights": heights}, 2)
    return _spillway.MeshOrigin(source, point_options(options, 0), how, {}, ground.classes)


def _put_products(target: _spillway.DemOptions, value: str | Sequence[str]) -> None:
    target.products = [value] if isinstance(value, str) else list(value)


# What products must depend on for an option to make a difference (spillway::DemProductTraits).
_TRAIT_OF_OPTION = {
    "azimuth": ("by_azimuth", "hillshade"),
    "altitude": ("by_altitude", "hillshade"),
    "z_factor": ("by_ground", "slope, aspect, hillshade or curvature"),
    "gradient": ("by_gradient", "slope, aspect or hillshade"),
    "compute_edges": ("of_neighbours", "slope or another product of a pixel's neighbours"),
    "fill_voids": ("fills_voids", "min, max, mean or a percentile"),
}

# Of these nothing is left where products are of points alone.
_OF_TRIANGLES = [
    "heights",
    "max_edge",
    "tile_points",
    "leaf_points",
    "division",
    "children",
    "kernel",
    "resume",
    "checkpoint_every",
]


def _check_products(how: _spillway.DemOptions, surface: dict[str, Any], options: Any) -> None:
    """Refuse options that make no difference to the products."""
    for name, (trait, products) in _TRAIT_OF_OPTION.items():
        if trait not in how.traits:
            refuse(surface, [name], f"without {products} among the products")
    if "of_triangles" not in how.traits and not surface["fill_voids"]:
        refuse(options, _OF_TRIANGLES, "on products of points alone, which need no triangles")
    if how.products == ["density"]:
        refuse(options, ["heights", "max_edge"], "on density, which counts vertices")


def _put_tiles(
    how: _spillway.DemOptions, tiles: float | PathLike | None, vrt: PathLike | None, align: bool, force_crs: bool
) -> None:
    """Put what a raster is cut into."""
    if tiles is None:
        refuse({"vrt": vrt}, ["vrt"], "without tiles, which a VRT puts together")
        return
    if vrt is not None:
        how.vrt = as_path(vrt, "vrt")
    put_tiles(how, tiles)
    if how.tile_polygons:
        how.foreign_crs = force_crs
    else:
        refuse({"align": align}, ["align"], "with tiles that are squares, which align pixels")


def _warn_of_empty(report: RasterReport) -> None:
    if report.pixels_with_data == 0:
        tell(
            True,
            f"no pixel of the {report.columns} x {report.rows} has a value: the raster lies beside "
            "the points, or its pixels are too large for them",
        )
