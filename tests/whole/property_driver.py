#!/usr/bin/env python3
"""Runs the whole command on random points in random ways, and compares it with CGAL.

    property_driver.py FOLDER [--minutes 1 | --cases 100] [--seed 1] [--kind runs] [--most 20000]

FOLDER has the programs spillway and cgal_mesh. A case follows from its seed, its kind and --most
alone; the first one has --seed (a number, or `random`), the next one the next number. Kinds: `runs`
of one process, `ranks` of several, and `meshes`, which are damaged: `check` must refuse all that are
wrong. At the first finding the driver prints its seed, makes the case small, keeps its files, prints
the command that repeats it, and ends with 1; with 77 if something is missing that it needs.
"""
import argparse
import collections
import os
import random
import shutil
import sys
import tempfile
import time

SKIPPED = 77

try:
    import numpy
except ImportError:
    print("skipped: this Python has no NumPy")
    sys.exit(SKIPPED)

import cases
import damaged_meshes
import oracle
import runs
import shrink

numpy.seterr(all="ignore")  # huge and subnormal coordinates


class Driver:
    def __init__(self, options):
        self.options = options
        self.binary = os.path.abspath(f"{options.folder}/spillway")
        self.cgal = os.path.abspath(f"{options.folder}/cgal_mesh")
        self.folder = tempfile.mkdtemp(prefix="spillway-whole-")
        self.counts = collections.Counter()

    def run(self, case):
        return runs.run_case(case, self.binary, self.cgal, f"{self.folder}/case")

    def one(self, seed, kind):
        os.makedirs(f"{self.folder}/made", exist_ok=True)
        os.chdir(self.folder)
        if kind == "meshes":
            what = damaged_meshes.run(seed, self.binary, self.cgal, f"{self.folder}/case", self.options)
            self.counts[what] += 1
            return
        case = cases.random_case(seed, self.binary, f"{self.folder}/made", kind, self.options.most)
        try:
            self.counts.update(self.run(case).what)
        except oracle.Failed as failure:
            print(f"{runs.shown(case, 'spillway')}\n  {case.family}, {case.points()} points: {failure}",
                  file=sys.stderr, flush=True)
            self.report_small(case, failure.sort)
            raise

    def report_small(self, case, sort):
        small = shrink.Shrinker(self.run, sort, self.options.shrink).shrunk(case)
        try:
            self.run(small)
            text = "the small case does not fail again"
        except oracle.Failed as failure:
            text = str(failure)
        print(f"small: {runs.shown(small, self.binary)}\n  {text}", file=sys.stderr)
        for number, one in enumerate(small.inputs):
            lattice = f", scale {one.scale}, offset {one.offset}" if one.scale is not None else ""
            print(f"  {one.name(number)}: {len(one.points)} points{lattice}", file=sys.stderr)
            for row in one.points[:40] if small.points() < 300 else []:
                print("    " + " ".join(repr(float(v)) for v in row), file=sys.stderr)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", help="of the programs")
    parser.add_argument("--minutes", type=float, help="how long; default: until --cases are done")
    parser.add_argument("--cases", type=int, help="how many; default: 100, or any for --minutes")
    parser.add_argument("--seed", default="1", help="of the first case, or `random`")
    parser.add_argument("--kind", choices=["runs", "ranks", "meshes"], action="append")
    parser.add_argument("--most", type=int, default=20_000, help="points of a case in the plane")
    parser.add_argument("--shrink", type=float, default=60, help="seconds for making a case small")
    options = parser.parse_args()
    if options.minutes is None and options.cases is None:
        options.cases = 100
    return options


def main():
    options = arguments()
    kinds = options.kind or ["runs"] * 6 + ["meshes"] * 3 + ["ranks"]
    if "ranks" in kinds and not shutil.which("mpirun"):
        kinds = [kind for kind in kinds if kind != "ranks"]
        if not kinds:
            print("skipped: there is no mpirun")
            return SKIPPED
    first = random.SystemRandom().randrange(2 ** 40) if options.seed == "random" else int(options.seed)
    driver = Driver(options)
    started = time.monotonic()
    done = 0
    while ((options.cases is None or done < options.cases) and
           (options.minutes is None or time.monotonic() < started + 60 * options.minutes)):
        seed = first + done
        kind = kinds[seed % len(kinds)]
        try:
            driver.one(seed, kind)
        except Exception as failure:
            print(f"seed {seed}, kind {kind}: {failure}\n  again: property_driver.py {options.folder} "
                  f"--seed {seed} --kind {kind} --cases 1 --most {options.most}\n"
                  f"  its files: {driver.folder}/case", file=sys.stderr)
            if not isinstance(failure, oracle.Failed):
                raise
            return 1
        done += 1
    os.chdir("/")
    shutil.rmtree(driver.folder)
    print(f"{done} cases from seed {first} in {time.monotonic() - started:.0f} s: "
          + ", ".join(f"{count} {what}" for what, count in sorted(driver.counts.items())))
    return 0


if __name__ == "__main__":
    sys.exit(main())
