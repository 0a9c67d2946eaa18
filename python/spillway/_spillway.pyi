from typing import Any, Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from ._arrays import Floats, Integers
from ._periodic import Box

version: str

def end_threads() -> None: ...

class _Mesh:
    def __init__(
        self,
        points: Floats,
        threads: int,
        progress: Callable[[float], object] | None,
        periodic: Box | None = ...,
    ) -> None: ...
    @property
    def points(self) -> Floats: ...
    @property
    def cell_vertices(self) -> Integers: ...
    @property
    def cell_neighbours(self) -> Integers: ...
    @property
    def cell_offsets(self) -> NDArray[np.int8]: ...
    @property
    def periodic(self) -> Box | None: ...
    @property
    def hull_facets(self) -> Integers: ...
    @property
    def duplicates(self) -> Integers: ...
    @property
    def vertex_cells(self) -> Integers: ...
    def vertex_neighbours(self) -> tuple[Integers, Integers]: ...
    def circumcentres(self) -> Floats: ...
    def canonical_hash(self) -> int: ...
    def locate(self, places: Floats) -> Integers: ...
    def nearest_vertex(self, places: Floats) -> Integers: ...
    def interpolate(
        self, values: Floats, places: Floats
    ) -> Floats: ...

class Mesh2(_Mesh): ...
class Mesh3(_Mesh): ...
class Mesh4(_Mesh): ...
class Mesh5(_Mesh): ...
class Mesh6(_Mesh): ...
class WideMesh2(_Mesh): ...
class WideMesh3(_Mesh): ...
class WideMesh4(_Mesh): ...
class WideMesh5(_Mesh): ...
class WideMesh6(_Mesh): ...

class Run:
    def __init__(
        self,
        memory: str,
        threads: int,
        scratch_folder: bytes,
        max_tmp: str,
        progress: Callable[[float], object] | None,
        explains: bool,
    ) -> None: ...

class PointOptions:
    dimension: int
    format: str
    columns: list[int]
    column_names: list[str]
    characters: list[tuple[int, int]]
    skip_lines: int
    separator: str
    decimal: str
    no_header: bool
    skip_invalid: bool
    max_expansion: int
    salvage: bool
    skip_broken: bool
    keep_withheld: bool
    every: int
    classes: list[int]
    other_classes: list[int]
    resolution: float
    crs: str
    foreign_crs: bool
    clip: bytes
    clip_buffer: float
    clip_outside: bool
    z_range: tuple[float, float] | None
    to_crs: str
    z_multiplier: float
    metadata: bool
    attributes: list[str]
    def set_returns(self, first: bool, last: bool, single: bool, numbers: list[int]) -> None: ...
    def set_bounds(self, low: list[float], high: list[float]) -> None: ...
    def set_thin(self, cell: float, choice: str) -> None: ...

class MeshFileOptions:
    format: str
    attributes: list[str] | None
    tile_side: float
    tile_polygons: bytes
    clip: bytes
    clip_buffer: float
    clip_outside: bool
    foreign_crs: bool

class MeshOptions:
    format: str
    crs: str
    foreign_crs: bool
    max_expansion: int

class PointFileOptions:
    output_format: str
    las_version: str
    scale: list[float]
    offset: list[float]
    exact: bool
    attributes: list[str] | None
    force: bool
    def set_sorted(self, dimension: int, cell_points: int) -> None: ...

class TriangulateOptions:
    dimension: int
    heights: str
    max_edge: float | None
    input_index: bool
    tile_points: int
    leaf_points: int
    division: str
    children: int
    trust_headers: bool
    resume_folder: bytes | str
    checkpoint_seconds: float
    kernel: str
    periodic: Box | None

class DemOptions:
    products: list[str]
    @property
    def traits(self) -> set[str]: ...
    resolution: float
    bounds: tuple[float, float, float, float] | None
    align: bool
    force_size: bool
    like: bytes | str
    foreign_crs: bool
    gradient: str
    compute_edges: bool
    fill_voids: bool
    azimuth: float
    altitude: float
    z_factor: float | None
    max_edge: float | None
    nodata: float
    type: str
    compress: str
    cog: bool
    clip: bytes
    clip_buffer: float
    clip_outside: bool

class VolumeOptions:
    max_edge: float | None
    z_factor: float | None
    foreign_crs: bool

class DensityOptions:
    weight: str
    cells: Sequence[int]
    def set_grid_box(self, low: Sequence[float], high: Sequence[float]) -> None: ...

class HeightOptions:
    replace_z: bool
    min_height: float | None
    max_height: float | None
    nodata: float
    foreign_crs: bool

