"""Where points come from: this process, or a daemon. Both have the same functions."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, overload

from ._fields import darkness, raster
from ._help import documented
from ._points import PointSet
from ._query import PLANE, Body, Boxed, Dimension, OfWorld, Query, Shaped, body
from ._space import Space

if TYPE_CHECKING:
    from typing_extensions import TypeAlias, Unpack

    from . import _strew
    from ._parameters import Integer, Number
    from ._remote import Asked


#: A query that is understood, and counted when that is wanted.
Plan: TypeAlias = "_strew.Plan | Asked"


class Source:
    """Where points come from."""

    def plan(self, query: Body, dimension: Dimension = PLANE) -> Plan:
        raise NotImplementedError

    def point(self, id: str, address: str, dimension: Dimension = PLANE) -> dict[str, Any]:
        raise NotImplementedError

    def nearest(self, address: str, dimension: Dimension = PLANE) -> list[dict[str, Any]]:
        raise NotImplementedError

    def hold_field(self, field: Any) -> str:
        raise NotImplementedError

    #: Whether a query is checked when it is made, and not when its answer is first needed.
    checks_at_once = False

    # One amount, or sets that have their own; one region.
    @overload
    def points(self, *, spacing: Number, **query: Unpack[Boxed]) -> PointSet: ...
    @overload
    def points(self, *, spacing: Number, **query: Unpack[Shaped]) -> PointSet: ...
    @overload
    def points(self, *, density: Number, **query: Unpack[Boxed]) -> PointSet: ...
    @overload
    def points(self, *, density: Number, **query: Unpack[Shaped]) -> PointSet: ...
    @overload
    def points(self, *, count: Integer, **query: Unpack[Boxed]) -> PointSet: ...
    @overload
    def points(self, *, count: Integer, **query: Unpack[Shaped]) -> PointSet: ...
    @overload
    def points(self, *, min_distance: Number, **query: Unpack[Boxed]) -> PointSet: ...
    @overload
    def points(self, *, min_distance: Number, **query: Unpack[Shaped]) -> PointSet: ...
    @overload
    def points(self, *, layers: Sequence[Mapping[str, Any]], **query: Unpack[Boxed]) -> PointSet: ...
    @overload
    def points(self, *, layers: Sequence[Mapping[str, Any]], **query: Unpack[Shaped]) -> PointSet: ...
    @overload
    def points(self, *, features: Mapping[str, Any], **query: Unpack[Shaped]) -> PointSet: ...
    @overload
    def points(self, *, world: str, **query: Unpack[OfWorld]) -> PointSet: ...
    @documented(Query)
    def points(self, **query: Any) -> PointSet:
        """The points of a query: of a region, or without one the whole plane.

        >>> import strew
        >>> trees = strew.points(circle=(0, 0, 50), spacing=4, seed=3, attributes=["angle"])
        >>> trees["angle"].shape == (len(trees),)
        True
        """
        return self.query(body(query))

    def query(self, query: Body) -> PointSet:
        """The points of a query in JSON, the body of ``POST /v1/points:query``, as a dict.

        >>> import strew
        >>> strew.query({"region": {"bbox": [0, 0, 10, 10]}, "spacing": 1, "seed": 7}).count()
        100
        """
        return PointSet.of(self, query)

    @functools.cached_property
    def space(self) -> Space:
        """Points in space: ``space.points(ball=(0, 0, 0, 9), spacing=1)``."""
        return Space(self)

    def stipple(
        self,
        image: Any,
        points: int,
        *,
        invert: bool = False,
        gamma: float = 1.0,
        seed: int = 1,
        profile: str = "blue",
        settle: int = 3,
    ) -> PointSet:
        """Draws a picture with exactly ``points`` dots, in pixels of the picture, x to the right and y upward.

        ``image`` is a path, the bytes of a PNG, JPEG, WebP, TIFF or npy file, or an array: rows of light from 0 to
        1 if it is of floats, else of sRGB with up to four channels. With ``invert`` dots are where it is light.
        They move apart by ``settle`` steps, 0 to 4.

        >>> import numpy as np, strew
        >>> ramp = np.tile(np.linspace(0, 1, 64), (64, 1))
        >>> dots = strew.stipple(ramp, 500)
        >>> len(dots), bool(dots.x.mean() < 32)
        (500, True)
        """
        dark = darkness(image, invert)
        height, width = dark.shape
        field = raster(dark, bbox=(0, 0, width, height), edges="clamp", gamma=gamma)
        query = {
            "bbox": (0, 0, width, height),
            "count": points,
            "seed": seed,
            "profile": profile,
            "settle": settle,
            "field": field,
        }
        return self.query(body(query))
