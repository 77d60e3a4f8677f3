"""Surveys in the formats of others, one module a format, each imported when it is used.

    survey.export("warehouse.dxf", "dxf")

`_formats` has the table of formats and their options. Each module has ``write(survey, path, **options)``, which
writes the whole file or none and gives the paths of what it wrote. What several of them need: `_places` (labels with
ids, names and neighbours), `_text` (names made fit for a format), `_dates`, and `groundplan.roadmap`.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from groundplan._errors import ParameterError
from groundplan._extras import needed
from groundplan.export._formats import FORMATS, OPTIONS, Format, Option, format_named, format_of

if TYPE_CHECKING:
    from groundplan.survey import Survey

__all__ = ["FORMATS", "OPTIONS", "Format", "Option", "export", "format_named", "format_of", "prepare", "target"]


def export(
    survey: Survey, path: str | os.PathLike[str], format: str | Format | None = None, **options: Any
) -> list[Path]:
    """Write a survey in a format. The same survey and options give the same bytes.

    Parameters
    ----------
    survey
        What to write.
    path
        The file, or a directory: one that exists, or a name that ends in a separator or has no suffix. In a directory
        the file has the map's name and the format's suffix. A format of several files writes the others beside it.
    format
        A name from ``FORMATS``; by default told by the name's suffix.
    **options
        As the format takes them; ``map``, the `groundplan.Map` that was surveyed, where it uses pixels.

    Returns
    -------
    list of Path
        What was written, the file that was named first.

    Raises
    ------
    ParameterError
        ``export.path``, ``export.format``, ``export.option``, ``export.map``, and what a format says of an option's
        value.
    FormatError
        ``file.write`` when the place cannot be written, and what a format cannot say of this survey.
    GroundplanError
        ``extra.missing`` when a library is not installed.
    """
    if not isinstance(path, str | os.PathLike):
        raise ParameterError("export.path", f"{path!r} is no path", "a path is text or a pathlib.Path")
    if isinstance(format, Format):
        form = format
    else:
        form = format_named(format) if format is not None else format_of(Path(path).name)
    prepare([form], options)
    module = import_module(f"groundplan.export.{form.name.replace('-', '_')}")
    written: list[Path] = module.write(survey, target(path, form, survey), **options)
    return written


def prepare(forms: Iterable[Format], options: dict[str, Any]) -> None:
    """Everything that can be refused before anything is written: options, the map, libraries.

    Raises
    ------
    ParameterError
        ``export.option`` for an option that one of the formats does not take, ``export.map`` for a map that is needed
        and not given.
    GroundplanError
        ``extra.missing``.
    """
    for form in forms:
        takes = [*form.options, *(["map"] if form.map != "no" else [])]
        for name in options:
            if name not in takes:
                known = f"it takes {', '.join(takes)}" if takes else "it takes none"
                raise ParameterError("export.option", f"{form.name} has no option {name!r}", known)
        if form.map == "must" and options.get("map") is None:
            raise ParameterError("export.map", f"{form.name} needs the map's pixels", "give the map that was surveyed")
        if form.extra:
            for module in form.needs:
                needed(module, form.extra)


def target(path: str | os.PathLike[str], form: Format, survey: Survey) -> Path:
    """The file that `export` writes to, given a file or a directory."""
    named, text = Path(path), os.fspath(path)
    if named.is_dir() or not named.suffix or text.endswith(("/", os.sep)):
        return named / f"{stem(survey)}{form.suffix}"
    return named


def stem(survey: Survey) -> str:
    """The map's name without its suffix, made fit for a file's name."""
    kept = "".join(
        letter if letter.isprintable() and letter not in '/\\:*?"<>|' else "_" for letter in survey.map.image
    )
    return Path(kept).stem.lstrip(".") or "map"
