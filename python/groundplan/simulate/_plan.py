"""The ground plan of a simulated site: shapes, faces and a network of corridors, in a metric frame of its own.

A layout generator fills a GroundPlan; rasterising, driving, sensing and the truth read nothing else. So a new kind
of site is a new generator and no more.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

Point = tuple[float, float]

#: How far a corridor must go on beyond a crossing's own half width to count as an arm of the junction, metres.
_ARM = 2.0
#: Crossings nearer than this are one, metres.
_APART = 0.3
#: Three ways of which two meet at less than this angle are a Y and no T.
_SQUARE = math.radians(64.5)


@dataclass(frozen=True)
class Face:
    """A straight piece of wall or rack front that a survey should find.

    Attributes
    ----------
    kind : str
        ``wall`` or ``rack``.
    p, q : (float, float)
        Its ends, metres.
    outward : (float, float)
        Unit vector from the face to the side that it is seen from.
    """

    kind: str
    p: Point
    q: Point
    outward: Point


@dataclass(frozen=True)
class Corridor:
    """A way between racks or walls, whole: centre line from `a` to `b` and free width across it, metres.

    Where it meets another, `a` or `b` is the crossing's centre; at a dead end it is the end of the free space.
    """

    a: Point
    b: Point
    width: float


@dataclass(frozen=True)
class Room:
    """A piece of floor that walls set apart: its free outline, counter-clockwise, and its holes.

    `use` is ``room``, ``corridor`` or ``hall``.
    """

    polygon: list[Point]
    use: str
    holes: list[list[Point]] = field(default_factory=list)


@dataclass(frozen=True)
class Door:
    """A way through a wall from room `a` to room `b`: `at` is its middle; `state` is open, half or closed.

    `along` is the unit vector along the wall; its left-hand normal points into room `b`.
    """

    at: Point
    width: float
    a: int
    b: int
    along: Point
    state: str


@dataclass(frozen=True)
class Node:
    """A place of the network: `arms` are unit vectors along the corridors that leave it; `width` the widest of them."""

    at: Point
    arms: tuple[Point, ...]
    width: float

    @property
    def kind(self) -> str | None:
        """L, T, Y, X or end; None where a corridor merely goes straight on."""
        if len(self.arms) == 2:
            (ax, ay), (bx, by) = self.arms
            return None if ax * bx + ay * by < -0.94 else "L"
        if len(self.arms) == 3:
            cosines = [a[0] * b[0] + a[1] * b[1] for a, b in itertools.combinations(self.arms, 2)]
            return "T" if min(cosines) < -0.94 and max(cosines) < math.cos(_SQUARE) else "Y"
        return {1: "end", 4: "X"}.get(len(self.arms))


@dataclass(frozen=True)
class Rack:
    """One piece of a rack row: its centre line from `a` to `b`, its depth, and how many bays of one width it has."""

    a: Point
    b: Point
    depth: float
    bays: int


@dataclass(frozen=True)
class Thing:
    """Something that can be carried away: shapes `first` to `last` (excluded) of the plan; none for an empty place.

    `put` puts something else of its kind there or thereabouts; None where nothing takes its place.
    """

    kind: str
    first: int
    last: int
    put: Callable[[np.random.Generator], object] | None = None


@dataclass
class GroundPlan:
    """Everything that a robot could run into, and what it means.

    Attributes
    ----------
    directions : list of float
        Angle of each family of lines, radians.
    shapes : list of (n, 2) float arrays
        Convex polygons, counter-clockwise, metres: all that a lidar's plane cuts.
    faces, corridors
        What a survey of a perfect map would find.
    rooms, doors
        The same of an office: a warehouse has none.
    halls : list of list of (float, float)
        Of a warehouse the corners of each hall.
    ways : list of Corridor
        What is driven besides the corridors.
    racks, pillars
        Pieces of rack rows, and (middle, side) of square pillars.
    things : list of Thing
        Goods and furniture, and empty places for them.
    outline : list of (float, float)
        Corners of the halls: all lies within their box.
    """

    directions: list[float]
    outline: list[Point]
    shapes: list[npt.NDArray[np.float64]] = field(default_factory=list)
    faces: list[Face] = field(default_factory=list)
    corridors: list[Corridor] = field(default_factory=list)
    rooms: list[Room] = field(default_factory=list)
    doors: list[Door] = field(default_factory=list)
    halls: list[list[Point]] = field(default_factory=list)
    ways: list[Corridor] = field(default_factory=list)
    racks: list[Rack] = field(default_factory=list)
    pillars: list[tuple[Point, float]] = field(default_factory=list)
    things: list[Thing] = field(default_factory=list)

    def box(self, centre: Point, length: float, width: float, angle: float = 0.0) -> None:
        """Add a rectangle by its centre, its sides and the angle of its length."""
        c, s = math.cos(angle), math.sin(angle)
        half = ((-length, -width), (length, -width), (length, width), (-length, width))
        self.shapes.append(
            np.array([(centre[0] + (c * u - s * v) / 2, centre[1] + (s * u + c * v) / 2) for u, v in half])
        )

    def slab(self, p: Point, q: Point, thickness: float, outward: Point) -> None:
        """Add a plate from `p` to `q` that lies behind that line, on the side that `outward` points away from."""
        back = (-thickness * outward[0], -thickness * outward[1])
        ring = [p, q, (q[0] + back[0], q[1] + back[1]), (p[0] + back[0], p[1] + back[1])]
        area = sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(ring, ring[1:] + ring[:1], strict=True))
        self.shapes.append(np.array(ring if area > 0 else ring[::-1]))


@dataclass(frozen=True)
class Network:
    """The corridors' graph: nodes, and roads as pairs of node numbers. A road is straight."""

    nodes: list[Node]
    roads: list[tuple[int, int]]

    def length(self, road: tuple[int, int]) -> float:
        """Metres from one end of a road to the other."""
        return math.dist(self.nodes[road[0]].at, self.nodes[road[1]].at)


