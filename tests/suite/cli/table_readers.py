"""Reads the files of a folder with the usual readers of tables, as far as they are installed."""

import csv
import importlib
import sys
from pathlib import Path

folder = Path(sys.argv[1])
with open(folder / "t.csv", newline="") as file:
    expected = [(row["id"], float(row["x"]), row["variant"]) for row in csv.DictReader(file)]


def check(name, ids, xs, variants):
    rows = [(str(i), float(x), str(v)) for i, x, v in zip(ids, xs, variants, strict=True)]
    assert rows == expected, name


def columns(name, table):
    check(name, *(table.column(c).to_pylist() for c in ("id", "x", "variant")))


def pyarrow():
    import pyarrow.dataset
    import pyarrow.feather

    for name in ("t.arrow", "t.feather"):
        columns(name, pyarrow.feather.read_table(folder / name))
    columns("dataset", pyarrow.dataset.dataset(folder / "t.arrow", format="arrow").to_table())
    with pyarrow.ipc.open_stream(folder / "t.arrows") as reader:
        columns("stream", reader.read_all())


def pandas():
    import pandas

    for name in ("t.arrow", "t.feather"):
        frame = pandas.read_feather(folder / name)
        check(name, frame["id"], frame["x"], frame["variant"])


def polars():
    import polars

    frame = polars.read_ipc(folder / "t.arrow")
    check("polars", frame["id"], frame["x"], frame["variant"])


def geopandas():
    import geopandas

    frame = geopandas.read_parquet(folder / "t.parquet")
    assert frame.crs is None and (frame.geometry.x == frame["x"]).all()
    check("geopandas", frame["id"], frame["x"], frame["variant"])


def duckdb():
    import duckdb

    rows = duckdb.sql(f"select id, x, variant from '{folder / 't.parquet'}'").fetchall()
    check("duckdb", *zip(*rows))


for reader in (pyarrow, pandas, polars, geopandas, duckdb):
    try:
        importlib.import_module(reader.__name__)
    except ImportError:
        print(f"skipped: {reader.__name__} is not installed")
        continue
    reader()
