"""Ways around one row of racks, beside which no other tells what is a way, in closed halls that no simulator made."""

from __future__ import annotations

import numpy as np
import pytest
from zoo import Picture, walled

import groundplan

Boxes = list[tuple[float, float, float, float]]  # from x, from y, to x, to y

RESOLUTION = 0.05


def hall(width: float, depth: float, racks: Boxes) -> Picture:
    """A closed hall, metres, with what stands in it; the unknown around."""
    picture = walled(round(width / RESOLUTION), round(depth / RESOLUTION))
    for box in racks:
        left, low, right, high = (round(metres / RESOLUTION) + 20 for metres in box)
        picture[low:high, left:right] = 0
    return picture


def labels(picture: Picture, kind: str, key: str) -> list[object]:
    """One value of all labels of a kind, sorted."""
    return sorted(label[key] for label in groundplan.survey(picture, resolution=RESOLUTION).of_kind(kind))


def in_line(count: int) -> Boxes:
    """Racks of 4 m by 1 m in line, 4 m apart and from the walls, in a hall 6 m deep."""
    return [(4 + 8 * n, 2.5, 8 + 8 * n, 3.5) for n in range(count)]


@pytest.mark.parametrize("count", [2, 3, 4])
def test_ways_lead_around_and_between_racks_in_line_along_the_middle_of_a_hall(count: int) -> None:
    picture = hall(8 * count + 4, 6, in_line(count))
    assert labels(picture, "junction", "type") == ["L"] * 4 + ["T"] * 2 * (count - 1)
    assert labels(picture, "corridor", "width") == pytest.approx([2.5] * 2 + [4.0] * (count + 1), abs=0.25)


def test_around_a_single_thing_in_a_room_is_no_way() -> None:
    assert labels(hall(12, 6, in_line(1)), "corridor", "name") == []


@pytest.mark.parametrize(("rack", "aisle", "way"), [(4, 2.4, 2.5), (5.5, 2.4, 3), (5.5, 2.6, 3.5)])
def test_a_way_leads_past_a_rack_that_leans_on_a_wall_between_the_dead_ends_beside_it(
    rack: float, aisle: float, way: float
) -> None:
    picture = hall(way + rack, 2 * aisle + 2.2, [(way, aisle, way + rack, aisle + 2.2)])
    assert labels(picture, "junction", "type") == ["L", "L", "end", "end"]
    assert labels(picture, "corridor", "width") == pytest.approx(sorted([aisle, aisle, way]), abs=0.25)


def test_the_last_bay_of_one_row_is_no_way_where_the_rows_beside_go_on_to_the_wall() -> None:
    racks: Boxes = [(left, low, left + 9, low + 2) for low in (3, 8, 13) for left in (0, 13)]
    racks[3] = (13, 8, 19, 10)
    ways = labels(hall(22, 18, racks), "corridor", "width")
    assert ways == pytest.approx([3.0] * 4 + [4.0], abs=0.25)


def test_ways_lead_past_two_rows_that_end_in_line() -> None:
    racks: Boxes = [(2.6 + 9.6 * n, low, 9.6 + 9.6 * n, low + 0.5) for n in range(3) for low in (4.0, 8.5)]
    picture = hall(31.4, 13, racks)
    assert labels(picture, "junction", "type") == ["L"] * 4 + ["T"] * 6 + ["X"] * 2
    assert labels(picture, "corridor", "width") == pytest.approx([2.6] * 4 + [4.0] * 3, abs=0.25)


def test_ways_lead_past_a_row_up_to_the_walls_behind_the_racks_across_the_aisles() -> None:
    racks: Boxes = [(3, low, 17, low + depth) for low, depth in ((0.0, 1.0), (4.0, 1.2), (8.2, 1.0))]
    picture = hall(20, 9.2, racks)
    assert labels(picture, "junction", "type") == ["L"] * 4
    assert labels(picture, "corridor", "width") == pytest.approx([3.0] * 4, abs=0.25)
    ends = [rack["axis"] for rack in groundplan.survey(picture, resolution=RESOLUTION).of_kind("rack")]
    assert [np.hypot(*np.subtract(*axis)) for axis in ends] == pytest.approx([14.0] * 3, abs=0.3)


