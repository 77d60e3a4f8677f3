"""Where rows end each at its own place before a wall, a way leads along it all the same."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from _legs import Box, put_posts
from _legs import hall as drawn
from zoo import OCCUPIED, UNKNOWN, Picture, walled

import groundplan
from groundplan import simulate

RESOLUTION = 0.1


def hall(
    early: tuple[float, ...], boxes: tuple[tuple[float, float], ...] = (), empty: tuple[int, ...] = ()
) -> groundplan.Survey:
    """40 m by 3 m and 4.5 m for each row: racks 1.5 m deep from the west wall to 3 m and more before the east wall.

    Of some rows the last bay of 2.5 m is empty but for its legs.
    """
    depth = 3.0 + 4.5 * len(early)
    y, x = np.mgrid[-1.0 : depth + 1.0 : RESOLUTION, -1.0:41.0:RESOLUTION]
    picture = np.full(x.shape, 205, dtype=np.uint8)
    picture[(x > -0.2) & (x < 40.2) & (y > -0.2) & (y < depth + 0.2)] = 0
    picture[(x > 0) & (x < 40) & (y > 0) & (y < depth)] = 254
    for row, by in enumerate(early):
        low = 3.0 + 4.5 * row
        picture[(x > 0) & (x < 37 - by) & (y > low) & (y < low + 1.5)] = 0
    for row in empty:
        low = 3.0 + 4.5 * row
        within = (x > 34.5) & (x < 37) & (y > low) & (y < low + 1.5)
        legs = (x > 36.8) & ((y < low + 0.2) | (y > low + 1.3))
        picture[within & ~legs] = 254
    for at in boxes:
        picture[(abs(x - at[0]) < 0.2) & (abs(y - at[1]) < 0.2)] = 0
    return groundplan.survey(np.ascontiguousarray(picture[::-1]), resolution=RESOLUTION)


@pytest.mark.parametrize("early", [(2.0, 0.0, 4.0), (5.0, 0.0), (0.8, 0.0), (0.0, 4.0, 1.5, 3.0)])
def test_aisles_meet_the_way_along_the_wall_before_rows_of_any_length(early: tuple[float, ...]) -> None:
    survey = hall(early)
    kinds = sorted(label["type"] for label in survey.of_kind("junction") if label["type"] != "end")
    assert kinds == ["L", "L"] + ["T"] * (len(early) - 1)
    assert all(abs(label["at"][0] - 39.5) < 0.3 for label in survey.of_kind("junction") if label["type"] != "end")


@pytest.mark.parametrize(
    "early",
    [
        (-1.0, 4.0, 4.0, -1.0, 4.0),
        (-1.1, 1.6, 1.6, -1.1, 1.6),
        (-1.1, 3.0, 3.0, -1.1, 3.0),
        (-1.5, 3.0, 1.6, -1.5, 4.0),
    ],
)
def test_the_way_along_the_wall_may_be_narrower_than_the_aisles_that_lead_to_it(early: tuple[float, ...]) -> None:
    survey = hall(early)
    kinds = sorted(label["type"] for label in survey.of_kind("junction") if label["type"] != "end")
    assert kinds == ["L"] * 2 + ["T"] * 4


@pytest.mark.parametrize("gap", [2.4, 3.0, 4.0])
def test_an_aisle_that_an_office_closes_leads_round_the_head_of_the_row_beside_it(gap: float) -> None:
    """Two rows 2 m deep and three aisles of 3 m; one row and the aisle beside it end before an office in the corner."""
    y, x = np.mgrid[-1.0:14.0:RESOLUTION, -1.0:41.0:RESOLUTION] + RESOLUTION / 2
    picture = np.full(x.shape, 205, dtype=np.uint8)
    picture[(x > -0.2) & (x < 40.2) & (y > -0.2) & (y < 13.2)] = 0
    picture[(x > 0) & (x < 40) & (y > 0) & (y < 13)] = 254
    picture[(x > 29.8) & (y > -0.2) & (y < 5.0)] = 0
    for low, end in ((3.0, 29.8 - gap), (8.0, 36.5)):
        picture[(x > 3.5) & (x < end) & (y > low) & (y < low + 2.0)] = 0
    survey = groundplan.survey(np.ascontiguousarray(picture[::-1]), resolution=RESOLUTION)
    beside = [label for label in survey.of_kind("junction") if abs(label["at"][0] - (30.8 - gap / 2)) < 0.5]
    assert sorted(label["type"] for label in beside) == ["L", "T"]


@pytest.mark.parametrize("empty", [(0, 1, 3), (0, 1, 2, 3), (1, 2, 3, 4)])
def test_the_way_along_the_wall_is_known_though_the_last_bays_are_empty(empty: tuple[int, ...]) -> None:
    survey = hall((0.0,) * 5, empty=empty)
    ways = [label for label in survey.of_kind("corridor") if label["name"].startswith("C")]
    assert [way["width"] for way in ways] == pytest.approx([3.0], abs=0.2)
    kinds = sorted(label["type"] for label in survey.of_kind("junction") if label["type"] != "end")
    assert kinds == ["L"] * 2 + ["T"] * 4


@pytest.mark.parametrize(("early", "empty"), [((0.0, 2.5, 0.0, 2.5, 0.0), (0, 2, 4)), ((2.5, 0.0, 2.5, 0.0), (1, 3))])
def test_the_way_along_the_wall_is_as_wide_as_the_longest_rows_leave(
    early: tuple[float, ...], empty: tuple[int, ...]
) -> None:
    """Every second row is a bay short, and the last bays of the others are empty."""
    ways = [label for label in hall(early, empty=empty).of_kind("corridor") if label["name"].startswith("C")]
    assert [way["width"] for way in ways] == pytest.approx([3.0], abs=0.2)


@pytest.mark.parametrize("rows", [2, 3])
@pytest.mark.parametrize("gap", [2.4, 3.6])
def test_a_way_leads_past_rows_that_end_before_a_corner_of_the_hall(rows: int, gap: float) -> None:
    """Rows 1.2 m deep between aisles of 3 m: some end before a corner, the others go on past it."""
    y, x = np.mgrid[-1.0 : 4.2 * (rows + 2) + 4.0 : 0.05, -1.0:41.0:0.05] + 0.025
    depth = 4.2 * (rows + 2) + 3.0
    picture = np.full(x.shape, 205, dtype=np.uint8)
    corner = 4.2 * rows
    is_hall = (x > 0) & (y > 0) & (y < depth) & (x < np.where(y < corner, 28.0, 40.0))
    near = (x > -0.2) & (y > -0.2) & (y < depth + 0.2) & (x < np.where(y < corner, 28.2, 40.2))
    picture[near] = 0
    picture[is_hall] = 254
    for row in range(rows + 2):
        low = 3.0 + 4.2 * row
        end = 28.0 - gap if row < rows else 37.0
        picture[(x > 3.0) & (x < end) & (y > low) & (y < low + 1.2)] = 0
    survey = groundplan.survey(np.ascontiguousarray(picture[::-1]), resolution=0.05)
    beside = [label for label in survey.of_kind("junction") if abs(label["at"][0] - (28.5 - gap / 2)) < 1.0]
    assert sorted(label["type"] for label in beside) == ["L"] + ["T"] * rows


@pytest.mark.parametrize("bay", [1.8, 2.7, 3.6])
def test_no_way_leads_past_rows_at_a_wall_of_which_two_have_their_last_bays_empty(bay: float) -> None:
    """Three rows of five bays stand against the east wall, the first full up to there; posts stand between bays."""
    cell = 0.05
    bay_px, aisle, depth = round(bay / cell), 60, 20
    picture = walled(aisle + 5 * bay_px, 3 * depth + 4 * aisle)
    for row in range(3):
        low = 20 + aisle + row * (aisle + depth)
        for n in range(6):
            post = min(20 + aisle + n * bay_px, picture.shape[1] - 22)
            for edge in (low, low + depth - 2):
                picture[edge : edge + 2, post : post + 2] = 0
        for n in range(5):
            if (n < 4 or row == 0) and (n + row) % 4 != 1:
                start = 20 + aisle + n * bay_px
                picture[low + 1 : low + depth - 1, start + 4 : start + bay_px // 2 - 1] = 0
                picture[low + 1 : low + depth - 1, start + bay_px // 2 + 1 : start + bay_px - 3] = 0
    survey = groundplan.survey(picture, resolution=cell)
    at_wall = [label for label in survey.of_kind("junction") if label["at"][0] > 4.0 + 3.0 * bay]
    assert [label["type"] for label in at_wall] == ["end"] * 4


def test_boxes_on_both_faces_of_a_row_are_not_its_end() -> None:
    survey = hall((0.0, 0.0, 0.0), boxes=((39.0, 3.0), (39.0, 4.5)))
    ways = [label for label in survey.of_kind("corridor") if label["name"].startswith("C")]
    assert [round(way["width"]) for way in ways] == [3]


def test_rows_that_go_on_to_the_wall_leave_no_way_along_it() -> None:
    survey = hall((-3.0, -3.0, -3.0))
    assert {label["type"] for label in survey.of_kind("junction")} == {"end"}


def test_the_way_along_the_wall_is_known_though_not_all_aisles_beside_the_rows_end_there() -> None:
    options = simulate.WarehouseOptions(halls=2, uneven=0.7, gap=6.0, width=30, depth=22, sparse=0.3)
    survey = groundplan.survey(simulate.warehouse(options, seed=2).map)
    at_wall = [way for way in survey.of_kind("corridor") if all(abs(x) < 0.3 for x, _ in way["axis"])]
    assert [(way["name"][0], round(way["width"])) for way in at_wall] == [("C", 3)]


@pytest.mark.parametrize("gap", [3.4, 4.6])
def test_ways_lead_past_both_ends_of_a_single_row_though_they_are_as_wide_as_its_bays(gap: float) -> None:
    """A row of eight bays of 2.8 m between posts, two of them empty, 4 m from one wall."""
    length, depth = 26.4 + gap, 7.5
    y, x = np.mgrid[-1.0 : depth + 1.0 : 0.05, -1.0 : length + 1.0 : 0.05] + 0.025
    picture = np.full(x.shape, 205, dtype=np.uint8)
    picture[(x > -0.2) & (x < length + 0.2) & (y > -0.2) & (y < depth + 0.2)] = 0
    picture[(x > 0) & (x < length) & (y > 0) & (y < depth)] = 254
    for start in 4.0 + 2.8 * np.arange(9):
        picture[(abs(x - start) < 0.05) & (y > 3.2) & (y < 4.3) & ((y < 3.3) | (y > 4.2))] = 0
    for bay in (0, 1, 3, 4, 6, 7):
        for low, high in ((0.28, 1.34), (1.46, 2.58)):
            start = 4.0 + 2.8 * bay
            picture[(x > start + low) & (x < start + high) & (y > 3.25) & (y < 4.25)] = 0
    survey = groundplan.survey(np.ascontiguousarray(picture[::-1]), resolution=0.05)
    ways = sorted(way["width"] for way in survey.of_kind("corridor") if way["name"].startswith("C"))
    assert ways == pytest.approx(sorted([gap, 4.0]), abs=0.3)
    assert [label["type"] for label in survey.of_kind("junction")] == ["L"] * 4


def racks(seed: int) -> groundplan.Survey:
    """Rows of one rack or of two back to back, of bays of 3.3 m on posts, between a way about as wide and a wider one.

    A third to three quarters of the goods are there, and bars across some rows close their ends.
    """
    draws, bay, depth, aisle = np.random.default_rng(seed), 66, 44, 56  # pixels of 0.05 m
    rows, bays = int(draws.integers(3, 6)), int(draws.integers(6, 11))
    first, last = int(draws.integers(60, 72)), int(draws.integers(74, 100))
    picture = walled(first + last + bays * bay, rows * depth + (rows + 1) * aisle)
    full = draws.uniform(0.35, 0.75)
    for low in (20 + aisle + row * (aisle + depth) for row in range(rows)):
        is_barred, is_double = draws.random() < 0.6, draws.random() < 0.7
        for post in range(bays + 1):
            x = 20 + first + post * bay
            put_posts(picture, low, x, (0, 19, 23, depth - 2) if is_double else (0, 19))
            if is_barred and post in (0, bays):
                picture[low : low + (depth if is_double else 21), x - 1 : x + 1] = 0
            if post == bays:
                continue
            for rack in (1, 24) if is_double else (1,):
                for at in (3, 24, 45):
                    if draws.random() < full:
                        picture[low + rack : low + rack + 18, x + at : x + at + 18] = 0
    return groundplan.survey(picture, resolution=0.05)


@pytest.mark.parametrize("seed", [64, 131, 188, 214])
def test_a_way_as_wide_as_bays_past_the_ends_of_some_rows_leads_past_all_that_leave_it_free(seed: int) -> None:
    survey = racks(seed)
    types = [junction["type"] for junction in survey.of_kind("junction")]
    assert types.count("end") == 0 and types.count("L") == 4


@pytest.mark.parametrize("full", [1, 2])
def test_no_way_leads_along_a_wall_over_last_bays_of_which_one_rack_of_two_is_full(full: int) -> None:
    # Four rows of nine bays of 2.7 m on posts, the last of them at the wall, and of these all are empty but that one.
    draws, bay, depth, aisle, first = np.random.default_rng(full), 54, 44, 60, 80  # pixels of 0.05 m
    picture = walled(first + 9 * bay, 4 * depth + 5 * aisle)
    for row in range(4):
        low = 20 + aisle + row * (aisle + depth)
        for post in range(10):
            x = 20 + first + post * bay
            put_posts(picture, low, x, (0, 19, 23, depth - 2))
            for rack in (0, 1):
                is_full = draws.random() < 0.8 if post < 8 else post == 8 and (row, rack) == (full, 0)
                if is_full:
                    picture[low + 1 + 23 * rack : low + 19 + 23 * rack, x + 3 : x + 51] = 0
    survey = groundplan.survey(picture, resolution=0.05)
    assert sum(junction["type"] == "end" for junction in survey.of_kind("junction")) == 5


@pytest.mark.parametrize("gap", [48, 54, 60])
@pytest.mark.parametrize(("rows", "short"), [(5, 3), (4, 2), (5, 2)])
def test_a_way_as_wide_as_a_bay_leads_past_rows_that_end_at_bars_before_an_office(
    rows: int, short: int, gap: int
) -> None:
    """Rows of 14 bays of 3 m on posts, some four bays shorter, and a way of 3.6 m across all.

    Of each bay one rack is full.
    """
    draws, bay, depth, aisle, first, cross = np.random.default_rng(rows), 60, 44, 60, 80, 72  # pixels of 0.05 m
    picture = walled(2 * first + 14 * bay + cross, (rows + 1) * aisle + rows * depth)
    for row in range(rows):
        low = 20 + aisle + row * (aisle + depth)
        for left, bays in ((20 + first, 5), (20 + first + 5 * bay + cross, 5 if row < short else 9)):
            for post in range(bays + 1):
                put_posts(picture, low, left + post * bay, (0, 19, 23, depth - 2))
            for x in (left, left + bays * bay):
                picture[low : low + depth, x - 1 : x + 1] = 0
            for n, rack in enumerate(draws.integers(0, 2, bays)):
                x = left + n * bay
                picture[low + 1 + 23 * rack : low + 20 + 23 * rack, x + 3 : x + bay - 3] = 0
    office, end = 20 + first + 10 * bay + cross + gap, 20 + short * (aisle + depth)
    picture[18:end, office:] = 0
    picture[20 : end - 2, office + 2 : -20] = 205
    survey = groundplan.survey(picture, resolution=0.05)
    assert min(way["width"] for way in survey.of_kind("corridor")) == pytest.approx(gap * 0.05, abs=0.1)
    assert all(junction["type"] != "end" for junction in survey.of_kind("junction"))


@pytest.mark.parametrize("rows", [5, 12])
@pytest.mark.parametrize("side", ["east", "west"])
def test_the_way_along_the_wall_is_one_though_pillars_stand_in_it(side: str, rows: int) -> None:
    """Rows 2.4 m deep end 5.5 m before a wall; pillars of 0.5 m stand 1.9 m before that, one every 2.5 m."""
    aisle, rack = 3.0, 2.4
    depth = aisle + (aisle + rack) * rows
    y, x = np.mgrid[-1.0 : depth + 1.0 : 0.05, -1.0:31.0:0.05]
    picture = np.full(x.shape, 205, dtype=np.uint8)
    picture[(x > -0.2) & (x < 30.2) & (y > -0.2) & (y < depth + 0.2)] = 0
    picture[(x > 0) & (x < 30) & (y > 0) & (y < depth)] = 254
    for row in range(rows):
        low = aisle + (aisle + rack) * row
        picture[(x > 3) & (x < 24.5) & (y > low) & (y < low + rack)] = 0
    for at in np.arange(1.7, depth, 2.5):
        picture[(abs(x - 27.85) < 0.25) & (abs(y - at) < 0.25)] = 0
    survey = groundplan.survey(np.ascontiguousarray(picture if side == "east" else picture[:, ::-1]), resolution=0.05)
    widths = sorted(way["width"] for way in survey.of_kind("corridor") if way["name"].startswith("C"))
    assert widths == pytest.approx([3.0, 5.5], abs=0.2)
    kinds = sorted(label["type"] for label in survey.of_kind("junction"))
    assert kinds == ["L"] * 4 + ["T"] * (2 * rows - 2)


@pytest.mark.parametrize("single", [0.9, 1.2, 1.4])
def test_a_way_leads_past_few_rows_that_end_alike_before_an_office_which_the_next_aisle_passes(single: float) -> None:
    """Three single rows: two end 3 m before the wall of an office of 11 m by 9 m, along the third an aisle leads on."""
    y, x = np.mgrid[-1.0:17.0:0.05, -1.0:47.0:0.05] + 0.025
    is_office = (x > 34.0) & (y > 8.0)
    picture = np.full(x.shape, 205, dtype=np.uint8)
    picture[(x > -0.2) & (y > -0.2) & (x < 45.2) & (y < 16.2) & ~((x > 34.2) & (y > 8.2))] = 0
    picture[(x > 0) & (y > 0) & (x < 45) & (y < 16) & ~is_office] = 254
    for low, end in ((3.0, 42.0), (8.0 - single, 31.0), (12.0 - single, 31.0)):
        picture[(x > 3.0) & (x < end) & (y > low) & (y < low + single)] = 0
    survey = groundplan.survey(np.ascontiguousarray(picture[::-1]), resolution=0.05)
    beside = [label for label in survey.of_kind("junction") if abs(label["at"][0] - 33.5) < 1.0]
    assert sorted(label["type"] for label in beside) == ["L", "T", "T"]


@pytest.mark.parametrize(("head", "depth"), [(3.0, 1.8), (4.0, 2.4), (4.0, 2.7)])
def test_a_slit_behind_the_last_row_is_no_way_that_leads_on_past_its_end(head: float, depth: float) -> None:
    boxes = ((head, 3.0 + n * (3.0 + depth), 50.0 - head, (n + 1) * (3.0 + depth)) for n in range(4))
    survey = groundplan.survey(drawn(50.0, 4 * (3.0 + depth) + 0.4, boxes), resolution=0.05)
    assert sorted(label["type"] for label in survey.of_kind("junction")) == ["L"] * 4 + ["T"] * 4


@pytest.mark.parametrize("by", [(0, 9, 9, 0), (9, 9, 0, 0), (0, 0, 8, 8), (10, 0, 0, 10), (0, 9, 9, 9, 9, 0)])
def test_aisles_lead_over_open_floor_to_the_way_that_others_beside_them_lead_to(by: tuple[int, ...]) -> None:
    boxes = ((4.0, 3.0 + 5.2 * n, 40.0 - early, 5.2 + 5.2 * n) for n, early in enumerate(by))
    survey = groundplan.survey(drawn(43.0, 3.0 + 5.2 * len(by), boxes), resolution=0.05)
    assert sorted(label["type"] for label in survey.of_kind("junction")) == ["L"] * 4 + ["T"] * 2 * (len(by) - 1)


def test_aisles_lead_past_goods_to_the_way_before_them_though_those_of_another_zone_point_there_from_afar() -> None:
    def boxes() -> Iterator[Box]:
        yield from ((x, 3.0, x + 2.2, 13.0) for x in (3.0, 8.2, 13.4, 18.6))
        yield 23.8, 3.0, 25.0, 13.0
        for y in (18.0, 23.2, 28.4):
            yield 4.0, y, 20.5, y + 2.2
            yield 22.0, y + 2.5, 23.0, y + 3.7

    survey = groundplan.survey(drawn(28.0, 33.6, boxes()), resolution=0.05)
    assert len(survey.of_kind("junction")) == 19


@pytest.mark.parametrize(("to_wall", "ends"), [({0}, 1), ({3}, 1), ({2, 3}, 2)], ids=str)
def test_a_way_leads_along_a_wall_up_to_the_row_that_goes_on_to_it(to_wall: set[int], ends: int) -> None:
    # Four rows 5.5 m before the west wall and 3.5 m before the east wall, but for those.
    rows = ((5.5, 3 + 5 * n, 40 if n in to_wall else 36.5, 5 + 5 * n) for n in range(4))
    survey = groundplan.survey(drawn(40, 23, rows), resolution=0.05)
    kinds = sorted(label["type"] for label in survey.of_kind("junction"))
    assert kinds == ["L"] * 4 + ["T"] * (6 - ends) + ["end"] * ends


@pytest.mark.parametrize("free", [3, 4, 5])
def test_the_two_aisles_of_a_row_meet_before_a_corner_of_the_hall(free: int) -> None:
    # Beside it two rows end before a wall that stands 6 m farther in.
    boxes: list[Box] = [(4, 3, 40 - free, 5), (4, 8, 31, 10), (4, 13, 31, 15), (34, 8, 40, 18)]
    survey = groundplan.survey(drawn(40, 18, iter(boxes)), resolution=0.05)
    assert sorted(label["type"] for label in survey.of_kind("junction")) == ["L"] * 5 + ["T"] * 4


def before_a_corner(seed: int) -> Picture:
    """Rows on posts, in bays of 3.1 m and 2.9 m from the walls.

    Two are full for the most part, and two, nearly empty, begin before a corner of the hall.
    """
    draws = np.random.default_rng(seed)
    bay, bays, depth, way = 62, 12, 38, 58
    picture = walled(2 * way + bays * bay, 5 * way + 4 * depth)
    left, low = 20 + 5 * bay, 10 + 3 * way + 2 * depth
    picture[low:, :left] = UNKNOWN
    picture[low : low + 2, 20 : left + 2] = picture[low:, left : left + 2] = OCCUPIED
    for row, (first, full) in enumerate([(0, 0.8), (0, 0.8), (5, 0.08), (5, 0.08)]):
        rack = picture[20 + way + row * (way + depth) :][:depth]
        for x in (20 + way + number * bay for number in range(first, bays + 1)):
            rack[:3, x - 1 : x + 2] = rack[-3:, x - 1 : x + 2] = OCCUPIED
        for x in (20 + way + number * bay for number in range(first, bays)):
            if draws.random() < full:
                rack[1:-1, x + 3 : x + bay - 2] = OCCUPIED
    return picture


@pytest.mark.parametrize("seed", [3, 5])
def test_a_way_along_the_wall_past_rows_of_posts_is_told_by_one_as_wide_past_full_rows(seed: int) -> None:
    survey = groundplan.survey(before_a_corner(seed), resolution=0.05)
    assert [junction for junction in survey.of_kind("junction") if junction["type"] == "end"] == []


def along_a_turned_wall(seed: int, lean: float) -> Picture:
    """Half-empty rows in two blocks with frames at their ends and beside many a bay, 2 m before a wall.

    Drift has turned the wall and the ends by so many pixels from row to row, 4.8 m.
    """
    draws = np.random.default_rng(seed)
    rows, bay, bays, depth, aisle, end, way = 8, 66, 6, 30, 66, 62, 56
    length = 2 * bays * bay + way
    picture = walled(2 * end + length + 44, (rows + 1) * aisle + rows * depth)
    for y in range(18, picture.shape[0] - 18):
        x = int(20 + end + length + 40 + lean * (y - 20) / (aisle + depth) - lean * rows / 2)
        picture[y, x : x + 3], picture[y, x + 3 :] = OCCUPIED, UNKNOWN
    for row in range(rows):
        rack = picture[20 + aisle + row * (aisle + depth) :][:depth]
        for block in range(2):
            left = 20 + end + block * (bays * bay + way) + lean * (row + 0.5 - rows / 2) * (block + 1) / 2
            for number, x in enumerate(round(left + bay * number) for number in range(bays + 1)):
                rack[:3, x - 1 : x + 2] = rack[-3:, x - 1 : x + 2] = OCCUPIED
                if number in (0, bays) or draws.random() < 0.4:
                    rack[:, x - 1 : x + 1] = OCCUPIED
                if number < bays and draws.random() < 0.35:
                    rack[1:-1, x + 3 : x + bay - 3] = OCCUPIED
    return picture


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("lean", [2.0, 2.5])
def test_aisles_meet_the_way_along_a_wall_that_drift_has_turned(lean: float, seed: int) -> None:
    survey = groundplan.survey(along_a_turned_wall(seed, lean), resolution=0.05)
    assert [junction for junction in survey.of_kind("junction") if junction["type"] == "end"] == []


def up_to_a_row(ends: tuple[int, int, int, int], length: int) -> Picture:
    """Four rows of niches that end so much before the east wall; one goes on to it."""
    aisle, depth = 26, 20
    picture = walled(length + 40, 5 * aisle + 4 * depth)
    draws = np.random.default_rng(1)
    for row, off in enumerate(ends):
        low, right = 20 + aisle + row * (aisle + depth), 20 + length + 40 - off
        picture[low : low + depth, 20:right] = 0
        picture[low + 3 : low + depth - 3, 20 : right - 3] = UNKNOWN
        for x in range(24, right - 20, 18):
            niche = draws.integers(4)
            if niche < 2:
                top = low + niche * (depth // 2 + 2)
                picture[top : top + depth // 2 - 2, x : x + 15] = 254
    return picture


@pytest.mark.parametrize("length", [120, 200, 260])
@pytest.mark.parametrize("ends", [(44, 40, 0, 44), (40, 45, 0, 45)])
def test_a_way_leads_past_two_rows_that_end_nearly_in_line_though_the_next_goes_on_to_the_wall(
    ends: tuple[int, int, int, int], length: int
) -> None:
    survey = groundplan.survey(up_to_a_row(ends, length), resolution=0.05)
    kinds = [junction["type"] for junction in survey.of_kind("junction") if junction["at"][0] > length * 0.05]
    assert kinds.count("L") == 2 and kinds.count("T") == 1


def short_of_the_wall(gap: int, clear: int = 0) -> groundplan.Survey:
    """Two rows of two racks with frames; one ends so much before the west wall, the other keeps so clear of it."""
    bay, way, aisle, depth = 54, 76, 66, 46
    left = 20 + gap + 2 * bay
    picture = walled(left - 20 + way + 5 * bay + 70, 3 * aisle + 2 * depth)

    def rack(low: int, first: int, bays: int) -> None:
        for n in range(bays + 1):
            picture[low : low + depth, first + n * bay - 1 : first + n * bay + 2] = 0
        for n in range(bays):
            if n in (0, 1, 3):
                picture[low + 3 : low + depth - 3, first + n * bay + 5 : first + (n + 1) * bay - 4] = 0
            picture[low + depth // 2 - 1 : low + depth // 2 + 1, first + n * bay : first + (n + 1) * bay] = 0

    rack(20 + aisle, 20 + gap, 2)
    rack(20 + 2 * aisle + depth, 21 + clear, (left - 20 - clear) // bay)
    for low in (20 + aisle, 20 + 2 * aisle + depth):
        rack(low, left + way, 5)
    return groundplan.survey(picture, resolution=0.05)


@pytest.mark.parametrize(("gap", "corners"), [(54, 2), (60, 2), (72, 4), (78, 4), (84, 4)])
def test_past_the_end_of_one_row_a_way_as_wide_as_others_is_none_if_it_may_be_a_bay_that_is_empty(
    gap: int, corners: int
) -> None:
    # From post to post it is 2.7 m, and others are 3.8 m wide; past the end there are 1 to 1.6 bays.
    kinds = [junction["type"] for junction in short_of_the_wall(gap).of_kind("junction")]
    assert kinds.count("L") == corners


def test_past_the_end_of_one_row_an_empty_bay_is_none_though_the_rows_keep_clear_of_the_wall() -> None:
    kinds = [junction["type"] for junction in short_of_the_wall(54 + 18, clear=18).of_kind("junction")]
    assert kinds.count("L") == 2
