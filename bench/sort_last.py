#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Moloney, Ray Coherence in Parallel Volume Rendering (2008), Figures 1.1, 6.6, 6.7 and 6.15: rays in one process, or in pieces.

    bench/sort_last.py --tessera PROGRAM [--document docs/RESULTS.md] [--only "figure 6.15"] [--size 512x512] [--samples 192] [--frames 5]

    Figure 6.15  sort-first and sort-last by number of processes, with and without early termination; bricks of 32^3, nothing culled, rotation about y,
                 sort-first split by the previous frame as printed, and by our default
    Figure 1.1   CPU time of the slowest process, relative to the mean, while a view moves into the volume
    Figure 6.6   direct send, asynchronous and synchronous, by number of processes
    Figure 6.7   asynchronous direct send of six processes by the image's size

Volumes are ripples (`tessera generate ripples`), opaque for Figure 6.15. Where the thesis has frames per second, 6.15 has 1 s divided by the CPU time of the
slowest process, because two cores cannot show the wall time of six: messages are not included. Figures 6.6 and 6.7 have the data sent by a process, and the
time from a process's last ray to its last composited pixel (of the slowest, which also waits for the others' rays), compared with the time of the bytes alone at
95 MB/s, the thesis's bandwidth. Medians over frames except the first.

Needs mpirun and Python's standard library.
"""
import argparse
import json
import math
import os
import pathlib
import statistics
import tempfile

import results_file
from balance import run

UNITS = (1, 2, 3, 4, 5, 6)
BANDWIDTH = 95e6  # bytes per second


class Bench:
    def __init__(self, args, folder):
        self.args, self.folder = args, folder
        self.volume = folder / "ripples.nrrd"
        run([args.tessera, "generate", "ripples", self.volume, f"n={args.samples}", "bits=8", "--quiet"])
        self.opaque, self.thin = folder / "opaque.txt", folder / "thin.txt"
        self.opaque.write_text("0 0.1 0.2 0.8 2\n128 0.9 0.8 0.3 20\n255 1 0.3 0.1 60\n")
        self.thin.write_text("0 0.1 0.2 0.8 0.1\n128 0.9 0.8 0.3 0.4\n255 1 0.3 0.1 1\n")

    def frames(self, units, size, function, path, *words):
        """The report's data of all frames except the first."""
        (self.folder / "path.json").write_text(json.dumps(path))
        report = self.folder / "report.json"
        run(["mpirun", "--oversubscribe", "-n", units, self.args.tessera, "render", self.volume, "-o", self.folder / "f%d.pfm", "--camera",
             self.folder / "path.json", "--size", size, "--threads", "1", "--transfer-function", function, "--brick-size", "32", "--quiet",
             "--report", report, *words])
        return json.loads(report.read_text())["frames"][1:]


def rotation(frames, distance=6.5, angle=30):
    """About the y axis; ripples are in [-1, 1]^3."""
    for n in range(frames):
        a = 2 * math.pi * n / frames + 0.3
        yield {"position": [distance * math.cos(a), 0.4, distance * math.sin(a)], "focal_point": [0, 0, 0], "view_up": [0, 1, 0], "view_angle": angle}


def slowest(frames):
    """CPU milliseconds of the slowest process, median over frames."""
    return statistics.median(max(p["cpu_ms"] + p["split_cpu_ms"] for p in frame["balance"]["processes"]) for frame in frames)


def figure_15(bench):
    ways = {"sort-first, previous": ["--balance", "previous"], "sort-first, learned": [], "sort-last": ["--distribution", "sort-last"]}
    lines = ["| processes | " + " | ".join(f"{way}: with / without ERT [frames/s] | gain kept [%]" for way in ways) + " |", "|---:|" + "---:|---:|" * len(ways)]
    alone = {}
    for units in UNITS:
        cells = []
        for way, words in ways.items():
            rate = {}
            for without in ("culling,skipping", "culling,skipping,termination"):
                frames = bench.frames(units, bench.args.size, bench.opaque, list(rotation(bench.args.frames)), "--without", without, *words)
                rate[without] = 1e3 / slowest(frames)
            fast, slow = rate.values()
            alone.setdefault(way, fast / slow - 1)
            cells.append(f"{fast:.2f} / {slow:.2f} | {100 * (fast / slow - 1) / alone[way]:.0f}")
        lines.append(f"| {units} | " + " | ".join(cells) + " |")
        print(lines[-1], flush=True)
    gain = next(iter(alone.values()))
    lines += ["", f"Early termination makes one process {1 + gain:.1f} times as fast; *gain kept* is what is left of that gain."]
    return lines


