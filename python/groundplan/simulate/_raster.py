"""A plan's shapes as a fine raster with its distance field, which a ray can leap through."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from groundplan.simulate._plan import GroundPlan

_MARGIN = 4  # pixels of free border, so that a ray's last step stays inside


@dataclass(frozen=True)
class World:
    """What stands where.

    Attributes
    ----------
    distance : (height, width) int16
        City-block distance from each pixel to the nearest taken one, pixels; row 0 is the lowest y.
    step : float
        Metres per pixel.
    origin : (float, float)
        Lower left corner of pixel [0, 0], metres.
    """

    distance: npt.NDArray[np.int16]
    step: float
    origin: tuple[float, float]

    def taken(self, x: float, y: float) -> bool:
        """Does something stand within a hand's breadth (0.1 m) of this point?"""
        row, column = int((y - self.origin[1]) / self.step), int((x - self.origin[0]) / self.step)
        return int(self.distance[row, column]) * self.step < 0.1


def rasterise(plan: GroundPlan, step: float = 0.02) -> World:
    """Draw every shape of the plan; a pixel is taken where its centre lies in a shape."""
    low = np.min([s.min(axis=0) for s in plan.shapes], axis=0) - _MARGIN * step
    high = np.max([s.max(axis=0) for s in plan.shapes], axis=0) + _MARGIN * step
    width, height = (int(n) + 1 for n in (high - low) / step)
    taken = np.zeros((height, width), dtype=bool)
    for shape in plan.shapes:
        first = np.maximum(((shape.min(axis=0) - low) / step).astype(int) - 1, 0)
        last = np.minimum(((shape.max(axis=0) - low) / step).astype(int) + 2, (width, height))
        x = low[0] + (np.arange(first[0], last[0]) + 0.5) * step
        y = (low[1] + (np.arange(first[1], last[1]) + 0.5) * step)[:, None]
        inside = np.ones((y.size, x.size), dtype=bool)
        for (px, py), (qx, qy) in zip(shape, np.roll(shape, -1, axis=0), strict=True):
            inside &= (qx - px) * (y - py) >= (qy - py) * (x - px)
        taken[first[1] : last[1], first[0] : last[0]] |= inside
    return World(city_block(taken), step, (float(low[0]), float(low[1])))


def city_block(taken: npt.NDArray[np.bool_]) -> npt.NDArray[np.int16]:
    """City-block distance to the nearest True, in pixels, at most 8000: two running minima along each axis."""
    distance = np.where(taken, 0, 8000).astype(np.int16)
    for axis in (0, 1):
        ramp = np.arange(taken.shape[axis], dtype=np.int16).reshape((-1, 1) if axis == 0 else (1, -1))
        ahead = np.minimum.accumulate(distance - ramp, axis=axis) + ramp
        behind = np.flip(np.minimum.accumulate(np.flip(distance + ramp, axis), axis=axis), axis) - ramp
        distance = np.minimum(ahead, behind)
    return distance
