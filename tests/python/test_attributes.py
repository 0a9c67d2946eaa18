"""What points carry besides coordinates, in and out of NumPy."""

import pathlib
import unittest

import numpy as np
import spillway
from support import InFolder, random_points


def survey(count):
    """Points with attributes of several types, as a structured array."""
    rng = np.random.default_rng(5)
    fields = [("x", "f8"), ("y", "f8"), ("z", "f8"), ("intensity", "u2"), ("depth", "<i4")]
    points = np.zeros(count, [*fields, ("gps_time", "f8"), ("normal", "f4", 3)])
    for axis in "xyz":
        points[axis] = rng.integers(0, 6400, count) / 64
    points["intensity"] = rng.integers(0, 65536, count)
    points["depth"] = rng.integers(-1000, 1000, count)
    points["gps_time"] = rng.random(count)
    points["normal"] = rng.random((count, 3))
    return points


class Attributes(InFolder):
    def test_a_structured_array_comes_back_from_files(self):
        points = survey(500)
        for name in ("points.las", "points.laz", "points.spp", "points.npy"):
            with self.subTest(file=name):
                scale = 1 / 64 if "la" in name else None
                self.assertEqual(spillway.convert(points, name, scale=scale).lost, [])
                back = spillway.read_points(name, attributes=points.dtype.names[3:])
                self.assertEqual(set(back.dtype.names), set(points.dtype.names))
                for field in points.dtype.names:
                    self.assertEqual(back.dtype[field], points.dtype[field])
                    np.testing.assert_array_equal(back[field], points[field])

    def test_a_dict_of_arrays_is_a_structured_array(self):
        points = survey(50)
        spillway.convert(points, "array.spp")
        by_name = {name: points[name] for name in points.dtype.names}
        spillway.convert({**by_name, "depth": points["depth"].astype(">i4")}, "dict.spp")
        with open("array.spp", "rb") as one, open("dict.spp", "rb") as other:
            self.assertEqual(one.read(), other.read())

    def test_files_of_numpy_are_what_is_read(self):
        spillway.generate("terrain", 300, "hills.las")
        spillway.convert("hills.las", "hills.npy")
        read = spillway.read_points("hills.las", attributes="all")
        np.testing.assert_array_equal(read, np.load("hills.npy"))

    def test_without_names_points_are_rows(self):
        points = random_points(100, 2)
        spillway.convert(points, "points.npy")
        np.testing.assert_array_equal(spillway.read_points("points.npy"), points)
        with self.assertRaisesRegex(ValueError, 'no attribute "colour"'):
            spillway.read_points("points.npy", attributes=["colour"])
        self.assertEqual(len(spillway.read_points("points.npy", every=4)), 25)

    def test_scaled_numbers_are_what_is_meant(self):
        spillway.generate("terrain", 20, "hills.las", las_version="1.4")
        angles = spillway.read_points("hills.las", attributes="scan_angle")["scan_angle"]
        self.assertEqual(angles.dtype, np.float64)

    def test_a_structured_array_is_triangulated_by_its_coordinates(self):
        points = survey(200)
        report = spillway.triangulate(points, "mesh.spm")
        rows = np.column_stack([points[axis] for axis in "xyz"])
        self.assertEqual(report.canonical_hash, spillway.Delaunay(rows, dim=2).hash)

    def test_blocks_have_attributes_by_name(self):
        for block in spillway.blocks(survey(100)):
            self.assertEqual(block.attributes, {})
        points = survey(100)
        vertices = 0
        for block in spillway.blocks(points, id=True, attributes="all"):
            for name in points.dtype.names:
                if name not in "xyz":
                    np.testing.assert_array_equal(
                        block.attributes[name], points[name][block.input_index]
                    )
            vertices += len(block.vertices)
        self.assertEqual(vertices, 100)

    def test_vertices_of_files_keep_what_points_carry(self):
        points = survey(100)
        spillway.triangulate(points, "mesh.npy", id=True, attributes="all")
        index = np.load("mesh_input_index.npy")
        carried = np.load("mesh_attributes.npy")
        self.assertEqual(set(carried.dtype.names), set(points.dtype.names) - set("xyz"))
        for name in carried.dtype.names:
            np.testing.assert_array_equal(carried[name], points[name][index])
        spillway.triangulate(points, "mesh.spm", attributes="all")
        spillway.convert("mesh.spm", "none.ply", attributes=[])
        spillway.convert("mesh.spm", "all.ply")
        sizes = [pathlib.Path(name).stat().st_size for name in ("none.ply", "all.ply")]
        self.assertLess(*sizes)
        with self.assertRaisesRegex(ValueError, 'no attribute "colour"'):
            spillway.triangulate(points, "mesh.spm", attributes="colour")

    def test_what_cannot_be_an_attribute_is_named(self):
        x = np.arange(4.0)
        wrong = {
            "has no field y": {"x": x},
            "one number a point": {"x": x, "y": x[:3]},
            r"inputs\['a'\] has elements of type <U1": {"x": x, "y": x, "a": list("abcd")},
            r"a row for each of the 4 points": {"x": x, "y": x, "a": x[:3]},
        }
        for message, inputs in wrong.items():
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                spillway.convert(inputs, "out.spp")
        with self.assertRaisesRegex(ValueError, "in memory already"):
            spillway.read_points(survey(3))

    def test_info_lists_them(self):
        spillway.convert(survey(10), "points.spp")
        told = spillway.info("points.spp").attributes
        values = survey(10)
        for name, more in (("intensity", {"type": "uint16"}), ("normal", {"elements": 3})):
            attribute = next(one for one in told if one["name"] == name)
            self.assertLessEqual(more.items(), attribute.items())
            self.assertEqual(attribute["min"], values[name].min())
            self.assertEqual(attribute["max"], values[name].max())


if __name__ == "__main__":
    unittest.main()
