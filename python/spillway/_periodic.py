"""Boxes that points repeat with."""

from __future__ import annotations

from typing import Any, Tuple

import numpy as np

from .errors import InvalidArgumentError

Box = Tuple["tuple[float, ...]", "tuple[float, ...]", "tuple[bool, ...]"]
"""The lower and the upper sides, and whether each axis is periodic, three each."""


def as_periodic_box(periodic: Any, ndim: int) -> Box:
    """A box of ``(low, high)``, where None stands for the sides of an open axis, or one from 0 of a
    period or of one along each axis, where 0 stands for an open axis."""
    if ndim > 3:
        raise InvalidArgumentError(f"periodic boxes have 2 or 3 dimensions, not {ndim}")
    if isinstance(periodic, (str, bytes)):
        raise TypeError(f"periodic is {periodic!r}; give a box or its periods")
    if np.ndim(_without_none(periodic)) == 0:
        periodic = [periodic] * ndim
    sides = list(periodic)
    if not any(np.ndim(_without_none(side)) for side in sides):
        _check_length(sides, ndim, "periods")
        for period in sides:
            if period is not None and not float(period) >= 0:
                raise InvalidArgumentError(f"periodic has the period {period}; give one above 0")
        high = [period or None for period in sides]
        low = [None if side is None else 0.0 for side in high]
    else:
        if len(sides) != 2:
            raise InvalidArgumentError(
                f"periodic has {len(sides)} corners; give the lower and the upper one"
            )
        low, high = (list(corner) for corner in sides)
        for corner in (low, high):
            _check_length(corner, ndim, "coordinates in a corner")
    flags = []
    for axis, (least, most) in enumerate(zip(low, high)):
        if (least is None) != (most is None):
            raise InvalidArgumentError(
                f"periodic has one side along {'xyz'[axis]}; give both, or None for both"
            )
        flags.append(least is not None)
    rest = 3 - ndim
    return (
        tuple([0.0 if side is None else float(side) for side in low] + [0.0] * rest),
        tuple([0.0 if side is None else float(side) for side in high] + [0.0] * rest),
        tuple(flags + [True] * rest),
    )


def _without_none(value: Any) -> Any:
    """For numpy.ndim: None is a number that is not told."""
    if value is None:
        return 0
    if isinstance(value, (list, tuple)):
        return [_without_none(part) for part in value]
    return value


def _check_length(sides: list[Any], ndim: int, what: str) -> None:
    if len(sides) != ndim:
        raise InvalidArgumentError(f"periodic has {len(sides)} {what}; give {ndim}")


def corners_of_box(box: Box | None, ndim: int) -> Any:
    """The box as ``(low, high)``, with None for open axes; None for none."""
    if box is None:
        return None
    low, high, flags = box
    return (
        tuple(side if flag else None for side, flag in zip(low[:ndim], flags)),
        tuple(side if flag else None for side, flag in zip(high[:ndim], flags)),
    )
