"""A daemon or several: one request more where an address fails, errors that say so, and never a shorter set."""

from __future__ import annotations

import pickle
import threading
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

import pytest
from conftest import daemon
from test_daemon import same

import strew

#: No server listens there.
NOWHERE = "http://127.0.0.1:9"
QUERY: dict[str, Any] = {"bbox": (0, 0, 300, 300), "spacing": 1, "seed": 4, "attributes": ["angle"]}
Answer = Callable[["Answering", "bytes | None"], None]


class Answering(BaseHTTPRequestHandler):
    """A server that answers as the test wants."""

    protocol_version = "HTTP/1.1"

    def log_message(self, *_: object) -> None:
        pass

    def do_GET(self) -> None:
        length = self.headers["content-length"]
        body = None if length is None else self.rfile.read(int(length))
        self.server.requests.append(self.path)  # type: ignore[attr-defined]
        self.server.answer(self, body)  # type: ignore[attr-defined]
        self.close_connection = True

    do_POST = do_GET


@contextmanager
def serving(answer: Answer) -> Iterator[tuple[str, list[str]]]:
    """A server's address and the requests that it gets."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), Answering)
    server.requests, server.answer = [], answer  # type: ignore[attr-defined]
    threading.Thread(target=server.serve_forever, args=(0.01,), daemon=True).start()
    try:
        yield f"http://127.0.0.1:{server.server_port}", server.requests  # type: ignore[attr-defined]
    finally:
        server.shutdown()
        server.server_close()


def refusing(status: int, content: str = "busy", **headers: str) -> Answer:
    def answer(handler: Answering, _: bytes | None) -> None:
        handler.send_response(status)
        for name, value in {**headers, "content-length": str(len(content))}.items():
            handler.send_header(name.replace("_", "-"), value)
        handler.end_headers()
        handler.wfile.write(content.encode())

    return answer


def passing(upstream: str, share: float, more: int = 0) -> Answer:
    """Sends this share of a daemon's answer, whose head states ``more`` points."""

    def answer(handler: Answering, body: bytes | None) -> None:
        with urllib.request.urlopen(urllib.request.Request(upstream + handler.path, body)) as response:
            content = response.read()
            handler.send_response(200)
            handler.send_header("strew-count", str(int(response.headers["strew-count"] or 0) + more))
        handler.send_header("content-length", str(len(content)))
        handler.end_headers()
        handler.wfile.write(content[: int(len(content) * share)])

    return answer


@pytest.fixture
def waits(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """The waits between attempts, which take no time."""
    found: list[float] = []
    monkeypatch.setattr("strew._remote.sleep", found.append)
    return found


def count(there: strew.Daemon) -> int:
    return there.points(bbox=(0, 0, 9, 9), spacing=1).count()


def test_requests_go_on_at_the_next_address_and_stay_there(url: str, waits: list[float]) -> None:
    wanted = count(strew.connect(url))
    with serving(refusing(503, retry_after="2")) as (busy, requests):
        there = strew.connect([busy, NOWHERE, url])
        with pytest.raises(strew.Disconnected, match=f"^{busy}: HTTP 503: busy; {NOWHERE}: .*refused"):
            count(there)
        assert [count(there) for _ in range(5)] == [wanted] * 5
        assert len(requests) == 1 and waits == [2]
        assert count(strew.connect([NOWHERE, url])) == wanted


@pytest.mark.parametrize(("stated", "wait"), [("0", 0), ("3", 3), ("600", 5), ("Sun, 06 Nov 2094 08:49:37 GMT", 5)])
def test_one_address_is_tried_twice(waits: list[float], stated: str, wait: float) -> None:
    problem = '{"type": "urn:strew:problem:busy", "detail": "later"}'
    with serving(refusing(503, problem, retry_after=stated)) as (busy, requests):
        with pytest.raises(strew.StrewError, match=f"^{busy}: later$") as raised:
            count(strew.connect(busy))
        assert raised.value.kind == "busy" and len(requests) == 2 and waits == [wait]
    with pytest.raises(strew.Disconnected, match=f"^{NOWHERE}: [^;]*$"):
        count(strew.connect(NOWHERE))


@pytest.mark.parametrize("status", [400, 401, 404, 409, 413, 429, 500, 502, 503, 504])
def test_refusals_are_not_repeated(status: int) -> None:
    later = {"retry_after": "1"} if status != 503 else {}
    with serving(refusing(status, "no", **later)) as (one, first), serving(refusing(200, "{}")) as (other, second):
        with pytest.raises(strew.StrewError, match=f"^HTTP {status}: no$"):
            count(strew.connect([one, other]))
        assert (len(first), len(second)) == (1, 0)


@pytest.mark.parametrize(("share", "more"), [(0, 0), (0.1, 0), (2 / 3, 0), (0.9999, 0), (1, 1), (1, -1)])
def test_an_answer_that_breaks_off_is_an_error(url: str, share: float, more: int) -> None:
    with serving(passing(url, share, more)) as (broken, requests):
        points = strew.connect([broken, url]).points(**QUERY)
        readings: list[Callable[[], Any]] = [points.columns]
        if not more:
            readings += [points.count, lambda: points.document("csv"), lambda: points.nearest((3, 4))]
        for reading in readings:
            with pytest.raises(strew.Disconnected, match=f"^{broken}: the answer broke off: .*"):
                reading()
        # No answer is begun again.
        assert len(requests) == len(readings)


def test_pages_continue_from_the_cursor_of_the_last_one(url: str) -> None:
    whole = strew.points(**QUERY)
    process, dying = daemon()
    try:
        there = strew.connect([dying, url])
        cursor, pages = None, []
        while not pages or cursor:
            page = there.points(**QUERY, limit=20_000, cursor=cursor)
            page.columns()
            pages.append(page)
            cursor = page.next
            process.kill()
            process.wait()
    finally:
        process.kill()
        process.wait()
    assert len(pages) == 5
    assert b"".join(page.ids.tobytes() for page in pages) == whole.ids.tobytes()
    assert b"".join(page.xy.tobytes() for page in pages) == whole.xy.tobytes()


def test_fields_of_arrays_are_known_where_they_are_needed(url: str) -> None:
    noise = {"noise": {"wavelength": 123.25}}
    there = strew.connect([NOWHERE, url])
    assert there.points(spacing=1, field=noise).nearest((3, 4)) == strew.points(spacing=1, field=noise).nearest((3, 4))
    same(strew.points(**QUERY, field=noise), there.points(**QUERY, field=noise))


def test_addresses_are_a_list_or_a_text() -> None:
    there = strew.connect("http://a:1, b:2/,http://a:1/")
    assert repr(there) == "http://a:1,http://b:2" == repr(strew.connect(["http://a:1", "http://b:2"]))
    assert repr(pickle.loads(pickle.dumps(there))) == repr(there)
    for wrong in ([], "http://a,,http://b", "http://a,ftp://b"):
        with pytest.raises(ValueError, match="no address"):
            strew.connect(wrong)
