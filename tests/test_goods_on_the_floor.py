"""Goods on the floor stand in aisles and in ways across rows, and end neither."""

from __future__ import annotations

import pytest
from zoo import UNKNOWN, Picture, walled

import groundplan

RESOLUTION = 0.05
AISLE, DEPTH, CROSS, BLOCK = 60, 30, 72, 200  # pixels: aisles of 3 m, rows of 1.5 m, ways of 3.6 m across them


def hall(rows: int) -> Picture:
    """Rows of boxes in two blocks, with ways across at both ends and between the blocks."""
    picture = walled(2 * BLOCK + 3 * CROSS, rows * DEPTH + (rows + 1) * AISLE)
    for row in range(rows):
        low = 20 + AISLE + row * (AISLE + DEPTH)
        for left in (20 + CROSS, 20 + 2 * CROSS + BLOCK):
            picture[low : low + DEPTH, left : left + BLOCK] = 0
            picture[low + 3 : low + DEPTH - 3, left + 3 : left + BLOCK - 3] = UNKNOWN
    return picture


def pile(picture: Picture, low: int, left: int, depth: int, length: int) -> None:
    picture[low : low + depth, left : left + length] = 0
    picture[low + 2 : low + depth - 2, left + 2 : left + length - 2] = UNKNOWN


def types(picture: Picture) -> list[str]:
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    return sorted(junction["type"] for junction in survey.of_kind("junction"))


WHOLE = ["L"] * 4 + ["T"] * 6 + ["X"] * 2


@pytest.mark.parametrize("length", [24, 40, 60])
@pytest.mark.parametrize("lane", [10, 16])
def test_an_aisle_leads_past_a_pile_before_the_way_at_its_end(lane: int, length: int) -> None:
    picture = hall(3)
    low = 20 + AISLE + DEPTH
    pile(picture, low, 20 + CROSS + 5, AISLE - lane, length)
    assert types(picture) == WHOLE


def test_an_aisle_ends_before_what_leaves_no_lane() -> None:
    picture = hall(3)
    low = 20 + AISLE + DEPTH
    pile(picture, low, 20 + CROSS + 5, AISLE, 40)
    assert types(picture) != WHOLE


@pytest.mark.parametrize("left", [2, 34])
@pytest.mark.parametrize("rows", [4, 5])
def test_a_way_through_rows_leads_through_the_next_beside_goods_between_its_racks(rows: int, left: int) -> None:
    picture = hall(rows)
    low = 20 + AISLE + (rows - 1) * (AISLE + DEPTH)
    pile(picture, low - 4, 20 + CROSS + BLOCK + left, DEPTH - 10, 34)
    assert types(picture) == ["L"] * 4 + ["T"] * (2 * rows) + ["X"] * (rows - 1)
