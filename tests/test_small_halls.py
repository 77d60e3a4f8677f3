"""Halls of few or short racks, whose ways a person is sure of by what lies beside them."""

from __future__ import annotations

from collections import Counter

import numpy as np
import numpy.typing as npt
import pytest

import groundplan

RESOLUTION = 0.05


def hall(width: float, depth: float, *boxes: tuple[float, float, float, float]) -> groundplan.Survey:
    """The survey of a hall within walls, metres; in it stand boxes from (x, y) to (x, y)."""
    pixels = [round(metres / RESOLUTION) for metres in (depth, width)]
    picture: npt.NDArray[np.uint8] = np.full((pixels[0] + 40, pixels[1] + 40), 205, np.uint8)
    picture[17 : pixels[0] + 23, 17 : pixels[1] + 23] = 0
    picture[20 : pixels[0] + 20, 20 : pixels[1] + 20] = 254
    for box in boxes:
        left, low, right, high = (20 + round(metres / RESOLUTION) for metres in box)
        picture[low:high, left:right] = 0
    return groundplan.survey(picture, resolution=RESOLUTION)


def combed(between: float) -> groundplan.Survey:
    """Six bays of 3.2 m by 5.8 m off a way of 3.3 m, with so much between one and the next."""
    step = 3.2 + between
    racks = [(3.2 + n * step, 0.0, (n + 1) * step, 5.8) for n in range(5)]
    return hall(6 * 3.2 + 5 * between, 9.1, *racks)


def test_short_aisles_between_racks_off_one_way_are_aisles() -> None:
    survey = combed(2.3)
    assert Counter(junction["type"] for junction in survey.of_kind("junction")) == {"L": 2, "T": 4, "end": 6}
    assert len(survey.of_kind("corridor")) == 7


def test_what_walls_part_and_is_as_short_are_bays_of_a_room() -> None:
    assert len(combed(0.2).of_kind("corridor")) <= 1


@pytest.mark.parametrize("racks", [2, 3])
def test_ways_at_a_hall_s_ends_are_known_by_the_aisles_that_open_into_them(racks: int) -> None:
    rows = [(4.8, 4.1 + n * 5.5, 13.5, 5.5 + n * 5.5) for n in range(racks)]
    survey = hall(18.3, 4.1 + racks * 5.5, *rows)
    ways = [round(way["width"], 1) for way in survey.of_kind("corridor")]
    assert sorted(ways) == pytest.approx([4.1] * (racks + 1) + [4.8] * 2, abs=0.15)
    found = Counter(junction["type"] for junction in survey.of_kind("junction"))
    assert found == {"L": 4, "T": 2 * (racks - 1)}


@pytest.mark.parametrize("short", [None, 1])
def test_a_shelf_that_is_empty_at_the_wall_is_no_way_where_the_rows_beside_it_go_on_to_it(short: int | None) -> None:
    ends = [20.5 if row == short else 23.8 for row in range(3)]
    survey = hall(23.8, 15.8, *((3.6, 2.0 + 4.6 * row, end, 4.6 + 4.6 * row) for row, end in enumerate(ends)))
    across = [way["width"] for way in survey.of_kind("corridor") if way["name"].startswith("C")]
    assert across == pytest.approx([3.6], abs=0.15)
