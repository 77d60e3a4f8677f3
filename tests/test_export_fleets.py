"""One road map in every fleet's format: the same nodes at the same places, the same ways, by readers of their own."""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import jsonschema
import networkx
import pytest
import shapely
from _exports import GOOD, ODD, demo, loads, odd_names, once, shifted
from _fleet import Roads, building, navigation_graph, route_graph
from conftest import SHARED
from lxml import etree

import groundplan
from groundplan import FormatError, GroundplanError, ParameterError
from groundplan.roadmap import road_map

ONE_WAY: list[dict[str, Any]] = [{"name": "A03", "way": "forward", "speed": 0.8}, {"name": "A04", "way": "backward"}]


@cache
def schema(name: str) -> Any:
    """A published schema; skipped where those are not."""
    file = SHARED / "schemas" / name
    if not file.is_file():
        pytest.skip(f"needs the published schemas: no {file}")
    return etree.XMLSchema(etree.parse(file)) if file.suffix == ".xsd" else json.loads(file.read_text("utf-8"))


def lif(path: Path) -> Roads:
    """A layout by the VDMA's schema, its ids its own, its ends and stations at nodes that there are."""
    tree = loads(path)
    jsonschema.validate(tree, schema("LIF-1.0.0.schema.json"), jsonschema.Draft7Validator)
    (layout,) = tree["layouts"]
    nodes = {node["nodeId"]: (node["nodePosition"]["x"], node["nodePosition"]["y"]) for node in layout["nodes"]}
    assert len(nodes) == len(layout["nodes"])
    assert len({edge["edgeId"] for edge in layout["edges"]}) == len(layout["edges"])
    for entry in [*layout["nodes"], *layout["edges"]]:
        assert entry.get("vehicleTypeNodeProperties") or entry.get("vehicleTypeEdgeProperties")
    for station in layout["stations"]:
        assert set(station["interactionNodeIds"]) <= set(nodes) and station["interactionNodeIds"]
    return nodes, {(edge["startNodeId"], edge["endNodeId"]) for edge in layout["edges"]}


def opentcs(path: Path) -> Roads:
    """A plant model by openTCS's schema, its names its own, all that it names there."""
    tree = etree.parse(path)
    schema("openTCS-model-7.0.0.xsd").assertValid(tree)
    root = tree.getroot()
    names = [e.get("name") for e in root if e.tag in ("point", "path", "location", "locationType", "block")]
    assert len(set(names)) == len(names)
    points = {p.get("name"): (int(p.get("positionX")) / 1e3, int(p.get("positionY")) / 1e3) for p in root.iter("point")}
    paths = {p.get("name"): (p.get("sourcePoint"), p.get("destinationPoint")) for p in root.iter("path")}
    for point in root.iter("point"):
        leaving = {name for name, (start, _) in paths.items() if start == point.get("name")}
        assert {out.get("name") for out in point.iter("outgoingPath")} == leaving
    assert {link.get("point") for link in root.iter("link")} <= set(points)
    assert {member.get("name") for member in root.iter("member")} <= set(points) | set(paths)
    for path_ in root.iter("path"):
        a, b = (points[end] for end in paths[path_.get("name")])
        assert int(path_.get("length")) == pytest.approx(max(1000 * math.dist(a, b), 1), abs=2)
    return points, set(paths.values())


READERS: dict[str, Callable[[Path], Roads]] = {
    "lif": lif,
    "nav2": lambda path: route_graph(path)[0],
    "opentcs": opentcs,
    "rmf-building": lambda path: building(path)[0],
    "rmf-nav": lambda path: navigation_graph(path)[0],
}


def expected(survey: groundplan.Survey, **options: Any) -> Roads:
    """The road map itself."""
    roads = road_map(survey, **options)
    ids = [node.id for node in roads.nodes]
    return {node.id: node.at for node in roads.nodes}, {(ids[way.start], ids[way.end]) for way in roads.directed()}


@pytest.mark.parametrize("which", GOOD)
@pytest.mark.parametrize("format", READERS)
def test_nodes_come_back_to_a_millimetre_and_ways_as_they_lead(format: str, which: str, tmp_path: Path) -> None:
    survey = GOOD[which]()
    nodes, edges = READERS[format](once(survey, format, tmp_path))
    places, ways = expected(survey)
    assert edges == ways and nodes.keys() == places.keys()
    assert all(nodes[id] == pytest.approx(at, abs=1e-3) for id, at in places.items())


