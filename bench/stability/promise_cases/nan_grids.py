# SPDX-License-Identifier: BSD-3-Clause
"""Grids with blank (NaN) samples: outside a ball, in a slab, at random single positions, on whole lattice planes, in
whole cells of 8^3 voxels, almost everywhere; with functions of few knots that are invisible at one end, both or in
the middle, and of many knots; float fields, point and cell data, regular and rectilinear.
"""
import math

from . import _volumes, files


def blanks(r, n):
    """(words, f): whether the sample at position x of [0, 1]^3 and index i is blank."""
    kind = r.choice(["outside", "outside", "inside", "slab", "half", "random", "plane", "cells", "most"])
    at, radius = [r.uniform(0.3, 0.7) for _ in range(3)], r.uniform(0.2, 0.6)
    normal = [r.gauss(0, 1) for _ in range(3)] if r.random() < 0.6 else r.choice([[1, 0, 0], [0, 1, 0], [0, 0, 1]])
    long = math.sqrt(sum(v * v for v in normal))
    across = lambda x: sum(v * (y - o) for v, y, o in zip(normal, x, at)) / long
    if kind == "outside":
        return kind, lambda x, i: math.dist(x, at) > radius
    if kind == "inside":
        return kind, lambda x, i: math.dist(x, at) < radius
    if kind == "slab":
        return kind, lambda x, i: abs(across(x)) < 0.15
    if kind == "half":
        return kind, lambda x, i: across(x) > 0
    if kind == "random":
        share = 10 ** r.uniform(-3, -0.3)
        return kind, lambda x, i: r.random() < share
    if kind == "plane":
        # Usually between two cells of 8^3 voxels, or two bricks.
        axis, place = r.randrange(3), r.choice([8, 8, 16, 4, r.randint(0, 12)])
        return f"plane {place} of axis {axis}", lambda x, i: i[axis] == place
    if kind == "cells":
        parity = r.randrange(2)
        return kind, lambda x, i: (i[0] // 8 + i[1] // 8 + i[2] // 8) % 2 == parity
    keep = [r.randrange(m) for m in n]
    return kind, lambda x, i: max(abs(a - b) for a, b in zip(i, keep)) > 2


def knots(r, low, high, size):
    """(words, knots)"""
    span, top, c = high - low or 1, _volumes.extinction(r, size), lambda: _volumes.color(r)
    at = lambda u: low + u * span
    kind = r.choice(["clear below", "clear above", "clear ends", "clear middle", "ramp", "steps", "many"])
    a, b = sorted((r.uniform(0.05, 0.95), r.uniform(0.05, 0.95)))
    if kind == "clear below":
        return kind, [(at(0), *c(), 0), (at(a), *c(), 0), (at(1), *c(), top)]
    if kind == "clear above":
        return kind, [(at(0), *c(), top), (at(a), *c(), 0), (at(1), *c(), 0)]
    if kind == "clear ends":
        m = (a + b) / 2
        return kind, [(at(a), *c(), 0), (at(m), *c(), top), (at(b), *c(), 0)]
    if kind == "clear middle":
        return kind, [(at(0), *c(), top), (at(a), *c(), 0), (at(b), *c(), 0), (at(1), *c(), top * r.random())]
    if kind == "ramp":
        return kind, [(at(0), *c(), top * r.random()), (at(1), *c(), top)]
    if kind == "steps":
        return kind, [(at(a), *c(), 0), (at(a), *c(), top), (at(b), *c(), top), (at(b), *c(), 0)]
    places = sorted(r.random() for _ in range(r.choice([12, 40, 200])))
    return kind, [(at(u), *c(), top * max(0, r.uniform(-0.5, 1))) for u in places]


def case(r, folder, tessera):
    kind, association = r.choice(["Float32", "Float32", "Float64"]), r.choice(["point", "point", "cell"])
    n = _volumes.counts(r, association)
    cells, places = _volumes.sites(n, association)
    shape, f = _volumes.smooth(r)
    if r.random() < 0.2:
        # Clear or not on either side of a blank layer: no value between the two may be visible.
        inner, axis, level = f, r.randrange(3), r.uniform(0.3, 0.7)
        shape, f = "two levels", lambda x: 0.05 * inner(x) + (1 if x[axis] > level else 0)
    scale, shift = 10 ** r.uniform(-3, 3), r.choice([0, 0, -0.5, 3])
    values = [scale * (f(x) + shift) for x in places]
    if kind == "Float32":
        values = [files.float32(v) for v in values]
    low, high = min(values), max(values)
    how, blank = blanks(r, cells)
    index = lambda m: (m % cells[0], m // cells[0] % cells[1], m // cells[0] // cells[1])
    values = [math.nan if blank(x, index(m)) else v for m, (x, v) in enumerate(zip(places, values))]
    if all(math.isnan(v) for v in values):
        values[r.randrange(len(values))] = low  # a volume with only blanks has no range
    words = ""

    def made_function(size):
        nonlocal words
        words, made = knots(r, low, high, size)
        return made

    made = _volumes.made(r, folder, n, values, association, kind, made_function, f"{shape}, blank {how}")
    made["words"] += f", {words}"
    return made
