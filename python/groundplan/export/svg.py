"""The plan as an SVG to scale, a layer for each kind, that people look at, print and edit."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from groundplan._errors import ParameterError
from groundplan._files import write_bytes
from groundplan.export._places import Place, places, spread
from groundplan.export._svg import Drawing, names_on
from groundplan.figures import _style as ink
from groundplan.figures._labels import JUNCTION_NAMES, door_direction
from groundplan.figures._names import name_corridors, name_racks, name_regions
from groundplan.figures._panels import round_length
from groundplan.figures._underlay import Extent, underlay

if TYPE_CHECKING:
    from groundplan.maps import Map
    from groundplan.survey import Survey

#: The plan's long side on paper is no longer than this where no scale is asked for, mm.
LONGEST_MM = 400.0
MARGIN_MM, HEAD_MM, ROW_MM, ENTRY_MM, NARROWEST_MM = 8.0, 9.0, 5.0, 34.0, 120.0
#: Half the width of a pillar of which nothing says how wide it is, m.
PILLAR_M = 0.15
#: A kind's layer: its name, and how its shapes are drawn; the first lies lowest.
LAYERS: dict[str, tuple[str, dict[str, str]]] = {
    "region": ("Regions", {"fill_opacity": "0.2", "stroke_opacity": "0.8"}),
    "corridor": ("Corridors", {"fill": ink.CORRIDOR, "fill_opacity": "0.24", "stroke": ink.CORRIDOR}),
    "rack": ("Racks", {"fill": ink.RACK, "fill_opacity": "0.5", "stroke": ink.RACK}),
    "wall": ("Walls", {"fill": "none", "stroke": ink.WALL, "stroke_linecap": "round"}),
    "axis": ("Centre lines", {"fill": "none", "stroke": ink.CORRIDOR}),
    "door": ("Doors", {"fill": "none", "stroke": ink.DOOR}),
    "pillar": ("Pillars", {"fill": ink.PILLAR}),
    "junction": ("Junctions", {"stroke": "#ffffff"}),
}
#: Widths of lines on paper, mm.
WIDTHS = {"wall": 0.35, "door": 0.8, "axis": 0.2}


def write(survey: Survey, path: Path, scale: float | None = None, map: Map | None = None) -> list[Path]:
    """Write the plan at 1 : `scale`, else at the largest round scale at which it fits on a sheet.

    Raises
    ------
    ParameterError
        ``export.scale``.
    """
    if scale is not None and not (math.isfinite(scale) and scale > 0):
        raise ParameterError("export.scale", f"the scale is 1 : {scale}", "it is greater than 0, such as 100")
    found = places(survey)
    view = None if map is None else underlay(map)
    extent = view.extent if view is not None else _extent(survey, found)
    if scale is None:
        scale = _round_scale(max(extent[1] - extent[0], extent[3] - extent[2]) * 1000 / LONGEST_MM)
    drawing = Drawing(scale)
    entries = _entries(survey, found)
    page = _page(drawing, extent, len(entries))
    drawing.page(page, f"{survey.map.image or 'map'}, 1 : {scale:g}")
    if view is not None:
        drawing.picture(drawing.layer("map", "Map", upright=True), view)
    _shapes(drawing, survey, found)
    _names(drawing, survey, found)
    _legend(drawing, survey, extent, page, scale, entries)
    write_bytes(path, drawing.data())
    return [path]


def _extent(survey: Survey, found: list[Place]) -> Extent:
    points = spread(survey, found)
    (x0, y0), (x1, y1) = points.min(axis=0), points.max(axis=0)
    return float(x0), float(x1), float(y0), float(y1)


def _round_scale(least: float) -> float:
    """The first of 1, 2, 5, 10, 20, ... that is not below."""
    power = 10.0 ** math.floor(math.log10(max(least, 1.0)))
    return next(step * power for step in (1, 2, 5, 10) if step * power >= least * 0.9999)


def _page(drawing: Drawing, extent: Extent, entries: int) -> Extent:
    """The paper around the plan: a margin, a head, and a legend below."""
    x0, x1, y0, y1 = extent
    margin = MARGIN_MM * drawing.mm
    wide = max(x1 - x0, (NARROWEST_MM - 2 * MARGIN_MM) * drawing.mm)
    rows = math.ceil(entries / max(1, int(wide / (ENTRY_MM * drawing.mm))))
    below = (rows * ROW_MM + 2.0) * drawing.mm
    return x0 - margin, x0 + wide + margin, y0 - below - margin, y1 + HEAD_MM * drawing.mm + margin


def _shapes(drawing: Drawing, survey: Survey, found: list[Place]) -> None:
    """A layer for each kind, empty ones too, so that all plans have the same layers."""
    layers = {}
    for kind, (name, style) in LAYERS.items():
        width = WIDTHS.get(kind, 0.15) * drawing.mm
        layers[kind] = drawing.layer(kind, name, style | {"stroke_width": f"{width:.4f}"})
    layers["axis"].set("stroke-dasharray", f"{2 * drawing.mm:.4f} {drawing.mm:.4f}")
    for n, (a, b) in enumerate(survey.walls.points.reshape(-1, 2, 2).tolist()):
        drawing.line(layers["wall"], (a, b), f"wall-{n}")
    regions = 0
    for place in found:
        if place.kind not in layers or place.kind in ("wall", "axis"):
            continue
        layer, id, title = layers[place.kind], f"{place.kind}-{place.id}", _title(place)
        if place.kind == "junction":
            fill = ink.JUNCTIONS.get(place.use, ink.JUNCTIONS["end"])
            drawing.disc(layer, place.centre, 1.3 * drawing.mm, id, title, fill=fill)
        elif place.kind == "pillar":
            drawing.disc(layer, place.centre, (place.width or 2 * PILLAR_M) / 2, id, title)
        elif place.kind == "door":
            at = np.asarray(place.centre)
            along = door_direction(survey.labels[place.label], at, survey) * (place.width or 0.0) / 2
            drawing.line(layer, (at - along, at + along), id, title)
        elif place.shape is not None:
            own = {}
            if place.kind == "region":
                own = {"fill": (tint := ink.REGIONS[regions % len(ink.REGIONS)]), "stroke": tint}
                regions += 1
            rings = [ring.coords[:-1] for ring in (place.shape.exterior, *place.shape.interiors)]
            drawing.path(layer, rings, id, title, **own)
            if place.kind == "corridor" and place.axis is not None:
                drawing.line(layers["axis"], place.axis, f"axis-{place.id}")


def _title(place: Place) -> str:
    """What a pointer that rests on a shape is told."""
    kind = JUNCTION_NAMES.get(place.use, "Junction").lower() if place.kind == "junction" else place.use or place.kind
    parts = [place.name, kind]
    parts += [f"{place.width:.2f} m wide"] if place.width else []
    parts += [f"{place.area:.1f} m²"] if place.kind == "region" and place.area is not None else []
    return ", ".join(parts)


def _names(drawing: Drawing, survey: Survey, found: list[Place]) -> None:
    """Names where there is room for them, as in the figures; racks too."""
    style = {"text_anchor": "middle", "stroke": "#ffffff", "paint_order": "stroke", "stroke_opacity": "0.85"}
    width = {"stroke_width": f"{0.5 * drawing.mm:.4f}"}
    layer = drawing.layer("name", "Names", style | width, upright=True)
    names = names_on(drawing, layer)
    kinds = {kind: survey.of_kind(kind) for kind in ("corridor", "junction", "region")}
    for label in kinds["junction"]:
        names.take(label["at"], 8, 8)
    for place in found:
        if place.kind == "junction" and place.use in ("X", "T", "L", "Y"):
            drawing.text(layer, place.centre, place.use, 1.8, fill="#ffffff", stroke="none", font_weight="bold")
    name_corridors(kinds["corridor"], kinds["junction"], names)
    name_racks(survey.of_kind("rack"), names)
    name_regions([region for region in kinds["region"] if region.get("polygon")], kinds["corridor"], names)


def _entries(survey: Survey, found: list[Place]) -> list[tuple[str, str, dict[str, str]]]:
    """Of each kind that there is: its name with a count, its sign, and the sign's style."""
    fill = {kind: style for kind, (_, style) in LAYERS.items()}
    entries: list[tuple[str, str, dict[str, str]]] = []
    if len(survey.walls):
        entries.append(("Wall", "line", fill["wall"]))
    for kind in ("corridor", "rack", "region"):
        if count := sum(place.kind == kind for place in found):
            own = {"fill": ink.REGION, "stroke": ink.REGION} if kind == "region" else {}
            entries.append((f"{kind.title()} ({count})", "path", fill[kind] | own))
    for type, name in JUNCTION_NAMES.items():
        if count := sum(place.kind == "junction" and place.use == type for place in found):
            entries.append((f"{name} ({count})", "disc", {"fill": ink.JUNCTIONS[type]}))
    for kind, sign in (("door", "line"), ("pillar", "disc")):
        if count := sum(place.kind == kind for place in found):
            entries.append((f"{kind.title()} ({count})", sign, fill[kind]))
    return entries


