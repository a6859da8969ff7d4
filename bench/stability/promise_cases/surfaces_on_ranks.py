# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces on several ranks, each of which composites its own runs: their order is that of one process, whichever rank has them.

Some tets of a lattice, each with its boundary's triangles again as a surface from a file, in either direction, and with
other colors; seen from anywhere. Each rank has a different share of cells and triangles, so the order at one depth is determined
by several processes. The image must equal one process's, up to the rounding of runs.
"""
import array
import itertools

from promise_cases.files import split_box, write_vtu
from promise_cases.plateau_meshes import camera

TOLERANCE = 2e-6


def boundary_of(tets):
    faces = {}
    for tet in tets:
        for face in itertools.combinations(tet, 3):
            faces.setdefault(tuple(sorted(face)), []).append(face)
    return [found[0] for found in faces.values() if len(found) == 1]


def write_triangles(path, points, triangles):
    lines = ["# vtk DataFile Version 3.0", "triangles", "ASCII", "DATASET POLYDATA", f"POINTS {len(points)} double"]
    lines += [" ".join(repr(float(x)) for x in p) for p in points]
    lines.append(f"POLYGONS {len(triangles)} {4 * len(triangles)}")
    lines += [f"3 {a} {b} {c}" for a, b, c in triangles]
    path.write_text("\n".join(lines) + "\n")
    return path


def case(r, folder, tessera):
    points, tets = split_box([r.randint(1, 3) for _ in range(3)])
    share = r.choice((0.3, 0.7, 1.0))
    tets = [t for t in tets if r.random() < share] or tets[:1]
    scalars = [r.uniform(-1, 1) for _ in points]
    mesh = write_vtu(folder / "mesh.vtu", points, tets, scalars)
    args, surfaces = [], r.sample(("boundary", "skin", "skin again"), r.choice((1, 2, 2, 3)))
    for surface in surfaces:
        name = "boundary"
        if surface != "boundary":
            triangles = [f if r.random() < 0.5 else f[::-1] for f in boundary_of(tets)]
            name = write_triangles(folder / f"{surface.replace(' ', '_')}.vtk", points, triangles)
        args += ["--surface", f"{name}:{r.choice(('red', 'blue', 'green'))}:{r.choice((0.3, 0.5, 1.0))}"]
    if r.random() < 0.3:
        args += ["--iso", f"{r.uniform(-0.5, 0.5)!r}:yellow:0.4"]
    extinction = r.choice((0.0, 0.5))
    knots = [(-1.0, 1.0, 0.3, 0.1, extinction), (1.0, 0.1, 0.5, 1.0, extinction)]
    return {"input": [mesh], "function": knots, "camera": camera(r, 24), "args": args, "ranks": r.choice((2, 3)),
            "partition": r.choice(("file", "curve", "random")), "methods": [["--integrator", "exact"]],
            "words": f"{len(tets)} tets, {', '.join(surfaces)}, extinction {extinction}"}


def check(case, methods, tally):
    """Compares one process's image with the reference, and the ranks' images with that. Ranks that share memory make the pixels of one process; others
    composite runs, which end at each other's triangles only in double precision."""
    import promises  # the script that imports this module

    made, broken = case.made, []

    def image(words, name, **how):
        status, frame, said, path = case.render(words, name=name, **how)
        if status not in (0, 4) or frame is None:
            raise ValueError(f"{' '.join(words)}: status {status}: {said}")
        return frame, array.array("f", path.read_bytes().split(b"\n", 3)[3])

    for words in methods:
        try:
            frame, alone = image(words, "alone.pfm")
            error, bound = promises.counted(frame, tally)
            if not error <= bound and made.get("verified", True):
                broken.append(f"one process: {error} from the reference")
            on_ranks = [*words, "--partition", made["partition"]]
            _, in_double = image([*words, "--without", "lattice"], "double.pfm", verify=False)
            _, shared = image(on_ranks, "shared.pfm", verify=False, ranks=made["ranks"])
            _, runs = image([*on_ranks, "--without", "sharing"], "runs.pfm", verify=False, ranks=made["ranks"])
        except ValueError as fault:
            return False, str(fault)
        if shared != alone:
            broken.append(f"{made['ranks']} ranks that share memory: not the bits of one process")
        error = max(abs(a - b) for a, b in zip(in_double, runs))
        tally["worst"] = max(tally["worst"], error / TOLERANCE)
        if not error <= TOLERANCE:
            broken.append(f"{made['ranks']} ranks: {error:.3g} from one process in double precision")
    return not broken, "; ".join(broken)
