"""Builds, validates and installs the extension of engines/blender, runs it against a daemon, and checks every instance:
blender_check.py FOLDER URL. The folder of the user is that of BLENDER_USER_RESOURCES."""

import io
import json
import math
import os
import subprocess
import sys
import urllib.request
import warnings
from pathlib import Path

import bpy
import numpy as np

# What Blender will remove must not be used.
warnings.simplefilter("error", DeprecationWarning)
folder, url = sys.argv[1:]
home = Path(os.environ["BLENDER_USER_RESOURCES"])

tool = Path(bpy.utils.system_resource("SCRIPTS")) / "addons_core/bl_pkg/cli/blender_ext.py"
for order in (
    ["build", "--source-dir", folder, "--output-dir", str(home)],
    ["validate", str(home / "strew-0.1.0.zip")],
):
    done = subprocess.run([sys.executable, tool, *order], capture_output=True, text=True)
    assert done.returncode == 0 and "rror" not in done.stdout, done.stdout + done.stderr

done = bpy.ops.extensions.package_install_files(
    filepath=str(home / "strew-0.1.0.zip"), repo="user_default", enable_on_install=True
)
assert done == {"FINISHED"}, done
assert (home / "extensions/user_default/strew/blender_manifest.toml").exists()


def collection(name, count):
    made = bpy.data.collections.new(name)
    for i in range(count):
        made.objects.link(bpy.data.objects.new(f"{name} {i}", bpy.data.meshes.new(f"{name} {i}")))
        made.objects[-1].data.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
    return made


def instances():
    graph = bpy.context.evaluated_depsgraph_get()
    return [
        (one.matrix_world.copy(), one.object.original.name)
        for one in graph.object_instances
        if one.is_instance and one.parent and one.parent.original.name == "Strew"
    ]


def points(**more):
    query = {"region": {"bbox": [0, 0, 30, 20]}, "spacing": 2, "seed": 7, "attributes": ["angle", "scale", "u1"], **more}
    body = json.dumps({**query, "scale_range": [0.75, 1.25], "format": "npy"}).encode()
    request = urllib.request.Request(f"{url}/v1/points:query", body, {"content-type": "application/json"})
    with urllib.request.urlopen(request) as answer:
        columns = json.loads(answer.headers["strew-columns"])
        rows = np.load(io.BytesIO(answer.read()))
    found = {column["name"]: rows[:, i] for i, column in enumerate(columns)}
    names = [column["names"] for column in columns if column.get("names")]
    return found, names[0] if names else []


for thing in list(bpy.context.scene.objects):
    bpy.data.objects.remove(thing)
settings = bpy.context.scene.strew
settings.source, settings.url = "DAEMON", url
settings.low, settings.high, settings.spacing, settings.seed, settings.scale = (0, 0), (30, 20), 2, 7, (0.75, 1.25)
assert bpy.ops.strew.scatter() == {"FINISHED"} and not settings.error, settings.error
assert len(bpy.data.objects["Strew"].data.vertices) == len(points()[0]["x"]) > 100 and not instances()

for made, weight in ((collection("oak tree", 2), 3), (collection("rock", 1), 1)):
    bpy.ops.strew.add_kind()
    settings.kinds[-1].collection, settings.kinds[-1].weight = made, weight
for is_even in (True, False):
    settings.is_even = is_even
    assert bpy.ops.strew.scatter() == {"FINISHED"} and not settings.error, settings.error
    shares = {"attributes": ["angle", "scale", "u1", "variant"], "variants": {"oak_tree": 3, "rock": 1}}
    wanted, names = points(**shares, spread="even" if is_even else "chance")
    found = instances()
    assert len(found) == len(wanted["x"]) > 100, (len(found), len(wanted["x"]))
    places = {tuple(np.float32(place)): i for i, place in enumerate(zip(wanted["x"], wanted["y"]))}
    for matrix, name in found:
        place, turn, size = matrix.decompose()
        i = places.pop((np.float32(place.x), np.float32(place.y)))
        assert abs(size.x - wanted["scale"][i]) < 1e-5, (size, wanted["scale"][i])
        assert math.cos(turn.to_euler().z - wanted["angle"][i]) > 1 - 1e-9
        kind = names[int(wanted["variant"][i])]
        assert name == (f"oak tree {int(2 * wanted['u1'][i])}" if kind == "oak_tree" else "rock 0"), (name, kind)
    assert not places

# On a surface: a slope over half of its bounds.
mesh = bpy.data.meshes.new("slope")
mesh.from_pydata([(0, 0, 0), (30, 0, 3), (0, 20, 0)], [], [(0, 1, 2)])
slope = bpy.data.objects.new("slope", mesh)
bpy.context.scene.collection.objects.link(slope)
slope.location.z = 5
settings.surface = slope
bpy.context.view_layer.update()
assert bpy.ops.strew.scatter() == {"FINISHED"} and not settings.error, settings.error
inside = wanted["x"] / 30 + wanted["y"] / 20 < 1
found = [matrix.to_translation() for matrix, _ in instances()]
assert abs(len(found) - inside.sum()) <= 1, (len(found), inside.sum())
assert all(abs(place.z - (5 + place.x / 10)) < 1e-4 for place in found)
settings.surface = None
whole = len(wanted["x"])

# What is wrong is said in the panel, and what was scattered stays.
for change, words in (
    ({"url": "http://127.0.0.1:9"}, "does not answer"),
    ({"url": "http://example.org"}, "offline"),
    ({"most": 7}, "more than At Most"),
    ({"high": (-1, 20)}, "bbox"),
):
    before = {name: tuple(value) if name == "high" else value for name in change for value in [getattr(settings, name)]}
    for name, value in change.items():
        setattr(settings, name, value)
    assert bpy.ops.strew.scatter() == {"CANCELLED"} and words in settings.error, (words, settings.error)
    assert len(instances()) == len(found)
    for name, value in before.items():
        setattr(settings, name, value)
assert bpy.ops.strew.scatter() == {"FINISHED"} and not settings.error and len(instances()) == whole

# The panel draws what the settings have.
assert bpy.types.STREW_PT_panel.bl_category == "Strew"
bpy.ops.preferences.addon_disable(module="bl_ext.user_default.strew")
assert not hasattr(bpy.types.Scene, "strew")
print(whole)
