"""Hooks that make the queries of schemathesis valid: by the rules that the document publishes
(`x-rules`), and with moderate numbers.

No schema says which tables are loaded, or that a region of 1e300 holds too many points. Without
these hooks next to no answer would have points; with them every query must be accepted.
"""

import schemathesis

# Members that name what a server may lack.
NAMED = ["alpha", "map", "table", "cursor", "world", "world_digest", "field", "variant_fields", "except"]
PROFILES = ["blue", "spaced", "step", "pink"]
SQUARE = {"type": "Polygon", "coordinates": [[[0, 0], [9, 0], [9, 9], [0, 9], [0, 0]]]}
FEATURES = {"of": {"type": "FeatureCollection", "features": [{"type": "Feature", "geometry": SQUARE}]}}
NAMES = ["angle", "scale", "variant", "rank", "u1", "u16"]


def number(value, low, high):
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return low
    return low + abs(value) % (high - low)


def choose(value, among):
    return among[len(str(value)) % len(among)]


def drop(query, names):
    for name in names:
        query.pop(name, None)


def has(query, name, values):
    """Whether a member has one of some values, or a list one among its items; of no values, any."""
    given = query.get(name)
    items = given.split(",") if isinstance(given, str) else given if isinstance(given, list) else [given]
    return name in query and (not values or any(value in items for value in values))


def obey(query, rules):
    """Drops members whose rules others do not fulfill."""
    for rule in rules:
        if rule["rule"] == "only-with":
            fits = has(query, rule["other"], rule["values"])
        elif rule["rule"] == "only-with-one-of":
            fits = any(has(query, other["parameter"], other["values"]) for other in rule["others"])
        elif rule["rule"] == "not-with":
            fits = not any(other in query for other in rule["others"])
        else:
            continue
        if not fits:
            query.pop(rule["parameter"], None)


def amounts_of(rules):
    """The amounts of a query: one is required, or at most one may be given."""
    rules = (rule["parameters"] for rule in rules if rule["rule"] in ["exactly-one-of", "at-most-one-of"])
    return next((names for names in rules if "density" in names), [])


def not_with(rules, name):
    rules = (rule["others"] for rule in rules if rule["rule"] == "not-with" and rule["parameter"] == name)
    return next(rules, [])


def one_of(query, among, default):
    """Keeps one member of some, chosen by the query itself."""
    given = [name for name in among if name in query] or [default]
    chosen = choose(query, given)
    drop(query, [name for name in among if name != chosen])
    query.setdefault(chosen, 1)
    return chosen


def tidy_set(query, is_text, rules, amounts, in_space=False):
    amount = one_of(query, amounts, "spacing")
    query[amount] = 1 + int(number(query[amount], 0, 300)) if amount == "count" else number(
        query[amount], 0.5, 4
    )
    drop(query, NAMED)
    if "profile" in query:
        query["profile"] = "blue" if amount == "min_distance" else choose(
            query["profile"], ["blue", "spaced"] if in_space else PROFILES
        )
    if "keep" in query:
        query["keep"] = number(query["keep"], 0.1, 1)
    if "warp" in query:
        query["warp"] = choose(query["warp"], ["on", "off"] if is_text else ["on", 0.5, 2])
    if "seed" in query:
        query["seed"] = int(number(query["seed"], 0, 2**53))
    spread = "even" if "spread" in query and query.get("profile", "blue") == "blue" else "chance"
    names = []
    if "attributes" in query:
        names = NAMES[: 1 + len(str(query["attributes"])) % len(NAMES)]
        if in_space:
            names = ["rotation" if name == "angle" else name for name in names]
        query["attributes"] = ",".join(names) if is_text else names
    is_mixed = "variant" in names or spread == "even"
    has_ranges = "scale" in names and "scale_ranges" in query and is_mixed
    if has_ranges:
        ranges = {"oak": [0.5, 2], "birch": [0, 1]}
        query["scale_ranges"] = "oak:0.5:2,birch:0:1" if is_text else ranges
        query.pop("scale_range", None)
    else:
        query.pop("scale_ranges", None)
        if "scale_range" in query:
            query["scale_range"] = "0.5,2" if is_text else [0.5, 2]
    if "terrain" in query and not is_text:
        query["terrain"] = {"constant": 0.5}
    else:
        # No field is loaded that an address could name.
        query.pop("terrain", None)
    query.pop("variants", None)
    if is_mixed:
        query["variants"] = "oak:3,birch" if is_text else {"oak": 3, "birch": 1}
    if "spread" in query:
        query["spread"] = spread
    if spread == "even":
        # Its kinds are made soonest.
        query["map"] = "s"
    if "only" in query:
        query["only"] = choose(query["only"], ["oak", "birch"])
    obey(query, rules)


