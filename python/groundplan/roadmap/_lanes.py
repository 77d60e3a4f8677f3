"""Lanes on the centre lines of corridors, nodes where these cross and where they end."""

from __future__ import annotations

import bisect
import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import shapely

from groundplan.export._places import Place, forwards
from groundplan.roadmap._model import Point

if TYPE_CHECKING:
    from groundplan.survey import Survey

#: Axes cross when they are this far from parallel: beyond what noise does to one aisle that goes on behind another.
CROSSING_RAD = math.radians(20)
#: Crossings of one junction that are nearer to each other than this are one node, metres: what a lane may be off the
#: centre line, from either side.
ONE_NODE_M = 0.25
#: A gap through a row is for people and not for vehicles: under so many metres, and under such a share of how wide ways
#: usually are there. Where all ways are narrow, as in an office, none is a gap.
GAP_M, GAP_SHARE = 1.2, 0.4
#: A node at a dead end stands so far before the wall, metres.
BEFORE_WALL_M = 0.6


@dataclass
class Stop:
    """A node to be: where, and which corridors pass there."""

    at: Point
    kind: str
    junction: int | None
    corridors: list[int]


@dataclass
class Way:
    """A corridor's centre line and the stops on it, as (metres from its start, stop).

    It runs to the right, or up where it is steeper than that: so do the numbers of the aisles. `aside` is how far the
    lane lies to the left of the middle.
    """

    place: Place
    start: Point
    along: Point
    length: float
    width: float
    aside: float = 0.0
    stops: list[tuple[float, int]] = field(default_factory=list)

    def place_of(self, at: Point) -> tuple[float, float]:
        """Metres along the centre line, and to its left."""
        dx, dy = at[0] - self.start[0], at[1] - self.start[1]
        return dx * self.along[0] + dy * self.along[1], dy * self.along[0] - dx * self.along[1]

    def point(self, along: float, left: float = 0.0) -> Point:
        """The point so far along the centre line and to its left."""
        (x, y), (u, v) = self.start, self.along
        return x + along * u - left * v, y + along * v + left * u

    def add(self, at: Point, stop: int) -> None:
        """Put a stop where it belongs."""
        bisect.insort(self.stops, (self.place_of(at)[0], stop))

    def line(self) -> Any:
        """From the first stop to the last as a shapely line; None where there is no lane."""
        if len(self.stops) < 2 or self.stops[0][0] == self.stops[-1][0]:
            return None
        return shapely.LineString([self.point(self.stops[0][0]), self.point(self.stops[-1][0])])

    def nearest(self, along: float) -> tuple[float, int]:
        """The stop nearest to a place, and where it is."""
        return min(self.stops, key=lambda stop: abs(stop[0] - along))

    def targets(self, seen: Point) -> Iterator[float]:
        """Where a way that comes from a place may meet the lane: square to it, or at its ends."""
        along, _ = self.place_of(seen)
        if self.lies_on_a_lane(along):
            yield along
        yield self.stops[0][0]
        yield self.stops[-1][0]

    def outwards(self, along: float) -> Point:
        """The direction in which it ends at that end of it which is nearer to a place."""
        sign = 1.0 if along > self.length / 2 else -1.0
        return sign * self.along[0], sign * self.along[1]

    def lies_on_a_lane(self, along: float) -> bool:
        """Whether there is a lane at that place."""
        return len(self.stops) > 1 and self.stops[0][0] <= along <= self.stops[-1][0]


def ways(places: Sequence[Place]) -> dict[int, Way]:
    """The corridors that have a length, by label id."""
    found = {}
    for place in places:
        if place.kind != "corridor" or place.axis is None:
            continue
        p, q = place.axis
        length = math.dist(p, q)
        if length <= 0:
            continue
        along = (q[0] - p[0]) / length, (q[1] - p[1]) / length
        if not forwards(*along):
            p, along = q, (-along[0], -along[1])
        found[place.label] = Way(place, p, along, length, place.width or 0.0)
    return found


