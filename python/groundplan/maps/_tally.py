"""What is counted over all pixels of a picture before anybody can say what its greys mean; parts of it add up."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from groundplan.maps import _greys as greys
from groundplan.maps._source import Bytes

#: So many rows at least are looked along, where a picture has them.
ROWS = 128


@dataclass(frozen=True)
class Tally:
    """Counts over a picture, or over some of its rows.

    Attributes
    ----------
    counts, border : (256,) int64
        How often each pixel value occurs, and how often among the outermost pixels.
    rows : (N, width) uint8
        Some rows of it, evenly spaced.
    """

    counts: npt.NDArray[np.int64]
    border: npt.NDArray[np.int64]
    rows: Bytes


def tally(pixels: Bytes, top: int = 0, height: int | None = None) -> Tally:
    """Count over rows of a picture of so many rows, the first of which is row `top`; over all of it by default."""
    whole = len(pixels) if height is None else height
    edges = [pixels[:, :1], pixels[:, -1:]]
    edges += [pixels[:1]] if top == 0 else []
    edges += [pixels[-1:]] if top + len(pixels) == whole else []
    border = np.zeros(256, np.int64)
    for edge in edges:
        border += greys.count(edge)
    step = max(1, whole // ROWS)
    return Tally(greys.count(pixels), border, pixels[-top % step :: step])


def summed(parts: Sequence[Tally]) -> Tally:
    """The tally of a picture from those of its parts, from the top down."""
    counts, border = (np.sum([getattr(part, name) for part in parts], axis=0) for name in ("counts", "border"))
    return Tally(counts, border, np.concatenate([part.rows for part in parts]))
