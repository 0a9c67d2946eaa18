#!/usr/bin/env python3
"""Kills runs with --resume at random moments, again and again until they end, and compares bytes.

    kill_driver.py COMMAND [--kills 50 | --damages 40 | --full-disks 5 | --soak 20] [--seed 1]
                   [--family NAME] [--points 150000]

Each family is a kind of run. What it writes must be what the same run writes that nobody kills, and
nothing else may be left. With --damages, checkpoints and scratch files of killed runs are damaged:
a bit flipped, the end cut off, or a file missing. Then a run must end with an error that names the
file, or with the same bytes. With --full-disks, outputs and states are on a disk that gets full, and
then gets more room. With --soak 20 --points 2e8, one large run is killed every 20 seconds, and its
time told beside that of one that nobody kills. Exits with 1 at the first run that does not end so,
and with 77 if it is skipped.
"""
import argparse
import filecmp
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

TERRAIN = ["generate", "terrain", "-o", "terrain.las", "-n"]
TABLE = ["generate", "terrain", "-o", "terrain.csv", "-n"]
SURVEY = ["generate", "terrain", "--grid", "5x5", "-o", "survey#.las", "-n"]
TILES = ["generate", "terrain", "--grid", "2x2", "-o", "tile#.las", "-n"]
SPACE = ["generate", "uniform", "--dim", "3", "-o", "space.npy", "-n"]
SURFACE = ["generate", "ellipsoid", "--dim", "3", "-o", "surface.npy", "-n"]
MPIRUN = ["mpirun", "--oversubscribe", "--bind-to", "none"]
PLANE = ["--tile-points", "5000", "--memory", "64M"]
SMALL = ["--memory", "32M"]  # for some million points
IN_SPACE = ["--dim", "3", "--tile-points", "5000", "--memory", "96M"]

# Name: input, share of the points, arguments, output or, of a batch, a pattern of its outputs; and
# the number of ranks, if there are any.
FAMILIES = {
    "spilled": (TERRAIN, 15, ["triangulate", "terrain.las", *SMALL], "x.spm"),
    "whole": (TERRAIN, 1, ["triangulate", "terrain.las", *PLANE], "x.spm"),
    "planned": (SURVEY, 1, ["triangulate", "survey*.las", *PLANE], "x.spm"),
    "planned_space": (SURVEY, 0.3, ["triangulate", "survey*.las", *IN_SPACE], "x.spm"),
    "space": (SPACE, 0.3, ["triangulate", "space.npy", *IN_SPACE], "x.spm"),
    "surface": (SURFACE, 0.5, ["triangulate", "surface.npy", *IN_SPACE], "x.spm"),
    "spooled": (TERRAIN, 1, ["triangulate", "terrain.las", "--id", *PLANE], "x.ply"),
    "text": (TERRAIN, 1, ["triangulate", "terrain.las", "--max-edge", "4", *PLANE], "x.sma"),
    "thinned": (TERRAIN, 1, ["triangulate", "terrain.las", "--thin", "2:lowest", *PLANE], "x.spm"),
    "stl": (TERRAIN, 0.5, ["triangulate", "terrain.las", *PLANE], "x.stl"),
    "dem": (TERRAIN, 1, ["dem", "terrain.las", "--resolution", "2", *PLANE], "x.tif"),
    "dem_planned": (SURVEY, 1, ["dem", "survey*.las", "--resolution", "0.5", "--product",
                                "height,slope,density", *PLANE], "x.tif"),
    "contour": (TERRAIN, 0.5, ["contour", "terrain.las", "--interval", "20", *PLANE], "x.shp"),
    "soak": (TERRAIN, 1, ["triangulate", "terrain.las", "--memory", "256M"], "x.spm"),
    "batch": (TILES, 1, ["batch", "tile*.las", "--to", "spm,ply", "-j", "2", "--tile-points", "5000",
                         "--memory", "256M"], "*.[ps]??"),
    "ranks": (SURVEY, 1, ["triangulate", "survey*.las", "--id", *PLANE], "x.spm", 3),
    "ranks_spilled": (TERRAIN, 15, ["triangulate", "terrain.las", *SMALL], "x.spm", 2),
    "ranks_text": (TABLE, 0.5, ["triangulate", "terrain.csv", "--id", *PLANE], "x.ply", 2),
    "ranks_space": (SPACE, 0.3, ["triangulate", "space.npy", *IN_SPACE], "x.vtu", 2),
    "ranks_dem": (TERRAIN, 1, ["dem", "terrain.las", "--resolution", "2", *PLANE], "x.tif", 2),
    "ranks_contour": (TERRAIN, 0.5, ["contour", "terrain.las", "--interval", "20", *PLANE],
                      "x.shp", 2),
}


SKIPPED = 77


class Failed(Exception):
    pass


def descendants(process):
    """The processes that this one has begun, and those that they have."""
    parents = {}
    for entry in pathlib.Path("/proc").iterdir():
        try:
            parents[int(entry.name)] = int((entry / "stat").read_text().rpartition(")")[2].split()[1])
        except (ValueError, OSError):
            pass
    found = [process]
    for parent in found:
        found += [child for child, of in parents.items() if of == parent]
    return found[1:]


