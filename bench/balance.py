#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Moloney, Ray Coherence in Parallel Volume Rendering (2008), Tables 6.4 and 6.5, Figures 6.8 to 6.10: how evenly an image is divided among processes.

    bench/balance.py --tessera PROGRAM [--document docs/RESULTS.md] [--only "table 6.4"] [--processes 6] [--size 1024x1024] [--brick-size 64] [--volume FILE]
                     [--transfer-function NAME] [--frames 60] [--runs 1]

Two smooth recorded animations: a turn of two degrees per frame around an oblique axis, which shows all of the volume, and a zoom from
outside to the middle. A frame's *deviation* is defined as in the thesis: the difference between the longest and the shortest time of a process,
divided by their mean. Where the thesis uses time, this uses a process's CPU time, for finding the split and rendering together: with fewer cores
than processes, wall time does not measure the work of each. Tables have the mean over frames except a run's first, in which nothing is known yet,
and the standard deviation.

    Table 6.4  --balance learned, accurate, splatting, backface; cost maps with as many pixels as the image, and with a quarter
    Table 6.5  the cost map (backface, a quarter; ours: learned) compared with the previous frame, with 0, 2 and 4 frames of the turn left out
    Figure 6.8   CPU time of the cost map, by number of bricks, for 128 x 128 map pixels, on one process
    Figure 6.9   the same for 729 bricks, by map pixels
    Figure 6.10  for 10,648 bricks and 1024 x 1024 map pixels, by number of processes: of the slowest process, including the search for the split

