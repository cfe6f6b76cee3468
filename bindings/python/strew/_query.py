"""Queries: keywords as the body, and as the address, that REST takes."""

from __future__ import annotations

import json
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from keyword import iskeyword
from typing import TYPE_CHECKING, Any, Literal
from urllib.parse import quote

import numpy as np

from ._crs import Placed, named
from ._errors import fault
from ._parameters import KINDS, OUTPUT, REGIONS, WINDOW
from ._parameters import Amounts, Attribute, Common, Number, Numbers, Parameters, Regions, World

if TYPE_CHECKING:
    from typing_extensions import Required, TypeAlias

#: An attribute of a point in space.
SpaceAttribute: TypeAlias = "Attribute | Literal['rotation']"
#: A query as the body of ``POST /v1/points:query``.
Body: TypeAlias = "dict[str, Any]"
#: The regions of the plane that are keywords.
SHAPES = (*REGIONS, "chunk")
#: Those of space.
VOLUMES = ("bbox", "ball", "prism", "chunk")
#: Members of a query that are not about its set of points.
OF_ANSWERS = ("region", *WINDOW, *OUTPUT)


@dataclass(frozen=True)
class Dimension:
    """The plane or space: the coordinates of points, the regions that are keywords, and the paths of REST."""

    axes: str
    shapes: tuple[str, ...]
    #: What the paths begin with.
    root: str
    #: The path of queries that are bodies.
    queries: str


PLANE = Dimension("xy", SHAPES, "/v1", "/v1/points:query")
SPACE = Dimension("xyz", VOLUMES, "/v1/space", "/v1/space/points")


class OfWorld(Regions, Amounts, Common, Parameters, total=False):
    """The keywords beside a world."""

    chunk: Numbers | Mapping[str, Any] | None
    region: Mapping[str, Any] | None
    crs: Any


class Query(OfWorld, World, total=False):
    """The keywords of a query: the members of REST's JSON, and the shapes of regions by themselves.

    ``except`` is a word of Python: its keyword is ``except_``.
    """

    features: Mapping[str, Any] | None
    layers: Sequence[Mapping[str, Any]] | None


class Boxed(Common, Parameters, total=False):
    """The keywords beside an amount, with a box as the region."""

    bbox: Required[Numbers]
    circle: None
    polygon: None
    chunk: None
    region: None
    crs: Any


class Shaped(Common, Parameters, total=False):
    """The keywords beside an amount, with another region, or none."""

    bbox: None
    circle: Numbers | Mapping[str, Any] | None
    polygon: Any
    chunk: Numbers | Mapping[str, Any] | None
    region: Mapping[str, Any] | None
    crs: Any


class Volumes(Common, total=False):
    """The keywords of a query in space beside an amount; those that the plane has, too, mean the same."""

    bbox: Numbers | None
    ball: Numbers | Mapping[str, Any] | None
    prism: tuple[Any, Number, Number] | Mapping[str, Any] | None
    chunk: Numbers | Mapping[str, Any] | None
    region: Mapping[str, Any] | None
    attributes: SpaceAttribute | Sequence[SpaceAttribute] | None
    crs: Any


class SpaceQuery(Volumes, Amounts, total=False):
    """The keywords of a query in space: see :class:`Query`."""

    layers: Sequence[Mapping[str, Any]] | None


#: The meanings of the keywords that are no parameters of addresses.
ABOUT_MORE = {
    "chunk": "size, column, row of a square of the world grid; coordinates are relative to its corner.",
    "region": "Any region as JSON has it, with ``include`` and ``exclude``.",
    "features": (
        'Each feature of a collection by itself, as a layer of its name: {"of": gdf.__geo_interface__, "id": "NAME", '
        '"count": "TREES"} with the properties that hold names and numbers of points.'
    ),
    "layers": "Several sets at once: a list of dicts with a ``name`` each.",
    "crs": (
        "The reference system of all coordinates: a code of EPSG, a text such as ``EPSG:32633``, or an object of pyproj. "
        "By default that of regions, features, fields and terrain; another one is refused, since coordinates do not "
        "change."
    ),
}
#: The meanings of the keywords in space, where they are not those of the plane.
ABOUT_SPACE = {
    "bbox": "The region as a box: min_x, min_y, min_z, max_x, max_y, max_z.",
    "ball": "The region as a ball: x, y, z and its radius.",
    "prism": (
        "The region as an upright prism: the vertices of its base, or GeoJSON, the height of its bottom, and "
        "of its top."
    ),
    "chunk": "size, x, y, z of a cube of the world grid; coordinates are relative to its corner.",
    "region": "Any volume as JSON has it, with ``include`` and ``exclude``.",
    "layers": "Several sets at once: a list of dicts with a ``name`` each.",
    "profile": "The noise profile: blue or spaced, or what a daemon has.",
    "alpha": "The number α of the pattern.",
    "map": "The size of the neighborhood map, such as r16.",
    "attributes": (
        "Further values of each point: rotation (a uniform unit quaternion, the columns qx, qy, qz and qw), "
        "scale, variant, rank, u1 to u16."
    ),
    "variants": "The names that the attribute variant chooses from, with their weights.",
    "crs": ABOUT_MORE["crs"],
}


