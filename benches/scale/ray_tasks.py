#!/usr/bin/env python3
"""How long Ray takes to write points as Parquet, by the number of tasks: `PYTHONPATH=bindings/python benches/scale/ray_tasks.py`.

Needs `ray[data]`, pyarrow and a release build of the package. Prints the seconds by the clock, the files and the load.
"""

import argparse
import os
import tempfile
import time
from pathlib import Path

import ray
import strew
import strew.ray

parser = argparse.ArgumentParser()
parser.add_argument("--side", type=float, default=2000, help="the side of the box, of spacing 1")
parser.add_argument("--tasks", default="0,137", help="numbers of tasks; 0 is the default")
options = parser.parse_args()
ray.init(num_cpus=2, include_dashboard=False, logging_level="ERROR", object_store_memory=800 << 20)
ray.data.DataContext.get_current().enable_progress_bars = False
points = strew.points(bbox=(0, 0, options.side, options.side), spacing=1, seed=7)
print(f"{len(points)} points")
for tasks in map(int, options.tasks.split(",")):
    with tempfile.TemporaryDirectory() as folder:
        start = time.perf_counter()
        strew.ray.read(points, tasks=tasks or None).write_parquet(folder)
        taken, files = time.perf_counter() - start, len(list(Path(folder).glob("*.parquet")))
        print(f"{tasks or 'default'} tasks: {taken:.1f} s, {files} files, load {os.getloadavg()[0]:.1f}")
ray.shutdown()
