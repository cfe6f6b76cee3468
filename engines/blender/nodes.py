"""The points as a mesh with attributes, and the geometry nodes that put objects on them."""

import bpy
import numpy as np

#: The attributes that the nodes read, with their types.
FLOATS, INTEGERS = ("angle", "scale"), ("kind", "choice")


def fill(mesh, places, values):
    """Makes a mesh of one vertex a point, with its values as attributes."""
    mesh.clear_geometry()
    mesh.vertices.add(len(places))
    mesh.vertices.foreach_set("co", np.ascontiguousarray(places, np.float32).ravel())
    for name in (*FLOATS, *INTEGERS):
        form, kind = ("FLOAT", np.float32) if name in FLOATS else ("INT", np.int32)
        mesh.attributes.new(name, form, "POINT").data.foreach_set("value", np.ascontiguousarray(values[name], kind))
    mesh.update()


def instances(group, kinds):
    """Fills a group with the nodes for some collections: a point of the kind i has an object of the i-th."""
    group.nodes.clear()
    group.interface.clear()
    group.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    link = group.links.new
    made = 0

    def node(kind, **values):
        nonlocal made
        one = group.nodes.new(kind)
        one.location = (220 * (made % 6), -220 * (made // 6))
        made += 1
        for name, value in values.items():
            setattr(one, name, value)
        return one

    def value(name, kind):
        one = node("GeometryNodeInputNamedAttribute", data_type=kind)
        one.inputs["Name"].default_value = name
        return next(output for output in one.outputs if output.enabled and output.name == "Attribute")

    points, joined = node("NodeGroupInput"), node("GeometryNodeJoinGeometry")
    turn = node("ShaderNodeCombineXYZ")
    link(value("angle", "FLOAT"), turn.inputs["Z"])
    scale, kind, choice = value("scale", "FLOAT"), value("kind", "INT"), value("choice", "INT")
    for i, collection in enumerate(kinds):
        objects = node("GeometryNodeCollectionInfo")
        objects.inputs["Collection"].default_value = collection
        objects.inputs["Separate Children"].default_value = True
        objects.inputs["Reset Children"].default_value = True
        is_kind = node("FunctionNodeCompare", data_type="INT", operation="EQUAL")
        one, other = (entry for entry in is_kind.inputs if entry.enabled and entry.name in ("A", "B"))
        link(kind, one)
        other.default_value = i
        place = node("GeometryNodeInstanceOnPoints")
        place.inputs["Pick Instance"].default_value = True
        link(points.outputs[0], place.inputs["Points"])
        link(is_kind.outputs[0], place.inputs["Selection"])
        link(objects.outputs[0], place.inputs["Instance"])
        link(choice, place.inputs["Instance Index"])
        link(turn.outputs[0], place.inputs["Rotation"])
        link(scale, place.inputs["Scale"])
        link(place.outputs[0], joined.inputs[0])
    link((joined if kinds else points).outputs[0], node("NodeGroupOutput").inputs[0])


def hold(scene, name):
    """The object of the points and its group of nodes, made once and filled again."""
    thing = bpy.data.objects.get(name)
    if thing is None or thing.type != "MESH":
        thing = bpy.data.objects.new(name, bpy.data.meshes.new(name))
        scene.collection.objects.link(thing)
    modifier = thing.modifiers.get(name) or thing.modifiers.new(name, "NODES")
    if modifier.node_group is None:
        modifier.node_group = bpy.data.node_groups.new(name, "GeometryNodeTree")
    return thing, modifier.node_group
