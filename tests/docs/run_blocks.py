"""Runs the shell blocks of a page from top to bottom, in a folder of their own.

    run_blocks.py PAGE COMMAND

PAGE is a page in Markdown, COMMAND the spillway to run; `python3` is the interpreter that runs this. Each block is one
run of bash, which must succeed. So that pages may speak of a hundred million points, `spillway generate` makes at most
20,000. `build/release` is the build that COMMAND is of, `docs` that of this checkout. A block below a line

    <!-- not run: REASON -->

is only shown; programs of this checkout that it names must be there. Prints a line for each block, and ends with 77
(skipped) where the build or the machine lacks what the blocks need.
"""

import importlib.util
import os
import pathlib
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time

CHECKOUT = pathlib.Path(__file__).resolve().parents[2]
BLOCK = re.compile(r"^(?:<!-- not run: (?P<reason>[^\n]+) -->\n+)?```sh\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL)
SKIPPED = 77
SECONDS = 120

FEWER_POINTS = """#!/bin/bash
# spillway, but with fewer points to generate.
arguments=()
for argument; do
  if [[ ${previous:-} =~ ^(-n|--count)$ ]]; then
    argument=$(awk -v n="$argument" 'BEGIN { print (n > 20000) ? 20000 : n }')
  fi
  arguments+=("$argument")
  previous=$argument
done
exec -a spillway COMMAND "${arguments[@]}"
"""


def lacking(command, blocks):
    """What the blocks need and this machine lacks; empty if it lacks nothing."""
    version = subprocess.run([command, "--version"], check=True, capture_output=True, text=True).stdout
    lacks = re.findall(r"without \w+", version)
    text = "".join(block["text"] for block in blocks if not block["reason"])
    programs = [name for name in ("mpirun", "gdal_calc.py", "awk", "zcat", "cmake") if name in text]
    lacks += [f"no {name}" for name in programs if shutil.which(name) is None]
    modules = [name for name in ("numpy", "spillway") if f"import {name}" in text]
    return lacks + [f"no Python module {name}" for name in modules if importlib.util.find_spec(name) is None]


def check_shown(text):
    """A block that is only shown names programs of the checkout that are there."""
    for path in re.findall(r"(?:^|\s)((?:tools|tests|docs)/[\w./-]+)", text):
        assert (CHECKOUT / path).exists(), f"there is no {path}"


def add_program(path, text):
    path.write_text(text, encoding="utf-8")
    path.chmod(0o755)


def run(text, folder, environment):
    """Whether the block succeeds in time; else what it has printed is shown."""
    shell = subprocess.Popen(
        ["bash", "-e", "-u", "-o", "pipefail", "-c", text],
        cwd=folder,
        env=environment,
        start_new_session=True,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
    )
    try:
        printed, _ = shell.communicate(timeout=SECONDS)
    except subprocess.TimeoutExpired:
        os.killpg(shell.pid, signal.SIGKILL)
        printed = f"{shell.communicate()[0]}\nnot done after {SECONDS} s"
    if shell.returncode != 0:
        print(printed)
    return shell.returncode == 0


def main():
    page, command = pathlib.Path(sys.argv[1]), str(pathlib.Path(sys.argv[2]).resolve())
    text = page.read_text(encoding="utf-8")
    blocks = list(BLOCK.finditer(text))
    assert len(blocks) == len(re.findall(r"^```sh$", text, re.MULTILINE)), "a block does not end"
    if missing := lacking(command, blocks):
        print("skipped:", ", ".join(missing))
        return SKIPPED
    failures = 0
    with tempfile.TemporaryDirectory(prefix="spillway-blocks-") as work:
        programs, folder = pathlib.Path(work, "bin"), pathlib.Path(work, "folder")
        programs.mkdir()
        (folder / "build").mkdir(parents=True)
        (folder / "build" / "release").symlink_to(pathlib.Path(command).parents[1])
        (folder / "docs").symlink_to(CHECKOUT / "docs")
        add_program(programs / "spillway", FEWER_POINTS.replace("COMMAND", shlex.quote(command)))
        add_program(programs / "python3", f'#!/bin/sh\nexec {shlex.quote(sys.executable)} "$@"\n')
        environment = {
            **os.environ,
            "PATH": f"{programs}:{os.environ['PATH']}",
            "OMPI_ALLOW_RUN_AS_ROOT": "1",
            "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
            "OMPI_MCA_rmaps_base_oversubscribe": "1",
        }
        for block in blocks:
            line = text.count("\n", 0, block.start("text")) + 1
            first = block["text"].splitlines()[0]
            if block["reason"]:
                check_shown(block["text"])
                print(f"shown   {page.name}:{line}  {first}  ({block['reason']})")
                continue
            begin = time.monotonic()
            succeeded = run(block["text"], folder, environment)
            failures += not succeeded
            seconds = time.monotonic() - begin
            print(f"{'ran    ' if succeeded else 'FAILED '} {page.name}:{line}  {first}  {seconds:.1f} s")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
