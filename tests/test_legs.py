"""Racks of which a lidar sees the legs alone: legs in pairs, at one pitch, with floor under the lowest beams."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
import shapely
from _legs import RESOLUTION, Box, Picture, hall, legs, with_a_way

import groundplan


def plates(x: float, y: float, bays: int, depth: float, pitch: float) -> Iterator[Box]:
    """The same where a plate joins the two legs of each frame."""
    for n in range(bays + 1):
        yield x + n * pitch, y, x + n * pitch + 0.1, y + depth


def counts(picture: Picture) -> dict[str, int]:
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    return {kind: len(survey.of_kind(kind)) for kind in ("rack", "corridor", "junction", "pillar")}


NOTHING = {"rack": 0, "corridor": 0, "junction": 0, "pillar": 0}


@pytest.mark.parametrize("degrees", [0.0, 17.0])
@pytest.mark.parametrize(
    ("depth", "pitch", "aisle"), [(1.1, 2.7, 3.0), (1.3, 3.6, 2.0), (0.6, 1.5, 1.5), (0.6, 0.9, 1.5)]
)
def test_legs_in_pairs_at_one_pitch_are_racks_with_aisles_between_them(
    depth: float, pitch: float, aisle: float, degrees: float
) -> None:
    boxes = (box for n in range(4) for box in legs(4.0, aisle + n * (aisle + depth), 7, depth, pitch))
    picture = hall(8.0 + 7 * pitch, 5 * aisle + 4 * depth, boxes, degrees)
    # Five aisles along the racks and a way past each of their ends.
    assert counts(picture) == {"rack": 4, "corridor": 7, "junction": 10, "pillar": 0}
    for rack in groundplan.survey(picture, resolution=RESOLUTION).of_kind("rack"):
        assert rack["width"] == pytest.approx(depth, abs=0.15)
        assert np.hypot(*np.subtract(*rack["axis"])) == pytest.approx(7 * pitch, abs=0.3)


def test_goods_on_some_of_the_floor_under_the_racks_change_nothing() -> None:
    def boxes() -> Iterator[Box]:
        for n in range(4):
            yield from legs(4.0, 3.0 + 4.1 * n, 8, 1.1, 2.7)
            for bay in (n, n + 3):
                yield 4.3 + 2.7 * bay, 3.1 + 4.1 * n, 5.9 + 2.7 * bay, 4.0 + 4.1 * n

    assert counts(hall(29.6, 19.4, boxes())) == {"rack": 4, "corridor": 7, "junction": 10, "pillar": 0}


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_racks_are_whole_though_every_seventh_leg_was_not_seen(seed: int) -> None:
    draws = np.random.default_rng(seed)
    boxes = (box for n in range(4) for box in legs(4.0, 3.0 + 4.1 * n, 8, 1.1, 2.7) if draws.random() > 1 / 7)
    picture = hall(29.6, 19.4, boxes, 5.0 * seed)
    assert counts(picture) == {"rack": 4, "corridor": 7, "junction": 10, "pillar": 0}


def test_legs_of_one_pixel_of_a_coarse_map_are_racks_too() -> None:
    # Half as large at half the pixel.
    boxes = (box for n in range(4) for box in legs(2.0, 1.5 + 2.05 * n, 8, 0.55, 1.35, 0.05))
    survey = groundplan.survey(hall(14.8, 9.7, boxes, 7.0), resolution=2 * RESOLUTION)
    assert len(survey.of_kind("rack")) == 4 and len(survey.of_kind("corridor")) == 7


def test_racks_whose_legs_all_show_are_sure_and_so_are_the_aisles_beside_them() -> None:
    boxes = (box for n in range(4) for box in legs(4.0, 3.0 + 4.1 * n, 8, 1.1, 2.7))
    survey = groundplan.survey(hall(29.6, 19.4, boxes, 17.0), resolution=RESOLUTION)
    racks, aisles = survey.of_kind("rack"), [way for way in survey.of_kind("corridor") if way["name"][0] == "A"]
    assert (len(racks), len(aisles)) == (4, 5)
    assert all(label["confidence"] >= 0.8 for label in (*racks, *aisles))


def test_racks_back_to_back_are_one() -> None:
    def boxes() -> Iterator[Box]:
        for n in range(3):
            yield from legs(4.0, 3.0 + 5.4 * n, 8, 1.1, 2.7)
            yield from legs(4.0, 4.3 + 5.4 * n, 8, 1.1, 2.7)

    survey = groundplan.survey(hall(29.6, 19.2, boxes()), resolution=RESOLUTION)
    assert [rack["width"] for rack in survey.of_kind("rack")] == pytest.approx([2.4] * 3, abs=0.15)
    assert len(survey.of_kind("corridor")) == 6


@pytest.mark.parametrize("degrees", [0.0, 25.0])
def test_racks_back_to_back_are_one_though_the_legs_between_them_are_seen_as_single_things(degrees: float) -> None:
    def boxes() -> Iterator[Box]:
        for n in range(4):
            low = 2.0 + 3.9 * n
            yield from legs(3.0, low, 12, 0.95, 0.9)
            yield from legs(3.0, low + 0.95, 12, 0.95, 0.9)
            for leg in range(13):  # What lies between two legs was hit as well.
                yield 3.0 + 0.9 * leg, low + 0.8, 3.1 + 0.9 * leg, low + 1.1

    survey = groundplan.survey(hall(16.9, 17.6, boxes(), degrees), resolution=RESOLUTION)
    assert [rack["width"] for rack in survey.of_kind("rack")] == pytest.approx([1.9] * 4, abs=0.15)
    assert len(survey.of_kind("corridor")) == 7


def test_a_way_across_racks_on_legs_is_none_of_their_bays() -> None:
    def boxes() -> Iterator[Box]:
        for n in range(4):
            for x in (4.0, 4.0 + 5 * 2.7 + 3.5):
                yield from legs(x, 3.0 + 4.1 * n, 5, 1.1, 2.7)

    assert counts(hall(38.5, 19.4, boxes(), 5.0)) == {"rack": 8, "corridor": 8, "junction": 15, "pillar": 0}


def test_plates_that_follow_one_another_are_the_frames_of_racks() -> None:
    """Six racks of two bays, with aisles hardly wider than they are deep."""
    boxes = (box for n in range(6) for box in plates(3.0, 1.0 + 1.9 * n, 2, 0.9, 2.0))
    picture = hall(10.0, 12.4, boxes, 3.0)
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    assert len(survey.of_kind("rack")) == 6 and len(survey.of_kind("corridor")) == 9


def test_a_rack_whose_last_frame_is_lost_in_a_wall_is_as_long_as_those_beside_it() -> None:
    def boxes() -> Iterator[Box]:
        for n in range(5):
            yield from plates(3.0, 2.0 + 1.9 * n, 2, 0.9, 2.0)
        # Before the wall behind the third of them stands something.
        yield 7.0, 5.7, 7.9, 6.8

    survey = groundplan.survey(hall(7.9, 11.8, boxes()), resolution=RESOLUTION)
    lengths = [np.hypot(*np.subtract(*rack["axis"])) for rack in survey.of_kind("rack")]
    assert lengths == pytest.approx([4.0] * 5, abs=0.3)


def test_a_table_is_no_rack_be_it_long() -> None:
    assert counts(hall(20.0, 12.0, legs(5.0, 5.0, 6, 1.0, 1.5))) == NOTHING


def test_legs_anyhow_are_no_racks() -> None:
    draws = np.random.default_rng(3)
    places = draws.uniform((1.0, 1.0), (23.0, 17.0), (120, 2))
    assert counts(hall(24.0, 18.0, ((x, y, x + 0.1, y + 0.1) for x, y in places)))["rack"] == 0


def test_a_grid_of_thin_posts_as_far_apart_along_as_across_is_no_rack() -> None:
    boxes = ((x, y, x + 0.1, y + 0.1) for x in np.arange(3.0, 20.0, 1.5) for y in np.arange(3.0, 20.0, 1.5))
    assert counts(hall(23.0, 23.0, boxes))["rack"] == 0


def test_a_way_through_racks_whose_legs_stand_a_bay_apart_beside_it_is_told_by_the_goods_in_the_others() -> None:
    survey = groundplan.survey(with_a_way(), resolution=RESOLUTION)
    types = [junction["type"] for junction in survey.of_kind("junction")]
    assert sorted(types) == ["L"] * 4 + ["T"] * 6 + ["X"] * 2


def double(x: float, y: float, bays: int, pitch: float, closed: tuple[bool, bool], back: float = 0.2) -> Iterator[Box]:
    """Two racks 1.1 m deep back to back; a plate as deep as both stands in place of the legs at a closed end."""
    depth = 2.2 + back
    for low in (y, y + 1.1 + back):
        first, last = int(closed[0]), bays - int(closed[1])
        yield from legs(x + first * pitch, low, last - first, 1.1, pitch)
    for is_closed, at in zip(closed, (x, x + bays * pitch), strict=True):
        if is_closed:
            yield at, y, at + 0.1, y + depth


def lengths(survey: groundplan.Survey) -> list[float]:
    return sorted(float(np.hypot(*np.subtract(*rack["axis"]))) for rack in survey.of_kind("rack"))


@pytest.mark.parametrize("degrees", [0.0, 33.0])
def test_a_plate_across_two_racks_back_to_back_is_the_last_frame_of_both(degrees: float) -> None:
    boxes = (box for n in range(4) for box in double(4.0, 3.0 + 5.4 * n, 7, 2.7, (True, True)))
    picture = hall(27.0, 24.6, boxes, degrees)
    assert counts(picture) == {"rack": 4, "corridor": 7, "junction": 10, "pillar": 0}
    assert lengths(groundplan.survey(picture, resolution=RESOLUTION)) == pytest.approx([18.9] * 4, abs=0.3)


def test_racks_in_line_have_bays_of_their_own() -> None:
    def boxes() -> Iterator[Box]:
        for n in range(4):
            yield from double(4.0, 3.0 + 5.4 * n, 7, 1.5, (True, True))
            yield from double(18.2, 3.0 + 5.4 * n, 3, 2.8, (True, True))

    survey = groundplan.survey(hall(30.6, 24.6, boxes()), resolution=RESOLUTION)
    assert lengths(survey) == pytest.approx([8.4] * 4 + [10.5] * 4, abs=0.3)
    assert len(survey.of_kind("corridor")) == 8 and len(survey.of_kind("junction")) == 15


@pytest.mark.parametrize("pitch", [1.8, 2.1])
def test_a_rack_of_which_every_second_frame_shows_one_leg_does_not_grow_over_the_way_beside_it(pitch: float) -> None:
    def boxes() -> Iterator[Box]:
        for y in (3.0 + 4.1 * n for n in range(4)):
            yield from legs(4.0 + 12 * pitch, y, 10, 1.1, pitch)
            hidden = [(4.0 + n * pitch, y + 1.0) for n in range(1, 10, 2)]
            yield from (
                box for box in legs(4.0, y, 10, 1.1, pitch) if not np.isclose(hidden, box[:2]).all(axis=1).any()
            )

    survey = groundplan.survey(hall(8.0 + 22 * pitch, 19.4, boxes()), resolution=RESOLUTION)
    assert lengths(survey) == pytest.approx([10 * pitch] * 8, abs=0.3)
    assert len(survey.of_kind("corridor")) == 8


def test_the_legs_between_two_racks_are_no_frame_though_they_stand_as_far_apart_as_shelves_are_deep() -> None:
    boxes = (box for n in range(3) for box in double(4.0, 3.0 + 5.7 * n, 8, 2.2, (False, False), back=0.45))
    survey = groundplan.survey(hall(25.7, 20.1, boxes), resolution=RESOLUTION)
    assert [rack["width"] for rack in survey.of_kind("rack")] == pytest.approx([2.65] * 3, abs=0.15)
    assert len(survey.of_kind("corridor")) == 6


@pytest.mark.parametrize(
    ("bays", "closed", "racks"), [(3, (True, True), 1), (5, (False, False), 1), (2, (False, False), 0)]
)
def test_two_racks_back_to_back_by_themselves_are_told_from_tables_by_plates_or_their_length(
    bays: int, closed: tuple[bool, bool], racks: int
) -> None:
    picture = hall(9.0 + 2.7 * bays, 9.0, double(4.0, 3.3, bays, 2.7, closed))
    assert counts(picture)["rack"] == racks


def test_racks_of_one_pitch_are_of_a_kind_though_none_is_as_deep_as_another() -> None:
    boxes = (box for n, depth in enumerate((0.8, 1.1, 1.4)) for box in legs(4.0, 3.0 + 4.2 * n, 5, depth, 2.7))
    assert counts(hall(21.5, 15.8, boxes))["rack"] == 3


@pytest.mark.parametrize(("last", "ways"), [(True, 1), (False, 0)])
def test_what_ends_one_bay_before_a_wall_leans_on_it_where_its_other_end_alone_is_closed(last: bool, ways: int) -> None:
    boxes = (box for n in range(4) for box in double(4.0, 3.0 + 5.4 * n, 7, 2.7, (True, last)))
    survey = groundplan.survey(hall(4.0 + 8 * 2.7, 24.6, boxes), resolution=RESOLUTION)
    along = [way for way in survey.of_kind("corridor") if way["axis"][0][0] > 22.9 and way["name"][0] == "C"]
    assert len([way for way in survey.of_kind("corridor") if way["name"][0] == "C"]) == 1 + ways, along


@pytest.mark.parametrize("is_double", [False, True])
def test_a_way_as_wide_as_a_bay_between_plates_is_one(is_double: bool) -> None:
    def boxes() -> Iterator[Box]:
        for n in range(3):
            for x in (4.0, 4.0 + 5 * 2.7):
                if is_double:
                    yield from double(x, 3.0 + 5.4 * n, 4, 2.7, (True, True))
                else:
                    yield from legs(x + 2.7, 3.0 + 5.4 * n, 2, 1.1, 2.7)
                    yield from plates(x, 3.0 + 5.4 * n, 1, 1.1, 4 * 2.7)

    survey = groundplan.survey(hall(8.0 + 9 * 2.7, 18.0, boxes()), resolution=RESOLUTION)
    assert len(survey.of_kind("rack")) == 6
    assert len([way for way in survey.of_kind("corridor") if way["name"][0] == "C"]) == 3


def test_rows_of_tables_are_no_racks_though_their_legs_are_in_step() -> None:
    boxes = (box for n, depth in enumerate((0.7, 1.1)) for box in legs(4.0, 3.0 + 3.0 * n, 5, depth, 1.6))
    assert counts(hall(16.0, 12.0, boxes))["rack"] == 0


@pytest.mark.parametrize("degrees", [0.0, 17.0])
def test_goods_that_hide_frames_leave_a_rack_whole(degrees: float) -> None:
    def boxes() -> Iterator[Box]:
        for n, full in enumerate([(1, 7), (2, 6)]):
            yield from legs(3.0, 2.6 + 3.3 * n, 9, 1.1, 1.6)
            # Pallets touch the legs beside them.
            for bay in full:
                yield 3.1 + 1.6 * bay, 2.6 + 3.3 * n, 4.6 + 1.6 * bay, 3.7 + 3.3 * n

    found = counts(hall(20.5, 9.6, boxes(), degrees))
    assert found == {"rack": 2, "corridor": 5, "junction": 6, "pillar": 0}


def test_what_a_map_shows_twice_is_one_rack() -> None:
    def boxes() -> Iterator[Box]:
        for n in range(3):
            for off in (0.0, 0.25):
                yield from legs(3.0 + off, 3.0 + 4.1 * n, 7, 1.1, 2.7)

    found = counts(hall(25.0, 15.3, boxes()))
    assert found == {"rack": 3, "corridor": 6, "junction": 8, "pillar": 0}


@pytest.mark.parametrize("share", [0.4, 0.6])
@pytest.mark.parametrize("racks", [1, 2])
@pytest.mark.parametrize("seed", range(4))
def test_a_way_two_shelves_wide_in_which_no_post_stands_is_no_shelf(seed: int, racks: int, share: float) -> None:
    draws = np.random.default_rng(seed)
    apart, depth = 2.5 + 0.9 * racks, 0.9 * racks
    gaps = draws.integers(6, 22, 4)

    def boxes() -> Iterator[Box]:
        for n, gap in enumerate(gaps):
            for y in (3.0 + apart * n + 0.9 * rack for rack in range(racks)):
                for first, end in ((0, gap), (gap + 2, 30)):
                    yield from legs(4.0 + 1.25 * first, y, end - first, 0.85, 1.25)
                    for bay in first + np.flatnonzero(draws.random(end - first) < share):
                        yield 4.13 + 1.25 * bay, y + 0.05, 5.21 + 1.25 * bay, y + 0.8

    height = 5.5 + 4 * apart
    survey = groundplan.survey(hall(45.5, height, boxes()), resolution=RESOLUTION)
    across = [shapely.Polygon(way["polygon"]) for way in survey.of_kind("corridor") if way["name"][0] == "C"]
    side = survey.map.width * RESOLUTION / 2
    middles = [(4.0 + 1.25 * (gap + 1) - 22.75, 3.0 + apart * n + depth / 2 - height / 2) for n, gap in enumerate(gaps)]
    assert all(any(way.contains(shapely.Point(side + x, side + y)) for way in across) for x, y in middles)
    # Those past the rows' ends are two more; some of the others may be in line.
    assert len(across) <= 6


def against_a_wall(rows: int, pitch: float, off: float, bump: float) -> Picture:
    """Racks on legs that end so far before the east wall; legs that stand against it reach so far before it."""
    end = 4.0 + 9 * pitch

    def boxes() -> Iterator[Box]:
        for n in range(rows):
            y = 3.0 + 4.1 * n
            yield from legs(4.0, y, 9, 1.1, pitch)
            for low in (y, y + 1.0):
                yield end + off - bump, low, end + off, low + 0.1

    return hall(end + off, 3.0 + 4.1 * rows, boxes())


@pytest.mark.parametrize("rows", [3, 4])
@pytest.mark.parametrize("pitch", [1.6, 2.1, 2.7])
def test_racks_whose_last_legs_are_bumps_on_a_wall_stand_against_it(pitch: float, rows: int) -> None:
    survey = groundplan.survey(against_a_wall(rows, pitch, pitch + 0.05, 0.1), resolution=RESOLUTION)
    assert len([way for way in survey.of_kind("corridor") if way["name"][0] == "C"]) == 1
    for rack in survey.of_kind("rack"):
        assert np.hypot(*np.subtract(*rack["axis"])) == pytest.approx(10 * pitch, abs=0.3)


@pytest.mark.parametrize("pitch", [1.6, 2.1, 2.7])
def test_a_way_as_wide_as_a_bay_leads_past_racks_on_legs_along_a_bare_wall(pitch: float) -> None:
    survey = groundplan.survey(against_a_wall(4, pitch, pitch + 0.05, 0.0), resolution=RESOLUTION)
    assert len([way for way in survey.of_kind("corridor") if way["name"][0] == "C"]) == 2


@pytest.mark.parametrize("wide", [0.5, 1.1])
@pytest.mark.parametrize("pitch", [1.6, 2.1, 2.7])
def test_what_stands_at_a_wall_before_racks_and_is_wider_than_legs_leaves_the_way_past_them(
    pitch: float, wide: float
) -> None:
    end = 4.0 + 9 * pitch

    def boxes() -> Iterator[Box]:
        for n in range(4):
            yield from legs(4.0, 3.0 + 4.1 * n, 9, 1.1, pitch)
            yield end + pitch - 0.2, 3.0 + 4.1 * n, end + pitch + 0.05, 3.0 + 4.1 * n + wide

    survey = groundplan.survey(hall(end + pitch + 0.05, 19.4, boxes()), resolution=RESOLUTION)
    assert len([way for way in survey.of_kind("corridor") if way["name"][0] == "C"]) == 2
