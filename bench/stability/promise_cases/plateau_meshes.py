# SPDX-License-Identifier: BSD-3-Clause
"""Meshes whose field is within some last places of a step's value over whole regions: saturated fields (tanh, volume of
fluid), noise of the last places around a step, point and cell data, 32-bit and 64-bit; one step or several, up and down, some
last places apart, in the middle of the range or at its ends; any view."""
import math

from . import files
from .perspective_ties import direction

ULPS = [0, 1, 1, 2, 3, 16, 64, 256, 1000, 10_000, 1_000_000]


def camera(r, size, near=2.2, far=5.0):
    """A view of [-1, 1]^3, sometimes along an axis, sometimes from inside."""
    towards = direction(r)
    if r.random() < 0.2:
        towards = [0.0, 0.0, 0.0]
        towards[r.randrange(3)] = r.choice([-1.0, 1.0])
    at = [r.uniform(-0.3, 0.3) for _ in range(3)]
    distance = r.uniform(near, far)
    up = direction(r)
    if abs(sum(a * b for a, b in zip(up, towards))) > 0.95:
        up = [towards[1], towards[2], -towards[0]] if abs(towards[0]) < 0.9 else [0.0, 1.0, 0.0]
    lens = f"parallel_scale {r.uniform(0.2, 1.8)!r}" if r.random() < 0.5 else f"view_angle {r.uniform(15, 110)!r}"
    if r.random() < 0.1:
        distance = r.uniform(0, 0.5)
    eye = [a + distance * t for a, t in zip(at, towards)]
    if distance == 0:
        at = [a - t for a, t in zip(at, towards)]
    return files.camera_text(eye, at, up, lens, size, size)


def mesh(r):
    counts = [r.randint(1, 5) for _ in range(3)]
    points, tets = files.split_box(counts)
    jitter = r.choice([0, 0, 0.1, 0.3])
    moved = [tuple(x if abs(x) == 1 else x + r.uniform(-jitter, jitter) / n for x, n in zip(p, counts)) for p in points]
    return moved, tets


def knots_with_steps(r, steps, low, high):
    """Knots with a step at each of `steps`, ascending, and a few others between."""
    dense = 10 ** r.uniform(-0.5, 2.2)
    optics = lambda: (r.random(), r.random(), r.random(), 0.0 if r.random() < 0.3 else dense * r.random())
    values = sorted([(v, 2) for v in steps] + [(low + (high - low) * r.random(), 1) for _ in range(r.randint(0, 3))] +
                    ([(low, 1), (high, 1)] if r.random() < 0.5 else []))
    knots, taken = [], set(steps)
    for value, count in values:
        if count == 1 and (value in taken or any(abs(value - s) < 1e-3 * (high - low) for s in steps)):
            continue
        if count == 1:
            knots.append((value, *optics()))
            continue
        # Between two steps some last places apart the function is constant: a ramp has no other values there.
        near = knots and value - knots[-1][0] < 1e-6 * (high - low)
        knots += [(value, *(knots[-1][1:] if near else optics())), (value, *optics())]
    return knots


def case(r, folder, tessera):
    points, tets = mesh(r)
    kind, association = r.choice(["Float32", "Float64"]), "cell" if r.random() < 0.25 else "point"
    beside = files.next_float32 if kind == "Float32" else files.next_float64
    rounded = files.float32 if kind == "Float32" else float
    low, high = r.choice([(0.0, 1.0), (-1.0, 1.0), (0.0, 1.0), (1000.0, 1001.0), (-3.7, 12.5), (0.0, 1e-5)])
    span = high - low
    inner = [rounded(low + span * r.uniform(0.1, 0.9)) for _ in range(r.choice([0, 0, 1, 3]))]
    level = r.choice([high, high, low, rounded(low + span * r.uniform(0.2, 0.8)), rounded(low + span / 2)])
    if level == 0:
        level = rounded(span * 1e-3)
    if r.random() < 0.1 and inner:  # a second step some last places away
        inner = [beside(level, r.choice([1, 2, 16, 1000]))]
    steps = sorted({level, *inner})
    places = points if association == "point" else [tuple(sum(points[v][a] for v in t) / 4 for a in range(3)) for t in tets]
    normal, offset, steep = direction(r), r.uniform(-0.6, 0.6), 10 ** r.uniform(0.3, 2)
    ulps, shape = r.choice(ULPS), r.choice(["tanh", "noise", "noise", "below", "alternating", "everywhere"])
    sign = -1 if level == high else 1 if level == low else r.choice([-1, 1])

    def value(i, p):
        u = sum(a * b for a, b in zip(normal, p)) - offset
        if shape == "tanh":
            return rounded(level + sign * span / 2 * (1 - math.tanh(steep * u)))
        if shape != "everywhere" and u < 0:
            return rounded(level + sign * span * min(1, -u * steep / 10))
        if shape == "alternating":
            return beside(level, ulps if i % 2 else -ulps)
        if shape == "below":
            return beside(level, -r.choice([0, ulps, ulps]))
        return beside(level, r.choice([-ulps, 0, ulps, r.randint(-ulps, ulps)]))

    scalars = [value(i, p) for i, p in enumerate(places)]
    path = files.write_vtu(folder / "mesh.vtu", points, tets, scalars, association, kind)
    words = (f"{len(tets)} tets, {kind} {association} data, {shape} of {ulps} last places round {level!r}, "
             f"{len(steps)} steps")
    return {"input": [path], "function": knots_with_steps(r, steps, low, high), "camera": camera(r, 20), "words": words}
