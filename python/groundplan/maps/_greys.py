"""What the greys of a picture mean where the thresholds do not say it: unknown read as free, walls drawn in grey.

Everything here looks at the histogram over *levels*: darkness p in 255 steps, 0 the whitest grey and 255 the blackest
(the other way round for a negated map). A *spike* is a narrow peak; a smooth occupancy probability has none besides
its ends and its unknown.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from groundplan.maps._map import FREE, OCCUPIED, UNKNOWN

Floats = npt.NDArray[np.float64]
Bytes = npt.NDArray[np.uint8]

#: Greys that map writers use for unknown: 205 of map_saver, 128 and 127 of Cartographer and CARMEN.
WRITTEN_UNKNOWN = (205, 128, 127)

#: Half width of a spike, and how far around it must be nearly empty. JPEG spreads a spike by about two levels.
SPIKE, AROUND = 2, 12

#: Least share of a spike at a grey that map writers use for unknown, and at any other.
LEAST_WRITTEN, LEAST_OTHER = 0.005, 0.10

#: Least share of a grey free spike that stays free and is told of.
LEAST_DOUBTFUL = 0.04

#: Least share of whiter free pixels beside which a darker free spike is suspicious.
LEAST_WHITER = 0.001

#: Dark pixels are walls that the thresholds miss when they are this share of the picture and few of them are occupied.
LEAST_DARK, FEW_OCCUPIED = 0.003, 0.25

#: Band of pixels counted at once: bincount widens each to eight bytes.
BAND = 1 << 22


@dataclass(frozen=True)
class Levels:
    """Shares of the picture by level.

    Attributes
    ----------
    mass : (256,) float64
        Share of the pixels at each level; sums to 1 less the transparent ones.
    border : (256,) float64
        Share of the picture's outermost pixels at each level.
    states : (256,) uint8
        State of each level that occurs; UNKNOWN where none does.
    greys : (256,) int64
        The picture's own grey at each level, 0 black to 255 white; -1 where there is none. Alpha averaged into a
        mean and `negate` set it apart from the level.
    """

    mass: Floats
    border: Floats
    states: Bytes
    greys: npt.NDArray[np.int64]

    def window(self, level: int, half: int = SPIKE) -> float:
        """Share of the pixels within `half` levels of `level`."""
        return float(self.mass[max(level - half, 0) : level + half + 1].sum())

    def is_spike(self, level: int) -> bool:
        """Whether the mass at this level is a narrow peak.

        It is compared with the median around it, so that two spikes close to each other are two, not a slope.
        """
        near = slice(max(level - SPIKE, 0), level + SPIKE + 1)
        around = np.r_[self.mass[max(level - AROUND, 0) : near.start], self.mass[near.stop : level + AROUND + 1]]
        peak = float(self.mass[near].sum())
        background = float(np.median(around)) * (2 * SPIKE + 1)
        return bool(self.mass[level] == self.mass[near].max()) and peak > 0 and background < peak / 3

    def share(self, state: int) -> float:
        """Share of the pixels in a state."""
        return float(self.mass[self.states == state].sum())


def count(pixels: Bytes) -> npt.NDArray[np.int64]:
    """How often each pixel value occurs; (256,) int64. Rows are taken in bands so that memory stays small."""
    total = np.zeros(256, np.int64)
    rows = max(1, BAND // max(1, pixels.shape[1]))
    for top in range(0, pixels.shape[0], rows):
        total += np.bincount(pixels[top : top + rows].ravel(), minlength=256)
    return total


def level_of(p: Floats) -> npt.NDArray[np.int64]:
    """Level of each darkness."""
    return np.floor(np.clip(p, 0.0, 1.0) * 255.0 + 0.5).astype(np.int64)


def levels(
    counts: npt.NDArray[np.int64],
    border: npt.NDArray[np.int64],
    p: Floats,
    states: Bytes,
    shades: Floats,
    opaque: npt.NDArray[np.bool_],
) -> Levels:
    """Bring histograms over pixel values to levels.

    Parameters
    ----------
    counts, border : (256,) int64
        How often each pixel value occurs in the picture and along its border.
    p : (256,) float64
        Darkness of each pixel value.
    states : (256,) uint8
        State of each pixel value.
    shades : (256,) float64
        The picture's own grey of each pixel value.
    opaque : (256,) bool
        False for the pixel values that mean transparency.
    """
    level = level_of(p)
    mass = np.bincount(level[opaque], weights=counts[opaque], minlength=256) / max(1, int(counts.sum()))
    edge = np.bincount(level[opaque], weights=border[opaque], minlength=256) / max(1, int(border.sum()))
    by_level, greys = np.full(256, UNKNOWN, np.uint8), np.full(256, -1, np.int64)
    seen = np.flatnonzero(opaque & (counts > 0))
    seen = seen[np.argsort(counts[seen], kind="stable")]  # the commonest value of a level names it
    by_level[level[seen]] = states[seen]
    greys[level[seen]] = np.floor(shades[seen] + 0.5).astype(np.int64)
    return Levels(mass, edge, by_level, greys)


def unknown_read_as_free(of: Levels) -> tuple[list[int], list[int]]:
    """Spikes that the thresholds class as free although a whiter free exists.

    A grey that map writers use for unknown is suspicious from half a percent on. Any other must be a tenth of the
    picture, so that furniture drawn in grey stays free, and must surround it: a floor drawn light grey on white paper
    does not touch the border, the unexplored outside does.

    Returns
    -------
    unknown : list of int
        Levels that are most likely unknown.
    doubtful : list of int
        Levels that are large enough to be told.
    """
    free = of.states == FREE
    unknown, doubtful = [], []
    for level in np.flatnonzero(free & (of.mass > 0)).tolist():
        whiter = free & (np.arange(256) < level - AROUND)
        if of.mass[whiter].sum() < LEAST_WHITER or not of.is_spike(level):
            continue
        surrounds = of.border[max(level - SPIKE, 0) : level + SPIKE + 1].sum() > of.border[whiter].sum()
        written = of.greys[level] in WRITTEN_UNKNOWN
        if of.window(level) >= (LEAST_WRITTEN if written else LEAST_OTHER) and (written or surrounds):
            unknown.append(level)
        elif of.window(level) >= LEAST_DOUBTFUL:
            doubtful.append(level)
    return unknown, doubtful


def unknown_read_as_occupied(of: Levels) -> list[int]:
    """Levels of the broad spikes classed as occupied beside darker walls: perhaps another outside."""
    occupied = of.states == OCCUPIED
    return [
        level
        for level in np.flatnonzero(occupied & (of.mass > 0)).tolist()
        if of.is_spike(level)
        and of.window(level) >= LEAST_OTHER
        and of.mass[occupied & (np.arange(256) > level + AROUND)].sum() >= LEAST_WHITER
    ]


def areas(of: Levels) -> list[int]:
    """Levels of the spikes between white and black that cover a tenth of the picture, the largest first."""
    inner = [level for level in range(AROUND, 256 - AROUND) if of.is_spike(level) and of.window(level) >= LEAST_OTHER]
    return sorted(inner, key=of.window, reverse=True)


def better_occupied_thresh(of: Levels, free_thresh: float) -> float | None:
    """A limit under which the picture's dark strokes are occupied, if most of them are not; None if all is well.

    Dark is what is darker than the unknown. The limit lies halfway between the unknown and the commonest dark grey.
    """
    large = areas(of)
    unknown = large[0] if large else int(free_thresh * 255)
    dark = np.arange(256) > unknown + AROUND
    for level in large:
        dark[max(level - AROUND, 0) : level + AROUND + 1] = False
    mass = float(of.mass[dark].sum())
    if mass < LEAST_DARK or of.mass[dark & (of.states == OCCUPIED)].sum() >= FEW_OCCUPIED * mass:
        return None
    commonest = max(np.flatnonzero(dark).tolist(), key=of.window)
    return round((unknown + commonest) / 2 / 255, 2)


def better_free_thresh(of: Levels) -> float | None:
    """A limit under which the whitest grey of the picture is free, if none is; None if all is well or nothing helps.

    The limit lies halfway between the whitest common grey and the next one.
    """
    if of.share(FREE) > 0:
        return None
    common = [
        level for level in range(256) if of.mass[level] >= 0.01 or (of.is_spike(level) and of.mass[level] > 0.002)
    ]
    if not common or of.greys[common[0]] in WRITTEN_UNKNOWN:
        return None
    whitest = common[0]
    darker = [level for level in common if level > whitest + AROUND]
    return round((whitest + darker[0]) / 2 / 255, 2) if darker else None
