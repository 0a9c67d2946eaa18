"""A mesh block by block: the mesh of the command, and nothing left behind however the loop ends."""

import gc
import os
import pathlib
import signal
import subprocess
import sys
import threading
import unittest

import numpy as np
import spillway
from support import InFolder, as_set, command, random_points


def gathered(blocks):
    """Vertices, simplices and input indices of all blocks, which are seen to keep the rules."""
    vertices, simplices, index, finalized = [], [], [], []
    count, done = 0, set()
    for block in blocks:
        assert block.first_vertex == count
        count += len(block.vertices)
        assert block.simplices.dtype == block.finalized.dtype == np.int64
        assert block.simplices.max(initial=0) < count
        assert not done.intersection(block.simplices.ravel())
        done.update(block.finalized)
        vertices.append(block.vertices)
        simplices.append(block.simplices)
        index.append(block.input_index)
    assert done == set(range(count))
    return np.concatenate(vertices), np.concatenate(simplices), index


class TheMesh(InFolder):
    def test_all_blocks_are_the_mesh(self):
        for dim in (2, 3):
            points = random_points(20_000, dim)
            blocks = spillway.blocks(points, dim=dim, id=True, leaf_points=1000)
            vertices, simplices, index = gathered(blocks)
            numbers = np.concatenate(index)
            np.testing.assert_array_equal(points[numbers], vertices[:, :dim])
            expected = spillway.Delaunay(points)
            np.testing.assert_array_equal(as_set(numbers[simplices]), as_set(expected.simplices))
            self.assertEqual(blocks.report.canonical_hash, expected.hash)

    def test_out_of_core_from_files_within_little_memory(self):
        command("generate", "terrain", "-n", 1_000_000, "-o", "hills.las")
        command("triangulate", "hills.las", "-o", "mesh.spm", "--memory", "32M")
        blocks = spillway.blocks("hills.las", memory="32M", scratch_folder="tmp")
        vertices, simplices, index = gathered(blocks)
        self.assertEqual(set(index), {None})
        told = spillway.info("mesh.spm")
        self.assertEqual(blocks.report.canonical_hash, told.canonical_hash)
        self.assertEqual((len(vertices), len(simplices)), (told.vertices, told.simplices))
        self.assertGreater(blocks.report.spilled_points, 0)
        self.assert_nothing_is_left("hills.las", "mesh.spm")

    def test_a_mesh_that_is_there_is_read_along(self):
        points = random_points(5000, 2)
        report = spillway.triangulate(points, "mesh.spm", id=True)
        blocks = spillway.blocks("mesh.spm")
        vertices, simplices, index = gathered(blocks)
        self.assertEqual(len(simplices), report.simplices)
        np.testing.assert_array_equal(points[np.concatenate(index)], vertices[:, :2])
        with self.assertRaisesRegex(ValueError, "every, id have no effect on a mesh"):
            spillway.blocks("mesh.spm", id=True, every=2)

    def test_heights_are_carried_along(self):
        points = np.column_stack([random_points(100, 2), np.arange(100)])
        vertices, _, index = gathered(spillway.blocks(points, id=True))
        np.testing.assert_array_equal(points[np.concatenate(index)], vertices)

    def test_arrays_outlive_the_loop(self):
        kept = [block.vertices for block in spillway.blocks(random_points(30_000, 2))]
        gc.collect()
        self.assertEqual(sum(map(len, kept)), 30_000)
        self.assertTrue(all(0 <= v.min() and v.max() <= 1 for v in kept if len(v)))


class Endings(InFolder):
    """`run` makes more blocks than wait, and spills."""

    def run_blocks(self, **options):
        points = random_points(1_000_000, 2)
        return spillway.blocks(points, memory="32M", scratch_folder="tmp", leaf_points=2000, **options)

    def test_a_loop_that_is_left_early_ends_the_run(self):
        for block in self.run_blocks():
            self.assertNotEqual(os.listdir("tmp"), [])
            break
        gc.collect()
        self.assert_nothing_is_left()

    def test_blocks_that_nobody_takes_end_with_the_object(self):
        blocks = self.run_blocks()
        del blocks
        gc.collect()
        self.assert_nothing_is_left()

    def test_close_and_with(self):
        blocks = self.run_blocks()
        next(blocks)
        blocks.close()
        self.assert_nothing_is_left()
        self.assertEqual(list(blocks), [])
        self.assertIsNone(blocks.report)
        with self.run_blocks() as blocks:
            next(blocks)
        self.assert_nothing_is_left()

    def test_an_exception_in_the_loop_ends_the_run(self):
        with self.assertRaises(ZeroDivisionError):
            for block in self.run_blocks():
                raise ZeroDivisionError
        gc.collect()
        self.assert_nothing_is_left()

    def test_an_error_of_the_run_is_raised_in_the_loop(self):
        pathlib.Path("typo.txt").write_text("1 2 3\n" * 10 + "7 8 g\n")
        with self.assertRaisesRegex(spillway.errors.BadInputError, "typo.txt: line 11"):
            list(spillway.blocks("typo.txt", columns=[1, 2, 3]))
        with self.assertRaisesRegex(OSError, "nowhere.las"):
            list(spillway.blocks("nowhere.las"))
        blocks = spillway.blocks(np.zeros((9, 2)))
        with self.assertRaises(spillway.errors.DegenerateInputError):
            next(blocks)
        self.assertEqual(list(blocks), [])

    def test_ctrl_c_in_the_loop(self):
        told = []

        def press(fraction):
            told.append(fraction)
            signal.raise_signal(signal.SIGINT)

        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        try:
            with self.assertRaises(KeyboardInterrupt):
                for block in self.run_blocks(progress=press):
                    pass
        finally:
            signal.signal(signal.SIGINT, before)
        self.assertLess(max(told), 1)
        self.assert_nothing_is_left()

    def test_the_end_of_the_interpreter_ends_the_run(self):
        program = (
            "import numpy as np, spillway\n"
            "points = np.random.default_rng(1).random((1_000_000, 2))\n"
            "blocks = spillway.blocks(points, memory='32M', scratch_folder='tmp', leaf_points=2000)\n"
            "next(blocks)\n"
            "held = [blocks]; held.append(held)\n"
        )
        subprocess.run([sys.executable, "-c", program], check=True, timeout=60)
        self.assert_nothing_is_left()

    @unittest.skipUnless(hasattr(os, "fork"), "needs fork(), which this system has not")
    def test_a_child_of_fork_leaves_the_run_to_its_parent(self):
        program = (
            "import os, sys, numpy as np, spillway\n"
            "points = np.random.default_rng(1).random((1_000_000, 2))\n"
            "blocks = spillway.blocks(points, memory='32M', scratch_folder='tmp', leaf_points=2000)\n"
            "next(blocks)\n"
            "child = os.fork()\n"
            "if child == 0: sys.exit(0)\n"
            "assert os.waitpid(child, 0)[1] == 0\n"
            "assert sum(len(block.vertices) for block in blocks) > 900_000\n"
        )
        subprocess.run([sys.executable, "-c", program], check=True, timeout=60)
        self.assert_nothing_is_left()

    def test_blocks_may_be_taken_by_several_threads(self):
        blocks, counts = self.run_blocks(), []

        def take():
            counts.append(sum(len(block.simplices) for block in blocks))

        threads = [threading.Thread(target=take) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(sum(counts), spillway.Delaunay(random_points(1_000_000, 2)).nsimplex)


if __name__ == "__main__":
    unittest.main()
