#!/usr/bin/env python3
"""Runs a command for long, and watches what it takes of the machine.

    soak.py COMMAND --points 1e9 --folder FOLDER [--memory 1G] [--picture FILE.png]
    soak.py COMMAND --jobs 20000 --folder FOLDER [--picture FILE.png]

With --points, so many points of a terrain are generated, triangulated, checked, made a raster, and
checked against the points. With --jobs, `batch` makes meshes of so many small files. Twice a second
a line goes to FOLDER/samples.csv: seconds, stage, memory and descriptors of the process and of
those that it has begun, bytes in its scratch folder, and how much it has done. At the end a table
is printed; --picture draws the lines. Exits with 1 if a stage fails, takes more memory than
--memory and 54 MiB, or if its descriptors grow: in the last tenth of a stage there are more than in
its first half, by some.
"""
import argparse
import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import threading
import time

MIB = 1 << 20
ALLOWED = 54 * MIB  # beside --memory: 14 MiB, and what GDAL takes where coordinate systems are read
SOME_DESCRIPTORS = 8  # that come and go
FIELDS = ["seconds", "stage", "memory", "descriptors", "scratch", "done"]


def with_children(process):
    """The process and those that it has begun."""
    found = [process]
    for task in pathlib.Path(f"/proc/{process}/task").iterdir():
        for child in (task / "children").read_text().split():
            found += with_children(int(child))
    return found


def taken_by(processes):
    """Their resident memory and their descriptors."""
    memory = descriptors = 0
    for process in processes:
        try:
            pages = int(pathlib.Path(f"/proc/{process}/statm").read_text().split()[1])
            descriptors += len(os.listdir(f"/proc/{process}/fd"))
            memory += pages * os.sysconf("SC_PAGE_SIZE")
        except (FileNotFoundError, ProcessLookupError):  # it has just ended
            pass
    return memory, descriptors


def bytes_below(folder):
    total = 0
    for path in folder.rglob("*"):
        try:
            total += path.stat().st_blocks * 512
        except FileNotFoundError:  # gone meanwhile
            pass
    return total


class Watcher:
    """Runs stages one after the other and keeps samples of all."""

    def __init__(self, options):
        self.options = options
        self.folder = pathlib.Path(options.folder)
        self.tmp = self.folder / "tmp"
        self.tmp.mkdir(parents=True)
        self.samples = []
        self.begin = time.monotonic()

    def run(self, stage, arguments):
        arguments = [self.options.command, *arguments, "--progress", "json"]
        process = subprocess.Popen(arguments, cwd=self.folder, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE,
                                   env={**os.environ, "TMPDIR": str(self.tmp)}, text=True)
        last = {"line": "", "done": 0, "phases": 0}
        reader = threading.Thread(target=self.follow, args=(process, last))
        reader.start()
        first = len(self.samples)
        while process.poll() is None:
            self.sample(stage, process.pid, last)
            time.sleep(0.5)
        reader.join()
        if process.returncode != 0:
            raise SystemExit(f"{stage} ends with {process.returncode}: {last['line']}")
        if any(self.tmp.iterdir()):
            raise SystemExit(f"{stage} leaves {list(self.tmp.iterdir())}")
        return self.samples[first:]

    @staticmethod
    def follow(process, last):
        for line in process.stderr:
            last["line"] = line
            try:
                told = json.loads(line)
            except ValueError:
                continue
            if "done" in told:
                last["done"] = last["phases"] + told["done"]
                if told.get("finished"):
                    last["phases"] = last["done"]

    def sample(self, stage, process, last):
        try:
            memory, descriptors = taken_by(with_children(process))
        except (FileNotFoundError, ProcessLookupError):  # it has just ended
            return
        self.samples.append({
            "seconds": round(time.monotonic() - self.begin, 2), "stage": stage, "memory": memory,
            "descriptors": descriptors, "scratch": bytes_below(self.tmp), "done": last["done"]})

    def write(self):
        with open(self.folder / "samples.csv", "w", newline="") as file:
            writer = csv.DictWriter(file, FIELDS)
            writer.writeheader()
            writer.writerows(self.samples)


