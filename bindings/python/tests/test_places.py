"""Reference systems: one through every argument, in this process and at a daemon, and in every file."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import strew

pyproj = pytest.importorskip("pyproj")
geopandas = pytest.importorskip("geopandas")

BOX = (0, 0, 20, 20)
RING: Any = {"type": "Polygon", "coordinates": [[[0, 0], [20, 0], [20, 20], [0, 20], [0, 0]]]}
EVEN: Any = {"attributes": "variant", "variants": {"oak": 1, "crs": 1}, "spread": "even"}


@pytest.fixture(params=["here", "there"])
def source(request: pytest.FixtureRequest) -> Any:
    return strew if request.param == "here" else request.getfixturevalue("remote")


def arguments(crs: str) -> dict[str, Any]:
    """Queries that each bring a reference system along, by the argument that has it."""
    shapes = geopandas.GeoSeries.from_wkt(["POLYGON ((0 0, 20 0, 20 20, 0 20, 0 0))"], crs=crs)
    frame = geopandas.GeoDataFrame({"k": ["one"], "n": [7]}, geometry=shapes)
    member = {"type": "name", "properties": {"name": crs}}
    field = strew.raster(np.ones((4, 4)), bbox=BOX, crs=crs)
    hill = strew.pixels(np.ones((4, 4)), bbox=BOX, crs=crs)
    box = {"bbox": BOX}
    return {
        "region.polygon": {"polygon": frame},
        "region.polygon.crs": {"polygon": {**RING, "crs": member}},
        "region.include[1].polygon": {"region": {"include": [{"bbox": BOX}, {"polygon": shapes}]}},
        "region.exclude[0].polygon": {"region": {"include": [{"bbox": (0, 0, 30, 30)}], "exclude": [{"polygon": shapes}]}},
        "features.of": {"features": {"of": frame, "id": "k", "count": "n"}},
        "field": {**box, "field": field},
        "field.multiply[1]": {**box, "field": {"multiply": [{"constant": 1}, field]}},
        "field.invert.curve.of": {**box, "field": {"invert": {"curve": {"of": field, "points": [[0, 1], [1, 0]]}}}},
        "field.height.terrain": {**box, "field": {"height": {"terrain": hill, "heights": [0, 1]}}},
        "terrain": {**box, "terrain": field},
        "variant_fields.crs": {**box, **EVEN, "variant_fields": {"crs": field}},
        "layers[1].field": {**box, "layers": [{"name": "a", "spacing": 2}, {"name": "b", "spacing": 1, "field": field}]},
        "layers[0].region.polygon": {**box, "layers": [{"name": "a", "spacing": 2, "region": {"polygon": frame}}]},
        "crs": {**box, "crs": crs},
    }


def whole(query: dict[str, Any]) -> dict[str, Any]:
    return query if "features" in query or "layers" in query else {**query, "spacing": 1}


@pytest.mark.parametrize("argument", arguments("EPSG:2154"))
def test_every_argument_carries_its_system_into_every_result(source: Any, argument: str, tmp_path: Path) -> None:
    points = source.points(**whole(arguments("EPSG:2154")[argument]))
    assert points.crs == "EPSG:2154" and len(points) > 0
    for same in (points, points[:3], *points.split(2), source.query(points.body)):
        assert same.crs == "EPSG:2154"
    # Features have regions of their own.
    assert argument == "features.of" or points.within(bbox=(1, 1, 9, 9)).crs == "EPSG:2154"
    frame = points.to_geopandas()
    assert frame.crs.to_epsg() == 2154
    points.write(tmp_path / "points.geojson")
    read = geopandas.read_file(tmp_path / "points.geojson")
    assert read.crs.to_epsg() == 2154 and len(read) == len(frame)
    for name, reader in (("points.parquet", geopandas.read_parquet), ("points.arrow", geopandas.read_feather)):
        points.write(tmp_path / name)
        read = reader(tmp_path / name)
        assert read.crs.to_epsg() == 2154 and len(read) == len(frame)
    assert points.document("geojson") == points.document("geojson", crs=2154)
    assert b"EPSG" not in points.document("csv")
    for contradiction in (
        lambda: points.write(tmp_path / "x.geojson", crs="EPSG:32633"),
        lambda: points.to_geopandas(crs=32633),
        lambda: points.to_arrow(geometry=True, crs=32633),
        lambda: points.within(polygon=arguments("EPSG:32633")["region.polygon"]["polygon"]),
    ):
        with pytest.raises(strew.StrewError, match="EPSG:32633'`: contradicts the EPSG:2154 of `points`"):
            contradiction()


@pytest.mark.parametrize("argument", arguments("EPSG:2154"))
def test_a_contradiction_names_both_systems_and_both_arguments(source: Any, argument: str) -> None:
    query = whole(arguments("EPSG:2154")[argument])
    if argument != "crs":
        with pytest.raises(strew.StrewError) as raised:
            source.points(**query, crs=32633)
        assert f"`crs` = `'EPSG:32633'`: contradicts the EPSG:2154 of `{argument}`" in str(raised.value)
        assert source.points(**query, crs=2154).crs == "EPSG:2154"
    for other, more in arguments("EPSG:32633").items():
        [own] = set(more) - {"bbox", *EVEN}
        if own in query or own in ("region", "polygon", "features", "layers") or "features" in query:
            continue
        if "layers" in query and own != "crs":
            continue
        with pytest.raises(strew.StrewError, match="contradicts the") as raised:
            source.points(**{**query, **EVEN, own: more[own]})
        for word in ("EPSG:32633", "EPSG:2154", f"`{other}`", f"`{argument}`"):
            assert word in str(raised.value)


def test_a_raster_contradicts_features_and_layers(source: Any) -> None:
    here, there = arguments("EPSG:2154"), arguments("EPSG:32633")
    field = there["field"]["field"]
    for query in (
        {**here["features.of"], "field": field},
        {**here["region.polygon"], "layers": [{"name": "a", "spacing": 1, "field": field}]},
        {**here["region.polygon"], "field": {"multiply": [field, {"constant": 1}]}, "spacing": 1},
        {**here["region.polygon"], "field": {"multiply": [here["field"]["field"], {"invert": field}]}, "spacing": 1},
    ):
        with pytest.raises(strew.StrewError, match="'EPSG:32633'`: contradicts the EPSG:2154 of `"):
            source.points(**query)


def test_the_keyword_takes_what_pyproj_takes(source: Any, tmp_path: Path) -> None:
    crs = pyproj.CRS(2154)

    class Other:
        def to_wkt(self) -> str:
            return str(crs.to_wkt())

    forms = [2154, np.int64(2154), "EPSG:2154", "epsg:2154", " EPSG:2154 ", "urn:ogc:def:crs:EPSG::2154", crs, crs.to_wkt()]
    forms += [crs.to_json_dict(), ("EPSG", 2154), Other(), "http://www.opengis.net/def/crs/EPSG/0/2154", crs.name]
    for form in forms:
        points = source.points(bbox=BOX, spacing=2, crs=form)
        assert points.crs == "EPSG:2154" and points.to_geopandas().crs.to_epsg() == 2154
        assert source.points(bbox=BOX, spacing=2).to_geopandas(crs=form).crs.to_epsg() == 2154
    assert source.points(bbox=BOX, spacing=2, crs=None).crs is None
    for wrong in ("EPSG", "nowhere", True, -1.5, object(), [1]):
        with pytest.raises(strew.StrewError, match="`crs` = .*: not a reference system; allowed: what pyproj reads"):
            source.points(bbox=BOX, spacing=2, crs=wrong)
    degrees = source.points(bbox=BOX, spacing=2, crs="OGC:CRS84")
    assert degrees.to_geopandas(crs=4326).crs.to_epsg() == 4326


def test_a_system_without_a_name_is_kept_and_never_left_out(source: Any, tmp_path: Path) -> None:
    crs = pyproj.CRS("+proj=aea +lat_1=51 +lat_2=47 +lon_0=9.25 +ellps=GRS80")
    points = source.points(bbox=BOX, spacing=2, crs=crs)
    assert points.to_geopandas().crs == crs == geopandas.GeoDataFrame.from_arrow(points.to_arrow(geometry=True)).crs
    with pytest.raises(strew.StrewError, match=r"has no name that geojson could state; allowed: .*to_geopandas\(\)"):
        points.write(tmp_path / "points.geojson")
    points.write(tmp_path / "points.csv")
    with pytest.raises(strew.StrewError, match="contradicts"):
        source.points(bbox=BOX, spacing=2, crs=crs, field=arguments("EPSG:2154")["field"]["field"])


def test_points_in_space_carry_their_system(source: Any) -> None:
    shapes = arguments("EPSG:2154")["region.polygon"]["polygon"]
    for points in (
        source.space.points(prism=(shapes, 0, 4), spacing=2),
        source.space.points(bbox=(0, 0, 0, 4, 4, 4), spacing=2, crs=2154),
    ):
        assert points.crs == "EPSG:2154"
        written = json.loads(points.document("geojson"))
        assert written["crs"]["properties"]["name"].endswith("EPSG::2154")
        with pytest.raises(strew.StrewError, match="contradicts"):
            points.document("geojson", crs=4326)


def test_columns_of_features_that_are_not_read_may_be_of_any_type(source: Any) -> None:
    pandas = pytest.importorskip("pandas")
    frame = arguments("EPSG:2154")["features.of"]["features"]["of"]
    frame = frame.assign(day=pandas.to_datetime(["2026-11-27"]), thing=[object()], set=[{1, 2}])
    points = source.points(features={"of": frame, "id": "k", "count": "n"})
    assert len(points) == 7 and points["layer"].tolist() == ["one"] * 7
    assert points.crs == "EPSG:2154"


def test_features_are_named_by_the_index_and_need_a_geometry(source: Any) -> None:
    frame = arguments("EPSG:2154")["features.of"]["features"]["of"]
    frame = geopandas.GeoDataFrame({"n": [7, 5]}, geometry=[frame.geometry[0], None], index=["Île", "sea"], crs=2154)
    with pytest.warns(UserWarning, match="features without a geometry have no points: sea$"):
        points = source.points(features={"of": frame, "count": "n"})
    assert points["layer"].tolist() == ["Île"] * 7 and points.crs == "EPSG:2154"


def test_sets_of_other_systems_differ() -> None:
    query: Any = {"bbox": BOX, "spacing": 2}
    assert strew.points(**query) == strew.points(**query)
    assert strew.points(**query) != strew.points(**query, crs=2154)
