#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The speed of meshes where a target was set: one table of target, result, and command.

    bench/targets.py [--tessera build/release/apps/tessera] [--work FOLDER] [--data FOLDER] [--repeat 5]
                     [--json FILE] [--results docs/RESULTS.md] [--only cube,large,real,parallel,modes]

Makes its meshes in FOLDER (kept, so that a second run starts at once): cubes, a TetGen filling of a box, graded meshes
of 15.8 and 51.1 M tets, and with --data (a directory with oxygen-post/ and bracket/) those, cut into eight. View and
transfer function are those of all performance figures unless a row states otherwise; 1024 x 1024, `exact`, two threads. A time
is the minimum of the repeats, followed by its median. Ratios are of lower quartiles of alternating runs, because the machine's
speed changes from minute to minute. The section between the script's marks in the results file is
replaced; text outside is kept.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys

import results_file

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent
MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
BOX = """ply
format ascii 1.0
element vertex 8
property float x
property float y
property float z
element face 6
property list uchar int vertex_indices
end_header
-1 -1 -1\n1 -1 -1\n1 1 -1\n-1 1 -1\n-1 -1 1\n1 -1 1\n1 1 1\n-1 1 1
4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7
"""


def run(command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, env=os.environ | MPI)
    if done.returncode != 0:
        sys.exit(f"targets.py: {' '.join(str(c) for c in command)}\n{done.stderr.strip()}")
    return done.stdout


