"""Points as a data source of Ray: every task makes its own part, and no data is moved to it.

    import strew, strew.ray
    trees = strew.ray.read(strew.points(bbox=(0, 0, 1e5, 1e5), spacing=1, seed=7))

Needs ``ray[data]``. The blocks are Arrow tables; names are text. A task whose worker dies is made again by Ray with the
same points, bit for bit.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator
from typing import Any

import pyarrow as pa
import ray.data
from ray.data.block import BlockMetadata
from ray.data.datasource import Datasource, ReadTask

from ._points import PointSet
from ._tasks import BATCH, batches, count_of_tasks, schema, split

#: About how many bytes of Arrow a value of a column takes: the longest are ids, as text.
BYTES = 12


def _tables(part: PointSet, number: int, columns: pa.Schema, size: int) -> Iterator[pa.Table]:
    for batch in batches(part, number, columns, size):
        yield pa.Table.from_batches([batch])


class StrewDatasource(Datasource):
    """What :func:`read` passes to ``ray.data.read_datasource``."""

    def __init__(self, points: PointSet, tasks: int | None = None, batch: int = BATCH) -> None:
        super().__init__()  # type: ignore[no-untyped-call]
        self._points, self._batch = points, batch
        #: The number of tasks.
        self.tasks = count_of_tasks(points.count(), tasks)
        self._columns = schema(points)

    def estimate_inmemory_data_size(self) -> int:
        return self._bytes(self._points.count())

    def _bytes(self, count: int) -> int:
        return count * BYTES * len(self._columns)

    def get_read_tasks(
        self, parallelism: int, per_task_row_limit: int | None = None, data_context: Any = None
    ) -> list[ReadTask]:
        made = []
        for part, count in split(self._points, self.tasks):
            number = count if per_task_row_limit is None else min(count, per_task_row_limit)
            about = BlockMetadata(num_rows=number, size_bytes=self._bytes(number), input_files=None, exec_stats=None)
            make = functools.partial(_tables, part, number, self._columns, self._batch)
            made.append(ReadTask(make, about, schema=self._columns, per_task_row_limit=per_task_row_limit))
        return made


def read(points: PointSet, *, tasks: int | None = None, batch: int = BATCH, **options: Any) -> ray.data.Dataset:
    """A set of points as a ``ray.data.Dataset``.

    ``tasks`` is the number of tasks, which have equal numbers of points; by default one for each million points, up to
    10,000. What Ray proposes is for tasks of a few MiB, which take longer to begin than to run. ``batch`` is the most points in memory of a task at a time.
    ``options`` are those of ``ray.data.read_datasource``. Points of a daemon (:func:`strew.connect`) are made by it.

    Raises :class:`strew.StrewError` for a query that is not valid, and ``ValueError`` for numbers below 1.
    """
    for name, value in (("tasks", tasks), ("batch", batch)):
        if value is not None and value < 1:
            raise ValueError(f"`{name}` = `{value}`: out of range; allowed: an integer from 1")
    source = StrewDatasource(points, tasks, batch)
    # Else Ray cuts what few tasks make into the number of blocks that it proposes.
    options.setdefault("override_num_blocks", max(source.tasks, 1))
    made: ray.data.Dataset = ray.data.read_datasource(source, **options)
    return made
