"""Layers of a drawing: a table by AIA's names that the user can replace, row by row.

As TOML:

    [layers]
    wall = "A-WALL"
    rack = {name = "A-EQPM-RACK", color = 30, linetype = "CONTINUOUS", on = true}

or as CSV with a head: ``what,name,color,linetype,on``. What is not named stays as it is.
"""

from __future__ import annotations

import csv
import dataclasses
import io
import os
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from groundplan._errors import FormatError, ParameterError
from groundplan._files import unreadable


@dataclass(frozen=True)
class Layer:
    """A layer's name, its colour (AutoCAD's index, 1 to 255), its linetype, and whether it is shown."""

    name: str
    color: int
    linetype: str = "CONTINUOUS"
    on: bool = True


#: What is drawn, and where: names after the AIA's CAD layer guidelines, discipline X for what a vehicle drives on.
LAYERS: dict[str, Layer] = {
    "map": Layer("X-MAPP-IMAG", 8),
    "line": Layer("A-GRID", 8, "CENTER", False),
    "wall": Layer("A-WALL", 7),
    "freestanding": Layer("A-WALL-PRHT", 5),
    "rack": Layer("A-EQPM-RACK", 30),
    "rack-fill": Layer("A-EQPM-RACK-PATT", 30, on=False),
    "pillar": Layer("A-COLS", 6),
    "door": Layer("A-DOOR", 4),
    "region": Layer("A-AREA", 3),
    "region-fill": Layer("A-AREA-PATT", 3, on=False),
    "corridor": Layer("A-AREA-AISL", 2),
    "axis": Layer("A-AREA-AISL-CNTR", 1, "CENTER"),
    "name": Layer("A-AREA-IDEN", 7),
    "place": Layer("A-AREA-IDEN-SYMB", 7),
    "node": Layer("X-ROUT-NODE", 5),
    "lane": Layer("X-ROUT-EDGE", 5),
    "lane-name": Layer("X-ROUT-IDEN", 5, on=False),
    "keep-out": Layer("X-ZONE-KEEP", 1, on=False),
    "speed": Layer("X-ZONE-SPED", 40),
}

_COLUMNS = ("what", "name", "color", "linetype", "on")
_LINETYPES = ("CONTINUOUS", "CENTER", "DASHED", "DOT", "DASHDOT", "PHANTOM")


def layers(given: str | os.PathLike[str] | Mapping[str, Any] | None) -> dict[str, Layer]:
    """The table, with rows replaced by a TOML or CSV file, or by a mapping such as the TOML's.

    Raises
    ------
    FormatError
        ``layers.read`` for a file that cannot be read.
    ParameterError
        ``layers.value`` for a row that is none.
    """
    if given is None:
        return dict(LAYERS)
    where, rows = "", given
    if not isinstance(given, Mapping):
        where, rows = f"{os.fspath(given)}: ", _file(Path(given))
    table = dict(LAYERS)
    assert isinstance(rows, Mapping)
    for what, row in rows.items():
        if what not in table:
            raise ParameterError(
                "layers.value", f"{where}there is no {what!r} to draw", f"there are {', '.join(table)}"
            )
        table[what] = _layer(table[what], {"name": row} if isinstance(row, str) else row, f"{where}{what}")
    return table


def _file(path: Path) -> Mapping[str, Any]:
    try:
        text = path.read_text(encoding="utf-8-sig")
        if path.suffix.lower() != ".csv":
            tree = tomllib.loads(text).get("layers")
            if not isinstance(tree, Mapping):
                raise ParameterError("layers.value", f"{path} has no table [layers]", 'such as wall = "A-WALL" in it')
            return tree
    except OSError as fault:
        raise unreadable("layers.read", path, fault) from fault
    except ValueError as fault:
        if isinstance(fault, ParameterError):
            raise
        raise FormatError("layers.read", f"{path}: {fault}") from fault
    reader = csv.DictReader(io.StringIO(text, newline=""))
    if not {"what", "name"} <= set(reader.fieldnames or ()) <= set(_COLUMNS):
        raise ParameterError("layers.value", f"{path} has no head of a table of layers", ",".join(_COLUMNS))
    return {row.pop("what") or "": {key: value for key, value in row.items() if value} for row in reader}


def _layer(before: Layer, row: Any, where: str) -> Layer:
    from ezdxf.lldxf.validator import is_valid_layer_name

    if not isinstance(row, Mapping) or not set(row) <= set(_COLUMNS[1:]):
        raise ParameterError("layers.value", f"{where} is {row!r}", "a name, or a table of name, color, linetype, on")
    name, color = row.get("name", before.name), row.get("color", before.color)
    linetype, on = row.get("linetype", before.linetype), row.get("on", before.on)
    if not isinstance(name, str) or not name.strip() or len(name) > 255 or not is_valid_layer_name(name):
        raise ParameterError("layers.value", f"the layer of {where} is {name!r}", 'without <>/\\":;?*|=`')
    try:
        number = int(color)
    except (TypeError, ValueError):
        number = 0
    if not 1 <= number <= 255:
        raise ParameterError("layers.value", f"the color of {where} is {color!r}", "AutoCAD's index, 1 to 255")
    if str(linetype).upper() not in _LINETYPES:
        raise ParameterError("layers.value", f"the linetype of {where} is {linetype!r}", f"{', '.join(_LINETYPES)}")
    shown = {"true": True, "yes": True, "1": True, "false": False, "no": False, "0": False}.get(str(on).lower())
    if shown is None:
        raise ParameterError("layers.value", f"{where} is {on!r} to be shown", "true or false")
    return dataclasses.replace(before, name=name, color=number, linetype=str(linetype).upper(), on=shown)
