"""Trees and rocks in Blender by the extension of engines/blender: points of a daemon, or of the Python package.

    strew serve
    blender --background --python scatter.py -- --bbox 0,0,60,40 --spacing 2 --save forest.blend --render forest.png

Runs in Blender 4.2 and newer, and with `pip install bpy`. It makes placeholders for three kinds, and presses the button
of the extension's panel; in the saved file the panel changes everything, once the extension is installed.
"""

import argparse
import math
import sys
import time
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "engines"))
import blender as extension  # noqa: E402, the folder engines/blender

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


def material(name, color):
    made = bpy.data.materials.new(name)
    made.diffuse_color = (*color, 1)
    if bpy.app.version < (5, 0, 0):
        # Newer materials always have nodes.
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
    if bpy.app.version < (5, 0, 0):
        scene.world.use_nodes = True
    sky = scene.world.node_tree.nodes.get("Background") or scene.world.node_tree.nodes.new("ShaderNodeBackground")
    sky.inputs["Color"].default_value = (0.55, 0.68, 0.85, 1)
    scene.camera = camera
    scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 24, False
    scene.render.resolution_x, scene.render.resolution_y = 960, 540
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)


def scatter(options, box):
    """Fills the panel of the extension in, and presses its button."""
    settings = bpy.context.scene.strew
    settings.source, settings.url = "DAEMON", options.url
    settings.low, settings.high = box[:2], box[2:]
    settings.spacing, settings.seed = float(options.spacing), int(options.seed)
    for name, weight in KINDS.items():
        kind = settings.kinds.add()
        kind.collection, kind.weight = bpy.data.collections.new(name), weight
        kind.collection.objects.link(placeholder(name))
    bpy.ops.strew.scatter()
    while "try again" in settings.error:
        # The daemon makes labels of these kinds, once, so that each of them is evenly spread.
        time.sleep(5)
        bpy.ops.strew.scatter()
    if settings.error:
        sys.exit(settings.error)


def main():
    options = arguments()
    extension.register()
    for thing in list(bpy.context.scene.objects):
        bpy.data.objects.remove(thing)
    box = np.array([float(v) for v in options.bbox.split(",")])
    scatter(options, box)
    ground(box[:2], box[2:])
    placed = bpy.context.evaluated_depsgraph_get().object_instances
    count = sum(1 for one in placed if one.is_instance and one.parent and one.parent.original.name == "Strew")
    print(f"{count} instances of {', '.join(KINDS)}")
    if options.save:
        bpy.ops.wm.save_as_mainfile(filepath=options.save)
    if options.render:
        render(options.render, box[:2], box[2:])


if __name__ == "__main__":
    main()
