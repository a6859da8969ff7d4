#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Error of --compositor gl-fragment by depth complexity: 16-bit framebuffer (as printed) and 32-bit.

Cubes of more and more cells along the ray, and one stack of up to 20,000; all with the same optical depth. The error is the maximum over pixels and channels
compared with the CPU's `sampled` with the same number of samples. The table has four of them; the figure, docs/images/half_error.svg, all.
"""
import array
import math

from results import ROOT, Section, generated, options, render, written

SHOWN = (3, 48, 2000, 40000)


def svg(rows):
    width, height, left, bottom = 640, 400, 70, 50
    x = lambda d: left + (width - left - 20) * math.log10(d) / math.log10(40000)
    y = lambda e: 20 + (height - 20 - bottom) * (0 - math.log10(max(e, 1e-8))) / 8
    text = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="12">',
            f'<rect width="{width}" height="{height}" fill="white"/>']
    for power in range(9):
        at = y(10**-power)
        text.append(f'<line x1="{left}" y1="{at:.1f}" x2="{width - 20}" y2="{at:.1f}" stroke="#ddd"/>'
                    f'<text x="{left - 8}" y="{at + 4:.1f}" text-anchor="end">1e-{power}</text>')
    text += [f'<text x="{x(10**power):.1f}" y="{height - bottom + 18}" text-anchor="middle">{10**power}</text>' for power in range(5)]
    text.append(f'<text x="{width / 2}" y="{height - 10}" text-anchor="middle">most ray segments of a pixel</text>')
    for column, color, name in ((1, "#c33", "16-bit framebuffer"), (2, "#36c", "32-bit framebuffer")):
        points = [(x(r[0]), y(r[column])) for r in rows]
        text.append(f'<polyline fill="none" stroke="{color}" stroke-width="2" points="' + " ".join(f"{a:.1f},{b:.1f}" for a, b in points) + '"/>')
        text.append("".join(f'<circle cx="{a:.1f}" cy="{b:.1f}" r="3" fill="{color}"/>' for a, b in points))
        text.append(f'<text x="{points[-1][0]:.1f}" y="{points[-1][1] - 8:.1f}" text-anchor="end" fill="{color}">{name}</text>')
    return "\n".join([*text, "</svg>\n"])


def main():
    args, rows = options(__doc__, backend="osmesa"), []
    section = Section(args)
    section.table("lll", "ray segments of the deepest pixel, about", "16-bit framebuffer", "32-bit framebuffer")
    # Colour and extinction vary; a ray through two units has an optical depth of about two.
    function = written(args.work / "function.txt", "0 0.9 0.2 0.1 0.6\n0.5 0.2 0.9 0.3 1\n1 0.1 0.3 0.9 1.4\n")
    # A voxel's six tets: about three per ray.
    for depth, size, *data in [(3 * n, "24x24", "cube", f"n={n}") for n in (1, 2, 4, 8, 16, 32, 64)] + [
            (2 * n, "8x8", "stack", f"layers={n}", "width=0.2") for n in (1000, 5000, 20000)]:
        images = []
        for words in ([], *(["--compositor", "gl-fragment", "--backend", args.backend, *more] for more in ([], ["--framebuffer", "float"]))):
            render(args, generated(args, f"{'-'.join(data)}.tets", *data), "--size", size, "--transfer-function", function, "--integrator", "sampled:4",
                   "--tile-size", "8", *words)
            images.append(array.array("f", (args.work / "picture.pfm").read_bytes().split(b"\n", 3)[3]))
        rows.append((depth, *(max(abs(a - b) for a, b in zip(images[0], image)) for image in images[1:])))
        if depth in SHOWN:
            section.row(f"{depth:,}", *(f"{e:.1e}" for e in rows[-1][1:]))
    section.keep()
    if args.write:
        written(ROOT / "docs" / "images" / "half_error.svg", svg(rows))


if __name__ == "__main__":
    main()
