# SPDX-License-Identifier: BSD-3-Clause
"""Files for bench/reading.py: one cube of tets, hexahedra or samples in a selection of formats.

Each function writes into a directory and returns the file to open; `FORMATS` lists them, with VTK's reader. Written by VTK's writers, or
here if it has none. HDF5 by h5py.
"""
import struct

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray


def lattice(n):
    """n^3 points of a cube, x fastest, displaced from a regular grid, and a field."""
    z, y, x = np.meshgrid(*[np.linspace(-1, 1, n)] * 3, indexing="ij")
    points = np.stack([x + 0.02 * y * z, y + 0.01 * x * x, z], -1).reshape(-1, 3).astype(np.float32)
    return points, np.sin(3 * x + 2 * y).ravel().astype(np.float32) * np.cos(2 * z).ravel().astype(np.float32)


def hexahedra(n):
    """Corners of the (n - 1)^3 cells, in VTK's order."""
    k, j, i = np.meshgrid(*[np.arange(n - 1)] * 3, indexing="ij")
    first = (i + n * (j + n * k)).reshape(-1, 1)
    return first + np.array([0, 1, 1 + n, n, n * n, 1 + n * n, 1 + n + n * n, n + n * n])


def points_of(points):
    held = vtk.vtkPoints()
    held.SetData(numpy_to_vtk(points, True))
    return held


def with_field(attributes, values):
    field = numpy_to_vtk(values, True)
    field.SetName("f")
    attributes.SetScalars(field)


def grid_of(points, values, cells, kind):
    grid, array, width = vtk.vtkUnstructuredGrid(), vtk.vtkCellArray(), cells.shape[1]
    grid.SetPoints(points_of(points))
    array.SetData(numpy_to_vtkIdTypeArray(np.arange(0, cells.size + 1, width, dtype=np.int64), True),
                  numpy_to_vtkIdTypeArray(cells.ravel().astype(np.int64), True))
    grid.SetCells(kind, array)
    with_field(grid.GetPointData(), values)
    return grid


def tets(n):
    hexes = hexahedra(n)
    six = np.array([[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]])
    return grid_of(*lattice(n), hexes[:, six].reshape(-1, 4), vtk.VTK_TETRA)


def hexes(n):
    return grid_of(*lattice(n), hexahedra(n), vtk.VTK_HEXAHEDRON)


def image(n):
    grid = vtk.vtkImageData()
    grid.SetDimensions(n, n, n)
    with_field(grid.GetPointData(), lattice(n)[1])
    return grid


def structured(n):
    points, values = lattice(n)
    grid = vtk.vtkStructuredGrid()
    grid.SetDimensions(n, n, n)
    grid.SetPoints(points_of(points))
    with_field(grid.GetPointData(), values)
    return grid


def written(writer, data, file, **settings):
    writer.SetFileName(str(file))
    writer.SetInputData(data)
    for name, value in settings.items():
        getattr(writer, name)(value)
    writer.Write()
    return file


APPENDED = {"SetDataMode": vtk.vtkXMLWriter.Appended, "SetEncodeAppendedData": False, "SetCompressorType": 0}
TEXT = {"SetDataMode": vtk.vtkXMLWriter.Ascii}


def foam_file(file, kind, body, binary=True):
    file.parent.mkdir(parents=True, exist_ok=True)
    head = f'FoamFile\n{{\n version 2.0;\n format {"binary" if binary else "ascii"};\n arch "LSB;label=32;scalar=64";\n class {kind};\n object {file.name};\n}}\n'
    file.write_bytes(head.encode() + body)


