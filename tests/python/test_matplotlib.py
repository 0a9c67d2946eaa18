"""In the hands of matplotlib."""

import unittest

import numpy as np
import spillway
from support import needed, random_points

matplotlib = needed("matplotlib", "matplotlib")
matplotlib.use("Agg")
tri_module = needed("matplotlib.tri", "matplotlib")


class InTheHandsOfMatplotlib(unittest.TestCase):
    def test_a_triangulation_with_neighbours_and_a_finder(self):
        points = random_points(300, 2)
        tri = spillway.Delaunay(points)
        theirs = tri_module.Triangulation(points[:, 0], points[:, 1], tri.simplices)
        np.testing.assert_array_equal(theirs.triangles, tri.simplices)
        # Its k-th neighbor lies beyond the edge from the k-th vertex to the next.
        np.testing.assert_array_equal(theirs.neighbors, np.roll(tri.neighbors, -2, axis=1))
        places = random_points(100, 2, seed=2)
        found = theirs.get_trifinder()(places[:, 0], places[:, 1])
        np.testing.assert_array_equal(found, tri.find_simplex(places))


if __name__ == "__main__":
    unittest.main()
