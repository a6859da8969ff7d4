"""Whole files for the test of advice, which rows damage: each the smallest that is read."""

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
    '[{"Name": "two", "ColorSpace": "RGB", "RGBPoints": [0, 0, 0, 1, 1, 1, 0, 0], "Points": [0, 0, 0.5, 0, 1, 1, 0.5, 0],'
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
    b"ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nOffset = 0 0 0\nElementSpacing = 1 1 1\n"
    b"DimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n"
) + SAMPLES


def nifti(dimensions=(3, 2, 2, 2), datatype=2, bits=8, offset=352, magic=b"n+1\0", slope=1.0, spacing=1.0):
    """A NIfTI-1 header of these dimensions, as nifti1.h has it."""
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
    '<Points>\n<DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0 0 0 1</DataArray>\n</Points>\n'
    '<Cells>\n<DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3</DataArray>\n'
    '<DataArray type="Int64" Name="offsets" format="ascii">4</DataArray>\n'
    '<DataArray type="UInt8" Name="types" format="ascii">10</DataArray>\n</Cells>\n'
    "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n"
)


def image_data(kind="ImageData", extent="0 1 0 1 0 1", values="0 1 2 3 4 5 6 7", coordinates="", more=""):
    """VTK XML of a regular or rectilinear grid."""
    geometry = "" if kind == "RectilinearGrid" else ' Origin="0 0 0" Spacing="1 1 1"'
    return (
        f'<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian">\n<{kind} WholeExtent="{extent}"{geometry}{more}>\n'
        f'<Piece Extent="{extent}">\n<PointData>\n<DataArray type="Float64" Name="f" format="ascii">{values}</DataArray>\n'
        f"</PointData>\n{coordinates}</Piece>\n</{kind}>\n</VTKFile>\n"
    )


IMAGE = image_data()


def rectilinear(x="0 1", values="0 1 2 3 4 5 6 7"):
    axes = "".join(f'<DataArray type="Float64" format="ascii">{axis}</DataArray>\n' for axis in (x, "0 1", "0 1"))
    return image_data("RectilinearGrid", f"0 {len(x.split()) - 1} 0 1 0 1", values, f"<Coordinates>\n{axes}</Coordinates>\n")


RECTILINEAR = rectilinear()
UNEVEN = rectilinear("0 1 3", "0 1 2 3 4 5 6 7 8 9 10 11")
