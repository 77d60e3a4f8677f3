"""Pillars and pitches, as statements about maps."""

from __future__ import annotations

import dataclasses
import json
import math
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from zoo import walled

import groundplan
from groundplan import Survey, simulate
from groundplan.evaluate import score
from groundplan.simulate import Simulated

SHARED = Path(__file__).parents[2] / "shared" / "maps"
WIDE: dict[str, Any] = {"seed": 2, "pillars": 5.0, "aisle": 6.0, "cross_aisle": 6.0, "yaw": 20.0}


@cache
def wide(**changes: Any) -> tuple[Simulated, Survey]:
    made = simulate.warehouse(**(WIDE | changes))
    return made, groundplan.survey(made.map)


def test_the_truth_marks_the_pillars_that_goods_hide() -> None:
    pillars = wide()[0].truth["pillars"]
    assert 0 < sum(pillar["observed"] for pillar in pillars) < len(pillars)


def test_pillars_that_stand_free_in_a_grid_are_found_and_nothing_else() -> None:
    made, survey = wide()
    assert score(survey.to_dict(), made.truth)["pillar_f1"] == 1.0
    (pattern,) = [pattern for pattern in survey.patterns if pattern["kind"] == "pillars"]
    assert [survey.labels[n]["kind"] for n in pattern["labels"]] == ["pillar"] * len(survey.of_kind("pillar"))
    for label in survey.of_kind("pillar"):
        assert label["name"].startswith("P") and 0.3 < label["width"] < 0.7
        assert survey.patterns[label["pattern"]] is pattern


def test_a_pattern_says_where_its_pillars_stand() -> None:
    _, survey = wide()
    (pattern,) = [pattern for pattern in survey.patterns if pattern["kind"] == "pillars"]
    c, s = math.cos(pattern["angle"]), math.sin(pattern["angle"])
    for label in survey.of_kind("pillar"):
        x, y = label["at"]
        places = (x * c + y * s, y * c - x * s)
        for place, pitch, phase in zip(places, pattern["pitch"], pattern["phase"], strict=True):
            assert abs((place - phase + pitch / 2) % pitch - pitch / 2) < 0.2


@pytest.mark.parametrize("changes", [{"pillars": 0.0}, {"pillars": 0.0, "clutter": 3.0}])
def test_what_was_left_on_the_floor_is_no_pillar(changes: dict[str, Any]) -> None:
    assert wide(**changes)[1].of_kind("pillar") == []


def test_a_row_of_racks_has_the_pitch_of_its_posts() -> None:
    made = simulate.warehouse(seed=101)
    scores = score(groundplan.survey(made.map).to_dict(), made.truth)
    assert scores["pitch_recall"] >= 0.6
    assert scores["pitch_error_m"] <= 0.05


@pytest.mark.parametrize("seed", range(4))
def test_the_pitch_of_racks_is_a_bay_and_not_a_pallet(seed: int) -> None:
    # Five single racks of twelve bays of 3.5 m, a third empty; three pallets as far apart in the others.
    draws = np.random.default_rng(seed)
    bay, count = 70, 12
    picture = walled(990, 430)
    for low in range(80, 400, 74):
        row = picture[low : low + 18, 100 : 100 + count * bay]
        for start in range(0, count * bay, bay):
            for post in (start, start + bay - 2):
                row[[0, 1, -2, -1], post : post + 2] = 0
            for at in (4, 26, 48) if draws.random() < 0.65 else ():
                row[1:-1, start + at : start + at + 18] = 0
    racks = groundplan.survey(picture, resolution=0.05).of_kind("rack")
    assert [rack["pitch"] for rack in racks] == pytest.approx([3.5] * 5, abs=0.1)
    # Posts stand where each rack begins.
    assert all(min(rack["phase"], rack["pitch"] - rack["phase"]) < 0.4 for rack in racks)


