"""Several halls, joined by passages and gates, and a wing turned by any angle."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

import numpy as np

from groundplan._errors import ParameterError
from groundplan.simulate._hall import Hall, lay_out
from groundplan.simulate._options import WarehouseOptions
from groundplan.simulate._plan import Point
from groundplan.simulate._ports import Port, apart, meet, ports
from groundplan.simulate._staggered import stagger
from groundplan.simulate._uneven import make_uneven

_THICK = 0.25  # of a passage's walls
_APART = 0.5  # metres between two halls' insides: a gate goes through a wall as thick as that
_CORNER = 0.3  # metres of wall between a gate and a corner
_LONGEST = 30.0  # metres that a passage may grow so that nothing overlaps
_FACING = {"east": ("west",), "west": ("east",), "north": ("south",), "south": ("north",)}
_ACROSS = {"east": ("south", "north"), "west": ("south", "north"), "north": ("west", "east"), "south": ("west", "east")}

#: One wall of a passage: its face from p to q, the two corners behind it (next to q first), and where it looks.
Side = tuple[Point, Point, list[Point], Point]


@dataclass(frozen=True)
class Passage:
    """A way from a crossing of one hall to one of another, with its two walls."""

    a: Point
    b: Point
    width: float
    sides: list[Side]
    outline: list[Point]


def site(options: WarehouseOptions, random: np.random.Generator) -> tuple[list[Hall], list[Passage]]:
    """The halls, each joined to one before it, and the passages between them."""
    halls = [_hall(options, False, random)]
    passages: list[Passage] = []
    for number in range(1, options.halls):
        new = _hall(_smaller(options, random, 0.6, 0.95), options.crosswise and number % 2 == 1, random)
        passages.append(_grow(halls, passages, new, options, random))
    if options.wing:
        new = _hall(_smaller(options, random, 0.5, 0.75), False, random)
        passages.append(_grow(halls, passages, new, options, random, math.radians(options.wing)))
    return halls, passages


def _hall(options: WarehouseOptions, crosswise: bool, random: np.random.Generator) -> Hall:
    """A hall with all that makes it irregular, not yet in its place."""
    if crosswise:  # its rows run where the others have their cross aisles, so the lean is the other way round
        options = dataclasses.replace(options, skew=-options.skew)
    hall = lay_out(options, random)
    hall.crosswise = crosswise
    if options.uneven:
        make_uneven(hall, options, random)
    if options.staggered:
        stagger(hall, options, random)
    return hall


def _smaller(options: WarehouseOptions, random: np.random.Generator, least: float, most: float) -> WarehouseOptions:
    """The options of a hall that is smaller than the first, with as many cross aisles to its length."""
    width = max(float(random.uniform(least, most)) * options.width, min(20.0, options.width))
    depth = max(float(random.uniform(least, most)) * options.depth, min(16.0, options.depth))
    crosses = max(round(options.cross_aisles * width / options.width), min(1, options.cross_aisles))
    return dataclasses.replace(options, width=width, depth=depth, cross_aisles=crosses)


def _grow(
    halls: list[Hall],
    passages: list[Passage],
    new: Hall,
    options: WarehouseOptions,
    random: np.random.Generator,
    bend: float = 0.0,
) -> Passage:
    """Join one more hall to those that stand: where it fits, by the shortest passage that lets it."""
    width = min(options.aisle, float(random.uniform(2.4, 3.6)))
    doors = ports(new, width, random)
    pairs = [
        (hall, here, there)
        for hall in halls
        for here in ports(hall, width, random)
        for there in doors
        if there.side in (_FACING if hall.crosswise == new.crosswise else _ACROSS)[here.side]
    ]
    if bend:  # a turned passage from a hall's corner is hard to tell from the corner
        pairs = [pair for pair in pairs if not pair[1].corner] or pairs
    pairs = [pairs[k] for k in random.permutation(len(pairs)).tolist()]
    shortest = max(options.gap, _APART)
    for length in np.arange(shortest, shortest + _LONGEST, 0.5).tolist():
        for hall, here, there in pairs:
            passage = _join(hall, here, new, there, width, length, bend)
            others = [other.corners() for other in halls if other is not hall] + [p.outline for p in passages]
            if (
                passage is not None
                and apart(hall.corners(), new.corners()) >= _APART - 0.01
                and all(apart(other, mine) >= 1.0 for other in others for mine in (new.corners(), passage.outline))
            ):
                _open(hall, here, passage)
                _open(new, there, passage)
                halls.append(new)
                return passage
    raise ParameterError("simulate.small", "the halls cannot be joined without overlap", "try another seed")


def _join(hall: Hall, here: Port, new: Hall, there: Port, width: float, length: float, bend: float) -> Passage | None:
    """Put the new hall at the end of a passage; None where its mouth has no room in a wall."""
    heading = hall.angle + here.heading + bend
    u = math.cos(heading), math.sin(heading)
    a, wall = hall.put(*here.anchor), (hall.put(*here.wall[0]), hall.put(*here.wall[1]))
    gate = meet(a, u, wall)
    new.angle, new.origin = heading + math.pi - there.heading, (0.0, 0.0)
    found = new.put(*there.gate)
    new.origin = gate[0] + length * u[0] - found[0], gate[1] + length * u[1] - found[1]
    far = new.put(*there.wall[0]), new.put(*there.wall[1])
    sides: list[Side] = []
    for hand in (1.0, -1.0):
        rim, back = (
            [meet((a[0] - hand * off * u[1], a[1] + hand * off * u[0]), u, line) for line in (wall, far)]
            for off in (width / 2, width / 2 + _THICK)
        )
        if not all(_within(line, p) for line, p in ((wall, rim[0]), (wall, back[0]), (far, rim[1]), (far, back[1]))):
            return None
        sides.append((rim[0], rim[1], back[::-1], (hand * u[1], -hand * u[0])))
    outline = [sides[1][0], sides[1][1], sides[0][1], sides[0][0]]
    return Passage(a, new.put(*there.anchor), width, sides, outline)


def _within(line: tuple[Point, Point], p: Point) -> bool:
    """Does a point of a line lie between its ends, off the corners?"""
    length = math.dist(*line)
    return math.dist(line[0], p) < length - _CORNER and math.dist(line[1], p) < length - _CORNER


def _open(hall: Hall, port: Port, passage: Passage) -> None:
    """Make the gate in the hall's wall, and the way to it through the row that stands there."""
    rims = [(p, (q[0] - p[0], q[1] - p[1])) for p, q, _, _ in passage.sides]

    def cut(first: Point, second: Point) -> list[Point]:
        return [hall.find(meet(p, u, (hall.put(*first), hall.put(*second)))) for p, u in rims]

    axis = 1 if port.side in ("east", "west") else 0
    mouth = [place[axis] for place in cut(*port.wall)]
    hall.gates.append((port.side, min(mouth), max(mouth)))
    if axis == 0:
        row = hall.rows[0 if port.side == "south" else -1]
        places = [place[0] for y in (row.y0, row.y1) for place in cut((0.0, y), (hall.width, y))]
        row.cut(min(places), max(places))
