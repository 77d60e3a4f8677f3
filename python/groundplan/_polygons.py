"""Polygons as pixels."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt


def fill(rings: Sequence[npt.ArrayLike], shape: tuple[int, int]) -> npt.NDArray[np.bool_]:
    """The pixels whose centres lie inside an odd number of rings, so that a ring within another is a hole.

    Parameters
    ----------
    rings
        (n, 2) corners as (column, row), pixels; the centre of pixel [0, 0] is at (0.5, 0.5).
    shape
        (height, width) of the answer.
    """
    mask = np.zeros(shape, dtype=bool)
    edges = [np.concatenate([r, np.roll(r, -1, axis=0)], axis=1) for r in (np.asarray(r, dtype=float) for r in rings)]
    lines = np.concatenate(edges) if edges else np.empty((0, 4))
    if not len(lines):
        return mask
    low = max(int(lines[:, [1, 3]].min() - 0.5), 0)
    high = min(int(lines[:, [1, 3]].max() + 0.5) + 1, shape[0])
    for row in range(low, high):
        y = row + 0.5
        x0, y0, x1, y1 = lines[(lines[:, 1] <= y) != (lines[:, 3] <= y)].T
        crossings = np.sort(x0 + (y - y0) / (y1 - y0) * (x1 - x0))
        # Of the centres k + 0.5, the first at or right of a crossing.
        stops = np.clip(np.ceil(crossings - 0.5), 0, shape[1]).astype(int)
        for a, b in zip(stops[::2].tolist(), stops[1::2].tolist(), strict=True):
            mask[row, a:b] = True
    return mask