def kill(processes):
    for process in processes:
        try:
            os.kill(process, signal.SIGKILL)
        except ProcessLookupError:
            pass


class Runs:
    """Runs of one family, in a folder of its own."""

    def __init__(self, command, family, points, seed, checkpoint_seconds=0.02):
        self.checkpoint_seconds = checkpoint_seconds
        source, share, self.arguments, self.output, *ranks = FAMILIES[family]
        self.ranks = ranks[0] if ranks else 0
        self.command = [command]
        self.random = random.Random(f"{family} {seed}")
        self.call([*source, str(int(points * share)), "--seed", str(seed), "-q"])
        if self.ranks:
            self.command = [*MPIRUN, "-n", str(self.ranks), command]
        started = time.monotonic()
        self.call(self.run_of("undisturbed"))
        self.seconds = time.monotonic() - started
        self.check_clean("undisturbed")

    def call(self, arguments):
        done = subprocess.run([*self.command, *arguments], capture_output=True, text=True)
        if done.returncode != 0:
            raise Failed(f"{' '.join(arguments)}: {done.stderr}")

    def run_of(self, folder):
        os.makedirs(folder, exist_ok=True)
        pace = ["--checkpoint-every", str(self.checkpoint_seconds)]
        if self.arguments[0] == "batch":
            return [*self.arguments, "--output-dir", folder, *pace, "--resume"]
        return [*self.arguments, "-o", f"{folder}/{self.output}", *pace, "--resume",
                f"{folder}/run"]

    def run_for(self, folder, seconds):
        """The exit code and messages; None for the code if it was killed: all of it, or a rank."""
        process = subprocess.Popen([*self.command, *self.run_of(folder)], stderr=subprocess.PIPE,
                                   stdout=subprocess.DEVNULL, text=True)
        try:
            _, messages = process.communicate(timeout=seconds)
            return process.returncode, messages
        except subprocess.TimeoutExpired:
            ranks = descendants(process.pid) if self.ranks else []
            if ranks and self.random.random() < 0.5:
                kill([self.random.choice(ranks)])
                try:
                    return None, process.communicate(timeout=5)[1]
                except subprocess.TimeoutExpired:  # some versions of mpirun wait for ever
                    pass
            kill([process.pid, *ranks])
            return None, process.communicate()[1]  # ends when all of them have

    def check_clean(self, folder):
        left = [name for name in os.listdir(folder)
                if name == "run" or name.endswith((".part", ".resume"))]
        if left:
            raise Failed(f"a run that is complete has left {', '.join(left)}")

    def check_same(self, folder):
        for reference in pathlib.Path("undisturbed").glob(self.output):
            if not filecmp.cmp(pathlib.Path(folder) / reference.name, reference, shallow=False):
                raise Failed(f"{reference.name} is another one than that of the run that was not "
                             "killed")
        self.check_clean(folder)

    def kill_until_done(self):
        """How often it was killed, and how often it went on from a checkpoint."""
        shutil.rmtree("killed", ignore_errors=True)
        kills = 0
        went_on = 0
        while True:
            # Longer and longer, as the last steps of a run may be long ones.
            most = 0.6 * self.seconds * (1 + 0.1 * kills)
            ends = kills >= 40
            code, messages = self.run_for(
                "killed", 60 + 20 * self.seconds if ends else self.random.uniform(0.02, most))
            went_on += "goes on" in messages
            if code is None and ends:
                raise Failed(f"after {kills} kills the run does not end")
            if code is None:
                kills += 1
            elif code != 0:
                raise Failed(f"after {kills} kills: {messages}")
            else:
                self.check_same("killed")
                return kills, went_on

    def soak(self, seconds):
        """Seconds of a run that cannot go on, of one that can, and of one that is killed again and
        again after `seconds`; and how often that was."""
        started = time.monotonic()
        self.call([*self.arguments, "-o", "usual.spm"])
        usual = time.monotonic() - started
        os.remove("usual.spm")
        started = time.monotonic()
        kills = 0
        while self.run_for("killed", seconds)[0] is None:
            kills += 1
        killed = time.monotonic() - started
        self.check_same("killed")
        return {"s of the usual run": round(usual), "s of one that can go on": round(self.seconds),
                "s of one that was killed": round(killed), "times": kills}

    def killed_run(self):
        """Leaves the folder of a run that was killed once it had a checkpoint."""
        while True:
            shutil.rmtree("killed", ignore_errors=True)
            code, _ = self.run_for("killed", self.random.uniform(0.1, 0.9) * self.seconds)
            states = len(list(pathlib.Path("killed/run").rglob("state")))
            if code is None and states >= max(1, self.ranks):
                return

    def damage(self):
        """Damages a file of a killed run, and returns what became of the run."""
        shutil.rmtree("damaged", ignore_errors=True)
        shutil.copytree("killed", "damaged")
        files = [path for path in pathlib.Path("damaged/run").rglob("*")
                 if path.is_file() and path.stat().st_size > 0]
        path = self.random.choice(files if self.random.random() < 0.5 else
                                  [p for p in files if p.parent.name != "scratch"])
        size = path.stat().st_size
        place = self.random.randrange(size)
        kind = self.random.choice(["flipped", "flipped", "cut off", "missing"])
        if kind == "flipped":
            with open(path, "r+b") as file:
                file.seek(place)
                byte = file.read(1)[0]
                file.seek(place)
                file.write(bytes([byte ^ (1 << self.random.randrange(8))]))
        elif kind == "cut off":
            os.truncate(path, place)
        else:
            path.unlink()
        # The same paths: the folder is where the killed run had it.
        shutil.rmtree("killed.kept", ignore_errors=True)
        os.rename("killed", "killed.kept")
        os.rename("damaged", "killed")
        code, messages = self.run_for("killed", 60 + 20 * self.seconds)
        what = f"{kind} at {place} of {size} bytes of {path.relative_to('damaged')}"
        try:
            if code == 0:
                self.check_same("killed")
                return "same"
            if code is None or code < 0:
                raise Failed(f"the run does not end well (code {code})")
            if "killed/run" not in messages and "part" not in messages:
                raise Failed(f"the message names no file of the run: {messages}")
            return "refused"
        except Failed as failure:
            raise Failed(f"{what}: {failure}") from None
        finally:
            shutil.rmtree("killed", ignore_errors=True)
            os.rename("killed.kept", "killed")


    def fill_disk(self):
        """How often a run ended as the disk was full, before there was room enough."""
        shutil.rmtree("killed", ignore_errors=True)
        os.mkdir("killed")
        size = sum(file.stat().st_size for file in pathlib.Path("undisturbed").glob(self.output))
        room = self.random.uniform(0.1, 1) * size
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={int(room)}", "none", "killed"],
                       check=True)
        try:
            times_full = 0
            while True:
                code, messages = self.run_for("killed", 60 + 20 * self.seconds)
                if code == 0:
                    self.check_same("killed")
                    return times_full
                if code is None or code < 0 or "No space left on device" not in messages:
                    raise Failed(f"on a disk of {int(room)} bytes, code {code}: {messages}")
                times_full += 1
                room *= 1.5
                subprocess.run(["mount", "-o", f"remount,size={int(room)}", "killed"], check=True)
        finally:
            subprocess.run(["umount", "-l", "killed"], check=True)


