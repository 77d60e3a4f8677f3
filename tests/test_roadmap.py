"""The road map: lanes on centre lines, a node where something is decided, and nothing else."""

from __future__ import annotations

import dataclasses
import math
from itertools import pairwise
from pathlib import Path

import networkx
import numpy as np
import pytest
import shapely
from _exports import GOOD, ODD, demo, jones_farms, odd_names
from conftest import ROOT
from zoo import surveyed

import groundplan
from groundplan import FormatError, ParameterError, simulate
from groundplan.evaluate import Case, suite
from groundplan.evaluate._roads import read_route, road_scores
from groundplan.export._places import places
from groundplan.roadmap import RoadMap, road_map
from groundplan.roadmap._doors import Regions
from groundplan.roadmap._pixels import CLEAR_M


def degree(roads: RoadMap) -> dict[str, int]:
    """How many lanes meet at each node."""
    counts = dict.fromkeys((node.id for node in roads.nodes), 0)
    for lane in roads.lanes:
        for end in (lane.start, lane.end):
            counts[roads.nodes[end].id] += 1
    return counts


def plain() -> groundplan.Survey:
    """The example warehouse, its racks without bays."""
    return with_bays(None)


def with_bays(pitch: float | None, phase: float = 0.0) -> groundplan.Survey:
    """The example warehouse, its racks telling their bays."""
    bays = {"pitch": pitch, "phase": phase}
    labels = [label | bays if label["kind"] == "rack" else label for label in demo().labels]
    return dataclasses.replace(demo(), labels=labels)


def test_a_warehouse_has_a_node_at_each_junction_and_a_lane_between_neighbours() -> None:
    roads = road_map(plain())
    assert repr(roads).startswith(f"RoadMap({len(roads.nodes)} nodes, {len(roads.lanes)} lanes, ")
    junctions = demo().of_kind("junction")
    assert len(roads.nodes) == len(junctions) == 15
    for node in roads.nodes:
        assert min(math.dist(node.at, junction["at"]) for junction in junctions) < 0.75
    # Four aisles of two lanes, two cross aisles of four and one of four with its stubs.
    assert len(roads.lanes) == 20 and networkx.is_strongly_connected(roads.to_networkx())


def test_a_lane_s_room_is_a_region_less_what_a_lane_keeps_from_its_walls() -> None:
    survey = plain()
    regions = Regions(survey, places(survey), {}, None, None)
    for place in regions.places:
        if place.kind == "region":
            steps = place.shape.simplify(0.075).buffer(-CLEAR_M).difference(regions.racks.buffer(CLEAR_M))
            assert regions.space(place.label).symmetric_difference(steps).area < 0.01 * steps.area


@pytest.mark.parametrize("case", suite("roadmaps")[:10], ids=lambda case: case.name)
def test_a_simulated_warehouse_s_aisles_are_joined_as_its_truth_joins_them(case: Case, tmp_path: Path) -> None:
    made = simulate.warehouse(**case.options)
    (file,) = groundplan.survey(made.map, threads=1).export(tmp_path / "x.route.geojson", map=made.map)
    scores = road_scores(*read_route(file), made.truth, made.map)
    assert scores["joins_missing"] == scores["joins_extra"] == scores["lane_elsewhere_m"] == 0
    assert scores["lane_error_m"] <= 0.15 and scores["lane_clearance_m"] >= 0.4 and scores["node_ratio"] <= 1.3


def test_a_lane_runs_between_the_posts_and_not_between_goods_that_stand_back_from_them() -> None:
    made = simulate.warehouse(**next(case for case in suite("warehouses") if case.name == "turned").options)
    survey = groundplan.survey(made.map, threads=1)
    off = []
    for roads in (road_map(survey), road_map(survey, map=made.map)):
        nodes = np.array([node.at for node in roads.nodes])
        edges = {(lane.start, lane.end) for lane in roads.lanes if lane.kind == "aisle"}
        off.append(road_scores(nodes, edges, made.truth, made.map)["lane_error_m"])
    assert max(off) < 0.1


