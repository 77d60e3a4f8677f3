"""Passages that bend between a hall and a wing that is turned: their last walls are too short to be lines."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest
from zoo import FREE, OCCUPIED, Canvas

import groundplan

Picture = npt.NDArray[np.uint8]

RESOLUTION = 0.05
WALL = 4


class Plan:
    """Floors and racks along one direction each, pixels from a corner; walls come around all floors together."""

    def __init__(self, width: int, height: int) -> None:
        self.canvas = Canvas(width, height)
        self.bars: list[tuple[tuple[float, float], float, float, float]] = []

    def floor(self, corner: tuple[float, float], degrees: float, length: float, width: float) -> None:
        """A floor of which one side is so long, along a direction, and lies to the right of it."""
        sin, cos = np.sin(np.radians(degrees)), np.cos(np.radians(degrees))
        self.bars.append(((corner[0] - width / 2 * sin, corner[1] + width / 2 * cos), degrees, length, width))

    def drawn(self, racks: Plan) -> Picture:
        """The floors, with what stands on them."""
        for (x, y), degrees, length, width in self.bars:
            back = WALL * np.cos(np.radians(degrees)), WALL * np.sin(np.radians(degrees))
            self.canvas.bar((x - back[0], y - back[1]), degrees, length + 2 * WALL, width + 2 * WALL)
        for value, bars in ((FREE, self.bars), (OCCUPIED, racks.bars)):
            for bar in bars:
                self.canvas.bar(*bar, value)
        return self.canvas.picture


def joined_by_a_bend(turn: float, leg: float, wall: float | None = None, first: float = 240) -> Picture:
    """A hall of four aisles, and one of three that is turned; a passage leads from the one, bends, and after so many
    pixels between walls opens into the side of the other's last aisle. A thin wall may close it, askew by so much. From
    the first hall's wall to the bend's middle it is as long as is asked for."""
    floors, racks = Plan(1250, 1000), Plan(1250, 1000)
    floors.floor((20, 340), 0, 400, 360)
    for y in (400, 500, 600):
        racks.floor((80, y), 0, 280, 40)
    along = np.array([np.cos(np.radians(turn)), np.sin(np.radians(turn))])
    across = np.array([-along[1], along[0]])
    bend = np.array([420 + first, 520])
    corner = bend - 200 * along - (320 + leg) * across

    def at(u: float, v: float) -> tuple[float, float]:
        x, y = corner + u * along + v * across
        return float(x), float(y)

    floors.floor((400, 490), 0, 20 + first + 30 * np.tan(np.radians(90 - turn) / 2), 60)
    floors.floor(at(0, 0), turn, 500, 320)
    floors.floor(at(170, 300), turn, 60, 20 + leg + 30 * np.tan(np.radians(90 - turn) / 2))
    for v in (80, 200):
        racks.floor(at(60, v), turn, 380, 40)
    if wall is not None:
        left, low = at(200, 320 + leg / 2)
        askew = np.radians(turn + wall)
        start = (float(left - 50 * np.cos(askew)), float(low - 50 * np.sin(askew)))
        racks.bars.append((start, turn + wall, 100, 3))
    return floors.drawn(racks)


@pytest.mark.parametrize(("turn", "leg"), [(40, 50), (30, 60), (52, 70)])
def test_a_passage_leads_round_its_bend_into_the_wing(turn: float, leg: float) -> None:
    survey = groundplan.survey(joined_by_a_bend(turn, leg), resolution=RESOLUTION)
    junctions = survey.of_kind("junction")
    assert sorted(junction["type"] for junction in junctions) == ["L"] * 9 + ["T"] * 8
    bends = [junction for junction in junctions if np.hypot(*np.subtract(junction["at"], (33, 26))) < 0.75]
    assert [junction["type"] for junction in bends] == ["L"]


@pytest.mark.parametrize("first", [50, 70, 90])
@pytest.mark.parametrize(("turn", "leg"), [(40, 70), (52, 90)])
def test_a_passage_that_turns_soon_on_both_sides_is_one(turn: float, leg: float, first: float) -> None:
    survey = groundplan.survey(joined_by_a_bend(turn, leg, first=first), resolution=RESOLUTION)
    bend = ((420 + first) * RESOLUTION, 26)
    near = [junction for junction in survey.of_kind("junction") if np.hypot(*np.subtract(junction["at"], bend)) < 0.75]
    assert [junction["type"] for junction in near] == ["L"]


@pytest.mark.parametrize("wall", [0, 30, 45])
def test_a_wall_closes_what_follows_a_bend_be_it_askew(wall: float) -> None:
    survey = groundplan.survey(joined_by_a_bend(40, 90, wall), resolution=RESOLUTION)
    beyond = np.array((33, 26)) - 4.5 * np.array((np.cos(np.radians(130)), np.sin(np.radians(130))))
    for way in survey.of_kind("corridor"):
        start, end = np.array(way["axis"])
        along = (end - start) / np.linalg.norm(end - start)
        # None leads along the leg up to the wing.
        is_along = abs(along @ np.array((np.cos(np.radians(130)), np.sin(np.radians(130))))) > 0.99
        near = start + np.clip((beyond - start) @ along, 0, np.linalg.norm(end - start)) * along
        assert not is_along or np.linalg.norm(near - beyond) > 1
