#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Juliachs et al. 2007, Table 1 and Figure 9: how rendering scales with nodes.

    bench/scaling.py --tessera PROGRAM --work FOLDER [--results docs/RESULTS.md] [--frames 50] [--nodes 2,4,8] [--millions 15.7,51.1]

Cubes with these numbers of tetrahedra are generated and kept in --work; each node has a projector and a compositor process, as printed, of one
thread each. Every run leaves a file of figures in --work, and is not repeated if that exists: so an interrupted run can be continued, and
a later commit needs a new directory.

Measured from the traces of all ranks (`render --timing`): CPU time per rank and stage, bytes and messages, the largest memory of a
rank, imbalance. With a core for each rank, wall time too. With fewer, the time of a frame is that of a *stated model*
(model_of): processes have a core each, and work on several frames at once, so a frame takes as long as the slowest resource: a projector, a
compositor, or the data on a node's link in one direction. Effects that it ignores (contention, waiting, the last tile) make it a lower bound.
Needs only Python's standard library.
"""
import argparse
import collections
import json
import math
import os
import pathlib
import resource
import subprocess
import sys
import time

import results_file

PRINTED = {15.7: {2: (878, 1.0), 4: (1572, 0.89), 8: (2533, 0.72)}, 51.1: {2: (1021, 1.0), 4: (1861, 0.91), 8: (3406, 0.83)}}  # kTets/s, efficiency
SIZE = 1024
LINK = 1.25e9  # bytes per second and direction: 10 Gbit
STAGES = {"projector": ("transform", "cull", "bin", "project", "sort", "integrate", "composite", "pack", "send", "other"),
          "compositor": ("receive", "sort", "integrate", "composite", "assemble", "write", "send", "other")}
COLOURS = ("#4e79a7", "#f28e2b", "#e15759", "#76b7b2", "#59a14f", "#edc948", "#b07aa1", "#ff9da7", "#9c755f", "#bab0ac", "#1b9e77", "#a6761d", "#7570b3")


def as_rank(folder, command):
    """Runs a rank and records its largest memory."""
    status = subprocess.run(command, check=False).returncode
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024
    (pathlib.Path(folder) / f"memory-{os.environ['OMPI_COMM_WORLD_RANK']}").write_text(str(peak))
    return status


def exclusive(spans):
    """For nested spans, the CPU time of each without those inside: (span, seconds)."""
    found, open_spans = [], []
    for span in sorted(spans, key=lambda s: (s["ts"], -s["dur"])):
        while open_spans and span["ts"] >= open_spans[-1][0]["ts"] + open_spans[-1][0]["dur"]:
            found.append(tuple(open_spans.pop()))
        seconds = span["args"].get("cpu_us", 0) * 1e-6
        if open_spans:
            open_spans[-1][1] -= seconds
        open_spans.append([span, seconds])
    return found + [tuple(one) for one in open_spans]


def figures_of(trace, ranks):
    """For each rank: its role, and per frame the CPU seconds of its stages, bytes and messages sent and received."""
    threads = collections.defaultdict(list)
    for event in json.loads(trace.read_text())["traceEvents"]:
        if event["ph"] == "X" and event["name"] != "frame":
            threads[event["pid"], event["tid"]].append(event)
    of_rank = [{"role": "", "frames": collections.defaultdict(collections.Counter)} for _ in range(ranks)]
    for (rank, _), spans in threads.items():
        for span, seconds in exclusive(spans):
            args = span["args"]
            of_rank[rank]["role"] = args.get("role", "") or of_rank[rank]["role"]
            stage = span["name"]
            if stage in ("read", "partition", "prepare") or (stage == "send" and "frame" not in args):
                continue  # once per mesh
            frame = of_rank[rank]["frames"][args.get("frame", 0)]
            if stage != "wait":
                frame[stage if stage in STAGES[args["role"]] else "other"] += max(seconds, 0)
            if stage in ("send", "receive"):
                frame["bytes " + stage] += args.get("bytes", 0)
                frame["messages"] += args.get("messages", 0) if stage == "send" else 0
    return [{"role": one["role"], "frames": [dict(one["frames"][k]) for k in sorted(one["frames"])]} for one in of_rank]


def run(args, million, nodes):
    """One run's figures, from its file if it exists."""
    kept = args.work / f"{million}-{nodes}.json"
    if kept.exists():
        return json.loads(kept.read_text())
    side = round((million * 1e6 / 6) ** (1 / 3))
    mesh = args.work / f"cube-{side}.tets"
    if not mesh.exists():
        subprocess.run([args.tessera, "generate", "cube", mesh, f"n={side}", "--quiet"], check=True)
    ranks = 2 * nodes
    scratch = args.work / "scratch"
    scratch.mkdir(exist_ok=True)
    for old in scratch.iterdir():
        old.unlink()
    words = ["render", mesh, "--size", f"{SIZE}x{SIZE}", "--orbit", str(args.frames), "-o", scratch / "frame_%04d.png", "--threads", "1",
             "--timing", scratch / "trace.json", "--report", scratch / "report.json", "--quiet",
             "--without", "sharing", "--projectors", str(nodes), "--compositors", str(nodes)]
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    begin, load = time.monotonic(), os.getloadavg()[0]
    subprocess.run(["mpirun", "--oversubscribe", "-n", str(ranks), sys.executable, __file__, "--as-rank", scratch, args.tessera, *words],
                   check=True, env=environment, stdin=subprocess.DEVNULL)
    report = json.loads((scratch / "report.json").read_text())
    figures = {"million": million, "nodes": nodes, "tets": report["mesh"]["tets"], "frames": args.frames,
               "commit": results_file.commit(), "load": load, "wall": time.monotonic() - begin,
               "ranks": figures_of(scratch / "trace.json", ranks),
               "memory": [int((scratch / f"memory-{r}").read_text()) for r in range(ranks)],
               "frame_ms": [f["frame_ms"][0] for f in report["frames"]]}
    kept.write_text(json.dumps(figures))
    print(f"{kept.name}: {figures['wall']:.0f} s", flush=True)
    return figures


