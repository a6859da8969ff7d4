# SPDX-License-Identifier: BSD-3-Clause
"""Rows of advice about outputs."""

import gzip

from advice_files import LEGACY, PLY, TETRAHEDRON, TETS
from advice_row import row

R = "render m.vtu -o a.png --size 16x16 "
V = "render v.vti -o a.png --size 16x16 "

# A fake ffmpeg in the directory, which stores its input, and the commands that its shell needs.
FFMPEG = {"PATH": ".:/usr/bin:/bin"}
FAKE_FFMPEG = {"ffmpeg": ("program", '#!/bin/sh\nfor last; do :; done\ncat > "$last"\n')}
VIEW = (
    '{{"position": [0, 0, 9], "focal_point": [0, 0, 0], "view_up": [0, 1, 0], "parallel_scale": 2, "size": [{0}, {0}]}}'
)
CAMERAS = f"[{VIEW.format(16)}, {VIEW.format(32)}]"

# As written by --report, with the entries that --like reads.
REPORT = (
    '{"method": {"blend": "linear", "emission": "absorption", "shade": false},'
    ' "mesh": {"field": {"name": "f", "association": "point"}, "fields": []},'
    ' "transfer_function": {"knots": [[0, 1, 0, 0, 1], [1, 0, 0, 1, 2]]},'
    ' "frames": [{"view": {"position": [0, 0, 9], "focal_point": [0, 0, 0], "view_up": [0, 1, 0],'
    ' "parallel_scale": 2, "size": [16, 16]}}]}'
)

BROKEN = "#!/bin/sh\nexit 1\n"

