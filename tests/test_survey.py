"""The survey as a whole: its stages, its frame, what is given to it."""

from __future__ import annotations

import dataclasses
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import zoo
from PIL import Image
from zoo import FREE, OCCUPIED, OPEN, PADDED, RESOLUTION, TURNS, ZOO

import groundplan
from groundplan import Directions, GroundplanError, Lines, MapError, ParameterError

#: Maps with labels that a hundredth of a degree decides.
CLOSE = frozenset({"pillars", "triangle_grid", "all_occupied", "diagonal_only", "skewed", "two_blocks_of_racks"})


def survey(name: str, **given: Any) -> groundplan.Survey:
    return groundplan.survey(ZOO[name](), resolution=RESOLUTION, threads=1, **given)


@pytest.mark.parametrize("name", ZOO)
def test_the_stages_one_by_one_give_the_survey(name: str) -> None:
    expected = zoo.surveyed(name)
    map = groundplan.from_array(ZOO[name](), RESOLUTION)
    gradients = groundplan.find_gradients(map)
    directions = groundplan.find_directions(map, gradients)
    radiograms = groundplan.find_radiograms(map, directions, gradients)
    lines = groundplan.add_rack_faces(map, directions, groundplan.find_lines(radiograms), gradients)
    cut = groundplan.subdivide(map, directions, lines)
    occupancy = groundplan.find_occupancy(map, directions, lines, gradients)
    walls = groundplan.find_walls(cut, occupancy)
    adjacency = groundplan.find_adjacency(cut, walls)
    assert directions == expected.directions
    assert radiograms == expected.radiograms
    assert lines == expected.lines
    assert cut == expected.subdivision
    assert occupancy == expected.occupancy
    assert walls == expected.walls
    assert adjacency == expected.adjacency


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("name", sorted(ZOO.keys() - CLOSE))
def test_a_turned_map_has_labels_of_the_same_kinds(name: str, turn: int) -> None:
    if turn == PADDED and name in OPEN:
        return
    kinds = [
        Counter((label["kind"], label.get("type")) for label in found.labels)
        for found in (zoo.surveyed(name), zoo.surveyed(name, turn))
    ]
    assert kinds[0] == kinds[1]


def gain(one: groundplan.Survey, other: groundplan.Survey) -> zoo.Points:
    """How many pixels more each face has."""
    return one.occupancy.pixels.astype(np.float64) - other.occupancy.pixels.astype(np.float64)


def outline(survey: groundplan.Survey) -> zoo.Points:
    """Pixels around each face: offsets are rounded to micrometres, so those that lie on its lines may change sides."""
    cut = survey.subdivision
    sides = [cut.polygon(face) for face in range(len(cut.areas))]
    around = [np.abs(np.roll(corners, -1, axis=0) - corners).sum() for corners in sides]
    return np.array(around) / RESOLUTION + 1


@pytest.mark.parametrize("name", ZOO)
def test_moving_the_origin_moves_the_survey(name: str) -> None:
    still, moved = zoo.surveyed(name), survey(name, origin=(-120.5, 3000.25, 0.0))
    shift = np.array([-120.5, 3000.25])
    assert (moved.directions.angles == still.directions.angles).all()
    angles = still.directions.angles[still.lines.directions]
    offsets = still.lines.offsets + np.stack([-np.sin(angles), np.cos(angles)], axis=1) @ shift
    assert moved.lines.offsets == pytest.approx(offsets, abs=1e-5)
    assert moved.subdivision.vertices == pytest.approx(still.subdivision.vertices + shift, abs=2e-5)
    assert (moved.subdivision.edge_faces == still.subdivision.edge_faces).all()
    assert (np.abs(gain(moved, still)) <= outline(still)).all()
    assert moved.walls.points == pytest.approx(still.walls.points + shift, abs=2e-5)
    assert [label["kind"] for label in moved.labels] == [label["kind"] for label in still.labels]
    sure = [label["confidence"] for label in still.labels]
    assert [label["confidence"] for label in moved.labels] == pytest.approx(sure, abs=0.02)
    assert moved.problems() == []


