"""Sets of points."""

from __future__ import annotations

import gzip
import operator
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Generic, SupportsIndex, TypeVar, overload

import numpy as np

from . import _frames
from ._crs import Placed, is_name, joined, named
from ._errors import fault
from ._parameters import KINDS, PLACED, WINDOW
from ._query import OF_ANSWERS, PLANE, Body, Dimension, address, body, features, text

if TYPE_CHECKING:
    import geopandas
    import matplotlib.axes
    import pandas
    import pyarrow
    from typing_extensions import Self, Unpack

    from ._parameters import Output
    from ._source import Plan, Source
    from ._columns import Columns

Floats = np.ndarray[Any, np.dtype[np.float64]]


#: The most points that a row by its number makes, and keeps.
FEW = 1_000_000
#: The formats that geopandas and pyarrow write.
FILES = ("parquet", "feather", "arrow")

# Endings of files that are not the names of formats.
_ENDINGS = {"jsonl": "ndjson", "geojsons": "geojsonseq", "geojsonl": "geojsonseq", "arrow": "feather", "arrows": "arrow"}


@dataclass(frozen=True)
class Point:
    """A point of a set."""

    #: Its stable id.
    id: str
    x: float
    y: float
    #: How far it is from the place whose neighbors were wanted.
    distance: float | None = None
    #: Its attributes by name.
    attributes: Mapping[str, Any] = field(default_factory=dict)


#: A point of the plane, or in space.
P = TypeVar("P")