@pytest.mark.parametrize("format", READERS)
def test_a_one_way_aisle_leads_one_way_and_a_narrow_one_is_left_out(format: str, tmp_path: Path) -> None:
    options: dict[str, Any] = {"rules": ONE_WAY, "spurs": 0.5, "vehicle_width": 1.0}
    _, edges = READERS[format](once(demo(), format, tmp_path, **options))
    both = {edge for edge in edges if edge[::-1] in edges}
    assert edges == expected(demo(), **options)[1] and edges - both
    wide = max(label["width"] for label in demo().of_kind("corridor")) + 0.1
    if format != "nav2":
        assert READERS[format](once(demo(), format, tmp_path, vehicle_width=wide))[1] == set()
    else:
        with pytest.raises(FormatError, match="the survey has no lanes"):
            once(demo(), format, tmp_path, vehicle_width=wide)


@pytest.mark.parametrize("which", ODD)
@pytest.mark.parametrize("format", READERS)
def test_an_odd_survey_is_a_valid_file_or_a_clear_error(format: str, which: str, tmp_path: Path) -> None:
    try:
        file = once(ODD[which](), format, tmp_path)
    except GroundplanError as fault:
        assert fault.code == "export.empty" and not list(tmp_path.iterdir())
    else:
        READERS[format](file)


def test_stations_and_locations_are_the_pick_faces(tmp_path: Path) -> None:
    faces = {face.id: face for face in road_map(demo()).faces}
    (layout,) = loads(once(demo(), "lif", tmp_path, vehicle_type="Forklift"))["layouts"]
    assert {station["stationId"] for station in layout["stations"]} == set(faces)
    for station in layout["stations"]:
        place, face = station["stationPosition"], faces[station["stationId"]]
        assert (place["x"], place["y"]) == pytest.approx(face.at, abs=1e-3) and abs(place["theta"]) <= math.pi
    assert {p["vehicleTypeId"] for n in layout["nodes"] for p in n["vehicleTypeNodeProperties"]} == {"Forklift"}
    root = etree.parse(once(demo(), "opentcs", tmp_path)).getroot()
    assert {location.get("name") for location in root.iter("location")} == set(faces)


def test_every_edge_of_the_route_graph_knows_its_free_width_and_speed(tmp_path: Path) -> None:
    _, told = route_graph(once(demo(), "nav2", tmp_path, rules=ONE_WAY))
    for way in road_map(demo(), rules=ONE_WAY).directed():
        metadata = told[way.id]
        assert (metadata["left"], metadata["right"]) == pytest.approx((way.left, way.right))
        assert metadata.get("abs_speed_limit") == way.lane.speed and metadata["class"] == way.lane.kind
    assert {0.8} <= {metadata.get("abs_speed_limit") for metadata in told.values()}


@pytest.mark.parametrize("name", ["aws", "sample", "turtlebot4"])
def test_nav2_s_own_graphs_are_read_by_the_same_rules_and_have_the_same_members(name: str, tmp_path: Path) -> None:
    sample = SHARED / "schemas" / f"nav2-route-{name}_graph.geojson"
    if not sample.is_file():
        pytest.skip(f"needs Nav2's graphs: no {sample}")
    (nodes, edges), _ = route_graph(sample, ours=False)
    assert nodes and edges
    own, theirs = loads(once(demo(), "nav2", tmp_path)), loads(sample)
    assert own.keys() <= theirs.keys() and own["crs"] == theirs["crs"]
    for type in ("Point", "LineString"):
        ours = [f for f in own["features"] if f["geometry"]["type"] == type]
        needed = [f for f in theirs["features"] if f["geometry"]["type"] in (type, f"Multi{type}")]
        always = set.intersection(*(set(feature["properties"]) for feature in needed))
        assert ours and needed and all(always <= set(feature["properties"]) for feature in ours)


def test_a_way_over_the_layout_is_an_order_that_a_vehicle_takes(tmp_path: Path) -> None:
    nodes, edges = lif(once(demo(), "lif", tmp_path, rules=ONE_WAY))
    _, told = route_graph(once(demo(), "nav2", tmp_path, rules=ONE_WAY))
    (layout,) = loads(tmp_path / "file.lif.json")["layouts"]
    ids = {(edge["startNodeId"], edge["endNodeId"]): edge["edgeId"] for edge in layout["edges"]}
    a, b = min(nodes, key=lambda n: sum(nodes[n])), max(nodes, key=lambda n: sum(nodes[n]))
    way = networkx.shortest_path(networkx.DiGraph(sorted(edges)), a, b)
    released = {"released": True, "actions": []}
    order = {
        **{"headerId": 1, "timestamp": "2026-05-01T09:30:00.000Z", "version": "3.0.0", "manufacturer": "nobody"},
        **{"serialNumber": "1", "orderId": "1", "orderUpdateId": 0},
        "nodes": [
            {"nodeId": n, "sequenceId": 2 * k, "nodePosition": {"x": nodes[n][0], "y": nodes[n][1], "mapId": "map"}}
            | released
            for k, n in enumerate(way)
        ],
        "edges": [
            {"edgeId": ids[pair], "sequenceId": 2 * k + 1, "corridor": _corridor(told[ids[pair]])} | released
            for k, pair in enumerate(itertools.pairwise(way))
        ],
    }
    taker = jsonschema.Draft202012Validator(schema("VDA5050-3.0.0-order.schema.json"))
    assert len(way) > 5 and not list(taker.iter_errors(order))
    # The schema is asked in earnest.
    order["edges"][0]["corridor"]["leftWidth"] = "wide"  # type: ignore[index]
    assert list(taker.iter_errors(order))


