"""Optional libraries, imported when used."""

from __future__ import annotations

import importlib.util
from collections.abc import Iterable
from typing import Any

from groundplan._errors import GroundplanError


def needed(module: str, extra: str) -> Any:
    """A module of an optional extra.

    Raises
    ------
    GroundplanError
        ``extra.missing``, with the command that installs it.
    """
    try:
        return importlib.import_module(module)
    except ImportError as fault:
        said = f"{module.partition('.')[0]} is not installed"
        raise GroundplanError("extra.missing", said, installs(extra)) from fault


def missing(modules: Iterable[str]) -> list[str]:
    """Which of some modules are not installed; none of them is imported."""
    return [module for module in modules if importlib.util.find_spec(module) is None]


def installs(extra: str) -> str:
    """The command that installs an extra."""
    return f"pip install 'groundplan[{extra}]'"
