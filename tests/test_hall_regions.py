"""Halls are regions of their own: gates in walls and passages part them, rows of racks do not."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from test_joined_halls import Box, rows, site

import groundplan
from groundplan import Survey
from groundplan.evaluate import score
from groundplan.simulate import warehouse

RESOLUTION = 0.05
SMALL: dict[str, Any] = {"width": 34.0, "depth": 24.0, "scan_every": 0.6, "beams": 400}


def areas(survey: Survey) -> list[float]:
    return sorted(region["area"] for region in survey.of_kind("region"))


def surveyed(picture: npt.NDArray[np.uint8], **parameters: Any) -> Survey:
    return groundplan.survey(picture, resolution=RESOLUTION, **parameters)


def two_halls(gate: tuple[float, float], apart: float = 0.3) -> npt.NDArray[np.uint8]:
    """Halls of 30 x 17 m and 20 x 17 m with four rows of racks each, and a way from the one to the other."""
    right = 30 + apart
    floors: list[Box] = [(0, 0, 30, 17), (right, 0, right + 20, 17), (29, gate[0], right + 1, gate[1])]
    racks = rows([3, 8, 13], [(4, 26)], 1.5) + rows([3, 8, 13], [(right + 4, right + 16)], 1.5)
    return site(floors, racks)


@pytest.mark.parametrize("width", [2.0, 3.2, 5.0])
def test_a_gate_in_the_wall_between_two_halls_is_a_door_that_joins_them(width: float) -> None:
    survey = surveyed(two_halls((6.2 - width / 2, 6.2 + width / 2)))
    assert len(areas(survey)) == 2
    (door,) = survey.of_kind("door")
    assert door["width"] == pytest.approx(width, abs=0.15)
    assert door["at"][0] == pytest.approx(31.1, abs=0.4)


def test_a_passage_between_two_halls_is_a_region_with_a_door_at_each_end() -> None:
    survey = surveyed(two_halls((4.8, 7.6), apart=8.0))
    passage, *halls = areas(survey)
    assert passage == pytest.approx(8.0 * 2.8, rel=0.15) and len(halls) == 2
    assert [door["width"] for door in survey.of_kind("door")] == pytest.approx([2.8, 2.8], abs=0.15)
    assert sorted(region["use"] for region in survey.of_kind("region")) == ["corridor", "hall", "hall"]


def test_a_passage_shorter_than_wide_parts_two_halls_all_the_same() -> None:
    assert len(areas(surveyed(two_halls((4.6, 7.8), apart=1.6)))) == 2


@pytest.mark.parametrize(
    "pieces",
    [[(0, 13), (16, 30)], [(4, 13), (16, 26)], [(0, 1.2), (4.2, 30)], [(0, 2.2), (5, 30)]],
    ids=["from wall to wall", "free", "a short piece at the wall", "a bay at the wall"],
)
def test_ways_through_rows_are_no_gates(pieces: list[tuple[float, float]]) -> None:
    survey = surveyed(site([(0, 0, 30, 17)], rows([3, 8, 13], pieces, 1.5)))
    assert len(areas(survey)) == 1 and not survey.of_kind("door")


def test_aisles_that_end_at_a_wall_are_of_their_hall() -> None:
    assert len(areas(surveyed(site([(0, 0, 30, 17)], rows([3, 8, 13], [(4, 30)], 1.5))))) == 1


def test_halls_keep_apart_when_the_wall_is_seen_through_noise() -> None:
    picture = two_halls((4.6, 7.6))
    noise = np.random.default_rng(3)
    edge = picture == 0
    # A fifth of the walls' pixels was not hit, and some of what is next to them was.
    picture[edge & (noise.random(picture.shape) < 0.2)] = 205
    beside = np.roll(edge, 1, axis=0) & ~edge & (noise.random(picture.shape) < 0.2)
    picture[beside] = 0
    assert len([area for area in areas(surveyed(picture)) if area > 100]) == 2


@pytest.mark.parametrize(
    "options",
    [
        {"halls": 2, "gap": 0.5},
        {"halls": 3, "gap": 0.5, "yaw": 20.0},
        {"halls": 2, "gap": 4.0, "crosswise": True, "yaw": -12.0},
        {"wing": 30.0, "gap": 3.0},
    ],
    ids=["gate", "three", "passage", "wing"],
)
def test_each_hall_of_a_simulated_site_is_a_region(options: dict[str, Any]) -> None:
    made = warehouse(seed=300, **SMALL, **options)
    scores = score(groundplan.survey(made.map).to_dict(), made.truth)
    assert (scores["hall_recall"], scores["hall_precision"]) == (1.0, 1.0)


def test_a_hall_of_which_little_was_seen_is_not_asked_for() -> None:
    made = warehouse(seed=300, **SMALL)
    survey = groundplan.survey(made.map).to_dict()
    (hall,) = made.truth["halls"]
    assert hall["observed"]
    unseen = {**made.truth, "halls": [{**hall, "observed": False}]}
    assert [score(survey, truth)["hall_recall"] for truth in (made.truth, unseen)] == [1.0, None]
    nothing = {**survey, "labels": []}
    assert (score(nothing, made.truth)["hall_recall"], score(nothing, made.truth)["hall_precision"]) == (0.0, None)
