"""Nav2's speed mask, read by the rules of its map server and its speed filter."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import shapely
from _exports import GOOD, demo, once
from _nav2 import Floats, along, filter_info, load_raw

import groundplan
from groundplan import ParameterError

RULES = [{"name": "A*", "speed": 1.25}, {"name": "C*", "speed": 0.9}, {"name": "J0*", "speed": 0.333}]


def limits(file: Path, kind: int, points: Floats) -> list[float | None]:
    """The speed limit at points as the filter computes it; None without one."""
    type, base, multiplier = filter_info(file, "speed")
    assert type == kind
    return [None if value == 0 else value * multiplier + base for value in load_raw(file).at(points).astype(float)]


def middle(survey: groundplan.Survey, name: str) -> Floats:
    """Points on a corridor's axis that lie in no junction and no other corridor."""
    corridors = [label for label in survey.of_kind("corridor") if label["name"] != name]
    others = shapely.union_all([shapely.Polygon(k["polygon"]) for k in [*corridors, *survey.of_kind("junction")]])
    axis = next(label["axis"] for label in survey.of_kind("corridor") if label["name"] == name)
    points = along(axis, 60)
    alone: Floats = points[~shapely.contains_xy(others.buffer(0.1), *points.T)]
    return alone


def test_speeds_come_back_in_metres_a_second(tmp_path: Path) -> None:
    survey = demo()
    file = once(survey, "speed", tmp_path, rules=RULES)
    for name, speed in (("A01", 1.25), ("A03", 1.25), ("C01", 0.9)):
        found = limits(file, 2, middle(survey, name))
        assert found and all(value is not None and speed - 0.02 < value <= speed + 1e-9 for value in found)
    # Junctions lie above their corridors; their numbers run from the lower left.
    places = np.array([label["at"] for label in survey.of_kind("junction")])
    found = limits(file, 2, places)
    assert sum(value == pytest.approx(0.32) for value in found) == 9 and len(found) == 15


def test_speeds_come_back_in_percent_of_the_vehicle_s(tmp_path: Path) -> None:
    file = once(demo(), "speed", tmp_path, rules=RULES, max_speed=2.0)
    assert limits(file, 1, middle(demo(), "A01"))[0] == 62.0
    assert limits(file, 1, middle(demo(), "C06"))[0] == 45.0
    slow = once(demo(), "speed", tmp_path, rules=[{"speed": 0.001}], max_speed=2.0)
    assert limits(slow, 1, middle(demo(), "A01"))[0] == 1.0  # and not 0, which is none
    fast = once(demo(), "speed", tmp_path, rules=[{"speed": 9.0}], max_speed=2.0)
    assert limits(fast, 1, middle(demo(), "A01"))[0] == 100.0


@pytest.mark.parametrize("which", GOOD)
def test_without_rules_junctions_have_half_the_speed_and_the_rest_no_limit(which: str, tmp_path: Path) -> None:
    survey = GOOD[which]()
    file = once(survey, "speed", tmp_path)
    grid, (type, base, multiplier) = load_raw(file), filter_info(file, "speed")
    assert (type, base, multiplier) == (1, 0.0, 1.0)
    x, y = grid.centres()
    shapes = [shapely.Polygon(label["polygon"]) for label in survey.of_kind("junction") if label["type"] != "end"]
    expected = shapely.contains_xy(shapely.union_all(shapes), x, y)
    assert (grid.data[expected] == 50).mean() > 0.99 and (grid.data[~expected] == 0).mean() > 0.999


def test_of_two_ways_that_cross_the_slower_counts(tmp_path: Path) -> None:
    survey = demo()
    cross = next(label for label in survey.of_kind("junction") if label["type"] == "X")
    for rules in (RULES[:2], RULES[1::-1]):
        file = once(survey, "speed", tmp_path, rules=rules)
        assert limits(file, 2, np.array([cross["at"]])) == [pytest.approx(0.9)]


def test_rules_without_a_speed_limit_nothing(tmp_path: Path) -> None:
    assert load_raw(once(demo(), "speed", tmp_path, rules=[{"name": "A01", "way": "forward"}])).data.max() == 0


@pytest.mark.parametrize(
    ("options", "code"),
    [({"max_speed": -1.0}, "export.max_speed"), ({"rules": [{"name": "A01", "speed": -2}]}, "rules.value")],
)
def test_what_is_no_speed_is_refused(options: dict[str, object], code: str, tmp_path: Path) -> None:
    with pytest.raises(ParameterError) as told:
        demo().export(tmp_path / "x", "speed", **options)
    assert told.value.code == code and not list(tmp_path.iterdir())
