"""Racks with the pitch of their posts, and pillars, as the map shows them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from groundplan.simulate._lidar import FREE, OCCUPIED
from groundplan.simulate._plan import GroundPlan, Point, Rack
from groundplan.simulate._truth import Frame, Picture, mapped, walk

_AROUND = 0.35  # metres from a pillar's faces where floor shows that it stands by itself
_ALONE = 0.8  # share of the floor round a pillar that must be known to be free
_FACES = 0.5  # metres before a rack's faces


def patterns(plan: GroundPlan, picture: Picture, frame: Frame) -> dict[str, Any]:
    """``racks`` and ``pillars`` of the truth. What is not seen well enough to be told is marked so."""
    racks = [
        {
            "a": _point(frame(rack.a)),
            "b": _point(frame(rack.b)),
            "width": round(rack.depth, 4),
            "pitch": round(math.dist(rack.a, rack.b) / rack.bays, 4),
            "observed": _seen_rack(rack, picture, frame),
        }
        for rack in plan.racks
    ]
    pillars = [
        {"at": _point(frame(at)), "width": side, "observed": _seen_pillar(at, side, picture, frame)}
        for at, side in plan.pillars
    ]
    return {"racks": racks, "pillars": pillars}


def _point(p: Point) -> list[float]:
    return [round(p[0], 4), round(p[1], 4)]


def _seen_rack(rack: Rack, picture: Picture, frame: Frame) -> bool:
    """Is most of the floor along one of its faces known to be free?"""
    length = math.dist(rack.a, rack.b)
    nx, ny = -(rack.b[1] - rack.a[1]) / length, (rack.b[0] - rack.a[0]) / length
    off = rack.depth / 2 + _FACES
    sides = [[(x + sign * off * nx, y + sign * off * ny) for x, y in walk(rack.a, rack.b, 0.2)] for sign in (1, -1)]
    return any(float(np.mean(picture.at(mapped(side, frame)) == FREE)) > 0.7 for side in sides)


def _seen_pillar(at: Point, side: float, picture: Picture, frame: Frame) -> bool:
    """Has it left marks, and is the floor round it known to be free?"""
    reach = side / math.sqrt(2)
    around = [2 * math.pi * k / 48 for k in range(48)]
    ring = [(at[0] + (reach + _AROUND) * math.cos(a), at[1] + (reach + _AROUND) * math.sin(a)) for a in around]
    grid = [side * k / 8 for k in range(-5, 6)]
    marks = picture.at(mapped([(at[0] + u, at[1] + v) for u in grid for v in grid], frame)) == OCCUPIED
    return bool(marks.any()) and float(np.mean(picture.at(mapped(ring, frame)) == FREE)) >= _ALONE