@pytest.mark.parametrize("name", sorted(ZOO.keys() - CLOSE))
@pytest.mark.parametrize("yaw", [0.5, -2.0, np.pi])
def test_yaw_in_the_origin_turns_the_survey(name: str, yaw: float) -> None:
    still, turned = zoo.surveyed(name), survey(name, origin=(1.0, 2.0, yaw))
    rotation = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
    shift = np.array([1.0, 2.0])
    gaps = zoo.apart(still.directions.angles + yaw, turned.directions.angles)
    assert len(turned.directions) == len(still.directions)
    assert (np.diag(gaps) < 1e-6).all()
    assert len(turned.lines) == len(still.lines)
    assert len(turned.subdivision.areas) == len(still.subdivision.areas)
    for old, new in (
        (still.subdivision.vertices, turned.subdivision.vertices),
        (still.subdivision.centres, turned.subdivision.centres),
        (still.walls.points, turned.walls.points),
    ):
        assert zoo.farthest(old @ rotation.T + shift, new) < 0.25 * RESOLUTION
    assert turned.problems() == []


def test_a_quarter_turn_of_yaw_is_a_quarter_turn_of_the_map() -> None:
    map_turned = zoo.surveyed("comb_of_racks", 1)
    height = ZOO["comb_of_racks"]().shape[0] * RESOLUTION
    frame_turned = survey("comb_of_racks", origin=(height, 0.0, np.pi / 2))
    assert zoo.farthest(map_turned.subdivision.centres, frame_turned.subdivision.centres) < RESOLUTION


def test_an_occupancy_grid_message_is_the_picture_upside_down() -> None:
    picture = ZOO["turned_warehouse"]()
    values = {zoo.FREE: 0, zoo.UNKNOWN: -1, zoo.OCCUPIED: 100}
    data = np.vectorize(values.get)(picture[::-1]).astype(np.int8)
    message = groundplan.survey(data, resolution=RESOLUTION)
    assert (
        message.to_json().partition('"directions"')[2]
        == zoo.surveyed("turned_warehouse").to_json().partition('"directions"')[2]
    )


def test_rows_that_lie_the_other_way_are_the_same_map() -> None:
    picture = ZOO["turned_warehouse"]()
    flipped = np.ascontiguousarray(picture[::-1])[::-1]
    spread = np.repeat(picture, 2, axis=1)[:, ::2]
    for view in (flipped, spread):
        assert not view.flags.c_contiguous
        assert groundplan.survey(view, resolution=RESOLUTION).to_json() == zoo.surveyed("turned_warehouse").to_json()


def test_the_pixels_are_left_as_they_were() -> None:
    picture = ZOO["comb_of_racks"]()
    picture.flags.writeable = False
    before = picture.copy()
    groundplan.survey(picture, resolution=RESOLUTION)
    assert (picture == before).all()


def test_given_directions_are_taken() -> None:
    given = Directions.of(np.radians([5.0, -40.0]))
    found = survey("single_room", directions=given)
    assert found.directions == given
    assert [r.direction for r in found.radiograms] == [0, 1]
    assert found.problems() == []


def test_given_lines_are_taken() -> None:
    directions, lines = Directions.of([0.0, -np.pi / 2]), Lines.of([0, 1, 1], [2.0, 1.0, 4.5])
    found = survey("single_room", directions=directions, lines=lines)
    assert found.lines == lines
    assert len(found.subdivision.areas) == 2 * 3
    assert found.problems() == []


def test_given_stages_that_were_found_change_nothing() -> None:
    expected = zoo.surveyed("turned_warehouse")
    found = survey("turned_warehouse", directions=expected.directions, lines=expected.lines)
    assert found.to_json() == expected.to_json()


@pytest.mark.parametrize("name", ["empty", "all_unknown", "all_occupied", "one_pixel", "one_row", "noise"])
def test_a_map_without_structure_is_one_face_and_warnings(name: str) -> None:
    found = zoo.surveyed(name)
    assert len(found.subdivision.areas) == 1
    assert found.warnings
    assert {label["kind"] for label in found.labels} <= {"region"}


def test_what_hardly_lines_up_is_not_said_to_be_nothing() -> None:
    specks = np.random.default_rng(5).random((400, 400)) < 0.1
    picture = np.where(specks, OCCUPIED, FREE).astype(np.uint8)
    found = groundplan.survey(picture, resolution=RESOLUTION, directions_angles_deg=[30.0])
    said = {warning.code: warning.message for warning in found.warnings}
    assert said["little-structure"].startswith("less than 1 percent of the structure")


def test_parameters_in_force_are_kept() -> None:
    found = survey("single_room", lines_snr=4.0, **{"walls.disparity": 0.3})
    assert found.parameters["lines.snr"] == 4.0
    assert found.parameters["walls.disparity"] == 0.3
    assert found.parameters["directions.count"] is None


