#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Error of --compositor gl-fragment by depth complexity: 16-bit framebuffer (as printed) and 32-bit.

Cubes of more and more cells along the ray, and one stack of 20,000; all with the same optical depth. The error is the maximum
over pixels and channels compared with the CPU's `sampled` with the same number of samples. Prints a markdown table and writes an
SVG if requested.
"""
import argparse
import array
import json
import math
import os
import subprocess
import tempfile


def read_pfm(path):
    with open(path, "rb") as file:
        file.readline(), file.readline(), file.readline()
        values = array.array("f")
        values.frombytes(file.read())
    return values


def svg(rows, path):
    width, height, left, bottom = 640, 400, 70, 50
    x = lambda d: left + (width - left - 20) * math.log10(d) / math.log10(40000)
    y = lambda e: 20 + (height - 20 - bottom) * (0 - math.log10(max(e, 1e-8))) / 8
    text = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
            'font-family="sans-serif" font-size="12">',
            f'<rect width="{width}" height="{height}" fill="white"/>']
    for power in range(0, 9, 1):
        at = y(10**-power)
        text.append(f'<line x1="{left}" y1="{at:.1f}" x2="{width - 20}" y2="{at:.1f}" stroke="#ddd"/>'
                    f'<text x="{left - 8}" y="{at + 4:.1f}" text-anchor="end">1e-{power}</text>')
    for power in range(0, 5):
        at = x(10**power)
        text.append(f'<text x="{at:.1f}" y="{height - bottom + 18}" text-anchor="middle">{10**power}</text>')
    text.append(f'<text x="{width / 2}" y="{height - 10}" text-anchor="middle">most ray segments of a pixel</text>')
    for column, color, name in ((1, "#c33", "16-bit framebuffer"), (2, "#36c", "32-bit framebuffer")):
        points = [(x(r[0]), y(r[column])) for r in rows]
        text.append(f'<polyline fill="none" stroke="{color}" stroke-width="2" points="' +
                    " ".join(f"{a:.1f},{b:.1f}" for a, b in points) + '"/>')
        text.append("".join(f'<circle cx="{a:.1f}" cy="{b:.1f}" r="3" fill="{color}"/>' for a, b in points))
        text.append(f'<text x="{points[-1][0]:.1f}" y="{points[-1][1] - 8:.1f}" text-anchor="end" fill="{color}">{name}</text>')
    text.append("</svg>\n")
    open(path, "w").write("\n".join(text))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tessera", default="build/release/apps/tessera")
    parser.add_argument("--backend", default="osmesa")
    parser.add_argument("--svg", default="")
    arguments = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        function, mesh = os.path.join(folder, "tf.txt"), os.path.join(folder, "m.tets")
        # Colour and extinction vary; a ray through two units has an optical depth of about two.
        open(function, "w").write("0 0.9 0.2 0.1 0.6\n0.5 0.2 0.9 0.3 1\n1 0.1 0.3 0.9 1.4\n")
        for kind, parameters, size in (
            [("cube", [f"n={n}"], "24x24") for n in (1, 2, 4, 8, 16, 32, 64)] +
            [("stack", [f"layers={n}", "width=0.2"], "8x8") for n in (1000, 5000, 20000)]):
            subprocess.run([arguments.tessera, "generate", kind, mesh, "--quiet"] + parameters, check=True)
            pictures = []
            for options in ([], ["--compositor", "gl-fragment"], ["--compositor", "gl-fragment", "--framebuffer", "float"]):
                picture, report = os.path.join(folder, f"{len(pictures)}.pfm"), os.path.join(folder, "report.json")
                if options:
                    options = options + ["--backend", arguments.backend]
                subprocess.run([arguments.tessera, "render", mesh, "-o", picture, "--size", size, "--quiet",
                                "--transfer-function", function, "--integrator", "sampled:4", "--tile-size", "8",
                                "--report", report] + options, check=True)
                pictures.append(read_pfm(picture))
            frame = json.load(open(report))["frames"][0]
            depth = frame["counters"].get("most_segments_of_a_pixel")
            if not depth:
                depth = int(parameters[0].split("=")[1]) * (2 if kind == "stack" else 3)  # a voxel's six tets: about three per ray
            errors = [max(abs(a - b) for a, b in zip(pictures[0], p)) for p in pictures[1:]]
            rows.append((depth, *errors))
    print("| ray segments of the deepest pixel, about | 16-bit framebuffer | 32-bit framebuffer |\n|---|---|---|")
    for depth, half, whole in rows:
        print(f"| {depth} | {half:.1e} | {whole:.1e} |")
    if arguments.svg:
        svg(rows, arguments.svg)


if __name__ == "__main__":
    main()
