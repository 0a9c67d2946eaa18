"""Questions to a triangulation: against brute force, on edges and vertices, and outside."""

import unittest
import warnings

import numpy as np
import spillway
from support import DIMENSIONS, random_points

# Two triangles, whose coordinates are exact in binary; and places with what each of them meets.
SQUARE = [[0, 0], [4, 0], [4, 4], [0, 4.5]]


class FindSimplex(unittest.TestCase):
    def test_vertices_and_edges_belong_to_the_lowest_simplex_around(self):
        for dim in DIMENSIONS:
            grid = np.stack(np.meshgrid(*[np.arange(5.0)] * dim), axis=-1).reshape(-1, dim)
            tri = spillway.Delaunay(grid)
            corners = grid[tri.simplices]
            for k in range(dim + 1):
                # Middles of edges, and vertices: with these coordinates no rounding occurs.
                for places in (corners[:, k], (corners[:, k] + corners[:, k - 1]) / 2):
                    found = tri.find_simplex(places)
                    self.assertTrue((found >= 0).all() and (found <= np.arange(len(corners))).all())
                    self.assert_inside(corners[found], places)

    def assert_inside(self, corners, places):
        edges = np.swapaxes(corners[:, :-1] - corners[:, -1:], 1, 2)
        shares = np.linalg.solve(edges, (places - corners[:, -1])[..., None])[..., 0]
        self.assertTrue((shares >= -1e-12).all() and (shares.sum(axis=1) <= 1 + 1e-12).all())

    def test_the_hull_is_inside_and_the_next_number_is_outside(self):
        tri = spillway.Delaunay(SQUARE)
        self.assertGreaterEqual(tri.find_simplex([2, 0]), 0)
        self.assertEqual(tri.find_simplex([2, -5e-324]), -1)
        self.assertGreaterEqual(tri.find_simplex([4, 4]), 0)
        self.assertEqual(tri.find_simplex([np.nextafter(4, 5), 4]), -1)

    def test_shapes_of_places(self):
        tri = spillway.Delaunay(SQUARE)
        self.assertEqual(tri.find_simplex([1, 1]).shape, ())
        self.assertEqual(tri.find_simplex(np.ones((2, 0, 2))).shape, (2, 0))
        self.assertEqual(tri.find_simplex(np.ones((5, 3, 2), "f4")).shape, (5, 3))
        backwards = random_points(40, 2)[::-2, ::-1]
        np.testing.assert_array_equal(
            tri.find_simplex(backwards), tri.find_simplex(backwards.copy())
        )
        np.testing.assert_array_equal(tri.find_simplex([[np.nan, 1], [np.inf, 1]]), -1)

    def test_more_places_than_are_asked_for_at_once(self):
        tri = spillway.Delaunay(random_points(20, 2))
        places = random_points((1 << 20) + 5, 2)
        found = tri.find_simplex(places)
        np.testing.assert_array_equal(found[-9:], tri.find_simplex(places[-9:]))
        np.testing.assert_array_equal(found[:9], tri.find_simplex(places[:9]))

    def test_bad_places(self):
        tri = spillway.Delaunay(SQUARE)
        for places in (1.0, [1, 2, 3], [["a", "b"]]):
            with self.assertRaisesRegex(spillway.Error, "xi has"):
                tri.find_simplex(places)
        with self.assertRaisesRegex(spillway.Error, "tol is"):
            tri.find_simplex([1, 1], tol=1e-3)


class Nearest(unittest.TestCase):
    def test_brute_force(self):
        for dim in DIMENSIONS:
            points = np.random.default_rng(5).integers(0, 30, (200, dim)).astype(float)
            points = np.unique(points, axis=0)
            places = np.random.default_rng(6).integers(-5, 35, (300, dim)).astype(float)
            distances = ((places[:, None] - points) ** 2).sum(axis=2)
            found = spillway.Delaunay(points).nearest(places)
            np.testing.assert_array_equal(found, distances.argmin(axis=1))

    def test_not_finite(self):
        self.assertEqual(spillway.Delaunay(SQUARE).nearest([np.nan, 0]), -1)


