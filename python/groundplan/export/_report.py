"""Sheets of a report: all of one shape, A4 across, with the plan on the first and tables on the last."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from groundplan.export._text import one_line
from groundplan.figures._labelled import draw_found, summary
from groundplan.figures._labels import key
from groundplan.figures._panels import blank, fitted, frame, place, scale_bar, shortened
from groundplan.figures._style import HAIR, QUIET
from groundplan.figures._underlay import Underlay
from groundplan.survey import Survey

#: Inches.
WIDE, HIGH, MARGIN = 11.69, 8.27, 0.6
PLAN, HEAD, FOOT = (7.5, 6.5), 0.95, 0.45
#: A table's rows to a sheet, and inches from one to the next.
ROWS, ROW = 34, 0.18
#: The first sheet's second column: inches, and letters to a line of it.
COLUMN, LETTERS = 2.65, 44


def plan(survey: Survey, view: Underlay, title: str, date: str) -> Figure:
    """The first sheet: the plan, and beside it what is known of the map, the key and the warnings."""
    sheet = _sheet(title)
    wide, high = fitted(view, *PLAN)
    axes = place(sheet, MARGIN, FOOT + 0.2 + (PLAN[1] - high), wide, high)
    frame(axes, view.extent)
    view.draw(axes)
    draw_found(axes, survey)
    scale_bar(axes, view.extent, wide)
    for spine in axes.spines.values():
        spine.set_color(HAIR)
    left, top = WIDE - MARGIN - COLUMN, HIGH - HEAD - 0.25
    told = [date, f"origin {', '.join(f'{value:.6g}' for value in survey.map.origin)} (m, m, rad)"]
    facts = [*told, *summary(survey), f"{len(survey.walls)} walls"]
    top = _lines(sheet, left, top, "The map", facts)
    entries = key(survey)
    if entries:
        at = (left / WIDE, (top - 0.05) / HIGH)
        sheet.text(*at, "Legend", size=9, weight="bold", va="top")
        legend = {"borderpad": 0.0, "borderaxespad": 0.0, "handlelength": 1.5, "labelspacing": 0.45}
        sheet.legend(handles=entries, loc="upper left", bbox_to_anchor=(at[0], at[1] - 0.24 / HIGH), **legend)
        top -= 0.5 + 0.19 * len(entries)
    said = [one_line(f"{warning.message} [{warning.code}]") for warning in survey.warnings]
    lines = [line for text in said for line in wrapped(text, LETTERS)] or ["none"]
    room = max(1, int((top - FOOT - 0.4) / ROW))
    if len(lines) > room:
        lines = [*lines[: room - 1], "… more on the sheet of warnings"]
    _lines(sheet, left, top, "Warnings", lines)
    return sheet


def tables(title: str, head: Sequence[str], rows: Sequence[Sequence[str]], widths: Sequence[float]) -> Iterator[Figure]:
    """A table on as many sheets as it takes; `widths` of the columns in inches, those of numbers negative.

    A row whose first column is empty goes on with the one above it.
    """
    numbers = np.cumsum([bool(row[0]) for row in rows]).tolist()
    for start in range(0, max(len(rows), 1), ROWS):
        part = rows[start : start + ROWS]
        shown = numbers[start : start + ROWS]
        more = f", {shown[0]} to {shown[-1]} of {numbers[-1]}" if len(rows) > ROWS else ""
        sheet = _sheet(title + more)
        top, left = HIGH - HEAD, MARGIN
        for column, (name, width) in enumerate(zip(head, widths, strict=True)):
            right = width < 0
            x = (left + abs(width) - 0.25 if right else left) / WIDE
            side = "right" if right else "left"
            sheet.text(x, top / HIGH, name, size=8, weight="bold", ha=side, va="top")
            for n, row in enumerate(part):
                y = (top - 0.26 - n * ROW) / HIGH
                sheet.text(x, y, shortened(one_line(row[column]), letters(width)), size=8, ha=side, va="top")
            left += abs(width)
        yield sheet


def letters(width: float) -> int:
    """How many fit in a column of a table, inches."""
    return int(abs(width) / 0.078)


def warnings(survey: Survey) -> Iterator[Figure]:
    """The warnings in full."""
    lines: list[list[str]] = []
    for warning in survey.warnings:
        parts = wrapped(one_line(warning.message), 110)
        lines += [[warning.code if n == 0 else "", part] for n, part in enumerate(parts)]
    if lines:
        yield from tables("Warnings", ("Code", "What it says"), lines, (2.0, 8.4))


def page(figure: Figure) -> Bbox:
    """The paper around a figure, inches: A4 across, or as much larger as the figure needs, the figure in its middle."""
    wide, high = figure.get_size_inches()
    scale = max(1.0, wide / WIDE, high / HIGH)
    x, y = (WIDE * scale - wide) / 2, (HIGH * scale - high) / 2
    return Bbox([[-x, -y], [wide + x, high + y]])


def bare(survey: Survey, points: npt.NDArray[np.float64]) -> Underlay:
    """White paper in the map's place, as large as what was found."""
    low, high = points.min(axis=0), points.max(axis=0)
    spare = max(0.025 * float((high - low).max()), survey.map.resolution)
    x0, y0 = (float(value) for value in low - spare)
    x1, y1 = (float(value) for value in high + spare)
    side = max(x1 - x0, y1 - y0)
    white = np.ones((1, 1), np.uint8)
    return Underlay(white, 1, side, (x0, y0), (0.0, 0.0, 0.0), (x0, x1, y0, y1), points)


def _sheet(title: str) -> Figure:
    sheet = blank(WIDE, HIGH)
    sheet.text(MARGIN / WIDE, 1 - 0.45 / HIGH, shortened(one_line(title), 90), size=13, weight="bold", va="center")
    return sheet


def _lines(sheet: Figure, left: float, top: float, title: str, lines: Sequence[str]) -> float:
    """A title and lines below it; where the next may begin."""
    sheet.text(left / WIDE, top / HIGH, title, size=9, weight="bold", va="top")
    for n, line in enumerate(lines):
        y = (top - 0.24 - n * ROW) / HIGH
        sheet.text(left / WIDE, y, shortened(line, LETTERS), size=8, color=QUIET, va="top")
    return top - 0.24 - ROW * len(lines) - 0.2


def wrapped(text: str, letters: int) -> list[str]:
    """Lines of so many letters at most; one that is empty where there is no text."""
    return textwrap.wrap(text, letters) or [""]
