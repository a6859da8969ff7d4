# SPDX-License-Identifier: BSD-3-Clause
"""Grids with --shade or --iso, whose neighbouring values differ little compared with the range: lighting depends on the direction of
the gradient, however small that is.

The image is judged by --verify, and some pixels by a separate oracle: along the ray, voxel by voxel, the trilinear field's
gradient in the middle of each interval lights what a constant function emits there (the light's formula is in
docs/ACCURACY.md). Values are 64-bit and 32-bit floats and integers with a scale.
"""
import math

from promise_cases.files import float32, write_vti
from promise_cases.perspective_ties import cross, dot, unit

COLOR, EXTINCTION = (0.6, 0.2, 0.4), 1.0
TOLERANCE = 1e-5
AMBIENT, DIFFUSE, SPECULAR, SHININESS = 0.2, 0.8, 0.2, 32


def case(r, folder, tessera):
    counts = [r.randint(2, 6) for _ in range(3)]
    spacing = [r.choice((1.0, r.uniform(0.5, 2))) for _ in range(3)]
    kind = r.choice(("Float64", "Float64", "Float32"))
    differences = 10 ** r.uniform(-10 if kind == "Float64" else -6, -1)
    level = r.choice((0.5, r.uniform(0.1, 0.9)))
    low, high = r.choice(((0.0, 1.0), (0.0, 1.0), (-1.0, 1.0)))
    values = [level + differences * r.uniform(-1, 1) for _ in range(math.prod(counts))]
    layer = counts[0] * counts[1]
    if r.random() < 0.7:  # the rest of the range, elsewhere
        values[:layer], values[-layer:] = [low] * layer, [high] * layer
    if kind == "Float32":
        values = [float32(v) for v in values]
    size = 20
    centre = [(n - 1) * s / 2 for n, s in zip(counts, spacing)]
    while True:
        towards = unit([r.uniform(-1, 1) for _ in range(3)])
        if abs(towards[2]) < 0.95:
            break
    far = 3 * math.hypot(*((n - 1) * s for n, s in zip(counts, spacing)))
    eye = [c - far * t for c, t in zip(centre, towards)]
    scale = 0.5 * math.hypot(*((n - 1) * s for n, s in zip(counts, spacing)))
    words = lambda v: " ".join(repr(float(x)) for x in v)
    view = {"eye": eye, "forward": towards, "scale": scale, "size": size}
    has_surface = r.random() < 0.3
    args = ["--iso", f"{level!r}:white:0.4"] if has_surface else []
    return {"input": [write_vti(folder / "grid.vti", counts, values, kind=kind, spacing=spacing)],
            "function": [(low - 1, *COLOR, EXTINCTION), (high + 1, *COLOR, EXTINCTION)], "args": [*args, "--shade"],
            "camera": f"position {words(eye)}\nfocal_point {words(centre)}\nview_up 0 0 1\nparallel_scale {scale!r}\nsize {size} {size}\n",
            "grid": (counts, spacing, values), "view": view, "judge": None if has_surface else sorted(r.sample(range(size * size), 40)),
            "methods": [["--integrator", "exact"], ["--accuracy", "1e-5"]],
            "words": f"{kind}, differences {differences:.3g}, {'surface, ' if has_surface else ''}{'x'.join(map(str, counts))}"}


def oracle(made, number):
    """RGB of a pixel: the voxels along its ray, each with the light of its own gradient."""
    (nx, ny, nz), spacing, values = made["grid"]
    view = made["view"]
    right = unit(cross(view["forward"], (0, 0, 1)))
    up = cross(right, view["forward"])
    pixel = 2 * view["scale"] / view["size"]
    x, y = number % view["size"] + 0.5 - view["size"] / 2, view["size"] / 2 - (number // view["size"] + 0.5)
    origin = [(e + pixel * (x * a + y * b)) / s for e, a, b, s in zip(view["eye"], right, up, spacing)]
    step = [f / s for f, s in zip(view["forward"], spacing)]
    planes = set()
    begin, end = -math.inf, math.inf
    for axis, n in enumerate((nx, ny, nz)):
        if step[axis] == 0:
            if not 0 <= origin[axis] <= n - 1:
                return 0.0, 0.0, 0.0
            continue
        at = sorted((k - origin[axis]) / step[axis] for k in range(n))
        begin, end = max(begin, at[0]), min(end, at[-1])
        planes.update(at)
    if not begin < end:
        return 0.0, 0.0, 0.0
    places = [begin, *sorted(p for p in planes if begin < p < end), end]
    through, light = 1.0, [0.0, 0.0, 0.0]
    for a, b in zip(places, places[1:]):
        middle = [o + (a + b) / 2 * s for o, s in zip(origin, step)]
        cell = [min(max(int(m), 0), n - 2) for m, n in zip(middle, (nx, ny, nz))]
        f = [m - c for m, c in zip(middle, cell)]
        v = [values[cell[0] + i + nx * (cell[1] + j + ny * (cell[2] + k))] for k in (0, 1) for j in (0, 1) for i in (0, 1)]
        mean = lambda d, p, q: (d[0] * (1 - p) + d[1] * p) * (1 - q) + (d[2] * (1 - p) + d[3] * p) * q
        g = [mean((v[1] - v[0], v[3] - v[2], v[5] - v[4], v[7] - v[6]), f[1], f[2]) / spacing[0],
             mean((v[2] - v[0], v[3] - v[1], v[6] - v[4], v[7] - v[5]), f[0], f[2]) / spacing[1],
             mean((v[4] - v[0], v[5] - v[1], v[6] - v[2], v[7] - v[3]), f[0], f[1]) / spacing[2]]
        own, white = 1.0, 0.0
        if any(g):
            cosine = min(abs(dot(unit(g), view["forward"])), 1.0)  # the light is at the eye
            own, white = AMBIENT + DIFFUSE * cosine, SPECULAR * cosine ** SHININESS
        opacity = -math.expm1(-EXTINCTION * (b - a))
        light = [x + through * opacity * (own * c + white) for x, c in zip(light, COLOR)]
        through *= 1 - opacity
    return tuple(light)


def check(case, methods, tally):
    import promises  # the script that imports this module

    broken = promises.judged(case, methods, tally)
    made = case.made
    if made["judge"] is None or broken:
        return not broken, "; ".join(broken)
    for words in methods:
        _, _, _, path = case.render(words, verify=False)
        _, _, rgb = promises.pixels_of(path)
        error = max(abs(a - b) for n in made["judge"] for a, b in zip(oracle(made, n), rgb[3 * n:3 * n + 3]))
        tally["worst"] = max(tally["worst"], error / TOLERANCE)
        if not error <= TOLERANCE:
            broken.append(f"{' '.join(words)}: {error:.3g} from the oracle")
    return not broken, "; ".join(broken)
