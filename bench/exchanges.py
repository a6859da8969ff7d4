#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Which exchange composites the parts of an image with the fewest bytes, messages and CPU time: direct send, binary swap, radix-k, and for meshes runs.

    bench/exchanges.py --program build/release/bench/compositing_exchanges [--document docs/RESULTS.md] [--only volumes]
                       [--data ../shared/data --tessera PROGRAM]

    volumes  parts of a k-d tree, as for `--distribution sort-last`
    meshes   parts of a space-filling curve, as for `--partition curve`: runs as sent to other machines, compared with images of the parts
             composited in the order of their centres, which is correct only if no part is both in front of and behind another

bench/compositing_exchanges.cpp defines what is counted; figures are means over views. A process's time is modelled: its CPU time, plus its sent bytes
at 95 MB/s (the thesis's bandwidth); waiting for others is not included.

Needs Python's standard library. Meshes of files need --data, and --tessera to convert them; otherwise they are left out.
"""
import argparse
import json
import os
import pathlib
import subprocess
import tempfile

import results_file

EXCHANGES = {"direct-send": "direct send", "binary-swap": "binary swap", "radix-k": "radix-k"}
BANDWIDTH = 95e6  # bytes a second: the thesis's
MESHES = {"cube": ("mesh=cube", "n=24", "jitter=0"), "cube, vertices moved": ("mesh=cube", "n=24", "jitter=0.2")}
FILES = {"notch": "notch/notch_stress_fixed.vtk", "disk-out": "disk-out/disk_out_ref.ex2"}


def run(args, *words):
    """Rows by number of ranks and exchange."""
    done = subprocess.run([args.program, *map(str, words)], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"exchanges.py: {done.stderr.strip()}")
    rows = {}
    for line in done.stdout.splitlines():
        row = json.loads(line)
        rows.setdefault(row["ranks"], {})[row["exchange"]] = row
    return rows


def volumes(args, _):
    rows = run(args, f"volume={args.volume}", f"n={args.samples}", f"size={args.size}", f"views={args.views}", f"ranks={args.ranks}")
    columns = [f"{name}: MB | messages | ms" for name in EXCHANGES.values()]
    lines = ["| processes | " + " | ".join(columns) + " |", "|---:|" + "---:|" * (3 * len(EXCHANGES))]
    for ranks, of in rows.items():
        cells = []
        for name in EXCHANGES:
            row = of[name]
            cells.append(f"{row['bytes'] / ranks / 1e6:.2f} | {row['messages'] / ranks:.0f} | "
                         f"{row['cpu_ms'] + 1e3 * row['most_bytes'] / BANDWIDTH:.1f}")
        lines.append(f"| {ranks} | " + " | ".join(cells) + " |")
    worst = max(row["error"] for of in rows.values() for row in of.values())
    return lines + ["", f"`{args.volume}` of {args.samples}^3, {args.size}x{args.size} pixels, {args.views} views. *ms*: CPU time, and the most bytes of a process at 95 MB/s. "
                    f"Images are within {results_file.error(worst)} of that of one process."]


def meshes(args, folder):
    lines = ["| mesh | processes | runs a pixel | runs: MB | direct send: MB | radix-k: MB | error of runs | of direct send |", "|---|" + "---:|" * 7]
    files = {}
    for name, path in (FILES if args.data else {}).items():
        converted = folder / f"{name}.tets"
        subprocess.run([args.tessera, "convert", args.data / path, converted, "--quiet"], check=True)
        files[f"`{name}`"] = (f"mesh={converted}",)
    for name, words in {**MESHES, **files}.items():
        for ranks, of in run(args, *words, f"size={args.size // 2}", f"views={args.views // 2}", f"ranks={args.mesh_ranks}").items():
            # One of the compositors, all of which get the same number of tiles, is in the same process.
            sent = of["runs"]["bytes"] * (ranks - 1) / ranks
            cells = [f"{of['runs']['runs_a_part']:.3f}", f"{sent / ranks / 1e6:.2f}"]
            cells += [f"{of[exchange]['bytes'] / ranks / 1e6:.2f}" for exchange in ("direct-send", "radix-k")]
            cells += [results_file.error(of[exchange]["error"]) for exchange in ("runs", "direct-send")]
            lines.append(f"| {name} | {ranks} | " + " | ".join(cells) + " |")
            print(lines[-1], flush=True)
    return lines + ["", f"{args.size // 2}x{args.size // 2} pixels, {args.views // 2} views; cubes of 24^3, vertices moved by a fifth; errors are the largest differences from the image of one process."]


TABLES = {"volumes": volumes, "meshes": meshes}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=pathlib.Path, required=True)
    parser.add_argument("--document", type=pathlib.Path)
    parser.add_argument("--only", choices=TABLES)
    parser.add_argument("--data", type=pathlib.Path)
    parser.add_argument("--tessera", type=pathlib.Path)
    parser.add_argument("--volume", default="head")
    parser.add_argument("--samples", type=int, default=160)
    parser.add_argument("--size", type=int, default=1024)
    parser.add_argument("--views", type=int, default=8)
    parser.add_argument("--ranks", default="2,4,6,8,16,64")
    parser.add_argument("--mesh-ranks", default="2,8")
    args = parser.parse_args()
    if args.data and not args.tessera:
        parser.error("--data needs --tessera")
    for name, table in TABLES.items():
        if args.only not in (None, name):
            continue
        load = os.getloadavg()[0]
        with tempfile.TemporaryDirectory() as folder:
            lines = table(args, pathlib.Path(folder))
        print("\n".join(lines))
        if args.document:
            results_file.put(args.document, f"exchanges.py {name}", f"{results_file.made(load)} `{results_file.command('exchanges.py')}`", lines)


if __name__ == "__main__":
    main()
