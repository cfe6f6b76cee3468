"""Measuring points: how even they are, and how isotropic."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._errors import fault
from ._native import native
from ._points import PointSet
from ._space import SpaceSet

Floats = np.ndarray[Any, np.dtype[np.float64]]


class Measured:
    """Figures and curves of a set of points. Frequencies ν are in units of the square root of the density."""

    def __init__(self, document: dict[str, Any], inputs: tuple[Any, ...], report: Any = None) -> None:
        self._document, self._inputs, self._report = document, inputs, report
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
        if self._report is None:
            # It was pickled without what pictures are drawn from.
            self._report = native().measure(*self._inputs)
        drawn: str = self._report.svg(title)
        return drawn

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._document, self._inputs)

    def _repr_svg_(self) -> str:
        return self.svg()

    def __repr__(self) -> str:
        return f"<{self.points} points: {self.figures}>"


def measure(
    points: Any,
    *,
    bbox: Any = None,
    density: float | None = None,
    periodic: bool | None = None,
    nu_max: float = 4.0,
    ring_width: float | None = None,
) -> Measured:
    """Measures points that fill a square: a :class:`PointSet` in a square box, or an array of pairs with ``bbox``.

    ``periodic`` says whether the square continues itself, as a set of ``strew.points(periodic=…)`` does, of which that
    is known. ``density`` is the number of points per unit of area, by default that of the query or the square.
    ``nu_max`` is the greatest frequency and ``ring_width`` the width of a ring of frequencies, in units of the square
    root of the density.

    >>> import strew
    >>> measured = strew.measure(strew.points(bbox=(0, 0, 60, 60), spacing=1, seed=1))
    >>> bool(measured.figures["low_power"] < 1e-3)
    True
    """
    if isinstance(points, SpaceSet):
        raise fault("points", points, "points in space", "a set of the plane, or pairs of coordinates with bbox=")
    if isinstance(points, PointSet):
        query = points.query
        is_periodic = "periodic" in points.body
        periodic = is_periodic if periodic is None else periodic
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
    inputs = (np.ascontiguousarray(at).tobytes(), corners, density, bool(periodic), nu_max, ring_width)
    report = native().measure(*inputs)
    return Measured(report.document(), inputs, report)
