"""Lanes through doors: from a door to the corridor's lane abreast of it, or into the room behind it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from groundplan._results import UNSURE
from groundplan.roadmap._lanes import Way
from groundplan.roadmap._model import Point
from groundplan.roadmap._pixels import CLEAR_M, Pixels

if TYPE_CHECKING:
    from groundplan.export._places import Place
    from groundplan.survey import Survey

#: Of a door's lane so much may lie between the regions, in the wall itself, metres.
THRESHOLD_M = 0.3
#: A door this near to a stop, along the lane, is reached from that stop, metres.
AT_STOP_M = 0.3
#: How far into a room a lane may go straight before it turns, metres, and in which steps.
STRAIGHT_M, STEP_M = 8.0, 0.25
#: A turn is worth a detour of so much, metres.
TURN_M = 2.0
#: What is less is a small room, square metres.
SMALL_M2 = 6.0
#: A lane that runs through a region for longer than this is one of its lanes, metres.
THROUGH_M = 0.3
#: Half of what lies between two specks that block a lane as one, metres.
SPECK_M = 0.05


@dataclass(frozen=True)
class Branch:
    """The way from a door into the region on one side: to a corridor's lane, or to the region's own node.

    `turn` is where it turns, None where it is straight.
    """

    door: int
    region: int
    corridor: int | None
    along: float
    turn: Point | None = None

    @property
    def leads_to(self) -> tuple[int, int, float]:
        """The door, and what is told apart of where it leads: a corridor's place, or a region."""
        return (self.door, -1 - self.region, 0.0) if self.corridor is None else (self.door, self.corridor, self.along)


def branches(survey: Survey, places: list[Place], regions: Regions, least_m: float) -> Iterator[Branch]:
    """Both sides of every door that is at least so wide, as far as there is a straight or once bent way from it.

    Doors that lanes run through as it is have none, and so have alcoves and what may be none.
    """
    for door in places:
        label = survey.labels[door.label]
        if door.kind != "door" or (door.width is not None and door.width < least_m) or regions.passed(door):
            continue
        between = list(dict.fromkeys(label.get("between", ())))
        if any(regions.is_none(survey, region, door) for region in between):
            continue
        for region in between:
            found = regions.branch(door, region)
            if found is not None:
                yield found


