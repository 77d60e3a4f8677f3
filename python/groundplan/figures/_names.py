"""Names on a figure: where a centre line has room for one, and no two over one another."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.path import Path
from matplotlib.patheffects import withStroke

from groundplan._results import Label
from groundplan._shapes import readable
from groundplan.figures import _style as ink

Points = npt.NDArray[np.float64]
#: Puts a name on what it is written on: the place, the name, its size in points, colour, zorder and degrees.
Put = Callable[[Sequence[float] | Points, str, float, str, float, float], None]

#: Width of a letter and height of a line to the size of the type.
LETTER, LINE = 0.66, 1.0
#: Points between two names.
CLEAR = 1.5
#: Sizes of type along a corridor or a rack, points: it is left out where even the least does not fit.
LEAST_TYPE, GREATEST_TYPE = 4.5, 9.0
#: So much of the width the type takes, and the least type so much at most: capitals and digits are lower than a line.
SHARE, MOST = 0.62, 0.8
#: Of a region's name, the second where the first does not fit.
REGION_TYPE = (6.5, 5.0)


class Names:
    """Writes names, and knows where something stands already; `dots` are points of type to a metre."""

    def __init__(self, dots: float, put: Put) -> None:
        self.dots, self.put = dots, put
        self.taken: list[tuple[float, float, float, float]] = []

    def box(
        self, at: Sequence[float] | Points, wide: float, high: float, angle: float = 0.0
    ) -> tuple[float, float, float, float]:
        """Least and greatest x and y, points, of what is so many points wide and high about a place."""
        cos, sin = abs(math.cos(math.radians(angle))), abs(math.sin(math.radians(angle)))
        x, y = float(at[0]) * self.dots, float(at[1]) * self.dots
        half, rise = (wide * cos + high * sin) / 2, (wide * sin + high * cos) / 2
        return x - half, x + half, y - rise, y + rise

    def take(self, at: Sequence[float] | Points, wide: float, high: float, angle: float = 0.0) -> None:
        """Nothing more is to be written there."""
        self.taken.append(self.box(at, wide, high, angle))

    def fits(self, at: Sequence[float] | Points, text: str, size: float) -> bool:
        """Whether nothing stands where the name would."""
        x0, x1, y0, y1 = self.box(at, LETTER * size * len(text) + 2 * CLEAR, LINE * size + CLEAR)
        return all(x1 <= a0 or a1 <= x0 or y1 <= b0 or b1 <= y0 for a0, a1, b0, b1 in self.taken)

    def write(
        self, at: Sequence[float] | Points, text: str, size: float, colour: str, zorder: float, angle: float = 0.0
    ) -> None:
        """Write centred on a place, turned by so many degrees, with a light seam that keeps it legible on anything."""
        self.take(at, LETTER * size * len(text), LINE * size, angle)
        self.put(at, text, size, colour, zorder, angle)


def on_axes(axes: Axes) -> Put:
    """Puts names on axes."""

    def put(at: Sequence[float] | Points, text: str, size: float, colour: str, zorder: float, angle: float) -> None:
        seam = [withStroke(linewidth=max(1.2, 0.28 * size), foreground=(1, 1, 1, 0.85))]
        axes.text(
            at[0],
            at[1],
            # Half a letter has no shape.
            text.encode(errors="replace").decode(),
            size=size,
            color=colour,
            ha="center",
            va="center_baseline",
            rotation=angle,
            rotation_mode="anchor",
            zorder=zorder,
            clip_on=True,
            path_effects=seam,
        )

    return put


def meetings(line: Points, others: Sequence[Points]) -> Points:
    """Where a centre line crosses others, (N, 2)."""
    ends = np.array([[other[0], other[-1]] for other in others])
    start, along = line[0], line[-1] - line[0]
    theirs, apart = ends[:, 1] - ends[:, 0], ends[:, 0] - start
    turn = along[0] * theirs[:, 1] - along[1] * theirs[:, 0]
    some = np.abs(turn) > 1e-9
    theirs, apart, turn = theirs[some], apart[some], turn[some]
    mine = (apart[:, 0] * theirs[:, 1] - apart[:, 1] * theirs[:, 0]) / turn
    other = (apart[:, 0] * along[1] - apart[:, 1] * along[0]) / turn
    both = (mine >= 0) & (mine <= 1) & (other >= 0) & (other <= 1)
    points: Points = start + mine[both, None] * along
    return points


def widest_gap(line: Points, crossings: Points, near: float) -> tuple[Points, float]:
    """Where along a centre line a name has most room between crossings: the place, and the room in metres."""
    start, along = line[0], line[-1] - line[0]
    length = float(np.hypot(*along))
    if length == 0:
        return start, 0.0
    unit = along / length
    relative = crossings - start
    at, aside = relative @ unit, relative @ np.array([-unit[1], unit[0]])
    on = at[(np.abs(aside) <= near) & (at > -near) & (at < length + near)]
    stops = np.sort(np.concatenate([[0.0], np.clip(on, 0, length), [length]]))
    gaps = np.diff(stops)
    # Of gaps about as wide as the widest, the one nearest the middle: names in a row of aisles then line up.
    middles = (stops[1:] + stops[:-1]) / 2
    wide = gaps >= 0.85 * gaps.max()
    best = np.flatnonzero(wide)[np.argmin(np.abs(middles[wide] - length / 2))]
    return start + middles[best] * unit, float(gaps[best])


def name_corridors(corridors: Sequence[Label], junctions: Sequence[Label], names: Names) -> None:
    """Names along the centre lines, where these have most room between crossings."""
    lines = [np.asarray(corridor["axis"], dtype=np.float64) for corridor in corridors]
    crossings = np.array([label["at"] for label in junctions], dtype=np.float64).reshape(-1, 2)
    for corridor, line in zip(corridors, lines, strict=True):
        stops = np.concatenate([crossings, meetings(line, lines)])
        _name_along(corridor, line, *widest_gap(line, stops, 0.75 * corridor["width"]), ink.CORRIDOR_INK, names)


def name_racks(racks: Sequence[Label], names: Names) -> None:
    """Names along the racks that have room for them."""
    for rack in racks:
        if "axis" in rack and "width" in rack:
            line = np.asarray(rack["axis"], dtype=np.float64)
            _name_along(rack, line, line.mean(axis=0), float(np.hypot(*(line[-1] - line[0]))), ink.INK, names)


def _name_along(label: Label, line: Points, at: Points, room: float, colour: str, names: Names) -> None:
    """The name of what is as wide as it says, at a place of its centre line with so much room, metres."""
    name = label.get("name")
    if not name:
        return
    wide = label["width"] * names.dots
    high = max(SHARE * wide, min(LEAST_TYPE, MOST * wide))
    size = min(high, room * names.dots / (0.72 * len(name)), GREATEST_TYPE)
    if size >= LEAST_TYPE:
        angle = math.degrees(math.atan2(*(line[-1] - line[0])[::-1]))
        names.write(at, name, size, colour, 7, readable(angle))


def name_regions(regions: Sequence[Label], corridors: Sequence[Label], names: Names) -> None:
    """Names where there is room for them, those of large regions first; a way goes by the names of its corridors."""
    middles = np.array([np.mean(corridor["axis"], axis=0) for corridor in corridors]).reshape(-1, 2)
    line = 1.15 * REGION_TYPE[0] / names.dots
    aside = [
        (line * far * x, line * far * y) for far in (1, 2, 4, 8, 16) for x, y in ((0, 1), (0, -1), (2, 0), (-2, 0))
    ]
    for region in sorted(regions, key=lambda region: -float(region.get("area", 0))):
        name, inside = region.get("name"), closed(np.asarray(region["polygon"], dtype=np.float64))
        if not name or (region.get("use") == "corridor" and inside.contains_points(middles).any()):
            continue
        holes = [closed(np.asarray(hole, dtype=np.float64)) for hole in region.get("holes", [])]
        x, y = region["at"]
        others = [(x + dx, y + dy) for dx, dy in aside]
        free = (at for at in others if inside.contains_point(at) and not any(h.contains_point(at) for h in holes))
        # The place that it has is in it; another has to be.
        places = [(x, y), *free]
        room = ((at, size) for size in REGION_TYPE for at in places if names.fits(at, name, size))
        if found := next(room, None):
            names.write(found[0], name, found[1], ink.INK, 8)


def closed(ring: Points) -> Path:
    """A ring as a path."""
    return Path(np.concatenate([ring, ring[:1]]), closed=True)
