"""Coordinate reference systems by name. The package changes no coordinates: it carries names, and finds contradictions."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ._errors import fault
from ._parameters import KINDS


class Placed(dict[str, Any]):
    """A query or a part of one as JSON has it, with the reference system that its coordinates are in."""

    #: The name of the reference system, such as ``EPSG:32633``; ``None`` if it is not known.
    crs: str | None = None

    @classmethod
    def of(cls, json: Mapping[str, Any], crs: str | None) -> Placed:
        made = cls(json)
        made.crs = crs
        return made

    @classmethod
    def query(cls, query: Mapping[str, Any]) -> Placed:
        """A query with the one reference system of its arguments. Raises :class:`StrewError` where two differ."""
        crs = joined(dict(_places(query, "")))
        return cls.of({name: value for name, value in query.items() if name != "crs"}, crs)


#: Names of reference systems: an authority and a code, also as a URN or an address of the OGC.
_NAME = re.compile(
    r"(?:([a-z]{1,16}):|urn:(?:x-)?ogc:def:crs:([a-z]{1,16}):(?:[^:]*:)?"
    r"|https?://www\.opengis\.net/def/crs/([a-z]{1,16})/[^/]+/)([a-z0-9]{1,16})",
    re.IGNORECASE,
)


def named(crs: Any, argument: str = "crs") -> str | None:
    """The name of a reference system, ``EPSG:32633``: of an EPSG code, of an object of pyproj or rasterio, of whatever
    else pyproj reads, or of a GeoJSON member ``crs``. One without a name is its WKT; ``None`` is none."""
    if isinstance(crs, Mapping) and "properties" in crs:
        # The member `crs` of GeoJSON of 2008.
        crs = crs["properties"].get("name")
    if crs is None or isinstance(crs, str) and not crs.strip():
        return None
    if isinstance(crs, (int, np.integer)) and not isinstance(crs, bool):
        return f"EPSG:{crs}"
    if isinstance(crs, str):
        name = _NAME.fullmatch(crs.strip())
        if name:
            return ":".join(part for part in name.groups() if part).upper()
    elif hasattr(crs, "to_wkt"):
        return _of_object(crs)
    try:
        from pyproj import CRS
        from pyproj.exceptions import CRSError
    except ImportError:
        if isinstance(crs, str) and "[" in crs:
            return crs.strip()
        raise fault(argument, crs, "not a reference system without pyproj", "a code such as 32633, EPSG:32633, or WKT") from None
    try:
        return _of_object(CRS.from_user_input(crs))
    except (CRSError, TypeError):
        raise fault(argument, crs, "not a reference system", "what pyproj reads, such as 32633, EPSG:32633, or WKT") from None


def _of_object(crs: Any) -> str | None:
    authority = crs.to_authority() if hasattr(crs, "to_authority") else None
    if authority:
        return ":".join(authority).upper()
    wkt = str(crs.to_wkt())
    # That of rasterio is empty where there is none.
    return (wkt or None) if hasattr(crs, "to_authority") else named(wkt)


def is_name(crs: str) -> bool:
    """Whether a reference system has an authority and a code; others are WKT."""
    return _NAME.fullmatch(crs) is not None


def _places(thing: Any, path: str) -> Iterator[tuple[str, str | None]]:
    """The reference systems that a query or a part of it brings along, with the arguments that they are in."""
    crs = getattr(thing, "crs", None)
    yield path or "points", named(crs, path)
    if not hasattr(thing, "crs") and hasattr(thing, "__geo_interface__"):
        thing = thing.__geo_interface__
    if isinstance(thing, Mapping):
        for name, part in thing.items():
            at, kind = f"{path}.{name}" if path else str(name), KINDS.get(name)
            if name == "crs":
                yield at, named(part, at)
            elif kind == "fields" and isinstance(part, Mapping):
                for variant, field in part.items():
                    yield from _places(field, f"{at}.{variant}")
            elif kind not in ("weights", "ranges") and name not in ("clear_of", "coordinates", "properties"):
                yield from _places(part, at)
    elif isinstance(thing, (list, tuple)) and thing and not isinstance(thing[0], (int, float, str)):
        for i, part in enumerate(thing):
            yield from _places(part, f"{path}[{i}]")


def joined(places: Mapping[str, str | None]) -> str | None:
    """The one reference system of several things by their names. Raises :class:`StrewError` where two differ."""
    known = {place: crs for place, crs in places.items() if crs is not None}
    first = next(iter(known), None)
    for place, crs in known.items():
        if first is not None and not _is_same(known[first], crs):
            detail = f"contradicts the {known[first]} of `{first}`"
            raise fault(place, crs, detail, "one reference system: reproject one of them, such as by geopandas' to_crs")
    # Of equal ones a name, which every format has a place for.
    return next(filter(is_name, known.values()), None) or (None if first is None else known[first])


#: Names of longitude and latitude on WGS 84, in this order of coordinates.
_DEGREES = {"EPSG:4326", "OGC:CRS84"}


def _is_same(one: str, other: str) -> bool:
    if one == other or {one, other} <= _DEGREES:
        return True
    try:
        from pyproj import CRS
        from pyproj.exceptions import CRSError
    except ImportError:
        # Names differ. Of a WKT without a reader nothing is known.
        return not (is_name(one) and is_name(other))
    try:
        return bool(CRS.from_user_input(one) == CRS.from_user_input(other))
    except CRSError:
        return False
