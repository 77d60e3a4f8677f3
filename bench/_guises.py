"""One map in other guises: the same pixels lying elsewhere, with a margin, turned by right angles, seen in a mirror."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from groundplan import Map
from groundplan.maps import UNKNOWN

Points = npt.NDArray[np.float64]

#: Where else a map's origin may lie, metres: no whole number of pixels, whatever the resolution.
ELSEWHERE = (137.3127, -58.2691)
#: Degrees by which the origin's yaw may differ.
YAW_DEG = 0.1
#: Unknown pixels beside the map: left, right, below, above.
MARGIN = (7, 3, 5, 10)
#: The name of the first of them.
AS_IT_IS = "as it is"


@dataclass(frozen=True)
class Guise:
    """A map, and where a point of it lies in the first map's own frame: metres from that one's lower left corner."""

    map: Map
    unturned: Callable[[Points], Points]

    def back(self, points: list[list[float]]) -> Points:
        """Points of the map's frame, in the first one's own."""
        x, y, yaw = self.map.origin
        turn = np.array([[math.cos(yaw), -math.sin(yaw)], [math.sin(yaw), math.cos(yaw)]])
        return self.unturned((np.array(points, dtype=float).reshape(-1, 2) - (x, y)) @ turn)


def guises(map: Map) -> dict[str, Guise]:
    """The map as it is, and its other guises by name; without a margin where no pixel's value is unknown."""
    x, y, yaw = map.origin
    wide, high = map.width * map.resolution, map.height * map.resolution

    def turned(quarters: int) -> Guise:
        pixels = np.ascontiguousarray(np.rot90(map.pixels, quarters))
        unturned: list[Callable[[Points], Points]] = [
            lambda p: p,
            lambda p: np.stack([p[:, 1], high - p[:, 0]], axis=1),
            lambda p: np.stack([wide - p[:, 0], high - p[:, 1]], axis=1),
            lambda p: np.stack([wide - p[:, 1], p[:, 0]], axis=1),
        ]
        return Guise(replace(map, pixels=pixels), unturned[quarters])

    mirrored = replace(map, pixels=np.ascontiguousarray(map.pixels[:, ::-1]))
    made = {
        AS_IT_IS: turned(0),
        "origin": Guise(replace(map, origin=(x + ELSEWHERE[0], y + ELSEWHERE[1], yaw)), lambda p: p),
        "yaw": Guise(replace(map, origin=(x, y, yaw + math.radians(YAW_DEG))), lambda p: p),
        "90": turned(1),
        "180": turned(2),
        "270": turned(3),
        "mirror": Guise(mirrored, lambda p: np.stack([wide - p[:, 0], p[:, 1]], axis=1)),
    }
    unknown = np.flatnonzero(map.states == UNKNOWN)
    if unknown.size:
        # The commonest of them, which is the ground of a map.
        counts = np.bincount(map.pixels.ravel(), minlength=256)[unknown]
        left, right, below, above = MARGIN
        margin = ((above, below), (left, right))
        pixels = np.pad(map.pixels, margin, constant_values=unknown[counts.argmax()])
        shift = np.array([left, below]) * map.resolution
        made["margin"] = Guise(replace(map, pixels=pixels), lambda p: p - shift)
    return made
