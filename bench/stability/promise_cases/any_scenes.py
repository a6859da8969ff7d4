# SPDX-License-Identifier: BSD-3-Clause
"""Any generated mesh or grid, transfer function, view and accuracy from 1e-2 to 1e-5."""
import math
import subprocess

from promise_cases import files


def transfer_function(r, low, high):
    """Knots over (about) a field's range: ramps, steps, clear intervals, extinctions of 1e-3 to 1e4 per world size."""
    count = r.choice([1, 2, 3, 5, 8, 14, 15, 20, 40, 200])
    strength = 10 ** r.uniform(-3, 4) if r.random() < 0.3 else 10 ** r.uniform(-1, 1.5)
    wide = r.choice([0.6, 1.0, 1.0, 2.0])
    values = sorted(low + (high - low) * (0.5 + wide * (r.random() - 0.5)) for _ in range(count))
    knots = []
    for i, v in enumerate(values):
        kappa = 0.0 if r.random() < 0.3 else strength * r.random() ** 2
        knots.append((v, r.random(), r.random(), r.random(), kappa))
        if r.random() < 0.15:
            knots.append((v, r.random(), r.random(), r.random(), strength * r.random()))
    return knots


def camera(r, size):
    """The world is about [-1, 1]^3: from outside or inside, along an axis or not."""
    away = r.choice([4.0, 2.5, 1.0, 0.3])
    direction = [r.gauss(0, 1) for _ in range(3)]
    if r.random() < 0.2:
        direction = r.choice([[0, 0, 1], [1, 0, 0], [0, 1, 0]])
    norm = math.hypot(*direction) or 1.0
    at = [round(r.uniform(-0.3, 0.3), r.choice([1, 6])) for _ in range(3)]
    eye = [a + away * d / norm for a, d in zip(at, direction)]
    up = [0, 1, 0] if abs(direction[1]) < 0.9 * norm else [1, 0, 0]
    lens = f"parallel_scale {10 ** r.uniform(-1.5, 0.5)!r}" if r.random() < 0.5 else f"view_angle {r.choice([5, 30, 60, 120, 165])}"
    clip, near = "", away * r.uniform(0.2, 1)
    if r.random() < 0.15:
        clip = f"clipping_range {near!r} {near + r.uniform(0.2, 2)!r}\n"
    return files.camera_text(eye, at, up, lens, size, r.choice([size, size // 2 + 1]), clip)


def random_input(r, tessera, folder):
    """(file, options): a generated mesh or grid whose field is about in [0, 1]."""
    if r.random() < 0.35:
        kind, words = r.choice([("ripples", [f"n={r.randint(2, 40)}", f"bits={r.choice([8, 16, 32])}"]),
                                ("checker", [f"n={r.randint(2, 9)}"])])
        path, extra = folder / "input.vti", ["--brick-size", str(r.choice([2, 5, 32]))]
    else:
        kind, words = r.choice([
            ("cube", [f"n={r.randint(1, 12)}", f"jitter={r.choice([0, 0.1, 0.25])}"]),
            ("graded", [f"n={2 * r.randint(2, 5)}", f"volume_ratio={10 ** r.randint(1, 12)}"]),
            ("slivers", [f"n={r.randint(2, 5)}", f"aspect={10 ** r.randint(2, 10)}"]),
            ("stack", [f"layers={10 ** r.randint(0, 3)}", f"width={r.choice([0.02, 0.2, 0.4])}"]),
            ("ball", [f"levels={r.randint(0, 3)}"]), ("annulus", [f"n={8 * r.randint(1, 4)}", f"seam={r.randint(0, 1)}"]),
            ("shells", [f"count={r.randint(1, 5)}", "levels=1", "layers=1"]), ("bars", [f"n={r.randint(1, 16)}"])])
        if r.random() < 0.25:
            words = [*words, "cell_data=1"]
        if r.random() < 0.2:
            words = [*words, f"inverted={r.randint(1, 2)}"]
        path, extra = folder / "input.vtu", []
    subprocess.run([tessera, "generate", kind, path, *words, "--quiet"], check=True, capture_output=True, text=True)
    return path, extra, f"{kind} {' '.join(words)}"


def case(r, folder, tessera):
    path, extra, words = random_input(r, tessera, folder)
    accuracy = 10 ** r.uniform(-5, -2)
    return {"input": [path], "args": extra, "function": transfer_function(r, 0.0, 1.0), "camera": camera(r, r.choice([24, 48, 96])),
            "methods": [["--accuracy", repr(accuracy)]], "words": words}
