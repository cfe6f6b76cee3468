"""Points that are made in this process."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._native import native
from ._query import PLANE, SPACE, Body, Dimension, text
from ._source import Plan, Source

if TYPE_CHECKING:
    from . import _strew


class _Planned:
    def __init__(self, plan: _strew.Plan) -> None:
        self._plan = plan

    def count(self) -> int:
        return self._plan.count()

    def query(self) -> dict[str, Any]:
        query: dict[str, Any] = json.loads(self._plan.query())
        return query

    def tables(self) -> list[str]:
        return self._plan.tables()

    def next(self) -> str | None:
        return self._plan.next()

    def columns(self) -> _strew.Columns:
        return self._plan.columns()

    def coordinates(self) -> np.ndarray[Any, np.dtype[np.float64]]:
        return np.asarray(self._plan.coordinates())

    def split(self, parts: int) -> list[tuple[str, int]]:
        return self._plan.split(str(parts))

    def document(self, options: Sequence[tuple[str, str]]) -> bytes:
        return self._plan.document(list(options))


class Local(Source):
    """This process."""

    checks_at_once = True

    def plan(self, query: Body, dimension: Dimension = PLANE) -> Plan:
        return _Planned(native().plan(text(query), dimension is SPACE))

    def point(self, id: str, address: str, dimension: Dimension = PLANE) -> dict[str, Any]:
        point: dict[str, Any] = json.loads(native().point(id, address, dimension is SPACE))
        return point

    def nearest(self, address: str, dimension: Dimension = PLANE) -> list[dict[str, Any]]:
        neighbors: list[dict[str, Any]] = json.loads(native().nearest(address, dimension is SPACE))
        return neighbors

    def hold_field(self, field: Any) -> str:
        return str(native().hold_field(text(field)))

    def __repr__(self) -> str:
        return "strew"

    def __reduce__(self) -> str:
        return "LOCAL"


LOCAL = Local()
