"""The straightened map: the grid turned so that the strongest direction is the x axis, and the turn both ways.

A robot drives and plans in it as in any map; poses go from one map into the other by the transforms beside it.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from groundplan._errors import FormatError
from groundplan.export import _grids
from groundplan.export._grids import BAND_ROWS, FREE, OCCUPIED, UNKNOWN, Bytes, Frame
from groundplan.maps import _map as states

if TYPE_CHECKING:
    from groundplan.maps import Map
    from groundplan.survey import Survey

Floats = npt.NDArray[np.float64]
GREYS = {states.FREE: FREE, states.OCCUPIED: OCCUPIED, states.UNKNOWN: UNKNOWN}


def write(survey: Survey, path: Path, map: Map | None = None) -> list[Path]:
    """Write the turned grid, trinary, and the transforms as JSON.

    Raises
    ------
    FormatError
        ``export.straight`` for a survey without a direction.
    """
    assert map is not None
    if not len(survey.directions):
        raise FormatError("export.straight", "the map has no direction that could be made the x axis")
    angle = float(survey.directions.angles[0])
    pixels, frame = straightened(map, angle)
    yaml, pgm = _grids.names(path)
    transforms = yaml.with_suffix(".json")
    said = _transforms(angle, survey.map.image, pgm.name)
    bands = (pixels[row : row + BAND_ROWS] for row in range(0, frame.height, BAND_ROWS))
    return _grids.write(path, frame, bands, beside={transforms: json.dumps(said, indent=2) + "\n"})


def straightened(map: Map, angle: float) -> tuple[Bytes, Frame]:
    """The map turned by -`angle` about the map frame's (0, 0), as greys, the top row first, and where it lies.

    A pixel has the state of the place in the map on which its centre falls, and is occupied besides where an occupied
    pixel's centre, or the middle between two that touch, falls into it. Sampling alone would tear walls one pixel
    thick; so they stay whole, and no wall grows by more than the pixel in which its own middle lies. What no pixel of
    the map covers is unknown; rows and columns at the sides that hold nothing known are left away.
    """
    x, y, yaw = map.origin
    cos, sin = math.cos(angle), math.sin(angle)
    at = x * cos + y * sin, y * cos - x * sin
    frame = _grids.turned(map.width, map.height, map.resolution, at, yaw - angle)
    # Where the grid's corner lies among the new pixels, and the turn between the two lattices.
    corner = np.subtract(at, frame.origin) / map.resolution
    turn = np.array([[math.cos(yaw - angle), -math.sin(yaw - angle)], [math.sin(yaw - angle), math.cos(yaw - angle)]])
    greys = np.full(256, UNKNOWN, np.uint8)
    for state, grey in GREYS.items():
        greys[map.states == state] = grey
    made = np.full((frame.height, frame.width), UNKNOWN, np.uint8)  # the bottom row first until the end
    for row in range(0, frame.height, BAND_ROWS):
        band = made[row : row + BAND_ROWS]
        band[:] = _sampled(map, greys, row, band.shape, turn, corner)
    for points in _solid(map, turn):
        columns, rows = np.floor(points @ turn.T + corner).astype(np.int64).T
        made[np.clip(rows, 0, frame.height - 1), np.clip(columns, 0, frame.width - 1)] = OCCUPIED
    return _trimmed(made, frame)


def _sampled(map: Map, greys: Bytes, row: int, shape: tuple[int, ...], turn: Floats, corner: Floats) -> Bytes:
    """Rows of the new grid from one on, from the bottom: what lies in the map under the middle of each pixel."""
    height, width = shape
    column, line = np.arange(width) + 0.5 - corner[0], np.arange(row, row + height) + 0.5 - corner[1]
    u = np.floor(turn[0, 0] * column + turn[1, 0] * line[:, None]).astype(np.int64)
    v = np.floor(turn[0, 1] * column + turn[1, 1] * line[:, None]).astype(np.int64)
    inside = (u >= 0) & (u < map.width) & (v >= 0) & (v < map.height)
    found = np.full(shape, UNKNOWN, np.uint8)
    found[inside] = greys[map.pixels[map.height - 1 - v[inside], u[inside]]]
    return found


def _solid(map: Map, turn: Floats) -> Iterator[Floats]:
    """Points (N, 2) in pixels of the map, y up, that are occupied whatever the turn: in bands of rows."""
    for top in range(0, map.height, BAND_ROWS):
        # One row more, for what touches the band's last.
        taken = map.states[map.pixels[top : top + BAND_ROWS + 1]] == states.OCCUPIED
        own = taken[:BAND_ROWS]
        above, below = taken[:-1], taken[1:]
        falling, rising = above[:, :-1] & below[:, 1:], above[:, 1:] & below[:, :-1]
        # Two that touch at a corner alone may come to lie two pixels apart.
        corner = (falling & rising) | (falling & _parted(turn, 1.0, -1.0)) | (rising & _parted(turn, 1.0, 1.0))
        for mask, across, down in (
            (own, 0.5, 0.5),
            (own[:, :-1] & own[:, 1:], 1.0, 0.5),
            (above & below, 0.5, 1.0),
            (corner, 1.0, 1.0),
        ):
            rows, columns = np.nonzero(mask)
            yield np.column_stack([columns + across, map.height - top - rows - down])


def _parted(turn: Floats, across: float, up: float) -> bool:
    """Whether pixels so far apart can come to lie in pixels that do not touch."""
    return bool(np.abs(turn @ (across, up)).max() > 1.0 + _grids.NEAR)


def _trimmed(made: Bytes, frame: Frame) -> tuple[Bytes, Frame]:
    """The grid, the top row first, without unknown rows and columns at its sides."""
    known = made != UNKNOWN
    rows, columns = (np.flatnonzero(known.any(axis=axis)) for axis in (1, 0))
    if not len(rows):
        return made[::-1], frame
    bottom, top, left, right = int(rows[0]), int(rows[-1]) + 1, int(columns[0]), int(columns[-1]) + 1
    x, y = (round(frame.origin[k] + by * frame.resolution, 9) for k, by in enumerate((left, bottom)))
    return made[bottom:top, left:right][::-1], Frame(right - left, top - bottom, frame.resolution, (x, y))


def _transforms(angle: float, image: str, straight: str) -> dict[str, object]:
    """Both ways: a point (x, y) goes to ``matrix`` times (x, y, 1), a heading grows by ``yaw``."""

    def way(turn: float) -> dict[str, object]:
        cos, sin = math.cos(turn), math.sin(turn)
        return {"x": 0.0, "y": 0.0, "yaw": turn, "matrix": [[cos, -sin, 0.0], [sin, cos, 0.0]]}

    return {
        "map": image,
        "straight": straight,
        "units": {"length": "m", "angle": "rad"},
        "about": [0.0, 0.0],
        "direction": angle,
        "map_to_straight": way(-angle),
        "straight_to_map": way(angle),
    }
