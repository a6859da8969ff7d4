#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Moloney, Ray Coherence in Parallel Volume Rendering (2008): Tables 6.2 and 6.3, Figures 6.21 to 6.23: bricks and their cache.

    bench/cache.py --tessera PROGRAM --frames-program build/release/bench/cache_frames [--document docs/RESULTS.md] [--only "table 6.3"]

    Table 6.2    brick sizes: samples in visible bricks, samples stored with edge bricks of fixed and of variable size, frames per second
    Table 6.3    frames in which a unit waits for more bricks than the threshold: lru, and proximity that preloads the same number
    Figure 6.21  frames per second by the speed of a turn and of a zoom
    Figure 6.22, 6.23  largest number of bricks that any unit loads in a frame, waited for and ahead; two turns around the x axis at three speeds

Volumes are those of `tessera generate` that have the printed fraction of visible bricks, of 128 samples a side in bricks of 8: about as many
bricks as printed, but small ones. Except for Table 6.2, units are threads of one process (bench/cache_frames.cpp) with their own caches and
rectangles, 512 x 512 pixels, and the volume in memory; where stated, loading a brick takes them 0.57 ms, the printed transfer of 64^3 bytes to
texture memory at 458.5 MB/s. Limits of bricks loaded ahead are the printed ones, scaled by the ratio of visible bricks here to those printed. Steps
along rays are eight samples long, which does not affect loads (one where frames are timed), and the first frame, before which nothing is
loaded, does not count.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

import results_file

PRINTED_2 = {8: (42.24, 80.15, 79.53, 6.2), 16: (57.85, 79.89, 79.89, 15.4), 32: (82.53, 108.00, 104.07, 10.4),
             64: (102.03, 171.97, 112.20, 7.9), 128: (103.46, 218.10, 136.84, 7.9), 256: (104.04, 134.22, 134.22, 7.1)}
PRINTED_ALL = 104.04  # millions of samples of 510 x 510 x 400
PRINTED_3 = {5: (11.65, 2.25, 10.53, 1.54), 10: (6.52, 0.59, 5.67, 0.37), 15: (4.38, 0.09, 3.33, 0.09), 20: (2.96, 0.06, 2.25, 0.05)}
READ_US = 570
SPEEDS = (0.5, 1, 2, 4, 7, 14)  # degrees per frame


def frames_of(args, runs):
    """The output of cache_frames for each run."""
    words = []
    for run in runs:
        words += ["then"] * bool(words) + [f"{name}={value}" for name, value in run.items()]
    done = subprocess.run([args.frames_program, *words], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"cache.py: {' '.join(words)}\n{done.stderr.strip()}")
    return [json.loads(line) for line in done.stdout.splitlines()]


def visible_bricks(args, volume):
    return frames_of(args, [dict(volume=volume, frames=0)])[0]["visible"]


def table_2(args, folder):
    volume, function, report = folder / "head.nrrd", folder / "function.txt", folder / "report.json"
    subprocess.run([args.tessera, "generate", "head", volume, "n=225", "bits=8", "--quiet"], check=True)
    function.write_text("64 0.8 0.5 0.4 0\n255 1 1 0.9 2\n")  # as in cache_frames.cpp
    lines = ["| brick size, here / printed | samples rendered [%]: here | printed | stored, fixed [%]: here | printed | stored, variable [%]: here | printed | "
             "frames/s, by bricks: here | printed | default |", "|---|---|---|---|---|---|---|---|---|---|"]
    everything = 225 ** 3

    def render(brick, *words):
        """Samples stored, and frames per second of CPU time: the minimum of three runs."""
        cpu = []
        for _ in range(3):
            subprocess.run([args.tessera, "render", volume, "-o", folder / "f.pfm", "--transfer-function", function, "--size", "512x512", "--integrator",
                            "sampled", "--step", "1", "--projection", "perspective", "--threads", "1", "--brick-size", str(brick), "--repeat", "2", "--quiet",
                            "--report", report, *words], check=True, capture_output=True)
            frame = json.loads(report.read_text())["frames"][0]
            cpu.append(frame["balance"]["processes"][0]["cpu_ms"])
        return frame["counters"]["bytes_resident"], 1e3 / min(cpu)

    every = frames_of(args, [dict(n=225, brick=brick, frames=0, share=2) for brick in PRINTED_2])
    for shown, (brick, (rendered, fixed, variable, rate)) in zip(every, PRINTED_2.items()):
        stored = {edge: render(brick, "--without", "skipping,termination", "--edge-bricks", edge) for edge in ("fixed", "variable")}
        default = render(brick)
        share = lambda samples, of: f"{100 * samples / of:.1f}"
        lines.append(f"| {brick}^3 / {2 * brick}^3 | {share(shown['visible_voxels'], 224 ** 3)} | {share(rendered, PRINTED_ALL)} | "
                     f"{share(stored['fixed'][0], everything)} | {share(fixed, PRINTED_ALL)} | {share(stored['variable'][0], everything)} | "
                     f"{share(variable, PRINTED_ALL)} | {stored['variable'][1]:.1f} | {rate} | {default[1]:.1f} |")
        print(lines[-1], flush=True)
    return lines


def spikes(run, threshold):
    """Percentage of frames in which a unit waits for more bricks, over units."""
    over = [loaded > threshold for frame in run["frames"][1:] for loaded, _, _ in frame["units"]]
    return f"{100 * statistics.mean(over):.2f}"


