"""Fields from numpy arrays: pixels as JSON has them."""

from __future__ import annotations

import os
import struct
import zlib
from base64 import b64encode
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ._crs import Placed, joined, named
from ._errors import fault
from ._native import native
from ._rasters import checked, masked, of_classes, opened, placed, where_it_is


def pixels(
    array: Any,
    *,
    bbox: Any = None,
    transform: Any = None,
    crs: Any = None,
    nodata: float | None = None,
    band: int | None = None,
    **where: Any,
) -> dict[str, Any]:
    """Pixels, the terrain of ``height`` and ``slope`` fields: rows from the top, where y is greatest.

    ``array``, ``bbox``, ``transform``, ``crs`` and ``band`` are those of :func:`raster`. Where they
    are masked or ``nodata``, a field of them has the share 0. ``where`` has the members of JSON's pixels: ``edges``, ``filter``, … Integers of 8 and 16 bits are sent as PNG, all other numbers as ``f32``.

    >>> import numpy as np, strew
    >>> terrain = strew.pixels(np.linspace(0, 90, 64 * 64).reshape(64, 64), bbox=(0, 0, 64, 64))
    >>> low = strew.points(bbox=(0, 0, 64, 64), spacing=1, field={"height": {"terrain": terrain, "heights": [30, 60],
    ...     "shares": [1, 0]}})
    >>> bool(low.y.mean() > 32)
    True
    """
    array, read, own = opened(array, band, transform is not None)
    plain, missing = masked(array, nodata)
    if missing is not None:
        plain = np.where(missing, np.nan, plain.astype(np.float64))
    crs = joined({"array": named(own), "crs": named(crs)})
    return _pixels(plain, bbox, where_it_is(bbox, transform, read), crs, where)


def _pixels(array: np.ndarray[Any, Any], bbox: Any, transform: Any, crs: Any, where: dict[str, Any]) -> Placed:
    if transform is not None and bbox is None:
        array, bbox = placed(array, transform)
    if array.dtype == np.bool_:
        array = array.astype(np.uint8) * np.uint8(255)
    made = Placed.of({}, crs)
    if array.dtype in (np.uint8, np.uint16):
        made["png"] = b64encode(_png(array)).decode()
    else:
        floats = np.ascontiguousarray(array, dtype="<f4")
        height, width = floats.shape
        made.update(f32=b64encode(floats.tobytes()).decode(), width=width, height=height)
    where = {"bbox": bbox, **where}
    made.update((name, _listed(value)) for name, value in where.items() if value is not None)
    return made


def raster(
    array: Any,
    *,
    bbox: Any = None,
    transform: Any = None,
    crs: Any = None,
    nodata: float | None = None,
    band: int | None = None,
    shares: Mapping[float, float] | None = None,
    **where: Any,
) -> dict[str, Any]:
    """A field of the pixels of an array: the share of the density that is left at each place.

    ``array`` has rows and columns. Floats are shares from 0 to 1, ``bool`` is 0 or 1 with sharp edges, and of ``uint8``
    and ``uint16`` the greatest number of the type (255, 65535) is 1. ``white=`` and ``black=`` name other numbers for 1 and 0. Integers
    that hold 0 and 1 alone are refused as ``uint8``: pass ``array.astype(bool)``. A rasterio dataset, or one of its
    bands (``rasterio.band(dataset, 2)`` or ``band=2``), is read with its transform, its reference system and its mask.
    So is an array of xarray, by the names and the coordinates of its dimensions.

    Masked pixels, and those that equal ``nodata`` (which may be NaN), have the share 0 up to their edges, whatever is
    made of the field.

    ``bbox`` is the place of the whole array: its first row is at the top, where y is greatest. ``transform`` is an
    Affine in its place, or its six numbers a, b, c, d, e, f as rasterio has them; rows may run in any direction along
    the axes. Without both a pixel is a unit. ``crs`` names the reference system of that place; one that contradicts
    that of the region is refused.

    ``shares`` makes a raster of classes, such as land cover, a field: ``shares={3: 1, 4: 0.2}`` has the share of each
    class, and 0 for all others; its pixels are not interpolated.

    ``where`` has further members of JSON's rasters: ``edges``, ``filter``, ``low``, ``high``, ``gamma``, ….

    >>> import numpy as np, strew
    >>> mask = np.zeros((8, 8)); mask[:, 4:] = 1
    >>> points = strew.points(bbox=(0, 0, 8, 8), spacing=0.2, field=strew.raster(mask, filter="nearest"))
    >>> bool(points.x.min() >= 4)
    True
    """
    array, read, own = opened(array, band, transform is not None)
    plain, missing = masked(array, nodata)
    if shares is not None:
        plain = of_classes(plain, shares)
    if shares is not None or plain.dtype == np.bool_:
        # Between classes, and between yes and no, is nothing.
        where.setdefault("filter", "nearest")
    checked(plain if missing is None else plain[~missing], where.get("white"))
    if missing is not None:
        if plain.dtype in (np.uint8, np.uint16):
            where.setdefault("white", int(np.iinfo(plain.dtype).max))
        # What JSON's floats have for a pixel without data.
        plain = np.where(missing, np.nan, plain.astype(np.float64))
    crs = joined({"array": named(own), "crs": named(crs)})
    return Placed.of({"raster": _pixels(plain, bbox, where_it_is(bbox, transform, read), crs, where)}, crs)


