# SPDX-License-Identifier: BSD-3-Clause
"""Grids of one value, and of few values within some ulps: of all sample types, also with blanks, also a single voxel;
with functions that have knots near the value, far from it, at it, and steps there; extinctions of all magnitudes.
"""
import math

from . import _volumes, files


def value_of(r, kind):
    if kind in _volumes.LEVELS:
        low, high = _volumes.LEVELS[kind]
        return r.choice([low, high, 7, 0 if low <= 0 else 1, r.randint(low, high), r.randint(0, 255)])
    v = r.choice([7.25, 1.0, 0.0, -3.5, 1e-20, 1e20, 0.1, -1 / 3, r.gauss(0, 1) * 10 ** r.uniform(-12, 12)])
    return files.float32(v) if kind == "Float32" else v


def knots(r, v, kind, size):
    top, c = _volumes.extinction(r, size), lambda: _volumes.color(r)
    most = 1 if kind in _volumes.LEVELS else abs(v) if v != 0 else 1
    near = r.choice([0.5, 0.25, 1, 10, 1e3, 1e6]) if kind in _volumes.LEVELS else most * 10 ** r.uniform(-15, 6)
    form = r.choice(["ramp", "ramp", "ramp", "peak", "step at it", "step beside it", "knot at it", "all below", "all above", "many"])
    up, down = near * r.uniform(0.2, 1), near * r.uniform(0.2, 1)
    if form == "ramp":
        return form, [(v - down, *c(), top * r.choice([0, 0, r.random()])), (v + up, *c(), top)]
    if form == "peak":
        return form, [(v - 2 * down, *c(), 0), (v - down * r.uniform(-0.5, 1), *c(), top), (v + 2 * up, *c(), 0)]
    if form == "step at it":
        return form, [(v, *c(), top * r.random()), (v, *c(), top * r.random())]
    if form == "step beside it":
        at = v + r.choice([-1, 1]) * near if kind in _volumes.LEVELS or v == 0 else files.next_float64(v, r.choice([-1, 1, -3, 3, 1000, -1000]))
        return form, [(at, *c(), top * r.random()), (at, *c(), top * r.random())]
    if form == "knot at it":
        return form, [(v - down, *c(), 0), (v, *c(), top), (v + up, *c(), top * r.random())]
    if form == "all below":
        return form, [(v - 2 * down, *c(), 0), (v - down, *c(), top)]
    if form == "all above":
        return form, [(v + down, *c(), top), (v + 2 * down, *c(), 0)]
    return form, [(v + near * r.uniform(-1, 1), *c(), top * r.random()) for _ in range(r.choice([6, 20, 100]))]


def case(r, folder, tessera):
    kind, association = r.choice(_volumes.KINDS), r.choice(["point", "point", "cell"])
    n = [2, 2, 2] if r.random() < 0.2 else _volumes.counts(r, association, 12)
    cells, places = _volumes.sites(n, association)
    v = value_of(r, kind)
    values, words = [v] * len(places), f"constant {v!r}"
    if r.random() < 0.15 and kind.startswith("Float") and v != 0:
        step = files.next_float32 if kind == "Float32" else files.next_float64
        ulps = r.choice([1, 2, 100])
        values = [step(v, r.randint(0, ulps)) for _ in places]
        words += f" and up to {ulps} ulps more"
    if r.random() < 0.15 and kind.startswith("Float") and len(values) > 1:
        values = [math.nan if r.random() < 0.2 and m > 0 else x for m, x in enumerate(values)]
        words += " with blanks"
    how = ""

    def function(size):
        nonlocal how
        how, made = knots(r, v, kind, size)
        return sorted(made, key=lambda knot: knot[0])

    made = _volumes.made(r, folder, n, values, association, kind, function, words)
    made["words"] += f", {how}"
    return made
