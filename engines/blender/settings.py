"""The settings of a scatter, which a scene keeps: what is scattered, where, and how densely."""

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)


def _is_mesh(_, thing):
    return thing.type == "MESH"


class StrewKind(bpy.types.PropertyGroup):
    """A kind of thing: a collection, of which each point has one object, and its share of all points."""

    collection: PointerProperty(name="Collection", description="Each point of this kind has one of its objects", type=bpy.types.Collection)
    weight: FloatProperty(name="Weight", description="The share of this kind, beside the weights of the others", default=1, min=0.001, soft_max=10)


class StrewSettings(bpy.types.PropertyGroup):
    """The settings of the panel."""

    source: EnumProperty(
        name="Points from",
        items=[
            ("AUTO", "Package or Daemon", "The Python package strew where Blender's Python has it, else the daemon"),
            ("DAEMON", "Daemon", "The daemon of the address"),
        ],
    )
    url: StringProperty(name="Daemon", description="The address of a daemon: strew serve", default="http://127.0.0.1:8080")
    surface: PointerProperty(
        name="Surface",
        description="The mesh that points stand on: they fill its bounds from above. Without it they lie on the ground",
        type=bpy.types.Object,
        poll=_is_mesh,
    )
    low: FloatVectorProperty(name="From", description="The least x and y of the bounds", size=2, default=(-20, -20), subtype="XYZ", unit="LENGTH")
    high: FloatVectorProperty(name="To", description="The greatest x and y of the bounds", size=2, default=(20, 20), subtype="XYZ", unit="LENGTH")
    amount: EnumProperty(
        name="Amount",
        items=[
            ("spacing", "Spacing", "The mean distance of points"),
            ("density", "Density", "Points per square unit"),
            ("count", "Count", "The exact number of points in the bounds"),
        ],
    )
    spacing: FloatProperty(name="Spacing", description="The mean distance of points", default=2, min=0.001, unit="LENGTH")
    density: FloatProperty(name="Density", description="Points per square unit", default=0.25, min=1e-6)
    count: IntProperty(name="Count", description="The exact number of points in the bounds", default=400, min=1)
    seed: IntProperty(name="Seed", description="Another number, other points. 0 is the plain pattern", default=7, min=0)
    scale: FloatVectorProperty(name="Scale", description="The least and the greatest scale", size=2, default=(0.7, 1.3), min=0)
    is_turned: BoolProperty(name="Turn", description="Turn each instance about the vertical at random", default=True)
    is_even: BoolProperty(name="Even Kinds", description="Spread each kind evenly by itself, instead of by chance", default=True)
    most: IntProperty(name="At Most", description="More points than this are refused", default=100_000, min=1)
    kinds: CollectionProperty(type=StrewKind)
    #: What went wrong last; empty after a success.
    error: StringProperty()


CLASSES = (StrewKind, StrewSettings)
