"""The map beneath a figure: cropped to what is known, small enough to draw, its thin walls kept."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.transforms import Affine2D

from groundplan.figures._style import FREE, OCCUPIED, UNKNOWN
from groundplan.maps import Map
from groundplan.maps import _map as states

#: Least x, greatest x, least y, greatest y, metres.
Extent = tuple[float, float, float, float]
#: A picture of a map has at most so many pixels on its long side.
LONGEST = 2400
# In a block of pixels the highest rank is seen: a wall one pixel wide outlives any reduction.
RANKS = {states.UNKNOWN: 0, states.FREE: 1, states.OCCUPIED: 2}
COLOURS = (np.array([to_rgb(c) for c in (UNKNOWN, FREE, OCCUPIED)]) * 255).round().astype(np.uint8)
BAND_ROWS = 1024
#: Of the known pixels, this share may lie outside of what is shown, on each side.
SPECKS = 2e-4


@dataclass(frozen=True)
class Underlay:
    """The known part of a map, as a picture in the map frame.

    Attributes
    ----------
    ranks : (rows, columns) uint8
        0 unknown, 1 free, 2 occupied, top row first; each stands for ``block`` x ``block`` pixels.
    block : int
    resolution : float
        Metres per pixel of the map, not of this picture.
    corner : (float, float)
        Lower left corner of the picture on the grid, metres, before the origin's pose.
    origin : (float, float, float)
        Pose of the grid in the map frame: m, m, rad.
    extent : Extent
        Least x, greatest x, least y, greatest y to show, metres in the map frame.
    outline : (N, 2) float64
        Points in the map frame that hold all that is known between them.
    """

    ranks: npt.NDArray[np.uint8]
    block: int
    resolution: float
    corner: tuple[float, float]
    origin: tuple[float, float, float]
    extent: Extent
    outline: npt.NDArray[np.float64]

    @property
    def size(self) -> tuple[float, float]:
        """Width and height to show, metres."""
        return self.extent[1] - self.extent[0], self.extent[3] - self.extent[2]

    @property
    def pose(self) -> Affine2D:
        """From metres on the grid to metres in the map frame."""
        x, y, yaw = self.origin
        return Affine2D().rotate(yaw).translate(x, y)

    def draw(self, axes: Axes, *, faint: bool = False, turn: Affine2D | None = None) -> None:
        """Draw the picture in the map frame, or in that frame turned. Faint is for what is drawn over it."""
        colours = COLOURS if not faint else (255 - (255 - COLOURS.astype(np.float64)) * 0.42).round().astype(np.uint8)
        pixel = self.block * self.resolution
        rows, columns = self.ranks.shape
        left, bottom = self.corner
        pose = self.pose + turn if turn is not None else self.pose
        axes.set_facecolor(colours[0] / 255)
        axes.imshow(
            colours[self.ranks],
            extent=(left, left + columns * pixel, bottom, bottom + rows * pixel),
            transform=pose + axes.transData,
            interpolation="auto",
            zorder=0,
        )

    def window(self, extent: Extent) -> Underlay:
        """The same picture, another part of it shown."""
        return replace(self, extent=extent)

    def turned_extent(self, turn: Affine2D, margin: float = 0.02) -> Extent:
        """What to show of the picture when the map frame is turned."""
        x0, x1, y0, y1 = box(turn.transform(self.outline))
        spare = margin * max(x1 - x0, y1 - y0)
        return x0 - spare, x1 + spare, y0 - spare, y1 + spare


def underlay(map: Map, longest: int = LONGEST, margin: float = 0.025) -> Underlay:
    """The known part of `map` with a margin (a share of its long side), at most `longest` pixels long."""
    table = np.zeros(256, dtype=np.uint8)
    for state, rank in RANKS.items():
        table[map.states == state] = rank
    top, bottom, first, last = known(map, table)
    left, right = int(first.min()), int(last.max())
    longer = max(bottom - top, right - left)
    block = max(1, math.ceil(longer / longest))
    spare = max(1, round(margin * longer / block)) * block
    # In the margin the map goes on, whole blocks away from what is known.
    above, before = (min(spare, start // block * block) for start in (top, left))
    window = map.pixels[top - above : bottom + spare, left - before : right + spare]
    ranks = reduced(window, table, block)
    # The picture hangs from its top left corner: its last row and column may stand out over the map's.
    corner = (left - before) * map.resolution, (map.height - top + above - len(ranks) * block) * map.resolution
    edge = outline(map, first, last, top)
    x0, x1, y0, y1 = box(edge)
    # As many whole blocks as it takes, so that a block of the picture can be a whole number of dots.
    step, spare_m = block * map.resolution, spare * map.resolution
    wide, high = (math.ceil((size + 2 * spare_m) / step - 1e-6) * step for size in (x1 - x0, y1 - y0))
    west, south = x0 - spare_m, y1 + spare_m - high
    extent = (west, west + wide, south, south + high)
    return Underlay(ranks, block, map.resolution, corner, map.origin, extent, edge)


def known(map: Map, table: npt.NDArray[np.uint8]) -> tuple[int, int, npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Rows of the map with known pixels, and in each of them the first known column and that after the last.

    Known are free pixels and the sides of what is occupied: a map may be black all around. A few specks far out do not
    count. Without any known pixel it is the whole map. Rows between that hold none are given as empty in the middle.
    """
    first, last = np.full(map.height, map.width, dtype=np.int64), np.zeros(map.height, dtype=np.int64)
    in_row, in_column = np.zeros(map.height, dtype=np.int64), np.zeros(map.width, dtype=np.int64)
    for start in range(0, map.height, BAND_ROWS):
        ranks = table[map.pixels[start : start + BAND_ROWS]]
        seen, changes = ranks == RANKS[states.FREE], ranks[:, 1:] != ranks[:, :-1]
        taken = ranks == RANKS[states.OCCUPIED]
        seen[:, 1:] |= changes & taken[:, 1:]
        seen[:, :-1] |= changes & taken[:, :-1]
        some = seen.any(axis=1)
        band = slice(start, start + len(seen))
        first[band] = np.where(some, seen.argmax(axis=1), map.width)
        last[band] = np.where(some, map.width - seen[:, ::-1].argmax(axis=1), 0)
        in_row[band] = seen.sum(axis=1)
        in_column += seen.sum(axis=0)
    if not in_row.any():
        return 0, map.height, np.zeros(map.height, np.int64), np.full(map.height, map.width, np.int64)
    (top, bottom), (left, right) = without_specks(in_row), without_specks(in_column)
    first, last = np.maximum(first, left)[top:bottom], np.minimum(last, right)[top:bottom]
    empty = first >= last
    return top, bottom, np.where(empty, map.width, first), np.where(empty, 0, last)