class Regions:
    """The regions' free space, less what a lane keeps from walls and racks; made when first asked for."""

    def __init__(
        self, survey: Survey, places: list[Place], ways: dict[int, Way], pixels: Pixels | None, vehicle: float | None
    ) -> None:
        self.places, self.ways, self.pixels, self.vehicle = places, ways, pixels, vehicle
        self.walls = shapely.multilinestrings(shapely.linestrings(survey.walls.points.reshape(-1, 2, 2)))
        self.racks = shapely.union_all([p.shape for p in places if p.kind == "rack" and p.shape is not None])
        self.clear: dict[int, Any] = {}
        #: Corridors by the regions that their lanes run through.
        self.within: dict[int, list[int]] = {}
        lines = {corridor: way.line() for corridor, way in ways.items()}
        self.lines = {corridor: line for corridor, line in lines.items() if line is not None}
        for place in places:
            if place.kind == "region" and place.shape is not None:
                runs = {c: line.intersection(place.shape).length for c, line in self.lines.items()}
                self.within[place.label] = [c for c, length in runs.items() if length > THROUGH_M]

    def space(self, region: int) -> Any:
        """Where the middle of a lane may be in a region."""
        if region not in self.clear:
            shape = self.places[region].shape.simplify(0.075)  # a pixel's step is no wall
            # Specks by the thousand, as a fine map has them, grow into one another before they are grown to the full.
            shape = shape.buffer(-SPECK_M, quad_segs=4).buffer(SPECK_M - CLEAR_M)
            shape = shape.difference(self.racks.buffer(CLEAR_M))
            shapely.prepare(shape)
            self.clear[region] = shape
        return self.clear[region]

    def free(self, region: int, points: list[Point], door: Place | None = None) -> bool:
        """Whether a line keeps clear of the region's walls, but at its door."""
        line = shapely.LineString(points)
        # At the door the jambs are near; what stands in the way is not.
        mouth = None if door is None else shapely.Point(door.centre).buffer((door.width or 1.0) / 2 + 2 * CLEAR_M)
        inside = line if mouth is None else line.difference(mouth)
        if not inside.is_empty and not self.space(region).covers(inside):
            return False
        # Asked last, for it is answered from the region's whole outline.
        if mouth is not None and line.intersection(mouth).difference(self.places[region].shape).length > THRESHOLD_M:
            return False
        if self.pixels is None:
            return True
        width = math.inf if door is None or door.width is None else door.width
        return self.pixels.open(points, self.pixels.keep(width, self.vehicle or 0.0))

    def open(self, region: int, points: list[Point]) -> bool:
        """Whether a line keeps clear of all that stands in a region, what is seen of single posts too."""
        return self.free(region, points) and shapely.LineString(points).distance(self.walls) >= CLEAR_M

    def leads(self, a: Point, b: Point) -> bool:
        """Whether a straight way is free from one place to another, whatever regions it runs through."""
        if self.pixels is not None:
            line = shapely.LineString([a, b])
            return self.pixels.free(a, b) and self.pixels.open([a, b]) and not line.intersects(self.racks)
        return any(self.open(region, [a, b]) for region in self.within)

    def is_hall(self, region: int, points: list[Point], outwards: Point, depth: float) -> bool:
        """Whether all that lies beyond a straight line, as deep as an aisle is wide, is open but for pillars.

        Else the racks go on there, and what is open before them are empty bays.
        """
        (ax, ay), (bx, by) = points
        length = math.dist(*points)
        if not length or abs((bx - ax) * outwards[0] + (by - ay) * outwards[1]) > 0.5 * length:
            return False
        far = [(px + depth * outwards[0], py + depth * outwards[1]) for px, py in points[::-1]]
        beyond = shapely.Polygon([*points, *far])
        # Of the region what is near alone: a fine map's has specks by the thousand.
        near = self.places[region].shape.intersection(shapely.box(*beyond.buffer(2 * THRESHOLD_M).bounds))
        if not near.buffer(THRESHOLD_M).covers(beyond) or beyond.intersects(self.racks):
            return False
        if self.pixels is None:
            return bool(beyond.distance(self.walls) > 0)
        a, b = ((px + depth / 2 * outwards[0], py + depth / 2 * outwards[1]) for px, py in points)
        s, d = self.pixels.beside(a, b, depth / 2)
        inside = (s > 0) & (s < length)
        u, v = (bx - ax) / length, (by - ay) / length
        x, y = a[0] + s * u - d * v, a[1] + s * v + d * u
        for pillar in self.places:
            if pillar.kind == "pillar" and pillar.width:
                inside &= np.hypot(x - pillar.centre[0], y - pillar.centre[1]) > pillar.width
        return not inside.any()

    def outside(self, region: int, at: Point) -> bool:
        """Whether a point lies clearly outside a region."""
        return bool(self.places[region].shape.distance(shapely.Point(at)) > AT_STOP_M)

    def beside(self, region: int, points: list[Point]) -> float:
        """The free width on either side of a line in a region."""
        line, shape = shapely.LineString(points), self.places[region].shape
        return float(min(line.distance(shape.boundary), line.distance(self.racks)))

    def passed(self, door: Place) -> bool:
        """Whether a lane runs through a door as it is."""
        if door.axis is None:
            return any(line.distance(shapely.Point(door.centre)) < AT_STOP_M for line in self.lines.values())
        across = shapely.LineString(door.axis)
        return any(line.intersects(across) for line in self.lines.values())

    def is_none(self, survey: Survey, region: int, door: Place) -> bool:
        """Whether a region without lanes is no room to drive into, but a gap between goods.

        Those are less deep than their mouth is wide, or small and unsure.
        """
        if not 0 <= region < len(self.places) or self.places[region].shape is None or self.within.get(region):
            return False
        sure: float = survey.labels[region].get("confidence", 1.0)
        small = SMALL_M2 if sure <= UNSURE else 0.0
        return bool(self.places[region].shape.area < max(small, (door.width or 0.0) ** 2))

    def branch(self, door: Place, region: int) -> Branch | None:
        """The shortest way from a door to a lane in the region, or to its middle where it has no lanes."""
        if not 0 <= region < len(self.places) or self.places[region].shape is None:
            return None
        inward = self._inward(door, region)
        bends: list[Point | None] = [None, *_ahead(door.centre, inward)]
        options: list[tuple[float, Branch, list[Point]]] = []
        for turn in bends:
            seen = door.centre if turn is None else turn
            for corridor, along in self._targets(region, seen):
                at = self.places[region].centre if corridor is None else self.ways[corridor].point(along)
                points = [door.centre, *([] if turn is None else [turn]), at]
                length = math.fsum(itertools.starmap(math.dist, itertools.pairwise(points)))
                cost = length + (0 if turn is None else TURN_M)
                options.append((cost, Branch(door.label, region, corridor, along, turn), points))
        options.sort(key=lambda option: option[0])
        return next((branch for _, branch, points in options if self.free(region, points, door)), None)

    def _targets(self, region: int, seen: Point) -> Iterator[tuple[int | None, float]]:
        """Places on lanes that a door may be joined to: the one abreast of a point, and the stops at a lane's ends."""
        if not self.within.get(region):
            yield None, 0.0
        for corridor in self.within.get(region, ()):
            for along in self.ways[corridor].targets(seen):
                yield corridor, along

    def _inward(self, door: Place, region: int) -> Point:
        """Square to the door, into the region."""
        if door.axis is None or math.dist(*door.axis) == 0:
            x, y = self.places[region].centre
            away = math.dist(door.centre, (x, y)) or 1.0
            return (x - door.centre[0]) / away, (y - door.centre[1]) / away
        (x0, y0), (x1, y1) = door.axis
        length = math.dist(*door.axis)
        u, v = -(y1 - y0) / length, (x1 - x0) / length
        shape = self.places[region].shape
        ahead = [shapely.Point(door.centre[0] + s * u, door.centre[1] + s * v) for s in (0.5, -0.5)]
        sign = 1.0 if shape.distance(ahead[0]) <= shape.distance(ahead[1]) else -1.0
        return sign * u, sign * v


def _ahead(at: Point, inward: Point) -> Iterator[Point]:
    for n in range(2, round(STRAIGHT_M / STEP_M) + 1):
        yield at[0] + n * STEP_M * inward[0], at[1] + n * STEP_M * inward[1]