class Interpolate(unittest.TestCase):
    def test_a_linear_function_is_met_inside_and_there_is_none_outside(self):
        for dim in DIMENSIONS:
            points = random_points(300, dim)
            tri = spillway.Delaunay(points)
            places = random_points(500, dim, seed=2) * 1.4 - 0.2
            found = tri.interpolate(places, points @ np.arange(1.0, dim + 1) + 5)
            inside = tri.find_simplex(places) >= 0
            np.testing.assert_array_equal(np.isnan(found), ~inside)
            expected = places[inside] @ np.arange(1.0, dim + 1) + 5
            np.testing.assert_allclose(found[inside], expected, rtol=1e-12)

    def test_vertices_have_their_values_exactly(self):
        points = random_points(300, 3)
        np.testing.assert_array_equal(
            spillway.Delaunay(points).interpolate(points, points[:, 1]), points[:, 1]
        )

    def test_z_is_the_default(self):
        points = random_points(300, 3)
        tri = spillway.Delaunay(points, dim=2)
        np.testing.assert_array_equal(tri.interpolate(points[:, :2]), points[:, 2])
        with self.assertRaisesRegex(spillway.Error, "carry no z"):
            spillway.Delaunay(points).interpolate(points)

    def test_several_values_a_point(self):
        points = random_points(100, 2)
        values = random_points(100, 6, seed=2).reshape(100, 2, 3)
        tri = spillway.Delaunay(points)
        places = random_points(8, 2, seed=3).reshape(4, 2, 2)
        found = tri.interpolate(places, values)
        self.assertEqual(found.shape, (4, 2, 2, 3))
        np.testing.assert_array_equal(found[..., 1, 2], tri.interpolate(places, values[:, 1, 2]))

    def test_values_without_components_or_not_aligned(self):
        points = random_points(100, 2)
        tri = spillway.Delaunay(points)
        self.assertEqual(tri.interpolate(points[:7], np.zeros((100, 0))).shape, (7, 0))
        record = np.zeros(100, [("flag", "u1"), ("value", float)])
        record["value"] = points[:, 0]
        found = tri.interpolate(points, record["value"])
        np.testing.assert_array_equal(found, points[:, 0])

    def test_bad_values(self):
        tri = spillway.Delaunay(SQUARE)
        for values in ([1, 2, 3], 5, ["a"] * 4, [1j] * 4):
            with self.assertRaisesRegex(spillway.Error, "values has"):
                tri.interpolate([1, 1], values)


class Arrays(unittest.TestCase):
    def test_circumcenters_are_as_far_from_all_vertices(self):
        for dim in DIMENSIONS:
            points = random_points(200, dim)
            tri = spillway.Delaunay(points)
            radii = np.linalg.norm(points[tri.simplices] - tri.circumcenters[:, None], axis=2)
            np.testing.assert_allclose(radii, radii[:, :1].repeat(dim + 1, axis=1), rtol=1e-9)

    def test_transform_gives_barycentric_coordinates(self):
        for dim in DIMENSIONS:
            points = random_points(200, dim) * 1e-200
            tri = spillway.Delaunay(points)
            for k in range(dim):
                shares = np.einsum(
                    "mij,mj->mi",
                    tri.transform[:, :dim],
                    points[tri.simplices[:, k]] - tri.transform[:, dim],
                )
                np.testing.assert_allclose(shares, np.eye(dim)[[k]].repeat(len(shares), 0), atol=1e-6)

    def test_transform_is_no_number_where_a_simplex_is_flat(self):
        tri = spillway.Delaunay([[0, 0], [1, 0], [2, 1e-18]])
        self.assertTrue(np.isnan(tri.transform[0, :2]).all())

    def test_transform_does_not_warn_of_the_largest_coordinates(self):
        square = np.array([[-1, -1], [1, -1], [-1, 1], [1, 1.5]]) * (np.finfo(float).max / 2)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertEqual(spillway.Delaunay(2 * (square / 1.5)).transform.shape, (2, 3, 2))

    def test_faces_lead_each_simplex_with_its_number_of_vertices(self):
        for dim in DIMENSIONS:
            tri = spillway.Delaunay(random_points(30, dim))
            faces = tri.faces.reshape(-1, dim + 2)
            np.testing.assert_array_equal(faces[:, 0], dim + 1)
            np.testing.assert_array_equal(faces[:, 1:], tri.simplices)


if __name__ == "__main__":
    unittest.main()
