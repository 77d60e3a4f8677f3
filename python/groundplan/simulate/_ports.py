"""Where a hall may have a gate, and the plane geometry of joining two halls."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np

from groundplan.simulate._hall import Hall
from groundplan.simulate._plan import Point

_CLEAR = 2.0  # metres between a gate of its own and the nearest cross aisle


@dataclass(frozen=True)
class Port:
    """A place in a wall that a way of the hall leads to or could lead to. All points are (u, y) of the hall.

    Attributes
    ----------
    side : str
        Of which wall.
    heading : float
        The way out, against the hall's rows, radians.
    anchor : (float, float)
        The crossing, or the way's end at the wall, that the passage starts from.
    gate : (float, float)
        Where the way meets the wall.
    wall : ((float, float), (float, float))
        The wall's ends.
    corner : bool
        Is the crossing the last before a corner of the hall?
    """

    side: str
    heading: float
    anchor: Point
    gate: Point
    wall: tuple[Point, Point]
    corner: bool


def ports(hall: Hall, width: float, random: np.random.Generator) -> list[Port]:
    """East and west at every aisle; south and north at the cross aisles, and at one place off them."""
    found = []
    w, d = hall.width, hall.depth
    for k, aisle in enumerate(hall.aisles):
        corner = k in (0, len(hall.aisles) - 1)
        found.append(Port("east", 0.0, (aisle.end, aisle.y), (w, aisle.y), ((w, 0.0), (w, d)), corner))
        found.append(Port("west", math.pi, (aisle.start, aisle.y), (0.0, aisle.y), ((0.0, 0.0), (0.0, d)), corner))
    outer = {cross.u for cross in (hall.crosses[0], hall.crosses[-1])}
    for side, edge, turn in (("south", 0.0, 1.5), ("north", d, 0.5)):
        way = hall.aisles[0 if side == "south" else -1].y
        end = edge if side in hall.closed else way
        here = [c for c in hall.crosses if abs((c.low if side == "south" else c.high) - end) < 1e-6]
        places = [c.u for c in here]
        alone = float(random.uniform(0.1, 0.9)) * w
        if side not in hall.closed and all(abs(alone - c.u) > (c.width + width) / 2 + _CLEAR for c in here):
            places.append(alone)
        for u in places:
            wall = ((0.0, edge), (w, edge))
            found.append(Port(side, turn * math.pi + hall.lean, (u, end), (u, edge), wall, u in outer))
    return found


def meet(p: Point, u: Point, line: tuple[Point, Point]) -> Point:
    """Where the line through `p` along `u` meets another; they are not parallel."""
    (ax, ay), (bx, by) = line
    vx, vy = bx - ax, by - ay
    t = ((ax - p[0]) * vy - (ay - p[1]) * vx) / (u[0] * vy - u[1] * vx)
    return p[0] + t * u[0], p[1] + t * u[1]


def apart(one: list[Point], other: list[Point]) -> float:
    """How far two convex polygons lie apart along the normal of an edge that parts them best; negative: overlap."""
    best = -math.inf
    for mine, theirs in ((one, other), (other, one)):
        area = sum(a[0] * b[1] - a[1] * b[0] for a, b in itertools.pairwise([*mine, mine[0]]))
        for a, b in itertools.pairwise([*mine, mine[0]]):
            length = math.copysign(math.dist(a, b), area)
            nx, ny = (b[1] - a[1]) / length, (a[0] - b[0]) / length
            best = max(best, min((p[0] - a[0]) * nx + (p[1] - a[1]) * ny for p in theirs))
    return best
