"""The ground plan of a warehouse of one hall: rack rows, aisles, cross aisles and walls."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from groundplan._errors import ParameterError
from groundplan.simulate._options import WarehouseOptions
from groundplan.simulate._plan import Corridor, Face, GroundPlan, Point

#: From (u along the rows, y across them) to the plan, which leans.
Place = Callable[[float, float], Point]

_POST = 0.10  # side of a rack's upright
_FLUE = 0.20  # gap between the two halves of a double row
_WALL = 0.25  # thickness of the outer walls
_CLEAR = 0.45  # half the width of the strip along a centre line that stays free for the robot


@dataclass(frozen=True)
class _Row:
    """A rack row across the plan: from y0 to y1, open to an aisle below and above or standing at a wall."""

    y0: float
    y1: float
    below: bool
    above: bool
    cut: bool  # do the cross aisles go through it


def warehouse_plan(options: WarehouseOptions, random: np.random.Generator) -> GroundPlan:
    """Lay the warehouse out.

    Rows run along x at constant y; cross aisles are where u = x + y tan(skew) is constant, so with a skew they lean
    while the rows stay where they are. On an open side an aisle runs along the wall; along the south and north walls
    stands a single row that the cross aisles do not cut. On a closed south or north side stands a deep block that
    they do cut, ending at the wall; on a closed east or west side the rows run up to the wall and aisles end at it.
    """
    lean = math.radians(options.skew)
    slope = math.tan(lean)

    def put(u: float, y: float) -> Point:
        return u - y * slope, y

    rows, aisles = _across(options)
    spans, crosses = _along(options, random)
    corners = [put(0, 0), put(options.width, 0), put(options.width, options.depth), put(0, options.depth)]
    plan = GroundPlan([0.0, math.pi / 2 + lean], corners)
    for p, q in zip(corners, corners[1:] + corners[:1], strict=True):
        _wall(plan, p, q)
    for row in rows:
        for start, end in spans if row.cut else [(spans[0][0], spans[-1][1])]:
            _rack(plan, row, start, end, put, options, random)

    west, east = "west" not in options.closed_sides, "east" not in options.closed_sides
    upright = [c for c, _ in crosses]
    for y, width in aisles:
        start = upright[0] if west else 0.0
        end = upright[-1] if east else options.width
        plan.corridors.append(Corridor(put(start, y), put(end, y), width))
    low = 0.0 if "south" in options.closed_sides else aisles[0][0]
    high = options.depth if "north" in options.closed_sides else aisles[-1][0]
    for u, width in crosses:
        plan.corridors.append(Corridor(put(u, low), put(u, high), width * math.cos(lean)))
    _clutter(plan, options, random)
    return plan


def _across(options: WarehouseOptions) -> tuple[list[_Row], list[tuple[float, float]]]:
    """Rows, and aisles as (centre line's y, width), from south to north."""
    single, double = options.rack_depth, 2 * options.rack_depth + _FLUE
    south, north = "south" in options.closed_sides, "north" in options.closed_sides
    # A closed side's block is two double rows deep, so that a cross aisle's end in it is no mere niche.
    first, last = (2 * double if south else single), (2 * double if north else single)
    room = options.depth - first - last
    count = max(1, round((room + double) / (options.aisle + double)))
    width = (room - (count - 1) * double) / count
    if count > 1 and width < 0.8 * options.aisle:
        count -= 1
        width = (room - (count - 1) * double) / count
    if width < 0.7 * options.aisle:
        raise ParameterError("simulate.small", f"a depth of {options.depth} m has no room for an aisle between racks")
    rows = [_Row(0.0, first, False, True, south)]
    aisles = []
    y = first
    for k in range(count):
        aisles.append((y + width / 2, width))
        y += width
        if k < count - 1:
            rows.append(_Row(y, y + double, True, True, True))
            y += double
    rows.append(_Row(y, options.depth, True, False, north))
    return rows, aisles


def _along(
    options: WarehouseOptions, random: np.random.Generator
) -> tuple[list[tuple[float, float]], list[tuple[float, float]]]:
    """Spans of the rows as (start, end), and cross aisles as (centre, width), along u from west to east."""
    # A width is measured across the cross aisle, so along the rows it takes more where that leans.
    wide = options.cross_aisle / math.cos(math.radians(options.skew))
    west, east = "west" not in options.closed_sides, "east" not in options.closed_sides
    room = options.width - wide * (options.cross_aisles + west + east)
    pieces = options.cross_aisles + 1
    bays = int(room / options.bay + 0.35)
    if bays < 2 * pieces:
        raise ParameterError(
            "simulate.small", f"a width of {options.width} m has no room for {pieces} rack rows of two bays"
        )
    bay = room / bays
    share = [bays // pieces + (k < bays % pieces) for k in range(pieces)]
    for k in range(pieces - 1):  # uneven spans, as in a real hall
        move = int(random.integers(-(share[k] // 4), share[k + 1] // 4 + 1))
        share[k], share[k + 1] = share[k] + move, share[k + 1] - move
    spans, crosses, u = [], [], 0.0
    if west:
        crosses.append((wide / 2, wide))
        u = wide
    for k, count in enumerate(share):
        spans.append((u, u + count * bay))
        u += count * bay
        if k < pieces - 1 or east:
            crosses.append((u + wide / 2, wide))
            u += wide
    return spans, crosses


def _wall(plan: GroundPlan, p: Point, q: Point) -> None:
    """An outer wall, counter-clockwise round the hall, so its inside is on the left."""
    length = math.dist(p, q)
    ux, uy = (q[0] - p[0]) / length, (q[1] - p[1]) / length
    inward = (-uy, ux)
    plan.faces.append(Face("wall", p, q, inward))
    plan.slab((p[0] - _WALL * ux, p[1] - _WALL * uy), (q[0] + _WALL * ux, q[1] + _WALL * uy), _WALL, inward)


def _rack(
    plan: GroundPlan,
    row: _Row,
    start: float,
    end: float,
    put: Place,
    options: WarehouseOptions,
    random: np.random.Generator,
) -> None:
    """One piece of a row between two cross aisles: its faces, its end guards, and what stands in its bays."""
    bays = max(1, round((end - start) / options.bay))
    pitch = (end - start) / bays
    deep = options.rack_depth
    fronts = ([(row.y0, 1)] if row.below else []) + ([(row.y1, -1)] if row.above else [])
    for y, inward in fronts:
        plan.faces.append(Face("rack", put(start, y), put(end, y), (0.0, -float(inward))))
        for k in range(bays + 1):
            u = min(max(start + k * pitch, start + _POST / 2), end - _POST / 2)
            for v in (y + inward * _POST / 2, y + inward * (deep - _POST / 2)):
                plan.box(put(u, v), _POST, _POST)
        for k in range(bays):
            if random.random() >= options.sparse:
                _goods(plan, start + k * pitch, pitch, y, inward, put, options, random)
    depth = row.y1 - row.y0
    if len(fronts) == 1 and depth > 1.5 * deep:
        # A block at a wall: behind the front rack it is filled with goods on pallets to the wall.
        y, inward = fronts[0]
        behind = deep + 0.15
        while behind + deep < depth + 0.01:
            for k in range(bays):
                if random.random() >= options.sparse:
                    _goods(plan, start + k * pitch, pitch, y + inward * behind, inward, put, options, random)
            behind += deep + 0.1
    for u, side in ((start, -1.0), (end, 1.0)):
        if not 0.01 < u < options.width - 0.01:
            continue  # stands at the wall
        p, q = put(u, row.y0), put(u, row.y1)
        length = math.dist(p, q)
        outward = (side * (q[1] - p[1]) / length, -side * (q[0] - p[0]) / length)
        plan.faces.append(Face("rack", p, q, outward))
        # The guard that keeps forklifts off a row's end, a hand's breadth shorter than the row is deep.
        trim = 0.08
        plan.slab(put(u, row.y0 + trim), put(u, row.y1 - trim), 0.06, outward)


def _goods(
    plan: GroundPlan,
    start: float,
    pitch: float,
    front: float,
    inward: int,
    put: Place,
    options: WarehouseOptions,
    random: np.random.Generator,
) -> None:
    """Fill a bay: mostly two or three pallets, at times one long piece; some stand back, some stick out a little."""
    inner = pitch - _POST
    slots = 1 if random.random() < 0.12 else max(1, round(inner / float(random.choice([0.9, 1.3]))))
    slot = inner / slots
    for k in range(slots):
        if slots > 1 and random.random() < 0.1:
            continue
        length = slot * float(random.uniform(0.74, 0.95))
        back = float(random.normal(0.05, 0.04))
        if random.random() < 0.1:
            back += float(random.uniform(0.2, 0.5))
        if random.random() < 0.05:
            back = -float(random.uniform(0.05, 0.15))
        depth = options.rack_depth * float(random.uniform(0.6, 0.9))
        back = min(back, options.rack_depth - depth)
        shift = float(random.uniform(-0.5, 0.5)) * (slot - length)
        u = start + _POST / 2 + (k + 0.5) * slot + shift
        plan.box(put(u, front + inward * (back + depth / 2)), length, depth, float(random.normal(0.0, 0.015)))


def _clutter(plan: GroundPlan, options: WarehouseOptions, random: np.random.Generator) -> None:
    """Leave things along the aisles' sides; the robot's strip along every centre line stays clear."""
    for corridor in plan.corridors:
        wanted = int(random.poisson(options.clutter * math.dist(corridor.a, corridor.b) / 10))
        for _ in range(4 * wanted):
            if wanted and _leave(plan, corridor, random):
                wanted -= 1


def _leave(plan: GroundPlan, corridor: Corridor, random: np.random.Generator) -> bool:
    """Try to leave one thing at the side of a corridor; False where it would stand in the robot's way."""
    length = math.dist(corridor.a, corridor.b)
    ux, uy = (corridor.b[0] - corridor.a[0]) / length, (corridor.b[1] - corridor.a[1]) / length
    along, kind, side = float(random.uniform(0, length)), random.random(), float(random.choice([-1.0, 1.0]))
    if kind < 0.35:  # a pallet along the face
        size, turn = (1.2, 0.8), float(random.normal(0.0, 0.05))
    elif kind < 0.75:  # a box, anyhow
        edge = float(random.uniform(0.3, 0.7))
        size, turn = (edge, edge * float(random.uniform(0.7, 1.0))), float(random.uniform(0.0, math.pi))
    else:  # a pole
        edge = float(random.uniform(0.08, 0.2))
        size, turn = (edge, edge), 0.0
    reach = math.hypot(*size) / 2
    breadth = size[1] / 2 + 0.05 if kind < 0.35 else reach
    off = corridor.width / 2 - size[1] / 2 - float(random.exponential(0.15))
    if off < _CLEAR + breadth:
        return False
    at = corridor.a[0] + along * ux - side * off * uy, corridor.a[1] + along * uy + side * off * ux
    if not all(_clear(other, at, reach) for other in plan.corridors if other is not corridor):
        return False
    plan.box(at, size[0], size[1], math.atan2(uy, ux) + turn)
    return True


def _clear(corridor: Corridor, at: Point, radius: float) -> bool:
    """Does a thing of this radius leave the robot's strip along the corridor free?"""
    ux, uy = corridor.b[0] - corridor.a[0], corridor.b[1] - corridor.a[1]
    t = ((at[0] - corridor.a[0]) * ux + (at[1] - corridor.a[1]) * uy) / (ux * ux + uy * uy)
    t = min(1.0, max(0.0, t))
    return math.dist(at, (corridor.a[0] + t * ux, corridor.a[1] + t * uy)) > radius + _CLEAR
