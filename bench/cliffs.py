#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What each option and kind of transfer function costs: the time of a frame as a multiple of the same frame without options, and its error.

Default view and function, 700 x 700 pixels, two threads; the frame with and the frame without an option are rendered in turn, and the ratio is that of the lower
quartiles. The error is the largest difference from the double-precision reference at 200 pixels (`--verify 200`). Data sets are of `tessera generate` and, with
--data, the public ones; `--only NAME` measures one.
"""
import pathlib

from results import Section, data_words, error, generated, options, render

SHARED = {"mesh": ("bracket", "unisim"), "grid": ("heptane",)}
ANY = {"exact": ["--integrator", "exact"], "sampled": ["--integrator", "sampled"], "preintegrated": ["--integrator", "preintegrated"], "shade": ["--shade"],
       "log": ["--log"], "independent": ["--emission", "independent"], "viridis:ramp": ["--transfer-function", "viridis:ramp"],
       "inferno:peaks": ["--transfer-function", "inferno:peaks"], "peel": ["--peel", "0.6:3"], "deep": [], "perspective": ["--projection", "perspective"],
       "ten iso-surfaces": [word for k in range(1, 11) for word in ("--iso", f"{k / 11}")], "iso and shade": ["--iso", "0.5:red:0.5", "--shade"]}
ROWS = {"mesh": ANY | {"surface": ["--surface", "boundary"], "translucent surface": ["--surface", "boundary:#80a0c0:0.2"]}, "grid": ANY}


def quartile(times):
    return sorted(times)[len(times) // 4]


def main():
    args = options(__doc__, data=pathlib.Path, only=str, rounds=3)
    data = {"cube 64": ("mesh", lambda: [generated(args, "cube64.tets", "cube", "n=64")]),
            "ripples 160": ("grid", lambda: [generated(args, "ripples160.nrrd", "ripples", "n=160")])}
    if args.data is not None:
        data |= {name: (kind, lambda name=name: data_words(args, name)) for kind, names in SHARED.items() for name in names}
    section = Section(args)
    section.table("llrrrl", "data", "option", "plain [ms]", "times as long", "error", "arithmetic")
    for name, (kind, words_of) in data.items():
        if args.only not in (None, name):
            continue
        words = [*words_of(), "--size", "700x700", "--threads", "2"]
        for option, more in ROWS[kind].items():
            if "iso" in option and name not in ("cube 64", "ripples 160"):
                continue  # whose values are from 0 to 1
            picture, plain, times = "picture.deep.exr" if option == "deep" else "picture.pfm", [], []
            for _ in range(args.rounds):
                plain += render(args, words[0], *words[1:], "--repeat", 3)["frames"][0]["frame_ms"]
                report = render(args, words[0], *words[1:], *more, "--repeat", 3, picture=picture)["frames"][0]
                times += report["frame_ms"]
            checked = option not in ("sampled", "preintegrated", "deep", "peel")
            found = render(args, words[0], *words[1:], *more, "--verify", 200)["frames"][0]["verify"]["max_error"] if checked else None
            section.row(name, option, f"{quartile(plain):.0f}", f"{quartile(times) / quartile(plain):.2f}", error(found) if checked else "", report.get("arithmetic", "lanes"))
    section.keep()


if __name__ == "__main__":
    main()
