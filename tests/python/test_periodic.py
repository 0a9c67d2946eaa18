"""Periodic triangulations: in memory, from files and block by block."""

import copy
import pickle
import unittest

import numpy as np
import spillway
from support import DIMENSIONS, InFolder, random_points


def box_of(dim, low=0.0, side=1.0):
    return ((low,) * dim, (low + side,) * dim)


class InMemory(unittest.TestCase):
    def test_simplices_fill_the_box_and_none_is_on_a_hull(self):
        for dim in DIMENSIONS:
            with self.subTest(dim=dim):
                tri = spillway.Delaunay(random_points(500, dim), periodic=1.0)
                self.assertEqual(tri.offsets.shape, (tri.nsimplex, dim + 1, dim))
                self.assertEqual(tri.offsets.dtype, np.int8)
                self.assertFalse(tri.offsets.flags.writeable)
                self.assertEqual(len(tri.convex_hull), 0)
                self.assertTrue((tri.neighbors >= 0).all())
                corners = tri.points[tri.simplices] + tri.offsets
                volumes = np.linalg.det(corners[:, 1:] - corners[:, :1])
                self.assertTrue((volumes > 0).all())
                factorial = {2: 2, 3: 6}[dim]
                self.assertAlmostEqual(volumes.sum() / factorial, 1, places=9)
                self.assertTrue((np.abs(tri.circumcenters - 0.5) < 0.5 + 1e-9).all())

    def test_boxes_are_told_by_corners_or_by_periods(self):
        for dim in DIMENSIONS:
            points = random_points(300, dim)
            same = [1, 1.0, [1] * dim, np.ones(dim), box_of(dim), np.array(box_of(dim))]
            hashes = {spillway.Delaunay(points, periodic=box).hash for box in same}
            self.assertEqual(len(hashes), 1)
            self.assertEqual(spillway.Delaunay(points, periodic=1).periodic, box_of(dim))

    def test_axes_may_be_open(self):
        points = random_points(300, 2)
        tri = spillway.Delaunay(points, periodic=((None, 0), (None, 1)))
        self.assertEqual(tri.periodic, ((None, 0.0), (None, 1.0)))
        self.assertGreater(len(tri.convex_hull), 0)
        self.assertTrue((tri.offsets[:, :, 0] == 0).all())
        self.assertEqual(tri.hash, spillway.Delaunay(points, periodic=(0, 1)).hash)
        self.assertEqual(tri.hash, spillway.Delaunay(points, periodic=(None, 1)).hash)

    def test_questions_are_the_same_for_all_copies_of_a_place(self):
        for dim in DIMENSIONS:
            points = np.round(random_points(400, dim) * 1024) / 1024
            tri = spillway.Delaunay(points, periodic=1)
            places = np.round(random_points(200, dim, seed=2) * 4096) / 4096
            values = random_points(400, 2, seed=3)
            far = places + np.arange(dim) - 2
            self.assertTrue((tri.find_simplex(places) >= 0).all())
            np.testing.assert_array_equal(tri.find_simplex(places), tri.find_simplex(far))
            np.testing.assert_array_equal(tri.nearest(places), tri.nearest(far))
            np.testing.assert_array_equal(
                tri.interpolate(places, values), tri.interpolate(far, values)
            )
            away = places[:, None] - points
            away -= np.round(away)
            nearest = (away * away).sum(axis=2).argmin(axis=1)
            self.assertGreater((tri.nearest(places) == nearest).mean(), 0.99)  # but for ties

    def test_others_have_no_offsets(self):
        tri = spillway.Delaunay(random_points(50, 2))
        self.assertIsNone(tri.offsets)
        self.assertIsNone(tri.periodic)

    def test_copies_and_pickles_have_the_box(self):
        tri = spillway.Delaunay(random_points(300, 3), periodic=(1, 1, 0))
        self.assertIs(copy.copy(tri), tri)
        other = pickle.loads(pickle.dumps(tri))
        self.assertEqual((other.hash, other.periodic), (tri.hash, tri.periodic))
        self.assertIs(type(tri), tri.__class__)

    def test_barycentric_coordinates_are_those_of_the_corners(self):
        tri = spillway.Delaunay(random_points(300, 2), periodic=1)
        corners = tri.points[tri.simplices] + tri.offsets
        maps = tri.transform
        middle = corners.mean(axis=1) - maps[:, 2]
        found = np.einsum("nij,nj->ni", maps[:, :2], middle)
        np.testing.assert_allclose(found, 1 / 3, atol=1e-6)

    def test_what_cannot_be_is_refused(self):
        points = random_points(100, 2)
        for box, text in (
            ((1, 2, 3), "periodic has 3 periods; give 2"),
            (((0, 0), (1, 1), (2, 2)), "periodic has 3 corners; give the lower and the upper one"),
            (((0, 0, 0), (1, 1, 1)), "periodic has 3 coordinates in a corner; give 2"),
            (((0, None), (1, 1)), "periodic has one side along y"),
            (-1, "periodic has the period -1"),
            (((1, 1), (0, 2)), "the periodic box has no length along x"),
            (0, "the periodic box has no periodic axis"),
        ):
            with self.subTest(box=box), self.assertRaisesRegex(ValueError, text):
                spillway.Delaunay(points, periodic=box)
        with self.assertRaisesRegex(ValueError, "periodic boxes have 2 or 3 dimensions, not 4"):
            spillway.Delaunay(random_points(100, 4), periodic=1)
        with self.assertRaisesRegex(spillway.Error, "too few points for a triangulation"):
            spillway.Delaunay(points[:3], periodic=1)
        with self.assertRaises(TypeError):
            spillway.Delaunay(points, periodic="1")
        tri = spillway.Delaunay(points, periodic=1)
        with self.assertRaisesRegex(ValueError, "no periodic meshes"):
            tri.to_meshio()
        with self.assertRaisesRegex(ValueError, "periodic"):
            tri.equations


