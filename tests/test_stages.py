"""What is handed to a stage: taken where it fits, refused by name where it does not."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
import zoo
from zoo import RESOLUTION, ZOO

import groundplan
from groundplan import Directions, Lines, MapError, ParameterError, Route

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
        (
            {"directions": dataclasses.replace(Directions.of(0.0), angles=np.array([np.nan]))},
            "an angle of the directions is not finite",
        ),
        ({"lines": [1.0]}, "lines has to be Lines and is a list"),
        ({"lines": Lines.of([9], [1.0])}, "a line names a direction that there is not"),
        (
            {"lines": dataclasses.replace(Lines.of([0], [1.0]), offsets=np.array([np.inf]))},
            "an offset of the lines is not finite",
        ),
        ({"lines": dataclasses.replace(Lines.of([0], [1.0]), widths=np.zeros(1, np.float32))}, "an array is not of"),
    ],
)
def test_a_survey_refuses_what_does_not_fit(given: dict[str, Any], sentence: str) -> None:
    assert sentence in str(refused(groundplan.survey, MAP, **given))


@pytest.mark.parametrize(
    ("angles", "sentence", "hint"),
    [
        ([0.0, float("nan")], "angles[1] is nan, which is not finite", "Directions.of([0.0, math.pi / 2])"),
        ([17, -73], "angles[0] is 17, and no angle in radians is beyond a turn", "np.radians"),
        ([0, 0], "angles[0] and angles[1], 0 and 0, are one direction", "each is given once"),
        ([1.0, 0.5, 0.5 - np.pi], "angles[1] and angles[2], 0.5 and -2.64159, are one direction", "half a turn"),
        ("ab", "angles has to be a list of numbers and is 'ab'", "Directions.of"),
        ([[0.0, 1.0]], "angles has to be a list of numbers and is [[0.0, 1.0]]", "Directions.of"),
        (None, "angles has to be a list of numbers and is None", "Directions.of"),
    ],
)
def test_what_is_no_angle_in_radians_makes_no_direction(angles: Any, sentence: str, hint: str) -> None:
    fault = refused(Directions.of, angles)
    assert str(fault).startswith(sentence) and hint in str(fault.hint)


def test_directions_of_your_own_are_brought_into_half_a_turn() -> None:
    assert Directions.of([np.pi / 2, 2 * np.pi]).angles == pytest.approx([-np.pi / 2, 0.0])
    assert Directions.of(0.5).angles.tolist() == [0.5] and len(Directions.of([])) == 0


@pytest.mark.parametrize(
    ("directions", "offsets", "sentence"),
    [
        ([0, 1], [1], "directions and offsets have 2 and 1 values"),
        ([-1], [1], "directions[0] is -1, which is no index"),
        ([0, 0.5], [1, 2], "directions[1] is 0.5, which is no index"),
        ([2**32], [1], "directions[0] is 4.29497e+09, which is no index"),
        ("a", [1], "directions has to be a list of numbers and is 'a'"),
        ([0], [float("inf")], "offsets[0] is inf, which is not finite"),
    ],
)
def test_what_is_no_index_or_no_offset_makes_no_line(directions: Any, offsets: Any, sentence: str) -> None:
    assert str(refused(Lines.of, directions, offsets)) == sentence


def test_a_hint_says_what_makes_the_right_input() -> None:
    assert "Directions.of" in str(refused(groundplan.survey, MAP, directions=[0.0]).hint)
    assert str(refused(groundplan.survey, MAP, directions=3).hint).startswith("directions_count=3 takes so many")
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


@pytest.mark.parametrize("threads", [0, -1, 1.5, True])
def test_threads_are_a_whole_number_from_1_on(threads: Any) -> None:
    for stage in (groundplan.survey, groundplan.find_gradients):
        with pytest.raises(ParameterError, match="threads cannot be") as fault:
            stage(MAP, threads=threads)
        assert fault.value.code == "parameter.range"


@pytest.mark.parametrize("given", [None, 7, MAP.pixels.shape[0] * 1.0])
def test_what_is_no_map_is_named(given: Any) -> None:
    for resolution in (None, 0.05):
        with pytest.raises(MapError) as fault:
            groundplan.survey(given, resolution=resolution)
        assert repr(given) in str(fault.value) and "a file's path" in str(fault.value.hint)


def test_a_resolution_given_in_python_gets_no_flag_for_a_hint() -> None:
    with pytest.raises(MapError, match="-1") as fault:
        groundplan.survey(MAP.pixels, resolution=-1)
    assert fault.value.hint is None


def test_what_is_printed_is_short() -> None:
    assert repr(MAP) == "Map('', 240 x 160 pixels of 0.05 m)".replace("240 x 160", f"{MAP.width} x {MAP.height}")
    stages = (FOUND.directions, FOUND.lines, FOUND.subdivision, FOUND.occupancy, FOUND.walls, FOUND.adjacency)
    response = groundplan.find_response(FOUND.radiograms[0])
    way = Route(np.arange(3, dtype=np.uint32), np.zeros((2, 2)), 1.5, 0.3, ("S1-01",))
    for thing in (MAP, GRADIENTS, FOUND, *stages, FOUND.radiograms[0], response, way):
        assert len(repr(thing)) < 230 and "array" not in repr(thing)
    assert repr(way) == "Route(3 faces, 2 points, length 1.5, clearance 0.3, 1 racks)"
    assert repr(Directions.of([0.0])) == "Directions(1 angles, 1 weights, 0 histogram, explained 1)"


def test_maps_are_equal_when_their_pixels_are() -> None:
    assert groundplan.from_array(ZOO["single_room"](), RESOLUTION) == MAP
    assert groundplan.from_array(ZOO["single_room"](), 0.1) != MAP
    assert groundplan.from_array(ZOO["comb_of_racks"](), RESOLUTION) != MAP
    assert MAP != 3


def test_a_whole_number_is_one_in_the_survey() -> None:
    found = groundplan.survey(MAP, directions_count=2)
    assert '"directions.count":2,' in found.to_json()
    assert groundplan.Survey.from_json(found.to_json()).to_json() == found.to_json()
