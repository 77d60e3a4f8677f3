"""From greys or occupancies to tables: where dialect, thresholds, alpha and histogram meet."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from groundplan._errors import MapError, shown
from groundplan.maps import _greys as greys
from groundplan.maps._dialects import (
    DIALECTS,
    FREE_PERCENT,
    FREE_THRESH,
    OCCUPIED_PERCENT,
    OCCUPIED_THRESH,
    Dialect,
    Meaning,
    darkness,
    states_of,
    tables,
)
from groundplan.maps._map import FREE, UNKNOWN, MapWarning
from groundplan.maps._source import Bytes, Described, Occupancies, Picture
from groundplan.maps._tally import Tally, tally
from groundplan.maps._warnings import (
    RAW,
    assumed_limits,
    grey_as_free,
    nonsense,
    shares,
    unknown_as_free,
    unknown_as_occupied,
    walls_as_unknown,
)
from groundplan.maps.map_server import check_mode, check_threshold, number

Unknown = None | str | int | Sequence[int]
Interpreted = tuple[Bytes, npt.NDArray[np.int8], Bytes, list[MapWarning]]


def meaning_of(
    described: Described,
    dialect: str,
    negate: bool | None,
    mode: str | None,
    occupied_thresh: float | None,
    free_thresh: float | None,
    where: str,
) -> tuple[Meaning, tuple[bool, bool]]:
    """How to read the greys, and whether the occupied and the free threshold were stated by anyone."""
    known: Dialect | None = next((name for name in DIALECTS if name == dialect), None)
    if known is None:
        raise MapError("map.dialect", f"dialect {shown(dialect)} is none of {', '.join(DIALECTS)}")
    high, low = described.occupied_thresh, described.free_thresh
    if occupied_thresh is not None:
        high = check_threshold(occupied_thresh, "occupied_thresh", "occupied_thresh")
    if free_thresh is not None:
        low = check_threshold(free_thresh, "free_thresh", "free_thresh")
    stated = high is not None, low is not None
    # A single stated threshold may lie beyond the other's default.
    if high is None:
        high = (1.0 + low) / 2 if low is not None and low >= OCCUPIED_THRESH else OCCUPIED_THRESH
    if low is None:
        low = high / 2 if high <= FREE_THRESH else FREE_THRESH
    if not low < high:
        raise MapError("map.thresholds", f"{where}: free_thresh {low:g} is not below occupied_thresh {high:g}")
    chosen = described.mode or "trinary"
    if mode is not None:
        chosen = check_mode(mode, "mode")
    return Meaning(known, chosen, bool(described.negate if negate is None else negate), high, low), stated


def weigh(content: Occupancies, meaning: Meaning, stated: tuple[bool, bool], known: Tally | None = None) -> Interpreted:
    """Pixels, tables and warnings of occupancies; of the meaning, the stated thresholds alone count.

    `known` is the tally of all pixels where these are not at hand.
    """
    values = np.arange(256, dtype=np.uint8).view(np.int8).copy()
    if content.certain:
        values = np.where(np.arange(256) == 0, 0, 100).astype(np.int8)
    if content.absent is not None:
        values[content.absent] = -1
    values[(values < 0) | (values > 100)] = -1
    high = 100.0 * meaning.occupied_thresh if stated[0] else OCCUPIED_PERCENT
    low = 100.0 * meaning.free_thresh if stated[1] else FREE_PERCENT
    states = states_of(values, high, low)
    counts = greys.count(content.pixels) if known is None else known.counts
    return content.pixels, values, states, nonsense(shares(counts, states), None, None)


def interpret(
    picture: Picture, meaning: Meaning, stated: tuple[bool, bool], unknown: Unknown, known: Tally | None = None
) -> Interpreted:
    """Pixels, tables and warnings of a picture; `known` is the tally of all pixels where these are not at hand."""
    chosen = _chosen(unknown)
    pixels, shades, clear = _with_alpha(picture, meaning)
    seen = tally(pixels) if known is None else known
    counts, border = seen.counts, seen.border
    warnings: list[MapWarning] = []

    def reading(of: Meaning) -> tuple[npt.NDArray[np.int8], Bytes, greys.Levels]:
        values, states = tables(shades, of)
        values[clear], states[clear] = -1, UNKNOWN
        if isinstance(chosen, list):
            set_unknown(values, states, np.isin(np.floor(picture.shades + 0.5), chosen) & ~clear)
        return values, states, greys.levels(counts, border, darkness(shades, of), states, picture.shades, ~clear)

    def set_unknown(values: npt.NDArray[np.int8], states: Bytes, where: npt.NDArray[np.bool_]) -> None:
        values[where], states[where] = -1, UNKNOWN

    values, states, levels = reading(meaning)
    high = low = None
    if meaning.mode != "raw":
        high, low = greys.better_occupied_thresh(levels, meaning.free_thresh), greys.better_free_thresh(levels)
        meaning, assumed = assumed_limits(meaning, stated, high, low)
        if assumed:
            warnings += assumed
            values, states, levels = reading(meaning)
            high = low = None
    if meaning.mode != "raw" and chosen is None:
        level_of = greys.level_of(darkness(shades, meaning))
        certain, doubtful = greys.unknown_read_as_free(levels)
        warnings += [grey_as_free(level, levels) for level in doubtful if level < min(certain, default=256)]
        for level in certain:
            # What is darker than unknown is not free either.
            set_unknown(values, states, (level_of >= level - greys.SPIKE) & (states == FREE) & ~clear)
            warnings.append(unknown_as_free(level, levels, meaning))
        warnings += [unknown_as_occupied(level, levels, meaning) for level in greys.unknown_read_as_occupied(levels)]
    if isinstance(chosen, list):
        occurring = np.unique(np.floor(picture.shades + 0.5)[(counts > 0) & ~clear])
        absent = [grey for grey in chosen if grey not in occurring]
        if absent:
            named = ", ".join(map(str, absent))
            warnings.append(MapWarning("unknown-absent", f"no pixel has the grey {named} given as unknown"))
    darker = any(warning.code == "unknown-as-occupied" for warning in warnings)
    hint = RAW if meaning.mode == "raw" else ""
    odd = nonsense(shares(counts, states), high, low, walls_darker=darker, hint=hint)
    if meaning.mode != "raw" and not odd:
        odd = walls_as_unknown(seen.rows, counts, states, darkness(shades, meaning))
    return pixels, values, states, warnings + odd


def _chosen(unknown: Unknown) -> list[int] | str | None:
    """None to find unknown greys, "none" to take none, or the greys given."""
    if unknown is None or unknown == "auto":
        return None
    if isinstance(unknown, str):
        if unknown == "none":
            return "none"
        parts: list[object] = [*re.split(r"[,\s]+", unknown.strip())]
    else:
        parts = [*unknown] if isinstance(unknown, Sequence) else [unknown]
    chosen = []
    for part in parts:
        grey = number(part)
        if grey is None or not 0 <= grey <= 255 or grey != int(grey):
            raise MapError("map.unknown", f"unknown {shown(part)} is neither none nor a grey between 0 and 255")
        chosen.append(int(grey))
    return chosen


def _with_alpha(picture: Picture, meaning: Meaning) -> tuple[Bytes, npt.NDArray[np.float64], npt.NDArray[np.bool_]]:
    """Pixels and shades with alpha worked in, and which pixel values mean transparency.

    Where all is opaque, or alpha belongs to the palette, the tables do it. Otherwise the transparent pixels get a
    value that means nothing else.
    """
    clear = np.zeros(256, np.bool_) if picture.absent is None else picture.absent.copy()
    pixels, shades = picture.pixels, picture.shades
    if not picture.has_alpha or meaning.mode == "raw":
        return pixels, shades, clear
    if meaning.averages_alpha:
        if picture.alpha is None:
            alphas = np.full(256, 255.0) if picture.alphas is None else picture.alphas.astype(np.float64)
            return pixels, (3.0 * shades + alphas) / 4.0, clear
        mixed = (3 * pixels.astype(np.uint16) + picture.alpha + 2) // 4
        return mixed.astype(np.uint8), shades, clear
    # ROS 1 looks at alpha between the thresholds only, and there at full transparency only.
    least = 1 if meaning.dialect == "ros1" else 255
    between = np.ones(256, np.bool_)
    if meaning.dialect == "ros1":
        p = darkness(shades, meaning)
        between = (p >= meaning.free_thresh) & (p <= meaning.occupied_thresh)
    if picture.alphas is not None:
        return pixels, shades, clear | ((picture.alphas < least) & between)
    if picture.alpha is None:
        return pixels, shades, clear
    unused = np.flatnonzero(greys.count(pixels) == 0)
    spare = int(unused[-1]) if unused.size else _spare(pixels, shades, meaning)
    hidden = (picture.alpha < least) & between[pixels]
    if unused.size == 0 and tables(shades, meaning)[0][spare] != -1:
        # Every value is in use and none means unknown: the rarest joins its neighbour, one grey away.
        pixels = np.where(pixels == spare, np.uint8(spare - 1 if spare else 1), pixels)
    clear[spare] = True
    return np.where(hidden, np.uint8(spare), pixels), shades, clear


def _spare(pixels: Bytes, shades: npt.NDArray[np.float64], meaning: Meaning) -> int:
    """A pixel value for transparency where all 256 are in use: one that means unknown anyway, else the rarest."""
    unknown = np.flatnonzero(tables(shades, meaning)[0] == -1)
    return int(unknown[0]) if unknown.size else int(greys.count(pixels).argmin())
