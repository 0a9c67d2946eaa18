"""Shows pages of `spillway render` in Chromium, and compares what is seen with what should be.

    page_in_browser.py COMMAND

COMMAND is the spillway to run. The terrain is a hill whose heights and slopes are known at every place: where each is
seen, how bright and in which colour follows from these. Ends with 77 (skipped) where there is no Chromium.
"""

import json
import math
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

COMMAND = pathlib.Path(sys.argv.pop(1)).resolve()
BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
SKIPPED = 77
SIZE = 400, 300
VIEW = {"panels": 0, "azimuth": 180, "elevation": 90, "distance": 4, "light": 315, "altitude": 45}
EXAGGERATION = 1.5


def height(x, y):
    return 500 + 20 * math.exp(-((x - 60) ** 2 + (y - 40) ** 2) / 800)


def gradient(x, y):
    return [-2 * away / 800 * (height(x, y) - 500) for away in (x - 60, y - 40)]


class Picture:
    """A PNG of 8 bits a channel, as browsers write them."""

    def __init__(self, path):
        stored = path.read_bytes()
        chunks, at = {}, 8
        while at < len(stored):
            (length,) = struct.unpack(">I", stored[at : at + 4])
            name = stored[at + 4 : at + 8]
            chunks[name] = chunks.get(name, b"") + stored[at + 8 : at + 8 + length]
            at += length + 12
        self.width, self.height, depth, kind = struct.unpack(">IIBB", chunks[b"IHDR"][:10])
        assert depth == 8 and kind in (2, 6), "a PNG of another kind"
        channels = 3 if kind == 2 else 4
        lines, stride = zlib.decompress(chunks[b"IDAT"]), channels * self.width
        self.rows, above = [], bytes(stride)
        for start in range(0, len(lines), stride + 1):
            line = bytearray(lines[start + 1 : start + 1 + stride])
            for i in range(stride):
                left = line[i - channels] if i >= channels else 0
                corner = above[i - channels] if i >= channels else 0
                line[i] = (line[i] + guess(lines[start], left, above[i], corner)) & 255
            self.rows.append([tuple(line[i : i + 3]) for i in range(0, stride, channels)])
            above = line


