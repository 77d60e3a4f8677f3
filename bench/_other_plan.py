"""Warehouses of another make than `groundplan.simulate`: one hall of whole blocks, racks without guards at their ends.

In the plan x runs along the rows of racks and y across them; the hall is [0, width] x [0, depth], metres. Cross aisles
may be missing at one end of the hall or at both, and racks or aisles may stand along its two long walls.
"""

from __future__ import annotations

import random
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

Point: TypeAlias = tuple[float, float]
Box: TypeAlias = tuple[float, float, float, float]  # from x, from y, to x, to y

_POST = 0.05  # metres, half a post's width
_SHEET = 0.06  # metres, how thick a hollow rack's sides are
_PALLET = 1.2  # metres of a bay's width for each pallet


@dataclass(frozen=True)
class Measures:
    """What is drawn at random for a site; metres, radians."""

    aisle: float
    cross: float
    depth: float
    bay: float
    rows: int
    blocks: int
    bays: int
    style: str
    fill: float
    ends: str
    walls: str
    yaw: float
    resolution: float
    look: str
    range: float
    noise: float
    clutter: int
    wall: float


@dataclass(frozen=True)
class Face:
    """A wall or a rack's long side from `p` to `q`, and the way to its floor."""

    kind: str
    p: Point
    q: Point
    floor: Point


@dataclass(frozen=True)
class Crossing:
    """Where an aisle and a cross aisle meet: its size along x and y, and the ways out of it as unit vectors."""

    at: Point
    size: Point
    arms: tuple[Point, ...]


@dataclass(frozen=True)
class Plan:
    """A site: what stands in it, and what a survey should find.

    `hidden` are the insides of racks that are drawn as not seen, `aisles` the y of the aisles' middles, `crosses` the
    x of the cross aisles'.
    """

    width: float
    depth: float
    boxes: list[Box]
    hidden: list[Box]
    faces: list[Face]
    aisles: list[float]
    crosses: list[float]
    corridors: list[tuple[Point, Point, float]]
    crossings: list[Crossing]


#: What each measure is drawn from, in this order: between two numbers, or one of several.
_RANGES: dict[str, Any] = {
    "aisle": (1.6, 4.2),
    "cross": (2.2, 5.0),
    "depth": (0.7, 1.3),
    "bay": (1.8, 3.6),
    "rows": range(3, 9),
    "blocks": range(1, 5),
    "bays": range(3, 9),
    "style": ["solid", "hollow", "legs", "shelves"],
    "fill": [1, 0.9, 0.7, 0.5],
    "ends": ["both", "both", "west", "none"],
    "walls": ["rack", "aisle"],
    "yaw": (-np.pi / 2, np.pi / 2),
    "resolution": [0.03, 0.05, 0.05, 0.05, 0.1],
    "look": ["trinary", "grey", "drawn"],
    "range": [8, 15, 25],
    "noise": [0.01, 0.02, 0.03],
    "clutter": [0, 0, 10, 25],
    "wall": (0.1, 0.3),
}
_WIDE = _RANGES | {
    "aisle": (1.2, 6.0),
    "cross": (1.6, 6.5),
    "depth": (0.4, 1.6),
    "bay": (1.0, 4.0),
    "rows": [2, 3, 4, 6, 9, 13, 20],
    "blocks": range(1, 6),
    "bays": [2, 3, 5, 8, 14],
    "fill": [1, 0.9, 0.8, 0.6],
    "resolution": [0.02, 0.04, 0.05, 0.08, 0.1],
    "range": [6, 12, 30],
    "noise": [0.005, 0.03, 0.05],
    "clutter": [0, 5, 20, 60],
    "wall": (0.05, 0.4),
}
#: A wide site is no larger, square metres, and no longer, metres.
_LARGEST, _LONGEST = 2600, 90


def measures(draw: random.Random, ranges: dict[str, Any] = _RANGES) -> Measures:
    """Draw a site's measures."""
    drawn = (draw.uniform(*of) if isinstance(of, tuple) else draw.choice(of) for of in ranges.values())
    return Measures(**dict(zip(ranges, drawn, strict=True)))


def wide(draw: random.Random) -> Measures:
    """Draw measures from wider ranges: two to twenty rows, narrow and wide ways, thin racks, maps from 2 cm on."""
    while True:
        site = measures(draw, _WIDE)
        length, depth = (site.bay * site.bays + site.cross) * site.blocks, (site.aisle + 2 * site.depth) * site.rows
        if length * depth <= _LARGEST and max(length, depth) <= _LONGEST:
            return site


