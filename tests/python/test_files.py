"""Calls from files and arrays to files do what the command does."""

import dataclasses
import errno
import functools
import inspect
import json
import lzma
import os
import pathlib
import pickle
import re
import signal
import subprocess
import sys
import threading
import unittest
import warnings

import numpy as np
import spillway
from support import (
    COMMAND,
    InFolder,
    bytes_of,
    command,
    degenerate_sets,
    hash_by_command,
    random_points,
)

# Its points are one compressed block, after four numbers of 64 bits: how many blocks there are, the
# bytes of each, those of the last one (0: as the others), and the compressed ones.
HOLLOW_VTU = """<VTKFile type="UnstructuredGrid" byte_order="LittleEndian" header_type="UInt64"
 compressor="vtkLZMADataCompressor"><UnstructuredGrid><Piece NumberOfPoints="{}" NumberOfCells="1">
<Points><DataArray type="Float64" Name="Points" NumberOfComponents="3" format="appended" offset="0"/>
</Points><Cells>
<DataArray type="Int64" Name="connectivity" format="ascii">0 1 2</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">3</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">5</DataArray>
</Cells></Piece></UnstructuredGrid><AppendedData encoding="raw">_"""


def write_hollow_vtu(path, count):
    """A triangle whose vertices, and all others, are the origin."""
    block = lzma.compress(bytes(24 * count))
    with open(path, "wb") as file:
        file.write(HOLLOW_VTU.format(count).encode())
        file.write(np.array([1, 24 * count, 0, len(block)], "<u8").tobytes() + block)
        file.write(b"</AppendedData></VTKFile>")


