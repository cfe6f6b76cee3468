"""Reads points in space with the usual reader of a format and prints `id,x,y,z` lines, as csv has them.

Numbers go through repr, which is exact.
"""

import sys


def show(ids, xs, ys, zs):
    for id, x, y, z in zip(ids, xs, ys, zs, strict=True):
        print(f"{id},{float(x)!r},{float(y)!r},{float(z)!r}")


def table(table):
    columns = {name: table.column(name).to_pylist() for name in ("id", "x", "y", "z")}
    show(*columns.values())


def arrow(path):
    import pyarrow.ipc

    with open(path, "rb") as file:
        table(pyarrow.ipc.open_stream(file).read_all())


def parquet(path):
    import geopandas
    import pyarrow.parquet

    table(pyarrow.parquet.read_table(path))
    # GeoParquet: the third coordinate is in the geometry, too.
    frame = geopandas.read_parquet(path)
    assert frame.geometry.has_z.all()
    assert (frame.geometry.z == frame["z"]).all()


def usda(path):
    from pxr import Usd, UsdGeom

    stage = Usd.Stage.Open(path)
    root = stage.GetPrimAtPath("/points")
    origin = root.GetAttribute("xformOp:translate").Get()
    for prim in stage.Traverse():
        if not prim.IsA(UsdGeom.PointInstancer):
            continue
        instancer = UsdGeom.PointInstancer(prim)
        places = instancer.GetPositionsAttr().Get()
        assert len(instancer.GetOrientationsAttr().Get()) == len(places)
        for id, place in zip(instancer.GetIdsAttr().Get(), places, strict=True):
            parts = [((id >> shift & 0x1FFFFF) ^ 0x100000) - 0x100000 for shift in (42, 21, 0)]
            x, y, z = (float(a + b) for a, b in zip(origin, place, strict=True))
            print(f"{parts[0]}:{parts[1]}:{parts[2]},{x!r},{y!r},{z!r}")


if __name__ == "__main__":
    try:
        globals()[sys.argv[1]](sys.argv[2])
    except ImportError as missing:
        print(missing, file=sys.stderr)
        sys.exit(77)