def tidy_output(query, rules):
    # Records without room for some attributes are refused.
    if query.get("format") in ["multimesh", "instances"]:
        query["format"] = "glb"
    if "decimals" in query:
        query["decimals"] = int(number(query["decimals"], 0, 17))
    if "size" in query:
        query["size"] = 16 + int(number(query["size"], 0, 500))
    if "crs" in query:
        query["crs"] = "EPSG:3857"
    if "limit" in query:
        query["limit"] = 1 + int(number(query["limit"], 0, 200))
    if "offset" in query:
        query["offset"] = int(number(query["offset"], 0, 50))
    obey(query, rules)


def volume(value):
    value = value if isinstance(value, dict) else {}
    shift = number(len(str(value)), 0, 9)
    ball = {"ball": {"center": [shift, -shift, 1], "radius": 2 + shift / 9}}
    if "ball" in value:
        return ball
    if "prism" in value:
        base = {"type": "Polygon", "coordinates": [[[0, 0], [4, shift - 5], [3, 4], [0, 0]]]}
        return {"prism": {"polygon": base, "bottom": -shift, "top": 1}}
    if "chunk" in value:
        return {"chunk": {"size": 1 + shift / 3, "x": -3, "y": int(shift), "z": 1}}
    if "include" in value:
        return {"include": [ball, {"bbox": [0, 0, 0, 3, 2, 1]}], "exclude": []}
    return {"bbox": [-shift / 3, 0, 1, 4, 3 + shift / 3, 3]}


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
        include = value.get("include")
        items = include[:3] if isinstance(include, list) else []
        regions = [region(item, depth + 1) for item in items] or [region({}, depth + 1)]
        # What is left must not be empty.
        exclude = [{"circle": {"center": [1, 1], "radius": 0.1 + shift / 99}}]
        return {"include": regions, "exclude": exclude if value.get("exclude") else []}
    return {"bbox": [-shift, 0, 4, 9 + shift]}


def tidy_body(schema, body, in_space):
    body = dict(body)
    rules = schema["x-rules"]
    amounts = amounts_of(rules)
    layers = body.get("layers")
    is_layered = isinstance(layers, list) and bool(layers)
    is_periodic = "periodic" in body and not is_layered
    body.pop("periodic", None)
    place = volume if in_space else region
    body["region"] = place(body.get("region"))
    if is_layered:
        either = schema["allOf"][0]["oneOf"]
        excluded = next(one["properties"] for one in either if "layers" in one.get("required", []))
        drop(body, [*excluded, *NAMED, "seed", "keep", "only", "features"])
        tidy = []
        for i, layer in enumerate(layers[:4]):
            layer = dict(layer) if isinstance(layer, dict) else {}
            is_clear = "clear_of" in layer and i > 0
            own = [name for name in amounts if not is_clear or name != "count"]
            tidy_set(layer, False, rules, own, in_space)
            layer["name"] = f"layer-{i}"
            layer.pop("count" if is_clear else "clear_of", None)
            if is_clear:
                layer["clear_of"] = {f"layer-{j}": 0.5 for j in range(i) if "count" not in tidy[j]}
            if "region" in layer:
                layer["region"] = place(layer["region"])
                if "count" in layer:
                    layer.pop("region")
            tidy.append(layer)
        body["layers"] = tidy
    else:
        body.pop("layers", None)
        others = not_with(rules, "periodic") if is_periodic else []
        tidy_set(body, False, rules, [name for name in amounts if name not in others], in_space)
        if is_periodic:
            drop(body, [*others, "region", "features"])
            body["periodic"] = 900
        elif "features" in body:
            drop(body, ["region"])
            body["features"] = FEATURES
    tidy_output(body, rules)
    return body


def tidy_arrangement(query, rules, is_text):
    offsets = [[2, 1], [-3, 5 + len(str(query.get("offsets"))) % 4]]
    query["offsets"] = " ".join(f"{x},{y}" for x, y in offsets) if is_text else offsets
    if "grid" in query or "list" in query:
        query["grid"] = "-20,3,31,40" if is_text else [-20, 3, 31, 40]
    drop(query, NAMED)
    if "limit" in query:
        query["limit"] = 1 + int(number(query["limit"], 0, 200))
    if "seed" in query:
        query["seed"] = int(number(query["seed"], 0, 2**53))
    given = [name for name in amounts_of(rules) if name in query]
    drop(query, given[1:])
    if given:
        query[given[0]] = number(query[given[0]], 0.5, 4)
    obey(query, rules)
    if "profile" in query:
        query["profile"] = "blue"
    if "warp" in query:
        query["warp"] = "on"
    return query


