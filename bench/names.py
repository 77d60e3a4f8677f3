"""Names of warehouses that nothing was chosen on: bench/names.py [FIRST [COUNT]].

As the suite ``names``, with other seeds: COUNT (4) sites of each of ten kinds from the seeds FIRST (3000) on, five more
maps of each. The table has the shares of names kept and of labels found again, and the sites that keep less than 0.95
of their aisles' or regions' names. No bar, so no exit code.
"""

from __future__ import annotations

import argparse
import statistics
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import Any

from groundplan._cli.arguments import count
from groundplan.evaluate import Case
from groundplan.evaluate._suite import remade

KINDS: dict[str, dict[str, Any]] = {
    "plain": {},
    "turned": {"yaw": 23.0, "width": 50.0, "cross_aisles": 2},
    "closed": {"closed_sides": ["south", "east"], "sparse": 0.3, "drift": 0.04},
    "near-diagonal": {"yaw": 44.8, "skew": 8.0},
    "upright": {"yaw": 89.8, "uneven": 0.3},
    "crosswise": {"halls": 2, "gap": 4.0, "crosswise": True, "yaw": -12.0},
    "wing": {"wing": 35.0, "yaw": 5.0},
    "staggered": {"staggered": 8.0, "goods": 0.05, "yaw": 66.0},
    "three-halls": {"halls": 3, "gap": 0.5},
    "cluttered": {"cross_aisles": 3, "sparse": 0.4, "clutter": 0.8, "yaw": 10.0},
}
FIGURES = ("names_aisles", "found_aisles", "names_regions", "found_regions", "names_racks", "found_racks")
REMAKES = 5
LOW = 0.95

Site = tuple[str, int]


def scored(site: Site) -> tuple[Site, dict[str, Any]]:
    """The scores of one site over its remakes."""
    kind, seed = site
    options = KINDS[kind] | {"seed": seed, "remakes": REMAKES}
    return site, remade(Case(f"{kind}-{seed}", kind, "warehouse", options), "strips")


def main() -> None:
    """Make the sites and their remakes, score them, print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("first", nargs="?", type=int, default=3000)
    parser.add_argument("count", nargs="?", type=count, default=4)
    words = parser.parse_args()
    sites = [(kind, words.first + 10 * n + k) for k, kind in enumerate(KINDS) for n in range(words.count)]
    with ProcessPoolExecutor(mp_context=get_context("spawn")) as pool:
        scores = dict(pool.map(scored, sites))
    print(f"{len(sites)} sites{'mean':>12}{'worst':>8}")
    for figure in FIGURES:
        values = [site[figure] for site in scores.values() if site[figure] is not None]
        print(f"{figure:16}{statistics.mean(values):8.3f}{min(values):8.2f}")
    for (kind, seed), site in scores.items():
        if any(site[figure] is not None and site[figure] < LOW for figure in ("names_aisles", "names_regions")):
            print(f"{kind:14}{seed:6}  " + "  ".join(f"{figure} {site[figure]}" for figure in FIGURES[:4]))


if __name__ == "__main__":
    main()
