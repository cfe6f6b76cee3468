"""One client of several daemons: they are killed, busy, or hold other tables, and every point comes once."""

from __future__ import annotations

import json
import random
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any
from urllib.parse import parse_qsl, urlsplit

import pytest
from conftest import daemon
from test_daemon import same

import strew
from strew._remote import _Answer
from strew._replicas import Replica, Replicas, retry_after

READERS, KILLS = 32, 4
QUERY: dict[str, Any] = {"bbox": (0, 0, 150, 150), "spacing": 1, "attributes": ["angle", "u1"]}


@contextmanager
def daemons(*settings: tuple[str, ...]) -> Iterator[list[str]]:
    """A daemon for each list of settings, and their addresses."""
    running = [daemon(*one) for one in settings]
    try:
        yield [url for _, url in running]
    finally:
        end(running)


def end(running: list[Any]) -> None:
    """Kills daemons."""
    for process, _ in running:
        process.kill()
        process.wait()


def continuations(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Collects after how many rows answers are continued."""
    found: list[int] = []
    rest = _Answer._rest

    def noted(self: _Answer) -> Any:
        query = rest(self)
        if "cursor" in query:
            found.append(query["offset"])
        return query

    monkeypatch.setattr(_Answer, "_rest", noted)
    return found


def test_readers_of_killed_replicas_get_every_point_once(monkeypatch: pytest.MonkeyPatch) -> None:
    continued = continuations(monkeypatch)
    running = [daemon() for _ in range(3)]
    try:
        there = strew.connect(",".join(url for _, url in running))
        read_while_killed(there, running, READERS, KILLS)
    finally:
        end(running)
    assert continued and max(continued) > 0


def read_while_killed(there: strew.Daemon, running: list[Any], number_of_readers: int, kills: int) -> None:
    """Readers compare every point, while one daemon after another is killed and comes back."""
    wanted = [strew.points(**QUERY, seed=seed) for seed in range(4)]
    for points in wanted:
        points.columns()
    is_over = threading.Event()
    failures: list[BaseException] = []
    answers = [0] * number_of_readers

    def read(number: int) -> None:
        seed = number % len(wanted)
        try:
            while not is_over.is_set() or not answers[number]:
                same(wanted[seed], there.points(**QUERY, seed=seed))
                answers[number] += 1
        except BaseException as error:
            failures.append(error)

    readers = [threading.Thread(target=read, args=(number,)) for number in range(number_of_readers)]
    for reader in readers:
        reader.start()
    try:
        for kill in range(kills):
            # Each daemon dies with answers half sent, and is back before the next one dies.
            before, victim = sum(answers), kill % len(running)
            until(lambda: sum(answers) > before + 3 or failures or not any(r.is_alive() for r in readers))
            process, url = running[victim]
            process.kill()
            process.wait()
            running[victim] = daemon(listen=url.removeprefix("http://"))
    finally:
        is_over.set()
        for reader in readers:
            reader.join()
    assert failures == []
    assert min(answers) >= 1


def until(holds: Callable[[], Any]) -> None:
    waited = threading.Event()
    for _ in range(6000):
        if holds():
            return
        waited.wait(0.01)
    raise AssertionError("waited in vain")


class Answering(BaseHTTPRequestHandler):
    """A server that answers with what the test wants, or passes on a part of a daemon's answer and breaks off."""

    protocol_version = "HTTP/1.1"

    def log_message(self, *_: object) -> None:
        pass

    def do_POST(self) -> None:
        body = self.rfile.read(int(self.headers["content-length"]))
        self.server.requests.append(json.loads(body))  # type: ignore[attr-defined]
        self.server.answer(self, body)  # type: ignore[attr-defined]
        self.close_connection = True

    def do_GET(self) -> None:
        pairs = parse_qsl(urlsplit(self.path).query)
        query = {name: int(value) if name in ("offset", "limit") else value for name, value in pairs}
        self.server.requests.append(query)  # type: ignore[attr-defined]
        self.server.answer(self, None)  # type: ignore[attr-defined]
        self.close_connection = True


def refusing(status: int, content: str = "{}", **headers: str) -> Callable[[Any, bytes | None], None]:
    def answer(handler: Any, _: bytes | None) -> None:
        handler.send_response(status)
        for name, value in headers.items():
            handler.send_header(name.replace("_", "-"), value)
        handler.send_header("content-length", str(len(content)))
        handler.end_headers()
        handler.wfile.write(content.encode())

    return answer


def breaking(upstream: str, share: float = 2 / 3) -> Callable[[Any, bytes | None], None]:
    """Answers once with a share of a daemon's answer; later connections break at once."""
    import urllib.request

    answered: list[bytes | None] = []

    def answer(handler: Any, body: bytes | None) -> None:
        if answered:
            return
        answered.append(body)
        with urllib.request.urlopen(urllib.request.Request(upstream + handler.path, body)) as response:
            content = response.read()
            handler.send_response(200)
            for name in ("strew-count", "strew-cursor", "strew-table"):
                handler.send_header(name, response.headers[name])
        handler.send_header("content-length", str(len(content)))
        handler.end_headers()
        handler.wfile.write(content[: int(len(content) * share)])

    return answer


@contextmanager
def serving(answer: Callable[[Any, bytes], None]) -> Iterator[tuple[str, list[Any]]]:
    """A server's address and the requests that it gets."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), Answering)
    server.requests, server.answer = [], answer  # type: ignore[attr-defined]
    threading.Thread(target=server.serve_forever, args=(0.01,), daemon=True).start()
    try:
        yield f"http://127.0.0.1:{server.server_port}", server.requests  # type: ignore[attr-defined]
    finally:
        server.shutdown()
        server.server_close()


def count(there: strew.Daemon, **more: Any) -> int:
    return there.points(**{"bbox": (0, 0, 9, 9), "spacing": 1, **more}).count()


def test_a_busy_daemon_rests_and_others_answer(url: str) -> None:
    with serving(refusing(503, retry_after="600")) as (busy, requests):
        there = strew.connect([busy, url])
        for _ in range(5):
            assert count(there) == count(strew.connect(url))
        assert len(requests) == 1
        # Alone it would be called again only after the client's patience.
        began = time.monotonic()
        with pytest.raises(strew.StrewError, match="HTTP 503"):
            count(strew.connect(busy))
        assert len(requests) == 2 and time.monotonic() - began < 5


def test_refusals_of_a_query_are_not_repeated() -> None:
    problem = '{"type": "urn:strew:problem:invalid-query", "detail": "no", "errors": [{"field": "spacing"}]}'
    for status in (400, 401, 404, 413):
        with serving(refusing(status, problem)) as (one, first), serving(refusing(status, problem)) as (other, second):
            with pytest.raises(strew.StrewError, match="no"):
                count(strew.connect([one, other]))
            assert len(first) + len(second) == 1


def test_attempts_are_bounded() -> None:
    with serving(refusing(503)) as (one, first), serving(refusing(502)) as (other, second):
        with pytest.raises(strew.StrewError, match="HTTP 50"):
            count(strew.connect([one, other], retries=2))
        assert len(first) + len(second) == 6
        with pytest.raises(strew.StrewError, match="HTTP 50"):
            count(strew.connect([one, other], retries=1000, patience=0.3))
        assert len(first) + len(second) < 30


def test_an_address_that_failed_is_left_out_and_tried_again_by_one() -> None:
    one, other = Replica("http://one"), Replica("http://other")
    replicas = Replicas([one, other], retries=3, patience=1)
    assert replicas.take(set())[0] is one and replicas.take(set())[0] is other
    replicas.failed(one)
    replicas.failed(one)
    assert one.failures == 1
    assert {replicas.take(set())[0] for _ in range(9)} == {other}
    one.until = 0
    assert [replicas.take(set())[0] for _ in range(3)] == [one, other, other]
    replicas.answered(one)
    assert replicas.take(set())[0] is one
    pauses = [Replica("", failures=failures).pause() for failures in range(1, 99) for _ in range(9)]
    assert 0.05 <= min(pauses) and max(pauses) <= 5


def test_retry_after_is_a_number_or_a_date() -> None:
    date = time.strftime("%a, %d %b %Y %H:%M:%S GMT", time.gmtime(time.time() + 60))
    assert 50 < retry_after(date) <= 60
    assert [retry_after(text) for text in ("7", "", None, "soon", "Sun, 06 Nov 1994 08:49:37 GMT")] == [7, 0, 0, 0, 0]


def fields(folder: Path, wavelength: int) -> tuple[str, ...]:
    """The settings of a daemon that holds the field `woods`, and the world `forest` in it."""
    folder.mkdir()
    (folder / "woods.json").write_text(json.dumps({"noise": {"wavelength": wavelength}}))
    (folder / "worlds").mkdir()
    (folder / "worlds" / "forest.toml").write_text("spacing = 1\nfield = 'woods'\n")
    return (f"fields.folder={folder}", f"worlds.folder={folder / 'worlds'}")


def test_an_answer_continues_only_where_its_fields_are(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    continued = continuations(monkeypatch)
    ours, theirs = fields(tmp_path / "ours", 30), fields(tmp_path / "theirs", 31)
    query: Any = {"bbox": (0, 0, 200, 200), "spacing": 1, "field": "woods"}
    with daemons(ours, theirs, ours) as (first, other, third):
        whole = strew.connect(first).points(**query)
        with serving(breaking(first)) as (broken, _):
            there = strew.connect([broken, other], retries=1)
            with pytest.raises(strew.StrewError, match="points came, and no other daemon continues.*another table"):
                there.points(**query).columns()
        with serving(breaking(first)) as (broken, _):
            same(whole, strew.connect([broken, other, third]).points(**query))
        assert len(continued) >= 3 and min(continued) > 0
        # Of an answer that breaks off before any point nothing is kept.
        with serving(breaking(first, share=0)) as (broken, _):
            same(strew.connect(other).points(**query), strew.connect([broken, other]).points(**query))
        # The other one has other points.
        assert strew.connect(other).points(**query).xy.tobytes() != whole.xy.tobytes()


def test_pinned_queries_find_the_replica_that_holds_what_they_name(tmp_path: Path) -> None:
    ours, theirs = fields(tmp_path / "ours", 30), fields(tmp_path / "theirs", 31)
    problem = json.dumps({"type": "urn:strew:problem:other-table", "detail": "another table"})
    with daemons(ours, theirs) as (first, other):
        digest = strew.connect(first).json("GET", "/v1/worlds/forest")["digest"]
        world: Any = {"bbox": (0, 0, 40, 40), "world": "forest", "world_digest": digest}
        for urls in ([first, other], [other, first]):
            assert count(strew.connect(urls), **{**world, "spacing": None}) > 100
        with pytest.raises(strew.StrewError, match="this server's is") as refusal:
            count(strew.connect([other, other.replace("127.0.0.1", "localhost")]), **{**world, "spacing": None})
        assert refusal.value.kind == "other-world"
        with serving(refusing(409, problem)) as (upgraded, requests):
            assert count(strew.connect([upgraded, first])) == count(strew.connect(first))
            assert len(requests) == 1


def test_fields_of_arrays_are_known_to_every_replica(url: str) -> None:
    noise = {"noise": {"wavelength": random.randrange(10**6, 10**9)}}
    with daemons((), ()) as urls:
        there = strew.connect(urls)
        for _ in range(6):
            here = strew.points(spacing=1, field=noise)
            assert there.points(spacing=1, field=noise).nearest((3, 4)) == here.nearest((3, 4))


def test_addresses_are_a_list_or_a_text() -> None:
    there = strew.connect("http://a:1, b:2/,http://a:1/")
    assert repr(there) == "http://a:1,http://b:2" == repr(strew.connect(["http://a:1", "http://b:2"]))
    import pickle

    assert repr(pickle.loads(pickle.dumps(there))) == repr(there)
    for wrong in ([], "http://a,,http://b", "http://a,ftp://b"):
        with pytest.raises(ValueError, match="no address"):
            strew.connect(wrong)
