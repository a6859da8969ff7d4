#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks the layout: which directory includes which, and how many modules one contains.

MAY_INCLUDE is the table. A row applies to its directory and all below it; a row of a subdirectory adds to its parent's.
Every directory may include its own headers, the public ones (tessera/), scene/ and system/. A directory and its
subdirectories may include each other: they are one library. Sibling subdirectories may not, unless a row allows it.
The table has no cycle. The compiler enforces the same between libraries (cmake/TesseraTarget.cmake).

Reports every include that the table does not allow as file:line, and directories of more than 40 modules; exit status 1
if there is one. Also reports, without failing, unused allowances.

    include_rules.py SOURCE_TREE [--count]    --count: prints the number of includes from directory to directory instead
"""

import re
import sys
from collections import Counter, defaultdict
from pathlib import Path, PurePosixPath

# None: any.
MAY_INCLUDE = {
    "include": set(),
    "scene": set(),
    "system": set(),
    "colormaps": set(),
    "cells": set(),
    "io": {"cells", "colormaps"},
    "io/files": set(),
    "io/text": {"io/files"},
    "io/foreign/messages": set(),
    "io/foreign/client": {"io/foreign/messages", "io/files"},
    "io/vtk": {"io/foreign/client", "io/foreign/messages", "io/files", "io/text"},
    "io/mesh": {"io/vtk", "io/foreign/client", "io/files", "io/text"},
    "io/volume": {"io/vtk", "io/foreign/client", "io/files", "io/text"},
    "io/foreign": {"io/mesh", "io/volume", "io/vtk", "io/files", "io/text"},
    "io/formats": {"io/foreign", "io/mesh", "io/volume", "io/files"},
    "io/image": {"io/text"},
    "io/scene": {"io/vtk", "io/files", "io/text"},
    "readers": {"cells", "io/files", "io/text", "io/foreign/messages"},
    "readers/common": set(),
    "readers/dicom": {"readers/common"},
    "readers/gmsh": {"readers/common"},
    "readers/med": {"readers/common"},
    "readers/tetgen": {"readers/common"},
    "readers/vtk": {"readers/common", "io/vtk"},
    "readers/xdmf": {"readers/common"},
    "integrals": set(),
    "exchange": set(),
    "gl": set(),
    "projection": {"gl"},
    "sorting": {"projection", "gl"},
    "volume": {"integrals"},
    "volume/bricks": set(),
    "volume/split": {"volume/bricks"},
    "volume/precise": {"volume/bricks", "volume/split"},
    "volume/lanes": {"volume/bricks", "volume/precise"},
    "compositor": {"sorting", "projection", "integrals", "exchange", "gl"},
    "reference": set(),
    "reference/mesh": set(),
    "reference/grid": {"reference/mesh"},
    "reference/curved": {"reference/mesh"},
    "frame": {"compositor", "sorting", "projection", "volume", "integrals", "exchange", "io", "cells"},
    "frame/mesh": set(),
    "frame/ranks": {"frame/mesh"},
    "frame/grid": {"frame/ranks"},
    "api": {"frame", "projection", "volume", "integrals", "exchange", "io", "cells", "colormaps", "reference"},
    "datasets": set(),
    "annotation": set(),
    "analysis": set(),
    "server": {"analysis"},
    "apps": {"analysis", "datasets", "server"},
    "apps/options": set(),
    "apps/render": {"apps/options"},
    "apps/commands": {"apps/options", "apps/render"},
    "apps/help": {"apps/render", "apps/commands"},
    "examples": set(),
    "bench": None,
    "tests": None,
}
# These may include neither scene/ nor system/, unless their row allows it.
PUBLIC_ONLY = {"include", "examples", "annotation", "analysis", "server", "apps"}
# These may not include headers that are not installed (tessera/program/).
INSTALLED = {"examples"}
MOST_MODULES = 40

# Headers of other libraries, and the only directories or files that may include them. Tests of readers write VTK's
# files with VTK.
ONLY_IN = [
    (r"mpi\.h$", ["exchange/mpi/", "include/tessera/mpi.hpp"]),
    (r"vtk", ["readers/vtk/", "tests/readers/", "tests/io/"]),
    (r"gmsh\.h$", ["readers/gmsh/"]),
    (r"tetgen\.h$", ["readers/tetgen/"]),
    (r"^Xdmf", ["readers/xdmf/"]),
    (r"^boost/", ["readers/xdmf/", "server/", "tests/server/"]),
    (r"^med\.h$", ["readers/med/", "tests/readers/"]),
    (r"^minc2\.h$", ["readers/vtk/", "tests/readers/"]),
    (r"CLI/", ["apps/"]),
    (r"(GL|EGL|KHR)/", ["gl/"]),
    (r"cairo", ["analysis/", "annotation/"]),
]

SUFFIXES = {".cpp", ".hpp", ".h", ".in"}
# Highway itself includes the file named in this way, once per instruction set.
INCLUDE = re.compile(r'^\s*#\s*(?:include|define\s+HWY_TARGET_INCLUDE)\s*[<"]([^>"]+)[>"]')


def sources(tree):
    """Every source in the directories of the table, as a path relative to the tree."""
    for directory in sorted({name.split("/")[0] for name in MAY_INCLUDE}):
        for file in sorted((tree / directory).rglob("*")):
            if file.suffix in SUFFIXES and file.is_file():
                yield file.relative_to(tree)


def includes(tree, file):
    """(line, header) of every include of a file."""
    for number, line in enumerate((tree / file).read_text(encoding="utf-8").splitlines(), 1):
        if match := INCLUDE.match(line):
            yield number, match[1]


def directory_of(path):
    """The directory of a file or header; tessera for a public header."""
    return PurePosixPath(path).parent.as_posix()


def top(directory):
    return directory.split("/")[0]


def is_within(directory, other):
    return directory == other or directory.startswith(other + "/")


def rows_of(directory):
    """The names of the rows that apply to a directory: its own and its parents'."""
    parts = directory.split("/")
    return [name for n in range(len(parts)) if (name := "/".join(parts[: n + 1])) in MAY_INCLUDE]


