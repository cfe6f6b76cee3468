"""Strew for Blender: evenly spread instances within bounds or on a surface, from a daemon or from the Python package."""

import bpy

from . import panel, scatter, settings

CLASSES = (*settings.CLASSES, *scatter.CLASSES, *panel.CLASSES)


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Scene.strew = bpy.props.PointerProperty(type=settings.StrewSettings)


def unregister():
    del bpy.types.Scene.strew
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
