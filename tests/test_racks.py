"""Racks as a person sees them: oblong, of a depth that repeats, with floor before them; and what is none."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from _legs import Box
from _legs import hall as drawn
from zoo import Picture, walled

import groundplan
from groundplan import simulate
from groundplan.evaluate import score


def hall(width: float = 30.0, depth: float = 40.0) -> Picture:
    """A hall with nothing in it, 20 pixels a metre, a metre of unknown round it."""
    return walled(int(20 * width), int(20 * depth))


def put(picture: Picture, x: float, y: float, width: float, depth: float, inside: int = 205) -> None:
    """An outline with its lower corner at (x, y) metres of the floor, and what is seen inside."""
    box = np.s_[int(20 * y) + 20 : int(20 * (y + depth)) + 20, int(20 * x) + 20 : int(20 * (x + width)) + 20]
    picture[box] = 0
    picture[box][2:-2, 2:-2] = inside


def racks(picture: Picture) -> list[dict[str, Any]]:
    return groundplan.survey(picture, resolution=0.05).of_kind("rack")


@pytest.mark.parametrize("aisle", [2.4, 3.2])
def test_what_is_free_between_the_beams_of_a_rack_is_no_way(aisle: float) -> None:
    # Racks of 20 m, 2.2 m deep, of which a lidar sees three beams, 4 m before the walls at their open ends.
    picture = hall(28.0, 4 * aisle + 6.6)
    for row in range(3):
        for beam in (0.0, 1.05, 2.1):
            y = aisle + row * (aisle + 2.2) + beam
            picture[int(20 * y) + 20 : int(20 * (y + 0.1)) + 20, 20 + 80 : 20 + 480] = 0
    survey = groundplan.survey(picture, resolution=0.05)
    widths = sorted(way["width"] for way in survey.of_kind("corridor"))
    assert widths == pytest.approx(sorted([aisle] * 4 + [4.0] * 2), abs=0.25)
    assert sorted(label["type"] for label in survey.of_kind("junction")) == ["L"] * 4 + ["T"] * 4


@pytest.mark.parametrize("short", [3, 4])
def test_what_is_free_between_two_beams_is_no_way_where_the_next_row_ends_before_them(short: int) -> None:
    # By turns two beams 1.3 m apart and a block 2.6 m deep that is shorter, 4 m before the walls.
    def boxes() -> Iterator[Box]:
        for y in (4.0, 16.0):
            yield 4, y, 18, y + 0.1
            yield 4, y + 1.3, 18, y + 1.4
            yield 4, y + 5.4, 18 - short, y + 8.0

    survey = groundplan.survey(drawn(22, 28, boxes()), resolution=0.05)
    assert min(way["width"] for way in survey.of_kind("corridor")) > 3


def test_a_passage_between_two_wider_corridors_is_no_inside_of_a_rack() -> None:
    picture = hall(24.0, 7.6)
    for wall in (3.0, 4.5):
        picture[int(20 * wall) + 20 : int(20 * wall) + 22, 20 + 60 : 20 + 420] = 0
    survey = groundplan.survey(picture, resolution=0.05)
    widths = sorted(way["width"] for way in survey.of_kind("corridor") if way["name"].startswith("A"))
    assert widths == pytest.approx([1.4, 3.0, 3.0], abs=0.2)


@pytest.mark.parametrize("inside", [0, 205])
def test_racks_far_apart_in_a_hall_are_racks_without_an_aisle_between(inside: int) -> None:
    picture = hall()
    for x in (4.0, 14.0, 24.0):
        put(picture, x, 10.0, 1.1, 16.0, inside)
    survey = groundplan.survey(picture, resolution=0.05)
    found = survey.of_kind("rack")
    assert len(found) == 3
    for label in found:
        assert label["width"] == pytest.approx(1.1, abs=0.15) and label["confidence"] >= 0.5
        (_, y0), (_, y1) = label["axis"]
        assert abs(y1 - y0) == pytest.approx(16.0, abs=0.3)
        assert label["faces"]


def test_a_rack_is_the_surer_the_more_others_are_as_deep() -> None:
    picture = hall()
    for x in (3.0, 8.0, 13.0, 18.0):
        put(picture, x, 10.0, 1.1, 16.0, inside=0)
    for x in (22.0, 26.0):
        put(picture, x, 10.0, 1.9, 16.0, inside=0)
    found = racks(picture)
    thin, thick = (
        [rack["confidence"] for rack in found if (rack["width"] > 1.5) is is_thick] for is_thick in (False, True)
    )
    assert len(thin) == 4 and len(thick) == 2
    assert min(thin) > max(thick)


def test_shelves_that_are_seen_through_are_racks() -> None:
    picture = hall()
    for x in (4.0, 16.0):
        for y in (6.0, 9.0, 12.0, 15.0):
            put(picture, x, y, 4.0, 0.55, 254)
    assert len(racks(picture)) == 8


def test_crates_pillars_and_single_blocks_are_no_racks() -> None:
    picture = hall()
    for x in (4.0, 8.0, 12.0, 16.0):
        put(picture, x, 8.0, 1.2, 0.8)
        put(picture, x, 20.0, 0.4, 0.4)
    put(picture, 10.0, 30.0, 8.0, 1.5)
    assert racks(picture) == []


def test_walls_that_end_in_a_room_are_no_racks() -> None:
    picture = hall()
    for y in (8.0, 16.0, 24.0, 32.0):
        put(picture, 0.0, y, 12.0, 0.5)
    assert racks(picture) == []


@pytest.mark.parametrize(
    ("name", "count", "length"), [("isaac_iw_hub_warehouse", 3, 16.4), ("svl_warehouse", 10, 14.6)]
)
def test_the_racks_of_maps_of_others_are_of_one_depth_and_length(
    name: str, count: int, length: float, shared: Path
) -> None:
    found = groundplan.survey(groundplan.read(shared / "maps" / f"{name}.yaml")).of_kind("rack")
    assert len(found) == count
    depths = [label["width"] for label in found]
    assert max(depths) - min(depths) < 0.2
    for label in found:
        assert np.hypot(*np.subtract(*label["axis"])) == pytest.approx(length, abs=0.4)


def test_a_rack_at_a_wall_is_like_those_that_stand_free() -> None:
    picture = hall()
    for x in (0.0, 10.0, 20.0):
        put(picture, x, 10.0, 1.1, 16.0, 0)
    assert len(racks(picture)) == 3


SMALL: dict[str, Any] = {"scan_every": 0.6, "beams": 480}


def test_racks_at_the_walls_of_a_simulated_hall_are_found_too() -> None:
    pytest.importorskip("shapely", reason="scores need shapely and scipy")
    made = simulate.warehouse(seed=7, width=26.0, depth=20.0, **SMALL)
    scores = score(groundplan.survey(made.map).to_dict(), made.truth)
    assert scores["rack_recall"] == scores["rack_precision"] == 1.0


def test_the_unknown_between_two_halls_is_no_rack() -> None:
    pytest.importorskip("shapely", reason="scores need shapely and scipy")
    made = simulate.warehouse(seed=204, width=40.0, depth=28.0, halls=3, gap=3.0, crosswise=True, **SMALL)
    assert score(groundplan.survey(made.map).to_dict(), made.truth)["rack_precision"] >= 0.95


@pytest.mark.parametrize("wall", [0.6, 1.0])
def test_walls_that_are_drawn_solid_are_no_racks_be_the_racks_solid_too(wall: float) -> None:
    # Two halls of 27 m by 30 m with a door of a metre between them, as a plan is drawn.
    picture = np.full((int(20 * (32 + 2 * wall)), int(20 * (56 + 3 * wall))), 205, np.uint8)

    def draw(x: float, y: float, width: float, depth: float, value: int) -> None:
        picture[
            round(20 * y) + 20 : round(20 * (y + depth)) + 20, round(20 * x) + 20 : round(20 * (x + width)) + 20
        ] = value

    draw(0.0, 0.0, 54 + 3 * wall, 30 + 2 * wall, 0)
    for left in (wall, 27 + 2 * wall):
        draw(left, wall, 27, 30, 254)
        for row in range(6):
            draw(left + 3.5, wall + 3.5 + 4.4 * row, 20, 1.2, 0)
    draw(27 + wall, 12.4 + wall, wall, 1.0, 254)
    survey = groundplan.survey(picture, resolution=0.05)
    assert sorted(rack["width"] for rack in survey.of_kind("rack")) == pytest.approx([1.2] * 12, abs=0.1)
    assert [len(survey.of_kind(kind)) for kind in ("region", "door")] == [2, 1]


@pytest.mark.parametrize("depth", [0.6, 1.1])
def test_a_rack_along_a_wall_goes_on_to_the_corners_behind_the_ways_that_cross_its_aisle(depth: float) -> None:
    picture = hall(20.0, 6.6 + 2 * depth)
    for y in (0.0, 6.6 + depth):
        put(picture, 0.0, y, 20.0, depth, inside=0)
    for row in range(3):
        put(picture, 3.0, depth + 1.3 + 1.6 * row, 14.0, 0.8, inside=0)
    lengths = sorted(abs(rack["axis"][0][0] - rack["axis"][1][0]) for rack in racks(picture))
    assert lengths == pytest.approx([14.0] * 3 + [20.0] * 2, abs=0.3)


def test_a_row_goes_on_where_one_of_its_aisles_was_not_driven() -> None:
    pytest.importorskip("shapely", reason="scores need shapely and scipy")
    made = simulate.warehouse(seed=114, width=60.0, depth=40.0, partial=0.5, lidar_range=12.0, **SMALL)
    assert score(groundplan.survey(made.map).to_dict(), made.truth)["rack_recall"] >= 0.9


def test_rooms_and_the_unknown_beside_two_ways_that_cross_are_no_racks(shared: Path) -> None:
    survey = groundplan.survey(groundplan.read(shared / "maps" / "halmstad" / "E5_13.yaml"))
    assert len(survey.of_kind("corridor")) == 2 and survey.of_kind("rack") == []


def rows_and_a_wall() -> Picture:
    """Three rows of two racks with a way between the two, and a wall below them with nothing at it yet."""
    picture = hall(40.0, 17.0)
    for y in (4.0, 8.2, 12.4):
        put(picture, 4.0, y, 14.0, 1.2)
        put(picture, 22.0, y, 14.0, 1.2)
    return picture


def at_the_wall(picture: Picture) -> list[list[float]]:
    """From where to where the racks at that wall stand, metres of the floor."""
    top = picture.shape[0] / 20 - 1.0
    low = [rack for rack in racks(picture) if top - rack["axis"][0][1] < 1.2]
    return sorted(sorted(x - 1.0 for x, _ in rack["axis"]) for rack in low)


@pytest.mark.parametrize("inside", [0, 205, 254])
def test_racks_at_a_wall_end_where_the_ways_past_them_lead_on_to_it(inside: int) -> None:
    picture = rows_and_a_wall()
    put(picture, 4.0, 0.0, 14.0, 1.0, inside)
    put(picture, 22.0, 0.0, 14.0, 1.0, inside)
    assert np.array(at_the_wall(picture)) == pytest.approx(np.array([[4.0, 18.0], [22.0, 36.0]]), abs=0.3)


def test_empty_bays_of_a_rack_at_a_wall_part_it_nowhere_be_two_of_them_before_a_way() -> None:
    picture = rows_and_a_wall()
    for bay in {0, 1, 3, 4, 7, 8, 10, 11}:
        put(picture, 4.0 + 2.7 * bay, 0.0, 2.6, 1.0, inside=0)
    assert np.array(at_the_wall(picture)) == pytest.approx(np.array([[4.0, 36.3]]), abs=0.3)


@pytest.mark.parametrize("depth", [2.2, 4.4])
def test_two_rows_along_which_bays_recur_are_racks(depth: float) -> None:
    draws = np.random.default_rng(3)

    def boxes() -> Iterator[Box]:
        for y in (3.2, 6.4 + depth):
            posts = (4.0 + 2.8 * n for n in range(13))
            yield from ((x, low, x + 0.1, low + 0.1) for x in posts for low in np.linspace(y, y + depth - 0.1, 3))
            places = (4.15 + 2.8 * n + 0.87 * m for n in range(12) for m in range(3))
            yield from ((x, y, x + 0.8, y + depth) for x in places if draws.random() > 0.1)

    survey = groundplan.survey(drawn(41.7, 9.6 + 2 * depth, boxes()), resolution=0.05)
    assert [rack["width"] for rack in survey.of_kind("rack")] == pytest.approx([depth] * 2, abs=0.2)


def stacks(depth: float, empty: float) -> Picture:
    """Three rows of pallets, two one behind another, with a way of 3.2 m through their middles."""
    draws = np.random.default_rng(3)

    def boxes() -> Iterator[Box]:
        for y in (3.2 + n * (3.2 + depth) for n in range(3)):
            for x in (4.0 + 1.2 * n + (3.2 if n >= 12 else 0.0) for n in range(24)):
                for low in (y, y + depth / 2):
                    if draws.random() > empty:
                        yield x + 0.05, low, x + 1.15, low + depth / 2 - 0.1

    return drawn(40.0, 12.8 + 3 * depth, boxes())


@pytest.mark.parametrize("depth", [3.0, 4.0, 4.4, 5.2])
@pytest.mark.parametrize("empty", [0.1, 0.25])
def test_racks_may_be_as_deep_as_rooms(depth: float, empty: float) -> None:
    survey = groundplan.survey(stacks(depth, empty), resolution=0.05)
    assert [rack["width"] for rack in survey.of_kind("rack")] == pytest.approx([depth - 0.1] * 6, abs=0.2)
    kinds = sorted(label["type"] for label in survey.of_kind("junction"))
    assert kinds == ["L"] * 4 + ["T"] * 6 + ["X"] * 2


@pytest.mark.parametrize("depth", [4.0, 5.2])
def test_mirrored_racks_as_deep_as_rooms_are_as_many_and_as_long(depth: float) -> None:
    def lengths(picture: Picture) -> list[float]:
        survey = groundplan.survey(np.ascontiguousarray(picture), resolution=0.05)
        return sorted(float(np.hypot(*np.subtract(*rack["axis"]))) for rack in survey.of_kind("rack"))

    picture = stacks(depth, 0.25)
    for mirrored in (picture[::-1], picture[:, ::-1]):
        assert lengths(mirrored) == pytest.approx(lengths(picture), abs=0.25)


@pytest.mark.parametrize("depth", [4.0, 4.8, 5.6])
def test_two_racks_are_two_though_nobody_saw_the_aisle_between_them(depth: float) -> None:
    deep = depth / 2 - 0.75
    picture = hall(38.0, 15.6 + 4 * depth)
    for y in (3.0 + n * (3.2 + depth) for n in range(4)):
        put(picture, 4.0, y, 30.0, depth, inside=205)
        picture[int(20 * (y + deep)) + 20 : int(20 * (y + deep + 1.5)) + 20, 100:700] = 205
        for low in (y, y + deep + 1.5):
            put(picture, 4.0, low, 30.0, deep, inside=0)
    assert [rack["width"] for rack in racks(picture)] == pytest.approx([deep] * 8, abs=0.15)


@pytest.mark.parametrize("share", [0.3, 0.5, 0.65])
def test_no_rack_is_laid_over_an_aisle_between_two_in_which_goods_stand(share: float) -> None:
    draws = np.random.default_rng(2)

    def boxes() -> Iterator[Box]:
        for low in (3.0, 10.1, 17.2):
            for y in (low, low + 2.7):
                yield from ((4.0 + 2.7 * n, leg, 4.1 + 2.7 * n, leg + 0.1) for n in range(13) for leg in (y, y + 1.3))
                goods = (4.2 + 2.7 * n + 0.8 * m for n in range(12) for m in range(3) if draws.random() > 0.1)
                yield from ((x, y + draws.uniform(0, 0.1), x + 0.7, y + 1.4 - draws.uniform(0, 0.1)) for x in goods)
            length = 32.4 * share / 2
            yield 8.9, low + 1.3, 8.9 + length, low + 2.8
            yield 36.4 - length, low + 1.3, 36.4, low + 2.8

    found = racks(drawn(40.4, 24.3, boxes()))
    assert len(found) >= 6 and all(rack["width"] < 1.6 for rack in found)


def test_furnished_rooms_between_thick_walls_are_no_racks_where_pixels_are_coarse() -> None:
    """Three rows of five rooms of 5.6 m by 4 m, each with two desks and a door, between walls of 0.5 m."""
    picture = np.full((260, 400), 205, np.uint8)
    picture[19:-19, 19:-19] = 0
    picture[20:-20, 20:-20] = 254
    for low in (40 + 60 * row for row in range(3)):
        for left in (40 + 56 * n for n in range(6)):
            picture[low : low + 40, left : left + 5] = 0
        for n, left in enumerate(40 + 56 * n for n in range(5)):
            picture[[low, low + 1, low + 38, low + 39], left : left + 56] = 0
            door = low if n % 2 else low + 38
            picture[door : door + 2, left + 15 : left + 24] = 254
            picture[low + 10 : low + 18, left + 8 : left + 50] = 0
            picture[low + 24 : low + 32, left + 8 : left + 50] = 0
    survey = groundplan.survey(picture, resolution=0.1)
    assert not survey.of_kind("rack") and len(survey.of_kind("door")) == 15


@pytest.mark.parametrize("deep", [3.8, 4.6, 5.4])
def test_furnished_rooms_between_two_corridors_are_no_racks_be_they_so_deep(deep: float) -> None:
    """Four corridors with three rows of eight rooms between them, each with two desks and a door."""
    picture = hall(34.0, 8.0 + 3 * deep)
    for low in (2.0 + n * (2.0 + deep) for n in range(3)):
        for n in range(8):
            x = 1.0 + 4.0 * n
            put(picture, x, low, 4.1, deep, inside=254)
            door = low if n % 2 else low + deep - 0.1
            for at, width, height in ((door, 0.9, 0.1), (low + 0.6, 1.6, 0.8), (low + deep - 1.6, 1.2, 0.8)):
                value = 254 if at == door else 0
                picture[int(20 * at) + 20 : int(20 * (at + height)) + 20, int(20 * x) + 40 :][:, : int(20 * width)] = (
                    value
                )
    assert racks(picture) == []
