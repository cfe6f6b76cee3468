"""The data source of Spark, on a cluster of two workers with a core each. Skipped without pyspark."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from conftest import assert_equal

import strew

pyspark = pytest.importorskip("pyspark", reason="pyspark is not installed")
pa = pytest.importorskip("pyarrow")

from pyspark.errors import PySparkException  # noqa: E402
from pyspark.sql import SparkSession  # noqa: E402

from strew._tasks import MOST_TASKS  # noqa: E402
from strew.spark import StrewDataSource, StrewReader, _warn, points  # noqa: E402

WOODS: dict[str, Any] = {"bbox": "0,0,300,200", "spacing": 1, "seed": 7, "attributes": "angle,variant", "variants": "oak:3,birch:1"}


@pytest.fixture(scope="module")
def spark() -> Iterator[SparkSession]:
    os.environ["PYSPARK_PYTHON"] = sys.executable
    package = str(Path(strew.__file__).resolve().parents[1])
    session = (
        SparkSession.builder.master("local-cluster[2,1,1024]")
        .config("spark.ui.enabled", "false")
        .config("spark.ui.showConsoleProgress", "false")
        .config("spark.executorEnv.PYTHONPATH", package)
        .config("spark.sql.python.filterPushdown.enabled", "true")
        .getOrCreate()
    )
    session.sparkContext.setLogLevel("FATAL")
    session.dataSource.register(StrewDataSource)
    yield session
    session.stop()


def load(spark: SparkSession, **options: Any) -> Any:
    return spark.read.format("strew").options(**options).load()


def assert_same(frame: Any, points: strew.PointSet) -> None:
    assert_equal(frame.toArrow(), points)


def woods() -> strew.PointSet:
    return strew.points(
        bbox=(0, 0, 300, 200), spacing=1, seed=7, attributes=["angle", "variant"], variants={"oak": 3, "birch": 1}
    )


def test_all_tasks_together_have_the_set(spark: SparkSession) -> None:
    frame = load(spark, **WOODS, partitions=7, batch=1000)
    assert frame.rdd.getNumPartitions() == 7
    assert_same(frame, woods())


def test_fields_and_layers(spark: SparkSession) -> None:
    ramp = {"ramp": {"from": [0, 0], "to": [200, 0], "shares": [1, 0.1]}}
    query = {
        "region": {"circle": {"center": [90, 80], "radius": 70}},
        "layers": [
            {"name": "trees", "spacing": 2, "seed": 3, "field": ramp, "attributes": ["angle"]},
            {"name": "rocks", "spacing": 4, "seed": 9, "clear_of": {"trees": 1}},
        ],
    }
    assert_same(load(spark, query=json.dumps(query), partitions=5), strew.query(query))


def test_options_are_members_of_the_body() -> None:
    options = {
        "bbox": "0,0,9,9",
        "spacing": "1",
        "terrain": '{"ramp": {"from": [0, 0], "to": [9, 0]}}',
        "heights": "400,2600.5",
        "normals": "on",
        "align": "0.5",
        "except": "2:-1, 8:-1",
    }
    members = {
        "region": {"bbox": [0, 0, 9, 9]},
        "spacing": 1,
        "terrain": {"ramp": {"from": [0, 0], "to": [9, 0]}},
        "heights": [400, 2600.5],
        "normals": "on",
        "align": 0.5,
        "except": ["2:-1", "8:-1"],
    }
    # With a daemon, which is not called, names of its worlds are no errors.
    daemon = {"url": "http://127.0.0.1:1"}
    assert points({**options, **daemon}).body == members
    period = points({"periodic": "5000", "map": "s", "spacing": "1", **daemon})
    assert period.body == {"periodic": 5000, "map": "s", "spacing": 1}
    world = {"world": "forest", "world_digest": "31936fdd"}
    assert points({**world, **daemon}).body == world
    assert len(points(options).plan().columns().names()) == 8


def test_a_period_and_what_is_left_out(spark: SparkSession) -> None:
    whole = strew.query({"periodic": 5000, "map": "s", "spacing": 1})
    assert_same(load(spark, periodic=5000, map="s", spacing=1, partitions=3), whole)
    first = ":".join(map(str, whole.ids[0]))
    left = load(spark, bbox="0,0,71,71", map="s", spacing=1, **{"except": first})
    assert left.where(f"id = '{first}'").count() == 0


def test_the_default_number_of_tasks_is_limited() -> None:
    schema = pa.schema([])
    many = StrewReader({"bbox": "0,0,2e5,2e5", "spacing": "1"}, schema)
    assert abs(len(many.partitions()) - MOST_TASKS) <= 1
    few = StrewReader({"bbox": "0,0,2e3,1.2e3", "spacing": "1"}, schema)
    assert len(few.partitions()) == 3


def test_an_empty_region(spark: SparkSession) -> None:
    assert load(spark, bbox="0,0,0.001,0.001", spacing=1).count() == 0


def test_a_box_is_narrowed(spark: SparkSession) -> None:
    whole = woods()
    x, y = whole.xy.T
    frame = load(spark, **WOODS, narrow="on", partitions=2).where("x >= 100 and x < 110.5 and y > 20 and y <= 40")
    assert frame.count() == int(((x >= 100) & (x < 110.5) & (y > 20) & (y <= 40)).sum()) > 0
    plain = load(spark, **WOODS, partitions=2)
    assert plain.where("x < 50").count() == int((x < 50).sum())
    assert plain.count() == len(whole)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"spacing": "-1"}, "`spacing` = `-1`: out of range"),
        ({"spacing": "wide"}, "`spacing`"),
        ({"spacing": "1", "sed": "7"}, "`sed` = `7`: unknown; allowed: align"),
        ({"spacing": "1", "partitions": "0"}, "`partitions` = `0`: not a whole number from 1"),
        ({"spacing": "1", "narrow": "yes"}, "`narrow` = `yes`: unknown; allowed: off, on"),
        ({"query": "{}", "spacing": "1"}, ": not beside `query`"),
    ],
)
def test_wrong_options_are_refused_by_name(spark: SparkSession, options: dict[str, str], words: str) -> None:
    with pytest.raises(PySparkException) as refusal:
        load(spark, bbox="0,0,9,9", **options).count()
    assert words in str(refusal.value)


def executors() -> list[int]:
    """The processes of this test's executors."""
    listed = subprocess.run(["pgrep", "-f", "CoarseGrainedExecutorBackend"], capture_output=True, text=True, check=False)
    return [int(line) for line in listed.stdout.split()]


