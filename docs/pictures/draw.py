"""Draws the pictures of the pages, by the command and the Python module.

    python3 docs/pictures/draw.py COMMAND [FOLDER] [--points N]

COMMAND is the spillway to run, FOLDER where pictures go (beside this file, if left out). N is the largest set of points
for resident-border.svg: 1e8, which takes a minute or two. Needs the module spillway and matplotlib; for page.png also
Chromium, without which that picture is left as it is.
"""

import argparse
import json
import pathlib
import shutil
import subprocess
import tempfile
import warnings

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import spillway

INK, FINAL, BORDER = "#333333", "#7fb069", "#e8833a"
plt.rcParams.update({"font.size": 9, "axes.edgecolor": INK, "svg.hashsalt": "spillway", "savefig.dpi": 120})


def main():
    parser = argparse.ArgumentParser(description="Draws the pictures of the pages.")
    parser.add_argument("command", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path, nargs="?", default=pathlib.Path(__file__).parent)
    parser.add_argument("--points", type=float, default=1e8)
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="spillway-pictures-") as work:
        scene = Scene(arguments.command.resolve(), pathlib.Path(work), arguments.folder.resolve())
        draw_mesh(scene)
        draw_dem(scene)
        draw_products(scene)
        draw_contours(scene)
        draw_smooth_contours(scene)
        draw_bands(scene)
        draw_colours(scene)
        draw_aslant(scene)
        draw_page(scene)
        draw_section(scene)
        draw_haloes(scene)
        draw_border(scene)
        draw_resident_border(scene, int(arguments.points))


class Scene:
    """A hilly country with woods and houses, and where its files lie."""

    def __init__(self, command, work, folder):
        self.command, self.work, self.folder = command, work, folder
        self.spillway("generate", "terrain", "-n", "4e5", "--seed", "7", "-o", "hills.las")
        low = spillway.info(str(work / "hills.las")).extent[0]
        self.x, self.y = (100 * np.floor(value / 100) for value in low[:2])

    def spillway(self, *arguments):
        subprocess.run([self.command, *map(str, arguments), "-q"], cwd=self.work, check=True)

    def box(self, west, south, east, north):
        """A box in metres from the corner of the country, as --zoom and --bounds take it."""
        return f"{self.x + west},{self.y + south},{self.x + east},{self.y + north}"

    def pixels(self, **options):
        return spillway.dem(str(self.work / "hills.las"), **options)

    def render(self, inputs, name, *arguments):
        """A picture that the command draws as it is to be."""
        self.spillway("render", inputs, "-o", name, *arguments)
        (self.work / name).replace(self.folder / name)

    def features(self, *arguments):
        """Lines or polygons of the lowest points."""
        lowest = ("--thin", "6:lowest", "--force-crs")
        self.spillway("contour", "hills.las", "-o", "features.geojson", *lowest, *arguments)
        return json.loads((self.work / "features.geojson").read_text(encoding="utf-8"))["features"]

    def save(self, figure, name):
        options = {"metadata": {"Date": None}} if name.endswith(".svg") else {}
        figure.savefig(self.folder / name, bbox_inches="tight", **options)
        plt.close(figure)


def draw_mesh(scene):
    scene.render("hills.las", "relief.png", "--thin", 2, "--max-edge", 40, "--size", 640)
    zoom = scene.box(300, 150, 360, 195)
    scene.render("hills.las", "mesh.png", "--zoom", zoom, "--wireframe", "--size", 520)


def draw_dem(scene):
    """The same place with everything on it, and from the lowest points."""
    box = tuple(float(side) for side in scene.box(60, 100, 300, 260).split(","))
    figure, axes = plt.subplots(1, 2, figsize=(8.4, 3))
    for axis, title, options in zip(axes, ("all points", "the lowest one in 6 m"), ({}, {"thin": (6, "lowest")})):
        axis.imshow(scene.pixels(resolution=0.5, product="hillshade", bounds=box, **options).values, cmap="gray")
        axis.set(title=title, xticks=[], yticks=[])
    scene.save(figure, "dem.png")


