"""II-D: O(face) and O(edge) against plain counting."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import numpy.typing as npt
import pytest
import zoo
from zoo import RESOLUTION, TURNS, ZOO, Canvas

import groundplan
from groundplan import Directions, Lines, Occupancy, Subdivision

PERCENT = {zoo.FREE: 0.0, zoo.UNKNOWN: 0.5, zoo.OCCUPIED: 1.0}


def depth(cut: Subdivision, face: int, points: zoo.Points) -> zoo.Points:
    """How far inside a face points lie, metres; outside is negative."""
    corners = cut.polygon(face)
    sides = np.roll(corners, -1, axis=0) - corners
    lengths = np.hypot(sides[:, 0], sides[:, 1])
    corners, sides, lengths = (array[lengths > 1e-5] for array in (corners, sides, lengths))
    if len(lengths) < 3:
        return np.full(len(points), -np.inf)
    towards = points[:, None, :] - corners[None, :, :]
    return ((sides[:, 0] * towards[:, :, 1] - sides[:, 1] * towards[:, :, 0]) / lengths).min(axis=1)  # type: ignore[no-any-return]


def centres(picture: zoo.Picture) -> tuple[zoo.Points, npt.NDArray[np.uint8]]:
    """The pixels' centres in the map frame, and their values."""
    rows, columns = np.indices(picture.shape)
    x, y = columns + 0.5, len(picture) - rows - 0.5
    return RESOLUTION * np.stack([x.ravel(), y.ravel()], axis=1), picture.ravel()


@pytest.mark.parametrize("name", ZOO)
def test_a_face_holds_what_counting_its_pixels_gives(name: str) -> None:
    survey = zoo.surveyed(name)
    points, values = centres(ZOO[name]())
    percent = np.vectorize(PERCENT.get)(values)
    held = np.zeros(len(points), dtype=int)
    for face in range(len(survey.subdivision.areas)):
        inside = depth(survey.subdivision, face, points)
        # Vertices are rounded to micrometres: a pixel whose centre lies on a line may be on either side.
        surely, maybe = inside > 5e-6, inside > -5e-6
        held += surely
        assert surely.sum() <= survey.occupancy.pixels[face] <= maybe.sum()
        if surely.sum() == maybe.sum() > 0:
            assert survey.occupancy.faces[face] == pytest.approx(percent[surely].mean(), abs=1e-6)
            assert survey.occupancy.unknown[face] == pytest.approx((values[surely] == zoo.UNKNOWN).mean(), abs=1e-6)
            assert survey.occupancy.free[face] == pytest.approx((values[surely] == zoo.FREE).mean(), abs=1e-6)
    assert held.max() <= 1
    assert survey.occupancy.pixels.sum() == values.size


@pytest.mark.parametrize("name", ZOO)
def test_every_pixel_lies_in_one_face(name: str) -> None:
    for turn in TURNS:
        assert zoo.surveyed(name, turn).occupancy.pixels.sum() == zoo.variants(name)[turn].picture.size


def measured(
    picture: zoo.Picture, angles_deg: list[float], lines: list[tuple[int, float]]
) -> tuple[Subdivision, Occupancy]:
    """A map cut by lines of one's own: direction, and offset in pixels."""
    map = groundplan.from_array(picture, RESOLUTION)
    directions = Directions.of(np.radians(angles_deg))
    own = Lines.of([d for d, _ in lines], [RESOLUTION * o for _, o in lines])
    return groundplan.subdivide(map, directions, own), groundplan.find_occupancy(map, directions, own)


def test_a_pixel_on_a_line_belongs_to_the_right_of_it_or_above() -> None:
    picture = Canvas(10, 8, zoo.FREE).box(4, 0, 5, 8).picture
    cut, found = measured(picture, [-90.0], [(0, 4.5)])
    left, right = np.argsort(cut.centres[:, 0])
    assert found.pixels[[left, right]].tolist() == [32, 48]
    assert found.faces[[left, right]] == pytest.approx([0, 8 / 48], abs=1e-6)
    cut, found = measured(picture, [0.0], [(0, 2.5)])
    below, above = np.argsort(cut.centres[:, 1])
    assert found.pixels[[below, above]].tolist() == [20, 60]


def test_a_face_without_pixels_is_what_it_lies_in() -> None:
    picture = Canvas(10, 8, zoo.FREE).box(4, 0, 6, 8).picture
    cut, found = measured(picture, [-90.0], [(0, 4.6), (0, 5.4), (0, 7.6), (0, 8.4)])
    order = np.argsort(cut.centres[:, 0])
    assert found.pixels[order].tolist() == [40, 0, 24, 0, 16]
    assert found.faces[order].tolist() == pytest.approx([0.2, 1.0, 8 / 24, 0.0, 0.0], abs=1e-6)
    assert found.states[order].tolist() == [0, 1, 0, 0, 0]


