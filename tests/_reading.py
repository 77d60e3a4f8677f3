"""What tests of reading maps share."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from groundplan import Map, MapError, read


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
