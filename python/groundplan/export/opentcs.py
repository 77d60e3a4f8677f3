"""A plant model of openTCS 7: points, paths, locations and blocks, in whole millimetres.

A path leads one way, so that a two-way lane is two; nothing is driven in reverse. Pick faces are locations. A junction
is a block for one vehicle at a time.
"""

from __future__ import annotations

import math
from collections import defaultdict
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

from groundplan._files import write_bytes
from groundplan.export._text import one_line
from groundplan.roadmap import road_map

if TYPE_CHECKING:
    from groundplan.survey import Survey

VERSION = "7.0.0"
#: What a vehicle is taken to be where nobody says, millimetres.
VEHICLE_MM = 1000
#: The greatest speed where no rule says, millimetres per second.
SPEED_MM_S = 1000
PICK = "Pick face"
#: Millimetres on the drawing that one pixel shows.
SCALE = 50.0


def write(survey: Survey, path: Path, vehicle_width: float | None = None, **roads: Any) -> list[Path]:
    """Write the model; options as in `groundplan.roadmap.road_map`."""
    made = road_map(survey, vehicle_width=vehicle_width, **roads)
    width = VEHICLE_MM if vehicle_width is None else max(millimetres(vehicle_width), 1)
    root = ElementTree.Element("model", version=VERSION, name=one_line(survey.map.image) or "map")
    ways = list(made.directed())
    leaving = defaultdict(list)
    for way in ways:
        leaving[way.start].append(way.id)
    for n, node in enumerate(made.nodes):
        point = _at(root, "point", node.id, node.at, type="HALT_POSITION", vehicleOrientationAngle="NaN")
        box = {"length": VEHICLE_MM, "width": width, "height": VEHICLE_MM, "referenceOffsetX": 0, "referenceOffsetY": 0}
        _add(point, "maxVehicleBoundingBox", **box)
        for id in leaving[n]:
            _add(point, "outgoingPath", name=id)
        _properties(point, kind=node.kind, label=node.name)
        _add(point, "pointLayout", labelOffsetX=-10, labelOffsetY=-20, layerId=0)
    for way in ways:
        lane = way.lane
        own = _add(
            root,
            "path",
            name=way.id,
            sourcePoint=made.nodes[way.start].id,
            destinationPoint=made.nodes[way.end].id,
            length=max(millimetres(made.length(lane)), 1),
            maxVelocity=SPEED_MM_S if lane.speed is None else max(millimetres(lane.speed), 1),
            maxReverseVelocity=0,
            locked="false",
        )
        _properties(
            own, kind=lane.kind, label=lane.name, left_mm=millimetres(way.left), right_mm=millimetres(way.right)
        )
        _add(own, "pathLayout", connectionType="DIRECT", layerId=0)
    if made.faces:
        kind = _add(root, "locationType", name=PICK)
        for operation in ("Load cargo", "Unload cargo"):
            _add(kind, "allowedOperation", name=operation)
        _add(kind, "locationTypeLayout", locationRepresentation="LOAD_TRANSFER_GENERIC")
    for face in made.faces:
        own = _at(root, "location", face.id, face.at, type=PICK, locked="false")
        _add(own, "link", point=made.nodes[face.node].id)
        _properties(own, heading_deg=f"{math.degrees(face.heading):.3f}", width_mm=millimetres(face.width))
        layout = {"labelOffsetX": -10, "labelOffsetY": -20, "locationRepresentation": "DEFAULT", "layerId": 0}
        _add(own, "locationLayout", **layout)
    for node in made.nodes:
        if node.kind == "junction":
            block = _add(root, "block", name=f"Block-{node.id}", type="SINGLE_VEHICLE_ONLY")
            _add(block, "member", name=node.id)
            _add(block, "blockLayout", color="#FF0000")
    layout = _add(root, "visualLayout", name="VLayout", scaleX=SCALE, scaleY=SCALE)
    _add(layout, "layer", id=0, ordinal=0, visible="true", name="Default layer", groupId=0)
    _add(layout, "layerGroup", id=0, name="Default layer group", visible="true")
    ElementTree.indent(root)
    write_bytes(path, ElementTree.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n")
    return [path]


def millimetres(metres: float) -> int:
    """Whole millimetres."""
    return round(metres * 1000)


def _at(into: Any, kind: str, name: str, at: tuple[float, float], **values: Any) -> Any:
    x, y = (millimetres(value) for value in at)
    return _add(into, kind, name=name, positionX=x, positionY=y, positionZ=0, **values)


def _add(into: Any, kind: str, **values: Any) -> Any:
    return ElementTree.SubElement(into, kind, {key: str(value) for key, value in values.items()})


def _properties(into: Any, **values: Any) -> None:
    for name, value in values.items():
        _add(into, "property", name=f"groundplan:{name}", value=value)
