"""Figure 9: coarse and fine side by side."""

from __future__ import annotations

from matplotlib.figure import Figure

from groundplan.figures._dual import draw_connectivity, draw_subdivision
from groundplan.figures._labelled import counted, draw_found, name_of
from groundplan.figures._labels import key
from groundplan.figures._panels import LEFT, RIGHT, blank, fitted, foot, foot_height, header, map_panel, scale_bar
from groundplan.figures._underlay import Underlay
from groundplan.survey import Survey


def coarse_and_fine(survey: Survey, coarse: Survey, fine: Survey, view: Underlay) -> Figure:
    """Figure 9: the coarse subdivision with labels, the fine one with its connectivity."""
    beside = view.size[0] < 1.7 * view.size[1]
    wide, high = fitted(view, *((5.6, 7.0) if beside else (9.4, 4.5)))
    handles = key(coarse)
    rise, gap, above = high + 0.5, 0.5, 0.35
    width = max(5.0, LEFT + 2 * wide + gap + RIGHT) if beside else LEFT + wide + RIGHT
    below = foot_height(width, handles)
    if beside:
        figure = blank(width, below + rise + above)
        corners = [(LEFT, below), (LEFT + wide + gap, below)]
    else:
        figure = blank(width, below + 2 * rise + above)
        corners = [(LEFT, below + rise), (LEFT, below)]
    header(figure, "Coarse for labels, fine for paths", [name_of(survey)])
    for (left, bottom), name, part in zip(corners, ("Coarse", "Fine"), (coarse, fine), strict=True):
        title = f"{name}: {counted(len(part.lines), 'line')}, {counted(len(part.subdivision.areas), 'face')}"
        axes = map_panel(figure, view, left, bottom, wide, title)
        view.draw(axes)
        scale_bar(axes, view.extent, wide)
        draw_subdivision(axes, part)
        if part is coarse:
            draw_found(axes, part)
        else:
            draw_connectivity(axes, part)
    foot(figure, handles)
    return figure
