#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Messages that give advice: following the advice works.

Each row (advice_row.py) is a command that fails or warns, the advice that its message must give, and the command after
following that advice, which must succeed and write the stated output. Data are generated; most files are damaged on the
spot. Each message of apps/ and io/ that gives advice must come from a row, or be listed among the exceptions
(advice_exceptions.py) with the reason why no command provokes it. Reports each row and each message that violates this;
exit status 1 if there is one.

    advice.py --tessera PROGRAM --source SOURCE_TREE [--only WORDS]
"""

import argparse
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import advice_arguments
import advice_colors
import advice_decks
import advice_empty
import advice_foreign
import advice_libraries
import advice_meshes
import advice_outputs
import advice_unread
import advice_volumes
from advice_exceptions import EXCEPTIONS, NO_ADVICE
from advice_messages import messages_of

TOPICS = (
    advice_arguments,
    advice_outputs,
    advice_colors,
    advice_volumes,
    advice_meshes,
    advice_foreign,
    advice_libraries,
    advice_decks,
    advice_empty,
    advice_unread,
)


def make_data(tessera, folder: Path):
    """Data shared by rows."""
    folder.mkdir()
    for command in ("generate cube m.vtu n=3", "generate ripples v.vti n=8", "convert v.vti v.raw"):
        done = subprocess.run([tessera, *shlex.split(command)], cwd=folder, capture_output=True, errors="replace")
        if done.returncode != 0:
            sys.exit(f"{command}: {done.stderr}")
    (folder / "c.json").write_text(
        '{"position": [0, 0, 9], "focal_point": [0, 0, 0], "view_up": [0, 1, 0], "parallel_scale": 2}'
    )


def write(folder: Path, files):
    for name, content in files.items():
        file = folder / name
        if name.endswith("/"):
            file.mkdir(parents=True, exist_ok=True)
            continue
        file.parent.mkdir(parents=True, exist_ok=True)
        file.unlink(missing_ok=True)
        if isinstance(content, tuple):
            kind, content = content
            if kind == "link":
                file.symlink_to(content)
                continue
            file.touch(0o755)
        if content is not None:
            file.write_bytes(content if isinstance(content, bytes) else content.encode())


def outputs_of(command):
    """Files that a command writes."""
    words = shlex.split(command)
    if words[0] in ("convert", "generate") and len(words) > 2:
        return [words[2]]
    named = [
        words[k + 1]
        for k, word in enumerate(words[:-1])
        if word in ("-o", "--output", "--report", "--annotation-layer")
    ]
    return [name for name in named if name != "-" and "%" not in name]


def has_said(done):
    return done.stderr.decode(errors="replace"), (done.stdout or b"").decode(errors="replace")


def copy_of(tessera, folder: Path):
    """The program in a directory without its helpers."""
    copy = folder / "alone/bin/tessera"
    copy.parent.mkdir(parents=True)
    try:
        os.link(tessera, copy)
    except OSError:
        shutil.copy(tessera, copy)
    return str(copy)


def no_terminal():
    """Why a command cannot be given a terminal; empty if it can."""
    try:
        for each in os.openpty():
            os.close(each)
    except OSError as error:
        return f"this machine has no pseudo-terminals ({error})"
    return ""


def follow(tessera, data: Path, folder: Path, row):
    """Runs a row: its fault, and the output of its first command; None if this build or machine does not support it."""
    if row.terminal in ("stdin", "stdout") and (reason := no_terminal()):
        print(f"{row.line}: skipped: {reason}", flush=True)
        return [], None
    folder.mkdir()
    for file in data.iterdir():
        os.link(file, folder / file.name)

    def run(command, terminal="", limits="", alone=""):
        streams = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE}
        opened = []
        if row.stdin:
            opened.append(os.open(folder / row.stdin, os.O_RDONLY))
            streams["stdin"] = opened[0]
        if terminal == "full":
            opened.append(os.open("/dev/full", os.O_WRONLY))
            streams["stdout"] = opened[-1]
        elif terminal:
            opened += os.openpty()
            streams[terminal] = opened[-1]
        environment = {**os.environ, "PATH": "/nowhere", **row.env}
        words = [alone or tessera, *shlex.split(command)]
        if limits:
            words = ["/bin/sh", "-c", f'{limits}; exec "$0" "$@"', *words]
        done = subprocess.run(words, cwd=folder, timeout=1200, env=environment, stderr=subprocess.PIPE, **streams)
        for each in opened:
            os.close(each)
        return done

    write(folder, row.before)
    failed = run(row.command, row.terminal, row.limits, copy_of(tessera, folder) if row.alone else "")
    errors, output = has_said(failed)
    wrong = []
    faults = [line for line in errors.splitlines() if line.startswith("tessera: ") and "warning: " not in line]
    is_line = failed.returncode in (2, 3) and len(faults) == 1
    # An image that does not show everything is a warning.
    said = "\n".join((errors, re.sub(r"\n +", " ", errors), re.sub(r"\n +", "; ", errors), output))  # lines are wrapped
    # A reader, or a part of one, that is not in this build; or one that is installed on this machine.
    is_lacking = re.search("which (is not installed|this build leaves out)", said) and not row.alone
    if is_lacking or (row.alone and failed.returncode == 0):
        return [], None
    if not (is_line or failed.returncode == 0) or row.advice not in said:
        wrong.append(f"{row.command}\n  status {failed.returncode}, '{row.advice}' awaited: {errors.strip()}")
    write(folder, dict.fromkeys(outputs_of(row.mended)) | row.after)
    done = run(row.mended)
    if done.returncode != 0 or row.advice in has_said(done)[0]:
        wrong.append(f"{row.mended}\n  status {done.returncode}, after '{row.advice}': {has_said(done)[0].strip()}")
    missing = [name for name in outputs_of(row.mended) if done.returncode == 0 and not (folder / name).exists()]
    wrong += [f"{row.mended}\n  {name} is not there after '{row.advice}'" for name in missing]
    return [f"{row.line}: {line}" for line in wrong], said


def follow_in_time(tessera, data, folder, row):
    try:
        return follow(tessera, data, folder, row)
    except subprocess.TimeoutExpired as late:
        return [f"{row.line}: {row.command}\n  {late}"], ""


def uncovered(source, said, is_partial):
    """Messages that no row produced and that are not excepted; unused exceptions. `is_partial`: not all rows ran."""
    every = messages_of(source, ("api/options", "apps", "cells", "io", "readers", "system"))
    messages = [message for message in every if not any(re.search(known, str(message)) for known in NO_ADVICE)]
    followed = [message for message in messages if message.pattern.search(said)]
    rest = [message for message in messages if message not in followed]
    excused = 0
    wrong = []
    for pattern, (count, _) in EXCEPTIONS.items():
        excepted = [message for message in rest if re.search(pattern, str(message))]
        rest = [message for message in rest if message not in excepted]
        excused += len(excepted)
        if len(excepted) != count and not is_partial:
            wrong.append(f"advice_exceptions.py: '{pattern}' excepts {len(excepted)} messages that no row makes")
    for pattern in NO_ADVICE:
        if not any(re.search(pattern, str(message)) for message in every):
            wrong.append(f"advice_exceptions.py: '{pattern}' is not a message")
    if not is_partial:
        wrong += [f"no row and no exception: {message}" for message in rest]
    counts = f"{len(followed)} are followed, {excused} excepted"
    return wrong, f"{len(messages)} messages give advice, {counts}"


def unread_formats(tessera, said):
    """Formats that are known but not supported, for which no row follows the advice in the table of formats."""
    listed = json.loads(subprocess.run([tessera, "formats", "--json"], check=True, capture_output=True).stdout)
    return [
        f"no row: {each['name']}: {each['remark']}"
        for each in listed
        if each["holds"] == "not read"
        and f"({each['name']}) is not read; {each['remark']}" not in said
        and each["name"] != "Fluent HDF5"  # the reader of HDF5 refuses it with its own message
    ]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--tessera", required=True)
    parser.add_argument("--source", type=Path, required=True)
    parser.add_argument("--sanitized", action="store_true", help="helpers have no limits, so some messages do not come")
    parser.add_argument("--only", help="rows that have these words, and no count of messages")
    parser.add_argument("--every", type=int, default=1, help="each so many-th row, and no count of messages")
    options = parser.parse_args()
    tessera = os.path.abspath(options.tessera)
    rows = [row for topic in TOPICS for row in topic.ROWS]
    if options.only:
        rows = [row for row in rows if options.only in row.command + row.advice + row.line]
    rows = rows[:: options.every]
    with tempfile.TemporaryDirectory() as name, ThreadPoolExecutor(2) as pool:
        folder = Path(name)
        make_data(tessera, folder / "data")
        results = list(
            pool.map(
                lambda item: follow_in_time(tessera, folder / "data", folder / str(item[0]), item[1]), enumerate(rows)
            )
        )
    wrong = [line for lines, _ in results for line in lines]
    counts = ""
    if not options.only and options.every == 1:
        everything = [said for _, said in results if said is not None]
        unfollowed, counts = uncovered(
            options.source, "\n".join(everything), options.sanitized or len(everything) < len(rows)
        )
        wrong += unfollowed + unread_formats(tessera, "\n".join(everything))
    print("\n".join(wrong))
    print(f"{counts}; {len(rows)} rows, {len(wrong)} wrong")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
