"""Speeds and one-way lanes, said by a person: by the names of corridors, doors and racks.

    [[rule]]
    name = "A*"            # as in a shell; corridors, doors and racks
    speed = 1.2            # m/s

    [[rule]]
    name = "A03"
    way = "forward"        # in the order of its numbers, right or up; or "backward", "both", "closed"

What a later rule says beats what an earlier one does.
"""

from __future__ import annotations

import fnmatch
import math
import os
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from groundplan._errors import FormatError, ParameterError
from groundplan._files import unreadable

WAYS = ("both", "forward", "backward", "closed")


@dataclass(frozen=True)
class Rule:
    """What holds for lanes of a name; None where the rule does not say."""

    name: str = "*"
    speed: float | None = None
    way: str | None = None


def rules(given: str | os.PathLike[str] | Sequence[Mapping[str, Any]] | None) -> list[Rule]:
    """Rules from a TOML file, or from mappings with the same keys.

    Raises
    ------
    FormatError
        ``rules.read`` for a file that cannot be read or is not TOML.
    ParameterError
        ``rules.value`` for what is no rule.
    """
    if given is None:
        return []
    where = ""
    entries: Any = given
    if isinstance(given, str | os.PathLike):
        where = f"{os.fspath(given)}: "
        try:
            tree = tomllib.loads(Path(given).read_text(encoding="utf-8"))
        except OSError as fault:
            raise unreadable("rules.read", given, fault) from fault
        except ValueError as fault:
            raise FormatError("rules.read", f"{where}{fault}") from fault
        strange = [key for key in tree if key != "rule"]
        if strange or not isinstance(tree.get("rule", []), list):
            said = f"{where}there is no {strange[0]!r} among rules" if strange else f"{where}rule is no list"
            raise ParameterError("rules.value", said, "[[rule]] begins each")
        entries = tree.get("rule", [])
    return [_rule(entry, f"{where}rule {number}") for number, entry in enumerate(entries, 1)]


def _rule(entry: Any, where: str) -> Rule:
    if not isinstance(entry, Mapping):
        raise ParameterError("rules.value", f"{where} is {entry!r}", "it has a name, and a speed or a way")
    for key in entry:
        if key not in ("name", "speed", "way"):
            raise ParameterError("rules.value", f"{where} has a {key!r}", "name, speed and way are known")
    name, speed, way = entry.get("name", "*"), entry.get("speed"), entry.get("way")
    if not isinstance(name, str):
        raise ParameterError("rules.value", f"the name of {where} is {name!r}", "it is a text, such as A*")
    if speed is not None and not (
        isinstance(speed, int | float) and not isinstance(speed, bool) and speed > 0 and math.isfinite(speed)
    ):
        raise ParameterError("rules.value", f"the speed of {where} is {speed!r}", "it is in m/s and greater than 0")
    if way is not None and way not in WAYS:
        raise ParameterError("rules.value", f"the way of {where} is {way!r}", f"it is one of {', '.join(WAYS)}")
    return Rule(name, None if speed is None else float(speed), way)


def ruled(rules: Sequence[Rule], name: str) -> tuple[float | None, str]:
    """The speed and the way that hold for a name."""
    speed: float | None = None
    way = "both"
    for rule in rules:
        if fnmatch.fnmatchcase(name, rule.name):
            speed = rule.speed if rule.speed is not None else speed
            way = rule.way if rule.way is not None else way
    return speed, way
