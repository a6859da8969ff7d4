#!/usr/bin/env python3
"""What the default skips, and what that saves: a table a data set, from the program's own counters.

    bench/needed.py --data FOLDER [--tessera build/release/apps/tessera] [--document docs/ACCURACY.md]

Each data set once with its default transfer function and once with a sparse one (the upper fifth of the field's range
shows). Cells and bricks that the function makes invisible are counted by the run; what skipping them is worth is
measured by the same picture with a function that is almost clear there (1e-9 of the extinction) instead of clear.
Early termination: the same picture at --accuracy 1e-2 and 1e-5. Exchange: bytes of runs beside raw segments, two ranks,
where mpirun is. Times are the fastest of three frames.
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


def sparse(low, high, unit, clear):
    at = lambda t: low + (high - low) * t
    kappa = 2.0 / unit
    rest = 1e-9 * kappa if not clear else 0.0
    knots = [(at(0), 0.2, 0.4, 0.9, rest), (at(0.8), 0.2, 0.4, 0.9, rest), (at(0.85), 0.9, 0.5, 0.1, kappa), (at(1), 1, 0.9, 0.8, kappa)]
    return "".join(" ".join(repr(float(x)) for x in k) + "\n" for k in knots)


def measure(args, name, words, folder):
    words = [str(args.data / w) if not w.startswith("--") else w for w in words]
    everything, counters, ms = run(args, folder, words)
    part = everything.get("mesh") or everything["volume"]
    low, high = part["field"]["range"]
    unit = everything["transfer_function"]["unit_distance"]["value"]
    out = {"name": name, "volume": "volume" in everything, "default": (counters, ms)}
    for clear in (True, False):
        tf = folder / "sparse.txt"
        tf.write_text(sparse(low, high, unit, clear))
        _, c, t = run(args, folder, [*words, "--transfer-function", str(tf)])
        out["sparse" if clear else "not skipped"] = (c, t)
    dense = ["--opacity-scale", "50"]
    out["opaque 1e-2"] = run(args, folder, [*words, *dense, "--accuracy", "1e-2"])[1:]
    out["opaque 1e-5"] = run(args, folder, [*words, *dense, "--accuracy", "1e-5"])[1:]
    if shutil.which("mpirun") and not out["volume"]:
        for exchange in ("runs", "segments"):
            out[exchange] = run(args, folder, [*words, "--exchange", exchange], ranks=2)[1].get("exchange_bytes", 0)
    return out


def lines_of(results):
    lines = ["| data set | cells or bricks | invisible: default / sparse | sparse, ms: skipped / not | opaque, ms: 1e-2 / 1e-5 | "
             "exchanged, MB: runs / segments |", "|---|---|---|---|---|---|"]
    for r in results:
        c, s = r["default"][0], r["sparse"][0]
        total, skipped = ("bricks_total", "bricks_invisible") if r["volume"] else ("tets_total", "tets_invisible")
        share = lambda x: f"{100 * x[skipped] / max(x[total], 1):.0f} %"
        sent = f"{r['runs'] / 1e6:.1f} / {r['segments'] / 1e6:.1f}" if "runs" in r else "-"
        lines.append(f"| {r['name']} | {c[total]} | {share(c)} / {share(s)} | {r['sparse'][1]:.0f} / {r['not skipped'][1]:.0f} | "
                     f"{r['opaque 1e-2'][1]:.0f} / {r['opaque 1e-5'][1]:.0f} | {sent} |")
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
