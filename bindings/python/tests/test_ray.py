"""The data source of Ray, on two local workers, of which some are killed, and Dask. Skipped where these are missing."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from conftest import assert_equal

import strew

pa = pytest.importorskip("pyarrow")

QUERY: dict[str, Any] = {
    "bbox": (0, 0, 300, 200),
    "spacing": 1,
    "seed": 7,
    "attributes": ["angle", "variant"],
    "variants": {"oak": 3, "birch": 1},
}
PACKAGE = str(Path(strew.__file__).resolve().parents[1])


@pytest.fixture(scope="module")
def source() -> Iterator[Any]:
    ray = pytest.importorskip("ray", reason="ray is not installed")
    os.environ["PYTHONPATH"] = PACKAGE
    ray.init(num_cpus=2, include_dashboard=False, logging_level="ERROR", object_store_memory=400 << 20)
    import strew.ray

    ray.data.DataContext.get_current().enable_progress_bars = False
    yield strew.ray
    ray.shutdown()


def table(dataset: Any) -> Any:
    import ray

    tables = ray.get(dataset.to_arrow_refs())
    return pa.concat_tables([one for one in tables if one.num_rows] or tables)


def test_the_union_of_the_tasks_is_the_set(source: Any) -> None:
    layers = [{"name": "trees", "spacing": 3, "seed": 1}, {"name": "bushes", "spacing": 2, "clear_of": {"trees": 1}}]
    field = {"noise": {"wavelength": 40}}
    for points in (
        strew.points(**QUERY),
        strew.points(**QUERY, field=field),
        strew.query({"region": {"bbox": [0, 0, 200, 200]}, "layers": layers}),
        strew.points(**QUERY, offset=100, limit=5000),
    ):
        assert_equal(table(source.read(points, tasks=7, batch=3000)), points)


def test_empty_sets_limits_and_wrong_numbers(source: Any) -> None:
    points = strew.points(**QUERY)
    assert source.read(points.within(bbox=(0, 0, 1e-3, 1e-3))).count() == 0
    assert source.read(points, tasks=5).limit(10).count() == 10
    assert source.read(points).count() == len(points)
    for wrong in ({"tasks": 0}, {"batch": -1}):
        with pytest.raises(ValueError, match="out of range; allowed: an integer from 1"):
            source.read(points, **wrong)
    with pytest.raises(strew.StrewError, match="spacing"):
        source.read(strew.points(spacing=-1))


def test_a_task_has_a_million_points(source: Any) -> None:
    points = strew.points(bbox=(0, 0, 1700, 1700), spacing=1, seed=7)
    for tasks, expected in ((None, 3), (5, 5)):
        made = source.StrewDatasource(points, tasks).get_read_tasks(200)
        assert len(made) == expected
        blocks = source.read(points, tasks=tasks).materialize().num_blocks()
        assert blocks <= -(-len(points) // (1 << 18)) + expected
        assert sum(task.metadata.num_rows for task in made) == len(points)


def readers() -> list[int]:
    """The workers below this process that read."""
    listed = subprocess.run(["ps", "-eo", "pid=,ppid=,args="], capture_output=True, text=True, check=True)
    rows = [line.split(None, 2) for line in listed.stdout.splitlines()]
    parents = {int(pid): int(parent) for pid, parent, _ in rows}

    def is_ours(pid: int) -> bool:
        while pid in parents and pid != os.getpid():
            pid = parents[pid]
        return pid == os.getpid()

    return [int(pid) for pid, _, args in rows if args.startswith("ray::Read") and is_ours(int(pid))]


def test_a_killed_worker_loses_and_doubles_nothing(source: Any) -> None:
    points = strew.points(bbox=(0, 0, 2000, 1500), spacing=1, seed=5, attributes=["angle"])
    results: list[Any] = []
    job = threading.Thread(target=lambda: results.append(table(source.read(points, tasks=24))))
    job.start()
    waited = threading.Event()
    killed: list[int] = []
    while job.is_alive() and len(killed) < 2:
        for pid in readers()[:1]:
            if pid not in killed:
                os.kill(pid, signal.SIGKILL)
                killed.append(pid)
        waited.wait(0.2)
    job.join(300)
    assert killed and len(results) == 1
    assert_equal(results[0], points)


def test_dask_as_the_readme_shows_it() -> None:
    pytest.importorskip("dask.dataframe", reason="dask is not installed")
    pytest.importorskip("pandas")
    text = (Path(PACKAGE) / "README.md").read_text()
    _, section = text.split("## Ray and Dask")
    code = [block for block in re.findall(r"```python\n(.*?)```", section, re.S) if "from_map" in block][0]
    names: dict[str, Any] = {}
    exec(code, names)
    found = names["frame"].compute()
    wanted = pa.table(names["trees"]).to_pandas()
    assert len(found) == len(wanted) > 1000
    for name in ("id", "x", "y", "angle"):
        assert found[name].tolist() == wanted[name].tolist()
