#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How the error of the caster's methods falls with step or asked accuracy (docs/ACCURACY.md, "Volumes by steps").

    bench/volume_convergence.py --tessera build/release/apps/tessera [--volume FILE] [--size 200x200] [--pixels 2000]

Renders ripples (128^3 samples) with the transfer function of all performance figures and with one of narrow peaks, and
compares random pixels with the double-precision reference (--verify). `order` is log2 of the ratio of two RMS errors.
"""
import argparse
import json
import math
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
SHARP = "0.5 0.1 0.3 0.9 0\n0.51 0.2 0.9 0.3 60\n0.52 0.9 0.8 0.1 0\n0.8 1 0.3 0 0\n1 1 1 1 40\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tessera", default=HERE.parent / "build/release/apps/tessera")
    parser.add_argument("--volume")
    parser.add_argument("--size", default="200x200")
    parser.add_argument("--pixels", default="2000")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "sharp.txt").write_text(SHARP)
        volume = args.volume or folder / "v.nrrd"
        if not args.volume:
            subprocess.run([str(args.tessera), "generate", "ripples", str(volume), "n=128", "--quiet"], check=True)

        def errors(function, words):
            command = [args.tessera, "render", volume, "-o", folder / "a.pfm", "--camera", HERE / "camera.txt",
                       "--transfer-function", function, "--size", args.size, "--verify", args.pixels, "--quiet",
                       "--report", folder / "r.json", *words]
            done = subprocess.run([str(w) for w in command], capture_output=True, text=True)
            if done.returncode not in (0, 4):
                sys.exit(f"volume_convergence.py: {done.stderr.strip()}")
            verify = json.loads((folder / "r.json").read_text())["frames"][0]["verify"]
            return verify["max_error"], verify["rms_error"]

        functions = [("six knots", HERE / "transfer_function.txt"), ("narrow peaks", folder / "sharp.txt")]
        print("| method | " + " | ".join(f"{name}: max | RMS | order" for name, _ in functions) + " |")
        print("|---|" + "---|---|---|" * len(functions))
        rows = [(f"`{method}` every {step:g} voxels", ["--integrator", method, "--step", step], method)
                for method in ("sampled", "preintegrated") for step in (2, 1, 0.5, 0.25, 0.125)]
        rows += [(f"`auto` to {eps}", ["--accuracy", eps], None) for eps in ("1e-2", "1e-3", "1e-4", "1e-5")]
        rows += [("`exact`", ["--integrator", "exact"], None)]
        before = {}
        for title, words, series in rows:
            line = f"| {title} "
            for name, function in functions:
                most, rms = errors(function, words)
                order = ""
                if series and (series, name) in before:
                    order = f"{math.log2(before[series, name] / rms):.1f}"
                before[series, name] = rms
                line += f"| {most:.1e} | {rms:.1e} | {order} "
            print(line + "|", flush=True)


if __name__ == "__main__":
    main()
