"""Empty places in racks that no way leads through, and some that are like them, on maps that no simulator made up."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np
import pytest
from _legs import Box, legs
from _legs import hall as drawn
from PIL import Image
from zoo import UNKNOWN, Picture, walled

import groundplan

RESOLUTION = 0.05
AISLE, END = 64, 84  # pixels: 3.2 m between rows, 4.2 m before their heads


def hall(rows: int, depth: int, length: int) -> tuple[Picture, list[Picture]]:
    """A hall of rows without a gap, so many pixels deep and long, and each row's part of the picture."""
    picture = walled(2 * END + length, rows * depth + (rows + 1) * AISLE)
    lows = [20 + AISLE + n * (AISLE + depth) for n in range(rows)]
    parts = [picture[low : low + depth, 20 + END : 20 + END + length] for low in lows]
    for part in parts:
        part[:] = 0
    return picture, parts


def ways_across(picture: Picture) -> list[float]:
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    return sorted(way["width"] for way in survey.of_kind("corridor") if way["name"].startswith("C"))


HEADS = [END * RESOLUTION] * 2


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("sparse", [0.05, 0.15])
def test_empty_bays_between_frames_as_deep_as_the_rack_are_no_ways(sparse: float, seed: int) -> None:
    draws = np.random.default_rng(seed)
    bay = 54
    picture, rows = hall(4, 22, 12 * bay + 2)
    for row in rows:
        for n in np.flatnonzero(draws.random(12) < sparse).tolist():
            row[:, n * bay + 2 : (n + 1) * bay] = 254
    assert ways_across(picture) == pytest.approx(HEADS, abs=0.15)


@pytest.mark.parametrize("slot", [20, 26])
def test_slots_in_racks_of_several_pallets_depth_are_no_ways(slot: int) -> None:
    picture, rows = hall(3, 88, 700)
    for n, row in enumerate(rows):
        row[:62, 120 + 30 * n : 120 + slot + 30 * n] = 254
        row[20:, 400 + 50 * n : 400 + slot + 50 * n] = 254
    # And one right through a row, as wide as a pallet.
    rows[1][:, 600 : 600 + slot] = 254
    assert ways_across(picture) == pytest.approx(HEADS, abs=0.15)


def test_a_passage_through_several_racks_of_that_depth_is_a_way_though_it_is_narrow() -> None:
    picture, rows = hall(3, 88, 700)
    for row in rows:
        row[:, 400:426] = 254
    assert ways_across(picture) == pytest.approx([26 * RESOLUTION, *HEADS], abs=0.15)


def test_a_way_that_is_seen_to_end_a_little_before_a_wide_aisle_leads_into_that(shared: Path) -> None:
    survey = groundplan.survey(groundplan.read(shared / "maps" / "radish_edmonton_convention.yaml"))
    assert any(way["name"] == "C05" and way["width"] > 3 for way in survey.of_kind("corridor"))


@pytest.mark.parametrize(("width", "ways"), [(66, 1), (84, 2)])
def test_where_ways_lead_through_all_rows_a_gap_in_one_of_them_is_a_way_if_it_is_longer_than_beams(
    width: int, ways: int
) -> None:
    picture, rows = hall(4, 40, 900)
    for row in rows:
        row[:, 300:370] = 254
    rows[2][:, 600 : 600 + width] = 254
    across = ways_across(picture)
    assert across == pytest.approx(sorted([*HEADS, 3.5, width * RESOLUTION][: 2 + ways]), abs=0.15)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("gaps", [(4, 8, 6), (4, 8)])
def test_a_gap_as_wide_as_a_bay_is_a_way_where_each_of_the_rows_has_one_between_the_ends_of_racks(
    gaps: tuple[int, ...], seed: int
) -> None:
    # Of three rows of two racks back to back, one of which is empty in most bays.
    draws = np.random.default_rng(seed)
    bay, count = 58, 12
    picture, rows = hall(3, 44, count * bay + 2)
    for row, gap in itertools.zip_longest(rows, gaps):
        row[:] = 254
        for n, full in enumerate(draws.integers(1, 4, count).tolist()):
            for rack in (0, 1):
                if full & (rack + 1) and n != gap:
                    row[2 + 21 * rack : 21 + 21 * rack, n * bay + 4 : (n + 1) * bay - 2] = 0
        for post in range(count + 1):
            row[[0, 1, -2, -1], post * bay : post * bay + 2] = 0
        for end in (0, count) if gap is None else (0, gap, gap + 1, count):
            row[:, end * bay : end * bay + 2] = 0
    assert len(ways_across(picture)) == 2 + (len(gaps) if len(gaps) == len(rows) else 0)


