"""Sheets of paper and the maps on them: sizes in inches, axes in metres of the map frame."""

from __future__ import annotations

import math
from collections.abc import Sequence

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from groundplan.figures._style import HAIR, INK, QUIET
from groundplan.figures._underlay import LONGEST, Extent, Underlay

#: Inches: the long side of a map on a sheet of its own, and the paper around it.
LONG_SIDE = 9.0
LEFT, RIGHT, HEAD, FOOT, ENTRY_ROW, ENTRY = 0.52, 0.18, 0.62, 0.3, 0.19, 1.32
NARROWEST = 3.6


def blank(width: float, height: float) -> Figure:
    """An empty sheet, inches."""
    return Figure(figsize=(width, height), facecolor="white")


def place(figure: Figure, left: float, bottom: float, width: float, height: float) -> Axes:
    """Axes at a place on the sheet, inches from its lower left corner."""
    w, h = figure.get_size_inches()
    return figure.add_axes((left / w, bottom / h, width / w, height / h))


def header(figure: Figure, title: str, note: Sequence[str] = ()) -> None:
    """A short title, and a quiet line below it, at the sheet's upper left.

    The title is cut where the sheet ends; of the line, as many parts are written as fit beside a scale bar.
    """
    width, height = figure.get_size_inches()
    room = width - LEFT - RIGHT
    figure.text(LEFT / width, 1 - 0.24 / height, shortened(title, int(room / 0.1)), size=11, weight="bold", va="center")
    line = ""
    for part in note:
        longer = f"{line} · {part}" if line else part
        if len(longer) * 0.06 > room - 1.5 and line:
            break
        line = longer
    figure.text(LEFT / width, 1 - 0.44 / height, line, size=7.5, color=QUIET, va="center")


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


def scale_bar(axes: Axes, extent: Extent, width: float, beyond: float = 0.0) -> None:
    """A bar of a round number of metres above the upper right corner.

    `width` is the axes', and `beyond` how far to the right of them the bar ends, both in inches.
    """
    shown = extent[1] - extent[0]
    share = max(0.45 / width, min(0.22, 1.3 / width))
    length = round_length(share * shown)
    share = length / shown
    height = axes.get_window_extent().height / axes.figure.dpi
    right, at, tick = 1 + beyond / width, 1 + 0.075 / height, 0.03 / height
    x = [right - share, right - share, right, right]
    y = [at + tick, at, at, at + tick]
    axes.add_line(Line2D(x, y, transform=axes.transAxes, color=INK, lw=1.2, clip_on=False, solid_joinstyle="miter"))
    middle, above = right - share / 2, at + 0.04 / height
    axes.text(middle, above, f"{length:g} m", transform=axes.transAxes, size=7, ha="center", va="bottom")


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
            ncols=min(len(handles), entries_in_row(width)),
            borderpad=0.3,
            borderaxespad=0,
            handlelength=1.5,
            handletextpad=0.5,
            columnspacing=1.4,
            labelspacing=0.35,
        )


def foot_height(width: float, handles: Sequence[Artist]) -> float:
    """Inches below the axes of a sheet so many inches wide: ticks and legend."""
    rows = math.ceil(len(handles) / entries_in_row(width))
    return FOOT + (rows * ENTRY_ROW + 0.02 if rows else 0)


def entries_in_row(width: float) -> int:
    """Entries of a legend that stand side by side on a sheet so many inches wide."""
    return max(1, int((width - LEFT) / ENTRY))


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
    # Paper in whole dots, too: else the map's edge falls between two of them.
    left, below, above = (round(part * dpi) / dpi for part in (LEFT, below, HEAD))
    paper = tuple(math.ceil(part * dpi - 1e-6) / dpi for part in (sheet_width, below + height + above))
    figure = blank(*paper)
    axes = place(figure, left, below, width, height)
    frame(axes, view.extent)
    header(figure, title, note)
    scale_bar(axes, view.extent, width, sheet_width - LEFT - width - RIGHT)
    foot(figure, handles)
    for spine in axes.spines.values():
        spine.set_color(HAIR)
    return figure, axes, dpi


def map_panel(figure: Figure, view: Underlay, left: float, bottom: float, width: float, title: str = "") -> Axes:
    """A map on a sheet with others, `width` inches wide, its title above it."""
    axes = place(figure, left, bottom, width, width * view.size[1] / view.size[0])
    frame(axes, view.extent)
    if title:
        axes.set_title(title, pad=4)
    return axes


def fitted(view: Underlay, width: float, height: float) -> tuple[float, float]:
    """Width and height of a map in a box of inches, its shape kept."""
    scale = min(width / view.size[0], height / view.size[1])
    return view.size[0] * scale, view.size[1] * scale
