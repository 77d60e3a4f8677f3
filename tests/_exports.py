"""Surveys to export: good ones, real ones, and those that a person or chance has made odd."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from conftest import ROOT, SHARED
from zoo import surveyed

import groundplan
from groundplan.export import FORMATS

#: What people call places: each of these has broken some writer of some format.
NAMES = (
    'The "big" one',
    "O'Brien & <Söhne>, 50 %",
    "Gang Ä; Ölüm",
    "冷蔵庫 🚜",
    "two\nlines\tand\r\ntabs",
    "=1+1",
    "%%d \\P {x}",
    "same",
    "same",
    "",
    "null \x00 and \x1b bell \x07",
    "half \ud83d letter",
    " ",
    "x" * 400,
)


@cache
def demo() -> groundplan.Survey:
    """The example warehouse, turned by 12 degrees."""
    return groundplan.survey(groundplan.read(ROOT / "examples" / "warehouse.yaml"), threads=1)


@cache
def jones_farms() -> groundplan.Survey:
    """A real office floor; skipped where the real maps are not."""
    return real("radish_intel_jones_farms")


@cache
def nav2_warehouse() -> groundplan.Survey:
    """The warehouse that Nav2's demos drive in; skipped where the real maps are not."""
    return real("nav2_warehouse")


def real(name: str) -> groundplan.Survey:
    """The survey of a map that is not ours."""
    file = SHARED / "maps" / f"{name}.yaml"
    if not file.is_file():
        pytest.skip(f"needs the real maps: no {file}")
    return groundplan.survey(groundplan.read(file), threads=1)


@cache
def shifted() -> groundplan.Survey:
    """The example warehouse in a map frame that is turned and far away."""
    read = groundplan.read(ROOT / "examples" / "warehouse.yaml", origin=(1200.5, -830.25, 0.7))
    return groundplan.survey(read, threads=1)


def odd_names() -> groundplan.Survey:
    """The example warehouse with names that a person may have typed."""
    return named(demo(), NAMES)


def named(survey: groundplan.Survey, names: tuple[str, ...]) -> groundplan.Survey:
    """The survey with names, given to its labels in turn, junctions and doors too."""
    labels = [label | {"name": names[n % len(names)]} for n, label in enumerate(survey.labels)]
    info = dataclasses.replace(survey.map, image=names[0] + "🚜\n.pgm")
    return dataclasses.replace(survey, labels=labels, map=info)


def broken_shapes() -> groundplan.Survey:
    """Labels as another program may have written them: crossed, flat and tiny polygons, doors to nowhere."""
    bow = [[0.0, 0.0], [4.0, 4.0], [4.0, 0.0], [0.0, 4.0]]
    flat = [[0.0, 0.0], [5.0, 0.0], [9.0, 0.0]]
    labels: list[dict[str, Any]] = [
        {"kind": "corridor", "polygon": bow, "axis": [[0.0, 2.0], [4.0, 2.0]], "width": 4.0, "name": "bow"},
        {"kind": "corridor", "polygon": flat, "axis": [[1.0, 0.0], [1.0, 0.0]], "width": 0.0, "name": "flat"},
        {"kind": "junction", "type": "X", "at": [2.0, 2.0], "corridors": [0, 1, 77]},
        {"kind": "region", "use": "room", "polygon": bow[:2], "holes": [flat], "at": [1.0, 1.0], "area": 0.0},
        {"kind": "door", "at": [1.0, 1.0], "width": 0.9, "between": [3, 99]},
        {"kind": "pillar", "at": [3.0, 3.0]},
        {"kind": "forklift", "note": "a kind that is not known yet"},
    ]
    return dataclasses.replace(surveyed("single_room"), labels=labels)


#: Every survey that a format must be able to write, or to refuse in clear words; by name.
ODD: dict[str, Callable[[], groundplan.Survey]] = {
    "empty": lambda: surveyed("empty"),
    "unknown": lambda: surveyed("all_unknown"),
    "one pixel": lambda: surveyed("one_pixel"),
    "one row": lambda: surveyed("one_row"),
    "room": lambda: surveyed("single_room"),
    "offices": lambda: surveyed("rows_of_offices"),
    "noise": lambda: surveyed("noise"),
    "names": odd_names,
    "shapes": broken_shapes,
}
GOOD: dict[str, Callable[[], groundplan.Survey]] = {
    "demo": demo,
    "jones farms": jones_farms,
    "nav2 warehouse": nav2_warehouse,
    "shifted": shifted,
    "turned": lambda: surveyed("turned_warehouse"),
}


def once(survey: groundplan.Survey, format: str, directory: Path, **options: Any) -> Path:
    """Export into a directory; the file that was named."""
    return survey.export(directory / f"file{FORMATS[format].suffix}", format, **options)[0]


def same_twice(survey: groundplan.Survey, format: str, directory: Path, **options: Any) -> bool:
    """Whether two exports have the same bytes, the second of a survey that was written and read."""
    again = groundplan.Survey.from_json(survey.to_json())
    first, second = (survey.export(directory / name / "x", format, **options) for name in "ab")
    third = again.export(directory / "c" / "x", format, **options)
    contents = [[file.read_bytes() for file in files] for files in (first, second, third)]
    return contents[0] == contents[1] == contents[2]


def loads(path: Path) -> Any:
    """JSON, strictly: no NaN, no name twice."""

    def once_each(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        assert len({key for key, _ in pairs}) == len(pairs)
        return dict(pairs)

    def refuse(word: str) -> None:
        raise ValueError(f"{word} is no JSON")

    return json.loads(path.read_text("utf-8"), parse_constant=refuse, object_pairs_hook=once_each)
