"""II-D, II-E: cogency, walls, and the dual."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
import zoo
from zoo import OPEN, PADDED, RESOLUTION, TURNS, ZOO, Canvas

import groundplan
from groundplan._results import NONE

#: Maps with edges so near to a threshold that a hundredth of a degree decides.
CLOSE = frozenset({"pillars", "triangle_grid", "turned_warehouse", "half_explored", "diagonal_only", "skewed"})


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
        np.array([[20, 49.5, 80, 49.5], [80, 49.5, 140, 49.5]]), abs=1.1
    )


def spans(picture: zoo.Picture, across: Sequence[float], **parameters: Any) -> list[list[float]]:
    """From and to, in pixels, of the walls along y = 50; lines cross that one at each of `across`."""
    directions = groundplan.Directions.of([0.0, -np.pi / 2])
    lines = groundplan.Lines.of([0] + [1] * len(across), RESOLUTION * np.array([50.0, *across]))
    survey = groundplan.survey(picture, resolution=RESOLUTION, directions=directions, lines=lines, **parameters)
    along = survey.walls.points.reshape(-1, 2, 2)[survey.walls.lines == 0] / RESOLUTION
    assert along[:, :, 1] == pytest.approx(50.0, abs=1e-3)
    ends: list[list[float]] = np.sort(along[:, :, 0], axis=1).tolist()
    return sorted(ends)


def wall(*pieces: tuple[int, int]) -> zoo.Picture:
    """Free space with pieces of one wall, from and to."""
    plan = Canvas(240, 100, zoo.FREE)
    for start, end in pieces:
        plan.box(start, 49, end, 52)
    return plan.picture


def test_a_wall_ends_where_its_structure_ends() -> None:
    # Between lines on either side it takes 120 of 200 pixels.
    assert spans(wall((60, 180)), (20.0, 220.0)) == [pytest.approx([60, 180], abs=1.5)]


def test_a_wall_goes_on_where_little_of_it_lies_on_the_next_edge() -> None:
    # Beyond x = 150 it takes 30 of 70 pixels, and that edge is not cogent.
    assert spans(wall((60, 180)), (20.0, 150.0, 220.0)) == [pytest.approx([60, 180], abs=1.5)]


def test_a_door_is_open_be_it_in_the_middle_of_an_edge() -> None:
    door = spans(wall((30, 100), (118, 210)), (20.0, 220.0))
    assert door == [pytest.approx([30, 100], abs=1.5), pytest.approx([118, 210], abs=1.5)]


def test_a_crack_is_no_opening_and_what_is_one_the_caller_says() -> None:
    cracked = wall((30, 100), (106, 210))
    assert spans(cracked, (20.0, 220.0)) == [pytest.approx([30, 210], abs=1.5)]
    assert len(spans(cracked, (20.0, 220.0), walls_min_opening=0.1)) == 2
    door = wall((30, 100), (118, 210))
    assert spans(door, (20.0, 220.0), walls_min_opening=1.0) == [pytest.approx([30, 210], abs=1.5)]


def test_a_scrap_beside_a_wall_does_not_lengthen_it() -> None:
    assert spans(wall((60, 180), (186, 188)), (20.0, 220.0)) == [pytest.approx([60, 180], abs=1.5)]


@pytest.mark.parametrize("between", [(110, 130, 140), (107, 110, 117)])
@pytest.mark.parametrize("origin", [(0.0, 0.0), (0.013, 0.02), (10.0, 20.0), (-7.77, 3.1), (565000.0, 5929980.8)])
def test_a_gap_just_at_the_bound_is_no_opening_wherever_the_origin_lies(
    between: tuple[int, int, int], origin: tuple[float, float]
) -> None:
    # A pixel covers the one beside it: gaps of 10 are 0.4 m, and those of 7 are as wide as the 3 pixels between them.
    start, end, again = between
    x, y = origin
    survey = groundplan.survey(
        wall((30, 100), (start, end), (again, 210)),
        resolution=RESOLUTION,
        origin=origin,
        directions=groundplan.Directions.of([0.0, -np.pi / 2]),
        lines=groundplan.Lines.of([0, 1, 1], np.array([50.0, 20.0, 220.0]) * RESOLUTION + [y, x, x]),
    )
    along = survey.walls.points.reshape(-1, 2, 2)[survey.walls.lines == 0, :, 0] - x
    assert np.sort(along) / RESOLUTION == pytest.approx(np.array([[30, 210]]), abs=1.5)


def test_a_door_is_open_in_the_zoo() -> None:
    survey = zoo.surveyed("two_rooms_with_door")
    ends = survey.walls.points.reshape(-1, 2, 2) / RESOLUTION
    upright = ends[np.abs(ends[:, 0, 0] - ends[:, 1, 0]) < 1]
    between = np.sort(upright[np.abs(upright[:, 0, 0] - 80.5) < 3][:, :, 1], axis=1)
    # The door is from y = 30 to 46.
    assert len(between) >= 2
    assert ((between[:, 1] < 32) | (between[:, 0] > 44)).all()


def test_the_walls_of_a_room_close() -> None:
    points = zoo.surveyed("single_room").walls.points
    assert len(np.unique(points, axis=0)) == 4


@pytest.mark.parametrize("name", ["single_room", "turned_warehouse", "l_corridor"])
def test_no_two_walls_end_just_beside_each_other(name: str) -> None:
    walls = zoo.surveyed(name).walls
    gaps = np.linalg.norm(walls.points[:, None] - walls.points[None], axis=2)
    lines = walls.lines.repeat(2)
    assert not ((lines[:, None] != lines) & (gaps > 1e-6) & (gaps < 3 * RESOLUTION)).any()


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


def has_the_walls(name: str, turn: int, **asked: Any) -> None:
    """Asserts that a variant of a map has its walls."""
    original, turned = (
        groundplan.survey(variant.picture, resolution=RESOLUTION, threads=1, **asked)
        for variant in (zoo.variants(name)[0], zoo.variants(name)[turn])
    )
    assert len(turned.walls) == len(original.walls)
    assert turned.walls.freestanding.sum() == original.walls.freestanding.sum()
    moved = zoo.variants(name)[turn].points(original.walls.points)
    assert zoo.farthest(moved, turned.walls.points) < 2 * RESOLUTION


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("name", sorted(ZOO.keys() - CLOSE))
def test_a_turned_map_has_the_turned_walls(name: str, turn: int) -> None:
    if turn != PADDED or name not in OPEN:
        has_the_walls(name, turn)


def between(values: zoo.Points, start: float, end: float) -> float:
    """The middle of the widest gap between values within [start, end]."""
    inside = np.unique(np.append(values[(values > start) & (values < end)], (start, end)))
    widest = np.diff(inside).argmax()
    assert inside[widest + 1] - inside[widest] > 0.04
    return float(inside[widest : widest + 2].mean())


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("name", sorted(CLOSE - {"turned_warehouse"}))
def test_a_turned_map_has_the_turned_walls_where_no_edge_is_near_a_threshold(name: str, turn: int) -> None:
    inner = (zoo.surveyed(name).subdivision.edge_faces != NONE).all(axis=1)
    # What counts as a wall, and as an opening, is asked where nothing of the map is near to it: directions of turned
    # maps are a hundredth of a degree apart, and widths by pixels are whole pixels.
    asked = {
        "walls.min_opening": 8.5 * RESOLUTION,
        "walls.disparity": between(zoo.surveyed(name).walls.disparity[inner], 0.05, 0.4),
        "walls.occupancy": between(zoo.surveyed(name).occupancy.edges[inner], 0.3, 0.7),
    }
    if turn != PADDED or name not in OPEN:
        has_the_walls(name, turn, **asked)


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
