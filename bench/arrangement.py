"""The arrangement with full subdivision: what a face costs, how that grows, and how shapely fares on the same lines.

Medians; the two of a ratio are measured in turns in one run. Ends with exit code 1 when a bar is missed: at most 0.6 us
a face at a million faces, that at most 1.5 times what one of ten thousand costs, and 40 times faster than shapely's
``unary_union`` and ``polygonize`` on 200 + 200 lines. Needs shapely.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import time
from collections.abc import Callable

import numpy as np

import groundplan
from groundplan import Directions, Lines, Map

SIDE, RESOLUTION = 4000, 0.05
#: Lines a direction, for two directions to four.
COUNTS = {2: (10, 30, 100, 200, 500, 1000, 2000), 3: (10, 100, 500), 4: (10, 100, 400)}
ANGLES_DEG = (10.0, -80.0, 55.0, -35.0)
US_A_FACE, GROWTH, AGAINST_SHAPELY = 0.6, 1.5, 40.0

Input = tuple[Map, Directions, Lines]


def case(directions: int, count: int) -> Input:
    """Lines of some directions at random offsets, near enough to the middle that all of them cross in the map."""
    map = groundplan.from_array(np.full((SIDE, SIDE), 254, dtype=np.uint8), RESOLUTION)
    random = np.random.default_rng(count)
    given = Directions.of(np.radians(ANGLES_DEG[:directions]))
    centre = SIDE * RESOLUTION / 2
    middles = centre * (np.cos(given.angles) - np.sin(given.angles))
    offsets = [m + np.sort(random.uniform(-0.6, 0.6, count)) * centre for m in middles]
    return map, given, Lines.of(np.repeat(np.arange(directions), count), np.concatenate(offsets))


def median(*tasks: Callable[[], object], runs: int) -> list[float]:
    """Median seconds of each task, run in turns so that what else the computer does falls on all of them alike."""
    times: list[list[float]] = [[] for _ in tasks]
    for _ in range(runs):
        for spent, task in zip(times, tasks, strict=True):
            start = time.perf_counter()
            task()
            spent.append(time.perf_counter() - start)
    return [statistics.median(spent) for spent in times]


def with_shapely(given: Input) -> int:
    """The faces that shapely makes of the same lines and the map's border."""
    import shapely

    _, directions, lines = given
    side = SIDE * RESOLUTION
    box = shapely.box(0, 0, side, side)
    angles = directions.angles[lines.directions]
    along = np.column_stack([np.cos(angles), np.sin(angles)]) * 2 * side
    foot = np.column_stack([-np.sin(angles), np.cos(angles)]) * lines.offsets[:, None]
    pieces = shapely.intersection(shapely.linestrings(np.stack([foot - along, foot + along], axis=1)), box)
    noded = shapely.union_all([*pieces, box.exterior])
    return len(shapely.get_parts(shapely.polygonize(shapely.get_parts(noded))))


def main() -> int:
    """Measure, print the table, hold it to the bars."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    cost: dict[tuple[int, int], float] = {}
    print("directions  lines each      faces        ms  us a face")
    for directions, counts in COUNTS.items():
        for count in counts:
            given = case(directions, count)
            faces = len(groundplan.subdivide(*given).areas)
            (seconds,) = median(lambda given=given: groundplan.subdivide(*given), runs=5 if faces > 200_000 else 25)
            cost[directions, count] = seconds / faces * 1e6
            print(f"{directions:10}  {count:10}  {faces:9,}  {seconds * 1e3:8.2f}  {cost[directions, count]:9.3f}")

    small, large, crossing = case(2, 100), case(2, 1000), case(2, 200)
    ten, million = median(lambda: groundplan.subdivide(*small), lambda: groundplan.subdivide(*large), runs=9)
    faces = {name: len(groundplan.subdivide(*given).areas) for name, given in (("ten", small), ("million", large))}
    growth = (million / faces["million"]) / (ten / faces["ten"])
    ours, theirs = median(lambda: groundplan.subdivide(*crossing), lambda: with_shapely(crossing), runs=3)
    same = with_shapely(crossing) == len(groundplan.subdivide(*crossing).areas)
    bars = [
        ("us a face at a million faces", million / faces["million"] * 1e6, US_A_FACE, False),
        ("that over us a face at ten thousand", growth, GROWTH, False),
        ("times faster than shapely, 200 + 200 lines", theirs / ours, AGAINST_SHAPELY, True),
    ]
    print()
    missed = not same
    for name, value, bar, least in bars:
        met = value >= bar if least else value <= bar
        missed |= not met
        print(f"{name:44}{value:9.3f}  bar {'>=' if least else '<='} {bar:g}{'' if met else '  MISSED'}")
    print(f"{'faces are as many as shapely makes':44}{'yes' if same else 'NO':>9}")
    return int(missed)


if __name__ == "__main__":
    sys.exit(main())
