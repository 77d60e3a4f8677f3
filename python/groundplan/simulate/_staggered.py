"""Cross aisles that every row has at places of its own."""

from __future__ import annotations

import dataclasses
import itertools

import numpy as np

from groundplan.simulate._hall import Cross, Hall, Span
from groundplan.simulate._options import WarehouseOptions

_CLEAR = 2.0  # metres of rack between two openings that face the same aisle, or they would be one crossing
_ALIGNED = 0.3  # share of openings that stay where the row before has them, so that some crossings have four arms
_TRIES = 40


def stagger(hall: Hall, options: WarehouseOptions, random: np.random.Generator) -> None:
    """Move the cross aisles between the rows' ends: row by row, up to `options.staggered` metres to either side.

    Those along the walls stay whole; what was one way across all rows becomes a way through each row.
    """
    inner = hall.crosses[("west" not in hall.closed) : len(hall.crosses) - ("east" not in hall.closed)]
    if not inner:
        return
    kept = [cross for cross in hall.crosses if cross not in inner]
    ways: list[Cross] = []
    before: list[float] = []
    for number, row in enumerate(hall.rows):
        if len(row.spans) < 2:
            continue
        ends = (row.spans[0][0], row.spans[-1][1])
        places = _places(inner, before, ends, options, random)
        row.spans = [ends]
        for u, cross in zip(places, inner, strict=True):
            row.cut(u - cross.width / 2, u + cross.width / 2)
            low = hall.aisles[number - 1].y if number else 0.0
            high = hall.aisles[number].y if number < len(hall.aisles) else hall.depth
            ways.append(dataclasses.replace(cross, u=u, low=low, high=high))
        before = places
    hall.crosses = kept + ways


def _places(
    inner: list[Cross], before: list[float], ends: Span, options: WarehouseOptions, random: np.random.Generator
) -> list[float]:
    """Where a row has its openings: clear of one another, of its ends, and of those of the row before."""
    width = inner[0].width
    for _ in range(_TRIES):
        places = [
            before[k]
            if before and random.random() < _ALIGNED
            else cross.u + float(random.uniform(-1.0, 1.0)) * options.staggered
            for k, cross in enumerate(inner)
        ]
        stops = [ends[0] - width / 2, *places, ends[1] + width / 2]
        roomy = all(b - a >= width + 2 * options.bay for a, b in itertools.pairwise(stops))
        if roomy and all(u == old or abs(u - old) >= width + _CLEAR for u in places for old in before):
            return places
    return before or [cross.u for cross in inner]