def faces_of(n):
    """Quadrilaterals of a lattice's cells, those between cells first in the order of their owners: corners, owner, neighbour (-1)."""
    m = n - 1
    k, j, i = (a.ravel() for a in np.meshgrid(*[np.arange(m)] * 3, indexing="ij"))
    cell, corners = i + m * (j + m * k), hexahedra(n)
    sides = [([1, 2, 6, 5], i + 1 < m, 1), ([3, 7, 6, 2], j + 1 < m, m), ([4, 5, 6, 7], k + 1 < m, m * m),
             ([0, 4, 7, 3], i > 0, -1), ([0, 1, 5, 4], j > 0, -m), ([0, 3, 2, 1], k > 0, -m * m)]
    quads, owners, neighbours = [], [], []
    for number, (which, inside, step) in enumerate(sides):
        kept = np.ones_like(inside) if number < 3 else ~inside
        quads.append(corners[kept][:, which])
        owners.append(cell[kept])
        neighbours.append(np.where(inside, cell + step, -1)[kept])
    quad, owner, neighbour = np.concatenate(quads), np.concatenate(owners), np.concatenate(neighbours)
    order = np.lexsort((neighbour, owner, neighbour < 0))
    return quad[order], owner[order], neighbour[order]


def openfoam(folder, n):
    points, values = lattice(n)
    quad, owner, neighbour = faces_of(n)
    inner, cells = int((neighbour >= 0).sum()), (n - 1) ** 3
    mesh = folder / "constant" / "polyMesh"
    packed = lambda count, array: f"{count}\n(".encode() + array.tobytes() + b")\n"
    foam_file(mesh / "points", "vectorField", packed(len(points), points.astype("<f8")))
    foam_file(mesh / "faces", "faceCompactList", packed(len(quad) + 1, np.arange(0, quad.size + 1, 4, dtype="<i4")) + packed(quad.size, quad.astype("<i4")))
    foam_file(mesh / "owner", "labelList", packed(len(owner), owner.astype("<i4")))
    foam_file(mesh / "neighbour", "labelList", packed(inner, neighbour[:inner].astype("<i4")))
    foam_file(mesh / "boundary", "polyBoundaryMesh", f"1\n(\nwalls\n{{\n type wall;\n nFaces {len(quad) - inner};\n startFace {inner};\n}}\n)\n".encode(), False)
    field = b"dimensions [0 2 -2 0 0 0 0];\ninternalField nonuniform List<scalar> " + packed(cells, values[:cells].astype("<f8"))
    foam_file(folder / "0" / "p", "volScalarField", field + b";\nboundaryField\n{\n walls\n {\n  type zeroGradient;\n }\n}\n")
    foam_file(folder / "system" / "controlDict", "dictionary",
              b"startFrom startTime;\nstartTime 0;\nendTime 0;\ndeltaT 1;\nwriteControl timeStep;\nwriteInterval 1;\n", False)
    (folder / "case.foam").touch()
    return folder / "case.foam"


def exodus(folder, n):
    return written(vtk.vtkExodusIIWriter(), tets(n), folder / "m.ex2")


