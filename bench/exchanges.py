#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Which exchange composites the parts of an image with the fewest bytes, messages and CPU time: direct send, binary swap, radix-k, and for meshes runs.

    volumes  parts of a k-d tree, as for `--distribution sort-last`
    meshes   parts of a space-filling curve, as for `--partition curve`: runs as sent to other machines, compared with images of the parts
             composited in the order of their centres, which is correct only if no part is both in front of and behind another

compositing_exchanges.cpp (in the build that --programs names) defines what is counted; figures are means over views. A process's time is modelled: its CPU
time, plus its sent bytes at 95 MB/s (the thesis's bandwidth); waiting for others is not included. Meshes of files need --data.
"""
import json
import pathlib

from results import PROGRAMS, data_words, error, measure_parts, options, run

EXCHANGES = {"direct-send": "direct send", "binary-swap": "binary swap", "radix-k": "radix-k"}
BANDWIDTH = 95e6  # bytes a second: the thesis's
MESHES = {"cube": ("mesh=cube", "n=24", "jitter=0"), "cube, vertices moved": ("mesh=cube", "n=24", "jitter=0.2")}
SAMPLES, SIZE, VIEWS, RANKS = 160, 1024, 8, 8


def exchanged(args, *words):
    """Rows by number of ranks and exchange."""
    rows = {}
    for line in run(args.programs / "compositing_exchanges", *words).out.splitlines():
        row = json.loads(line)
        rows.setdefault(row["ranks"], {})[row["exchange"]] = row
    return rows


def volumes(args, section):
    section.table("r" * 10, "processes", *(column for name in EXCHANGES.values() for column in (f"{name}: MB", "messages", "ms")))
    rows = exchanged(args, "volume=head", f"n={SAMPLES}", f"size={SIZE}", f"views={VIEWS}", "ranks=2,4,6,8,16,64")
    for ranks, of in rows.items():
        section.row(ranks, *(cell for name in EXCHANGES for cell in (
            f"{of[name]['bytes'] / ranks / 1e6:.2f}", f"{of[name]['messages'] / ranks:.0f}", f"{of[name]['cpu_ms'] + 1e3 * of[name]['most_bytes'] / BANDWIDTH:.1f}")))
    worst = max(row["error"] for of in rows.values() for row in of.values())
    section.text(f"`head` of {SAMPLES}^3, {SIZE}x{SIZE} pixels, {VIEWS} views. *ms*: CPU time, plus the time to send the largest number of bytes of a process at 95 MB/s. "
                 f"Images differ from that of one process by at most {error(worst)}.")


def meshes(args, section):
    section.table("l" + "r" * 6, "mesh", "runs per pixel", "runs: MB", "direct send: MB", "radix-k: MB", "error of runs", "error of direct send")
    files = {}
    for name in ("notch", "disk-out") if args.data else ():
        run(args.tessera, "convert", *data_words(args, name), args.work / f"{name}.tets", "--quiet")
        files[f"`{name}`"] = (f"mesh={args.work / name}.tets",)
    for name, words in {**MESHES, **files}.items():
        of = exchanged(args, *words, f"size={SIZE // 2}", f"views={VIEWS // 2}", f"ranks={RANKS}")[RANKS]
        # One of the compositors, all of which get the same number of tiles, is in the same process.
        sent = [of["runs"]["bytes"] * (RANKS - 1) / RANKS, of["direct-send"]["bytes"], of["radix-k"]["bytes"]]
        section.row(name, f"{of['runs']['runs_a_part']:.3f}", *(f"{size / RANKS / 1e6:.2f}" for size in sent), error(of["runs"]["error"]),
                    error(of["direct-send"]["error"]))
    section.text(f"{RANKS} processes, {SIZE // 2}x{SIZE // 2} pixels, {VIEWS // 2} views; cubes of 24^3, vertices moved by a fifth; errors are the largest "
                 "differences from the image of one process.")


if __name__ == "__main__":
    parts = {"volumes": volumes, "meshes": meshes}
    measure_parts(options(__doc__, programs=PROGRAMS, only=tuple(parts), data=pathlib.Path), parts)
