"""Points that a daemon makes, or one of several, over HTTP."""

from __future__ import annotations

import functools
import http.client
import json
import ssl
from collections.abc import Sequence
from typing import Any
from urllib.parse import SplitResult, quote, urlsplit

import numpy as np

from ._columns import Columns, Further, Received
from ._errors import Disconnected, StrewError, refusal
from ._ipc import Batch, Column, Stream
from ._query import PLANE, Body, Dimension, path, text
from ._replicas import Attempts, Elsewhere, Later, Replica, Replicas, retry_after
from ._source import Plan, Source

#: The statuses after which a daemon wants to be called again.
LATER = (429, 502, 503, 504)
#: The seconds that a connection may take, where there is another address.
CONNECTING = 5.0
#: Refusals that depend on what a daemon holds: by their kind, or by the only members that are wrong.
HELD_KINDS = ("other-table", "other-world")
HELD = {"cursor", "except", "field", "profile", "table", "terrain", "world"}


def _parts(url: str) -> SplitResult:
    parts = urlsplit(url if "://" in url else f"http://{url}")
    if parts.scheme not in ("http", "https") or not parts.hostname:
        raise ValueError(f"{url!r} is no address of a daemon; allowed: http://host:port, https://host:port")
    return parts


def _addresses(url: str | Sequence[str]) -> list[str]:
    """Addresses in their plain form, each once."""
    texts = url.split(",") if isinstance(url, str) else list(url)
    parts = [_parts(text.strip()) for text in texts]
    if not parts:
        raise ValueError("no address of a daemon; allowed: http://host:port, https://host:port, or several")
    return list(dict.fromkeys(f"{part.scheme}://{part.netloc}{part.path.rstrip('/')}" for part in parts))


