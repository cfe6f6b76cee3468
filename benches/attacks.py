#!/usr/bin/env python3
"""Attacks a daemon of its own from 127.0.0.2 and measures its memory and a victim at 127.0.0.1.

    benches/attacks.py target/release/strew [--keys] [ATTACK ...]
    benches/attacks.py --container 256m strew:ci [--keys] [ATTACK ...]

Needs Linux and nothing besides Python. With --container the program is an image, which an engine (docker) runs in the
network of this machine with this much memory; a daemon that the kernel kills is an error. With --keys the daemon requires a key, which attackers of
closed paths and the victim have. Attackers, victim and daemon share the processors; attackers that
keep sending are processes of their own.
"""

import argparse
import base64
import gzip
import http.client
import json
import math
import multiprocessing
import os
import pathlib
import re
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import zlib

SMALL = "/v1/points?bbox=0,0,10,10&spacing=1"
LARGE = "/v1/nearest?at=0,0&k=10000&spacing=1&attributes=angle,u1,u2,u3,u4,u5,u6,u7,u8"
LONG = "/v1/points?bbox=0,0,31700,31700&spacing=1&format=f32"
COUNT = "/v1/count?circle=0,0,270000&spacing=1&warp=2&seed=7"
SPECTRUM = "/v1/profiles/blue/spectrum.svg"
HEALTH = "/grpc.health.v1.Health/"
CALL = {"content-type": "application/grpc", "te": "trailers"}
# The attacker's requests on each HTTP/2 connection.
STREAMS = 99


