"""Points as tables of pyarrow, pandas and geopandas, and as a picture of matplotlib."""

from __future__ import annotations

import io
import json
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import program

import strew

QUERY: Any = {"bbox": (0, 0, 20, 10), "spacing": 1, "attributes": ["angle", "variant"], "variants": {"oak": 3, "fir": 1}}


def test_tables_of_arrow() -> None:
    pyarrow = pytest.importorskip("pyarrow")
    points = strew.points(**QUERY)
    assert points.to_arrow().equals(pyarrow.table(points))
    table = points.to_arrow(geometry=True, crs="EPSG:32633")
    assert table.column_names == ["id", "angle", "variant", "geometry"]
    assert np.array(table["geometry"].to_pylist()).tobytes() == points.xy.tobytes()
    geopandas = pytest.importorskip("geopandas")
    frame = geopandas.GeoDataFrame.from_arrow(table)
    assert frame.crs.to_epsg() == 32633 and frame.geometry.x.tolist() == points.x.tolist()


def test_frames_of_pandas() -> None:
    pytest.importorskip("pandas")
    points = strew.points(**QUERY)
    frame = points.to_pandas()
    assert list(frame.columns) == ["id", "x", "y", "angle", "variant"]
    assert frame["id"].tolist() == points["id"].tolist() and frame["x"].tolist() == points.x.tolist()
    assert frame["variant"].tolist() == points["variant"].tolist() and frame["variant"].dtype == "category"
    stars = strew.space.points(ball=(0, 0, 0, 5), spacing=1).to_pandas()
    assert list(stars.columns) == ["id", "x", "y", "z"]


def test_frames_of_geopandas() -> None:
    geopandas = pytest.importorskip("geopandas")
    frame = strew.points(**QUERY).to_geopandas(crs=32633)
    assert frame.crs.to_epsg() == 32633 and frame.total_bounds.max() < 20
    chunk = strew.points(**QUERY).chunk(8, 1, 0)
    assert chunk.x.max() < 8 <= chunk.to_geopandas().geometry.x.min()
    tall = strew.points(**QUERY, terrain={"constant": 0.5}).to_geopandas()
    assert set(tall.geometry.z) == {0.5}
    # A region of geopandas brings its reference system along.
    region = geopandas.GeoSeries.from_wkt(["POLYGON ((0 0, 9 0, 9 9, 0 0))"], crs=32633)
    inside = strew.points(polygon=region, spacing=1)
    assert inside.to_geopandas().crs.to_epsg() == 32633
    assert inside.to_geopandas().within(region.iloc[0]).all()
    with pytest.raises(strew.StrewError, match="contradicts"):
        inside.to_geopandas(crs=4326)


def test_files_of_parquet_have_the_columns_of_the_command(tmp_path: Path) -> None:
    geopandas = pytest.importorskip("geopandas")
    pyarrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    flags = "--bbox 0,0,20,10 --spacing 1 --attributes angle,variant --variants oak:3,fir:1 --crs EPSG:32633 -q".split()
    subprocess.run([program(), "sample", *flags, "-o", tmp_path / "a.parquet"], check=True)
    strew.points(**QUERY, crs=32633).write(tmp_path / "b.parquet")
    one, other = (parquet.ParquetFile(tmp_path / f"{name}.parquet") for name in "ab")
    assert one.schema_arrow.names == other.schema_arrow.names
    assert [json.loads(file.metadata.metadata[b"geo"])["version"] for file in (one, other)] == ["1.1.0", "1.1.0"]
    theirs, ours = (geopandas.read_parquet(tmp_path / f"{name}.parquet") for name in "ab")
    assert ours.crs == theirs.crs and ours.to_wkt().values.tolist() == theirs.to_wkt().values.tolist()
    stars = strew.space.points(bbox=(0, 0, 0, 5, 5, 5), count=77, crs=32633)
    read = geopandas.read_parquet(io.BytesIO(stars.document("parquet")))
    assert read.geometry.z.tolist() == read["z"].tolist() == stars.z.tolist() and read.crs.to_epsg() == 32633
    assert geopandas.read_feather(io.BytesIO(stars.document("feather"))).equals(read)
    streamed = pyarrow.ipc.open_stream(stars.document("arrow")).read_all()
    assert streamed.equals(stars.to_arrow()) and streamed.schema.metadata[b"strew.count"] == b"77"


def test_pictures_of_matplotlib() -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    from matplotlib import pyplot

    points = strew.points(**QUERY)
    for by in (None, "angle", "variant"):
        axes = pyplot.figure().add_subplot()
        assert points.plot(axes, by=by, alpha=0.5) is axes
        drawn = np.concatenate([one.get_offsets() for one in axes.collections])
        assert sorted(map(tuple, drawn)) == sorted(map(tuple, points.xy))
        assert axes.get_aspect() == 1
    assert points.plot() is pyplot.gca()
    pyplot.close("all")
    stars = strew.space.points(bbox=(0, 0, 0, 5, 5, 5), count=77, attributes="u1")
    [drawn, *_] = stars.plot(by="u1").collections
    assert np.array(drawn._offsets3d).T.tolist() == stars.xyz.tolist()
    pyplot.close("all")
