"""What calls on files tell of what they did: small objects that do not change."""

from __future__ import annotations

import dataclasses
from typing import Any, Optional, Tuple

Triple = Tuple[float, float, float]
Extent = Tuple[Triple, Triple]


# Attributes that are not printed.
_TOO_LONG = ("final", "stages", "tile_shapes")


class _Report:
    """Figures that print one a line, and in short as one line."""

    def _summary(self) -> str:
        raise NotImplementedError

    def __repr__(self) -> str:
        return f"<spillway.{type(self).__name__}: {self._summary()}>"

    def __str__(self) -> str:
        lines = [self._summary()]
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if value is not None and field.name not in _TOO_LONG:
                lines.append(f"  {field.name:24} {_text(value)}")
        return "\n".join(lines)


def _text(value: Any) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{name} {_text(item)}" for name, item in value.items() if item != 0)
    if isinstance(value, (list, tuple)):
        return ", ".join(_text(item) for item in value)
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _simplices(dimension: int) -> str:
    return {2: "triangles", 3: "tetrahedra"}.get(dimension, "simplices")


def _counts(report: Any) -> str:
    return f"{report.vertices} vertices, {report.simplices} {_simplices(report.dimension)}"


@dataclasses.dataclass(frozen=True, repr=False)
class RunReport(_Report):
    """What a run was like that made a mesh, or something of a mesh.

    The attributes are the keys of ``spillway triangulate --stats``; lengths of time are in seconds.
    Of a mesh that was not triangulated here those about the work are 0.
    """

    dimension: int
    points: int
    duplicates: int
    vertices: int
    simplices: int
    hull_facets: int
    canonical_hash: str
    left_out: int
    on_lattice: bool
    filters: dict[str, int]
    skipped_files: list[dict[str, str]]
    lost: list[str]
    output_format: str
    output_bytes: int
    output_files: int
    outside_tiles: int
    outside_vertices: int
    other_files: list[str]
    threads: int
    tiles: int
    tile_capacity: int
    leaves: int
    leaf_size: int
    spilled_points: int
    spilled_bytes: int
    divided_points: int
    first_block_read_points: int
    tile_shapes: dict[str, int]
    final: dict[str, Any]
    retriangulated_points: int
    border_simplices: int
    border_bytes: int
    phases: dict[str, float]
    stages: dict[str, float]
    memory_limit: int
    seconds: float

    def _summary(self) -> str:
        return f"{self.points} points, {_counts(self)}, hash {self.canonical_hash}"


@dataclasses.dataclass(frozen=True, repr=False)
class RasterReport(RunReport):
    """What a raster is like, and the run that made it. Lengths are in units of x and y; `west` and
    `north` are the edges of the corner pixel, `bands` names of products. Of tiles, `files` tells how
    many were written, `files_during_run` how many of them before all triangles had come, and
    `other_files` what is called like them and is of another run."""

    columns: int
    rows: int
    resolution: float
    west: float
    north: float
    bands: list[str]
    pixels_with_data: int
    files: int
    files_during_run: int
    empty_tiles: int
    vrt: str
    closed_tiles: int
    spilled_pixel_bytes: int
    points_in_pixels: int
    pixels_with_points: int
    filled_pixels: int

    def _summary(self) -> str:
        return (
            f"{self.columns} x {self.rows} pixels of {self.resolution:.6g}, "
            f"{self.pixels_with_data} with data; {_counts(self)}"
        )


@dataclasses.dataclass(frozen=True, repr=False)
class HeightReport(RunReport):
    """What became of points that were measured, the least and the greatest height of all of them,
    and the run that triangulated the ground."""

    written: int
    without_ground: int
    below_ground: int
    other_heights: int
    lowest: float
    highest: float
    spilled_height_bytes: int

    def _summary(self) -> str:
        return (
            f"{self.written} points, heights from {self.lowest:.6g} to {self.highest:.6g}, "
            f"{self.without_ground} without ground; {_counts(self)}"
        )


@dataclasses.dataclass(frozen=True, repr=False)
class VolumeReport(RunReport):
    """Volumes and areas of the plane where the first surface lies above the second, or the level
    (cut), and where below (fill); the area that both cover, that of each, 0 for a level; and the run
    that triangulated the first surface."""

    cut: float
    fill: float
    cut_area: float
    fill_area: float
    area: float
    first_area: float
    second_area: float
    spilled_triangle_bytes: int

    @property
    def net(self) -> float:
        """What is left over of the cut, or, below 0, is missing for the fill."""
        return self.cut - self.fill

    def _summary(self) -> str:
        return f"cut {self.cut:.6g}, fill {self.fill:.6g}; {_counts(self)}"


@dataclasses.dataclass(frozen=True, repr=False)
class DensityReport(RunReport):
    """The mass, which is the integral of the density, the volume of all simplices, an area in the
    plane, the least and the most density at a vertex, and the run that triangulated the points."""

    mass: float
    volume: float
    least: float
    most: float

    def _summary(self) -> str:
        return (
            f"mass {self.mass:.6g}, density from {self.least:.6g} to {self.most:.6g}; "
            f"{_counts(self)}"
        )


