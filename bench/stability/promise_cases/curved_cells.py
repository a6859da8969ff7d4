# SPDX-License-Identifier: BSD-3-Clause
"""Single cells of second order, bent at random: the error of the image of their tets, compared with the value that `render` states.

The exact result is the same cell cut uniformly into tets by this file: positions and field by the polynomials of each type, from its
monomials and nodes. A case is broken if a pixel has a larger error than stated, or if more is stated than requested, without
a warning.
"""
import itertools
import json
import math

import promises
from promise_cases import files
from promise_cases.mesh_scenes import any_camera

ACCURACY = 0.01
CUTS = 40  # per edge; a pixel for which 20 cuts differ by a quarter of the stated error is excused
EXCUSABLE = 3e-3


def powers(*degrees):
    return list(itertools.product(*(range(d + 1) for d in degrees)))


HEX = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
HEX_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
WEDGE = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1)]
WEDGE_EDGES = [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)]
TET = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
TET_EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
PLANE_2 = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)]


def middles(corners, groups):
    return [tuple(sum(corners[c][i] for c in group) / len(group) for i in range(3)) for group in groups]


def nodes(corners, edges, faces=(), inside=False):
    more = [tuple(range(len(corners)))] if inside else []
    return corners + middles(corners, edges) + middles(corners, faces) + middles(corners, more)


def superlinear(p):
    return sum(n for n in p if n > 1)


SIDES = [(0, 3, 7, 4), (1, 2, 6, 5), (0, 1, 5, 4), (2, 3, 7, 6)]
# VTK's number: nodes in VTK's order, the monomials of the type, the part of the cube that the cell fills (pieces()).
TYPES = {
    24: (nodes(TET, TET_EDGES), [p for p in powers(2, 2, 2) if sum(p) <= 2], "tet"),
    25: (nodes(HEX, HEX_EDGES), [p for p in powers(2, 2, 2) if superlinear(p) <= 2], "cube"),
    26: (nodes(WEDGE, WEDGE_EDGES), [(*p, k) for p in PLANE_2 for k in (0, 1)] + [(0, 0, 2), (1, 0, 2), (0, 1, 2)], "wedge"),
    29: (nodes(HEX, HEX_EDGES, [*SIDES, (0, 1, 2, 3), (4, 5, 6, 7)], True), powers(2, 2, 2), "cube"),
    31: (nodes(WEDGE, WEDGE_EDGES[:6]), [(*p, k) for p in PLANE_2 for k in (0, 1)], "wedge"),
    32: (nodes(WEDGE, WEDGE_EDGES, [(0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)]), [(*p, k) for p in PLANE_2 for k in (0, 1, 2)], "wedge"),
    33: (nodes(HEX, HEX_EDGES, SIDES), [p for p in powers(2, 2, 2) if superlinear(p[:2]) <= 2], "cube"),
}


def solved(matrix, right):
    """The x of matrix x = right, whose rows may have several columns: Gaussian elimination, with the largest pivot of a column."""
    rows = [list(a) + list(b) for a, b in zip(matrix, right)]
    n = len(rows)
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for i in range(n):
            if i != k and rows[i][k]:
                by = rows[i][k] / rows[k][k]
                rows[i] = [a - by * b for a, b in zip(rows[i], rows[k])]
    return [[x / rows[k][k] for x in rows[k][n:]] for k in range(n)]


def pieces(part, cuts):
    """Places and tets in the cell's own coordinates: the cube cut uniformly, each small cube into six along one diagonal. The wedge is
    its part with x >= y, the tet that with x >= y >= z, which such tets fill exactly."""
    holds = {"cube": lambda x, y, z: True, "wedge": lambda x, y, z: x >= y, "tet": lambda x, y, z: x >= y >= z}[part]
    own = {"cube": lambda x, y, z: (x, y, z), "wedge": lambda x, y, z: (x - y, y, z), "tet": lambda x, y, z: (x - y, y - z, z)}[part]
    number, places, tets = {}, [], []
    for p in itertools.product(range(cuts + 1), repeat=3):
        if holds(*p):
            number[p] = len(places)
            places.append([c / cuts for c in own(*p)])
    for p in itertools.product(range(cuts), repeat=3):
        for way in itertools.permutations(range(3)):
            q, corners = list(p), [p]
            for axis in way:
                q[axis] += 1
                corners.append(tuple(q))
            if all(holds(*c) for c in corners):
                tets.append([number[c] for c in corners])
    return places, tets


EVEN = {}


def determinants(place, coefficients, monomials):
    """Of the map's derivatives at a place in the cell's own coordinates."""
    rows = []
    for axis in range(3):
        change = [0.0, 0.0, 0.0]
        for c, p in zip(coefficients, monomials):
            if p[axis]:
                lower = [n - (i == axis) for i, n in enumerate(p)]
                value = p[axis] * math.prod(x ** n for x, n in zip(place, lower))
                change = [s + value * x for s, x in zip(change, c)]
        rows.append(change)
    a, b, c = rows
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])


