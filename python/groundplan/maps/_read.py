"""From a file or an array to a Map: the one place where picture, YAML, dialect and greys meet."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from groundplan._errors import MapError
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
from groundplan.maps._map import FREE, UNKNOWN, Map, MapWarning
from groundplan.maps._warnings import (
    assumed_limits,
    grey_as_free,
    nonsense,
    rounded,
    shares,
    unknown_as_free,
    unknown_as_occupied,
    walls_as_unknown,
)
from groundplan.maps.image import FORMATS, Picture, is_image, look, read_image
from groundplan.maps.map_server import (
    Described,
    check_mode,
    check_origin,
    check_resolution,
    check_threshold,
    number,
    read_yaml,
    shown,
)

Unknown = None | str | int | Sequence[int]
Bytes = npt.NDArray[np.uint8]


def read(
    path: str | os.PathLike[str],
    *,
    resolution: float | None = None,
    origin: Sequence[float] | None = None,
    dialect: str = "nav2",
    unknown: Unknown = None,
    negate: bool | None = None,
    mode: str | None = None,
    occupied_thresh: float | None = None,
    free_thresh: float | None = None,
) -> Map:
    """Read a map: a map_server YAML with its image, or a bare image.

    What is given here beats what the YAML says. The file is never changed, and an 8-bit PGM is not even read: its
    pixels are a read-only memory map.

    Parameters
    ----------
    path : path
        A map_server YAML, or a PGM, PNG, BMP, TIFF, JPEG, PBM or PPM.
    resolution : float, optional
        Metres per pixel. A bare image needs it.
    origin : (x, y) or (x, y, yaw), optional
        Pose of the lower left corner of the lower left pixel: metres, metres, radians.
    dialect : {"nav2", "nav2-humble", "ros1"}
        Whose reading of the greys to follow.
    unknown : None, "none", int or sequence of int
        Greys that mean unknown. None finds a grey that the thresholds take for free although it is most likely
        unknown, and warns; "none" follows the thresholds to the letter.
    negate : bool, optional
        White is occupied and black is free.
    mode : {"trinary", "scale", "raw"}, optional
        How greys become occupancy.
    occupied_thresh, free_thresh : float, optional
        Darkness from which a pixel is occupied and up to which it is free, 0 to 1. Where neither the YAML nor the
        caller states them and map_saver's 0.65 and 0.196 miss the picture, they are taken from its histogram.

    Returns
    -------
    Map
        With the warnings of what was odd.

    Raises
    ------
    MapError
        The file is missing, unreadable, not a map, or says what cannot be; the message names file and value.
    """
    place = Path(path).expanduser() if str(path).startswith("~") else Path(path)
    described = _describe(place)
    warnings = list(described.warnings)
    where = str(place)
    metres = check_resolution(resolution, "resolution") if resolution is not None else described.resolution
    if metres is None:
        hint = "--resolution sets it, such as --resolution 0.05"
        raise MapError("map.resolution", f"{where} states no resolution", hint)
    pose = described.origin
    if origin is not None:
        pose, odd = check_origin(origin, "origin")
        warnings = [warning for warning in warnings if warning.code != "yaw-nan"] + odd
    if pose is None:
        if described.image != place:
            raise MapError("map.origin", f"{where} states no origin", "--origin sets it, such as --origin 0 0 0")
        pose = (0.0, 0.0, 0.0)
    meaning, stated = _meaning(described, dialect, negate, mode, occupied_thresh, free_thresh, where)
    picture = read_image(described.image, luma=meaning.dialect == "nav2")
    warnings += picture.warnings
    if resolution is None:
        warnings += rounded(metres, picture.pixels.shape)
    pixels, values, states, odd = _interpret(picture, meaning, stated, unknown)
    return Map(pixels, values, states, metres, pose, described.image.name, tuple(warnings + odd))


def from_array(
    array: npt.NDArray[np.generic],
    resolution: float,
    origin: Sequence[float] = (0.0, 0.0, 0.0),
    *,
    image: str = "",
    dialect: str = "nav2",
    unknown: Unknown = None,
    negate: bool | None = None,
    mode: str | None = None,
    occupied_thresh: float | None = None,
    free_thresh: float | None = None,
) -> Map:
    """A Map over an array, without copying it.

    Parameters
    ----------
    array : (height, width) uint8, int8 or bool
        uint8: the greys of an image, row 0 at the top, read as map_server does.
        int8: the data of a nav_msgs/OccupancyGrid, -1 and 0..100, row 0 at the bottom.
        bool: True is occupied, False is free, row 0 at the top.
    resolution : float
        Metres per pixel.
    origin : (x, y) or (x, y, yaw)
        Pose of the lower left corner of the lower left pixel: metres, metres, radians.
    image : str
        Name to give the map in its survey.
    dialect, unknown, negate, mode, occupied_thresh, free_thresh
        As in `read`, for uint8. For int8 the thresholds alone count, as hundredths of a percent; 0.65 and 0.25
        when not given.

    Raises
    ------
    MapError
        ``map.pixels`` for another shape or type, and those of `read` for the other arguments.
    """
    if array.ndim != 2 or array.size == 0:
        raise MapError("map.pixels", f"an array of shape {array.shape} is not a map; it needs height x width pixels")
    metres = check_resolution(resolution, "resolution")
    pose, warnings = check_origin(origin, "origin")
    nothing = Described(Path(image), metres, pose, None, None, None, None)
    meaning, stated = _meaning(nothing, dialect, negate, mode, occupied_thresh, free_thresh, "from_array")
    if array.dtype == np.uint8:
        picture = Picture(array.view(np.uint8))
        pixels, values, states, odd = _interpret(picture, meaning, stated, unknown)
        return Map(pixels, values, states, metres, pose, image, tuple(warnings + odd))
    if array.dtype == np.int8:
        pixels = array.view(np.uint8)[::-1]
        values = np.arange(256, dtype=np.uint8).view(np.int8).copy()
        high = OCCUPIED_PERCENT if occupied_thresh is None else 100.0 * meaning.occupied_thresh
        low = FREE_PERCENT if free_thresh is None else 100.0 * meaning.free_thresh
    elif array.dtype == np.bool_:
        pixels = array.view(np.uint8)
        values = np.where(np.arange(256) == 0, 0, 100).astype(np.int8)
        high, low = OCCUPIED_PERCENT, FREE_PERCENT
    else:
        raise MapError(
            "map.pixels",
            f"an array of {array.dtype} is not a map; it needs uint8 greys, int8 occupancies or bool",
            "convert an OccupancyGrid's data with .astype('int8')",
        )
    values[(values < 0) | (values > 100)] = -1
    states = states_of(values, high, low)
    counts = greys.count(pixels)
    warnings += nonsense(shares(counts, states), None, None)
    return Map(pixels, values, states, metres, pose, image, tuple(warnings))


def _describe(path: Path) -> Described:
    """What the YAML says, or nothing for a bare image."""
    if path.suffix.lower() in (".yaml", ".yml"):
        return read_yaml(path)
    _, start = look(path)
    if not is_image(start):
        raise MapError("map.format", f"{path} is not a map: it is neither a map_server YAML nor {FORMATS}")
    return Described(path, None, None, None, None, None, None)


def _meaning(
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


def _interpret(
    picture: Picture, meaning: Meaning, stated: tuple[bool, bool], unknown: Unknown
) -> tuple[Bytes, npt.NDArray[np.int8], Bytes, list[MapWarning]]:
    """Pixels, tables and warnings of a picture."""
    chosen = _chosen(unknown)
    pixels, shades, clear = _with_alpha(picture, meaning)
    counts, border = greys.count(pixels), _border(pixels)
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
    odd = nonsense(shares(counts, states), high, low, walls_darker=darker)
    if meaning.mode != "raw" and not odd:
        odd = walls_as_unknown(pixels, counts, states, darkness(shades, meaning))
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
    clear = np.zeros(256, np.bool_)
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
        return pixels, shades, (picture.alphas < least) & between
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


def _border(pixels: Bytes) -> npt.NDArray[np.int64]:
    """Histogram of the outermost pixels."""
    total = np.zeros(256, np.int64)
    for edge in (pixels[:1], pixels[-1:], pixels[:, :1], pixels[:, -1:]):
        total += greys.count(edge)
    return total
