"""Four to six dimensions, against SciPy."""

import pickle
import tempfile
import unittest

import numpy as np
import spillway
from spillway import errors
from support import as_set, needed, random_points

COUNTS = {4: 1000, 5: 200, 6: 80}


class HigherDimensionsOfStreams(unittest.TestCase):
    def test_arrays_and_files_have_one_mesh(self):
        with tempfile.TemporaryDirectory() as folder:
            for dim, count in COUNTS.items():
                points = spillway.generate("uniform", count, dim=dim)
                self.assertEqual(points.shape, (count, dim))
                named = f"{folder}/points.npy"
                np.save(named, points)
                mesh = f"{folder}/mesh.spm"
                report = spillway.triangulate(points, mesh, dim=dim)
                again = spillway.triangulate(named, f"{folder}/again.spm", dim=dim)
                self.assertEqual(report.canonical_hash, again.canonical_hash)
                self.assertEqual(report.simplices, spillway.Delaunay(points).nsimplex)
                self.assertIn("simplices", repr(report))
                self.assertTrue(spillway.check(mesh, points=points).proved)
                low, high = spillway.info(mesh).extent
                np.testing.assert_array_equal(low, points.min(axis=0))
                np.testing.assert_array_equal(high, points.max(axis=0))

    def test_blocks_have_rows_of_all_coordinates(self):
        points = spillway.generate("normal", 600, dim=4)
        simplices, vertices = [], np.zeros_like(points)
        for block in spillway.blocks(points, dim=4, tile_points=150, id=True):
            self.assertEqual(block.attributes, {})
            np.testing.assert_array_equal(block.vertices, points[block.input_index])
            vertices[block.first_vertex :][: len(block.vertices)] = block.vertices
            simplices.append(block.simplices)
        corners = np.sort(vertices[np.concatenate(simplices)][:, :, 0])
        tri = spillway.Delaunay(points)
        expected = np.sort(points[tri.simplices][:, :, 0])
        np.testing.assert_array_equal(as_set(corners), as_set(expected))

    def test_blocks_of_a_mesh_have_them_too(self):
        points = spillway.generate("normal", 200, dim=5)
        with tempfile.TemporaryDirectory() as folder:
            mesh = f"{folder}/mesh.spm"
            spillway.triangulate(points, mesh, dim=5)
            rows = np.concatenate([block.vertices for block in spillway.blocks(mesh)])
        np.testing.assert_array_equal(np.unique(rows, axis=0), np.unique(points, axis=0))

    def test_wrong_dimensions_are_errors(self):
        points = random_points(50, 4)
        for dim in (2, 3, 5, 7):
            with self.assertRaises(errors.InvalidArgumentError):
                spillway.triangulate(points, "a.spm", dim=dim)
        with self.assertRaisesRegex(errors.InvalidArgumentError, "no simplices of 4 dimensions"):
            spillway.triangulate(points, "a.ply", dim=4)


class HigherDimensions(unittest.TestCase):
    def test_simplices_are_those_of_scipy(self):
        spatial = needed("scipy.spatial", "SciPy")
        for dim, count in COUNTS.items():
            points = random_points(count, dim)
            ours, theirs = spillway.Delaunay(points), spatial.Delaunay(points)
            np.testing.assert_array_equal(as_set(ours.simplices), as_set(theirs.simplices))
            np.testing.assert_array_equal(as_set(ours.convex_hull), as_set(theirs.convex_hull))
            places = random_points(500, dim, seed=2) * 1.2 - 0.1
            own, other = ours.find_simplex(places), theirs.find_simplex(places)
            np.testing.assert_array_equal(own >= 0, other >= 0)
            np.testing.assert_allclose(
                ours.transform[own[own >= 0], dim], points[ours.simplices[own[own >= 0], dim]]
            )
            self.assertEqual(ours.equations.shape, (ours.nsimplex, dim + 2))

    def test_interpolation_is_that_of_scipy(self):
        interpolate = needed("scipy.interpolate", "SciPy")
        for dim, count in COUNTS.items():
            points = random_points(count, dim)
            values = np.sin(points).sum(axis=1)
            places = random_points(500, dim, seed=2)
            tri = spillway.Delaunay(points)
            theirs = interpolate.LinearNDInterpolator(points, values)(places)
            np.testing.assert_allclose(tri.interpolate(places, values), theirs, rtol=1e-9)
            by_scipy = interpolate.LinearNDInterpolator(tri, values)(places)
            np.testing.assert_allclose(by_scipy, theirs, rtol=1e-9)

    def test_lattices_have_one_triangulation_whatever_the_order(self):
        for dim in COUNTS:
            cube = np.stack(np.meshgrid(*[np.arange(2.0)] * dim), axis=-1).reshape(-1, dim)
            tri = spillway.Delaunay(cube)
            self.assertEqual(spillway.Delaunay(cube[::-1]).hash, tri.hash)
            self.assertEqual(pickle.loads(pickle.dumps(tri)).hash, tri.hash)
            corners = tri.points[tri.simplices]
            volumes = np.linalg.det(corners[:, 1:] - corners[:, :1])
            self.assertTrue((volumes > 0).all())
            self.assertAlmostEqual(volumes.sum(), float(np.prod(np.arange(1.0, dim + 1))))

    def test_says_what_it_is_and_what_it_cannot_be(self):
        tri = spillway.Delaunay(random_points(10, 4))
        self.assertIn("simplices of 10 points", repr(tri))
        with self.assertRaisesRegex(errors.InvalidArgumentError, "4 dimensions; meshio has"):
            tri.to_meshio()
        with self.assertRaisesRegex(errors.DegenerateInputError, "no simplex of 5 dimensions"):
            spillway.Delaunay(np.zeros((9, 5)))


if __name__ == "__main__":
    unittest.main()
