"""The Vector Object Server's parameters, read as ROS reads parameters: a list has one type, a name is a word."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path
from typing import Any

import pytest
import shapely
import yaml
from _exports import GOOD, ODD, demo, odd_names, once
from conftest import SHARED

SAMPLE = SHARED / "schemas" / "nav2-vector_object_server_params.yaml"


def shapes(file: Path) -> dict[str, dict[str, Any]]:
    """The shapes by name, each with the keys, types and sizes that the server asks for."""
    tree = yaml.safe_load(file.read_text("utf-8"))
    assert set(tree) == {"vector_object_server", "costmap_filter_info_server"}
    said = tree["vector_object_server"]["ros__parameters"]
    assert isinstance(said["resolution"], float) and said["resolution"] > 0
    names = said.get("shapes")
    assert names is None or names  # an empty list has no type
    found = {name: said[name] for name in names or []}
    assert len(found) == len(names or [])
    for name, shape in found.items():
        assert re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name) and shape["frame_id"] == "map" and shape["value"] == 100
        numbers = shape["points"] if shape["type"] == "polygon" else [*shape["center"], shape["radius"]]
        assert all(type(number) is float for number in numbers)
        if shape["type"] == "polygon":
            assert shape["closed"] is True and len(numbers) >= 6 and len(numbers) % 2 == 0
        else:
            assert shape["type"] == "circle" and shape["fill"] is True and len(numbers) == 3 and shape["radius"] > 0
    return found


@pytest.mark.parametrize("which", GOOD)
def test_every_rack_is_a_polygon_to_a_millimetre(which: str, tmp_path: Path) -> None:
    survey = GOOD[which]()
    found = [s for s in shapes(once(survey, "vector-objects", tmp_path)).values() if s["type"] == "polygon"]
    racks = survey.of_kind("rack")
    assert len(found) == len(racks)
    for rack, shape in zip(racks, found, strict=True):
        read = shapely.Polygon(list(zip(shape["points"][::2], shape["points"][1::2], strict=True)))
        assert read.is_valid and read.exterior.is_ccw
        assert shapely.hausdorff_distance(read, shapely.Polygon(rack["polygon"])) < 1e-3


def test_pillars_are_circles_and_names_are_words(tmp_path: Path) -> None:
    pillars: list[dict[str, Any]] = [
        {"kind": "pillar", "at": [1.0, 2.0], "width": 0.5},
        {"kind": "pillar", "at": [-3.0, 0.0], "name": "7"},
    ]
    survey = dataclasses.replace(odd_names(), labels=[*odd_names().labels, *pillars])
    found = shapes(once(survey, "vector-objects", tmp_path))
    circles = [shape for shape in found.values() if shape["type"] == "circle"]
    assert [(c["center"], c["radius"]) for c in circles] == [([1.0, 2.0], 0.25), ([-3.0, 0.0], 0.05)]
    assert list(found)[-1] == "pillar_7" and len(found) == 9


@pytest.mark.parametrize("which", ODD)
def test_an_odd_survey_gives_parameters_that_can_be_read(which: str, tmp_path: Path) -> None:
    shapes(once(ODD[which](), "vector-objects", tmp_path))


def test_the_keys_are_those_of_the_server_s_own_sample(tmp_path: Path) -> None:
    if not SAMPLE.is_file():
        pytest.skip(f"needs Nav2's sample: no {SAMPLE}")
    sample = yaml.safe_load(SAMPLE.read_text())
    written = yaml.safe_load(once(demo(), "vector-objects", tmp_path).read_text())
    own, theirs = (tree["vector_object_server"]["ros__parameters"] for tree in (written, sample))
    assert set(theirs) - {"Poly", "Circle"} == set(own) - set(own["shapes"])
    assert all(set(own[name]) == set(theirs["Poly"]) for name in own["shapes"])
    assert written["costmap_filter_info_server"] == sample["costmap_filter_info_server"]
