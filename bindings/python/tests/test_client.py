"""The client without the native part: installed by itself into an empty environment, with the points of a daemon."""

from __future__ import annotations

import subprocess
import venv
from pathlib import Path

import numpy as np
import pytest
from test_points import LAYERS

import strew

FOLDER = Path(__file__).resolve().parents[1]

PROGRAM = """
import sys, importlib.util
import numpy as np
import strew
assert importlib.util.find_spec("strew._strew") is None, strew.__file__
daemon = strew.connect(sys.argv[1])
points = daemon.points(bbox=(0, 0, 50, 50), spacing=1, seed=3, attributes=["angle", "variant"], variants={"oak": 2, "fir": 1})
np.savez(sys.argv[2], ids=points.ids, xy=points.xy, angle=points["angle"], variant=points["variant"])
assert points[3].id == points["id"][3] and len(points.split(3)) == 3
assert len(daemon.space.points(ball=(0, 0, 0, 5), spacing=1).xyz)
assert len(daemon.stipple(np.tile(np.linspace(0, 1, 32), (32, 1)), 100)) == 100
for made in (lambda: strew.points(bbox=(0, 0, 1, 1), spacing=1), lambda: strew.measure(points), lambda: strew.mask(32)):
    try:
        made()
    except ImportError as error:
        assert "strew.connect(url)" in str(error), error
    else:
        raise AssertionError("made without the native part")
if importlib.util.find_spec("pyarrow"):
    import pyarrow
    assert pyarrow.table(points).num_rows == len(points)
    print(pyarrow.table(points).schema.to_string(show_schema_metadata=False))
"""


def test_the_client_talks_with_a_daemon(url: str, tmp_path: Path) -> None:
    home = tmp_path / "venv"
    venv.create(home, with_pip=True)
    python = home / "bin/python"
    # A copy, because setuptools writes beside its sources.
    source = tmp_path / "source"
    for file in [*FOLDER.glob("strew/*.py*"), *FOLDER.glob("strew/py.typed"), *FOLDER.glob("client/*.*")]:
        copy = source / file.relative_to(FOLDER)
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_bytes(file.read_bytes())
    install = [python, "-m", "pip", "install", "-q", str(source / "client")]
    done = subprocess.run(install, capture_output=True, text=True)
    if done.returncode and ("No matching distribution" in done.stderr or "connection" in done.stderr.lower()):
        pytest.skip("pip has no index")
    assert done.returncode == 0, done.stderr
    saved = tmp_path / "points.npz"
    run = subprocess.run([python, "-c", PROGRAM, url, saved], capture_output=True, text=True, cwd=tmp_path, env={})
    assert run.returncode == 0, run.stderr
    here = strew.points(
        bbox=(0, 0, 50, 50), spacing=1, seed=3, attributes=["angle", "variant"], variants={"oak": 2, "fir": 1}
    )
    with np.load(saved) as there:
        assert there["ids"].tobytes() == here.ids.tobytes() and there["xy"].tobytes() == here.xy.tobytes()
        assert there["angle"].tobytes() == here["angle"].tobytes()
        assert there["variant"].tolist() == here["variant"].tolist()


def test_arrow_of_the_client_is_that_of_the_native_part(remote: strew.Daemon, monkeypatch: pytest.MonkeyPatch) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    points = remote.points(**LAYERS)
    native = pyarrow.table(points)
    monkeypatch.setattr("strew._columns.is_there", lambda: False)
    plain = pyarrow.table(points)
    assert plain.schema.equals(native.schema, check_metadata=True)
    assert plain.to_pylist() == native.to_pylist()


def test_versions_are_one() -> None:
    assert strew.__version__ == strew._local.native().__version__


def test_a_refusal_of_a_large_body_is_read(url: str) -> None:
    box = (0, 0, 2000, 2000)
    field = strew.raster(np.random.default_rng(1).random((2300, 2300)), bbox=box)
    for _ in range(5):
        with pytest.raises(strew.StrewError, match="bytes, the limit of this server"):
            strew.connect(url).points(bbox=box, spacing=1, field=field).count()
