"""Options that several functions have: their types, their docstrings, and the way to the library.

A function takes them as ``**options: Unpack[...]`` and is decorated by `takes`, which refuses other
names and shows the options in its signature and docstring.
"""

from __future__ import annotations

import dataclasses
import difflib
import functools
import inspect
import numbers
import operator
import os
import pathlib
import re
import textwrap
from typing import Any, Callable, Iterable, Mapping, Sequence, TypedDict, TypeVar, Union

from . import _spillway
from ._arrays import as_thread_count
from ._messages import is_explained
from ._periodic import as_periodic_box
from .errors import Error, InvalidArgumentError

PATHS = (str, bytes, os.PathLike)
PathLike = Union[str, bytes, "os.PathLike[str]", "os.PathLike[bytes]"]
_Function = TypeVar("_Function", bound=Callable[..., Any])


class RunOptions(TypedDict, total=False):
    """What a run may take, and who is told how far it is."""

    memory: int | str | None
    threads: int | None
    scratch_folder: PathLike | None
    max_tmp: int | str | None
    progress: Callable[[float], object] | None


class FilterOptions(TypedDict, total=False):
    """How point files are read, and which of their points."""

    input_format: str | None
    columns: Sequence[int] | Sequence[str] | None
    skip_lines: int | None
    separator: str | None
    decimal: str | None
    header: bool
    skip_invalid: bool
    max_expansion: int
    salvage: bool
    keep_withheld: bool
    every: int | None
    keep_class: int | Iterable[int] | None
    drop_class: int | Iterable[int] | None
    returns: int | str | Iterable[int | str] | None
    where: str | None
    thin: float | tuple[float, str] | None
    z_range: tuple[float, float] | None
    clip: PathLike | None
    clip_buffer: float | None
    clip_outside: bool
    to_crs: str | os.PathLike[str] | None
    multiply_z: float | None


class PlaceOptions(TypedDict, total=False):
    """Filters by place, where a function has no other meaning for these words."""

    bounds: Sequence[float] | None
    resolution: float | None


class JoinOptions(TypedDict, total=False):
    """How files become one: their coordinate systems, and those that cannot be read."""

    crs: str | os.PathLike[str] | None
    force_crs: bool
    skip_broken: bool


class DivisionOptions(TypedDict, total=False):
    """How points are triangulated."""

    heights: str | None
    max_edge: float | None
    trust_headers: bool
    tile_points: int | None
    leaf_points: int | None
    division: str | None
    children: int | None
    kernel: str | None
    resume: PathLike | None
    checkpoint_every: float | None


class ConvertOptions(FilterOptions, PlaceOptions, JoinOptions, RunOptions, total=False):
    """Of points that are read."""


class InfoOptions(FilterOptions, PlaceOptions, RunOptions, total=False):
    """Of points that are read, each file by itself; `max_expansion` also of a mesh."""


class CheckOptions(FilterOptions, PlaceOptions, RunOptions, total=False):
    """Of points that a mesh is compared with; `max_expansion` also of the mesh."""

    force_crs: bool


class ClipOptions(TypedDict, total=False):
    """Filters by place, where `bounds` and `resolution` are those of a raster."""

    clip_bounds: Sequence[float] | None


class DemOptions(
    DivisionOptions, FilterOptions, ClipOptions, JoinOptions, RunOptions, total=False
):
    """Of points that become a raster."""


class TriangulateOptions(
    DivisionOptions, FilterOptions, PlaceOptions, JoinOptions, RunOptions, total=False
):
    """Of points that are triangulated."""


class RepeatingOptions(TriangulateOptions, total=False):
    """Of points that are triangulated to a mesh, which may be periodic."""

    periodic: Any


@dataclasses.dataclass(frozen=True)
class _Option:
    kind: str
    text: str
    target: str = "run"
    """What has it: "run", "points" or "division"."""
    put: Callable[[Any, Any], None] | None = None
    """Sets it there."""


def attribute(
    name: str, convert: Callable[[Any], Any] = lambda value: value
) -> Callable[[Any, Any], None]:
    """What sets an attribute to a value that is converted, for `put`."""
    return lambda target, value: setattr(target, name, convert(value))


