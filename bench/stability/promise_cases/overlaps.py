# SPDX-License-Identifier: BSD-3-Clause
"""Cells that overlap, on several ranks: the image equals one process's, whatever the partition.

The result for overlapping cells is a convention, the nearer entry first; if entries are at one depth up to rounding, the
reference may use another order, so it is not used here.
"""
from promise_cases.files import split_box, write_vtu
from promise_cases.plateau_meshes import camera
from promise_cases.surfaces_on_ranks import check  # noqa: F401


def case(r, folder, tessera):
    points, tets = [], []
    blocks = r.choice((2, 2, 3))
    for _ in range(blocks):
        low = [r.uniform(-1, 0) for _ in range(3)]
        high = [x + r.uniform(0.5, 1) for x in low]
        some, own = split_box([r.randint(1, 3) for _ in range(3)], low, high)
        tets += [tuple(v + len(points) for v in t) for t in own]
        points += some
    r.shuffle(tets)
    scalars = [r.uniform(-1, 1) for _ in points]
    dense = 10 ** r.uniform(-1, 1)
    knots = [(-1.0, 1.0, 0.3, 0.1, dense), (0.0, 0.2, 0.9, 0.1, 0.1 * dense), (1.0, 0.1, 0.5, 1.0, dense)]
    return {"input": [write_vtu(folder / "mesh.vtu", points, tets, scalars)], "function": knots, "camera": camera(r, 24),
            "ranks": r.choice((2, 3)), "partition": r.choice(("file", "curve", "random")), "verified": False,
            "methods": [r.choice((["--integrator", "exact"], ["--accuracy", "1e-4"]))], "words": f"{blocks} blocks that overlap"}
