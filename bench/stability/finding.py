#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How often `--verify K` finds a broken promise.

    bench/stability/finding.py CLASS... [--tessera build/release/apps/tessera] [--cases 100] [--seed 1] [--first 0]
        [--size 256x256] [--pixels 1000]

Takes the random cases of promises.py, makes their images larger, judges every pixel, and where a promise is broken
checks whether `--verify K` also reports it, compared with the probability for K random pixels. A program that
keeps its promises has nothing to find: use one that does not.
"""
import argparse
import importlib
import json
import math
import pathlib
import random
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def chance(broken, pixels, looked_at):
    """Probability that `looked_at` random pixels of `pixels` include one of the broken ones."""
    missed = 0.0
    for i in range(broken):
        if pixels - looked_at - i <= 0:
            return 1.0
        missed += math.log((pixels - looked_at - i) / (pixels - i))
    return -math.expm1(missed)


def verified(args, made, folder, words, pixels):
    """The report's `verify`, or None."""
    report = folder / "report.json"
    report.unlink(missing_ok=True)
    command = [args.tessera, "render", *made["input"], "--transfer-function", folder / "function.txt", *made.get("args", []),
               *words, "-o", folder / "picture.pfm", "--report", report, "--quiet", "--threads", args.threads,
               "--verify", pixels]
    command += ["--camera", folder / "camera.txt"] if made.get("camera") else ["--size", args.size]
    done = subprocess.run([str(w) for w in command], capture_output=True, text=True, timeout=3600)
    if done.returncode not in (0, 4):
        print(f"status {done.returncode}: {done.stderr.strip()}")
        return None
    return json.loads(report.read_text())["frames"][0]["verify"]


def prepared(made, folder, size):
    knots = "".join(" ".join(repr(float(x)) for x in knot) + "\n" for knot in made["function"])
    (folder / "function.txt").write_text(knots)
    if made.get("camera"):
        width, height = size.split("x")
        lines = re.sub(r"(?m)^\s*size\s.*$", "", made["camera"])
        (folder / "camera.txt").write_text(f"{lines.rstrip()}\nsize {width} {height}\n")


def broken_in(tally):
    return tally["over_bound"] - tally["excused"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("classes", nargs="+", metavar="CLASS")
    parser.add_argument("--tessera", type=pathlib.Path, default=ROOT / "build/release/apps/tessera")
    parser.add_argument("--cases", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--size", default="256x256")
    parser.add_argument("--pixels", type=int, default=1000)
    parser.add_argument("--threads", type=int, default=2)
    args = parser.parse_args()
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
    promises = importlib.import_module("promises")
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for name in args.classes:
            module = importlib.import_module(f"promise_cases.{name}")
            cases = broken_cases = found = 0
            expected = 0.0
            for number in range(args.first, args.first + args.cases):
                made = module.case(random.Random(f"{name}/{args.seed}/{number}"), folder, str(args.tessera))
                prepared(made, folder, args.size)
                for words in made.get("methods", promises.METHODS):
                    cases += 1
                    every = verified(args, made, folder, words, 10 ** 8)
                    if every is None or every["met"] or broken_in(every) == 0:
                        continue
                    some = verified(args, made, folder, words, args.pixels)
                    by = {kind: broken_in(t) for kind, t in some["chosen"].items() if broken_in(t) > 0}
                    if broken_in(some["random"]) > 0:
                        by["random"] = broken_in(some["random"])
                    luck = chance(broken_in(every), every["pixels"], args.pixels)
                    broken_cases, expected = broken_cases + 1, expected + luck
                    found += bool(by)
                    print(f"{name}, seed {args.seed}, case {number}, {' '.join(words)}: {broken_in(every)} of {every['pixels']} "
                          f"pixels broken, {every['max_error_not_excused']:.2g} of {every['bound']:g}: "
                          f"{'found ' + str(by) if by else 'MISSED'}; at random {luck:.3f}", flush=True)
            print(f"{name}: {broken_cases} of {cases} pictures break a promise; --verify {args.pixels} finds {found}, "
                  f"as many pixels at random {expected:.1f}", flush=True)


if __name__ == "__main__":
    main()
