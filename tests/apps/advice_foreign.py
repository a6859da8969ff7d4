# SPDX-License-Identifier: BSD-3-Clause
"""Rows of advice about files of VTK's formats."""

import gzip
import struct

from advice_files import (
    AMR,
    AMR_FILES,
    CORNERS,
    IMAGE,
    LEGACY,
    PVTU,
    RECTILINEAR,
    STL,
    TETRAHEDRON,
    TREES,
    UNEVEN,
    VTM,
    VTP,
    block,
    hyper_trees,
    image_data,
    in_pieces,
    rectilinear,
    unstructured,
)
from advice_row import cut, damaged, row

TET = unstructured()
R = "render m.vtu -o a.png --size 16x16 "


def mesh(whole, advice, good=TET):
    """A .vtu that is written again."""
    return row("info a.vtu", advice, None, {"a.vtu": whole}, {"a.vtu": good})


def binary_legacy(order):
    """Legacy VTK of one tetrahedron in binary numbers of a byte order; the format requires big-endian."""
    numbers = struct.Struct(f"{order}12f").pack(*[x for p in CORNERS for x in p])
    return (
        b"# vtk DataFile Version 3.0\none\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n"
        + numbers
        + b"\nCELLS 1 5\n"
        + struct.pack(f"{order}5i", 4, 0, 1, 2, 3)
        + b"\nCELL_TYPES 1\n"
        + struct.pack(f"{order}i", 10)
        + b"\n"
    )


def amr(advice, good=AMR_FILES, command="info a.vth", **files):
    return row(command, advice, None, {**AMR_FILES, **{f"{name}.vti": text for name, text in files.items()}}, good)


def trees(advice, whole):
    return row("info a.htg", advice, None, {"a.htg": whole}, {"a.htg": TREES})


FIELD = '<PointData>\n<DataArray type="Float64" Name="f" format="ascii">{}</DataArray>\n</PointData>\n'
CELL_FIELD = '<CellData>\n<DataArray type="Float64" Name="f" format="ascii">{}</DataArray>\n</CellData>\n'
PIECE = unstructured(fields=FIELD.format("0 1 2 3"))
FACES = '<DataArray type="Int64" Name="{}" format="ascii">{}</DataArray>\n'
POLYHEDRON = FACES.format("faces", "4 3 0 2 1 3 0 1 3 3 1 2 3 3 0 3 2") + FACES.format("faceoffsets", "17")
TWO = {"p.vtu": PIECE, "q.vtu": PIECE.replace("0 0 0 1 0 0 0 1 0 0 0 1", "5 0 0 6 0 0 5 1 0 5 0 1")}
GRID_PIECES = [("p", "0 1 0 1 0 1"), ("q", "1 2 0 1 0 1")]


def pieces(kind, extension, advice, p, q, good):
    """A grid of two pieces."""
    listed = in_pieces(kind, [(f"{name}.{extension}", points) for name, points in GRID_PIECES])
    return row(
        f"info a.p{extension}",
        advice,
        None,
        {f"a.p{extension}": listed, f"p.{extension}": p, f"q.{extension}": q},
        {f"q.{extension}": good, **({f"p.{extension}": IMAGE} if extension == "vti" else {})},
    )


def second(text):
    """The same grid, shifted along x."""
    return text.replace("0 1 0 1 0 1", "1 2 0 1 0 1")


SECOND = second(rectilinear("1 2"))
DEEP = " ".join(["1"] + ["8"] * 31)

VOLUME = (
    "# vtk DataFile Version 3.0\none\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nORIGIN 0 0 0\nSPACING 1 1 1\n"
    "POINT_DATA 8\nSCALARS f float 1\nLOOKUP_TABLE default\n0 1 2 3 4 5 6 7\n"
)
PARTS = (
    '<VTKFile type="Collection"><Collection><DataSet timestep="0" part="0" file="m.vtu"/><DataSet '
    'timestep="0" part="1" file="{}"/>'
    "</Collection></VTKFile>"
)

ONLY_FIELDS = "# vtk DataFile Version 3.0\nt\nASCII\n\nFIELD all 1\nf 1 4 float\n0 1 2 3\n"
SERVERS = "FORMAT\ntype: master_server gold\nSERVERS\nnumber of servers: 1\ncasefile: m.case\n"
ENSIGHT = {
    "m.case": "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: m.geo\nVARIABLE\nscalar per node: f m.f\n",
    "m.geo": "made\nhere\nnode id off\nelement id off\npart\n         1\nbox\ncoordinates\n         4\n"
    + "".join(f"{x:12.5e}\n" for x in (0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1))
    + "tetra4\n         1\n         1         2         3         4\n",
    "m.f": "f\npart\n         1\ncoordinates\n" + "".join(f"{x:12.5e}\n" for x in range(4)),
}

