#!/usr/bin/env python3
"""Measures the processor time that a daemon takes for an answer: more telling than rates on a busy machine.

    benches/cost.py target/release/strew [OTHER ...] [--rounds N]

Needs Linux and nothing besides Python. All programs run side by side and are measured by turns, so that two
builds can be compared. The least of the rounds is printed: it has the fewest interruptions.
"""

import argparse
import os
import socket
import subprocess

# Small answers on one connection; the box of each is elsewhere.
SMALL = {
    "GET /livez": "/livez",
    "a box of a point or none": "/v1/points?bbox={x},{y},{x}.5,{y}.5&spacing=1&format=f32",
    "a box of 1,000 points": "/v1/points?bbox={x},{y},{x1}.6,{y1}.6&spacing=1&format=f32",
    "the same, warped": "/v1/points?bbox={x},{y},{x1}.6,{y1}.6&spacing=1&format=f32&seed=7",
}
SQUARE = "/v1/points?bbox=0,0,{side},{side}&spacing=1&format="
# Streams: the path and the side of the square in spacings.
STREAMS = {
    "f32": (SQUARE + "f32", 8000),
    "f32, warped": (SQUARE + "f32&seed=7", 8000),
    "csv": (SQUARE + "csv", 2000),
    "csv, 6 decimals": (SQUARE + "csv&decimals=6", 2000),
}
ANSWERS = 2000


class Daemon:
    def __init__(self, program):
        command = [program, "serve", "--listen", "127.0.0.1:0", "--set", "log.filter=error"]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        self.port = int(self.process.stdout.readline().rsplit(":", 1)[1])
        self.buffer = bytearray(1 << 20)

    def times(self):
        """Seconds in the program and in the kernel."""
        fields = open(f"/proc/{self.process.pid}/stat").read().rsplit(")", 1)[1].split()
        return [int(ticks) / os.sysconf("SC_CLK_TCK") for ticks in fields[11:13]]

    def connect(self):
        return socket.create_connection(("127.0.0.1", self.port))

    def small(self, path, first):
        """Microseconds of the program and of the kernel for an answer."""
        with self.connect() as stream:
            before = self.times()
            for number in range(first, first + ANSWERS):
                x, y = number % 997 * 40, number // 997 * 40
                asked = path.format(x=x, y=y, x1=x + 31, y1=y + 31)
                stream.sendall(f"GET {asked} HTTP/1.1\r\nhost: localhost\r\n\r\n".encode())
                self.read_answer(stream)
            return [1e6 * (b - a) / ANSWERS for a, b in zip(before, self.times())]

    def read_answer(self, stream):
        read = end = 0
        while not end or read < end:
            got = stream.recv_into(memoryview(self.buffer)[read:])
            assert got, "the daemon hung up"
            read += got
            if not end and (at := self.buffer.find(b"\r\n\r\n", 0, read)) >= 0:
                head = bytes(self.buffer[:at]).lower()
                assert head.startswith(b"http/1.1 200"), head
                length = head.split(b"content-length: ", 1)[1].split(b"\r\n")[0]
                end = at + 4 + int(length)

    def stream(self, path, side):
        """Nanoseconds a point: of the program, of the kernel for it, of the reader."""
        request = f"GET {path.format(side=side)} HTTP/1.1\r\nhost: localhost\r\nconnection: close\r\n\r\n"
        with self.connect() as stream:
            before, reader = self.times(), os.times()
            stream.sendall(request.encode())
            while stream.recv_into(self.buffer):
                pass
            after, done = self.times(), os.times()
        own = done.user + done.system - reader.user - reader.system
        seconds = [b - a for a, b in zip(before, after)] + [own]
        return [1e9 * of / side**2 for of in seconds]


def least(rounds):
    """The round with the least sum."""
    return min(rounds, key=sum)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", nargs="+")
    parser.add_argument("--rounds", type=int, default=5)
    args = parser.parse_args()
    daemons = [Daemon(program) for program in args.programs]
    try:
        print("small answers, µs: program + kernel")
        for title, path in SMALL.items():
            rounds = [[d.small(path, i * ANSWERS) for d in daemons] for i in range(args.rounds)]
            best = map(least, zip(*rounds))
            print(f"{title:26}", "".join(f"{a:8.1f} + {b:5.1f}" for a, b in best))
        print("streams, ns a point: program + kernel, reader")
        for title, (path, side) in STREAMS.items():
            rounds = [[d.stream(path, side) for d in daemons] for _ in range(args.rounds)]
            best = map(least, zip(*rounds))
            print(f"{title:26}", "".join(f"{a:8.2f} + {b:5.2f}, {c:5.2f}" for a, b, c in best))
    finally:
        for daemon in daemons:
            daemon.process.terminate()


if __name__ == "__main__":
    main()
