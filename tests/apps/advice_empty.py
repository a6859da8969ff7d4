# SPDX-License-Identifier: BSD-3-Clause
"""Rows of advice about images that show nothing, and about axes that are out of proportion."""

import struct

from advice_files import image_data, unstructured
from advice_library_files import netcdf
from advice_row import row

R = "render m.vtu -o a.png --size 64x64 "
V = "render v.vti -o a.png --size 64x64 "


def tet(size):
    """A tet so thin that it may be between pixels."""
    field = '<PointData>\n<DataArray type="Float64" Name="f" format="ascii">0 1 2 3</DataArray>\n</PointData>\n'
    return unstructured(points=f"0 0 0 1 0 0 0.5 {size} 0 0.5 0 {size}", fields=field)


# Two tets far from each other, with nothing in the middle.
SPECKS = unstructured(
    points="0 0 0 1 0 0 0 1 0 0 0 1 1e7 1e7 1e7 10000001 1e7 1e7 1e7 10000001 1e7 1e7 1e7 10000001",
    cells="0 1 2 3 4 5 6 7",
    offsets="4 8",
    types="10 10",
    fields='<PointData>\n<DataArray type="Float64" Name="f" format="ascii">0 1 2 3 4 5 6 7</DataArray>\n</PointData>\n',
)
BAR = {"a.vtu": tet(0.001)}
BAR_COMMAND = "render a.vtu -o a.png --size 64x64 --view front "
FAR = {"far.json": '{"position": [50, 0, 9], "focal_point": [50, 0, 0], "view_up": [0, 1, 0], "parallel_scale": 2}'}
NEAR = {
    "near.json": '{"position": [0, 0, 9], "focal_point": [0, 0, 0], "view_up": [0, 1, 0], "parallel_scale": 2, '
    '"clipping_range": [1, 2]}'
}
CLEAR = {"f.txt": "0 1 1 1 0\n1 1 1 1 0\n"}
PAST = {"f.txt": "5 1 1 1 0\n6 1 1 1 3\n"}
FAINT = {"f.txt": "0 1 1 1 1e-6\n1 1 1 1 1e-6\n"}
DARK = {"f.txt": "0 1e-9 0 0 0\n1 1e-9 0 0 0\n"}
SEEN = {"f.txt": "0 1 1 1 2\n1 1 1 1 3\n"}

# Every second sample of one field is NaN, so that no voxel has all of its corners.
HOLES = image_data(values="0.5 nan nan 1.5 nan 2.5 3.5 nan").replace(
    "</PointData>", '<DataArray type="Float64" Name="g" format="ascii">0 1 2 3 4 5 6 7</DataArray>\n</PointData>'
)
EVERY_OTHER = {"a_2x2x2_uint8.raw": bytes([0, 5, 5, 1, 5, 1, 0, 5])}
OF_RAW = "render a_2x2x2_uint8.raw -o a.png --size 16x16 "
# A single visible sample, in a corner.
CORNER = {"a_8x8x8_float32.raw": struct.pack("<512f", 9, *[0] * 511), "f.txt": "1 1 1 1 0\n9 1 1 1 9\n"}
SPOT = {**CORNER, "f.txt": "8 1 1 1 0\n9 1 1 1 9\n"}
OF_CORNER = "render a_8x8x8_float32.raw -o a.png --size 16x16 --transfer-function f.txt "

OCEAN = netcdf(
    {"depth": 3, "lat": 2, "lon": 2},
    [
        ("depth", "d", ("depth",), [0.0, 1000.0, 4000.0], [("units", "c", "m")]),
        ("lat", "d", ("lat",), [0.0, 1.0], [("units", "c", "degrees_north")]),
        ("lon", "d", ("lon",), [0.0, 1.0], [("units", "c", "degrees_east")]),
        ("f", "f", ("depth", "lat", "lon"), [float(k) for k in range(12)], ()),
    ],
)

ROWS = [
    row(BAR_COMMAND, "the centres of pixels; --size 1536x1536", BAR_COMMAND.replace("64x64", "1536x1536"), BAR),
    row("render a.vtu -o a.png --size 64x64", "shows something", "render a.vtu -o a.png --size 64x64 "
        "--camera '{\"position\": [0.2, 0.2, 9], \"focal_point\": [0.2, 0.2, 0], \"view_up\": [0, 1, 0], "
        "\"parallel_scale\": 1}'", {"a.vtu": SPECKS}),
    row("render a.vtu -o a.png --size 64x64", "no volume that a pixel could show; give a mesh that has", None,
        {"a.vtu": unstructured(points="0 0 0 1 0 0 0 1 0 1 1 0")}, {"a.vtu": unstructured()}),
    row(R + "--camera far.json", "is in the view; --fit shows something", R + "--camera far.json --fit", FAR),
    row(R + "--camera near.json", "a camera without its clipping_range", R + "--camera near.json --fit", NEAR),
    row(R + "--transfer-function f.txt", "no pixel is more opaque than", R + "--transfer-function f.txt "
        "--opacity-scale 1e6", FAINT),
    row(R + "--transfer-function f.txt --emission independent", "give the transfer function brighter colours", None,
        DARK, SEEN),
    row(R + "--transfer-function f.txt --iso 50", "; give it opacity", None, CLEAR, SEEN),
    row(R + "--transfer-function f.txt --iso 50", "stretches it over them", R + "--transfer-function f.txt --range=-9,9",
        PAST),
    row(OF_RAW + "--transfer-function f.txt --threshold 4,6", "all its values in --threshold; leave it out",
        OF_RAW + "--transfer-function f.txt", {**EVERY_OTHER, **SEEN}),
    row("render a.vti -o a.png --size 16x16 --field f", "choose another --field",
        "render a.vti -o a.png --size 16x16 --field g", {"a.vti": HOLES}),
    row(OF_CORNER + "--zoom 50", "see the whole without --zoom", OF_CORNER, CORNER),
    row(OF_CORNER, "give a larger --size", OF_CORNER.replace("16x16", "256x256"), SPOT),
    row("info a.nc", "--scale 1,1,1 keeps it as it is", "info a.nc --scale 1,1,1", {"a.nc": OCEAN}),
]