def test_the_scores_see_what_is_wrong_with_a_road_map(tmp_path: Path) -> None:
    case = suite("roadmaps")[0]
    made = simulate.warehouse(**case.options)
    (file,) = groundplan.survey(made.map, threads=1).export(tmp_path / "x.route.geojson", map=made.map)
    nodes, edges = read_route(file)
    mine = made.truth, made.map
    cross = made.truth["corridors"][-1]
    axis = shapely.LineString([cross["a"], cross["b"]]).buffer(0.3)
    without = {edge for edge in edges if not axis.contains(shapely.LineString(nodes[list(edge)]))}
    assert len(without) < len(edges) and road_scores(nodes, without, *mine)["joins_missing"] > 0
    assert road_scores(nodes + 0.3, edges, *mine)["lane_error_m"] > 0.25
    wrong = road_scores(nodes, edges | {(0, len(nodes) - 1)}, *mine)
    assert wrong["lane_clearance_m"] < 0.4 and wrong["lane_elsewhere_m"] > 1 and wrong["joins_extra"] > 0
    middles = np.array([nodes[list(edge)].mean(0) for edge in sorted(edges)])
    split = {pair for n, (a, b) in enumerate(sorted(edges), len(nodes)) for pair in ((a, n), (n, b))}
    more = road_scores(np.concatenate([nodes, middles]), split, *mine)["node_ratio"]
    assert more > 1.5 * road_scores(nodes, edges, *mine)["node_ratio"]


def test_a_file_that_is_no_route_graph_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="does not exist"):
        read_route(tmp_path / "none.geojson")
    (tmp_path / "x.geojson").write_text('{"features": [{"geometry": {"type": "Point"}}]}')
    with pytest.raises(FormatError, match=r"x\.geojson is no route graph"):
        read_route(tmp_path / "x.geojson")


def hall(*taken: tuple[float, float, float, float]) -> groundplan.Map:
    """A hall of 24 m by 14 m: three aisles between two rows of racks, ways across at their ends, and what is given."""
    pixels = np.full((280, 480), 254, np.uint8)
    for x0, y0, x1, y1 in ((0, 0, 24, 0.2), (0, 13.8, 24, 14), (0, 0, 0.2, 14), (23.8, 0, 24, 14), *taken):
        pixels[280 - round(y1 / 0.05) : 280 - round(y0 / 0.05), round(x0 / 0.05) : round(x1 / 0.05)] = 0
    for y in (3.2, 8.6):
        pixels[280 - round((y + 2.2) / 0.05) : 280 - round(y / 0.05), 60:420] = 0
    return groundplan.from_array(pixels, 0.05)


def test_no_lane_leads_through_what_stands_in_the_way_and_no_node_is_left_for_it() -> None:
    free, box = hall(), hall((11.5, 6.6, 12.5, 7.4))
    open, blocked = (road_map(groundplan.survey(map, threads=1), map=map) for map in (free, box))
    assert {lane.name for lane in open.lanes} == {"A01", "A02", "A03", "C01", "C06"}
    assert {lane.name for lane in blocked.lanes} == {"A01", "A03", "C01", "C06"}
    assert {node.kind for node in blocked.nodes} == {"junction"} and len(blocked.nodes) == 4
    assert [piece.id for piece in blocked.blocked] == ["A02.1"] and not open.blocked
    assert shapely.box(11.5, 6.6, 12.5, 7.4).contains(shapely.Point(blocked.blocked[0].at))
    assert min(degree(blocked).values()) == 2


@pytest.mark.parametrize(("options", "clear"), [({"spurs": 0.6}, 0.4), ({"vehicle_width": 1.2}, 0.6)])
def test_spurs_and_wide_vehicles_keep_clear_of_what_is_occupied(options: dict[str, float], clear: float) -> None:
    made = simulate.warehouse(**suite("roadmaps")[5].options)  # the cluttered one
    roads = road_map(groundplan.survey(made.map, threads=1), map=made.map, **options)  # type: ignore[arg-type]
    nodes = np.array([node.at for node in roads.nodes])
    scores = road_scores(nodes, {(lane.start, lane.end) for lane in roads.lanes}, made.truth, made.map)
    assert scores["lane_clearance_m"] >= clear and scores["lane_elsewhere_m"] == 0
    assert scores["lane_error_m"] < 0.15
    if "spurs" in options:
        spurs = sum(lane.kind == "spur" for lane in roads.lanes)
        assert 0.8 * len(roads.faces) < spurs < len(roads.faces)  # pallets stand before some


def test_a_map_of_coarse_pixels_has_a_road_map() -> None:
    pixels = np.full((100, 160), 254, np.uint8)
    pixels[[0, -1]] = pixels[:, [0, -1]] = 0
    # Of rows 7 m deep no way leads past the ends, and aisles lead up to the walls.
    for row in (15, 35, 55, 75):
        pixels[row : row + 12, 15:145] = 0
    map = groundplan.from_array(pixels, 0.6)
    survey = groundplan.survey(map, threads=1)
    roads = road_map(survey, map=map)
    assert {lane.name for lane in roads.lanes} == {"A01", "A05", "A08", "A11"} and not roads.blocked
    # Lanes end 0.6 m before the walls: what is wider is in their way, and told by a pixel of the wall.
    wide = road_map(survey, map=map, vehicle_width=3.0)
    assert wide.lanes == [] and len(wide.blocked) >= 3
    for piece in wide.blocked:
        column, row = int(piece.at[0] / 0.6), 99 - int(piece.at[1] / 0.6)
        assert pixels[row, column] == 0 and column in (0, 159)


