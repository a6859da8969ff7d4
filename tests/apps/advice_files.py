# SPDX-License-Identifier: BSD-3-Clause
"""Valid files for the test of advice, which rows damage: each the smallest that is read."""

import struct

CORNERS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
FACES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]  # outwards


def lines(rows):
    return "".join(" ".join(map(str, row)) + "\n" for row in rows)


PLY = (
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    + lines(CORNERS)
    + lines((3, *face) for face in FACES)
)

TEXT_CAMERA = "position 0 0 9\nfocal_point 0 0 0\nview_up 0 1 0\nparallel_scale 2\n"
JSON_CAMERA = '{"position": [0, 0, 9], "focal_point": [0, 0, 0], "view_up": [0, 1, 0], "parallel_scale": 2}'


def pvcc_property(name, numbers):
    elements = "".join(f'<Element index="{index}" value="{number}"/>' for index, number in enumerate(numbers))
    return f'<Property name="{name}">{elements}</Property>\n'


PVCC = (
    '<?xml version="1.0"?>\n<PVCameraConfiguration version="1.0"><Proxy group="views">\n'
    + pvcc_property("CameraPosition", (0, 0, 5))
    + pvcc_property("CameraFocalPoint", (0, 0, 0))
    + pvcc_property("CameraViewUp", (0, 1, 0))
    + pvcc_property("CameraViewAngle", (30,))
    + "</Proxy></PVCameraConfiguration>\n"
)
KNOTS = "0 1 0 0 0.5\n1 0 0 1 2\n"
COLOR_MAP = (
    '[{"Name": "two", "ColorSpace": "RGB", "RGBPoints": [0, 0, 0, 1, 1, 1, 0, 0], "Points": [0, 0, 0.5, '
    "0, 1, 1, 0.5, 0],"
    ' "ScalarOpacityUnitDistance": 1}]'
)
PVD = (
    '<VTKFile type="Collection" version="0.1"><Collection>\n<DataSet timestep="0" part="0" file="m.vtu"/>\n'
    '<DataSet timestep="1" part="0" file="m.vtu"/>\n</Collection></VTKFile>\n'
)
SERIES = '{"file-series-version": "1.0", "files": [{"name": "m.vtu", "time": 0}, {"name": "m.vtu", "time": 1}]}'
TRACE = (
    '{"traceEvents": [{"name": "project", "cat": "tessera", "ph": "X", "ts": 0, "dur": 9, "pid": 0, "tid": 0,'
    ' "args": {"cpu_us": 9, "frame": 0, "bytes": 0, "messages": 0}}],'
    ' "otherData": {"tets": 1, "frames": 1, "width": 9, "height": 9, "ranks": 1}}'
)
SAMPLES = bytes(range(8))  # of 2x2x2 bytes
NRRD = (
    "NRRD0004\ntype: uint8\ndimension: 3\nspace dimension: 3\nsizes: 2 2 2\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n"
    "space origin: (0,0,0)\nendian: little\nencoding: raw\n\n"
).encode() + SAMPLES
META = (
    b"ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nOffset = 0 0 0\n"
    b"ElementSpacing = 1 1 1\n"
    b"DimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n"
) + SAMPLES


def nifti(dimensions=(3, 2, 2, 2), datatype=2, bits=8, offset=352, magic=b"n+1\0", slope=1.0, spacing=1.0):
    """A NIfTI-1 header with these dimensions, according to nifti1.h."""
    dimensions = tuple(dimensions) + (1,) * (8 - len(dimensions))
    return (
        struct.pack("<i36x8h14x", 348, *dimensions)
        + struct.pack("<hhh8ff", datatype, bits, 0, *([1.0] + [spacing] * 7), offset)
        + struct.pack("<ff", slope, 0.0)
        + bytes(344 - 120)
        + magic
        + bytes(4)
    )


NIFTI = nifti() + SAMPLES
TETRAHEDRON = (
    '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian">\n<UnstructuredGrid>\n'
    '<Piece NumberOfPoints="4" NumberOfCells="1">\n'
    '<PointData>\n<DataArray type="Float64" Name="f" format="ascii">0 250 500 1000</DataArray>\n</PointData>\n'
    '<Points>\n<DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0 0 0 '
    "1</DataArray>\n</Points>\n"
    '<Cells>\n<DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3</DataArray>\n'
    '<DataArray type="Int64" Name="offsets" format="ascii">4</DataArray>\n'
    '<DataArray type="UInt8" Name="types" format="ascii">10</DataArray>\n</Cells>\n'
    "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n"
)


