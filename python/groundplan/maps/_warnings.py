"""What is told about a map: one text for each warning."""

from __future__ import annotations

import dataclasses

import numpy as np
import numpy.typing as npt

from groundplan.maps._dialects import Meaning
from groundplan.maps._greys import Levels
from groundplan.maps._map import FREE, OCCUPIED, UNKNOWN, MapWarning

#: More of the map occupied than this is an outside painted like the walls.
MOSTLY = 0.5

#: Darker than the usual unknown by this, a grey is something else; a state of its own where walls are looked for.
DARKER, DARK = 16 / 255, 3
#: Rows that are looked at, pixels behind the end of the free space, and the fewest ends that say something.
BEHIND, FEWEST = 4, 50

#: map_saver rounds the resolution to millimetres; from this error over the map's length on, in metres, it is told.
ROUNDING = 0.25


def percent(share: float) -> str:
    """A share in a sentence; what rounds to nothing is not said to be nothing."""
    return "less than 0.1 %" if 0 < share < 0.0005 else f"{100 * share:.1f} %"


def shares(counts: npt.NDArray[np.int64], states: npt.NDArray[np.uint8]) -> dict[int, float]:
    """Share of the picture in each state."""
    total = int(counts.sum())
    return {state: float(counts[states == state].sum()) / total for state in (FREE, OCCUPIED, UNKNOWN)}


def assumed_limits(
    meaning: Meaning, stated: tuple[bool, bool], high: float | None, low: float | None
) -> tuple[Meaning, list[MapWarning]]:
    """Class limits from the histogram, for those thresholds that nobody stated."""
    high = None if stated[0] else high
    low = None if stated[1] else low
    if high is None and low is None:
        return meaning, []
    free = meaning.free_thresh if low is None else low
    occupied = meaning.occupied_thresh if high is None else high
    if not free < occupied:
        if stated[0] or stated[1]:
            return meaning, []
        free, occupied = (free, (1.0 + free) / 2) if high is None else (occupied / 2, occupied)
    said = f"occupied from p = {occupied:g} on, free up to p = {free:g}"
    return dataclasses.replace(meaning, occupied_thresh=occupied, free_thresh=free), [
        MapWarning(
            "limits-assumed",
            f"no thresholds are stated and the usual ones miss this picture; taken from its histogram: {said}; "
            "--occupied-thresh, --free-thresh and --unknown set them",
        )
    ]


def unknown_as_free(level: int, levels: Levels, meaning: Meaning) -> MapWarning:
    grey = levels.greys[level]
    return MapWarning(
        "unknown-as-free",
        f"grey {grey} (p = {level / 255:.3f}, {percent(levels.window(level))} of the picture) counts as free by "
        f"free_thresh {meaning.free_thresh:g}, but a lighter free grey exists: it was read as unknown; "
        f"--unknown none reads it as free, --unknown {grey} confirms it",
    )


def grey_as_free(level: int, levels: Levels) -> MapWarning:
    grey = levels.greys[level]
    return MapWarning(
        "grey-as-free",
        f"grey {grey} (p = {level / 255:.3f}, {percent(levels.window(level))} of the picture) counts as free beside "
        f"a lighter free grey; if it is the inside of walls or not explored, --unknown {grey} says so",
    )


def unknown_as_occupied(level: int, levels: Levels, meaning: Meaning) -> MapWarning:
    grey = levels.greys[level]
    return MapWarning(
        "unknown-as-occupied",
        f"grey {grey} (p = {level / 255:.3f}, {percent(levels.window(level))} of the picture) counts as occupied by "
        f"occupied_thresh {meaning.occupied_thresh:g} although the walls are darker; if it is not explored or "
        f"outside, --unknown {grey} says so",
    )


#: What may help where a grey is taken as it is.
RAW = (
    "; in mode raw a grey from 0 to 100 is a percentage occupied and others are unknown: "
    "--mode trinary reads what is dark as occupied"
)

#: The state that no pixel has, by the warning that says so.
MISSING = {"no-free-space": FREE, "no-occupied": OCCUPIED}


