"""`Delaunay`: a triangulation in memory, and questions to it."""

from __future__ import annotations

import functools
import importlib
import sys
from typing import Any, Callable

import numpy as np
from numpy.typing import NDArray

from . import _spillway
from ._affine import barycentric_transform, lifted_planes
from ._arrays import Floats, Integers, as_floats, as_places, as_points, as_thread_count, frozen
from ._periodic import Box, as_periodic_box, corners_of_box
from .errors import InvalidArgumentError, TooLargeError

_MOST_NARROW = 2**31 - 1
# Simplices a point has about. Where that makes more than 32 bits number, numbers have 64.
_SIMPLICES_A_POINT = {2: 2.0, 3: 6.8, 4: 32.0, 5: 190.0, 6: 1300.0}
# Places that are asked for at once; in between the interpreter sees to signals.
_CHUNK = 1 << 20


class Delaunay:
    """The Delaunay triangulation of points in the plane, in space, or in four to six dimensions.

    It is exact: no circumsphere of a simplex has a point inside, without any tolerance. For every
    set of points there is one result, whatever the number of threads, also where more than
    ``ndim + 1`` points lie on one circle or sphere. Names and shapes are those of
    `scipy.spatial.Delaunay`.

    Parameters
    ----------
    points : array_like, shape (n, 2) to (n, 6)
        Coordinates, finite, of any unit, the same on all axes. Besides the copy that the library
        keeps, none is made of float64 in native byte order, whatever the strides; other numbers
        are converted.
    dim : {None, 2, 3, 4, 5, 6}, optional
        Dimension of the triangulation. By default that of the points. With 2, points of three
        coordinates are triangulated in the plane and carry their z along.
    threads : int, optional
        The most threads to use, here and for questions. By default all that the process may use.
        The result does not depend on it.
    progress : callable, optional
        Told from time to time the fraction that is done, from 0 to 1, the last time with 1. It is
        called in the thread of the caller. What it raises ends the run.
    periodic : box, float or sequence of float, optional
        In the plane and in space: the box that points repeat with, as
        ``((xmin, ymin), (xmax, ymax))`` or of three coordinates each, with None for both sides of an
        open axis; or its periods from 0, as the `boxsize` of `scipy.spatial.cKDTree`: one for all
        axes, or one for each, 0 for an open one. Points are brought into the box, and the
        triangulation has no boundary along its periodic axes.

    Attributes
    ----------
    points : ndarray of float64, shape (npoints, ndim)
        The coordinates in the order of the input, of a periodic triangulation in the box.
    z : ndarray of float64, shape (npoints,), or None
        The heights that points in the plane carry.
    simplices : ndarray of int32, shape (nsimplex, ndim + 1)
        The vertices of each simplex as numbers of points, positively oriented: triangles run
        counter-clockwise; of a tetrahedron the first three do, seen from the last; in general the
        determinant of the edges from the first vertex to the others is positive. Numbers are
        int64 where there may be more than 2,147,483,647 of them.
    neighbors : ndarray of int32, shape (nsimplex, ndim + 1)
        The k-th neighbor lies opposite the k-th vertex; -1 outside of the hull.
    offsets : ndarray of int8, shape (nsimplex, ndim + 1, ndim), or None
        Of a periodic triangulation, for each vertex in `simplices` the copy of it that the simplex
        has: so many periods along each axis beyond the point, -1, 0 or 1. The corners are
        ``points[simplices] + offsets * periods``. The first of them in the order of coordinates has
        0. None for others.
    periodic : tuple or None
        The box of a periodic triangulation as ``(low, high)``, with None for the sides of open axes.
        Its sides are rounded so that copies of points are exact.
    convex_hull : ndarray of int32, shape (nfacets, ndim)
        The vertices of each facet of the hull.
    coplanar : ndarray of int32, shape (nduplicates, 3)
        The points that equal an earlier one, each with a simplex that has that one as a vertex, and
        that vertex.
    vertex_to_simplex : ndarray of int32, shape (npoints,)
        A simplex of which each point is a vertex; -1 for points that equal an earlier one.
    ndim, npoints, nsimplex : int
        Dimension; number of points, equal ones included; number of simplices.

    Raises
    ------
    spillway.Error
        Also a ValueError, with the attribute `code`: ``"invalid argument"`` for coordinates that
        are not finite or arguments that cannot be used, ``"degenerate input"`` for points that span
        no triangle (tetrahedron, simplex): none, too few, or all on one line (plane, hyperplane);
        or so few in a periodic box that a simplex is half a period long.
    MemoryError
        If memory runs out.
    KeyboardInterrupt
        On Ctrl-C, as soon as the parts of the work that have been begun are done.

    Notes
    -----
    All arrays are read-only, and so is the object: it may be used by several threads at a time, and
    a copy of it is the same object. A pickle holds the points, which are triangulated again when it
    is read. Import SciPy for `scipy.interpolate.LinearNDInterpolator` and other users of its
    triangulations: they take this one, too.
    """

    def __init__(
        self,
        points: Any,
        *,
        dim: int | None = None,
        threads: int | None = None,
        progress: Callable[[float], object] | None = None,
        periodic: Any = None,
    ) -> None:
        if progress is not None and not callable(progress):
            raise TypeError(f"progress is {progress!r}; give a function that takes a fraction")
        coordinates, self.z = as_points(points, dim)
        self._threads = threads
        ndim = coordinates.shape[1]
        self._given = None if periodic is None else as_periodic_box(periodic, ndim)
        self._mesh = _make_mesh(coordinates, as_thread_count(threads), progress, self._given)
        self.points: Floats = self._mesh.points
        self.simplices: Integers = self._mesh.cell_vertices
        self.neighbors: Integers = self._mesh.cell_neighbours
        self.convex_hull: Integers = self._mesh.hull_facets
        self.vertex_to_simplex: Integers = self._mesh.vertex_cells
        self.npoints, self.ndim = self.points.shape
        self.nsimplex = len(self.simplices)
        self.offsets: NDArray[np.int8] | None = None
        self.periodic = corners_of_box(self._mesh.periodic, self.ndim)
        if periodic is not None:
            shape = (self.nsimplex, self.ndim + 1, self.ndim)
            self.offsets = self._mesh.cell_offsets.reshape(shape)

    def __repr__(self) -> str:
        cells = {2: "triangles", 3: "tetrahedra"}.get(self.ndim, "simplices")
        return f"<spillway.Delaunay: {self.nsimplex} {cells} of {self.npoints} points>"

    @functools.cached_property
    def coplanar(self) -> Integers:
        """The points that equal an earlier one, each with a simplex that has that one as a vertex,
        and that vertex, shape (nduplicates, 3)."""
        point, vertex = self._mesh.duplicates.T
        return frozen(np.column_stack([point, self.vertex_to_simplex[vertex], vertex]))

    @functools.cached_property
    def min_bound(self) -> Floats:
        """The least coordinates of the points, shape (ndim,)."""
        return frozen(self.points.min(axis=0))

    @functools.cached_property
    def max_bound(self) -> Floats:
        """The greatest coordinates of the points, shape (ndim,)."""
        return frozen(self.points.max(axis=0))

    @functools.cached_property
    def vertex_neighbor_vertices(self) -> tuple[Integers, Integers]:
        """The vertices that have an edge in common with each: ``(indptr, indices)``, where those of
        point k, ascending, are ``indices[indptr[k]:indptr[k + 1]]``."""
        indptr, indices = self._mesh.vertex_neighbours()
        return frozen(indptr), frozen(indices)

    @functools.cached_property
    def transform(self) -> Floats:
        """The affine maps to barycentric coordinates, shape (nsimplex, ndim + 1, ndim).

        With ``T = transform[i]``, ``c = T[:ndim] @ (x - T[ndim])`` are the coordinates of a place x
        in simplex i, but the last, which is ``1 - c.sum()``. Not a number where a simplex is so
        thin that they would be all rounding error. Of a periodic triangulation x must be the copy of
        the place that lies at the corners as `offsets` say.
        """
        return frozen(barycentric_transform(self._corners()))

    @functools.cached_property
    def circumcenters(self) -> Floats:
        """The centres of the simplices' circumspheres, shape (nsimplex, ndim); infinite where they
        lie beyond the largest float64. Of a periodic triangulation they are in the box."""
        return frozen(self._mesh.circumcentres())

    @functools.cached_property
    def hash(self) -> str:
        """The canonical hash, which `spillway triangulate` prints: it depends on nothing but the set
        of simplices, each the set of its vertices' coordinates."""
        return f"{self._mesh.canonical_hash():016x}"

    @functools.cached_property
    def faces(self) -> Integers:
        """The simplices in one row as PyVista has them, each led by the number of its vertices:
        ``[3, a, b, c, 3, ...]`` for ``PolyData(points, faces)``, ``[4, a, b, c, d, 4, ...]`` for
        ``UnstructuredGrid``."""
        counts = np.full(self.nsimplex, self.ndim + 1, self.simplices.dtype)
        return frozen(np.column_stack([counts, self.simplices]).ravel())

    def find_simplex(self, xi: Any, bruteforce: bool = False, tol: float | None = None) -> Any:
        """Find the simplex that has each place inside or on its boundary. Exact.

        Parameters
        ----------
        xi : array_like, shape (..., ndim)
            The places.
        bruteforce : bool, optional
            Without effect: every search is exact.
        tol : None, optional
            There is no tolerance.

        Returns
        -------
        ndarray of int32, shape (...)
            Of several simplices the lowest number; -1 outside of the hull, and for coordinates that
            are not finite.

        Raises
        ------
        spillway.Error
            Also a ValueError: for places of another shape, and for a tolerance.
        """
        if tol is not None and np.any(tol):
            raise InvalidArgumentError(f"tol is {tol!r}, but the search is exact; leave it out")
        return self._ask(self._mesh.locate, xi, self.simplices.dtype)

    def nearest(self, xi: Any) -> Any:
        """Find the vertex nearest to each place, also outside of the hull. Exact.

        Parameters
        ----------
        xi : array_like, shape (..., ndim)
            The places.

        Returns
        -------
        ndarray of int32, shape (...)
            Numbers of points, of several at the same distance the lowest; -1 for coordinates that
            are not finite.

        Raises
        ------
        spillway.Error
            Also a ValueError: for places of another shape.
        """
        return self._ask(self._mesh.nearest_vertex, xi, self.simplices.dtype)

    def interpolate(self, xi: Any, values: Any = None) -> Any:
        """The function that is linear on every simplex and has the given values at the vertices.

        Parameters
        ----------
        xi : array_like, shape (..., ndim)
            The places.
        values : array_like, shape (npoints, ...), optional
            The values at the points; those of points that equal an earlier one are not used. By
            default `z`.

        Returns
        -------
        ndarray of float64, shape of the places followed by that of a point's values
            Not a number outside of the hull, and for coordinates that are not finite. At a vertex
            exactly the vertex's value.

        Raises
        ------
        spillway.Error
            Also a ValueError: for places or values of another shape, and without values where the
            points carry no z.
        """
        if values is None:
            values = self.z
        if values is None:
            raise InvalidArgumentError("the points carry no z; give values")
        table = as_floats(values, "values")
        if table.ndim == 0 or len(table) != self.npoints:
            raise InvalidArgumentError(
                f"values has the shape {table.shape}; its first axis must have {self.npoints}, "
                "one for each point"
            )
        places = as_places(xi, self.ndim)
        columns = np.require(table.reshape(self.npoints, -1).T, requirements=["C", "A"])
        found = np.empty((*places.shape[:-1], len(columns)))
        for k, column in enumerate(columns):
            question = functools.partial(self._mesh.interpolate, column)
            found[..., k] = self._ask(question, places, np.float64)
        return found.reshape(places.shape[:-1] + table.shape[1:])

    def to_meshio(self) -> Any:
        """The triangulation as a `meshio.Mesh`; points in the plane have their z.

        Raises
        ------
        ImportError
            Without the package meshio.
        InvalidArgumentError
            For more than three dimensions, which no mesh format has, and for periodic triangulations.
        """
        if self.periodic is not None:
            raise InvalidArgumentError("meshio has no periodic meshes; make one of copies of points")
        if self.ndim > 3:
            raise InvalidArgumentError(
                f"the mesh has {self.ndim} dimensions; meshio has cells of two and three"
            )
        meshio = importlib.import_module("meshio")
        points = self.points if self.z is None else np.column_stack([self.points, self.z])
        return meshio.Mesh(points, [("triangle" if self.ndim == 2 else "tetra", self.simplices)])

    def _corners(self) -> Floats:
        """The corners of the simplices, shape (nsimplex, ndim + 1, ndim)."""
        corners: Floats = self.points[self.simplices]
        if self.offsets is None:
            return corners
        low, high, flags = self._mesh.periodic
        periods = np.where(flags, np.subtract(high, low), 0.0)[: self.ndim]
        return corners + self.offsets * periods

    def _ask(self, question: Callable[[Floats], NDArray[Any]], xi: Any, kind: Any) -> Any:
        places = as_places(xi, self.ndim)
        rows = places.reshape(-1, self.ndim)
        answers = np.empty(len(rows), kind)
        for begin in range(0, len(rows), _CHUNK):
            answers[begin : begin + _CHUNK] = question(rows[begin : begin + _CHUNK])
        return answers.reshape(places.shape[:-1])

    # Nothing of it changes, so that a copy is not needed.
    def __copy__(self) -> Delaunay:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Delaunay:
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        points = self.points if self.z is None else np.column_stack([self.points, self.z])
        box = corners_of_box(self._given, self.ndim)
        make = functools.partial(
            type(self), dim=self.ndim, threads=self._threads, periodic=box
        )
        return make, (points,)

    # From here on: what SciPy asks of its own triangulations.

    paraboloid_scale = 1.0
    paraboloid_shift = 0.0
    furthest_site = False

    @property  # type: ignore[misc]
    def __class__(self) -> type:
        # Users of triangulations in SciPy ask isinstance() for its class, and read arrays of the
        # same names. Whoever asks has imported it, so this need not. They know of no copies.
        if getattr(self, "periodic", None) is not None:
            return type(self)
        scipy_module = sys.modules.get("scipy.spatial._qhull")
        theirs: type | None = getattr(scipy_module, "Delaunay", None)
        return type(self) if theirs is None else theirs

    @property
    def _points(self) -> Floats:
        return self.points

    @functools.cached_property
    def equations(self) -> Floats:
        """The hyperplanes of the simplices on the paraboloid z = |x|^2, as downward unit normals and
        offsets, shape (nsimplex, ndim + 2)."""
        if self.periodic is not None:
            raise InvalidArgumentError("a periodic triangulation is no hull of points that are lifted")
        return frozen(lifted_planes(self.points[self.simplices], self.circumcenters))

    @functools.cached_property
    def good(self) -> Integers:
        """One for each simplex: all are wanted."""
        return frozen(np.ones(self.nsimplex, np.int32))

    @property
    def vertices(self) -> Integers:
        """The same as `simplices`."""
        return self.simplices

    def lift_points(self, x: Any) -> Floats:
        """Places on the paraboloid z = |x|^2, shape (..., ndim + 1), for places of (..., ndim)."""
        places = as_places(x, self.ndim)
        return np.concatenate([places, (places * places).sum(axis=-1, keepdims=True)], axis=-1)

    def plane_distance(self, xi: Any) -> Floats:
        """How far below the hyperplane of each simplex the lifted places lie, shape (...,
        nsimplex), for places of (..., ndim): positive within its circumsphere, up to rounding."""
        distances: Floats = self.lift_points(xi) @ self.equations[:, :-1].T + self.equations[:, -1]
        return distances


def _make_mesh(points: Floats, threads: int, progress: Any, periodic: Box | None) -> Any:
    count, ndim = points.shape
    narrow, wide = getattr(_spillway, f"Mesh{ndim}"), getattr(_spillway, f"WideMesh{ndim}")
    if count * _SIMPLICES_A_POINT[ndim] > _MOST_NARROW:
        return wide(points, threads, progress, periodic)
    try:
        return narrow(points, threads, progress, periodic)
    except TooLargeError:  # points in space may have far more simplices than is usual
        return wide(points, threads, progress, periodic)
