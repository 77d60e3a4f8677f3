"""The labels as places: each with an id, a name, a shape and its neighbours."""

from __future__ import annotations

import itertools
import math
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import shapely

from groundplan._shapes import outline
from groundplan.export._text import one_line, slug, unique

if TYPE_CHECKING:
    from groundplan._results import Label
    from groundplan.survey import Survey

#: The letters of what the survey gives no name; those that it names have A, C (corridors), S (racks), R (regions).
LETTERS = {"junction": "J", "door": "D", "pillar": "P"}
#: A rack stands at a corridor when no more than this lies between them, metres: a rack's face wavers.
BESIDE_M = 0.5


@dataclass
class Place:
    """A label, ready to be written.

    Attributes
    ----------
    label : int
        Its id: the position in ``survey.labels``.
    id : str
        Unique, of ASCII letters, digits, ``_`` and ``-``; from its name, so that it stays while that does.
    name : str
        As the survey or a person named it, in one line; not always unique.
    kind : str
        ``corridor``, ``junction``, ``region``, ``door``, ``rack``, ``pillar``.
    use : str
        What kind of its kind: a junction's type, a region's use; else empty.
    shape : shapely.Polygon or None
        Its outline with holes, metres in the map frame, valid; None for doors and pillars.
    centre : (float, float)
        A point in it that stands for it, metres.
    axis : list of (float, float) or None
        Two points, metres.
    width : float or None
        As the label has it, metres.
    area : float or None
        As the label has it, square metres: of a region its free floor. Else the outline's.
    region : int or None
        The label id of the region that holds its centre.
    neighbours : list of int
        Label ids: junctions and their corridors, corridors and the racks along them, doors and their regions.
    """

    label: int
    id: str
    name: str
    kind: str
    use: str
    shape: Any
    centre: tuple[float, float]
    axis: list[tuple[float, float]] | None
    width: float | None
    area: float | None
    region: int | None = None
    neighbours: list[int] = field(default_factory=list)


def places(survey: Survey) -> list[Place]:
    """Every label as a place, in the order of their ids."""
    names = _names(survey)
    ids = unique(slug(name) or label["kind"] for name, label in zip(names, survey.labels, strict=True))
    found = [_place(n, ids[n], names[n], label) for n, label in enumerate(survey.labels)]
    for a, b in _meetings(survey, found):
        found[a].neighbours.append(b)
        found[b].neighbours.append(a)
    for place in found:
        place.neighbours = sorted(set(place.neighbours))
    _find_regions(found)
    return found


def _find_regions(found: list[Place]) -> None:
    """The region in which the middle of each place lies; a rack, whose ground is taken, is where its corridors are."""
    regions = [place for place in found if place.kind == "region" and place.shape is not None]
    others = [place for place in found if place.kind not in ("region", "door")]
    if not regions or not others:
        return
    tree = shapely.STRtree([region.shape for region in regions])
    points = shapely.points([place.centre for place in others])
    # Of several regions the last in this order, the first of all, stays.
    for n, k in sorted(tree.query(points, predicate="covered_by").T.tolist(), reverse=True):
        others[n].region = regions[k].label
    for rack in others:
        if rack.kind == "rack" and rack.region is None:
            beside = {found[n].region for n in rack.neighbours if found[n].kind == "corridor"}
            rack.region = beside.pop() if len(beside) == 1 else None


def _names(survey: Survey) -> list[str]:
    """A name for each label: its own, or a letter and a number, which runs from the lower left."""
    names = [one_line(label.get("name", "")) for label in survey.labels]
    unnamed = defaultdict(list)
    for n, label in enumerate(survey.labels):
        if not names[n]:
            unnamed[label["kind"]].append(n)
    for kind, members in unnamed.items():
        order = in_rows([_centre(survey.labels[n]) for n in members], main_angle(survey))
        for number, k in enumerate(order, 1):
            names[members[k]] = f"{LETTERS.get(kind, kind[:1].upper())}{number:02}"
    return names


def main_angle(survey: Survey) -> float:
    """The angle along which aisles run, radians; 0 without directions."""
    length: dict[float, float] = defaultdict(float)
    for label in survey.of_kind("corridor"):
        (x0, y0), (x1, y1) = label["axis"]
        angle = math.atan2(y1 - y0, x1 - x0) % math.pi
        near = min(length, key=lambda other: abs(math.sin(other - angle)), default=angle)
        length[near if abs(math.sin(near - angle)) < 0.1 else angle] += math.hypot(x1 - x0, y1 - y0)
    if length:
        return max(length, key=lambda angle: length[angle])
    return float(survey.directions.angles[0]) if len(survey.directions) else 0.0


