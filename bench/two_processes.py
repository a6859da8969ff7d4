#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The cost of two processes: films of a volume by two processes of one thread, compared with one process of two threads.

    bench/two_processes.py --tessera PROGRAM [--old PROGRAM] [--repeats 5] [--frames 12] [--samples 256] [--size 1024x1024] [--results docs/RESULTS.md]

`ripples` of SAMPLES^3 floats from a distance of five half sides: a turn of 2 degrees per frame, whose splits use the times of the previous frame, and an orbit of
36 degrees per frame, where each view is new; sort-first by `--balance learned`, and sort-last. Each film is rendered by one process, then by two in both
modes, and so on REPEATS times. A *frame* is the median over the film's frames except the first, the median of that over repetitions; *whole* the time of
the whole run, including starting, reading and writing images. Ratios are medians over repetitions of two processes' time to that of the one,
with the smallest and largest; *CPU* is the same for the run's processor time, including mpirun. *Finding* is the share of finding the splits in the processor
time of rendering, *uneven* the excess of the slowest process over the mean, in processor time, both for frames except the first.

On two cores shared with other programs, ratios of time depend more on the other load than on the program. Needs mpirun and Python's standard library.
"""
import argparse
import json
import math
import os
import pathlib
import resource
import statistics
import tempfile
import time

import results_file
from balance import run

FILMS = {"turn": 2, "orbit": 36}  # degrees per frame
WAYS = {"sort-first": [], "sort-last": ["--distribution", "sort-last"]}


def path(degrees, frames):
    """About the y axis; ripples are in [-1, 1]^3."""
    for n in range(frames):
        a = math.radians(degrees * n) + 0.3
        yield {"position": [5 * math.cos(a), 1, 5 * math.sin(a)], "focal_point": [0, 0, 0], "view_up": [0, 1, 0], "view_angle": 40}


def render(args, program, folder, film, processes, words):
    """For a run: milliseconds of a frame and in total, CPU milliseconds, and the balance of its frames except the first."""
    report = folder / "report.json"
    launch = ["mpirun", "--oversubscribe", "-n", processes] if processes > 1 else []
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    begin = time.monotonic()
    run([*launch, program, "render", folder / "ripples.nrrd", "-o", folder / "f%d.pfm", "--camera", folder / f"{film}.json", "--size", args.size,
         "--transfer-function", "cool-warm:rise", "--threads", 2 // processes, "--quiet", "--report", report, *words])
    whole = 1e3 * (time.monotonic() - begin)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = 1e3 * (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    frames = json.loads(report.read_text())["frames"][1:]
    return {"frame": statistics.median(ms for frame in frames for ms in frame["frame_ms"]), "whole": whole, "cpu": cpu,
            "balance": [frame["balance"]["processes"] for frame in frames] if processes > 1 else []}


def shares(runs):
    """(CPU time of finding splits relative to that of rendering, the slowest process's relative to the mean minus one), percent."""
    frames = [processes for made in runs for processes in made["balance"]]
    finding = sum(p["split_cpu_ms"] for f in frames for p in f) / sum(p["cpu_ms"] for f in frames for p in f)
    uneven = statistics.mean(max(p["cpu_ms"] for p in f) / statistics.mean(p["cpu_ms"] for p in f) - 1 for f in frames)
    return 100 * finding, 100 * uneven


def ratios(two, one, what):
    of = [t[what] / o[what] for t, o in zip(two, one)]
    return f"{statistics.median(of):.2f} ({min(of):.2f} to {max(of):.2f})"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tessera", type=pathlib.Path, required=True)
    parser.add_argument("--old", type=pathlib.Path, help="another program, in turn with the first")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--frames", type=int, default=12)
    parser.add_argument("--samples", type=int, default=256)
    parser.add_argument("--size", default="1024x1024")
    parser.add_argument("--results", type=pathlib.Path)
    args = parser.parse_args()
    programs = {"new": args.tessera.resolve()} | ({"old": args.old.resolve()} if args.old else {})
    load = os.getloadavg()[0]
    made = {}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run([programs["new"], "generate", "ripples", folder / "ripples.nrrd", f"n={args.samples}", "--quiet"])
        for film, degrees in FILMS.items():
            (folder / f"{film}.json").write_text(json.dumps(list(path(degrees, args.frames))))
        for _ in range(args.repeats):
            for film in FILMS:
                for which, program in programs.items():
                    for way, processes, words in [("one", 1, []), *((way, 2, words) for way, words in WAYS.items())]:
                        made.setdefault((film, which, way), []).append(render(args, program, folder, film, processes, words))

    which_column = len(programs) > 1  # else all rows are of one program
    table = ["| film " + "| program " * which_column + "| two processes | a frame: one / two, ms | ratio (range) | whole run: one / two, s | "
             "ratio (range) | CPU (range) | finding | uneven |",
             "|---" * (2 + which_column) + "|---:|---|---:|---|---|---:|---:|"]
    for film, degrees in FILMS.items():
        for which in programs:
            first = f"| {film}, {degrees} degrees a frame " + f"| {which} " * which_column
            one = made[film, which, "one"]
            for way in WAYS:
                two = made[film, which, way]
                middle = {what: [statistics.median(m[what] for m in runs) for runs in (one, two)] for what in ("frame", "whole")}
                finding, uneven = shares(two)
                table.append(f"{first}| {way} | {middle['frame'][0]:.0f} / {middle['frame'][1]:.0f} | "
                             f"{ratios(two, one, 'frame')} | {middle['whole'][0] / 1e3:.1f} / {middle['whole'][1] / 1e3:.1f} | {ratios(two, one, 'whole')} | "
                             f"{ratios(two, one, 'cpu')} | {finding:.1f} % | {uneven:.1f} % |")
    print("\n".join(table))
    caption = f"{results_file.made(load)} `{results_file.command('two_processes.py')}`"
    print(caption)
    if args.results:
        results_file.put(args.results, "two_processes.py", f"{caption}: `ripples` of {args.samples}^3 by two processes, compared with one of two threads", table)


if __name__ == "__main__":
    main()
