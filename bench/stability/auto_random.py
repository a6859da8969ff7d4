#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Random scenes against the promise of `--accuracy`: no pixel may have a larger error than requested.

    bench/stability/auto_random.py [--tessera build/release/apps/tessera] [--cases 1000] [--seed 1] [--first 0]

Case i of a seed is always the same: a random mesh or grid, transfer function, view and accuracy (1e-2 to 1e-5), and
`--verify` on random pixels. An excused pixel (docs/ACCURACY.md) does not break a case, because one of 400 is more than a whole
image may have. Over all cases, at most 1e-4 of the pixels, plus three standard deviations, may be excused. Prints each
case that breaks with the command that reproduces it (`--first i --cases 1 --keep FOLDER` keeps its files), and exits with
status 1 if any did or too many pixels were excused. Needs only Python's standard library.
"""
import argparse
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def transfer_function(r, low, high):
    """Knots over (about) a field's range: ramps, steps, clear intervals, extinctions of 1e-3 to 1e4 per world size."""
    count = r.choice([1, 2, 3, 5, 8, 14, 15, 20, 40, 200])
    strength = 10 ** r.uniform(-3, 4) if r.random() < 0.3 else 10 ** r.uniform(-1, 1.5)
    wide = r.choice([0.6, 1.0, 1.0, 2.0])
    values = sorted(low + (high - low) * (0.5 + wide * (r.random() - 0.5)) for _ in range(count))
    knots = []
    for i, v in enumerate(values):
        kappa = 0.0 if r.random() < 0.3 else strength * r.random() ** 2
        knots.append((v, r.random(), r.random(), r.random(), kappa))
        if r.random() < 0.15:
            knots.append((v, r.random(), r.random(), r.random(), strength * r.random()))
    return knots


def camera(r, size):
    """The world is about [-1, 1]^3: from outside or inside, along an axis or not."""
    away = r.choice([4.0, 2.5, 1.0, 0.3])
    direction = [r.gauss(0, 1) for _ in range(3)]
    if r.random() < 0.2:
        direction = r.choice([[0, 0, 1], [1, 0, 0], [0, 1, 0]])
    norm = math.sqrt(sum(d * d for d in direction)) or 1.0
    at = [round(r.uniform(-0.3, 0.3), r.choice([1, 6])) for _ in range(3)]
    eye = [a + away * d / norm for a, d in zip(at, direction)]
    up = [0, 1, 0] if abs(direction[1]) < 0.9 * norm else [1, 0, 0]
    lines = [f"position {eye[0]!r} {eye[1]!r} {eye[2]!r}", f"focal_point {at[0]!r} {at[1]!r} {at[2]!r}",
             f"view_up {up[0]} {up[1]} {up[2]}"]
    if r.random() < 0.5:
        lines.append(f"parallel_scale {10 ** r.uniform(-1.5, 0.5)!r}")
    else:
        lines.append(f"view_angle {r.choice([5, 30, 60, 120, 165])}")
    if r.random() < 0.15:
        near = away * r.uniform(0.2, 1)
        lines.append(f"clipping_range {near!r} {near + r.uniform(0.2, 2)!r}")
    return "\n".join([*lines, f"size {size} {r.choice([size, size // 2 + 1])}"]) + "\n"


