#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""No library's message names an option: it names the setting, `tile_size`, and apps/ makes --tile-size of it.

Looks at every string literal of the library folders' C++ sources, comments left aside. Says file:line of each that
holds an option, or a name in backquotes that is no option's (api/options/option_table.cpp has those that are, and their
help), which the program would print as it stands. Exit status 1 if there is one.

    option_names.py SOURCE_TREE
"""

import re
import sys
from pathlib import Path

FOLDERS = """include scene system colormaps cells io readers integrals exchange projection gl sorting compositor volume reference
             frame api datasets annotation analysis""".split()
TABLE = "api/options/option_table.cpp"
SUFFIXES = {".cpp", ".hpp", ".h", ".inl"}

TOKEN = re.compile(
    r"""//[^\n]*
      | /\*.*?\*/
      | R"(?P<fence>[^(\s\\]*)\((?P<raw>.*?)\)(?P=fence)"
      | "(?P<text>(?:[^"\\\n]|\\.)*)"
      | (?<![0-9A-Za-z_])'(?:[^'\\\n]|\\.)+'""",
    re.DOTALL | re.VERBOSE,
)
OPTION = re.compile(r"(?<![\w-])(?<!tessera render )--([a-z][a-z-]*)")  # a whole command may be named
SETTING = re.compile(r"`([a-z][a-z0-9_]*)`")
COLUMNS = {"wait", "other", "cpu", "send"}  # of the timing table, which is no message


def in_literals(pattern, source):
    """(line, name) of every match of the pattern in a string literal of this C++ text."""
    for token in TOKEN.finditer(source):
        group = "raw" if token["raw"] is not None else "text"
        text = re.sub(r"\\.", "  ", token[group] or "")  # the n of a line break is no letter before the name
        for match in pattern.finditer(text):
            yield source.count("\n", 0, token.start(group) + match.start()) + 1, match[1]


def settings_known(tree):
    table = (tree / TABLE).read_text(encoding="utf-8")
    names = re.findall(r'^    \{"([a-z,-]+)", ', table, re.MULTILINE)
    return {name.replace("-", "_") for row in names for name in row.split(",")}


def main():
    tree = Path(sys.argv[1])
    known = settings_known(tree)
    looked_at, faults = 0, []
    for folder in FOLDERS:
        for file in sorted((tree / folder).rglob("*")):
            if file.suffix not in SUFFIXES or file == tree / TABLE:
                continue
            looked_at += 1
            source, name = file.read_text(encoding="utf-8"), file.relative_to(tree)
            for line, option in in_literals(OPTION, source):
                faults.append(f"{name}:{line}: names --{option}; write `{option.replace('-', '_')}`")
            for line, setting in in_literals(SETTING, source):
                if setting not in known | COLUMNS:
                    faults.append(f"{name}:{line}: names `{setting}`, which is no option; see {TABLE}")
    if looked_at < 100:
        sys.exit(f"{tree}: only {looked_at} sources of libraries found; give the source tree")
    print(*faults, f"{looked_at} sources, {len(known)} settings, {len(faults)} faults", sep="\n")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
