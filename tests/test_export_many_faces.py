"""A hundred thousand faces: every format is written whole, or refused in clear words, in a time one would wait."""

from __future__ import annotations

import json
import sqlite3
from contextlib import closing
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from _program import files

import groundplan
from groundplan import Directions, FormatError, Lines
from groundplan.export import FORMATS

LINES = 318


@cache
def many() -> tuple[groundplan.Survey, groundplan.Map]:
    """An empty hall, cut by lines a hand's breadth apart."""
    directions = Directions(np.array([0.0, -np.pi / 2]), np.ones(2), np.zeros(360), 1.0)
    which = np.repeat(np.array([0, 1], dtype=np.uint32), LINES)
    offsets = np.tile(np.linspace(0.05, 34.9, LINES), 2)
    lines = Lines(which, offsets, np.ones(2 * LINES), np.full(2 * LINES, 0.02), 1.0)
    map = groundplan.from_array(np.full((700, 700), 254, np.uint8), 0.05)
    survey = groundplan.survey(map, directions=directions, lines=lines)
    assert len(survey.subdivision.areas) > 100_000
    return survey, map


@pytest.mark.parametrize("name", FORMATS)
def test_a_hundred_thousand_faces_are_written_whole_or_refused_in_clear_words(name: str, tmp_path: Path) -> None:
    survey, map = many()
    options = {"map": map} if FORMATS[name].map != "no" else {}
    try:
        written = survey.export(tmp_path / "out" / "x", name, **options)
    except FormatError as fault:
        assert name == "nav2" and fault.code == "export.empty" and files(tmp_path) == set()
        return
    assert {str(file.relative_to(tmp_path)) for file in written} == files(tmp_path)
    count = len(survey.subdivision.areas)
    if name == "gpkg":
        with closing(sqlite3.connect(written[0])) as base:
            assert base.execute("SELECT count(*) FROM faces").fetchone() == (count,)
    if name == "geojson":
        features = json.loads(written[0].read_bytes())["features"]
        assert sum(feature["properties"]["layer"] == "faces" for feature in features) == count


def test_the_graph_of_a_hundred_thousand_faces_comes_back_whole(tmp_path: Path) -> None:
    survey, _ = many()
    (file,) = survey.export(tmp_path / "x", "json", graph="faces")
    tree = json.loads(file.read_bytes())
    assert len(tree["nodes"]) == len(survey.subdivision.areas) and len(tree["edges"]) == len(survey.adjacency.edges)