def test_a_pillar_behind_a_rack_is_not_of_it() -> None:
    racks: Boxes = [(3, low, 17, low + 1.2) for low in (0.5, 4.7, 8.9)]
    pillars: Boxes = [(x, low, x + 0.5, low + 0.5) for x in (6.0, 19.0) for low in (0.05, 10.05)]
    picture = hall(22, 10.6, racks + pillars)
    ends = [rack["axis"] for rack in groundplan.survey(picture, resolution=RESOLUTION).of_kind("rack")]
    assert [np.hypot(*np.subtract(*axis)) for axis in ends] == pytest.approx([14.0] * 3, abs=0.3)


@pytest.mark.parametrize("depth", [4, 7, 8, 12])
def test_rows_of_a_coarse_map_are_free_where_nothing_stands_in_them(depth: int) -> None:
    # At 0.1 m a pixel what is asked of a row's columns is as high as a pixel.
    picture = walled(250, 4 * 32 + 3 * depth)
    for n in range(3):
        low = 20 + 32 + n * (32 + depth)
        picture[low : low + depth, 44:246] = 0
    survey = groundplan.survey(picture, resolution=0.1)
    assert sorted(label["type"] for label in survey.of_kind("junction")) == ["L"] * 4 + ["T"] * 4
    assert len(survey.of_kind("rack")) == 3


def outlined(depth: float) -> Picture:
    """A hall of 32 m with three rows of two racks of 10 m that are drawn by their outlines, floor within."""
    aisle, way = 2.8, 4.0
    lows = [aisle + n * (aisle + depth) for n in range(3)]
    racks = [(left, low, left + 10, low + depth) for low in lows for left in (way, 2 * way + 10)]
    picture = hall(3 * way + 20, 4 * aisle + 3 * depth, racks)
    inside = hall(
        3 * way + 20, 4 * aisle + 3 * depth, [(x0 + 0.1, y0 + 0.1, x1 - 0.1, y1 - 0.1) for x0, y0, x1, y1 in racks]
    )
    solid = hall(3 * way + 20, 4 * aisle + 3 * depth, [])
    picture[(inside == 0) & (solid == 254)] = 254
    return picture


@pytest.mark.parametrize("depth", [0.8, 1.6, 2.4])
def test_racks_that_are_drawn_by_their_outlines_have_ways_around_and_none_within(depth: float) -> None:
    assert labels(outlined(depth), "junction", "type") == ["L"] * 4 + ["T"] * 6 + ["X"] * 2
    assert len(labels(outlined(depth), "corridor", "name")) == 7
    racks = groundplan.survey(outlined(depth), resolution=RESOLUTION).of_kind("rack")
    assert [rack["width"] for rack in racks] == pytest.approx([depth] * 6, abs=0.15)
    assert min(rack["confidence"] for rack in racks) > 0.5


def test_corridors_whose_doors_are_all_shut_are_ways() -> None:
    walls: Boxes = [(0, 2.0, 40, 2.1)]
    assert labels(hall(40, 4.1, walls), "corridor", "width") == pytest.approx([2.0, 2.0], abs=0.15)


@pytest.mark.parametrize("seed", range(6))
def test_specks_between_an_aisle_and_the_way_past_its_end_bar_neither(seed: int) -> None:
    picture = hall(31.4, 15, [(2.6 + 9.6 * n, low, 9.6 + 9.6 * n, low + 1.5) for n in range(3) for low in (4.0, 9.5)])
    specks = np.random.default_rng(seed).random(picture.shape) < 0.002
    picture[specks & (picture == 254)] = 0
    assert labels(picture, "junction", "type") == ["L"] * 4 + ["T"] * 6 + ["X"] * 2


@pytest.mark.parametrize(("rack", "flue"), [(0.55, 0.3), (0.9, 0.2), (1.1, 0.25)])
def test_a_row_of_racks_back_to_back_ends_where_both_do(rack: float, flue: float) -> None:
    lows = [2.6, 2.6 + rack + flue]
    racks: Boxes = [(left, low, left + 12, low + rack) for low in lows for left in (2.4, 16.8)]
    picture = hall(31.2, 5.2 + 2 * rack + flue, racks)
    assert labels(picture, "junction", "type") == ["L"] * 4 + ["T"] * 2
    assert labels(picture, "corridor", "width") == pytest.approx([2.4] * 3 + [2.6] * 2, abs=0.25)


