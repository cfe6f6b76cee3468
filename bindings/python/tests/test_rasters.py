"""Arrays as fields: masks, places, reference systems, classes, and datasets of rasterio."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import strew

BOX = (0, 0, 10, 10)


def points(field: Any, **more: Any) -> strew.PointSet:
    return strew.points(**{"bbox": BOX, "spacing": 0.5, "field": field, **more})


def test_masked_pixels_have_the_share_0() -> None:
    mask = np.eye(4, dtype=bool)
    for array in (np.ones((4, 4)), np.full((4, 4), 255, np.uint8), np.full((4, 4), 65535, np.uint16), np.ones((4, 4), bool)):
        masked = np.ma.array(array, mask=mask)
        filled = points(strew.raster(masked.filled(0), bbox=BOX, filter="nearest"))
        found = points(strew.raster(masked, bbox=BOX, filter="nearest"))
        assert found.ids.tolist() == filled.ids.tolist()
        assert 0 < len(found) < len(points(strew.raster(array, bbox=BOX, filter="nearest")))
    shifted = np.ma.array(np.full((4, 4), 9.0), mask=mask)
    found = points(strew.raster(shifted, bbox=BOX, filter="nearest", black=5, white=9))
    assert len(found) == len(points(strew.raster(~mask, bbox=BOX, filter="nearest")))
    # No neighbor is spread into them, and nothing that is made of the field brings them back.
    wide = np.ma.array(np.ones((4, 4)), mask=mask)
    field, hill = strew.raster(wide, bbox=BOX, low=0.5), {"terrain": strew.pixels(wide, bbox=BOX), "heights": [0, 2]}
    for sharp in (field, {"invert": strew.raster(np.ma.array(np.zeros((4, 4)), mask=mask), bbox=BOX)}, {"height": hill}):
        found = points(sharp, settle=0)
        assert len(found) and not mask[3 - (found.y * 0.4).astype(int), (found.x * 0.4).astype(int)].any()


def test_nodata_is_masked() -> None:
    array = np.where(np.eye(4, dtype=bool), -9999.0, 1.0)
    wanted = points(strew.raster(array > 0, bbox=BOX, filter="nearest")).ids.tolist()
    assert points(strew.raster(array, bbox=BOX, filter="nearest", nodata=-9999)).ids.tolist() == wanted
    array[array < 0] = np.nan
    assert points(strew.raster(array, bbox=BOX, filter="nearest", nodata=np.nan)).ids.tolist() == wanted


def test_integers_that_are_no_shares_are_refused_with_the_way_out() -> None:
    for kind in (np.uint8, np.uint16):
        with pytest.raises(strew.StrewError, match=r"holds 0 and 1 alone.*array.astype\(bool\)"):
            strew.raster(np.ones((4, 4), kind), bbox=BOX)
        assert len(points(strew.raster(np.ones((4, 4), kind), bbox=BOX, white=1))) > 300
    with pytest.raises(strew.StrewError, match="holds 7: numbers of this type are shares"):
        strew.raster(np.full((4, 4), 7, np.int32), bbox=BOX)
    assert len(points(strew.raster(np.ones((4, 4), np.int64), bbox=BOX))) > 300
    for shape, way_out in (((3,), "rows and columns"), ((1, 4, 4), r"array\[0\]"), ((3, 4, 4), "one band")):
        with pytest.raises(strew.StrewError, match=f"2 dimensions, not {len(shape)}; allowed: .*{way_out}"):
            strew.raster(np.ma.zeros(shape))
    for path in ("cover.tif", Path("cover.tif")):
        with pytest.raises(strew.StrewError, match=r"cover.tif.*: not an array; allowed: rasterio.open\(path\)"):
            strew.raster(path)


def test_the_order_of_bytes_means_nothing() -> None:
    numbers = np.arange(12).reshape(3, 4)
    for kind in ("u2", "i2", "i4", "i8", "f4", "f8"):
        native = (numbers * 5000).astype(kind)
        white: Any = {} if kind == "u2" else {"white": 60000}
        there, here = (strew.raster(native.astype(order + kind), bbox=BOX, **white) for order in ("<", ">"))
        assert there == here
        assert points(here).ids.tolist() == points(there).ids.tolist()
    for order in ("<u2", ">u2"):
        with pytest.raises(strew.StrewError, match=r"holds 0 and 1 alone.*array.astype\(bool\)"):
            strew.raster(np.ones((4, 4), order), bbox=BOX)


def test_a_mask_is_sharp() -> None:
    mask = np.indices((10, 10)).sum(axis=0) % 2 == 0
    found = points(strew.raster(mask, bbox=BOX), settle=0)
    assert len(found) > 100 and mask[(9 - found.y.astype(int)), found.x.astype(int)].all()
    assert strew.raster(mask, bbox=BOX, filter="linear") == strew.raster(mask.astype(np.uint8) * 255, bbox=BOX, filter="linear")


def test_arrays_of_xarray_lie_where_their_coordinates_say() -> None:
    xarray = pytest.importorskip("xarray")
    numbers = np.arange(12.0).reshape(3, 4) / 12
    wanted = strew.raster(numbers, bbox=(100, 200, 108, 206))
    x, y = 101 + 2.0 * np.arange(4), 205 - 2.0 * np.arange(3)
    plain = xarray.DataArray(numbers, {"y": y, "x": x}, ("y", "x"))
    for array in (
        plain, plain[::-1], plain[:, ::-1], plain.T, plain.T[::-1, ::-1], plain.expand_dims("band"),
        plain.rename(y="lat", x="lon"), xarray.concat([plain, 1 - plain], "band").isel(band=[0]),
    ):
        assert strew.raster(array) == wanted
        assert strew.raster(array, bbox=(100, 200, 108, 206)) == wanted
    assert strew.raster(xarray.concat([1 - plain, plain], "band"), band=2) == wanted
    # A transform is that of the rows as they are stored.
    assert strew.raster(plain[::-1], transform=(2, 0, 100, 0, 2, 200)) == wanted
    assert strew.raster(xarray.DataArray(numbers, dims=("y", "x")), bbox=(100, 200, 108, 206)) == wanted
    named = plain.assign_coords(spatial_ref=((), 0, {"crs_wkt": "EPSG:32633"}))
    assert strew.points(bbox=BOX, spacing=1, field=strew.raster(named)).crs == "EPSG:32633"
    for wrong, words in (
        (plain.rename(y="a"), "rows and columns are not known"),
        (plain.assign_coords(x=[1, 2, 4, 8]), "coordinates at uneven distances"),
        (plain[:1], "one coordinate, which has no width"),
        (xarray.concat([plain, plain], "band"), "the array has 2 of band; allowed: band=1 to band=2"),
    ):
        with pytest.raises(strew.StrewError, match=words):
            strew.raster(wrong)
    gaps = xarray.DataArray(np.array([[7, 255], [255, 0]], np.uint8), {"y": [1.5, 0.5], "x": [0.5, 1.5]}, ("y", "x"))
    gaps.attrs["_FillValue"] = 7
    masked = np.ma.masked_equal(gaps.values, 7)
    assert strew.raster(gaps) == strew.raster(masked, bbox=(0, 0, 2, 2))


def test_classes_have_shares() -> None:
    classes = np.array([[1, 2], [3, 4]], np.uint8)
    found = points(strew.raster(classes, bbox=BOX, shares={2: 1, 3: 0.25}))
    right, left = found.xy[found.x >= 5], found.xy[found.x < 5]
    assert (right[:, 1] >= 5).all() and (left[:, 1] < 5).all()
    assert 3 * len(left) < len(right)


def test_rows_may_run_in_any_direction_along_the_axes() -> None:
    array = np.arange(12.0).reshape(3, 4) / 12
    plain = strew.raster(array, bbox=(100, 200, 108, 206))
    for rows, transform in (
        (array, (2, 0, 100, 0, -2, 206)),
        (array[::-1], (2, 0, 100, 0, 2, 200)),
        (array[:, ::-1], (-2, 0, 108, 0, -2, 206)),
        (array.T, (0, 2, 100, -2, 0, 206)),
        (array.T[::-1, ::-1], (0, -2, 108, 2, 0, 200)),
    ):
        assert strew.raster(rows, transform=transform) == plain
    for turned in ((2, 1, 0, 1, -2, 0), (0, 0, 0, 0, -2, 0), (1, 2, 3), 7):
        with pytest.raises(strew.StrewError, match="`transform`"):
            strew.raster(array, transform=turned)
    with pytest.raises(strew.StrewError, match="not beside bbox"):
        strew.raster(array, transform=(2, 0, 100, 0, -2, 206), bbox=BOX)


def test_reference_systems_that_contradict_are_refused() -> None:
    field = strew.raster(np.ones((4, 4)), bbox=BOX, crs="EPSG:32633")
    assert points(field).crs == "EPSG:32633"
    assert points(field).chunk(4, 0, 0).crs == "EPSG:32633"
    polygon = {"type": "Polygon", "coordinates": [[[0, 0], [9, 0], [9, 9], [0, 0]]]}
    for crs in ("urn:ogc:def:crs:EPSG::32633", "epsg:32633"):
        named = {**polygon, "crs": {"type": "name", "properties": {"name": crs}}}
        assert strew.points(polygon=named, spacing=1, field=field).crs == "EPSG:32633"
    degrees = {**polygon, "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:OGC:1.3:CRS84"}}}
    with pytest.raises(strew.StrewError, match="`field` = `'EPSG:32633'`: contradicts the OGC:CRS84 of `region.polygon.crs`"):
        strew.points(polygon=degrees, spacing=1, field=field)
    with pytest.raises(strew.StrewError, match="contradicts"):
        points(field).within(polygon=degrees)
    assert strew.points(polygon=degrees, spacing=1, field=strew.raster(np.ones((2, 2)), bbox=BOX, crs=4326)).crs


def test_datasets_of_rasterio_are_read(tmp_path: Path) -> None:
    rasterio = pytest.importorskip("rasterio")
    array = np.array([[255, 255, 0], [255, 7, 255]], np.uint8)
    path = tmp_path / "raster.tif"
    transform = rasterio.Affine(5, 0, 500_000, 0, -5, 5_400_010)
    form = {"driver": "GTiff", "width": 3, "height": 2, "dtype": "uint8", "crs": "EPSG:32633", "transform": transform}
    with rasterio.open(path, "w", count=2, nodata=7, **form) as made:
        made.write(array, 1)
        made.write(array // 2, 2)
    box = (500_000, 5_400_000, 500_015, 5_400_010)
    wanted = strew.raster(np.ma.masked_equal(array, 7), bbox=box, filter="nearest")
    with rasterio.open(path) as dataset:
        for given in (strew.raster(dataset, band=1, filter="nearest"), strew.raster(rasterio.band(dataset, 1), filter="nearest")):
            assert given == wanted
            assert strew.points(bbox=box, spacing=1, field=given).crs == "EPSG:32633"
        with pytest.raises(strew.StrewError, match="the dataset has 2 bands; allowed: band=1 to band=2"):
            strew.raster(dataset)
        with pytest.raises(strew.StrewError, match="contradicts"):
            strew.raster(dataset, band=1, crs="EPSG:4326")
        with pytest.raises(strew.StrewError, match=r"strew.raster\(array"):
            strew.points(bbox=box, spacing=1, field=dataset)


def test_land_cover_as_the_readme_shows_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rasterio = pytest.importorskip("rasterio")
    geopandas = pytest.importorskip("geopandas")
    pytest.importorskip("pyarrow")
    readme = (Path(__file__).resolve().parents[1] / "README.md").read_text()
    [code] = [block for block in re.findall(r"```python\n(.*?)```", readme, re.S) if "cover.tif" in block]
    monkeypatch.chdir(tmp_path)
    transform = rasterio.Affine(100, 0, 500_000, 0, -100, 5_400_200)
    form = {"driver": "GTiff", "width": 2, "height": 2, "count": 1, "dtype": "uint8", "crs": "EPSG:32633", "nodata": 43}
    with rasterio.open("cover.tif", "w", transform=transform, **form) as made:
        made.write(np.array([[41, 7], [43, 43]], np.uint8), 1)
    exec(code, {})
    trees = geopandas.read_parquet("trees.parquet")
    assert trees.crs.to_epsg() == 32633 and 350 < len(trees) < 450
    assert trees.geometry.x.max() < 500_100 and trees.geometry.y.min() >= 5_400_100
