# SPDX-License-Identifier: BSD-3-Clause
"""Perspective rays along a mesh's faces, edges and vertices: the tie rule, checked against its definition.

A ray in a face belongs to the cells that a ray shifted by (e, e^2) pixel meets, e infinitely small (docs/ACCURACY.md). So
the image must be the limit of images of the scene shifted by less and less. Here: boxes and lattices with faces in
planes through the eye and a column or row of pixel centres, in front of the eye, around it and behind it, with any camera; with
cell data, so that the wrong side is visible. The reference does not decide which side is right, but must agree (--verify).
"""
import array
import math

from promise_cases.files import camera_text, split_box, write_vtu

# Pixels to the right; down a thousandth of that, because no edge here is that steep. Edges that pass a centre by less
# than the last shift count as passing through it; 1e-4 was not small enough: faces through the eye pass whole rows of
# centres by 1e-6.
SHIFTS = (0.0, 1e-3, 1e-7)
METHODS = [["--integrator", "exact"], ["--integrator", "exact", "--without", "lattice"]]
# A pixel has no limit yet if the two shifted images differ by this: an edge is next to its centre.
NO_LIMIT = 1e-2
TOLERANCE = 5e-5


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    length = math.sqrt(dot(a, a))
    return [x / length for x in a]


def plus(a, *scaled):
    """a + s b for each (s, b)."""
    return [x + math.fsum(s * b[i] for s, b in scaled) for i, x in enumerate(a)]


def direction(r):
    while True:
        v = [r.uniform(-1, 1) for _ in range(3)]
        if 0.1 < dot(v, v) < 1:
            return unit(v)


class View:
    """A random camera, and world points from pixels."""

    def __init__(self, r):
        self.width, self.height = r.choice((9, 16, 21, 32)), r.choice((9, 16, 21, 32))
        self.angle = r.choice((30.0, 60.0, r.uniform(5, 120), 10 ** r.uniform(-1, 1), r.uniform(120, 165)))
        self.eye = [r.choice((0.0, 0.1, r.uniform(-3, 3))) for _ in range(3)]
        kind = r.choice(("axis", "level", "any"))
        if kind == "axis":
            axes = r.sample(range(3), 2)
            look, up = ([r.choice((-1.0, 1.0)) if i == a else 0.0 for i in range(3)] for a in axes)
        elif kind == "level":
            turn = r.choice((r.uniform(0, 6.28), math.radians(r.randrange(360))))
            look, up = [math.cos(turn), 0.0, math.sin(turn)], [0.0, 1.0, 0.0]
        else:
            look, up = direction(r), direction(r)
            while abs(dot(look, up)) > 0.9:
                up = direction(r)
        self.focal = plus(self.eye, (r.choice((1.0, 2.5, r.uniform(1, 4))), look))
        self.view_up = up
        self.forward = unit(plus(self.focal, (-1, self.eye)))
        self.right = unit(cross(self.forward, unit(up)))
        self.up = cross(self.right, self.forward)
        self.per_tangent = self.height / 2 / math.tan(math.radians(self.angle) / 2)

    def camera(self):
        return camera_text(self.eye, self.focal, self.view_up, f"view_angle {self.angle!r}", self.width, self.height)

    def point(self, x, y, depth):
        """The world point at a pixel position and depth."""
        tx, ty = (x - self.width / 2) / self.per_tangent, (self.height / 2 - y) / self.per_tangent
        return plus(self.eye, (depth, self.forward), (depth * tx, self.right), (depth * ty, self.up))

    def shifted(self, p, shift):
        """The point moved so that it appears `shift` pixels further left, and a thousandth of that further up."""
        depth = dot(self.forward, plus(p, (-1, self.eye)))
        part = shift * depth / self.per_tangent
        return plus(p, (-part, self.right), (part * 1e-3, self.up)) if shift else p


def centres(r, size, count):
    return sorted(k + 0.5 for k in r.sample(range(size), min(count, size)))


def projective_lattice(r, view):
    """All of its vertical and horizontal faces are in planes through the eye and pixel centres: frusta, split like boxes."""
    columns, rows = (centres(r, side, r.randint(2, 5)) for side in (view.width, view.height))
    near = r.uniform(0.5, 3)
    depths = [near + r.uniform(0.5, 4) * k for k in range(r.randint(2, 4))]
    depths = sorted(depths)
    points, tets = split_box((len(columns) - 1, len(rows) - 1, len(depths) - 1), (0, 0, 0),
                             (len(columns) - 1, len(rows) - 1, len(depths) - 1))
    return [view.point(columns[round(i)], rows[round(j)], depths[round(k)]) for i, j, k in points], tets


