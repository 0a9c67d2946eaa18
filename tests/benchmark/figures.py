"""Runs the shell blocks of docs/performance.md, and keeps what each of them prints.

    tests/benchmark/figures.py FOLDER [NAME...]

Builds first. Then the blocks run in FOLDER, which needs 25 GB, from top to bottom; the output of one below the heading
"Rasters and contours" is in FOLDER/rasters-and-contours.txt. NAME (rasters-and-contours) runs some of them alone. LIDAR
in the environment names real LiDAR files; ../shared/data is taken without it. Let nothing else use the machine.
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
    with output.open("a", encoding="utf-8") as file:
        code = subprocess.run(
            ["bash", "-u", "-o", "pipefail", "-c", text], cwd=folder, env=environment, stdout=file, stderr=file
        ).returncode
    print(f"{output.name}: exit code {code}, {time.monotonic() - begin:.0f} s", flush=True)


def main():
    folder, names = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:]
    folder.mkdir(parents=True, exist_ok=True)
    (_, build), *others = blocks()
    subprocess.run(["bash", "-e", "-c", build], cwd=CHECKOUT, check=True, stdout=subprocess.DEVNULL)
    environment = {
        **os.environ,
        "PATH": f"{pathlib.Path(sys.executable).parent}:{CHECKOUT}/build/release/bin:{CHECKOUT}/tests/benchmark:{os.environ['PATH']}",
        "PYTHONPATH": f"{CHECKOUT}/build/release/python",
        "LIDAR": os.environ.get("LIDAR", str(CHECKOUT.parent / "shared" / "data")),
    }
    for name, text in others:
        if not names or name in names:
            run(text, folder / f"{name}.txt", folder, environment)


if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    main()
