"""Sheets of paper and the maps on them: sizes in inches, axes in metres of the map frame."""

from __future__ import annotations

import math
from collections.abc import Sequence

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.lines import Line2D
from matplotlib.textpath import TextPath
from matplotlib.ticker import MaxNLocator

from groundplan.figures._style import HAIR, INK, QUIET
from groundplan.figures._underlay import LONGEST, Extent, Underlay

#: Inches: the long side of a map on a sheet of its own, and the paper around it.
LONG_SIDE = 9.0
LEFT, RIGHT, HEAD, FOOT, ENTRY_ROW, ENTRY = 0.52, 0.18, 0.62, 0.3, 0.19, 1.32
#: Of the lines below a title: points, and inches from one to the next.
NOTE_SIZE, NOTE_ROW = 7.5, 0.15
NARROWEST = 3.6


def blank(width: float, height: float) -> Figure:
    """An empty sheet, inches."""
    return Figure(figsize=(width, height), facecolor="white")


def place(figure: Figure, left: float, bottom: float, width: float, height: float) -> Axes:
    """Axes at a place on the sheet, inches from its lower left corner."""
    w, h = figure.get_size_inches()
    return figure.add_axes((left / w, bottom / h, width / w, height / h))


def header(figure: Figure, title: str, note: Sequence[str] = ()) -> None:
    """A short title, cut where the sheet ends, and quiet lines below it, at the sheet's upper left."""
    width, height = figure.get_size_inches()
    room = width - LEFT - RIGHT
    figure.text(LEFT / width, 1 - 0.24 / height, shortened(title, int(room / 0.1)), size=11, weight="bold", va="center")
    for row, line in enumerate(note_lines(note, width)):
        down = 0.44 + row * NOTE_ROW
        figure.text(LEFT / width, 1 - down / height, line, size=NOTE_SIZE, color=QUIET, va="center")


def note_lines(note: Sequence[str], width: float) -> list[str]:
    """The parts of a note in as many lines as it takes on a sheet so many inches wide."""
    lines: list[str] = []
    room = width - LEFT - RIGHT
    for part in (shortened(part, int(room / 0.055)) for part in note):
        longer = f"{lines[-1]} · {part}" if lines else part
        if lines and text_width(longer) <= room:
            lines[-1] = longer
        else:
            lines.append(part)
    return lines


def text_width(text: str) -> float:
    """Inches that a line of a note takes."""
    return (
        float(TextPath((0, 0), text, size=NOTE_SIZE, prop=FontProperties(family="DejaVu Sans")).get_extents().width)
        / 72
    )


def shortened(text: str, length: int) -> str:
    """At most `length` characters, the end replaced by an ellipsis."""
    return text if len(text) <= length else text[: max(1, length - 1)].rstrip() + "…"


def frame(axes: Axes, extent: Extent) -> None:
    """Make axes a window on the map frame, with light ticks in metres."""
    # The limits hold whatever is drawn: aspect is the sheet's affair, which has the right shape already.
    axes.set_autoscale_on(False)
    axes.set_aspect("auto")
    axes.set_xlim(extent[0], extent[1])
    axes.set_ylim(extent[2], extent[3])
    box = axes.get_window_extent()
    dots = axes.figure.dpi
    for axis, inches in ((axes.xaxis, box.width / dots), (axes.yaxis, box.height / dots)):
        axis.set_major_locator(MaxNLocator(nbins=max(1, min(10, int(inches / 0.55))), steps=[1, 2, 5, 10]))
        axis.set_major_formatter("{x:g}")
    axes.tick_params(length=2.5, pad=2)


def scale_bar(axes: Axes, extent: Extent, width: float) -> None:
    """A bar of a round number of metres above the upper right corner of axes so many inches wide."""
    length = bar_length(extent, width)
    share = length / (extent[1] - extent[0])
    height = axes.get_window_extent().height / axes.figure.dpi
    at, tick = 1 + 0.075 / height, 0.03 / height
    x = [1 - share, 1 - share, 1, 1]
    y = [at + tick, at, at, at + tick]
    axes.add_line(Line2D(x, y, transform=axes.transAxes, color=INK, lw=1.2, clip_on=False, solid_joinstyle="miter"))
    middle, above = 1 - share / 2, at + 0.04 / height
    axes.text(middle, above, f"{length:g} m", transform=axes.transAxes, size=7, ha="center", va="bottom")