def table_3(args, folder):
    common = dict(volume="head", animation="explore", degrees=1, frames=args.frames, share=230 / 320)
    caches = {"lru": dict(cache="lru"), **{t: dict(cache="proximity", preload=t) for t in PRINTED_3}}
    asked = {(units, name): dict(units=units, **words, **common) for units in (4, 9) for name, words in caches.items()}
    runs = dict(zip(asked, frames_of(args, asked.values())))
    lines = ["| threshold | 4 units, lru: here | printed | proximity: here | printed | 9 units, lru: here | printed | proximity: here | printed |", "|---:|---|---|---|---|---|---|---|---|"]
    for threshold, printed in PRINTED_3.items():
        here = [spikes(runs[units, cache], threshold) for units in (4, 9) for cache in ("lru", threshold)]
        lines.append(f"| {threshold} | " + " | ".join(f"{h} | {p:.2f}" for h, p in zip(here, printed)) + " |")
    loads = lambda run: sum(loaded + ahead for frame in run["frames"][1:] for loaded, ahead, _ in frame["units"])
    lines += ["", "Bricks loaded in all, over those of lru: " + "; ".join(
        f"{units} units, " + ", ".join(f"{t}: {loads(runs[units, t]) / loads(runs[units, 'lru']):.2f}" for t in PRINTED_3) for units in (4, 9)) + "."]
    print("\n".join(lines), flush=True)
    return lines


def rate(run):
    return 1e3 / statistics.mean(frame["ms"] for frame in run["frames"][1:])


def figure_21(args, folder):
    limit = round(30 * visible_bricks(args, "head") / 2265)
    lines = [f"| degrees a frame | turn, proximity, {limit} ahead: frames/s | wait [ms] | turn, lru: frames/s | wait [ms] | zoom, proximity: frames/s | "
             "wait [ms] | zoom, lru: frames/s | wait [ms] |", "|---:|---|---|---|---|---|---|---|---|"]
    for degrees in SPEEDS:
        cells = []
        for run in frames_of(args, [dict(volume="head", animation=animation, degrees=degrees, units=6, step=1, frames=args.frames // 10, share=211 / 566,
                                         read_us=READ_US, **cache)
                                    for animation in ("turn", "zoom") for cache in (dict(cache="proximity", preload=limit), dict(cache="lru"))]):
            waited = statistics.mean(us for frame in run["frames"][1:] for _, _, us in frame["units"]) / 1e3
            cells += [f"{rate(run):.1f}", f"{waited:.1f}"]
        lines.append(f"| {degrees:g} | " + " | ".join(cells) + " |")
        print(lines[-1], flush=True)
    return lines


def most_loaded(args, volume, share, limit):
    """Rows by cache and speed: quantiles over frames of the most bricks that any unit loads."""
    lines = [f"| degrees a frame | cache | bricks loaded, most of a unit: median | largest | frames over {limit} [%] |", "|---:|---|---|---|---|"]
    kinds = {"lru": dict(cache="lru", read_us=READ_US), "proximity": dict(cache="proximity", read_us=READ_US),
             f"proximity, {limit} ahead": dict(cache="proximity", preload=limit, read_us=READ_US)}
    for degrees in (2, 7, 14):
        runs = frames_of(args, [dict(volume=volume, animation="turn", degrees=degrees, units=6, frames=min(args.frames, 720 // degrees), share=share, **words)
                                for words in kinds.values()])
        for name, run in zip(kinds, runs):
            frames = [frame["units"] for frame in run["frames"][1:]]
            most = [max(loaded + ahead for loaded, ahead, _ in units) for units in frames]
            over = statistics.mean(max(loaded for loaded, _, _ in units) > limit for units in frames)  # waited for, not loaded ahead
            cells = [f"{statistics.median(most):g}", str(max(most)), f"{100 * over:.1f}"]
            lines.append(f"| {degrees} | {name} | " + " | ".join(cells) + " |")
            print(lines[-1], flush=True)
    return lines


def figure_22(args, folder):
    return most_loaded(args, "turbulence", 211 / 416, round(30 * visible_bricks(args, "turbulence") / 1662))


def figure_23(args, folder):
    return most_loaded(args, "head", 211 / 696, round(60 * visible_bricks(args, "head") / 5571))


SECTIONS = {"table 6.2": table_2, "table 6.3": table_3, "figure 6.21": figure_21, "figure 6.22": figure_22, "figure 6.23": figure_23}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tessera", type=pathlib.Path, required=True)
    parser.add_argument("--frames-program", type=pathlib.Path, required=True)
    parser.add_argument("--frames", type=int, default=150, help="of an animation, at most")
    parser.add_argument("--document", type=pathlib.Path)
    parser.add_argument("--only", choices=SECTIONS, help="one of them")
    args = parser.parse_args()
    for name, section in SECTIONS.items():
        if args.only not in (None, name):
            continue
        load = os.getloadavg()[0]
        with tempfile.TemporaryDirectory() as folder:
            lines = section(args, pathlib.Path(folder))
        if args.document:
            results_file.put(args.document, f"cache.py {name}", f"{results_file.made(load)} `{results_file.command('cache.py')}`", lines)


if __name__ == "__main__":
    main()