def busy(frame):
    return sum(v for k, v in frame.items() if not k.startswith(("bytes", "messages")))


def model_of(figures):
    """Seconds of a frame, and the resource that limits it: see above. The first frame, which includes initialization, does not count."""
    ranks = figures["ranks"]
    frames = range(1, figures["frames"])
    parts = collections.Counter()
    for f in frames:
        at = [one["frames"][f] if f < len(one["frames"]) else {} for one in ranks]
        parts["a projector"] += max(busy(a) for a, one in zip(at, ranks) if one["role"] == "projector")
        parts["a compositor"] += max(busy(a) for a, one in zip(at, ranks) if one["role"] == "compositor")
        for way in ("send", "receive"):
            node = collections.Counter()
            for r, a in enumerate(at):
                node[r % figures["nodes"]] += a.get("bytes " + way, 0)
            parts["link " + way] += max(node.values()) / LINK
    parts["a link"] = max(parts.pop("link send"), parts.pop("link receive"))
    slowest = max(parts, key=parts.get)
    return parts[slowest] / len(frames), slowest, {k: v / len(frames) for k, v in parts.items()}


def sums(figures, role):
    """CPU seconds a frame by stage: (average over the role's ranks, each rank's)."""
    ranks = [one for one in figures["ranks"] if one["role"] == role]
    totals = []
    for one in ranks:
        total = collections.Counter()
        for frame in one["frames"][1:]:
            total.update(frame)
        totals.append({k: v / (figures["frames"] - 1) for k, v in total.items()})
    average = {stage: sum(t.get(stage, 0) for t in totals) / len(totals) for stage in STAGES[role]}
    return average, totals


def table_1(runs, has_cores):
    lines = ["| M tets | nodes | printed: kTets/s | efficiency | here: kTets/s | efficiency | slowest |", "|---:|---:|---:|---:|---:|---:|---|"]
    first = {}
    for r in sorted(runs, key=lambda r: (r["million"], r["nodes"])):
        million, nodes = r["million"], r["nodes"]
        seconds, slowest, _ = model_of(r)
        if has_cores:
            seconds, slowest = sum(r["frame_ms"][1:]) / (r["frames"] - 1) * 1e-3, "wall time"
        rate = r["tets"] / seconds / 1e3
        base_rate, base_nodes = first.setdefault(million, (rate, nodes))
        printed = PRINTED.get(million, {}).get(nodes)
        printed = f"{printed[0]} | {printed[1]:.2f}" if printed else "- | -"
        lines.append(f"| {million} | {nodes} | {printed} | {rate:.0f} | {rate / base_rate * base_nodes / nodes:.2f} | {slowest} |")
    return lines


