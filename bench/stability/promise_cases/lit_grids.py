# SPDX-License-Identifier: BSD-3-Clause
"""Grids with --shade or --iso, whose neighbouring values differ little compared with the range: lighting depends on the direction of
the gradient, however small that is.

The image is judged by --verify, and some pixels by a separate oracle: along the ray, voxel by voxel, the trilinear field's
gradient in the middle of each interval lights what a constant function emits there (the light's formula is in
docs/ACCURACY.md). Values are 64-bit and 32-bit floats and integers with a scale.
"""
import math

from promise_cases._oracle import AMBIENT, DIFFUSE, SHININESS, SPECULAR, Camera, Grid, cosine_of
from promise_cases.files import float32, write_vti
from promise_cases.perspective_ties import plus, unit

COLOR, EXTINCTION = (0.6, 0.2, 0.4), 1.0
TOLERANCE = 1e-5


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
    size, lengths = 20, [(n - 1) * s for n, s in zip(counts, spacing)]
    centre = [length / 2 for length in lengths]
    while True:
        towards = unit([r.uniform(-1, 1) for _ in range(3)])
        if abs(towards[2]) < 0.95:
            break
    camera = Camera(plus(centre, (-3 * math.hypot(*lengths), towards)), centre, (0, 0, 1), size, size, scale=0.5 * math.hypot(*lengths))
    has_surface = r.random() < 0.3
    args = ["--iso", f"{level!r}:white:0.4"] if has_surface else []
    return {"input": [write_vti(folder / "grid.vti", counts, values, kind=kind, spacing=spacing)],
            "function": [(low - 1, *COLOR, EXTINCTION), (high + 1, *COLOR, EXTINCTION)], "args": [*args, "--shade"], "camera": camera.text(),
            "grid": Grid(counts, spacing, (0, 0, 0), values), "view": camera, "judge": None if has_surface else sorted(r.sample(range(size * size), 40)),
            "methods": [["--integrator", "exact"], ["--accuracy", "1e-5"]],
            "words": f"{kind}, differences {differences:.3g}, {'surface, ' if has_surface else ''}{'x'.join(map(str, counts))}"}


def oracle(made, number):
    """RGB of a pixel: the voxels along its ray, each with the light of its own gradient."""
    origin, direction = made["view"].ray(number)
    through, light = 1.0, [0.0, 0.0, 0.0]
    for front, back, voxel in made["grid"].stretches(origin, direction, 0.0, math.inf):
        gradient = made["grid"].field(voxel, plus(origin, ((front + back) / 2, direction)))[1]
        own, white = 1.0, 0.0
        if any(gradient):
            cosine = cosine_of(gradient, direction)  # the light is at the eye
            own, white = AMBIENT + DIFFUSE * cosine, SPECULAR * cosine ** SHININESS
        opacity = -math.expm1(-EXTINCTION * (back - front))
        light = [x + through * opacity * (own * c + white) for x, c in zip(light, COLOR)]
        through *= 1 - opacity
    return light


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
