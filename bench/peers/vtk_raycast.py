#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Renders a tetrahedral mesh or a regular grid with VTK's software ray casters, timed.

    xvfb-run -a /usr/bin/python3 vtk_raycast.py DATA REPORT.json PICTURE.pfm [--integrator partial] [--step 1] [--repeat K] [--threads T]

DATA is .tets or .vtu (linear tets only) or .vti; view and transfer function are those of a report of `tessera render`, whose image is PICTURE. Prints the
frames' times and the difference from that image as JSON. Needs python3-vtk9, python3-numpy and a display (xvfb-run). Also a module: compare_vtk.py and
vtk_chart.py call `render` and `render_grid`.

Differences of VTK, which are measured as they are: the image is 8-bit. With `full` the integral comes from a table
(vtkUnstructuredGridPreIntegration), with `partial` from Moreland and Angel's formula and tables for opacity
(vtkUnstructuredGridPartialPreIntegration), with `linear` from a formula for colour and opacity that are linear along a
segment, with `homogeneous` from their means. VTK's unstructured mappers interpret "opacity" as extinction per unit distance,
so extinctions are passed unchanged. The fixed-point caster of grids has opacity and colour in 15 bits, and for 8-bit samples
evaluates the transfer function only at integers. A frame is the time of vtkRenderWindow::Render() after a change of
the camera, so that nothing is reused except what VTK caches by itself (the faces' neighbours, built in the first frame).
"""
import argparse
import json
import sys
import time

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy


def camera_of(view):
    """A report's view with a list for each value."""
    return {name: value if isinstance(value, list) else [value] for name, value in view.items()}


def read_grid(path):
    reader = vtk.vtkXMLImageDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    image = reader.GetOutput()
    if image.GetPointData().GetNumberOfArrays() == 0:
        sys.exit("vtk_raycast.py: cell data of a grid have no peer in VTK")
    image.GetPointData().SetActiveScalars(image.GetPointData().GetArrayName(0))
    return image


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


def without_flat(grid, on_cells=False):
    """The grid with its first array, without tets of exactly zero volume (collapsed cells), which are invisible: VTK 9.1's ray caster may crash on them."""
    points = vtk_to_numpy(grid.GetPoints().GetData()).astype(np.float64)
    corners = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)
    scalars = vtk_to_numpy((grid.GetCellData() if on_cells else grid.GetPointData()).GetArray(0)).astype(np.float64)
    a, b, c = (points[corners[:, i]] - points[corners[:, 0]] for i in (1, 2, 3))
    keep = np.einsum("ij,ij->i", np.cross(a, b), c) != 0
    return grid_of(points, corners[keep], scalars[keep] if on_cells else scalars, on_cells)


INTEGRATORS = {"full": vtk.vtkUnstructuredGridPreIntegration, "partial": vtk.vtkUnstructuredGridPartialPreIntegration,
               "linear": vtk.vtkUnstructuredGridLinearRayIntegrator,
               "homogeneous": vtk.vtkUnstructuredGridHomogeneousRayIntegrator}


def render(grid, camera, knots, integrator="partial", repeat=0, threads=None, cells=False, caster="bunyk", seconds=None):
    """(linear RGB, row 0 at the top, float32 [h, w, 3]; seconds of the first frame; list of `repeat` frames' seconds).
    With `seconds`, no further frame once these are spent."""
    color, extinction = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction()
    color.AllowDuplicateScalarsOn()
    extinction.AllowDuplicateScalarsOn()
    for value, r, g, b, kappa in knots:
        color.AddRGBPoint(value, r, g, b)
        extinction.AddPoint(value, kappa)
    if caster == "bunyk":
        mapper = vtk.vtkUnstructuredGridVolumeRayCastMapper()
        mapper.SetRayCastFunction(vtk.vtkUnstructuredGridBunykRayCastFunction())
        if threads:
            mapper.SetNumberOfThreads(threads)
    else:
        mapper = vtk.vtkUnstructuredGridVolumeZSweepMapper()
    mapper.SetRayIntegrator(INTEGRATORS[integrator]())
    mapper.AutoAdjustSampleDistancesOff()
    mapper.SetImageSampleDistance(1.0)
    if cells:
        mapper.SetScalarModeToUseCellData()
    mapper.SetInputData(grid)
    return frames(mapper, color, extinction, 1.0, camera, repeat, seconds)


