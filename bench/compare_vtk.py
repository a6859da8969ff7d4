#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares `tessera render` with VTK's unstructured-grid ray caster on real meshes: same view, same transfer function.

    xvfb-run -a /usr/bin/python3 bench/compare_vtk.py --data FOLDER --output FOLDER
        [--tessera build/release/apps/tessera] [--only bracket,notch] [--document docs/RESULTS.md] [--images docs/images]

FOLDER of --data contains oxygen-post, bluntfin, bracket, disk-out, notch and unisim (described in docs/RESULTS.md).
For each: Tessera's default image (checked for coverage, darkness, saturation), then at the default view, with a
text transfer function made here, Tessera's `exact` image, and VTK's twice: of the tets written by `tessera convert` (the
difference is the rendering) and of the tets made by VTK's own reader and vtkDataSetTriangleFilter (the difference also
includes reading, and where the cells are not tets, how they are cut). Writes NAME.png (a row for each: Tessera, VTK, eight
times their difference) and figures.json to --output; tables between marks in --document; small default images in
--images.
"""
import argparse
import json
import math
import os
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "peers"))
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

import vtk_raycast

ROOT = pathlib.Path(__file__).resolve().parent.parent
BEGIN, END = "<!-- compare_vtk.py begin -->", "<!-- compare_vtk.py end -->"
FILES = {
    "oxygen-post": ("oxygen-post/postxyz.bin", "oxygen-post/postq.bin"),
    "bluntfin": ("bluntfin/bluntfinxyz.bin", "bluntfin/bluntfinq.bin"),
    "bracket": ("bracket/bracket_appended_compressed.vtu", None),
    "bracket-perspective": ("bracket/bracket_appended_compressed.vtu", None),
    "disk-out": ("disk-out/disk_out_ref.ex2", None),
    "notch": ("notch/notch_stress_fixed.vtk", None),
    "unisim": ("unisim/UNISIM-II-D.vtu", None),
}
# Along the field's range: value, linear colour, extinction times the default image's unit distance. Two humps and a
# bright end, so that every part of the range is visible and the order of cells matters.
SHAPE = [(0.0, 0.05, 0.10, 0.50, 0.02), (0.2, 0.05, 0.45, 0.60, 0.06), (0.45, 0.20, 0.80, 0.20, 0.30),
         (0.55, 0.90, 0.80, 0.10, 0.06), (0.8, 0.95, 0.35, 0.05, 0.25), (1.0, 1.00, 0.95, 0.90, 0.60)]


def tessera(args, *words):
    done = subprocess.run([str(args.tessera), *map(str, words)], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"compare_vtk.py: tessera {' '.join(map(str, words))}\n{done.stderr.strip()}")
    return done.stderr.strip()


# ---- VTK's own reader -----------------------------------------------------------------------------------------------

def first_leaf(blocks):
    iterator = blocks.NewIterator()
    iterator.InitTraversal()
    return iterator.GetCurrentDataObject()


def read_with_vtk(path, q):
    if q:
        reader = vtk.vtkMultiBlockPLOT3DReader()
        reader.SetFileName(str(path))
        reader.SetQFileName(str(q))
        reader.BinaryFileOn()
        reader.SetByteOrderToBigEndian()
        reader.HasByteCountOff()
        reader.MultiGridOff()
        size = os.path.getsize(path)
        with open(path, "rb") as f:
            points = int(np.prod(np.fromfile(f, ">i4", 3).astype(np.int64)))
        reader.SetIBlanking(size == 12 + 16 * points)
    elif path.suffix == ".ex2":
        reader = vtk.vtkExodusIIReader()
        reader.SetFileName(str(path))
        reader.UpdateInformation()
        reader.SetAllArrayStatus(vtk.vtkExodusIIReader.NODAL, 1)
    elif path.suffix == ".vtk":
        reader = vtk.vtkUnstructuredGridReader()
        reader.SetFileName(str(path))
        reader.ReadAllScalarsOn()
        reader.ReadAllVectorsOn()
        reader.ReadAllFieldsOn()
        reader.ReadAllTensorsOn()
    else:
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutputDataObject(0)
    return first_leaf(grid) if grid.IsA("vtkCompositeDataSet") else grid


def drop_hidden(grid):
    ghost = grid.GetCellData().GetArray("vtkGhostType")
    if ghost is None:
        return grid
    keep = np.flatnonzero((vtk_to_numpy(ghost) & (1 | 32)) == 0)
    ids = vtk.vtkIdList()
    for i in keep:
        ids.InsertNextId(int(i))
    grid.GetCellData().RemoveArray("vtkGhostType")  # otherwise the filter blanks by it again
    extract = vtk.vtkExtractCells()
    extract.SetInputData(grid)
    extract.SetCellList(ids)
    extract.Update()
    return extract.GetOutput()


def own_tets(path, q, field, on_cells):
    grid = drop_hidden(read_with_vtk(path, q))
    split = vtk.vtkDataSetTriangleFilter()
    split.TetrahedraOnlyOn()
    split.SetInputData(grid)
    split.Update()
    grid = split.GetOutput()
    choose_field(grid, field, on_cells)
    return vtk_raycast.without_flat(grid, on_cells)


def choose_field(grid, label, on_cells):
    """Makes the array that Tessera calls `label` (NAME or NAME:mag, NAME:x ...) the only one, as float64."""
    attributes = grid.GetCellData() if on_cells else grid.GetPointData()
    array, component = attributes.GetArray(label), None
    if array is None and ":" in label:
        name, component = label.rsplit(":", 1)
        array = attributes.GetArray(name)
    if array is None:
        sys.exit(f"compare_vtk.py: VTK read no array {label}")
    values = vtk_to_numpy(array).astype(np.float64)
    if values.ndim > 1:
        values = np.linalg.norm(values, axis=1) if component in (None, "mag") else values[:, "xyz".find(component)]
    if on_cells and np.count_nonzero(values != values):
        sys.exit("compare_vtk.py: NaN cells are not compared")
    scalars = numpy_to_vtk(np.ascontiguousarray(values), deep=1)
    scalars.SetName("f")
    for data in (grid.GetPointData(), grid.GetCellData()):
        data.Initialize()
    attributes.SetScalars(scalars)


# ---- images ----------------------------------------------------------------------------------------------------------

def encode_srgb(x):
    x = np.clip(x, 0, 1)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.power(x, 1 / 2.4) - 0.055)


def write_png(path, rgb):
    """Display values in [0, 1], row 0 at the top."""
    pixels = np.ascontiguousarray((np.clip(rgb[::-1], 0, 1) * 255 + 0.5).astype(np.uint8))
    image = vtk.vtkImageData()
    image.SetDimensions(rgb.shape[1], rgb.shape[0], 1)
    array = numpy_to_vtk(pixels.reshape(-1, pixels.shape[2]), deep=1)
    image.GetPointData().SetScalars(array)
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(str(path))
    writer.SetCompressionLevel(9)
    writer.SetInputData(image)
    writer.Write()


def read_png(path):
    reader = vtk.vtkPNGReader()
    reader.SetFileName(str(path))
    reader.Update()
    image = reader.GetOutput()
    width, height, _ = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)[::-1] / 255.0


def looks(path):
    """Possible faults of a default image, as numbers over the pixels where anything is visible."""
    rgba = read_png(path)
    alpha, shown = rgba[..., 3], rgba[..., 3] > 0
    rgb = rgba[..., :3]
    return {"covered": float(shown.mean()), "mean_alpha": float(alpha[shown].mean()), "max_alpha": float(alpha.max()),
            "opaque": float((alpha[shown] > 0.98).mean()),
            "saturated": float(((rgb * alpha[..., None]).max(-1)[shown] > 0.98).mean()),
            "dark": float(((rgb * alpha[..., None]).max(-1)[shown] < 0.05).mean()),
            "colors": int(len(np.unique((rgba[shown] * 31).astype(int), axis=0)))}


def in_child(render, path):
    """The array `render()` returns, computed in a separate process: VTK's ray caster may crash. None if it does."""
    child = os.fork()
    if child == 0:
        np.save(path, render())
        os._exit(0)
    _, status = os.waitpid(child, 0)
    return np.load(path) if status == 0 else None


