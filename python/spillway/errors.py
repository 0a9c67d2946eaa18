"""The exceptions of Spillway: `Error`, one class for each of its codes, and `Warning`."""

from __future__ import annotations

from typing import Any

__all__ = [
    "BadInputError",
    "ClosedPipeError",
    "DegenerateInputError",
    "Error",
    "InputOutputError",
    "InterruptedRunError",
    "InvalidArgumentError",
    "OutOfBudgetError",
    "TooLargeError",
    "Warning",
]


class Error(Exception):
    """What Spillway raises by itself. Its text says what is wrong, where, and what to do.

    Attributes
    ----------
    code : str
        The kind of fault, as ``"degenerate input"``.
    file : str or None
        The file at fault.
    place : (str, int) or None
        Where in it: ``("line", 3)``, ``("byte", 227)`` or ``("record", 12)``.
    """

    code = ""
    file: str | None = None
    place: tuple[str, int] | None = None

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


class InvalidArgumentError(Error, ValueError):
    """An argument that no call could use, as a coordinate that is not finite."""

    code = "invalid argument"


class DegenerateInputError(Error, ValueError):
    """Points that span no triangle (tetrahedron): too few, or all on one line (plane)."""

    code = "degenerate input"


class TooLargeError(Error, ValueError):
    """More points or simplices than can be numbered."""

    code = "too large"


class InterruptedRunError(Error):
    """A run that was asked to stop. Ctrl-C raises KeyboardInterrupt instead."""

    code = "interrupted"


class BadInputError(Error, ValueError):
    """A file, or what it says, is not what it should be."""

    code = "bad input"


class InputOutputError(Error, OSError):
    """The system refuses to read, to write or to create something."""

    code = "input or output"

    def __reduce__(self) -> tuple[Any, ...]:
        # OSError leaves out what was set after it was made.
        kind, text = type(self), str(self)
        return kind, (text,), {**vars(self), "errno": self.errno, "filename": self.filename}


class OutOfBudgetError(Error, MemoryError):
    """A limit of the caller's does not suffice: of memory, of scratch files."""

    code = "out of budget"


class ClosedPipeError(Error, BrokenPipeError):
    """The reader of the output has closed its end of the pipe."""

    code = "closed pipe"


class Warning(UserWarning):
    """What a run finds worth a warning: its result is as it should be, but perhaps not as wanted."""


_CLASSES = {kind.code: kind for kind in Error.__subclasses__()}


def make_error(
    code: str,
    message: str,
    file: str = "",
    unit: str = "",
    number: int = 0,
    system_error: int = 0,
) -> Error:
    """The exception for an error of the library. The extension module calls it."""
    error = _CLASSES[code](message)
    error.file = file or None
    error.place = (unit, number) if unit else None
    if isinstance(error, OSError) and system_error:
        error.errno, error.filename = system_error, file or None
    return error
