"""The ground plan of a warehouse: its halls with their walls and racks, what joins them, and what lies about."""

from __future__ import annotations

import math

import numpy as np

from groundplan.simulate._goods import bay, clutter, floor_goods, near
from groundplan.simulate._hall import POST, Hall, Row
from groundplan.simulate._halls import Passage, site
from groundplan.simulate._options import WarehouseOptions
from groundplan.simulate._plan import Corridor, Face, GroundPlan, Point, Rack

_WALL = 0.25  # thickness of the outer walls
_SIDES = ("south", "east", "north", "west")
_PILLAR = 0.4  # side of a pillar ...
_PASSED = 0.75  # ... which the robot's ways pass by
_ALIKE = math.radians(0.5)  # directions nearer than this are one


def warehouse_plan(options: WarehouseOptions, random: np.random.Generator) -> GroundPlan:
    """Lay the warehouse out: every hall, the passages between them, and then the things on the floor."""
    halls, passages = site(options, random)
    plan = GroundPlan(_directions(halls), [corner for hall in halls for corner in hall.corners()])
    plan.halls.extend(hall.corners() for hall in halls)
    for hall in halls:
        _build(plan, hall, options, random)
    for passage in passages:
        _join(plan, passage)
    if options.pillars:
        for hall in halls:
            _pillars(plan, hall, options)
    clutter(plan, options, random)
    floor_goods(plan, options, random)
    return plan


def _directions(halls: list[Hall]) -> list[float]:
    """The families of lines: along the rows and along the cross aisles of every hall, each once."""
    angles: list[float] = []
    for hall in halls:
        for angle in (hall.angle, hall.angle + math.pi / 2 + hall.lean):
            if all(abs((angle - a + math.pi / 2) % math.pi - math.pi / 2) > _ALIKE for a in angles):
                angles.append(angle)
    return angles


def _build(plan: GroundPlan, hall: Hall, options: WarehouseOptions, random: np.random.Generator) -> None:
    """The walls, racks and ways of a hall."""
    corners = hall.corners()
    for side, p, q in zip(_SIDES, corners, corners[1:] + corners[:1], strict=True):
        _wall(plan, p, q, _openings(hall, side))
    for row in hall.rows:
        for start, end in row.spans:
            _rack(plan, hall, row, start, end, options, random)
    for aisle in hall.aisles:
        plan.corridors.append(Corridor(hall.put(aisle.start, aisle.y), hall.put(aisle.end, aisle.y), aisle.width))
    for cross in hall.crosses:
        ends = hall.put(cross.u, cross.low), hall.put(cross.u, cross.high)
        plan.corridors.append(Corridor(*ends, cross.width * math.cos(hall.lean)))


def _openings(hall: Hall, side: str) -> list[tuple[float, float]]:
    """The gates of a wall as (start, end), metres from where it begins when one walks round the hall."""
    along = [(low, high) for at, low, high in hall.gates if at == side]
    if side in ("east", "west"):  # a wall that leans is longer than the hall is deep
        along = [(low / math.cos(hall.lean), high / math.cos(hall.lean)) for low, high in along]
    if side in ("north", "west"):
        whole = hall.width if side == "north" else hall.depth / math.cos(hall.lean)
        along = [(whole - high, whole - low) for low, high in along]
    return sorted(along)


def _wall(plan: GroundPlan, p: Point, q: Point, openings: list[tuple[float, float]]) -> None:
    """An outer wall, counter-clockwise round the hall, so its inside is on the left; not where there are gates."""
    length = math.dist(p, q)
    ux, uy = (q[0] - p[0]) / length, (q[1] - p[1]) / length
    inward = (-uy, ux)
    stops = [0.0, *(stop for pair in openings for stop in pair), length]
    for start, end in zip(stops[::2], stops[1::2], strict=True):
        a = p if start == 0.0 else (p[0] + start * ux, p[1] + start * uy)
        b = q if end == length else (p[0] + end * ux, p[1] + end * uy)
        before, after = (_WALL if start == 0.0 else 0.0), (_WALL if end == length else 0.0)
        plan.faces.append(Face("wall", a, b, inward))
        plan.slab((a[0] - before * ux, a[1] - before * uy), (b[0] + after * ux, b[1] + after * uy), _WALL, inward)


