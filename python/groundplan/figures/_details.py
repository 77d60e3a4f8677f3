"""Figure 9: coarse and fine side by side."""

from __future__ import annotations

from matplotlib.figure import Figure

from groundplan.figures._dual import draw_connectivity, draw_subdivision
from groundplan.figures._labelled import counted, draw_found, name_of
from groundplan.figures._labels import key
from groundplan.figures._panels import (
    LEFT,
    RIGHT,
    bar_length,
    blank,
    fitted,
    foot,
    foot_height,
    header,
    map_panel,
    scale_bar,
    text_width,
)
from groundplan.figures._underlay import Underlay
from groundplan.survey import Survey


def coarse_and_fine(survey: Survey, coarse: Survey, fine: Survey, view: Underlay) -> Figure:
    """Figure 9: the coarse subdivision with labels, the fine one with its connectivity."""
    beside = view.size[0] < 1.7 * view.size[1]
    wide, high = fitted(view, *((5.6, 7.0) if beside else (9.4, 4.5)))
    handles = key(coarse)
    titles = [
        f"{name}: {counted(len(part.lines), 'line')}, {counted(len(part.subdivision.areas), 'face')}"
        for name, part in (("Coarse", coarse), ("Fine", fine))
    ]
    # On a narrow map the titles stand above the scale bars.
    free = wide * (1 - bar_length(view.extent, wide) / view.size[0])
    lift = 0.0 if all(1.2 * text_width(title) + 0.1 <= free for title in titles) else 0.2
    rise, gap, above = high + 0.5 + lift, max(0.5, 1.2 * max(map(text_width, titles)) - wide + 0.2), 0.35
    width = max(5.0, LEFT + 2 * wide + gap + RIGHT) if beside else LEFT + wide + RIGHT
    below = foot_height(width, handles)
    if beside:
        figure = blank(width, below + rise + above)
        corners = [(LEFT, below), (LEFT + wide + gap, below)]
    else:
        figure = blank(width, below + 2 * rise + above)
        corners = [(LEFT, below + rise), (LEFT, below)]
    header(figure, "Coarse for labels, fine for paths", [name_of(survey)])
    for (left, bottom), title, part in zip(corners, titles, (coarse, fine), strict=True):
        axes = map_panel(figure, view, left, bottom, wide, title, lift)
        view.draw(axes)
        scale_bar(axes, view.extent, wide)
        draw_subdivision(axes, part)
        if part is coarse:
            draw_found(axes, part)
        else:
            draw_connectivity(axes, part)
    foot(figure, handles)
    return figure
