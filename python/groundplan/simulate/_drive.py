"""Where the robot drives."""

from __future__ import annotations

import heapq
import itertools
import math

import numpy as np

from groundplan.simulate._lidar import Pose
from groundplan.simulate._plan import Network, Point
from groundplan.simulate._raster import World

Road = tuple[int, int]

_WEAVE = 0.12  # metres that the robot sways off a corridor's centre line
_SHY = 1.2  # metres that it keeps from the wall at a dead end


def explored(net: Network, partial: float, random: np.random.Generator) -> tuple[list[Road], list[tuple[Road, float]]]:
    """Choose the roads that are driven: all but the share `partial` of their length.

    About half of what is left out lies together, far from the start, the rest is single roads; what is driven stays
    in one piece. Some of the roads left out are driven a little way in from a driven end: the second list, with the
    share of each (negative: from the road's second end).
    """
    driven = list(net.roads)
    wanted = partial * sum(net.length(r) for r in driven)
    corner = net.nodes[int(random.integers(len(net.nodes)))].at
    middle = {r: _middle(net, r) for r in driven}
    together = sorted(driven, key=lambda r: math.dist(middle[r], corner))
    single = [driven[k] for k in random.permutation(len(driven))]
    left, dropped = 0.0, []
    for order, goal in ((together, 0.55 * wanted), (single, wanted)):
        for road in order:
            if left + 0.5 * net.length(road) > goal:
                if order is together:
                    break
                continue
            rest = [r for r in driven if r != road]
            if road in driven and connected(rest):
                driven = rest
                dropped.append(road)
                left += net.length(road)
    reached = {n for r in driven for n in r}
    looks = []
    for road in dropped:
        share = float(random.uniform(0.2, 0.5))
        if random.random() < 0.35 and (road[0] in reached or road[1] in reached):
            looks.append((road, share if road[0] in reached else -share))
    return driven, looks


def _middle(net: Network, road: Road) -> Point:
    (ax, ay), (bx, by) = net.nodes[road[0]].at, net.nodes[road[1]].at
    return (ax + bx) / 2, (ay + by) / 2


def connected(roads: list[Road]) -> bool:
    """Is there a way between any two of the roads?"""
    if not roads:
        return False
    seen, todo = {roads[0][0]}, [roads[0][0]]
    while todo:
        here = todo.pop()
        for a, b in roads:
            for one, other in ((a, b), (b, a)):
                if one == here and other not in seen:
                    seen.add(other)
                    todo.append(other)
    return all(a in seen for a, _ in roads)


def route(net: Network, roads: list[Road], looks: list[tuple[Road, float]]) -> list[Point]:
    """A drive over every road once at least, as a polyline: always on to the nearest road not yet driven."""
    todo = {frozenset(r) for r in roads}
    glances: dict[int, list[Point]] = {}
    for (a, b), share in looks:
        here, there = (a, b) if share > 0 else (b, a)
        (ax, ay), (bx, by) = net.nodes[here].at, net.nodes[there].at
        glances.setdefault(here, []).append((ax + abs(share) * (bx - ax), ay + abs(share) * (by - ay)))
    near: dict[int, list[int]] = {}
    for a, b in roads:
        near.setdefault(a, []).append(b)
        near.setdefault(b, []).append(a)
    here = roads[0][0]
    path = [here]
    while todo:
        way = _nearest(net, near, todo, here)
        for a, b in zip([here, *way], way, strict=False):
            todo.discard(frozenset((a, b)))
        path += way
        here = way[-1]
    points: list[Point] = []
    for n in path:
        points.append(_stand(net, n))
        for glance in glances.pop(n, []):
            points += [glance, _stand(net, n)]
    return points


def _nearest(net: Network, near: dict[int, list[int]], todo: set[frozenset[int]], start: int) -> list[int]:
    """The nodes from `start` to the far end of the nearest road to be driven (Dijkstra)."""
    heap: list[tuple[float, int, list[int]]] = [(0.0, start, [])]
    done: set[int] = set()
    while heap:
        cost, here, way = heapq.heappop(heap)
        if way and frozenset((way[-2] if len(way) > 1 else start, here)) in todo:
            return way
        if here in done:
            continue
        done.add(here)
        for there in near[here]:
            if there not in done or frozenset((here, there)) in todo:
                heapq.heappush(heap, (cost + net.length((here, there)), there, [*way, there]))
    raise AssertionError("the roads are in one piece")


def _stand(net: Network, n: int) -> Point:
    """Where the robot turns at a node: its centre, or a little before a dead end."""
    node = net.nodes[n]
    if node.kind != "end":
        return node.at
    (ux, uy), (x, y) = node.arms[0], node.at
    return x + _SHY * ux, y + _SHY * uy


def scan_poses(
    points: list[Point], every: float, world: World, random: np.random.Generator
) -> list[tuple[Pose, float]]:
    """True poses along the route, `every` metres, with the length driven so far; none where something stands."""
    poses, driven, due = [], 0.0, 0.0
    phase = float(random.uniform(0, 2 * math.pi))
    for (ax, ay), (bx, by) in itertools.pairwise(points):
        length = math.dist((ax, ay), (bx, by))
        if length < 1e-9:
            continue
        ux, uy = (bx - ax) / length, (by - ay) / length
        while due < length:
            sway = _WEAVE * math.sin((driven + due) / 1.9 + phase)
            x, y = ax + due * ux - sway * uy, ay + due * uy + sway * ux
            heading = math.atan2(uy, ux) + _WEAVE / 1.9 * math.cos((driven + due) / 1.9 + phase)
            if not world.taken(x, y):
                poses.append((Pose(x, y, heading), driven + due))
            due += every
        due -= length
        driven += length
    return poses
