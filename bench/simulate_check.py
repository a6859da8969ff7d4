#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""bench/simulate.py compared with real runs: nodes are network namespaces, on a bridge, with links limited by tc.

    bench/simulate_check.py --tessera PROGRAM --work FOLDER [--results docs/RESULTS.md] [--nodes 2,4,8] [--mbit 100,1000] [--side 48]
                            [--size 512] [--frames 14] [--repeat 3]

Needs root, ip, tc and Open MPI. For each number of nodes the same film is traced once without namespaces, over the loopback device: the model
gets only that trace, and predicts the film on limited links. All nodes share this machine's cores, which the model takes into account: also the load of other
programs, measured just before and just after the run that it is compared with, and the system time per byte moved between namespaces (measured first, with
two plain sockets). Every namespace is removed at the end, however the program ends. Needs only Python's standard library.
"""
import argparse
import contextlib
import json
import os
import pathlib
import re
import signal
import statistics
import subprocess
import sys
import time

import results_file
from simulate import GOODPUT, Model, Settings
from simulate_work import work_of

ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", LC_ALL="C")
SENDER = "import socket,sys; s=socket.create_connection((sys.argv[1],7777)); b=bytes(1<<18); [s.sendall(b) for _ in range(int(sys.argv[2]))]"
RECEIVER = """import socket
l=socket.create_server(('',7777)); print(flush=True); c=l.accept()[0]
while c.recv(1<<18): pass"""
GREEDY_COUNT = 4
GREEDY = """import time
begin, cpu = time.monotonic(), time.process_time()
while time.monotonic() < begin + 1.5: pass
print((time.process_time() - cpu) / (time.monotonic() - begin))"""


def call(*words):
    subprocess.run([str(w) for w in words], check=True, capture_output=True, text=True)


@contextlib.contextmanager
def network(nodes, mbit):
    """Names of the nodes' namespaces; node i is 10.77.0.(i+1). The switch has its own, so that nothing else can access it."""
    prefix = f"tessera-{os.getpid()}"
    switch, names = f"{prefix}-switch", [f"{prefix}-{n + 1}" for n in range(nodes)]
    try:
        for name in (switch, *names):
            call("ip", "netns", "add", name)
            call("ip", "-n", name, "link", "set", "lo", "up")
        call("ip", "-n", switch, "link", "add", "name", "bridge0", "type", "bridge")
        call("ip", "-n", switch, "link", "set", "bridge0", "up")
        for n, name in enumerate(names):
            call("ip", "-n", switch, "link", "add", "name", f"port{n}", "type", "veth", "peer", "name", "eth0", "netns", name)
            call("ip", "-n", switch, "link", "set", f"port{n}", "master", "bridge0", "up")
            call("ip", "-n", name, "address", "add", f"10.77.0.{n + 1}/24", "dev", "eth0")
            call("ip", "-n", name, "link", "set", "eth0", "up")
            if mbit:
                burst = max(128, round(mbit * 1e6 / 8 * 1e-3 / 1024))  # KiB; with less, tc cuts TCP's segments of up to 64 KiB into frames
                for space, device in ((name, "eth0"), (switch, f"port{n}")):  # out of the node, and into it
                    call("tc", "-n", space, "qdisc", "add", "dev", device, "root", "tbf", "rate", f"{mbit}mbit", "burst", f"{burst}kb", "latency", "20ms")
        yield names
    finally:
        for name in (*names, switch):
            subprocess.run(["ip", "netns", "delete", name], check=False, capture_output=True)


def others():
    """The load of other programs, in threads that share the cores with ours: derived from the share that busy processes get, each in its own session like
    our ranks. The kernel shares cores among sessions first, so neither the number of the others' threads nor their nice values determine it."""
    greedy = [subprocess.Popen([sys.executable, "-c", GREEDY], start_new_session=True, stdout=subprocess.PIPE, text=True) for _ in range(GREEDY_COUNT)]
    got = sum(float(one.communicate()[0]) for one in greedy)
    return max(0.0, GREEDY_COUNT * os.cpu_count() / got - GREEDY_COUNT)


def byte_cost():
    """Core seconds per byte between namespaces at either end."""
    count = 1200
    with network(2, None) as names:
        before = os.times()
        receiver = subprocess.Popen(["ip", "netns", "exec", names[1], sys.executable, "-c", RECEIVER], stdout=subprocess.PIPE)
        receiver.stdout.readline()
        started = os.times()
        subprocess.run(["ip", "netns", "exec", names[0], sys.executable, "-c", SENDER, "10.77.0.2", str(count)], check=True)
        receiver.wait()
        after = os.times()
    spent = after.children_user + after.children_system - before.children_user - before.children_system
    return spent / 2 / (count << 18), (count << 18) / (after.elapsed - started.elapsed)


def words_of(args, nodes, out):
    mesh = args.work / f"cube-{args.side}.tets"
    if not mesh.exists():
        call(args.tessera, "generate", "cube", mesh, f"n={args.side}", "--quiet")
    # Nodes share no memory. Each has its own session, because the kernel shares cores among sessions first.
    return ["setsid", "--wait", args.tessera, "render", mesh, "--size", f"{args.size}x{args.size}", "--orbit", args.frames, "-o", args.work / "frame_%04d.png",
            "--threads", "1", "--without", "sharing", "--projectors", nodes, "--compositors", nodes, "--report", out.with_suffix(".report.json"),
            "--timing", out.with_suffix(".trace.json"), "--quiet"]


