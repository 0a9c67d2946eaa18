#!/usr/bin/env python3
"""Runs the shell blocks of docs/performance.md, and keeps what each of them prints.

    LIDAR=FOLDER tests/benchmark/figures.py FOLDER [NAME...]

Builds first. Then the blocks run in FOLDER, which needs 25 GB, from top to bottom; the output of one below the heading
"Rasters and contours" is in FOLDER/rasters-and-contours.txt. NAME (rasters-and-contours) runs some of them alone; most
of them use files that the first ones leave in FOLDER. LIDAR names a folder with real LiDAR files. Let nothing else use
the machine. The exit code is 1 if a block failed.
"""

import os
import pathlib
import re
import subprocess
import sys
import time

CHECKOUT = pathlib.Path(__file__).resolve().parents[2]
PAGE = CHECKOUT / "docs" / "performance.md"


def blocks():
    """Names and texts, in the page's order; the first one has none: it is the build."""
    name = ""
    for heading, text in re.findall(r"^#{2,3} ([^\n]+)$|^```sh\n(.*?)^```$", PAGE.read_text("utf-8"), re.M | re.S):
        if heading:
            name = re.sub(r"\W+", "-", heading.lower())
        else:
            yield name, text


def run(text, output, folder, environment):
    begin = time.monotonic()
    script = ["bash", "-e", "-u", "-o", "pipefail", "-c", text]
    with output.open("a", encoding="utf-8") as file:
        code = subprocess.run(script, cwd=folder, env=environment, stdout=file, stderr=file).returncode
    print(f"{output.name}: exit code {code}, {time.monotonic() - begin:.0f} s", flush=True)
    return code == 0


def main():
    folder, names = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:]
    folder.mkdir(parents=True, exist_ok=True)
    (_, build), *others = blocks()
    chosen = [(name, text) for name, text in others if not names or name in names]
    for name, _ in chosen:
        (folder / f"{name}.txt").unlink(missing_ok=True)
    subprocess.run(["bash", "-e", "-c", build], cwd=CHECKOUT, check=True, stdout=subprocess.DEVNULL)
    programs = [pathlib.Path(sys.executable).parent, CHECKOUT / "build/release/bin", CHECKOUT / "tests/benchmark"]
    environment = {
        **os.environ,
        "PATH": ":".join([*map(str, programs), os.environ["PATH"]]),
        "PYTHONPATH": f"{CHECKOUT}/build/release/python",
        "LIDAR": str(pathlib.Path(os.environ["LIDAR"]).resolve()),
    }
    succeeded = [run(text, folder / f"{name}.txt", folder, environment) for name, text in chosen]
    return 0 if all(succeeded) else 1


if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1].startswith("-") or "LIDAR" not in os.environ:
        sys.exit(__doc__)
    sys.exit(main())
