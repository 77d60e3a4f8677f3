"""Labels on a map: ways and crossings, racks, regions, doors and pillars, each kind drawn when it is there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PathCollection, PolyCollection
from matplotlib.colors import to_rgba
from matplotlib.font_manager import FontProperties
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path
from matplotlib.textpath import TextPath
from matplotlib.transforms import IdentityTransform

from groundplan._results import UNSURE, Label
from groundplan.figures import _style as ink
from groundplan.figures._names import Names, closed, name_corridors, name_racks, name_regions, on_axes
from groundplan.survey import Survey

Points = npt.NDArray[np.float64]

JUNCTION_NAMES = {"X": "X junction", "T": "T junction", "L": "L corner", "Y": "Y junction", "end": "Dead end"}


def draw_labels(axes: Axes, survey: Survey) -> None:
    """Draw every label, the large beneath the small; those that are unsure are pale."""
    kinds = {kind: survey.of_kind(kind) for kind in ("region", "rack", "corridor", "junction", "door", "pillar")}
    names = Names(points_per_metre(axes), on_axes(axes))
    draw_regions(axes, kinds["region"])
    draw_racks(axes, kinds["rack"])
    draw_doors(axes, kinds["door"], survey)
    draw_pillars(axes, kinds["pillar"])
    draw_junctions(axes, kinds["junction"], kinds["corridor"], names)
    draw_corridors(axes, kinds["corridor"], kinds["junction"], survey.labels)
    name_corridors(kinds["corridor"], kinds["junction"], names)
    name_racks(kinds["rack"], names)
    name_regions(kinds["region"], kinds["corridor"], names)


def draw_walls(axes: Axes, survey: Survey, width: float = 1.1) -> None:
    """Draw the abstraction in one colour."""
    segments = survey.walls.points.reshape(-1, 2, 2)
    axes.add_collection(
        LineCollection(list(segments), colors=ink.WALL, linewidths=width, capstyle="round", zorder=4), autolim=False
    )


def key(survey: Survey) -> list[Artist]:
    """What a legend says of the labels and walls that there are, with counts."""
    entries: list[Artist] = []
    if len(survey.walls):
        entries.append(Line2D([], [], color=ink.WALL, lw=1.6, label="Wall"))
    fills = (("corridor", "Corridor", ink.CORRIDOR, 0.35), ("rack", "Rack", ink.RACK, 0.55))
    for kind, name, fill, alpha in (*fills, ("region", "Region", ink.REGION, 0.25)):
        if count := len(survey.of_kind(kind)):
            patch = Patch(facecolor=to_rgba(fill, alpha), edgecolor=fill, lw=0.8, label=f"{name} ({count})")
            entries.append(patch)
    for kind, fill in ink.JUNCTIONS.items():
        if count := sum(label["type"] == kind for label in survey.of_kind("junction")):
            marker = "s" if kind == "end" else "o"
            entries.append(dot(fill, 6 if kind == "end" else 7, f"{JUNCTION_NAMES[kind]} ({count})", marker))
    if count := len(survey.of_kind("door")):
        entries.append(Line2D([], [], color=ink.DOOR, lw=3, solid_capstyle="butt", label=f"Door ({count})"))
    if count := len(survey.of_kind("pillar")):
        entries.append(dot(ink.PILLAR, 4, f"Pillar ({count})"))
    if count := sum(map(is_pale, survey.labels)):
        entries.append(
            Patch(facecolor="none", edgecolor=ink.QUIET, lw=0.8, ls=":", label=f"Pale or hollow: unsure ({count})")
        )
    return entries


def dot(fill: str, size: float, label: str, marker: str = "o") -> Line2D:
    """A dot for a legend."""
    return Line2D([], [], marker=marker, ls="", color=fill, markersize=size, markeredgewidth=0, label=label)


def points_per_metre(axes: Axes) -> float:
    """Points of type to a metre of the map."""
    low, high = axes.get_xlim()
    box = axes.get_window_extent()
    return float(box.width / axes.figure.dpi * 72 / (high - low))


def draw_regions(axes: Axes, regions: Sequence[Label]) -> None:
    """Thin outlined tints, holes left out."""
    for number, region in enumerate(regions):
        # What winds the other way is left out of the tint.
        holes = [wound(hole, -1) for hole in region.get("holes", [])]
        path = Path.make_compound_path(*(closed(ring) for ring in (wound(region["polygon"], 1), *holes)))
        fill = ink.REGIONS[number % len(ink.REGIONS)]
        tint, edge = (0.07, 0.4) if is_pale(region) else (0.2, 0.8)
        patch = PathPatch(path, facecolor=to_rgba(fill, tint), edgecolor=to_rgba(fill, edge), lw=0.5, zorder=1)
        axes.add_patch(patch)


def wound(ring: Sequence[Sequence[float]], side: int) -> Points:
    """A ring counter-clockwise (1) or clockwise (-1), (N, 2)."""
    points = np.asarray(ring, dtype=np.float64)
    x, y = points.T
    doubled_area = float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
    return points if doubled_area * side >= 0 else points[::-1]


def is_pale(label: Label) -> bool:
    """Whether a label is drawn so because it is unsure."""
    return bool(label.get("confidence", 1.0) <= UNSURE)


def draw_racks(axes: Axes, racks: Sequence[Label]) -> None:
    """Ochre polygons with a thin edge."""
    shown = [label for label in racks if label.get("polygon")]
    collection = PolyCollection(
        [np.asarray(label["polygon"]) for label in shown],
        facecolors=[to_rgba(ink.RACK, 0.15 if is_pale(label) else 0.5) for label in shown],
        edgecolors=[to_rgba(ink.RACK, 0.9)],
        linewidths=0.5,
        zorder=2,
    )
    axes.add_collection(collection, autolim=False)


def draw_corridors(axes: Axes, corridors: Sequence[Label], junctions: Sequence[Label], labels: Sequence[Label]) -> None:
    """Translucent polygons with their centre lines, and corners: the corridors that end there end in their middle."""
    unsure = [corridor for corridor in corridors if is_pale(corridor)]
    sure = [corridor for corridor in corridors if not is_pale(corridor)]
    pale = {n for n, label in enumerate(labels) if is_pale(label)}
    corners = [label for label in junctions if pale.isdisjoint(label.get("corridors", ()))]
    _draw_ways(axes, unsure, unsure, 0.08, 0.45)
    _draw_ways(axes, sure, [*sure, *corners], 0.24, 0.95)


def _draw_ways(axes: Axes, corridors: Sequence[Label], filled: Sequence[Label], tint: float, line: float) -> None:
    """Corridors with so deep a tint, and centre lines as deep as that."""
    # One shape for them all: where two cross, the tint is no deeper.
    tinted = [closed(wound(label["polygon"], 1)) for label in filled if label.get("polygon")]
    if not corridors:
        return
    if tinted:
        fill = to_rgba(ink.CORRIDOR, tint)
        axes.add_patch(PathPatch(Path.make_compound_path(*tinted), facecolor=fill, edgecolor="none", lw=0, zorder=3))
    outlines = [closed(np.asarray(label["polygon"])).vertices for label in corridors if label.get("polygon")]
    edge = to_rgba(ink.CORRIDOR, 0.6)
    axes.add_collection(LineCollection(outlines, colors=[edge], linewidths=0.4, zorder=3.1), autolim=False)
    lines = [np.asarray(corridor["axis"], dtype=np.float64) for corridor in corridors]
    style = LineCollection(lines, colors=[to_rgba(ink.CORRIDOR, line)], linewidths=0.8, linestyles="--", zorder=5)
    axes.add_collection(style, autolim=False)


def draw_junctions(axes: Axes, junctions: Sequence[Label], corridors: Sequence[Label], names: Names) -> None:
    """Discs in the colour of their type, with its letter where there is room."""
    widths = [corridor["width"] for corridor in corridors] or [2.5]
    size = float(np.clip(0.7 * np.quantile(widths, 0.75) * names.dots, 4.5, 11.0))
    for label in junctions:
        names.take(label["at"], size, size)
    for kind, fill in ink.JUNCTIONS.items():
        for pale in (False, True):
            own = [label["at"] for label in junctions if label["type"] == kind and is_pale(label) == pale]
            if own:
                inks = ("white", fill) if pale else (fill, "white")
                _draw_crossings(axes, np.array(own, dtype=np.float64), kind, size, inks)


def _draw_crossings(axes: Axes, at: Points, kind: str, size: float, inks: tuple[str, str]) -> None:
    """Those of one type: the ink that fills them, and that of their edges and letters."""
    fill, edge = inks
    if kind == "end":
        axes.scatter(
            at[:, 0], at[:, 1], s=(0.7 * size) ** 2, c=fill, marker="s", edgecolors=edge, linewidths=0.6, zorder=9
        )
        return
    axes.scatter(at[:, 0], at[:, 1], s=size**2, c=fill, edgecolors=edge, linewidths=0.6, zorder=9)
    if size >= 6:
        letter = PathCollection(
            [centred(kind)],
            sizes=[(0.62 * size) ** 2],
            offsets=at,
            offset_transform=axes.transData,
            facecolors=edge,
            linewidths=0,
            zorder=10,
        )
        # Its size alone scales it; the offsets place it.
        letter.set_transform(IdentityTransform())
        axes.add_collection(letter, autolim=False)


def centred(letter: str) -> Path:
    """A bold letter about the origin, one unit high."""
    path = TextPath((0, 0), letter, size=1, prop=FontProperties(family="DejaVu Sans", weight="bold"))
    low, high = path.vertices.min(axis=0), path.vertices.max(axis=0)
    return Path((path.vertices - (low + high) / 2) / (high[1] - low[1]), path.codes)


def draw_doors(axes: Axes, doors: Sequence[Label], survey: Survey) -> None:
    """Short thick strokes along the wall that each is in."""
    strokes = []
    for door in doors:
        at = np.asarray(door["at"], dtype=np.float64)
        along = door_direction(door, at, survey) * max(float(door["width"]), 1e-6) / 2
        strokes.append(np.stack([at - along, at + along]))
    inks = [to_rgba(ink.DOOR, 0.4 if is_pale(door) else 1.0) for door in doors]
    axes.add_collection(LineCollection(strokes, colors=inks, linewidths=2.4, capstyle="butt", zorder=6), autolim=False)


def door_direction(door: Label, at: Points, survey: Survey) -> Points:
    """Unit vector along the opening.

    That of its own axis where it has one, else of the nearest wall, else across the way from region to region.
    """
    along = np.array([1.0, 0.0])
    if "axis" in door:
        along = np.subtract(door["axis"][1], door["axis"][0])
    elif len(survey.walls):
        ends = survey.walls.points.reshape(-1, 2, 2)
        walls = ends[:, 1] - ends[:, 0]
        share = np.einsum("ij,ij->i", at - ends[:, 0], walls) / np.maximum(np.einsum("ij,ij->i", walls, walls), 1e-12)
        nearest = ends[:, 0] + np.clip(share, 0, 1)[:, None] * walls
        along = walls[np.argmin(np.hypot(*(nearest - at).T))]
    else:
        sides = [survey.labels[i]["at"] for i in door.get("between", []) if i is not None and "at" in survey.labels[i]]
        if len(sides) == 2:
            way = np.subtract(sides[1], sides[0])
            along = np.array([-way[1], way[0]])
        # Regions seldom face each other squarely: the door is along what the map is along.
        angles = survey.directions.angles
        if len(angles):
            lines = np.column_stack([np.cos(angles), np.sin(angles)])
            along = lines[np.argmax(np.abs(lines @ along))]
    length = float(np.hypot(*along))
    return along / length if length > 0 else np.array([1.0, 0.0])


def draw_pillars(axes: Axes, pillars: Sequence[Label]) -> None:
    """Small dots."""
    at = np.array([pillar["at"] for pillar in pillars], dtype=np.float64).reshape(-1, 2)
    inks = [("white", ink.PILLAR) if is_pale(pillar) else (ink.PILLAR, "white") for pillar in pillars]
    fills, edges = zip(*inks, strict=True) if inks else ((), ())
    axes.scatter(at[:, 0], at[:, 1], s=9, c=fills, edgecolors=edges, linewidths=0.4, zorder=8)
