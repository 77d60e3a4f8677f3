"""Ways keep clear of what is occupied, are short, and are none where there is none."""

from __future__ import annotations

import json
import math
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import zoo
from _program import call
from zoo import RESOLUTION, Canvas

import groundplan
from groundplan import Map, ParameterError, Route, Survey
from groundplan.maps import FREE, OCCUPIED

spatial = pytest.importorskip("scipy.spatial")
csgraph = pytest.importorskip("scipy.sparse.csgraph")
sparse = pytest.importorskip("scipy.sparse")

SEEDS = (3, 11)
Points = npt.NDArray[np.float64]


@cache
def site(seed: int) -> tuple[Map, Survey]:
    """A simulated warehouse, and its survey."""
    from groundplan.simulate import warehouse

    map = warehouse(seed=seed, width=26.0, depth=20.0, scan_every=0.5, beams=480).map
    return map, groundplan.survey(map, threads=1)


def centres(map: Map, state: int) -> Points:
    """The middles of the pixels of a state, metres in the map frame."""
    rows, columns = np.nonzero(map.states[map.pixels] == state)
    x, y = (columns + 0.5) * map.resolution, (map.height - rows - 0.5) * map.resolution
    ox, oy, yaw = map.origin
    return np.column_stack([ox + x * math.cos(yaw) - y * math.sin(yaw), oy + x * math.sin(yaw) + y * math.cos(yaw)])


def sampled(way: Route, step: float = 0.01) -> Points:
    """Points along a way, a centimetre apart."""
    parts = []
    for p, q in zip(way.points, way.points[1:], strict=False):
        t = np.linspace(0, 1, max(2, math.ceil(float(np.hypot(*(q - p))) / step)))[:, None]
        parts.append(p + t * (q - p))
    return np.concatenate(parts)


def least_clearance(map: Map, way: Route) -> float:
    """Metres from the way to the nearest point of any occupied pixel (of maps whose origin is not turned)."""
    occupied, points = centres(map, OCCUPIED), sampled(way)
    near = spatial.cKDTree(occupied).query_ball_point(points, way.clearance + 2 * map.resolution)
    least = math.inf
    for point, found in zip(points, near, strict=True):
        if found:
            beyond = np.maximum(np.abs(occupied[found] - point) - map.resolution / 2, 0)
            least = min(least, float(np.hypot(*beyond.T).min()))
    return least


def shortest(map: Map, a: Points, b: Points, clearance: float) -> float:
    """The shortest way over pixels that keep the clearance from the middles of the occupied ones; infinite without one.

    Over 32 neighbours, so less than one percent too long.
    """
    free = map.states[map.pixels[::-1]] == FREE
    middles = centres(map, OCCUPIED)
    rows, columns = np.nonzero(free)
    own = np.column_stack([columns + 0.5, rows + 0.5]) * map.resolution + np.array(map.origin[:2])
    keeps = spatial.cKDTree(middles).query(own)[0] >= clearance
    ids = np.full(free.shape, -1)
    ids[rows[keeps], columns[keeps]] = np.arange(keeps.sum())
    height, width = free.shape
    links: list[tuple[Any, Any, Any]] = []
    for dx in range(-3, 4):
        for dy in range(4):
            if math.gcd(dx, dy) != 1 or (dy == 0 and dx < 0):
                continue
            one = ids[: height - dy, max(0, -dx) : width - max(0, dx)]
            two = ids[dy:, max(0, dx) : width + min(0, dx)]
            both = (one >= 0) & (two >= 0)
            links.append((one[both], two[both], np.full(both.sum(), math.hypot(dx, dy) * map.resolution)))
    one, two, far = (np.concatenate(part) for part in zip(*links, strict=True))
    graph = sparse.csr_matrix((far, (one, two)), shape=(keeps.sum(),) * 2)
    start, end = (int(spatial.cKDTree(own[keeps]).query(p)[1]) for p in (a, b))
    return float(csgraph.dijkstra(graph, directed=False, indices=start)[end])