def bar_length(extent: Extent, width: float) -> float:
    """Metres of the scale bar above axes so many inches wide."""
    return round_length(max(0.45 / width, min(0.22, 1.3 / width)) * (extent[1] - extent[0]))


def round_length(length: float) -> float:
    """The longest of 1, 2, 5, 10, ... not over `length`."""
    power = 10.0 ** math.floor(math.log10(length))
    return next(step * power for step in (5, 2, 1) if step * power <= length * 1.0001 or step == 1)


def foot(figure: Figure, handles: Sequence[Artist], left: float = LEFT) -> None:
    """A legend in rows along the foot of the sheet."""
    if handles:
        width, height = figure.get_size_inches()
        figure.legend(
            handles=list(handles),
            loc="lower left",
            bbox_to_anchor=(left / width, 0.02 / height),
            ncols=math.ceil(len(handles) / legend_rows(width, handles)),
            borderpad=0.3,
            borderaxespad=0,
            handlelength=1.5,
            handletextpad=0.5,
            columnspacing=1.4,
            labelspacing=0.35,
        )


def foot_height(width: float, handles: Sequence[Artist]) -> float:
    """Inches below the axes of a sheet so many inches wide: ticks and legend."""
    rows = legend_rows(width, handles)
    return FOOT + (rows * ENTRY_ROW + 0.02 if rows else 0)


def legend_rows(width: float, handles: Sequence[Artist]) -> int:
    """Rows that a legend takes on a sheet so many inches wide."""
    return math.ceil(len(handles) / max(1, int((width - LEFT) / ENTRY)))


def map_sheet(view: Underlay, title: str, note: Sequence[str], handles: Sequence[Artist]) -> tuple[Figure, Axes, float]:
    """A sheet with one map, its title, its scale and its legend: figure, axes, and the dots per inch to save it with.

    A pixel of the map becomes a whole number of dots, or a whole number of its pixels one dot, so that a PNG shows
    the map as it is.
    """
    wide, high = view.size
    long_side = max(wide, high)
    pixels = long_side / (view.block * view.resolution)
    dots = pixels * max(1, math.floor(LONGEST / pixels))
    dpi = dots / LONG_SIDE
    scale = LONG_SIDE / long_side
    width, height = wide * scale, high * scale
    sheet_width = max(NARROWEST, LEFT + width + RIGHT)
    below = foot_height(sheet_width, handles)
    head = head_height(note, sheet_width, width - bar_length(view.extent, width) * scale)
    # Paper in whole dots, too: else the map's edge falls between two of them.
    left, below, above = (round(part * dpi) / dpi for part in (LEFT, below, head))
    paper = tuple(math.ceil(part * dpi - 1e-6) / dpi for part in (sheet_width, below + height + above))
    figure = blank(*paper)
    axes = place(figure, left, below, width, height)
    frame(axes, view.extent)
    header(figure, title, note)
    scale_bar(axes, view.extent, width)
    foot(figure, handles)
    for spine in axes.spines.values():
        spine.set_color(HAIR)
    return figure, axes, dpi


def head_height(note: Sequence[str], width: float, room: float) -> float:
    """Inches above the axes of a sheet so many inches wide: title, note and scale bar.

    The bar has a row of its own where the last line of the note does not fit into the room left of it.
    """
    lines = note_lines(note, width)
    alone = bool(lines) and text_width(lines[-1]) + 0.2 > room
    return HEAD + NOTE_ROW * (max(0, len(lines) - 1) + alone)


def map_panel(
    figure: Figure, view: Underlay, left: float, bottom: float, width: float, title: str = "", lift: float = 0.0
) -> Axes:
    """A map on a sheet with others, `width` inches wide, its title above it, lifted by so many inches."""
    axes = place(figure, left, bottom, width, width * view.size[1] / view.size[0])
    frame(axes, view.extent)
    if title:
        axes.set_title(title, pad=4 + 72 * lift)
    return axes


def fitted(view: Underlay, width: float, height: float) -> tuple[float, float]:
    """Width and height of a map in a box of inches, its shape kept."""
    scale = min(width / view.size[0], height / view.size[1])
    return view.size[0] * scale, view.size[1] * scale
