"""Hooks that make the queries of schemathesis valid: one region, one amount, moderate numbers.

No schema says that parameters exclude each other, or which tables are loaded. Without these hooks,
next to no answer would have points.
"""

import schemathesis

AMOUNTS = ["density", "spacing", "min_distance", "count"]
REGIONS = ["bbox", "circle", "polygon"]
PROFILES = ["blue", "spaced", "step", "pink"]
NAMES = ["angle", "scale", "variant", "rank", "u1", "u16"]


def number(value, low, high):
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return low
    return low + abs(value) % (high - low)


def choose(value, among):
    return among[len(str(value)) % len(among)]


def one_of(query, among, default):
    """Keeps one member of some, chosen by the query itself."""
    given = [name for name in among if name in query] or [default]
    chosen = choose(query, given)
    for name in among:
        if name != chosen:
            query.pop(name, None)
    query.setdefault(chosen, 1)
    return chosen


def tidy_set(query, is_text, amounts=AMOUNTS):
    amount = one_of(query, amounts, "spacing")
    query[amount] = 1 + int(number(query[amount], 0, 300)) if amount == "count" else number(
        query[amount], 0.5, 4
    )
    for name in ["alpha", "map", "table", "cursor"]:
        query.pop(name, None)
    if "profile" in query:
        query["profile"] = "blue" if amount == "min_distance" else choose(query["profile"], PROFILES)
    if "keep" in query:
        query["keep"] = number(query["keep"], 0.1, 1)
    if "warp" in query:
        query["warp"] = choose(query["warp"], ["on", "off"] if is_text else ["on", 0.5, 2])
    if "seed" in query:
        query["seed"] = int(number(query["seed"], 0, 2**53))
    if "attributes" in query:
        count = 1 + len(str(query["attributes"])) % len(NAMES)
        names = NAMES[:count]
        query["attributes"] = ",".join(names) if is_text else names
        query["variants"] = "oak:3,birch" if is_text else {"oak": 3, "birch": 1}
        if "variant" not in names:
            query.pop("variants")
        if "scale_range" in query:
            query["scale_range"] = "0.5,2" if is_text else [0.5, 2]
        if "scale" not in names:
            query.pop("scale_range", None)
    else:
        query.pop("variants", None)
        query.pop("scale_range", None)


def tidy_looks(query):
    if "decimals" in query and query.get("format") not in ["json", "ndjson", "csv", "geojson"]:
        query.pop("decimals")
    if "size" in query and query.get("format") not in ["png", "svg"]:
        query.pop("size")
    if "limit" in query:
        query["limit"] = 1 + int(number(query["limit"], 0, 200))
    if "offset" in query:
        query["offset"] = int(number(query["offset"], 0, 50))


def region(value, depth=0):
    value = value if isinstance(value, dict) else {}
    kinds = ["bbox", "circle", "polygon", "chunk", "include"]
    kind = next((kind for kind in kinds if kind in value), "bbox")
    shape = value.get(kind)
    shift = number(len(str(value)), 0, 9)
    if kind == "circle":
        radius = shape.get("radius") if isinstance(shape, dict) else 1
        return {"circle": {"center": [shift, -shift], "radius": number(radius, 0.5, 9)}}
    if kind == "polygon":
        outer = [[0, 0], [12, shift - 5], [14, 14], [shift, 9], [0, 0]]
        hole = [[3, 3], [4, 3], [4, 5]]
        if choose(shape, [True, False]):
            return {"polygon": {"type": "Polygon", "coordinates": [outer, hole]}}
        return {"polygon": {"type": "MultiPolygon", "coordinates": [[outer], [hole]]}}
    if kind == "chunk":
        return {"chunk": {"size": 1 + shift, "x": -3, "y": int(shift)}}
    if kind == "include" and depth < 3:
        lists = [value.get(name) or [] for name in ["include", "exclude"]]
        include, exclude = [
            [region(item, depth + 1) for item in items[:3]] if isinstance(items, list) else []
            for items in lists
        ]
        return {"include": include or [region({}, depth + 1)], "exclude": exclude}
    return {"bbox": [-shift, 0, 4, 9 + shift]}


def name_of(context):
    return context.operation.definition.raw.get("operationId", "")


@schemathesis.hook
def map_body(context, body):
    if not isinstance(body, dict):
        return body
    body["region"] = region(body.get("region"))
    layers = body.get("layers")
    if isinstance(layers, list) and layers:
        for name in AMOUNTS + ["profile", "alpha", "map", "table", "seed", "warp", "keep"]:
            body.pop(name, None)
        for name in ["attributes", "variants", "scale_range", "cursor"]:
            body.pop(name, None)
        tidy = []
        for i, layer in enumerate(layers[:4]):
            layer = dict(layer) if isinstance(layer, dict) else {}
            is_clear = "clear_of" in layer and i > 0
            tidy_set(layer, False, AMOUNTS[:3] if is_clear else AMOUNTS)
            layer["name"] = f"layer-{i}"
            layer.pop("count" if is_clear else "clear_of", None)
            if is_clear:
                layer["clear_of"] = {f"layer-{j}": 0.5 for j in range(i) if "count" not in tidy[j]}
            if "region" in layer:
                layer["region"] = region(layer["region"])
                if "count" in layer:
                    layer.pop("region")
            tidy.append(layer)
        body["layers"] = tidy
    else:
        body.pop("layers", None)
        tidy_set(body, False)
    tidy_looks(body)
    if name_of(context) == "countPoints":
        for name in ["format", "decimals", "size"]:
            body.pop(name, None)
    return body


@schemathesis.hook
def map_query(context, query):
    name = name_of(context)
    if not isinstance(query, dict) or name not in [
        "getPoints", "getCount", "getChunk", "getPoint", "getNearest",
    ]:
        return query
    tidy_set(query, True, AMOUNTS[:3] if name in ["getPoint", "getNearest"] else AMOUNTS)
    if name in ["getPoints", "getCount"]:
        shape = one_of(query, REGIONS, "bbox")
        query[shape] = {"bbox": "-5,0,7,9", "circle": "1,2,6", "polygon": "0,0,9,1,3,12"}[shape]
    if name == "getNearest":
        query["at"] = "3,-2.5"
        if "k" in query:
            query["k"] = 1 + int(number(query["k"], 0, 50))
        if "radius" in query:
            query["radius"] = number(query["radius"], 0, 9)
    tidy_looks(query)
    return query


@schemathesis.hook
def map_path_parameters(context, path_parameters):
    if name_of(context) == "getChunk" and isinstance(path_parameters, dict):
        path_parameters["size"] = 1 + len(str(path_parameters)) % 9
        path_parameters["cx"] = int(number(path_parameters.get("cx"), 0, 1000))
        path_parameters["cy"] = -int(number(path_parameters.get("cy"), 0, 1000))
    return path_parameters
