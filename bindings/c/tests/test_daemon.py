"""The library, called by ctypes, has the points, documents and words of the real daemon for 1,000 random queries.

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
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python/tests"))

from queries import random_query  # noqa: E402

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

    def plan(self, query: str) -> ctypes.c_void_p | None:
        plan = ctypes.c_void_p()
        code = self.calls.strew_plan_query(self.library, query.encode(), ctypes.byref(plan))
        return plan if code == 0 else None

    def bytes(self, call: str, *arguments: Any) -> bytes:
        made = ctypes.c_void_p()
        assert getattr(self.calls, call)(*arguments, ctypes.byref(made)) == 0, self.error()
        content = ctypes.string_at(self.calls.strew_bytes_data(made), self.calls.strew_bytes_length(made))
        self.calls.strew_bytes_free(made)
        return content

    def filled(self, call: str, kind: Any, count: int, *arguments: Any) -> list[Any]:
        buffer = (kind * max(count, 1))()
        capacity = ctypes.c_size_t(count // 2 if call.endswith(("xy", "ids")) else count)
        assert getattr(self.calls, call)(*arguments, buffer, capacity) == 0, self.error()
        return list(buffer[:count])


def answer(url: str, query: str) -> tuple[int, bytes]:
    try:
        with urllib.request.urlopen(f"{url}/v1/points:query", query.encode()) as response:
            return 200, response.read()
    except urllib.error.HTTPError as refused:
        return refused.code, refused.read()


def same_words(strew: Strew, content: bytes) -> None:
    problem, error = json.loads(content), strew.error()
    assert error["detail"] == problem["detail"], (error, problem)
    assert error["kind"] == problem["type"].rsplit(":")[-1]
    assert error["errors"] == problem.get("errors", [])


def same_points(strew: Strew, plan: ctypes.c_void_p, document: dict[str, Any]) -> None:
    rows, count = document["points"], len(document["points"])
    xy = strew.filled("strew_plan_fill_xy", ctypes.c_double, 2 * count, plan)
    assert xy == [row[axis] for row in rows for axis in "xy"]
    ids = strew.filled("strew_plan_fill_ids", ctypes.c_int64, 2 * count, plan)
    assert ids == [int(part) for row in rows for part in row["id"].split(":")]
    for column in json.loads(strew.bytes("strew_plan_columns", plan)):
        name, expected = column["name"], [row.get(column["name"]) for row in rows]
        if column["names"] is None:
            values = strew.filled("strew_plan_fill_numbers", ctypes.c_double, count, plan, name.encode())
            assert [None if math.isnan(value) else value for value in values] == expected
        else:
            codes = strew.filled("strew_plan_fill_codes", ctypes.c_int32, count, plan, name.encode())
            assert [None if code < 0 else column["names"][code] for code in codes] == expected


def main(path: str, program: str) -> None:
    strew = Strew(path)
    command = [program, "serve", "--listen", "127.0.0.1:0"]
    daemon = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    assert daemon.stdout is not None
    url = daemon.stdout.readline().removeprefix("listening on ").strip()
    try:
        points = 0
        for seed in range(1000):
            query = json.dumps(random_query(seed))
            status, content = answer(url, query)
            plan = strew.plan(query)
            if plan is None:
                same_words(strew, content)
                continue
            assert status == 200, content
            assert strew.bytes("strew_plan_document", plan, b"format=json") == content
            document = json.loads(content)
            same_points(strew, plan, document)
            points += len(document["points"])
            strew.calls.strew_plan_free(plan)
        for query in WRONG:
            status, content = answer(url, query)
            assert status == 400 or status == 409, (query, status)
            assert strew.plan(query) is None, query
            same_words(strew, content)
        print(f"1000 random queries with {points} points, and {len(WRONG)} wrong ones, are the daemon's")
    finally:
        daemon.terminate()
        daemon.wait()


if __name__ == "__main__":
    main(*sys.argv[1:])
