# SPDX-License-Identifier: BSD-3-Clause
"""Writers of small inputs for random cases: meshes as .vtu, grids as .vti and .vtr, all exact to the bit.

Shapes: a grid's values are a flat list, x fastest, then y, then z. `kind` names an array's type as in VTK ("Float32",
"Float64", "UInt8", "UInt16", "Int16", "Int32"). """
import array as numbers
import base64
import struct


def float32(value):
    """The nearest 32-bit float, as a double."""
    return struct.unpack("<f", struct.pack("<f", value))[0]


def next_float32(value, steps):
    """The 32-bit float `steps` places above `value` (below if negative), as a double; `value` must be one, and not 0."""
    bits = struct.unpack("<i", struct.pack("<f", value))[0]
    return struct.unpack("<f", struct.pack("<i", bits + (steps if value > 0 else -steps)))[0]


def next_float64(value, steps):
    """The double `steps` places above `value` (below if negative); `value` must not be 0."""
    bits = struct.unpack("<q", struct.pack("<d", value))[0]
    return struct.unpack("<d", struct.pack("<q", bits + (steps if value > 0 else -steps)))[0]


def camera_text(eye, focal_point, view_up, lens, width, height, more=""):
    """A camera file; `lens` is a line of its own, as `view_angle 30`."""
    line = lambda name, numbers: f"{name} {' '.join(repr(float(x)) for x in numbers)}\n"
    return line("position", eye) + line("focal_point", focal_point) + line("view_up", view_up) + f"{lens}\n{more}size {width} {height}\n"


CODES = {"Float32": "f", "Float64": "d", "UInt8": "B", "Int8": "b", "UInt16": "H", "Int16": "h", "Int32": "i", "UInt32": "I", "Int64": "q"}


def array(name, kind, values, components=1):
    """A DataArray of bytes, so that NaN too is read unchanged."""
    data = numbers.array(CODES[kind], values if kind.startswith("Float") else [int(v) for v in values]).tobytes()
    words = base64.b64encode(struct.pack("<Q", len(data)) + data).decode()
    more = f' NumberOfComponents="{components}"' if components != 1 else ""
    return f'<DataArray type="{kind}" Name="{name}"{more} format="binary">{words}</DataArray>\n'


def document(kind, body):
    return (f'<?xml version="1.0"?>\n<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n'
            f'<{kind}{body}</{kind}>\n</VTKFile>\n')


def field(association, kind, values):
    where = "PointData" if association == "point" else "CellData"
    return f'<{where} Scalars="f">{array("f", kind, values)}</{where}>\n'


def write_vtu(path, points, tets, scalars, association="point", kind="Float64", more=""):
    """Tetrahedra: `points` triples, `tets` quadruples of indices, one scalar per point or cell. Points are doubles. `more`: XML."""
    body = (f'>\n<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(tets)}">\n' + field(association, kind, scalars) + more +
            "<Points>" + array("Points", "Float64", [x for p in points for x in p], 3) + "</Points>\n<Cells>" +
            array("connectivity", "Int64", [v for t in tets for v in t]) +
            array("offsets", "Int64", [4 * (i + 1) for i in range(len(tets))]) +
            array("types", "UInt8", [10] * len(tets)) + "</Cells>\n</Piece>\n")
    path.write_text(document("UnstructuredGrid", body))
    return path


def extent(counts):
    return " ".join(f"0 {n - 1}" for n in counts)


def write_vti(path, counts, values, association="point", kind="Float32", spacing=(1, 1, 1), origin=(0, 0, 0)):
    """A regular grid of counts = (x, y, z) points; cell data has one value less along each axis."""
    whole = extent(counts)
    body = (f' WholeExtent="{whole}" Origin="{" ".join(repr(float(o)) for o in origin)}" '
            f'Spacing="{" ".join(repr(float(s)) for s in spacing)}">\n<Piece Extent="{whole}">\n' +
            field(association, kind, values) + "</Piece>\n")
    path.write_text(document("ImageData", body))
    return path


def write_vtr(path, axes, values, association="point", kind="Float32"):
    """A rectilinear grid: `axes` three increasing lists of coordinates."""
    whole = extent([len(a) for a in axes])
    coordinates = "".join(array(name, "Float64", a) for name, a in zip("xyz", axes))
    body = (f' WholeExtent="{whole}">\n<Piece Extent="{whole}">\n' + field(association, kind, values) +
            f"<Coordinates>{coordinates}</Coordinates>\n</Piece>\n")
    path.write_text(document("RectilinearGrid", body))
    return path


def split_box(counts, low=(-1, -1, -1), high=(1, 1, 1)):
    """(points, tets) of a box of counts = (x, y, z) hexahedra, each split into six tets around the same diagonal, so
    that neighbours match."""
    nx, ny, nz = counts
    place = lambda n, i, a: low[a] + (high[a] - low[a]) * i / n
    points = [(place(nx, i, 0), place(ny, j, 1), place(nz, k, 2))
              for k in range(nz + 1) for j in range(ny + 1) for i in range(nx + 1)]
    index = lambda i, j, k: i + (nx + 1) * (j + (ny + 1) * k)
    ways = [(0, 1, 2), (0, 2, 1), (1, 0, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0)]
    tets = []
    for k in range(nz):
        for j in range(ny):
            for i in range(nx):
                for way in ways:
                    at, corners = [i, j, k], [index(i, j, k)]
                    for axis in way:
                        at[axis] += 1
                        corners.append(index(*at))
                    tets.append(tuple(corners))
    return points, tets
