"""Bars close the ends of rows beside ways and not beside bays: they tell ways from bays where widths do not."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from _legs import Box, Picture
from _legs import hall as drawn

import groundplan
from groundplan import simulate
from groundplan.evaluate import score


def typed(seed: int, **options: Any) -> float:
    """Junctions of a simulated site whose cross aisles are staggered from row to row, as F1 by place and type."""
    simulated = simulate.warehouse(seed=seed, **options, scan_every=0.8, beams=400)
    return float(score(groundplan.survey(simulated.map).to_dict(), simulated.truth)["junction_typed_f1"])


@pytest.mark.parametrize(
    "options",
    [
        {"seed": 65219, "yaw": -11.7, "width": 59.58, "depth": 26.1, "aisle": 2.95, "cross_aisle": 3.58},
        {"seed": 86219, "yaw": 8.2, "width": 56.49, "depth": 28.11, "aisle": 2.86, "cross_aisle": 3.33},
    ],
    ids=["60-m", "56-m"],
)
def test_a_way_between_bars_through_one_row_of_several_is_no_empty_bay(options: dict[str, Any]) -> None:
    assert typed(**options, staggered=8.0, cross_aisles=2, clutter=0.8) == 1


@pytest.mark.parametrize(
    "options",
    [
        {"seed": 62218, "yaw": 4.1, "width": 52.14, "depth": 33.14, "aisle": 3.26, "cross_aisle": 3.81}
        | {"staggered": 10.0, "cross_aisles": 1},
        {"seed": 67219, "yaw": 5.2, "width": 59.87, "depth": 31.32, "aisle": 2.7, "cross_aisle": 3.85}
        | {"staggered": 8.0, "cross_aisles": 2, "clutter": 0.8},
    ],
    ids=["52-m", "60-m"],
)
def test_a_bay_between_a_bar_and_goods_is_narrower_than_from_post_to_post_and_no_way(options: dict[str, Any]) -> None:
    assert typed(**options) == 1


@pytest.mark.parametrize(
    "options",
    [
        {"seed": 68220, "yaw": 50.9, "width": 57.12, "depth": 32.3, "aisle": 2.74, "cross_aisle": 3.03},
        {"seed": 83220, "yaw": 85.0, "width": 53.07, "depth": 28.06, "aisle": 3.01, "cross_aisle": 3.06},
        {"seed": 89220, "yaw": 62.0, "width": 52.68, "depth": 27.38, "aisle": 3.3, "cross_aisle": 3.76},
    ],
    ids=["57-m", "53-m", "52-m-wide-way"],
)
def test_a_way_leads_no_further_than_bars_stand_beside_it_where_posts_of_empty_bays_stand_in_it(
    options: dict[str, Any],
) -> None:
    assert typed(**options, skew=-9.0, staggered=9.0, cross_aisles=1, sparse=0.4) == 1


@pytest.mark.parametrize(
    "options",
    [
        {"seed": 61222, "yaw": 18.2, "width": 53.63, "depth": 36.11, "aisle": 2.6, "cross_aisle": 3.3},
        {"seed": 63222, "yaw": 14.4, "width": 52.82, "depth": 32.16, "aisle": 2.91, "cross_aisle": 3.75},
    ],
    ids=["54-m", "53-m"],
)
def test_a_gap_through_one_row_of_several_that_no_number_of_bays_fills_is_a_way(options: dict[str, Any]) -> None:
    assert typed(**options, uneven=0.5, staggered=9.0, goods=0.6, cross_aisles=2) == 1


def test_a_gap_beside_which_no_bar_stands_is_no_way_where_bars_end_all_rows() -> None:
    site: dict[str, Any] = {
        "seed": 75219,
        "yaw": -21.7,
        "width": 71.58,
        "depth": 25.73,
        "aisle": 2.92,
        "cross_aisle": 3.28,
    }
    assert typed(**site, staggered=8.0, cross_aisles=2, clutter=0.8) == 1


def test_a_way_between_bars_through_several_rows_is_no_empty_bay_though_it_is_narrower() -> None:
    site: dict[str, Any] = {"seed": 70066, "yaw": -2.8, "width": 35.16, "depth": 27.34, "aisle": 3.23}
    assert typed(**site, cross_aisle=2.81, cross_aisles=2, sparse=0.6, halls=2) == 1


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize(("depth", "empty"), [(2.2, 0.3), (4.4, 0.15)])
def test_ways_narrower_than_bays_through_one_row_each_are_ways_where_as_wide_ones_between_bars_are(
    depth: float, empty: float, seed: int
) -> None:
    """Four rows of 15 bays of 2.8 m, each between bars, and parted by a way of 2.3 m between two more."""
    draws = np.random.default_rng(seed)

    def row(y: float, parted: int) -> Iterator[Box]:
        x = 4.0
        for n in range(15):
            if n in (0, parted):
                yield x, y, x + 0.1, y + depth
            for low in np.linspace(y, y + depth - 0.1, 3):
                yield x, low, x + 0.1, low + 0.1
                yield x + 2.8, low, x + 2.9, low + 0.1
            for low in (y, y + depth / 2):
                goods = [m for m in range(3) if draws.random() > empty]
                yield from ((x + 0.15 + 0.87 * m, low, x + 0.95 + 0.87 * m, low + depth / 2 - 0.1) for m in goods)
            x += 2.8
            if n in (parted - 1, 14):
                yield x, y, x + 0.1, y + depth
                x += 2.4
        assert x > 48.0

    parted = [4, 10, 6, 12]
    boxes = (box for n in range(4) for box in row(3.2 + n * (3.2 + depth), parted[n]))
    survey = groundplan.survey(drawn(52.5, 16.0 + 4 * depth, boxes), resolution=0.05)
    across = sorted(way["width"] for way in survey.of_kind("corridor") if way["name"].startswith("C"))
    assert across == pytest.approx([2.3] * 4 + [4.0] * 2, abs=0.2)


@pytest.mark.parametrize("seed", range(4))
def test_ways_narrower_than_bays_are_ways_through_single_racks_too_where_as_many_lead_through_two(seed: int) -> None:
    """Six rows of 15 bays, of two racks and of one by turns, each parted by a way; a fifth of the goods is gone."""
    draws = np.random.default_rng(seed)

    def row(y: float, racks: int, parted: int) -> Iterator[Box]:
        x, depth = 4.0, 1.1 * racks
        for n in range(15):
            if n in (0, parted):
                yield x, y, x + 0.1, y + depth
            for low in (y, y + depth - 0.1):
                yield x, low, x + 0.1, low + 0.1
                yield x + 2.8, low, x + 2.9, low + 0.1
            for rack in range(racks):
                goods = [x + 0.15 + 0.9 * m for m in range(3) if draws.random() > 0.2]
                yield from ((left, y + 1.1 * rack, left + 0.84, y + 1.1 * rack + 1.0) for left in goods)
            x += 2.8
            if n in (parted - 1, 14):
                yield x, y, x + 0.1, y + depth
                x += 2.4

    places = [(3.2, 2, 4), (8.6, 1, 10), (12.9, 2, 6), (18.3, 1, 12), (22.6, 2, 5), (28.0, 1, 9)]
    boxes = (box for place in places for box in row(*place))
    survey = groundplan.survey(drawn(52.5, 32.3, boxes), resolution=0.05)
    across = sorted(way["width"] for way in survey.of_kind("corridor") if way["name"].startswith("C"))
    assert across == pytest.approx([2.3] * 6 + [4.1] * 2, abs=0.2)


@pytest.mark.parametrize("seed", range(8))
def test_a_way_one_bay_wide_between_bars_through_the_only_double_row_is_no_empty_bay(seed: int) -> None:
    draws = np.random.default_rng(seed)

    def boxes() -> Iterator[Box]:
        for y in (3.3, 4.5):
            for x, bays in ((3.5, 4), (3.5 + 5 * 2.6, 5)):
                for n in range(bays + 1):
                    for low in (y, y + 0.9):
                        yield x + 2.6 * n - 0.05, low, x + 2.6 * n + 0.05, low + 0.1
                for end in (0, bays):
                    yield x + 2.6 * end - 0.05, y, x + 2.6 * end + 0.05, y + 1.0
                for bay in np.flatnonzero(draws.random(bays) < 0.7):
                    for left in (x + 2.6 * bay + 0.15, x + 2.6 * bay + 1.35):
                        yield left, y + 0.1, left + 1.1, y + 0.9

    survey = groundplan.survey(drawn(33.0, 8.8, boxes()), resolution=0.05)
    across = [way["width"] for way in survey.of_kind("corridor") if way["name"].startswith("C")]
    assert len(across) == 3


def sheeted(x: float, y: float, full: npt.NDArray[np.bool_], bay: float) -> Iterator[Box]:
    """Two racks with a flue of 15 cm, posts at both faces of the row and a sheet across either end; goods fill bays."""
    racks, bays, depth, flue = 2, full.shape[1], 1.05, 0.15
    deep = racks * depth + flue
    for n in range(bays + 1):
        for low in (y, y + deep - 0.1):
            yield x + n * bay - 0.05, low, x + n * bay + 0.05, low + 0.1
    for n in (0, bays):
        yield x + n * bay - 0.05, y, x + n * bay + 0.05, y + deep
    for rack, n in np.argwhere(full).tolist():
        low = y + rack * (depth + flue)
        yield x + n * bay + 0.1, low + 0.05 * (1 - rack), x + (n + 1) * bay - 0.1, low + depth - 0.05 * rack


def partly_full(draws: np.random.Generator, bays: int) -> npt.NDArray[np.bool_]:
    """Which of two racks' bays are full: most are, and one of the two that face each other always."""
    full = draws.random((2, bays)) < 0.8
    full[draws.integers(2, size=bays), np.arange(bays)] = True
    return full