@pytest.mark.parametrize("shelf", [20, 24, 28])
def test_the_pitch_of_shelves_is_one_shelf_though_it_is_no_longer_than_a_pallet(shelf: int) -> None:
    # Three rows of 13 shelves of 1 to 1.4 m, one in five of them empty.
    draws = np.random.default_rng(0)
    depth, gap, count = 12, 60, 13
    picture = walled(count * shelf + 2 * gap, 3 * depth + 4 * gap)
    for low in range(20 + gap, 20 + 3 * (depth + gap), depth + gap):
        row = picture[low : low + depth, 20 + gap :]
        for post in range(0, (count + 1) * shelf, shelf):
            row[[0, 1, -2, -1], post : post + 2] = 0
        for start in range(0, count * shelf, shelf):
            if draws.random() < 0.8:
                row[1:-1, start + 3 : start + shelf - 1] = 0
    racks = groundplan.survey(picture, resolution=0.05).of_kind("rack")
    assert [rack["pitch"] for rack in racks] == pytest.approx([shelf * 0.05] * 3, abs=0.05)


def test_a_pattern_of_bays_lies_on_the_posts() -> None:
    _, survey = wide()
    bays = [pattern for pattern in survey.patterns if pattern["kind"] == "bays"]
    assert len(bays) == sum(rack["pitch"] is not None for rack in survey.of_kind("rack")) > 0
    for pattern in bays:
        (rack,) = (survey.labels[n] for n in pattern["labels"])
        (x, y), _ = rack["axis"]
        start = x * math.cos(pattern["angle"]) + y * math.sin(pattern["angle"])
        assert 0 <= rack["phase"] < rack["pitch"] == pattern["pitch"][0]
        off = (start + rack["phase"] - pattern["phase"][0]) / rack["pitch"]
        assert off == pytest.approx(round(off), abs=1e-4)


def test_racks_have_their_pitch_however_far_from_the_origin_they_stand() -> None:
    made = simulate.warehouse(seed=0, width=26, depth=18, beams=240, scan_every=0.8).map

    for x in (0.0, 2e8):
        racks = groundplan.survey(dataclasses.replace(made, origin=(x, 0.0, 0.0))).of_kind("rack")
        pitches = [rack["pitch"] for rack in racks if rack["pitch"] is not None]
        assert len(pitches) > 3
        assert pitches == pytest.approx([2.65] * len(pitches), abs=0.1)


def test_patterns_come_back_from_the_file() -> None:
    _, survey = wide()
    assert Survey.from_json(survey.to_json()).patterns == survey.patterns
    old = survey.to_dict()
    del old["patterns"]
    assert Survey.from_json(json.dumps(old)).patterns == []


def test_pillars_are_drawn(tmp_path: Path) -> None:
    from groundplan.figures import draw_survey

    made, survey = wide()
    without = dataclasses.replace(survey, labels=[label for label in survey.labels if label["kind"] != "pillar"])
    drawn = [draw_survey(s, made.map, tmp_path / f"{n}.png").read_bytes() for n, s in enumerate((survey, without))]
    assert drawn[0] != drawn[1]


@pytest.mark.parametrize(
    ("name", "count"),
    [("nav2_warehouse", 10), ("tugbot_warehouse_shelves", 8), ("rbk_warehouse_columns", 7), ("radish_intel_lab", 0)],
)
def test_pillars_of_real_halls_are_those_that_a_person_counts(name: str, count: int) -> None:
    path = SHARED / f"{name}.yaml"
    if not path.is_file():
        pytest.skip("the shared maps are not here")
    assert len(groundplan.survey(groundplan.read(path)).of_kind("pillar")) == count


def test_a_survey_of_as_many_pillars_elsewhere_scores_nothing() -> None:
    made, survey = wide()
    moved = survey.to_dict()
    moved["labels"] = [
        label | {"at": (np.array(label["at"]) + 2).tolist()} if label["kind"] == "pillar" else label
        for label in moved["labels"]
    ]
    assert score(moved, made.truth)["pillar_f1"] == 0.0