def box_in_plane(r, view):
    """A box of cubes with one plane of faces in that of the eye and a column or row; the eye is at a random position."""
    column = r.random() < 0.5
    place = r.randrange(view.width if column else view.height) + 0.5
    if column:
        along = view.up
        tangent = (place - view.width / 2) / view.per_tangent
        into = unit(plus([0, 0, 0], (1, view.forward), (tangent, view.right)))
    else:
        along = view.right
        tangent = (view.height / 2 - place) / view.per_tangent
        into = unit(plus([0, 0, 0], (1, view.forward), (tangent, view.up)))
    normal = unit(cross(along, into))
    turn = r.choice((0.0, 0.0, r.uniform(0, 6.28)))
    u = plus([0, 0, 0], (math.cos(turn), along), (math.sin(turn), into))
    v = plus([0, 0, 0], (-math.sin(turn), along), (math.cos(turn), into))
    counts = [r.randint(1, 4) for _ in range(3)]
    size = r.choice((0.5, 1.0, r.uniform(0.2, 2)))
    where = r.choice(("before", "before", "round", "on a grid line", "on a vertex"))
    if where == "before":
        distance = r.uniform(1, 6)
        start = plus([0, 0, 0], (distance, into), (r.uniform(-1, 1) * distance * 0.3, along), (-size / 2, u), (-size / 2, v))
        start_u, start_v = dot(start, u), dot(start, v)
    else:
        start_u, start_v = (-r.uniform(0, counts[i]) * size for i in range(2))
        if where != "round":
            start_u = -r.randint(0, counts[0]) * size
        if where == "on a vertex":
            start_v = -r.randint(0, counts[1]) * size
    layer = r.randint(0, counts[2])  # the plane of faces that contains the eye
    flip = r.choice((-1, 1))
    local, tets = split_box(counts, (0, 0, 0), counts)
    points = [plus(view.eye, (start_u + size * i, u), (start_v + size * j, v), (flip * size * (k - layer), normal))
              for i, j, k in local]
    # A vertex at the eye must be exactly there: after rounding it could be anywhere in the image.
    points = [list(view.eye) if math.dist(p, view.eye) < 1e-9 else p for p in points]
    return points, tets, where


def case(r, folder, tessera):
    view = View(r)
    if r.random() < 0.4:
        points, tets = projective_lattice(r, view)
        words = "frusta between rows and columns"
    else:
        points, tets, where = box_in_plane(r, view)
        words = f"a box with faces in the eye's plane, {where}"
    association = r.choice(("cell", "cell", "point"))
    scalars = [r.random() for _ in (tets if association == "cell" else points)]
    scenes = []
    for n, shift in enumerate(SHIFTS):
        moved = [view.shifted(p, shift) for p in points]
        scenes.append([write_vtu(folder / f"scene{n}.vtu", moved, tets, scalars, association)])
    reach = max(math.dist(p, view.eye) for p in points)
    extinction = r.choice((0.5, 3.0)) / reach
    knots = [(0.0, 1.0, 0.0, 0.1, extinction), (0.5, 0.1, 1.0, 0.0, 0.2 * extinction), (1.0, 0.0, 0.2, 1.0, 2 * extinction)]
    return {"input": scenes[0], "scenes": scenes, "function": knots, "camera": view.camera(), "methods": METHODS,
            "words": f"{words}, {association} data, {view.width}x{view.height}, {view.angle:.4g} degrees"}


def values_of(path):
    """The numbers of a .pfm, in its own order."""
    return array.array("f", path.read_bytes().split(b"\n", 3)[3])


def check(case, methods, tally):
    import promises  # the script that imports this module

    broken = []
    for words in methods:
        pictures = []
        for n, scene in enumerate(case.made["scenes"]):
            case.made["input"] = scene
            status, frame, said, path = case.render(words, verify=n == 0, name=f"picture{n}.pfm")
            if status not in (0, 4) or frame is None:
                return False, f"{' '.join(words)}: status {status}: {said}"
            if n == 0:
                error, bound = promises.counted(frame, tally)
                if not error <= bound:
                    broken.append(f"{' '.join(words)}: {error} from the reference")
            pictures.append(values_of(path))
        at, far, near = pictures
        wrong, worst = 0, 0.0
        for i in range(0, len(at), 3):
            change = max(abs(far[i + k] - near[i + k]) for k in range(3))
            error = max(abs(at[i + k] - near[i + k]) for k in range(3))
            if change < NO_LIMIT:
                worst = max(worst, error / (TOLERANCE + change))
                wrong += error > TOLERANCE + change
        tally["worst"] = max(tally["worst"], worst)
        if wrong:
            broken.append(f"{' '.join(words)}: {wrong} pixels of another side, {worst:.3g} times the tolerance")
    return not broken, "; ".join(broken)
