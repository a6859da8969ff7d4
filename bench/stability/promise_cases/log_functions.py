# SPDX-License-Identifier: BSD-3-Clause
"""Functions of up to some hundred knots that are spaced logarithmically, on meshes and grids whose values span up to thirty
decades, of any magnitude from 1e-30 to 1e30: most knots are in a very small part of the range.

In addition to the promise an image must be finished in time: `promises.py` gives each a limit.
"""
import math

from promise_cases import files
from promise_cases.plateau_meshes import camera, mesh


def knots_by_logarithm(r, decades, size, dense):
    count = r.choice((5, 40, 256, 700))
    knots = []
    for n in range(count):
        x = n / (count - 1)
        wave = 0.5 + 0.5 * math.sin(r.choice((3, 17)) * x)
        knots.append((size * 10 ** (decades * (x - 1)), x, wave, 1 - x, dense * (x if r.random() < 0.9 else 0)))
    return knots


def case(r, folder, tessera):
    decades, size = r.choice((2, 4, 8, 8, 16, 30)), r.choice((1.0, 1.0, 1e-30, 1e30, 10 ** r.uniform(-30, 30)))
    kind = "Float64" if not 1e-25 < size * 10 ** -decades < size < 1e30 else r.choice(("Float32", "Float64"))
    rounded = files.float32 if kind == "Float32" else float
    rough = r.random() < 0.5
    value = lambda u: rounded(size * 10 ** (-decades * (r.random() if rough else min(1, max(0, u)))))
    if r.random() < 0.5:
        points, tets = mesh(r)
        made = {"input": [files.write_vtu(folder / "mesh.vtu", points, tets, [value(0.5 + 0.5 * p[0]) for p in points], kind=kind)],
                "camera": camera(r, 16)}
        length = 2.0
    else:
        counts = [r.randint(2, 8) for _ in range(3)]
        values = [value(i / counts[0]) for k in range(counts[2]) for j in range(counts[1]) for i in range(counts[0])]
        spacing = [2 / (n - 1) for n in counts]
        made = {"input": [files.write_vti(folder / "grid.vti", counts, values, kind=kind, spacing=spacing, origin=(-1, -1, -1))],
                "camera": camera(r, 16)}
        length = 2.0
    made["function"] = knots_by_logarithm(r, decades, size, 10 ** r.uniform(-1, 1.5) / length)
    made["words"] = f"{kind}, {decades} decades up to {size:.3g}, {len(made['function'])} knots, {'rough' if rough else 'smooth'}"
    return made
