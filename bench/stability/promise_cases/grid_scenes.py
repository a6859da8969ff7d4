# SPDX-License-Identifier: BSD-3-Clause
"""Grids with everything that can be drawn in them, at random: iso-surfaces, clips, light on the matter, any view, some on
two or three ranks. Some pixels are compared with _oracle.py, which is independent of the program's reference.
"""
import math

from promise_cases import _oracle, files
from promise_cases.mesh_scenes import drawn, function, pixel_of, seen


def case(r, folder, tessera):
    counts = [r.randint(2, 6) for _ in range(3)]
    kind = r.choice(("Float32", "Float64", "UInt8"))
    values = [r.random() for _ in range(math.prod(counts))]
    values = [round(255 * v) for v in values] if kind == "UInt8" else [files.float32(v) for v in values] if kind == "Float32" else values
    reach = 255.0 if kind == "UInt8" else 1.0
    spacing, origin = [2 / (n - 1) for n in counts], [-1.0] * 3
    path = files.write_vti(folder / "grid.vti", counts, values, kind=kind, spacing=spacing, origin=origin)
    args, scene, words = drawn(r, True, reach)
    return {"input": [path], "function": function(r, reach), "args": args, "oracle": (counts, spacing, origin, values), "scene": scene, "on_ranks": [],
            **seen(r, 6), "words": f"{kind}, {'x'.join(map(str, counts))}{''.join(', ' + w for w in words)}"}


def check(case, methods, tally):
    return _oracle.check(case, methods, tally, 1e-5, pixel_of(case.made))
