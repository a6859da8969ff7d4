#!/usr/bin/env python3
"""Every command of docs/GUIDE.md does what it says: it ends with status 0, on data made here.

Commands are the indented lines that begin with `tessera`, in their order, in one folder. Pictures are made small and
charts in little time; those of the lines below are left out, with the reason. Says each that fails; exit status 1 if one
does.

    guide.py --tessera PROGRAM --source SOURCE_TREE
"""

import argparse
import gzip
import json
import os
import shlex
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

LEFT_OUT = {
    "can.ex2": "an Exodus file, which nothing here writes",
    "--backend": "needs OpenGL",
    "1.json 2.json 4.json": "traces of three machines",
}
SMALL = ["--size", "64x48"]


def make_data(folder: Path, source: Path):
    (folder / "datasets").symlink_to(source / "datasets")
    view = {"position": [5, -40, 12], "focal_point": [5, 0, 0], "view_up": [0, 0, 1], "parallel_scale": 5}
    (folder / "view.json").write_text(json.dumps(view))
    (folder / "path.json").write_text(json.dumps([view, {**view, "position": [15, -40, 12]}]))
    # NIfTI-1: 16-bit samples, one millimetre apart.
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, 16, 16, 16, 1, 1, 1, 1)
    struct.pack_into("<2h", header, 70, 4, 16)
    struct.pack_into("<8f", header, 76, 1, 1, 1, 1, 1, 1, 1, 1)
    struct.pack_into("<f", header, 108, 352)
    header[344:348] = b"n+1\0"
    samples = [x * x + y * y + z * z for z in range(16) for y in range(16) for x in range(16)]
    (folder / "head.nii.gz").write_bytes(gzip.compress(bytes(header) + struct.pack(f"<{len(samples)}h", *samples)))
    (folder / "engine_256x256x128_uint8.raw").write_bytes(bytes(range(256)) * (256 * 128))
    vectors = " ".join(f"{x} {y} {z}" for z in range(4) for y in range(4) for x in range(4))
    (folder / "flow.vti").write_text(
        '<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian"><ImageData WholeExtent="0 3 0 3 0 3" '
        'Origin="0 0 0" Spacing="1 1 1"><Piece Extent="0 3 0 3 0 3"><PointData><DataArray type="Float32" '
        f'Name="Velocity" NumberOfComponents="3" format="ascii">{vectors}</DataArray></PointData></Piece></ImageData>'
        "</VTKFile>"
    )
    # In the place of ffmpeg, which need not be installed: takes the pictures.
    (folder / "bin").mkdir()
    ffmpeg = folder / "bin/ffmpeg"
    ffmpeg.write_text('#!/bin/sh\nfor last; do :; done\nexec cat > "$last"\n')
    ffmpeg.chmod(0o755)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--tessera", required=True)
    parser.add_argument("--source", type=lambda name: Path(name).resolve(), required=True)
    options = parser.parse_args()
    failed = ran = left = 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        make_data(folder, options.source)
        environment = {**os.environ, "PATH": f"{folder}/bin:{os.environ['PATH']}"}
        guide = (options.source / "docs/GUIDE.md").read_text().splitlines()
        # Files that other sections make come first.
        commands = [(0, ["tessera", "generate", "cube", "cube.vtu", "n=4"])]
        for number, line in enumerate(guide, 1):
            if line.startswith("    tessera "):
                if any(words in line for words in LEFT_OUT):
                    left += 1
                else:
                    # A shell begins a comment at a # only after a blank, Python's everywhere.
                    commands.append((number, shlex.split(line.split(" # ")[0])))
        for number, words in commands:
            if words[1] == "render" and "--size" not in words:
                words = words + SMALL
            if words[1] == "chart":
                words[words.index("--budget-seconds") + 1] = "1"
            try:
                done = subprocess.run([options.tessera, *words[1:]], cwd=folder, env=environment, timeout=100,
                                      stdin=subprocess.DEVNULL, capture_output=True)
                status, said = done.returncode, done.stderr.decode(errors="replace")
            except subprocess.TimeoutExpired:
                status, said = "none", "takes longer than 100 s"
            ran += 1
            if status != 0:
                failed += 1
                print(f"docs/GUIDE.md:{number}: {' '.join(words)}\n  status {status}: {said.strip()}")
    print(f"{ran} commands, {failed} failed, {left} left out")
    sys.exit(1 if failed or ran < 30 else 0)


if __name__ == "__main__":
    main()
