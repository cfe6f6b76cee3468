"""Points that are made in this process."""

from __future__ import annotations

from typing import Any

from ._errors import fault
from ._native import native
from ._query import PLANE, SPACE, Body, Dimension, text
from ._source import Plan, Source


class Local(Source):
    """This process."""

    checks_at_once = True

    def plan(self, query: Body, dimension: Dimension = PLANE) -> Plan:
        plan: Plan = native().plan(text(query), dimension is SPACE)
        return plan

    def point(self, id: str, address: str, dimension: Dimension = PLANE) -> dict[str, Any]:
        point: dict[str, Any] = native().point(id, address, dimension is SPACE)
        return point

    def nearest(self, address: str, dimension: Dimension = PLANE) -> list[dict[str, Any]]:
        neighbors: list[dict[str, Any]] = native().nearest(address, dimension is SPACE)
        return neighbors

    def hold_field(self, field: Any) -> str:
        return str(native().hold_field(text(field)))

    def __repr__(self) -> str:
        return "strew"

    def __reduce__(self) -> str:
        return "LOCAL"


LOCAL = Local()


def limits(
    *, points: int | None = None, rows: int | None = None, vertices: int | None = None, pixels: int | None = None
) -> dict[str, int]:
    """Sets limits of this process for the calls that follow, and returns all of them.

    ``points`` is the most points of an answer, ``rows`` the most steps of counting, as for ``count=`` in fields and for
    :func:`stipple`, ``vertices`` the most vertices of a region, and ``pixels`` the most pixels of a query. Other
    processes have limits of their own, and daemons those of their settings.

    >>> import strew
    >>> strew.limits()["rows"]
    5000000
    """
    for name, most in {"points": points, "rows": rows, "vertices": vertices, "pixels": pixels}.items():
        if most is not None and not 1 <= most < 2**63:
            raise fault(name, most, "out of range", "an integer from 1 to 2**63 - 1")
    set_now: dict[str, int] = native().limits((points, rows, vertices, pixels))
    return set_now
