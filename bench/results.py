#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The measured tables of docs/RESULTS.md and docs/ACCURACY.md, made from docs/results/*.json; and what the scripts of bench/ share.

    bench/results.py            writes the tables into the documents
    bench/results.py --check    reports each document that differs; exit status 1 if one does

A section is between two marks of a document, `<!-- NAME begin -->` and `<!-- NAME end -->`; its name begins with that of the script that measured it. Its
caption, tables and paragraphs are in docs/results/, in the file named after the script. `--write` of a script replaces its sections there and in the document.
"""
import argparse
import datetime
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import textwrap
import time
import types

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent
STORE = ROOT / "docs" / "results"
DOCUMENTS = [ROOT / "docs" / "RESULTS.md", ROOT / "docs" / "ACCURACY.md"]
WIDTH = 160  # columns of a line of Markdown
VIEW = ["--camera", HERE / "camera.txt", "--transfer-function", HERE / "transfer_function.txt"]  # of all performance figures
EXACT = ["--integrator", "exact"]
MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
PROGRAMS = ROOT / "build/release/bench"  # of -DTESSERA_BENCH=ON
PYTHON_OF_VTK = ["xvfb-run", "-a", "/usr/bin/python3"]
DATA = {"oxygen-post": ("oxygen-post/postxyz.bin", "oxygen-post/postq.bin"), "bluntfin": ("bluntfin/bluntfinxyz.bin", "bluntfin/bluntfinq.bin"),
        "bracket": ("bracket/bracket_appended_compressed.vtu",), "disk-out": ("disk-out/disk_out_ref.ex2",), "notch": ("notch/notch_stress_fixed.vtk",),
        "unisim": ("unisim/UNISIM-II-D.vtu",), "heptane": ("volumes/heptane.nii.gz",), "LIDC2": ("volumes/LIDC2.vti",), "engine": ("volumes/engine.nii.gz",),
        "carotid": ("volumes/carotid.vtk",)}  # in the directory of --data: PLOT3D's coordinates and values, or one file


# ---- Running programs ------------------------------------------------------------------------------------------------

def options(doc, **more):
    """The arguments of a script: --tessera, --work, --write and `more`, whose values are defaults, types or tuples of choices."""
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tessera", type=pathlib.Path, default=ROOT / "build/release/apps/tessera", help="the program (default: of build/release)")
    parser.add_argument("--work", type=pathlib.Path, help="folder of inputs, which are kept (default: a temporary one)")
    parser.add_argument("--write", action="store_true", help="write the tables into docs/")
    for name, value in more.items():
        how = {"choices": value} if isinstance(value, tuple) else {"type": value} if isinstance(value, type) else {"type": pathlib.Path if isinstance(value, pathlib.Path) else type(value), "default": value}
        parser.add_argument("--" + name.replace("_", "-"), **how)
    args = parser.parse_args()
    args.tessera = args.tessera.resolve()
    if not args.tessera.exists():
        parser.error(f"{args.tessera}: no such program; build it or name it with --tessera")
    args.temporary = tempfile.TemporaryDirectory()  # removed at exit
    args.work = (args.work or pathlib.Path(args.temporary.name)).resolve()
    args.work.mkdir(parents=True, exist_ok=True)
    return args


def run(*command, ranks=1, good=(0,)):
    """Runs a command, by mpirun if it has several ranks, and ends the script if it fails: its output, seconds of wall and CPU time, KiB of memory."""
    launch = ["mpirun", "--oversubscribe", "-n", ranks] if ranks > 1 else []
    words = [str(word) for word in [*launch, *command]]
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
        begin = time.monotonic()
        process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=out, stderr=err, env=os.environ | MPI)
        try:
            _, status, usage = os.wait4(process.pid, 0)
        except BaseException:  # a signal
            process.terminate()
            process.wait()
            raise
        wall, process.returncode = time.monotonic() - begin, os.waitstatus_to_exitcode(status)
        texts = [file.seek(0) or file.read() for file in (out, err)]
    if process.returncode not in good:
        sys.exit(f"{pathlib.Path(sys.argv[0]).name}: {' '.join(words)}\n{texts[1].strip()}")
    return types.SimpleNamespace(out=texts[0], err=texts[1], wall=wall, cpu=usage.ru_utime + usage.ru_stime, memory=usage.ru_maxrss)


def generated(args, file, kind, *parameters):
    """A data set of `tessera generate` in --work, made if it is not there yet."""
    if not (args.work / file).exists():
        run(args.tessera, "generate", kind, args.work / file, *parameters, "--quiet")
    return args.work / file


def render(args, data, *words, ranks=1, picture="picture.pfm", program=None):
    """The report of `tessera render`, which report.json in --work has too, with the run as its `run`. Pixels that --verify finds too far off do not count as a failure."""
    report = args.work / "report.json"
    done = run(program or args.tessera, "render", data, "-o", args.work / picture, "--report", report, "--quiet", *words, ranks=ranks, good=(0, 4))
    return json.loads(report.read_text()) | {"run": done}


def written(path, content):
    """A path, after writing text or JSON to it."""
    path.write_text(content if isinstance(content, str) else json.dumps(content))
    return path


def data_words(args, name):
    """Words of a command that reads a data set of DATA."""
    if args.data is None:
        sys.exit(f"{pathlib.Path(sys.argv[0]).name}: name the directory of the data sets with --data")
    file, *values = (args.data / file for file in DATA[name])
    return [file, *(["--q", *values] if values else [])]


def knots_of(path):
    """The numbers of a transfer function's lines."""
    return [[float(word) for word in line.split()] for line in path.read_text().splitlines() if line.strip() and line[0] != "#"]


