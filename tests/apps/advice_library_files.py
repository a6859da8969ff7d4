# SPDX-License-Identifier: BSD-3-Clause
"""Valid files of other libraries' formats for the test of advice, each the smallest that is read."""

import struct

from advice_files import CORNERS, FACES, lines

GMSH = (
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n"
    + lines((k + 1, *p) for k, p in enumerate(CORNERS))
    + "$EndNodes\n$Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n"
)
MEDIT = (
    "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n"
    + lines((*p, 0) for p in CORNERS)
    + "Tetrahedra\n1\n1 2 3 4 0\nEnd\n"
)
UNV = (
    "    -1\n  2411\n"
    + lines((f"{k + 1:10}{1:10}{1:10}{11:10}\n" + "".join(f"{x:25.16E}" for x in p),) for k, p in enumerate(CORNERS))
    + "    -1\n    -1\n  2412\n"
    + lines(("".join(f"{n:10}" for n in numbers),) for numbers in [(1, 111, 1, 1, 7, 4), (1, 2, 3, 4)])
    + "    -1\n"
)
UCD = (
    "4 1 1 0 0\n"
    + lines((k + 1, *p) for k, p in enumerate(CORNERS))
    + "1 1 tet 1 2 3 4\n1 1\nf, none\n"
    + lines((k + 1, k) for k in range(4))
)

CUBE = [[(k & 1), (k >> 1) & 1, k >> 2] for k in range(8)]
PLOT3D_LIST = '{"filenames": [{"xyz": "a.xyz"}]}'
PLOT3D = "2 2 2\n" + "".join(" ".join(str(p[axis]) for p in CUBE) + "\n" for axis in range(3))
SOLUTION = "2 2 2\n0.5 0 1 0\n" + "".join(" ".join("12345678") + "\n" for _ in range(5))


def item(values, dimensions=None, more=""):
    words = values.split()
    return (
        f'<DataItem Dimensions="{dimensions or len(words)}" Format="XML" NumberType="Float" '
        f'Precision="8"{more}>{values}</DataItem>'
    )


def xdmf(grid, before=""):
    return f'<?xml version="1.0"?>\n{before}<Xdmf Version="3.0">\n<Domain>\n{grid}\n</Domain>\n</Xdmf>\n'


def xdmf_mesh(
    points=item("0 0 0 1 0 0 0 1 0 0 0 1", "4 3"),
    cells=item("0 1 2 3", "1 4"),
    kind="Tetrahedron",
    geometry="XYZ",
    values="1 2 3 4",
    more="",
    time="",
):
    return (
        f'<Grid Name="mesh" GridType="Uniform">\n{time}<Topology TopologyType="{kind}" '
        f'NumberOfElements="1"{more}>{cells}</Topology>\n'
        f'<Geometry GeometryType="{geometry}">{points}</Geometry>\n'
        f'<Attribute Name="f" AttributeType="Scalar" Center="Node">{item(values)}</Attribute>\n</Grid>'
    )


def xdmf_grid(
    dimensions="2 2 2",
    origin="0 0 0",
    values="1 2 3 4 5 6 7 8",
    kind="3DCoRectMesh",
    geometry="ORIGIN_DXDYDZ",
    spacing="1 1 1",
):
    return (
        f'<Grid Name="grid" GridType="Uniform">\n<Topology TopologyType="{kind}" Dimensions="{dimensions}"/>\n'
        f'<Geometry GeometryType="{geometry}">{item(origin)}{item(spacing)}</Geometry>\n'
        f'<Attribute Name="f" AttributeType="Scalar" Center="Node">{item(values)}</Attribute>\n</Grid>'
    )


XDMF = xdmf(xdmf_mesh())


def foam(kind, name, text):
    return f"FoamFile\n{{\n version 2.0;\n format ascii;\n class {kind};\n object {name};\n}}\n{text}"


def foam_list(rows):
    rows = list(rows)
    return f"{len(rows)}\n(\n" + "".join(f"{row}\n" for row in rows) + ")\n"


def foam_case(folder="case/"):
    mesh = folder + "constant/polyMesh/"
    return {
        folder + "system/controlDict": foam("dictionary", "controlDict", "startFrom startTime;\nstartTime 0;\n"),
        mesh + "points": foam("vectorField", "points", foam_list(f"({x} {y} {z})" for x, y, z in CORNERS)),
        mesh + "faces": foam("faceList", "faces", foam_list(f"3({a} {b} {c})" for a, b, c in FACES)),
        mesh + "owner": foam("labelList", "owner", foam_list([0] * 4)),
        mesh + "neighbour": foam("labelList", "neighbour", foam_list([])),
        mesh
        + "boundary": foam(
            "polyBoundaryMesh", "boundary", "1\n(\n wall\n {\n type wall;\n nFaces 4;\n startFace 0;\n }\n)\n"
        ),
        folder
        + "0/p": foam(
            "volScalarField", "p", "dimensions [0 0 0 0 0 0 0];\ninternalField uniform 1;\nboundaryField\n{\n}\n"
        ),
    }


