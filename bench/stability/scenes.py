# SPDX-License-Identifier: BSD-3-Clause
"""The stresses: each varies one parameter until something breaks. `stresses()` lists them.

A stress is a name, a description of its parameter, its values from harmless to extreme, and a function from a value to a scene:
{"input": file, "args": words of `tessera render`, "verify": pixels, "methods": None for all, or those it is for}. Scenes
are generated, so that they can be reproduced.
"""
import array
import math
import struct

KNOTS = [(0.0, 0.05, 0.1, 0.6, 0.0), (0.2, 0.1, 0.4, 0.9, 0.3), (0.4, 0.2, 0.8, 0.2, 0.1), (0.6, 0.9, 0.8, 0.1, 1.0),
         (0.8, 0.9, 0.3, 0.1, 0.2), (1.0, 1.0, 0.9, 0.8, 2.0)]


class Maker:
    """Makes inputs in a directory, each once."""

    def __init__(self, folder, tessera):
        self.folder, self.tessera, self.made = folder, tessera, set()

    def path(self, name):
        return self.folder / name

    def generated(self, kind, ext=".vtu", **parameters):
        words = [f"{k}={v!r}" if isinstance(v, float) else f"{k}={v}" for k, v in parameters.items()]
        name = self.path("-".join([kind, *words]).replace("=", "").replace("+", "p") + ext)
        if name not in self.made:
            self.tessera("generate", kind, name, *words, "--quiet")
            self.made.add(name)
        return name

    def text(self, name, lines):
        path = self.path(name)
        path.write_text("".join(" ".join(str(w) for w in line) + "\n" for line in lines))
        return path

    def function(self, name, knots):
        return self.text(name + ".tf.txt", [[repr(float(x)) for x in k] for k in knots])

    def camera(self, name, position, focal_point, scale=None, angle=None, up=(0, 1, 0), clip=None):
        lines = [["position", *map(repr, map(float, position))], ["focal_point", *map(repr, map(float, focal_point))],
                 ["view_up", *up]]
        lines.append(["parallel_scale", repr(float(scale))] if angle is None else ["view_angle", repr(float(angle))])
        if clip:
            lines.append(["clipping_range", *map(repr, map(float, clip))])
        return self.text(name + ".camera.txt", lines)

    def tets(self, name, points, cells, scalars):
        path = self.path(name + ".tets")
        with open(path, "wb") as f:
            f.write(struct.pack("<qq", len(points), len(cells)))
            array.array("f", [x for p in points for x in p]).tofile(f)
            array.array("f", scalars).tofile(f)
            array.array("i", [v for c in cells for v in c]).tofile(f)
        return path

    def loaded(self, path):
        with open(path, "rb") as f:
            n, m = struct.unpack("<qq", f.read(16))
            xyz, s, t = array.array("f"), array.array("f"), array.array("i")
            xyz.fromfile(f, 3 * n), s.fromfile(f, n), t.fromfile(f, 4 * m)
        return ([tuple(xyz[3 * i:3 * i + 3]) for i in range(n)], [tuple(t[4 * i:4 * i + 4]) for i in range(m)], list(s))


def scene(path, *args, verify=300, size="64x64", methods=None):
    return {"input": path, "args": [*args, "--size", size], "verify": verify, "methods": methods}


def seen_across(m, size):
    """A world of [-1, 1]^3 across the longer side of the image, in the middle of the shorter."""
    w, h = map(int, size.split("x"))
    return m.camera(f"across-{size}", (2, 1.5, 4), (0, 0, 0), scale=1.5 * h / max(w, h))


