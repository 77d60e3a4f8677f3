"""Lanes through open space: from the end of an aisle to the next lane that can be seen from it.

Aisles often end in a hall that is too wide to be a corridor; what lies in one region is joined there, by as little as
will do.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import networkx

from groundplan.roadmap._doors import TURN_M, Regions
from groundplan.roadmap._lanes import Way
from groundplan.roadmap._model import Lane, Node, Point

#: A link from an aisle's end is worth having where the way round is so many times as long.
SPARED = 3.0
#: An aisle that ends in the open goes on so far beyond its racks that a lane across it clears them, metres.
BEYOND_M = 1.0


@dataclass(frozen=True)
class Link:
    """From a corridor's first or last stop to a place on another's lane, straight or with one turn."""

    stop: int
    corridor: int
    along: float
    turn: Point | None
    half: float


class Net:
    """Lanes as a graph that grows, for asking how far it is from one place to another along them."""

    def __init__(self, nodes: list[Node], lanes: list[Lane], ways: dict[int, Way]) -> None:
        self.graph: networkx.Graph[Any] = networkx.Graph()
        self.ways = ways
        for lane in lanes:
            self.graph.add_edge(lane.start, lane.end, length=math.dist(nodes[lane.start].at, nodes[lane.end].at))
        for way in ways.values():
            self.graph.add_nodes_from(stop for _, stop in way.stops)
            for (here, a), (there, b) in itertools.pairwise(way.stops):
                self.graph.add_edge(a, b, length=there - here)

    def nearer(self, stop: int, corridor: int, along: float, length: float) -> bool:
        """Whether lanes lead from a stop to a place on a corridor within a length."""
        reached = networkx.single_source_dijkstra_path_length(self.graph, stop, cutoff=length, weight="length")
        stops = self.ways[corridor].stops
        return any(reached[node] + abs(place - along) <= length for place, node in stops if node in reached)

    def reached(self, stop: int, corridor: int) -> bool:
        """Whether lanes lead from a stop to a corridor."""
        return bool(networkx.has_path(self.graph, stop, self.ways[corridor].stops[0][1]))

    def link(self, stop: int, corridor: int, along: float, length: float) -> None:
        """Add a link."""
        place = (corridor, along)
        self.graph.add_edge(stop, place, length=length)
        for other, node in self.ways[corridor].stops:
            self.graph.add_edge(place, node, length=abs(other - along))


def links(regions: Regions, ways: dict[int, Way], nodes: list[Node], net: Net, angle: float) -> Iterator[Link]:
    """The shortest links that join what lies apart in a region, and those that spare an aisle's end a long way round.

    Turns are square to `angle`.
    """
    for region, corridors in regions.within.items():
        options: list[tuple[float, int, int, float, Point | None, list[Point]]] = []
        for corridor, other in itertools.permutations(corridors, 2):
            if not (ways[corridor].stops and ways[other].stops):
                continue
            for along, stop in sorted({ways[corridor].stops[0], ways[corridor].stops[-1]}):
                at = ways[corridor].point(along)
                if regions.outside(region, at):
                    continue
                for target in _targets(ways[other], at):
                    to = ways[other].point(target)
                    for turn in (None, *_corners(at, to, angle)):
                        points = [at, *([] if turn is None else [turn]), to]
                        length = math.fsum(itertools.starmap(math.dist, itertools.pairwise(points)))
                        cost = length + (0.0 if turn is None else TURN_M)
                        options.append((cost, stop, other, target, turn, points))
        options.sort(key=lambda option: option[:4])
        for length, stop, other, target, turn, points in options:
            spares = turn is None and nodes[stop].kind == "end" and not net.nearer(stop, other, target, SPARED * length)
            if (spares or not net.reached(stop, other)) and regions.open(region, points):
                net.link(stop, other, target, length)
                yield Link(stop, other, target, turn, regions.beside(region, points))


def goes_on(regions: Regions, way: Way, far: bool) -> float | None:
    """How far along, from its start, a corridor leads out into the open at one of its ends; None where it does not."""
    ahead = way.length + BEYOND_M if far else -BEYOND_M
    points = [way.point(way.length if far else 0.0), way.point(ahead)]
    return ahead if any(regions.open(region, points) for region in regions.within) else None


def _targets(way: Way, seen: Point) -> Iterator[float]:
    along, _ = way.place_of(seen)
    if way.lies_on_a_lane(along):
        yield along
    yield way.stops[0][0]
    yield way.stops[-1][0]


def _corners(a: Point, b: Point, angle: float) -> list[Point]:
    """The two corners of ways that are square to an angle; none where one way is straight."""
    cos, sin = math.cos(angle), math.sin(angle)
    dx, dy = b[0] - a[0], b[1] - a[1]
    u, v = dx * cos + dy * sin, dy * cos - dx * sin
    if min(abs(u), abs(v)) < 0.5:
        return []
    return [(a[0] + u * cos, a[1] + u * sin), (a[0] - v * sin, a[1] + v * cos)]
