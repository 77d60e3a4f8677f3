"""Plain halls, drawn without noise, and as a lidar hits them: bench/plain.py [FIRST [COUNT]].

The least that one may ask of a survey: a closed hall with blocks of racks in rows, aisles between them, ways across
between the blocks and past the last ones. What a person would count is known from the plan. Every measure comes from
the hall's seed: widths, depths and lengths, alike or each its own, racks at the long walls or aisles, a hall whose last
block leans on a wall, turned or along the pixels, 2.5 to 10 cm; racks are solid, or outlines of what nobody saw, or
outlines of floor, and deep ones may have a flue. The tables have how many of COUNT (400) halls from the seeds FIRST (0)
on have other junctions than the plan, and how many another number of racks where it has three or more: as they are
drawn, and as a lidar hits them, which sees the first pixel of what stands and misses one in five. Then those with other
junctions as they are drawn. No bar, so no exit code.
"""

from __future__ import annotations

import argparse
import math
import random
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, fields
from multiprocessing import get_context

import numpy as np
import numpy.typing as npt

import groundplan
from groundplan._cli.arguments import count
from groundplan.maps import FREE, OCCUPIED, UNKNOWN

GREYS = {FREE: 254, OCCUPIED: 0, UNKNOWN: 205}
#: Metres: how thick walls are, and how deep racks along them; the unknown around.
WALL, AT_WALL, AROUND = 0.15, 1.0, 2.0
#: The sides of a rack that is no more than its outline, metres, or so many pixels.
SIDE, SIDE_PIXELS = 0.06, 1.5
#: Rows this deep may be of racks back to back, metres.
BACK_TO_BACK = 1.3
#: So many racks make a place of racks.
RACKS = 3
#: What a lidar misses of what it could hit.
MISSED = 0.2
KINDS = ("L", "T", "X", "Y", "end")
#: So many halls are named.
NAMED = 30


@dataclass(frozen=True)
class Hall:
    """What is drawn at random; metres, degrees."""

    aisles: list[float]
    depths: list[float]
    lengths: list[float]
    gaps: list[float]
    look: str
    at_walls: str
    ends: str
    turn: float
    resolution: float
    corner: tuple[float, float]  # of the hall on its first pixel, shares of it
    flue: float  # between racks that stand back to back, where a row is deep enough


def hall(seed: int) -> Hall:
    """The hall of a seed."""
    draw = random.Random(seed)
    rows, blocks = draw.choice([1, 2, 3, 4, 6]), draw.choice([1, 2, 3, 4])
    aisle, gap, depth = draw.uniform(1.4, 4.5), draw.uniform(1.9, 4.5), draw.uniform(0.4, 2.6)
    length, spread = max(draw.uniform(6, 24), 2.5 * aisle), draw.choice([0.0, 0.0, 0.3])

    def some(metres: float, count: int) -> list[float]:
        return [metres * (1 + draw.uniform(-spread, spread)) for _ in range(count)]

    return Hall(
        aisles=some(aisle, rows + 1),
        depths=some(depth, rows),
        lengths=some(length, blocks),
        gaps=some(gap, blocks + 1),
        look=draw.choice(["solid", "unseen", "hollow"]),
        at_walls=draw.choice(["aisles", "racks"]),
        ends=draw.choice(["ways", "ways", "a wall"]),
        turn=draw.choice([0.0, 0.0, draw.uniform(-45, 45)]),
        resolution=draw.choice([0.025, 0.05, 0.05, 0.1]),
        corner=(draw.random(), draw.random()),
        flue=draw.choice([0.0, 0.24]),
    )


def picture(hall: Hall) -> npt.NDArray[np.uint8]:
    """The hall as a map."""
    pixel, rim = hall.resolution, AT_WALL if hall.at_walls == "racks" else 0.0
    gaps = hall.gaps if hall.ends == "ways" else [*hall.gaps[:-1], 0.0]
    wide, deep = sum(hall.lengths) + sum(gaps), sum(hall.aisles) + sum(hall.depths) + 2 * rim
    cos, sin = math.cos(math.radians(hall.turn)), math.sin(math.radians(hall.turn))
    columns = int((abs(wide * cos) + abs(deep * sin) + 2 * AROUND) / pixel)
    rows = int((abs(wide * sin) + abs(deep * cos) + 2 * AROUND) / pixel)
    y, x = np.mgrid[:rows, :columns].astype(float)
    x = (x + 0.5 + hall.corner[0] - columns / 2) * pixel
    y = (y + 0.5 + hall.corner[1] - rows / 2) * pixel
    u, v = x * cos + y * sin + wide / 2, y * cos - x * sin + deep / 2
    drawn = np.full((rows, columns), GREYS[UNKNOWN], dtype=np.uint8)

    def fill(x0: float, x1: float, y0: float, y1: float, state: int) -> None:
        drawn[(u > x0) & (u < x1) & (v > y0) & (v < y1)] = GREYS[state]

    def rack(x0: float, x1: float, y0: float, y1: float) -> None:
        fill(x0, x1, y0, y1, OCCUPIED)
        if hall.look != "solid":
            by = max(SIDE, SIDE_PIXELS * pixel)
            fill(x0 + by, x1 - by, y0 + by, y1 - by, FREE if hall.look == "hollow" else UNKNOWN)
        if y1 - y0 >= BACK_TO_BACK:
            fill(x0, x1, (y0 + y1 - hall.flue) / 2, (y0 + y1 + hall.flue) / 2, FREE)

    fill(-WALL, wide + WALL, -WALL, deep + WALL, OCCUPIED)
    fill(0, wide, 0, deep, FREE)
    at = 0.0
    for gap, length in zip(gaps, hall.lengths, strict=False):
        at += gap
        low = rim
        for aisle, depth in zip(hall.aisles, hall.depths, strict=False):
            low += aisle
            rack(at, at + length, low, low + depth)
            low += depth
        if rim:
            rack(at, at + length, 0, rim)
            rack(at, at + length, deep - rim, deep)
        at += length
    return drawn


