# SPDX-License-Identifier: BSD-3-Clause
"""Sections of docs/RESULTS.md: a table, with commit, machine and command.

A section is between two marks, `<!-- NAME begin -->` and `<!-- NAME end -->`, and is replaced completely by the next run of
the script after which it is named; text outside the marks is kept. A new section goes to the end of the file.
"""
import datetime
import os
import pathlib
import re
import subprocess
import sys
import textwrap

ROOT = pathlib.Path(__file__).resolve().parent.parent
WIDTH = 160  # columns of a line of Markdown
PLACES = ("--tessera", "--old", "--before", "--program", "--frames-program", "--packing", "--data", "--work", "--folder", "--output", "--document", "--results",
          "--json", "--figure", "--images", "--sheets")  # options with paths on this machine


def commit():
    done = subprocess.run(["git", "-C", ROOT, "describe", "--always", "--dirty"], capture_output=True, text=True)
    return done.stdout.strip() or "unknown"


def processor():
    """The processor's name and number of cores."""
    names = (line.split(":", 1)[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name"))
    return next(names, "unknown CPU").replace("(R)", "").removesuffix(" Processor"), os.cpu_count()


def made(load_before):
    """Date, commit, machine, and the load average before/after."""
    name, cores = processor()
    return (f"{datetime.date.today().isoformat()}, commit {commit()}: {name}, {cores} cores, load {load_before:.1f}/"
            f"{os.getloadavg()[0]:.1f}.")


def command(script):
    """The command line of this run without PLACES and without the directories of absolute paths."""
    words, rest = [], iter(sys.argv[1:])
    for word in rest:
        name, has_value, _ = word.partition("=")
        if name not in PLACES:
            words.append(re.sub(r"(^|=)/.*/", r"\1", word))
        elif not has_value:
            next(rest, None)
    return " ".join([f"bench/{script}", *words])


def error(x):
    """1.2e-7: two digits in the fewest columns."""
    return f"{x:.1e}".replace("e-0", "e-")


def put(path, name, caption, table):
    """Writes the section NAME: a paragraph, and the lines of a table."""
    begin, end = f"<!-- {name} begin -->", f"<!-- {name} end -->"
    paragraph = textwrap.fill(caption, WIDTH, break_long_words=False, break_on_hyphens=False)
    section = "\n".join([begin, paragraph, "", *table, end])
    text = path.read_text() if path.exists() else "# Results\n"
    if begin in text:
        before, rest = text.split(begin, 1)
        path.write_text(before + section + rest.split(end, 1)[1])
    else:
        path.write_text(text.rstrip() + "\n\n" + section + "\n")
