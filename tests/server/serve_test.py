#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of `tessera serve` through the program: images equal those of `tessera render`, unauthorized clients are refused,
hostile clients do no harm, and it exits normally.

    serve_test.py --tessera PROGRAM [--part pictures|refusals|tls|hostile|ends] [--without-mpi]
                  [--without-tls] [--sanitized] [--every N]

TESSERA_SERVE_MESSAGES: number of mutated messages sent (30000), TESSERA_SERVE_FRAMES: number of small frames over which
memory is checked (500).
"""

import argparse
import json
import os
import random
import shlex
import shutil
import signal
import socket
import ssl
import subprocess
import sys
import tempfile
import threading
import time
import urllib.parse
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from serve_client import HANG, Server  # noqa: E402

MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
MPIRUN = ["mpirun", "--oversubscribe", "-n", "2"]

options = None
folder = None


def tessera(*words, launcher=()):
    result = subprocess.run([*launcher, options.tessera, *map(str, words)], capture_output=True, text=True, cwd=folder,
                            env=dict(os.environ, **MPI), check=False)
    assert result.returncode == 0, f"tessera {words}: {result.stderr}"


def check(holds, words):
    if not holds:
        raise AssertionError(words)


def files():
    tessera("generate", "ball", "ball.vtu", "levels=3")
    tessera("generate", "cube", "cells.vtu", "n=6", "cell_data=2")
    tessera("generate", "ripples", "ripples.vti", "n=24")
    return [folder / name for name in ("ball.vtu", "cells.vtu", "ripples.vti")]


def rendered(command, launcher=(), output="picture.png"):
    """The bytes written by a command line that a server has reported."""
    words = shlex.split(command)
    check(words[:2] == ["tessera", "render"] and words[-2:] == ["-o", "picture.png"], command)
    words[-1] = output
    path = folder / output
    path.unlink(missing_ok=True)
    # The file as it was passed to the server.
    tessera(*words[1:], launcher=launcher)
    return path.read_bytes()


def states_of(server, is_grid, is_points):
    """States that differ in everything that a page can change."""
    defaults = dict(server.data()["defaults"], size="160x120")
    turned = dict(defaults, camera=server.json("POST", "/api/camera", {"state": defaults, "view": "iso",
                                                                       "projection": "perspective"}))
    yield defaults
    yield {"size": "120x160"}
    yield dict(turned, background="#203040", **{"color-bar": True, "axes": "both", "outline": True, "scale-bar": True})
    yield {"size": "160x120", "transfer-function": "viridis:peaks", "range": "0.2,0.8", "opacity": 3, "log": False}
    yield dict(turned, clip=["0,0,0,1,0.2,0"], **{"transfer-function": "plasma:ends"})
    paraview = server.json("POST", "/api/function", {"state": defaults})["paraview"]
    yield dict(turned, **{"transfer-function": paraview})
    if is_points:
        yield dict(turned, iso=["0.5:red:0.4"])
    if not is_grid:
        yield dict(turned, surface=["boundary:white:0.3"], threshold="0.1,0.9")
    else:
        yield dict(turned, shade=True)


def pictures_of(file, launcher=()):
    is_grid = file.suffix == ".vti"
    with Server(options.tessera, file, "--memory", "1G", launcher=launcher, environment=MPI) as server:
        client = server.socket()
        check(client.receive()["type"] == "welcome", "no welcome")
        states = list(enumerate(states_of(server, is_grid, file.name != "cells.vtu"), 1))
        for number, state in states[:: options.every]:
            client.state(number, state)
            header, image = client.last_frame(number)
            check(header["level"] == "exact" and header["mime"] == "image/png", header)
            exact = dict(state, integrator="exact")
            command = server.json("POST", "/api/command", {"state": exact})["command"]
            check(image == rendered(command, launcher), f"not the picture of {command}")
            status, headers, picture = server.ask("POST", "/picture", {"state": exact, "format": "png"})
            check(status == 200 and picture == image, "picture is not the frame")
            check("attachment" in headers["Content-Disposition"], headers)
            query = urllib.parse.urlencode({"state": json.dumps(exact), "format": "exr"})
            if len(query) < 15000:  # otherwise the URL is too long
                status, _, picture = server.ask("GET", "/picture?" + query)
            else:
                status, _, picture = server.ask("POST", "/picture", {"state": exact, "format": "exr"})
            check(status == 200 and picture == rendered(command, launcher, "picture.exr"), f"not the .exr of {command}")
            automatic = server.json("POST", "/api/command", {"state": state})["command"]
            _, _, picture = server.ask("POST", "/picture", {"state": state})
            check(picture == rendered(automatic, launcher), f"not the picture of {automatic}")
        status, errors = server.stop()
        check(status == 0 or launcher, f"ended with {status}: {errors}")
        check("tessera" not in errors, errors)


def defaults_are_the_first_picture(file):
    """The data's reported defaults are those shown when nothing is specified."""
    with Server(options.tessera, file) as server:
        defaults = server.data()["defaults"]
        _, _, said = server.ask("POST", "/picture", {"state": dict(defaults, size="90x90")})
        _, _, unsaid = server.ask("POST", "/picture", {"state": {"size": "90x90", "camera": defaults["camera"]}})
        check(said == unsaid, f"{file.name}: the defaults make another picture")


