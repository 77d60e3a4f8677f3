"""Ways that were seen from the ways that they open into alone, on maps that no simulator made up."""

from __future__ import annotations

import numpy as np
import pytest
from zoo import UNKNOWN, Picture, walled

import groundplan

RESOLUTION = 0.05
AISLE, DEPTH, CROSS, LENGTH = 60, 30, 72, 420  # pixels: aisles of 3 m, rows of 1.5 m by 21 m, ways of 3.6 m across them


def hall(rows: int, recess: int = 0, first: int = 0) -> Picture:
    """Rows of boxes from one way across to the other, of which some end so much before the right one."""
    picture = walled(LENGTH + 2 * CROSS, rows * DEPTH + (rows + 1) * AISLE)
    for row in range(rows):
        low = 20 + AISLE + row * (AISLE + DEPTH)
        right = 20 + CROSS + LENGTH - (recess if row >= first else 0)
        picture[low : low + DEPTH, 20 + CROSS : right] = 0
        picture[low + 3 : low + DEPTH - 3, 20 + CROSS + 3 : right - 3] = UNKNOWN
    return picture


def types(picture: Picture, turns: int = 0) -> list[str]:
    survey = groundplan.survey(np.ascontiguousarray(np.rot90(picture, turns)), resolution=RESOLUTION)
    return sorted(junction["type"] for junction in survey.of_kind("junction"))


def through_cones(middle: int, sides: int) -> Picture:
    """A hall of three rows, of whose second aisle the sides were seen so far from either end, and so far the middle."""
    picture = hall(3)
    low = 20 + AISLE + DEPTH
    for y in range(AISLE):
        off = min(y, AISLE - 1 - y) / (AISLE / 2)
        seen = round(sides + (middle - sides) * off)
        picture[low + y, 20 + CROSS + seen : 20 + CROSS + LENGTH - seen] = UNKNOWN
    return picture


@pytest.mark.parametrize("turns", range(4))
@pytest.mark.parametrize("middle", [0, 8, 16])
def test_an_aisle_opens_where_its_sides_were_seen_and_its_middle_was_not(middle: int, turns: int) -> None:
    assert types(through_cones(middle, sides=60), turns) == ["L"] * 4 + ["T"] * 4


def test_where_neither_sides_nor_middle_were_seen_no_aisle_opens() -> None:
    assert types(through_cones(16, sides=16)) == ["L"] * 4 + ["T"] * 2


def led_beyond(seen: int) -> Picture:
    """Rows in three blocks; behind the last one nothing was seen but so far into the two ways between the blocks."""
    block, gate, rows = 200, 50, 3
    picture = walled(3 * block + 2 * gate + 2 * CROSS, rows * (AISLE + DEPTH) + 200)
    lefts = [20 + CROSS + n * (block + gate) for n in range(3)]
    for row in range(rows):
        low = 20 + AISLE + row * (AISLE + DEPTH)
        for left in lefts:
            picture[low : low + DEPTH, left : left + block] = 0
            picture[low + 3 : low + DEPTH - 3, left + 3 : left + block - 3] = UNKNOWN
    last = 20 + rows * AISLE + (rows - 1) * DEPTH
    picture[last + seen :] = UNKNOWN
    for left in lefts:
        picture[last + 3 :, left + 3 : left + block - 3] = UNKNOWN
    return picture


@pytest.mark.parametrize("turns", range(4))
@pytest.mark.parametrize("seen", [26, 28, 30])
def test_a_way_leads_on_from_a_junction_to_a_frontier_at_1_2_m(seen: int, turns: int) -> None:
    assert types(led_beyond(seen), turns) == ["L"] * 2 + ["T"] * 6 + ["X"] * 4


def test_a_way_of_which_less_was_seen_beyond_a_junction_ends_there() -> None:
    assert types(led_beyond(20)) == ["L"] * 4 + ["T"] * 6 + ["X"] * 2


def before_a_wall(left: int, right: int) -> Picture:
    """A hall of two rows, of whose outer aisles so much was seen from the left way across, and from the right one."""
    picture = hall(2)
    for low, outer in ((20, slice(0, 20)), (20 + 2 * (AISLE + DEPTH), slice(-20, None))):
        for y in range(AISLE):
            off = min(y, AISLE - 1 - y) / (AISLE / 2)
            end = 20 + CROSS + LENGTH - round(right * (1 - 0.8 * off))
            picture[low + y, 20 + CROSS + left : end] = UNKNOWN
        picture[outer, 20 + CROSS + left : 20 + CROSS + LENGTH - right] = UNKNOWN
        face = low + AISLE if low == 20 else low - 3
        picture[face : face + 3, 20 + CROSS + left : 20 + CROSS + LENGTH - right] = UNKNOWN
    return picture


