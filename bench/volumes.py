#!/usr/bin/env python3
"""Times `tessera render` of regular grids beside VTK's fixed-point ray caster: same volume, view, transfer function, run.

    bench/volumes.py [--tessera build/release/apps/tessera] [--data FOLDER] [--rounds 3] [--repeat 5] [--threads 2]
                     [--size N] [--verify 100] [--no-vtk] [--mechanisms] [--only NAME] [--results bench/RESULTS.md]

Makes `tessera generate ripples n=256` in float and 8-bit samples (view and transfer function of all speed figures);
FOLDER of --data may hold heptane.nii.gz and LIDC2.vti, which get their default view and a function that shows the top
of their range alone. Rounds go through all renderers in turn, so that all see the same machine; a time is the least of
all rounds' frames, the median beside it. Errors: Tessera's against the double-precision reference at --verify random
pixels, VTK's against Tessera's `exact` picture, all pixels, linear RGB. VTK (python3-vtk9, under xvfb-run) takes steps
of one voxel. The results file gets a section of its own, replaced by the next run.

With --mechanisms, instead: what culling of bricks, skipping of empty space and early termination save at the default
accuracy (each left out by `--without`, and all of them), and what `--shade` costs, with the functions as they are and 50
times as opaque. CPU time of all threads is the least of the rounds' last frames: other work on the machine counts little. No VTK.
"""
import argparse
import datetime
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
BEGIN, END = "<!-- volumes.py begin -->", "<!-- volumes.py end -->"
MECHANISMS_BEGIN, MECHANISMS_END = "<!-- volumes.py mechanisms begin -->", "<!-- volumes.py mechanisms end -->"
METHODS = [("--accuracy", "1e-3"), ("--accuracy", "1e-4"), ("--accuracy", "1e-5"), ("--integrator", "exact")]
VARIATIONS = [(), ("--without", "culling"), ("--without", "skipping"), ("--without", "culling,skipping"), ("--without", "termination"),
              ("--without", "culling,skipping,termination"), ("--shade",)]


def run(command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode not in (0, 4):
        sys.exit(f"volumes.py: {' '.join(str(c) for c in command)}\n{done.stderr.strip()}")
    return done


def peer(volume, view, knots, threads, repeat, exact):
    """The VTK side, in a process of its own under xvfb-run."""
    sys.path.insert(0, str(HERE / "peers"))
    import vtk_chart
    import vtk_raycast
    camera = {k: v if isinstance(v, list) else [v] for k, v in json.loads(view).items()}
    pixels, _, seconds = vtk_raycast.render_grid(vtk_chart.image_of(volume), camera, json.loads(knots), 1.0, repeat, threads)
    error = abs(pixels - vtk_raycast.read_pfm(exact)).max()
    print(json.dumps([[1e3 * s for s in seconds], float(error)]))


def volumes(args, folder):
    """Name, file, words of view and transfer function."""
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
    """Lines of a table: every variation of every volume, in turn, so that all see the same machine."""
    rows = []
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
        for variation in VARIATIONS:
            c = counters[variation]
            rows.append(f"| {name} | {'`' + ' '.join(variation) + '`' if variation else 'all, unshaded'} | {min(cpu[variation]):.0f} | "
                        f"{min(cpu[variation]) / min(cpu[()]):.2f} | {1e-6 * c['voxels_visited']:.1f} | "
                        f"{1e-6 * c['samples']:.1f} | {c['bricks_total'] - c['bricks_invisible']} of {c['bricks_total']} | "
                        f"{errors[variation]:.1e} |")
        print("\n".join(rows[-len(VARIATIONS):]), flush=True)
    return [f"`bench/volumes.py --mechanisms --rounds {args.rounds} --repeat {args.repeat} --threads {args.threads}`", "",
            "| volume | mechanisms | CPU, least [ms] | of the default | voxels visited [millions] | pieces [millions] | "
            "bricks to load | max error |", "|---|---|---|---|---|---|---|---|", *rows]


def put(results, begin, end, lines):
    """The section between two marks, printed, and in the results file if one is given."""
    section = "\n".join([begin, "", *lines, "", end])
    if results:
        text = results.read_text()
        if begin in text:
            text = text[:text.index(begin)] + section + text[text.index(end) + len(end):]
        else:
            text = text.rstrip() + "\n\n" + section + "\n"
        results.write_text(text)
    print(section)


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
    when = lambda: f"{datetime.date.today()}: load average before {load_before:.1f}, after {os.getloadavg()[0]:.1f}. "
    if args.mechanisms:
        with tempfile.TemporaryDirectory() as scratch:
            lines = mechanisms(args, pathlib.Path(scratch))
        return put(args.results, MECHANISMS_BEGIN, MECHANISMS_END, [when() + lines[0], *lines[1:]])
    rows = []
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
            for method in METHODS:
                least, median = min(times[method]), statistics.median(times[method])
                report = reports[method]
                voxels = report["frames"][0]["counters"]["voxels_visited"]
                verified = report["frames"][0].get("verify")
                error = f"{verified['max_error']:.1e}" if verified else "-"
                ratio = f"{min(vtk) / least:.1f}" if vtk else "-"
                rows.append(f"| {name} | `{' '.join(method)}` | {least:.0f} ({median:.0f}) | {ratio} | {error} | "
                            f"{1e6 * least * args.threads / voxels:.1f} |")
            if vtk:
                rows.append(f"| {name} | VTK fixed point, one-voxel steps | {min(vtk):.0f} ({statistics.median(vtk):.0f}) | 1.0 | "
                            f"{difference:.1e} | - |")
            print("\n".join(rows), flush=True)
    head = [when() + f"`bench/volumes.py --rounds {args.rounds} --repeat {args.repeat} --threads {args.threads}`", "",
            "| volume | method | frame, least (median) [ms] | VTK / this | max error | ns a voxel visited |",
            "|---|---|---|---|---|---|"]
    put(args.results, BEGIN, END, [*head, *rows])


if __name__ == "__main__":
    main()