def _corridor(metadata: dict[str, Any]) -> dict[str, Any]:
    return {"leftWidth": metadata["left"], "rightWidth": metadata["right"], "corridorReferencePoint": "CONTOUR"}


def test_a_map_far_from_its_origin_is_too_far_for_the_route_server(tmp_path: Path) -> None:
    read = groundplan.read(Path(__file__).parent.parent / "examples" / "warehouse.yaml", origin=(500000.0, 0.0, 0.0))
    with pytest.raises(FormatError) as told:
        once(groundplan.survey(read, threads=1), "nav2", tmp_path)
    assert told.value.code == "export.range"


def test_rmf_has_the_walls_and_no_door_that_a_robot_would_wait_at(tmp_path: Path) -> None:
    survey = shifted()
    _, level = building(once(survey, "rmf-building", tmp_path))
    at = [(x, y) for x, y, *_ in level["vertices"]]
    length = sum(math.dist(at[a], at[b]) for a, b, _ in level["walls"])
    ends = survey.walls.points.reshape(-1, 2, 2).tolist()
    assert length == pytest.approx(sum(math.dist(*pair) for pair in ends), rel=1e-3) and level["doors"] == []


def test_zones_are_valid_and_keep_vehicles_out_of_racks_and_corridors_one_way(tmp_path: Path) -> None:
    survey = demo()
    tree = loads(once(survey, "vda5050", tmp_path, date="2026-05-01", rules=ONE_WAY))
    jsonschema.validate(tree, schema("VDA5050-3.0.0-zoneSet.schema.json"), jsonschema.Draft202012Validator)
    zones = {zone["zoneId"]: zone for zone in tree["zoneSet"]["zones"]}
    assert len(zones) == len(tree["zoneSet"]["zones"]) and tree["timestamp"] == "2026-05-01T00:00:00.000Z"
    blocked = shapely.union_all([shape(zone) for zone in zones.values() if zone["zoneType"] == "BLOCKED"])
    racks = shapely.union_all([shapely.Polygon(rack["polygon"]) for rack in survey.of_kind("rack")])
    assert racks.difference(blocked.buffer(1e-3)).area < 1e-6
    for corridor in survey.of_kind("corridor"):
        (x0, y0), (x1, y1) = corridor["axis"]
        zone = zones[f"{corridor['name']}-way"]
        along = math.cos(zone["direction"] - math.atan2(y1 - y0, x1 - x0))
        assert abs(along) == pytest.approx(1.0, abs=1e-3)
        assert zone["zoneType"] == ("DIRECTED" if corridor["name"] in ("A03", "A04") else "BIDIRECTED")
    assert math.cos(zones["A03-way"]["direction"] - zones["A04-way"]["direction"]) == pytest.approx(-1.0, abs=1e-3)


def shape(zone: dict[str, Any]) -> Any:
    """A zone's polygon."""
    return shapely.Polygon([(vertex["x"], vertex["y"]) for vertex in zone["vertices"]])


@pytest.mark.parametrize("which", [*GOOD, *ODD])
def test_the_zones_of_every_survey_are_valid(which: str, tmp_path: Path) -> None:
    tree = loads(once((GOOD | ODD)[which](), "vda5050", tmp_path))
    jsonschema.validate(tree, schema("VDA5050-3.0.0-zoneSet.schema.json"), jsonschema.Draft202012Validator)
    assert len({zone["zoneId"] for zone in tree["zoneSet"]["zones"]}) == len(tree["zoneSet"]["zones"])


def test_names_of_people_come_through(tmp_path: Path) -> None:
    (layout,) = loads(once(odd_names(), "lif", tmp_path))["layouts"]
    names = {node["nodeName"] for node in layout["nodes"]} | {edge["edgeName"] for edge in layout["edges"]}
    assert any("Söhne" in name for name in names)


def test_a_vehicle_type_without_a_name_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="vehicle type"):
        once(demo(), "lif", tmp_path, vehicle_type=" \n")
