"""A way over the map."""

from __future__ import annotations

from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from groundplan._queries import Route
from groundplan.figures import _style as ink
from groundplan.figures._labelled import name_of
from groundplan.figures._labels import points_per_metre
from groundplan.figures._panels import map_sheet
from groundplan.figures._underlay import Underlay
from groundplan.survey import Survey

WAY, BAND = "#d1360f", "#f2b8a6"


def route(survey: Survey, way: Route, view: Underlay) -> tuple[Figure, float]:
    """The way as a line, and what it keeps clear as a band about it; dots per inch as `map_sheet` has them."""
    handles = [
        Line2D([], [], color=WAY, lw=1.4, marker="o", markersize=2.5, label="The way and its bends"),
        Line2D([], [], color=BAND, lw=6, solid_capstyle="butt", label=f"Kept clear: {way.clearance:g} m to both sides"),
    ]
    note = [f"{way.length:.1f} m", f"{len(way.points)} points", f"{len(way.faces)} faces"]
    figure, axes, dpi = map_sheet(view, f"A way through {name_of(survey)}", note, handles)
    view.draw(axes)
    x, y = way.points.T
    wide = 2 * way.clearance * points_per_metre(axes)
    axes.plot(x, y, color=BAND, lw=wide, solid_capstyle="round", solid_joinstyle="round", alpha=0.8, zorder=3)
    axes.plot(x, y, color=WAY, lw=1.4, marker="o", markersize=2, zorder=4)
    axes.plot(x[[0, -1]], y[[0, -1]], ls="", marker="o", markersize=6, color=WAY, mec=ink.FREE, mew=1, zorder=5)
    return figure, dpi