def _listed(value: Any) -> Any:
    if isinstance(value, (tuple, np.ndarray)):
        return [item.item() if isinstance(item, np.generic) else item for item in value]
    return value


def _png(array: np.ndarray[Any, Any]) -> bytes:
    """A gray PNG."""
    height, width = array.shape
    bits = 8 * array.dtype.itemsize
    rows = np.ascontiguousarray(array.astype(array.dtype.newbyteorder(">"))).tobytes()
    stride = width * array.dtype.itemsize
    lines = b"".join(b"\0" + rows[at : at + stride] for at in range(0, len(rows), max(stride, 1)))

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", width, height, bits, 0, 0, 0, 0)
    # In parts, between which Ctrl-C is heard.
    packer, part = zlib.compressobj(6), 1 << 20
    packed = b"".join(packer.compress(lines[at : at + part]) for at in range(0, len(lines), part)) + packer.flush()
    body = chunk(b"IHDR", head) + chunk(b"IDAT", packed) + chunk(b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + body


def darkness(image: Any, invert: bool) -> np.ndarray[Any, np.dtype[np.uint16]]:
    """How dark each pixel of a picture is, in linear light; some pixel is."""
    dark = _darkness(image, invert)
    if not dark.any():
        color, other = ("black", "without invert") if invert else ("white", "with invert=True")
        raise ValueError(f"the picture is all {color}: no dot has a place; allowed: another picture, or {other}")
    return dark


def _darkness(image: Any, invert: bool) -> np.ndarray[Any, np.dtype[np.uint16]]:
    if isinstance(image, (str, os.PathLike)):
        picture = Path(image).read_bytes()
    elif isinstance(image, (bytes, bytearray, memoryview)):
        picture = bytes(image)
    else:
        array = np.asarray(image)
        if array.dtype.kind == "f":
            if array.ndim != 2:
                raise ValueError(f"a picture of floats has 2 dimensions, not {array.ndim}")
            if array.size and not (np.isfinite(array).all() and array.min() >= 0 and array.max() <= 1):
                raise ValueError("a picture of floats has light from 0 (black) to 1 (white)")
            light = array if invert else 1.0 - array
            return (light * 65535.0 + 0.5).astype(np.uint16)
        picture = _picture(array)
    width, height, words = native().darkness(picture, invert)
    return np.frombuffer(words, dtype=np.uint16).reshape(height, width)


def _picture(array: np.ndarray[Any, Any]) -> bytes:
    """An array of sRGB as a PNG: gray, with alpha, RGB, RGBA."""
    if array.dtype == np.bool_:
        array = array.astype(np.uint8) * np.uint8(255)
    if array.dtype not in (np.uint8, np.uint16):
        raise ValueError(f"a picture is of uint8, uint16, bool or floats, not of {array.dtype}")
    if array.ndim == 2:
        return _png(array)
    if array.ndim != 3 or array.shape[2] not in (1, 2, 3, 4):
        raise ValueError(f"a picture has rows, columns and up to 4 channels, not the shape {array.shape}")
    height, width, channels = array.shape
    gray = _png(array.reshape(height, width * channels))
    # The head is replaced: it declares the samples to be of several channels.
    kind = {1: 0, 2: 4, 3: 2, 4: 6}[channels]
    head = struct.pack(">IIBBBBB", width, height, 8 * array.dtype.itemsize, kind, 0, 0, 0)
    crc = struct.pack(">I", zlib.crc32(b"IHDR" + head))
    return gray[:16] + head + crc + gray[33:]
