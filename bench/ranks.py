#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The cost of ranks: the same frames by one process of two threads, by two ranks of one thread, and by 8 projectors and 8 compositors, in turn.

Cube 64 (1.57 million tets), view and transfer function of all performance figures, 1024 x 1024, `exact`. *Time* is the median of the frames of a run, each alone
(--repeat), in memory. *CPU* is that of a frame: the difference between a run of REPEAT more frames and another run, over all processes including mpirun, so
without starting and reading, divided by that number. The table has medians of ratios to the one process over --pairs rounds, and the smallest and largest.
*Serial* is for one process: the parts of a frame in which no thread is in a stage (`other`), and waiting, as a fraction of the frame's CPU time.

On two cores shared with other programs, ratios of time with a wide range depend more on the other load than on the program. Needs mpirun.
"""
import csv
import statistics

from results import EXACT, VIEW, Section, generated, options, render, run

ONE = "one process of two threads"
ARRANGEMENTS = {ONE: (1, ["--threads", "2"]), "two ranks of one thread": (2, ["--threads", "1"]),
                "8 projectors and 8 compositors": (16, ["--threads", "1", "--projectors", "8", "--compositors", "8"])}
BASE = 2  # frames of the run that is subtracted


def main():
    args = options(__doc__, pairs=10, repeat=8)
    mesh = generated(args, "cube64.tets", "cube", "n=64")

    def frames(arrangement, repeat, *more):
        ranks, threads = ARRANGEMENTS[arrangement]
        return render(args, mesh, *VIEW, *EXACT, "--size", "1024x1024", "--repeat", repeat, *threads, *more, ranks=ranks)

    def measured(arrangement):
        """Milliseconds of a frame, and of its CPU time."""
        short, long = frames(arrangement, BASE), frames(arrangement, BASE + args.repeat)
        return statistics.median(long["frames"][0]["frame_ms"]), 1000 * (long["run"].cpu - short["run"].cpu) / args.repeat

    section = Section(args)
    rounds = [{arrangement: measured(arrangement) for arrangement in ARRANGEMENTS} for _ in range(args.pairs)]
    section.table("lll", "arrangement", "time relative to one process: median (range); per frame", "CPU time relative to one process: median (range); per frame")
    for arrangement in ARRANGEMENTS:
        cells = []
        for i in range(2):
            ratios = [one[arrangement][i] / one[ONE][i] for one in rounds]
            middle = statistics.median(one[arrangement][i] for one in rounds)
            cells.append(f"{statistics.median(ratios):.2f} ({min(ratios):.2f}-{max(ratios):.2f}); {middle:.0f} ms")
        section.row(arrangement, *cells)
    trace, table = args.work / "trace.json", args.work / "stages.csv"
    frames(ONE, args.repeat, "--timing", trace)
    run(args.tessera, "timing", trace, "--csv", table)
    rows = [row for row in csv.DictReader(table.read_text().splitlines()) if row["part"] == "frame"]
    serial = sum(float(row["average_ms"]) for row in rows if row["stage"] in ("other", "wait"))
    cpu = sum(float(row["cpu_ms"]) for row in rows if row["cpu_ms"] and row["stage"] not in ("whole", "other", "wait", "write"))
    section.row(f"serial in {ONE}", f"{serial:.1f} ms", f"{100 * serial / cpu:.2f} % of {cpu:.0f} ms")
    section.keep("the cost of ranks with cube 64; the arrangements take turns")


if __name__ == "__main__":
    main()
