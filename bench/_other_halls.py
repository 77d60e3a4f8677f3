"""One hall of a harder site of another make, in its own frame: x along its rows, its floor [0, width] x [0, depth].

Each row of racks may have its gaps, its ends and its depth to itself. A port is a place of a wall where a passage may
come in: at the end of an aisle or of a cross aisle, or between two of them.
"""

from __future__ import annotations

import itertools
import random
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np
from _other_plan import Box, Face, Measures, Point, stock

#: Where a wall's outside is.
OUT: dict[str, Point] = {"east": (1.0, 0.0), "west": (-1.0, 0.0), "north": (0.0, 1.0), "south": (0.0, -1.0)}

_STAGGER = 2.5  # metres at least between cross aisles of neighbouring rows that do not face one another
_CLEAR = 2.5  # metres at least between a port and a cross aisle that it does not lead to
_OWN = 3.0  # metres at least between a port's own crossing and the next
_NARROWEST = 1.8  # metres, of a port


@dataclass(frozen=True)
class Row:
    """Racks in one line: from y to y, back to back or not, and from where to where they stand."""

    low: float
    high: float
    is_double: bool
    spans: list[tuple[float, float]]


@dataclass(frozen=True)
class Way:
    """A cross aisle: its middle and width, and the first and the last aisle that it joins."""

    x: float
    width: float
    first: int
    last: int


@dataclass(frozen=True)
class Port:
    """Where a passage may come in: the middle of the crossing that it makes or leads to, and how wide it may be.

    `is_new` when the crossing is the passage's own, `is_corner` when it is the hall's last; `size` is along x and y,
    `None` where an aisle that ends at the wall goes on through it.
    """

    side: str
    at: Point
    width: float
    size: Point | None
    is_new: bool = False
    is_corner: bool = False


