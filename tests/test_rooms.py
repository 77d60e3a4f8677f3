"""Regions and doors, as statements about maps."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import zoo
from zoo import FREE, OCCUPIED, RESOLUTION, UNKNOWN, ZOO, Canvas, Picture

import groundplan
from groundplan import Survey


def survey(picture: Picture, **parameters: Any) -> Survey:
    return groundplan.survey(picture, resolution=RESOLUTION, **parameters)


def two_rooms(door: int = 18) -> Canvas:
    """Two rooms of 4.8 by 4.4 m, and a door of so many pixels in the wall between them."""
    plan = Canvas(220, 110).room(10, 10, 110, 104).room(107, 10, 207, 104)
    return plan.box(107, 30, 110, 30 + door, FREE)


def drawn(found: Survey, shape: tuple[int, int]) -> np.ndarray:
    """How many regions hold each pixel's centre, top row first (even-odd, holes taken out)."""
    y, x = np.mgrid[: shape[0], : shape[1]]
    px, py = (x + 0.5) * RESOLUTION, (shape[0] - y - 0.5) * RESOLUTION
    count = np.zeros(shape, dtype=np.int64)
    for region in found.of_kind("region"):
        inside = np.zeros(shape, dtype=bool)
        for ring in (region["polygon"], *region["holes"]):
            for (x0, y0), (x1, y1) in zip(ring, [*ring[1:], ring[0]], strict=True):
                if y0 != y1:
                    crosses = (py < y0) != (py < y1)
                    inside ^= crosses & (px < x0 + (py - y0) * (x1 - x0) / (y1 - y0))
        count += inside
    return count


def area(ring: list[list[float]]) -> float:
    x, y = np.array(ring).T
    return float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum() / 2)