def allowances(directory):
    """All directories in the rows of a directory; None: anything."""
    rows = [MAY_INCLUDE[name] for name in rows_of(directory)]
    return None if None in rows else set().union(*rows)


def allowance_of(directory, of):
    """The entry that allows `directory` to include a header of the directory `of`; None if there is none."""
    others = allowances(directory)
    if others is None or (top(of) == "tessera" and (of == "tessera" or top(directory) not in INSTALLED)):
        return "tessera"
    if top(of) in ("scene", "system") and top(directory) not in PUBLIC_ONLY:
        return top(of)
    if is_within(directory, of) or is_within(of, directory):
        return directory
    return next((name for name in sorted(others) if is_within(of, name)), None)


def cycle_in_table():
    """A cycle of the table's rows, or None. Rows of a library include those of its subdirectories."""
    follows = {name: {other for other in others or () if other not in rows_of(name)} for name, others in MAY_INCLUDE.items()}
    for name in MAY_INCLUDE:
        seen, path = set(), []

        def visit(at):
            if at == name and path:
                return path + [at]
            if at in seen:
                return None
            seen.add(at)
            path.append(at)
            for row in MAY_INCLUDE:
                if is_within(row, at):
                    for other in follows[row]:
                        if found := visit(other):
                            return found
            path.pop()
            return None

        if found := visit(name):
            return found
    return None


def module(file):
    """The common name of a header and its source."""
    return re.sub(r"\.(cpp|hpp|h)(\.in)?$", "", file.as_posix())


def unknown_directories(tree):
    """Directories that the build adds and the table lacks."""
    build = (tree / "CMakeLists.txt").read_text(encoding="utf-8")
    return [f for f in re.findall(r"^\s*add_subdirectory\((\w+)\)", build, re.MULTILINE) if f not in MAY_INCLUDE]


def main():
    tree = Path(sys.argv[1])
    faults = [f"CMakeLists.txt: adds {name}/, which this table does not know" for name in unknown_directories(tree)]
    if cycle := cycle_in_table():
        faults.append(f"include_rules.py: the table has a cycle: {' -> '.join(cycle)}")
    files, used, arrows, modules = list(sources(tree)), defaultdict(set), Counter(), defaultdict(set)
    for file in files:
        directory = directory_of(file)
        if top(directory) not in ("tests", "bench"):
            modules[directory].add(module(file))
        for line, header in includes(tree, file):
            of = directory_of(header)
            if top(of) in MAY_INCLUDE or top(of) == "tessera":
                if of != directory:
                    arrows[directory, of] += 1
                if allowance := allowance_of(directory, of):
                    used[directory].add(allowance)
                else:
                    may = ", ".join(sorted(allowances(directory))) or "nothing else"
                    faults.append(f'{file}:{line}: includes "{header}"; {directory}/ may include {may}')
            for pattern, places in ONLY_IN:
                if re.match(pattern, header) and not file.as_posix().startswith(tuple(places)):
                    faults.append(f"{file}:{line}: includes {header}; only {' and '.join(places)} may")
    if "--count" in sys.argv:
        for (directory, of), count in sorted(arrows.items()):
            print(f"{directory} -> {of}: {count}")
        return 0
    for directory, names in sorted(modules.items()):
        if len(names) > MOST_MODULES and directory != "include/tessera":
            faults.append(f"{directory}/: {len(names)} modules, {MOST_MODULES} at most; divide it")
    for fault in faults:
        print(fault)
    for name, others in MAY_INCLUDE.items():
        inside = set().union(*(words for directory, words in used.items() if is_within(directory, name)), set())
        if unused := sorted((others or set()) - inside):
            print(f"note: {name}/ may include {', '.join(unused)} and does not")
    print(f"{len(files)} files, {len(faults)} faults")
    return 1 if faults or not files else 0


if __name__ == "__main__":
    sys.exit(main())
