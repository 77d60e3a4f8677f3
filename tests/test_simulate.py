"""The simulator: its bytes, its truth against its pixels, its parts against plain arithmetic."""

from __future__ import annotations

import dataclasses
import itertools
import json
import math
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import yaml
from _simulated import along, states

from groundplan._errors import FormatError, ParameterError
from groundplan.maps._map import FREE, OCCUPIED, UNKNOWN
from groundplan.simulate import Simulated, WarehouseOptions, warehouse
from groundplan.simulate._drift import Drift
from groundplan.simulate._drive import connected, explored, route
from groundplan.simulate._lidar import Pose, cast, grid_map
from groundplan.simulate._plan import Corridor, GroundPlan, Point, network
from groundplan.simulate._raster import city_block, rasterise
from groundplan.simulate._warehouse import warehouse_plan

SMALL: dict[str, Any] = {"width": 26.0, "depth": 20.0, "scan_every": 0.5, "beams": 480}


@cache
def small(**changes: Any) -> Simulated:
    return warehouse(seed=7, **(SMALL | changes))


def occupied(simulated: Simulated) -> npt.NDArray[np.float64]:
    """Centres of the occupied pixels in the map frame."""
    m = simulated.map
    rows, columns = np.nonzero(m.states[m.pixels] == OCCUPIED)
    x = m.origin[0] + (columns + 0.5) * m.resolution
    y = m.origin[1] + (m.height - rows - 0.5) * m.resolution
    return np.stack([x, y], axis=1)


def types(simulated: Simulated) -> dict[str, int]:
    count: dict[str, int] = {}
    for junction in simulated.truth["junctions"]:
        count[junction["type"]] = count.get(junction["type"], 0) + 1
    return count


def test_same_seed_same_bytes_and_another_seed_others() -> None:
    first, again = warehouse(seed=7, **SMALL), warehouse(seed=7, **SMALL)
    assert first.map.pixels.tobytes() == again.map.pixels.tobytes()
    assert json.dumps(first.truth) == json.dumps(again.truth)
    assert warehouse(seed=8, **SMALL).map.pixels.tobytes() != first.map.pixels.tobytes()


def test_more_noise_does_not_move_the_racks() -> None:
    before, after = small(drift=0.0), small(drift=0.0, noise=0.03)
    assert before.truth["junctions"] == after.truth["junctions"]
    assert before.map.pixels.tobytes() != after.map.pixels.tobytes()


def test_the_map_is_trinary_with_all_three_values() -> None:
    simulated = small()
    assert set(np.unique(simulated.map.pixels).tolist()) == {0, 205, 254}
    assert simulated.map.states[[0, 205, 254]].tolist() == [OCCUPIED, UNKNOWN, FREE]
    assert simulated.map.values[[0, 205, 254]].tolist() == [100, -1, 0]
    assert simulated.map.origin[0] != 0 and simulated.map.origin[1] != 0


@pytest.mark.parametrize("changes", [{}, {"yaw": 33.0, "skew": -14.0}, {"sparse": 0.6, "yaw": -70.0}, {"drift": 0.05}])
def test_true_lines_lie_on_what_the_map_shows(changes: dict[str, Any]) -> None:
    simulated = small(**({"drift": 0.0} | changes))
    marks = occupied(simulated)
    assert len(simulated.truth["lines"]) > 15
    for line in simulated.truth["lines"]:
        p, q, normal = np.array(line["p"]), np.array(line["q"]), np.array(line["normal"])
        length = float(np.linalg.norm(q - p))
        assert abs(normal @ p - line["offset"]) < 0.01 and abs(normal @ q - line["offset"]) < 0.01
        s, d = (marks - p) @ (q - p) / length, marks @ normal - line["offset"]
        near = (s >= 0) & (s <= length) & (np.abs(d) < 0.15)
        # Bay for bay something stands on the line, at its ends too.
        gaps = np.diff(np.concatenate([[0.0], np.sort(s[near]), [length]]))
        assert gaps.max() < 3.5
        if line["kind"] == "wall":
            assert abs(float(np.median(d[near]))) < (0.12 if "drift" in changes else 0.04)


