"""Threshold masks for dithering, as arrays."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._native import native
from ._query import address


def mask(size: int, *, seed: int = 0, profile: str | None = None) -> np.ndarray[Any, np.dtype[np.float64]]:
    """A tileable threshold mask of ``size`` by ``size`` pixels, 16 to 1024: each pixel has a threshold in [0, 1).

    ``mask < gray`` is on in the share ``gray`` of all pixels, evenly spread at every level, across the seam, too.
    ``mask * size**2`` are the ranks, each once. Another ``seed`` makes another mask. ``profile`` names the pattern of
    the first eighth, by default that of the daemon's ``/v1/mask.png``. A second takes about 400 by 400 pixels.

    Raises :class:`strew.StrewError` for a size that is out of range.

    >>> import strew
    >>> mask = strew.mask(32, seed=7)
    >>> mask.shape, int((mask < 0.25).sum())
    ((32, 32), 256)
    """
    values = {} if profile is None else {"profile": profile}
    ranks = np.frombuffer(native().mask(size, seed, address(values)), np.uint32).reshape(size, size)
    return ranks / float(size * size)