def image_data(kind="ImageData", extent="0 1 0 1 0 1", values="0 1 2 3 4 5 6 7", coordinates="", more=""):
    """VTK XML of a regular or rectilinear grid."""
    geometry = "" if kind == "RectilinearGrid" else ' Origin="0 0 0" Spacing="1 1 1"'
    return (
        f'<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian">\n<{kind} '
        f'WholeExtent="{extent}"{geometry}{more}>\n'
        f'<Piece Extent="{extent}">\n<PointData>\n<DataArray type="Float64" Name="f" '
        f'format="ascii">{values}</DataArray>\n'
        f"</PointData>\n{coordinates}</Piece>\n</{kind}>\n</VTKFile>\n"
    )


IMAGE = image_data()


def rectilinear(x="0 1", values="0 1 2 3 4 5 6 7"):
    axes = "".join(f'<DataArray type="Float64" format="ascii">{axis}</DataArray>\n' for axis in (x, "0 1", "0 1"))
    return image_data(
        "RectilinearGrid", f"0 {len(x.split()) - 1} 0 1 0 1", values, f"<Coordinates>\n{axes}</Coordinates>\n"
    )


RECTILINEAR = rectilinear()
UNEVEN = rectilinear("0 1 3", "0 1 2 3 4 5 6 7 8 9 10 11")
SU2 = f"NDIME= 3\nNELEM= 1\n10 0 1 2 3 0\nNPOIN= 4\n{lines((*p, k) for k, p in enumerate(CORNERS))}"
NODE = "4 3 1 0\n" + lines((k, *p, k) for k, p in enumerate(CORNERS))
ELE = "1 4 0\n0 0 1 2 3\n"
SMESH = "4 3 0 0\n" + lines((k, *p) for k, p in enumerate(CORNERS)) + "4 0\n" + lines((3, *f) for f in FACES) + "0\n0\n"
TETS = struct.pack("<qq12f4f4i", 4, 1, *[x for p in CORNERS for x in p], 0, 1, 2, 3, 0, 1, 2, 3)
STL = (
    "solid a\n"
    + "".join(
        "facet normal 0 0 0\nouter loop\n"
        + "".join(f"vertex {x} {y} {z}\n" for x, y, z in (CORNERS[v] for v in face))
        + "endloop\nendfacet\n"
        for face in FACES
    )
    + "endsolid a\n"
)
BOX = "((0,0,0) (1,1,1) (0,0,0))"
AMREX = {
    "plt/Header": "HyperCLaw-V1.1\n1\nf\n3\n0.0\n0\n0 0 0\n1 1 1\n\n"
    + BOX
    + "\n0\n0.5 0.5 0.5\n0\n0\n0 1 0\n0\n0 1\n0 1\n0 1\nLevel_0/Cell\n",
    "plt/Level_0/Cell_H": f"1\n1\n1\n0\n(1 0\n{BOX}\n)\n1\nFabOnDisk: Cell_D_00000 0\n",
    "plt/Level_0/Cell_D_00000": f"FAB ((8, (64 11 52 0 1 12 0 1023)),(8, (8 7 6 5 4 3 2 1))){BOX} 1\n".encode()
    + struct.pack("<8d", *range(8)),
}
POLY = SMESH[: SMESH.index("4 0\n")] + "4 0\n" + "".join(f"1\n3 {a} {b} {c}\n" for a, b, c in FACES) + "0\n0\n"
LEGACY = (
    "# vtk DataFile Version 3.0\none\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n"
    + lines(CORNERS)
    + "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\nPOINT_DATA 4\nSCALARS f float 1\nLOOKUP_TABLE default\n0 1 2 3\n"
)
VTP = (
    '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian">\n<PolyData>\n<Piece '
    'NumberOfPoints="4" NumberOfPolys="4">\n'
    '<Points>\n<DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0 0 0 '
    "1</DataArray>\n</Points>\n"
    '<Polys>\n<DataArray type="Int64" Name="connectivity" format="ascii">0 2 1 0 1 3 1 2 3 0 3 2</DataArray>\n'
    '<DataArray type="Int64" Name="offsets" format="ascii">3 6 9 12</DataArray>\n</Polys>\n</Piece>\n'
    "</PolyData>\n</VTKFile>\n"
)


def unstructured(points="0 0 0 1 0 0 0 1 0 0 0 1", cells="0 1 2 3", offsets="4", types="10", fields="", faces=""):
    """VTK XML of an unstructured grid."""

    def array(kind, name, values, more=""):
        return f'<DataArray type="{kind}" Name="{name}"{more} format="ascii">{values}</DataArray>\n'

    return (
        '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian">\n<UnstructuredGrid>\n'
        f'<Piece NumberOfPoints="{len(points.split()) // 3}" NumberOfCells="{len(types.split())}">\n{fields}<Points>\n'
        + array("Float64", "Points", points, ' NumberOfComponents="3"')
        + "</Points>\n<Cells>\n"
        + array("Int64", "connectivity", cells)
        + array("Int64", "offsets", offsets)
        + array("UInt8", "types", types)
        + faces
        + "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n"
    )