class Daemon(Source):
    """A daemon, or several with the same points; see :func:`connect`."""

    def __init__(
        self,
        url: str | Sequence[str],
        key: str | None,
        timeout: float,
        retries: int,
        verify: str | bool,
        patience: float = 30.0,
    ) -> None:
        urls = _addresses(url)
        #: The address, or several with commas between them.
        self.url = ",".join(urls)
        self._key, self._timeout, self._verify = key, timeout, verify
        self._replicas = Replicas([Replica(url) for url in urls], retries, patience)

    def __repr__(self) -> str:
        return self.url

    def __reduce__(self) -> tuple[Any, ...]:
        replicas = self._replicas
        return Daemon, (self.url, self._key, self._timeout, replicas.retries, self._verify, replicas.patience)

    @functools.cached_property
    def _context(self) -> ssl.SSLContext:
        context = ssl.create_default_context(cafile=self._verify if isinstance(self._verify, str) else None)
        if self._verify is False:
            context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
        return context

    def _connection(self, parts: SplitResult) -> http.client.HTTPConnection:
        is_alone = len(self._replicas.all) == 1
        wait = self._timeout if is_alone else min(self._timeout, CONNECTING)
        host = parts.hostname or ""
        made: http.client.HTTPConnection
        if parts.scheme == "http":
            made = http.client.HTTPConnection(host, parts.port, timeout=wait)
        else:
            made = http.client.HTTPSConnection(host, parts.port, timeout=wait, context=self._context)
        made.connect()
        made.sock.settimeout(self._timeout)
        return made

    def open(self, replica: Replica, method: str, path: str, body: str | None = None) -> http.client.HTTPResponse:
        """The response of a replica, once it is a good one. The connection closes with it."""
        parts = urlsplit(replica.url)
        headers = {"connection": "close"}
        if body is not None:
            headers["content-type"] = "application/json"
        if self._key is not None:
            headers["authorization"] = f"Bearer {self._key}"
        connection = self._connection(parts)
        try:
            connection.request(method, parts.path + path, None if body is None else body.encode(), headers)
        except (BrokenPipeError, ConnectionResetError):
            # A body that is too large is refused before it was read: the refusal says so, and is not tried again.
            if body is None:
                raise
        response = connection.getresponse()
        if response.status == 200:
            self._replicas.answered(replica)
            return response
        with response:
            refusal = _refusal(response, response.read())
        if response.status in LATER:
            raise Later(retry_after(response.headers.get("retry-after")), refusal)
        self._replicas.answered(replica)
        raise Elsewhere(refusal) if _is_about_held(refusal) else refusal

    def open_points(
        self, replica: Replica, query: Body, dimension: Dimension = PLANE
    ) -> http.client.HTTPResponse:
        """The points of a query: by GET if its address is short, because caches keep no answers to POST."""
        short = path(query, dimension)
        if short is not None:
            try:
                return self.open(replica, "GET", short)
            except (StrewError, Elsewhere) as refusal:
                error = refusal.error if isinstance(refusal, Elsewhere) else refusal
                # An invalid query is sent again as a body, to be refused in the words of bodies.
                if error.kind != "invalid-query":
                    raise
        return self.open(replica, "POST", dimension.queries, text(query))

    def read(self, method: str, path: str, body: str | None = None) -> bytes:
        """The content of a response."""
        return self._read(self.attempts(), method, path, body)

    def _read(self, attempts: Attempts, method: str, path: str, body: str | None) -> bytes:
        for attempt in attempts:
            with attempt as replica, self.open(replica, method, path, body) as response:
                return response.read()
        raise AssertionError("the last attempt raises")

    def attempts(self) -> Attempts:
        """Attempts with pauses between them; the last one raises what is wrong."""
        return self._replicas.attempts()

    def json(self, method: str, path: str, body: str | None = None) -> Any:
        return json.loads(self.read(method, path, body))

    def plan(self, query: Body, dimension: Dimension = PLANE) -> Plan:
        return _Asked(self, query, dimension)

    def point(self, id: str, address: str, dimension: Dimension = PLANE) -> dict[str, Any]:
        found: dict[str, Any] = self.json("GET", f"{dimension.root}/points/{quote(id, safe=':')}?{address}")["point"]
        return found

    def nearest(self, address: str, dimension: Dimension = PLANE) -> list[dict[str, Any]]:
        found: list[dict[str, Any]] = self.json("GET", f"{dimension.root}/nearest?{address}")["neighbors"]
        return found

    def hold_field(self, field: Any) -> str:
        """Sends a field to all daemons that can be reached, because any may be called next. Its name is a digest."""
        body, name, error = text(field), "", None
        if len(self._replicas.all) == 1:
            return str(self.json("POST", "/v1/fields", body)["name"])
        for replica in self._replicas.up():
            try:
                only = Attempts(self._replicas, [replica], retries=0)
                name = json.loads(self._read(only, "POST", "/v1/fields", body))["name"]
            except (Disconnected, StrewError) as refusal:
                error = refusal
        if name:
            return name
        if error is not None:
            raise error
        return str(self.json("POST", "/v1/fields", body)["name"])


def connect(
    url: str | Sequence[str],
    *,
    key: str | None = None,
    timeout: float = 60.0,
    retries: int = 3,
    verify: str | bool = True,
    patience: float = 30.0,
) -> Daemon:
    """A daemon, with the functions of this module: ``points``, ``query``, ``stipple``.

    ``key`` is an API key, which is part of pickles. ``timeout`` is how many seconds an answer may pause. ``verify`` may
    be the path of an authority's certificate, or ``False`` for none.

    Code moves from a laptop to a service by one line::

        points = strew.points(bbox=(0, 0, 10, 10), spacing=1)
        points = strew.connect("http://localhost:8080").points(bbox=(0, 0, 10, 10), spacing=1)

    The daemon is called when an answer is needed: :class:`StrewError` is raised then.

    Several replicas are a list of addresses, or one text with commas: ``"http://a:7777,http://b:7777"``. A request goes
    to the one with the fewest requests of this client. An address that refuses connections, breaks off or answers 429,
    502, 503 or 504 is left out, for as long as its ``Retry-After`` says, else for 0.1 to 5 seconds, more with each
    failure; afterwards one request tries it again.

    An answer that breaks off continues where it ended, at any address, by its cursor: every point comes once. Only a
    daemon with the same tables and fields takes that cursor. A request that fails is repeated until each address has
    failed ``retries`` + 1 times in a row, but for at most ``patience`` seconds after the first failure. Refusals of a
    query are raised at once. Those of what a daemon holds (a pinned table, a world, a named field) are raised once all
    addresses refuse.
    """
    return Daemon(url, key, timeout, retries, verify, patience)