def pairs(map: Map, survey: Survey, clearance: float, count: int) -> list[tuple[Points, Points]]:
    """Pairs of free points where a robot may be, metres apart."""
    free, random = centres(map, FREE), np.random.default_rng(5)
    found: list[tuple[Points, Points]] = []
    while len(found) < count:
        a, b = free[random.integers(0, len(free), 2)]
        try:
            survey.route(a, a, clearance=clearance, map=map), survey.route(b, b, clearance=clearance, map=map)
        except ParameterError:
            continue
        if np.hypot(*(a - b)) > 6:
            found.append((a, b))
    return found


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("clearance", [0.2, 0.45])
def test_a_way_keeps_its_clearance_and_is_hardly_longer_than_the_shortest(seed: int, clearance: float) -> None:
    map, survey = site(seed)
    found = 0
    for a, b in pairs(map, survey, clearance, 6):
        way = survey.route(a, b, clearance=clearance)
        if way is None:
            # With what the pixels' own size takes of the room, there may be none where the reference just has one.
            assert shortest(map, a, b, clearance + 2 * map.resolution) == math.inf
            continue
        found += 1
        assert (way.points[0] == a).all()
        assert (way.points[-1] == b).all()
        assert way.length == pytest.approx(np.hypot(*np.diff(way.points, axis=0).T).sum())
        assert least_clearance(map, way) >= clearance - 1e-6
        assert way.length <= 1.05 * shortest(map, a, b, clearance)
    assert found >= 4


@pytest.mark.parametrize("seed", SEEDS)
def test_a_way_lies_in_free_pixels(seed: int) -> None:
    map, survey = site(seed)
    for a, b in pairs(map, survey, 0.0, 4):
        way = survey.route(a, b, clearance=0.0)
        assert way is not None
        columns, rows = ((sampled(way) - map.origin[:2]) / map.resolution).T
        assert (map.states[map.pixels[map.height - 1 - rows.astype(int), columns.astype(int)]] == FREE).all()


@pytest.mark.parametrize("seed", SEEDS)
def test_the_faces_of_a_way_are_those_it_passes_through(seed: int) -> None:
    map, survey = site(seed)
    (a, b), *_ = pairs(map, survey, 0.3, 1)
    way = survey.route(a, b, clearance=0.3)
    assert way is not None
    x, y = sampled(way, 0.002).T
    along = survey.locate(x, y)
    assert set(along.tolist()) <= set(way.faces.tolist())
    assert (way.faces[0], way.faces[-1]) == (survey.locate(*a), survey.locate(*b))
    linked = {frozenset(pair) for pair in survey.adjacency.faces.tolist()}
    steps = [frozenset(pair) for pair in zip(way.faces.tolist(), way.faces[1:].tolist(), strict=False)]
    assert all(step in linked for step in steps)


def rooms(door: float) -> Map:
    """Two rooms of 3.6 m by 3.2 m, and a door so many pixels wide in the wall between."""
    plan = Canvas(160, 90).room(10, 10, 82, 80).room(79, 10, 150, 80)
    plan.box(79, 40 - door / 2, 82, 40 + door / 2, zoo.FREE)
    return groundplan.from_array(plan.picture, RESOLUTION)


LEFT, RIGHT = (1.5, 3.0), (6.5, 1.2)


def test_an_open_door_is_a_way_and_a_closed_one_is_none() -> None:
    way = groundplan.survey(rooms(16)).route(LEFT, RIGHT, clearance=0.3)
    assert way is not None
    at_door = sampled(way)[np.abs(sampled(way)[:, 0] - 4.0) < 0.05]
    assert ((at_door[:, 1] > 1.9 - 0.25) & (at_door[:, 1] < 2.1 + 0.25)).all()
    assert groundplan.survey(rooms(0)).route(LEFT, RIGHT, clearance=0.3) is None


def test_a_robot_too_wide_for_the_door_has_no_way() -> None:
    survey = groundplan.survey(rooms(16))
    assert survey.route(LEFT, RIGHT, clearance=0.36) is not None
    assert survey.route(LEFT, RIGHT, clearance=0.42) is None


def test_a_survey_from_a_file_knows_walls_and_doors() -> None:
    for door, clearance in ((16, 0.3), (0, 0.3)):
        map = rooms(door)
        survey = Survey.from_json(groundplan.survey(map).to_json())
        way = survey.route(LEFT, RIGHT, clearance=clearance)
        assert (way is None) == (door == 0)
        if way is not None:
            assert least_clearance(map, way) >= clearance
            # With the map it is the way of the survey that was just made.
            made = groundplan.survey(map).route(LEFT, RIGHT, clearance=clearance)
            assert survey.route(LEFT, RIGHT, clearance=clearance, map=map) == made


