"""Trees and rocks in Blender: points of a Strew daemon as instances with an angle and a scale.

    strew serve
    blender --background --python scatter.py -- --bbox 0,0,60,40 --spacing 2 --save forest.blend --render forest.png

Runs in Blender 4.2 and newer (also in its text editor, then with the values below), and with `pip install bpy`. The
points are vertices of one mesh with the attributes `angle`, `scale` and `variant`; a modifier of geometry nodes puts an
object of the collection "strew kinds" on each. Put your own objects into that collection: they are taken in the order
of their names.
"""

import argparse
import io
import json
import math
import sys
import urllib.error
import urllib.parse
import urllib.request

import bpy
import numpy as np

KINDS = {"oak": 4, "pine": 2, "rock": 1}


def arguments():
    """What follows `--` on Blender's command line, or what follows the script."""
    given = sys.argv[1:] if bpy.app.module else []
    if "--" in sys.argv:
        given = sys.argv[sys.argv.index("--") + 1 :]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--url", default="http://127.0.0.1:8080", help="the daemon (%(default)s)")
    parser.add_argument("--bbox", default="0,0,60,40", help="min x, min y, max x, max y in meters (%(default)s)")
    parser.add_argument("--spacing", default="2", help="mean distance of points, in meters (%(default)s)")
    parser.add_argument("--seed", default="7", help="another number, other points (%(default)s)")
    parser.add_argument("--save", help="write the scene here")
    parser.add_argument("--render", help="write a picture here")
    return parser.parse_args(given)


def ask(options):
    """The points as columns: name → array."""
    query = {
        "bbox": options.bbox,
        "spacing": options.spacing,
        "seed": options.seed,
        "attributes": "angle,scale,variant",
        "scale_range": "0.7,1.3",
        "variants": ",".join(f"{name}:{share}" for name, share in KINDS.items()),
        "spread": "even",
        "format": "npy",
    }
    address = f"{options.url}/v1/points?{urllib.parse.urlencode(query)}"
    try:
        with urllib.request.urlopen(address) as answer:
            rows = np.load(io.BytesIO(answer.read()))
            columns = json.loads(answer.headers["strew-columns"])
    except urllib.error.HTTPError as error:
        sys.exit(f"{options.url}: {error.read().decode()}")
    except urllib.error.URLError as error:
        sys.exit(f"{options.url} does not answer ({error.reason}): start `strew serve`, or name a daemon by --url")
    return {column["name"]: (rows[:, i], column.get("names")) for i, column in enumerate(columns)}


def material(name, color):
    made = bpy.data.materials.new(name)
    made.diffuse_color = (*color, 1)
    made.use_nodes = True
    made.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*color, 1)
    return made


def cone(vertices, radius, top, low, high):
    """A frustum from height `low` to `high`: its points and faces."""
    around = [(math.cos(a), math.sin(a)) for a in (math.tau * i / vertices for i in range(vertices))]
    points = [(radius * x, radius * y, low) for x, y in around] + [(top * x, top * y, high) for x, y in around]
    faces = [(i, (i + 1) % vertices, (i + 1) % vertices + vertices, i + vertices) for i in range(vertices)]
    return points, [*faces, tuple(range(vertices, 2 * vertices)), tuple(reversed(range(vertices)))]


def placeholder(name):
    """An object for a kind: a crown on a trunk, or a stone."""
    shapes = {
        "oak": [((0.12, 0.1, 0.0, 0.8), (0.16, 0.09, 0.05)), ((0.9, 0.5, 0.6, 2.1), (0.10, 0.28, 0.06))],
        "pine": [((0.1, 0.1, 0.0, 0.5), (0.16, 0.09, 0.05)), ((0.7, 0.02, 0.4, 2.8), (0.03, 0.17, 0.09))],
        "rock": [((0.5, 0.3, 0.0, 0.4), (0.32, 0.31, 0.30))],
    }[name]
    points, faces, slots = [], [], []
    mesh = bpy.data.meshes.new(name)
    for slot, ((radius, top, low, high), color) in enumerate(shapes):
        more, sides = cone(9, radius, top, low, high)
        faces += [tuple(len(points) + i for i in side) for side in sides]
        slots += [slot] * len(sides)
        points += more
        mesh.materials.append(material(f"{name} {slot}", color))
    mesh.from_pydata(points, [], faces)
    mesh.polygons.foreach_set("material_index", slots)
    return bpy.data.objects.new(name, mesh)


