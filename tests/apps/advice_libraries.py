# SPDX-License-Identifier: BSD-3-Clause
"""Rows of advice about files read by libraries other than VTK's XML and legacy readers."""

import gzip
import struct

from advice_library_files import (
    CUBE,
    EXODUS,
    FOAM,
    GMSH,
    MINC,
    PLOT3D,
    PLOT3D_LIST,
    SLICES,
    SOLUTION,
    UCD,
    UNV,
    XDMF,
    axis,
    dicom,
    FRAGMENTS,
    dicom_frames,
    packed,
    segmentation,
    exodus,
    foam,
    foam_case,
    foam_list,
    item,
    minc,
    netcdf,
    netcdf_grid,
    xdmf,
    xdmf_grid,
    xdmf_mesh,
)
from advice_row import cut, damaged, row

HDF5 = b"\x89HDF\r\n\x1a\n" + b"?" * 2000


def wrong_xdmf(whole, advice, good=XDMF, **more):
    return row("info a.xdmf", advice, None, {"a.xdmf": whole, **more}, {"a.xdmf": good})


def f_of(values):
    """XDMF whose field is this item."""
    return XDMF.replace(item("1 2 3 4"), values)


NODE_DATA = '$NodeData\n1\n"f"\n1\n0\n3\n0\n1\n4\n1 0\n2 1\n3 2\n4 3\n$EndNodeData\n'


def record(numbers, kind="f"):
    return struct.pack(f"<i{len(numbers)}{kind}i", 4 * len(numbers), *numbers, 4 * len(numbers))


RECORDS_OF_PLANES = record((2, 2, 2), "i") + 2 * record(range(12))


def msh(old, new, advice):
    return damaged("a.msh", GMSH, old, new, advice)


def wrong_exodus(whole, advice, command="info a.ex2", mended=None, good=EXODUS):
    return row(command, advice, mended, {"a.ex2": whole}, {"a.ex2": good})


def ct(advice, command="info ct", mended=None, good=SLICES, **files):
    return row(command, advice, mended, {**SLICES, **{f"ct/{name}.dcm": whole for name, whole in files.items()}}, good)


def solved(old, new, advice):
    return row(
        "info a.xyz --q a.q", advice, None, {"a.xyz": PLOT3D, "a.q": SOLUTION.replace(old, new, 1)}, {"a.q": SOLUTION}
    )


def collection(*steps):
    grids = "".join(xdmf_mesh(time=f'<Time Value="{step}"/>\n') for step in steps)
    return xdmf(f'<Grid Name="steps" GridType="Collection" CollectionType="Temporal">{grids}</Grid>')


BINARY = struct.pack("<3i24f", 2, 2, 2, *(float(p[a]) for a in range(3) for p in CUBE))
GRID = xdmf(xdmf_grid())
TIMES = collection(0, 1)

CYLINDRICAL = (
    f"    -1\n  2420\n{1:10}\npart\n{2:10}{1:10}{8:10}\nround\n" + "1.0 0.0 0.0\n0.0 1.0 0.0\n0.0 0.0 1.0\n0.0 0.0 0.0\n    -1\n"
)
LFS_POINTER = f"version https://git-lfs.github.com/spec/v1\noid sha256:{'0' * 64}\nsize 12345\n"

