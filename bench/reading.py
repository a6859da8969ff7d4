#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Times reading: `tessera info` compared with VTK's own reader, for a selection of formats.

Files are generated (reading_files.py) and kept in --work. Runs alternate; figures are the minimum of --repeat. For Tessera they cover the whole program, including
making and examining tets: CPU and wall time, and the largest sum of the memory of both processes, sampled every few milliseconds; and its reader program alone.
For VTK they cover the reader's Update() with all arrays, in a separate process, without the time and memory of starting Python and loading VTK. Needs
python3-vtk9, python3-numpy, and python3-h5py for CGNS.
"""
import json
import os
import pathlib
import resource
import subprocess
import sys
import threading
import time

from results import Section, options, run


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
    *figures, cells = json.loads(run(sys.executable, __file__, "--vtk", name, file).out.splitlines()[-1])
    if cells == 0:
        sys.exit(f"reading.py: {file}: VTK reads nothing")
    return figures


def file_of(work, name, n, write):
    """The file of a format, made if it is not there yet, and the megabytes of all that belongs to it."""
    folder = work / "".join(c if c.isalnum() else "_" for c in name)
    note = folder.with_suffix(".name")
    if not note.exists():
        folder.mkdir(exist_ok=True)
        note.write_text(str(write(folder, n).relative_to(work)))
    return work / note.read_text(), sum(f.stat().st_size for f in folder.rglob("*") if f.is_file()) / 1e6


def main():
    if sys.argv[1:2] == ["--vtk"]:
        return read_by_vtk(*sys.argv[2:4])
    import reading_files
    args = options(__doc__, repeat=5, only="")
    section = Section(args)
    section.table("lrrrr", "format", "MB", "VTK: CPU [s], memory [MiB]", "reading program: CPU, memory", "`tessera info`: CPU, memory, wall")
    for name, n, write, reader in reading_files.FORMATS:
        if args.only not in name:
            continue
        file, size = file_of(args.work, name, n, write)
        runs = {"tessera": [], "VTK": []}
        for turn in range(args.repeat):
            for which in ("tessera", "VTK") if turn % 2 == 0 else ("VTK", "tessera"):
                runs[which].append(run_tessera(args.tessera, "info", file) if which == "tessera" else run_vtk(reader, file))
        (wall, cpu, memory, reader_cpu, reader_memory), (vtk_wall, vtk_cpu, vtk_memory) = ([min(figures) for figures in zip(*of)] for of in runs.values())
        section.row(name, f"{size:.0f}", f"{vtk_cpu:.2f}, {vtk_memory / 2**20:.0f}",
                    f"{reader_cpu / vtk_cpu:.2f}x, {reader_memory / vtk_memory:.2f}x" if reader_memory > 0 else "-",
                    f"{cpu / vtk_cpu:.2f}x, {memory / vtk_memory:.2f}x, {wall / vtk_wall:.2f}x")
    section.keep(f"`tessera info` (the whole program) compared with VTK 9.1's reader alone (without loading VTK). Cells are the least of {args.repeat} runs: CPU time, "
                 "peak memory and wall time as multiples of VTK's")


if __name__ == "__main__":
    main()
