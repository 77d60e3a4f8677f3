"""Figure 8: the labelled map, the picture of a survey."""

from __future__ import annotations

import math

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from groundplan.figures._labels import draw_labels, draw_walls, key
from groundplan.figures._panels import map_sheet
from groundplan.figures._underlay import Underlay
from groundplan.survey import Survey


def labelled(survey: Survey, view: Underlay) -> tuple[Figure, float]:
    """The labelled map, and the dots per inch that show its pixels as they are."""
    figure, axes, dpi = map_sheet(view, name_of(survey), summary(survey), key(survey))
    view.draw(axes)
    draw_found(axes, survey)
    return figure, dpi


def draw_found(axes: Axes, survey: Survey) -> None:
    """Walls and labels."""
    draw_walls(axes, survey)
    draw_labels(axes, survey)


def summary(survey: Survey) -> list[str]:
    """What there is to say of a survey: size and resolution, directions, lines, faces."""
    frame = survey.map
    wide, high = frame.width * frame.resolution, frame.height * frame.resolution
    angles = ", ".join(degrees(angle) for angle in survey.directions.angles[:4])
    more = ", …" if len(survey.directions) > 4 else ""
    return [
        f"{_metres(wide)} × {_metres(high)} m at {frame.resolution:.3g} m",
        counted(len(survey.directions), "direction") + (f" ({angles}{more})" if angles else ""),
        counted(len(survey.lines), "line"),
        counted(len(survey.subdivision.areas), "face"),
    ]


def _metres(length: float) -> str:
    """Three figures, or all before the point."""
    return f"{length:.0f}" if length >= 100 else f"{length:.3g}"


def degrees(angle: float) -> str:
    """An angle in radians as it is read, in degrees."""
    return f"{math.degrees(angle):.1f}°".replace("-", "−").replace("−0.0°", "0.0°")


def counted(number: int, noun: str) -> str:
    """A number and its noun."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def name_of(survey: Survey) -> str:
    """The name of the map's image, where it has one."""
    return survey.map.image or "map"
