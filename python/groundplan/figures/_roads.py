"""The road map over the map."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke

from groundplan.figures import _style as ink
from groundplan.figures._labelled import counted, name_of, summary
from groundplan.figures._labels import dot
from groundplan.figures._panels import map_sheet
from groundplan.figures._underlay import Underlay
from groundplan.roadmap import RoadMap
from groundplan.survey import Survey

#: Colour, size of the dot in points, and name of each kind of node.
NODES = {
    "junction": ("#0072b2", 5.0, "Junction"),
    "end": ("#70757a", 5.0, "Dead end"),
    "pick": ("#d1360f", 2.8, "Pick face"),
    "foot": ("#1f2328", 2.0, "On a lane"),
    "turn": ("#1f2328", 2.0, "Turn"),
    "door": ("#0b5cd6", 3.6, "Door"),
    "room": ("#9a5fb4", 5.0, "Room"),
}
LANES = {
    "aisle": ("#00724f", 1.1, "Lane"),
    "spur": ("#d1360f", 0.7, "Spur"),
    "door": ("#0b5cd6", 0.8, "Door lane"),
    "open": ("#8a5a2b", 0.9, "Through open space"),
}
#: With more nodes than this only junctions are named.
MANY = 150


def roads(survey: Survey, road_map: RoadMap, view: Underlay) -> tuple[Figure, float]:
    """The road map over the map, and the dots per inch that show its pixels as they are."""
    told = [*summary(survey)[:1], counted(len(road_map.nodes), "node"), counted(len(road_map.lanes), "lane")]
    figure, axes, dpi = map_sheet(view, name_of(survey), told, _key(road_map))
    view.draw(axes, faint=True)
    _draw(axes, road_map)
    return figure, dpi


def _draw(axes: Axes, road_map: RoadMap) -> None:
    for zone in road_map.zones:
        fill = ink.RACK if zone.kind == "keep-out" else ink.CORRIDOR
        area = PolyCollection([np.array(zone.ring)], facecolors=to_rgba(fill, 0.25), edgecolors=fill, lw=0.5, zorder=2)
        axes.add_collection(area, autolim=False)
    for kind, (colour, width, _) in LANES.items():
        chosen = [lane for lane in road_map.lanes if lane.kind == kind]
        lines = [np.array([road_map.nodes[lane.start].at, road_map.nodes[lane.end].at]) for lane in chosen]
        axes.add_collection(LineCollection(lines, colors=colour, linewidths=width, zorder=5), autolim=False)
        for lane, line in zip(chosen, lines, strict=True):
            if lane.way != "both":
                a, b = line if lane.way == "forward" else line[::-1]
                arrow = {"arrowstyle": "-|>", "color": colour, "lw": 0, "mutation_scale": 7}
                axes.annotate("", a + 0.6 * (b - a), a + 0.4 * (b - a), arrowprops=arrow, zorder=5)
    for kind, (colour, size, _) in NODES.items():
        points = np.array([node.at for node in road_map.nodes if node.kind == kind]).reshape(-1, 2)
        axes.plot(*points.T, ls="", marker="o", ms=size, mfc=colour, mec="white", mew=0.3, zorder=6)
    named = ("junction", "end", "room", "door") if len(road_map.nodes) <= MANY else ("junction", "room")
    for node in road_map.nodes:
        if node.kind in named:
            seam = [withStroke(linewidth=1.2, foreground=(1, 1, 1, 0.85))]
            axes.annotate(
                node.name,
                node.at,
                xytext=(3.5, 3),
                textcoords="offset points",
                size=5,
                color=ink.INK,
                zorder=8,
                path_effects=seam,
            )


def _key(road_map: RoadMap) -> list[Artist]:
    entries: list[Artist] = []
    for kind, (colour, width, name) in LANES.items():
        if count := sum(lane.kind == kind for lane in road_map.lanes):
            entries.append(Line2D([], [], color=colour, lw=width + 0.6, label=f"{name} ({count})"))
    for kind, (colour, size, name) in NODES.items():
        if count := sum(node.kind == kind for node in road_map.nodes):
            entries.append(dot(colour, size + 1, f"{name} ({count})"))
    if count := sum(zone.kind == "keep-out" for zone in road_map.zones):
        entries.append(
            Patch(facecolor=to_rgba(ink.RACK, 0.25), edgecolor=ink.RACK, lw=0.6, label=f"Keep-out ({count})")
        )
    return entries
