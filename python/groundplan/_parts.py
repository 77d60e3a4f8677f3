"""What a survey takes from a band of rows, wherever its pixels are; parts of all bands are put together by who asks.

A part is made of integers, or of rows in their order: they come to the same bytes wherever the map is cut.
"""

from __future__ import annotations

import zlib
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from groundplan import _core
from groundplan.maps import Map
from groundplan.maps._distant import Distant
from groundplan.maps._source import Bytes, Span
from groundplan.maps._tally import Tally, tally
from groundplan.stages import layout

#: What the state of four pixels is, by the byte that they are packed in.
UNPACKED = (np.arange(256)[:, None] >> np.array([0, 2, 4, 6]) & 3).astype(np.uint8)


def count_rows(far: Distant, span: Span) -> Tally:
    """Counts over some rows."""
    made = tally(far.rows(*span), span[0], far.shape[0])
    return replace(made, rows=made.rows.copy())


def look(
    source: Distant | Bytes, held: Span, span: Span, height: int, meaning: Any, values: dict[str, Any]
) -> tuple[dict[str, Any], bytes]:
    """Gradients of a band, of which more rows are held, and of a file the states of its pixels: who asks lacks them."""
    pixels = source.rows(*held) if isinstance(source, Distant) else source
    grid = layout(Map(pixels, *meaning))
    width = pixels.shape[1]
    rows = height - span[1], height - span[0]
    part = _core.find_gradients_in(grid, (height, height - held[1]), rows, (0, width), values, 1)
    own = pixels[span[0] - held[0] : span[1] - held[0]]
    return part, packed(meaning[1][own]) if isinstance(source, Distant) else b""


def add_faces(
    source: Distant | Bytes,
    held: Span,
    span: Span,
    height: int,
    meaning: Any,
    directions: dict[str, Any],
    lines: dict[str, Any],
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """What a band adds to the faces that it meets: which they are, and a row of sums for each. More may be held."""
    pixels = source.rows(*held) if isinstance(source, Distant) else source
    rows = height - span[1], height - span[0]
    sums = _core.sum_faces(layout(Map(pixels, *meaning)), (height, height - held[1]), rows, directions, lines, 1)
    which = np.flatnonzero(sums.any(axis=1))
    return which, sums[which]


def packed(states: Bytes) -> bytes:
    """States of pixels, four to a byte and compressed."""
    flat = np.concatenate([states.ravel(), np.zeros(-states.size % 4, np.uint8)])
    return zlib.compress(flat[0::4] | flat[1::4] << 2 | flat[2::4] << 4 | flat[3::4] << 6, 1)


def unpacked(data: bytes, shape: tuple[int, int]) -> Bytes:
    """The inverse of `packed`."""
    states: Bytes = UNPACKED[np.frombuffer(zlib.decompress(data), np.uint8)].ravel()[: shape[0] * shape[1]]
    return states.reshape(shape)


def commonest(states: Bytes, counts: npt.NDArray[np.int64]) -> tuple[Bytes, bool]:
    """The commonest pixel value of each state, and whether there is no other."""
    there = [np.where(states == state, counts, -1) for state in range(3)]
    exact = all((of > 0).sum() <= 1 for of in there)
    return np.array([of.argmax() for of in there], np.uint8), exact
