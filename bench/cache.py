#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Moloney, Ray Coherence in Parallel Volume Rendering (2008): Tables 6.2 and 6.3, Figures 6.21 to 6.23: bricks and their cache.

    table 6.2    brick sizes: samples in visible bricks, samples stored with edge bricks of fixed and of variable size, frames per second
    table 6.3    frames in which a unit waits for more bricks than the threshold: lru, and proximity that preloads the same number
    figure 6.21  frames per second by the speed of a turn and of a zoom
    figure 6.22, 6.23  largest number of bricks that any unit loads in a frame, waited for and ahead; two turns around the x axis at three speeds

Volumes are those of `tessera generate` that have the thesis's fraction of visible bricks, of 128 samples a side in bricks of 8: about as many bricks as in the
thesis, but small ones. Except for Table 6.2, units are threads of one process (cache_frames.cpp, in the build that --programs names) with their own caches and
rectangles, 512 x 512 pixels, and the volume in memory; where stated, loading a brick takes 0.57 ms, the thesis's transfer of 64^3 bytes to texture memory at
458.5 MB/s. Limits of bricks loaded ahead are those of the thesis, scaled by the ratio of visible bricks here to those there. Steps along rays are eight samples
long, which does not affect loads (one where frames are timed), and the first frame, before which nothing is loaded, does not count.
"""
import json
import statistics

from results import PROGRAMS, generated, measure_parts, options, render, run, written

PRINTED_2 = {8: (42.24, 80.15, 79.53, 6.2), 16: (57.85, 79.89, 79.89, 15.4), 32: (82.53, 108.00, 104.07, 10.4),
             64: (102.03, 171.97, 112.20, 7.9), 128: (103.46, 218.10, 136.84, 7.9), 256: (104.04, 134.22, 134.22, 7.1)}
PRINTED_ALL = 104.04  # millions of samples of 510 x 510 x 400
PRINTED_3 = {5: (11.65, 2.25, 10.53, 1.54), 10: (6.52, 0.59, 5.67, 0.37), 15: (4.38, 0.09, 3.33, 0.09), 20: (2.96, 0.06, 2.25, 0.05)}
READ_US = 570


def frames_of(args, runs):
    """The output of cache_frames for each run."""
    words = []
    for one in runs:
        words += ["then"] * bool(words) + [f"{name}={value}" for name, value in one.items()]
    return [json.loads(line) for line in run(args.programs / "cache_frames", *words).out.splitlines()]


def ahead(args, volume, printed, printed_bricks):
    """A limit of bricks loaded ahead from the thesis, in proportion to visible bricks."""
    return round(printed * frames_of(args, [dict(volume=volume, frames=0)])[0]["visible"] / printed_bricks)


def table_2(args, section):
    volume = generated(args, "head-225.nrrd", "head", "n=225", "bits=8")
    function = written(args.work / "function.txt", "64 0.8 0.5 0.4 0\n255 1 1 0.9 2\n")  # as in cache_frames.cpp
    section.table("l" * 10, "brick size, ours / thesis", "samples rendered [%]: ours", "thesis", "stored, fixed [%]: ours", "thesis",
                  "stored, variable [%]: ours", "thesis", "frames/s, by bricks: ours", "thesis", "default")

    def rendered(brick, *words):
        """Samples stored, and frames per second of CPU time: the minimum of three runs."""
        frames = [render(args, volume, "--transfer-function", function, "--size", "512x512", "--integrator", "sampled", "--step", "1", "--projection",
                         "perspective", "--threads", "1", "--brick-size", brick, "--repeat", "2", *words)["frames"][0] for _ in range(3)]
        return frames[0]["counters"]["bytes_resident"], 1e3 / min(frame["balance"]["processes"][0]["cpu_ms"] for frame in frames)

    share = lambda samples, of: f"{100 * samples / of:.1f}"
    every = frames_of(args, [dict(n=225, brick=brick, frames=0, share=2) for brick in PRINTED_2])
    for shown, (brick, (visible, fixed, variable, rate)) in zip(every, PRINTED_2.items()):
        stored = {edge: rendered(brick, "--without", "skipping,termination", "--edge-bricks", edge) for edge in ("fixed", "variable")}
        section.row(f"{brick}^3 / {2 * brick}^3", share(shown["visible_voxels"], 224 ** 3), share(visible, PRINTED_ALL),
                    share(stored["fixed"][0], 225 ** 3), share(fixed, PRINTED_ALL), share(stored["variable"][0], 225 ** 3), share(variable, PRINTED_ALL),
                    f"{stored['variable'][1]:.1f}", rate, f"{rendered(brick)[1]:.1f}")


def table_3(args, section):
    caches = {"lru": dict(cache="lru"), **{t: dict(cache="proximity", preload=t) for t in PRINTED_3}}
    asked = {(units, name): dict(units=units, **words, volume="head", animation="explore", degrees=1, frames=args.frames, share=230 / 320)
             for units in (4, 9) for name, words in caches.items()}
    runs = dict(zip(asked, frames_of(args, asked.values())))
    section.table("r" + "l" * 8, "threshold", *(column for units in (4, 9) for column in (f"{units} units, lru: ours", "thesis", "proximity: ours", "thesis")))
    for threshold, printed in PRINTED_3.items():
        cells = []
        for (units, cache), in_print in zip([(units, cache) for units in (4, 9) for cache in ("lru", threshold)], printed):
            over = [loaded > threshold for frame in runs[units, cache]["frames"][1:] for loaded, _, _ in frame["units"]]
            cells += [f"{100 * statistics.mean(over):.2f}", f"{in_print:.2f}"]
        section.row(threshold, *cells)
    loads = {key: sum(loaded + early for frame in found["frames"][1:] for loaded, early, _ in frame["units"]) for key, found in runs.items()}
    print("bricks loaded by proximity, over those by lru:", ", ".join(f"{loads[key] / loads[key[0], 'lru']:.2f}" for key in loads if key[1] != "lru"))


def figure_21(args, section):
    limit, frames_per_speed = ahead(args, "head", 30, 2265), args.frames // 10
    kinds = [(name, animation, words) for animation in ("turn", "zoom") for name, words in
             ((f"{animation}, proximity{', %d ahead' % limit if animation == 'turn' else ''}: frames/s", dict(cache="proximity", preload=limit)),
              (f"{animation}, lru: frames/s", dict(cache="lru")))]
    section.table("r" + "l" * 8, "degrees per frame", *(column for name, _, _ in kinds for column in (name, "wait [ms]")))
    for degrees in (1, 2, 4, 14):
        cells = []
        for found in frames_of(args, [dict(volume="head", animation=animation, degrees=degrees, units=6, step=1, frames=frames_per_speed, share=211 / 566,
                                           read_us=READ_US, **words) for _, animation, words in kinds]):
            frames = found["frames"][1:]
            waited = statistics.mean(us for frame in frames for _, _, us in frame["units"]) / 1e3
            cells += [f"{1e3 / statistics.mean(frame['ms'] for frame in frames):.1f}", f"{waited:.1f}"]
        section.row(degrees, *cells)


def most_loaded(args, section, volume, share, limit):
    """Rows by cache and speed: quantiles over frames of the most bricks that any unit loads."""
    section.table("rllll", "degrees per frame", "cache", "bricks loaded by the unit with the most: median", "largest", f"frames over {limit} [%]")
    kinds = {"lru": dict(cache="lru"), "proximity": dict(cache="proximity"), f"proximity, {limit} ahead": dict(cache="proximity", preload=limit)}
    for degrees in (2, 7, 14):
        runs = frames_of(args, [dict(volume=volume, animation="turn", degrees=degrees, units=6, frames=min(args.frames, 720 // degrees), share=share,
                                     read_us=READ_US, **words) for words in kinds.values()])
        for name, found in zip(kinds, runs):
            frames = [frame["units"] for frame in found["frames"][1:]]
            most = [max(loaded + early for loaded, early, _ in units) for units in frames]
            over = statistics.mean(max(loaded for loaded, _, _ in units) > limit for units in frames)  # waited for, not loaded ahead
            section.row(degrees, name, f"{statistics.median(most):g}", max(most), f"{100 * over:.1f}")


def figure_22(args, section):
    most_loaded(args, section, "turbulence", 211 / 416, ahead(args, "turbulence", 30, 1662))


def figure_23(args, section):
    most_loaded(args, section, "head", 211 / 696, ahead(args, "head", 60, 5571))


if __name__ == "__main__":
    parts = {"table 6.2": table_2, "table 6.3": table_3, "figure 6.21": figure_21, "figure 6.22": figure_22, "figure 6.23": figure_23}
    measure_parts(options(__doc__, programs=PROGRAMS, only=tuple(parts), frames=150), parts)
