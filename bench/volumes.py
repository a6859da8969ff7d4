#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Times `tessera render` of regular grids compared with VTK's fixed-point ray caster: same volume, view, transfer function, run.

Ripples of 256^3 samples in float and in 8 bits (view and transfer function of all performance figures), and if --data names a directory with volumes/heptane.nii.gz
and volumes/LIDC2.vti, those in their default view with a function that shows only the top of their range. Rounds alternate over all renderers, so that all
have the same conditions. Errors: Tessera's against the double-precision reference at 100 random pixels, VTK's against Tessera's `exact` image, all pixels,
linear RGB. VTK (python3-vtk9, under xvfb-run) uses steps of one voxel.
"""
import json
import pathlib
import statistics

from results import HERE, PYTHON_OF_VTK, VIEW, Section, data_words, error, generated, knots_of, options, render, run, written

METHODS = [("--accuracy", "1e-3"), ("--accuracy", "1e-4"), ("--accuracy", "1e-5"), ("--integrator", "exact")]


def volumes(args):
    """Name, file, arguments for view and transfer function."""
    bytes_function = "".join(" ".join(map(repr, [255 * value, *rest])) + "\n" for value, *rest in knots_of(VIEW[3]))
    yield "ripples 256^3 float", generated(args, "ripples.nrrd", "ripples", "n=256"), VIEW
    yield "ripples 256^3 8-bit", generated(args, "bytes.nrrd", "ripples", "n=256", "bits=8"), [*VIEW[:3], written(args.work / "bytes.txt", bytes_function)]
    for name in ("heptane", "LIDC2") if args.data else ():
        path, = data_words(args, name)
        volume = render(args, path, "--size", "64x64")["volume"]
        low, high = volume["field"]["range"]
        extent = max(b - a for a, b in zip(*volume["bounds"]))
        at = lambda u: low + u * (high - low)
        function = f"{at(0.5)} 1 0.6 0.2 0\n{at(0.7)} 1 1 1 {40 / extent}\n{at(1)} 1 1 1 {80 / extent}\n"
        yield f"{name}, sparse", path, ["--transfer-function", written(args.work / f"{name}.txt", function), "--size", "1024x1024"]


def main():
    args = options(__doc__, data=pathlib.Path, rounds=3, repeat=5, threads=2)
    section = Section(args)
    section.table("lllllll", "volume", *(f"`{' '.join(method)}`" for method in METHODS), "VTK fixed point", "ns per voxel, 1e-4")
    for name, path, words in volumes(args):
        times, reports, vtk = {method: [] for method in METHODS}, {}, []
        run(args.tessera, "convert", path, args.work / "samples.vti", "--quiet")
        for number in range(args.rounds):
            verify = ["--verify", 100] if number == args.rounds - 1 else []
            for method in METHODS:
                report = reports[method] = render(args, path, *words, *method, "--threads", args.threads, "--repeat", args.repeat, *verify)
                times[method] += report["frames"][0]["frame_ms"]
            found = json.loads(run(*PYTHON_OF_VTK, HERE / "peers" / "vtk_raycast.py", args.work / "samples.vti", args.work / "report.json",
                                   args.work / "picture.pfm", "--repeat", max(2, args.repeat // 2), "--threads", args.threads).out.splitlines()[-1])
            vtk += found["frame_ms"]
        cells = [f"{min(times[m]):.0f} ({statistics.median(times[m]):.0f}), {min(vtk) / min(times[m]):.1f}x, "
                 f"{error(reports[m]['frames'][0]['verify']['max_error'])}" for m in METHODS]
        each = 1e6 * min(times[METHODS[1]]) * args.threads / reports[METHODS[1]]["frames"][0]["counters"]["voxels_visited"]
        section.row(name, *cells, f"{min(vtk):.0f} ({statistics.median(vtk):.0f}), {error(found['max_error'])}", f"{each:.1f}")
    section.keep("least (median) time of a frame [ms], VTK's least time (with steps of one voxel) divided by ours, maximum error. The last column is ns per voxel "
                 "visited at accuracy 1e-4; for the other methods it is proportional to time")


if __name__ == "__main__":
    main()
