"""In the hands of meshio."""

import unittest

import numpy as np
import spillway
from support import needed, random_points

needed("meshio", "meshio")


class InTheHandsOfMeshio(unittest.TestCase):
    def test_cells_and_points_are_passed_on(self):
        points = random_points(40, 3)
        for dim, kind in ((2, "triangle"), (3, "tetra")):
            tri = spillway.Delaunay(points, dim=dim)
            mesh = tri.to_meshio()
            np.testing.assert_array_equal(mesh.points, points)
            np.testing.assert_array_equal(mesh.cells_dict[kind], tri.simplices)


if __name__ == "__main__":
    unittest.main()
