"""Against SciPy's triangulations, and in the hands of SciPy."""

import unittest

import numpy as np
import spillway
from support import DIMENSIONS, as_set, degenerate_sets, needed, random_points

spatial = needed("scipy.spatial", "SciPy")
interpolate = needed("scipy.interpolate", "SciPy")


class SameAsScipy(unittest.TestCase):
    def test_100000_random_points(self):
        for dim in DIMENSIONS:
            points = random_points(100_000, dim)
            ours, theirs = spillway.Delaunay(points), spatial.Delaunay(points)
            np.testing.assert_array_equal(as_set(ours.simplices), as_set(theirs.simplices))
            np.testing.assert_array_equal(as_set(ours.convex_hull), as_set(theirs.convex_hull))
            for attribute in ("ndim", "npoints", "nsimplex"):
                self.assertEqual(getattr(ours, attribute), getattr(theirs, attribute))

    def test_types_and_answers(self):
        for dim in DIMENSIONS:
            points = random_points(10_000, dim)
            ours, theirs = spillway.Delaunay(points), spatial.Delaunay(points)
            self.assert_types_are_the_same(ours, theirs)
            self.assert_answers_are_the_same(ours, theirs)

    def assert_types_are_the_same(self, ours, theirs):
        for name in (
            "points simplices neighbors convex_hull coplanar vertex_to_simplex transform "
            "min_bound max_bound equations"
        ).split():
            with self.subTest(dim=ours.ndim, array=name):
                own, other = getattr(ours, name), getattr(theirs, name)
                self.assertEqual((own.dtype, own.ndim), (other.dtype, other.ndim))
                self.assertEqual(own.shape[1:], other.shape[1:])
        for own, other in zip(ours.vertex_neighbor_vertices, theirs.vertex_neighbor_vertices):
            self.assertEqual((own.dtype, own.shape), (other.dtype, other.shape))

    def assert_answers_are_the_same(self, ours, theirs):
        places = random_points(20_000, ours.ndim, seed=2) * 1.2 - 0.1
        own, other = ours.find_simplex(places), theirs.find_simplex(places)
        np.testing.assert_array_equal(own >= 0, other >= 0)
        np.testing.assert_array_equal(
            np.sort(ours.simplices[own[own >= 0]]), np.sort(theirs.simplices[other[other >= 0]])
        )
        own, other = spatial.tsearch(ours, places), spatial.tsearch(theirs, places)
        np.testing.assert_array_equal(own >= 0, other >= 0)

    def test_duplicates_are_listed_alike(self):
        points = random_points(50, 2)
        points = np.concatenate([points, points[:5]])
        ours, theirs = spillway.Delaunay(points), spatial.Delaunay(points)

        # Which of two equal points is the vertex is SciPy's choice.
        def coordinates(tri):
            return sorted(map(tuple, points[tri.coplanar[:, 0]]))

        self.assertEqual(coordinates(ours), coordinates(theirs))
        for point, simplex, vertex in ours.coplanar:
            self.assertEqual(tuple(points[point]), tuple(points[vertex]))
            self.assertIn(vertex, ours.simplices[simplex])

    def test_planes_hold_the_lifted_vertices(self):
        for dim in DIMENSIONS:
            points = random_points(500, dim)
            tri = spillway.Delaunay(points)
            theirs = spatial.Delaunay(points)
            self.assertTrue((tri.equations[:, -2] < 0).all())
            lifted = theirs.lift_points(points)[:, -1]
            # SciPy scales its paraboloid; this one is not scaled.
            lifted = (lifted - theirs.paraboloid_shift) / theirs.paraboloid_scale
            rows = np.column_stack([points, lifted, np.ones(len(points))])[tri.simplices]
            distances = (rows * tri.equations[:, None]).sum(axis=2)
            np.testing.assert_allclose(distances, 0, atol=1e-12)


    def test_places_lie_below_the_planes_of_the_circumspheres_that_have_them(self):
        for dim in DIMENSIONS:
            tri = spillway.Delaunay(random_points(200, dim))
            theirs = spatial.Delaunay(tri.points)
            places = random_points(60, dim, seed=2).reshape(4, 15, dim)
            self.assertEqual(tri.lift_points(places).shape, theirs.lift_points(places).shape)
            found = tri.plane_distance(places)
            self.assertEqual(found.shape, theirs.plane_distance(places).shape)
            apart = np.linalg.norm(places[..., None, :] - tri.circumcenters, axis=-1)
            radii = np.linalg.norm(tri.points[tri.simplices[:, 0]] - tri.circumcenters, axis=1)
            np.testing.assert_array_equal(found > 0, apart < radii)
            self.assertIs(tri.vertices, tri.simplices)
            np.testing.assert_array_equal(tri.good, theirs.good)


class InTheHandsOfScipy(unittest.TestCase):
    def test_linear_interpolation(self):
        for dim in DIMENSIONS:
            points = random_points(5000, dim)
            values = np.sin(points).sum(axis=1)
            places = random_points(5000, dim, seed=2) * 1.2 - 0.1
            tri = spillway.Delaunay(points)
            ours = interpolate.LinearNDInterpolator(tri, values)
            theirs = interpolate.LinearNDInterpolator(points, values)
            self.assertIs(ours.tri, tri)
            np.testing.assert_allclose(ours(places), theirs(places), rtol=1e-12)
            np.testing.assert_allclose(tri.interpolate(places, values), theirs(places), rtol=1e-12)

    def test_linear_interpolation_over_ties_and_duplicates(self):
        for dim in DIMENSIONS:
            for name, points in degenerate_sets(dim):
                with self.subTest(dim=dim, set=name):
                    values = points @ np.arange(1.0, dim + 1)
                    middle = points[spillway.Delaunay(points).simplices].mean(axis=1)
                    ours = interpolate.LinearNDInterpolator(spillway.Delaunay(points), values)
                    np.testing.assert_allclose(ours(middle), middle @ np.arange(1.0, dim + 1))

    def test_smooth_interpolation(self):
        points = random_points(2000, 2)
        values = np.sin(points).sum(axis=1)
        places = random_points(500, 2, seed=2) * 0.8 + 0.1
        ours = interpolate.CloughTocher2DInterpolator(spillway.Delaunay(points), values)
        theirs = interpolate.CloughTocher2DInterpolator(points, values)
        np.testing.assert_allclose(ours(places), theirs(places), atol=1e-5)

    def test_it_passes_for_a_triangulation_of_scipy_and_for_its_own_class(self):
        tri = spillway.Delaunay(random_points(10, 2))
        self.assertIsInstance(tri, spatial.Delaunay)
        self.assertIsInstance(tri, spillway.Delaunay)


if __name__ == "__main__":
    unittest.main()
