# SPDX-License-Identifier: BSD-3-Clause
"""Meshes and grids with everything that can be drawn in them, in layers of --peel. Every layer is compared with the reference by
--verify; composited they equal the image; and some pixels' layers are compared with _oracle.py, which cuts rays itself.
"""
from promise_cases import _exr, _oracle, grid_scenes, mesh_scenes

TOLERANCE = 1e-5


def case(r, folder, tessera):
    made = (mesh_scenes if r.random() < 0.6 else grid_scenes).case(r, folder, tessera)
    threshold, layers = r.choice((0.3, 0.5, 0.9, r.uniform(0.05, 0.95))), r.randint(1, 5)
    made["peel"] = (threshold, layers)
    made["pixels"] = made["pixels"][:6]
    made["methods"] = [["--peel", f"{threshold!r}:{layers}"]]
    made["words"] += f", {layers} layers of {threshold:.3g}, {made['ranks']} ranks"
    return made


def layers_of(made, number):
    """[(rgb, opacity)] of a pixel, by the oracle."""
    light = _oracle.LayeredLight(*made["peel"])
    mesh_scenes.pixel_of(made, light=light)(number)
    return light.layers()


def check(case, methods, tally):
    import promises

    made = case.made
    threshold, count = made["peel"]
    words = [*methods[0], *made["on_ranks"]]
    status, frame, said, path = case.render(words, name="picture.exr", ranks=made["ranks"])
    if status == 2 and "nothing is left" in said:
        return True, ""
    if status not in (0, 4) or frame is None:
        return False, f"status {status}: {said}"
    broken = []
    error, bound = promises.counted(frame, tally)
    if status == 4 or not error <= bound:
        broken.append(f"{error} from the reference")
    _, _, whole = _exr.read(path)
    layers = [_exr.read(path.with_name(f"picture.layer{n + 1}.exr"))[2] for n in range(count)]
    worst = 0.0
    for n in range(len(whole["R"])):
        through, flat = 1.0, [0.0] * 4
        for layer in layers:
            values = [layer[c][n][0] for c in "RGBA"]
            flat = [a + through * b for a, b in zip(flat, values)]
            through *= 1 - values[3]
        worst = max(worst, *(abs(a - whole[c][n][0]) for a, c in zip(flat, "RGBA")))
    if not worst <= (count + 1) * TOLERANCE:  # each layer's bound, plus the image's own
        broken.append(f"layers composited are {worst:.3g} from the picture")
    for n in made["pixels"]:
        for k, (rgb, opacity) in enumerate(layers_of(made, n)):
            got = [layers[k][c][n][0] for c in "RGBA"]
            off = max(abs(a - b) for a, b in zip((*rgb, opacity), got))
            # The oracle's grids are linear, with an error of 1e-7; light behind a cut is amplified by the inverse of
            # the layer's transmittance.
            bound = TOLERANCE + (1e-7 / (1 - threshold) ** k if made["input"][0].suffix == ".vti" else 0)
            tally["worst"] = max(tally["worst"], off / bound)
            if not off <= bound:
                broken.append(f"pixel {n}, layer {k + 1}: {off:.3g} from the oracle")
    return not broken, "; ".join(broken[:4])
