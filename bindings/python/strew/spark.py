"""Points as a data source of Spark 4: every task makes its own part, and no data is moved to it.

    from strew.spark import StrewDataSource
    spark.dataSource.register(StrewDataSource)
    trees = spark.read.format("strew").options(bbox="0,0,1e5,1e5", spacing=1, seed=7).load()

The options are the keywords of :func:`strew.points`, with ``except`` for ``except_`` and values as in REST's addresses,
and:

- ``query``: a whole body of REST in JSON, such as one with layers, in place of the keywords;
- ``url``: a daemon that makes the points; without it the tasks do, each in its own process;
- ``partitions``: the number of tasks, which get equal numbers of points; by default one for each million points, up to
  10,000;
- ``batch``: the most points in memory of a task at a time, 262,144 by default;
- ``narrow``: ``on`` to narrow the box of a query by filters on ``x`` and ``y`` before it is split, so that no point
  outside is made. It needs ``spark.sql.python.filterPushdown.enabled``. Use such a DataFrame with one filter only:
  Spark 4.3.0 uses the narrowed source again for the same DataFrame without its filter, and then points are missing.
  A second ``load()`` is independent. It is ``off`` by default.

Workers run the ``python3`` of their path. In a virtual environment that is not activated they lack this package, and
report ``ModuleNotFoundError: strew``: name its Python by ``PYSPARK_PYTHON`` before the session begins, of which importing
this module warns.

A task is a query with a cursor, a few hundred bytes. One that is lost is made again with the same points, bit for bit.
Spark cannot pass the needed columns to a source written in Python: choose them by ``attributes``. A limit
stops a task after the batch that fills it.
"""

from __future__ import annotations

import json
import math
import os
import shutil
import sys
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pyarrow as pa
from pyspark.sql.datasource import (
    DataSource,
    DataSourceReader,
    EqualTo,
    Filter,
    GreaterThan,
    GreaterThanOrEqual,
    InputPartition,
    LessThan,
    LessThanOrEqual,
)
from pyspark.sql.pandas.types import from_arrow_schema
from pyspark.sql.types import StructType

from ._local import LOCAL
from ._parameters import KINDS, OUTPUT, WINDOW
from ._points import PointSet
from ._query import body
from ._remote import connect
from ._source import Source
from ._tasks import BATCH, batches, schema, split


def _warn() -> None:
    """Warns where workers on this machine would run another Python than this one."""
    others = shutil.which("python3")
    if sys.prefix == sys.base_prefix or os.environ.get("PYSPARK_PYTHON") or os.environ.get("SPARK_REMOTE"):
        return
    if others is None or Path(others).parent.resolve() != Path(sys.executable).parent.resolve():
        way_out = f"set PYSPARK_PYTHON={sys.executable} before the session begins"
        warnings.warn(f"Spark's workers run {others or 'python3'}, which may lack strew: {way_out}", stacklevel=3)


_warn()

#: What is an option and no part of a query.
OWN = ("query", "url", "partitions", "batch", "narrow", "path")
#: The members of a query by the kinds of their values.
MEMBERS = {name: kind for name, kind in KINDS.items() if name not in OUTPUT}
MEMBERS |= {"chunk": "numbers", "region": "region", "layers": "layers"}


def _number(text: str) -> float:
    try:
        return int(text)
    except ValueError:
        return float(text)


def _numbers(text: str) -> list[float]:
    return [_number(part) for part in text.split(",")]


def _names(text: str) -> list[str]:
    return [name.strip() for name in text.split(",")]


def _pairs(text: str) -> list[list[float]]:
    numbers = _numbers(text)
    return [numbers[i : i + 2] for i in range(0, len(numbers), 2)]


def _shares(text: str) -> dict[str, float]:
    shares = (part.split(":") for part in text.split(","))
    return {name: float(share) for name, share in shares}


def _ranges(text: str) -> dict[str, list[float]]:
    ranges = (part.split(":") for part in text.split(","))
    return {name: [float(low), float(high)] for name, low, high in ranges}


def _fields(text: str) -> dict[str, str]:
    return dict((name, field) for name, field in (part.split(":") for part in text.split(",")))


#: How an option is read, by the kind of its values. Others are passed on as text.
READERS: dict[str, Callable[[str], Any]] = {
    "number": _number,
    "integer": int,
    "numbers": _numbers,
    "pairs": _pairs,
    "names": _names,
    "weights": _shares,
    "ranges": _ranges,
    "fields": _fields,
}


