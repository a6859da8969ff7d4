# SPDX-License-Identifier: BSD-3-Clause
"""Meshes with everything that can be drawn in them, at random: iso-surfaces, the boundary, clips, a threshold, light on the matter,
point and cell data, any view, some on two or three ranks. Some pixels are compared with _oracle.py, which is independent
of the program's reference.
"""
from promise_cases import _oracle, files
from promise_cases.perspective_ties import direction, dot, plus
from promise_cases.plateau_meshes import mesh

NAMES = {"red": (1.0, 0.0, 0.0), "blue": (0.0, 0.0, 1.0), "yellow": (1.0, 1.0, 0.0)}


def any_camera(r, size):
    towards, at = direction(r), [r.uniform(-0.3, 0.3) for _ in range(3)]
    while True:
        up = direction(r)
        if abs(dot(up, towards)) < 0.9:
            break
    lens = {"scale": r.uniform(0.5, 1.6)} if r.random() < 0.5 else {"angle": r.uniform(20, 90)}
    return _oracle.Camera(plus(at, (-r.uniform(2.5, 5), towards)), at, up, size, size, **lens)


def function(r, reach=1.0):
    dense = 10 ** r.uniform(-1, 1)
    values = sorted({0.0, 1.0, *(r.random() for _ in range(r.choice((0, 1, 4))))})
    return [(reach * v, r.random(), r.random(), r.random(), 0.0 if r.random() < 0.2 else dense * r.random()) for v in values]


def drawn(r, has_points, reach=1.0):
    """(arguments, the same for _oracle.py, words) of what is drawn: surfaces, clips, light; point data only have gradients."""
    args, scene, words = [], {}, []
    if has_points and r.random() < 0.5:
        surfaces = [(reach * r.uniform(0.1, 0.9), name, r.choice((0.3, 0.6, 1.0))) for name in r.sample(sorted(NAMES), r.randint(1, 3))]
        args += [f"--iso={v!r}:{name}:{opacity}" for v, name, opacity in surfaces]
        scene["iso"] = [(v, NAMES[name], opacity) for v, name, opacity in surfaces]
        words.append(f"{len(surfaces)} surfaces")
    if r.random() < 0.4:
        scene["planes"] = [([r.uniform(-0.5, 0.5) for _ in range(3)], direction(r)) for _ in range(r.randint(1, 2))]
        args += ["--clip=" + ",".join(repr(float(x)) for x in (*point, *normal)) for point, normal in scene["planes"]]
        words.append(f"{len(scene['planes'])} clips")
    if has_points and r.random() < 0.3:
        scene["shade"] = True
        args.append("--shade")
        words.append("shaded")
    return args, scene, words


def seen(r, pixels):
    """A case's view, pixels to judge, ranks and method."""
    camera = any_camera(r, 16)
    return {"camera": camera.text(), "view": camera, "pixels": sorted(r.sample(range(16 * 16), pixels)), "ranks": r.choice((1, 1, 1, 2, 3)),
            "methods": [r.choice((["--integrator", "exact"], ["--accuracy", "1e-4"], ["--accuracy", "1e-5"]))]}


def case(r, folder, tessera):
    points, tets = mesh(r)
    association = "cell" if r.random() < 0.25 else "point"
    scalars = [r.random() for _ in (points if association == "point" else tets)]
    path = files.write_vtu(folder / "mesh.vtu", points, tets, scalars, association)
    args, scene, words = drawn(r, association == "point")
    if r.random() < 0.3:
        scene["boundary"] = (NAMES["red"], 0.4)
        args += ["--surface", "boundary:red:0.4"]
        words.append("boundary")
    if r.random() < 0.3:
        low, high = sorted((r.uniform(0, 0.4), r.uniform(0.6, 1)))
        kept = [n for n, t in enumerate(tets) if all(low <= s <= high for s in ([scalars[n]] if association == "cell" else [scalars[v] for v in t]))]
        if kept:
            scalars = [scalars[n] for n in kept] if association == "cell" else scalars
            tets = [tets[n] for n in kept]
            args += ["--threshold", f"{low!r},{high!r}"]
            words.append("threshold")
    return {"input": [path], "function": function(r), "args": args, "oracle": (points, tets, scalars, association), "scene": scene,
            "on_ranks": ["--without", "sharing"], **seen(r, 24), "words": f"{len(tets)} tets, {association} data{''.join(', ' + w for w in words)}"}


def pixel_of(made, **more):
    """The oracle's RGB of a pixel, by its number; `more` arguments of mesh_pixel() and grid_pixel() replace the scene's."""
    is_grid = made["input"][0].suffix == ".vti"
    pixel, of = (_oracle.grid_pixel, _oracle.Grid) if is_grid else (_oracle.mesh_pixel, _oracle.Mesh)
    data, knots = of(*made["oracle"]), _oracle.Function(made["function"])
    return lambda n: pixel(data, knots, made["view"], n, **{**made["scene"], **more})


def check(case, methods, tally):
    return _oracle.check(case, methods, tally, 2e-5, pixel_of(case.made))