def rotation(centre, distance, frames, degrees, height=0.0, angle=30):
    """Views around the y axis, `degrees` apart."""
    for n in range(frames):
        a = math.radians(degrees * n) + 0.3
        yield {"position": [centre[0] + distance * math.cos(a), centre[1] + height, centre[2] + distance * math.sin(a)], "focal_point": list(centre),
               "view_up": [0, 1, 0], "view_angle": angle}


def exclusive(spans):
    """For nested spans of a trace, the CPU time of each without those inside: (span, seconds)."""
    found, open_spans = [], []
    for span in sorted(spans, key=lambda s: (s["ts"], -s["dur"])):
        while open_spans and span["ts"] >= open_spans[-1][0]["ts"] + open_spans[-1][0]["dur"]:
            found.append(tuple(open_spans.pop()))
        seconds = span["args"].get("cpu_us", 0) * 1e-6
        if open_spans:
            open_spans[-1][1] -= seconds
        open_spans.append([span, seconds])
    return found + [tuple(one) for one in open_spans]


def spans_of(trace):
    """A parsed trace's spans without whole frames, by (rank, thread)."""
    threads = {}
    for event in trace["traceEvents"]:
        if event["ph"] == "X" and event["name"] != "frame":
            threads.setdefault((event["pid"], event["tid"]), []).append(event)
    return threads


# ---- Captions --------------------------------------------------------------------------------------------------------

def commit():
    done = subprocess.run(["git", "-C", ROOT, "describe", "--always", "--dirty"], capture_output=True, text=True)
    return done.stdout.strip() or "unknown"


