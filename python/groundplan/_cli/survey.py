"""groundplan survey: from a map to its survey, picture and figures."""

from __future__ import annotations

import argparse
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from groundplan._cli import terminal
from groundplan._cli.arguments import Parser, add_reading, count, number, numbers, place, reading
from groundplan._cli.export import formats

if TYPE_CHECKING:
    from groundplan.maps import Map
    from groundplan.survey import Survey


def fill(own: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    own.usage = "groundplan survey MAP [-o DIR] [--figures] [--export LIST] [flags]"
    own.epilog = (
        "Of the parameters, what a flag says beats the file, and the file beats the default; of several flags for one "
        "parameter the last counts. groundplan parameters lists them."
    )
    own.add_argument(
        "map",
        metavar="MAP",
        help="a map_server YAML, an image (PGM, PNG, BMP, TIFF, JPEG), a bag of ROS 1 or 2, a GeoTIFF, a Zarr array or "
        "a point cloud (LAS, LAZ, E57); its content tells which",
    )
    own.add_argument(
        "-o",
        "--out",
        metavar="DIR",
        type=place,
        help="where survey.json and survey.png go (default: the map's name with -survey, in the current directory)",
    )
    drawn = own.add_mutually_exclusive_group()
    drawn.add_argument("--figures", action="store_true", help="draw the paper's figures 2 to 9 into DIR/figures too")
    drawn.add_argument("--no-picture", action="store_true", help="write no survey.png, which takes longest")
    own.add_argument(
        "--export",
        metavar="LIST",
        type=formats,
        default=[],
        help="write formats of other programs into DIR/export too; several with commas (groundplan export --list)",
    )
    own.add_argument(
        "--json",
        action="store_true",
        help="print the survey instead of the summary, and write files only where -o, --figures or --export asks",
    )
    own.add_argument(
        "--dask",
        metavar="ADDRESS",
        help="have the workers of the Dask scheduler at this address do what is done on pixels; the survey is the same",
    )
    own.add_argument("-q", "--quiet", action="store_true", help="no summary, no warnings: only errors are told")
    add_method(own)
    add_reading(own, frame=True)


def add_method(own: argparse.ArgumentParser) -> None:
    """Flags for how a map is surveyed."""
    own.add_argument("--name", metavar="NAME", help="what the survey calls the map (default: as its file or topic)")
    own.add_argument("--threads", type=count, metavar="N", help="at most so many; any number gives the same survey")
    group = own.add_argument_group("the method")
    either = group.add_mutually_exclusive_group()
    either.add_argument("--directions", action=_Set, name="directions.count", type=count, metavar="N", help="how many")
    either.add_argument(
        "--direction",
        action=_Set,
        name="directions.angles_deg",
        type=numbers,
        nargs="+",
        metavar="DEG",
        help="the directions themselves, in degrees in the map frame",
    )
    group.add_argument(
        "--detail",
        action=_Set,
        name="lines.detail",
        type=_detail,
        metavar="HOW",
        help="how fine: coarse, fine, or 0 (only the strongest lines) to 1 (default: found by itself)",
    )
    group.add_argument("--set", action=_Set, metavar="NAME=VALUE", help="any parameter; repeatable")
    group.add_argument("--config", metavar="FILE", help="parameters from a TOML file")


#: A flag that says one thing of two takes the other back, wherever the file says that.
_TAKES_BACK = {
    "directions.count": "directions.angles_deg",
    "directions.angles_deg": "directions.count",
    "lines.detail": "lines.min_amplitude",
}


class _Set(argparse.Action):
    """Parameters in the order in which they were typed."""

    def __init__(self, *args: Any, name: str | None = None, **options: Any) -> None:
        super().__init__(*args, **options)
        self.name = name
        self.dest = "settings"

    def __call__(
        self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, values: Any, flag: str | None = None
    ) -> None:
        settings = dict(namespace.settings or {})
        if self.name is None:
            from groundplan.parameters import named, parse

            settings |= named(dict([parse(values)]))
        else:
            if self.name in _TAKES_BACK:
                settings[_TAKES_BACK[self.name]] = None
            settings[self.name] = values
        namespace.settings = settings


def _detail(text: str) -> Any:
    if text in ("coarse", "fine"):
        return text
    try:
        return number(text)
    except argparse.ArgumentTypeError:
        raise argparse.ArgumentTypeError(f"{text!r} is neither coarse nor fine nor a number") from None


def settings(arguments: argparse.Namespace) -> dict[str, Any]:
    """Default < file < flag, held to the table before any map is read."""
    from groundplan.parameters import named, read_toml

    own = named(read_toml(arguments.config)) if arguments.config else {}
    _hold(own, arguments.parser, f"{arguments.config}: ")
    own |= arguments.settings or {}
    _hold(own, arguments.parser)
    return own


def _hold(own: dict[str, Any], parser: Parser, where: str = "") -> None:
    """Hold settings to the table; of a name that a flag has and no parameter, the hint is the flag."""
    from groundplan._errors import ParameterError
    from groundplan.parameters import resolve, table

    try:
        resolve(own)
    except ParameterError as fault:
        hint = fault.hint
        if fault.code == "parameter.unknown":
            known = {row.name for row in table()}
            name = next(name for name in own if name not in known)
            flag = parser.flag_of(name)
            if flag is None and not str(hint).startswith("did you mean"):  # [map] and below it resolution
                flag = parser.flag_of(name.rpartition(".")[2])
            hint = f"did you mean the flag {flag}?" if flag else hint
        raise ParameterError(fault.code, f"{where}{fault}", hint) from fault


def run(arguments: argparse.Namespace) -> None:
    """Survey a map."""
    import dataclasses

    import groundplan
    from groundplan._cli import export

    chosen, given = settings(arguments), reading(arguments)
    export.ready(arguments.export, {"map": ...})  # what is not installed is told before the work
    origin = arguments.origin
    if origin is not None and len(origin) not in (2, 3):
        arguments.parser.error(f"--origin has {len(origin)} numbers; it takes 2 or 3: X Y [YAW]")
    name = Path(arguments.map).name
    with terminal.status(arguments.quiet) as status:
        if arguments.dask:
            found, map = on_cluster(arguments, chosen, given, name, status)
        else:
            map = groundplan.read(
                arguments.map, progress=lambda share: status(f"reading {name}, {100 * share:.0f} %"), **given
            )
            refuse_nothing(map, name)
            found = terminal.working(
                status, f"surveying {name}", lambda: groundplan.survey(map, threads=arguments.threads, **chosen)
            )
        named = dataclasses.replace(found.map, image=printable(arguments.name or found.map.image))
        out = directory(arguments)
        found = found._with(map=named, source=seen_from(out or Path(), arguments.map), reading=given)
        picture = None if arguments.no_picture else "survey.png"
        written = [] if out is None else write(out, found, map, status, picture, arguments.figures)
        refused: export.Refused = {}
        told: list[str] = []
        if arguments.export:
            place = f"{Path(out or '') / 'export'}{os.sep}"
            files, refused, told = export.write(found, arguments.export, place, {"map": map}, status)
            written += [str(file) for file in files]
    if arguments.json:
        terminal.put(found.to_json())
    if not arguments.quiet:
        from groundplan._cli.summary import summary

        if not arguments.json:
            terminal.put(summary(found))
        for warning in found.warnings:
            terminal.say("warning", f"{warning.message} [{warning.code}]")
        for sentence in told:
            terminal.say("warning", sentence)
        for file in written:
            terminal.say("wrote", file)
    export.tell(refused)


def on_cluster(
    arguments: argparse.Namespace, chosen: dict[str, Any], given: dict[str, Any], name: str, status: terminal.Status
) -> tuple[Survey, Map]:
    """The survey of a map by the workers of a Dask scheduler, and the map for its picture."""
    from groundplan import _cluster

    with _cluster.connect(arguments.dask) as client:
        site = terminal.working(status, f"counting {name}", lambda: _cluster.open_map(arguments.map, given, client))
        refuse_nothing(site.map, name)
        return terminal.working(
            status,
            f"surveying {name}",
            lambda: _cluster.survey_site(site, client, chosen, arguments.threads, {}),
        )


def refuse_nothing(map: Map, name: str) -> None:
    """A map in which no robot can stand is no map to a person, though the method would give it one face.

    Raises
    ------
    MapError
        ``map.one-pixel``, ``map.no-free-space``.
    """
    from groundplan._errors import MapError

    if map.width * map.height == 1:
        raise MapError("map.one-pixel", f"{name} is a single pixel: there is nothing to survey")
    for warning in map.warnings:
        if warning.code == "no-free-space":
            hint = "--free-thresh, --occupied-thresh and --unknown say what the greys mean"
            raise MapError("map.no-free-space", f"{name}: {warning.message}: there is nothing to survey", hint)


def printable(path: str) -> str:
    """A path that UTF-8 can say: a file name may hold any bytes."""
    return os.fsencode(path).decode("utf-8", "replace")


def directory(arguments: argparse.Namespace) -> Path | None:
    """Where files go; None where none are asked for."""
    if arguments.out is not None:
        return Path(arguments.out)
    if arguments.json and not arguments.figures and not arguments.export:
        return None
    return Path(f"{Path(arguments.map).stem}-survey")


def seen_from(out: Path, map: str) -> str:
    """A map's path as a survey in `out` names it, with slashes: the same however either was typed."""
    path = Path(map).expanduser() if map.startswith("~") else Path(map)
    # Without links, because ".." leads out of what a link points to.
    there = Path(os.path.realpath(path.parent)) / path.name
    try:
        relative = os.path.relpath(there, os.path.realpath(out))
    except ValueError:  # on another drive
        relative = path.name
    return printable(Path(relative).as_posix())


def write(
    out: Path, survey: Survey, map: Map, status: terminal.Status, picture: str | None, figures: bool
) -> list[str]:
    """Write the files; the names of what was written."""
    from groundplan._files import whole

    # The survey is put in place after its picture: where the disk is full there is neither.
    with whole(out / "survey.json") as beside:
        survey._write_to(beside)
        if picture:
            from groundplan.figures import draw_survey

            status(f"drawing {picture}")
            draw_survey(survey, map, out / picture)
    written = [str(out / name) for name in ("survey.json", picture) if name]
    if figures:
        from groundplan.figures import draw_figures

        status("drawing the figures")
        drawn = draw_figures(survey, map, out / "figures", progress=lambda what: status(f"drawing {what}"))
        written.append(f"{out / 'figures'}{os.sep} ({len(drawn)} files)")
    return written
