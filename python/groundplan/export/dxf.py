"""DXF R2010 (AC1024): what CAD programs and layout tools of AGVs open.

Walls and lines are lines, racks, regions and zones closed polylines, places and nodes of the road map are blocks with
attributes that hold their stable ids, and entities carry their id as extended data of GROUNDPLAN too. Nothing in it
tells the time, so that the same survey gives the same bytes.
"""

from __future__ import annotations

import contextlib
import math
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from groundplan._errors import ParameterError
from groundplan._files import whole
from groundplan.export import _underlay
from groundplan.export._drawing import UNITS, Drawing
from groundplan.export._layers import Layer, layers
from groundplan.export._places import Place, main_angle, places, square
from groundplan.roadmap import RoadMap, road_map

if TYPE_CHECKING:
    from groundplan.maps import Map
    from groundplan.survey import Survey

PLACE = ("ID", "NAME", "KIND", "USE", "WIDTH", "AREA", "REGION")
NODE = ("ID", "NAME", "KIND", "TYPE")
#: Height of a name at most and at least, metres.
TEXT_M, LEAST_TEXT_M = 0.6, 0.15
#: The map's picture is blended with the sheet by so much, percent: names in the CAD's own colour, white on a dark
#: sheet, are read on its white floor.
FADE = 60


def write(
    survey: Survey,
    path: Path,
    units: str = "m",
    layers: str | os.PathLike[str] | Mapping[str, Any] | None = None,
    map: Map | None = None,
    **roads: Any,
) -> list[Path]:
    """Write the drawing, and where the map is given its picture beside it, as an underlay.

    Parameters
    ----------
    survey, path
        What to write, and where to.
    units
        ``m`` or ``mm``.
    layers
        What replaces rows of the table of layers; see `groundplan.export._layers`.
    map
        What was surveyed.
    **roads
        Options of `groundplan.roadmap.road_map`.

    Raises
    ------
    ParameterError
        ``export.units``, ``layers.value``.
    """
    if units not in UNITS:
        raise ParameterError("export.units", f"there is no unit {units!r}", "there are m and mm")
    plan = _Plan(units, _table(layers))
    picture = None if map is None else path.with_name(f"{path.stem}.underlay.png")
    if map is not None and picture is not None:
        plan.underlay(map, picture.name)
    plan.lines(survey)
    plan.places(survey, places(survey))
    plan.roads(road_map(survey, map=map, **roads))
    with contextlib.ExitStack() as files:
        beside = files.enter_context(whole(path))
        if map is not None and picture is not None:
            _underlay.write(map, files.enter_context(whole(picture)))
        plan.save(beside)
    return [path] if picture is None else [path, picture]


_table = layers