def random_input(r, tessera, folder):
    """(file, options): a generated mesh or grid whose field is about in [0, 1]."""
    if r.random() < 0.35:
        kind, words = r.choice([("ripples", [f"n={r.randint(2, 40)}", f"bits={r.choice([8, 16, 32])}"]),
                                ("checker", [f"n={r.randint(2, 9)}"])])
        path, extra = folder / "input.vti", ["--brick-size", str(r.choice([2, 5, 32]))]
    else:
        kind, words = r.choice([
            ("cube", [f"n={r.randint(1, 12)}", f"jitter={r.choice([0, 0.1, 0.25])}"]),
            ("graded", [f"n={2 * r.randint(2, 5)}", f"volume_ratio={10 ** r.randint(1, 12)}"]),
            ("slivers", [f"n={r.randint(2, 5)}", f"aspect={10 ** r.randint(2, 10)}"]),
            ("stack", [f"layers={10 ** r.randint(0, 3)}", f"width={r.choice([0.02, 0.2, 0.4])}"]),
            ("ball", [f"levels={r.randint(0, 3)}"]), ("annulus", [f"n={8 * r.randint(1, 4)}", f"seam={r.randint(0, 1)}"]),
            ("shells", [f"count={r.randint(1, 5)}", "levels=1", "layers=1"]), ("bars", [f"n={r.randint(1, 16)}"])])
        if r.random() < 0.25:
            words = [*words, "cell_data=1"]
        if r.random() < 0.2:
            words = [*words, f"inverted={r.randint(1, 2)}"]
        path, extra = folder / "input.vtu", []
    subprocess.run([tessera, "generate", kind, path, *words, "--quiet"], check=True, capture_output=True, text=True)
    return path, extra, f"{kind} {' '.join(words)}"


def case_of(tessera, seed, number, folder, threads):
    """(command, the input's description, accuracy); its files are in `folder`, the report will be r.json."""
    r = random.Random(f"{seed}/{number}")
    path, extra, words = random_input(r, tessera, folder)
    knots = transfer_function(r, 0.0, 1.0)
    (folder / "tf.txt").write_text("".join(" ".join(repr(float(x)) for x in k) + "\n" for k in knots))
    (folder / "camera.txt").write_text(camera(r, r.choice([24, 48, 96])))
    accuracy = 10 ** r.uniform(-5, -2)
    return [tessera, "render", str(path), *extra, "--transfer-function", str(folder / "tf.txt"), "--camera",
            str(folder / "camera.txt"), "--accuracy", repr(accuracy), "-o", str(folder / "o.pfm"), "--verify", "400",
            "--report", str(folder / "r.json"), "--threads", str(threads)], words, accuracy


def run_case(tessera, seed, number, folder, threads):
    command, words, accuracy = case_of(tessera, seed, number, folder, threads)
    done = subprocess.run([*command, "--quiet"], capture_output=True, text=True, timeout=600)
    if done.returncode != 0 and done.returncode != 4:
        return False, words, f"status {done.returncode}: {done.stderr.strip()}", accuracy, None
    verify = json.loads((folder / "r.json").read_text())["frames"][0]["verify"]
    return verify["max_error_not_excused"] <= accuracy, words, done.stdout.strip(), accuracy, verify


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tessera", type=pathlib.Path, default=ROOT / "build/release/apps/tessera")
    parser.add_argument("--cases", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the last case's files")
    args = parser.parse_args()
    broken, worst, pixels, excused = [], 0.0, 0, 0
    with tempfile.TemporaryDirectory() as scratch:
        folder = args.keep or pathlib.Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        for number in range(args.first, args.first + args.cases):
            met, words, said, accuracy, verify = run_case(str(args.tessera), args.seed, number, folder, args.threads)
            if verify is not None:
                worst = max(worst, verify["max_error_not_excused"] / accuracy)
                pixels, excused = pixels + verify["pixels"], excused + verify["excused"]
            if not met:
                broken.append(number)
                print(f"BROKEN: seed {args.seed} case {number}: {words}, accuracy {accuracy:.3g}: {said}", flush=True)
    print(f"seed {args.seed}, cases {args.first} to {args.first + args.cases - 1}: {len(broken)} broken; "
          f"largest error {worst:.3g} of what was asked; {excused} of {pixels} pixels excused")
    # Three standard deviations of a fraction of 1e-4.
    sys.exit(1 if broken or excused > 1e-4 * pixels + 3 * math.sqrt(1e-4 * pixels) else 0)


if __name__ == "__main__":
    main()