def is_simple(ring: list[list[float]]) -> bool:
    """No two sides of the ring meet but neighbours in their corner."""
    points = np.array(ring)
    p, q = points, np.roll(points, -1, axis=0)

    def side(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> Any:
        return np.sign(
            np.round((b[..., 0] - a[..., 0]) * (c[..., 1] - a[..., 1]), 9)
            - np.round((b[..., 1] - a[..., 1]) * (c[..., 0] - a[..., 0]), 9)
        )

    a, b, c, d = p[:, None], q[:, None], p[None], q[None]
    crossing = (side(a, b, c) * side(a, b, d) < 0) & (side(c, d, a) * side(c, d, b) < 0)
    return not bool(crossing.any()) and len(np.unique(points, axis=0)) == len(points)


def test_two_rooms_with_a_door_are_two_regions_that_it_joins() -> None:
    found = survey(two_rooms(18).picture)
    rooms, doors = found.of_kind("region"), found.of_kind("door")
    assert [(room["name"], room["use"]) for room in rooms] == [("R1-01", "room"), ("R1-02", "room")]
    assert [room["area"] for room in rooms] == pytest.approx([94 * 88 / 400, 94 * 88 / 400], rel=0.02)
    (door,) = doors
    assert door["width"] == pytest.approx(18 * RESOLUTION, abs=0.06)
    assert door["at"] == pytest.approx([108.5 * RESOLUTION, 39 * RESOLUTION], abs=0.16)
    assert [found.labels[n]["name"] for n in door["between"]] == ["R1-01", "R1-02"]


@pytest.mark.parametrize("degrees", [0, 12, 31, 45, 77])
def test_a_turned_map_has_the_same_rooms_and_doors(degrees: float) -> None:
    plan = Canvas(260, 260).turn(degrees).room(30, 70, 130, 164).room(127, 70, 227, 164)
    found = survey(plan.box(127, 95, 130, 113, FREE).picture)
    assert [room["area"] for room in found.of_kind("region")] == pytest.approx([94 * 88 / 400] * 2, rel=0.04)
    assert [door["width"] for door in found.of_kind("door")] == pytest.approx([0.9], abs=0.12)


def test_furniture_splits_no_room() -> None:
    plan = two_rooms()
    for x in range(30, 90, 15):
        for y in (40, 60):
            plan.box(x, y, x + 3, y + 3)
    plan.box(90, 85, 107, 101, UNKNOWN).box(130, 50, 150, 62).box(160, 13, 180, 24)
    found = survey(plan.picture)
    assert len(found.of_kind("region")) == 2
    assert len(found.of_kind("door")) == 1


@pytest.mark.parametrize("turn", [0, 20])
@pytest.mark.parametrize("hinge", [112, 128])
def test_the_leaf_of_a_door_that_stands_open_parts_no_room(hinge: int, turn: float) -> None:
    """It is as long as the doorway is wide, and beyond its tip 2 m of the room are open."""
    plan = Canvas(280, 260).turn(turn).room(40, 40, 140, 200).room(137, 40, 201, 200).box(137, 111, 140, 129, FREE)
    found = survey(plan.box(140, hinge - 1, 158, hinge + 1).picture)
    assert len(found.of_kind("region")) == 2
    assert len(found.of_kind("door")) == 1


def test_a_corridor_and_its_rooms() -> None:
    found = zoo.surveyed("rows_of_offices")
    uses = [region["use"] for region in found.of_kind("region")]
    assert uses == ["room"] * 3 + ["corridor"] + ["room"] * 3
    corridor = next(n for n, label in enumerate(found.labels) if label.get("use") == "corridor")
    assert len(found.of_kind("door")) == 6
    assert all(corridor in door["between"] for door in found.of_kind("door"))


@pytest.mark.parametrize("name", ["crossing", "t_junction", "l_corridor", "pillars", "single_room"])
def test_ways_that_open_into_one_another_are_one_region(name: str) -> None:
    found = zoo.surveyed(name)
    assert len(found.of_kind("region")) == 1
    assert found.of_kind("door") == []


@pytest.mark.parametrize("door", [60, 140, 150, 170, 200])
def test_a_door_in_a_wall_before_the_ends_of_racks_is_found(door: int) -> None:
    hall = Canvas(1200, 800).room(38, 38, 1162, 762)
    for low in range(146, 706, 70):
        hall.box(120, low, 520, low + 44).box(600, low, 1000, low + 44)
    hall.box(1040, 38, 1044, 240).box(1040, 236, 1162, 240)
    found = survey(hall.box(1040, door, 1044, door + 20, FREE).picture)
    (way_in,) = found.of_kind("door")
    assert way_in["width"] == pytest.approx(1.0, abs=0.1)
    assert way_in["at"] == pytest.approx([52.1, (door + 10) * RESOLUTION], abs=0.2)


@pytest.mark.parametrize("wall", [1, 3, 6])
def test_doors_in_a_thin_wall_along_an_aisle_are_found(wall: int) -> None:
    hall = Canvas(960, 680).room(40, 40, 920, 640).box(40, 480, 920, 480 + wall)
    for x in (260, 480, 700):
        hall.box(x, 480, x + 2, 640)
    for low in (392, 304, 216):
        hall.box(110, low, 850, low + 28)
    for x in (140, 360, 580, 800):
        hall.box(x, 480, x + 18, 480 + wall, FREE)
    found = survey(hall.picture)
    assert len(found.of_kind("rack")) == 3 and len(found.of_kind("region")) == 5
    assert [door["width"] for door in found.of_kind("door")] == pytest.approx([0.9] * 4, abs=0.06)


def test_the_widest_opening_and_the_least_room_can_be_set() -> None:
    assert len(survey(two_rooms(40).picture).of_kind("region")) == 2
    assert len(survey(two_rooms(40).picture, rooms_openness=0.4).of_kind("region")) == 1
    assert len(survey(two_rooms(18).picture, rooms_min_area=30.0).of_kind("region")) == 1


@pytest.mark.parametrize("turn", zoo.TURNS)
@pytest.mark.parametrize("name", ZOO)
def test_regions_hold_the_free_space_and_do_not_overlap(name: str, turn: int) -> None:
    picture = zoo.variants(name)[turn].picture
    found = zoo.surveyed(name, turn)
    count = drawn(found, picture.shape)
    assert count.max(initial=0) <= 1
    regions = found.of_kind("region")
    free = picture == FREE
    if regions and name not in {"noise", "double_walls", "one_row"}:
        # The corners of outlines are cut by half a pixel.
        assert (count[free] == 1).mean() > 0.99
    assert sum(region["area"] for region in regions) <= free.sum() * RESOLUTION**2 + 1e-6
    for region in regions:
        assert area(region["polygon"]) > 0 and all(area(hole) < 0 for hole in region["holes"])
        assert all(is_simple(ring) for ring in (region["polygon"], *region["holes"]))
    faces = [face for region in regions for face in region["faces"]]
    assert len(faces) == len(set(faces))
    assert found.problems() == []


@pytest.mark.parametrize("name", ZOO)
def test_a_door_joins_two_regions_and_has_a_width(name: str) -> None:
    found = zoo.surveyed(name)
    for door in found.of_kind("door"):
        assert len(set(door["between"])) == 2
        assert all(found.labels[n]["kind"] == "region" for n in door["between"])
        assert door["width"] == pytest.approx(np.linalg.norm(np.subtract(*door["axis"])), abs=1e-5)


def test_any_grid_has_an_answer() -> None:
    random = np.random.default_rng(7)
    for shape in [(1, 1), (1, 40), (40, 1), (2, 2), (3, 3), (7, 90), (90, 7), (60, 60)]:
        for share in (0.0, 0.3, 0.7, 1.0):
            chance = random.random(shape)
            picture = np.where(chance < share, FREE, np.where(chance < 0.9, OCCUPIED, UNKNOWN)).astype(np.uint8)
            assert survey(picture).problems() == []
            assert drawn(survey(picture), shape).max(initial=0) <= 1


@pytest.mark.parametrize(("jut", "doors"), [(0, 0), (13, 1)])
def test_between_niches_a_corridor_has_no_door_unless_its_walls_jut_out(jut: int, doors: int) -> None:
    plan = Canvas(520, 94).room(10, 20, 510, 70)
    for left, right in ((190, 250), (258, 318)):
        plan.room(left, 8, right, 82).box(left, 20, right, 70, FREE)
    plan.box(250, 8, 258, 23 + jut).box(250, 67 - jut, 258, 82).box(250, 23 + jut, 258, 67 - jut, FREE)
    assert len(survey(plan.picture).of_kind("door")) == doors
