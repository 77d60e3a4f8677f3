"""What every format costs for a survey of a hundred thousand faces: seconds, and megabytes written."""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path

import numpy as np

import groundplan
from groundplan import Directions, FormatError, Lines, from_array
from groundplan.export import FORMATS

LINES = 318


def main() -> None:
    """Cut an empty hall by lines a hand's breadth apart, and write it in every format."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    offsets = np.linspace(0.05, 34.9, LINES)
    directions = Directions(np.array([0.0, -np.pi / 2]), np.ones(2), np.zeros(360), 1.0)
    which = np.repeat(np.array([0, 1], dtype=np.uint32), LINES)
    lines = Lines(which, np.tile(offsets, 2), np.ones(2 * LINES), np.full(2 * LINES, 0.02), 1.0)
    map = from_array(np.full((700, 700), 254, np.uint8), 0.05)
    survey = groundplan.survey(map, directions=directions, lines=lines)
    print(f"{len(survey.subdivision.areas)} faces")
    with tempfile.TemporaryDirectory() as directory:
        for name, form in FORMATS.items():
            more = [("", {}), (" of faces", {"graph": "faces"})] if "graph" in form.options else [("", {})]
            for what, chosen in more:
                options = chosen | ({"map": map} if form.map != "no" else {})
                start = time.perf_counter()
                try:
                    written = survey.export(Path(directory) / name / "x", form.name, **options)
                except FormatError as refused:  # an empty hall has no roads
                    print(f"{name + what:<20} {refused}")
                    continue
                size = sum(file.stat().st_size for file in written) / 1e6
                print(f"{name + what:<20} {time.perf_counter() - start:7.2f} s {size:8.2f} MB")


if __name__ == "__main__":
    main()