def _put_box(name: str, target: Any, value: Any) -> None:
    box = as_reals(value)
    if len(box) not in (4, 6):
        raise InvalidArgumentError(
            f"{name} has {len(box)} numbers; give xmin, ymin, xmax, ymax or xmin, ymin, zmin, "
            "xmax, ymax, zmax"
        )
    half = len(box) // 2
    endless = [float("inf")] * (3 - half)
    low, high = box[:half] + [-x for x in endless], box[half:] + endless
    if not all(least <= most for least, most in zip(low, high)):
        raise InvalidArgumentError(f"{name} has a least coordinate above the most: {box}")
    target.set_bounds(low, high)


def _put_thin(target: Any, value: Any) -> None:
    cell, choice = value if isinstance(value, tuple) else (value, "first")
    target.set_thin(cell, choice)


def _put_returns(target: Any, value: Any) -> None:
    wanted = [value] if isinstance(value, (str, int)) else list(value)
    words = [word for word in wanted if isinstance(word, str)]
    for word in words:
        if word not in ("first", "last", "single"):
            raise InvalidArgumentError(
                f'returns has "{word}"; give "first", "last", "single" and numbers from 1 to 15'
            )
    counted = [operator.index(number) for number in wanted if not isinstance(number, str)]
    target.set_returns("first" in words, "last" in words, "single" in words, counted)


def _put_columns(target: Any, value: Any) -> None:
    if isinstance(value, str):
        raise InvalidArgumentError(f"columns is {value!r}; give the columns one by one")
    columns = list(value)
    if columns and all(isinstance(column, str) for column in columns):
        target.column_names = columns
    elif columns and all(isinstance(column, Sequence) for column in columns):
        target.characters = [tuple(_as_list(ends)) for ends in columns]
    else:
        target.columns = _as_list(columns)


def _as_list(value: Any) -> list[int]:
    return [operator.index(n) for n in (value if isinstance(value, Iterable) else [value])]


def as_reals(values: Any) -> list[float]:
    """Numbers as floats. Raises TypeError for a text, of which each letter would be one."""
    if isinstance(values, (str, bytes)):
        raise TypeError(f"{values!r} is a text")
    return [float(value) for value in values]


def as_path(path: Any, name: str) -> bytes:
    """A path as bytes."""
    if not isinstance(path, PATHS):
        raise TypeError(f"{name} is of type {type(path).__name__}; give a path")
    made = os.fsencode(path)
    if not made:
        raise InvalidArgumentError(f"{name} is empty; give a path")
    if b"\0" in made:
        raise InvalidArgumentError(f"{name} is {path!r}; no path has a null character in it")
    return made


def as_word(word: Any, name: str) -> str:
    """A word; empty for None."""
    if word is not None and not isinstance(word, str):
        raise TypeError(f"{name} is {word!r}; give str")
    return word or ""


def as_names(names: str | Sequence[str] | None, name: str) -> list[str]:
    """A word or several; none for None."""
    if names is None:
        return []
    return [as_word(word, name) for word in ([names] if isinstance(names, str) else names)]


def as_crs(crs: Any) -> str:
    """A coordinate system as text; a path stands for what is in the file."""
    if not isinstance(crs, os.PathLike):
        return "" if crs is None else str(crs)
    return " ".join(pathlib.Path(crs).read_text(encoding="utf-8").splitlines()).strip()


put_classes = attribute("classes", _as_list)
"""Sets the classes of points that are read, for `put`."""

