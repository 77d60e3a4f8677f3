"""What the map's pixels say of lanes: how near the next occupied one is, and where the posts of racks stand."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from groundplan.maps import Map
from groundplan.maps._map import FREE, OCCUPIED
from groundplan.roadmap._model import Point

Floats = npt.NDArray[np.float64]

#: What a lane keeps from every occupied pixel, metres.
CLEAR_M = 0.4
#: Pixels are looked at along a lane in pieces of this length, metres: a slanted lane's box would be the whole map.
PIECE_M = 8.0


class Pixels:
    """The occupied pixels of a map, asked for beside lines."""

    def __init__(self, map: Map) -> None:
        self.map = map
        x, y, yaw = map.origin
        self.corner, self.cos, self.sin = (x, y), math.cos(yaw), math.sin(yaw)
        #: From a pixel's middle to its farthest corner.
        self.half = map.resolution / math.sqrt(2)

    def beside(self, a: Point, b: Point, reach: float) -> tuple[Floats, Floats]:
        """Of the occupied pixels within a reach of the line from a to b: how far along it, and to its left."""
        length = math.dist(a, b)
        u, v = ((b[0] - a[0]) / length, (b[1] - a[1]) / length) if length else (1.0, 0.0)
        parts = []
        for p, q in _pieces(a, b):
            x, y = self._middles(p, q, reach)
            s, d = (x - a[0]) * u + (y - a[1]) * v, (y - a[1]) * u - (x - a[0]) * v
            near = (np.abs(d) <= reach) & (s >= -reach) & (s <= length + reach)
            parts.append(np.column_stack([s[near], d[near]]))
        found = np.unique(np.concatenate(parts), axis=0)  # neighbouring pieces share some
        return found[:, 0], found[:, 1]

    def clearance(self, points: Sequence[Point], reach: float = 2 * CLEAR_M) -> float:
        """From a line to the nearest occupied pixel, as far as the reach."""
        nearest = reach
        for a, b in itertools.pairwise(points):
            s, d = self.beside(a, b, reach)
            beyond = np.maximum(np.maximum(-s, s - math.dist(a, b)), 0.0)
            nearest = min(nearest, float(np.hypot(d, beyond).min(initial=reach)) - self.half)
        return nearest

    def keep(self, width: float, vehicle: float | None) -> float:
        """What a lane has to keep from occupied pixels where the way is so wide; less where a vehicle fits there."""
        if vehicle is None:
            return CLEAR_M
        return max(vehicle / 2, min(CLEAR_M, width / 2 - 2 * self.half))

    def nearest(self, a: Point, b: Point, reach: float) -> Point:
        """The occupied pixel nearest to a line, of those within a reach."""
        s, d = self.beside(a, b, reach)
        length = math.dist(a, b)
        n = int(np.argmin(np.hypot(d, np.maximum(np.maximum(-s, s - length), 0.0))))
        u, v = ((b[0] - a[0]) / length, (b[1] - a[1]) / length) if length else (1.0, 0.0)
        return float(a[0] + s[n] * u - d[n] * v), float(a[1] + s[n] * v + d[n] * u)

    def open(self, points: Sequence[Point], keep: float = CLEAR_M) -> bool:
        """Whether a line keeps so far from every occupied pixel."""
        # A pixel is near by its corner, and found by its middle: where pixels are wide, twice as far is not far enough.
        return self.clearance(points, max(2 * keep, keep + 2 * self.half)) >= keep

    def free(self, a: Point, b: Point) -> bool:
        """Whether all pixels under a line are known to be free."""
        steps = np.linspace(0.0, 1.0, math.ceil(math.dist(a, b) / self.map.resolution) + 1)[:, None]
        grid = np.floor((self._grid(a) + steps * np.subtract(self._grid(b), self._grid(a))) / self.map.resolution)
        columns, rows = grid[:, 0].astype(int), self.map.height - 1 - grid[:, 1].astype(int)
        if min(columns.min(), rows.min()) < 0 or columns.max() >= self.map.width or rows.max() >= self.map.height:
            return False
        return bool((self.map.states[self.map.pixels[rows, columns]] == FREE).all())

    def _middles(self, a: Point, b: Point, reach: float) -> tuple[Floats, Floats]:
        """The middles of the occupied pixels in the box round a piece of a line, metres in the map frame."""
        map, step = self.map, self.map.resolution
        grid = np.array([self._grid(p) for p in (a, b)]) / step
        low, high = np.floor(grid.min(0) - reach / step), np.ceil(grid.max(0) + reach / step)
        left, right = (int(np.clip(value, 0, map.width)) for value in (low[0], high[0]))
        bottom, top = (int(np.clip(value, 0, map.height)) for value in (low[1], high[1]))
        box = map.pixels[map.height - top : map.height - bottom, left:right]
        rows, columns = np.nonzero(map.states[box] == OCCUPIED)
        along, up = (left + columns + 0.5) * step, (top - 0.5 - rows) * step
        x = self.corner[0] + along * self.cos - up * self.sin
        y = self.corner[1] + along * self.sin + up * self.cos
        return x, y

    def _grid(self, point: Point) -> Point:
        """A point of the map frame in metres along the grid's rows and up its columns."""
        dx, dy = point[0] - self.corner[0], point[1] - self.corner[1]
        return dx * self.cos + dy * self.sin, dy * self.cos - dx * self.sin


def _pieces(a: Point, b: Point) -> Iterator[tuple[Point, Point]]:
    count = max(1, math.ceil(math.dist(a, b) / PIECE_M))
    points = [(a[0] + n / count * (b[0] - a[0]), a[1] + n / count * (b[1] - a[1])) for n in range(count + 1)]
    return itertools.pairwise(points)
