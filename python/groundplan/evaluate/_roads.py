"""Scores of a road map against the aisles of a truth, and against the pixels of the map."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from groundplan.evaluate._scores import optional
from groundplan.maps import Map
from groundplan.maps._map import OCCUPIED
from groundplan.roadmap import Lane, RoadMap

Points = npt.NDArray[np.float64]

#: A lane is an aisle's when it runs within this of its centre line, metres, and of its direction.
BESIDE_M, ALONG_RAD = 0.75, math.radians(10)
#: A corridor of the truth leads to a junction of it when its centre line passes within this, metres.
AT_JUNCTION_M = 0.75
#: Places of the truth that are nearer than this are one, metres.
SAME_M = 1.5
STEP_M = 0.05


def road_scores(roads: RoadMap, truth: Mapping[str, Any], map: Map) -> dict[str, Any]:
    """How a road map agrees with a truth.

    Parameters
    ----------
    roads
        What is scored.
    truth
        ``corridors`` {a, b}, ``junctions`` {at, observed} and ``ends`` {at}, metres in the map frame.
    map
        What was surveyed.

    Returns
    -------
    dict
        joins_missing
            Pairs of aisles that meet at an observed junction of the truth, and are not joined by the road map.
        joins_extra
            Pairs of aisles that the road map joins at one node, or by lanes that follow no aisle, and that meet at no
            junction of the truth.
        lane_elsewhere_m
            Metres of lane on corridors that follow no aisle of the truth.
        lane_error_m
            How far a lane is off its aisle's centre line, at most.
        lane_clearance_m
            From lanes to the nearest occupied pixel, at least.
        node_ratio
            Nodes, over junctions, ends, loose ends of aisles and pick faces together.
    """
    aisles = [(np.array(c["a"], dtype=float), np.array(c["b"], dtype=float)) for c in truth["corridors"]]
    followed, off, elsewhere = {}, [0.0], 0.0
    for number, lane in enumerate(roads.lanes):
        if lane.kind == "aisle":
            walk = _walk(roads, lane)
            followed[number], error, strange = _follows(walk, aisles)
            off.append(error)
            elsewhere += strange * roads.length(lane)
    meet, may_meet = _meetings(truth["junctions"], aisles)
    joined = _joined(roads, followed)
    return {
        "joins_missing": len(meet - joined),
        "joins_extra": len(joined - may_meet),
        "lane_elsewhere_m": round(elsewhere, 3),
        "lane_error_m": round(max(off), 4),
        "lane_clearance_m": _clearance(roads, map),
        "node_ratio": round(len(roads.nodes) / max(1, _places(truth, aisles) + len(roads.faces)), 4),
    }


def _walk(roads: RoadMap, lane: Lane) -> Points:
    """Points along a lane, a pixel apart."""
    a, b = np.array(roads.nodes[lane.start].at), np.array(roads.nodes[lane.end].at)
    steps = np.linspace(0.0, 1.0, max(2, math.ceil(roads.length(lane) / STEP_M) + 1))
    points: Points = a + steps[:, None] * (b - a)
    return points


def _follows(walk: Points, aisles: list[tuple[Points, Points]]) -> tuple[set[int], float, float]:
    """The aisles that a lane follows, how far it is off them at most, and the share of it that follows none."""
    heading = walk[-1] - walk[0]
    error, follows, covered = 0.0, set(), np.zeros(len(walk), dtype=bool)
    for number, (a, b) in enumerate(aisles):
        length = float(np.linalg.norm(b - a))
        along = (b - a) / length
        turned = abs(heading[0] * along[1] - heading[1] * along[0])
        if turned > math.sin(ALONG_RAD) * np.linalg.norm(heading):
            continue
        s, d = (walk - a) @ along, np.abs((walk - a) @ np.array([-along[1], along[0]]))
        beside = (d < BESIDE_M) & (s > -SAME_M) & (s < length + SAME_M)
        within = beside & (s > 0) & (s < length)
        if within.mean() > 0.3 or within.sum() * STEP_M > 2.0:
            follows.add(number)
            error = max(error, float(d[within].max()))
        covered |= beside
    return follows, error, float(1 - covered.mean())


def _meetings(
    junctions: Iterable[Mapping[str, Any]], aisles: list[tuple[Points, Points]]
) -> tuple[set[tuple[int, int]], set[tuple[int, int]]]:
    """Pairs of aisles that meet where it was observed, and those that meet anywhere."""
    seen: set[tuple[int, int]] = set()
    all: set[tuple[int, int]] = set()
    for junction in junctions:
        at = np.array(junction["at"], dtype=float)
        there = [n for n, (a, b) in enumerate(aisles) if _distance(at, a, b) < AT_JUNCTION_M]
        pairs = set(itertools.combinations(there, 2))
        all |= pairs
        seen |= pairs if junction["observed"] else set()
    return seen, all


def _distance(at: Points, a: Points, b: Points) -> float:
    share = np.clip((at - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
    return float(np.linalg.norm(at - a - share * (b - a)))


def _joined(roads: RoadMap, followed: Mapping[int, set[int]]) -> set[tuple[int, int]]:
    """Pairs of aisles that come together at a node, or at nodes joined by lanes that follow none."""
    group = list(range(len(roads.nodes)))

    def head(node: int) -> int:
        while group[node] != node:
            node = group[node]
        return node

    for number, lane in enumerate(roads.lanes):
        if not followed.get(number):
            group[head(lane.start)] = head(lane.end)
    aisles: dict[int, set[int]] = {}
    for number, lane in enumerate(roads.lanes):
        for node in (lane.start, lane.end):
            aisles.setdefault(head(node), set()).update(followed.get(number, set()))
    return {pair for there in aisles.values() for pair in itertools.combinations(sorted(there), 2)}


def _clearance(roads: RoadMap, map: Map) -> float | None:
    """The least distance of a lane from the middle of an occupied pixel, metres; None without lanes."""
    if not roads.lanes:
        return None
    taken = map.states[map.pixels] == OCCUPIED
    if not taken.any():
        return None
    tree = optional("scipy.spatial").cKDTree(_middles(map, taken))
    found, _ = tree.query(np.concatenate([_walk(roads, lane) for lane in roads.lanes]))
    return round(float(found.min()), 4)


def _middles(map: Map, taken: npt.NDArray[np.bool_]) -> Points:
    rows, columns = np.nonzero(taken)
    x, y, yaw = map.origin
    u, v = (columns + 0.5) * map.resolution, (map.height - 0.5 - rows) * map.resolution
    cos, sin = math.cos(yaw), math.sin(yaw)
    middles: Points = np.column_stack([x + u * cos - v * sin, y + u * sin + v * cos])
    return middles


def _places(truth: Mapping[str, Any], aisles: list[tuple[Points, Points]]) -> int:
    """Junctions, ends, and ends of aisles that are at neither: where the robot saw no farther."""
    places = [np.array(p["at"], dtype=float) for key in ("junctions", "ends") for p in truth.get(key, ())]
    for end in (end for aisle in aisles for end in aisle):
        if not any(np.linalg.norm(end - place) < SAME_M for place in places):
            places.append(end)
    return len(places)
