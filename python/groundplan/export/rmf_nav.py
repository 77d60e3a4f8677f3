"""Open-RMF's navigation graph, as fleet adapters load it: waypoints and lanes of one level.

Lanes are one-way there, whatever they say of themselves, so that a two-way lane is two. No waypoint shares its name.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from groundplan.export._rmf import LEVEL, metres, save
from groundplan.export._text import one_line
from groundplan.roadmap import road_map

if TYPE_CHECKING:
    from groundplan.survey import Survey


def write(survey: Survey, path: Path, **roads: Any) -> list[Path]:
    """Write the graph; ``roads`` as in `groundplan.roadmap.road_map`."""
    made = road_map(survey, **roads)
    vertices = [[metres(node.at[0]), metres(node.at[1]), {"name": node.id}] for node in made.nodes]
    lanes = [
        [way.start, way.end, {} if way.lane.speed is None else {"speed_limit": float(way.lane.speed)}]
        for way in made.directed()
    ]
    name = Path(one_line(survey.map.image) or "map").stem or "map"
    save(
        path,
        {"building_name": name, "levels": {LEVEL: {"vertices": vertices, "lanes": lanes}}, "doors": {}, "lifts": {}},
    )
    return [path]
