# SPDX-License-Identifier: BSD-3-Clause
"""Grids with everything that can be drawn in them, at random: iso-surfaces, clips, light on the matter, any view, some on
two or three ranks. Some pixels are compared with _oracle.py, which is independent of the program's reference.
"""
import math

from promise_cases import _oracle, files
from promise_cases.mesh_scenes import NAMES, WORDS, any_camera
from promise_cases.plateau_meshes import direction


def case(r, folder, tessera):
    counts = [r.randint(2, 6) for _ in range(3)]
    kind = r.choice(("Float32", "Float64", "UInt8"))
    values = [r.random() for _ in range(math.prod(counts))]
    values = [round(255 * v) for v in values] if kind == "UInt8" else [files.float32(v) for v in values] if kind == "Float32" else values
    reach = 255.0 if kind == "UInt8" else 1.0
    spacing, origin = [2 / (n - 1) for n in counts], [-1.0] * 3
    path = files.write_vti(folder / "grid.vti", counts, values, kind=kind, spacing=spacing, origin=origin)
    dense = 10 ** r.uniform(-1, 1)
    at = sorted({0.0, 1.0, *(r.random() for _ in range(r.choice((0, 1, 4))))})
    knots = [(reach * v, r.random(), r.random(), r.random(), 0.0 if r.random() < 0.2 else dense * r.random()) for v in at]
    args, scene, words = [], {}, []
    if r.random() < 0.5:
        surfaces = [(reach * r.uniform(0.1, 0.9), name, r.choice((0.3, 0.6, 1.0))) for name in r.sample(sorted(NAMES), r.randint(1, 3))]
        args += [f"--iso={v!r}:{name}:{opacity}" for v, name, opacity in surfaces]
        scene["iso"] = [(v, NAMES[name], opacity) for v, name, opacity in surfaces]
        words.append(f"{len(surfaces)} surfaces")
    if r.random() < 0.4:
        scene["planes"] = [([r.uniform(-0.5, 0.5) for _ in range(3)], direction(r)) for _ in range(r.randint(1, 2))]
        for point, normal in scene["planes"]:
            args.append(f"--clip={WORDS([*point, *normal])}")
        words.append(f"{len(scene['planes'])} clips")
    if r.random() < 0.3:
        scene["shade"] = True
        args.append("--shade")
        words.append("shaded")
    size = 16
    camera = any_camera(r, size)
    return {"input": [path], "function": knots, "camera": camera.text(), "args": args, "oracle": (counts, spacing, origin, values),
            "view": camera, "scene": scene, "pixels": sorted(r.sample(range(size * size), 6)), "ranks": r.choice((1, 1, 1, 2, 3)), "on_ranks": [],
            "methods": [r.choice((["--integrator", "exact"], ["--accuracy", "1e-4"], ["--accuracy", "1e-5"]))],
            "words": f"{kind}, {'x'.join(map(str, counts))}{''.join(', ' + w for w in words)}"}


def check(case, methods, tally):
    made = case.made
    grid, function = _oracle.Grid(*made["oracle"]), _oracle.Function(made["function"])
    return _oracle.check(case, methods, tally, 1e-5,
                         lambda n: _oracle.grid_pixel(grid, function, made["view"], n, **made["scene"]))
