"""What tests of reading maps share: small maps as files, with their YAML, and what reading them gives."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from groundplan import Map, MapError, read
from groundplan.maps import FREE, OCCUPIED, UNKNOWN

Pixels = npt.NDArray[Any]

PLAIN = {
    "image": "map.pgm",
    "resolution": "0.05",
    "origin": "[-1.5, 2.0, 0.0]",
    "negate": "0",
    "occupied_thresh": "0.65",
    "free_thresh": "0.196",
}


def states(of: Map) -> npt.NDArray[np.uint8]:
    """What each pixel of a map means."""
    return of.states[of.pixels]


def refused(path: Path, code: str, *said: str, **options: Any) -> MapError:
    """Reading gives this error, and it says these words in one line."""
    with pytest.raises(MapError) as caught:
        read(path, **options)
    assert caught.value.code == code, caught.value
    sentence = f"{caught.value} {caught.value.hint}"
    assert "\n" not in sentence
    for word in said:
        assert word in sentence
    return caught.value


def write_yaml(folder: Path, **fields: str | None) -> Path:
    """A map_server YAML with these fields changed, or left out where None."""
    said = {**PLAIN, **fields}
    path = folder / "map.yaml"
    path.write_text("".join(f"{key}: {value}\n" for key, value in said.items() if value is not None))
    return path


def write_pgm(path: Path, pixels: Pixels, maxval: int = 255, comment: str = "") -> Path:
    height, width = pixels.shape
    path.write_bytes(b"P5\n%s%d %d\n%d\n" % (comment.encode(), width, height, maxval) + pixels.tobytes())
    return path


def hall() -> Pixels:
    """40 x 60 pixels: unknown 205 around a room of 254 with walls of 0. Not symmetric, so that a flip shows."""
    pixels = np.full((40, 60), 205, np.uint8)
    pixels[5:30, 10:50] = 0
    pixels[6:29, 11:49] = 254
    return pixels


def with_greys(free: int, unknown: int, wall: int) -> Pixels:
    return np.choose(np.searchsorted([0, 205, 254], hall()), [wall, unknown, free]).astype(np.uint8)


def codes(of: Map) -> list[str]:
    return [warning.code for warning in of.warnings]


def message(of: Map, code: str) -> str:
    return next(warning.message for warning in of.warnings if warning.code == code)


def shares(of: Map) -> tuple[float, ...]:
    seen = states(of)
    return tuple(100 * float((seen == state).mean()) for state in (FREE, OCCUPIED, UNKNOWN))


EXPECTED = np.choose(np.searchsorted([0, 205, 254], hall()), [OCCUPIED, UNKNOWN, FREE])
