#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The cost of two processes: films of a volume by two processes of one thread, compared with one process of two threads.

`ripples` of 256^3 floats from a distance of five half sides, 1024 x 1024 pixels, 12 frames: a turn of 2 degrees per frame, whose splits use the times of the
previous frame, and an orbit of 36 degrees per frame, where each view is new; sort-first by `--balance learned`, and sort-last. Each film is rendered by one
process, then by two in both modes, and so on --repeats times. A *frame* is the median over the film's frames except the first, the median of that over
repetitions. Ratios are medians over repetitions of two processes' time to that of the one, with the smallest and largest; *CPU* is the same for the run's
processor time, including mpirun. On two cores shared with other programs, ratios of time depend more on the other load than on the program. Needs mpirun.
"""
import statistics

from results import Section, generated, options, render, rotation, written

FILMS = {"turn": 2, "orbit": 36}  # degrees per frame
WAYS = {"one": (1, []), "sort-first": (2, []), "sort-last": (2, ["--distribution", "sort-last"])}
SAMPLES, FRAMES = 256, 12


def main():
    args = options(__doc__, repeats=5)
    volume, section, made = generated(args, "ripples.nrrd", "ripples", f"n={SAMPLES}"), Section(args), {}
    for _ in range(args.repeats):
        for film, degrees in FILMS.items():
            path = written(args.work / "path.json", list(rotation((0, 0, 0), 5, FRAMES, degrees, height=1, angle=40)))
            for way, (processes, words) in WAYS.items():
                report = render(args, volume, "--camera", path, "--size", "1024x1024", "--transfer-function", "cool-warm:rise", "--threads", 2 // processes,
                                *words, ranks=processes, picture="f%d.pfm")
                frame = statistics.median(ms for frame in report["frames"][1:] for ms in frame["frame_ms"])
                made.setdefault((film, way), []).append((frame, report["run"].cpu))
    section.table("llrll", "film", "distribution", "time of a frame with one / two processes, ms", "ratio (range)", "ratio of CPU time (range)")
    for film, degrees in FILMS.items():
        one = made[film, "one"]
        for way in list(WAYS)[1:]:
            two, cells = made[film, way], []
            for i in range(2):
                ratios = [t[i] / o[i] for t, o in zip(two, one)]
                cells.append(f"{statistics.median(ratios):.2f} ({min(ratios):.2f}-{max(ratios):.2f})")
            both = " / ".join(f"{statistics.median(ms for ms, _ in runs):.0f}" for runs in (one, two))
            section.row(f"{film}, {degrees} degrees a frame", way, both, *cells)
    section.keep(f"`ripples` of {SAMPLES}^3 by two processes of one thread, compared with one process of two threads")


if __name__ == "__main__":
    main()
