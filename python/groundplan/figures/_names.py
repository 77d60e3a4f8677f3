"""Names on a figure: where a centre line has room for one, and no two over one another."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.patheffects import withStroke

Points = npt.NDArray[np.float64]
#: Puts a name on what it is written on: the place, the name, its size in points, colour, zorder and degrees.
Put = Callable[[Sequence[float] | Points, str, float, str, float, float], None]

#: Width of a letter and height of a line to the size of the type.
LETTER, LINE = 0.66, 1.0
#: Points between two names.
CLEAR = 1.5


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
            text,
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
