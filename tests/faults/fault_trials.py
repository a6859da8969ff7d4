#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Breaks runs under mpirun on purpose and checks how they end.

    fault_trials.py --tessera PROGRAM [--trials N] [--seed S] [--ranks R] [--volume [--sort-last|--mixed]] [--only KIND,...]

Each trial renders a short film on R ranks and breaks it: a rank is killed or terminated at a random time, mpirun is
terminated or killed itself, a rank is stopped and continues or (once a random number of images exists) does not,
the directory of the images is moved away, the disk is full (a small tmpfs, if this user may mount one), or one rank's
piece of the mesh is damaged. Checked after each, whatever the time of the fault and the load of the machine: the run
ends; no process of it remains; one line of ours reports what happened; the status is correct; the directory contains
only complete images, each with the bytes of an undisturbed run. Every fourth trial then runs the same command with
--resume, which must complete the film. --volume films a volume, with --sort-last in parts of it, with --mixed alternately in parts of it
and of the image. A launcher that hangs or crashes alone after a rank died while MPI started is Open MPI's fault
(4.1.4, when it ends PMIx's server), and counted separately.

Prints a line per trial, with the seconds from the fault to the end, and a table of the stages that were reached. Exit
status 1 if any check failed.
"""
import argparse
import collections
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

HANG = 300.0  # seconds, reached only by a hang
ALONE = 30.0  # then a launcher whose ranks have ended is killed, which is not a failure


def processes_of(token):
    """Processes whose command line names the token, by pid."""
    found = []
    for entry in os.listdir("/proc"):
        if not entry.isdigit():
            continue
        try:
            words = Path("/proc", entry, "cmdline").read_bytes().split(b"\0")
            state = Path("/proc", entry, "stat").read_text().rsplit(")", 1)[1].split()[0]
        except (OSError, IndexError):
            continue
        if state != "Z" and any(token.encode() in word for word in words):
            found.append((int(entry), words))
    return found


def ranks_of(film, token):
    return [pid for pid, words in processes_of(token) if words[0] == film.tessera.encode()]


class Film:
    """The command of every trial, and its result without a fault."""

    def __init__(self, tessera, ranks, root, volume=False, sort_last=False):
        root.mkdir()
        self.tessera, self.ranks, self.root = str(tessera), ranks, root
        self.frames = 24
        self.volume = volume
        self.how = ["--distribution", "sort-last"] if sort_last else [] if volume else ["--exchange", "segments"]
        self.mesh = root / ("volume.nrrd" if volume else "mesh.pvtu")
        if volume:
            self.run_tool("generate", "ripples", self.mesh, "n=64")
        else:
            whole = root / "mesh.vtu"
            self.run_tool("generate", "cube", whole, "n=20")
            self.run_tool("convert", whole, self.mesh, "--pieces", "4")
        self.reference = root / "reference"
        self.reference.mkdir()
        trace = root / "trace.json"
        start = time.monotonic()
        done = subprocess.run(self.command(self.reference, self.mesh) + ["--timing", str(trace)], env=environment(),
                              capture_output=True, text=True, timeout=HANG)
        if done.returncode != 0:
            sys.exit(f"fault_trials: the undisturbed run failed: {done.stderr}")
        self.seconds = time.monotonic() - start
        self.pictures = {path.name: path.read_bytes() for path in self.reference.iterdir()}
        assert len(self.pictures) == self.frames
        events = [e for e in json.loads(trace.read_text())["traceEvents"] if e["ph"] == "X" and e["name"] != "frame"]
        self.traced_seconds = max(e["ts"] + e["dur"] for e in events) / 1e6
        self.events = events

    def run_tool(self, *words):
        subprocess.run([self.tessera, *map(str, words), "--quiet"], check=True)

    def command(self, folder, mesh):
        return ["mpirun", "--oversubscribe", "-n", str(self.ranks), self.tessera, "render", str(mesh), "-o",
                str(folder / "frame_%03d.pfm"), "--size", "200x200", "--orbit", str(self.frames), "--threads", "1",
                "--quiet", *self.how]

    def random_time(self, source):
        """When to break the run: at any time, or while some stage is active, each with equal probability, however short it is."""
        if source.random() < 0.5:
            return source.uniform(0, self.seconds)
        stage = source.choice(sorted({e["name"] for e in self.events}))
        event = source.choice([e for e in self.events if e["name"] == stage])
        at = (event["ts"] + source.random() * event["dur"]) / 1e6
        return max(0.01, self.seconds - self.traced_seconds + at)

    def stages_at(self, seconds):
        """The ranks' stages in the undisturbed run at this time before its end."""
        at = (self.traced_seconds - (self.seconds - seconds)) * 1e6
        names = {e["name"] for e in self.events if e["ts"] <= at < e["ts"] + e["dur"]}
        return names or {"start or end"}


def environment():
    return dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                ASAN_OPTIONS="detect_leaks=0")  # leaks of Open MPI itself