def until(holds: Callable[[], bool], what: str, seconds: float = 300) -> None:
    waited = threading.Event()
    for _ in range(int(seconds / 0.05)):
        if holds():
            return
        waited.wait(0.05)
    raise AssertionError(f"waited in vain until {what}")


def test_a_killed_executor_loses_and_doubles_nothing(spark: SparkSession) -> None:
    context = spark.sparkContext
    frame = load(spark, bbox="0,0,2000,1500", spacing=1, seed=5, partitions=40)
    results: list[Any] = []
    job = threading.Thread(target=lambda: results.append(frame.toArrow()))
    tracker = context.statusTracker()

    def done() -> int:
        stages = (tracker.getStageInfo(stage) for stage in tracker.getActiveStageIds())
        return max((info.numCompletedTasks for info in stages if info), default=0)

    job.start()
    until(lambda: done() >= 4, "some tasks are done")
    before = executors()
    assert len(before) >= 2
    os.kill(before[0], signal.SIGKILL)
    job.join(600)
    assert len(results) == 1
    # Another one took its place, or its tasks went to the other.
    assert before[0] not in executors()
    found = results[0].sort_by("id")
    points = strew.points(bbox=(0, 0, 2000, 1500), spacing=1, seed=5)
    wanted = pa.table(points).cast(found.schema).replace_schema_metadata(None).sort_by("id")
    assert found.replace_schema_metadata(None).equals(wanted)


def test_another_python_of_workers_is_warned_of(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "base_prefix", "/elsewhere")
    monkeypatch.setenv("PATH", "")
    monkeypatch.delenv("PYSPARK_PYTHON", raising=False)
    with pytest.warns(UserWarning, match=f"set PYSPARK_PYTHON={sys.executable}"):
        _warn()
    monkeypatch.setenv("PYSPARK_PYTHON", sys.executable)
    _warn()