class ContourOptions:
    interval: float
    base: float
    levels: list[float]
    foreign_crs: bool
    max_edge: float | None
    index: int
    min_length: float | None
    smooth: float | None
    simplify: float | None
    bands: bool
    tile_side: float
    tile_polygons: bytes

class PictureOptions:
    size: int | None
    triangles: int | None
    color: str
    ramp: str
    legend: bool
    scale_bar: bool
    world_file: bool
    zoom: tuple[float, float, float, float] | None
    wireframe: bool
    exaggerate: float | None
    view: tuple[float, float] | None
    light: tuple[float, float] | None
    shadows: bool
    transparent: bool
    max_edge: float | None
    def set_slice(self, axis: str, value: float) -> None: ...

class GenerateOptions:
    family: str
    count: int
    dim: int
    seed: int

class GridOptions:
    overlap: float
    output_format: str
    las_version: str
    def set_grid(self, columns: int, rows: int) -> None: ...

_Inputs = list[bytes] | Floats
_Figures = dict[str, Any]

class MeshOrigin:
    def __init__(
        self,
        inputs: _Inputs | bytes,
        options: PointOptions | MeshOptions,
        how: TriangulateOptions = ...,
        attributes: dict[str, NDArray[Any]] = ...,
        ground_classes: list[int] = ...,
    ) -> None: ...

def is_mesh(run: Run, inputs: _Inputs, mesh_format: str, point_format: str) -> bool: ...
def mesh(run: Run, origin: MeshOrigin, output: bytes, options: MeshFileOptions) -> _Figures: ...
def dem(run: Run, origin: MeshOrigin, output: bytes, options: DemOptions) -> _Figures: ...
def dem_in_memory(
    run: Run, origin: MeshOrigin, options: DemOptions
) -> tuple[_Figures, NDArray[np.float32], str]: ...
def heights(
    run: Run,
    inputs: _Inputs,
    options: PointOptions,
    attributes: dict[str, NDArray[Any]],
    ground: MeshOrigin,
    how: HeightOptions,
    output: bytes,
    written: PointFileOptions,
) -> _Figures: ...
def heights_in_memory(
    run: Run, inputs: _Inputs, options: PointOptions, ground: MeshOrigin, how: HeightOptions
) -> tuple[_Figures, NDArray[np.float64]]: ...
def volume_between(
    run: Run, first: MeshOrigin, second: MeshOrigin, how: VolumeOptions
) -> _Figures: ...
def volume_above(run: Run, surface: MeshOrigin, level: float, how: VolumeOptions) -> _Figures: ...
def density(
    run: Run, points: MeshOrigin, path: bytes, options: DensityOptions
) -> _Figures: ...
def contours(run: Run, origin: MeshOrigin, output: bytes, options: ContourOptions) -> _Figures: ...
def picture(run: Run, origin: MeshOrigin, output: bytes, options: PictureOptions) -> _Figures: ...
def convert_points(
    run: Run,
    inputs: _Inputs,
    options: PointOptions,
    output: bytes,
    how: PointFileOptions,
    attributes: dict[str, NDArray[Any]],
) -> _Figures: ...
def read_points(
    run: Run, inputs: _Inputs, options: PointOptions
) -> tuple[Floats, dict[str, NDArray[Any]]]: ...
def generate(
    run: Run, options: GenerateOptions, output: bytes, how: PointFileOptions
) -> _Figures: ...
def generate_survey(
    run: Run, options: GenerateOptions, output: bytes, grid: GridOptions
) -> _Figures: ...
def generate_in_memory(run: Run, options: GenerateOptions) -> Floats: ...
def points_info(run: Run, path: bytes, options: PointOptions, fast: bool) -> _Figures: ...
def mesh_info(run: Run, path: bytes, options: MeshOptions) -> _Figures: ...
def check(
    run: Run,
    path: bytes,
    options: MeshOptions,
    any_delaunay: bool,
    points: _Inputs | None,
    point_options: PointOptions,
) -> _Figures: ...

class BlockStream:
    def __init__(self, run: Run, origin: MeshOrigin, attributes: list[str]) -> None: ...
    def next(
        self,
    ) -> (
        tuple[
            int,
            Floats,
            NDArray[np.int64],
            NDArray[np.int64],
            NDArray[np.int64] | None,
            dict[str, NDArray[Any]],
            NDArray[np.int8] | None,
        ]
        | None
    ): ...
    def close(self) -> None: ...
    @property
    def periodic(self) -> Box | None: ...
    @property
    def report(self) -> _Figures | None: ...
