"""Daemons with the same points: which of them to call next, and when to call one again that failed.

Replicas share nothing and answer alike, so a request goes to the one with the fewest requests of this client. One that
refuses, breaks off or is busy is left out for a while; afterwards a single request tries it again. A request ends once
the addresses have failed too often in a row, or for too long.
"""

from __future__ import annotations

import email.utils
import http.client
import random
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from ._errors import Disconnected, StrewError

#: What breaks a connection: the same request is worth another try.
BROKEN = (OSError, http.client.HTTPException, EOFError)
#: How long, in seconds, an address is left out after its first failure, and at most. It doubles with each failure.
SHORTEST, LONGEST = 0.1, 5.0


class Later(Exception):
    """A refusal for now, and the seconds after which the daemon wants to be called again."""

    def __init__(self, wait: float, error: StrewError) -> None:
        super().__init__(str(error))
        self.wait, self.error = wait, error


class Elsewhere(Exception):
    """A refusal because of the tables, fields or worlds that a daemon holds: another one may hold others."""

    def __init__(self, error: StrewError) -> None:
        super().__init__(str(error))
        self.error = error


def retry_after(text: str | None) -> float:
    """The seconds of a header ``Retry-After``: a number, or a date."""
    text = (text or "").strip()
    if text.isdecimal():
        return float(text)
    try:
        date = email.utils.parsedate_to_datetime(text)
    except ValueError:
        return 0.0
    return max(0.0, date.timestamp() - time.time())


@dataclass(eq=False)
class Replica:
    """A daemon, and how it did lately."""

    url: str
    #: How many requests of this client it answers now.
    running: int = 0
    #: When it was chosen last, as a number that grows.
    turn: int = 0
    #: How often it failed in a row.
    failures: int = 0
    #: Until when it is left out, by the monotonic clock.
    until: float = 0.0

    def leave_out(self, now: float, least: float = 0.0) -> None:
        """Leaves it out for a while. Requests that fail together count as one failure."""
        if now >= self.until:
            self.failures += 1
        self.until = max(self.until, now + max(least, self.pause()))

    def pause(self) -> float:
        """The seconds for which it is left out: more with each failure, and at random, so that clients return apart."""
        longest = min(SHORTEST * 2.0 ** min(self.failures - 1, 30), LONGEST)
        return longest * random.uniform(0.5, 1.0)


@dataclass
class Replicas:
    """The daemons of a client, for all its threads."""

    all: list[Replica]
    #: How often each may fail in a row before a request ends.
    retries: int
    #: For how many seconds a request is repeated after its first failure.
    patience: float
    _turns: int = 0
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def take(self, refused: set[Replica], is_urgent: bool = False) -> tuple[Replica | None, float]:
        """The replica for the next request; or none, and in how many seconds there may be one."""
        with self._lock:
            now = time.monotonic()
            left = [replica for replica in self.all if replica not in refused]
            up = [replica for replica in left if replica.until <= now]
            if not up and not is_urgent:
                return None, min(replica.until for replica in left) - now
            best = min(up or left, key=lambda replica: (replica.running, replica.turn))
            if best.failures:
                # Others wait for what this request finds.
                best.failures += 1
                best.until = now + best.pause()
            self._turns += 1
            best.turn = self._turns
            best.running += 1
            return best, 0.0

    def give_back(self, replica: Replica) -> None:
        """A request has ended."""
        with self._lock:
            replica.running -= 1

    def answered(self, replica: Replica) -> None:
        """A replica answers."""
        with self._lock:
            replica.failures, replica.until = 0, 0.0

    def failed(self, replica: Replica, wait: float = 0.0) -> None:
        """A replica refused or broke off, and is to be left out for at least this many seconds."""
        with self._lock:
            replica.leave_out(time.monotonic(), wait)

    def up(self) -> list[Replica]:
        """The replicas that are not left out."""
        with self._lock:
            now = time.monotonic()
            return [replica for replica in self.all if replica.until <= now]

    def attempts(self) -> Attempts:
        """The attempts of a request."""
        return Attempts(self)


class Attempts:
    """The attempts of a request. The last one raises what is wrong."""

    def __init__(self, replicas: Replicas, only: list[Replica] | None = None, retries: int | None = None) -> None:
        self.replicas = replicas
        self._retries = replicas.retries if retries is None else retries
        self._refused = set() if only is None else set(replicas.all) - set(only)
        self._refusal: StrewError | None = None
        self._last: Exception | None = None
        self._failures = 0
        self._end: float | None = None

    def __iter__(self) -> Iterator[Attempt]:
        while True:
            replica, wait = self.replicas.take(self._refused)
            if replica is None:
                if self._is_too_late(wait):
                    self._give_up()
                    # Nothing was tried, because other requests failed.
                    replica, _ = self.replicas.take(self._refused, is_urgent=True)
                else:
                    time.sleep(wait)
                    continue
            assert replica is not None
            yield Attempt(self, replica)

    def progress(self) -> None:
        """A part of the answer came: what failed before is forgotten."""
        self._failures, self._end, self._last = 0, None, None

    def _is_too_late(self, wait: float) -> bool:
        now = time.monotonic()
        if self._end is None:
            self._end = now + self.replicas.patience
        return now + wait > self._end

    def _give_up(self) -> None:
        """Raises what went wrong, if something did."""
        error = self._refusal or self._last
        if error is not None:
            raise error from error.__cause__

    def failed(self, error: Exception) -> None:
        """Notes a failure that another attempt may mend, and raises it if there is none left."""
        self._last = error
        self._failures += 1
        if self._failures >= (self._retries + 1) * self._left() or self._is_too_late(0.0):
            self._give_up()

    def refused(self, replica: Replica, error: StrewError) -> None:
        """Notes that a replica does not hold what the request needs, and raises it if none does."""
        self._refused.add(replica)
        self._refusal = error
        if not self._left():
            raise error from None

    def _left(self) -> int:
        return len(self.replicas.all) - len(self._refused)


class Attempt:
    """One attempt of several: passes over what another one may mend."""

    def __init__(self, attempts: Attempts, replica: Replica) -> None:
        self._attempts, self._replica = attempts, replica

    def __enter__(self) -> Replica:
        return self._replica

    def __exit__(self, kind: Any, error: BaseException | None, trace: Any) -> bool:
        replicas = self._attempts.replicas
        replicas.give_back(self._replica)
        if isinstance(error, Elsewhere):
            self._attempts.refused(self._replica, error.error)
            return True
        if isinstance(error, Later):
            replicas.failed(self._replica, error.wait)
            self._attempts.failed(error.error)
            return True
        if isinstance(error, BROKEN):
            replicas.failed(self._replica)
            lost = Disconnected(f"{self._replica.url}: {error or type(error).__name__}")
            lost.__cause__ = error
            self._attempts.failed(lost)
            return True
        return False