class _Plan(Drawing):
    """What is drawn of a survey."""

    def __init__(self, units: str, table: dict[str, Layer]) -> None:
        super().__init__(units, table)
        self.block("GROUNDPLAN_PLACE", PLACE)
        self.block("GROUNDPLAN_NODE", NODE)
        self.angle = 0.0

    def underlay(self, map: Map, name: str) -> None:
        """The map's picture, in place."""
        picture = self.doc.add_image_def(name, (map.width, map.height), name="MAP")
        corner, *_ = self.points(_underlay.corners(map))
        size = map.width * map.resolution * self.scale, map.height * map.resolution * self.scale
        held = self.on("map") | {"fade": FADE}
        self.space.add_image(picture, corner, size, math.degrees(map.origin[2]), dxfattribs=held)

    def lines(self, survey: Survey) -> None:
        """Walls, and the lines of the directions across the map."""
        ends = survey.walls.points.reshape(-1, 2, 2)
        for n, ((a, b), free) in enumerate(zip(ends, survey.walls.freestanding, strict=True)):
            self.line("freestanding" if free else "wall", a, b, f"wall {n}")
        frame = survey.map
        corners = _underlay.rectangle(frame.width * frame.resolution, frame.height * frame.resolution, frame.origin)
        for n, (direction, offset) in enumerate(zip(survey.lines.directions, survey.lines.offsets, strict=True)):
            piece = _clipped(corners, float(survey.directions.angles[direction]), float(offset))
            if piece is not None:
                self.line("line", piece[0], piece[1], f"line {n}")

    def places(self, survey: Survey, found: list[Place]) -> None:
        """Labels: outlines, centre lines, names, and a symbol with the place's attributes."""
        self.angle = main_angle(survey)
        for place in found:
            label = survey.labels[place.label]
            self._outline(place)
            self.symbol("place", "GROUNDPLAN_PLACE", place.centre, _attributes(place, found))
            if label.get("name"):
                angle = 0.0
                if place.axis is not None:
                    (x0, y0), (x1, y1) = place.axis
                    angle = math.atan2(y1 - y0, x1 - x0)
                size = place.width or (math.sqrt(place.shape.area) / 4 if place.shape is not None else 1.0)
                height = min(TEXT_M, max(LEAST_TEXT_M, 0.25 * size))
                # Above its line and its symbol, whichever way it reads.
                up = (angle + math.pi / 2 + 1e-6) % math.pi
                x, y = place.centre
                self.text("name", (x + height * math.cos(up), y + height * math.sin(up)), place.name, height, angle)

    def _outline(self, place: Place) -> None:
        """A place's shape: rings, their fill, a centre line."""
        what = place.kind if place.kind in self.table else "place"
        if place.shape is not None and place.kind != "junction":
            rings = [place.shape.exterior.coords[:-1], *(ring.coords[:-1] for ring in place.shape.interiors)]
            for ring in rings:
                self.ring(what, ring, place.id)
            if f"{place.kind}-fill" in self.table:
                self.fill(f"{place.kind}-fill", rings, place.id)
        if place.axis is not None and place.kind in ("corridor", "door"):
            self.line("axis" if place.kind == "corridor" else "door", place.axis[0], place.axis[1], place.id)
        if place.kind == "pillar":
            self.ring("pillar", square(place.centre, place.width or 0.2, self.angle), place.id)

    def roads(self, roads: RoadMap) -> None:
        """Lanes, nodes and zones of the road map."""
        for zone in roads.zones:
            self.ring(zone.kind, zone.ring, zone.id)
        for lane in roads.lanes:
            a, b = roads.nodes[lane.start].at, roads.nodes[lane.end].at
            self.line("lane", a, b, lane.id)
            middle = (a[0] + b[0]) / 2, (a[1] + b[1]) / 2
            self.text("lane-name", middle, lane.id, LEAST_TEXT_M, roads.heading(lane))
        for node in roads.nodes:
            values = dict(zip(NODE, (node.id, node.name, node.kind, node.type), strict=True))
            self.symbol("node", "GROUNDPLAN_NODE", node.at, values)


def _attributes(place: Place, found: list[Place]) -> dict[str, str]:
    region = "" if place.region is None else found[place.region].id
    width = "" if place.width is None else f"{place.width:.3f}"
    area = "" if place.area is None else f"{place.area:.3f}"
    return dict(zip(PLACE, (place.id, place.name, place.kind, place.use, width, area, region), strict=True))


def _clipped(
    corners: Sequence[tuple[float, float]], angle: float, offset: float
) -> tuple[tuple[float, float], tuple[float, float]] | None:
    """The part of a line that lies in a convex ring."""
    cos, sin = math.cos(angle), math.sin(angle)
    found = []
    for (ax, ay), (bx, by) in zip(corners, [*corners[1:], corners[0]], strict=True):
        da, db = ay * cos - ax * sin - offset, by * cos - bx * sin - offset
        if (da < 0) != (db < 0):
            t = da / (da - db)
            found.append((ax + t * (bx - ax), ay + t * (by - ay)))
    return (found[0], found[1]) if len(found) == 2 else None