@pytest.mark.parametrize("turns", range(4))
@pytest.mark.parametrize(("left", "right"), [(110, 64), (150, 80)])
def test_an_aisle_ends_in_a_way_before_the_wall_though_the_aisles_beside_it_were_hardly_seen(
    left: int, right: int, turns: int
) -> None:
    assert types(before_a_wall(left, right), turns) == ["L"] * 4 + ["T"] * 2


def past_short_rows(recess: int, seen: int) -> Picture:
    """A hall of five rows of which the last two end so much before others; of the aisles behind so much was seen."""
    picture = hall(5, recess, first=3)
    ends = slice(20 + CROSS + seen, 20 + CROSS + LENGTH - recess - seen)
    for aisle in (4, 5):
        low = 20 + aisle * (AISLE + DEPTH)
        picture[low - DEPTH : low + AISLE, ends] = UNKNOWN
    picture[low + AISLE :, ends] = UNKNOWN
    return picture


@pytest.mark.parametrize("turns", range(4))
@pytest.mark.parametrize("recess", [30, 40, 60])
def test_a_way_along_a_wall_leads_on_past_rows_that_end_before_others(recess: int, turns: int) -> None:
    picture = past_short_rows(recess, seen=60)
    assert types(picture, turns) == ["L"] * 4 + ["T"] * 8


@pytest.mark.parametrize("recess", [30, 60])
def test_a_way_along_a_wall_leads_over_no_row(recess: int) -> None:
    # One of the rows ends at the wall.
    picture = past_short_rows(recess, seen=60)
    low = 20 + 4 * AISLE + 3 * DEPTH
    picture[low : low + DEPTH, 20 + CROSS + LENGTH - recess : 20 + 2 * CROSS + LENGTH] = 0
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    wall = (LENGTH + 1.5 * CROSS + 20) * RESOLUTION
    along = [way for way in survey.of_kind("corridor") if abs(np.mean(way["axis"], axis=0)[0] - wall) < 1]
    beyond = (len(picture) - low - DEPTH) * RESOLUTION
    assert all(min(y for _, y in way["axis"]) > beyond or max(y for _, y in way["axis"]) < beyond for way in along)


def behind_corners(rows: int, near: int, slope: float) -> Picture:
    """A hall of rows of 30 m, of whose last aisle 2.2 m were seen from either end, and less behind a row's corners."""
    length, depth, seen, wall = 600, 25, 44, 96
    picture = walled(length + 2 * CROSS, rows * depth + (rows + 1) * AISLE)
    left, right = 20 + CROSS, 20 + CROSS + length
    for low in (20 + AISLE + row * (AISLE + depth) for row in range(rows)):
        picture[low : low + depth, left:right] = 0
        picture[low + 3 : low + depth - 3, left + 3 : right - 3] = UNKNOWN
    last = 20 + rows * (AISLE + depth)
    for y in range(AISLE):
        free = min(seen, near + round(y / slope))
        picture[last + y, left + free : right - free] = UNKNOWN
    picture[last - 3 : last, left + near : right - near] = UNKNOWN
    picture[-20:, left + wall : right - wall] = UNKNOWN
    return picture


@pytest.mark.parametrize("rows", [2, 3])
@pytest.mark.parametrize(("near", "slope"), [(10, 0.4), (12, 0.7), (12, 0.9)])
def test_an_aisle_opens_though_behind_the_corners_of_a_row_less_was_seen(near: int, slope: float, rows: int) -> None:
    assert types(behind_corners(rows, near, slope)) == ["L"] * 4 + ["T"] * 2 * (rows - 1)


def across_from_bays(bay: int) -> Picture:
    """A way with a rack of such bays along one side; of the aisles on its other side 3 m were seen, one whole."""
    rows, wall, seen = 8, 24, 60
    height = rows * DEPTH + (rows + 1) * AISLE
    picture = walled(wall + 2 * CROSS + LENGTH, height)
    for n, y in enumerate(range(20, 20 + height - bay, bay)):
        picture[y : y + 2, 20 : 20 + wall] = 0
        if n % 3 != 1:
            picture[y + 4 : y + bay - 4, 21 : 20 + wall - 1] = 0
    left = 20 + wall + CROSS
    for low in (20 + AISLE + row * (AISLE + DEPTH) for row in range(rows)):
        picture[low : low + DEPTH, left : left + LENGTH] = 0
        picture[low + 3 : low + DEPTH - 3, left + 3 : left + LENGTH - 3] = UNKNOWN
    picture[20 + AISLE + DEPTH :, left + seen :] = UNKNOWN
    return picture


@pytest.mark.parametrize("turns", range(2))
@pytest.mark.parametrize("bay", [62, 66, 70])
def test_aisles_open_into_a_way_along_the_other_side_of_which_bays_are_as_wide(bay: int, turns: int) -> None:
    assert types(across_from_bays(bay), turns).count("T") == 7