class Triangulate(InFolder):
    def test_a_file_becomes_the_bytes_of_the_command(self):
        command("generate", "terrain", "-n", 30_000, "-o", "hills.las")
        for output in ("mesh.spm", "mesh.ply", "mesh.obj"):
            command("triangulate", "hills.las", "-o", "command." + output, "--memory", "64M")
            report = spillway.triangulate("hills.las", output, memory="64M")
            self.assertEqual(bytes_of(output), bytes_of("command." + output))
            self.assertEqual(report.output_bytes, os.path.getsize(output))

    def test_the_report_has_the_figures_of_the_command(self):
        command("generate", "terrain", "-n", 30_000, "-o", "hills.las")
        command("triangulate", "hills.las", "-o", "a.spm", "--memory", "64M", "--stats", "run.json")
        stats = json.loads(pathlib.Path("run.json").read_text())
        report = spillway.triangulate("hills.las", "b.spm", memory=64 << 20)
        figures = dataclasses.asdict(report)
        self.assertEqual(
            set(stats) - set(figures),
            {"version", "inputs", "output", "withheld", "peak_rss_bytes", "task_sums"},
        )
        timed = ("seconds", "phases", "stages", "border_simplices", "border_bytes")
        for key in set(figures) - set(timed):
            with self.subTest(key=key):
                self.assertEqual(figures[key], stats[key])
        self.assertEqual(set(report.phases), set(stats["phases"]))

    def test_every_option_reaches_the_run(self):
        rng = np.random.default_rng(3)
        np.savetxt("points.txt", np.column_stack([rng.random((4000, 2)), rng.random(4000)]))
        cases = {
            "--id": {"id": True},
            "--dim 3": {"dim": 3},
            "--max-edge 0.02": {"max_edge": 0.02},
            "--every 3": {"every": 3},
            "--thin 0.05:lowest": {"thin": (0.05, "lowest")},
            "--thin 0.05": {"thin": 0.05},
            "--bounds 0,0,0.5,0.7": {"bounds": (0, 0, 0.5, 0.7)},
            "--bounds 0,0,0.2,0.5,0.7,1": {"bounds": [0, 0, 0.2, 0.5, 0.7, 1]},
            "--columns 2,3,1": {"columns": (2, 3, 1)},
            "--input-format text": {"input_format": "text"},
            "--leaf-points 100": {"leaf_points": 100},
            "--tile-points 1000 --children 4": {"tile_points": 1000, "children": 4},
            "--division cycling --leaf-points 200": {"division": "cycling", "leaf_points": 200},
            "--kernel cgal": {"kernel": "cgal"},
            "--no-trust-headers": {"trust_headers": False},
            "--skip-invalid": {"skip_invalid": True},
            "--max-expansion 50": {"max_expansion": 50},
            "--skip-broken": {"skip_broken": True},
            "--salvage": {"salvage": True},
            "--output-format ply": {"output_format": "ply"},
            "--max-tmp 1G --threads 2": {"max_tmp": "1G", "threads": 2},
        }
        for words, options in cases.items():
            with self.subTest(options=words):
                command("triangulate", "points.txt", "-o", "a.spm", "--memory", "96M", *words.split())
                spillway.triangulate("points.txt", "b.spm", memory="96M", **options)
                self.assertEqual(bytes_of("b.spm"), bytes_of("a.spm"))

    def test_filters_by_class_and_return_are_those_of_the_command(self):
        command("generate", "terrain", "-n", 3000, "-o", "hills.las")
        cases = {
            "--keep-class 0-2": {"keep_class": range(3)},
            "--drop-class 7,18": {"drop_class": [7, 18]},
            "--returns first,2": {"returns": ["first", 2]},
            "--returns last": {"returns": "last"},
            "--keep-withheld": {"keep_withheld": True},
            "--crs EPSG:2056": {"crs": "EPSG:2056"},
            "--crs EPSG:2056 --force-crs": {"crs": "EPSG:2056", "force_crs": True},
        }
        for words, options in cases.items():
            with self.subTest(options=words):
                command("triangulate", "hills.las", "-o", "a.spm", *words.split())
                spillway.triangulate("hills.las", "b.spm", **options)
                self.assertEqual(bytes_of("b.spm"), bytes_of("a.spm"))
        with self.assertRaisesRegex(spillway.Error, "other classes"):
            spillway.triangulate("hills.las", "b.spm", keep_class=250)

    def test_files_that_are_cut_off_are_salvaged_and_broken_ones_are_named(self):
        command("generate", "terrain", "-n", 3000, "-o", "hills.las")
        pathlib.Path("cut.las").write_bytes(bytes_of("hills.las")[:-1000])
        with self.assertRaisesRegex(spillway.Error, "complete copy"):
            spillway.triangulate("cut.las", "b.spm")
        with self.assertWarnsRegex(Warning, "lost"):
            report = spillway.triangulate("cut.las", "b.spm", salvage=True)
        self.assertEqual(report.filters["read"] + report.filters["lost"], 3000)
        report = spillway.convert(["hills.las", "cut.las"], "b.spp", skip_broken=True)
        self.assertEqual([skipped["path"] for skipped in report.skipped_files], ["cut.las"])
        self.assertEqual(report.written, 3000)

    def test_duplicates_choose_heights(self):
        points = np.array([[0, 0, 1], [4, 0, 1], [0, 4, 1], [0, 0, 5], [0, 0, 3.0]])
        for choice, z in {"first": 1, "lowest": 1, "highest": 5, "mean": 3}.items():
            spillway.triangulate(points, "mesh_.npy", heights=choice)
            vertices = np.load("mesh__vertices.npy")
            self.assertEqual(vertices[(vertices[:, :2] == 0).all(axis=1)][0, 2], z)

    def test_arrays_of_any_layout_become_the_mesh_of_the_command(self):
        for dim in (2, 3):
            points = random_points(3000, dim)
            expected = hash_by_command(points)
            wide = np.zeros((3000, 7))
            wide[:, 1 : 1 + dim] = points
            for rows in (
                points,
                np.asfortranarray(points),
                wide[:, 1 : 1 + dim],
                points[::-1],
                points.tolist(),
            ):
                report = spillway.triangulate(rows, "mesh.spm", dim=dim)
                self.assertEqual(report.canonical_hash, expected)
                self.assertEqual(report.dimension, dim)
        heights = np.column_stack([random_points(3000, 2), np.arange(3000)])
        self.assertEqual(
            spillway.triangulate(heights, "mesh.spm").canonical_hash,
            spillway.Delaunay(heights, dim=2).hash,
        )

    def test_ties_are_broken_as_in_memory(self):
        for dim in (2, 3):
            for name, points in degenerate_sets(dim):
                with self.subTest(dim=dim, points=name):
                    report = spillway.triangulate(points, "mesh.spm", dim=dim)
                    self.assertEqual(report.canonical_hash, spillway.Delaunay(points).hash)

    def test_several_files_patterns_and_paths_of_all_types(self):
        command("generate", "terrain", "-n", 4000, "--grid", "2x2", "-o", "hills_#.las")
        files = sorted(pathlib.Path(".").glob("hills_*.las"))
        reports = [
            spillway.triangulate(inputs, pathlib.Path("mesh.spm"))
            for inputs in (files, "hills_*.las", b"hills_*.las", [str(file) for file in files])
        ]
        self.assertEqual(len({report.canonical_hash for report in reports}), 1)
        self.assertEqual(reports[0].points, 4000)

    def test_names_that_are_not_utf_8(self):
        name = b"hills-\xff.npy"
        with open(name, "wb") as file:
            np.save(file, random_points(100, 2))
        spillway.triangulate(name, b"mesh-\xfe.spm")
        self.assertIn(b"mesh-\xfe.spm", os.listdir(b"."))
        spillway.triangulate(os.fsdecode(name), "mesh.spm")

    def test_a_coordinate_system_of_an_array_is_written(self):
        points = np.column_stack([random_points(50, 2), np.zeros(50)]) * 100
        spillway.triangulate(points, "mesh.spm", crs="EPSG:2056")
        self.assertEqual(spillway.info("mesh.spm").crs, "EPSG:2056")
        pathlib.Path("system.wkt").write_text("EPSG:2056\n")
        spillway.triangulate(points, "other.spm", crs=pathlib.Path("system.wkt"))
        self.assertEqual(bytes_of("other.spm"), bytes_of("mesh.spm"))


