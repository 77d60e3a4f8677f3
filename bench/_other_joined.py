"""Harder sites of another make: where halls stand, joined by gates and passages, and what is to be found in them."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from _other_halls import OUT, Hall, Port
from _other_plan import Box, Face, Point
from shapely.geometry import Polygon

WALL = 0.2  # metres, how thick walls are
_LONGEST = 14.0  # metres, of a passage
_OFF = 0.15  # metres that the two ends of a gate may be off one another


@dataclass(frozen=True)
class Meeting:
    """Where ways meet: the floor that they share as two vectors, and each way out with where it begins."""

    at: Point
    sides: tuple[Point, Point]
    arms: list[tuple[Point, float]]


@dataclass
class Layout:
    """A site in one frame: its convex walls, floors, racks' insides and all that stands, and what is to be found."""

    walls: list[list[Point]] = field(default_factory=list)
    floors: list[list[Point]] = field(default_factory=list)
    hidden: list[list[Point]] = field(default_factory=list)
    stands: list[list[Point]] = field(default_factory=list)
    faces: list[Face] = field(default_factory=list)
    corridors: list[tuple[Point, Point, float]] = field(default_factory=list)
    meetings: list[Meeting] = field(default_factory=list)


@dataclass(frozen=True)
class Place:
    """Where a hall's frame lies in the site."""

    origin: Point
    angle: float

    def turn(self, v: Point) -> Point:
        cos, sin = math.cos(self.angle), math.sin(self.angle)
        return v[0] * cos - v[1] * sin, v[0] * sin + v[1] * cos

    def back(self, v: Point) -> Point:
        """A way of the site as the hall has it."""
        return Place((0.0, 0.0), -self.angle).turn(v)

    def put(self, p: Point) -> Point:
        x, y = self.turn(p)
        return self.origin[0] + x, self.origin[1] + y

    def box(self, box: Box) -> list[Point]:
        left, low, right, high = box
        return [self.put(p) for p in ((left, low), (right, low), (right, high), (left, high))]


@dataclass(frozen=True)
class Standing:
    """A hall and where it stands."""

    hall: Hall
    place: Place

    def floor(self) -> list[Point]:
        """Its corners."""
        return self.place.box((0.0, 0.0, self.hall.width, self.hall.depth))

    def end(self, port: Port, gate: Point) -> Point:
        """Where a passage that comes in at a gate ends: at the crossing, or where the aisle goes on."""
        return self.place.put(port.at if port.size else gate)


@dataclass(frozen=True)
class Joint:
    """How one more hall is joined: by which ports, turned by how much, and at least how far beyond the wall."""

    here: Port
    there: Port
    turn: float
    length: float


def join(halls: list[Standing], new: Hall, joint: Joint, made: Layout) -> bool:
    """Put a hall beyond a wall of the last one, by a gate or a passage; False where there is no room for it."""
    old = halls[-1]
    out, facing = OUT[joint.here.side], OUT[joint.there.side]
    start, heading = old.place.put(at_wall(old.hall, joint.here)), old.place.turn(out)
    angle = old.place.angle + joint.turn + math.atan2(-out[1], -out[0]) - math.atan2(facing[1], facing[0])
    inward = Place((0.0, 0.0), angle).back(heading)
    gate = _reach(new, joint.there, inward)
    width = min(joint.here.width, joint.there.width)
    if gate is None or not _has_room(
        new, joint.there.side, gate, width / -(inward[0] * facing[0] + inward[1] * facing[1])
    ):
        return False
    length = joint.length
    moved = Place((0.0, 0.0), angle).put(gate)
    while length < _LONGEST:
        end = (start[0] + heading[0] * length, start[1] + heading[1] * length)
        standing = Standing(new, Place((end[0] - moved[0], end[1] - moved[1]), angle))
        if _is_free(standing, halls):
            _open(old, standing, joint, gate, made)
            halls.append(standing)
            return True
        if not joint.turn:
            return False
        length += 0.5
    return False


def join_again(halls: list[Standing], ports: tuple[list[Port], list[Port]], taken: Port, made: Layout) -> None:
    """One more gate between the last two halls, which are not turned, where a way of each ends at one place."""
    old, new = halls[-2:]
    for here in ports[0]:
        for there in ports[1]:
            if here.is_new or there.is_new or math.dist(here.at, taken.at) < 4 * here.width:
                continue
            gate = at_wall(new.hall, there)
            a, b, normal = old.place.put(at_wall(old.hall, here)), new.place.put(gate), old.place.turn(OUT[here.side])
            if abs((b[0] - a[0]) * normal[1] - (b[1] - a[1]) * normal[0]) < _OFF:
                _open(old, new, Joint(here, there, 0.0, 0.0), gate, made)
                return