PVTU = (
    '<VTKFile type="PUnstructuredGrid" version="1.0">\n<PUnstructuredGrid>\n<PPointData><PDataArray '
    'type="Float64" Name="f"/>'
    '</PPointData>\n<Piece Source="p.vtu"/>\n</PUnstructuredGrid>\n</VTKFile>\n'
)
VTM = (
    '<VTKFile type="vtkMultiBlockDataSet" version="1.0">\n<vtkMultiBlockDataSet>\n<DataSet index="0" '
    'name="one" file="p.vtu"/>\n'
    '<DataSet index="1" name="two" file="q.vtu"/>\n</vtkMultiBlockDataSet>\n</VTKFile>\n'
)


def in_pieces(kind, pieces, extent="0 2 0 1 0 1"):
    """A grid's pieces, each given by a name and its points."""
    geometry = ' Origin="0 0 0" Spacing="1 1 1"' if kind == "ImageData" else ""
    listed = "".join(f'<Piece Extent="{points}" Source="{name}"/>\n' for name, points in pieces)
    return (
        f'<VTKFile type="P{kind}" version="1.0">\n<P{kind} WholeExtent="{extent}" '
        f'GhostLevel="0"{geometry}>\n{listed}</P{kind}>\n</VTKFile>\n'
    )


def block(cells="0 2 0 2 0 2", origin="0 0 0", spacing="1 1 1", more="", values=None):
    """Image data with one value per cell, as in lists of AMR blocks."""
    ends = [int(word) for word in cells.split()]
    count = (ends[1] - ends[0]) * (ends[3] - ends[2]) * (ends[5] - ends[4])
    values = " ".join(map(str, range(count))) if values is None else values
    return (
        f'<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian">\n<ImageData '
        f'WholeExtent="{cells}" Origin="{origin}"'
        f' Spacing="{spacing}"{more}>\n<Piece Extent="{cells}">\n<CellData>\n<DataArray type="Float64" '
        f'Name="f" format="ascii">{values}'
        "</DataArray>\n</CellData>\n</Piece>\n</ImageData>\n</VTKFile>\n"
    )


AMR = (
    '<VTKFile type="vtkOverlappingAMR" version="1.1">\n<vtkOverlappingAMR>\n<Block level="0"><DataSet '
    'index="0" file="b0.vti"/></Block>\n'
    '<Block level="1"><DataSet index="0" file="b1.vti"/></Block>\n</vtkOverlappingAMR>\n</VTKFile>\n'
)
AMR_FILES = {"a.vth": AMR, "b0.vti": block(), "b1.vti": block(spacing="0.5 0.5 0.5")}


def hyper_trees(
    axes=("0 1", "0 1", "0 1"), counts="1 8", divided="1", version="2.0", branching=2, values=None, depth="2"
):
    """One tree, or as many as `depth` has words."""

    def array(kind, name, values):
        return (
            f'<DataArray type="{kind}" Name="{name}" NumberOfTuples="{len(values.split())}" '
            f'format="ascii">{values}</DataArray>\n'
        )

    sizes = " ".join(str(len(axis.split())) for axis in axes)
    cells = sum(map(int, counts.split()))
    values = " ".join(map(str, range(cells))) if values is None else values
    trees = " ".join(map(str, range(len(depth.split()))))
    return (
        f'<VTKFile type="HyperTreeGrid" version="{version}" byte_order="LittleEndian" header_type="UInt32">\n'
        f'<HyperTreeGrid BranchFactor="{branching}" TransposedRootIndexing="0" Dimensions="{sizes}" '
        f'NumberOfVertices="{cells}">\n'
        "<Grid>\n"
        + "".join(array("Float64", f"{name}Coordinates", axis) for name, axis in zip("XYZ", axes))
        + "</Grid>\n<Trees>\n"
        + array("Bit", "Descriptors", divided)
        + array("Int64", "NumberOfVerticesPerDepth", counts)
        + array("Int64", "TreeIds", trees)
        + array("UInt32", "DepthPerTree", depth)
        + "</Trees>\n<CellData>\n"
        + array("Float64", "f", values)
        + "</CellData>\n</HyperTreeGrid>\n</VTKFile>\n"
    )


TREES = hyper_trees()