def difference(ours, theirs):
    d = np.abs(ours.astype(np.float64) - theirs)
    largest = d.max(-1)
    y, x = np.unravel_index(largest.argmax(), largest.shape)
    outside = (theirs.max(-1) > 0) & (ours.max(-1) == 0)
    missed = (ours.max(-1) > 1.5 / 255) & (theirs.max(-1) == 0)  # certainly visible in 8 bits
    return {"max": float(d.max()), "max_inside": float(largest[~outside].max()),
            "only_vtk": int(outside.sum()), "only_tessera": int(missed.sum()), "rms": float(np.sqrt((d ** 2).mean())), "over_0.02": float((largest > 0.02).mean()),
            "p99.9": float(np.quantile(largest, 0.999)),
            "worst": [int(x), int(y)], "mean_signed": float((ours.astype(np.float64) - theirs).mean())}


def compare(args, name):
    mesh, q = FILES[name]
    mesh, q = args.data / mesh, (args.data / q if q else None)
    out = lambda suffix: args.output / f"{name}{suffix}"
    extra = (["--q", q] if q else [])
    view_words = ["--projection", "perspective"] if name.endswith("perspective") else []
    said = tessera(args, "render", mesh, *extra, *view_words, "--size", args.size, "-o", out("-default.png"), "--report",
                   out("-default.json"))
    report = json.loads(out("-default.json").read_text())
    field, on_cells = report["mesh"]["field"]["name"], report["mesh"]["field"]["association"] == "cell"
    low, high = report["mesh"]["field"]["range"]
    unit = report["transfer_function"]["unit_distance"]["value"]
    view = report["frames"][0]["view"]
    out("-view.json").write_text(json.dumps(view))
    knots = [(low + (high - low) * t, r, g, b, kappa / unit) for t, r, g, b, kappa in SHAPE]
    out("-tf.txt").write_text("".join(" ".join(repr(float(x)) for x in k) + "\n" for k in knots))

    tessera(args, "render", mesh, *extra, "--camera", out("-view.json"), "--transfer-function", out("-tf.txt"),
            "--integrator", "exact", "-o", out(".pfm"), "--verify", 300, "--report", out(".json"))
    frame = json.loads(out(".json").read_text())["frames"][0]
    tessera(args, "convert", mesh, out(".vtu"), *extra)
    ours = vtk_raycast.read_pfm(out(".pfm"))

    camera = vtk_raycast.camera_of(view)
    same = vtk_raycast.read_mesh(str(out(".vtu")))
    choose_field(same, field, on_cells)
    own = own_tets(mesh, q, field, on_cells)
    pictures = [in_child(lambda grid=g: vtk_raycast.render(grid, camera, knots, "partial", 0, os.cpu_count(), on_cells)[0],
                         out(f"-vtk-{kind}.npy")) for kind, g in (("same", same), ("own", own))]
    rows = [np.concatenate([encode_srgb(ours), encode_srgb(p), np.clip(8 * np.abs(ours - p), 0, 1)], axis=1)
            for p in pictures if p is not None]
    write_png(out(".png"), np.concatenate(rows))
    if args.images and not view_words:
        args.images.mkdir(parents=True, exist_ok=True)
        tessera(args, "render", mesh, *extra, "--size", "400x300", "-o", args.images / f"{name}.png")
    return {"name": name, "said": said, "field": field, "on_cells": on_cells, "tets": report["mesh"]["tets"],
            "vtk_tets": own.GetNumberOfCells(), "looks": looks(out("-default.png")), "verify": frame["verify"],
            "same_tets": pictures[0] is not None and difference(ours, pictures[0]),
            "own_tets": pictures[1] is not None and difference(ours, pictures[1]), "size": view["size"]}


