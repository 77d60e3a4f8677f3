"""What a grey means to the three generations of map_server: ros1, nav2-humble and nav2."""

from __future__ import annotations

import math

import numpy as np
import pytest

from groundplan.maps import FREE, OCCUPIED, UNKNOWN, from_array


def as_printed(c: int, dialect: str, mode: str, *, negate: bool, occupied: float, free: float) -> int:
    """What map_server makes of an opaque grey, written out pixel by pixel after the three sources."""
    if dialect == "nav2":
        if mode == "raw":
            return c if c <= 100 else -1
        p = np.float32(c) / np.float32(255)
        p = p if negate else np.float32(1) - p
        high, low = np.float32(occupied), np.float32(free)
        if p <= low:
            return 0
        if p >= high:
            return 100
        part = (p - low) / np.float32(occupied - free) * np.float32(100)
        return -1 if mode == "trinary" else math.floor(float(part) + 0.5)
    shade = c / 255
    if mode == "raw":
        grey = 255 - c if negate and dialect == "ros1" else c
        return grey if grey <= 100 else -1
    dark = shade if negate else ((255 - c) / 255 if dialect == "ros1" else 1.0 - shade)
    if dark > occupied:
        return 100
    if dark < free:
        return 0
    if mode == "trinary":
        return -1
    ratio = (dark - free) / (occupied - free)
    return int(1 + 98 * ratio) if dialect == "ros1" else round(100 * ratio)


@pytest.mark.parametrize("negate", [False, True])
@pytest.mark.parametrize("mode", ["trinary", "scale", "raw"])
@pytest.mark.parametrize("dialect", ["nav2", "nav2-humble", "ros1"])
@pytest.mark.parametrize("thresholds", [(0.65, 0.196), (0.65, 0.25), (0.6, 0.2), (0.9, 0.1)])
def test_every_grey_means_what_the_dialect_says(
    dialect: str, mode: str, negate: bool, thresholds: tuple[float, float]
) -> None:
    occupied, free = thresholds
    picture = np.arange(256, dtype=np.uint8).reshape(16, 16)
    got = from_array(
        picture,
        0.05,
        dialect=dialect,
        mode=mode,
        negate=negate,
        occupied_thresh=occupied,
        free_thresh=free,
        unknown="none",
    )
    wanted = [as_printed(c, dialect, mode, negate=negate, occupied=occupied, free=free) for c in range(256)]
    assert got.values.tolist() == wanted
    assert got.values.dtype == np.int8
    assert got.states.dtype == np.uint8


def test_the_dialects_differ_where_p_equals_the_threshold() -> None:
    picture = np.full((4, 4), 204, np.uint8)  # p = 0.2, in float32 0.19999999 or 0.2
    options = {"occupied_thresh": 0.65, "free_thresh": 0.2, "unknown": "none"}
    states_by_dialect = {
        name: int(from_array(picture, 0.05, dialect=name, **options).states[204])  # type: ignore[arg-type]
        for name in ("nav2", "nav2-humble", "ros1")
    }
    assert states_by_dialect["nav2"] == FREE
    assert states_by_dialect["ros1"] == UNKNOWN


def test_scale_keeps_numbers_and_takes_the_state_by_percent() -> None:
    picture = np.arange(256, dtype=np.uint8).reshape(16, 16)
    got = from_array(picture, 0.05, mode="scale", occupied_thresh=0.9, free_thresh=0.1, unknown="none")
    assert got.values[128] == 50
    assert got.states[128] == UNKNOWN
    assert (got.states == np.where(got.values >= 65, OCCUPIED, np.where(got.values <= 25, FREE, UNKNOWN))).all()
