"""What users give, as arrays that the extension module takes: checked, and copied only if need be."""

from __future__ import annotations

import operator
from typing import Any, Mapping, TypeVar

import numpy as np
from numpy.typing import NDArray

from .errors import InvalidArgumentError

Floats = NDArray[np.float64]
Integers = NDArray[np.integer[Any]]
_Array = TypeVar("_Array", bound=NDArray[Any])

_MOST_EXACT_INTEGER = 2**53


def as_floats(numbers: Any, name: str) -> Floats:
    """Real numbers as an array of float64 in native byte order.

    Such an array is returned as it is, whatever its strides; others are converted. Raises
    InvalidArgumentError for what has no exact value as float64.
    """
    if _has_masked(numbers):
        raise InvalidArgumentError(f"{name} has masked elements; leave them out")
    try:
        array = np.asarray(numbers)
    except ValueError as fault:
        raise InvalidArgumentError(f"{name} is no array of numbers: {fault}") from fault
    if array.dtype == np.float64 and array.dtype.isnative:
        return array
    if array.dtype == object and array.ndim == 0:
        raise InvalidArgumentError(
            f"{name} is of type {type(numbers).__name__}; give an array of numbers"
        )
    if array.dtype.kind not in "iuf" or array.dtype.itemsize > 8:
        raise InvalidArgumentError(
            f"{name} has elements of type {array.dtype}; give real numbers of at most 64 bits, "
            "as float64"
        )
    if array.dtype.kind in "iu" and array.dtype.itemsize == 8 and array.size > 0:
        if max(int(array.max()), -int(array.min())) > _MOST_EXACT_INTEGER:
            raise InvalidArgumentError(
                f"{name} has integers beyond 2**53, which float64 does not hold exactly; "
                "subtract an offset from them"
            )
    return array.astype(np.float64)


def as_rows(points: Any, name: str) -> Floats:
    """Coordinates as rows of two to six."""
    array = as_floats(points, name)
    if array.ndim != 2 or not is_dimension(array.shape[1]):
        raise InvalidArgumentError(
            f"{name} has the shape {array.shape}; give rows of 2 to 6 coordinates, as (n, 2)"
        )
    return array


def fields_of(points: Any) -> Mapping[str, Any] | None:
    """What a structured array, or a dict of arrays, has by name; None for others."""
    if isinstance(points, Mapping):
        return points
    if isinstance(points, np.ndarray) and points.dtype.names is not None:
        return {name: points[name] for name in points.dtype.names}
    return None


def rows_of_fields(fields: Mapping[str, Any], name: str) -> Floats:
    """The fields x, y and, if there is one, z as rows of coordinates."""
    missing = [axis for axis in "xy" if axis not in fields]
    if missing:
        raise InvalidArgumentError(
            f"{name} has no field {missing[0]}; give x, y and, where there are heights, z"
        )
    columns = [as_floats(fields[axis], f"{name}[{axis!r}]") for axis in "xyz" if axis in fields]
    if any(column.ndim != 1 or len(column) != len(columns[0]) for column in columns):
        raise InvalidArgumentError(
            f"{name} has coordinates of the shapes {[column.shape for column in columns]}; give "
            "one number a point"
        )
    return np.column_stack(columns)


def attributes_of(points: Any, name: str) -> dict[str, NDArray[Any]]:
    """What points carry besides x, y and z, by name."""
    fields = fields_of(points) or {}
    return {
        field: _as_attribute(values, f"{name}[{field!r}]", len(fields["x"]))
        for field, values in fields.items()
        if field not in ("x", "y", "z")
    }


def _as_attribute(values: Any, name: str, count: int) -> NDArray[Any]:
    if _has_masked(values):
        raise InvalidArgumentError(f"{name} has masked elements; leave them out")
    array = np.asarray(values)
    if array.dtype == bool:
        array = array.astype(np.uint8)
    if array.dtype.kind not in "iuf" or array.dtype.itemsize not in (1, 2, 4, 8):
        raise InvalidArgumentError(
            f"{name} has elements of type {array.dtype}; give integers or float32 or float64"
        )
    if array.dtype == np.float16:
        array = array.astype(np.float32)
    if array.ndim not in (1, 2) or len(array) != count:
        raise InvalidArgumentError(
            f"{name} has the shape {array.shape}; give a row for each of the {count} points"
        )
    return array.astype(array.dtype.newbyteorder("="), copy=False)


def as_points(points: Any, dim: int | None) -> tuple[Floats, Floats | None]:
    """Coordinates as rows of two to six, and the heights that points in the plane carry."""
    array = as_rows(points, "points")
    if dim is not None and not is_dimension(dim):
        raise InvalidArgumentError(f"dim is {dim!r}; give 2 to 6 or None")
    columns = array.shape[1]
    if dim is None or dim == columns:
        return array, None
    if (dim, columns) != (2, 3):
        raise InvalidArgumentError(
            f"dim is {dim}, but points has {columns} columns; give {dim} coordinates a point"
        )
    z = np.array(array[:, 2])
    bad = np.flatnonzero(~np.isfinite(z))
    if bad.size > 0:
        raise InvalidArgumentError(f"point {bad[0]} has a z that is not finite: {z[bad[0]]}")
    return array[:, :2], frozen(z)


def is_dimension(dim: Any, most: int = 6) -> bool:
    """Whether this is 2, 3, ... or the most."""
    return np.ndim(dim) == 0 and dim in range(2, most + 1)


def as_places(places: Any, ndim: int) -> Floats:
    """Coordinates of places, in the shape (..., ndim)."""
    array = as_floats(places, "xi")
    if array.ndim == 0 or array.shape[-1] != ndim:
        raise InvalidArgumentError(
            f"xi has the shape {array.shape}; its last axis must have {ndim} coordinates"
        )
    return array


def as_thread_count(threads: Any) -> int:
    """A number of threads; 0 stands for as many as the process may use."""
    if threads is None:
        return 0
    try:
        count = operator.index(threads)
    except TypeError:
        raise TypeError(f"threads is {threads!r}; give an int, or None for all") from None
    if count < 1 or count > 4096:
        raise InvalidArgumentError(f"threads is {count}; give 1 to 4096, or None for all")
    return count


def _has_masked(numbers: Any) -> bool:
    """Whether an array hides some of its elements, or a list has such rows."""
    parts = numbers if isinstance(numbers, (list, tuple)) else [numbers]
    return any(isinstance(part, np.ma.MaskedArray) and np.any(part.mask) for part in parts)


def frozen(array: _Array) -> _Array:
    """The array, made read-only."""
    array.flags.writeable = False
    return array
