"""The one table of parameters, and the ways to set them: keywords, ``name=value``, a TOML file."""

from __future__ import annotations

import os
import tomllib
from dataclasses import dataclass
from functools import cache
from typing import Any

from groundplan import _core
from groundplan._errors import FormatError, ParameterError
from groundplan._files import unreadable


@dataclass(frozen=True)
class Parameter:
    """One row: `default` is None where the value finds itself; `words` are those of a choice."""

    name: str
    unit: str
    default: Any
    range: str
    words: list[str]
    sentence: str
    section: str


def table() -> list[Parameter]:
    """Every parameter there is."""
    return [Parameter(**row) for row in _core.table()]


def resolve(parameters: dict[str, Any]) -> dict[str, Any]:
    """Every parameter's value with `parameters` set.

    Raises
    ------
    ParameterError
        ``parameter.unknown`` or ``parameter.range``.
    """
    values = _core.resolve(named(parameters))
    whole = (row["name"] for row in _core.table() if row["range"].startswith("a whole number"))
    return values | {name: int(values[name]) for name in whole if values[name] is not None}


def named(parameters: dict[str, Any]) -> dict[str, Any]:
    """Python keywords as the table names them: ``lines_snr`` and ``lines.snr`` are one; others stay as they are."""
    dotted = {name: name.replace("_", ".", 1) for name in parameters if "." not in name}
    return {dotted[name] if dotted.get(name) in _names() else name: value for name, value in parameters.items()}


@cache
def _names() -> frozenset[str]:
    return frozenset(row["name"] for row in _core.table())


def parse(text: str) -> tuple[str, Any]:
    """``name=value`` as typed: a number, a word, several numbers with commas, or ``auto``."""
    name, equals, value = text.partition("=")
    if not equals or not name.strip():
        raise ParameterError("parameter.syntax", f"{text!r} is not name=value", "for example --set lines.snr=4")
    return name.strip(), parse_value(value.strip())


def parse_value(text: str) -> Any:
    """A value as typed."""
    if text in ("auto", "null", "none"):
        return None
    try:
        numbers = [float(part) for part in text.strip("[]").split(",")]
    except ValueError:
        return text
    return numbers if len(numbers) > 1 or text.startswith("[") else numbers[0]


def read_toml(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Settings from a TOML file: a table for each stage, or dotted names.

    Raises
    ------
    FormatError
        ``settings.read`` when there is no such file, ``settings.toml`` when it is not TOML.
    """
    try:
        with open(path, "rb") as file:
            tree = tomllib.load(file)
    except OSError as fault:
        raise unreadable("settings.read", path, fault) from fault
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as fault:
        raise FormatError("settings.toml", f"{os.fspath(path)} is not TOML: {fault}") from fault
    flat: dict[str, Any] = {}
    for stage, values in tree.items():
        if not isinstance(values, dict):
            flat[stage] = values
            continue
        for name, value in values.items():
            flat[f"{stage}.{name}"] = None if value == "auto" else value
    return flat
