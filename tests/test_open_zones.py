"""Where racks stand before an open zone, ways lead past the last row into it, and it is no corridor."""

from __future__ import annotations

import pytest
from zoo import FREE, OCCUPIED, UNKNOWN, Canvas, Picture

import groundplan

RESOLUTION = 0.05
#: Metres: aisles and ways across, rows from face to face, racks from end to end.
AISLE, DEPTH, LENGTH = 3.0, 1.0, 12.0


def drawn(
    rows: int, zone: float, degrees: float = 0.0, closed: bool = True, wall: bool = False, gate: bool = False
) -> Picture:
    """Rows of two racks with a way across between them, aisles below and between, and so much floor above.

    The racks are closed and their insides unknown, or each has legs between plates at its ends. Along the last row's
    back may run a wall, with a gate of 2 m in line with the way across or with nothing seen beyond.
    """
    width, height = 3 * AISLE + 2 * LENGTH, rows * (AISLE + DEPTH) + zone
    around = 15.0 if degrees else 0.2
    canvas = Canvas(round((width + 2 * around) / RESOLUTION), round((height + 2 * around) / RESOLUTION)).turn(degrees)
    left = low = around

    def box(x0: float, y0: float, x1: float, y1: float, value: int = OCCUPIED) -> None:
        canvas.box(
            (left + x0) / RESOLUTION, (low + y0) / RESOLUTION, (left + x1) / RESOLUTION, (low + y1) / RESOLUTION, value
        )

    box(-0.2, -0.2, width + 0.2, height + 0.2)
    box(0, 0, width, height, FREE)
    for row in range(rows):
        y = AISLE + row * (AISLE + DEPTH)
        for x in (AISLE, 2 * AISLE + LENGTH):
            box(x, y, x + LENGTH, y + DEPTH)
            if closed:
                box(x + 0.1, y + 0.1, x + LENGTH - 0.1, y + DEPTH - 0.1, UNKNOWN)
            else:
                box(x + 0.1, y, x + LENGTH - 0.1, y + DEPTH, FREE)
                for leg in range(1, 4):
                    for face in (y, y + DEPTH - 0.1):
                        box(x + 3 * leg - 0.05, face, x + 3 * leg + 0.05, face + 0.1)
    if wall:
        back = rows * (AISLE + DEPTH)
        box(0, back, width, back + 0.2)
        if gate:
            box(AISLE + LENGTH + 0.5, back, 2 * AISLE + LENGTH - 0.5, back + 0.2, FREE)
        else:
            box(0, back + 0.2, width, height, UNKNOWN)
    return canvas.picture


def hall(rows: int, zone: float, degrees: float = 0.0, **others: bool) -> groundplan.Survey:
    return groundplan.survey(drawn(rows, zone, degrees, **others), resolution=RESOLUTION)


def kinds(survey: groundplan.Survey) -> list[str]:
    return sorted(junction["type"] for junction in survey.of_kind("junction"))


@pytest.mark.parametrize("degrees", [0.0, 17.0])
@pytest.mark.parametrize("closed", [True, False])
@pytest.mark.parametrize(("rows", "zone"), [(3, 9.5), (2, 14.0), (4, 20.0)])
def test_ways_lead_past_the_last_row_into_the_open(rows: int, zone: float, closed: bool, degrees: float) -> None:
    survey = hall(rows, zone, degrees, closed=closed)
    # Two corners below, where the way across ends too; all else are ways on.
    assert kinds(survey) == sorted(["L", "L", "T"] + ["T", "X", "T"] * (rows - 1))
    corridors = survey.of_kind("corridor")
    assert len(corridors) == rows + 3
    assert all(corridor["width"] == pytest.approx(AISLE, abs=0.25) for corridor in corridors)


@pytest.mark.parametrize("rows", [2, 3])
def test_ways_end_at_the_last_aisle_where_a_wall_runs_behind_its_racks(rows: int) -> None:
    survey = hall(rows, 9.5, wall=True)
    assert kinds(survey) == sorted(["L", "T", "L"] * 2 + ["T", "X", "T"] * (rows - 2))


@pytest.mark.parametrize("zone", [9.0, 12.0])
def test_a_gate_in_a_wall_behind_the_last_row_is_a_door_and_no_way(zone: float) -> None:
    survey = hall(3, zone, wall=True, gate=True)
    assert kinds(survey) == sorted(["L", "T", "L"] * 2 + ["T", "X", "T"])
    assert len(survey.of_kind("door")) == 1


@pytest.mark.parametrize("behind", [0.3, 0.6])
def test_nothing_leads_on_where_the_map_ends_behind_the_last_row(behind: float) -> None:
    picture = drawn(3, 9.0)[round((9.2 - behind) / RESOLUTION) :]
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    top = picture.shape[0] * RESOLUTION
    assert all(0 < y < top for corridor in survey.of_kind("corridor") for _, y in corridor["axis"])
    assert kinds(survey) == sorted(["L", "T", "L"] * 2 + ["T", "X", "T"])


@pytest.mark.parametrize(("behind", "leads_on"), [(0.5, True), (1.5, True), (-0.6, False)])
def test_ways_lead_on_through_the_last_row_where_what_lies_behind_was_not_seen(behind: float, leads_on: bool) -> None:
    picture = drawn(3, 9.0)
    # The lowest row is the picture's last.
    picture[: round((9.2 - behind) / RESOLUTION), round(0.3 / RESOLUTION) : -round(0.3 / RESOLUTION)] = UNKNOWN
    survey = groundplan.survey(picture, resolution=RESOLUTION)
    way = [junction["type"] for junction in survey.of_kind("junction") if junction["at"][1] > 2 * (AISLE + DEPTH)]
    assert ("X" in way) == leads_on


@pytest.mark.parametrize("zone", [9.0, 11.0, 14.0])
def test_what_is_wider_than_corridors_may_be_is_none(zone: float) -> None:
    survey = hall(3, zone)
    assert all(corridor["width"] < AISLE + 0.5 for corridor in survey.of_kind("corridor"))
