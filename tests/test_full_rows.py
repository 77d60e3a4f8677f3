"""Gates through rows of racks that are full: as wide as bays, and told by how they lie."""

from __future__ import annotations

import numpy as np
import pytest
from test_bays_are_no_ways import HEADS, hall, ways_across
from zoo import UNKNOWN, Picture


def full_rows(gates: tuple[int, ...], wide: int, seed: int) -> tuple[Picture, int]:
    """Full rows of thirty bays of 2.7 m with so many gates of so many bays, and how many of these lie beside none."""
    draws = np.random.default_rng(seed)
    bay, bays = 54, 30
    picture, rows = hall(len(gates), 22, bays * bay + 2)
    places = set()
    for n, (row, count) in enumerate(zip(rows, gates, strict=True)):
        row[2:-2, 2:-2] = UNKNOWN
        for first in np.sort(draws.choice(np.arange(2, bays - 3, 2 + wide), count, replace=False)).tolist():
            row[:, first * bay + 2 : (first + wide) * bay] = 254
            row[:, first * bay : first * bay + 2] = row[:, (first + wide) * bay : (first + wide) * bay + 2] = 0
            places.add((n, first))
    return picture, sum((n - 1, first) not in places for n, first in places)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("wide", [1, 2])
@pytest.mark.parametrize("gates", [(1, 2, 2, 1, 1, 1, 2), (1, 2, 2, 2, 1, 1)])
def test_gates_that_lie_in_full_rows_more_evenly_than_chance_deals_them_are_ways(
    gates: tuple[int, ...], wide: int, seed: int
) -> None:
    picture, count = full_rows(gates, wide, seed)
    assert len(ways_across(picture)) == count + len(HEADS)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("empty", [(3, 0, 2, 1, 0, 2, 1), (0, 3, 1, 2, 4, 0, 1)])
def test_bays_that_are_empty_in_full_rows_as_chance_deals_them_are_no_ways(empty: tuple[int, ...], seed: int) -> None:
    picture, _ = full_rows(empty, 1, seed)
    assert ways_across(picture) == pytest.approx(HEADS, abs=0.15)
