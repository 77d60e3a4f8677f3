"""Halls drawn as plainly as can be have the junctions and racks that a person counts: those of bench/plain.py."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest

import groundplan

_path = Path(__file__).resolve().parent.parent / "bench" / "plain.py"
_spec = importlib.util.spec_from_file_location("plain", _path)
assert _spec is not None and _spec.loader is not None
plain = importlib.util.module_from_spec(_spec)
sys.modules["plain"] = plain
_spec.loader.exec_module(plain)


@pytest.mark.parametrize("seed", range(32))
def test_a_plain_hall_has_the_junctions_of_its_plan(seed: int) -> None:
    hall = plain.hall(seed)
    plan, found = plain.planned(hall), plain.found(seed)
    assert {kind: found[kind] for kind in plain.KINDS} == {kind: plan[kind] for kind in plain.KINDS}


def is_right_as_hit(seed: int) -> bool:
    """Whether it has them where a lidar misses one pixel in five."""
    plan, found = plain.planned(plain.hall(seed)), plain.found_as_hit(seed)
    return all(found[kind] == plan[kind] for kind in plain.KINDS)


def test_most_have_them_where_a_lidar_misses_one_pixel_in_five() -> None:
    assert np.mean([is_right_as_hit(seed) for seed in range(48)]) >= 0.9


@pytest.mark.parametrize("seed", [44, 74, 184, 270, 306])
def test_aisles_end_at_a_wall_one_pixel_thick_of_which_a_fifth_was_not_hit(seed: int) -> None:
    assert plain.planned(plain.hall(seed))["end"] > 0
    assert is_right_as_hit(seed)


@pytest.mark.parametrize("seed", [8, 50, 66, 158, 221, 248, 294])
def test_no_way_leads_within_or_through_an_outline_of_which_a_fifth_was_not_hit(seed: int) -> None:
    assert plain.hall(seed).look == "hollow"
    assert is_right_as_hit(seed)


def test_racks_in_plain_halls_are_counted_and_sure() -> None:
    alike, sure = [], []
    for seed in range(64):
        hall = plain.hall(seed)
        plan = plain.planned(hall)
        # Few do not make a place of racks.
        if plan["rack"] < plain.RACKS:
            continue
        survey = groundplan.survey(plain.picture(hall), resolution=hall.resolution, threads=1)
        alike.append(len(survey.of_kind("rack")) == plan["rack"])
        sure += [rack["confidence"] > 0.5 for rack in survey.of_kind("rack")]
    assert len(alike) >= 40
    assert np.mean(alike) >= 0.9
    assert np.mean(sure) >= 0.9
