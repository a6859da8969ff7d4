#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Times the same frames with two programs alternately, and compares time, CPU time and memory.

    bench/same_speed.py --old PROGRAM --new PROGRAM [--rounds 5] [--repeat 5] [--only TEXT] [--work FOLDER] [--json FILE]

For changes that must not cost performance: the frames of bench/targets.py and bench/volumes.py made of generated
data, view and transfer function of all performance figures, 1024 x 1024, two threads. A round renders each row by both programs, the
old one first in every second round; times are of single frames in memory (`frame_ms`), without reading and writing. A row has the ratio of the
lower quartiles of all rounds' frames, new over old, the same for the processes' CPU time, and for their largest resident memory.
Last, the size of the programs. Needs Python's standard library, and mpirun for the rows of ranks.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
VIEW = ["--camera", HERE / "camera.txt", "--transfer-function", HERE / "transfer_function.txt"]
EXACT = ["--integrator", "exact"]
CUBE32, CUBE64, CUBE128 = (["cube.tets", "cube", f"n={n}"] for n in (32, 64, 128))
GRADED = ["graded.tets", "graded", "n=138"]
RIPPLES, BYTES = ["ripples.nrrd", "ripples", "n=256"], ["bytes.nrrd", "ripples", "n=256", "bits=8"]
# Name, data, arguments, ranks.
ROWS = [
    ("cube 32, exact", CUBE32, VIEW + EXACT, 1),
    ("cube 32, in double precision", CUBE32, VIEW + EXACT + ["--without", "lattice", "--size", "512x512"], 1),
    ("cube 64, exact", CUBE64, VIEW + EXACT, 1),
    ("cube 64, auto", CUBE64, VIEW, 1),
    ("cube 64, exact, one thread", CUBE64, VIEW + EXACT + ["--threads", "1"], 1),
    ("cube 64, exact, two ranks of one thread", CUBE64, VIEW + EXACT + ["--threads", "1"], 2),
    ("cube 64, segments, two ranks", CUBE64, VIEW + EXACT + ["--threads", "1", "--exchange", "segments"], 2),
    ("cube 128, 12.6 M tets, exact", CUBE128, VIEW + EXACT, 1),
    ("graded, 15.8 M tets, exact", GRADED, VIEW + EXACT, 1),
    ("ripples 256, float, auto", RIPPLES, VIEW, 1),
    ("ripples 256, float, exact", RIPPLES, VIEW + EXACT, 1),
    ("ripples 256, float, shaded", RIPPLES, VIEW + ["--shade"], 1),
    ("ripples 256, float, preintegrated", RIPPLES, VIEW + ["--integrator", "preintegrated"], 1),
    ("ripples 256, 8 bits, auto", BYTES, VIEW, 1),
    ("ripples 256, float, auto, two ranks", RIPPLES, VIEW + ["--threads", "1"], 2),
]


def run(command):
    """(seconds of CPU, KiB of memory) of a command; for mpirun, including the ranks for which it waited."""
    process = subprocess.Popen([str(c) for c in command], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, env=os.environ | MPI)
    message = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{pathlib.Path(sys.argv[0]).name}: {' '.join(str(c) for c in command)}\n{message.decode().strip()}")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss


class Row:
    def __init__(self, name, file, arguments, ranks):
        self.name, self.file, self.arguments, self.ranks = name, file, arguments, ranks
        self.frames, self.cpu, self.memory = {}, {}, {}

    def measure(self, which, program, repeat, report):
        launch = ["mpirun", "--oversubscribe", "-n", self.ranks] if self.ranks > 1 else []
        size = [] if "--size" in self.arguments else ["--size", "1024x1024"]
        threads = [] if "--threads" in self.arguments else ["--threads", "2"]
        cpu, memory = run(launch + [program, "render", self.file, "-o", report.with_suffix(".pfm"), "--repeat", repeat, "--report", report,
                                    "--quiet", *size, *threads, *self.arguments])
        self.frames.setdefault(which, []).extend(json.loads(report.read_text())["frames"][0]["frame_ms"])
        self.cpu.setdefault(which, []).append(cpu)
        self.memory.setdefault(which, []).append(memory)

    def result(self):
        def quartile(values):
            return sorted(values)[len(values) // 4]

        frames = {which: quartile(f) for which, f in self.frames.items()}
        return {"row": self.name, "old_ms": frames["old"], "new_ms": frames["new"], "time": frames["new"] / frames["old"],
                "cpu": quartile(self.cpu["new"]) / quartile(self.cpu["old"]),
                "memory": statistics.median(self.memory["new"]) / statistics.median(self.memory["old"])}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--old", type=pathlib.Path, required=True)
    parser.add_argument("--new", type=pathlib.Path, required=True)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--only", default="")
    parser.add_argument("--work", type=pathlib.Path)
    parser.add_argument("--json", type=pathlib.Path)
    args = parser.parse_args()
    programs = {"old": args.old.resolve(), "new": args.new.resolve()}
    with tempfile.TemporaryDirectory() as folder:
        work = args.work or pathlib.Path(folder)
        work.mkdir(parents=True, exist_ok=True)
        rows = []
        for name, (file, kind, *parameters), arguments, ranks in ROWS:
            if args.only not in name:
                continue
            stem, suffix = file.split(".")
            data = work / f"{stem}-{'-'.join(parameters)}.{suffix}"
            if not data.exists():
                run([programs["new"], "generate", kind, data, *parameters, "--quiet"])
            rows.append(Row(name, data, arguments, ranks))
        for number in range(args.rounds):
            for row in rows:
                for which in ("old", "new") if number % 2 == 0 else ("new", "old"):
                    row.measure(which, programs[which], args.repeat, work / "report.json")
    results = [row.result() for row in rows]
    print("| row | old, ms | new, ms | time | CPU | memory |\n|---|---:|---:|---:|---:|---:|")
    for r in results:
        print(f"| {r['row']} | {r['old_ms']:.1f} | {r['new_ms']:.1f} | {r['time']:.3f} | {r['cpu']:.3f} | {r['memory']:.3f} |")
    sizes = {which: program.stat().st_size for which, program in programs.items()}
    print(f"programs: {sizes['old']:,} and {sizes['new']:,} bytes, {sizes['new'] / sizes['old']:.3f}")
    if args.json:
        args.json.write_text(json.dumps(results, indent=2))


if __name__ == "__main__":
    main()
