"""Rasters, lines and pictures are those of the command."""

import os
import unittest

import numpy as np
import spillway
from support import InFolder, bytes_of, command, random_points


class Dem(InFolder):
    def setUp(self):
        super().setUp()
        command("generate", "terrain", "-n", 20_000, "-o", "hills.las")

    def test_a_file_has_the_bytes_of_the_command(self):
        box, corners = "500100,4100100,500300,4100300", (500100, 4100100, 500300, 4100300)
        cases = {
            "--resolution 3": {"resolution": 3},
            "--resolution 3 --align --compress none --nodata -1": {
                "resolution": 3, "align": True, "compress": "none", "nodata": -1,
            },
            "--resolution 3 --product height,slope,hillshade --azimuth 90 --altitude 30 --z-factor 2": {
                "resolution": 3, "product": ["height", "slope", "hillshade"],
                "azimuth": 90, "altitude": 30, "z_factor": 2,
            },
            "--resolution 3 --product slope,tri --gradient zevenbergen-thorne --compute-edges": {
                "resolution": 3, "product": ["slope", "tri"],
                "gradient": "zevenbergen-thorne", "compute_edges": True,
            },
            "--resolution 3 --product hillshade --type byte": {
                "resolution": 3, "product": "hillshade", "type": "byte",
            },
            "--resolution 3 --product max,p50,count,p99.5": {
                "resolution": 3, "product": ["max", "p50", "count", "p99.5"],
            },
            "--resolution 1 --product mean,height --fill-voids --max-edge 9": {
                "resolution": 1, "product": ["mean", "height"], "fill_voids": True, "max_edge": 9,
            },
            f"--resolution 5 --bounds {box}": {"resolution": 5, "bounds": corners},
            f"--resolution 5 --clip-bounds {box}": {"resolution": 5, "clip_bounds": corners},
            "--resolution 3 --cog --max-edge 20": {"resolution": 3, "cog": True, "max_edge": 20},
            "--like like.tif": {"like": "like.tif"},
            "--resolution 3 --force-size --crs EPSG:32633": {
                "resolution": 3, "force_size": True, "crs": "EPSG:32633",
            },
        }
        command("dem", "hills.las", "-o", "like.tif", "--resolution", 7)
        for words, options in cases.items():
            with self.subTest(options=words):
                command("dem", "hills.las", "-o", "a.tif", *words.split())
                report = spillway.dem("hills.las", "b.tif", **options)
                self.assertEqual(bytes_of("b.tif"), bytes_of("a.tif"))
                self.assertGreater(report.pixels_with_data, 0)

    def test_tiles_are_those_of_the_command(self):
        for folder in ("a", "b"):
            os.makedirs(folder)
        command("dem", "hills.las", "-o", "a/t_{x}_{y}.tif", "--resolution", 1, "--tiles", 100)
        report = spillway.dem("hills.las", "b/t_{x}_{y}.tif", resolution=1, tiles=100)
        self.assertEqual(sorted(os.listdir("a")), sorted(os.listdir("b")))
        for name in os.listdir("a"):
            self.assertEqual(bytes_of(f"a/{name}"), bytes_of(f"b/{name}"))
        self.assertEqual(report.files, len(os.listdir("b")) - 1)
        self.assertEqual(report.vrt, "b/t.vrt")
        for message, options in (
            ("vrt has no effect without tiles", {"vrt": "a.vrt"}),
            ("align has no effect with tiles", {"tiles": 100, "align": True}),
            ("need {x} and {y}", {"tiles": 100}),
        ):
            with self.assertRaisesRegex(spillway.errors.InvalidArgumentError, message):
                spillway.dem("hills.las", "c.tif", resolution=1, **options)
        with self.assertRaisesRegex(spillway.errors.InvalidArgumentError, "without an output"):
            spillway.dem("hills.las", resolution=1, tiles=100)

    def test_tiles_of_meshes_and_contours_are_those_of_the_command(self):
        for folder in ("a", "b", "c"):
            os.makedirs(folder)
        command("triangulate", "hills.las", "-o", "a/t_{x}_{y}.ply", "--tiles", 100)
        report = spillway.triangulate("hills.las", "b/t_{x}_{y}.ply", tiles=100)
        self.assertEqual(report.output_files, len(os.listdir("b")))
        spillway.triangulate("hills.las", "hills.spm")
        spillway.convert("hills.spm", "c/t_{x}_{y}.ply", tiles=100)
        self.assertEqual(os.listdir("c"), os.listdir("b"))
        command("contour", "hills.las", "-o", "a/{x}_{y}.shp", "--interval", 5, "--bands", "--tiles", 200)
        report = spillway.contour("hills.las", "b/{x}_{y}.shp", interval=5, bands=True, tiles=200)
        self.assertGreater(report.files, 1)
        self.assertEqual(report.outside_tiles, 0)
        self.assertEqual(sorted(os.listdir("a")), sorted(os.listdir("b")))
        for name in os.listdir("a"):
            if not name.endswith(".dbf"):  # which has a date
                self.assertEqual(bytes_of(f"a/{name}"), bytes_of(f"b/{name}"), name)
        with open("sheet.csv", "w", encoding="utf8") as sheet:
            sheet.write('n,WKT\n7,"POLYGON ((0 0,1 0,1 1,0 1,0 0))"\n')
        with self.assertWarnsRegex(spillway.errors.Warning, "none of the tiles"):
            report = spillway.triangulate(
                "hills.las", "s_{n}.ply", tiles="sheet.csv", force_crs=True
            )
        self.assertEqual(report.outside_tiles, report.simplices)
        with self.assertRaisesRegex(spillway.errors.InvalidArgumentError, "a side above 0"):
            spillway.triangulate("hills.las", "{x}_{y}.ply", tiles=0)
        with self.assertRaisesRegex(spillway.errors.InvalidArgumentError, "a mesh is cut"):
            spillway.convert("hills.las", "{x}_{y}.las", tiles=100)

    def test_an_array_has_the_pixels_of_the_file(self):
        gdal = self.gdal()
        command("triangulate", "hills.las", "-o", "mesh.spm")
        for product in ("height", ["height", "slope", "density"]):
            names = product if isinstance(product, str) else ",".join(product)
            words = ["--resolution", 0.7, "--product", names, "--nodata", "nan"]
            command("dem", "hills.las", "-o", "a.tif", *words)
            file = gdal.Open("a.tif")
            for inputs in ("hills.las", "mesh.spm"):
                raster = spillway.dem(inputs, resolution=0.7, product=product)
                np.testing.assert_array_equal(raster.values, file.ReadAsArray())
                self.assertEqual(raster.values.dtype, np.float32)
                self.assertEqual(raster.geotransform, file.GetGeoTransform())
        self.assertGreater(min(raster.values.shape[1:]), 256)

    def test_an_array_needs_neither_a_file_nor_room_for_one(self):
        x, y = np.meshgrid(np.arange(40.0), np.arange(30.0))
        points = np.column_stack([x.ravel(), y.ravel(), (2 * x + 3 * y).ravel()])
        raster = spillway.dem(points, resolution=1, scratch_folder="tmp")
        self.assertEqual(raster.values.shape, (29, 39))
        self.assertEqual(raster.geotransform, (0, 1, 0, 29, 0, -1))
        columns, rows = np.meshgrid(np.arange(39) + 0.5, 29 - (np.arange(29) + 0.5))
        np.testing.assert_allclose(raster.values, 2 * columns + 3 * rows, rtol=1e-6)
        self.assertIsNone(raster.crs)
        self.assert_nothing_is_left("hills.las")

    def test_products_of_points_are_those_of_numpy(self):
        places = np.random.default_rng(3).uniform(0, 20, (3000, 3))
        points = np.concatenate([places, places[:1000] + [0, 0, 5]])  # some above others
        products = ["min", "max", "mean", "stddev", "p25", "count"]
        raster = spillway.dem(points, resolution=4, product=products, bounds=(0, 0, 20, 20))
        self.assertEqual(raster.report.bands, products)
        self.assertEqual(raster.report.points_in_pixels, 4000)
        self.assertEqual(raster.report.pixels_with_points, 25)
        for row, column in np.ndindex(5, 5):
            inside = (points[:, 0] // 4 == column) & ((20 - points[:, 1]) // 4 == row)
            z = points[inside, 2]
            expected = [z.min(), z.max(), z.mean(), z.std(), np.percentile(z, 25), z.size]
            np.testing.assert_allclose(raster.values[:, row, column], expected, rtol=1e-6)

    def test_pixels_without_data_are_not_a_number(self):
        points = np.array([[0, 0, 1], [10, 0, 1], [0, 10, 1.0]])
        raster = spillway.dem(points, resolution=1)
        self.assertTrue(np.isnan(raster.values[0, 9]))
        self.assertEqual(raster.values[9, 0], 1)
        self.assertEqual(np.isfinite(raster.values).sum(), raster.report.pixels_with_data)

    def test_the_coordinate_system_comes_with_an_array(self):
        self.assertEqual(spillway.dem("hills.las", resolution=9, crs="EPSG:32633").crs, "EPSG:32633")

    def test_options_without_effect_are_refused(self):
        for words, options in [
            ("resolution, the side of a pixel, is missing", {}),
            ("azimuth has no effect", {"resolution": 1, "azimuth": 3}),
            ("z_factor has no effect", {"resolution": 1, "z_factor": 3}),
            ("gradient has no effect", {"resolution": 1, "gradient": "horn"}),
            ("compute_edges has no effect", {"resolution": 1, "compute_edges": True}),
            ("fill_voids has no effect", {"resolution": 1, "product": "count", "fill_voids": True}),
            ("heights has no effect", {"resolution": 1, "product": "max", "heights": "mean"}),
            ("max_edge has no effect", {"resolution": 1, "product": "density", "max_edge": 3}),
            (
                "force_size has no effect with bounds",
                {"resolution": 1, "bounds": (0, 0, 1, 1), "force_size": True},
            ),
            ("resolution has no effect with like", {"resolution": 1, "like": "a.tif"}),
            ("nodata, cog have no effect without an output", {"resolution": 1, "nodata": 0, "cog": True}),
            ('product is "depth"; give one of height', {"resolution": 1, "product": "depth"}),
            ("a side above 0", {"resolution": -1}),
        ]:
            with self.subTest(options=options), self.assertRaisesRegex(ValueError, words):
                spillway.dem("hills.las", **options)
        with self.assertRaisesRegex(ValueError, "no z"):
            spillway.dem(random_points(10, 2), resolution=1)

    def gdal(self):
        try:
            from osgeo import gdal
        except ImportError:
            self.skipTest("there is no GDAL for Python to read the file")
        gdal.UseExceptions()
        return gdal


class Lines(InFolder):
    def test_contours_are_those_of_the_command(self):
        command("generate", "terrain", "-n", 5000, "-o", "hills.las")
        os.mkdir("a")  # the file has its own name in it
        cases = {
            "--interval 10": {"interval": 10},
            "--interval 10 --base 3": {"interval": 10, "base": 3},
            "--interval 10 --index 2": {"interval": 10, "index": 2},
            "--interval 10 --smooth 3 --simplify 0.5": {
                "interval": 10,
                "smooth": 3,
                "simplify": 0.5,
            },
            "--interval 10 --bands": {"interval": 10, "bands": True},
            "--interval 10 --min-length 90.5": {"interval": 10, "min_length": 90.5},
            "--levels 380,390.5": {"levels": [380, 390.5]},
        }
        for words, options in cases.items():
            common = ["-o", "a/lines.geojson", "--force-crs", "--memory", "64M"]
            command("contour", "hills.las", *common, *words.split())
            with self.assertWarns(spillway.Warning):
                report = spillway.contour(
                    "hills.las", "lines.geojson", force_crs=True, memory="64M", **options
                )
            self.assertEqual(bytes_of("lines.geojson"), bytes_of("a/lines.geojson"))
            self.assertGreater(report.lines, 0)

    def test_heights_are_asked_for_in_one_way(self):
        points = np.column_stack([random_points(50, 2), np.arange(50)])
        with self.assertRaisesRegex(ValueError, "interval, the height between two lines"):
            spillway.contour(points, "a.gpkg")
        with self.assertRaisesRegex(ValueError, "interval has no effect with levels"):
            spillway.contour(points, "a.gpkg", interval=1, levels=[2])
        with self.assertRaisesRegex(ValueError, "index has no effect with levels"):
            spillway.contour(points, "a.gpkg", levels=[2], index=5)
        with self.assertRaisesRegex(ValueError, "min_length has no effect with bands"):
            spillway.contour(points, "a.gpkg", interval=2, bands=True, min_length=5)
        with self.assertRaisesRegex(ValueError, "index is 0"):
            spillway.contour(points, "a.gpkg", interval=2, index=0)
        with self.assertWarnsRegex(spillway.Warning, "lines left out: shorter than min_length"):
            spillway.contour(points, "a.gpkg", interval=2, min_length=1e6)
        with self.assertWarnsRegex(spillway.Warning, "no lines"):
            self.assertEqual(spillway.contour(points, "a.gpkg", levels=[99]).lines, 0)


class Pictures(InFolder):
    def test_pictures_are_those_of_the_command(self):
        command("generate", "terrain", "-n", 5000, "-o", "hills.las")
        np.save("cloud.npy", random_points(3000, 3))
        cases = [
            ("hills.las", "", {}),
            (
                "hills.las",
                "--wireframe --transparent --exaggerate 3",
                {"wireframe": True, "transparent": True, "exaggerate": 3},
            ),
            (
                "hills.las",
                "--zoom 500100,4100100,500200,4100200",
                {"zoom": (500100, 4100100, 500200, 4100200)},
            ),
            ("hills.las", "--ramp magma --legend", {"ramp": "magma", "legend": True}),
            (
                "hills.las",
                "--color return --scale-bar --world-file",
                {"color": "return", "scale_bar": True, "world_file": True},
            ),
            (
                "hills.las",
                "--view 200,35 --light 90,20 --shadows",
                {"view": (200, 35), "light": (90, 20), "shadows": True},
            ),
            ("cloud.npy", "--dim 3 --view 120,30", {"dim": 3, "view": (120, 30)}),
            ("cloud.npy", "--dim 3 --slice z=0.5", {"dim": 3, "slice": ("z", 0.5)}),
        ]
        for inputs, words, options in cases:
            with self.subTest(options=words):
                command("render", inputs, "-o", "a.png", "--size", 150, *words.split())
                report = spillway.render(inputs, "b.png", size=150, **options)
                self.assertEqual(bytes_of("b.png"), bytes_of("a.png"))
                self.assertEqual(max(report.columns, report.rows), 150)
                if "world_file" in options:
                    self.assertEqual(bytes_of("b.pgw"), bytes_of("a.pgw"))

    def test_pages_are_those_of_the_command(self):
        command("generate", "terrain", "-n", 5000, "-o", "hills.las")
        os.mkdir("a")
        options = ("--triangles", 2000, "--view", "90,50", "--exaggerate", 2)
        command("render", "hills.las", "-o", "a/page.html", *options)
        report = spillway.render("hills.las", "page.html", triangles=2000, view=(90, 50), exaggerate=2)
        self.assertEqual(bytes_of("page.html"), bytes_of("a/page.html"))
        self.assertGreater(report.triangles, 1000)
        self.assertIn("triangles on", str(report))

    def test_wrong_values(self):
        points = random_points(100, 3)
        for kind, options in [
            (ValueError, {"slice": ("w", 1)}),
            (TypeError, {"slice": 3}),
            (TypeError, {"size": "large"}),
            (TypeError, {"zoom": (1, 2)}),
        ]:
            with self.subTest(options=options), self.assertRaises(kind):
                spillway.render(points, "a.png", dim=3, **options)


if __name__ == "__main__":
    unittest.main()
