#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks that the sources and pages named in README.md, docs/ and the READMEs of directories exist.

There are three kinds of names: a source with its directory (`api/session.cpp`, also in diagrams; tessera/NAME.hpp is in
include/); a source without one in the README of a directory, which is in that directory or below it; and the target of
a link.
Reports file:line of each that does not exist; exit status 1 if there is one.

    doc_names.py SOURCE_TREE
"""

import re
import sys
from pathlib import Path

SOURCE = r"[\w*-]+(?:/[\w*-]+)*(?:-inl)?\.(?:hpp|cpp|h|py|sh|glsl|comp|frag|vert|md)\b"
IN_DIRECTORY = re.compile(rf"(?<![\w/.*-])([a-z]+/{SOURCE})")
BARE = re.compile(rf"`({SOURCE})`")
LINK = re.compile(r"\]\(([^)#:\s]+)(?:#[^)]*)?\)")
GENERATED = {"tessera/version.hpp"}


def pages(tree):
    yield tree / "README.md"
    yield from sorted((tree / "docs").glob("*.md"))
    yield from sorted(tree.glob("*/README.md"))


def is_there(tree, page, name):
    """Whether a source `name` exists, relative to the tree or a page; files of other projects are not checked."""
    places = [tree, page.parent, tree / "include"]
    if name in GENERATED:
        return True
    first = name.split("/")[0]
    if "/" in name and not any((place / first).is_dir() for place in places):
        return True
    if "/" not in name and next(page.parent.glob("**/" + name), None):
        return True
    return any(next(place.glob(name), None) for place in places)


def faults_of(tree, page):
    inside = page.parent != tree and page.parent.name != "docs"
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        names = set(IN_DIRECTORY.findall(line)) | (set(BARE.findall(line)) if inside else set())
        for name in sorted(names):
            if not is_there(tree, page, name):
                yield f"{page.relative_to(tree)}:{number}: {name} does not exist"
        for target in LINK.findall(line):
            if not (page.parent / target).exists():
                yield f"{page.relative_to(tree)}:{number}: links to {target}, which does not exist"


def main():
    tree = Path(sys.argv[1]).resolve()
    looked_at = list(dict.fromkeys(pages(tree)))
    faults = [fault for page in looked_at for fault in faults_of(tree, page)]
    for fault in faults:
        print(fault)
    print(f"{len(looked_at)} pages, {len(faults)} names that do not exist")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
