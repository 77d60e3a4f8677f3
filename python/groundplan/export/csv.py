"""A table of places for a warehouse management system, RFC 4180: commas, quotes where needed, CR LF, UTF-8.

Lengths are metres with three decimals in the map frame; the polygon is WKT, as every spatial database reads it.
"""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import TYPE_CHECKING

import shapely

from groundplan._files import write_bytes
from groundplan.export._places import Place, places

if TYPE_CHECKING:
    from groundplan.survey import Survey

COLUMNS = ("id", "name", "kind", "use", "x", "y", "width", "length", "area", "region", "neighbours", "polygon")


def write(survey: Survey, path: Path) -> list[Path]:
    """Write one row for each place; neighbours are ids with semicolons between."""
    found = places(survey)
    text = io.StringIO(newline="")
    rows = csv.writer(text)
    rows.writerow(COLUMNS)
    rows.writerows(_row(place, found) for place in found)
    write_bytes(path, text.getvalue().encode())
    return [path]


def _row(place: Place, found: list[Place]) -> list[str]:
    length = None if place.axis is None else shapely.LineString(place.axis).length
    return [
        place.id,
        place.name,
        place.kind,
        place.use,
        _metres(place.centre[0]),
        _metres(place.centre[1]),
        _metres(place.width),
        _metres(length),
        _metres(place.area),
        "" if place.region is None else found[place.region].id,
        ";".join(found[n].id for n in place.neighbours),
        "" if place.shape is None else shapely.to_wkt(place.shape, rounding_precision=3),
    ]


def _metres(value: float | None) -> str:
    return "" if value is None else f"{value:.3f}"
