# SPDX-License-Identifier: BSD-3-Clause
"""Grids with plateaus at, or some ulps away from, the value of a step of the transfer function: saturated fields (tanh,
clamped distances, volume fractions of 0 and 1, terraces), their plateaus exact or noisy by 1 to 1e4 ulps; steps at the
smallest or largest value, between, and at several plateaus; boxes, single steps and stairs; all sample types.
"""
import math

from . import _volumes, files


def levels(r):
    """(words, f, plateaus): a field over [0, 1]^3 that is constant at the plateaus' values."""
    name, f = _volumes.smooth(r)
    center, sharp = r.uniform(0.35, 0.65), r.choice([3, 10, 40, 200])
    kind = r.choice(["tanh", "tanh", "clamp", "fraction", "terraces"])
    if kind == "tanh":
        # Saturates beyond the last place of the float or integer.
        return f"tanh of {name}", lambda x: math.tanh(sharp * (f(x) - center)), [-1.0, 1.0]
    if kind == "clamp":
        low, high = center - 0.1, center + 0.1
        return f"clamped {name}", lambda x: min(max(f(x), low), high), [low, high]
    if kind == "fraction":
        return f"volume fraction of {name}", lambda x: min(max(0.5 + sharp / 4 * (f(x) - center), 0.0), 1.0), [0.0, 1.0]
    steps = r.randint(2, 5)
    return f"terraces of {name}", lambda x: math.floor(steps * f(x)) / steps, [m / steps for m in range(-1, steps + 1)]


def case(r, folder, tessera):
    kind, association = r.choice(_volumes.KINDS), r.choice(["point", "point", "point", "cell"])
    n = _volumes.counts(r, association)
    cells, places = _volumes.sites(n, association)
    words, f, plateaus = levels(r)
    low, high = min(plateaus), max(plateaus)
    if kind in _volumes.LEVELS:
        first, last = sorted(r.sample(range(_volumes.LEVELS[kind][0], _volumes.LEVELS[kind][1] + 1), 2)) if r.random() < 0.5 else _volumes.LEVELS[kind]
        last = max(last, first + 3)
        stored = lambda v: min(_volumes.LEVELS[kind][1], max(_volumes.LEVELS[kind][0], round(first + (last - first) * (v - low) / (high - low))))
    else:
        scale, shift = 10 ** r.uniform(-3, 3) if r.random() < 0.6 else 1.0, r.choice([0, 0, 0, 1, 10, -1e3])
        exact = (lambda v: files.float32(v)) if kind == "Float32" else (lambda v: v)
        stored = lambda v: exact(scale * (v + shift))
    values = [stored(f(x)) for x in places]
    plateaus = sorted({stored(p) for p in plateaus} & set(values)) or [max(values)]
    ulps = 0
    if kind.startswith("Float") and r.random() < 0.6:
        # Noisy: on the plateau's far side, near side, or both.
        step = files.next_float32 if kind == "Float32" else files.next_float64
        ulps, side = r.choice([1, 1, 2, 16, 256, 10000]), r.choice([-1, 0, 1])
        share, rests = r.choice([0.02, 0.5, 1]), set(plateaus) - {0.0}
        away = lambda: ulps * (side or r.choice([-1, 1])) if r.random() < 0.7 else r.randint(-ulps, ulps) if side == 0 else side * r.randint(0, ulps)
        values = [step(v, away()) if v in rests and r.random() < share else v for v in values]
    span = (max(values) - min(values)) or 1
    form = r.choice(["step", "step", "box", "stairs"])

    def function(size):
        top, c = _volumes.extinction(r, size), lambda: _volumes.color(r)
        at = r.choice(plateaus)
        if r.random() < 0.2 and kind.startswith("Float") and at != 0:
            at = (files.next_float32 if kind == "Float32" else files.next_float64)(at, r.choice([-1, 1, -16, 16]))
        amount = lambda: r.choice([0, top, top * r.random()])
        if form == "step":
            below, above = r.choice([(0, top), (top, 0), (amount(), top)])
            made = [(at, *c(), below), (at, *c(), above)]
            if r.random() < 0.4:
                made.append((at + span * r.uniform(0.1, 2), *c(), amount()))
            if r.random() < 0.4:
                made.insert(0, (at - span * r.uniform(0.1, 2), *c(), amount()))
            return made
        if form == "box":
            width = span * 10 ** r.uniform(-4, 0)
            start = at - width if r.random() < 0.5 else at
            return [(start, *c(), 0), (start, *c(), top), (start + width, *c(), top), (start + width, *c(), 0)]
        made, level = [], amount()
        for p in plateaus[:6]:
            up = amount()
            made += [(p, *c(), level), (p, *c(), up)]
            level = up
        return made

    made = _volumes.made(r, folder, n, values, association, kind, function,
                         f"{words}, {form}{f', frayed by {ulps} ulps' if ulps else ''}")
    return made