FOAM = foam_case()


def dicom(
    instance, samples=1, bits=16, series="1.2.3.4", pixels=None, position=None, orientation="1\\0\\0\\0\\1\\0", about=""
):
    """A slice of 2x2 pixels, explicit little endian, according to part 5 of the DICOM standard."""

    def element(group, number, kind, value):
        if isinstance(value, int):
            value = struct.pack("<H", value)
        elif isinstance(value, str):
            value = value.encode() + (b"\0" if kind == "UI" else b" ") * (len(value) % 2)
        length = struct.pack("<HI", 0, len(value)) if kind in ("OB", "OW") else struct.pack("<H", len(value))
        return struct.pack("<HH", group, number) + kind.encode() + length + value

    kind, uid = "1.2.840.10008.5.1.4.1.1.2", f"{series}.{instance}"
    meta = (
        element(2, 1, "OB", b"\0\1")
        + element(2, 2, "UI", kind)
        + element(2, 3, "UI", uid)
        + element(2, 16, "UI", "1.2.840.10008.1.2.1")
        + element(2, 18, "UI", "1.2.3")
    )
    position = instance if position is None else position
    pixels = struct.pack("<4H", *range(instance, instance + 4)) if pixels is None else pixels
    return (
        bytes(128)
        + b"DICM"
        + element(2, 0, "UL", struct.pack("<I", len(meta)))
        + meta
        + (element(8, 8, "CS", about) if about else b"")
        + element(8, 0x16, "UI", kind)
        + element(8, 0x18, "UI", uid)
        + element(8, 0x60, "CS", "CT")
        + element(0x20, 0xD, "UI", "1.2.3")
        + element(0x20, 0xE, "UI", series)
        + element(0x20, 0x13, "IS", str(instance))
        + element(0x20, 0x32, "DS", f"0\\0\\{position}")
        + element(0x20, 0x37, "DS", orientation)
        + element(0x28, 2, "US", samples)
        + element(0x28, 4, "CS", "MONOCHROME2" if samples == 1 else "RGB")
        + (element(0x28, 6, "US", 0) if samples > 1 else b"")
        + element(0x28, 0x10, "US", 2)
        + element(0x28, 0x11, "US", 2)
        + element(0x28, 0x30, "DS", "1\\1")
        + element(0x28, 0x100, "US", bits)
        + element(0x28, 0x101, "US", bits)
        + element(0x28, 0x102, "US", bits - 1)
        + element(0x28, 0x103, "US", 0)
        + element(0x7FE0, 0x10, "OW", pixels)
    )


def dicom_frames(positions):
    """Frames of 2x2 pixels at these places along z, in one file."""

    def sequence(group, number, *items):
        content = b"".join(struct.pack("<HHI", 0xFFFE, 0xE000, len(item)) + item for item in items)
        return struct.pack("<HH2sHI", group, number, b"SQ", 0, len(content)) + content

    def place(z):
        text = f"0\\0\\{z}".encode()
        text += b" " * (len(text) % 2)
        return sequence(0x20, 0x9113, struct.pack("<HH2sH", 0x20, 0x32, b"DS", len(text)) + text)

    whole = dicom(1, pixels=struct.pack("<4H", 1, 2, 3, 4) * len(positions))
    count = struct.pack("<HH2sH", 0x28, 8, b"IS", 2) + f"{len(positions)} ".encode()
    rows, pixels = whole.index(struct.pack("<HH2s", 0x28, 0x10, b"US")), whole.index(struct.pack("<HH", 0x7FE0, 0x10))
    frames = sequence(0x5200, 0x9230, *[place(z) for z in positions])
    return whole[:rows] + count + whole[rows:pixels] + frames + whole[pixels:]


# One fragment of zero bytes, and the end.
FRAGMENTS = b"\xfe\xff\0\xe0\0\0\0\0\xfe\xff\xdd\xe0\0\0\0\0"


def packed(slices):
    """As compressed by RLE."""
    return slices.replace(b"1.2.840.10008.1.2.1\0", b"1.2.840.10008.1.2.5\0")


def segmentation(positions):
    """The same as segments."""
    return dicom_frames(positions).replace(b"\x08\0\x60\0CS\2\0CT", b"\x08\0\x60\0CS\4\0SEG ")


SLICES = {f"ct/{k}.dcm": dicom(k) for k in (1, 2, 3)}