def defaults_hold_the_start(file):
    """The options with which the server was started are in the first image's state, whichever client asks, and in the welcome."""
    words = ["--transfer-function", "viridis:rise", "--range", "0.2,0.9", "--opacity", "2", "--log", "--clip", "0,0,0,1,0,0",
             "--iso", "0.5", "--background", "navy", "--color-bar=left", "--axes=both", "--outline", "--view", "front"]
    with Server(options.tessera, file, *words) as server:
        server.data()
        with server.socket() as client:
            base = client.receive()["base"]
        check(base["background"] == "navy" and base["color-bar"] == "left" and base["view"] == "front", base)
        for state in ({"size": "90x90"}, {"size": "90x90", "color-bar": None, "clip": ["0,0,0,0,1,0"]}):
            _, _, unsaid = server.ask("POST", "/picture", {"state": state})  # it waits for the data
            defaults = server.json("POST", "/api/data", {"state": state})["defaults"]
            for word in set(base) - {"view"}:
                check(defaults[word] == state.get(word, base[word]), f"{word}: {defaults}")
            _, _, said = server.ask("POST", "/picture", {"state": defaults})
            check(said == unsaid, f"{file.name}: the defaults make another picture")
        function = server.json("POST", "/api/function", {"state": {"size": "90x90"}})
        histogram = server.json("POST", "/api/histogram", {"state": {"size": "90x90"}})
        check(function["log"] is True and histogram["log"] is True, "the logarithm is not known")
        plain = server.json("POST", "/api/function", {"state": {"size": "90x90", "log": None}})
        check(plain["log"] is False, "a logarithm that was taken away")


def moving_frames_are_bare(file):
    """Moving frames are shown small and enlarged, so they have no annotation."""
    with Server(options.tessera, file) as server:
        state = dict(server.data()["defaults"], size="300x200")
        shown = {"color-bar": True, "axes": "both", "outline": True, "scale-bar": True, "annotate": ["text"]}
        pictures = []
        for moving in (state, dict(state, **shown)):
            with server.socket() as client:
                client.state(1, moving, moving=True)
                header, image = client.frame()
                check(header["level"] == "moving", header)
                pictures.append((header["width"], image))
        check(pictures[0] == pictures[1], "a moving frame is annotated")


def answers(file):
    with Server(options.tessera, file) as server:
        data = server.data()
        state = dict(data["defaults"], size="64x48")
        histogram = server.json("POST", "/api/histogram", {"state": state, "bins": 32, "visible": True})
        check(len(histogram["counts"]) == 32 and abs(sum(histogram["counts"]) - 1) < 1e-9, histogram)
        check(histogram["quantiles"]["0.005"] < histogram["quantiles"]["0.995"], histogram)
        function = server.json("POST", "/api/function", {"state": state})
        check(server.json("POST", "/api/function", {"state": dict(state, **{"transfer-function": function["json"]})})
              ["json"] == function["json"], "the function does not come back")
        probe = server.json("POST", "/api/probe", {"state": state, "x": 32, "y": 24, "samples": 16})
        check(probe["hit"] and len(probe["profile"]["distance"]) == 16, probe)
        check(not server.json("POST", "/api/probe", {"state": state, "x": 0, "y": 0})["hit"], "hit beside the data")
        verified = server.json("POST", "/api/verify", {"state": state, "pixels": 200})
        check(verified["met"] and verified["pixels"] == 200 and verified["largest_error"] <= verified["promised"], verified)
        fitted = server.json("POST", "/api/camera", {"state": state, "view": "fit"})
        check(fitted["view_up"] == state["camera"]["view_up"], fitted)
        if data["kind"] == "mesh":
            check(server.json("GET", "/api/check")["clean"] is True, "the mesh is not clean")
        else:
            server.json("GET", "/api/check", expect=400)
        if shutil.which("ffmpeg"):
            status, headers, film = server.ask("POST", "/film", {"state": state, "orbit": 4, "format": "gif"})
            check(status == 200 and film.startswith(b"GIF8") and headers["Content-Type"] == "image/gif", status)
            views = [state["camera"], fitted]
            status, _, film = server.ask("POST", "/film", {"state": state, "views": views, "frames": 3, "format": "mp4"})
            check(status == 200 and film[4:8] == b"ftyp", status)
        check(server.json("GET", "/api/progress")["film"] is None, "a film goes on")
        for path, body, words in (("/api/camera", {"state": {"sise": "8x8"}}, "did you mean size"),
                                  ("/api/camera", {"state": {"size": "8"}}, "--size"),
                                  ("/api/camera", {"state": []}, "state"),
                                  ("/api/camera", {"state": state, "view": "up"}, "view"),
                                  ("/api/probe", {"state": state, "x": 64, "y": 0}, "x"),
                                  ("/api/verify", {"state": state, "pixels": 0}, "pixels"),
                                  ("/picture", {"state": state, "format": "bmp"}, "format"),
                                  ("/picture", {"state": dict(state, size="16385x1")}, "--size"),
                                  ("/picture", {"state": dict(state, size="16384x16384")}, "--memory"),
                                  ("/picture", {"state": dict(state, field="nothing")}, "nothing"),
                                  ("/picture", {"state": dict(state, threshold="7,8")}, ""),
                                  ("/film", {"state": state}, "film"), ("/api/function", "[", "line 1")):
            error = server.json("POST", path, body, expect=400)["error"]
            check(words in error and "\n" not in error and "`" not in error.replace("`tessera", "").replace(" info`", ""), f"{path} {words}: {error}")
        server.json("GET", "/api/nothing", expect=404)
        server.json("GET", "/api/camera", expect=405)


