"""The parser, and the arguments that several commands take."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterable, Sequence
from importlib import import_module
from pathlib import Path
from typing import Any, NoReturn

from groundplan._cli import terminal
from groundplan._errors import MapError

COMMANDS = {
    "survey": "find the directions, walls, corridors and junctions of a map",
    "watch": "keep a survey of a live topic up to date",
    "figures": "draw the paper's figures from a saved survey",
    "route": "find the way from one place of a saved survey to another",
    "export": "write a saved survey for CAD, fleets, warehouse systems and other programs",
    "simulate": "make a map of a place that never was, with its truth",
    "evaluate": "score a survey against a truth, or the method on a suite of simulated maps",
    "parameters": "list every parameter that survey takes by --set and --config",
}


def _formatter(prog: str) -> argparse.HelpFormatter:
    """Room for our longest flag, and no lines too long to read."""
    return argparse.HelpFormatter(prog, max_help_position=26, width=min(terminal.width() - 2, 100))


class Parser(argparse.ArgumentParser):
    """A parser that is filled when it is used, and speaks of errors as the rest of the program does."""

    def __init__(self, *, fill: Callable[[Parser], None] | None = None, **options: Any) -> None:
        settled: dict[str, Any] = {"allow_abbrev": False, "formatter_class": _formatter} | options
        super().__init__(**settled)
        self._fill = fill

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """As argparse does, with the command's arguments added first."""
        if self._fill is not None:
            fill, self._fill = self._fill, None
            fill(self)
        return super().parse_known_args(args, namespace)

    def parse(self, argv: Sequence[str] | None) -> argparse.Namespace:
        """The arguments, or exit code 2 and the nearest flag or command there is."""
        words = list(sys.argv[1:] if argv is None else argv)
        if not words:
            self.print_help(sys.stderr)
            self.exit(2)
        if not words[0].startswith("-") and words[0] not in COMMANDS:
            self._refuse_command(words[0])
        known, extra = self.parse_known_args(words)
        arguments: argparse.Namespace = known
        if extra:
            arguments.parser._refuse_argument(extra[0])
        return arguments

    def error(self, message: str, hint: str | None = None) -> NoReturn:
        """Say what is wrong and leave with exit code 2."""
        terminal.say("error", message)
        terminal.say("hint", hint or f"{self.prog} --help")
        self.exit(2)

    def flag_of(self, name: str) -> str | None:
        """The flag of a name, whatever stands between its words; None where there is none."""
        flag = "--" + name.replace(".", "-").replace("_", "-")
        return flag if flag in self._option_string_actions else None

    def _refuse_command(self, word: str) -> NoReturn:
        near = nearest(word, COMMANDS)
        hint = f"did you mean {self.prog} {near}?" if near else None
        if not near and Path(word).suffix:
            hint = f"{self.prog} survey {word}"
        self.error(f"there is no command {word!r}", hint)

    def _refuse_argument(self, word: str) -> NoReturn:
        if not word.startswith("-"):
            self.error(f"one argument too many: {word!r}", (self.usage or "").partition("\n")[0] or None)
        flag = word.partition("=")[0]
        near = nearest(flag.lstrip("-"), [name[2:] for name in self._option_string_actions if name.startswith("--")])
        self.error(f"there is no flag {flag}", f"did you mean --{near}?" if near else None)


def nearest(word: str, names: Iterable[str]) -> str | None:
    """The name that `word` was most likely meant to be: at most a third of its letters are wrong."""
    apart = {name: _distance(word, name) for name in names}
    best = min(apart, key=lambda name: apart[name], default=None)
    return best if best is not None and 3 * apart[best] <= len(best) else None


def _distance(a: str, b: str) -> int:
    """Letters to change, put in, take out or swap with the next to make one word the other."""
    before, row = [0] * (len(b) + 1), list(range(len(b) + 1))
    for i, letter in enumerate(a, 1):
        earlier, before, row = before, row, [i] * (len(b) + 1)
        for j, other in enumerate(b, 1):
            row[j] = min(before[j] + 1, row[j - 1] + 1, before[j - 1] + (letter != other))
            if i > 1 and j > 1 and (letter, a[i - 2]) == (b[j - 2], other):
                row[j] = min(row[j], earlier[j - 2] + 1)
    return row[-1]


