#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The cost of ranks: the same frames by one process and by several, in pairs, old program and new.

    bench/ranks.py --tessera PROGRAM [--old PROGRAM] [--pairs 10] [--repeat 8] [--work FOLDER] [--results docs/RESULTS.md]

Cube 64 (1.57 million tets), view and transfer function of all performance figures, 1024 x 1024, `exact`. A pair is one process of two threads, then
two ranks of one thread, then 8 projectors and 8 compositors of one thread. *Time* is the median of the pair's frames, each alone
(`--repeat`), in memory. *CPU* is that of a frame: the difference between a run of REPEAT more frames and another run, over all processes
including mpirun, so without starting and reading, divided by that number. The table has medians of the pairs' ratios to the one process, and the smallest and
largest ratio; `--old` adds the same for another program, with alternating pairs. *Serial* is for one process: the parts of a frame in which no thread is in a
stage (`other`), and waiting, as a fraction of the frame's CPU time.

On two cores shared with other programs, ratios of time with a wide range depend more on the other load than on the program. Needs mpirun and Python's
standard library.
"""
import argparse
import csv
import json
import os
import pathlib
import statistics
import tempfile

import results_file
from same_speed import EXACT, VIEW, run

FRAME = VIEW + EXACT + ["--size", "1024x1024"]
ONE, TWO, EIGHT = "one process of two threads", "two ranks of one thread", "8 projectors and 8 compositors"
ARRANGEMENTS = {ONE: (1, ["--threads", "2"]), TWO: (2, ["--threads", "1"]),
                EIGHT: (16, ["--threads", "1", "--projectors", "8", "--compositors", "8"])}
BASE = 2  # frames of the run that is subtracted


def frames(program, mesh, work, arrangement, repeat, *more):
    """(CPU seconds of the run, milliseconds of its frames)."""
    ranks, threads = ARRANGEMENTS[arrangement]
    report = work / "report.json"
    launch = ["mpirun", "--oversubscribe", "-n", ranks] if ranks > 1 else []
    cpu, _ = run(launch + [program, "render", mesh, "-o", work / "picture.pfm", "--repeat", repeat, "--report", report, "--quiet", *FRAME, *threads, *more])
    return cpu, json.loads(report.read_text())["frames"][0]["frame_ms"]


def measure(program, mesh, work, arrangement, repeat):
    """(median time, CPU time) of a frame, milliseconds."""
    short, _ = frames(program, mesh, work, arrangement, BASE)
    long, times = frames(program, mesh, work, arrangement, BASE + repeat)
    return statistics.median(times), 1000 * (long - short) / repeat


def serial(program, mesh, work, repeat):
    """(serial milliseconds of a frame of one process, its CPU milliseconds); all except the last frame, which is written."""
    trace, table = work / "trace.json", work / "stages.csv"
    frames(program, mesh, work, ONE, repeat, "--timing", trace)
    run([program, "timing", trace, "--csv", table])
    with open(table) as lines:
        rows = [row for row in csv.DictReader(lines) if row["part"] == "frame"]
    alone = sum(float(row["average_ms"]) for row in rows if row["stage"] in ("other", "wait"))
    cpu = sum(float(row["cpu_ms"]) for row in rows if row["cpu_ms"] and row["stage"] not in ("whole", "other", "wait", "write"))
    return alone, cpu


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tessera", type=pathlib.Path, required=True)
    parser.add_argument("--old", type=pathlib.Path)
    parser.add_argument("--pairs", type=int, default=10)
    parser.add_argument("--repeat", type=int, default=8)
    parser.add_argument("--work", type=pathlib.Path)
    parser.add_argument("--results", type=pathlib.Path)
    args = parser.parse_args()
    programs = {"new": args.tessera.resolve()} | ({"old": args.old.resolve()} if args.old else {})
    load = os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as folder:
        work = args.work or pathlib.Path(folder)
        work.mkdir(parents=True, exist_ok=True)
        mesh = work / "cube64.tets"
        if not mesh.exists():
            run([programs["new"], "generate", "cube", mesh, "n=64", "--quiet"])
        figures = {which: {arrangement: [] for arrangement in ARRANGEMENTS} for which in programs}
        for _ in range(args.pairs):
            for which, program in programs.items():
                for arrangement in ARRANGEMENTS:
                    figures[which][arrangement].append(measure(program, mesh, work, arrangement, args.repeat))
        alone = {which: serial(program, mesh, work, args.repeat) for which, program in programs.items()}

    def words(values, of):
        return f"{statistics.median(values):.2f} ({min(values):.2f} to {max(values):.2f}); {of:.0f} ms"

    which_column = len(programs) > 1  # else all rows are of one program
    table = ["| program " * which_column + "| arrangement | time over that of one process: median (range); a frame | CPU over that of one process: median "
             "(range); a frame |", "|---" * (3 + which_column) + "|"]
    for which in programs:
        first = f"| {which} " * which_column
        one = figures[which][ONE]
        for arrangement in ARRANGEMENTS:
            mine = figures[which][arrangement]
            time, cpu = ([m[i] / o[i] for m, o in zip(mine, one)] for i in (0, 1))
            middle = [statistics.median(m[i] for m in mine) for i in (0, 1)]
            table.append(f"{first}| {arrangement} | {words(time, middle[0])} | {words(cpu, middle[1])} |")
        ms, of = alone[which]
        table.append(f"{first}| serial in {ONE} | {ms:.1f} ms | {100 * ms / of:.2f} % of {of:.0f} ms |")
    print("\n".join(table))
    if args.results:
        caption = f"{results_file.made(load)} `{results_file.command('ranks.py')}`: what ranks cost with cube 64, pairs in turn"
        results_file.put(args.results, "ranks.py", caption, table)


if __name__ == "__main__":
    main()
