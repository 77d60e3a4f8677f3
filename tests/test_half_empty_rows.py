"""Small halls of which more than half of the bays are empty: posts that are seen at empty bays tell where bays are."""

from __future__ import annotations

from typing import Any

import pytest

import groundplan
from groundplan.evaluate import score
from groundplan.simulate import warehouse

SCANNED: dict[str, Any] = {"scan_every": 0.8, "beams": 400, "drift": 0.0, "cross_aisles": 1}
HALLS: dict[str, dict[str, Any]] = {
    "three-rows": {
        "seed": 43,
        "width": 26,
        "depth": 20,
        "aisle": 3.2,
        "cross_aisle": 3.2,
        "bay": 2.78,
        "rack_depth": 1.14,
    }
    | {"sparse": 0.65, "yaw": 15.8},
    "shallow-racks": {"seed": 82, "width": 26, "depth": 20, "aisle": 3.6, "cross_aisle": 3.5, "bay": 3.47}
    | {"rack_depth": 0.89, "sparse": 0.6, "yaw": -54.9},
    "two-halls": {
        "seed": 5,
        "width": 40,
        "depth": 20,
        "aisle": 3.2,
        "cross_aisle": 4.3,
        "bay": 3.69,
        "rack_depth": 1.17,
    }
    | {"sparse": 0.65, "yaw": 44.2, "halls": 2, "gap": 0.5},
}


@pytest.mark.parametrize("name", HALLS)
def test_aisles_and_crossings_of_half_empty_halls_are_found(name: str) -> None:
    simulated = warehouse(**(SCANNED | HALLS[name]))
    found = score(groundplan.survey(simulated.map).to_dict(), simulated.truth)
    assert found["junction_typed_f1"] == 1 and found["corridor_recall"] > 0.95
