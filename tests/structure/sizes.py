#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks the sizes of the library's sources: files of more than 500 lines and functions of more than 80 need a reason.

A file states the reason before its first namespace, a function in its body or in the comment above it:

    // Long: one table whose parts cannot be read alone.

Functions are found by their braces, ignoring comments and literals; a lambda, or a class inside a function, counts with
its lines. The lines of a function are those from the signature to the closing brace.

    sizes.py SOURCE_TREE
"""

import re
import sys
from pathlib import Path

FOLDERS = """include scene system colormaps cells io readers integrals exchange projection gl sorting compositor volume reference
             frame api datasets analysis server""".split()
SUFFIXES = {".cpp", ".hpp", ".h"}
FILE_LINES, FUNCTION_LINES = 500, 80

WHY = re.compile(r"//+ Long: \S")

TOKEN = re.compile(
    r"""//[^\n]*
      | /\*.*?\*/
      | R"(?P<fence>[^(\s\\]*)\(.*?\)(?P=fence)"
      | "(?:[^"\\\n]|\\.)*"
      | (?<![0-9A-Za-z_])'(?:[^'\\\n]|\\.)+'
      | ^[ \t]*\#(?:[^\n\\]|\\.)*
    """,
    re.DOTALL | re.VERBOSE | re.MULTILINE,
)
KEPT_OPEN = re.compile(r"^(inline\s+)?namespace\b|^extern\b|(^|[>\s])(class|struct|union|enum)\s")


def blanked(source):
    """The text with comments, literals and directives replaced by spaces: offsets do not change."""
    return TOKEN.sub(lambda m: re.sub(r"[^\n]", " ", m[0]), source)


def opens_function(head):
    """Whether `head`, the text between the end of the last statement and a brace, begins a function."""
    head = re.sub(r"HWY_\w+|TESSERA_EXPORT", "", head).strip()
    signature = re.sub(r"template\s*<[^{};]*?>\s*(?=\w)", "", head)
    if "(" not in head or KEPT_OPEN.search(signature.split("(")[0]):
        return False
    return not re.search(r"(^|[^=!<>])=\s*$|\breturn\s*$", head)


def functions(text):
    """(begin, end) offsets of every function with a body, except those inside other functions."""
    start, i, depth_in, found = 0, 0, 0, []
    open_at = None
    for match in re.finditer(r"[{};:]", text):
        i, mark = match.start(), match[0]
        if open_at is not None:  # inside a function, or a brace that is not one
            depth_in += {"{": 1, "}": -1}.get(mark, 0)
            if depth_in == 0:
                begin, is_function = open_at
                open_at = None
                if is_function:
                    found.append((begin, i))
                    start = i + 1
            continue
        if mark == ":":
            if re.search(r"\b(public|private|protected)\s*$", text[start:i]):
                start = i + 1
        elif mark == "{":
            head = text[start:i]
            # A member's value in a constructor's list, or a default argument: the head continues after it.
            value = re.search(r"\)\s*(noexcept\s*)?:[^:]", head) and re.search(r"[\w>]\s*$", head) and not re.search(
                r"\b(const|noexcept|override|final)\s*$", head)
            if value or head.count("(") > head.count(")"):
                open_at, depth_in = (start, False), 1
            elif opens_function(head):
                open_at, depth_in = (start, True), 1
            elif re.search(r"(^|[^=!<>])=\s*$|[\w>\]]\s*$", head) and not KEPT_OPEN.search(
                    re.sub(r"template\s*<[^{};]*?>\s*(?=\w)", "", head.strip())):
                open_at, depth_in = (start, False), 1  # a variable's value
            else:
                start = i + 1
        else:
            start = i + 1
    return found


def name_of(head):
    head = re.sub(r"\s+", " ", head).strip()
    match = re.search(r"([\w:~]+(?: ?operator ?[^\s(]+)?) ?\(", re.sub(r"HWY_\w+|TESSERA_EXPORT", "", head))
    return match[1] if match else head[:40]


def too_long(name, source):
    """(subject, line, lines, allowed) of the file, and of its functions, that are too long without a stated reason."""
    text, lines = blanked(source), source.count("\n")
    if lines > FILE_LINES and not WHY.search(source.split("\nnamespace")[0]):
        yield name, 1, lines, FILE_LINES
    for begin, end in functions(text):
        at = begin + re.search(r"\S", text[begin:]).start()
        long = text.count("\n", at, end) + 1
        if long > FUNCTION_LINES and not WHY.search(source[begin:end]):
            yield f"{name} {name_of(text[at:end])}", text.count("\n", 0, at) + 1, long, FUNCTION_LINES


def main():
    tree = Path(sys.argv[1])
    files, faults = 0, 0
    for folder in FOLDERS:
        for file in sorted((tree / folder).rglob("*")):
            if file.suffix not in SUFFIXES or not file.is_file():
                continue
            files += 1
            source, name = file.read_text(encoding="utf-8"), file.relative_to(tree).as_posix()
            for subject, line, long, most in too_long(name, source):
                faults += 1
                what = subject.removeprefix(name).strip() or "the file"
                print(f"{name}:{line}: {what} has {long} lines, more than {most}; split it, or say why: // Long: ...")
    print(f"{files} files, {faults} sizes against the rules")
    return 1 if faults or not files else 0


if __name__ == "__main__":
    sys.exit(main())
