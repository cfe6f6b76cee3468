"""Time and quality of about 10,000 points in the unit square: strew, scipy's PoissonDisk, and Bridson's algorithm.

    python examples/compare.py [--points 10000]

scipy is left out where it is not installed. (fast_poisson is a crate of Rust and not on PyPI; the benches of
`crates/core` compare with it.) Low power is the mean radial power below half of the square root of the density: 1 for
white noise, 0 for a set without large-scale fluctuations.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from typing import Any

import numpy as np

import strew

Points = np.ndarray[Any, np.dtype[np.float64]]


def bridson(radius: float, rng: np.random.Generator, tries: int = 30) -> Points:
    """Bridson's algorithm (2007) in plain Python over a grid, for the unit square."""
    size = int(np.ceil(np.sqrt(2) / radius))
    grid = -np.ones((size, size), dtype=int)
    points = [rng.random(2)]
    active = [0]
    grid[tuple((points[0] * size).astype(int))] = 0
    while active:
        place = int(rng.integers(len(active)))
        center = points[active[place]]
        for _ in range(tries):
            distance, angle = radius * (1 + rng.random()), 2 * np.pi * rng.random()
            point = center + distance * np.array([np.cos(angle), np.sin(angle)])
            if not ((point >= 0) & (point < 1)).all():
                continue
            x, y = (point * size).astype(int)
            near = grid[max(x - 2, 0) : x + 3, max(y - 2, 0) : y + 3]
            if all(((points[i] - point) ** 2).sum() >= radius**2 for i in near[near >= 0]):
                grid[x, y] = len(points)
                active.append(len(points))
                points.append(point)
                break
        else:
            active.pop(place)
    return np.array(points)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--points", type=int, default=10_000)
    count = parser.parse_args().points
    # A maximal set of disks of this radius has about this number of points.
    radius = float(np.sqrt(0.7 / count))
    ways: dict[str, Callable[[], Points]] = {
        "strew": lambda: strew.points(bbox=(0, 0, 1, 1), spacing=count**-0.5, seed=1).xy,
        "Bridson, in Python": lambda: bridson(radius, np.random.default_rng(1)),
        "white noise": lambda: np.random.default_rng(1).random((count, 2)),
    }
    try:
        from scipy.stats import qmc

        ways["scipy PoissonDisk"] = lambda: qmc.PoissonDisk(2, radius=radius, seed=1).fill_space()
    except ImportError:
        print("scipy is not installed")
    ways["strew"]()
    print(f"{'':20} {'points':>7} {'seconds':>9} {'low power':>10} {'least distance':>15}")
    for name, make in ways.items():
        began = time.perf_counter()
        points = make()
        seconds = time.perf_counter() - began
        inside = points[((points >= 0) & (points < 1)).all(axis=1)]
        figures = strew.measure(inside, bbox=(0, 0, 1, 1)).figures
        print(f"{name:20} {len(points):7} {seconds:9.4f} {figures['low_power']:10.1e} {figures['delta_min']:15.3f}")


if __name__ == "__main__":
    main()
