#!/usr/bin/env python3
"""How evenly processes share the image of a volume: over a turn and a zoom, with 0, 2 and 4 frames left out between
those that are rendered, for each --balance (Moloney, Ray Coherence in Parallel Volume Rendering, 2008, chapter 4).

    bench/balance.py --tessera build/release/apps/tessera [--processes 6] [--size 512x512] [--volume FILE] [--animations turn,zoom]
        [--transfer-function FILE] [--results bench/RESULTS.md]

Prints (largest - least) / mean of the samples (pieces) that processes counted, worst and mean over frames, and the mean
of the same for CPU time. The first frame, in which nothing is known yet, is named apart. A row a measurement goes to
standard output, a row an animation and method to the results file.
"""
import argparse
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import results_file

ROOT = pathlib.Path(__file__).resolve().parent.parent
METHODS = ("accurate", "backface", "splatting", "previous", "even")
LEFT_OUT = (0, 2, 4)


def run(words):
    env = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, env=env)
    if done.returncode != 0:
        sys.exit(f"balance.py: {' '.join(map(str, words))}\n{done.stderr.strip()}")


def views(kind, box, frames):
    """A turn round an oblique axis, or a way from far outside to the middle of the box."""
    low, high = box
    centre = [(a + b) / 2 for a, b in zip(low, high)]
    radius = math.dist(low, high) / 2
    for n in range(frames):
        t = n / frames
        if kind == "turn":
            a = 2 * math.pi * t
            away = [math.cos(a), 0.45 * math.sin(2 * a) + 0.3, math.sin(a)]
            distance, angle = 3 * radius, 45
        else:
            away, distance, angle = [0.55, 0.35, 0.75], radius * (4 - 3.2 * t), 40
        length = math.hypot(*away)
        yield {"position": [c + d / length * distance for c, d in zip(centre, away)], "focal_point": centre,
               "view_up": [0, 1, 0], "view_angle": angle}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tessera", default=ROOT / "build/release/apps/tessera")
    parser.add_argument("--processes", type=int, default=6)
    parser.add_argument("--size", default="512x512")
    parser.add_argument("--frames", type=int, default=30)
    parser.add_argument("--volume", help="default: ripples of 128^3 samples")
    parser.add_argument("--transfer-function", default="cool-warm:rise")
    parser.add_argument("--methods", default=",".join(METHODS))
    parser.add_argument("--animations", default="turn,zoom")
    parser.add_argument("--results", type=pathlib.Path)
    args = parser.parse_args()
    load_before, figures = os.getloadavg()[0], {}
    print("| animation | balance | left out | first frame | worst after | mean after | CPU time, mean |\n|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        volume = args.volume or folder / "ripples.nrrd"
        if not args.volume:
            run([args.tessera, "generate", "ripples", volume, "n=128", "--quiet"])
        info = json.loads(subprocess.run([str(args.tessera), "info", str(volume), "--json"], capture_output=True,
                                         text=True, check=True).stdout)
        for kind in args.animations.split(","):
            path = list(views(kind, info["bounds"], args.frames))
            for left_out in LEFT_OUT:
                for method in args.methods.split(","):
                    (folder / "path.json").write_text(json.dumps(path[::left_out + 1]))
                    run(["mpirun", "--oversubscribe", "-n", args.processes, args.tessera, "render", volume, "-o",
                         folder / "f%d.pfm", "--camera", folder / "path.json", "--size", args.size, "--threads", "1",
                         "--transfer-function", args.transfer_function, "--balance", method, "--quiet", "--report",
                         folder / "r.json"])
                    frames = [f["balance"] for f in json.loads((folder / "r.json").read_text())["frames"]]
                    samples = [100 * f["samples_deviation"] for f in frames]
                    cpu = [100 * f["cpu_deviation"] for f in frames[1:]]
                    later = samples[1:]
                    row = samples[0], max(later), sum(later) / len(later), sum(cpu) / len(cpu)
                    figures.setdefault((kind, method), []).append(row)
                    print(f"| {kind} | {method} | {left_out} | " + " | ".join(f"{x:.1f} %" for x in row) + " |", flush=True)
    table = ["| animation | balance | first frame | worst after | mean after | CPU time, mean |", "|---" * 6 + "|"]
    for (kind, method), rows in figures.items():
        first, *others = zip(*rows)  # the first frame is the same, however many are left out after it
        table.append(f"| {kind} | {method} | {first[0]:.1f} % | " + " | ".join(" / ".join(f"{x:.1f}" for x in o) + " %" for o in others) + " |")
    print("\n".join(["", *table]))
    if args.results:
        caption = (f"{results_file.made(load_before)} `{results_file.command('balance.py')}`: (largest - least) / mean of the samples that "
                   f"{args.processes} processes counted, with {' / '.join(map(str, LEFT_OUT))} frames left out; the same of their CPU time")
        results_file.put(args.results, "balance.py", caption, table)


if __name__ == "__main__":
    main()
