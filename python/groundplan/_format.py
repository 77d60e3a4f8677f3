"""The name and version of the survey's format, and the refusal of another."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from groundplan._errors import FormatError

FORMAT, VERSION = "groundplan-survey", 1


def check_format(tree: Mapping[str, Any], where: str = "") -> None:
    """Refuse what is not a survey of this version.

    Raises
    ------
    FormatError
        ``survey.format``, ``survey.version``.
    """
    name, version = tree.get("format"), tree.get("version")
    if name != FORMAT:
        raise FormatError("survey.format", f"{where}the format is {name!r} and not {FORMAT!r}")
    if version != VERSION or isinstance(version, bool):
        raise FormatError("survey.version", f"{where}version {version!r} of the format is not known, {VERSION} is")
