"""The types that the package declares are right, and are those of its functions."""

import inspect
import pathlib
import subprocess
import sys
import tempfile
import unittest

import spillway
from support import needed

needed("mypy", "mypy")

PROGRAM = """
from typing import Any, Iterator
import numpy as np
from numpy.typing import NDArray
import spillway

raster: spillway.Raster = spillway.dem("a.las", resolution=1.0, keep_class=2, memory="1G")
height: NDArray[np.float32] = raster.values
file: spillway.RasterReport = spillway.dem("a.las", "a.tif", resolution=1.0, cog=True)
points: NDArray[np.float64] = spillway.generate("uniform", 10)
written: spillway.GenerateReport = spillway.generate("uniform", 10, "a.npy")
blocks: Iterator[spillway.Block] = spillway.blocks(points, thin=(0.5, "lowest"))
densities: NDArray[Any] = spillway.density(points, dim=3, periodic=1.0, grid=(4, 4, 4))
mass: float = spillway.density("a.las", "a.vtu", weight="mass").mass
report: spillway.RunReport = spillway.triangulate(["a.las"], "a.ply", progress=print)
"""


class Types(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cache = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cache.cleanup)
        cls.cache = cache.name

    def mypy(self, *arguments):
        run = subprocess.run(
            [sys.executable, "-m", "mypy", "--strict", "--enable-incomplete-feature=Unpack"]
            + ["--cache-dir", self.cache, *arguments],
            cwd=pathlib.Path(spillway.__path__[0]).parent,
            capture_output=True,
            text=True,
        )
        return run.stdout + run.stderr

    def test_the_package_keeps_its_own_types(self):
        self.assertIn("Success", self.mypy("-p", "spillway"))

    def test_a_program_is_checked_by_them(self):
        self.assertIn("Success", self.mypy("-c", PROGRAM))
        told = self.mypy("-c", PROGRAM + "spillway.triangulate('a', 'b', memmory=3)\n")
        self.assertIn('Unexpected keyword argument "memmory"', told)
        told = self.mypy("-c", PROGRAM + "spillway.check('a', every='3')\n")
        self.assertIn("incompatible type", told)

    def test_docstrings_describe_every_argument(self):
        for name in spillway.__all__:
            function = getattr(spillway, name)
            if not inspect.isfunction(function):
                continue
            for argument in inspect.signature(function).parameters:
                with self.subTest(function=name, argument=argument):
                    self.assertRegex(function.__doc__, rf"(?m)^    (\w+, )*{argument}(, \w+)* : ")


if __name__ == "__main__":
    unittest.main()
