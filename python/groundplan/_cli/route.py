"""groundplan route: the way from one place of a surveyed map to another."""

from __future__ import annotations

import argparse
import json
import re
from pathlib import Path
from typing import TYPE_CHECKING

from groundplan._cli import terminal
from groundplan._cli.arguments import add_reading, number, reading
from groundplan._errors import FormatError

if TYPE_CHECKING:
    from groundplan.maps import Map
    from groundplan.survey import Survey

#: The exit code where there is no way.
NO_WAY = 4
#: So many racks are named.
SHOWN = 5


def fill(own: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    own.usage = "groundplan route SURVEY A B [--clearance M] [--figure FILE] [flags]"
    own.epilog = (
        "Prints the bends of the way, x and y in metres in the map frame, one on a line. Exit code 4: there is no way. "
        "Without its map a survey knows its regions and what lies on lines, but not what is small."
    )
    # A point may begin with a minus.
    own._negative_number_matcher = re.compile(r"^-[\d.]")
    own.add_argument("survey", metavar="SURVEY", type=Path, help="a survey.json, or the directory that holds it")
    for name, what in (("a", "where it begins"), ("b", "and ends")):
        own.add_argument(
            name,
            metavar=name.upper(),
            type=spot,
            help=f"{what}: a point X,Y in metres, a label's name (A01, or J01 as in exports), or a face's id",
        )
    own.add_argument(
        "--clearance", type=number, default=0.3, metavar="M", help="to keep from what is occupied, m (default: 0.3)"
    )
    own.add_argument("--around-racks", action="store_true", help="take racks as occupied, be they on legs or empty")
    own.add_argument("--map", metavar="MAP", help="the surveyed map, where the survey's own name for it leads nowhere")
    own.add_argument("--figure", metavar="FILE", type=Path, help="draw it over the map: a PNG, SVG or PDF")
    own.add_argument("--json", action="store_true", help="print points, faces and length as JSON")
    own.add_argument("-q", "--quiet", action="store_true", help="only errors are told")
    add_reading(own, frame=False)


def spot(text: str) -> str | int | tuple[float, float]:
    """A place as it is typed."""
    parts = text.split(",")
    if len(parts) == 2:
        return number(parts[0]), number(parts[1])
    return int(text) if text.isdecimal() else text


def run(arguments: argparse.Namespace) -> None:
    """Find the way."""
    from groundplan._cli.figures import open_survey

    path, survey = open_survey(arguments.survey)
    with terminal.status(arguments.quiet) as status:
        map = _map(arguments, survey, path)
        status("looking for the way")
        way = survey.route(
            arguments.a, arguments.b, clearance=arguments.clearance, around_racks=arguments.around_racks, map=map
        )
        if way is not None and arguments.figure is not None:
            if map is None:
                raise FormatError("survey.source", "a figure is drawn over the map", "--map MAP says where it is")
            status("drawing the way")
            from groundplan.figures import draw_route

            draw_route(survey, map, way, arguments.figure)
    if way is None:
        ends = " and ".join(_said(place) for place in (arguments.a, arguments.b))
        terminal.say(
            "error", f"there is no way between {ends} that keeps {arguments.clearance:g} m from what is occupied"
        )
        if arguments.clearance > 0:
            from groundplan._queries import LESS

            terminal.say("hint", LESS)
        raise SystemExit(NO_WAY)
    if way.racks and not arguments.around_racks and not arguments.quiet:
        terminal.say("warning", f"the way leads under or through {_listed(way.racks)}: on legs, or with empty bays")
        terminal.say("hint", "--around-racks takes racks as occupied")
    if arguments.json:
        answer = {
            "length": way.length,
            "clearance": way.clearance,
            "racks": list(way.racks),
            "points": way.points.tolist(),
            "faces": way.faces.tolist(),
        }
        terminal.put(json.dumps(answer) + "\n")
    else:
        terminal.put("".join(f"{x:.3f} {y:.3f}\n" for x, y in way.points.tolist()))


def _listed(names: tuple[str, ...]) -> str:
    shown = ", ".join(names[:SHOWN])
    return shown if len(names) <= SHOWN else f"{shown} and {len(names) - SHOWN} more"


def _said(place: str | int | tuple[float, float]) -> str:
    if isinstance(place, tuple):
        return f"({place[0]:g}, {place[1]:g})"
    return f"face {place}" if isinstance(place, int) else place


def _map(arguments: argparse.Namespace, survey: Survey, path: Path) -> Map | None:
    """The surveyed map; without it the way is found over what the survey knows."""
    from groundplan._cli.figures import agree, find_map
    from groundplan.maps import read

    try:
        source = arguments.map if arguments.map is not None else find_map(survey, path)
    except FormatError as fault:
        if not arguments.quiet:
            terminal.say("warning", f"{fault}: the way is found over what the survey knows")
        return None
    frame = {"resolution": survey.map.resolution, "origin": survey.map.origin}
    map = read(source, **{**survey.reading, **reading(arguments), **frame})
    agree(survey, map, path, source, arguments.quiet)
    return map