def test_unknown_counts_a_half_and_is_counted() -> None:
    survey = zoo.surveyed("all_unknown")
    assert survey.occupancy.faces.tolist() == [0.5]
    assert survey.occupancy.unknown.tolist() == [1.0]
    assert survey.occupancy.states.tolist() == [2]
    assert zoo.surveyed("all_occupied").occupancy.states.tolist() == [1]
    assert zoo.surveyed("empty").occupancy.states.tolist() == [0]


def along(cut: Subdivision, found: Occupancy, line: int) -> list[tuple[float, float, float]]:
    """From, to and O of the edges of a line, lowest coordinate first."""
    edges = np.nonzero(cut.edge_lines == line)[0]
    ends = np.sort(cut.vertices[cut.edge_vertices[edges]].sum(axis=2), axis=1)
    return sorted((float(a), float(b), float(o)) for (a, b), o in zip(ends, found.edges[edges], strict=True))


@pytest.mark.parametrize("degrees", [0.0, 17.0, 45.0, -60.0, -90.0])
def test_an_edge_is_occupied_as_far_as_its_wall_goes(degrees: float) -> None:
    angle = np.radians(degrees)
    normal, heading = np.array([-np.sin(angle), np.cos(angle)]), np.array([np.cos(angle), np.sin(angle)])
    middle = np.array([100.0, 100.0])
    start = middle - 60 * heading
    picture = Canvas(200, 200, zoo.FREE).bar((float(start[0]), float(start[1])), degrees, 120, 1.5).picture
    place = float(middle @ heading)
    # Lines across, at the wall's ends and in the middle of it.
    across = [(1, float(sign * (place + s))) for s in (-60, -20, 20, 60) for sign in (crosswise(degrees),)]
    cut, found = measured(picture, [degrees, degrees + 90], [(0, float(middle @ normal)), *across])
    edges = found.edges[cut.edge_lines == 0]
    assert len(edges) == 5
    assert edges[1:4] == pytest.approx(1.0, abs=0.07)
    assert edges[[0, 4]] == pytest.approx(0.0, abs=0.07)


def crosswise(degrees: float) -> float:
    """The sign that the normal of the direction at right angles has along this one."""
    other = Directions.of(np.radians([degrees + 90])).angles[0]
    return float(np.sign(-np.sin(other) * np.cos(np.radians(degrees)) + np.cos(other) * np.sin(np.radians(degrees))))


def test_a_door_is_a_gap_in_its_wall() -> None:
    picture = ZOO["two_rooms_with_door"]()
    cut, found = measured(picture, [-90.0, 0.0], [(0, 80.5), (1, 30.0), (1, 46.0)])
    below, door, above = (o for low, _, o in along(cut, found, 0))
    assert door == pytest.approx(0.0, abs=0.15)
    # Of 30 pixels to the map's border the wall has 20, of 44 above it has 34.
    assert below == pytest.approx(20 / 30, abs=0.07)
    assert above == pytest.approx(34 / 44, abs=0.07)


def test_edges_shorter_than_a_pixel_are_judged_where_they_lie() -> None:
    # The wall ends at x = 40: edges of a third of a pixel on it are full, those beyond are empty.
    picture = Canvas(80, 30, zoo.FREE).box(0, 14, 40, 17).picture
    cuts = [20 + n / 3 for n in range(1, 7)] + [60 + n / 3 for n in range(1, 7)]
    cut, found = measured(picture, [0.0, -90.0], [(0, 15.5), *((1, x) for x in cuts)])
    edges = along(cut, found, 0)
    for (low, high), (_, _, share) in zip(pairwise([0.0, *cuts, 80.0]), edges, strict=True):
        if high <= 38:
            assert share == pytest.approx(1.0, abs=0.06), (low, high)
        if low >= 42:
            assert share == 0.0, (low, high)


@pytest.mark.parametrize("name", ZOO)
def test_the_border_is_not_occupied(name: str) -> None:
    survey = zoo.surveyed(name)
    assert (survey.occupancy.edges[survey.subdivision.edge_lines < 0] == 0).all()
    assert ((survey.occupancy.edges >= 0) & (survey.occupancy.edges <= 1)).all()


@pytest.mark.parametrize("name", ZOO)
def test_an_edge_is_occupied_by_its_runs(name: str) -> None:
    survey = zoo.surveyed(name)
    cut, found = survey.subdivision, survey.occupancy
    lengths = np.hypot(*(cut.vertices[cut.edge_vertices[:, 1]] - cut.vertices[cut.edge_vertices[:, 0]]).T)
    assert len(found.run_offsets) == len(lengths) + 1
    assert found.run_offsets[-1] == len(found.runs)
    for edge, length in enumerate(lengths):
        runs = found.runs[found.run_offsets[edge] : found.run_offsets[edge + 1]]
        assert (np.diff(runs.ravel()) >= 0).all()
        assert ((runs >= 0) & (runs <= length + 1e-5)).all()
        # O(edge) counts whole pixels.
        assert np.diff(runs).sum() == pytest.approx(found.edges[edge] * length, abs=1.01 * RESOLUTION)