_OPTIONS = {
    "memory": _Option(
        "int or str, optional",
        'Memory to keep to, in bytes or as ``"512M"`` or ``"2G"``: 32M at least, for tetrahedra 96M,'
        " for rasters and pictures 64M. By default a quarter of the machine's, 2G at most.",
    ),
    "threads": _Option(
        "int, optional",
        "The most threads to use. By default all that the process may use. The result does not "
        "depend on it.",
    ),
    "scratch_folder": _Option(
        "path, optional",
        "Where scratch files go that do not fit into memory. By default ``$TMPDIR``, else ``/tmp``.",
    ),
    "max_tmp": _Option(
        "int or str, optional", "Most that may lie there at a time. By default no limit."
    ),
    "progress": _Option(
        "callable, optional",
        "Told from time to time the fraction that is done, from 0 to 1, the last time with 1, in "
        "the thread of the caller. What it raises ends the run.",
    ),
    "input_format": _Option(
        "str, optional",
        'Format of the points, where neither first bytes nor name tell: ``"las"``, ``"laz"``, '
        '``"copc"``, ``"text"``, ``"npy"``, ``"ply"``, ``"pcd"``, ``"spp"`` or ``"raster"``.',
        "points",
        attribute("format"),
    ),
    "columns": _Option(
        "sequence of int, of str or of pairs of int, optional",
        "Of text, the columns of x, y and z, counted from 1, or their names, or the first and the "
        "last character of each in a line, counted from 1.",
        "points",
        _put_columns,
    ),
    "skip_lines": _Option(
        "int, optional",
        "Of text, leave out so many lines at the top.",
        "points",
        attribute("skip_lines"),
    ),
    "separator": _Option(
        "str, optional",
        'Of text, what separates columns: ``","``, ``";"``, a tab or a blank, for any blanks.',
        "points",
        attribute("separator"),
    ),
    "decimal": _Option(
        "str, optional",
        'Of text, the decimal sign, ``"."`` or ``","``.',
        "points",
        attribute("decimal"),
    ),
    "header": _Option(
        "bool, optional",
        "Of text, whether its first line or a comment may name the columns. By default it may.",
        "points",
        attribute("no_header", operator.not_),
    ),
    "skip_invalid": _Option(
        "bool, optional",
        "Leave out rows of text, npy, PLY and PCD that are no points. By default they are an error.",
        "points",
        attribute("skip_invalid"),
    ),
    "max_expansion": _Option(
        "int, optional",
        "Of compressed text and blocks of VTU, most bytes for each compressed one; a file that expands "
        "to more is an error. By default 2000.",
        "points",
        attribute("max_expansion"),
    ),
    "salvage": _Option(
        "bool, optional",
        "Use the points that are whole of LAS and LAZ files that are cut off or damaged, with a "
        "warning that counts the others. By default such a file is an error.",
        "points",
        attribute("salvage"),
    ),
    "skip_broken": _Option(
        "bool, optional",
        "Leave out files that cannot be opened, or whose headers are broken, and name them in the "
        "figures as `skipped_files`. By default they are an error.",
        "points",
        attribute("skip_broken"),
    ),
    "keep_withheld": _Option(
        "bool, optional",
        "Use points that LAS files flag as withheld, too.",
        "points",
        attribute("keep_withheld"),
    ),
    "every": _Option(
        "int, optional",
        "Use records 0, n, 2n, ... of each file.",
        "points",
        attribute("every"),
    ),
    "keep_class": _Option(
        "int or iterable of int, optional",
        "Use points of these classes only.",
        "points",
        put_classes,
    ),
    "drop_class": _Option(
        "int or iterable of int, optional",
        "Leave out points of these classes.",
        "points",
        attribute("other_classes", _as_list),
    ),
    "returns": _Option(
        "int, str or iterable of these, optional",
        'Use these returns of a pulse: ``"first"``, ``"last"``, ``"single"`` and numbers.',
        "points",
        _put_returns,
    ),
    "where": _Option(
        "str, optional",
        'Use points of which this holds: ``"intensity > 200 and class in (2, 9)"``.',
        "points",
        attribute("where"),
    ),
    "thin": _Option(
        "float or (float, str), optional",
        "Use one point of each cell of a grid with sides of this length: the first one, or as the "
        'word says ``"first"``, ``"lowest"``, ``"highest"`` or ``"center"``.',
        "points",
        _put_thin,
    ),
    "bounds": _Option(
        "sequence of float, optional",
        "Use points in xmin, ymin, xmax, ymax or xmin, ymin, zmin, xmax, ymax, zmax.",
        "points",
        functools.partial(_put_box, "bounds"),
    ),
    "clip_bounds": _Option(
        "sequence of float, optional",
        "Use points in xmin, ymin, xmax, ymax or xmin, ymin, zmin, xmax, ymax, zmax.",
        "points",
        functools.partial(_put_box, "clip_bounds"),
    ),
    "z_range": _Option(
        "(float, float), optional",
        "Use points with heights from the first to the second.",
        "points",
        attribute("z_range", as_reals),
    ),
    "clip": _Option(
        "path, optional",
        "Use points in the polygons of this vector file, of any format that GDAL reads.",
        "points",
        attribute("clip", functools.partial(as_path, name="clip")),
    ),
    "clip_buffer": _Option(
        "float, optional",
        "Use points up to this far from what `clip` has, lines and points, too; below 0: so far "
        "inside of its polygons.",
        "points",
        attribute("clip_buffer"),
    ),
    "clip_outside": _Option(
        "bool, optional",
        "Use the points that `clip` leaves out.",
        "points",
        attribute("clip_outside"),
    ),
    "to_crs": _Option(
        "str or path-like, optional",
        "Bring points to this coordinate system, before anything else is done with them.",
        "points",
        attribute("to_crs", as_crs),
    ),
    "multiply_z": _Option(
        "float, optional",
        "Multiply heights by this, after that.",
        "points",
        attribute("z_multiplier"),
    ),
    "resolution": _Option(
        "float, optional",
        "Of COPC files, read the levels that are needed for points so far apart.",
        "points",
        attribute("resolution"),
    ),
    "crs": _Option(
        "str or path-like, optional",
        'The coordinate system of inputs that name none: ``"EPSG:n"``, WKT, or a `pathlib.Path` of '
        "a file with WKT. Nothing is transformed.",
        "points",
        attribute("crs", as_crs),
    ),
    "force_crs": _Option(
        "bool, optional",
        "Use coordinates as they are, even if coordinate systems differ.",
        "points",
        attribute("foreign_crs"),
    ),
    "heights": _Option(
        "str, optional",
        'Which z a vertex of several points of equal x and y gets: ``"first"``, ``"lowest"``, '
        '``"highest"`` or ``"mean"``.',
        "division",
        attribute("heights"),
    ),
    "max_edge": _Option(
        "float, optional",
        "Leave out simplices with a longer edge.",
        "division",
        attribute("max_edge"),
    ),
    "trust_headers": _Option(
        "bool, optional",
        "If False, all points are read before any is triangulated, as headers may lie about their "
        "extent. By default True.",
        "division",
        attribute("trust_headers"),
    ),
    "tile_points": _Option(
        "int, optional",
        "Most points of a tile that is loaded at a time. By default chosen by the memory.",
        "division",
        attribute("tile_points"),
    ),
    "leaf_points": _Option(
        "int, optional",
        "Most points of a leaf, which one thread triangulates. By default chosen by number and "
        "memory.",
        "division",
        attribute("leaf_points"),
    ),
    "division": _Option(
        "str, optional",
        'Which axis the division of points cuts: ``"least-border"``, ``"longest"``, ``"cycling"`` '
        'or ``"constant"``.',
        "division",
        attribute("division"),
    ),
    "children": _Option(
        "int, optional",
        "Parts that are merged at a time, 2 to 1024.",
        "division",
        attribute("children"),
    ),
    "kernel": _Option(
        "str, optional",
        'What triangulates leaves: ``"spillway"`` or ``"cgal"``. Both give the same mesh.',
        "division",
        attribute("kernel"),
    ),
    "periodic": _Option(
        "box, float or sequence of float, optional",
        "The box that points repeat with, as ``((xmin, ymin), (xmax, ymax))`` or of three "
        "coordinates each, with None for both sides of an open axis; or its periods from 0, one for "
        "all axes or one for each. Points are brought into it, and the mesh has no boundary there.",
        "division",
        lambda target, value: setattr(
            target, "periodic", as_periodic_box(value, target.dimension)
        ),
    ),
    "resume": _Option(
        "path, optional",
        "A folder by which the run can go on if it is killed: the same call goes on from the last "
        "checkpoint there, and gives the same result. It is made, and removed when the run is "
        "complete. Not for arrays.",
        "division",
        attribute("resume_folder", lambda path: as_path(path, "resume")),
    ),
    "checkpoint_every": _Option(
        "float, optional",
        "Seconds between two checkpoints. By default 60; longer where checkpoints would take more "
        "than 2 % of the run.",
        "division",
        attribute("checkpoint_seconds"),
    ),
}


