#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Times `tessera render` compared with VTK's unstructured-grid ray caster: same mesh, view, transfer function, machine, run.

    bench/tets.py [--tessera build/release/apps/tessera] [--cubes 32,64] [--repeat 7] [--vtk-repeat 2]
                  [--verify 200] [--json bench/tets.json] [--results docs/RESULTS.md]

Makes `tessera generate cube` meshes, renders each with the integrators `exact` and `auto` and with VTK's full and
partial pre-integration (bench/peers/vtk_raycast.py under xvfb-run), and writes a table of times, ratios and errors.
Errors: Tessera's against the double-precision reference at `--verify` random pixels; VTK's against Tessera's `exact`
image, all pixels, linear RGB. `--no-vtk` leaves VTK out. The results file gets its own section, replaced by the
next run; text outside its marks is kept.
"""
import argparse
import datetime
import json
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

import results_file

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent


def run(command, **options):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, **options)
    if done.returncode != 0:
        sys.exit(f"tets.py: {' '.join(str(c) for c in command)}\n{done.stderr.strip()}")
    return done.stdout


def machine(tessera):
    """The context without which a figure has no meaning."""
    cpu, cores = results_file.processor()
    facts = {"cpu": cpu, "cores": cores, "date": datetime.date.today().isoformat(), "commit": results_file.commit()}
    for folder in tessera.resolve().parents:
        cache = folder / "CMakeCache.txt"
        if not cache.exists():
            continue
        entries = dict(re.findall(r"^(\w+):\w+=(.*)$", cache.read_text(), re.M))
        build = entries.get("CMAKE_BUILD_TYPE", "")
        compiler = run([entries["CMAKE_CXX_COMPILER"], "--version"]).splitlines()[0]
        flags = f"{entries.get('CMAKE_CXX_FLAGS', '')} {entries.get('CMAKE_CXX_FLAGS_' + build.upper(), '')}".split()
        facts |= {"compiler": compiler, "build": build, "flags": " ".join(flags)}
        break
    return facts


def time_tessera(args, mesh, integrator, folder):
    picture, report = folder / f"{mesh.stem}-{integrator}.pfm", folder / f"{mesh.stem}-{integrator}.json"
    run([args.tessera, "render", mesh, "-o", picture, "--camera", HERE / "camera.txt", "--transfer-function",
         HERE / "transfer_function.txt", "--integrator", integrator, "--repeat", args.repeat, "--verify", args.verify,
         "--report", report, "--quiet"])
    frame = json.loads(report.read_text())["frames"][0]
    verify = frame["verify"]
    return {"renderer": f"Tessera `{integrator}`", "frame_ms": frame["frame_ms"], "max_error": verify["max_error"],
            "rms_error": verify["rms_error"], "segments": frame["counters"]["segments"],
            "tets": frame["counters"]["tets_total"], "instruction_set": frame["instruction_set"],
            "picture": str(picture)}


def time_vtk(args, mesh, integrator, folder):
    picture, figures = folder / f"{mesh.stem}-vtk-{integrator}.pfm", folder / f"{mesh.stem}-vtk-{integrator}.json"
    run(["xvfb-run", "-a", args.vtk_python, HERE / "peers" / "vtk_raycast.py", mesh, "--camera", HERE / "camera.txt",
         "--transfer-function", HERE / "transfer_function.txt", "--integrator", integrator, "--repeat", args.vtk_repeat,
         "--threads", os.cpu_count(), "--output", picture, "--json", figures])
    return json.loads(figures.read_text()) | {"picture": str(picture)}


def vtk_errors(args, vtk, exact):
    """Maximum and RMS of the difference of two images; numpy is only in VTK's Python."""
    script = ("import sys; sys.path.insert(0, sys.argv[1]); from vtk_raycast import *; "
              "d = np.abs(read_pfm(sys.argv[2]) - read_pfm(sys.argv[3])); print(d.max(), np.sqrt((d.astype(float) ** 2).mean()))")
    words = run([args.vtk_python, "-c", script, HERE / "peers", vtk["picture"], exact["picture"]]).split()
    vtk["max_error"], vtk["rms_error"] = float(words[0]), float(words[1])


def table(runs):
    """A row per mesh, a cell per renderer: median (minimum) of its frames, ratio to the first, errors."""
    names = [r["renderer"] for r in runs[0]["renderers"]]
    lines = ["| mesh | " + " | ".join(names) + " |", "|---" * (len(names) + 1) + "|"]
    for mesh in runs:
        base, cells = statistics.median(mesh["renderers"][0]["frame_ms"]), []
        for r in mesh["renderers"]:
            median, least = statistics.median(r["frame_ms"]), min(r["frame_ms"])
            times = "" if r is mesh["renderers"][0] else f"{median / base:.1f}x, "
            cells.append(f"{median:.0f} ({least:.0f}), {times}{results_file.error(r['max_error'])}, {results_file.error(r['rms_error'])}")
        lines.append(f"| {mesh['mesh']}, {1e-6 * mesh['tets']:.2f} M tets | " + " | ".join(cells) + " |")
    return lines


def write_results(path, results):
    m = results["machine"]
    caption = (f"{results_file.made(results['load_before'])} {m.get('compiler', '')}, {m.get('build', '')} ({m.get('flags', '')}), "
               f"kernels {results['instruction_set']}, all cores. `{results['command']}`: frame, median (least) [ms]; "
               "times the first renderer's median; maximum and RMS error")
    results_file.put(path, "tets.py", caption, table(results["runs"]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tessera", type=pathlib.Path, default=ROOT / "build" / "release" / "apps" / "tessera")
    parser.add_argument("--cubes", default="32,64")
    parser.add_argument("--repeat", type=int, default=7)
    parser.add_argument("--vtk-repeat", type=int, default=2)
    parser.add_argument("--verify", type=int, default=200)
    parser.add_argument("--vtk-python", default="/usr/bin/python3")
    parser.add_argument("--no-vtk", action="store_true")
    parser.add_argument("--json", type=pathlib.Path)
    parser.add_argument("--results", type=pathlib.Path)
    args = parser.parse_args()
    if not args.tessera.exists():
        sys.exit(f"tets.py: {args.tessera}: no such program; build it or name it with --tessera")
    if not args.no_vtk and not shutil.which("xvfb-run"):
        sys.exit("tets.py: xvfb-run is missing; install xvfb and python3-vtk9, or give --no-vtk")

    results = {"command": results_file.command("tets.py"), "machine": machine(args.tessera),
               "load_before": os.getloadavg()[0], "runs": []}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for n in args.cubes.split(","):
            mesh = folder / f"cube{n}.tets"
            run([args.tessera, "generate", "cube", mesh, f"n={n}", "--quiet"])
            ours = [time_tessera(args, mesh, i, folder) for i in ("exact", "auto")]
            peers = [] if args.no_vtk else [time_vtk(args, mesh, i, folder) for i in ("full", "partial")]
            for peer in peers:
                vtk_errors(args, peer, ours[0])
            results["instruction_set"] = ours[0]["instruction_set"]
            results["runs"].append({"mesh": f"cube {n}", "tets": ours[0]["tets"], "segments": ours[0]["segments"],
                                    "renderers": ours + peers})
            print("\n".join(table(results["runs"][-1:])), flush=True)
    results["load_after"] = os.getloadavg()[0]
    for r in (r for one in results["runs"] for r in one["renderers"]):
        del r["picture"]
    if args.json:
        args.json.write_text(json.dumps(results, indent=1) + "\n")
    if args.results:
        write_results(args.results, results)


if __name__ == "__main__":
    main()