ROWS = [
    # unstructured grids
    mesh(unstructured(cells="0 1 2 9"), "the file holds 4 points; write cells and points from one mesh"),
    mesh(unstructured(cells="0 1 2 -7"), "a point of no possible number, the file holds 4 points"),
    mesh(unstructured(offsets="9"), "the file is truncated or damaged, export it again"),
    mesh(
        unstructured(cells="0 1 2 3 0 1 2 3", offsets="6 4", types="10 10"),
        "the file is damaged, export it again",
    ),
    mesh(unstructured(cells="0 1 2 3 0 1 2 3", offsets="3 8", types="10 10"), "it must have 4; correct the cell types"),
    mesh(unstructured(types="64"), "split such cells into tetrahedra first"),
    mesh(
        unstructured(types="42"),
        "is a polyhedron without a list of its faces; write it with them",
        unstructured(types="42", faces=POLYHEDRON),
    ),
    mesh(
        unstructured(types="42", faces=POLYHEDRON.replace("3 0 2 1", "3 0 2 9")),
        "write them again",
        unstructured(types="42", faces=POLYHEDRON),
    ),
    mesh(unstructured(fields=FIELD.format("0 1 2")), "export it again"),
    mesh(unstructured(types="5", cells="0 1 2", offsets="3"), "give a mesh of volume cells or choose another field"),
    cut("a.vtu", TET, len(TET) - 30, "the file is truncated or damaged, export it again"),
    damaged("a.vtu", TET, "</Points>", "</Point>", "export it again"),
    damaged("a.vtu", TET, "VTKFile type", "File type", "check that it is one"),
    damaged("a.vtu", TET, '"UnstructuredGrid"', '"Table"', "give a mesh"),
    row("info a.vtk", "give the file that does", None, {"a.vtk": ONLY_FIELDS}, {"a.vtk": LEGACY}),
    row("info a.sos", "put it there", None, {"a.sos": SERVERS}, ENSIGHT),
    damaged("a.sos", SERVERS, "casefile:", "file:", "write it again", beside=ENSIGHT),
    damaged("a.vtk", LEGACY, "# vtk DataFile Version 3.0", "vtk", "check that it is a legacy VTK file"),
    damaged("a.vtk", LEGACY, "SCALARS", "SCALRS", "correct it, or have the file written again"),
    damaged("a.vtk", LEGACY, "CELL_TYPES 1\n10", "CELL_TYPES 1\n64", "(ParaView: Tetrahedralize)"),
    row(
        "info a.vtk",
        "swap their bytes, or export text or .vtu",
        None,
        {"a.vtk": binary_legacy("<")},
        {"a.vtk": binary_legacy(">")},
    ),
    damaged("a.vtk", LEGACY, "POINT_DATA 4", "POINT_DATA 5", "or have it written in another format"),
    # pieces and blocks
    row(
        "info a.pvtu",
        "piece 0 has no Source; write it again",
        None,
        {"a.pvtu": PVTU.replace("Source", "From"), "p.vtu": PIECE},
        {"a.pvtu": PVTU},
    ),
    row("info a.pvtu", "there is no such file", None, {"a.pvtu": PVTU}, {"p.vtu": PIECE}),
    row("info a.pvtu", "is not a regular file; give one that", None, {"a.pvtu": PVTU, "p.vtu": ("link", "/dev/null")}, {"p.vtu": PIECE}),
    row("info a.vtu", "it is text in UTF-16; save it in UTF-8", None, {"a.vtu": PIECE.encode("utf-16")}, {"a.vtu": PIECE}),
    row(
        "info a.vtu",
        "nested more than 256 deep; the file is damaged, export it again",
        None,
        {"a.vtu": PIECE.replace("</VTKFile>", "<a>" * 300 + "</a>" * 300 + "</VTKFile>")},
        {"a.vtu": PIECE},
    ),
    row(
        "info a.pvtu",
        "does not begin as a VTK XML file does; write it again",
        None,
        {"a.pvtu": PVTU, "p.vtu": "nothing"},
        {"p.vtu": PIECE},
    ),
    row(
        "info a.pvtu",
        "not 'UnstructuredGrid'; write both again",
        None,
        {"a.pvtu": PVTU, "p.vtu": IMAGE},
        {"p.vtu": PIECE},
    ),
    row(
        "info a.pvtu.gz",
        "unpack it with gunzip",
        "info a.pvtu",
        {"a.pvtu.gz": gzip.compress(PVTU.encode())},
        {"a.pvtu": PVTU, "p.vtu": PIECE},
    ),
    row(
        "info a.vtm",
        "not a mesh or grid; leave it out",
        None,
        {"a.vtm": VTM, **TWO, "q.vtu": VTM},
        {"a.vtm": VTM.replace('file="q.vtu"', "")},
    ),
    row("info a.vtm --block three", "it has 'one', 'two'", "info a.vtm --block two", {"a.vtm": VTM, **TWO}),
    row("info a.vtm --block onee", "the nearest is 'one'", "info a.vtm --block one", {"a.vtm": VTM, **TWO}),
    *(
        row(
            "info a.pvtu --field f",
            f"{words}' of {size} that other pieces have; write all pieces with the same fields",
            None,
            {
                "a.pvtu": PVTU.replace('<Piece Source="p.vtu"/>', '<Piece Source="p.vtu"/><Piece Source="q.vtu"/>'),
                "p.vtu": unstructured(fields=field),
                "q.vtu": TET,
            },
            {"q.vtu": unstructured(fields=field)},
        )
        for words, size, field in (
            ("it lacks the point field 'f", "one component", FIELD.format("0 1 2 3")),
            (
                "it lacks the point field 'f",
                "2 components",
                FIELD.replace('"f"', '"f" NumberOfComponents="2"').format("0 1 2 3 4 5 6 7"),
            ),
            ("it lacks the cell field 'f", "one component", CELL_FIELD.format("7")),
            (
                "it lacks the cell field 'f",
                "2 components",
                CELL_FIELD.replace('"f"', '"f" NumberOfComponents="2"').format("7 8"),
            ),
        )
    ),
    # grids
    row(
        "info a.vti",
        "it has no field; write one with it",
        None,
        {"a.vti": IMAGE.replace("PointData", "NoData")},
        {"a.vti": IMAGE},
    ),
    row("info a.vti", "export it again", None, {"a.vti": image_data(values="0 1 2")}, {"a.vti": IMAGE}),
    row("info a.vtr", "write the file again", None, {"a.vtr": UNEVEN.replace("0 1 3", "0 1 0")}, {"a.vtr": UNEVEN}),
    pieces("ImageData", "vti", "but not a .vti; write them again", IMAGE, RECTILINEAR, second(IMAGE)),
    pieces(
        "ImageData",
        "vti",
        "but a.pvti states 1 2 0 1 0 1; write them again",
        IMAGE,
        IMAGE,
        second(IMAGE),
    ),
    pieces(
        "ImageData",
        "vti",
        "another piece of a.pvti has it as double x 1; write them again",
        IMAGE,
        second(IMAGE).replace("Float64", "Float32"),
        second(IMAGE),
    ),
    pieces(
        "RectilinearGrid",
        "vtr",
        "another piece of a.pvtr has it at 1; write them again",
        RECTILINEAR,
        SECOND.replace(">1 2<", ">1.5 2<"),
        SECOND,
    ),
    row(
        "info a.pvti",
        "being flat or empty; give a volume",
        None,
        {"a.pvti": in_pieces("ImageData", [], "0 2 0 2 0 0")},
        {"a.pvti": in_pieces("ImageData", [("p.vti", "0 1 0 1 0 1")], "0 1 0 1 0 1"), "p.vti": IMAGE},
    ),
    row(
        "info a.pvti",
        "the file is truncated or damaged, write it again",
        None,
        {"a.pvti": in_pieces("ImageData", [("p.vti", "0 1 0 1 0 1")]), "p.vti": IMAGE},
        {"a.pvti": in_pieces("ImageData", [("p.vti", "0 1 0 1 0 1")], "0 1 0 1 0 1")},
    ),
    # surfaces
    damaged("a.vtp", VTP, "0 2 1 0", "0 2 9 0", "the file holds 4; write it again"),
    cut("a.stl", STL, 20, "write it again"),
    row(
        "info a.stl",
        "close its holes",
        None,
        {"a.stl": STL.replace(STL[STL.index("facet") : STL.index("endfacet") + 9], "")},
        {"a.stl": STL},
    ),
    # AMR
    amr(
        "blocks of AMR meshes must be aligned with the axes; turn it back",
        b1=block(spacing="0.5 0.5 0.5", more=' Direction="0 1 0 -1 0 0 0 0 1"'),
    ),
    amr(
        "no cells of volume; give a three-dimensional mesh",
        b1=block("0 2 0 2 0 0", spacing="0.5 0.5 0.5", values="0 1 2 3"),
    ),
    amr("give numbers, spacings above 0", b1=block(spacing="0.5 0 0.5")),
    amr("only whole ratios, the same along all axes, are read", b1=block(spacing="0.5 0.5 0.3")),
    amr("write the levels between", b1=block(spacing="0.01 0.01 0.01")),
    amr("that of its level 1; write it again", b1=block(spacing="1 1 0.95")),
    amr("which has to be a whole number; write it again", b1=block(origin="0.2 0 0", spacing="0.5 0.5 0.5")),
    amr("cells long, the limit is", b1=block(origin="1000000000 0 0", spacing="0.5 0.5 0.5")),
    row(
        "info a.vth",
        "check what it is",
        None,
        {
            **AMR_FILES,
            "a.vth": AMR.replace("<vtkOverlappingAMR>", "<other>").replace("</vtkOverlappingAMR>", "</other>"),
        },
        AMR_FILES,
    ),
    row(
        "info a.vth",
        "it holds no cells; check how it was written",
        None,
        {"a.vth": AMR.replace("DataSet", "Data")},
        AMR_FILES,
    ),
    row(
        "info a.vth",
        "write all blocks with one",
        None,
        {
            "a.vth": AMR,
            "b0.vti": block().replace("CellData", "NoData"),
            "b1.vti": block(spacing="0.5 0.5 0.5").replace("CellData", "NoData"),
        },
        AMR_FILES,
    ),
    # trees
    trees("up to 2 is read; save it as .vtu in ParaView", hyper_trees(version="3.0")),
    trees("HyperTreeGrids' by 2 or 3; write it again", hyper_trees(branching=5)),
    trees("give a grid of three", hyper_trees(("0 1", "0 1", "0"))),
    trees("write it again", hyper_trees(counts="1 9")),
    trees("give coordinates that rise, or fewer levels", hyper_trees(("1 0", "0 1", "0 1"))),
    row(
        "info a.phtg",
        "has no Source; write it again",
        None,
        {
            "a.phtg": '<VTKFile type="PHyperTreeGrid"><PHyperTreeGrid><Piece/></PHyperTreeGrid></VTKFile>',
            "p.htg": TREES,
        },
        {"a.phtg": '<VTKFile type="PHyperTreeGrid"><PHyperTreeGrid><Piece Source="p.htg"/></PHyperTreeGrid></VTKFile>'},
    ),
    *(
        row(
            "info a.phtg",
            advice,
            None,
            {
                "a.phtg": '<VTKFile type="PHyperTreeGrid"><PHyperTreeGrid><Piece Source="p.htg"/><Piece '
                'Source="q.htg"/></PHyperTreeGrid></VTKFile>',
                "p.htg": TREES,
                "q.htg": other,
            },
            {
                "a.phtg": '<VTKFile type="PHyperTreeGrid"><PHyperTreeGrid><Piece Source="p.htg"/>'
                "</PHyperTreeGrid></VTKFile>"
            },
        )
        for advice, other in (
            ("write each tree once, or mark ghosts by vtkGhostType", TREES),
            (
                "its grid is not that of piece 'p.htg'; write all pieces of one data set",
                hyper_trees(("0 1 2", "0 1", "0 1")),
            ),
            ("are not those of piece 'p.htg'; write all pieces of one data set", hyper_trees(("0 2", "0 1", "0 1"))),
        )
    ),
    row(
        "render a.pvd -o a.png --size 16x16",
        "give it alone",
        "render a.htg -o a.png --size 16x16",
        {
            "a.htg": TREES,
            "a.pvd": '<VTKFile type="Collection"><Collection><DataSet timestep="0" part="0" file="a.htg"/>'
            '<DataSet timestep="0" part="1" file="m.vtu"/></Collection></VTKFile>',
        },
    ),
    # surfaces, shapes and parts
    row(
        "render a.vtm -o a.png --size 16x16 --surface two",
        "is not finite; correct it",
        None,
        {"a.vtm": VTM.replace("q.vtu", "q.vtp"), "p.vtu": PIECE, "q.vtp": VTP.replace("1 0 0", "1 nan 0")},
        {"q.vtp": VTP},
    ),
    mesh(TET.replace('NumberOfPoints="4"', 'NumberOfPoints="99999999999"'), "export it again"),
    mesh(TET.replace("0 0 0 1 0 0", "0 0 0 one 0 0"), "should be; correct it"),
    mesh(TET.replace('NumberOfComponents="3"', 'NumberOfComponents="2"'), "give x y z"),
    mesh(unstructured(cells="", offsets="", types=""), "check how it was written"),
    row(
        "render a.vtu -o a.png --size 16x16",
        "--field draws one of",
        "render a.vtu -o a.png --size 16x16 --field f",
        {"a.vtu": unstructured(fields=FIELD.format("7 7 7 7"))},
    ),
    row(
        "render a.pvd -o a.png --size 16x16",
        "give it alone or among volumes",
        "render a.vtk -o a.png --size 16x16",
        {"a.vtk": VOLUME, "a.pvd": PARTS.format("a.vtk")},
    ),
    row(
        "render a.pvd -o a.png --size 16x16",
        "give it alone or among volumes",
        "render v.vti -o a.png --size 16x16",
        {"a.pvd": PARTS.format("v.vti")},
    ),
    trees(
        "write it with fewer levels",
        hyper_trees(counts="1" + 40 * " 8", divided="1" + 39 * " 1 0 0 0 0 0 0 0", depth="41"),
    ),
]