def send(pid, number):
    try:
        os.kill(pid, number)
    except ProcessLookupError:
        pass


def pictures_of(folder):
    return list(folder.iterdir()) if folder.exists() else []


def check_folder(film, folder, problems):
    for path in folder.iterdir():
        if path.name not in film.pictures:
            problems.append(f"left {path.name}")
        elif path.read_bytes() != film.pictures[path.name]:
            problems.append(f"{path.name} is not the undisturbed run's")


def stop_in_midst(film, run, token, folder, random_source):
    """Stops a rank once some images exist; returns whether enough were left for every rank to take part in them."""
    wanted = random_source.randrange(1, film.frames // 2)
    while len(pictures_of(folder)) < wanted and run.poll() is None:
        time.sleep(0.002)
    ranks = ranks_of(film, token)
    if not ranks:
        return True  # on a busy machine, a running rank was reported as stopped
    victim = random_source.choice(ranks)
    send(victim, signal.SIGSTOP)
    if len(pictures_of(folder)) <= film.frames - 8:
        return True
    send(victim, signal.SIGCONT)
    return False


def end_of(film, run, token, folder, kind):
    """The output of the run, and whether its launcher remained alone and was killed."""
    until, alone_since = time.monotonic() + HANG, None
    errors = []
    reader = threading.Thread(target=lambda: errors.append(run.communicate()[1]))
    reader.start()
    while reader.is_alive() and time.monotonic() < until:
        reader.join(0.05)
        if kind not in ("kill", "term") or pictures_of(folder) or ranks_of(film, token):
            alone_since = None
        elif alone_since is None:
            alone_since = time.monotonic()
        elif time.monotonic() - alone_since > ALONE:
            break
    hangs = reader.is_alive()
    if hangs:
        for pid, _ in processes_of(token):
            send(pid, signal.SIGKILL)
    reader.join()
    return errors[0], hangs, hangs and alone_since is not None


def trial(film, kind, random_source, number):
    folder = film.root / f"trial_{number}"
    folder.mkdir()
    token = str(folder)
    mesh, mounted, problems = film.mesh, False, []
    if kind == "disk":
        megabytes_for = random_source.randrange(1, film.frames)
        size = megabytes_for * len(next(iter(film.pictures.values()))) + 4096
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", token],
                                 capture_output=True).returncode == 0
        if not mounted:
            folder.rmdir()
            return kind, set(), ["skipped"], 0
    if kind == "piece":
        pieces = film.root / f"damaged_{number}"
        shutil.copytree(film.root, pieces, ignore=shutil.ignore_patterns("trial*", "damaged*", "reference", "*.json"))
        mesh = pieces / "mesh.pvtu"
        victim = random_source.choice(sorted(pieces.glob("mesh_*.vtu")))
        victim.write_bytes(victim.read_bytes()[: random_source.randrange(100, victim.stat().st_size)])

    words = {"pause": ["--stall-timeout", "0.5"], "stall": ["--stall-timeout", "0.5", "--on-stall", "abort"]}
    command = film.command(folder, mesh) + words.get(kind, [])
    if kind == "pause":
        command.remove("--quiet")
    run = subprocess.Popen(command, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    timed = kind in ("kill", "end", "launcher", "term", "pause", "folder")
    delay = film.random_time(random_source) if timed else 0
    moved = film.root / f"moved_{number}"
    in_time = kind != "stall" or stop_in_midst(film, run, token, folder, random_source)
    fault_at = time.monotonic()
    if delay:
        time.sleep(delay)
        fault_at = time.monotonic()
        if kind in ("kill", "term", "pause"):
            ranks = ranks_of(film, token)
            if ranks:
                victim = random_source.choice(ranks)
                paused_for = random_source.uniform(0.8, 2.0) if kind == "pause" else 0
                send(victim, {"kill": signal.SIGKILL, "term": signal.SIGTERM}.get(kind, signal.SIGSTOP))
                time.sleep(paused_for)
                if kind == "pause":
                    send(victim, signal.SIGCONT)
        elif kind == "folder":
            folder.rename(moved)
        elif run.poll() is None:
            run.send_signal(signal.SIGTERM if kind == "end" else signal.SIGKILL)
    errors, hangs, launcher_hangs = end_of(film, run, token, folder, kind)
    if hangs and not launcher_hangs:
        problems.append("it hangs")
    while processes_of(token) and time.monotonic() < fault_at + HANG:
        time.sleep(0.05)
    took = time.monotonic() - fault_at
    if moved.exists():
        moved.rename(folder)
    if left := processes_of(token):
        problems.append(f"{len(left)} processes left")
        for pid, _ in left:
            send(pid, signal.SIGKILL)

    lines = [line for line in errors.splitlines() if line.startswith("tessera: ")]
    finished = run.returncode == 0 and len(list(folder.iterdir())) == film.frames
    began = bool(pictures_of(folder))  # otherwise MPI may not have started when it broke
    launcher_crashes = kind in ("kill", "term") and not began and run.returncode == -signal.SIGSEGV
    if not finished and not launcher_hangs:
        # A rank that dies before MPI has started leaves the report to mpirun; one that is killed while it ends prints
        # nothing.
        midst = began and len(pictures_of(folder)) < film.frames
        speaks = kind in ("disk", "piece") or (kind in ("term", "stall", "folder") and midst)
        if len(lines) > (1 if began else film.ranks) or (speaks and len(lines) != 1):
            problems.append(f"{len(lines)} lines of ours: {lines}")
        wanted = {"launcher": {-9}, "disk": {3}, "piece": {2}, "pause": {0}, "folder": {3} if began else {3, 2}}
        if began:  # otherwise MPI has its own status codes
            wanted |= {"kill": {137, 3}, "term": {3}, "stall": {3}}
        failed = run.returncode not in wanted[kind] if kind in wanted else run.returncode == 0
        if failed and not launcher_crashes:
            problems.append(f"status {run.returncode}, not {sorted(wanted.get(kind, {'an error'}))}")
    elif kind in ("disk", "piece") or (kind == "stall" and in_time):
        problems.append("succeeded")
    check_folder(film, folder, problems)

    if kind != "piece" and not mounted and number % 4 == 0:
        again = subprocess.run(film.command(folder, film.mesh) + ["--resume"], env=environment(), capture_output=True,
                               text=True, timeout=HANG)
        if again.returncode != 0 or len(list(folder.iterdir())) != film.frames:
            problems.append(f"--resume ended with {again.returncode}: {again.stderr}")
        check_folder(film, folder, problems)
    if mounted:
        subprocess.run(["umount", token], check=True)
    shutil.rmtree(folder)
    if (launcher_hangs or launcher_crashes) and not problems:
        kind += " that the launcher does not survive"
    return kind, film.stages_at(delay) if delay else set(), problems, took


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--tessera", required=True, type=Path)
    arguments.add_argument("--trials", type=int, default=20)
    arguments.add_argument("--ranks", type=int, default=4)
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--volume", action="store_true")
    arguments.add_argument("--sort-last", action="store_true")
    arguments.add_argument("--mixed", action="store_true")
    arguments.add_argument("--only", default="", metavar="KIND,...")
    options = arguments.parse_args()
    if shutil.which("mpirun") is None:
        print("skipped: there is no mpirun")
        return 0
    source = random.Random(options.seed)
    root = Path(tempfile.mkdtemp(prefix="tessera_faults_"))
    failures, kinds, stages = 0, collections.Counter(), collections.Counter()
    try:
        ways = (False, True) if options.mixed else (options.sort_last,)
        films = [Film(options.tessera.resolve(), options.ranks, root / f"film{way:d}", options.volume, way) for way in ways]
        seconds = " and ".join(f"{film.seconds:.1f}" for film in films)
        print(f"seed {options.seed}, {options.ranks} ranks, {seconds} s undisturbed")
        for number in range(options.trials):
            kinds_of = [kind for kind in options.only.split(",") if kind] or [
                "kill", "term", "stall", "piece", "pause", "end", "kill", "disk", "folder", "launcher"]
            kind = kinds_of[number % len(kinds_of)]
            if options.volume and kind == "piece":
                kind = "term"
            film = films[(number + number // len(kinds_of)) % len(films)]
            kind, reached, problems, took = trial(film, kind, source, number)
            if problems == ["skipped"]:
                print(f"trial {number}: {kind} skipped")
                continue
            kinds[kind] += 1
            stages.update(reached)
            failures += bool(problems)
            way = " sort-last" if "sort-last" in film.how else ""
            print(f"trial {number}:{way} {kind} {took:.1f} s {'; '.join(problems) or 'ok'}", flush=True)
    finally:
        shutil.rmtree(root)
    print("kinds: " + ", ".join(f"{kind} {count}" for kind, count in kinds.items()))
    print("stages under way when it broke: " + ", ".join(f"{stage} {count}" for stage, count in stages.most_common()))
    print(f"{sum(kinds.values())} trials, {failures} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
