"""What is installed as the component `python` is all that the module needs."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import spillway
from support import random_points


class Install(unittest.TestCase):
    def test_the_installed_package_works_from_any_folder(self):
        points = random_points(200, 2)
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run(
                ["cmake", "--install", os.environ["SPILLWAY_BUILD"]]
                + ["--component", "python", "--prefix", f"{folder}/prefix"],
                check=True,
                stdout=subprocess.DEVNULL,
            )
            (package,) = pathlib.Path(folder).glob("prefix/lib/python3*/*-packages/spillway")
            self.assertEqual(
                sorted(file.name for file in package.iterdir()),
                sorted(n for n in os.listdir(spillway.__path__[0]) if n != "__pycache__"),
            )
            moved = package.parent.rename(f"{folder}/packages")
            program = (
                "import os, numpy as np, spillway\n"
                f"points = np.array({points.tolist()})\n"
                "print(spillway.Delaunay(points).hash)\n"
                "heights = np.column_stack([points, points.sum(axis=1)])\n"
                "if os.path.exists(f'{spillway.__path__[0]}/spillway_gdal.so'):\n"
                "    spillway.dem(heights, 'heights.tif', resolution=0.1)\n"
            )
            printed = subprocess.run(
                [sys.executable, "-c", program],
                env={**os.environ, "PYTHONPATH": str(moved)},
                cwd=folder,
                check=True,
                capture_output=True,
                text=True,
            ).stdout
        self.assertEqual(printed.strip(), spillway.Delaunay(points).hash)


if __name__ == "__main__":
    unittest.main()