def without_specks(counts: npt.NDArray[np.int64]) -> tuple[int, int]:
    """From and to of what counts: outside, to either side, lies less than a `SPECKS` share of all."""
    sums, least = counts.cumsum(), int(SPECKS * counts.sum())
    return int(np.searchsorted(sums, least, side="right")), int(np.searchsorted(sums, sums[-1] - least)) + 1


def outline(map: Map, first: npt.NDArray[np.int64], last: npt.NDArray[np.int64], top: int) -> npt.NDArray[np.float64]:
    """Corners of the first and the last known pixel of each row, (N, 2), metres in the map frame."""
    rows = np.flatnonzero(last > 0)
    upper = map.height - top - rows
    ends = np.concatenate([first[rows], last[rows]]).astype(np.float64)
    corners = np.concatenate(
        [np.column_stack([ends, np.tile(upper, 2)]), np.column_stack([ends, np.tile(upper - 1, 2)])]
    )
    x, y, yaw = map.origin
    cos, sin = math.cos(yaw), math.sin(yaw)
    placed: npt.NDArray[np.float64] = corners * map.resolution @ np.array([[cos, sin], [-sin, cos]]) + (x, y)
    return placed


def box(points: npt.NDArray[np.float64]) -> Extent:
    """The points' bounding box."""
    low, high = points.min(axis=0), points.max(axis=0)
    return float(low[0]), float(high[0]), float(low[1]), float(high[1])


def reduced(pixels: npt.NDArray[np.uint8], table: npt.NDArray[np.uint8], block: int) -> npt.NDArray[np.uint8]:
    """Ranks of the pixels, the highest of each block, block row by block row."""
    if block == 1:
        return table[pixels]
    height, width = pixels.shape
    columns = np.arange(0, width, block)
    starts = range(0, height, block)
    out = np.empty((len(starts), len(columns)), dtype=np.uint8)
    for row, start in enumerate(starts):
        out[row] = np.maximum.reduceat(table[pixels[start : start + block]].max(axis=0), columns)
    return out
