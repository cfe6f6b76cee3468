"""Fields from numpy arrays: pixels as JSON has them."""

from __future__ import annotations

import os
import struct
import zlib
from base64 import b64encode
from pathlib import Path
from typing import Any

import numpy as np

from . import _strew

Array = "np.ndarray[Any, Any]"


def pixels(array: Any, **where: Any) -> dict[str, Any]:
    """Pixels, the terrain of ``height`` and ``slope`` fields: rows from the top, where y is greatest.

    ``where`` has the members of JSON's pixels: ``bbox``, ``edges``, ``filter``, … Integers of 8 and 16 bits are sent as
    PNG, all other numbers as ``f32``.

    >>> import numpy as np, strew
    >>> terrain = strew.pixels(np.linspace(0, 90, 64 * 64).reshape(64, 64), bbox=(0, 0, 64, 64))
    >>> low = strew.points(bbox=(0, 0, 64, 64), spacing=1, field={"height": {"terrain": terrain, "heights": [30, 60],
    ...     "shares": [1, 0]}})
    >>> bool(low.y.mean() > 32)
    True
    """
    array = np.asarray(array)
    if array.dtype == np.bool_:
        array = array.astype(np.uint8) * np.uint8(255)
    if array.ndim != 2:
        raise ValueError(f"pixels have 2 dimensions, not {array.ndim}: rows and columns")
    made: dict[str, Any]
    if array.dtype in (np.uint8, np.uint16):
        made = {"png": b64encode(_png(array)).decode()}
    else:
        floats = np.ascontiguousarray(array, dtype="<f4")
        height, width = floats.shape
        made = {"f32": b64encode(floats.tobytes()).decode(), "width": width, "height": height}
    made.update((name, _listed(value)) for name, value in where.items() if value is not None)
    return made


def raster(array: Any, **where: Any) -> dict[str, Any]:
    """A field of the pixels of an array: shares of the density from 0 to 1, or up to the greatest integer.

    >>> import numpy as np, strew
    >>> mask = np.zeros((8, 8)); mask[:, 4:] = 1
    >>> points = strew.points(bbox=(0, 0, 8, 8), spacing=0.2, field=strew.raster(mask, filter="nearest"))
    >>> bool(points.x.min() >= 4)
    True
    """
    return {"raster": pixels(array, **where)}


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
    body = chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(lines, 6)) + chunk(b"IEND", b"")
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
    width, height, words = _strew.darkness(picture, invert)
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