class Streams(InFolder):
    def test_files_have_the_hash_of_the_mesh_in_memory(self):
        for dim in DIMENSIONS:
            points = random_points(3000, dim) + 7
            box = box_of(dim, 7.0)
            report = spillway.triangulate(points, "mesh.spm", dim=dim, periodic=box)
            tri = spillway.Delaunay(points, periodic=box)
            self.assertEqual(report.canonical_hash, tri.hash)

    def test_blocks_have_offsets_and_the_box(self):
        points = random_points(3000, 2)
        with spillway.blocks(points, periodic=1) as blocks:
            made = list(blocks)
        self.assertEqual(blocks.periodic, box_of(2))
        offsets = np.concatenate([block.offsets for block in made])
        simplices = np.concatenate([block.simplices for block in made])
        vertices = np.concatenate([block.vertices for block in made])[:, :2]
        corners = vertices[simplices] + offsets
        volumes = np.linalg.det(corners[:, 1:] - corners[:, :1])
        self.assertTrue((volumes > 0).all())
        self.assertAlmostEqual(volumes.sum() / 2, 1, places=9)
        spillway.triangulate(points, "mesh.spm", periodic=1)
        with spillway.blocks("mesh.spm") as read:
            self.assertIsNotNone(next(read).offsets)
            self.assertEqual(read.periodic, box_of(2))

    def test_blocks_of_others_have_none(self):
        with spillway.blocks(random_points(100, 2)) as blocks:
            self.assertIsNone(next(blocks).offsets)
            self.assertIsNone(blocks.periodic)

    def test_other_values_are_told(self):
        with self.assertRaisesRegex(TypeError, "periodic is 'a'; give box, float or sequence"):
            spillway.triangulate(random_points(100, 2), "mesh.spm", periodic="a")
        with self.assertRaisesRegex(TypeError, "unexpected keyword argument 'periodic'"):
            spillway.dem(random_points(100, 3), "dem.tif", resolution=1, periodic=1)


if __name__ == "__main__":
    unittest.main()