def tidy_pattern(query):
    """Parameters of clusters, maps and figures: small ones of one pattern."""
    drop(query, NAMED)
    if "offsets" in query:
        query["offsets"] = "2,1 3,3"
    if "distance" in query:
        query["distance"] = number(query["distance"], 1, 3)
    if "most" in query:
        query["most"] = 1 + int(number(query["most"], 0, 20))
    if "radius" in query:
        query["radius"] = 1 + int(number(query["radius"], 0, 30))
    if "refined" in query:
        query["refined"] = 40
    if "block" in query:
        query["block"] = "0,0"
    if "window" in query:
        query["window"] = 8 + int(number(query["window"], 0, 30))
    if "size" in query:
        query["size"] = 64 + int(number(query["size"], 0, 300))
    return query


def tidy_mask(query):
    """Parameters of masks: small ones of loaded tables."""
    drop(query, NAMED)
    if "profile" in query:
        query["profile"] = choose(query["profile"], PROFILES)
    if "seed" in query:
        query["seed"] = int(number(query["seed"], 0, 2**53))
    query["size"] = 16 + int(number(query.get("size"), 0, 60))
    return query


FIGURES = ["Index", "Arrangement", "Clusters", "Map"]
PATTERNS = ["getClusters", "getMap"] + [f"get{name}{form}" for name in FIGURES for form in ["Figure", "Picture"]]
MASKS = ["getMask", "getMaskSpectrum"]


def tidy_query(name, rules, query):
    query = dict(query)
    if name == "getArrangement":
        return tidy_arrangement(query, rules, True)
    if name in PATTERNS:
        return tidy_pattern(query)
    if name in MASKS:
        return tidy_mask(query)
    for rule in rules:
        if rule["rule"] == "exactly-one-of" and "bbox" in rule["parameters"]:
            shape = one_of(query, rule["parameters"], "bbox")
            shapes = {"bbox": "-5,0,7,9", "circle": "1,2,6", "polygon": "0,0,9,1,3,12", "periodic": 900}
            if "Space" in name:
                shapes = {"bbox": "-1,0,2,4,5,4", "ball": "1,2,3,3"}
            query[shape] = shapes[shape]
        elif rule["rule"] == "exactly-one-of":
            others = not_with(rules, "periodic") if "periodic" in query else []
            if "periodic" in query:
                query["periodic"] = 900
            drop(query, others)
            amounts = [one for one in rule["parameters"] if one not in others]
            tidy_set(query, True, rules, amounts, "Space" in name)
    if name in ["getNearest", "getSpaceNearest"]:
        query["at"] = "3,-2.5" if name == "getNearest" else "3,-2.5,1"
        if "k" in query:
            query["k"] = 1 + int(number(query["k"], 0, 50))
        if "radius" in query:
            query["radius"] = number(query["radius"], 0, 9)
    if name in ["getProfile", "getSpectrum"]:
        query.clear()
    if name == "listPeriods":
        drop(query, NAMED)
        if "profile" in query:
            query["profile"] = choose(query["profile"], PROFILES)
    if name in ["splitPoints", "splitSpacePoints"]:
        query["parts"] = 1 + int(number(query.get("parts"), 0, 50))
    tidy_output(query, rules)
    return query


def query_of(name):
    """The name of the schema of a body."""
    if "Space" in name:
        return "SpaceQuery"
    return "CountQuery" if name == "countPoints" else "PointsQuery"


@schemathesis.hook
def before_call(context, case, kwargs):
    raw = case.operation.definition.raw
    name = raw.get("operationId", "")
    schemas = case.operation.schema.raw_schema["components"]["schemas"]
    if name == "sendExcept" and isinstance(case.body, dict):
        # The grammar of an id is more than its type.
        case.body = {"ids": [f"{i}:-3" for i in range(max(1, len(case.body.get("ids") or [])))]}
    elif isinstance(case.body, dict):
        case.body = (
            tidy_arrangement(dict(case.body), schemas["ArrangementQuery"]["x-rules"], False)
            if name == "findArrangement"
            else tidy_body(schemas[query_of(name)], case.body, "Space" in name)
        )
    if "x-rules" in raw or name in ["getProfile", "getSpectrum", "listPeriods", "splitPoints", "splitSpacePoints"] + PATTERNS + MASKS:
        case.query = tidy_query(name, raw.get("x-rules", []), case.query or {})
    if name in ["getChunk", "getFieldChunk", "getSpaceChunk"]:
        path = dict(case.path_parameters or {})
        path["size"] = 1 + len(str(path)) % 9
        path["cx"] = int(number(path.get("cx"), 0, 1000))
        path["cy"] = -int(number(path.get("cy"), 0, 1000))
        if "cz" in path:
            path["cz"] = int(number(path["cz"], 0, 1000))
        case.path_parameters = path
    if name == "getPoint":
        case.path_parameters = {"id": f"{len(str(case.query))}:-3"}
    if name == "getSpacePoint":
        case.path_parameters = {"id": f"{len(str(case.query))}:-3:2"}
