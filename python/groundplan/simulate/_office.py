"""The ground plan of an office: rooms along corridors, their walls, doors and furniture."""

from __future__ import annotations

import itertools
import math

import numpy as np

from groundplan.simulate._furniture import furnish
from groundplan.simulate._options import OfficeOptions
from groundplan.simulate._plan import Corridor, Door, Face, GroundPlan, Point, Room, inset, unit
from groundplan.simulate._strips import WALL, Shape, Strip, shape

_MOUTH = 1.6  # metres of corridor that every room has along its front at least
_JAMB = 0.25  # metres of wall between a door and a corner at least
_LEAF = 0.04  # thickness of a door
_HALL = 12.0  # length of a hall along the corridor, about
_SHORTEST = 0.3  # a shorter piece of wall is no line
_SHY = 0.7  # metres that the robot keeps from the walls of a room


def office_plan(options: OfficeOptions, random: np.random.Generator) -> GroundPlan:
    """Lay the office out: corridors, rooms with their doors, walls, ways into the rooms, and furniture."""
    building = shape(options, random)
    corners = [(x, y) for s in building.strips for x in (s.low[0], s.high[0]) for y in (s.low[1], s.high[1])]
    plan = GroundPlan([0.0, math.pi / 2], corners + building.outline, corridors=list(building.corridors))
    hole = [inset(building.hole, -WALL / 2)] if building.hole else []
    plan.rooms.append(Room(inset(building.outline, WALL / 2), "corridor", hole))
    rings = [building.outline, building.hole[::-1]] if building.hole else [building.outline]
    for strip, halls in zip(building.strips, _halls(building, options), strict=True):
        rings += _fill(plan, strip, halls, options, random)
    for ring in rings:
        _walls(plan, ring)
    for room in plan.rooms:
        for ring in (room.polygon, *(hole[::-1] for hole in room.holes)):
            _faces(plan, ring)
    for door in plan.doors:
        _hang(plan, door, random)
    for room in plan.rooms:
        furnish(plan, room, options.furniture, random)
    return plan


def _halls(building: Shape, options: OfficeOptions) -> list[int]:
    """How many halls each strip has: the longest first, one after another."""
    order = sorted(
        range(len(building.strips)),
        key=lambda k: (
            building.strips[k].low[building.strips[k].axis] - building.strips[k].high[building.strips[k].axis]
        ),
    )
    counts = [0] * len(order)
    for number in range(options.halls):
        counts[order[number % len(order)]] += 1
    return counts


def _fill(
    plan: GroundPlan, strip: Strip, halls: int, options: OfficeOptions, random: np.random.Generator
) -> list[list[Point]]:
    """Divide a strip into rooms, each with a door to the corridor; their outlines on the walls' centre lines."""
    axis = strip.axis
    stops = _stops(strip, halls, options, random)
    first, rings = len(plan.rooms), []
    for start, end in itertools.pairwise(stops):
        low, high = list(strip.low), list(strip.high)
        low[axis], high[axis] = start, end
        ring = [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])]
        rings.append(ring)
        hall = end - start > 0.7 * _HALL
        plan.rooms.append(Room(inset(ring, WALL / 2), "hall" if hall else "room"))
        _front_door(plan, strip, (start, end), hall, options, random)
    for k, stop in enumerate(stops[1:-1]):
        if random.random() < options.linked:
            _side_door(plan, strip, stop, first + k, options, random)
    return rings


def _stops(strip: Strip, halls: int, options: OfficeOptions, random: np.random.Generator) -> list[float]:
    """Where the walls between the rooms stand, both ends among them; every room has a mouth to the corridor."""
    start, end = strip.low[strip.axis], strip.high[strip.axis]
    halls = min(halls, int((end - start) / _HALL))
    rooms = max(1, round((end - start - halls * _HALL) / options.room_width)) if end - start > halls * _HALL else 0
    sizes = [options.room_width * float(random.uniform(0.7, 1.4)) for _ in range(rooms)]
    sizes += [_HALL * float(random.uniform(0.9, 1.2)) for _ in range(halls)]
    sizes = [sizes[k] for k in random.permutation(len(sizes)).tolist()]
    scale = (end - start) / sum(sizes)
    stops = [start + scale * s for s in itertools.accumulate(sizes[:-1])]
    low, high = strip.reach[0] + _MOUTH, strip.reach[1] - _MOUTH
    return [start, *(s for s in stops if low <= s <= high), end]


