"""The exceptions of Spillway: `Error`, one class for each of its codes, and `Warning`."""

from __future__ import annotations

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
    """

    code = ""


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


class OutOfBudgetError(Error, MemoryError):
    """A limit of the caller's does not suffice: of memory, of scratch files."""

    code = "out of budget"


class ClosedPipeError(Error, BrokenPipeError):
    """The reader of the output has closed its end of the pipe."""

    code = "closed pipe"


class Warning(UserWarning):
    """What a run finds worth a warning: its result is as it should be, but perhaps not as wanted."""


_CLASSES = {kind.code: kind for kind in Error.__subclasses__()}


def make_error(code: str, message: str) -> Error:
    """The exception for a code of the library. The extension module calls it."""
    return _CLASSES[code](message)
