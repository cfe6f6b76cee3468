"""What the package says about itself and about wrong values, and rows, ids and masks."""

from __future__ import annotations

import inspect
import math
import pickle
import traceback
from decimal import Decimal
from typing import Any, get_args

import numpy as np
import pytest

import strew
from strew._parameters import Attribute, Parameters
from strew._query import SpaceQuery


def test_signatures_and_docstrings_list_every_keyword() -> None:
    daemon = strew.connect("http://127.0.0.1:9")
    for function, query in (
        (strew.points, strew.Query),
        (daemon.points, strew.Query),
        (strew.space.points, SpaceQuery),
    ):
        signature = inspect.signature(function)
        assert list(signature.parameters) == list(query.__annotations__)
        assert all(one.kind is one.KEYWORD_ONLY and one.default is None for one in signature.parameters.values())
        doc = inspect.getdoc(function) or ""
        for name in signature.parameters:
            assert f"\n{name} : " in doc, name
    doc = inspect.getdoc(strew.points) or ""
    assert set(Parameters.__annotations__) <= set(inspect.signature(strew.points).parameters)
    assert "spacing : float\n    The mean spacing in world units" in doc and "Default: 0." in doc
    assert "periodic" in inspect.signature(strew.points).parameters


@pytest.mark.parametrize(
    ("keywords", "words"),
    [
        ({"spacing": math.nan}, "`spacing` = `nan`: not finite; allowed: finite numbers"),
        ({"region": {"bbox": (0, 0, math.inf, 9)}}, "`region`.*not finite"),
        ({"attributes": {"angle"}}, r"`attributes` = `{'angle'}`: a query cannot hold a set; allowed: what JSON has"),
        ({"field": np.ones((4, 4))}, r"`field`.*allowed: strew.raster\(array"),
        ({"variant_fields": {"oak": np.ones((4, 4))}}, r"`variant_fields`.*allowed: strew.raster\(array"),
        ({"seed": np.random.default_rng(1)}, r"`seed`.*int\(generator.integers\(2\*\*63\)\)"),
        ({"polygon": [0, 0, 4, 0, 0]}, "`polygon` = .*not vertices; allowed: pairs of numbers"),
    ],
)
def test_wrong_values_are_refused_by_name(keywords: Any, words: str) -> None:
    region = {} if "polygon" in keywords or "region" in keywords else {"bbox": (0, 0, 9, 9)}
    with pytest.raises(strew.StrewError, match=words) as raised:
        strew.points(**{**region, "spacing": 1, **keywords}).count()
    assert raised.value.kind == "invalid-query" and raised.value.faults[0]["field"] == next(iter(keywords))


def test_more_forms_of_values_are_taken() -> None:
    plain = strew.points(polygon=[(0, 0), (4, 0), (0, 4)], spacing=0.5)
    assert strew.points(polygon=[0, 0, 4, 0, 0, 4], spacing=Decimal("0.5")).ids.tolist() == plain.ids.tolist()
    assert strew.points(bbox=range(4), spacing=1).count() == strew.points(bbox=(0, 1, 2, 3), spacing=1).count()
    with pytest.raises(strew.StrewError, match="`query` = `None`"):
        strew.query(None)  # type: ignore[arg-type]


def test_errors_are_named_as_they_are_imported() -> None:
    with pytest.raises(strew.StrewError) as raised:
        strew.points(bbox=(0, 0, 1, 1), spacing=-1)
    assert traceback.format_exception_only(raised.type, raised.value)[0].startswith("strew.StrewError: `spacing`")
    with pytest.raises(strew.StrewError, match="this process returns at most"):
        strew.points(bbox=(0, 0, 1e6, 1e6), spacing=1).columns()


@pytest.mark.parametrize("query", [{"map": "r77"}, {"alpha": "sqrt(3)", "map": "l"}, {"except_": "0" * 64}])
def test_errors_give_no_advice_for_other_programs(query: Any) -> None:
    with pytest.raises(strew.StrewError) as raised:
        strew.points(bbox=(0, 0, 9, 9), spacing=1, **query)
    told = f"{raised.value} {raised.value.faults}"
    assert not any(words in told for words in ("strew forge", "tables.folder", "server", "/v1/"))


def test_types_name_the_attributes_that_there_are() -> None:
    names: Any = get_args(Attribute)
    points = strew.points(bbox=(0, 0, 9, 9), spacing=1, attributes=names, variants={"oak": 1})
    assert sorted(points.names) == sorted(names) and len(names) == 20


def test_rows_by_number(remote: strew.Daemon) -> None:
    for source in (strew, remote):
        points = source.points(bbox=(0, 0, 20, 20), spacing=1, seed=3, attributes=["angle"])
        listed = list(points)
        assert points[0] == listed[0] and points[-1] == listed[-1] and points[np.int64(7)] == listed[7]
        assert list(points[5:9]) == listed[5:9] and list(points[5:][1:3]) == listed[6:8]
        assert points["id"].tolist() == [point.id for point in listed]
        with pytest.raises(IndexError, match="row 1000 of"):
            points[1000]
        for wrong in (slice(3, 3), slice(None, None, 2)):
            with pytest.raises(strew.StrewError, match="slice"):
                points[wrong]
        for id in (points.ids[3], points.ids[3].tolist(), points["id"][3]):
            assert points.point(id).x == points.x[3]
        with pytest.raises(LookupError) as raised:
            points.point("1:1000003")
        assert isinstance(raised.value, strew.NoSuchPoint) and isinstance(raised.value, ValueError)
        assert isinstance(pickle.loads(pickle.dumps(raised.value)), strew.NoSuchPoint)
    many = strew.points(bbox=(0, 0, 1e6, 1e6), spacing=1)
    assert many[10**9].id == many[10**9:][0].id
    stars = strew.space.points(ball=(0, 0, 0, 5), spacing=1)
    assert stars[2] == list(stars)[2] and stars.point(stars.ids[2]).z == stars.z[2]


def test_truth() -> None:
    assert strew.points(spacing=1) and strew.points(bbox=(0, 0, 9, 9), spacing=1)
    assert not strew.points(bbox=(0, 0, 1e-3, 1e-3), spacing=9)


def test_measures_of_periods_and_their_pickles() -> None:
    points = strew.points(periodic=1000, map="s", spacing=1)
    measured = strew.measure(points)
    assert measured.figures == strew.measure(points, periodic=True).figures
    assert measured.figures != strew.measure(points, periodic=False).figures
    again = pickle.loads(pickle.dumps(measured))
    assert again.figures == measured.figures and again.svg() == measured.svg()


def test_masks_are_those_of_the_daemon(url: str) -> None:
    from urllib.request import urlopen

    mask = strew.mask(64, seed=7)
    assert sorted((mask * 64 * 64).ravel()) == list(range(64 * 64))
    with urlopen(f"{url}/v1/mask.png?size=64&seed=7&bits=16") as response:
        served = response.read()
    dots = strew._fields.native().darkness(served, True)
    assert dots[:2] == (64, 64)
    # The same order: the light of an sRGB picture rises with its numbers.
    light = np.frombuffer(dots[2], np.uint16).reshape(64, 64)
    order = np.argsort(mask, axis=None)
    assert (np.diff(light.ravel()[order].astype(int)) >= 0).all()
    with pytest.raises(strew.StrewError, match="`size` = `8`"):
        strew.mask(8)