def render_grid(image, camera, knots, step, repeat=0, threads=None, seconds=None):
    """Like render(), for a vtkImageData with vtkFixedPointVolumeRayCastMapper. `step` in voxels (cube root of a voxel's
    volume)."""
    distance = step * float(np.prod(image.GetSpacing())) ** (1 / 3)
    color, opacity = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction()
    color.AllowDuplicateScalarsOn()
    opacity.AllowDuplicateScalarsOn()
    for value, r, g, b, kappa in knots:
        color.AddRGBPoint(value, r, g, b)
    # Opacity is 1 - exp(-kappa d), which is not linear between knots: intermediate knots keep VTK's function equal to
    # ours.
    for (v0, *_, k0), (v1, *_, k1) in zip(knots, knots[1:]):
        for u in np.linspace(0, 1, 33) if v1 > v0 else ():
            opacity.AddPoint(v0 + (v1 - v0) * u, -np.expm1(-(k0 + (k1 - k0) * u) * distance))
    if len(knots) == 1:
        opacity.AddPoint(knots[0][0], -np.expm1(-knots[0][4] * distance))
    mapper = vtk.vtkFixedPointVolumeRayCastMapper()
    mapper.AutoAdjustSampleDistancesOff()
    mapper.LockSampleDistanceToInputSpacingOff()
    mapper.SetImageSampleDistance(1.0)
    mapper.SetSampleDistance(distance)
    mapper.SetInteractiveSampleDistance(distance)
    if threads:
        mapper.SetNumberOfThreads(threads)
    mapper.SetInputData(image)
    return frames(mapper, color, opacity, distance, camera, repeat, seconds)


def frames(mapper, color, opacity, unit_distance, camera, repeat, budget):
    prop = vtk.vtkVolumeProperty()
    prop.SetColor(color)
    prop.SetScalarOpacity(opacity)
    prop.SetScalarOpacityUnitDistance(unit_distance)
    prop.SetInterpolationTypeToLinear()
    prop.ShadeOff()
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
    renderer.ResetCameraClippingRange()
    straighten(renderer, volume, width, height)

    seconds = []
    for frame in range(repeat + 1):
        if frame > 1 and budget and sum(seconds) + seconds[-1] > budget:
            break
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


def straighten(renderer, volume, width, height):
    """Moves the view so that VTK's rays pass through the centres of the window's pixels.

    VTK 9.1 draws the n pixels' rays of its ray casters as a linearly interpolated texture whose first and last texel's
    centres are on the edges of n pixels: n rays over n - 1 pixels (measured on meshes by least squares: 1.0 pixel along
    both axes). The opposite transform after the projection places the rays where they are shown. The blur by the interpolation
    itself, half a pixel near the edges of the volume's window and zero in its middle, remains.
    """
    view = renderer.GetActiveCamera()
    mapper = volume.GetMapper()
    straight = vtk.vtkTransform()
    if mapper.IsA("vtkUnstructuredGridVolumeRayCastMapper"):
        # Its texture is the window, and its rays pass through the pixels' lower left corners (measured: 0.50 pixel).
        straight.Translate(-1.0 / width, -1.0 / height, 0)
        straight.Scale(1 - 1.0 / width, 1 - 1.0 / height, 1)
    elif mapper.IsA("vtkFixedPointVolumeRayCastMapper"):
        # Its texture is the window of the volume's box plus two pixels on each side.
        low, high = [width, height], [0, 0]
        bounds = volume.GetBounds()
        for corner in range(8):
            renderer.SetWorldPoint(*(bounds[2 * i + (corner >> i & 1)] for i in range(3)), 1.0)
            renderer.WorldToDisplay()
            for axis in range(2):
                low[axis] = min(low[axis], renderer.GetDisplayPoint()[axis])
                high[axis] = max(high[axis], renderer.GetDisplayPoint()[axis])
        scale, shift = [], []
        for axis, size in enumerate((width, height)):
            first, last = max(low[axis] - 2, 0), min(high[axis] + 2, size - 1)
            n = int(last - first + 1)
            scale.append((n - 1) / n)
            # Pixel x -> first + 0.5 + (x - first) (n - 1) / n, in coordinates of -1 to 1.
            shift.append(2 * (int(first) / n + 0.5) / size - 1 + scale[-1])
        straight.Translate(shift[0], shift[1], 0)
        straight.Scale(scale[0], scale[1], 1)
    view.SetUserTransform(straight)


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
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for word in ("data", "report", "picture"):
        parser.add_argument(word)
    parser.add_argument("--integrator", choices=list(INTEGRATORS), default="partial")
    parser.add_argument("--step", type=float, default=1.0)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--threads", type=int)
    args = parser.parse_args()
    report = json.load(open(args.report))
    camera, knots = camera_of(report["frames"][0]["view"]), report["transfer_function"]["knots"]
    if args.data.endswith(".vti"):
        rgb, _, seconds = render_grid(read_grid(args.data), camera, knots, args.step, args.repeat, args.threads)
        name = f"fixed point, step {args.step:g}"
    else:
        rgb, _, seconds = render(read_mesh(args.data), camera, knots, args.integrator, args.repeat, args.threads)
        name = f"bunyk ray caster, {args.integrator}"
    apart = np.abs(rgb - read_pfm(args.picture)).astype(np.float64)
    print(json.dumps({"renderer": f"VTK {vtk.VTK_VERSION} {name}", "frame_ms": [1e3 * s for s in seconds], "max_error": float(apart.max()),
                      "rms_error": float(np.sqrt((apart ** 2).mean()))}))


if __name__ == "__main__":
    main()