def machine():
    """The processor's name, and its number of cores unless that is two, as docs/RESULTS.md states of all machines."""
    names = (line.split(":", 1)[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name"))
    cores = "" if os.cpu_count() == 2 else f", {os.cpu_count()} cores"
    return next(names, "unknown CPU").replace("(R)", "").removesuffix(" Processor") + cores


def command(part=""):
    """The command line of this run, without the options that name programs, directories and outputs, and without --only for the one part measured."""
    words, rest = [], iter(sys.argv[1:])
    for word in rest:
        name, _, value = word.partition("=")
        if name in ("--tessera", "--work", "--data", "--programs") or (name == "--only" and part):
            None if value else next(rest, None)
        elif name != "--write":
            words.append(word)
    return " ".join([str(pathlib.Path(sys.argv[0]).resolve().relative_to(ROOT)), *words])


def error(x):
    """1.2e-7: two digits in the fewest columns."""
    return f"{x:.1e}".replace("e-0", "e-")


# ---- Sections --------------------------------------------------------------------------------------------------------

class Section:
    """A section while it is measured. Tables are printed row by row."""

    def __init__(self, args, part=""):
        self.args, self.blocks, self.load = args, [], os.getloadavg()[0]
        self.name = " ".join(filter(None, [pathlib.Path(sys.argv[0]).name, part]))

    def table(self, align, *columns):
        """Begins a table; `align` has an l or r for each column."""
        assert len(align) == len(columns), columns
        self.blocks.append({"align": align, "columns": list(columns), "rows": []})
        print("\n".join(["", *table_lines(self.blocks[-1])]), flush=True)

    def row(self, *cells):
        assert len(cells) == len(self.blocks[-1]["columns"]), cells
        self.blocks[-1]["rows"].append([str(cell) for cell in cells])
        print(row_line(self.blocks[-1]["rows"][-1]), flush=True)

    def text(self, words):
        self.blocks.append(words)
        print(f"\n{words}", flush=True)

    def made(self):
        return f"{datetime.date.today().isoformat()}, commit {commit()}: {machine()}, load {self.load:.1f}/{os.getloadavg()[0]:.1f}."

    def keep(self, note="", made=""):
        """Writes the section if --write is given; the caption is `made` (default: date, commit, machine, load), the command and the note."""
        made = made or self.made()
        if self.args.write:
            script, _, part = self.name.partition(" ")
            path = STORE / (script.partition(".")[0] + ".json")
            sections = json.loads(path.read_text()) if path.exists() else {}
            sections[self.name] = {"caption": f"{made} `{command(part)}`{note and ': '}{note}", "blocks": self.blocks}
            path.write_text(dumped(sections))
            update()


def measure_parts(args, parts):
    """A section for each part of a script, or for that of --only: `parts` are functions of arguments and section, which return the caption's note."""
    for name, part in parts.items():
        if args.only in (None, name):
            section = Section(args, name)
            section.keep(part(args, section) or "")


def dumped(sections):
    """JSON with a line for each row of a table."""
    text = json.dumps(sections, indent=1, ensure_ascii=False)
    return re.sub(r'\[\n\s+("(?:[^"\\]|\\.)*"(?:,\n\s+"(?:[^"\\]|\\.)*")*)\n\s+\]', lambda m: "[" + re.sub(r",\n\s+", ", ", m[1]) + "]", text) + "\n"


def row_line(cells):
    return f"| {' | '.join(cells)} |"


def table_lines(block):
    rule = "|" + "|".join({"l": "---", "r": "---:"}[a] for a in block["align"]) + "|"
    return [row_line(block["columns"]), rule, *map(row_line, block["rows"])]


def markdown(name, section):
    lines = [f"<!-- {name} begin -->"]
    for block in filter(None, [section["caption"], *section["blocks"]]):
        if isinstance(block, dict):
            lines += [*table_lines(block), ""]
        else:
            lines += [textwrap.fill(block, WIDTH, break_long_words=False, break_on_hyphens=False), ""]
    return "\n".join([*lines[:-1], f"<!-- {name} end -->"])


def update(check=False):
    """Writes all sections into the documents, or lists what differs."""
    sections = {name: section for path in sorted(STORE.glob("*.json")) for name, section in json.loads(path.read_text()).items()}
    faults, found = [], set()
    for document in DOCUMENTS:
        text = document.read_text(encoding="utf-8")
        names = re.findall(r"<!-- (.+) begin -->", text)
        faults += [f"{document.name}: {name}: docs/results/ has no such section" for name in names if name not in sections]
        found.update(names)
        made = text
        for name in filter(sections.get, names):
            marks = re.escape(f"<!-- {name} begin -->") + ".*?" + re.escape(f"<!-- {name} end -->")
            made = re.sub(marks, lambda _: markdown(name, sections[name]), made, flags=re.S)
        if check and made != text:
            line = next(n for n, (a, b) in enumerate(zip(f"{made}\n0".splitlines(), f"{text}\n1".splitlines()), 1) if a != b)
            faults.append(f"{document.name}:{line}: differs from docs/results/; run bench/results.py")
        elif made != text:
            document.write_text(made, encoding="utf-8")
    faults += [f"docs/results/: {name}: no document has its marks" for name in sections if name not in found]
    return faults


if __name__ == "__main__":
    if sys.argv[1:] not in ([], ["--check"]):
        sys.exit(__doc__)
    failures = update("--check" in sys.argv)
    print("\n".join(failures) or "The tables are those of docs/results/.")
    sys.exit(1 if failures else 0)
