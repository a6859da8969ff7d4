#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What messages name exists: options, their values, commands, file formats, switches of the build, pages, packages.

A library's message names the setting, `tile_size`, from which apps/ makes --tile-size. Checks every string literal of
the C++ sources, without comments; adjacent ones are one. Options and their values are those of
api/options/option_table.cpp, and a command's sources name options of that command. A file name extension that a message
recommends is that of a format which is read (io/formats/format_table.cpp) or written (the option table). First checks
itself: each line of WRONG has to be refused.

Options named in the manual (MANUAL) exist too. The list of options in docs/REFERENCE.md has to be the one that --write
writes there, between two marker lines. Exit status 1 if there is a fault.

    option_names.py SOURCE_TREE [--write]
"""

import re
import sys
import textwrap
from pathlib import Path

FOLDERS = """include scene system colormaps cells io readers integrals exchange projection gl sorting compositor volume
             reference frame api datasets annotation analysis""".split()
PROGRAMS = ["apps", "server"]  # which may name options
TABLE = "api/options/option_table.cpp"
MANUAL = ["docs/GUIDE.md", "docs/REFERENCE.md", "docs/FORMATS.md", "docs/SERVER.md"]
STATES, CONTROLS = "docs/SERVER.md", "server/web/wording.js"  # which list options of states and of the page
FORMATS = "io/formats/format_table.cpp"
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
OPTION = re.compile(r"(?<![\w-])--([a-z][a-z-]*)")
SETTING = re.compile(r"`([a-z][a-z0-9_]*)`")
OWN = {"help", "help-all", "version"}  # options that the table does not list
COLUMNS = {"wait", "other", "cpu", "send"}  # of the timing table, which is not a message
# A command to type, not what the program prints about itself.
COMMAND = re.compile(r"(?<![\w<])tessera ([a-z]+)([^;`\n]*)")
VALUE = re.compile(r"\b(?:use|set|write|give|with|or) [`-]+([a-z][a-z0-9_-]*)`? ([a-z][a-z0-9-]*)")
EXTENSIONS = re.compile(r"\b(?:write|export|save|convert|choose|give|end it|rename) [^;]*")
EXTENSION = re.compile(r"(?<![\w.])\.([a-z][a-z0-9]*)|(?:FILE|NAME|OUT|out|mesh|%04d)\.([a-z][a-z0-9]*)")
PACKAGE = re.compile(r"Debian: (?:apt install )?([a-z0-9.+-]+)")
PLACE = re.compile(r"\b((?:docs|scripts)/[\w./]+\w)")
SWITCH = re.compile(r"\b(TESSERA_[A-Z0-9]+)=")
BETWEEN = {"vdb"}  # extensions of a step before the last of an advice
SCRIPTS = "apps/help/completion_scripts.cpp"  # are not messages

# Source, literal: each is refused, and nothing in RIGHT is.
WRONG = [
    ("frame/a.cpp", "raise --memory"),
    ("frame/a.cpp", "raise `memori`"),
    ("apps/commands/info_command.cpp", "leave --shade out"),
    ("apps/main.cpp", "leave --shades out"),
    ("io/a.cpp", "`tessera list` shows them"),
    ("io/a.cpp", "give a file that tessera info --timing wrote"),
    ("io/a.cpp", "use `backend` gpu"),
    ("io/a.cpp", "VTK has no reader; convert it to .vtv with meshio"),
    ("io/a.cpp", "its format is not open; save it as .h3d"),
    ("io/a.cpp", "build with TESSERA_JPG=ON"),
    ("io/a.cpp", "docs/FORMAT.md lists them"),
    ("io/a.cpp", "install one (Debian: fonts-deja)"),
]
RIGHT = [
    ("frame/a.cpp", "raise `memory`, or give `backend` cpu; tessera render --memory 1G -o a.png has it"),
    ("apps/commands/info_command.cpp", "leave --smooth out; see tessera info --help and docs/FORMATS.md"),
    ("io/a.cpp", "convert it to .vtu with meshio, or write OUT.pvtu; build with TESSERA_JPEG=ON (Debian: zlib1g-dev)"),
]


def literals(source):
    """(line, text) of every string literal of this C++ text; adjacent ones are one."""
    begin, text, last = 0, "", None
    for token in TOKEN.finditer(source):
        part = token["raw"] if token["raw"] is not None else token["text"]
        if part is None:
            continue
        if last is not None and source[last : token.start()].strip():
            yield source.count("\n", 0, begin) + 1, text
            text, last = "", None
        begin = token.start() if last is None else begin
        text += re.sub(r"\\n", "\n", part)
        last = token.end()
    if last is not None:
        yield source.count("\n", 0, begin) + 1, text


class Names:
    """What there is in this tree."""

    def __init__(self, tree):
        self.tree = tree
        self.options, self.values = {}, {}  # commands and values, by the option
        for _, names, value, traits, _ in option_rows(tree):
            if "positional" in traits:
                continue
            words = re.sub(r"\[.*?\]|:N", "", value).split("|")
            for name in names:
                self.options.setdefault(name, set()).update(traits)
                if all(re.fullmatch(r"[a-z0-9-]+", word) for word in words):
                    self.values.setdefault(name, set()).update(words)
        read = re.findall(r' row\("[^"]*", "([^"]*)"', (tree / FORMATS).read_text(encoding="utf-8"))
        written = re.findall(r"\.([a-z0-9]+)", (tree / TABLE).read_text(encoding="utf-8"))
        self.extensions = {word.strip(".") for words in read for word in words.split()} | set(written)
        packages = (tree / "scripts/packages.txt").read_text(encoding="utf-8")
        self.packages = set(re.findall(r"^[a-z]+ +(\S+)", packages, re.MULTILINE)) | {"ffmpeg"}
        self.switches = set(re.findall(r"option\((TESSERA_\w+)", (tree / "CMakeLists.txt").read_text(encoding="utf-8")))

    def faults(self, file, text):
        """What this literal of the file names, and there is not."""
        command = re.match(r"apps/commands/([a-z]+)_|server/", file)
        own = {command[1] or "serve"} if command else set(COMMANDS)
        own |= {"render"} if own == {"chart"} else set()  # a chart's methods are options of render
        for match in COMMAND.finditer(text):
            if match[1] not in COMMANDS:
                yield f"tessera {match[1]} is not a command"
            for option in OPTION.findall(match[2]):
                if match[1] not in self.options.get(option, ()) and option not in OWN:
                    yield f"tessera {match[1]} has no --{option}"
        for option in OPTION.findall(COMMAND.sub("", text)):
            if file.split("/")[0] not in PROGRAMS and file != TABLE:
                yield f"names --{option}; write `{option.replace('-', '_')}`"
            elif not own & self.options.get(option, set()) and option not in OWN:
                yield f"--{option} is not an option of {', '.join(sorted(own))}"
        for setting in SETTING.findall(text):
            if setting.replace("_", "-") not in self.options and setting not in COLUMNS:
                yield f"names `{setting}`, which is not an option; see {TABLE}"
        for option, value in VALUE.findall(text):
            if value not in self.values.get(option.replace("_", "-"), {value}) | {"and", "or", "too"}:
                yield f"{option} has no value {value}"
        for clause in EXTENSIONS.findall(text):
            for extension in {a or b for a, b in EXTENSION.findall(clause)} - self.extensions - BETWEEN:
                yield f".{extension} is neither read nor written"
        tables = ((PACKAGE, self.packages, "package"), (SWITCH, self.switches, "switch of the build"))
        for pattern, known, what in tables:
            for name in set(pattern.findall(text)) - known:
                yield f"{name} is not a {what}"
        for place in PLACE.findall(text):
            if not (self.tree / place).exists():
                yield f"there is no {place}"


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
    names = Names(tree)
    page = page_with(tree, option_list(tree))
    if sys.argv[2:] == ["--write"]:
        (tree / PAGE).write_text(page, encoding="utf-8")
    faults = [f"does not refuse its example: {text}" for file, text in WRONG if not list(names.faults(file, text))]
    faults += [f"refuses its example: {text}: {fault}" for file, text in RIGHT for fault in names.faults(file, text)]
    sources = [f for folder in FOLDERS + PROGRAMS for f in sorted((tree / folder).rglob("*")) if f.suffix in SUFFIXES]
    for file in sources:
        if file == tree / SCRIPTS:
            continue
        name = file.relative_to(tree).as_posix()
        for line, text in literals(file.read_text(encoding="utf-8")):
            faults += [f"{name}:{line}: {fault}" for fault in names.faults(name, text)]
    others = OWN | {"oversubscribe", "timeout"}  # of mpirun and timeout
    for name in MANUAL:
        for number, line in enumerate((tree / name).read_text(encoding="utf-8").splitlines(), 1):
            unknown = set(OPTION.findall(line)) - set(names.options) - others
            faults += [f"{name}:{number}: --{option} is not an option" for option in unknown]
    controls = (tree / CONTROLS).read_text(encoding="utf-8").partition("controls = {")[2].partition("};")[0]
    for name in re.findall(r'([a-z-]+)"?: "', controls):
        if "serve" not in names.options.get(name, ()):
            faults.append(f"{CONTROLS}: {name} is not an option of serve")
    states = (tree / STATES).read_text(encoding="utf-8")
    keys = [keys[0] for _, keys, _, traits, _ in option_rows(tree) if "state" in traits]
    faults += [f"{STATES}: `{key}` of states is missing" for key in keys if f"`{key}`" not in states]
    if page != (tree / PAGE).read_text(encoding="utf-8"):
        faults.append(f"{PAGE}: the list of options is not that of {TABLE}; run {Path(__file__).name} {tree} --write")
    if len(sources) < 100:
        sys.exit(f"{tree}: only {len(sources)} sources found; give the source tree")
    print(*faults, f"{len(sources)} sources, {len(names.options)} options, {len(faults)} faults", sep="\n")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
