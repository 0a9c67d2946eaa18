"""`pip install` of a checkout works without a network, and what it installs is complete."""

import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import spillway
from support import random_points

SOURCE = pathlib.Path(__file__).resolve().parents[2] / "python"


class Pip(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if importlib.util.find_spec("ensurepip") is None:
            raise unittest.SkipTest("needs python3-venv, which is not installed")

    def test_a_checkout_is_installed_into_a_virtual_environment_without_a_network(self):
        points = random_points(500, 3)
        with tempfile.TemporaryDirectory() as folder:
            environment = pathlib.Path(folder) / "environment"
            python = str(environment / "bin" / "python")
            self.run_quietly(sys.executable, "-m", "venv", "--system-site-packages", environment)
            self.run_quietly(python, "-m", "pip", "install", "--no-index", SOURCE)
            np.save(f"{folder}/points.npy", points)
            program = (
                "import numpy, spillway; print(spillway.__path__[0], spillway.__version__,"
                " spillway.Delaunay(numpy.load('points.npy')).hash)"
            )
            package, version, found = self.run_quietly(python, "-c", program, cwd=folder).split()
            self.assertTrue(pathlib.Path(package).is_relative_to(environment))
            self.assertEqual(version, spillway.__version__)
            self.assertEqual(found, spillway.Delaunay(points).hash)
            self.assertEqual(
                sorted(n for n in os.listdir(package) if n != "__pycache__"),
                sorted(n for n in os.listdir(spillway.__path__[0]) if n != "__pycache__"),
            )
            self.run_quietly(python, "-m", "pip", "uninstall", "--yes", "spillway")
            self.assertFalse(os.path.exists(package))

    def run_quietly(self, *command, cwd=None):
        """What a command prints. What it says where it fails stands in the test's message."""
        # Not the package of the build folder.
        environment = {name: v for name, v in os.environ.items() if name != "PYTHONPATH"}
        done = subprocess.run(
            command, cwd=cwd, env=environment, capture_output=True, text=True, check=False
        )
        self.assertEqual(done.returncode, 0, f"{command}:\n{done.stdout}\n{done.stderr}")
        return done.stdout


if __name__ == "__main__":
    unittest.main()
