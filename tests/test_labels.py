"""What is what: the labels of maps that a person can read at a glance."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import zoo

import groundplan
from groundplan import evaluate, simulate


def kinds(survey: groundplan.Survey) -> Counter[str]:
    """How many of each: corridors, racks, and junctions by type."""
    return Counter(
        str(label.get("type", label["kind"])) for label in survey.labels if label["kind"] not in ("region", "door")
    )


EXPECTED: dict[str, dict[str, int]] = {
    "empty": {},
    "single_room": {},
    "noise": {},
    "pillars": {},
    "l_corridor": {"corridor": 2, "L": 1, "end": 2},
    "crossing": {"corridor": 2, "X": 1, "end": 4},
    "comb_of_racks": {"corridor": 5, "end": 10, "rack": 4},
    "skewed": {},
}


@pytest.mark.parametrize("name", EXPECTED)
def test_a_map_has_the_labels_that_a_person_sees(name: str) -> None:
    assert kinds(zoo.surveyed(name)) == EXPECTED[name]


def test_two_corridors_cross_where_their_middles_do() -> None:
    survey = zoo.surveyed("crossing")
    (crossing,) = [label for label in survey.of_kind("junction") if label["type"] == "X"]
    assert np.allclose(crossing["at"], [4.0, 4.0], atol=0.1)
    assert sorted(crossing["corridors"]) == [0, 1]
    assert all(abs(corridor["width"] - 1.85) < 0.1 for corridor in survey.of_kind("corridor"))


def test_the_stages_give_the_labels_of_the_survey() -> None:
    map = groundplan.from_array(zoo.ZOO["comb_of_racks"](), zoo.RESOLUTION)
    survey = groundplan.survey(map)
    found = groundplan.find_labels(map, survey.directions, survey.lines, survey.occupancy, survey.walls)
    assert found == survey.labels


def hall(wall: int) -> npt.NDArray[np.uint8]:
    """A corridor of 36 m by 3 m, closed in the middle by a wall so many pixels thick."""
    picture = np.full((100, 760), 205, np.uint8)
    picture[20:82, 20:740] = 0
    picture[21:81, 21:739] = 254
    picture[21:81, 380 : 380 + wall] = 0
    return picture


@pytest.mark.parametrize("wall", [1, 2, 6])
def test_no_corridor_runs_through_a_closed_wall(wall: int) -> None:
    corridors = groundplan.survey(hall(wall), resolution=0.05).of_kind("corridor")
    assert len(corridors) == 2
    ends = sorted(tuple(sorted(point[0] for point in corridor["axis"])) for corridor in corridors)
    assert ends[0][1] == pytest.approx(19.0, abs=0.3) and ends[1][0] == pytest.approx(19.0, abs=0.6)


def corridor_and_room(opening: int) -> npt.NDArray[np.uint8]:
    """A corridor of 30 m by 2.2 m and beside its middle a space of 3 m by 7 m that opens to it over so many pixels."""
    picture = np.full((240, 640), 205, np.uint8)
    picture[18:66, 18:622] = 0
    picture[66:212, 286:350] = 0
    picture[20:64, 20:620] = 254
    picture[66:210, 288:348] = 254
    picture[64:66, 318 - opening // 2 : 318 + opening // 2] = 254
    return picture


@pytest.mark.parametrize(("opening", "corridors"), [(18, 1), (60, 2)])
def test_a_space_behind_a_door_is_a_room_and_not_a_corridor(opening: int, corridors: int) -> None:
    survey = groundplan.survey(corridor_and_room(opening), resolution=0.05)
    assert len(survey.of_kind("corridor")) == corridors
    assert [label["type"] for label in survey.of_kind("junction") if label["type"] != "end"] == ["T"] * (corridors - 1)


def between_goods(apart: int) -> npt.NDArray[np.uint8]:
    """A way of 30 m by 3 m that bends by 0.3 m, between goods that stand back from it by up to so many pixels."""
    draws = np.random.default_rng(3)
    picture = np.full((180, 640), 205, np.uint8)
    for x in range(20, 620, 12):
        bend = round(6 * np.sin(x / 70))
        low, high = (60 + bend - int(draws.integers(0, apart + 1)), 120 + bend + int(draws.integers(0, apart + 1)))
        picture[low:high, x : x + 12] = 254
        picture[low, x : x + 12] = picture[high, x : x + 12] = 0
    return picture


def test_a_bent_way_between_goods_at_every_depth_is_seen_over_most_of_its_length() -> None:
    corridors = groundplan.survey(between_goods(24), resolution=0.05).of_kind("corridor")
    assert sum(np.hypot(*np.subtract(*corridor["axis"])) for corridor in corridors) >= 24.0


@pytest.mark.parametrize("method", ["strips", "paper"])
def test_the_paper_and_its_successor_on_a_crossing(method: str) -> None:
    survey = groundplan.survey(zoo.ZOO["crossing"](), resolution=zoo.RESOLUTION, labels_method=method)
    assert [label["type"] for label in survey.of_kind("junction") if label["type"] != "end"] == ["X"]


@pytest.mark.parametrize(
    "options",
    [
        {"seed": 1, "yaw": 20.0},
        {"seed": 2, "yaw": -35.0, "skew": 8.0, "sparse": 0.3},
        {"seed": 12, "yaw": 20.0, "bay": 3.6, "cross_aisle": 4.68},
    ],
)
def test_junctions_and_aisles_of_a_simulated_warehouse(options: dict[str, Any], tmp_path: Path) -> None:
    pytest.importorskip("shapely", reason="scores need shapely and scipy")
    made = simulate.warehouse(**options)
    scores = evaluate.score(groundplan.survey(made.map).to_dict(), made.truth)
    assert scores["direction_error_deg"] <= 0.15 and scores["direction_extra"] == 0
    assert scores["line_recall"] >= 0.97
    assert scores["junction_typed_f1"] >= 0.9
    assert scores["corridor_recall"] >= 0.9 and scores["corridor_precision"] >= 0.95


def test_jones_farms_has_the_directions_that_were_measured(shared: Path) -> None:
    survey = groundplan.survey(groundplan.read(shared / "maps" / "radish_intel_jones_farms.yaml"))
    assert np.degrees(survey.directions.angles) == pytest.approx([-52.12, 37.83], abs=0.15)
    assert {label["type"] for label in survey.of_kind("junction")} >= {"T", "X"}


@pytest.mark.parametrize("seed", [11, 12])
def test_names_hold_when_the_map_is_made_again(seed: int) -> None:
    options: dict[str, Any] = {"seed": seed, "width": 32.0, "depth": 24.0, "yaw": 7.0}
    before = groundplan.survey(simulate.warehouse(**options).map)
    again = groundplan.survey(simulate.warehouse(**(options | {"yaw": 7.5, "noise": 0.02})).map)
    places = [{c["name"]: np.mean(c["axis"], axis=0) for c in survey.of_kind("corridor")} for survey in (before, again)]
    kept = [name for name, at in places[0].items() if name in places[1] and np.hypot(*(at - places[1][name])) < 1.0]
    assert len(kept) >= 0.95 * len(places[0])


@pytest.mark.parametrize("name", ["cluttered", "near-diagonal", "staggered", "goods-on-the-floor"])
def test_ways_across_rows_are_told_from_bays_that_goods_close(name: str) -> None:
    options = next(case.options for case in evaluate.suite("warehouses") if case.name == name)
    made = simulate.warehouse(**options)
    scores = evaluate.score(groundplan.survey(made.map, threads=1).to_dict(), made.truth)
    assert scores["junction_typed_f1"] >= 0.93 and scores["corridor_precision"] >= 0.95