def takes(kind: Any) -> Callable[[_Function], _Function]:
    """A decorator for functions that take the options of a TypedDict: it checks their names, and
    puts them into the signature, and into the docstring in place of ``{options}``. Of a value of a
    wrong type it tells what the docstring says."""
    names = list(kind.__annotations__)

    def decorate(function: _Function) -> _Function:
        @functools.wraps(function)
        def checked(*args: Any, **given: Any) -> Any:
            given = _with_present_names(given)
            for name in given:
                if name not in known:
                    raise TypeError(_unexpected(function.__name__, name, known))
            try:
                return function(*args, **given)
            except _Unfit as fault:
                raise fault.told(kinds) from fault.__cause__

        signature = inspect.signature(function)
        own = [p for p in signature.parameters.values() if p.kind is not p.VAR_KEYWORD]
        own += [
            inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None) for name in names
        ]
        known = [p.name for p in own]
        checked.__signature__ = signature.replace(parameters=own)  # type: ignore[attr-defined]
        checked.__doc__ = (function.__doc__ or "").replace("    {options}\n", _described(names))
        kinds = _kinds(checked.__doc__)
        return checked  # type: ignore[return-value]

    return decorate


_FORMER_NAMES = {
    "base_case": "leaf_points",
    "distrust_headers": "trust_headers",
    "duplicates": "heights",
    "tile": "tile_points",
    "tmpdir": "scratch_folder",
}


