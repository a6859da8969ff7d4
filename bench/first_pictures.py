#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""First images: the result of `tessera render FILE -o OUT` without other options, in numbers; the images stay in --work.

Data sets: the ten of --data (of two files the first), and 40 generated ones: meshes and volumes of `tessera generate`, and
volumes that this script writes (scans in Hounsfield units, an MR-like head, labels, signed and heavy-tailed fields, noise). Images are 1024 x 1024, the program's
default size. For each image, before it is composited over a background:

  covered    pixels with alpha >= 1/255
  alpha      their mean; target: 0.05 to 0.6
  saturated  fraction of covered pixels with alpha >= 0.98; target: at most 2 %
  colours    of covered pixels divided by alpha, converted from sRGB to CIE L*a*b*, in cells of 10 units a side: cells with at least 1 % of
             the pixels, taken largest first, each at least 15 (CIE76) from those taken before; target: 3

Shapes (meshes without a varying field) are solids without these targets. The table has a row for each data set outside the targets. Needs python3-numpy and
python3-pil.
"""
import gzip
import pathlib
import struct

import numpy as np
from PIL import Image

from results import DATA, Section, generated, options, run

GENERATED = (
    ("demo.vtu", "demo"), ("cube.vtu", "cube n=16"), ("cube_cells.vtu", "cube n=12 cell_data=6"), ("regular.vtu", "regular"),
    ("graded.vtu", "graded n=16"), ("slivers.vtu", "slivers n=8 aspect=1000"), ("ball.vtu", "ball levels=3"), ("annulus.vtu", "annulus n=32"),
    ("shells.vtu", "shells count=3 levels=2"), ("bars.vtu", "bars n=8"), ("tet.vtu", "tet"), ("small.vtu", "regular scale=1e-9"),
    ("far.vtu", "ball levels=2 offset=1e6"), ("flat.vtu", "regular nx=32 ny=24 nz=2"), ("tall.vtu", "regular nx=6 ny=6 nz=40"),
    ("deep.vtu", "regular nx=6 ny=40 nz=8"), ("ripples.nrrd", "ripples n=64"), ("ripples8.vti", "ripples n=48 bits=8"),
    ("checker.vti", "checker n=8"))


def nifti(path, values):
    """A NIfTI-1 volume with an sform: values[k, j, i]."""
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, *values.shape[::-1], 1, 1, 1, 1)
    struct.pack_into("<2h", header, 70, {"int16": 4, "float32": 16, "uint8": 2}[values.dtype.name], values.dtype.itemsize * 8)
    struct.pack_into("<8f", header, 76, 1, 1, 1, 1, 1, 1, 1, 1)
    struct.pack_into("<3f", header, 108, 352, 1, 0)
    struct.pack_into("<2h", header, 252, 0, 1)
    for axis in range(3):
        struct.pack_into("<f", header, 280 + 20 * axis, 1)
    header[344:348] = b"n+1\0"
    path.write_bytes(gzip.compress(bytes(header) + values.tobytes(), 1))


def nrrd(path, values):
    sizes = " ".join(map(str, values.shape[::-1]))
    kind = {"float32": "float"}.get(values.dtype.name, values.dtype.name)
    path.write_bytes(f"NRRD0004\ntype: {kind}\ndimension: 3\nsizes: {sizes}\nendian: little\nencoding: raw\n\n".encode() + values.tobytes())


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


def lab(srgb):
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    xyz = linear @ np.array([[0.4124, 0.2126, 0.0193], [0.3576, 0.7152, 0.1192], [0.1805, 0.0722, 0.9505]]) / [0.9505, 1, 1.089]
    f = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16 / 116)
    return np.stack([116 * f[..., 1] - 16, 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])], -1)


def measured(picture):
    """Mean alpha, saturated fraction and distinguishable colours of covered pixels."""
    rgba = np.asarray(Image.open(picture).convert("RGBA"), np.float64) / 255
    covered = rgba[rgba[..., 3] >= 1 / 255 - 1e-9]
    if len(covered) == 0:
        return 0, 0, 0
    cells, counts = np.unique(np.floor(lab(covered[:, :3]) / 10), axis=0, return_counts=True)
    taken = []
    for cell, count in sorted(zip(cells.tolist(), counts.tolist()), key=lambda pair: -pair[1]):
        if count < 0.01 * len(covered):
            break
        if all(np.linalg.norm((np.array(cell) - other) * 10) >= 15 for other in taken):
            taken.append(np.array(cell))
    return covered[:, 3].mean(), (covered[:, 3] >= 0.98).mean(), len(taken)


def main():
    args = options(__doc__, data=pathlib.Path)
    files = [args.data / file for file, *_ in DATA.values()] if args.data else []
    files += [generated(args, name, *words.split()) for name, words in GENERATED] + [args.work / name for name in written(args.work)]
    section, outside = Section(args), []
    for file in files:
        picture = args.work / f"{file.name}.png"
        is_shape = "field shape (depth)" in run(args.tessera, "render", file, "-o", picture).err
        alpha, saturated, colours = measured(picture)
        if not is_shape and not (0.05 <= alpha <= 0.6 and saturated <= 0.02 and colours >= 3):
            outside.append((file.name, f"{alpha:.2f}", f"{100 * saturated:.1f}", colours))
        print(f"{file.name}: alpha {alpha:.2f}, saturated {100 * saturated:.1f} %, {colours} colours{', shape' * is_shape}", flush=True)
    if outside:
        section.table("lrrr", "data set", "alpha", "saturated [%]", "colours")
        for row in outside:
            section.row(*row)
    section.keep("`tessera render FILE -o OUT` without other options, 1024 x 1024 pixels. For pixels with alpha of 1/255 or more, the targets are a mean alpha of "
                 "0.05 to 0.6, at most 2 % with alpha of 0.98 or more, and 3 distinguishable colours. Data sets within all three targets: "
                 f"{len(files) - len(outside)} of {len(files)}, counting shapes (meshes without a field), which have no targets")


if __name__ == "__main__":
    main()
