#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks that every source names its licence in its first two lines (SPDX), and that the inline namespace of public
names is the version of CMakeLists.txt. Reports each violation as file:line; exit status 1 if there is one.

    licences.py SOURCE_TREE
"""

import re
import sys
from pathlib import Path

SUFFIXES = {".cpp", ".hpp", ".h", ".in", ".glsl", ".comp", ".frag", ".vert", ".js", ".mjs", ".css", ".py", ".sh", ".cmake"}
LICENCE = "SPDX-License-Identifier: BSD-3-Clause"
# Templates that are not sources, and third-party files.
EXCEPT = {"cmake/tessera.pc.in", "cmake/tesseraConfig.cmake.in"}
BUILT = {"build", ".git", "node_modules"}


def sources(tree):
    for file in sorted(tree.rglob("*")):
        name = file.relative_to(tree)
        if not BUILT.intersection(name.parts) and name.as_posix() not in EXCEPT and file.is_file():
            if file.suffix in SUFFIXES or file.name == "CMakeLists.txt":
                yield name


def main():
    tree = Path(sys.argv[1])
    version = re.search(r"project\(.*?VERSION (\d+)\.(\d+)", (tree / "CMakeLists.txt").read_text(encoding="utf-8"), re.DOTALL)
    expected = f"v{version[1]}_{version[2]}"
    faults, count = [], 0
    for name in sources(tree):
        count += 1
        lines = (tree / name).read_text(encoding="utf-8").splitlines()
        if not any(LICENCE in line for line in lines[:2]):
            faults.append(f"{name}:1: does not name its licence: {LICENCE}")
        for number, line in enumerate(lines, 1):
            if (match := re.match(r"inline namespace (v\w+) \{", line)) and match[1] != expected:
                faults.append(f"{name}:{number}: the namespace is {match[1]}, the version's is {expected}")
    for fault in faults:
        print(fault)
    print(f"{count} files, {len(faults)} faults")
    return 1 if faults or not count else 0


if __name__ == "__main__":
    sys.exit(main())
