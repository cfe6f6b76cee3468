"""A real daemon for the tests: ``STREW_BIN``, or the debug build of this repository."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import strew

ROOT = Path(__file__).resolve().parents[3]


def program() -> str:
    """The program ``strew``."""
    path = os.environ.get("STREW_BIN") or str(ROOT / "target/debug/strew")
    if not Path(path).exists():
        pytest.skip(f"{path} is not built: cargo build")
    return path


def daemon(*settings: str, listen: str = "127.0.0.1:0") -> tuple[subprocess.Popen[str], str]:
    """A daemon, on a free port if none is named, and its address."""
    flags = [flag for setting in settings for flag in ("--set", setting)]
    environment = {name: value for name, value in os.environ.items() if not name.startswith("STREW_")}
    process = subprocess.Popen(
        [program(), "serve", "--listen", listen, *flags],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        env=environment,
    )
    assert process.stdout is not None
    line = process.stdout.readline()
    assert line.startswith("listening on "), line
    return process, line.removeprefix("listening on ").strip()


def assert_equal(found: Any, points: strew.PointSet) -> None:
    """Fails unless a table has the rows of a set, bit for bit, in any order."""
    import pyarrow as pa

    wanted = pa.table(points).cast(found.schema).replace_schema_metadata(None)
    order = [(name, "ascending") for name in ("layer", "id") if name in found.column_names]
    assert found.num_rows == wanted.num_rows
    assert found.replace_schema_metadata(None).sort_by(order).equals(wanted.sort_by(order))


@pytest.fixture(scope="session")
def url() -> Iterator[str]:
    process, address = daemon()
    yield address
    process.terminate()
    process.wait()


@pytest.fixture(scope="session")
def remote(url: str) -> strew.Daemon:
    return strew.connect(url)
