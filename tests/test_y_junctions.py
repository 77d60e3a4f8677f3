"""Y junctions: three arms that are not square, mapped by the simulated robot and held against the truth."""

from __future__ import annotations

import math

import pytest

import groundplan
from groundplan.evaluate import score
from groundplan.simulate import Simulated, WarehouseOptions, _simulated
from groundplan.simulate._plan import Corridor, Face, GroundPlan, Point

WALL = 0.25


def three_arms(degrees: tuple[float, float, float], length: float = 14.0, width: float = 3.0) -> Simulated:
    """Three corridors from one place, closed at their ends; the angles ascend."""
    headings = [math.radians(a) for a in degrees]
    reach = length + 2
    box: list[Point] = [(-reach, -reach), (reach, -reach), (reach, reach), (-reach, reach)]
    ends = [(length * math.cos(a), length * math.sin(a)) for a in headings]
    ways = [Corridor((0.0, 0.0), end, width) for end in ends]
    plan = GroundPlan([(a + math.pi / 2) % math.pi - math.pi / 2 for a in headings], box, corridors=ways)

    def wall(p: Point, q: Point, outward: Point, beyond: float = 0.0) -> None:
        plan.faces.append(Face("wall", p, q, outward))
        shift = beyond * outward[1], -beyond * outward[0]
        plan.slab((p[0] + shift[0], p[1] + shift[1]), (q[0] - shift[0], q[1] - shift[1]), WALL, outward)

    def beside(n: int, side: float) -> Point:
        a = headings[n]
        return ends[n][0] - side * width / 2 * math.sin(a), ends[n][1] + side * width / 2 * math.cos(a)

    for n, a in enumerate(headings):
        following = (n + 1) % 3
        b = headings[following]
        half = (b - a) % (2 * math.pi) / 2
        corner = (width / 2 / math.sin(half) * math.cos(a + half), width / 2 / math.sin(half) * math.sin(a + half))
        wall(corner, beside(n, 1.0), (math.sin(a), -math.cos(a)))
        wall(beside(following, -1.0), corner, (-math.sin(b), math.cos(b)))
        wall(beside(n, 1.0), beside(n, -1.0), (-math.cos(a), -math.sin(a)), WALL)
    return _simulated(plan, WarehouseOptions(), seed=1)


@pytest.mark.parametrize("degrees", [(10.0, 130.0, 250.0), (0.0, 135.0, 225.0), (20.0, 125.0, 255.0)])
def test_three_arms_that_are_not_square_are_a_y(degrees: tuple[float, float, float]) -> None:
    made = three_arms(degrees)
    assert [(j["type"], j["observed"]) for j in made.truth["junctions"]] == [("Y", True)]
    survey = groundplan.survey(made.map)
    assert score(survey.to_dict(), made.truth)["junction_typed_f1"] == 1.0
    (junction,) = (label for label in survey.of_kind("junction") if label["type"] != "end")
    assert junction["type"] == "Y" and len(junction["corridors"]) == 3


@pytest.mark.parametrize("turn", [70.0, 90.0])
def test_two_arms_in_line_and_one_nearly_square_to_them_are_none(turn: float) -> None:
    made = three_arms((0.0, turn, 180.0))
    assert [j["type"] for j in made.truth["junctions"]] == ["T"]
    types = [label["type"] for label in groundplan.survey(made.map).of_kind("junction")]
    assert types.count("T") == 1 and "Y" not in types


def test_two_arms_in_line_and_one_askew_to_them_are_a_y() -> None:
    made = three_arms((0.0, 60.0, 180.0))
    assert [j["type"] for j in made.truth["junctions"]] == ["Y"]
    types = [label["type"] for label in groundplan.survey(made.map).of_kind("junction")]
    assert types.count("Y") == 1 and "T" not in types
