"""Typed junctions and corridors of warehouses that nothing was chosen on: bench/unseen.py [SETS].

The suite ``warehouses`` with other seeds, each site turned by up to 20 degrees more; sites whose every measure is drawn
at random: aisles of 2.4 to 4 m, bays of 2 to 3.6 m, up to half of them empty, and one of eight hard kinds each;
small halls of which 30 to 65 percent of the bays are empty; and the suite's sites whose ways are staggered from row to
row, every measure within 15 percent of theirs. A site that has no room for its rows is left out. SETS
(default 1) makes as many of each, of which the first is what docs/approaches.md tells of; no bar, so no exit code.
"""

from __future__ import annotations

import argparse
import random
import statistics
import tomllib
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import groundplan
from groundplan import ParameterError
from groundplan._cli.arguments import count
from groundplan.evaluate import score
from groundplan.simulate import warehouse

SUITE = Path(groundplan.__file__).parent / "evaluate" / "warehouses.toml"
FIGURES = ("junction_f1", "junction_typed_f1", "corridor_recall", "corridor_precision")
MEASURES = ("width", "depth", "aisle", "cross_aisle", "bay", "rack_depth")
Options = dict[str, Any]


def reseeded(number: int) -> list[Options]:
    """The suite's sites from other seeds."""
    sites = []
    for case in tomllib.loads(SUITE.read_text())["case"]:
        options = {name: value for name, value in case.items() if name not in ("name", "kind")}
        seed = options["seed"] + 1000 * (4 * number + 1)
        turn = random.Random(seed).uniform(-20, 20)
        sites.append(options | {"seed": seed, "yaw": round(options.get("yaw", 0) + turn, 1)})
    return sites


def drawn(number: int) -> list[Options]:
    """Sites with every measure at random."""
    return [_drawn(9000 + 500 * number + n, n % 8) for n in range(24)]


def _drawn(seed: int, kind: int) -> Options:
    draw = random.Random(seed)
    options: Options = {"seed": seed, "yaw": round(draw.uniform(-90, 90), 1)}
    options |= {"width": round(draw.uniform(30, 56)), "depth": round(draw.uniform(22, 38))}
    options |= {"aisle": round(draw.uniform(2.4, 4.0), 1), "cross_aisle": round(draw.uniform(2.6, 4.6), 1)}
    options |= {"bay": round(draw.uniform(2.0, 3.6), 2), "rack_depth": round(draw.uniform(0.9, 1.4), 2)}
    options |= {"cross_aisles": draw.choice([1, 1, 2, 2, 3]), "sparse": draw.choice([0, 0.1, 0.2, 0.3, 0.4, 0.5])}
    options["clutter"] = round(draw.uniform(0, 1.2), 1)
    if kind == 0:
        return options | {"halls": 2, "gap": draw.choice([0.5, 3.0, 5.0]), "crosswise": draw.random() < 0.5}
    if kind == 1:
        return options | {"staggered": round(draw.uniform(5, 11))}
    if kind == 2:
        wing = draw.choice([-50, -40, -30, -20, 20, 30, 40, 50])
        return options | {"wing": wing, "gap": draw.choice([2.0, 4.0])}
    if kind == 3:
        gap = draw.choice([0.5, 2.0, 4.0])
        return options | {"halls": 3, "gap": gap, "crosswise": True, "width": 34, "depth": 24}
    if kind == 4:
        return options | {"bend": 0.2, "drift": 0.04}
    if kind == 5:
        return options | {"goods": round(draw.uniform(0.3, 0.7), 1), "clutter": 0.8}
    if kind == 6:
        return options | {"uneven": round(draw.uniform(0.3, 0.6), 1), "lidar_range": draw.choice([5.0, 8.0, 15.0])}
    halls = {"staggered": 8, "halls": 2, "gap": 2.0, "goods": 0.3, "partial": 0.15}
    return options | halls | {"skew": draw.choice([0, 8, -8])}


def half_empty(number: int) -> list[Options]:
    """Small halls of one or two, many bays of which are empty."""
    return [_half_empty(12000 + 500 * number + n, n) for n in range(80)]


def _half_empty(seed: int, kind: int) -> Options:
    draw = random.Random(seed)
    options: Options = {"seed": seed, "yaw": round(draw.uniform(-90, 90), 1)}
    options |= {"width": draw.choice([26, 32, 40]), "depth": draw.choice([16, 20, 26])}
    options |= {"aisle": round(draw.uniform(2.2, 3.6), 1), "cross_aisle": round(draw.uniform(3.0, 4.6), 1)}
    options |= {"bay": round(draw.uniform(1.9, 3.8), 2), "rack_depth": round(draw.uniform(0.8, 1.3), 2)}
    options |= {"cross_aisles": draw.choice([1, 2]), "sparse": draw.choice([0.3, 0.45, 0.6, 0.65])}
    options |= {"scan_every": 0.8, "beams": 400}
    return options | ({"halls": 2, "gap": draw.choice([0.5, 0.6, 3.0])} if kind % 4 == 1 else {})


def staggered(number: int) -> list[Options]:
    """The suite's staggered sites, five of each, with other measures."""
    cases = [case for case in tomllib.loads(SUITE.read_text())["case"] if "staggered" in case]
    return [_staggered(case, 60 + 5 * number + n) for n in range(5) for case in cases]


def _staggered(case: Options, number: int) -> Options:
    options = {name: value for name, value in case.items() if name not in ("name", "kind")}
    seed = options["seed"] + 1000 * number + 7
    draw = random.Random(seed)
    options |= {"seed": seed, "yaw": round(options.get("yaw", 0) + draw.uniform(-20, 20), 1)}
    for name in [name for name in MEASURES if name in options]:
        options[name] = round(options[name] * draw.uniform(0.85, 1.15), 2)
    for name, usual in (("aisle", 2.8), ("cross_aisle", 3.4)):
        if name not in options:
            options[name] = round(usual * draw.uniform(0.88, 1.2), 2)
    return options


def scores(options: Options) -> list[float] | None:
    """The figures of one site; none where its rows have no room."""
    try:
        made = warehouse(**options)
    except ParameterError:
        return None
    found = score(groundplan.survey(made.map, threads=1).to_dict(), made.truth)
    return [float(found[name]) for name in FIGURES]


def main() -> None:
    """Make the sites, score them, print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sets", nargs="?", type=count, default=1)
    sets = parser.parse_args().sets
    print(f"{'sites':15}{'count':>6}{'F1':>8}{'typed':>8}{'worst':>8}{'recall':>8}{'precision':>11}")
    with ProcessPoolExecutor(mp_context=get_context("spawn")) as pool:
        for number in range(sets):
            for name, sites in (
                ("other seeds", reseeded(number)),
                ("random", drawn(number)),
                ("half empty", half_empty(number)),
                ("staggered", staggered(number)),
            ):
                rows = [row for row in pool.map(scores, sites) if row is not None]
                f1, typed, recall, precision = (statistics.mean(column) for column in zip(*rows, strict=True))
                worst = min(row[1] for row in rows)
                print(
                    f"{name:15}{len(rows):6}{f1:8.3f}{typed:8.3f}{worst:8.3f}{recall:8.3f}{precision:11.3f}", flush=True
                )


if __name__ == "__main__":
    main()
