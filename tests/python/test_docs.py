"""The code in docs/python.md, in README.md and in docstrings runs."""

import contextlib
import doctest
import functools
import io
import os
import pathlib
import re
import tempfile
import unittest

import spillway
from support import needed

os.environ["MPLBACKEND"] = "Agg"
needed("matplotlib", "matplotlib")
needed("scipy", "SciPy")

PAGE = pathlib.Path(__file__).parents[2] / "docs" / "python.md"


class Docs(unittest.TestCase):
    def test_the_code_of_the_page_runs_from_top_to_bottom(self):
        page = PAGE.read_text(encoding="utf-8")
        blocks = re.findall(r"^```python\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
        self.assertGreater(len(blocks), 5)
        names, printed = {}, io.StringIO()
        self.addCleanup(os.chdir, os.getcwd())
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            with contextlib.redirect_stdout(printed):
                for block in blocks:
                    exec(compile(block, str(PAGE), "exec"), names)
            self.assertGreater(os.path.getsize("hills.png"), 10_000)
        said = re.search(r"^    print\(error\) +# (.*)$", page, re.MULTILINE).group(1)
        self.assertIn(said, printed.getvalue())

    def test_the_code_of_the_first_page_runs(self):
        page = (PAGE.parents[1] / "README.md").read_text(encoding="utf-8")
        (block,) = re.findall(r"^```python\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            exec(compile(block, "README.md", "exec"), {})
        self.assertGreaterEqual(int(printed.getvalue()), 0)

    def test_every_attribute_of_the_page_is_there(self):
        tri = spillway.Delaunay([[0, 0], [1, 0], [0, 1]])
        table = re.search(r"^\| attribute .*?\n\n", PAGE.read_text("utf-8"), re.M | re.S).group().strip()
        for row in table.splitlines()[2:]:
            for name in re.findall(r"`(\w+)`", row.split("|")[1]):
                with self.subTest(attribute=name):
                    self.assertTrue(hasattr(tri, name))

    def test_examples_in_docstrings(self):
        self.assertEqual(doctest.testmod(spillway).failed, 0)

    def test_everything_public_has_a_docstring(self):
        for owner in (spillway, spillway.errors, spillway.Delaunay):
            for name, value in vars(owner).items():
                described = callable(value) or isinstance(value, (property, functools.cached_property))
                if described and not name.startswith("_"):
                    with self.subTest(owner=owner.__name__, name=name):
                        self.assertTrue(value.__doc__)


if __name__ == "__main__":
    unittest.main()
