"""What furniture leaves free of a room is no aisle."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

import groundplan

RESOLUTION = 0.05


def furnished_room(table: int) -> npt.NDArray[np.uint8]:
    """A room of 12 m by 7 m and in it, 2 m off a wall, tables of so many pixels every 2.4 m, 0.8 m deep."""
    picture = np.full((280, 180), 205, np.uint8)
    picture[18:262, 18:162] = 0
    picture[20:260, 20:160] = 254
    for y in range(30, 250, 48):
        end = min(y + table, 260)
        picture[y:end, 104:120] = 0
        picture[y + 1 : end - 1, 105:119] = 205
    return picture


def test_what_furniture_leaves_free_along_a_wall_of_a_room_is_no_aisle() -> None:
    assert not groundplan.survey(furnished_room(22), resolution=RESOLUTION).of_kind("corridor")
    (aisle,) = groundplan.survey(furnished_room(44), resolution=RESOLUTION).of_kind("corridor")
    assert np.hypot(*np.subtract(*aisle["axis"])) > 10.0