class Bench:
    def __init__(self, args):
        self.args, self.rows, self.seen = args, [], {}
        args.work.mkdir(parents=True, exist_ok=True)

    def mesh(self, name, *command):
        """A mesh made by a tessera command that ends with its file's path, if it does not exist yet."""
        file = self.args.work / name
        if not file.exists():
            run([self.args.tessera] + [file if c == "OUT" else c for c in command])
        return file

    def render(self, mesh, *extra, threads=2, ranks=1, figures=True, repeat=None, verify=0):
        report = self.args.work / "report.json"
        command = [self.args.tessera, "render", mesh, "-o", self.args.work / "out.pfm", "--size", "1024x1024",
                   "--threads", threads, "--repeat", repeat or self.args.repeat, "--report", report, "--quiet", *extra]
        if "--integrator" not in extra:
            command += ["--integrator", "exact"]
        if figures and "--camera" not in extra:
            command += ["--camera", HERE / "camera.txt"]
        if figures and "--transfer-function" not in extra:
            command += ["--transfer-function", HERE / "transfer_function.txt"]
        if verify:
            command += ["--verify", verify]
        if ranks > 1:
            command = ["mpirun", "--oversubscribe", "-n", ranks] + command
        run(command)
        frame = json.loads(report.read_text())["frames"][0]
        times = sorted(frame["frame_ms"])
        frame |= {"least": times[0], "median": statistics.median(times)}
        frame["rate"] = frame["counters"]["segments"] / times[0] / 1e3  # Mseg/s
        return frame

    def in_turn(self, mesh, *variants, rounds=4):
        """A frame of each variant, (arguments, keywords) of render(), with the times of all rounds."""
        frames, times = [None] * len(variants), [[] for _ in variants]
        for _ in range(rounds):
            for i, (extra, options) in enumerate(variants):
                frames[i] = self.render(mesh, *extra, **options)
                times[i] += frames[i]["frame_ms"]
        for frame, all_times in zip(frames, times):
            all_times.sort()
            frame |= {"least": all_times[0], "median": statistics.median(all_times),
                      "quartile": all_times[len(all_times) // 4]}
        return frames

    def row(self, what, wanted, reached, command=""):
        self.rows.append({"what": what, "wanted": wanted, "reached": reached, "command": command})
        print(f"{what}: wanted {wanted}; {reached}", flush=True)


def ms(frame):
    return f"{frame['least']:.0f} ms (median {frame['median']:.0f})"


def ratio(frame, to):
    return f"{frame['quartile'] / to['quartile']:.2f}x"


def error(frame):
    return f"error {frame['verify']['max_error']:.1e}" if "verify" in frame else ""


def cubes(b):
    c64, c32 = b.mesh("cube64.tets", "generate", "cube", "OUT", "n=64"), b.mesh("cube32.tets", "generate", "cube",
                                                                                "OUT", "n=32")
    f = b.render(c64, verify=200)
    b.row("cube 64", "<= 130 ms", f"{ms(f)}, {f['rate']:.0f} Mseg/s, {error(f)}")
    one, two = b.in_turn(c64, ([], {"threads": 1}), ([], {}))
    b.row("cube 64, second thread", ">= 1.9x", f"{ratio(one, two)} ({ms(one)} on one, {ms(two)} on two)")
    f = b.render(c32, verify=200)
    b.row("cube 32", ">= 400 Mseg/s at 2e-5", f"{f['rate']:.0f} Mseg/s, {error(f)}")
    c128 = b.mesh("cube128.tets", "generate", "cube", "OUT", "n=128")
    f = b.render(c128)
    b.row("cube 128, 12.6 M tets", "<= 300 ms", f"{ms(f)}, {f['rate']:.0f} Mseg/s")
    peak, tets = f["counters"]["peak_buffer_bytes"], f["counters"]["tets_total"]
    b.row("memory above the mesh, cube 128", "<= 32 B a tet + 64 MiB",
          f"{(peak - (64 << 20)) / tets:.0f} B a tet + 64 MiB ({peak / 2**20:.0f} MiB in all)")
    box = b.args.work / "box.ply"
    box.write_text(BOX)
    delaunay = b.mesh("delaunay.tets", "convert", box, "OUT", "--max-volume", "1.55e-5")
    f = b.render(delaunay, verify=200)
    b.row(f"TetGen Delaunay, {f['counters']['tets_total']:,} tets", ">= 400 Mseg/s",
          f"{f['rate']:.0f} Mseg/s, {ms(f)}, {error(f)}")


def large(b):
    for name, n, wanted in (("graded, 15.8 M tets", 138, "<= 500 ms"), ("graded, 51.1 M tets", 204, "<= 1500 ms")):
        f = b.render(b.mesh(f"graded{n}.tets", "generate", "graded", "OUT", f"n={n}"), repeat=3)
        peak, tets = f["counters"]["peak_buffer_bytes"], f["counters"]["tets_total"]
        b.row(f"{name}", wanted, f"{ms(f)}, {f['rate']:.0f} Mseg/s; {(peak - (64 << 20)) / tets:.0f} B a tet + 64 MiB")


def real(b):
    if b.args.data is None:
        print("real meshes: no --data, left out")
        return
    for name, file, options in (("oxygen-post", "oxygen-post/postxyz.bin", ["--q", b.args.data / "oxygen-post/postq.bin"]),
                                ("bracket", "bracket/bracket_appended_compressed.vtu", [])):
        mesh = b.mesh(f"{name}.tets", "convert", b.args.data / file, "OUT", "--subdivide", "1", *options)
        f = b.render(mesh, figures=False, verify=200)
        b.row(f"{name}, cut into {f['counters']['tets_total']:,} tets, default view", ">= 300 Mseg/s",
              f"{f['rate']:.0f} Mseg/s, {ms(f)}, {error(f)}")


def parallel(b):
    c64 = b.mesh("cube64.tets", "generate", "cube", "OUT", "n=64")
    threads, ranks = b.in_turn(c64, ([], {}), ([], {"threads": 1, "ranks": 2}))
    b.row("cube 64, 2 ranks x 1 thread against 1 x 2", "within 10 %",
          f"{100 * (ranks['quartile'] / threads['quartile'] - 1):+.0f} % ({ms(ranks)} against {ms(threads)})")

    def processor(ranks, *extra):
        trace = b.args.work / "trace.json"
        table = b.args.work / "stages.csv"
        b.render(c64, "--timing", trace, *extra, threads=1, ranks=ranks)
        run([b.args.tessera, "timing", trace, "--csv", table])
        return table.read_text()

    def cpu_of(table):
        """CPU [ms] of all stages of a frame, of all processes, without waiting and file output."""
        lines = [line.split(",") for line in table.strip().splitlines()]
        rows = [dict(zip(lines[0], line)) for line in lines[1:]]
        return sum(float(r["cpu_ms"]) * int(r["role_processes"]) for r in rows
                   if r["part"] == "frame" and r["cpu_ms"] and r["stage"] not in ("wait", "write", "whole", "other"))

    many = ("--projectors", 8, "--compositors", 8)
    totals = [(cpu_of(processor(1)), cpu_of(processor(16, *many))) for _ in range(3)]
    one, ranks = (min(t) for t in zip(*totals))
    if one > 0:
        b.row("cube 64, CPU of 8 + 8 ranks against one process", "<= 1.15x",
              f"{ranks / one:.2f}x ({ranks:.0f} against {one:.0f} ms, the least of three each)")


def modes(b):
    c64 = b.mesh("cube64.tets", "generate", "cube", "OUT", "n=64")
    knots = [line.split() for line in (HERE / "transfer_function.txt").read_text().splitlines()
             if line.strip() and not line.startswith("#")]

    def function(name, lines):
        file = b.args.work / name
        file.write_text("\n".join(" ".join(str(w) for w in line) for line in lines) + "\n")
        return file

    opaque = function("opaque.txt", [k[:4] + [float(k[4]) * 40 + 20] for k in knots])
    few = function("few.txt", [[0, 0, 0, 0, 0], [0.92, 1, 1, 1, 0], [1, 1, .5, .2, 8]])
    eye = function("perspective.txt", [["position", 3.1, 2.3, 4.2], ["focal_point", 0, 0, 0], ["view_up", 0, 1, 0],
                                       ["view_angle", 35]])
    counts = (14, 30, 64, 256)
    maps = [function(f"knots{count}.txt", [[i / (count - 1), (i % 3) / 2, i / count, 1 - i / count,
                                            1.5 + 1.5 * ((i * 7) % 11) / 11] for i in range(count)]) for count in counts]
    base, full, ended, shows, auto, p, *mapped = b.in_turn(
        c64, ([], {}), (["--transfer-function", opaque], {}),
        (["--transfer-function", opaque, "--integrator", "auto", "--accuracy", "4e-3"], {}),
        (["--transfer-function", few], {}), (["--integrator", "auto"], {}), (["--camera", eye], {"verify": 200}),
        *((["--transfer-function", m], {"verify": 200}) for m in maps))
    b.row("cube 64, opaque function (x 40 + 20), rays ended at 1e-3", "<= 0.5x",
          f"{ratio(ended, base)} of the usual function ({ratio(full, base)} with `exact`)")
    shown = 100 * shows["counters"]["tets_projected"] / shows["counters"]["tets_total"]
    b.row(f"cube 64, a function that shows {shown:.1f} % of the cells", "<= 0.15x",
          f"{shows['quartile'] / base['quartile']:.3f}x")
    b.row("cube 64, `auto` at 1e-4 against `exact`", "<= 1x", ratio(auto, base))
    segments = p["counters"]["segments"] / base["counters"]["segments"]
    b.row("cube 64, perspective, ns a segment against orthographic", "<= 1.25x",
          f"{p['quartile'] / base['quartile'] / segments:.2f}x, {error(p)}")
    b.row(f"cube 64, {' / '.join(map(str, counts))} knots against 6", "-",
          "; ".join(f"{ratio(f, base)}, {error(f)}" for f in mapped))


def write(args, b, load):
    table = ["| what | wanted | reached |", "|---|---|---|"] + [f"| {r['what']} | {r['wanted']} | {r['reached']} |" for r in b.rows]
    if args.json:
        args.json.write_text(json.dumps(b.rows, indent=1) + "\n")
    if args.results:
        results_file.put(args.results, "targets.py", f"{results_file.made(load)} `{results_file.command('targets.py')}`", table)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tessera", type=pathlib.Path, default=ROOT / "build" / "release" / "apps" / "tessera")
    parser.add_argument("--work", type=pathlib.Path, default=ROOT / "build" / "targets")
    parser.add_argument("--data", type=pathlib.Path)
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--only", default="cube,large,real,parallel,modes")
    parser.add_argument("--json", type=pathlib.Path)
    parser.add_argument("--results", type=pathlib.Path)
    args = parser.parse_args()
    if not args.tessera.exists():
        sys.exit(f"targets.py: {args.tessera}: no such program; build it or name it with --tessera")
    b, load = Bench(args), os.getloadavg()[0]
    for name, group in (("cube", cubes), ("large", large), ("real", real), ("parallel", parallel), ("modes", modes)):
        if name in args.only.split(","):
            group(b)
    write(args, b, load)


if __name__ == "__main__":
    main()