def test_without_ways_it_is_said_what_was_sought() -> None:
    found = groundplan.survey(ZOO["single_room"](), resolution=RESOLUTION, labels_min_width=7.5)
    said = {warning.code: warning.message for warning in found.warnings}
    assert "regions: 1" in said["no-labels"]
    assert "labels.min_width = 7.5 to labels.max_width = 8 m" in said["no-labels"]


def test_a_kind_of_label_that_there_is_not_is_no_empty_list() -> None:
    room = zoo.surveyed("single_room")
    assert room.of_kind("rack") == []
    with pytest.raises(ParameterError, match="'corridr'") as refused:
        room.of_kind("corridr")
    assert refused.value.code == "label.kind" and "corridor" in str(refused.value.hint)


def test_a_file_is_surveyed_as_the_map_read_from_it(tmp_path: Path) -> None:
    path = tmp_path / "room.png"
    Image.fromarray(ZOO["single_room"]()).save(path)
    read = groundplan.read(path, resolution=RESOLUTION, negate=True)
    found = groundplan.survey(path, resolution=RESOLUTION, reading={"negate": True})
    assert found.to_json() == groundplan.survey(read).to_json()
    with pytest.raises(MapError, match=r"there is no 'negat'"):
        groundplan.survey(path, resolution=RESOLUTION, reading={"negat": True})
    with pytest.raises(MapError, match=r"nowhere\.yaml"):
        groundplan.survey("nowhere.yaml")


def test_what_is_wrong_is_said_by_name() -> None:
    picture = ZOO["single_room"]()
    with pytest.raises(ParameterError, match="lines_snt") as unknown:
        groundplan.survey(picture, resolution=RESOLUTION, lines_snt=1)
    assert unknown.value.code == "parameter.unknown"
    with pytest.raises(ParameterError, match="-1") as range_:
        groundplan.survey(picture, resolution=RESOLUTION, lines_snr=-1)
    assert range_.value.code == "parameter.range"
    with pytest.raises(GroundplanError, match="resolution"):
        groundplan.survey(picture)
    for array in (picture.astype(np.float64), picture[0], np.zeros((0, 5), dtype=np.uint8)):
        with pytest.raises(MapError):
            groundplan.survey(array, resolution=RESOLUTION)


def test_what_says_nothing_about_a_map_is_refused_by_name() -> None:
    picture = ZOO["single_room"]()
    map = groundplan.from_array(picture, RESOLUTION)
    with pytest.raises(MapError, match="resolution says nothing about a Map"):
        groundplan.survey(map, resolution=0.1)
    with pytest.raises(MapError, match="mode says nothing about a Map"):
        groundplan.survey(map, reading={"mode": "raw"})
    with pytest.raises(MapError, match="array"):
        groundplan.survey(picture, resolution=RESOLUTION, reading={"mode": "raw"})


def test_a_misspelt_word_of_reading_is_told_with_the_right_one() -> None:
    with pytest.raises(MapError, match="'unknwon'") as caught:
        groundplan.survey(Path("hall.pgm"), client=object(), resolution=RESOLUTION, reading={"unknwon": 205})
    assert caught.value.hint == "did you mean unknown?"


def test_algorithm_1_as_printed_surveys_every_map() -> None:
    for name in ZOO:
        assert survey(name, labels_method="paper").problems() == []


def test_labels_name_faces_and_labels_that_exist() -> None:
    for name in ZOO:
        for method in ("strips", "paper"):
            found = survey(name, labels_method=method)
            for label in found.labels:
                assert all(0 <= face < len(found.subdivision.areas) for face in label.get("faces", []))
                assert all(found.labels[n]["kind"] == "corridor" for n in label.get("corridors", []))


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"directions": [0, 7]}, "a line names a direction that there is not"),
        ({"offsets": [1.0, float("nan")]}, "an offset of the lines is not finite"),
        ({"offsets": [1.0]}, "the lines' arrays differ in length"),
    ],
)
def test_lines_that_do_not_fit_are_refused(change: dict[str, Any], sentence: str) -> None:
    good = Lines.of([0, 0], [1.0, 2.0])
    kinds = {"offsets": np.float64, "directions": np.uint32}
    arrays: dict[str, Any] = {name: np.array(values, kinds[name]) for name, values in change.items()}
    lines = dataclasses.replace(good, **arrays)
    with pytest.raises(ValueError, match=sentence):
        survey("single_room", directions=Directions.of([0.0]), lines=lines)