class Convert(InFolder):
    def test_points_become_the_bytes_of_the_command(self):
        command("generate", "terrain", "-n", 5000, "-o", "hills.las")
        command("generate", "uniform", "-n", 5000, "-o", "square.npy")
        cases = [
            ("hills.las", "a.txt", "", {}),
            (
                "hills.las",
                "a.spp",
                "--sorted --cell-points 700 --memory 32M",
                {"sorted": True, "cell_points": 700, "memory": "32M"},
            ),
            ("hills.las", "a.las", "--las-version 1.4", {"las_version": "1.4"}),
            ("hills.las", "a.bin", "--output-format npy --every 2", {"output_format": "npy", "every": 2}),
            (
                "square.npy",
                "a.las",
                "--scale 0.01 --offset 1,2,3",
                {"scale": 0.01, "offset": (1, 2, 3)},
            ),
        ]
        for source, output, words, options in cases:
            with self.subTest(options=words):
                command("convert", source, "-o", output, *words.split())
                report = spillway.convert(source, "b" + output[1:], **options)
                self.assertEqual(bytes_of("b" + output[1:]), bytes_of(output))
                self.assertGreater(report.written, 0)
        self.assertTrue(report.rounded)
        self.assertEqual(report.scale, (0.01, 0.01, 0.01))

    def test_a_mesh_becomes_the_bytes_of_the_command(self):
        spillway.triangulate(random_points(2000, 2), "mesh.spm")
        command("convert", "mesh.spm", "-o", "a.ply")
        report = spillway.convert("mesh.spm", "b.ply")
        self.assertEqual(bytes_of("b.ply"), bytes_of("a.ply"))
        self.assertEqual(report.canonical_hash, spillway.info("mesh.spm").canonical_hash)

    def test_scales_and_offsets_may_be_arrays(self):
        points = random_points(100, 3)
        axes = np.array([0.5, 0.25, 0.125])
        for scale in (axes, iter(axes), tuple(axes)):
            report = spillway.convert(points, "points.las", scale=scale, offset=np.zeros(3))
            self.assertEqual(report.scale, tuple(axes))

    def test_arrays_are_written_as_they_are(self):
        for dim in (2, 3):
            points = random_points(100, dim)
            report = spillway.convert(points, "points.npy")
            np.testing.assert_array_equal(np.load("points.npy"), points)
            self.assertEqual(report.written, 100)

    def test_options_without_effect_are_refused(self):
        spillway.triangulate(random_points(50, 2), "mesh.spm")
        for inputs, options in [
            ("mesh.spm", {"scale": 0.1}),
            ("mesh.spm", {"keep_class": 2}),
            ("mesh.spm", {"every": 2}),
            (random_points(9, 2), {"every": 2}),
            (random_points(9, 2), {"cell_points": 100}),
            (random_points(9, 2), {"mesh_format": "ply"}),
        ]:
            with self.subTest(options=options), self.assertRaisesRegex(ValueError, "no effect"):
                spillway.convert(inputs, "out.spp", **options)

    def test_blocks_of_vtu_that_expand_far_are_read_if_that_is_meant(self):
        count = 2_900_000  # more than 64 MiB of zeros, and one triangle
        write_hollow_vtu("hollow.vtu", count)
        with self.assertRaisesRegex(spillway.Error, "that is meant, raise max_expansion"):
            spillway.info("hollow.vtu")
        with self.assertRaisesRegex(spillway.Error, "more than 1000 times as many"):
            spillway.check("hollow.vtu", max_expansion=1000)
        with self.assertRaisesRegex(spillway.Error, "more than 1000 times as many"):
            spillway.check("hollow.vtu", points=random_points(9, 2), max_expansion=1000)
        with self.assertRaisesRegex(spillway.Error, "more than 1000 times as many"):
            spillway.height(random_points(9, 2), ground="hollow.vtu", max_expansion=1000)
        np.save("points.npy", random_points(9, 3))
        for words in (
            ["convert", "hollow.vtu", "-o", "a.ply"],
            ["volume", "hollow.vtu", "--level", "0"],
            ["height", "points.npy", "--ground", "hollow.vtu", "-o", "a.csv"],
        ):
            with self.subTest(words[0]):
                told = subprocess.run(
                    [COMMAND, *words, "--max-expansion", "1000"], capture_output=True, text=True
                ).stderr
                self.assertIn("more than 1000 times as many; the file may be corrupt; if ", told)
        self.assertEqual(spillway.info("hollow.vtu", max_expansion=20000).vertices, count)


class Generate(InFolder):
    def test_files_and_arrays_are_those_of_the_command(self):
        command("generate", "uniform", "-n", 1000, "--dim", 3, "--seed", 7, "-o", "a.npy")
        array = spillway.generate("uniform", 1000, dim=3, seed=7)
        np.testing.assert_array_equal(array, np.load("a.npy"))
        self.assertEqual(spillway.generate("circle", 10).shape, (10, 2))
        self.assertEqual(spillway.generate("terrain", 10).shape, (10, 3))
        self.assertEqual(spillway.generate("uniform", 0).shape, (0, 2))
        command("generate", "terrain", "-n", 1000, "-o", "a.las", "--las-version", "1.4")
        report = spillway.generate("terrain", 1000, "b.las", las_version="1.4")
        self.assertEqual(bytes_of("b.las"), bytes_of("a.las"))
        self.assertEqual((report.points, report.files), (1000, 1))

    def test_a_survey_is_that_of_the_command(self):
        words = ["-n", 3000, "--grid", "3x2", "--overlap", 0.2]
        command("generate", "terrain", *words, "-o", "a_#.las")
        report = spillway.generate("terrain", 3000, "b_#.las", grid=(3, 2), overlap=0.2)
        self.assertEqual(report.files, 6)
        for file in pathlib.Path(".").glob("a_*.las"):
            self.assertEqual(bytes_of("b" + file.name[1:]), bytes_of(file))

    def test_options_without_effect_are_refused(self):
        for options in [{"grid": (2, 2)}, {"overlap": 0.1}, {"output_format": "npy"}]:
            with self.assertRaisesRegex(ValueError, "without an output"):
                spillway.generate("uniform", 10, **options)
        with self.assertRaisesRegex(ValueError, "which always has z"):
            spillway.generate("terrain", 10, dim=3)
        with self.assertRaisesRegex(ValueError, "hills"):
            spillway.generate("hills", 10)


