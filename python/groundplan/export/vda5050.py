"""A zone set of VDA 5050 3.0: where vehicles must not be, how fast and which way they go where.

Racks and pillars are BLOCKED, what a rule slows down is SPEED_LIMIT, a corridor is BIDIRECTED along its axis, or
DIRECTED where a rule makes it one-way. No RELEASE zones are made: a vehicle would wait at each for a master control to
speak.
"""

from __future__ import annotations

import json
import math
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import shapely

from groundplan._files import write_text
from groundplan._shapes import outline
from groundplan.export._dates import moment
from groundplan.export._text import one_line, slug, unique
from groundplan.roadmap import RoadMap, road_map

if TYPE_CHECKING:
    from groundplan.survey import Survey

VERSION = "3.0.0"


def write(survey: Survey, path: Path, date: str | datetime | None = None, **roads: Any) -> list[Path]:
    """Write the zone set as the message that carries it; ``roads`` as in `groundplan.roadmap.road_map`."""
    made, name = road_map(survey, **roads), one_line(survey.map.image) or "map"
    place = slug(Path(name).stem) or "map"
    zones = [*_zones(made), *_corridors(survey, made)]
    for zone, id in zip(zones, unique(zone["zoneId"] for zone in zones), strict=True):
        zone["zoneId"] = id
    tree = {
        "headerId": 0,
        "timestamp": moment(date).strftime("%Y-%m-%dT%H:%M:%S.000Z"),
        "version": VERSION,
        "manufacturer": "",
        "serialNumber": "",
        "zoneSet": {"mapId": place, "zoneSetId": f"{place}-zones", "zoneSetDescriptor": name, "zones": zones},
    }
    write_text(path, json.dumps(tree, indent=1, ensure_ascii=False) + "\n")
    return [path]


def _zones(roads: RoadMap) -> list[dict[str, Any]]:
    """The road map's own zones."""
    made = []
    for zone in roads.zones:
        kind = (
            {"zoneType": "SPEED_LIMIT", "maximumSpeed": zone.speed} if zone.kind == "speed" else {"zoneType": "BLOCKED"}
        )
        if kind["zoneType"] == "BLOCKED" or zone.speed is not None:
            made.append({"zoneId": zone.id, **kind, "zoneDescriptor": zone.name, "vertices": _vertices(zone.ring)})
    return made


def _corridors(survey: Survey, roads: RoadMap) -> list[dict[str, Any]]:
    """Which way corridors go, as their lanes do."""
    made = []
    for n, label in enumerate(survey.labels):
        lanes = [lane for lane in roads.lanes if lane.label == n and lane.kind == "aisle"]
        shape = outline(label) if label["kind"] == "corridor" and lanes else None
        if shape is None:
            continue
        ways = {lane.way for lane in lanes}
        heading = roads.heading(lanes[0])
        if ways in ({"forward"}, {"backward"}):
            turned = heading if ways == {"forward"} else math.remainder(heading + math.pi, 2 * math.pi)
            kind = {"zoneType": "DIRECTED", "direction": round(turned, 6), "directedLimitation": "RESTRICTED"}
        else:
            kind = {"zoneType": "BIDIRECTED", "direction": round(heading, 6), "bidirectedLimitation": "SOFT"}
        ring = shapely.orient_polygons(shape).exterior.coords[:-1]
        made.append(
            {
                "zoneId": f"{slug(lanes[0].name) or 'corridor'}-way",
                **kind,
                "zoneDescriptor": lanes[0].name,
                "vertices": _vertices(ring),
            }
        )
    return made


def _vertices(ring: Any) -> list[dict[str, float]]:
    return [{"x": round(float(x), 4), "y": round(float(y), 4)} for x, y, *_ in ring]
