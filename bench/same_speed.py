#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Times the same frames with two programs alternately, and compares time, CPU time and memory.

    bench/same_speed.py --old PROGRAM --new PROGRAM [--rounds 5] [--repeat 5] [--only TEXT] [--work FOLDER] [--json FILE]

For changes that must not cost performance: the frames of bench/targets.py and bench/volumes.py made of generated data, view and transfer function of all
performance figures, 1024 x 1024, two threads. A round renders each row by both programs, the old one first in every second round; times are of single frames
in memory (`frame_ms`), without reading and writing. A row has the ratio of the lower quartiles of all rounds' frames, new over old, the same for the processes'
CPU time, and for their largest resident memory. Last, the size of the programs. An interrupt (Ctrl-C)
ends the measurement; the rows that have been measured are printed. Needs mpirun for the rows of ranks.
"""
import argparse
import json
import pathlib
import statistics
import tempfile

from results import EXACT, VIEW, generated, render

CUBE32, CUBE64, CUBE128 = (("cube", f"n={n}") for n in (32, 64, 128))
GRADED, RIPPLES, BYTES = ("graded", "n=138"), ("ripples", "n=256"), ("ripples", "n=256", "bits=8")
ONE_THREAD = ["--threads", "1"]
# Name, data, arguments, ranks.
ROWS = [
    ("cube 32, exact", CUBE32, EXACT, 1),
    ("cube 32, in double precision", CUBE32, EXACT + ["--without", "lattice", "--size", "512x512"], 1),
    ("cube 64, exact", CUBE64, EXACT, 1),
    ("cube 64, auto", CUBE64, [], 1),
    ("cube 64, exact, one thread", CUBE64, EXACT + ONE_THREAD, 1),
    ("cube 64, exact, two ranks of one thread", CUBE64, EXACT + ONE_THREAD, 2),
    ("cube 64, segments, two ranks", CUBE64, EXACT + ONE_THREAD + ["--exchange", "segments"], 2),
    ("cube 128, 12.6 M tets, exact", CUBE128, EXACT, 1),
    ("graded, 15.8 M tets, exact", GRADED, EXACT, 1),
    ("ripples 256, float, auto", RIPPLES, [], 1),
    ("ripples 256, float, exact", RIPPLES, EXACT, 1),
    ("ripples 256, float, shaded", RIPPLES, ["--shade"], 1),
    ("ripples 256, float, preintegrated", RIPPLES, ["--integrator", "preintegrated"], 1),
    ("ripples 256, 8 bits, auto", BYTES, [], 1),
    ("ripples 256, float, auto, two ranks", RIPPLES, ONE_THREAD, 2),
]


def quartile(values):
    return sorted(values)[len(values) // 4]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--old", type=pathlib.Path, required=True)
    parser.add_argument("--new", type=pathlib.Path, required=True)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--only", default="", help="rows whose names contain it")
    parser.add_argument("--work", type=pathlib.Path)
    parser.add_argument("--json", type=pathlib.Path)
    args = parser.parse_args()
    programs = {"old": args.old.resolve(), "new": args.new.resolve()}
    args.tessera, results = programs["new"], []
    with tempfile.TemporaryDirectory() as folder:
        args.work = args.work or pathlib.Path(folder)
        args.work.mkdir(parents=True, exist_ok=True)
        rows = [row for row in ROWS if args.only in row[0]]
        files = {data: generated(args, "-".join(data) + (".nrrd" if data[0] == "ripples" else ".tets"), *data) for _, data, _, _ in rows}
        measured = [{which: {"ms": [], "cpu": [], "memory": []} for which in programs} for _ in rows]
        try:
            for number in range(args.rounds):
                for (_, data, words, ranks), found in zip(rows, measured):
                    words = ["--size", "1024x1024"] * ("--size" not in words) + ["--threads", "2"] * ("--threads" not in words) + words
                    for which in ("old", "new") if number % 2 == 0 else ("new", "old"):
                        report = render(args, files[data], *VIEW, "--repeat", args.repeat, *words, ranks=ranks, program=programs[which])
                        found[which]["ms"] += report["frames"][0]["frame_ms"]
                        found[which]["cpu"].append(report["run"].cpu)
                        found[which]["memory"].append(report["run"].memory)
        except KeyboardInterrupt:
            rows = [row for row, found in zip(rows, measured) if found["new"]["ms"] and found["old"]["ms"]]  # what has been measured
    print("| row | old, ms | new, ms | time | CPU | memory |\n|---|---:|---:|---:|---:|---:|")
    for (name, *_), found in zip(rows, measured):
        old, new = ({**{key: quartile(found[which][key]) for key in ("ms", "cpu")}, "memory": statistics.median(found[which]["memory"])} for which in programs)
        results.append({"row": name, "old_ms": old["ms"], "new_ms": new["ms"], "time": new["ms"] / old["ms"], "cpu": new["cpu"] / old["cpu"],
                        "memory": new["memory"] / old["memory"]})
        print("| {row} | {old_ms:.1f} | {new_ms:.1f} | {time:.3f} | {cpu:.3f} | {memory:.3f} |".format(**results[-1]))
    sizes = {which: program.stat().st_size for which, program in programs.items()}
    print(f"programs: {sizes['old']:,} and {sizes['new']:,} bytes, {sizes['new'] / sizes['old']:.3f}")
    if args.json:
        args.json.write_text(json.dumps(results, indent=2))


if __name__ == "__main__":
    main()
