# SPDX-License-Identifier: BSD-3-Clause
"""Grids with steep transfer functions: narrow peaks, steps, staircases and noise of a few or many knots, extinctions of 1
to 1e6 times the volume's size, some in thin fog; smooth, noisy, checkered and thin fields of all sample types; point
and cell data; regular, anisotropic and rectilinear grids; seen from outside and inside, orthographic and perspective,
some through near planes.

Knots are at random values: a plateau of samples at exactly a step's value is another class. Fields vary.
"""
import math

from . import _volumes, files

KINDS = ["Float32", "Float32", "Float64", "UInt8", "UInt8", "UInt16", "Int16"]
LEVELS = {"UInt8": 255, "UInt16": 65535, "Int16": 30000}


def shape(r):
    """(words, f): a field over [0, 1]^3."""
    kind = r.choice(["smooth", "smooth", "smooth", "smooth", "noise", "rough", "checker", "thread"])
    name, smooth = _volumes.smooth(r)
    if kind == "smooth":
        return name, smooth
    if kind == "noise":
        return kind, lambda x: r.random()
    if kind == "rough":
        share = 10 ** r.uniform(-4, -0.7)
        return f"rough {name}", lambda x: smooth(x) + share * (r.random() - 0.5)
    if kind == "checker":
        low, high, spread = r.uniform(0, 0.3), r.uniform(0.7, 1), 10 ** r.uniform(-3, -1)
        parity = r.choice([17, 5, 2])
        return kind, lambda x: (high if sum(int(parity * v + 0.01) for v in x) % 2 else low) + spread * r.random()
    width, y, z = r.uniform(0.03, 0.2), r.uniform(0.2, 0.8), r.uniform(0.2, 0.8)
    return kind, lambda x: math.exp(-((x[0] - y) ** 2 + (x[1] - z - 0.2 * math.sin(6 * x[2])) ** 2) / width ** 2) + 1e-3 * smooth(x)


def colors(r):
    one = _volumes.color(r)
    return (lambda: one) if r.random() < 0.3 else lambda: _volumes.color(r)


def function(r, low, high, size):
    """(words, knots): with extinctions up to 1 to 1e6 over `size`."""
    most, fog = 10 ** r.uniform(0, 6) / size, r.choice([0, 0, 10 ** r.uniform(-2, 1) / size])
    color, span = colors(r), high - low
    kind = r.choice(["peak", "peak", "peaks", "box", "step", "stairs", "noise", "flank", "mixed"])
    place = lambda: r.uniform(low + 0.03 * span, high - 0.03 * span)
    knots = [(low - span, fog)]

    def peak(at):
        width = span * 10 ** r.uniform(-4.5, -0.7)
        left, right = at - width * r.uniform(0.2, 1), at + width * r.uniform(0.2, 1)
        top = most * r.choice([1, 1, 10 ** r.uniform(-3, 0)])
        return [(left, fog), (at, top), (right, fog)]

    def box(at):
        width = span * 10 ** r.uniform(-4, -0.5)
        return [(at, fog), (at, most), (at + width, most * r.random()), (at + width, fog)]

    if kind == "peak":
        knots += peak(place())
    elif kind == "peaks":
        for at in sorted(place() for _ in range(r.randint(2, 12))):
            made = peak(at)
            if made[0][0] > knots[-1][0]:
                knots += made
    elif kind == "box":
        knots += box(place())
    elif kind == "step":
        at = place()
        knots += [(at, fog), (at, most)]
        if r.random() < 0.5:
            knots += [(high + span, most * r.random())]
    elif kind == "stairs":
        level = fog
        for at in sorted(place() for _ in range(r.randint(2, 10))):
            up = most * r.random() * r.choice([0, 1, 1e-2, 1e-4])
            knots += [(at, level), (at, up)]
            level = up
    elif kind == "noise":
        for at in sorted(place() for _ in range(r.choice([2, 4, 16, 60, 250]))):
            knots.append((at, most * r.random() ** r.choice([1, 8])))
    elif kind == "flank":
        at, width = place(), span * 10 ** r.uniform(-4, 0)
        knots += [(at, fog), (at + width, most)]
    else:
        at = place()
        made = peak(at) + [(max(at + 0.3 * (high - at), at + span), most * 1e-3), (high + 2 * span, most)]
        knots += made
    return f"{kind}, extinction x size {most * size:.3g}, fog {fog * size:.3g}", [(v, *color(), e) for v, e in knots]


def case(r, folder, tessera):
    kind = r.choice(KINDS)
    association = r.choice(["point", "point", "point", "cell"])
    counts = [max(3, n) for n in _volumes.counts(r, association)]
    name, f = shape(r)
    values = list(map(f, _volumes.sites(counts, association)[1]))
    low, high = min(values), max(values)
    if high - low < 1e-6:
        values[0], high = low + 1, low + 1
    values = [(v - low) / (high - low) for v in values]
    if kind in LEVELS:
        first, last = sorted(r.sample(range(LEVELS[kind] + 1), 2)) if r.random() < 0.3 else (0, LEVELS[kind])
        last = max(last, first + 3) if first + 3 <= LEVELS[kind] else last
        values = [round(first + (last - first) * v) for v in values]
    else:
        scale, shift = 10 ** r.uniform(-3, 3), r.choice([0, 0, -0.5, 3])
        values = [scale * (v + shift) for v in values]
        if kind == "Float32":
            values = [files.float32(v) for v in values]
    low, high = min(values), max(values)
    independent, how = r.random() < 0.06, ""

    def made_function(size):
        nonlocal how
        how, knots = function(r, low, high, size)
        return [(v, *(c / size if independent else c for c in rgb), e) for v, *rgb, e in knots]

    made = _volumes.made(r, folder, counts, values, association, kind, made_function, name, ["--emission", "independent"] * independent)
    made["words"] += f", {how}"
    return made
