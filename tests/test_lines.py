"""II-B: radiograms, and the lines that are their peaks."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
import zoo
from _legs import Box, hall, legs
from zoo import OPEN, PADDED, RESOLUTION, TURNS, ZOO, Canvas

import groundplan

#: Maps whose weakest lines are as strong as one another, so that where the cut falls among them is chance; and maps
#: whose slanted walls are just thick enough to show two faces, a pixel or two apart.
EVEN = frozenset({"pillars", "all_occupied", "diagonal_only", "triangle_grid"})


def offsets_along(survey: groundplan.Survey, degrees: float) -> zoo.Points:
    """Offsets in pixels of the lines of the direction nearest to an angle, along the normal of that angle."""
    gaps = zoo.apart(np.radians([degrees]), survey.directions.angles)[0]
    direction = int(gaps.argmin())
    own = survey.lines.offsets[survey.lines.directions == direction] / RESOLUTION
    same = np.cos(np.radians(degrees) - survey.directions.angles[direction])
    return np.sort(own * np.sign(same))


@pytest.mark.parametrize("apart", [6, 8, 12])
@pytest.mark.parametrize("degrees", [0, 17, 45, 73])
def test_two_parallel_walls_a_few_pixels_apart_are_two_lines(degrees: float, apart: float) -> None:
    canvas = Canvas(220, 220, zoo.FREE)
    cos, sin = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    middle = np.array([110.0, 110.0]) - 80 * np.array([cos, sin])
    centre = -110.0 * sin + 110.0 * cos
    for side in (-0.5, 0.5):
        x, y = middle + side * apart * np.array([-sin, cos])
        canvas.bar((float(x), float(y)), degrees, 160, 1.5)
    found = offsets_along(groundplan.survey(canvas.picture, resolution=RESOLUTION), degrees)
    assert len(found) == 2
    assert found == pytest.approx([centre - apart / 2, centre + apart / 2], abs=0.6)


def test_the_walls_of_a_room_lie_where_they_were_drawn() -> None:
    survey = zoo.surveyed("single_room")
    assert offsets_along(survey, 0) == pytest.approx([11.5, 78.5], abs=0.3)
    assert -offsets_along(survey, 90)[::-1] == pytest.approx([11.5, 108.5], abs=0.3)


def test_a_thick_wall_is_a_line_for_each_face() -> None:
    survey = zoo.surveyed("thick_walls")
    assert offsets_along(survey, 0) == pytest.approx([10.5, 21.5, 98.5, 109.5], abs=0.5)
    assert -offsets_along(survey, 90)[::-1] == pytest.approx([10.5, 21.5, 128.5, 139.5], abs=0.5)


def test_a_line_says_how_much_of_a_wall_lies_on_it() -> None:
    lines = zoo.surveyed("freestanding_wall").lines
    # Two faces of a wall of 4 m.
    assert lines.amplitudes == pytest.approx([8.0], rel=0.1)


@pytest.mark.parametrize("name", ZOO)
def test_the_knob_goes_from_coarse_to_fine(name: str) -> None:
    picture = ZOO[name]()

    def count(**parameters: Any) -> int:
        return len(groundplan.survey(picture, resolution=RESOLUTION, threads=1, **parameters).lines)

    steps = [count(lines_detail=detail) for detail in (0.0, "coarse", 0.5, "fine", 1.0)]
    assert steps == sorted(steps)
    assert steps[1] <= len(zoo.surveyed(name).lines) <= steps[-1]


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("name", sorted(ZOO.keys() - EVEN))
def test_a_turned_map_has_the_turned_lines(name: str, turn: int) -> None:
    original, turned = zoo.surveyed(name), zoo.surveyed(name, turn)
    if turn == PADDED and name in OPEN:
        return
    variant = zoo.variants(name)[turn]
    assert len(turned.lines) == len(original.lines)
    found = [np.zeros((0, 2))]
    for angle, lines in zip(turned.directions.angles, by_direction(turned), strict=True):
        match = int(zoo.apart(variant.angles(original.directions.angles), [angle])[:, 0].argmin())
        old = original.directions.angles[match]
        # Where the old line passes the map's middle, as an offset of the new direction.
        size = np.array([original.map.width, original.map.height]) * RESOLUTION / 2
        normal = np.array([-np.sin(old), np.cos(old)])
        feet = size + (by_direction(original)[match] - normal @ size)[:, None] * normal
        moved = np.sort(variant.points(feet) @ np.array([-np.sin(angle), np.cos(angle)]))
        found.append(np.stack([moved, lines], axis=1))
    pairs = np.concatenate(found)
    assert pairs[:, 0] == pytest.approx(pairs[:, 1], abs=0.5 * RESOLUTION)


def by_direction(survey: groundplan.Survey) -> list[zoo.Points]:
    lines = survey.lines
    return [np.sort(lines.offsets[lines.directions == n]) for n in range(len(survey.directions))]


@pytest.mark.parametrize("name", ZOO)
def test_lines_come_by_direction_and_offset(name: str) -> None:
    lines = zoo.surveyed(name).lines
    assert (np.lexsort((lines.offsets, lines.directions)) == np.arange(len(lines))).all()
    assert (lines.amplitudes >= lines.min_amplitude).all()


@pytest.mark.parametrize("name", ["single_room", "turned_warehouse", "skewed"])
def test_a_radiogram_covers_the_map(name: str) -> None:
    survey = zoo.surveyed(name)
    width, height = survey.map.width * RESOLUTION, survey.map.height * RESOLUTION
    corners = np.array([[0, 0], [width, 0], [0, height], [width, height]])
    for radiogram in survey.radiograms:
        angle = survey.directions.angles[radiogram.direction]
        offsets = corners @ np.array([-np.sin(angle), np.cos(angle)])
        assert radiogram.offsets[0] <= offsets.min() <= offsets.max() <= radiogram.offsets[-1]
        assert (radiogram.values >= 0).all()


def test_the_response_of_a_radiogram_has_a_row_for_each_width() -> None:
    radiogram = zoo.surveyed("single_room").radiograms[0]
    response = groundplan.find_response(radiogram)
    assert response.rows.shape == (len(response.widths), len(radiogram.values))
    assert response.widths[[0, -1]] / RESOLUTION == pytest.approx([1.0, 20.0])
    assert (np.diff(response.widths) > 0).all()


def racks_on_legs(degrees: float = 0.0) -> zoo.Picture:
    """Four racks of eight bays, of which a lidar sees no more than the legs, in a hall of 29.6 by 19.4 m."""
    return hall(29.6, 19.4, (box for n in range(4) for box in legs(4.0, 3.0 + 4.1 * n, 8, 1.1, 2.7)), degrees)


#: From face to face of those racks, and to the hall's walls, metres from its middle.
FACES = [-9.7, *(low + at - 9.7 for at in (3.0, 7.1, 11.2, 15.3) for low in (0.0, 1.1)), 9.7]


def along_faces(survey: groundplan.Survey, degrees: float) -> list[float]:
    """Offsets from the hall's middle of the lines along the racks, metres."""
    normal = np.array([-np.sin(np.radians(degrees)), np.cos(np.radians(degrees))])
    middle = normal @ [survey.map.width * RESOLUTION / 2, survey.map.height * RESOLUTION / 2]
    return sorted(float(offset) for offset in offsets_along(survey, degrees) * RESOLUTION - middle)


