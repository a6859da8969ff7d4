#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""First images: the result of `tessera render FILE -o OUT` without other options, in numbers and on contact sheets.

    bench/first_pictures.py --tessera PROGRAM [--before PROGRAM] [--data FOLDER] [--generated 40] [--sheets FOLDER] [--work FOLDER]
                            [--results docs/RESULTS.md]

Data sets: those of FOLDER (in the layout of its README: one file each, named in DATA below), and the same number of generated ones: meshes
and volumes of `tessera generate`, and volumes that this script writes (scans in Hounsfield units, an MR-like head, labels, signed and
heavy-tailed fields, noise). Images are 1024 x 1024, the program's default size.

For each image, before it is composited over a background:

  covered    pixels with alpha >= 1/255
  alpha      their mean; target: 0.05 to 0.6
  saturated  fraction of covered pixels with alpha >= 0.98; target: at most 2 %
  colours    of covered pixels divided by alpha, converted from sRGB to CIE L*a*b*, in cells of 10 units a side: cells with at least 1 % of
             the pixels, taken largest first, each at least 15 (CIE76) from those taken before; target: 3

Shapes (meshes without a varying field) are solids without these targets. --sheets writes before.png and after.png there:
thumbnails over dark grey with their names. The results have a row
for each data set outside the targets. Needs python3-numpy and python3-pil.
"""
import argparse
import gzip
import os
import pathlib
import struct
import subprocess
import tempfile

import numpy as np
from PIL import Image, ImageDraw

import results_file

DATA = ("oxygen-post/postxyz.bin", "bluntfin/bluntfinxyz.bin", "bracket/bracket_appended_compressed.vtu", "disk-out/disk_out_ref.ex2",
        "notch/notch_stress_fixed.vtk", "unisim/UNISIM-II-D.vtu", "volumes/heptane.nii.gz", "volumes/LIDC2.vti",
        "volumes/engine.nii.gz", "volumes/carotid.vtk")

GENERATED = (
    ("demo.vtu", "demo"), ("cube.vtu", "cube n=16"), ("cube_cells.vtu", "cube n=12 cell_data=6"), ("regular.vtu", "regular"),
    ("graded.vtu", "graded n=16"), ("slivers.vtu", "slivers n=8 aspect=1000"), ("ball.vtu", "ball levels=3"), ("annulus.vtu", "annulus n=32"),
    ("shells.vtu", "shells count=3 levels=2"), ("bars.vtu", "bars n=8"), ("tet.vtu", "tet"), ("small.vtu", "regular scale=1e-9"),
    ("far.vtu", "ball levels=2 offset=1e6"), ("flat.vtu", "regular nx=32 ny=24 nz=2"), ("tall.vtu", "regular nx=6 ny=6 nz=40"),
    ("deep.vtu", "regular nx=6 ny=40 nz=8"), ("ripples.nrrd", "ripples n=64"), ("ripples8.vti", "ripples n=48 bits=8"),
    ("checker.vti", "checker n=8"))


def nifti(path, values, spacing=(1, 1, 1)):
    """A NIfTI-1 volume with an sform: values[k, j, i]."""
    kinds = {"int16": 4, "float32": 16, "uint8": 2}
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, *values.shape[::-1], 1, 1, 1, 1)
    struct.pack_into("<2h", header, 70, kinds[values.dtype.name], values.dtype.itemsize * 8)
    struct.pack_into("<8f", header, 76, 1, *spacing, 1, 1, 1, 1)
    struct.pack_into("<3f", header, 108, 352, 1, 0)
    struct.pack_into("<2h", header, 252, 0, 1)
    for axis in range(3):
        row = [0.0] * 4
        row[axis] = spacing[axis]
        struct.pack_into("<4f", header, 280 + 16 * axis, *row)
    header[344:348] = b"n+1\0"
    with gzip.open(path, "wb", 1) as file:
        file.write(bytes(header) + values.tobytes())


def nrrd(path, values):
    kinds = {"int16": "int16", "float32": "float", "uint8": "uint8", "float64": "double"}
    sizes = " ".join(str(n) for n in values.shape[::-1])
    head = f"NRRD0004\ntype: {kinds[values.dtype.name]}\ndimension: 3\nsizes: {sizes}\nendian: little\nencoding: raw\n\n"
    path.write_bytes(head.encode() + values.tobytes())


def written(folder):
    """Volumes made here, each with a description of what it represents."""
    random = np.random.default_rng(5)
    n = 72
    z, y, x = np.meshgrid(*[np.linspace(-1, 1, n)] * 3, indexing="ij")
    r = np.sqrt(x * x + y * y + z * z)
    head = np.sqrt((x / 0.7) ** 2 + (y / 0.85) ** 2 + (z / 0.95) ** 2)
    nose = np.sqrt((x / 0.12) ** 2 + ((y - 0.85) / 0.2) ** 2 + ((z - 0.05) / 0.2) ** 2)
    ct = np.full(x.shape, -1000.0)
    ct[(head < 1) | (nose < 1)] = 40
    ct[(head < 0.92) & (head > 0.82)] = 900
    ct[head < 0.82] = 30
    ct = ct + random.normal(0, 12, ct.shape)
    lungs = np.full(x.shape, -1000.0)
    lungs[(x / 0.9) ** 2 + (y / 0.6) ** 2 < 1] = 30
    for side in (-1, 1):
        lungs[((x - 0.42 * side) / 0.33) ** 2 + (y / 0.42) ** 2 + (z / 0.85) ** 2 < 1] = -820
    lungs[(x / 0.12) ** 2 + ((y + 0.45) / 0.1) ** 2 < 1] = 500
    mr = np.where(head < 1, 90 + 60 * np.cos(9 * head) + 30 * np.sin(6 * x) * np.cos(5 * y), 0) + np.abs(random.normal(0, 4, x.shape))
    labels = np.zeros(x.shape, np.uint8)
    labels[head < 1] = 1
    for label, (cx, cy, cz, size) in enumerate([(0.3, 0, 0.3, 0.25), (-0.3, 0.1, 0.2, 0.22), (0, 0, -0.4, 0.3), (0.1, -0.4, 0, 0.2)], 2):
        labels[(x - cx) ** 2 + (y - cy) ** 2 + (z - cz) ** 2 < size**2] = label
    blobs = sum(np.exp(-((x - a) ** 2 + (y - b) ** 2 + (z - c) ** 2) * 18) for a, b, c in random.uniform(-0.7, 0.7, (9, 3)))
    f32 = np.float32
    volumes = {
        "ct_head.nii.gz": ct.astype(np.int16), "ct_chest.nii.gz": lungs.astype(np.int16), "mr_head.nii.gz": mr.astype(f32),
        "labels.nrrd": labels, "labels_head.nii.gz": labels, "signed.nrrd": (x * np.exp(-3 * r * r)).astype(f32),
        "waves.nrrd": np.sin(7 * x) .astype(f32) * np.cos(5 * y).astype(f32), "linear.nrrd": (x + 0.3 * y).astype(f32),
        "blobs.nrrd": blobs.astype(f32), "outlier.nrrd": np.where(r < 0.03, 1e6, np.exp(-2 * r)).astype(f32),
        "power.nrrd": (10.0 ** (4 * (1 - r))).astype(f32), "noise.nrrd": random.normal(0, 1, x.shape).astype(f32),
        "radius.nrrd": r.astype(f32), "shell.nrrd": np.exp(-((r - 0.7) / 0.05) ** 2).astype(f32),
        "plume.nrrd": (np.exp(-(x * x + y * y) * 40 / (1.2 + z)) / (1.2 + z)).astype(f32),
        "negative.nrrd": (-5 - 3 * np.exp(-4 * r * r)).astype(f32), "tiny.nrrd": (1e-12 * blobs).astype(f32),
        "huge.nrrd": (1e25 * blobs).astype(f32), "inverted.nrrd": (200 - 150 * blobs).astype(f32),
        "mostly_zero.nrrd": np.where(blobs > 1.0, blobs, 0).astype(f32), "holes.nrrd": np.where(blobs > 0.8, np.nan, r).astype(f32)}
    for name, values in volumes.items():
        (nifti if name.endswith(".nii.gz") else nrrd)(folder / name, np.ascontiguousarray(values))
        yield name


def rendered(program, file, picture):
    done = subprocess.run([program, "render", file, "-o", picture], capture_output=True, text=True, timeout=600)
    if done.returncode != 0:
        raise SystemExit(f"{file}: {done.stderr.strip()}")
    return done.stderr


def lab(srgb):
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    xyz = linear @ np.array([[0.4124, 0.2126, 0.0193], [0.3576, 0.7152, 0.1192], [0.1805, 0.0722, 0.9505]]) / [0.9505, 1, 1.089]
    f = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16 / 116)
    return np.stack([116 * f[..., 1] - 16, 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])], -1)


def measured(picture):
    """covered fraction of the image, mean alpha, saturated fraction, distinguishable colours"""
    rgba = np.asarray(Image.open(picture).convert("RGBA"), np.float64) / 255
    covered = rgba[rgba[..., 3] >= 1 / 255 - 1e-9]
    if len(covered) == 0:
        return 0, 0, 0, 0
    alpha = covered[:, 3]
    cells, counts = np.unique(np.floor(lab(covered[:, :3]) / 10), axis=0, return_counts=True)
    taken = []
    for cell, count in sorted(zip(cells.tolist(), counts.tolist()), key=lambda pair: -pair[1]):
        if count < 0.01 * len(covered):
            break
        if all(np.linalg.norm((np.array(cell) - other) * 10) >= 15 for other in taken):
            taken.append(np.array(cell))
    return len(covered) / rgba[..., 3].size, alpha.mean(), (alpha >= 0.98).mean(), len(taken)


def sheet(pictures, path):
    side, columns = 192, 8
    rows = -(-len(pictures) // columns)
    image = Image.new("RGB", (columns * side, rows * (side + 14)), (20, 20, 20))
    draw = ImageDraw.Draw(image)
    for i, (name, picture) in enumerate(pictures):
        at = (i % columns * side, i // columns * (side + 14))
        over = Image.new("RGBA", (1024, 1024), (60, 60, 60, 255))
        over.alpha_composite(Image.open(picture).convert("RGBA"))
        image.paste(over.convert("RGB").resize((side - 4, side - 4), Image.LANCZOS), (at[0] + 2, at[1] + 14))
        draw.text((at[0] + 4, at[1] + 1), name, fill=(230, 230, 230))
    image.save(path)


def right(row, shape):
    return shape or (0.05 <= row[1] <= 0.6 and row[2] <= 0.02 and row[3] >= 3)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tessera", required=True)
    parser.add_argument("--before", help="another build, for the other sheet and columns")
    parser.add_argument("--data", type=pathlib.Path)
    parser.add_argument("--generated", type=int, default=40)
    parser.add_argument("--sheets", type=pathlib.Path)
    parser.add_argument("--work", type=pathlib.Path)
    parser.add_argument("--results", type=pathlib.Path)
    arguments = parser.parse_args()
    load = os.getloadavg()[0]
    temporary = tempfile.TemporaryDirectory()
    work = arguments.work or pathlib.Path(temporary.name)
    work.mkdir(parents=True, exist_ok=True)
    files = [arguments.data / name for name in DATA] if arguments.data else []
    made = []
    for name, words in GENERATED:
        kind, *parameters = words.split()
        subprocess.run([arguments.tessera, "generate", kind, work / name, *parameters, "--quiet"], check=True)
        made.append(work / name)
    made += [work / name for name in written(work)]
    files += made[: arguments.generated]
    programs = {"after": arguments.tessera} | ({"before": arguments.before} if arguments.before else {})
    rows, pictures = {}, {which: [] for which in programs}
    for file in files:
        for which, program in programs.items():
            picture = work / f"{file.name}.{which}.png"
            said = rendered(program, file, picture)
            is_shape = "shape by depth" in said
            rows.setdefault(file.name, {})[which] = (*measured(picture), is_shape)
            pictures[which].append((file.name, picture))
        print(file.name, *(f"{which}: " + " ".join(f"{x:.3g}" for x in rows[file.name][which]) for which in programs), flush=True)
    table = ["| data set | " + " | ".join(f"{which}: alpha | saturated [%] | colours" for which in reversed(list(programs))) + " |",
             "|---" * (1 + 3 * len(programs)) + "|"]
    outside = {name: row for name, row in rows.items() if not right(row["after"], row["after"][4])}
    for name, row in outside.items():
        cells = [f"{row[w][1]:.2f} | {100 * row[w][2]:.1f} | {row[w][3]}{' (shape)' if row[w][4] else ''}" for w in reversed(list(programs))]
        table.append(f"| {name} | " + " | ".join(cells) + " |")
    good = {w: sum(right(row[w], row[w][4]) for row in rows.values()) for w in programs}
    for which in reversed(list(programs)):
        print(f"{which}: {good[which]} of {len(rows)} within all three bounds")
    for name, row in outside.items():
        print("outside:", name, row["after"])
    if arguments.sheets:
        arguments.sheets.mkdir(parents=True, exist_ok=True)
        for which, some in pictures.items():
            sheet(some, arguments.sheets / f"{which}.png")
    if arguments.results:
        counts = ", ".join((f"{which} " if arguments.before else "") + str(good[which]) for which in reversed(list(programs)))
        caption = (f"{results_file.made(load)} `{results_file.command('first_pictures.py')}`: `tessera render FILE -o OUT`, no other option, "
                   "1024 x 1024. Of pixels with alpha of 1/255 or more: mean alpha (wanted 0.05 to 0.6), share with 0.98 or more (wanted at "
                   f"most 2 %), distinguishable colours (wanted 3); of {len(rows)} data sets within all three: {counts}; shapes, meshes without "
                   "a field, count as within")
        results_file.put(arguments.results, "first_pictures.py", caption, table if outside else [])


if __name__ == "__main__":
    main()
