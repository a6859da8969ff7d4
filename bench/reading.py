#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Times reading: `tessera info` compared with VTK's own reader, for every format that VTK's Python module reads as a volume.

    bench/reading.py --tessera PROGRAM [--work FOLDER] [--repeat 5] [--only TEXT] [--results docs/RESULTS.md]

    bench/reading.py --tessera PROGRAM --old PROGRAM ...    compares the two programs instead: `tessera render`, 8 x 8 pixels with
                                                            a given function, so that neither computes a default one

Files are generated (reading_files.py) and kept in --work. Runs alternate; figures are the minimum of --repeat. For Tessera they cover the
whole program, including making and examining tets: CPU and wall time, and the largest sum of the memory of both processes, sampled
every few milliseconds; and its reader program alone. For VTK they cover the reader's Update() with all arrays, in a separate process, without the time
and memory of starting Python and loading VTK. Needs python3-vtk9, python3-numpy, and python3-h5py for CGNS and VTKHDF.
"""
import argparse
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import threading
import time

import results_file

PYTHON = sys.executable
FUNCTION, CAMERA = (pathlib.Path(__file__).with_name(f"{name}.txt") for name in ("transfer_function", "camera"))


def children_of(process):
    return [int(child) for child in open(f"/proc/{process}/task/{process}/children").read().split()]


def in_use(process):
    """Bytes of a process that no file on a disk backs: its own memory, and unnamed files that it has open or mapped."""
    own = shared = 0
    for line in open(f"/proc/{process}/status"):
        if line.startswith("RssAnon:"):
            own = 1024 * int(line.split()[1])
        elif line.startswith("RssShmem:"):
            shared = 1024 * int(line.split()[1])
    nameless = {}
    for name in os.listdir(f"/proc/{process}/fd"):
        file = f"/proc/{process}/fd/{name}"
        if os.readlink(file).startswith("/memfd:"):
            facts = os.stat(file)
            nameless[facts.st_ino] = 512 * facts.st_blocks
    return own, max(shared, sum(nameless.values()))


class Watch(threading.Thread):
    """Samples a process and the one that it started: the largest sum of their memory, and the resources of the started one."""

    def __init__(self, process):
        super().__init__()
        self.process, self.ended = process, threading.Event()
        self.peak = self.reader_peak = self.reader_seconds = 0
        self.start()

    def run(self):
        while not self.ended.wait(0.002):
            try:
                own, shared = in_use(self.process)
                for child in children_of(self.process):
                    its_own, its_shared = in_use(child)
                    self.reader_peak = max(self.reader_peak, its_own + its_shared)
                    self.reader_seconds = max(self.reader_seconds, int(open(f"/proc/{child}/schedstat").read().split()[0]) / 1e9)
                    own, shared = own + its_own, max(shared, its_shared)  # both report the same
                self.peak = max(self.peak, own + shared)
            except (OSError, ValueError):
                pass  # one has ended

    def stop(self):
        self.ended.set()
        self.join()


def run_tessera(program, *words):
    """Seconds of wall and CPU time, bytes; for the reader program seconds of CPU time and bytes."""
    begin = time.monotonic()
    process = subprocess.Popen([str(program), *map(str, words)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    watch = Watch(process.pid)
    message = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    wall = time.monotonic() - begin
    watch.stop()
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise RuntimeError(message.decode().strip())
    return wall, usage.ru_utime + usage.ru_stime, watch.peak, watch.reader_seconds, watch.reader_peak


def read_by_vtk(name, file):
    """In a separate process: prints the same values as run_tessera()."""
    import vtk

    vtk.vtkObject.GlobalWarningDisplayOff()
    reader = getattr(vtk, name)()
    if name == "vtkDICOMImageReader":
        reader.SetDirectoryName(file)
    elif name == "vtkGenericEnSightReader":
        reader.SetCaseFileName(file)
    elif name == "vtkNrrdReader":  # the parallel one replaces it
        reader.SetController(vtk.vtkDummyController())
        reader.SetFileName(file)
    elif name == "vtkMultiBlockPLOT3DReader":
        reader.SetXYZFileName(file)
        reader.SetQFileName(str(pathlib.Path(file).with_suffix(".q")))
        reader.SetBinaryFile(1)
        reader.SetByteOrderToLittleEndian()
        reader.SetHasByteCount(0)
        reader.SetMultiGrid(0)
    else:
        reader.SetFileName(file)

    def memory(what):
        return next(1024 * int(line.split()[1]) for line in open("/proc/self/status") if line.startswith(what))

    pathlib.Path("/proc/self/clear_refs").write_text("5")  # resets the peak
    before, begin, used = memory("VmRSS"), time.monotonic(), resource.getrusage(resource.RUSAGE_SELF)
    reader.UpdateInformation()
    for enable in ("EnableAllCellArrays", "EnableAllPointArrays", "EnableAllBases", "ReadAllVariablesOn"):
        if hasattr(reader, enable):
            getattr(reader, enable)()
    if name == "vtkExodusIIReader":
        for kind in (vtk.vtkExodusIIReader.NODAL, vtk.vtkExodusIIReader.ELEM_BLOCK):
            reader.SetAllArrayStatus(kind, 1)
    if name == "vtkAMReXGridReader":
        reader.SetMaxLevel(10)
        for k in range(reader.GetNumberOfCellArrays()):
            reader.SetCellArrayStatus(reader.GetCellArrayName(k), 1)
    if name == "vtkXMLUniformGridAMRReader":
        reader.SetMaximumLevelsToReadByDefault(0)
    reader.Update()
    after = resource.getrusage(resource.RUSAGE_SELF)
    data = reader.GetOutputDataObject(0)
    count = 0 if data is None else data.GetNumberOfElements(vtk.vtkDataObject.CELL) or data.GetNumberOfElements(vtk.vtkDataObject.POINT)
    cpu = after.ru_utime + after.ru_stime - used.ru_utime - used.ru_stime
    print(json.dumps([time.monotonic() - begin, cpu, memory("VmHWM") - before, count]))


def run_vtk(name, file):
    done = subprocess.run([PYTHON, __file__, "--vtk", name, str(file)], capture_output=True, text=True, check=True)
    *figures, cells = json.loads(done.stdout.splitlines()[-1])
    if cells == 0:
        raise RuntimeError("VTK reads nothing")
    return figures


def least(runs):
    return [min(figures) for figures in zip(*runs)]


def measure(args, work):
    """A row per format: name, MB, and for both readers wall time, CPU time and memory, the minimum of each."""
    import reading_files

    for name, n, write, reader in reading_files.FORMATS:
        if not any(word in name for word in args.only.split(",")):
            continue
        folder = work / "".join(c if c.isalnum() else "_" for c in name)
        try:
            if not folder.exists():
                folder.mkdir(parents=True)
                file = write(folder, n)
                (work / f"{folder.name}.name").write_text(str(file.relative_to(work)))
            file = work / (work / f"{folder.name}.name").read_text()
            first, second = [], []
            tiny = ["render", file, "-o", work / "tiny.pfm", "--size", "8x8", "--quiet", "--transfer-function", FUNCTION,
                    "--camera", CAMERA]
            words = tiny if args.old else ["info", file]
            sides = [(first, lambda: run_tessera(args.tessera, *words)),
                     (second, lambda: run_tessera(args.old, *words) if args.old else run_vtk(reader, file))]
            for turn in range(args.repeat):
                for runs, run in sides if turn % 2 == 0 else sides[::-1]:
                    runs.append(run())
        except (RuntimeError, OSError, subprocess.CalledProcessError, AttributeError, ImportError) as error:
            print(f"{name}: {getattr(error, 'stderr', None) or error}", file=sys.stderr, flush=True)
            continue
        size = sum(f.stat().st_size for f in folder.rglob("*") if f.is_file()) / 1e6
        yield name, size, least(first), least(second)


def main():
    if sys.argv[1:2] == ["--vtk"]:
        return read_by_vtk(*sys.argv[2:4])
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tessera", type=pathlib.Path, required=True)
    parser.add_argument("--old", type=pathlib.Path)
    parser.add_argument("--work", type=pathlib.Path)
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--only", default="")
    parser.add_argument("--results", type=pathlib.Path)
    args = parser.parse_args()
    load = os.getloadavg()[0]
    other = "before" if args.old else "VTK"
    table = [f"| format | MB | {other}: CPU [s], memory [MiB] | reading program: CPU, memory | {'`tessera render`' if args.old else '`tessera info`'}: CPU, memory, wall |", "|---|---:|---:|---:|---:|"]
    print("\n".join(table), flush=True)
    with tempfile.TemporaryDirectory() as folder:
        for name, size, own, others in measure(args, args.work or pathlib.Path(folder)):
            wall, cpu, memory = (a / b for a, b in zip(own[:3], others[:3]))
            reader = f"{own[3] / others[1]:.2f}x, {own[4] / others[2]:.2f}x" if own[4] > 0 else "-"
            table.append(f"| {name} | {size:.0f} | {others[1]:.2f}, {others[2] / 2**20:.0f} | {reader} | {cpu:.2f}x, {memory:.2f}x, {wall:.2f}x |")
            print(table[-1], flush=True)
    if args.results:
        what = ("`tessera render` of 8 x 8 pixels with view and function given, and an older program" if args.old else
                "`tessera info`, the whole program, and VTK 9.1's reader alone, without loading it")
        caption = (f"{results_file.made(load)} `{results_file.command('reading.py')}`: {what}; the least of {args.repeat} runs; CPU and wall time and peak "
                   f"memory as multiples of the others'")
        results_file.put(args.results, "reading.py old" if args.old else "reading.py", caption, table)


if __name__ == "__main__":
    main()
