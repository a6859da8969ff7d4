# SPDX-License-Identifier: BSD-3-Clause
"""Rows of advice about files that are not supported or are incomplete."""

import gzip
import struct

from advice_files import LEGACY, STL, VTM, VTP, unstructured
from advice_foreign import ENSIGHT, TET
from advice_library_files import UCD
from advice_row import cut, damaged, row

FREESURFER = struct.pack(">6i", 1, 4, 3, 2, 1, 3) + bytes(356)


def not_read(name, advice, content="nothing"):
    return row(f"info {name}", advice, "info m.vtu", {name: content})


CUBE = "0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1"
FOAM = 'FoamFile\n{\n version 2.0;\n format ascii;\n class %s;\n object %s;\n}\n'
CASE = {
    "of/system/controlDict": FOAM % ("dictionary", "controlDict") + "startFrom latestTime;\n",
    "of/constant/polyMesh/points": FOAM % ("vectorField", "points")
    + "4\n(\n(0 0 0)\n(1 0 0)\n(0 1 0)\n(0 0 1)\n)\n",
    "of/constant/polyMesh/faces": FOAM % ("faceList", "faces")
    + "4\n(\n3(0 2 1)\n3(0 1 3)\n3(1 2 3)\n3(0 3 2)\n)\n",
    "of/constant/polyMesh/owner": FOAM % ("labelList", "owner") + "4\n(\n0\n0\n0\n0\n)\n",
    "of/constant/polyMesh/neighbour": FOAM % ("labelList", "neighbour") + "0\n(\n)\n",
    "of/constant/polyMesh/boundary": FOAM % ("polyBoundaryMesh", "boundary")
    + "1\n(\n all\n {\n  type wall;\n  nFaces 4;\n  startFace 0;\n }\n)\n",
    "of/a.OpenFOAM": "",
}
P = (
    FOAM % ("volScalarField", "p")
    + "dimensions [0 0 0 0 0 0 0];\ninternalField nonuniform List<scalar> 1(%s);\n"
    + "boundaryField\n{\n all\n {\n  type zeroGradient;\n }\n}\n"
)
FLUENT = '(0 "made")\n(2 {})\n(10 (0 1 4 0 {}))\n(12 (0 1 1 0))\n(12 (2 1 1 1{}))\n'


def without(files, name):
    return {other: text for other, text in files.items() if other != name}


