"""Maps of 1 and 2 cm a pixel: what is thinner than the survey's samples are apart bars a way as on any other map."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pytest

import groundplan

SIZE = (26.0, 14.0)  # metres of map
YAW = 5.0  # degrees
WALL, RACK, AISLE = 0.05, 1.2, 3.0  # metres


def hall(resolution: float, wall: float | None = None, yaw: float = 0.0, every: int = 1) -> npt.NDArray[np.uint8]:
    """A hall of 23 m by 10.5 m with two rows of racks of 17 m, turned about the map's middle.

    Across the aisle between them a wall of one pixel may stand so far along; of its pixels one of so many is seen.
    """
    columns, rows = (round(side / resolution) for side in SIZE)
    x, y = np.meshgrid(*((np.arange(count) + 0.5) * resolution for count in (columns, rows)))
    cos, sin = math.cos(math.radians(yaw)), math.sin(math.radians(yaw))
    x, y = x - SIZE[0] / 2, SIZE[1] / 2 - y
    u, v = x * cos + y * sin, y * cos - x * sin
    picture = np.full((rows, columns), 205, np.uint8)
    for left, low, right, high in [
        (-11.5, -5.25, 11.5, 5.25),
        *((-8.5, low, 8.5, low + RACK) for low in (AISLE / 2, -AISLE / 2 - RACK)),
    ]:
        is_rack = right < 11.0
        beyond = [WALL, 0.0] if not is_rack else [0.0, -WALL]
        for more, value in zip(beyond, (0, 205 if is_rack else 254), strict=True):
            inside = (u > left - more) & (u < right + more) & (v > low - more) & (v < high + more)
            picture[inside] = value
    if wall is not None:
        thick = resolution * (abs(cos) + abs(sin)) / 2 + 1e-9
        line = (abs(u - wall) <= thick) & (abs(v) < AISLE / 2)
        picture[line & (np.arange(rows)[:, None] % every == 0)] = 0
    return picture


def along(survey: groundplan.Survey, yaw: float) -> list[list[float]]:
    """From where to where the aisles between the rows go, metres from the hall's middle, in order."""
    cos, sin = math.cos(math.radians(yaw)), math.sin(math.radians(yaw))
    places = []
    for aisle in survey.of_kind("corridor"):
        ends = [(x - SIZE[0] / 2, y - SIZE[1] / 2) for x, y in aisle["axis"]]
        if all(abs(y * cos - x * sin) < 0.5 for x, y in ends):
            places.append(sorted(x * cos + y * sin for x, y in ends))
    return sorted(places)


@pytest.mark.parametrize("yaw", [0.0, YAW])
@pytest.mark.parametrize("resolution", [0.01, 0.015, 0.02, 0.05])
def test_a_wall_one_pixel_thick_ends_the_aisle_that_it_stands_across(resolution: float, yaw: float) -> None:
    ((left, right),) = along(groundplan.survey(hall(resolution, yaw=yaw), resolution=resolution), yaw)
    assert left < -8.0 and right > 8.0
    for wall in (2.0, 2.013, 2.038):
        places = along(groundplan.survey(hall(resolution, wall, yaw), resolution=resolution), yaw)
        assert not [place for place in places if place[0] < wall - 0.3 and place[1] > wall + 0.3]
        assert [place for place in places if place[0] < -8.0]


def test_a_fence_of_which_every_other_pixel_is_seen_does_too() -> None:
    for wall in (2.0, 2.013, 2.038):
        places = along(groundplan.survey(hall(0.01, wall, every=2), resolution=0.01), 0.0)
        assert not [place for place in places if place[0] < wall - 0.3 and place[1] > wall + 0.3]


@pytest.mark.parametrize("resolution", [0.01, 0.02])
def test_single_specks_end_no_aisle(resolution: float) -> None:
    picture = hall(resolution)
    picture[(np.random.default_rng(2).random(picture.shape) < 0.005) & (picture == 254)] = 0
    ((left, right),) = along(groundplan.survey(picture, resolution=resolution), 0.0)
    assert left < -8.0 and right > 8.0


def test_a_thin_wall_that_comes_later_gives_the_survey_of_the_whole_map() -> None:
    before, after = hall(0.02), hall(0.02, 2.013)
    column = round((2.0 + SIZE[0] / 2) / 0.02) - 10
    updated = groundplan.survey(before, resolution=0.02).update(after[:, column : column + 20], 0, column)
    assert updated.to_json() == groundplan.survey(after, resolution=0.02).to_json()


@pytest.mark.parametrize("resolution", [0.01, 0.02, 0.025, 0.05])
def test_a_wall_one_pixel_thick_at_a_corridor_s_end_makes_it_a_dead_end(resolution: float) -> None:
    columns, rows = round(40 / resolution), round(30 / resolution)
    x, y = np.meshgrid(*((np.arange(count) + 0.5) * resolution for count in (columns, rows)))
    picture = np.full((rows, columns), 205, np.uint8)
    for more, value in ((resolution, 0), (0.0, 254)):
        for left, low, right, high in ((2.0, 14.0, 38.0, 16.5), (19.0, 2.0, 21.5, 28.0)):
            picture[(x > left - more) & (x < right + more) & (y > low - more) & (y < high + more)] = value
    survey = groundplan.survey(picture, resolution=resolution)
    assert sorted(label["type"] for label in survey.of_kind("junction")) == ["X", "end", "end", "end", "end"]
