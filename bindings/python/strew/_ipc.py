"""Reading Arrow's IPC stream, as far as a daemon writes it: text, floats and dictionaries of text.

Needs numpy alone. The format is described in https://arrow.apache.org/docs/format/Columnar.html.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

Read = Callable[[int], bytes]
Array = np.ndarray[Any, Any]

SCHEMA, DICTIONARY, RECORDS = 1, 2, 3


class _Table:
    """A table of a flatbuffer."""

    def __init__(self, data: bytes, at: int) -> None:
        self.data, self.at = data, at

    def _unpack(self, form: str, at: int) -> Any:
        return struct.unpack_from("<" + form, self.data, at)[0]

    def _place(self, field: int) -> int | None:
        fields = self.at - self._unpack("i", self.at)
        if 4 + 2 * field >= self._unpack("H", fields):
            return None
        offset = self._unpack("H", fields + 4 + 2 * field)
        return self.at + offset if offset else None

    def number(self, field: int, form: str, default: int = 0) -> int:
        place = self._place(field)
        return default if place is None else self._unpack(form, place)

    def _target(self, field: int) -> int | None:
        place = self._place(field)
        return None if place is None else place + self._unpack("I", place)

    def table(self, field: int) -> _Table | None:
        target = self._target(field)
        return None if target is None else _Table(self.data, target)

    def text(self, field: int) -> str:
        target = self._target(field)
        if target is None:
            return ""
        length = self._unpack("I", target)
        return self.data[target + 4 : target + 4 + length].decode()

    def tables(self, field: int) -> list[_Table]:
        target = self._target(field)
        if target is None:
            return []
        places = (target + 4 + 4 * i for i in range(self._unpack("I", target)))
        return [_Table(self.data, place + self._unpack("I", place)) for place in places]

    def pairs(self, field: int) -> list[tuple[int, int]]:
        """A vector of pairs of 64-bit integers."""
        target = self._target(field)
        if target is None:
            return []
        return [struct.unpack_from("<qq", self.data, target + 4 + 16 * i) for i in range(self._unpack("I", target))]


@dataclass
class Column:
    """A column of the schema."""

    name: str
    is_optional: bool
    dictionary: int | None
    #: The names of a dictionary.
    names: list[str] | None = None


@dataclass
class Batch:
    """Some rows: ids and coordinates as pairs, in space as triples, and the values of each further column."""

    ids: Array
    at: Array
    further: list[Array]


class Stream:
    """An IPC stream that is read batch by batch."""

    def __init__(self, read: Read, axes: str = "xy") -> None:
        self._read, self._axes = read, len(axes)
        message = self._message()
        if message is None or message[0].number(1, "B") != SCHEMA:
            raise ValueError("an Arrow stream begins with a schema")
        schema = message[0].table(2)
        assert schema is not None
        columns = []
        for field in schema.tables(1):
            dictionary = field.table(4)
            number = None if dictionary is None else dictionary.number(0, "q")
            columns.append(Column(field.text(0), bool(field.number(1, "?")), number, None if number is None else []))
        first = ["id", *axes]
        if [column.name for column in columns[: len(first)]] != first:
            raise ValueError("not the columns of points")
        #: The columns beside ids and coordinates.
        self.columns = columns[len(first) :]
        #: What the stream says about itself.
        self.metadata = {pair.text(0): json.loads(pair.text(1)) for pair in schema.tables(2)}

    def _message(self) -> tuple[_Table, bytes] | None:
        start = self._read(4)
        if start == b"\xff\xff\xff\xff":
            start = self._read(4)
        (length,) = struct.unpack("<i", start)
        if length == 0:
            return None
        data = self._read(length)
        message = _Table(data, struct.unpack_from("<I", data)[0])
        return message, self._read(message.number(3, "q"))

    def __iter__(self) -> Iterator[Batch]:
        while (read := self._message()) is not None:
            message, body = read
            kind, head = message.number(1, "B"), message.table(2)
            assert head is not None
            if kind == DICTIONARY:
                self._names(head, body)
            elif kind == RECORDS:
                yield self._batch(head, body)

    def _names(self, head: _Table, body: bytes) -> None:
        data = head.table(1)
        assert data is not None
        offsets, text = _texts(data.number(0, "q"), data.pairs(2), body)
        names = [text[a:b].decode() for a, b in zip(offsets[:-1], offsets[1:])]
        for column in self.columns:
            if column.dictionary == head.number(0, "q"):
                column.names = names

    def _batch(self, head: _Table, body: bytes) -> Batch:
        rows, nodes, buffers = head.number(0, "q"), head.pairs(1), head.pairs(2)
        if head.table(3) is not None:
            raise ValueError("compressed batches are not read")
        offsets, text = _texts(rows, buffers[:3], body)
        # An id has three buffers, a number two.
        axes = [_numbers(rows, buffers[4 + 2 * axis], body, "<f8") for axis in range(self._axes)]
        first = 3 + 2 * self._axes
        further = []
        for i, column in enumerate(self.columns):
            validity, values = buffers[first + 2 * i : first + 2 + 2 * i]
            kind = "<f8" if column.names is None else "<i4"
            numbers = _numbers(rows, values, body, kind).astype(kind[1:])
            if nodes[1 + self._axes + i][1]:
                bits = np.frombuffer(body, np.uint8, -(-rows // 8), validity[0])
                is_there = np.unpackbits(bits, bitorder="little")[:rows].astype(bool)
                numbers[~is_there] = np.nan if column.names is None else -1
            further.append(numbers)
        return Batch(_ids(offsets, text, self._axes), np.column_stack(axes), further)


def _numbers(rows: int, buffer: tuple[int, int], body: bytes, kind: str) -> Array:
    return np.frombuffer(body, kind, rows, buffer[0]) if rows else np.empty(0, kind)


def _texts(rows: int, buffers: list[tuple[int, int]], body: bytes) -> tuple[Array, bytes]:
    if not rows:
        return np.zeros(1, "<i4"), b""
    _, offsets, text = buffers
    return np.frombuffer(body, "<i4", rows + 1, offsets[0]), body[text[0] : text[0] + text[1]]


def _ids(offsets: Array, text: bytes, axes: int) -> Array:
    """Texts such as ``x:y`` as rows of integers."""
    if len(offsets) == 1:
        return np.empty((0, axes), np.int64)
    letters = np.frombuffer(text, np.uint8)[: offsets[-1]]
    lines = np.insert(letters, offsets[1:], ord("\n")).tobytes().replace(b":", b"\n")
    return np.array(lines.split(), dtype=np.int64).reshape(-1, axes)
