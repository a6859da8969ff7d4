#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The cost of assembling an image on one rank: bytes received, and CPU time of the stage `assemble`.

Films of 1024 x 1024 pixels on 8 nodes, with a projector and a compositor process of one thread per node: a cube, which fills half of the image, the wake of
`tessera generate demo`, which has much empty space around it, and a cube of cell data, whose pixels are noisy. Bytes are those of all messages of tiles that other
ranks send to the first compositor; CPU time is that of its stage `assemble`. Both exclude the first four frames, whose memory is new. Medians of --repeat runs.
A second table has the cost of packing and unpacking one image of each (pixel_packing.cpp, in the build that --programs names).
"""
import json
import statistics

from results import PROGRAMS, Section, exclusive, generated, options, render, run, spans_of

SIZE, FIRST, NODES = "1024x1024", 4, 8
MESHES = {"cube": ("cube.tets", "cube", "n=69"), "wake": ("demo.tets", "demo"), "noisy cube": ("noisy.vtu", "cube", "n=48", "cell_data=1")}


def figures(trace):
    """Megabytes and milliseconds per frame: see above."""
    threads = {key: spans for key, spans in spans_of(trace).items() if key[0] >= NODES}
    written = {e["args"]["frame"]: e["ts"] for (rank, _), of in threads.items() for e in of if rank == NODES and e["name"] == "write" and "frame" in e["args"]}
    begin, end, frames = written[FIRST], written[max(written)], max(written) - FIRST
    seconds = sum(s for (rank, _), of in threads.items() if rank == NODES for e, s in exclusive(of) if e["name"] == "assemble" and begin <= e["ts"] < end)
    sent = sum(e["args"].get("bytes", 0) for (rank, _), of in threads.items() if rank > NODES for e in of
               if e["name"] == "send" and e["args"].get("frame", 0) > 0)
    return 1e-6 * sent / max(written), 1e3 * seconds / frames


def main():
    args = options(__doc__, programs=PROGRAMS, frames=20, repeat=3)
    section, trace, images = Section(args), args.work / "trace.json", []
    section.table("lrrr", "image", "MB received per frame", "bytes per pixel", "assembly, CPU ms per frame")
    for name, data in MESHES.items():
        found = []
        for _ in range(args.repeat):
            render(args, generated(args, *data), "--size", SIZE, "--orbit", args.frames, "--threads", "1", "--projectors", NODES, "--compositors", NODES, "--timing",
                   trace, ranks=2 * NODES, picture="frame_%04d.png")
            found.append(figures(json.loads(trace.read_text())))
        megabytes, ms = map(statistics.median, zip(*found))
        section.row(name, f"{megabytes:.2f}", f"{1e6 * megabytes / 1024 ** 2:.2f}", f"{ms:.1f}")
        images.append(f"{name.replace(' ', '-')}.exr")
        render(args, args.work / data[0], "--size", SIZE, picture=images[-1])
    heads, _, *rows = run(args.programs / "pixel_packing", *(args.work / image for image in images)).out.strip().splitlines()
    cells = lambda line: line.strip("| ").split(" | ")
    section.table("lrrrrrr", *cells(heads))
    for row in rows:
        section.row(*cells(row))
    section.keep()


if __name__ == "__main__":
    main()