class InfoAndCheck(InFolder):
    def test_info_tells_what_the_command_tells(self):
        command("generate", "terrain", "-n", 2000, "-o", "hills.las")
        spillway.triangulate("hills.las", "mesh.spm", id=True)
        for file, kind in (("hills.las", spillway.PointsInfo), ("mesh.spm", spillway.MeshInfo)):
            told = json.loads(command("info", file, "--json"))
            info = spillway.info(file)
            self.assertIsInstance(info, kind)
            for key, value in dataclasses.asdict(info).items():
                if key == "filters" or key not in told:
                    continue
                if key in ("classes", "returns"):  # the keys of JSON are texts
                    value = {str(number): count for number, count in value.items()} or None
                if key in ("extent", "header_box"):
                    value = None if value is None else {"min": list(value[0]), "max": list(value[1])}
                with self.subTest(file=file, key=key):
                    value = list(value) if isinstance(value, tuple) else value
                    self.assertEqual(value, told[key])
        self.assertEqual(spillway.info("hills.las", every=4).points, 500)
        fast = spillway.info("hills.las", fast=True)
        self.assertEqual((fast.points, fast.classes, fast.extent), (2000, {}, fast.header_box))

    def test_points_are_clipped_and_brought_to_another_system_as_by_the_command(self):
        spillway.generate("terrain", 2000, "hills.las")
        low, high = (corner for corner in spillway.info("hills.las").extent)
        x, z = (round((low[k] + high[k]) / 2) for k in (0, 2))
        with open("area.csv", "w", encoding="utf8") as file:
            file.write(f'n,WKT\n1,"POLYGON ((0 0,{x} 0,{x} 9000000,0 9000000,0 0))"\n')
        cases = (
            ("--clip area.csv --clip-buffer -5", {"clip": "area.csv", "clip_buffer": -5}),
            ("--clip area.csv --clip-outside", {"clip": "area.csv", "clip_outside": True}),
            (f"--z-range 0,{2 * z} --multiply-z 2", {"z_range": (0, 2 * z), "multiply_z": 2}),
            ("--crs EPSG:32633 --to-crs EPSG:25832", {"crs": "EPSG:32633", "to_crs": "EPSG:25832"}),
        )
        for words, options in cases:
            with self.subTest(options=words):
                command("convert", "hills.las", "-o", "a.csv", *words.split())
                report = spillway.convert("hills.las", "b.csv", **options)
                self.assertEqual(bytes_of("b.csv"), bytes_of("a.csv"))
                self.assertGreater(report.written, 0)

    def test_meshes_are_clipped_as_by_the_command(self):
        spillway.generate("terrain", 2000, "hills.las")
        low, high = spillway.info("hills.las").extent
        x = round((low[0] + high[0]) / 2) + 0.0037
        with open("area.csv", "w", encoding="utf8") as file:
            file.write(f'n,WKT\n1,"POLYGON ((0 0,{x} 0,{x} 9000000,0 9000000,0 0))"\n')
        command("triangulate", "hills.las", "-o", "whole.spm")
        command("convert", "whole.spm", "-o", "a.spm", "--clip", "area.csv", "--clip-outside")
        report = spillway.convert("whole.spm", "b.spm", clip="area.csv", clip_outside=True)
        self.assertGreater(report.outside_tiles, 0)
        spillway.triangulate(
            "hills.las", "c.spm", clip="area.csv", clip_outside=True, clip_simplices=True
        )
        self.assertEqual(bytes_of("b.spm"), bytes_of("a.spm"))
        self.assertEqual(spillway.info("c.spm").canonical_hash, spillway.info("a.spm").canonical_hash)
        with self.assertRaisesRegex(spillway.errors.InvalidArgumentError, "clip"):
            spillway.triangulate("hills.las", "d.spm", clip_simplices=True)
        raster = spillway.dem("hills.las", resolution=5, clip="area.csv", clip_pixels=True)
        whole = spillway.dem("hills.las", resolution=5)
        seen = ~np.isnan(raster.values)
        self.assertEqual(raster.values.shape, whole.values.shape)
        self.assertTrue((raster.values[seen] == whole.values[seen]).all())
        columns = np.arange(seen.shape[1]) * 5 + 2.5 + raster.geotransform[0]
        self.assertFalse(seen[:, columns > x].any())
        self.assertTrue((seen == ~np.isnan(whole.values))[:, columns < x].all())

    def test_columns_of_fixed_width_and_what_is_told_of_a_table(self):
        with open("fixed.txt", "w", encoding="utf8") as file:
            file.write("1    1000.505000.25  100.10 EP\n2    1003.255010.75  101.20 TREE\n")
        spillway.convert("fixed.txt", "a.csv", columns=[(6, 12), (13, 20), (21, 27)])
        self.assertEqual(bytes_of("a.csv"), b"1000.5,5000.25,100.1\n1003.25,5010.75,101.2\n")
        told = spillway.info("fixed.txt", columns=[(6, 12), (13, 20), (21, 27)]).table
        self.assertEqual((told["separator"], told["columns"]), ("none", ["6-12", "13-20", "21-27"]))

    def test_what_is_said_of_a_table_is_as_by_the_command(self):
        with open("table.txt", "w", encoding="utf8") as file:
            file.write("station\nNr;Rechts;Hoch;NN\n" + "1;1,5;2,5;3,5\n2;4;5;6\n3;0;9;7\n")
        words = "--skip-lines 1 --columns Rechts,Hoch,NN --separator semicolon --decimal comma"
        command("convert", "table.txt", "-o", "a.csv", *words.split())
        spillway.convert(
            "table.txt", "b.csv", skip_lines=1, columns=["Rechts", "Hoch", "NN"], separator=";", decimal=","
        )
        self.assertEqual(bytes_of("b.csv"), bytes_of("a.csv"))
        spillway.convert(
            "table.txt", "c.csv", skip_lines=2, columns=[2, 3, 4], header=False, attributes=[]
        )
        self.assertIn(b"1.5", bytes_of("c.csv"))

    def test_a_mesh_is_proved_with_and_without_points(self):
        points = random_points(1000, 2)
        spillway.triangulate(points, "mesh.spm")
        self.assertTrue(spillway.check("mesh.spm"))
        self.assertTrue(spillway.check("mesh.spm", points=points))
        np.save("points.npy", points)
        report = spillway.check("mesh.spm", points="points.npy")
        self.assertTrue(report.proved)
        told = json.loads(command("check", "mesh.spm", "--points", "points.npy", "--json"))
        self.assertEqual(report.properties, told["properties"])
        self.assertEqual(report.canonical_hash, told["canonical_hash"])

    def test_a_mesh_that_is_none_is_refuted(self):
        points = random_points(500, 2)
        spillway.triangulate(points, "mesh.spm")
        other = points.copy()
        other[7] += 1e-3
        report = spillway.check("mesh.spm", points=other)
        self.assertFalse(report)
        self.assertEqual(len(report.faults), report.fault_count)
        self.assertIn("refuted", repr(report))
        with self.assertRaisesRegex(ValueError, "every has no effect without points"):
            spillway.check("mesh.spm", every=2)

    def test_either_diagonal_of_a_square_is_accepted_on_demand(self):
        grid = np.stack(np.meshgrid(*[np.arange(2.0)] * 2), axis=-1).reshape(-1, 2)
        spillway.triangulate(grid, "mesh.obj")
        lines = pathlib.Path("mesh.obj").read_text().splitlines()
        vertices = [line for line in lines if line.startswith("v ")]
        place = {tuple(map(float, v.split()[1:3])): i + 1 for i, v in enumerate(vertices)}
        rising = [(0, 0), (1, 0), (1, 1)], [(0, 0), (1, 1), (0, 1)]
        falling = [(0, 0), (1, 0), (0, 1)], [(1, 0), (1, 1), (0, 1)]
        found = []
        for triangles in (rising, falling):
            faces = ["f " + " ".join(str(place[c]) for c in corners) for corners in triangles]
            pathlib.Path("other.obj").write_text("\n".join(vertices + faces) + "\n")
            found.append(bool(spillway.check("other.obj")))
            self.assertTrue(spillway.check("other.obj", any_delaunay=True))
        self.assertEqual(sorted(found), [False, True])


