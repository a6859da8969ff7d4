#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The speed of meshes where a target was set: one table of target and result.

Meshes are made in --work: cubes, a TetGen filling of a box, graded meshes of 15.8 and 51.1 M tets, and with --data (a directory with oxygen-post/ and bracket/)
those, cut into eight. View and transfer function are those of all performance figures unless a row states otherwise; 1024 x 1024, `exact`, two threads. A time
is the minimum of the repeats, followed by its median. Ratios are of lower quartiles of alternating runs, because the machine's speed changes from minute to
minute. --only takes some of cube, large, real and modes.
"""
import pathlib
import statistics

from results import EXACT, VIEW, Section, data_words, generated, knots_of, options, render, run, written

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


class Bench:
    def __init__(self, args):
        self.args, self.section = args, Section(args)
        self.section.table("lll", "measurement", "target", "measured")

    def converted(self, name, *words):
        """A mesh of `tessera convert`, made if it is not there yet."""
        file = self.args.work / name
        if not file.exists():
            run(self.args.tessera, "convert", words[0], file, *words[1:])
        return file

    def in_turn(self, mesh, *variants, rounds=4, repeat=None):
        """A frame of each variant, words of `render`, with the times of all rounds. Words that come again take the place of the usual ones."""
        frames, usual = [{} for _ in variants], [*VIEW, *EXACT, "--threads", "2"]
        for _ in range(rounds):
            for frame, words in zip(frames, variants):
                rest = [w for pair in zip(usual[::2], usual[1::2]) if pair[0] not in words for w in pair]
                report = render(self.args, mesh, "--size", "1024x1024", "--repeat", repeat or self.args.repeat, *rest, *words)["frames"][0]
                frame.update(report | {"times": sorted(frame.get("times", []) + report["frame_ms"])})
        for frame in frames:
            times = frame["times"]
            frame |= {"least": times[0], "median": statistics.median(times), "quartile": times[len(times) // 4],
                      "rate": frame["counters"]["segments"] / times[0] / 1e3}  # Mseg/s
        return frames

    def one(self, mesh, *words, repeat=None):
        return self.in_turn(mesh, list(words), rounds=1, repeat=repeat)[0]


def ms(frame):
    return f"{frame['least']:.0f} ms ({frame['median']:.0f})"


def ratio(frame, to):
    return f"{frame['quartile'] / to['quartile']:.2f}x"


def error(frame):
    return f"error {frame['verify']['max_error']:.1e}"


def above_the_mesh(frame):
    """Bytes a tet of buffers, without 64 MiB."""
    return f"{(frame['counters']['peak_buffer_bytes'] - (64 << 20)) / frame['counters']['tets_total']:.0f} B/tet + 64 MiB"


VERIFY = ("--verify", "200")


def cube(b):
    row = b.section.row
    c64 = generated(b.args, "cube64.tets", "cube", "n=64")
    f = b.one(c64, *VERIFY)
    row("cube 64", "<= 130 ms", f"{ms(f)}, {f['rate']:.0f} Mseg/s, {error(f)}")
    one, two = b.in_turn(c64, ["--threads", "1"], [])
    row("cube 64, second thread", ">= 1.9x", f"{ratio(one, two)} ({ms(one)} on one, {ms(two)} on two)")
    f = b.one(generated(b.args, "cube32.tets", "cube", "n=32"), *VERIFY)
    row("cube 32", ">= 400 Mseg/s at 2e-5", f"{f['rate']:.0f} Mseg/s, {error(f)}")
    f = b.one(generated(b.args, "cube128.tets", "cube", "n=128"))
    row("cube 128, 12.6 M tets", "<= 300 ms", f"{ms(f)}, {f['rate']:.0f} Mseg/s")
    row("memory above the mesh, cube 128", "<= 32 B/tet + 64 MiB", f"{above_the_mesh(f)} ({f['counters']['peak_buffer_bytes'] / 2**20:.0f} MiB in all)")
    f = b.one(b.converted("delaunay.tets", written(b.args.work / "box.ply", BOX), "--max-volume", "1.55e-5"), *VERIFY)
    row(f"TetGen Delaunay, {f['counters']['tets_total']:,} tets", ">= 400 Mseg/s", f"{f['rate']:.0f} Mseg/s, {ms(f)}, {error(f)}")


def large(b):
    for name, n, wanted in (("graded, 15.8 M tets", 138, "<= 500 ms"), ("graded, 51.1 M tets", 204, "<= 1500 ms")):
        f = b.one(generated(b.args, f"graded{n}.tets", "graded", f"n={n}"), repeat=3)
        b.section.row(name, wanted, f"{ms(f)}, {f['rate']:.0f} Mseg/s; {above_the_mesh(f)}")


def real(b):
    for name in ("oxygen-post", "bracket") if b.args.data else ():
        mesh = b.converted(f"{name}.tets", *data_words(b.args, name), "--subdivide", "1")
        report = render(b.args, mesh, "--size", "1024x1024", *EXACT, "--threads", "2", "--repeat", b.args.repeat, *VERIFY)["frames"][0]
        times, segments = sorted(report["frame_ms"]), report["counters"]["segments"]
        b.section.row(f"{name}, cut into {report['counters']['tets_total']:,} tets, default view", ">= 300 Mseg/s",
                      f"{segments / times[0] / 1e3:.0f} Mseg/s, {times[0]:.0f} ms ({statistics.median(times):.0f}), {error(report)}")


def modes(b):
    knots = knots_of(VIEW[3])
    function = lambda name, lines: ["--transfer-function", written(b.args.work / name, "".join(" ".join(map(str, line)) + "\n" for line in lines))]
    opaque = function("opaque.txt", [[*k[:4], k[4] * 40 + 20] for k in knots])
    few = function("few.txt", [[0, 0, 0, 0, 0], [0.92, 1, 1, 1, 0], [1, 1, .5, .2, 8]])
    eye = written(b.args.work / "perspective.txt", "position 3.1 2.3 4.2\nfocal_point 0 0 0\nview_up 0 1 0\nview_angle 35\n")
    counts = (14, 30, 64, 256)
    maps = [function(f"knots{n}.txt", [[i / (n - 1), (i % 3) / 2, i / n, 1 - i / n, 1.5 + 1.5 * ((i * 7) % 11) / 11] for i in range(n)]) for n in counts]
    base, full, ended, shows, auto, p, *mapped = b.in_turn(
        generated(b.args, "cube64.tets", "cube", "n=64"), [], opaque, [*opaque, "--integrator", "auto", "--accuracy", "4e-3"], few, ["--integrator", "auto"],
        ["--camera", eye, *VERIFY], *([*m, *VERIFY] for m in maps))
    row = b.section.row
    row("cube 64, opaque function (x 40 + 20), rays ended at 1e-3", "<= 0.5x", f"{ratio(ended, base)} of the usual function ({ratio(full, base)} with `exact`)")
    shown = 100 * shows["counters"]["tets_projected"] / shows["counters"]["tets_total"]
    row(f"cube 64, a function that shows {shown:.1f} % of the cells", "<= 0.15x", f"{shows['quartile'] / base['quartile']:.3f}x")
    row("cube 64, `auto` at 1e-4 against `exact`", "<= 1x", ratio(auto, base))
    segments = p["counters"]["segments"] / base["counters"]["segments"]
    row("cube 64, perspective, ns a segment against orthographic", "<= 1.25x", f"{p['quartile'] / base['quartile'] / segments:.2f}x, {error(p)}")
    row(f"cube 64, {' / '.join(map(str, counts))} knots against 6", "-", "; ".join(f"{ratio(f, base)}, {error(f)}" for f in mapped))


def main():
    args = options(__doc__, data=pathlib.Path, repeat=5, only="cube,large,real,modes")
    b = Bench(args)
    for group in (cube, large, real, modes):
        if group.__name__ in args.only.split(","):
            group(b)
    b.section.keep("least (median) times")


if __name__ == "__main__":
    main()
