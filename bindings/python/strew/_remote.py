"""Points that a daemon makes, or one of several, over HTTP.

A request goes to the address that answered last, and is sent once more to the next one. Nothing else is kept of
addresses: balancing, health and longer retries are what proxies are for.
"""

from __future__ import annotations

import functools
import http.client
import json
import ssl
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from time import sleep
from typing import Any
from urllib.parse import SplitResult, quote, urlsplit

import numpy as np

from ._columns import Columns, Further, Received
from ._errors import Disconnected, StrewError, refusal
from ._ipc import Stream
from ._query import PLANE, Body, Dimension, path, text
from ._source import Plan, Source

#: What breaks a connection or an answer.
BROKEN = (OSError, http.client.HTTPException, EOFError)
#: The seconds that a connection may take, and the longest wait for ``Retry-After``.
PATIENCE = 5


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

    def __init__(self, url: str | Sequence[str], key: str | None, timeout: float, verify: str | bool) -> None:
        self._urls = _addresses(url)
        #: The address, or several with commas between them.
        self.url = ",".join(self._urls)
        self._key, self._timeout, self._verify = key, timeout, verify
        #: Which address the next request goes to.
        self._place = 0

    def __repr__(self) -> str:
        return self.url

    def __reduce__(self) -> tuple[Any, ...]:
        return Daemon, (self.url, self._key, self._timeout, self._verify)

    @functools.cached_property
    def _context(self) -> ssl.SSLContext:
        context = ssl.create_default_context(cafile=self._verify if isinstance(self._verify, str) else None)
        if self._verify is False:
            context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
        return context

    def _connection(self, parts: SplitResult) -> http.client.HTTPConnection:
        wait = min(self._timeout, PATIENCE)
        host = parts.hostname or ""
        made: http.client.HTTPConnection
        if parts.scheme == "http":
            made = http.client.HTTPConnection(host, parts.port, timeout=wait)
        else:
            made = http.client.HTTPSConnection(host, parts.port, timeout=wait, context=self._context)
        made.connect()
        made.sock.settimeout(self._timeout)
        return made

    def _response(self, url: str, method: str, path: str, body: str | None) -> http.client.HTTPResponse:
        """The response of an address. The connection closes with it."""
        parts = urlsplit(url)
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
        return connection.getresponse()

    def open(
        self, method: str, path: str, body: str | None = None
    ) -> AbstractContextManager[http.client.HTTPResponse]:
        """A good response, for a ``with`` statement. A request without an answer is sent once more."""
        tried: list[str] = []
        while True:
            place, error = self._place, None
            url = self._urls[place]
            try:
                response = self._response(url, method, path, body)
                if response.status == 200:
                    return _whole(url, response)
                with response:
                    error = _refusal(response, response.read())
                wait = response.headers.get("retry-after")
                if response.status != 503 or wait is None:
                    raise error
                why = str(error)
            except BROKEN as broken:
                wait, why = "0", _why(broken)
            self._place = (place + 1) % len(self._urls)
            tried.append(f"{url}: {why}")
            if len(tried) == 2:
                words = "; ".join(dict.fromkeys(tried))
                raise StrewError(words, error.kind) if error else Disconnected(words)
            sleep(min(int(wait), PATIENCE) if wait.isdecimal() else PATIENCE)

    def open_points(
        self, query: Body, dimension: Dimension = PLANE
    ) -> AbstractContextManager[http.client.HTTPResponse]:
        """The points of a query: by GET if its address is short, because caches keep no answers to POST."""
        short = path(query, dimension)
        if short is not None:
            try:
                return self.open("GET", short)
            except StrewError as error:
                # An invalid query is sent again as a body, to be refused in the words of bodies.
                if error.kind != "invalid-query":
                    raise
        return self.open("POST", dimension.queries, text(query))

    def read(self, method: str, path: str, body: str | None = None) -> bytes:
        """The content of a response."""
        with self.open(method, path, body) as response:
            return response.read()

    def json(self, method: str, path: str, body: str | None = None) -> Any:
        return json.loads(self.read(method, path, body))

    def plan(self, query: Body, dimension: Dimension = PLANE) -> Plan:
        return Asked(self, query, dimension)

    def point(self, id: str, address: str, dimension: Dimension = PLANE) -> dict[str, Any]:
        found: dict[str, Any] = self.json("GET", f"{dimension.root}/points/{quote(id, safe=':')}?{address}")["point"]
        return found

    def nearest(self, address: str, dimension: Dimension = PLANE) -> list[dict[str, Any]]:
        found: list[dict[str, Any]] = self.json("GET", f"{dimension.root}/nearest?{address}")["neighbors"]
        return found

    def hold_field(self, field: Any) -> str:
        return str(self.json("POST", "/v1/fields", text(field))["name"])


