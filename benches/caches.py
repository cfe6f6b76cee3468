#!/usr/bin/env python3
"""Replays the walks of players through a world of chunks, with a cache before the daemon and without.

    benches/caches.py target/release/strew [--cache nginx] [--players 1000] [--steps 40] [--seed 1] [--connections 8]

Needs Linux, Python, and nginx (deploy/nginx/cache.conf) or Varnish (deploy/varnish/strew.vcl). A player starts near one
of a few towns, walks on with small turns, and requests each chunk that comes into view, 5 x 5 around the player, once:
clients keep what they have seen. Addresses hold the world's digest, so answers never change and nothing is purged. Both
runs replay the same requests in the same order and compare all bodies. Load is processor time, which other work on the
machine changes little.
"""

import argparse
import collections
import hashlib
import http.client
import json
import math
import os
import pathlib
import random
import socket
import subprocess
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
WORLD = "[worlds.walk]\nspacing = 2\nseed = 7\n"
SIDE = 64
VIEW = 2
HEADERS = {"Accept-Encoding": "identity"}


def walks(players, steps, seed):
    """The chunks that each step of all players requests, as (column, row), in the order in which they are requested."""
    rng = random.Random(seed)
    towns = [(rng.uniform(-8000, 8000), rng.uniform(-8000, 8000)) for _ in range(12)]
    # Few towns have most players.
    weights = [1 / (k + 1) for k in range(len(towns))]
    states = []
    for _ in range(players):
        x, y = rng.choices(towns, weights)[0]
        states.append([rng.gauss(x, 300), rng.gauss(y, 300), rng.uniform(0, 2 * math.pi), set()])
    for _ in range(steps):
        for state in states:
            x, y, way, seen = state
            cx, cy = math.floor(x / SIDE), math.floor(y / SIDE)
            around = range(-VIEW, VIEW + 1)
            for chunk in ((cx + i, cy + j) for i in around for j in around):
                if chunk not in seen:
                    seen.add(chunk)
                    yield chunk
            state[2] = way + rng.gauss(0, 0.4)
            state[0] += 32 * math.cos(state[2])
            state[1] += 32 * math.sin(state[2])


def cpu(pid):
    """Seconds of processor time of a process and its children; Varnish works in one."""
    fields = open(f"/proc/{pid}/stat").read().rsplit(")", 1)[1].split()
    own = sum(int(ticks) for ticks in fields[11:13]) / os.sysconf("SC_CLK_TCK")
    return own + sum(map(cpu, open(f"/proc/{pid}/task/{pid}/children").read().split()))


def wait_for(port):
    while True:
        try:
            return socket.create_connection(("127.0.0.1", port)).close()
        except OSError:
            time.sleep(0.02)


def nginx(folder, port, cache_port):
    """The command of nginx as a cache before a port."""
    conf = (ROOT / "deploy/nginx/cache.conf").read_text()
    conf = conf.replace("/var/cache/nginx", str(folder)).replace("strew:8080", f"127.0.0.1:{port}")
    conf = conf.replace("listen 80;", f"listen 127.0.0.1:{cache_port};")
    paths = " ".join(f"{name}_temp_path {folder}/{name};" for name in ["client_body", "proxy", "fastcgi", "uwsgi", "scgi"])
    (folder / "nginx.conf").write_text(
        f"daemon off; master_process off; pid {folder}/pid; error_log {folder}/error.log;\n"
        f"events {{ worker_connections 512; }}\nhttp {{ access_log off; keepalive_requests 1000000; {paths}\n{conf} }}\n"
    )
    return ["nginx", "-p", folder, "-c", folder / "nginx.conf"]


def varnish(folder, port, cache_port):
    """The command of Varnish as a cache before a port."""
    conf = (ROOT / "deploy/varnish/strew.vcl").read_text()
    conf = conf.replace('"strew"', '"127.0.0.1"').replace('"8080"', f'"{port}"')
    (folder / "strew.vcl").write_text(conf)
    command = ["varnishd", "-F", "-j", "none", "-n", folder / "varnish", "-a", f"127.0.0.1:{cache_port}"]
    return command + ["-f", folder / "strew.vcl", "-s", "malloc,2g", "-p", "http_gzip_support=off"]


