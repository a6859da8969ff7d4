#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes one small data set by each of VTK's own writers, in every supported encoding: initial files of a corpus.

    bench/vtk_files.py FOLDER

Meshes of mixed cells, curvilinear, rectilinear and image grids; point and cell fields of several types, vectors and an array of
strings; XML in text, base64 and raw, compressed (zlib, LZ4, LZMA) and not, with 32- and 64-bit headers; legacy in text and binary.
Needs VTK's Python module (Debian: python3-vtk9).
"""
import pathlib
import sys

import vtk


def fields(data):
    for attributes, tuples in ((data.GetPointData(), data.GetNumberOfPoints()), (data.GetCellData(), data.GetNumberOfCells())):
        for name, array, components in (("f", vtk.vtkDoubleArray(), 1), ("v", vtk.vtkFloatArray(), 3), ("n", vtk.vtkIntArray(), 1),
                                        ("b", vtk.vtkUnsignedCharArray(), 1), ("wide", vtk.vtkTypeInt64Array(), 1)):
            array.SetName(name)
            array.SetNumberOfComponents(components)
            array.SetNumberOfTuples(tuples)
            for i in range(tuples):
                for c in range(components):
                    array.SetComponent(i, c, (7 * i + 3 * c) % 29)
            attributes.AddArray(array)
        attributes.SetActiveScalars("f")
        words = vtk.vtkStringArray()
        words.SetName("words")
        for i in range(tuples):
            words.InsertNextValue("abcdefgh"[: i % 9])
        attributes.AddArray(words)
    return data


def image(n):
    grid = vtk.vtkImageData()
    grid.SetDimensions(n, n + 1, n + 2)
    grid.SetSpacing(0.5, 1, 2)
    return fields(grid)


def rectilinear(n):
    grid = vtk.vtkRectilinearGrid()
    grid.SetDimensions(n, n + 1, n + 2)
    for axis, set_axis in enumerate((grid.SetXCoordinates, grid.SetYCoordinates, grid.SetZCoordinates)):
        values = vtk.vtkDoubleArray()
        for i in range(n + axis):
            values.InsertNextValue(i * i + i)
        set_axis(values)
    return fields(grid)


def structured(n):
    grid = vtk.vtkStructuredGrid()
    grid.SetDimensions(n, n, n)
    points = vtk.vtkPoints()
    for k in range(n):
        for j in range(n):
            for i in range(n):
                points.InsertNextPoint(i + 0.1 * j, j, k + 0.05 * i)
    grid.SetPoints(points)
    return fields(grid)


def unstructured(n):
    whole = structured(n)
    grid = vtk.vtkUnstructuredGrid()
    grid.SetPoints(whole.GetPoints())
    for c in range(whole.GetNumberOfCells()):
        ids = [whole.GetCell(c).GetPointId(k) for k in range(8)]
        if c % 3 == 0:
            grid.InsertNextCell(vtk.VTK_HEXAHEDRON, 8, ids)
        elif c % 3 == 1:
            for wedge in ((0, 1, 3, 4, 5, 7), (1, 2, 3, 5, 6, 7)):
                grid.InsertNextCell(vtk.VTK_WEDGE, 6, [ids[k] for k in wedge])
        else:
            for tet in ((0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)):
                grid.InsertNextCell(vtk.VTK_TETRA, 4, [ids[k] for k in tet])
    return fields(grid)


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    kinds = (("vti", image(5), vtk.vtkXMLImageDataWriter, vtk.vtkStructuredPointsWriter),
             ("vtr", rectilinear(5), vtk.vtkXMLRectilinearGridWriter, vtk.vtkRectilinearGridWriter),
             ("vts", structured(5), vtk.vtkXMLStructuredGridWriter, vtk.vtkStructuredGridWriter),
             ("vtu", unstructured(5), vtk.vtkXMLUnstructuredGridWriter, vtk.vtkUnstructuredGridWriter))
    for suffix, data, xml, legacy in kinds:
        for mode in (vtk.vtkXMLWriter.Ascii, vtk.vtkXMLWriter.Binary, vtk.vtkXMLWriter.Appended):
            for base64 in (False, True) if mode == vtk.vtkXMLWriter.Appended else (False,):
                for packed in ("none", "zlib", "lz4", "lzma") if mode != vtk.vtkXMLWriter.Ascii else ("none",):
                    for bits in (32, 64):
                        writer = xml()
                        writer.SetFileName(str(folder / f"{['ascii', 'binary', 'appended'][mode]}{'64' if base64 else ''}-{packed}-{bits}.{suffix}"))
                        writer.SetDataMode(mode)
                        writer.SetEncodeAppendedData(base64)
                        writer.SetHeaderType(bits)
                        writer.SetCompressorType({"none": 0, "zlib": 1, "lz4": 2, "lzma": 3}[packed])
                        writer.SetInputData(data)
                        writer.Write()
        for binary in (False, True):
            writer = legacy()
            writer.SetFileName(str(folder / f"{suffix}-{'binary' if binary else 'ascii'}.vtk"))
            writer.SetFileType(vtk.VTK_BINARY if binary else vtk.VTK_ASCII)
            writer.SetInputData(data)
            writer.Write()


if __name__ == "__main__":
    main()
