"""Halls of which each has its own bays, joined by passages: what is known of one tells nothing of the others."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest

import groundplan

Picture = npt.NDArray[np.uint8]
Bays = npt.NDArray[np.bool_]  # of two racks back to back, which of their bays are full

RESOLUTION, DEPTH = 0.05, 1.2


def pixels(*metres: float) -> tuple[int, ...]:
    return tuple(round(place / RESOLUTION) for place in metres)


def unknown(right: float, top: float) -> Picture:
    """Nothing seen as far as 2 m beyond two places."""
    return np.full(pixels(top + 2, right + 2), 205, np.uint8)


def floor(picture: Picture, left: float, low: float, right: float, top: float) -> None:
    """Floor within walls; what is floor already stays."""
    x, y, to, high = pixels(left, low, right, top)
    around = picture[y - 2 : high + 2, x - 2 : to + 2]
    around[around != 254] = 0
    picture[y:high, x:to] = 254


def racks(picture: Picture, left: float, low: float, bay: float, full: Bays) -> float:
    """Two racks back to back with posts between their bays, of which those that are full are solid; where they end."""
    for side, own in enumerate(full):
        bottom, top = pixels(low + side * DEPTH, low + (side + 1) * DEPTH)
        for n in range(len(own) + 1):
            (post,) = pixels(left + n * bay)
            picture[bottom : bottom + 2, post - 1 : post + 1] = picture[top - 2 : top, post - 1 : post + 1] = 0
        for n in np.flatnonzero(own).tolist():
            here, there = pixels(left + n * bay, left + (n + 1) * bay)
            picture[bottom + 1 : top, here + 2 : there - 2] = 0
    return left + int(full.shape[1]) * bay


def hall(picture: Picture, left: float, bay: float, way: float, aisle: float, rows: list[tuple[Bays, int]]) -> float:
    """Rows of racks with aisles and ways of one width around, each with a way after so many bays; where it ends."""
    length = int(rows[0][0].shape[1]) * bay + way
    right, low = left + length + 2 * aisle, 2 + aisle
    floor(picture, left, 2, right, low + len(rows) * (2 * DEPTH + aisle))
    for row, (full, before) in enumerate(rows):
        at = low + row * (2 * DEPTH + aisle)
        ends = racks(picture, left + aisle, at, bay, full[:, :before])
        racks(picture, ends + way, at, bay, full[:, before:])
    return right


def junctions(picture: Picture, left: float, right: float) -> list[str]:
    """The types of those between two places along, without dead ends."""
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    found = [label["type"] for label in survey.of_kind("junction") if left < label["at"][0] < right]
    return sorted(kind for kind in found if kind != "end")


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("way", [1.9, 2.3])
def test_each_full_row_has_its_way_beside_a_hall_through_all_rows_of_which_one_leads(way: float, seed: int) -> None:
    # The two share an aisle, through a passage; in the first one bays are of 3 m, of which more than half are full.
    draws = np.random.default_rng(seed)
    picture = unknown(85, 24)
    first = hall(picture, 2, 3.0, 3.2, 3.0, [(draws.random((2, 10)) < 0.6, 5) for _ in range(3)])
    second = hall(picture, first + 3, 2.5, way, 2.8, [(np.ones((2, 9), np.bool_), before) for before in (2, 6, 4)])
    floor(picture, first - 1, 8.1, first + 4, 10.1)
    assert junctions(picture, first + 3, second) == ["L"] * 4 + ["T"] * 9 + ["X"]
