"""How well a survey agrees with a truth on racks, and on what recurs: pillars, and the pitch of racks."""

from __future__ import annotations

from typing import Any

import numpy as np

from groundplan.evaluate._scores import Floats, bearing, matches, optional, points, turn

_SAME_PLACE = 0.5  # metres between a pillar and the true one
_SAME_AXIS = 0.17  # radians between a rack and the true one
_BESIDE = 0.8  # metres between their centre lines
_RIGHT = 0.05  # metres that a pitch may be off
_OVERLAP = 0.5  # least intersection over union of a rack and the true one


def pattern_scores(survey: dict[str, Any], truth: dict[str, Any]) -> dict[str, Any]:
    """F1 of pillars; share of the racks whose pitch is right to 5 cm, and the median error of those that have one.

    A pillar that was not observed counts neither way, nor does a rack that is none. None where there is nothing to ask.
    """
    pillars = truth.get("pillars", [])
    asked = points([pillar["at"] for pillar in pillars if pillar["observed"]])
    unseen = points([pillar["at"] for pillar in pillars if not pillar["observed"]])
    given = points([label["at"] for label in survey["labels"] if label["kind"] == "pillar"])
    given = given[(_apart(given, unseen) > _SAME_PLACE).all(axis=1)]
    total = len(asked) + len(given)
    apart = _apart(asked, given)
    f1 = round(2 * matches(apart, apart <= _SAME_PLACE) / total, 4) if total else None
    errors, racks = [], 0
    for label in survey["labels"]:
        true = true_rack(label, truth.get("racks", [])) if label["kind"] == "rack" else None
        if true is not None:
            racks += 1
            if label.get("pitch") is not None:
                errors.append(abs(label["pitch"] - true["pitch"]))
    return {
        "pillar_f1": f1 if "pillars" in truth else None,
        "pitch_recall": round(sum(error <= _RIGHT for error in errors) / racks, 4) if racks else None,
        "pitch_error_m": round(float(np.median(errors)), 4) if errors else None,
    }


def rack_scores(survey: dict[str, Any], truth: dict[str, Any]) -> dict[str, Any]:
    """Recall and precision of racks, matched one to one where their outlines have an IoU of 0.5 at least.

    Racks that were not observed count neither way, nor does what overlaps them so. None where there is nothing to ask.
    """
    if "racks" not in truth:
        return {"rack_recall": None, "rack_precision": None}
    geometry = optional("shapely.geometry")
    asked, unseen = ([r for r in truth["racks"] if r["observed"] is seen] for seen in (True, False))
    given = [label for label in survey["labels"] if label["kind"] == "rack"]

    def overlaps(racks: list[dict[str, Any]]) -> Floats:
        true = [
            geometry.LineString([rack["a"], rack["b"]]).buffer(rack["width"] / 2, cap_style="flat") for rack in racks
        ]
        mine = [geometry.Polygon(label["polygon"]).buffer(0) for label in given]
        shares = [[a.intersection(b).area / a.union(b).area for b in mine] for a in true]
        return np.array(shares, dtype=float).reshape(len(true), len(mine))

    hidden = (overlaps(unseen) >= _OVERLAP).any(axis=0)
    overlap = overlaps(asked)[:, ~hidden]
    right = matches(1.0 - overlap, overlap >= _OVERLAP) if overlap.size else 0
    count = int((~hidden).sum())
    return {
        "rack_recall": round(right / len(asked), 4) if asked else None,
        "rack_precision": round(right / count, 4) if count else None,
    }


def _apart(a: Floats, b: Floats) -> Floats:
    apart: Floats = np.linalg.norm(a[:, None] - b[None], axis=2)
    return apart


def true_rack(label: dict[str, Any], racks: list[dict[str, Any]]) -> dict[str, Any] | None:
    """The true rack that holds the middle of a label's centre line and runs along it."""
    p, q = np.array(label["axis"][0]), np.array(label["axis"][-1])
    middle = (p + q) / 2
    for rack in racks:
        a, b = np.array(rack["a"]), np.array(rack["b"])
        length = float(np.linalg.norm(b - a))
        along = (b - a) / length
        off = middle - a
        beside = abs(along[0] * off[1] - along[1] * off[0])
        if 0 <= off @ along <= length and beside < _BESIDE and turn(bearing(p, q), bearing(a, b)) < _SAME_AXIS:
            return rack
    return None