BAY = 56  # pixels: 2.8 m


def fill(row: Picture, starts: Iterable[int], full: Iterable[bool]) -> None:
    """Draws bays between posts into a row, two pallets in each that is full."""
    row[:] = 254
    for start, has_goods in zip(starts, full, strict=True):
        for post in (start, start + BAY - 2):
            row[[0, 1, -2, -1], post : post + 2] = 0
        if has_goods:
            row[1:-1, start + 3 : start + 26] = 0
            row[1:-1, start + 30 : start + BAY - 3] = 0


def half_empty(width: int, share: float, seed: int, is_closed: bool = False) -> Picture:
    """Three rows of sixteen bays of 2.8 m between posts, some empty, and a way through all of them."""
    draws = np.random.default_rng(seed)
    count = 16
    picture, rows = hall(3, 20, count * BAY + width)
    full = draws.random((len(rows), count)) > share
    # No bay is empty in each row.
    full[draws.integers(0, len(rows), count), np.arange(count)] = True
    if is_closed:
        full[:, count // 2 - 1 : count // 2 + 1] = True
    starts = [n * BAY + (width if n >= count // 2 else 0) for n in range(count)]
    for row, own in zip(rows, full.tolist(), strict=True):
        fill(row, starts, own)
    return picture


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("width", [57, 59])
def test_where_a_way_leads_through_all_rows_what_is_as_wide_in_some_is_a_bay_if_more_of_them_is_empty(
    width: int, seed: int
) -> None:
    across = ways_across(half_empty(width, 0.15, seed))
    assert across == pytest.approx(sorted([*HEADS, width * RESOLUTION]), abs=0.25)


@pytest.mark.parametrize("seed", [4, 6])
def test_where_a_wider_way_leads_through_all_rows_an_empty_bay_in_each_of_them_is_none(seed: int) -> None:
    across = ways_across(half_empty(64, 0.2, seed))
    assert across == pytest.approx(sorted([*HEADS, 64 * RESOLUTION]), abs=0.35)


@pytest.mark.parametrize("seed", [6, 7, 11])
def test_what_leads_through_all_rows_between_goods_is_a_way_though_it_is_as_wide_as_empty_bays(seed: int) -> None:
    across = ways_across(half_empty(56, 0.35, seed, is_closed=True))
    assert across == pytest.approx(sorted([*HEADS, 56 * RESOLUTION]), abs=0.25)


@pytest.mark.parametrize("beside", [(0, 3), (0, 4), (2, 3)])
def test_ways_lead_through_all_rows_though_a_bay_beside_one_of_them_is_empty(beside: tuple[int, int]) -> None:
    # Of three rows of twelve bays, with ways of 3 m after the fourth and the eighth and four empty bays elsewhere.
    width = 60
    picture, rows = hall(3, 20, 12 * BAY + 2 * width)
    starts = [n * BAY + width * (n // 4) for n in range(12)]
    empty = {beside, (0, 10), (1, 1), (1, 6), (2, 9)}
    for r, row in enumerate(rows):
        fill(row, starts, [(r, n) not in empty for n in range(12)])
    assert ways_across(picture) == pytest.approx([3.0, 3.0, *HEADS], abs=0.25)


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("width", [50, 54])
def test_one_gap_in_each_full_row_is_a_way_be_some_of_them_in_line(width: int, seed: int) -> None:
    # Pallets that do not stand quite in line, in bays of 2.7 m; after so many bays of each row a gap.
    draws = np.random.default_rng(seed)
    gaps, bay, count = (3, 3, 3, 3, 9, 6, 1), 54, 10
    picture, rows = hall(len(gaps), 22, count * bay + width)
    for row, gap in zip(rows, gaps, strict=True):
        row[:] = 254
        for x in (n * bay + (width if n >= gap else 0) for n in range(count)):
            for at in (2, bay // 2 + 1):
                left, right, low, high = draws.integers(0, 3, 4).tolist()
                row[1 + low : -1 - high, x + at + left : x + at + bay // 2 - 3 - right] = 0
            for post in (x, x + bay - 2):
                row[[0, 1, -2, -1], post : post + 2] = 0
        for end in (0, gap * bay - 2, gap * bay + width, count * bay + width - 2):
            row[:, end : end + 2] = 0
    assert len(ways_across(picture)) == 2 + 4


@pytest.mark.parametrize("seed", range(4))
def test_a_mesh_behind_empty_bays_lets_no_way_through_at_the_wall(seed: int) -> None:
    # The rows reach the wall on the right; of each row's bays the last one is empty, before a mesh along all of it.
    draws = np.random.default_rng(seed)
    picture, rows = hall(5, 22, 14 * BAY + 2)
    picture[:, 20 + END + 14 * BAY + 2 :] = 205
    picture[18:-18, 20 + END + 14 * BAY + 2 :][:, :2] = 0
    for row in rows:
        fill(row, range(0, 14 * BAY, BAY), (*(draws.random(13) < 0.5).tolist(), False))
        row[:, -4:] = 254
        row[-2:] = 0
    assert ways_across(picture) == pytest.approx(HEADS[:1], abs=0.3)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("width", [40, 56])
def test_a_gate_as_wide_as_a_bay_in_the_wall_between_two_halls_is_a_way(width: int, seed: int) -> None:
    # A wall of 0.4 m, too thick for a line and too thin for racks, between halls of rows of which half is empty.
    draws = np.random.default_rng(seed)
    count = 14
    halls = [hall(number, 20, count * BAY) for number in (2, 3)]
    for row in [row for _, rows in halls for row in rows]:
        fill(row, [n * BAY for n in range(count)], (draws.random(count) > 0.5).tolist())
    (below, _), (above, _) = halls
    wall = len(below) - 20
    picture = np.vstack([below[:-16], above[16:]])
    picture[wall : wall + 8, 18:-18] = 0
    for gate in (280, 630):
        picture[wall : wall + 8, gate : gate + width] = 254
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    place = (len(picture) - wall - 4) * RESOLUTION
    axes = [sorted(way["axis"], key=lambda end: end[1]) for way in survey.of_kind("corridor")]
    gates = sorted(low[0] for low, high in axes if low[1] < place < high[1])
    assert gates == pytest.approx([(gate + width / 2) * RESOLUTION for gate in (280, 630)], abs=0.2)


def stack(row: Picture, starts: Iterable[int], empty: range, draws: np.random.Generator) -> None:
    """Draws bays of three pallets between posts into a row, some places empty; of pallets a lidar sees the outlines."""
    starts = list(starts)
    fill(row, starts, [False] * len(starts))
    for n in set(range(3 * len(starts))) - set(empty):
        first = starts[n // 3] + 3 + 18 * (n % 3) + draws.integers(2)
        pallet = row[2 + draws.integers(2) : -2 - draws.integers(2), first : first + 15 + draws.integers(2)]
        pallet[:] = 0
        pallet[1:-1, 1:-1] = 205


def turned(picture: Picture, degrees: float) -> Picture:
    return np.array(Image.fromarray(picture).rotate(degrees, expand=True, fillcolor=205))


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("depth", [22, 26, 46])
@pytest.mark.parametrize("degrees", [3.0, 17.0, 36.0])
def test_a_bay_that_is_empty_is_no_way_where_posts_stand_within_what_is_seen_of_one(
    degrees: float, depth: int, seed: int
) -> None:
    draws = np.random.default_rng(seed)
    picture, rows = hall(5, depth, 12 * (BAY + 1))
    none = range(0)
    for row, empty in zip(rows, [none, range(9, 12), none, range(24, 27), none], strict=True):
        stack(row, [n * (BAY + 1) for n in range(12)], empty, draws)
    assert ways_across(turned(picture, degrees)) == pytest.approx(HEADS, abs=0.4)


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("way", [70, 80, 90])
@pytest.mark.parametrize("degrees", [3.0, 17.0])
def test_a_way_through_one_row_ends_before_an_empty_bay_of_the_next_in_line(
    degrees: float, way: int, seed: int
) -> None:
    # After the fifth bay of the second row; the fifth bay of the third row, in line with it, is empty.
    draws, none = np.random.default_rng(seed), range(0)
    picture, rows = hall(5, 22, 12 * (BAY + 1) + way)
    for r, (row, empty) in enumerate(zip(rows, [none, none, range(12, 15), range(27, 30), none], strict=True)):
        stack(row, [n * (BAY + 1) + way * (r != 1 or n >= 5) for n in range(12)], empty, draws)
    survey = groundplan.survey(turned(picture, degrees), resolution=RESOLUTION)
    lengths = [np.linalg.norm(np.subtract(*c["axis"])) for c in survey.of_kind("corridor") if c["name"].startswith("C")]
    assert min(lengths) == pytest.approx((AISLE + 22) * RESOLUTION, abs=0.3)
    assert [junction["type"] for junction in survey.of_kind("junction")].count("X") == 0


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("rows", [5, 6])
def test_ways_as_wide_as_bays_lead_through_every_other_row_in_line_and_through_the_rest(rows: int, seed: int) -> None:
    # Rows of two racks back to back, of nine bays for four pallets, of which every third is missing.
    draws = np.random.default_rng(seed)
    bay, count, gaps = 72, 9, (2, 6)
    picture, parts = hall(rows, 40, count * bay + 2)
    for n, row in enumerate(parts):
        row[:] = 254
        for k in range(count):
            for slot, rack in itertools.product(range(4), (0, 1)):
                if k != gaps[n % 2] and draws.random() > 1 / 3:
                    x = k * bay + 4 + 17 * slot
                    row[2 + 19 * rack : 19 + 19 * rack, x : x + 15] = 0
        for post in range(count + 1):
            row[[0, 1, -2, -1], post * bay : post * bay + 2] = 0
    assert len(ways_across(picture)) == 2 + rows


@pytest.mark.parametrize("width", [40, 46, 60])
@pytest.mark.parametrize("rows", [4, 7])
def test_a_gap_in_line_through_full_rows_is_a_way_though_one_row_beside_them_has_none(rows: int, width: int) -> None:
    picture, parts = hall(rows, 22, 600)
    for row in parts[1:]:
        row[:, 280 : 280 + width] = 254
    assert ways_across(picture) == pytest.approx(sorted([*HEADS, width * RESOLUTION]), abs=0.15)
    assert len(groundplan.survey(picture, resolution=RESOLUTION).of_kind("rack")) == 2 * rows - 1


@pytest.mark.parametrize("seed", range(1, 5))
@pytest.mark.parametrize("rows", [2, 3])
def test_ways_past_the_ends_that_are_as_wide_as_bays_make_no_empty_bay_a_way(rows: int, seed: int) -> None:
    draws = np.random.default_rng(seed)
    count = 16
    picture = walled((count + 2) * BAY, rows * 22 + (rows + 1) * AISLE)
    full = draws.random((rows, count)) > 0.3
    # No bay is empty in each row.
    full[draws.integers(0, rows, count), np.arange(count)] = True
    for n, own in enumerate(full.tolist()):
        low = 20 + AISLE + n * (AISLE + 22)
        fill(picture[low : low + 22, 20 + BAY : 20 + (count + 1) * BAY], range(0, count * BAY, BAY), own)
    assert ways_across(picture) == pytest.approx([BAY * RESOLUTION] * 2, abs=0.3)


@pytest.mark.parametrize("seed", range(4))
def test_a_way_is_as_wide_as_the_posts_beside_it_leave_whatever_lines_are_near(seed: int) -> None:
    """One through each row at its own place: posts, and goods that stand back from them, have lines in other rows."""
    draws = np.random.default_rng(seed)
    bay, bays, width = 44, 12, 62  # pixels: 2.2 and 3.1 m
    picture, rows = hall(7, 24, bays * bay + width + 2)
    places = draws.choice(range(2, bays - 1, 2), len(rows), replace=True).tolist()
    for row, at in zip(rows, places, strict=True):
        row[:] = 254
        for n in range(bays):
            start = n * bay + (width if n >= at else 0)
            row[2:-2, start + 3 : start + bay - 1] = 0
            for post in (start, start + bay):
                row[[0, 1, -2, -1], post : post + 2] = 0
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    ways = [way for way in survey.of_kind("corridor") if way["name"].startswith("C")]
    across = [way for way in ways if way["width"] < 4]
    assert [way["width"] for way in across] == pytest.approx([width * RESOLUTION] * len(across), abs=0.25)
    lengths = [np.linalg.norm(np.subtract(*way["axis"])) for way in across]
    aisles = (AISLE + 24) * RESOLUTION
    assert sum(lengths) == pytest.approx(len(rows) * aisles, abs=1.0)


@pytest.mark.parametrize("widths", [(38, 48, 62, 44), (60, 40, 50, 36, 46)])
def test_one_gap_in_each_row_without_bays_is_a_way_however_wide(widths: tuple[int, ...]) -> None:
    picture, rows = hall(len(widths), 24, 800)
    for row, width, at in zip(rows, widths, [120, 560, 300, 430, 640], strict=False):
        row[:, at : at + width] = 254
    expected = sorted([*HEADS, *(width * RESOLUTION for width in widths)])
    assert ways_across(picture) == pytest.approx(expected, abs=0.15)


@pytest.mark.parametrize("ways", [(3,), (3, 11)])
@pytest.mark.parametrize("through", [4, 5])
def test_ways_as_wide_as_bays_through_the_first_rows_in_line_are_ways_though_some_bays_are_empty(
    through: int, ways: tuple[int, ...]
) -> None:
    # One or two bays of each row are empty besides, nowhere in line.
    count, empty = 15, [{7, 9}, {1, 13}, {6, 8}, {5, 0}, {9}, {6}, {13}, {2}]
    picture, rows = hall(8, 22, count * BAY)
    for n, row in enumerate(rows):
        full = [at not in empty[n] and not (n < through and at in ways) for at in range(count)]
        fill(row, range(0, count * BAY, BAY), full)
    assert len(ways_across(picture)) == 2 + len(ways)


@pytest.mark.parametrize("width", [26, 30, 40])
def test_a_way_is_no_wider_than_it_is_free_be_it_narrow(width: int) -> None:
    bays = 12
    picture, rows = hall(4, 22, bays * BAY + width)
    for row in rows:
        fill(row, [n * BAY + (width if n >= 5 else 0) for n in range(bays)], [True] * bays)
    assert ways_across(picture)[0] == pytest.approx(width * RESOLUTION, abs=0.15)


def test_a_rack_ends_where_a_way_leads_through_be_that_as_narrow_as_the_aisles_of_a_shop() -> None:
    # Five rows 0.8 m deep with 1.5 m between them, and as much between their halves.
    gap = 30
    picture = walled(5 * 46 + 30 + 64, 62 + 250 + 42)
    for n in range(5):
        left = 20 + 60 + 46 * n
        picture[20 + 62 : 20 + 62 + 250, left : left + 16] = 0
        picture[20 + 62 + 110 : 20 + 62 + 110 + gap, left : left + 16] = 254
    racks = groundplan.survey(picture, resolution=RESOLUTION).of_kind("rack")
    lengths = sorted(round(float(np.hypot(*np.subtract(*rack["axis"]))), 1) for rack in racks)
    assert lengths == pytest.approx([5.5] * 5 + [(140 - gap) * RESOLUTION] * 5, abs=0.25)


@pytest.mark.parametrize("seed", [2, 11])
def test_a_bay_that_is_empty_in_all_half_empty_rows_is_no_way(seed: int) -> None:
    draws = np.random.default_rng(seed)

    def boxes() -> Iterator[Box]:
        for row in range(3):
            low = 2.6 + 4.1 * row
            for left, bays in ((4.0, 16), (4.0 + 16 * 2.4 + 4.0, 8)):
                yield from legs(left, low, bays, 1.4, 2.4)
                for bay in np.flatnonzero(draws.random(bays) < 0.62):
                    yield left + 0.15 + 2.4 * bay, low + 0.05, left + 2.35 + 2.4 * bay, low + 1.35

    survey = groundplan.survey(drawn(8.0 + 24 * 2.4 + 4.1, 3 * 4.1 + 1.5, boxes()), resolution=RESOLUTION)
    types = sorted(junction["type"] for junction in survey.of_kind("junction"))
    # The way between the blocks, and those before the rows' heads.
    assert types == ["L"] * 4 + ["T"] * 6 + ["X"] * 2


def two_racks(seed: int, rows: int, bays: int, bay: int, shares: tuple[float, float]) -> Picture:
    """Rows of two racks on posts back to back; of all places a share is full on both sides, and a share on one."""
    draws = np.random.default_rng(seed)
    depth = 21
    picture = walled(2 * END + bay * bays, (rows + 1) * AISLE + 2 * rows * depth)
    for row in (20 + AISLE + n * (AISLE + 2 * depth) for n in range(rows)):
        drawn_shares, side = draws.random(bays), draws.integers(0, 2, bays)
        for number, rack in enumerate((row, row + depth)):
            for post in range(bays + 1):
                x = min(max(20 + END + post * bay - 1, 20 + END), 20 + END + bays * bay - 2)
                picture[rack : rack + 2, x : x + 2] = picture[rack + depth - 2 : rack + depth, x : x + 2] = 0
            full = (drawn_shares < shares[0]) | ((drawn_shares < sum(shares)) & (side == number))
            for x in (20 + END + bay * np.flatnonzero(full)).tolist():
                picture[rack + 1 : rack + depth - 1, x + 2 : x + bay - 2] = 0
    return picture


@pytest.mark.parametrize(
    ("seed", "rows", "bays", "bay", "shares"),
    [
        (0, 8, 31, 50, (0.43, 0.19)),
        (5, 8, 25, 56, (0.3, 0.2)),
        (18, 7, 24, 48, (0.4, 0.12)),
        (11, 10, 19, 49, (0.21, 0.34)),
    ],
)
def test_where_both_of_two_racks_are_empty_at_every_third_place_these_are_no_ways(
    seed: int, rows: int, bays: int, bay: int, shares: tuple[float, float]
) -> None:
    assert ways_across(two_racks(seed, rows, bays, bay, shares)) == pytest.approx(HEADS, abs=0.15)


def up_to_a_wall(seed: int, off: int, way: int) -> Picture:
    """Seven rows of bays of 2.3 m whose first frames lean on a wall, unseen; a way after five bays, one past the last.

    Goods stand in few bays, and of the first ones in that of the fourth row.
    """
    draws = np.random.default_rng(seed)
    rows, bays, bay, depth, aisle, at = 7, 16, 46, 21, 50, 5
    picture = walled(bay * bays + way + 80, (rows + 1) * aisle + rows * depth)
    for n, row in enumerate(20 + aisle + n * (aisle + depth) for n in range(rows)):
        for post in range(1, bays + 2):
            x = 20 + off + (post * bay if post <= at else (post - 1) * bay + way)
            picture[row : row + 2, x - 1 : x + 1] = picture[row + depth - 2 : row + depth, x - 1 : x + 1] = 0
        full = draws.random(bays) < 0.15
        full[0] = n == rows // 2
        for place in np.flatnonzero(full).tolist():
            x = 20 + off + place * bay + (way if place >= at else 0)
            picture[row + 1 : row + depth - 1, x + 3 : x + bay - 3] = 0
    return picture


@pytest.mark.parametrize("seed", [0, 1])
@pytest.mark.parametrize(("off", "way"), [(2, 86), (3, 104)])
def test_empty_bays_between_the_first_posts_and_a_wall_are_no_way_where_goods_stand_in_one(
    off: int, way: int, seed: int
) -> None:
    survey = groundplan.survey(up_to_a_wall(seed, off, way), resolution=RESOLUTION)
    kinds = [junction["type"] for junction in survey.of_kind("junction") if junction["type"] != "end"]
    assert sorted(kinds) == ["L"] * 2 + ["T"] * 8 + ["X"] * 6


@pytest.mark.parametrize("gates", [2, 4, 5])
def test_gates_as_wide_as_a_bay_through_a_full_row_by_itself_are_ways_however_many(gates: int) -> None:
    bay, bays = 54, 18
    picture, (row,) = hall(1, 22, bays * bay + 2)
    row[2:-2, 2:-2] = UNKNOWN
    for gate in np.linspace(2, bays - 3, gates).round().astype(int).tolist():
        row[:, gate * bay + 2 : (gate + 1) * bay] = 254
        row[:, gate * bay : gate * bay + 2] = row[:, (gate + 1) * bay : (gate + 1) * bay + 2] = 0
    assert len(ways_across(picture)) == 2 + gates