def _is_about_held(error: StrewError) -> bool:
    members = {str(fault.get("field", "")).rsplit(".", 1)[-1] for fault in error.faults}
    return error.kind in HELD_KINDS or (bool(members) and members <= HELD)


def _refusal(response: http.client.HTTPResponse, content: bytes) -> StrewError:
    try:
        problem = json.loads(content)
        kind = problem["type"].rsplit(":", 1)[-1]
        return refusal(problem["detail"], kind, problem.get("errors"))
    except (ValueError, KeyError, TypeError):
        shown = content[:200].decode(errors="replace").strip()
        return StrewError(f"HTTP {response.status}: {shown or response.reason}", f"http-{response.status}")


class _Asked:
    """A query of a daemon."""

    def __init__(self, daemon: Daemon, query: Body, dimension: Dimension) -> None:
        self._daemon, self._query, self._dimension = daemon, query, dimension
        self._counted: tuple[int, dict[str, Any]] | None = None
        self._begun: tuple[str | None, list[str]] | None = None

    def _split(self, parts: int) -> str:
        return f"{self._dimension.root}/points:split?parts={quote(str(parts))}"

    def _open(self, replica: Replica, **more: Any) -> http.client.HTTPResponse:
        return self._daemon.open_points(replica, {**self._query, **more}, self._dimension)

    def _body(self, **more: Any) -> str:
        return text({**self._query, **more})

    def _head(self) -> tuple[int, dict[str, Any]]:
        if self._counted is None:
            window = {"offset", "limit", "cursor"} & set(self._query)
            if window:
                # The count of a window comes with its split into one part.
                count = int(self._daemon.json("POST", self._split(1), self._body())["count"])
                one = self._body(format="json", limit=1)
                first = self._daemon.json("POST", self._dimension.queries, one)["query"]
                # These members describe the document, not the points.
                first = {name: first[name] for name in first if name not in ("format", "relative_to", "limit")}
                if "limit" in window:
                    first["limit"] = self._query["limit"]
                self._counted = count, first
            else:
                counted = self._daemon.json("POST", f"{self._dimension.root}/count", self._body())
                self._counted = int(counted["count"]), counted["query"]
        return self._counted

    def count(self) -> int:
        return self._head()[0]

    def query(self) -> dict[str, Any]:
        return dict(self._head()[1])

    def _first(self) -> tuple[str | None, list[str]]:
        if self._begun is None:
            for attempt in self._daemon.attempts():
                with attempt as replica, self._open(replica, format="f32") as response:
                    self._begun = response.headers.get("strew-next"), _tables(response)
                    break
        assert self._begun is not None
        return self._begun

    def tables(self) -> list[str]:
        return self._first()[1]

    def next(self) -> str | None:
        return self._first()[0]

    def split(self, parts: int) -> list[tuple[str, int]]:
        answer = self._daemon.json("POST", self._split(parts), self._body())
        return [(part["query"]["cursor"], int(part["count"])) for part in answer["parts"]]

    def document(self, options: Sequence[tuple[str, str]]) -> bytes:
        given: dict[str, Any] = dict(options)
        for name in ("decimals", "size"):
            if given.get(name, "").isdigit():
                given[name] = int(given[name])
        for attempt in self._daemon.attempts():
            with attempt as replica, self._open(replica, **given) as response:
                return response.read()
        raise AssertionError("the last attempt raises")

    def coordinates(self) -> np.ndarray[Any, np.dtype[np.float64]]:
        return np.asarray(self.columns().at())

    def columns(self) -> Columns:
        answer = _Answer(self._daemon, self._query, self._dimension)
        batches, columns = answer.batches, answer.columns
        ids, at = (_joined([getattr(batch, name) for batch in batches]) for name in ("ids", "at"))
        further = [
            Further(column.name, column.is_optional, _joined([batch.further[i] for batch in batches]), column.names)
            for i, column in enumerate(columns)
        ]
        return Received(len(self._dimension.axes), ids, at, further, answer.origin)