CACHES = {"nginx": nginx, "varnish": varnish}


def start(program, cache, folder):
    """The daemon and the cache: processes and ports."""
    (folder / "strew.toml").write_text(WORLD)
    command = [program, "serve", "--listen", "127.0.0.1:0", "--config", folder / "strew.toml"]
    command += ["--set", "log.filter=error"]
    daemon = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    port = int(daemon.stdout.readline().rsplit(":", 1)[1])
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        cache_port = free.getsockname()[1]
    process = subprocess.Popen(CACHES[cache](folder, port, cache_port))
    wait_for(cache_port)
    return (daemon, port), (process, cache_port)


def replay(port, requests, path, connections):
    """Requests everything on some connections: seconds, bytes, answers by the cache's status, a digest of each body."""
    done, lock, faults = {}, threading.Lock(), []
    tally, size = collections.Counter(), collections.Counter()

    def work(mine):
        try:
            request(mine)
        except Exception as fault:
            with lock:
                faults.append(fault)

    def request(mine):
        client = http.client.HTTPConnection("127.0.0.1", port)
        known, counted, length = {}, collections.Counter(), 0
        for cx, cy in mine:
            client.request("GET", path.format(cx=cx, cy=cy), headers=HEADERS)
            answer = client.getresponse()
            body = answer.read()
            if answer.status != 200:
                raise RuntimeError(f"{answer.status} {body[:300]}")
            counted[answer.getheader("x-cache-status", "none")] += 1
            length += len(body)
            digest = hashlib.blake2b(body, digest_size=8).digest()
            if known.setdefault((cx, cy), digest) != digest:
                raise RuntimeError(f"chunk {cx},{cy} has changed")
        with lock:
            done.update(known)
            tally.update(counted)
            size["bytes"] += length

    began = time.monotonic()
    threads = [threading.Thread(target=work, args=(requests[k::connections],)) for k in range(connections)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    if faults:
        raise faults[0]
    return time.monotonic() - began, size["bytes"], tally, done


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--cache", choices=CACHES, default="nginx")
    parser.add_argument("--players", type=int, default=1000)
    parser.add_argument("--steps", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--connections", type=int, default=8)
    args = parser.parse_args()
    requests = list(walks(args.players, args.steps, args.seed))
    distinct = len(set(requests))
    print(f"{args.players} players, {args.steps} steps: {len(requests)} requests for {distinct} chunks; "
          f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    with tempfile.TemporaryDirectory() as folder:
        (daemon, port), (cache, cache_port) = start(args.program, args.cache, pathlib.Path(folder))
        try:
            client = http.client.HTTPConnection("127.0.0.1", port)
            client.request("GET", "/v1/worlds/walk")
            digest = json.loads(client.getresponse().read())["digest"]
            path = f"/v1/worlds/walk/chunks/{SIDE}/{{cx}}/{{cy}}?format=f32&world_digest={digest}"
            print(f"| | requests to the daemon | daemon, CPU s | {args.cache}, CPU s | hit ratio | points/s |\n|---|---|---|---|---|---|")
            bodies = []
            for name, to in [("daemon alone", port), ("behind the cache", cache_port), ("again, cache warm", cache_port)]:
                before = cpu(daemon.pid), cpu(cache.pid)
                seconds, size, tally, done = replay(to, requests, path, args.connections)
                spent = cpu(daemon.pid) - before[0], cpu(cache.pid) - before[1]
                hits = tally["HIT"] / len(requests)
                print(f"| {name} | {len(requests) - tally['HIT']} | {spent[0]:.2f} | {spent[1]:.2f} | {hits:.1%} | "
                      f"{size / 8 / seconds / 1e6:.2f} M |")
                bodies.append(done)
            if any(other != bodies[0] for other in bodies):
                raise SystemExit("the cache answers other bytes")
            print(f"all bodies are equal: {size / 8e6:.1f} M points, {size / 1e6:.0f} MB in each run")
        finally:
            for process in (cache, daemon):
                process.terminate()
                process.wait()


main()
