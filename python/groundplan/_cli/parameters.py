"""groundplan parameters: the table of parameters."""

from __future__ import annotations

import argparse
import textwrap
from typing import TYPE_CHECKING, Any

from groundplan._cli import terminal

if TYPE_CHECKING:
    from groundplan.parameters import Parameter


def fill(own: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    own.usage = "groundplan parameters [--json | --markdown]"
    own.epilog = "For example: groundplan survey MAP.yaml --set lines.snr=4 --set directions.count=2"
    either = own.add_mutually_exclusive_group()
    either.add_argument("--json", action="store_true", help="as a JSON list")
    either.add_argument("--markdown", action="store_true", help="as the page docs/parameters.md")


def run(arguments: argparse.Namespace) -> None:
    """Print the table."""
    from groundplan.parameters import table

    rows = table()
    if arguments.json:
        import dataclasses
        import json

        terminal.put(json.dumps([dataclasses.asdict(row) for row in rows], indent=1, ensure_ascii=False) + "\n")
    else:
        terminal.put(markdown(rows) if arguments.markdown else listing(rows, min(terminal.width(), 100)))


def listing(rows: list[Parameter], columns: int) -> str:
    """For the terminal: a line of facts for each, and its sentence below."""
    facts = [(row.name, _default(row), row.range + (f" {row.unit}" if row.unit else ""), row.section) for row in rows]
    heads = terminal.columns([("NAME", "DEFAULT", "RANGE", "SECTION"), *facts])
    said = [textwrap.fill(row.sentence, columns - 1, initial_indent="    ", subsequent_indent="    ") for row in rows]
    return "\n".join([heads[0], *(line for pair in zip(heads[1:], said, strict=True) for line in pair)]) + "\n"


def _default(row: Parameter) -> str:
    return "auto" if row.default is None else value(row.default)


def value(of: Any) -> str:
    """A default as one would type it."""
    return f"{of:g}" if isinstance(of, float) else str(of)


_PAGE = """\
# Parameters

None is needed to start: directions, resolution and thresholds find themselves. Each can be set

- on the command line, `groundplan survey MAP.yaml --set lines.snr=4`;
- in a file, `groundplan survey MAP.yaml --config settings.toml`, with a table for each stage:

      [lines]
      snr = 4

- in Python, `groundplan.survey(map, lines_snr=4)`.

A flag beats the file, and the file beats the default; `auto` gives a value back to finding itself. Sections are those
of Gholami Shahbandi, Åstrand and Philippsen (ICARCV 2014). This page is what `groundplan parameters --markdown`
prints.

| name | default | range | unit | section | what it does |
|---|---|---|---|---|---|
"""


def markdown(rows: list[Parameter]) -> str:
    """The page of the documentation."""
    cells = ((f"`{r.name}`", _default(r), r.range, r.unit, r.section, r.sentence.replace("|", "\\|")) for r in rows)
    return _PAGE + "".join(f"| {' | '.join(row)} |\n" for row in cells)
