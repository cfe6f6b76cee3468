"""The library, called by ctypes, has the points, documents and words of the real daemon for 1,000 random queries,
and for 200 in space.

python3 test_daemon.py LIBRARY PROGRAM
"""

from __future__ import annotations

import ctypes
import json
import math
import subprocess
import sys
import urllib.error
import urllib.request
from dataclasses import dataclass
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python/tests"))

from queries import random_query, random_query_in_space  # noqa: E402

WRONG: list[str] = [
    "{}",
    "{",
    '{"region": {}, "spacing": 1}',
    '{"region": {"bbox": [0, 0, 0, 1]}, "spacing": 1}',
    '{"region": {"bbox": [0, 0, 1e300, 1]}, "spacing": 1}',
    '{"region": {"bbox": [0, 0, 1, 1]}, "spacing": -1, "sed": 3}',
    '{"region": {"bbox": [0, 0, 1, 1]}, "spacing": 1, "profile": "blu"}',
    '{"region": {"bbox": [0, 0, 1, 1]}, "spacing": 1, "table": "' + "0" * 64 + '"}',
    '{"region": {"bbox": [0, 0, 1, 1]}, "spacing": 1, "field": {"noise": {"wavelength": -1}}}',
    '{"region": {"bbox": [0, 0, 1, 1]}, "layers": [{"name": "a", "spacing": 1}, {"name": "a", "spacing": 0}]}',
]

WRONG_IN_SPACE: list[str] = [
    "{}",
    '{"region": {"bbox": [0, 0, 1, 1]}, "spacing": 1}',
    '{"region": {"circle": {"center": [0, 0], "radius": 1}}, "spacing": 1}',
    '{"region": {"ball": {"center": [0, 0, 0], "radius": -1}}, "spacing": 1, "field": "forest"}',
    '{"region": {"bbox": [0, 0, 0, 1, 1, 1]}, "spacing": 1, "attributes": ["angle"]}',
    '{"region": {"bbox": [0, 0, 0, 1, 1, 1]}, "spacing": 1, "profile": "pink"}',
]


class Strew:
    """The calls that the test needs."""

    def __init__(self, path: str) -> None:
        self.calls = ctypes.CDLL(path)
        for name in ("strew_error_document", "strew_bytes_data"):
            getattr(self.calls, name).restype = ctypes.c_char_p
        self.calls.strew_bytes_data.restype = ctypes.c_void_p
        self.calls.strew_bytes_length.restype = ctypes.c_size_t
        self.library = ctypes.c_void_p()
        assert self.calls.strew_library_open(None, ctypes.byref(self.library)) == 0

    def error(self) -> dict[str, Any]:
        error: dict[str, Any] = json.loads(self.calls.strew_error_document())
        return error

    def plan(self, query: str, kind: Kind) -> ctypes.c_void_p | None:
        plan = ctypes.c_void_p()
        code = self.calls.strew_plan_query(self.library, len(kind.axes), query.encode(), ctypes.byref(plan))
        return plan if code == 0 else None

    def bytes(self, call: str, *arguments: Any) -> bytes:
        made = ctypes.c_void_p()
        assert getattr(self.calls, call)(*arguments, ctypes.byref(made)) == 0, self.error()
        content = ctypes.string_at(self.calls.strew_bytes_data(made), self.calls.strew_bytes_length(made))
        self.calls.strew_bytes_free(made)
        return content

    def filled(self, call: str, kind: Any, count: int, *arguments: Any) -> list[Any]:
        buffer = (kind * max(count, 1))()
        assert getattr(self.calls, call)(*arguments, buffer, ctypes.c_size_t(count)) == 0, self.error()
        return list(buffer[:count])


@dataclass(frozen=True)
class Kind:
    """The axes and the path for queries of the plane, or in space."""

    axes: str
    path: str


PLANE = Kind("xy", "/v1/points:query")
SPACE = Kind("xyz", "/v1/space/points")


def answer(url: str, query: str) -> tuple[int, bytes]:
    try:
        with urllib.request.urlopen(url, query.encode()) as response:
            return 200, response.read()
    except urllib.error.HTTPError as refused:
        return refused.code, refused.read()


def same_words(strew: Strew, content: bytes) -> None:
    problem, error = json.loads(content), strew.error()
    assert error["detail"] == problem["detail"], (error, problem)
    assert error["kind"] == problem["type"].rsplit(":")[-1]
    assert error["errors"] == problem.get("errors", [])


def same_points(strew: Strew, plan: ctypes.c_void_p, document: dict[str, Any], kind: Kind) -> None:
    rows, count, each = document["points"], len(document["points"]), len(kind.axes)
    at = strew.filled("strew_plan_fill_coordinates", ctypes.c_double, each * count, plan)
    assert at == [row[axis] for row in rows for axis in kind.axes]
    ids = strew.filled("strew_plan_fill_ids", ctypes.c_int64, each * count, plan)
    assert ids == [int(part) for row in rows for part in row["id"].split(":")]
    for column in json.loads(strew.bytes("strew_plan_columns", plan)):
        name, expected = column["name"], [row.get(column["name"]) for row in rows]
        if column["names"] is None:
            values = strew.filled("strew_plan_fill_numbers", ctypes.c_double, count, plan, name.encode())
            assert [None if math.isnan(value) else value for value in values] == expected
        else:
            codes = strew.filled("strew_plan_fill_codes", ctypes.c_int32, count, plan, name.encode())
            assert [None if code < 0 else column["names"][code] for code in codes] == expected


def compare(strew: Strew, url: str, kind: Kind, queries: list[dict[str, Any]], wrong: list[str]) -> None:
    url, points = url + kind.path, 0
    for query in map(json.dumps, queries):
        status, content = answer(url, query)
        plan = strew.plan(query, kind)
        if plan is None:
            same_words(strew, content)
            continue
        assert status == 200, content
        assert strew.bytes("strew_plan_document", plan, b"format=json") == content
        document = json.loads(content)
        same_points(strew, plan, document, kind)
        points += len(document["points"])
        strew.calls.strew_plan_free(plan)
    for query in wrong:
        status, content = answer(url, query)
        assert status == 400 or status == 409, (query, status)
        assert strew.plan(query, kind) is None, query
        same_words(strew, content)
    asked = f"{len(queries)} random queries at {kind.path}"
    print(f"{asked} with {points} points, and {len(wrong)} wrong ones, are the daemon's")


def same_neighbors(strew: Strew, url: str) -> None:
    """Single points in space are those of the daemon."""
    address = "at=1e3,-2.5,40&k=3&radius=20&spacing=1.5&seed=9&attributes=rotation"
    with urllib.request.urlopen(f"{url}/v1/space/nearest?{address}") as response:
        there = json.loads(response.read())["neighbors"]
    none = ctypes.c_void_p()
    found = strew.bytes("strew_nearest", strew.library, 3, address.encode(), none, ctypes.c_size_t(0), none)
    assert len(there) == 3 and json.loads(found) == there


def main(path: str, program: str) -> None:
    strew = Strew(path)
    command = [program, "serve", "--listen", "127.0.0.1:0"]
    daemon = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    assert daemon.stdout is not None
    url = daemon.stdout.readline().removeprefix("listening on ").strip()
    try:
        compare(strew, url, PLANE, [random_query(seed) for seed in range(1000)], WRONG)
        compare(strew, url, SPACE, [random_query_in_space(seed) for seed in range(200)], WRONG_IN_SPACE)
        same_neighbors(strew, url)
    finally:
        daemon.terminate()
        daemon.wait()


if __name__ == "__main__":
    main(*sys.argv[1:])