class Reports(InFolder):
    def test_they_print_well_and_do_not_change(self):
        report = spillway.triangulate(random_points(100, 2), "mesh.spm")
        self.assertRegex(
            repr(report),
            r"^<spillway.RunReport: 100 points, 100 vertices, \d+ triangles, hash \w{16}>$",
        )
        self.assertIn(f"\n  simplices                {report.simplices}\n", str(report))
        self.assertLess(max(map(len, str(report).splitlines())), 200)
        with self.assertRaises(dataclasses.FrozenInstanceError):
            report.points = 3


class Options(unittest.TestCase):
    # What reports and exceptions have, what is about the terminal, and what plays and shares runs.
    NOT_HERE = set("help json output parts progress quiet stats tasks verbose".split())

    def test_names_that_options_had_before_go_on_working(self):
        now = {"leaf_points": 100, "tile_points": 200, "heights": "mean", "trust_headers": False}
        before = {"base_case": 100, "tile": 200, "duplicates": "mean", "distrust_headers": True}
        spillway.generate("terrain", 500, "points.las")
        for options, file in ((now, "now.spm"), (before, "before.spm")):
            spillway.triangulate("points.las", file, **options)
        self.assertEqual(open("now.spm", "rb").read(), open("before.spm", "rb").read())
        with self.assertRaisesRegex(TypeError, "tile is the former name of tile_points; give one"):
            spillway.triangulate("points.las", "both.spm", tile_points=300, tile=200)

    def test_functions_have_the_options_of_the_command(self):
        # What a call of a program has besides, and what stands without dashes there.
        beside = set(
            "inputs points first second file mesh family output path threads memory scratch_folder "
            "max_tmp progress".split()
        )
        for name in "triangulate dem height volume density contour render check convert info generate".split():
            told = set(re.findall(r"--([a-z][a-z-]+)", command(name, "--help").split("Examples:")[0]))
            expected = {
                option.removeprefix("no-").replace("-", "_")
                for option in told - self.NOT_HERE
                if not option.startswith("simulate-")
            }
            found = set(inspect.signature(getattr(spillway, name)).parameters)
            with self.subTest(function=name):
                self.assertEqual(expected - found, set())
                self.assertEqual(found - expected - beside, set())

    def test_blocks_have_the_options_of_triangulate_and_of_a_mesh(self):
        found, expected = (
            set(inspect.signature(call).parameters)
            for call in (spillway.blocks, spillway.triangulate)
        )
        self.assertEqual(found - expected, {"mesh_format"})
        self.assertEqual(expected - found, {"output", "output_format", "tiles", "clip_simplices"})