def _region(shape: str, value: Any) -> dict[str, Any]:
    if hasattr(value, "__geo_interface__"):
        value = Placed.of(value.__geo_interface__, named(getattr(value, "crs", None), shape))
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, range):
        value = list(value)
    # Other values are passed on unchanged, to be refused in the words of REST.
    if isinstance(value, (list, tuple)):
        if shape == "circle" and len(value) == 3:
            value = {"center": [value[0], value[1]], "radius": value[2]}
        elif shape == "ball" and len(value) == 4:
            value = {"center": list(value[:3]), "radius": value[3]}
        elif shape == "chunk" and len(value) in (3, 4):
            value = dict(zip(("size", "x", "y", "z"), value))
        elif shape == "prism" and len(value) == 3:
            base, bottom, top = value
            value = {**_region("polygon", base), "bottom": bottom, "top": top}
        elif shape == "polygon":
            if value and all(map(_is_number, value)) and len(value) % 2 == 0:
                # x1, y1, x2, y2, …, as in addresses.
                value = [value[i : i + 2] for i in range(0, len(value), 2)]
            if not all(isinstance(vertex, (list, tuple, np.ndarray)) for vertex in value):
                raise fault(shape, value, "not vertices", "pairs of numbers, x1, y1, x2, y2, …, or GeoJSON")
            ring = [list(vertex) for vertex in value]
            if ring and ring[0] != ring[-1]:
                ring.append(ring[0])
            value = {"type": "Polygon", "coordinates": [ring]}
    return {shape: value}


def body(keywords: Mapping[str, Any]) -> Body:
    """Keywords as a body. Those that are ``None`` are left out."""
    made: Body = {}
    for name, value in keywords.items():
        if value is None:
            continue
        if iskeyword(name[:-1]) and name.endswith("_"):
            name = name[:-1]
        if name in SHAPES or name in VOLUMES:
            # Several shapes are refused together, with all their names.
            made.setdefault("region", {})
            made["region"] = {**made["region"], **_region(name, value)}
        elif KINDS.get(name) == "names" and isinstance(value, str):
            made[name] = [word.strip() for word in value.split(",")]
        else:
            made[name] = value
    return made


def text(body: Mapping[str, Any]) -> str:
    """A body as JSON. Raises :class:`StrewError` with the member that has no form in JSON."""
    if not isinstance(body, Mapping):
        raise fault("query", body, "not a body of REST", "a dict such as {'region': {'bbox': [0, 0, 9, 9]}, 'spacing': 1}")
    for name, value in body.items():
        _check(name, value)
    try:
        return json.dumps(body, default=_plain, separators=(",", ":"), allow_nan=False)
    except (TypeError, ValueError):
        for name, value in body.items():
            _written(name, value)
        raise


def features(features: Any) -> Any:
    """Features without the properties that are not read: columns of a frame may have values that JSON lacks. Those of a
    frame are named by its index, if by no column."""
    of = features.get("of") if isinstance(features, Mapping) else None
    is_frame = hasattr(of, "__geo_interface__")
    of = getattr(of, "__geo_interface__", of)
    if not isinstance(of, Mapping) or not isinstance(of.get("features"), (list, tuple)):
        return features
    if is_frame and features.get("id") is None:
        features = {**features, "id": "index"}
    id, count = features.get("id"), features.get("count")
    read, bare = [], []
    for feature in of["features"]:
        own = feature.get("properties") if isinstance(feature, Mapping) else None
        if isinstance(own, Mapping):
            own = {**own, "index": feature["id"]} if is_frame and id == "index" and "index" not in own else own
            feature = {**feature, "properties": {name: own[name] for name in own if name in (id, count)}}
            if feature.get("geometry") is None:
                bare.append(str(own.get(id)))
        read.append(feature)
    if bare:
        warnings.warn(f"features without a geometry have no points: {', '.join(bare)}", stacklevel=5)
    return {**features, "of": {**of, "features": read}}


