"""Sets of points in this process: arrays, pickles, threads, Arrow, pictures, figures."""

from __future__ import annotations

import gzip
import multiprocessing
import os
import pickle
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import program

import strew

LAYERS: Any = {
    "bbox": (0, 0, 30, 30),
    "layers": [
        {"name": "trees", "spacing": 2, "attributes": ["angle", "variant"], "variants": {"oak": 2, "fir": 1}},
        {"name": "rocks", "spacing": 3, "attributes": ["u1"]},
    ],
}


def test_arrays_look_at_the_memory_of_the_library() -> None:
    points = strew.points(bbox=(0, 0, 50, 50), spacing=1, attributes=["angle"])
    columns = points.columns()
    for array, owner in ((points.ids, columns.ids()), (points["angle"], columns.further(0)[0])):
        address, is_read_only = owner.__array_interface__["data"]
        assert array.__array_interface__["data"] == (address, True) and is_read_only
    x = points.x
    assert x.base is not None and not x.flags.writeable
    kept = points.ids[:3].copy()
    ids = points.ids
    del points, columns
    assert (ids[:3] == kept).all()
    assert np.asarray(strew.points(bbox=(0, 0, 9, 9), spacing=1)).shape[1] == 2
    assert strew.points(bbox=(0, 0, 9, 9), spacing=1).__array__(np.float32).dtype == np.float32


def test_coordinates_alone_are_those_of_all_columns() -> None:
    for query in (LAYERS, {"circle": (3, 4, 50), "spacing": 0.5, "seed": 2}, {"chunk": (32, 1, 2), "spacing": 1}):
        alone, all_columns = strew.points(**query), strew.points(**query)
        all_columns.columns()
        assert alone.xy.tobytes() == all_columns.xy.tobytes()


def test_partitions_have_each_point_once() -> None:
    whole = strew.points(bbox=(-20, -20, 20, 20), spacing=1, seed=9)
    quarters = [whole.within(bbox=(x, y, x + 20, y + 20)) for x in (-20, 0) for y in (-20, 0)]
    ids = np.concatenate([quarter.ids for quarter in quarters])
    assert sorted(map(tuple, ids)) == sorted(map(tuple, whole.ids))
    assert np.concatenate([part.ids for part in whole.split(7)]).tobytes() == whole.ids.tobytes()


def ids_of(part: strew.PointSet) -> bytes:
    return part.ids.tobytes()


def test_sets_are_pickled_as_their_queries_and_made_by_other_processes() -> None:
    field = strew.raster(np.linspace(0, 1, 64).reshape(8, 8), bbox=(0, 0, 40, 40))
    whole = strew.points(bbox=(0, 0, 40, 40), spacing=0.5, field=field, seed=2)
    again = pickle.loads(pickle.dumps(whole))
    assert again == whole and again.xy.tobytes() == whole.xy.tobytes()
    parts = whole.split(4)
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        assert b"".join(pool.map(ids_of, parts)) == whole.ids.tobytes()
    daemon = strew.connect("https://example.org/strew/", key="secret")
    assert repr(pickle.loads(pickle.dumps(daemon))) == "https://example.org/strew"
    error = pickle.loads(pickle.dumps(strew.StrewError("words", "kind", [{"field": "x"}])))
    assert (str(error), error.kind, error.faults) == ("words", "kind", [{"field": "x"}])


def test_threads_have_the_same_points() -> None:
    def made(seed: int) -> bytes:
        return strew.points(bbox=(0, 0, 100, 100), spacing=0.5, seed=seed, attributes=["angle"]).xy.tobytes()

    with ThreadPoolExecutor(8) as pool:
        assert list(pool.map(made, [seed % 4 for seed in range(32)])) == [made(seed % 4) for seed in range(32)]