class Errors(InFolder):
    def test_what_is_wrong_with_a_file_is_raised_with_its_name(self):
        with self.assertRaisesRegex(OSError, "^cannot open nowhere.las: No such file") as caught:
            spillway.triangulate("nowhere.las", "mesh.spm")
        self.assertEqual(caught.exception.code, "input or output")
        self.assertEqual(caught.exception.errno, errno.ENOENT)
        self.assertEqual(caught.exception.filename, "nowhere.las")
        pathlib.Path("typo.txt").write_text("1 2 3\n4 5 6\n7 8 g\n")
        with self.assertRaisesRegex(ValueError, "typo.txt: line 3") as caught:
            spillway.triangulate("typo.txt", "mesh.spm")
        self.assertEqual((caught.exception.file, caught.exception.place), ("typo.txt", ("line", 3)))
        other = pickle.loads(pickle.dumps(caught.exception))
        self.assertEqual(other.place, ("line", 3))
        command("generate", "terrain", "-n", 1000, "-o", "hills.las")
        pathlib.Path("short.las").write_bytes(bytes_of("hills.las")[:-100])
        with self.assertRaisesRegex(spillway.errors.BadInputError, "short.las"):
            spillway.triangulate("short.las", "mesh.spm", scratch_folder="tmp")
        self.assert_nothing_is_left("typo.txt", "hills.las", "short.las")

    def test_errors_name_the_arguments_that_help(self):
        points = np.column_stack([random_points(100, 2), np.arange(100)])
        for words, call in [
            ('memory="64M" is enough', lambda: spillway.dem(points, resolution=1, memory="32M")),
            ("EPSG:99999999", lambda: spillway.triangulate(points, "a.gpkg", crs="EPSG:99999999")),
            ("leave out that filter", lambda: spillway.triangulate("a.npy", "a.spm", keep_class=2)),
            ("force_crs=True", lambda: spillway.contour(points, "a.geojson", interval=1)),
            ("columns=", lambda: spillway.triangulate("a.txt", "a.spm")),
        ]:
            np.save("a.npy", points)
            np.savetxt("a.txt", np.column_stack([np.arange(1, 101), points]), fmt="%d %f %f %f")
            with self.subTest(words=words), self.assertRaisesRegex(spillway.Error, words) as caught:
                call()
            self.assertNotIn("--", str(caught.exception))

    def test_a_file_that_was_there_stays_after_an_error(self):
        pathlib.Path("mesh.spm").write_text("old")
        with self.assertRaises(spillway.errors.DegenerateInputError):
            spillway.triangulate(np.zeros((5, 2)), "mesh.spm")
        self.assertEqual(pathlib.Path("mesh.spm").read_text(), "old")

    def test_wrong_options_are_told_by_their_names(self):
        points = random_points(20, 2)
        calls = spillway.triangulate, spillway.convert, spillway.contour, spillway.render
        for call in calls:
            with self.assertRaisesRegex(TypeError, "'memmory'. Did you mean 'memory'"):
                call(points, "out", memmory="1G")
        for call in (spillway.blocks, spillway.dem):
            with self.assertRaisesRegex(TypeError, "unexpected keyword argument 'progres'"):
                call(points, progres=print)
        for kind, words, options in [
            (TypeError, "max_edge is 'long'; give float", {"max_edge": "long"}),
            (TypeError, "every is 1.5; give int", {"every": 1.5}),
            (ValueError, "every is -1, which is out of range", {"every": -1}),
            (ValueError, "tile_points is 1180591620717411303424", {"tile_points": 2**70}),
            (TypeError, r"bounds is '1234'; give sequence", {"bounds": "1234", "every": 1}),
            (TypeError, r"bounds is \('a', 1", {"bounds": ("a", 1, 2, 3), "every": 1}),
            (TypeError, r"thin is \(1,\); give float or", {"thin": (1,), "every": 1}),
            (TypeError, "output_format is 3; give str", {"output_format": 3}),
            (TypeError, "input_format is 3; give str", {"input_format": 3, "every": 1}),
            (TypeError, "scratch_folder is of type int; give a path", {"scratch_folder": 3}),
            (TypeError, "threads is 1.5; give an int", {"threads": 1.5}),
            (ValueError, r"dim is array", {"dim": np.array([2, 3])}),
            (TypeError, "memory is 1.5", {"memory": 1.5}),
            (TypeError, "progress is 3", {"progress": 3}),
            (ValueError, "memory|size", {"memory": "much"}),
            (ValueError, "threads is 0", {"threads": 0}),
            (ValueError, 'heights is "any"; give one of first, lowest', {"heights": "any"}),
            (ValueError, 'kernel is "qhull"', {"kernel": "qhull"}),
            (ValueError, "dim is 4", {"dim": 4}),
            (ValueError, "dim is 3, but inputs has 2 columns", {"dim": 3}),
            (ValueError, "format", {"output_format": "docx"}),
        ]:
            with self.subTest(options=options), self.assertRaisesRegex(kind, words):
                inputs = "hills.las" if "every" in options else points
                spillway.triangulate(inputs, "mesh.spm", **options)
        for words, options in [
            ("bounds has 3 numbers", {"bounds": (1, 2, 3)}),
            ("least coordinate above the most", {"bounds": (1, 0, 0, 1)}),
            ('returns has "second"', {"returns": "second"}),
            ('thin is "deepest"', {"thin": (1, "deepest")}),
            ("no effect with dim=3", {"dim": 3, "heights": "mean"}),
        ]:
            with self.subTest(options=options), self.assertRaisesRegex(ValueError, words):
                spillway.triangulate("hills.las", "mesh.spm", **options)
        self.assert_nothing_is_left()

    def test_wrong_arguments_of_one_function_are_told_with_what_its_docstring_says(self):
        points = random_points(20, 3)
        convert = functools.partial(spillway.convert, points, "out.spp")
        generate, dem = spillway.generate, functools.partial(spillway.dem, points)
        raster = functools.partial(dem, "out.tif", resolution=1)
        render = functools.partial(spillway.render, points, "out.png")
        for kind, words, call, options in [
            (TypeError, "scale is '123'; give float or", convert, {"scale": "123"}),
            (ValueError, "2 numbers; give 1 or 3", convert, {"scale": [1, 2]}),
            (ValueError, "cell_points is -1", convert, {"sorted": True, "cell_points": -1}),
            (TypeError, "mesh_format is 3", spillway.check, {"mesh": "a", "mesh_format": 3}),
            (ValueError, "count is -1, which", generate, {"family": "uniform", "count": -1}),
            (TypeError, "count is None; give int", generate, {"family": "uniform", "count": None}),
            (TypeError, "exaggerate is 'x'; give float", render, {"exaggerate": "x"}),
            (TypeError, "slice is 'z'; give", render, {"slice": "z"}),
            (TypeError, "product is None; give str", dem, {"product": None}),
            (TypeError, "cog is 'yes'; give bool", raster, {"cog": "yes"}),
            (TypeError, r"bounds is \(1, 2\); give \(float,", raster, {"bounds": (1, 2)}),
            (ValueError, "clip_bounds has no effect on an array", raster, {"clip_bounds": (1, 2)}),
        ]:
            with self.subTest(options=options), self.assertRaisesRegex(kind, words):
                call(**options)
        with self.assertRaisesRegex(TypeError, r"grid is \(2,\); give \(int, int\)"):
            generate("uniform", 9, "out#.npy", grid=(2,))
        with self.assertRaisesRegex(ValueError, "levels is empty"):
            spillway.contour(points, "out.gpkg", levels=[])
        self.assert_nothing_is_left()

    def test_names_that_no_file_can_have_are_refused(self):
        points = random_points(20, 3)
        for words, name in [("empty", ""), ("null character", "mesh\0.ply")]:
            for call in [
                lambda: spillway.triangulate(points, name),
                lambda: spillway.triangulate(name, "mesh.ply"),
                lambda: spillway.triangulate(["hills.las", name], "mesh.ply"),
                lambda: spillway.info(name),
                lambda: spillway.dem(points, like=name),
                lambda: spillway.triangulate(points, "mesh.ply", scratch_folder=name),
            ]:
                with self.assertRaisesRegex(ValueError, words):
                    call()
        self.assert_nothing_is_left()

    def test_paths_that_come_one_by_one_are_refused_with_a_hint(self):
        for inputs in (pathlib.Path(".").glob("*.las"), {"hills.las"}, open(os.devnull)):
            with self.assertRaisesRegex(TypeError, "give paths in a list, or an array"):
                spillway.triangulate(inputs, "mesh.spm")
        inputs.close()

    def test_wrong_inputs(self):
        for words, inputs in [
            (r"shape \(4,\)", np.zeros(4)),
            (r"shape \(5, 7\)", np.zeros((5, 7))),
            ("dim is 2, but inputs has 4 columns", np.zeros((5, 4))),
            ("is empty; give paths", []),
            ("is of type NoneType", None),
            ("elements of type complex128", np.zeros((5, 2), complex)),
            ("elements of type <U1|is no array", [["a", "b"]]),
            ("not finite", [[0, 0], [1, np.nan], [1, 1]]),
        ]:
            with self.subTest(inputs=inputs), self.assertRaisesRegex(ValueError, words):
                spillway.triangulate(inputs, "mesh.spm")
        with self.assertRaisesRegex(TypeError, "a path and ndarray"):
            spillway.triangulate(["a.las", np.zeros((3, 2))], "mesh.spm")
        with self.assertRaisesRegex(TypeError, "output is of type int"):
            spillway.triangulate(np.zeros((3, 2)), 3)
        with self.assertRaisesRegex(ValueError, "every has no effect on an array"):
            spillway.triangulate(np.eye(3), "mesh.spm", every=2)
        with self.assertRaisesRegex(ValueError, "heights has no effect on points without z"):
            spillway.triangulate(random_points(9, 2), "mesh.spm", heights="mean")
        self.assert_nothing_is_left()

    def test_more_points_than_memory_holds_are_a_memory_error_before_the_work(self):
        for count in (10**15, 2**61):
            with self.assertRaisesRegex(MemoryError, "memory ran out"):
                spillway.generate("uniform", count)

    def test_limits_that_do_not_suffice(self):
        points = random_points(1_000_000, 2)
        with self.assertRaises(MemoryError) as caught:
            spillway.triangulate(points, "mesh.spm", memory="1M")
        self.assertEqual(caught.exception.code, "out of budget")
        with self.assertRaises(spillway.errors.OutOfBudgetError):
            spillway.triangulate(points, "mesh.spm", memory="32M", scratch_folder="tmp", max_tmp="64K")
        self.assert_nothing_is_left()


