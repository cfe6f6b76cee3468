"""Which queries are sent by GET: those whose address is short and means the same as the body."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from strew._query import body, path


@pytest.mark.parametrize(
    ("keywords", "expected"),
    [
        ({"bbox": (0, 0, 9, 4.5), "spacing": 1}, "/v1/points?spacing=1&bbox=0,0,9,4.5"),
        ({"bbox": np.array([0.0, 0, 1, 1]), "seed": np.uint64(7)}, "/v1/points?seed=7&bbox=0.0,0.0,1.0,1.0"),
        ({"circle": (1, 2, 3), "density": 1e-5}, "/v1/points?density=1e-05&circle=1,2,3"),
        ({"chunk": (64, -3, 2), "spacing": 2}, "/v1/chunks/64/-3/2?spacing=2"),
        (
            {"chunk": (64, 0, 0), "attributes": "angle,scale", "variants": {"oak": 3, "elm": 1}, "normals": True},
            "/v1/chunks/64/0/0?attributes=angle,scale&variants=oak:3,elm:1&normals=on",
        ),
        ({"bbox": (0, 0, 1, 1), "except_": ["1:2", "a/-3:4"]}, "/v1/points?except=1:2,a%2F-3:4&bbox=0,0,1,1"),
    ],
)
def test_short_queries_have_addresses(keywords: dict[str, Any], expected: str) -> None:
    assert path(body(keywords)) == expected


@pytest.mark.parametrize(
    "keywords",
    [
        {"polygon": [(0, 0), (1, 0), (0, 1)]},
        {"bbox": (0, 0, 1, 1), "layers": [{"name": "a", "spacing": 1}]},
        {"bbox": (0, 0, 1, 1), "field": {"constant": 0.5}},
        {"bbox": (0, 0, 1, 1), "variants": {f"name{i}": 1 for i in range(250)}},
        # What an address would take, and a body refuses.
        {"bbox": (0, 0, 1, 1), "spacing": "1"},
        {"bbox": (0, 0, 1, 1), "seed": True},
        {"bbox": (0, 0, 1), "spacing": 1},
        {"bbox": (0, 0, 1, 1), "circle": (0, 0, 1)},
    ],
)
def test_other_queries_have_none(keywords: dict[str, Any]) -> None:
    assert path(body(keywords)) is None
