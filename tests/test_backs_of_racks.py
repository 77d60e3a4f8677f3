"""Racks whose backs show where bays are empty: what nothing closes from aisle to aisle is a way, however wide."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np
import numpy.typing as npt
import pytest
from _legs import Box, Picture, hall
from shapely.geometry import Polygon

import groundplan

Bays = npt.NDArray[np.bool_]  # which bays of a row's racks are full, by rack

BACK, POST = 0.1, 0.1


def row(left: float, low: float, full: Bays, bay: float, depth: float, closed: Bays | None = None) -> Iterator[Box]:
    """Racks side by side, posts at both faces of the row, with a back along its middle where its bays are closed."""
    racks, bays = full.shape
    high, middle = low + racks * depth, low + racks * depth / 2
    for n in range(bays + 1):
        for face in (low, high - POST):
            yield left + n * bay - POST / 2, face, left + n * bay + POST / 2, face + POST
    for rack, n in np.argwhere(full).tolist():
        yield left + n * bay + 0.05, low + rack * depth, left + (n + 1) * bay - 0.05, low + (rack + 1) * depth
    for n in np.flatnonzero(np.ones(bays, np.bool_) if closed is None else closed).tolist():
        yield left + n * bay, middle - BACK / 2, left + (n + 1) * bay, middle + BACK / 2


def without_ends(picture: Picture) -> list[str]:
    survey = groundplan.survey(picture, resolution=0.05)
    return sorted(kind for label in survey.of_kind("junction") if (kind := label["type"]) != "end")


def staggered(seed: int, share: float, racks: int, depth: float, backs: bool = True) -> Picture:
    """Four rows of sixteen bays of which a share is full, and of each row another one is left out for a way as wide."""
    draws, ways, bay, aisle, bays = np.random.default_rng(seed), [5, 11, 4, 12], 2.4, 2.6, 16

    def boxes() -> Iterator[Box]:
        for n, way in enumerate(ways):
            low = aisle + n * (racks * depth + aisle)
            full = draws.random((racks, bays)) < share
            # Both ends of a row are seen.
            full[:, [0, way - 1, way + 1, bays - 1]] = True
            full[:, way] = False
            closed = np.full(bays, backs)
            closed[way] = False
            yield from row(aisle, low, full, bay, depth, closed)

    height = len(ways) * (racks * depth + aisle) + aisle
    return hall(bays * bay + 2 * aisle, height, boxes(), 20.0)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("share", "racks", "depth"), [(0.3, 2, 1.1), (0.5, 1, 1.2)])
def test_a_way_as_wide_as_a_bay_is_told_by_the_backs_of_empty_bays(
    share: float, racks: int, depth: float, seed: int
) -> None:
    assert without_ends(staggered(seed, share, racks, depth)) == ["L"] * 4 + ["T"] * 14


@pytest.mark.parametrize("seed", range(3))
def test_without_backs_an_empty_bay_is_no_way(seed: int) -> None:
    assert without_ends(staggered(seed, 0.3, 2, 1.1, backs=False)) == ["L"] * 4 + ["T"] * 6


@pytest.mark.parametrize("depth", [1.1, 1.2])
def test_a_way_ends_before_a_row_that_backs_close(depth: float) -> None:
    # It leads through two rows of four; of the next ones the bays in line with it are empty, and have backs.
    def boxes() -> Iterator[Box]:
        for n in range(4):
            low = 2.6 + n * (2 * depth + 2.6)
            full = np.ones((2, 12), np.bool_)
            full[:, [6, 7]] = False
            closed = np.ones(12, np.bool_)
            if n < 2:
                closed[6] = False
                full[:, 7] = True
            yield from row(2.6, low, full, 2.4, depth, closed)

    picture = hall(12 * 2.4 + 5.2, 4 * (2 * depth + 2.6) + 2.6, boxes(), 20.0)
    assert without_ends(picture) == ["L"] * 4 + ["T"] * 8 + ["X"]


def bent(seed: int, off: float, count: int, width: float) -> Picture:
    """Rows of two racks with empty bays, and a way through each that lies farther on than in the one before."""
    draws = np.random.default_rng(seed)

    def boxes() -> Iterator[Box]:
        for n in range(count):
            low, way = 2.6 + n * 5.2, 14.6 + off * n
            for left, bays in ((way - 5 * 2.4, 5), (way + width, 6)):
                full = draws.random((2, bays)) < 0.7
                full[:, [0, bays - 1]] = True
                yield from row(left, low, full, 2.4, 1.3)

    return hall(32.0 + off * count, count * 5.2 + 2.6, boxes(), 20.0)


@pytest.mark.parametrize("seed", range(2))
def test_of_two_that_lead_on_from_one_row_either_way_each_is_a_way(seed: int) -> None:
    # Drift moves the way from row to row, so that no one rectangle leads through all of them.
    assert without_ends(bent(seed, 0.5, 4, 1.8)) == ["L"] * 4 + ["T"] * 8 + ["X"] * 3


def head_of_rows(office: float) -> Picture:
    """Five rows of two racks with half their bays empty, of which the lower three begin beyond an office and a way."""
    draws = np.random.default_rng(3)

    def boxes() -> Iterator[Box]:
        yield 0.0, 0.0, office, 3 * 4.8 + 0.2
        for n in range(5):
            first = 2 if n < 3 else 0
            full = draws.random((2, 12)) < 0.5
            full[:, [first, 11]] = True
            low = 2.4 + n * 4.8
            yield from row(2.4 + first * 3.6, low, full[:, first:7], 3.6, 1.2)
            yield from row(2.4 + 7 * 3.6 + 3.2, low, full[:, 7:], 3.6, 1.2)

    return hall(2.4 + 12 * 3.6 + 3.2 + 2.4, 5 * 4.8 + 2.4, boxes(), 0.0)


def test_a_way_before_an_office_is_told_by_the_ends_of_rows_with_backs() -> None:
    assert without_ends(head_of_rows(7.2)) == ["L"] * 5 + ["T"] * 10 + ["X"] * 4


@pytest.mark.parametrize("seed", range(6))
def test_a_way_that_backs_tell_in_some_rows_alone_is_one_way(seed: int) -> None:
    draws = np.random.default_rng(seed)

    def boxes() -> Iterator[Box]:
        for n in range(6):
            full = draws.random((2, 12)) < 0.15
            low = 2.6 + n * 5.2
            yield from row(2.6, low, full[:, :4], 2.7, 1.1)
            yield from row(2.6 + 4 * 2.7 + 2.9, low, full[:, 4:], 2.7, 1.1)

    survey = groundplan.survey(hall(12 * 2.7 + 2.9 + 5.2, 6 * 5.2 + 2.6, boxes()), resolution=0.05)
    ways = [Polygon(corridor["polygon"]) for corridor in survey.of_kind("corridor")]
    over = [one.intersection(two).area / min(one.area, two.area) for one, two in itertools.combinations(ways, 2)]
    assert max(over) < 0.5
