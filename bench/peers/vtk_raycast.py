#!/usr/bin/env python3
"""Renders a tetrahedral mesh with VTK's unstructured-grid ray caster (Bunyk), timed.

    xvfb-run -a /usr/bin/python3 vtk_raycast.py MESH --camera CAM.txt --transfer-function TF.txt
        [--integrator full|partial] [--repeat K] [--threads T] [--output OUT.pfm] [--json OUT.json]

MESH is .tets or .vtu (linear tets only); camera and transfer function are Tessera's text files. Needs python3-vtk9,
python3-numpy and a display (xvfb-run). Also a module: `render` is what compare_vtk.py calls.

What VTK does differently, and is measured as it is: the picture is 8-bit; with `full` the integral comes from a table
(vtkUnstructuredGridPreIntegration), with `partial` from Moreland and Angel's formula and tables for opacity
(vtkUnstructuredGridPartialPreIntegration). VTK's unstructured mappers read "opacity" as extinction per unit distance,
so extinctions pass unchanged. A frame is the time of vtkRenderWindow::Render() after a change of the camera, so that
nothing is reused but what VTK keeps by itself (the faces' neighbours, built in the first frame).
"""
import argparse
import json
import time

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy


def words(path):
    """Lines of words, comments removed."""
    lines = (line.split("#")[0].split() for line in open(path))
    return [line for line in lines if line]


def read_camera(path):
    camera = {w[0]: [float(x) for x in w[1:]] for w in words(path)}
    camera.setdefault("view_up", [0.0, 1.0, 0.0])
    return camera


def read_knots(path):
    return [[float(x) for x in w] for w in words(path)]


def read_mesh(path):
    if path.endswith(".tets"):
        with open(path, "rb") as f:
            vertices, tets = np.fromfile(f, np.int64, 2)
            points = np.fromfile(f, np.float32, 3 * vertices).reshape(-1, 3)
            scalars = np.fromfile(f, np.float32, vertices)
            corners = np.fromfile(f, np.int32, 4 * tets)
        return grid_of(points, corners.reshape(-1, 4), scalars)
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def grid_of(points, corners, scalars, on_cells=False):
    """A vtkUnstructuredGrid of tets with one active scalar array, "f"."""
    grid = vtk.vtkUnstructuredGrid()
    vtk_points = vtk.vtkPoints()
    vtk_points.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=1))
    grid.SetPoints(vtk_points)
    cells = vtk.vtkCellArray()
    offsets = np.arange(0, 4 * len(corners) + 1, 4, dtype=np.int64)
    cells.SetData(numpy_to_vtkIdTypeArray(offsets, deep=1),
                  numpy_to_vtkIdTypeArray(np.ascontiguousarray(corners, dtype=np.int64).ravel(), deep=1))
    grid.SetCells(vtk.VTK_TETRA, cells)
    array = numpy_to_vtk(np.ascontiguousarray(scalars), deep=1)
    array.SetName("f")
    (grid.GetCellData() if on_cells else grid.GetPointData()).SetScalars(array)
    return grid


