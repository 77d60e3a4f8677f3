"""Rooms, doors and halls as the map shows them, and the ground truth picture of the rooms."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from groundplan._polygons import fill
from groundplan.simulate._lidar import FREE, UNKNOWN
from groundplan.simulate._plan import GroundPlan, Point, inset
from groundplan.simulate._truth import Frame, Picture

_SEEN = 0.4  # share of a room's pixels that are known where it counts as observed
_RIM = 0.12  # metres from a room's outline in which what is not seen free is the wall's
_STRAIGHT = 0.02  # metres that a side may bend before it gets another corner
_ROOM, _DIVIDER = 254, 0


def rooms(plan: GroundPlan, picture: Picture, frame: Frame) -> tuple[dict[str, Any], npt.NDArray[np.uint8]]:
    """``rooms`` and ``doors`` of the truth, and its picture: rooms light, dark between them (row 0 is the top row).

    In the picture are the rooms that were observed, whole, whatever stands in them or was not seen of them; what of a
    doorway lies within the wall belongs to neither room, nor do the pixels of the walls' faces.
    """
    image = np.full(picture.pixels.shape, _DIVIDER, dtype=np.uint8)

    entries = []
    for room in plan.rooms:
        rings = [_outline(ring, frame) for ring in (room.polygon, *room.holes)]
        mask = _within(rings, picture)
        observed = _observed(mask, picture)
        entry = {"polygon": [_point(p) for p in rings[0]], "use": room.use, "observed": observed}
        if room.holes:
            entry["holes"] = [[_point(p) for p in ring] for ring in rings[1:]]
        entries.append(entry)
        if observed:
            inner = [inset(room.polygon, _RIM), *(inset(hole, -_RIM) for hole in room.holes)]
            core = _within([_outline(ring, frame) for ring in inner], picture)
            image[mask & (core | (picture.pixels == FREE))] = _ROOM
    doors = [
        {
            "at": _point(frame(door.at)),
            "width": round(door.width, 4),
            "a": door.a,
            "b": door.b,
            "state": door.state,
            "observed": door.state != "closed" and entries[door.a]["observed"] and entries[door.b]["observed"],
        }
        for door in plan.doors
    ]
    return {"rooms": entries, "doors": doors}, np.ascontiguousarray(image[::-1])


def halls(plan: GroundPlan, picture: Picture, frame: Frame) -> dict[str, Any]:
    """``halls`` of the truth, wall to wall; one counts as observed as a room does."""
    entries = []
    for hall in plan.halls:
        ring = _outline(hall, frame)
        observed = _observed(_within([ring], picture), picture)
        entries.append({"polygon": [_point(p) for p in ring], "observed": observed})
    return {"halls": entries}


def _within(rings: list[list[Point]], picture: Picture) -> npt.NDArray[np.bool_]:
    """Which pixels lie in an outline and not in its holes."""
    height, width = picture.pixels.shape
    return fill([(np.array(ring) - picture.origin) / picture.resolution for ring in rings], (height, width))


def _observed(mask: npt.NDArray[np.bool_], picture: Picture) -> bool:
    """Is enough of some pixels known?"""
    return bool(mask.any() and np.mean(picture.pixels[mask] != UNKNOWN) >= _SEEN)


def _point(p: Point) -> list[float]:
    return [round(p[0], 4), round(p[1], 4)]


def _outline(ring: list[Point], frame: Frame) -> list[Point]:
    """A ring as the map shows it, with more corners where the map bends its sides."""
    result: list[Point] = []
    for p, q in zip(ring, ring[1:] + ring[:1], strict=True):
        result += _side(p, q, frame)
    return result


def _side(p: Point, q: Point, frame: Frame) -> list[Point]:
    """From `p` on, short of `q`."""
    a, b, middle = frame(p), frame(q), ((p[0] + q[0]) / 2, (p[1] + q[1]) / 2)
    if math.dist(frame(middle), ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)) < _STRAIGHT or math.dist(p, q) < 1.0:
        return [a]
    return _side(p, middle, frame) + _side(middle, q, frame)