def along_faces(m, angle, *args, **more):
    """A lattice whose faces are at an angle to the view; at angle 0 vertices are on pixel centres: 64 pixels over 2 units, cells of 4 pixels."""
    eye = (1 + 1 / 64 + 4 * math.sin(angle), 1 + 1 / 64 + 4 * math.sin(angle) * 0.7, 4)
    mesh = m.generated("regular", nx=8, ny=8, nz=8, **more)
    return scene(mesh, "--camera", m.camera(f"edge-{angle:g}", eye, (1 + 1 / 64, 1 + 1 / 64, 0), scale=1), *args, verify=4096)


def pile(m, layers, thickness=1.0, extinction=3.0, **more):
    """Layers along the view, seen in their middle."""
    path = m.generated("stack", layers=int(layers), width=0.3, thickness=float(thickness))
    return scene(path, "--transfer-function", m.function(f"stack-{extinction:g}", scaled(KNOTS, extinction=extinction)), "--camera",
                 m.camera("stack", (0.003, 0.001, 5), (0.003, 0.001, 0), scale=0.2), **{"size": "16x16", **more})


def powers(first, last, step=1):
    """10^first, 10^(first + step), ..., 10^last."""
    return [10.0 ** e for e in range(first, last + (1 if step > 0 else -1), step)]


def scaled(knots, values=1.0, extinction=1.0, shift=0.0):
    return [(shift + values * k[0], *k[1:4], extinction * k[4]) for k in knots]


def oscillating(count):
    return [((i + 0.5) / (2 * count), *((0.9, 0.2, 0.1, 4.0) if i % 2 else (0.1, 0.3, 0.9, 0.0))) for i in range(2 * count)]


def hashed(i):
    return (i * 2654435761 % 4294967296) / 4294967296


def random_knots(count):
    return [(i / max(count - 1, 1), hashed(3 * i), hashed(3 * i + 1), hashed(3 * i + 2), 4 * hashed(7 * i + 5))
            for i in range(count)]


def steps(count):
    knots = []
    for i in range(count):
        low, high = ([hashed(11 * i + j) for j in range(3)] + [3 * hashed(13 * i)] for _ in range(2))
        knots.append(((i + 1) / (count + 1), *([hashed(11 * (i - 1) + j) for j in range(3)] + [3 * hashed(13 * (i - 1))])))
        knots.append(((i + 1) / (count + 1), *high))
    return knots


