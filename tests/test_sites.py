"""Simulated sites of more than one regular hall: their truth against their pixels, and their network against reason."""

from __future__ import annotations

import itertools
import math
from functools import cache
from typing import Any

import numpy as np
import pytest
from _simulated import along, states

from groundplan._errors import ParameterError
from groundplan.maps._map import FREE, OCCUPIED
from groundplan.simulate import Simulated, WarehouseOptions, warehouse
from groundplan.simulate._drift import Drift
from groundplan.simulate._halls import site
from groundplan.simulate._plan import Corridor, Point, network
from groundplan.simulate._ports import apart
from groundplan.simulate._truth import _straights
from groundplan.simulate._warehouse import warehouse_plan

SMALL: dict[str, Any] = {"width": 30.0, "depth": 22.0, "scan_every": 0.6, "beams": 400, "drift": 0.0}


@cache
def small(**changes: Any) -> Simulated:
    return warehouse(seed=5, **(SMALL | changes))


KINDS: list[dict[str, Any]] = [
    {"halls": 2, "crosswise": True, "gap": 3.0, "skew": 10.0, "yaw": 20.0},
    {"wing": 35.0, "gap": 3.0},
    {"staggered": 8.0, "width": 44.0, "uneven": 0.6, "goods": 0.5},
    {"lidar_range": 5.0, "bend": 0.3, "width": 40.0, "yaw": -12.0},
]


@pytest.mark.parametrize("changes", KINDS, ids=lambda changes: next(iter(changes)))
def test_truth_lies_where_the_map_shows_it(changes: dict[str, Any]) -> None:
    simulated = small(**changes)
    for corridor in simulated.truth["corridors"]:
        assert np.mean(states(simulated, along(corridor["a"], corridor["b"])) == FREE) > 0.95
    seen = np.array([j["at"] for j in simulated.truth["junctions"] if j["observed"]])
    assert len(seen) > 8 and (states(simulated, seen) == FREE).all()
    marked, length = 0.0, 0.0
    for line in simulated.truth["lines"]:
        points, normal = along(line["p"], line["q"]), np.array(line["normal"])
        looks = [states(simulated, points + off * normal) == OCCUPIED for off in np.arange(-0.2, 0.21, 0.05)]
        share = float(np.mean(np.any(looks, axis=0)))
        assert share > (0.8 if line["kind"] == "wall" and math.dist(line["p"], line["q"]) > 5 else 0.05)
        marked, length = marked + share * len(points), length + len(points)
    assert marked > 0.65 * length


def test_an_option_of_a_kind_changes_nothing_else() -> None:
    plain = small()
    for changes in ({"gap": 9.0}, {"crosswise": True}):
        assert small(**changes).map.pixels.tobytes() == plain.map.pixels.tobytes()


@pytest.mark.parametrize("seed", range(6))
def test_halls_lie_apart_and_everything_is_in_one_piece(seed: int) -> None:
    options = WarehouseOptions(halls=4, crosswise=True, wing=-40.0, staggered=6.0, uneven=0.5, skew=6.0, gap=1.0)
    halls, passages = site(options, np.random.default_rng(seed))
    assert len(halls) == 5 and len(passages) == 4
    for one, other in itertools.combinations(halls, 2):
        assert apart(one.corners(), other.corners()) > 0.45
    plan = warehouse_plan(options, np.random.default_rng(seed))
    net = network(plan.corridors)
    reached, todo = {0}, [0]
    while todo:
        here = todo.pop()
        fresh = {n for road in net.roads if here in road for n in road} - reached
        reached |= fresh
        todo += fresh
    assert len(reached) == len(net.nodes)
    assert {node.kind for node in net.nodes} <= {"L", "T", "X", "Y", None}
    for one_node, other_node in itertools.combinations(net.nodes, 2):
        assert math.dist(one_node.at, other_node.at) > 3.0  # twice what a found junction may be off


def test_directions_are_those_of_every_hall() -> None:
    def degrees(**changes: Any) -> list[float]:
        return sorted(math.degrees(a) for a in small(**changes).truth["directions"])

    assert degrees(halls=2, crosswise=True) == pytest.approx([-90.0, 0.0], abs=0.05)
    assert degrees(wing=35.0) == pytest.approx([-90.0, -55.0, 0.0, 35.0], abs=0.05)
    assert degrees(wing=-20.0, skew=5.0) == pytest.approx([-85.0, -20.0, 0.0, 75.0], abs=0.05)


