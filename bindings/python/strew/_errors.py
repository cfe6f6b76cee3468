"""The errors of the package, in the words of the REST API."""

from __future__ import annotations

from typing import Any


class StrewError(ValueError):
    """A query that has no answer.

    >>> import strew
    >>> strew.points(bbox=(0, 0, 10, 10), spacing=-1)
    Traceback (most recent call last):
        ...
    strew.StrewError: `spacing` = `-1`: out of range; allowed: a number from 1e-100 to 1e100
    """

    # Tracebacks name the place that callers import it from.
    __module__ = "strew"

    #: The kind of error, as in REST's problem documents: ``invalid-query``, ``too-many-points``, …
    kind: str
    #: For an invalid query everything that is wrong with it: dicts of ``field`` (its path), ``value`` (``None`` if
    #: it is missing), ``detail`` and ``allowed``.
    faults: list[dict[str, Any]]

    def __init__(self, message: str, kind: str = "", faults: list[dict[str, Any]] | None = None) -> None:
        super().__init__(message)
        self.kind = kind
        self.faults = faults or []

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.kind, self.faults)


class NoSuchPoint(StrewError, LookupError):
    """An id that no point of the set has."""

    __module__ = "strew"


class Disconnected(ConnectionError):
    """A daemon that cannot be reached, or whose answer broke off."""

    __module__ = "strew"


def refusal(message: str, kind: str, faults: list[dict[str, Any]] | None = None) -> StrewError:
    """The error of a refusal."""
    return (NoSuchPoint if kind == "no-such-point" else StrewError)(message, kind, faults)


def fault(field: str, value: Any, detail: str, allowed: str) -> StrewError:
    """The error of a keyword that has no form in JSON, in the words of REST."""
    shown = " ".join(repr(value).split())
    shown = shown if len(shown) <= 60 else shown[:60] + "…"
    told = {"field": field, "value": shown, "detail": detail, "allowed": allowed}
    return StrewError(f"`{field}` = `{shown}`: {detail}; allowed: {allowed}", "invalid-query", [told])
