"""Densities have the mass of the points, and are those of the command."""

import os
import pathlib
import unittest

import numpy as np
import spillway
from support import DIMENSIONS, InFolder, bytes_of, command, random_points


def corners_of(dim, side):
    """The box from 0 as the command has it, and as the module has it."""
    return ",".join(["0"] * dim + [str(side)] * dim), ((0,) * dim, (side,) * dim)


class Files(InFolder):
    def test_the_mass_is_the_number_of_points(self):
        for dim in DIMENSIONS:
            points = random_points(1000, dim) * 10
            for options in ({}, {"periodic": 10}):
                with self.subTest(dim=dim, options=options):
                    report = spillway.density(points, "rho.npy", dim=dim, **options)
                    self.assertIsInstance(report, spillway.DensityReport)
                    self.assertAlmostEqual(report.mass, 1000, places=6)
                    if options:
                        self.assertAlmostEqual(report.volume / 10**dim, 1, places=9)
                    else:
                        self.assertLess(report.volume, 10**dim)
                    values = np.load("rho.npy")["density"]
                    self.assertEqual((values.min(), values.max()), (report.least, report.most))
                    self.assertEqual(report.points, 1000)
                    self.assertIn("<spillway.DensityReport: mass 1000, density from", repr(report))
                    self.assertIn("\n  least  ", str(report))

    def test_files_are_those_of_the_command(self):
        for dim in DIMENSIONS:
            np.save("points.npy", random_points(2000, dim))
            words, box = corners_of(dim, 1)
            middle, where = corners_of(dim, 0.5)
            cells = (8, 12, 6)[:dim]
            grid = ["--grid", ",".join(map(str, cells))]
            for name, told, options in (
                ("rho.npy", [], {}),
                ("rho.vtu", [], {}),
                ("rho.ply", [], {}),
                ("rho.spm", ["--periodic", words], {"periodic": box}),
                ("rho.npy", grid, {"grid": cells}),
                ("rho.npy", [*grid, "--periodic", words], {"grid": cells, "periodic": box}),
                ("rho.npy", [*grid, "--grid-box", middle], {"grid": cells, "grid_box": where}),
                ("rho.npy", ["--every", 2], {"every": 2}),
            ):
                with self.subTest(dim=dim, told=told, name=name):
                    command("density", "-q", "points.npy", "--dim", dim, *told, "-o", f"c_{name}")
                    spillway.density("points.npy", f"m_{name}", dim=dim, **options)
                    self.assertEqual(bytes_of(f"m_{name}"), bytes_of(f"c_{name}"))
                    if name == "rho.npy":
                        np.testing.assert_array_equal(
                            spillway.density("points.npy", dim=dim, **options), np.load("c_rho.npy")
                        )

    def test_an_array_is_as_its_file(self):
        points = random_points(500, 2)
        np.save("points.npy", points)
        for options in ({}, {"periodic": (1, 0)}, {"grid": (9, 9)}):
            np.testing.assert_array_equal(
                spillway.density(points, **options), spillway.density("points.npy", **options)
            )

    def test_weights_are_what_points_carry(self):
        points = random_points(400, 3)
        mass = np.arange(400) * 0.5
        fields = {**dict(zip("xyz", points.T)), "mass": mass, "other": np.ones(400)}
        report = spillway.density(fields, "rho.npy", dim=3, periodic=1, weight="mass")
        self.assertAlmostEqual(report.mass, mass.sum(), places=6)
        self.assertEqual(report.least, 0)
        even = spillway.density(fields, dim=3, periodic=1)
        heavy = spillway.density(fields, dim=3, periodic=1, weight="mass")
        order = [np.lexsort((table["z"], table["y"], table["x"])) for table in (even, heavy)]
        given = np.lexsort(points.T[::-1])
        np.testing.assert_allclose(
            heavy["density"][order[1]], even["density"][order[0]] * mass[given], rtol=1e-12
        )
        rows = np.column_stack([points, mass])
        np.savetxt("gas.csv", rows, "%.17g", ",", header="x,y,z,mass", comments="")
        command("density", "-q", "gas.csv", "--dim", 3, "--weight", "mass", "-o", "c.npy")
        np.testing.assert_array_equal(
            spillway.density("gas.csv", dim=3, weight="mass"), np.load("c.npy")
        )
        for unknown in (points, fields, "gas.csv"):
            with self.assertRaisesRegex(spillway.errors.InvalidArgumentError, 'no attribute "age"'):
                spillway.density(unknown, dim=3, weight="age")

    def test_pictures_of_the_plane_are_geotiffs(self):
        report = spillway.density(random_points(300, 2), "rho.tif", grid=(20, 20), periodic=1)
        self.assertEqual(report.output_format, "tif")
        with self.assertRaisesRegex(ValueError, "GeoTIFF holds rasters of the plane"):
            spillway.density(random_points(300, 3), "rho.tif", dim=3, grid=(4, 4, 4))