def test_arrow_readers_take_all_columns() -> None:
    pyarrow = pytest.importorskip("pyarrow")
    points = strew.points(**LAYERS)
    table = pyarrow.table(points)
    table.validate(full=True)
    assert table.column_names == ["id", "x", "y", "layer", "angle", "variant", "u1"]
    assert table["id"].to_pylist() == [f"{x}:{y}" for x, y in points.ids.tolist()]
    assert table["x"].to_numpy().tobytes() == points.x.tobytes()
    assert table["layer"].to_pylist() == points["layer"].tolist()
    assert [name or "" for name in table["variant"].to_pylist()] == points["variant"].tolist()
    angles = table["angle"].to_pylist()
    assert [angle is None for angle in angles] == np.isnan(points["angle"]).tolist()
    assert table.schema.metadata[b"strew.count"] == str(len(points)).encode()
    capsule = points.__arrow_c_stream__()
    del points, capsule
    many = strew.points(bbox=(0, 0, 1500, 1500), spacing=1, seed=1, attributes=["angle"])
    batches = pyarrow.table(many).to_batches()
    assert len(batches) == 3 and sum(batch.num_rows for batch in batches) == len(many)
    empty = strew.points(bbox=(0.1, 0.1, 0.2, 0.2), spacing=99, attributes=["variant"], variants={"oak": 1})
    assert pyarrow.table(empty).num_rows == 0


def test_polars_and_duckdb_take_points() -> None:
    points = strew.points(**LAYERS)
    polars = pytest.importorskip("polars")
    frame = polars.DataFrame(points)
    assert frame["y"].to_numpy().tobytes() == points.y.tobytes()
    duckdb = pytest.importorskip("duckdb")
    count = duckdb.sql("select count(*), count(angle) from points").fetchall()[0]
    assert count == (len(points), int((points["layer"] == "trees").sum()))


def test_arrow_is_that_of_the_daemon(url: str) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    import urllib.request

    points = strew.points(**LAYERS)
    body = strew._query.text({**points.body, "format": "arrow"}).encode()
    with urllib.request.urlopen(f"{url}/v1/points:query", body) as response:
        theirs = pyarrow.ipc.open_stream(response.read()).read_all()
    ours = pyarrow.table(points)
    assert ours.schema.equals(theirs.schema) and ours.to_pylist() == theirs.to_pylist()