@pytest.mark.parametrize("degrees", [0.0, 17.0])
def test_the_faces_of_racks_on_legs_are_lines(degrees: float) -> None:
    survey = groundplan.survey(racks_on_legs(degrees), resolution=RESOLUTION)
    assert along_faces(survey, degrees) == pytest.approx(FACES, abs=0.1)
    assert all(survey.lines.amplitudes > 0.5)
    assert not survey.problems()


def test_a_rack_whose_faces_are_lines_has_no_others() -> None:
    def boxes() -> Iterator[Box]:
        for n in range(4):
            yield from legs(4.0, 3.0 + 4.1 * n, 8, 1.1, 2.7)
            yield 4.3, 3.0 + 4.1 * n, 22.0, 4.1 + 4.1 * n

    map = groundplan.from_array(hall(29.6, 19.4, boxes()), RESOLUTION)
    directions = groundplan.find_directions(map)
    lines = groundplan.find_lines(groundplan.find_radiograms(map, directions))
    assert groundplan.add_rack_faces(map, directions, lines) == lines


def test_of_racks_on_legs_as_much_has_to_be_seen_as_is_asked_of_lines() -> None:
    map = groundplan.from_array(racks_on_legs(), RESOLUTION)
    surveys = groundplan.survey(map), groundplan.survey(map, lines_min_amplitude=3.0)
    assert [len(along_faces(survey, 0.0)) for survey in surveys] == [10, 2]


@pytest.mark.parametrize("detail", [0.8, 0.9, 1.0])
def test_a_fine_detail_has_the_faces_of_racks_on_legs_that_the_default_has(detail: float) -> None:
    survey = groundplan.survey(racks_on_legs(), resolution=RESOLUTION, lines_detail=detail)
    assert all(np.min(np.abs(np.subtract(along_faces(survey, 0.0), face))) < 0.1 for face in FACES)


def test_racks_on_legs_have_no_line_twice_in_whatever_order_lines_are_given() -> None:
    map = groundplan.from_array(racks_on_legs(), RESOLUTION)
    directions, lines = groundplan.find_directions(map), groundplan.survey(map).lines
    order = np.random.default_rng(1).permutation(len(lines))
    shuffled = groundplan.Lines.of(lines.directions[order], lines.offsets[order])
    assert len(groundplan.add_rack_faces(map, directions, shuffled)) == len(lines)
    none = groundplan.Lines.of([], [])
    assert len(groundplan.add_rack_faces(map, directions, none, lines_min_amplitude=50.0)) == 0


def test_lines_that_are_given_and_those_of_the_papers_labels_stay_as_they_are() -> None:
    map = groundplan.from_array(racks_on_legs(), RESOLUTION)
    given = groundplan.find_lines(groundplan.find_radiograms(map, groundplan.find_directions(map)))
    assert groundplan.survey(map, lines=given).lines == given
    assert groundplan.survey(map, labels_method="paper").lines == given
