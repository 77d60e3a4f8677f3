"""How well a survey agrees with a truth: directions, lines, junctions, corridors.

Each score is a function of its own. Lengths are metres, angles radians, points in the map frame.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from groundplan._extras import needed

Floats = npt.NDArray[np.float64]

_SAME_LINE = math.radians(3)  # a line of this bearing is of the true line's family ...
_ON_LINE = 0.20  # ... and follows it if both ends of the true line are this near
_SAME_AXIS = math.radians(10)
_SAME_PLACE = 1.5  # between a junction and the true one
_SQUARE = 2.6  # round a junction, where a corridor is not asked for
_STRIDE = 0.25  # between two looks along a true corridor
_LEEWAY = 0.4  # beside a true corridor's free width
_NO_MATCH = 1e6


def optional(module: str) -> Any:
    """A library that scoring needs."""
    return needed(module, "evaluate")


def turn(a: Any, b: Any) -> Any:
    """The angle between undirected directions `a` and `b`, in [0, pi/2]."""
    return abs((a - b + math.pi / 2) % math.pi - math.pi / 2)


def bearing(p: Sequence[float] | Floats, q: Sequence[float] | Floats) -> float:
    """Angle of the way from `p` to `q`."""
    return math.atan2(q[1] - p[1], q[0] - p[0])


def direction_scores(survey: dict[str, Any], truth: dict[str, Any]) -> dict[str, Any]:
    """Greatest error over the true directions, degrees (180 when none was found), and how many are too many."""
    found = np.array([d["angle"] for d in survey["directions"]])
    true = np.array(truth["directions"])
    worst = float(turn(true[:, None], found[None, :]).min(axis=1).max()) if found.size else math.pi
    return {
        "direction_error_deg": round(math.degrees(worst), 4),
        "direction_extra": max(0, found.size - true.size),
    }


def line_scores(survey: dict[str, Any], truth: dict[str, Any]) -> dict[str, Any]:
    """Share of the true lines' length that is followed, and the median distance of their midpoints to what does.

    A share of nothing is None: a truth without lines asks for none.
    """
    angles = np.array([survey["directions"][line["direction"]]["angle"] for line in survey["lines"]])
    offsets = np.array([line["offset"] for line in survey["lines"]])
    normals = np.stack([-np.sin(angles), np.cos(angles)], axis=1)
    followed, length, misses = 0.0, 0.0, []
    for line in truth["lines"]:
        p, q = np.array(line["p"], dtype=float), np.array(line["q"], dtype=float)
        extent = float(np.linalg.norm(q - p))
        length += extent
        if not angles.size:
            continue
        gap = np.maximum(np.abs(normals @ p - offsets), np.abs(normals @ q - offsets))
        gap[~(turn(bearing(p, q), angles) < _SAME_LINE)] = np.inf
        best = int(gap.argmin())
        if gap[best] <= _ON_LINE:
            followed += extent
            misses.append(abs(float(normals[best] @ (p + q)) / 2 - float(offsets[best])))
    return {
        "line_recall": round(followed / length, 4) if length else None,
        "line_error_m": round(float(np.median(misses)), 4) if misses else None,
    }


def junction_scores(survey: dict[str, Any], truth: dict[str, Any]) -> dict[str, Any]:
    """F1 of the best one-to-one matching of junctions, without and with their types.

    What lies at a junction that was not observed counts neither way, nor do types that the truth does not speak of.
    """
    asked = [j for j in truth["junctions"] if j.get("observed", True)]
    unseen = points([j["at"] for j in truth["junctions"] if not j.get("observed", True)])
    spoken = {"L", "T", "X"} | {j["type"] for j in asked}
    given = [
        label
        for label in survey["labels"]
        if label["kind"] == "junction"
        and label["type"] in spoken
        and not (np.linalg.norm(unseen - label["at"], axis=1) <= _SAME_PLACE).any()
    ]
    if not asked or not given:
        agreed = float(len(asked) == len(given))
        return {"junction_f1": agreed, "junction_typed_f1": agreed}
    apart = np.linalg.norm(points([j["at"] for j in asked])[:, None] - points([j["at"] for j in given])[None], axis=2)
    near = apart <= _SAME_PLACE
    alike = np.array([[a["type"] == g["type"] for g in given] for a in asked])
    total = len(asked) + len(given)
    return {
        "junction_f1": round(2 * matches(apart, near) / total, 4),
        "junction_typed_f1": round(2 * matches(apart, near & alike) / total, 4),
    }


def points(points: Sequence[Sequence[float]]) -> Floats:
    """Points as (n, 2)."""
    return np.array(points, dtype=float).reshape(-1, 2)


def matches(apart: Floats, allowed: npt.NDArray[np.bool_]) -> int:
    """Size of the one-to-one matching over allowed pairs that costs least."""
    return len(matched(apart, allowed))


def matched(apart: Floats, allowed: npt.NDArray[np.bool_]) -> list[tuple[int, int]]:
    """The pairs of that matching."""
    rows, columns = optional("scipy.optimize").linear_sum_assignment(np.where(allowed, apart, _NO_MATCH))
    return [(a, b) for a, b in zip(rows.tolist(), columns.tolist(), strict=True) if allowed[a, b]]


def corridor_scores(survey: dict[str, Any], truth: dict[str, Any]) -> dict[str, Any]:
    """Share of the true corridors' length that is labelled, and share of the labels' area that is true."""
    geometry, union = optional("shapely.geometry"), optional("shapely.ops").unary_union
    labels = [label for label in survey["labels"] if label["kind"] == "corridor"]
    areas = [geometry.Polygon(label["polygon"]).buffer(0) for label in labels]
    axes = np.array([bearing(label["axis"][0], label["axis"][-1]) for label in labels])
    bearings = np.array([bearing(c["a"], c["b"]) for c in truth["corridors"]])

    tree = optional("shapely").STRtree(areas)
    squares = union([geometry.Point(j["at"]).buffer(_SQUARE) for j in truth["junctions"]])
    looked = met = 0
    for corridor, angle in zip(truth["corridors"], bearings, strict=True):
        a, b = np.array(corridor["a"], dtype=float), np.array(corridor["b"], dtype=float)
        length = float(np.linalg.norm(b - a))
        for share in np.arange(_STRIDE, length, _STRIDE) / length:
            spot = geometry.Point(*(a + share * (b - a)))
            if squares.covers(spot):
                continue
            looked += 1
            met += any(areas[k].covers(spot) and turn(axes[k], angle) < _SAME_AXIS for k in tree.query(spot))

    shares = true_share(labels, truth)
    right = sum(share * area.area for share, area in zip(shares, areas, strict=True))
    whole = sum(area.area for area in areas)
    return {
        "corridor_recall": round(met / max(looked, 1), 4),
        "corridor_precision": round(right / whole, 4) if whole else 0.0,
    }


def true_share(labels: Sequence[dict[str, Any]], truth: dict[str, Any]) -> list[float]:
    """Of each corridor, the share of its area in true corridors along it."""
    geometry, union = optional("shapely.geometry"), optional("shapely.ops").unary_union
    bearings = [bearing(c["a"], c["b"]) for c in truth["corridors"]]
    strips = [
        geometry.LineString([c["a"], c["b"]]).buffer(c["width"] / 2 + _LEEWAY, cap_style="square")
        for c in truth["corridors"]
    ]
    shares = []
    for label in labels:
        area, axis = geometry.Polygon(label["polygon"]).buffer(0), bearing(label["axis"][0], label["axis"][-1])
        along = [strip for strip, angle in zip(strips, bearings, strict=True) if turn(angle, axis) < _SAME_AXIS]
        shares.append(area.intersection(union(along)).area / area.area if area.area else 0.0)
    return shares