def connect(
    url: str | Sequence[str],
    *,
    key: str | None = None,
    timeout: float = 60.0,
    verify: str | bool = True,
) -> Daemon:
    """A daemon, with the functions of this module: ``points``, ``query``, ``stipple``.

    ``key`` is an API key, which is part of pickles. ``timeout`` is how many seconds an answer may pause. ``verify`` may
    be the path of an authority's certificate, or ``False`` for none.

    Code moves from a laptop to a service by one line::

        points = strew.points(bbox=(0, 0, 10, 10), spacing=1)
        points = strew.connect("http://localhost:8080").points(bbox=(0, 0, 10, 10), spacing=1)

    The daemon is called when an answer is needed: :class:`StrewError` is raised then.

    Several replicas are a list of addresses, or one text with commas: ``"http://a:7777,http://b:7777"``. A request goes
    to the address that answered last. If the connection fails, or the answer is 503 with ``Retry-After``, it is sent
    once more after that time, at most 5 seconds: to the next address, or to the only one. Then an error names every
    address tried and why. All other refusals are raised at once. A connection may take 5 seconds.

    An answer that breaks off raises :class:`Disconnected`; a set is never shorter than it should be. To continue where
    long reading ended, read pages (``limit=``), each with ``cursor=`` the :attr:`PointSet.next` of the one before.
    """
    return Daemon(url, key, timeout, verify)


@contextmanager
def _whole(url: str, response: http.client.HTTPResponse) -> Iterator[http.client.HTTPResponse]:
    """A response while it is read. What breaks it off is an error that says so."""
    try:
        with response:
            yield response
    except BROKEN as broken:
        raise Disconnected(f"{url}: the answer broke off: {_why(broken)}") from broken


def _why(error: Exception) -> str:
    return str(error) or type(error).__name__


def _refusal(response: http.client.HTTPResponse, content: bytes) -> StrewError:
    try:
        problem = json.loads(content)
        kind = problem["type"].rsplit(":", 1)[-1]
        return refusal(problem["detail"], kind, problem.get("errors"))
    except (ValueError, KeyError, TypeError):
        shown = content[:200].decode(errors="replace").strip()
        return StrewError(f"HTTP {response.status}: {shown or response.reason}", f"http-{response.status}")


class Asked:
    """A query of a daemon."""

    def __init__(self, daemon: Daemon, query: Body, dimension: Dimension) -> None:
        self._daemon, self._query, self._dimension = daemon, query, dimension
        self._counted: tuple[int, dict[str, Any]] | None = None
        self._begun: tuple[str | None, list[str]] | None = None

    def _split(self, parts: int) -> str:
        return f"{self._dimension.root}/points:split?parts={quote(str(parts))}"

    def _open(self, **more: Any) -> AbstractContextManager[http.client.HTTPResponse]:
        return self._daemon.open_points({**self._query, **more}, self._dimension)

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
            with self._open(format="f32") as response:
                tables = (response.headers.get("strew-table") or "").split(", ")
                self._begun = response.headers.get("strew-next"), tables
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
        with self._open(**given) as response:
            return response.read()

    def coordinates(self) -> np.ndarray[Any, np.dtype[np.float64]]:
        return np.asarray(self.columns().at())

    def columns(self) -> Columns:
        with self._open(format="arrow") as response:
            stream = Stream(_exactly(response), self._dimension.axes)
            batches, columns = list(stream), stream.columns
            came, expected = sum(len(batch.at) for batch in batches), int(response.headers["strew-count"])
            if came != expected:
                raise EOFError(f"{came} of {expected} points came")
        ids, at = (_joined([getattr(batch, name) for batch in batches]) for name in ("ids", "at"))
        further = [
            Further(column.name, column.is_optional, _joined([batch.further[i] for batch in batches]), column.names)
            for i, column in enumerate(columns)
        ]
        return Received(len(self._dimension.axes), ids, at, further, _origin(response))


def _joined(arrays: list[np.ndarray[Any, Any]]) -> np.ndarray[Any, Any]:
    made = np.concatenate(arrays)
    made.flags.writeable = False
    return made


def _origin(response: http.client.HTTPResponse) -> tuple[float, ...] | None:
    origin = response.headers.get("strew-origin")
    return None if origin is None else tuple(map(float, origin.split(",")))


def _exactly(response: http.client.HTTPResponse) -> Any:
    def read(count: int) -> bytes:
        data = response.read(count) if count else b""
        if len(data) != count:
            raise EOFError(f"{len(data)} of {count} bytes came")
        return data

    return read