class Daemon:
    def __init__(self, program, keys, container=None):
        self.key = self.container = None
        with socket.create_server(("127.0.0.1", 0)) as free:
            self.port = free.getsockname()[1]
        settings = [f"server.listen=127.0.0.1:{self.port}", "log.filter=error"]
        self.folder = tempfile.TemporaryDirectory()
        folder = "/attacks" if container else self.folder.name
        os.chmod(self.folder.name, 0o777)
        settings.append(f"tables.folder={folder}")
        if keys:
            run = ["docker", "run", "--rm", program] if container else [program]
            made = subprocess.run([*run, "key", "new", "client"], capture_output=True, text=True)
            self.key = re.search("strew_[0-9a-f]+", made.stderr).group(0)
            pathlib.Path(self.folder.name, "keys.toml").write_text(made.stdout)
            settings.append(f"access.keys_file={folder}/keys.toml")
        command = ["serve", *(word for setting in settings for word in ("--set", setting))]
        if container:
            self.contain([program, *command], container)
        else:
            self.process = subprocess.Popen([program, *command], stdout=subprocess.PIPE, text=True)
            self.process.stdout.readline()
            self.pid = self.process.pid
        self.victim(SMALL, 1)
        self.idle = self.memory()

    def contain(self, command, memory):
        """Runs the image as deploy/ does, with this much memory and none beside it."""
        flags = ["--read-only", "--cap-drop", "ALL", "--security-opt", "no-new-privileges", "--network", "host"]
        flags += ["-m", memory, "--memory-swap", memory, "-v", f"{self.folder.name}:/attacks"]
        run = subprocess.run(["docker", "run", "-d", *flags, *command], capture_output=True, text=True, check=True)
        self.container = run.stdout.strip()
        while "listening on" not in subprocess.run(["docker", "logs", self.container], capture_output=True, text=True).stdout:
            self.must_run()
            time.sleep(0.1)
        self.pid = int(self.inspect("{{.State.Pid}}"))

    def inspect(self, template):
        shown = subprocess.run(["docker", "inspect", "-f", template, self.container], capture_output=True, text=True)
        return shown.stdout.strip()

    def must_run(self):
        state = self.inspect("{{.State.Status}}, out of memory: {{.State.OOMKilled}}, restarts: {{.RestartCount}}")
        if state != "running, out of memory: false, restarts: 0":
            log = subprocess.run(["docker", "logs", "--tail", "20", self.container], capture_output=True, text=True)
            sys.exit(f"the container is {state}\n{log.stdout}{log.stderr}")

    def end(self):
        """Ends the daemon, which must have survived."""
        if self.container:
            self.must_run()
            subprocess.run(["docker", "rm", "-f", "-v", self.container], capture_output=True)
        else:
            self.process.kill()
            self.process.wait()

    def headers(self):
        return {"x-api-key": self.key} if self.key else {}

    def memory(self, figure="VmRSS"):
        """Memory in MiB."""
        status = open(f"/proc/{self.pid}/status").read()
        return int(re.search(figure + r":\s+(\d+)", status).group(1)) // 1024

    def connect(self, address="127.0.0.2"):
        stream = socket.socket()
        stream.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        stream.settimeout(60)
        stream.bind((address, 0))
        stream.connect(("127.0.0.1", self.port))
        return stream

    def request(self, method, path, body=b""):
        """An HTTP/1.1 request."""
        lines = [f"{method} {path} HTTP/1.1", "host: localhost", f"content-length: {len(body)}"]
        lines += [f"{name}: {value}" for name, value in self.headers().items()]
        return "\r\n".join([*lines, "", ""]).encode() + body

    def unread(self, path, connections):
        """Connections that send a request and read the status only, which are counted."""
        streams = [self.connect() for _ in range(connections)]
        for stream in streams:
            stream.sendall(self.request("GET", path))
        statuses = {}
        for stream in streams:
            count(statuses, status(stream))
        return streams, statuses

    def http2(self):
        """An HTTP/2 connection whose streams have no window."""
        stream = self.connect()
        settings = frame(4, 0, 0, struct.pack(">HI", 4, 0))
        stream.sendall(b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n" + settings)
        return stream

    def victim(self, path, seconds):
        """The latencies and statuses of one request after the other."""
        times, statuses = [], {}
        end = time.time() + seconds
        while time.time() < end:
            start = time.perf_counter()
            try:
                connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=30)
                connection.request("GET", path, headers=self.headers())
                answer = connection.getresponse()
                answer.read()
                connection.close()
                count(statuses, answer.status)
            except OSError as error:
                count(statuses, type(error).__name__)
            times.append(1e3 * (time.perf_counter() - start))
        times.sort()
        middle, late = times[len(times) // 2], times[int(0.99 * (len(times) - 1))]
        return f"p50 {middle:.1f}, p99 {late:.1f}, max {times[-1]:.1f} ms {statuses}"

    def json(self, method, path, body=None):
        """The document of an answer."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=30)
        headers = {"content-type": "application/json", **self.headers()}
        connection.request(method, path, body and json.dumps(body), headers)
        answer = connection.getresponse().read()
        connection.close()
        return json.loads(answer)

    def report(self, what):
        print(f"{what}: {self.idle} MiB idle, {self.memory('VmHWM')} at most; victim: {self.victim(SMALL, 2)}", flush=True)

    def report_left(self):
        """Waits after the attackers have left."""
        for seconds in (2, 15, 15):
            time.sleep(seconds)
            print(f"    {seconds} s later: {self.memory()} MiB", flush=True)


def count(counts, what):
    counts[what] = counts.get(what, 0) + 1


def status(stream):
    try:
        return stream.recv(12)[9:].decode() or "closed"
    except OSError as error:
        return type(error).__name__


def frame(kind, flags, stream, payload=b""):
    return struct.pack(">I", len(payload))[1:] + bytes([kind, flags]) + struct.pack(">I", stream) + payload


def head(stream, method, path, headers, ends=True):
    """A request's HEADERS, as literals without an index."""
    names = {":method": method, ":scheme": "http", ":path": path, ":authority": "x", **headers}
    block = b""
    for name, value in names.items():
        # Lengths from 127 on continue in a second byte.
        length = bytes([len(value)]) if len(value) < 127 else bytes([127, len(value) - 127])
        block += b"\0" + bytes([len(name)]) + name.encode() + length + value.encode()
    return frame(1, 5 if ends else 4, stream, block)


def closed(streams):
    """The number of connections that the daemon has closed."""
    number = 0
    for stream in streams:
        stream.setblocking(False)
        try:
            while stream.recv(65536):
                pass
            number += 1
        except BlockingIOError:
            pass
        except OSError:
            number += 1
        stream.setblocking(True)
    return number


def without_window(daemon, path, headers, connections, reset_every=None):
    streams = [daemon.http2() for _ in range(connections)]
    for stream in streams:
        for i in range(STREAMS):
            stream.sendall(head(2 * i + 1, "GET", path, headers))
    start = last = time.time()
    time.sleep(4)
    daemon.report(f"{path}, {connections} connections without a window")
    number = 2 * STREAMS + 1
    while closed(streams) < connections and time.time() - start < 120:
        time.sleep(1)
        if reset_every and time.time() - last > reset_every:
            last, number = time.time(), number + 2
            for stream in streams:
                try:
                    stream.sendall(head(number, "GET", "/livez", {}) + frame(3, 0, number, bytes([0, 0, 0, 8])))
                except OSError:
                    pass
    print(f"    {closed(streams)} closed after {time.time() - start:.0f} s", flush=True)
    for stream in streams:
        stream.close()
    daemon.report_left()


def calls(daemon, method, message, connections):
    streams = [daemon.http2() for _ in range(connections)]
    for stream in streams:
        for i in range(STREAMS):
            stream.sendall(head(2 * i + 1, "POST", HEALTH + method, CALL, False))
            if message is not None:
                stream.sendall(frame(0, 1, 2 * i + 1, message))
    time.sleep(4)
    daemon.report(f"{connections} x {STREAMS} calls of {method}")
    time.sleep(30)
    print(f"    30 s later: {daemon.memory()} MiB", flush=True)


def compared(daemon, clients, attack, victims, wait=2):
    """Victims alone, and while clients attack: in a process that ends when the event is set, with a
    thread for each, which counts statuses."""
    alone = [daemon.victim(path, 3) for path in victims]
    is_over, counted = multiprocessing.Event(), multiprocessing.Queue()

    def run():
        statuses = {}
        threads = [threading.Thread(target=attack, args=(is_over, statuses)) for _ in range(clients)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        counted.put(statuses)

    attackers = multiprocessing.Process(target=run)
    attackers.start()
    time.sleep(wait)
    for path, before in zip(victims, alone):
        print(f"{path}\n    alone:    {before}\n    attacked: {daemon.victim(path, 4)}", flush=True)
    print(f"    {daemon.memory('VmHWM')} MiB at most", flush=True)
    is_over.set()
    print(f"    {clients} attackers: {counted.get()}", flush=True)
    attackers.join()


def repeated(daemon, clients, request, victims):
    """Victims while clients repeat a request."""

    def repeat(is_over, statuses):
        while not is_over.is_set():
            try:
                stream = daemon.connect()
                stream.sendall(request)
                count(statuses, status(stream))
                stream.close()
            except OSError as error:
                count(statuses, type(error).__name__)

    compared(daemon, clients, repeat, victims)


def pages(daemon):
    for coding in ("zstd", "gzip"):
        without_window(daemon, "/openapi.json", {"accept-encoding": coding}, 20)


def answers(daemon):
    streams, statuses = daemon.unread(LARGE, 400)
    daemon.report(f"400 unread whole answers {statuses}")
    for stream in streams:
        stream.close()
    daemon.report_left()


def bodies(daemon):
    body = b'{"spacing": 1, "unknown": [0' + b",0" * 1_990_000 + b"]}"
    repeated(daemon, 8, daemon.request("POST", "/v1/points:query", body), [SMALL, "/livez"])


def arriving(daemon):
    """Bodies of 4 MiB without their last byte."""
    request = daemon.request("POST", "/v1/points:query", bytes(4 << 20))[:-1]

    def send(is_over, statuses):
        try:
            stream = daemon.connect()
            stream.sendall(request)
            is_over.wait()
            stream.setblocking(False)
            count(statuses, status(stream))
        except OSError as error:
            count(statuses, type(error).__name__)

    compared(daemon, 300, send, [SMALL, SMALL, "/livez"], wait=0)


def counts(daemon):
    victims = [
        SMALL,
        "/v1/count?circle=0,0,3000&spacing=1",
        "/v1/points?bbox=0,0,200,200&spacing=1&warp=1&format=csv",
        "/v1/chunks/64/3/4?spacing=1&format=f32",
        "/livez",
    ]
    repeated(daemon, 4, daemon.request("GET", COUNT), victims)


def readers(daemon):
    streams, statuses = daemon.unread(LONG, 256)
    daemon.report(f"256 unread streams {statuses}")
    for stream in streams:
        stream.close()


def documents(daemon):
    without_window(daemon, SPECTRUM, daemon.headers(), 60, reset_every=15)


def health(daemon):
    calls(daemon, "Check", None, 40)
    calls(daemon, "Watch", bytes(5), 60)


VICTIMS = [
    SMALL,
    "/v1/chunks/64/3/4?spacing=1&format=f32",
    "/v1/points?bbox=0,0,200,200&spacing=1&seed=7&format=csv",
    "/livez",
]


def costly(octaves=8, parts=60):
    """A field that takes some ten microseconds a look."""
    return {"multiply": [{"noise": {"wavelength": 5 + i, "octaves": octaves, "seed": i}} for i in range(parts)]}


def reading(daemon, clients, request, victims):
    """Victims while clients read the answers to a request, again and again."""

    def read(is_over, statuses):
        while not is_over.is_set():
            try:
                stream = daemon.connect()
                stream.settimeout(1)
                stream.sendall(request)
                count(statuses, status(stream))
                while not is_over.is_set() and stream.recv(65536):
                    pass
            except TimeoutError:
                count(statuses, "late")
            except OSError as error:
                count(statuses, type(error).__name__)

    compared(daemon, clients, read, victims)


def mixes(daemon):
    """Kinds of ever new shares, whose clients leave after 0.3 s."""
    number = iter(range(1, 10**6))

    def leave(is_over, statuses):
        while not is_over.is_set():
            some = next(number)
            shares = f"oak:{1 + some % 1020},fir:{1020 - some % 1020}"
            path = f"/v1/points?bbox=0,0,9,9&spacing=1&spread=even&variants={shares}&map={'lms'[some % 3]}"
            try:
                stream = daemon.connect()
                stream.sendall(daemon.request("GET", path))
                stream.settimeout(0.3)
                count(statuses, status(stream))
                stream.close()
            except OSError as error:
                count(statuses, type(error).__name__)

    compared(daemon, 12, leave, [*VICTIMS, "/v1/count?circle=0,0,9000&spacing=1"])


def streams(daemon):
    """Streams of points that cost 50 microseconds each."""
    body = {"region": {"bbox": [0, 0, 3000, 3000]}, "spacing": 1, "format": "f32", "terrain": costly(), "heights": [0, 9], "normals": "on"}
    reading(daemon, 8, daemon.request("POST", "/v1/points:query", json.dumps(body).encode()), VICTIMS)


def longlane(daemon):
    """Work that takes as long as it may, beside an honest long count and a figure."""
    tangled = [[i * 617 % 1000, i * 367 % 1009] for i in range(9999)]
    chain = [
        {"name": f"l{i}", "spacing": 1, "seed": i, "clear_of": {f"l{j}": 1 for j in range(i)}} for i in range(16)
    ]
    box = {"bbox": [0, 0, 1000, 1000]}
    bodies = [
        {"region": box, "spacing": 1, "field": costly()},
        {"region": box, "spacing": 1, "field": {"distance": {"distances": [0, 5], "lines": [tangled]}}},
        {"region": {"bbox": [0, 0, 200, 200]}, "layers": chain},
        {"region": {"circle": {"center": [0, 0], "radius": 250000}}, "spacing": 1, "warp": 2, "seed": 7},
    ]
    victims = [*VICTIMS, "/v1/count?circle=0,0,9000&spacing=1", "/v1/pattern/figures/map.svg?alpha=sqrt(3)"]
    for body in bodies:
        repeated(daemon, 3, daemon.request("POST", "/v1/count", json.dumps(body).encode()), victims)
    split = {"region": {"circle": {"center": [0, 0], "radius": 30000}}, "spacing": 1}
    repeated(daemon, 3, daemon.request("POST", "/v1/points:split?parts=10000", json.dumps(split).encode()), victims)


def underpriced(daemon):
    """What was once taken for short work: chains of layers in space, later layers behind a cursor, stars of many
    corners, parts of a ball."""
    ball = {"ball": {"center": [0, 0, 0], "radius": 3}}
    chain = [{"name": f"l{i}", "spacing": 1, "seed": i, "clear_of": {f"l{i - 1}": 0.6} if i else {}} for i in range(6)]
    circle = {"circle": {"center": [0, 0], "radius": 60000}}
    layers = [{"name": "a", "spacing": 9000}, *({"name": f"b{i}", "spacing": 1, "warp": 1, "seed": i} for i in range(4))]
    page = {"region": circle, "layers": layers, "limit": 10, "format": "json"}
    page["cursor"] = daemon.json("POST", "/v1/points:query", page)["next"]
    turns = [2 * math.pi * i / 60_000 for i in range(60_000)]
    radii = [1e4 if i % 2 else 4e3 for i in range(60_000)]
    ring = [[round(r * math.cos(t), 3), round(r * math.sin(t), 3)] for r, t in zip(radii, turns)]
    star = {"polygon": {"type": "Polygon", "coordinates": [[*ring, ring[0]]]}}
    victims = [*VICTIMS, "/v1/points?bbox=0,0,200,200&spacing=1&format=csv", "/readyz"]
    for path, body in [
        ("/v1/space/count", {"region": ball, "layers": chain}),
        ("/v1/points:query", page),
        ("/v1/count", {"region": star, "spacing": 1e9}),
        ("/v1/space/points:split?parts=300", {"region": {"ball": {"center": [0, 0, 0], "radius": 40}}, "spacing": 1}),
    ]:
        print(path, flush=True)
        repeated(daemon, 4, daemon.request("POST", path, json.dumps(body).encode()), victims)


def four(daemon):
    """Four addresses, each within its share: bodies that do not end, and readers of 5 kB/s."""
    body = daemon.request("POST", "/v1/points:query", bytes(1000))[:-900]
    held = []
    for last in range(2, 6):
        for request, number in ((body, 250), (daemon.request("GET", LONG), 64)):
            for _ in range(number):
                stream = daemon.connect(f"127.0.0.{last}")
                stream.sendall(request)
                held.append(stream)
    time.sleep(2)
    for path in VICTIMS:
        print(f"{path}\n    {daemon.victim(path, 4)}", flush=True)
    print(f"    {len(held)} held, {daemon.memory('VmHWM')} MiB at most", flush=True)


def field(number, content=b""):
    """A field of a message."""
    def varint(value):
        low = bytes([value & 127 | 128])
        return low + varint(value >> 7) if value > 127 else bytes([value])

    return varint(number << 3 | 2) + varint(len(content)) + content


def messages(daemon):
    """4 MB of empty layers and of empty parts of a field, plain and as gzip."""
    many = 2_000_000
    for name, message in [
        ("layers", field(3) * many),
        ("parts", field(2, field(15, field(10, field(1) * many)))),
    ]:
        for coding in ("identity", "gzip"):
            packed = gzip.compress(message) if coding == "gzip" else message
            body = bytes([coding == "gzip"]) + struct.pack(">I", len(packed)) + packed
            headers = {"content-type": "application/grpc-web+proto", "grpc-encoding": coding, **daemon.headers()}
            connection = http.client.HTTPConnection("127.0.0.1", daemon.port, timeout=60, source_address=("127.0.0.2", 0))
            connection.request("POST", "/strew.v1.PointService/StreamPoints", body, headers)
            answer = connection.getresponse()
            answer.read()
            daemon.report(f"{name}, {coding}: {len(body)} bytes, status {answer.headers['grpc-status']}")
            connection.close()


def includes(daemon):
    boxes = b",".join([b'{"bbox":[0,0,1,1]}'] * 210_000)
    body = b'{"spacing": 1, "region": {"include": [' + boxes + b"]}}"
    repeated(daemon, 8, daemon.request("POST", "/v1/points:query", body), [SMALL, "/livez"])


def fields_posts(daemon):
    body = b'{"distance": {"unknown": [0' + b",0" * 1_990_000 + b"]}}"
    victims = [
        SMALL,
        "/v1/points?bbox=0,0,200,200&spacing=1&warp=1&format=csv",
        "/v1/chunks/64/3/4?spacing=1&format=f32",
        "/livez",
    ]
    repeated(daemon, 8, daemon.request("POST", "/v1/fields", body), victims)


def wide_tiff(width, height, tile):
    """A TIFF whose tiles of one row are far wider than the picture; all of them are the same bytes."""
    packed = zlib.compress(bytes(tile), 9)
    places = 8 + len(packed)
    tags = [(256, 1, width), (257, 1, height), (258, 1, 8), (259, 1, 8), (262, 1, 1), (277, 1, 1), (322, 1, tile)]
    tags += [(323, 1, 1), (324, height, places), (325, height, places + 4 * height)]
    arrays = struct.pack(f"<{2 * height}I", *[8] * height, *[len(packed)] * height)
    entries = b"".join(struct.pack("<HHII", tag, 4, n, value) for tag, n, value in tags)
    head = struct.pack("<2sHI", b"II", 42, places + len(arrays))
    return head + packed + arrays + struct.pack("<H", len(tags)) + entries + bytes(4)


def mask(side, shade):
    """A gray PNG of one shade."""

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = chunk(b"IHDR", struct.pack(">IIBBBBB", side, side, 8, 0, 0, 0, 0))
    rows = zlib.compress((b"\0" + bytes([shade]) * side) * side, 9)
    return b"\x89PNG\r\n\x1a\n" + head + chunk(b"IDAT", rows) + chunk(b"IEND", b"")


def raster(picture):
    return {"raster": {"png": base64.b64encode(picture).decode()}}


def pictures(daemon):
    """Pictures that would inflate to gigabytes: large bodies, and bodies that are read at once; then PNGs."""
    victims = [
        SMALL,
        "/v1/points?bbox=0,0,200,200&spacing=1&seed=7&format=csv",
        "/v1/chunks/64/3/4?spacing=1&format=f32",
        "/livez",
    ]
    for clients, picture in (
        (2, wide_tiff(64, 16384, 20_000_000)),
        (8, wide_tiff(16, 200, 1 << 20)),
        (8, mask(1024, 7)),
    ):
        body = json.dumps(raster(picture)).encode()
        print(f"bodies of {len(body)} bytes", flush=True)
        repeated(daemon, clients, daemon.request("POST", "/v1/fields", body), victims)


def sent(daemon):
    """40 fields of 4 MB push out none of another client's."""
    known = daemon.json("POST", "/v1/fields", raster(mask(256, 255)))["digest"]
    floats = base64.b64encode(bytes(3_000_000)).decode()
    statuses = {}
    for i in range(40):
        pixels = {"f32": floats, "width": 1000, "height": 750, "bbox": [0, 0, 1 + i, 1]}
        stream = daemon.connect()
        stream.sendall(daemon.request("POST", "/v1/fields", json.dumps({"raster": pixels}).encode()))
        count(statuses, status(stream))
        stream.close()
    named = daemon.victim(f"{SMALL}&field={known}", 1)
    daemon.report(f"40 fields {statuses}; the other client's: {named}")


ATTACKS = [
    pages,
    answers,
    bodies,
    arriving,
    counts,
    readers,
    documents,
    health,
    messages,
    includes,
    fields_posts,
    pictures,
    sent,
    mixes,
    streams,
    longlane,
    underpriced,
    four,
]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--container", metavar="MEMORY")
    parser.add_argument("--keys", action="store_true")
    parser.add_argument("attack", nargs="*", metavar="ATTACK", help=", ".join(a.__name__ for a in ATTACKS))
    arguments = parser.parse_intermixed_args()
    for attack in ATTACKS:
        if not arguments.attack or attack.__name__ in arguments.attack:
            print(f"## {attack.__name__}", flush=True)
            daemon = Daemon(arguments.program, arguments.keys, arguments.container)
            try:
                attack(daemon)
            finally:
                daemon.end()


if __name__ == "__main__":
    main()
