"""Arrays as rasters: where they lie, which of their pixels have data, and what their numbers mean."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np

from ._errors import fault

Array = np.ndarray[Any, Any]

#: Names of the dimensions of xarray that rows and columns are.
ROWS, COLUMNS = ("y", "lat", "latitude", "northing"), ("x", "lon", "longitude", "easting")


def opened(source: Any, band: int | None, has_transform: bool = False) -> tuple[Any, Any, Any]:
    """An array, its transform and its reference system: those of a rasterio dataset or band are read, and those of an
    array of xarray, unless it has a transform of the caller's."""
    if isinstance(source, (str, bytes, os.PathLike)):
        raise fault("array", source, "not an array", "rasterio.open(path), or np.asarray(PIL.Image.open(path))")
    if all(hasattr(source, name) for name in ("dims", "coords", "transpose", "values")):
        return _of_xarray(source, band, has_transform)
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


def _of_xarray(source: Any, band: int | None, has_transform: bool) -> tuple[Any, Any, Any]:
    """The rows and columns of an array of xarray by the names of its dimensions, from the top and from the left by
    their coordinates, with the place that these say."""
    row, column = (next((dim for dim in source.dims if str(dim).lower() in names), None) for names in (ROWS, COLUMNS))
    if row is None or column is None:
        known = f"dimensions named {' or '.join(ROWS)} and {' or '.join(COLUMNS)}, or the array's values"
        raise fault("array", source.dims, "dimensions of which rows and columns are not known", known)
    for dim in set(source.dims) - {row, column}:
        bands = source.sizes[dim]
        if band is None and bands != 1:
            raise fault("band", band, f"the array has {bands} of {dim}", f"band=1 to band={bands}")
        source = source.isel({dim: 0 if band is None else int(band) - 1})
    missing = source.attrs.get("_FillValue", source.attrs.get("missing_value"))
    stated = [source.coords[name].attrs for name in ("spatial_ref", "crs") if name in source.coords]
    crs = next((attrs[name] for attrs in stated for name in ("crs_wkt", "spatial_ref") if name in attrs), None)
    source = source.transpose(row, column)
    transform = None
    if not has_transform and row in source.coords and column in source.coords:
        source = source.sortby(column).sortby(row, ascending=False)
        (x, width), (y, height) = (_step(source.coords[dim].values, str(dim)) for dim in (column, row))
        transform = (width, 0.0, x - width / 2, 0.0, height, y - height / 2)
    values = np.ma.masked_invalid(source.values) if source.dtype.kind == "f" else source.values
    return (values if missing is None else np.ma.masked_equal(values, missing)), transform, crs


def _step(centers: Array, dim: str) -> tuple[float, float]:
    """The first of some centers of pixels, and the distance from each to the next."""
    steps = np.diff(centers.astype(np.float64))
    if not len(steps):
        raise fault("array", dim, "one coordinate, which has no width", "transform=, beside the array's values")
    step = float(steps.mean())
    if not np.allclose(steps, step, rtol=1e-3, atol=0):
        raise fault("array", dim, "coordinates at uneven distances", "an array on a regular grid: interpolate it first")
    return float(centers[0]), step


def masked(array: Any, nodata: float | None) -> tuple[Array, Array | None]:
    """An array of two dimensions, and which pixels lack data, if any do."""
    missing = np.ma.getmaskarray(array).copy() if np.ma.isMaskedArray(array) else None
    plain = np.asarray(np.ma.getdata(array) if np.ma.isMaskedArray(array) else array)
    # One order of bytes, so that types are known.
    plain = plain.astype(plain.dtype.newbyteorder("="), copy=False)
    if plain.ndim != 2:
        way_out = "array[0]" if plain.ndim == 3 and plain.shape[0] == 1 else "one band, array[k] or array[:, :, k]"
        raise fault("array", plain.shape, f"pixels have 2 dimensions, not {plain.ndim}", f"rows and columns: {way_out}")
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