def cgns(folder, n):
    import h5py

    def node(parent, name, label, kind, data=None):
        made = parent.create_group(name, track_order=True)
        made.attrs["name"], made.attrs["label"] = np.array(name.encode(), "S33"), np.array(label.encode(), "S33")
        made.attrs["type"] = np.array(kind.encode(), "S3")
        made.attrs["flags"] = np.array([1], np.int32)
        if data is not None:
            made.create_dataset(" data", data=data)
        return made

    text = lambda s: np.frombuffer(s.encode(), np.int8)
    points, values = lattice(n)
    cells = hexahedra(n)
    with h5py.File(folder / "m.cgns", "w", libver=("earliest", "v108"), track_order=True) as file:
        file.attrs["name"], file.attrs["label"] = np.array(b"HDF5 MotherNode", "S33"), np.array(b"Root Node of HDF5 File", "S33")
        file.attrs["type"] = np.array(b"MT", "S3")
        file.create_dataset(" format", data=np.frombuffer(b"IEEE_LITTLE_32\0", np.int8))
        file.create_dataset(" hdf5version", data=np.frombuffer(b"HDF5 Version 1.10.8\0".ljust(33, b"\0"), np.int8))
        node(file, "CGNSLibraryVersion", "CGNSLibraryVersion_t", "R4", np.array([3.3], np.float32))
        base = node(file, "Base", "CGNSBase_t", "I4", np.array([3, 3], np.int32))
        zone = node(base, "Zone", "Zone_t", "I4", np.array([[len(points)], [len(cells)], [0]], np.int32))
        node(zone, "ZoneType", "ZoneType_t", "C1", text("Unstructured"))
        place = node(zone, "GridCoordinates", "GridCoordinates_t", "MT")
        for axis in range(3):
            node(place, "Coordinate" + "XYZ"[axis], "DataArray_t", "R8", points[:, axis].astype(np.float64))
        part = node(zone, "Hexahedra", "Elements_t", "I4", np.array([17, 0], np.int32))
        node(part, "ElementRange", "IndexRange_t", "I4", np.array([1, len(cells)], np.int32))
        node(part, "ElementConnectivity", "DataArray_t", "I4", (cells.ravel() + 1).astype(np.int32))
        solution = node(zone, "Solution", "FlowSolution_t", "MT")
        node(solution, "GridLocation", "GridLocation_t", "C1", text("Vertex"))
        node(solution, "f", "DataArray_t", "R8", values.astype(np.float64))
    return folder / "m.cgns"


def plot3d(folder, n):
    points, values = lattice(n)
    with open(folder / "m.xyz", "wb") as file:
        np.array([n, n, n], "<i4").tofile(file)
        points.T.astype("<f4").tofile(file)
    with open(folder / "m.q", "wb") as file:
        np.array([n, n, n], "<i4").tofile(file)
        np.array([0.5, 0, 1e5, 0], "<f4").tofile(file)
        np.stack([values + 2] + [values] * 4).astype("<f4").tofile(file)
    return folder / "m.xyz"


def rows(file, array, form):
    np.savetxt(file, array, fmt=form)


def fluent(folder, n):
    points, values = lattice(n)
    quad, owner, neighbour = faces_of(n)
    inner, cells = int((neighbour >= 0).sum()), (n - 1) ** 3
    with open(folder / "m.cas", "w") as file:
        file.write(f'(0 "cube")\n(2 3)\n(10 (0 1 {len(points):x} 0 3))\n(10 (1 1 {len(points):x} 1 3)(\n')
        rows(file, points, "%.7g")
        file.write(f"))\n(12 (0 1 {cells:x} 0))\n(12 (2 1 {cells:x} 1 4))\n(13 (0 1 {len(quad):x} 0))\n")
        faces = np.column_stack([quad + 1, owner + 1, np.maximum(neighbour, -1) + 1])
        for zone, first, last, kind in ((3, 0, inner, 2), (4, inner, len(quad), 3)):
            file.write(f"(13 ({zone:x} {first + 1:x} {last:x} {kind} 4)(\n")
            rows(file, faces[first:last], "%x")
            file.write("))\n")
        file.write("(45 (2 fluid fluid)())\n(45 (3 interior inside)())\n(45 (4 wall walls)())\n")
    with open(folder / "m.dat", "w") as file:
        file.write(f'(0 "values")\n(300 (3 2 1 0 0 1 {cells})\n(')
        rows(file, values[:cells] + 300, "%.7g")
        file.write("))\n")
    return folder / "m.cas"


