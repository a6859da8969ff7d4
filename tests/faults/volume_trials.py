#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Volume files as written by other programs, and damaged ones: does `tessera` read them correctly, and refuse the rest?

    volume_trials.py --tessera PROGRAM [--only WORDS] [--keep FOLDER] [--mpi RANKS]

Files come from VTK's own writers (.vti .vtk .mha .nii) and from this script's (NRRD, NIfTI, MetaImage in all their types,
encodings and geometries). For each valid one: `info --json` reports the range of values, the blanks and the geometry that were
written; its image equals that of the same numbers in a plain double .nrrd, with sharp and smooth transfer functions,
orthographic, perspective and from inside; `--verify` passes. For each damaged one, and for every valid one truncated: status 2,
one line on stderr, nothing written; the same under mpirun.

Prints a line per fault and a count; status 1 if anything was wrong. Needs NumPy and VTK's Python package.
"""
import argparse
import bz2
import gzip
import json
import os
import struct
import subprocess
import sys
import tempfile
import zlib
from pathlib import Path

import numpy as np

try:
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk
except ImportError:
    sys.exit("volume_trials: VTK's Python package is missing (python3-vtk9)")

SHAPE = (7, 6, 5)  # k, j, i
EYE = np.eye(3)
TURN = np.array([[0.8, -0.6, 0.0], [0.6, 0.8, 0.0], [0.0, 0.0, 1.0]])  # columns are axes


def field(dtype=np.float64, components=1):
    """Smooth numbers that fit into a signed byte; no two axes or components are equal."""
    k, j, i = np.meshgrid(*(np.arange(n) for n in SHAPE), indexing="ij")
    parts = [60 * np.sin(0.9 * i + 0.4 * j * k + c) + 10 * (k - j) + c for c in range(components)]
    values = np.stack(parts, axis=-1) if components > 1 else parts[0]
    if np.dtype(dtype).kind == "u":
        values = values + 120
    return values.round().astype(dtype) if np.dtype(dtype).kind in "ui" else values.astype(dtype)


def nrrd_header(values, origin, spacing, direction, type_name, encoding="raw", extra="", components=1, endian="little"):
    n = " ".join(str(n) for n in SHAPE[::-1])
    steps = " ".join("(%.17g,%.17g,%.17g)" % tuple(direction[:, a] * spacing[a]) for a in range(3))
    sizes = f"{components} {n}" if components > 1 else n
    return (f"NRRD0004\n# a comment\ntype: {type_name}\ndimension: {4 if components > 1 else 3}\nsizes: {sizes}\n"
            f"space dimension: 3\nspace directions: {'none ' if components > 1 else ''}{steps}\n"
            f"space origin: (%.17g,%.17g,%.17g)\nencoding: {encoding}\nendian: {endian}\n{extra}\n" % tuple(origin))


class Good:
    """A file and its contents: values (k, j, i) of the chosen field, geometry of the samples."""

    def __init__(self, name, values, origin=(0, 0, 0), spacing=(1, 1, 1), direction=EYE, cell=False, words=(), files=()):
        self.name, self.values, self.cell = name, np.asarray(values, np.float64), cell
        self.origin, self.spacing, self.direction = np.asarray(origin, float), np.asarray(spacing, float), direction
        self.words, self.files = list(words), list(files)  # files: others that belong to it


class Trials:
    def __init__(self, tessera, folder, only, ranks):
        self.tessera, self.folder, self.only, self.ranks = str(tessera), folder, only, ranks
        self.good, self.bad, self.faults, self.runs = [], [], 0, 0

    def path(self, name):
        (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
        return self.folder / name

    def add(self, name, content, values, **more):
        if content is not None:
            self.path(name).write_bytes(content if isinstance(content, bytes) else content.encode())
        self.good.append(Good(name, values, **more))

    def refuse(self, name, content, words="", options=()):
        if content is not None:
            self.path(name).write_bytes(content if isinstance(content, bytes) else content.encode())
        self.bad.append((name, words, list(options)))

    def run(self, *words, ranks=0, cwd=None):
        self.runs += 1
        command = [self.tessera, *map(str, words)]
        environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
        if ranks:
            command = ["mpirun", "--oversubscribe", "-n", str(ranks)] + command
        return subprocess.run(command, capture_output=True, text=True, timeout=60, env=environment, cwd=cwd)

    def fault(self, name, what):
        self.faults += 1
        print(f"{name}: {what}", flush=True)

    # -- expectations for valid files

    def check_good(self, case):
        file = self.path(case.name)
        out = self.run("info", file, "--json", *case.words)
        if out.returncode != 0:
            return self.fault(case.name, f"info: {out.returncode} {out.stderr.strip()}")
        told = json.loads(out.stdout)
        finite = case.values[np.isfinite(case.values)]
        blank = case.values.size - finite.size
        points = [n + (1 if case.cell else 0) for n in case.values.shape[::-1]]
        wanted = {"points": points, "blank": blank, "low": finite.min(), "high": finite.max()}
        got = {"points": told["points"], "blank": told["field"]["blank"], "low": told["field"]["range"][0],
               "high": told["field"]["range"][1]}
        for key, value in wanted.items():
            if not np.allclose(got[key], value, rtol=1e-6, atol=1e-30):
                return self.fault(case.name, f"{key} is {got[key]}, not {value}")
        for key, value in (("origin", case.origin), ("spacing", case.spacing), ("direction", case.direction.T)):
            if not np.allclose(told[key], value, rtol=1e-5, atol=1e-6):
                return self.fault(case.name, f"{key} is {told[key]}, not {np.asarray(value).tolist()}")
        self.check_pictures(case, file, told, finite)

    def check_pictures(self, case, file, told, finite):
        """Compares with the same numbers in the plainest file; cell data is checked only by --verify."""
        low, high = float(finite.min()), float(finite.max())
        size = float(np.max(case.spacing * np.array(case.values.shape[::-1])))
        smooth = self.folder / "smooth.txt"
        smooth.write_text(f"{low!r} .1 .2 .9 0\n{high!r} .9 .5 .1 {8 / size!r}\n")
        sharp = self.folder / "sharp.txt"
        middle = low + 0.55 * (high - low)
        sharp.write_text(f"{low!r} 0 0 1 0\n{middle!r} 0 0 1 0\n{middle!r} 1 .3 0 {20 / size!r}\n{high!r} 1 .9 0 {20 / size!r}\n")
        plain = self.folder / "plain.nrrd"
        header = nrrd_header(case.values, told["origin"], told["spacing"], np.array(told["direction"]).T, "double")
        plain.write_bytes(header.encode() + case.values.astype("<f8").tobytes())
        box = np.array(told["bounds"])
        inside = box.mean(axis=0)
        camera = self.folder / "inside.txt"
        camera.write_text("position %r %r %r\nfocal_point %r %r %r\nview_up .1 1 .2\nview_angle 90\n" % (
            *map(float, inside), *map(float, box[1] * [1, .9, .8] + inside * [0, .1, .2])))
        views = [(smooth, ["--projection", "orthographic"]), (sharp, ["--projection", "perspective"]),
                 (smooth, ["--camera", camera]), (sharp, ["--projection", "orthographic", "--accuracy", "1e-5"])]
        for number, (function, view) in enumerate(views):
            words = ["--transfer-function", function, "--size", "24x20", "--quiet", *view]
            first, second = self.folder / "first.pfm", self.folder / "second.pfm"
            report = self.folder / "report.json"
            one = self.run("render", file, "-o", first, "--verify", 480, "--report", report, *case.words, *words)
            # At a step one pixel of 480 may be excused, which is more than a whole image may have.
            judged = json.loads(report.read_text())["frames"][0]["verify"] if one.returncode in (0, 4) else {}
            if not judged or judged["max_error_not_excused"] > judged["bound"] or judged["excused"] > 2:
                return self.fault(case.name, f"view {number}: {one.returncode} {one.stderr.strip()} {one.stdout.strip()}")
            if case.cell:
                continue
            two = self.run("render", plain, "-o", second, *words)
            if two.returncode != 0:
                return self.fault(case.name, f"plain copy: {two.stderr.strip()}")
            a, b = (np.frombuffer(f.read_bytes()[-24 * 20 * 12:], "<f4") for f in (first, second))
            if number == 0 and not np.abs(a).max() > 0.05:
                return self.fault(case.name, "the picture is empty")
            # Twice the accuracy; a step's edge may be on either side of a pixel's centre.
            if np.count_nonzero(np.abs(a - b) > 2.1e-4) > (0 if function == smooth else 12):
                return self.fault(case.name, f"view {number}: {np.abs(a - b).max():.2g} off the plain copy")

    # -- expectations for damaged files

    def check_bad(self, name, words, options, command="render", ranks=0):
        output = self.folder / "out.png"
        more = ["-o", output, "--size", "16x16"] if command == "render" else []
        run = self.run(command, self.path(name), *more, *options, ranks=ranks)
        own = [line for line in run.stderr.splitlines() if line.startswith("tessera: ")]
        lines = len(own) if ranks else len(run.stderr.splitlines())
        label = f"{name} ({command}{' on ' + str(ranks) if ranks else ''})"
        if run.returncode != 2 or lines != 1 or len(own) != 1:
            self.fault(label, f"status {run.returncode}, {lines} lines: {run.stderr.strip()[:300]}")
        elif words not in own[0]:
            self.fault(label, f"'{words}' is not in: {own[0]}")
        if output.exists():
            self.fault(label, "left a picture")
            output.unlink()

    def check_cut(self, case):
        """Truncates the file, and then the files that belong to it, anywhere."""
        for name in [case.name, *case.files]:
            path = self.path(name)
            whole = path.read_bytes()
            for part in (0, 1, 40, len(whole) // 3, len(whole) - 30, len(whole) - 1):
                if part < 0 or part >= len(whole):
                    continue
                path.write_bytes(whole[:part])
                run = self.run("info", self.path(case.name), *case.words)
                lines = len(run.stderr.splitlines())
                # The last byte may be a newline that is not needed, or part of a checksum.
                if run.returncode not in ((0, 2) if part >= len(whole) - 30 else (2,)) or lines != (run.returncode == 2):
                    self.fault(case.name, f"{name} cut to {part} of {len(whole)}: {run.returncode} {run.stderr.strip()[:200]}")
            path.write_bytes(whole)

    def all(self):
        for case in self.good:
            if self.only in case.name:
                self.check_good(case)
                self.check_cut(case)
        for name, words, options in self.bad:
            if self.only in name:
                self.check_bad(name, words, options)
                self.check_bad(name, words, options, "info")
                if self.ranks:
                    self.check_bad(name, words, options, ranks=self.ranks)
        print(f"{len(self.good)} good files, {len(self.bad)} broken ones, {self.runs} runs, {self.faults} faults")
        return self.faults


# -- NRRD

def text_of(values):
    return "\n".join(" ".join("%.17g" % v for v in row) for row in values.reshape(-1, values.shape[-1])) + "\n"


def add_nrrd(t):
    types = {"signed char": "i1", "int8_t": "i1", "uchar": "u1", "unsigned char": "u1", "short": "i2", "int16": "i2",
             "ushort": "u2", "unsigned short int": "u2", "int": "i4", "uint32_t": "u4", "longlong": "i8", "int64": "i8",
             "unsigned long long int": "u8", "float": "f4", "double": "f8"}
    geometry = dict(origin=(1.5, -2, 3), spacing=(0.5, 1, 2), direction=TURN)
    for number, (name, code) in enumerate(types.items()):
        values = field(code)
        for encoding in ("raw", "gzip", "ascii", "hex", "text", "txt", "gz"):
            if encoding in ("text", "txt", "gz") and number > 0 or encoding == "hex" and code[0] == "f":
                continue
            endian = ("little", "big")[number % 2]
            raw = values.astype(("<", ">")[number % 2] + code).tobytes()
            data = {"raw": raw, "gz": gzip.compress(raw), "gzip": gzip.compress(raw), "hex": raw.hex().encode()}.get(
                encoding, text_of(values).encode())
            head = nrrd_header(values, **geometry, type_name=name, encoding=encoding, endian=endian)
            t.add(f"nrrd_{name.replace(' ', '-')}_{encoding}.nrrd", head.encode() + data, values, **geometry)
    v = field("i2")
    raw = v.astype("<i2").tobytes()
    plain = dict(origin=(0, 0, 0), spacing=(1, 1, 1), direction=EYE, type_name="short")
    t.path("data/nrrd.raw").write_bytes(raw)
    t.add("nrrd_detached.nhdr", nrrd_header(v, **plain, extra="data file: data/nrrd.raw\n").rstrip() + "\n", v,
          files=["data/nrrd.raw"])
    t.path("data/nrrd.raw.gz").write_bytes(gzip.compress(raw))
    t.add("nrrd_detached_gz.nhdr", nrrd_header(v, **plain, encoding="gzip", extra="datafile: ./data/nrrd.raw.gz\n"), v,
          files=["data/nrrd.raw.gz"])
    t.path("data/nrrd.txt").write_text("skip me\nand me\n" + text_of(v))
    t.add("nrrd_detached_text.nhdr",
          nrrd_header(v, **plain, encoding="ascii", extra="line skip: 2\ndata file: data/nrrd.txt\n"), v,
          files=["data/nrrd.txt"])
    t.path("data/nrrd.skip").write_bytes(b"one line\nand another\nxyz" + raw)
    t.add("nrrd_skips.nhdr", nrrd_header(v, **plain, extra="line skip: 2\nbyte skip: 3\ndata file: data/nrrd.skip\n"), v,
          files=["data/nrrd.skip"])
    t.add("nrrd_from_the_end.nrrd", nrrd_header(v, **plain, extra="byte skip: -1\n").encode() + b"noise" + raw, v)
    t.add("nrrd_skip_in_gzip.nrrd", nrrd_header(v, **plain, encoding="gzip", extra="byte skip: 7\n").encode() +
          gzip.compress(b"7 bytes" + raw), v)
    t.add("nrrd_gzip_members.nrrd", nrrd_header(v, **plain, encoding="gzip").encode() + gzip.compress(raw[:100]) +
          gzip.compress(raw[100:]), v)
    t.add("nrrd_dos_lines.nrrd", nrrd_header(v, **plain).replace("\n", "\r\n").encode() + raw, v)
    t.add("nrrd_keys.nrrd", nrrd_header(v, **plain, extra="key:=value: with colon\nkinds: domain domain domain\n"
                                                          "space units: \"mm\" \"mm\" \"mm\"\ncontent: a b\n").encode() + raw, v)
    t.add("nrrd_spacings.nrrd", b"NRRD0001\ntype: short\ndimension: 3\nsizes: 5 6 7\nspacings: 1 nan 0.25\naxis mins: 1 2 "
          b"NaN\nencoding: raw\nendian: little\n\n" + raw, v, spacing=(1, 1, 0.25), origin=(1, 2, 0))
    t.add("nrrd_space_names.nrrd", b"NRRD0005\nType: SHORT\nDimension: 3\nspace: left-posterior-superior\nSizes: 5 6 7\n"
          b"Space Directions: (-1,0,0) (0,-2,0) (0,0,3)\nEncoding: RAW\nEndian: Little\nspace origin: (9, 8, 7)\n\n" + raw,
          v, spacing=(1, 2, 3), origin=(9, 8, 7), direction=np.diag([-1., -1, 1]))
    nan = field("f4")
    nan[1, 2, 3], nan[4, 4, 4], nan[0, 0, 0] = np.nan, np.inf, -np.inf
    t.add("nrrd_nan.nrrd", nrrd_header(nan, **dict(plain, type_name="float")).encode() + nan.tobytes(), nan)
    t.add("nrrd_nan_text.nrrd", nrrd_header(nan, **dict(plain, type_name="float"), encoding="text").encode() +
          text_of(nan).encode(), nan)
    for components in (2, 3, 4):
        many = field("f4", components)
        for number in range(components):
            t.add(f"nrrd_{components}_components_{number}.nrrd",
                  nrrd_header(many, **dict(plain, type_name="float"), components=components).encode() + many.tobytes(),
                  many[..., number], words=["--field", f"samples:{number}"])
        t.add(f"nrrd_{components}_components_mag.nrrd",
              nrrd_header(many, **dict(plain, type_name="float"), components=components).encode() + many.tobytes(),
              np.linalg.norm(many.astype(np.float64), axis=-1), words=["--field", "samples:mag"])
    last = nrrd_header(v, **plain).replace("dimension: 3", "dimension: 4").replace("sizes: 5 6 7", "sizes: 5 6 7 2")
    last = last.replace("(0,0,1)\n", "(0,0,1) none\n")
    t.refuse("nrrd_components_last.nrrd", last.encode() + raw + raw)
    t.refuse("nrrd_bzip2.nrrd", nrrd_header(v, **plain, encoding="bzip2").encode() + bz2.compress(raw), "bzip2")
    t.refuse("nrrd_block.nrrd", nrrd_header(v, **dict(plain, type_name="block")).encode() + raw, "block")
    t.refuse("nrrd_flat.nrrd", nrrd_header(v, **plain).replace("sizes: 5 6 7", "sizes: 5 6 1").encode() + raw[:60])
    t.refuse("nrrd_huge.nrrd", nrrd_header(v, **plain).replace("sizes: 5 6 7", "sizes: 900000000 900000000 9").encode() + raw)
    t.refuse("nrrd_overflow.nrrd",
             nrrd_header(v, **plain).replace("sizes: 5 6 7", "sizes: 1099511627776 1099511627776 1099511627776").encode() + raw)
    for encoding in ("gzip", "text", "hex"):
        t.refuse(f"nrrd_huge_{encoding}.nrrd",
                 nrrd_header(v, **plain, encoding=encoding).replace("sizes: 5 6 7", "sizes: 90000 90000 90000").encode() +
                 gzip.compress(raw))
    t.refuse("nrrd_words.nrrd", nrrd_header(v, **plain, encoding="text").encode() + b"1 2 three" + b" 4" * 300, "three")
    t.refuse("nrrd_list.nhdr", nrrd_header(v, **plain, extra="data file: LIST\nabsent.raw\n"), "no such file")
    t.refuse("nrrd_absent.nhdr", nrrd_header(v, **plain, extra="data file: nowhere.raw\n"), "nowhere.raw")
    t.refuse("nrrd_folder.nhdr", nrrd_header(v, **plain, extra="data file: data\n"))
    t.refuse("nrrd_itself.nhdr", nrrd_header(v, **plain, extra="data file: nrrd_itself.nhdr\nbyte skip: 100000\n"))
    t.refuse("nrrd_no_samples.nrrd", nrrd_header(v, **plain))
    t.refuse("nrrd_singular.nrrd", nrrd_header(v, **dict(plain, direction=np.ones((3, 3)))).encode() + raw)
    t.refuse("nrrd_zero_spacing.nrrd", nrrd_header(v, **dict(plain, spacing=(1, 0, 1))).encode() + raw)
    all_nan = np.full(SHAPE, np.nan, "f4")
    t.refuse("nrrd_all_nan.nrrd", nrrd_header(v, **dict(plain, type_name="float")).encode() + all_nan.tobytes(), "finite")


# -- NIfTI

def nifti_bytes(values, code, version=1, order="<", dim=None, slope=0, inter=0, quaternion=None, offset=None, qfac=1,
                rows=None, spacing=(1, 1, 1), extension=b"", magic=None):
    dim = dim or [3, *values.shape[::-1][:3]]
    dim = dim + [1] * (8 - len(dim))
    pixdim = [qfac, *spacing, 1, 1, 1, 1]
    bits = values.dtype.itemsize * 8
    if version == 1:
        h = bytearray(348)
        struct.pack_into(order + "i", h, 0, 348)
        struct.pack_into(order + "8h", h, 40, *dim)
        struct.pack_into(order + "hh", h, 70, code, bits)
        struct.pack_into(order + "8f", h, 76, *pixdim)
        struct.pack_into(order + "fff", h, 108, 352 + len(extension), slope, inter)
        struct.pack_into(order + "hh", h, 252, 1 if quaternion else 0, 1 if rows is not None else 0)
        if quaternion:
            struct.pack_into(order + "6f", h, 256, *quaternion, *offset)
        if rows is not None:
            struct.pack_into(order + "12f", h, 280, *np.asarray(rows).ravel())
        h[344:348] = magic or b"n+1\0"
    else:
        h = bytearray(540)
        struct.pack_into(order + "i", h, 0, 540)
        h[4:12] = magic or b"n+2\0\r\n\x1a\n"
        struct.pack_into(order + "hh", h, 12, code, bits)
        struct.pack_into(order + "8q", h, 16, *dim)
        struct.pack_into(order + "8d", h, 104, *pixdim)
        struct.pack_into(order + "qdd", h, 168, 544 + len(extension), slope, inter)
        struct.pack_into(order + "ii", h, 344, 1 if quaternion else 0, 1 if rows is not None else 0)
        if quaternion:
            struct.pack_into(order + "6d", h, 352, *quaternion, *offset)
        if rows is not None:
            struct.pack_into(order + "12d", h, 400, *np.asarray(rows).ravel())
    return bytes(h) + (b"\1\0\0\0" if extension else b"\0" * 4) + extension + values.astype(values.dtype.newbyteorder(order)).tobytes()


def add_nifti(t):
    codes = {2: "u1", 4: "i2", 8: "i4", 16: "f4", 64: "f8", 256: "i1", 512: "u2", 768: "u4", 1024: "i8", 1280: "u8"}
    for code, kind in codes.items():
        values = field(kind)
        for version in (1, 2):
            for order in "<>":
                data = nifti_bytes(values, code, version, order, spacing=(1, 2, 3))
                t.add(f"nifti{version}_{kind}_{'lb'[order == '>']}.nii", data, values, spacing=(1, 2, 3))
        t.add(f"nifti_{kind}.nii.gz", gzip.compress(nifti_bytes(values, code)), values)
    v = field("i2")
    t.add("nifti_slope.nii", nifti_bytes(v, 4, slope=-0.5, inter=100), v * -0.5 + 100)
    t.add("nifti_slope_u8.nii.gz", gzip.compress(nifti_bytes(field("u1"), 2, slope=3.0517578125e-05, inter=-0.25)),
          field("u1") * 3.0517578125e-05 - 0.25)
    nan = field("f4")
    nan[3, 3, 3] = np.nan
    t.add("nifti_nan.nii", nifti_bytes(nan, 16, slope=2, inter=1), nan.astype(np.float64) * 2 + 1)
    shear = np.array([[-2, .3, 0, 10], [0, 1.5, .2, -20], [.1, 0, 3, 30]], "f4")
    lengths = np.linalg.norm(shear[:, :3], axis=0)
    for version in (1, 2):
        t.add(f"nifti{version}_sform.nii", nifti_bytes(v, 4, version, rows=shear), v, origin=shear[:, 3], spacing=lengths,
              direction=shear[:, :3] / lengths)
        half = np.sqrt(0.1)  # (0.8, 0.6) is a rotation by atan2(.6, .8) about z: sine of half its angle
        turned = TURN.copy()
        turned[:, 2] *= -1
        t.add(f"nifti{version}_qform.nii", nifti_bytes(v, 4, version, quaternion=(0, 0, half), offset=(1, 2, 3), qfac=-1,
                                                       spacing=(.5, 1, 2)), v, origin=(1, 2, 3), spacing=(.5, 1, 2),
              direction=turned)
    t.add("nifti_extension.nii", nifti_bytes(v, 4, extension=b"x" * 64), v)
    t.add("nifti_4d_of_one.nii", nifti_bytes(v, 4, dim=[4, 5, 6, 7, 1]), v)
    t.add("nifti_5d_of_one.nii", nifti_bytes(v, 4, dim=[5, 5, 6, 7, 1, 1]), v)
    rgb = field("u1", 3)
    t.add("nifti_rgb.nii", nifti_bytes(rgb, 128, dim=[3, 5, 6, 7]), rgb[..., 1], words=["--field", "samples:1"])
    writer = vtk.vtkNIFTIImageWriter()
    writer.SetInputData(vtk_image(field("f4"), (1, 2, 3), (0.5, 1, 2)))
    for name in ("nifti_vtk.nii", "nifti_vtk.nii.gz"):
        writer.SetFileName(str(t.path(name)))
        writer.Write()
        # Its own qform stores the origin's and the axes' signs; only the samples and the spacing are compared.
        told = json.loads(t.run("info", t.path(name), "--json").stdout or "{}")
        t.add(name, None, field("f4"), origin=told.get("origin", 0), spacing=(.5, 1, 2),
              direction=np.array(told.get("direction", EYE)).T)
    t.refuse("nifti_6d.nii", nifti_bytes(v, 4, dim=[6, 5, 6, 7, 1, 1, 3]) + v.tobytes() * 2, "dimension 6")
    t.add("nifti_5d.nii", nifti_bytes(v, 4, dim=[5, 5, 6, 7, 1, 3]) + v.tobytes() * 2, v, words=["--field", "samples:1"])
    t.add("nifti_time.nii", nifti_bytes(v, 4, dim=[4, 5, 6, 7, 2]) + v.tobytes(), v)
    t.refuse("nifti_flat.nii", nifti_bytes(v, 4, dim=[2, 5, 6]))
    t.refuse("nifti_complex.nii", nifti_bytes(field("f8"), 32), "32")
    t.refuse("nifti_huge.nii", nifti_bytes(v, 4, dim=[3, 32767, 32767, 32767]), "bytes")
    t.refuse("nifti_huge.nii.gz", gzip.compress(nifti_bytes(v, 4, dim=[3, 32767, 32767, 32767])))
    t.refuse("nifti_minus.nii", nifti_bytes(v, 4, dim=[3, -5, 6, 7]), "-5")
    t.refuse("nifti_two_files.nii", nifti_bytes(v, 4, magic=b"ni1\0"), "does not exist")
    t.refuse("nifti_no_spacing.nii", nifti_bytes(v, 4, spacing=(1, 0, 1)), "spacing")
    t.refuse("nifti_text.nii", "hello\n")
    t.refuse("nifti_text.nii.gz", gzip.compress(b"hello\n" * 300))
    t.refuse("nifti_broken.nii.gz", gzip.compress(nifti_bytes(v, 4))[:60] + b"\xff" * 400)
    t.refuse("nifti_inf_offset.nii", nifti_bytes(v, 4)[:108] + struct.pack("<f", float("inf")) + nifti_bytes(v, 4)[112:])


# -- MetaImage

def add_meta(t):
    types = {"MET_CHAR": "i1", "MET_UCHAR": "u1", "MET_SHORT": "i2", "MET_USHORT": "u2", "MET_INT": "i4", "MET_UINT": "u4",
             "MET_LONG_LONG": "i8", "MET_ULONG_LONG": "u8", "MET_FLOAT": "f4", "MET_DOUBLE": "f8"}

    def header(kind, extra="", data="LOCAL", n="5 6 7"):
        return f"ObjectType = Image\nNDims = 3\nDimSize = {n}\nElementType = {kind}\n{extra}ElementDataFile = {data}\n"

    for number, (kind, code) in enumerate(types.items()):
        v = field(code)
        for order, word in (("<", "False"), (">", "True")):
            raw = v.astype(order + code).tobytes()
            name = f"meta_{code}_{'lb'[order == '>']}"
            t.add(name + ".mha", header(kind, f"BinaryData = True\nBinaryDataByteOrderMSB = {word}\n").encode() + raw, v)
            t.path(name + ".raw").write_bytes(raw)
            t.add(name + ".mhd", header(kind, f"ElementByteOrderMSB = {word}\n", name + ".raw"), v, files=[name + ".raw"])
            packed = zlib.compress(raw)
            t.add(name + "_z.mha", header(kind, f"BinaryData = True\nBinaryDataByteOrderMSB = {word}\nCompressedData = True\n"
                                          f"CompressedDataSize = {len(packed)}\n").encode() + packed, v)
        t.add(f"meta_{code}_text.mha", header(kind, "BinaryData = False\n").encode() + text_of(v).encode(), v)
    v = field("i2")
    raw = v.tobytes()
    place = ("Offset = 1.5 -2 3\nTransformMatrix = .8 .6 0 -.6 .8 0 0 0 1\nCenterOfRotation = 0 0 0\nAnatomicalOrientation = RAI\n"
             "ElementSpacing = .5 1 2\nElementSize = 1 1 1\n")
    t.add("meta_placed.mha", header("MET_SHORT", place).encode() + raw, v, origin=(1.5, -2, 3), spacing=(.5, 1, 2), direction=TURN)
    t.path("meta.zraw").write_bytes(zlib.compress(raw))
    t.add("meta_zraw.mhd", header("MET_SHORT", "CompressedData = True\n", "meta.zraw"), v, files=["meta.zraw"])
    t.path("meta_tail.raw").write_bytes(b"a header of some other program" + raw)
    t.add("meta_tail.mhd", header("MET_SHORT", "HeaderSize = -1\n", "meta_tail.raw"), v, files=["meta_tail.raw"])
    t.add("meta_skip.mhd", header("MET_SHORT", "HeaderSize = 30\n", "meta_tail.raw"), v)
    for components in (2, 3, 4):
        many = field("f4", components)
        t.add(f"meta_{components}_channels.mha", header("MET_FLOAT", f"ElementNumberOfChannels = {components}\n").encode() +
              many.tobytes(), many[..., 1], words=["--field", "samples:1"])
    t.add("meta_array.mha", header("MET_FLOAT_ARRAY", "ElementNumberOfChannels = 3\n").encode() + field("f4", 3).tobytes(),
          field("f4", 3)[..., 2], words=["--field", "samples:2"])
    t.add("meta_comment.mha", b"Comment = made by hand\n" + header("MET_SHORT").encode() + raw, v)
    t.add("meta_dos.mha", header("MET_SHORT").replace("\n", "\r\n").encode() + raw, v)
    writer = vtk.vtkMetaImageWriter()
    writer.SetInputData(vtk_image(field("f4"), (1, 2, 3), (0.5, 1, 2)))
    for packed in (False, True):
        writer.SetFileName(str(t.path(f"meta_vtk_{packed}.mha")))
        writer.SetCompression(packed)
        writer.Write()
        t.add(f"meta_vtk_{packed}.mha", None, field("f4"), origin=(1, 2, 3), spacing=(.5, 1, 2))
    t.refuse("meta_4d.mha", header("MET_SHORT").replace("NDims = 3", "NDims = 4").encode() + raw, "4")
    t.refuse("meta_2d.mha", header("MET_SHORT", n="5 6").replace("NDims = 3", "NDims = 2").encode() + raw)
    t.refuse("meta_huge.mha", header("MET_SHORT", n="90000 90000 90000").encode() + raw)
    t.refuse("meta_huge_z.mha", header("MET_SHORT", "CompressedData = True\n", n="90000 90000 90000").encode() + zlib.compress(raw))
    t.refuse("meta_list.mhd", header("MET_SHORT", data="LIST"), "no names follow")
    t.refuse("meta_absent.mhd", header("MET_SHORT", data="nowhere.raw"), "nowhere.raw")
    t.refuse("meta_no_file.mhd", header("MET_SHORT", data=""))
    t.refuse("meta_folder.mhd", header("MET_SHORT", data="data"))
    t.refuse("meta_type.mha", header("MET_OTHER").encode() + raw, "MET_OTHER")
    t.refuse("meta_tube.mha", "ObjectType = Tube\nNDims = 3\n")
    t.refuse("meta_nan_spacing.mha", header("MET_SHORT", "ElementSpacing = 1 nan 1\n").encode() + raw)
    t.refuse("meta_slope.mha", header("MET_SHORT", "ElementToIntensityFunctionSlope = 0\n").encode() + raw)


# -- VTK

def vtk_image(values, origin=(0, 0, 0), spacing=(1, 1, 1), direction=EYE, cell=None, low=(0, 0, 0), name="a field"):
    """Point data `values`, and cell data `cell`, of an extent that begins at `low`."""
    image = vtk.vtkImageData()
    shape = values.shape if values is not None else tuple(n + 1 for n in cell.shape)
    image.SetExtent(*[v for a in range(3) for v in (low[a], low[a] + shape[2 - a] - 1)])
    image.SetOrigin(*map(float, origin))
    image.SetSpacing(*map(float, spacing))
    image.SetDirectionMatrix(*map(float, np.asarray(direction).ravel()))
    for data, numbers in ((image.GetPointData(), values), (image.GetCellData(), cell)):
        if numbers is not None:
            flat = np.ascontiguousarray(numbers).reshape(-1, *numbers.shape[3:])
            array = numpy_to_vtk(flat, deep=True)
            array.SetName(name)
            data.SetScalars(array)
    return image


def even_grid(values, origin, spacing, cell=None):
    """A rectilinear grid with uniform coordinates, so that the plain copy can represent them."""
    grid = vtk.vtkRectilinearGrid()
    grid.SetExtent(0, SHAPE[2] - 1, 0, SHAPE[1] - 1, 0, SHAPE[0] - 1)
    for a, axis in enumerate("XYZ"):
        getattr(grid, f"Set{axis}Coordinates")(numpy_to_vtk(origin[a] + spacing[a] * np.arange(SHAPE[2 - a]), deep=True))
    for data, numbers in ((grid.GetPointData(), values), (grid.GetCellData(), cell)):
        if numbers is not None:
            array = numpy_to_vtk(np.ascontiguousarray(numbers).ravel(), deep=True)
            array.SetName("a field")
            data.SetScalars(array)
    return grid


def part_of(grid, low, high):
    """The slab of points low to high along k."""
    part = grid.NewInstance()
    part.ShallowCopy(grid)
    part.Crop([0, SHAPE[2] - 1, 0, SHAPE[1] - 1, low, high])
    return part


def parallel_file(word, parts):
    """A .pvti or .pvtr of these files and extents."""
    kind = {"vti": "PImageData", "vtr": "PRectilinearGrid"}[word]
    place = ' Origin="1.5 -2 3" Spacing="0.5 1 2"' if word == "vti" else ""
    pieces = "".join(f'<Piece Extent="{extent}" Source="{name}"/>' for name, extent in parts.items())
    return (f'<VTKFile type="{kind}" version="0.1" byte_order="LittleEndian"><{kind} WholeExtent="0 4 0 5 0 6" '
            f'GhostLevel="0"{place}><PPointData/>{pieces}</{kind}></VTKFile>')


def add_vtk(t):
    geometry = dict(origin=(1.5, -2, 3), spacing=(0.5, 1, 2), direction=TURN)
    line = dict(origin=(1.5, -2, 3), spacing=(0.5, 1, 2))
    codes = ["i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f4", "f8"]
    def write(image, name, mode="appended", packed="zlib", **more):
        # A new one each time: VTK 9.1's writes raw bytes between tags after it has once appended raw bytes.
        writer = more.get("writer", vtk.vtkXMLImageDataWriter)()
        writer.SetInputData(image)
        writer.SetFileName(str(t.path(name)))
        {"ascii": writer.SetDataModeToAscii, "binary": writer.SetDataModeToBinary}.get(mode, writer.SetDataModeToAppended)()
        {"none": writer.SetCompressorTypeToNone, "lz4": writer.SetCompressorTypeToLZ4,
         "lzma": writer.SetCompressorTypeToLZMA}.get(packed, writer.SetCompressorTypeToZLib)()
        writer.SetEncodeAppendedData(mode != "appended" or more.get("base64", True))
        writer.SetHeaderTypeToUInt64() if more.get("wide") else writer.SetHeaderTypeToUInt32()
        writer.SetNumberOfPieces(more.get("pieces", 1))
        (writer.SetByteOrderToBigEndian if more.get("big") else writer.SetByteOrderToLittleEndian)()
        writer.SetWriteExtent(*image.GetExtent())
        writer.Write()

    for number, code in enumerate(codes):
        v = field(code)
        image = vtk_image(v, **geometry)
        for mode in ("ascii", "binary", "appended"):
            for packed in ("none", "zlib", "lz4", "lzma"):
                if mode == "ascii" and packed != "none" or packed in ("lz4", "lzma") and number % 4:
                    continue
                name = f"vti_{code}_{mode}_{packed}.vti"
                write(image, name, mode, packed, wide=number % 2 == 0, base64=number % 3 == 0, big=number % 5 == 3)
                t.add(name, None, v, **geometry)
    v, c = field("f4"), field("i2")[:-1, :-1, :-1]
    write(vtk_image(v, low=(3, -4, 5), **geometry), "vti_extent.vti")
    shifted = np.asarray(geometry["origin"]) + TURN @ (np.asarray(geometry["spacing"]) * [3, -4, 5])
    t.add("vti_extent.vti", None, v, origin=shifted, spacing=geometry["spacing"], direction=TURN)
    write(vtk_image(None, cell=c, **geometry), "vti_cells.vti")
    t.add("vti_cells.vti", None, c, cell=True, **geometry)
    both = vtk_image(v, cell=c)
    more = numpy_to_vtk(np.ascontiguousarray(field("f8", 3)).reshape(-1, 3), deep=True)
    more.SetName("Velo city")
    both.GetPointData().AddArray(more)
    write(both, "vti_many.vti")
    for name, words, values, cell in (("point", "point:a field", v, False), ("cell", "cell:a field", c, True),
                                      ("mag", "Velo city:mag", np.linalg.norm(field("f8", 3), axis=-1), False),
                                      ("y", "Velo city:y", field("f8", 3)[..., 1], False)):
        name = f"vti_many_{name}.vti"
        t.path(name).write_bytes(t.path("vti_many.vti").read_bytes())
        t.add(name, None, values, cell=cell, words=["--field", words])
    for pieces in (2, 3):
        write(vtk_image(v, **geometry), f"vti_{pieces}_pieces.vti", pieces=pieces)
        t.add(f"vti_{pieces}_pieces.vti", None, v, **geometry)
        parallel = vtk.vtkXMLPImageDataWriter()
        parallel.SetInputData(vtk_image(v, **geometry))
        parallel.SetNumberOfPieces(pieces)
        parallel.SetEndPiece(pieces - 1)
        parallel.SetFileName(str(t.path(f"pvti_{pieces}.pvti")))
        parallel.Write()
        parts = sorted(p.name for p in t.folder.glob(f"pvti_{pieces}_*.vti"))
        t.add(f"pvti_{pieces}.pvti", None, v, files=parts, **geometry)
    # Pieces with their own extents, which VTK's parallel writers create from a pipeline that supports requests for
    # parts.
    v, c = field("f4"), field("i2")[:-1, :-1, :-1]
    for word, grid in (("vti", vtk_image(v, cell=c, **geometry)), ("vtr", even_grid(v, cell=c, **line))):
        parts = {}
        for number, (low, high) in enumerate(((0, 2), (2, 3), (3, 6))):
            name = f"p{word}_parts_{number}.{word}"
            write(part_of(grid, low, high), name, ("ascii", "binary", "appended")[number],
                  **({} if word == "vti" else dict(writer=vtk.vtkXMLRectilinearGridWriter)))
            parts[name] = f"0 4 0 5 {low} {high}"
        for name, words, values, cell in (("point", "point:a field", v, False), ("cell", "cell:a field", c, True)):
            t.add(f"p{word}_parts_{name}.p{word}", parallel_file(word, parts), values, cell=cell,
                  words=["--field", words], files=list(parts), **(geometry if word == "vti" else line))
    names = list(parts)
    for name, changed in (("gap", {n: parts[n] for n in names[:2]}), ("twice", {names[0]: parts[names[0]]}),
                          ("gone", {**parts, "gone.vtr": "0 4 0 5 0 6"}), ("self", {**parts, "pvtr_self.pvtr": "0 4 0 5 0 6"}),
                          ("claims", {**parts, names[1]: "0 4 0 5 0 6"}), ("beyond", {**parts, names[1]: "0 9 0 5 2 3"}),
                          ("words", {**parts, names[1]: "0 4 0 five"})):
        t.refuse(f"pvtr_{name}.pvtr", parallel_file("vtr", changed))
    for name, other in (("moved", even_grid(v, cell=c, **dict(line, origin=(1.5, -2, 3.25)))),
                        ("type", even_grid(v.astype("f8"), cell=c, **line)),
                        ("arrays", even_grid(v, **line))):
        write(part_of(other, 2, 3), f"bad_{name}.vtr", "ascii", writer=vtk.vtkXMLRectilinearGridWriter)
        t.refuse(f"pvtr_{name}.pvtr", parallel_file("vtr", {names[0]: parts[names[0]], f"bad_{name}.vtr": parts[names[1]],
                                                            names[2]: parts[names[2]]}), f"bad_{name}.vtr")
    t.refuse("pvtr_large.pvtr", parallel_file("vtr", parts).replace("0 4 0 5 0 6", "0 1500 0 1500 0 1500"))
    nan = field("f4")
    nan[1, 2, 3] = np.nan
    write(vtk_image(nan), "vti_nan.vti")
    t.add("vti_nan.vti", None, nan)
    hidden = vtk_image(v)
    ghosts = np.zeros(v.size, np.uint8)
    ghosts[17] = 2
    array = numpy_to_vtk(ghosts, deep=True)
    array.SetName("vtkGhostType")
    hidden.GetPointData().AddArray(array)
    write(hidden, "vti_hidden.vti")
    shown = v.astype(np.float64).ravel().copy()
    shown[17] = np.nan
    t.add("vti_hidden.vti", None, shown.reshape(SHAPE))
    legacy = vtk.vtkStructuredPointsWriter()
    for number, code in enumerate(codes):
        v = field(code)
        for mode in ("ascii", "binary"):
            points = vtk.vtkStructuredPoints()
            points.ShallowCopy(vtk_image(v, geometry["origin"], geometry["spacing"], name="a_field"))
            legacy.SetInputData(points)
            legacy.SetFileName(str(t.path(f"vtk_{code}_{mode}.vtk")))
            (legacy.SetFileTypeToASCII if mode == "ascii" else legacy.SetFileTypeToBinary)()
            legacy.Write()
            if code == "f4" and mode == "ascii":  # six digits
                v = np.vectorize(lambda x: float("%g" % x))(v)
            t.add(f"vtk_{code}_{mode}.vtk", None, v, origin=geometry["origin"], spacing=geometry["spacing"])
    old = "# vtk DataFile Version 2.0\nby hand\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 5 6 7\nORIGIN 0 0 0\n{}\nPOINT_DATA 210\n"
    v = field("i2")
    body = "SCALARS volume short 1\nLOOKUP_TABLE default\n" + text_of(v)
    t.add("vtk_aspect.vtk", old.format("ASPECT_RATIO 1 2 3") + body, v, spacing=(1, 2, 3))
    t.add("vtk_lines.vtk", old.format("SPACING 1 2 3").replace("\n", "\r\n") + body.replace("\n", "\r\n"), v, spacing=(1, 2, 3))
    t.add("vtk_cells.vtk", old.format("SPACING 1 1 1").replace("POINT_DATA 210", "CELL_DATA 120") +
          "SCALARS volume short 1\nLOOKUP_TABLE default\n" + text_of(v[:-1, :-1, :-1]), v[:-1, :-1, :-1], cell=True)
    t.add("vtk_vectors.vtk", old.format("SPACING 1 1 1") + "VECTORS wind float\n" +
          text_of(field("f4", 3).reshape(-1, 3)), field("f4", 3)[..., 2], words=["--field", "wind:z"])
    t.refuse("vtk_huge.vtk", old.format("SPACING 1 1 1").replace("5 6 7", "90000 90000 90000") + body)
    t.refuse("vtk_negative.vtk", old.format("SPACING 1 1 1").replace("5 6 7", "5 -6 7") + body)
    t.refuse("vtk_no_field.vtk", old.format("SPACING 1 1 1").replace("POINT_DATA 210\n", ""), "field")
    t.refuse("vtk_zero_spacing.vtk", old.format("SPACING 1 0 1") + body)
    good = t.path("vti_f4_ascii_none.vti").read_text()
    t.refuse("vti_huge.vti", good.replace('Extent="0 4 0 5 0 6"', 'Extent="0 90000 0 90000 0 90000"'))
    t.refuse("vti_large.vti", good.replace('Extent="0 4 0 5 0 6"', 'Extent="0 1500 0 1500 0 1500"'))
    t.refuse("pvti_large.pvti", t.path("pvti_2.pvti").read_text().replace("0 4 0 5 0 6", "0 1500 0 1500 0 1500"))
    t.refuse("vti_wrong.vti", good.replace('Extent="0 4 0 5 0 6"', 'Extent="0 4 0 5 0 7"'))
    t.refuse("vti_upside_down.vti", good.replace('Extent="0 4 0 5 0 6"', 'Extent="4 0 0 5 0 6"'))
    t.refuse("vti_xml.vti", good.replace("</Piece>", ""))
    t.refuse("pvti_absent.pvti", t.path("pvti_2.pvti").read_text().replace("pvti_2_1.vti", "gone.vti"), "gone.vti")
    half = t.path("pvti_2.pvti").read_text().replace('Piece Extent="0 4 0 5 0 6"', 'Piece Extent="0 4 0 5 0 2"')
    t.refuse("pvti_gap.pvti", half, "cells")
    t.refuse("pvti_itself.pvti", t.path("pvti_2.pvti").read_text().replace("pvti_2_1.vti", "pvti_itself.pvti"))


# -- raw files, and files that are not volumes

def add_others(t):
    for code, name in {"i1": "int8", "u1": "uint8", "i2": "int16", "u2": "uint16", "i4": "int32", "u4": "uint32", "f4": "float32",
                       "f8": "float64"}.items():
        v = field(code)
        t.add(f"raw_5x6x7_{name}.raw", v.tobytes(), v)
        t.add(f"raw_{name}_big.raw", b"abc" + v.astype(">" + code).tobytes(), v, spacing=(1, 2, 3), origin=(4, 5, 6),
              words=["--dims", "5x6x7", "--type", name, "--endian", "big", "--skip", 3, "--spacing", "1,2,3", "--origin", "4,5,6"])
    raw = field("i2").tobytes()
    t.refuse("raw_5x6x8_int16.raw", raw, "420")
    t.refuse("raw_5x6x6_int16.raw", raw, "420")
    t.refuse("raw.raw", raw, "--dims")
    t.refuse("raw_9000000x9000000x9000000_float64.raw", raw)
    t.refuse("raw_1x6x35_int16.raw", raw)
    t.refuse("raw_0x6x35_int16.raw", raw)
    t.refuse("empty.raw", b"")
    t.refuse("empty.vti", b"")
    t.refuse("empty.nrrd", b"")
    t.refuse("noise.nrrd", os.urandom(3000))
    t.refuse("noise.mha", os.urandom(3000))
    t.refuse("noise.nii", os.urandom(3000))
    t.refuse("noise.vti", os.urandom(3000))
    t.refuse("noise.bricks", os.urandom(3000))
    t.refuse("noise.vtk", os.urandom(3000))
    t.refuse("absent.nii.gz", None, "no such file")
    for name in ("folder.vti", "folder.raw", "folder.nii.gz", "folder"):
        t.path(name).mkdir(exist_ok=True)
        t.refuse(name, None)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tessera", required=True)
    parser.add_argument("--only", default="", help="cases whose names hold this")
    parser.add_argument("--keep", type=Path, help="keep the files here")
    parser.add_argument("--mpi", type=int, default=0, help="broken files on so many ranks too")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        trials = Trials(Path(arguments.tessera).resolve(), arguments.keep or Path(scratch), arguments.only, arguments.mpi)
        trials.folder.mkdir(exist_ok=True)
        for add in (add_nrrd, add_nifti, add_meta, add_vtk, add_others):
            add(trials)
        sys.exit(1 if trials.all() else 0)


if __name__ == "__main__":
    main()