def _check(name: str, value: Any) -> None:
    """Refuses what JSON would take for something else."""
    kind = KINDS.get(name)
    of_fields = value.values() if kind == "fields" and isinstance(value, Mapping) else [value]
    if kind in ("field", "fields"):
        for field in of_fields:
            if hasattr(field, "__array__") or hasattr(field, "read"):
                raise fault(name, field, "an array is no field yet", "strew.raster(array, bbox=…), a name, or a field as in JSON")
    if hasattr(value, "integers") and hasattr(value, "random"):
        way_out = "an integer, such as int(generator.integers(2**63))"
        raise fault(name, value, "a generator is not stored: the same query must have the same points", way_out)


def _written(name: str, value: Any) -> None:
    try:
        json.dumps(value, default=_plain, allow_nan=False)
    except TypeError as error:
        raise fault(name, value, str(error), "what JSON has: numbers, texts, lists, dicts, True and False") from None
    except ValueError:
        detail = "not finite" if isinstance(value, float) else "holds a number that is not finite"
        raise fault(name, value, detail, "finite numbers") from None


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, range):
        return list(value)
    if isinstance(value, (Decimal, Fraction)):
        return float(value)
    if isinstance(value, Mapping):
        return dict(value)
    if hasattr(value, "__geo_interface__"):
        return value.__geo_interface__
    raise TypeError(f"a query cannot hold a {type(value).__name__}")


#: The longest address that is sent, in characters. Proxies and caches refuse much longer ones.
LONGEST = 2000


def path(query: Body, dimension: Dimension = PLANE) -> str | None:
    """The address of a query that is short and means the same there, so that caches keep its answer."""
    values = {name: value for name, value in query.items() if name != "region"}
    route = f"{dimension.root}/points"
    circle, axes = ("ball", 3) if dimension is SPACE else ("circle", 2)
    corner = ("size", *dimension.axes)
    if "region" in query:
        region = query["region"]
        if not isinstance(region, Mapping) or len(region) != 1:
            return None
        [(shape, place)] = region.items()
        place = place.tolist() if isinstance(place, np.ndarray) else place
        if shape == "bbox" and _is_numbers(place, 2 * axes):
            values["bbox"] = place
        elif isinstance(place, Mapping) and shape == circle and set(place) == {"center", "radius"}:
            values[circle] = [*place["center"], place["radius"]] if _is_numbers(place["center"], axes) else None
        elif isinstance(place, Mapping) and shape == "chunk" and set(place) == set(corner):
            parts = [place[name] for name in corner]
            if not _is_numbers(parts):
                return None
            route = f"{dimension.root}/chunks/" + "/".join(map(_text, parts))
        else:
            return None
    if not all(_is_plain(name, value) for name, value in values.items()):
        return None
    made = f"{route}?{address(values)}"
    return made if len(made) <= LONGEST else None


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool)


def _is_numbers(value: Any, count: int | None = None) -> bool:
    is_list = isinstance(value, (list, tuple)) and count in (None, len(value))
    return is_list and len(value) > 0 and all(map(_is_number, value))


def _is_plain(name: str, value: Any) -> bool:
    """Whether a member is written in an address as in a body. What is wrong is refused in the words of bodies."""
    kind = KINDS.get(name)
    if kind in ("text", "field"):
        return isinstance(value, str)
    if kind == "switch":
        return isinstance(value, bool)
    if kind == "names":
        return isinstance(value, (list, tuple)) and len(value) > 0 and all(isinstance(one, str) for one in value)
    if kind in ("weights", "ranges"):
        items = value.items() if isinstance(value, Mapping) else ()
        return bool(items) and all(isinstance(key, str) and (_is_number(of) or _is_numbers(of, 2)) for key, of in items)
    return _is_number(value) or _is_numbers(value)


def address(values: Mapping[str, Any]) -> str:
    """Values as the parameters of an address."""
    pairs = (f"{quote(name, safe='')}={quote(_text(value), safe=',:')}" for name, value in values.items())
    return "&".join(pairs)


def _text(value: Any) -> str:
    if isinstance(value, (np.ndarray, np.generic)):
        value = value.tolist()
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, Mapping):
        pairs = ((name, part if isinstance(part, (list, tuple)) else [part]) for name, part in value.items())
        return ",".join(":".join([str(name), *map(_text, part)]) for name, part in pairs)
    if isinstance(value, (list, tuple)):
        return ",".join(map(_text, value))
    return repr(value) if isinstance(value, float) else str(value)
