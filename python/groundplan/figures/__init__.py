"""The paper's figures, drawn from a survey and its map.

    from groundplan.figures import draw_figures, draw_survey

    draw_survey(survey, map, "survey.png")
    draw_figures(survey, map, "figures")

Numbers are those of Gholami Shahbandi, Åstrand and Philippsen (ICARCV 2014). Everything is drawn in the map frame.
matplotlib is imported with this package, and this package by nothing but its users.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from matplotlib.figure import Figure

from groundplan._pipeline import survey as make_survey
from groundplan._queries import Route
from groundplan.figures._details import coarse_and_fine
from groundplan.figures._directions import directions, radiograms
from groundplan.figures._dual import abstraction, connectivity, edge_features, subdivision_and_dual
from groundplan.figures._labelled import labelled
from groundplan.figures._roads import roads as road_sheet
from groundplan.figures._route import route as route_sheet
from groundplan.figures._style import DPI, save, style
from groundplan.figures._underlay import Underlay, underlay
from groundplan.maps import Map
from groundplan.parameters import table
from groundplan.roadmap import RoadMap
from groundplan.survey import Survey

__all__ = ["draw_figures", "draw_road_map", "draw_route", "draw_survey"]


def draw_survey(survey: Survey, map: Map, path: str | os.PathLike[str]) -> Path:
    """Draw the labelled map (Fig. 8) to `path`: PNG, SVG or PDF, by its suffix.

    Raises
    ------
    FormatError
        ``file.write`` when the place cannot be written.
    """
    target = Path(path)
    with style():
        figure, dpi = labelled(survey, underlay(map))
        return save(figure, target, dpi)


def draw_road_map(survey: Survey, map: Map, roads: RoadMap, path: str | os.PathLike[str]) -> Path:
    """Draw a road map over the map to `path`: PNG, SVG or PDF, by its suffix.

    Raises
    ------
    FormatError
        ``file.write`` when the place cannot be written.
    """
    with style():
        figure, dpi = road_sheet(survey, roads, underlay(map))
        return save(figure, Path(path), dpi)


def draw_route(survey: Survey, map: Map, way: Route, path: str | os.PathLike[str]) -> Path:
    """Draw a way over the map to `path`: PNG, SVG or PDF, by its suffix.

    Raises
    ------
    FormatError
        ``file.write`` when the place cannot be written.
    """
    with style():
        figure, dpi = route_sheet(survey, way, underlay(map))
        return save(figure, Path(path), dpi)


def draw_figures(
    survey: Survey,
    map: Map,
    directory: str | os.PathLike[str],
    formats: Sequence[str] = ("png", "svg"),
    progress: Callable[[str], None] | None = None,
) -> list[Path]:
    """Draw figures 2 to 9 into `directory`, each in every one of `formats` (png, svg, pdf).

    Figure 9 surveys the map twice more, coarse and fine, along the directions that the survey has. `progress` is
    told the name of each figure before it is drawn. Returns the files, in the order of their numbers.

    Raises
    ------
    FormatError
        ``file.write`` when the place cannot be written.
    """
    written: list[Path] = []
    with style():
        for name, figure, dpi in figures(survey, map, progress or (lambda text: None)):
            written += [save(figure, Path(directory) / f"{name}.{suffix}", dpi) for suffix in formats]
    return written


def figures(survey: Survey, map: Map, progress: Callable[[str], None]) -> Iterator[tuple[str, Figure, float]]:
    """Each figure's name, the figure, and its dots per inch; drawn as they are asked for."""
    # A quarter of the pixels does for figures that share a sheet, and keeps an SVG small.
    whole, small = underlay(map), underlay(map, longest=1200)
    drawn: list[tuple[str, Callable[[], Figure]]] = [
        ("figure-2-directions", lambda: directions(survey, small)),
        ("figure-3-radiograms", lambda: radiograms(survey, small)),
        ("figure-4-subdivision", lambda: subdivision_and_dual(survey, whole)),
        ("figure-5d-edge-features", lambda: edge_features(survey)),
        ("figure-6-abstraction", lambda: abstraction(survey, small)),
        ("figure-7-connectivity", lambda: connectivity(survey, small)),
    ]
    for name, draw in drawn:
        progress(name)
        yield name, draw(), DPI
    progress("figure-8-labels")
    yield "figure-8-labels", *labelled(survey, whole)
    progress("figure-9-coarse-and-fine")
    yield "figure-9-coarse-and-fine", _compared(survey, map, small), DPI


def _compared(survey: Survey, map: Map, view: Underlay) -> Figure:
    """Figure 9, from two more surveys that differ from this one in their detail alone."""
    known = {row.name for row in table()} - {"lines.detail", "lines.min_amplitude"}
    same = {name: value for name, value in survey.parameters.items() if name in known and value is not None}
    coarse, fine = (
        make_survey(map, directions=survey.directions, lines_detail=detail, **same) for detail in ("coarse", "fine")
    )
    return coarse_and_fine(survey, coarse, fine, view)
