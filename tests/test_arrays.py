"""Maps from arrays."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from _reading import EXPECTED, Pixels, hall, states

import groundplan
from groundplan._errors import MapError
from groundplan.maps import FREE, OCCUPIED, UNKNOWN, from_array


def test_an_occupancy_grid_is_flipped_and_not_copied() -> None:
    data = np.array([[0, 100, -1], [50, 25, 65], [127, -128, 101]], np.int8)
    got = from_array(data, 0.1, (1.0, 2.0, 0.5))
    assert np.shares_memory(got.pixels, data)
    assert got.values[got.pixels].tolist() == [[-1, -1, -1], [50, 25, 65], [0, 100, -1]]
    assert states(got).tolist() == [
        [UNKNOWN, UNKNOWN, UNKNOWN],
        [UNKNOWN, FREE, OCCUPIED],
        [FREE, OCCUPIED, UNKNOWN],
    ]
    assert got.origin == (1.0, 2.0, 0.5)
    assert from_array(data, 0.1, occupied_thresh=0.5).states[50] == OCCUPIED


def test_a_bool_array_is_true_where_occupied() -> None:
    walls = hall() == 0
    got = from_array(walls, 0.05, image="hall")
    assert np.shares_memory(got.pixels, walls)
    assert (states(got) == np.where(walls, OCCUPIED, FREE)).all()
    assert got.image == "hall"
    assert got.warnings == ()


def test_a_grey_array_is_not_copied() -> None:
    pixels = hall()
    got = from_array(pixels, 0.05, (0.0, 0.0))
    assert np.shares_memory(got.pixels, pixels)
    assert (states(got) == EXPECTED).all()


@pytest.mark.parametrize(
    "array", [np.zeros((2, 2, 3), np.uint8), np.zeros((0, 4), np.uint8), np.zeros((2, 2)), np.zeros((2, 2), np.int64)]
)
def test_arrays_that_are_no_maps(array: Pixels) -> None:
    with pytest.raises(MapError) as caught:
        from_array(array, 0.05)
    assert caught.value.code == "map.pixels"


@pytest.mark.parametrize(
    ("value", "said", "hint"),
    [
        (None, "None is no array", "height x width pixels"),
        ("hall.pgm", "'hall.pgm' is no array", "groundplan.read(path)"),
        (np.dstack([hall()] * 3), f"an array of shape {(*hall().shape, 3)} is not a map", "array[..., 0]"),
    ],
)
def test_what_makes_no_map_is_told_with_what_would(value: Any, said: str, hint: str) -> None:
    with pytest.raises(MapError, match=re.escape(said)) as caught:
        from_array(value, 0.05)
    assert caught.value.code == "map.pixels" and hint in str(caught.value.hint)


@pytest.mark.parametrize(
    ("value", "said", "hint"),
    [
        (hall(), f"an array of shape {hall().shape} is no file's path", "groundplan.from_array(array, resolution)"),
        (hall().tolist(), "[[", "groundplan.from_array(array, resolution)"),
        (from_array(hall(), 0.05), " pixels of 0.05 m) is a Map already", "groundplan.survey takes it"),
        (None, "None is no file's path", "a path is text or a pathlib.Path"),
        (b"hall.yaml", "b'hall.yaml' is no file's path", "a path is text or a pathlib.Path"),
    ],
)
def test_what_is_no_path_is_not_read_and_the_hint_says_what_takes_it(value: Any, said: str, hint: str) -> None:
    with pytest.raises(MapError, match=re.escape(said)) as caught:
        groundplan.read(value)
    assert caught.value.code == "map.input" and hint in str(caught.value.hint) and "\n" not in str(caught.value)


def test_masked_pixels_are_refused_and_a_mask_of_none_is_not() -> None:
    greys = hall()
    for take in (from_array, lambda array, resolution: groundplan.survey(array, resolution=resolution)):
        with pytest.raises(MapError, match="12 pixels of the array are masked") as caught:
            take(np.ma.masked_array(greys, np.arange(greys.size).reshape(greys.shape) < 12), 0.05)
        assert caught.value.code == "map.pixels" and ".filled(205)" in str(caught.value.hint)
    none = from_array(np.ma.masked_array(greys), 0.05)
    assert type(none.pixels) is np.ndarray and (states(none) == EXPECTED).all()
    with pytest.raises(groundplan.ParameterError, match="pixels of the patch are masked"):
        survey = groundplan.survey(greys, resolution=0.05)
        survey.update(np.ma.masked_array(greys[:4, :4], np.eye(4, dtype=bool)), 0, 0)


def test_the_hint_for_shares_of_one_makes_a_map() -> None:
    shares = np.array([[0.0, 1.0], [np.nan, 0.5]])
    with pytest.raises(MapError) as caught:
        from_array(shares, 0.05)
    assert "np.where(np.isfinite(a), np.rint(100 * a), -1).astype('int8')" in str(caught.value.hint)
    got = from_array(np.where(np.isfinite(shares), np.rint(100 * shares), -1).astype("int8"), 0.05)
    assert got.values[got.pixels].tolist() == [[-1, 50], [0, 100]]


@pytest.mark.parametrize("origin", [[1.0, 2.0], (1, 2, 0.0), np.array([1.0, 2.0, 0.0])])
def test_an_origin_is_a_list_a_tuple_or_an_array(origin: Any) -> None:
    assert groundplan.survey(hall(), resolution=0.05, origin=origin).map.origin == (1.0, 2.0, 0.0)


NAN, INF = float("nan"), float("inf")


@pytest.mark.parametrize(
    ("frame", "said"),
    [
        ({"origin": (NAN, 0.0, 0.0)}, "origin (nan, 0.0, 0.0) is not a place"),
        ({"origin": (0.0, -INF, 0.0)}, "origin (0.0, -inf, 0.0) is not a place"),
        ({"origin": (0.0, 0.0, INF)}, "origin has the yaw inf, which is no angle"),
        ({"origin": None}, "origin None is not 2 or 3 numbers"),
        ({"resolution": NAN}, "resolution nan is not a number of metres a pixel"),
        ({"resolution": INF}, "resolution inf is not"),
        ({"resolution": 0}, "resolution 0 is not"),
        ({"resolution": -0.05}, "resolution -0.05 is not"),
        ({"resolution": "fine"}, "resolution 'fine' is not"),
    ],
)
def test_a_map_made_by_hand_has_a_frame_that_can_be(frame: dict[str, Any], said: str) -> None:
    made = from_array(hall(), 0.05)
    whole: dict[str, Any] = {"resolution": 0.05} | frame
    doors: list[Callable[[], groundplan.Map]] = [
        lambda: groundplan.Map(made.pixels, made.values, made.states, **whole),
        lambda: dataclasses.replace(made, **frame),
        lambda: from_array(hall(), **whole),
    ]
    for make in doors:
        with pytest.raises(MapError) as caught:
            make()
        assert str(caught.value).startswith(said) and caught.value.code == f"map.{next(iter(frame))}"


def test_a_map_made_by_hand_is_the_one_made_of_an_array() -> None:
    made = from_array(hall(), 0.05, (1.0, 2.0, NAN))
    by_hand = groundplan.Map(made.pixels, made.values, made.states, np.float32(0.05), [1, 2, NAN])  # type: ignore[arg-type]
    assert by_hand == made and by_hand.origin == (1.0, 2.0, 0.0)
    assert [warning.message for warning in by_hand.warnings] == ["the yaw of the origin is nan: read as 0"]
    assert dataclasses.replace(by_hand, image="hall").warnings == by_hand.warnings


def test_a_yaw_of_more_than_a_turn_is_taken_and_told_once() -> None:
    turned = from_array(hall(), 0.05, (1.0, 2.0, 90.0))
    said = "the yaw of the origin is 90 rad, more than a turn: if these are degrees, it is 1.5708"
    assert turned.origin[2] == 90 and [(w.code, w.message) for w in turned.warnings] == [("yaw-degrees", said)]
    assert dataclasses.replace(turned, image="hall").warnings == turned.warnings
    assert from_array(hall(), 0.05, (1.0, 2.0, -6.28)).warnings == ()


def test_a_map_of_other_arrays_is_told_as_a_stage_tells_it() -> None:
    made = from_array(hall(), 0.05)
    wrong: list[dict[str, Any]] = [{"pixels": made.pixels * 1.0}, {"values": None}]
    for arrays in wrong:
        with pytest.raises(groundplan.ParameterError, match="an array is not of the type that its stage says"):
            groundplan.survey(dataclasses.replace(made, **arrays))


@pytest.mark.parametrize("origin", [3, 3.5, "12", (1, 2, 3, 4), np.zeros((1, 3))])
def test_an_origin_that_is_none_is_named(origin: Any) -> None:
    with pytest.raises(MapError) as caught:
        groundplan.survey(hall(), resolution=0.05, origin=origin)
    assert caught.value.code == "map.origin"
