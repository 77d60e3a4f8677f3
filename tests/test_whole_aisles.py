"""An aisle is whole, however much of a wall is missing along it, and as wide as what stands along it leaves of it."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
import shapely

import groundplan
from groundplan.maps import UNKNOWN

RESOLUTION = 0.05
ROOT = Path(__file__).parents[1]


def shelves_across(reach: float) -> npt.NDArray[np.uint8]:
    """A hall of 20 m by 30 m with two racks of 20 m, and in the 7.6 m between the last of them and the wall shelves of
    0.6 m that reach so far from it."""
    picture = np.full((640, 440), 205, np.uint8)
    picture[18:622, 18:422] = 0
    picture[20:620, 20:420] = 254
    for x in (108, 228):
        picture[140:540, x : x + 40] = 0
        picture[142:538, x + 2 : x + 38] = 205
    draws = np.random.default_rng(2)
    for y in (220, 300, 380):
        shelf = picture[y : y + 12, 420 - int(reach / RESOLUTION) : 420]
        shelf[draws.random(shelf.shape) < 0.4] = 0
        shelf[[0, -1]] = 0
    return picture


@pytest.mark.parametrize("reach", [2.5, 3.5])
def test_an_aisle_between_a_rack_and_the_ends_of_shelves_is_as_wide_as_they_leave_it(reach: float) -> None:
    survey = groundplan.survey(shelves_across(reach), resolution=RESOLUTION)
    assert len(survey.of_kind("rack")) == 5
    (aisle,) = (label for label in survey.of_kind("corridor") if min(x for x, _ in label["axis"]) > 14.0)
    assert aisle["width"] == pytest.approx(7.6 - reach, abs=0.2)


def along_goods(gap: int) -> npt.NDArray[np.uint8]:
    """A way of 4.4 m between walls for 11 m that goes on, so many pixels further, for 30 m, 3.2 m wide or more, between
    goods at any depth; between the two a hall opens on both sides."""
    draws = np.random.default_rng(1)
    picture = np.full((240, 860 + gap), 205, np.uint8)
    picture[74:166, 18:242] = 0
    picture[20:220, 240 : 840 + gap] = 254
    picture[76:164, 20:242] = 254
    for side in (-1, 1):
        x = 240 + gap
        while x < 830 + gap:
            width = int(draws.integers(14, 30))
            near, far = 120 + side * int(draws.integers(32, 39)), 120 + side * 102
            picture[min(near, far) : max(near, far), x : x + width] = 205
            picture[min(near, far) : max(near, far), [x, min(x + width, 839 + gap)]] = 0
            picture[near - 1 : near + 1, x : x + width] = 0
            x += width + int(draws.integers(4, 14))
    return picture


@pytest.mark.parametrize("gap", [60, 140, 205])
def test_an_aisle_goes_on_across_a_hall_that_is_three_times_as_long_as_it_is_wide(gap: int) -> None:
    (aisle,) = groundplan.survey(along_goods(gap), resolution=RESOLUTION).of_kind("corridor")
    assert abs(np.subtract(*aisle["axis"])[0]) == pytest.approx(41.0 + gap * RESOLUTION, abs=2.0)


def racks_past_one_another(apart: int, past: int) -> npt.NDArray[np.uint8]:
    """A hall of 38 m by 30 m with two racks of 18 m by 2 m, of which the one begins so many pixels before the other."""
    picture = np.full((640, 800), 205, np.uint8)
    picture[18:622, 18:782] = 0
    picture[20:620, 20:780] = 254
    for y, x in ((200, 150), (240 + apart, 150 + past)):
        picture[y : y + 40, x : x + 360] = 0
        picture[y + 2 : y + 38, x + 2 : x + 358] = 205
    return picture


@pytest.mark.parametrize(("apart", "past"), [(120, 120), (140, 90), (150, 60)])
def test_racks_that_face_one_another_for_less_than_twice_their_distance_have_an_aisle_between(
    apart: int, past: int
) -> None:
    (aisle,) = groundplan.survey(racks_past_one_another(apart, past), resolution=RESOLUTION).of_kind("corridor")
    assert abs(np.subtract(*aisle["axis"])[0]) > 18.0
    # From the face of the one to that of the other, and its axis half way between.
    assert aisle["width"] == pytest.approx(apart * RESOLUTION, abs=0.3)
    assert aisle["axis"][0][1] == pytest.approx(20.0 - apart * RESOLUTION / 2, abs=0.2)
    assert aisle["confidence"] > 0.8


@pytest.mark.parametrize("name", ["dis_b1", "lab_903", "radish_intel_lab_rendered", "radish_sdr_site_b"])
def test_where_an_aisle_is_wider_or_narrower_there_is_no_second_one_within_it(name: str, shared: Path) -> None:
    corridors = groundplan.survey(groundplan.read(shared / "maps" / f"{name}.yaml")).of_kind("corridor")
    for ways in itertools.combinations(corridors, 2):
        (ax, ay), (bx, by) = (np.subtract(*way["axis"]) / np.hypot(*np.subtract(*way["axis"])) for way in ways)
        one, other = (shapely.Polygon(way["polygon"]) for way in ways)
        if abs(ax * by - ay * bx) < 0.01:
            assert one.intersection(other).area < 0.5 * min(one.area, other.area), [way["name"] for way in ways]


def test_an_aisle_between_two_racks_is_as_wide_as_they_leave_it_though_a_box_stands_in_it(shared: Path) -> None:
    survey = groundplan.survey(groundplan.read(shared / "maps" / "nav2_warehouse.yaml"))
    (aisle,) = (label for label in survey.of_kind("corridor") if min(y for _, y in label["axis"]) > 12.0)
    assert aisle["width"] == pytest.approx(7.0, abs=0.1)


def test_an_aisle_past_the_ends_of_racks_ends_with_them(shared: Path) -> None:
    survey = groundplan.survey(groundplan.read(shared / "maps" / "tugbot_warehouse_shelves.yaml"))
    (aisle,) = (label for label in survey.of_kind("corridor") if all(8.5 < x < 9.5 for x, _ in label["axis"]))
    assert 6.0 < max(y for _, y in aisle["axis"]) < 9.5


def test_an_aisle_that_bends_goes_on_behind_the_bend(shared: Path) -> None:
    survey = groundplan.survey(groundplan.read(shared / "maps" / "torwic_slam_warehouse.yaml"))
    low = [label["axis"] for label in survey.of_kind("corridor") if max(y for _, y in label["axis"]) < 12.0]
    assert len(low) == 2
    assert [min(x for axis in low for x, _ in axis), max(x for axis in low for x, _ in axis)] == pytest.approx(
        [9.6, 40.1], abs=0.5
    )


@pytest.mark.parametrize("name", ["xixian_office", "halmstad/E5_12"])
def test_no_corridor_lies_on_another_that_runs_nearly_the_same_way(name: str, shared: Path) -> None:
    survey = groundplan.survey(groundplan.read(shared / "maps" / f"{name}.yaml"))
    corridors = survey.of_kind("corridor")
    places = [shapely.Polygon(label["polygon"]) for label in corridors]
    ways = [np.subtract(*label["axis"]) / np.hypot(*np.subtract(*label["axis"])) for label in corridors]
    for one, two in itertools.combinations(range(len(corridors)), 2):
        shared_area = places[one].intersection(places[two]).area
        if abs(ways[one] @ ways[two]) > 0.9:
            assert shared_area < 0.5 * min(places[one].area, places[two].area)


def test_an_aisle_goes_on_where_its_sides_are_no_lines_any_more(shared: Path) -> None:
    survey = groundplan.survey(groundplan.read(shared / "maps" / "torwic_slam_warehouse.yaml"))
    main = max(survey.of_kind("corridor"), key=lambda label: float(np.hypot(*np.subtract(*label["axis"]))))
    assert max(y for _, y in main["axis"]) > 78.0
    # At all but a twentieth of its places nothing stands within 1.9 m of its axis on one side, 1.55 m on the other, and
    # 4.1 m across.
    assert main["width"] == pytest.approx(3.7, abs=0.2)
    corners = [label["at"] for label in survey.of_kind("junction") if label["type"] == "L"]
    assert min(np.hypot(*np.subtract(at, (39.1, 43.3))) for at in corners) < 1.0


@pytest.mark.parametrize("by", [2.0, 2.5])
def test_a_way_that_goes_on_beside_itself_is_a_dead_end_at_its_own_ends_alone(by: float) -> None:
    y, x = np.mgrid[-2.0:10.0:RESOLUTION, -2.0:62.0:RESOLUTION]

    def floor(more: float, parted: bool) -> npt.NDArray[np.bool_]:
        one = (x > -more) & (x < 30 + more) & (y > -more) & (y < 3 + more)
        start = 30.3 if parted else 28.0
        two = (x > start - more) & (x < 58 + more) & (y > by - more) & (y < by + 3 + more)
        return np.asarray(one | two, np.bool_)

    for parted, ends in ((False, [0, 58]), (True, [0, 30, 30, 58])):
        picture = np.where(floor(0.0, parted), 254, np.where(floor(0.15, parted), 0, 205)).astype(np.uint8)
        survey = groundplan.survey(np.ascontiguousarray(picture[::-1]), resolution=RESOLUTION, origin=(-2, -2))
        assert len(survey.of_kind("corridor")) == 2
        found = sorted(label["at"][0] for label in survey.of_kind("junction"))
        assert found == pytest.approx(ends, abs=0.4)


@pytest.mark.parametrize(("hidden", "walled"), [((0.62, 0.93), False), ((0.06, 0.3), False), ((0.62, 0.93), True)])
def test_an_aisle_between_two_racks_is_as_long_as_they_are_seen_or_not(
    hidden: tuple[float, float], walled: bool
) -> None:
    map = groundplan.read(ROOT / "examples" / "warehouse.yaml")
    (aisle,) = (label for label in groundplan.survey(map).of_kind("corridor") if label["name"] == "A03")
    start, along = np.array(aisle["axis"][0]), np.subtract(*aisle["axis"][::-1])
    row, column = np.mgrid[: map.height, : map.width]
    places = np.stack([column + 0.5, map.height - row - 0.5]) * map.resolution
    x, y = places + np.reshape(map.origin[:2], (2, 1, 1)) - start.reshape(2, 1, 1)
    share = (x * along[0] + y * along[1]) / (along @ along)
    aside = abs(y * along[0] - x * along[1]) / np.hypot(*along)
    pixels = np.array(map.pixels)
    unknown = int(np.flatnonzero((map.states == UNKNOWN) & (np.bincount(pixels.ravel(), minlength=256) > 0))[0])
    pixels[(share > hidden[0]) & (share < hidden[1]) & (aside < aisle["width"] / 2 - 0.15)] = unknown
    if walled:
        pixels[(abs(share - 0.8) < 0.004) & (aside < aisle["width"] / 2)] = 0
    found = groundplan.survey(groundplan.from_array(pixels, map.resolution, map.origin)).of_kind("corridor")
    (whole,) = (label for label in found if label["name"] == "A03")
    first, last = sorted(float((np.array(end) - start) @ along / (along @ along)) for end in whole["axis"])
    assert first == pytest.approx(0, abs=0.02)
    if walled:
        assert last < hidden[0] + 0.02
    else:
        assert last == pytest.approx(1, abs=0.02)
        assert whole["confidence"] < aisle["confidence"] - 0.1


def test_an_aisle_ends_at_the_wall_though_the_last_bay_on_one_side_is_empty() -> None:
    # Four aisles between racks of 1.2 m, 20 m long, from a way of 4 m to a wall; the last 3.2 m of one rack are
    # empty up to its back.
    picture = np.full((320, 520), 205, np.uint8)
    picture[18:302, 18:502] = 0
    picture[20:300, 20:500] = 254
    for y in (80, 164, 248):
        picture[y : y + 24, 20:420] = 0
    picture[164:186, 20:84] = 254
    survey = groundplan.survey(np.ascontiguousarray(picture[::-1]), resolution=RESOLUTION, origin=(0, 0))
    ends = sorted(label["at"][1] for label in survey.of_kind("junction") if label["type"] == "end")
    assert ends == pytest.approx([2.5, 6.7, 10.9, 14.3], abs=0.2)


@pytest.mark.parametrize("metres", [3.2, 4.5, 7.0])
def test_an_aisle_ends_at_the_wall_though_the_last_bays_on_both_sides_are_empty(metres: float) -> None:
    # The same, of two racks that face each other.
    picture = np.full((320, 520), 205, np.uint8)
    picture[18:302, 18:502] = 0
    picture[20:300, 20:500] = 254
    for y in (80, 164, 248):
        picture[y : y + 24, 20:420] = 0
    for y in (82, 164):
        picture[y : y + 22, 20 : 20 + round(20 * metres)] = 254
    survey = groundplan.survey(np.ascontiguousarray(picture[::-1]), resolution=RESOLUTION, origin=(0, 0))
    ends = sorted(label["at"][1] for label in survey.of_kind("junction") if label["type"] == "end")
    assert ends == pytest.approx([2.5, 6.7, 10.9, 14.3], abs=0.2)


def test_where_a_row_ends_before_the_wall_the_aisles_beside_it_lead_round_its_head() -> None:
    # Four rows of 0.6 m, 2.2 m apart, between aisles that end at a wall; one of the rows ends 3.2 m before that.
    picture = np.full((308, 644), 205, np.uint8)
    picture[18:290, 18:626] = 0
    picture[20:288, 20:624] = 254
    for n in range(4):
        low = 20 + 44 + n * 56
        picture[low : low + 12, 20 + (64 if n == 1 else 0) : 520] = 0
    survey = groundplan.survey(np.ascontiguousarray(picture[::-1]), resolution=RESOLUTION, origin=(0, 0))
    ends = sorted(label["at"][1] for label in survey.of_kind("junction") if label["type"] == "end")
    assert ends == pytest.approx([2.1, 10.5, 13.3], abs=0.3)


def among_goods(goods: list[tuple[int, int]], aisle: int = 76) -> npt.NDArray[np.uint8]:
    """A hall of two blocks of three racks of 8 m by 2 m, 5 m apart; in an aisle of the second one goods of 1.2 m by 1 m
    stand along one face (0) or the other (1), so many pixels from the block's end."""
    picture = np.full((40 + 3 * 40 + 4 * aisle, 580), 205, np.uint8)
    picture[18:-18, 18:-18] = 0
    picture[20:-20, 20:-20] = 254
    for low in (20 + aisle + rack * (40 + aisle) for rack in range(3)):
        for left in (80, 340):
            picture[low : low + 40, left : left + 160] = 0
            picture[low + 2 : low + 38, left + 2 : left + 158] = 205
    for face, at in goods:
        low = 60 + aisle + face * (aisle - 20)
        picture[low : low + 20, 340 + at : 364 + at] = 0
        picture[low + 2 : low + 18, 342 + at : 362 + at] = 205
    return np.rot90(picture).copy()