def figure_1(bench):
    lines = ["| distance, half diagonals | sort-first: largest over mean | deviation [%] | sort-last: largest over mean | deviation [%] |", "|---:|---:|---:|---:|---:|"]
    for distance in (4, 2, 1, 0.5, 0.25):
        place = [d * distance * math.sqrt(3) / math.sqrt(0.6 ** 2 + 0.35 ** 2 + 0.72 ** 2) for d in (0.6, 0.35, 0.72)]
        path = [{"position": place, "focal_point": [p * 0.5 for p in place], "view_up": [0, 1, 0], "view_angle": 40}] * 3
        cells = []
        for words in ([], ["--distribution", "sort-last"]):
            frames = bench.frames(6, bench.args.size, bench.thin, path, *words)
            of = [[p["cpu_ms"] + p["split_cpu_ms"] for p in frame["balance"]["processes"]] for frame in frames]
            cells += [f"{statistics.median(max(cpu) / statistics.mean(cpu) for cpu in of):.2f}",
                      f"{100 * statistics.median(frame['balance']['cpu_deviation'] for frame in frames):.0f}"]
        lines.append(f"| {distance} | " + " | ".join(cells) + " |")
        print(lines[-1], flush=True)
    return lines


def sent(frames):
    """Bytes and messages per process and frame, and the slowest process's milliseconds of compositing."""
    middle = lambda name: statistics.median(frame["counters"][name] for frame in frames)
    return middle("exchange_bytes"), middle("exchange_messages"), middle("composite_us") / 1e3


def figure_6(bench):
    lines = ["| processes | MB a process sends | of 20 bytes a pixel [%] | messages | ms at 95 MB/s | asynchronous, ms | synchronous, ms |", "|---:|---:|---:|---:|---:|---:|---:|"]
    for units in UNITS[1:]:
        asynchronous, synchronous = (sent(bench.frames(units, "1024x1024", bench.thin, list(rotation(bench.args.frames)), "--distribution", "sort-last",
                                                       "--direct-send", how)) for how in ("asynchronous", "synchronous"))
        each = asynchronous[0] / units
        lines.append(f"| {units} | {each / 1e6:.2f} | {100 * each / (20 * 1024 ** 2 * (units - 1) / units):.0f} | {asynchronous[1] / units:.0f} | "
                     f"{1e3 * each / BANDWIDTH:.0f} | {asynchronous[2]:.0f} | {synchronous[2]:.0f} |")
        print(lines[-1], flush=True)
    return lines


def figure_7(bench):
    lines = ["| pixels | MB a process sends | ms at 95 MB/s | asynchronous, ms |", "|---|---:|---:|---:|"]
    for side in (256, 512, 768, 1024, 1448):
        each, _, ms = sent(bench.frames(6, f"{side}x{side}", bench.thin, list(rotation(bench.args.frames)), "--distribution", "sort-last"))
        lines.append(f"| {side}x{side} | {each / 6e6:.2f} | {1e3 * each / 6 / BANDWIDTH:.0f} | {ms:.0f} |")
        print(lines[-1], flush=True)
    return lines


FIGURES = {"figure 6.15": figure_15, "figure 1.1": figure_1, "figure 6.6": figure_6, "figure 6.7": figure_7}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tessera", type=pathlib.Path, required=True)
    parser.add_argument("--document", type=pathlib.Path)
    parser.add_argument("--only", choices=FIGURES)
    parser.add_argument("--size", default="512x512")
    parser.add_argument("--samples", type=int, default=192)
    parser.add_argument("--frames", type=int, default=5)
    args = parser.parse_args()
    for name, figure in FIGURES.items():
        if args.only not in (None, name):
            continue
        load = os.getloadavg()[0]
        with tempfile.TemporaryDirectory() as folder:
            lines = figure(Bench(args, pathlib.Path(folder)))
        if args.document:
            results_file.put(args.document, f"sort_last.py {name}", f"{results_file.made(load)} `{results_file.command('sort_last.py')}`", lines)


if __name__ == "__main__":
    main()