@pytest.mark.parametrize(("spurs", "least"), [(0.05, 35), (0.1, 35), (0.6, 55)])
def test_spurs_may_end_nearer_to_a_face_than_a_pixel_is_wide(spurs: float, least: int) -> None:
    map = groundplan.read(ROOT / "examples" / "warehouse.yaml")
    roads = road_map(demo(), map=map, spurs=spurs)
    made = [lane for lane in roads.lanes if lane.kind == "spur"]
    assert len(roads.faces) == 74 >= len(made) >= least
    faces = {face.id: face for face in roads.faces}
    for lane in made:
        face = faces[lane.id.removesuffix(".spur")]
        assert math.dist(face.at, roads.nodes[lane.end].at) == pytest.approx(spurs, abs=0.15)


def rows(*taken: tuple[float, float, float, float]) -> groundplan.Map:
    """Four rows of racks, a way across on their left, and on their right a hall 14 m deep; more may stand in it."""
    pixels = np.full((480, 640), 254, np.uint8)
    racks = [(3.2, y, 18, y + 2.2) for y in (3.2, 8.6, 14.0, 19.4)]
    for x0, y0, x1, y1 in ((0, 0, 32, 0.2), (0, 23.8, 32, 24), (0, 0, 0.2, 24), (31.8, 0, 32, 24), *racks, *taken):
        pixels[480 - round(y1 / 0.05) : 480 - round(y0 / 0.05), round(x0 / 0.05) : round(x1 / 0.05)] = 0
    return groundplan.from_array(pixels, 0.05)


def test_a_lane_along_a_hall_s_side_spares_a_long_way_round_but_leads_through_no_gap_between_racks() -> None:
    def joined(map: groundplan.Map) -> set[frozenset[str]]:
        roads = road_map(groundplan.survey(map, threads=1), map=map)
        aisles = [lane for lane in roads.lanes if lane.kind == "aisle"]
        named = [{lane.name for lane in aisles if n in (lane.start, lane.end)} for n in range(len(roads.nodes))]
        return {frozenset(named[lane.start] | named[lane.end]) for lane in roads.lanes if lane.kind == "open"}

    everywhere = {frozenset(pair) for pair in pairwise(("A01", "A02", "A04", "A05", "A06"))}
    assert joined(rows()) == everywhere
    # A post of the same row: the racks go on, and what is open before it are empty bays.
    assert joined(rows((21, 9.6, 21.2, 9.8))) == everywhere - {frozenset({"A02", "A04"})}


def test_a_lane_steps_aside_for_what_sticks_out() -> None:
    plain, out = hall(), hall((10, 6.2, 11, 6.68), (14, 6.2, 15, 6.68))
    lanes = [road_map(groundplan.survey(map, threads=1), map=out) for map in (plain, out)]
    for roads in lanes:
        lane = next(lane for lane in roads.lanes if lane.name == "A02")
        line = shapely.LineString([roads.nodes[lane.start].at, roads.nodes[lane.end].at])
        assert line.distance(shapely.box(10, 6.2, 11, 6.68)) >= 0.4
        assert line.distance(shapely.LineString([(3, 7.0), (21, 7.0)])) < 0.15


@pytest.mark.parametrize("which", [*GOOD, *ODD])
def test_any_survey_has_a_road_map_that_is_whole(which: str) -> None:
    survey = (GOOD | ODD)[which]()
    roads = road_map(survey, spurs=0.5)
    ids = [*(node.id for node in roads.nodes), *(way.id for way in roads.directed())]
    assert len(set(ids)) == len(ids) and all(id.isascii() and id.isprintable() for id in ids)
    assert all(count > 0 for count in degree(roads).values())
    for lane in roads.lanes:
        assert roads.length(lane) > 0 and lane.left >= 0 and lane.right >= 0
    assert roads == road_map(groundplan.Survey.from_json(survey.to_json()), spurs=0.5)


