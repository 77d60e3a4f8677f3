"""Halls as regions, of sites that nothing was chosen on: bench/halls.py [FIRST [COUNT]].

COUNT (4) sites of each of twelve kinds from the seeds FIRST (300) on. By kind, the shares of the halls that one region
is and of the regions in halls that are one; then the means over all sites. No bar, so no exit code.
"""

from __future__ import annotations

import argparse
import statistics
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import Any

import groundplan
from groundplan import simulate
from groundplan._cli.arguments import count
from groundplan.evaluate import score

KINDS: dict[str, dict[str, Any]] = {
    "one hall": {},
    "closed sides": {"closed_sides": ["south", "east"], "sparse": 0.3},
    "gate": {"halls": 2},
    "gates": {"halls": 3, "yaw": 20.0},
    "passage": {"halls": 2, "gap": 4.0, "crosswise": True, "yaw": -12.0},
    "wing": {"wing": 30.0, "gap": 3.0},
    "gate and wing": {"halls": 2, "wing": -25.0, "yaw": 50.0},
    "lidar of 5 m": {"halls": 3, "gap": 6.0, "lidar_range": 5.0},
    "half empty": {"halls": 2, "sparse": 0.4, "goods": 0.5},
    "bent": {"halls": 3, "bend": 0.3, "width": 36.0},
    "staggered": {"halls": 2, "gap": 2.0, "staggered": 8.0, "uneven": 0.5},
    "four halls": {"halls": 4, "crosswise": True, "pillars": 8.0},
}
FIGURES = ("hall_recall", "hall_precision")

Site = tuple[str, int]


def scored(site: Site) -> tuple[str, list[float]]:
    """The kind of a site and its scores."""
    kind, seed = site
    made = simulate.warehouse(seed=seed, **KINDS[kind])
    scores = score(groundplan.survey(made.map, threads=1).to_dict(), made.truth)
    return kind, [scores[figure] or 0.0 for figure in FIGURES]


def main() -> None:
    """Make the sites, survey and score them, print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("first", nargs="?", type=int, default=300)
    parser.add_argument("count", nargs="?", type=count, default=4)
    words = parser.parse_args()
    sites = [(kind, words.first + n) for kind in KINDS for n in range(words.count)]
    with ProcessPoolExecutor(mp_context=get_context("spawn")) as pool:
        scores = list(pool.map(scored, sites))
    print(f"{len(sites)} sites{'halls':>12}{'prec':>8}")
    rows = {kind: [own for name, own in scores if name == kind] for kind in KINDS}
    for kind, own in (rows | {"mean": [own for _, own in scores]}).items():
        print(f"{kind:14}" + "".join(f"{statistics.mean(figures):8.3f}" for figures in zip(*own, strict=True)))


if __name__ == "__main__":
    main()
