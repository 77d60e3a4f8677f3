"""Lanes through open space: from the end of an aisle straight on, or to the next lane that can be seen from it.

Aisles often end in a hall that is too wide to be a corridor; what lies apart in one region is joined there by as little
as will do, and along the hall's side runs a lane that spares an aisle's end a long way round.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import networkx

from groundplan.roadmap._doors import TURN_M, Regions
from groundplan.roadmap._lanes import ONE_NODE_M, Way, crossing
from groundplan.roadmap._model import Lane, Node, Point

#: An aisle that ends in the open goes on so far beyond its racks that a lane across it clears them, metres.
BEYOND_M = 1.0
#: A link along a hall's side is worth having where the way round is so many times as long.
SPARED = 3.0


@dataclass(frozen=True)
class Link:
    """From a corridor's first or last stop to a place on another's lane, straight or with one turn."""

    stop: int
    corridor: int
    along: float
    turn: Point | None
    half: float


class Net:
    """Lanes as a graph that grows, for asking whether and how far they lead from one place to another."""

    def __init__(
        self, nodes: list[Node], lanes: list[Lane], ways: dict[int, Way], leads: Callable[[Way, int, int], bool]
    ) -> None:
        self.graph: networkx.Graph[Any] = networkx.Graph()
        self.ways = ways
        for lane in lanes:
            self.graph.add_edge(lane.start, lane.end, length=math.dist(nodes[lane.start].at, nodes[lane.end].at))
        for way in ways.values():
            self.graph.add_nodes_from(stop for _, stop in way.stops)
            for (here, a), (there, b) in itertools.pairwise(way.stops):
                if leads(way, a, b):
                    self.graph.add_edge(a, b, length=there - here)

    def length(self, stop: int, corridor: int, along: float) -> float:
        """How far it is from a stop to about a place on a corridor; infinite without lanes."""
        place, node = self.ways[corridor].nearest(along)
        try:
            way: float = networkx.dijkstra_path_length(self.graph, stop, node, weight="length")
        except networkx.NetworkXNoPath:
            return math.inf
        return way + abs(place - along)

    def link(self, stop: int, corridor: int, along: float, length: float) -> None:
        """Add a link."""
        place, node = self.ways[corridor].nearest(along)
        self.graph.add_edge(stop, node, length=length + abs(place - along))


def straight_on(regions: Regions, ways: dict[int, Way], corridor: int, far: bool) -> tuple[int, float] | None:
    """The next lane that a corridor's own leads to when it goes straight on, and where on that; None without a way."""
    way = ways[corridor]
    last = way.stops[-1 if far else 0][0]
    found = []
    for other, lane in ways.items():
        if other == corridor or len(lane.stops) < 2:
            continue
        at = crossing(way, lane)
        if at is None:  # an aisle that goes on behind another one
            ends = (lane.point(lane.stops[side][0]) for side in (0, -1))
            at = min(ends, key=lambda end: math.dist(end, way.point(last)))
            if abs(way.place_of(at)[1]) > ONE_NODE_M:
                continue
        ahead = (way.place_of(at)[0] - last) * (1 if far else -1)
        along, _ = lane.place_of(at)
        if ahead > ONE_NODE_M and lane.stops[0][0] - ONE_NODE_M <= along <= lane.stops[-1][0] + ONE_NODE_M:
            found.append((ahead, other, along))
    if not found:
        return None
    _, other, along = min(found)
    return (other, along) if regions.leads(way.point(last), ways[other].point(along)) else None


def links(regions: Regions, ways: dict[int, Way], nodes: list[Node], net: Net, angle: float) -> Iterator[Link]:
    """The shortest links that join what lies apart in a region, and those along a hall's side that spare a long way.

    Turns are square to `angle`.
    """
    for region, corridors in regions.within.items():
        options: list[tuple[float, int, int, float, Point | None, list[Point], Point]] = []
        for corridor, other in itertools.permutations(corridors, 2):
            if not (ways[corridor].stops and ways[other].stops):
                continue
            for along, stop in sorted({ways[corridor].stops[0], ways[corridor].stops[-1]}):
                at, outwards = ways[corridor].point(along), ways[corridor].outwards(along)
                if regions.outside(region, at):
                    continue
                for target in ways[other].targets(at):
                    to = ways[other].point(target)
                    for turn in (None, *_corners(at, to, angle)):
                        points = [at, *([] if turn is None else [turn]), to]
                        length = math.fsum(itertools.starmap(math.dist, itertools.pairwise(points)))
                        cost = length + (0.0 if turn is None else TURN_M)
                        options.append((cost, stop, other, target, turn, points, outwards))
        options.sort(key=lambda option: option[:4])
        for cost, stop, other, target, turn, points, outwards in options:
            round = net.length(stop, other, target)
            if round > SPARED * cost and regions.open(region, points):
                depth = ways[other].width
                if round == math.inf or (turn is None and regions.is_hall(region, points, outwards, depth)):
                    net.link(stop, other, target, cost)
                    yield Link(stop, other, target, turn, regions.beside(region, points))


def goes_on(regions: Regions, way: Way, far: bool) -> float | None:
    """How far along, from its start, a corridor leads out into the open at one of its ends; None where it does not."""
    ahead = way.length + BEYOND_M if far else -BEYOND_M
    points = [way.point(way.length if far else 0.0), way.point(ahead)]
    return ahead if any(regions.open(region, points) for region in regions.within) else None


def _corners(a: Point, b: Point, angle: float) -> list[Point]:
    """The two corners of ways that are square to an angle; none where one way is straight."""
    cos, sin = math.cos(angle), math.sin(angle)
    dx, dy = b[0] - a[0], b[1] - a[1]
    u, v = dx * cos + dy * sin, dy * cos - dx * sin
    if min(abs(u), abs(v)) < 0.5:
        return []
    return [(a[0] + u * cos, a[1] + u * sin), (a[0] - v * sin, a[1] + v * cos)]
