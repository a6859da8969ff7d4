# SPDX-License-Identifier: BSD-3-Clause
"""A row of the test of advice: a command that causes a message, and how to follow its advice."""

import sys
from dataclasses import dataclass, field


@dataclass
class Row:
    command: str
    advice: str  # text that the message must contain
    mended: str  # the command after following the advice
    # Files by name, which may end in / for a directory: text, bytes, ("program", text), ("link", target), None:
    # removed.
    before: dict = field(default_factory=dict)  # for the first command
    after: dict = field(default_factory=dict)  # files changed by following the advice
    stdin: str = ""  # file that both commands read
    env: dict = field(default_factory=dict)
    terminal: str = ""  # stream of the first command that is a terminal: stdin or stdout; full: its output is full
    limits: str = ""  # shell commands executed before the first command
    alone: bool = False  # whether the first command is a program without its helpers
    line: str = ""


def row(command, advice, mended=None, before=None, after=None, **more):
    """Without `mended` the command is the same, and only files change."""
    caller = sys._getframe(1)
    while caller.f_code.co_filename.endswith("advice_row.py"):
        caller = caller.f_back
    place = f"{caller.f_code.co_filename.rsplit('/', 1)[-1]}:{caller.f_lineno}"
    assert mended or after, place
    return Row(command, advice, mended or command, before or {}, after or {}, line=place, **more)


def damaged(name, whole, old, new, advice, command="info", beside=None):
    """A file that is written again after a change of it gave a message; `beside` are files that belong to it."""
    assert old in whole, f"{name}: no {old!r}"
    return row(f"{command} {name}", advice, None, {**(beside or {}), name: whole.replace(old, new, 1)}, {name: whole})


def cut(name, whole, size, advice, command="info", beside=None):
    """The same for a truncated file."""
    return row(f"{command} {name}", advice, None, {**(beside or {}), name: whole[:size]}, {name: whole})