def netcdf(dimensions, variables, attributes=()):
    """NetCDF's classic format: lengths of dimensions by name, 0 for the unlimited one; (name, type, dimensions,
    values, attributes) of variables, with the types of struct, "c" for a str."""
    codes = {"c": 2, "i": 4, "f": 5, "d": 6, "b": 1}

    def padded(data):
        return data + bytes(-len(data) % 4)

    def name_of(text):
        return struct.pack(">i", len(text)) + padded(text.encode())

    def numbers(kind, values):
        return values.encode() if kind == "c" else struct.pack(f">{len(values)}{kind}", *values)

    def listed(tag, entries):
        return struct.pack(">ii", tag if entries else 0, len(entries)) + b"".join(entries)

    def attribute_list(given):
        return listed(
            12,
            [
                name_of(name) + struct.pack(">ii", codes[kind], len(values)) + padded(numbers(kind, values))
                for name, kind, values in given
            ],
        )

    names = list(dimensions)

    def header(begins):
        entries = []
        for (name, kind, along, values, given), begin in zip(variables, begins):
            size = len(padded(numbers(kind, values)))
            entries.append(
                name_of(name)
                + struct.pack(f">i{len(along)}i", len(along), *(names.index(d) for d in along))
                + attribute_list(given)
                + struct.pack(">iii", codes[kind], size, begin)
            )
        return (
            b"CDF\1\0\0\0\0"
            + listed(10, [name_of(n) + struct.pack(">i", length) for n, length in dimensions.items()])
            + attribute_list(attributes)
            + listed(11, entries)
        )

    begins, at = [], len(header([0] * len(variables)))
    for _, kind, _, values, _ in variables:
        begins.append(at)
        at += len(padded(numbers(kind, values)))
    return header(begins) + b"".join(padded(numbers(kind, values)) for _, kind, _, values, _ in variables)


def axis(name, values=(0.0, 1.0)):
    return (name, "d", (name,), values, ())


def netcdf_grid(along=("z", "y", "x")):
    return netcdf(
        {name: 2 for name in along},
        [axis(name) for name in along] + [("f", "f", along, [float(k) for k in range(2 ** len(along))], ())],
    )


def exodus(dimension=3, corners=(1, 2, 3, 4), kind="TETRA4", set_element=1, sides=False):
    """An Exodus file of one tetrahedron and an element set, with a node set and a side set if requested."""
    dimensions = {
        "len_string": 33,
        "len_line": 81,
        "four": 4,
        "time_step": 0,
        "num_dim": dimension,
        "num_nodes": 4,
        "num_elem": 1,
        "num_el_blk": 1,
        "num_el_in_blk1": 1,
        "num_nod_per_el1": len(corners),
        "num_elem_sets": 1,
        "num_ele_els1": 1,
    }
    identity = [("name", "c", "ID")]
    variables = [("eb_status", "i", ("num_el_blk",), [1], ()), ("eb_prop1", "i", ("num_el_blk",), [1], identity)]
    variables += [
        (f"coord{'xyz'[a]}", "d", ("num_nodes",), [float(p[a]) for p in CORNERS], ()) for a in range(dimension)
    ]
    variables += [("connect1", "i", ("num_el_in_blk1", "num_nod_per_el1"), corners, [("elem_type", "c", kind)])]
    variables += [
        ("els_status", "i", ("num_elem_sets",), [1], ()),
        ("els_prop1", "i", ("num_elem_sets",), [7], identity),
        ("elem_els1", "i", ("num_ele_els1",), [set_element], ()),
    ]
    if sides:
        dimensions |= {"num_node_sets": 1, "num_nod_ns1": 1, "num_side_sets": 1, "num_side_ss1": 1}
        variables += [
            ("ns_status", "i", ("num_node_sets",), [1], ()),
            ("ns_prop1", "i", ("num_node_sets",), [5], identity),
            ("node_ns1", "i", ("num_nod_ns1",), [1], ()),
            ("ss_status", "i", ("num_side_sets",), [1], ()),
            ("ss_prop1", "i", ("num_side_sets",), [6], identity),
            ("elem_ss1", "i", ("num_side_ss1",), [1], ()),
            ("side_ss1", "i", ("num_side_ss1",), [1], ()),
        ]
    return netcdf(
        dimensions,
        variables,
        [
            ("api_version", "f", [4.98]),
            ("version", "f", [4.98]),
            ("floating_point_word_size", "i", [8]),
            ("file_size", "i", [1]),
            ("title", "c", "one"),
        ],
    )


EXODUS = exodus()


def minc(valid=(0.0, 127.0)):
    space = [
        (
            name,
            "i",
            (),
            [0],
            [
                ("varid", "c", "MINC standard variable"),
                ("vartype", "c", "dimension____"),
                ("step", "d", [1.0]),
                ("start", "d", [0.0]),
            ],
        )
        for name in ("zspace", "yspace", "xspace")
    ]
    range_of = [("valid_range", "d", list(valid)), ("signtype", "c", "signed__"), ("complete", "c", "true_")]
    return netcdf(
        {"zspace": 2, "yspace": 2, "xspace": 2},
        space
        + [
            ("image", "b", ("zspace", "yspace", "xspace"), list(range(8)), range_of),
            ("image-max", "d", ("zspace",), [127.0, 127.0], ()),
            ("image-min", "d", ("zspace",), [0.0, 0.0], ()),
        ],
    )


MINC = minc()