def _read(name: str, text: str) -> Any:
    if text.lstrip().startswith(("{", "[")):
        return json.loads(text)
    try:
        return READERS.get(MEMBERS[name], str)(text)
    except ValueError:
        # It is passed on as it is, to be refused in the words of REST.
        return text


def _positive(options: Mapping[str, str], name: str, default: int) -> int:
    text = options.get(name, str(default))
    if not text.isdecimal() or int(text) == 0:
        raise ValueError(f"`{name}` = `{text}`: not a whole number from 1; allowed: a whole number from 1")
    return int(text)


def points(options: Mapping[str, str]) -> PointSet:
    """The set of points that options describe."""
    for name in options:
        if name not in MEMBERS and name not in OWN:
            allowed = ", ".join(sorted([*MEMBERS, *OWN]))
            raise ValueError(f"`{name}` = `{options[name]}`: unknown; allowed: {allowed}")
    source: Source = connect(options["url"]) if "url" in options else LOCAL
    keywords = {name: _read(name, text) for name, text in options.items() if name not in OWN}
    if "query" not in options:
        return source.query(body(keywords))
    if keywords:
        raise ValueError(f"`{next(iter(keywords))}`: not beside `query`; allowed: a member of `query`")
    return source.query(json.loads(options["query"]))


@dataclass
class Part(InputPartition):
    """The points of a task."""

    points: PointSet
    number: int


class StrewReader(DataSourceReader):
    """Splits a query into tasks, and makes the points of one."""

    def __init__(self, options: Mapping[str, str], schema: pa.Schema) -> None:
        self.points = points(options)
        self.schema = schema
        self.tasks = _positive(options, "partitions", 0) if "partitions" in options else None
        self.batch = _positive(options, "batch", BATCH)
        #: Whether filters leave nothing.
        self.is_empty = False

    def partitions(self) -> list[Part]:  # type: ignore[override]
        # Spark wants one task, even of no points.
        parts = [(self.points, 0)] if self.is_empty else split(self.points, self.tasks)
        return [Part(part, count) for part, count in parts]

    def read(self, partition: Part) -> Iterator[pa.RecordBatch]:  # type: ignore[override]
        return batches(partition.points, partition.number, self.schema, self.batch)


class NarrowedReader(StrewReader):
    """Makes only the points of the box that filters leave. Spark filters them, too: filters may include an edge."""

    def pushFilters(self, filters: list[Filter]) -> Iterable[Filter]:
        """Narrows the box. Spark filters the points, too, because boxes have no upper edge and filters may."""
        if not self._is_box():
            return filters
        body = self.points.body
        low, high = list(map(float, body["region"]["bbox"][:2])), list(map(float, body["region"]["bbox"][2:]))
        for one in filters:
            axis = {("x",): 0, ("y",): 1}.get(getattr(one, "attribute", ()))
            if axis is None or not isinstance(getattr(one, "value", None), (int, float)):
                continue
            value = float(one.value)  # type: ignore[attr-defined]
            if isinstance(one, (GreaterThan, GreaterThanOrEqual, EqualTo)):
                low[axis] = max(low[axis], value)
            if isinstance(one, (LessThan, LessThanOrEqual, EqualTo)):
                high[axis] = min(high[axis], math.nextafter(value, math.inf))
        if low + high == [*map(float, body["region"]["bbox"])]:
            return filters
        self.is_empty = any(low[axis] >= high[axis] for axis in (0, 1))
        if self.is_empty:
            return filters
        if "count" in body:
            # The set of the whole box, not `count` points in the smaller box.
            self.points = self.points._with(count=None, spacing=self.points.query["spacing"])
        self.points = self.points.within(bbox=[*low, *high])
        return filters

    def _is_box(self) -> bool:
        body = self.points.body
        windows = any(name in body for name in WINDOW)
        return set(body.get("region", {})) == {"bbox"} and len(body["region"]["bbox"]) == 4 and not windows


NARROW: dict[str, type[StrewReader]] = {"off": StrewReader, "on": NarrowedReader}


class StrewDataSource(DataSource):
    """``spark.read.format("strew")``."""

    @classmethod
    def name(cls) -> str:
        return "strew"

    def _arrow(self) -> pa.Schema:
        return schema(points(self.options))

    def schema(self) -> StructType:
        return from_arrow_schema(self._arrow())

    def reader(self, schema: StructType) -> StrewReader:
        way = self.options.get("narrow", "off")
        if way not in NARROW:
            raise ValueError(f"`narrow` = `{way}`: unknown; allowed: {', '.join(NARROW)}")
        return NARROW[way](self.options, self._arrow())
