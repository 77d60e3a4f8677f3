"""What a grey means to map_server: three generations of one loader, three semantics.

p is the normalised darkness of a pixel, 0 white to 1 black, the other way round with `negate`.

============  ======================  ==========================  ==============================
              ros1                    nav2-humble                 nav2
============  ======================  ==========================  ==============================
colour        mean of R, G, B         mean of R, G, B             luma (Rec. 601), 8 bit
alpha         trinary: averaged in    trinary: averaged in        trinary, scale: < 255 unknown
              scale: 0 is unknown     scale: < 255 is unknown
p             float64                 float64                     float32
occupied      p > occupied_thresh     p > occupied_thresh         p >= occupied_thresh
free          p < free_thresh         p < free_thresh             p <= free_thresh
scale         1 + 98 r, truncated     100 r, half to even         100 r, half away from zero
raw           grey, flipped by negate grey, negate ignored        grey, negate ignored
============  ======================  ==========================  ==============================

with r = (p - free_thresh) / (occupied_thresh - free_thresh).

Sources: ros-planning/navigation ``image_loader.cpp``; ros-navigation/navigation2 ``map_io.cpp``, tag 1.1.18 for
nav2-humble and main of 2026 for nav2.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from groundplan.maps._map import FREE, OCCUPIED, UNKNOWN

Dialect = Literal["nav2", "nav2-humble", "ros1"]
Mode = Literal["trinary", "scale", "raw"]

DIALECTS: tuple[Dialect, ...] = ("nav2", "nav2-humble", "ros1")
MODES: tuple[Mode, ...] = ("trinary", "scale", "raw")

#: The thresholds map_saver writes; 0.196 keeps its unknown grey 205 (p = 0.19608) out of the free class.
OCCUPIED_THRESH, FREE_THRESH = 0.65, 0.196

#: From which percentage on a nav_msgs/OccupancyGrid value is occupied, and up to which it is free.
OCCUPIED_PERCENT, FREE_PERCENT = 65.0, 25.0

Bytes = npt.NDArray[np.uint8]
Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Meaning:
    """How greys are to be read: the fields of a map_server YAML that are about pixels, and the dialect."""

    dialect: Dialect = "nav2"
    mode: Mode = "trinary"
    negate: bool = False
    occupied_thresh: float = OCCUPIED_THRESH
    free_thresh: float = FREE_THRESH

    @property
    def averages_alpha(self) -> bool:
        """Whether alpha is a fourth channel of the mean."""
        return self.dialect != "nav2" and self.mode == "trinary"


def darkness(shades: Floats, meaning: Meaning) -> Floats:
    """Darkness p of each shade as the dialect computes it.

    Parameters
    ----------
    shades : (256,) float64
        Grey of each pixel value, 0 black to 255 white.
    """
    if meaning.dialect == "nav2":
        part = np.floor(shades + 0.5).astype(np.float32) / np.float32(255)
        return (part if meaning.negate else np.float32(1) - part).astype(np.float64)
    if meaning.negate:
        return shades / 255.0
    return 1.0 - shades / 255.0 if meaning.dialect == "nav2-humble" else (255.0 - shades) / 255.0


def tables(shades: Floats, meaning: Meaning) -> tuple[npt.NDArray[np.int8], Bytes]:
    """The OccupancyGrid value and the state of each pixel value.

    Returns
    -------
    values : (256,) int8
        0..100, or -1 for unknown. Raw values that an OccupancyGrid cannot hold are -1 too, in every dialect.
    states : (256,) uint8
        FREE, OCCUPIED or UNKNOWN.
    """
    if meaning.mode == "raw":
        return _raw(shades, meaning)
    p = darkness(shades, meaning)
    high, low = meaning.occupied_thresh, meaning.free_thresh
    if meaning.dialect == "nav2":
        # Eigen brings the thresholds to float32 before it compares, and compares with equality.
        high, low = float(np.float32(high)), float(np.float32(low))
        occupied, free = p >= high, p <= low
    else:
        occupied, free = p > high, p < low
    values = _scaled(p, meaning) if meaning.mode == "scale" else np.full(256, -1, np.int8)
    values[occupied] = 100
    values[free] = 0
    return values, states_of(values, OCCUPIED_PERCENT, FREE_PERCENT)


def states_of(values: npt.NDArray[np.int8], occupied_percent: float, free_percent: float) -> Bytes:
    """FREE, OCCUPIED or UNKNOWN for OccupancyGrid values, both limits included in their class."""
    states = np.full(values.shape, UNKNOWN, np.uint8)
    states[(values >= 0) & (values <= free_percent)] = FREE
    states[values >= occupied_percent] = OCCUPIED
    return states


def _scaled(p: Floats, meaning: Meaning) -> npt.NDArray[np.int8]:
    """Values between the thresholds; those beyond are set by the caller."""
    high, low = meaning.occupied_thresh, meaning.free_thresh
    if meaning.dialect == "nav2":
        part = (p.astype(np.float32) - np.float32(low)) / np.float32(high - low) * np.float32(100)
        scaled = np.floor(part.astype(np.float64) + 0.5)
    elif meaning.dialect == "nav2-humble":
        scaled = np.rint((p - low) / (high - low) * 100.0)
    else:
        scaled = np.trunc(1.0 + 98.0 * ((p - low) / (high - low)))
    return np.clip(scaled, 0, 100).astype(np.int8)


def _raw(shades: Floats, meaning: Meaning) -> tuple[npt.NDArray[np.int8], Bytes]:
    """The grey itself is the value; the thresholds are percentages of it."""
    greys = np.floor(shades + 0.5)
    if meaning.dialect == "ros1":
        greys = np.floor(255.0 - shades if meaning.negate else shades)
    values = np.where((greys >= 0) & (greys <= 100), greys, -1).astype(np.int8)
    part = values / 100.0
    states = np.full(256, UNKNOWN, np.uint8)
    if meaning.dialect == "nav2":
        free, occupied = part <= meaning.free_thresh, part >= meaning.occupied_thresh
    else:
        free, occupied = part < meaning.free_thresh, part > meaning.occupied_thresh
    states[free & (values >= 0)] = FREE
    states[occupied] = OCCUPIED
    return values, states
