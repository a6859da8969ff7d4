# SPDX-License-Identifier: BSD-3-Clause
"""Common parts of the random grids of several classes: shapes of fields, geometries, views and options."""
import math

from . import files

KINDS = ["Float32", "Float32", "Float64", "UInt8", "UInt16", "Int16", "Int32"]
LEVELS = {"UInt8": (0, 255), "UInt16": (0, 65535), "Int16": (-32768, 32767), "Int32": (-2000000000, 2000000000)}
METHODS = [["--integrator", "exact"], ["--accuracy", "1e-4"], ["--accuracy", "1e-5"]]


def counts(r, association, most=24):
    """Points along each axis; sometimes across a cell of 8^3 voxels or a chunk of 32 slabs."""
    n = [r.choice([r.randint(2, most), 9, 17]) for _ in range(3)]
    if r.random() < 0.15:
        n[r.randrange(3)] = r.choice([33, 34, 40, 65])
    return n


def sites(n, association):
    """Samples along each axis, and their positions in [0, 1]^3, x fastest."""
    cells = [c - 1 for c in n] if association == "cell" else n
    half = lambda i, m: (i + 0.5) / m
    return cells, [(half(i, cells[0]), half(j, cells[1]), half(k, cells[2]))
                   for k in range(cells[2]) for j in range(cells[1]) for i in range(cells[0])]


def smooth(r):
    """(words, f): a smooth field over [0, 1]^3, with values of about [0, 1]."""
    kind = r.choice(["ball", "waves", "ramp", "sheet"])
    at = [r.uniform(0.2, 0.8) for _ in range(3)]
    a, b, c, p = r.uniform(1, 9), r.uniform(1, 9), r.uniform(1, 9), r.uniform(0, 6)
    if kind == "ball":
        return kind, lambda x: math.dist(x, at)
    if kind == "waves":
        return kind, lambda x: 0.5 + 0.25 * (math.sin(a * x[0] + p) * math.cos(b * x[1]) + math.sin(c * x[2]))
    normal = [r.gauss(0, 1) for _ in range(3)] if r.random() < 0.7 else r.choice([[1, 0, 0], [0, 1, 0], [0, 0, 1]])
    long = math.sqrt(sum(v * v for v in normal))
    across = lambda x: sum(v * (y - o) for v, y, o in zip(normal, x, at)) / long
    if kind == "ramp":
        return kind, lambda x: 0.5 + across(x)
    return kind, lambda x: math.exp(-(across(x) / 0.2) ** 2)


def write(r, folder, n, values, association, kind):
    """(words, path, far corner) of a regular or rectilinear grid."""
    spacing = [1.0] * 3 if r.random() < 0.5 else [10 ** r.uniform(-0.7, 0.7) for _ in range(3)]
    if r.random() < 0.2:
        axes = []
        for count, s in zip(n, spacing):
            places = [0.0]
            for _ in range(count - 1):
                places.append(places[-1] + s * 10 ** r.uniform(-0.7, 0.3))
            axes.append(places)
        return "rectilinear ", files.write_vtr(folder / "grid.vtr", axes, values, association, kind), [a[-1] for a in axes]
    path = files.write_vti(folder / "grid.vti", n, values, association, kind, spacing)
    return "", path, [s * (count - 1) for s, count in zip(spacing, n)]


def camera(r, corner, most=48):
    """(words, text): from outside, orthographic or perspective, or from inside; along axes, across them, zoomed."""
    size, center = math.dist([0, 0, 0], corner), [c / 2 for c in corner]
    direction = [r.gauss(0, 1) for _ in range(3)]
    if r.random() < 0.25:
        direction = r.choice([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, 0, -1], [1, 1, 0], [1, 1, 1]])
    long = math.sqrt(sum(v * v for v in direction))
    direction = [v / long for v in direction]
    up = min(([1, 0, 0], [0, 1, 0], [0, 0, 1]), key=lambda u: abs(sum(a * b for a, b in zip(u, direction))))
    kind = r.choice(["orthographic", "perspective", "inside"])
    away = size * r.uniform(0.7, 4)
    eye = [c + away * v for c, v in zip(center, direction)]
    if kind == "inside":
        eye = [c * r.uniform(0.05, 0.95) for c in corner]
    focus = [e - away * v for e, v in zip(eye, direction)]
    if kind == "orthographic":
        lens = f"parallel_scale {size * 10 ** r.uniform(-1.5, -0.25)!r}"
    else:
        angle = r.uniform(30, 130) if kind == "inside" else 2 * math.degrees(math.atan(0.5 * size / away))
        lens = f"view_angle {min(angle * 10 ** r.uniform(-1.2, 0.1), 150)!r}"
    clip = f"clipping_range {max(1e-3, away - size * r.uniform(0, 0.4))!r} {away + size!r}\n" if r.random() < 0.1 else ""
    return kind, files.camera_text(eye, focus, up, lens, r.randint(16, most), r.randint(16, most), clip)


def options(r):
    """Options that must not change an image: brick size, omitted mechanisms."""
    words = []
    if r.random() < 0.6:
        words += ["--brick-size", str(r.choice([2, 4, 8, 13, 16, 64]))]
    if r.random() < 0.4:
        words += ["--without", r.choice(["culling", "skipping", "termination", "culling,skipping"])]
    return words


def extinction(r, size):
    return 10 ** r.uniform(-1, 2) / size


def color(r):
    return [r.random() for _ in range(3)]


def made(r, folder, n, values, association, kind, function, words, args=()):
    """`function(size)` returns the knots."""
    form, path, corner = write(r, folder, n, values, association, kind)
    view, text = camera(r, corner)
    extra = options(r) + list(args)
    return {"input": [path], "function": function(math.dist([0, 0, 0], corner)), "camera": text, "args": extra,
            "methods": METHODS, "words": f"{words}, {form}{kind} {association} {n}, {view} {' '.join(extra)}"}
