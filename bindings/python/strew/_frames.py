"""Points as tables of other libraries, and as a picture of matplotlib: each is needed only where it is called."""

from __future__ import annotations

import io
import json
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from ._points import Points


def arrow(points: Points[Any], geometry: bool, crs: str | None) -> Any:
    """A ``pyarrow.Table``."""
    import pyarrow as pa

    table = pa.table(points)
    if not geometry:
        return table
    at = np.ascontiguousarray(absolute(points))
    axes = at.shape[1]
    values = pa.FixedSizeListArray.from_arrays(pa.array(at.ravel()), axes)
    metadata = {"ARROW:extension:name": "geoarrow.point"}
    if crs is not None:
        is_code = ":" in crs and "[" not in crs
        metadata["ARROW:extension:metadata"] = json.dumps({"crs": crs, "crs_type": "authority_code" if is_code else "wkt2:2019"})
    coordinate = pa.field("xyz"[:axes], pa.float64(), False)
    field = pa.field("geometry", pa.list_(coordinate, axes), False, metadata)
    kept = table.drop_columns(list("xyz"[:axes]))
    return kept.append_column(field, values.cast(field.type))


def absolute(points: Points[Any]) -> np.ndarray[Any, Any]:
    """The coordinates from the world's origin, also of chunks."""
    at = np.asarray(points)
    origin = points.columns().origin
    return at if origin is None else at + np.asarray(origin, np.float64)


def pandas(points: Points[Any]) -> Any:
    """A ``pandas.DataFrame``."""
    import pandas as pd

    columns: dict[str, Any] = {"id": points["id"]}
    columns.update((axis, points[axis]) for axis in points._dimension.axes)
    for name in points.names:
        values, names = points._further(name)
        columns[name] = values if names is None else pd.Categorical.from_codes(values, names)
    return pd.DataFrame(columns)


def geopandas(points: Points[Any], crs: str | None) -> Any:
    """A ``geopandas.GeoDataFrame``."""
    import geopandas as gpd

    frame = pandas(points).drop(columns=["x", "y"])
    at = absolute(points)
    z = frame.pop("z") if "z" in frame else None
    return gpd.GeoDataFrame(frame, geometry=gpd.points_from_xy(at[:, 0], at[:, 1], z), crs=crs)


def file(points: Points[Any], format: str, crs: str | None, options: dict[str, Any]) -> bytes:
    """A GeoParquet or an Arrow file with the columns that the command line writes, or an Arrow stream."""
    content = io.BytesIO()
    if format == "arrow":
        import pyarrow as pa

        table = pa.table(points)
        with pa.ipc.new_stream(content, table.schema, **options) as stream:
            stream.write_table(table)
        return content.getvalue()
    frame = geopandas(points, crs)
    for i, (axis, values) in enumerate(zip(points._dimension.axes, absolute(points).T), 1):
        frame.insert(i, axis, values)
    getattr(frame, f"to_{format}")(content, **{"compression": "zstd", "schema_version": "1.1.0", **options})
    return content.getvalue()


def plot(points: Points[Any], ax: Any, by: str | None, style: dict[str, Any]) -> Any:
    """The axes of matplotlib with the points on them."""
    at = absolute(points).T
    if ax is None:
        import matplotlib.pyplot as plt

        ax = plt.gca() if len(at) == 2 else plt.gcf().add_subplot(projection="3d")
    # About half of the mean spacing, for a picture of 5 inches at 72 points each.
    style.setdefault("s", min(20.0, (180.0 / max(len(points), 1) ** (1 / len(at))) ** 2))
    style.setdefault("linewidths", 0)
    values, names = (None, None) if by is None else points._further(by)
    if names is not None:
        for code, name in enumerate(names):
            ax.scatter(*at[:, values == code], label=name, **style)
        ax.legend(title=by)
    elif by is not None:
        ax.figure.colorbar(ax.scatter(*at, c=values, **style), ax=ax, label=by)
    else:
        ax.scatter(*at, **style)
    ax.set_aspect("equal")
    return ax
