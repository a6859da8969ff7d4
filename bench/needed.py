#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What the default skips, and what each mechanism that skips it saves: a table per data set of --data, from the program's own counters.

Each data set with its default transfer function, with a sparse one (shows the upper fifth of the field's range) and with an opaque one (50 times the default's
extinction), and each time without one of the relevant mechanisms (`tessera render --without`). A cell is ms with it / ms without it, and the reduction of work by
the counters (ray segments of meshes, pieces integrated of volumes). Times are the fastest of six frames, in three rounds over all, 512 x 512 pixels. Bytes: of
bricks in memory, and of runs compared with raw segments (`--without merging`), two ranks. --only takes some of the data sets.
"""
import pathlib

from results import DATA, Section, data_words, options, render, written


def sparse(low, high, unit):
    at = lambda t: low + (high - low) * t
    return f"{at(0)!r} 0.2 0.4 0.9 0\n{at(0.8)!r} 0.2 0.4 0.9 0\n{at(0.85)!r} 0.9 0.5 0.1 {2 / unit!r}\n{at(1)!r} 1 0.9 0.8 {2 / unit!r}\n"


def cells(args, words):
    """A row of the table."""
    def counted(*more, ranks=1, repeat=("--repeat", 2)):
        report = render(args, *words, "--size", "512x512", *more, *repeat, ranks=ranks)
        return report, report["frames"][0]["counters"], min(report["frames"][0]["frame_ms"])

    report, counters, _ = counted(repeat=())
    is_volume = "volume" in report
    field, unit = (report["volume" if is_volume else "mesh"]["field"], report["transfer_function"]["unit_distance"]["value"])
    fewer = ["culling", "skipping"] if is_volume else ["culling"]
    plan = {"default": ([], fewer + ([] if is_volume else ["lattice"])), "opaque": (["--opacity-scale", "50"], ["termination"]),
            "sparse": (["--transfer-function", written(args.work / "sparse.txt", sparse(*field["range"], unit))], fewer)}
    found = {}  # by function and mechanism: counters, ms
    for function, (more, mechanisms) in plan.items():
        # All in turn, three times, so that load bursts of other programs affect all.
        for _ in range(3):
            for m in ("default", *mechanisms):
                _, counts, ms = counted(*more, *(["--without", m] if m != "default" else []))
                found[function, m] = counts, min(ms, found.get((function, m), (0, ms))[1])
    total, gone, work = ("bricks_total", "bricks_invisible", "samples") if is_volume else ("tets_total", "tets_invisible", "segments")

    def both(function, m):
        (with_it, ms), (without, other_ms) = found[function, "default"], found[function, m]
        less = 100 * (1 - with_it[work] / max(without[work], 1))
        return f"{ms:.0f} / {other_ms:.0f}" + (f" (-{less:.0f} %)" if less >= 0.5 else "")

    pair = lambda m: f"{both('default', m)}; {both('sparse', m)}" if ("sparse", m) in found else "-"
    sent = [counted(*more, ranks=2, repeat=())[1].get("exchange_bytes", 0) for more in ([], ["--without", "merging"])] if not is_volume else []
    held = [found["sparse", m][0]["bytes_resident"] for m in ("default", "culling")] if is_volume else []
    megabytes = lambda of: " / ".join(f"{size / 1e6:.1f}" for size in of) or "-"
    return (f"{counters[total]} {'bricks' if is_volume else 'tets'}",
            " / ".join(f"{100 * found[function, 'default'][0][gone] / max(counters[total], 1):.0f} %" for function in ("default", "sparse")),
            pair("culling"), pair("skipping"), both("opaque", "termination"), "-" if is_volume else both("default", "lattice"), megabytes(held), megabytes(sent))


def main():
    args = options(__doc__, data=pathlib.Path, only=",".join(DATA))
    section = Section(args)
    section.table("l" * 9, "data set", "size", "left out by culling: default / sparse", "culling: default; sparse", "skipping: default; sparse", "termination: opaque",
                  "lattice: default", "bricks held, MB: sparse", "merging, MB sent")
    for name in args.only.split(","):
        section.row(name, *cells(args, data_words(args, name)))
    section.keep()


if __name__ == "__main__":
    main()
