"""What stands in the racks and on the floor."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from groundplan.simulate._hall import POST, Hall
from groundplan.simulate._options import WarehouseOptions
from groundplan.simulate._plan import Corridor, GroundPlan, Point, Thing

_CLEAR = 0.45  # half the width of the strip along a centre line that stays free for the robot
_PALLET = (1.2, 0.8)


def fill_bay(
    plan: GroundPlan,
    hall: Hall,
    start: float,
    pitch: float,
    front: float,
    inward: int,
    deep: float,
    random: np.random.Generator,
) -> None:
    """Fill a bay: mostly two or three pallets, at times one long piece; some stand back, some stick out a little."""
    inner = pitch - POST
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
        depth = deep * float(random.uniform(0.6, 0.9))
        back = min(back, deep - depth)
        shift = float(random.uniform(-0.5, 0.5)) * (slot - length)
        u = start + POST / 2 + (k + 0.5) * slot + shift
        at = hall.put(u, front + inward * (back + depth / 2))
        plan.box(at, length, depth, hall.angle + float(random.normal(0.0, 0.015)))


def bay(
    plan: GroundPlan,
    place: tuple[Hall, float, float, float, int, float],
    options: WarehouseOptions,
    random: np.random.Generator,
) -> None:
    """Fill a bay, given as `fill_bay` takes it, or leave it empty."""
    since = len(plan.shapes)
    if random.random() >= options.sparse:
        fill_bay(plan, *place, random)
    plan.things.append(Thing("bay", since, len(plan.shapes), partial(fill_bay, plan, *place)))


def clutter(plan: GroundPlan, options: WarehouseOptions, random: np.random.Generator) -> None:
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
    here = len(plan.shapes)
    plan.things.append(Thing("clutter", here - 1, here, partial(_leave, plan, corridor)))
    return True


def _clear(corridor: Corridor, at: Point, radius: float) -> bool:
    """Does a thing of this radius leave the robot's strip along the corridor free?"""
    return near(corridor, at) > radius + _CLEAR


def floor_goods(plan: GroundPlan, options: WarehouseOptions, random: np.random.Generator) -> None:
    """Stack pallets on the floor, two to six in a line along a side of a way, where the robot still gets past."""
    if not options.goods:
        return
    for corridor in plan.corridors:
        length = math.dist(corridor.a, corridor.b)
        ux, uy = (corridor.b[0] - corridor.a[0]) / length, (corridor.b[1] - corridor.a[1]) / length
        off = corridor.width / 2 - _PALLET[1] / 2 - 0.08
        if off < _CLEAR + _PALLET[1] / 2 + 0.1:
            continue
        for _ in range(int(random.poisson(options.goods * length / 10))):
            start, side = float(random.uniform(0, length)), float(random.choice([-1.0, 1.0]))
            for k in range(int(random.integers(2, 7))):
                along = start + k * (_PALLET[0] + 0.1)
                shy = off - float(random.uniform(0.0, 0.1))
                at = corridor.a[0] + along * ux - side * shy * uy, corridor.a[1] + along * uy + side * shy * ux
                turn = math.atan2(uy, ux) + float(random.normal(0.0, 0.03))
                # Not on a crossing: no other way may pass here.
                if along > length or any(near(o, at) < o.width / 2 + 1.0 for o in plan.corridors if o is not corridor):
                    break
                plan.box(at, *_PALLET, turn)
                plan.things.append(Thing("pallet", len(plan.shapes) - 1, len(plan.shapes)))


def near(corridor: Corridor, at: Point) -> float:
    """Distance from a corridor's centre line."""
    ux, uy = corridor.b[0] - corridor.a[0], corridor.b[1] - corridor.a[1]
    t = ((at[0] - corridor.a[0]) * ux + (at[1] - corridor.a[1]) * uy) / (ux * ux + uy * uy)
    t = min(1.0, max(0.0, t))
    return math.dist(at, (corridor.a[0] + t * ux, corridor.a[1] + t * uy))