def draw_products(scene):
    """Products of one place: of the lowest points, and what stands above these."""
    box = tuple(float(side) for side in scene.box(60, 100, 300, 260).split(","))
    place = {"resolution": 1, "bounds": box}
    of_ground = {
        "height": "gist_earth", "slope": "YlOrRd", "aspect": "twilight", "hillshade": "gray",
        "facet-hillshade": "gray", "multi-hillshade": "gray", "roughness": "YlOrRd", "curvature": "PuOr",
    }
    ground = scene.pixels(product=list(of_ground), thin=(6, "lowest"), **place).values
    scene.spillway("convert", "hills.las", "-o", "low.las", "--thin", "6:lowest")
    above = ("hills.las", "--ground", "low.las", "--replace-z", "--min-height", 0, "-o", "above.las")
    scene.spillway("height", *above)
    heights = spillway.dem(str(scene.work / "above.las"), heights="highest", **place).values
    figure, axes = plt.subplots(3, 3, figsize=(8.4, 6.6))
    panels = [*zip(of_ground, ground, of_ground.values()), ("height above the ground", heights, "viridis")]
    for axis, (title, values, colours) in zip(axes.flat, panels):
        most = np.nanpercentile(np.abs(values), 98)
        limits = {"vmin": -most, "vmax": most} if title == "curvature" else {}
        axis.imshow(values, cmap=colours, **limits)
        axis.set(title=title, xticks=[], yticks=[])
    scene.save(figure, "products.png")


def draw_contours(scene):
    """Contours of the lowest points over their shaded relief."""
    lines = scene.features("--interval", 2)
    shade = scene.pixels(resolution=1, product="hillshade", thin=(6, "lowest"))
    west, step, _, north, _, _ = shade.geotransform
    rows, columns = shade.values.shape
    figure, axis = plt.subplots(figsize=(6.4, 4.6))
    extent = (west, west + step * columns, north - step * rows, north)
    axis.imshow(shade.values, cmap="gray", vmin=-60, extent=extent)
    for line in lines:
        x, y, *_ = np.array(line["geometry"]["coordinates"]).T
        heavy = line["properties"]["index"] == 1
        axis.plot(x, y, color="#8a4b1f", linewidth=1.1 if heavy else 0.4)
    axis.set(xticks=[], yticks=[], xlim=(scene.x + 50, scene.x + 370), ylim=(scene.y + 80, scene.y + 310))
    scene.save(figure, "contours.png")


def draw_smooth_contours(scene):
    """Contours as they are, and smooth and simple ones."""
    figure, axes = plt.subplots(1, 2, figsize=(8.4, 3.4))
    smooth = ("--smooth", 2, "--simplify", 0.2, "--min-length", 20)
    for axis, title, options in zip(axes, ("as they are", " ".join(map(str, smooth))), ((), smooth)):
        for line in scene.features("--interval", 1, *options):
            x, y, *_ = np.array(line["geometry"]["coordinates"]).T
            axis.plot(x, y, color="#8a4b1f", linewidth=1.2 if line["properties"]["index"] == 1 else 0.6)
        limits = {"xlim": (scene.x + 90, scene.x + 250), "ylim": (scene.y + 120, scene.y + 240)}
        axis.set(title=title, xticks=[], yticks=[], aspect="equal", **limits)
    scene.save(figure, "smooth-contours.png")


def draw_bands(scene):
    """Polygons between heights, filled by their lower one."""
    bands = scene.features("--interval", 2, "--bands", "--smooth", 2)
    heights = [band["properties"]["min"] for band in bands]
    colours = plt.get_cmap("YlGnBu_r")
    figure, axis = plt.subplots(figsize=(6.4, 4.6))
    for band, height in zip(bands, heights):
        polygons = band["geometry"]["coordinates"]
        for rings in polygons if band["geometry"]["type"] == "MultiPolygon" else [polygons]:
            rings = [matplotlib.path.Path(np.array(ring)[:, :2], closed=True) for ring in rings]
            share = (height - min(heights)) / (max(heights) - min(heights))
            path = matplotlib.path.Path.make_compound_path(*rings)
            axis.add_patch(matplotlib.patches.PathPatch(path, facecolor=colours(share), edgecolor=INK, linewidth=0.3))
    limits = {"xlim": (scene.x + 50, scene.x + 370), "ylim": (scene.y + 80, scene.y + 310)}
    axis.set(xticks=[], yticks=[], aspect="equal", **limits)
    norm = plt.Normalize(min(heights), max(heights))
    figure.colorbar(matplotlib.cm.ScalarMappable(norm, colours), ax=axis, shrink=0.8, label="min")
    scene.save(figure, "bands.png")


