#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Stage times of the compositors on one mesh in one run: CPU, gl-compute, the same with cells rasterized by the device,
gl-fragment.

Every compositor renders the same image from the same ray segments; stages are self times of its trace (device stages
by the device's own clock, CPU stages summed over threads and divided by their number; the CPU rasterizes cells unless
stated otherwise). gl-fragment is the paper's, and is left out unless the integrator is sampled:N. Prints a
markdown table.
"""
import argparse
import collections
import json
import os
import subprocess
import tempfile

import results_file


def self_times(trace):
    """Milliseconds of each stage, for threads and (without CPU time) for the device's row."""
    rows = collections.defaultdict(list)
    for event in json.load(open(trace))["traceEvents"]:
        if event.get("ph") == "X" and event["name"] != "frame":
            rows[event["tid"]].append(event)
    times, passes = collections.Counter(), collections.Counter()
    for events in rows.values():
        device = all(e["args"].get("cpu_us", 0) == 0 for e in events)
        open_spans = []
        for e in sorted(events, key=lambda e: (e["ts"], -e["dur"])):
            while open_spans and e["ts"] >= open_spans[-1]["ts"] + open_spans[-1]["dur"] - 1e-3:
                open_spans.pop()
            key = (device, e["name"])
            times[key] += e["dur"] / 1e3
            passes[key] += e["args"].get("messages", 0)
            if open_spans:
                times[(device, open_spans[-1]["name"])] -= e["dur"] / 1e3
            open_spans.append(e)
    return times, passes


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tessera", default="build/release/apps/tessera")
    parser.add_argument("--mesh", default="", help="default: cube of --cube voxels a side")
    parser.add_argument("--cube", type=int, default=16)
    parser.add_argument("--size", default="256x256")
    parser.add_argument("--integrator", default="sampled:8")
    parser.add_argument("--backend", default="osmesa")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    here = os.path.dirname(os.path.abspath(__file__))
    with tempfile.TemporaryDirectory() as folder:
        mesh = arguments.mesh
        if not mesh:
            mesh = os.path.join(folder, "cube.tets")
            subprocess.run([arguments.tessera, "generate", "cube", mesh, f"n={arguments.cube}", "--quiet"], check=True)
        cases = [
            ("CPU", []),
            ("gl-compute", ["--compositor", "gl-compute", "--backend", arguments.backend]),
            ("gl-compute, cells on the device",
             ["--compositor", "gl-compute", "--rasterizer", "device", "--backend", arguments.backend]),
        ]
        cases += [] if not arguments.integrator.startswith("sampled") else [
            ("gl-fragment, half", ["--compositor", "gl-fragment", "--backend", arguments.backend]),
            ("gl-fragment, float",
             ["--compositor", "gl-fragment", "--framebuffer", "float", "--backend", arguments.backend]),
        ]
        print(f"{results_file.made(os.getloadavg()[0])}\n`{results_file.command('gl_stages.py')}`\n")
        print("| compositor | frame [ms] | project [ms] | sort [ms] | integrate [ms] | composite [ms] | sort passes |")
        print("|---|---|---|---|---|---|---|")
        for name, options in cases:
            trace, report = os.path.join(folder, "trace.json"), os.path.join(folder, "report.json")
            subprocess.run(
                [arguments.tessera, "render", mesh, "-o", os.path.join(folder, "x.pfm"), "--size", arguments.size,
                 "--camera", os.path.join(here, "camera.txt"),
                 "--transfer-function", os.path.join(here, "transfer_function.txt"), "--quiet",
                 "--integrator", arguments.integrator, "--threads", str(arguments.threads),
                 "--timing", trace, "--report", report] + options, check=True)
            times, passes = self_times(trace)
            frame = json.load(open(report))["frames"][0]
            device = bool(options)
            per = 1 if device else arguments.threads
            cell = lambda stage: f"{times[(device, stage)] / per:.0f}" if times[(device, stage)] else "in composite"
            rasterizes = "device" in options
            project = times[(rasterizes, "project")] / (1 if rasterizes else arguments.threads)
            print(f"| {name} | {frame['frame_ms'][0]:.0f} | {project:.0f} | {cell('sort')} | {cell('integrate')} | "
                  f"{cell('composite')} | {passes[(device, 'sort')] or '-'} |")
        print(f"\n{frame['counters']['segments']} ray segments; {frame['backend']}")


if __name__ == "__main__":
    main()
