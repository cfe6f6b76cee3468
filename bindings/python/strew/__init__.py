"""Blue-noise points of any region: evenly spread, without a pattern, the same for everyone.

A set of points fills the whole plane and is stored nowhere. A query names a set (its spacing and seed) and a
region; the same query has the same points on every machine.

>>> import strew
>>> points = strew.points(bbox=(0, 0, 10, 10), spacing=1, seed=7)
>>> len(points)
100
>>> points.xy.shape
(100, 2)

``strew.space.points`` has the same in three dimensions, with boxes, balls, prisms and chunks.

:func:`points` answers in this process. :func:`connect` asks a daemon instead; what it returns has the same
functions and the same points. The package ``strew-client`` is this one without its native part: it has daemons alone.
"""

from ._errors import Disconnected, NoSuchPoint, StrewError
from ._fields import pixels, raster
from ._local import LOCAL, limits
from ._mask import mask
from ._measure import Measured, measure
from ._points import Point, PointSet
from ._progress import progress
from ._query import Query, SpaceQuery
from ._remote import Daemon, connect
from ._source import Source
from ._space import SpacePoint, SpaceSet
from ._version import VERSION as __version__

points = LOCAL.points
query = LOCAL.query
stipple = LOCAL.stipple
space = LOCAL.space

__all__ = [
    "Daemon",
    "Disconnected",
    "Measured",
    "NoSuchPoint",
    "Point",
    "PointSet",
    "Query",
    "Source",
    "SpacePoint",
    "SpaceQuery",
    "SpaceSet",
    "StrewError",
    "__version__",
    "connect",
    "limits",
    "mask",
    "measure",
    "pixels",
    "points",
    "progress",
    "query",
    "raster",
    "space",
    "stipple",
]
