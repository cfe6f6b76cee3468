"""Arrays as rasters: where they lie, which of their pixels have data, and what their numbers mean."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ._errors import fault

Array = np.ndarray[Any, Any]


class Pixels(dict[str, Any]):
    """Pixels or a raster as JSON has them, with the reference system that their place is in."""

    #: The name of the reference system, such as ``EPSG:32633``; ``None`` if it is not known.
    crs: str | None = None


def opened(source: Any, band: int | None) -> tuple[Any, Any, Any]:
    """An array, its transform and its reference system: those of a rasterio dataset or band are read."""
    if all(hasattr(source, name) for name in ("ds", "bidx")):
        # rasterio.band(dataset, number)
        source, band = source.ds, source.bidx
    if not all(hasattr(source, name) for name in ("read", "transform", "count")):
        if band is not None:
            raise fault("band", band, "an array has no bands", "a band of a rasterio dataset")
        return source, None, None
    if band is None and source.count != 1:
        raise fault("band", band, f"the dataset has {source.count} bands", f"band=1 to band={source.count}")
    if not isinstance(1 if band is None else band, (int, np.integer)):
        raise fault("band", band, "not the number of one band", "an integer")
    # A picture without a place has the identity, with which rows would run upward.
    transform = None if tuple(source.transform)[:6] == (1, 0, 0, 0, 1, 0) else source.transform
    return source.read(1 if band is None else int(band), masked=True), transform, source.crs


def masked(array: Any, nodata: float | None) -> tuple[Array, Array | None]:
    """An array of two dimensions, and which pixels lack data, if any do."""
    missing = np.ma.getmaskarray(array).copy() if np.ma.isMaskedArray(array) else None
    plain = np.asarray(np.ma.getdata(array) if np.ma.isMaskedArray(array) else array)
    if plain.ndim != 2:
        raise ValueError(f"pixels have 2 dimensions, not {plain.ndim}: rows and columns")
    if plain.dtype.kind not in "buif":
        raise fault("array", plain.dtype, "not numbers", "an array of numbers or of bool")
    if nodata is not None:
        is_nodata = np.isnan(plain) if np.isnan(nodata) else plain == nodata
        missing = is_nodata if missing is None else missing | is_nodata
    return plain, None if missing is None or not missing.any() else missing


def where_it_is(bbox: Any, transform: Any, read: Any) -> Any:
    """The transform of an array, beside what was read with it."""
    if bbox is not None and transform is not None:
        raise fault("transform", tuple(transform), "not beside bbox", "bbox or transform")
    return read if transform is None else transform


def placed(array: Array, transform: Any) -> tuple[Array, tuple[float, float, float, float]]:
    """An array whose rows begin at the top, and its box. The transform is an Affine, or its six numbers: x is a·column
    + b·row + c, y is d·column + e·row + f."""
    try:
        a, b, c, d, e, f = (float(number) for number in tuple(transform)[:6])
    except (TypeError, ValueError):
        raise fault("transform", transform, "not an Affine", "an Affine, or six numbers a, b, c, d, e, f") from None
    if a == e == 0 and b and d:
        # Rows run along x.
        array, a, b, d, e = array.T, b, 0.0, 0.0, d
    if b or d or not a or not e:
        raise fault("transform", (a, b, c, d, e, f), "turned or sheared", "rows and columns along the axes; warp it first")
    if a < 0:
        array, c, a = array[:, ::-1], c + a * array.shape[1], -a
    if e > 0:
        array, f, e = array[::-1], f + e * array.shape[0], -e
    height, width = array.shape
    return array, (c, f + e * height, c + a * width, f)


def of_classes(array: Array, shares: Mapping[float, float]) -> Array:
    """The share of each pixel by its class; 0 for classes that are not listed."""
    made = np.zeros(array.shape, np.float32)
    for value, share in shares.items():
        made[array == value] = share
    return made


def checked(array: Array, white: float | None) -> None:
    """Raises :class:`StrewError` for integers that are neither shares nor as wide as their type."""
    if array.dtype.kind not in "ui" or white is not None or not array.size:
        return
    most = array.max()
    if array.dtype in (np.uint8, np.uint16):
        if most == 1:
            full = np.iinfo(array.dtype).max
            detail = f"holds 0 and 1 alone, and 1 is a share of 1/{full}"
            raise fault("array", array.dtype, detail, "array.astype(bool) for a mask, or white=1")
    elif most > 1:
        detail = f"holds {most}: numbers of this type are shares"
        raise fault("array", array.dtype, detail, "uint8 or uint16, white= the number of the share 1, or shares= by class")
