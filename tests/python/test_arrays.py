"""What is taken as points: types of numbers, strides, and refusals."""

import tracemalloc
import unittest

import numpy as np
import spillway
from spillway import errors
from support import DIMENSIONS, random_points


class ArraysOfPoints(unittest.TestCase):
    def test_every_type_and_layout_gives_the_same_mesh(self):
        for dim in DIMENSIONS:
            points = np.random.default_rng(3).integers(0, 60, (200, dim))
            expected = spillway.Delaunay(points.astype(float)).simplices
            wide = np.zeros((400, 2 * dim + 1))
            wide[::2, ::2][:, :dim] = points
            locked = points.astype(float)
            locked.flags.writeable = False
            record = np.zeros(200, dtype=[("flag", "u1"), ("place", float, (dim,))])
            record["place"] = points
            layouts = {
                "list": points.tolist(),
                "strided": wide[::2, ::2][:, :dim],
                "Fortran": np.asfortranarray(points.astype(float)),
                "backwards": np.ascontiguousarray(points[::-1, ::-1].astype(float))[::-1, ::-1],
                "read-only": locked,
                "not aligned": record["place"],
                "masked, nothing hidden": np.ma.array(points.astype(float)),
            }
            for kind in "i1 u1 i2 u2 i4 >i4 i8 u8 >i8 f2 f4 >f4 <f8 >f8".split():
                layouts[kind] = points.astype(kind)
            for name, layout in layouts.items():
                with self.subTest(dim=dim, layout=name):
                    tri = spillway.Delaunay(layout)
                    np.testing.assert_array_equal(tri.simplices, expected)
                    np.testing.assert_array_equal(tri.points, points)

    def test_no_copy_is_made_of_float64(self):
        points = random_points(100_000, 2)
        heights = random_points(100_000, 3)
        for name, layout in {"contiguous": points, "every other": heights[::2, ::2]}.items():
            with self.subTest(layout=name):
                tracemalloc.start()
                tri = spillway.Delaunay(layout)
                _, most = tracemalloc.get_traced_memory()
                tracemalloc.stop()
                self.assertLess(most, layout.nbytes / 10)
                self.assertEqual(tri.npoints, len(layout))

    def test_later_changes_of_the_array_do_not_matter(self):
        points = random_points(50, 3)
        tri = spillway.Delaunay(points, dim=2)
        before = points.copy()
        points[:] = 0
        np.testing.assert_array_equal(tri.points, before[:, :2])
        np.testing.assert_array_equal(tri.z, before[:, 2])


class BadPoints(unittest.TestCase):
    def refused(self, kind, text, points, **options):
        with self.assertRaisesRegex(spillway.Error, text) as caught:
            spillway.Delaunay(points, **options)
        self.assertIs(type(caught.exception), kind)
        self.assertIsInstance(caught.exception, ValueError)

    def test_not_finite(self):
        for bad in (np.nan, np.inf, -np.inf):
            points = random_points(100, 2)
            points[42, 1] = bad
            self.refused(errors.InvalidArgumentError, "point 42 .* not finite", points)
            heights = np.column_stack([random_points(100, 2), points[:, 1]])
            self.refused(errors.InvalidArgumentError, "point 42 .* not finite", heights, dim=2)

    def test_shape(self):
        for points in (3.0, [], [1.0, 2.0], np.zeros((3, 7)), np.zeros((3, 1)), np.zeros((2, 2, 2))):
            self.refused(errors.InvalidArgumentError, "give rows of 2 to 6", points)
        self.refused(errors.InvalidArgumentError, "no array of numbers", [[1, 2], [3]])

    def test_types_without_an_exact_value(self):
        for points in (
            np.array([[0, "a"]], object),
            [["a", "b"]],
            [[1j, 0]],
            [[True, False]],
            np.zeros((4, 2), np.longdouble),
            np.zeros(4, [("x", float), ("y", float)]),
            np.zeros((4, 2), "M8[s]"),
        ):
            self.refused(errors.InvalidArgumentError, "give real numbers", points)

    def test_integers_that_would_be_rounded(self):
        for corner in (2**53 + 1, -(2**53) - 1):
            points = [[0, 0], [1, 0], [0, corner]]
            self.refused(errors.InvalidArgumentError, "subtract an offset", points)
        self.assertEqual(spillway.Delaunay([[0, 0], [1, 0], [0, 2**53]]).nsimplex, 1)

    def test_masked(self):
        points = np.ma.array(random_points(5, 2))
        points[2, 0] = np.ma.masked
        self.refused(errors.InvalidArgumentError, "masked", points)

    def test_rows_that_are_masked(self):
        rows = [np.ma.array([1.0, 2.0], mask=[True, False]), [3, 4], [9, 1]]
        self.refused(errors.InvalidArgumentError, "masked", rows)

    def test_what_is_no_array_at_all(self):
        for points in (None, (row for row in [[0, 0], [1, 0], [0, 1]]), {(0, 0), (1, 0), (0, 1)}):
            name = type(points).__name__
            self.refused(errors.InvalidArgumentError, f"points is of type {name}; give", points)

    def test_degenerate(self):
        line = np.outer(np.arange(9.0), [1, 2, 3])
        for dim, points in {
            "no points, .* no triangle": np.zeros((0, 2)),
            "no points, .* no tetrahedron": np.zeros((0, 3)),
            r"all points \(1\) lie at one place": [[1, 2]],
            r"all points \(7\) lie at one place": np.ones((7, 3)),
            r"all points \(2\) lie on one line": [[0, 0], [1, 2]],
            "on one line: they span no triangle": line[:, :2],
            "on one line: they span no tetrahedron": line,
            "on one plane: they span no tetrahedron": random_points(9, 3) * [1, 1, 0],
        }.items():
            self.refused(errors.DegenerateInputError, dim, points)

    def test_dim(self):
        self.refused(errors.InvalidArgumentError, "dim is 4", random_points(9, 3), dim=4)
        self.refused(errors.InvalidArgumentError, "dim is 7", random_points(9, 3), dim=7)
        self.refused(errors.InvalidArgumentError, "2 columns", random_points(9, 2), dim=3)
        self.refused(errors.InvalidArgumentError, "4 columns", random_points(9, 4), dim=2)
        both = np.array([2, 3])
        self.refused(errors.InvalidArgumentError, "dim is array", random_points(9, 3), dim=both)

    def test_threads_and_progress(self):
        points = random_points(9, 2)
        for threads in (0, -1, 4097):
            self.refused(errors.InvalidArgumentError, "threads is", points, threads=threads)
        for options in ({"threads": "2"}, {"threads": 1.5}, {"progress": 3}):
            with self.assertRaisesRegex(TypeError, f"{next(iter(options))} is .*; give"):
                spillway.Delaunay(points, **options)


class Errors(unittest.TestCase):
    def test_each_code_has_a_class_that_is_also_python_s_own(self):
        for code, kind in {
            "invalid argument": ValueError,
            "degenerate input": ValueError,
            "too large": ValueError,
            "interrupted": Exception,
            "bad input": ValueError,
            "input or output": OSError,
            "out of budget": MemoryError,
            "closed pipe": BrokenPipeError,
        }.items():
            error = errors.make_error(code, "what is wrong")
            self.assertIsInstance(error, spillway.Error)
            self.assertIsInstance(error, kind)
            self.assertEqual((error.code, str(error)), (code, "what is wrong"))


if __name__ == "__main__":
    unittest.main()
