"""What runs say beside their results: warnings of Python, and what explains them to the log."""

from __future__ import annotations

import logging
import sys
import warnings
from typing import TYPE_CHECKING, TypeVar

from . import errors

if TYPE_CHECKING:
    from ._reports import RunReport

_Report = TypeVar("_Report", bound="RunReport")

_log = logging.getLogger("spillway")


def tell(is_warning: bool, text: str) -> None:
    """Pass on a message of a run. The extension module calls it, in the thread that called it."""
    if is_warning:
        warnings.warn(text, errors.Warning, stacklevel=_levels_to_the_caller())
    else:
        _log.info("%s", text)


def warn_of_tiles(report: _Report) -> _Report:
    """Warn of what lies in no tile, and of files that are called like tiles; return the report."""
    if report.outside_tiles > 0:
        tell(True, f"{report.outside_tiles} parts are in none of the tiles, and in no file")
    if report.outside_vertices > 0:
        tell(
            True,
            f"{report.outside_vertices} vertices belong to no simplex of a tile, and are in no file",
        )
    if report.other_files:
        tell(
            True,
            f"{', '.join(report.other_files)}: called like tiles of this run, which has not "
            "written them",
        )
    return report


def is_explained() -> bool:
    """Whether anybody reads what explains a run."""
    return _log.isEnabledFor(logging.INFO)


def _levels_to_the_caller() -> int:
    """How far up the stack the call of this package is, as `warnings.warn` counts in `tell`."""
    level = 1
    frame = sys._getframe(1)
    while frame.f_back is not None and str(frame.f_globals.get("__name__")).startswith("spillway."):
        frame = frame.f_back
        level += 1
    return level
