"""Volumes are those of the command, and those of prisms."""

import json
import unittest

import numpy as np
import spillway
from support import InFolder, command, random_points

CORNERS = np.array([(0, 0), (1, 0), (0, 1), (1, 1)], float)


def plane(count, seed, height):
    """Points on a plane over the unit square."""
    places = np.vstack([CORNERS, random_points(count, 2) * 0.98 + 0.01 * (seed + 1) / 10])
    return np.column_stack([places, height(places[:, 0], places[:, 1])])


class Volumes(InFolder):
    def test_between_planes_are_those_of_prisms(self):
        level = plane(100, 1, lambda x, y: 0 * x + 1)
        slope = plane(150, 2, lambda x, y: 2 * x)
        found = spillway.volume(slope, level)
        # 2x - 1 over the unit square: a quarter above, a quarter below.
        for name, expected in {
            "cut": 0.25, "fill": 0.25, "net": 0, "cut_area": 0.5, "fill_area": 0.5,
            "area": 1, "first_area": 1, "second_area": 1,
        }.items():
            self.assertAlmostEqual(getattr(found, name), expected, places=12, msg=name)
        above = spillway.volume(slope, level=1, z_factor=3)
        self.assertAlmostEqual(above.cut, 0.75, places=12)
        self.assertEqual(above.second_area, 0)
        self.assertIn("cut 0.75", repr(above))

    def test_are_those_of_the_command(self):
        command("generate", "terrain", "-n", 5000, "-o", "a.las")
        command("generate", "terrain", "-n", 4000, "--seed", 2, "-o", "b.las")
        command("triangulate", "b.las", "-o", "b.spm")
        for words, second, options in (
            (["b.las"], "b.las", {}),
            (["b.spm"], "b.spm", {}),
            (["--level", 380, "--z-factor", 2], None, {"level": 380, "z_factor": 2}),
            (["b.las", "--max-edge", 20], "b.las", {"max_edge": 20}),
        ):
            told = json.loads(command("volume", "a.las", *words, "--json"))
            found = spillway.volume("a.las", second, **options)
            for name in ("cut", "fill", "net", "cut_area", "fill_area", "area", "first_area"):
                self.assertEqual(getattr(found, name), told[name], (words, name))

    def test_tell_what_is_wrong(self):
        points = plane(9, 1, lambda x, y: x)
        for message, second, options in (
            ("Give a second one, or level", None, {}),
            ("Give a second one, or level", points, {"level": 1}),
            ("resume has no effect with two surfaces", points, {"resume": "folder"}),
        ):
            with self.assertRaisesRegex(spillway.errors.InvalidArgumentError, message):
                spillway.volume(points, second, **options)
        with self.assertWarnsRegex(spillway.Warning, "no area in common"):
            spillway.volume(points, points + [5, 5, 0])


if __name__ == "__main__":
    unittest.main()