def test_lanes_lie_on_the_corridors_centre_lines_with_their_free_width() -> None:
    survey = demo()
    roads = road_map(survey)
    for lane in roads.lanes:
        assert lane.label is not None
        corridor = survey.labels[lane.label]
        axis = shapely.LineString(corridor["axis"])
        for end in (lane.start, lane.end):
            assert axis.distance(shapely.Point(roads.nodes[end].at)) < 0.15
        assert lane.left + lane.right == pytest.approx(corridor["width"], abs=0.3)


def test_names_run_right_and_up_however_the_map_lies() -> None:
    roads = road_map(plain())
    first = [lane for lane in roads.lanes if lane.name == "A01"]
    assert [lane.id for lane in first] == ["A01.1", "A01.2"]
    assert roads.nodes[first[0].start].id == "J01" and roads.nodes[first[-1].end].id == "J03"
    assert {node.id for node in roads.nodes} == {f"J{n:02}" for n in range(1, 16)}


def test_bays_have_a_stop_on_the_lane_and_those_across_share_it() -> None:
    bare, roads = road_map(plain()), road_map(with_bays(2.7))
    # Three racks of six bays, three of five, each open on both sides, and a row of twelve at a wall.
    assert len(roads.faces) == 2 * (3 * 6 + 3 * 5) + 12 and not any(lane.kind == "spur" for lane in roads.lanes)
    picks = [node for node in roads.nodes if node.kind == "pick"]
    assert len(picks) == len(roads.nodes) - len(bare.nodes) <= len(roads.faces)
    for face in roads.faces:
        stop = roads.nodes[face.node]
        away = math.dist(face.at, stop.at)
        # The stop is square before the face, and on it the lane's middle.
        ahead = (stop.at[0] + away * math.cos(face.heading), stop.at[1] + away * math.sin(face.heading))
        assert math.dist(ahead, face.at) < 0.2 and 1.5 < away < 2.5
    ratio = len(roads.nodes) / (15 + len(roads.faces))
    assert ratio <= 1.3


def test_spurs_lead_square_from_the_lane_to_the_pick_faces() -> None:
    roads = road_map(with_bays(2.7), spurs=0.6)
    spurs = [lane for lane in roads.lanes if lane.kind == "spur"]
    assert len(spurs) == len(roads.faces) == 78
    main = {lane.name: roads.heading(lane) for lane in roads.lanes if lane.kind == "aisle"}
    for spur in spurs:
        assert abs(math.cos(roads.heading(spur) - main["A03"])) < 0.02
    for face in roads.faces:
        assert math.dist(face.at, roads.nodes[face.node].at) == pytest.approx(0.6, abs=0.15)


def test_a_rack_s_phase_moves_its_bays() -> None:
    at = {face.id: face.at for face in road_map(with_bays(2.7)).faces}
    moved = {face.id: face.at for face in road_map(with_bays(2.7, 0.5)).faces}
    for id in at.keys() & moved.keys():
        assert math.dist(at[id], moved[id]) == pytest.approx(0.5, abs=1e-6)
    assert at and min(id.rpartition(".")[2] for id in at) == "L01"


def test_what_a_vehicle_does_not_fit_is_left_out() -> None:
    whole = road_map(demo())
    widths = sorted(label["width"] for label in demo().of_kind("corridor"))
    some = road_map(demo(), vehicle_width=(widths[2] + widths[3]) / 2)
    assert {lane.name for lane in some.lanes} < {lane.name for lane in whole.lanes}
    assert all(lane.left + lane.right > widths[2] for lane in some.lanes)
    assert {(corridor.width, corridor.least) for corridor in some.narrow} == {
        (width, (widths[2] + widths[3]) / 2) for width in widths[:3]
    }
    assert {corridor.name for corridor in some.narrow}.isdisjoint(lane.name for lane in some.lanes)
    assert road_map(demo(), vehicle_width=50.0).nodes == [] and whole.narrow == []


def test_narrow_corridors_have_lanes_where_all_are_narrow() -> None:
    survey = jones_farms()
    long = [c for c in survey.of_kind("corridor") if c["width"] < 1.2 and math.dist(*c["axis"]) > 20]
    assert len(long) == 4
    assert {c["name"] for c in long} <= {lane.name for lane in road_map(survey).lanes}


def test_a_gap_through_a_row_has_no_lane_but_for_a_vehicle_that_fits() -> None:
    survey = demo()
    narrow = next(n for n, label in enumerate(survey.labels) if label.get("name") == "C06")
    labels = [label | {"width": 0.9} if n == narrow else label for n, label in enumerate(survey.labels)]
    gap = dataclasses.replace(survey, labels=labels)
    roads = road_map(gap)
    assert "C06" not in {lane.name for lane in roads.lanes} and [one.name for one in roads.narrow] == ["C06"]
    assert "C06" in {lane.name for lane in road_map(gap, vehicle_width=0.6).lanes}


