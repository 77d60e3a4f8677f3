"""Ways of which little was seen, on maps that no simulator made up."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from _legs import Box, legs
from _legs import hall as drawn
from zoo import UNKNOWN, Picture, walled

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
        left = 20 + CROSS + n * (BLOCK + CROSS)
        for corner in (left + 18, left + BLOCK - 22):
            picture[back + 14 : back + AISLE, corner : corner + 4] = 0
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    assert len([way for way in survey.of_kind("corridor") if way["width"] < 3.3]) == 2


def mouths(seen: int, closed: bool = False) -> Picture:
    """Four rows of 15 m between two ways of 3.6 m, of whose five aisles the second and the fourth were seen for so many
    pixels from either way, or are closed there."""
    length = 300
    picture = walled(length + 2 * CROSS, 5 * AISLE + 4 * DEPTH)
    left = 20 + CROSS
    for row in range(4):
        low = 20 + AISLE + row * (AISLE + DEPTH)
        picture[low : low + DEPTH, left : left + length] = 0
    for aisle in (1, 3):
        low = 20 + aisle * (AISLE + DEPTH)
        if closed:
            picture[low : low + AISLE, left + seen - 4 : left + length - seen + 4] = 0
        # Of the rows beside it no more was seen from there either.
        picture[low - DEPTH + 3 : low + AISLE + DEPTH - 3, left + seen : left + length - seen] = 205
        for face in (low - DEPTH, low + AISLE + DEPTH - 3):
            picture[face : face + 3, left : left + length] = 0
    return picture


@pytest.mark.parametrize("turns", range(4))
@pytest.mark.parametrize("seen", [44, 56, 70])
def test_an_aisle_that_was_seen_as_far_as_a_sensor_reaches_opens_into_the_way_past_it(seen: int, turns: int) -> None:
    picture = np.ascontiguousarray(np.rot90(mouths(seen), turns))
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    assert sorted(junction["type"] for junction in survey.of_kind("junction")) == ["L"] * 4 + ["T"] * 6


@pytest.mark.parametrize("seen", [44, 56, 70])
def test_what_something_closes_that_far_from_a_way_is_a_niche(seen: int) -> None:
    survey = groundplan.survey(mouths(seen, closed=True), resolution=RESOLUTION)
    assert sorted(junction["type"] for junction in survey.of_kind("junction")) == ["L"] * 4 + ["T"] * 2


def test_where_next_to_nothing_was_seen_between_two_rows_no_way_is_known() -> None:
    survey = groundplan.survey(mouths(16), resolution=RESOLUTION)
    assert sorted(junction["type"] for junction in survey.of_kind("junction")) == ["L"] * 4 + ["T"] * 2


def beyond_rows(seen: int) -> Picture:
    """Four rows in two blocks, of whose five aisles the second and the third were seen at their ends alone.

    Through the way across the rows so many pixels were seen of them, a little wider than that is.
    """
    picture = walled(3 * CROSS + 2 * BLOCK, 5 * AISLE + 4 * DEPTH)
    lefts = [20 + CROSS, 20 + 2 * CROSS + BLOCK]
    first, second, third, fourth = (20 + AISLE + row * (AISLE + DEPTH) for row in range(4))
    for left in lefts:
        for low in (first, second, third, fourth):
            picture[low : low + DEPTH, left : left + BLOCK] = 0
    picture[first + DEPTH : third, lefts[0] + 20 : lefts[1] + BLOCK - 20] = 205
    for left in lefts:
        for low, high in ((first + 3, first + DEPTH), (second + 3, second + DEPTH - 3), (third, third + DEPTH - 3)):
            picture[low:high, left + 3 : left + BLOCK - 3] = 205
    across = slice(lefts[1] - CROSS - 14, lefts[1] + 14)
    picture[first + DEPTH : first + DEPTH + seen, across] = 254
    picture[third - seen : third, across] = 254
    return picture


@pytest.mark.parametrize("turns", range(4))
@pytest.mark.parametrize("seen", [18, 24, 30])
def test_a_way_across_rows_leads_on_through_the_row_in_line_with_it_as_far_as_was_seen(seen: int, turns: int) -> None:
    survey = groundplan.survey(np.ascontiguousarray(np.rot90(beyond_rows(seen), turns)), resolution=RESOLUTION)
    types = [junction["type"] for junction in survey.of_kind("junction")]
    # In the first aisle it is a place to turn off, and in the fourth one it leads on.
    assert sorted(types) == ["L"] * 4 + ["T"] * 4 + ["X"]


@pytest.mark.parametrize("wall", [4, 8, 12])
def test_a_gate_to_the_yard_in_line_with_a_way_across_rows_is_none(wall: int) -> None:
    # Of the yard a cone was seen through it.
    picture = np.pad(walled(3 * CROSS + 2 * BLOCK, 3 * AISLE + 2 * DEPTH), ((0, 120), (0, 0)), constant_values=205)
    lefts = [20 + CROSS, 20 + 2 * CROSS + BLOCK]
    for left in lefts:
        for low in (20 + AISLE, 20 + 2 * AISLE + DEPTH):
            picture[low : low + DEPTH, left : left + BLOCK] = 0
    bottom = 20 + 3 * AISLE + 2 * DEPTH
    picture[bottom : bottom + wall, 18:-18] = 0
    middle = lefts[1] - CROSS // 2
    for y in range(bottom, bottom + 80):
        reach = CROSS // 2 + max(0, y - bottom - wall) // 2
        picture[y, middle - reach : middle + reach] = 254
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    assert sorted(junction["type"] for junction in survey.of_kind("junction")) == ["L"] * 4 + ["T"] * 4 + ["X"]


def test_a_way_does_not_lead_on_through_a_row_behind_one_that_is_shut() -> None:
    # Across the first row a way leads, the next one is full, and behind a gap in line in the last one nothing was seen.
    picture = walled(3 * CROSS + 2 * BLOCK, 4 * AISLE + 3 * DEPTH)
    lefts = [20 + CROSS, 20 + 2 * CROSS + BLOCK]
    lows = [20 + AISLE + n * (AISLE + DEPTH) for n in range(3)]
    for low in lows:
        for left in lefts:
            picture[low : low + DEPTH, left : left + BLOCK] = 0
    picture[lows[1] : lows[1] + DEPTH, lefts[0] : lefts[1] + BLOCK] = 0
    back = lows[2] + DEPTH
    picture[back:, lefts[0] + 44 : lefts[1] + BLOCK - 44] = 205
    for left in lefts:
        picture[lows[2] + 3 : back, left + 3 : left + BLOCK - 3] = 205
    picture[back : back + 24, lefts[1] - CROSS - 14 : lefts[1] + 14] = 254
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    middle = (lefts[1] - CROSS / 2) * RESOLUTION
    across = [way for way in survey.of_kind("corridor") if abs(np.mean(way["axis"], axis=0)[0] - middle) < 0.5]
    assert len([way for way in across if way["width"] > 3.3]) == 1


@pytest.mark.parametrize(("hidden", "door"), [(12, False), (20, False), (0, True)])
def test_an_aisle_ends_at_a_wall_of_which_the_middle_was_not_seen_and_not_at_a_door_in_it(
    hidden: int, door: bool
) -> None:
    # 3.4 m wide, from a way across to a wall; before the wall's middle so much was not seen, or floor leads through.
    picture = np.full((380, 520), UNKNOWN, np.uint8)
    for top, left, bottom, right in ((20, 20, 84, 500), (82, 224, 344, 296)):
        picture[top:bottom, left:right] = 0
    picture[22:82, 22:498] = picture[80:342, 226:294] = 254
    picture[342 - hidden : 346, 240:280] = 254 if door else 205
    picture[346:, :] = UNKNOWN
    found = groundplan.survey(picture, resolution=RESOLUTION)
    ends = [junction["at"] for junction in found.of_kind("junction") if junction["type"] == "end"]
    low = [y for x, y in ends if abs(x - 13.0) < 1]
    assert low == ([] if door else [pytest.approx(1.9, abs=0.15)])


def with_patches(seed: int, rows: tuple[int, ...], wide: float) -> Picture:
    """Three rows of racks in two blocks; in the way between these so much was not seen as deep as some of the rows."""
    draws = np.random.default_rng(seed)

    def boxes() -> Iterator[Box]:
        for low in (2.6, 6.7, 10.8):
            for left in (4.0, 26.4):
                yield from legs(left, low, 8, 1.4, 2.4)
                for bay in np.flatnonzero(draws.random(8) < 0.7):
                    yield left + 0.15 + 2.4 * bay, low + 0.05, left + 2.35 + 2.4 * bay, low + 1.35

    width, height = 49.7, 13.8
    picture = drawn(width, height, boxes())[::-1].copy()

    def pixel(place: float, length: float) -> int:
        return int((place - length / 2) / RESOLUTION + len(picture) / 2)

    for low in (2.4 + 4.1 * row for row in rows):
        columns = slice(pixel(24.85 - wide / 2, width), pixel(24.85 + wide / 2, width))
        picture[pixel(low, height) : pixel(low + 1.8, height), columns] = UNKNOWN
    return np.ascontiguousarray(picture[::-1])


@pytest.mark.parametrize("wide", [0.4, 0.9])
@pytest.mark.parametrize(("seed", "rows"), [(1, (1,)), (0, (0, 1, 2)), (2, (0, 1, 2))])
def test_a_patch_that_nobody_saw_between_rays_closes_no_way(seed: int, rows: tuple[int, ...], wide: float) -> None:
    survey = groundplan.survey(with_patches(seed, rows, wide), resolution=RESOLUTION)
    types = sorted(junction["type"] for junction in survey.of_kind("junction"))
    assert types == ["L"] * 4 + ["T"] * 6 + ["X"] * 2


@pytest.mark.parametrize(
    ("gap", "has_frame", "corridors"), [(4, False, 1), (8, False, 1), (8, True, 2), (18, False, 2)]
)
def test_a_corridor_goes_on_over_a_strip_that_nobody_saw_and_not_through_a_frame(
    gap: int, has_frame: bool, corridors: int
) -> None:
    picture = walled(700, 44)
    picture[20:64, 360 : 360 + gap] = UNKNOWN
    if has_frame:
        picture[20:23, 357 : 363 + gap] = picture[61:64, 357 : 363 + gap] = 0
    assert len(groundplan.survey(picture, resolution=RESOLUTION).of_kind("corridor")) == corridors
