#!/usr/bin/env python3
"""Fuzzes all readers, or some, for a time each, and minimises what is found.

    tests/fuzz/run.py build/fuzz/bin/fuzz FOLDER --minutes 60 --jobs 2 [TARGET...]

FOLDER keeps the inputs of each target that reach something new, and the next run begins with them. A
target ends at its first finding: a line with the command that repeats it. The exit code is 1 if there is
one, and 0 if there is none.
"""

import argparse
import concurrent.futures
import hashlib
import pathlib
import re
import subprocess
import sys
import time

DICTIONARIES = pathlib.Path(__file__).resolve().parent / "dictionaries"
LIMITS = ["-rss_limit_mb=1024", "-malloc_limit_mb=256", "-timeout=10"]
LONGEST_INPUT = 16384
# Readers are quick: choosing inputs by what is rare in them would take most of the time.
CHOICE = ["-entropic=0"]


def executions(log):
    """How many inputs a log of libFuzzer tells of."""
    told = re.findall(r"stat::number_of_executed_units: (\d+)", log) or re.findall(r"^#(\d+)\t", log, re.M)
    return int(told[-1]) if told else 0


def run_target(options, target):
    """Returns the target, how many inputs were read, and the finding, or nothing."""
    folder = options.folder / target
    found = folder / "found"
    corpus = folder / "corpus"
    for path in (found, corpus):
        path.mkdir(parents=True, exist_ok=True)
    dictionary = DICTIONARIES / (target + ".dict")
    log = folder / "log"
    with open(log, "w", encoding="utf-8") as output:
        done = subprocess.run(
            [options.program, f"--target={target}", f"-dict={dictionary}", *LIMITS, *CHOICE,
             f"-max_total_time={max(1, round(options.minutes * 60))}", f"-max_len={LONGEST_INPUT}",
             "-print_final_stats=1", f"-artifact_prefix={found}/", corpus, options.folder / "seeds" / target],
            stdout=output, stderr=subprocess.STDOUT, check=False)
    text = log.read_text(encoding="utf-8", errors="replace")
    finding = None
    if done.returncode != 0:
        artifact = re.search(r"Test unit written to (\S+)", text)
        finding = minimised(options, target, artifact.group(1), found) if artifact else str(log)
    return target, executions(text), finding


def minimised(options, target, artifact, found):
    """The path of the shortest input with the same end that is found in a minute."""
    name = hashlib.sha256(pathlib.Path(artifact).read_bytes()).hexdigest()[:12]
    smallest = found / f"minimised-{name}"
    if "timeout-" in artifact:
        return artifact
    subprocess.run(
        [options.program, f"--target={target}", *LIMITS, "-minimize_crash=1", "-max_total_time=60",
         f"-exact_artifact_path={smallest}", artifact],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
    return str(smallest) if smallest.exists() else artifact


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("targets", nargs="*")
    parser.add_argument("--minutes", type=float, default=1, help="for each target (default: %(default)s)")
    parser.add_argument("--jobs", type=int, default=1, help="targets at a time (default: %(default)s)")
    options = parser.parse_intermixed_args()
    options.program = options.program.resolve()
    options.folder = options.folder.resolve()
    targets = options.targets or subprocess.run([options.program, "--list"], capture_output=True, text=True,
                                                check=True).stdout.split()
    subprocess.run([options.program, f"--seeds={options.folder / 'seeds'}"], check=True)
    total = 0
    findings = 0
    begin = time.monotonic()
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        jobs = [pool.submit(run_target, options, target) for target in targets]
        for job in concurrent.futures.as_completed(jobs):
            target, count, finding = job.result()
            total += count
            print(f"{target}: {count} inputs" + (", none is a fault" if finding is None else ""), flush=True)
            if finding is not None:
                findings += 1
                print(f"FOUND {options.program} --target={target} {' '.join(LIMITS)} {finding}", flush=True)
    print(f"{total} inputs in {time.monotonic() - begin:.0f} s, {findings} findings")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
