"""Reads a GeoParquet file of 360,000 points in [0, 600)², EPSG:25832, with the usual readers, as far as they are installed."""

import importlib
import sys

path = sys.argv[1]


def pyarrow():
    import pyarrow.dataset
    import pyarrow.parquet

    metadata = pyarrow.parquet.ParquetFile(path).metadata
    bounds = []
    for i in range(metadata.num_row_groups):
        group = metadata.row_group(i)
        columns = {group.column(j).path_in_schema: group.column(j) for j in range(group.num_columns)}
        assert columns["x"].compression == "ZSTD" and "BYTE_STREAM_SPLIT" in columns["x"].encodings
        assert columns["x"].statistics.has_min_max and columns["y"].statistics.has_min_max
        bounds.append((columns["y"].statistics.min, columns["y"].statistics.max))
    assert len(bounds) > 3
    here = pyarrow.dataset.field("y") < 50
    fragments = list(pyarrow.dataset.dataset(path).get_fragments(here))
    [fragment] = [fragment.subset(here) for fragment in fragments]
    assert len(fragment.row_groups) == sum(low < 50 for low, _ in bounds) < len(bounds)


def geopandas():
    import geopandas
    import pyproj

    frame = geopandas.read_parquet(path)
    assert frame.crs == pyproj.CRS.from_epsg(25832), frame.crs
    assert (frame.geometry.x == frame["x"]).all()
    low, high = frame.total_bounds[:2], frame.total_bounds[2:]
    assert (low >= 0).all() and (high < 600).all()


def duckdb():
    import duckdb

    [[low, count]] = duckdb.sql(f"select min(y), count(*) from '{path}' where y >= 550").fetchall()
    [[groups]] = duckdb.sql(
        f"select count(*) from parquet_metadata('{path}') where path_in_schema = 'y' and stats_max_value::double < 550"
    ).fetchall()
    assert low >= 550 and count > 29_000 and groups > 1, (low, count, groups)


for reader in (pyarrow, geopandas, duckdb):
    try:
        importlib.import_module(reader.__name__)
    except ImportError:
        print(f"skipped: {reader.__name__} is not installed")
        continue
    reader()
