"""Ways across the rows of halls that a wall parts and a gate joins: what lies behind the wall is none of their rows."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pytest
from zoo import FREE, OCCUPIED, Canvas

import groundplan

Picture = npt.NDArray[np.uint8]
Box = tuple[float, float, float, float]  # from x, from y, to x, to y
Draw = Callable[..., None]

RESOLUTION = 0.05


def site(floors: list[Box], racks: list[Box]) -> Picture:
    """Floors with walls around what they cover together, metres, and what stands on them; the unknown around."""
    right, top = (max(box[n] for box in floors) for n in (2, 3))
    picture = np.full((round(top / RESOLUTION) + 40, round(right / RESOLUTION) + 40), 205, np.uint8)
    walls = [(left - 0.1, low - 0.1, to + 0.1, high + 0.1) for left, low, to, high in floors]
    for boxes, grey in ((walls, 0), (floors, 254), (racks, 0)):
        for box in boxes:
            left, low, to, high = (round(metres / RESOLUTION) + 20 for metres in box)
            picture[low:high, left:to] = grey
    return picture


def rows(lows: list[float], pieces: list[tuple[float, float]], depth: float = 2) -> list[Box]:
    """Racks from place to place along each of some rows."""
    return [(left, low, right, low + depth) for low in lows for left, right in pieces]


def hall_and_wing(canvas: Canvas, low: float, at: tuple[float, float], turn: float) -> tuple[Draw, Draw]:
    """What draws boxes, metres: of a hall so much off the lower edge, and of a wing that is turned about a place."""
    cos, sin = np.cos(np.radians(turn)), np.sin(np.radians(turn))

    def box(x: float, y: float, right: float, top: float, value: int = OCCUPIED) -> None:
        canvas.box(20 * (x + 4), 20 * (y + low), 20 * (right + 4), 20 * (top + low), value)

    def wing(x: float, y: float, right: float, top: float, value: int = OCCUPIED) -> None:
        middle = (y + top) / 2
        start = (20 * (at[0] + cos * x + sin * middle), 20 * (at[1] + cos * middle - sin * x))
        canvas.bar(start, -turn, 20 * (right - x), 20 * (top - y), value)

    return box, wing


def found(picture: Picture) -> tuple[list[str], list[float]]:
    """The types of all junctions, and how wide the ways across the rows are."""
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    across = [way for way in survey.of_kind("corridor") if abs(np.subtract(*way["axis"])[0]) < 1]
    return sorted(junction["type"] for junction in survey.of_kind("junction")), sorted(way["width"] for way in across)


def test_ways_across_rows_end_at_the_wall_between_two_halls() -> None:
    # Aisles of 3 m along both sides of a wall of 0.4 m, and a gate in it where the first ways of both halls are one.
    floors: list[Box] = [(0, 0, 40, 13), (0, 13.4, 40, 26.4), (0, 12, 4, 14)]
    below = rows([3, 8], [(4, 20), (22.7, 35)])
    above = rows([16.4, 21.4], [(4, 24), (27.2, 37)])
    junctions, widths = found(site(floors, [*below, *above]))
    assert junctions == ["L"] * 6 + ["T"] * 10 + ["X"] * 2
    assert widths == pytest.approx([2.7, 3.0, 3.2, 4.0, 5.0], abs=0.3)


def test_ways_lead_past_rows_on_both_sides_of_a_gate() -> None:
    # An aisle of the one hall leads through the gate and is one of the other's.
    floors: list[Box] = [(0, 0, 20, 8), (20.2, 4.5, 50, 18), (19, 5, 22, 8)]
    left, right = rows([3], [(3, 17)]), rows([8, 13], [(23.2, 46)])
    junctions, widths = found(site(floors, [*left, *right]))
    assert junctions == ["L"] * 6 + ["T"] * 4
    assert widths == pytest.approx([3.0, 3.0, 3.0, 4.0], abs=0.25)


def test_a_way_leads_past_a_row_at_a_wall_with_a_gate() -> None:
    floors: list[Box] = [(0, 0, 10, 3), (10.2, 0, 40, 8), (9, 0, 11, 3)]
    junctions, widths = found(site(floors, rows([3], [(13.2, 37)])))
    assert junctions == ["L"] * 3 + ["T", "end"]
    assert widths == pytest.approx([3.0, 3.0], abs=0.25)


def test_two_ways_as_wide_as_bays_lead_through_two_full_rows() -> None:
    # Bays of 3 m between posts, goods in all of them but for two ways.
    racks: list[Box] = []
    for low in (3.0, 8.4):
        for n in range(28):
            left = 5 + 3 * n
            racks += [(left - 0.05, low + at, left + 0.05, low + at + 0.1) for at in (0, 0.9, 1.3, 2.3)]
            for place in range(0 if n in (9, 18, 27) else 3):
                start = left + 0.1 + 0.95 * place
                racks += [(start, low + at, start + 0.85, low + at + 1) for at in (0.05, 1.35)]
    junctions, widths = found(site([(0, 0, 91, 13.8)], racks))
    assert junctions == ["L"] * 4 + ["T"] * 6 + ["X"] * 2
    assert widths == pytest.approx([2.9, 2.9, 5.0, 5.0], abs=0.3)


@pytest.mark.parametrize("apart", [1.2, 2.5])
def test_ways_lead_past_rows_on_both_sides_of_what_nobody_saw_between_two_halls(apart: float) -> None:
    # A way leads from hall to hall through the middle of all rows; the upper hall is shorter than the lower one.
    high = 12 + apart
    floors: list[Box] = [(0, 0, 40, 12), (6, high, 34, high + 13), (18.5, 11, 21.5, high + 1)]
    below = rows([3, 7], [(3.5, 18.5), (21.5, 36.5)])
    above = rows([high + 3.2, high + 7.8], [(8.4, 18.5), (21.5, 31.6)], 1.6)
    junctions, widths = found(site(floors, [*below, *above]))
    assert junctions == ["L"] * 8 + ["T"] * 6 + ["X"] * 4
    assert widths == pytest.approx([2.4, 2.4, 3.0, 3.5, 3.5], abs=0.3)


@pytest.mark.parametrize("wall", [0.1, 0.2, 0.4])
@pytest.mark.parametrize("gate", [2.4, 4.2])
def test_a_gate_in_a_thin_wall_between_two_aisles_is_a_way(wall: float, gate: float) -> None:
    # It leads on into no aisle across, and is no wider than the ways past the rows' ends or as wide.
    beyond = 14.2 + wall
    floors: list[Box] = [(0, 0, 40, 14.2), (0, beyond, 40, beyond + 14.2), (16, 13, 16 + gate, beyond + 1)]
    racks = rows([3, 8.6, beyond + 3, beyond + 8.6], [(4, 36)], depth=2.6)
    junctions, widths = found(site(floors, racks))
    assert junctions == ["L"] * 8 + ["T"] * 6
    assert widths == pytest.approx(sorted([gate, 4.1, 4.1, 4.1, 4.1]), abs=0.2)


@pytest.mark.parametrize("wall", [0.2, 0.4, 0.5])
@pytest.mark.parametrize("way", [2.4, 3.0])
def test_a_way_that_leads_on_through_a_gate_is_one_though_rows_lie_across_behind_it(way: float, wall: float) -> None:
    # Wider ones lead through the rows of the one hall alone, and past all rows' ends.
    low = 16.9 + wall
    floors: list[Box] = [(0, 0, 40, 16.9), (0, low, 40, low + 12.1), (17.6, 16, 18.4 + way, 18)]
    below = rows([2.5, 7.3, 12.1], [(3.5, 18), (18 + way, 28), (32.2, 36.5)], depth=2.3)
    junctions, widths = found(site(floors, [*below, *rows([low + 2.5, low + 7.3], [(3.5, 36.5)], depth=2.3)]))
    assert junctions == ["L"] * 8 + ["T"] * 10 + ["X"] * 5
    assert widths == pytest.approx(sorted([way, 3.5, 3.5, 3.5, 3.5, 4.2]), abs=0.25)


def test_ways_through_single_rows_are_as_wide_as_they_are_whatever_leads_through_the_next_hall() -> None:
    # One of 3 m leads on through a gate in a wall of 0.4 m; behind that each of two rows has its own way.
    floors: list[Box] = [(0, 0, 40, 16.9), (0, 17.3, 40, 29.4), (17.6, 16, 21.4, 18)]
    below = rows([2.5, 7.3, 12.1], [(3.5, 18), (21, 36.5)], depth=2.3)
    above = [*rows([19.8], [(3.5, 9), (11.2, 36.5)], depth=2.3), *rows([24.6], [(3.5, 27), (29.2, 36.5)], depth=2.3)]
    _, widths = found(site(floors, [*below, *above]))
    assert widths == pytest.approx([2.2, 2.2, 3.0, 3.5, 3.5, 3.5, 3.5], abs=0.25)


def test_openings_between_the_pillars_of_two_aisles_are_no_gates() -> None:
    pillars = [(n, 14.2, n + 0.4, 14.4) for n in np.arange(4.0, 37.0, 4.0).tolist()]
    junctions, _ = found(site([(0, 0, 40, 28.6)], [*rows([3, 8.6, 17.4, 23], [(4, 36)], depth=2.6), *pillars]))
    assert "X" not in junctions
    assert junctions.count("T") <= 8


@pytest.mark.parametrize(("turn", "free", "way"), [(8.5, 4.4, 3.0), (10.0, 5.0, 2.4), (10.0, 6.4, 3.0)])
def test_a_way_across_rows_is_none_along_the_next_wing(turn: float, free: float, way: float) -> None:
    # Between guards the way is straight. Beyond these bays are empty: a wider one leads through along the wing's rows.
    length, aisle, depth, ends = 44, 3.6, 2.4, 4.5
    height = 5 * (aisle + depth) + aisle
    canvas = Canvas(1640, 952)

    box, wing = hall_and_wing(canvas, 10, (length + 9.2, 6), turn)

    box(-0.15, -0.15, length + 0.15, height + 0.15)
    box(length - 0.3, 18.3, length + 9, 21.6)
    wing(-0.15, -0.15, 20.15, 28.15)
    box(0, 0, length, height, FREE)
    wing(0, 0, 20, 28, FREE)
    box(length - 0.3, 18.45, length + 9, 21.45, FREE)
    middle = 0.45 * length
    for low in (aisle + n * (aisle + depth) for n in range(5)):
        askew = middle + (low + (depth - height) / 2) * np.tan(np.radians(turn))
        box(ends, low, min(middle - way / 2, askew - free / 2), low + depth)
        box(max(middle + way / 2, askew + free / 2), low, length - ends, low + depth)
        for guard in (middle - way / 2 - 0.1, middle + way / 2):
            box(guard, low, guard + 0.1, low + depth)
    for n in range(4):
        wing(3.4 + 4.4 * n, 4, 4.6 + 4.4 * n, 24)
    survey = groundplan.survey(canvas.picture, resolution=RESOLUTION)
    axes = [way["axis"] for way in survey.of_kind("corridor") if 15 < np.mean(way["axis"], axis=0)[0] < 32]
    across = [axis for axis in axes if abs(np.subtract(*axis)[1]) > 10]
    assert len(across) == 1
    assert abs(np.subtract(*across[0])[0]) < 0.2
    hall = [junction["type"] for junction in survey.of_kind("junction") if junction["at"][0] < 46]
    assert hall.count("X") == 5


@pytest.mark.parametrize("wall", [0.8, 1.0])
def test_the_way_past_a_rows_head_is_one_though_another_halls_aisle_lies_beside_the_row_elsewhere(wall: float) -> None:
    floors: list[Box] = [(0, 0, 44, 7.4), (0, 7.4 + wall, 20, 10.6 + wall), (9.5, 7, 12.5, 8 + wall)]
    survey = groundplan.survey(site(floors, rows([3.2], [(4.5, 39.5)], depth=1)), resolution=RESOLUTION)
    ends = [junction for junction in survey.of_kind("junction") if junction["at"][0] > 40]
    assert [junction["type"] for junction in ends] == ["L", "L"]


@pytest.mark.parametrize("turns", range(2))
@pytest.mark.parametrize(("length", "hidden"), [(5, 0), (5, 1), (6, 2), (8, 3)])
def test_a_passage_between_two_halls_opens_into_that_one_from_which_it_was_seen(
    length: float, hidden: float, turns: int
) -> None:
    # Two rows of 2 m in each hall; what stands in the left one hides most of the passage's beginning.
    halls: list[Box] = [(0, 0, 20, 18), (20 + length, 0, 40 + length, 18)]
    floors: list[Box] = [*halls, (19, 9.7, 21 + length, 12.2)]
    racks = [row for left, *_ in halls for row in rows([4, 10], [(left + 4.5, left + 15.5)])]
    picture = site(floors, racks)
    picture[212:256, 420 : 420 + round(hidden / RESOLUTION)] = 205
    junctions, _ = found(np.ascontiguousarray(np.rot90(picture, turns)))
    assert junctions == ["L"] * 8 + ["T"] * (5 if hidden else 6)


@pytest.mark.parametrize(
    ("turn", "first", "depth", "gaps"),
    [(28.8, 4.1, 1.5, (-0.1, 2.6, 7.3)), (35.3, 4.4, 1.1, (1.0, 6.1, 8.2)), (29.3, 4.5, 2.0, (0.3, 4.4, 6.1))],
)
def test_an_aisle_leads_into_a_wing_up_to_its_first_aisle_and_not_on_through_its_cross_aisle(
    turn: float, first: float, depth: float, gaps: tuple[float, float, float]
) -> None:
    # The racks of the wing are parted about where a passage of 3 m, in line with an aisle of the hall, would lead on.
    canvas = Canvas(1500, 1500)

    box, wing = hall_and_wing(canvas, 30, (33, 41.5), turn)

    box(-0.15, -0.15, 26.15, 19.15)
    box(25.7, 9.85, 32, 13.15)
    wing(-0.15, -14.15, 24.15, 20.15)
    box(0, 0, 26, 19, FREE)
    wing(0, -14, 24, 20, FREE)
    box(25.7, 10, 31, 13, FREE)
    for n in range(3):
        box(4, 3 + 5 * n, 22, 5 + 5 * n)
    for n, gap in enumerate(gaps):
        for low, top in ((-10, gap), (gap + 3.4, 16)):
            wing(first + n * (depth + 3.2), low, first + n * (depth + 3.2) + depth, top)
    survey = groundplan.survey(canvas.picture, resolution=RESOLUTION)
    along = [way["axis"] for way in survey.of_kind("corridor") if abs(np.subtract(*way["axis"])[1]) < 1]
    assert len(along) == 4
    assert max(end[0] for axis in along for end in axis) < 46


@pytest.mark.parametrize("turn", [8.0, 10.0, 12.0, 14.0])
def test_a_passage_leads_up_to_the_first_way_of_a_wing_and_not_on_through_an_aisle_that_runs_nearly_so(
    turn: float,
) -> None:
    canvas = Canvas(1500, 1060)
    first, aisle, depth, passage = 3.2, 4.6, 2.0, 2.4
    height = 4 * aisle + 3 * depth
    low = -height / 2 - 1.5

    box, wing = hall_and_wing(canvas, 12, (34, 20), turn)

    box(-0.15, -0.15, 24.15, 19.15)
    box(23.7, 8 - passage / 2 - 0.15, 33, 8 + passage / 2 + 0.15)
    wing(-0.15, low - 0.15, 30.15, low + height + 0.15)
    box(0, 0, 24, 19, FREE)
    wing(0, low, 30, low + height, FREE)
    box(23.7, 8 - passage / 2, 30.8, 8 + passage / 2, FREE)
    for n in range(3):
        box(4, 3.5 + 5 * n, 20, 5.5 + 5 * n)
        wing(first, low + aisle + (aisle + depth) * n, 26.5, low + (aisle + depth) * (n + 1))
    survey = groundplan.survey(canvas.picture, resolution=RESOLUTION)
    along = [way["axis"] for way in survey.of_kind("corridor") if abs(np.subtract(*way["axis"])[1]) < 1]
    assert len(along) == 4
    assert max(end[0] for axis in along for end in axis) < 36


@pytest.mark.parametrize("turn", [8.0, 12.0, 16.0])
def test_a_corridor_between_walls_of_its_own_forks_off_another_though_a_third_crosses_both(turn: float) -> None:
    canvas, width = Canvas(1200, 900), 60
    for margin, value in ((3, OCCUPIED), (0, FREE)):
        for start, degrees, length in (((60, 300), 0.0, 1080), ((300, 300), turn, 700), ((700, 100), 90.0, 750)):
            cos, sin = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
            first = (start[0] - margin * cos, start[1] - margin * sin)
            canvas.bar(first, degrees, length + 2 * margin, width + 2 * margin, value)
    survey = groundplan.survey(canvas.picture, resolution=RESOLUTION)
    askew = [way["axis"] for way in survey.of_kind("corridor") if 2 < abs(np.subtract(*way["axis"])[1]) < 20]
    assert max(np.hypot(*np.subtract(*axis)) for axis in askew) > 30


@pytest.mark.parametrize("low", [2.0, 2.7])
@pytest.mark.parametrize("head", [2.0, 2.6])
def test_a_way_leads_past_the_end_of_a_single_row_before_a_passage(low: float, head: float) -> None:
    # Two halls of one row each; the passage between them opens opposite the ends of both rows.
    floors: list[Box] = [(0, 0, 30, 7.8), (29, low, 41, low + 2.4), (40, 0, 66, 7.8)]
    racks = [*rows([2.8], [(3.2, 30 - head)], depth=2.2), *rows([2.8], [(43.2, 62.5)], depth=2.2)]
    assert found(site(floors, racks))[0] == ["L"] * 8 + ["T"] * 2


@pytest.mark.parametrize(("depth", "aisle", "head"), [(1.2, 3.2, 3.6), (1.2, 4.0, 3.6), (0.9, 4.0, 4.0)])
def test_a_way_leads_past_rows_that_end_alike_before_a_wall_through_which_an_aisle_leads_on(
    depth: float, aisle: float, head: float
) -> None:
    # Behind the gate two rows lie across.
    up, low = 3.0, 3.0 + aisle + depth
    high = up + 2 * depth + 3 * aisle
    floors: list[Box] = [(0, up, 24, high), (23, low, 26, low + aisle), (25, up - 2, 40, high + 2)]
    racks = rows([up + aisle, low + aisle], [(3.2, 24 - head)], depth=depth)
    across: list[Box] = [(28.5, up + 1, 30.5, high - 1), (34, up + 1, 36, high - 1)]
    assert found(site(floors, [*racks, *across]))[0] == ["L"] * 8 + ["T"] * 4 + ["X"]