class Points(Generic[P]):
    """The points of a query, of the plane or in space: what :class:`PointSet` and ``SpaceSet`` have in common."""

    _dimension: ClassVar[Dimension] = PLANE
    #: The class of a point.
    _kind: ClassVar[Any]

    def __init__(self, source: Source, query: Placed) -> None:
        self._source = source
        self._body = query
        self._plan: Plan | None = None
        self._made: Columns | None = None
        self._at: Floats | None = None

    @classmethod
    def of(cls, source: Source, query: Body) -> Self:
        """The points of a query, which is checked at once where that costs no request."""
        if not isinstance(query, Mapping):
            text(query)
        placed = Placed.query(query)
        if "features" in placed:
            placed["features"] = features(placed["features"])
        return cls(source, placed)._checked()

    def _checked(self) -> Self:
        if self._source.checks_at_once and "region" in self._body:
            self.plan()
        return self

    @property
    def source(self) -> Source:
        """Where the points come from: this process or a daemon."""
        return self._source

    @property
    def body(self) -> Body:
        """The query in JSON: the body of ``POST /v1/points:query``, in space of ``POST /v1/space/points``."""
        return Placed.of(self._body, self.crs)

    def plan(self) -> Plan:
        """The plan: what the points are made from. Raises :class:`StrewError` for a query that is not valid."""
        if self._plan is None:
            self._plan = self._source.plan(self._body, self._dimension)
        return self._plan

    @property
    def query(self) -> dict[str, Any]:
        """The query with everything filled in, as answers of REST repeat it."""
        return self.plan().query()

    @property
    def tables(self) -> list[str]:
        """The digests of the tables that answer, each once: ``table=`` pins one."""
        return self.plan().tables()

    @property
    def next(self) -> str | None:
        """With a limit: the cursor of the points after these, if there are any."""
        return self.plan().next()

    def count(self) -> int:
        """The exact number of points, of any size, without making them.

        >>> import strew
        >>> strew.points(bbox=(-5e8, -5e8, 5e8, 5e8), spacing=1).count()
        1000000000097677487
        """
        return self.plan().count()

    def __len__(self) -> int:
        return self.count()

    def __bool__(self) -> bool:
        """Whether there is a point: always without a region."""
        return not ("region" in self._body or "periodic" in self._body) or self.count() > 0

    # -- other regions and parts of the same points ------------------------------------------------------------

    def _with(self, **members: Any) -> Self:
        kept = {name: value for name, value in self._body.items() if name not in members}
        more = {name: value for name, value in members.items() if value is not None}
        query = Placed.of({**kept, **more}, self.crs)
        # Nothing but a region has a place.
        return type(self)(self._source, Placed.query(query) if "region" in more else query)._checked()

    def within(self, region: Any = None, **shape: Any) -> Self:
        """The same set of points in another region: ``bbox``, ``circle``, ``polygon``, ``chunk`` or ``region``; in
        space ``bbox``, ``ball``, ``prism``, ``chunk`` or ``region``."""
        if region is not None:
            shape["region"] = region
        unknown = set(shape) - set(self._dimension.shapes) - {"region"}
        if unknown or not shape:
            raise TypeError(f"within takes one of region, {', '.join(self._dimension.shapes)}")
        return self._with(region=body(shape)["region"], **dict.fromkeys(WINDOW))

    def split(self, parts: int) -> list[Self]:
        """The points in at most ``parts`` sets of the same size, give or take one, in their order.

        Each part is a set by itself, which another process or machine can make from its pickle.

        >>> import pickle, strew
        >>> whole = strew.points(bbox=(0, 0, 50, 50), spacing=1, seed=2)
        >>> parts = [pickle.loads(pickle.dumps(part)) for part in whole.split(3)]
        >>> [len(part) for part in parts], len(whole)
        ([833, 832, 832], 2497)
        """
        places = self.plan().split(parts)
        return [self._with(cursor=cursor, limit=count, offset=None) for cursor, count in places]

    # -- single points -----------------------------------------------------------------------------------------

    def _set(self, **more: Any) -> str:
        """The address of the set alone."""
        values = {**more, **{name: value for name, value in self._body.items() if name not in OF_ANSWERS}}
        if "count" in values and "region" in self._body:
            del values["count"]
            values["spacing"] = self.query["spacing"]
        for name, value in values.items():
            if KINDS.get(name) == "field" and isinstance(value, Mapping):
                values[name] = self._source.hold_field(value)
        return address({name: value for name, value in values.items() if value is not None})

    def nearest(self, at: Any, k: int | None = None, radius: float | None = None) -> list[P]:
        """The points nearest to a place, nearest first: one, or ``k``, or all within ``radius``."""
        found = self._source.nearest(self._set(at=list(at), k=k, radius=radius), self._dimension)
        return [self._described(point) for point in found]

    def point(self, id: Any) -> P:
        """The point of an id: a text, or the integers as in :attr:`ids`. Raises :class:`NoSuchPoint`."""
        id = id if isinstance(id, str) else ":".join(str(int(part)) for part in id)
        return self._described(self._source.point(id, self._set(), self._dimension))

    def _described(self, found: dict[str, Any]) -> P:
        names = ("id", *self._dimension.axes, "distance")
        own = {name: found.pop(name) for name in names if name in found}
        found.pop("block", None)
        point: P = self._kind(**own, attributes=found)
        return point

    # -- columns -----------------------------------------------------------------------------------------------

    def columns(self) -> Columns:
        """All columns, as memory that numpy and Arrow look at."""
        if self._made is None:
            self._made = self.plan().columns()
        return self._made

    def _coordinates(self) -> Floats:
        if self._at is None:
            self._at = np.asarray(self.plan().coordinates() if self._made is None else self._made.at())
        return self._at

    @property
    def x(self) -> Floats:
        """The first coordinates."""
        return self._coordinates()[:, 0]

    @property
    def y(self) -> Floats:
        """The second coordinates."""
        return self._coordinates()[:, 1]

    @property
    def origin(self) -> tuple[float, ...] | None:
        """The place that coordinates are relative to, the corner of a chunk; `None` for the world's origin."""
        origin = self.columns().origin
        return None if origin is None else tuple(origin)

    @property
    def ids(self) -> np.ndarray[Any, np.dtype[np.int64]]:
        """The ids: an array of pairs of integers, in space of triples. As text an id is ``x:y``, in space ``x:y:z``."""
        return np.asarray(self.columns().ids())

    @property
    def names(self) -> list[str]:
        """The names of the columns beside ids and coordinates: ``layer``, if there are layers, and attributes."""
        return self.columns().names()

    def _further(self, name: str) -> tuple[np.ndarray[Any, Any], list[str] | None]:
        columns = self.columns()
        try:
            place = columns.names().index(name)
        except ValueError:
            known = ", ".join(["id", *self._dimension.axes, *columns.names()])
            raise KeyError(f"no column {name!r}; there are {known}") from None
        values, names = columns.further(place)
        return np.asarray(values), names

    @overload
    def __getitem__(self, name: str) -> np.ndarray[Any, Any]: ...
    @overload
    def __getitem__(self, name: slice) -> Self: ...
    @overload
    def __getitem__(self, name: SupportsIndex) -> P: ...
    def __getitem__(self, name: str | SupportsIndex | slice) -> Any:
        """A column by its name, a point by its number, or a set of the rows of a slice.

        A column is of numbers, or of names; where a layer lacks it there is NaN, or the empty name. ``"id"`` is the
        ids as text. Numbers count in the order of the answer. A slice makes no points: it is the same query with an
        ``offset`` and a ``limit``.

        >>> import strew
        >>> row = strew.points(bbox=(0, 0, 9, 9), spacing=1)
        >>> row[0].id == row["id"][0], row[-1].id == row["id"][-1], len(row[10:15])
        (True, True, 5)

        >>> import strew
        >>> trees = strew.points(bbox=(0, 0, 9, 9), spacing=3, attributes=["variant"], variants={"oak": 3, "birch": 1})
        >>> sorted(set(trees["variant"].tolist()))
        ['birch', 'oak']
        >>> trees.codes("variant")[0].dtype
        dtype('int32')
        """
        if isinstance(name, slice):
            return self._rows_of(name)
        if not isinstance(name, str):
            return self._row(operator.index(name))
        if name == "id":
            return np.array([":".join(map(str, id)) for id in self.ids.tolist()], dtype=np.str_)
        if name in tuple(self._dimension.axes):
            return self._coordinates()[:, self._dimension.axes.index(name)]
        values, names = self._further(name)
        # −1, the code of what is missing, is the last one.
        return values if names is None else np.array([*names, ""])[values]

    def _rows_of(self, rows: slice) -> Self:
        first, end, step = rows.indices(self.count())
        if step != 1:
            raise fault("slice", rows, "skips rows", "a step of 1; columns are arrays, which take any slice")
        if end <= first:
            raise fault("slice", rows, "has no rows", "at least one row")
        return self._with(offset=self._body.get("offset", 0) + first, limit=end - first)

    def _row(self, i: int) -> P:
        count = self.count()
        if not -count <= i < count:
            raise IndexError(f"row {i} of {count} points")
        i %= count
        # Few points are made whole, so that a loop over them makes them once.
        if self._made is None and count > FEW:
            return next(iter(self._rows_of(slice(i, i + 1))))
        return next(self._iterate(i, i + 1))

    def codes(self, name: str) -> tuple[np.ndarray[Any, np.dtype[np.int32]], list[str]]:
        """A column of names as indices, without a copy, and the names. −1 stands where a layer lacks it."""
        values, names = self._further(name)
        if names is None:
            raise KeyError(f"{name!r} is a column of numbers")
        return values, names

    def __iter__(self) -> Iterator[P]:
        return self._iterate()

    def _iterate(self, first: int = 0, end: int | None = None) -> Iterator[P]:
        """The points of some rows."""
        rows = slice(first, end)
        columns = {name: self[name][rows] for name in self.names}
        for i, (id, at) in enumerate(zip(self.ids[rows].tolist(), self._coordinates()[rows].tolist())):
            attributes = {name: values[i].item() for name, values in columns.items()}
            yield self._kind(":".join(map(str, id)), *at, attributes=attributes)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray[Any, Any]:
        at = self._coordinates()
        if copy is None:
            return at if dtype is None else at.astype(dtype, copy=False)
        return np.array(at, dtype=dtype, copy=copy)

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        """All columns as an Arrow stream: what ``pyarrow.table``, polars and duckdb take."""
        import json

        metadata = {
            "strew.query": json.dumps(self.query, separators=(",", ":")),
            "strew.table": json.dumps(self.tables),
            "strew.count": str(len(self.columns())),
        }
        return self.columns().arrow_stream(metadata)

    def to_arrow(self, *, geometry: bool = False, crs: Any = None) -> pyarrow.Table:
        """A ``pyarrow.Table`` of all columns. With ``geometry`` a column of GeoArrow points replaces the coordinates.

        ``crs`` is the reference system of that column, :attr:`crs` by default.
        """
        return _frames.arrow(self, geometry, self._crs_or(crs))

    def to_pandas(self) -> pandas.DataFrame:
        """A ``pandas.DataFrame`` of all columns: ids as text, names as categories."""
        return _frames.pandas(self)

    def to_geopandas(self, crs: Any = None) -> geopandas.GeoDataFrame:
        """A ``geopandas.GeoDataFrame``: ids, attributes, and points as geometry, with their height if they have one.

        ``crs`` is the reference system, by default :attr:`crs`. Coordinates do not
        change; points of chunks get those from the world's origin.
        """
        return _frames.geopandas(self, self._crs_or(crs))

    def plot(self, ax: Any = None, *, by: str | None = None, **style: Any) -> matplotlib.axes.Axes:
        """Draws the points by matplotlib, on ``ax`` or the current axes, which are returned. Those of points in space
        are of three dimensions.

        ``by`` names the column that colors them. ``style`` is passed on to ``Axes.scatter``.
        """
        axes: matplotlib.axes.Axes = _frames.plot(self, ax, by, style)
        return axes

    @property
    def crs(self) -> str | None:
        """The reference system of the points, such as ``EPSG:32633``: that of the keyword ``crs``, or of any region,
        field, terrain or feature of the query; else ``None``."""
        return self._body.crs

    def _crs_or(self, crs: Any) -> str | None:
        stated = named(crs)
        own = joined({"points": self.crs, "crs": stated})
        return stated or own

    # -- documents ---------------------------------------------------------------------------------------------

    def document(self, format: str, **options: Unpack[Output]) -> bytes:
        """The points in a format of REST: ``json``, ``csv``, ``geojson``, ``ply``, ``npy``, ``svg``, ``png``, …, or as
        a GeoParquet (``parquet``), an Arrow file (``feather``) or stream (``arrow``), by geopandas and pyarrow.

        The options are the members of ``Output``, such as ``decimals`` for texts and ``size`` for pictures, or those of
        geopandas. Formats that state a reference system, such as ``geojson``, have that of the points.

        >>> import strew
        >>> print(strew.points(bbox=(0, 0, 2, 1), spacing=1, seed=1).document("csv", decimals=2).decode())
        id,x,y
        -1:1,0.29,0.60
        5:1,1.70,0.79
        3:2,0.92,0.02
        <BLANKLINE>
        """
        given = {"format": format, **options}
        crs = self._crs_or(options.get("crs"))
        if format in FILES:
            given = {name: value for name, value in options.items() if name != "crs"}
            return _frames.file(self, format, crs, given)
        if crs is not None and (format in PLACED or "crs" in options):
            if not is_name(crs):
                way_out = "one with an authority and a code, or points.to_geopandas().to_file(path)"
                raise fault("crs", crs, f"has no name that {format} could state", way_out)
            given["crs"] = crs
        texts = [(name, "on" if value is True else "off" if value is False else str(value)) for name, value in given.items()]
        return self.plan().document(texts)

    def write(self, path: str | Path, format: str | None = None, **options: Unpack[Output]) -> None:
        """Writes a document; the ending of the path is the format, as of ``strew sample -o``, also with ``.gz``."""
        inner = Path(path)
        is_packed = inner.suffix.lower() == ".gz"
        if is_packed:
            inner = inner.with_suffix("")
        ending = inner.suffix.lstrip(".").lower()
        format = format or _ENDINGS.get(ending, ending)
        content = self.document(format, **options)
        Path(path).write_bytes(gzip.compress(content, mtime=0) if is_packed else content)

    def _repr_svg_(self) -> str | None:
        """A picture, for notebooks."""
        if "region" not in self._body or self.count() > 20_000:
            return None
        return self.document("svg").decode()

    # -- identity ----------------------------------------------------------------------------------------------

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Points) or self._dimension is not other._dimension:
            return NotImplemented
        ours, theirs = ((repr(points._source), points.crs, text(points._body)) for points in (self, other))
        return ours == theirs

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        shown = text(self._body)
        kind = "points in space" if len(self._dimension.axes) == 3 else "points"
        return f"<{kind} of {self._source!r}: {shown if len(shown) < 300 else shown[:300] + '…'}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._source, self._body)


class PointSet(Points[Point]):
    """The points of a query of the plane, made when they are first needed.

    A query without a region is the whole plane: it has :meth:`chunk`, :meth:`within`, :meth:`nearest` and
    :meth:`point`. With a region it has a length and columns, too. A set is pickled as its query.

    >>> import strew
    >>> forest = strew.points(spacing=2, seed=5)
    >>> chunk = forest.chunk(64, -3, 2)
    >>> chunk.origin
    (-192.0, 128.0)
    >>> nearest = forest.nearest((100, -3), k=2)
    >>> forest.point(nearest[0].id).x == nearest[0].x
    True
    """

    _kind = Point

    def chunk(self, size: float, x: int, y: int) -> Self:
        """The points of a square of the world grid. Coordinates are relative to its corner, :attr:`origin`."""
        return self.within(chunk=(size, x, y))

    @property
    def xy(self) -> Floats:
        """The coordinates: an array of pairs, read only."""
        return self._coordinates()
