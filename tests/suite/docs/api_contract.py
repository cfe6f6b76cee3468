"""Hooks that make the queries of schemathesis valid: by the rules that the document publishes
(`x-rules`), and with moderate numbers.

No schema says which tables are loaded, or that a region of 1e300 holds too many points. Without
these hooks next to no answer would have points; with them every query must be accepted.
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
    for name in ["alpha", "map", "table", "cursor", "world", "world_digest", "field", "variant_fields", "except"]:
        query.pop(name, None)
    if "profile" in query:
        query["profile"] = "blue" if amount == "min_distance" else choose(query["profile"], PROFILES)
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
        query["attributes"] = ",".join(names) if is_text else names
    is_mixed = "variant" in names or spread == "even"
    has_ranges = "scale" in names and "scale_ranges" in query and is_mixed
    if has_ranges:
        ranges = {"oak": [0.5, 2], "birch": [0, 1]}
        query["scale_ranges"] = "oak:0.5:2,birch:0:1" if is_text else ranges
    else:
        query.pop("scale_ranges", None)
    if "scale_range" in query:
        query["scale_range"] = "0.5,2" if is_text else [0.5, 2]
    if "scale" not in names or has_ranges:
        query.pop("scale_range", None)
    if "terrain" in query and not is_text:
        query["terrain"] = {"constant": 0.5}
    else:
        # No field is loaded that an address could name.
        for name in ["terrain", "heights", "normals", "align"]:
            query.pop(name, None)
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
        if spread != "even":
            query.pop("only")


def tidy_output(query):
    # Records without room for some attributes are refused.
    if query.get("format") in ["multimesh", "instances"]:
        query["format"] = "glb"
    if "decimals" in query:
        query["decimals"] = int(number(query["decimals"], 0, 17))
        if query.get("format") not in ["json", "ndjson", "csv", "geojson"]:
            query.pop("decimals")
    if "size" in query:
        query["size"] = 16 + int(number(query["size"], 0, 500))
        if query.get("format") not in ["png", "svg"]:
            query.pop("size")
    if "summary" in query and query.get("format") != "ndjson":
        query.pop("summary")
    if "crs" in query:
        query["crs"] = "EPSG:3857"
        if query.get("format") not in ["geojson", "geojsonseq"]:
            query.pop("crs")
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
        include = value.get("include")
        items = include[:3] if isinstance(include, list) else []
        regions = [region(item, depth + 1) for item in items] or [region({}, depth + 1)]
        # What is left must not be empty.
        exclude = [{"circle": {"center": [1, 1], "radius": 0.1 + shift / 99}}]
        return {"include": regions, "exclude": exclude if value.get("exclude") else []}
    return {"bbox": [-shift, 0, 4, 9 + shift]}


def tidy_body(name, body):
    body = dict(body)
    layers = body.get("layers")
    is_layered = isinstance(layers, list) and bool(layers)
    is_periodic = "periodic" in body and not is_layered
    body.pop("periodic", None)
    body["region"] = region(body.get("region"))
    if is_layered:
        for member in AMOUNTS + ["profile", "alpha", "map", "table", "seed", "warp", "keep"]:
            body.pop(member, None)
        for member in ["attributes", "variants", "scale_range", "scale_ranges", "spread", "only", "variant_fields"]:
            body.pop(member, None)
        for member in ["cursor", "world", "world_digest", "except", "field", "terrain", "heights", "normals", "align"]:
            body.pop(member, None)
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
        tidy_set(body, False, AMOUNTS[:2] if is_periodic else AMOUNTS)
        if is_periodic:
            for member in ["min_distance", "count", "region"]:
                body.pop(member, None)
            body["periodic"] = 900
    tidy_output(body)
    if name == "countPoints":
        for member in ["format", "decimals", "size", "summary", "crs", "offset", "limit"]:
            body.pop(member, None)
    return body


def tidy_arrangement(query, is_text):
    offsets = [[2, 1], [-3, 5 + len(str(query.get("offsets"))) % 4]]
    query["offsets"] = " ".join(f"{x},{y}" for x, y in offsets) if is_text else offsets
    if "grid" in query or "list" in query:
        query["grid"] = "-20,3,31,40" if is_text else [-20, 3, 31, 40]
    for name in ["alpha", "map", "cursor"]:
        query.pop(name, None)
    if "list" not in query:
        query.pop("limit", None)
    if "limit" in query:
        query["limit"] = 1 + int(number(query["limit"], 0, 200))
    if "seed" in query:
        query["seed"] = int(number(query["seed"], 0, 2**53))
    given = [name for name in AMOUNTS[:3] if name in query]
    for name in given[1:]:
        query.pop(name)
    if given:
        query[given[0]] = number(query[given[0]], 0.5, 4)
    for name in ["profile", "warp"]:
        if not given:
            query.pop(name, None)
    if "profile" in query:
        query["profile"] = "blue"
    if "warp" in query:
        query["warp"] = "on"
    return query


def tidy_pattern(query):
    """Parameters of clusters, maps and figures: small ones of one pattern."""
    query.pop("alpha", None)
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
    for member in ["alpha", "map", "table"]:
        query.pop(member, None)
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
        return tidy_arrangement(query, True)
    if name in PATTERNS:
        return tidy_pattern(query)
    if name in MASKS:
        return tidy_mask(query)
    for rule in rules:
        if rule["rule"] == "exactly-one-of" and "bbox" in rule["parameters"]:
            shape = one_of(query, rule["parameters"], "bbox")
            shapes = {"bbox": "-5,0,7,9", "circle": "1,2,6", "polygon": "0,0,9,1,3,12", "periodic": 900}
            query[shape] = shapes[shape]
        elif rule["rule"] == "exactly-one-of":
            amounts = rule["parameters"]
            if "periodic" in query:
                query["periodic"] = 900
                amounts = [name for name in amounts if name not in ["min_distance", "count"]]
            tidy_set(query, True, amounts)
            for name in set(rule["parameters"]) - set(amounts):
                query.pop(name, None)
    if name == "getNearest":
        query["at"] = "3,-2.5"
        if "k" in query:
            query["k"] = 1 + int(number(query["k"], 0, 50))
        if "radius" in query:
            query["radius"] = number(query["radius"], 0, 9)
    if name in ["getProfile", "getSpectrum"]:
        query.clear()
    if name == "listPeriods":
        for member in ["alpha", "map", "table"]:
            query.pop(member, None)
        if "profile" in query:
            query["profile"] = choose(query["profile"], PROFILES)
    if name == "splitPoints":
        query["parts"] = 1 + int(number(query.get("parts"), 0, 50))
    tidy_output(query)
    return query


@schemathesis.hook
def before_call(context, case, kwargs):
    raw = case.operation.definition.raw
    name = raw.get("operationId", "")
    if name == "sendExcept" and isinstance(case.body, dict):
        # The grammar of an id is more than its type.
        case.body = {"ids": [f"{i}:-3" for i in range(max(1, len(case.body.get("ids") or [])))]}
    elif isinstance(case.body, dict):
        case.body = (
            tidy_arrangement(dict(case.body), False)
            if name == "findArrangement"
            else tidy_body(name, case.body)
        )
    if "x-rules" in raw or name in ["getProfile", "getSpectrum", "listPeriods", "splitPoints"] + PATTERNS + MASKS:
        case.query = tidy_query(name, raw.get("x-rules", []), case.query or {})
    if name in ["getChunk", "getFieldChunk"]:
        path = dict(case.path_parameters or {})
        path["size"] = 1 + len(str(path)) % 9
        path["cx"] = int(number(path.get("cx"), 0, 1000))
        path["cy"] = -int(number(path.get("cy"), 0, 1000))
        case.path_parameters = path
    if name == "getPoint":
        case.path_parameters = {"id": f"{len(str(case.query))}:-3"}
