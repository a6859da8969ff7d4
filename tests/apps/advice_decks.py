# SPDX-License-Identifier: BSD-3-Clause
"""Rows of advice about Tecplot's text, Nastran's decks and Medit meshes, which this library parses itself."""

import gzip
import struct

from advice_library_files import MEDIT
from advice_row import damaged, row

VARIABLES = 'VARIABLES="X" "Y" "Z" "f"\n'
NODES = "0 0 0 1\n1 0 0 2\n0 1 0 3\n0 0 1 4\n"
TECPLOT = VARIABLES + 'ZONE T="a", N=4, E=1, DATAPACKING=POINT, ZONETYPE=FETETRAHEDRON\n' + NODES + "1 2 3 4\n"
SECOND = 'ZONE T="b", N=4, E=1, DATAPACKING=POINT, ZONETYPE=FETETRAHEDRON\n' + NODES + "1 2 3 4\n"
BLOCKS = (
    VARIABLES
    + "ZONE N=4, E=1, DATAPACKING=BLOCK, ZONETYPE=FETETRAHEDRON, VARLOCATION=([4]=CELLCENTERED)\n"
    + "0 1 0 0\n0 0 1 0\n0 0 0 1\n5\n1 2 3 4\n"
)

GRIDS = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\n"
NASTRAN = "BEGIN BULK\n" + GRIDS + "GRID,4,,0.,0.,1.\nCTETRA,9,1,1,2,3,4\nENDDATA\n"
SYSTEM = (
    "BEGIN BULK\n" + GRIDS + "GRID,4,5,0.,0.,1.\nCORD2R,5,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nCTETRA,9,1,1,2,3,4\nENDDATA\n"
)
OF_POINTS = SYSTEM.replace("CORD2R,5,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n", "CORD1R,5,1,2,3\n").replace(
    "5,0.,0.,1.\n", "5,0.,1.,0.\n"
)


def tecplot(old, new, advice, whole=TECPLOT):
    return damaged("a.tec", whole, old, new, advice)


def nastran(old, new, advice, whole=NASTRAN):
    return damaged("a.bdf", whole, old, new, advice)


def meshb(dimension=3, kind=8, cell=(1, 2, 3, 4), cells=1):
    """Version 1: four points and cells of one kind."""
    text = struct.pack("<2i", 1, 1) + struct.pack("<3i", 3, 20, dimension)
    points = b"".join(struct.pack("<3fi", *p, 0) for p in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)))
    text += struct.pack("<3i", 4, 32 + len(points), 4) + points
    body = struct.pack(f"<{len(cell) + 1}i", *cell, 0)
    text += struct.pack("<3i", kind, len(text) + 12 + len(body), cells) + body
    return text + struct.pack("<2i", 54, 0)


def medit(whole, advice):
    return row("info a.meshb", advice, None, {"a.meshb": whole}, {"a.meshb": meshb()})


def medit_text(old, new, advice):
    return damaged("a.mesh", MEDIT, old, new, advice)


