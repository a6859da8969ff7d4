# SPDX-License-Identifier: BSD-3-Clause
"""Rows of advice about volumes and their files."""

import gzip

from advice_files import IMAGE, META, NIFTI, NRRD, SAMPLES, TETRAHEDRON, UNEVEN, nifti
from advice_row import cut, damaged, row

R = "render m.vtu -o a.png --size 16x16 "
V = "render v.vti -o a.png --size 16x16 "


def nrrd(old, new, advice, **more):
    return damaged("a.nrrd", NRRD, old.encode(), new.encode(), advice, **more)


def meta(old, new, advice):
    return damaged("a.mha", META, old.encode(), new.encode(), advice)


def nii(header, advice, samples=SAMPLES):
    return row("info a.nii", advice, None, {"a.nii": header + samples}, {"a.nii": NIFTI})


def nrrd_axes(axes, advice):
    """Axes that cannot be read, and a vector's that can."""
    head = "NRRD0004\ntype: uint8\nencoding: raw\n"
    dimension = f"dimension: {len(axes.split(':')[-1].split())}\n"
    good = "dimension: 4\nkinds: vector domain domain domain\nsizes: 2 2 2 2\n\n"
    return row(
        "info a.nrrd",
        advice,
        None,
        {"a.nrrd": f"{head}{dimension}{axes}\n\n".encode() + SAMPLES * 4},
        {"a.nrrd": (head + good).encode() + SAMPLES * 2},
    )


DETACHED = NRRD.replace(b"encoding: raw\n\n" + SAMPLES, b"encoding: raw\ndata file: a%d.raw 0 1 1\n")
PARTS = {"a0.raw": SAMPLES[:4], "a1.raw": SAMPLES[4:]}
META_TEXT = META.replace(b"BinaryData = True", b"BinaryData = False").replace(SAMPLES, b"1 2 3 4 5 6 7 8")
ROOMY = TETRAHEDRON.replace("</VTKFile>", " " * (100 << 20) + "</VTKFile>")  # blanks that gzip compresses to nothing
PACKED = NRRD.replace(b"raw", b"gzip").replace(SAMPLES, gzip.compress(SAMPLES, mtime=0))
TEXT = NRRD.replace(b"raw", b"ascii").replace(SAMPLES, b"1 2 3 4 5 6 7 8")
HEX = NRRD.replace(b"raw", b"hex").replace(SAMPLES, SAMPLES.hex().encode())
ANALYZE = nifti(magic=b"ni1\0", offset=0)

