"""GeoJSON, read by GDAL and shapely and held against RFC 7946; the true place on Earth by a geodesic."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pyogrio.raw
import pyproj
import pytest
import shapely
from _exports import GOOD, ODD, demo, loads, once

from groundplan import ParameterError
from groundplan.roadmap import road_map


def features(path: Path, layer: str | None = None) -> list[tuple[Any, dict[str, Any]]]:
    """Shapes and properties, of one layer or all."""
    tree = loads(path)
    assert tree["type"] == "FeatureCollection" and "crs" not in tree  # RFC 7946, 4
    return [
        (shapely.geometry.shape(feature["geometry"]), feature["properties"])
        for feature in tree["features"]
        if layer in (None, feature["properties"]["layer"])
    ]


@pytest.mark.parametrize("which", [*GOOD, *ODD])
def test_every_feature_comes_back_and_shells_turn_as_the_rfc_wants(which: str, tmp_path: Path) -> None:
    survey = (GOOD | ODD)[which]()
    read = features(once(survey, "geojson", tmp_path))
    assert sum(values["layer"] == "faces" for _, values in read) == len(survey.subdivision.areas)
    for shape, _ in read:
        assert shape.is_valid and not shape.is_empty
        if shape.geom_type == "Polygon":
            assert shape.exterior.is_ccw and not any(hole.is_ccw for hole in shape.interiors)


@pytest.mark.parametrize("which", GOOD)
def test_gdal_reads_metres_to_a_millimetre(which: str, tmp_path: Path) -> None:
    survey = GOOD[which]()
    file = once(survey, "geojson", tmp_path)
    assert loads(file)["frame"] == "map" and loads(file)["units"] == "m" and file.name.endswith(".local.geojson")
    _, _, blobs, _ = pyogrio.raw.read(file, where="layer = 'walls'")
    for shape, ends in zip(shapely.from_wkb(blobs), survey.walls.points.reshape(-1, 2, 2), strict=True):
        assert np.abs(shapely.get_coordinates(shape) - ends).max() < 1e-3


def test_the_road_map_is_a_layer_too(tmp_path: Path) -> None:
    roads = road_map(demo(), vehicle_width=1.0)
    lanes = features(once(demo(), "geojson", tmp_path, vehicle_width=1.0), "road_lanes")
    assert [values["id"] for _, values in lanes] == [lane.id for lane in roads.lanes]
    assert [shape.length for shape, _ in lanes] == pytest.approx([roads.length(lane) for lane in roads.lanes], abs=1e-3)


@pytest.mark.parametrize("heading", [90.0, 0.0, 217.5])
def test_with_an_anchor_lengths_and_headings_on_earth_are_the_map_s(heading: float, tmp_path: Path) -> None:
    survey = demo()
    file = once(survey, "geojson", tmp_path, anchor=(57.7, 11.97, heading))
    assert file.name == "file.geojson" and "frame" not in loads(file)
    earth = pyproj.Geod(ellps="WGS84")
    for (shape, _), ends in zip(features(file, "walls"), survey.walls.points.reshape(-1, 2, 2), strict=True):
        (lon0, lat0), (lon1, lat1) = shape.coords
        azimuth, _, length = earth.inv(lon0, lat0, lon1, lat1)
        assert length == pytest.approx(math.dist(*ends), abs=1e-3)
        away, _, distance = earth.inv(11.97, 57.7, lon0, lat0)
        x, y = ends[0]
        assert distance == pytest.approx(math.hypot(x, y), abs=1e-3)
        if length > 1.0:
            turned = heading - math.degrees(math.atan2(ends[1][1] - ends[0][1], ends[1][0] - ends[0][0]))
            assert math.cos(math.radians(azimuth - turned)) == pytest.approx(1.0, abs=1e-6)
        if distance > 1.0:
            assert math.cos(math.radians(away - (heading - math.degrees(math.atan2(y, x))))) > 1 - 1e-6


@pytest.mark.parametrize("anchor", [(57.7,), (91.0, 0.0, 0.0), (0.0, 200.0, 0.0), (math.nan, 0.0, 0.0)])
def test_an_anchor_that_is_no_place_is_refused(anchor: tuple[float, ...], tmp_path: Path) -> None:
    with pytest.raises(ParameterError) as told:
        once(demo(), "geojson", tmp_path, anchor=anchor)
    assert told.value.code == "export.anchor" and not list(tmp_path.iterdir())