@dataclasses.dataclass(frozen=True, repr=False)
class ContourReport(RunReport):
    """How many lines there are, or polygons, of how many points, how many lines were left out for
    their length, the least and the greatest height of the terrain, and the run that made them. Of
    tiles, `files` tells how many have some, `outside_tiles` how many lines or polygons are in none,
    and `other_files` what is called like them and is of another run."""

    lines: int
    short_lines: int
    polygons: int
    line_points: int
    lowest: float
    highest: float
    files: int
    spilled_line_bytes: int

    def _summary(self) -> str:
        what = f"{self.polygons} polygons" if self.polygons else f"{self.lines} lines"
        return f"{what} of {self.line_points} points; {_counts(self)}"


@dataclasses.dataclass(frozen=True, repr=False)
class PictureReport(RunReport):
    """What a picture shows, its size in pixels, and the run that made it.

    Of a page `columns` and `rows` are those of its heights, and it shows `triangles`.
    """

    columns: int
    rows: int
    triangles: int
    description: str
    edges_too_small: bool

    def _summary(self) -> str:
        pixels = "" if self.triangles else f"{self.columns} x {self.rows} pixels, "
        return f"{pixels}{self.description}; {_counts(self)}"


@dataclasses.dataclass(frozen=True, repr=False)
class ConvertReport(_Report):
    """What became of points that were converted.

    `scale` and `offset` are the lattice that coordinates were rounded to, None if they were not;
    `farthest` is how far that moved one at most. `lost` names what the output does not hold.
    """

    written: int
    filters: dict[str, int]
    skipped_files: list[dict[str, str]]
    rounded: bool
    scale: Optional[Triple]
    offset: Optional[Triple]
    farthest: float
    adds_heights: bool
    lost: list[str]
    cells: int
    spilled_points: int
    spilled_bytes: int
    seconds: float

    def _summary(self) -> str:
        return f"{self.written} points written"


@dataclasses.dataclass(frozen=True, repr=False)
class GenerateReport(_Report):
    """How many points were written, to how many files."""

    points: int
    files: int
    seconds: float

    def _summary(self) -> str:
        return f"{self.points} points in {self.files} file{'' if self.files == 1 else 's'}"


@dataclasses.dataclass(frozen=True, repr=False)
class CheckReport(_Report):
    """What a check found. It is true where the mesh is proved.

    `properties` has a line for each property that holds, `faults` one for each of the first faults,
    `fault_count` counts all, and `other_ties` those that ``any_delaunay=True`` accepts.
    """

    dimension: int
    vertices: int
    simplices: int
    hull_facets: int
    canonical_hash: str
    on_lattice: bool
    properties: list[str]
    faults: list[str]
    fault_count: int
    off_lattice: int
    other_ties: int
    peak_live_vertices: int
    peak_open_facets: int
    filters: dict[str, int]

    @property
    def proved(self) -> bool:
        """Whether all properties hold."""
        return self.fault_count == 0

    def __bool__(self) -> bool:
        return self.proved

    def _summary(self) -> str:
        verdict = "proved" if self.proved else f"refuted by {self.fault_count} faults"
        return f"{verdict}; {_counts(self)}, hash {self.canonical_hash}"


@dataclasses.dataclass(frozen=True, repr=False)
class PointsInfo(_Report):
    """What a point file holds. What it does not tell is None; boxes are (lowest, highest) corners.

    `attributes` is what points carry, as in the JSON of ``spillway info``: dicts with "name" and
    "type", "min" and "max" where there are values, and what else there is to say. `classes` and
    `returns` tell how many points are of each of these numbers, `flags` how many have each flag of
    LAS. `table` tells how a text was understood, as in the JSON of ``spillway info``.
    """

    format: str
    version: Optional[str]
    point_format: Optional[int]
    coordinates: int
    points: Optional[int]
    filters: dict[str, int]
    extent: Optional[Extent]
    header_box: Optional[Extent]
    points_outside: Optional[int]
    scale: Optional[Triple]
    offset: Optional[Triple]
    crs: Optional[str]
    crs_note: Optional[str]
    software: Optional[str]
    cells: Optional[int]
    classes: dict[int, int]
    returns: dict[int, int]
    flags: dict[str, int]
    table: Optional[dict[str, Any]]
    attributes: list[dict[str, Any]]

    def _summary(self) -> str:
        return f"{self.points} points, {self.format}"


@dataclasses.dataclass(frozen=True, repr=False)
class MeshInfo(_Report):
    """What a file of a mesh holds. What it does not tell is None.

    `periodic` is the (lowest, highest) sides of the box that the mesh repeats with, where open axes
    have None.
    """

    format: str
    dimension: int
    vertices: int
    simplices: int
    hull_facets: int
    canonical_hash: str
    points: Optional[int]
    duplicates: Optional[int]
    extent: Optional[Extent]
    scale: Optional[Triple]
    offset: Optional[Triple]
    input_index: bool
    crs: Optional[str]
    peak_live_vertices: Optional[int]
    attributes: list[dict[str, Any]]
    periodic: Optional[Tuple[Tuple[Optional[float], ...], Tuple[Optional[float], ...]]]

    def _summary(self) -> str:
        return f"{_counts(self)}, {self.format}, hash {self.canonical_hash}"
