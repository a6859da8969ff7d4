# SPDX-License-Identifier: BSD-3-Clause
"""Small files of other programs' formats, for the commands of the guide: formats that `tessera generate` does not write.

All meshes are [0, n]^3 divided into cubes, with a field that is the distance from a corner.
"""

import gzip
import struct
from pathlib import Path

SIDES = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (3, 7, 6, 2), (0, 4, 7, 3), (1, 2, 6, 5))


class Cubes:
    def __init__(self, n):
        self.n = n
        self.points = [(i, j, k) for k in range(n + 1) for j in range(n + 1) for i in range(n + 1)]
        self.cells = []
        for k in range(n):
            for j in range(n):
                for i in range(n):
                    low = [self.at(i, j, k), self.at(i + 1, j, k), self.at(i + 1, j + 1, k), self.at(i, j + 1, k)]
                    self.cells.append(low + [point + (n + 1) ** 2 for point in low])

    def at(self, i, j, k):
        return i + (self.n + 1) * (j + (self.n + 1) * k)

    def field(self):
        return [(x * x + y * y + z * z) ** 0.5 for x, y, z in self.points]


def foam_case(folder: Path, cubes: Cubes):
    """An OpenFOAM case of two times with a pressure in its cells."""
    faces = {}  # by corners: in its owner's order, owner, neighbour
    for number, cell in enumerate(cubes.cells):
        for side in SIDES:
            corners = [cell[k] for k in side]
            faces.setdefault(tuple(sorted(corners)), [corners, number, -1])[2] = number
    inner = sorted((f for f in faces.values() if f[1] != f[2]), key=lambda f: f[1:])
    outer = [f for f in faces.values() if f[1] == f[2]]

    def write(name, kind, text):
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f'FoamFile\n{{\n version 2.0;\n format ascii;\n class {kind};\n object {path.name};\n}}\n{text}\n')

    def listed(values):
        return f"{len(values)}\n(\n" + "\n".join(values) + "\n)"

    write("system/controlDict", "dictionary", "application icoFoam;\nstartTime 0;\nendTime 1;\n")
    write("constant/polyMesh/points", "vectorField", listed(["({} {} {})".format(*p) for p in cubes.points]))
    write("constant/polyMesh/faces", "faceList", listed(["4({} {} {} {})".format(*f[0]) for f in inner + outer]))
    write("constant/polyMesh/owner", "labelList", listed([str(f[1]) for f in inner + outer]))
    write("constant/polyMesh/neighbour", "labelList", listed([str(f[2]) for f in inner]))
    write("constant/polyMesh/boundary", "polyBoundaryMesh",
          f"1\n(\nwalls {{ type wall; nFaces {len(outer)}; startFace {len(inner)}; }}\n)")
    for time in (0, 1):
        write(f"{time}/p", "volScalarField", "dimensions [0 2 -2 0 0 0 0];\ninternalField nonuniform List<scalar>\n"
              + listed([str(sum(cubes.points[c[0]]) + time) for c in cubes.cells])
              + ";\nboundaryField { walls { type zeroGradient; } }")


def gmsh_mesh(path: Path, cubes: Cubes):
    """MSH 2.2 as text: a physical volume and a view on nodes."""
    nodes = [f"{v + 1} {x} {y} {z}" for v, (x, y, z) in enumerate(cubes.points)]
    cells = [f"{c + 1} 5 2 1 1 " + " ".join(str(p + 1) for p in cell) for c, cell in enumerate(cubes.cells)]
    values = [f"{v + 1} {value}" for v, value in enumerate(cubes.field())]
    path.write_text("\n".join(
        ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "1", '3 1 "body"', "$EndPhysicalNames", "$Nodes",
         str(len(nodes)), *nodes, "$EndNodes", "$Elements", str(len(cells)), *cells, "$EndElements", "$NodeData", "1",
         '"temperature"', "1", "0", "3", "0", "1", str(len(values)), *values, "$EndNodeData", ""]))


def stl_surface(path: Path, cubes: Cubes):
    """The cube's boundary as text."""
    corners = [(x * cubes.n, y * cubes.n, z * cubes.n) for x, y, z in
               ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))]
    lines = ["solid cube"]
    for a, b, c, d in SIDES:
        for triangle in ((a, b, c), (a, c, d)):
            lines += ["facet normal 0 0 0", "outer loop"]
            lines += ["vertex {} {} {}".format(*corners[k]) for k in triangle] + ["endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid cube", ""]))


