#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Long runs: 2,000 frames each of a mesh, a grid, a series and a server. Resident memory and open descriptors are sampled;
from the first tenth of the frames to the last their peaks may grow by 3 MiB and by none, respectively.

    bench/soak.py --tessera build/release/apps/tessera [--frames 2000]

Prints a line per run; exits with 1 if one grows."""

import argparse
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request

MOST_GROWTH_KIB = 3 * 1024


def resident_kib(process):
    text = pathlib.Path(f"/proc/{process}/status").read_text()
    return int(re.search(r"VmRSS:\s+(\d+)", text).group(1))


def descriptors(process):
    return len(os.listdir(f"/proc/{process}/fd"))


class Watch(threading.Thread):
    """Samples of a process, each with the number of frames completed by then."""

    def __init__(self, process, frames_done):
        super().__init__(daemon=True)
        self.process, self.frames_done, self.samples = process, frames_done, []

    def run(self):
        while True:
            try:
                self.samples.append((self.frames_done(), resident_kib(self.process), descriptors(self.process)))
            except (OSError, AttributeError):  # it has ended
                return
            time.sleep(0.01)


def judge(name, samples, frames):
    early = [s for s in samples if frames * 0.05 <= s[0] < frames * 0.15]
    late = [s for s in samples if s[0] >= frames * 0.9]
    if not early or not late:
        print(f"{name}: too few samples ({len(early)} early, {len(late)} late); give more --frames")
        return False
    growth = max(s[1] for s in late) - max(s[1] for s in early)
    opened = max(s[2] for s in late) - max(s[2] for s in early)
    good = growth <= MOST_GROWTH_KIB and opened <= 0
    print(f"{name}: {frames} frames, {len(samples)} samples, {max(s[1] for s in early)} KiB at the first tenth, "
          f"{growth:+d} KiB to the end, descriptors {max(s[2] for s in early)} {opened:+d}{'' if good else ': GROWS'}")
    return good


def rendered(name, words, folder, frames):
    pictures = folder / name
    pictures.mkdir()
    run = subprocess.Popen([*words, "-o", str(pictures / "f_%05d.png"), "--size", "64x64", "--quiet"])
    watch = Watch(run.pid, lambda: len(os.listdir(pictures)))
    watch.start()
    if run.wait() != 0:
        sys.exit(f"{name}: ended with {run.returncode}")
    watch.join()
    return judge(name, watch.samples, frames)


def served(tessera, mesh, frames):
    server = subprocess.Popen([tessera, "serve", str(mesh), "--port", "0"], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True)
    try:
        for line in server.stdout:
            if found := re.search(r"(http://\S+?)/?[?#]\S*?token=([0-9a-f]+)|(http://\S+?)/\?(\w+)", line):
                break
        address, token = [part for part in found.groups() if part]
        threading.Thread(target=lambda: [None for _ in server.stdout], daemon=True).start()
        done = [0]
        watch = Watch(server.pid, lambda: done[0])
        watch.start()
        for frame in range(frames):
            state = {"size": "64x64", "azimuth": frame * 0.18}
            request = urllib.request.Request(f"{address}/picture", json.dumps({"state": state}).encode(),
                                             {"Authorization": f"Bearer {token}", "Content-Type": "application/json"})
            urllib.request.urlopen(request, timeout=600).read()
            done[0] += 1
        time.sleep(0.1)
        samples = list(watch.samples)
    finally:
        server.terminate()
        server.wait()
    return judge("server", samples, frames)


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--tessera", default="build/release/apps/tessera")
    options.add_argument("--frames", type=int, default=2000)
    given = options.parse_args()
    tessera, frames = str(pathlib.Path(given.tessera).resolve()), given.frames
    with tempfile.TemporaryDirectory(prefix="tessera-soak-") as name:
        folder = pathlib.Path(name)
        mesh, grid = folder / "mesh.vtu", folder / "grid.nrrd"
        subprocess.run([tessera, "generate", "cube", str(mesh), "n=8", "--quiet"], check=True)
        subprocess.run([tessera, "generate", "ripples", str(grid), "n=24", "--quiet"], check=True)
        steps = "".join(f'<DataSet timestep="{i}" file="mesh.vtu"/>' for i in range(frames))
        series = folder / "series.pvd"
        series.write_text(f'<VTKFile type="Collection"><Collection>{steps}</Collection></VTKFile>')
        orbit = ["--orbit", str(frames)]
        good = [rendered("mesh", [tessera, "render", str(mesh), *orbit], folder, frames),
                rendered("grid", [tessera, "render", str(grid), *orbit], folder, frames),
                rendered("series", [tessera, "render", str(series)], folder, frames),
                served(tessera, mesh, frames)]
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
