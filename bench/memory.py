#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Memory of processes that render volumes, and the bytes that they read again if a volume is larger than that.

    of processes   the largest resident set of each rank, by volume, budget and number of ranks, sort-first and sort-last
    of sort-last   a volume that fits into the memory of all ranks together, not of one: bricks loaded and evicted per frame, in both modes

A rank's largest resident set is reported by the system at its end (wait4), including the program, its libraries, MPI's and any helper process. Volumes have 8
bits: `tessera generate head`, and `radial` of --large a side: 2048 takes 8.6 GB in --work, twice for both tables, and as much of the page cache as the machine has.
"""
import os
import pathlib
import sys

from results import generated, measure_parts, options, render, run, written

RANKS = 4  # for sort-last
PATH = 4  # views of one turn
WAYS = {"1 process": (1, []), "2, sort-first": (2, []), "3, sort-first": (3, []), "2, sort-last": (2, ["--distribution", "sort-last"]),
        "3, sort-last": (3, ["--distribution", "sort-last"])}


def watch(output, words):
    """Runs a rank, and writes its largest resident set in KiB to a file of its own."""
    rank = os.environ.get("OMPI_COMM_WORLD_RANK", "0")
    _, status, usage = os.wait4(os.posix_spawnp(words[0], words, os.environ), 0)
    pathlib.Path(f"{output}.{rank}").write_text(str(usage.ru_maxrss))
    sys.exit(os.waitstatus_to_exitcode(status) & 255)


def peaks(args, volume, memory, ranks, *words):
    """The report, and MiB of each rank, by rank."""
    launcher = written(args.work / "rank.sh", f'#!/bin/sh\nexec "{sys.executable}" "{__file__}" --watch "{args.work}/peak" "{args.tessera}" "$@"\n')
    launcher.chmod(0o755)
    report = render(args, volume, "--threads", 1 if ranks > 1 else 2, "--memory", memory, *words, ranks=ranks, picture="f%d.pfm", program=launcher)
    return report, ", ".join(f"{int((args.work / f'peak.{rank}').read_text()) / 1024:.0f}" for rank in range(ranks))


def large_volume(args):
    return generated(args, f"radial_{args.large}x{args.large}x{args.large}_uint8.raw", "radial", f"n={args.large}", "bits=8")


def of_processes(args, section):
    section.table("lrl" + "l" * len(WAYS), "volume", "file, MiB", "`--memory`", *WAYS)
    head = lambda n: generated(args, f"head_{n}x{n}x{n}_uint8.raw", "head", f"n={n}", "bits=8")
    for name, volume, memory, words in ((f"`radial` of {args.large}^3, raw", large_volume(args), "1G", ["--size", "512x512"]),
                                        ("`head` of 512^3, raw", head(512), "64M", ["--size", "512x512", "--orbit", "3"]),
                                        ("`head` of 400^3, raw, 70 x 50 pixels", head(400), "64M", ["--size", "70x50", "--orbit", "12"])):
        section.row(name, f"{volume.stat().st_size / 2 ** 20:,.0f}", memory, *(peaks(args, volume, memory, ranks, *words, *more)[1] for ranks, more in WAYS.values()))


def of_sort_last(args, section):
    n, volume = args.large, args.work / f"radial_{args.large}.bricks"
    if not volume.exists():
        run(args.tessera, "convert", large_volume(args), volume, "--quiet")
    # Nothing is clear and nothing opaque, so that every brick is visible; a raw file's voxels have length one.
    function = written(args.work / "all.txt", f"0 0.1 0.2 0.8 {0.2 / n}\n128 0.9 0.8 0.3 {0.6 / n}\n255 1 0.3 0.1 {1.5 / n}\n")
    section.table("lllrl", "distribution", "bricks loaded in each frame", "bricks evicted in each frame", "bricks in memory at the end, all processes",
                  "largest resident set of each process, MiB")
    for way in ("sort-first", "sort-last"):
        report, sizes = peaks(args, volume, args.memory, RANKS, "--size", "512x512", "--orbit", PATH, "--transfer-function", function, "--projection", "perspective",
                              "--distribution", way)
        counters = [frame["counters"] for frame in report["frames"]]
        loaded, evicted = (", ".join(f"{c[name]:,}" for c in counters) for name in ("bricks_loaded", "bricks_evicted"))
        section.row(way, loaded, evicted, f"{counters[-1]['bytes_resident'] / 1e9:.2f} GB", sizes)
    section.text(f"`radial` of {n}^3, {volume.stat().st_size / 1e9:.2f} GB, {counters[-1]['bricks_total']:,} bricks of 32^3; {RANKS} processes of one thread with "
                 f"`--memory {args.memory}` each; {PATH} views around the volume at 512 x 512 pixels.")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--watch"]:
        watch(sys.argv[2], sys.argv[3:])
    parts = {"of processes": of_processes, "of sort-last": of_sort_last}
    measure_parts(options(__doc__, only=tuple(parts), large=2048, memory="2700M"), parts)
