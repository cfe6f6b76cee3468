"""Runs examples/blender/scatter.py against a daemon, and checks every instance: check.py SAMPLE URL."""

import importlib.util
import math
import sys

import bpy

specification = importlib.util.spec_from_file_location("scatter", sys.argv[1])
sample = importlib.util.module_from_spec(specification)
specification.loader.exec_module(sample)
sys.argv = [sys.argv[1], "--url", sys.argv[2], "--bbox", "0,0,30,20"]

columns = sample.ask(sample.arguments())
for thing in list(bpy.context.scene.objects):
    bpy.data.objects.remove(thing)
points = sample.scatter(columns)
x, y, angle, scale, variant = (columns[name][0] for name in ("x", "y", "angle", "scale", "variant"))
names = columns["variant"][1]
graph = bpy.context.evaluated_depsgraph_get()
found = [
    (one.matrix_world.copy(), one.object.original.name)
    for one in graph.object_instances
    if one.is_instance and one.parent and one.parent.original == points
]
assert len(found) == len(x) > 100, (len(found), len(x))
for i, (matrix, name) in enumerate(found):
    place, turn, size = matrix.decompose()
    assert math.dist(place, (x[i], y[i], 0)) < 1e-5, (i, place, x[i], y[i])
    assert abs(size.x - scale[i]) < 1e-5, (i, size, scale[i])
    assert math.cos(turn.to_euler().z - angle[i]) > 1 - 1e-9, (i, turn.to_euler(), angle[i])
    assert name == names[int(variant[i])], (i, name, variant[i])
print(len(found))
