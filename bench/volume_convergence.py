#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How the error of the caster's methods falls with step or asked accuracy (docs/ACCURACY.md, "Volumes by steps").

Renders ripples (128^3 samples) with the transfer function of all performance figures and with one of narrow peaks, and compares 2,000 random pixels with the
double-precision reference (--verify).
"""
from results import VIEW, Section, generated, options, render, written

SHARP = "0.5 0.1 0.3 0.9 0\n0.51 0.2 0.9 0.3 60\n0.52 0.9 0.8 0.1 0\n0.8 1 0.3 0 0\n1 1 1 1 40\n"
STEPS, ACCURACIES = ("2", "0.5", "0.125"), ("1e-2", "1e-4", "1e-5")


def main():
    args = options(__doc__, samples=128)
    volume, section = generated(args, "ripples.nrrd", "ripples", f"n={args.samples}"), Section(args)
    functions = {"six knots": VIEW[3], "narrow peaks": written(args.work / "sharp.txt", SHARP)}
    rows = {f"`{method}`, {' / '.join(STEPS)} voxels": [["--integrator", method, "--step", step] for step in STEPS] for method in ("sampled", "preintegrated")}
    rows[f"`auto`, {' / '.join(ACCURACIES)}"] = [["--accuracy", accuracy] for accuracy in ACCURACIES]
    rows["`exact`"] = [["--integrator", "exact"]]
    section.table("lll", "method", *functions)
    for name, methods in rows.items():
        errors = [[render(args, volume, *VIEW[:2], "--transfer-function", function, "--size", "200x200", "--verify", 2000, *words)["frames"][0]["verify"]["max_error"]
                   for words in methods] for function in functions.values()]
        section.row(name, *(" / ".join(f"{e:.1e}" for e in of) for of in errors))
    section.keep()


if __name__ == "__main__":
    main()