@pytest.mark.parametrize("seed", SEEDS)
def test_what_stands_in_rows_is_kept_clear_of_without_the_map(seed: int) -> None:
    map, survey = site(seed)
    read = Survey.from_json(survey.to_json())
    names = [label["name"] for label in survey.of_kind("corridor")]
    ways = [read.route(names[0], name, clearance=0.3) for name in names[1:]]
    kept = [least_clearance(map, way) for way in ways if way is not None]
    assert len(kept) >= 2
    assert sum(clearance >= 0.3 - 1e-6 for clearance in kept) >= 0.75 * len(kept)


@cache
def racks_on_legs() -> Map:
    """A hall of 20 m by 14 m with three racks of six bays, of which a lidar sees the legs."""
    drawn = Canvas(440, 320).room(20, 20, 420, 300)
    for row in range(3):
        for column in range(7):
            for side in (0, 20):
                x, y = 92 + 42 * column, 78 + 70 * row + side
                drawn.box(x, y, x + 2, y + 2)
    return groundplan.from_array(drawn.picture, RESOLUTION)


def test_a_way_under_racks_is_told_and_one_around_them_keeps_off_them() -> None:
    map = racks_on_legs()
    survey = groundplan.survey(map)
    assert len(survey.of_kind("rack")) == 3
    below, above = (11.0, 2.5), (11.0, 12.5)
    under = survey.route(below, above, clearance=0.4)
    assert under is not None
    assert sorted(under.racks) == sorted(rack["name"] for rack in survey.of_kind("rack"))
    assert under.length == pytest.approx(10.0, abs=0.5)
    for asked, of_map in ((survey, None), (Survey.from_json(survey.to_json()), None), (survey, map)):
        around = asked.route(below, above, clearance=0.4, around_racks=True, map=of_map)
        assert around is not None
        assert around.racks == ()
        assert around.length > 15.0
        for rack in survey.of_kind("rack"):
            low, high = np.min(rack["polygon"], axis=0), np.max(rack["polygon"], axis=0)
            apart = np.hypot(*np.maximum(0, np.maximum(low - sampled(around), sampled(around) - high)).T)
            # A pixel is taken by its middle.
            assert apart.min() >= 0.4 - RESOLUTION / 2
    # A rack itself is gone up to.
    name = survey.of_kind("rack")[0]["name"]
    for around_racks in (False, True):
        up_to = survey.route(below, name, clearance=0.4, around_racks=around_racks)
        assert up_to is not None
        assert name not in up_to.racks
    middle = np.mean(survey.of_kind("rack")[0]["axis"], axis=0)
    with pytest.raises(ParameterError, match=f"is in {name}"):
        survey.route(below, middle, clearance=0.4, around_racks=True)


def test_places_are_points_names_and_faces() -> None:
    _, survey = site(SEEDS[0])
    corridor = survey.of_kind("corridor")[0]
    middle = np.mean(corridor["axis"], axis=0)
    to_name = survey.route(survey.of_kind("corridor")[1]["name"], corridor["name"])
    assert to_name is not None
    assert np.hypot(*(to_name.points[-1] - middle)) < 0.5 * corridor["width"] + 1.0
    face = int(np.argmax(survey.occupancy.free * survey.subdivision.areas))
    to_face = survey.route(corridor["name"], face)
    assert to_face is not None
    assert to_face.faces[-1] == face
    # As exports name what has no name of its own.
    from groundplan.export._places import places

    crossing = next(place for place in places(survey) if place.name == "J01")
    to_crossing = survey.route(corridor["name"], "J01")
    assert to_crossing is not None
    assert to_crossing.points[-1] == pytest.approx(crossing.centre, abs=0.5)
    stay = survey.route(face, face)
    assert stay is not None
    assert (stay.length, stay.faces.tolist()) == (0.0, [face])


@pytest.mark.parametrize("seed", SEEDS)
def test_every_place_has_a_way_to_itself_or_no_room(seed: int) -> None:
    map, survey = site(seed)
    free = np.flatnonzero(survey.occupancy.free > 0.5).tolist()
    assert len(free) > 20
    for face in free:
        try:
            way = survey.route(face, face, clearance=0.3, map=map)
        except ParameterError as fault:
            assert fault.code == "route.blocked"
        else:
            assert way is not None, face


