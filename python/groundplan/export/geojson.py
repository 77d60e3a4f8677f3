"""GeoJSON (RFC 7946): every layer in one collection, in metres of the map frame or, with an anchor, in WGS 84.

RFC 7946 knows longitude and latitude only. Without an anchor the file is therefore no GeoJSON in its strict sense, and
says so: its name ends in ``.local.geojson``, and it has the foreign members ``frame`` and ``units``.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from groundplan._errors import ParameterError
from groundplan._extras import needed
from groundplan._files import write_text
from groundplan.export._features import layers

if TYPE_CHECKING:
    from groundplan.survey import Survey

LOCAL, TRUE = ".local.geojson", ".geojson"
HINT = "such as 57.7,11.97,90: the map frame's x axis points east"


def write(survey: Survey, path: Path, anchor: tuple[float, ...] | None = None, **roads: Any) -> list[Path]:
    """Write all layers as features with the member ``layer`` among their properties.

    Parameters
    ----------
    survey, path
        With an anchor, a name that ends in ``.local.geojson`` loses the ``.local``.
    anchor
        Latitude and longitude of the map frame's origin, degrees in WGS 84, and the heading of its x axis, degrees
        clockwise from north.
    **roads
        Options of `groundplan.roadmap.road_map`.

    Raises
    ------
    ParameterError
        ``export.anchor``.
    """
    if anchor is not None:
        place, head, digits = _anchored(anchor), {}, 9  # 1e-9 degrees are a tenth of a millimetre
        if path.name.endswith(LOCAL):
            path = path.with_name(path.name.removesuffix(LOCAL) + TRUE)
    else:
        place, head, digits = None, {"frame": "map", "units": "m"}, 6
    features = []
    for layer in layers(survey, **roads):
        shapes = np.array(layer.shapes, dtype=object)
        if place is not None:
            shapes = shapely.transform(shapes, place)
        texts = shapely.to_geojson(shapely.transform(shapes, lambda points: points.round(digits)))
        for (_, values), text in zip(layer.features(), texts, strict=True):
            known = {key: value for key, value in values.items() if value == value}  # NaN is no JSON
            said = json.dumps({"layer": layer.name} | known, ensure_ascii=False)
            features.append(f'{{"type": "Feature", "properties": {said}, "geometry": {text}}}')
    rows = ",\n".join(features)
    members = "".join(f"{json.dumps(key)}: {json.dumps(value)},\n" for key, value in head.items())
    write_text(path, f'{{"type": "FeatureCollection",\n{members}"features": [\n{rows}\n]}}\n')
    return [path]


def _anchored(anchor: tuple[float, ...]) -> Any:
    """A function from metres in the map frame to degrees of longitude and latitude."""
    if len(anchor) != 3 or not all(math.isfinite(value) for value in anchor):
        raise ParameterError("export.anchor", f"the anchor {anchor!r} is not latitude, longitude and heading", HINT)
    latitude, longitude, heading = anchor
    if abs(latitude) > 89 or abs(longitude) > 180 or abs(heading) > 360:
        raise ParameterError("export.anchor", f"the anchor {anchor!r} is outside 89, 180 and 360 degrees", HINT)
    pyproj = needed("pyproj", "gis")
    # Azimuthal equidistant: true distances and headings from the anchor, 1 mm off at 10 km from it.
    flat = pyproj.CRS.from_dict({"proj": "aeqd", "lat_0": latitude, "lon_0": longitude, "datum": "WGS84"})
    project = pyproj.Transformer.from_crs(flat, "EPSG:4326", always_xy=True)
    turn = math.radians(90 - heading)
    to_east_north = np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])

    def place(points: Any) -> Any:
        east, north = (points @ to_east_north).T
        return np.column_stack(project.transform(east, north))

    return place
