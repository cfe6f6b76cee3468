"""Sets of points in space."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar, overload

from ._help import documented
from ._points import Floats, Points
from ._query import SPACE, Body, Dimension, SpaceQuery, Volumes, body

if TYPE_CHECKING:
    from typing_extensions import Self, Unpack

    from ._parameters import Integer, Number
    from ._source import Source


@dataclass(frozen=True)
class SpacePoint:
    """A point in space."""

    #: Its stable id.
    id: str
    x: float
    y: float
    z: float
    #: How far it is from the place whose neighbors were wanted.
    distance: float | None = None
    #: Its attributes by name.
    attributes: Mapping[str, Any] = field(default_factory=dict)


class SpaceSet(Points[SpacePoint]):
    """The points of a query in space, made when they are first needed.

    A query without a region is all of space: it has :meth:`chunk`, :meth:`within`, :meth:`nearest` and :meth:`point`.
    With a region it has a length and columns, too. A set is pickled as its query.

    >>> import strew
    >>> stars = strew.space.points(spacing=2, seed=5)
    >>> chunk = stars.chunk(16, -3, 2, 1)
    >>> chunk.origin
    (-48.0, 32.0, 16.0)
    >>> nearest = stars.nearest((100, -3, 12), k=2)
    >>> stars.point(nearest[0].id).z == nearest[0].z
    True
    """

    _dimension: ClassVar[Dimension] = SPACE
    _kind = SpacePoint

    def chunk(self, size: float, x: int, y: int, z: int) -> Self:
        """The points of a cube of the world grid. Coordinates are relative to its corner, :attr:`origin`."""
        return self.within(chunk=(size, x, y, z))

    @property
    def xyz(self) -> Floats:
        """The coordinates: an array of triples, read only."""
        return self._coordinates()

    @property
    def z(self) -> Floats:
        """The third coordinates."""
        return self.xyz[:, 2]


class Space:
    """Points in space, of this process or of a daemon: ``strew.space``, ``daemon.space``."""

    def __init__(self, source: Source) -> None:
        self._source = source

    @overload
    def points(self, *, spacing: Number, **query: Unpack[Volumes]) -> SpaceSet: ...
    @overload
    def points(self, *, density: Number, **query: Unpack[Volumes]) -> SpaceSet: ...
    @overload
    def points(self, *, count: Integer, **query: Unpack[Volumes]) -> SpaceSet: ...
    @overload
    def points(self, *, min_distance: Number, **query: Unpack[Volumes]) -> SpaceSet: ...
    @overload
    def points(self, *, layers: Sequence[Mapping[str, Any]], **query: Unpack[Volumes]) -> SpaceSet: ...
    @documented(SpaceQuery)
    def points(self, **query: Any) -> SpaceSet:
        """The points of a query in space.

        >>> import strew
        >>> stars = strew.space.points(ball=(0, 0, 0, 9), spacing=1.5, seed=3, attributes=["rotation"])
        >>> stars.xyz.shape == (len(stars), 3)
        True
        >>> stars.names
        ['qx', 'qy', 'qz', 'qw']
        >>> prism = strew.space.points(prism=([(0, 0), (9, 0), (0, 9)], 0, 4), spacing=1)
        >>> bool(prism.z.min() >= 0 and prism.z.max() < 4)
        True
        """
        return self.query(body(query))

    def query(self, query: Body) -> SpaceSet:
        """The points of a query in JSON, the body of ``POST /v1/space/points``, as a dict.

        >>> import strew
        >>> strew.space.query({"region": {"bbox": [0, 0, 0, 8, 8, 8]}, "spacing": 1}).count()
        505
        """
        return SpaceSet.of(self._source, query)

    def __repr__(self) -> str:
        return f"{self._source!r}, in space"
