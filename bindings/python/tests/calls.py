"""Calls for checkers of types: lines that end in ``# refused`` are errors, all others are right. Nothing runs them."""

from typing import Any, Iterator

import numpy as np
from typing_extensions import assert_type

import strew

box = (0, 0, 9, 9)
daemon = strew.connect("http://localhost:8080")
cube = (0, 0, 0, 9, 9, 9)

points = strew.points(bbox=box, spacing=np.float32(1), seed=np.int64(3), periodic=None, attributes=["angle", "u16"])
strew.points(circle=(0, 0, 9), density=2, bbox=None, attributes="rank")
strew.points(polygon=[(0, 0), (9, 0), (0, 9)], count=np.int64(7), keep=None)
strew.points(min_distance=1, chunk=(64, 0, 0), variants={"oak": 1})
strew.points(periodic=5000, spacing=1, map="s")
strew.points(bbox=np.array(box), layers=[{"name": "a", "spacing": 2}])
strew.points(features={"of": {}, "id": "k"}, limit=9)
daemon.points(world="forest", bbox=box)
daemon.points(world="forest", spacing=2)
strew.space.points(bbox=cube, count=9, attributes=["rotation", "u1"])
strew.space.points(ball=(0, 0, 0, 9), spacing=np.float64(1))

strew.points(bbox=box, spacing=1, density=1)  # refused
strew.points(bbox=box, count=1, min_distance=1)  # refused
strew.points(bbox=box)  # refused
strew.points(bbox=box, polygon=[(0, 0), (9, 0), (0, 9)], spacing=1)  # refused
strew.points(bbox=box, circle=(0, 0, 9), count=7)  # refused
strew.points(bbox=box, spacing="1")  # refused
strew.points(bbox=box, spacing=1, attributes=["angel"])  # refused
strew.points(bbox=box, spacing=1, attributes="u17")  # refused
strew.points(bbox=box, spacing=1, sede=7)  # refused
strew.space.points(bbox=cube)  # refused
strew.space.points(bbox=cube, spacing=1, density=1)  # refused
strew.space.points(bbox=cube, spacing=1, circle=(0, 0, 9))  # refused
strew.limits(row=1)  # refused
points.xy()  # refused
points[0].z  # refused
points.document("csv", decimal=2)  # refused

assert_type(points[0], strew.Point)
assert_type(points[np.int64(0)], strew.Point)
assert_type(points[:5], strew.PointSet)
assert_type(points["angle"], "np.ndarray[Any, Any]")
assert_type(points.nearest((0, 0)), "list[strew.Point]")
assert_type(iter(strew.space.points(spacing=1)), Iterator[strew.SpacePoint])
assert_type(points.xy, "np.ndarray[Any, np.dtype[np.float64]]")
