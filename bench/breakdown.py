#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Moloney, Ray Coherence in Parallel Volume Rendering (2008), Figure 6.24: the time of a frame by stages.

    bench/breakdown.py --tessera PROGRAM [--document docs/RESULTS.md] [--processes 6] [--samples 400] [--frames 13] [--zoom 8]

Three volumes of `tessera generate` instead of the thesis's, two transfer functions that hide the same bricks, one of which is opaque, and images of
1 and 2 megapixels (1024x1024 and 1792x1170): four rotations, about three axes and the diagonal, of seven degrees per frame, and seven zooms, along three
axes and four diagonals, from three radii of the volume to eight tenths of one; up to 7.5 MB of bricks of 32^3 preloaded per frame. Figures are CPU
milliseconds per frame and process (of `render --timing`), because two cores cannot show the wall time of six; *gather* is process 0's, without waiting.

Needs mpirun and Python's standard library.
"""
import argparse
import csv
import json
import math
import os
import pathlib
import tempfile

import results_file
from balance import bounds_of, run

VOLUMES = ("head", "radial", "turbulence")
FUNCTIONS = {"high opacity": 60, "low opacity": 1.5}  # extinction of the highest value, per world unit
SIZES = {"1": "1024x1024", "2": "1792x1170"}
AXES = ((1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1))
ZOOMS = ((1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1), (-1, 1, 1), (1, -1, 1), (1, 1, -1))
BRICK = 32
AHEAD = int(7.5e6 / (BRICK + 1) ** 3)  # bricks of bytes, including shared samples
STAGES = {"load balancing": ("partition",), "loading": ("read",), "culling": ("cull",), "rendering": ("project",), "gather": ("pack", "assemble")}


def turned(v, axis, angle):
    """Rodrigues' formula."""
    length = math.sqrt(sum(a * a for a in axis))
    k = [a / length for a in axis]
    cross = [k[1] * v[2] - k[2] * v[1], k[2] * v[0] - k[0] * v[2], k[0] * v[1] - k[1] * v[0]]
    along = sum(a * b for a, b in zip(k, v)) * (1 - math.cos(angle))
    return [a * math.cos(angle) + b * math.sin(angle) + c * along for a, b, c in zip(v, cross, k)]


def path(centre, radius, frames, zoom):
    for axis in AXES:
        for n in range(frames):
            away = turned([0.4, 0.5, 0.77], axis, math.radians(7 * n))
            yield {"position": [c + 3 * radius * a for c, a in zip(centre, away)], "focal_point": centre,
                   "view_up": turned([0.1, 0.8, -0.6], axis, math.radians(7 * n)), "view_angle": 40}
    for axis in ZOOMS:
        for n in range(zoom):
            distance = 3 * radius * (0.8 / 3) ** (n / max(1, zoom - 1)) / math.sqrt(sum(a * a for a in axis))
            yield {"position": [c + distance * a for c, a in zip(centre, axis)], "focal_point": centre, "view_up": [0.3, 0.8, -0.5],
                   "view_angle": 40}


def breakdown(args, folder, volume, function, size):
    trace, table, report = folder / "trace.json", folder / "trace.csv", folder / "report.json"
    run(["mpirun", "--oversubscribe", "-n", args.processes, args.tessera, "render", volume, "-o", folder / "f%d.pfm", "--camera", folder / "path.json",
         "--size", size, "--threads", "1", "--transfer-function", function, "--brick-size", BRICK, "--cache", "proximity", "--preload", AHEAD,
         "--quiet", "--report", report, "--timing", trace])
    run([args.tessera, "timing", trace, "--csv", table])
    with open(table) as file:
        rows = {row["stage"]: row for row in csv.DictReader(file) if row["part"] == "frame"}
    counters = [frame["counters"] for frame in json.loads(report.read_text())["frames"]]
    cpu = {name: sum(float(rows[stage]["cpu_ms"]) for stage in stages if stage in rows) for name, stages in STAGES.items()}
    return cpu, counters[0]


def table(args, folder):
    lines = ["| data, function, megapixels | visible bricks | " + " | ".join(f"{name} [ms]" for name in STAGES) + " | all | rendering [%] |",
             "|---|---:|" + "---:|" * (len(STAGES) + 2)]
    for name in VOLUMES:
        volume = folder / f"{name}.nrrd"
        run([args.tessera, "generate", name, volume, f"n={args.samples}", "bits=8", "--quiet"])
        low, high = bounds_of(args.tessera, volume)
        (folder / "path.json").write_text(json.dumps(list(path([(a + b) / 2 for a, b in zip(low, high)], math.dist(low, high) / 2, args.frames, args.zoom))))
        for words, extinction in FUNCTIONS.items():
            function = folder / "function.txt"
            function.write_text(f"64 0.8 0.5 0.4 0\n255 1 1 0.9 {extinction / math.dist(low, high) * 3.4}\n")
            for megapixels, size in SIZES.items():
                cpu, counters = breakdown(args, folder, volume, function, size)
                all_ms = sum(cpu.values())
                shown = counters["bricks_total"] - counters["bricks_invisible"]
                lines.append(f"| {name}, {words}, {megapixels} | {shown} of {counters['bricks_total']} | " + " | ".join(f"{ms:.1f}" for ms in cpu.values()) +
                             f" | {all_ms:.1f} | {100 * cpu['rendering'] / all_ms:.0f} |")
                print(lines[-1], flush=True)
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tessera", type=pathlib.Path, required=True)
    parser.add_argument("--document", type=pathlib.Path)
    parser.add_argument("--processes", type=int, default=6)
    parser.add_argument("--samples", type=int, default=400)
    parser.add_argument("--frames", type=int, default=13, help="of each rotation")
    parser.add_argument("--zoom", type=int, default=8, help="frames of each zoom")
    args = parser.parse_args()
    load = os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as folder:
        lines = table(args, pathlib.Path(folder))
    if args.document:
        results_file.put(args.document, "breakdown.py figure 6.24", f"{results_file.made(load)} `{results_file.command('breakdown.py')}`", lines)


if __name__ == "__main__":
    main()