def guess(kind, left, above, corner):
    """What a filter of PNG takes a byte for."""
    if kind == 4:
        from_left, from_above = abs(above - corner), abs(left - corner)
        from_corner = abs(left + above - 2 * corner)
        if from_left <= from_above and from_left <= from_corner:
            return left
        return above if from_above <= from_corner else corner
    return (0, left, above, (left + above) // 2)[kind]


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.work = tempfile.TemporaryDirectory(prefix="spillway-browser-")
        cls.folder = pathlib.Path(cls.work.name)
        points = [(x / 2, y / 2) for x in range(201) for y in range(161)]
        lines = (f"{x} {y} {height(x, y):.6f}\n" for x, y in points)
        (cls.folder / "hill.txt").write_text("".join(lines), encoding="ascii")
        render = [COMMAND, "render", "-q", "hill.txt", "-o", "hill.html", "--triangles", "30000", "--ramp", "grey"]
        subprocess.run([*render, "--exaggerate", str(EXAGGERATION)], cwd=cls.folder, check=True, timeout=60)
        cls.text = (cls.folder / "hill.html").read_text(encoding="utf-8")
        found = re.search(r'<script id="relief" type="application/json">(.*?)</script>', cls.text)
        cls.relief = json.loads(found[1])

    @classmethod
    def tearDownClass(cls):
        cls.work.cleanup()

    def shown(self, page="hill.html", **view):
        """What a browser shows of the page, looked at in this way."""
        address = (self.folder / page).as_uri() + "#" + "&".join(f"{name}={value}" for name, value in view.items())
        options = ["--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
        options += ["--hide-scrollbars", "--force-device-scale-factor=1", f"--window-size={SIZE[0]},{SIZE[1]}"]
        options += [f"--user-data-dir={self.folder / 'profile'}", f"--screenshot={self.folder / 'shown.png'}"]
        subprocess.run([BROWSER, *options, address], check=True, timeout=120, capture_output=True)
        picture = Picture(self.folder / "shown.png")
        self.assertEqual((picture.width, picture.height), SIZE)
        return picture

    def pixel(self, x, y, view):
        """Where a place of the surface is seen: a pinhole camera that looks at the middle of the grid and
        of the heights in colours."""
        relief = self.relief
        longer = (max(relief["columns"], relief["rows"]) - 1) * relief["side"]
        middle = [relief["columns"] * relief["side"] / 2, 80 - relief["rows"] * relief["side"] / 2]
        z = (height(x, y) - sum(relief["range"]) / 2) * EXAGGERATION
        place = [2 * value / longer for value in (x - middle[0], y - middle[1], z)]
        a, e = math.radians(view["azimuth"]), math.radians(view["elevation"])
        # Turned about the vertical until one looks from the south, then tipped.
        right = -place[0] * math.cos(a) + place[1] * math.sin(a)
        away = -place[0] * math.sin(a) - place[1] * math.cos(a)
        up = away * math.sin(e) + place[2] * math.cos(e)
        near = place[2] * math.sin(e) - away * math.cos(e)
        scale = min(SIZE) / 2 / math.tan(math.radians(17.5)) / (view["distance"] - near)
        return SIZE[0] / 2 + right * scale, SIZE[1] / 2 - up * scale

    def colour(self, x, y, view):
        """The colour of a place in the light."""
        low, high = self.relief["range"]
        first, last = (int(text[1:3], 16) for text in self.relief["ramps"]["grey"])
        own = first + min(max((height(x, y) - low) / (high - low), 0), 1) * (last - first)
        azimuth, altitude = math.radians(view["light"]), math.radians(view["altitude"])
        light = math.sin(azimuth) * math.cos(altitude), math.cos(azimuth) * math.cos(altitude), math.sin(altitude)
        east, north = (EXAGGERATION * slope for slope in gradient(x, y))
        normal = [value / math.hypot(east, north, 1) for value in (-east, -north, 1)]
        brightness = max(0, sum(a * b for a, b in zip(normal, light)))
        if brightness <= light[2]:
            return own * (0.28 + 0.72 * brightness / light[2])
        return own + (255 - own) * 0.4 * (brightness - light[2]) / (1 - light[2])

    def expect(self, view):
        picture = self.shown(**view)
        differences = []
        for x in range(4, 97, 4):
            for y in range(4, 77, 4):
                column, row = self.pixel(x, y, view)
                seen = picture.rows[int(row)][int(column)]
                self.assertEqual(len(set(seen)), 1, "grey")
                differences.append(abs(seen[0] - self.colour(x, y, view)))
        differences.sort()
        self.assertLess(differences[len(differences) // 2], 2, "half of the places are as they should be")
        self.assertLess(differences[-1], 14, "and none is far off: a pixel shows more than one place")
        for x, y in ((-8, 40), (108, 40), (50, -8), (50, 88)):
            column, row = self.pixel(x, y, view)
            self.assertEqual(picture.rows[int(row)][int(column)], (255, 255, 255), "background")
        return picture

    def test_from_above_light_and_colours_are_those_of_the_hill(self):
        picture = self.expect(VIEW)
        facing, behind = (self.pixel(60 - way, 40 + way, VIEW) for way in (12, -12))
        brightness = [picture.rows[int(row)][int(column)][0] for column, row in (facing, behind)]
        self.assertGreater(brightness[0], brightness[1] + 50)

    def test_from_aside(self):
        self.expect({**VIEW, "azimuth": 215, "elevation": 65})

    def test_light_from_elsewhere(self):
        self.expect({**VIEW, "light": 100, "altitude": 30})

    def test_colours_of_its_own(self):
        # Two classes, west and east of the top, on level ground: ground and water.
        rows = (f"{x},{y},5,{2 if x < 50 else 9}\n" for x in range(101) for y in range(81))
        (self.folder / "classes.csv").write_text("x,y,z,classification\n" + "".join(rows), encoding="ascii")
        render = [COMMAND, "render", "-q", "classes.csv", "-o", "classes.html", "--triangles", "20000"]
        subprocess.run([*render, "--color", "class"], cwd=self.folder, check=True, timeout=60)
        picture = self.shown("classes.html", **VIEW)
        self.assertEqual(picture.rows[150][150], (191, 144, 94))
        self.assertEqual(picture.rows[150][250], (66, 134, 222))
        by_height = self.shown("classes.html", **VIEW, ramp="grey")
        self.assertEqual(by_height.rows[150][150], by_height.rows[150][250])

    def test_a_browser_without_webgl_is_told_so(self):
        options = ["--headless", "--no-sandbox", "--disable-3d-apis", "--dump-dom"]
        options += [f"--user-data-dir={self.folder / 'other-profile'}"]
        address = (self.folder / "hill.html").as_uri()
        shown = subprocess.run([BROWSER, *options, address], check=True, timeout=120, capture_output=True, text=True)
        self.assertIn('<div id="failure" class="panel">This browser has no WebGL 2', shown.stdout)

    def test_keys_wheel_pointer_and_sliders_do_what_the_address_does(self):
        script = """
          const canvas = document.getElementById("view");
          const key = (name) => canvas.dispatchEvent(new KeyboardEvent("keydown", {key: name}));
          const point = (kind, x, y) => canvas.dispatchEvent(
              new PointerEvent(kind, {pointerId: 7, clientX: x, clientY: y, buttons: 1}));
          for (let i = 0; i < 4; ++i) key("ArrowRight");
          canvas.dispatchEvent(new WheelEvent("wheel", {deltaY: -100, cancelable: true}));
          point("pointerdown", 100, 100);
          point("pointermove", 150, 25);
          point("pointerup", 150, 25);
          point("pointermove", 300, 300);
          const slider = document.getElementById("azimuth");
          slider.value = 45;
          slider.dispatchEvent(new Event("input", {bubbles: true}));
        """
        (self.folder / "moved.html").write_text(
            self.text.replace("</body>", f"<script>{script}</script></body>"), encoding="utf-8"
        )
        moved = self.shown("moved.html", **VIEW)
        there = {**VIEW, "azimuth": 220, "elevation": 60, "distance": 4 * math.exp(-0.2), "light": 45}
        expected = self.shown(**there)
        self.assertEqual(moved.rows, expected.rows)
        self.assertNotEqual(moved.rows, self.shown(**VIEW).rows)


if __name__ == "__main__":
    if BROWSER is None:
        print("skipped: there is no Chromium to show pages in")
        sys.exit(SKIPPED)
    unittest.main(verbosity=2)
