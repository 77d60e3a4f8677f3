"""II-D, II-E: cogency, walls, and the dual."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import zoo
from zoo import OPEN, PADDED, RESOLUTION, TURNS, ZOO, Canvas

import groundplan
from groundplan.stages import NONE

#: Maps with edges so near to a threshold that a hundredth of a degree decides.
CLOSE = frozenset({"pillars", "triangle_grid", "turned_warehouse", "half_explored", "diagonal_only"})


def lengths(survey: groundplan.Survey) -> zoo.Points:
    """Of the walls, metres."""
    ends = survey.walls.points.reshape(-1, 2, 2)
    gaps: zoo.Points = np.hypot(*(ends[:, 1] - ends[:, 0]).T)
    return gaps


@pytest.mark.parametrize("name", ZOO)
def test_cogency_is_what_the_paper_says(name: str) -> None:
    survey = zoo.surveyed(name)
    faces = survey.subdivision.edge_faces
    inner = (faces != NONE).all(axis=1)
    occupancy = survey.occupancy.faces
    disparity = np.where(inner, np.abs(occupancy[faces[:, 0]] - occupancy[faces[:, 1]]), 0)
    assert survey.walls.disparity == pytest.approx(disparity, abs=2e-6)
    t1, t2 = survey.parameters["walls.disparity"], survey.parameters["walls.occupancy"]
    cogent = inner & ((survey.walls.disparity > t1) | (survey.occupancy.edges > t2))
    assert (survey.walls.cogent == cogent).all()


def test_a_wall_in_free_space_is_freestanding() -> None:
    walls = zoo.surveyed("freestanding_wall").walls
    assert walls.freestanding.tolist() == [True]


def test_the_walls_of_a_room_separate() -> None:
    survey = zoo.surveyed("single_room")
    assert survey.walls.freestanding.tolist() == [False] * 4
    # Between the middles of its walls: 97 pixels and 67, twice each.
    assert np.sort(lengths(survey)) / RESOLUTION == pytest.approx([67, 67, 97, 97], abs=2)


def test_a_wall_of_two_kinds_is_two_walls() -> None:
    # Something is taken below its left half, and free space is on both sides of its right one.
    picture = Canvas(160, 100, zoo.FREE).box(20, 20, 80, 50).box(80, 48, 140, 51).picture
    directions = groundplan.Directions.of([0.0, -np.pi / 2])
    offsets = RESOLUTION * np.array([20.0, 49.5, 20.0, 80.0, 140.0])
    lines = groundplan.Lines.of([0, 0, 1, 1, 1], offsets)
    survey = groundplan.survey(picture, resolution=RESOLUTION, directions=directions, lines=lines)
    upper = survey.walls.lines == 1
    assert survey.walls.freestanding[upper].tolist() == [False, True]
    assert survey.walls.points.reshape(-1, 4)[upper] / RESOLUTION == pytest.approx(
        np.array([[20, 49.5, 80, 49.5], [80, 49.5, 140, 49.5]])
    )


def test_the_frontier_of_the_unknown_is_no_wall() -> None:
    # Free space that ends where the map was not seen; the wall stands elsewhere.
    picture = Canvas(160, 100).box(0, 0, 80, 100, zoo.FREE).box(20, 20, 23, 80).picture
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    assert (survey.walls.points[:, 0] < 25 * RESOLUTION).all()


@pytest.mark.parametrize("name", ZOO)
def test_walls_lie_on_their_lines(name: str) -> None:
    survey = zoo.surveyed(name)
    lines = np.repeat(survey.walls.lines, 2)
    angles = survey.directions.angles[survey.lines.directions[lines]]
    offsets = (survey.walls.points * np.stack([-np.sin(angles), np.cos(angles)], axis=1)).sum(axis=1)
    assert offsets == pytest.approx(survey.lines.offsets[lines], abs=1e-5)


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("name", sorted(ZOO.keys() - CLOSE))
def test_a_turned_map_has_the_turned_walls(name: str, turn: int) -> None:
    if turn == PADDED and name in OPEN:
        return
    original, turned = zoo.surveyed(name), zoo.surveyed(name, turn)
    assert len(turned.walls) == len(original.walls)
    assert turned.walls.freestanding.sum() == original.walls.freestanding.sum()
    moved = zoo.variants(name)[turn].points(original.walls.points)
    assert zoo.farthest(moved, turned.walls.points) < 2 * RESOLUTION


@pytest.mark.parametrize("name", ZOO)
def test_each_inner_edge_is_one_link(name: str) -> None:
    survey = zoo.surveyed(name)
    faces, dual = survey.subdivision.edge_faces, survey.adjacency
    inner = np.nonzero((faces != NONE).all(axis=1))[0]
    assert dual.edges.tolist() == inner.tolist()
    assert (dual.faces == faces[inner]).all()
    assert (dual.connected == ~survey.walls.cogent[inner]).all()
    pairs = {frozenset(pair) for pair in dual.faces.tolist()}
    assert len(pairs) == len(dual)
    assert all(len(pair) == 2 for pair in pairs)


@pytest.mark.parametrize("name", ZOO)
def test_every_face_can_be_reached_over_links(name: str) -> None:
    survey = zoo.surveyed(name)
    group = np.arange(len(survey.subdivision.areas))
    for _ in group:
        before = group.copy()
        for a, b in survey.adjacency.faces:
            group[a] = group[b] = min(group[a], group[b])
        if (before == group).all():
            break
    assert (group == 0).all()


def test_thresholds_are_the_callers() -> None:
    picture = ZOO["comb_of_racks"]()

    def count(**parameters: Any) -> int:
        return int(groundplan.survey(picture, resolution=RESOLUTION, **parameters).walls.cogent.sum())

    assert count(walls_disparity=1.0, walls_occupancy=1.0) == 0
    assert count(walls_disparity=0.1) >= count() >= count(walls_disparity=0.9)
    assert count(walls_occupancy=0.1) >= count() >= count(walls_occupancy=0.9)
