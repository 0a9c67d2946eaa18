"""What the tests of the Python module have in common."""

import importlib
import json
import os
import subprocess
import tempfile
import unittest

import numpy as np

COMMAND = os.environ["SPILLWAY_COMMAND"]
DIMENSIONS = (2, 3)


def needed(name, package):
    """A module of another package. Where it is missing, the tests of the whole file are skipped."""
    try:
        return importlib.import_module(name)
    except ImportError:
        raise unittest.SkipTest(f"needs {package}, which is not installed") from None


def random_points(count, dim, seed=1):
    return np.random.default_rng(seed).random((count, dim))


def as_set(rows):
    """Rows of vertices, each as a set, in an order of their own."""
    rows = np.sort(rows, axis=1)
    return rows[np.lexsort(rows.T)]


def degenerate_sets(dim):
    """Names and points of sets with many ties, which span the dimension."""
    rng = np.random.default_rng(7)
    grid = np.stack(np.meshgrid(*[np.arange(12.0)] * dim), axis=-1).reshape(-1, dim)
    yield "grid", grid
    yield "grid with duplicates", rng.permutation(np.concatenate([grid, grid[:40], grid[:10]]))
    angle = np.arange(64) * (2 * np.pi / 64)
    circle = np.zeros((64, dim))
    circle[:, 0], circle[:, 1] = np.cos(angle), np.sin(angle)
    yield "circle", np.concatenate([circle, circle / 2, np.eye(dim), np.zeros((1, dim))])
    line = np.zeros((50, dim))
    line[:, 0] = np.arange(50)
    yield "collinear but for a few", np.concatenate([line, np.eye(dim) + 0.5])
    yield "far from the origin", np.round(rng.random((300, dim)), 2) + 5e6


def hash_by_command(points):
    """The canonical hash that `spillway triangulate` tells."""
    with tempfile.TemporaryDirectory() as folder:
        np.save(f"{folder}/points.npy", points)
        subprocess.run(
            [COMMAND, "triangulate", "-q", "points.npy", "--dim", str(points.shape[1])]
            + ["-o", "mesh.spm", "--stats", "run.json"],
            cwd=folder,
            check=True,
        )
        with open(f"{folder}/run.json", encoding="utf-8") as figures:
            return json.load(figures)["canonical_hash"]


def command(*arguments):
    """Runs the command in the current folder, and returns what it prints."""
    return subprocess.run(
        [COMMAND, *map(str, arguments)], check=True, capture_output=True, text=True
    ).stdout


def bytes_of(path):
    with open(path, "rb") as file:
        return file.read()


class InFolder(unittest.TestCase):
    """Tests in an empty folder of their own, which has a folder `tmp` for scratch files."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)
        os.mkdir("tmp")

    def assert_nothing_is_left(self, *names):
        """There are these files, and no scratch file."""
        self.assertEqual(os.listdir("tmp"), [])
        self.assertEqual(sorted(os.listdir(".")), sorted(["tmp", *names]))
