"""What is asked of a survey again and again: where a point is, and the way from one place to another."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

from groundplan import _core
from groundplan._errors import FormatError, ParameterError
from groundplan._results import Floats, Ids, SignedIds, Stage, record
from groundplan.maps import Map
from groundplan.stages import layout, needs

if TYPE_CHECKING:
    from groundplan._results import Label
    from groundplan.survey import Survey

#: A point (x, y) in metres, a label's name, or the id of a face.
Place: TypeAlias = "Sequence[float] | Floats | str | int"

#: What a place may be, as a hint.
PLACE = "a place is a point X,Y in metres, a label's name (A01, or J01 as in exports), or a face's id"
#: What may help where there is no way, or no room to stand, as a hint.
LESS = "a smaller clearance may leave room"

#: Clearances whose free space is kept ready.
KEPT = 4
#: A way is asked every so many metres whether it is in a rack, which are deeper.
STEP = 0.1


@dataclass(frozen=True, eq=False, repr=False)
class Route(Stage):
    """A way through a map.

    Attributes
    ----------
    faces : (K,) uint32
        That it passes through, in order; a face is named again where the way comes back to it.
    points : (N, 2) float64
        Its bends, metres in the map frame, both ends included.
    length : float
        Metres.
    clearance : float
        What it keeps from what is occupied, metres.
    racks : tuple of str
        Names of the racks that it leads under or through: such as stand on legs, or have empty bays.
    """

    faces: Ids
    points: Floats
    length: float
    clearance: float
    racks: tuple[str, ...] = ()


def no_point(x: Any, y: Any) -> ParameterError:
    """What is wrong with what is no point."""
    for value in (x, y):
        if not _is_number(value):
            return ParameterError("point.number", f"a coordinate cannot be {value!r}", "numbers, in metres")
    return ParameterError("point.finite", f"the point ({x}, {y}) is not finite")


class Queries:
    """A survey's index of places; its space of each clearance is made when it is first asked for."""

    def __init__(self, survey: Survey) -> None:
        info = survey.map
        self.survey = survey
        self.frame = (info.width, info.height, info.resolution, info.origin)
        polygons = [(n, label) for n, label in enumerate(survey.labels) if "polygon" in label]
        rings = [(n, ring) for n, label in polygons for ring in (label["polygon"], *label.get("holes", ()))]
        self.locator = _core.Locator(
            self.frame,
            record(survey.directions),
            record(survey.lines),
            *_ragged([r for _, r in rings]),
            [n for n, _ in rings],
        )
        if self.locator.faces != len(survey.subdivision.areas):
            said = f"its lines make {self.locator.faces} faces and it has {len(survey.subdivision.areas)}"
            raise FormatError("survey.content", f"the survey is not whole: {said}")
        self._ways: dict[tuple[float, bool, int], tuple[Map | None, _core.Ways]] = {}

    def locate_all(self, x: npt.ArrayLike, y: npt.ArrayLike) -> SignedIds:
        """The faces that hold points, `NONE` outside."""
        try:
            xs, ys = np.broadcast_arrays(np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64))
        except (TypeError, ValueError, OverflowError) as reason:
            raise ParameterError("point.number", f"the points are none: {reason}", "as many numbers x as y") from None
        if not (np.isfinite(xs).all() and np.isfinite(ys).all()):
            raise ParameterError("point.finite", "a coordinate of the points is not finite")
        points = np.column_stack([xs.ravel(), ys.ravel()])
        return self.locator.locate_all(points).reshape(xs.shape)

    def route(self, a: Place, b: Place, clearance: float, around_racks: bool, map: Map | None) -> Route | None:
        """As `Survey.route`."""
        if not _is_number(clearance) or not 0 <= clearance < math.inf:
            raise ParameterError("route.clearance", f"the clearance cannot be {clearance!r}", "metres from 0 on")
        ways = self.ways(float(clearance), around_racks, map)
        start, end = (self.place(place, ways, clearance, around_racks) for place in (a, b))
        found = ways.route(start, end)
        if found is None:
            return None
        length = float(np.hypot(*np.diff(found, axis=0).T).sum())
        passed = [self.survey.labels[n] for n in self.locator.labels_along(found, STEP)]
        racks = tuple(label["name"] for label in passed if label["kind"] == "rack" and "name" in label)
        return Route(self.locator.along(found), found, length, float(clearance), racks)

    def ways(self, clearance: float, around_racks: bool, map: Map | None) -> _core.Ways:
        """The free space that keeps a clearance."""
        key = (clearance, bool(around_racks), id(map))
        if key not in self._ways:
            if len(self._ways) == KEPT:
                del self._ways[next(iter(self._ways))]
            racks = self.survey.of_kind("rack") if around_racks else ()
            closed = _ragged([rack["polygon"] for rack in racks if "polygon" in rack])
            # The map is held with it, so that no other has its id.
            made = self._of_survey(closed, clearance) if map is None else self._of_map(closed, clearance, map)
            self._ways[key] = map, made
        return self._ways[key][1]

    def _of_map(self, closed: tuple[Floats, list[int]], clearance: float, map: Map) -> _core.Ways:
        info, needed = self.survey.map, needs(Map, "map", map)
        if (needed.width, needed.height) != (info.width, info.height):
            said = f"the map has {map.width} x {map.height} pixels, and the surveyed one {info.width} x {info.height}"
            raise ParameterError("route.map", said)
        return _core.Ways.of_map(layout(needed), closed, clearance)

    def _of_survey(self, closed: tuple[Floats, list[int]], clearance: float) -> _core.Ways:
        survey, cut = self.survey, self.survey.subdivision
        regions = survey.of_kind("region")
        rings = [ring for region in regions for ring in (region["polygon"], *region.get("holes", ()))]
        if not rings:
            rings = [cut.polygon(int(face)) for face in np.flatnonzero(survey.occupancy.states == 0)]
        # The covered parts of the edges.
        runs, counts = survey.occupancy.runs, np.diff(survey.occupancy.run_offsets)
        ends = cut.vertices[cut.edge_vertices][np.repeat(np.arange(len(counts)), counts)]
        along = ends[:, 1] - ends[:, 0]
        along /= np.maximum(np.hypot(*along.T), 1e-9)[:, None]
        taken = [(ends[:, :1] + along[:, None] * runs[:, :, None]).reshape(-1, 2)]
        for pillar in survey.of_kind("pillar"):
            half = pillar.get("width", 0) / 2
            taken.append(np.array(pillar["at"]) + half * np.array([[-1, -1], [1, 1], [-1, 1], [1, -1]]))
        return _core.Ways.of_survey(self.frame, _ragged(rings), np.concatenate(taken), closed, clearance)

    def place(self, place: Place, ways: _core.Ways, clearance: float, around_racks: bool) -> tuple[float, float]:
        """A point that a robot may stand on."""
        if isinstance(place, str):
            label = self._named(place)
            is_rack = label["kind"] == "rack" and "polygon" in label
            if is_rack and (before := self._before(label, ways, clearance)):
                return before
            # A pillar is gone up to.
            beside = [label["width"] / 2 + clearance] if label["kind"] == "pillar" else []
            corners = [np.add(label["at"], side * by) for by in beside for side in (-1, 1)]
            ring = np.asarray(label.get("polygon", label.get("axis", corners)), dtype=np.float64)
            axis = np.asarray(label["axis"]).mean(axis=0) if "axis" in label else ring.mean(axis=0)
            middle = label.get("at", axis)
        elif isinstance(place, int | np.integer) and not isinstance(place, bool):
            cut = self.survey.subdivision
            if not 0 <= place < len(cut.areas):
                raise ParameterError(
                    "route.face", f"there is no face {place}", f"there are {len(cut.areas)}, from 0 on"
                )
            ring, middle = cut.polygon(int(place)), cut.centres[place]
        else:
            return self._point(place, ways, clearance, around_racks)
        reach = float(np.hypot(*np.ptp(ring, axis=0))) / 2
        open = ways.nearest(float(middle[0]), float(middle[1]), reach)
        if open is None:
            said = f"no point of {place!r} is {clearance:g} m from what is occupied"
            raise ParameterError("route.blocked", said, LESS)
        return open[0], open[1]

    def _named(self, name: str) -> Label:
        names = {label["name"]: label for label in self.survey.labels if "name" in label and "polygon" in label}
        if name not in names:
            # As files that were exported call what the survey gives no name.
            from groundplan.export._places import places

            others = {place.name: self.survey.labels[place.label] for place in places(self.survey)}
            names |= {n: label for n, label in others.items() if n not in names and {"polygon", "at"} & label.keys()}
        if name not in names:
            own = [known for known in names if known.casefold() == name.casefold()]
            near = own or get_close_matches(name, [known for known in names if known[:1] == name[:1]], 1)
            hint = f"did you mean {near[0]}?" if near else PLACE
            raise ParameterError("route.name", f"no label is named {name!r}", hint)
        return names[name]

    def _before(self, rack: Label, ways: _core.Ways, clearance: float) -> tuple[float, float] | None:
        """A point before one of a rack's sides, the long ones first: a rack is gone up to, be there floor in it."""
        ring = np.asarray(rack["polygon"], dtype=np.float64)
        sides = np.stack([ring, np.roll(ring, -1, axis=0)], axis=1)
        lengths = np.hypot(*(sides[:, 1] - sides[:, 0]).T)
        for side, length in sorted(zip(sides, lengths, strict=True), key=lambda pair: -pair[1]):
            along = (side[1] - side[0]) / max(length, 1e-9)
            # Rings go round counter-clockwise.
            x, y = side.mean(axis=0) + (clearance + 2 * self.survey.map.resolution) * np.array([along[1], -along[0]])
            open = ways.nearest(float(x), float(y), float(length) / 2)
            if open and rack not in (self.survey.labels[n] for n in self.locator.labels_at(*open)):
                return open[0], open[1]
        return None

    def _point(self, place: Any, ways: _core.Ways, clearance: float, around_racks: bool) -> tuple[float, float]:
        try:
            x, y = (float(value) for value in place)
        except (TypeError, ValueError, OverflowError):
            raise ParameterError("route.place", f"{place!r} is no place", PLACE) from None
        if not (math.isfinite(x) and math.isfinite(y)):
            raise no_point(x, y)
        if self.locator.locate(x, y) is None:
            low, high = self.survey.subdivision.vertices.min(axis=0), self.survey.subdivision.vertices.max(axis=0)
            within = f"it reaches from ({low[0]:.2f}, {low[1]:.2f}) to ({high[0]:.2f}, {high[1]:.2f})"
            raise ParameterError("route.outside", f"({x:g}, {y:g}) lies outside the map", within)
        if not ways.is_open(x, y):
            nearest = ways.nearest(x, y, 2.0)
            hint = LESS
            if nearest:
                hint = f"the nearest point that is, is ({nearest[0]:.3f}, {nearest[1]:.3f})"
            held = [self.survey.labels[n] for n in self.locator.labels_at(x, y)] if around_racks else []
            under = [label.get("name", "a rack") for label in held if label["kind"] == "rack"]
            said = f"({x:g}, {y:g}) is not free and {clearance:g} m from what is occupied"
            if under:
                said = f"({x:g}, {y:g}) is in {under[0]}, and racks are taken as occupied"
            raise ParameterError("route.blocked", said, hint)
        return x, y


def _is_number(value: object) -> bool:
    if isinstance(value, int) and abs(value) > sys.float_info.max:
        return False
    return isinstance(value, int | float | np.integer | np.floating) and not isinstance(value, bool)


def _ragged(rings: Sequence[Any]) -> tuple[Floats, list[int]]:
    """Rings as points and offsets."""
    parts = [np.asarray(ring, dtype=np.float64).reshape(-1, 2) for ring in rings]
    points = np.concatenate(parts) if parts else np.empty((0, 2))
    return points, np.cumsum([0, *(len(part) for part in parts)]).tolist()
