"""The road map for the Nav2 Route Server: GeoJSON as its graph loader reads it.

Ids are whole numbers, nodes first and edges after them; the road map's own ids are in ``metadata``, where values are
numbers, texts or flat lists only. Edges are directed, so that a two-way lane is two. The loader keeps coordinates as
32-bit floats; ``crs`` is the one that Nav2's own graphs name, so that GIS programs show metres.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from groundplan._errors import FormatError
from groundplan._files import write_text
from groundplan.roadmap import Directed, Node, RoadMap, road_map

if TYPE_CHECKING:
    from groundplan.survey import Survey

#: Beyond it, neighbouring 32-bit floats are over 2 mm apart.
FARTHEST_M = 16384.0


def write(survey: Survey, path: Path, **roads: Any) -> list[Path]:
    """Write nodes and directed edges; ``roads`` as in `groundplan.roadmap.road_map`.

    Raises
    ------
    FormatError
        ``export.empty`` without a lane, ``export.range`` for a map farther from its frame's origin than 32-bit floats
        can say to a millimetre. The loader refuses a graph without edges.
    """
    made = road_map(survey, **roads)
    if not made.lanes:
        hint = "a road map needs corridors, or doors between regions, as wide as the vehicle"
        raise FormatError("export.empty", "the survey has no lanes, and the Route Server loads no empty graph", hint)
    farthest = max(abs(value) for node in made.nodes for value in node.at)
    if farthest > FARTHEST_M:
        floats = f"the Route Server's 32-bit floats end at {FARTHEST_M:.0f}"
        said = f"a node lies {farthest:.0f} m from the origin, and {floats}"
        raise FormatError("export.range", said, "give the map an origin near it")
    features = [_node(number, node, made) for number, node in enumerate(made.nodes)]
    features += [_edge(number, way, made) for number, way in enumerate(made.directed(), len(made.nodes))]
    rows = ",\n".join(json.dumps(feature, ensure_ascii=False) for feature in features)
    crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::3857"}}
    head = f'{{"type": "FeatureCollection",\n"name": "graph",\n"crs": {json.dumps(crs)},\n"features": [\n'
    write_text(path, f"{head}{rows}\n]}}\n")
    return [path]


def _node(number: int, node: Node, roads: RoadMap) -> dict[str, Any]:
    metadata = {"id": node.id, "name": node.name, "class": node.kind}
    faces = [face.id for face in roads.faces if roads.nodes[face.node] is node]
    return {
        "type": "Feature",
        "properties": {"id": number, "frame": "map", "metadata": metadata | ({"pick_faces": faces} if faces else {})},
        "geometry": {"type": "Point", "coordinates": list(node.at)},
    }


def _edge(number: int, way: Directed, roads: RoadMap) -> dict[str, Any]:
    lane = way.lane
    # Numbers are floats, always: the loader makes whole ones another type.
    limit = {} if lane.speed is None else {"abs_speed_limit": float(lane.speed)}
    sides = {"left": float(way.left), "right": float(way.right)}
    return {
        "type": "Feature",
        "properties": {
            "id": number,
            "startid": way.start,
            "endid": way.end,
            "metadata": {"id": way.id, "name": lane.name, "class": lane.kind, **sides, **limit},
        },
        "geometry": {
            "type": "LineString",
            "coordinates": [list(roads.nodes[end].at) for end in (way.start, way.end)],
        },
    }
