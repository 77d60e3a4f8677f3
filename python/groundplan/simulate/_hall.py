"""A hall: rack rows with their spans, aisles and cross aisles, in a frame of its own that is put into the plan."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from groundplan._errors import ParameterError
from groundplan.simulate._options import WarehouseOptions
from groundplan.simulate._plan import Point

POST = 0.10  # side of a rack's upright
FLUE = 0.20  # gap between the two halves of a double row

Span = tuple[float, float]


@dataclass
class Row:
    """A rack row from y0 to y1, open to an aisle below and above or standing at a wall."""

    y0: float
    y1: float
    below: bool
    above: bool
    deep: float  # of one rack
    spans: list[Span] = field(default_factory=list)  # (start, end) of its pieces, along u

    def cut(self, low: float, high: float) -> None:
        """Open a way through the row."""
        pieces = [piece for a, b in self.spans for piece in ((a, min(b, low)), (max(a, high), b))]
        self.spans = [(a, b) for a, b in pieces if b - a > 2 * POST]


@dataclass(frozen=True)
class Aisle:
    """A way along the rows, at y."""

    y: float
    width: float
    start: float
    end: float


@dataclass(frozen=True)
class Cross:
    """A way across the rows, at u, from y = low to y = high; its width is measured along the rows."""

    u: float
    width: float
    low: float
    high: float


@dataclass
class Hall:
    """One hall. (u, y) are its own metres along and across its rows; cross aisles are where u is constant.

    Attributes
    ----------
    lean : float
        How far the cross aisles lean from square to the rows, radians.
    crosswise : bool
        Do its rows run across those of the first hall?
    gates : list of (side, low, high)
        Openings in the walls; of the south and north wall along u, of the east and west along y.
    origin, angle
        Where the plan has the hall's corner, and the angle of its rows.
    """

    width: float
    depth: float
    lean: float
    closed: tuple[str, ...]
    rows: list[Row]
    aisles: list[Aisle]
    crosses: list[Cross]
    crosswise: bool = False
    gates: list[tuple[str, float, float]] = field(default_factory=list)
    origin: Point = (0.0, 0.0)
    angle: float = 0.0

    def put(self, u: float, y: float) -> Point:
        """Where the plan has (u, y)."""
        x, y = self.turn(u - y * math.tan(self.lean), y)
        return self.origin[0] + x, self.origin[1] + y

    def turn(self, x: float, y: float) -> Point:
        """A vector of the hall as the plan has it."""
        c, s = math.cos(self.angle), math.sin(self.angle)
        return c * x - s * y, s * x + c * y

    def find(self, at: Point) -> Point:
        """(u, y) of a point of the plan."""
        x, y = at[0] - self.origin[0], at[1] - self.origin[1]
        c, s = math.cos(self.angle), math.sin(self.angle)
        u, v = c * x + s * y, c * y - s * x
        return u + v * math.tan(self.lean), v

    def corners(self) -> list[Point]:
        """Its four corners, counter-clockwise from the south-west."""
        w, d = self.width, self.depth
        return [self.put(0, 0), self.put(w, 0), self.put(w, d), self.put(0, d)]


def lay_out(options: WarehouseOptions, random: np.random.Generator) -> Hall:
    """A regular hall.

    On an open side an aisle runs along the wall; along the south and north walls stands a single row that the cross
    aisles do not cut. On a closed south or north side stands a deep block that they do cut, ending at the wall; on a
    closed east or west side the rows run up to the wall and aisles end at it.
    """
    closed = options.closed_sides
    rows, ways = _across(options)
    spans, crosses = _along(options, random)
    for k, row in enumerate(rows):
        whole = (k == 0 and "south" not in closed) or (k == len(rows) - 1 and "north" not in closed)
        row.spans = [(spans[0][0], spans[-1][1])] if whole else list(spans)
    start = 0.0 if "west" in closed else crosses[0][0]
    end = options.width if "east" in closed else crosses[-1][0]
    low = 0.0 if "south" in closed else ways[0][0]
    high = options.depth if "north" in closed else ways[-1][0]
    return Hall(
        options.width,
        options.depth,
        math.radians(options.skew),
        closed,
        rows,
        [Aisle(y, width, start, end) for y, width in ways],
        [Cross(u, width, low, high) for u, width in crosses],
    )


def _across(options: WarehouseOptions) -> tuple[list[Row], list[tuple[float, float]]]:
    """Rows, and aisles as (centre line's y, width), from south to north."""
    single, double = options.rack_depth, 2 * options.rack_depth + FLUE
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
    rows = [Row(0.0, first, False, True, single)]
    aisles = []
    y = first
    for k in range(count):
        aisles.append((y + width / 2, width))
        y += width
        if k < count - 1:
            rows.append(Row(y, y + double, True, True, single))
            y += double
    rows.append(Row(y, options.depth, True, False, single))
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
