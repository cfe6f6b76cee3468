"""Points that a daemon makes, over HTTP."""

from __future__ import annotations

import http.client
import json
import ssl
import time
from collections.abc import Iterator, Sequence
from typing import Any
from urllib.parse import quote, urlsplit

import numpy as np

from ._errors import Disconnected, StrewError
from ._ipc import Batch, Column, Stream
from ._query import Body, text
from ._source import Plan, Source
from ._strew import Columns

#: What breaks a connection: the same request is worth another try.
BROKEN = (OSError, http.client.HTTPException, EOFError)
#: The statuses after which a daemon wants to be asked again.
LATER = (429, 502, 503, 504)


class Daemon(Source):
    """A daemon; see :func:`connect`."""

    def __init__(self, url: str, key: str | None, timeout: float, retries: int, verify: str | bool) -> None:
        parts = urlsplit(url if "://" in url else f"http://{url}")
        if parts.scheme not in ("http", "https") or not parts.hostname:
            raise ValueError(f"{url!r} is no address of a daemon; allowed: http://host:port, https://host:port")
        self.url = f"{parts.scheme}://{parts.netloc}{parts.path.rstrip('/')}"
        self._host, self._port, self._path = parts.hostname, parts.port, parts.path.rstrip("/")
        self._key, self._timeout, self._retries, self._verify = key, timeout, retries, verify

    def __repr__(self) -> str:
        return self.url

    def __reduce__(self) -> tuple[Any, ...]:
        return Daemon, (self.url, self._key, self._timeout, self._retries, self._verify)

    def _connection(self) -> http.client.HTTPConnection:
        if self.url.startswith("http:"):
            return http.client.HTTPConnection(self._host, self._port, timeout=self._timeout)
        context = ssl.create_default_context(cafile=self._verify if isinstance(self._verify, str) else None)
        if self._verify is False:
            context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
        return http.client.HTTPSConnection(self._host, self._port, timeout=self._timeout, context=context)

    def open(self, method: str, path: str, body: str | None = None) -> http.client.HTTPResponse:
        """The response to a request, once it is a good one. The connection closes with it."""
        headers = {"connection": "close"}
        if body is not None:
            headers["content-type"] = "application/json"
        if self._key is not None:
            headers["authorization"] = f"Bearer {self._key}"
        connection = self._connection()
        connection.request(method, self._path + path, None if body is None else body.encode(), headers)
        response = connection.getresponse()
        if response.status == 200:
            return response
        with response:
            content = response.read()
            if response.status in LATER:
                wait = response.headers.get("retry-after", "")
                raise _Later(float(wait) if wait.isdigit() else 0.0, _refusal(response, content))
            raise _refusal(response, content)

    def read(self, method: str, path: str, body: str | None = None) -> bytes:
        """The content of a response."""
        for attempt in self.attempts():
            with attempt, self.open(method, path, body) as response:
                return response.read()
        raise AssertionError("the last attempt raises")

    def attempts(self) -> Iterator[_Attempt]:
        """Attempts with pauses between them; the last one raises what is wrong."""
        for left in range(self._retries, -1, -1):
            attempt = _Attempt(self.url, left, self._retries)
            yield attempt
            time.sleep(attempt.pause)

    def json(self, method: str, path: str, body: str | None = None) -> Any:
        return json.loads(self.read(method, path, body))

    def plan(self, query: Body) -> Plan:
        return _Asked(self, query)

    def point(self, id: str, address: str) -> dict[str, Any]:
        found: dict[str, Any] = self.json("GET", f"/v1/points/{quote(id, safe=':')}?{address}")["point"]
        return found

    def nearest(self, address: str) -> list[dict[str, Any]]:
        found: list[dict[str, Any]] = self.json("GET", f"/v1/nearest?{address}")["neighbors"]
        return found

    def hold_field(self, field: Any) -> str:
        name: str = self.json("POST", "/v1/fields", text(field))["name"]
        return name


def connect(
    url: str, *, key: str | None = None, timeout: float = 60.0, retries: int = 3, verify: str | bool = True
) -> Daemon:
    """A daemon, with the functions of this module: ``points``, ``query``, ``stipple``.

    An answer that breaks off is taken up where it ended. A request is repeated up to ``retries`` times while the daemon cannot be reached or says that it is busy. ``key`` is an API key, which is part
    of pickles. ``verify`` may be the path of an authority's certificate, or ``False`` for none.

    Code moves from a laptop to a service by one line::

        points = strew.points(bbox=(0, 0, 10, 10), spacing=1)
        points = strew.connect("http://localhost:8080").points(bbox=(0, 0, 10, 10), spacing=1)

    The daemon is called when an answer is needed: :class:`StrewError` is raised then.
    """
    return Daemon(url, key, timeout, retries, verify)


class _Later(Exception):
    """A refusal for now."""

    def __init__(self, wait: float, error: StrewError) -> None:
        super().__init__(str(error))
        self.wait, self.error = wait, error


class _Attempt:
    """One attempt of several: passes over what another one may mend."""

    def __init__(self, url: str, left: int, most: int) -> None:
        self._url, self._left = url, left
        self.pause = 0.1 * 2 ** (most - left)

    def __enter__(self) -> _Attempt:
        return self

    def __exit__(self, kind: Any, error: BaseException | None, trace: Any) -> bool:
        if isinstance(error, _Later):
            if not self._left:
                raise error.error from None
            self.pause = max(self.pause, error.wait)
            return True
        if isinstance(error, BROKEN):
            if not self._left:
                raise Disconnected(f"{self._url}: {error or type(error).__name__}") from error
            return True
        return False


