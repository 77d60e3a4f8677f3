"""Nav2's speed mask: a limit for each pixel, 0 where there is none."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from groundplan._errors import ParameterError
from groundplan.export import _masks
from groundplan.export._places import places
from groundplan.roadmap._rules import ruled
from groundplan.roadmap._rules import rules as read_rules

if TYPE_CHECKING:
    from groundplan.export._places import Place
    from groundplan.survey import Survey

PERCENT, METRES_PER_SECOND = 1, 2
#: Where no rule says anything: vehicles cross each other's way at junctions.
JUNCTION_PERCENT = 50
GREATEST = 100
#: What a step of a pixel's value can stand for, m/s.
STEPS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0)
#: The later lies above: a junction is a part of its corridors, and these of a region.
ORDER = ("region", "corridor", "junction", "door")


def write(survey: Survey, path: Path, rules: Any = None, max_speed: float | None = None) -> list[Path]:
    """Write the mask of the rules' speeds: in m/s, or with a greatest speed in percent of that.

    Without rules junctions have half of the greatest speed. Limits are rounded down.

    Raises
    ------
    ParameterError
        ``export.max_speed``, and as `groundplan.roadmap` says of rules.
    """
    if max_speed is not None and not (math.isfinite(max_speed) and max_speed > 0):
        raise ParameterError("export.max_speed", f"max_speed is {max_speed}", "it is in m/s and greater than 0")
    found = [place for place in places(survey) if place.kind in ORDER and _masks.area(place) is not None]
    if rules is None:
        limits = [(place, JUNCTION_PERCENT) for place in found if _crossing(place)]
        return _written(survey, path, limits, PERCENT, 1.0)
    said = read_rules(rules)
    speeds = [(place, speed) for place in found if (speed := ruled(said, place.name)[0]) is not None]
    if max_speed is not None:
        type, step, scale = PERCENT, 1.0, 100.0 / max_speed
    else:
        fastest = max((speed for _, speed in speeds), default=0.0)
        step = next((step for step in STEPS if fastest <= GREATEST * step), STEPS[-1])
        type, scale = METRES_PER_SECOND, 1.0 / step
    # 0 would be no limit at all.
    limits = [(place, min(max(math.floor(speed * scale + 1e-6), 1), GREATEST)) for place, speed in speeds]
    return _written(survey, path, limits, type, step)


def _crossing(place: Place) -> bool:
    return place.kind == "junction" and place.use != "end"


def _written(survey: Survey, path: Path, limits: list[tuple[Place, int]], type: int, step: float) -> list[Path]:
    """The mask of places and values; of two places of a kind that overlap, the slower one counts."""
    limits.sort(key=lambda limit: (ORDER.index(limit[0].kind), -limit[1]))
    return _masks.write(survey, path, [(_masks.area(place), value) for place, value in limits], "speed", type, step)
