"""A set of points as tasks of an engine for large data: equal parts, each made by itself and handed over as Arrow.

A task is a query with a cursor, a few hundred bytes. One that is lost is made again with the same points, bit for bit.
Needs pyarrow.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pyarrow as pa

from ._points import PointSet

#: How many points a task has by default, and the most tasks: the engine lists each with its cursor.
TASK, MOST_TASKS = 1_000_000, 10_000
#: The most points in memory of a task at a time.
BATCH = 1 << 18


def schema(points: PointSet) -> pa.Schema:
    """The columns of a set, with names as text: the dictionaries of tasks would be merged again and again."""
    columns = (
        pa.field(column.name, pa.string() if pa.types.is_dictionary(column.type) else column.type, column.nullable)
        for column in pa.table(points._with(limit=1)).schema
    )
    return pa.schema(list(columns))


def count_of_tasks(count: int, tasks: int | None = None) -> int:
    """The number of tasks for a number of points."""
    return min(tasks or min(-(-count // TASK), MOST_TASKS), count)


def split(points: PointSet, tasks: int | None = None) -> list[tuple[PointSet, int]]:
    """The parts of a set with their numbers of points; by default one for each million points."""
    count = points.count()
    tasks = count_of_tasks(count, tasks)
    if tasks <= 1:
        return [(points, count)]
    return [(part, part.body["limit"]) for part in points.split(tasks)]


def batches(part: PointSet, number: int, columns: pa.Schema, size: int = BATCH) -> Iterator[Any]:
    """The first ``number`` points of a part as record batches, of which one at a time is in memory."""
    while number > 0:
        some = part._with(limit=min(number, size))
        yield from pa.table(some).cast(columns).to_batches()
        number -= size
        if number > 0:
            part = part._with(cursor=some.next, offset=None)