@pytest.mark.parametrize(
    "goods",
    [
        [(0, 2), (1, 36), (1, 86), (0, 110)],
        [(1, 12), (0, 12), (0, 34), (1, 80), (0, 108)],
        [(0, 10), (1, 35), (0, 110), (1, 117)],
    ],
)
def test_an_aisle_leads_on_past_goods_at_both_its_sides(goods: list[tuple[int, int]]) -> None:
    found = groundplan.survey(among_goods(goods), resolution=RESOLUTION)
    assert sorted(junction["type"] for junction in found.of_kind("junction")) == ["L"] * 4 + ["T"] * 6 + ["X"] * 2
    aisles = [way for way in found.of_kind("corridor") if way["name"].startswith("A")]
    assert [way["width"] for way in aisles] == pytest.approx([3.8] * 4, abs=0.15)
    assert [np.ptp(way["axis"], axis=0).max() for way in aisles] == pytest.approx([24.0] * 4, abs=0.3)


def test_an_aisle_ends_where_goods_on_both_sides_leave_no_way() -> None:
    goods = [(0, 10), (1, 20), (1, 86), (0, 110)]
    found = groundplan.survey(among_goods(goods, aisle=52), resolution=RESOLUTION)
    assert len(found.of_kind("corridor")) == 7
    assert sorted(junction["type"] for junction in found.of_kind("junction")).count("X") == 1
