#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The cost of assembling an image on one rank: bytes received, and CPU time of the stage `assemble`.

    bench/assembly.py --tessera PROGRAM [--tessera BEFORE ...] --work FOLDER [--results docs/RESULTS.md] [--nodes 8] [--frames 20] [--repeat 3]
                      [--packing PROGRAM]

Each program renders the same films of 1024 x 1024 pixels, alternating with the others, with a projector and a compositor process of one thread
per node: a cube, which fills half of the image, the wake of `tessera generate demo`, which has much empty space around it, and a cube of cell
data, whose pixels are noisy. Bytes are those of all messages of tiles that other ranks send to the first compositor; CPU time is that of its
stage `assemble`. Both exclude the first four frames, whose memory is new. Medians of the runs.

With --packing, the build's bench/pixel_packing, a second table has the cost of packing and unpacking one image of each. Needs only Python's
standard library.
"""
import argparse
import json
import os
import pathlib
import re
import statistics
import subprocess

import results_file
from scaling import exclusive
from simulate_check import call, mpirun

SIZE, FIRST = 1024, 4
MESHES = {"cube": ("cube", "cube.tets", "n=69"), "wake": ("demo", "demo.tets"), "noisy cube": ("cube", "noisy.vtu", "n=48", "cell_data=1")}


def figures(trace, nodes):
    """Milliseconds and megabytes per frame: see above."""
    spans = {}
    for event in json.loads(trace.read_text())["traceEvents"]:
        if event["ph"] == "X" and event["name"] != "frame" and event["pid"] >= nodes:
            spans.setdefault((event["pid"], event["tid"]), []).append(event)
    written = {e["args"]["frame"]: e["ts"] for (rank, _), of in spans.items() for e in of if rank == nodes and e["name"] == "write" and "frame" in e["args"]}
    begin, end, frames = written[FIRST], written[max(written)], max(written) - FIRST
    seconds = sum(s for (rank, _), of in spans.items() if rank == nodes for e, s in exclusive(of) if e["name"] == "assemble" and begin <= e["ts"] < end)
    sent = sum(e["args"].get("bytes", 0) for (rank, _), of in spans.items() if rank > nodes for e in of
               if e["name"] == "send" and e["args"].get("frame", 0) > 0)
    return 1e3 * seconds / frames, 1e-6 * sent / max(written)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--tessera", type=pathlib.Path, action="append", required=True)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--results", type=pathlib.Path)
    parser.add_argument("--packing", type=pathlib.Path)
    parser.add_argument("--nodes", type=int, default=8)
    parser.add_argument("--frames", type=int, default=20)
    parser.add_argument("--repeat", type=int, default=3)
    args = parser.parse_args()
    programs, args.work = [p.resolve() for p in args.tessera], args.work.resolve()
    args.work.mkdir(parents=True, exist_ok=True)
    load = os.getloadavg()[0]
    lines = ["| picture | program | MB a frame that come | bytes a pixel | assemble, CPU ms a frame |", "|---|---|---:|---:|---:|"]
    for name, (kind, file, *parameters) in MESHES.items():
        mesh, trace = args.work / file, args.work / "trace.json"
        if not mesh.exists():
            call(programs[0], "generate", kind, mesh, *parameters, "--quiet")
        runs = [[] for _ in programs]
        for _ in range(args.repeat):
            for program, found in zip(programs, runs):
                mpirun(["mpirun", "--oversubscribe", "-n", 2 * args.nodes, program, "render", mesh, "--size", f"{SIZE}x{SIZE}", "--orbit", args.frames,
                        "-o", args.work / "frame_%04d.png", "--threads", "1", "--projectors", args.nodes, "--compositors", args.nodes, "--timing", trace,
                        "--quiet"], [])
                found.append(figures(trace, args.nodes))
        for which, found in zip(("this", *(f"before ({n})" for n in range(1, len(programs)))), runs):
            megabytes = statistics.median(m for _, m in found)
            lines.append(f"| {name} | {which} | {megabytes:.2f} | {1e6 * megabytes / SIZE ** 2:.2f} | {statistics.median(ms for ms, _ in found):.1f} |")
            print(lines[-1], flush=True)
    if args.packing:
        pictures = [args.work / f"{name.replace(' ', '-')}.exr" for name in MESHES]
        for picture, (_, file, *_) in zip(pictures, MESHES.values()):
            call(programs[0], "render", args.work / file, "--size", f"{SIZE}x{SIZE}", "-o", picture, "--quiet")
        table = subprocess.run([args.packing, *pictures], check=True, capture_output=True, text=True).stdout
        print(table)
        lines += ["", *table.splitlines()]
    if args.results:
        made = re.sub(r"\.$", "", results_file.made(load))
        results_file.put(args.results, "assembly.py", f"{made}. `{results_file.command('assembly.py')}`.", lines)


if __name__ == "__main__":
    main()