ROWS = [
    # volumes
    row(V + "--smooth", "leave it out", V),
    row(V + "--light 1,1,1", "add it, or leave --light out", V + "--light 1,1,1 --shade"),
    row(V + "--light 0,0,0 --shade", "give the direction towards the light", V + "--light 1,1,1 --shade"),
    row(V + "--shade --no-shade", "leave one of the two out", V + "--shade"),
    row(V + "--cache fifo", "use lru or proximity", V + "--cache proximity"),
    row(V + "--labels maybe", "use on or off", V + "--labels off"),
    row(V + "--edge-bricks open", "use variable or fixed", V + "--edge-bricks fixed"),
    row(V + "--preload 3", "add it, or leave --preload out", V + "--preload 3 --cache proximity"),
    row(V + "--step 0.5", "use sampled or preintegrated", V + "--step 0.5 --integrator sampled"),
    row(V + "--iso 7", "choose a value between", V + "--iso 0.5"),
    row(V + "--iso 0.5 --integrator sampled", "leave one of the two out", V + "--iso 0.5 --integrator exact"),
    row(V + "--threshold 7,8", "give a wider range", V + "--threshold=-1,1"),
    row(V + "--integrator partial", "use auto, exact, sampled or preintegrated", V + "--integrator exact"),
    row(V + "--distribution last", "use sort-first or sort-last", V + "--distribution sort-last"),
    row(V + "--direct-send slow --distribution sort-last", "use asynchronous or synchronous",
        V + "--distribution sort-last --direct-send synchronous"),
    row(V + "--direct-send synchronous", "add it, or leave it out", V),
    row(V + "--distribution sort-last --balance even", "leave one of the two out", V + "--balance even"),
    row(V + "--distribution sort-last --integrator preintegrated", "or sort-first",
        V + "--distribution sort-first --integrator preintegrated"),
    row(R + "--distribution sort-last", "leave it out", R),
    row(V + "--balance best", "use learned, accurate, backface", V + "--balance backface"),
    row(V + "--balance-resolution 7", "from 0.001 to 1", V + "--balance-resolution 0.5"),
    row(V + "--show cost", "use balance", V + "--show balance"),
    row(V + "--type int7", "use int8, uint8", "info v.raw --dims 8x8x8 --type float32"),
    row(V + "--endian middle", "use little or big", "info v.raw --dims 8x8x8 --type float32 --endian little"),
    row("info v.raw", "give --dims WxHxD --type", "info v.raw --dims 8x8x8 --type float32"),
    row(
        "info v.raw --dims 9x9x9 --type float32", "give the right dimensions", "info v.raw --dims 8x8x8 --type float32"
    ),
    row(V + "--dims 8x8x8", "this one states them itself", V),
    row("info v.vti --check", "leave it out", "info v.vti"),
    # NRRD
    row(
        "info a.nrrd",
        "add a line of kinds if it is one of space",
        "info a.nrrd",
        {"a.nrrd": b"NRRD0004\ntype: uint8\ndimension: 4\nsizes: 2 2 2 2\nencoding: raw\n\n" + SAMPLES * 2},
        {
            "a.nrrd": b"NRRD0004\ntype: uint8\ndimension: 4\nsizes: 2 2 2 2\nkinds: domain domain domain time\n"
            b"encoding: raw\n\n" + SAMPLES * 2
        },
    ),
    nrrd("sizes: 2", "sizes: 3", "the file is truncated, write it again"),
    nrrd("uint8", "block", "write integers, float or double"),
    nrrd("encoding: raw", "encoding: bzip2", "write raw, gzip, ascii or hex"),
    nrrd(
        "dimension: 3\nspace dimension: 3\nsizes: 2 2 2",
        "dimension: 6\nsizes: 1 1 1 2 2 2",
        "a volume has three, before them components and after",
    ),
    nrrd(
        "dimension: 3\nspace dimension: 3\nsizes: 2 2 2",
        "dimension: 2\nsizes: 4 2",
        "a volume has three, before them components and after",
    ),
    nrrd("(1,0,0) (0,1,0) (0,0,1)", "(1,0) (0,1) none", "write a space of three, with a direction for each axis"),
    row(
        "info a.nrrd",
        "add a line 'endian: little', or big",
        None,
        {"a.nrrd": NRRD.replace(b"uint8", b"short").replace(b"endian: little\n", b"") + SAMPLES},
        {"a.nrrd": NRRD.replace(b"uint8", b"short") + SAMPLES},
    ),
    nrrd("sizes: 2 2 2", "sizes: 2 2 x", "the file is truncated or damaged, write it again"),
    nrrd("sizes: 2 2 2", "sizes: 9999999999 9999999999 9999999999", "write the file again"),
    row(
        "info a.nrrd",
        "than can be addressed; it is damaged, write it again",
        None,
        {"a.nrrd": b"NRRD0004\ntype: uint8\ndimension: 4\nsizes: 100000 100000 100000 99999999\nencoding: raw\n\n"},
        {"a.nrrd": NRRD},
    ),
    row(
        "info a.nrrd",
        "write at most 64 components",
        None,
        {
            "a.nrrd": b"NRRD0004\ntype: uint8\ndimension: 4\nkinds: vector domain domain domain\nsizes: "
            b"65 2 2 2\nencoding: raw\n\n" + SAMPLES * 65
        },
        {
            "a.nrrd": b"NRRD0004\ntype: uint8\ndimension: 4\nkinds: vector domain domain domain\nsizes: "
            b"64 2 2 2\nencoding: raw\n\n" + SAMPLES * 64
        },
    ),
    row(
        "info a.nrrd",
        "write one of them alone",
        None,
        {
            "a.nrrd": b"NRRD0004\ntype: uint8\ndimension: 5\nkinds: list domain domain domain time\n"
            b"sizes: 2 2 2 2 2\nencoding: raw\n\n" + SAMPLES * 4
        },
        {
            "a.nrrd": b"NRRD0004\ntype: uint8\ndimension: 4\nkinds: list domain domain domain\nsizes: 2 2 "
            b"2 2\nencoding: raw\n\n" + SAMPLES * 2
        },
    ),
    nrrd_axes("kinds: vector domain domain domain vector\nsizes: 2 2 2 2 2", "write one of them alone"),
    nrrd_axes("kinds: time domain domain domain vector\nsizes: 2 2 2 2 2", "or write one step alone"),
    nrrd_axes("kinds: domain time domain domain\nsizes: 2 2 2 2", "write it first or last"),
    nrrd_axes("kinds: time domain domain domain\nsizes: 70000 2 2 2", "write at most 65536"),
    row(
        "info a.nrrd",
        "state where they begin",
        None,
        {"a.nrrd": TEXT.replace(b"ascii\n", b"ascii\nbyte skip: -1\n")},
        {"a.nrrd": TEXT.replace(b"ascii\n", b"ascii\nbyte skip: 0\n")},
    ),
    row(
        "info a.nhdr",
        "'line skip' is for one file of samples; leave it out",
        None,
        {"a.nhdr": DETACHED.replace(b"data file", b"line skip: 1\ndata file"), **PARTS},
        {"a.nhdr": DETACHED},
    ),
    row("info a.nhdr", "put the file it names there", None, {"a.nhdr": DETACHED, "a0.raw": SAMPLES[:4]}, PARTS),
    row(
        "info a.nhdr",
        "its part of the samples is 4 bytes, the file has 3; the file is truncated, write it again",
        None,
        {"a.nhdr": DETACHED, **PARTS, "a1.raw": b"abc"},
        PARTS,
    ),
    row(
        "info a.nhdr",
        "list all its slices",
        None,
        {"a.nhdr": DETACHED.replace(b"0 1 1", b"0 2 1"), **PARTS, "a2.raw": b"1"},
        {"a.nhdr": DETACHED},
    ),
    damaged(
        "a.nrrd", PACKED, b"sizes: 2 2 2", b"sizes: 2 2 3", "its compressed samples end or break after 8 of 12 bytes"
    ),
    damaged(
        "a.nrrd",
        PACKED,
        b"sizes: 2 2 2",
        b"sizes: 2000 2000 3",
        "compressed ones cannot hold them; the file is truncated",
    ),
    damaged("a.nrrd", TEXT, b" 8", b"", "of 8 numbers; the file is truncated or damaged"),
    damaged("a.nrrd", TEXT, b" 8", b" 999", "the file is damaged or of another type, write it again"),
    damaged("a.nrrd", HEX, b"07", b"0g", "not a hexadecimal digit; write it again"),
    row(
        "info a.nrrd.gz",
        "unpack it with gunzip",
        "info a.nhdr",
        {"a.nrrd.gz": gzip.compress(DETACHED), **PARTS},
        {"a.nhdr": DETACHED},
    ),
    row(
        "info a.vtu.gz",
        "it is empty; write it again",
        None,
        {"a.vtu.gz": gzip.compress(b"")},
        {"a.vtu.gz": gzip.compress(TETRAHEDRON.encode())},
    ),
    cut("a.nrrd.gz", gzip.compress(NRRD * 3), 90, "its compressed bytes end or break"),
    row(
        "info a.vtu.gz",
        "hold more than 76 MiB, which is out of proportion; unpack it with gunzip",
        "info a.vtu",
        {"a.vtu.gz": gzip.compress(ROOMY.encode())},
        {"a.vtu": ROOMY},
    ),
    row(
        "info a.nrrd",
        "choose another field",
        None,
        {"a.nrrd": NRRD.replace(b"uint8", b"float").replace(SAMPLES, b"\0\0\xc0\x7f" * 8)},
        {"a.nrrd": NRRD},
    ),
    # MetaImage
    meta("MET_UCHAR", "MET_NONE", "write MET_UCHAR, MET_SHORT"),
    row(
        "info a.mha",
        "write them binary",
        None,
        {"a.mha": META_TEXT.replace(b"ElementType", b"CompressedData = True\nElementType")},
        {"a.mha": META},
    ),
    meta("ObjectType = Image", "ObjectType = Tube", "give a volume"),
    meta("NDims = 3", "NDims = 2", "a volume has three, or four with time"),
    meta("LOCAL", "b.raw", "put the file it names there"),
    row(
        "info a.mhd",
        "is for binary samples only",
        None,
        {
            "a.mhd": META_TEXT.replace(b"LOCAL\n", b"b.raw\n").replace(b"ElementType", b"HeaderSize = -1\nElementType"),
            "b.raw": b"1 2 3 4 5 6 7 8",
        },
        {"a.mhd": META_TEXT.replace(b"LOCAL\n", b"b.raw\n")},
    ),
    # NIfTI and Analyze
    nii(nifti((6, 2, 2, 2, 1, 1, 2)), "a volume has three, time and components, write one alone", SAMPLES * 2),
    nii(nifti((5, 2, 2, 2, 2, 2)), "write only one of the two, with at most 64 components", SAMPLES * 4),
    nii(nifti(datatype=32), "write integers or 32 or 64-bit floats"),
    nii(nifti((9, 2, 2, 2)), "the file is truncated or damaged, write it again"),
    nii(nifti((4, 2, 2, 2, 3)), ", of 3 steps, are"),
    row("info a.hdr", "put it next to the header", None, {"a.hdr": ANALYZE}, {"a.img": SAMPLES}),
    row("info a.img", "put it next to the samples", None, {"a.img": SAMPLES}, {"a.hdr": ANALYZE}),
    row(
        "info a.nrrd",
        "it does not begin as a nrrd does; check what it is",
        None,
        {"a.nrrd": b"?" * 400},
        {"a.nrrd": NRRD},
    ),
    row("info a", "lists them", "formats", {"a": "nothing known"}),
    # .raw
    row(
        "info b.raw --dims 2x2x2",
        "does not state its type; give --dims WxHxD --type uint8",
        "info b.raw --dims 2x2x2 --type uint8",
        {"b.raw": SAMPLES},
    ),
    row(
        "info b.raw --type uint8",
        "or name it NAME_WxHxD_uint8.raw",
        "info b_2x2x2_uint8.raw",
        {"b.raw": SAMPLES, "b_2x2x2_uint8.raw": SAMPLES},
    ),
    # writing
    row("convert a.vtr b.nrrd", "write .vtr or .bricks", "convert a.vtr b.vtr", {"a.vtr": UNEVEN}),
    row(
        "convert c.vti b.nrrd",
        "write .vti, .vtr or .bricks",
        "convert c.vti b.bricks",
        {"c.vti": IMAGE.replace("PointData", "CellData").replace("0 1 2 3 4 5 6 7", "7")},
    ),
    row(
        "convert a.nrrd b.raw",
        "write .vti, .nrrd or .bricks",
        "convert a.nrrd b.vti",
        {"a.nrrd": NRRD.replace(b"(1,0,0) (0,1,0)", b"(0,1,0) (-1,0,0)")},
    ),
    # fields and steps
    row("info m.vtu --field f:7", "use the name alone", "info m.vtu --field f"),
    row(
        "info a.nrrd --field samples:9",
        "use :mag or :0 to :1",
        "info a.nrrd --field samples:mag",
        {
            "a.nrrd": NRRD.replace(
                b"dimension: 3\nspace dimension: 3\nsizes: 2 2 2\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n"
                b"space origin: (0,0,0)",
                b"dimension: 4\nkinds: vector domain domain domain\nsizes: 2 2 2 2",
            )
            + SAMPLES
        },
    ),
    row("info m.vtu --field ff", "did you mean 'f'?", "info m.vtu --field f"),
    row(
        "render s.series -o a%d.png --size 16x16",
        "give volumes only",
        "render t.series -o a%d.png --size 16x16",
        {
            "s.series": '{"files": [{"name": "v.vti"}, {"name": "m.vtu"}]}',
            "t.series": '{"files": [{"name": "v.vti"}, {"name": "v.vti"}]}',
        },
    ),
    row(
        "render s.series -o a%d.png --size 16x16",
        "give it alone or among volumes",
        "info v.vti",
        {"s.series": '{"files": [{"name": "m.vtu"}, {"name": "v.vti"}]}'},
    ),
    row(
        "info n.vtu --field g",
        "the file has none; leave --field out",
        "info n.vtu",
        {
            "n.vtu": TETRAHEDRON.replace(
                '<DataArray type="Float64" Name="f" format="ascii">0 250 500 1000</DataArray>', ""
            )
        },
    ),
    row("info /dev/null", "give one that can be read twice", "info v.vti"),
    row(
        "info a.mha --field samples:mag",
        "choose one with --field samples:0",
        "info a.mha --field samples:0",
        {
            "a.mha": META.replace(
                b"ElementType", b"ElementNumberOfChannels = 2\nElementToIntensityFunctionOffset = 5\nElementType"
            )
            + SAMPLES
        },
    ),
    row(
        "info a.mha",
        "choose one with --field samples:0 (red)",
        "info a.mha --field samples:0",
        {"a.mha": META.replace(b"ElementType", b"ElementNumberOfChannels = 3\nElementType") + 2 * SAMPLES},
    ),
    row(
        "info b.raw --dims 2x2x2 --type uint8 --skip 1",
        "give the right dimensions and type",
        "info b.raw --dims 2x2x2 --type uint8",
        {"b.raw": SAMPLES},
    ),
    row(
        "info b.raw --dims 2x2x2 --type uint8",
        "or --skip 5 if a header is before them",
        "info b.raw --dims 2x2x2 --type uint8 --skip 5",
        {"b.raw": b"12345" + SAMPLES},
    ),
    row(
        "info b.raw", "does not state its dimensions and type", "info b.raw --dims 2x2x2 --type uint8", {"b.raw": SAMPLES}
    ),
]
