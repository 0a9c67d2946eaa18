"""The arrays of a triangulation: against the command and against what they promise of each other."""

import unittest

import numpy as np
import spillway
from spillway import _spillway
from support import DIMENSIONS, degenerate_sets, hash_by_command, random_points


class Mesh(unittest.TestCase):
    def test_degenerate_sets_have_the_hash_of_the_command(self):
        for dim in DIMENSIONS:
            for name, points in degenerate_sets(dim):
                with self.subTest(dim=dim, set=name):
                    self.assertEqual(spillway.Delaunay(points).hash, hash_by_command(points))

    def test_neighbors_are_symmetric_and_opposite_their_vertices(self):
        for dim in DIMENSIONS:
            for name, points in degenerate_sets(dim):
                with self.subTest(dim=dim, set=name):
                    tri = spillway.Delaunay(points)
                    hull = 0
                    for cell, row in enumerate(tri.neighbors):
                        for k, neighbor in enumerate(row):
                            hull += neighbor < 0
                            if neighbor < 0:
                                continue
                            self.assertIn(cell, tri.neighbors[neighbor])
                            facet = set(np.delete(tri.simplices[cell], k))
                            self.assertLessEqual(facet, set(tri.simplices[neighbor]))
                            self.assertNotIn(tri.simplices[cell, k], tri.simplices[neighbor])
                    self.assertEqual(hull, len(tri.convex_hull))

    def test_simplices_are_positively_oriented(self):
        for dim in DIMENSIONS:
            corners = random_points(500, dim)
            corners = corners[spillway.Delaunay(corners).simplices]
            volumes = np.linalg.det(corners[:, 1:] - corners[:, :1])
            self.assertTrue((volumes > 0).all())

    def test_each_vertex_is_in_its_simplex(self):
        for dim in DIMENSIONS:
            tri = spillway.Delaunay(random_points(500, dim))
            self.assertTrue(
                (tri.simplices[tri.vertex_to_simplex] == np.arange(500)[:, None]).any(axis=1).all()
            )

    def test_coplanar_lists_each_point_that_equals_an_earlier_one(self):
        for dim in DIMENSIONS:
            points = random_points(50, dim)
            tri = spillway.Delaunay(np.concatenate([points, points[[7, 3, 7]]]))
            np.testing.assert_array_equal(tri.coplanar[:, [0, 2]], [[50, 7], [51, 3], [52, 7]])
            for _, simplex, vertex in tri.coplanar:
                self.assertIn(vertex, tri.simplices[simplex])
            np.testing.assert_array_equal(tri.vertex_to_simplex[50:], -1)
            indptr, _ = tri.vertex_neighbor_vertices
            np.testing.assert_array_equal(np.diff(indptr)[50:], 0)
        self.assertEqual(spillway.Delaunay(random_points(9, 2)).coplanar.shape, (0, 3))

    def test_vertex_neighbors_are_the_ends_of_all_edges(self):
        for dim in DIMENSIONS:
            for name, points in degenerate_sets(dim):
                with self.subTest(dim=dim, set=name):
                    tri = spillway.Delaunay(points)
                    around = [set() for _ in points]
                    for simplex in tri.simplices:
                        for vertex in simplex:
                            around[vertex].update(simplex[simplex != vertex])
                    indptr, indices = tri.vertex_neighbor_vertices
                    for vertex, expected in enumerate(around):
                        found = indices[indptr[vertex] : indptr[vertex + 1]]
                        self.assertEqual(list(found), sorted(expected))

    def test_sizes_and_bounds(self):
        points = np.array([[0, 0], [4, 1], [1, 3], [0, 0]])
        tri = spillway.Delaunay(points)
        self.assertEqual((tri.ndim, tri.npoints, tri.nsimplex), (2, 4, 1))
        np.testing.assert_array_equal(tri.min_bound, [0, 0])
        np.testing.assert_array_equal(tri.max_bound, [4, 3])
        self.assertEqual(repr(tri), "<spillway.Delaunay: 1 triangles of 4 points>")

    def test_points_in_the_plane_carry_their_z(self):
        points = random_points(200, 3)
        tri = spillway.Delaunay(points, dim=2)
        self.assertEqual(tri.hash, spillway.Delaunay(points[:, :2]).hash)
        np.testing.assert_array_equal(tri.points, points[:, :2])
        np.testing.assert_array_equal(tri.z, points[:, 2])
        self.assertIsNone(spillway.Delaunay(points).z)

    def test_the_result_does_not_depend_on_threads(self):
        points = random_points(300_000, 2)
        one, several = (spillway.Delaunay(points, threads=n) for n in (1, 5))
        np.testing.assert_array_equal(one.simplices, several.simplices)
        np.testing.assert_array_equal(one.neighbors, several.neighbors)

    def test_numbers_of_64_bits_give_the_same_mesh(self):
        for dim in DIMENSIONS:
            points = random_points(300, dim)
            tri = spillway.Delaunay(points)
            wide = getattr(_spillway, f"WideMesh{dim}")(points, 0, None)
            self.assertEqual(tri.simplices.dtype, np.int32)
            self.assertEqual(wide.cell_vertices.dtype, np.int64)
            np.testing.assert_array_equal(wide.cell_vertices, tri.simplices)
            for own, other in zip(wide.vertex_neighbours(), tri.vertex_neighbor_vertices):
                self.assertEqual(own.dtype, np.int64)
                np.testing.assert_array_equal(own, other)

    def test_all_arrays_are_contiguous_and_read_only(self):
        for dim in DIMENSIONS:
            tri = spillway.Delaunay(random_points(50, dim))
            arrays = {name: getattr(tri, name) for name in ARRAYS}
            arrays["indptr"], arrays["indices"] = tri.vertex_neighbor_vertices
            for name, array in arrays.items():
                with self.subTest(dim=dim, array=name):
                    self.assertTrue(array.flags.c_contiguous)
                    self.assertFalse(array.flags.writeable)

    def test_an_array_outlives_its_triangulation(self):
        points = random_points(50, 2)
        simplices = spillway.Delaunay(points).simplices
        np.testing.assert_array_equal(simplices, spillway.Delaunay(points).simplices)


ARRAYS = (
    "points simplices neighbors convex_hull coplanar vertex_to_simplex transform min_bound "
    "max_bound circumcenters equations faces"
).split()

if __name__ == "__main__":
    unittest.main()
