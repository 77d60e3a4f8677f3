"""Where a simulated map is asked: its states at points, and points along a line."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from groundplan.simulate import Simulated


def states(simulated: Simulated, points: npt.NDArray[np.float64]) -> npt.NDArray[np.uint8]:
    """The map's state at points of the map frame."""
    m = simulated.map
    index = np.floor((points - np.array(m.origin[:2])) / m.resolution).astype(int)
    found: npt.NDArray[np.uint8] = m.states[m.pixels[m.height - 1 - index[:, 1], index[:, 0]]]
    return found


def along(p: list[float], q: list[float]) -> npt.NDArray[np.float64]:
    """Points from the one to the other, a decimetre apart."""
    count = max(2, int(math.dist(p, q) / 0.1))
    share = (np.arange(count)[:, None] + 0.5) / count
    points: npt.NDArray[np.float64] = np.array(p) + share * (np.array(q) - np.array(p))
    return points
