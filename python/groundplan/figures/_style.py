"""One palette, one type size, one way to save: the same survey gives the same bytes."""

from __future__ import annotations

import contextlib
import threading
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib
from matplotlib.figure import Figure

from groundplan._files import whole

# Told apart by readers who see no red or no green: after Okabe and Ito, with lightness differing as well.
FREE, UNKNOWN, OCCUPIED = "#ffffff", "#eae6df", "#2d2d2d"
INK, QUIET, HAIR = "#1f2328", "#6e7781", "#c9cdd2"
WALL, FREESTANDING = "#b01e46", "#3b6fd4"
CORRIDOR, CORRIDOR_INK = "#009e73", "#00533c"
RACK, REGION, DOOR, PILLAR = "#c79a2b", "#56b4e9", "#0b5cd6", "#4d2a7f"
JUNCTIONS = {"X": "#0072b2", "T": "#d1360f", "L": "#e69f00", "Y": "#9a5fb4", "end": "#70757a"}
SUBDIVISION, DUAL = "#c8321e", "#1f6fc4"
# Neither a rack's ochre nor a corridor's green is among the tints.
REGIONS = ("#56b4e9", "#cc79a7", "#8f7fd1", "#b5a800", "#0072b2", "#d97a5b", "#6e7781")
DIRECTIONS = (
    "#0072b2",
    "#d55e00",
    "#009e73",
    "#cc79a7",
    "#e69f00",
    "#5b4bb0",
    "#56b4e9",
    "#8a5a2b",
    "#b5a800",
    "#6e7781",
)

#: Dots per inch of a figure, and of the pictures inside an SVG. The survey's own picture has its pixels counted out.
DPI = 160

# The style is matplotlib's to hold, for all threads at once: one figure is drawn at a time.
_drawing = threading.RLock()


def colour(index: int) -> str:
    """Colour of a direction."""
    return DIRECTIONS[index % len(DIRECTIONS)]


@contextlib.contextmanager
def style() -> Iterator[None]:
    """Draw within this: our style whatever the reader's matplotlibrc says, and theirs back in the end."""
    ours: dict[str, Any] = {
        "font.family": ["DejaVu Sans"],
        "font.size": 8,
        "text.color": INK,
        # An image's name may hold a dollar sign.
        "text.parse_math": False,
        "axes.edgecolor": HAIR,
        "axes.labelcolor": QUIET,
        "axes.linewidth": 0.6,
        "axes.titlesize": 9,
        "axes.titlelocation": "left",
        "xtick.color": HAIR,
        "ytick.color": HAIR,
        "xtick.labelcolor": QUIET,
        "ytick.labelcolor": QUIET,
        "xtick.labelsize": 7,
        "ytick.labelsize": 7,
        "xtick.major.width": 0.6,
        "ytick.major.width": 0.6,
        "legend.frameon": False,
        "legend.fontsize": 8,
        "svg.hashsalt": "groundplan",
        "path.simplify": True,
    }
    plain: dict[Any, Any] = {n: value for n, value in matplotlib.rcParamsDefault.items() if "backend" not in n}
    with _drawing, matplotlib.rc_context(plain | ours), warnings.catch_warnings():
        # A name in a script that the font does not have is drawn as boxes, and no reason to stop.
        warnings.filterwarnings("ignore", message="Glyph .* missing from", category=UserWarning)
        yield


def save(figure: Figure, path: Path, dpi: float = DPI) -> Path:
    """Write a figure whole or not at all, with nothing in it that changes from day to day."""
    kind = path.suffix.lower().removeprefix(".")
    undated: dict[str, dict[str, Any]] = {
        "png": {"Software": None},
        "svg": {"Date": None, "Creator": "Groundplan"},
        "pdf": {"CreationDate": None, "ModDate": None, "Producer": None, "Creator": "Groundplan"},
    }
    # Few colours and large areas: a light hand packs as well as a heavy one, in half the time.
    more: dict[str, Any] = {"pil_kwargs": {"compress_level": 4}} if kind == "png" else {}
    with whole(path) as beside:
        figure.savefig(beside, dpi=dpi, metadata=undated.get(kind, {}), **more)
    return path
