#!/usr/bin/env python3
"""Measures what a connection costs a daemon: memory while it is idle, processor time of a TLS handshake.

    benches/connections.py target/release/strew [--connections 2000] [--handshakes 300]

Needs Linux, Python and openssl. Clients come from many addresses of this machine, because the daemon bounds those of one.
Handshakes are full ones of TLS 1.3 with a P-256 certificate.
"""

import argparse
import os
import pathlib
import socket
import ssl
import subprocess
import tempfile


def start(program, *settings):
    command = [program, "serve", "--listen", "127.0.0.1:0", "--set", "log.filter=error"]
    command += [word for setting in settings for word in ("--set", setting)]
    daemon = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    return daemon, int(daemon.stdout.readline().strip().rstrip("/").rsplit(":", 1)[1])


def cpu(pid):
    fields = open(f"/proc/{pid}/stat").read().rsplit(")", 1)[1].split()
    return sum(int(ticks) for ticks in fields[11:13]) / os.sysconf("SC_CLK_TCK")


def resident(pid):
    status = open(f"/proc/{pid}/status").read()
    return next(int(line.split()[1]) for line in status.splitlines() if line.startswith("VmRSS"))


def connect(port, number):
    return socket.create_connection(("127.0.0.1", port), source_address=(f"127.0.1.{1 + number % 200}", 0))


def idle(program, connections):
    daemon, port = start(program)
    try:
        def ask(stream):
            stream.sendall(b"GET /livez HTTP/1.1\r\nhost: localhost\r\n\r\n")
            stream.recv(4096)

        ask(connect(port, 0))
        before = resident(daemon.pid)
        held = [connect(port, number) for number in range(connections)]
        for stream in held:
            ask(stream)
        after = resident(daemon.pid)
        print(f"{connections} idle connections: {(after - before) / connections:.1f} kB each")
    finally:
        daemon.terminate()
        daemon.wait()


def handshakes(program, number, folder):
    key, cert = folder / "key.pem", folder / "cert.pem"
    subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "2",
                    "-subj", "/CN=localhost", "-keyout", key, "-out", cert], check=True, stderr=subprocess.DEVNULL)
    daemon, port = start(program, f"tls.certificate={cert}", f"tls.key={key}")
    try:
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
        context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
        context.wrap_socket(connect(port, 0)).close()
        before = cpu(daemon.pid)
        for k in range(number):
            context.wrap_socket(connect(port, k)).close()
        print(f"{number} handshakes: {1e3 * (cpu(daemon.pid) - before) / number:.2f} ms of the daemon's processor time each")
    finally:
        daemon.terminate()
        daemon.wait()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--connections", type=int, default=2000)
    parser.add_argument("--handshakes", type=int, default=300)
    args = parser.parse_args()
    print(f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    idle(args.program, args.connections)
    with tempfile.TemporaryDirectory() as folder:
        handshakes(args.program, args.handshakes, pathlib.Path(folder))


main()