def spread(survey: Survey, found: Sequence[Place]) -> npt.NDArray[np.float64]:
    """Points, n x 2, between which lies all that was found; the map's corners where that has no extent."""
    shapes = [place.shape if place.shape is not None else shapely.Point(place.centre) for place in found]
    points = np.concatenate([shapely.get_coordinates(shapes), survey.walls.points.reshape(-1, 2)])
    if not len(points) or not np.ptp(points, axis=0).min() > 0:
        points = survey.subdivision.vertices
    return points


def forwards(x: float, y: float) -> bool:
    """Whether numbers run that way: right, or up."""
    return 0.927 * x + 0.375 * y >= 0


def in_rows(points: list[tuple[float, float]], angle: float, row_m: float = 1.0) -> list[int]:
    """The order in which points are numbered: row by row along an angle, from the lower left; rows are 1 m apart."""
    cos, sin = math.cos(angle), math.sin(angle)
    # Whichever way the direction happened to be measured.
    along_sign = 1.0 if forwards(cos, sin) else -1.0
    across_sign = 1.0 if forwards(-sin, cos) else -1.0
    along = [along_sign * (x * cos + y * sin) for x, y in points]
    across = [across_sign * (y * cos - x * sin) for x, y in points]
    rows: list[list[int]] = []
    for n in sorted(range(len(points)), key=lambda n: across[n]):
        if rows and across[n] - across[rows[-1][0]] < row_m:
            rows[-1].append(n)
        else:
            rows.append([n])
    return [n for row in rows for n in sorted(row, key=lambda n: along[n])]


def _centre(label: Label) -> tuple[float, float]:
    if "at" in label:
        return float(label["at"][0]), float(label["at"][1])
    if "axis" in label:
        (x0, y0), (x1, y1) = label["axis"]
        return (x0 + x1) / 2, (y0 + y1) / 2
    ring = label.get("polygon") or [[0.0, 0.0]]
    return sum(p[0] for p in ring) / len(ring), sum(p[1] for p in ring) / len(ring)


def _place(n: int, id: str, name: str, label: Label) -> Place:
    axis = label.get("axis")
    width, shape = label.get("width"), outline(label)
    area = label.get("area", None if shape is None else shape.area)
    return Place(
        label=n,
        id=id,
        name=name,
        kind=label["kind"],
        use=str(label.get("use", label.get("type", ""))),
        shape=shape,
        centre=_centre(label),
        axis=None if axis is None else [(float(x), float(y)) for x, y in axis],
        width=None if width is None else float(width),
        area=None if area is None else round(float(area), 6),
    )


def square(at: tuple[float, float], side: float, angle: float) -> list[tuple[float, float]]:
    """The corners of a square about a point, one side along an angle, counter-clockwise."""
    cos, sin = side / 2 * math.cos(angle), side / 2 * math.sin(angle)
    corners = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    return [(round(at[0] + a * cos - b * sin, 6), round(at[1] + a * sin + b * cos, 6)) for a, b in corners]


def _meetings(survey: Survey, found: list[Place]) -> list[tuple[int, int]]:
    """Pairs of label ids that adjoin."""
    pairs: set[tuple[int, int]] = set()
    for n, label in enumerate(survey.labels):
        sides = [other for other in label.get("between", ()) if 0 <= other < len(found)]
        pairs |= {(n, other) for other in [*label.get("corridors", ()), *sides] if 0 <= other < len(found)}
        # Who goes through a door comes from the one region into the other.
        pairs |= set(itertools.combinations(sides, 2))
    racks, ways = ([p for p in found if p.kind == kind and p.shape is not None] for kind in ("rack", "corridor"))
    if racks and ways:
        tree = shapely.STRtree([way.shape for way in ways])
        for rack in racks:
            for k in tree.query(rack.shape, predicate="dwithin", distance=BESIDE_M).tolist():
                if _alongside(rack, ways[k]):
                    pairs.add((rack.label, ways[k].label))
    return sorted({(min(a, b), max(a, b)) for a, b in pairs if a != b})


def _alongside(rack: Place, way: Place) -> bool:
    """Whether a rack stands at a corridor with its side, and not with its end."""
    if rack.axis is None or way.axis is None:
        return False
    (ax, ay), (bx, by) = rack.axis
    (cx, cy), (dx, dy) = way.axis
    along = abs((bx - ax) * (dx - cx) + (by - ay) * (dy - cy))
    return bool(along > 0.9 * math.hypot(bx - ax, by - ay) * math.hypot(dx - cx, dy - cy) > 0)