class NetCDF:
    """A file of NetCDF's classic format; a variable along `time` has its records last."""

    KINDS = {"c": (2, "s", 1), "i": (4, "i", 4), "f": (5, "f", 4), "d": (6, "d", 8)}

    def __init__(self, dimensions, records):
        self.dimensions, self.records, self.variables = dimensions, records, []

    def add(self, name, kind, over, values, attributes=None):
        """`values` in order, one record after the other; text as bytes of the full length."""
        self.variables.append((name, kind, over.split(), values, attributes or {}))

    @staticmethod
    def padded(data):
        return data + b"\0" * (-len(data) % 4)

    def name(self, text):
        return struct.pack(">i", len(text)) + self.padded(text.encode())

    def attributes(self, given):
        out = struct.pack(">2i", 12, len(given)) if given else struct.pack(">2i", 0, 0)
        for name, (kind, value) in given.items():
            count = len(value) if kind == "c" else 1
            out += self.name(name) + struct.pack(">2i", self.KINDS[kind][0], count) + self.padded(self.stored(kind, value))
        return out

    def stored(self, kind, values):
        if kind == "c":
            return values.encode() if isinstance(values, str) else values
        return struct.pack(f">{len(values)}{self.KINDS[kind][1]}", *values)

    def write(self, path: Path, attributes):
        names = list(self.dimensions)
        head = b"CDF\1" + struct.pack(">i", self.records) + struct.pack(">2i", 10, len(names))
        for name in names:
            head += self.name(name) + struct.pack(">i", self.dimensions[name])
        head += self.attributes(attributes)
        fixed = [v for v in self.variables if v[2][0] != "time_step"]
        moving = [v for v in self.variables if v[2][0] == "time_step"]

        def part(variable):  # bytes per record, or in total
            count = 1
            for name in variable[2]:
                count *= max(1, self.dimensions[name])
            return count * self.KINDS[variable[1]][2]

        entries, sizes = [], {}
        for variable in fixed + moving:
            name, kind, over, _, given = variable
            size = sizes[name] = part(variable) + -part(variable) % 4
            entries.append((name, self.name(name) + struct.pack(f">{1 + len(over)}i", len(over), *map(names.index, over))
                            + self.attributes(given) + struct.pack(">2i", self.KINDS[kind][0], size)))
        begin = len(head) + 8 + sum(len(entry) + 4 for _, entry in entries)
        head += struct.pack(">2i", 11, len(entries))
        for name, entry in entries:
            head += entry + struct.pack(">i", begin)
            begin += sizes[name]
        data = b"".join(self.padded(self.stored(v[1], v[3])) for v in fixed)
        for record in range(self.records):
            for variable in moving:
                stored, each = self.stored(variable[1], variable[3]), part(variable)
                data += self.padded(stored[record * each:(record + 1) * each])
        path.write_bytes(head + data)


def exodus_mesh(path: Path, cubes: Cubes, steps=3):
    """Exodus II: the lower half of the cubes is the block `steel`, the upper `air`; a temperature at nodes."""
    half = len(cubes.cells) // 2
    blocks = (cubes.cells[:half], cubes.cells[half:])
    file = NetCDF({"len_name": 33, "time_step": 0, "num_dim": 3, "num_nodes": len(cubes.points),
                   "num_elem": len(cubes.cells), "num_el_blk": 2, "num_el_in_blk1": half, "num_nod_per_el1": 8,
                   "num_el_in_blk2": len(cubes.cells) - half, "num_nod_per_el2": 8, "num_nod_var": 1}, steps)
    for axis, letter in enumerate("xyz"):
        file.add("coord" + letter, "d", "num_nodes", [p[axis] for p in cubes.points])
    file.add("eb_status", "i", "num_el_blk", [1, 1])
    file.add("eb_prop1", "i", "num_el_blk", [1, 2], {"name": ("c", "ID")})
    file.add("eb_names", "c", "num_el_blk len_name", b"steel".ljust(33, b"\0") + b"air".ljust(33, b"\0"))
    for number, cells in enumerate(blocks, 1):
        file.add(f"connect{number}", "i", f"num_el_in_blk{number} num_nod_per_el{number}",
                 [point + 1 for cell in cells for point in cell], {"elem_type": ("c", "HEX8")})
    file.add("name_nod_var", "c", "num_nod_var len_name", b"temperature".ljust(33, b"\0"))
    file.add("time_whole", "d", "time_step", [0.5 * k for k in range(steps)])
    file.add("vals_nod_var1", "d", "time_step num_nodes",
             [value / (1 + k) for k in range(steps) for value in cubes.field()])
    file.write(path, {"api_version": ("f", [5.1]), "version": ("f", [5.1]), "floating_point_word_size": ("i", [8]),
                      "file_size": ("i", [1]), "title": ("c", "cubes")})


