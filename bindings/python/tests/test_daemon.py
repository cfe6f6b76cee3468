"""The same points, the same documents and the same words as the real daemon."""

from __future__ import annotations

import json
import re
import urllib.error
import urllib.request
from typing import Any

import numpy as np
import pytest
from queries import random_query

import strew

NOISE = {"noise": {"wavelength": 9}}


def asked(url: str, path: str, body: Any = None) -> bytes:
    data = None if body is None else strew._query.text(body).encode()
    with urllib.request.urlopen(urllib.request.Request(url + path, data)) as response:
        content: bytes = response.read()
        return content


def answered(url: str, route: str) -> int:
    """How many requests for a route a daemon has answered."""
    lines = asked(url, "/metrics").decode().splitlines()
    return sum(int(line.rsplit(" ", 1)[1]) for line in lines if re.match(rf'strew_requests_total.*[/"]{route}"', line))


def same(a: Any, b: Any) -> None:
    assert a.ids.shape == np.asarray(a).shape == np.asarray(b).shape
    assert a.ids.tobytes() == b.ids.tobytes()
    assert np.asarray(a).tobytes() == np.asarray(b).tobytes()
    assert (a.origin, a.names) == (b.origin, b.names)
    for name in a.names:
        one, other = a[name], b[name]
        assert one.dtype == other.dtype and one.tobytes() == other.tobytes(), name
        if one.dtype.kind == "U":
            assert a.codes(name)[1] == b.codes(name)[1]


def of(source: Any, path: str) -> Any:
    return source.space if "space" in path else source


@pytest.mark.parametrize(("queries", "path"), [(1000, "/v1/points:query"), (200, "/v1/space/points")])
def test_random_queries_have_the_points_of_the_daemon(remote: strew.Daemon, url: str, queries: int, path: str) -> None:
    counts, refused = [], 0
    for seed in range(queries):
        query = random_query(seed, "space" in path)
        there = of(remote, path).query(query)
        try:
            here = of(strew, path).query(query)
        except strew.StrewError as error:
            # A number of points where the field leaves no place for them.
            assert (str(error), error.kind, error.faults) == refusal(there.columns)
            refused += 1
            continue
        same(here, there)
        counts.append(len(here))
        if seed % 10 == 0:
            # Over plain HTTP: every byte of the documents.
            for name in ("csv", "json", "ply", "npy", "f32"):
                assert here.document(name) == asked(url, path, {**query, "format": name}), (seed, name)
            assert there.count() == len(here)
            assert there.query == here.query
            assert there.next == here.next and there.tables == here.tables
            for a, b in zip(here.split(3), there.split(3)):
                same(a, b)
    assert refused < queries / 50 and max(counts) > 100


