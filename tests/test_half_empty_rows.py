"""Small halls of which more than half of the bays are empty: posts that are seen at empty bays tell where bays are, and
bars across the rows' ends tell ways from them."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from _legs import Box, hall, legs
from shapely import Polygon

import groundplan
from groundplan.evaluate import score
from groundplan.simulate import warehouse

SCANNED: dict[str, Any] = {"scan_every": 0.8, "beams": 400, "cross_aisles": 1}
HALLS: dict[str, dict[str, Any]] = {
    "three-rows": {
        "seed": 43,
        "width": 26,
        "depth": 20,
        "aisle": 3.2,
        "cross_aisle": 3.2,
        "bay": 2.78,
        "rack_depth": 1.14,
    }
    | {"sparse": 0.65, "yaw": 15.8},
    "shallow-racks": {"seed": 82, "width": 26, "depth": 20, "aisle": 3.6, "cross_aisle": 3.5, "bay": 3.47}
    | {"rack_depth": 0.89, "sparse": 0.6, "yaw": -54.9},
    "two-halls": {
        "seed": 5,
        "width": 40,
        "depth": 20,
        "aisle": 3.2,
        "cross_aisle": 4.3,
        "bay": 3.69,
        "rack_depth": 1.17,
    }
    | {"sparse": 0.65, "yaw": 44.2, "halls": 2, "gap": 0.5},
}
#: Few posts recur along any line, but frames stand by themselves a bay apart.
FEW: dict[str, dict[str, Any]] = {
    "frames": {
        "seed": 12071,
        "width": 26,
        "depth": 26,
        "aisle": 2.3,
        "cross_aisle": 3.9,
        "bay": 2.66,
        "rack_depth": 0.9,
    }
    | {"sparse": 0.6, "yaw": -79.8},
    "posts-at-walls": {
        "seed": 12044,
        "width": 26,
        "depth": 16,
        "aisle": 2.7,
        "cross_aisle": 4.2,
        "bay": 3.62,
        "rack_depth": 0.85,
    }
    | {"sparse": 0.6, "yaw": 6.8},
}
#: A bay of each row is empty at one place, between posts; the rows' ends are closed.
CLOSED: dict[str, dict[str, Any]] = {
    "second-bays": {
        "seed": 12028,
        "width": 32,
        "depth": 26,
        "aisle": 3.4,
        "cross_aisle": 3.2,
        "bay": 3.35,
        "rack_depth": 1.16,
    }
    | {"sparse": 0.65, "yaw": 32.1},
    "last-bays": {
        "seed": 12571,
        "width": 40,
        "depth": 26,
        "aisle": 2.5,
        "cross_aisle": 3.2,
        "bay": 1.95,
        "rack_depth": 0.88,
    }
    | {"sparse": 0.6, "yaw": 35.9},
}


def is_right(options: dict[str, Any]) -> bool:
    """True when all junctions of a hall are found, no others, and its aisles."""
    simulated = warehouse(**(SCANNED | options))
    found = score(groundplan.survey(simulated.map).to_dict(), simulated.truth)
    return bool(found["junction_typed_f1"] == 1 and found["corridor_recall"] > 0.95)


@pytest.mark.parametrize("name", HALLS)
def test_aisles_and_crossings_of_half_empty_halls_are_found(name: str) -> None:
    assert is_right(HALLS[name] | {"drift": 0.0})


@pytest.mark.parametrize("name", FEW)
def test_bays_are_told_by_frames_that_stand_alone_where_too_few_posts_recur(name: str) -> None:
    assert is_right(FEW[name])


@pytest.mark.parametrize("name", CLOSED)
def test_an_empty_bay_of_each_row_between_posts_is_no_way_where_the_rows_ends_are_closed(name: str) -> None:
    assert is_right(CLOSED[name])


def test_what_posts_alone_part_from_the_way_past_the_ends_of_rows_is_their_last_bay() -> None:
    options: dict[str, Any] = {"seed": 12561, "yaw": -53.5, "width": 26, "depth": 16, "aisle": 2.7, "cross_aisle": 3.5}
    site = warehouse(**options, **SCANNED, bay=3.09, rack_depth=1.05, sparse=0.65, halls=2, gap=0.5)
    ways = [Polygon(way["polygon"]) for way in groundplan.survey(site.map).of_kind("corridor")]
    parted = [one.distance(two) for one, two in itertools.combinations(ways, 2) if not one.intersects(two)]
    # Of two that lie side by side between the ends of both rows of the other hall one is a way, and which is not told.
    assert [gap for gap in parted if gap < 0.5] == pytest.approx([0.3], abs=0.05)


@pytest.mark.parametrize(("share", "seed"), [(0.33, 44), (0.33, 56), (0.4, 43), (0.4, 44)])
def test_empty_bays_in_line_with_bays_that_goods_reach_into_are_no_way(share: float, seed: int) -> None:
    # Eight rows of two racks with so much of their room taken. Of five rows one bay in line is empty, but for a pallet
    # at its side in two of them.
    random = np.random.default_rng(seed)

    def boxes() -> Iterator[Box]:
        for row, rack in itertools.product(range(8), range(2)):
            low = 3.0 + 5.2 * row + 1.1 * rack
            yield from legs(4.0, low, 13, 1.1, 3.2)
            for bay, place in itertools.product(range(13), range(3)):
                stands = random.random() < share
                if bay == 11 and 1 <= row <= 5:
                    stands = (row, rack, place) in ((1, 0, 2), (2, 1, 0))
                if stands:
                    left = 4.15 + 3.2 * bay + place
                    yield left, low + 0.05, left + 0.9, low + 1.05

    survey = groundplan.survey(hall(49.7, 44.6, boxes(), 17.0), resolution=0.05)
    assert sorted(junction["type"] for junction in survey.of_kind("junction")) == ["L"] * 4 + ["T"] * 14