def as_hit(picture: npt.NDArray[np.uint8], seed: int) -> npt.NDArray[np.uint8]:
    """What of it beams from the floor hit: the first pixel of what stands, and not all of them."""
    free = np.pad(picture == GREYS[FREE], 1)
    beside = free[:-2, 1:-1] | free[2:, 1:-1] | free[1:-1, :-2] | free[1:-1, 2:]
    is_hit = beside & (np.random.default_rng(seed).random(picture.shape) >= MISSED)
    return np.where((picture == GREYS[OCCUPIED]) & ~is_hit, GREYS[UNKNOWN], picture).astype(np.uint8)


def planned(hall: Hall) -> Counter[str]:
    """How many of each kind a person would count."""
    aisles, between = len(hall.aisles), len(hall.lengths) - 1
    past = 2 if hall.ends == "ways" else 1
    junctions = {"L": 2 * past, "T": (aisles - 2) * past + 2 * between, "X": (aisles - 2) * between}
    racks = len(hall.lengths) * (len(hall.depths) + (2 if hall.at_walls == "racks" else 0))
    return Counter(junctions | {"end": 0 if past == 2 else aisles, "rack": racks})


def found(seed: int) -> Counter[str]:
    """The same of a survey."""
    return counted(picture(hall(seed)), hall(seed).resolution)


def found_as_hit(seed: int) -> Counter[str]:
    """And of what a lidar hits of it."""
    return counted(as_hit(picture(hall(seed)), seed), hall(seed).resolution)


def counted(drawn: npt.NDArray[np.uint8], resolution: float) -> Counter[str]:
    """Junctions by their types, and racks."""
    survey = groundplan.survey(drawn, resolution=resolution, threads=1)
    kinds = Counter(label["type"] for label in survey.of_kind("junction"))
    return kinds + Counter(rack=len(survey.of_kind("rack")))


def said(value: object) -> str:
    """A measure in few letters."""
    if isinstance(value, float):
        return f"{value:.3g}"
    return "/".join(map(said, value)) if isinstance(value, list) else str(value)


Plans = dict[int, tuple[Hall, Counter[str]]]


def wrong(plans: Plans, counts: dict[int, Counter[str]]) -> tuple[set[int], set[int]]:
    """The seeds with other junctions than the plan, and with another number of racks."""
    junctions = {seed for seed, (_, plan) in plans.items() if any(counts[seed][kind] != plan[kind] for kind in KINDS)}
    return junctions, {seed for seed, (_, plan) in plans.items() if counts[seed]["rack"] != plan["rack"] >= RACKS}


def table(plans: Plans, title: str, junctions: set[int], racks: set[int]) -> None:
    """How many are wrong, by what was drawn."""
    print(f"{f'{len(plans)} halls, {title}':24}  other junctions  other racks    of")
    for measure in ("look", "at_walls", "ends", "flue", "resolution"):
        for value in sorted({getattr(made, measure) for made, _ in plans.values()}, key=str):
            own = {seed for seed, (made, _) in plans.items() if getattr(made, measure) == value}
            print(f"{measure:11}{said(value):10}{len(own & junctions):20}{len(own & racks):13}{len(own):6}")
    print(f"{'all':21}{len(junctions):20}{len(racks):13}{len(plans):6}")


def main() -> None:
    """Survey all, print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("first", nargs="?", type=int, default=0)
    parser.add_argument("count", nargs="?", type=count, default=400)
    words = parser.parse_args()
    seeds = range(words.first, words.first + words.count)
    plans = {seed: (hall(seed), planned(hall(seed))) for seed in seeds}
    with ProcessPoolExecutor(mp_context=get_context("spawn")) as pool:
        surveyed, hit = (
            dict(zip(seeds, pool.map(of, seeds, chunksize=4), strict=True)) for of in (found, found_as_hit)
        )
    drawn = wrong(plans, surveyed)
    table(plans, "as drawn", *drawn)
    print()
    table(plans, "as hit", *wrong(plans, hit))
    other = drawn[0]
    for seed in sorted(other)[:NAMED]:
        made, plan = plans[seed]
        measures = "  ".join(
            f"{field.name} {said(getattr(made, field.name))}" for field in fields(made) if field.name != "corner"
        )
        told = "  ".join(f"{kind} {surveyed[seed][kind]} for {plan[kind]}" for kind in KINDS if plan[kind])
        print(f"\n{seed}: {told}\n    {measures}")


if __name__ == "__main__":
    main()
