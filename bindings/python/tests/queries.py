"""Random queries, the same in every run."""

from __future__ import annotations

import random
from typing import Any

NAMES = ["oak", "birch", "fir"]


def random_query(seed: int, in_space: bool = False) -> dict[str, Any]:
    """A valid query of up to a few hundred points."""
    chance = random.Random(seed)
    query: dict[str, Any] = _set(chance, in_space)
    if chance.random() < 0.15:
        layers = [dict(_set(chance, in_space), name=f"layer{i}") for i in range(chance.randint(2, 3))]
        # What keeps clear of others, and layers of the plane, have no exact number.
        for layer in layers[-1:] if in_space else layers:
            if layer.pop("count", None):
                layer["spacing"] = 2
        if chance.random() < 0.5:
            layers[-1]["clear_of"] = {"layer0": chance.uniform(0.1, 1)}
        query = {"layers": layers}
    elif query.get("spread") and chance.random() < 0.3:
        query["only"] = "birch"
    query["region"] = _volume(chance) if in_space else _region(chance)
    if chance.random() < 0.1 and "layers" not in query and not in_space:
        query |= {"terrain": {"noise": {"wavelength": 30}}, "align": chance.random()}
    if chance.random() < 0.1:
        query["lod"] = chance.uniform(0.1, 1)
    if chance.random() < 0.1:
        query["offset"] = chance.randint(0, 20)
    if chance.random() < 0.1:
        query["limit"] = chance.randint(1, 50)
    return query


def random_query_in_space(seed: int) -> dict[str, Any]:
    """The same in space: tests of other bindings call it by its name."""
    return random_query(seed, in_space=True)


def _region(chance: random.Random) -> dict[str, Any]:
    x, y = (chance.uniform(-1, 1) * 10 ** chance.randint(0, 6) for _ in "xy")
    size = chance.uniform(2, 30)
    kind = chance.randrange(5)
    if kind == 0:
        return {"circle": {"center": [x, y], "radius": size / 2}}
    if kind == 1:
        return {"chunk": {"size": chance.choice([8, 16, 10.5]), "x": chance.randint(-9, 9), "y": chance.randint(-9, 9)}}
    if kind == 2:
        ring = [[x, y], [x + size, y + 1], [x + 2, y + size], [x, y]]
        return {"polygon": {"type": "Polygon", "coordinates": [ring]}}
    return {"bbox": [x, y, x + size, y + chance.uniform(2, 30)]}


#: The profiles, fields and attributes of sets of the plane, and of those in space.
PROFILES = (["spaced", "step", "green", "pattern"], ["spaced"])
FIELDS: Any = (
    [
        {"noise": {"wavelength": 11, "seed": 5}},
        {"radial": {"center": [0, 0], "radii": [5, 50]}},
        {"invert": {"ramp": {"from": [0, 0], "to": [9, 9]}}},
        {"multiply": [{"constant": 0.7}, {"distance": {"points": [[0, 0], [5, 5]], "distances": [1, 40]}}]},
    ],
    [
        {"noise": {"seed": 7, "wavelength": 8, "octaves": 2, "range": [0.3, 1]}},
        {"ramp": {"from": [0, 0, -9], "to": [9, 9, 9], "shares": [0.4, 1]}},
        {"multiply": [{"constant": 0.7}, {"radial": {"center": [0, 0], "radii": [1, 40], "shares": [0.5, 1]}}]},
    ],
)
ATTRIBUTES = (["angle", "scale", "rank", "u1", "u16", "variant"], ["rotation", "scale", "rank", "u1", "u16", "variant"])


def _set(chance: random.Random, in_space: bool = False) -> dict[str, Any]:
    amount = chance.choice(["density", "count", "min_distance", *["spacing"] * 5])
    ranges = {"density": (0.1, 2), "min_distance": (0.5, 2), "spacing": (0.7, 4)}
    query: dict[str, Any] = {amount: chance.randint(1, 200) if amount == "count" else chance.uniform(*ranges[amount])}
    if chance.random() < 0.8:
        query["seed"] = chance.choice([chance.randrange(1 << 64), chance.randrange(100)])
    if chance.random() < 0.2 and amount != "min_distance":
        query["profile"] = chance.choice(PROFILES[in_space])
    if chance.random() < 0.2:
        query["warp"] = chance.choice(["off", "on", 0.5])
    if chance.random() < 0.2:
        query |= {"keep": chance.uniform(0.1, 1)} if in_space else {"keep": 0.5, "settle": chance.randint(0, 4)}
    if chance.random() < 0.4:
        query["attributes"] = chance.sample(ATTRIBUTES[in_space], chance.randint(1, 4))
        if "variant" in query["attributes"]:
            query["variants"] = {name: chance.uniform(0.5, 3) for name in chance.sample(NAMES, chance.randint(1, 3))}
            if "profile" not in query and not in_space and chance.random() < 0.5:
                query |= {"spread": chance.choice(["even", "joint"]), "variants": {"oak": 3, "birch": 1}}
    if chance.random() < 0.2 and amount != "min_distance":
        query["field"] = chance.choice(FIELDS[in_space])
    return query


def _volume(chance: random.Random) -> dict[str, Any]:
    x, y, z = (chance.uniform(-1, 1) * 10 ** chance.randint(0, 6) for _ in "xyz")
    size = chance.uniform(2, 12)
    kind = chance.randrange(5)
    if kind == 0:
        return {"ball": {"center": [x, y, z], "radius": size / 2}}
    if kind == 1:
        place = {axis: chance.randint(-9, 9) for axis in "xyz"}
        return {"chunk": {"size": chance.choice([4, 8, 10.5]), **place}}
    if kind == 2:
        ring = [[x, y], [x + size, y + 1], [x + 2, y + size], [x, y]]
        polygon = {"type": "Polygon", "coordinates": [ring]}
        return {"prism": {"polygon": polygon, "bottom": z, "top": z + size}}
    return {"bbox": [x, y, z, x + size, y + chance.uniform(2, 12), z + chance.uniform(2, 12)]}