def netcdf(folder, n):
    """NetCDF classic: dimensions z y x, their axes, and one variable of floats."""
    name = lambda s: struct.pack(">I", len(s)) + s.encode().ljust(-(-len(s) // 4) * 4, b"\0")
    variables = [("z", [0], n), ("y", [1], n), ("x", [2], n), ("f", [0, 1, 2], n ** 3)]
    def head(at):
        out = b"CDF\2" + struct.pack(">III", 0, 10, 3) + b"".join(name(d) + struct.pack(">I", n) for d in "zyx") + struct.pack(">II", 0, 0)
        out += struct.pack(">II", 11, len(variables))
        for variable, dimensions, count in variables:
            out += name(variable) + struct.pack(">I", len(dimensions)) + struct.pack(f">{len(dimensions)}I", *dimensions)
            out += struct.pack(">IIIIQ", 0, 0, 5, 4 * count, at)
            at += 4 * count
        return out
    with open(folder / "m.nc", "wb") as file:
        file.write(head(len(head(0))))
        for _ in range(3):
            np.linspace(0, 1, n).astype(">f4").tofile(file)
        lattice(n)[1].astype(">f4").tofile(file)
    return folder / "m.nc"


def dicom(folder, n):
    """One file per slice: explicit, little endian, 16 bits."""
    values = (lattice(n)[1].reshape(n, n, n) * 1000).astype("<i2")

    def element(group, number, kind, data):
        data = data.encode() if isinstance(data, str) else data
        data += (b"\0" if kind in ("UI", "OB") else b" ") * (len(data) % 2)
        tag = struct.pack("<HH", group, number) + kind.encode()
        return tag + (struct.pack("<HI", 0, len(data)) if kind in ("OW", "OB") else struct.pack("<H", len(data))) + data

    short = lambda number: struct.pack("<H", number)
    for k in range(n):
        meta = element(2, 1, "OB", b"\0\1") + element(2, 2, "UI", "1.2.840.10008.5.1.4.1.1.2") + element(2, 3, "UI", f"1.2.3.{k + 1}")
        meta += element(2, 0x10, "UI", "1.2.840.10008.1.2.1") + element(2, 0x12, "UI", "1.2.3")
        body = element(8, 0x16, "UI", "1.2.840.10008.5.1.4.1.1.2") + element(8, 0x18, "UI", f"1.2.3.{k + 1}") + element(8, 0x60, "CS", "CT")
        body += element(0x20, 0xD, "UI", "1.2.4") + element(0x20, 0xE, "UI", "1.2.5") + element(0x20, 0x13, "IS", str(k))
        body += element(0x20, 0x32, "DS", f"0\\0\\{k}") + element(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0")
        body += element(0x28, 2, "US", short(1)) + element(0x28, 4, "CS", "MONOCHROME2") + element(0x28, 0x10, "US", short(n)) + element(0x28, 0x11, "US", short(n))
        body += element(0x28, 0x30, "DS", "1\\1") + element(0x28, 0x100, "US", short(16)) + element(0x28, 0x101, "US", short(16))
        body += element(0x28, 0x102, "US", short(15)) + element(0x28, 0x103, "US", short(1)) + element(0x7FE0, 0x10, "OW", values[k].tobytes())
        (folder / f"slice{k:04}.dcm").write_bytes(b"\0" * 128 + b"DICM" + element(2, 0, "UL", struct.pack("<I", len(meta))) + meta + body)
    return folder


def hyper_trees(folder, n):
    source = vtk.vtkRandomHyperTreeGridSource()
    source.SetDimensions(n + 1, n + 1, n + 1)
    source.SetSeed(7)
    source.SetMaxDepth(4)
    source.SetSplitFraction(0.4)
    source.Update()
    writer = vtk.vtkXMLHyperTreeGridWriter()
    return written(writer, source.GetOutput(), folder / "m.htg", SetDataMode=vtk.vtkXMLWriter.Binary)


def levels(folder, n):
    """A coarse block, and one of twice the resolution over its middle."""
    amr = vtk.vtkOverlappingAMR()
    amr.Initialize(2, [1, 1])
    amr.SetOrigin([0, 0, 0])
    amr.SetGridDescription(vtk.VTK_XYZ_GRID)
    for level, (low, high) in enumerate(((0, n - 1), (n // 2, n // 2 + n - 1))):
        step = 1.0 / 2 ** level
        grid = vtk.vtkUniformGrid()
        grid.SetDimensions(n + 1, n + 1, n + 1)
        grid.SetSpacing(step, step, step)
        grid.SetOrigin(low * step, low * step, low * step)
        with_field(grid.GetCellData(), lattice(n)[1])
        amr.SetSpacing(level, [step] * 3)
        amr.SetAMRBox(level, 0, vtk.vtkAMRBox([low] * 3, [high] * 3))
        amr.SetDataSet(level, 0, grid)
        amr.SetRefinementRatio(level, 2)
    return written(vtk.vtkXMLUniformGridAMRWriter(), amr, folder / "m.vthb", **APPENDED)


def amrex(folder, n):
    """One level of one box."""
    plot = folder / "plt00000"
    (plot / "Level_0").mkdir(parents=True, exist_ok=True)
    box = f"((0,0,0) ({n - 1},{n - 1},{n - 1}) (0,0,0))"
    (plot / "Header").write_text(f"HyperCLaw-V1.1\n1\nf\n3\n0\n0\n0 0 0\n1 1 1\n\n{box}\n0\n{1 / n} {1 / n} {1 / n}\n0\n0\n0 1 0\n0\n"
                                 "0 1\n0 1\n0 1\nLevel_0/Cell\n")
    values = lattice(n)[1].astype("<f8")
    (plot / "Level_0" / "Cell_H").write_text(f"1\n1\n1\n0\n(1 0\n{box}\n)\n1\nFabOnDisk: Cell_D_00000 0\n\n1,1\n{values.min():.17g},\n\n1,1\n{values.max():.17g},\n\n")
    (plot / "Level_0" / "Cell_D_00000").write_bytes(f"FAB ((8, (64 11 52 0 1 12 0 1023)),(8, (8 7 6 5 4 3 2 1))){box} 1\n".encode() + values.tobytes())
    return plot


def xml(kind, make, writer, settings):
    return lambda folder, n: written(writer(), make(n), folder / f"m.{kind}", **settings)


# Name, points along an edge, writer, VTK's reader; the last part of a name in brackets is the storage format.
UG, SG, IM = (getattr(vtk, f"vtkXML{k}Writer") for k in ("UnstructuredGrid", "StructuredGrid", "ImageData"))
FORMATS = [
    (".vtu, raw", 65, xml("vtu", tets, UG, APPENDED), "vtkXMLUnstructuredGridReader"),
    (".vtu, text", 65, xml("vtu", tets, UG, TEXT), "vtkXMLUnstructuredGridReader"),
    (".vtu of hexahedra, raw", 101, xml("vtu", hexes, UG, APPENDED), "vtkXMLUnstructuredGridReader"),
    (".vts, raw", 101, xml("vts", structured, SG, APPENDED), "vtkXMLStructuredGridReader"),
    (".vti, raw", 257, xml("vti", image, IM, APPENDED), "vtkXMLImageDataReader"),
    ("OpenFOAM, binary", 101, openfoam, "vtkOpenFOAMReader"),
    ("CGNS", 101, cgns, "vtkCGNSReader"),
    ("Exodus II", 65, exodus, "vtkExodusIIReader"),
    ("PLOT3D, binary", 101, plot3d, "vtkMultiBlockPLOT3DReader"),
    ("Fluent, text", 71, fluent, "vtkFLUENTReader"),
    ("NetCDF classic", 257, netcdf, "vtkNetCDFCFReader"),
    ("NIfTI", 257, lambda folder, n: written(vtk.vtkNIFTIImageWriter(), image(n), folder / "m.nii"), "vtkNIFTIImageReader"),
    ("DICOM, 16 bits", 257, dicom, "vtkDICOMImageReader"),
    ("HyperTreeGrid", 24, hyper_trees, "vtkXMLHyperTreeGridReader"),
    ("overlapping AMR", 128, levels, "vtkXMLUniformGridAMRReader"),
    ("AMReX", 128, amrex, "vtkAMReXGridReader"),
]