def nonsense(
    shares: dict[int, float], high: float | None, low: float | None, *, walls_darker: bool = False, hint: str = ""
) -> list[MapWarning]:
    """Warnings of a map in which a class is missing, or nearly all there is.

    Parameters
    ----------
    shares : dict
        Share of the picture in each state.
    high, low : float or None
        Thresholds that would fit the picture better than those stated.
    walls_darker : bool
        Whether it is told already that a grey counts as occupied although the walls are darker.
    hint : str
        What may help where no threshold would.
    """
    warnings = []
    if shares[FREE] == 0:
        help_ = f"; --free-thresh {low:g} would make its lightest grey free" if low is not None else hint
        warnings.append(MapWarning("no-free-space", f"no pixel of the map is free{help_}"))
    if shares[OCCUPIED] == 0:
        help_ = f"; --occupied-thresh {high:g} would make its dark greys occupied" if high is not None else hint
        warnings.append(MapWarning("no-occupied", f"no pixel of the map is occupied{help_}"))
    elif high is not None:
        said = f"most dark greys of the picture count as unknown; --occupied-thresh {high:g} would make them occupied"
        warnings.append(MapWarning("walls-as-unknown", said))
    if shares[OCCUPIED] > MOSTLY and shares[FREE] > 0:
        same = "outside and walls have the same grey and cannot be told apart, which needs no flag; "
        said = f"{percent(shares[OCCUPIED])} of the map is occupied: {'' if walls_darker else same}"
        warnings.append(MapWarning("outside-occupied", f"{said}if black is meant to be free, --negate says so"))
    return warnings


def walls_as_unknown(
    rows: npt.NDArray[np.uint8],
    counts: npt.NDArray[np.int64],
    states: npt.NDArray[np.uint8],
    p: npt.NDArray[np.float64],
) -> list[MapWarning]:
    """A warning where free space ends at something darker than the unknown and seldom at something occupied.

    Parameters
    ----------
    rows : (N, width) uint8
        Some rows of the picture.
    counts, states, p : (256,)
        How many pixels have each value, its state, and how dark it is, 0 to 1.
    """
    if not (states == UNKNOWN).any():
        return []
    usual = int(np.where(states == UNKNOWN, counts, -1).argmax())
    limit = float(p[usual]) + DARKER
    kind = np.where(states == UNKNOWN, np.where(p > limit, DARK, UNKNOWN), states).astype(np.uint8)
    rows = kind[rows]
    seen = {OCCUPIED: 0, DARK: 0}
    for line in (rows, rows[:, ::-1]):
        ends = np.argwhere((line[:, :-1] == FREE) & (line[:, 1:] != FREE))
        # What lies behind the end of the free space, before the next free pixel.
        reach = np.minimum(ends[:, 1:] + np.arange(1, BEHIND + 1), line.shape[1] - 1)
        behind = line[ends[:, :1], reach]
        before = np.logical_and.accumulate(behind != FREE, axis=1)
        taken, dark = (((behind == state) & before).any(axis=1) for state in (OCCUPIED, DARK))
        seen[OCCUPIED] += int(taken.sum())
        seen[DARK] += int((dark & ~taken).sum())
    if seen[DARK] <= max(FEWEST, 2 * seen[OCCUPIED]):
        return []
    said = (
        f"free space ends {seen[DARK]} times at something darker than the unknown and {seen[OCCUPIED]} times at "
        f"something occupied: walls may count as unknown; --occupied-thresh {limit:.2f} would make them occupied"
    )
    return [MapWarning("walls-as-unknown", said)]


def rounded(resolution: float, shape: tuple[int, ...]) -> list[MapWarning]:
    """A warning where map_saver's rounding to three decimals may have bent the map's scale.

    Sizes such as 0.05 or 0.025 are what people choose; 0.033 is what is left of a thirtieth.
    """
    millimetres = resolution * 1000.0
    odd = abs(millimetres - round(millimetres)) < 1e-6 and round(millimetres) > 5 and round(millimetres) % 5 != 0
    error = 0.0005 * max(shape)
    if not odd or error < ROUNDING:
        return []
    said = (
        f"resolution {resolution:g} looks rounded to three decimals, as map_saver does: over {max(shape)} pixels the "
        f"map may be up to {error:.2f} m off; --resolution sets the true one"
    )
    return [MapWarning("resolution-rounded", said)]
