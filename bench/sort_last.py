#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Moloney, Ray Coherence in Parallel Volume Rendering (2008), Figures 1.1, 6.6, 6.7 and 6.15: rays in one process, or in pieces.

    figure 6.15  sort-first and sort-last by number of processes, with and without early termination; bricks of 32^3, nothing culled, rotation about y,
                 sort-first split by the previous frame as in the thesis, and by our default
    figure 1.1   CPU time of the slowest process, relative to the mean, while a view moves into the volume
    figure 6.6   direct send, asynchronous and synchronous, by number of processes
    figure 6.7   asynchronous direct send of six processes by the image's size

Volumes are ripples (`tessera generate ripples`), opaque for Figure 6.15. Where the thesis has frames per second, 6.15 has 1 s divided by the CPU time of the
slowest process, because two cores cannot show the wall time of six: messages are not included. Figures 6.6 and 6.7 have the data sent by a process, and the
time from a process's last ray to its last composited pixel (of the slowest, which also waits for the others' rays), compared with the time of the bytes alone
at 95 MB/s, the thesis's bandwidth. Medians over frames except the first.
"""
import math
import statistics

from results import generated, measure_parts, options, render, rotation, written

BANDWIDTH = 95e6  # bytes per second
OPAQUE, THIN = "0 0.1 0.2 0.8 2\n128 0.9 0.8 0.3 20\n255 1 0.3 0.1 60\n", "0 0.1 0.2 0.8 0.1\n128 0.9 0.8 0.3 0.4\n255 1 0.3 0.1 1\n"
SORT_LAST = ["--distribution", "sort-last"]


def frames_of(args, units, size, function, *words, path=None):
    """The report's data of all frames except the first."""
    volume = generated(args, f"ripples-{args.samples}.nrrd", "ripples", f"n={args.samples}", "bits=8")
    path = path or list(rotation((0, 0, 0), 6.5, args.frames, 360 / args.frames, height=0.4))
    report = render(args, volume, "--camera", written(args.work / "path.json", path), "--size", size, "--threads", "1", "--transfer-function",
                    written(args.work / "function.txt", function), "--brick-size", "32", *words, ranks=units, picture="f%d.pfm")
    return report["frames"][1:]


def cpu_ms(frame):
    """Milliseconds of each process."""
    return [p["cpu_ms"] + p["split_cpu_ms"] for p in frame["balance"]["processes"]]


def figure_15(args, section):
    ways = {"sort-first, previous": ["--balance", "previous"], "sort-first, learned": [], "sort-last": SORT_LAST}
    section.table("r" * 7, "processes", *(column for way in ways for column in (f"{way}: with / without ERT [frames/s]", "gain kept [%]")))
    alone = {}
    for units in (1, 2, 3, 4, 5, 6):
        cells = []
        for way, words in ways.items():
            fast, slow = (1e3 / statistics.median(max(cpu_ms(frame)) for frame in frames_of(args, units, args.size, OPAQUE, "--without", without, *words))
                          for without in ("culling,skipping", "culling,skipping,termination"))
            alone.setdefault(way, fast / slow - 1)
            cells += [f"{fast:.2f} / {slow:.2f}", f"{100 * (fast / slow - 1) / alone[way]:.0f}"]
        section.row(units, *cells)
    section.text(f"Early termination makes one process {1 + next(iter(alone.values())):.1f} times as fast; *gain kept* is the remaining share of that gain.")


def figure_1(args, section):
    section.table("rrr", "distance, in half diagonals", "sort-first: busiest over mean", "sort-last: busiest over mean")
    for distance in (4, 2, 1, 0.5, 0.25):
        place = [d * distance * math.sqrt(3) / math.hypot(0.6, 0.35, 0.72) for d in (0.6, 0.35, 0.72)]
        path = [{"position": place, "focal_point": [p * 0.5 for p in place], "view_up": [0, 1, 0], "view_angle": 40}] * 3
        times = [map(cpu_ms, frames_of(args, 6, args.size, THIN, *words, path=path)) for words in ([], SORT_LAST)]
        section.row(distance, *(f"{statistics.median(max(cpu) / statistics.mean(cpu) for cpu in of):.2f}" for of in times))


def sent(args, units, size, *words):
    """Bytes and messages of a process and frame, and the slowest process's milliseconds of compositing."""
    counters = [frame["counters"] for frame in frames_of(args, units, size, THIN, *SORT_LAST, *words)]
    sent_bytes, messages, us = (statistics.median(c[name] for c in counters) for name in ("exchange_bytes", "exchange_messages", "composite_us"))
    return sent_bytes / units, messages / units, us / 1e3


def figure_6(args, section):
    section.table("r" * 7, "processes", "MB a process sends", "relative to 20 bytes per pixel [%]", "messages", "ms at 95 MB/s", "asynchronous, ms", "synchronous, ms")
    for units in (2, 3, 4, 5, 6):
        (each, messages, ms), (_, _, synchronous_ms) = (sent(args, units, "1024x1024", "--direct-send", how) for how in ("asynchronous", "synchronous"))
        section.row(units, f"{each / 1e6:.2f}", f"{100 * each / (20 * 1024 ** 2 * (units - 1) / units):.0f}", f"{messages:.0f}",
                    f"{1e3 * each / BANDWIDTH:.0f}", f"{ms:.0f}", f"{synchronous_ms:.0f}")


def figure_7(args, section):
    section.table("lrrr", "pixels", "MB a process sends", "ms at 95 MB/s", "asynchronous, ms")
    for side in (256, 512, 768, 1024, 1448):
        each, _, ms = sent(args, 6, f"{side}x{side}")
        section.row(f"{side}x{side}", f"{each / 1e6:.2f}", f"{1e3 * each / BANDWIDTH:.0f}", f"{ms:.0f}")


if __name__ == "__main__":
    parts = {"figure 6.15": figure_15, "figure 1.1": figure_1, "figure 6.6": figure_6, "figure 6.7": figure_7}
    measure_parts(options(__doc__, only=tuple(parts), size="512x512", samples=192, frames=5), parts)
