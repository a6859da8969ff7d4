#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What each option and kind of transfer function costs: the time of a frame as a multiple of the same frame without options, and its error.

Default view and function, 700 x 700 pixels, two threads; the frame with and the frame without an option are rendered in turn, and the ratio is that of the lower
quartiles. The error is the largest difference from the double-precision reference at 200 pixels (`--verify 200`) of each data set. Data sets are of `tessera
generate` and, with --data, the public ones; `--only NAME` measures one.
"""
import pathlib

from results import Section, data_words, error, generated, options, render

SHARED = {"mesh": ("oxygen-post", "bracket", "disk-out", "unisim"), "grid": ("heptane",)}
SAMPLED = {"mesh": ["--integrator", "sampled:8"], "grid": ["--integrator", "sampled"]}
ISO = ["--iso", "0.5:red:0.5"]
TRANSLUCENT = ["--surface", "boundary:#80a0c0:0.2"]
ANY = {"`exact`": ["--integrator", "exact"], "`sampled`": [], "`preintegrated`": ["--integrator", "preintegrated"],
       "`--shade`": ["--shade"], "`--log`": ["--log"], "`--emission independent`": ["--emission", "independent"],
       "`viridis:ramp`": ["--transfer-function", "viridis:ramp"], "`inferno:peaks`": ["--transfer-function", "inferno:peaks"], "perspective": ["--projection", "perspective"],
       "`--iso`": ISO, "ten `--iso`": [word for k in range(1, 11) for word in ("--iso", f"{k / 11}")], "`--iso`, `--shade`": [*ISO, "--shade"],
       "`--peel 0.6:3`": ["--peel", "0.6:3"], "deep image": []}
OF_MESHES = {"`--surface boundary`": ["--surface", "boundary"], "translucent surface": TRANSLUCENT, "translucent, `--iso`": [*TRANSLUCENT, *ISO],
             "translucent, `--shade`": [*TRANSLUCENT, "--shade"]}
UNBOUND = ("`sampled`", "`preintegrated`", "deep image", "`--peel 0.6:3`")  # whose image has no promise, or is not the only result


def quartile(times):
    return sorted(times)[len(times) // 4]


def applies(option, kind, name):
    if "--iso" in option and name not in ("cube 64", "ripples 160"):
        return False  # values from 0 to 1
    return (kind == "mesh" or option not in OF_MESHES) and (option != "`--log`" or name != "unisim")  # it has no positive value


def measured(args, words, option, more):
    """The ratio to the plain frame, and the error; the error is not measured for a method without a promise."""
    picture, plain, times = "picture.deep.exr" if option == "deep image" else "picture.pfm", [], []
    for _ in range(args.rounds):
        plain += render(args, words[0], *words[1:], "--repeat", 3)["frames"][0]["frame_ms"]
        times += render(args, words[0], *words[1:], *more, "--repeat", 3, picture=picture)["frames"][0]["frame_ms"]
    found = None if option in UNBOUND else render(args, words[0], *words[1:], *more, "--verify", 200)["frames"][0]["verify"]["max_error"]
    return quartile(times) / quartile(plain), found


def main():
    args = options(__doc__, data=pathlib.Path, only=str, rounds=3)
    data = {"cube 64": ("mesh", lambda: [generated(args, "cube64.tets", "cube", "n=64")]),
            "ripples 160": ("grid", lambda: [generated(args, "ripples160.nrrd", "ripples", "n=160")])}
    if args.data is not None:
        data |= {name: (kind, lambda name=name: data_words(args, name)) for kind, names in SHARED.items() for name in names}
    data = {name: (kind, [*words(), "--size", "700x700", "--threads", "2"]) for name, (kind, words) in data.items() if args.only in (None, name)}
    section = Section(args)
    section.table("l" + "r" * len(data) + "r", "times as long as without the option", *data, "largest error")
    for option, more in (ANY | OF_MESHES).items():
        cells, errors = [], []
        for name, (kind, words) in data.items():
            more = SAMPLED[kind] if option == "`sampled`" else more
            ratio, found = measured(args, words, option, more) if applies(option, kind, name) else (None, None)
            cells.append("" if ratio is None else f"{ratio:.2f}" if ratio < 10 else f"{ratio:.0f}")
            errors += [] if found is None else [found]
        section.row(option, *cells, error(max(errors)) if errors else "")
    section.keep()


if __name__ == "__main__":
    main()