def point_mesh(columns):
    """One vertex a point, with its values as attributes."""
    count = len(columns["x"][0])
    mesh = bpy.data.meshes.new("strew points")
    mesh.vertices.add(count)
    places = np.zeros((count, 3), np.float32)
    places[:, 0], places[:, 1] = columns["x"][0], columns["y"][0]
    mesh.vertices.foreach_set("co", places.ravel())
    for name, kind in [("angle", "FLOAT"), ("scale", "FLOAT"), ("variant", "INT")]:
        values = columns[name][0].astype(np.float32 if kind == "FLOAT" else np.int32)
        mesh.attributes.new(name, kind, "POINT").data.foreach_set("value", values)
    mesh.update()
    return mesh


def instances(kinds):
    """Geometry nodes that put the kind of each point on it, turned and scaled."""
    group = bpy.data.node_groups.new("strew instances", "GeometryNodeTree")
    group.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")

    def node(kind, **values):
        made = group.nodes.new(kind)
        for name, value in values.items():
            setattr(made, name, value)
        return made

    def value(name, kind):
        made = node("GeometryNodeInputNamedAttribute", data_type=kind)
        made.inputs["Name"].default_value = name
        return made.outputs["Attribute"]

    collection = node("GeometryNodeCollectionInfo")
    collection.inputs["Collection"].default_value = kinds
    collection.inputs["Separate Children"].default_value = True
    collection.inputs["Reset Children"].default_value = True
    place = node("GeometryNodeInstanceOnPoints")
    place.inputs["Pick Instance"].default_value = True
    turn = node("ShaderNodeCombineXYZ")
    link = group.links.new
    link(node("NodeGroupInput").outputs[0], place.inputs["Points"])
    link(collection.outputs[0], place.inputs["Instance"])
    link(value("variant", "INT"), place.inputs["Instance Index"])
    link(value("angle", "FLOAT"), turn.inputs["Z"])
    link(turn.outputs[0], place.inputs["Rotation"])
    link(value("scale", "FLOAT"), place.inputs["Scale"])
    link(place.outputs[0], node("NodeGroupOutput").inputs[0])
    return group


def scatter(columns):
    """The points as an object of the scene, and the collection of what stands on them."""
    kinds = bpy.data.collections.new("strew kinds")
    # The names of variants come sorted, as a collection's children do.
    for name in columns["variant"][1]:
        kinds.objects.link(placeholder(name))
    points = bpy.data.objects.new("strew points", point_mesh(columns))
    bpy.context.scene.collection.objects.link(points)
    points.modifiers.new("strew", "NODES").node_group = instances(kinds)
    return points


def ground(low, high):
    mesh = bpy.data.meshes.new("ground")
    margin = 4
    (left, bottom), (right, top) = low - margin, high + margin
    mesh.from_pydata([(left, bottom, 0), (right, bottom, 0), (right, top, 0), (left, top, 0)], [], [(0, 1, 2, 3)])
    mesh.materials.append(material("ground", (0.16, 0.17, 0.07)))
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("ground", mesh))


def render(path, low, high):
    """A picture from the south, by Cycles on the processor."""
    scene = bpy.context.scene
    middle, wide = (low + high) / 2, float(max(high - low))
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.data.angle, sun.rotation_euler = 4, 0.02, (0.8, 0.2, 0.6)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.lens = 40
    camera.location = (middle[0], middle[1] - 1.0 * wide, 0.62 * wide)
    camera.rotation_euler = (math.radians(56), 0, 0)
    for thing in (sun, camera):
        scene.collection.objects.link(thing)
    scene.world = scene.world or bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    sky = scene.world.node_tree.nodes.get("Background") or scene.world.node_tree.nodes.new("ShaderNodeBackground")
    sky.inputs["Color"].default_value = (0.55, 0.68, 0.85, 1)
    scene.camera = camera
    scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 24, False
    scene.render.resolution_x, scene.render.resolution_y = 960, 540
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)


def main():
    options = arguments()
    columns = ask(options)
    for thing in list(bpy.context.scene.objects):
        bpy.data.objects.remove(thing)
    points = scatter(columns)
    box = np.array([float(v) for v in options.bbox.split(",")])
    ground(box[:2], box[2:])
    placed = bpy.context.evaluated_depsgraph_get().object_instances
    count = sum(1 for one in placed if one.is_instance and one.parent and one.parent.original == points)
    print(f"{count} instances of {', '.join(columns['variant'][1])}")
    if options.save:
        bpy.ops.wm.save_as_mainfile(filepath=options.save)
    if options.render:
        render(options.render, box[:2], box[2:])


if __name__ == "__main__":
    main()
