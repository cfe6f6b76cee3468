"""Writes known.zst: the definitions of coordinate reference systems as PROJJSON, a line each behind its name.

Takes them from the database of PROJ by pyproj: all projected and geographic systems of EPSG in two dimensions that are
not deprecated, and OGC:CRS84. Areas, scopes and remarks are left out, numbers are not changed.

    pip install pyproj && python make.py && zstd --ultra -22 known -o known.zst
"""

import json

from pyproj import CRS
from pyproj.database import query_crs_info
from pyproj.enums import PJType

LEFT_OUT = {"scope", "area", "bbox", "usages", "remarks", "$schema"}


def slim(value):
    if isinstance(value, dict):
        return {name: slim(of) for name, of in value.items() if name not in LEFT_OUT}
    return [slim(of) for of in value] if isinstance(value, list) else value


kinds = [PJType.PROJECTED_CRS, PJType.GEOGRAPHIC_2D_CRS]
known = query_crs_info("EPSG", kinds, allow_deprecated=False)
names = [f"EPSG:{info.code}" for info in sorted(known, key=lambda info: int(info.code))]
with open("known", "w", encoding="utf-8") as file:
    for name in ["OGC:CRS84", *names]:
        definition = slim(CRS.from_user_input(name).to_json_dict())
        file.write(f"{name} {json.dumps(definition, separators=(',', ':'), ensure_ascii=False)}\n")
