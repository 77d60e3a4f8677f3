"""Whether confidence means something: of the labels of each confidence, how many are right."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from groundplan._results import KINDS
from groundplan.evaluate._patterns import true_rack
from groundplan.evaluate._scores import matched, optional, points

#: Upper ends of the bins.
BINS = (0.25, 0.5, 0.75, 0.9, 1.0)

_NEAR = {"junction": 1.5, "door": 0.6, "pillar": 0.5}  # metres between a label and the true one
_CORRIDOR = 0.7  # least share of a corridor's area in true ones along it
_REGION = 0.7  # least intersection over union of a region and a room

Judged = tuple[str, float, bool]


def judged(survey: dict[str, Any], truth: dict[str, Any]) -> list[Judged]:
    """(kind, confidence, whether it is right) of each label that the truth can judge."""
    found: list[Judged] = []
    for kind, judge in (("corridor", _corridors), ("junction", _junctions), ("rack", _racks), ("pillar", _pillars)):
        found += _each(kind, survey, truth, judge)
    if "rooms" in truth:
        found = [entry for entry in found if entry[0] == "pillar"]  # an office is not laid out by its corridors
        found += _each("region", survey, truth, _regions)
        found += _each("door", survey, truth, _doors)
    return found


def _each(kind: str, survey: dict[str, Any], truth: dict[str, Any], judge: Any) -> Iterator[Judged]:
    labels = [label for label in survey["labels"] if label["kind"] == kind]
    for label, right in zip(labels, judge(labels, truth), strict=True):
        if right is not None:
            yield kind, float(label["confidence"]), bool(right)


def _corridors(labels: list[dict[str, Any]], truth: dict[str, Any]) -> list[bool]:
    from groundplan.evaluate._scores import true_share

    return [share >= _CORRIDOR for share in true_share(labels, truth)]


def _junctions(labels: list[dict[str, Any]], truth: dict[str, Any]) -> list[bool | None]:
    asked = [j for j in (*truth["junctions"], *truth.get("ends", [])) if j.get("observed", True)]
    unseen = points([j["at"] for j in (*truth["junctions"], *truth.get("ends", [])) if not j.get("observed", True)])
    apart = _apart(asked, labels)
    alike = np.array([[a["type"] == g["type"] for g in labels] for a in asked]).reshape(len(asked), len(labels))
    right = {b for _, b in matched(apart, (apart <= _NEAR["junction"]) & alike)}
    hidden = (np.linalg.norm(points([g["at"] for g in labels])[:, None] - unseen[None], axis=2) <= 1.5).any(axis=1)
    return [True if n in right else None if hidden[n] else False for n in range(len(labels))]


def _racks(labels: list[dict[str, Any]], truth: dict[str, Any]) -> list[bool]:
    return [true_rack(label, truth.get("racks", [])) is not None for label in labels]


def _pillars(labels: list[dict[str, Any]], truth: dict[str, Any]) -> list[bool]:
    right = _apart(truth.get("pillars", []), labels) <= _NEAR["pillar"]
    return right.any(axis=0).tolist() if len(right) else [False] * len(labels)


def _doors(labels: list[dict[str, Any]], truth: dict[str, Any]) -> list[bool]:
    open_ones = [door for door in truth["doors"] if door["state"] != "closed"]
    apart = _apart(open_ones, labels)
    right = {b for _, b in matched(apart, apart <= _NEAR["door"])}
    return [n in right for n in range(len(labels))]


def _regions(labels: list[dict[str, Any]], truth: dict[str, Any]) -> list[bool]:
    geometry = optional("shapely.geometry")
    rooms = [geometry.Polygon(room["polygon"], room.get("holes")).buffer(0) for room in truth["rooms"]]
    right = []
    for label in labels:
        own = geometry.Polygon(label["polygon"], label.get("holes")).buffer(0)
        shares = [own.intersection(room).area / own.union(room).area for room in rooms if own.intersects(room)]
        right.append(max(shares, default=0.0) >= _REGION)
    return right


def _apart(asked: Sequence[dict[str, Any]], given: Sequence[dict[str, Any]]) -> Any:
    a, b = points([entry["at"] for entry in asked]), points([entry["at"] for entry in given])
    return np.linalg.norm(a[:, None] - b[None], axis=2)


def table(entries: list[Judged]) -> dict[str, list[dict[str, Any]]]:
    """For each kind and for all, by bin: its upper end, how many labels there are, and the share that is right."""
    result = {}
    for kind in (*KINDS, "all"):
        own = [(confidence, right) for k, confidence, right in entries if kind in (k, "all")]
        low, rows = -1.0, []
        for high in BINS:
            within = [right for confidence, right in own if low < confidence <= high]
            share = round(sum(within) / len(within), 4) if within else None
            rows.append({"to": high, "labels": len(within), "right": share})
            low = high
        result[kind] = rows
    return result
