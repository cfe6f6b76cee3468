"""The panel in the sidebar of the 3D view: the settings, and what went wrong."""

import textwrap

import bpy


class STREW_PT_panel(bpy.types.Panel):
    """The settings of a scatter."""

    bl_label = "Strew"
    bl_idname = "STREW_PT_panel"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Strew"

    def draw(self, context):
        settings, layout = context.scene.strew, self.layout
        layout.use_property_split = True
        layout.prop(settings, "surface")
        if settings.surface is None:
            layout.prop(settings, "low")
            layout.prop(settings, "high")
        layout.prop(settings, "amount")
        layout.prop(settings, settings.amount)
        for name in ("seed", "scale", "is_turned"):
            layout.prop(settings, name)
        box = layout.box()
        box.label(text="Kinds")
        for i, kind in enumerate(settings.kinds):
            row = box.row(align=True)
            row.use_property_split = False
            row.prop(kind, "collection", text="")
            row.prop(kind, "weight", text="")
            row.operator("strew.remove_kind", text="", icon="REMOVE").index = i
        box.operator("strew.add_kind", icon="ADD")
        if len(settings.kinds) > 1:
            box.prop(settings, "is_even")
        layout.prop(settings, "source")
        layout.prop(settings, "url")
        layout.prop(settings, "most")
        layout.operator("strew.scatter", icon="POINTCLOUD_DATA")
        for i, line in enumerate(textwrap.wrap(settings.error, 40)):
            layout.label(text=line, icon="ERROR" if i == 0 else "BLANK1")


CLASSES = (STREW_PT_panel,)
