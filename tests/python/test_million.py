"""A million points and places: the same simplices as SciPy's, and answers that integers prove."""

import concurrent.futures
import unittest

import numpy as np
import spillway
from support import DIMENSIONS, as_set, needed, random_points

MILLION = 1_000_000


class Triangulation(unittest.TestCase):
    def test_random_points_give_the_simplices_of_scipy(self):
        spatial = needed("scipy.spatial", "SciPy")

        def theirs(points):
            return as_set(spatial.Delaunay(points).simplices)

        # SciPy takes by far the longest, most of it without the interpreter's lock.
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            sets = [random_points(MILLION, dim) for dim in reversed(DIMENSIONS)]
            expected = [pool.submit(theirs, points) for points in sets]
            found = [as_set(spillway.Delaunay(points, threads=1).simplices) for points in sets]
            for ours, theirs_too in zip(found, expected):
                np.testing.assert_array_equal(ours, theirs_too.result())


class FindSimplex(unittest.TestCase):
    """Points are even integers, so that middles of edges are integers, too. They are small enough
    for determinants of 64 bits."""

    def test_places_anywhere_on_edges_and_on_vertices_lie_in_the_simplex_that_is_found(self):
        for dim in DIMENSIONS:
            rng = np.random.default_rng(dim)
            points = 2 * np.unique(rng.integers(0, 2**14, (100_000, dim)), axis=0)
            tri = spillway.Delaunay(points)
            vertices = rng.integers(0, len(points), MILLION // 4)
            edges = tri.simplices[rng.integers(0, tri.nsimplex, MILLION // 4), :2]
            middles = points[edges].sum(axis=1) // 2
            anywhere = rng.integers(-(2**11), 2**15 + 2**11, (MILLION // 2, dim))
            places = np.concatenate([points[vertices], middles, anywhere])
            found = tri.find_simplex(places)
            inside = found >= 0
            self.assertTrue(inside[: MILLION // 2].all())
            np.testing.assert_array_equal(found[: len(vertices)], tri.vertex_to_simplex[vertices])
            corners = points[tri.simplices[found[inside]]]
            self.assertTrue((self.sides(corners, places[inside]) >= 0).all())
            self.assert_outside(tri, points, places[~inside])

    def assert_outside(self, tri, points, places):
        """Each lies strictly beyond a facet of the hull."""
        self.assertGreater(len(places), MILLION // 20)
        middle = np.full((1, tri.ndim), 2**14)
        for facet in points[tri.convex_hull]:
            inner_side = np.sign(self.volumes(facet[None], middle))
            places = places[self.volumes(facet[None], places) * inner_side >= 0]
        self.assertEqual(len(places), 0)

    def sides(self, corners, places):
        """For each facet of each simplex: positive where the place is on the simplex's side."""
        facets = [np.delete(corners, k, axis=1) for k in range(corners.shape[1])]
        return np.stack(
            [
                self.volumes(facet, places) * np.sign(self.volumes(facet, corners[:, k]))
                for k, facet in enumerate(facets)
            ]
        )

    def volumes(self, facets, places):
        """Determinants of what leads from a place to the vertices of a facet."""
        rows = np.moveaxis(facets - places[:, None], 2, 0)
        if len(rows) == 2:
            return rows[0][:, 0] * rows[1][:, 1] - rows[0][:, 1] * rows[1][:, 0]
        a, b, c = np.moveaxis(rows, 2, 0)
        return (a * np.cross(b, c, axis=0)).sum(axis=0)


if __name__ == "__main__":
    unittest.main()
