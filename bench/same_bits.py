#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Renders the same scenes with two programs and compares the images to the bit: colours, opacity and depth.

    bench/same_bits.py --old PROGRAM --new PROGRAM [--seed 1] [--only meshes,grids,large,ranks,device] [--threads 2]
        [--keep FOLDER]

For changes that must not change an image. Scenes are derived from a seed, so that they can be reproduced:

  meshes  126 random views and transfer functions of nine meshes, point and cell data, alternating `exact`, `auto` and others
  grids   60 random views of six grids (8, 16, 32 bits, point and cell data, rectilinear), alternating every method
  large   ten images of 1024 x 1024: few, many and opaque knots, perspective, independent emission, small cells
  ranks   18 of the meshes' views, and 6 of the grids', on two and three ranks (`--exchange segments`); needs mpirun
  device  6 of the meshes' views through `--compositor gl-compute` and gl-fragment on OSMesa

Prints differences, with the number of pixels and the largest difference, and exits with status 1 if there are any. The
old program reads the same files as the new one; both take their threads from `--threads`.
"""
import argparse
import array
import os
import pathlib
import random
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE / "stability"))
from promise_cases import any_scenes, files
from results import MPI, knots_of, written

MESHES = [("cube", "n=10"), ("cube", "n=9", "cell_data=1"), ("regular", "nx=12", "ny=8", "nz=10"), ("graded", "n=12", "volume_ratio=1e8"),
          ("slivers", "n=6", "aspect=1e6"), ("annulus", "n=32", "seam=1"), ("shells", "count=3"), ("bars", "n=12", "inverted=2"),
          ("ball", "levels=3")]
VIEWS = 14  # per mesh
MESH_METHODS = [["--integrator", "exact"], [], ["--integrator", "exact"], ["--accuracy", "1e-6"], ["--integrator", "sampled:4"],
                ["--without", "lattice"], ["--integrator", "partial"]]
GRID_METHODS = [["--integrator", "exact"], [], ["--accuracy", "1e-6"], ["--integrator", "sampled"], ["--integrator", "preintegrated"], ["--shade"]]
LARGE = [("cube", ["n=64"], "figures", []), ("cube", ["n=64"], "figures", ["--integrator", "exact"]), ("cube", ["n=64"], "opaque", []),
         ("cube", ["n=64"], "14 knots", []), ("cube", ["n=64"], "64 knots", []), ("cube", ["n=64"], "256 knots", []),
         ("cube", ["n=64"], "figures", ["perspective"]), ("cube", ["n=64"], "figures", ["--emission", "independent"]),
         ("graded", ["n=64"], "figures", []), ("cube", ["n=48", "cell_data=6"], "figures", [])]


def large_function(name):
    if name == "figures":
        return knots_of(HERE / "transfer_function.txt")
    if name == "opaque":
        return [(*k[:4], 40 * k[4] + 20) for k in knots_of(HERE / "transfer_function.txt")]
    count, r = int(name.split()[0]), random.Random(name)
    return [(i / (count - 1), r.random(), r.random(), r.random(), 5 * r.random()) for i in range(count)]


class Comparison:
    def __init__(self, args, folder):
        self.args, self.folder = args, folder
        self.drawn, self.different = 0, 0

    def generate(self, kind, words, ending):
        path = self.folder / ("-".join([kind, *words]).replace("=", "") + ending)
        if not path.exists():
            subprocess.run([self.args.old, "generate", kind, path, *words, "--quiet"], check=True, capture_output=True)
        return path

    def function(self, knots):
        return written(self.folder / "function.txt", "".join(" ".join(repr(float(x)) for x in k) + "\n" for k in knots))

    def random_view(self, r):
        """Words of `tessera render` for a random function and camera."""
        return ["--transfer-function", self.function(any_scenes.transfer_function(r, 0.0, 1.0)), "--camera",
                written(self.folder / "camera.txt", any_scenes.camera(r, r.choice([48, 96, 160])))]

    def draw(self, program, name, words, ranks):
        pictures = [self.folder / f"{name}.exr", self.folder / f"{name}.pfm"]
        launcher = ["mpirun", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
        command = [*launcher, program, "render", *words, "-o", pictures[0], "-o", pictures[1], "--threads", self.args.threads, "--quiet"]
        done = subprocess.run([str(w) for w in command], capture_output=True, text=True, env=os.environ | MPI)
        if done.returncode != 0:
            return f"status {done.returncode}: {done.stderr.strip().splitlines()[-1:]}", command
        return pictures, command

    def compare(self, what, words, ranks=1):
        self.drawn += 1
        old, _ = self.draw(self.args.old, "old", words, ranks)
        new, command = self.draw(self.args.new, "new", words, ranks)
        if isinstance(old, str) or isinstance(new, str):
            # A scene that both versions refuse cannot be compared; scenes are made so that none is refused.
            said = f"old: {old if isinstance(old, str) else 'drawn'}; new: {new if isinstance(new, str) else 'drawn'}"
        elif all(a.read_bytes() == b.read_bytes() for a, b in zip(old, new)):
            return
        else:
            a, b = (array.array("f", p[1].read_bytes().split(b"\n", 3)[3]) for p in (old, new))
            apart = [abs(x - y) for x, y in zip(a, b) if x != y]
            said = f"{len(apart)} of {len(a)} colour values differ, by {max(apart, default=0):.3g} at most (opacity and depth are in the .exr)"
        self.different += 1
        print(f"DIFFERENT: {what}: {said}\n  {' '.join(map(str, command))}", flush=True)

    def mesh_view(self, mesh, view):
        """Arguments of `tessera render` for one view of a mesh."""
        kind, *parameters = MESHES[mesh]
        r = random.Random(f"{self.args.seed}/mesh/{mesh}/{view}")
        return [self.generate(kind, parameters, ".vtu"), *self.random_view(r)]

    def meshes(self):
        for mesh in range(len(MESHES)):
            for view in range(VIEWS):
                words = self.mesh_view(mesh, view) + MESH_METHODS[view % len(MESH_METHODS)]
                self.compare(f"mesh {' '.join(MESHES[mesh])}, view {view}", words)

    def grid_inputs(self):
        inputs = [self.generate("ripples", [f"n={n}", f"bits={bits}"], ".vti") for n, bits in ((40, 8), (33, 16), (48, 32))]
        inputs.append(self.generate("checker", ["n=9"], ".vti"))
        r = random.Random("grid inputs")
        axis = lambda: [-1.0] + sorted(r.uniform(-1, 1) for _ in range(14)) + [1.0]
        inputs.append(files.write_vtr(self.folder / "uneven.vtr", [axis(), axis(), axis()], [r.random() for _ in range(16 ** 3)]))
        inputs.append(files.write_vti(self.folder / "cells.vti", (21, 21, 21), [r.random() for _ in range(20 ** 3)], "cell", "Float32",
                                      (0.1, 0.1, 0.1), (-1, -1, -1)))
        return inputs

    def grid_view(self, inputs, grid, view):
        r = random.Random(f"{self.args.seed}/grid/{grid}/{view}")
        return [inputs[grid], *self.random_view(r), "--brick-size", r.choice([5, 32])]

    def grids(self):
        inputs = self.grid_inputs()
        for grid, path in enumerate(inputs):
            for view in range(10):
                method = GRID_METHODS[view % len(GRID_METHODS)]
                if path.suffix == ".vtr" and method in (["--shade"], ["--integrator", "sampled"], ["--integrator", "preintegrated"]):
                    method = []  # not supported for rectilinear grids
                self.compare(f"grid {path.name}, view {view}", self.grid_view(inputs, grid, view) + method)

    def large(self):
        for kind, parameters, function, words in LARGE:
            camera = (HERE / "camera.txt").read_text()
            if "perspective" in words:
                camera, words = camera.replace("parallel_scale 1.8", "view_angle 36"), []
            self.compare(f"large {kind} {' '.join(parameters)}, {function} {' '.join(words)}",
                         [self.generate(kind, parameters, ".vtu" if "cell_data" in str(parameters) else ".tets"), "--camera", written(self.folder / "camera.txt", camera), "--transfer-function",
                          self.function(large_function(function)), *words])

    def ranks(self):
        for mesh in range(len(MESHES)):
            for view, count in ((0, 2), (1, 3)):
                self.compare(f"mesh {' '.join(MESHES[mesh])}, view {view}, {count} ranks",
                             self.mesh_view(mesh, view) + ["--exchange", "segments"], count)
        inputs = self.grid_inputs()
        for grid in range(len(inputs)):
            self.compare(f"grid {inputs[grid].name}, 3 ranks", self.grid_view(inputs, grid, 0), 3)

    def device(self):
        for mesh, compositor in ((0, "gl-compute"), (1, "gl-compute"), (3, "gl-compute"), (0, "gl-fragment"), (5, "gl-fragment"), (6, "gl-fragment")):
            more = ["--integrator", "sampled:4"] if compositor == "gl-fragment" else ["--integrator", "exact"]
            self.compare(f"mesh {' '.join(MESHES[mesh])}, {compositor}",
                         self.mesh_view(mesh, 2) + ["--compositor", compositor, "--backend", "osmesa", *more])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--old", required=True, type=pathlib.Path)
    parser.add_argument("--new", required=True, type=pathlib.Path)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--only", default="meshes,grids,large,ranks,device")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for inputs and the last pictures")
    args = parser.parse_args()
    args.old, args.new = args.old.resolve(), args.new.resolve()
    parts = args.only.split(",")
    unknown = set(parts) - {"meshes", "grids", "large", "ranks", "device"}
    if unknown:
        parser.error(f"--only {','.join(sorted(unknown))}: no such part")
    total, different = 0, 0
    with tempfile.TemporaryDirectory() as scratch:
        folder = args.keep or pathlib.Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        for part in parts:
            comparison = Comparison(args, folder)
            getattr(comparison, part)()
            print(f"{part}: {comparison.drawn} pictures, {comparison.different} different", flush=True)
            total, different = total + comparison.drawn, different + comparison.different
    print(f"{total} pictures, {different} different")
    sys.exit(1 if different else 0)


if __name__ == "__main__":
    main()
