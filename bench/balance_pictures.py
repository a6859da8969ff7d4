#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Moloney, Ray Coherence in Parallel Volume Rendering (2008), Figures 1.1, 1.2, 4.1 and 4.4: which process renders what, and its estimated cost.

    bench/balance_pictures.py --tessera PROGRAM [--images docs/images]

    Figure 1.1  figure-1-1-1.png, -2.png: the parts of four processes of sort-last, and the bricks in their colours, from outside and from inside;
                prints the CPU time of each
    Figure 1.2  figure-1-2-1.png, -2.png: the rectangles of four processes, and the bricks in their colours, in two views
    Figure 4.1  figure-4-1-METHOD.png: the cost map of one brick
    Figure 4.4  figure-4-4-METHOD.png: those of `head` for eight processes; figure-4-4.png the image, figure-4-4-bricks.png with bricks

Needs mpirun and Python's standard library.
"""
import argparse
import json
import pathlib
import tempfile

from balance import run

METHODS = ("accurate", "backface", "splatting")
VIEWS = [{"position": [2.6, -3.6, 1.6], "focal_point": [0, 0, 0], "view_up": [0, 0, 1], "view_angle": 38},
         {"position": [-0.9, 1.3, 0.9], "focal_point": [0.3, -0.2, 0.1], "view_up": [0, 0, 1], "view_angle": 60}]
INTO = [VIEWS[0], {"position": [-0.1, -0.6, 0.6], "focal_point": [-0.35, 0.4, 0.1], "view_up": [0, 0, 1], "view_angle": 30}]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tessera", type=pathlib.Path, required=True)
    parser.add_argument("--images", type=pathlib.Path, default=pathlib.Path("docs/images"))
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        head, brick, function, everything = folder / "head.nrrd", folder / "brick.nrrd", folder / "function.txt", folder / "everything.txt"
        run([args.tessera, "generate", "head", head, "n=128", "bits=8", "--quiet"])
        run([args.tessera, "generate", "radial", brick, "n=33", "bits=8", "--quiet"])
        function.write_text("64 0.8 0.5 0.4 0\n255 1 1 0.9 12\n")
        everything.write_text("0 1 1 1 1\n255 1 1 1 1\n")

        def render(processes, volume, colours, output, *words):
            """Creates output.png; with --show balance also output.cost.png."""
            run(["mpirun", "--oversubscribe", "-n", processes, args.tessera, "render", volume, "-o", output, "--transfer-function", colours, "--size",
                 "220x220", "--threads", "1", "--background", "black", "--quiet", *words])

        def keep(made, kept):
            (args.images / kept).write_bytes((folder / made).read_bytes())

        views = folder / "views.json"
        views.write_text(json.dumps(VIEWS))
        render(4, head, function, folder / "a%d.png", "--camera", views, "--brick-size", "16", "--show", "balance")
        for n in range(2):
            keep(f"a{n}.png", f"figure-1-2-{n + 1}.png")
        views.write_text(json.dumps(INTO))
        render(4, head, function, folder / "b%d.png", "--camera", views, "--brick-size", "16", "--show", "balance", "--distribution", "sort-last",
               "--report", folder / "b.json")
        for n, frame in enumerate(json.loads((folder / "b.json").read_text())["frames"]):
            keep(f"b{n}.png", f"figure-1-1-{n + 1}.png")
            print(f"figure 1.1, view {n + 1}: CPU ms " + ", ".join(f"{p['cpu_ms']:.1f}" for p in frame["balance"]["processes"]))
        for method in METHODS:
            words = ["--show", "balance", "--balance", method, "--balance-resolution", "1"]
            render(1, brick, everything, folder / "one.png", "--brick-size", "32", *words)
            keep("one.cost.png", f"figure-4-1-{method}.png")
            render(8, head, function, folder / "head.png", "--brick-size", "8", *words)
            keep("head.cost.png", f"figure-4-4-{method}.png")
        keep("head.png", "figure-4-4-bricks.png")
        render(1, head, function, folder / "plain.png")
        keep("plain.png", "figure-4-4.png")


if __name__ == "__main__":
    main()
