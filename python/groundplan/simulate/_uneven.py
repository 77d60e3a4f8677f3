"""Rows of different length and depth."""

from __future__ import annotations

import dataclasses

import numpy as np

from groundplan.simulate._hall import FLUE, Hall
from groundplan.simulate._options import WarehouseOptions

_DEEPER = 0.3  # by how much of a rack's depth a row's face moves at most
_SHORTEST = 3  # bays that a shortened piece keeps


def make_uneven(hall: Hall, options: WarehouseOptions, random: np.random.Generator) -> None:
    """Move the faces of the rows between two aisles, and let some rows end one or two bays before the way at the wall.

    Of two neighbouring rows only one ends early, so that the other still shows where the aisle between them begins.
    """
    inner = [row for row in hall.rows if row.below and row.above]
    for row in inner:
        reach = _DEEPER * options.uneven * options.rack_depth
        row.y0 += float(random.uniform(-1, 1)) * reach
        row.y1 += float(random.uniform(-1, 1)) * reach
        row.deep = (row.y1 - row.y0 - FLUE) / 2
    for k, aisle in enumerate(hall.aisles):
        low, high = hall.rows[k].y1, hall.rows[k + 1].y0
        hall.aisles[k] = dataclasses.replace(aisle, y=(low + high) / 2, width=high - low)
    _follow(hall)
    for side in ("west", "east"):
        if side in hall.closed:
            continue
        early = False
        for row in inner:
            early = not early and random.random() < options.uneven
            short = int(random.integers(1, 3)) * options.bay
            start, end = row.spans[0] if side == "west" else row.spans[-1]
            if not early or end - start < short + _SHORTEST * options.bay:
                continue
            if side == "west":
                row.spans[0] = (start + short, end)
            else:
                row.spans[-1] = (start, end - short)


def _follow(hall: Hall) -> None:
    """Let the cross aisles end at the aisles' centre lines where those are now."""
    south, north = "south" in hall.closed, "north" in hall.closed
    low = 0.0 if south else hall.aisles[0].y
    high = hall.depth if north else hall.aisles[-1].y
    hall.crosses = [dataclasses.replace(cross, low=low, high=high) for cross in hall.crosses]
