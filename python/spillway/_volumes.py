"""Volumes between surfaces, and above a level: `volume`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import _spillway
from ._inputs import mesh_origin
from ._messages import tell
from ._options import TriangulateOptions, make_run, put_all, refuse, takes
from ._reports import VolumeReport
from .errors import InvalidArgumentError

if TYPE_CHECKING:
    from typing_extensions import Unpack


@takes(TriangulateOptions)
def volume(
    first: Any,
    second: Any = None,
    *,
    level: float | None = None,
    z_factor: float | None = None,
    mesh_format: str | None = None,
    **options: Unpack[TriangulateOptions],
) -> VolumeReport:
    """Measure cut and fill between two surfaces, or above and below a level.

    As ``spillway volume``: a sum over the overlay of both triangulations, which is not sampled.

    Parameters
    ----------
    first : path, sequence of paths, or array_like of shape (n, 3)
        Points, as `triangulate` takes them, or one file of a mesh of triangles.
    second : path, sequence of paths, or array_like of shape (n, 3), optional
        Likewise, the surface that the first one is compared with.
    level : float, optional
        A height in place of the second surface.
    z_factor : float, optional
        Multiply heights by this, to have the unit of x and y. By default as units tell.
    mesh_format : str, optional
        Format of a mesh, where neither first bytes nor name tell.
    {options}

    Returns
    -------
    VolumeReport
        Volumes in cubes, and areas in squares, of the unit of x and y.

    Raises
    ------
    spillway.Error
        As `triangulate`.
    """
    if (second is None) == (level is None):
        raise InvalidArgumentError("what does the surface lie above? Give a second one, or level")
    how = _spillway.VolumeOptions()
    put_all(how, {"z_factor": z_factor, "max_edge": options.get("max_edge")})
    how.foreign_crs = bool(options.get("force_crs"))
    run = make_run(options)
    surface = mesh_origin(run, first, 2, mesh_format, options)
    if second is None:
        return VolumeReport(**_spillway.volume_above(run, surface, level, how))
    once = ["resume", "checkpoint_every"]
    refuse(options, once, "with two surfaces, which are two runs")
    other = mesh_origin(run, second, 2, mesh_format, options)
    report = VolumeReport(**_spillway.volume_between(run, surface, other, how))
    if report.area == 0:
        tell(True, "the surfaces have no area in common")
    return report