@pytest.mark.parametrize("changes", [{}, {"yaw": 33.0, "skew": -14.0, "clutter": 2.0}])
def test_true_corridors_and_junctions_lie_on_free_floor(changes: dict[str, Any]) -> None:
    simulated = small(**changes)
    for corridor in simulated.truth["corridors"]:
        assert np.mean(states(simulated, along(corridor["a"], corridor["b"])) == FREE) > 0.98
    at = np.array([j["at"] for j in simulated.truth["junctions"]])
    assert (states(simulated, at) == FREE).all()


def test_directions_are_those_asked_for_and_of_the_true_lines() -> None:
    simulated = small(yaw=33.0, skew=-14.0)
    true = np.degrees(simulated.truth["directions"])
    assert true == pytest.approx([33.0, 33.0 + 90.0 - 14.0 - 180.0], abs=0.06)
    for line in simulated.truth["lines"]:
        angle = math.degrees(math.atan2(line["q"][1] - line["p"][1], line["q"][0] - line["p"][0]))
        assert np.abs((angle - true + 90) % 180 - 90).min() < 1.5


def test_the_layout_tells_the_types() -> None:
    # 26 m by 20 m: four aisles, two cross aisles along the walls, one between.
    assert len(small(cross_aisles=0).truth["corridors"]) == 6
    assert types(small(cross_aisles=0)) == {"L": 4, "T": 4}
    assert types(small(cross_aisles=1)) == {"L": 4, "T": 6, "X": 2}
    assert small().truth["ends"] == []


def test_a_closed_side_makes_dead_ends() -> None:
    west = small(closed_sides=("west",))
    assert types(west) == {"T": 4, "X": 2, "L": 2}
    assert len(west.truth["ends"]) == 4
    south = small(closed_sides=("south",), depth=24.0)
    assert len(south.truth["ends"]) == 3
    assert types(south)["L"] == 2 and all(
        j["arms"] == {"L": 2, "T": 3, "X": 4}[j["type"]] for j in south.truth["junctions"]
    )


def test_what_was_not_driven_is_not_asked_for() -> None:
    options: dict[str, Any] = {
        "width": 44.0,
        "depth": 30.0,
        "partial": 0.5,
        "lidar_range": 8.0,
        "scan_every": 0.6,
        "beams": 360,
    }
    part, whole = warehouse(seed=3, **options), warehouse(seed=3, **(options | {"partial": 0.0}))

    def length(simulated: Simulated, what: str, p: str, q: str) -> float:
        return sum(math.dist(item[p], item[q]) for item in simulated.truth[what])

    assert all(j["observed"] for j in whole.truth["junctions"])
    assert not all(j["observed"] for j in part.truth["junctions"])
    assert len(part.truth["junctions"]) == len(whole.truth["junctions"])
    assert length(part, "lines", "p", "q") < 0.85 * length(whole, "lines", "p", "q")
    assert length(part, "corridors", "a", "b") < 0.9 * length(whole, "corridors", "a", "b")
    for corridor in part.truth["corridors"]:
        assert np.mean(states(part, along(corridor["a"], corridor["b"])) == FREE) > 0.85


def test_options_reach_the_map() -> None:
    def floor(**changes: Any) -> float:
        m = small(**changes).map
        return float(np.sum(m.states[m.pixels] == FREE)) * m.resolution**2

    assert floor(sparse=0.8) > 1.05 * floor(sparse=0.0)
    assert floor(clutter=4.0) < floor(clutter=0.0)
    assert small(resolution=0.1).map.resolution == 0.1
    assert small(resolution=0.1).map.width == pytest.approx(small().map.width / 2, abs=25)