Needs mpirun and Python's standard library.
"""
import argparse
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

import results_file

METHODS = ("learned", "accurate", "splatting", "backface")
RESOLUTIONS = {"full": 1, "a quarter": 0.5}
PRINTED_4 = {("rotation", "full"): (13.7, 10.8, 17.3), ("rotation", "a quarter"): (14.0, 10.9, 17.4), ("zoom", "full"): (10.3, 9.1, 14.7)}
PRINTED_5 = {0: ("17.0 ± 12.7", "22.8 ± 23.3"), 2: ("17.6 ± 13.0", "46.9 ± 34.0"), 4: ("18.2 ± 13.6", "60.6 ± 34.2")}
DEGREES = 2  # per frame of the turn


def run(words):
    env = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, env=env)
    if done.returncode != 0:
        sys.exit(f"{pathlib.Path(sys.argv[0]).name}: {' '.join(map(str, words))}\n{done.stderr.strip()}")


def bounds_of(tessera, volume):
    """Low and high corner, world units."""
    info = subprocess.run([str(tessera), "info", str(volume), "--json"], capture_output=True, text=True, check=True)
    return json.loads(info.stdout)["bounds"]


def views(kind, box, frames):
    low, high = box
    centre = [(a + b) / 2 for a, b in zip(low, high)]
    radius = math.dist(low, high) / 2
    for n in range(frames):
        if kind == "rotation":
            a = math.radians(DEGREES * n)
            away = [math.cos(a), 0.45 * math.sin(2 * a) + 0.3, math.sin(a)]
            distance, angle = 3 * radius, 45
        else:
            away, distance, angle = [0.55, 0.35, 0.75], radius * (4 - 3.2 * n / frames), 40
        length = math.hypot(*away)
        yield {"position": [c + d / length * distance for c, d in zip(centre, away)], "focal_point": centre,
               "view_up": [0, 1, 0], "view_angle": angle}


class Bench:
    def __init__(self, args, folder):
        self.args, self.folder = args, folder
        self.volume = args.volume or folder / "ripples.nrrd"
        if not args.volume:
            run([args.tessera, "generate", "ripples", self.volume, "n=256", "bits=8", "--quiet"])
        self.box = bounds_of(args.tessera, self.volume)

    def frames(self, kind, method, resolution, left_out):
        """The reports' balance data of all frames except each run's first."""
        path = list(views(kind, self.box, self.args.frames))[::left_out + 1]
        (self.folder / "path.json").write_text(json.dumps(path))
        report = self.folder / "report.json"
        frames = []
        for _ in range(self.args.runs):
            run(["mpirun", "--oversubscribe", "-n", self.args.processes, self.args.tessera, "render", self.volume, "-o", self.folder / "f%d.pfm",
                 "--camera", self.folder / "path.json", "--size", self.args.size, "--threads", "1", "--transfer-function", self.args.transfer_function,
                 "--brick-size", self.args.brick_size, "--balance", method, "--balance-resolution", resolution, "--quiet", "--report", report])
            frames += [frame["balance"] for frame in json.loads(report.read_text())["frames"]][1:]
        return frames


def deviation(frames):
    of = [100 * f["cpu_deviation"] for f in frames]
    return f"{statistics.mean(of):.1f} ± {statistics.stdev(of):.1f}"


def split_share(frames):
    """CPU time of finding the split relative to that of rendering, over all processes [%]."""
    split, render = (sum(p[part] for f in frames for p in f["processes"]) for part in ("split_cpu_ms", "cpu_ms"))
    return 100 * split / render


def table_4(bench):
    lines = ["| animation, cost map | learned | accurate: here | printed | splatting: here | printed | back face: here | printed |", "|---|---|---|---|---|---|---|---|"]
    shares = {}
    for kind in ("rotation", "zoom"):
        for name, resolution in RESOLUTIONS.items():
            measured = {method: bench.frames(kind, method, resolution, 0) for method in METHODS}
            for method, frames in measured.items():
                shares.setdefault((method, name), []).append(split_share(frames))
            printed = PRINTED_4.get((kind, name)) or ["+0.5 at most"] * 3
            here = [deviation(measured[method]) for method in METHODS]
            lines.append(f"| {kind}, {name} | {here[0]} | " + " | ".join(f"{h} | {p}" for h, p in zip(here[1:], printed)) + " |")
            print(lines[-1], flush=True)
    lines += ["", "CPU time of finding the split over that of rendering, rotation / zoom [%]:", "", "| cost map | " + " | ".join(METHODS) + " |",
              "|---|" + "---|" * len(METHODS)]
    for name in RESOLUTIONS:
        lines.append(f"| {name} | " + " | ".join(" / ".join(f"{s:.1f}" for s in shares[method, name]) for method in METHODS) + " |")
    return lines


def table_5(bench):
    lines = ["| frames left out | back face, a quarter: here | printed | learned | the frame before: here | printed |", "|---:|---|---|---|---|---|"]
    for left_out, (cost, before) in PRINTED_5.items():
        here = [deviation(bench.frames("rotation", method, 0.5, left_out)) for method in ("backface", "learned", "previous")]
        lines.append(f"| {left_out} | {here[0]} | {cost} | {here[1]} | {here[2]} | {before} |")
        print(lines[-1], flush=True)
    return lines


MAPS = ("accurate", "backface", "splatting")
BRICKS = {128: 8, 64: 64, 32: 512, 16: 4096, 12: 10648, 8: 32768}  # of 255 voxels along each axis, by their size


def map_ms(bench, method, processes, brick, map_side, resolution=1.0):
    """CPU milliseconds of finding the split in the slowest process; median over frames."""
    (bench.folder / "path.json").write_text(json.dumps(list(views("rotation", bench.box, 7))))
    report = bench.folder / "report.json"
    side = round(map_side / resolution)
    # A single process has nothing to split, but reports the data for a split.
    run(["mpirun", "--oversubscribe", "-n", processes, bench.args.tessera, "render", bench.volume, "-o", bench.folder / "f%d.pfm", "--camera",
         bench.folder / "path.json", "--size", f"{side}x{side}", "--threads", "1", "--transfer-function", bench.args.transfer_function, "--brick-size", brick,
         "--balance", method, "--balance-resolution", resolution, *(["--show", "balance"] if processes == 1 else []), "--quiet", "--report", report])
    frames = json.loads(report.read_text())["frames"][1:]
    return statistics.median(max(p["split_cpu_ms"] for p in frame["balance"]["processes"]) for frame in frames)


def by_method(bench, heading, rows):
    """A line for each row: its name, and the time by each method with the arguments that follow it."""
    lines = [f"| {heading} | " + " | ".join(f"{method}, ms" for method in MAPS) + " |", "|---:|" + "---:|" * len(MAPS)]
    for name, *arguments in rows:
        lines.append(f"| {name} | " + " | ".join(f"{map_ms(bench, method, *arguments):.1f}" for method in MAPS) + " |")
        print(lines[-1], flush=True)
    return lines


def figure_8(bench):
    return by_method(bench, "bricks", [(count, 1, brick, 128, 0.5) for brick, count in BRICKS.items()])


def figure_9(bench):
    return by_method(bench, "map pixels", [(f"{side}x{side}", 1, 29, side) for side in (64, 128, 256, 512, 1024)])


def figure_10(bench):
    return by_method(bench, "processes", [(units, units, 12, 1024) for units in range(1, 7)])


TABLES = {"table 6.4": table_4, "table 6.5": table_5, "figure 6.8": figure_8, "figure 6.9": figure_9, "figure 6.10": figure_10}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tessera", type=pathlib.Path, required=True)
    parser.add_argument("--processes", type=int, default=6)
    parser.add_argument("--size", default="1024x1024")
    parser.add_argument("--brick-size", type=int, default=64)
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("--runs", type=int, default=1, help="of each animation, for tables")
    parser.add_argument("--volume", type=pathlib.Path, help="default: ripples of 256^3 samples of 8 bits")
    parser.add_argument("--transfer-function", default="cool-warm:rise")
    parser.add_argument("--document", type=pathlib.Path)
    parser.add_argument("--only", choices=TABLES)
    args = parser.parse_args()
    for name, table in TABLES.items():
        if args.only not in (None, name):
            continue
        load = os.getloadavg()[0]
        with tempfile.TemporaryDirectory() as folder:
            lines = table(Bench(args, pathlib.Path(folder)))
        if args.document:
            says = ": deviation of CPU time [%], mean ± standard deviation over frames" if name.startswith("table") else ""
            caption = f"{results_file.made(load)} `{results_file.command('balance.py')}`{says}"
            results_file.put(args.document, f"balance.py {name}", caption, lines)


if __name__ == "__main__":
    main()
