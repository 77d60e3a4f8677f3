"""II-C: what the lines cut a map into."""

from __future__ import annotations

import numpy as np
import pytest
import zoo
from zoo import OPEN, PADDED, RESOLUTION, TURNS, ZOO

import groundplan
from groundplan import Directions, Lines, Subdivision
from groundplan._results import NONE

EVERY = [(name, turn) for name in ZOO for turn in TURNS]


@pytest.mark.parametrize(("name", "turn"), EVERY)
def test_every_invariant_holds(name: str, turn: int) -> None:
    assert zoo.surveyed(name, turn).problems() == []


@pytest.mark.parametrize("name", ZOO)
def test_vertices_less_edges_plus_faces_are_one(name: str) -> None:
    cut = zoo.surveyed(name).subdivision
    # The outside is not counted among the faces, and everything hangs together.
    assert len(cut.vertices) - len(cut.edge_vertices) + len(cut.areas) == 1


@pytest.mark.parametrize("name", ZOO)
def test_the_faces_cover_the_map(name: str) -> None:
    survey = zoo.surveyed(name)
    area = survey.map.width * survey.map.height * RESOLUTION**2
    assert survey.subdivision.areas.sum() == pytest.approx(area, abs=1e-6 * len(survey.subdivision.areas))
    assert survey.subdivision.map_area == pytest.approx(area)


@pytest.mark.parametrize("name", ZOO)
def test_faces_are_convex_and_run_counter_clockwise(name: str) -> None:
    cut = zoo.surveyed(name).subdivision
    for face in range(len(cut.areas)):
        corners = cut.polygon(face)
        sides = np.roll(corners, -1, axis=0) - corners
        after = np.roll(sides, -1, axis=0)
        # Vertices are rounded to micrometres.
        assert (sides[:, 0] * after[:, 1] - sides[:, 1] * after[:, 0] > -1e-4).all()


@pytest.mark.parametrize("name", ZOO)
def test_an_edge_has_its_left_face_on_its_left(name: str) -> None:
    cut = zoo.surveyed(name).subdivision
    ends = cut.vertices[cut.edge_vertices]
    along = ends[:, 1] - ends[:, 0]
    for side, sign in ((0, 1), (1, -1)):
        inner = cut.edge_faces[:, side] != NONE
        towards = cut.centres[cut.edge_faces[inner, side]] - ends[inner, 0]
        cross = along[inner, 0] * towards[:, 1] - along[inner, 1] * towards[:, 0]
        assert (sign * cross > -1e-5).all()


@pytest.mark.parametrize("name", ZOO)
def test_the_border_is_what_has_no_line(name: str) -> None:
    survey = zoo.surveyed(name)
    cut = survey.subdivision
    size = np.array([survey.map.width, survey.map.height]) * RESOLUTION
    ends = cut.vertices[cut.edge_vertices]
    low, high = np.isclose(ends, 0, atol=1e-6).all(axis=1), np.isclose(ends, size, atol=1e-6).all(axis=1)
    assert (np.any(low | high, axis=1) == (cut.edge_lines == NONE)).all()
    assert ((cut.edge_faces == NONE).any(axis=1) == (cut.edge_lines == NONE)).all()


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("name", sorted(ZOO.keys() - {"pillars"}))
def test_a_turned_map_has_the_turned_faces(name: str, turn: int) -> None:
    # Slanted lines go on to cross in the margin of a padded map.
    if turn == PADDED and (name in OPEN or name == "turned_warehouse"):
        return
    original, turned = zoo.surveyed(name).subdivision, zoo.surveyed(name, turn).subdivision
    assert len(turned.areas) == len(original.areas)
    assert len(turned.edge_vertices) == len(original.edge_vertices)
    if turn != PADDED:
        moved = zoo.variants(name)[turn].points(original.centres)
        assert zoo.farthest(moved, turned.centres) < 2 * RESOLUTION
        assert np.sort(turned.areas) == pytest.approx(np.sort(original.areas), abs=0.3)


def cut_of(angles_deg: list[float], lines: list[tuple[int, float]]) -> Subdivision:
    """A map of 5 m by 4 m, cut by lines of one's own."""
    map = groundplan.from_array(np.full((80, 100), zoo.FREE, dtype=np.uint8), RESOLUTION)
    directions = Directions.of(np.radians(angles_deg))
    return groundplan.subdivide(map, directions, Lines.of([d for d, _ in lines], [o for _, o in lines]))


def test_no_lines_leave_one_face() -> None:
    cut = cut_of([0.0], [])
    assert (len(cut.areas), cut.areas[0], cut.centres[0].tolist()) == (1, 20.0, [2.5, 2.0])
    assert cut.problems() == []


@pytest.mark.parametrize(("n", "m"), [(1, 0), (1, 1), (2, 3), (6, 5)])
def test_two_families_make_a_grid(n: int, m: int) -> None:
    level = [(0, 0.5 + 0.5 * k) for k in range(n)]
    upright = [(1, 0.7 + 0.6 * k) for k in range(m)]
    cut = cut_of([0.0, -90.0], level + upright)
    assert len(cut.areas) == n * m + n + m + 1
    assert cut.problems() == []


def test_lines_that_miss_the_map_cut_nothing() -> None:
    cut = cut_of([0.0, 45.0], [(0, -1.0), (0, 0.0), (0, 4.0), (0, 99.0), (1, -50.0), (1, 1e12)])
    assert len(cut.areas) == 1
    assert cut.problems() == []


def test_lines_a_micrometre_apart_stay_two() -> None:
    cut = cut_of([0.0], [(0, 2.0), (0, 2.000_001), (0, 2.0)])
    assert len(cut.areas) == 3
    assert cut.problems() == []


def test_two_directions_half_a_degree_apart_hold() -> None:
    lines = [(d, 0.3 * k) for k in range(1, 14) for d in (0, 1)]
    assert cut_of([10.0, 10.5], lines).problems() == []


def test_problems_names_what_is_broken() -> None:
    cut = cut_of([0.0, -90.0], [(0, 2.0), (1, 2.0)])
    broken = Subdivision(**{**vars(cut), "areas": cut.areas * 2})
    assert any("area" in sentence for sentence in broken.problems())
    swapped = Subdivision(**{**vars(cut), "edge_faces": cut.edge_faces[:, ::-1].copy()})
    assert any("side" in sentence for sentence in swapped.problems())
    short = Subdivision(**{**vars(cut), "edge_vertices": cut.edge_vertices[:-1]})
    assert short.problems() != []
