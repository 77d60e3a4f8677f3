"""Through glass a lidar sees no wall but a fan of rays, and where there is no floor there is no way."""

from __future__ import annotations

import numpy as np
import pytest

import groundplan

RESOLUTION = 0.05
#: Metres: the hall, and around it.
LENGTH, DEPTH, AROUND = 30.0, 21.0, 9.0


def hall(glass: tuple[float, float] | None, *, is_aisle: bool = False) -> groundplan.Survey:
    """Four rows of racks 1.5 m deep, 3 m from all walls and from one another; the east wall is partly of glass.

    What is seen through it spreads on both sides and ends at the unknown. Or it leads on between racks of which little
    was seen.
    """
    y, x = np.mgrid[-AROUND : DEPTH + AROUND : RESOLUTION, -AROUND : LENGTH + AROUND : RESOLUTION]
    picture = np.full(x.shape, 205, dtype=np.uint8)
    picture[(x > -0.1) & (x < LENGTH + 0.1) & (y > -0.1) & (y < DEPTH + 0.1)] = 0
    picture[(x > 0) & (x < LENGTH) & (y > 0) & (y < DEPTH)] = 254
    for row in range(4):
        low = 3.0 + 4.5 * row
        picture[(x > 3) & (x < LENGTH - 3) & (y > low) & (y < low + 1.5)] = 0
    if glass is not None:
        draw = np.random.default_rng(7)
        off, reach = x - LENGTH, draw.uniform(4.0, 8.0, 400)
        spread = 0.0 if is_aisle else 0.8
        low, high = glass[0] - spread * off, glass[1] + spread * off
        rays = reach[(200 * np.arctan2(y - sum(glass) / 2, off + 1.0) / np.pi).astype(int) % 400]
        picture[(off >= 0) & (off < rays) & (y > low) & (y < high)] = 254
    return groundplan.survey(np.ascontiguousarray(picture[::-1]), resolution=RESOLUTION, origin=(-AROUND, -AROUND))


def meetings(survey: groundplan.Survey) -> list[tuple[str, float, float]]:
    """What the ways make where they meet or end, and where, to half a metre."""
    found = survey.of_kind("junction")
    return sorted((label["type"], *(round(2 * place) / 2 for place in label["at"])) for label in found)


@pytest.mark.parametrize("glass", [(4.0, 10.0), (8.5, 12.0), (1.5, 19.0)])
def test_a_wall_of_glass_is_a_wall(glass: tuple[float, float]) -> None:
    assert meetings(hall(glass)) == meetings(hall(None))


def test_between_racks_of_which_little_was_seen_a_way_leads_on() -> None:
    # In line with the third aisle.
    survey = hall((9.0, 12.0), is_aisle=True)
    assert max(way["axis"][end][0] for way in survey.of_kind("corridor") for end in (0, 1)) > LENGTH + 2


def test_a_corridor_behind_a_door_is_none_of_glass() -> None:
    y, x = np.mgrid[-12.0:12.0:RESOLUTION, -16.0:34.0:RESOLUTION]
    picture = np.full(x.shape, 205, dtype=np.uint8)
    picture[(x > -14.1) & (x < 0) & (abs(y) < 10.1)] = 0
    picture[(x > -14) & (x < -0.1) & (abs(y) < 10)] = 254
    # A door of 2 m, and behind it 20 m of a corridor of 3.4 m, whose end was not seen.
    picture[(x > -0.2) & (x < 20) & (abs(y) < 1)] = 254
    picture[(x > 0) & (x < 20) & (abs(y) < np.minimum(1 + 0.9 * x, 1.7))] = 254
    picture[(x > 0.3) & (x < 20) & (abs(abs(y) - 1.8) < 0.1)] = 0
    survey = groundplan.survey(np.ascontiguousarray(picture[::-1]), resolution=RESOLUTION, origin=(-16, -12))
    assert [[round(x) for x, _ in way["axis"]] for way in survey.of_kind("corridor")] == [[0, 20]]


def behind_a_slit(*, is_walled: bool) -> groundplan.Survey:
    """A room of 6 by 8 m, and 8 m of floor half a metre wide behind a slit in its wall, as rays show it, or walls."""
    y, x = np.mgrid[-6.0:6.0:RESOLUTION, -8.0:14.0:RESOLUTION]
    picture = np.full(x.shape, 205, dtype=np.uint8)
    picture[(x > -6.1) & (x < 0.1) & (abs(y) < 4.1)] = 0
    picture[(x > -6) & (x < 0) & (abs(y) < 4)] = 254
    half = np.clip(0.15 + 0.25 * x, 0.15, 0.275)
    if is_walled:
        picture[(x >= 0) & (x < 8.1) & (abs(y) < half + 0.1)] = 0
    picture[(x > -RESOLUTION) & (x < 8) & (abs(y) < half)] = 254
    return groundplan.survey(np.ascontiguousarray(picture[::-1]), resolution=RESOLUTION)


@pytest.mark.parametrize("is_walled", [False, True])
def test_a_ray_through_a_slit_is_no_room_but_a_narrow_room_is(is_walled: bool) -> None:
    survey = behind_a_slit(is_walled=is_walled)
    found = [len(survey.of_kind(kind)) for kind in ("region", "door")]
    assert found == ([2, 1] if is_walled else [1, 0])
