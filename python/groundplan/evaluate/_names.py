"""Whether names hold: the labels of one place surveyed twice, paired by where they lie in the ground plan."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from groundplan.evaluate._scores import optional

#: What has a name, and the score of it.
NAMED = {"corridor": "aisles", "region": "regions", "rack": "racks", "pillar": "pillars"}
_SAME = 0.4  # least intersection over union of what is the same label
_NEAR = 0.5  # metres between two pillars that are the same


def name_scores(
    first: dict[str, Any], truth: dict[str, Any], others: list[tuple[dict[str, Any], Any]]
) -> dict[str, Any]:
    """How many labels of a survey have the same name in the surveys of other maps of the same place.

    Parameters
    ----------
    first, truth
        A survey, and the truth of its map, whose ``frame`` is the ground plan's pose in it.
    others
        Other surveys of the place with theirs.

    Returns
    -------
    dict
        For each kind ``names_<kind>``, the share of the first survey's labels that every other one has at the same
        place by the same name, over all others; ``found_<kind>``, the same by whatever name; None without any.
    """
    result: dict[str, Any] = {}
    for kind, key in NAMED.items():
        own = _placed(first, truth, kind)
        kept = met = 0
        for survey, its_truth in others:
            for a, b in _pairs(own, _placed(survey, its_truth, kind), kind):
                met += 1
                kept += own[a][0] == _placed_name(survey, kind, b)
        asked = len(own) * len(others)
        result[f"names_{key}"] = round(kept / asked, 4) if asked else None
        result[f"found_{key}"] = round(met / asked, 4) if asked else None
    return result


def _placed_name(survey: dict[str, Any], kind: str, index: int) -> str:
    return str([label for label in survey["labels"] if label["kind"] == kind][index]["name"])


def _placed(survey: dict[str, Any], truth: dict[str, Any], kind: str) -> list[tuple[str, Any]]:
    """(name, geometry in the ground plan) of the labels of one kind."""
    geometry = optional("shapely.geometry")
    x0, y0, yaw = truth["frame"]
    turn = np.array([[math.cos(yaw), -math.sin(yaw)], [math.sin(yaw), math.cos(yaw)]])

    def back(points: Any) -> Any:
        return (np.array(points, dtype=float).reshape(-1, 2) - (x0, y0)) @ turn

    placed = []
    for label in survey["labels"]:
        if label["kind"] != kind:
            continue
        if "polygon" in label:
            shape = geometry.Polygon(back(label["polygon"]), [back(hole) for hole in label.get("holes", [])]).buffer(0)
        else:
            shape = geometry.Point(back(label["at"])[0]).buffer(_NEAR)
        placed.append((label["name"], shape))
    return placed


def _pairs(own: list[tuple[str, Any]], other: list[tuple[str, Any]], kind: str) -> list[tuple[int, int]]:
    """The best one-to-one pairing by intersection over union, of pairs that are the same at all."""
    if not own or not other:
        return []
    share = np.zeros((len(own), len(other)))
    tree = optional("shapely").STRtree([shape for _, shape in other])
    for a, (_, shape) in enumerate(own):
        for b in tree.query(shape):
            shared = shape.intersection(other[b][1]).area
            share[a, b] = shared / (shape.area + other[b][1].area - shared) if shared else 0.0
    least = 0.1 if kind == "pillar" else _SAME
    rows, columns = optional("scipy.optimize").linear_sum_assignment(-share)
    return [(a, b) for a, b in zip(rows.tolist(), columns.tolist(), strict=True) if share[a, b] >= least]