ROWS = [
    # Tecplot
    tecplot("1 2 3 4\n", '1 2 3 4\nVARIABLES="X" "Y"\n', "write what has other variables to another file"),
    tecplot("N=4", "N=400000000", "more than the file can hold; it is truncated, export it again"),
    tecplot("1 2 3 4\n", "1 2 3\n", "the zone ends before its nodes of elements do; it is truncated, export it again"),
    tecplot("1 2 3 4\n", "1 2 3 5\n", "nodes count from 1, export the file again"),
    tecplot("1 2 3 4\n", "1 2 3.5 4\n", "3.5 is among the nodes of elements; export the file again"),
    tecplot("0 1 0 3", "0 one 0 3", "'one' is among the values, and is not a number; export the file again"),
    tecplot("N=4", "N=4000000000", "more than the file can hold; it is truncated, export it again"),
    tecplot("N=4", "N=x", "N is 'x', not a whole number; export the file again"),
    tecplot("N=4", "N 4", "is not a key of a zone with a value; export the file again"),
    tecplot("N=4", "NV=4, N=4", "is not read; write them in order"),
    tecplot('"a"', '"a', "a quote does not end; end it, or export the file again"),
    tecplot(TECPLOT[TECPLOT.index(", E=1") :], ", E=", "'E' has no value; export the file again"),
    tecplot("E=1", "E=1, DT=(SINGLE", "the list of 'DT' does not end; export the file again"),
    tecplot("FETETRAHEDRON", "FEMIXED", "which is not read; export bricks or tetrahedra"),
    tecplot("FETETRAHEDRON", "FETRIANGLE", "give one with bricks, tetrahedra or three dimensions"),
    tecplot("ZONE", "ZONES", "it has no ZONE; check that it is a text of Tecplot's"),
    tecplot("=POINT", "=LINES", "the packing is 'LINES'; write POINT or BLOCK"),
    tecplot("VARIABLES=", "FILETYPE=SOLUTION\nVARIABLES=", "it holds a solution without its grid; write FILETYPE=FULL"),
    tecplot('"X" "Y" "Z" "f"', "X,Y,(Z),f", "VARIABLES holds no name here; quote the names"),
    tecplot('"Z" "f"', "", "give a file with all three"),
    tecplot("E=1", "E=1, PASSIVEVARLIST=([9])", "names other variables than the 1 to 4 of the file; export it again"),
    tecplot(
        "E=1",
        "E=1, VARSHARELIST=([1]=1)",
        "VARSHARELIST is zone 1, and 0 zones come before; export the file again",
    ),
    tecplot('"b", N=4', '"b", VARSHARELIST=([1]=1), N=3', "and needs 3; export the file again", TECPLOT + SECOND),
    tecplot(
        '"b", N=4, E=1',
        '"b", N=4, E=0, CONNECTIVITYSHAREZONE=1',
        "with which it shares them; export the file again",
        TECPLOT + SECOND,
    ),
    tecplot("BLOCK", "POINT", "values of cells are by points; write DATAPACKING=BLOCK", BLOCKS),
    tecplot("[4]", "[1]", "the coordinate 'X' is not of the zone's nodes; write it NODAL", BLOCKS),
    row(
        "info a.tec",
        "more than the file can hold; it is truncated, export it again",
        None,
        {"a.tec": 'VARIABLES="X" "Y" "Z"' + ' "v"' * 30 + "\nZONE I=150,J=1,K=2,F=BLOCK\nZONE I=150,J=2,K=2,F=BLOCK\n0"},
        {"a.tec": TECPLOT},
    ),
    row(
        "info a.tec",
        "nodes of faces, more than the file can hold; it is truncated, export it again",
        None,
        {"a.tec": VARIABLES + "ZONE N=1,E=1,FACES=2,ZONETYPE=FEPOLYHEDRON,F=BLOCK\n0 0 0 0\n2*900000\n"},
        {"a.tec": TECPLOT},
    ),
    # Nastran
    nastran("CTETRA,9,1,1,2,3,4", "", "give a deck with a volume"),
    nastran("1,2,3,4", "1,2,3,5", "element 9 uses GRID 5, which the file does not have; add it, or what includes it"),
    nastran("1,2,3,4", "1,2,,4", "and number 3 is blank; correct it"),
    nastran("1,2,3,4", "1,2,x,4", "'x' of CTETRA is not a whole number; correct it"),
    nastran("GRID,4,,0.", "GRID,4,,zero", "'zero' of GRID is not a number; correct it"),
    nastran("GRID,4", "GRID,", "GRID has no number; correct it"),
    nastran("GRID,4", "GRID,4,,5.,5.,5.\nGRID,4", "GRID 4 is given twice, at different places; remove one"),
    nastran("GRID,4,", "GRID,4,7", "which the file does not have; add it, or what includes it"),
    nastran("GRID,1", "\0GRID,1", "it is not text; give a Nastran bulk data file"),
    nastran("CORD2R", "CORD3G", "have the points written in the basic system", SYSTEM),
    nastran("CORD2R,5,0", "CORD2R,5,5", "which leads back to itself, or through a thousand others; correct it", SYSTEM),
    nastran("\n,1.,0.,0.", "\n,0.,0.,2.", "whose three points are on one line; correct it", SYSTEM),
    nastran("5,1,2,3", "5,1,2,8", "which uses GRID 8, which the file does not have; add it", OF_POINTS),
    nastran("5,1,2,3", "5,1,2,4", "in a coordinate system that it makes itself; correct it", OF_POINTS),
    nastran("CTETRA", "=,*x,==\nCTETRA", "'x' of GRID is not a number; correct it"),
    nastran("CTETRA", "=,=3,==\nCTETRA", "'=3' of GRID is not a replication; correct it"),
    nastran("CTETRA", "=(n),*1,==\nCTETRA", "'=(N)' is not a number of replications; correct it"),
    nastran("CTETRA", "=(99999999),*1,==\nCTETRA", "it replicates more than 10000000 entries; write them out"),
    nastran("CTETRA", "=,*9223372036854775807,==\nCTETRA", "leads to a number beyond 2^63; correct it"),
    nastran("CTETRA,9", "CTETRA,=", "'=' of CTETRA has no CTETRA before it to replicate; write its number"),
    nastran("ENDDATA", "BEGIN SUPER=1\nENDDATA", "give each part as a file of its own"),
    row(
        "info a.bdf",
        "it includes 'b.bdf', and there is no such file; put it there",
        None,
        {"a.bdf": "BEGIN BULK\nINCLUDE 'b.bdf'\nENDDATA\n"},
        {"b.bdf": NASTRAN},
    ),
    row(
        "info 0.bdf",
        "more than 64 files include each other; give one file",
        "info 70.bdf",
        {f"{k}.bdf": f"INCLUDE '{k + 1}.bdf'\n" if k < 70 else NASTRAN for k in range(71)},
    ),
    row(
        "info a.bdf.gz",
        "unpack it with gunzip",
        None,
        {"a.bdf.gz": gzip.compress(b"BEGIN BULK\nINCLUDE 'b.bdf'\nENDDATA\n")},
        {"a.bdf.gz": gzip.compress(NASTRAN.encode())},
    ),
    # Medit
    medit_text("MeshVersionFormatted", "Mesh", "it does not begin as a Medit mesh does; check what it is"),
    medit_text("Dimension 3", "Dimension 2", "and a volume has three; give one"),
    medit_text("Tetrahedra", "Triangles", "give a mesh of tetrahedra, hexahedra, prisms or pyramids"),
    medit_text("Tetrahedra", "HexahedraQ2", "its HexahedraQ2 are not read; export first-order cells"),
    medit_text("1 2 3 4 0", "1 2 3 5 0", "a cell uses point 5 of 4; the file is damaged, export it again"),
    medit_text("1 2 3 4 0", "1 2 3", "the file is truncated or damaged, export it again"),
    # binary Medit
    medit(meshb(dimension=2), "and a volume has three; give one"),
    medit(meshb(kind=33), "it has hexahedra of order 2, which are not read; export first-order cells"),
    medit(meshb(kind=6), "it holds no cells of volume; give a mesh of tetrahedra, hexahedra, prisms or pyramids"),
    medit(meshb(cell=(1, 2, 3, 5)), "a cell uses point 5 of 4; the file is damaged, export it again"),
    medit(meshb(cells=9), "more than the file can hold; the file is truncated or damaged, export it again"),
    medit(b"words", "it does not begin as a binary Medit mesh does; check what it is"),
]
