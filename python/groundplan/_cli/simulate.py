"""groundplan simulate: a map of a place that never was, with its truth."""

from __future__ import annotations

import argparse
import dataclasses
from collections.abc import Callable
from typing import Any

from groundplan._cli import terminal
from groundplan._cli.arguments import Parser, place


def fill(own: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    kinds = own.add_subparsers(metavar="PLACE", required=True)
    kinds.add_parser(
        "warehouse",
        help="rack rows, aisles and cross aisles, driven and scanned by a robot",
        description="Write DIR/warehouse.pgm, DIR/warehouse.yaml and DIR/truth.json, and print their names. The same "
        "flags and seed give the same bytes.",
        fill=_fill_warehouse,
    )
    kinds.add_parser(
        "office",
        help="rooms along corridors with doors and furniture, driven and scanned by a robot",
        description="Write DIR/office.pgm, DIR/office.yaml, DIR/office.gt.png and DIR/truth.json, and print their "
        "names. The same flags and seed give the same bytes.",
        fill=_fill_office,
    )


def _fill_warehouse(own: Parser) -> None:
    from groundplan.simulate import WarehouseOptions

    _fill_place(own, "warehouse", WarehouseOptions)


def _fill_office(own: Parser) -> None:
    from groundplan.simulate import OfficeOptions

    _fill_place(own, "office", OfficeOptions)


def _fill_place(own: Parser, kind: str, options: type[Any]) -> None:
    own.usage = f"groundplan simulate {kind} -o DIR [--seed N] [flags]"
    own.set_defaults(parser=own, place=kind)
    own.add_argument("-o", "--out", metavar="DIR", type=place, required=True, help="where the files go")
    own.add_argument("--seed", type=_seed, default=0, metavar="N", help="zero or more (default: 0)")
    group = own.add_argument_group(f"the {kind}")
    for option in dataclasses.fields(options):
        group.add_argument("--" + option.name.replace("_", "-"), dest=option.name, **_flag(option))


def _flag(option: dataclasses.Field[Any]) -> dict[str, Any]:
    """What argparse is told of an option: all that its metadata says."""
    facts, default = option.metadata, option.default
    sentence = facts["help"].rstrip(".")
    if default is False:
        return {"action": "store_true", "default": None, "help": f"{sentence} (default: no)"}
    if "choices" in facts:
        return {"nargs": "+", "choices": facts["choices"], "metavar": "SIDE", "help": f"{sentence} (default: none)"}
    if "choice" in facts:
        return {"choices": facts["choice"], "metavar": "WORD", "help": f"{sentence} (default: {default})"}
    unit = f" {facts['unit']}" if "unit" in facts else ""
    return {
        "type": type(default),
        "metavar": "N" if isinstance(default, int) else "X",
        "help": f"{sentence}: {facts['least']:g} to {facts['most']:g}{unit} (default: {default:g})",
    }


def _seed(text: str) -> int:
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number from 0 on")
    return int(text)


def run(arguments: argparse.Namespace) -> None:
    """Simulate a place."""
    from groundplan import simulate

    options = {"warehouse": simulate.WarehouseOptions, "office": simulate.OfficeOptions}[arguments.place]
    make: Callable[..., simulate.Simulated] = getattr(simulate, arguments.place)
    names = [option.name for option in dataclasses.fields(options)]
    given = {name: value for name in names if (value := getattr(arguments, name)) is not None}
    if "closed_sides" in given:
        given["closed_sides"] = tuple(dict.fromkeys(given["closed_sides"]))
    with terminal.status() as status:
        made = terminal.working(status, f"driving the {arguments.place}", lambda: make(seed=arguments.seed, **given))
        yaml = made.write(arguments.out, arguments.place)
    rooms = [yaml.with_suffix(".gt.png")] if made.rooms is not None else []
    for file in (yaml.with_suffix(".pgm"), yaml, *rooms, yaml.with_name("truth.json")):
        terminal.put(f"{file}\n")