WRONG: list[dict[str, Any]] = [
    {},
    {"bbox": (0, 0, 1, 1)},
    {"spacing": 1, "region": {}},
    {"bbox": (0, 0, 0, 1), "spacing": 1},
    {"bbox": (0, 0, 1), "spacing": 1},
    {"bbox": "0,0,1,1", "spacing": 1},
    {"bbox": (0, 0, 1, 1), "circle": (0, 0, 1), "spacing": 1},
    {"circle": (0, 0, -1), "spacing": 1},
    {"circle": (0, 0), "spacing": 1},
    {"chunk": (64, 0.5, 0), "spacing": 1},
    {"polygon": [(0, 0)], "spacing": 1},
    {"polygon": {"type": "Point"}, "spacing": 1},
    {"bbox": (0, 0, 1e300, 1), "spacing": 1},
    {"bbox": (0, 0, 1, 1), "spacing": -1},
    {"bbox": (0, 0, 1, 1), "spacing": "wide"},
    {"bbox": (0, 0, 1, 1), "spacing": 1, "density": 1},
    {"bbox": (0, 0, 1, 1), "spacing": 1, "seed": -1},
    {"bbox": (0, 0, 1, 1), "spacing": 1, "seed": 1.5},
    {"bbox": (0, 0, 1, 1), "spacing": 1, "sed": 1},
    {"bbox": (0, 0, 1, 1), "spacing": 1, "profile": "blu"},
    {"bbox": (0, 0, 1, 1), "spacing": 1, "alpha": "7"},
    {"bbox": (0, 0, 1, 1), "spacing": 1, "map": "xl"},
    {"bbox": (0, 0, 1, 1), "spacing": 1, "table": "00"},
    {"bbox": (0, 0, 1, 1), "spacing": 1, "table": "0" * 64},
    {"bbox": (0, 0, 1, 1), "spacing": 1, "warp": 3},
    {"bbox": (0, 0, 1, 1), "spacing": 1, "keep": 0},
    {"bbox": (0, 0, 1, 1), "spacing": 1, "attributes": ["size"]},
    {"bbox": (0, 0, 1, 1), "spacing": 1, "attributes": ["variant"]},
    {"bbox": (0, 0, 1, 1), "spacing": 1, "scale_range": (2, 1), "attributes": "scale"},
    {"bbox": (0, 0, 1, 1), "spacing": 1, "field": "nowhere"},
    {"bbox": (0, 0, 1, 1), "spacing": 1, "field": {"noise": {"wavelength": -1, "octaves": 99}}},
    {"bbox": (0, 0, 1, 1), "spacing": 1, "cursor": "00"},
    {"bbox": (0, 0, 1, 1), "spacing": 1, "limit": 0},
    {"bbox": (0, 0, 1, 1), "layers": [{"name": "a", "spacing": 1}, {"name": "a", "spacing": 0}]},
    {"bbox": (0, 0, 1, 1), "layers": []},
    {"bbox": (0, 0, 1, 1), "spacing": 1, "world": "none"},
    {"circle": (0, 0, 1e7), "spacing": 1e-3},
]
WRONG_IN_SPACE: list[dict[str, Any]] = [
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
EVERY = [("/v1/points:query", query) for query in WRONG] + [("/v1/space/points", query) for query in WRONG_IN_SPACE]


def refusal(points: Any) -> tuple[str, str, list[dict[str, Any]]]:
    with pytest.raises(strew.StrewError) as raised:
        points()
    return str(raised.value), raised.value.kind, raised.value.faults


@pytest.mark.parametrize(("path", "keywords"), EVERY)
def test_wrong_queries_are_refused_with_the_same_words(
    remote: strew.Daemon, url: str, path: str, keywords: dict[str, Any]
) -> None:
    here = refusal(lambda: of(strew, path).points(**keywords).columns())
    # Limits are those of this process here, and can be raised.
    here = (here[0].partition(", or raise strew.limits")[0].replace("this process", "this server"), *here[1:])
    assert here == refusal(lambda: of(remote, path).points(**keywords).columns())
    with pytest.raises(urllib.error.HTTPError) as raised:
        asked(url, path, strew._query.body(keywords))
    problem = json.loads(raised.value.read())
    assert here == (problem["detail"], problem["type"].rsplit(":")[-1], problem.get("errors", []))


def test_too_many_points_are_refused(remote: strew.Daemon) -> None:
    query = {"bbox": (0, 0, 1e6, 1e6), "spacing": 1, "seed": 0}
    here, there = strew.points(**query), remote.points(**query)
    assert here.count() == there.count() > 10**11
    for points in (here, there):
        message, kind, _ = refusal(points.columns)
        assert kind == "too-many-points" and str(here.count()) in message


@pytest.mark.parametrize(
    ("path", "more", "at", "lost"),
    [("/v1", {"attributes": "angle"}, (0, 0), "1:1"), ("/v1/space", {"attributes": "rotation"}, (0, 0, 7), "1:0:0")],
)
def test_single_points_are_those_of_the_daemon(
    remote: strew.Daemon, path: str, more: dict[str, Any], at: Any, lost: str
) -> None:
    sources = of(strew, path), of(remote, path)
    kinds = {"attributes": "variant", "variants": {"oak": 3, "fir": 1.5}}
    for more in ({}, {**more, "keep": 0.5}, kinds, {"field": NOISE}):
        for seed in range(4):
            here, there = (source.points(spacing=1.5, seed=seed, **more) for source in sources)
            for place in (at, (1e6, -3.25, 7)[: len(at)]):
                found = here.nearest(place, k=3, radius=20)
                assert len(found) == 3 and found == there.nearest(place, k=3, radius=20)
                again = here.point(found[0].id)
                assert again == there.point(found[0].id) and again.attributes == found[0].attributes
    for source in sources:
        assert refusal(lambda: source.points(spacing=1).point("1:x"))[2][0]["field"] == "id"
        assert refusal(lambda: source.points(spacing=1).point(lost))[1] == "no-such-point"
        assert refusal(lambda: source.points(spacing=1).nearest(at, k=0))[2][0]["field"] == "k"
        assert refusal(lambda: source.points(spacing=1).nearest((0,)))[2][0]["field"] == "at"
    counted = [source.points(bbox=(0, 0, 9, 9), count=7, seed=1) for source in (strew, remote)]
    assert counted[0].nearest((4, 4)) == counted[1].nearest((4, 4))


def test_parts_and_chunks(remote: strew.Daemon) -> None:
    here, there = (source.points(bbox=(-9, -9, 20, 21), spacing=1, seed=3) for source in (strew, remote))
    same(here, there)
    for a, b in zip(here.split(4), there.split(4)):
        same(a, b)
        assert len(a) == len(b)
    same(here.chunk(16, -1, 0), there.chunk(16, -1, 0))
    for limit in (1, 500):
        same(*(source.points(bbox=(-9, -9, 20, 21), spacing=1, limit=limit, offset=9) for source in (strew, remote)))
    assert refusal(lambda: here.split(0)) == refusal(lambda: there.split(0))


def test_pictures_and_fields_of_arrays(remote: strew.Daemon) -> None:
    row = np.linspace(0, 1, 40)
    picture = np.outer(row, row)
    same(*(source.stipple(picture, 300, gamma=1.5) for source in (strew, remote)))
    for array in (picture, (picture * 255).astype(np.uint8), (picture * 65535).astype(np.uint16), picture > 0.3):
        field = strew.raster(array, bbox=(0, 0, 40, 40), edges="mirror")
        same(*(source.points(bbox=(0, 0, 60, 60), spacing=1, field=field) for source in (strew, remote)))


def test_empty_answers_have_columns_and_names(remote: strew.Daemon) -> None:
    query: Any = {"bbox": (0.1, 0.1, 0.2, 0.2), "spacing": 50, "attributes": ["angle", "variant"], "variants": {"oak": 1}}
    here, there = strew.points(**query), remote.points(**query)
    same(here, there)
    assert len(here) == 0 and here.names == ["angle", "variant"] and there.codes("variant")[1] == ["oak"]
