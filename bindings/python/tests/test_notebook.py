"""The notebook and the examples run."""

from __future__ import annotations

import doctest
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

FOLDER = Path(__file__).resolve().parents[1]


def test_the_notebook_runs() -> None:
    notebook = json.loads((FOLDER / "notebooks/points.ipynb").read_text())
    names: dict[str, Any] = {"__name__": "notebook"}
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert len(cells) >= 5
    for cell in cells:
        exec(compile("".join(cell["source"]), "points.ipynb", "exec"), names)


def test_the_readme_is_true() -> None:
    result = doctest.testfile(str(FOLDER / "README.md"), module_relative=False)
    assert result.attempted > 10 and not result.failed


def test_the_page_for_python_is_true(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    docs = FOLDER.parents[1] / "docs"
    monkeypatch.chdir(tmp_path)
    result = doctest.testfile(str(docs / "python.md"), module_relative=False)
    assert result.attempted >= 10 and not result.failed
    kept = (docs / "pictures/trades/ramp.png").read_bytes()
    assert (tmp_path / "ramp.png").read_bytes() == kept


def test_the_comparison_runs() -> None:
    command = [sys.executable, FOLDER / "examples/compare.py", "--points", "400"]
    run = subprocess.run(command, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    assert "Bridson" in run.stdout


@pytest.mark.parametrize("module", ["", *"_errors _fields _local _mask _measure _points _progress _query _source _space".split()])
def test_examples_of_the_documentation(module: str) -> None:
    import importlib

    result = doctest.testmod(importlib.import_module(f"strew.{module}" if module else "strew"))
    assert not result.failed