def mesh_stresses(m):
    f = lambda: m.function("plain", KNOTS)
    cube = lambda n=6, **more: m.generated("cube", n=n, **more)
    tf = lambda: ("--transfer-function", f())

    def beside_plane(offset):
        """The eye close to a plane of faces that contains a column of pixel centres, and cell data, which differs on the two sides."""
        s = m.generated("regular", nx=8, ny=8, nz=8, cell_data=1)
        eye = (1 + 0.25 * offset, 0.9, 5)
        turn = math.atan((40.5 - 32) / 32 * math.tan(math.radians(15)))  # column 40 of 64
        at = (eye[0] - 3 * math.sin(turn), 0.9, eye[2] - 3 * math.cos(turn))
        return scene(s, "--camera", m.camera(f"beside-{offset:g}", eye, at, angle=30), *tf(), verify=4096)

    def unshared(share):
        name = f"unshared-{share:g}"
        points, cells, scalars = m.loaded(m.generated("cube", ".tets", n=5))
        p, s, c = list(points), list(scalars), []
        for i, cell in enumerate(cells):
            if hashed(i) >= share:
                c.append(cell)
                continue
            c.append(tuple(range(len(p), len(p) + 4)))
            p += [points[v] for v in cell]
            s += [scalars[v] for v in cell]
        return scene(m.tets(name, p, c, s), *tf())

    def stack(layers, thickness=1.0, extinction=3.0, verify=8):
        # The reference takes a quarter of a minute at 1e5 cells per ray, too long to run it for every method.
        deep = layers > 3e4
        return pile(m, layers, thickness, extinction, verify=1 if deep else verify, methods=("default",) if deep else None)

    def neighbours(ratio):
        """A fan of six tets over a hexagon, and under each a neighbour whose height is smaller by the ratio."""
        ring = [(math.cos(math.pi * i / 3), math.sin(math.pi * i / 3), 0.0) for i in range(6)]
        points = [*ring, (0.0, 0.0, 0.0), (0.1, 0.05, 1.0), (0.1, 0.05, -1.0 / ratio)]
        cells = [(i, (i + 1) % 6, 6, apex) for i in range(6) for apex in (7, 8)]
        scalars = [0.5 + 0.4 * math.sin(2.0 * i) for i in range(6)] + [0.2, 0.9, 0.6]
        return scene(m.tets(f"neighbours-{ratio:g}", points, cells, scalars), "--transfer-function", m.function("neighbours", scaled(KNOTS, extinction=2)))

    def offset(ratio):
        cells = 1 / 3
        return scene(cube(offset=float(ratio * cells)), *tf())

    def scale(value):
        knots = m.function(f"scale-{value:g}", scaled(KNOTS, extinction=1 / value))
        return scene(cube(scale=float(value)), "--transfer-function", knots)

    def with_field(name, change, **function):
        points, cells, scalars = m.loaded(m.generated("cube", ".tets", n=5))
        return scene(m.tets(name, points, cells, list(map(change, scalars))), "--transfer-function", m.function(name, scaled(KNOTS, **function)))

    def with_knots(name, knots):
        return scene(cube(), "--transfer-function", m.function(name, knots))

    def angle(degrees):
        # So near that it covers a hundred pixels even at the widest angle; the middle pixel looks straight ahead.
        return scene(cube(), *tf(), "--camera", m.camera(f"angle-{degrees:g}", (0.1, 0.2, 1.05), (0, 0, 0), angle=degrees),
                     size="65x65", verify=4225)

    def eye(place):
        where = {"outside": (0.3, 0.2, 3), "inside": (0.111, -0.07, 0.05), "on a face": (0.1, 0.05, 0.0),
                 "on an edge": (0.125, 0.0, 0.0), "in a vertex": (0.0, 0.0, 0.0), "on the boundary": (0.3, 0.2, 1.0)}[place]
        s = m.generated("regular", nx=8, ny=8, nz=8, spacing=0.25, offset=-1.0)
        return scene(s, *tf(), "--camera", m.camera("eye-" + place.replace(" ", ""), where, (0.2, 0.3, -1), angle=90))

    def near(share):
        return scene(cube(), *tf(), "--camera", m.camera(f"near-{share:g}", (1.3, 0.9, 3), (0, 0, 0), angle=40,
                                                         clip=(1.8 + 3 * share, 1.8 + 3 * share + 0.5)))

    def subpixel(pixels):
        n = 12  # cells of 2 / n, window of 64 pixels
        # The smallest mesh is a hundredth of a pixel, in the middle of the central pixel.
        return scene(cube(n), *tf(), "--camera", m.camera(f"sub-{pixels:g}", (1.3, 0.9, 5), (0.001, 0.002, 0),
                                                          scale=32.5 * (2 / n) / pixels), size="65x65", verify=4225)

    def zoomed(pixels):
        return scene(m.generated("tet"), *tf(), "--camera",
                     m.camera(f"zoom-{pixels:g}", (0.25, 0.2, 5), (0.25, 0.2, 0), scale=32 / pixels))

    def plateau(places):
        """A saturated field: half of the mesh has a step's value, or is up to `places` last places of a float below it."""
        points, cells, scalars = m.loaded(m.generated("cube", ".tets", n=6))
        values = [1 - int(3 * hashed(i)) * places * 2.0 ** -24 if p[0] + 0.3 * p[1] > 0 else 0.9 * s
                  for i, (p, s) in enumerate(zip(points, scalars))]
        knots = [*KNOTS[:-1], (1.0, 0.1, 0.3, 0.9, 0.1), (1.0, 1.0, 0.9, 0.3, 3.0)]
        return scene(m.tets(f"plateau-{places:g}", points, cells, values), "--transfer-function", m.function("plateau", knots))

    def lengthwise(extinction):
        """A wide view along a thin sheet next to the eye: depth is its length, rays at the edge pass through its thickness."""
        across, down = (-2.0, 0.0, 2.0), (-2.12, -1.12, -0.12)
        points = [(x, y, z) for z in down for y in (-3e-4, 0.0) for x in across]
        at = lambda i, j, k: i + 3 * j + 6 * k
        cells = []
        for i, k in ((0, 0), (1, 0), (0, 1), (1, 1)):
            for u, v in (((1, 0, 0), (1, 1, 0)), ((1, 0, 0), (1, 0, 1)), ((0, 1, 0), (1, 1, 0)), ((0, 1, 0), (0, 1, 1)),
                         ((0, 0, 1), (1, 0, 1)), ((0, 0, 1), (0, 1, 1))):
                cells.append((at(i, 0, k), at(i + u[0], u[1], k + u[2]), at(i + v[0], v[1], k + v[2]), at(i + 1, 1, k + 1)))
        path = m.tets("sheet", points, cells, [0.5] * len(points))
        knots = m.function(f"sheet-{extinction:g}", [(0.0, 0.2, 0.4, 0.9, extinction), (1.0, 0.9, 0.5, 0.2, extinction)])
        return scene(path, "--transfer-function", knots, "--camera",
                     m.camera("sheet", (0.031, 1.73, 0), (0.031, 1.73, -1), angle=140), verify=4096)

    across = lambda size: seen_across(m, size)
    plain = lambda *args, **more: scene(cube(), *tf(), *args, **more)
    return [
        ("slivers", "aspect ratio", powers(2, 14, 2), lambda v: scene(m.generated("slivers", n=4, aspect=v), *tf())),
        ("volume ratio", "largest over smallest cell", powers(1, 15, 2), lambda v: scene(m.generated("graded", n=8, volume_ratio=v), *tf())),
        ("neighbours' volumes", "of two that share a face", powers(0, 12, 3), neighbours),
        ("edge-on faces", "angle to the view, radian", powers(-1, -15, -2) + [0.0], lambda v: along_faces(m, v, *tf())),
        ("faces along rays", "eye beside their plane, cell sides", powers(-1, -15, -2) + [0.0], beside_plane),
        ("coincident vertices", "share of cells with vertices of their own", [0.0, 0.5, 1.0], unshared),
        ("inverted cells", "0 none, 1 all, 2 every other", [0, 1, 2], lambda v: scene(cube(inverted=v), *tf())),
        ("small cells", "pixels a cell", powers(1, -4, -1), subpixel),
        ("large cells", "pixels a cell", powers(1, 9, 2), zoomed),
        ("far from the origin", "offset over cell size", [0.0] + powers(3, 15, 2), offset),
        ("scene scale", "world units", powers(-30, 30, 10), scale),
        ("extinction", "times world size", [0.0] + powers(-12, 12, 4), lambda v: with_knots(f"k-{v:g}", scaled(KNOTS, extinction=v))),
        ("knots", "number", [2, 6, 14, 15, 30, 100, 1000, 4096], lambda v: with_knots(f"knots-{v}", random_knots(v))),
        ("steps", "number", [1, 7, 50, 300], lambda v: with_knots(f"steps-{v}", steps(v))),
        ("plateau at a step", "last places of a float between neighbours", [1e6, 1e4, 256, 16, 1, 0], plateau),
        ("sheet seen lengthwise", "extinction", [1, 10, 100, 200, 300, 1e3, 1e4, 1e6], lengthwise),
        ("oscillations", "over the range", [1, 10, 100, 1000], lambda v: with_knots(f"osc-{v}", oscillating(v))),
        ("field range", "largest value", [0.0] + powers(-30, 30, 10),
         lambda v: with_field(f"field-{v:g}", lambda s: s * v or 0.5, values=v or 1)),
        ("field far from zero", "offset over range", powers(0, 7), lambda v: with_field(f"fieldoffset-{v:g}", lambda s: s + v, shift=v)),
        ("view angle", "degrees", [1, 30, 90, 150, 170, 178, 179], angle),
        ("eye", "place", ["outside", "inside", "on the boundary", "on a face", "on an edge", "in a vertex"], eye),
        ("near plane", "share of the way through", [0.0, 0.25, 0.5, 0.75, 1.0], near),
        ("image", "pixels", ["1x1", "1x777", "777x1", "63x65", "16384x8", "4x16384"], lambda v: scene(cube(), *tf(), "--camera", across(v), size=v)),
        ("tiles", "pixels a side", [1, 7, 31, 32, 33, 1000], lambda v: plain("--tile-size", v, size="101x67")),
        ("memory", "budget", ["64M", "16M", "8M"], lambda v: plain("--memory", v, size="101x67")),
        ("depth complexity", "segments a ray", powers(0, 5), lambda v: stack(v, verify=16)),
        ("nearly equal depths", "thickness of 1e4 layers", powers(0, -15, -3), lambda v: stack(1e4, v, extinction=3 / v)),
        ("faint segments", "optical depth of each of 1e4", powers(-4, -13, -3), lambda v: stack(1e4, extinction=v * 1e4)),
        ("opacity 1e-9 a segment", "segments a ray", powers(2, 5), lambda v: stack(v, extinction=1e-9 * v)),
    ]