def test_staggered_ways_open_each_row_at_a_place_of_its_own() -> None:
    options = WarehouseOptions(width=60.0, depth=36.0, staggered=10.0, cross_aisles=1)
    (hall,), _ = site(options, np.random.default_rng(3))
    places = [row.spans[0][1] for row in hall.rows[1:-1]]
    assert len({round(p, 6) for p in places}) > 2
    for a, b in itertools.pairwise(places):
        assert a == b or abs(a - b) > 5.0
    regular, _ = site(WarehouseOptions(width=60.0, depth=36.0), np.random.default_rng(3))
    assert len(hall.crosses) == 2 + len(places) and len(regular[0].crosses) == 3


def test_uneven_rows_differ_in_length_and_depth() -> None:
    (hall,), _ = site(WarehouseOptions(uneven=0.8), np.random.default_rng(1))
    inner = hall.rows[1:-1]
    assert len({round(row.y1 - row.y0, 6) for row in inner}) == len(inner)
    starts = [row.spans[0][0] for row in inner]
    assert len(set(starts)) > 1
    assert not any(a > min(starts) and b > min(starts) for a, b in itertools.pairwise(starts))


def test_arms_lead_somewhere() -> None:
    main = Corridor((0, 0), (20, 0), 3)
    kinds = {}
    for length in (2.5, 4.5):
        net = network([main, Corridor((10, 0), (10, length), 3)])
        kinds[length] = next(n.kind for n in net.nodes if n.at == (10.0, 0.0))
    assert kinds == {2.5: None, 4.5: "T"}
    # However short, a way to another crossing is an arm.
    net = network([main, Corridor((10, 0), (10, 3.2), 3), Corridor((0, 3.2), (20, 3.2), 3)])
    assert sorted(str(n.kind) for n in net.nodes) == ["T", "T", "end", "end", "end", "end"]


@pytest.mark.parametrize(("angle", "kind"), [(90, "T"), (70, "T"), (60, "Y"), (50, "Y"), (30, "Y")])
def test_a_slanted_third_way_makes_a_y(angle: float, kind: str) -> None:
    a = math.radians(angle)
    net = network([Corridor((0, 0), (20, 0), 3), Corridor((10, 0), (10 + 9 * math.cos(a), 9 * math.sin(a)), 3)])
    assert next(n.kind for n in net.nodes if n.at == (10.0, 0.0)) == kind


def test_a_bend_is_smooth_and_as_great_as_asked_for() -> None:
    outline: list[Point] = [(0, 0), (80, 0), (80, 50), (0, 50)]
    drift = Drift(0.0, outline, np.random.default_rng(1), 0.3, np.random.default_rng(2))
    grid = [(4.0 * i, 2.5 * j) for i in range(21) for j in range(21)]
    shifts = [math.dist(drift.bend(p), p) for p in grid]
    assert max(shifts) == pytest.approx(0.3)
    for x, y in grid:
        assert math.dist(drift.bend((x + 1, y)), drift.bend((x, y))) == pytest.approx(1.0, abs=0.1)


def test_a_bent_line_is_told_in_straight_pieces() -> None:
    points: list[Point] = [(0.1 * k, 0.0) for k in range(300)]
    assert len(_straights(points, lambda p: p)) == 1
    pieces = _straights(points, lambda p: (p[0], 0.4 * math.sin(2 * math.pi * p[0] / 40)))
    assert 3 <= len(pieces) <= 7
    for (ax, ay), (bx, by) in pieces:
        for x, y in ((ax, ay), (bx, by)):
            assert abs(y - 0.4 * math.sin(2 * math.pi * x / 40)) < 0.12
    assert sum(math.dist(p, q) for p, q in pieces) == pytest.approx(29.9, abs=0.1 * len(pieces) + 0.2)


def test_halls_that_cannot_be_joined_are_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("groundplan.simulate._halls.ports", lambda *_: [])
    with pytest.raises(ParameterError, match="cannot be joined"):
        site(WarehouseOptions(halls=2), np.random.default_rng(0))
