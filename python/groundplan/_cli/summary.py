"""What a survey found, as a short table."""

from __future__ import annotations

import math
from collections import Counter
from itertools import pairwise
from typing import TYPE_CHECKING

from groundplan._cli import terminal

if TYPE_CHECKING:
    from groundplan.survey import Survey

#: How the types of junctions are called in a list.
_TYPES = {"end": ("dead end", "dead ends")}


def summary(survey: Survey) -> str:
    """The table."""
    rows = [*_map(survey), *_directions(survey), *_faces(survey), *_walls(survey), *_labels(survey)]
    codes = Counter(warning.code for warning in survey.warnings)
    rows.append(("warnings", ", ".join(codes) or "none"))
    return "\n".join(terminal.columns(rows)) + "\n"


Rows = list[tuple[str, str]]


def _map(survey: Survey) -> Rows:
    info = survey.map
    wide, high = info.width * info.resolution, info.height * info.resolution
    size = f"{_metres(wide)} x {_metres(high)} m, {info.width} x {info.height} pixels of {info.resolution:g} m"
    return [("map", info.image or "without a name"), ("", size)]


def _metres(length: float) -> str:
    """With one decimal; what is under a metre with two digits, so that no map has no width."""
    return f"{length:.1f}" if length >= 1 else f"{length:.2g}"


def _directions(survey: Survey) -> Rows:
    if not len(survey.directions):
        return [("directions", "none")]
    lines = Counter(survey.lines.directions.tolist())
    table = [
        [f"{_degrees(angle):.2f} deg", f"weight {weight:.2f}", f"{lines[k]} line{'s' * (lines[k] != 1)}"]
        for k, (angle, weight) in enumerate(zip(survey.directions.angles, survey.directions.weights, strict=True))
    ]
    said = terminal.columns(table, "><<")
    return [("directions", said[0]), *(("", line) for line in said[1:])]


def _degrees(angle: float) -> float:
    """Without a minus before a zero."""
    return round(math.degrees(angle), 2) + 0.0


def _faces(survey: Survey) -> Rows:
    from groundplan._results import STATES

    states = Counter(STATES[state] for state in survey.occupancy.states.tolist())
    kinds = ", ".join(f"{states[state]} {state}" for state in STATES if states[state])
    return [("faces", f"{len(survey.subdivision.areas)}: {kinds}")]


def _walls(survey: Survey) -> Rows:
    if not len(survey.walls):
        return [("walls", "none")]
    ends = survey.walls.points.reshape(-1, 2, 2)
    length = sum(math.dist(a, b) for a, b in ends.tolist())
    free = int(survey.walls.freestanding.sum())
    kinds = f"{len(survey.walls) - free} separating, {free} freestanding"
    return [("walls", f"{len(survey.walls)}, {length:.1f} m in all: {kinds}")]


def _labels(survey: Survey) -> Rows:
    kinds: Counter[str] = Counter()
    types: Counter[str] = Counter()
    corridors: list[tuple[float, float]] = []
    for label in survey._each_label():
        kinds[label["kind"]] += 1
        if label["kind"] == "corridor":
            axis = label["axis"]
            corridors.append((sum(math.dist(a, b) for a, b in pairwise(axis)), label["width"]))
        elif label["kind"] == "junction":
            types[label["type"]] += 1
    rows = [("corridors", _corridors(corridors)), ("junctions", _junctions(types))]
    others = [kind for kind in kinds if kind not in ("corridor", "junction")]
    return rows + [(f"{kind}s", str(kinds[kind])) for kind in others]


def _corridors(corridors: list[tuple[float, float]]) -> str:
    """Of the lengths and widths of all."""
    if not corridors:
        return "none"
    length = sum(length for length, _ in corridors)
    widths = sorted(f"{width:.1f}" for _, width in corridors)
    low, high = min(widths, key=float), max(widths, key=float)
    wide = f"{low} m" if low == high else f"{low} to {high} m"
    return f"{len(corridors)}, {length:.1f} m in all, {wide} wide"


def _junctions(types: Counter[str]) -> str:
    if not types:
        return "none"
    said = []
    for kind in sorted(types, key=lambda kind: (kind in _TYPES, kind)):
        one, many = _TYPES.get(kind, (kind, kind))
        said.append(f"{types[kind]} {one if types[kind] == 1 else many}")
    return f"{types.total()}: {', '.join(said)}"
