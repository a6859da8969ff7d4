#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Memory of processes that render volumes, and the bytes that they read again if a volume is larger than that.

    bench/memory.py --tessera PROGRAM [--document docs/RESULTS.md] [--only "of processes"] [--samples 512] [--large 2048] [--folder FOLDER]

    of processes   the largest resident set of each rank, by volume, format, budget and number of ranks, sort-first and sort-last
    of sort-last   a volume that fits into the memory of all ranks together, not of one: bricks loaded and evicted per frame, in both modes

A rank's largest resident set is reported by the system at its end (wait4), including the program, its libraries, MPI's and any helper process.
Volumes have 8 bits: `tessera generate head` of --samples a side, as raw, as .vti and .vtr by `tessera convert`, and packed by this script
(.nii.gz; .vti of zlib blocks in base64), and `radial` of --large a side. They are kept in --folder, if given, for the next run; --large
2048 takes 8.6 GB there, and as much of the page cache as the machine has.

Needs mpirun and Python's standard library.
"""
import argparse
import base64
import contextlib
import gzip
import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

import results_file

SMALL_BUDGET, LARGE_BUDGET = "64M", "1G"
RANKS = 4  # for sort-last
PATH = 4  # views of one turn


def run(words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"memory.py: {' '.join(map(str, words))}\n{done.stderr.strip()}")


def watch(output, words):
    """Runs a rank, and writes its largest resident set in KiB to a file of its own."""
    rank = os.environ.get("OMPI_COMM_WORLD_RANK") or os.environ.get("PMI_RANK", "0")
    child = os.posix_spawnp(words[0], words, os.environ)
    _, status, usage = os.wait4(child, 0)
    pathlib.Path(f"{output}.{rank}").write_text(str(usage.ru_maxrss))
    sys.exit(os.waitstatus_to_exitcode(status) & 255)


class Bench:
    def __init__(self, args, folder):
        self.args, self.folder = args, folder

    def made(self, name, make):
        """A file in the directory, created once."""
        file = self.folder / name
        if not file.exists():
            with tempfile.TemporaryDirectory(dir=self.folder) as unfinished:
                make(pathlib.Path(unfinished) / name)
                os.rename(pathlib.Path(unfinished) / name, file)
        return file

    def generated(self, kind, n):
        return self.made(f"{kind}_{n}x{n}x{n}_uint8.raw", lambda file: run([self.args.tessera, "generate", kind, file, f"n={n}", "bits=8", "--quiet"]))

    def converted(self, volume, name):
        return self.made(name, lambda file: run([self.args.tessera, "convert", volume, file, "--quiet"]))

    def nifti(self, volume, n):
        header = bytearray(352)
        struct.pack_into("<i", header, 0, 348)
        struct.pack_into("<8h", header, 40, 3, n, n, n, 1, 1, 1, 1)
        struct.pack_into("<2h", header, 70, 2, 8)
        struct.pack_into("<4f", header, 76, 1, 1, 1, 1)
        struct.pack_into("<f", header, 108, 352)
        header[344:347] = b"n+1"

        def make(file):
            with gzip.open(file, "wb", 1) as out, open(volume, "rb") as samples:
                out.write(header)
                while part := samples.read(1 << 20):
                    out.write(part)
        return self.made(f"head_{n}.nii.gz", make)

    def packed_vti(self, volume, n):
        extent = f"0 {n - 1} " * 3
        head = (f'<?xml version="1.0"?>\n<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian" header_type="UInt64" '
                f'compressor="vtkZLibDataCompressor">\n<ImageData WholeExtent="{extent}" Origin="0 0 0" Spacing="1 1 1"><Piece Extent="{extent}">'
                f'<PointData Scalars="head"><DataArray type="UInt8" Name="head" format="binary">\n')

        def make(file):
            size, blocks = 1 << 15, []
            with open(volume, "rb") as samples:
                while part := samples.read(size):
                    blocks.append(zlib.compress(part, 1))
            table = struct.pack(f"<{3 + len(blocks)}Q", len(blocks), size, n ** 3 % size, *map(len, blocks))
            file.write_bytes(head.encode() + base64.b64encode(table) + base64.b64encode(b"".join(blocks)) +
                             b"\n</DataArray></PointData></Piece></ImageData></VTKFile>\n")
        return self.made(f"head_{n}.vti", make)

    def peaks(self, volume, memory, ranks, *words):
        """MiB of each rank, by rank."""
        with tempfile.TemporaryDirectory() as folder:
            output = pathlib.Path(folder) / "peak"
            start = ["mpirun", "--oversubscribe", "-n", ranks] if ranks > 1 else []
            run([*start, sys.executable, __file__, "--watch", output, self.args.tessera, "render", volume, "-o", f"{folder}/f%d.pfm", "--threads",
                 1 if ranks > 1 else 2, "--memory", memory, "--quiet", *words])
            return [round(int(pathlib.Path(f"{output}.{rank}").read_text()) / 1024) for rank in range(ranks)]


WAYS = {"1": (1, []), "2, sort-first": (2, []), "3, sort-first": (3, []), "2, sort-last": (2, ["--distribution", "sort-last"]),
        "3, sort-last": (3, ["--distribution", "sort-last"])}


def of_processes(bench):
    n, large = bench.args.samples, bench.args.large
    head, vast, few = bench.generated("head", n), bench.generated("radial", large), bench.generated("head", 400)
    turn = ["--size", "512x512", "--orbit", "3"]
    volumes = [(f"`radial` of {large}^3, raw", vast, LARGE_BUDGET, ["--size", "512x512"]), (f"`head` of {n}^3, raw", head, SMALL_BUDGET, turn),
               ("the same, `.vti`, raw", bench.converted(head, f"raw_{n}.vti"), SMALL_BUDGET, turn),
               ("the same, `.vti`, zlib and base64", bench.packed_vti(head, n), SMALL_BUDGET, turn),
               ("the same, `.nii.gz`", bench.nifti(head, n), SMALL_BUDGET, turn),
               ("the same, `.vtr`, raw", bench.converted(head, f"raw_{n}.vtr"), SMALL_BUDGET, turn),
               ("`head` of 400^3, raw, 70 x 50 pixels", few, SMALL_BUDGET, ["--size", "70x50", "--orbit", "12"])]
    lines = ["| volume | file, MiB | `--memory` | " + " | ".join(WAYS) + " |", "|---|---:|---|" + "---|" * len(WAYS)]
    for name, volume, memory, words in volumes:
        peaks = [bench.peaks(volume, memory, ranks, *words, *more) for ranks, more in WAYS.values()]
        lines.append(f"| {name} | {os.path.getsize(volume) / 2 ** 20:,.0f} | {memory} | " + " | ".join(", ".join(map(str, of)) for of in peaks) + " |")
        print(lines[-1], flush=True)
    return lines


def of_sort_last(bench):
    n, memory = bench.args.large, bench.args.memory
    volume, function = bench.converted(bench.generated("radial", n), f"radial_{n}.bricks"), bench.folder / "all.txt"
    # Nothing is clear and nothing opaque, so that every brick is visible; a raw file's voxels have length one.
    function.write_text(f"0 0.1 0.2 0.8 {0.2 / n}\n128 0.9 0.8 0.3 {0.6 / n}\n255 1 0.3 0.1 {1.5 / n}\n")
    lines = ["| way | bricks loaded, by frame | thrown out again, by frame | bricks in memory at the end, all processes | largest resident set of each, MiB |",
             "|---|---|---|---:|---|"]
    for way in ("sort-first", "sort-last"):
        report = bench.folder / f"{way}.json"
        peaks = bench.peaks(volume, memory, RANKS, "--size", "512x512", "--orbit", PATH, "--transfer-function", function, "--projection", "perspective",
                            "--distribution", way, "--report", report)
        counters = [frame["counters"] for frame in json.loads(report.read_text())["frames"]]
        by_frame = lambda name: ", ".join(f"{c[name]:,}" for c in counters)
        lines.append(f"| {way} | {by_frame('bricks_loaded')} | {by_frame('bricks_evicted')} | {counters[-1]['bytes_resident'] / 1e9:.2f} GB | "
                     f"{', '.join(map(str, peaks))} |")
        print(lines[-1], flush=True)
    bricks = counters[-1]["bricks_total"]
    lines += ["", f"`radial` of {n}^3, {os.path.getsize(volume) / 1e9:.2f} GB, {bricks:,} bricks of 32^3; {RANKS} processes of one thread, `--memory {memory}` each, "
              f"{PATH} views once round it at 512 x 512 pixels."]
    return lines


TABLES = {"of processes": of_processes, "of sort-last": of_sort_last}


def main():
    if sys.argv[1:2] == ["--watch"]:
        watch(sys.argv[2], sys.argv[3:])
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tessera", type=pathlib.Path, required=True)
    parser.add_argument("--document", type=pathlib.Path)
    parser.add_argument("--only", choices=TABLES)
    parser.add_argument("--samples", type=int, default=512)
    parser.add_argument("--large", type=int, default=2048)
    parser.add_argument("--memory", default="2700M", help="of a process of the second table")
    parser.add_argument("--folder", type=pathlib.Path)
    args = parser.parse_args()
    args.tessera = args.tessera.resolve()
    for name, table in TABLES.items():
        if args.only not in (None, name):
            continue
        load = os.getloadavg()[0]
        with contextlib.ExitStack() as stack:
            folder = args.folder or pathlib.Path(stack.enter_context(tempfile.TemporaryDirectory()))
            lines = table(Bench(args, folder))
        if args.document:
            results_file.put(args.document, f"memory.py {name}", f"{results_file.made(load)} `{results_file.command('memory.py')}`", lines)


if __name__ == "__main__":
    main()
