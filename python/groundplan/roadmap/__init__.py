"""The road map that an integrator would draw by hand: lanes on centre lines, nodes where something is decided.

    from groundplan.roadmap import road_map

    roads = road_map(survey, vehicle_width=1.2, rules="rules.toml")

One node stands at each junction and dead end, one abreast of each pick face where racks tell their bays, one in each
door and in each room behind one. Where aisles end in a hall, lanes through it join them. Needs shapely and networkx.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any

from groundplan._errors import ParameterError
from groundplan._extras import needed
from groundplan.roadmap._model import Blocked, Directed, Lane, Narrow, Node, PickFace, RoadMap, Zone

if TYPE_CHECKING:
    from groundplan.maps import Map
    from groundplan.survey import Survey

__all__ = ["Blocked", "Directed", "Lane", "Narrow", "Node", "PickFace", "RoadMap", "Zone", "built_once", "road_map"]

_built: ContextVar[dict[Any, RoadMap] | None] = ContextVar("built", default=None)


def road_map(
    survey: Survey,
    *,
    vehicle_width: float | None = None,
    rules: str | os.PathLike[str] | Sequence[Mapping[str, Any]] | None = None,
    spurs: float | None = None,
    map: Map | None = None,
) -> RoadMap:
    """The road map of a survey. The same survey and options give the same one.

    Parameters
    ----------
    survey
        Its corridors, junctions, racks, regions and doors are used.
    vehicle_width
        Metres; corridors and doors that are narrower are left out. By default a corridor under 1.2 m
        is where ways are usually more than two and a half times as wide: a gap for people. `RoadMap.narrow` has them.
    rules
        Speeds and one-way lanes, as `groundplan.roadmap._rules` describes them: a TOML file, or its entries.
    spurs
        Where given, a spur leads square from the lane to each pick face and ends so many metres before it, and the
        vehicle stands there; else it stands on the lane.
    map
        The surveyed map. Where it is given centre lines are held against the posts of racks, and no lane comes nearer
        than 0.4 m (than half the vehicle's width where that is more) to an occupied pixel; less only in doors under
        0.8 m, and in such corridors where a vehicle is given that fits them.

    Raises
    ------
    ParameterError
        ``roads.vehicle_width``, ``roads.spurs``, ``rules.value``.
    FormatError
        ``rules.read``.
    GroundplanError
        ``extra.missing`` without shapely or networkx.
    """
    for name, value in (("vehicle_width", vehicle_width), ("spurs", spurs)):
        if value is not None and not (math.isfinite(value) and value >= 0):
            raise ParameterError(f"roads.{name}", f"{name} is {value}", "it is in metres, and not negative")
    for module in ("shapely", "networkx"):
        needed(module, "fleet")
    from groundplan.roadmap._build import build
    from groundplan.roadmap._rules import rules as read_rules

    built = _built.get()
    if built is None:
        return build(survey, read_rules(rules), vehicle_width, spurs, map)
    asked = id(survey), repr(rules), vehicle_width, spurs, id(map)
    if asked not in built:
        built[asked] = build(survey, read_rules(rules), vehicle_width, spurs, map)
    return built[asked]


@contextmanager
def built_once() -> Iterator[None]:
    """Within, a road map that is asked for again is the one that was made, as several formats of one export do.

    The surveys, maps and rules that are asked with have to live, and to stay as they are, as long as that.
    """
    token = _built.set({})
    try:
        yield
    finally:
        _built.reset(token)
