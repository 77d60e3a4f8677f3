"""Asking a survey of 40,000 faces: where a point is, what is there, and the way from one place to another.

The map is drawn here: a hall of 200 m by 200 m at 5 cm, rows of racks with rough fronts, goods in the aisles, cut by
199 lines a direction. Each number is a median over random points, called from Python one by one. Ends with exit code 1
when a bar is missed: at most 2 us for ``locate``, at most 5 ms for ``route``.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import time
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

import groundplan
from groundplan import Directions, Lines, Map, ParameterError, Survey

SIDE, RESOLUTION, LINES = 4000, 0.05, 199
CLEARANCE = 0.4
LOCATE_US, ROUTE_MS = 2.0, 5.0


def hall() -> Map:
    """Racks 1.1 m deep and 24 m long, aisles of 3 m, cross aisles of 4 m; fronts that waver by a pixel; pallets."""
    random = np.random.default_rng(7)
    pixels = np.full((SIDE, SIDE), 254, dtype=np.uint8)
    for start in range(60, SIDE - 100, 82):
        for left in range(80, SIDE - 500, 560):
            for x in range(left, left + 480, 4):
                low, high = random.integers(0, 2, 2)
                pixels[start + low : start + 22 - high, x : x + 4] = 0
    for y, x in random.integers(0, SIDE - 20, (1500, 2)):
        pixels[y : y + 16, x : x + 20] = 0
    pixels[:4] = pixels[-4:] = 0
    pixels[:, :4] = pixels[:, -4:] = 0
    return groundplan.from_array(pixels, RESOLUTION)


def surveyed(map: Map) -> Survey:
    """Cut by lines of our own, so that there are as many faces as there should be."""
    offsets = np.linspace(0, SIDE * RESOLUTION, LINES + 2)[1:-1]
    lines = Lines.of(np.repeat([0, 1], LINES), np.tile(offsets, 2))
    return groundplan.survey(map, directions=Directions.of([0.0, -np.pi / 2]), lines=lines)


def each(task: Callable[..., object], asked: Iterable[tuple[Any, ...]]) -> list[float]:
    """Seconds of each call."""
    times = []
    for arguments in asked:
        start = time.perf_counter()
        task(*arguments)
        times.append(time.perf_counter() - start)
    return times


def main() -> int:
    """Measure, print the table, hold it to the bars."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    map = hall()
    survey = surveyed(map)
    size = SIDE * RESOLUTION
    random = np.random.default_rng(1)
    points = [tuple(point) for point in (random.random((20_000, 2)) * size).tolist()]
    print(f"{len(survey.subdivision.areas):,} faces, {len(survey.labels)} labels, {SIDE} x {SIDE} pixels")

    (index,) = each(survey.locate, points[:1])
    # In loops of a thousand, so that the clock itself is not what is measured.
    loops = [
        each(lambda part: [survey.locate(x, y) for x, y in part], [(points[n : n + 1000],)])
        for n in range(0, 20_000, 1000)
    ]
    locate = statistics.median(loop[0] for loop in loops) / 1000 * 1e6
    x, y = np.array(points).T
    many = statistics.median(each(survey.locate, [(x, y)] * 5)) / len(points) * 1e6
    labels = statistics.median(each(survey.labels_at, points)) * 1e6

    def standing() -> tuple[float, float]:
        while True:
            point: tuple[float, float] = tuple((random.random(2) * size).tolist())  # type: ignore[assignment]
            try:
                survey.route(point, point, clearance=CLEARANCE)
            except ParameterError:
                continue
            return point

    (first,) = each(lambda: standing(), [()])
    ends = [(standing(), standing()) for _ in range(200)]
    route = [s * 1e3 for s in each(lambda a, b: survey.route(a, b, clearance=CLEARANCE), ends)]
    median_route = statistics.median(route)
    rows = [
        ("locate", f"{locate:8.2f} us", f"<= {LOCATE_US:g} us", locate <= LOCATE_US),
        ("locate, 20,000 points at once, each", f"{many:8.2f} us", "", True),
        ("labels_at", f"{labels:8.2f} us", "", True),
        ("route", f"{median_route:8.2f} ms", f"<= {ROUTE_MS:g} ms", median_route <= ROUTE_MS),
        ("route, the slowest of 20", f"{statistics.quantiles(route, n=20)[-1]:8.2f} ms", "", True),
        ("the first locate: the index", f"{index * 1e3:8.2f} ms", "", True),
        ("the first route: the free space", f"{first * 1e3:8.2f} ms", "", True),
    ]
    for name, value, bar, met in rows:
        print(f"{name:38}{value}  {bar}{'' if met else '  MISSED'}".rstrip())
    return int(not all(met for *_, met in rows))


if __name__ == "__main__":
    sys.exit(main())
