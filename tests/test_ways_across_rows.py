"""Which gaps in rows of racks are ways across them and which are empty bays, on maps that no simulator made up."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from _legs import put_posts
from zoo import FREE, OCCUPIED, UNKNOWN, Canvas, Picture, walled

import groundplan
from groundplan import simulate
from groundplan.evaluate import score

RESOLUTION = 0.05
AISLE, DEPTH = 56, 20  # pixels: 2.8 m between rows, two racks of 1 m back to back
BAY, BAYS = 42, 6


def racks_of_legs(seed: int) -> Picture:
    """A hall of 36 m by 12.4 m with two rows of racks in two blocks, four bays of ten empty and the legs seen there.

    A way of 4.2 m, as wide as two bays, lies between the blocks, and one of 3.5 m at either wall.
    """
    return legs(seed, full=0.6, aisle=AISLE, depth=DEPTH, rows=2, blocks=(BAYS,) * 2, way=84, end=70)


def rows_as_deep_as_aisles_are_wide(seed: int) -> Picture:
    """Three rows in three blocks: 2.2 m deep, as aisles are wide, and most bays empty."""
    return legs(seed, full=0.28, aisle=44, depth=22, rows=3, blocks=(4,) * 3, way=80, end=80)


def posts_of_every_second_bay(bay: int) -> Picture:
    """A hall of 28 m with two rows of eight bays, five full, and of the posts of one bay both are hardly ever seen."""
    return legs(15, bay=bay, full=0.6, aisle=72, depth=18, rows=2, blocks=(8,), way=0, end=80)


def legs(
    seed: int,
    *,
    full: float,
    aisle: int,
    depth: int,
    rows: int,
    blocks: tuple[int, ...],
    way: int,
    end: int,
    bay: int = BAY,
    empty: int | None = None,
) -> Picture:
    """Rows of two racks back to back, in blocks of so many bays: a share is full, the others show their legs.

    One row may be empty.
    """
    draws = np.random.default_rng(seed)
    lefts = [20 + end + bay * sum(blocks[:n]) + way * n for n in range(len(blocks))]
    picture = walled(2 * end + bay * sum(blocks) + way * (len(blocks) - 1), (rows + 1) * aisle + 2 * rows * depth)
    for number, row in enumerate(20 + aisle + n * (aisle + 2 * depth) for n in range(rows)):
        for left, bays in zip(lefts, blocks, strict=True):
            for rack in (row, row + depth):
                for post in range(bays + 1):
                    x = min(max(left + post * bay - 1, left), left + bays * bay - 2)
                    picture[rack : rack + 2, x : x + 2] = picture[rack + depth - 2 : rack + depth, x : x + 2] = 0
                for x in (left + bay * np.flatnonzero(draws.random(bays) < full * (number != empty))).tolist():
                    picture[rack + 1 : rack + depth - 1, x + 2 : x + bay - 2] = 0
    return picture


def shelves(empty: list[tuple[int, int]], rows: int = 3) -> Picture:
    """A hall with rows of six shelves of 2.6 m between ways of 3.6 m; of the rows given shelves are empty."""
    bay, end = 52, 72
    picture = walled(2 * end + 6 * bay, (rows + 1) * AISLE + 2 * rows * DEPTH)
    for row in range(rows):
        low = 20 + AISLE + row * (AISLE + 2 * DEPTH)
        picture[low : low + 2 * DEPTH, 20 + end : 20 + end + 6 * bay] = 0
        for _, shelf in (place for place in empty if place[0] == row):
            left = 20 + end + shelf * bay
            picture[low : low + 2 * DEPTH, left : left + bay] = 254
    return picture


@pytest.mark.parametrize("seed", [2, 3, 4, 5, 39])
def test_a_way_through_two_half_empty_rows_is_told_by_the_legs_that_do_not_stand_in_it(seed: int) -> None:
    survey = groundplan.survey(racks_of_legs(seed), resolution=RESOLUTION)
    across = [way for way in survey.of_kind("corridor") if way["name"].startswith("C")]
    assert sorted(way["axis"][0][0] for way in across) == pytest.approx([2.75, 19.2, 35.65], abs=0.3)
    crossings = [junction["type"] for junction in survey.of_kind("junction")]
    assert sorted(crossings) == ["L"] * 4 + ["T"] * 4 + ["X"]


@pytest.mark.parametrize("seed", [9, 20, 138])
def test_posts_that_recur_across_rows_as_deep_as_aisles_are_wide_make_no_bays_of_the_aisles(seed: int) -> None:
    survey = groundplan.survey(rows_as_deep_as_aisles_are_wide(seed), resolution=RESOLUTION)
    assert [way["width"] for way in survey.of_kind("corridor")] == pytest.approx([2.2] * 4 + [4.0] * 4, abs=0.2)
    crossings = [junction["type"] for junction in survey.of_kind("junction")]
    assert sorted(crossings) == ["L"] * 4 + ["T"] * 8 + ["X"] * 4


@pytest.mark.parametrize(
    ("seed", "rows", "way", "end", "empty"),
    [
        *((seed, 2, 40, 90, None) for seed in (1, 33)),
        *((seed, 3, 44, 70, 0) for seed in (6, 18, 23)),
    ],
)
def test_a_way_as_wide_as_a_bay_is_told_by_the_rows_though_those_at_the_walls_are_wider(
    seed: int, rows: int, way: int, end: int, empty: int | None
) -> None:
    # Of an empty row the legs recur right over the way.
    full = 0.6 if empty is None else 0.7
    picture = legs(seed, full=full, aisle=AISLE, depth=DEPTH, rows=rows, blocks=(6, 6), way=way, end=end, empty=empty)
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    crossings = [junction["type"] for junction in survey.of_kind("junction")]
    assert sorted(crossings) == ["L"] * 4 + ["T"] * (2 * rows) + ["X"] * (rows - 1)


@pytest.mark.parametrize("seed", [108, 109, 110])
def test_half_empty_rows_without_a_way_have_none(seed: int) -> None:
    picture = legs(seed, full=0.25, aisle=AISLE, depth=DEPTH, rows=2, blocks=(12,), way=0, end=60)
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    assert sorted(junction["type"] for junction in survey.of_kind("junction")) == ["L"] * 4 + ["T"] * 2


@pytest.mark.parametrize("bay", [50, 54])
def test_two_bays_are_not_taken_for_one_where_posts_are_seen_at_every_second(bay: int) -> None:
    survey = groundplan.survey(posts_of_every_second_bay(bay), resolution=RESOLUTION)
    assert [way["width"] for way in survey.of_kind("corridor")] == pytest.approx([3.6] * 3 + [4.0] * 2, abs=0.25)
    assert sorted(junction["type"] for junction in survey.of_kind("junction")) == ["L"] * 4 + ["T"] * 2


@pytest.mark.parametrize(
    ("empty", "rows"), [([], 3), ([(0, 2)], 3), ([(1, 3)], 3), ([(0, 1), (2, 4)], 3), ([(0, 2), (3, 4)], 6)]
)
def test_an_empty_shelf_in_one_row_is_no_way_where_those_through_all_rows_are_wider(
    empty: list[tuple[int, int]], rows: int
) -> None:
    # Through six rows the ways are longer than the rows.
    survey = groundplan.survey(shelves(empty, rows), resolution=RESOLUTION)
    across = [way["width"] for way in survey.of_kind("corridor") if way["name"].startswith("C")]
    assert across == pytest.approx([3.6, 3.6], abs=0.15)


def test_a_gap_as_wide_as_the_ways_of_the_place_is_a_way_though_it_leads_through_one_row() -> None:
    picture = shelves([])
    low = 20 + 2 * AISLE + 2 * DEPTH
    picture[low : low + 2 * DEPTH, 210:282] = 254
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    across = [way["width"] for way in survey.of_kind("corridor") if way["name"].startswith("C")]
    assert across == pytest.approx([3.6] * 3, abs=0.15)


@pytest.mark.parametrize(("rows", "gap"), [(2, 50), (3, 50)])
def test_a_gap_in_each_full_row_of_two_racks_is_a_way_though_not_as_wide_as_those_at_the_walls(
    rows: int, gap: int
) -> None:
    # One in each row, at a place of its own.
    picture = shelves([], rows=rows)
    for row in range(rows):
        low = 20 + AISLE + row * (AISLE + 2 * DEPTH)
        left = 20 + 72 + 60 + 70 * row
        picture[low : low + 2 * DEPTH, left : left + gap] = 254
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    across = sorted(way["width"] for way in survey.of_kind("corridor") if way["name"].startswith("C"))
    assert across == pytest.approx(sorted([3.6, 3.6, *[gap * RESOLUTION] * rows]), abs=0.15)


def test_a_gap_longer_than_beams_are_is_no_empty_bay() -> None:
    picture = shelves([])
    low = 20 + AISLE
    picture[low : low + 2 * DEPTH, 200:292] = 254
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    across = sorted(way["width"] for way in survey.of_kind("corridor") if way["name"].startswith("C"))
    assert across == pytest.approx([3.6, 3.6, 4.6], abs=0.15)


@pytest.mark.parametrize("at", [4.0, 9.0, 15.6])
def test_a_gap_as_wide_as_a_pallet_is_no_way_between_aisles_for_trucks(at: float) -> None:
    # One row of 24 m by 2.4 m with aisles of 3 m on both sides, 3 m from the walls at its ends.
    picture = walled(600, 168)
    picture[80:128, 80:560] = 0
    left = 80 + round(at / RESOLUTION)
    picture[80:128, left : left + 24] = 254
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    assert sorted(way["width"] for way in survey.of_kind("corridor")) == pytest.approx([3.0] * 4, abs=0.15)
    assert [junction["type"] for junction in survey.of_kind("junction")] == ["L"] * 4


def test_aisles_as_narrow_lead_between_racks_side_by_side() -> None:
    # Racks of 2.4 m by 8 m, 1.2 m apart, with ways of 3 m before their ends and of 2.4 m at the walls beside them.
    picture = walled(720, 280)
    for n in range(9):
        picture[80:240, 20 + 48 + n * 72 : 20 + 96 + n * 72] = 0
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    narrow = [way for way in survey.of_kind("corridor") if way["width"] < 2]
    assert len(narrow) == 8


def test_ways_staggered_from_row_to_row_need_not_be_as_wide_as_those_at_the_walls() -> None:
    # Four rows of 16 bays of 3 m between posts, with goods in all of them, and in each row a way of 3.8 m at a place of
    # its own; ways of 5 m and 6.2 m at the walls.
    picture = walled(1260, 4 * 46 + 5 * 60)
    for row, bays in enumerate((4, 11, 6, 13)):
        low = 20 + 60 + row * 106
        for start, count in ((0, bays), (60 * bays + 76, 16 - bays)):
            for bay in range(count + 1):
                x = 20 + 100 + start + 60 * bay
                for face in (0, 18, 26, 44):
                    picture[low + face : low + face + 2, x - 1 : x + 1] = 0
                for at in () if bay == count else (3, 31):
                    for goods in (1, 27):
                        picture[low + goods : low + goods + 18, x + at : x + at + 26] = 0
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    assert sorted(junction["type"] for junction in survey.of_kind("junction")) == ["L"] * 4 + ["T"] * 14
    across = [way["width"] for way in survey.of_kind("corridor") if way["name"].startswith("C")]
    assert sorted(across) == pytest.approx([3.8] * 4 + [5.0, 6.2], abs=0.2)


@pytest.mark.parametrize("row", [0, 1, 2])
def test_a_way_staggered_as_others_are_is_known_though_one_of_two_racks_at_its_side_is_empty(row: int) -> None:
    # Three rows of two racks of 1 m back to back, 28 m long, and in each a way of 3.2 m at a place of its own. Shelves
    # of 2.6 m are empty here and there, one of them at a side of one of the ways.
    empty = [(0, 0, 120), (1, 1, 460), (2, 0, 480)]
    picture = walled(560 + 144, 3 * 2 * DEPTH + 4 * AISLE)
    for n, way in enumerate((380, 180, 300)):
        low = 20 + AISLE + n * (AISLE + 2 * DEPTH)
        picture[low : low + 2 * DEPTH, 20 + 72 : 20 + 72 + 560] = 0
        picture[low : low + 2 * DEPTH, 92 + way : 92 + way + 64] = 254
        places = [(rack, left) for of, rack, left in empty if of == n] + [(1, way - 52) for _ in range(n == row)]
        for rack, left in places:
            picture[low + rack * DEPTH : low + (rack + 1) * DEPTH, 92 + left : 92 + left + 52] = 254
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    across = [way["width"] for way in survey.of_kind("corridor") if way["name"].startswith("C")]
    assert sorted(across) == pytest.approx([3.2] * 3 + [3.6] * 2, abs=0.15)
    assert sorted(junction["type"] for junction in survey.of_kind("junction")) == ["L"] * 4 + ["T"] * 10


def test_one_way_in_each_row_at_a_place_of_its_own_is_narrower_than_those_at_the_walls() -> None:
    # Five rows of 1.4 m by 30 m, a way of 1.8 m through each, and ways of 3.2 m past their ends.
    picture = walled(600 + 128, 5 * 28 + 6 * 44)
    for row, way in enumerate((120, 400, 260, 500, 180)):
        low = 20 + 44 + row * 72
        picture[low : low + 28, 84 : 84 + 600] = 0
        picture[low : low + 28, 84 + way : 84 + way + 36] = 254
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    across = [way["width"] for way in survey.of_kind("corridor") if way["name"].startswith("C")]
    assert sorted(across) == pytest.approx([1.8] * 5 + [3.2] * 2, abs=0.15)


@pytest.mark.parametrize("ways", [(380, 380, 250, 120), (100, 330, 330, 200), (420, 180, 300, 90)])
def test_a_gap_in_each_row_is_a_way_where_hardly_a_shelf_is_empty(ways: tuple[int, ...]) -> None:
    # Four rows of 1.15 m by 28 m that begin at a wall, a gap of 2.1 m in each; a way of 4.1 m past their ends.
    picture = walled(560 + 82, 4 * 23 + 5 * 46)
    for row, way in enumerate(ways):
        low = 20 + 46 + row * 69
        picture[low : low + 23, 20 : 20 + 560] = 0
        picture[low : low + 23, 20 + way : 20 + way + 42] = 254
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    across = [way["width"] for way in survey.of_kind("corridor") if way["name"].startswith("C")]
    gaps = len(ways) - sum(one == two for one, two in itertools.pairwise(ways))
    assert sorted(across) == pytest.approx([2.1] * gaps + [4.1], abs=0.15)


def rows_on_posts(seed: int, ways: tuple[int, ...], gap: int) -> Picture:
    """Rows of 14 bays of 3 m between posts, the goods of three in ten missing, each with a gap after so many bays."""
    draws = np.random.default_rng(seed)
    picture = walled(840 + gap + 180, len(ways) * 40 + (len(ways) + 1) * AISLE)
    for row, bays in enumerate(ways):
        low = 20 + AISLE + row * (AISLE + 40)
        for start, count in ((0, bays), (60 * bays + gap, 14 - bays)):
            for post in range(count + 1):
                x = 20 + 90 + start + 60 * post
                for face in (0, 16, 22, 38):
                    picture[low + face : low + face + 2, x - 1 : x + 1] = 0
                for at, goods in ((3, 1), (3, 23), (31, 1), (31, 23)) if post < count else ():
                    # At the gap there are some on either side.
                    if draws.random() < 0.7 or post == (count - 1 if start == 0 else 0):
                        picture[low + goods : low + goods + 16, x + at : x + at + 26] = 0
    return picture


@pytest.mark.parametrize("seed", range(3))
def test_a_way_narrower_than_a_bay_is_told_by_posts_that_are_out_of_step_beyond_it(seed: int) -> None:
    survey = groundplan.survey(rows_on_posts(seed, (7,), 50), resolution=RESOLUTION)
    across = [way["width"] for way in survey.of_kind("corridor") if way["name"].startswith("C")]
    assert sorted(across) == pytest.approx([2.4] + [4.4] * 2, abs=0.2)


@pytest.mark.parametrize("ways", [(7,), (9, 6)])
@pytest.mark.parametrize("seed", range(4))
def test_a_bay_in_step_with_the_others_is_no_way(seed: int, ways: tuple[int, ...]) -> None:
    survey = groundplan.survey(rows_on_posts(seed, ways, 60), resolution=RESOLUTION)
    across = [way["width"] for way in survey.of_kind("corridor") if way["name"].startswith("C")]
    assert sorted(across) == pytest.approx([4.4] * 2, abs=0.2)


def pallets(ends: tuple[int, int], count: int, taken: list[set[int]], off: int = 0) -> Picture:
    """A hall with a rack of bays of 2.7 m on posts in each row, between ways as wide as given, in pixels.

    Of each row goods stand in the bays given, two pallets in each; posts of every other row stand so many pixels off.
    """
    bay, depth = 54, 22
    picture = walled(sum(ends) + count * bay, len(taken) * (AISLE + depth) + AISLE)
    for row, bays in enumerate(taken):
        low = 20 + AISLE + row * (AISLE + depth)
        for post in range(count + 1):
            x = 20 + ends[0] + post * bay + row % 2 * off
            for y in (low, low + depth - 2):
                picture[y : y + 2, x - 1 : x + 1] = 0
        for x in (20 + ends[0] + n * bay + at for n in bays for at in (3, 28)):
            picture[low + 1 : low + depth - 1, x : x + 23] = 0
    return picture


@pytest.mark.parametrize("seed", [0, 3, 4, 5])
def test_ways_as_wide_as_bays_lead_past_the_ends_of_rows_though_the_last_bays_are_empty(seed: int) -> None:
    draws = np.random.default_rng(seed)
    taken = [set(np.flatnonzero(draws.random(8) < 0.5).tolist()) for _ in range(2)]
    survey = groundplan.survey(pallets((54, 54), 8, taken, off=4), resolution=RESOLUTION)
    assert sorted(junction["type"] for junction in survey.of_kind("junction")) == ["L"] * 4 + ["T"] * 2


@pytest.mark.parametrize(("seed", "rows", "count", "fill"), [(4, 4, 5, 0.7), (5, 3, 6, 0.6)])
def test_a_way_through_rows_leads_on_through_the_next_where_the_bays_beside_it_are_empty(
    seed: int, rows: int, count: int, fill: float
) -> None:
    # Two racks back to back in each row, two blocks of bays of 2.7 m, a way of 2.5 m between them, 3 m from the walls.
    # Of the last row the bays beside that way are empty, and its posts stand about as far apart as all others.
    bay, depth, way, end = 54, 22, 50, 60
    draws = np.random.default_rng(seed)
    picture = walled(2 * end + 2 * count * bay + way, rows * (AISLE + 2 * depth + 3) + AISLE)
    for rack in range(2 * rows):
        low = 20 + AISLE + rack // 2 * (AISLE + 2 * depth + 3) + rack % 2 * (depth + 3)
        taken = set(np.flatnonzero(draws.random(2 * count) < fill).tolist())
        if rack >= 2 * rows - 2:
            taken -= {count - 1, count}
        for block in range(2):
            left = 20 + end + block * (count * bay + way)
            for post in range(count + 1):
                x = min(max(left + post * bay - 1, left), left + count * bay - 2)
                for y in (low, low + depth - 2):
                    picture[y : y + 2, x : x + 2] = 0
            for n in range(count):
                for x in (left + n * bay + at for at in (3, 28) if n + block * count in taken):
                    picture[low + 1 : low + depth - 1, x : x + 23] = 0
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    expected = ["L"] * 4 + ["T"] * 2 * rows + ["X"] * (rows - 1)
    assert sorted(junction["type"] for junction in survey.of_kind("junction")) == expected


@pytest.mark.parametrize("empty", [(1,), (1, 2), (0, 3)])
@pytest.mark.parametrize(("bay", "deep"), [(60, 24), (70, 48)])
def test_an_empty_last_bay_beside_a_way_is_none(empty: tuple[int, ...], bay: int, deep: int) -> None:
    # A way of 3.2 m through four rows, and 0.1 m of guard between it and what is as wide in one row or two.
    left, way, right = 20 + 80, 64, 420
    middle = left + 240
    picture = walled(160 + 240 + way + right, 4 * (60 + deep) + 60)
    for n in range(4):
        row = picture[80 + n * (60 + deep) :][:deep]
        row[:, left:middle] = 0
        row[:, middle + way : middle + way + right] = 0
        if n in empty:
            row[:, middle + way + 2 : middle + way + bay] = 254
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    assert sorted(junction["type"] for junction in survey.of_kind("junction")) == ["L"] * 4 + ["T"] * 8 + ["X"] * 3


@pytest.mark.parametrize(("seed", "sparse"), [(401, 0.5), (413, 0.35), (418, 0.5)])
def test_many_half_empty_rows_that_nothing_leads_through_have_no_way(seed: int, sparse: float) -> None:
    options = simulate.WarehouseOptions(sparse=sparse, cross_aisles=0, width=70.0, depth=45.0)
    survey = groundplan.survey(simulate.warehouse(options, seed=seed).map)
    assert len([way for way in survey.of_kind("corridor") if way["name"].startswith("C")]) == 2


@pytest.mark.parametrize(
    "options",
    [
        {"seed": 45, "yaw": -27.4, "width": 44, "depth": 22, "aisle": 2.5, "cross_aisle": 2.9, "bay": 2.47}
        | {"rack_depth": 0.9, "sparse": 0.4, "staggered": 10.7},
        {"seed": 73, "yaw": -26.4, "width": 44, "depth": 18, "aisle": 2.9, "cross_aisle": 3.2, "bay": 2.89}
        | {"rack_depth": 1.06, "sparse": 0.1, "staggered": 7.0, "halls": 2, "gap": 0.5},
    ],
    ids=["one-hall", "two-halls"],
)
def test_staggered_ways_a_little_wider_than_bays_are_ways(options: dict[str, Any]) -> None:
    simulated = simulate.warehouse(**options, scan_every=0.8, beams=400)
    survey = groundplan.survey(simulated.map)
    assert score(survey.to_dict(), simulated.truth)["junction_typed_f1"] == 1


def two_halls(way: int) -> Picture:
    """Four rows of 14 bays of 3.4 m in one hall, and of 10 of 2.5 m in the next with a way through each, as drawn.

    Seven bays of ten are full, and nothing but posts stands at the ways.
    """
    draws = np.random.default_rng(2)

    def hall(bay: int, bays: int, places: list[int]) -> Picture:
        picture = walled(160 + bays * bay + way * bool(places), 5 * 60 + 4 * 44)
        for row in range(4):
            low, first = 80 + row * 104, places[row] if places else bays
            runs = [(100, first), (100 + first * bay + way, bays - first)]
            for left, count in runs if places else runs[:1]:
                for x in range(left, left + count * bay + 1, bay):
                    put_posts(picture, low, x, (0, 19, 23, 42))
                for x in range(left, left + count * bay, bay):
                    for rack in np.flatnonzero(draws.random(2) < 0.7):
                        picture[low + 1 + 23 * rack : low + 20 + 23 * rack, x + 4 : x + bay - 4] = 0
        return picture

    one = hall(68, 14, [])
    return np.hstack([one[:, :-19], hall(50, 10, draws.integers(2, 9, 4).tolist())[:, 19:]])


@pytest.mark.parametrize("way", [60, 64, 70])
def test_a_way_wider_than_its_own_halls_bays_is_one_though_those_of_the_next_hall_are_longer(way: int) -> None:
    ways = groundplan.survey(two_halls(way), resolution=RESOLUTION).of_kind("corridor")
    own = [found for found in ways if found["name"].startswith("C") and abs(found["width"] - way * RESOLUTION) < 0.25]
    assert len(own) >= 3


@pytest.mark.parametrize("places", [(170, 420, 560), (300, 150, 440, 560), (200, 420, 160, 380, 560)])
def test_a_way_through_each_row_is_none_less_where_one_row_is_seen_in_two_pieces(places: tuple[int, ...]) -> None:
    """Solid rows of 40 m, each with a way of 3.2 m; the last aisle was not seen in the middle."""
    depth, rows, length = 44, len(places), 800
    picture = walled(160 + length, (rows + 1) * 60 + rows * depth)
    for row, at in enumerate(places):
        low = 80 + row * (60 + depth)
        for left, right in ((100, 100 + at), (164 + at, 100 + length)):
            picture[low : low + depth, left:right] = 0
            picture[low + 2 : low + depth - 2, left + 2 : right - 2] = 205
    picture[20 + rows * (60 + depth) :, 280:520] = 205
    ways = groundplan.survey(picture, resolution=RESOLUTION).of_kind("corridor")
    across = sorted(way["width"] for way in ways if way["name"].startswith("C"))
    assert across == pytest.approx([3.3] * rows + [4.1] * 2, abs=0.1)


@pytest.mark.parametrize(("wall", "end"), [(1040, 240), (1060, 240), (1040, 400)])
def test_a_way_between_racks_and_an_office_ends_where_it_goes_on_as_a_wider_one(wall: int, end: int) -> None:
    hall = Canvas(1200, 800).room(38, 38, 1162, 762)
    for low in range(146, 706, 70):
        hall.box(120, low, 520, low + 44).box(600, low, 1000, low + 44)
    hall.box(wall, 38, wall + 4, end).box(wall, end - 4, 1162, end)
    found = groundplan.survey(hall.box(wall, 100, wall + 4, 120, FREE).picture, resolution=RESOLUTION)
    behind = [way for way in found.of_kind("corridor") if min(x for x, _ in way["axis"]) > 50]
    narrow, wide = sorted(behind, key=lambda way: float(way["width"]))
    assert narrow["width"] == pytest.approx((wall - 1000 + 4) * RESOLUTION, abs=0.2)
    assert wide["width"] == pytest.approx(7.9, abs=0.3)
    # Both reach the aisle behind the office; only a junction more is shared at most.
    (low, lap), (begins, high) = (sorted(y for _, y in way["axis"]) for way in (narrow, wide))
    assert low == pytest.approx(4.6, abs=0.2) and high == pytest.approx(36.0, abs=0.2)
    assert end * RESOLUTION < begins <= lap + 0.1 < begins + 4
    assert all(junction["type"] != "end" for junction in found.of_kind("junction"))


def solid_rows(
    depth: float, openings: list[list[float]], gap: float = 2.8
) -> tuple[Picture, list[tuple[float, float]]]:
    """Solid rows of 40 m between aisles of 2.5 m, open at some places, and where aisles meet the ways there."""
    aisle, head, length = 2.5, 3.5, 40.0
    height = aisle + len(openings) * (depth + aisle)
    width = length + 2 * head

    hall = Canvas(round((width + 2) / RESOLUTION), round((height + 2) / RESOLUTION))

    def fill(ends: tuple[float, float, float, float], value: int) -> None:
        x0, y0, x1, y1 = (round((at + 1) / RESOLUTION) for at in ends)
        hall.box(x0, y0, x1, y1, value)

    fill((-0.1, -0.1, width + 0.1, height + 0.1), OCCUPIED)
    fill((0, 0, width, height), FREE)
    meets = []
    for number, own in enumerate(openings):
        low = aisle + number * (depth + aisle)
        middles = [head + at for at in own]
        starts = [head, *(middle + gap / 2 for middle in middles)]
        ends = [*(middle - gap / 2 for middle in middles), head + length]
        for start, end in zip(starts, ends, strict=True):
            fill((start, low, end, low + depth), OCCUPIED)
            fill((start + 0.1, low + 0.1, end - 0.1, low + depth - 0.1), UNKNOWN)
        meets += [(1 + at, 1 + y) for at in middles for y in (low - aisle / 2, low + depth + aisle / 2)]
    return hall.picture, meets


@pytest.mark.parametrize("has_niche", [False, True])
@pytest.mark.parametrize("depth", [1.8, 2.4])
@pytest.mark.parametrize(
    "openings", [[[8, 30], [14], [22, 34], [18]], [[14], [26], [20], []], [[], [14, 22], [], [8, 19]]]
)
def test_what_is_open_of_solid_rows_of_two_racks_is_a_way_though_not_each_has_as_many(
    depth: float, openings: list[list[float]], has_niche: bool
) -> None:
    picture, meets = solid_rows(depth, openings)
    if has_niche:  # of 0.7 m, from half the depth of the lowest row to its upper face
        low, high = (round((3.5 + share * depth) / RESOLUTION) for share in (0.5, 1))
        picture[-high:-low, 480:494] = FREE
    found = groundplan.survey(picture, resolution=RESOLUTION)
    junctions = [junction["at"] for junction in found.of_kind("junction") if junction["type"] in "TX"]
    for meet in meets:
        assert min(np.hypot(*np.subtract(at, meet)) for at in junctions) < 0.3
    across = [np.ptp(way["axis"], axis=0) for way in found.of_kind("corridor")]
    assert sum(y > x and y < depth + 3 for x, y in across) == sum(len(own) for own in openings)


@pytest.mark.parametrize("gaps", [[[3, 9], [5], [8, 2], []], [[3], [10], [], [6]], [[4, 12], [], [2, 9], []]])
def test_what_both_of_two_racks_leave_open_where_one_alone_seldom_is_is_a_way_though_some_rows_have_none(
    gaps: list[list[int]],
) -> None:
    # Rows of two racks of 1 m back to back, 14 bays of 2.7 m long; here and there a bay of one rack is empty.
    bay, aisle, end = 54, 60, 72
    picture = walled(2 * end + 14 * bay, 5 * aisle + 8 * DEPTH)
    for row, own in enumerate(gaps):
        low, left = 20 + aisle + row * (aisle + 2 * DEPTH), 20 + end
        picture[low : low + 2 * DEPTH, left : left + 14 * bay] = 0
        for at in own:
            picture[low : low + 2 * DEPTH, left + at * bay : left + (at + 1) * bay] = 254
        for rack, at in {0: [(0, 6)], 2: [(1, 11)], 3: [(0, 3)]}.get(row, []):
            picture[low + rack * DEPTH :][:DEPTH, left + at * bay : left + (at + 1) * bay] = 254
    found = groundplan.survey(picture, resolution=RESOLUTION)
    across = [way["width"] for way in found.of_kind("corridor") if way["name"].startswith("C")]
    assert sorted(across) == pytest.approx([2.7] * sum(map(len, gaps)) + [3.6] * 2, abs=0.15)


@pytest.mark.parametrize(
    ("gaps", "are_ways"),
    [([[200], [], [350], []], True), ([[], [150], [300], [220]], True), ([[200], [], [], []], False)],
)
def test_gaps_of_rows_that_are_closed_everywhere_else_are_ways_though_narrower_than_that_through_all(
    gaps: list[list[int]], are_ways: bool
) -> None:
    # Solid rows of 1.1 m by 45 m with a way of 3.8 m through all of them, and gaps of 3 m: one by itself may be a bay.
    picture = walled(1048, 5 * 70 + 4 * 22)
    for row, own in enumerate(gaps):
        low = 90 + row * 92
        picture[low : low + 22, 94:994] = 0
        for left, right in [(694, 770), *((94 + at, 154 + at) for at in own)]:
            picture[low : low + 22, left:right] = 254
    found = groundplan.survey(picture, resolution=RESOLUTION)
    across = [way["width"] for way in found.of_kind("corridor") if way["name"].startswith("C")]
    assert sorted(across) == pytest.approx([3.0] * sum(map(len, gaps)) * are_ways + [3.8] * 3, abs=0.15)


def closed_rows(gaps: list[list[tuple[int, int]]], length: int = 520) -> Picture:
    """Rows of one rack 1 m deep, each with gaps from where to where, pixels; nobody saw what is inside of them."""
    end = 60
    picture = walled(2 * end + length, (len(gaps) + 1) * AISLE + len(gaps) * DEPTH)
    for n, row in enumerate(gaps):
        low = 20 + AISLE + n * (AISLE + DEPTH)
        edges = [0, *itertools.chain(*row), length]
        for left, right in zip(edges[::2], edges[1::2], strict=True):
            picture[low : low + DEPTH, 20 + end + left : 20 + end + right] = OCCUPIED
            picture[low + 2 : low + DEPTH - 2, 20 + end + left + 2 : 20 + end + right - 2] = UNKNOWN
    return picture


@pytest.mark.parametrize(
    "gaps",
    [
        [[(157, 205)], [(331, 397)], [(75, 131), (400, 460)]],
        [[(100, 144)], [(283, 349)]],
        [[(64, 93)], [(311, 349)], [(157, 189)], [(391, 429)]],  # two of them are less than 1.6 m wide
    ],
)
def test_staggered_gaps_of_any_widths_in_closed_rows_are_ways(gaps: list[list[tuple[int, int]]]) -> None:
    survey = groundplan.survey(closed_rows(gaps), resolution=RESOLUTION)
    ways = sum(map(len, gaps))
    expected = ["L"] * 4 + ["T"] * 2 * (len(gaps) - 1 + ways)
    assert sorted(junction["type"] for junction in survey.of_kind("junction")) == expected


def test_staggered_gaps_of_any_widths_are_ways_though_some_racks_are_empty_alone() -> None:
    gaps = [[(157, 205)], [(331, 397)], [(75, 131), (400, 460)]]
    picture = closed_rows(gaps)
    for row, left in ((0, 300), (1, 120)):  # of one of two racks back to back 3 m
        low, x = 20 + AISLE + row * (AISLE + DEPTH), 80 + left
        picture[low : low + DEPTH // 2, x - 2 : x + 62] = OCCUPIED
        picture[low : low + DEPTH // 2 - 2, x : x + 60] = FREE
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    assert sorted(junction["type"] for junction in survey.of_kind("junction")) == ["L"] * 4 + ["T"] * 12


@pytest.mark.parametrize("bay", [48, 52, 54])
def test_staggered_gaps_as_wide_as_a_bay_a_whole_number_of_bays_apart_are_empty_bays(bay: int) -> None:
    gaps = [[(bay * n, bay * (n + 1) - 2) for n in empty] for empty in ((2,), (), (5,), ())]
    survey = groundplan.survey(closed_rows(gaps, length=9 * bay), resolution=RESOLUTION)
    assert sorted(junction["type"] for junction in survey.of_kind("junction")) == ["L"] * 4 + ["T"] * 6


def guarded(rows: int, wide: int, narrow: int, guards: int) -> Picture:
    """Full rows of two racks with bays of 1.95 m, a wide way through all and one that guards leave 1.45 m of."""
    bay, depth, aisle, end = 39, 36, 92, 70
    blocks = (7, 6, 6)
    lefts = [20 + end, 20 + end + 7 * bay + narrow, 20 + end + 13 * bay + narrow + wide]
    picture = walled(lefts[2] - 20 + 6 * bay + end, rows * depth + (rows + 1) * aisle)
    for low in (20 + aisle + n * (aisle + depth) for n in range(rows)):
        for left, bays in zip(lefts, blocks, strict=True):
            for n in range(bays):
                for rack in (low, low + depth // 2):
                    picture[rack : rack + depth // 2 - 1, left + n * bay + 2 : left + (n + 1) * bay - 1] = 0
            for post in range(bays + 1):
                for face in (low, low + depth - 2):
                    picture[face : face + 2, left + post * bay - 1 : left + post * bay + 1] = 0
        for at in (lefts[0] + 7 * bay + guards, lefts[1] - guards):
            for face in (low, low + depth - 2):
                picture[face : face + 2, at - 1 : at + 1] = 0
    return picture


@pytest.mark.parametrize("rows", [4, 5])
def test_a_way_that_guards_narrow_is_one_through_full_rows_whatever_wider_ways_there_are(rows: int) -> None:
    survey = groundplan.survey(guarded(rows, 100, 37, 3), resolution=RESOLUTION)
    crossings = [junction["type"] for junction in survey.of_kind("junction")]
    assert sorted(crossings) == ["L"] * 4 + ["T"] * (4 + 2 * (rows - 1)) + ["X"] * (2 * (rows - 1))


def test_a_line_through_the_middle_of_a_way_makes_no_narrower_one_of_it() -> None:
    # Shelves between aisles of 1.4 m; through each leads one way of 4.3 m; where some have their middles others begin.
    starts, gate, aisle, depth = [200, 600, 243, 643, 200, 600, 243], 86, 28, 20
    picture = walled(1120, len(starts) * depth + (len(starts) + 1) * aisle)
    for n, start in enumerate(starts):
        row = picture[20 + aisle + n * (aisle + depth) :][:depth, 80:1080]
        row[:] = OCCUPIED
        row[2:-2, 2:-2] = UNKNOWN
        row[:, start - 2 : start + gate + 2] = OCCUPIED
        row[:, start : start + gate] = FREE
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    widths = sorted(way["width"] for way in survey.of_kind("corridor") if way["name"].startswith("C"))
    assert widths == pytest.approx([3.1] * 2 + [4.3] * len(starts), abs=0.15)


def stores(aisle: int, way: int, gaps: dict[int, int]) -> Picture:
    """Four rows of shelves of 13 m by 0.9 m between aisles for people, with gaps where these are given."""
    depth, length, end = 18, 260, 28
    picture = walled(length + 2 * end, 5 * aisle + 4 * depth)
    left = 20 + end
    for row in range(4):
        low = 20 + aisle + row * (aisle + depth)
        pieces = [(left, left + length)]
        if row in gaps:
            pieces = [(left, left + gaps[row]), (left + gaps[row] + way, left + length)]
        for begin, stop in pieces:
            picture[low : low + depth, begin:stop] = 0
            picture[low + 2 : low + depth - 2, begin + 2 : stop - 2] = UNKNOWN
    return picture


@pytest.mark.parametrize("aisle", [18, 22])
@pytest.mark.parametrize("way", [26, 30])
def test_between_aisles_for_people_ways_are_as_narrow_as_these(way: int, aisle: int) -> None:
    # Ways of 1.3 and 1.5 m, where trucks would want 1.6; a gap narrower than the aisles is none.
    survey = groundplan.survey(stores(aisle, way, {1: 60, 2: 160}), resolution=RESOLUTION)
    assert len(survey.of_kind("junction")) == 4 + 6 + 4
    survey = groundplan.survey(stores(aisle, aisle - 4, {1: 60, 2: 160}), resolution=RESOLUTION)
    assert len(survey.of_kind("junction")) == 4 + 6
