"""IFC4 (ISO 16739-1): the storey as a building model: regions as spaces, walls, racks, pillars, doors, boundaries.

A survey is flat. Heights are invented (option ``height``), and so is a wall's thickness where it was seen from one side
only; the property set ``SurveyProvenance`` of each element says so.
"""

from __future__ import annotations

from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from groundplan._errors import ParameterError
from groundplan._files import write_text
from groundplan.export._boundaries import Boundary, boundaries
from groundplan.export._dates import moment
from groundplan.export._ifc_model import Model
from groundplan.export._places import Place, places
from groundplan.export._text import one_line

if TYPE_CHECKING:
    from groundplan.survey import Survey

HEIGHT_M = 3.0
#: No wall of a building is thinner; a line's width is that of what the robot saw of it.
THINNEST_M = 0.05
#: A pillar's side where its label has no polygon, metres.
PILLAR_M = 0.3
DOOR_HEIGHT_M = 2.1


def write(survey: Survey, path: Path, date: str | datetime | None = None, height: float = HEIGHT_M) -> list[Path]:
    """Write the model; `height` in metres is that of the storey and everything in it.

    Raises
    ------
    ParameterError
        ``export.height``.
    """
    if not 0.1 <= height <= 1000:
        raise ParameterError("export.height", f"a height of {height} m is outside 0.1 to 1000", "such as 3.0")
    name = one_line(survey.map.image) or "map"
    model = Model(name, moment(date), height)
    found = places(survey)
    spaces = {
        place.label: _space(model, place) for place in found if place.kind == "region" and place.shape is not None
    }
    model.aggregate(list(spaces.values()))
    walls, outlines = _walls(model, survey)
    doors = {place.label: _door(model, place) for place in found if place.kind == "door"}
    others = [_solid(model, place) for place in found if place.kind in ("rack", "pillar")]
    model.contain([*walls, *doors.values(), *(other for other in others if other is not None)])
    for boundary in boundaries(survey, found, outlines):
        _boundary(model, boundary, spaces, walls, doors)
    model.mark({"Source": name, "HeightIsInvented": True, "Frame": "map"})
    write_text(path, model.text())
    return [path]


def _space(model: Model, place: Place) -> Any:
    space = model.element(
        "IfcSpace",
        place.id,
        Name=place.id,
        LongName=place.name,
        ObjectType=place.use or None,
        CompositionType="ELEMENT",
        PredefinedType="INTERNAL",
        **model.body(place.shape, model.height),
    )
    areas = {"GrossFloorArea": place.shape.area, "NetFloorArea": place.area or 0.0}
    model.quantities(space, "Qto_SpaceBaseQuantities", **areas, Height=model.height)
    return space


def _walls(model: Model, survey: Survey) -> tuple[list[Any], list[Any]]:
    """The walls, and the rectangle of each."""
    made, outlines = [], []
    for n, ends in enumerate(survey.walls.points.reshape(-1, 2, 2)):
        line = shapely.LineString(ends)
        if line.length < 1e-6:
            continue
        thickness = max(float(survey.lines.widths[survey.walls.lines[n]]), survey.map.resolution, THINNEST_M)
        outline = line.buffer(thickness / 2, cap_style="flat")
        kind = "freestanding" if survey.walls.freestanding[n] else "separating"
        made.append(
            model.element(
                "IfcWall",
                f"wall {n}",
                Name=f"W{n:04}",
                ObjectType=kind,
                Tag=str(n),
                **model.body(outline, model.height),
            )
        )
        outlines.append(outline)
    return made, outlines


def _door(model: Model, place: Place) -> Any:
    """A door as a thin leaf across its opening."""
    (x0, y0), (x1, y1) = place.axis if place.axis is not None else _across(place)
    leaf = shapely.LineString([(x0, y0), (x1, y1)]).buffer(THINNEST_M / 2, cap_style="flat")
    height = min(DOOR_HEIGHT_M, model.height)
    width = place.width if place.width else float(np.hypot(x1 - x0, y1 - y0))
    return model.element(
        "IfcDoor",
        place.id,
        Name=place.id,
        ObjectType="opening",
        OverallHeight=height,
        OverallWidth=max(width, THINNEST_M),
        PredefinedType="DOOR",
        **model.body(leaf, height),
    )


def _across(place: Place) -> tuple[tuple[float, float], tuple[float, float]]:
    half, (x, y) = max(place.width or 0.0, THINNEST_M) / 2, place.centre
    return (x - half, y), (x + half, y)


def _solid(model: Model, place: Place) -> Any | None:
    """A rack as furniture, a pillar as a column."""
    shape = place.shape
    if place.kind == "pillar" and shape is None:
        shape = shapely.box(*(v - PILLAR_M / 2 for v in place.centre), *(v + PILLAR_M / 2 for v in place.centre))
    if shape is None:
        return None
    kind, type = ("IfcFurniture", "SHELF") if place.kind == "rack" else ("IfcColumn", "COLUMN")
    return model.element(
        kind, place.id, Name=place.id, ObjectType=place.kind, PredefinedType=type, **model.body(shape, model.height)
    )


def _boundary(
    model: Model, boundary: Boundary, spaces: dict[int, Any], walls: list[Any], doors: dict[int, Any]
) -> None:
    """What bounds a space: a wall, a door, or nothing that can be touched."""
    key = f"boundary {boundary.region} {boundary.kind} {boundary.by}"
    virtual = boundary.kind == "open"
    if virtual:
        by = model.virtual(f"virtual {boundary.region} {boundary.by}")
    else:
        by = walls[boundary.by] if boundary.kind == "wall" else doors[boundary.by]
    model.boundary(key, spaces[boundary.region], by, boundary.line, virtual=virtual, outer=boundary.outer)
