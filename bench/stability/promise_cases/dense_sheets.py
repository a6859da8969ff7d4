# SPDX-License-Identifier: BSD-3-Clause
"""Thin sheets and stacks of them, thickness 1e-7 to 1 of their width, extinction 1 to 1e6, seen orthographically and with
view angles of 5 to 175 degrees from 0.01 to 10 away, face on, tilted, and along the sheet."""
import math

from . import files
from .perspective_ties import direction


def lengthwise(r, folder):
    """A wide view along a sheet next to the eye: depth is the sheet's length, and rays at the window's edge pass through its
    thickness."""
    thickness, ahead, length = 10 ** r.uniform(-6, -1), 10 ** r.uniform(-1.5, 0.3), r.uniform(1, 4)
    counts = r.choice([(1, 1, 1), (2, 1, 2), (1, 2, 1), (2, 5, 3)])
    points, tets = files.split_box(counts, (-2, -thickness, -ahead - length), (2, 0, -ahead))
    scalars = [r.choice([0.5, 0.5 + 0.1 * p[0] + 0.03 * p[2]]) for p in points] if r.random() < 0.5 else [0.5] * len(points)
    dense, beside, angle = 10 ** r.uniform(1, 3), 10 ** r.uniform(-1.5, 0.6), r.uniform(90, 174)
    knots = [(0.0, 0.2, 0.4, 0.9, dense), (1.0, 0.9, 0.5, 0.2, r.random() * dense)]
    camera = files.camera_text((r.uniform(-0.3, 0.3), beside, 0), (0, beside - r.choice([0, 0, r.uniform(-1, 1)]), -1), (0, 1, 0), f"view_angle {angle!r}", 24, 24)
    path = files.write_vtu(folder / "mesh.vtu", points, tets, scalars)
    told = f"{thickness:.2g} thick, {length:.2g} long, {ahead:.2g} ahead, {beside:.2g} beside, extinction {dense:.3g}, angle {angle:.0f}"
    return {"input": [path], "function": knots, "camera": camera, "words": told}


def case(r, folder, tessera):
    if r.random() < 0.5:
        return lengthwise(r, folder)
    thickness = 10 ** r.uniform(-7, 0)
    layers = r.choice([1, 1, 1, 2, 5, 30])
    side = r.randint(1, 4)
    axis = r.randrange(3)
    counts, low, high = [side] * 3, [-1.0] * 3, [1.0] * 3
    counts[axis], low[axis], high[axis] = layers, 0.0, thickness
    points, tets = files.split_box(counts, low, high)
    if r.random() < 0.4:  # some direction other than the axes
        a, b = r.uniform(-1, 1), r.uniform(-1, 1)
        turn = lambda p: (p[0] * math.cos(a) - p[1] * math.sin(a), p[0] * math.sin(a) + p[1] * math.cos(a), p[2])
        lean = lambda p: (p[0], p[1] * math.cos(b) - p[2] * math.sin(b), p[1] * math.sin(b) + p[2] * math.cos(b))
        points = [lean(turn(p)) for p in points]
    pattern = r.choice(["level", "random", "alternating", "along"])
    scalars = [{"level": 0.6, "random": r.random(), "alternating": float(i % 2), "along": 0.5 + 0.35 * p[0]}[pattern]
               for i, p in enumerate(points)]
    dense = 10 ** r.uniform(0, 6)
    knots = [(0.0, r.random(), 0.2, 0.9, r.choice([0.0, 0.3 * dense])), (0.5, 0.1, r.random(), 0.3, dense * r.random()),
             (1.0, 0.9, 0.5, r.random(), dense)]
    if r.random() < 0.3:
        knots.insert(2, (0.5, 0.8, 0.8, 0.1, r.choice([0.0, dense])))
    if r.random() < 0.3:
        knots = [(0.0, 0.9, 0.5, 0.2, dense)]
    at = list(points[r.randrange(len(points))])
    middle = [sum(p[a] for p in points) / len(points) for a in range(3)]
    at = [m + r.uniform(0, 0.8) * (x - m) for x, m in zip(at, middle)]
    away, look = 10 ** r.uniform(-2, 1), direction(r)
    eye = [a + away * d for a, d in zip(at, look)]
    view = r.random()
    if view < 0.25:  # along the sheet
        along = direction(r)
        along[axis] = r.choice([0.0, 0.01, 0.1, 0.4])
        focal = [e + d for e, d in zip(eye, along)]
    elif view < 0.4:
        focal = [e - d + 0.8 * x for e, d, x in zip(eye, look, direction(r))]
    else:
        focal = at
    if math.dist(eye, focal) < 1e-9:
        focal = [eye[0] + 1, eye[1], eye[2]]
    forward = [f - e for f, e in zip(focal, eye)]
    up = r.choice([(0, 1, 0), (0, 0, 1), (1, 0, 0), tuple(direction(r))])
    size = math.sqrt(sum(x * x for x in forward))
    if abs(sum(a * b for a, b in zip(up, forward))) > 0.99 * size:
        up = (0.3, 0.5, 0.8) if abs(0.3 * forward[0] + 0.5 * forward[1] + 0.8 * forward[2]) < 0.9 * size else (1, -0.4, 0.1)
    lens = f"parallel_scale {10 ** r.uniform(-1.5, 0.3)!r}" if r.random() < 0.4 else f"view_angle {r.uniform(5, 175)!r}"
    camera = files.camera_text(eye, focal, up, lens, 20, 20)
    path = files.write_vtu(folder / "mesh.vtu", points, tets, scalars)
    told = f"{layers} layers {thickness:.2g} thick, extinction {dense:.3g}, {away:.2g} away, {pattern}, {lens}"
    return {"input": [path], "function": knots, "camera": camera, "words": told}
