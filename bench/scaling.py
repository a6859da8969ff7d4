#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Juliachs et al. 2007, Table 1 and Figure 9: how rendering scales with nodes.

    bench/scaling.py --work FOLDER [--frames 50] [--nodes 2,4,8] [--millions 15.7,51.1] [--write]

Cubes with these numbers of tetrahedra are generated and kept in --work; each node has a projector and a compositor process, as in the paper, of one thread each.
Every run leaves a file of figures in --work, and is not repeated if that exists: so an interrupted run can be continued, and a later commit needs a new directory.

Measured from the traces of all ranks (`render --timing`): CPU time per rank and stage, bytes, the largest memory of a rank, imbalance. The time of a frame is that
of a *stated model* (model_of): processes have a core each, and work on several frames at once, so a frame takes as long as the slowest resource: a projector, a
compositor, or the data on a node's link in one direction. Effects that it ignores (contention, waiting, the last tile) make it a lower bound.
"""
import collections
import json
import os
import pathlib
import resource
import shutil
import subprocess
import sys

from results import ROOT, Section, commit, exclusive, generated, machine, options, render, spans_of

PRINTED = {15.7: {2: (878, 1.0), 4: (1572, 0.89), 8: (2533, 0.72)}, 51.1: {2: (1021, 1.0), 4: (1861, 0.91), 8: (3406, 0.83)}}  # kTets/s, efficiency
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


def figures_of(trace, ranks):
    """For each rank: its role, and per frame the CPU seconds of its stages, bytes sent and received."""
    of_rank = [{"role": "", "frames": collections.defaultdict(collections.Counter)} for _ in range(ranks)]
    for (rank, _), spans in spans_of(json.loads(trace.read_text())).items():
        for span, seconds in exclusive(spans):
            args, stage = span["args"], span["name"]
            of_rank[rank]["role"] = args.get("role", "") or of_rank[rank]["role"]
            if stage in ("read", "partition", "prepare") or (stage == "send" and "frame" not in args):
                continue  # once per mesh
            frame = of_rank[rank]["frames"][args.get("frame", 0)]
            if stage != "wait":
                frame[stage if stage in STAGES[args["role"]] else "other"] += max(seconds, 0)
            if stage in ("send", "receive"):
                frame["bytes " + stage] += args.get("bytes", 0)
    return [{"role": one["role"], "frames": [dict(one["frames"][k]) for k in sorted(one["frames"])]} for one in of_rank]


def run(args, million, nodes):
    """One run's figures, from its file if it exists."""
    kept = args.work / f"{million}-{nodes}.json"
    if kept.exists():
        return json.loads(kept.read_text())
    side = round((million * 1e6 / 6) ** (1 / 3))
    mesh, ranks, scratch = generated(args, f"cube-{side}.tets", "cube", f"n={side}"), 2 * nodes, args.work / "scratch"
    shutil.rmtree(scratch, ignore_errors=True)
    scratch.mkdir()
    launcher = scratch / "rank.sh"
    launcher.write_text(f'#!/bin/sh\nexec "{sys.executable}" "{__file__}" --as-rank "{scratch}" "{args.tessera}" "$@"\n')
    launcher.chmod(0o755)
    load = os.getloadavg()[0]
    report = render(args, mesh, "--size", "1024x1024", "--orbit", args.frames, "--threads", "1", "--timing", scratch / "trace.json", "--without", "sharing",
                    "--projectors", nodes, "--compositors", nodes, ranks=ranks, picture="scratch/frame_%04d.png", program=launcher)
    figures = {"million": million, "nodes": nodes, "tets": report["mesh"]["tets"], "frames": args.frames, "commit": commit(), "load": load,
               "ranks": figures_of(scratch / "trace.json", ranks), "memory": [int((scratch / f"memory-{r}").read_text()) for r in range(ranks)]}
    kept.write_text(json.dumps(figures))
    print(f"{kept.name}: {report['run'].wall:.0f} s", flush=True)
    return figures


def busy(frame):
    return sum(v for k, v in frame.items() if not k.startswith("bytes"))


def model_of(figures):
    """Seconds of a frame, and the resource that limits it: see above. The first frame, which includes initialization, does not count."""
    ranks, parts = figures["ranks"], collections.Counter()
    for f in range(1, figures["frames"]):
        at = [one["frames"][f] if f < len(one["frames"]) else {} for one in ranks]
        for role in STAGES:
            parts["a " + role] += max(busy(a) for a, one in zip(at, ranks) if one["role"] == role)
        for way in ("send", "receive"):
            node = collections.Counter()
            for r, a in enumerate(at):
                node[r % figures["nodes"]] += a.get("bytes " + way, 0)
            parts["a link: " + way] += max(node.values()) / LINK
    slowest = max(parts, key=parts.get)
    return parts[slowest] / (figures["frames"] - 1), slowest


