# SPDX-License-Identifier: BSD-3-Clause
"""Unreasonable partitions over MPI, compared with one process: the same bits, or the difference.

Each partition is a .pvtu with the stated pieces, rendered by ranks of one thread; `--exchange segments` promises
the bits of one process with the whole mesh, `runs` a difference of 2e-6 at most.
"""
import array
import json
import os
import random
import shutil
import subprocess

from promise_cases import files
from scenes import KNOTS

RANKS = 3


def write_vtu(path, points, cells, scalars, ghosts=None):
    """Points that no cell uses are left out, as by partitioners."""
    used = sorted({v for c in cells for v in c})
    number = {v: i for i, v in enumerate(used)}
    cells = [[number[v] for v in cell] for cell in cells]
    more = f"<CellData>{files.array('vtkGhostType', 'UInt8', ghosts)}</CellData>\n" if ghosts is not None else ""
    return files.write_vtu(path, [points[v] for v in used], cells, [scalars[v] for v in used], more=more)


def write_pvtu(folder, name, pieces, points, scalars):
    """`pieces`: lists of (cell, ghost)."""
    ghosts = any(g for piece in pieces for _, g in piece)
    sources = [write_vtu(folder / f"{name}-{i}.vtu", points, [c for c, _ in piece], scalars, [g for _, g in piece] if ghosts else None).name
               for i, piece in enumerate(pieces)]
    path = folder / f"{name}.pvtu"
    path.write_text(files.document("PUnstructuredGrid", f''' GhostLevel="{int(ghosts)}">
<PPointData><PDataArray type="Float64" Name="f"/></PPointData>
<PCellData>{'<PDataArray type="UInt8" Name="vtkGhostType"/>' if ghosts else ""}</PCellData>
<PPoints><PDataArray type="Float64" NumberOfComponents="3"/></PPoints>
{"".join(f'<Piece Source="{source}"/>' for source in sources)}'''))
    return path


def dealt(cells, count, piece_of):
    pieces = [[] for _ in range(count)]
    for i, cell in enumerate(cells):
        pieces[piece_of(i)].append((cell, 0))
    return pieces


def with_ghosts(pieces):
    """Every piece with its neighbours' touching cells, marked as ghosts (vtkGhostType 1)."""
    out = []
    for i, piece in enumerate(pieces):
        mine = {v for cell, _ in piece for v in cell}
        out.append(piece + [(cell, 1) for j, other in enumerate(pieces) if j != i for cell, _ in other
                            if any(v in mine for v in cell)])
    return out


def partitions(cells):
    r = random.Random(1)
    third = lambda i: i * RANKS // len(cells)
    return [("blocks", RANKS, dealt(cells, RANKS, third)),
            ("random", RANKS, dealt(cells, RANKS, lambda _: r.randrange(RANKS))),
            ("interleaved, every third cell", RANKS, dealt(cells, RANKS, lambda i: i % RANKS)),
            ("one cell here, the rest there", RANKS, dealt(cells, 2, lambda i: int(i != len(cells) // 2))),
            ("ghost cells left in", RANKS, with_ghosts(dealt(cells, RANKS, third))),
            ("pieces without a cell", RANKS, dealt(cells, 7, lambda i: 2 + 3 * (i % 2))),
            ("more ranks than pieces", 5, dealt(cells, 2, lambda i: i % 2))]


def measure(program, maker, folder):
    """[{partition, ranks, same_bits, runs_difference}]; empty without mpirun. A missing image is `failed`."""
    if shutil.which("mpirun") is None:
        return []
    points, cells, scalars = maker.loaded(maker.generated("cube", ".tets", n=6))
    whole = write_vtu(folder / "whole.vtu", points, cells, scalars)
    function = maker.function("partitions", KNOTS)  # the range of the default one is a sample's, which depends on the order of cells
    env = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMPI_MCA_rmaps_base_oversubscribe="1")

    def picture(file, ranks, *words):
        out = folder / "partition.pfm"
        out.unlink(missing_ok=True)
        command = [str(program), "render", str(file), "-o", str(out), "--size", "96x96", "--transfer-function", str(function), "--quiet",
                   "--threads", "1", *words]
        if ranks:
            command = ["mpirun", "--oversubscribe", "-n", str(ranks), *command, "--without", "sharing"]
        done = subprocess.run(command, capture_output=True, text=True, timeout=300, env=env)
        if done.returncode:
            raise RuntimeError(done.stderr.strip().split("\n")[0])
        return out.read_bytes()

    def difference(a, b):
        x, y = array.array("f"), array.array("f")
        body = len(a) - 4 * 3 * 96 * 96
        x.frombytes(a[body:]), y.frombytes(b[body:])
        return max(abs(p - q) for p, q in zip(x, y))

    one, results = picture(whole, 0), []
    for name, ranks, pieces in partitions(cells):
        file = write_pvtu(folder, name.replace(" ", "-").replace(",", ""), pieces, points, scalars)
        row = {"partition": name, "ranks": ranks}
        try:
            row["same_bits"] = picture(file, ranks, "--exchange", "segments", "--partition", "file") == one
            row["runs_difference"] = difference(picture(file, ranks, "--exchange", "runs", "--partition", "file"), one)
        except (RuntimeError, subprocess.TimeoutExpired) as error:
            row["failed"] = str(error)
        results.append(row)
        print(f"partition: {json.dumps(row)}", flush=True)
    return results


def kept(row):
    return row.get("same_bits", False) and row["runs_difference"] <= 2e-6