def large_run(watcher):
    options = watcher.options
    memory = ["--memory", options.memory]
    yield "generate", ["generate", "terrain", "-n", options.points, "-o", "points.spp"]
    yield "triangulate", ["triangulate", "points.spp", "-o", "mesh.spm", *memory]
    yield "check", ["check", "mesh.spm", *memory]
    yield "dem", ["dem", "points.spp", "-o", "dem.tif", "--resolution", "5", *memory]
    yield "check --points", ["check", "mesh.spm", "--points", "points.spp", *memory]


def many_jobs(watcher):
    options = watcher.options
    for i in range(int(float(options.jobs))):
        (watcher.folder / f"part{i}.xyz").write_text(
            "".join(f"{x} {y} {(x * y + i) % 17}\n" for x in range(5) for y in range(5)))
    yield "batch", ["batch", "part*.xyz", "--to", "spm", "--output-dir", "meshes",
                    "-j", "2", "--memory", options.memory]


def figures(stage, samples):
    half, tenth = samples[:(len(samples) + 1) // 2], samples[-max(1, len(samples) // 10):]
    return {"stage": stage, "seconds": samples[-1]["seconds"] - samples[0]["seconds"],
            "memory": max(s["memory"] for s in samples) / MIB,
            "memory at the end": max(s["memory"] for s in tenth) / MIB,
            "descriptors": max(s["descriptors"] for s in samples),
            "grows": max(s["descriptors"] for s in tenth)
            > max(s["descriptors"] for s in half) + SOME_DESCRIPTORS,
            "scratch": max(s["scratch"] for s in samples) / MIB}


def draw(samples, picture):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(4, 1, figsize=(9, 9), sharex=True)
    rates = [0.0] + [max(0, b["done"] - a["done"]) / max(b["seconds"] - a["seconds"], 1e-9) / 1e6
                     if a["stage"] == b["stage"] else 0 for a, b in zip(samples, samples[1:])]
    width = max(1, len(samples) // 200)
    smooth = [sum(rates[max(0, i - width):i + 1]) / len(rates[max(0, i - width):i + 1])
              for i in range(len(rates))]
    lines = [("memory, MiB", [s["memory"] / MIB for s in samples]),
             ("descriptors", [s["descriptors"] for s in samples]),
             ("scratch, MiB", [s["scratch"] / MIB for s in samples]),
             ("rate, millions/s", smooth)]
    seconds = [s["seconds"] for s in samples]
    for axis, (name, values) in zip(axes, lines):
        axis.plot(seconds, values, linewidth=1)
        axis.set_ylabel(name)
        axis.set_ylim(bottom=0)
        axis.grid(alpha=0.3)
    for stage in dict.fromkeys(s["stage"] for s in samples):
        first = next(s["seconds"] for s in samples if s["stage"] == stage)
        for axis in axes:
            axis.axvline(first, color="grey", linewidth=0.8)
        axes[0].annotate(stage, (first, axes[0].get_ylim()[1]), fontsize=9, rotation=25)
    axes[-1].set_xlabel("seconds")
    figure.tight_layout()
    figure.savefig(picture, dpi=100)


def bytes_of(size):
    return float(size[:-1]) * {"M": MIB, "G": 1024 * MIB}[size[-1]]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("command")
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--points")
    what.add_argument("--jobs")
    parser.add_argument("--folder", required=True, help="a new one, on the disk that is used")
    parser.add_argument("--memory", default="1G")
    parser.add_argument("--picture")
    options = parser.parse_args()
    options.command = shutil.which(options.command) or options.command
    options.command = str(pathlib.Path(options.command).resolve())
    watcher = Watcher(options)
    wrong = False
    for stage, arguments in (many_jobs if options.jobs else large_run)(watcher):
        of_stage = figures(stage, watcher.run(stage, arguments))
        watcher.write()
        if options.picture:
            draw(watcher.samples, options.picture)
        grows, limited = of_stage.pop("grows"), "--memory" in arguments
        too_much = limited and of_stage["memory"] * MIB > bytes_of(options.memory) + ALLOWED
        wrong |= grows or too_much
        print(" ".join(f"{name} {value:.0f}," if name != "stage" else f"{value}:"
                       for name, value in of_stage.items()),
              "descriptors grow" if grows else "", "too much memory" if too_much else "", flush=True)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
