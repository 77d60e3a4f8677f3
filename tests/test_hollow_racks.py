"""Ways through racks of which a lidar sees the faces: goods stand all along both, and nothing closes the ends."""

from __future__ import annotations

import numpy as np
import pytest
from zoo import Picture, walled

import groundplan

RESOLUTION = 0.05
# Pixels: aisles of 3 m, racks of 1 m by 25 m, ways of 3.5 m past their ends.
AISLE, DEPTH, CROSS, LENGTH = 60, 20, 70, 500


def hall(gaps: list[list[int]], width: int) -> Picture:
    """Racks of two faces and nothing between, open at some places over so many pixels."""
    picture = walled(LENGTH + 2 * CROSS, len(gaps) * DEPTH + (len(gaps) + 1) * AISLE)
    for row, places in enumerate(gaps):
        low, left = 20 + AISLE + row * (AISLE + DEPTH), 20 + CROSS
        rack = picture[low : low + DEPTH, left : left + LENGTH]
        rack[[0, 1, -2, -1]] = 0
        for place in places:
            rack[:, place : place + width] = 254
    return picture


def types(picture: Picture, turns: int = 0) -> list[str]:
    survey = groundplan.survey(np.ascontiguousarray(np.rot90(picture, turns)), resolution=RESOLUTION)
    return sorted(junction["type"] for junction in survey.of_kind("junction"))


def plain(rows: int) -> list[str]:
    return ["L"] * 4 + ["T"] * 2 * (rows - 1)


@pytest.mark.parametrize("turns", range(4))
@pytest.mark.parametrize("width", [32, 44, 60])
def test_a_gap_in_both_faces_of_one_rack_is_a_way(width: int, turns: int) -> None:
    assert types(hall([[], [230], []], width), turns) == sorted(plain(3) + ["T"] * 2)


@pytest.mark.parametrize("width", [32, 44, 60])
def test_each_rack_has_its_own_ways(width: int) -> None:
    assert types(hall([[100], [60, 300], [200], []], width)) == sorted(plain(4) + ["T"] * 8)


def test_ways_in_line_through_several_racks_are_one() -> None:
    assert types(hall([[230], [230], [230]], 32)) == sorted(plain(3) + ["T"] * 2 + ["X"] * 2)


@pytest.mark.parametrize("length", [600, 640])
def test_a_corridor_between_rooms_whose_doors_face_each_other_is_no_rack(length: int) -> None:
    corridor, wall, depth, door = 40, 3, 80, 30
    picture = walled(length, 3 * depth + 4 * corridor)
    for low in (20 + corridor + n * (corridor + depth) for n in range(3)):
        picture[low : low + depth, 60 : length - 20] = 0
        picture[low + wall : low + depth - wall, 60 + wall : length - 20 - wall] = 254
        for place in range(95, length - 60, 100):
            picture[low : low + depth, place : place + door] = 254
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    across = [way["axis"][0][0] for way in survey.of_kind("corridor") if way["name"][0] == "C"]
    assert len(across) == 2, across


def broken(first: int, second: int | None) -> Picture:
    """Three racks between whose faces little was seen: of the middle one each face is open at a place, or one is."""
    picture = hall([[], [], []], 40)
    for row in range(3):
        low = 20 + AISLE + row * (AISLE + DEPTH)
        picture[low + 2 : low + DEPTH - 2, 20 + CROSS : 20 + CROSS + LENGTH] = 205
    low = 20 + 2 * AISLE + DEPTH
    for face, place in ((0, first), (DEPTH - 2, second)):
        if place is not None:
            open_part = slice(20 + CROSS + place, 20 + CROSS + place + 40)
            picture[low + face : low + face + 2, open_part] = 254
            picture[low + 2 : low + DEPTH - 2, open_part] = 254
    return picture


def test_what_is_open_in_one_face_alone_is_no_way() -> None:
    assert types(broken(230, None)) == plain(3)


def test_what_is_open_at_other_places_in_the_one_face_than_in_the_other_is_no_way() -> None:
    assert types(broken(230, 260)) == plain(3)


def test_racks_whose_faces_are_open_at_one_place_have_a_way_there() -> None:
    assert types(broken(230, 230)) == sorted(plain(3) + ["T"] * 2)


def test_racks_of_posts_with_goods_here_and_there_are_not_solid() -> None:
    picture = hall([[], [], []], 40)
    draws = np.random.default_rng(1)
    for row in range(3):
        low = 20 + AISLE + row * (AISLE + DEPTH)
        for bay in np.flatnonzero(draws.random(10) < 0.4).tolist():
            picture[low : low + DEPTH, 20 + CROSS + bay * 50 + 3 : 20 + CROSS + bay * 50 + 47] = 254
    assert types(picture) == plain(3)
