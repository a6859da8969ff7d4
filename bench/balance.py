#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Moloney, Ray Coherence in Parallel Volume Rendering (2008), Tables 6.4 and 6.5, Figures 6.8 to 6.10: how evenly an image is divided among processes.

Two smooth recorded animations of a ripple of 256^3: a turn of two degrees per frame around an oblique axis, which shows all of the volume, and a zoom from outside
to the middle. A frame's *deviation* is defined as in the thesis: the difference between the longest and the shortest time of a process, divided by their mean.
Where the thesis uses time, this uses a process's CPU time, for finding the split and rendering together: with fewer cores than processes, wall time does not
measure the work of each. Tables have the mean over frames except a run's first, in which nothing is known yet, and the standard deviation.

    table 6.4    --balance learned, accurate, splatting, backface; cost maps with as many pixels as the image, and with a quarter
    table 6.5    the cost map (backface, a quarter; ours: learned) compared with the previous frame, with 0, 2 and 4 frames of the turn left out
    figure 6.8   CPU time of the cost map, by number of bricks, for 128 x 128 map pixels, on one process
    figure 6.9   the same for 729 bricks, by map pixels
    figure 6.10  for 10,648 bricks and 1024 x 1024 map pixels, by number of processes: of the slowest process, including the search for the split
"""
import math
import statistics

from results import generated, measure_parts, options, render, written

METHODS = ("learned", "accurate", "splatting", "backface")
RESOLUTIONS = {"full": 1, "a quarter": 0.5}
PRINTED_4 = {("rotation", "full"): (13.7, 10.8, 17.3), ("rotation", "a quarter"): (14.0, 10.9, 17.4), ("zoom", "full"): (10.3, 9.1, 14.7)}
PRINTED_5 = {0: ("17.0 ± 12.7", "22.8 ± 23.3"), 2: ("17.6 ± 13.0", "46.9 ± 34.0"), 4: ("18.2 ± 13.6", "60.6 ± 34.2")}
RADIUS = math.sqrt(3)  # of the ripples' cube, [-1, 1]^3


def views(kind, frames):
    for n in range(frames):
        a = math.radians(2 * n)
        away, distance, angle = ([math.cos(a), 0.45 * math.sin(2 * a) + 0.3, math.sin(a)], 3 * RADIUS, 45) if kind == "rotation" else (
            [0.55, 0.35, 0.75], RADIUS * (4 - 3.2 * n / frames), 40)
        yield {"position": [d / math.hypot(*away) * distance for d in away], "focal_point": [0, 0, 0], "view_up": [0, 1, 0], "view_angle": angle}


def balances(args, path, method, resolution, size, brick, *words, ranks=6):
    """The reports' balance data of all frames except the first."""
    report = render(args, generated(args, "ripples.nrrd", "ripples", "n=256", "bits=8"), "--camera", written(args.work / "path.json", path), "--size", size,
                    "--threads", "1", "--transfer-function", "cool-warm:rise", "--brick-size", brick, "--balance", method, "--balance-resolution", resolution,
                    *words, ranks=ranks, picture="f%d.pfm")
    return [frame["balance"] for frame in report["frames"][1:]]


def animated(args, kind, method, resolution, left_out=0):
    path = list(views(kind, args.frames))[::left_out + 1]
    return [frame for _ in range(args.runs) for frame in balances(args, path, method, resolution, args.size, 64)]


def deviation(frames):
    of = [100 * frame["cpu_deviation"] for frame in frames]
    return f"{statistics.mean(of):.1f} ± {statistics.stdev(of):.1f}"


def split_share(frames):
    """CPU time of finding the split relative to that of rendering, over all processes [%]."""
    split, render_ms = (sum(p[part] for f in frames for p in f["processes"]) for part in ("split_cpu_ms", "cpu_ms"))
    return f"{100 * split / render_ms:.1f}"


def table_4(args, section):
    section.table("l" * 8, "animation, cost map", "learned", "accurate: ours", "thesis", "splatting: ours", "thesis", "back face: ours", "thesis")
    shares = {}
    for kind in ("rotation", "zoom"):
        for name, resolution in RESOLUTIONS.items():
            measured = {method: animated(args, kind, method, resolution) for method in METHODS}
            for method, frames in measured.items():
                shares.setdefault((name, method), []).append(split_share(frames))
            printed = PRINTED_4.get((kind, name)) or ["+0.5 at most"] * 3
            learned, *here = (deviation(frames) for frames in measured.values())
            section.row(f"{kind}, {name}", learned, *(cell for pair in zip(here, printed) for cell in pair))
    section.text("CPU time of finding the split, relative to that of rendering, for rotation / zoom [%]:")
    section.table("l" * 5, "cost map", *METHODS)
    for name in RESOLUTIONS:
        section.row(name, *(" / ".join(shares[name, method]) for method in METHODS))
    return "deviation of CPU time [%], mean ± standard deviation over frames"


def table_5(args, section):
    section.table("rlllll", "frames left out", "back face, a quarter: ours", "thesis", "learned", "previous frame: ours", "thesis")
    for left_out, (cost, before) in PRINTED_5.items():
        here = [deviation(animated(args, "rotation", method, 0.5, left_out)) for method in ("backface", "learned", "previous")]
        section.row(left_out, here[0], cost, here[1], here[2], before)


MAPS = ("accurate", "backface", "splatting")
BRICKS = {128: 8, 64: 64, 32: 512, 16: 4096, 12: 10648, 8: 32768}  # of 255 voxels along each axis, by their size


def by_method(args, section, heading, rows):
    """A line for each row (name, processes, brick size, map side, map pixels a pixel): CPU ms of finding the split in the slowest process, median over frames."""
    section.table("rrrr", heading, *(f"{method}, ms" for method in MAPS))
    for name, processes, brick, side, resolution in rows:
        # A single process has nothing to split, but reports the data for a split.
        words = ["--show", "balance"] if processes == 1 else []
        size = round(side / resolution)
        frames = [balances(args, list(views("rotation", 7)), method, resolution, f"{size}x{size}", brick, *words, ranks=processes) for method in MAPS]
        section.row(name, *(f"{statistics.median(max(p['split_cpu_ms'] for p in frame['processes']) for frame in of):.1f}" for of in frames))


def figure_8(args, section):
    by_method(args, section, "bricks", [(count, 1, brick, 128, 0.5) for brick, count in BRICKS.items()])


def figure_9(args, section):
    by_method(args, section, "map pixels", [(f"{side}x{side}", 1, 29, side, 1) for side in (64, 128, 256, 512, 1024)])


def figure_10(args, section):
    by_method(args, section, "processes", [(n, n, 12, 1024, 1) for n in (1, 2, 3, 4, 5, 6)])


if __name__ == "__main__":
    parts = {"table 6.4": table_4, "table 6.5": table_5, "figure 6.8": figure_8, "figure 6.9": figure_9, "figure 6.10": figure_10}
    measure_parts(options(__doc__, only=tuple(parts), size="1024x1024", frames=60, runs=1), parts)
