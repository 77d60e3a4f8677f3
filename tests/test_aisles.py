"""What a person calls an aisle and what not, on maps of places that no simulator made up."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import shapely
from _legs import hall as drawn

import groundplan

RESOLUTION = 0.05


def between_machines(gap: int) -> npt.NDArray[np.uint8]:
    """A hall of 30 m by 7 m with four rows of machines of 0.95 m by 0.4 m at any depth, with gaps of so many pixels."""
    draws = np.random.default_rng(5)
    picture = np.full((180, 640), 205, np.uint8)
    picture[18:162, 18:622] = 0
    picture[20:160, 20:620] = 254
    for row in (46, 73, 107, 134):
        for x in range(60, 560, 19 + gap):
            low, high = (row - 4 - int(draws.integers(0, 2)), row + 4 + int(draws.integers(0, 2)))
            picture[low:high, x : x + 19] = 0
            picture[low + 1 : high - 1, x + 1 : x + 18] = 205
    return picture


def cubicles() -> npt.NDArray[np.uint8]:
    """Three ways of 30 m by 1.8 m and two across them; along each, niches of 1.6 m by 1.8 m, opposite one another."""
    picture = np.full((560, 640), 205, np.uint8)
    ways = (80, 270, 460)
    for way in ways:
        for x in range(100, 520, 60):
            picture[way - 38 : way + 74, x - 2 : x + 34] = 0
    for wall in (2, 0):
        value = 0 if wall else 254
        for way in ways:
            picture[way - wall : way + 36 + wall, 20 - wall : 620 + wall] = value
        for x in (22, 580):
            picture[80 - wall : 496 + wall, x - wall : x + 38 + wall] = value
    for way in ways:
        for x in range(100, 520, 60):
            picture[way - 36 : way + 72, x : x + 32] = 254
    return picture


def niches_opposite() -> npt.NDArray[np.uint8]:
    """A way of 24 m by 1.6 m and, half way along it, on either side a niche of 0.9 m by 2.4 m."""
    picture = np.full((180, 520), 205, np.uint8)
    picture[72:108, 18:502] = 0
    picture[24:156, 248:270] = 0
    picture[74:106, 20:500] = 254
    picture[26:154, 250:268] = 254
    return picture


def rooms_in_line() -> npt.NDArray[np.uint8]:
    """Five rooms of 5 m by 6 m, with doors of 1.1 m in line."""
    picture = np.full((160, 560), 205, np.uint8)
    for n in range(5):
        x = 20 + 104 * n
        picture[18:142, x - 2 : x + 104] = 0
        picture[20:140, x : x + 100] = 254
        picture[24:60, x + 2 : x + 30] = 0
        picture[100:136, x + 60 : x + 90] = 0
    for n in range(4):
        picture[69:91, 118 + 104 * n : 126 + 104 * n] = 254
    return picture


def aisle_past_a_hall() -> npt.NDArray[np.uint8]:
    """A way of 14 m, a hall of 6.5 m by 7 m, and the way goes on for 15 m, 0.4 m off its line and a little wider."""
    picture = np.full((180, 760), 205, np.uint8)
    picture[18:162, 298:432] = 0
    picture[58:112, 18:302] = 0
    picture[64:122, 428:742] = 0
    picture[60:110, 20:302] = 254
    picture[66:120, 428:740] = 254
    picture[20:160, 300:430] = 254
    return picture


def past_goods() -> npt.NDArray[np.uint8]:
    """A way of 4.4 m between walls for 11 m that goes on for 20 m, 3 m wide or more, between goods at any depth."""
    draws = np.random.default_rng(3)
    picture = np.full((240, 660), 205, np.uint8)
    picture[74:166, 18:242] = 0
    picture[20:220, 240:640] = 254
    picture[76:164, 20:242] = 254
    for side in (-1, 1):
        x = 272
        while x < 630:
            width = int(draws.integers(14, 30))
            near, far = 120 + side * int(draws.integers(30, 60)), 120 + side * 102
            picture[min(near, far) : max(near, far), x : x + width] = 205
            picture[min(near, far) : max(near, far), [x, min(x + width, 639)]] = 0
            picture[near - 1 : near + 1, x : x + width] = 0
            x += width + int(draws.integers(4, 14))
    return picture


def long_racks() -> npt.NDArray[np.uint8]:
    """A hall of 20 m by 26 m with pillars along its walls every 4 m, and in it three racks of 15 m by 1 m, 7 m apart,
    that end 4 m and 7 m before the walls."""
    picture = np.full((560, 440), 205, np.uint8)
    picture[18:542, 18:422] = 0
    picture[20:540, 20:420] = 254
    for y in range(60, 540, 80):
        for x in (20, 412):
            picture[y : y + 8, x : x + 8] = 0
            picture[y + 1 : y + 7, x + 1 : x + 7] = 205
    for x in (46, 206, 366):
        picture[100:400, x : x + 20] = 0
    return picture


def shelves_at_a_wall(count: int) -> npt.NDArray[np.uint8]:
    """A hall of 14 m by 20 m and at its wall so many shelves of 4 m by 0.9 m, 0.95 m apart."""
    picture = np.full((440, 320), 205, np.uint8)
    picture[18:422, 18:302] = 0
    picture[20:420, 20:300] = 254
    for n in range(count):
        y = 120 + 37 * n
        picture[y : y + 18, 216:296] = 0
    return picture


def docks() -> npt.NDArray[np.uint8]:
    """A hall of 22 m by 12 m with docks of 4.3 m at one side, walls of 2.2 m between them, and pallets before them."""
    picture = np.full((280, 480), 205, np.uint8)
    picture[18:262, 18:462] = 0
    picture[20:260, 20:460] = 254
    for x in range(106, 450, 88):
        picture[216:260, x : x + 3] = 0
    for x in (110, 170, 330, 380):
        picture[140:176, x : x + 36] = 0
        picture[142:174, x + 2 : x + 34] = 205
    return picture


def open_end(cross: int, length: int = 180) -> npt.NDArray[np.uint8]:
    """A hall of three aisles of 2.5 m between rows of racks, which open into a way so many pixels wide."""
    picture = np.full((270, 40 + length + cross), 205, np.uint8)
    picture[18:252, 18 : 22 + length + cross] = 0
    picture[20:250, 20 : 20 + length + cross] = 254
    for row in (70, 160):
        picture[row : row + 40, 20 : 20 + length] = 0
        picture[row + 2 : row + 38, 22 : 18 + length] = 205
    return picture


def coarse() -> npt.NDArray[np.uint8]:
    """A hall of 25 m by 13 m, 0.1 m a pixel: four aisles of 1.9 m between solid rows, a way of 4.3 m at either end."""
    picture = np.full((172, 290), 205, np.uint8)
    picture[18:154, 18:272] = 0
    picture[20:152, 20:270] = 254
    for row, deep in ((20, 7), (46, 14), (79, 14), (112, 14), (145, 7)):
        picture[row : row + deep, 63:227] = 0
    return picture


def racks_in_the_open() -> npt.NDArray[np.uint8]:
    """A hall of 30 m by 40 m with three racks of 18 m along its left wall, and beyond their ends eight of 4 m across,
    in two columns of which the first stands 8 m off that wall."""
    picture = np.full((840, 640), 205, np.uint8)
    picture[18:822, 18:622] = 0
    picture[20:820, 20:620] = 254
    for x in (104, 224, 344):
        picture[410:770, x : x + 40] = 0
    for y in (160, 220, 280, 340):
        for x in (184, 384):
            picture[y : y + 12, x : x + 76] = 0
    return picture


@pytest.mark.parametrize("gap", [8, 14])
def test_ways_between_rows_of_machines_and_past_their_ends_are_aisles(gap: int) -> None:
    survey = groundplan.survey(between_machines(gap), resolution=RESOLUTION)
    lengths = [np.hypot(*np.subtract(*aisle["axis"])) for aisle in survey.of_kind("corridor")]
    assert sorted(length >= 20.0 for length in lengths) == [False] * 2 + [True] * 5
    # Though narrow ones are hardly further apart than two crossings that are one.
    assert sorted(label["type"] for label in survey.of_kind("junction")) == ["L"] * 4 + ["T"] * 6


def test_niches_along_a_way_are_no_aisles_and_what_lies_between_is_no_rack() -> None:
    survey = groundplan.survey(cubicles(), resolution=RESOLUTION)
    assert len(survey.of_kind("corridor")) == 5 and not survey.of_kind("rack")
    assert {label["type"] for label in survey.of_kind("junction")} == {"L", "T"}


def test_two_niches_that_face_each_other_make_no_aisle_across_the_way_between_them() -> None:
    (way,) = groundplan.survey(niches_opposite(), resolution=RESOLUTION).of_kind("corridor")
    assert np.hypot(*np.subtract(*way["axis"])) == pytest.approx(24.0, abs=0.5)


def test_rooms_with_doors_in_line_are_no_aisle() -> None:
    assert not groundplan.survey(rooms_in_line(), resolution=RESOLUTION).of_kind("corridor")


def test_an_aisle_that_goes_on_past_a_hall_is_one_aisle() -> None:
    (aisle,) = groundplan.survey(aisle_past_a_hall(), resolution=RESOLUTION).of_kind("corridor")
    assert np.hypot(*np.subtract(*aisle["axis"])) == pytest.approx(36.0, abs=0.5)


def test_wide_aisles_end_with_their_racks_where_pillars_at_the_walls_recur() -> None:
    wide = [
        aisle
        for aisle in groundplan.survey(long_racks(), resolution=RESOLUTION).of_kind("corridor")
        if aisle["width"] > 6.0
    ]
    assert len(wide) == 2
    for aisle in wide:
        assert sorted(end[1] for end in aisle["axis"]) == pytest.approx([8.0, 23.0], abs=0.3)


def beside_a_way(width: float, length: float) -> npt.NDArray[np.uint8]:
    """A way of 30 m by 3 m, and what opens into it and is shut at its end."""
    blocks = [(0, 0, 32, 4), (0, 4, 1, 7), (31, 4, 32, 7), (0, 7, 14, 16), (14 + width, 7, 32, 16)]
    return drawn(32.0, 16.0, iter([*blocks, (14, 7 + length, 14 + width, 16)]))


@pytest.mark.parametrize(("width", "length"), [(3.0, 5.4), (2.6, 4.6)])
def test_a_dead_end_as_wide_as_the_way_that_it_opens_into_is_an_aisle_though_it_is_short(
    width: float, length: float
) -> None:
    survey = groundplan.survey(beside_a_way(width, length), resolution=RESOLUTION)
    assert sorted(junction["type"] for junction in survey.of_kind("junction")) == ["T", "end", "end", "end"]


@pytest.mark.parametrize(("width", "length"), [(3.0, 3.6), (1.5, 3.2)])
def test_what_is_as_short_and_narrow_as_a_room_is_none(width: float, length: float) -> None:
    survey = groundplan.survey(beside_a_way(width, length), resolution=RESOLUTION)
    assert sorted(junction["type"] for junction in survey.of_kind("junction")) == ["end", "end"]


@pytest.mark.parametrize(("slot", "are_aisles"), [(0.85, False), (1.05, False), (1.3, True), (1.8, True)])
def test_slots_between_machines_are_no_aisles_where_they_are_narrower_than_corridors(
    slot: float, are_aisles: bool
) -> None:
    lefts = [3.0, 7.0 + slot, 13.0 + 2 * slot, 18.0 + 3 * slot]
    blocks = [(x, 3.0, x + width, 12.0) for x, width in zip(lefts, (4.0, 6.0, 5.0, 8.0), strict=True)]
    survey = groundplan.survey(drawn(29.0 + 3 * slot, 15.0, iter(blocks)), resolution=RESOLUTION)
    assert any(aisle["width"] < 2.0 for aisle in survey.of_kind("corridor")) == are_aisles


def test_slots_that_meet_others_alone_are_none_either() -> None:
    # From an aisle of 3 m a slot of 1.1 m leads on between blocks, and from that one of 0.5 m.
    blocks = [(3.0, 3.0, 14.0, 23.0), (15.1, 3.0, 30.0, 12.0), (15.1, 12.5, 30.0, 23.0)]
    survey = groundplan.survey(drawn(33.0, 26.0, iter(blocks)), resolution=RESOLUTION, labels_min_width=0.4)
    assert all(aisle["width"] > 2.5 for aisle in survey.of_kind("corridor"))


def test_a_narrow_aisle_along_a_rack_is_no_slot() -> None:
    bays = [(3.0 + 2.7 * n, y, 5.6 + 2.7 * n, y + 1.1) for n in range(9) for y in (3.0, 5.2, 9.0) if n not in (3, 7)]
    survey = groundplan.survey(drawn(30.3, 13.1, iter(bays)), resolution=RESOLUTION)
    assert min(aisle["width"] for aisle in survey.of_kind("corridor")) == pytest.approx(1.1, abs=0.15)


@pytest.mark.parametrize(("shelves", "aisles"), [(2, 0), (6, 5)])
def test_short_ways_into_a_hall_are_aisles_where_several_lie_side_by_side(shelves: int, aisles: int) -> None:
    survey = groundplan.survey(shelves_at_a_wall(shelves), resolution=RESOLUTION)
    assert len(survey.of_kind("corridor")) == aisles


def test_no_aisle_leads_along_docks_through_the_walls_between_them() -> None:
    aisles = groundplan.survey(docks(), resolution=RESOLUTION).of_kind("corridor")
    walls = [shapely.box(x, 1.5, x + 0.15, 2.5) for x in np.arange(5.3, 22.0, 4.4)]
    assert not any(shapely.Polygon(aisle["polygon"]).intersects(wall) for aisle in aisles for wall in walls)


@pytest.mark.parametrize("length", [120, 180])
@pytest.mark.parametrize("cross", [60, 80, 100, 120])
def test_aisles_side_by_side_tell_the_way_that_they_open_into_be_it_as_wide_as_they_are_long(
    cross: int, length: int
) -> None:
    survey = groundplan.survey(open_end(cross, length), resolution=RESOLUTION)
    widths = sorted(label["width"] for label in survey.of_kind("corridor"))
    assert widths == pytest.approx([2.5, 2.5, 2.5, cross * RESOLUTION], abs=0.15)
    crossings = [junction["type"] for junction in survey.of_kind("junction")]
    assert sorted(crossings) == ["L", "L", "T", "end", "end", "end"]


def test_ends_of_rows_that_a_coarse_map_has_few_pixels_of_make_the_ways_before_them() -> None:
    survey = groundplan.survey(coarse(), resolution=0.1)
    widths = sorted(label["width"] for label in survey.of_kind("corridor"))
    assert widths == pytest.approx([1.9] * 4 + [4.3] * 2, abs=0.25)
    assert sorted(junction["type"] for junction in survey.of_kind("junction")) == ["L"] * 4 + ["T"] * 4


def test_ways_between_racks_in_the_open_end_with_them_and_not_at_a_wall_far_off() -> None:
    aisles = groundplan.survey(racks_in_the_open(), resolution=RESOLUTION).of_kind("corridor")
    north = [aisle for aisle in aisles if min(end[1] for end in aisle["axis"]) > 24.0]
    assert len(north) == 3
    assert all(min(end[0] for end in aisle["axis"]) > 8.0 for aisle in north)


def test_an_aisle_between_walls_that_goes_on_between_goods_is_one_aisle() -> None:
    (aisle,) = groundplan.survey(past_goods(), resolution=RESOLUTION).of_kind("corridor")
    assert np.hypot(*np.subtract(*aisle["axis"])) == pytest.approx(31.0, abs=0.6)


def test_an_aisle_beyond_a_crossing_is_one_though_half_of_its_wall_was_seen(shared: Path) -> None:
    survey = groundplan.survey(groundplan.read(shared / "maps" / "radish_intel_jones_farms.yaml"))
    crossings = [label["at"] for label in survey.of_kind("junction") if label["type"] == "X"]
    assert min(np.hypot(*np.subtract(at, (23.9, 33.4))) for at in crossings) < 0.5


def between_racks(aisle: dict[str, Any]) -> bool:
    (x, low), (_, high) = sorted(aisle["axis"], key=lambda end: float(end[1]))
    return bool(abs(x) < 5 and low < -15 < high)


def test_aisles_are_not_led_on_through_the_rows_that_stand_beyond_their_ends(shared: Path) -> None:
    survey = groundplan.survey(groundplan.read(shared / "maps" / "tugbot_warehouse_shelves.yaml"))
    ends = [sorted(end[1] for end in aisle["axis"]) for aisle in survey.of_kind("corridor") if between_racks(aisle)]
    assert len(ends) == 2 and all(end == pytest.approx(-2.4, abs=0.5) for _, end in ends)


def between_rays(share: float) -> npt.NDArray[np.uint8]:
    """A way of 12 m by 2 m between walls at 1 cm a pixel, of whose floor no more than that share was hit by rays."""
    picture = np.full((260, 1260), 205, np.uint8)
    picture[24:236, 30:1230] = 0
    picture[30:230, 30:1230] = np.where(np.random.default_rng(1).random((200, 1200)) < share, 254, 205)
    return picture


@pytest.mark.parametrize("share", [0.3, 0.5])
def test_the_floor_between_rays_is_floor_where_pixels_are_finer_than_they_are_dense(share: float) -> None:
    (aisle,) = groundplan.survey(between_rays(share), resolution=0.01).of_kind("corridor")
    assert np.hypot(*np.subtract(*aisle["axis"])) == pytest.approx(12.0, abs=0.3)
    assert aisle["width"] == pytest.approx(2.0, abs=0.15)


def test_aisles_open_into_the_main_aisle_though_the_wall_at_its_end_is_askew(shared: Path) -> None:
    survey = groundplan.survey(groundplan.read(shared / "maps" / "aws_small_warehouse.yaml"))
    (main,) = (label for label in survey.of_kind("corridor") if label["width"] > 2.0)
    assert abs(np.subtract(*main["axis"])[0]) > 15.0
    types = sorted(label["type"] for label in survey.of_kind("junction") if label["type"] != "end")
    assert types == ["L"] + ["T"] * 5


def test_what_lies_beside_an_aisle_nearly_along_it_does_not_cross_it(shared: Path) -> None:
    survey = groundplan.survey(groundplan.read(shared / "maps" / "rbk_warehouse.yaml"))
    ways = [np.subtract(*label["axis"]) for label in survey.of_kind("corridor")]
    cosines = [abs(one @ two) / np.hypot(*one) / np.hypot(*two) for one in ways for two in ways if one is not two]
    assert all(cosine < 0.5 or cosine > 0.999 for cosine in cosines)


@pytest.mark.parametrize(
    ("name", "aisles", "racks"),
    [("radish_intel_jones_farms", 7, 0), ("textile_factory", 7, 5), ("aws_small_warehouse", 7, 6)],
)
def test_real_sites_have_the_aisles_that_a_person_counts(name: str, aisles: int, racks: int, shared: Path) -> None:
    survey = groundplan.survey(groundplan.read(shared / "maps" / f"{name}.yaml"))
    assert len(survey.of_kind("corridor")) == aisles
    assert len(survey.of_kind("rack")) == racks


def test_aisles_lead_between_racks_of_which_no_more_than_posts_and_the_unknown_shows() -> None:
    # Three racks of 42 m by 2.2 m with aisles of 3 m beside them; floor shows to 0.1 m behind their posts, 3 m apart.
    picture = np.full((374, 1040), 205, np.uint8)
    picture[18:356, 18:1022] = 0
    picture[20:354, 20:1020] = 254
    for low in (78, 178, 278):
        picture[low + 3 : low + 41, 103:937] = 205
        for x in range(100, 941, 60):
            for face in (low, low + 41):
                picture[face : face + 3, x - 1 : x + 2] = 0
    junctions = groundplan.survey(picture, resolution=RESOLUTION).of_kind("junction")
    assert sorted(junction["type"] for junction in junctions) == ["L"] * 4 + ["T"] * 4


def drums_on_both_sides_of_a_mesh(gaps: float) -> npt.NDArray[np.uint8]:
    """Three rows of drums 0.75 m wide, two side by side with a mesh between, of which a share was not hit."""
    draws = np.random.default_rng(0)
    width, rows, deep, aisle, cross = 600, 3, 56, 60, 72
    picture = np.full((rows * deep + (rows + 1) * aisle + 40, width + 2 * cross + 40), 205, np.uint8)
    picture[18:-18, 18:-18] = 0
    picture[20:-20, 20:-20] = 254
    y, x = np.mgrid[: picture.shape[0], : picture.shape[1]]
    for low in (20 + aisle + row * (aisle + deep) for row in range(rows)):
        columns = np.arange(20 + cross, 20 + cross + width)
        picture[low + deep // 2, columns[draws.random(len(columns)) > gaps]] = 0
        for middle in (low + 7, low + deep - 8):
            for at in range(28 + cross, 12 + cross + width, 17):
                off = np.hypot(y - middle, x - at)
                picture[off <= 7.5] = 0
                picture[off <= 6.2] = 205
    return picture


@pytest.mark.parametrize("gaps", [0.05, 0.2, 0.3])
def test_between_goods_on_both_sides_of_a_mesh_no_aisle_leads(gaps: float) -> None:
    aisles = groundplan.survey(drums_on_both_sides_of_a_mesh(gaps), resolution=RESOLUTION).of_kind("corridor")
    assert sorted(aisle["width"] for aisle in aisles) == pytest.approx([3.05] * 4 + [3.5, 3.8], abs=0.15)