@dataclass
class Hall:
    """A hall; `opened` are the ports that passages use, each with the way in which it goes out of the hall."""

    measures: Measures
    width: float
    depth: float
    rows: list[Row]
    aisles: list[float]
    ways: list[Way]
    low: float  # x of the aisles' first ends
    high: float  # ... and of their last
    opened: list[tuple[Port, Point]] = field(default_factory=list)

    def corridors(self) -> list[tuple[Point, Point, float]]:
        """Middle lines and widths of the aisles and the cross aisles."""
        width = self.measures.aisle
        lines: list[tuple[Point, Point, float]] = [((self.low, y), (self.high, y), width) for y in self.aisles]
        return lines + [((w.x, self.aisles[w.first]), (w.x, self.aisles[w.last]), w.width) for w in self.ways]

    def crossings(self) -> Iterator[tuple[Point, Point, list[Point]]]:
        """Where ways meet, the sizes of that along x and y, and the ways out."""
        ports = {port.at: [out for other, out in self.opened if other.at == port.at] for port, _ in self.opened}
        for k, y in enumerate(self.aisles):
            for x in sorted({way.x for way in self.ways if way.first <= k <= way.last}):
                here = [way for way in self.ways if way.x == x]
                arms = {(-1.0, 0.0): x > self.low, (1.0, 0.0): x < self.high}
                arms |= {(0.0, -1.0): any(w.first < k <= w.last for w in here)}
                arms |= {(0.0, 1.0): any(w.first <= k < w.last for w in here)}
                out = [arm for arm, is_open in arms.items() if is_open]
                yield (x, y), (here[0].width, self.measures.aisle), out + ports.pop((x, y), [])
        for port, _ in self.opened:
            if port.is_new and port.size:
                along: list[Point] = [(0.0, -1.0), (0.0, 1.0)] if OUT[port.side][0] else [(-1.0, 0.0), (1.0, 0.0)]
                yield port.at, port.size, along + ports[port.at]

    def faces(self) -> Iterator[Face]:
        """The walls' insides and the racks' long sides."""
        width, depth = self.width, self.depth
        yield from (Face("wall", (0, 0), (width, 0), (0, 1)), Face("wall", (0, depth), (width, depth), (0, -1)))
        yield from (Face("wall", (0, 0), (0, depth), (1, 0)), Face("wall", (width, 0), (width, depth), (-1, 0)))
        for row in self.rows:
            for left, right in row.spans:
                if row.low > 0:
                    yield Face("rack", (left, row.low), (right, row.low), (0, -1))
                if row.high < depth:
                    yield Face("rack", (left, row.high), (right, row.high), (0, 1))

    def stands(self, goods: np.random.Generator) -> tuple[list[Box], list[Box]]:
        """What stands in it, and the insides of racks that a drawing leaves out."""
        boxes: list[Box] = []
        hidden: list[Box] = []
        for row in self.rows:
            for left, right in row.spans:
                deep = (row.high - row.low) / (2 if row.is_double else 1)
                bays = round((right - left) / self.measures.bay)
                stocked, unseen = stock(
                    replace(self.measures, depth=deep, bays=bays), (left, row.low, right, row.high), goods
                )
                boxes += stocked
                hidden += unseen
        return boxes, hidden

    def ports(self, side: str, draw: random.Random) -> list[Port]:
        """Where a passage may come in through a wall, in no order."""
        found = self._at_ends(side, draw) if side in ("east", "west") else self._along(side, draw)
        draw.shuffle(found)
        return [port for port in found if port.width >= _NARROWEST]

    def _at_ends(self, side: str, draw: random.Random) -> list[Port]:
        wall = self.width if side == "east" else 0.0
        end = self.high if side == "east" else self.low
        aisle, cross = self.measures.aisle, self.measures.cross
        size = (cross, aisle) if end != wall else None
        found = [
            Port(side, (end, y), aisle * draw.uniform(0.75, 1), size, is_corner=y in (self.aisles[0], self.aisles[-1]))
            for y in self.aisles
        ]
        for row in self.rows:
            beside = (row.high - row.low + aisle) / 2
            if size and row.low > 0 and row.high < self.depth and beside >= _OWN:
                width = min(row.high - row.low, draw.uniform(2.0, 3.2))
                found.append(Port(side, (end, (row.low + row.high) / 2), width, (cross, width), is_new=True))
        return found

    def _along(self, side: str, draw: random.Random) -> list[Port]:
        k, y = (len(self.aisles) - 1, self.aisles[-1]) if side == "north" else (0, self.aisles[0])
        size = self.measures.cross, self.measures.aisle
        ways = [way.x for way in self.ways if way.first <= k <= way.last]
        whole = [way.x for way in self.ways if way.first == 0 and way.last == len(self.aisles) - 1]
        racks = [row for row in self.rows if ((row.high == self.depth) if side == "north" else (row.low == 0))]
        if racks:
            ways = [x for x in whole if not any(low < x < high for low, high in racks[0].spans)]
        found = [
            Port(side, (x, y), size[0] * draw.uniform(0.75, 1), size, is_corner=x in (self.low, self.high))
            for x in ways
        ]
        if not racks:
            width = draw.uniform(2.0, 3.2)
            apart = size[0] / 2 + width / 2 + _CLEAR
            places = [draw.uniform(3.0, self.width - 3.0) for _ in range(6)]
            clear = [x for x in places if all(abs(x - way) > apart for way in ways)]
            found += [Port(side, (x, y), width, (width, size[1]), is_new=True) for x in clear[:1]]
        return found