def write_survey(scene):
    """The country with classes, returns, intensities and colours, as a survey would have them."""
    points = spillway.read_points(str(scene.work / "hills.las"))
    low = spillway.read_points(str(scene.work / "hills.las"), thin=(25, "lowest"))
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=".* lie over no triangle of the ground")
        heights = np.nan_to_num(spillway.height(points, ground=low))
    rng = np.random.default_rng(3)
    # Roofs are smooth, trees are not.
    cells = np.floor(points[:, :2] / 2).astype(int)
    _, cell = np.unique(cells, axis=0, return_inverse=True)
    cell = cell.ravel()
    count = np.bincount(cell)
    mean = np.bincount(cell, heights) / count
    rough = np.sqrt(np.maximum(np.bincount(cell, heights**2) / count - mean**2, 0))[cell] > 1
    ground, low_green, green, high_green, roof = 2, 3, 4, 5, 6
    kinds = [heights < 1.8, (heights > 3.5) & ~rough, heights < 2.6, heights < 5]
    classes = np.select(kinds, [ground, roof, low_green, green], high_green)
    tints = {ground: (150, 140, 95), low_green: (120, 140, 70), green: (80, 120, 55), high_green: (50, 95, 45),
             roof: (165, 85, 70)}
    colours = np.array([tints[one] for one in classes]) + rng.normal(0, 5, (len(points), 1))
    colours += 12 * np.sin(points[:, :1] / 25) * np.cos(points[:, 1:2] / 31)
    fields = {"classification": "u1", "return_number": "u1", "intensity": "u2", "red": "u2", "green": "u2",
              "blue": "u2"}
    survey = np.zeros(len(points), dtype=[(axis, "f8") for axis in "xyz"] + list(fields.items()))
    survey["x"], survey["y"], survey["z"] = points.T
    survey["classification"] = classes
    survey["return_number"] = np.where(rough & (heights > 1), rng.integers(1, 4, len(points)), 1)
    survey["intensity"] = np.clip(colours.sum(axis=1) * 8 + rng.normal(0, 200, len(points)), 0, 65535)
    for name, values in zip(("red", "green", "blue"), colours.T):
        survey[name] = np.clip(values, 0, 255) * 257
    spillway.convert(survey, str(scene.work / "survey.las"), crs="EPSG:32632")


def draw_colours(scene):
    """What colours can stand for, with words below."""
    write_survey(scene)
    box = scene.box(190, 120, 370, 240)
    figure, axes = plt.subplots(2, 2, figsize=(8.4, 6.2))
    for axis, colour in zip(axes.flat, ("class", "intensity", "return", "rgb")):
        words = ("--scale-bar",) if colour == "rgb" else ("--scale-bar", "--legend")
        how = ("--zoom", box, "--color", colour, "--size", 430)
        scene.spillway("render", "survey.las", "-o", "colours.png", *how, *words)
        axis.imshow(plt.imread(scene.work / "colours.png"))
        axis.set(title=f"--color {colour}")
        axis.axis("off")
    figure.tight_layout()
    scene.save(figure, "colours.png")


def draw_aslant(scene):
    """The country aslant, with light from the side."""
    view = ("--view", "200,35", "--light", "300,28", "--shadows", "--max-edge", 40)
    scene.render("survey.las", "aslant.png", *view, "--size", 820)