def parser() -> Parser:
    """The whole command line; a command's own arguments are added when it is chosen."""
    listed = "\n".join(f"  {name:<12}{sentence}" for name, sentence in COMMANDS.items())
    top = Parser(
        prog="groundplan",
        usage="groundplan COMMAND ...",
        description="Groundplan surveys robot maps: it finds the ground plan in an occupancy grid.",
        epilog=f"commands:\n{listed}\n\nStart with: groundplan survey MAP.yaml\n"
        "Each command tells more: groundplan survey --help",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    top.add_argument("--version", action=_Version, nargs=0, help="print the version and exit")
    commands = top.add_subparsers(prog="groundplan", metavar="COMMAND", required=True, help=argparse.SUPPRESS)
    for name, sentence in COMMANDS.items():

        def fill(own: Parser, name: str = name) -> None:
            module = import_module(f"groundplan._cli.{name}")
            own.set_defaults(run=module.run, parser=own)
            module.fill(own)

        commands.add_parser(name, help=sentence, description=f"{sentence[0].upper()}{sentence[1:]}.", fill=fill)
    return top


class _Version(argparse.Action):
    """Asks the core for the version only when it is wanted."""

    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> None:
        import groundplan

        terminal.put(f"groundplan {groundplan.__version__}\n")
        parser.exit()


def place(text: str) -> Path:
    """A directory to write to; what a shell variable without a value leaves is none."""
    if not text:
        raise argparse.ArgumentTypeError("the directory has no name")
    return Path(text)


def number(text: str) -> float:
    """A number as an argument."""
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number") from None


def numbers(text: str) -> float:
    """A number of several. What is typed behind them by mistake is taken for one of them."""
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number; what is not one comes before this flag") from None


def share(text: str) -> float:
    """A number from 0 to 1."""
    value = number(text)
    if not 0 <= value <= 1:
        raise argparse.ArgumentTypeError(f"{text!r} is not between 0 and 1")
    return value


def metres_per_pixel(text: str) -> float:
    """A resolution that a map can have."""
    from groundplan.maps.map_server import check_resolution

    try:
        return check_resolution(text)
    except MapError as fault:
        raise argparse.ArgumentTypeError(str(fault)) from None


def greys(text: str) -> str | list[int]:
    """Greys with commas, none, or auto."""
    if text in ("none", "auto"):
        return text
    listed = [int(part) if part.strip().isdecimal() else -1 for part in text.split(",")]
    if not all(0 <= grey <= 255 for grey in listed):
        raise argparse.ArgumentTypeError(f"{text!r} is neither none nor greys between 0 and 255")
    return listed


def count(text: str) -> int:
    """A whole number from 1 on."""
    try:
        value = int(text)
    except ValueError:
        value = 0
    if value < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number from 1 on")
    return value


def add_reading(own: argparse.ArgumentParser, *, frame: bool) -> None:
    """Flags for how a map's file is read; `frame`: its resolution and origin too."""
    group = own.add_argument_group("reading the map", "What is given here beats what the file says.")
    if frame:
        group.add_argument(
            "--resolution",
            type=metres_per_pixel,
            metavar="M",
            help="metres per pixel; an image alone needs it (default for a point cloud: 0.05)",
        )
        group.add_argument(
            "--origin",
            type=numbers,
            nargs="+",
            metavar=("X", "Y YAW"),
            help="pose of the lower left corner: m, m, and rad if it is turned (default for an image: 0 0)",
        )
    group.add_argument(
        "--dialect",
        choices=("nav2", "nav2-humble", "ros1"),
        metavar="WHOSE",
        help="the map_server to follow: nav2 (default), nav2-humble or ros1",
    )
    group.add_argument(
        "--unknown",
        type=greys,
        metavar="GREY,...",
        help="greys that mean unknown, 0 to 255; none: as the thresholds say (default: finds itself)",
    )
    group.add_argument(
        "--negate", action=argparse.BooleanOptionalAction, help="white is occupied and black is free, or the contrary"
    )
    group.add_argument(
        "--mode",
        choices=("trinary", "scale", "raw"),
        metavar="HOW",
        help="how greys become occupancy: trinary, scale or raw",
    )
    group.add_argument("--occupied-thresh", type=share, metavar="P", help="occupied from this darkness on, 0 to 1")
    group.add_argument("--free-thresh", type=share, metavar="P", help="free up to this darkness, 0 to 1")
    bag = own.add_argument_group("reading a bag")
    bag.add_argument("--topic", metavar="NAME", help="the topic with the map (default: the only one, or /map)")
    bag.add_argument(
        "--stamp", type=number, metavar="S", help="the map as it was then, by its header, s (default: the last)"
    )
    cloud = own.add_argument_group("reading a point cloud", "What no points hit is read as free space.")
    cloud.add_argument(
        "--band", type=numbers, nargs=2, metavar=("Z0", "Z1"), help="heights of the points that count, m; always needed"
    )
    cloud.add_argument("--min-hits", type=count, metavar="N", help="points that make a pixel occupied (default: 2)")


def reading(arguments: argparse.Namespace) -> dict[str, Any]:
    """What the flags of `add_reading` say, as `groundplan.read` takes it: only those that were given."""
    from groundplan._tree import READING

    return {name: value for name in READING if (value := getattr(arguments, name, None)) is not None}
