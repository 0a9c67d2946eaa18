"""Exact Delaunay triangulations of huge point sets, in the plane and in space.

>>> import numpy as np, spillway
>>> tri = spillway.Delaunay(np.random.default_rng(1).random((1000, 2)))
>>> tri.simplices.shape[1]
3
"""

import os as _os

from . import _spillway
from ._blocks import Block, Blocks, blocks
from ._delaunay import Delaunay
from ._densities import density
from ._files import check, convert, generate, info, read_points, triangulate
from ._heights import height
from ._products import Raster, contour, dem, render
from ._reports import (
    CheckReport,
    ContourReport,
    ConvertReport,
    DensityReport,
    GenerateReport,
    HeightReport,
    MeshInfo,
    PictureReport,
    PointsInfo,
    RasterReport,
    RunReport,
    VolumeReport,
)
from ._volumes import volume
from .errors import Error, Warning

__all__ = [
    "Block",
    "Blocks",
    "CheckReport",
    "ContourReport",
    "ConvertReport",
    "Delaunay",
    "DensityReport",
    "Error",
    "GenerateReport",
    "HeightReport",
    "MeshInfo",
    "PictureReport",
    "PointsInfo",
    "Raster",
    "RasterReport",
    "RunReport",
    "Warning",
    "__version__",
    "blocks",
    "check",
    "contour",
    "convert",
    "dem",
    "density",
    "generate",
    "height",
    "info",
    "read_points",
    "render",
    "triangulate",
    "volume",
]
__version__: str = _spillway.version

# A child of fork() has none of its parent's threads, so the library must not count on any.
if hasattr(_os, "register_at_fork"):
    _os.register_at_fork(before=_spillway.end_threads)
