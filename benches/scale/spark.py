"""What points cost in Spark: made alone, handed over as Arrow, and as rows of Spark on one and on two workers.

    cargo build --release && (cd bindings/python && CARGO_TARGET_DIR=../../target \
        cargo build --release --features pyo3/extension-module)
    cp target/release/lib_strew.so bindings/python/strew/_strew.abi3.so
    PYTHONPATH=bindings/python python3 benches/scale/spark.py [--points 1e7] [--rounds 3]

Needs pyspark 4, pyarrow and Java. Prints a table in Markdown. Times are seconds of processor time for a million
points, of all processes that take part: on a busy machine they say more than the clock. One thread a process. Rounds
take turns, and the middle one is reported.
"""

from __future__ import annotations

import argparse
import os
import resource
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

# Read by the library at its first points, here and in the workers of Spark.
os.environ["RAYON_NUM_THREADS"] = "1"

from pyspark.sql import SparkSession  # noqa: E402

import strew  # noqa: E402
from strew import _tasks  # noqa: E402
from strew.spark import StrewDataSource  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = str(Path(strew.__file__).resolve().parents[1])
TICKS = os.sysconf("SC_CLK_TCK")


def spent() -> dict[int, tuple[bool, float]]:
    """Of this process and of all below it: whether it is Java, and its processor seconds."""
    every: dict[int, tuple[int, bool, float]] = {}
    for folder in Path("/proc").iterdir():
        if folder.name.isdecimal():
            try:
                head, _, rest = (folder / "stat").read_text().rpartition(")")
            except OSError:
                continue
            fields = rest.split()
            seconds = sum(map(int, fields[11:13])) / TICKS
            every[int(folder.name)] = int(fields[1]), head.endswith("(java"), seconds

    def is_ours(pid: int) -> bool:
        while pid in every and pid != os.getpid():
            pid = every[pid][0]
        return pid == os.getpid()

    return {pid: (is_java, seconds) for pid, (_, is_java, seconds) in every.items() if is_ours(pid)}


def measured(work: Callable[[], None]) -> dict[str, float]:
    """Processor seconds of some work, and of the clock. Spark keeps its workers, so none ends meanwhile."""
    before, began = spent(), time.monotonic()
    work()
    clock, after = time.monotonic() - began, spent()
    made = [(is_java, seconds - before.get(pid, (False, 0.0))[1]) for pid, (is_java, seconds) in after.items()]
    java = sum(seconds for is_java, seconds in made if is_java)
    return {"all": sum(seconds for _, seconds in made), "java": java, "clock": clock}


def made(points: strew.PointSet) -> None:
    """The points in batches, as numbers of the library."""
    for part, count in _tasks.split(points):
        while count > 0:
            some = part._with(limit=min(count, _tasks.BATCH))
            some.columns()
            count -= _tasks.BATCH
            if count > 0:
                part = part._with(cursor=some.next, offset=None)


def handed_over(points: strew.PointSet) -> None:
    """The points as Arrow, as a task hands them over."""
    columns = _tasks.schema(points)
    for part, count in _tasks.split(points):
        for _ in _tasks.batches(part, count, columns):
            pass


def session(workers: int) -> SparkSession:
    built = SparkSession.builder.master(f"local-cluster[{workers},1,1024]").config("spark.ui.enabled", "false")
    built = built.config("spark.ui.showConsoleProgress", "false").config("spark.executorEnv.PYTHONPATH", PACKAGE)
    made = built.config("spark.executorEnv.RAYON_NUM_THREADS", "1").getOrCreate()
    made.sparkContext.setLogLevel("FATAL")
    made.dataSource.register(StrewDataSource)
    return made


def sampled(side: float) -> dict[str, float] | None:
    """The program `strew sample`, with Arrow to nowhere."""
    program = ROOT / "target/release/strew"
    if not program.exists():
        return None
    box = f"0,0,{side},{side}"
    flags = ["--bbox", box, "--spacing", "1", "--seed", "7", "--format", "arrow", "-q", "-o", "-"]
    before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    subprocess.run([program, "sample", *flags], check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return {"all": seconds, "java": 0.0, "clock": time.monotonic() - began}


def main() -> None:
    reader = argparse.ArgumentParser()
    reader.add_argument("--points", type=float, default=1e7)
    reader.add_argument("--rounds", type=int, default=3)
    given = reader.parse_args()
    side = given.points**0.5
    points = strew.points(bbox=(0, 0, side, side), spacing=1, seed=7)
    millions = len(points) / 1e6
    rows: dict[str, list[dict[str, float]]] = {}

    def note(name: str, found: dict[str, float] | None) -> None:
        if found is not None:
            print(f"{name}: {found}", file=sys.stderr, flush=True)
            rows.setdefault(name, []).append(found)

    os.environ["PYSPARK_PYTHON"] = sys.executable
    for _ in range(given.rounds):
        note("`strew sample --format arrow`", sampled(side))
        note("made, in process", measured(lambda: made(points)))
        note("made and handed over as Arrow", measured(lambda: handed_over(points)))
    for workers in (1, 2):
        spark = session(workers)
        source = spark.read.format("strew").options(bbox=f"0,0,{side},{side}", spacing=1, seed=7).load()
        own = spark.range(int(1e6 * millions)).selectExpr("cast(id as string) id", "id * 1e-3 x", "id * 2e-3 y")
        label = f"{workers} worker{'s' * (workers > 1)}"
        # The first job starts the workers.
        source.limit(10).write.format("noop").mode("overwrite").save()
        for _ in range(given.rounds):
            for name, frame in ((f"Spark, {label}", source), (f"Spark's own rows, {label}", own)):
                note(name, measured(lambda: frame.write.format("noop").mode("overwrite").save()))
        spark.stop()
    load = os.getloadavg()[0]
    print(f"{millions:.2f} million points, {given.rounds} rounds, {os.cpu_count()} cores, load {load:.1f}\n")
    print("| | s of processor per 10⁶ points | of it Java | s by the clock | 10⁶ points/s and core |")
    print("|---|---|---|---|---|")
    for name, found in rows.items():
        middle = {key: statistics.median(one[key] for one in found) / millions for key in found[0]}
        rate = 1 / middle["all"]
        print(f"| {name} | {middle['all']:.3f} | {middle['java']:.3f} | {middle['clock']:.3f} | {rate:.2f} |")


if __name__ == "__main__":
    main()
