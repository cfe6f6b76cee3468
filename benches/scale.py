#!/usr/bin/env python3
"""Simulates the chunk traffic of players through layers of caches: edges of a CDN, its shield, daemons.

    benches/scale.py [--players 20000] [--minutes 10] [--seed 1]

Needs Python alone; the result is the same on every machine. Players walk at 4 m/s from towns of unequal size, see 5 x 5
chunks, and keep what they have seen. Each is near one of the edges of the CDN; an edge keeps the chunks that were
requested last, the shield those that edges requested. A daemon makes what no cache has. Chunks never change. The
figures for a second are means over the second half, when caches are warm.
"""

import argparse
import collections
import math
import random

SPEED = 4.0
STEP = 4.0
VIEW = 2
# Points in a square meter, and the bytes of a point as f32.
DENSITY = 0.25
BYTES = 8


class Recent:
    """A cache that drops what was requested longest ago."""

    def __init__(self, room):
        self.room, self.kept = room, collections.OrderedDict()

    def has(self, key):
        if key in self.kept:
            self.kept.move_to_end(key)
            return True
        self.kept[key] = None
        if len(self.kept) > self.room:
            self.kept.popitem(last=False)
        return False


def around(cx, cy):
    """The chunks that are seen from one, each as a number."""
    first = (cx - VIEW << 32) + cy - VIEW
    return [first + (i << 32) + j for i in range(2 * VIEW + 1) for j in range(2 * VIEW + 1)]


def simulate(players, side, world, edges, gigabytes, minutes, seed):
    """Requests for a chunk at the edges, the shield and the daemons, in a second."""
    rng = random.Random(seed)
    size = side * side * DENSITY * BYTES
    towns = [(rng.uniform(0, world), rng.uniform(0, world)) for _ in range(64)]
    weights = [1 / (k + 1) for k in range(64)]
    states = []
    for _ in range(players):
        x, y = rng.choices(towns, weights)[0]
        start = [rng.gauss(x, 300), rng.gauss(y, 300), rng.uniform(0, 2 * math.pi)]
        states.append([*start, set(), rng.randrange(edges), None])
    caches = [Recent(int(gigabytes * 1e9 / size)) for _ in range(edges)]
    shield = Recent(int(4 * gigabytes * 1e9 / size))
    counts = [0, 0, 0]
    steps = int(minutes * 60 / STEP)
    for step in range(steps):
        if step == steps // 2:
            counts = [0, 0, 0]
        for state in states:
            x, y, way, seen, edge, before = state
            center = math.floor(x / side), math.floor(y / side)
            # All that a player sees in a chunk was seen when the player came there.
            if center != before:
                state[5] = center
                for chunk in around(*center):
                    if chunk in seen:
                        continue
                    seen.add(chunk)
                    counts[0] += 1
                    if not caches[edge].has(chunk):
                        counts[1] += 1
                        if not shield.has(chunk):
                            counts[2] += 1
            state[2] = way + rng.gauss(0, 0.2)
            state[0] = (x + SPEED * STEP * math.cos(state[2])) % world
            state[1] = (y + SPEED * STEP * math.sin(state[2])) % world
    seconds = (steps - steps // 2) * STEP
    return [count / seconds for count in counts], size


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--players", type=int, default=20000)
    parser.add_argument("--minutes", type=float, default=10)
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    print("| players | world, km | chunk, m | edges | GB an edge | requests/s | egress to players, MB/s | "
          "hits of edges | hits of the shield | to daemons, requests/s | points made/s |")
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    usual = {"players": args.players, "world": 32, "side": 64, "edges": 8, "gigabytes": 1.0}
    others = [{}, {"players": args.players // 10}, {"world": 8}, {"world": 128}, {"side": 32}, {"side": 128},
              {"edges": 32}, {"gigabytes": 0.02}]
    for change in others:
        of = usual | change
        rates, size = simulate(of["players"], of["side"], of["world"] * 1000, of["edges"], of["gigabytes"],
                               args.minutes, args.seed)
        edge, shield, made = rates
        print(f"| {of['players']} | {of['world']} | {of['side']} | {of['edges']} | {of['gigabytes']} | {edge:.0f} | "
              f"{edge * size / 1e6:.1f} | {1 - shield / edge:.1%} | {1 - made / max(shield, 1e-9):.1%} | {made:.1f} | "
              f"{made * size / BYTES / 1e6:.2f} M |", flush=True)


main()
