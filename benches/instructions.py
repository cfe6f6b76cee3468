#!/usr/bin/env python3
"""Counts what a request costs a daemon: instructions and allocations, the same in every run.

    benches/instructions.py PROGRAM [CASE ...] [--check | --write] [--few] [--kept FILE] [--profile FOLDER]

Needs Linux, valgrind and nothing besides Python. The program has names, since allocations are counted by the names of
functions: `cargo build --profile profiling`, or a debug build. One daemon runs under callgrind and logs warnings
only; each case is asked 40 times to warm up and 200 times to be counted, on one connection. Instructions are those of
the whole process, the kernel's excluded. Cases of the library are boxes of the example `counted` of strew-core beside
the program, if it is there: what the points of a box take without a daemon.

`--write` keeps the figures in benches/instructions.txt, or another file; `--check` fails where one is more than 3 %
above those kept, if the compiler is the same. `--few` asks 10 and 40 times: for debug builds, which are slow.
`--profile` keeps callgrind's files, one for each case, for callgrind_annotate.
"""

import argparse
import os
import pathlib
import re
import socket
import ssl
import struct
import subprocess
import sys
import tempfile

# How often a case is asked to warm up and to be counted.
MANY, FEW = (40, 200), (10, 40)
KEPT = pathlib.Path(__file__).with_suffix(".txt")
# More than this above what is kept is too much.
TOLERANCE = 1.03
# Numbers of the contract.
ENCODING, F32 = 4, 3
# Functions that allocate, of any allocator.
ALLOCATING = re.compile(r"^(_rjem_|mi_)?(c|m|re)alloc(x|_aligned)?$|^(_rjem_)?(posix_)?memalign$|^rallocx$")


def box(number, side=31.6):
    """A box elsewhere for each number."""
    x, y = number % 997 * 40, number // 997 * 40
    return x, y, x + side, y + side


def boxed(path, rest, side=31.6):
    """Paths with a box."""
    return lambda number: f"{path}?bbox={','.join(map(str, box(number, side)))}&spacing=1{rest}"


def chunk(rest):
    return lambda number: f"/v1/chunks/32/{number % 997}/{number // 997}?spacing=1{rest}"


# What is asked over HTTP/1.1: the path of each number.
GETS = {
    "livez": lambda number: "/livez",
    "empty box": boxed("/v1/points", "&format=f32", 0.001),
    "box, f32": boxed("/v1/points", "&format=f32"),
    "box, csv": boxed("/v1/points", "&format=csv"),
    "box, json": boxed("/v1/points", "&format=json"),
    "box, f32, seeded": boxed("/v1/points", "&format=f32&seed=7"),
    "box, csv, seeded": boxed("/v1/points", "&format=csv&seed=7"),
    "box, f32, in a field": boxed("/v1/points", "&format=f32&seed=7&field=forest&settle=0"),
    "chunk, f32": chunk("&format=f32"),
    "chunk, f32, seeded": chunk("&format=f32&seed=7"),
    "chunk, csv, seeded": chunk("&format=csv&seed=7"),
    "chunk, json, seeded": chunk("&format=json&seed=7"),
    "nearest 8": lambda number: f"/v1/nearest?at={number * 40},3&k=8&spacing=1&seed=7",
    "point by id": lambda number: "/v1/points/0:0?spacing=1",
    "count": boxed("/v1/count", ""),
    "count, seeded": boxed("/v1/count", "&seed=7"),
}


def varint(value):
    text = bytearray()
    while value > 127:
        text.append(value & 127 | 128)
        value >>= 7
    return bytes(text) + bytes([value])


def member(number, value):
    """A field of a message: bytes, or an integer."""
    if isinstance(value, int):
        return varint(number << 3) + varint(value)
    if isinstance(value, float):
        return varint(number << 3 | 1) + struct.pack("<d", value)
    return varint(number << 3 | 2) + varint(len(value)) + value


def query(region, encoding=0, seed=0):
    amount = member(2, 1.0) + (member(9, seed) if seed else b"")
    return member(1, region) + member(2, amount) + (member(ENCODING, encoding) if encoding else b"")


def in_box(number, side=31.6):
    edges = enumerate(box(number, side), 1)
    return member(1, b"".join(member(place, float(edge)) for place, edge in edges))