def mpirun(prefix, words, patience=300):
    """Runs until it ends, or kills it with all that it has started."""
    process = subprocess.Popen([str(w) for w in [*prefix, *words]], env=ENVIRONMENT, stdin=subprocess.DEVNULL, start_new_session=True)
    try:
        if process.wait(patience) != 0:
            raise SystemExit(f"mpirun ended with {process.returncode}")
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGTERM)
            process.wait(10)


def frame_seconds(out):
    """Mean of the frames that the model counts: it has no first one, and needs one as a start."""
    frames = json.loads(out.with_suffix(".report.json").read_text())["frames"]
    return statistics.mean(f["frame_ms"][0] for f in frames[2:]) * 1e-3


def trace(args, nodes):
    out = args.work / f"base-{nodes}"
    mpirun(["mpirun", "--oversubscribe", "--bind-to", "none", "--map-by", "node", "--mca", "btl", "tcp,self", "-n", 2 * nodes],
           words_of(args, nodes, out))
    return work_of(out.with_suffix(".trace.json"))


AGENT = """#!/bin/sh
# Open MPI calls: agent HOST COMMAND. Each node has a name and a folder of its own.
host=$1; shift
node=${host##*.}
mkdir -p WORK/node-$node
exec ip netns exec PREFIX-$node unshare --uts sh -c "hostname tessera-node-$node; export TMPDIR=WORK/node-$node; $*"
"""


def measure(args, nodes, mbit):
    """A run on limited links: seconds per frame, the load of others in threads, and its own trace's work."""
    out = args.work / f"real-{nodes}-{mbit}"
    with network(nodes, mbit) as names:
        agent = args.work / "agent.sh"
        agent.write_text(AGENT.replace("PREFIX", names[0].rsplit("-", 1)[0]).replace("WORK", str(args.work)))
        agent.chmod(0o755)
        hosts = ",".join(f"10.77.0.{n + 1}:2" for n in range(nodes))
        before = others()
        mpirun(["ip", "netns", "exec", names[0], "mpirun", "--host", hosts, "--map-by", "node", "--bind-to", "none", "--oversubscribe",
                "--mca", "plm_rsh_agent", agent, "--mca", "btl", "tcp,self", "--mca", "btl_tcp_if_include", "eth0",
                "--mca", "oob_tcp_if_include", "eth0", "-n", 2 * nodes], words_of(args, nodes, out))
        after = others()
    return frame_seconds(out), (before + after) / 2, work_of(out.with_suffix(".trace.json"))


def row(nodes, mbit, found):
    """A line of the table: for each run (measured, others, predicted, replayed)."""
    def cells(at):
        errors = [100 * (one[at] / one[0] - 1) for one in found]
        return f"{statistics.median(errors):+.0f} (" + ", ".join(f"{e:+.0f}" for e in errors) + ")"
    measured = ", ".join(f"{1e3 * one[0]:.0f}" for one in found)
    return f"| {nodes} | {mbit} | {measured} | {max(one[1] for one in found):.1f} | {cells(2)} | {cells(3)} |"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--tessera", type=pathlib.Path, required=True)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--results", type=pathlib.Path)
    parser.add_argument("--nodes", default="2,4,8")
    parser.add_argument("--mbit", default="100,1000")
    parser.add_argument("--side", type=int, default=48)
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--frames", type=int, default=14)
    parser.add_argument("--repeat", type=int, default=3)
    args = parser.parse_args()
    args.tessera, args.work = args.tessera.resolve(), args.work.resolve()
    args.work.mkdir(parents=True, exist_ok=True)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # so that namespaces are removed
    load = os.getloadavg()[0]
    byte, speed = byte_cost()
    print(f"{1e9 * byte:.2f} ns of a core for a byte at either end; {8e-9 * speed:.1f} Gbit/s without limit", flush=True)
    lines = ["| nodes | Mbit/s | measured, each run [ms] | others | error of the prediction [%]: median (each) | error of the replay [%]: median (each) |",
             "|---:|---:|---|---:|---|---|"]
    for nodes in map(int, args.nodes.split(",")):
        for mbit in map(int, args.mbit.split(",")):
            found = []
            for _ in range(args.repeat):
                before = trace(args, nodes)
                real, rivals, own = measure(args, nodes, mbit)
                settings = Settings(bytes_per_second=mbit * 1e6 / 8 * GOODPUT, latency=50e-6, cores=os.cpu_count(), shared=True, others=rivals,
                                    byte_cpu=byte)
                found.append((real, rivals, Model(before, settings).run(), Model(own, settings).run()))
            lines.append(row(nodes, mbit, found))
            print(lines[-1], flush=True)
    if args.results:
        made = re.sub(r"\.$", "", results_file.made(load))
        results_file.put(args.results, "simulate_check.py", f"{made}. `{results_file.command('simulate_check.py')}`: {1e9 * byte:.2f} ns of a core for a "
                         f"byte at either end.", lines)


if __name__ == "__main__":
    begin = time.monotonic()
    main()
    print(f"{time.monotonic() - begin:.0f} s")