def hall(measures: Measures, is_staggered: bool, is_ragged: bool, draw: random.Random) -> Hall:
    """Lay a hall out."""
    bounds, aisles, depth = _bounds(measures, is_ragged, draw)
    first = measures.cross if measures.ends != "none" else 0.0
    count = measures.bays * measures.blocks
    inner = len(aisles) - 1
    shared = [measures.bays * k for k in range(1, measures.blocks)]
    gaps = _staggered(measures, inner, draw) if is_staggered else [shared] * inner
    x_high = first + count * measures.bay + len(gaps[0]) * measures.cross
    high = x_high + measures.cross / 2 if measures.ends == "both" else x_high
    width = x_high + measures.cross if measures.ends == "both" else x_high
    low = first / 2
    ways: list[Way] = []
    for k, places in enumerate(gaps):
        for j, bay in enumerate(places):
            x = first + bay * measures.bay + (j + 0.5) * measures.cross
            before = next((way for way in ways if way.last == k and abs(way.x - x) < 1e-6), None)
            if before:
                ways.remove(before)
            ways.append(Way(x, measures.cross, before.first if before else k, k + 1))
    if first:
        ways.append(Way(low, measures.cross, 0, inner))
    if measures.ends == "both":
        ways.append(Way(high, measures.cross, 0, inner))
    rows, early = [], (0, 0)
    for at, (bottom, top, is_double) in enumerate(bounds):
        is_inner = bottom > 0 and top < depth
        before_it = len([b for b in bounds[:at] if b[0] > 0])
        own = gaps[min(before_it, inner - 1)] if is_inner else ([] if is_staggered else shared)
        spans = _spans(measures, first, own, x_high)
        # Of two neighbours one ends early.
        early = (
            (_early(draw, first > 0, early[0]), _early(draw, measures.ends == "both", early[1])) if is_ragged else early
        )
        if is_inner:
            spans = _shortened(spans, early, measures.bay)
        rows.append(Row(bottom, top, is_double, spans))
    return Hall(measures, width, depth, rows, aisles, ways, low, high)


def _bounds(
    measures: Measures, is_ragged: bool, draw: random.Random
) -> tuple[list[tuple[float, float, bool]], list[float], float]:
    """From y to y of each row and whether it is back to back, the aisles' middles, and the hall's depth."""

    def deep() -> float:
        return measures.depth * draw.uniform(0.75, 1.25) if is_ragged else measures.depth

    y = deep() if measures.walls == "rack" else 0.0
    bounds = [(0.0, y, False)] if y else []
    aisles = []
    for k in range(measures.rows):
        aisles.append(y + measures.aisle / 2)
        y += measures.aisle
        if k < measures.rows - 1:
            is_double = not is_ragged or draw.random() < 0.7
            by = (2 if is_double else 1) * deep()
            bounds.append((y, y + by, is_double))
            y += by
    if measures.walls == "rack":
        by = deep()
        bounds.append((y, y + by, False))
        y += by
    return bounds, aisles, y


def _staggered(measures: Measures, inner: int, draw: random.Random) -> list[list[int]]:
    """Before which bays each row has its cross aisles: as its neighbour has them, or well beside them."""
    bays, count = measures.bays * measures.blocks, max(1, measures.blocks - 1)
    apart = int((measures.cross + _STAGGER) / measures.bay) + 1
    rows: list[list[int]] = []
    while len(rows) < inner:
        for _ in range(200):
            row = sorted(draw.sample(range(2, bays - 1), count))
            wide = all(b - a >= apart for a, b in itertools.pairwise(row))
            beside = not rows or all(
                abs(a - b) >= apart or (a, i) == (b, j) for i, a in enumerate(row) for j, b in enumerate(rows[-1])
            )
            if wide and beside and (len(rows) != 1 or row != rows[0]):
                break
        else:
            row = rows[-1] if rows else row
        rows.append(row)
    return rows


def _spans(measures: Measures, first: float, gaps: list[int], last: float) -> list[tuple[float, float]]:
    stops = [(first + bay * measures.bay + j * measures.cross) for j, bay in enumerate(gaps)]
    starts = [first, *(stop + measures.cross for stop in stops)]
    return list(zip(starts, [*stops, last], strict=True))


def _early(draw: random.Random, may: bool, before: int) -> int:
    """By how many bays a row ends before the others."""
    return draw.choice([0, 1, 2]) if may and not before else 0


def _shortened(spans: list[tuple[float, float]], early: tuple[int, int], bay: float) -> list[tuple[float, float]]:
    """Bays left out at both ends, as far as two of the first and the last rack stay."""
    (left, right), *_ = spans
    spans = [(left + min(early[0], max(0, round((right - left) / bay) - 2)) * bay, right), *spans[1:]]
    left, right = spans[-1]
    return [*spans[:-1], (left, right - min(early[1], max(0, round((right - left) / bay) - 2)) * bay)]
