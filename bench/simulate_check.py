#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""bench/simulate.py compared with real runs: nodes are network namespaces, on a bridge, with links limited by tc.

Needs root, ip, tc and Open MPI. For each number of nodes the same film is traced once without namespaces, over the loopback device: the model gets only that
trace, and predicts the film on limited links. All nodes share this machine's cores, which the model takes into account: also the load of other programs, measured
just before and just after the run that it is compared with, and the system time per byte moved between namespaces (measured first, with two plain sockets).
Every namespace is removed at the end, however the program ends.
"""
import contextlib
import json
import os
import signal
import statistics
import subprocess
import sys

from results import Section, generated, options, run, written
from simulate import GOODPUT, Model, Settings
from simulate_work import work_of

SENDER = "import socket,sys; s=socket.create_connection((sys.argv[1],7777)); b=bytes(1<<18); [s.sendall(b) for _ in range(int(sys.argv[2]))]"
RECEIVER = """import socket
l=socket.create_server(('',7777)); print(flush=True); c=l.accept()[0]
while c.recv(1<<18): pass"""
GREEDY_COUNT = 4
GREEDY = """import time
begin, cpu = time.monotonic(), time.process_time()
while time.monotonic() < begin + 1.5: pass
print((time.process_time() - cpu) / (time.monotonic() - begin))"""


@contextlib.contextmanager
def network(nodes, mbit):
    """Names of the nodes' namespaces; node i is 10.77.0.(i+1). The switch has its own, so that nothing else can access it."""
    prefix = f"tessera-{os.getpid()}"
    switch, names = f"{prefix}-switch", [f"{prefix}-{n + 1}" for n in range(nodes)]
    try:
        for name in (switch, *names):
            run("ip", "netns", "add", name)
            run("ip", "-n", name, "link", "set", "lo", "up")
        run("ip", "-n", switch, "link", "add", "name", "bridge0", "type", "bridge")
        run("ip", "-n", switch, "link", "set", "bridge0", "up")
        for n, name in enumerate(names):
            run("ip", "-n", switch, "link", "add", "name", f"port{n}", "type", "veth", "peer", "name", "eth0", "netns", name)
            run("ip", "-n", switch, "link", "set", f"port{n}", "master", "bridge0", "up")
            run("ip", "-n", name, "address", "add", f"10.77.0.{n + 1}/24", "dev", "eth0")
            run("ip", "-n", name, "link", "set", "eth0", "up")
            if mbit:
                burst = max(128, round(mbit * 1e6 / 8 * 1e-3 / 1024))  # KiB; with less, tc cuts TCP's segments of up to 64 KiB into frames
                for space, device in ((name, "eth0"), (switch, f"port{n}")):  # out of the node, and into it
                    run("tc", "-n", space, "qdisc", "add", "dev", device, "root", "tbf", "rate", f"{mbit}mbit", "burst", f"{burst}kb", "latency", "20ms")
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


def film(args, nodes, *launch):
    """Seconds of a frame and the work of the trace. Nodes share no memory. Each rank has its own session, because the kernel shares cores among sessions first."""
    trace, report = args.work / "trace.json", args.work / "report.json"
    run("timeout", "300", *launch, "--oversubscribe", "--bind-to", "none", "--map-by", "node", "--mca", "btl", "tcp,self", "-n", 2 * nodes, "setsid", "--wait",
        args.tessera, "render", generated(args, "cube-48.tets", "cube", "n=48"), "--size", "512x512", "--orbit", args.frames, "-o", args.work / "frame_%04d.png",
        "--threads", "1", "--without", "sharing", "--projectors", nodes, "--compositors", nodes, "--report", report, "--timing", trace, "--quiet")
    # The model has no first frame, and needs one as a start.
    return statistics.mean(f["frame_ms"][0] for f in json.loads(report.read_text())["frames"][2:]) * 1e-3, work_of(trace)


AGENT = """#!/bin/sh
# Open MPI calls: agent HOST COMMAND. Each node has a name and a folder of its own.
host=$1; shift
node=${host##*.}
mkdir -p WORK/node-$node
exec ip netns exec PREFIX-$node unshare --uts sh -c "hostname tessera-node-$node; export TMPDIR=WORK/node-$node; $*"
"""


def limited(args, nodes, mbit):
    """A run on limited links: seconds per frame, the load of others in threads, and its own trace's work."""
    with network(nodes, mbit) as names:
        agent = written(args.work / "agent.sh", AGENT.replace("PREFIX", names[0].rsplit("-", 1)[0]).replace("WORK", str(args.work)))
        agent.chmod(0o755)
        hosts = ",".join(f"10.77.0.{n + 1}:2" for n in range(nodes))
        before = others()
        seconds, work = film(args, nodes, "ip", "netns", "exec", names[0], "mpirun", "--host", hosts, "--mca", "plm_rsh_agent", agent, "--mca",
                             "btl_tcp_if_include", "eth0", "--mca", "oob_tcp_if_include", "eth0")
        return seconds, (before + others()) / 2, work


def main():
    args = options(__doc__, nodes="2,4,8", mbit="100,1000", frames=14, repeat=3)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # so that namespaces are removed
    byte, speed = byte_cost()
    print(f"{8e-9 * speed:.1f} Gbit/s without limit", flush=True)
    section = Section(args)
    section.table("rrlrll", "nodes", "Mbit/s", "measured, each run [ms]", "others", "error of the prediction [%]: median (each)",
                  "error of the replay [%]: median (each)")
    for nodes in map(int, args.nodes.split(",")):
        for mbit in map(int, args.mbit.split(",")):
            found = []
            for _ in range(args.repeat):
                _, before = film(args, nodes, "mpirun")
                real, rivals, own = limited(args, nodes, mbit)
                settings = Settings(bytes_per_second=mbit * 1e6 / 8 * GOODPUT, latency=50e-6, cores=os.cpu_count(), shared=True, others=rivals,
                                    byte_cpu=byte)
                found.append((real, rivals, *(100 * (Model(work, settings).run() / real - 1) for work in (before, own))))
            measured, load, *errors = zip(*found)
            section.row(nodes, mbit, ", ".join(f"{1e3 * seconds:.0f}" for seconds in measured), f"{max(load):.1f}",
                        *(f"{statistics.median(of):+.0f} ({', '.join(f'{e:+.0f}' for e in of)})" for of in errors))
    section.keep(f"in the model, a byte takes {1e9 * byte:.2f} ns of a core at each end of a link.")


if __name__ == "__main__":
    main()
