#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Varies one parameter after the other until a method breaks.

    bench/stability/stability.py [--only WORD,...] [--reduced] [--large] [--json FILE [--resume]] [--write]

Each image is judged by `--verify` against the double-precision reference of the same scene. For every method: the
first value at which its error exceeds 1e-3, and the first at which it fails completely (no image, NaN, a crash). Partitions
over MPI are compared with one process (partitions.py). Exits with status 1 if the default breaks its promise anywhere: 1e-4,
except for excused pixels, which may be 1e-4 of all that were examined. `--reduced`: the first and last value of each
stress, only the default method; used by the tests. `--large`: also images of 16384 x 16384 (6 GB, minutes). `--resume`:
results already in the file of `--json` are not computed again, and all of it goes into the document; so an interrupted run, or
a single changed stress (removed from FILE), needs no complete run. `--write` writes docs/RESULTS.md and docs/images/stability.svg.
"""
import argparse
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import time

import partitions
import scenes

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from results import ROOT, Section  # noqa: E402

MESH = {"default": [], "exact": ["--integrator", "exact"], "partial": ["--integrator", "partial"],
        "preintegrated:128": ["--integrator", "preintegrated"], "sampled:4": ["--integrator", "sampled:4"],
        "paper (scanline, sampled:8)": ["--rasterizer", "scanline", "--integrator", "sampled:8"]}
GRID = {"default": [], "exact": ["--integrator", "exact"],
        "sampled, 0.5": ["--integrator", "sampled", "--step", "0.5"],
        "sampled, 10": ["--integrator", "sampled", "--step", "10"],
        "preintegrated, 0.5": ["--integrator", "preintegrated", "--step", "0.5"]}
BAD = 1e-3


def shows(picture):
    """Whether anything is visible in a .pfm; None for one that is too large to check."""
    if picture.stat().st_size > 1e8:
        return None
    body = picture.read_bytes().split(b"\n", 3)[3]
    return any(body)


class Runner:
    def __init__(self, program, folder, threads):
        self.program, self.folder, self.threads = program, folder, threads

    def generate(self, *words):
        subprocess.run([str(self.program), *map(str, words)], check=True, capture_output=True, text=True)

    def render(self, scene, words):
        report = self.folder / "report.json"
        command = [self.program, "render", scene["input"], "-o", self.folder / "picture.pfm", *scene["args"], *words,
                   "--verify", scene["verify"], "--report", report, "--quiet", "--threads", self.threads]
        command = [str(w) for w in command]
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=scene.get("seconds", 300))
        except subprocess.TimeoutExpired as late:
            return {"failed": f"no picture within {late.timeout:g} s", "command": command}
        if done.returncode not in (0, 4):
            return {"failed": done.stderr.strip().split("\n")[-1] or f"status {done.returncode}", "status": done.returncode,
                    "command": command}
        judged = json.loads(report.read_text())["frames"][0]
        verify = judged["verify"]
        error = verify["max_error"] if verify["max_error"] is not None else math.inf
        # Without a bound no pixel is examined for an excuse.
        bound = verify.get("bound")
        return {"error": verify["max_error_not_excused"] if bound else error, "met": verify["met"], "excused": verify["excused"],
                "pixels": verify["pixels"], "bound": bound, "ms": min(judged["frame_ms"]),
                "arithmetic": judged.get("arithmetic"), "shows": shows(self.folder / "picture.pfm"), "command": command}


def exponent(x):
    """1e-7: one digit."""
    return f"{x:.0e}".replace("e-0", "e-").replace("e+00", "")


def value_words(v):
    return v if isinstance(v, str) else f"{v:g}"


def verdicts(results):
    """(first value above BAD, first value that fails outright)"""
    worse = next((r["value"] for r in results if r.get("error", 0) > BAD or "failed" in r), None)
    failed = next((r["value"] for r in results if "failed" in r or not math.isfinite(r.get("error", 0))), None)
    return worse, failed


def steady(method):
    """Whether the parameter changes nothing: all values pass, or all fail alike."""
    errors = [r["error"] for r in method["results"] if "failed" not in r]
    return not errors or len(errors) == len(method["results"]) and (max(errors) <= BAD or errors[0] > BAD and max(errors) < 2 * errors[0])


def words_of(method):
    """A cell of the tables: the largest error, bold where it is above BAD, and from which value on."""
    results = method["results"]
    worst = max((r.get("error", math.inf) for r in results if "failed" not in r), default=0)
    if method["fails"] is not None and all("failed" in r for r in results):
        return "refused"
    words = exponent(worst)
    if method["above_1e-3"] is not None:
        words = f"**{words}**"
        if method["above_1e-3"] != results[0]["value"] or "failed" in results[0]:
            words += f" from {method['above_1e-3']}"
    return words + (f", fails at {method['fails']}" if method["fails"] is not None else "")


def measure(args, folder):
    runner = Runner(args.tessera, folder, args.threads)
    maker = scenes.Maker(folder, runner.generate)
    out, broken = [], []
    before = json.loads(args.json.read_text()) if args.resume and args.json.exists() else {"stresses": [], "partitions": []}
    earlier = {(s["kind"], s["name"]): s for s in before["stresses"]}
    kinds = [("mesh", scenes.mesh_stresses(maker) + (scenes.large_stresses(maker) if args.large else []), MESH),
             ("grid", scenes.volume_stresses(maker), GRID), ("printed", scenes.printed_stresses(maker), scenes.PRINTED)]
    for kind, stresses, methods in kinds:
        if args.reduced and kind == "printed":
            continue
        for name, parameter, values, make in stresses:
            if (kind, name) in earlier:
                out.append(earlier[kind, name])
                broken += default_broken(out[-1])
                continue
            if args.only and not any(w in name for w in args.only.split(",")):
                continue
            if args.reduced:
                values = [v for v in (values[0], values[-1])]
                if name in ("depth complexity", "opacity 1e-9 a segment"):
                    values = [1.0, 1e3]
            stress = {"kind": kind, "name": name, "parameter": parameter, "values": [value_words(v) for v in values], "methods": {}}
            made = {}
            for value in values:
                try:
                    made[value] = make(value)
                except subprocess.CalledProcessError as error:
                    made[value] = error.stderr.strip()
            for method, words in methods.items():
                if args.reduced and method != "default":
                    continue
                results, begin = [], time.monotonic()
                for value in values:
                    if isinstance(made[value], str):
                        result = {"failed": made[value]}
                    elif made[value]["methods"] and method not in made[value]["methods"]:
                        continue
                    else:
                        result = runner.render(made[value], words)
                    result["value"] = value_words(value)
                    results.append(result)
                if not results:
                    continue
                worse, failed = verdicts(results)
                for r in results:
                    if "command" in r:
                        r["command"] = " ".join(w.replace(str(folder), "FOLDER") for w in r["command"][1:])
                stress["methods"][method] = {"results": results, "above_1e-3": worse, "fails": failed}
                worst = max((r.get("error", math.inf) for r in results), default=0)
                print(f"{name:24s} {method:28s} worst {worst:9.2e}  above 1e-3: {worse}  fails: {failed}  "
                      f"{time.monotonic() - begin:.0f} s", flush=True)
            out.append(stress)
            broken += default_broken(stress)
            save(args, out, before["partitions"])
    rows = before["partitions"]
    if not rows and (not args.only or any(w in "partitions" for w in args.only.split(","))):
        rows = [] if args.reduced else partitions.measure(args.tessera, maker, folder)
    for row in rows:
        if not partitions.kept(row):
            broken.append(("partition", row["partition"], {"failed": json.dumps(row)}))
    return out, rows, broken


def default_broken(stress):
    return [(stress["name"], r["value"], r) for r in stress["methods"].get("default", {"results": []})["results"]
            if "failed" in r or not r["error"] <= r["bound"]]


def save(args, stresses, rows):
    if args.json:
        args.json.write_text(json.dumps({"stresses": stresses, "partitions": rows}, indent=1))


def excused_of(stresses):
    """(excused, pixels) of the default."""
    excused, pixels = 0, 0
    for s in stresses:
        for r in s["methods"].get("default", {"results": []})["results"]:
            if "pixels" in r:
                excused, pixels = excused + r["excused"], pixels + r["pixels"]
    return excused, pixels


def values_of(stress):
    return f"{stress['values'][0]}…{stress['values'][-1]}"


def largest(method, stresses):
    return exponent(max((r.get("error", math.inf) for s in stresses for r in s["methods"].get(method, {"results": []})["results"]), default=0))


def document(section, stresses, rows):
    section.text("![error against each stress's parameter](images/stability.svg)")
    for kind, title in (("mesh", "Meshes"), ("grid", "Regular grids")):
        mine = [s for s in stresses if s["kind"] == kind]
        methods = [m for m in dict.fromkeys(m for s in mine for m in s["methods"]) if m != "exact"]
        still = [s for s in mine if all(map(steady, s["methods"].values()))]
        section.text(f"### {title}")
        if still:
            section.text("These stresses change no method's result (their parameters are in brackets): " + "; ".join(f"{s['name']} ({s['parameter']}, {values_of(s)})" for s in still) + ". In these tests, the default's "
                         f"errors reach {largest('default', still)}; those of `exact` in this section reach {largest('exact', mine)}.")
        section.table("l" * (2 + len(methods)), "stress, parameter", "values", *methods)
        for s in mine:
            if s not in still:
                section.row(f"{s['name']}: {s['parameter']}", values_of(s), *(words_of(s["methods"][m]) if m in s["methods"] else "" for m in methods))
    section.text("### Limits of the published methods")
    section.text("Each row provokes one limit of a published method; the default is given for comparison.")
    section.table("lll", "limit, parameter", "values", "largest errors")
    for s in stresses:
        if s["kind"] == "printed":
            section.row(f"{s['name']}: {s['parameter']}", values_of(s), "; ".join(f"{m}: {words_of(d)}" for m, d in s["methods"].items()))
    section.text("### Partitions over MPI")
    section.text("The images are compared with that of one process with the whole mesh. `segments` promises the same bits, `runs` differences of at most 2e-6.")
    section.table("lll", "partitions (ranks)", "`segments`: the same bits", "`runs`: largest difference")
    alike = {}
    for r in rows:
        found = ("**failed**", r["failed"]) if "failed" in r else ("yes" if r["same_bits"] else "**no**", f"{r['runs_difference']:.1e}")
        alike.setdefault(found, []).append(f"{r['partition']} ({r['ranks']})")
    for found, names in alike.items():
        section.row("; ".join(names), *found)
    section.keep()


COLORS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7f7f7f", "#000000"]


def chart(s, x0, y0, width, height, color):
    """One stress, with its plot's upper left corner at (x0, y0)."""
    low, high = -9, 1
    y = lambda e: y0 + height * (high - min(max(math.log10(max(e, 1e-300)), low), high)) / (high - low)
    out = [f'<text x="{x0}" y="{y0 - 5}" font-size="10.5">{s["name"]}</text>']
    for power in (-9, -6, -3, 0):
        at = y(10.0 ** power)
        out.append(f'<line x1="{x0}" x2="{x0 + width}" y1="{at:.1f}" y2="{at:.1f}" stroke="{"#bbb" if power == -3 else "#e4e4e4"}"/>'
                   f'<text x="{x0 - 3}" y="{at + 3:.1f}" text-anchor="end">1e{power}</text>')
    count = len(s["values"])
    x = lambda i: x0 + width * (i + 0.5) / count
    for i, value in enumerate(s["values"]):
        if i in (0, count - 1) or (count <= 4 and max(map(len, s["values"])) < 8):
            out.append(f'<text x="{x(i):.1f}" y="{y0 + height + 11}" text-anchor="middle">{value}</text>')
    out.append(f'<text x="{x0 + width / 2}" y="{y0 + height + 23}" text-anchor="middle" fill="#777">{s["parameter"]}</text>')
    for m, d in reversed(list(s["methods"].items())):
        place = {v: i for i, v in enumerate(s["values"])}
        points = [(x(place[r["value"]]), y(r["error"])) for r in d["results"] if "error" in r]
        out.append(f'<polyline fill="none" stroke="{color[m]}" stroke-width="{2.2 if m == "default" else 1.1}" points="' +
                   " ".join(f"{a:.1f},{b:.1f}" for a, b in points) + '"/>')
        out += [f'<circle cx="{a:.1f}" cy="{b:.1f}" r="1.8" fill="{color[m]}"/>' for a, b in points]
        out += [f'<text x="{x(place[r["value"]]):.1f}" y="{y0 + 6}" text-anchor="middle" font-weight="bold" fill="{color[m]}">x</text>'
                for r in d["results"] if "failed" in r]
    return out


