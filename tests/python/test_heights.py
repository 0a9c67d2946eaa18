"""Heights above ground are those of the command, and those that NumPy finds on planes."""

import unittest

import numpy as np
import spillway
from support import InFolder, bytes_of, command, random_points


def slope(points):
    """Heights of a plane."""
    return 0.5 * points[:, 0] - 0.25 * points[:, 1]


def on_slope(points, above=0.0):
    return np.column_stack([points, slope(points) + above])


class Heights(InFolder):
    def setUp(self):
        super().setUp()
        corners = np.array([(0, 0), (1, 0), (0, 1), (1, 1)], float)
        self.ground = on_slope(np.vstack([corners, random_points(200, 2)]))
        self.above = np.linspace(-2, 8, 500)
        self.points = on_slope(random_points(500, 2), self.above)

    def test_of_arrays_are_an_array(self):
        heights = spillway.height(self.points, ground=self.ground)
        self.assertEqual(heights.shape, (500,))
        np.testing.assert_allclose(heights, self.above, atol=1e-12)

    def test_beside_the_ground_are_no_numbers(self):
        self.points[7, 0] = 5
        with self.assertWarnsRegex(spillway.Warning, "1 point lies over no triangle"):
            heights = spillway.height(self.points, ground=self.ground)
        self.assertEqual(np.flatnonzero(np.isnan(heights)).tolist(), [7])

    def test_above_a_mesh_are_those_above_its_points(self):
        spillway.triangulate(self.ground, "ground.spm")
        np.testing.assert_array_equal(
            spillway.height(self.points, ground="ground.spm"),
            spillway.height(self.points, ground=self.ground),
        )

    def test_a_file_has_the_bytes_of_the_command(self):
        command("generate", "scan", "-n", 3000, "-o", "scan.las")
        command("convert", "scan.las", "-o", "ground.las", "--every", 9)
        cases = {
            "": {},
            "--replace-z --min-height 0": {"replace_z": True, "min_height": 0},
            "--nodata -1 --attributes none": {"nodata": -1, "attributes": []},
        }
        for words, options in cases.items():
            with self.subTest(options=words):
                command("height", "scan.las", "--ground", "ground.las", "-o", "a.las", *words.split())
                with self.assertWarns(spillway.Warning):
                    report = spillway.height("scan.las", "b.las", ground="ground.las", **options)
                self.assertEqual(bytes_of("b.las"), bytes_of("a.las"))
                self.assertGreater(report.without_ground, 0)

    def test_classes_choose_the_ground(self):
        carried = {
            "x": np.r_[self.ground[:, 0], self.points[:, 0]],
            "y": np.r_[self.ground[:, 1], self.points[:, 1]],
            "z": np.r_[self.ground[:, 2], self.points[:, 2]],
            "classification": np.r_[np.full(204, 2, np.uint8), np.full(500, 5, np.uint8)],
        }
        spillway.convert(carried, "all.spp")
        heights = spillway.height("all.spp", ground_class=2, keep_class=5)
        np.testing.assert_allclose(heights, self.above, atol=1e-12)

    def test_canopies_are_those_of_the_command(self):
        command("convert", self.write_forest(), "-o", "forest.las", "--scale", 0.001)
        raster = ["--resolution", 0.1, "--product", "chm"]
        command("dem", "forest.las", "-o", "a.tif", *raster)
        spillway.dem("forest.las", "b.tif", resolution=0.1, product="chm", ground_class=2)
        self.assertEqual(bytes_of("b.tif"), bytes_of("a.tif"))
        values = spillway.dem("forest.las", resolution=0.1, product="chm").values
        self.assertGreater(np.nanmax(values), 5)
        self.assertGreaterEqual(np.nanmin(values), 0)

    def write_forest(self):
        rows = [(*p, 2) for p in self.ground] + [(*p, 5) for p in self.points]
        np.savetxt("forest.csv", rows, delimiter=",", header="x,y,z,classification", comments="")
        return "forest.csv"

    def test_options_that_have_no_effect_are_refused(self):
        spillway.triangulate(self.ground, "ground.spm")
        with self.assertRaisesRegex(ValueError, "what is the ground"):
            spillway.height(self.points)
        with self.assertRaisesRegex(ValueError, "of an array give ground"):
            spillway.height(self.points, ground_class=2)
        with self.assertRaisesRegex(ValueError, "nodata has no effect without an output"):
            spillway.height(self.points, ground=self.ground, nodata=3)
        with self.assertRaisesRegex(ValueError, "max_edge has no effect where the ground is a mesh"):
            spillway.height(self.points, ground="ground.spm", max_edge=3)


if __name__ == "__main__":
    unittest.main()