def kinds(picture: Picture) -> list[str]:
    survey = groundplan.survey(picture, resolution=0.05)
    return sorted(label["type"] for label in survey.of_kind("junction"))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("way", [2.1, 2.35])
def test_a_way_narrower_than_bays_is_told_by_the_sheets_on_both_its_sides(way: float, seed: int) -> None:
    draws, bay = np.random.default_rng(seed), 2.8

    def boxes() -> Iterator[Box]:
        for y, before in ((2.8, 4), (7.85, 7)):
            yield from sheeted(2.8, y, partly_full(draws, before), bay)
            yield from sheeted(2.8 + before * bay + way, y, partly_full(draws, 12 - before), bay)

    assert kinds(drawn(12 * bay + way + 5.6, 12.9, boxes())) == ["L"] * 4 + ["T"] * 6


@pytest.mark.parametrize("bay", [2.1, 2.8])
def test_a_bay_that_both_racks_have_empty_is_no_way_where_a_flue_parts_its_sides_and_sheets_end_the_row(
    bay: float,
) -> None:
    full = partly_full(np.random.default_rng(2), 12)
    full[:, 4] = False
    assert kinds(drawn(12 * bay + 5.6, 7.85, sheeted(2.8, 2.8, full, bay))) == ["L"] * 4