def test_rules_set_speeds_and_one_way_lanes_by_name(tmp_path: Path) -> None:
    file = tmp_path / "rules.toml"
    file.write_text(
        '[[rule]]\nname = "A*"\nspeed = 1.5\n[[rule]]\nname = "A03"\nway = "backward"\nspeed = 1\n'
        '[[rule]]\nname = "A05"\nway = "closed"\n'
    )
    roads = road_map(plain(), rules=file)
    by_name = {lane.name: (lane.speed, lane.way) for lane in roads.lanes}
    assert by_name["A01"] == (1.5, "both") and by_name["A03"] == (1.0, "backward") and "A05" not in by_name
    assert by_name["C01"] == (None, "both")
    ways = [way.id for way in roads.directed() if way.lane.name == "A03"]
    assert ways == ["A03.1r", "A03.2r"]
    assert {zone.speed for zone in roads.zones if zone.kind == "speed"} == {1.5, 1.0}


@pytest.mark.parametrize(
    ("rule", "said"),
    [
        ({"speed": 0}, "the speed of rule 1 is 0"),
        ({"speed": "fast"}, "the speed of rule 1 is 'fast'"),
        ({"way": "up"}, "the way of rule 1 is 'up'"),
        ({"nam": "A01"}, "rule 1 has a 'nam'"),
        ({"name": 3}, "the name of rule 1 is 3"),
    ],
)
def test_a_rule_that_is_none_is_refused_by_its_value(rule: dict[str, object], said: str) -> None:
    with pytest.raises(ParameterError, match=said):
        road_map(demo(), rules=[rule])


def test_a_file_of_rules_that_is_none_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="does not exist"):
        road_map(demo(), rules=tmp_path / "none.toml")
    (tmp_path / "bad.toml").write_text("[[rule]\n")
    with pytest.raises(FormatError, match=r"bad\.toml"):
        road_map(demo(), rules=tmp_path / "bad.toml")
    (tmp_path / "other.toml").write_text("speed = 3\n")
    with pytest.raises(ParameterError, match="there is no 'speed' among rules"):
        road_map(demo(), rules=tmp_path / "other.toml")


@pytest.mark.parametrize("option", ["vehicle_width", "spurs"])
def test_a_length_that_is_none_is_refused(option: str) -> None:
    with pytest.raises(ParameterError, match=option):
        road_map(demo(), **{option: float("nan")})  # type: ignore[arg-type]


def test_racks_are_kept_out_of() -> None:
    zones = [zone for zone in road_map(demo()).zones if zone.kind == "keep-out"]
    assert [zone.label for zone in zones] == [n for n, x in enumerate(demo().labels) if x["kind"] == "rack"]
    for zone in zones:
        assert shapely.LinearRing(zone.ring).is_ccw and shapely.Polygon(zone.ring).is_valid


def test_rooms_are_reached_through_their_doors() -> None:
    survey = surveyed("rows_of_offices")
    roads = road_map(survey)
    rooms = [node for node in roads.nodes if node.kind == "room"]
    doors = [node for node in roads.nodes if node.kind == "door"]
    assert len(rooms) == len(doors) == 6
    assert networkx.is_strongly_connected(roads.to_networkx())
    walls = shapely.multilinestrings(shapely.linestrings(survey.walls.points.reshape(-1, 2, 2)))
    for lane in roads.lanes:
        line = shapely.LineString([roads.nodes[lane.start].at, roads.nodes[lane.end].at])
        at_doors = shapely.union_all([shapely.Point(door.at).buffer(0.6) for door in doors])
        assert line.difference(at_doors).distance(walls) >= 0.3


def test_no_door_is_drawn_where_a_lane_runs_through_it_as_it_is() -> None:
    survey = jones_farms()
    roads = road_map(survey)
    lanes = [lane for lane in roads.lanes if lane.kind == "aisle"]
    lines = [shapely.LineString([roads.nodes[lane.start].at, roads.nodes[lane.end].at]) for lane in lanes]
    for node in roads.nodes:
        if node.kind == "door":
            assert min(line.distance(shapely.Point(node.at)) for line in lines) > 0.3
    graph = roads.to_networkx().to_undirected()
    assert len(max(networkx.connected_components(graph), key=len)) > 0.85 * len(graph)


def test_names_of_any_kind_give_ids_of_ascii() -> None:
    roads = road_map(odd_names())
    assert all(node.id.isascii() for node in roads.nodes)
    assert len(roads.nodes) >= 15
