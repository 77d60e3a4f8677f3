"""What bounds each region: the walls along it, its doors, and where it goes over into another."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import shapely

from groundplan.export._places import Place

if TYPE_CHECKING:
    from groundplan.survey import Survey

#: A wall bounds a region that comes this near to it, metres: the region ends at the first occupied pixel.
NEAR_M = 0.25
#: Shorter pieces bound nothing, metres: they are where a wall's end touches a region's corner.
SHORTEST_M = 0.3


@dataclass(frozen=True)
class Boundary:
    """A piece of a region's outline.

    Attributes
    ----------
    region : int
        Label id.
    kind : str
        ``wall``, ``door`` or ``open``.
    by : int
        The wall's position in the outlines given, the door's label id, or the label id of the region beyond.
    line : shapely.LineString
        Metres; the longest piece where there are several.
    outer : bool
        Whether no region lies on its other side.
    """

    region: int
    kind: str
    by: int
    line: Any
    outer: bool


def boundaries(survey: Survey, found: list[Place], walls: list[Any]) -> Iterator[Boundary]:
    """All boundaries of all regions, given the walls' outlines."""
    regions = [place for place in found if place.kind == "region" and place.shape is not None]
    if not regions:
        return
    shapes = [place.shape for place in regions]
    tree, region_tree = shapely.STRtree(walls), shapely.STRtree(shapes)
    doors = [(place, _gap(place)) for place in found if place.kind == "door"]
    for place in regions:
        ring = place.shape.boundary
        for n in sorted(tree.query(place.shape, predicate="dwithin", distance=NEAR_M).tolist()):
            line = _longest(ring.intersection(walls[n].buffer(NEAR_M, cap_style="flat")))
            if line is not None:
                beyond = region_tree.query(walls[n], predicate="dwithin", distance=NEAR_M)
                yield Boundary(place.label, "wall", n, line, len(beyond) < 2)
        for door, gap in doors:
            if place.label in survey.labels[door.label].get("between", ()) and gap is not None:
                yield Boundary(place.label, "door", door.label, gap, False)
        near = region_tree.query(place.shape, predicate="dwithin", distance=survey.map.resolution * 1.5)
        for k in sorted(near.tolist()):
            if regions[k].label == place.label:
                continue
            shared = ring.intersection(shapes[k].buffer(survey.map.resolution * 1.5))
            for _, gap in doors:
                if gap is not None:
                    shared = shared.difference(gap.buffer(NEAR_M))
            line = _longest(shared)
            if line is not None:
                yield Boundary(place.label, "open", regions[k].label, line, False)


def _gap(door: Place) -> Any | None:
    if door.axis is None or door.axis[0] == door.axis[1]:
        return None
    return shapely.LineString(door.axis)


def _longest(shape: Any) -> Any | None:
    """The longest line among the pieces of a shape, if it is long enough."""
    merged = shapely.line_merge(shape) if shape.geom_type != "LineString" else shape
    lines = [part for part in shapely.get_parts(merged) if part.geom_type == "LineString"]
    line = max(lines, key=lambda part: part.length, default=None)
    return line if line is not None and line.length >= SHORTEST_M else None
