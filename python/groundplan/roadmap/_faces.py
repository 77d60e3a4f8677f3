"""Pick faces: where the bays of racks open on an aisle, and where a vehicle stands for them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from groundplan.export._places import Place, forwards
from groundplan.roadmap._lanes import Way
from groundplan.roadmap._model import Point

if TYPE_CHECKING:
    from groundplan.survey import Survey

#: A rack's face wavers, and so does the side of the aisle: they are one when no more than this lies between, metres.
BESIDE_M = 0.5
#: Bays across the aisle whose middles are nearer than this are served from one point, metres.
ABREAST_M = 0.25
#: A spur shorter than this is none, metres.
SHORTEST_SPUR_M = 0.3


@dataclass
class Bay:
    """A bay's open side, and where it lies along its aisle."""

    id: str
    at: Point
    rack: int
    corridor: int
    along: float
    left: float
    width: float


@dataclass
class Foot:
    """A point of a lane, and the bays abreast of it."""

    along: float
    bays: list[Bay]


@dataclass
class Posts:
    """The posts of a rack that tells its bays: metres from post to post, and along its axis to the first post."""

    rack: Place
    axis: tuple[Point, Point]
    width: float
    length: float
    pitch: float
    first: float


def posts(survey: Survey, places: list[Place]) -> Iterator[Posts]:
    """Of each rack that has a ``pitch``; its ``phase`` is where along its axis the first post stands."""
    for rack in places:
        label = survey.labels[rack.label]
        pitch = label.get("pitch")
        if rack.kind != "rack" or rack.axis is None or not pitch or rack.width is None:
            continue
        length = math.dist(*rack.axis)
        if length > 0 and pitch > 0 and length / pitch <= 10_000:
            yield Posts(
                rack, (rack.axis[0], rack.axis[1]), rack.width, length, pitch, float(label.get("phase") or 0.0) % pitch
            )


def bays(survey: Survey, places: list[Place], ways: dict[int, Way]) -> list[Bay]:
    """Every bay's open sides that lie on an aisle."""
    found = []
    for row in posts(survey, places):
        rack, pitch = row.rack, row.pitch
        (x0, y0), (x1, y1) = row.axis
        u, v = (x1 - x0) / row.length, (y1 - y0) / row.length
        # A rack that ends a little before its last post has that bay all the same.
        count = max(0, math.floor((row.length - row.first) / pitch + 0.25))
        turned = not forwards(u, v)
        for side, letter in ((1.0, "RL"[not turned]), (-1.0, "LR"[not turned])):
            for n in range(count):
                s, across = row.first + (n + 0.5) * pitch, side * row.width / 2
                at = x0 + s * u - across * v, y0 + s * v + across * u
                aisle = _aisle(at, (-side * v, side * u), ways)
                if aisle is not None:
                    along, left = ways[aisle].place_of(at)
                    number = count - n if turned else n + 1
                    found.append(Bay(f"{rack.id}.{letter}{number:02}", at, rack.label, aisle, along, left, pitch))
    return found


def _aisle(at: Point, outward: Point, ways: dict[int, Way]) -> int | None:
    """The corridor that a face opens on: parallel to it, its near side at the face, a lane in front of it."""
    best, nearest = None, BESIDE_M
    for corridor, way in ways.items():
        along, left = way.place_of(at)
        square = abs(outward[0] * way.along[1] - outward[1] * way.along[0])
        towards = (outward[0] * -way.along[1] + outward[1] * way.along[0]) * left < 0
        gap = abs(abs(left) - way.width / 2)
        if square > 0.9 and towards and gap < nearest and way.lies_on_a_lane(along):
            best, nearest = corridor, gap
    return best


def feet(bays: list[Bay]) -> dict[int, list[Foot]]:
    """The points of each corridor's lanes from which its bays are served, in order; bays across share one."""
    found: dict[int, list[Foot]] = {}
    for bay in sorted(bays, key=lambda bay: (bay.corridor, bay.along, bay.id)):
        row = found.setdefault(bay.corridor, [])
        last = row[-1] if row else None
        if last and bay.along - last.along < ABREAST_M and all((b.left > 0) != (bay.left > 0) for b in last.bays):
            last.bays.append(bay)
            last.along = math.fsum(b.along for b in last.bays) / len(last.bays)
        else:
            row.append(Foot(bay.along, [bay]))
    return found
