"""What functions on files take: paths, or arrays of points."""

from __future__ import annotations

from typing import Any, Iterable, Mapping, Sequence

from numpy.typing import NDArray

from . import _spillway
from ._arrays import Floats, as_rows, attributes_of, fields_of, is_dimension, rows_of_fields
from ._options import (
    PATHS,
    as_path,
    as_word,
    mesh_options,
    names_for,
    names_for_points_alone,
    point_options,
    refuse,
    triangulate_options,
)
from .errors import InvalidArgumentError


def as_inputs(inputs: Any, name: str = "inputs") -> list[bytes] | Floats:
    """Paths as bytes, or rows of coordinates."""
    fields = fields_of(inputs)
    if fields is not None:
        return rows_of_fields(fields, name)
    if isinstance(inputs, PATHS):
        return [as_path(inputs, name)]
    if isinstance(inputs, (list, tuple)):
        if not inputs:
            raise InvalidArgumentError(f"{name} is empty; give paths, or an array of points")
        if any(isinstance(item, PATHS) for item in inputs):
            for item in inputs:
                if not isinstance(item, PATHS):
                    raise TypeError(
                        f"{name} has a path and {type(item).__name__}; give paths, or one array"
                    )
            return [as_path(item, name) for item in inputs]
    elif isinstance(inputs, Iterable) and not isinstance(inputs, Sequence):
        if not hasattr(inputs, "__array__") and not hasattr(inputs, "__array_interface__"):
            raise TypeError(
                f"{name} is of type {type(inputs).__name__}; give paths in a list, or an array"
            )
    return as_rows(inputs, name)


def as_dimension(
    dim: Any, inputs: list[bytes] | Floats, most: int = 6, name: str = "inputs"
) -> int:
    """The dimension of a triangulation of these inputs."""
    if not is_dimension(dim, most):
        raise InvalidArgumentError(f"dim is {dim!r}; give 2 {'or' if most == 3 else 'to'} {most}")
    if not isinstance(inputs, list):
        columns = inputs.shape[1]
        if dim != columns and (dim, columns) != (2, 3):
            raise InvalidArgumentError(
                f"dim is {dim}, but {name} has {columns} columns; give {dim} coordinates a point"
            )
    return int(dim)


def check_array(
    inputs: list[bytes] | Floats, options: Mapping[str, Any], *, keeps: tuple[str, ...] = ()
) -> None:
    """Refuse options of files where there is an array, but those that a mesh beside it has."""
    if not isinstance(inputs, list):
        allowed = {"crs", "force_crs", *keeps}
        of_files = [n for n in names_for("points") if n not in allowed]
        refuse(options, of_files, "on an array, of which NumPy selects rows")


def is_mesh(
    run: _spillway.Run,
    inputs: list[bytes] | Floats,
    mesh_format: str | None,
    options: Mapping[str, Any],
) -> bool:
    """Whether the inputs are one mesh."""
    point_format = as_word(options.get("input_format"), "input_format")
    if mesh_format and (point_format or not isinstance(inputs, list) or len(inputs) > 1):
        refuse({"mesh_format": mesh_format}, ["mesh_format"], "on these inputs, which are points")
    return _spillway.is_mesh(run, inputs, as_word(mesh_format, "mesh_format"), point_format)


def check_mesh_options(options: Mapping[str, Any], *, keeps: tuple[str, ...] = ()) -> None:
    """Refuse options of points where a mesh is read, but those that it keeps."""
    allowed = {"crs", "force_crs", "max_edge", *keeps}
    names = [n for n in [*names_for_points_alone(), *names_for("division"), "id"] if n not in allowed]
    refuse(options, names, "on a mesh")


def points_origin(
    inputs: list[bytes] | Floats,
    dim: int,
    options: Mapping[str, Any],
    id: bool,
    carried: dict[str, NDArray[Any]],
) -> _spillway.MeshOrigin:
    """A mesh that is made of points, and what these carry if they are an array."""
    check_array(inputs, options)
    if dim > 2:
        refuse(options, ["heights"], f"with dim={dim}, as it chooses a height")
    how = triangulate_options(options, dim)
    how.input_index = bool(id)
    return _spillway.MeshOrigin(inputs, point_options(options, dim), how, carried)


def mesh_origin(
    run: _spillway.Run,
    inputs: Any,
    dim: int,
    mesh_format: str | None,
    options: Mapping[str, Any],
    id: bool = False,
) -> _spillway.MeshOrigin:
    """A mesh that is made of points, or that is there."""
    source = as_inputs(inputs)
    dim = as_dimension(dim, source)
    if is_mesh(run, source, mesh_format, options):
        check_mesh_options({**options, "id": id})
        assert isinstance(source, list)
        return _spillway.MeshOrigin(source[0], mesh_options(options, mesh_format))
    return points_origin(source, dim, options, id, attributes_of(inputs, "inputs"))
