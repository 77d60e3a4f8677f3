"""Figures 4, 6, 7: the subdivision, its dual and the abstraction on the map; figure 5d: what decides a wall."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

from groundplan._results import NONE, STATES
from groundplan.figures import _style as ink
from groundplan.figures._labelled import counted, name_of
from groundplan.figures._labels import dot
from groundplan.figures._panels import blank, foot, header, map_sheet, place
from groundplan.figures._underlay import Extent, Underlay
from groundplan.survey import Survey

Floats = npt.NDArray[np.float64]

#: More shapes than this become a picture within an SVG.
MOST_SHAPES = 3000
#: Faces across the part of the map that figure 4 shows.
WINDOW_FACES = 20


def strokes(axes: Axes, segments: Floats, colour: str, width: float, zorder: float, **more: Any) -> None:
    """Many line segments, (N, 2, 2), at once."""
    heavy = len(segments) > MOST_SHAPES
    collection = LineCollection(
        list(segments), colors=colour, linewidths=width, zorder=zorder, rasterized=heavy, **more
    )
    axes.add_collection(collection, autolim=False)


def dots(axes: Axes, points: Floats, colour: str, size: float, zorder: float, marker: str = "o") -> None:
    """Many points, (N, 2), at once; size in points."""
    heavy = len(points) > MOST_SHAPES
    axes.scatter(
        points[:, 0], points[:, 1], s=size**2, c=colour, marker=marker, linewidths=0, zorder=zorder, rasterized=heavy
    )


def edge_segments(survey: Survey) -> Floats:
    """Every edge, (E, 2, 2)."""
    cut = survey.subdivision
    return cut.vertices[cut.edge_vertices].reshape(-1, 2, 2)


def link_segments(survey: Survey) -> Floats:
    """Every link from centre to centre, (K, 2, 2)."""
    return survey.subdivision.centres[survey.adjacency.faces].reshape(-1, 2, 2)


def subdivision_and_dual(survey: Survey, view: Underlay) -> Figure:
    """Figure 4: valid edges and links solid, invalid ones dashed; the busiest part where there are too many."""
    window, faces = busiest(survey, view)
    total = len(survey.subdivision.areas)
    part = counted(total, "face") if faces is None else f"the busiest part, {faces} of {total} faces"
    handles = [
        Line2D([], [], color=ink.SUBDIVISION, lw=1.8, label="Edge, cogent"),
        Line2D([], [], color=ink.SUBDIVISION, lw=0.9, ls=(0, (3, 2)), label="Edge, not cogent"),
        dot(ink.SUBDIVISION, 4, "Vertex"),
        Line2D([], [], color=ink.DUAL, lw=0.9, label="Link, connected"),
        Line2D([], [], color=ink.DUAL, lw=0.7, ls=(0, (3, 2)), label="Link, not"),
        dot(ink.DUAL, 4, "Node", "s"),
    ]
    title = "Subdivision and its dual"
    figure, axes, _ = map_sheet(view.window(window), title, [name_of(survey), part], handles)
    view.draw(axes, faint=True)
    edges, links = edge_segments(survey), link_segments(survey)
    cogent, connected = survey.walls.cogent, survey.adjacency.connected
    shown, linked = inside(edges, window), inside(links, window)
    dash = (0, (3, 2))
    strokes(axes, edges[shown & ~cogent], ink.SUBDIVISION, 0.7, 3, linestyles=[dash])
    strokes(axes, edges[shown & cogent], ink.SUBDIVISION, 1.7, 4, capstyle="round")
    strokes(axes, links[linked & ~connected], ink.DUAL, 0.55, 5, linestyles=[dash])
    strokes(axes, links[linked & connected], ink.DUAL, 0.9, 6)
    dots(axes, within(survey.subdivision.vertices, window), ink.SUBDIVISION, 3.0, 7)
    dots(axes, within(survey.subdivision.centres, window), ink.DUAL, 3.0, 8, "s")
    return figure


def inside(segments: Floats, window: Extent) -> npt.NDArray[np.bool_]:
    """Whether each segment's bounding box meets the window."""
    low, high = segments.min(axis=1), segments.max(axis=1)
    x0, x1, y0, y1 = window
    meets: npt.NDArray[np.bool_] = (high[:, 0] >= x0) & (low[:, 0] <= x1) & (high[:, 1] >= y0) & (low[:, 1] <= y1)
    return meets