def _refusal(response: http.client.HTTPResponse, content: bytes) -> StrewError:
    try:
        problem = json.loads(content)
        kind = problem["type"].rsplit(":", 1)[-1]
        return StrewError(problem["detail"], kind, problem.get("errors"))
    except (ValueError, KeyError, TypeError):
        shown = content[:200].decode(errors="replace").strip()
        return StrewError(f"HTTP {response.status}: {shown or response.reason}", f"http-{response.status}")


class _Asked:
    """A query of a daemon."""

    def __init__(self, daemon: Daemon, query: Body) -> None:
        self._daemon, self._query = daemon, query
        self._counted: tuple[int, dict[str, Any]] | None = None
        self._begun: tuple[str | None, list[str]] | None = None

    def _body(self, **more: Any) -> str:
        return text({**self._query, **more})

    def _head(self) -> tuple[int, dict[str, Any]]:
        if self._counted is None:
            window = {"offset", "limit", "cursor"} & set(self._query)
            if window:
                # The count of a window comes with its split into one part.
                count = self._daemon.json("POST", "/v1/points:split?parts=1", self._body())["count"]
                first = self._daemon.json("POST", "/v1/points:query", self._body(format="json", limit=1))["query"]
                # What is about the document, and not about the points.
                first = {name: first[name] for name in first if name not in ("format", "relative_to", "limit")}
                if "limit" in window:
                    first["limit"] = self._query["limit"]
                self._counted = count, first
            else:
                counted = self._daemon.json("POST", "/v1/count", self._body())
                self._counted = counted["count"], counted["query"]
        return self._counted

    def count(self) -> int:
        return self._head()[0]

    def query(self) -> dict[str, Any]:
        return dict(self._head()[1])

    def _first(self) -> tuple[str | None, list[str]]:
        if self._begun is None:
            for attempt in self._daemon.attempts():
                with attempt, self._daemon.open("POST", "/v1/points:query", self._body(format="f32")) as response:
                    self._begun = response.headers.get("strew-next"), _tables(response)
                    break
        assert self._begun is not None
        return self._begun

    def tables(self) -> list[str]:
        return self._first()[1]

    def next(self) -> str | None:
        return self._first()[0]

    def split(self, parts: int) -> list[tuple[str, int]]:
        answer = self._daemon.json("POST", f"/v1/points:split?parts={quote(str(parts))}", self._body())
        return [(part["query"]["cursor"], part["count"]) for part in answer["parts"]]

    def document(self, options: Sequence[tuple[str, str]]) -> bytes:
        given: dict[str, Any] = dict(options)
        for name in ("decimals", "size"):
            if given.get(name, "").isdigit():
                given[name] = int(given[name])
        return self._daemon.read("POST", "/v1/points:query", self._body(**given))

    def coordinates(self) -> np.ndarray[Any, np.dtype[np.float64]]:
        return np.asarray(self.columns().at())

    def columns(self) -> Columns:
        answer = _Answer(self._daemon, self._query)
        batches = list(answer)
        columns = answer.columns
        ids, at = (_joined([getattr(batch, name) for batch in batches]) for name in ("ids", "at"))
        further = []
        for i, column in enumerate(columns):
            values = _joined([batch.further[i] for batch in batches])
            further.append((column.name, column.is_optional, values, column.names))
        return Columns.received(ids, at, further, answer.origin)


def _tables(response: http.client.HTTPResponse) -> list[str]:
    return (response.headers.get("strew-table") or "").split(", ")


def _joined(arrays: list[np.ndarray[Any, Any]]) -> bytes:
    return b"".join(np.ascontiguousarray(array).tobytes() for array in arrays)


class _Answer:
    """The batches of an answer. One that breaks off goes on after the rows that came."""

    columns: list[Column]
    origin: tuple[float, float] | None

    def __init__(self, daemon: Daemon, query: Body) -> None:
        self._daemon, self._query = daemon, query
        self.columns, self.origin = [], None

    def __iter__(self) -> Iterator[Batch]:
        rows, expected = 0, None
        rest = dict(self._query, format="arrow")
        for attempt in self._daemon.attempts():
            with attempt, self._daemon.open("POST", "/v1/points:query", text(rest)) as response:
                if expected is None:
                    expected = int(response.headers["strew-count"])
                self.origin = _origin(response)
                stream = Stream(_exactly(response))
                self.columns = stream.columns
                for batch in stream:
                    yield batch
                    rows += len(batch.at)
                if rows < expected:
                    raise EOFError(f"{rows} of {expected} points came")
            if expected is not None and rows >= expected:
                return
            if rows:
                # The order is fixed, so the rest is known by its place.
                rest["offset"] = self._query.get("offset", 0) + rows
                if "limit" in self._query:
                    rest["limit"] = self._query["limit"] - rows


def _origin(response: http.client.HTTPResponse) -> tuple[float, float] | None:
    origin = response.headers.get("strew-origin")
    if origin is None:
        return None
    x, y = origin.split(",")
    return float(x), float(y)


def _exactly(response: http.client.HTTPResponse) -> Any:
    def read(count: int) -> bytes:
        data = response.read(count) if count else b""
        if len(data) != count:
            raise EOFError("the answer broke off")
        return data

    return read
