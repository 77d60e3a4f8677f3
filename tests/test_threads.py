"""Any number of threads gives the same bytes."""

from __future__ import annotations

import numpy as np
import pytest
import zoo
from zoo import RESOLUTION, ZOO

import groundplan


def tall() -> zoo.Picture:
    """Many row bands: the warehouse four times over, the last with noise."""
    one = ZOO["turned_warehouse"]()
    noisy = one.copy()
    noisy[np.random.default_rng(7).random(one.shape) < 0.05] = zoo.OCCUPIED
    return np.concatenate([one, noisy, np.rot90(one, 2), one])


@pytest.mark.parametrize("name", [*ZOO, "tall"])
def test_a_survey_is_the_same_with_one_two_and_four_threads(name: str) -> None:
    picture = tall() if name == "tall" else ZOO[name]()
    one, *others = (groundplan.survey(picture, resolution=RESOLUTION, threads=n).to_json() for n in (1, 2, 4, 64))
    assert all(other == one for other in others)


def test_stages_are_the_same_with_one_and_four_threads() -> None:
    # As many as four threads have pixels enough for.
    map = groundplan.from_array(np.ascontiguousarray(np.tile(tall(), (3, 2))), RESOLUTION)
    assert map.width * map.height >= 4 << 18
    gradients = groundplan.find_gradients(map, threads=1)
    assert groundplan.find_gradients(map, threads=4) == gradients
    directions = groundplan.find_directions(map, gradients, threads=1)
    assert groundplan.find_directions(map, gradients, threads=4) == directions
    radiograms = groundplan.find_radiograms(map, directions, gradients, threads=1)
    assert groundplan.find_radiograms(map, directions, gradients, threads=4) == radiograms
    lines = groundplan.find_lines(radiograms)
    one, four = (groundplan.find_occupancy(map, directions, lines, gradients, threads=n) for n in (1, 4))
    assert one == four
    labelled = (groundplan.survey(map, threads=n).to_json() for n in (1, 4))
    assert len(set(labelled)) == 1


def test_more_edge_pixels_than_one_thread_projects_at_a_time_give_the_same_directions() -> None:
    picture = np.full((1600, 1600), zoo.FREE, dtype=np.uint8)
    picture[::20] = zoo.OCCUPIED
    picture[:, ::25] = zoo.OCCUPIED
    map = groundplan.from_array(picture, RESOLUTION)
    gradients = groundplan.find_gradients(map)
    one, four = (groundplan.find_directions(map, gradients, threads=n) for n in (1, 4))
    assert one == four
    assert len(one) == 2


@pytest.mark.parametrize("angles", [[0.1, -1.4], [0.1, -1.4, 0.9]])
def test_more_faces_than_one_thread_makes_at_a_time_are_the_same(angles: list[float]) -> None:
    map = groundplan.from_array(np.full((900, 700), zoo.FREE, dtype=np.uint8), RESOLUTION)
    offsets = np.sort(np.random.default_rng(3).uniform(-50, 50, 800))
    directions = groundplan.Directions.of(np.array(angles))
    lines = groundplan.Lines.of(np.repeat(np.arange(len(angles)), 800), np.tile(offsets, len(angles)))
    one, four = (groundplan.subdivide(map, directions, lines, threads=n) for n in (1, 4))
    assert len(one.areas) > 2 << 14
    assert one == four


def test_the_same_map_twice_is_the_same_survey() -> None:
    one, two = (groundplan.survey(tall(), resolution=RESOLUTION).to_json() for _ in range(2))
    assert one == two