def in_chunk(number):
    return member(4, member(1, 32.0) + member(2, number % 997) + member(3, number // 997))


# Calls: the method and the message of each number.
CALLS = {
    "CountPoints": ("CountPoints", lambda number: query(in_box(number))),
    "FindNearest": (
        "FindNearest",
        lambda number: member(1, member(1, number * 40.0) + member(2, 3.0))
        + member(2, 8)
        + member(4, member(2, 1.0) + member(9, 7)),
    ),
    "GetPoint": ("GetPoint", lambda number: member(1, b"0:0") + member(2, member(2, 1.0))),
    "StreamPoints, empty": ("StreamPoints", lambda number: query(in_box(number, 0.001), F32)),
    "StreamPoints, box, f32": ("StreamPoints", lambda number: query(in_box(number), F32)),
    "StreamPoints, chunk, f32, seeded": ("StreamPoints", lambda number: query(in_chunk(number), F32, 7)),
}
SERVICE = "/strew.v1.PointService/"


class Http1:
    """A connection for answers of a known or unknown length."""

    def __init__(self, stream):
        self.stream = stream
        self.rest = b""

    def more(self):
        got = self.stream.recv(1 << 20)
        assert got, "the daemon hung up"
        self.rest += got

    def ask(self, method, path, headers=(), body=b""):
        """The head, in small letters, and the body of an answer."""
        lines = [f"{method} {path} HTTP/1.1", "host: localhost", *headers]
        if body:
            lines.append(f"content-length: {len(body)}")
        self.stream.sendall(("\r\n".join(lines) + "\r\n\r\n").encode() + body)
        while b"\r\n\r\n" not in self.rest:
            self.more()
        head, _, self.rest = self.rest.partition(b"\r\n\r\n")
        head = head.decode().lower()
        if "transfer-encoding: chunked" in head:
            return head, self.chunked()
        length = re.search(r"content-length: (\d+)", head)
        return head, self.take(int(length[1]) if length else 0)

    def take(self, length):
        while len(self.rest) < length:
            self.more()
        taken, self.rest = self.rest[:length], self.rest[length:]
        return taken

    def chunked(self):
        whole = b""
        while True:
            while b"\r\n" not in self.rest:
                self.more()
            size, _, self.rest = self.rest.partition(b"\r\n")
            part = self.take(int(size, 16) + 2)[:-2]
            if not part:
                return whole
            whole += part


class Http2:
    """A connection of HTTP/2 for calls one after another, with as few frames as there can be."""

    def __init__(self, stream):
        self.stream = stream
        self.rest = b""
        self.next = 1
        stream.sendall(b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n")
        # No pushes, windows as large as can be.
        self.send(4, 0, 0, struct.pack(">HIHI", 2, 0, 4, 2**31 - 1))
        self.send(8, 0, 0, struct.pack(">I", 2**31 - 1 - 65535))

    def send(self, kind, flags, number, payload):
        length = struct.pack(">I", len(payload))[1:]
        self.stream.sendall(length + struct.pack(">BBI", kind, flags, number) + payload)

    def frame(self):
        def take(length):
            while len(self.rest) < length:
                got = self.stream.recv(1 << 20)
                assert got, "the daemon hung up"
                self.rest += got
            taken, self.rest = self.rest[:length], self.rest[length:]
            return taken

        head = take(9)
        kind, flags, number = struct.unpack(">BBI", head[3:])
        return kind, flags, number, take(int.from_bytes(head[:3], "big"))

    def call(self, method, message):
        """The bytes of an answer."""
        fields = [
            (":method", "POST"),
            (":scheme", "http"),
            (":path", SERVICE + method),
            (":authority", "a"),
            ("content-type", "application/grpc"),
            ("te", "trailers"),
        ]
        # Literal, never indexed, not compressed (RFC 7541, 6.2.3).
        text = b""
        for name, value in fields:
            text += b"\x10" + bytes([len(name)]) + name.encode() + bytes([len(value)]) + value.encode()
        number, self.next = self.next, self.next + 2
        self.send(1, 4, number, text)
        self.send(0, 1, number, struct.pack(">BI", 0, len(message)) + message)
        answer = b""
        while True:
            kind, flags, of, payload = self.frame()
            if kind == 4 and not flags & 1:
                self.send(4, 1, 0, b"")
            assert kind != 7 and kind != 3, payload
            if of == number and kind == 0:
                answer += payload
                self.send(8, 0, 0, struct.pack(">I", max(len(payload), 1)))
            if of == number and kind in (0, 1) and flags & 1:
                return answer


class Daemon:
    def __init__(self, program, folder, certificate, often):
        self.folder = folder
        self.often = often
        command = ["valgrind", "--tool=callgrind", "-q", f"--callgrind-out-file={folder}/out"]
        command += [program, "serve", "--listen", "127.0.0.1:0", "--set", "log.filter=warn"]
        if certificate:
            command += ["--set", f"tls.certificate={certificate}.pem", "--set", f"tls.key={certificate}.key"]
        # One thread for sockets: who wakes whom is not by chance.
        environment = {**os.environ, "TOKIO_WORKER_THREADS": "1"}
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment)
        self.port = int(self.process.stdout.readline().rsplit(":", 1)[1])
        self.dumps = 0

    def control(self, *what):
        command = ["callgrind_control", *what, str(self.process.pid)]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        assert done.returncode == 0 and "Error" not in done.stdout, done.stdout

    def connect(self, is_tls=False):
        stream = socket.create_connection(("127.0.0.1", self.port))
        stream.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        if not is_tls:
            return stream
        context = ssl.create_default_context()
        context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
        return context.wrap_socket(stream)

    def count(self, ask):
        """Instructions and allocations of a request."""
        warm, counted = self.often
        for number in range(warm):
            ask(number)
        self.control("--zero")
        for number in range(warm, warm + counted):
            ask(number)
        self.dumps += 1
        self.control(f"--dump={self.dumps}")
        text = next(pathlib.Path(self.folder).glob(f"out.{self.dumps}")).read_text()
        return total(text) / counted, allocations(text) / counted


def total(text):
    """The instructions in one of callgrind's files."""
    return int(re.search(r"^(?:totals|summary): (\d+)", text, re.M)[1])


def alone(program, arguments, folder, often):
    """Instructions and allocations of one of the boxes that a program makes."""

    def of(boxes):
        file = pathlib.Path(folder, "alone")
        command = ["valgrind", "--tool=callgrind", "-q", f"--callgrind-out-file={file}", program, str(boxes)]
        subprocess.run([*command, *arguments], check=True)
        text = file.read_text()
        return total(text), allocations(text)

    warm, counted = often
    pairs = zip(of(warm + counted), of(warm))
    return tuple((all - before) / counted for all, before in pairs)


def allocations(text):
    """The calls of functions that allocate in one of callgrind's files."""
    names, calls, called = {}, 0, ""
    for line in text.splitlines():
        if match := re.match(r"c?fn=\((\d+)\)(?: (.*))?", line):
            number, name = match.groups()
            if name:
                names[number] = name.split("'")[0]
            if line.startswith("c"):
                called = names[number]
        elif line.startswith("calls=") and ALLOCATING.match(called):
            calls += int(line[6:].split()[0])
    return calls


def cases(wanted=()):
    """The names of the cases, and what asks them: over HTTP/1.1, and as calls."""
    every = [*GETS, "unchanged (304)", *CALLS, *WEB, *TLS, *LIBRARY]
    chosen = [name for name in every if not wanted or name in wanted]
    unknown = [name for name in wanted if name not in chosen]
    if unknown:
        sys.exit(f"no case {unknown[0]!r}; there are: {', '.join(cases([]))}")
    return chosen


# Calls as pages send them, and what is asked over TLS.
WEB = {"gRPC-Web: CountPoints": "CountPoints", "gRPC-Web: StreamPoints, box, f32": "StreamPoints, box, f32"}
TLS = {"TLS: livez": "livez", "TLS: box, f32": "box, f32"}
# Boxes without a daemon, by the further arguments of the example.
LIBRARY = {"library: box, f32": [], "library: box, f32, seeded": ["7"]}


def good(answer):
    head, body = answer
    assert head.startswith(("http/1.1 200", "http/1.1 304")), (head, body)
    return head


def asker(name, daemon):
    """Asks a case once, with a number."""
    if name in CALLS:
        method, message = CALLS[name]
        connection = Http2(daemon.connect())
        return lambda number: connection.call(method, message(number))
    connection = Http1(daemon.connect(name in TLS))
    if name in WEB:
        method, message = CALLS[WEB[name]]
        lines = ["content-type: application/grpc-web+proto"]

        def call(number):
            sent = message(number)
            good(connection.ask("POST", SERVICE + method, lines, struct.pack(">BI", 0, len(sent)) + sent))

        return call
    if name == "unchanged (304)":
        path = GETS["box, f32"](0)
        tag = re.search(r"etag: (.*)", good(connection.ask("GET", path)))[1].strip()
        lines = [f"if-none-match: {tag}"]
        return lambda number: good(connection.ask("GET", path, lines))
    path = GETS[TLS.get(name, name)]
    return lambda number: good(connection.ask("GET", path(number)))


def certificate(folder):
    """A certificate and its key, or None where there is no openssl."""
    made = f"{folder}/self"
    command = ["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes"]
    command += ["-subj", "/CN=localhost", "-keyout", f"{made}.key", "-out", f"{made}.pem"]
    try:
        subprocess.run(command, check=True, capture_output=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    return made


def kept(file):
    """The figures of the last `--write`, by case, and the compiler of the program that had them."""
    if not file.exists():
        return {}, None
    compiler, _, *lines = file.read_text().splitlines()
    rows = (re.split(r"  +", line.strip()) for line in lines)
    figures = {name: (float(instructions.replace(",", "")), float(calls)) for name, instructions, calls in rows}
    return figures, compiler


def compiler():
    """The version of the compiler, without its date."""
    told = subprocess.run(["rustc", "--version"], stdout=subprocess.PIPE, text=True, check=True).stdout
    return " ".join(told.split()[:2])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("cases", nargs="*")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--few", action="store_true")
    parser.add_argument("--kept", type=pathlib.Path, default=KEPT)
    parser.add_argument("--profile", type=pathlib.Path)
    args = parser.parse_args()
    (before, before_by), found = kept(args.kept), {}
    often = FEW if args.few else MANY
    chosen = cases(args.cases)

    def tell(name):
        instructions, calls = found[name]
        share = f"{instructions / before[name][0] - 1:+8.1%}" if name in before else ""
        print(f"{name:34}  {instructions:11,.0f}  {calls:6.1f}{share}", flush=True)

    with tempfile.TemporaryDirectory() as folder:
        for is_tls in (False, True):
            names = [name for name in chosen if name not in LIBRARY and (name in TLS) == is_tls]
            made = certificate(folder) if is_tls and names else None
            if not names or is_tls and not made:
                continue
            here = pathlib.Path(folder, "tls" if is_tls else "plain")
            here.mkdir()
            daemon = Daemon(args.program, here, made, often)
            try:
                for name in names:
                    found[name] = daemon.count(asker(name, daemon))
                    tell(name)
                    if args.profile:
                        args.profile.mkdir(parents=True, exist_ok=True)
                        kept_as = re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")
                        (here / f"out.{daemon.dumps}").replace(args.profile / kept_as)
            finally:
                daemon.process.terminate()
                daemon.process.wait()
        example = pathlib.Path(args.program).with_name("examples") / "counted"
        for name in [name for name in chosen if name in LIBRARY and example.exists()]:
            found[name] = alone(example, LIBRARY[name], folder, often)
            tell(name)
    if args.write:
        rows = (f"{name:34}  {instructions:11,.0f}  {calls:6.1f}" for name, (instructions, calls) in found.items())
        head = [compiler(), f"{'request':34}  {'instructions':>11}  {'allocations'}"]
        args.kept.write_text("\n".join([*head, *rows]) + "\n")
    if args.check and compiler() != before_by:
        print(f"not compared: {args.kept.name} is of {before_by}, this is {compiler()}")
    elif args.check:
        above = [name for name, (counted, _) in found.items() if name in before and counted > TOLERANCE * before[name][0]]
        if above:
            sys.exit(f"more instructions than in {args.kept.name}: {', '.join(above)}")


if __name__ == "__main__":
    main()