class Arrays(InFolder):
    def test_of_vertices_have_fields(self):
        for columns, dim, names in ((2, 2, "x y"), (3, 2, "x y z"), (3, 3, "x y z")):
            points = random_points(300, columns)
            table = spillway.density(points, dim=dim)
            self.assertEqual(table.dtype.names, (*names.split(), "density"))
            self.assertEqual(table.shape, (300,))
            found = np.column_stack([table[name] for name in names.split()])
            self.assertEqual(set(map(tuple, found)), set(map(tuple, points)))
            self.assertTrue((table["density"] > 0).all())

    def test_of_grids_have_their_shape_and_are_nan_outside(self):
        for dim in DIMENSIONS:
            points = random_points(2000, dim)
            cells = (10, 20, 15)[:dim]
            values = spillway.density(points, dim=dim, grid=cells, grid_box=(0,) * dim + (2,) * dim)
            self.assertEqual((values.shape, values.dtype), (cells, np.float64))
            inside = np.zeros(cells, bool)
            inside[tuple(slice(0, count // 2) for count in cells)] = True
            self.assertTrue(np.isnan(values[~inside]).all())
            self.assertGreater(np.isfinite(values[inside]).mean(), 0.5)
            around = spillway.density(points, dim=dim, grid=cells, periodic=1)
            self.assertTrue(np.isfinite(around).all())

    def test_of_periodic_points_go_with_them_around_the_box(self):
        points = np.round(random_points(500, 2) * 1024) / 1024
        values = spillway.density(points, periodic=1, grid=(16, 16))
        moved = spillway.density((points + (0.25, 0.5)) % 1, periodic=1, grid=(16, 16))
        far = spillway.density(points + (3, -2), periodic=1, grid=[16, 16])
        np.testing.assert_allclose(np.roll(values, (4, 8), (0, 1)), moved, rtol=1e-9)
        np.testing.assert_array_equal(values, far)
        fine = spillway.density(points, periodic=1, grid=(400, 400))
        self.assertAlmostEqual(fine.mean() / 500, 1, 1)

    def test_leave_no_files(self):
        spillway.density(random_points(300, 2), grid=(5, 5), scratch_folder="tmp")
        spillway.density(random_points(300, 2), scratch_folder=pathlib.Path("tmp"))
        spillway.density(random_points(300, 2), scratch_folder=os.fsencode("tmp"))
        with self.assertRaises(spillway.errors.DegenerateInputError):
            spillway.density(np.zeros((9, 2)), scratch_folder="tmp")
        self.assert_nothing_is_left()
        with self.assertRaisesRegex(spillway.errors.InputOutputError, "nowhere: No such") as caught:
            spillway.density(random_points(9, 2), scratch_folder="nowhere")
        self.assertEqual(caught.exception.filename, "nowhere")


class Arguments(InFolder):
    def test_what_is_wrong_is_told(self):
        points = random_points(100, 2)
        for words, options in (
            ("max_edge has no effect on densities", {"max_edge": 1}),
            ("heights has no effect on densities", {"heights": "mean"}),
            ("resume has no effect on densities", {"resume": "folder"}),
            ("checkpoint_every has no effect without resume", {"checkpoint_every": 1}),
            ("grid_box has no effect without grid", {"grid_box": (0, 0, 1, 1)}),
            ("every has no effect on an array", {"every": 2}),
            ("grid has 3 axes, and the densities 2", {"grid": (2, 2, 2)}),
            ("grid has 1 axes, and the densities 2", {"grid": 2}),
            (r"grid is \(0, 2\); give its cells", {"grid": (0, 2)}),
            ("grid is .*from 1 to 1000000", {"grid": (2, 1_000_001)}),
            ("grid_box has 6 numbers; give the 2 least", {"grid": (2, 2), "grid_box": (0,) * 6}),
            ("no length along some axis", {"grid": (2, 2), "grid_box": (0, 0, 0, 1)}),
            ("no length along some axis", {"grid": (2, 2), "grid_box": (0, 0, 1, np.inf)}),
            ("dim is 4; give 2 or 3", {"dim": 4}),
            ("dim is 3, but points has 2 columns", {"dim": 3}),
        ):
            with self.subTest(options=options):
                with self.assertRaisesRegex(spillway.errors.InvalidArgumentError, words):
                    spillway.density(points, **options)
        for words, options in (
            ("grid is 'ab'; give sequence of int", {"grid": "ab"}),
            (r"grid is \(1.5, 2\); give sequence of int", {"grid": (1.5, 2)}),
            ("grid_box is 'abcd'; give box", {"grid": (2, 2), "grid_box": "abcd"}),
            ("weight is 3; give str", {"weight": 3}),
            ("path is of type int; give a path", {"path": 3}),
            ("'wieght'. Did you mean 'weight'", {"wieght": "mass"}),
        ):
            with self.subTest(options=options), self.assertRaisesRegex(TypeError, words):
                spillway.density(points, **options)
        with self.assertRaisesRegex(ValueError, "a grid of densities is npy or GeoTIFF"):
            spillway.density(points, "rho.vtu", grid=(2, 2))
        self.assert_nothing_is_left()


if __name__ == "__main__":
    unittest.main()