@pytest.mark.parametrize(
    ("place", "clearance", "code", "said"),
    [
        ("A99", 0.3, "route.name", "A99"),
        (10_000, 0.3, "route.face", "10000"),
        (-1, 0.3, "route.face", "-1"),
        ((1.0, 2.0, 3.0), 0.3, "route.place", "3.0"),
        (None, 0.3, "route.place", "None"),
        ((math.nan, 1.0), 0.3, "point.finite", "nan"),
        ((-5.0, 1.0), 0.3, "route.outside", "-5"),
        ((0.6, 2.0), 0.3, "route.blocked", "0.6"),
        (LEFT, -0.1, "route.clearance", "-0.1"),
        (LEFT, math.inf, "route.clearance", "inf"),
        (LEFT, 10**400, "route.clearance", "1000"),
        ("a99", 0.3, "route.name", "a99"),
        (LEFT, "wide", "route.clearance", "wide"),
        (LEFT, 5.0, "route.blocked", "5 m"),
    ],
)
def test_what_is_no_place_is_named(place: Any, clearance: Any, code: str, said: str) -> None:
    with pytest.raises(ParameterError, match=said) as caught:
        groundplan.survey(rooms(16), threads=1).route(RIGHT if place != LEFT else LEFT, place, clearance=clearance)
    assert caught.value.code == code


def test_a_map_of_another_size_is_refused() -> None:
    other = groundplan.from_array(np.zeros((5, 5), dtype=np.uint8), RESOLUTION)
    with pytest.raises(ParameterError, match="5 x 5") as caught:
        groundplan.survey(rooms(16)).route(LEFT, RIGHT, map=other)
    assert caught.value.code == "route.map"


def test_the_command_prints_the_way_and_draws_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    from PIL import Image

    monkeypatch.chdir(tmp_path)
    for name, door in (("open", 16), ("shut", 0)):
        Image.fromarray(rooms(door).pixels).save(f"{name}.png")
        assert call(capsys, "survey", f"{name}.png", "--resolution", "0.05", "-o", name, "-q").code == 0
    ran = call(capsys, "route", "open", "1.5,3.0", "6.5,1.2", "--figure", "way.svg")
    assert ran.code == 0
    printed = np.array([line.split() for line in ran.out.splitlines()], dtype=float)
    way = groundplan.survey(rooms(16)).route(LEFT, RIGHT)
    assert way is not None
    assert np.abs(printed - way.points).max() < 1e-3
    assert b"<svg" in Path("way.svg").read_bytes()
    told = json.loads(call(capsys, "route", "open/survey.json", "1.5,3.0", "6.5,1.2", "--json").out)
    assert (told["points"], told["faces"]) == (way.points.tolist(), way.faces.tolist())
    none = call(capsys, "route", "shut", "1.5,3.0", "6.5,1.2")
    assert (none.code, none.out) == (4, "")
    assert "no way between (1.5, 3) and (6.5, 1.2)" in none.err
    assert none.err.endswith("hint: a smaller clearance may leave room\n")
    assert "hint" not in call(capsys, "route", "shut", "1.5,3.0", "6.5,1.2", "--clearance", "0").err
    wrong = call(capsys, "route", "open", "-1.5,3", "6.5,1")
    assert wrong.code == 2
    assert "(-1.5, 3) lies outside the map" in wrong.err
    Image.fromarray(racks_on_legs().pixels).save("legs.png")
    assert call(capsys, "survey", "legs.png", "--resolution", "0.05", "-o", "legs", "-q").code == 0
    under = call(capsys, "route", "legs", "11,2.5", "11,12.5", "--json")
    assert len(json.loads(under.out)["racks"]) == 3
    assert "under or through S" in under.err
    assert under.err.endswith("hint: --around-racks takes racks as occupied\n")
    around = call(capsys, "route", "legs", "11,2.5", "11,12.5", "--around-racks", "--json")
    assert (json.loads(around.out)["racks"], around.err) == ([], "")
    Path("open.png").unlink()
    assert "what the survey knows" in call(capsys, "route", "open", "1.5,3.0", "6.5,1.2").err