def _join(plan: GroundPlan, passage: Passage) -> None:
    """The two walls of a passage and its way."""
    plan.corridors.append(Corridor(passage.a, passage.b, passage.width))
    for p, q, back, outward in passage.sides:
        ring = [p, q, *back]
        area = sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(ring, ring[1:] + ring[:1], strict=True))
        plan.shapes.append(np.array(ring if area > 0 else ring[::-1]))
        if math.dist(p, q) >= 1.0:  # less is the jamb of a gate
            plan.faces.append(Face("wall", p, q, outward))


def _rack(
    plan: GroundPlan,
    hall: Hall,
    row: Row,
    start: float,
    end: float,
    options: WarehouseOptions,
    random: np.random.Generator,
) -> None:
    """One piece of a row between two cross aisles: its faces, its end guards, and what stands in its bays."""
    bays = max(1, round((end - start) / options.bay))
    pitch = (end - start) / bays
    deep = row.deep
    fronts = ([(row.y0, 1)] if row.below else []) + ([(row.y1, -1)] if row.above else [])
    for y, inward in fronts:
        plan.faces.append(Face("rack", hall.put(start, y), hall.put(end, y), hall.turn(0.0, -float(inward))))
        for k in range(bays + 1):
            u = min(max(start + k * pitch, start + POST / 2), end - POST / 2)
            for v in (y + inward * POST / 2, y + inward * (deep - POST / 2)):
                plan.box(hall.put(u, v), POST, POST, hall.angle)
        for k in range(bays):
            bay(plan, (hall, start + k * pitch, pitch, y, inward, deep), options, random)
    plan.racks.append(_axis(hall, row, start, end, bays))
    depth = row.y1 - row.y0
    if len(fronts) == 1 and depth > 1.5 * deep:
        # A block at a wall: behind the front rack it is filled with goods on pallets to the wall.
        y, inward = fronts[0]
        behind = deep + 0.15
        while behind + deep < depth + 0.01:
            for k in range(bays):
                bay(plan, (hall, start + k * pitch, pitch, y + inward * behind, inward, deep), options, random)
            behind += deep + 0.1
    for u, side in ((start, -1.0), (end, 1.0)):
        if not 0.01 < u < hall.width - 0.01:
            continue  # stands at the wall
        p, q = hall.put(u, row.y0), hall.put(u, row.y1)
        length = math.dist(p, q)
        outward = (side * (q[1] - p[1]) / length, -side * (q[0] - p[0]) / length)
        plan.faces.append(Face("rack", p, q, outward))
        # The guard that keeps forklifts off a row's end, a hand's breadth shorter than the row is deep.
        trim = 0.08
        plan.slab(hall.put(u, row.y0 + trim), hall.put(u, row.y1 - trim), 0.06, outward)


def _axis(hall: Hall, row: Row, start: float, end: float, bays: int) -> Rack:
    """A piece of a row from face to face; where it stands at a wall, one rack deep."""
    low = row.y0 if row.below else row.y1 - row.deep
    high = row.y1 if row.above else row.y0 + row.deep
    middle = (low + high) / 2
    return Rack(hall.put(start, middle), hall.put(end, middle), high - low, bays)


def _pillars(plan: GroundPlan, hall: Hall, options: WarehouseOptions) -> None:
    """A grid of pillars as near to its pitch as divides the hall evenly; none where the robot has its way."""
    counts = [max(2, round(extent / options.pillars)) for extent in (hall.width, hall.depth)]
    for i in range(1, counts[0]):
        for j in range(1, counts[1]):
            at = hall.put(i * hall.width / counts[0], j * hall.depth / counts[1])
            if all(near(way, at) > _PASSED for way in plan.corridors):
                plan.box(at, _PILLAR, _PILLAR, hall.angle)
                plan.pillars.append((at, _PILLAR))
