#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Predictions of bench/simulate.py for machines that are not available: 8, 64 and 1024 nodes, 15.7 million to 10^10 tetrahedra.

Traces cubes of two sizes on 8 nodes (1024 x 1024 pixels), and scales their work to M tets and N nodes by these rules:

- Culling and binning: proportional to M, from the larger cube, divided evenly.
- Tiles' CPU time on projectors: a M + b M^(1/3), cells and ray segments, fitted to both cubes. Cells smaller than pixels save nothing.
- A projector's part of the mesh covers N^(-2/3) of the image, and all tiles that this touches: a square of side s+1 tiles if its own side is
  s. The bytes of all fragments and their compositing grow as N^(1/3) and as the power of M given by both cubes, at most 1/3.
- Imbalance of projectors, variation of depth among tiles, and the costs of a message, a byte, assembly and writing: as measured with the larger cube
  on 8 nodes.
- Threads of a rank share its work without loss; at most 8 in assembling an image, at most 12 in writing one, the number of compressed strips of a .png
  of this size.
"""
import collections
import functools
import itertools
import math
import multiprocessing

from results import Section, generated, options, render
from simulate import GOODPUT, Settings, losses
from simulate_work import Work, work_of

SIZE, TILE, BASE_NODES = 1024, 32, 8
STRIPS = 12  # io/image/picture_strips.hpp: rows of 256 KiB, of 3 bytes a pixel
PARTS = ("projection", "imbalance", "last tile", "compositing", "assembly", "wire")
MILLIONS = (15.7, 1e4)
NODES = (8, 64, 1024)
MACHINES = ((32, 10), (2, 10), (32, 1))  # cores per node, Gbit/s


class Base:
    """Sums over a trace's frames, per frame."""

    def __init__(self, work, side):
        self.work, self.millions = work, 6e-6 * side ** 3
        self.depth = collections.Counter()  # seconds per tile, over all projectors
        self.merge = collections.Counter()
        own = collections.Counter()
        self.setup, self.bytes, self.pairs = sum(work.setup.values()) / work.frames, 0.0, 0.0
        for (_, p), tiles in work.tiles.items():
            own[p] += work.setup.get((_, p), 0.0) / work.frames
            for tile, seconds, size in tiles:
                self.depth[tile] += seconds / work.frames
                own[p] += seconds / work.frames
                self.bytes += size / work.frames
                self.pairs += 1 / work.frames
        for (_, tile), seconds in work.merge.items():
            self.merge[tile] += seconds / work.frames
        self.project = sum(self.depth.values())
        mean = sum(own.values()) / work.projectors
        self.uneven = [own[p] / mean for p in range(work.projectors)]


def cells_and_segments(small, large):
    """(a, b) of a M + b M^(1/3), both non-negative."""
    m, n = small.millions, large.millions
    a = (large.project - small.project * (n / m) ** (1 / 3)) / (n - m * (n / m) ** (1 / 3))
    a = min(max(a, 0.0), large.project / n)
    return a, (large.project - a * n) / n ** (1 / 3)


def power(small, large, of):
    return min(max(math.log(of(large) / of(small)) / math.log(large.millions / small.millions), 0.0), 1 / 3)


def scaled(small, large, millions, nodes, frames):
    """The work of M million tets on N nodes."""
    a, b = cells_and_segments(small, large)
    project = a * millions + b * millions ** (1 / 3)
    setup = large.setup * millions / large.millions
    grow, more = millions / large.millions, (nodes / BASE_NODES) ** (1 / 3)
    size = large.bytes * more * grow ** power(small, large, lambda x: x.bytes)
    merge = more * grow ** power(small, large, lambda x: sum(x.merge.values()))
    side = (math.sqrt(large.pairs / BASE_NODES) - 1) * (nodes / BASE_NODES) ** (-1 / 3) + 1
    across = SIZE // TILE
    work = Work(nodes, nodes)
    work.__dict__.update({k: getattr(large.work, k) for k in ("send", "receive", "assemble", "write", "tile_bytes")})
    work.frames = frames
    windows = [window(large.depth, (p + 0.5) / nodes, side, across) for p in range(nodes)]
    pairs = sum(map(len, windows))
    for p, tiles in enumerate(windows):
        uneven = large.uneven[p % len(large.uneven)]
        share, depth = uneven / nodes, sum(large.depth[t] for t in tiles)
        for f in range(frames):
            work.setup[f, p] = setup * share
            work.tiles[f, p] = [[t, project * share * large.depth[t] / depth, size / pairs] for t in tiles]
    work.owner = {t: t % nodes for t in range(across * across)}
    work.merge = {(f, t): seconds * merge for t, seconds in large.merge.items() for f in range(frames)}
    return work


def window(depth, quantile, side, across):
    """The tiles of a square around the tile at which the cumulative depth reaches that fraction; only those with any depth."""
    left = quantile * sum(depth.values())
    for centre in sorted(depth):
        left -= depth[centre]
        if left <= 0:
            break
    y, x = divmod(centre, across)
    half, count = (side - 1) / 2, max(1, round(side))
    rows, columns = (range(max(0, round(v - half)), min(across, round(v - half) + count)) for v in (y, x))
    return sorted({across * j + i for j in rows for i in columns if depth.get(across * j + i)} | {centre})


def base(args, side):
    trace = args.work / f"cube-{side}.trace.json"
    if not trace.exists():
        render(args, generated(args, f"cube-{side}.tets", "cube", f"n={side}"), "--size", f"{SIZE}x{SIZE}", "--orbit", args.frames, "--threads", "1", "--without",
               "sharing", "--projectors", BASE_NODES, "--compositors", BASE_NODES, "--timing", trace, ranks=2 * BASE_NODES, picture="frame_%04d.png")
    return Base(work_of(trace), side)


def predicted(small, large, frames, case):
    cores, gbit, millions, nodes = case
    settings = Settings(bytes_per_second=gbit * 1e9 / 8 * GOODPUT, latency=20e-6, cores=cores, threads=max(1, cores - 2))
    work = scaled(small, large, millions, nodes, frames)
    work.write /= min(settings.threads, STRIPS)  # its CPU time was measured on one thread
    return losses(work, settings)


def cell(whole, parts):
    """A frame's milliseconds, the share of it that projection is, and the largest loss if it is more than 5 %."""
    share = {name: 100 * parts[name] / whole for name in PARTS}
    loss = max(PARTS[1:], key=share.get)
    return f"{1e3 * whole:.0f}, {share['projection']:.0f} %" + (f", {loss} {share[loss]:.0f} %" if round(share[loss]) > 5 else "")


def main():
    args = options(__doc__, sides="69,138", frames=4, jobs=1)
    section = Section(args)
    small, large = (base(args, int(side)) for side in args.sides.split(","))
    section.table("rrr" + "l" * len(NODES), "cores per node", "Gbit/s", "tets", *(f"{nodes} nodes [ms]" for nodes in NODES))
    with multiprocessing.Pool(args.jobs) as pool:
        found = pool.imap(functools.partial(predicted, small, large, args.frames),
                          [(*machine, millions, nodes) for machine in MACHINES for millions in MILLIONS for nodes in NODES])
        for (cores, gbit), millions in itertools.product(MACHINES, MILLIONS):
            tets = f"{millions} M" if millions < 1000 else f"10^{round(math.log10(millions)) + 6}"
            section.row(cores, gbit, tets, *(cell(*next(found)) for _ in NODES))
    section.keep()


if __name__ == "__main__":
    main()
