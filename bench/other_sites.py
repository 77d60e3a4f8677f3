"""Warehouses of another make than `groundplan.simulate`: bench/other_sites.py [FIRST [COUNT]] [--wide | --hard].

What is tuned on simulated sites may fit the simulator. These are made by other rules (`_other_plan.py`,
`_other_map.py`): racks solid, hollow, of legs with pallets between or of shelves, full or half empty, without guards
at their ends; a wall beside the last cross aisle or the last block; maps drawn, scanned to three values or to greys,
at 3 to 10 cm. Every measure comes from the site's seed. COUNT sites (110) are made from the seeds FIRST (0) on,
surveyed with default parameters and scored; the table has them by kind, and then those that score least or have a
direction off. With ``--wide`` every measure comes from a wider range. With ``--hard`` they are of the harder kinds
(`_other_hard.py`): several halls, a wing, staggered and ragged rows, bent maps, pallets on the floor, half seen
sites. No bar, so no exit code.
"""

from __future__ import annotations

import argparse
import statistics
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from typing import Any

from _other_hard import KINDS as HARD
from _other_hard import Hard
from _other_hard_map import hard_site
from _other_map import site
from _other_plan import Measures

import groundplan
from groundplan._cli.arguments import count
from groundplan.evaluate import score

FIGURES = (
    "direction_error_deg",
    "direction_extra",
    "line_recall",
    "junction_f1",
    "junction_typed_f1",
    "corridor_recall",
    "corridor_precision",
)
KINDS: dict[str, Callable[[Measures], Any]] = {
    "racks": lambda site: site.style,
    "full": lambda site: site.fill if site.style in ("legs", "shelves") else "-",
    "metres a pixel": lambda site: site.resolution,
    "map": lambda site: site.look,
    "aisles at ends": lambda site: site.ends,
    "aisles": lambda site: site.rows,
}
HARD_KINDS: dict[str, Callable[[Hard], Any]] = {
    "kind": lambda site: f"{HARD.index(site.kind) + 1:2} {site.kind}",
    "racks": lambda site: site.common.style,
    "metres a pixel": lambda site: site.common.resolution,
}
#: Sites whose junctions score less are listed, and those of which a direction is more degrees off.
LOW, ASKEW = 0.9, 0.15

Row = tuple[int, Any, list[float]]


def scored(seed: int, is_wide: bool = False, is_hard: bool = False) -> Row:
    """The figures of one site."""
    made = hard_site(seed) if is_hard else site(seed, is_wide)
    found = score(groundplan.survey(made.map, threads=1).to_dict(), made.truth)
    return seed, made.measures, [float(found[name]) for name in FIGURES]


def line(name: str, rows: list[Row]) -> str:
    """One row of the table: the means of some sites, their worst direction and typed F1, the directions too many."""
    columns = list(zip(*(row[2] for row in rows), strict=True))
    error, _, lines, f1, typed, recall, precision = (statistics.mean(column) for column in columns)
    return (
        f"{name:22}{len(rows):6}{error:8.3f}{max(columns[0]):8.2f}{sum(columns[1]):7.0f}{lines:8.3f}{f1:8.3f}"
        f"{typed:8.3f}{min(columns[4]):8.3f}{recall:8.3f}{precision:11.3f}"
    )


def main() -> None:
    """Make the sites, score them, print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("first", nargs="?", type=int, default=0)
    parser.add_argument("count", nargs="?", type=count, default=110)
    how = parser.add_mutually_exclusive_group()
    how.add_argument("--wide", action="store_true", help="every measure from a wider range")
    how.add_argument("--hard", action="store_true", help="several halls, wings, staggered rows, drift, half seen")
    words = parser.parse_args()
    seeds = range(words.first, words.first + words.count)
    with ProcessPoolExecutor(mp_context=get_context("spawn")) as pool:
        rows = list(pool.map(partial(scored, is_wide=words.wide, is_hard=words.hard), seeds))
    print(
        f"{'sites':22}{'count':>6}{'error':>8}{'worst':>8}{'extra':>7}{'lines':>8}{'F1':>8}{'typed':>8}{'worst':>8}"
        f"{'recall':>8}{'precision':>11}"
    )
    kinds: dict[str, Callable[[Any], Any]] = HARD_KINDS if words.hard else KINDS
    for name, kind in kinds.items():
        for value in sorted({kind(row[1]) for row in rows}, key=str):
            print(line(f"{name}: {value}", [row for row in rows if kind(row[1]) == value]))
    print(line("all", rows))
    low = sorted((row[2][4], row[0]) for row in rows if row[2][4] < LOW)
    askew = sorted(((row[2][0], row[0]) for row in rows if row[2][0] > ASKEW), reverse=True)
    for what, which in ((f"typed F1 under {LOW}", low), (f"direction error over {ASKEW}", askew)):
        print(f"{what}: " + (", ".join(f"{figure:.2f} of seed {seed}" for figure, seed in which) or "none"))


if __name__ == "__main__":
    main()