def nifti_volume(path: Path, n, times=1):
    """NIfTI-1: 16-bit samples, one millimetre apart."""
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3 if times == 1 else 4, n, n, n, times, 1, 1, 1)
    struct.pack_into("<2h", header, 70, 4, 16)
    struct.pack_into("<8f", header, 76, 1, 1, 1, 1, 1, 1, 1, 1)
    struct.pack_into("<f", header, 108, 352)
    header[344:348] = b"n+1\0"
    samples = [(1 + t) * (x * x + y * y + z * z) for t in range(times) for z in range(n) for y in range(n) for x in range(n)]
    path.write_bytes(gzip.compress(bytes(header) + struct.pack(f"<{len(samples)}h", *samples)))


def dicom_series(folder: Path, n):
    """CT slices, one file each: explicit, little endian."""
    folder.mkdir()

    def element(group, number, kind, value):
        if isinstance(value, str):
            value = value.encode()
            value += (b"\0" if kind == "UI" else b" ") * (len(value) % 2)
        elif isinstance(value, int):
            value = struct.pack("<H", value)
        head = struct.pack("<2H", group, number) + kind.encode()
        if kind in ("OB", "OW"):
            return head + struct.pack("<HI", 0, len(value)) + value
        return head + struct.pack("<H", len(value)) + value

    for k in range(n):
        uid, kind = f"1.2.826.0.1.3680043.2.1143.{k + 1}", "1.2.840.10008.5.1.4.1.1.2"
        meta = (element(2, 1, "OB", b"\0\1") + element(2, 2, "UI", kind) + element(2, 3, "UI", uid)
                + element(2, 0x10, "UI", "1.2.840.10008.1.2.1"))
        samples = [int(1000 - 60 * ((x - n / 2) ** 2 + (y - n / 2) ** 2 + (k - n / 2) ** 2) ** 0.5) for y in range(n) for x in range(n)]
        body = [(8, 0x16, "UI", kind), (8, 0x18, "UI", uid), (8, 0x60, "CS", "CT"), (0x20, 0xD, "UI", "1.2.826.0.1.3680043.2.1143.100"),
                (0x20, 0xE, "UI", "1.2.826.0.1.3680043.2.1143.101"), (0x20, 0x13, "IS", str(k + 1)), (0x20, 0x32, "DS", f"0\\0\\{k}"),
                (0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0"), (0x28, 2, "US", 1), (0x28, 4, "CS", "MONOCHROME2"), (0x28, 0x10, "US", n),
                (0x28, 0x11, "US", n), (0x28, 0x30, "DS", "1\\1"), (0x28, 0x100, "US", 16), (0x28, 0x101, "US", 16),
                (0x28, 0x102, "US", 15), (0x28, 0x103, "US", 1), (0x28, 0x1052, "DS", "-1000"), (0x28, 0x1053, "DS", "1"),
                (0x7FE0, 0x10, "OW", struct.pack(f"<{n * n}h", *samples))]
        data = element(2, 0, "UL", struct.pack("<I", len(meta))) + meta + b"".join(element(*words) for words in body)
        (folder / f"slice{k:03}.dcm").write_bytes(bytes(128) + b"DICM" + data)


def vector_volume(path: Path):
    """A .vti of vectors."""
    vectors = " ".join(f"{x} {y} {z}" for z in range(4) for y in range(4) for x in range(4))
    path.write_text(
        '<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian"><ImageData WholeExtent="0 3 0 3 0 3" '
        'Origin="0 0 0" Spacing="1 1 1"><Piece Extent="0 3 0 3 0 3"><PointData><DataArray type="Float32" '
        f'Name="Velocity" NumberOfComponents="3" format="ascii">{vectors}</DataArray></PointData></Piece></ImageData>'
        "</VTKFile>")
