"""II-A: the directions of a map, found in number and angle."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pytest
import zoo
from zoo import RESOLUTION, TURNS, ZOO, Canvas, apart

import groundplan
from groundplan import simulate

Mask = npt.NDArray[np.bool_]


def angles_of(picture: zoo.Picture) -> zoo.Points:
    return np.degrees(groundplan.survey(picture, resolution=RESOLUTION).directions.angles)


def wall(degrees: float, length: float, width: float) -> zoo.Picture:
    along = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
    start = np.array([100.0, 100.0]) - length / 2 * along
    return Canvas(200, 200, zoo.FREE).bar((float(start[0]), float(start[1])), degrees, length, width).picture


@pytest.mark.parametrize("width", [1, 2, 3])
def test_a_wall_at_any_angle_is_measured_within_a_tenth_of_a_degree(width: float) -> None:
    for degrees in range(1, 90, 2):
        angles = angles_of(wall(degrees, 180, width))
        assert len(angles) == 1
        assert apart(np.radians(angles), [np.radians(degrees)]) < np.radians(0.1), (degrees, angles)


@pytest.mark.parametrize("degrees", [0, 45, 90])
@pytest.mark.parametrize("length", [60, 100, 180])
def test_a_wall_along_the_pixels_is_measured_exactly(degrees: float, length: float) -> None:
    angles = angles_of(wall(degrees, length, 2))
    assert len(angles) == 1
    assert apart(np.radians(angles), [np.radians(degrees)]) < np.radians(0.02), angles


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("single_room", [0, 90]),
        ("two_rooms_with_door", [0, 90]),
        ("crossing", [0, 90]),
        ("comb_of_racks", [0, 90]),
        ("thick_walls", [0, 90]),
        ("double_walls", [0, 90]),
        ("rows_of_offices", [0, 90]),
        ("pillars", [0, 90]),
        ("turned_warehouse", [17, -73]),
        ("skewed", [0, 70]),
        ("triangle_grid", [0, 60, -60]),
        ("freestanding_wall", [0]),
        ("diagonal_only", [45]),
    ],
)
def test_a_map_has_as_many_directions_as_its_walls(name: str, expected: list[float]) -> None:
    found = zoo.surveyed(name).directions
    assert len(found) == len(expected)
    assert (apart(np.radians(expected), found.angles).min(axis=1) < np.radians(0.15)).all(), np.degrees(found.angles)


@pytest.mark.parametrize("name", ["empty", "all_unknown", "all_occupied", "one_pixel", "one_row", "noise"])
def test_a_map_without_structure_has_no_directions_and_says_so(name: str) -> None:
    survey = zoo.surveyed(name)
    assert len(survey.directions) == 0
    assert "no-structure" in {warning.code for warning in survey.warnings}


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("name", sorted(ZOO.keys() - {"all_occupied"}))
def test_a_turned_map_has_the_turned_directions(name: str, turn: int) -> None:
    original, turned = zoo.surveyed(name).directions, zoo.surveyed(name, turn).directions
    assert len(turned) == len(original)
    gaps = apart(zoo.variants(name)[turn].angles(original.angles), turned.angles)
    assert (gaps < np.radians(0.15)).sum() == len(original), np.degrees(gaps)


def assert_square(
    degrees: float,
    racks: Callable[[zoo.Points, zoo.Points], Mask],
    side: float,
    length: float,
    depth: float,
    wall: float,
) -> None:
    """A turned hall of racks, drawn at 0.1 m a pixel on a map of so many metres, has its own two directions."""
    angle = np.radians(degrees)
    y, x = np.mgrid[-side / 2 : side / 2 : 0.1, -side / 2 : side / 2 : 0.1]
    along = x * np.cos(angle) + y * np.sin(angle) + length / 2
    across = y * np.cos(angle) - x * np.sin(angle) + depth / 2
    inside = (along > 0) & (along < length) & (across > 0) & (across < depth)
    walled = (along > -wall) & (along < length + wall) & (across > -wall) & (across < depth + wall) & ~inside
    taken = walled | (inside & racks(along, across))
    picture = np.where(taken, 0, np.where(inside, 254, 205)).astype(np.uint8)
    found = groundplan.survey(np.ascontiguousarray(picture[::-1]), resolution=0.1).directions.angles
    assert len(found) == 2
    assert (apart([angle, angle + np.pi / 2], found).min(axis=1) < np.radians(0.1)).all(), np.degrees(found)


@pytest.mark.parametrize("degrees", [5.5, 6.0, 6.5, 45.0, 83.5])
@pytest.mark.parametrize(("rows", "blocks"), [(13, 5), (6, 3)])
def test_narrow_rows_on_a_coarse_map_are_measured_where_staircases_look_like_other_directions(
    rows: int, blocks: int, degrees: float
) -> None:
    """Racks of 10.8 m by 1.3 m, 1.3 m apart, with ways of 4.5 m between the blocks."""
    length, depth = blocks * 15.3 + 4.5, rows * 2.6 + 1.3

    def racks(along: zoo.Points, across: zoo.Points) -> Mask:
        return (along % 15.3 > 4.5) & (across % 2.6 > 1.3)

    assert_square(degrees, racks, 1.2 * float(np.hypot(length, depth)), length=length, depth=depth, wall=0.2)


def test_walls_and_rack_ends_along_a_hall_of_650_metres_are_its_second_direction() -> None:
    length, width = 13000, 1400
    free = np.full((width, length), zoo.FREE, np.uint8)
    for rack in range(100, length - 100, 104):
        for first, last in ((60, 660), (760, 1360)):
            free[first:last, rack : rack + 44] = zoo.OCCUPIED
            free[first + 2 : last - 2, rack + 2 : rack + 42] = zoo.UNKNOWN
    hall = np.full((width + 6, length + 6), zoo.OCCUPIED, np.uint8)
    hall[3:-3, 3:-3] = free
    assert angles_of(hall) == pytest.approx([90.0, 0.0], abs=1e-3)


@pytest.mark.parametrize("wall", [0.3, 0.32, 0.36, 0.4])
@pytest.mark.parametrize("degrees", [35.0, 37.2, 40.2, 41.6, 48.6, 53.0, 55.0])
def test_cross_walls_of_a_hall_turned_by_much_are_square_to_its_racks(degrees: float, wall: float) -> None:
    """Seven racks of 19 m by 1.8 m, 2.1 m apart, in walls of three or four pixels."""
    length = 25.36

    def racks(along: zoo.Points, across: zoo.Points) -> Mask:
        return (along > 3.16) & (along < length - 3.16) & (across % 3.9 > 2.12)

    assert_square(degrees, racks, 46.8, length=length, depth=29.42, wall=wall)


@pytest.mark.parametrize("turn", [16.0, 35.0, 50.0])
def test_each_wing_has_the_direction_of_its_ends_be_that_little_beside_its_long_rows(turn: float) -> None:
    """A hall of 40 m by 16.5 m with four rows of racks, and a wing of 25 m by 12 m with three."""
    y, x = np.mgrid[-30.0:30.0:0.1, -45.0:35.0:0.1]
    picture = np.full(x.shape, 205, dtype=np.uint8)
    for left, bottom, degrees, length, rows in (
        (-10.0, -8.0, 10.0, 40.0, 4),
        (-15.0, -3.0, 10.0 + turn + 180, 25.0, 3),
    ):
        angle, depth = np.radians(degrees), rows * 4.5 - 1.5
        along = (x - left) * np.cos(angle) + (y - bottom) * np.sin(angle)
        across = (y - bottom) * np.cos(angle) - (x - left) * np.sin(angle)
        inside = (along > 0) & (along < length) & (across > 0) & (across < depth)
        walls = (along > -0.2) & (along < length + 0.2) & (across > -0.2) & (across < depth + 0.2) & ~inside
        racks = inside & (along > 3) & (along < length - 3) & (across % 4.5 > 3)
        picture[inside] = 254
        picture[walls | racks] = 0
    found = groundplan.survey(np.ascontiguousarray(picture[::-1]), resolution=0.1).directions.angles
    expected = np.radians([10.0, 100.0, 10.0 + turn, 100.0 + turn])
    assert len(found) == 4
    assert (apart(expected, found).min(axis=1) < np.radians(0.15)).all(), np.degrees(found)


@pytest.mark.parametrize("turn", [20, 33, 45])
def test_a_wing_that_is_small_beside_the_hall_has_its_two_directions(turn: float) -> None:
    def site(side: float) -> zoo.Picture:
        return Canvas(900, 900).room(40, 40, 860, 330).turn(turn).room(400, 500, 400 + side, 500 + side).picture

    found = np.radians(angles_of(site(90)))
    assert len(found) == 4
    assert (apart(np.radians([0, 90, turn, turn - 90]), found).min(axis=1) < np.radians(0.15)).all(), np.degrees(found)
    # A box on the floor is no wing.
    assert len(angles_of(site(12))) == 2


@pytest.mark.parametrize("turn", [20, 33])
def test_a_wing_of_whose_passage_and_first_wall_alone_something_was_seen_has_its_two_directions(turn: float) -> None:
    site = Canvas(900, 900).room(40, 40, 860, 330)
    for y in (80, 140, 200, 260):
        site.box(100, y, 800, y + 30)
    site.turn(turn)
    for y in (0, 40):
        site.box(420, 500 + y, 720, 504 + y)
    site.box(720, 470, 724, 575)
    found = np.radians(angles_of(site.picture))
    assert len(found) == 4
    assert (apart(np.radians([0, 90, turn, turn - 90]), found).min(axis=1) < np.radians(0.5)).all(), np.degrees(found)


@pytest.mark.parametrize("degrees", [0.0, 23.0])
def test_beveled_corners_of_blocks_are_no_wing(degrees: float) -> None:
    """A hall of 24 m by 16 m with three blocks of 5 m by 11 m, of each corner of which 1.2 m are cut off."""
    y, x = np.mgrid[-15.0:15.0:0.05, -15.0:15.0:0.05]
    cos, sin = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    u, v = np.abs(x * cos + y * sin), np.abs(y * cos - x * sin)
    picture = np.full(x.shape, 205, dtype=np.uint8)
    picture[(u < 12.2) & (v < 8.2)] = 0
    picture[(u < 12.0) & (v < 8.0)] = 254
    for middle in (0.0, 7.6):
        across = np.abs(u - middle)
        for deep, value in ((0.0, 0), (0.1, 205)):
            corner = across + v < 2.5 + 5.5 - 1.2 - deep * 1.4
            picture[(across < 2.5 - deep) & (v < 5.5 - deep) & corner] = value
    found = angles_of(np.ascontiguousarray(picture[::-1]))
    assert len(found) == 2


@pytest.mark.parametrize("turn", [5.5, -6.0, 7.0])
def test_a_wing_turned_by_a_few_degrees_has_directions_of_its_own(turn: float) -> None:
    found = groundplan.survey(simulate.warehouse(wing=turn, seed=3).map).directions.angles
    assert len(found) == 4
    assert (apart(np.radians([0, 90, turn, turn + 90]), found).min(axis=1) < np.radians(0.25)).all(), np.degrees(found)


@pytest.mark.parametrize(("skew", "seed"), [(10.0, 106), (-14.0, 14)])
def test_a_skewed_hall_has_no_third_direction_by_goods_that_are_square_to_its_racks(skew: float, seed: int) -> None:
    made = simulate.warehouse(skew=skew, seed=seed, width=44.0, depth=32.0, yaw=6.2)
    assert len(groundplan.survey(made.map).directions.angles) == 2


def test_angles_lie_between_minus_and_plus_a_right_angle() -> None:
    for name in ZOO:
        angles = zoo.surveyed(name).directions.angles
        assert ((angles >= -np.pi / 2) & (angles < np.pi / 2)).all()


def test_weights_are_shares_of_the_strongest() -> None:
    for name in ZOO:
        weights = zoo.surveyed(name).directions.weights
        assert len(weights) == 0 or weights[0] == 1.0
        assert (np.diff(weights) <= 0).all()


def test_no_more_directions_than_asked_for() -> None:
    picture = ZOO["triangle_grid"]()
    assert len(groundplan.survey(picture, resolution=RESOLUTION, directions_count=2).directions) == 2
    survey = groundplan.survey(ZOO["freestanding_wall"](), resolution=RESOLUTION, directions_count=3)
    assert len(survey.directions) == 1
    assert "few-directions" in {warning.code for warning in survey.warnings}


def test_directions_that_are_given_are_taken() -> None:
    survey = groundplan.survey(ZOO["single_room"](), resolution=RESOLUTION, directions_angles_deg=[10.0, 85.0, 190.0])
    assert sorted(np.degrees(survey.directions.angles)) == pytest.approx([10.0, 85.0])
    assert survey.problems() == []


@pytest.mark.parametrize(("angles", "near"), [([10.0, 10.5], True), ([-89.0, 5.0, 89.0], True), ([10.0, 18.0], False)])
def test_directions_that_are_given_nearer_than_two_may_be_found_are_kept_and_told(
    angles: list[float], near: bool
) -> None:
    for given in ({"directions_angles_deg": angles}, {"directions": groundplan.Directions.of(np.radians(angles))}):
        survey = groundplan.survey(ZOO["single_room"](), resolution=RESOLUTION, **given)
        assert sorted(np.degrees(survey.directions.angles)) == pytest.approx(angles)
        told = [warning.message for warning in survey.warnings if warning.code == "near-directions"]
        assert len(told) == near
        for sentence in told:
            assert all(f"{angle:g}" in sentence for angle in (angles[0], angles[-1], 5))
    wider = groundplan.survey(
        ZOO["single_room"](), resolution=RESOLUTION, directions_angles_deg=[10, 18], directions_separation_deg=9
    )
    assert "near-directions" in {warning.code for warning in wider.warnings}


def bent_hall(heading: Callable[[npt.NDArray[np.float64]], npt.NDArray[np.float64]]) -> npt.NDArray[np.uint8]:
    """A hall of 64 by 26 m with four rows of racks, all along a heading, degrees, that depends on the place along."""
    x = np.arange(0, 64, RESOLUTION)
    along = np.tan(np.radians(heading(x)))
    off = np.cumsum(along) * RESOLUTION
    y = np.mgrid[-4.0:40.0:RESOLUTION][:, None] - off
    picture = np.full(y.shape, zoo.UNKNOWN, dtype=np.uint8)
    picture[(y > -0.15) & (y < 26.15)] = zoo.OCCUPIED
    picture[(y > 0) & (y < 26)] = zoo.FREE
    for low in (4.0, 9.5, 15.0, 20.5):
        picture[(y > low) & (y < low + 1.5) & (x > 4) & (x < 60)] = zoo.OCCUPIED
    picture[:, x < 0.15] = picture[:, x > 63.85] = zoo.OCCUPIED
    return np.ascontiguousarray(picture[::-1])


def nearest(picture: npt.NDArray[np.uint8], degrees: float) -> float:
    found = groundplan.survey(picture, resolution=RESOLUTION).directions.angles
    return float(min(np.degrees(found), key=lambda angle: abs(float(angle) - degrees)))


def test_the_direction_of_a_bent_hall_is_the_mean_over_its_length() -> None:
    # Straight at first, the sharpest part, and then more and more askew.
    def heading(x: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        return np.clip((x - 24) / 10, 0, 4)

    rows = float(heading(np.arange(4, 60, RESOLUTION)).mean())
    assert nearest(bent_hall(heading), 0) == pytest.approx(rows, abs=0.3)


@pytest.mark.parametrize("askew", [0.0, 2.0, 3.0, 4.0])
def test_a_wing_that_is_turned_by_little_does_not_turn_a_straight_hall(askew: float) -> None:
    assert nearest(bent_hall(lambda x: np.where(x < 40, 0.0, askew)), 0) == pytest.approx(0, abs=0.1)


def test_the_histogram_counts_every_edge_pixel_once() -> None:
    map = groundplan.from_array(ZOO["turned_warehouse"](), RESOLUTION)
    gradients = groundplan.find_gradients(map)
    histogram = groundplan.find_directions(map, gradients).histogram
    assert histogram.sum() == gradients.magnitudes.sum(dtype=np.int64)


def test_edge_pixels_are_taken_with_a_neighbour_that_is_not() -> None:
    picture = ZOO["turned_warehouse"]()
    taken = np.pad(picture == zoo.OCCUPIED, 1, mode="edge")
    inner = taken[:-2, 1:-1] & taken[2:, 1:-1] & taken[1:-1, :-2] & taken[1:-1, 2:]
    rows, columns = np.nonzero(taken[1:-1, 1:-1] & ~inner)
    expected = sorted(zip(columns.tolist(), (len(picture) - 1 - rows).tolist(), strict=True))
    found = groundplan.find_gradients(groundplan.from_array(picture, RESOLUTION)).pixels
    assert sorted(map(tuple, found.tolist())) == expected


@pytest.mark.parametrize("radius", [7, 8, 20, 28, 32])
def test_a_gradient_is_that_of_the_scatter_of_the_edge_pixels_in_a_round_window(radius: int) -> None:
    picture = ZOO["turned_warehouse"]()
    picture[np.random.default_rng(radius).random(picture.shape) < 0.2] = zoo.OCCUPIED
    map = groundplan.from_array(picture, RESOLUTION)
    found = groundplan.find_gradients(map, gradients_radius=radius * RESOLUTION)
    pixels = found.pixels.astype(np.int64)
    for n in range(0, len(pixels), len(pixels) // 300):
        apart = pixels - pixels[n]
        x, y = apart[(apart**2).sum(axis=1) <= radius**2].T
        count = len(x)
        xx, xy, yy = (count * (a * b).sum() - a.sum() * b.sum() for a, b in ((x, x), (x, y), (y, y)))
        assert found.magnitudes[n] == np.floor(255 * np.hypot(xx - yy, 2 * xy) / (xx + yy) + 0.5)
        off = found.angles[n] - np.arctan2(2 * xy, xx - yy) / 2
        assert abs(np.sin(off)) < 1e-6
