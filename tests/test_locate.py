"""Which face and which labels hold a point."""

from __future__ import annotations

import copy
import math
import pickle
from typing import Any

import numpy as np
import pytest
import zoo
from zoo import RESOLUTION, TURNS, ZOO

import groundplan
from groundplan import Directions, Lines, ParameterError, Survey
from groundplan._results import NONE

EVERY = [(name, turn) for name in ZOO for turn in TURNS]


def two_lines() -> Survey:
    """5 m by 4 m, a level line at 2 m and an upright one at 3 m."""
    map = groundplan.from_array(np.full((80, 100), zoo.FREE, dtype=np.uint8), RESOLUTION)
    return groundplan.survey(
        map, directions=Directions.of([0.0, -math.pi / 2]), lines=Lines.of([0, 1], [2.0, 3.0]), threads=1
    )


@pytest.mark.parametrize(("name", "turn"), EVERY)
def test_the_centre_of_a_face_is_in_it(name: str, turn: int) -> None:
    survey = zoo.surveyed(name, turn)
    cut = survey.subdivision
    # The centre of a sliver thinner than a micrometre is rounded out of it.
    faces = np.flatnonzero(cut.areas > 1e-3)
    assert [survey.locate(*cut.centres[face].tolist()) for face in faces] == faces.tolist()


@pytest.mark.parametrize("name", ZOO)
def test_a_point_is_within_the_polygon_of_its_face(name: str) -> None:
    survey = zoo.surveyed(name)
    size = np.array([survey.map.width, survey.map.height]) * RESOLUTION
    points = np.random.default_rng(1).random((300, 2)) * size
    found = survey.locate(points[:, 0], points[:, 1])
    assert (found >= 0).all()
    for point, face in zip(points, found, strict=True):
        corners = survey.subdivision.polygon(int(face))
        sides, towards = np.roll(corners, -1, axis=0) - corners, point - corners
        assert (sides[:, 0] * towards[:, 1] - sides[:, 1] * towards[:, 0] > -1e-5).all()


def test_a_point_on_a_line_is_in_the_face_on_the_side_of_its_normal() -> None:
    survey = two_lines()
    assert survey.locate(1.0, 2.0) == survey.locate(1.0, 2.1) != survey.locate(1.0, 1.9)
    assert survey.locate(3.0, 1.0) == survey.locate(3.1, 1.0) != survey.locate(2.9, 1.0)
    assert survey.locate(3.0, 2.0) == survey.locate(4.0, 3.0)


def test_the_border_is_in_the_map_and_beyond_it_is_nothing() -> None:
    survey = two_lines()
    assert [survey.locate(x, y) is None for x, y in ((0, 0), (5, 4), (0, 4), (5, 0))] == [False] * 4
    assert [survey.locate(x, y) is None for x, y in ((-1e-6, 1), (5.001, 1), (1, 4.001), (1e300, 0))] == [True] * 4


def test_many_points_are_found_as_each_of_them() -> None:
    survey = zoo.surveyed("turned_warehouse")
    x, y = np.meshgrid(np.linspace(-1, 12, 23), np.linspace(-1, 12, 17))
    found = survey.locate(x, y)
    assert found.shape == x.shape
    assert found.dtype == np.int32
    one_by_one = [survey.locate(px, py) for px, py in zip(x.ravel().tolist(), y.ravel().tolist(), strict=True)]
    assert found.ravel().tolist() == [NONE if face is None else face for face in one_by_one]
    assert {NONE} < set(found.ravel().tolist())
    assert survey.locate([1.0, 2.0], [3.0, 3.0]).tolist() == [survey.locate(1.0, 3.0), survey.locate(2.0, 3.0)]


@pytest.mark.parametrize("x", [math.nan, math.inf])
def test_a_point_that_is_no_number_is_an_error(x: float) -> None:
    survey = two_lines()
    for ask in (
        lambda: survey.locate(x, 1.0),
        lambda: survey.locate([1.0, x], [1.0, 1.0]),
        lambda: survey.labels_at(1, x),
    ):
        with pytest.raises(ParameterError, match="finite") as caught:
            ask()
        assert caught.value.code == "point.finite"


@pytest.mark.parametrize("x", ["a", 1j, 10**400])
def test_a_point_that_is_not_of_numbers_is_an_error_that_names_it(x: Any) -> None:
    survey = two_lines()
    for ask in (
        lambda: survey.locate(x, 1.0),
        lambda: survey.locate([1.0, x], [1.0, 1.0]),
        lambda: survey.labels_at(1, x),
    ):
        with pytest.raises(ParameterError) as caught:
            ask()
        assert caught.value.code == "point.number"
    with pytest.raises(ParameterError, match="1j" if isinstance(x, complex) else repr(x)):
        survey.locate(x, 1.0)


def test_a_turned_origin_turns_the_faces() -> None:
    x, y, yaw = 10.0, -5.0, 0.5
    map = groundplan.from_array(np.full((80, 100), zoo.FREE, dtype=np.uint8), RESOLUTION, (x, y, yaw))
    angles = np.array([yaw, yaw - math.pi / 2])
    middle = np.array([x + 2.5 * math.cos(yaw) - 2 * math.sin(yaw), y + 2.5 * math.sin(yaw) + 2 * math.cos(yaw)])
    lines = Lines.of([0, 1], middle[1] * np.cos(angles) - middle[0] * np.sin(angles))
    survey = groundplan.survey(map, directions=Directions.of(angles), lines=lines, threads=1)
    centres = survey.subdivision.centres
    assert len(centres) == 4
    assert [survey.locate(*centre) for centre in centres.tolist()] == [0, 1, 2, 3]
    # Of the box around the turned map.
    assert survey.locate(x + 5, y) is None


def test_a_survey_from_a_file_a_copy_and_a_pickle_find_the_same() -> None:
    survey = two_lines()
    survey.locate(1.0, 1.0)
    for other in (Survey.from_json(survey.to_json()), copy.deepcopy(survey), pickle.loads(pickle.dumps(survey))):
        assert other == survey
        assert [other.locate(x, y) for x in (1.0, 4.0) for y in (1.0, 3.0)] == [
            survey.locate(x, y) for x in (1.0, 4.0) for y in (1.0, 3.0)
        ]


def test_the_labels_at_a_point_are_those_whose_polygons_hold_it() -> None:
    shapely = pytest.importorskip("shapely")
    survey = zoo.surveyed("crossing")
    polygons = {
        n: shapely.Polygon(it["polygon"], it.get("holes")) for n, it in enumerate(survey.labels) if "polygon" in it
    }
    seen: set[str] = set()
    for x, y in (np.random.default_rng(2).random((500, 2)) * 8).tolist():
        expected = [n for n, polygon in polygons.items() if polygon.contains(shapely.Point(x, y))]
        assert survey.labels_at(x, y) == [survey.labels[n] for n in expected]
        seen.update(survey.labels[n]["kind"] for n in expected)
    assert {"corridor", "junction", "region"} <= seen
    assert survey.labels_at(-100.0, 3.0) == []