def _front_door(
    plan: GroundPlan, strip: Strip, span: Point, hall: bool, options: OfficeOptions, random: np.random.Generator
) -> None:
    """The door to the corridor, and the robot's way through it where it is not closed."""
    axis = strip.axis
    width = options.door * float(random.uniform(0.95, 1.1)) * (1.8 if hall else 1.0)
    low = max(span[0], strip.reach[0]) + WALL / 2 + _JAMB + width / 2
    high = min(span[1], strip.reach[1]) - WALL / 2 - _JAMB - width / 2
    place = float(random.uniform(low, max(low, high)))
    along: Point = {"south": (1.0, 0.0), "north": (-1.0, 0.0), "west": (0.0, -1.0), "east": (0.0, 1.0)}[strip.front]
    front = (strip.low if strip.front in ("south", "west") else strip.high)[1 - axis]
    at = (place, front) if axis == 0 else (front, place)
    door = Door(at, width, 0, len(plan.rooms) - 1, along, _state(options, random))
    plan.doors.append(door)
    if door.state == "closed":
        return
    nx, ny = -along[1], along[0]
    deep = strip.high[1 - axis] - strip.low[1 - axis]
    back = (options.corridor + WALL) / 2
    begin = at[0] - back * nx, at[1] - back * ny
    plan.ways.append(Corridor(begin, (at[0] + (deep - _SHY) * nx, at[1] + (deep - _SHY) * ny), 0.0))
    middle = at[0] + deep / 2 * nx, at[1] + deep / 2 * ny
    if span[1] - span[0] > 4.5:
        a, b = list(middle), list(middle)
        a[axis], b[axis] = span[0] + _SHY, span[1] - _SHY
        plan.ways.append(Corridor((a[0], a[1]), (b[0], b[1]), 0.0))


def _side_door(
    plan: GroundPlan, strip: Strip, stop: float, room: int, options: OfficeOptions, random: np.random.Generator
) -> None:
    """A door from a room to the next one of the strip."""
    axis = strip.axis
    margin = WALL / 2 + _JAMB + options.door / 2
    place = float(random.uniform(strip.low[1 - axis] + margin, strip.high[1 - axis] - margin))
    at = (stop, place) if axis == 0 else (place, stop)
    along: Point = (0.0, -1.0) if axis == 0 else (1.0, 0.0)
    plan.doors.append(Door(at, options.door, room, room + 1, along, _state(options, random)))


def _state(options: OfficeOptions, random: np.random.Generator) -> str:
    draw = random.random()
    if draw < options.closed:
        return "closed"
    return "half" if draw < options.closed + options.half_open else "open"


def _pieces(plan: GroundPlan, p: Point, q: Point) -> list[tuple[Point, Point]]:
    """What the doors leave of a piece of wall."""
    length, (ux, uy) = math.dist(p, q), unit(p, q)
    cuts = []
    for door in plan.doors:
        dx, dy = door.at[0] - p[0], door.at[1] - p[1]
        s = dx * ux + dy * uy
        if abs(dx * uy - dy * ux) < WALL and abs(door.along[0] * ux + door.along[1] * uy) > 0.5 and 0 < s < length:
            cuts += [s - door.width / 2, s + door.width / 2]
    stops = [0.0, *sorted(cuts), length]
    return [
        ((p[0] + a * ux, p[1] + a * uy), (p[0] + b * ux, p[1] + b * uy))
        for a, b in zip(stops[::2], stops[1::2], strict=True)
    ]


def _walls(plan: GroundPlan, ring: list[Point]) -> None:
    """Walls along an outline, half of them on either side; where doors are, nothing."""
    for p, q in zip(ring, ring[1:] + ring[:1], strict=True):
        ux, uy = unit(p, q)
        for a, b in _pieces(plan, p, q):
            before, after = (WALL / 2 if a == p else 0.0), (WALL / 2 if math.dist(b, q) < 1e-9 else 0.0)
            length = math.dist(a, b) + before + after
            shift = (after - before) / 2
            middle = (a[0] + b[0]) / 2 + shift * ux, (a[1] + b[1]) / 2 + shift * uy
            plan.box(middle, length, WALL, math.atan2(uy, ux))


def _faces(plan: GroundPlan, ring: list[Point]) -> None:
    """The faces of the walls of a room, whose floor is on the left of its outline."""
    for p, q in zip(ring, ring[1:] + ring[:1], strict=True):
        ux, uy = unit(p, q)
        plan.faces += [Face("wall", a, b, (-uy, ux)) for a, b in _pieces(plan, p, q) if math.dist(a, b) >= _SHORTEST]


def _hang(plan: GroundPlan, door: Door, random: np.random.Generator) -> None:
    """A door's leaf (a wide door has two), hinged at a jamb and swung into room `b`."""
    (ux, uy), leaves = door.along, (2 if door.width > 1.3 else 1)
    angle = {"closed": 0.0, "half": random.uniform(62, 78), "open": random.uniform(84, 96)}[door.state]
    hand = float(random.choice([-1.0, 1.0]))
    for side in (hand, -hand)[:leaves]:
        c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
        # From the hinge along the wall to the other jamb, turned by the angle into the room.
        lx, ly = -side * c * ux - s * uy, -side * c * uy + s * ux
        hinge = door.at[0] + side * door.width / 2 * ux, door.at[1] + side * door.width / 2 * uy
        length = door.width / leaves
        middle = hinge[0] + length / 2 * lx, hinge[1] + length / 2 * ly
        plan.box(middle, length, _LEAF, math.atan2(ly, lx))
