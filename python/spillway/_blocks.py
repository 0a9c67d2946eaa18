"""`blocks`: a mesh larger than memory, block by block."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any, Iterator, NamedTuple, Sequence

import numpy as np
from numpy.typing import NDArray

from . import _spillway
from ._arrays import Floats
from ._inputs import mesh_origin
from ._options import RepeatingOptions, as_names, make_run, takes
from ._periodic import corners_of_box
from ._reports import RunReport

if TYPE_CHECKING:
    from types import TracebackType

    from typing_extensions import Unpack


class Block(NamedTuple):
    """Some vertices and simplices of a mesh.

    A mesh numbers its vertices 0, 1, 2, ... in the order in which they come. No simplex comes before
    its vertices, and none after one of them was finalized: who reads along need never hold more than
    the vertices in use.
    """

    first_vertex: int
    """The number of the first of `vertices`."""
    vertices: Floats
    """Those that come for the first time, shape (n, 3), of more dimensions (n, dim); z is 0 where
    points have none."""
    simplices: NDArray[np.int64]
    """Numbers of vertices, positively oriented, shape (m, dim + 1)."""
    finalized: NDArray[np.int64]
    """Numbers of vertices that are used no more, shape (k,)."""
    input_index: NDArray[np.int64] | None
    """The index of each of `vertices` in the input, shape (n,); None unless that was asked for."""
    attributes: dict[str, NDArray[Any]]
    """What `vertices` carry, of what was asked for, as it is stored: shape (n,) or (n, elements)."""
    offsets: NDArray[np.int8] | None = None
    """Of a periodic mesh, for each corner in `simplices` the copy of the vertex that it is: so many
    periods along each axis beyond the vertex, -1, 0 or 1; the first corner of a simplex in the order
    of coordinates has 0. Shape (m, dim + 1, dim). None for other meshes."""

    def __repr__(self) -> str:
        return (
            f"<spillway.Block: {len(self.vertices)} vertices from {self.first_vertex} on, "
            f"{len(self.simplices)} simplices, {len(self.finalized)} finalized>"
        )


class Blocks(Iterator[Block]):
    """The blocks of a mesh, as they come.

    The mesh is made in a thread of its own, a few blocks ahead. Whoever does not take all of them
    need do nothing: the run ends with this object, or with `close`, and leaves nothing behind.

    Attributes
    ----------
    report : RunReport or None
        What the run was like, once all blocks have been taken.
    periodic : tuple or None
        The box of a periodic mesh as ``(low, high)``, with None for the sides of open axes, once a
        block has been taken.
    """

    def __init__(self, stream: _spillway.BlockStream) -> None:
        self.report: RunReport | None = None
        self.periodic: Any = None
        self._stream = stream
        # Also where the interpreter ends before the run does.
        self._end = weakref.finalize(self, stream.close)

    def __iter__(self) -> Blocks:
        return self

    def __next__(self) -> Block:
        block = self._stream.next()
        if block is None:
            if self._stream.report is not None:
                self.report = RunReport(**self._stream.report)
            raise StopIteration
        made = Block(*block)
        if made.offsets is not None and self.periodic is None:
            self.periodic = corners_of_box(self._stream.periodic, made.offsets.shape[2])
        return made

    def close(self) -> None:
        """End the run, if it has not ended, and wait until it has left nothing behind."""
        self._end()

    def __enter__(self) -> Blocks:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        fault: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()


@takes(RepeatingOptions)
def blocks(
    inputs: Any,
    *,
    dim: int = 2,
    id: bool = False,
    attributes: str | Sequence[str] | None = None,
    mesh_format: str | None = None,
    **options: Unpack[RepeatingOptions],
) -> Blocks:
    """Go through a mesh that may be larger than memory, block by block.

    Points are triangulated as by `triangulate`, within the same memory, while the loop takes the
    blocks; a mesh is read along. A thread of its own works a few blocks ahead.

    Parameters
    ----------
    inputs : path, sequence of paths, or array_like of shape (n, 2) to (n, 6)
        Points, as `triangulate` takes them, or one file of a mesh.
    dim : {2, 3, 4, 5, 6}, optional
        2: triangles over x and y, z is carried along. 3: tetrahedra. Beyond: simplices.
    id : bool, optional
        Tell each vertex's index in the input.
    attributes : str or sequence of str, optional
        Names of attributes that blocks have of the vertices, where there are any, or "all".
    mesh_format : str, optional
        Format of a mesh, where neither first bytes nor name tell.
    {options}

    Returns
    -------
    Blocks
        An iterator over `Block`: ``(first_vertex, vertices, simplices, finalized, input_index,
        attributes, offsets)``.

    Raises
    ------
    spillway.Error
        As `triangulate`; what goes wrong while blocks are made is raised in the loop.
    KeyboardInterrupt
        In the loop, on Ctrl-C.

    Examples
    --------
    >>> import numpy as np, spillway
    >>> points = np.random.default_rng(1).random((1000, 2))
    >>> area = 0.0
    >>> corners = np.empty((1000, 3))
    >>> for block in spillway.blocks(points, memory="64M"):
    ...     new = slice(block.first_vertex, block.first_vertex + len(block.vertices))
    ...     corners[new] = block.vertices
    ...     a, b, c = np.moveaxis(corners[block.simplices][..., :2], 1, 0)
    ...     area += np.linalg.det(np.stack([b - a, c - a], axis=1)).sum() / 2
    >>> bool(0.9 < area < 1)
    True
    """
    run = make_run(options)
    origin = mesh_origin(run, inputs, dim, mesh_format, options, id)
    return Blocks(_spillway.BlockStream(run, origin, as_names(attributes, "attributes")))
