#!/usr/bin/env python3
"""Makes every call of a run to the system fail in turn, and looks at how the run ends.

    fault_driver.py COMMAND INJECTOR [--calls read,write] [--family NAME,...] [--most 40] [--jobs 2]

Each family is a kind of run. It is made once to count its calls, and then once for each call and
each error that the system may give: of files (open, read, write, ...), of memory from a page on, of
threads, and of what is read from scratch files, spp and spm. After an error that the run cannot
bear, it must end with exit code 1 and one line that says what failed and why; nothing may be under
the final name, beside it, or in the temporary folder. After one that it can (an interrupted call,
half a transfer), its bytes must be those of the run without faults. --most N takes N of a family's
calls of each kind, evenly, instead of all. Exits with 1 if a run ended otherwise.
"""
import argparse
import concurrent.futures
import errno
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SMALL = ["--memory", "32M"]  # at which 600,000 points are too many for the memory
POINTS = ["generate", "terrain", "-n", "20000", "-o", "in.las"]
MANY = ["generate", "terrain", "-n", "600000", "-o", "in.las"]
TABLE = ["generate", "terrain", "-n", "5000", "-o", "in.csv"]
SPACE = ["generate", "uniform", "--dim", "3", "-n", "5000", "-o", "in.npy"]
TILES = ["generate", "terrain", "--grid", "2x2", "-n", "4000", "-o", "in#.las"]
SEALED = ["convert", "in.las", "-o", "in.spp"]
MESH = ["triangulate", "in.las", "-o", "mesh.spm"]

# Name: what is run before, and arguments.
FAMILIES = {
    "spilled": ([MANY], ["triangulate", "in.las", "-o", "out.spm", *SMALL]),
    "spooled": ([MANY], ["triangulate", "in.las", "-o", "out.ply", *SMALL]),
    "tiled": ([POINTS], ["triangulate", "in.las", "-o", "out.obj", "--tile-points", "2000"]),
    "text": ([TABLE], ["triangulate", "in.csv", "-o", "out.sma"]),
    "space": ([SPACE], ["triangulate", "in.npy", "-o", "out.vtu", "--dim", "3"]),
    "resumed": ([POINTS], ["triangulate", "in.las", "-o", "out.spm", "--resume", "state",
                           "--checkpoint-every", "0.001", "--tile-points", "2000"]),
    "tiles": ([POINTS], ["triangulate", "in.las", "--tiles", "500", "-o", "out_{x}_{y}.ply"]),
    "laz": ([POINTS], ["convert", "in.las", "-o", "out.laz"]),
    "sorted": ([MANY], ["convert", "in.las", "-o", "out.spp", "--sorted", *SMALL]),
    "thinned": ([POINTS], ["convert", "in.las", "-o", "out.npy", "--thin", "5"]),
    "dem": ([POINTS], ["dem", "in.las", "--resolution", "20", "-o", "out.tif"]),
    "contour": ([POINTS], ["contour", "in.las", "--interval", "20", "-o", "out.shp"]),
    "picture": ([POINTS], ["render", "in.las", "-o", "out.png"]),
    "page": ([POINTS], ["render", "in.las", "-o", "out.html"]),
    "checked": ([POINTS, MESH], ["check", "mesh.spm", "--points", "in.las"]),
    "proved": ([MANY, MESH], ["check", "mesh.spm"]),
    "sealed": ([MANY, SEALED], ["triangulate", "in.spp", "-o", "out.spm"]),
    "converted": ([POINTS, MESH], ["convert", "mesh.spm", "-o", "out.obj"]),
    "rank_0": ([POINTS], ["triangulate", "in.las", "-o", "out.spm", "--tile-points", "2000"]),
    "rank_1": ([POINTS], ["triangulate", "in.las", "-o", "out.ply", "--tile-points", "2000"]),
    "batch": ([TILES], ["batch", "in*.las", "--to", "spm,ply", "-j", "1",
                         "--output-dir", "out"]),
}

