"""Points in space: the same points, documents and words as the real daemon."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest

import strew


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
