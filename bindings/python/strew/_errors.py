"""The errors of the package, in the words of the REST API."""

from __future__ import annotations

from typing import Any


class StrewError(ValueError):
    """A query that has no answer.

    >>> import strew
    >>> strew.points(bbox=(0, 0, 10, 10), spacing=-1)
    Traceback (most recent call last):
        ...
    strew._errors.StrewError: `spacing` = `-1`: out of range; allowed: a number from 1e-100 to 1e100
    """

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


class Disconnected(ConnectionError):
    """A daemon that cannot be reached, or whose answers break off again and again."""
