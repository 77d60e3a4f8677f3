"""Scores of surveys against truth, and the suites of simulated maps that the benchmark runs on."""

from __future__ import annotations

import dataclasses
import json
import os
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from groundplan._errors import FormatError, ParameterError
from groundplan._files import unreadable
from groundplan._format import check_format
from groundplan.evaluate import _patterns, _regions, _scores
from groundplan.maps import Map

__all__ = ["Case", "score", "score_regions", "suite", "suites"]

#: Where the maps of the suite ``rooms`` lie, if no other place is given.
MAPS = "GROUNDPLAN_ROOM_MAPS"
_BESIDE = Path("../shared/maps/bormann")
_TRUTH = ".gt.png"

Document: TypeAlias = Mapping[str, Any] | str | os.PathLike[str]


@dataclass(frozen=True)
class Case:
    """One map of a suite.

    Attributes
    ----------
    name, kind : str
        What it is called, and the part of the suite that it belongs to, such as ``regular`` or ``hard``.
    place : str
        What is simulated, ``warehouse`` or ``office``, and ``roads`` where it is a warehouse whose road map is scored;
        ``map`` where a map is read.
    options : dict
        Of the simulation, its seed among them; of a map its files, ``map`` and ``truth``.
    """

    name: str
    kind: str
    place: str
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
        pillar_f1 (this and what follows where the truth speaks of ``pillars`` or ``racks``)
            One-to-one matching within 0.5 m of the truth's ``pillars`` {at, observed}; None without any on either side.
        pitch_recall, pitch_error_m
            Share of the racks that lie on a true one of ``racks`` {a, b, pitch} whose pitch is right to 0.05 m, and the
            median error of those that have one; None without any.
        rack_recall, rack_precision
            One-to-one matching of racks whose outlines have an intersection over union of 0.5 at least with the
            truth's ``racks`` {a, b, width, observed}; None without any. Racks that were not observed do not count.
        hall_recall, hall_precision (where the truth speaks of ``halls``)
            One-to-one matching of regions whose outlines, holes left out, have an intersection over union of 0.7 at
            least with the truth's ``halls`` {polygon, observed}. Of the regions those count that lie in halls with half
            of their ground; what was not observed does not count. None without any.

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
    parts = [_scores.direction_scores, _scores.line_scores, _scores.junction_scores, _scores.corridor_scores]
    if "pillars" in true or "racks" in true:
        parts += [_patterns.pattern_scores, _patterns.rack_scores]
    if "halls" in true:
        parts.append(_regions.hall_scores)
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


def score_regions(survey: Document, map: Map, truth: str | os.PathLike[str] | npt.NDArray[np.uint8]) -> dict[str, Any]:
    """Score a survey's regions against a ground truth picture of rooms.

    Parameters
    ----------
    survey
        A survey.json, or the path of one.
    map
        What was surveyed; where it is lighter than 249 no region counts.
    truth
        The picture, or its (height, width) uint8 pixels: more than 250 in a room, darker between rooms, as
        Bormann et al. (2016) draw theirs and as `groundplan simulate office` writes it.

    Returns
    -------
    dict
        iou_1to1
            Sum of intersection over union of the best one-to-one assignment, over the greater number of regions.
        mcc
            Mean Matthews correlation of greedily paired regions, on what is labelled on both sides.
        rooms, regions
            How many there are, and how many were found; of more than 100 pixels each.

    Raises
    ------
    FormatError
        A survey that is not one, or a picture of another size than the map's.
    MapError
        A picture that cannot be read.
    GroundplanError
        ``extra.missing`` without SciPy.
    """
    found = _document(survey, "survey", ("labels",))
    true = _regions.truth_labels(truth) if isinstance(truth, np.ndarray) else _regions.read_truth(Path(truth))
    if true.shape != map.pixels.shape:
        sizes = [f"{width} x {height}" for height, width in (true.shape, map.pixels.shape)]
        raise FormatError("truth.size", f"the ground truth has {sizes[0]} pixels and the map {sizes[1]}")
    try:
        return _regions.region_scores(_regions.region_labels(found, map.pixels), true)
    except (KeyError, IndexError, TypeError, ValueError) as fault:
        raise FormatError("score.format", f"the survey is not one: {fault}") from fault


def suites() -> list[str]:
    """Names of the suites that come with Groundplan."""
    here = resources.files("groundplan.evaluate")
    return sorted(
        ["confidence", "rooms", *(f.name.removesuffix(".toml") for f in here.iterdir() if f.name.endswith(".toml"))]
    )


def suite(name: str, maps: str | os.PathLike[str] | None = None) -> list[Case]:
    """The cases of a suite.

    Parameters
    ----------
    name
        ``warehouses``, ``roadmaps``, ``offices`` and ``names`` (places of which several maps are made) are simulated,
        ``confidence`` is warehouses and offices together, ``rooms`` are the maps of Bormann et al. (2016), which are
        not ours to give away.
    maps
        Where those lie: ``<name>.yaml`` and ``<name>_furnitures.yaml`` beside ``<name>.gt.png``. By default what the
        environment's GROUNDPLAN_ROOM_MAPS says, or ../shared/maps/bormann.

    Raises
    ------
    ParameterError
        ``suite.unknown``, or ``suite.maps`` where there are no maps.
    """
    if name not in suites():
        raise ParameterError("suite.unknown", f"no suite {name!r}", f"there are: {', '.join(suites())}")
    if name == "confidence":
        return [*suite("warehouses"), *suite("offices")]
    if name == "rooms":
        return _rooms(Path(maps or os.environ.get(MAPS) or _BESIDE))
    text = (resources.files("groundplan.evaluate") / f"{name}.toml").read_text(encoding="utf-8")
    place = "roads" if name == "roadmaps" else name.removesuffix("s")
    cases = [Case(case.pop("name"), case.pop("kind"), place, case) for case in tomllib.loads(text)["case"]]
    # Of the suite of names a case's kind says what is simulated.
    return [dataclasses.replace(case, place=case.kind) if name == "names" else case for case in cases]


def _rooms(maps: Path) -> list[Case]:
    """The unfurnished maps and then the furnished ones."""
    truths = sorted(maps.glob("*" + _TRUTH))
    cases = []
    for kind, suffix in (("empty", ""), ("furnished", "_furnitures")):
        for truth in truths:
            name = truth.name.removesuffix(_TRUTH) + suffix
            if (maps / f"{name}.yaml").is_file():
                files = {"map": str(maps / f"{name}.yaml"), "truth": str(truth)}
                cases.append(Case(name, kind, "map", files))
    if not cases:
        raise ParameterError(
            "suite.maps",
            f"no maps with a ground truth in {maps}",
            f"--maps DIR or {MAPS} says where the maps of Bormann et al. lie",
        )
    return cases
