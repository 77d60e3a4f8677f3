"""Names, as statements about places that are mapped again."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import groundplan
from groundplan import simulate
from groundplan.evaluate._names import name_scores

SMALL: dict[str, Any] = {"scan_every": 0.6, "beams": 480}


def surveyed(made: simulate.Simulated, square: float = 4.0) -> tuple[dict[str, Any], dict[str, Any]]:
    return groundplan.survey(made.map, labels_square=square).to_dict(), made.truth


def test_aisles_racks_and_regions_of_a_warehouse_keep_their_names_when_it_is_mapped_again() -> None:
    place: dict[str, Any] = {"width": 26.0, "depth": 20.0, "seed": 7} | SMALL
    first = surveyed(simulate.warehouse(**place))
    again = [surveyed(simulate.warehouse(remake=k, yaw=yaw, **place)) for k, yaw in ((1, 0.5), (2, -0.5))]
    scores = name_scores(*first, again)
    assert scores["names_aisles"] >= 0.9 and scores["names_regions"] == 1.0
    assert scores["names_racks"] >= 0.8


def test_all_names_of_aisles_and_regions_hold_where_no_middle_lies_on_a_square_s_side() -> None:
    place: dict[str, Any] = {"width": 26.0, "depth": 20.0, "seed": 7} | SMALL
    first = surveyed(simulate.warehouse(**place), 5.0)
    again = [surveyed(simulate.warehouse(remake=k, yaw=yaw, **place), 5.0) for k, yaw in ((1, 0.5), (2, -0.5))]
    scores = name_scores(*first, again)
    assert scores["names_aisles"] == scores["names_regions"] == 1.0


def test_an_aisle_that_goes_renames_no_other() -> None:
    def aisles(*filled: int) -> dict[str, float]:
        """The aisles of a hall by their names, and how far up they lie; those between some racks are filled."""
        pixels = np.full((580, 720), 254, np.uint8)
        pixels[:4] = pixels[-4:] = pixels[:, :4] = pixels[:, -4:] = 0
        for n in range(5):
            pixels[60 + 104 * n : 104 + 104 * n + 60 * (n in filled), 80:640] = 0
        ways = groundplan.survey(pixels, resolution=0.05).of_kind("corridor")
        return {way["name"]: way["axis"][0][1] for way in ways if way["name"][0] == "A"}

    whole = aisles()
    assert len(whole) == 6
    for filled in range(4):
        fewer = aisles(filled)
        assert len(fewer) == 5
        assert fewer == pytest.approx({name: whole[name] for name in fewer}, abs=0.1)


def test_rooms_keep_their_names_when_an_office_is_mapped_again_even_on_its_diagonal() -> None:
    place: dict[str, Any] = {"shape": "L", "furniture": 0.2, "seed": 5} | SMALL
    first = surveyed(simulate.office(yaw=44.8, **place))
    scores = name_scores(*first, [surveyed(simulate.office(yaw=45.3, remake=1, **place))])
    assert scores["names_regions"] >= 0.95


def test_a_remake_is_the_same_place_with_some_goods_elsewhere() -> None:
    place: dict[str, Any] = {"width": 26.0, "depth": 20.0, "drift": 0.0, "noise": 0.0, "seed": 3} | SMALL
    first, same, moved = (simulate.warehouse(remake=k, moved=m, **place) for k, m in ((0, 0.0), (1, 0.0), (1, 0.5)))
    assert first.truth["lines"] == same.truth["lines"]
    assert np.mean(first.map.pixels != same.map.pixels) < 0.005
    assert first.map.pixels.shape != moved.map.pixels.shape or np.mean(first.map.pixels != moved.map.pixels) > 0.01
    assert first.truth["corridors"] == moved.truth["corridors"]


def room(name: str, low: float, high: float) -> dict[str, Any]:
    return {"kind": "region", "name": name, "polygon": [[low, 0.0], [high, 0.0], [high, 4.0], [low, 4.0]]}


def test_a_name_that_went_to_another_room_does_not_count_as_kept() -> None:
    first = {"labels": [room("R1-01", 0, 4), room("R1-02", 4, 8)]}
    again = {"labels": [room("R1-02", 0, 4), room("R1-01", 4, 8)]}
    truth = {"frame": [0.0, 0.0, 0.0]}
    scores = name_scores(first, truth, [(again, truth)])
    assert (scores["names_regions"], scores["found_regions"], scores["names_aisles"]) == (0.0, 1.0, None)


@pytest.mark.parametrize("lost", [[], [room("R1-01", 0, 4)]])
def test_a_room_that_is_not_found_again_has_not_kept_its_name(lost: list[dict[str, Any]]) -> None:
    first = {"labels": [room("R1-01", 0, 4), room("R1-02", 4, 8)]}
    truth = {"frame": [0.0, 0.0, 0.0]}
    scores = name_scores(first, truth, [({"labels": lost}, truth)])
    assert scores["names_regions"] == scores["found_regions"] == len(lost) / 2


def test_rooms_are_paired_in_the_ground_plan_however_the_map_lies() -> None:
    first = {"labels": [room("R1-01", 0, 4), room("R1-02", 4, 8)]}
    c, s = math.cos(0.4), math.sin(0.4)
    turned = [
        label | {"polygon": [[c * x - s * y + 7, s * x + c * y - 2] for x, y in label["polygon"]]}
        for label in first["labels"]
    ]
    scores = name_scores(first, {"frame": [0.0, 0.0, 0.0]}, [({"labels": turned}, {"frame": [7.0, -2.0, 0.4]})])
    assert scores["names_regions"] == 1.0
