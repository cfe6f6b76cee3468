"""Uses the client that openapi-python-client generates, whose folder's parent is on the path."""

import sys

from strew_client import Client
from strew_client.api.points import (
    count_points,
    get_chunk,
    get_nearest,
    get_points,
    query_points,
    split_points,
)
from strew_client.api.profiles import list_profiles
from strew_client.models import (
    BoxRegion,
    Circle,
    CircleRegion,
    CombinedRegion,
    CountQuery,
    Layer,
    LayerClearOf,
    Points,
    PointsQuery,
    Problem,
)

client = Client(base_url=sys.argv[1])

# By an address.
points = get_points.sync(client=client, bbox="0,0,9,9", spacing=1, seed=7)
assert isinstance(points, Points), points
assert points.count == len(points.points) > 60
assert points.query.seed == 7 and points.query.profile == "blue"

# By a body, in any region, in layers.
box = BoxRegion(bbox=[0, 0, 9, 9])
circle = CircleRegion(circle=Circle(center=[4, 4], radius=2))
query = PointsQuery(
    region=CombinedRegion(include=[box], exclude=[circle]),
    layers=[
        Layer(name="trees", spacing=2.0, seed=1),
        Layer(name="rocks", spacing=1.0, seed=2, clear_of=LayerClearOf.from_dict({"trees": 0.8})),
    ],
)
layered = query_points.sync(client=client, body=query)
assert isinstance(layered, Points), layered
assert {point.layer for point in layered.points} == {"trees", "rocks"}

# Its count.
counted = count_points.sync(
    client=client, body=CountQuery(region=query.region, layers=query.layers)
)
assert counted.count == layered.count

# Its parts, each sent as it came.
split = split_points.sync(client=client, body=query, parts=3)
assert len(split.parts) == 3
ids = []
for part in split.parts:
    answer = query_points.sync(client=client, body=part.query)
    assert answer.count == part.count
    ids += [point.id for point in answer.points]
assert ids == [point.id for point in layered.points]

# Chunks, single points, what is loaded.
chunk = get_chunk.sync(64, -3, 2, client=client, spacing=16)
assert isinstance(chunk, Points), chunk
near = get_nearest.sync(client=client, at="1,2", k=5, spacing=1)
assert len(near.neighbors) == 5
assert any(profile.profile == "blue" for profile in list_profiles.sync(client=client).profiles)

# Errors are typed, too.
problem = get_points.sync(client=client, bbox="0,0,9,9")
assert isinstance(problem, Problem), problem
assert [fault.field for fault in problem.errors] == ["spacing"], problem

print("used")