def _open(old: Standing, new: Standing, joint: Joint, gate: Point, made: Layout) -> None:
    """The passage, and what it is to both halls."""
    first = at_wall(old.hall, joint.here)
    start, end = old.place.put(first), new.place.put(gate)
    width = min(joint.here.width, joint.there.width)
    _passage((start, end), width, new.place.turn(OUT[joint.there.side]), made)
    made.corridors.append((old.end(joint.here, first), new.end(joint.there, gate), width))
    out = OUT[joint.here.side]
    inward = new.place.back(old.place.turn(out))
    old.hall.opened.append((joint.here, out))
    new.hall.opened.append((joint.there, (-inward[0], -inward[1])))


def at_wall(of: Hall, port: Port) -> Point:
    """Where a port is in its wall."""
    x, y = port.at
    return {"east": (of.width, y), "west": (0.0, y), "north": (x, of.depth), "south": (x, 0.0)}[port.side]


def _reach(of: Hall, port: Port, inward: Point) -> Point | None:
    """Where a way that comes in along `inward` passes the wall so that it meets the port's crossing."""
    if port.size is None and abs(inward[0] * inward[1]) > 1e-6:
        return None
    x, y = port.at
    out = OUT[port.side]
    wall = at_wall(of, port)
    far = (wall[0] - x) * out[0] + (wall[1] - y) * out[1]
    by = far / -(inward[0] * out[0] + inward[1] * out[1])
    return x - by * inward[0], y - by * inward[1]


def _has_room(of: Hall, side: str, gate: Point, width: float) -> bool:
    """True when a gate is off the wall's ends."""
    at, end = (gate[1], of.depth) if side in ("east", "west") else (gate[0], of.width)
    return width / 2 + 0.3 < at < end - width / 2 - 0.3


def _is_free(new: Standing, halls: list[Standing]) -> bool:
    """True when a hall and its walls overlap no other."""
    outer = Polygon(new.floor()).buffer(WALL - 0.01, join_style="mitre")
    return not any(outer.intersects(Polygon(each.floor())) for each in halls)


def _passage(ends: tuple[Point, Point], width: float, out: Point, made: Layout) -> None:
    """Its floor, its two walls and their insides; oblique at its far end, at the wall whose outside is `out`."""
    (ax, ay), (bx, by) = ends
    length = math.dist(*ends)
    ux, uy = (bx - ax) / length, (by - ay) / length
    lean = (-uy * out[0] + ux * out[1]) / (ux * out[0] + uy * out[1])  # metres nearer for each metre to the left

    def at(along: float, left: float) -> Point:
        return ax + along * ux - left * uy, ay + along * uy + left * ux

    def far(left: float) -> float:
        return length - lean * left

    half = width / 2
    made.floors.append([at(0, -half), at(far(-half), -half), at(far(half), half), at(0, half)])
    for hand in (-1, 1):
        near, back = hand * half, hand * (half + WALL)
        corners = [at(0, near), at(far(near), near), at(far(back), back), at(0, back)]
        made.walls.append(corners if hand < 0 else corners[::-1])
        made.faces.append(Face("wall", at(0, near), at(far(near), near), (hand * uy, -hand * ux)))


def put(standing: Standing, made: Layout, goods: np.random.Generator) -> None:
    """A hall into the site."""
    of, place = standing.hall, standing.place
    width, depth, w = of.width, of.depth, WALL
    walls = [(-w, -w, width + w, 0.0), (-w, depth, width + w, depth + w)]
    walls += [(-w, -w, 0.0, depth + w), (width, -w, width + w, depth + w)]
    made.walls += [place.box(wall) for wall in walls]
    made.floors.append(place.box((0.0, 0.0, width, depth)))
    boxes, hidden = of.stands(goods)
    made.stands += [place.box(box) for box in boxes]
    made.hidden += [place.box(box) for box in hidden]
    made.faces += [Face(face.kind, place.put(face.p), place.put(face.q), place.turn(face.floor)) for face in of.faces()]
    made.corridors += [(place.put(a), place.put(b), wide) for a, b, wide in of.corridors()]
    for at, (long, high), arms in of.crossings():
        sides = place.turn((long, 0.0)), place.turn((0.0, high))
        starts = [(place.turn((x, y)), min(_over(long, x), _over(high, y))) for x, y in arms]
        made.meetings.append(Meeting(place.put(at), sides, starts))


def _over(size: float, part: float) -> float:
    """From a crossing's middle to its side along a way out."""
    return size / 2 / abs(part) if abs(part) > 1e-9 else math.inf
