"""LIF 1.0.0, the VDMA's Layout Interchange Format: the road map for master controls that speak VDA 5050.

Edges are directed, so that a two-way lane is two. Stations are the pick faces. LIF has no walls and no zones.
"""

from __future__ import annotations

import json
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from groundplan._errors import ParameterError
from groundplan._files import write_text
from groundplan.export._dates import moment
from groundplan.export._text import one_line, slug
from groundplan.roadmap import Directed, Node, PickFace, RoadMap, road_map

if TYPE_CHECKING:
    from groundplan.survey import Survey

VERSION = "1.0.0"


def write(
    survey: Survey, path: Path, date: str | datetime | None = None, vehicle_type: str = "AGV", **roads: Any
) -> list[Path]:
    """Write one layout; `vehicle_type` is the id of the vehicles that may use it, ``roads`` as in `road_map`.

    Raises
    ------
    ParameterError
        ``export.vehicle_type``.
    """
    vehicle = one_line(vehicle_type)
    if not vehicle:
        raise ParameterError("export.vehicle_type", f"the vehicle type {vehicle_type!r} is no name", "such as AGV")
    made, name = road_map(survey, **roads), one_line(survey.map.image) or "map"
    place = slug(Path(name).stem) or "map"
    tree = {
        "metaInformation": {
            "projectIdentification": name,
            "creator": "Groundplan",
            "exportTimestamp": moment(date).strftime("%Y-%m-%dT%H:%M:%S.00Z"),
            "lifVersion": VERSION,
        },
        "layouts": [
            {
                "layoutId": place,
                "layoutName": name,
                "layoutVersion": "1",
                "nodes": [_node(node, place, vehicle) for node in made.nodes],
                "edges": [_edge(way, made, vehicle) for way in made.directed()],
                "stations": [_station(face, made) for face in made.faces],
            }
        ],
    }
    write_text(path, json.dumps(tree, indent=1, ensure_ascii=False) + "\n")
    return [path]


def _node(node: Node, map: str, vehicle: str) -> dict[str, Any]:
    return {
        "nodeId": node.id,
        "nodeName": node.name,
        "mapId": map,
        "nodePosition": {"x": node.at[0], "y": node.at[1]},
        "vehicleTypeNodeProperties": [{"vehicleTypeId": vehicle}],
    }


def _edge(way: Directed, roads: RoadMap, vehicle: str) -> dict[str, Any]:
    limit = {} if way.lane.speed is None else {"maxSpeed": way.lane.speed}
    return {
        "edgeId": way.id,
        "edgeName": way.lane.name,
        "startNodeId": roads.nodes[way.start].id,
        "endNodeId": roads.nodes[way.end].id,
        "vehicleTypeEdgeProperties": [
            {
                "vehicleTypeId": vehicle,
                "vehicleOrientation": 0.0,
                "orientationType": "TANGENTIAL",
                "rotationAllowed": False,
                "rotationAtStartNodeAllowed": "BOTH",
                "rotationAtEndNodeAllowed": "BOTH",
                **limit,
            }
        ],
    }


def _station(face: PickFace, roads: RoadMap) -> dict[str, Any]:
    return {
        "stationId": face.id,
        "interactionNodeIds": [roads.nodes[face.node].id],
        "stationPosition": {"x": face.at[0], "y": face.at[1], "theta": face.heading},
    }
