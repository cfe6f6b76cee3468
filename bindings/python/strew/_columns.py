"""The columns of points: those of the native part, and those that a daemon sends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ._native import is_there, native

if TYPE_CHECKING:
    from typing_extensions import TypeAlias

    from . import _strew

Array = np.ndarray[Any, Any]


#: All columns of a set, as memory that numpy looks at.
Columns: TypeAlias = "_strew.Columns | Received"


@dataclass
class Further:
    """A column beside ids and coordinates: numbers, or indices into names."""

    name: str
    is_optional: bool
    values: Array
    names: list[str] | None


class Received:
    """The columns of a daemon's answer."""

    def __init__(self, axes: int, ids: Array, at: Array, further: list[Further], origin: tuple[float, ...] | None) -> None:
        self._axes, self._ids, self._at, self._further = axes, ids, at, further
        self.origin = None if origin is None else list(origin)

    def __len__(self) -> int:
        return len(self._at)

    def ids(self) -> Array:
        return self._ids

    def at(self) -> Array:
        return self._at

    def names(self) -> list[str]:
        return [column.name for column in self._further]

    def further(self, i: int) -> tuple[Array, list[str] | None]:
        return self._further[i].values, self._further[i].names

    def arrow_stream(self, metadata: dict[str, str]) -> object:
        """An Arrow stream: by the native part, else by pyarrow."""
        if not is_there():
            return self._table(metadata).__arrow_c_stream__()
        further = [(one.name, one.is_optional, one.values.tobytes(), one.names) for one in self._further]
        made = native().Columns.received(self._axes, self._ids.tobytes(), self._at.tobytes(), further)
        stream: object = made.arrow_stream(metadata)
        return stream

    def _table(self, metadata: dict[str, str]) -> Any:
        import pyarrow as pa

        ids = pa.array([":".join(map(str, id)) for id in self._ids.tolist()], pa.string())
        arrays, fields = [ids], [pa.field("id", pa.string(), False)]
        for i, axis in enumerate("xyz"[: self._axes]):
            arrays.append(pa.array(np.ascontiguousarray(self._at[:, i])))
            fields.append(pa.field(axis, pa.float64(), False))
        for one in self._further:
            missing = np.isnan(one.values) if one.names is None else one.values < 0
            values = pa.array(one.values, mask=missing if one.is_optional else None)
            if one.names is not None:
                values = pa.DictionaryArray.from_arrays(values, pa.array(one.names, pa.string()))
            arrays.append(values)
            fields.append(pa.field(one.name, values.type, one.is_optional))
        return pa.Table.from_arrays(arrays, schema=pa.schema(fields, metadata=metadata))