# As errors: half of a transfer is done; a bit is flipped of what is read; nothing is read any more.
SHORT, FLIPPED, ENDED = 0, -1, -2
WORDS = {SHORT: "half a transfer", FLIPPED: "a flipped bit", ENDED: "an early end"}
BEARABLE = {SHORT, errno.EINTR}
ERRORS = {
    "scratch": [FLIPPED, ENDED],
    "input": [FLIPPED, ENDED],
    "open": [errno.EMFILE, errno.EACCES, errno.ENOSPC],
    "read": [errno.EIO, errno.EINTR, SHORT],
    "write": [errno.ENOSPC, errno.EIO, errno.EDQUOT, errno.EINTR, SHORT],
    "sync": [errno.EIO],
    "rename": [errno.EIO, errno.ENOSPC],
    "unlink": [errno.EIO],
    "folder": [errno.ENOSPC],
    "size": [errno.EIO],
    "close": [errno.EDQUOT],
    "memory": [errno.ENOMEM],
    "thread": [errno.EAGAIN],
}
OF_FILES = [call for call in ERRORS if call not in ("memory", "thread")]
REASONS = {"memory": "memory", "thread": "thread", "scratch": "tmp/"}
CHECKSUMS = {"proved": "mesh.spm", "sealed": "in.spp"}  # families whose input has them
OF_RANKS = {"rank_0": 0, "rank_1": 1}  # families of two processes, and which of them fails
# Their libraries end the process where they get no memory, and wait forever for a thread.
NEED_GDAL = {"dem", "contour"}
ONLY_FILES = NEED_GDAL | OF_RANKS.keys()
MPIRUN = ["mpirun", "--oversubscribe", "--bind-to", "none"]
ROOT_MAY = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
OF_SCRATCH = {"FAULT_FOLDER": "tmp"}  # within the folder of the run


class Family:
    """A kind of run: its inputs, and what it writes where nothing fails."""

    def __init__(self, name, options):
        self.name = name
        self.options = options
        self.before, self.arguments = FAMILIES[name]
        self.folder = pathlib.Path(options.work) / name
        self.folder.mkdir()
        for arguments in self.before:
            subprocess.run([options.command, *arguments, "-q"], cwd=self.folder, check=True)
        self.inputs = {path.name for path in self.folder.iterdir()}
        right = self.run("count", {"FAULT_COUNTS": "counts"})
        if right.code != 0:
            raise SystemExit(f"{name}: the run without faults ends with {right.code}: {right.text}")
        self.counts = dict(line.split() for line in right.counts.splitlines())
        of_scratch = self.run("count", {"FAULT_COUNTS": "counts", **OF_SCRATCH}).counts
        self.counts["input"] = self.counts["read"]
        self.counts["scratch"] = dict(line.split() for line in of_scratch.splitlines())["read"]
        self.right = right.files

    def run(self, name, environment):
        return Run(self, name, environment)


def command_with_fault(family, injected):
    """The command whose one process has this in its environment; of ranks, each has its TMPDIR."""
    command = [family.options.command, *family.arguments]
    failing = ["env", *[f"{name}={value}" for name, value in injected.items()], *command]
    if family.name not in OF_RANKS:
        return failing
    ranks = [["env", f"TMPDIR={injected['TMPDIR']}", *command]] * 2
    ranks[OF_RANKS[family.name]] = failing
    return [*MPIRUN, "-n", "1", *ranks[0], ":", "-n", "1", *ranks[1]]


class Run:
    """One run in a folder of its own, with what it said and left."""

    def __init__(self, family, name, environment):
        folder = family.folder / f"run_{name}"
        (folder / "tmp").mkdir(parents=True)
        for path in family.inputs:
            os.link(family.folder / path, folder / path)
        within = folder / environment.pop("FAULT_FOLDER", "")
        injected = {"LD_PRELOAD": family.options.injector, "FAULT_FOLDER": str(within),
                    "TMPDIR": str(folder / "tmp"), **environment}
        # Runs of mpirun that begin and end at once must not share a folder, which one of them removes.
        with tempfile.TemporaryDirectory(prefix="mpi-") as session:
            around = {**os.environ, **ROOT_MAY, "OMPI_MCA_orte_tmpdir_base": session}
            try:
                ended = subprocess.run(command_with_fault(family, injected), cwd=folder, env=around,
                                       capture_output=True, timeout=60)
                self.code, self.text = ended.returncode, ended.stderr.decode(errors="replace")
            except subprocess.TimeoutExpired:
                self.code, self.text = None, "does not end"
        counts = folder / "counts"
        self.counts = counts.read_text() if counts.exists() else ""
        counts.unlink(missing_ok=True)
        left = [path for path in folder.rglob("*") if path.is_file()]
        self.left = {str(path.relative_to(folder)) for path in left} - family.inputs
        self.left |= {str(path.relative_to(folder)) for path in (folder / "tmp").iterdir()}
        self.files = {path: (folder / path).read_bytes() for path in self.left
                      if (folder / path).is_file() and not path.startswith(("state", "tmp/"))
                      and not path.endswith((".log", ".json"))}  # a batch's records, with times
        shutil.rmtree(folder)

    def errors(self):
        """Its lines of errors; of a batch one of the jobs that failed."""
        lines = self.text.splitlines()
        of_jobs = [line for line in lines if re.match(r"spillway: \[\d+/\d+\] .*: failed", line)]
        return of_jobs[:1] or [line for line in lines if line.startswith("spillway: error")]


