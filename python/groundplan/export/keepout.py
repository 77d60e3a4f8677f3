"""Nav2's keep-out mask: 100 where no vehicle may be, 0 elsewhere."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import shapely

from groundplan._errors import ParameterError
from groundplan.export import _masks
from groundplan.export._places import places
from groundplan.roadmap._rules import ruled
from groundplan.roadmap._rules import rules as read_rules

if TYPE_CHECKING:
    from groundplan.survey import Survey

KEEP_OUT, TYPE = 100, 0
KINDS = ("racks", "walls", "pillars")
#: Half the width of a wall in pixels: no diagonal passes between the pixels of such a band.
HALF_WALL = 0.75


def write(survey: Survey, path: Path, keep: str | None = None, rules: Any = None) -> list[Path]:
    """Write the mask of the kinds to keep out of, and of what the rules close.

    Raises
    ------
    ParameterError
        ``export.keep``, and as `groundplan.roadmap` says of rules.
    """
    kinds = KINDS if keep is None else tuple(part.strip() for part in keep.split(",") if part.strip())
    for kind in kinds:
        if kind not in KINDS:
            raise ParameterError("export.keep", f"{kind!r} is nothing to keep out of", f"there are {', '.join(KINDS)}")
    shapes = [*(_walls(survey) if "walls" in kinds else []), *_places(survey, kinds, rules)]
    return _masks.write(survey, path, [(shape, KEEP_OUT) for shape in shapes], "keepout", TYPE)


def _walls(survey: Survey) -> list[Any]:
    """Walls as thin bands: the costmap knows how thick they are, and the mask must not narrow a way."""
    lines = shapely.linestrings(survey.walls.points.reshape(-1, 2, 2))
    bands: list[Any] = shapely.buffer(lines, HALF_WALL * survey.map.resolution, cap_style="square").tolist()
    return bands


def _places(survey: Survey, kinds: tuple[str, ...], rules: Any) -> list[Any]:
    """Racks, pillars, and places that the rules close; where an open way crosses a closed one it stays open."""
    said = read_rules(rules)
    found = places(survey)
    closed = [place for place in found if ruled(said, place.name)[1] == "closed"]
    shut = {place.label for place in closed}
    ways = [p.shape for p in found if p.kind in ("corridor", "junction") and p.label not in shut and p.shape]
    shapes = []
    for place in found:
        shape = _masks.area(place)
        if place.kind == "pillar" and shape is None:
            shape = shapely.Point(place.centre).buffer(survey.map.resolution)
        if shape is None:
            continue
        if f"{place.kind}s" in kinds:
            shapes.append(shape)
        elif place.label in shut:
            shapes.append(shape if place.kind != "corridor" else shapely.difference(shape, shapely.union_all(ways)))
    return shapes