def sums(figures, role):
    """CPU seconds a frame by stage: (average over the role's ranks, each rank's)."""
    totals = []
    for one in figures["ranks"]:
        if one["role"] == role:
            total = collections.Counter()
            for frame in one["frames"][1:]:
                total.update(frame)
            totals.append({k: v / (figures["frames"] - 1) for k, v in total.items()})
    return {stage: sum(t.get(stage, 0) for t in totals) / len(totals) for stage in STAGES[role]}, totals


def table_1(runs, section):
    section.table("rrrrrr", "M tets", "nodes", "paper: kTets/s", "efficiency", "ours: kTets/s", "efficiency")
    first = {}
    for r in runs:
        million, nodes = r["million"], r["nodes"]
        rate = r["tets"] / model_of(r)[0] / 1e3
        base_rate, base_nodes = first.setdefault(million, (rate, nodes))
        printed, efficiency = PRINTED.get(million, {}).get(nodes, ("-", float("nan")))
        section.row(million, nodes, printed, f"{efficiency:.2f}", f"{rate:.0f}", f"{rate / base_rate * base_nodes / nodes:.2f}")
    print("slowest:", ", ".join(model_of(r)[1] for r in runs))


def figure_9(runs, section):
    for role in STAGES:
        shown = [s for s in STAGES[role] if any(sums(r, role)[0][s] >= 5e-5 for r in runs)]
        section.text(f"{role.capitalize()}s: CPU time per frame [ms], average over ranks (worst rank):")
        section.table("r" * (4 + len(shown)), "M tets", "nodes", *shown, "all", "imbalance")
        for r in runs:
            average, totals = sums(r, role)
            all_of = [busy(t) for t in totals]
            mean = sum(all_of) / len(all_of)
            section.row(r["million"], r["nodes"], *(f"{1e3 * average[s]:.1f}" for s in shown), f"{1e3 * mean:.1f} ({1e3 * max(all_of):.1f})",
                        f"{max(all_of) / mean:.2f}")
    section.table("rrrr", "M tets", "nodes", "MB per frame, all", "largest memory of a rank [MiB]")
    for r in runs:
        sent = sum(t.get("bytes send", 0) for role in STAGES for t in sums(r, role)[1])
        section.row(r["million"], r["nodes"], f"{sent / 1e6:.1f}", f"{max(r['memory']) / 2**20:.0f}")


def draw(runs, path):
    """Figure 9 as stacked bars: a group of nodes for each role."""
    some = [r for r in runs if r["million"] == runs[0]["million"]]
    bar, gap, height, top, x, parts = 34, 14, 220, 40, 20, []
    names = STAGES["projector"] + ("receive", "assemble", "write")
    most = max(sum(sums(r, role)[0].values()) for r in some for role in STAGES) or 1
    for role in STAGES:
        parts.append(f'<text x="{x}" y="{top - 18}" font-weight="bold">{role}s</text><text x="{x}" y="{top - 4}">scale {1e3 * most:.0f} ms</text>')
        for r in some:
            y = top + height
            for stage in STAGES[role]:
                long = sums(r, role)[0][stage] / most * (height - 10)
                y -= long
                parts.append(f'<rect x="{x}" y="{y:.1f}" width="{bar}" height="{long:.1f}" fill="{COLOURS[names.index(stage)]}"><title>{stage}</title></rect>')
            parts.append(f'<text x="{x + bar / 2}" y="{top + height + 14}" text-anchor="middle">{r["nodes"]}</text>')
            x += bar + gap
        x += 40
    for n, stage in enumerate(names):
        at = 20 + n % 7 * 95, top + height + 34 + n // 7 * 18
        parts.append(f'<rect x="{at[0]}" y="{at[1] - 9}" width="10" height="10" fill="{COLOURS[n]}"/><text x="{at[0] + 14}" y="{at[1]}">{stage}</text>')
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" width="{max(x, 720)}" height="{top + height + 66}" font-family="sans-serif" font-size="12">'
                    f'<rect width="100%" height="100%" fill="white"/>{"".join(parts)}</svg>\n')


def main():
    args = options(__doc__, frames=50, nodes="2,4,8", millions="15.7,51.1")
    runs = [run(args, m, n) for m in sorted(map(float, args.millions.split(","))) for n in sorted(map(int, args.nodes.split(",")))]
    section = Section(args, "table 1")
    table_1(runs, section)
    section.keep(made=f"{machine()}.")
    section = Section(args, "figure 9")
    figure_9(runs, section)
    commits = " and ".join(f"{', '.join(dict.fromkeys(r['commit'] for r in runs if r['million'] == m))} ({m} million tetrahedra)" for m in
                           dict.fromkeys(r["million"] for r in runs))
    loads = [r["load"] for r in runs]
    section.keep(made=f"{machine()}, commits {commits}, loads of {min(loads):.1f} to {max(loads):.1f}.")
    if args.write:
        draw(runs, ROOT / "docs" / "images" / "scaling-figure9.svg")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--as-rank"]:
        sys.exit(as_rank(sys.argv[2], sys.argv[3:]))
    main()
