#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares `tessera render` with VTK's unstructured-grid ray caster on real meshes: same view, same transfer function.

    xvfb-run -a /usr/bin/python3 bench/compare_vtk.py --data FOLDER [--only bracket,notch] [--write]

FOLDER contains oxygen-post, bluntfin, bracket, disk-out, notch and unisim (described in docs/RESULTS.md). For each, at the default view, with a text transfer
function made here: Tessera's `exact` image, and VTK's twice: of the tets written by `tessera convert` (the difference is the rendering) and of the tets made by
VTK's own reader and vtkDataSetTriangleFilter (the difference also includes reading, and where the cells are not tets, how they are cut). --write also makes the
small default images in docs/images. Needs python3-vtk9 and python3-numpy.
"""
import os
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "peers"))
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

import vtk_raycast
from results import ROOT, Section, data_words, error, options, render, run, written

MESHES = ("oxygen-post", "bluntfin", "bracket", "bracket-perspective", "disk-out", "notch", "unisim")
# Along the field's range: value, linear colour, extinction times the default image's unit distance. Two humps and a
# bright end, so that every part of the range is visible and the order of cells matters.
SHAPE = [(0.0, 0.05, 0.10, 0.50, 0.02), (0.2, 0.05, 0.45, 0.60, 0.06), (0.45, 0.20, 0.80, 0.20, 0.30),
         (0.55, 0.90, 0.80, 0.10, 0.06), (0.8, 0.95, 0.35, 0.05, 0.25), (1.0, 1.00, 0.95, 0.90, 0.60)]


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

def in_child(render, path):
    """The array `render()` returns, computed in a separate process: VTK's ray caster may crash. None if it does."""
    child = os.fork()
    if child == 0:
        np.save(path, render())
        os._exit(0)
    _, status = os.waitpid(child, 0)
    return np.load(path) if status == 0 else None


def difference(ours, theirs):
    """Cells of the table: maximum and RMS, pixels over 0.02 and lit by one alone."""
    if theirs is None:
        return ["VTK crashed", ""], ["", ""]
    apart = np.abs(ours.astype(np.float64) - theirs)
    only_vtk = int(((theirs.max(-1) > 0) & (ours.max(-1) == 0)).sum())
    only_tessera = int(((ours.max(-1) > 1.5 / 255) & (theirs.max(-1) == 0)).sum())  # certainly visible in 8 bits
    return [error(apart.max()), error(np.sqrt((apart ** 2).mean()))], [f"{100 * (apart.max(-1) > 0.02).mean():.2f}", f"{only_vtk} + {only_tessera}"]


def compare(args, name):
    """A row of the table."""
    mesh, *extra = data_words(args, name.removesuffix("-perspective"))
    perspective = ["--projection", "perspective"] if name.endswith("perspective") else []
    report = render(args, mesh, *extra, *perspective, "--size", "512x384")
    field, on_cells, tets = report["mesh"]["field"]["name"], report["mesh"]["field"]["association"] == "cell", report["mesh"]["tets"]
    low, high = report["mesh"]["field"]["range"]
    knots = [(low + (high - low) * t, r, g, b, kappa / report["transfer_function"]["unit_distance"]["value"]) for t, r, g, b, kappa in SHAPE]
    view = report["frames"][0]["view"]
    exact = render(args, mesh, *extra, "--camera", written(args.work / "view.json", view), "--transfer-function",
                   written(args.work / "function.txt", "".join(" ".join(repr(float(x)) for x in k) + "\n" for k in knots)), "--integrator", "exact",
                   "--verify", 300)["frames"][0]
    ours = vtk_raycast.read_pfm(args.work / "picture.pfm")
    run(args.tessera, "convert", mesh, args.work / "tets.vtu", *extra, "--quiet")
    same = vtk_raycast.read_mesh(str(args.work / "tets.vtu"))
    choose_field(same, field, on_cells)
    own = own_tets(mesh, extra[-1] if extra else None, field, on_cells)
    (same_errors, same_pixels), (own_errors, _) = (
        difference(ours, in_child(lambda: vtk_raycast.render(grid, vtk_raycast.camera_of(view), knots, "partial", 0, os.cpu_count(), on_cells)[0],
                                  args.work / "vtk.npy")) for grid in (same, own))
    if args.write and not perspective:
        run(args.tessera, "render", mesh, *extra, "--size", "400x300", "-o", ROOT / "docs" / "images" / f"{name}.png")
    return (f"{name}, {field}{' (cells)' if on_cells else ''}", error(exact["verify"]["max_error"]), *same_errors, *same_pixels, *own_errors,
            f"{tets:,} / {own.GetNumberOfCells():,}")


def main():
    args = options(__doc__, data=pathlib.Path, only=",".join(MESHES))
    section = Section(args)
    section.text(f"Images of 512x384 pixels in linear RGB, VTK {vtk.VTK_VERSION}.")
    section.table("lrrrrrrrl", "mesh, field", "Tessera against the reference", "VTK, same tets: max", "RMS", "over 0.02 [%]", "lit by one alone",
                  "own tets: max", "RMS", "tets: ours / VTK")
    for name in args.only.split(","):
        section.row(*compare(args, name))
    section.keep()


if __name__ == "__main__":
    main()
