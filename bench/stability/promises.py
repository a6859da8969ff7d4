#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Random cases of one class against the promises of `exact` and `auto`, with every pixel judged.

    bench/stability/promises.py CLASS... [--tessera build/release/apps/tessera] [--cases 100] [--seed 1] [--first 0] [--keep FOLDER]

A class is a module of promise_cases/: scenes with a common property that once broke a promise, or any_scenes. Case i of a seed is
always the same. Each is rendered with `--integrator exact`, `--accuracy 1e-4` and `--accuracy 1e-5` (or the class's own
methods), and every pixel is judged against the double-precision reference. A case is broken if a pixel that
is not excused (docs/ACCURACY.md) has a larger error than promised, or if there is no image within five minutes. Excused pixels are
counted over all cases of a class and must stay below 1e-4 of all pixels, unless the class justifies more (EXCUSABLE, a fraction).
Prints each case that breaks (`--first i --cases 1 --keep FOLDER` reproduces it and keeps its files) and a line for each
class; exits with status 1 if any broke. Needs only Python's standard library.
"""
import argparse
import array
import importlib
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
CASES = pathlib.Path(__file__).resolve().parent / "promise_cases"
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
LIMIT = 300  # seconds, for images of a few hundred pixels
METHODS = [["--integrator", "exact"], ["--accuracy", "1e-4"], ["--accuracy", "1e-5"]]


def class_names():
    return sorted(p.stem for p in CASES.glob("*.py") if p.stem != "files" and not p.stem.startswith("_"))


def pixels_of(path):
    """(width, height, flat RGB), row 0 at the top, of a .pfm."""
    head, size, scale, body = path.read_bytes().split(b"\n", 3)
    width, height = map(int, size.split())
    values = array.array("f", body)
    row = 3 * width
    return width, height, [v for y in reversed(range(height)) for v in values[row * y:row * (y + 1)]]


class Case:
    """One case's files in a directory, and how to render it."""

    def __init__(self, tessera, made, folder, threads):
        self.tessera, self.made, self.folder, self.threads = tessera, made, folder, threads
        self.command = []
        function = "".join(" ".join(repr(float(x)) for x in knot) + "\n" for knot in made["function"])
        (folder / "function.txt").write_text(function)
        if made.get("camera"):
            (folder / "camera.txt").write_text(made["camera"])

    def render(self, words, verify=True, name="picture.pfm", ranks=1):
        """(status, the frame's report or None, the program's output, the image's path)."""
        picture, report = self.folder / name, self.folder / "report.json"
        report.unlink(missing_ok=True)
        command = [self.tessera, "render", *map(str, self.made["input"]), "--transfer-function", self.folder / "function.txt"]
        if self.made.get("camera"):
            command += ["--camera", self.folder / "camera.txt"]
        command += [*self.made.get("args", []), *words, "-o", picture, "--report", report, "--quiet", "--threads", self.threads]
        if verify:
            command += ["--verify", "100000000"]
        if ranks > 1:
            command = ["mpirun", "--oversubscribe", "-n", ranks, *command]
        self.command = [str(w) for w in command]
        try:
            done = subprocess.run(self.command, capture_output=True, text=True, timeout=LIMIT, env=ENVIRONMENT)
        except subprocess.TimeoutExpired:
            return None, None, f"not done after {LIMIT} s", picture
        frame = json.loads(report.read_text())["frames"][0] if report.exists() else None
        return done.returncode, frame, (done.stderr or done.stdout).strip(), picture


def counted(frame, tally):
    """(largest error that is not excused, bound) of an image that was judged, after counting it."""
    verify = frame["verify"]
    tally["pixels"] += verify["pixels"]
    tally["excused"] += verify["excused"]
    tally["double"] += frame.get("arithmetic") == "double"
    tally["frames"] += 1
    error = verify["max_error_not_excused"]
    return math.inf if error is None else error, verify["bound"]


def judged(case, methods, tally):
    """Description of what broke, or empty."""
    broken = []
    for words in methods:
        status, frame, said, _ = case.render(words)
        if status not in (0, 4) or frame is None:
            broken.append(f"{' '.join(words)}: status {status}: {said}")
            continue
        error, bound = counted(frame, tally)
        if not error <= bound:
            broken.append(f"{' '.join(words)}: {error:.3g} of {bound:g}")
        tally["worst"] = max(tally["worst"], error / bound)
    return broken


def run_class(name, args, folder):
    module = importlib.import_module(f"promise_cases.{name}")
    check = getattr(module, "check", None)
    tally = {"class": name, "seed": args.seed, "first": args.first, "cases": args.cases, "broken": [], "worst": 0.0,
             "pixels": 0, "excused": 0, "frames": 0, "double": 0}
    for number in range(args.first, args.first + args.cases):
        r = random.Random(f"{name}/{args.seed}/{number}")
        made = module.case(r, folder, str(args.tessera))
        case = Case(args.tessera, made, folder, args.threads)
        methods = made.get("methods", METHODS)
        if check is not None:
            right, words = check(case, methods, tally)
            broken = [] if right else [words]
        else:
            broken = judged(case, methods, tally)
        if broken:
            tally["broken"].append(number)
            print(f"BROKEN: {name}, seed {args.seed}, case {number}: {made['words']}: {'; '.join(broken)}", flush=True)
    excusable = getattr(module, "EXCUSABLE", 1e-4) * tally["pixels"]
    tally["too_many_excused"] = tally["excused"] > excusable + 3 * math.sqrt(excusable)
    print(f"{name}: seed {args.seed}, cases {args.first} to {args.first + args.cases - 1}: {len(tally['broken'])} broken; "
          f"largest error {tally['worst']:.3g} of what was promised; {tally['excused']} of {tally['pixels']} pixels excused"
          f"{', too many' if tally['too_many_excused'] else ''}; {tally['double']} of {tally['frames']} frames in double precision",
          flush=True)
    if hasattr(module, "summary"):
        print(f"{name}: {module.summary(tally)}", flush=True)
    return tally


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("classes", nargs="*", metavar="CLASS", help=f"of {', '.join(class_names())}; default: all")
    parser.add_argument("--tessera", type=pathlib.Path, default=ROOT / "build/release/apps/tessera")
    parser.add_argument("--cases", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the last case's files")
    args = parser.parse_args()
    names = args.classes or class_names()
    unknown = sorted(set(names) - set(class_names()))
    if unknown:
        parser.error(f"no class {', '.join(unknown)}; there are {', '.join(class_names())}")
    with tempfile.TemporaryDirectory() as scratch:
        folder = args.keep or pathlib.Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        results = [run_class(name, args, folder) for name in names]
    sys.exit(1 if any(t["broken"] or t["too_many_excused"] for t in results) else 0)


if __name__ == "__main__":
    main()
