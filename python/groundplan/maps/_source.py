"""What a source gives before it is interpreted: greys or occupancies, and what was stated about them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import numpy.typing as npt

from groundplan.maps._dialects import Mode
from groundplan.maps._map import MapWarning

Bytes = npt.NDArray[np.uint8]
Origin = tuple[float, float, float]

#: Rows from, to.
Span = tuple[int, int]

#: Is told the share that was read, 0 to 1.
Progress = Callable[[float], None]


@dataclass(frozen=True)
class Picture:
    """A decoded image.

    Attributes
    ----------
    pixels : (height, width) uint8
        Samples as they lie, top row first.
    shades : (256,) float64
        Grey of each sample value, 0 black to 255 white.
    alphas : (256,) uint8 or None
        Alpha of each sample value, where a palette or a table has it.
    alpha : (height, width) uint8 or None
        Alpha of each pixel, where it is not 255 everywhere.
    has_alpha : bool
        Whether the file has an alpha channel at all, be it opaque.
    absent : (256,) bool or None
        Sample values that the file declares to be no data.
    warnings : tuple of MapWarning
        What was lost in decoding.
    """

    pixels: Bytes
    shades: npt.NDArray[np.float64] = field(default_factory=lambda: np.arange(256, dtype=np.float64))
    alphas: Bytes | None = None
    alpha: Bytes | None = None
    has_alpha: bool = False
    absent: npt.NDArray[np.bool_] | None = None
    warnings: tuple[MapWarning, ...] = ()


@dataclass(frozen=True)
class Occupancies:
    """Occupancies as nav_msgs/OccupancyGrid says them.

    Attributes
    ----------
    pixels : (height, width) uint8
        The int8 seen as bytes: 0 to 100 percent, all else unknown; top row first.
    absent : int or None
        A value, as a byte, that the file declares to be no data.
    certain : bool
        Whether the values are no percentages: 0 is free and any other occupied.
    """

    pixels: Bytes
    absent: int | None = None
    certain: bool = False


@dataclass(frozen=True)
class Described:
    """What is stated about a map. `None` where nothing is.

    Attributes
    ----------
    image : Path
        The file with the pixels.
    content : Picture, Occupancies or None
        The pixels, where they were read together with what is said of them.
    shape : (int, int) or None
        Rows and columns of all pixels, where the source can be read by rows.
    block : int
        Rows that are stored together, and best read so.
    misspelled : mapping of str to str
        Of what is not stated, the names under which something is stated that may be meant.
    """

    image: Path
    resolution: float | None = None
    origin: Origin | None = None
    negate: bool | None = None
    mode: Mode | None = None
    occupied_thresh: float | None = None
    free_thresh: float | None = None
    warnings: tuple[MapWarning, ...] = ()
    content: Picture | Occupancies | None = None
    shape: tuple[int, int] | None = None
    block: int = 1
    misspelled: Mapping[str, str] = field(default_factory=dict)


def bands(height: int, width: int, pixels: int = 1 << 20) -> Iterator[slice]:
    """Row bands of about a million pixels, or so many."""
    rows = max(1, pixels // max(1, width))
    return (slice(top, min(top + rows, height)) for top in range(0, height, rows))
