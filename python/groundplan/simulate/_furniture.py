"""Desks, chairs and cabinets: what of them a lidar's plane cuts."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
import numpy.typing as npt

from groundplan.simulate._goods import near
from groundplan.simulate._plan import GroundPlan, Point, Room, Thing

Floats = npt.NDArray[np.float64]

_LEG = 0.05
_CLEAR = 0.45  # metres that the robot's ways keep clear to either side
_DOOR = 1.1  # metres round a door where nothing stands


def furnish(plan: GroundPlan, room: Room, amount: float, random: np.random.Generator) -> None:
    """Fill a room; of a corridor only a few cabinets stand along its walls."""
    if not amount:
        return
    since = len(plan.shapes)
    sides = list(zip(room.polygon, room.polygon[1:] + room.polygon[:1], strict=True))
    for p, q in sides:
        _cabinets(plan, since, p, q, amount * (0.15 if room.use == "corridor" else 0.6), random)
    if room.use == "corridor":
        return
    low, high = room.polygon[0], room.polygon[2]
    if room.use == "hall":
        _islands(plan, since, low, high, amount, random)
    elif random.random() < 0.2:
        _table(plan, since, low, high, random)
    else:
        wanted = max(1, round(amount * (high[0] - low[0]) * (high[1] - low[1]) / 9))
        for _ in range(8 * wanted):
            if wanted and _desk_at_wall(plan, since, sides, random):
                wanted -= 1


def _free(plan: GroundPlan, since: int, at: Point, reach: float) -> bool:
    """Is a place clear of ways, doors and everything that stands already?"""
    ways = [*plan.ways, *plan.corridors]
    return (
        all(near(way, at) > reach + _CLEAR for way in ways)
        and all(math.dist(door.at, at) > reach + _DOOR for door in plan.doors)
        and all(_off(shape, at) > reach for shape in plan.shapes[since:])
    )


def _off(shape: Floats, at: Point) -> float:
    """From a point to a shape's middle, less its own reach along its shorter side."""
    middle = shape.mean(axis=0)
    return math.dist((float(middle[0]), float(middle[1])), at) - _size(shape) / 2


def _size(shape: Floats) -> float:
    return max(
        math.dist((float(a[0]), float(a[1])), (float(b[0]), float(b[1])))
        for a, b in zip(shape, np.roll(shape, -1, axis=0), strict=True)
    )


def _cabinets(plan: GroundPlan, since: int, p: Point, q: Point, amount: float, random: np.random.Generator) -> None:
    """Cabinets side by side along a part of a wall, the room on the left."""
    length = math.dist(p, q)
    if random.random() > amount or length < 2.0:
        return
    ux, uy = (q[0] - p[0]) / length, (q[1] - p[1]) / length
    deep, wide = float(random.uniform(0.35, 0.5)), float(random.choice([0.8, 1.0, 1.2]))
    start = float(random.uniform(0.1, length / 2))
    for k in range(int(random.integers(1, 5))):
        s = start + (k + 0.5) * wide
        at = p[0] + s * ux - (deep / 2 + 0.02) * uy, p[1] + s * uy + (deep / 2 + 0.02) * ux
        if s + wide / 2 > length - 0.1 or not _free(plan, since, at, 0.45 * deep):
            continue
        plan.box(at, 0.98 * wide, deep, math.atan2(uy, ux))
        plan.things.append(Thing("cabinet", len(plan.shapes) - 1, len(plan.shapes)))


def _desk_at_wall(plan: GroundPlan, since: int, sides: list[tuple[Point, Point]], random: np.random.Generator) -> bool:
    """Try to stand a desk with its chair at a wall; False where there is no room."""
    p, q = sides[int(random.integers(len(sides)))]
    length = math.dist(p, q)
    if length < 2.0:
        return False
    ux, uy = (q[0] - p[0]) / length, (q[1] - p[1]) / length
    s = float(random.uniform(0.9, max(0.9, length - 0.9)))
    at = p[0] + s * ux - 0.42 * uy, p[1] + s * uy + 0.42 * ux
    if not _free(plan, since, at, 0.8):
        return False
    first = len(plan.shapes)
    desk(plan, at, math.atan2(uy, ux), random)
    plan.things.append(Thing("desk", first, len(plan.shapes), partial(_desk_at_wall, plan, since, sides)))
    return True


def desk(plan: GroundPlan, at: Point, angle: float, random: np.random.Generator) -> None:
    """A desk of 1.6 m by 0.8 m: four legs, often a block of drawers, and a chair before it (to the left of `angle`)."""
    c, s = math.cos(angle), math.sin(angle)

    def put(u: float, v: float) -> Point:
        return at[0] + c * u - s * v, at[1] + s * u + c * v

    for u in (-0.76, 0.76):
        for v in (-0.36, 0.36):
            plan.box(put(u, v), _LEG, _LEG, angle)
    if random.random() < 0.6:
        plan.box(put(float(random.choice([-0.5, 0.5])), -0.05), 0.42, 0.58, angle)
    chair(plan, put(float(random.uniform(-0.25, 0.25)), 0.62 + float(random.uniform(0, 0.2))), random)


def chair(plan: GroundPlan, at: Point, random: np.random.Generator) -> None:
    """An office chair: five feet in a star, or four legs."""
    feet, turn = int(random.choice([4, 5])), float(random.uniform(0, 2 * math.pi))
    reach = 0.28 if feet == 5 else 0.26
    for k in range(feet):
        a = turn + 2 * math.pi * k / feet
        plan.box((at[0] + reach * math.cos(a), at[1] + reach * math.sin(a)), _LEG, _LEG, a)


def _table(plan: GroundPlan, since: int, low: Point, high: Point, random: np.random.Generator) -> None:
    """A meeting table in the middle with chairs round it; the robot's ways stay clear."""
    x, y = (low[0] + high[0]) / 2, (low[1] + high[1]) / 2
    length, wide = max(1.4, 0.45 * (high[0] - low[0])), max(0.9, 0.25 * (high[1] - low[1]))
    for sx in (-1, 1):
        for sy in (-1, 1):
            at = x + sx * (length / 2 - 0.1), y + sy * (wide / 2 - 0.1)
            if _free(plan, since, at, 0.05):
                plan.box(at, 0.07, 0.07)
    for k in range(int(length / 0.75)):
        for side in (-1.0, 1.0):
            at = x - length / 2 + (k + 0.5) * 0.75, y + side * (wide / 2 + 0.3)
            if random.random() < 0.8 and _free(plan, since, at, 0.2):
                first = len(plan.shapes)
                chair(plan, at, random)
                plan.things.append(Thing("chair", first, len(plan.shapes)))


def _islands(plan: GroundPlan, since: int, low: Point, high: Point, amount: float, random: np.random.Generator) -> None:
    """Desks in two rows, on either side of the way through the hall."""
    long = 0 if high[0] - low[0] > high[1] - low[1] else 1
    for along in np.arange(low[long] + 1.2, high[long] - 1.0, 2.0).tolist():
        for share, turn in ((0.25, math.pi), (0.75, 0.0)):
            across = low[1 - long] + share * (high[1 - long] - low[1 - long])
            at = (along, across) if long == 0 else (across, along)
            if random.random() < amount and _free(plan, since, at, 0.5):
                first = len(plan.shapes)
                desk(plan, at, turn if long == 0 else turn + math.pi / 2, random)
                plan.things.append(Thing("desk", first, len(plan.shapes)))
