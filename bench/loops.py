#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The hot loops of a frame: their share of its time, their number of instructions, and the minimum number of cycles by the
processor's ports alone.

    bench/loops.py --tessera build/release/apps/tessera MESH [-- MORE ARGUMENTS OF tessera render]

Samples come from `perf record` over repeated frames, loops from the machine code (innermost: a backward jump without another
inside; only instructions with samples), cycles from llvm-mca, whose port model ignores caches, mispredicted jumps, and jumps
inside the loop that are taken only in some iterations. A loop whose time is about that of llvm-mca is bound by its
instructions. Needs perf, binutils and llvm-mca; a build with -g1
(-DCMAKE_CXX_FLAGS=-g1) adds source lines.
"""
import argparse
import collections
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import results_file

ROOT = pathlib.Path(__file__).resolve().parent.parent


def output(*command, text=None):
    return subprocess.run(command, input=text, capture_output=True, text=True, check=True).stdout


def function_of(symbol):
    """namespace::function<arguments> without parameters: the common part of the names in perf and nm."""
    symbol = re.sub(r"\((?:\w+::)*TableForm\)", "", symbol)
    found = re.search(r"N_\w+::\w+(<[^(]*?>)?(?=\(|$|\+)", symbol)
    return found[0] if found else None


def sample(args, more, folder):
    data = folder / "perf.data"
    render = [args.tessera, "render", args.mesh, "-o", str(folder / "o.pfm"), "--threads", str(args.threads),
              "--repeat", str(args.frames), "--quiet", *more]
    output("perf", "record", "-q", "-F", "1499", "-o", str(data), *render)
    places, total = collections.defaultdict(collections.Counter), 0
    for line in output("perf", "script", "-i", str(data), "-F", "ip,sym,symoff").splitlines():
        total += 1
        found = re.match(r"\s*[0-9a-f]+ (.*)\+0x([0-9a-f]+)$", line.rstrip())
        function = found and function_of(found[1])
        if function:
            places[function][int(found[2], 16)] += 1
    return places, total


def innermost_loops(code, samples):
    """(first, last) of instructions; among overlapping loops, the one with the most samples."""
    at = {address: i for i, (address, _) in enumerate(code)}
    loops = set()
    for i, (address, text) in enumerate(code):
        jump = re.match(r"j\w+\s+([0-9a-f]+)", text)
        if jump and at.get(int(jump[1], 16), i + 1) <= i:
            loops.add((at[int(jump[1], 16)], i))
    inner = [l for l in loops if not any(o != l and o[0] >= l[0] and o[1] <= l[1] for o in loops)]
    kept = []
    for first, last in sorted(inner, key=lambda l: -sum(samples.get(address, 0) for address, _ in code[l[0]:l[1] + 1])):
        if not any(first <= k[1] and k[0] <= last for k in kept):
            kept.append((first, last))
    return sorted(kept)


def taken(body, samples):
    """The instructions of those basic blocks that contain samples."""
    ends = [i for i, (_, text) in enumerate(body) if text.startswith("j")]
    targets = {int(m[1], 16) for _, text in body if (m := re.match(r"j\w+\s+([0-9a-f]+)", text))}
    starts = sorted({0, *(i + 1 for i in ends), *(i for i, (address, _) in enumerate(body) if address in targets)})
    blocks = [body[first:last] for first, last in zip(starts, [*starts[1:], len(body)])]
    return [x for block in blocks if any(samples.get(address) for address, _ in block) for x in block]


def source_of(args, address):
    """The project's own innermost source line."""
    lines = output("addr2line", "-i", "-e", args.tessera, hex(address)).splitlines()
    own = [l for l in lines if re.search(r"/(compositor|sorting|projection)/[\w-]+\.(h|cpp)", l)]
    return re.sub(r".*/| .*", "", (own or lines)[0])


def port_cycles(args, body):
    text = "\n".join(re.sub(r"<.*>", "", t) for _, t in body if not re.match(r"j|call|ret|nop|data16", t))
    found = re.search(r"Total Cycles:\s+(\d+)", output(args.llvm_mca, f"-mcpu={args.cpu}", "-iterations=100", text=text))
    return int(found[1]) / 100


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh")
    parser.add_argument("--tessera", default=str(ROOT / "build/release/apps/tessera"))
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--frames", type=int, default=10)
    parser.add_argument("--least", type=float, default=0.5, help="percent of all samples that a loop has to have")
    parser.add_argument("--llvm-mca", default=shutil.which("llvm-mca") or "llvm-mca-14")
    parser.add_argument("--cpu", default="icelake-server", help="llvm-mca's name of the processor")
    argv = sys.argv[1:]
    more = argv[argv.index("--") + 1:] if "--" in argv else []
    args = parser.parse_args(argv[:argv.index("--")] if "--" in argv else argv)
    load_before = os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as folder:
        places, total = sample(args, more, pathlib.Path(folder))
    print(f"{results_file.made(load_before)}\n`{results_file.command('loops.py')}`\n")
    print("| loop | samples | instructions | of 512 bits or masks | cycles by ports |\n|---|---|---|---|---|")
    for line in output("nm", "-C", "-S", "--defined-only", args.tessera).splitlines():
        part = line.split(None, 3)
        function = function_of(part[3]) if len(part) == 4 else None
        start, size = (int(part[0], 16), int(part[1], 16)) if function in places else (0, 0)
        samples = {start + offset: n for offset, n in places[function].items() if offset < size} if size else {}
        if sum(samples.values()) < args.least / 100 * total:
            continue
        listing = output("objdump", "-d", "--no-show-raw-insn", f"--start-address={start}",
                         f"--stop-address={start + size}", args.tessera)
        code = [(int(m[1], 16), m[2].split("#")[0].strip()) for m in re.finditer(r"^ +([0-9a-f]+):\s+(.*)$", listing, re.M)]
        for first, last in innermost_loops(code, samples):
            body = taken(code[first:last + 1], samples)
            here = [samples.get(address, 0) for address, _ in body]
            if sum(here) < args.least / 100 * total:
                continue
            source = source_of(args, body[here.index(max(here))][0])
            wide = sum("zmm" in text or "%k" in text for _, text in body)
            cycles = port_cycles(args, body)
            print(f"| {function}, {source} | {100 * sum(here) / total:.1f} % | {len(body)} | {wide} | {cycles:.1f} |")


if __name__ == "__main__":
    main()
