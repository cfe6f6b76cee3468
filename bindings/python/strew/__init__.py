"""Blue-noise points of any region: evenly spread, without a pattern, the same for everyone.

A set of points fills the whole plane and is stored nowhere. A query names a set (its spacing and seed) and a
region; the same query has the same points on every machine.

>>> import strew
>>> points = strew.points(bbox=(0, 0, 10, 10), spacing=1, seed=7)
>>> len(points)
100
>>> points.xy.shape
(100, 2)

:func:`points` answers in this process. :func:`connect` asks a daemon instead; what it returns has the same
functions and the same points.
"""

from ._errors import Disconnected, StrewError
from ._fields import pixels, raster
from ._local import LOCAL
from ._measure import Measured, measure
from ._points import Point, PointSet
from ._query import Query
from ._remote import Daemon, connect
from ._source import Source
from ._strew import __version__

points = LOCAL.points
query = LOCAL.query
stipple = LOCAL.stipple

__all__ = [
    "Daemon",
    "Disconnected",
    "Measured",
    "Point",
    "PointSet",
    "Query",
    "Source",
    "StrewError",
    "__version__",
    "connect",
    "measure",
    "pixels",
    "points",
    "query",
    "raster",
    "stipple",
]
