"""groundplan figures: the paper's figures from a saved survey and its map."""

from __future__ import annotations

import argparse
import os
from pathlib import Path
from typing import TYPE_CHECKING

from groundplan._cli import terminal
from groundplan._cli.arguments import add_reading, place, reading
from groundplan._errors import FormatError

if TYPE_CHECKING:
    from groundplan.maps import Map
    from groundplan.survey import Survey

FORMATS = ("png", "svg", "pdf")


def fill(own: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    own.usage = "groundplan figures SURVEY [--map MAP] [-o DIR] [--format png,svg] [flags]"
    own.epilog = (
        "The map is read as it was for the survey; a flag beats what the survey says of that. The names of the files "
        "are printed."
    )
    own.add_argument("survey", metavar="SURVEY", type=Path, help="a survey.json, or the directory that holds it")
    own.add_argument("--map", metavar="MAP", help="the surveyed map, where the survey's own name for it leads nowhere")
    own.add_argument(
        "-o", "--out", metavar="DIR", type=place, help="where the figures go (default: figures, beside the survey)"
    )
    own.add_argument(
        "--format", type=formats, default=("png", "svg"), metavar="png,svg", help="png, svg or pdf, or several of them"
    )
    own.add_argument("-q", "--quiet", action="store_true", help="print no names: only errors are told")
    add_reading(own, frame=False)


def formats(text: str) -> tuple[str, ...]:
    """Formats with commas."""
    chosen = tuple(dict.fromkeys(part.strip().lower() for part in text.split(",")))
    wrong = [part for part in chosen if part not in FORMATS]
    if wrong:
        raise argparse.ArgumentTypeError(f"{wrong[0]!r} is none of {', '.join(FORMATS)}")
    return chosen


def run(arguments: argparse.Namespace) -> None:
    """Draw the figures."""
    from groundplan.maps import read

    path, survey = open_survey(arguments.survey)
    source = arguments.map if arguments.map is not None else find_map(survey, path)
    frame = {"resolution": survey.map.resolution, "origin": survey.map.origin}
    with terminal.status(arguments.quiet) as status:
        map = read(source, **{**survey.reading, **reading(arguments), **frame})
        agree(survey, map, path, source, arguments.quiet)
        status("drawing the figures")
        from groundplan.figures import draw_figures

        out = arguments.out if arguments.out is not None else path.parent / "figures"
        drawn = draw_figures(
            survey, map, out, formats=arguments.format, progress=lambda what: status(f"drawing {what}")
        )
    if not arguments.quiet:
        terminal.put("".join(f"{path}\n" for path in drawn))


def survey_file(given: Path) -> Path:
    """A survey's file, given that or its directory."""
    return given / "survey.json" if given.is_dir() else given


def open_survey(given: Path) -> tuple[Path, Survey]:
    """A survey's file, given that or its directory, and what is in it; errors name the file.

    Raises
    ------
    FormatError
        As `Survey.read`.
    """
    from groundplan.survey import Survey

    file = survey_file(given)
    try:
        return file, Survey.read(file)
    except FormatError as fault:
        if fault.code == "survey.read":
            raise
        hint = fault.hint
        if fault.code == "survey.json" and file.suffix != ".json":
            hint = f"a map is surveyed first: groundplan survey {file}"
        raise FormatError(fault.code, f"{file}: {fault}", hint) from fault


def find_map(survey: Survey, path: Path) -> str:
    """The map that a survey names, seen from the survey's directory, from here, or from a directory above.

    Raises
    ------
    FormatError
        ``survey.source`` when it names none, or one that is not there.
    """
    if survey.source is None:
        raise FormatError("survey.source", f"{path} does not say which map it is of", "--map MAP names it")
    # A survey that was printed is of the directory where that was done, maybe one above.
    for seen in (path.resolve().parent, Path(), *path.absolute().parents):
        if (seen / survey.source).exists():
            return os.path.normpath(seen / survey.source)
    raise FormatError(
        "survey.source", f"{path} is of the map {survey.source}, which is not there", "--map MAP says where it is now"
    )


def agree(survey: Survey, map: Map, path: Path, source: str, quiet: bool) -> None:
    """Refuse a map of another size; warn of one that reads otherwise than when it was surveyed.

    Raises
    ------
    FormatError
        ``survey.map``.
    """
    info = survey.map
    if (info.width, info.height) != (map.width, map.height):
        raise FormatError(
            "survey.map",
            f"{source} has {map.width} x {map.height} pixels, but {path} is of a map of {info.width} x {info.height}",
            "--map MAP names the one that was surveyed",
        )
    import numpy as np

    from groundplan.maps import UNKNOWN
    from groundplan.maps._warnings import percent

    counts = np.zeros(256, np.int64)
    for row in map.pixels:  # no copy of a map that may be larger than memory
        counts += np.bincount(row, minlength=256)
    now = int(counts[map.states == UNKNOWN].sum())
    then = round(float((survey.occupancy.unknown * survey.occupancy.pixels).sum()))
    if now != then and not quiet:
        total = map.width * map.height
        terminal.say(
            "warning",
            f"{percent(now / total)} of {source} is unknown, and {percent(then / total)} was when it was "
            "surveyed: it was read with other flags then",
        )
