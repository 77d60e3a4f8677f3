"""Nav2's keep-out mask, read by the rules of its map server."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import shapely
from _exports import GOOD, demo, jones_farms, odd_names, once, shifted
from _nav2 import Grid, along, filter_info, load_raw

import groundplan
from groundplan import ParameterError


def corners(survey: groundplan.Survey) -> list[tuple[float, float]]:
    """The map's corners in the map frame."""
    info = survey.map
    (x, y, yaw), wide, high = info.origin, info.width * info.resolution, info.height * info.resolution
    cos, sin = math.cos(yaw), math.sin(yaw)
    return [(x + u * cos - v * sin, y + u * sin + v * cos) for u in (0.0, wide) for v in (0.0, high)]


def agree(grid: Grid, shape: shapely.Geometry) -> bool:
    """Whether the cells at 100 are those whose centres lie in a shape, and all others are 0."""
    x, y = grid.centres()
    edge = shapely.boundary(shape)
    sure = shapely.distance(shapely.points(x, y), edge) > 1e-6
    shapely.prepare(shape)
    return bool((np.where(shapely.contains_xy(shape, x, y), 100, 0) == grid.data)[sure].all())


@pytest.mark.parametrize("which", GOOD)
def test_racks_are_kept_out_of_to_the_pixel_and_nothing_else_is(which: str, tmp_path: Path) -> None:
    survey = GOOD[which]()
    file = once(survey, "keepout", tmp_path, keep="racks")
    racks = shapely.union_all([shapely.Polygon(rack["polygon"]) for rack in survey.of_kind("rack")])
    assert agree(load_raw(file), racks)
    assert filter_info(file, "keepout") == (0, 0.0, 1.0)


@pytest.mark.parametrize("which", GOOD)
def test_walls_are_kept_out_of_without_a_gap_and_aisles_stay_open(which: str, tmp_path: Path) -> None:
    survey = GOOD[which]()
    grid = load_raw(once(survey, "keepout", tmp_path))
    assert set(np.unique(grid.data)) == {0, 100}
    for start, end in survey.walls.points.reshape(-1, 2, 2):
        steps = np.linspace(0, 1, 2 + int(4 * math.dist(start, end) / grid.resolution))[1:-1, None]
        assert (grid.at(start + steps * (end - start)) == 100).all()
    for corridor in survey.of_kind("corridor"):
        start, end = np.array(corridor["axis"])
        middle = start + np.linspace(0.1, 0.9, 50)[:, None] * (end - start)
        assert (grid.at(middle) == 0).mean() > 0.9


def test_the_mask_has_the_map_s_frame_or_one_without_yaw_that_holds_the_map(tmp_path: Path) -> None:
    own, info = load_raw(once(demo(), "keepout", tmp_path)), demo().map
    assert own.origin == pytest.approx(info.origin[:2], abs=1e-9) and own.data.shape == (info.height, info.width)
    assert own.resolution == info.resolution
    turned = load_raw(once(shifted(), "keepout", tmp_path))
    x, y = turned.origin
    high, wide = (size * turned.resolution for size in turned.data.shape)
    found = np.array(corners(shifted()))
    assert (found > (x - 1e-6, y - 1e-6)).all() and (found < (x + wide + 1e-6, y + high + 1e-6)).all()
    assert np.ptp(found, axis=0) == pytest.approx((wide, high), abs=2 * turned.resolution)
    assert x / 0.05 == pytest.approx(round(x / 0.05), abs=1e-6)


def test_what_the_rules_close_is_kept_out_of_but_not_the_ways_across_it(tmp_path: Path) -> None:
    survey = demo()
    grid = load_raw(once(survey, "keepout", tmp_path, keep="racks", rules=[{"name": "A03", "way": "closed"}]))
    shapes = {label["name"]: shapely.Polygon(label["polygon"]) for label in survey.of_kind("corridor")}
    across = shapely.union_all([shape for name, shape in shapes.items() if name != "A03"])
    points = [shapely.Point(*p) for p in along(survey.labels[1]["axis"], 200)]
    assert survey.labels[1]["name"] == "A03"
    values = grid.at([(p.x, p.y) for p in points])
    crossings = np.array([across.contains(p) for p in points])
    assert 0 < crossings.sum() < len(points)
    near = np.array([shapely.boundary(across).distance(p) < 0.1 or not shapes["A03"].contains(p) for p in points])
    # Junctions are as open as the ways that meet there.
    junctions = shapely.union_all([shapely.Polygon(j["polygon"]).buffer(0.1) for j in survey.of_kind("junction")])
    open_ = crossings | np.array([junctions.contains(p) for p in points])
    assert (values[~open_ & ~near] == 100).all() and (values[crossings & ~near] == 0).all()
    assert (~open_ & ~near).sum() > 50


def test_racks_without_names_that_yaml_likes_and_an_office_are_written(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    files = odd_names().export(tmp_path / "a", "keepout")
    assert load_raw(files[0]).data.max() == 100 and filter_info(files[0], "keepout")[0] == 0
    assert load_raw(once(jones_farms(), "keepout", tmp_path)).data.max() == 100


def test_what_there_is_not_cannot_be_kept_out_of(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="'trees' is nothing to keep out of") as told:
        demo().export(tmp_path / "x", "keepout", keep="racks,trees")
    assert told.value.code == "export.keep"
