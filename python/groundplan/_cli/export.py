"""groundplan export: a saved survey in the formats of other programs."""

from __future__ import annotations

import argparse
import math
import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from groundplan._cli import terminal
from groundplan._cli.arguments import add_reading, number, reading
from groundplan._extras import installs, missing
from groundplan.export import FORMATS, OPTIONS, Format, Option, format_named

if TYPE_CHECKING:
    from groundplan._errors import GroundplanError
    from groundplan.maps import Map
    from groundplan.survey import Survey


def fill(own: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    own.usage = "groundplan export SURVEY --to FORMAT[,FORMAT] [-o PATH] [flags]\n       groundplan export --list"
    own.epilog = "The names of the files are printed."
    own.add_argument("survey", metavar="SURVEY", type=Path, nargs="?", help="a survey.json, or the directory of one")
    own.add_argument("--to", metavar="FORMAT", type=formats, help=f"{', '.join(FORMATS)}; several with commas, or all")
    own.add_argument("--list", action="store_true", help="say of each format what it holds and who reads it")
    own.add_argument(
        "-o",
        "--out",
        metavar="PATH",
        type=path,
        help="the file, or a directory for files with the map's name (default: export, beside the survey)",
    )
    own.add_argument(
        "--map",
        metavar="MAP",
        help="the surveyed map, for formats that use its pixels, where the survey's own name for it leads nowhere",
    )
    own.add_argument("-q", "--quiet", action="store_true", help="print no names: only errors are told")
    add_options(own)
    add_reading(own, frame=False)


def add_options(own: argparse.ArgumentParser) -> None:
    """A flag for each option of a format."""
    group = own.add_argument_group("formats")
    for name, option in OPTIONS.items():
        takers = ", ".join(form.name for form in FORMATS.values() if name in form.options)
        group.add_argument(
            f"--{name.replace('_', '-')}",
            dest=f"option_{name}",
            metavar=option.metavar,
            type=_type(option),
            choices=option.choices or None,
            help=f"{option.sentence} [{takers}]",
        )


def _type(option: Option) -> Any:
    return {"number": _number, "numbers": _listed}.get(option.kind, str)


def _number(text: str) -> float:
    value = number(text)
    if not 0 <= value < math.inf:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number from 0 on")
    return value


def _listed(text: str) -> list[float]:
    return [number(part) for part in text.split(",")]


def path(text: str) -> str:
    """Where to write to; kept as typed, because a slash behind it says that it is a directory."""
    if not text:
        raise argparse.ArgumentTypeError("the path has no name")
    return text


def formats(text: str) -> list[Format]:
    """Formats with commas, or all of them."""
    from groundplan._errors import ParameterError

    if text == "all":
        return list(FORMATS.values())
    try:
        return [format_named(name) for name in dict.fromkeys(part.strip() for part in text.split(","))]
    except ParameterError as fault:
        raise argparse.ArgumentTypeError(f"{fault}; {fault.hint}") from fault


def options(arguments: argparse.Namespace, forms: list[Format]) -> dict[str, Any]:
    """The options that were typed, each taken by one of the formats at least."""
    given = {name: getattr(arguments, f"option_{name}") for name in OPTIONS}
    given = {name: value for name, value in given.items() if value is not None}
    for name in given:
        if not any(name in form.options for form in forms):
            takers = ", ".join(form.name for form in FORMATS.values() if name in form.options)
            chosen = ", ".join(form.name for form in forms)
            arguments.parser.error(f"--{name.replace('_', '-')} says nothing to {chosen}", f"it is for {takers}")
    return given


def run(arguments: argparse.Namespace) -> None:
    """Write a survey in other formats."""
    if arguments.list:
        terminal.put(listed())
        return
    if arguments.survey is None or arguments.to is None:
        wanted = [
            said for said, given in (("a SURVEY", arguments.survey), ("--to FORMAT", arguments.to)) if given is None
        ]
        are = "is" if len(wanted) == 1 else "are"
        arguments.parser.error(f"{' and '.join(wanted)} {are} needed", "groundplan export --list")
    from groundplan._cli.figures import open_survey

    given = options(arguments, arguments.to)
    file, survey = open_survey(arguments.survey)
    with terminal.status(arguments.quiet) as status:
        map = _map(arguments, survey, file, given)
        if map is not None:
            given["map"] = map
        out = arguments.out or f"{file.parent / 'export'}{os.sep}"
        written, refused, told = write(survey, arguments.to, out, given, status)
    if not arguments.quiet:
        for sentence in told:
            terminal.say("warning", sentence)
        terminal.put("".join(f"{file}\n" for file in written))
    tell(refused)


def _map(arguments: argparse.Namespace, survey: Survey, file: Path, given: dict[str, Any]) -> Map | None:
    """The surveyed map, where a format has a use for it; None where it is not needed and not to be had."""
    from groundplan._cli.figures import agree, find_map
    from groundplan._errors import GroundplanError
    from groundplan.maps import read

    # Of the graphs, the road map's alone has a use for pixels.
    uses = {"no" if _is_of_places(form, given) else form.map for form in arguments.to}
    if uses == {"no"}:
        return None
    try:
        source = arguments.map if arguments.map is not None else find_map(survey, file)
        frame = {"resolution": survey.map.resolution, "origin": survey.map.origin}
        map = read(source, **{**survey.reading, **reading(arguments), **frame})
        agree(survey, map, file, source, arguments.quiet)
    except GroundplanError as fault:
        if arguments.map is not None or ("must" in uses and len(arguments.to) < len(FORMATS)):
            raise
        if not arguments.quiet:
            terminal.say("warning", f"written without the map's pixels: {fault}")
        return None
    return map


#: Formats that were not written, and why.
Refused = dict[str, "GroundplanError"]


def ready(forms: list[Format], given: dict[str, Any]) -> Refused:
    """Refuse what can be refused before the first is written; of all formats, leave out those that lack something."""
    from groundplan._errors import GroundplanError
    from groundplan.export import prepare

    missing: Refused = {}
    for form in forms:
        try:
            prepare([form], _own(form, given))
        except GroundplanError as fault:
            if fault.code not in ("extra.missing", "export.map") or len(forms) < len(FORMATS):
                raise
            missing[form.name] = fault
    return missing


def write(
    survey: Survey, forms: list[Format], out: str | Path, given: dict[str, Any], status: terminal.Status
) -> tuple[list[Path], Refused, list[str]]:
    """Write formats, each with the options that it takes; of several, one that cannot say this survey stops none.

    What was written, what was refused, and what is to be said of their road map.
    """
    from groundplan._errors import FormatError
    from groundplan.export import export
    from groundplan.roadmap import built_once

    refused = ready(forms, given)
    place = out if len(forms) == 1 else f"{out}{os.sep}"
    written: list[Path] = []
    with built_once():
        for form in forms:
            if form.name in refused:
                continue
            status(f"writing {form.name}")
            try:
                written += export(survey, place, form, **_own(form, given))
            except FormatError as fault:
                if len(forms) == 1 or not fault.code.startswith("export."):
                    raise
                refused[form.name] = fault
        told = list(told_lanes(survey, [form for form in forms if form.name not in refused], given))
    return written, refused, told


#: So many pieces of lane, or corridors, are named, and the others counted.
NAMED = 4


def told_lanes(survey: Survey, forms: list[Format], given: dict[str, Any]) -> Iterator[str]:
    """What the road map leaves out: what a vehicle does not fit, where something stands in its way, or all."""
    if not any("spurs" in form.options and not _is_of_places(form, given) for form in forms):
        return
    from groundplan.export._formats import ROADS
    from groundplan.roadmap import road_map

    roads = road_map(survey, **{name: given[name] for name in (*ROADS, "map") if name in given})
    fits = "fits the vehicle" if "vehicle_width" in given else "has a lane"
    if not roads.lanes:
        yield f"the road map is empty: no corridor, and no door between regions, {fits}"
    # Without a vehicle they are gaps for people, and no lane is expected there.
    if roads.narrow and "vehicle_width" in given:
        out, all = len(roads.narrow), len(survey.of_kind("corridor"))
        asked = f"narrower than the {given['vehicle_width']:g} m asked for"
        said = f"is {asked} and has" if out == 1 else f"are {asked} and have"
        named = [f"{corridor.id} ({corridor.width:.2f} m)" for corridor in roads.narrow]
        yield f"{out} of {all} corridors {said} no lane: {_some(named)}"
    if roads.blocked:
        named = [f"{piece.id} at ({piece.at[0]:.2f}, {piece.at[1]:.2f})" for piece in roads.blocked]
        out, stay = len(roads.blocked), sum(lane.kind == "aisle" for lane in roads.lanes)
        said = "1 lane of an aisle is" if out == 1 else f"{out} lanes of aisles are"
        yield f"{said} left out where something stands in the way, {stay} stay: {_some(named)}"


def _some(named: list[str]) -> str:
    """The first of a list, and how many more there are."""
    more = [f"{len(named) - NAMED} more"] if len(named) > NAMED else []
    return ", ".join(named[:NAMED] + more)


def _is_of_places(form: Format, given: dict[str, Any]) -> bool:
    """Whether a format of graphs writes another one than the road map's."""
    return "graph" in form.options and given.get("graph") != "roads"


def _own(form: Format, given: dict[str, Any]) -> dict[str, Any]:
    """The options that a format takes."""
    return {k: v for k, v in given.items() if k in form.options or (k == "map" and form.map != "no")}


def tell(refused: Refused) -> None:
    """Say which formats were not written and why, and end as the first of them would by itself.

    Raises
    ------
    GroundplanError
        Where there are any.
    """
    hints = set()
    for name, fault in refused.items():
        terminal.say("refused", f"{name}: {fault}")
        if fault.hint not in hints:
            terminal.say("hint", fault.hint)
            hints.add(fault.hint)
    if refused:
        first = next(iter(refused.values()))
        raise type(first)(first.code, f"not written: {', '.join(refused)}")


def listed() -> str:
    """A paragraph for each format."""
    rows = []
    for form in FORMATS.values():
        rows.append((form.name, form.holds))
        rows.append(("", f"for {form.readers}; tested with {form.tested}"))
        told = [f"--{name.replace('_', '-')}" for name in form.options] + ["--map"] * (form.map != "no")
        rows.append(("", f"NAME{form.suffix}{'; takes ' if told else ''}{', '.join(told)}"))
        if form.extra:
            lacking = ", ".join(missing(form.needs))
            there = f"{', '.join(form.needs)}, installed"
            rows.append(("", f"needs {f'{lacking}, not installed: {installs(form.extra)}' if lacking else there}"))
    return "\n".join(terminal.columns(rows)) + "\n"