def large_stresses(m):
    """Stresses that need 6 GB and minutes."""
    tf = m.function("plain", KNOTS)
    return [("large image", "pixels", ["4096x4096", "16384x16384"],
             lambda v: {**scene(m.generated("cube", n=6), "--transfer-function", tf, size=v, verify=100, methods=("default",)),
                        "seconds": 1800})]


GL = ["--backend", "osmesa", "--compositor", "gl-fragment", "--integrator", "sampled:8", "--framebuffer"]
PRINTED = {"default": [], "sampled:4": ["--integrator", "sampled:4"], "preintegrated:128": ["--integrator", "preintegrated"],
           "paper (scanline, sampled:8)": ["--rasterizer", "scanline", "--integrator", "sampled:8"],
           "sampled:8": ["--integrator", "sampled:8"], "scanline, exact": ["--rasterizer", "scanline", "--integrator", "exact"],
           "GL, 16-bit blending": [*GL, "half"], "GL, 32-bit blending": [*GL, "float"]}


def printed_stresses(m):
    """The limits of the published methods, each with the methods concerned and the default."""
    cube = lambda: m.generated("cube", n=4)

    def peak(width):
        knots = [(0.0, 0.1, 0.2, 0.9, 0.05), (0.5 - width, 0.1, 0.2, 0.9, 0.05), (0.5, 1.0, 0.6, 0.1, 0.5 / width),
                 (0.5 + width, 0.9, 0.4, 0.1, 0.05), (1.0, 0.9, 0.4, 0.1, 0.05)]
        return scene(cube(), "--transfer-function", m.function(f"peak-{width:g}", knots),
                     methods=("default", "sampled:4", "preintegrated:128", "paper (scanline, sampled:8)"))

    def edges(ratio):
        path = m.generated("graded", n=8, volume_ratio=ratio)
        knots = m.function("edges", scaled(KNOTS, extinction=3))
        span = min(1.0, 4 * ratio ** (-1 / 3))  # the view adapts to the smallest cells
        eye = (0.3 * span, 0.2 * span, 4.0)
        return scene(path, "--transfer-function", knots, "--camera", m.camera(f"edges-{ratio:g}", eye, (0, 0, 0), scale=span),
                     methods=("default", "scanline, exact"))

    half = ("GL, 16-bit blending", "GL, 32-bit blending")
    return [
        ("fixed Ns, thin features", "width of a peak over the range", [0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4], peak),
        ("length over the longest edge", "volume of largest over smallest cell", powers(1, 15, 2), edges),
        ("16-bit blending", "segments a ray", [1.0, 10.0, 100.0, 1e3], lambda v: pile(m, v, verify=16, methods=("default", *half))),
        ("lists longer than a texture", "segments a ray", [4e3, 1.6e4, 3.2e4], 
         lambda v: pile(m, v, verify=4, methods=("default", "sampled:8", *half[1:]), size="4x4")),
        ("z_back as the only key", "thickness of 1e3 layers, eye at 5", powers(0, -8, -1),
         lambda v: pile(m, 1e3, v, 3 / v, verify=16, methods=("default", "scanline, exact"))),
        ("no tie rule", "angle of faces to the view, cell data", powers(-1, -9, -2) + [0.0],
         lambda v: {**along_faces(m, v, "--transfer-function", m.function("plain", KNOTS), cell_data=1), "methods": ("default", "scanline, exact")}),
    ]