class Resume(InFolder):
    def run_of(self, output, **options):
        names = {"resume": "run", "checkpoint_every": 0.02, "memory": "64M", "tile_points": 5000}
        return spillway.triangulate("hills.las", output, **{**names, **options})

    def test_a_program_that_is_killed_goes_on(self):
        # So many that progress is told more than once after the first checkpoint.
        command("generate", "terrain", "-n", 800_000, "-o", "hills.las")
        whole = self.run_of("whole.spm")
        program = (
            "import os, spillway\n"
            "def kill(done):\n"
            "    if done > 0.2 and os.path.exists('run/state'): os.kill(os.getpid(), 9)\n"
            "spillway.triangulate('hills.las', 'a.spm', resume='run', checkpoint_every=0.02,\n"
            "                     memory='64M', tile_points=5000, progress=kill)\n"
        )
        killed = subprocess.run([sys.executable, "-c", program])
        self.assertEqual(killed.returncode, -9)
        self.assertFalse(os.path.exists("a.spm"))
        with self.assertRaisesRegex(ValueError, "tile points is 6000, and was 5000"):
            self.run_of("a.spm", tile_points=6000)
        with self.assertWarnsRegex(spillway.Warning, "goes on with the run in run"):
            report = self.run_of(pathlib.Path("a.spm"), resume=pathlib.Path("run"))
        self.assertEqual(report.canonical_hash, whole.canonical_hash)
        self.assertEqual(bytes_of("a.spm"), bytes_of("whole.spm"))
        self.assert_nothing_is_left("hills.las", "a.spm", "whole.spm")

    def test_what_cannot_go_on_is_refused(self):
        with self.assertRaisesRegex(ValueError, "cannot be resumed: its points are a program's"):
            spillway.triangulate(random_points(100, 2), "a.spm", resume="run")
        with self.assertRaisesRegex(ValueError, "checkpoint_every has no effect without resume"):
            spillway.triangulate("hills.las", "a.spm", checkpoint_every=5)
        command("generate", "terrain", "-n", 1000, "-o", "hills.las")
        with self.assertRaisesRegex(ValueError, "checkpoints are not -1 seconds apart"):
            spillway.triangulate("hills.las", "a.spm", resume="run", checkpoint_every=-1)
        with self.assertRaisesRegex(TypeError, "resume is 1; give path"):
            spillway.triangulate("hills.las", "a.spm", resume=1)
        self.assert_nothing_is_left("hills.las")

    def test_blocks_and_pixels_take_a_folder_too(self):
        command("generate", "terrain", "-n", 20_000, "-o", "hills.las")
        for call in (
            lambda **resume: spillway.dem("hills.las", resolution=2, **resume).values,
            lambda **resume: np.concatenate(
                [block.vertices for block in spillway.blocks("hills.las", tile_points=5000, **resume)]
            ),
        ):
            np.testing.assert_array_equal(call(resume="run"), call())
        self.assert_nothing_is_left("hills.las")