def test_write_gives_what_map_server_reads(tmp_path: Path) -> None:
    simulated = small()
    path = simulated.write(tmp_path / "new", "hall")
    assert sorted(p.name for p in path.parent.iterdir()) == ["hall.pgm", "hall.yaml", "truth.json"]
    m = simulated.map
    image = (path.parent / "hall.pgm").read_bytes()
    assert image == b"P5\n%d %d\n255\n" % (m.width, m.height) + m.pixels.tobytes()
    assert yaml.safe_load(path.read_text()) == {
        "image": "hall.pgm",
        "mode": "trinary",
        "resolution": 0.05,
        "origin": list(m.origin),
        "negate": 0,
        "occupied_thresh": 0.65,
        "free_thresh": 0.196,
    }
    truth = json.loads((path.parent / "truth.json").read_text())
    assert truth == simulated.truth
    assert truth["seed"] == 7
    options: dict[str, Any] = {k: tuple(v) if isinstance(v, list) else v for k, v in truth["options"].items()}
    assert WarehouseOptions(**options) == WarehouseOptions(**SMALL)


def test_a_place_that_cannot_be_written_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("a file")
    with pytest.raises(FormatError, match="taken"):
        small().write(tmp_path / "taken")


@pytest.mark.parametrize(
    ("changes", "code", "named"),
    [
        ({"yaw": math.nan}, "simulate.range", "nan"),
        ({"sparse": 1.5}, "simulate.range", "1.5"),
        ({"closed_sides": ("left",)}, "simulate.side", "left"),
        ({"closed_sides": ("east", "west"), "cross_aisles": 0}, "simulate.disconnected", "east and west"),
        ({"width": 12.0, "cross_aisles": 5}, "simulate.small", "12.0"),
        ({"depth": 10.0, "rack_depth": 3.0, "closed_sides": ("south",)}, "simulate.small", "10.0"),
        ({"jaw": 3.0}, "simulate.unknown", "jaw"),
        ({"seed": -1}, "simulate.seed", "-1"),
    ],
)
def test_wrong_options_name_the_value(changes: dict[str, Any], code: str, named: str) -> None:
    with pytest.raises(ParameterError, match=named) as caught:
        warehouse(**changes)
    assert caught.value.code == code


def test_every_option_says_what_it_is() -> None:
    for item in dataclasses.fields(WarehouseOptions):
        assert item.metadata["help"].endswith(".")
        if "least" in item.metadata:
            assert item.metadata["least"] <= item.default <= item.metadata["most"]


@pytest.mark.parametrize(
    "changes",
    [
        {"width": 12.0, "depth": 10.0, "cross_aisles": 0},
        {"skew": 35.0, "closed_sides": ("south", "east", "north"), "partial": 0.9},
        {"sparse": 1.0, "clutter": 10.0, "lidar_range": 2.0, "drift": 1.0, "noise": 0.5},
        {"resolution": 0.5, "beams": 60, "scan_every": 5.0, "bay": 1.0},
    ],
)
def test_the_far_corners_of_the_options_still_give_a_map(changes: dict[str, Any]) -> None:
    simulated = warehouse(seed=1, **({"width": 24.0, "depth": 22.0} | changes))
    assert simulated.map.pixels.size > 0
    assert len(simulated.truth["directions"]) == 2


def test_network_finds_nodes_arms_and_roads() -> None:
    ways = [Corridor((0, 0), (20, 0), 3), Corridor((0, 0), (0, 10), 3), Corridor((10, -10), (10, 10), 3)]
    net = network(ways)
    kinds = {tuple(round(v) for v in node.at): node.kind for node in net.nodes}
    assert kinds == {(0, 0): "L", (10, 0): "X", (20, 0): "end", (0, 10): "end", (10, -10): "end", (10, 10): "end"}
    assert sorted(net.length(road) for road in net.roads) == [10, 10, 10, 10, 10]


@pytest.mark.parametrize("gap", [0.5, 8.0])
@pytest.mark.parametrize("side", ["east", "north"])
def test_halls_are_one_network_through_a_closed_side_too(side: str, gap: float) -> None:
    # A passage from an aisle's end is in line with the aisle and may be shorter than a crossing is wide.
    for seed in range(5):
        options = WarehouseOptions(halls=2, gap=gap, closed_sides=(side,))
        net = network(warehouse_plan(options, np.random.default_rng(seed)).corridors)
        assert connected(net.roads)
        assert {n for road in net.roads for n in road} == set(range(len(net.nodes)))


