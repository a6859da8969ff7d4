#!/usr/bin/env python3
"""Which folder may include which: what each of the library's folders includes of the others, beside the table below.

Every folder may include its own headers, the public ones (tessera/) and scene/; what else, MAY_INCLUDE says. The
compiler holds targets to what they link (cmake/TesseraTarget.cmake); this holds the links to the design: a folder that
links another without being meant to fails here. Foreign headers that one place alone may know are in ONLY_IN.

Says file:line of every include that is not allowed; exit status 1 if there is one. Says too, without failing, which
allowances of MAY_INCLUDE nobody uses.

    include_rules.py SOURCE_TREE
"""

import re
import sys
from collections import defaultdict
from pathlib import Path

# Beside scene/ and tessera/. None: anything.
MAY_INCLUDE = {
    "include": set(),
    "scene": set(),
    "system": set(),
    "colormaps": set(),
    "cells": {"system"},
    "io": {"cells", "system", "colormaps"},
    "readers": {"cells", "io", "system"},
    "integrals": set(),
    "exchange": set(),
    "gl": set(),
    "projection": {"gl"},
    "sorting": {"projection", "gl"},
    "volume": {"integrals", "gl"},
    "compositor": {"sorting", "projection", "integrals", "exchange", "gl"},
    "reference": set(),
    "frame": {"compositor", "sorting", "projection", "volume", "integrals", "exchange", "gl", "io", "cells", "system",
              "colormaps",
              "reference"},
    "datasets": set(),
    "annotation": set(),
    "analysis": set(),
    "server": {"analysis"},
    "apps": {"analysis", "datasets", "server"},
    "examples": set(),
    "bench": None,
    "tests": None,
}
# These may not even include scene/.
PUBLIC_ONLY = {"include", "examples", "annotation", "analysis", "server", "apps"}

# Foreign headers, and the folders or files that alone may include them. Tests of io/ write VTK's files by VTK.
ONLY_IN = [
    (r"mpi\.h$", ["exchange/", "include/tessera/mpi.hpp"]),
    (r"vtk", ["readers/vtk/", "tests/io/"]),
    (r"gmsh\.h$", ["readers/gmsh/"]),
    (r"tetgen\.h$", ["readers/tetgen/tetgen_fill.cpp"]),
    (r"^Xdmf", ["readers/xdmf/"]),
    (r"^boost/", ["readers/xdmf/", "server/", "tests/server/"]),
    (r"^med\.h$", ["readers/med/", "tests/io/med_test.cpp"]),
    (r"^minc2\.h$", ["readers/vtk/", "tests/io/minc2_test.cpp"]),
    (r"CLI/", ["apps/"]),
    (r"(GL|EGL|KHR)/", ["gl/"]),
    (r"cairo", ["analysis/", "annotation/"]),
]

SUFFIXES = {".cpp", ".hpp", ".h", ".in"}
# Highway includes the file named so itself, once an instruction set.
INCLUDE = re.compile(r'^\s*#\s*(?:include|define\s+HWY_TARGET_INCLUDE)\s*[<"]([^>"]+)[>"]')


def includes(tree):
    """(folder, file, line, header) of every include in the folders of MAY_INCLUDE."""
    for folder in MAY_INCLUDE:
        for file in sorted((tree / folder).rglob("*")):
            if file.suffix in SUFFIXES and file.is_file():
                for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
                    if match := INCLUDE.match(line):
                        yield folder, file.relative_to(tree).as_posix(), number, match[1]


def allowed(folder, header):
    of = header.split("/")[0]
    if MAY_INCLUDE[folder] is None or of == "tessera" or (of == folder and folder != "include"):
        return True
    if of == "scene" and folder not in PUBLIC_ONLY:
        return True
    return of in MAY_INCLUDE[folder]


def unknown_folders(tree):
    """Folders that the build adds and the table lacks."""
    build = (tree / "CMakeLists.txt").read_text(encoding="utf-8")
    return [f for f in re.findall(r"^\s*add_subdirectory\((\w+)\)", build, re.MULTILINE) if f not in MAY_INCLUDE]


def main():
    tree = Path(sys.argv[1])
    faults = [f"CMakeLists.txt: adds {folder}/, which this table does not know" for folder in unknown_folders(tree)]
    files, used = set(), defaultdict(set)
    for folder, file, line, header in includes(tree):
        files.add(file)
        of = header.split("/")[0]
        if of in MAY_INCLUDE or of == "tessera":
            used[folder].add(of)
            if not allowed(folder, header):
                also = sorted({"tessera"} | MAY_INCLUDE[folder] | (set() if folder in PUBLIC_ONLY else {"scene"}))
                faults.append(f'{file}:{line}: includes "{header}"; {folder}/ may include {", ".join(also)}')
        for pattern, places in ONLY_IN:
            if re.match(pattern, header) and not file.startswith(tuple(places)):
                faults.append(f"{file}:{line}: includes {header}; only {' and '.join(places)} may")
    for fault in faults:
        print(fault)
    for folder, others in MAY_INCLUDE.items():
        if unused := sorted((others or set()) - used[folder]):
            print(f"note: {folder}/ may include {', '.join(unused)} and does not")
    print(f"{len(files)} files, {len(faults)} includes against the rules")
    return 1 if faults or not files else 0


if __name__ == "__main__":
    sys.exit(main())