def figure_9(runs):
    lines = []
    for role in ("projector", "compositor"):
        some = sorted(runs, key=lambda r: (r["million"], r["nodes"]))
        shown = [s for s in STAGES[role] if any(sums(r, role)[0][s] >= 5e-5 for r in some)]
        lines += [f"{role.capitalize()}s: CPU time a frame [ms], average over ranks (worst rank):", "",
                  "| M tets | nodes | " + " | ".join(shown) + " | all | imbalance |", "|---:|---:|" + "---:|" * (len(shown) + 2)]
        for r in some:
            average, totals = sums(r, role)
            cells = [f"{1e3 * average[s]:.1f}" for s in shown]
            all_of = [busy(t) for t in totals]
            mean = sum(all_of) / len(all_of)
            lines.append(f"| {r['million']} | {r['nodes']} | " + " | ".join(cells) +
                         f" | {1e3 * mean:.1f} ({1e3 * max(all_of):.1f}) | {max(all_of) / mean:.2f} |")
        lines.append("")
    return lines


def traffic(runs):
    lines = ["| M tets | nodes | MB a frame, all | busiest rank, sent / received | messages | largest memory of a rank [MiB] | load | commit |",
             "|---:|---:|---:|---:|---:|---:|---:|---|"]
    for r in sorted(runs, key=lambda r: (r["million"], r["nodes"])):
        totals = sums(r, "projector")[1] + sums(r, "compositor")[1]
        sent, received = ([t.get("bytes " + way, 0) / 1e6 for t in totals] for way in ("send", "receive"))
        lines.append(f"| {r['million']} | {r['nodes']} | {sum(sent):.1f} | {max(sent):.1f} / {max(received):.1f} | "
                     f"{sum(t.get('messages', 0) for t in totals):.0f} | {max(r['memory']) / 2**20:.0f} | {r['load']:.1f} | {r['commit']} |")
    return lines


def draw(runs, path):
    """Figure 9 as stacked bars: a group of nodes for each role."""
    million = min(r["million"] for r in runs)
    bar, gap, height, top = 34, 14, 220, 40
    parts, x = [], 20
    for role in ("projector", "compositor"):
        some = sorted((r for r in runs if r["million"] == million), key=lambda r: r["nodes"])
        most = max(sum(sums(r, other)[0].values()) for r in some for other in STAGES) or 1
        parts.append(f'<text x="{x}" y="{top - 18}" font-weight="bold">{role}s</text><text x="{x}" y="{top - 4}">scale {1e3 * most:.0f} ms</text>')
        for r in some:
            y = top + height
            for stage in STAGES[role]:
                long = sums(r, role)[0][stage] / most * (height - 10)
                y -= long
                colour = COLOURS[(STAGES["projector"] + ("receive", "assemble", "write")).index(stage) % len(COLOURS)]
                parts.append(f'<rect x="{x}" y="{y:.1f}" width="{bar}" height="{long:.1f}" fill="{colour}"><title>{stage}</title></rect>')
            parts.append(f'<text x="{x + bar / 2}" y="{top + height + 14}" text-anchor="middle">{r["nodes"]}</text>')
            x += bar + gap
        x += 40
    names = STAGES["projector"] + ("receive", "assemble", "write")
    for n, stage in enumerate(names):
        at = 20 + n % 7 * 95, top + height + 34 + n // 7 * 18
        parts.append(f'<rect x="{at[0]}" y="{at[1] - 9}" width="10" height="10" fill="{COLOURS[n % len(COLOURS)]}"/><text x="{at[0] + 14}" y="{at[1]}">{stage}</text>')
    wide = max(x, 720)
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" width="{wide}" height="{top + height + 66}" font-family="sans-serif" font-size="12">'
                    f'<rect width="100%" height="100%" fill="white"/>{"".join(parts)}</svg>\n')


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--tessera", type=pathlib.Path, required=True)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--results", type=pathlib.Path)
    parser.add_argument("--frames", type=int, default=50)
    parser.add_argument("--nodes", default="2,4,8")
    parser.add_argument("--millions", default="15.7,51.1")
    args = parser.parse_args()
    args.tessera, args.work = args.tessera.resolve(), args.work.resolve()
    args.work.mkdir(parents=True, exist_ok=True)
    runs = [run(args, float(m), int(n)) for m in args.millions.split(",") for n in args.nodes.split(",")]
    has_cores = os.cpu_count() >= max(2 * r["nodes"] for r in runs)
    text = [*table_1(runs, has_cores), *figure_9(runs), *traffic(runs)]
    print("\n".join(text))
    if args.results:
        name, cores = results_file.processor()
        caption = f"{name}, {cores} cores. `{results_file.command('scaling.py')}`"
        results_file.put(args.results, "scaling.py table 1", caption, table_1(runs, has_cores))
        results_file.put(args.results, "scaling.py figure 9", caption, [*figure_9(runs), *traffic(runs)])
        draw(runs, args.results.parent / "images" / "scaling-figure9.svg")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--as-rank"]:
        sys.exit(as_rank(sys.argv[2], sys.argv[3:]))
    main()
