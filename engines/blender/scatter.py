"""The operator that scatters: it makes the query of the panel, and instances of its points."""

import re

import bpy
import numpy as np
from mathutils import Vector

from . import nodes, source
from .source import Refused

#: The name of the object, its mesh, its modifier and its group of nodes.
NAME = "Strew"


def bounds(settings):
    """The box that points fill: min x, min y, max x, max y."""
    surface = settings.surface
    if surface is None:
        return [*settings.low, *settings.high]
    corners = np.array([surface.matrix_world @ Vector(corner) for corner in surface.bound_box])
    return [*map(float, corners.min(0)[:2]), *map(float, corners.max(0)[:2])]


def names(kinds):
    """The names of kinds in the query: those of their collections, of letters, digits, _ and -."""
    found = [re.sub(r"[^A-Za-z0-9_-]", "_", kind.collection.name) for kind in kinds]
    if len(set(found)) < len(found):
        raise Refused("two kinds have the same collection, or names that differ by signs alone: rename one")
    return found


def query_of(settings, kinds):
    """The body of `POST /v1/points:query`."""
    query = {
        "region": {"bbox": bounds(settings)},
        settings.amount: getattr(settings, settings.amount),
        "seed": settings.seed,
        "attributes": ["angle", "scale", "u1"],
        "scale_range": sorted(settings.scale),
    }
    if kinds:
        query["attributes"].append("variant")
        query["variants"] = dict(zip(names(kinds), (kind.weight for kind in kinds)))
        # One kind is spread evenly anyway.
        query["spread"] = "even" if settings.is_even and len(kinds) > 1 else "chance"
    return query


def stand(surface, columns, graph):
    """The places of points on a surface, and which of them it has below them."""
    evaluated = surface.evaluated_get(graph)
    back = surface.matrix_world.inverted()
    top = max((surface.matrix_world @ Vector(corner)).z for corner in surface.bound_box) + 1
    down = (back.to_3x3() @ Vector((0, 0, -1))).normalized()
    places, is_there = np.zeros((len(columns["x"]), 3)), np.zeros(len(columns["x"]), bool)
    for i, (x, y) in enumerate(zip(columns["x"], columns["y"])):
        hit, place, _, _ = evaluated.ray_cast(back @ Vector((x, y, top)), down)
        if hit:
            places[i], is_there[i] = surface.matrix_world @ place, True
    return places, is_there


def scatter(context):
    """Scatters by the settings of the scene, and returns the number of points."""
    settings = context.scene.strew
    kinds = [kind for kind in settings.kinds if kind.collection is not None and len(kind.collection.objects)]
    url = None if settings.source == "AUTO" and source.has_package() else settings.url
    if url is not None and not source.is_here(url) and not bpy.app.online_access:
        raise Refused("Blender is offline: allow online access in the preferences (System)")
    columns, variants = source.points(query_of(settings, kinds), settings.most, url)
    graph = context.evaluated_depsgraph_get()
    if settings.surface is None:
        places = np.stack([columns["x"], columns["y"], np.zeros(len(columns["x"]))], axis=1)
        is_there = np.ones(len(places), bool)
    else:
        places, is_there = stand(settings.surface, columns, graph)
    values = {name: np.asarray(columns[name]) for name in ("angle", "scale")}
    if not settings.is_turned:
        values["angle"] = np.zeros(len(places))
    order = names(kinds)
    places_of = np.array([order.index(name) for name in variants], int)
    values["kind"] = places_of[np.asarray(columns["variant"]).astype(int)] if kinds else np.zeros(len(places), int)
    sizes = np.array([len(kind.collection.objects) for kind in kinds] or [1])
    values["choice"] = (np.asarray(columns["u1"]) * sizes[values["kind"]]).astype(int)
    thing, group = nodes.hold(context.scene, NAME)
    nodes.fill(thing.data, places[is_there], {name: value[is_there] for name, value in values.items()})
    nodes.instances(group, [kind.collection for kind in kinds])
    return int(is_there.sum())


class STREW_OT_scatter(bpy.types.Operator):
    """Scatter the kinds of the panel, in place of what was scattered before"""

    bl_idname = "strew.scatter"
    bl_label = "Scatter"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        settings = context.scene.strew
        try:
            count = scatter(context)
        except Refused as refused:
            settings.error = str(refused)
            # A warning, because the panel shows it: an error would raise in scripts.
            self.report({"WARNING"}, settings.error)
            return {"CANCELLED"}
        settings.error = ""
        self.report({"INFO"}, f"{count} points")
        return {"FINISHED"}


class STREW_OT_add_kind(bpy.types.Operator):
    """Add a kind: a collection and its weight"""

    bl_idname = "strew.add_kind"
    bl_label = "Add Kind"
    bl_options = {"UNDO"}

    def execute(self, context):
        context.scene.strew.kinds.add()
        return {"FINISHED"}


class STREW_OT_remove_kind(bpy.types.Operator):
    """Remove this kind; its collection stays"""

    bl_idname = "strew.remove_kind"
    bl_label = "Remove Kind"
    bl_options = {"UNDO"}

    index: bpy.props.IntProperty()

    def execute(self, context):
        context.scene.strew.kinds.remove(self.index)
        return {"FINISHED"}


CLASSES = (STREW_OT_scatter, STREW_OT_add_kind, STREW_OT_remove_kind)
