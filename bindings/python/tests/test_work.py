"""Long calls: Ctrl-C ends them, whoever asks follows them, and their limits can be raised."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from time import monotonic
from typing import Any

import numpy as np
import pytest

import strew

NOISE = np.random.default_rng(1).random((2000, 2000))
FIELD: Any = {"noise": {"wavelength": 30}}
EVEN: Any = {"map": "l", "attributes": "variant", "variants": {"a": 1, "b": 2.7, "c": 3.1}, "spread": "even"}
#: Calls of a second and more, of up to 3 GB.
LONG: dict[str, Callable[[], Any]] = {
    "coordinates": lambda: strew.points(bbox=(0, 0, 12e3, 12e3), spacing=1, seed=1).xy,
    "columns": lambda: strew.points(bbox=(0, 0, 6e3, 6e3), spacing=1, seed=1, attributes="angle").columns(),
    "fields": lambda: strew.points(bbox=(0, 0, 8e3, 8e3), spacing=1, seed=1, field=FIELD).xy,
    "counts": lambda: strew.points(bbox=(0, 0, 4e4, 4e4), spacing=1, seed=1, field=FIELD).count(),
    "labels": lambda: strew.points(bbox=(0, 0, 9, 9), spacing=1, **EVEN),
    "documents": lambda: strew.points(bbox=(0, 0, 1e4, 1e4), spacing=1, seed=1).document("geojson"),
    "masks": lambda: strew.mask(1024),
    "measures": lambda: strew.measure(NOISE.reshape(-1, 2)[:400_000], bbox=(0, 0, 1, 1)),
    "pictures": lambda: strew.stipple(NOISE, 1_000_000).xy,
    "space": lambda: strew.space.points(bbox=(0, 0, 0, 400, 400, 400), spacing=1, seed=1).xyz,
}


#: A process that is interrupted in a call. The thread that does the work ends, too.
CHILD = """
import os, signal, sys, strew, test_work
signal.signal(signal.SIGINT, signal.default_int_handler)
strew.limits(rows=10**12)
strew.measure(test_work.NOISE.reshape(-1, 2)[:1000], bbox=(0, 0, 1, 1))
threads = lambda: len(os.listdir("/proc/self/task"))
before = threads()
try:
    with strew.progress(lambda *at: print("begun", flush=True)):
        test_work.LONG[sys.argv[1]]()
except KeyboardInterrupt:
    print("interrupted", flush=True)
while threads() >= before:
    os.sched_yield()
print(len(strew.points(bbox=(0, 0, 10, 10), spacing=1, seed=7).xy), "points")
"""


@pytest.fixture
def limits() -> Iterator[dict[str, int]]:
    before = strew.limits()
    yield before
    strew.limits(**before)


@pytest.mark.skipif(sys.platform != "linux", reason="threads are counted in /proc")
@pytest.mark.parametrize("kind", LONG)
def test_an_interrupt_ends_a_call_and_its_work(kind: str) -> None:
    command = [sys.executable, "-c", CHILD, kind]
    said: list[tuple[str, float]] = []
    with subprocess.Popen(command, cwd=Path(__file__).parent, stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout and child.stdout.readline() == "begun\n"
        child.send_signal(signal.SIGINT)
        sent = monotonic()
        said.extend((line.strip(), monotonic() - sent) for line in child.stdout if line != "begun\n")
    assert [line for line, _ in said] == ["interrupted", "100 points"]
    assert all(time < 3 for _, time in said), f"a second, on a busy machine: {said}"


def test_progress_is_followed() -> None:
    seen: list[tuple[int, int | None]] = []
    points = strew.points(bbox=(0, 0, 3e3, 3e3), spacing=1, seed=1)
    with strew.progress(lambda *at: seen.append(at)):
        points.xy
    assert seen and seen == sorted(seen) and {total for _, total in seen} == {len(points)}
    assert 0 < seen[-1][0] <= len(points)
    count = len(seen)
    points.columns()
    assert len(seen) == count, "only within the statement"

    def full(points: int, total: int | None) -> None:
        raise BufferError("full")

    with strew.progress(full), pytest.raises(BufferError):
        strew.mask(1024)


def test_a_terminal_has_a_line_of_progress(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    for is_terminal in (False, True):
        monkeypatch.setattr(sys.stderr, "isatty", lambda: is_terminal)
        with strew.progress():
            strew.points(bbox=(0, 0, 3e3, 3e3), spacing=1, seed=1).xy
        assert (" % of 8999978" in capsys.readouterr().err) == is_terminal


@pytest.mark.parametrize(
    ("limit", "call"),
    [
        ({"points": 50}, lambda: strew.points(bbox=(0, 0, 10, 10), spacing=1).xy),
        ({"points": 50}, lambda: strew.space.points(bbox=(0, 0, 0, 10, 10, 10), count=99)),
        ({"rows": 50}, lambda: strew.points(bbox=(0, 0, 99, 99), spacing=1, field=FIELD)),
        ({"rows": 5000}, lambda: strew.stipple(NOISE[:9, :9], 400)),
        ({"vertices": 3}, lambda: strew.points(polygon=[(0, 0), (9, 0), (0, 9)], spacing=1)),
        ({"pixels": 80}, lambda: strew.points(bbox=(0, 0, 9, 9), spacing=1, field=strew.raster(NOISE[:9, :9]))),
    ],
)
def test_limits_can_be_raised(limit: dict[str, int], call: Callable[[], Any], limits: dict[str, int]) -> None:
    [name] = limit
    assert strew.limits(**limit) == {**limits, **limit}
    with pytest.raises(strew.StrewError, match=rf"strew.limits\({name}=…\)"):
        call()
    strew.limits(**{name: 10**7})
    call()
    with pytest.raises(strew.StrewError, match=f"`{name}` = `0`: out of range"):
        strew.limits(**{name: 0})