def write_cell(path, kind, points, values):
    body = (f'>\n<Piece NumberOfPoints="{len(points)}" NumberOfCells="1">\n' + files.field("point", "Float64", values) + "<Points>" +
            files.array("Points", "Float64", [x for p in points for x in p], 3) + "</Points>\n<Cells>" +
            files.array("connectivity", "Int64", range(len(points))) + files.array("offsets", "Int64", [len(points)]) +
            files.array("types", "UInt8", [kind]) + "</Cells>\n</Piece>\n")
    path.write_text(files.document("UnstructuredGrid", body))
    return path


def case(r, folder, tessera):
    kind = r.choice(sorted(TYPES))
    places, monomials, part = TYPES[kind]
    if part not in EVEN:
        EVEN[part] = [pieces(part, cuts) for cuts in (CUTS // 2, CUTS)]
    even = EVEN[part][0][0]
    while True:
        bend, rough, phase = r.uniform(0, 0.3), r.choice((0.0, r.uniform(0, 0.06))), [r.uniform(0, 6) for _ in range(3)]
        points = [[p[i] - 0.4 + bend * math.sin((2 + i) * p[(i + 1) % 3] + p[(i + 2) % 3] + phase[i]) + rough * r.uniform(-1, 1)
                   for i in range(3)] for p in places]
        values = [p[0] + 0.5 * p[1] - p[2] + bend * 3 * math.sin(2 * p[0] + p[1] * 3 + phase[0]) + r.uniform(-0.1, 0.1) for p in places]
        matrix = [[math.prod(x ** n for x, n in zip(p, powers_of)) for powers_of in monomials] for p in places]
        coefficients = solved(matrix, [[*p, v] for p, v in zip(points, values)])
        some = [determinants(p, coefficients, monomials) for p in even[::5]]
        if min(some) > 0.1 * max(some):  # otherwise folded, or almost
            break
    truth = []
    for even, tets in EVEN[part]:
        whole = []
        for p in even:
            value = [0.0] * 4
            for c, n in zip(coefficients, monomials):
                by = p[0] ** n[0] * p[1] ** n[1] * p[2] ** n[2]
                value = [s + by * x for s, x in zip(value, c)]
            whole.append(value)
        truth.append(files.write_vtu(folder / f"even{len(truth)}.vtu", [v[:3] for v in whole], tets, [v[3] for v in whole]))
    low, high = min(v[3] for v in whole), max(v[3] for v in whole)
    dense = 10 ** r.uniform(-0.5, 1)
    knots = [(low + (high - low) * k / 3, r.random(), r.random(), r.random(), dense * r.random()) for k in range(4)]
    return {"input": [write_cell(folder / "cell.vtu", kind, points, values)], "truth": truth, "function": knots,
            "camera": any_camera(r, 64).text(), "methods": [["--accuracy", str(ACCURACY)]], "words": f"type {kind}, bent by {bend:.2g}, {rough:.2g}"}


def check(case, methods, tally):
    made, broken = case.made, []
    for words in methods:
        status, _, said, path = case.render(words, verify=False)
        if status != 0:
            return False, f"status {status}: {said}"
        mesh = json.loads((case.folder / "report.json").read_text())["mesh"]
        stated = mesh["higher_order"].get("pixel_error", 0.0)
        picture = promises.pixels_of(path)[2]
        cell, pictures = made["input"], []
        for name in ("even0.pfm", "even1.pfm"):
            made["input"] = [made["truth"][len(pictures)]]
            status, _, said, path = case.render(["--integrator", "exact"], verify=False, name=name)
            if status != 0:
                return False, f"even tets: status {status}: {said}"
            pictures.append(promises.pixels_of(path)[2])
        made["input"] = cell
        pixels = [[max(abs(a - b) for a, b in zip(one[n:n + 3], pictures[1][n:n + 3])) for n in range(0, len(picture), 3)]
                  for one in (picture, pictures[0])]
        known = [off for off, doubt in zip(*pixels) if doubt <= stated / 4]
        error = max(known, default=0.0)
        tally["pixels"] += len(pixels[0])
        tally["excused"] += len(pixels[0]) - len(known)
        tally["frames"] += 1
        tally["worst"] = max(tally["worst"], error / stated if stated else math.inf if error > 1e-6 else 0.0)
        tally.setdefault("stated", []).append(stated / max(pixels[0]) if any(pixels[0]) else math.inf)
        if not error <= stated or not (stated <= float(words[1]) or mesh["warnings"]):  # with too few tets
            broken.append(f"{' '.join(words)}: off by {error:.3g}, stated {stated:.3g}")
    return not broken, "; ".join(broken)


def summary(tally):
    times = sorted(tally["stated"])
    return (f"stated is {times[0]:.2g} to {times[-1]:.2g} times the truth, {times[len(times) // 2]:.2g} in the median, "
            f"up to 4 times in {sum(t <= 4 for t in times)} of {len(times)}")