def _legend(
    drawing: Drawing,
    survey: Survey,
    extent: Extent,
    page: Extent,
    scale: float,
    entries: list[tuple[str, str, dict[str, str]]],
) -> None:
    """The map's name and the scale bar above the plan, the signs below it."""
    mm = drawing.mm
    left, right, top = extent[0], page[1] - MARGIN_MM * mm, page[3] - MARGIN_MM * mm
    words = drawing.layer("legend-text", "Legend: words", {"fill": ink.INK}, upright=True)
    signs = drawing.layer("legend", "Legend", {"stroke": ink.INK, "stroke_width": f"{0.35 * mm:.4f}"})
    bar = round_length(min(0.3 * (right - left), 50 * mm))
    # The head has the name at the left; at the right the bar, its length beneath it.
    letters = max(4, int(((right - left) - bar - 8 * mm) / (2.4 * mm)))
    name = survey.map.image or "map"
    name = name if len(name) <= letters else name[: letters - 1] + "…"
    drawing.text(words, (left, top - 2 * mm), name, 3.6, font_weight="bold")
    drawing.text(words, (right, top - 4.6 * mm), f"{bar:g} m · 1 : {scale:g}", 2.6, text_anchor="end")
    ends = [(right - bar, top - 1.2 * mm), (right, top - 1.2 * mm)]
    drawing.line(signs, ends, "scale-bar", f"{bar:g} m")
    columns = max(1, int((right - left) / (ENTRY_MM * mm)))
    for n, (text, sign, style) in enumerate(entries):
        row, column = divmod(n, columns)
        x, y = left + column * ENTRY_MM * mm, extent[2] - (4.0 + row * ROW_MM) * mm
        if sign == "disc":
            drawing.disc(signs, (x + 2.5 * mm, y), 1.2 * mm, f"legend-{n}", text, stroke="none", **style)
        else:
            half = 0.0 if sign == "line" else 1.2 * mm
            box = [(x, y - half), (x + 5 * mm, y - half), (x + 5 * mm, y + half), (x, y + half)]
            drawing.path(signs, [box], f"legend-{n}", text, **style)
        drawing.text(words, (x + 6.5 * mm, y), text, 2.6)