ROWS = [
    # output files
    row("render m.vtu -o a.bmp", "end it in .exr, .png", R),
    row(
        "render m.vtu -o nowhere/a.png",
        "make the directory first, or name another",
        "render m.vtu -o folder/a.png",
        {"folder/": "", "folder.png/": ""},
    ),
    row(
        "render m.vtu -o folder.png",
        "name a file, not a directory",
        "render m.vtu -o folder/a.png",
        {"folder/": "", "folder.png/": ""},
    ),
    row("render m.vtu -o - -o -", "give it once", "render m.vtu -o - --size 9x9"),
    row(R + "-o - --report -", "give one of them a file", R + "-o - --report r.json"),
    row(R + "-o - --resume", "leave it out", R + "-o -"),
    row(R + "--frame-rate 25", "or leave it out", R),
    row(R + "--outline --annotation-layer l.jpg", "name a .png or an .exr", R + "--outline --annotation-layer l.png"),
    row("convert m.vtu a.xyz", "choose .vtu or .tets", "convert m.vtu a.tets"),
    row("convert v.vti a.png", "choose .vti, .vtr, .nrrd", "convert v.vti a.nrrd"),
    row("convert v.vti a.vti --clip 0,0,0,1,0,0", "leave it out", "convert v.vti a.vti"),
    row("convert m.vtu m.vtu", "choose another name", "convert m.vtu b.vtu"),
    row(
        R + "--config c.toml --report link.json",
        "is an input of this run and would be overwritten; choose another name",
        R + "--config c.toml --report r.json",
        {"c.toml": "opacity = 2\n", "link.json": ("link", "c.toml")},
    ),
    row(
        R + "--like like.json",
        "give a file that --report has written",
        R + "--like r.json",
        {"like.json": '{"frames": 1}'},
        {"r.json": REPORT},
    ),
    row(
        R + "--like like.json",
        "no frame was rendered; give another report",
        R + "--like r.json",
        {"like.json": REPORT.replace("[{", "[], \"more\": [{")},
        {"r.json": REPORT},
    ),
    row(R, "ulimit -s 8192", R, {}, {"any": ""}, limits="ulimit -s 256"),
    row(
        "convert m.vtu b.pvtu --pieces 2 --partition best",
        "use curve, file or random",
        "convert m.vtu b.pvtu --pieces 2 --partition random",
    ),
    row(
        "convert m.vtu b.vtu --partition file",
        "give their number too",
        "convert m.vtu b.pvtu --partition file --pieces 2",
    ),
    row("generate cube b.vtu n", "write NAME=VALUE", "generate cube b.vtu n=2"),
    row("generate cube b.vtu n=2 n=3", "give it once", "generate cube b.vtu n=3"),
    row("chart m.vtu -o a.png", "see tessera chart --help", "chart --help"),
    row(
        "render m.vtu -o a.mp4 --peel 0.5 --size 16x16",
        "name images, as -o a_%04d.png",
        "render m.vtu -o a_%04d.png --peel 0.5 --size 16x16",
    ),
    row("render m.vtu -o - --peel 0.5 --size 16x16", "name a file with -o", "render m.vtu -o a.png --peel 0.5 --size 9x9"),
    # a film without ffmpeg: an image sequence instead
    row("render m.vtu -o a.mp4 --size 16x16", "write a_%04d.png", "render m.vtu -o a_%04d.png --size 16x16"),
    row("render m.vtu -o a_%04d.mp4 --size 16x16", "write a_%04d.png", "render m.vtu -o a_%04d.png --size 16x16"),
    row(
        "render m.vtu -o a.mp4 --orbit 2 --size 16x16",
        "write a_%04d.png",
        "render m.vtu -o a_%04d.png --orbit 2 --size 16x16",
    ),
    row(
        "render m.vtu -o a.gif --size 16x16 --resume",
        "leave it out, or write numbered images",
        "render m.vtu -o a_%04d.png --orbit 2 --size 16x16 --resume",
    ),
    row(
        "render m.vtu -o a.gif --size 16x16 --frame-rate 2000",
        "is above 1000; give fewer",
        "render m.vtu -o a.gif --size 16x16 --frame-rate 20",
        FAKE_FFMPEG,
        env=FFMPEG,
    ),
    row(
        "render m.vtu -o a.gif --size 16x16 --frame-rate 1e-300",
        "is below 0.01; give more",
        "render m.vtu -o a.gif --size 16x16 --frame-rate 0.01",
        FAKE_FFMPEG,
        env=FFMPEG,
    ),
    row(
        "render m.vtu -o a.gif --camera cc.json",
        "use --size",
        "render m.vtu -o a.gif --camera cc.json --size 16x16",
        {"cc.json": CAMERAS, **FAKE_FFMPEG},
        env=FFMPEG,
    ),
    row("convert v.vti w.raw", "read it with --dims 8x8x8 --type", "info w.raw --dims 8x8x8 --type float32"),
    row("render m.vtu -o a.deep.exr --size 16x16 --integrator sampled:4 --outline", "name an .exr", R + "--outline"),
    row(f"render m.vtu -o {'n' * 300}.png --size 16x16", "give a shorter name", R),
    row("render m.vtu -o /sys/a.png --size 16x16", "name a directory you may write in", R),
    # disks, directories and films
    row("render m.vtu -o loop/a.png --size 16x16", "check the disk and the file system", R, {"loop": ("link", "loop")}),
    row(
        "convert m.tets b.tets",
        "free some space or name another disk",
        "convert m.tets b.tets",
        {"m.tets": TETS},
        limits="trap '' XFSZ; ulimit -f 0",
    ),
    row(
        "render m.vtu -o a.gif --size 16x16",
        "or write a_%04d.png",
        "render m.vtu -o a_%04d.png --size 16x16",
        {"bin/ffmpeg": ("program", BROKEN)},
        env={"PATH": "bin"},
    ),
    row(
        "render m.vtu -o a.exr --size 16x16 --half --background 1e6,0,0",
        "write float",
        "render m.vtu -o a.exr --size 16x16 --background 1e6,0,0",
    ),
    row(
        "render m.vtu -o a.jpg --size 65536x1 --threads 2",
        "write .png",
        "render m.vtu -o a.png --size 65536x1 --threads 2",
    ),
    row(
        "info a.vtk",
        "memory ran out; use a larger machine or a part of the mesh",
        "info a.vtk",
        {"a.vtk": LEGACY},
        {"a.vtk": LEGACY},
        limits="trap '' XFSZ; ulimit -f 0",
    ),
    row(
        "info m.vtu.gz",
        "memory ran out; use a larger machine or a part of the data",
        "info m.vtu.gz",
        {"m.vtu.gz": gzip.compress(TETRAHEDRON.encode())},
        limits="trap '' XFSZ; ulimit -f 0",
    ),
    # the program without its helpers, or with one that does not run
    row("info g.vtk", "install it", None, {"g.vtk": LEGACY}, {"x": ""}, alone=True),
    row(
        "info g.vtk",
        "install it with the library",
        "info g.vtk",
        {"g.vtk": LEGACY, "alone/libexec/tessera/tessera-read-vtk": ("program", "no program\n")},
        alone=True,
    ),
    row("info s.ply", "or give a mesh of tetrahedra", "info m.tets", {"s.ply": PLY, "m.tets": TETS}, alone=True),
    row(
        "info g.vtk",
        "check that it runs, and give it more memory",
        "info g.vtk",
        {"g.vtk": LEGACY, "alone/libexec/tessera/tessera-read-vtk": ("program", BROKEN)},
        alone=True,
    ),
]
