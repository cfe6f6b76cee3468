"""Reads an answer in a format of engines and prints `id,x,y,z,turn,size,thing` lines.

Places are in the frame of the world, z up, relative to the origin that the answer states. The turn is the angle
around the vertical. Formats without ids print an empty one.
"""

import json
import math
import struct
import sys


def turn(x, y, z, w):
    """The angle of a rotation around the vertical."""
    assert abs(x * x + y * y + z * z + w * w - 1) < 2e-3
    return 2 * math.atan2(z, w) % math.tau


def row(id, place, angle, size, thing):
    numbers = ",".join(repr(float(v)) for v in [*place, angle, size])
    print(f"{id},{numbers},{thing}")


def glb(path):
    """By the specification of glTF 2.0, section 4.4, and that of EXT_mesh_gpu_instancing."""
    data = open(path, "rb").read()
    magic, version, length, json_length, kind = struct.unpack_from("<4sIII4s", data)
    assert (magic, version, length, kind) == (b"glTF", 2, len(data), b"JSON")
    document = json.loads(data[20 : 20 + json_length])
    buffer_length, kind = struct.unpack_from("<I4s", data, 20 + json_length)
    buffer = data[28 + json_length :]
    assert kind == b"BIN\0" and buffer_length == len(buffer) == document["buffers"][0]["byteLength"]

    def array(number):
        accessor = document["accessors"][number]
        view = document["bufferViews"][accessor["bufferView"]]
        code, size = {5126: ("f", 4), 5123: ("H", 2)}[accessor["componentType"]]
        items = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        assert "byteStride" not in view
        first, end = accessor["byteOffset"], accessor["byteOffset"] + items * size * accessor["count"]
        assert first % 4 == 0 and end <= view["byteLength"]
        first += view["byteOffset"]
        return list(struct.iter_unpack(f"<{items}{code}", buffer[first : end + view["byteOffset"]]))

    root, *nodes = document["nodes"]
    assert root["children"] == list(range(1, len(nodes) + 1))
    for node in nodes:
        attributes = node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]
        arrays = {name: array(number) for name, number in attributes.items()}
        for i, (x, y, z) in enumerate(arrays["TRANSLATION"]):
            qx, qy, qz, qw = arrays["ROTATION"][i]
            size, *others = arrays["SCALE"][i]
            assert others == [size, size]
            a, b, c, d = arrays["_ID"][i]
            halves = struct.unpack("<ii", struct.pack("<HHHH", a, b, c, d))
            row("{}:{}".format(*halves), (x, -z, y), turn(qx, -qz, qy, qw), size, node["name"])


def usda(path):
    from pxr import Usd, UsdGeom

    stage = Usd.Stage.Open(path)
    assert UsdGeom.GetStageUpAxis(stage) == "Z" and UsdGeom.GetStageMetersPerUnit(stage) == 1
    total = 0
    for prim in stage.Traverse():
        if not prim.IsA(UsdGeom.PointInstancer):
            continue
        instancer = UsdGeom.PointInstancer(prim)
        things = [stage.GetPrimAtPath(p) for p in instancer.GetPrototypesRel().GetTargets()]
        names = [thing.GetAttribute("strew:name").Get() for thing in things]
        indices, ids = instancer.GetProtoIndicesAttr().Get(), instancer.GetIdsAttr().Get()
        turns, sizes = instancer.GetOrientationsAttr().Get(), instancer.GetScalesAttr().Get()
        # Of the prototypes' own transforms there are none.
        transforms = instancer.ComputeInstanceTransformsAtTime(0, 0)
        assert len(transforms) == len(ids) == len(set(ids)) == len(indices)
        for i, place in enumerate(instancer.GetPositionsAttr().Get()):
            assert transforms[i].ExtractTranslation() == place
            x, y, z = turns[i].imaginary
            size, *others = sizes[i]
            assert others == [size, size]
            id = f"{ids[i] >> 32}:{struct.unpack('<i', struct.pack('<I', ids[i] & 0xFFFFFFFF))[0]}"
            row(id, place, turn(x, y, z, turns[i].real), size, names[indices[i]])
        total += len(ids)
    assert str(total) == stage.GetRootLayer().customLayerData["strew_count"]


def multimesh(path):
    for record in struct.iter_unpack("<16f", open(path, "rb").read()):
        xx, yx, zx, x, xy, yy, zy, y, xz, yz, zz, z, variant, layer, u1, unused = record
        size = math.sqrt(xx * xx + xy * xy + xz * xz)
        assert (xy, yx, zy, yz, unused, layer) == (0, 0, 0, 0, 0, 0) and 0 <= u1 < 1
        assert math.isclose(yy, size, rel_tol=1e-6)
        row("", (x, -z, y), math.atan2(-xz, xx) % math.tau, size, ["birch", "oak"][int(variant)])


def instances(path):
    """The ranges are those of the query."""
    for x, y, z, angle, size, variant in struct.iter_unpack("<2f4H", open(path, "rb").read()):
        angle, size = angle / 65535 * math.tau, 0.5 + size / 65535 * 1.5
        row("", (x, y, z), angle % math.tau, size, ["birch", "oak"][variant])


if __name__ == "__main__":
    try:
        globals()[sys.argv[1]](sys.argv[2])
    except ModuleNotFoundError as error:
        print(f"{error.name} is not installed", file=sys.stderr)
        sys.exit(77)
