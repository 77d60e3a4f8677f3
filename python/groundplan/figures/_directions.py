"""Figure 2, the histogram of oriented gradients; figure 3, the radiograms."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from matplotlib.transforms import Affine2D

from groundplan._results import Radiogram
from groundplan.figures import _style as ink
from groundplan.figures._labelled import counted, degrees, name_of
from groundplan.figures._panels import LEFT, RIGHT, blank, fitted, header, map_panel, place, scale_bar
from groundplan.figures._underlay import Underlay
from groundplan.survey import Survey

Floats = npt.NDArray[np.float64]

#: Width of the Gaussian that the histogram's curve is smoothed with, degrees.
SMOOTHING_DEG = 1.0
#: At most so many directions have their radiogram drawn.
MOST_RADIOGRAMS = 4


def directions(survey: Survey, view: Underlay) -> Figure:
    """Figure 2: the map with its directions, and the histogram that they were found from."""
    beside = view.size[0] < 1.7 * view.size[1]
    wide, high = fitted(view, *((4.6, 4.6) if beside else (9.4, 4.2)))
    plot = (4.4, max(2.6, high)) if beside else (wide, 2.4)
    if beside:
        # Room for the scale bar below the map's name.
        figure = blank(LEFT + wide + 0.75 + plot[0] + RIGHT, max(high, plot[1]) + 1.3)
        axes = map_panel(figure, view, LEFT, 0.45 + max(0.0, plot[1] - high), wide)
        chart = place(figure, LEFT + wide + 0.75, 0.45, *plot)
    else:
        figure = blank(LEFT + wide + RIGHT, high + plot[1] + 1.6)
        axes = map_panel(figure, view, LEFT, plot[1] + 0.9, wide)
        chart = place(figure, LEFT, 0.45, *plot)
    count = counted(len(survey.directions), "dominant direction")
    header(figure, f"{count} from oriented gradients".capitalize(), [name_of(survey)])
    view.draw(axes)
    scale_bar(axes, view.extent, wide)
    compass(axes, view, survey.directions.angles)
    histogram(chart, survey)
    return figure


def compass(axes: Axes, view: Underlay, angles: Floats) -> None:
    """The directions as strokes through a disc, in the corner of the map where least is known."""
    x0, x1, y0, y1 = view.extent
    radius = 0.09 * min(view.size)
    right, up = emptiest_corner(view)
    centre = np.array(
        [x1 - 1.5 * radius if right else x0 + 1.5 * radius, y1 - 1.5 * radius if up else y0 + 1.5 * radius]
    )
    axes.add_patch(Circle((centre[0], centre[1]), 1.2 * radius, facecolor=(1, 1, 1, 0.85), edgecolor=ink.HAIR, lw=0.6))
    for number, angle in enumerate(angles):
        arm = radius * np.array([math.cos(angle), math.sin(angle)])
        ends = np.stack([centre - arm, centre + arm])
        axes.plot(*ends.T, color=ink.colour(number), lw=2.2, solid_capstyle="round", zorder=9)


def emptiest_corner(view: Underlay) -> tuple[bool, bool]:
    """Whether the corner of the picture with least in it is a right one, and an upper one."""
    rows, columns = view.ranks.shape
    share = {
        (right, up): float(
            (view.ranks[_part(rows, not up), _part(columns, right)] > 0).mean() if view.ranks.size else 0.0
        )
        for right in (False, True)
        for up in (False, True)
    }
    return min(share, key=share.__getitem__)


def _part(length: int, last: bool) -> slice:
    """The first or the last quarter."""
    quarter = max(1, length // 4)
    return slice(length - quarter, length) if last else slice(0, quarter)


def histogram(axes: Axes, survey: Survey) -> None:
    """The histogram over degrees, smoothed, its peaks as dots and the directions as lines."""
    values = survey.directions.histogram
    axes.set_xlim(-90, 90)
    axes.set_xticks(range(-90, 91, 30), [f"{d}°".replace("-", "−") for d in range(-90, 91, 30)])
    axes.set_xlabel("direction of the lines that the gradients stand for")
    axes.set_ylabel("weight, share of the greatest")
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    top = 1.0
    if len(values) and values.max() > 0:
        step = 180 / len(values)
        at = -90 + step * (np.arange(len(values)) + 0.5)
        curve = smoothed(values, SMOOTHING_DEG / step)
        # One greatest for both: a narrow peak loses height when it is smoothed, and the curve says how much.
        top = float(curve.max())
        axes.fill_between(at, np.minimum(values / top, 1.12), step="mid", color=ink.HAIR, alpha=0.6, lw=0)
        axes.plot(at, curve / top, color=ink.INK, lw=1.1)
        peaks = (curve > np.roll(curve, 1)) & (curve >= np.roll(curve, -1)) & (curve > 0.25 * top)
        axes.plot(at[peaks], curve[peaks] / top, "o", color=ink.INK, ms=3.2)
    else:
        axes.text(0, 0.5, "no oriented gradients", ha="center", color=ink.QUIET)
    axes.set_ylim(0, 1.12)
    for number, angle in enumerate(np.degrees(survey.directions.angles)):
        axes.axvline(angle, color=ink.colour(number), lw=1.4, zorder=1)
        left = angle > 84
        axes.annotate(
            degrees(math.radians(angle)),
            (angle, 1.11),
            xytext=(-2 if left else 2, 0),
            textcoords="offset points",
            rotation=90,
            ha="right" if left else "left",
            va="top",
            color=ink.colour(number),
            weight="bold",
            size=7.5,
        )


def smoothed(values: Floats, sigma: float) -> Floats:
    """The histogram of undirected angles, its ends joined, under a Gaussian of so many bins."""
    reach = min(len(values) // 2, math.ceil(4 * sigma))
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
    ring = np.concatenate([values[len(values) - reach :], values, values[:reach]])
    return np.convolve(ring, kernel / kernel.sum(), mode="valid")


def radiograms(survey: Survey, view: Underlay) -> Figure:
    """Figure 3: for each direction the map turned upright along it, the lines through it and the radiogram above."""
    shown = survey.radiograms[:MOST_RADIOGRAMS]
    if not shown:
        figure = blank(6, 2)
        header(figure, "No direction, no radiogram", [name_of(survey)])
        return figure
    columns = min(2, len(shown))
    box_wide, box_high, chart, gap = 4.7, 4.7, 1.25, 0.75
    turns = [upright(survey.directions.angles[r.direction]) for r in shown]
    windows = [view.turned_extent(turn) for turn, _ in turns]
    sizes = [fitted(view.window(window), box_wide, box_high) for window in windows]
    rows = [sizes[start : start + columns] for start in range(0, len(shown), columns)]
    heights = [max(high for _, high in row) + chart + 0.85 for row in rows]
    widths = [max(row[column][0] for row in rows if column < len(row)) for column in range(columns)]
    figure = blank(max(4.5, LEFT + sum(widths) + gap * (columns - 1) + RIGHT), sum(heights) + 0.65)
    more = f", the first {len(shown)} of {len(survey.radiograms)}" if len(survey.radiograms) > len(shown) else ""
    header(figure, f"Radiograms along each direction{more}", [name_of(survey)])
    top = sum(heights)
    for number, (radiogram, (turn, side), window, (wide, high)) in enumerate(
        zip(shown, turns, windows, sizes, strict=True)
    ):
        row, column = divmod(number, columns)
        left = LEFT + sum(widths[:column]) + gap * column
        ceiling = top - sum(heights[:row]) - 0.3
        above = place(figure, left, ceiling - chart, wide, chart)
        below = place(figure, left, ceiling - chart - 0.05 - high, wide, high)
        signal(above, survey, radiogram, side, window)
        through(below, survey, view, radiogram, turn, side, window)
    return figure


def upright(angle: float) -> tuple[Affine2D, int]:
    """The lesser turn that puts a direction upright, and whether offsets then grow to the right (1) or left (-1)."""
    side = 1 if angle < 0 else -1
    return Affine2D().rotate(-side * math.pi / 2 - angle), side


def signal(
    axes: Axes, survey: Survey, radiogram: Radiogram, side: int, window: tuple[float, float, float, float]
) -> None:
    """The radiogram with its peaks."""
    colour = ink.colour(radiogram.direction)
    at, values = side * radiogram.offsets, radiogram.values
    axes.fill_between(at, values, step="mid", color=colour, alpha=0.35, lw=0, rasterized=len(at) > 20_000)
    offsets = survey.lines.offsets[survey.lines.directions == radiogram.direction]
    if len(values):
        heights = np.interp(offsets, radiogram.offsets, values)
        axes.plot(side * offsets, heights, "o", color=colour, ms=2.6, mec="white", mew=0.3, zorder=3)
        axes.vlines(side * offsets, 0, heights, color=colour, lw=0.7)
        axes.set_ylim(0, 1.12 * max(float(values.max()), 1e-9))
    axes.set_xlim(window[0], window[1])
    axes.tick_params(bottom=False, labelbottom=False, length=2.5, pad=2)
    axes.locator_params(axis="y", nbins=3)
    axes.set_ylabel("structure, m", size=7)
    angle = degrees(survey.directions.angles[radiogram.direction])
    axes.set_title(f"Along {angle}: {counted(len(offsets), 'line')}", color=colour, weight="bold", pad=4)
    for place_ in ("top", "right"):
        axes.spines[place_].set_visible(False)


def through(
    axes: Axes,
    survey: Survey,
    view: Underlay,
    radiogram: Radiogram,
    turn: Affine2D,
    side: int,
    window: tuple[float, float, float, float],
) -> None:
    """The map turned, with the lines dropped through it."""
    axes.set_autoscale_on(False)
    axes.set_xlim(window[0], window[1])
    axes.set_ylim(window[2], window[3])
    view.draw(axes, turn=turn)
    axes.set_aspect("auto")
    at = side * survey.lines.offsets[survey.lines.directions == radiogram.direction]
    segments = [((x, window[2]), (x, window[3])) for x in at.tolist()]
    colour = ink.colour(radiogram.direction)
    axes.add_collection(LineCollection(segments, colors=colour, linewidths=0.7, alpha=0.75, zorder=2), autolim=False)
    axes.xaxis.set_major_formatter(lambda x, _: f"{side * x + 0.0:g}".replace("-", "−"))
    axes.set_xlabel("offset, m", size=7, labelpad=1)
    axes.tick_params(left=False, labelleft=False, length=2.5, pad=2)