ROWS = [
    # known, but not supported
    not_read("a.k", "export Nastran .bdf from LS-PrePost", "$ made\n*KEYWORD\n*NODE\n"),
    not_read("d3plot", "save it as .vtm"),
    not_read("a.inp", "convert it to .vtu with meshio", "*Part, name=a\n*Node\n1, 0, 0, 0\n"),
    not_read("a.frd", "convert it to .vtu with ccx2paraview"),
    not_read("a.op2", "by pyNastran and meshio"),
    not_read("a.h3d", "export Nastran .bdf or EnSight"),
    not_read("a.ccm", "export EnSight or CGNS"),
    not_read("a.res", "export CGNS or EnSight"),
    not_read("a.mphtxt", "export Nastran .nas or .vtu from COMSOL"),
    not_read("a.h5m", "convert it to .vtk with mbconvert"),
    not_read("a.ugrid", "convert it to .vtu with meshio"),
    not_read("a.f3grid", "convert it to .vtu with meshio"),
    not_read("a.mdpa", "convert it to .vtu with meshio"),
    not_read("a.silo", "save it as .vtm in ParaView or VisIt"),
    not_read("a", "mesh it: gmsh -3 FILE -o mesh.msh", "ISO-10303-21;\nHEADER;\n"),
    not_read("a.igs", "mesh it: gmsh -3 FILE -o mesh.msh"),
    not_read("a.brep", "mesh it: gmsh -3 FILE -o mesh.msh", "DBRep_DrawableShape\n"),
    not_read("a.geo", "mesh it: gmsh -3 FILE -o mesh.msh", "Point(1) = {0, 0, 0};\n"),
    not_read("a.obj", "convert it to .stl or .ply with meshio or MeshLab", "v 0 0 0\n"),
    not_read("a", "convert it to .stl or .ply with meshio or MeshLab", "OFF\n3 1 0\n"),
    not_read("a", "save it as .stl or .ply in Blender or MeshLab", b"glTF\2\0\0\0"),
    not_read("a.fbx", "save it as .stl or .ply in Blender"),
    not_read("a", "save it as .vti in ParaView", b" BDV\0\0\0\0\1"),
    not_read("a.nvdb", "save it as .vti from OpenVDB by ParaView", b"NanoVDB0"),
    not_read("a.bgeo", "save volumes as .vdb"),
    not_read("a.bp", "save it as .vtm"),
    not_read("a.grib2", "cdo -f nc copy FILE out.nc", b"GRIB\0\0\0\2\0"),
    not_read("a", "convert it to HDF5 with h4toh5", b"\x0e\x03\x13\x01\0"),
    not_read("a", "save it as .nrrd by astropy and pynrrd", "SIMPLE  =                    T"),
    not_read("a.mgz", "mri_convert FILE out.nii.gz"),
    not_read("a.mgh", "mri_convert FILE out.nii.gz", FREESURFER),
    not_read("a.mgz", "mri_convert FILE out.nii.gz", gzip.compress(FREESURFER)),
    not_read("a.gipl", "c3d FILE -o out.nii.gz"),
    not_read("a.brik", "3dAFNItoNIFTI FILE"),
    not_read("a", "describe it: --dims, --type and --skip 1024", bytes(208) + b"MAP " + bytes(812)),
    not_read("a", "save it as .nrrd in 3D Slicer", "# AmiraMesh BINARY-LITTLE-ENDIAN 2.1\n"),
    not_read("a", "save it as .nrrd in Fiji", b"II*\0\x08\0\0\0"),
    not_read("a.czi", "save it as .nrrd in Fiji"),
    not_read("a", "write it as .raw by tofile", b"\x93NUMPY\1\0"),
    not_read("a.mat", "write it as .raw by fwrite"),
    not_read("a.zarr", "write it as .nrrd by pynrrd"),
    # missing files
    row("info m.case", "it names m.geo, and there is no such file; put it there", None, without(ENSIGHT, "m.geo"),
        ENSIGHT),
    row("info m.case", "it names m.geo, which is not a regular file; put one there", None, {**ENSIGHT, "m.geo": ("link", "/dev/null")},
        ENSIGHT),
    row("info m.case --field f", "f of that time step is in m.f, and there is no such file; put it there", None,
        without(ENSIGHT, "m.f"), ENSIGHT),
    row("info m.case --field f", "which ends inside part 1; copy it there again", None,
        {**ENSIGHT, "m.f": ENSIGHT["m.f"][:-13]}, ENSIGHT),
    row("info of", "and there is no such file; put it there", None, without(CASE, "of/constant/polyMesh/faces"), CASE),
    row("info a.vtm", "q.vtu: there is no such file, which a.vtm lists; put it there", None, {"a.vtm": VTM, "p.vtu": TET}, {"q.vtu": TET}),
    # files of another kind than needed
    row("info a.vtm", "or one of the files itself", "info p.vtp",
        {"a.vtm": VTM.replace(".vtu", ".vtp"), "p.vtp": VTP, "q.vtp": VTP}),
    row("info a.msh", "has no volume to render; give one of 3", "info m.vtu", {"a.msh": FLUENT.format(2, 2, "")}),
    row("info a.cas", "does not state what they are; export CGNS or EnSight", "info m.vtu",
        {"a.cas": FLUENT.format(3, 3, "")}),
    row("info a.vtu", "write them in VTK's order", None,
        {"a.vtu": unstructured(points=CUBE, cells="0 1 2 3 4 5 6 7", offsets="8", types="12")},
        {"a.vtu": unstructured(points=CUBE, cells="0 1 3 2 4 5 7 6", offsets="8", types="12")}),
    # VTK's errors
    row("info m.case", "it needs m.mea, and there is no such file; put it there", None,
        {**ENSIGHT, "m.case": ENSIGHT["m.case"].replace("model: m.geo", "model: m.geo\nmeasured: m.mea")}, ENSIGHT),
    row("info of", "write the case in binary (foamFormatConvert)", None, {**CASE, "of/0/p": P % "nan"},
        {"of/0/p": P % "1"}),
    row("info of", "write the case again with foamFormatConvert", None,
        {**CASE, "of/constant/polyMesh/faces": FOAM % ("faceCompactList", "faces")
         + "5\n(\n0\n3\n6\n9\n12\n)\n12\n(\n0\n2\n1\n0\n1\n3\n1\n2\n3\n0\n3\n2\n)\n"}, CASE),
    cut("a.stl", STL, len(STL) - 40, "write it again"),
    damaged("a.vtk", LEGACY, "SCALARS f float 1", "SCALARS f quaternion 1", "correct it, or have the file written again"),
    damaged("a.inp", UCD, " tet ", " ball ", "or have it written in another format"),
]
