#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Every command of docs/GUIDE.md and docs/REFERENCE.md works as described: it ends with status 0, on data made here.

Commands are the indented lines of these pages that begin with a program's name (and Python between fences), executed by a
shell without changes, page after page in one directory. Only the initial mesh and the images are small, and
charts get little time. Commands that need missing programs are left out, with the reason. Reports each that fails; exit status 1 if
one does.

    guide.py --tessera PROGRAM --source SOURCE_TREE [--whole] [--without-mpi] [--page GUIDE.md]

--whole makes mesh, images and charts as stated in the pages.
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import guide_files

PAGES = ("docs/GUIDE.md", "docs/REFERENCE.md")
LEFT_OUT = {
    "nozzle.cgns": "a CGNS file, which is HDF5 and nothing here writes",
    "srun": "needs Slurm",
    "tessera serve": "waits for browsers",
    "--backend": "needs OpenGL",
    "1.json 2.json 4.json": "traces of three machines",
}
BEGINNINGS = ("tessera ", "mpirun ", "srun ", "for ")


def make_data(folder: Path, source: Path):
    (folder / "datasets").symlink_to(source / "datasets")
    view = {"position": [5, -40, 12], "focal_point": [5, 0, 0], "view_up": [0, 0, 1], "parallel_scale": 5}
    (folder / "view.json").write_text(json.dumps(view))
    (folder / "path.json").write_text(json.dumps([view, {**view, "position": [15, -40, 12]}]))
    cubes = guide_files.Cubes(6)
    guide_files.foam_case(folder / "cavity", cubes)
    guide_files.gmsh_mesh(folder / "part.msh", cubes)
    guide_files.stl_surface(folder / "part.stl", cubes)
    guide_files.exodus_mesh(folder / "can.ex2", cubes)
    guide_files.dicom_series(folder / "scan", 16)
    guide_files.nifti_volume(folder / "head.nii.gz", 32)
    guide_files.nifti_volume(folder / "beating.nii.gz", 16, times=3)
    guide_files.vector_volume(folder / "flow.vti")
    for name in ("engine_256x256x128_uint8.raw", "engine.raw"):
        (folder / name).write_bytes(bytes(range(256)) * (256 * 128))


def make_programs(folder: Path, tessera: str):
    """A directory for PATH; if ffmpeg is not installed, with a replacement that accepts the images."""
    (folder / "bin").mkdir()
    (folder / "bin/tessera").symlink_to(tessera)
    if shutil.which("ffmpeg") is None:
        ffmpeg = folder / "bin/ffmpeg"
        ffmpeg.write_text('#!/bin/sh\nfor last; do :; done\nexec cat > "$last"\n')
        ffmpeg.chmod(0o755)


def commands(page: Path):
    """Line number and text of each; Python also as such a text."""
    fenced = None
    for number, line in enumerate(page.read_text().splitlines(), 1):
        if fenced is not None:
            if line.startswith("```"):
                yield number - len(fenced), "python3 - <<'END'\n" + "\n".join(fenced) + "\nEND"
                fenced = None
            else:
                fenced.append(line)
        elif line.startswith("```python"):
            fenced = []
        elif line.startswith("    ") and line[4:].startswith(BEGINNINGS):
            yield number, line.strip()


def made_shorter(text: str):
    text = text.replace("generate demo wake.vtu", "generate demo wake.vtu resolution=0.25")
    text = re.sub(r"\bn=256", "n=64", text)
    text = re.sub(r"--budget-seconds \d+", "--budget-seconds 1", text)
    if "--size " not in text:
        return text.replace("tessera render ", "tessera render --size 128x128 ")
    return re.sub(r"--size (\d+)x(\d+)", lambda m: f"--size {max(64, int(m[1]) // 4)}x{max(64, int(m[2]) // 4)}", text)


def why_left_out(text: str, has_mpi: bool):
    if text.startswith("mpirun ") and not has_mpi:
        return "needs MPI"
    return next((reason for words, reason in LEFT_OUT.items() if words in text), None)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--tessera", type=os.path.abspath, required=True)
    parser.add_argument("--source", type=lambda name: Path(name).resolve(), required=True)
    parser.add_argument("--whole", action="store_true")
    parser.add_argument("--page", default="")
    parser.add_argument("--without-mpi", action="store_true")
    options = parser.parse_args()
    has_mpi = not options.without_mpi and shutil.which("mpirun") is not None
    failed = ran = left = 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        make_data(folder, options.source)
        make_programs(folder, options.tessera)
        # mpirun must be allowed to run as root, and with more processes than cores.
        environment = {**os.environ, "PATH": f"{folder}/bin:{os.environ['PATH']}", "OMPI_ALLOW_RUN_AS_ROOT": "1",
                       "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1"}
        # Files that other sections create, or that represent many.
        todo = [("here", k, text) for k, text in enumerate(
            ["tessera generate cube cube.vtu n=4", "tessera generate cube mesh_0000.vtu n=4",
             "tessera generate cube mesh_0001.vtu n=4 offset=0.5"])]
        for page in PAGES if not options.page else [f"docs/{options.page}"]:
            todo += [(page, number, text) for number, text in commands(options.source / page)]
        for page, number, text in todo:
            if why_left_out(text, has_mpi):
                left += 1
                continue
            if not options.whole:
                text = made_shorter(text)
            began = time.monotonic()
            try:
                done = subprocess.run(["bash", "-c", text], cwd=folder, env=environment, timeout=900,
                                      stdin=subprocess.DEVNULL, capture_output=True)
                status, said = done.returncode, done.stderr.decode(errors="replace")
            except subprocess.TimeoutExpired:
                status, said = "none", "takes longer than 900 s"
            # The program reports which parts this build lacks.
            if status == 2 and "this build" in said:
                left += 1
                continue
            ran += 1
            if time.monotonic() - began > 20:
                print(f"{page}:{number}: {text}\n  took {time.monotonic() - began:.0f} s", flush=True)
            if status != 0:
                failed += 1
                print(f"{page}:{number}: {text}\n  status {status}: {said.strip()}", flush=True)
    print(f"{ran} commands, {failed} failed, {left} left out")
    sys.exit(1 if failed or ran < 50 else 0)


if __name__ == "__main__":
    main()