def render(grid, camera, knots, integrator="partial", repeat=0, threads=None, cells=False):
    """(linear RGB, row 0 at the top, float32 [h, w, 3]; seconds of the first frame; list of `repeat` frames' seconds)"""
    color, extinction = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction()
    color.AllowDuplicateScalarsOn()
    extinction.AllowDuplicateScalarsOn()
    for value, r, g, b, kappa in knots:
        color.AddRGBPoint(value, r, g, b)
        extinction.AddPoint(value, kappa)
    prop = vtk.vtkVolumeProperty()
    prop.SetColor(color)
    prop.SetScalarOpacity(extinction)
    prop.SetScalarOpacityUnitDistance(1.0)
    prop.SetInterpolationTypeToLinear()
    prop.ShadeOff()

    mapper = vtk.vtkUnstructuredGridVolumeRayCastMapper()
    mapper.SetRayCastFunction(vtk.vtkUnstructuredGridBunykRayCastFunction())
    mapper.SetRayIntegrator({"full": vtk.vtkUnstructuredGridPreIntegration,
                             "partial": vtk.vtkUnstructuredGridPartialPreIntegration}[integrator]())
    mapper.AutoAdjustSampleDistancesOff()
    mapper.SetImageSampleDistance(1.0)
    if threads:
        mapper.SetNumberOfThreads(threads)
    if cells:
        mapper.SetScalarModeToUseCellData()
    mapper.SetInputData(grid)
    volume = vtk.vtkVolume()
    volume.SetMapper(mapper)
    volume.SetProperty(prop)

    renderer = vtk.vtkRenderer()
    renderer.SetBackground(0, 0, 0)
    renderer.AddVolume(volume)
    width, height = (int(x) for x in camera["size"])
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(width, height)
    window.AddRenderer(renderer)
    view = renderer.GetActiveCamera()
    view.SetPosition(camera["position"])
    view.SetFocalPoint(camera["focal_point"])
    view.SetViewUp(camera["view_up"])
    if "parallel_scale" in camera:
        view.ParallelProjectionOn()
        view.SetParallelScale(camera["parallel_scale"][0])
    else:
        view.SetViewAngle(camera["view_angle"][0])
    # VTK 9.1's unstructured ray caster casts a pixel's ray through its lower left corner, and spreads n pixels' rays over
    # n - 1 pixels (measured: its pictures fit exact ones when moved by 0.50 pixel and shrunk by 1.0 pixel along both
    # axes). The opposite transform after the projection puts its rays through the middles.
    middle = vtk.vtkTransform()
    middle.Translate(-1.0 / width, -1.0 / height, 0)
    middle.Scale(1 - 1.0 / width, 1 - 1.0 / height, 1)
    view.SetUserTransform(middle)
    renderer.ResetCameraClippingRange()

    seconds = []
    for frame in range(repeat + 1):
        view.Modified()
        volume.Modified()
        start = time.perf_counter()
        window.Render()
        seconds.append(time.perf_counter() - start)

    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.ShouldRerenderOff()
    grab.Update()
    pixels = vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars()).reshape(height, width, -1)
    return pixels[::-1, :, :3].astype(np.float32) / 255, seconds[0], seconds[1:]


def write_pfm(path, rgb):
    with open(path, "wb") as f:
        f.write(b"PF\n%d %d\n-1.0\n" % (rgb.shape[1], rgb.shape[0]))
        f.write(np.ascontiguousarray(rgb[::-1], dtype="<f4").tobytes())


def read_pfm(path):
    with open(path, "rb") as f:
        assert f.readline().strip() == b"PF"
        width, height = (int(x) for x in f.readline().split())
        order = "<f4" if float(f.readline()) < 0 else ">f4"
        return np.frombuffer(f.read(), order).reshape(height, width, 3)[::-1].astype(np.float32)


def main():
    parser = argparse.ArgumentParser(description="VTK's unstructured-grid ray caster, timed")
    parser.add_argument("mesh")
    parser.add_argument("--camera", required=True)
    parser.add_argument("--transfer-function", required=True)
    parser.add_argument("--integrator", choices=["full", "partial"], default="partial")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--threads", type=int)
    parser.add_argument("--output")
    parser.add_argument("--json")
    args = parser.parse_args()
    grid = read_mesh(args.mesh)
    rgb, first, seconds = render(grid, read_camera(args.camera), read_knots(args.transfer_function), args.integrator,
                                 args.repeat, args.threads)
    figures = {"renderer": f"VTK {vtk.VTK_VERSION} Bunyk ray caster, {args.integrator} pre-integration",
               "tets": grid.GetNumberOfCells(), "first_ms": 1e3 * first, "frame_ms": [1e3 * s for s in seconds]}
    if args.output:
        write_pfm(args.output, rgb)
    if args.json:
        json.dump(figures, open(args.json, "w"), indent=1)
    print(json.dumps(figures))


if __name__ == "__main__":
    main()