def _tables(response: http.client.HTTPResponse) -> list[str]:
    return (response.headers.get("strew-table") or "").split(", ")


def _joined(arrays: list[np.ndarray[Any, Any]]) -> np.ndarray[Any, Any]:
    made = np.concatenate(arrays)
    made.flags.writeable = False
    return made


class _Answer:
    """The batches of an answer. One that breaks off goes on after the rows that came."""

    def __init__(self, daemon: Daemon, query: Body, dimension: Dimension) -> None:
        self._daemon, self._query, self._dimension = daemon, query, dimension
        self.columns: list[Column] = []
        self.origin: tuple[float, ...] | None = None
        self.batches: list[Batch] = []
        self._rows = 0
        #: How many rows the answer has, and the cursor of its first point.
        self._expected: int | None = None
        self._cursor: str | None = None
        self._read()

    def _read(self) -> None:
        attempts = self._daemon.attempts()
        try:
            for attempt in attempts:
                with attempt as replica:
                    self._attempt(replica, attempts)
                    return
        except StrewError as error:
            if not self._rows:
                raise
            came = f"{self._rows} of {self._expected} points came"
            raise StrewError(f"{came}, and no other daemon continues: {error}", error.kind, error.faults) from None

    def _attempt(self, replica: Replica, attempts: Attempts) -> None:
        if self._cursor is None or not self._rows:
            # Short answers have no cursor: they begin again. So does one of which nothing came.
            self._rows, self._expected, self._cursor, self.batches = 0, None, None, []
        with self._daemon.open_points(replica, self._rest(), self._dimension) as response:
            count = int(response.headers["strew-count"])
            if self._expected is None:
                self._expected, self._cursor = count, response.headers.get("strew-cursor")
                self.origin = _origin(response)
            stream = Stream(_exactly(response), self._dimension.axes)
            if self._rows:
                self._check(count, stream.columns)
            self.columns = stream.columns
            for batch in stream:
                self.batches.append(batch)
                self._rows += len(batch.at)
                if self._cursor is not None:
                    attempts.progress()
        if self._rows > self._expected:
            raise StrewError(f"{self._rows} points came, {self._expected} were announced", "other-answer")
        if self._rows < self._expected:
            raise EOFError(f"{self._rows} of {self._expected} points came")

    def _rest(self) -> Body:
        """The query of the rows that are left. The order is fixed, so they are known by their place."""
        rest = {**self._query, "format": "arrow"}
        if self._rows:
            rest["cursor"], rest["offset"] = self._cursor, self._rows
            if "limit" in self._query:
                rest["limit"] = self._query["limit"] - self._rows
        return rest

    def _check(self, count: int, columns: list[Column]) -> None:
        same = [column.name for column in columns] == [column.name for column in self.columns]
        if self._rows + count != self._expected or not same:
            raise StrewError(f"the answer has {count} points in other columns or of another number", "other-answer")


def _origin(response: http.client.HTTPResponse) -> tuple[float, ...] | None:
    origin = response.headers.get("strew-origin")
    return None if origin is None else tuple(map(float, origin.split(",")))


def _exactly(response: http.client.HTTPResponse) -> Any:
    def read(count: int) -> bytes:
        data = response.read(count) if count else b""
        if len(data) != count:
            raise EOFError("the answer broke off")
        return data

    return read
