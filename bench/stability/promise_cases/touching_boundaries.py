# SPDX-License-Identifier: BSD-3-Clause
"""Boundaries that touch themselves in edges and corners, and rays along these: the order of faces at one depth.

The order is that of a ray shifted by (e, e^2) pixel, e infinitely small (docs/ACCURACY.md): so the image must be the limit
of images of the scene shifted by less and less. Here: some of the tets of a lattice whose edges and corners are on pixel
centres, seen along an axis or in perspective, with a boundary of any opacity, matter or none, and sometimes a clip. The
reference does not decide which order is right, but must agree (--verify).
"""
from promise_cases.files import camera_text, split_box, write_vtu
from promise_cases.perspective_ties import METHODS, SHIFTS, View, box_in_plane, check, dot, plus, projective_lattice  # noqa: F401


class Along:
    """An orthographic camera along an axis, whose pixels are an integer fraction of a lattice's cell."""

    def __init__(self, r):
        self.size, self.axis = r.choice((9, 15, 21)), r.randrange(3)
        self.pixel = 1 / r.choice((2, 4, 4, 8))
        self.sign = r.choice((-1.0, 1.0))
        self.forward = [self.sign if i == self.axis else 0.0 for i in range(3)]
        self.right = [1.0 if i == (self.axis + 1) % 3 else 0.0 for i in range(3)]
        self.up = [1.0 if i == (self.axis + 2) % 3 else 0.0 for i in range(3)]
        if self.sign > 0:  # right, up and backwards are a right-handed system
            self.right = [-x for x in self.right]
        self.centre = [float(r.randint(0, 2)) for _ in range(3)]

    def camera(self):
        return camera_text(plus(self.centre, (-8, self.forward)), self.centre, self.up, f"parallel_scale {self.size * self.pixel / 2!r}", self.size, self.size)

    def shifted(self, p, shift):
        return plus(p, (-shift * self.pixel, self.right), (shift * 1e-3 * self.pixel, self.up)) if shift else p


def some_tets(r, tets):
    share = r.choice((0.1, 0.3, 0.5, 0.8))
    return [t for t in tets if r.random() < share] or tets[:1]


def in_perspective(r):
    """A view, with points and tets that meet its pixels' centres. Boundaries through the eye, and points so near to it that the rounding of
    their coordinates is visible, are left out, because the ray may be on either side of them."""
    while True:
        view = View(r)
        points, tets, where = (*projective_lattice(r, view), "before") if r.random() < 0.5 else box_in_plane(r, view)
        off = max(2.0 ** -52 * max(map(abs, [*p, *view.eye])) * view.per_tangent / max(abs(dot(view.forward, plus(p, (-1, view.eye)))), 1e-300)
                  for p in points)  # pixels
        if where == "before" and off < 1e-10:
            return view, points, tets


def case(r, folder, tessera):
    if r.random() < 0.6:
        view, counts = Along(r), [r.randint(1, 3) for _ in range(3)]
        points, tets = split_box(counts, (0, 0, 0), counts)
        words = f"a lattice {'x'.join(map(str, counts))} along an axis"
    else:
        view, points, tets = in_perspective(r)
        words = "a lattice in perspective"
    tets = some_tets(r, tets)
    scalars = [r.random() for _ in points]
    scenes = [[write_vtu(folder / f"scene{n}.vtu", [view.shifted(p, shift) for p in points], tets, scalars)]
              for n, shift in enumerate(SHIFTS)]
    opacity = r.choice((1.0, 0.5, 0.2))
    extinction = r.choice((0.0, 0.0, 0.3))
    knots = [(0.0, 1.0, 0.0, 0.1, extinction), (1.0, 0.0, 0.2, 1.0, extinction)]
    return {"input": scenes[0], "scenes": scenes, "function": knots, "camera": view.camera(), "methods": METHODS[:1],
            "args": ["--surface", f"boundary:red:{opacity}"],
            "words": f"{words}, {len(tets)} tets, boundary of opacity {opacity}, extinction {extinction}"}
