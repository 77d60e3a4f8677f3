"""Optional libraries, imported when used."""

from __future__ import annotations

import importlib
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
        raise GroundplanError("extra.missing", said, f"pip install 'groundplan[{extra}]'") from fault
