"""Coordinate reference systems by name. The package changes no coordinates: it carries names, and finds contradictions."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from ._errors import fault


def named(crs: Any) -> str | None:
    """The name of a reference system, ``EPSG:32633``: of a text, an EPSG code, an object of pyproj or rasterio, or a
    GeoJSON member ``crs``. One without a name is its WKT; ``None`` is none."""
    if crs is None or crs == "":
        return None
    if isinstance(crs, Mapping):
        # The member `crs` of GeoJSON of 2008.
        return named(crs.get("properties", {}).get("name"))
    if isinstance(crs, int):
        return f"EPSG:{crs}"
    if not isinstance(crs, str):
        authority = crs.to_authority() if hasattr(crs, "to_authority") else None
        crs = ":".join(authority) if authority else str(crs.to_wkt() if hasattr(crs, "to_wkt") else crs)
    urn = re.fullmatch(r"urn:ogc:def:crs:(\w+):[^:]*:(\w+)", crs.strip(), re.IGNORECASE)
    text = ":".join(urn.groups()) if urn else crs.strip()
    return text.upper() if re.fullmatch(r"\w+:\w+", text) else text


def of(thing: Any) -> str | None:
    """The reference system that a region or a field brings along."""
    if isinstance(thing, Mapping):
        for member in ("crs", "raster"):
            if member in thing:
                return named(thing["crs"]) if member == "crs" else of(thing["raster"])
    return named(getattr(thing, "crs", None))


def joined(places: Mapping[str, str | None], what: str = "crs") -> str | None:
    """The one reference system of several things by their names. Raises :class:`StrewError` where two differ."""
    known = {place: crs for place, crs in places.items() if crs is not None}
    first = next(iter(known), None)
    for place, crs in known.items():
        if first is not None and not _is_same(known[first], crs):
            detail = f"contradicts the {known[first]} of `{first}`"
            raise fault(place, crs, detail, "one reference system: reproject one of them, such as by geopandas' to_crs")
    return None if first is None else known[first]


#: Names of longitude and latitude on WGS 84, in this order of coordinates.
_DEGREES = {"EPSG:4326", "OGC:CRS84"}


def _is_same(one: str, other: str) -> bool:
    if one == other or {one, other} <= _DEGREES:
        return True
    try:
        from pyproj import CRS
    except ImportError:
        # Names differ. Of a WKT without a reader nothing is known.
        return any(":" not in text or "[" in text for text in (one, other))
    return bool(CRS.from_user_input(one) == CRS.from_user_input(other))
