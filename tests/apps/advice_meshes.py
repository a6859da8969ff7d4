# SPDX-License-Identifier: BSD-3-Clause
"""Rows of advice about meshes and surfaces that the library reads itself."""

import struct

from advice_files import AMREX, BOX, ELE, FACES, NODE, PLY, POLY, SMESH, STL, SU2, TETRAHEDRON, TETS
from advice_row import cut, damaged, row

R = "render m.vtu -o a.png --size 16x16 "


def su2(old, new, advice):
    return damaged("a.su2", SU2, old, new, advice)


def surface(name, whole, old, new, advice):
    """For a file that `--surface` accepts."""
    return damaged(name, whole, old, new, advice, R + "--surface")


def amrex(file, old, new, advice):
    name = "plt/" + file
    old, new = (text if isinstance(AMREX[name], str) else text.encode() for text in (old, new))
    assert old in AMREX[name], old
    return row("info plt", advice, None, {**AMREX, name: AMREX[name].replace(old, new, 1)}, AMREX)


SHARED = "plt/Level_0/Cell_H"
FOUR_BOXES = {
    **AMREX,
    SHARED: AMREX[SHARED]
    .replace("(1 0\n", "(4 0\n" + 3 * (BOX + "\n"))
    .replace(")\n1\n", ")\n4\n" + 3 * "FabOnDisk: Cell_D_00000 0\n"),
    "plt/Header": AMREX["plt/Header"].replace("0 1 0\n0\n", "0 4 0\n0\n" + 9 * "0 1\n"),
}

CORNERS = SMESH.splitlines()[1:5]
CROSSED = (
    "8 3 0 0\n"
    + "".join(corner + "\n" for corner in CORNERS)
    + "4 0.1 0.1 0.1\n5 1.2 0.1 0.1\n6 0.1 1.2 0.1\n7 0.1 0.1 1.2\n8 0\n"
    + "".join(f"3 {a + first} {b + first} {c + first}\n" for first in (0, 4) for a, b, c in FACES)
    + "0\n0\n"
)

