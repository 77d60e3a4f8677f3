"""Confidence: what the labels say of themselves, held against the truth."""

from __future__ import annotations

from typing import Any

import pytest
import zoo
from zoo import ZOO

import groundplan
from groundplan import simulate
from groundplan.evaluate import _reliability

OFFICE: dict[str, Any] = {"seed": 512, "shape": "L", "yaw": 31.0, "furniture": 0.3}


@pytest.mark.parametrize("name", sorted(ZOO))
def test_every_label_of_any_map_has_a_confidence_from_0_to_1(name: str) -> None:
    assert all(0.0 <= label["confidence"] <= 1.0 for label in zoo.surveyed(name).labels)


def test_the_surer_rooms_of_an_office_are_right_more_often() -> None:
    made = simulate.office(**OFFICE)
    judged = _reliability.judged(groundplan.survey(made.map).to_dict(), made.truth)
    right = [confidence for kind, confidence, is_right in judged if kind in ("region", "door") and is_right]
    wrong = [confidence for kind, confidence, is_right in judged if kind in ("region", "door") and not is_right]
    assert right and wrong
    assert sum(right) / len(right) > sum(wrong) / len(wrong) + 0.05


def test_a_survey_says_so_where_the_evidence_does_not_decide() -> None:
    for name in ZOO:
        survey = zoo.surveyed(name)
        unsure = sum(label["confidence"] <= 0.5 for label in survey.labels)
        told = [warning.message for warning in survey.warnings if warning.code == "unsure-labels"]
        assert len(told) == (unsure > 0)
        assert all(f" {unsure} of {len(survey.labels)} labels" in message for message in told)


def hall(aisle: float, head: float, wall: float) -> zoo.Picture:
    """A hall of six rows of a metre, with floor outside its walls; metres, and pixels of 0.05 m."""
    depth = 6.0 + 7.0 * aisle
    plan = zoo.Canvas(1000, round((depth + 2.0 * wall + 14.0) / 0.05), zoo.FREE)

    def box(x: float, y: float, right: float, top: float, value: int) -> None:
        plan.box(x / 0.05, y / 0.05, right / 0.05, top / 0.05, value)

    box(7.0 - wall, 7.0 - wall, 43.0 + wall, 7.0 + depth + wall, zoo.OCCUPIED)
    box(7.0, 7.0, 43.0, 7.0 + depth, zoo.FREE)
    for row in range(6):
        low = 7.0 + aisle + row * (1.0 + aisle)
        box(7.0 + head, low, 43.0 - head, low + 1.0, zoo.OCCUPIED)
    return plan.picture


@pytest.mark.parametrize(
    ("aisle", "head", "wall"),
    [
        (1.1, 2.0, 0.3),
        (1.5, 5.0, 0.3),
        (2.0, 3.0, 0.3),
        (3.0, 3.0, 0.05),
        (3.0, 4.0, 0.1),
        (2.5, 2.5, 0.15),
        (3.0, 3.0, 0.2),
    ],
)
def test_junctions_are_sure_in_narrow_aisles_and_before_thin_walls(aisle: float, head: float, wall: float) -> None:
    junctions = groundplan.survey(hall(aisle, head, wall), resolution=0.05).of_kind("junction")
    assert sorted(label["type"] for label in junctions) == ["L"] * 4 + ["T"] * 10
    assert min(label["confidence"] for label in junctions) > 0.9


def test_the_table_counts_each_label_in_the_bin_of_its_confidence() -> None:
    rows = _reliability.table([("door", 0.2, False), ("door", 0.25, True), ("door", 1.0, True), ("rack", 0.6, True)])
    assert [row["labels"] for row in rows["door"]] == [2, 0, 0, 0, 1]
    assert [row["right"] for row in rows["all"]] == [0.5, None, 1.0, None, 1.0]