def preview_of(file, launcher=()):
    """A preview is shown while moving if nothing else is fast enough; never at rest."""
    with Server(options.tessera, file, "--latency", "1", launcher=launcher, environment=MPI if launcher else None) as server:
        state = dict(server.data()["defaults"], size="200x150")
        client = server.socket()
        number, given_up = 0, time.monotonic() + HANG
        header = None
        while header is None or not header["preview"]:
            check(time.monotonic() < given_up, f"{file.name}: no preview in {number} frames")
            number += 1
            client.state(number, dict(state, azimuth=str(number % 360)), moving=True)
            header, image = client.frame(acknowledge=False)
            check(number > 1 or not header["preview"], f"{file.name}: a preview where nothing was measured yet")
            time.sleep(0.01)  # including the client's time to paint it, no frame arrives within a millisecond
            client.send({"type": "ack", "frame": header["frame"]})
        check(image.startswith(b"\xff\xd8"), "a preview that is not a JPEG")
        number += 1
        client.state(number, state)
        header, _ = client.last_frame(number)
        check(header["final"] and not header["preview"], header)
        check(header["stages"] and abs(sum(header["stages"].values()) - header["milliseconds"]) < 1, header)


def row_of_cubes(step):
    """Five cubes with `still`, `conc`, which is 0 at step 0 and 2 at the end of step 1, and `depth`."""
    points = [(i, int(k in (1, 2)), k // 2) for i in range(6) for k in range(4)]
    factors = {"still": 0, "conc": (0, 2, 1)[step], "depth": 3}
    arrays = [("Float64", name, 1, [factor * x / 5 for x, _, _ in points]) for name, factor in factors.items()]

    def text(kind, name, components, numbers):
        return (f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="ascii">'
                f'{" ".join(map(str, numbers))}</DataArray>')

    return ('<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian"><UnstructuredGrid>'
            f'<Piece NumberOfPoints="24" NumberOfCells="5"><PointData>{"".join(text(*a) for a in arrays)}</PointData><Points>'
            f'{text("Float64", "", 3, [c for p in points for c in p])}</Points><Cells>'
            f'{text("Int64", "connectivity", 1, [4 * c + k for c in range(5) for k in range(8)])}'
            f'{text("Int64", "offsets", 1, [8 * c for c in range(1, 6)])}{text("UInt8", "types", 1, [12] * 5)}'
            '</Cells></Piece></UnstructuredGrid></VTKFile>')


def series_starts_as_a_film(launcher=()):
    """For a series, field and colors are those of `render`, which depend on all steps; commands specify them."""
    for step in range(3):
        (folder / f"row_{step}.vtu").write_text(row_of_cubes(step))
    words = ["--size", "90x60", "--integrator", "exact"]
    tessera("render", "row_%d.vtu", "-o", "film_%d.png", *words, launcher=launcher)
    with Server(options.tessera, folder / "row_%d.vtu", *words, launcher=launcher, environment=MPI) as server:
        data = server.data()
        check(data["field"] == "conc", data["field"])
        camera = data["defaults"]["camera"]
        for step in range(3):
            state = {"camera": camera, "time-step": str(step), "size": "90x60"}
            _, _, picture = server.ask("POST", "/picture", {"state": state})
            check(picture == (folder / f"film_{step}.png").read_bytes(), f"step {step} is not the film's")
            command = server.json("POST", "/api/command", {"state": state})["command"]
            check(picture == rendered(command, launcher), f"not the picture of {command}")
        preset = {"camera": camera, "time-step": "2", "transfer-function": "viridis", "size": "90x60"}
        command = server.json("POST", "/api/command", {"state": preset})["command"]
        check("--range=0,2" in command, command)
        other = server.json("POST", "/api/command", {"state": dict(preset, field="depth")})["command"]
        check("--range" not in other and "conc" not in other, other)


def accuracies_of_curved_cells():
    """A curved cell is read again for another accuracy, as `render` reads it."""
    points = "0 0 0 1 0 0.04 0.03 1 0 0.2 0.22 1 0.5 0 0.01 0.51 0.5 0.01 0.01 0.5 0 0.1 0.105 0.5 0.6 0.105 0.51 0.11 0.605 0.5"
    (folder / "curved.vtu").write_text(
        '<VTKFile type="UnstructuredGrid" version="2.2" byte_order="LittleEndian"><UnstructuredGrid>'
        '<Piece NumberOfPoints="10" NumberOfCells="1"><PointData><DataArray type="Float64" Name="f" format="ascii">'
        '0 1 2 3 0.2 1.9 0.7 1.1 2.2 2.9</DataArray></PointData><Points><DataArray type="Float64" NumberOfComponents="3" '
        f'format="ascii">{points}</DataArray></Points><Cells><DataArray type="Int64" Name="connectivity" format="ascii">'
        '0 1 2 3 4 5 6 7 8 9</DataArray><DataArray type="Int64" Name="offsets" format="ascii">10</DataArray>'
        '<DataArray type="UInt8" Name="types" format="ascii">24</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>')
    with Server(options.tessera, folder / "curved.vtu", environment=MPI) as server:
        camera = server.data()["defaults"]["camera"]
        pictures = set()
        for accuracy in ("3e-1", "1e-2"):
            state = {"camera": camera, "size": "90x60", "accuracy": accuracy}
            _, _, picture = server.ask("POST", "/picture", {"state": state})
            command = server.json("POST", "/api/command", {"state": state})["command"]
            check(picture == rendered(command), f"not the picture of {command}")
            pictures.add(picture)
        check(len(pictures) == 2, "both accuracies have one picture")


def part_pictures():
    accuracies_of_curved_cells()
    series_starts_as_a_film()
    if not options.without_mpi:
        series_starts_as_a_film(MPIRUN)
    for file in files():
        pictures_of(file)
        defaults_are_the_first_picture(file)
        moving_frames_are_bare(file)
        if file.name != "cells.vtu":  # it has no iso-surface
            defaults_hold_the_start(file)
        answers(file)
        if not options.without_mpi and file.name != "cells.vtu":
            pictures_of(file, MPIRUN)
    tessera("generate", "cube", "many_cells.vtu", "n=24", "cell_data=2")
    preview_of(folder / "many_cells.vtu")
    (folder / "s.pvd").write_text("<VTKFile type='Collection'><Collection><DataSet timestep='1' file='ball.vtu'/>"
                                  "<DataSet timestep='2' file='ball.vtu'/></Collection></VTKFile>")
    for words, step in ((), "0"), (("--time-step", "1"), "1"):
        with Server(options.tessera, folder / "s.pvd", *words) as server:
            found = server.data()
            check(found["defaults"]["time-step"] == step and found["times"] == [1, 2], found)
    if not options.without_mpi:
        for name in ("ball.vtu", "ripples.vti"):
            preview_of(folder / name, MPIRUN)


def part_refusals():
    file = files()[0]
    with Server(options.tessera, file) as server:
        server.data()
        for path in ("/api/data", "/picture", "/socket"):
            for headers, query in (({}, ""), ({"Authorization": "Bearer " + "0" * 32}, ""), ({}, "?token=" + "0" * 32),
                                   ({"Cookie": "tessera=" + server.token}, ""),
                                   ({"Sec-WebSocket-Protocol": "tessera, token." + "0" * 32}, "")):
                status, answer, text = server.ask("GET", path + query, headers=headers, token=False)
                check(status == 403, f"{path} {headers} {query}: {status}")
                check(answer["Content-Type"].startswith("application/json"), answer)
                check(b"token" in text and server.token.encode() not in text, text)
            for headers in ({"Host": "evil.example"}, {"Host": f"127.0.0.1.evil.example:{server.port}"},
                            {"Origin": "http://evil.example"}, {"Origin": "null"},
                            {"Origin": f"http://127.0.0.1:{server.port ^ 1}"}):
                check(server.ask("GET", path, headers=headers)[0] == 403, f"{path} {headers}")
                if path == "/socket":
                    check(server.socket(headers=headers).status == 403, headers)
        check(server.socket(token=False).status == 403, "a socket without a token")
        check(server.socket(headers={"Origin": f"http://127.0.0.1:{server.port}"}).status == 101, "our own page")
        offered = {"Sec-WebSocket-Protocol": f"tessera, token.{server.token}"}
        with server.socket(token=False, headers=offered) as client:
            check(client.status == 101 and client.protocol == "tessera" and client.receive()["type"] == "welcome", client.protocol)
        # The page is public, and sets no cookie.
        for path in ("/", f"/?token={server.token}", "/index.html", "/main.js"):
            status, headers, text = server.ask("GET", path, headers={"Origin": "http://evil.example"}, token=False)
            check(status == 200 and "Set-Cookie" not in headers and server.token.encode() not in text, f"{path}: {status} {headers}")
            for name, value in (("Cache-Control", "no-store"), ("X-Content-Type-Options", "nosniff"),
                                ("Referrer-Policy", "no-referrer")):
                check(headers[name] == value, headers)
            check("default-src 'self'" in headers["Content-Security-Policy"], headers)
            status, _, text = server.ask("GET", path, headers={"Host": "evil.example"}, token=False)
            check(status == 403 and b"--allow-host evil.example" in text, f"{path}: {status} {text}")
        check(server.ask("GET", "/none", token=False)[0] == 404, "a page that there is none of")
        check(server.ask("GET", "/..%2f..%2fetc/passwd")[0] == 404, "a file that is none of the page")
        check(server.ask("DELETE", "/")[0] == 405, "a page deleted")
    with Server(options.tessera, file, "--allow-host", "viz.example.org") as server:
        headers = {"Host": "viz.example.org", "Origin": "https://viz.example.org"}
        check(server.ask("GET", "/", headers=headers)[0] == 200, "an allowed host")
    two = subprocess.run([options.tessera, "serve", "a.vtu", "b.vtu"], capture_output=True, text=True, check=False)
    check(two.returncode != 0 and "'b.vtu' is a second" in two.stderr and "'a_%d.vtu'" in two.stderr, two.stderr)


def certificate(name):
    """(certificate, key): a self-signed one for this machine."""
    files = folder / f"{name}.pem", folder / f"{name}-key.pem"
    subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-keyout", files[1], "-out", files[0],
                    "-days", "2", "-subj", "/CN=localhost", "-addext", "subjectAltName=IP:127.0.0.1,DNS:localhost"],
                   check=True, capture_output=True)
    return files


