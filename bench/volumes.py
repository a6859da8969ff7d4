#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Times `tessera render` of regular grids compared with VTK's fixed-point ray caster: same volume, view, transfer function, run.

    bench/volumes.py [--tessera build/release/apps/tessera] [--data FOLDER] [--rounds 3] [--repeat 5] [--threads 2]
                     [--size N] [--verify 100] [--no-vtk] [--mechanisms] [--only NAME] [--results docs/RESULTS.md]

Makes `tessera generate ripples n=256` in float and 8-bit samples (view and transfer function of all performance figures);
FOLDER of --data may contain heptane.nii.gz and LIDC2.vti, which get their default view and a function that shows only the top
of their range. Rounds alternate over all renderers, so that all have the same conditions; a time is the minimum of
all rounds' frames, followed by the median. Errors: Tessera's against the double-precision reference at --verify random
pixels, VTK's against Tessera's `exact` image, all pixels, linear RGB. VTK (python3-vtk9, under xvfb-run) uses steps
of one voxel. A row per measurement goes to standard output; the results file gets a row per volume, in its own section,
replaced by the next run.

With --mechanisms, instead: what culling of bricks, skipping of empty space and early termination save at the default
accuracy (each disabled by `--without`, and all of them), and what `--shade` costs, with the functions unchanged and 50
times as opaque. CPU time of all threads is the minimum of the rounds' last frames: other load on the machine has little effect. No VTK.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

import results_file

HERE = pathlib.Path(__file__).resolve().parent
METHODS = [("--accuracy", "1e-3"), ("--accuracy", "1e-4"), ("--accuracy", "1e-5"), ("--integrator", "exact")]
VARIATIONS = [(), ("--without", "culling"), ("--without", "skipping"), ("--without", "culling,skipping"), ("--without", "termination"),
              ("--without", "culling,skipping,termination"), ("--shade",)]