def narrowest(ways: dict[int, Way]) -> float:
    """How wide a corridor has to be to have a lane where no vehicle is given, metres."""
    total = sum(way.length for way in ways.values())
    passed = 0.0
    for way in sorted(ways.values(), key=lambda way: way.width):
        passed += way.length
        if passed >= total / 2:  # half the length of all ways is narrower than this one
            return min(GAP_M, GAP_SHARE * way.width)
    return 0.0


def stops(survey: Survey, ways: dict[int, Way]) -> list[Stop]:
    """Every stop at a junction and at an end, each entered into its corridors."""
    made: list[Stop] = []

    def add(stop: Stop) -> None:
        for corridor in stop.corridors:
            ways[corridor].add(stop.at, len(made))
        made.append(stop)

    for n, label in enumerate(survey.labels):
        if label["kind"] == "junction":
            corridors = [c for c in dict.fromkeys(label.get("corridors", ())) if c in ways]
            if label["type"] != "end" and corridors:
                for stop in _crossings(n, (label["at"][0], label["at"][1]), corridors, ways):
                    add(stop)
    for corridor, way in ways.items():
        for at in _ends(survey, corridor, way, made, ways):
            add(at)
    return made


def _crossings(junction: int, at: Point, corridors: list[int], ways: dict[int, Way]) -> list[Stop]:
    """Where the centre lines of a junction's corridors cross: one stop, or several where aisles are out of line."""
    found: list[tuple[list[Point], set[int]]] = []
    for a, b in itertools.combinations(corridors, 2):
        point = crossing(ways[a], ways[b])
        if point is None or math.dist(point, at) > max(ways[a].width, ways[b].width):
            continue
        near = next((group for group in found if math.dist(_mean(group[0]), point) < ONE_NODE_M), None)
        if near is None:
            found.append(([point], {a, b}))
        else:
            near[0].append(point)
            near[1].update((a, b))
    if not found:
        return [Stop(at, "junction", junction, corridors)]
    return [Stop(_mean(points), "junction", junction, sorted(members)) for points, members in found]


def crossing(a: Way, b: Way) -> Point | None:
    """Where two centre lines cross, however far they have to go on for it; None where they run alike."""
    cross = a.along[0] * b.along[1] - a.along[1] * b.along[0]
    if abs(cross) < math.sin(CROSSING_RAD):
        return None
    dx, dy = b.start[0] - a.start[0], b.start[1] - a.start[1]
    return a.point((dx * b.along[1] - dy * b.along[0]) / cross)


def _mean(points: list[Point]) -> Point:
    return math.fsum(p[0] for p in points) / len(points), math.fsum(p[1] for p in points) / len(points)


def _ends(survey: Survey, corridor: int, way: Way, made: list[Stop], ways: dict[int, Way]) -> list[Stop]:
    """Stops at the ends of a corridor that goes on beyond its last junction, for longer than it is wide."""
    ends = [(n, j) for n, j in enumerate(survey.labels) if j["kind"] == "junction" and j["type"] == "end"]
    own = [(n, way.place_of(j["at"])[0]) for n, j in ends if corridor in j.get("corridors", ())]
    found = []
    back = min(BEFORE_WALL_M, way.length / 4)
    for far, place in ((0.0, back), (way.length, way.length - back)):
        label = next((n for n, along in own if abs(along - far) < max(way.width, 1.0)), None)
        beyond = math.inf
        if way.stops:
            along, stop = way.stops[0] if far == 0 else way.stops[-1]
            widths = [ways[c].width for c in made[stop].corridors if c != corridor]
            beyond = abs(far - along) - max(widths, default=0.0) / 2
        if beyond > way.width or (label is not None and beyond > back):
            found.append(Stop(way.point(place), "end", label, [corridor]))
    return found
