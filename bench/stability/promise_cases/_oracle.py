# SPDX-License-Identifier: BSD-3-Clause
"""Rays through tetrahedra and voxels in double precision, for classes whose images are not judged only by the program's own
reference: written for readability, from docs/ACCURACY.md. Places are parameters along a ray o + t d with unit d."""
import bisect
import math

from promise_cases.files import camera_text
from promise_cases.perspective_ties import cross, dot, plus, unit

AMBIENT, DIFFUSE, SPECULAR, SHININESS = 0.2, 0.8, 0.2, 32
NODES = ((-0.9602898564975363, 0.1012285362903763), (-0.7966664774136267, 0.2223810344533745),
         (-0.5255324099163290, 0.3137066458778873), (-0.1834346424956498, 0.3626837833783620),
         (0.1834346424956498, 0.3626837833783620), (0.5255324099163290, 0.3137066458778873),
         (0.7966664774136267, 0.2223810344533745), (0.9602898564975363, 0.1012285362903763))


class Camera:
    """eye, focal point and up, with a parallel scale or a view angle (degrees); rows from the top."""

    def __init__(self, eye, focal, view_up, width, height, scale=None, angle=None):
        self.eye, self.focal, self.view_up, self.width, self.height = eye, focal, view_up, width, height
        self.scale, self.angle = scale, angle
        self.forward = unit(plus(focal, (-1, eye)))
        self.right = unit(cross(self.forward, view_up))
        self.up = cross(self.right, self.forward)

    def text(self):
        lens = f"parallel_scale {self.scale!r}" if self.angle is None else f"view_angle {self.angle!r}"
        return camera_text(self.eye, self.focal, self.view_up, lens, self.width, self.height)

    def ray(self, pixel):
        """(origin, direction) through the centre of a pixel, counted row by row."""
        per_pixel = 2 * (self.scale if self.angle is None else math.tan(math.radians(self.angle) / 2)) / self.height
        x = (pixel % self.width + 0.5 - self.width / 2) * per_pixel
        y = (self.height / 2 - pixel // self.width - 0.5) * per_pixel
        if self.angle is None:
            return plus(self.eye, (x, self.right), (y, self.up)), self.forward
        return self.eye, unit(plus(self.forward, (x, self.right), (y, self.up)))


class Function:
    """The transfer function: knots (value, red, green, blue, extinction), ascending, without steps."""

    def __init__(self, knots):
        self.knots, self.values = knots, [k[0] for k in knots]

    def at(self, s):
        n = bisect.bisect_right(self.values, s)
        if n == 0 or n == len(self.knots):
            return self.knots[max(n - 1, 0)][1:]
        a, b = self.knots[n - 1], self.knots[n]
        u = (s - a[0]) / (b[0] - a[0])
        return [p + (q - p) * u for p, q in zip(a[1:], b[1:])]

    def between(self, s_0, s_1):
        """Positions between two values, as fractions, at which knots are passed, ascending."""
        low, high = min(s_0, s_1), max(s_0, s_1)
        inside = [v for v in self.values if low < v < high]
        return sorted((v - s_0) / (s_1 - s_0) for v in inside)


class Light:
    """The light accumulated by a ray, front to back."""

    def __init__(self):
        self.rgb, self.through = [0.0, 0.0, 0.0], 1.0

    def add_matter(self, function, s_0, s_1, length, lit=(1.0, 0.0)):
        """Adds an interval along which the scalar is linear; `lit`: factor on colors, and white added."""
        own, white = lit
        ends = [0.0, *(function.between(s_0, s_1) if s_0 != s_1 else []), 1.0]
        for a, b in zip(ends, ends[1:]):
            # Within an interval of the function: parts of at most half an optical depth, by Gauss-Legendre quadrature.
            scalar = lambda u: s_0 + (s_1 - s_0) * u
            inside = (lambda u: min(max(u, a + 1e-12 * (b - a)), b - 1e-12 * (b - a)))
            kappa = lambda u: function.at(scalar(inside(u)))[3]
            depth = (kappa(a) + kappa(b)) / 2 * (b - a) * length
            parts = max(1, math.ceil(2 * depth))
            for n in range(parts):
                u_0, u_1 = a + (b - a) * n / parts, a + (b - a) * (n + 1) / parts
                k_0, half, middle = kappa(u_0), (u_1 - u_0) / 2, (u_0 + u_1) / 2
                light = [0.0, 0.0, 0.0]
                for x, weight in NODES:
                    u = middle + half * x
                    k = kappa(u)
                    before = math.exp(-(k_0 + k) / 2 * (u - u_0) * length)
                    color = function.at(scalar(inside(u)))[:3]
                    light = [s + weight * half * length * k * before * (own * c + white) for s, c in zip(light, color)]
                self.rgb = [s + self.through * x for s, x in zip(self.rgb, light)]
                self.through *= math.exp(-(k_0 + kappa(u_1)) / 2 * (u_1 - u_0) * length)

    def add_surface(self, color, opacity, cosine):
        matte, shine = AMBIENT + DIFFUSE * cosine, SPECULAR * cosine ** SHININESS
        self.rgb = [s + self.through * opacity * (c * matte + shine) for s, c in zip(self.rgb, color)]
        self.through *= 1 - opacity


class LayeredLight(Light):
    """Light in layers: a ray is cut where its opacity since the last cut reaches a threshold."""

    def __init__(self, threshold, layers):
        super().__init__()
        self.threshold, self.most, self.done = threshold, layers, []

    def is_full(self):
        return len(self.done) < self.most - 1 and 1 - self.through >= self.threshold

    def cut(self):
        self.done.append((self.rgb, 1 - self.through))
        self.rgb, self.through = [0.0, 0.0, 0.0], 1.0

    def add_matter(self, function, s_0, s_1, length, lit=(1.0, 0.0)):
        while length > 0:
            before = list(self.rgb), self.through
            super().add_matter(function, s_0, s_1, length, lit)
            if not self.is_full():
                return
            low, high = 0.0, 1.0
            for _ in range(50):
                middle = (low + high) / 2
                self.rgb, self.through = list(before[0]), before[1]
                super().add_matter(function, s_0, s_0 + (s_1 - s_0) * middle, length * middle, lit)
                low, high = (low, middle) if self.is_full() else (middle, high)
            self.cut()
            s_0, length = s_0 + (s_1 - s_0) * high, length * (1 - high)

    def add_surface(self, color, opacity, cosine):
        super().add_surface(color, opacity, cosine)
        if self.is_full():
            self.cut()

    def layers(self):
        """(RGB, opacity) of each."""
        empty = [([0.0, 0.0, 0.0], 0.0)] * self.most
        return ([*self.done, (self.rgb, 1 - self.through)] + empty)[:self.most]


def gradient_of(points, scalars):
    """For a field that is linear in a tet."""
    e = [plus(p, (-1, points[0])) for p in points[1:]]
    volume = dot(e[0], cross(e[1], e[2]))
    change = [s - scalars[0] for s in scalars[1:]]
    return [sum(c * n[i] for c, n in zip(change, (cross(e[1], e[2]), cross(e[2], e[0]), cross(e[0], e[1])))) / volume for i in range(3)]


def cosine_of(normal, direction):
    return min(abs(dot(unit(normal), direction)), 1.0) if any(normal) else 1.0


def clipped(planes, origin, direction):
    """(near, far, normal at each) of what clips leave of a ray."""
    near, far, near_normal, far_normal = 0.0, math.inf, None, None
    for point, normal in planes:
        rise = dot(normal, direction)
        place = -dot(normal, plus(origin, (-1, point))) / rise
        if rise > 0 and place > near:
            near, near_normal = place, normal
        elif rise < 0 and place < far:
            far, far_normal = place, normal
    return near, far, near_normal, far_normal


def lit_by(gradient, camera, direction):
    """The factor on colors and the white that is added; the light is at the camera, in the view direction."""
    toward, normal = [-x for x in camera.forward], unit(gradient)
    n_h = abs(dot(normal, unit(plus(toward, (-1, direction)))))
    return AMBIENT + DIFFUSE * abs(dot(normal, toward)), SPECULAR * n_h ** SHININESS


class Mesh:
    """Tets of positive volume that do not overlap, with one scalar per point or cell."""

    def __init__(self, points, tets, scalars, association):
        self.points, self.tets, self.scalars, self.association = points, tets, scalars, association
        self.inverse = []
        faces = {}
        for n, tet in enumerate(tets):
            p = [points[v] for v in tet]
            e = [plus(q, (-1, p[0])) for q in p[1:]]
            volume = dot(e[0], cross(e[1], e[2]))
            self.inverse.append([[x / volume for x in row] for row in (cross(e[1], e[2]), cross(e[2], e[0]), cross(e[0], e[1]))])
            for corner in range(4):
                faces.setdefault(tuple(sorted(tet[:corner] + tet[corner + 1:])), []).append((n, corner))
        self.open = {where[0] for where in faces.values() if len(where) == 1}

    def normal(self, n, face):
        """Of the face opposite to a corner, of any length."""
        return self.inverse[n][face - 1] if face > 0 else [sum(row[i] for row in self.inverse[n]) for i in range(3)]

    def corners(self, n):
        return [self.scalars[n]] * 4 if self.association == "cell" else [self.scalars[v] for v in self.tets[n]]

    def stretches(self, origin, direction, nearest=0.0):
        """(front, back, tet, entered face, exited face, its barycentric coordinates as linear functions) sorted by front."""
        found = []
        for n, tet in enumerate(self.tets):
            start = plus(origin, (-1, self.points[tet[0]]))
            at = [dot(row, start) for row in self.inverse[n]]
            slope = [dot(row, direction) for row in self.inverse[n]]
            lines = [(1 - sum(at), -sum(slope)), *zip(at, slope)]
            front, back, enters, leaves = -math.inf, math.inf, None, None
            for corner, (a, b) in enumerate(lines):
                if b == 0:
                    if a < 0:
                        front, back = 1.0, 0.0
                elif b > 0:
                    if -a / b > front:
                        front, enters = -a / b, corner
                elif -a / b < back:
                    back, leaves = -a / b, corner
            if front < nearest:
                front, enters = nearest, None
            if front < back:
                found.append((front, back, n, enters, leaves, lines))
        return sorted(found)


def mesh_pixel(mesh, function, camera, pixel, iso=(), boundary=None, planes=(), shade=False, light=None):
    """RGB, also in `light`. `iso`: (value, color, opacity) each; `boundary`: (color, opacity); `planes`: (point, normal) each; the side to
    which the normal points is kept."""
    origin, direction = camera.ray(pixel)
    light = light or Light()
    near, far, near_normal, far_normal = clipped(planes, origin, direction)
    for front, back, n, enters, leaves, lines in mesh.stretches(origin, direction):
        is_cut_in, is_cut_out = front < near, back > far
        front, back = max(front, near), min(back, far)
        if not front < back:
            continue
        corners = mesh.corners(n)
        scalar = lambda t: sum((a + b * t) * s for (a, b), s in zip(lines, corners))
        points = [mesh.points[v] for v in mesh.tets[n]]
        gradient = gradient_of(points, corners) if mesh.association == "point" else [0.0, 0.0, 0.0]
        lit = lit_by(gradient, camera, direction) if shade and any(gradient) else (1.0, 0.0)

        def add_boundary(cut_by, face):
            """Where the ray enters or leaves the kept part of the tet: a plane's cut, or a face that no other tet has."""
            normal = cut_by or (mesh.normal(n, face) if (n, face) in mesh.open else None)
            if boundary is not None and normal is not None:
                light.add_surface(*boundary, cosine_of(normal, direction))

        add_boundary(near_normal if is_cut_in else None, enters)
        s_0, s_1 = scalar(front), scalar(back)
        crossings = sorted(((v - s_0) / (s_1 - s_0), color, opacity) for v, color, opacity in iso if min(s_0, s_1) < v < max(s_0, s_1))
        begin = 0.0
        for u, color, opacity in crossings:
            light.add_matter(function, s_0 + (s_1 - s_0) * begin, s_0 + (s_1 - s_0) * u, (back - front) * (u - begin), lit)
            light.add_surface(color, opacity, cosine_of(gradient, direction))
            begin = u
        light.add_matter(function, s_0 + (s_1 - s_0) * begin, s_1, (back - front) * (1 - begin), lit)
        add_boundary(far_normal if is_cut_out else None, leaves)
    return light.rgb


class Grid:
    """Point data: counts, spacing, origin of a regular grid, and its values, x fastest."""

    def __init__(self, counts, spacing, origin, values):
        self.counts, self.spacing, self.origin, self.values = counts, spacing, origin, values

    def stretches(self, origin, direction, near, far):
        """(front, back, voxel) along the ray."""
        start = [(o - p) / s for o, p, s in zip(origin, self.origin, self.spacing)]
        slope = [d / s for d, s in zip(direction, self.spacing)]
        places = set()
        for a, b, n in zip(start, slope, self.counts):
            if b == 0:
                if not 0 < a < n - 1:
                    return
                continue
            at = sorted((k - a) / b for k in range(n))
            near, far = max(near, at[0]), min(far, at[-1])
            places.update(at)
        if not near < far:
            return
        ends = [near, *sorted(t for t in places if near < t < far), far]
        for front, back in zip(ends, ends[1:]):
            middle = [a + b * (front + back) / 2 for a, b in zip(start, slope)]
            yield front, back, [min(max(int(m), 0), n - 2) for m, n in zip(middle, self.counts)]

    def field(self, voxel, place):
        """(value, gradient) of the trilinear field at a world position."""
        x, y, z = ((p - o) / s - v for p, o, s, v in zip(place, self.origin, self.spacing, voxel))
        nx, ny, _ = self.counts
        v = [self.values[voxel[0] + i + nx * (voxel[1] + j + ny * (voxel[2] + k))] for k in (0, 1) for j in (0, 1) for i in (0, 1)]
        mix = lambda d, p, q: (d[0] * (1 - p) + d[1] * p) * (1 - q) + (d[2] * (1 - p) + d[3] * p) * q
        value = mix(v[:4], x, y) * (1 - z) + mix(v[4:], x, y) * z
        return value, [mix((v[1] - v[0], v[3] - v[2], v[5] - v[4], v[7] - v[6]), y, z) / self.spacing[0],
                       mix((v[2] - v[0], v[3] - v[1], v[6] - v[4], v[7] - v[5]), x, z) / self.spacing[1],
                       mix((v[4] - v[0], v[5] - v[1], v[6] - v[2], v[7] - v[3]), x, y) / self.spacing[2]]


def bracketed(f, a, b):
    """The root of a function between two positions at which it has different signs."""
    rises = f(b) > 0
    for _ in range(80):
        middle = (a + b) / 2
        a, b = (a, middle) if (f(middle) > 0) == rises else (middle, b)
    return b


def monotone_parts(f):
    """[0, 1] cut at the turning points of a cubic."""
    at = [f(u) for u in (0, 1 / 3, 2 / 3, 1)]
    c3 = 4.5 * (at[3] - 3 * at[2] + 3 * at[1] - at[0])
    c2 = 4.5 * (at[0] - 2 * at[1] + at[2]) - c3
    c1 = at[3] - at[0] - c2 - c3
    square = c2 * c2 - 3 * c1 * c3
    turns = []
    if square > 0:
        q = -(c2 + math.copysign(math.sqrt(square), c2))
        turns = [u for u in ((q / (3 * c3)) if c3 else 2, (c1 / q) if q else 2) if 0 < u < 1]
    return [0.0, *sorted(turns), 1.0]


def grid_pixel(grid, function, camera, pixel, iso=(), planes=(), shade=False, light=None):
    """RGB, like mesh_pixel(). The matter of an interval in a voxel is lit by the gradient in its middle, between surfaces."""
    origin, direction = camera.ray(pixel)
    light = light or Light()
    near, far, _, _ = clipped(planes, origin, direction)
    for front, back, voxel in grid.stretches(origin, direction, near, far):
        at = lambda u: plus(origin, (front + (back - front) * u, direction))
        value = lambda u: grid.field(voxel, at(u))[0]
        parts = monotone_parts(value)
        crossings = []
        for level, color, opacity in iso:
            for a, b in zip(parts, parts[1:]):
                if (value(a) < level) != (value(b) < level):
                    u = bracketed(lambda x: value(x) - level, a, b)
                    crossings.append((u, color, opacity, cosine_of(grid.field(voxel, at(u))[1], direction)))
        begin = 0.0
        for u, *surface in [*sorted(crossings), (1.0, None)]:
            gradient = grid.field(voxel, at((begin + u) / 2))[1]
            lit = lit_by(gradient, camera, direction) if shade and any(gradient) else (1.0, 0.0)
            bend = max(abs(value(begin + (u - begin) * x) - value(begin) - (value(u) - value(begin)) * x) for x in (0.25, 0.5, 0.75))
            lines = min(400, 1 + math.ceil(math.sqrt(bend / 1e-6)))
            for n in range(lines):
                a, b = begin + (u - begin) * n / lines, begin + (u - begin) * (n + 1) / lines
                light.add_matter(function, value(a), value(b), (back - front) * (b - a), lit)
            if surface[0] is not None:
                light.add_surface(*surface)
            begin = u
    return light.rgb


def check(case, methods, tally, exact, pixel):
    """Whether an image keeps its promise (`exact`: of that integrator) by the reference, and some of its pixels by
    `pixel(number)`, an oracle's; on as many ranks as the case has."""
    import promises  # the script that imports this module

    made = case.made
    status, _, said, _ = case.render(methods[0], verify=False)
    if status == 2 and "nothing is left" in said:
        return True, ""
    broken = promises.judged(case, methods, tally)
    for words in methods:
        bound = exact if words[0] == "--integrator" else float(words[1])
        status, _, said, path = case.render([*words, *made["on_ranks"]], verify=False, ranks=made["ranks"])
        if status != 0:
            return False, f"{made['ranks']} ranks: status {status}: {said}"
        _, _, rgb = promises.pixels_of(path)
        errors = {n: max(abs(a - b) for a, b in zip(pixel(n), rgb[3 * n:3 * n + 3])) for n in made["pixels"]}
        worst = max(errors, key=errors.get)
        tally["worst"] = max(tally["worst"], errors[worst] / bound)
        if not errors[worst] <= bound:
            broken.append(f"{' '.join(words)}: pixel {worst}: {errors[worst]:.3g} of {bound:g} from the oracle")
    return not broken, "; ".join(broken)
