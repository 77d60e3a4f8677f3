"""How an office's corridors run, and the strips of rooms along them; all on the walls' centre lines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from groundplan._errors import ParameterError
from groundplan.simulate._options import OfficeOptions
from groundplan.simulate._plan import Corridor, Point

WALL = 0.14  # thickness of the walls
_LEAST = 6.0  # metres that a strip must be long at least


@dataclass(frozen=True)
class Strip:
    """A row of rooms in a rectangle, with a corridor along its front.

    Attributes
    ----------
    low, high : (float, float)
        Lower left and upper right corner.
    front : str
        The side that the corridor runs along: south, east, north or west.
    reach : (float, float)
        From where to where it does, along that side.
    """

    low: Point
    high: Point
    front: str
    reach: Point

    @property
    def axis(self) -> int:
        """0 where the rooms follow one another along x, 1 along y."""
        return 0 if self.front in ("south", "north") else 1


@dataclass(frozen=True)
class Shape:
    """Corridors as one outline with perhaps a hole, their centre lines, and the strips along them."""

    outline: list[Point]
    hole: list[Point]
    corridors: list[Corridor]
    strips: list[Strip]


def shape(options: OfficeOptions, random: np.random.Generator) -> Shape:
    """The building that the options ask for."""
    make = {"straight": _straight, "L": _bent, "T": _branched, "ring": _ring}[options.shape]
    result = make(options, random)
    for strip in result.strips:
        if strip.high[strip.axis] - strip.low[strip.axis] < _LEAST or min(strip.reach[1] - strip.reach[0], 9) < 2.0:
            raise ParameterError(
                "simulate.small", f"a building of {options.width} m by {options.depth} m has no room for this shape"
            )
    return result


def _deep(options: OfficeOptions, random: np.random.Generator) -> float:
    return options.room_depth * float(random.uniform(0.85, 1.2))


def _rectangle(x0: float, y0: float, x1: float, y1: float) -> list[Point]:
    return [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]


def _straight(options: OfficeOptions, random: np.random.Generator) -> Shape:
    """One corridor with rooms on both sides."""
    w, c, half = options.width, options.corridor + WALL, WALL / 2
    south, north = _deep(options, random), _deep(options, random)
    y = south + c / 2
    return Shape(
        _rectangle(0, south, w, south + c),
        [],
        [Corridor((half, y), (w - half, y), options.corridor)],
        [
            Strip((0, 0), (w, south), "north", (0, w)),
            Strip((0, south + c), (w, south + c + north), "south", (0, w)),
        ],
    )


def _bent(options: OfficeOptions, random: np.random.Generator) -> Shape:
    """A corridor that turns once, north at its east end."""
    w, d, c, half = options.width, options.depth, options.corridor + WALL, WALL / 2
    outer, inner = _deep(options, random), _deep(options, random)
    left, right, low, high = w - outer - c, w - outer, outer, outer + c
    bend = (left + right) / 2, (low + high) / 2
    return Shape(
        [(0, low), (right, low), (right, d), (left, d), (left, high), (0, high)],
        [],
        [
            Corridor((half, bend[1]), bend, options.corridor),
            Corridor(bend, (bend[0], d - half), options.corridor),
        ],
        [
            Strip((0, 0), (w, low), "north", (0, right)),
            Strip((right, low), (w, d), "west", (low, d)),
            Strip((0, high), (left, high + inner), "south", (0, left)),
            Strip((left - inner, high + inner), (left, d), "east", (high + inner, d)),
        ],
    )


def _branched(options: OfficeOptions, random: np.random.Generator) -> Shape:
    """A corridor with another that leaves it northward."""
    w, d, c, half = options.width, options.depth, options.corridor + WALL, WALL / 2
    south, north = _deep(options, random), _deep(options, random)
    west, east = _deep(options, random), _deep(options, random)
    low, high = south, south + c
    left = w * float(random.uniform(0.4, 0.6)) - c / 2
    right, y = left + c, (low + high) / 2
    return Shape(
        [(0, low), (w, low), (w, high), (right, high), (right, d), (left, d), (left, high), (0, high)],
        [],
        [
            Corridor((half, y), (w - half, y), options.corridor),
            Corridor(((left + right) / 2, y), ((left + right) / 2, d - half), options.corridor),
        ],
        [
            Strip((0, 0), (w, south), "north", (0, w)),
            Strip((0, high), (left, high + north), "south", (0, left)),
            Strip((right, high), (w, high + north), "south", (right, w)),
            Strip((left - west, high + north), (left, d), "east", (high + north, d)),
            Strip((right, high + north), (right + east, d), "west", (high + north, d)),
        ],
    )


def _ring(options: OfficeOptions, random: np.random.Generator) -> Shape:
    """A corridor all round a core; the core's rooms stand back to back where it is deep enough."""
    w, d, c = options.width, options.depth, options.corridor + WALL
    outer = _deep(options, random)
    left, right, low, high = outer, w - outer, outer, d - outer
    core = (left + c, low + c), (right - c, high - c)
    deep = core[1][1] - core[0][1]
    if deep < 3.0:
        raise ParameterError("simulate.small", f"a depth of {d} m has no room for a core within a ring")
    middle = (core[0][1] + core[1][1]) / 2 + float(random.uniform(-0.1, 0.1)) * deep
    across = core[0][0], core[1][0]
    inner = [Strip(core[0], core[1], "south", across)]
    if deep > 6.5:
        inner = [
            Strip(core[0], (core[1][0], middle), "south", across),
            Strip((core[0][0], middle), core[1], "north", across),
        ]
    x0, x1, y0, y1 = left + c / 2, right - c / 2, low + c / 2, high - c / 2
    ring = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    return Shape(
        _rectangle(left, low, right, high),
        _rectangle(*core[0], *core[1]),
        [Corridor(p, q, options.corridor) for p, q in zip(ring, ring[1:] + ring[:1], strict=True)],
        [
            Strip((0, 0), (w, low), "north", (left, right)),
            Strip((0, high), (w, d), "south", (left, right)),
            Strip((0, low), (left, high), "east", (low, high)),
            Strip((right, low), (w, high), "west", (low, high)),
            *inner,
        ],
    )