def can_mount():
    with tempfile.TemporaryDirectory() as folder:
        if subprocess.run(["mount", "-t", "tmpfs", "none", folder], capture_output=True).returncode:
            return False
        return subprocess.run(["umount", folder]).returncode == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("command")
    parser.add_argument("--kills", type=int, default=50, help="of each family at least")
    parser.add_argument("--damages", type=int, default=0, help="of each family, in place of kills")
    parser.add_argument("--full-disks", type=int, default=0, help="likewise; needs to be root")
    parser.add_argument("--soak", type=float, help="seconds after which one large run is killed")
    parser.add_argument("--points", type=float, default=150_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--family", choices=FAMILIES, action="append")
    options = parser.parse_args()
    command = os.path.abspath(options.command)
    os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    others = options.damages or options.full_disks or options.soak
    families = [family for family in FAMILIES
                if family != "soak" and not (others and family == "batch")]
    if options.soak:
        families = ["soak"]
    if options.full_disks and not can_mount():
        print("skipped: a small disk cannot be mounted, which root may")
        return SKIPPED
    for family in options.family or families:
        if len(FAMILIES[family]) > 4 and not shutil.which("mpirun"):
            print(f"{family}: skipped, as there is no mpirun")
            continue
        with tempfile.TemporaryDirectory(prefix="spillway-kills-") as folder:
            os.chdir(folder)
            try:
                runs = Runs(command, family, options.points, options.seed,
                            options.soak / 4 if options.soak else 0.02)
                counts = {"kills": 0, "went on": 0, "runs": 0}
                while counts["kills"] < options.kills and not others:
                    kills, went_on = runs.kill_until_done()
                    counts["kills"] += kills
                    counts["went on"] += went_on
                    counts["runs"] += 1
                if options.damages:
                    counts = {"refused": 0, "same": 0}
                for number in range(options.damages):
                    if number % 10 == 0:
                        runs.killed_run()
                    counts[runs.damage()] += 1
                if options.soak:
                    counts = runs.soak(options.soak)
                if options.full_disks:
                    counts = {"times full": 0, "runs": options.full_disks}
                for number in range(options.full_disks):
                    counts["times full"] += runs.fill_disk()
                print(f"{family}: {', '.join(f'{n} {what}' for what, n in counts.items())}",
                      flush=True)
            except Failed as failure:
                print(f"{family}, seed {options.seed}: {failure}", file=sys.stderr)
                return 1
            finally:
                os.chdir("/")
    return 0


if __name__ == "__main__":
    sys.exit(main())
