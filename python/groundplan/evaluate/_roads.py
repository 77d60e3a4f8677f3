"""Scores of a road map against the aisles of a truth, and against the pixels of the map.

The road map is the file that a vehicle's planner loads: nodes and edges, and nothing of what drew them.
"""

from __future__ import annotations

import itertools
import json
import math
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from groundplan._errors import FormatError
from groundplan._files import unreadable
from groundplan.evaluate._scores import optional
from groundplan.maps import Map
from groundplan.maps._map import OCCUPIED

Points = npt.NDArray[np.float64]
Edges = set[tuple[int, int]]

#: A lane is an aisle's when it runs within this of its centre line, metres, and of its direction.
BESIDE_M, ALONG_RAD = 0.75, math.radians(10)
#: A spur is square to its aisle to this.
SQUARE_RAD = math.radians(20)
#: A corridor of the truth leads to a junction of it when its centre line passes within this, metres.
AT_JUNCTION_M = 0.75
#: Places of the truth that are nearer than this are one, metres.
SAME_M = 1.5
#: A bay's face opens on an aisle when this near to its side, metres.
AT_SIDE_M = 0.5
STEP_M = 0.05


def read_route(path: str | os.PathLike[str]) -> tuple[Points, Edges]:
    """Nodes (N, 2), metres, and edges as pairs of nodes, their way aside, of a route graph in Nav2's GeoJSON.

    Raises
    ------
    FormatError
        ``route.read`` for a file that cannot be read, ``route.format`` for what is no route graph.
    """
    try:
        features = json.loads(Path(path).read_text(encoding="utf-8"))["features"]
        points = [f for f in features if f["geometry"]["type"] == "Point"]
        number = {f["properties"]["id"]: n for n, f in enumerate(points)}
        nodes = np.array([f["geometry"]["coordinates"][:2] for f in points], dtype=float).reshape(-1, 2)
        ends = [f["properties"] for f in features if f["geometry"]["type"] != "Point"]
        pairs = [(number[end["startid"]], number[end["endid"]]) for end in ends]
    except OSError as fault:
        raise unreadable("route.read", path, fault) from fault
    except (ValueError, KeyError, TypeError) as fault:
        raise FormatError("route.format", f"{os.fspath(path)} is no route graph: {fault}") from fault
    return nodes, {(min(pair), max(pair)) for pair in pairs if pair[0] != pair[1]}


def road_scores(nodes: Points, edges: Edges, truth: Mapping[str, Any], map: Map) -> dict[str, Any]:
    """How a road map agrees with a truth.

    Parameters
    ----------
    nodes, edges
        As `read_route` gives them.
    truth
        ``corridors`` {a, b, width}, ``junctions`` {at, observed}, ``ends`` {at} and ``racks`` {a, b, width, pitch,
        observed}, metres in the map frame.
    map
        What was surveyed.

    Returns
    -------
    dict
        joins_missing
            Pairs of aisles that meet at an observed junction of the truth, and are not joined by the road map.
        joins_extra
            Pairs of aisles that the road map joins at one node, or by edges that follow no aisle, and that meet at no
            junction of the truth.
        lane_elsewhere_m
            Metres of edges that follow no aisle of the truth, and are no spurs square to one within it.
        lane_error_m
            How far an edge is off the centre line of the aisle that it follows, at most.
        lane_clearance_m
            From edges to the nearest occupied pixel's farthest corner, at least.
        node_ratio
            Nodes, over observed junctions, ends, loose ends of aisles and pick faces together.
    """
    aisles = [_Aisle(corridor) for corridor in truth["corridors"]]
    followed, off, elsewhere = {}, [0.0], 0.0
    for edge in sorted(edges):
        walk = _walk(nodes, edge)
        followed[edge], error, strange = _follows(walk, aisles)
        off.append(error)
        elsewhere += strange * float(np.linalg.norm(walk[-1] - walk[0]))
    meet, may_meet = _meetings(truth["junctions"], aisles)
    joined = _joined(len(nodes), followed)
    return {
        "joins_missing": len(meet - joined),
        "joins_extra": len(joined - may_meet),
        "lane_elsewhere_m": round(elsewhere, 3),
        "lane_error_m": round(max(off), 4),
        "lane_clearance_m": _clearance(nodes, edges, map),
        "node_ratio": round(len(nodes) / max(1, _places(truth, aisles) + _faces(truth.get("racks", ()), aisles)), 4),
    }


class _Aisle:
    """A corridor of the truth: where points lie along it and to its left."""

    def __init__(self, corridor: Mapping[str, Any]) -> None:
        self.a, self.b = (np.array(corridor[end], dtype=float) for end in "ab")
        self.length, self.width = float(np.linalg.norm(self.b - self.a)), float(corridor["width"])
        self.along = (self.b - self.a) / self.length

    def place_of(self, points: Points) -> tuple[Points, Points]:
        off = points - self.a
        return off @ self.along, off @ np.array([-self.along[1], self.along[0]])

    def sine(self, heading: Points) -> float:
        """Of the angle to a heading."""
        cross = heading[0] * self.along[1] - heading[1] * self.along[0]
        return abs(float(cross)) / max(float(np.linalg.norm(heading)), 1e-9)

    def distance(self, at: Points) -> float:
        share = np.clip((at - self.a) @ self.along, 0.0, self.length)
        return float(np.linalg.norm(at - self.a - share * self.along))