ROWS = [
    # SU2
    cut("a.su2", SU2, len(SU2) - 10, "the file ends at point 3 of 4; it is truncated, write it again"),
    su2("NELEM= 1", "NELEM=", "is missing; write it again"),
    su2("10 0", "10 x", "is not a point number; correct it"),
    su2("10 0", "10 99999999999999999999", "is too large; correct it"),
    su2("10 0", "10 4294967295", "a point number is too large; correct it"),
    su2("10 0", "10 7", "points count from 0, correct it"),
    su2("10 0", "99 0", "is not a cell type of SU2 (3 5 9 10 12 13 14); correct it"),
    su2("10 0", "110 0", "which is not read; have SU2 write .vtu"),
    su2("NELEM= 1", "NELEM= 999", "more than the file can hold; it is truncated, write it again"),
    su2("NPOIN", "NELEM= 1\n10 0 1 2 3\nNPOIN", "NELEM is given twice in one zone; correct it"),
    row("info a.su2", "NPOIN is given twice in one zone; correct it", None, {"a.su2": SU2 + "NPOIN= 0\n"}, {"a.su2": SU2}),
    su2("NELEM= 1\n10 0 1 2 3 0\n", "", "there is no NELEM; it is truncated, write it again"),
    cut("a.su2", SU2, SU2.index("NPOIN"), "there is no NPOIN; it is truncated, write it again"),
    su2("NDIME= 3", "NDIME= 2", "give one of 3 dimensions"),
    # .tets
    cut("a.tets", TETS, 9, "are too few for a .tets header of 16; write the file again"),
    damaged("a.tets", TETS, struct.pack("<q", 4), struct.pack("<q", -4), "this is not a little-endian .tets file"),
    damaged(
        "a.tets",
        TETS,
        struct.pack("<4i", 0, 1, 2, 3),
        struct.pack("<4i", 0, 1, 2, 9),
        "write tets and vertices from one mesh",
    ),
    row(
        "convert c.vtu b.tets",
        "write .vtu, or smooth it",
        "convert c.vtu b.tets --smooth",
        {"c.vtu": TETRAHEDRON.replace("PointData", "CellData").replace("0 250 500 1000", "7")},
    ),
    row(
        "convert c.vtu b.tets",
        "write .vtu, which holds doubles",
        "convert c.vtu b.vtu",
        {"c.vtu": TETRAHEDRON.replace("0 250", "0 1e99")},
    ),
    # TetGen's
    damaged("a.ele", ELE, "0 1 2 3", "0 1 2 9", "write the file again", beside={"a.node": NODE}),
    damaged("a.smesh", SMESH, "3 0 2 1", "3 0 2 x", "write the file again"),
    # surfaces
    damaged("a.ply", PLY, "3 0 2 1", "3 0 2 9", "the file holds 4; write it again"),
    cut("a.ply", PLY, len(PLY) - 9, "the file is truncated or damaged, write it again"),
    damaged("a.ply", PLY, "element face 4", "element face 0", "the surface has no faces; write it again"),
    damaged("a.ply", PLY, "1 0 0\n", "1 0 nan\n", "of the surface is not finite; correct it"),
    damaged("a.ply", PLY, "element face 4", "element face 3", "close its holes"),
    damaged("a.ply", PLY.replace("0 0 1\n", "0 0 1\n"), "0 0 1\n", "1 1 0\n", "it encloses nothing; give a closed one"),
    surface("a.ply", PLY, "element face 4", "element face 0", "the surface has no faces; write it again"),
    surface("a.ply", PLY, "1 0 0\n", "1 0 nan\n", "of the surface is not finite; correct it"),
    surface("a.ply", PLY, "3 0 2 1", "3 0 2 9", "the file holds 4; write it again"),
    row(
        R + "--surface m.tets",
        "give a .ply, .stl, .vtp, .vtk, .poly or .smesh",
        R + "--surface a.ply",
        {"m.tets": TETS, "a.ply": PLY},
    ),
    row(
        R + "--surface a.poly",
        "divide it into polygons without",
        None,
        {"a.poly": POLY.replace("4 0\n1\n3 0 2 1\n", "4 0\n1 1\n3 0 2 1\n1 0.2 0.2 0\n")},
        {"a.poly": POLY},
    ),
    row("info a.ply --max-volume 1e-15", "or more", "info a.ply --max-volume 0.01", {"a.ply": PLY}),
    row("info a.ply --max-volume 0", "a number above 0", "info a.ply --max-volume 1", {"a.ply": PLY}),
    # AMReX
    amrex("Header", "Level_0/Cell\n", "", "it is truncated, write it again"),
    row("info plt --warp v", "a mesh with levels of refinement is not moved; leave it out", "info plt", AMREX),
    amrex("Header", "0.0\n0\n", "0.0\nx\n", "is wanted; write it again"),
    amrex("Header", "0.5 0.5 0.5", "0.5 x 0.5", "a number is wanted; write it again"),
    amrex("Header", "(0,0,0))", "(1,0,0))", "which are not read; write values of cells"),
    amrex("Header", "(1,1,1)", "(-1,1,1)", "ends before it begins; write it again"),
    amrex("Header", "f\n3\n", "f\n2\n", "give a data set of three"),
    amrex(
        "Header",
        "0.5\n0\n0\n",
        "0.5\n1\n0\n",
        "its coordinates are cylindrical, only Cartesian ones are read; give another data set",
    ),
    amrex(
        "Header",
        "0.5\n0\n0\n",
        "0.5\n2\n0\n",
        "its coordinates are spherical, only Cartesian ones are read; give another data set",
    ),
    amrex("Level_0/Cell_H", "1\n1\n1\n", "2\n1\n1\n", "write it with vismf.headerversion = 1"),
    amrex("Level_0/Cell_H", "1\n1\n1\n", "1\n1\n2\n", "it has 2 fields, the Header has 1; write it again"),
    amrex("Level_0/Cell_H", "FabOnDisk:", "FabOnTape:", "where FabOnDisk: is wanted; write it again"),
    amrex("Level_0/Cell_D_00000", "FAB ", "BAF ", "no values begin there with FAB"),
    amrex("Level_0/Cell_D_00000", "(64 11", "(64 12", "write IEEE numbers of 32 or 64 bits"),
    amrex("Level_0/Cell_D_00000", ") 1\n", ") 2\n", "2 fields are there, the Header has 1; write it again"),
    amrex("Level_0/Cell_D_00000", "(1,1,1)", "(0,1,1)", "its box has cells 0 to 1; write it again"),
    row(
        "info plt",
        "it is truncated, write it again",
        None,
        {**AMREX, "plt/Level_0/Cell_D_00000": AMREX["plt/Level_0/Cell_D_00000"][:-8]},
        AMREX,
    ),
    row("info plt", "boxes share their values; it is damaged, write it again", None, FOUR_BOXES, AMREX),
    row(
        "info plt",
        "field 600 has no name; write it again",
        None,
        {**AMREX, "plt/Header": "HyperCLaw-V1.1\n700\n" + 600 * "fieldnam\n" + "\n"},
        AMREX,
    ),
    row("info a.smesh", "TetGen cannot fill the surface", None, {"a.smesh": CROSSED}, {"a.smesh": SMESH}),
]
