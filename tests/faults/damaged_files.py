#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Damages real files and reads them with the whole program: no signal, no hang, one line, status 0 or 2, memory in proportion.

    tests/faults/damaged_files.py --tessera PROGRAM [--runs 1000] [--seed 1] [--jobs 2] [--keep FOLDER] FILE_OR_FOLDER...

Each run takes a file, changes it in one of these ways, and calls `tessera info` (every eighth time `tessera render` at 64 x 64):

  bits      1 to 16 bits anywhere           cut       the end is missing, or an interval in the middle
  header    the same in the first 2 KiB     number    a number in the text, by another: 0, -1, large, with a sign, off by one
  block     8 bytes at the beginning of     swap      two intervals are exchanged
            the appended data
A run is a fault if it ends by a signal or with a status other than 0 or 2, takes over 20 s, prints anything but one line on stderr
with status 2, uses more than twice the memory of the intact file plus 256 MiB, or leaves an output after a failure. The 20 s are
processor time, whatever else the machine does; after 300 s of wall time it counts as a hang. Faults are printed with the command that
creates the file again, and kept with --keep. Exits with status 1 if there are any. Standard library only.
"""
import argparse
import concurrent.futures
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import threading
import time

NUMBERS = (b"0", b"-1", b"1", b"255", b"65536", b"999999", b"2147483647", b"2147483648", b"4294967296", b"99999999999999999999", b"-2147483648",
           b"1e308", b"nan", b"", b"+7")


def damage(data, rng):
    data = bytearray(data)
    way = rng.choice(("bits", "bits", "header", "header", "number", "number", "number", "block", "block", "cut", "swap"))
    if way in ("bits", "header"):
        reach = len(data) if way == "bits" else min(len(data), 2048)
        for _ in range(rng.choice((1, 1, 2, 4, 16))):
            data[rng.randrange(reach)] ^= 1 << rng.randrange(8)
    elif way == "number":
        numbers = [m for m in re.finditer(rb"-?\d+(\.\d+)?", bytes(data[:65536]))]
        if numbers:
            m = rng.choice(numbers[:400])
            own = int(re.match(rb"-?\d+", m.group()).group())
            data[m.start():m.end()] = rng.choice(NUMBERS + (str(own + 1).encode(), str(own - 1).encode(), str(own * 10).encode()))
    elif way == "block":
        mark = data.find(b"<AppendedData")
        at = data.find(b"_", mark) + 1 if mark >= 0 else rng.randrange(len(data))
        at += 8 * rng.randrange(16)
        data[at:at + 8] = rng.choice((bytes(8), b"\xff" * 8, rng.randbytes(8), (rng.randrange(1 << 34)).to_bytes(8, "little")))
    elif way == "cut":
        if rng.random() < 0.6:
            del data[rng.randrange(len(data)):]
        else:
            at = rng.randrange(len(data))
            del data[at:at + rng.randrange(1, 4096)]
    else:
        size = rng.randrange(1, max(2, min(512, len(data) // 2)))
        a, b = (rng.randrange(len(data) - size + 1) for _ in range(2))
        data[a:a + size], data[b:b + size] = data[b:b + size], data[a:a + size]
    return way, bytes(data)


def run(command, folder):
    """Status, stderr, a message if it took too long, and the peak memory (MiB) of a command and its helpers."""
    begin = time.monotonic()
    with tempfile.TemporaryFile() as err:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=err, cwd=folder)
        timer = threading.Timer(300, process.kill)  # a hang
        timer.start()
        _, status, usage = os.wait4(process.pid, 0)
        timer.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        err.seek(0)
        seconds, processor = time.monotonic() - begin, usage.ru_utime + usage.ru_stime
        is_long = processor > 20 or seconds >= 300
        words = f"{seconds:.0f} s, {processor:.0f} s of the processor" if is_long else ""
        return process.returncode, err.read(), words, usage.ru_maxrss / 1024


def command_of(program, file, out):
    info = [program, "info", file]
    return info if out is None else [program, "render", file, "-o", out, "--size", "64x64", "--quiet"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tessera", type=pathlib.Path, required=True)
    parser.add_argument("--runs", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--keep", type=pathlib.Path)
    parser.add_argument("paths", type=pathlib.Path, nargs="+")
    args = parser.parse_args()
    program = str(args.tessera.resolve())
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    files = sorted(f for p in args.paths for f in (p.rglob("*") if p.is_dir() else [p]) if f.is_file() and 0 < f.stat().st_size < 4 << 20)
    intact, usable = {}, []
    for file in files:
        for rendered in (False, True):
            with tempfile.TemporaryDirectory() as folder:
                out = str(pathlib.Path(folder) / "o.pfm") if rendered else None
                status, _, _, memory = run(command_of(program, str(file.resolve()), out), folder)
                intact[file, rendered] = memory if status == 0 else None
        if intact[file, False] is not None:
            usable.append(file)
    if not usable:
        sys.exit("damaged_files.py: none of the files can be read as it is")

    def trial(number):
        rng = random.Random(args.seed * 1_000_003 + number)
        file = rng.choice(usable)
        rendered = number % 8 == 7 and intact[file, True] is not None
        way, data = damage(file.read_bytes(), rng)
        with tempfile.TemporaryDirectory() as folder:
            damaged = pathlib.Path(folder) / file.name
            damaged.write_bytes(data)
            out = pathlib.Path(folder) / "out.pfm" if rendered else None
            status, err, too_long, memory = run(command_of(program, str(damaged), out and str(out)), folder)
            faults = []
            if status not in (0, 2):
                faults.append(f"status {status}")
            if too_long:
                faults.append(too_long)
            if memory > 2 * intact[file, rendered] + 256:
                faults.append(f"{memory:.0f} MiB, intact {intact[file, rendered]:.0f}")
            if status == 2 and (err.count(b"\n") != 1 or not err.startswith(b"tessera: ")):
                faults.append(f"stderr {err[:200]!r}")
            if status != 0 and len(list(pathlib.Path(folder).iterdir())) > 1:
                faults.append("an output is left behind")
            if faults and args.keep:
                args.keep.mkdir(parents=True, exist_ok=True)
                shutil.copy(damaged, args.keep / f"{number}-{file.name}")
        return number, file, way, status, faults, err

    count, found = {}, 0
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        for number, file, way, status, faults, err in pool.map(trial, range(args.runs)):
            count[way, status] = count.get((way, status), 0) + 1
            if faults:
                found += 1
                print(f"run {number} of seed {args.seed}, {file.name}, {way}: {'; '.join(faults)}", flush=True)
    for way in sorted({w for w, _ in count}):
        print(way, ", ".join(f"status {s}: {n}" for (w, s), n in sorted(count.items()) if w == way))
    print(f"{args.runs} damaged files of {len(usable)}, {found} faults")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
