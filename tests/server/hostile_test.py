#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Hostile messages to `tessera serve`, from a seeded generator: after each one the server answers an honest request, and
at the end it exits normally, without any output on stderr.

    hostile_test.py --tessera PROGRAM [--seed N] [--count 800] [--least-scale 1e-310]
"""

import argparse
import http.client
import json
import random
import socket
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from serve_client import HANG, Server  # noqa: E402

options = None


def check(holds, words):
    if not holds:
        raise AssertionError(words)


class Honest:
    """A well-behaved client, with one connection for as long as the server keeps it."""

    def __init__(self, server):
        self.server = server
        self.headers = {"Authorization": f"Bearer {server.token}"}
        self.connection = None

    def ask(self, method, path, body=None):
        for last in (False, True):
            if self.connection is None:
                self.connection = http.client.HTTPConnection(self.server.host, self.server.port, timeout=HANG)
            try:
                self.connection.request(method, path, body, self.headers)
                answer = self.connection.getresponse()
                return answer.status, answer.read()
            except (http.client.HTTPException, OSError):
                self.connection.close()
                self.connection = None
                if last:
                    raise
        return None


# Numbers, as JSON texts.


def number(rng):
    kind = rng.randrange(8)
    if kind == 0:
        return rng.choice(["0", "-0.0", "-1", "1e308", "-1e308", "5e-324", "1e-310", "18446744073709551616", "1e999"])
    if kind == 1:
        return f"{rng.choice(['', '-'])}1e{rng.randint(-330, 320)}"
    if kind == 2:
        return "9" * rng.randint(1, 500)
    return f"{rng.uniform(-3, 3):.6g}"


def scale(rng):
    if rng.randrange(8) == 0:
        return repr(max(rng.choice([5e-324, 1e-310, 1e-308, 1e308]), options.least_scale))
    exponent = rng.uniform(-310, 308)
    mantissa = 10 ** (exponent - int(exponent))
    value = float(f"{mantissa:.3f}e{int(exponent)}")
    return repr(max(value, options.least_scale))


def vector(rng):
    if rng.randrange(12) == 0:
        return rng.choice(["null", "[]", "[1,2]", "[1,2,3,4]", '["a",1,2]', "[NaN,0,0]", "[[1],[2],[3]]", "{}", "7"])
    return "[" + ",".join(number(rng) for _ in range(3)) + "]"


def camera(rng):
    members = [f'"position":{vector(rng)}', f'"focal_point":{vector(rng)}']
    if rng.randrange(2):
        members.append(f'"view_up":{vector(rng)}')
    if rng.randrange(3):
        members.append(f'"parallel_scale":{scale(rng)}')
    else:
        members.append(f'"view_angle":{rng.choice([number(rng), scale(rng), str(rng.uniform(1, 170))])}')
    if rng.randrange(4) == 0:
        members.append(f'"clipping_range":[{number(rng)},{number(rng)}]')
    if rng.randrange(10) == 0:
        members.append(rng.choice(['"size":[1e9,1e9]', '"position":[0,0,1]', '"what":1', '"projection":7']))
    return "{" + ",".join(members) + "}"


def plain_camera(rng):
    """A camera that is accepted, except for its scale."""
    view = rng.choice(["[0.3,0.4,5]", "[3,-4,2]", "[0,0,-1e6]", "[1e300,0,0]"])
    return f'{{"position":{view},"focal_point":[0,0,0],"view_up":[0,0.1,1],"parallel_scale":{scale(rng)}}}'


def text(rng):
    return json.dumps(rng.choice(["", "true", "false", "null", "0", "-1", "1e308", "nan", "inf", "--help", "-o x.png", "a" * 5000,
                                  "/etc/passwd", "../../x", "{}", "[]", "{field}", "%s%n", "\u0000", "\u202e", "x" * 300, "1,2",
                                  "1:2:3", "box:0,0,0,1,1,1", "0,0,0,1,0,0", "boundary", "boundary:red:1e308", "viridis",
                                  "viridis:peaks", "8x8", "0x0", "99999x99999", "-8x8", "iso", "+x", "1e-300,1e300"]))


def function(rng):
    if rng.randrange(3) == 0:
        return rng.choice(["[]", "{}", '{"knots":[]}', '{"knots":[[0,0,0,0]]}', '{"knots":[[0,1e308,0,0,1e308]]}',
                           '{"knots":[[-1e308,0,0,0,1e100],[1e308,1,1,1,1e100]]}', '"viridis:nothing"', '[{"RGBPoints":[0,0,0]}]'])
    knots = sorted((rng.uniform(-1, 1) * 10 ** rng.uniform(-300, 300) for _ in range(rng.randint(1, 6))))
    return '{"knots":[' + ",".join(
        f"[{value!r},{rng.random()},{rng.random()},{rng.random()},{10 ** rng.uniform(-300, 100)!r}]" for value in knots) + "]}"


KEYS = ["view", "up", "azimuth", "elevation", "zoom", "fit", "projection", "field", "smooth", "warp", "threshold", "clip",
        "rescale", "range", "log", "opacity", "opacity-points", "unit-distance", "blend", "emission", "iso", "surface", "shade",
        "no-shade", "light", "background", "color-bar", "color-bar-title", "color-bar-range", "color-bar-scale", "field-unit",
        "axes", "outline", "scale-bar", "length-unit", "annotate", "annotation-color", "annotation-size", "accuracy",
        "integrator", "step", "half", "png-bits", "time-step", "block", "drop-duplicates", "nothing", "output", "config"]


def value(rng):
    return rng.choice([lambda: number(rng), lambda: text(rng), lambda: text(rng), lambda: "true", lambda: "null",
                       lambda: f"[{text(rng)},{text(rng)}]", lambda: f"[{number(rng)}]", lambda: "{}"])()


def state(rng):
    members = ['"size":"8x6"']
    kind = rng.randrange(4)
    if kind == 0:
        members.append(f'"camera":{camera(rng)}')
    elif kind == 1:
        members.append(f'"camera":{plain_camera(rng)}')
    elif kind == 2:
        members.append(f'"transfer-function":{function(rng)}')
    for key in rng.sample(KEYS, rng.randint(0, 1 if kind < 3 else 3)):
        members.append(f'"{key}":{value(rng)}')
    return "{" + ",".join(members) + "}"


def nested(rng):
    levels = rng.choice([64, 65, 100, 10_000, 500_000])
    begin, end = rng.choice([("[", "]"), ('{"a":', "}")])
    return begin * (levels // len(begin)) + rng.choice(["", "1" + end * (levels // len(begin))])


def message(rng):
    """A text message for a socket."""
    kind = rng.randrange(10)
    if kind < 4:
        return f'{{"type":"state","number":{rng.choice(["1", "2", number(rng)])},"moving":{rng.choice(["true", "false"])},"state":{state(rng)}}}'
    if kind == 4:
        return rng.choice(["", "{", "[]", "7", "null", "{}}", '{"type":"state"', '{"type":NaN}', '{"type":"pause","type":"ack"}',
                           "\u0000", '{"type":"state","number":1,"state":{},}', "'", "//", '"'])
    if kind == 5:
        return nested(rng)
    if kind == 6:
        return f'{{"type":{rng.choice([text(rng), number(rng), "[]"])},"frame":{number(rng)}}}'
    if kind == 7:
        return f'{{"type":"ack","frame":{rng.choice([number(rng), "null", text(rng)])}}}'
    if kind == 8:
        one, many = rng.choice([("{}", 330_000), ("0", 500_000), ("[]", 330_000), ('{"a":1}', 100_000)])
        return f'{{"type":"state","number":1,"state":{{}},"a":[{",".join([one] * many)}]}}'
    return json.dumps({"type": "state", "number": 1, "state": {rng.choice(KEYS): "x" * rng.choice([5_000, 900_000])}})


def frame_of(rng, payload):
    """A WebSocket frame, valid or damaged."""
    head = bytes([rng.choice([0x81] * 12 + [0x82, 0x80, 0x01, 0x83, 0x8f, 0xf1, 0x88, 0x89])])
    length = rng.choice([len(payload)] * 15 + [0, len(payload) + 9, (1 << 63) - 1, 1 << 21])
    masked = 0x80 if rng.randrange(15) else 0
    if length < 126:
        head += bytes([masked | length])
    elif length < 1 << 16:
        head += bytes([masked | 126]) + struct.pack(">H", length)
    else:
        head += bytes([masked | 127]) + struct.pack(">Q", length)
    return head + (bytes(4) + payload if masked else payload)  # a mask of zeros does not change it


class Hostile:
    def __init__(self, server, honest, rng):
        self.server, self.honest, self.rng = server, honest, rng
        self.client = None

    def over_socket(self):
        """Several per socket, until one of them makes the server close it."""
        rng = self.rng
        payload = message(rng).encode()
        if rng.randrange(12) == 0:
            payload = bytes(rng.randrange(256) for _ in range(rng.randint(1, 200)))
        try:
            if self.client is None:
                self.client = self.server.socket()
            self.client.stream.sendall(frame_of(rng, payload))
            closes = rng.randrange(6) == 0
        except OSError:
            closes = True
        if closes and self.client is not None:
            self.client.close()
            self.client = None
        return payload

    def over_http(self):
        """Sends bytes to the port unchanged."""
        rng, token = self.rng, self.server.token
        host = f"Host: 127.0.0.1:{self.server.port}\r\n"
        ours = f"Authorization: Bearer {token}\r\n"
        data = rng.choice([
            lambda: f"GET /api/data HTTP/1.1\r\n{host}Authorization: Bearer {rng.getrandbits(128):032x}\r\n\r\n",
            lambda: f"GET /api/data?token={token[:-1]} HTTP/1.1\r\n{host}\r\n",
            lambda: f"GET /api/progress HTTP/1.1\r\n{host}{host}{ours}\r\n",
            lambda: f"GET /api/progress HTTP/1.1\r\n{ours}\r\n",
            lambda: f"GET /api/progress HTTP/1.1\r\nHost: evil.example\r\n{ours}\r\n",
            lambda: f"GET /api/progress HTTP/1.1\r\n{host}{ours}Origin: http://evil.example\r\n\r\n",
            lambda: f"GET / HTTP/1.1\r\n{host}X: {'a' * rng.choice([15_000, 17_000, 1_000_000])}\r\n\r\n",
            lambda: f"GET / HTTP/1.1\r\n{host}" + "".join(f"X{n}: 1\r\n" for n in range(rng.choice([100, 5000]))) + "\r\n",
            lambda: f"GET /{'a' * rng.choice([100, 20_000])} HTTP/1.1\r\n{host}{ours}\r\n",
            lambda: f"GET /{rng.choice(['%00', '%', '..%2f..%2fetc/passwd', '%ff', '?token=%zz', 'socket'])} HTTP/1.1\r\n{host}{ours}\r\n",
            lambda: f"POST /api/camera HTTP/1.1\r\n{host}{ours}Content-Length: {rng.choice(['-1', '1e9', '99999999999999999999', '5', '2000000'])}\r\n\r\n{{}}",
            lambda: f"POST /api/camera HTTP/1.1\r\n{host}{ours}Content-Length: 2\r\nTransfer-Encoding: chunked\r\n\r\n2\r\n{{}}\r\n0\r\n\r\n",
            lambda: f"POST /api/camera HTTP/1.1\r\n{host}{ours}Transfer-Encoding: chunked\r\n\r\n{rng.choice(['zz', 'ffffffffffffffff', '2'])}\r\n{{}}",
            lambda: f"POST /picture HTTP/1.1\r\n{host}{ours}Content-Length: 1000\r\n\r\n{{",
            lambda: f"{rng.choice(['BREW', 'GET' * 500, 'DELETE', 'OPTIONS'])} /picture HTTP/1.1\r\n{host}{ours}\r\n",
            lambda: "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n",
            lambda: "\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" + "\x00" * 500,
            lambda: "GET /\r\n\r\n",
            lambda: "\r\n" * 5000,
            lambda: f"GET /socket HTTP/1.1\r\n{host}{ours}Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: {'a' * rng.choice([0, 3, 5000])}\r\nSec-WebSocket-Version: {rng.choice(['13', '12', 'x'])}\r\n\r\n",
        ])().encode("latin-1")
        data = data[:rng.randint(1, len(data))] if rng.randrange(4) == 0 else data
        try:
            with socket.create_connection((self.server.host, self.server.port), timeout=HANG) as stream:
                stream.sendall(data)
                stream.shutdown(socket.SHUT_WR)
                stream.recv(1 << 12)
        except OSError:
            pass  # closed before everything was sent
        return data

    def by_request(self):
        """A state in a valid request: it is answered, with or without an error."""
        rng = self.rng
        body = f'{{"state":{state(rng)}}}'
        path = rng.choice(["picture"] * 5 + ["api/camera", "api/function", "api/histogram", "api/command", "api/data", "film",
                                             "api/probe", "api/verify"])
        if path == "api/camera":
            body = f'{{"state":{state(rng)},"view":{text(rng)},"projection":{text(rng)}}}'
        if path == "film":
            body = f'{{"state":{{"size":"8x6"}},"views":[{camera(rng)},{plain_camera(rng)}],"frames":{number(rng)},"rate":{number(rng)},"format":{text(rng)}}}'
        if path == "api/probe":
            body = f'{{"state":{state(rng)},"x":{number(rng)},"y":{rng.choice(["1", number(rng)])},"samples":{number(rng)}}}'
        if path == "api/verify":
            body = f'{{"state":{state(rng)},"pixels":{rng.choice(["5", number(rng)])}}}'
        if rng.randrange(8) == 0:
            body = rng.choice([message(rng), body[:rng.randrange(len(body))]])
        status, answer = self.honest.ask("POST", "/" + path, body.encode())
        check(status in (200, 400, 413) or (status == 503 and path == "api/data"), f"{path} is answered {status}: {answer[:300]}")
        return f"{path} {body}".encode()

    def send(self):
        return self.rng.choice([self.over_socket, self.over_http, self.by_request])()


def attack(server, rng):
    honest = Honest(server)
    hostile = Hostile(server, honest, rng)
    sent = b""
    for index in range(options.count):
        try:
            sent = hostile.send()
            status, answer = honest.ask("POST", "/api/camera", '{"state":{"size":"8x6"},"view":"front"}')
            check(status == 200 and b"position" in answer, f"an honest request is answered {status}: {answer[:300]}")
        except (AssertionError, OSError, http.client.HTTPException) as fault:
            raise AssertionError(f"message {index} of seed {options.seed}, {sent[:2000]}: {fault!r}; the server's exit status: "
                                 f"{server.process.poll()}") from fault


def main():
    global options
    parser = argparse.ArgumentParser()
    parser.add_argument("--tessera", required=True)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=800)
    parser.add_argument("--least-scale", type=float, default=1e-310)
    options = parser.parse_args()
    print(f"seed {options.seed}", flush=True)
    rng = random.Random(options.seed)
    with tempfile.TemporaryDirectory() as folder:
        for words in (["ball", "ball.vtu", "levels=1"], ["ripples", "ripples.vti", "n=8"]):
            file = Path(folder) / words[1]
            subprocess.run([options.tessera, "generate", words[0], file, words[2]], capture_output=True, check=True)
            with Server(options.tessera, file) as server:
                server.data()
                attack(server, rng)
                status, errors = server.stop()
                check(status == 0 and errors == "", f"ended with {status}: {errors}")


if __name__ == "__main__":
    main()