def volume_stresses(m):
    tf = lambda name="vplain", knots=KNOTS: ("--transfer-function", m.function(name, knots))
    ripples = lambda n=24, **more: m.generated("ripples", ".vti", n=n, **more)

    def raw(name, dims, spacing, value):
        path = m.path(f"{name}.raw")
        w, h, d = dims
        data = array.array("f", (value(i, j, k) for k in range(d) for j in range(h) for i in range(w)))
        path.write_bytes(data.tobytes())
        return path, ["--dims", f"{w}x{h}x{d}", "--type", "float32", "--spacing", ",".join(map(repr, map(float, spacing)))]

    smooth = lambda i, j, k: 0.5 + 0.5 * math.sin(0.4 * i + 0.7 * j) * math.cos(0.5 * k + 0.1 * i)

    def spacing(ratio):
        path, words = raw(f"spacing-{ratio:g}", (16, 16, 16), (1, 1, ratio), smooth)
        knots = scaled(KNOTS, extinction=0.2 / max(ratio, 1))
        return scene(path, *words, *tf(f"spacing-{ratio:g}", knots))

    def thin(dims):
        path, words = raw("thin-" + dims, tuple(map(int, dims.split("x"))), (1, 1, 1), smooth)
        return scene(path, *words, *tf())

    def opaque(kappa):
        knots = [(0.0, 0.1, 0.2, 0.9, 0.0), (0.5, 0.1, 0.2, 0.9, 0.0), (0.5, 0.9, 0.4, 0.1, kappa), (1.0, 0.9, 0.4, 0.1, kappa)]
        return scene(m.generated("checker", ".vti", n=8), *tf(f"opaque-{kappa:g}", knots))

    def steep(depth):
        rough = lambda i, j, k: 0.5 + 0.3 * math.sin(0.9 * i + 0.4 * k) * math.cos(0.7 * j) + 0.2 * hashed(i + 12 * j + 144 * k)
        path, words = raw("steep", (12, 12, 12), (1, 1, 1), rough)
        k = depth / math.hypot(11, 11, 11)
        knots = [(0.0, 0.1, 0.9, 0.3, 0.0), (0.5, 0.1, 0.9, 0.3, 0.0), (0.5002, 0.9, 0.1, 0.3, k), (0.5005, 0.1, 0.2, 0.9, 0.0),
                 (0.71, 0.9, 0.9, 0.1, 0.0), (0.71, 0.9, 0.9, 0.1, 0.3 * k), (0.7103, 0.2, 0.1, 0.9, k), (0.7103, 0.9, 0.9, 0.1, 0.0)]
        return scene(path, *words, *tf(f"steep-{depth:g}", knots), verify=4096)

    def blanks(share):
        holes = lambda i, j, k: math.nan if hashed(i + 24 * j + 576 * k) < share else smooth(i, j, k)
        path, words = raw(f"blank-{share:g}", (24, 24, 24), (1, 1, 1), holes)
        return scene(path, *words, *tf("half-clear", [(0.0, 0, 0, 1, 0.0), (0.4, 0, 0, 0, 0.0), (1.0, 1, 1, 1, 0.3)]), verify=4096)

    def constant(distance):
        path, words = raw("constant", (9, 9, 9), (1, 1, 1), lambda i, j, k: 7.25)
        return scene(path, *words, *tf(f"beside-{distance:g}", [(7.25 - distance, 1, 0, 0, 0.0), (7.25 + 2 * distance, 0, 0, 1, 0.3)]))

    def saturated(places):
        step = 1 - places * 2.0 ** -24
        tanh = lambda i, j, k: 0.5 + 0.5 * math.tanh(0.9 * (math.dist((i, j, k), (11.5, 11.5, 11.5)) - 6))
        path, words = raw("saturated", (24, 24, 24), (1, 1, 1), tanh)
        return scene(path, *words, *tf(f"saturated-{places:g}", [(step, 1, 0.2, 0, 0.01), (step, 0, 0.3, 1, 0.2)]), verify=4096)

    def offset(ratio):
        path, words = raw("raw-offset", (16, 16, 16), (1, 1, 1), smooth)
        return scene(path, *words, *tf(), "--origin", f"{float(ratio)!r},{float(ratio)!r},{float(ratio)!r}")

    def angle(degrees):
        return scene(ripples(), *tf(), "--camera", m.camera(f"vangle-{degrees:g}", (0.1, 0.2, 1.05), (0, 0, 0), angle=degrees),
                     size="65x65", verify=4225)

    return [
        ("voxel spacing", "z over x", powers(-3, 3), spacing),
        ("thin volumes", "samples", ["2x2x2", "2x16x16", "16x2x16", "16x16x2", "2x2x64"], thin),
        ("bricks", "voxels a side", [2, 3, 8, 32, 1000], lambda v: scene(ripples(), *tf(), "--brick-size", v)),
        ("opaque beside empty", "extinction", powers(0, 12, 3), opaque),
        ("knots (grid)", "number", [2, 14, 30, 100, 1000, 4096], lambda v: scene(ripples(), *tf(f"vk-{v}", random_knots(v)))),
        ("oscillations (grid)", "over the range", [1, 10, 100, 1000], lambda v: scene(ripples(), *tf(f"vo-{v}", oscillating(v)))),
        ("extinction (grid)", "times world size", [0.0] + powers(-12, 12, 4), lambda v: scene(ripples(), *tf(f"ve-{v:g}", scaled(KNOTS, extinction=v)))),
        ("peaks of a thousandth (grid)", "extinction times size", powers(0, 8, 2), steep),
        ("blank samples", "share", [0.0, 0.001, 0.03, 0.3, 0.42], blanks),
        ("constant grid", "distance of knots", powers(3, -6, -3), constant),
        ("plateau at a step (grid)", "last places of a float from the step", [1e6, 1e4, 256, 16, 1, 0], saturated),
        ("grid far from the origin", "offset over voxel", [0.0] + powers(3, 12, 3), offset),
        ("view angle (grid)", "degrees", [1, 90, 170, 179], angle),
        ("image (grid)", "pixels", ["1x1", "1x777", "777x1", "63x65"], lambda v: scene(ripples(), *tf(), "--camera", seen_across(m, v), size=v)),
        ("grid scale", "world units", powers(-20, 20, 10), lambda v: scene(
            raw(f"gs-{v:g}", (12, 12, 12), (v, v, v), smooth)[0], *raw(f"gs-{v:g}", (12, 12, 12), (v, v, v), smooth)[1],
            *tf(f"gs-{v:g}", scaled(KNOTS, extinction=0.2 / v)))),
    ]