def test_stippling_is_that_of_the_command(tmp_path: Path) -> None:
    colors = (np.indices((30, 40)).sum(0) * 3).astype(np.uint8)
    picture = np.dstack([colors, colors // 2, 255 - colors])
    path = tmp_path / "picture.png"
    path.write_bytes(strew._fields._picture(picture))
    cases: list[tuple[dict[str, Any], list[str]]] = [
        ({}, []),
        ({"invert": True}, ["--invert"]),
        ({"settle": 0}, ["--settle", "0"]),
    ]
    for options, flags in cases:
        command = [program(), "stipple", path, "-n", "400", "-o", tmp_path / "dots.csv", "-q", *flags]
        environment = {name: value for name, value in os.environ.items() if not name.startswith("STREW_")}
        subprocess.run(command, check=True, env=environment)
        expected = (tmp_path / "dots.csv").read_bytes()
        for image in (path, path.read_bytes(), picture):
            assert strew.stipple(image, 400, **options).document("csv") == expected


def test_pictures_that_cannot_be_used_are_refused() -> None:
    for image, words in (
        (np.zeros((4, 4, 9), np.uint8), "channels"),
        (np.full((4, 4), 2.0), "light from 0"),
        (np.zeros((4, 4), np.int64), "uint8"),
        (np.full((4, 4), 255, np.uint8), "all white"),
        (np.ones((8, 8)), "all white"),
        (b"no picture", "cannot be read"),
    ):
        with pytest.raises(ValueError, match=words):
            strew.stipple(image, 9)
    with pytest.raises(ValueError, match="2 dimensions"):
        strew.raster(np.zeros(3))


def test_large_masks_are_taken_in_process() -> None:
    mask = np.zeros((1500, 1500), np.uint8)
    mask[:, 750:] = 255
    field = strew.raster(mask, bbox=(0, 0, 100, 100), filter="nearest")
    assert strew.points(bbox=(0, 0, 100, 100), spacing=1, field=field).x.min() >= 50


def test_measuring() -> None:
    points = strew.points(bbox=(0, 0, 60, 60), spacing=1, seed=1)
    measured = strew.measure(points)
    again = strew.measure(points.xy, bbox=(0, 0, 60, 60), density=1)
    assert measured.figures == again.figures and measured.points == len(points)
    assert measured.radial.shape[1] == 3 and measured.rdf.shape[1] == 2
    assert measured.svg("title").startswith("<svg")
    assert measured.figures["low_power"] < 1e-3 < strew.measure(np.random.default_rng(1).random((3600, 2)) * 60,
                                                                bbox=(0, 0, 60, 60)).figures["low_power"]
    with pytest.raises(strew.StrewError, match="only squares"):
        strew.measure(points.xy, bbox=(0, 0, 60, 50))
    with pytest.raises(strew.StrewError, match="outside of bbox"):
        strew.measure(points.xy, bbox=(0, 0, 50, 50))
    with pytest.raises(TypeError, match="bbox is missing"):
        strew.measure(points.xy)


def test_points_stand_on_a_terrain() -> None:
    # The slope goes on beyond the points: normals follow from heights beside them.
    ramp = {"ramp": {"from": [-5, 0], "to": [45, 0]}}
    on_it = strew.points(bbox=(0, 0, 40, 40), spacing=1, terrain=ramp, heights=(50, 550), normals=True, align=1)
    assert np.allclose(on_it["z"], 100 + 10 * on_it.x, atol=1e-3)
    # A slope of 10 to 1 toward x: the normal leans back.
    normal = np.stack([on_it["nx"], on_it["ny"], on_it["nz"]], axis=1)
    assert np.allclose(normal, np.array([-10, 0, 1]) / np.sqrt(101), atol=1e-5)
    turn = np.stack([on_it[name] for name in ("qx", "qy", "qz", "qw")], axis=1)
    assert np.allclose(np.linalg.norm(turn, axis=1), 1, atol=1e-5)


def test_points_are_left_out_by_their_ids() -> None:
    whole = strew.points(bbox=(0, 0, 20, 20), spacing=1)
    gone = [":".join(map(str, id)) for id in whole.ids[[3, 50]]]
    left = strew.points(bbox=(0, 0, 20, 20), spacing=1, except_=gone)
    assert len(left) == len(whole) - 2
    assert set(map(tuple, whole.ids)) - set(map(tuple, left.ids)) == {tuple(id) for id in whole.ids[[3, 50]]}
    with pytest.raises(strew.StrewError, match="except"):
        len(strew.points(bbox=(0, 0, 20, 20), spacing=1, except_=["seven"]))


def test_documents_and_iteration(tmp_path: Path) -> None:
    points = strew.points(**LAYERS)
    for ending, format in (("geojson", "geojson"), ("jsonl", "ndjson"), ("csv.gz", "csv")):
        points.write(tmp_path / f"points.{ending}")
        written = (tmp_path / f"points.{ending}").read_bytes()
        assert (gzip.decompress(written) if "gz" in ending else written) == points.document(format)
    for format in ("csv", "ndjson", "ply", "npy", "f32", "svg", "png"):
        assert points.document(format)
    with pytest.raises(strew.StrewError, match="unknown format"):
        points.document("txt")
    listed = list(points)
    assert [point.x for point in listed] == points.x.tolist()
    assert listed[0].attributes["layer"] == "trees"
    with pytest.raises(KeyError, match="there are id, x, y, layer"):
        points["size"]
    assert points._repr_svg_()
    with pytest.raises(TypeError):
        points.within(box=(0, 0, 1, 1))
    with pytest.raises(strew.StrewError, match="region"):
        len(strew.points(spacing=1))
