"""The parameters of queries. ``strew parameters --as py`` writes this file from crates/query/src/parameters.rs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, TypedDict, Union

import numpy as np

if TYPE_CHECKING:
    from typing_extensions import TypeAlias

Number: TypeAlias = "Union[float, np.integer[Any], np.floating[Any]]"
Integer: TypeAlias = "Union[int, np.integer[Any]]"
Numbers: TypeAlias = "Union[Sequence[Number], np.ndarray[Any, Any]]"
Attribute: TypeAlias = Literal[
    "angle", "scale", "variant", "rank", "u1", "u2", "u3", "u4", "u5", "u6",
    "u7", "u8", "u9", "u10", "u11", "u12", "u13", "u14", "u15", "u16",
]


class Regions(TypedDict, total=False):
    """Regions that are parameters by themselves: a query has one of them, or a member `region`."""

    bbox: Numbers | None
    circle: Numbers | Mapping[str, Any] | None
    polygon: Any | None


class Amounts(TypedDict, total=False):
    """How densely points lie: a set has one of them."""

    density: Number | None
    spacing: Number | None
    min_distance: Number | None
    count: Integer | None


class World(TypedDict, total=False):
    """What a query may leave everything open to."""

    world: str | None


class Common(TypedDict, total=False):
    """The parameters of queries of the plane and in space."""

    profile: str | None
    alpha: str | Number | None
    map: str | None
    table: str | None
    seed: Integer | None
    warp: str | Number | None
    keep: Number | None
    settle: Integer | None
    lod: Number | None
    field: str | Mapping[str, Any] | None
    except_: str | Sequence[str] | None
    scale_range: Numbers | None
    scale_ranges: Mapping[str, Numbers] | None
    variants: Mapping[str, Number] | None
    offset: Integer | None
    limit: Integer | None
    cursor: str | None


class Parameters(TypedDict, total=False):
    """The parameters of a query: which points, and which part of them."""

    periodic: Integer | None
    world_digest: str | None
    attributes: Attribute | Sequence[Attribute] | None
    spread: str | None
    variant_fields: Mapping[str, str | Mapping[str, Any]] | None
    only: str | None
    terrain: str | Mapping[str, Any] | None
    heights: Numbers | None
    normals: bool | None
    align: Number | None


class Output(TypedDict, total=False):
    """The options of a document, beside its format."""

    decimals: Integer | None
    size: Integer | None
    summary: bool | None
    crs: Any | None


#: Regions that are parameters by themselves.
REGIONS = ("bbox", "circle", "polygon")
#: Which part of the points an answer has.
WINDOW = ("offset", "limit", "cursor")
#: The form of an answer.
OUTPUT = ("format", "decimals", "size", "summary", "crs")
#: The formats that state the reference system of the plane.
PLACED = ("geojson", "parquet",)
#: The kinds of values by their parameters.
KINDS = {
    "bbox": "numbers", "circle": "numbers", "polygon": "pairs", "periodic": "integer", "density": "number",
    "spacing": "number", "min_distance": "number", "count": "integer", "world": "text", "world_digest": "text",
    "profile": "text", "alpha": "text", "map": "text", "table": "text", "seed": "integer", "warp": "strength",
    "keep": "number", "settle": "integer", "lod": "number", "field": "field", "except": "names", "attributes": "names",
    "scale_range": "numbers", "scale_ranges": "ranges", "variants": "weights", "spread": "text",
    "variant_fields": "fields", "only": "text", "offset": "integer", "limit": "integer", "cursor": "text",
    "format": "text", "decimals": "integer", "size": "integer", "summary": "switch", "crs": "text", "terrain": "field",
    "heights": "numbers", "normals": "switch", "align": "number",
}
#: The meaning, the allowed values and the default of each parameter, which docstrings show.
ABOUT = {
    "bbox": "The region as a box: min ≤ p < max on the reported coordinates. Allowed: four finite numbers "
            "min_x,min_y,max_x,max_y with min_x < max_x and min_y < max_y. ",
    "circle": "The region as a circle: the points nearer to x,y than the radius. Allowed: three finite numbers "
              "x,y,radius with a radius above 0. ",
    "polygon": "The region as a polygon with these vertices. Polygons that share an edge share no point and leave none "
               "out. Vertices, or GeoJSON. ",
    "periodic": "One exact period of points on [0, L)² instead of a region: the smallest that has at least this many "
                "points. Its copies, moved by L, continue one another. L is the mean spacing times the root of the "
                "number of points. Small maps have more periods: with map=m, the default, 5000 becomes 57121, with "
                "map=s 5041. The list of periods has all. Allowed: an integer from 1 to 4294967296. Default: the "
                "points of a region, on the unbounded plane. ",
    "density": "Points per unit of area, in space of volume. Allowed: a number from 1e-200 to 1e200. ",
    "spacing": "The mean spacing in world units: density^-1/2, in space density^-1/3. Allowed: a number from 1e-100 to "
               "1e100. ",
    "min_distance": "The least distance of any two points in world units: the density is the greatest that guarantees "
                    "it, with the warp. Not for profiles that guarantee none. Allowed: a number from 1e-100 to 1e100. ",
    "count": "The exact number of points in the region: the density follows from it. Allowed: an integer from 1 to "
             "18446744073709551615. ",
    "world": "The world that everything is taken from that the query leaves open: layers or a set of points, seed, "
             "limit, format. The list of worlds shows what is loaded. Allowed: the name of a loaded world. Default: "
             "none. ",
    "world_digest": "The digest that the world must have: caches may keep the answer forever. If the server's world "
                    "has another one, the query is refused. Allowed: 64 hexadecimal digits, as in the header "
                    "strew-world, beside world. Default: any. ",
    "profile": "The noise profile. The list of profiles shows what is loaded. Allowed: the name of a loaded profile. "
               "Default: blue. ",
    "alpha": "The number α of the pattern, as a decimal, a fraction or a quadratic irrational. Allowed: a number for "
             "which the profile is loaded. Default: (5-sqrt(3))/2. ",
    "map": "The size of the neighborhood map: larger maps have better quality and take more memory. Allowed: s, m or "
           "l, if the profile is loaded with it. Default: m; of pink l; if it is not loaded, s or the smallest, unless "
           "profile and alpha are the default. ",
    "table": "The digest of the table that must answer: caches may keep the answer forever. If another table would "
             "answer, the query is refused. Allowed: 64 hexadecimal digits, as in `points.tables`. Default: any table "
             "that fits the query. ",
    "seed": "Which set of points. Seed 0 is the plain pattern, every other seed a set of its own. Beside layers: the "
            "common seed, from which each layer without a seed has one by its name. Allowed: an integer from 0 to "
            "18446744073709551615. Default: 0. ",
    "warp": "The strength of the warp that makes a set isotropic and unlike those of other seeds: 0 (off), 1 (on), or "
            "between 0 and 2. Allowed: off, on, or a number from 0 to 2. Default: off for seed 0, else on. ",
    "keep": "The share of points to keep, those of the lowest rank. A smaller share keeps a subset of a larger one. "
            "Allowed: a number from 1e-6 to 1. Default: 1. ",
    "settle": "The steps by which the points of a set that is thinned or in a field move apart, so that they are "
              "spread evenly: 0 leaves them where their ranks have them, 4 is the smoothest. Each step takes its time. "
              "Sets with all points stay by default; for them 1 is one small step that moves the nearest points apart, "
              "and more count as 1. In space they stay: it counts as 0. Allowed: an integer from 0 to 4. Default: 2; 0 "
              "for sets with all points. ",
    "lod": "The level of detail: the part of the points that the answer has, at each place those of the lowest rank. "
           "None of them moves, so a level has a part of the points of a finer one, in fields, of kinds and of layers, "
           "too. Beside layers: of all of them; they keep clear of all points of each other. Allowed: a number from "
           "1e-6 to 1. Default: 1. ",
    "field": "The field that thins the points out, from place to place: a share of the density, which is that where "
             "the field is 1. The list of fields shows what is loaded. By its name, or as in JSON; see `strew.raster`. "
             "Default: none. ",
    "except_": "The points that are left out, by their ids, lists of the server by their names, and lists that were "
               "sent by their digests. Other layers keep clear of them all the same. Beside layers ids are "
               "layer/column:row. The list of lists shows what is loaded. Default: none. ",
    "attributes": "Further values of each point, hashed from its id and the seed: angle (radians, 0 to 2π), scale "
                  "(within scale_range), variant (one of variants, by weight), rank (0 to 1, see keep), u1 to u16 "
                  "(uniform, 0 to 1). Default: none. ",
    "scale_range": "The least and the greatest value of the attribute scale. Allowed: two numbers min,max with 0 <= "
                   "min <= max <= 1e9, beside the attribute scale. Default: 0,1. ",
    "scale_ranges": "The least and the greatest value of the attribute scale for each variant. Default: scale_range "
                    "for all. ",
    "variants": "The names that the attribute variant chooses from, with their weights. Their order does not matter. ",
    "spread": "How variants are spread. chance: each point has one by chance. even: each variant is evenly spread, "
              "like the points of all of them together, which do not move. joint: more evenly still, on a table made "
              "for these shares. Allowed: chance, even, joint. Default: chance. ",
    "variant_fields": "The fields that multiply the weights of variants, from place to place. A variant without one "
                      "has its weight; where all weights are zero, the fields do not count. Default: none. ",
    "only": "The one variant whose points are wanted, of those that are evenly spread. Beside layers: the one layer. "
            "Allowed: one of the names in variants, with spread even or joint; or the name of a layer. Default: all of "
            "them. ",
    "offset": "The number of points to leave out, in the fixed order, from the start or after the cursor. Allowed: an "
              "integer from 0 to 18446744073709551615. Default: 0. ",
    "limit": "The greatest number of points in the answer. `points.next` is the cursor of the rest. Allowed: an "
             "integer from 1 to 18446744073709551615. Default: all. ",
    "cursor": "Where an earlier answer to the same query ended: its `points.next`. Allowed: the cursor of an earlier "
              "answer to the same query. Default: the beginning. ",
    "terrain": "The terrain that points stand on: each has a height z. It is a field: its share becomes a height "
               "between heights. By its name, or as in JSON; see `strew.raster`. Default: none. ",
    "heights": "The heights of the terrain where its field is 0 and where it is 1, in world units. Allowed: two "
               "numbers low,high with -1e9 <= low < high <= 1e9, beside a terrain. Default: 0,1. ",
    "normals": "Whether points have the normal nx, ny, nz of the terrain, of unit length. Default: off. ",
    "align": "How far things lean from the vertical (0) to the normal of the terrain (1). Points then have a rotation "
             "qx, qy, qz, qw, which the attribute angle is part of. Allowed: a number from 0 to 1, beside a terrain. "
             "Default: no rotations. ",
    "decimals": "The number of decimals in text formats, rounded to the nearest, ties to even; zero has no sign. "
                "Coordinates are rounded within the box around the region: min ≤ p < max stays true. Allowed: an "
                "integer from 0 to 17. Default: the fewest digits that read back as the same number. ",
    "size": "The longer side of a picture (png, svg) in pixels. Allowed: an integer from 16 to 4096. Default: 512. ",
    "summary": "Whether ndjson ends with a line that is not a point: the query, the table and the count. Without it, "
               "programs that expect rows of one kind read the answer. Default: on. ",
    "crs": "The coordinate reference system of the plane, for geojson and Parquet: by default that of the region and "
           "of GeoTIFFs; another one is refused, since coordinates do not change. Without one readers of GeoJSON take "
           "coordinates for degrees. Allowed: an authority and a code joined by a colon, such as EPSG:3857, EPSG:32633 "
           "or OGC:CRS84. Default: none. ",
}