def test_network_does_not_count_a_stub_as_an_arm() -> None:
    net = network([Corridor((0, 0), (20, 0), 3), Corridor((10, -1.5), (10, 10), 3)])
    assert next(n.kind for n in net.nodes if n.at == (10.0, 0.0)) == "T"


def test_the_route_drives_every_road_in_one_piece() -> None:
    plan = warehouse_plan(WarehouseOptions(), np.random.default_rng(1))
    net = network(plan.corridors)
    driven, _ = explored(net, 0.3, np.random.default_rng(2))
    left_out = 1 - sum(map(net.length, driven)) / sum(map(net.length, net.roads))
    assert left_out == pytest.approx(0.3, abs=0.08)
    points = route(net, driven, [])
    number = {node.at: k for k, node in enumerate(net.nodes)}
    steps = {frozenset((number[a], number[b])) for a, b in itertools.pairwise(points)}
    assert steps == {frozenset(road) for road in driven}


def test_city_block_is_the_distance() -> None:
    taken = np.random.default_rng(0).random((23, 31)) < 0.02
    rows, columns = np.nonzero(taken)
    y, x = np.mgrid[0:23, 0:31]
    plain = (abs(y[..., None] - rows) + abs(x[..., None] - columns)).min(axis=-1)
    assert (city_block(taken) == plain).all()


def room() -> GroundPlan:
    corners: list[Point] = [(0, 0), (8, 0), (8, 6), (0, 6)]
    plan = GroundPlan([0.0, math.pi / 2], corners)
    for centre, length, width in (
        ((4, -0.1), 8.4, 0.2),
        ((8.1, 3), 0.2, 6.4),
        ((4, 6.1), 8.4, 0.2),
        ((-0.1, 3), 0.2, 6.4),
    ):
        plan.box(centre, length, width)
    return plan


def test_ranges_are_those_of_geometry() -> None:
    world = rasterise(room())
    pose = Pose(3.0, 2.0, 0.3)
    ranges = cast(world, [pose], 720, 4.5, 0.0, np.random.default_rng(0))[0]
    angles = 0.3 + 2 * np.pi * np.arange(720) / 720
    c, s = np.cos(angles), np.sin(angles)
    wall = np.minimum(np.where(c > 0, 5.0, 3.0) / np.abs(c), np.where(s > 0, 4.0, 2.0) / np.abs(s))
    assert np.isinf(ranges[wall > 4.55]).all()
    assert np.abs(ranges - wall)[wall < 4.45].max() < 0.06


def test_a_beam_clears_its_way_and_marks_its_end() -> None:
    poses = [Pose(3.0 + 0.1 * k, 2.0, 0.0) for k in range(6)]
    ranges = cast(rasterise(room()), poses, 720, 15.0, 0.0, np.random.default_rng(0))
    pixels = grid_map(poses, ranges, 15.0, (-1.0, -1.0), (160, 200), 0.05)[::-1]
    assert np.mean(pixels[24:136, 24:176] == 254) > 0.99  # inside, a few pixels off the walls
    assert (pixels[:16] == 205).all() and (pixels[:, 188:] == 205).all()  # behind them
    assert np.mean((pixels[22:138, 179:182] == 0).any(axis=1)) > 0.98


def test_drift_neither_turns_nor_moves_nor_stretches_the_site() -> None:
    outline: list[Point] = [(0, 0), (40, 0), (40, 30), (0, 30)]
    drift = Drift(0.1, outline, np.random.default_rng(3))
    grid = np.array([(2.0 * i, 1.5 * j) for i in range(21) for j in range(21)])
    error = np.array([drift.bend((x, y)) for x, y in grid.tolist()]) - grid
    assert np.sqrt(np.mean(error**2)) == pytest.approx(0.1, rel=1e-6)
    assert np.abs(error.mean(axis=0)).max() < 1e-9
    assert np.abs((grid - grid.mean(axis=0)).T @ error).max() < 1e-6
    assert Drift(0.0, outline, np.random.default_rng(3)).bend((3.0, 4.0)) == (3.0, 4.0)