def test_a_way_past_a_row_may_be_wider_than_its_aisles_are_together() -> None:
    picture = hall(32, 5.2, [(6.6, 2.0, 25.4, 3.2)])
    assert labels(picture, "junction", "type") == ["L"] * 4
    assert labels(picture, "corridor", "width") == pytest.approx([2.0] * 2 + [6.6] * 2, abs=0.25)


def test_a_row_of_racks_back_to_back_ends_where_one_of_them_has_an_empty_bay() -> None:
    racks: Boxes = [(5.0, 2.5, 15, 3.5), (3.0, 3.5, 15, 4.5), (18, 2.5, 30, 3.5), (18, 3.5, 28, 4.5)]
    picture = hall(33, 7, racks)
    assert labels(picture, "junction", "type") == ["L"] * 4 + ["T"] * 2
    assert labels(picture, "corridor", "width") == pytest.approx([2.5] * 2 + [3.0] * 3, abs=0.25)


def test_a_way_through_a_row_whose_end_bays_are_half_empty_is_as_wide_as_those_past_its_ends() -> None:
    racks: Boxes = [(3, 2.5, 13, 3.5), (3, 3.5, 15, 4.5), (18, 2.5, 30, 3.5), (20, 3.5, 30, 4.5)]
    picture = hall(33, 7, racks)
    assert labels(picture, "junction", "type") == ["L"] * 4 + ["T"] * 2
    # Two bays that are both empty are no way: they are narrower.
    racks = [(3, 2.5, 15, 4.5), (17, 2.5, 30, 3.5), (19, 3.5, 30, 4.5)]
    assert labels(hall(33, 7, racks), "junction", "type") == ["L"] * 4


def test_goods_on_the_floor_at_a_rows_faces_end_no_row() -> None:
    goods: Boxes = [(x, y, x + 0.3, y + 0.3) for x, y in ((1.2, 2.4), (1.5, 3.2), (12.6, 3.2), (12.9, 2.4))]
    picture = hall(24, 6, [(4, 2.5, 10, 3.4), (14, 2.5, 20, 3.4), *goods])
    assert labels(picture, "junction", "type") == ["L"] * 4 + ["T"] * 2
    assert labels(picture, "corridor", "width") == pytest.approx([2.5] * 2 + [4.0] * 3, abs=0.25)


def test_posts_end_a_row_where_no_bay_fits_between_them_and_the_wall() -> None:
    bay, first, full = 2.0, 3.4, (2, 3, 5, 6, 8, 9)  # of twelve bays
    places = [first + n * bay for n in range(13)]
    posts: Boxes = [(x - 0.05, y, x + 0.05, y + 0.1) for x in places for y in (2.5, 4.4)]
    goods: Boxes = [(places[n] + 0.1, 2.55, places[n + 1] - 0.1, 4.45) for n in full]
    picture = hall(2 * first + 12 * bay, 7, goods + posts)
    assert labels(picture, "junction", "type") == ["L"] * 4
    assert labels(picture, "corridor", "width") == pytest.approx([2.5] * 2 + [first] * 2, abs=0.25)


@pytest.mark.parametrize("place", [0.8, 1.2, 1.6])
def test_no_way_leads_between_two_racks_through_a_wall_that_joins_them(place: float) -> None:
    racks: Boxes = [(3.5, 2.8, 12, 5.2), (14.5, 2.8, 23, 5.2), (12, 2.8 + place, 14.5, 2.9 + place)]
    picture = hall(26.5, 8, racks)
    assert labels(picture, "junction", "type") == ["L"] * 4
    assert labels(picture, "corridor", "width") == pytest.approx([2.8, 2.8, 3.5, 3.5], abs=0.25)


@pytest.mark.parametrize("head", [3.0, 3.6])
def test_ways_lead_past_the_ends_of_a_row_of_pallets_of_which_the_blocks_alone_are_seen(head: float) -> None:
    # Pallets of nine blocks, two deep: nothing closes the row's ends.
    count, pallet = 12, 1.0
    places = [
        (head + pallet * n + 0.1 + 0.35 * k, 2.6 + 0.5 * m) for n in range(count) for k in range(3) for m in range(4)
    ]
    blocks: Boxes = [(x, y, x + 0.1, y + 0.1) for x, y in places]
    picture = hall(2 * head + count * pallet, 6.8, blocks)
    assert labels(picture, "junction", "type") == ["L"] * 4
    assert labels(picture, "corridor", "width") == pytest.approx([2.6] * 2 + [head] * 2, abs=0.3)
