# SPDX-License-Identifier: BSD-3-Clause
"""Deep images of meshes and grids, some with surfaces, clips and ranks: samples are sorted and do not overlap, and flattened equal the
image; cut anywhere in depth, as OpenEXR interprets deep pixels, they equal the image that ends there, which _oracle.py
computes from the scene with one more clip.
"""
from promise_cases import _exr, grid_scenes, mesh_scenes
from promise_cases.perspective_ties import plus

FLAT, CUT = 1e-5, 1e-3


def case(r, folder, tessera):
    while True:
        made = (mesh_scenes if r.random() < 0.6 else grid_scenes).case(r, folder, tessera)
        if not made["scene"].get("shade") and not made["scene"].get("boundary"):  # refused for grids; a clip has a boundary too
            break
    made["pixels"] = made["pixels"][:6]
    made["cuts"] = [r.random() for _ in made["pixels"]]
    made["words"] += f", {made['ranks']} ranks"
    return made


def composited(samples, n, end):
    """RGBA of a pixel's samples up to a depth."""
    through, flat = 1.0, [0.0] * 4
    for z, back, *values in zip(*(samples[c][n] for c in ("Z", "ZBack", "R", "G", "B", "A"))):
        if z > end or (z == end and back > z):
            continue
        if back > end:
            alpha = 1 - (1 - values[3]) ** ((end - z) / (back - z))
            values = [v * alpha / values[3] for v in values] if values[3] else [0.0] * 4
        flat = [a + through * b for a, b in zip(flat, values)]
        through *= 1 - values[3]
    return flat


def check(case, methods, tally):
    made = case.made
    status, _, said, flat_path = case.render(["--integrator", "exact"], verify=False, name="flat.exr")
    if status == 2 and "nothing is left" in said:
        return True, ""
    if status != 0:
        return False, f"status {status}: {said}"
    status, _, said, path = case.render(["--integrator", "exact", *made["on_ranks"]], verify=False, name="picture.deep.exr",
                                        ranks=made["ranks"])
    if status != 0:
        return False, f"deep: status {status}: {said}"
    _, _, whole = _exr.read(flat_path)
    _, _, samples = _exr.read(path)
    broken = []
    tally["frames"] += 1
    tally["pixels"] += len(whole["R"])
    for n in range(len(whole["R"])):
        places = [*zip(samples["Z"][n], samples["ZBack"][n])]
        if any(a > b for a, b in places) or any(p[1] > q[0] for p, q in zip(places, places[1:])):
            broken.append(f"pixel {n}: samples overlap or are not in order")
        off = max(abs(a - whole[c][n][0]) for a, c in zip(composited(samples, n, float("inf")), "RGBA"))
        if not off <= 2 * FLAT:  # the accuracy of each
            broken.append(f"pixel {n}: {off:.3g} from the picture")
    view, scene = made["view"], made["scene"]
    for n, cut in zip(made["pixels"], made["cuts"]):
        if not samples["Z"][n]:
            continue
        low, high = samples["Z"][n][0], samples["ZBack"][n][-1]
        if low == high:  # one surface: rounding of depth decides whether it is in front or behind
            continue
        end = low + cut * (high - low)
        planes = [*scene.get("planes", []), (plus(view.eye, (end, view.forward)), [-x for x in view.forward])]
        truth = mesh_scenes.pixel_of(made, planes=planes)(n)
        off = max(abs(a - b) for a, b in zip(composited(samples, n, end), truth))
        tally["worst"] = max(tally["worst"], off / CUT)
        if not off <= CUT:
            broken.append(f"pixel {n} cut at {end:.6g}: {off:.3g} from the oracle")
    return not broken, "; ".join(broken[:4])
