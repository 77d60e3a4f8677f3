"""The example is what the simulator makes."""

from __future__ import annotations

import json
from pathlib import Path

from groundplan.simulate import warehouse

EXAMPLES = Path(__file__).parents[1] / "examples"


def test_the_example_is_made_by_the_options_that_it_states(tmp_path: Path) -> None:
    truth = json.loads((EXAMPLES / "truth.json").read_text(encoding="utf-8"))
    options = truth["options"] | {"closed_sides": tuple(truth["options"]["closed_sides"])}
    warehouse(seed=truth["seed"], **options).write(tmp_path)
    for name in ("truth.json", "warehouse.pgm", "warehouse.yaml"):
        assert (tmp_path / name).read_bytes() == (EXAMPLES / name).read_bytes(), name