def plan(site: Measures, draw: random.Random, goods: np.random.Generator) -> Plan:
    """Lay a site out: `draw` has the clutter in its aisles, `goods` what stands in its racks."""
    aisles, spans, depth = _rows(site)
    blocks, crosses, width = _blocks(site)
    w = site.wall
    boxes = [(-w, -w, width + w, 0.0), (-w, depth, width + w, depth + w)]
    boxes += [(-w, -w, 0.0, depth + w), (width, -w, width + w, depth + w)]
    faces = [Face("wall", (0, 0), (width, 0), (0, 1)), Face("wall", (0, depth), (width, depth), (0, -1))]
    faces += [Face("wall", (0, 0), (0, depth), (1, 0)), Face("wall", (width, 0), (width, depth), (-1, 0))]
    hidden: list[Box] = []
    for low, high in spans:
        for left, right in blocks:
            if low > 0:
                faces.append(Face("rack", (left, low), (right, low), (0, -1)))
            if high < depth:
                faces.append(Face("rack", (left, high), (right, high), (0, 1)))
            stocked, unseen = stock(site, (left, low, right, high), goods)
            boxes += stocked
            hidden += unseen
    boxes += [_clutter(site, width, aisles, draw, goods) for _ in range(site.clutter)]
    first = crosses[0] if site.ends != "none" else 0.0
    last = crosses[-1] if site.ends == "both" else width
    corridors: list[tuple[Point, Point, float]] = [((first, y), (last, y), site.aisle) for y in aisles]
    corridors += [((x, aisles[0]), (x, aisles[-1]), site.cross) for x in crosses]
    ends = (first, aisles[0], last, aisles[-1])
    crossings = [Crossing((x, y), (site.cross, site.aisle), _arms((x, y), ends)) for y in aisles for x in crosses]
    return Plan(width, depth, boxes, hidden, faces, aisles, crosses, corridors, crossings)


def _rows(site: Measures) -> tuple[list[float], list[tuple[float, float]], float]:
    """Middles of the aisles, the rows of racks between them (back to back) and at the walls, and the hall's depth."""
    spans = [(0.0, site.depth)] if site.walls == "rack" else []
    y = spans[0][1] if spans else 0.0
    aisles = []
    for row in range(site.rows):
        aisles.append(y + site.aisle / 2)
        y += site.aisle
        if row < site.rows - 1:
            spans.append((y, y + 2 * site.depth))
            y += 2 * site.depth
    if site.walls == "rack":
        spans.append((y, y + site.depth))
        y += site.depth
    return aisles, spans, y


def _blocks(site: Measures) -> tuple[list[tuple[float, float]], list[float], float]:
    """From where to where racks stand, the middles of the cross aisles, and the hall's width."""
    length = site.bay * site.bays
    crosses = [site.cross / 2] if site.ends != "none" else []
    x = site.cross if crosses else 0.0
    # A hall without any cross aisle has no crossing to be asked for.
    count = 2 if site.ends == "none" and site.blocks == 1 else site.blocks
    blocks = []
    for block in range(count):
        blocks.append((x, x + length))
        x += length
        if block < count - 1 or site.ends == "both":
            crosses.append(x + site.cross / 2)
            x += site.cross
    return blocks, crosses, x


def stock(site: Measures, rack: Box, goods: np.random.Generator) -> tuple[list[Box], list[Box]]:
    """What stands of a rack, single or back to back, and its inside where a drawing leaves that out."""
    if site.style == "solid":
        return [rack], []
    return (_hollow(rack), [rack]) if site.style == "hollow" else (_open(site, rack, goods), [])


def _hollow(rack: Box) -> list[Box]:
    """The four sides of a rack."""
    left, low, right, high = rack
    across = [(left, low, right, low + _SHEET), (left, high - _SHEET, right, high)]
    return [*across, (left, low, left + _SHEET, high), (right - _SHEET, low, right, high)]


def _open(site: Measures, rack: Box, goods: np.random.Generator) -> list[Box]:
    """Posts, and what stands between them: shelves that fill their bays, or pallets on the floor."""
    left, low, right, high = rack
    back_to_back = high - low > 1.5 * site.depth
    deep = [(low, low + site.depth), (high - site.depth, high)] if back_to_back else [(low, high)]
    boxes: list[Box] = []
    for front, back in deep:
        for k in range(site.bays + 1):
            x = min(max(left + k * site.bay, left + _POST), right - _POST)
            boxes += [(x - _POST, y - _POST, x + _POST, y + _POST) for y in (front + _POST, back - _POST)]
        for k in range(site.bays):
            x = left + k * site.bay
            if site.style == "shelves":
                if goods.random() < site.fill:
                    boxes.append((x, front + 0.02, x + site.bay, back - 0.02))
                continue
            count = max(1, int(site.bay // _PALLET))
            wide = site.bay / count
            for j in range(count):
                if goods.random() < site.fill:
                    stands_back, apart = goods.uniform(0.0, 0.12), goods.uniform(0.03, 0.12)
                    sides = (x + j * wide + apart, x + (j + 1) * wide - apart)
                    boxes.append((sides[0], front + stands_back, sides[1], back - goods.uniform(0, 0.1)))
    return boxes


def _clutter(site: Measures, width: float, aisles: list[float], draw: random.Random, goods: np.random.Generator) -> Box:
    """A box on the floor at one side of an aisle."""
    aisle = draw.choice(aisles)
    x = goods.uniform(0.5, width - 0.5)
    side = draw.choice([-1, 1])
    half = goods.uniform(0.1, 0.35) / 2
    y = aisle + side * (site.aisle / 2 - half)
    return x - half, y - half, x + half, y + half


def _arms(at: Point, ends: Box) -> tuple[Point, ...]:
    """The ways out of a crossing, of which there are none beyond the aisles' and the cross aisles' ends."""
    (x, y), (first, low, last, high) = at, ends
    ways = {(-1.0, 0.0): x > first, (1.0, 0.0): x < last, (0.0, -1.0): y > low, (0.0, 1.0): y < high}
    return tuple(arm for arm, is_open in ways.items() if is_open)
