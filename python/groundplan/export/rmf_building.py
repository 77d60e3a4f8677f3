"""Open-RMF's ``.building.yaml``, in Cartesian metres: lanes, walls and the floor, for the traffic editor and rmf_site.

A parameter is a pair of its type and value: 1 text, 2 whole number, 3 number, 4 truth. Doors are left open in the walls
and not written as doors: a door of RMF's is one that a robot asks to open, and waits for.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from groundplan.export._rmf import LEVEL, metres, save
from groundplan.export._text import one_line
from groundplan.roadmap import Lane, road_map

if TYPE_CHECKING:
    from groundplan.survey import Survey

WALL = {
    "alpha": [3, 1.0],
    "texture_height": [3, 2.5],
    "texture_name": [1, "default"],
    "texture_scale": [3, 1.0],
    "texture_width": [3, 1.0],
}
FLOOR = {"texture_name": [1, "blue_linoleum"], "texture_rotation": [3, 0.0], "texture_scale": [3, 1.0]}


def write(survey: Survey, path: Path, **roads: Any) -> list[Path]:
    """Write one level; ``roads`` as in `groundplan.roadmap.road_map`."""
    made = road_map(survey, **roads)
    vertices: list[list[Any]] = [[metres(node.at[0]), metres(node.at[1]), 0.0, node.id, {}] for node in made.nodes]
    lanes = [_lane(lane) for lane in made.lanes]
    known: dict[tuple[float, float], int] = {}

    def corner(x: float, y: float) -> int:
        at = metres(x), metres(y)
        if at not in known:
            known[at] = len(vertices)
            vertices.append([*at, 0.0, "", {}])
        return known[at]

    ends = ((corner(*a), corner(*b)) for a, b in survey.walls.points.reshape(-1, 2, 2).tolist())
    walls = [[a, b, WALL] for a, b in ends if a != b]
    floor = {"parameters": FLOOR, "vertices": [corner(x, y) for x, y in _sheet(survey)]}
    level = {
        "elevation": 0.0,
        "drawing": {},
        "vertices": vertices,
        "lanes": lanes,
        "walls": walls,
        "doors": [],
        "floors": [floor],
        "measurements": [],
        "models": [],
        "layers": {},
    }
    name = one_line(survey.map.image) or "map"
    tree = {
        "name": Path(name).stem or "map",
        "coordinate_system": "cartesian_meters",
        "levels": {LEVEL: level},
        "lifts": {},
    }
    save(path, tree)
    return [path]


def _lane(lane: Lane) -> list[Any]:
    start, end = (lane.start, lane.end) if lane.way != "backward" else (lane.end, lane.start)
    return [
        start,
        end,
        {
            "bidirectional": [4, lane.way == "both"],
            "demo_mock_floor_name": [1, ""],
            "demo_mock_lift_name": [1, ""],
            "graph_idx": [2, 0],
            "mutex": [1, ""],
            "orientation": [1, ""],
            "speed_limit": [3, 0.0 if lane.speed is None else float(lane.speed)],
        },
    ]


def _sheet(survey: Survey) -> list[tuple[float, float]]:
    """The map's corners, counter-clockwise."""
    info = survey.map
    x, y, yaw = info.origin
    width, height = info.width * info.resolution, info.height * info.resolution
    cos, sin = math.cos(yaw), math.sin(yaw)
    corners = ((0.0, 0.0), (width, 0.0), (width, height), (0.0, height))
    return [(x + u * cos - v * sin, y + u * sin + v * cos) for u, v in corners]