ROWS = [
    # Gmsh
    msh("$EndElements\n", "", "it is truncated, write it again"),
    row(
        "info a.msh",
        "number these from 1",
        None,
        {"a.msh": (GMSH + NODE_DATA).replace("\n4 0 0 1\n", "\n1000000004 0 0 1\n").replace("2 3 4\n", "2 3 1000000004\n").replace("\n4 3\n", "\n1000000004 3\n")},
        {"a.msh": GMSH + NODE_DATA},
    ),
    msh("$MeshFormat", "$MashFormat", "it does not begin with $MeshFormat; write it again"),
    msh("1 4 2 1 1 1 2 3 4", "1 4 2 1 1 1 2 3 9", "write it again"),
    msh("1 4 2 1 1 1 2 3 4", "1 2 2 1 1 1 2 3", "give a mesh of tetrahedra, hexahedra, prisms or pyramids"),
    row(
        "info a.unv.gz",
        "have its name end in .unv",
        "info a.unv",
        {"a.unv.gz": gzip.compress(UNV.encode())},
        {"a.unv": UNV},
    ),
    damaged("a.unv", UNV, f"{111:10}", f"{117:10}", "export elements of first or second order"),
    damaged("a.unv", UNV, "  2412", "   780", "export it by a newer version, or in another format"),
    row(
        "info a.unv",
        "export points in the global one",
        None,
        {"a.unv": CYLINDRICAL + UNV.replace(f"{1:10}{1:10}", f"{1:10}{2:10}", 1)},
        {"a.unv": UNV},
    ),
    # XDMF
    wrong_xdmf('<?xml version="1.0"?>\n<Xdmf Version="3.0"/>\n', "it has no <Domain>; write it again"),
    wrong_xdmf(xdmf(""), "it holds no grid; give a mesh or a volume"),
    wrong_xdmf(
        xdmf(xdmf_mesh(), '<!DOCTYPE Xdmf [<!ENTITY a "b">]>\n'), "it defines entities of its own; write it without"
    ),
    wrong_xdmf(
        xdmf('<xi:include href="b.xdmf" xmlns:xi="http://www.w3.org/2001/XInclude"/>'),
        "have it written as one, with its numbers next to it",
    ),
    wrong_xdmf(
        xdmf(xdmf_mesh(values="1 2 3 4").replace('Name="f"', 'Name="f" Reference="XML"')),
        "write the element itself there, or save the file as .vtu",
    ),
    wrong_xdmf(
        XDMF.replace('Name="f"', 'Name="f" ItemType="FiniteElementFunction" ElementFamily="CG" ElementDegree="1"'),
        "write its values at points or cells",
    ),
    wrong_xdmf(xdmf(xdmf_mesh(values="1 2 3 4" + 10_000_000 * " ")), "write its numbers to HDF5 or a binary file"),
    wrong_xdmf(xdmf(xdmf_mesh(points=item("0 0 0 1 0 0 0 1 0", "4 3"))), "it is truncated or damaged, write it again"),
    wrong_xdmf(xdmf(xdmf_mesh(values="1 2 3")), "field 'f' has 3 values for 4 points; write it again"),
    wrong_xdmf(
        f_of('<DataItem ItemType="HyperSlab" Dimensions="4">' + item("1 1 4", "3 1") + item("1 2 3 4") + "</DataItem>"),
        "give three rows of as many numbers, with the slowest dimension first",
    ),
    wrong_xdmf(
        f_of('<DataItem ItemType="Coordinates" Dimensions="4">' + item("0 1 2 3") + item("1 2 3 4") + "</DataItem>"),
        "or choose them as a HyperSlab",
    ),
    wrong_xdmf(
        f_of('<DataItem Format="Binary" NumberType="Float" Precision="2" Dimensions="4">a.bin</DataItem>'),
        "write floats of 4 or 8 bytes or integers of 1, 2, 4 or 8",
        **{"a.bin": "12345678"},
    ),
    wrong_xdmf(xdmf(xdmf_mesh(geometry="X_Y_Z")), "not by three arrays of one length; write it again"),
    wrong_xdmf(
        xdmf(
            xdmf_mesh(values="1 2 3")
            .replace('"Node"', '"Cell"')
            .replace(item("0 1 2 3", "1 4"), item("0 1 2 3 0 1 2 3", "2 4"))
        ),
        "field 'f' has 3 values for 2 cells; write it again",
    ),
    wrong_xdmf(xdmf(xdmf_mesh(cells=item("6 0 1 2", "4"), kind="Mixed")), "its topology ends within a cell"),
    wrong_xdmf(
        xdmf(xdmf_mesh(cells=item("16 4 0 1 2 3", "6"), kind="Mixed")),
        "write tetrahedra, hexahedra, wedges or pyramids",
    ),
    wrong_xdmf(xdmf(xdmf_mesh(geometry="XY", points=item("0 0 1 0 0 1 1 1", "4 2"))), "not as x y z; write them so"),
    wrong_xdmf(
        xdmf(xdmf_grid("2 4", "0 0", kind="2DCoRectMesh", geometry="ORIGIN_DXDY", spacing="1 1")),
        "not a volume; give one of three",
        GRID,
    ),
    wrong_xdmf(xdmf(xdmf_grid("2 2 0")), "points along an axis; write it again", GRID),
    wrong_xdmf(XDMF.replace("Tetrahedron", "Nothing"), "the file or its data are damaged, write it again"),
    wrong_xdmf(
        XDMF.replace(
            item("0 1 2 3", "1 4"),
            '<DataItem Dimensions="1 4" Format="Binary" NumberType="Int" Precision="4">b.bin</DataItem>',
        ),
        "which is not there; put it there",
    ),
    wrong_xdmf(
        XDMF.replace(
            item("0 1 2 3", "1 4"),
            '<DataItem Dimensions="1 4" Format="Binary" NumberType="Int" Precision="4">b.bin</DataItem>',
        ),
        "the file has 3; write both again",
        **{"b.bin": b"abc"},
    ),
    wrong_xdmf(
        XDMF.replace(
            item("0 1 2 3", "1 4"),
            '<DataItem Dimensions="1 4" Format="Binary" NumberType="Int" Precision="4">/etc/passwd</DataItem>',
        ),
        "move it there, and name it so",
    ),
    row("info a.xdmf --time-step 2", "the file has 2; count from 0", "info a.xdmf --time-step 1", {"a.xdmf": TIMES}),
    row("info a.xdmf --time-step 2", "the file has none; leave it out", "info a.xdmf", {"a.xdmf": XDMF}),
    # Exodus
    wrong_exodus(b"nothing like it", "check that it is an Exodus file"),
    wrong_exodus(EXODUS[:-8], "write it again"),
    wrong_exodus(HDF5, "it is truncated or damaged, write it again"),
    wrong_exodus(exodus(2), "give a mesh in space"),
    wrong_exodus(exodus(kind="BLOB4"), "nodes; write tetrahedra, wedges"),
    wrong_exodus(exodus(corners=(1, 2, 3, 9)), "write elements and nodes from one mesh"),
    wrong_exodus(exodus(set_element=9), "write sets and elements from one mesh", "info a.ex2 --block 'element set 7'"),
    row(
        "info a.ex2 --block 'side set 6'",
        "(--surface shows side sets)",
        "info a.ex2 --block 'block 1'",
        {"a.ex2": exodus(sides=True)},
    ),
    row(
        "info a.ex2 --block 'node set 5'",
        "name element blocks or element sets",
        "info a.ex2 --block 'element set 7'",
        {"a.ex2": exodus(sides=True)},
    ),
    row(
        "info a.e.2.0",
        "put it next to it, or give this one another name",
        "info b.ex2",
        {"a.e.2.0": EXODUS, "b.ex2": EXODUS},
    ),
    row(
        "info a.e.2.0",
        "and none itself; write it again",
        None,
        {"a.e.2.0": EXODUS, "a.e.2.1": "nothing"},
        {"a.e.2.1": EXODUS},
    ),
    row("info a.ex2 --time-step 1", "there is no time step 1", "info a.ex2", {"a.ex2": EXODUS}),
    # NetCDF and MINC
    row(
        "info a.nc",
        "the file is truncated or damaged, write it again",
        None,
        {"a.nc": netcdf_grid()[:-8]},
        {"a.nc": netcdf_grid()},
    ),
    row(
        "info a.nc", "give a file of a grid in space", None, {"a.nc": netcdf_grid(("y", "x"))}, {"a.nc": netcdf_grid()}
    ),
    row("info a.mnc", "its valid_range is 7 to 7; write it again", None, {"a.mnc": minc((7.0, 7.0))}, {"a.mnc": MINC}),
    row(
        "convert a.nc b.vtr",
        "how the grid is turned; write .bricks",
        "convert a.nc b.bricks",
        {
            "a.nc": netcdf(
                {"z": 3, "y": 2, "x": 2},
                [axis("z", (4.0, 1.0, 0.0)), axis("y"), axis("x"), ("f", "f", ("z", "y", "x"), [0.5] * 11 + [2.0], ())],
            )
        },
    ),
    row("info a.mnc", "the file is truncated or damaged, write it again", None, {"a.mnc": MINC[:-30]}, {"a.mnc": MINC}),
    # OpenFOAM
    row(
        "info case.foam",
        "move it into the directory of a case, or name that directory",
        "info case/case.foam",
        {"case.foam": "", **FOAM, "case/case.foam": ""},
    ),
    row("info case.foam", "or name that directory", "info case", {"case.foam": "", **FOAM}),
    row("info case", "is not a regular file; remove it", None, {**FOAM, "case/0/x": ("link", "/dev/null")}, {"case/0/x": None}),
    row("info case", "write it again", None, {**FOAM, "case/constant/polyMesh/owner": "nothing"}, FOAM),
    row(
        "info case",
        "run reconstructPar, or decomposePar again",
        "info case",
        {
            "case/processor0/constant/x": "",
            **foam_case("case/processor0/"),
            "case/processor1/constant/polyMesh/x": "",
            "case/system/controlDict": FOAM["case/system/controlDict"],
        },
        foam_case(),
    ),
    # PLOT3D
    damaged("a.p3d", PLOT3D_LIST, '[{"xyz": "a.xyz"}]', '{"xyz": "a.xyz"}', "check that it is ParaView's", beside={"a.xyz": PLOT3D}),
    damaged("a.p3d", PLOT3D_LIST, '"a.xyz"', "3", "write it again", beside={"a.xyz": PLOT3D}),
    damaged("a.xyz", PLOT3D, "2 2 2\n0", "2 2 3\n0", "is truncated or of another kind (the solution goes with --q)"),
    row(
        "info a.bin",
        "it is truncated or of another kind (the solution goes with --q)",
        "info a.xyz",
        {"a.bin": b"\2\0\0\0" * 9, "a.xyz": PLOT3D},
    ),
    row("info a.bin", "write each grid as one record (/WHOLE)", "info m.vtu", {"a.bin": RECORDS_OF_PLANES}),
    damaged("a.xyz", PLOT3D, "0 1 0", "0 1d0 0", "write it with E"),
    damaged("a.xyz", PLOT3D, "0 1 0", "2*0 1 0", "write each"),
    damaged("a.xyz", PLOT3D, "0 1 0", "0 one 0", "PLOT3D in text is numbers alone"),
    row(
        "info a.xyz",
        "is not a whole number; correct it",
        None,
        {"a.xyz": PLOT3D + "1 1 1 1 1 1 1 0.5\n"},
        {"a.xyz": PLOT3D + "1 1 1 1 1 1 1 1\n"},
    ),
    row("info a.xyz", "name one by --q", "info a.xyz --q b.q", {"a.xyz": PLOT3D, "b.q": SOLUTION}),
    row(
        "info a.xyz.gz",
        "it has no field; name one by --q",
        "info a.xyz --q b.q",
        {"a.xyz.gz": gzip.compress(PLOT3D.encode()), "a.xyz": PLOT3D, "b.q": SOLUTION},
    ),
    solved("2 2 2", "2 2 3", "give the solution of this grid"),
    solved("1 2 3 4 5 6 7 8\n", "", "it is truncated or of another kind (function, OVERFLOW)"),
    row(
        "info a.xyz --q a.q",
        "give both in one form",
        None,
        {"a.xyz": PLOT3D, "a.q": b"\1\0\0\0" * 40},
        {"a.q": SOLUTION},
    ),
    # DICOM
    ct(
        "with 3 numbers a sample; give a series with one number a sample",
        **{str(k): dicom(k, samples=3, bits=8, pixels=bytes(12)) for k in (1, 2, 3)},
    ),
    row("info ct", "give a directory of slices", None, {"ct/1.dcm": dicom(1)}, SLICES),
    ct("give a directory", **{str(k): bytes(128) + b"DICM" + b"?" * 40 for k in (1, 2, 3)}),
    ct("write it again or leave it out", **{"2": dicom(2)[:-4]}),
    ct("may be missing", "info ct", None, {**SLICES, "ct/4.dcm": dicom(4)}, **{"4": dicom(5, position=5)}),
    ct(
        "name a file of another to show those",
        "info ct",
        "info ct/9.dcm",
        {},
        **{str(k): dicom(k, series="1.2.9") for k in (8, 9)},
    ),
    row(
        "info f.dcm",
        "times of one image, not a volume; give a volume",
        None,
        {"f.dcm": dicom_frames((1, 1, 1))},
        {"f.dcm": dicom_frames((1, 2, 3))},
    ),
    row(
        "info f.dcm",
        "all its segments are in one slice, which is not a volume; give a volume",
        None,
        {"f.dcm": segmentation((1, 1, 1))},
        {"f.dcm": segmentation((1, 2, 3))},
    ),
    row(
        "info f.dcm",
        "more than 65536 slices; correct their positions",
        None,
        {"f.dcm": segmentation((1, 2, 99999))},
        {"f.dcm": segmentation((1, 2, 9))},
    ),
    ct("convert it: dcm2niix", **{str(k): dicom(k, about="ORIGINAL\\PRIMARY\\M\\MOSAIC") for k in (1, 2, 3)}),
    ct(
        "dcmtk's `dcmconv +te` writes it plainly",
        **{"1": dicom(1).replace(b"\x14\x001.2.840.10008.1.2.1\0", b"\x16\x001.2.840.10008.1.2.1.99")},
    ),
    ct("segimage2itkimage", **{str(k): packed(dicom(k, bits=1, pixels=FRAGMENTS)) for k in (1, 2, 3)}),
    ct("bits, which are not read; write 8, 16 or 32", **{str(k): dicom(k, bits=4) for k in (1, 2, 3)}),
    row("info a.dcm", "GDCM finds no images in it; give a directory or a file of slices", "info ct", {**SLICES, "a.dcm": "text"}),
    ct("there is no time step 5", "info ct --time-step 5", "info ct"),
    # formats that are not supported, and those of solvers
    row("info a.nek5000", "save it as .vtu in ParaView", "info m.vtu", {"a.nek5000": "nothing"}),
    row("info a.vol", "convert it to .vtu with meshio", "info m.vtu", {"a.vol": "mesh3d\ndimension\n3\n"}),
    row("info a.cdb", "convert it to .vtu with meshio", "info m.vtu", {"a.cdb": "*HEADING\n*NODE\n"}),
    row("info a.odb", "export Exodus, EnSight or .vtu", "info m.vtu", {"a.odb": "nothing"}),
    row("info a.plt", "write text, CGNS or .vtu", "info m.vtu", {"a.plt": "#!TDV112"}),
    row("info a.mfem", "have MFEM write .vtu", "info m.vtu", {"a.mfem": "MFEM mesh v1.0\n\ndimension\n3\n"}),
    row("info a.inp", "`git lfs pull` brings the file itself", None, {"a.inp": LFS_POINTER}, {"a.inp": UCD}),
    cut("a.inp", UCD, len(UCD) // 2, "write it again"),
    row("info a.inp", "it does not begin as a file of AVS UCD does; check what it is", None, {"a.inp": "SOL 101\n"}, {"a.inp": UCD}),
    row("info a.neu", "as a file of GAMBIT does; check what it is", "info m.vtu", {"a.neu": "25 0 0 1\nPATRAN\n"}),
    row("info a.cas", "export CGNS or EnSight", "info m.vtu", {"a.cas": "(2 3)\n(10 (0 1 ffffffff 0))\n"}),
    row(
        "info a.dcm",
        "give a directory or a file of slices",
        "info ct",
        {**SLICES, "a.dcm": bytes(128) + b"DICM" + b"?" * 40},
    ),
    row("info a.ex2.gz", "unpack it with gunzip", "info a.ex2", {"a.ex2.gz": gzip.compress(HDF5)}, {"a.ex2": EXODUS}),
    row(
        "info a.xdmf",
        "time_step all shows them as a film".replace("time_step", "--time-step"),
        "render a.xdmf -o a%d.png --size 16x16 --time-step all",
        {"a.xdmf": TIMES},
    ),
    wrong_xdmf(
        XDMF.replace(
            item("1 2 3 4"),
            '<DataItem ItemType="Function" Function="$0 + $0" Dimensions="4">' + item("1 2 3 4") + "</DataItem>",
        ),
        "have the program that made it write them",
    ),
    wrong_xdmf(XDMF.replace('"Tetrahedron"', '"Polyline" NodesPerElement="0"'), "nodes each; write it again"),
    wrong_xdmf(xdmf(xdmf_grid(origin="0 0")), "is not of three numbers; write it again", GRID),
    row(
        "info a.xyz --q a.q",
        "it is truncated or of another kind (function, OVERFLOW)",
        None,
        {"a.xyz": BINARY, "a.q": BINARY[:12] + bytes(40)},
        {"a.q": BINARY[:12] + bytes(4 * 44)},
    ),
    row(
        "info case",
        "write it again",
        None,
        {
            **FOAM,
            **{f"case/constant/polyMesh/{n}": foam("x", n, foam_list([])) for n in ("faces", "owner", "neighbour")},
        },
        FOAM,
    ),
]