def network(corridors: list[Corridor]) -> Network:
    """Cross all centre lines; what leaves a crossing beyond its own square, or leads to another, is an arm of it."""
    places: list[Point] = []
    stops: list[dict[int, float]] = [{} for _ in corridors]  # corridor -> {node: metres along it}
    members: list[list[int]] = []

    def visit(at: Point, mine: tuple[int, ...]) -> None:
        node = next((k for k, p in enumerate(places) if math.dist(p, at) < _APART), len(places))
        if node == len(places):
            places.append(at)
            members.append([])
        for k in mine:
            stops[k][node] = math.dist(corridors[k].a, at)
            if k not in members[node]:
                members[node].append(k)

    for i, first in enumerate(corridors):
        for j in range(i):
            at = _crossing(first, corridors[j])
            if at is not None:
                visit(at, (i, j))
    for k, corridor in enumerate(corridors):
        for end in (corridor.a, corridor.b):
            # Where another begins in line, as a short passage from an aisle's end, the two would else not be joined.
            on = any(math.dist(end, other) < _APART for c in corridors if c is not corridor for other in (c.a, c.b))
            if on or all(math.dist(places[n], end) > _reach(corridors, members[n], k) for n in stops[k]):
                visit(end, (k,))

    nodes = []
    for at, mine in zip(places, members, strict=True):
        arms = []
        for k in mine:
            for end in (corridors[k].a, corridors[k].b):
                far = math.dist(at, end)
                if far > (_reach(corridors, mine, k) if len(mine) > 1 else 0.1) or (
                    far > _APART and any(len(members[n]) > 1 and math.dist(places[n], end) < _APART for n in stops[k])
                ):
                    arms.append(((end[0] - at[0]) / far, (end[1] - at[1]) / far))
        nodes.append(Node(at, tuple(arms), max(corridors[k].width for k in mine)))
    roads: list[tuple[int, int]] = []
    for here in stops:
        order = sorted(here, key=lambda n: here[n])
        roads += itertools.pairwise(order)
    return Network(nodes, roads)


def _reach(corridors: list[Corridor], mine: list[int], own: int) -> float:
    """From a crossing's centre, the length beyond which corridor `own` is an arm and not just the crossing's edge."""
    return max((corridors[k].width / 2 for k in mine if k != own), default=0.0) + _ARM


def _crossing(one: Corridor, other: Corridor) -> Point | None:
    """Where two centre lines meet, half a metre of slack at their ends; None for parallels."""
    ux, uy = one.b[0] - one.a[0], one.b[1] - one.a[1]
    vx, vy = other.b[0] - other.a[0], other.b[1] - other.a[1]
    wx, wy = other.a[0] - one.a[0], other.a[1] - one.a[1]
    cross = ux * vy - uy * vx
    lu, lv = math.hypot(ux, uy), math.hypot(vx, vy)
    if abs(cross) < 0.05 * lu * lv:
        return None
    s, t = (wx * vy - wy * vx) / cross, (wx * uy - wy * ux) / cross
    if not (-0.5 <= s * lu <= lu + 0.5 and -0.5 <= t * lv <= lv + 0.5):
        return None
    return one.a[0] + s * ux, one.a[1] + s * uy


def inset(ring: list[Point], by: float) -> list[Point]:
    """A rectilinear outline, counter-clockwise, made smaller all round (larger where `by` is negative)."""
    result = []
    for before, at, after in zip(ring[-1:] + ring[:-1], ring, ring[1:] + ring[:1], strict=True):
        (ax, ay), (bx, by_) = unit(before, at), unit(at, after)
        result.append((at[0] - by * (ay + by_), at[1] + by * (ax + bx)))
    return result


def unit(p: Point, q: Point) -> Point:
    """The unit vector from one point to another."""
    length = math.dist(p, q)
    return (q[0] - p[0]) / length, (q[1] - p[1]) / length