def document(path, figures):
    f = lambda x: f"{x:.1e}".replace("e-0", "e-")
    judged = lambda d: f"{f(d['max'])} | {f(d['rms'])}" if d else "VTK crashed |"
    pixels = lambda d: f"{100 * d['over_0.02']:.2f} | {d['only_vtk']} + {d['only_tessera']}" if d else "|"
    size = "x".join(map(str, figures[0]["size"]))
    lines = [BEGIN, "", f"Pictures of {size}, linear RGB, VTK {vtk.VTK_VERSION}.", "",
             "| mesh, field | Tessera against the reference | VTK, same tets: max | RMS | over 0.02 [%] | lit by one alone | own tets: max | RMS | tets ours / VTK |",
             "|---|---:|---:|---:|---:|---:|---:|---:|---|"]
    for r in figures:
        lines.append(f"| {r['name']}, {r['field']}{' (cells)' if r['on_cells'] else ''} | {f(r['verify']['max_error'])} | "
                     f"{judged(r['same_tets'])} | {pixels(r['same_tets'])} | {judged(r['own_tets'])} | {r['tets']:,} / {r['vtk_tets']:,} |")
    old = path.read_text() if path.exists() else f"{BEGIN}\n{END}\n"
    before, rest = old.split(BEGIN, 1)
    path.write_text(before + "\n".join(lines + ["", END]) + rest.split(END, 1)[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=pathlib.Path, required=True)
    parser.add_argument("--output", type=pathlib.Path, required=True)
    parser.add_argument("--tessera", type=pathlib.Path, default=ROOT / "build" / "release" / "apps" / "tessera")
    parser.add_argument("--only", default=",".join(FILES))
    parser.add_argument("--size", default="512x384")
    parser.add_argument("--document", type=pathlib.Path)
    parser.add_argument("--images", type=pathlib.Path)
    args = parser.parse_args()
    args.output.mkdir(parents=True, exist_ok=True)
    figures = []
    for name in args.only.split(","):
        figures.append(compare(args, name))
        print(json.dumps(figures[-1]), flush=True)
    (args.output / "figures.json").write_text(json.dumps(figures, indent=1) + "\n")
    if args.document:
        document(args.document, figures)


if __name__ == "__main__":
    main()