def _walk(nodes: Points, edge: tuple[int, int]) -> Points:
    """Points along an edge, a pixel apart."""
    a, b = nodes[edge[0]], nodes[edge[1]]
    steps = np.linspace(0.0, 1.0, max(2, math.ceil(float(np.linalg.norm(b - a)) / STEP_M) + 1))
    points: Points = a + steps[:, None] * (b - a)
    return points


def _follows(walk: Points, aisles: list[_Aisle]) -> tuple[set[int], float, float]:
    """The aisles that an edge follows, how far it is off them at most, and the share of it that is nothing's."""
    heading = walk[-1] - walk[0]
    error, follows, covered = 0.0, set(), np.zeros(len(walk), dtype=bool)
    for number, aisle in enumerate(aisles):
        sine = aisle.sine(heading)
        s, d = aisle.place_of(walk)
        near = (s > -SAME_M) & (s < aisle.length + SAME_M)
        if sine >= math.cos(SQUARE_RAD):
            covered |= near & (np.abs(d) < aisle.width / 2 + AT_SIDE_M)
        if sine > math.sin(ALONG_RAD):
            continue
        beside = near & (np.abs(d) < BESIDE_M)
        within = beside & (s > 0) & (s < aisle.length)
        if within.mean() > 0.3 or within.sum() * STEP_M > 2.0:
            follows.add(number)
            error = max(error, float(np.abs(d[within]).max()))
        covered |= beside
    return follows, error, float(1 - covered.mean())


def _meetings(junctions: Iterable[Mapping[str, Any]], aisles: list[_Aisle]) -> tuple[Edges, Edges]:
    """Pairs of aisles that meet where it was observed, and those that meet anywhere."""
    seen: Edges = set()
    all: Edges = set()
    for junction in junctions:
        at = np.array(junction["at"], dtype=float)
        there = [n for n, aisle in enumerate(aisles) if aisle.distance(at) < AT_JUNCTION_M]
        pairs = set(itertools.combinations(there, 2))
        all |= pairs
        seen |= pairs if junction["observed"] else set()
    return seen, all


def _joined(count: int, followed: Mapping[tuple[int, int], set[int]]) -> Edges:
    """Pairs of aisles that come together at a node, or at nodes joined by edges that follow none."""
    group = list(range(count))

    def head(node: int) -> int:
        while group[node] != node:
            node = group[node]
        return node

    for (a, b), follows in followed.items():
        if not follows:
            group[head(a)] = head(b)
    aisles: dict[int, set[int]] = {}
    for edge, follows in followed.items():
        for node in edge:
            aisles.setdefault(head(node), set()).update(follows)
    return {pair for there in aisles.values() for pair in itertools.combinations(sorted(there), 2)}


def _clearance(nodes: Points, edges: Edges, map: Map) -> float | None:
    """The least distance of an edge from an occupied pixel, metres; None without edges."""
    if not edges:
        return None
    taken = map.states[map.pixels] == OCCUPIED
    if not taken.any():
        return None
    tree = optional("scipy.spatial").cKDTree(_middles(map, taken))
    found, _ = tree.query(np.concatenate([_walk(nodes, edge) for edge in sorted(edges)]))
    # Whichever of its corners is the nearest, the pixel is no nearer than this.
    return round(float(found.min()) - map.resolution / math.sqrt(2), 4)


def _middles(map: Map, taken: npt.NDArray[np.bool_]) -> Points:
    rows, columns = np.nonzero(taken)
    x, y, yaw = map.origin
    u, v = (columns + 0.5) * map.resolution, (map.height - 0.5 - rows) * map.resolution
    cos, sin = math.cos(yaw), math.sin(yaw)
    middles: Points = np.column_stack([x + u * cos - v * sin, y + u * sin + v * cos])
    return middles


def _places(truth: Mapping[str, Any], aisles: list[_Aisle]) -> int:
    """Observed junctions, ends, and ends of aisles that are at neither: where the robot saw no farther."""
    known = [np.array(p["at"], dtype=float) for key in ("junctions", "ends") for p in truth.get(key, ())]
    loose: list[Points] = []
    for end in (end for aisle in aisles for end in (aisle.a, aisle.b)):
        if not any(np.linalg.norm(end - place) < SAME_M for place in (*known, *loose)):
            loose.append(end)
    observed = [p for key in ("junctions", "ends") for p in truth.get(key, ()) if p.get("observed", True)]
    return len(observed) + len(loose)


def _faces(racks: Iterable[Mapping[str, Any]], aisles: list[_Aisle]) -> int:
    """Pick faces: the sides of racks' bays that open on an aisle."""
    count = 0
    for rack in racks:
        a, b = (np.array(rack[end], dtype=float) for end in "ab")
        length = float(np.linalg.norm(b - a))
        if not rack.get("observed", True) or not length:
            continue
        bays = max(1, round(length / rack["pitch"]))
        along = (b - a) / length
        middles = a + ((np.arange(bays) + 0.5) * length / bays)[:, None] * along
        for side in (0.5, -0.5):
            face = middles + side * rack["width"] * np.array([-along[1], along[0]])
            count += int(np.any([_opens(face, along, aisle) for aisle in aisles], axis=0).sum())
    return count


def _opens(face: Points, along: Points, aisle: _Aisle) -> npt.NDArray[np.bool_]:
    """Which faces lie along an aisle, at its side."""
    s, d = aisle.place_of(face)
    beside = (np.abs(np.abs(d) - aisle.width / 2) < AT_SIDE_M) & (s > 0) & (s < aisle.length)
    return beside & (aisle.sine(along) < math.sin(ALONG_RAD))