def figure(path, stresses):
    """Small charts: error (logarithmic, 1e-9 and below at the bottom) by the parameter's values, in order; a cross at the
    top is a failure. Colours depend on the section."""
    columns, w, h, top, out = 4, 235, 150, 10, []
    for kind, title in (("mesh", "Meshes"), ("grid", "Regular grids"), ("printed", "Limits of the published methods")):
        mine = [s for s in stresses if s["kind"] == kind]
        if not mine:
            continue
        methods = list(dict.fromkeys(m for s in mine for m in s["methods"]))
        color = {m: COLORS[i % len(COLORS)] for i, m in enumerate(methods)}
        out.append(f'<text x="20" y="{top + 14}" font-size="14" font-weight="bold">{title}</text>')
        for i, m in enumerate(methods):
            x0, y0 = 20 + 235 * (i % 4), top + 24 + 16 * (i // 4)
            out.append(f'<rect x="{x0}" y="{y0}" width="10" height="10" fill="{color[m]}"/><text x="{x0 + 14}" y="{y0 + 9}" font-size="11">{m}</text>')
        top += 24 + 16 * ((len(methods) + 3) // 4) + 10
        for n, s in enumerate(mine):
            out += chart(s, 46 + (n % columns) * w, top + (n // columns) * h + 14, w - 44, h - 52, color)
        top += h * ((len(mine) + columns - 1) // columns) + 10
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" width="{columns * w + 20}" height="{top}" font-family="sans-serif" '
                    'font-size="9"><rect width="100%" height="100%" fill="white"/>' + "\n".join(out + ["</svg>\n"]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tessera", type=pathlib.Path, default=ROOT / "build/release/apps/tessera")
    parser.add_argument("--only", help="words in stresses' names")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--reduced", action="store_true")
    parser.add_argument("--large", action="store_true", help="pictures of 16384 x 16384 too")
    parser.add_argument("--json", type=pathlib.Path)
    parser.add_argument("--resume", action="store_true", help="keep what --json holds")
    parser.add_argument("--write", action="store_true", help="write the tables and the figure into docs/")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        start, section = time.monotonic(), Section(args)
        stresses, rows, broken = measure(args, pathlib.Path(folder))
    save(args, stresses, rows)
    if args.write:
        document(section, stresses, rows)
        figure(ROOT / "docs" / "images" / "stability.svg", stresses)
    for name, value, result in broken:
        print(f"default BROKEN: {name} at {value}: {result.get('failed', result.get('error'))}\n    {result.get('command', '')}")
    excused, pixels = excused_of(stresses)
    for s in stresses:
        empty = [r["value"] for r in s["methods"].get("default", {"results": []})["results"] if r.get("shows") is False]
        if empty:
            print(f"nothing to see: {s['name']} at {', '.join(empty)}")
    print(f"{len(stresses)} stresses and {len(rows)} partitions in {time.monotonic() - start:.0f} s, default broken in "
          f"{len(broken)} places; {excused} of {pixels} pixels excused")
    # Three standard deviations of a fraction of 1e-4.
    sys.exit(1 if broken or excused > 1e-4 * pixels + 3 * math.sqrt(1e-4 * pixels) else 0)


if __name__ == "__main__":
    main()
