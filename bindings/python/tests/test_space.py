"""Points in space: the same points, documents and words as the real daemon."""

from __future__ import annotations

import json
import pickle
import urllib.error
import urllib.request
from typing import Any

import numpy as np
import pytest
from queries import random_query_in_space

import strew

QUERIES = 200


def asked(url: str, body: str) -> bytes:
    with urllib.request.urlopen(f"{url}/v1/space/points", body.encode()) as response:
        content: bytes = response.read()
        return content


def same(a: strew.SpaceSet, b: strew.SpaceSet) -> None:
    assert a.xyz.shape == b.xyz.shape == (len(a), 3)
    assert a.ids.tobytes() == b.ids.tobytes()
    assert a.xyz.tobytes() == b.xyz.tobytes()
    assert (a.origin, a.names) == (b.origin, b.names)
    for name in a.names:
        one, other = a[name], b[name]
        assert one.dtype == other.dtype and one.tobytes() == other.tobytes(), name


def test_random_queries_have_the_points_of_the_daemon(remote: strew.Daemon, url: str) -> None:
    counts = []
    for seed in range(QUERIES):
        query = random_query_in_space(seed)
        here, there = strew.space.query(query), remote.space.query(query)
        same(here, there)
        counts.append(len(here))
        for name in ("json", "csv", "ply", "npy", "f32"):
            assert here.document(name) == asked(url, json.dumps({**query, "format": name})), (seed, name)
        if seed % 10 == 0:
            assert there.count() == len(here)
            assert there.query == here.query
            assert there.next == here.next and there.tables == here.tables
            for a, b in zip(here.split(3), there.split(3)):
                same(a, b)
    assert max(counts) > 100


WRONG: list[dict[str, Any]] = [
    {},
    {"bbox": (0, 0, 1, 1), "spacing": 1},
    {"bbox": (0, 0, 0, 0, 1, 1), "spacing": 1},
    {"bbox": (0, 0, 0, 1, 1, 1)},
    {"bbox": (0, 0, 0, 1, 1, 1), "ball": (0, 0, 0, 1), "spacing": 1},
    {"ball": (0, 0, 0, -1), "spacing": 1},
    {"ball": (0, 0, 1), "spacing": 1},
    {"circle": (0, 0, 1), "spacing": 1},
    {"chunk": (64, 0, 0), "spacing": 1},
    {"chunk": (64, 0.5, 0, 1), "spacing": 1},
    {"prism": ([(0, 0), (1, 1), (0, 1)], 3, 3), "spacing": 1},
    {"prism": ([(0, 0), (1, 1)], 0, 3), "spacing": 1},
    {"bbox": (0, 0, 0, 1, 1, 1), "spacing": 1, "attributes": ["angle"]},
    {"bbox": (0, 0, 0, 1, 1, 1), "spacing": 1, "field": {"ramp": {"from": [0, 0], "to": [0, 0, 9]}}},
    {"bbox": (0, 0, 0, 1, 1, 1), "count": 0},
    {"bbox": (0, 0, 0, 1, 1, 1), "spacing": 1, "profile": "pink"},
    {"bbox": (0, 0, 0, 1, 1, 1), "spacing": 1, "table": "0" * 64},
    {"bbox": (0, 0, 0, 1, 1, 1), "spacing": 1, "cursor": "00"},
    {"bbox": (0, 0, 0, 1, 1, 1), "layers": [{"name": "a", "spacing": 1}, {"name": "a", "spacing": 0}]},
]


def refusal(points: Any) -> tuple[str, str, list[dict[str, Any]]]:
    with pytest.raises(strew.StrewError) as raised:
        points()
    return str(raised.value), raised.value.kind, raised.value.faults


@pytest.mark.parametrize("keywords", WRONG, ids=lambda keywords: ",".join(keywords) or "nothing")
def test_wrong_queries_are_refused_with_the_same_words(
    remote: strew.Daemon, url: str, keywords: dict[str, Any]
) -> None:
    here = refusal(lambda: strew.space.points(**keywords).columns())
    assert here == refusal(lambda: remote.space.points(**keywords).columns())
    with pytest.raises(urllib.error.HTTPError) as raised:
        asked(url, strew._query.text(strew._query.body(keywords)))
    problem = json.loads(raised.value.read())
    assert here == (problem["detail"], problem["type"].rsplit(":")[-1], problem.get("errors", []))


def test_single_points_are_those_of_the_daemon(remote: strew.Daemon) -> None:
    for more in ({}, {"attributes": ["rotation", "variant"], "variants": {"oak": 3, "fir": 1.5}}, {"keep": 0.5}):
        for seed in range(3):
            here, there = (source.space.points(spacing=1.5, seed=seed, **more) for source in (strew, remote))
            for at in ((0, 0, 0), (1e6, -3.25, 7)):
                found = here.nearest(at, k=3, radius=20)
                assert found == there.nearest(at, k=3, radius=20)
                assert len(found) == 3
                again = here.point(found[0].id)
                assert again == there.point(found[0].id)
                assert (again.z, again.attributes) == (found[0].z, found[0].attributes)
    for source in (strew, remote):
        assert refusal(lambda: source.space.points(spacing=1).point("1:2"))[2][0]["field"] == "id"
        assert refusal(lambda: source.space.points(spacing=1).point("1:0:0"))[1] == "no-such-point"
        assert refusal(lambda: source.space.points(spacing=1).nearest((0, 0)))[2][0]["field"] == "at"


def test_a_set_has_columns_rows_and_chunks() -> None:
    stars = strew.space.points(spacing=2, seed=5, attributes="rotation, u1")
    chunk = stars.chunk(16, -3, 2, 1)
    assert chunk.origin == (-48, 32, 16) and bool((chunk.xyz >= 0).all() and (chunk.xyz < 16).all())
    whole = stars.within(bbox=(-48, 32, 16, -32, 48, 32))
    assert chunk.ids.tobytes() == whole.ids.tobytes()
    assert np.abs(np.linalg.norm([chunk[name] for name in ("qx", "qy", "qz", "qw")], axis=0) - 1).max() < 1e-12
    assert np.array_equal(chunk["z"], chunk.z) and np.array_equal(np.asarray(chunk), chunk.xyz)
    rows = list(whole)
    assert [row.z for row in rows] == whole.z.tolist()
    assert rows[3].id == ":".join(map(str, whole.ids[3])) and rows[3].attributes["u1"] == whole["u1"][3]
    assert pickle.loads(pickle.dumps(whole)) == whole
    assert whole != strew.points(spacing=2) and "in space" in repr(whole)
    with pytest.raises(TypeError, match="bbox, ball, prism, chunk"):
        stars.within(circle=(0, 0, 1))
    with pytest.raises(KeyError, match="there are id, x, y, z, qx"):
        chunk["angle"]


def test_arrow_has_the_third_coordinate() -> None:
    pyarrow = pytest.importorskip("pyarrow")
    stars = strew.space.points(ball=(0, 0, 0, 6), spacing=1, seed=2, attributes=["variant"], variants={"a": 1, "b": 1})
    table = pyarrow.table(stars)
    assert table.column_names == ["id", "x", "y", "z", "variant"]
    assert table["z"].to_pylist() == stars.z.tolist()
    assert table["id"].to_pylist() == [":".join(map(str, id)) for id in stars.ids.tolist()]
    empty = pyarrow.table(strew.space.points(bbox=(0.1, 0.1, 0.1, 0.2, 0.2, 0.2), spacing=50))
    assert empty.column_names == ["id", "x", "y", "z"] and len(empty) == 0