def within(points: Floats, window: Extent) -> Floats:
    """The points in the window."""
    x0, x1, y0, y1 = window
    return points[(points[:, 0] >= x0) & (points[:, 0] <= x1) & (points[:, 1] >= y0) & (points[:, 1] <= y1)]


def busiest(survey: Survey, view: Underlay) -> tuple[Extent, int | None]:
    """A part of the map about twenty faces wide, and how many are in it; all, and None, where they are not more.

    It is where most connected links between free faces lie: faces of the unknown have nothing to show.
    """
    free = survey.occupancy.states == STATES.index("free")
    known = survey.occupancy.states != STATES.index("unknown")
    if known.sum() <= WINDOW_FACES**2 * 3 // 4:
        return view.extent, None
    face = math.sqrt(float(survey.subdivision.areas[known].sum()) / int(known.sum()))
    wide = min(WINDOW_FACES * face, view.size[0])
    high = min(0.75 * wide, view.size[1])
    dual = survey.adjacency
    ways = dual.connected & free[dual.faces].all(axis=1)
    middles = link_segments(survey)[ways].mean(axis=1) if ways.any() else survey.subdivision.centres[known]
    x0, x1, y0, y1 = view.extent
    steps = 24
    lefts, bottoms = np.linspace(x0, x1 - wide, steps), np.linspace(y0, y1 - high, steps)
    across = (middles[:, 0] >= lefts[:, None]) & (middles[:, 0] <= lefts[:, None] + wide)
    along = (middles[:, 1] >= bottoms[:, None]) & (middles[:, 1] <= bottoms[:, None] + high)
    counts = across.astype(np.int32) @ along.T.astype(np.int32)
    column, row = np.unravel_index(int(counts.argmax()), counts.shape)
    left, bottom = float(lefts[column]), float(bottoms[row])
    window = (left, left + wide, bottom, bottom + high)
    return window, len(within(survey.subdivision.centres, window))


def edge_features(survey: Survey) -> Figure:
    """Figure 5d: face disparity against edge occupancy, the thresholds t1 and t2, and what is a wall."""
    between = (survey.subdivision.edge_faces != NONE).all(axis=1)
    across, along = survey.occupancy.edges[between], survey.walls.disparity[between]
    cogent = survey.walls.cogent[between]
    t1, t2 = (float(survey.parameters[name]) for name in ("walls.disparity", "walls.occupancy"))
    groups = (
        ("no wall", ~cogent, ink.QUIET),
        ("separating wall", cogent & (along > t1), ink.WALL),
        ("freestanding wall", cogent & ~(along > t1), ink.FREESTANDING),
    )
    figure = blank(6.3, 6.0)
    header(figure, "Feature space of edges", [name_of(survey), counted(int(between.sum()), "inner edge")])
    axes = place(figure, 0.62, 0.8, 5.0, 4.35)
    axes.axhspan(t1, 1.1, color=ink.WALL, alpha=0.06, lw=0)
    tint = Rectangle((t2, -0.1), 1.2 - t2, t1 + 0.1, facecolor=ink.FREESTANDING, alpha=0.06, lw=0)
    axes.add_patch(tint)
    axes.axhline(t1, color=ink.WALL, lw=0.9, ls="--")
    axes.axvline(t2, color=ink.FREESTANDING, lw=0.9, ls="--")
    for _, members, colour in groups:
        axes.scatter(
            across[members],
            along[members],
            s=9,
            c=colour,
            alpha=0.45,
            linewidths=0,
            zorder=3,
            rasterized=int(members.sum()) > MOST_SHAPES // 3,
        )
    axes.set_xlim(-0.02, 1.02)
    axes.set_ylim(-0.02, 1.02)
    axes.text(1.03, t1, f"t1 = {t1:g}", va="center", color=ink.WALL)
    axes.text(t2, 1.03, f"t2 = {t2:g}", ha="center", va="bottom", color=ink.FREESTANDING)
    axes.set_xlabel("edge occupancy O(edge)")
    axes.set_ylabel("face disparity |O(f1) − O(f2)|")
    foot(figure, [dot(colour, 6, f"{name} ({int(members.sum())})".capitalize()) for name, members, colour in groups])
    return figure