def part_tls():
    if options.without_tls or not shutil.which("openssl"):
        print("no TLS in this build, or no openssl to make a certificate with")
        return
    file = files()[0]
    shown, key = certificate("own")
    words = ("--tls-certificate", shown, "--tls-key", key)
    with Server(options.tessera, file, *words, trusted=shown) as server:
        check(server.url.startswith("https://127.0.0.1:"), server.url)
        state = dict(server.data()["defaults"], size="80x60", integrator="exact")
        with server.socket() as client:
            check(client.status == 101 and client.receive()["type"] == "welcome", "no welcome")
            client.state(1, state)
            _, image = client.last_frame(1)
        check(server.ask("POST", "/picture", {"state": state, "format": "png"})[2] == image, "picture is not the frame")
        check(server.ask("GET", "/api/data", token=False)[0] == 403, "without the token")
        check(server.socket(headers={"Origin": f"https://127.0.0.1:{server.port}"}).status == 101, "our own page")
        check(server.socket(headers={"Origin": f"https://127.0.0.1:{server.port ^ 1}"}).status == 403, "another page")
        # Nothing is answered without TLS, with an old protocol, or to a client that does not trust it; and the server
        # continues.
        with socket.create_connection((server.host, server.port), timeout=HANG) as plain:
            plain.sendall(f"GET /?token={server.token} HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n".encode())
            check(b"HTTP/" not in plain.recv(100), "an answer in the clear")
        for change in ("old", "strange"):
            context = ssl.create_default_context(cafile=str(certificate("other")[0]) if change == "strange" else str(shown))
            if change == "old":
                context.minimum_version, context.maximum_version = ssl.TLSVersion.TLSv1, ssl.TLSVersion.TLSv1_1
                context.set_ciphers("ALL:@SECLEVEL=0")
            try:
                with socket.create_connection((server.host, server.port), timeout=HANG) as stream:
                    context.wrap_socket(stream, server_hostname="127.0.0.1")
                raise AssertionError(f"{change}: a connection")
            except ssl.SSLError:
                pass
        # In TLS 1.2, nothing without forward secrecy or with a block cipher.
        for ciphers, is_taken in (("AES128-SHA", False), ("AES256-GCM-SHA384", False), ("ECDHE-RSA-AES128-SHA", False),
                                  ("ECDHE-RSA-AES128-SHA256", False), ("ECDHE-RSA-AES128-GCM-SHA256", True),
                                  ("ECDHE-RSA-CHACHA20-POLY1305", True)):
            context = ssl.create_default_context(cafile=str(shown))
            context.maximum_version = ssl.TLSVersion.TLSv1_2
            context.set_ciphers(ciphers)
            try:
                with socket.create_connection((server.host, server.port), timeout=HANG) as stream:
                    context.wrap_socket(stream, server_hostname="127.0.0.1")
                taken = True
            except ssl.SSLError:
                taken = False
            check(taken == is_taken, f"{ciphers}: {'taken' if taken else 'refused'}")
        check(server.ask("GET", "/api/data")[0] == 200, "it does not go on")
        status, errors = server.stop()
        check(status == 0 and errors == "", f"ended with {status}: {errors}")
    (folder / "none.pem").write_text("none\n")
    for bad in ((shown, certificate("other")[1]), (folder / "none.pem", key), (shown, folder / "none.pem"),
                (folder / "missing.pem", key)):
        result = subprocess.run([options.tessera, "serve", file, "--tls-certificate", bad[0], "--tls-key", bad[1]],
                                capture_output=True, text=True, timeout=HANG, check=False)
        check(result.returncode == 2 and result.stderr.count("\n") == 1 and ".pem" in result.stderr and
              result.stdout == "", f"{bad}: {result.returncode} {result.stderr}")


