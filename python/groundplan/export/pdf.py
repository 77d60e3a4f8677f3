"""A report as PDF: the plan, the paper's figures, a table of places, the warnings."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib
import shapely
from matplotlib.backends.backend_pdf import PdfPages
from matplotlib.figure import Figure

from groundplan._files import whole
from groundplan.export import _report
from groundplan.export._dates import moment
from groundplan.export._places import Place, places, spread
from groundplan.export._text import one_line
from groundplan.figures._directions import directions, radiograms
from groundplan.figures._dual import abstraction, connectivity, edge_features, subdivision_and_dual
from groundplan.figures._style import DPI, style
from groundplan.figures._underlay import underlay

if TYPE_CHECKING:
    from groundplan.maps import Map
    from groundplan.survey import Survey

HEAD = ("Name", "Kind", "Width, m", "Length, m", "Area, m²", "In region", "Neighbours")
WIDTHS = (2.0, 1.5, -1.0, -1.0, -1.0, 1.2, 2.7)
#: With more faces than this a figure of them all is a grey sheet, and takes a minute.
MOST_FACES = 20_000
#: Nobody turns more pages of a table than the fifty of so many places, at a row each.
MOST_PLACES = 50 * _report.ROWS
#: Radiograms and directions are drawn over a map of so many pixels.
SMALL = 1200


def write(survey: Survey, path: Path, date: str | datetime | None = None, map: Map | None = None) -> list[Path]:
    """Write the report; with the map its pixels lie beneath, and there are the figures that are drawn over them.

    Raises
    ------
    ParameterError
        ``export.date``.
    """
    when = moment(date)
    title = one_line(survey.map.image) or "map"
    said = {"Title": title, "Creator": "Groundplan", "Producer": None, "CreationDate": when, "ModDate": when}
    # Type that programs can read back, also where a name has letters beyond Latin-1.
    with (
        style(),
        matplotlib.rc_context({"pdf.fonttype": 42}),
        whole(path) as beside,
        PdfPages(beside, metadata=said) as pages,
    ):
        for sheet in _sheets(survey, title, when, map):
            pages.savefig(sheet, dpi=DPI, bbox_inches=_report.page(sheet), facecolor="white")
    return [path]


def _sheets(survey: Survey, title: str, when: datetime, map: Map | None) -> Iterator[Figure]:
    found = places(survey)
    view = underlay(map) if map is not None else _report.bare(survey, spread(survey, found))
    small = underlay(map, longest=SMALL) if map is not None else view
    yield _report.plan(survey, view, title, f"{when:%Y-%m-%d %H:%M} UTC")
    if map is not None:
        yield directions(survey, small)
        yield radiograms(survey, small)
    if len(survey.subdivision.areas) <= MOST_FACES:
        if map is not None:
            yield subdivision_and_dual(survey, small)
        yield edge_features(survey)
        yield abstraction(survey, small)
        yield connectivity(survey, small)
    kinds = list(dict.fromkeys(place.kind for place in found))
    in_order = sorted(found, key=lambda place: (kinds.index(place.kind), place.name))
    rows = [row for place in in_order[:MOST_PLACES] for row in _rows(place, found)]
    if rows:
        left = max(0, len(found) - MOST_PLACES)
        title = f"Places; {left} more are in the table that --to csv writes" if left else "Places"
        yield from _report.tables(title, HEAD, rows, WIDTHS)
    yield from _report.warnings(survey)


def _rows(place: Place, found: list[Place]) -> list[list[str]]:
    """A place's row, and as many more as its neighbours take."""
    length = None if place.axis is None else float(shapely.LineString(place.axis).length)
    kind = f"{place.kind} ({place.use})" if place.use and place.use != place.kind else place.kind
    numbers = ["" if value is None else f"{value:.2f}" for value in (place.width, length, place.area)]
    region = "" if place.region is None else found[place.region].name
    first = [place.name, kind, *numbers, region]
    neighbours = _report.wrapped(", ".join(found[n].name for n in place.neighbours), _report.letters(WIDTHS[-1]))
    return [[*(first if n == 0 else [""] * len(first)), line] for n, line in enumerate(neighbours)]
