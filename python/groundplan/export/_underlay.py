"""The map as a picture to draw over: PNG, which CAD programs and browsers read."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image

from groundplan.maps._map import FREE, OCCUPIED, UNKNOWN

if TYPE_CHECKING:
    from groundplan.maps import Map

Point = tuple[float, float]
#: Greys that let a drawing over them be seen.
GREYS = {FREE: 255, UNKNOWN: 225, OCCUPIED: 90}


def write(map: Map, path: Path) -> None:
    """Write the map's picture, a pixel for a pixel, top row first."""
    table = np.zeros(256, dtype=np.uint8)
    for state, grey in GREYS.items():
        table[map.states == state] = grey
    Image.fromarray(table[map.pixels], mode="L").save(path, format="PNG", optimize=False, compress_level=6)


def corners(map: Map) -> list[Point]:
    """The map's corners in the map frame, the lower left first, counter-clockwise."""
    return rectangle(map.width * map.resolution, map.height * map.resolution, map.origin)


def rectangle(width: float, height: float, pose: tuple[float, float, float]) -> list[Point]:
    """The corners of a rectangle whose lower left one is at a pose."""
    x, y, yaw = pose
    cos, sin = math.cos(yaw), math.sin(yaw)
    grid = ((0.0, 0.0), (width, 0.0), (width, height), (0.0, height))
    return [(x + u * cos - v * sin, y + u * sin + v * cos) for u, v in grid]