def left_behind(family, run, call):
    """What of a run that failed should not be there."""
    left = run.left
    if family.name == "resumed":  # to go on from; what is done stays
        left = {path for path in left if not re.match(r"state|out\.spm\..*\.part$", path)}
    if family.name in ("resumed", "batch"):
        left = {path for path in left if run.files.get(path, b"") != family.right.get(path)
                and not path.endswith((".log", ".json"))}
    if call == "unlink" and "cannot remove" in run.text:
        left = {path for path in left if not path.startswith("tmp/")}
    return sorted(left)


def complaint(family, run, call, error):
    """What is wrong with the end of this run; None if nothing is."""
    if run.code not in (0, 1):
        return f"ended with {run.code}"
    if run.code == 0:
        if run.files != family.right:
            return "other bytes without a word"
        in_tmp = any(path.startswith("tmp/") for path in run.left)
        silent = in_tmp and "cannot remove" not in run.text
        return "scratch files left without a word" if silent else None
    if error in BEARABLE:
        return "an error that it should bear"
    if len(run.errors()) != 1:
        return f"{len(run.errors())} lines of errors"
    named = CHECKSUMS.get(family.name) if call == "input" else REASONS.get(call)
    reason = named or os.strerror(error)
    untold = "ended with exit code" in run.errors()[0]  # the batch cannot read the job's log either
    untold |= family.name in NEED_GDAL and "cannot write" in run.errors()[0]  # nor does GDAL say it
    if reason not in run.errors()[0] and not untold:
        return f"the error does not say '{reason}'"
    left = left_behind(family, run, call)
    return f"left behind: {left}" if left else None


def evenly(count, most):
    numbers = range(1, count + 1)
    if most == 1:
        return numbers[:1]
    if most and count > most:
        return sorted({1 + i * (count - 1) // (most - 1) for i in range(most)})
    return numbers


def cases_of(family, options):
    for call in options.calls:
        if call in ("memory", "thread") and family.name in ONLY_FILES:
            continue
        if call == "input" and family.name not in CHECKSUMS:
            continue
        for n in evenly(int(family.counts[call]), options.most):
            for error in ERRORS[call]:
                # Of memory, the run frees some itself.
                lasting = error not in BEARABLE and call not in ("memory", "scratch", "input")
                for lasts in ("0", "1") if lasting else ("0",):
                    yield family, call, n, error, lasts


def try_case(case):
    family, call, n, error, lasts = case
    name = f"{call}_{n}_{error}_{lasts}"
    fault = {"FAULT_AT": str(n), "FAULT_ERROR": str(error), "FAULT_LASTS": lasts}
    if call == "scratch":
        fault.update(OF_SCRATCH)
    counted_as = "read" if call in ("scratch", "input") else call
    run = family.run(name, {"FAULT_CALL": counted_as, **fault})
    return case, run, complaint(family, run, call, error)


def described(case):
    family, call, n, error, lasts = case
    what = WORDS.get(error) or os.strerror(error)
    return f"{family.name}: {call} {n}{' and all later' if lasts == '1' else ''}: {what}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("command")
    parser.add_argument("injector")
    parser.add_argument("--calls", default=",".join(ERRORS))
    parser.add_argument("--family", default=",".join(FAMILIES))
    parser.add_argument("--most", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    options.command, options.injector = map(os.path.abspath, (options.command, options.injector))
    options.calls = OF_FILES if options.calls == "files" else options.calls.split(",")
    failed = runs = borne = 0
    with tempfile.TemporaryDirectory(prefix="faults.") as options.work, \
            concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for name in options.family.split(","):
            family = Family(name, options)
            for case, run, wrong in pool.map(try_case, cases_of(family, options)):
                runs += 1
                borne += run.code == 0
                if wrong:
                    failed += 1
                    print(f"{described(case)}: {wrong}\n{run.text[-600:]}", flush=True)
            print(f"{name}: {runs} runs with a fault so far, {borne} of which bore it, "
                  f"{failed} ended wrongly", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
