#!/usr/bin/env python3
"""Times spillway.Delaunay beside scipy.spatial.Delaunay, by turns, on the same points and places.

Prints a Markdown table: seconds of wall time, of the first construction of a process and of
another one, those that processors worked for the first, and the memory that it took on top of the
points. Each turn is a process of its own, with fresh memory; medians over the turns. Points and places are uniform, in no order.

    PYTHONPATH=build/release/python python3 tests/benchmark/python_benchmark.py
"""

import argparse
import json
import resource
import statistics
import subprocess
import sys
import time

MEASURES = {
    "construction": "s",
    "another construction": "s",
    "processors": "s",
    "memory": "MB",
    "find_simplex": "s",
    "interpolate": "s",
}


def peak_megabytes():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e6


def timed(work):
    begin = time.perf_counter()
    result = work()
    return time.perf_counter() - begin, result


def take_turn(library, dim, points, places, threads):
    """Measures one library in this process."""
    import numpy as np

    rng = np.random.default_rng(1)
    inputs = rng.random((points, dim))
    questions = rng.random((places, dim))
    values = inputs.sum(axis=1)
    figures = {}
    if library == "spillway":
        import spillway

        construct = lambda: spillway.Delaunay(inputs, threads=threads)
        interpolate = lambda: tri.interpolate(questions, values)
    else:
        from scipy.interpolate import LinearNDInterpolator
        from scipy.spatial import Delaunay

        construct = lambda: Delaunay(inputs)
        interpolate = lambda: LinearNDInterpolator(tri, values)(questions)
    memory, processors = peak_megabytes(), time.process_time()
    figures["construction"], tri = timed(construct)
    figures["processors"] = time.process_time() - processors
    figures["memory"] = peak_megabytes() - memory
    del tri
    figures["another construction"], tri = timed(construct)
    figures["find_simplex"], _ = timed(lambda: tri.find_simplex(questions))
    figures["interpolate"], _ = timed(interpolate)
    return figures


def turn_of(library, *numbers):
    """Figures of a turn, in a process of its own."""
    command = [sys.executable, __file__, "--turn", library, *map(str, numbers)]
    return json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--points-2d", type=int, default=1_000_000, metavar="N")
    parser.add_argument("--points-3d", type=int, default=300_000, metavar="N")
    parser.add_argument("--higher", action="store_true", help="four to six dimensions instead")
    parser.add_argument("--places", type=int, default=200_000, metavar="N")
    parser.add_argument("--threads", type=int, default=2, metavar="N", help="of spillway")
    parser.add_argument("--turns", type=int, default=3, metavar="N")
    parser.add_argument("--turn", nargs=5, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.turn:
        library, *numbers = options.turn
        print(json.dumps(take_turn(library, *map(int, numbers))))
        return
    print("| | points | | SciPy | Spillway | ratio |\n|---|---|---|---|---|---|")
    sets = ((2, options.points_2d), (3, options.points_3d))
    if options.higher:
        sets = ((4, 20_000), (5, 2_000), (6, 500))
    for dim, points in sets:
        turns = {"scipy": [], "spillway": []}
        for _ in range(options.turns):
            for library, figures in turns.items():
                figures.append(turn_of(library, dim, points, options.places, options.threads))
        for measure, unit in MEASURES.items():
            scipy, ours = (
                statistics.median(figures[measure] for figures in of_library)
                for of_library in turns.values()
            )
            row = f"| {dim}D | {points} | {measure}, {unit} "
            print(f"{row}| {scipy:.3g} | {ours:.3g} | **{scipy / ours:.3g}** |", flush=True)


if __name__ == "__main__":
    main()
