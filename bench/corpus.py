#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs `tessera info` and a 256 x 256 `tessera render` on every file of a directory, within limits, and sorts the results.

    bench/corpus.py --tessera PROGRAM FOLDER [--seconds 60] [--mebibytes 8192] [--jobs 2] [--pictures FOLDER] [--json FILE]

Outcomes, worst first:

  signal    it was ended by a signal, or with a status other than 0, 2, 3 and 4
  hang      it took longer than --seconds of wall time
  silent    status 2 or 3 without a line on stderr that begins with `tessera: ` and the file's name
  half      info and render disagree: one accepts the file, the other refuses it
  failed    status 3 or 4, or memory over --mebibytes
  refused   status 2 and one line
  rendered  both accept it

Prints a table of counts by extension, then each distinct line of refusals and faults, with the number of files and one of them,
for review. Exits with status 1 if anything is a signal, a hang or silent. --pictures keeps the images (.png) for inspection.
Needs only Python's standard library.
"""
import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time

ORDER = ("signal", "hang", "silent", "half", "failed", "refused", "rendered")


def run(command, seconds, mebibytes):
    """(status, stderr, seconds, MiB): a negative status is a signal, None a hang."""

    def limit():
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_AS, (mebibytes << 20, mebibytes << 20))
        os.setpgid(0, 0)

    begin = time.monotonic()
    with tempfile.TemporaryFile() as err:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=err, preexec_fn=limit)
        hung, usage, status = False, None, None
        while usage is None:
            pid, status, found = os.wait4(process.pid, os.WNOHANG)
            if pid == process.pid:
                usage = found
            elif time.monotonic() - begin > seconds and not hung:
                hung = True
                os.killpg(process.pid, signal.SIGKILL)
            else:
                time.sleep(0.005)
        process.returncode = os.waitstatus_to_exitcode(status)
        err.seek(0)
        text = err.read().decode(errors="replace")
        return None if hung else process.returncode, text, time.monotonic() - begin, usage.ru_maxrss / 1024


def outcome_of(result, file):
    status, err, _, _ = result
    if status is None:
        return "hang"
    if status == 0:
        return "rendered"
    if status not in (2, 3, 4):
        return "signal"
    lines = [line for line in err.splitlines() if line.startswith("tessera: ")]
    if len(lines) != 1 or file.name not in lines[0]:
        return "silent"
    return "refused" if status == 2 else "failed"


def try_file(file, args):
    program = str(args.tessera.resolve())
    with tempfile.TemporaryDirectory() as folder:
        picture = pathlib.Path(folder) / "picture.png"
        if args.pictures:
            picture = args.pictures / (re.sub(r"[^A-Za-z0-9._-]", "_", str(file.relative_to(args.folder))) + ".png")
        info = run([program, "info", str(file)], args.seconds, args.mebibytes)
        render = run([program, "render", str(file), "-o", str(picture), "--size", "256x256"], args.seconds, args.mebibytes)
    outcomes = [outcome_of(info, file), outcome_of(render, file)]
    outcome = min(outcomes, key=ORDER.index)
    if outcome == "refused" and "rendered" in outcomes:
        outcome = "half"
    line = next((line for status, err, _, _ in (render, info) if status != 0 for line in reversed(err.splitlines()) if line.startswith("tessera: ")), "")
    return {"file": str(file.relative_to(args.folder)), "outcome": outcome, "line": line, "status": [info[0], render[0]],
            "seconds": round(info[2] + render[2], 3), "mebibytes": round(max(info[3], render[3]))}


def judged(line, file):
    """A refusal without parts specific to this file, so that similar ones are grouped."""
    line = re.sub(r"^tessera: ", "", line).replace(file, "FILE")
    line = re.sub(r"\S*" + re.escape(pathlib.Path(file).name), "FILE", line)
    return re.sub(r"-?\d+(\.\d+)?", "N", line)[:160]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tessera", type=pathlib.Path, required=True)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--mebibytes", type=int, default=8192)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--pictures", type=pathlib.Path)
    parser.add_argument("--json", type=pathlib.Path)
    args = parser.parse_args()
    if args.pictures:
        args.pictures.mkdir(parents=True, exist_ok=True)
    files = sorted(f for f in args.folder.rglob("*") if f.is_file())
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        results = list(pool.map(lambda file: try_file(file, args), files))
    if args.json:
        args.json.write_text(json.dumps(results, indent=1))

    by_extension = collections.defaultdict(collections.Counter)
    for r in results:
        by_extension[pathlib.Path(r["file"]).suffix.lower() or "(none)"][r["outcome"]] += 1
    print("| extension | files | " + " | ".join(ORDER) + " |\n|---|---:|" + "---:|" * len(ORDER))
    for extension, counts in sorted(by_extension.items(), key=lambda item: -sum(item[1].values())):
        print(f"| {extension} | {sum(counts.values())} | " + " | ".join(str(counts[o] or "") for o in ORDER) + " |")
    total = collections.Counter(r["outcome"] for r in results)
    print(f"| all | {len(results)} | " + " | ".join(str(total[o] or "") for o in ORDER) + " |\n")
    groups = collections.defaultdict(list)
    for r in results:
        if r["outcome"] != "rendered":
            groups[r["outcome"], judged(r["line"], r["file"]) or f"status {r['status']}"].append(r["file"])
    for (outcome, line), names in sorted(groups.items(), key=lambda item: (ORDER.index(item[0][0]), -len(item[1]))):
        print(f"{outcome}, {len(names)}: {line}  ({names[0]})")
    return 1 if total["signal"] + total["hang"] + total["silent"] else 0


if __name__ == "__main__":
    sys.exit(main())
