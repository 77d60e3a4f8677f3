"""Ways of which little was seen, on maps that no simulator made up."""

from __future__ import annotations

import numpy as np
import pytest
from zoo import Picture, walled

import groundplan

RESOLUTION = 0.05
AISLE, DEPTH, CROSS, BLOCK = 60, 30, 72, 180  # pixels: aisles of 3 m, rows of 1.5 m by 9 m, ways of 3.6 m across them


def hall(blocks: int, slope: float) -> Picture:
    """Two rows in so many blocks, whose last aisle was seen from the ways across them only.

    In that aisle so much more is seen on both sides of such a way for each metre beyond the rows' corners.
    """
    width = blocks * BLOCK + (blocks + 1) * CROSS
    depth = 3 * AISLE + 2 * DEPTH
    picture = walled(width, depth)
    lefts = [20 + CROSS + n * (BLOCK + CROSS) for n in range(blocks)]
    back = 20 + 2 * AISLE + 2 * DEPTH
    for left in lefts:
        for row in range(2):
            low = 20 + AISLE + row * (AISLE + DEPTH)
            picture[low : low + DEPTH, left : left + BLOCK] = 0
        # Of the last row its back was not seen, and of the aisle there what lies round the corners.
        picture[back - DEPTH + 3 : back, left + 3 : left + BLOCK - 3] = 205
        for y in range(back, depth + 22):
            seen = round(slope * (y - back))
            picture[y, left + seen : max(left + BLOCK - seen, left + seen)] = 205
    return picture


@pytest.mark.parametrize("turns", range(4))
@pytest.mark.parametrize(("blocks", "slope"), [(1, 1.0), (2, 0.6), (2, 1.4), (3, 1.0)])
def test_an_aisle_behind_the_last_row_is_known_by_the_corners_of_its_racks(
    blocks: int, slope: float, turns: int
) -> None:
    picture = np.ascontiguousarray(np.rot90(hall(blocks, slope), turns))
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    widths = sorted(way["width"] for way in survey.of_kind("corridor"))
    assert widths == pytest.approx([3.0] * 3 + [3.6] * (blocks + 1), abs=0.15)
    expected = ["L"] * 4 + ["T"] * 2 * blocks + ["X"] * (blocks - 1)
    assert sorted(junction["type"] for junction in survey.of_kind("junction")) == expected


@pytest.mark.parametrize("blocks", [1, 2, 3])
def test_where_nothing_was_seen_behind_the_last_row_there_is_no_way(blocks: int) -> None:
    survey = groundplan.survey(hall(blocks, slope=0.02), resolution=RESOLUTION)
    assert len([way for way in survey.of_kind("corridor") if way["width"] < 3.3]) == 2


@pytest.mark.parametrize("blocks", [1, 2, 3])
def test_where_something_stands_behind_the_last_row_there_is_no_way(blocks: int) -> None:
    picture = hall(blocks, slope=1.0)
    back = 20 + 2 * AISLE + 2 * DEPTH
    for n in range(blocks):
        middle = 20 + CROSS + n * (BLOCK + CROSS) + BLOCK // 2
        picture[back + 20 : back + AISLE, middle - 30 : middle - 26] = 0
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    assert len([way for way in survey.of_kind("corridor") if way["width"] < 3.3]) == 2
