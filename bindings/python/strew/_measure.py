"""Measuring points: how even they are, and how isotropic."""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from . import _strew
from ._points import PointSet

Floats = np.ndarray[Any, np.dtype[np.float64]]


class Measured:
    """Figures and curves of a set of points. Frequencies ν are in units of the square root of the density."""

    def __init__(self, report: _strew.Report) -> None:
        self._report = report
        document = json.loads(report.document())
        #: The number of points.
        self.points: int = document["points"]
        #: Figures by name: ``delta_min``, ``low_power``, ``peak_power``, ``anisotropy_db``, …
        self.figures: dict[str, float] = document["figures"]
        #: Rows of ν, radial power and anisotropy in dB.
        self.radial: Floats = np.array(document["radial"]["rings"], dtype=np.float64)
        #: Rows of a distance in mean spacings and the radial distribution function.
        self.rdf: Floats = np.array(document["rdf"]["bins"], dtype=np.float64)

    def svg(self, title: str = "points") -> str:
        """Points, spectrum and curves as a picture."""
        return self._report.svg(title)

    def _repr_svg_(self) -> str:
        return self.svg()

    def __repr__(self) -> str:
        return f"<{self.points} points: {self.figures}>"


def measure(
    points: Any,
    *,
    bbox: Any = None,
    density: float | None = None,
    periodic: bool = False,
    nu_max: float = 4.0,
    ring_width: float | None = None,
) -> Measured:
    """Measures points that fill a square: a :class:`PointSet` in a square box, or an array of pairs with ``bbox``.

    >>> import strew
    >>> measured = strew.measure(strew.points(bbox=(0, 0, 60, 60), spacing=1, seed=1))
    >>> bool(measured.figures["low_power"] < 1e-3)
    True
    """
    if isinstance(points, PointSet):
        query = points.query
        if bbox is None:
            bbox = query["bbox"]
        if density is None and "layers" not in query and "field" not in query and "keep" not in query:
            density = query.get("density")
        if points.origin is not None:
            raise ValueError("the points of a chunk are relative to its corner: measure points within a bbox")
        at = points.xy
    else:
        at = np.asarray(points, dtype=np.float64)
    if bbox is None:
        raise TypeError("bbox is missing: the square that the points fill")
    if at.ndim != 2 or at.shape[1] != 2:
        raise ValueError(f"points are pairs of coordinates, not an array of the shape {at.shape}")
    corners = tuple(float(corner) for corner in bbox)
    if len(corners) != 4:
        raise ValueError(f"bbox has four numbers, not {len(corners)}")
    report = _strew.measure(np.ascontiguousarray(at).tobytes(), corners, density, periodic, nu_max, ring_width)
    return Measured(report)