class LongWork(InFolder):
    def test_progress_rises_to_one_in_the_thread_of_the_caller(self):
        told, threads = [], set()

        def progress(fraction):
            told.append(fraction)
            threads.add(threading.get_ident())

        points = random_points(600_000, 2)
        spillway.triangulate(points, "mesh.spm", threads=1, progress=progress)
        self.assertGreater(len(told), 1)
        self.assertEqual(told, sorted(set(told)))
        self.assertEqual(told[-1], 1)
        self.assertEqual(threads, {threading.get_ident()})

    def test_progress_of_every_call_ends_with_one(self):
        spillway.generate("terrain", 2000, "hills.las")
        for call in [
            lambda **o: spillway.triangulate("hills.las", "mesh.spm", **o),
            lambda **o: spillway.convert("hills.las", "hills.spp", sorted=True, **o),
            lambda **o: spillway.convert("mesh.spm", "mesh.ply", **o),
            lambda **o: spillway.dem("mesh.spm", resolution=5, **o),
            lambda **o: spillway.contour("hills.las", "lines.gpkg", interval=10, **o),
            lambda **o: spillway.render("mesh.ply", "view.png", size=64, **o),
            lambda **o: spillway.check("mesh.spm", points="hills.las", **o),
            lambda **o: spillway.info("hills.las", **o),
            lambda **o: spillway.generate("uniform", 100, **o),
            lambda **o: list(spillway.blocks("hills.las", **o)),
        ]:
            told = []
            call(progress=told.append)
            self.assertEqual(told[-1], 1)
            self.assertEqual(told, sorted(set(told)))

    def test_ctrl_c_leaves_nothing(self):
        points = random_points(1_500_000, 2)

        def press(fraction):
            signal.raise_signal(signal.SIGINT)

        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        try:
            with self.assertRaises(KeyboardInterrupt):
                spillway.triangulate(
                    points, "mesh.spm", memory="64M", scratch_folder="tmp", threads=1, progress=press
                )
        finally:
            signal.signal(signal.SIGINT, before)
        self.assert_nothing_is_left()

    def test_ctrl_c_ends_the_wait_for_a_pipe_that_nobody_writes_to(self):
        os.mkfifo("pipe")
        reader, writer = os.pipe()
        self.addCleanup(os.close, reader)
        self.addCleanup(os.close, writer)
        before = signal.signal(signal.SIGALRM, signal.default_int_handler)
        try:
            for name in ("pipe", f"/dev/fd/{reader}"):
                signal.setitimer(signal.ITIMER_REAL, 0.1)
                with self.assertRaises(KeyboardInterrupt):
                    spillway.triangulate(name, "mesh.spm", input_format="npy")
        finally:
            signal.signal(signal.SIGALRM, before)
        os.remove("pipe")
        self.assert_nothing_is_left()

    def test_what_progress_raises_ends_the_run(self):
        def progress(fraction):
            raise ZeroDivisionError

        with self.assertRaises(ZeroDivisionError):
            spillway.triangulate(
                random_points(1_000_000, 2), "mesh.spm", memory="64M", scratch_folder="tmp", progress=progress
            )
        self.assert_nothing_is_left()

    def test_warnings_of_a_run_are_warnings_of_python(self):
        command("generate", "terrain", "-n", 1000, "-o", "a.las")
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            spillway.dem("a.las", resolution=1e5)
        self.assertEqual([w.category for w in caught], [spillway.Warning])
        self.assertEqual(caught[0].filename, __file__)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with self.assertRaises(spillway.Warning):
                spillway.dem("a.las", resolution=1e5)

    def test_what_explains_a_run_is_logged(self):
        spillway.generate("terrain", 1000, "hills.las")
        with self.assertLogs("spillway", "INFO") as logged:
            spillway.triangulate("hills.las", "mesh.spm")
        self.assertIn("hills.las", "".join(logged.output))

    def test_runs_beside_each_other(self):
        results = {}

        def work(number):
            points = random_points(50_000, 2, seed=number)
            results[number] = spillway.triangulate(points, f"{number}.spm").canonical_hash

        threads = [threading.Thread(target=work, args=(n,)) for n in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for number, found in results.items():
            self.assertEqual(found, spillway.Delaunay(random_points(50_000, 2, seed=number)).hash)


if __name__ == "__main__":
    unittest.main()
