#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The option table, api/options/option_table.cpp, agrees with the libraries' messages and with docs/REFERENCE.md.

A library's message names the setting, `tile_size`, from which apps/ makes --tile-size. Checks every string literal of the
library directories' C++ sources, without comments. Reports file:line of each that contains an option, or a name in
backquotes that does not belong to an option, which the program would print unchanged. The list of options in docs/REFERENCE.md has
to be the one that --write writes there, between two marker lines. Exit status 1 if there is a fault.

    option_names.py SOURCE_TREE [--write]
"""

import re
import sys
import textwrap
from pathlib import Path

FOLDERS = """include scene system colormaps cells io readers integrals exchange projection gl sorting compositor volume reference
             frame api datasets annotation analysis""".split()
TABLE = "api/options/option_table.cpp"
PAGE, BEGIN, END = "docs/REFERENCE.md", "<!-- option_names.py begin -->\n", "<!-- option_names.py end -->\n"
COMMANDS = "render serve info convert generate chart timing formats presets help completion".split()
SUFFIXES = {".cpp", ".hpp", ".h", ".inl"}

TOKEN = re.compile(
    r"""//[^\n]*
      | /\*.*?\*/
      | R"(?P<fence>[^(\s\\]*)\((?P<raw>.*?)\)(?P=fence)"
      | "(?P<text>(?:[^"\\\n]|\\.)*)"
      | (?<![0-9A-Za-z_])'(?:[^'\\\n]|\\.)+'""",
    re.DOTALL | re.VERBOSE,
)
OPTION = re.compile(r"(?<![\w-])(?<!tessera render )--([a-z][a-z-]*)")  # a complete command may be named
SETTING = re.compile(r"`([a-z][a-z0-9_]*)`")
COLUMNS = {"wait", "other", "cpu", "send"}  # of the timing table, which is not a message


def in_literals(pattern, source):
    """(line, name) of every match of the pattern in a string literal of this C++ text."""
    for token in TOKEN.finditer(source):
        group = "raw" if token["raw"] is not None else "text"
        text = re.sub(r"\\.", "  ", token[group] or "")  # the n of a line break is not a letter before the name
        for match in pattern.finditer(text):
            yield source.count("\n", 0, token.start(group) + match.start()) + 1, match[1]


def option_rows(tree):
    """(topic, names, value, traits, help) of every row, in the order of help pages."""
    table = (tree / TABLE).read_text(encoding="utf-8")
    traits = {name: words.split(" | ") for name, words in re.findall(r"constexpr Trait (\w+) = ([\w |]+);", table)}
    text = r'((?:"(?:[^"\\]|\\.)*"\s*)+)'
    row = re.compile(rf"\{{{text},\s*{text},\s*([\w |]+),\s*{text}\}}")
    for topic, rows in re.findall(r'\{"([^"]*)", (\w+_rows)\}', table):
        begin = table.index(f" {rows}[] = ")
        for names, value, words, meaning in row.findall(table, begin, table.index("\n};", begin)):
            joined = ["".join(re.findall(r'"((?:[^"\\]|\\.)*)"', part)) for part in (names, value, meaning)]
            expanded = [trait for word in words.split(" | ") for trait in traits.get(word, [word])]
            expanded = [trait for word in expanded for trait in traits.get(word, [word])]
            yield topic, joined[0].split(","), joined[1], expanded, joined[2]


def option_list(tree):
    """The list as Markdown; of options that `render` lacks with the commands that have them."""
    lines, title = [], None
    for topic, names, value, traits, meaning in option_rows(tree):
        if "positional" in traits:
            continue
        if topic != title:
            lines += ["", f"### {topic}", ""]
            title = topic
        form = ", ".join(("-" if len(name) == 1 < len(names) else "--") + name for name in names)
        value = "" if not value or "flag" in traits or "place" in traits else " " + value
        commands = [command for command in COMMANDS if command in traits]
        of = "" if "render" in commands else f" ({', '.join(commands)})"
        lines += textwrap.wrap(f"- `{form}{value}`{of} {meaning}", 160, subsequent_indent="  ", break_on_hyphens=False,
                               break_long_words=False)
    return "\n".join([*lines, "", ""])


def page_with(tree, options):
    page = (tree / PAGE).read_text(encoding="utf-8")
    return page[:page.index(BEGIN) + len(BEGIN)] + options + page[page.index(END):]


def main():
    tree = Path(sys.argv[1])
    known = {name.replace("-", "_") for _, names, *_ in option_rows(tree) for name in names}
    page = page_with(tree, option_list(tree))
    if sys.argv[2:] == ["--write"]:
        (tree / PAGE).write_text(page, encoding="utf-8")
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
                    faults.append(f"{name}:{line}: names `{setting}`, which is not an option; see {TABLE}")
    if page != (tree / PAGE).read_text(encoding="utf-8"):
        faults.append(f"{PAGE}: the list of options is not that of {TABLE}; run {Path(__file__).name} {tree} --write")
    if looked_at < 100:
        sys.exit(f"{tree}: only {looked_at} sources of libraries found; give the source tree")
    print(*faults, f"{looked_at} sources, {len(known)} settings, {len(faults)} faults", sep="\n")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
