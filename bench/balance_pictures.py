#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Moloney, Ray Coherence in Parallel Volume Rendering (2008), Figures 1.1, 1.2, 4.1 and 4.4: which process renders what, and its estimated cost.

    Figure 1.1  figure-1-1-1.png, -2.png: the parts of four processes of sort-last, and the bricks in their colours, from outside and from inside;
                prints the CPU time of each
    Figure 1.2  figure-1-2-1.png, -2.png: the rectangles of four processes, and the bricks in their colours, in two views
    Figure 4.1  figure-4-1-METHOD.png: the cost map of one brick
    Figure 4.4  figure-4-4-METHOD.png: those of `head` for eight processes; figure-4-4.png the image, figure-4-4-bricks.png with bricks

The images stay in --work; --write copies them to docs/images.
"""
import shutil

from results import ROOT, generated, options, render, written

OUTSIDE, INSIDE, INTO = ({"position": position, "focal_point": focus, "view_up": [0, 0, 1], "view_angle": angle} for position, focus, angle in (
    ([2.6, -3.6, 1.6], [0, 0, 0], 38), ([-0.9, 1.3, 0.9], [0.3, -0.2, 0.1], 60), ([-0.1, -0.6, 0.6], [-0.35, 0.4, 0.1], 30)))


def main():
    args = options(__doc__)
    head, brick = generated(args, "head.nrrd", "head", "n=128", "bits=8"), generated(args, "brick.nrrd", "radial", "n=33", "bits=8")
    function = written(args.work / "function.txt", "64 0.8 0.5 0.4 0\n255 1 1 0.9 12\n")
    everything = written(args.work / "everything.txt", "0 1 1 1 1\n255 1 1 1 1\n")

    def images(processes, volume, colours, output, kept, *words):
        """Makes OUTPUT; with --show balance also that of the cost map, OUTPUT.cost.png. Keeps those of `kept`, by their names there."""
        report = render(args, volume, "--transfer-function", colours, "--size", "220x220", "--threads", "1", "--background", "black", *words, ranks=processes,
                        picture=output)
        for made, name in kept.items():
            (args.work / made).rename(args.work / f"figure-{name}.png")
            if args.write:
                shutil.copy(args.work / f"figure-{name}.png", ROOT / "docs" / "images")
        return report

    for figure, views, words in (("1-2", [OUTSIDE, INSIDE], []), ("1-1", [OUTSIDE, INTO], ["--distribution", "sort-last"])):
        report = images(4, head, function, "view%d.png", {f"view{n}.png": f"{figure}-{n + 1}" for n in range(2)}, "--camera",
                        written(args.work / "views.json", views), "--brick-size", "16", "--show", "balance", *words)
    for n, frame in enumerate(report["frames"]):
        print(f"figure 1.1, view {n + 1}: CPU ms " + ", ".join(f"{p['cpu_ms']:.1f}" for p in frame["balance"]["processes"]))
    for method in ("accurate", "backface", "splatting"):
        words = ["--show", "balance", "--balance", method, "--balance-resolution", "1"]
        images(1, brick, everything, "one.png", {"one.cost.png": f"4-1-{method}"}, "--brick-size", "32", *words)
        images(8, head, function, "head.png", {"head.cost.png": f"4-4-{method}", "head.png": "4-4-bricks"}, "--brick-size", "8", *words)
    images(1, head, function, "head.png", {"head.png": "4-4"})


if __name__ == "__main__":
    main()