def _with_present_names(given: Mapping[str, Any]) -> dict[str, Any]:
    """Options by the names they have now. Those of earlier versions go on working. Raises TypeError
    if one option is given by both."""
    named: dict[str, Any] = {}
    for name, value in given.items():
        present = _FORMER_NAMES.get(name, name)
        if present != name and present in given:
            raise TypeError(f"{name} is the former name of {present}; give one of them")
        named[present] = not value if name == "distrust_headers" else value
    return named


def _unexpected(function: str, name: str, known: list[str]) -> str:
    close = difflib.get_close_matches(name, known, 1)
    hint = f". Did you mean '{close[0]}'?" if close else ""
    return f"{function}() got an unexpected keyword argument '{name}'{hint}"


def _described(names: Iterable[str]) -> str:
    lines = []
    for name in names:
        lines.append(f"    {name} : {_OPTIONS[name].kind}\n")
        lines += [f"        {line}\n" for line in textwrap.wrap(_OPTIONS[name].text, 92)]
    return "".join(lines)


def _kinds(doc: str) -> dict[str, str]:
    """The kind of each parameter that a docstring describes."""
    kinds = {}
    for names, kind in re.findall(r"^    (\w+(?:, \w+)*) : (.+)$", doc, re.MULTILINE):
        kinds.update(dict.fromkeys(names.split(", "), kind.replace(", optional", "")))
    return kinds


class _Unfit(Exception):
    """A value that the library's option cannot have. `takes` tells the caller."""

    def __init__(self, name: str, value: Any) -> None:
        super().__init__(name, value)
        self.name, self.value = name, value

    def told(self, kinds: Mapping[str, str]) -> Exception:
        """The exception for callers of a function whose parameters are of these kinds."""
        kind = kinds[self.name]
        if isinstance(self.value, numbers.Integral) and re.search(r"\bint\b", kind):
            return InvalidArgumentError(f"{self.name} is {self.value}, which is out of range")
        return TypeError(f"{self.name} is {self.value!r}; give {kind}")


def put(target: Any, name: str, value: Any, setter: Callable[[Any, Any], None]) -> None:
    """Set an option of the library, in a function that is decorated by `takes`: this raises
    TypeError for a value of another type."""
    try:
        setter(target, value)
    except Error:
        raise
    except (TypeError, ValueError, OverflowError) as fault:
        raise _Unfit(name, value) from fault


def put_all(target: Any, values: Mapping[str, Any]) -> None:
    """Set attributes of the library's options, named as the arguments are, to the values that are
    not None."""
    for name, value in values.items():
        if value is not None:
            put(target, name, value, attribute(name))


def is_given(options: Mapping[str, Any], name: str) -> bool:
    """Whether an option asks for anything: headers are trusted unless they are not to be."""
    value = options.get(name)
    return value is not None and value is not (name in ("trust_headers", "header"))


def refuse(options: Mapping[str, Any], names: Iterable[str], where: str) -> None:
    """Raise InvalidArgumentError for options of these names, which have no effect there."""
    given = [name for name in names if is_given(options, name)]
    if given:
        verb, them = ("has", "it") if len(given) == 1 else ("have", "them")
        raise InvalidArgumentError(
            f"{', '.join(given)} {verb} no effect {where}: leave {them} out"
        )


