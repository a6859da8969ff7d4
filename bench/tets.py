#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Times `tessera render` compared with VTK's unstructured-grid ray caster: same mesh, view, transfer function, machine, run.

Renders cubes with the integrators `exact` and `auto`, and with VTK's full and partial pre-integration (peers/vtk_raycast.py under xvfb-run; needs
python3-vtk9). Errors: Tessera's against the double-precision reference at --verify random pixels; VTK's against Tessera's `exact` image, all pixels, linear RGB.
"""
import json
import os
import re
import statistics

from results import HERE, PYTHON_OF_VTK, VIEW, Section, error, generated, options, render, run


def build(tessera):
    """Compiler and flags of the build that a program is from."""
    for folder in tessera.parents:
        if (folder / "CMakeCache.txt").exists():
            entries = dict(re.findall(r"^(\w+):\w+=(.*)$", (folder / "CMakeCache.txt").read_text(), re.M))
            kind = entries.get("CMAKE_BUILD_TYPE", "")
            flags = f"{entries.get('CMAKE_CXX_FLAGS', '')} {entries.get('CMAKE_CXX_FLAGS_' + kind.upper(), '')}".split()
            return f"{run(entries['CMAKE_CXX_COMPILER'], '--version').out.splitlines()[0]}, {kind} ({' '.join(flags)})"
    return "unknown compiler"


def main():
    args = options(__doc__, cubes="32,64", repeat=7, vtk_repeat=2, verify=200)
    section, headed = Section(args), False
    for n in args.cubes.split(","):
        mesh, runs = generated(args, f"cube{n}.tets", "cube", f"n={n}"), {}
        for integrator in ("auto", "exact"):
            frame = render(args, mesh, *VIEW, "--integrator", integrator, "--repeat", args.repeat, "--verify", args.verify)["frames"][0]
            runs[f"Tessera `{integrator}`"] = frame | frame["verify"]
        for integrator in ("full", "partial"):
            found = json.loads(run(*PYTHON_OF_VTK, HERE / "peers" / "vtk_raycast.py", mesh, args.work / "report.json", args.work / "picture.pfm", "--integrator",
                                   integrator, "--repeat", args.vtk_repeat, "--threads", os.cpu_count()).out.splitlines()[-1])
            runs[found["renderer"]] = found
        runs = {"Tessera `exact`": runs.pop("Tessera `exact`")} | runs
        if not headed:
            section.table("l" * (1 + len(runs)), "mesh", *runs)
            headed = True
        base = statistics.median(frame["frame_ms"])
        cells = []
        for name, found in runs.items():
            median = statistics.median(found["frame_ms"])
            times = "" if not cells else f"{median / base:.1f}x, "
            cells.append(f"{median:.0f} ({min(found['frame_ms']):.0f}), {times}{error(found['max_error'])}, {error(found['rms_error'])}")
        section.row(f"cube {n}, {1e-6 * frame['counters']['tets_total']:.2f} M tets", *cells)
    section.keep("median (least) time of a frame [ms], its ratio to the first renderer's, maximum error, RMS error",
                 f"{section.made()} {build(args.tessera)}, kernels {frame['instruction_set']}, all cores.")


if __name__ == "__main__":
    main()
