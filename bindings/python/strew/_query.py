"""Queries: keywords as the body, and as the address, that REST takes."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from keyword import iskeyword
from typing import TYPE_CHECKING, Any, TypedDict
from urllib.parse import quote

import numpy as np

from ._parameters import KINDS, OUTPUT, REGIONS, WINDOW, Numbers, Parameters, Regions

if TYPE_CHECKING:
    from typing_extensions import TypeAlias

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


class Shapes(Regions, total=False):
    """The regions that are keywords."""

    #: size, column, row of a square of the world grid; coordinates are relative to its corner.
    chunk: Numbers | Mapping[str, Any]


class Query(Shapes, Parameters, total=False):
    """The keywords of a query: the members of REST's JSON, and the shapes of regions by themselves.

    ``except`` is a word of Python: its keyword is ``except_``.
    """

    #: Any region as JSON has it, with ``include`` and ``exclude``.
    region: Mapping[str, Any]
    #: Each feature of a collection by itself, as a layer of its name: ``{"of": gdf.__geo_interface__, "id": "NAME",
    #: "count": "TREES"}`` with the properties that hold names and numbers of points.
    features: Mapping[str, Any]
    #: Several sets at once: a list of dicts with a ``name`` each.
    layers: Sequence[Mapping[str, Any]]


class Volumes(TypedDict, total=False):
    """The regions of space that are keywords."""

    #: The region as a box: min_x, min_y, min_z, max_x, max_y, max_z.
    bbox: Numbers
    #: The region as a ball: x, y, z and its radius.
    ball: Numbers | Mapping[str, Any]
    #: The region as an upright prism: the vertices of its base, or GeoJSON, the height of its bottom, and of its top.
    prism: tuple[Any, float, float] | Mapping[str, Any]
    #: size, x, y, z of a cube of the world grid; coordinates are relative to its corner.
    chunk: Numbers | Mapping[str, Any]
    #: Any volume as JSON has it, with ``include`` and ``exclude``.
    region: Mapping[str, Any]


class SpaceQuery(Volumes, total=False):
    """The keywords of a query in space; those that the plane has, too, mean the same: see :class:`Query`."""

    #: Several sets at once: a list of dicts with a ``name`` each.
    layers: Sequence[Mapping[str, Any]]
    #: Points per unit of volume.
    density: float
    #: The mean spacing in world units: density^-1/3.
    spacing: float
    #: The least distance of any two points in world units.
    min_distance: float
    #: The noise profile: blue or spaced, or what a daemon has.
    profile: str
    #: The number α of the pattern.
    alpha: str | float
    #: The size of the neighborhood map, such as r16.
    map: str
    #: The digest of the table that must answer.
    table: str
    #: Which set of points. Default: 0.
    seed: int
    #: The strength of the warp, from 0 to 2, ``"on"`` or ``"off"``.
    warp: str | float
    #: The share of points to keep, those of the lowest rank.
    keep: float
    #: Further values of each point: rotation (a uniform unit quaternion, the columns qx, qy, qz and qw), scale,
    #: variant, rank, u1 to u16.
    attributes: str | Sequence[str]
    #: The least and the greatest value of the attribute scale.
    scale_range: Numbers
    #: The least and the greatest value of the attribute scale for each variant.
    scale_ranges: Mapping[str, Numbers]
    #: The names that the attribute variant chooses from, with their weights.
    variants: Mapping[str, float]
    #: The number of points to leave out.
    offset: int
    #: The greatest number of points.
    limit: int
    #: Where an earlier answer to the same query ended.
    cursor: str


def _region(shape: str, value: Any) -> dict[str, Any]:
    if hasattr(value, "__geo_interface__"):
        value = value.__geo_interface__
    if isinstance(value, np.ndarray):
        value = value.tolist()
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
    """A body as JSON."""
    try:
        return json.dumps(body, default=_plain, separators=(",", ":"), allow_nan=False)
    except ValueError:
        for name, value in body.items():
            try:
                json.dumps(value, default=_plain, allow_nan=False)
            except ValueError:
                shown = value if isinstance(value, float) else "holds a number that"
                raise ValueError(f"`{name}`: {shown} is not finite; allowed: finite numbers") from None
        raise


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
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
