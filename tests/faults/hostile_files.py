#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Small files of many formats, damaged, or redirected to things that are not data: the program reads or refuses each.

    tests/faults/hostile_files.py --tessera PROGRAM [--runs 1000] [--seed 1] [--jobs 2]

The files are made here, 200 bytes to 20 KB each. Most runs damage one, in the ways of damaged_files.py. In the others a name
that a file contains (of a piece, a step, samples, an EnSight mesh, an include) is replaced by that of something else: a named pipe,
/dev/zero, a directory, the file itself, its directory, a missing or endless file, one of a megabyte of letters or of
control characters. `tessera info` must end with status 0, or with 2 or 3 and one line of at most 8 KB without control
characters; without a signal, in 20 s of processor time, and with at most 256 MiB above the intact file's memory. Prints
each failure, and how to reproduce it; then a summary of how runs ended. Status 1 if any fails. Standard library only.
"""
import argparse
import concurrent.futures
import os
import pathlib
import random
import re
import resource
import shutil
import struct
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from damaged_files import damage, run  # noqa: E402

POINTS = [(x, y, z) for z in range(2) for y in range(2) for x in range(2)]
TETS = [(0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7)]
SAMPLES = bytes((7 * k) % 251 for k in range(4 * 4 * 4))


def rows(items):
    return "\n".join(" ".join(map(str, item)) for item in items) + "\n"


def numbered(items, first=1, shift=0):
    return "".join(f"{k} " + " ".join(str(n + shift) for n in item) + "\n" for k, item in enumerate(items, first))


def piece(name):
    return (f'<VTKFile type="PUnstructuredGrid" version="0.1"><PUnstructuredGrid GhostLevel="0"><Piece Source="{name}"/>'
            "</PUnstructuredGrid></VTKFile>")


def texts():
    """Name -> content of files that do not refer to others."""
    scalars = "".join(f"{k % 5}\n" for k in range(8))
    vtk = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET "
    files = {
        "m.vtk": vtk + f"UNSTRUCTURED_GRID\nPOINTS 8 float\n{rows(POINTS)}CELLS 6 30\n{rows((4,) + t for t in TETS)}"
        f"CELL_TYPES 6\n{'10 ' * 6}\nPOINT_DATA 8\nSCALARS a float 1\nLOOKUP_TABLE default\n{scalars}",
        "g.vtk": vtk + "STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA 8\nSCALARS a float 1\n"
        f"LOOKUP_TABLE default\n{scalars}",
        "m.su2": f"NDIME= 3\nNELEM= 6\n{rows((10,) + t for t in TETS)}NPOIN= 8\n{rows(POINTS)}NMARK= 0\n",
        "m.mesh": f"MeshVersionFormatted 2\nDimension 3\nVertices\n8\n{rows(p + (0,) for p in POINTS)}Tetrahedra\n6\n"
        f"{rows(tuple(n + 1 for n in t) + (1,) for t in TETS)}End\n",
        "m.msh": f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n{numbered(POINTS)}$EndNodes\n$Elements\n6\n"
        + "".join(f"{k} 4 2 1 1 " + " ".join(str(n + 1) for n in t) + "\n" for k, t in enumerate(TETS, 1)) + "$EndElements\n",
        "m.inp": f"8 6 1 0 0\n{numbered(POINTS)}"
        + "".join(f"{k} 1 tet " + " ".join(str(n + 1) for n in t) + "\n" for k, t in enumerate(TETS, 1))
        + "1 1\na, b\n" + "".join(f"{k} {k % 5}\n" for k in range(1, 9)),
        "m.dat": f'TITLE = "x"\nVARIABLES = "X", "Y", "Z", "a"\nZONE N=8, E=6, F=FEPOINT, ET=TETRAHEDRON\n'
        + rows(p + (k % 5,) for k, p in enumerate(POINTS)) + rows(tuple(n + 1 for n in t) for t in TETS),
        "m.bdf": "BEGIN BULK\n" + "".join(f"GRID,{k},,{p[0]}.,{p[1]}.,{p[2]}.\n" for k, p in enumerate(POINTS, 1))
        + "".join(f"CTETRA,{k},1," + ",".join(str(n + 1) for n in t) + "\n" for k, t in enumerate(TETS, 1)) + "ENDDATA\n",
        "s.ply": f"ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n",
        "s.stl": "solid x\n" + "".join(
            "facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {a} {b} {c}\n" for a, b, c in f) + "endloop\nendfacet\n"
            for f in (((0, 0, 0), (0, 1, 0), (1, 0, 0)), ((0, 0, 0), (1, 0, 0), (0, 0, 1)),
                      ((0, 0, 0), (0, 0, 1), (0, 1, 0)), ((1, 0, 0), (0, 1, 0), (0, 0, 1)))) + "endsolid x\n",
        "x.xdmf": '<Xdmf Version="3.0"><Domain><Grid><Topology TopologyType="Tetrahedron" NumberOfElements="6"><DataItem '
        f'Dimensions="6 4" NumberType="Int" Format="XML">{rows(TETS)}</DataItem></Topology><Geometry GeometryType="XYZ">'
        f'<DataItem Dimensions="8 3" Format="XML">{rows(POINTS)}</DataItem></Geometry><Attribute Name="a" Center="Node">'
        f'<DataItem Dimensions="8" Format="XML">{scalars}</DataItem></Attribute></Grid></Domain></Xdmf>',
        "v.vti": '<VTKFile type="ImageData" version="0.1"><ImageData WholeExtent="0 1 0 1 0 1" Origin="0 0 0" Spacing="1 1 1">'
        '<Piece Extent="0 1 0 1 0 1"><PointData Scalars="a"><DataArray type="Float32" Name="a" format="ascii">'
        f"{scalars}</DataArray></PointData></Piece></ImageData></VTKFile>",
    }
    files = {name: text.encode() for name, text in files.items()}
    files["m.tets"] = (struct.pack("<qq", 8, 6) + b"".join(struct.pack("<3f", *p) for p in POINTS)
                       + struct.pack("<8f", *range(8)) + b"".join(struct.pack("<4i", *t) for t in TETS))
    header = b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\n"
    meta = b"ObjectType = Image\nNDims = 3\nDimSize = 4 4 4\nElementType = MET_UCHAR\nElementDataFile = "
    files["v.nrrd"], files["v.mha"] = header + b"\n" + SAMPLES, meta + b"LOCAL\n" + SAMPLES
    nifti = bytearray(352)
    struct.pack_into("<i", nifti, 0, 348)
    struct.pack_into("<8h", nifti, 40, 3, 4, 4, 4, 1, 1, 1, 1)
    struct.pack_into("<hh", nifti, 70, 2, 8)
    struct.pack_into("<8f", nifti, 76, *[1.0] * 8)
    struct.pack_into("<f", nifti, 108, 352.0)
    nifti[344:348] = b"n+1\0"
    files["v.nii"] = bytes(nifti) + SAMPLES
    return files


def write_cases(folder):
    """Files that name others: name -> a list of (file, the name that it contains)."""
    (folder / "tet.node").write_text(f"8 3 0 0\n{numbered(POINTS)}")
    (folder / "tet.ele").write_text("6 4 0\n" + numbered(TETS, shift=1))
    (folder / "d.raw").write_bytes(SAMPLES)
    (folder / "d.nhdr").write_text("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\ndata file: d.raw\n")
    (folder / "a.nhdr").write_text("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: ascii\ndata file: d.txt\n")
    (folder / "d.txt").write_text(" ".join(str(n) for n in SAMPLES))
    (folder / "d.mhd").write_text(
        "ObjectType = Image\nNDims = 3\nDimSize = 4 4 4\nElementType = MET_UCHAR\nElementDataFile = d.raw\n")
    (folder / "p.pvtu").write_text(piece("m.vtu"))
    (folder / "l.vtm").write_text('<VTKFile type="vtkMultiBlockDataSet" version="1.0"><vtkMultiBlockDataSet><DataSet index="0" '
                                  'name="b" file="m.vtu"/></vtkMultiBlockDataSet></VTKFile>')
    (folder / "t.pvd").write_text('<VTKFile type="Collection" version="0.1"><Collection><DataSet timestep="0" file="m.vtu"/>'
                                  '<DataSet timestep="1" file="m.vtu"/></Collection></VTKFile>')
    (folder / "t.series").write_text('{"file-series-version":"1.0","files":[{"name":"m.vtu","time":0},{"name":"m.vtu","time":1}]}')
    (folder / "p.pvti").write_text(
        '<VTKFile type="PImageData" version="0.1"><PImageData WholeExtent="0 1 0 1 0 1" GhostLevel="0" Origin="0 0 0" '
        'Spacing="1 1 1"><PPointData><PDataArray type="Float32" Name="a"/></PPointData><Piece Extent="0 1 0 1 0 1" '
        'Source="v.vti"/></PImageData></VTKFile>')
    (folder / "e.case").write_text("FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: e.geo\nVARIABLE\nscalar per node: a e.scl\n")
    (folder / "e.geo").write_text("x\ny\nnode id assign\nelement id assign\npart\n1\nz\ncoordinates\n8\n"
                                  + "".join(f"{p[a]:.5e}\n" for a in range(3) for p in POINTS)
                                  + "tetra4\n6\n" + rows(tuple(n + 1 for n in t) for t in TETS))
    (folder / "e.scl").write_text("x\npart\n1\ncoordinates\n" + "".join(f"{k % 5:.5e}\n" for k in range(8)))
    (folder / "i.bdf").write_text("BEGIN BULK\nINCLUDE 'm.inc'\nENDDATA\n")
    (folder / "m.inc").write_bytes((folder / "m.bdf").read_bytes().replace(b"BEGIN BULK\n", b"").replace(b"ENDDATA\n", b""))
    (folder / "b.xdmf").write_text(
        (folder / "x.xdmf").read_text().replace('Dimensions="8" Format="XML">', 'Dimensions="8" NumberType="Float" Precision="8" '
                                                'Format="Binary" Endian="Little">').replace(
            "".join(f"{k % 5}\n" for k in range(8)), "x.bin"))
    (folder / "x.bin").write_bytes(struct.pack("<8d", *range(8)))
    poly = folder / "case" / "constant" / "polyMesh"
    poly.mkdir(parents=True)
    head = "FoamFile\n{{\n version 2.0;\n format ascii;\n class {};\n object {};\n}}\n"
    corners = [(0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5), (0, 2, 3, 1), (4, 5, 7, 6)]
    (poly / "points").write_text(head.format("vectorField", "points") + "8\n(\n" + "".join(
        f"({p[0]} {p[1]} {p[2]})\n" for p in POINTS) + ")\n")
    (poly / "faces").write_text(head.format("faceList", "faces") + "6\n(\n" + "".join(
        "4(" + " ".join(map(str, f)) + ")\n" for f in corners) + ")\n")
    (poly / "owner").write_text(head.format("labelList", "owner") + "6\n(\n" + "0\n" * 6 + ")\n")
    (poly / "neighbour").write_text(head.format("labelList", "neighbour") + "0\n(\n)\n")
    (poly / "boundary").write_text(head.format("polyBoundaryMesh", "boundary") +
                                   "1\n(\nw { type wall; nFaces 6; startFace 0; }\n)\n")
    (folder / "case" / "system").mkdir()
    (folder / "case" / "system" / "controlDict").write_text(head.format("dictionary", "controlDict") + "startTime 0;\n")
    (folder / "case" / "0").mkdir()
    (folder / "case" / "0" / "p").write_text(head.format("volScalarField", "p") +
                                             "dimensions [0 0 0 0 0 0 0];\ninternalField uniform 1;\nboundaryField {}\n")
    plot = folder / "plt"
    (plot / "Level_0").mkdir(parents=True)
    box = "((0,0,0) (1,1,1) (0,0,0))"
    (plot / "Header").write_text(f"HyperCLaw-V1.1\n1\na\n3\n0\n0\n0 0 0\n2 2 2\n\n{box}\n0\n1 1 1\n0\n0\n0 1 0\n0\n0 2\n0 2\n0 2\n"
                                 "Level_0/Cell\n")
    (plot / "Level_0" / "Cell_H").write_text(f"1\n0\n1\n0\n(1 0\n{box}\n)\n1\nFabOnDisk: Cell_D 0\n\n1,1\n0,\n\n1,1\n7,\n\n")
    (plot / "Level_0" / "Cell_D").write_bytes(
        f"FAB ((8, (64 11 52 0 1 12 0 1023)),(8, (8 7 6 5 4 3 2 1))){box} 1\n".encode() + struct.pack("<8d", *range(8)))
    return [("p.pvtu", "p.pvtu", "m.vtu"), ("l.vtm", "l.vtm", "m.vtu"), ("t.pvd", "t.pvd", "m.vtu"),
            ("t.series", "t.series", "m.vtu"), ("p.pvti", "p.pvti", "v.vti"), ("d.nhdr", "d.nhdr", "d.raw"),
            ("a.nhdr", "a.nhdr", "d.txt"), ("d.mhd", "d.mhd", "d.raw"), ("e.case", "e.case", "e.geo"),
            ("e.case", "e.case", "e.scl"), ("i.bdf", "i.bdf", "m.inc"), ("b.xdmf", "b.xdmf", "x.bin"),
            ("plt", "plt/Level_0/Cell_H", "Cell_D")]


# By their names alone: the file passed to the program, and the files that it searches for next to it.
BY_NAME = [("tet.ele", "tet.node"), ("tet.node", "tet.ele"), ("plt", "plt/Level_0/Cell_H"), ("plt", "plt/Header"),
           ("case", "case/constant/polyMesh/points"), ("case", "case/constant/polyMesh/faces"), ("case", "case/0/p"),
           ("m.vtu", "m.vtu"), ("v.nrrd", "v.nrrd"), ("m.su2", "m.su2"), ("s.stl", "s.stl"), ("m.msh", "m.msh")]


def targets(folder, itself):
    """The targets to which names are redirected."""
    os.mkfifo(folder / "pipe")
    (folder / "empty").touch()
    (folder / "gone-link").symlink_to("nowhere")
    (folder / "loop").symlink_to("loop")
    return ["pipe", str(folder / "pipe"), "/dev/zero", "/dev/stdin", "/proc/self/mem", ".", "/", itself, "nowhere", "empty", "gone-link",
            "loop", "../" * 40 + "etc/passwd", "y" * 1000000, "a" * 300, "\x1b[2J\x9b\u202e", "%s%n", "", "x y", "C:\\m.vtu"]


def problems_of(result, limit):
    status, err, too_long, memory = result
    found = []
    if status not in (0, 2, 3):
        found.append(f"status {status}")
    if too_long:
        found.append(too_long)
    if memory > limit:
        found.append(f"{memory:.0f} MiB")
    if status != 0 and (err.count(b"\n") != 1 or not err.startswith(b"tessera: ") or len(err) > 8192):
        found.append(f"{len(err)} bytes on stderr: {err[:200]!r}")
    if any(ord(c) < 0x20 and c != "\n" or 0x7f <= ord(c) < 0xa0 or c in "\u200e\u200f\u061c" or "\u202a" <= c <= "\u202e"
           for c in err.decode(errors="replace")):
        found.append(f"control characters on stderr: {err[:200]!r}")
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tessera", type=pathlib.Path, required=True)
    parser.add_argument("--runs", type=int, default=1000, help="with damaged files; those with names of others come on top")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    args = parser.parse_args()
    program = str(args.tessera.resolve())
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with tempfile.TemporaryDirectory() as root_name:
        root = pathlib.Path(root_name)
        whole = root / "whole"
        whole.mkdir()
        for name, content in texts().items():
            (whole / name).write_bytes(content)
        subprocess.run([program, "convert", whole / "m.tets", whole / "m.vtu", "--quiet"], check=True)
        named = write_cases(whole)
        memory, unread = {}, []
        for given in sorted({p.name for p in whole.iterdir() if p.is_file()} | {"plt", "case"}):
            status, err, _, used = run([program, "info", given], whole)
            if status == 0:
                memory[given] = used
            elif given in texts() or given in {n[0] for n in named} | {n[0] for n in BY_NAME}:
                unread.append((given, err.decode(errors="replace").strip()))
        trials = []

        def damaged_trial(number):
            rng = random.Random(args.seed * 1_000_003 + number)
            given = rng.choice(sorted(memory))
            folder = root / f"damaged-{number}"
            shutil.copytree(whole, folder)
            file = folder / given
            if file.is_dir():
                file = rng.choice(sorted(p for p in file.rglob("*") if p.is_file()))
            way, content = damage(file.read_bytes(), rng)
            file.write_bytes(content)
            return f"{given}: {way}", given, folder

        def named_trial(number, given, holder, name, which):
            folder = root / f"named-{number}"
            shutil.copytree(whole, folder)
            target = targets(folder, holder)[which]
            if name is not None:
                text = (folder / holder).read_text()
                (folder / holder).write_bytes(re.sub(re.escape(name), lambda _: target, text).encode("utf-8", "surrogateescape"))
            else:
                (folder / holder).unlink()
                if "/" in target or len(target) > 200 or not (folder / target).exists():
                    target = "/dev/zero" if which % 2 else str(folder / "pipe")
                (folder / holder).symlink_to(target if target.startswith("/") else folder / target)
            return f"{given}: {name or holder} -> {target[:60]!r}", given, folder

        for number in range(args.runs):
            trials.append((damaged_trial, (number,)))
        for given, holder, name in named:
            for which in range(20):
                trials.append((named_trial, (len(trials), given, holder, name, which)))
        for given, holder in BY_NAME:
            for which in range(4):
                trials.append((named_trial, (len(trials), given, holder, None, which)))

        def one(trial):
            words, given, folder = trial[0](*trial[1])
            result = run([program, "info", given], folder)
            shutil.rmtree(folder)
            return words, result[0], problems_of(result, memory.get(given, 64) + 256)

        count, failed = {}, len(unread)
        for given, err in unread:
            print(f"{given} is not read as it is: {err}")
        with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
            for number, (words, status, problems) in enumerate(pool.map(one, trials)):
                kind = "damaged" if number < args.runs else "redirected"
                count[kind, status] = count.get((kind, status), 0) + 1
                if problems:
                    failed += 1
                    print(f"run {number} of seed {args.seed}, {words}: {'; '.join(problems)}", flush=True)
        for kind in ("damaged", "redirected"):
            print(kind, ", ".join(f"status {s}: {n}" for (k, s), n in sorted(count.items()) if k == kind))
        print(f"{len(trials)} runs over {len(memory)} files, {failed} faults")
        return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
