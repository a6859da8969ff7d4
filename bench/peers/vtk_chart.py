#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""`tessera chart` with VTK's ray casters in it: the same data, view and transfer function, timed and judged in the same way.

    xvfb-run -a /usr/bin/python3 bench/peers/vtk_chart.py INPUT [words of tessera chart] [--tessera PROGRAM]
        [--peer-seconds 60] [--peer-threads T] [--keep FOLDER]

Asks Tessera for the view and the knots specified by the arguments, makes it write INPUT as plain tets (.vtu) or samples (.vti),
renders these with VTK (vtk_raycast.py), and finally runs `tessera chart` with all arguments and the peers. Meshes:
vtkUnstructuredGridVolumeRayCastMapper (Bunyk) with each of its integrators, and vtkUnstructuredGridVolumeZSweepMapper.
Grids: vtkFixedPointVolumeRayCastMapper at steps of 2 to 1/8 voxel. Each in a separate process, because VTK may crash or
take very long: a run that does not end within its share of --peer-seconds (or five times that, for its first frame) is reported
as left out. Needs python3-vtk9, python3-numpy and a display (xvfb-run).
"""
import argparse
import json
import multiprocessing
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import vtk

import vtk_raycast

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
MESHES = [("bunyk", "partial"), ("bunyk", "full"), ("bunyk", "linear"), ("bunyk", "homogeneous"), ("zsweep", "partial")]
STEPS = [1.0, 0.5, 2.0, 0.25, 0.125]


def tessera(args, *words):
    done = subprocess.run([str(args.tessera), *map(str, words)], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"vtk_chart.py: tessera {' '.join(map(str, words))}\n{done.stderr.strip()}")


def measured(render, seconds, picture):
    """frame_ms of render(), after writing its image; or why there is none."""
    here, there = multiprocessing.get_context("fork").Pipe(duplex=False)

    def work():
        rgb, first, rest = render()
        vtk_raycast.write_pfm(picture, rgb)
        there.send([1e3 * s for s in rest or [first]])
        os._exit(0)  # skips the destructors of VTK's windows

    child = multiprocessing.get_context("fork").Process(target=work)
    child.start()
    there.close()
    try:
        if here.poll(5 * seconds):
            return {"frame_ms": here.recv(), "picture": str(picture)}
    except EOFError:
        child.join()
        return {"left_out": f"VTK crashed (status {child.exitcode})"}
    finally:
        child.kill()
    return {"left_out": f"no picture within {5 * seconds:.0f} s; raise --peer-seconds"}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
                                     allow_abbrev=False)
    parser.add_argument("input")
    parser.add_argument("--tessera", type=pathlib.Path, default=ROOT / "build/release/apps/tessera")
    parser.add_argument("--peer-seconds", type=float, default=60)
    parser.add_argument("--peer-threads", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--keep", type=pathlib.Path, help="folder for VTK's pictures and times, peers.json")
    chart_only = [("--figure", "append"), ("--json", "store"), ("--csv", "store"), ("--budget-seconds", "store"),
                  ("--repeat", "store"), ("--pixels", "store"), ("--peer", "append")]
    for word, action in chart_only:
        parser.add_argument(word, action=action)
    data_words = ["--field", "--q", "--max-volume", "--time-step", "--dims", "--type", "--spacing", "--origin", "--endian", "--skip"]
    for word in data_words:
        parser.add_argument(word)
    parser.add_argument("--smooth", action="store_true")
    args, scene_words = parser.parse_known_args()
    value = lambda word: getattr(args, word[2:].replace("-", "_"))
    data = [w for word in data_words if value(word) is not None for w in (word, value(word))] + ["--smooth"] * args.smooth
    chart = [w for word, _ in chart_only if value(word) is not None
             for v in (value(word) if isinstance(value(word), list) else [value(word)]) for w in (word, v)]

    with tempfile.TemporaryDirectory() as scratch:
        folder = (args.keep or pathlib.Path(scratch)).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        render_words = [w for w in scene_words if w != "--quiet"]
        tessera(args, "render", args.input, *data, *render_words, "-o", folder / "tessera.pfm", "--report", folder / "scene.json", "--quiet")
        scene = json.loads((folder / "scene.json").read_text())
        if scene["method"]["emission"] != "absorption":
            sys.exit("vtk_chart.py: VTK supports emission by absorption only")
        camera = vtk_raycast.camera_of(scene["frames"][0]["view"])
        knots = scene["transfer_function"]["knots"]
        repeat = int(args.repeat or 5)
        family = f"VTK {vtk.VTK_VERSION}"
        if "mesh" in scene:
            tessera(args, "convert", args.input, folder / "tets.vtu", *data, "--quiet")
            on_cells = scene["mesh"]["field"]["association"] == "cell"
            grid = vtk_raycast.without_flat(vtk_raycast.read_mesh(str(folder / "tets.vtu")), on_cells)
            share = args.peer_seconds / len(MESHES)
            word = {"bunyk": "Bunyk", "zsweep": "ZSweep"}
            methods = [(f"{family} {word[c]}, {i}", f"VTK {word[c]}, {i}",
                        lambda c=c, i=i: vtk_raycast.render(grid, camera, knots, i, repeat, args.peer_threads, on_cells, c, share))
                       for c, i in MESHES]
        else:
            tessera(args, "convert", args.input, folder / "samples.vti", *data, "--quiet")
            image = vtk_raycast.read_grid(folder / "samples.vti")
            share = args.peer_seconds / len(STEPS)
            methods = [(f"{family} fixed point", f"VTK fixed point, step {s:g}",
                        lambda s=s: vtk_raycast.render_grid(image, camera, knots, s, repeat, args.peer_threads, share)) for s in STEPS]
        peers = []
        for number, (group, name, render) in enumerate(methods):
            peers.append({"family": group, "name": name, **measured(render, share, folder / f"peer-{number}.pfm")})
            print(json.dumps(peers[-1]), file=sys.stderr, flush=True)
        if "volume" in scene:
            peers.sort(key=lambda p: float(p["name"].split()[-1]))  # the figure joins a family's points in this order
        (folder / "peers.json").write_text(json.dumps(peers, indent=1) + "\n")
        done = subprocess.run([str(args.tessera), "chart", args.input, *data, *scene_words, *chart, "--peer", str(folder / "peers.json")])
    sys.exit(done.returncode)


if __name__ == "__main__":
    main()
