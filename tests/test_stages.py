"""What is handed to a stage: taken where it fits, refused by name where it does not."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
import zoo
from zoo import RESOLUTION, ZOO

import groundplan
from groundplan import Directions, Lines, ParameterError

MAP = groundplan.from_array(ZOO["single_room"](), RESOLUTION)
FOUND = zoo.surveyed("single_room")
GRADIENTS = groundplan.find_gradients(MAP)


def refused(stage: Any, *inputs: Any, **named: Any) -> ParameterError:
    """The error with which a stage refuses its input."""
    with pytest.raises(ParameterError) as fault:
        stage(*inputs, **named)
    assert fault.value.code == "stage.input"
    return fault.value


def test_lines_of_your_own_are_of_the_directions_that_are_found() -> None:
    lines = Lines.of([0, 1], [1.0, 2.0])
    found = groundplan.survey(MAP, lines=lines, directions_count=2)
    assert found.lines == lines
    assert found.directions == groundplan.find_directions(MAP, directions_count=2)
    assert groundplan.survey(MAP, lines=FOUND.lines).to_json() == FOUND.to_json()


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"directions": [0.0, 1.5]}, "directions has to be Directions and is a list"),
        ({"directions": Directions.of([float("nan")])}, "an angle of the directions is not finite"),
        ({"lines": [1.0]}, "lines has to be Lines and is a list"),
        ({"lines": Lines.of([9], [1.0])}, "a line names a direction that there is not"),
        ({"lines": Lines.of([0], [float("inf")])}, "an offset of the lines is not finite"),
        ({"lines": dataclasses.replace(Lines.of([0], [1.0]), widths=np.zeros(1, np.float32))}, "an array is not of"),
    ],
)
def test_a_survey_refuses_what_does_not_fit(given: dict[str, Any], sentence: str) -> None:
    assert sentence in str(refused(groundplan.survey, MAP, **given))


def test_a_hint_says_what_makes_the_right_input() -> None:
    assert "Directions.of" in str(refused(groundplan.survey, MAP, directions=[0.0]).hint)
    assert "groundplan.read" in str(refused(groundplan.find_gradients, "map.yaml").hint)


def test_inputs_in_the_wrong_order_are_named() -> None:
    cut, full, walls = FOUND.subdivision, FOUND.occupancy, FOUND.walls
    swapped: list[tuple[Any, tuple[Any, ...], str]] = [
        (groundplan.find_directions, (GRADIENTS, MAP), "map has to be a Map and is Gradients"),
        (groundplan.find_directions, (MAP, FOUND.directions), "gradients has to be Gradients and is Directions"),
        (groundplan.find_radiograms, (MAP, GRADIENTS, FOUND.directions), "directions has to be Directions"),
        (groundplan.find_lines, (FOUND.radiograms[0],), "radiograms has to be a list and is a Radiogram"),
        (groundplan.find_lines, ([FOUND.lines],), "radiograms[0] has to be a Radiogram and is Lines"),
        (groundplan.find_response, (FOUND.radiograms,), "radiogram has to be a Radiogram and is a list"),
        (groundplan.subdivide, (MAP, FOUND.lines, FOUND.directions), "directions has to be Directions and is Lines"),
        (groundplan.find_occupancy, (MAP, FOUND.lines, FOUND.directions), "directions has to be Directions"),
        (groundplan.find_walls, (full, cut), "subdivision has to be a Subdivision and is an Occupancy"),
        (groundplan.find_adjacency, (walls, cut), "subdivision has to be a Subdivision and is Walls"),
    ]
    for stage, inputs, sentence in swapped:
        assert sentence in str(refused(stage, *inputs))


def test_stages_of_another_map_are_refused() -> None:
    other = zoo.surveyed("comb_of_racks")
    assert "not those of this subdivision" in str(refused(groundplan.find_walls, FOUND.subdivision, other.occupancy))
