#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Moloney, Ray Coherence in Parallel Volume Rendering (2008), Figure 6.24: the time of a frame by stages, in six processes.

Three volumes of `tessera generate` of 400^3 samples instead of the thesis's, two transfer functions that hide the same bricks, one of which is opaque, and images
of 1 megapixel: four rotations, about three axes and the diagonal, of seven degrees per frame, and seven zooms, along three axes and four diagonals, from three
radii of the volume to eight tenths of one; up to 7.5 MB of bricks of 32^3 preloaded per frame. Figures are CPU milliseconds per frame and process (of
`render --timing`), because two cores cannot show the wall time of six; *gather* is process 0's, without waiting.
"""
import csv
import json
import math

from results import Section, generated, options, render, run, written

FUNCTIONS = {"high opacity": 60, "low opacity": 1.5}  # extinction of the highest value, per world unit
AXES = ((1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1))
ZOOMS = (*AXES, (-1, 1, 1), (1, -1, 1), (1, 1, -1))
BRICK = 32
AHEAD = int(7.5e6 / (BRICK + 1) ** 3)  # bricks of bytes, including shared samples
STAGES = {"load balancing": ("partition",), "loading": ("read",), "culling": ("cull",), "rendering": ("project",), "gather": ("pack", "assemble")}


def turned(v, axis, angle):
    """Rodrigues' formula."""
    k = [a / math.hypot(*axis) for a in axis]
    cross = [k[1] * v[2] - k[2] * v[1], k[2] * v[0] - k[0] * v[2], k[0] * v[1] - k[1] * v[0]]
    along = sum(a * b for a, b in zip(k, v)) * (1 - math.cos(angle))
    return [a * math.cos(angle) + b * math.sin(angle) + c * along for a, b, c in zip(v, cross, k)]


def path(centre, radius):
    at = lambda away, up: {"position": [c + a for c, a in zip(centre, away)], "focal_point": centre, "view_up": up, "view_angle": 40}
    for axis in AXES:
        for angle in (math.radians(7 * n) for n in range(13)):
            yield at([3 * radius * a for a in turned([0.4, 0.5, 0.77], axis, angle)], turned([0.1, 0.8, -0.6], axis, angle))
    for axis in ZOOMS:
        for distance in (3 * radius * (0.8 / 3) ** (n / 7) for n in range(8)):
            yield at([distance * a / math.hypot(*axis) for a in axis], [0.3, 0.8, -0.5])


def main():
    args = options(__doc__, samples=400)
    trace, table, section = args.work / "trace.json", args.work / "trace.csv", Section(args, "figure 6.24")
    section.table("l" + "r" * 8, "data, function", "visible / all bricks", *(f"{name} [ms]" for name in STAGES), "all", "rendering [%]")
    for name in ("head", "radial", "turbulence"):
        volume = generated(args, f"{name}-{args.samples}.nrrd", name, f"n={args.samples}", "bits=8")
        low, high = json.loads(run(args.tessera, "info", volume, "--json").out)["bounds"]
        views = written(args.work / "path.json", list(path([(a + b) / 2 for a, b in zip(low, high)], math.dist(low, high) / 2)))
        for function, extinction in FUNCTIONS.items():
            knots = written(args.work / "function.txt", f"64 0.8 0.5 0.4 0\n255 1 1 0.9 {extinction / math.dist(low, high) * 3.4}\n")
            counters = render(args, volume, "--camera", views, "--size", "1024x1024", "--threads", "1", "--transfer-function", knots, "--brick-size", BRICK,
                              "--cache", "proximity", "--preload", AHEAD, "--timing", trace, ranks=6, picture="f%d.pfm")["frames"][0]["counters"]
            run(args.tessera, "timing", trace, "--csv", table)
            rows = {row["stage"]: float(row["cpu_ms"] or 0) for row in csv.DictReader(table.read_text().splitlines()) if row["part"] == "frame"}
            cpu = {stage: sum(rows.get(part, 0) for part in parts) for stage, parts in STAGES.items()}
            shown = counters["bricks_total"] - counters["bricks_invisible"]
            section.row(f"{name}, {function}", f"{shown} / {counters['bricks_total']}", *(f"{ms:.1f}" for ms in cpu.values()), f"{sum(cpu.values()):.1f}",
                        f"{100 * cpu['rendering'] / sum(cpu.values()):.0f}")
    section.keep()


if __name__ == "__main__":
    main()
