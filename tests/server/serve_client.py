# SPDX-License-Identifier: BSD-3-Clause
"""A client of `tessera serve` that uses only the standard library: starts a server, and talks to it by HTTP and WebSocket."""

import base64
import http.client
import json
import os
import secrets
import signal
import socket
import ssl
import struct
import subprocess
import time
import urllib.parse


HANG = 300  # seconds, reached only by a hang


class Server:
    """`tessera serve`, running until stop(). `launcher`: the command that starts it, like mpirun. `trusted`: the
    server's certificate; then uses https."""

    def __init__(self, tessera, file, *words, launcher=(), environment=None, trusted=None):
        self.context = ssl.create_default_context(cafile=str(trusted)) if trusted else None
        environment = dict(os.environ, **(environment or {}))
        self.process = subprocess.Popen([*launcher, str(tessera), "serve", str(file), *words], stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True, env=environment)
        self.url = self.process.stdout.readline().strip()
        if not self.url:
            raise RuntimeError(f"the server did not start: {self.process.stderr.read()}")
        address = urllib.parse.urlsplit(self.url)
        self.host, self.port = address.hostname, address.port
        self.token = urllib.parse.parse_qs(address.query)["token"][0]

    def ask(self, method, path, body=None, headers=None, token=True, timeout=HANG):
        """(status, headers, bytes) of a request."""
        if self.context:
            connection = http.client.HTTPSConnection(self.host, self.port, timeout=timeout, context=self.context)
        else:
            connection = http.client.HTTPConnection(self.host, self.port, timeout=timeout)
        all_headers = {"Authorization": f"Bearer {self.token}"} if token else {}
        all_headers.update(headers or {})
        if isinstance(body, (dict, list)):
            body = json.dumps(body)
        try:
            connection.request(method, path, body, all_headers)
            answer = connection.getresponse()
            return answer.status, answer.headers, answer.read()
        finally:
            connection.close()

    def json(self, method, path, body=None, expect=200):
        status, _, text = self.ask(method, path, body)
        assert status == expect, f"{method} {path}: {status} {text[:300]}"
        return json.loads(text)

    def data(self, seconds=HANG):
        """api/data once it is read."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            status, _, text = self.ask("GET", "/api/data")
            if status == 200:
                return json.loads(text)
            assert status == 503, (status, text)
            time.sleep(0.05)
        raise AssertionError("the data was not read in time")

    def socket(self, **words):
        return WebSocket(self, **words)

    def stop(self, how=signal.SIGTERM, seconds=HANG):
        """(exit status, stderr)."""
        if self.process.poll() is None:
            self.process.send_signal(how)
        try:
            _, errors = self.process.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.communicate()
            raise AssertionError("the server did not end when it was told to") from None
        return self.process.returncode, errors

    def resident_bytes(self):
        with open(f"/proc/{self.process.pid}/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.process.communicate()


class WebSocket:
    def __init__(self, server, token=True, headers=None, timeout=HANG):
        self.stream = socket.create_connection((server.host, server.port), timeout=timeout)
        self.stream.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        if server.context:
            self.stream = server.context.wrap_socket(self.stream, server_hostname=server.host)
        key = base64.b64encode(secrets.token_bytes(16)).decode()
        lines = [f"GET /socket{'?token=' + server.token if token else ''} HTTP/1.1", "Upgrade: websocket",
                 "Connection: Upgrade", f"Sec-WebSocket-Key: {key}", "Sec-WebSocket-Version: 13"]
        all_headers = {"Host": f"{server.host}:{server.port}", **(headers or {})}
        lines += [f"{name}: {value}" for name, value in all_headers.items()]
        self.stream.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
        self.rest = b""
        while b"\r\n\r\n" not in self.rest:
            self.rest += self._some()
        head, self.rest = self.rest.split(b"\r\n\r\n", 1)
        self.status = int(head.split()[1])
        fields = [line.split(":", 1) for line in head.decode().split("\r\n")[1:]]
        self.protocol = {name.lower(): value.strip() for name, value in fields}.get("sec-websocket-protocol")

    def _some(self):
        data = self.stream.recv(1 << 16)
        if not data:
            raise ConnectionError("the server has closed the connection")
        return data

    def _take(self, count):
        parts = [self.rest]
        have = len(self.rest)
        while have < count:
            parts.append(self._some())
            have += len(parts[-1])
        all_of = b"".join(parts)
        self.rest = all_of[count:]
        return all_of[:count]

    def send_bytes(self, payload, opcode=1):
        head = bytes([0x80 | opcode])
        if len(payload) < 126:
            head += bytes([0x80 | len(payload)])
        elif len(payload) < 1 << 16:
            head += bytes([0x80 | 126]) + struct.pack(">H", len(payload))
        else:
            head += bytes([0x80 | 127]) + struct.pack(">Q", len(payload))
        mask = secrets.token_bytes(4)
        repeated = (mask * (len(payload) // 4 + 1))[:len(payload)]
        masked = (int.from_bytes(payload, "big") ^ int.from_bytes(repeated, "big")).to_bytes(len(payload), "big")
        self.stream.sendall(head + mask + masked)

    def send(self, message):
        self.send_bytes(json.dumps(message).encode())

    def state(self, number, state, moving=False):
        self.send({"type": "state", "number": number, "moving": moving, "state": state})

    def receive(self):
        """A text message as JSON, or a frame as (header, image)."""
        while True:
            first, second = self._take(2)
            length = second & 0x7f
            if length == 126:
                length = struct.unpack(">H", self._take(2))[0]
            elif length == 127:
                length = struct.unpack(">Q", self._take(8))[0]
            payload = self._take(length)
            opcode = first & 0xf
            if opcode == 1:
                return json.loads(payload)
            if opcode == 2:
                head = struct.unpack("<I", payload[:4])[0]
                return json.loads(payload[4:4 + head]), payload[4 + head:]
            if opcode == 8:
                raise ConnectionError("the server has closed the connection")
            if opcode == 9:
                self.send_bytes(payload, 10)
            if opcode == 10:
                return {"type": "pong"}

    def frame(self, acknowledge=True):
        """The next frame; other messages are skipped, errors raised."""
        while True:
            message = self.receive()
            if isinstance(message, tuple):
                if acknowledge:
                    self.send({"type": "ack", "frame": message[0]["frame"]})
                return message
            if message["type"] in ("error", "ended"):
                raise RuntimeError(message["error"])

    def begin_long_frame(self, number, state):
        """Requests larger and larger frames until the server reports progress of one; returns that state's number."""
        for size in ("3000x3000", "5000x5000", "8000x8000"):
            self.state(number, dict(state, size=size))
            while True:
                message = self.receive()
                if isinstance(message, tuple):
                    self.send({"type": "ack", "frame": message[0]["frame"]})
                    if message[0]["number"] == number and message[0]["final"]:
                        break
                elif message["type"] == "progress" and message["number"] == number:
                    return number
                elif message["type"] in ("error", "ended"):
                    raise RuntimeError(message["error"])
            number += 1
        raise RuntimeError("every frame is there before the server says how far it is")

    def last_frame(self, number):
        """The exact frame of a state."""
        while True:
            header, image = self.frame()
            if header["number"] == number and header["final"]:
                return header, image

    def close(self):
        self.stream.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
