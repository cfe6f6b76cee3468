"""Progress of long calls, for whoever asks for it."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from time import monotonic
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from typing_extensions import TypeAlias

#: Takes the number of points made so far, and that of all, if it is known.
Follower: TypeAlias = "Callable[[int, int | None], object]"

_FOLLOWER: ContextVar[Follower | None] = ContextVar("follower", default=None)


@contextmanager
def progress(follower: Follower | None = None) -> Iterator[None]:
    """Follows calls in this process that take long, while a ``with`` statement lasts.

    ``follower`` is called about 20 times a second with the number of points made so far and the number of all, or
    ``None`` while that is not known. If it raises an exception, the call ends with it. Without a follower a line on
    standard error shows the progress, if that is a terminal.

    >>> import strew
    >>> with strew.progress(lambda points, total: print(f"{points} of {total}")):
    ...     points = strew.points(bbox=(0, 0, 9, 9), spacing=1).xy
    """
    begun, is_shown = monotonic(), False

    def show(points: int, total: int | None) -> None:
        nonlocal is_shown
        is_shown = True
        share = f"{100 * points // total} % of {total}, " if total and points else ""
        print(f"\r\033[Kstrew: {share}{monotonic() - begun:.0f} s", end="", file=sys.stderr, flush=True)

    token = _FOLLOWER.set(follower or (show if sys.stderr.isatty() else None))
    try:
        yield
    finally:
        _FOLLOWER.reset(token)
        if is_shown:
            print("\r\033[K", end="", file=sys.stderr, flush=True)


def report(points: int, total: int | None) -> None:
    """Called by the native part about 20 times a second."""
    follower = _FOLLOWER.get()
    if follower is not None:
        follower(points, total)
