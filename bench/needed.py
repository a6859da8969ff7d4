#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What the default skips, and what each mechanism that skips it saves: a table per data set, from the program's own counters.

    bench/needed.py --data FOLDER [--tessera build/release/apps/tessera] [--only NAME,...] [--document docs/ACCURACY.md]

Each data set with its default transfer function, with a sparse one (shows the upper fifth of the field's range) and
with an opaque one (50 times the default's extinction), and each time without one of the relevant mechanisms
(`tessera render --without`). A cell is ms with it / ms without it, and the reduction of work by the counters (ray
segments of meshes, pieces integrated of volumes). Times are the fastest of six frames, in three rounds over all.
Bytes: of bricks in memory, and of runs compared with raw segments (`--without merging`), two ranks, if mpirun exists.
"""
import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
BEGIN, END = "<!-- needed.py begin -->", "<!-- needed.py end -->"
SETS = [("oxygen-post", ["oxygen-post/postxyz.bin", "--q", "oxygen-post/postq.bin"]),
        ("bluntfin", ["bluntfin/bluntfinxyz.bin", "--q", "bluntfin/bluntfinq.bin"]),
        ("bracket", ["bracket/bracket_appended_compressed.vtu"]), ("disk-out", ["disk-out/disk_out_ref.ex2"]),
        ("notch", ["notch/notch_stress_fixed.vtk"]), ("unisim", ["unisim/UNISIM-II-D.vtu"]),
        ("heptane", ["volumes/heptane.nii.gz"]), ("LIDC2", ["volumes/LIDC2.vti"]),
        ("engine", ["volumes/engine.nii.gz"]), ("carotid", ["volumes/carotid.vtk"])]


def run(args, folder, words, ranks=0, repeat=3):
    report = folder / "r.json"
    command = [str(args.tessera), "render", *words, "-o", str(folder / "o.pfm"), "--report", str(report), "--size", args.size]
    command += ["--quiet"] + (["--repeat", str(repeat)] if not ranks else [])
    env = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    if ranks:
        command = ["mpirun", "--oversubscribe", "-n", str(ranks), *command]
    done = subprocess.run(command, capture_output=True, text=True, env=env)
    if done.returncode:
        sys.exit(f"needed.py: {' '.join(command)}\n{done.stderr}")
    everything = json.loads(report.read_text())
    frame = everything["frames"][0]
    return everything, frame["counters"], min(frame["frame_ms"])


def sparse(low, high, unit):
    at = lambda t: low + (high - low) * t
    knots = [(at(0), 0.2, 0.4, 0.9, 0.0), (at(0.8), 0.2, 0.4, 0.9, 0.0), (at(0.85), 0.9, 0.5, 0.1, 2 / unit), (at(1), 1, 0.9, 0.8, 2 / unit)]
    return "".join(" ".join(repr(float(x)) for x in k) + "\n" for k in knots)


def measure(args, name, words, folder):
    """{"volume", "counters" of the default, FUNCTION: {"default" or MECHANISM: (counters, ms)}, "bytes": (runs, segments)}"""
    words = [str(args.data / w) if not w.startswith("--") else w for w in words]
    everything, counters, _ = run(args, folder, words, repeat=1)
    part = everything.get("mesh") or everything["volume"]
    is_volume = "volume" in everything
    (folder / "sparse.txt").write_text(sparse(*part["field"]["range"], everything["transfer_function"]["unit_distance"]["value"]))
    fewer = ["culling", "skipping"] if is_volume else ["culling"]
    plan = {"default": ([], fewer + ([] if is_volume else ["lattice"])),
            "sparse": (["--transfer-function", str(folder / "sparse.txt")], fewer),
            "opaque": (["--opacity-scale", "50"], ["termination"])}
    out = {"name": name, "volume": is_volume, "counters": counters}
    for function, (more, mechanisms) in plan.items():
        # All in turn, three times, so that load bursts of other programs affect all.
        rounds = [{m: run(args, folder, [*words, *more, *(["--without", m] if m != "default" else [])], repeat=2)[1:]
                   for m in ("default", *mechanisms)} for _ in range(3)]
        out[function] = {m: (rounds[0][m][0], min(r[m][1] for r in rounds)) for m in rounds[0]}
    if shutil.which("mpirun") and not is_volume:
        out["bytes"] = [run(args, folder, [*words, *more], ranks=2)[1].get("exchange_bytes", 0) for more in ([], ["--without", "merging"])]
    return out


def lines_of(results):
    lines = ["| data set | of | left out by culling: default / sparse | culling: default; sparse | skipping: default; sparse | termination: opaque | lattice: default | "
             "bricks held, MB: sparse | merging, MB sent |", "|---|---|---|---|---|---|---|---|---|"]
    for r in results:
        total, gone, work = ("bricks_total", "bricks_invisible", "samples") if r["volume"] else ("tets_total", "tets_invisible", "segments")
        share = lambda function: f"{100 * r[function]['default'][0][gone] / max(r['counters'][total], 1):.0f} %"

        def both(function, m):
            if m not in r[function]:
                return ""
            (with_it, ms), (without, other_ms) = r[function]["default"], r[function][m]
            less = 100 * (1 - with_it[work] / max(without[work], 1))
            return f"{ms:.0f} / {other_ms:.0f}" + (f" ({less:.0f} % less)" if less >= 0.5 else "")

        pair = lambda m: "; ".join(both(f, m) for f in ("default", "sparse")) if m in r["sparse"] else "-"
        sent = f"{r['bytes'][0] / 1e6:.1f} / {r['bytes'][1] / 1e6:.1f}" if "bytes" in r else "-"
        read = " / ".join(f"{r['sparse'][m][0]['bytes_resident'] / 1e6:.1f}" for m in ("default", "culling")) if r["volume"] else "-"
        lines.append(f"| {r['name']} | {r['counters'][total]} {'bricks' if r['volume'] else 'tets'} | {share('default')} / {share('sparse')} | {pair('culling')} | "
                     f"{pair('skipping')} | {both('opaque', 'termination')} | {both('default', 'lattice') or '-'} | {read} | {sent} |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=pathlib.Path, required=True)
    parser.add_argument("--tessera", type=pathlib.Path, default=ROOT / "build/release/apps/tessera")
    parser.add_argument("--size", default="512x512")
    parser.add_argument("--only")
    parser.add_argument("--document", type=pathlib.Path)
    args = parser.parse_args()
    results = []
    with tempfile.TemporaryDirectory() as folder:
        for name, words in SETS:
            if args.only and name not in args.only.split(","):
                continue
            results.append(measure(args, name, words, pathlib.Path(folder)))
            print("\n".join(lines_of(results[-1:])[2:]), flush=True)
    if args.document:
        text = args.document.read_text()
        begin, end = text.index(BEGIN), text.index(END)
        args.document.write_text(text[:begin] + "\n".join([BEGIN, "", *lines_of(results), ""]) + "\n" + text[end:])


if __name__ == "__main__":
    main()
