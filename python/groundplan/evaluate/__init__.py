"""Scores of surveys against truth, and the suites of simulated maps that the benchmark runs on."""

from __future__ import annotations

import json
import os
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any, TypeAlias

from groundplan._errors import FormatError, ParameterError
from groundplan._files import unreadable
from groundplan._format import check_format
from groundplan.evaluate import _scores

__all__ = ["Case", "score", "suite", "suites"]

Document: TypeAlias = Mapping[str, Any] | str | os.PathLike[str]


@dataclass(frozen=True)
class Case:
    """One map of a suite.

    Attributes
    ----------
    name, kind : str
        What it is called, and the part of the suite that it belongs to, such as ``regular`` or ``hard``.
    options : dict
        Of the simulation, its seed among them.
    """

    name: str
    kind: str
    options: dict[str, Any]


def score(survey: Document, truth: Document) -> dict[str, Any]:
    """Score a survey against a truth.

    Parameters
    ----------
    survey
        A survey.json, or the path of one.
    truth
        A truth.json as `groundplan simulate` writes it, or the path of one: ``directions`` (radians), ``lines``
        ``{kind, p, q}``, ``corridors`` ``{a, b, width}`` and ``junctions`` ``{at, type, observed}``, metres in the
        map frame.

    Returns
    -------
    dict
        direction_error_deg
            Greatest error over the true directions; 180 when none was found.
        direction_extra
            Directions found beyond the number of true ones.
        line_recall
            Share of the true lines' length that a line of the same direction follows to 0.20 m; None without any.
        line_error_m
            Median distance of the true lines' midpoints to what follows them; None when nothing does.
        junction_f1, junction_typed_f1
            One-to-one matching within 1.5 m, types ignored or not. Junctions that were not observed do not count.
        corridor_recall
            Share of the true corridors' length, off the junctions, in a corridor whose axis is within 10 degrees.
        corridor_precision
            Share of the corridors' area in true corridors of that axis.

    Raises
    ------
    FormatError
        A file that cannot be read, or that lacks what its format asks for.
    GroundplanError
        ``extra.missing`` without SciPy or Shapely.
    """
    found = _document(survey, "survey", ("directions", "lines", "labels"))
    check_format(found, f"{Path(survey)}: " if isinstance(survey, str | os.PathLike) else "")
    true = _document(truth, "truth", ("directions", "lines", "corridors", "junctions"))
    parts = (_scores.direction_scores, _scores.line_scores, _scores.junction_scores, _scores.corridor_scores)
    result: dict[str, Any] = {}
    for part in parts:
        try:
            result |= part(found, true)
        except (KeyError, IndexError, TypeError, ValueError) as fault:
            kind = f"no {fault}" if isinstance(fault, KeyError) else str(fault)
            raise FormatError("score.format", f"the survey or the truth is not one: {kind}") from fault
    return result


def _document(source: Document, what: str, needed: tuple[str, ...]) -> dict[str, Any]:
    """A JSON object with its needed lists, from a mapping or a file."""
    name = f"the {what}"
    if isinstance(source, Mapping):
        content: Any = source
    else:
        name = str(Path(source))
        try:
            content = json.loads(Path(source).read_text(encoding="utf-8"))
        except OSError as fault:
            raise unreadable("file.read", name, fault) from fault
        except ValueError as fault:
            raise FormatError("file.json", f"{name} is not JSON: {fault}") from fault
    for key in needed:
        if not isinstance(content, Mapping) or not isinstance(content.get(key), list):
            raise FormatError(f"{what}.format", f"{name} is not a {what}: it has no list {key!r}")
    return dict(content)


def suites() -> list[str]:
    """Names of the suites that come with Groundplan."""
    here = resources.files("groundplan.evaluate")
    return sorted(f.name.removesuffix(".toml") for f in here.iterdir() if f.name.endswith(".toml"))


def suite(name: str) -> list[Case]:
    """The cases of a suite.

    Raises
    ------
    ParameterError
        ``suite.unknown``.
    """
    if name not in suites():
        raise ParameterError("suite.unknown", f"no suite {name!r}", f"there are: {', '.join(suites())}")
    text = (resources.files("groundplan.evaluate") / f"{name}.toml").read_text(encoding="utf-8")
    return [Case(case.pop("name"), case.pop("kind"), case) for case in tomllib.loads(text)["case"]]