def names_for(target: str) -> list[str]:
    """The names of the options that "points" or "division" have."""
    return [name for name, option in _OPTIONS.items() if option.target == target]


def names_for_points_alone() -> list[str]:
    """The names of the options of points that meshes do not have."""
    return [name for name in names_for("points") if name != "max_expansion"]


def _fill(target: Any, kind: str, options: Mapping[str, Any]) -> None:
    for name, option in _OPTIONS.items():
        if option.target == kind and option.put and is_given(options, name):
            put(target, name, options[name], option.put)


def point_options(options: Mapping[str, Any], dim: int) -> _spillway.PointOptions:
    """Which points are read, and how."""
    made = _spillway.PointOptions()
    made.dimension = dim
    _fill(made, "points", options)
    return made


def triangulate_options(options: Mapping[str, Any], dim: int) -> _spillway.TriangulateOptions:
    """How they are triangulated."""
    if not is_given(options, "resume"):
        refuse(options, ["checkpoint_every"], "without resume")
    made = _spillway.TriangulateOptions()
    made.dimension = dim
    _fill(made, "division", options)
    return made


def mesh_options(options: Mapping[str, Any], mesh_format: str | None) -> _spillway.MeshOptions:
    """How a file of a mesh is read."""
    made = _spillway.MeshOptions()
    made.format = as_word(mesh_format, "mesh_format")
    made.crs = as_crs(options.get("crs"))
    made.foreign_crs = bool(options.get("force_crs"))
    put_all(made, {"max_expansion": options.get("max_expansion")})
    return made


def put_tiles(
    target: _spillway.DemOptions | _spillway.ContourOptions | _spillway.MeshFileOptions,
    tiles: float | PathLike | None,
) -> None:
    """Put what an output is cut into: squares of a side, or polygons of a file."""
    if isinstance(tiles, (str, bytes, os.PathLike)):
        target.tile_polygons = as_path(tiles, "tiles")
    elif tiles is not None:
        if not tiles > 0:
            raise InvalidArgumentError(f"tiles is {tiles}; give a side above 0, or a file")
        put(target, "tiles", tiles, lambda made, side: setattr(made, "tile_side", side))


_CLIP = ("clip", "clip_buffer", "clip_outside")


def move_clip(
    target: _spillway.DemOptions | _spillway.MeshFileOptions, options: Mapping[str, Any]
) -> dict[str, Any]:
    """Put what is to be clipped by, which is not points; returns the other options."""
    if options.get("clip") is None:
        raise InvalidArgumentError("clip, the file of polygons, is missing")
    target.clip = as_path(options["clip"], "clip")
    put_all(target, {name: options.get(name) for name in _CLIP[1:]})
    target.foreign_crs = bool(options.get("force_crs"))
    return {name: value for name, value in options.items() if name not in _CLIP}


def mesh_file_options(
    output_format: str | None,
    attributes: str | Sequence[str] | None,
    tiles: float | PathLike | None,
    options: Mapping[str, Any],
) -> _spillway.MeshFileOptions:
    """How a file of a mesh is written."""
    made = _spillway.MeshFileOptions()
    made.format = as_word(output_format, "output_format")
    if attributes is not None:
        made.attributes = as_names(attributes, "attributes")
    put_tiles(made, tiles)
    made.foreign_crs = bool(options.get("force_crs"))
    return made


def make_run(options: Mapping[str, Any]) -> _spillway.Run:
    """The settings of a run."""
    progress = options.get("progress")
    if progress is not None and not callable(progress):
        raise TypeError(f"progress is {progress!r}; give a function that takes a fraction")
    scratch_folder = options.get("scratch_folder")
    return _spillway.Run(
        _as_size(options.get("memory"), "memory"),
        as_thread_count(options.get("threads")),
        b"" if scratch_folder is None else as_path(scratch_folder, "scratch_folder"),
        _as_size(options.get("max_tmp"), "max_tmp"),
        progress,
        is_explained(),
    )


def _as_size(size: Any, name: str) -> str:
    if size is None or isinstance(size, str):
        return size or ""
    try:
        return str(operator.index(size))
    except TypeError:
        raise TypeError(f'{name} is {size!r}; give a number of bytes, or a text as "512M"') from None
