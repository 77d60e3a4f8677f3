"""Halls whose ways across rows run askew to these are labelled as they would be if they were square to them."""

from __future__ import annotations

import numpy as np
import pytest
from zoo import UNKNOWN, Picture, sheared, walled

import groundplan

RESOLUTION = 0.05
AISLE, DEPTH, CROSS, LENGTH = 60, 30, 72, 420  # pixels: aisles of 3 m, rows of 1.5 m by 21 m, ways of 3.6 m across them
SKEWS = [-15, -8, 0, 8, 15]  # degrees


def hall(rows: int) -> Picture:
    """Rows of boxes from one way across to the other."""
    picture = walled(LENGTH + 2 * CROSS, rows * DEPTH + (rows + 1) * AISLE)
    for row in range(rows):
        low = 20 + AISLE + row * (AISLE + DEPTH)
        picture[low : low + DEPTH, 20 + CROSS : 20 + CROSS + LENGTH] = 0
        picture[low + 3 : low + DEPTH - 3, 20 + CROSS + 3 : 17 + CROSS + LENGTH] = UNKNOWN
    return picture


def types(picture: Picture) -> list[str]:
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    return sorted(junction["type"] for junction in survey.of_kind("junction"))


@pytest.mark.parametrize("skew", SKEWS)
def test_a_hall_has_its_junctions_and_racks_at_any_skew(skew: float) -> None:
    survey = groundplan.survey(sheared(hall(3), skew), resolution=RESOLUTION)
    assert sorted(junction["type"] for junction in survey.of_kind("junction")) == ["L"] * 4 + ["T"] * 4
    assert len(survey.of_kind("rack")) == 3


@pytest.mark.parametrize("skew", SKEWS)
def test_an_aisle_of_which_3_m_were_seen_opens_into_both_ways(skew: float) -> None:
    picture, seen = hall(3), 60
    picture[20 + AISLE + DEPTH : 20 + 2 * AISLE + DEPTH, 20 + CROSS + seen : 20 + CROSS + LENGTH - seen] = UNKNOWN
    assert types(sheared(picture, skew)) == ["L"] * 4 + ["T"] * 4


@pytest.mark.parametrize("skew", SKEWS)
def test_corridors_across_the_rows_end_along_these(skew: float) -> None:
    survey = groundplan.survey(sheared(hall(3), skew), resolution=RESOLUTION)
    lengths = [np.hypot(*np.diff(way["axis"], axis=0)[0]) for way in survey.of_kind("corridor")]
    across = 3 * (DEPTH + AISLE) * RESOLUTION / np.cos(np.radians(skew))
    assert sorted(lengths)[:2] == pytest.approx([across, across], abs=0.2)
