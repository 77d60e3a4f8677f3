"""Zones: racks and pillars to keep out of, and corridors with a greatest speed."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

import shapely

from groundplan.export._places import Place, square
from groundplan.roadmap._model import Point, Zone
from groundplan.roadmap._rules import Rule, ruled


def zones(places: Sequence[Place], ways: Collection[int], rules: Sequence[Rule], angle: float) -> Iterator[Zone]:
    """The zones of places; of corridors those with a lane. Pillars are squares along an angle."""
    for place in places:
        if place.kind == "rack" and place.shape is not None:
            yield Zone(f"{place.id}.keep", "keep-out", place.name, _ring(place), place.label)
        elif place.kind == "pillar" and place.width:
            ring = square(place.centre, place.width, angle)
            yield Zone(f"{place.id}.keep", "keep-out", place.name, ring, place.label)
        elif place.kind == "corridor" and place.shape is not None and place.label in ways:
            speed, _ = ruled(rules, place.name)
            if speed is not None:
                yield Zone(f"{place.id}.speed", "speed", place.name, _ring(place), place.label, speed)


def _ring(place: Place) -> list[Point]:
    ring = shapely.orient_polygons(place.shape).exterior.coords[:-1]
    return [(float(x), float(y)) for x, y in ring]
