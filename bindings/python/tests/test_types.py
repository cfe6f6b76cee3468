"""What checkers of types refuse is what is refused when it runs."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

CALLS = Path(__file__).with_name("calls.py")


@pytest.mark.parametrize("checker", ["mypy", "pyright"])
def test_calls_are_refused_where_they_are_wrong(checker: str, tmp_path: Path) -> None:
    if checker == "mypy":
        pytest.importorskip("mypy")
        command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", tmp_path, CALLS]
    else:
        program = shutil.which("pyright") or pytest.skip("pyright is not installed")
        command = [program, "--pythonpath", sys.executable, CALLS]
    # Away from the settings of this package, as its users run it.
    package = str(CALLS.parents[1])
    environment = {**os.environ, "MYPYPATH": package, "PYTHONPATH": package}
    run = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, env=environment)
    found = {int(line) for line in re.findall(r"calls\.py:(\d+)(?::\d+)?(?: -)?:? error", run.stdout)}
    lines = CALLS.read_text().splitlines()
    assert found == {i for i, line in enumerate(lines, 1) if line.endswith("# refused")}, run.stdout + run.stderr
