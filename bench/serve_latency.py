#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Latency of `tessera serve` on the server's side: from sending a state to receiving its frame.

    serve_latency.py --tessera PROGRAM FILE [--size 1024x768] [--frames 200] [--latency 100] [--ranks N]

A client rotates the data by one degree at a time, and acknowledges each frame at once as painted. Prints median and 95 %
while moving, after a warm-up of 20 frames, the size of the images and how many showed a preview, and the time of the
exact image at rest compared with `tessera render` for the same image.
"""

import argparse
import math
import os
import re
import shlex
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent / "tests/server"))
from serve_client import Server  # noqa: E402

WARM_UP = 20


def turned(camera, degrees):
    """The camera, rotated around the z axis through its focal point."""
    angle = math.radians(degrees)
    focus, eye = camera["focal_point"], camera["position"]
    x, y = eye[0] - focus[0], eye[1] - focus[1]
    return dict(camera, position=[focus[0] + x * math.cos(angle) - y * math.sin(angle),
                                  focus[1] + x * math.sin(angle) + y * math.cos(angle), eye[2]])


def render_ms(tessera, command, file, launcher):
    """Time of `tessera render` for a frame, with a server's command line: the minimum of five."""
    words = shlex.split(command)
    words[0], words[2] = tessera, str(file)
    with tempfile.TemporaryDirectory() as folder:
        words[-1] = f"{folder}/picture.png"
        done = subprocess.run([*launcher, *words, "--repeat", "5"], capture_output=True, text=True, check=True)
    return float(re.search(r"frame_ms median .* min ([0-9.]+)", done.stdout)[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tessera", required=True)
    parser.add_argument("file")
    parser.add_argument("--size", default="1024x768")
    parser.add_argument("--frames", type=int, default=200)
    parser.add_argument("--latency", default="100")
    parser.add_argument("--ranks", type=int, default=1)
    options = parser.parse_args()
    os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    launcher = [] if options.ranks == 1 else ["mpirun", "--oversubscribe", "-n", str(options.ranks)]
    with Server(options.tessera, options.file, "--latency", options.latency, launcher=launcher,
                environment=os.environ) as server:
        state = dict(server.data(600)["defaults"], size=options.size)
        client = server.socket(timeout=600)
        client.state(1, state)
        exact, _ = client.last_frame(1)
        times, widths, previews = [], [], 0
        for number in range(2, options.frames + WARM_UP + 2):
            start = time.monotonic()
            client.state(number, dict(state, camera=turned(state["camera"], number)), moving=True)
            header, _ = client.frame()
            if number >= WARM_UP + 2:
                times.append(1e3 * (time.monotonic() - start))
                widths.append(header["width"])
                previews += header["preview"]
        times.sort()
        still = []
        for number in range(number + 1, number + 4):
            client.state(number, dict(state, camera=turned(state["camera"], number)))
            still.append(client.last_frame(number)[0]["milliseconds"])
        command = server.json("POST", "/api/command", {"state": dict(state, integrator="exact")})["command"]
        server.stop()
    print(f"moving: median {statistics.median(times):.0f} ms, 95 % {times[int(0.95 * len(times))]:.0f} ms, "
          f"width {statistics.median(widths):.0f} of {exact['width']}, {previews} of {len(times)} previews")
    print(f"exact at rest: {min(still):.0f} ms; tessera render: {render_ms(options.tessera, command, options.file, launcher):.0f} ms")


if __name__ == "__main__":
    main()
