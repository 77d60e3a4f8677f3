"""Maps that several benches measure on."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

import groundplan
from groundplan import Map

EXAMPLE = Path(__file__).parents[1] / "examples" / "warehouse.yaml"


def laid_out(side: int) -> Map:
    """The example's warehouse again and again, `side` pixels square."""
    one = groundplan.read(EXAMPLE)
    times = [-(-side // n) for n in one.pixels.shape]
    return replace(one, pixels=np.ascontiguousarray(np.tile(one.pixels, times)[:side, :side]))