def abstraction(survey: Survey, view: Underlay) -> Figure:
    """Figure 6: the walls, separating and freestanding, over the faint map."""
    segments = survey.walls.points.reshape(-1, 2, 2)
    lengths = np.hypot(*(segments[:, 1] - segments[:, 0]).T)
    freestanding = survey.walls.freestanding
    groups = (("Separating", ~freestanding, ink.WALL), ("Freestanding", freestanding, ink.FREESTANDING))
    handles = [
        Line2D([], [], color=colour, lw=1.8, label=f"{name} ({int(members.sum())})") for name, members, colour in groups
    ]
    note = [name_of(survey), counted(len(segments), "wall"), f"{float(lengths.sum()):.0f} m in all"]
    figure, axes, _ = map_sheet(view, "Abstraction", note, handles)
    view.draw(axes, faint=True)
    for _, members, colour in groups:
        strokes(axes, segments[members], colour, 1.6, 4, capstyle="round")
    return figure


def connectivity(survey: Survey, view: Underlay) -> Figure:
    """Figure 7: nodes at the centres of free faces and the connected links between them, over the subdivision."""
    handles = [
        Line2D([], [], color=ink.CORRIDOR, lw=1.2, label="Subdivision"),
        Line2D([], [], color=ink.DUAL, lw=1.4, label="Connected link"),
        dot(ink.DUAL, 4, "Free face"),
    ]
    free = survey.occupancy.states == STATES.index("free")
    links = int((survey.adjacency.connected & free[survey.adjacency.faces].all(axis=1)).sum())
    note = [name_of(survey), counted(int(free.sum()), "free face"), counted(links, "connected link")]
    figure, axes, _ = map_sheet(view, "Connectivity", note, handles)
    view.draw(axes)
    draw_subdivision(axes, survey)
    draw_connectivity(axes, survey)
    return figure


def draw_subdivision(axes: Axes, survey: Survey) -> None:
    """The lines that cut the map, thin, and faint where nothing is known on either side."""
    cut = survey.subdivision
    inner, segments = cut.edge_lines != NONE, edge_segments(survey)
    unknown = survey.occupancy.states[cut.edge_faces] == STATES.index("unknown")
    blind = (unknown | (cut.edge_faces == NONE)).all(axis=1)
    strokes(axes, segments[inner & blind], ink.CORRIDOR, 0.3, 3, alpha=0.3)
    strokes(axes, segments[inner & ~blind], ink.CORRIDOR, 0.4, 3, alpha=0.85)


def draw_connectivity(axes: Axes, survey: Survey) -> None:
    """Nodes of free faces and connected links between them, thinner where they are many."""
    free = survey.occupancy.states == STATES.index("free")
    dual = survey.adjacency
    ways = dual.connected & free[dual.faces].all(axis=1)
    light = float(np.clip(math.sqrt(600 / max(1, int(free.sum()))), 0.3, 1.0))
    strokes(axes, link_segments(survey)[ways], ink.DUAL, 1.3 * light, 4)
    dots(axes, survey.subdivision.centres[free], ink.DUAL, 3.4 * light, 5)
