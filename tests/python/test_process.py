"""A triangulation among what else goes on in a process: pickles, threads, forks, signals, progress."""

import concurrent.futures
import copy
import errno
import os
import pickle
import signal
import threading
import time
import unittest

import numpy as np
import spillway
from support import DIMENSIONS, random_points


class Copies(unittest.TestCase):
    def test_a_pickle_is_read_as_the_same_triangulation(self):
        cases = [(random_points(300, dim), None) for dim in DIMENSIONS]
        for points, dim in [*cases, (random_points(300, 3), 2)]:
            tri = spillway.Delaunay(points, dim=dim, threads=1)
            for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1):
                other = pickle.loads(pickle.dumps(tri, protocol))
                self.assertIs(type(other), spillway.Delaunay)
                np.testing.assert_array_equal(other.simplices, tri.simplices)
                np.testing.assert_array_equal(other.points, tri.points)
                self.assertEqual(other.z is None, tri.z is None)

    def test_a_copy_is_the_same_object(self):
        tri = spillway.Delaunay(random_points(10, 2))
        self.assertIs(copy.copy(tri), tri)
        self.assertIs(copy.deepcopy({"a": tri})["a"], tri)

    def test_errors_can_be_pickled(self):
        with self.assertRaises(spillway.Error) as caught:
            spillway.Delaunay(np.zeros((3, 2)))
        other = pickle.loads(pickle.dumps(caught.exception))
        self.assertEqual(
            (type(other), str(other)), (type(caught.exception), str(caught.exception))
        )

    def test_a_pickled_error_keeps_file_and_number_of_the_system(self):
        with self.assertRaises(OSError) as caught:
            spillway.info("not there.las")
        other = pickle.loads(pickle.dumps(caught.exception))
        for error in (caught.exception, other):
            self.assertEqual((error.errno, error.filename), (errno.ENOENT, "not there.las"))
            self.assertEqual((error.file, str(error)), ("not there.las", str(caught.exception)))


class Threads(unittest.TestCase):
    def test_runs_and_questions_beside_each_other(self):
        sets = [random_points(20_000, 2 + i % 2, seed=i) for i in range(8)]
        expected = [spillway.Delaunay(points).hash for points in sets]
        with concurrent.futures.ThreadPoolExecutor(4) as pool:
            found = list(pool.map(lambda points: spillway.Delaunay(points, threads=2), sets))
            self.assertEqual([tri.hash for tri in found], expected)
            tri = found[0]
            asked = pool.map(lambda _: tri.find_simplex(sets[0]), range(8))
            for cells in asked:
                np.testing.assert_array_equal(cells, tri.find_simplex(sets[0]))

    def test_other_threads_run_meanwhile(self):
        ticks = []
        done = threading.Event()

        def tick():
            while not done.wait(0.001):
                ticks.append(time.monotonic())

        clock = threading.Thread(target=tick)
        clock.start()
        begin = time.monotonic()
        spillway.Delaunay(random_points(500_000, 2), threads=1)
        end = time.monotonic()
        done.set()
        clock.join()
        self.assertGreater(sum(begin < t < end for t in ticks), 3)


@unittest.skipUnless(hasattr(os, "fork"), "needs fork(), which this system has not")
class Fork(unittest.TestCase):
    def test_a_child_triangulates_and_asks_with_threads_of_its_own(self):
        points = random_points(300_000, 2)
        tri = spillway.Delaunay(points, threads=3)
        cells = tri.find_simplex(points)
        child = os.fork()
        if child == 0:
            signal.alarm(60)
            same = spillway.Delaunay(points, threads=3).hash == tri.hash
            same = same and np.array_equal(tri.find_simplex(points), cells)
            threads = "/proc/self/task"
            several = not os.path.exists(threads) or len(os.listdir(threads)) > 1
            os._exit(0 if same and several else 1)
        _, status = os.waitpid(child, 0)
        self.assertEqual(os.waitstatus_to_exitcode(status), 0)
        self.assertEqual(spillway.Delaunay(points, threads=3).hash, tri.hash)


class Interruption(unittest.TestCase):
    def test_ctrl_c_ends_a_run_in_its_midst(self):
        # The signal comes when the run tells of its first progress.
        told = []

        def press(fraction):
            told.append(fraction)
            signal.raise_signal(signal.SIGINT)

        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        try:
            with self.assertRaises(KeyboardInterrupt):
                spillway.Delaunay(random_points(2_000_000, 2), threads=1, progress=press)
        finally:
            signal.signal(signal.SIGINT, before)
        self.assertLess(max(told), 1)

    def test_ctrl_c_from_outside_without_progress(self):
        points = random_points(3_000_000, 2)
        before = signal.signal(signal.SIGALRM, signal.default_int_handler)
        try:
            signal.setitimer(signal.ITIMER_REAL, 0.1)
            with self.assertRaises(KeyboardInterrupt):
                spillway.Delaunay(points, threads=1)
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, before)
        self.assertEqual(spillway.Delaunay(points[:100]).npoints, 100)


class Progress(unittest.TestCase):
    def test_fractions_rise_to_one_in_the_thread_of_the_caller(self):
        told, threads = [], set()

        def progress(fraction):
            told.append(fraction)
            threads.add(threading.get_ident())

        spillway.Delaunay(random_points(1_500_000, 2), threads=1, progress=progress)
        self.assertGreater(len(told), 1)
        self.assertEqual(told, sorted(set(told)))
        self.assertEqual(told[-1], 1)
        self.assertEqual(threads, {threading.get_ident()})

    def test_what_it_raises_ends_the_run(self):
        def progress(fraction):
            raise ZeroDivisionError(f"at {fraction}")

        with self.assertRaises(ZeroDivisionError):
            spillway.Delaunay(random_points(1_500_000, 2), threads=1, progress=progress)


if __name__ == "__main__":
    unittest.main()