def run(command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode not in (0, 4):
        sys.exit(f"volumes.py: {' '.join(str(c) for c in command)}\n{done.stderr.strip()}")
    return done


def peer(volume, view, knots, threads, repeat, exact):
    """The VTK side, in a separate process under xvfb-run."""
    sys.path.insert(0, str(HERE / "peers"))
    import vtk_chart
    import vtk_raycast
    camera = {k: v if isinstance(v, list) else [v] for k, v in json.loads(view).items()}
    pixels, _, seconds = vtk_raycast.render_grid(vtk_chart.image_of(volume), camera, json.loads(knots), 1.0, repeat, threads)
    error = abs(pixels - vtk_raycast.read_pfm(exact)).max()
    print(json.dumps([[1e3 * s for s in seconds], float(error)]))


def volumes(args, folder):
    """Name, file, arguments for view and transfer function."""
    for kind, bits in (("float", 32), ("8-bit", 8)):
        path = folder / f"ripples{bits}.nrrd"
        run([args.tessera, "generate", "ripples", path, f"n={args.size}", f"bits={bits}"])
        words = ["--camera", HERE / "camera.txt"]
        function = HERE / "transfer_function.txt"
        if bits == 8:
            function = folder / "function8.txt"
            lines = [l.split() for l in (HERE / "transfer_function.txt").read_text().splitlines() if l and l[0] != "#"]
            function.write_text("".join(f"{255 * float(l[0])} {' '.join(l[1:])}\n" for l in lines))
        if args.only in f"ripples {args.size}^3 {kind}":
            yield f"ripples {args.size}^3 {kind}", path, words + ["--transfer-function", function]
    for name in ("heptane.nii.gz", "LIDC2.vti"):
        path = args.data / name if args.data else None
        if path is None or not path.exists() or args.only not in name:
            continue
        report = folder / "scene.json"
        run([args.tessera, "render", path, "-o", folder / "look.pfm", "--size", "64x64", "--report", report, "--quiet"])
        volume = json.loads(report.read_text())["volume"]
        low, high = volume["field"]["range"]
        extent = max(b - a for a, b in zip(*volume["bounds"]))
        function = folder / f"{path.name}.txt"
        at = lambda u: low + u * (high - low)
        function.write_text(f"{at(0.5)} 1 0.6 0.2 0\n{at(0.7)} 1 1 1 {40 / extent}\n{at(1)} 1 1 1 {80 / extent}\n")
        yield f"{path.name.split('.')[0]}, sparse", path, ["--transfer-function", function, "--size", "1024x1024"]


def mechanisms(args, folder):
    """Lines of a table, one per volume; every variation in turn, so that all have the same conditions. Prints a line each."""
    rows = []
    print("| volume | mechanisms | CPU, least [ms] | of the default | voxels visited [millions] | pieces [millions] | bricks to load | "
          "max error |\n|---|---|---|---|---|---|---|---|", flush=True)
    scenes = [(name + more, path, [*words, *opacity]) for name, path, words in volumes(args, folder)
              for more, opacity in (("", []), (", opaque", ["--opacity-scale", "50"]))]
    for name, path, words in scenes:
        cpu, counters, errors = {v: [] for v in VARIATIONS}, {}, {}
        for number in range(args.rounds):
            for variation in VARIATIONS:
                report = folder / "report.json"
                verify = ["--verify", args.verify] if number == args.rounds - 1 else []
                run([args.tessera, "render", path, "-o", folder / "picture.pfm", *words, *variation, "--threads", args.threads,
                     "--repeat", args.repeat, "--report", report, *verify])
                frame = json.loads(report.read_text())["frames"][0]
                cpu[variation].append(frame["balance"]["processes"][0]["cpu_ms"])
                counters[variation] = frame["counters"]
                errors[variation] = frame.get("verify", {}).get("max_error")
        least = {v: min(cpu[v]) for v in VARIATIONS}
        loads = {v: f"{c['bricks_total'] - c['bricks_invisible']} of {c['bricks_total']}" for v, c in counters.items()}
        for v in VARIATIONS:
            print(f"| {name} | {'`' + ' '.join(v) + '`' if v else 'all, unshaded'} | {least[v]:.0f} | {least[v] / least[()]:.2f} | "
                  f"{1e-6 * counters[v]['voxels_visited']:.1f} | {1e-6 * counters[v]['samples']:.1f} | {loads[v]} | {errors[v]:.1e} |", flush=True)
        shown = [(), ("--without", "termination"), ("--shade",)]  # culling and skipping only change the count of bricks
        ratios = " | ".join(f"{least[v] / least[()]:.2f}" for v in VARIATIONS[1:])
        millions = lambda x: f"{1e-6 * x:.1f}" if x < 1e8 else f"{1e-6 * x:.0f}"
        count = lambda key: " / ".join(millions(counters[v][key]) for v in shown)
        rows.append(f"| {name} | {least[()]:.0f} | {ratios} | {count('voxels_visited')} | {count('samples')} | {loads[()]} | "
                    f"{' / '.join(results_file.error(errors[v]) for v in shown)} |")
    return ["| volume | CPU [ms] | culling | skipping | both | termination | all three | `--shade` | voxels [M] | pieces [M] | bricks | "
            "max error |", "|---" * 12 + "|", *rows]


def finish(args, load_before, name, table, what):
    """Prints the table for the results, and writes it there if a file is given."""
    print("\n".join(["", *table]))
    if args.results:
        results_file.put(args.results, name, f"{results_file.made(load_before)} `{results_file.command('volumes.py')}`: {what}", table)


def main():
    if len(sys.argv) > 1 and sys.argv[1] == "--peer":
        volume, view, knots, threads, repeat, exact = sys.argv[2:]
        return peer(volume, view, knots, int(threads), int(repeat), exact)
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tessera", type=pathlib.Path, default=pathlib.Path("build/release/apps/tessera"))
    parser.add_argument("--data", type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--size", type=int, default=256, help="samples a side")
    parser.add_argument("--verify", type=int, default=100)
    parser.add_argument("--no-vtk", action="store_true")
    parser.add_argument("--mechanisms", action="store_true")
    parser.add_argument("--only", default="", help="volumes whose name has this in it")
    parser.add_argument("--results", type=pathlib.Path)
    args = parser.parse_args()
    args.tessera = args.tessera.resolve()

    load_before = os.getloadavg()[0]
    if args.mechanisms:
        with tempfile.TemporaryDirectory() as scratch:
            table = mechanisms(args, pathlib.Path(scratch))
        return finish(args, load_before, "volumes.py mechanisms", table,
                      "CPU time of the default, accuracy 1e-4; as a ratio to it, CPU time without each mechanism, and with shading; voxels "
                      "visited, pieces integrated and maximum error: default / without termination / shaded; bricks to load")
    rows = []
    print("| volume | method | frame, least (median) [ms] | VTK / this | max error | ns a voxel visited |\n|---|---|---|---|---|---|", flush=True)
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for name, path, words in volumes(args, folder):
            times = {m: [] for m in METHODS}
            reports, vtk = {}, []
            for number in range(args.rounds):
                for method in METHODS:
                    picture, report = folder / f"{method[1]}.pfm", folder / "report.json"
                    last = number == args.rounds - 1
                    run([args.tessera, "render", path, "-o", picture, *words, *method, "--threads", args.threads,
                         "--repeat", args.repeat, "--report", report, *(["--verify", args.verify] if last else [])])
                    times[method] += json.loads(report.read_text())["frames"][0]["frame_ms"]
                    reports[method] = json.loads(report.read_text())
                if args.no_vtk:
                    continue
                scene = reports[METHODS[0]]
                if number == 0:
                    run([args.tessera, "convert", path, folder / "samples.vti", "--quiet"])
                done = run(["xvfb-run", "-a", "/usr/bin/python3", __file__, "--peer", folder / "samples.vti",
                            json.dumps(scene["frames"][0]["view"]), json.dumps(scene["transfer_function"]["knots"]),
                            args.threads, max(2, args.repeat // 2), folder / "exact.pfm"])
                frames, difference = json.loads(done.stdout.splitlines()[-1])
                vtk += frames
            cells = []
            for method in METHODS:
                least, median = min(times[method]), statistics.median(times[method])
                report = reports[method]
                voxels = report["frames"][0]["counters"]["voxels_visited"]
                verified = report["frames"][0].get("verify")
                error = results_file.error(verified["max_error"]) if verified else "-"
                ratio = f"{min(vtk) / least:.1f}" if vtk else "-"
                each = 1e6 * least * args.threads / voxels
                print(f"| {name} | `{' '.join(method)}` | {least:.0f} ({median:.0f}) | {ratio} | {error} | {each:.1f} |", flush=True)
                cells.append(f"{least:.0f} ({median:.0f}), {ratio}x, {error}" if vtk else f"{least:.0f} ({median:.0f}), {error}")
                if method == ("--accuracy", "1e-4"):
                    default_each = each
            if vtk:
                cells.append(f"{min(vtk):.0f} ({statistics.median(vtk):.0f}), {results_file.error(difference)}")
                print(f"| {name} | VTK fixed point, one-voxel steps | {cells[-1].replace(', ', ' | 1.0 | ')} | - |", flush=True)
            rows.append(f"| {name} | " + " | ".join(cells) + f" | {default_each:.1f} |")
    heads = ["volume", *(f"`{' '.join(m)}`" for m in METHODS), *([] if args.no_vtk else ["VTK fixed point"]), "ns a voxel, 1e-4"]
    finish(args, load_before, "volumes.py", ["| " + " | ".join(heads) + " |", "|---" * len(heads) + "|", *rows],
           "frame, least (median) [ms]; how many times as long VTK takes, by the least, in steps of one voxel; maximum error; ns a voxel visited "
           "at accuracy 1e-4, in proportion to time for the others")


if __name__ == "__main__":
    main()
