#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of `tessera serve` while it is busy: views get their turn among images and films, it ends soon whatever it
is doing, and leaves nothing behind; clients without a token do not block others.

    serve_turns_test.py --tessera PROGRAM [--without-mpi]
"""

import argparse
import http.client
import json
import os
import select
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from serve_client import HANG, Server  # noqa: E402

MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
MPIRUN = ["mpirun", "--oversubscribe", "-n", "2"]

options = None
with_fake_ffmpeg = None  # an environment with a fake ffmpeg, whose film is the sequence of images received


def check(holds, words):
    if not holds:
        raise AssertionError(words)


def await_that(holds, words):
    given_up = time.monotonic() + HANG
    while not holds():
        check(time.monotonic() < given_up, f"waited in vain: {words}")
        time.sleep(0.01)


class Long:
    """A long request, running until it is answered."""

    def __init__(self, server, path, body):
        self.connection = http.client.HTTPConnection(server.host, server.port, timeout=HANG)
        self.connection.request("POST", path, json.dumps(body), {"Authorization": f"Bearer {server.token}"})

    def answered(self):
        return bool(select.select([self.connection.sock], [], [], 0)[0])

    def status(self):
        """0: the connection ended without an answer."""
        try:
            return self.connection.getresponse().status
        except (http.client.HTTPException, OSError):
            return 0


def picture_in_work(server, state):
    """An image in progress, large enough for that to be observed."""
    for size in ("2000x2000", "4000x4000", "8000x8000"):
        picture = Long(server, "/picture", {"state": dict(state, size=size)})
        while not picture.answered():
            if server.json("GET", "/api/progress")["picture"] is not None:
                return picture
        check(picture.status() == 200, "no picture")
    raise AssertionError("every picture is there before the server says how far it is")


def film_in_work(server, state, frames=10_000):
    film = Long(server, "/film", {"state": dict(state, size="64x48"), "orbit": frames, "format": "mp4"})
    await_that(lambda: server.json("GET", "/api/progress")["film"] is not None, "a film")
    return film


def views_go_on(file):
    with Server(options.tessera, file, environment=with_fake_ffmpeg) as server:
        state = dict(server.data()["defaults"], size="64x48")
        client = server.socket()
        client.receive()
        number = 0

        def shown_meanwhile(begin):
            """Whether a view requested after that began arrives before it is finished; otherwise tries again."""
            nonlocal number
            long = begin()
            number += 1
            client.state(number, dict(state, azimuth=str(number % 360)))
            client.last_frame(number)
            was_first = not long.answered()
            long.connection.close()
            return was_first

        check(any(shown_meanwhile(lambda: picture_in_work(server, state)) for _ in range(20)), "no view during a picture")
        check(shown_meanwhile(lambda: film_in_work(server, state)), "no view during a film")
        for name in ("picture", "film"):  # its client has disconnected
            await_that(lambda of=name: server.json("GET", "/api/progress")[of] is None, f"the end of a {name}")
        check(server.stop() == (0, ""), "it does not end well")


def ends_at_any_time(file):
    def is_cut_short(begin, how):
        """Whether the current request was ended with the server; it may be finished before the signal arrives."""
        with Server(options.tessera, file) as server:
            at_hand = begin(server, server.data()["defaults"])
            status, errors = server.stop(how)
            check(status == 0 and errors == "", f"{how}: ended with {status}: {errors}")
            return at_hand.status() in (0, 503)

    for how in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
        check(any(is_cut_short(picture_in_work, how) for _ in range(10)), "pictures are made to their end")

    # A task that cannot be stopped does not keep the server running.
    def verify(server, defaults):
        state = dict(defaults, size="2000x2000")
        verified = Long(server, "/api/verify", {"state": state, "pixels": 100_000})
        server.json("POST", "/api/camera", {"state": state})
        return verified

    check(any(is_cut_short(verify, signal.SIGTERM) for _ in range(10)), "verifications are made to their end")
    # Two signals: both arrive before it can respond to one.
    with Server(options.tessera, file) as server:
        server.data()
        server.process.send_signal(signal.SIGSTOP)
        for how in (signal.SIGINT, signal.SIGTERM):
            server.process.send_signal(how)
        server.process.send_signal(signal.SIGCONT)
        _, errors = server.process.communicate(timeout=HANG)
        check(server.process.returncode in (130, 143) and errors == "", f"{server.process.returncode}: {errors}")


def sockets_of(process):
    found = set()
    for descriptor in Path(f"/proc/{process}/fd").iterdir():
        try:
            target = os.readlink(descriptor)
        except OSError:
            continue
        if target.startswith("socket:"):
            found.add(target)
    return found


def films_leave_nothing(file):
    for how in (signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGKILL):
        with tempfile.TemporaryDirectory() as scratch, \
                Server(options.tessera, file, environment=dict(with_fake_ffmpeg, TMPDIR=scratch)) as server:
            state = dict(server.data()["defaults"], size="64x48")
            status, _, film = server.ask("POST", "/film", {"state": state, "orbit": 2, "format": "mp4"})
            check(status == 200 and len(film) == 2 * 3 * 64 * 48, f"{status}, {len(film)} bytes")
            for rate, expected in ((1e-300, 400), (0.009, 400), (1001, 400), (0.01, 200), (1000, 200)):
                status, _, _ = server.ask("POST", "/film", {"state": state, "orbit": 1, "rate": rate})
                check(status == expected, f"a film of rate {rate}: {status}")
            client = server.socket()
            client.receive()
            in_work = film_in_work(server, state)  # kept referenced, because it stops with its connection
            children = []

            def has_begun(parent=server.process.pid, found=children):
                """Its name appears a moment later."""
                found[:] = subprocess.run(["pgrep", "-P", str(parent), "ffmpeg"], capture_output=True, text=True,
                                          check=False).stdout.split()
                return len(found) == 1

            await_that(has_begun, "ffmpeg")
            shared = sockets_of(children[0]) & sockets_of(server.process.pid)
            check(not shared, f"ffmpeg has {len(shared)} sockets of the server")
            server.stop(how)
            in_work.connection.close()
            await_that(lambda of=children[0]: not Path(f"/proc/{of}").exists(), "the end of ffmpeg")
            check(os.listdir(scratch) == [], f"{how} leaves {os.listdir(scratch)}")


def strangers_keep_nobody_out(file):
    with Server(options.tessera, file) as server:
        server.data()
        client = server.socket()
        client.receive()
        strangers = []
        for number in range(300):
            strangers.append(socket.create_connection((server.host, server.port), timeout=HANG))
            strangers[-1].sendall([b"", b"GET / HTTP/1.1\r\nX: ", b"GET /api/data HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"][number % 3])
            if number % 3 == 0:
                check(server.ask("GET", "/api/progress")[0] == 200, f"not answered beside {number} strangers")
        check(strangers[0].recv(1) == b"", "the oldest stranger is still there")
        strangers[-1].sendall(b"GET /api/data HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
        check(strangers[-1].recv(12) == b"HTTP/1.1 403", "the newest stranger is not answered")
        client.send_bytes(b"", 9)
        check(client.receive() == {"type": "pong"}, "a client lost its socket to strangers")
        for stream in strangers:
            stream.close()
        # Clients over the limit are informed.
        clients = [client]
        while (last := server.socket()).status == 101:
            clients.append(last)
            check(len(clients) <= 256, "more clients than it takes")
        check(last.status == 503 and len(clients) == 256, f"{last.status} after {len(clients)} clients")
        # A request with a second Host, which a proxy may use.
        clients.pop().close()
        await_that(lambda: server.ask("GET", "/api/progress")[0] == 200, "room for a request")
        with socket.create_connection((server.host, server.port), timeout=HANG) as stream:
            stream.sendall(f"GET /api/progress?token={server.token} HTTP/1.1\r\nHost: 127.0.0.1\r\nHost: localhost\r\n\r\n".encode())
            check(stream.recv(12) == b"HTTP/1.1 400", "two hosts")


def stopped_ranks_are_named(file):
    with Server(options.tessera, file, "--stall-timeout", "1", launcher=MPIRUN, environment=MPI) as server:
        server.data()
        ranks = subprocess.run(["pgrep", "-P", str(server.process.pid), "-f", "serve"], capture_output=True, text=True,
                               check=True).stdout.split()
        os.kill(int(ranks[1]), signal.SIGSTOP)
        line = ""
        while "has been silent" not in line:
            line = server.process.stderr.readline()
            check(line, "it ended without a word of the rank that is stopped")
        check(f"(process {ranks[1]} on" in line, line)
        os.kill(int(ranks[1]), signal.SIGCONT)
        while "is back" not in line:
            line = server.process.stderr.readline()
            check(line, "it ended without a word of the rank that is back")
        check(server.ask("GET", "/api/data")[0] == 200, "it does not go on")


def main():
    global options, with_fake_ffmpeg
    parser = argparse.ArgumentParser()
    parser.add_argument("--tessera", required=True)
    parser.add_argument("--without-mpi", action="store_true")
    options = parser.parse_args()
    options.tessera = str(Path(options.tessera).resolve())
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "ball.vtu"
        subprocess.run([options.tessera, "generate", "ball", file, "levels=3"], capture_output=True, check=True)
        fake_ffmpeg = Path(folder) / "ffmpeg"
        fake_ffmpeg.write_text("#!/bin/sh\nfor output; do :; done\ncat > \"$output\"\n")
        fake_ffmpeg.chmod(0o755)
        with_fake_ffmpeg = {"PATH": f"{folder}:{os.environ['PATH']}"}
        parts = [views_go_on, ends_at_any_time, films_leave_nothing, strangers_keep_nobody_out]
        if not options.without_mpi and shutil.which("mpirun"):
            parts.append(stopped_ranks_are_named)
        for part in parts:
            start = time.monotonic()
            part(file)
            print(f"{part.__name__}: {time.monotonic() - start:.1f} s", flush=True)


if __name__ == "__main__":
    main()