def mutated(rng, text):
    data = bytearray(text)
    for _ in range(rng.randint(1, 8)):
        at = rng.randrange(len(data)) if data else 0
        kind = rng.randrange(4)
        if kind == 0 and data:
            data[at] = rng.randrange(256)
        elif kind == 1:
            del data[at:at + rng.randint(1, 9)]
        elif kind == 2:
            data[at:at] = rng.choice([b"{", b"}", b"[", b"]", b'"', b",", b":", b"-", b"1e999", b"null", b"\\u0000"])
        else:
            data[at:at] = bytes(rng.randrange(256) for _ in range(rng.randint(1, 5)))
    return bytes(data)


def is_served(server, state):
    """Whether a well-behaved client gets its image."""
    client = admitted(server)
    client.state(1, state)
    header, image = client.last_frame(1)
    client.close()
    return header["final"] and image.startswith(b"\x89PNG")


def admitted(server):
    """A client, once there is room for it: the server notices disconnections with a delay."""
    given_up = time.monotonic() + HANG
    while True:
        try:
            client = server.socket()
            if client.status == 101:
                return client
        except OSError:
            pass
        check(time.monotonic() < given_up, "no room for a client")
        time.sleep(0.05)


def send_mutated(server, state, count):
    seed = random.SystemRandom().randrange(1 << 32)
    rng = random.Random(seed)
    print(f"mutated messages: seed {seed}")
    originals = [json.dumps({"type": "state", "number": 1, "moving": True, "state": dict(state, size="8x8")}).encode(),
                 json.dumps({"type": "state", "number": 2, "state": {"size": "9x9", "clip": ["0,0,0,1,0,0"]}}).encode(),
                 b'{"type":"ack","frame":1}', b'{"type":"pause"}']
    sent = 0
    while sent < count:
        client = server.socket()
        stop = threading.Event()

        def drain(of=client):
            try:
                while not stop.is_set():
                    of.receive()
            except (OSError, ValueError, KeyError):
                pass

        reader = threading.Thread(target=drain)
        reader.start()
        try:
            for _ in range(2000):
                client.send_bytes(mutated(rng, rng.choice(originals)), rng.choice([1, 1, 1, 1, 2]))
                sent += 1
        except OSError:
            pass  # closed because of a frame that is not UTF-8, or because the client did not read
        stop.set()
        try:
            client.stream.shutdown(socket.SHUT_RDWR)
        except OSError:
            pass
        reader.join()
        client.close()
        check(server.process.poll() is None, f"the server has died of seed {seed}")
    # HTTP, mutated from the first byte on.
    request = f"POST /api/camera?token={server.token} HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\nContent-Length: 15\r\n\r\n" \
              '{"state": {} } '
    for _ in range(count // 20):
        with socket.create_connection((server.host, server.port)) as stream:
            stream.settimeout(HANG)
            try:
                stream.sendall(mutated(rng, request.encode()))
                stream.shutdown(socket.SHUT_WR)
                stream.recv(1 << 16)
            except OSError:
                pass


def part_hostile():
    file = files()[0]
    count = int(os.environ.get("TESSERA_SERVE_MESSAGES", "3000" if options.sanitized else "30000"))
    with Server(options.tessera, file) as server:
        state = dict(server.data()["defaults"], size="48x48")
        send_mutated(server, state, count)
        check(is_served(server, state), "not served after mutated messages")

        # Messages and headers that are too long.
        client = server.socket()
        client.receive()
        try:
            client.send_bytes(b" " * ((1 << 20) + 1))
            while True:
                client.receive()
        except OSError:
            pass
        status, _, _ = server.ask("POST", "/api/camera", b" " * ((1 << 20) + 1))
        check(status == 413, f"a long body: {status}")
        status, _, _ = server.ask("GET", "/api/data", headers={"X-Long": "a" * 20000})
        check(status == 431, f"a long header: {status}")

        # Half-open connections are closed, and others are served in parallel.
        half_open = [socket.create_connection((server.host, server.port)) for _ in range(60)]
        for number, stream in enumerate(half_open):
            stream.sendall([b"", b"GET / HT", b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n"][number % 3])
        check(is_served(server, state), "not served beside half-open connections")
        # A client that does not read its frame.
        slow = server.socket()
        slow.state(1, dict(state, size="1500x1500"))
        # 200 clients at once.
        clients = [server.socket() for _ in range(170)]
        for number, client in enumerate(clients):
            client.state(1, dict(state, size=f"{8 + number % 5}x8"))
        for client in clients:
            client.last_frame(1)
        check(is_served(server, state), "not served beside 170 clients")
        for stream in half_open:
            stream.settimeout(HANG)
            check(stream.recv(1) == b"", "a half-open connection was answered")
            stream.close()
        # Of a hundred more, those over the limit of 256 are refused.
        before = len(clients)
        clients += [client for client in (socket_or_none(server) for _ in range(100)) if client]
        check(before < len(clients) <= 256, f"{len(clients)} clients of 270 were admitted")
        for client in clients + [slow]:
            client.close()

        # 500 states in a burst: one frame, and no second one before it is acknowledged.
        client = admitted(server)
        client.receive()
        for number in range(1, 501):
            client.state(number, dict(state, opacity=1 + number / 1000), moving=number < 500)
        header, _ = client.frame(acknowledge=False)
        for _ in range(2):  # between two images for others it would get its turn
            check(server.ask("POST", "/picture", {"state": state})[0] == 200, "no picture beside a client that waits")
        client.send_bytes(b"", 9)
        while (message := client.receive()) != {"type": "pong"}:
            check(not isinstance(message, tuple), "a second frame before the first was acknowledged")
        client.send({"type": "ack", "frame": header["frame"]})
        frames = 1
        while not (header["final"] and header["number"] == 500):
            header, _ = client.frame()
            frames += 1
        check(frames <= 4, f"{frames} frames for a burst of states")
        client.close()

        memory_stays(server, state)
        check(is_served(server, state), "not served at the end")
        status, errors = server.stop()
        check(status == 0 and errors == "", f"ended with {status}: {errors}")


def socket_or_none(server):
    """A client, or None if the server has reached its limit."""
    client = server.socket()
    return client if client.status == 101 else None


def memory_stays(server, state):
    """Frames leave no memory behind: in at least one of several rounds memory does not grow. A leak grows in each; threads and caches
    are created once."""
    frames = int(os.environ.get("TESSERA_SERVE_FRAMES", "150" if options.sanitized else "500"))
    client = admitted(server)
    client.receive()
    position = list(state["camera"]["position"])
    rounds = 1 if options.sanitized else 6  # its quarantine grows
    number = 0
    for _ in range(rounds):
        sizes = []
        for k in range(1, frames + 1):
            number += 1
            camera = dict(state["camera"], position=[position[0] + 1e-3 * number, *position[1:]])
            client.state(number, dict(state, camera=camera, opacity=1 + number % 40), moving=True)
            client.frame()
            if k % (frames // 10) == 0:
                sizes.append(server.resident_bytes())
        print(f"resident over {frames} frames: " + " ".join(f"{size >> 20}" for size in sizes) + " MiB")
        if sizes[-1] - sizes[4] < 8 << 20:
            break
    else:
        check(options.sanitized, "memory grows with frames")
    client.close()


def part_ends():
    file = files()[0]
    for how in (signal.SIGINT, signal.SIGTERM):
        with Server(options.tessera, file) as server:
            server.data()
            client = server.socket()
            client.receive()
            client.begin_long_frame(1, {})  # it is in progress
            status, errors = server.stop(how)
            check(status == 0 and errors == "", f"{how}: ended with {status}: {errors}")
            try:
                while True:
                    message = client.receive()
                    if not isinstance(message, tuple) and message["type"] == "ended":
                        break
            except ConnectionError:
                raise AssertionError("the client was not told of the end") from None
    for words, expected in ((["missing.vtu"], "missing.vtu"), ([file, "--port", "x"], "--port"),
                            ([file, "--bind", "nowhere"], "--bind"), ([file, "--latency", "0"], "--latency"),
                            ([file, "--tls-key", "k"], "--tls-certificate"), ([file, "--integrator", "x"], "--integrator"),
                            ([file, "--tls-key", "k", "--tls-certificate", "c"], ""), ([file, "-o", "a.png"], "-o")):
        result = subprocess.run([options.tessera, "serve", *map(str, words)], capture_output=True, text=True, cwd=folder,
                                timeout=HANG, check=False)
        check(result.returncode == 2 and result.stderr.count("\n") == 1 and expected in result.stderr and
              result.stdout == "", f"{words}: {result.returncode} {result.stderr}")
    (folder / "broken.vtu").write_text("<VTKFile type='UnstructuredGrid'>")
    with Server(options.tessera, folder / "broken.vtu") as server:
        client = server.socket()
        client.state(1, {"size": "8x8"})
        try:
            client.last_frame(1)
            raise AssertionError("a picture of a broken file")
        except RuntimeError as error:
            check("broken.vtu" in str(error), error)
        check(server.stop()[0] == 0, "a server of a broken file does not end well")
    if not options.without_mpi:
        ranks_end()


def ranks_end():
    file = folder / "ball.vtu"
    with Server(options.tessera, file, launcher=MPIRUN, environment=MPI) as server:
        state = dict(server.data()["defaults"], size="64x48")
        error = server.json("POST", "/picture", {"state": dict(state, field="nothing")}, expect=400)["error"]
        check("nothing" in error, error)
        error = server.json("POST", "/picture", {"state": dict(state, threshold="7,8")}, expect=400)["error"]
        client = server.socket()
        client.receive()
        # Stale frames stop on all ranks. One that is finished before it becomes stale does not count: try again.
        stale, given_up = 1, time.monotonic() + HANG
        while True:
            stale = client.begin_long_frame(stale, state)
            client.state(stale + 1, state)
            header, _ = client.frame()
            if header["number"] != stale + 1 or not header["final"]:
                client.last_frame(stale + 1)
            if header["number"] == stale + 1:
                break
            check(time.monotonic() < given_up, "no stale frame was stopped")
            stale += 2
        _, errors = server.stop()
        check("tessera:" not in errors, errors)
    # Otherwise Open MPI kills ranks one second after it has asked them to end, however busy the machine is.
    patient = dict(MPI, OMPI_MCA_odls_base_sigkill_timeout="10")
    with Server(options.tessera, file, launcher=MPIRUN, environment=patient) as server:
        server.data()
        client = server.socket()
        client.receive()
        ranks = subprocess.run(["pgrep", "-P", str(server.process.pid), "-f", "serve"], capture_output=True, text=True,
                               check=True).stdout.split()
        os.kill(int(ranks[1]), signal.SIGKILL)
        message = client.receive()
        check(message["type"] == "ended" and "rank" in message["error"], message)
        server.process.wait(HANG)
        errors = server.process.stderr.read()
        check(errors.count("tessera:") == 1, errors)


def main():
    global options, folder
    parser = argparse.ArgumentParser()
    parser.add_argument("--tessera", required=True)
    parser.add_argument("--part", choices=["pictures", "refusals", "tls", "hostile", "ends"])
    parser.add_argument("--without-mpi", action="store_true")
    parser.add_argument("--without-tls", action="store_true")
    parser.add_argument("--sanitized", action="store_true")
    parser.add_argument("--every", type=int, default=1, help="each so many-th state of part pictures")
    options = parser.parse_args()
    options.tessera = str(Path(options.tessera).resolve())
    options.without_mpi = options.without_mpi or not shutil.which("mpirun")
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        for name in ("pictures", "refusals", "tls", "hostile", "ends"):
            if options.part in (None, name):
                start = time.monotonic()
                globals()["part_" + name]()
                print(f"{name}: {time.monotonic() - start:.1f} s")


if __name__ == "__main__":
    main()