def draw_page(scene):
    """What a browser shows of a page."""
    browser = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
    if browser is None:
        print("page.png is left as it is: there is no Chromium")
        return
    scene.spillway("render", "hills.las", "-o", "hills.html", "--max-edge", 40)
    options = ["--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
    options += ["--hide-scrollbars", "--force-device-scale-factor=1", "--window-size=820,560"]
    options += [f"--user-data-dir={scene.work / 'profile'}", f"--screenshot={scene.folder / 'page.png'}"]
    address = (scene.work / "hills.html").as_uri() + "#distance=3&elevation=35"
    subprocess.run([browser, *options, address], check=True, timeout=120, capture_output=True)


def draw_section(scene):
    """Houses in space, cut at the height of a table."""
    scene.spillway("generate", "scan", "-n", "1e5", "-o", "houses.las")
    low = spillway.info(str(scene.work / "houses.las")).extent[0]
    scene.render("houses.las", "section.png", "--dim", 3, "--slice", f"z={low[2] + 1.2:.2f}", "--size", 640)


def draw_haloes(scene):
    """The density of clustered points in a box that repeats."""
    scene.spillway("generate", "haloes", "-n", 50_000, "--dim", 2, "--seed", 4, "-o", "haloes.npy")
    box = ("--periodic", "0,0,1,1", "--grid", "480,480")
    scene.spillway("density", "haloes.npy", *box, "-o", "density.npy")
    density = np.log10(np.load(scene.work / "density.npy")).T
    low, high = np.percentile(density, (1, 99.7))
    plt.imsave(scene.folder / "haloes.png", density, origin="lower", cmap="inferno", vmin=low, vmax=high)


def draw_border(scene):
    """Four tiles, each triangulated by itself: what is final, and what stays in memory as border."""
    points = np.random.default_rng(5).random((500, 2))
    figure, axis = plt.subplots(figsize=(4.6, 4.6))
    for column in (0, 1):
        for row in (0, 1):
            inside = (points[:, 0] >= 0.5) == column, (points[:, 1] >= 0.5) == row
            tile = spillway.Delaunay(points[inside[0] & inside[1]])
            centres = tile.circumcenters
            radii = np.linalg.norm(tile.points[tile.simplices[:, 0]] - centres, axis=1)
            # The other tiles are beyond the two lines in the middle.
            near_x = radii > np.abs(centres[:, 0] - 0.5)
            near_y = radii > np.abs(centres[:, 1] - 0.5)
            beyond = ((centres[:, 0] >= 0.5) != column) | ((centres[:, 1] >= 0.5) != row)
            border = near_x | near_y | beyond
            x, y = tile.points.T
            for chosen, colour in ((tile.simplices[~border], FINAL), (tile.simplices[border], BORDER)):
                axis.tripcolor(x, y, chosen, np.zeros(len(x)), cmap=matplotlib.colors.ListedColormap([colour]))
                axis.triplot(x, y, chosen, color="white", linewidth=0.5)
    axis.axhline(0.5, color=INK, linewidth=1)
    axis.axvline(0.5, color=INK, linewidth=1)
    axis.set(aspect="equal", xlim=(0, 1), ylim=(0, 1))
    axis.axis("off")
    scene.save(figure, "border.png")


def draw_resident_border(scene, most):
    """How many triangles of terrain are in memory at a time as border, beside all."""
    counts = [n for n in (100_000, 1_000_000, 10_000_000, 100_000_000) if n <= most]
    resident, all_of_them = [], []
    for count in counts:
        scene.spillway("generate", "terrain", "-n", count, "-o", "many.las")
        scene.spillway("triangulate", "many.las", "-o", "many.spm", "--memory", "256M", "--stats", "many.json")
        figures = json.loads((scene.work / "many.json").read_text(encoding="utf-8"))
        resident.append(figures["border_simplices"])
        all_of_them.append(figures["simplices"])
        for name in ("many.las", "many.spm", "many.json"):
            (scene.work / name).unlink()
    figure, axis = plt.subplots(figsize=(5.4, 3.2))
    axis.loglog(counts, all_of_them, "o-", color=FINAL, label="triangles of the mesh")
    axis.loglog(counts, resident, "o-", color=BORDER, label="of these in memory as border, at most")
    for count, border, whole in zip(counts, resident, all_of_them):
        axis.annotate(f"{100 * border / whole:.2g} %", (count, border), (0, 6), textcoords="offset points", ha="center")
    axis.set(xlabel="points of terrain", ylabel="triangles")
    axis.margins(x=0.1)
    axis.grid(alpha=0.3)
    axis.legend(frameon=False)
    scene.save(figure, "resident-border.svg")


if __name__ == "__main__":
    main()
