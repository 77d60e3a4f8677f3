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


def test_most_have_them_where_a_lidar_misses_one_pixel_in_five() -> None:
    def is_right(seed: int) -> bool:
        plan, found = plain.planned(plain.hall(seed)), plain.found_as_hit(seed)
        return all(found[kind] == plan[kind] for kind in plain.KINDS)

    assert np.mean([is_right(seed) for seed in range(48)]) >= 0.85


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
