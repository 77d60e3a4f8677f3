"""Whether a map has the same labels in another guise: bench/same.py [NAME ...]. No truth is needed.

Each map of ../shared/maps (89, and one in a bag) and twenty simulated sites is surveyed as it is and in the guises of
`_guises.py`: with its origin elsewhere by no whole number of pixels, its yaw in the YAML another by a tenth of a
degree, unknown pixels around it, turned by right angles, mirrored. The labels of each are brought back and held against
those of the map as it is, one to one within a kind. The table has the share that is found again (of both surveys'
labels; a map without any counts as 1), which maps keep all, which keep the number of each kind, and the maps that keep
least. With NAMEs only those maps. Needs shapely and scipy. No bar, so no exit code.
"""

from __future__ import annotations

import argparse
import os
import statistics
import sys
from collections import Counter
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from _guises import AS_IT_IS, Guise, guises
from _other_hard_map import hard_site
from _other_map import site
from scipy.optimize import linear_sum_assignment

import groundplan
from groundplan import GroundplanError, Map

ROOT = Path(__file__).resolve().parent.parent
SHARED = Path(os.environ.get("GROUNDPLAN_SHARED", ROOT.parent / "shared"))
#: Simulated sites of another make, by their seeds.
PLAIN, HARD = range(9000, 9010), range(9000, 9010)
#: What is the same: the ends of ways and racks, and the places of junctions, doors and pillars, within so many metres,
NEAR = {"corridor": 0.5, "rack": 0.5, "junction": 0.5, "door": 0.25, "pillar": 0.25}
#: widths within so many, or within two pixels,
WIDTH, WIDTH_PIXELS = 0.1, 2.0
#: and regions from this intersection over union on.
IOU = 0.9
KINDS = (*NEAR, "region")
#: So many maps are named that keep least.
WORST = 12

Label = dict[str, Any]
#: Of each guise and kind: labels as it is, in the guise, and found again.
Kept = dict[str, dict[str, tuple[int, int, int]]]


def placed(guise: Guise) -> list[Label]:
    """A guise's labels, in the first map's own frame."""
    labels = []
    for label in groundplan.survey(guise.map, threads=1).to_dict()["labels"]:
        said = {"kind": label["kind"], "word": label.get("type") or label.get("use"), "width": label.get("width", 0.0)}
        if label["kind"] == "region":
            rings = [guise.back(ring) for ring in (label["polygon"], *label["holes"])]
            labels.append(said | {"shape": shapely.Polygon(rings[0], rings[1:]).buffer(0)})
        else:
            labels.append(said | {"ends": guise.back(label["axis"] if "axis" in label else [label["at"]])})
    return labels


def unlike(one: Label, other: Label, pixel: float) -> float:
    """How far two labels of a kind are from being the same, 1 at most when they are."""
    if one["word"] != other["word"]:
        return np.inf
    if one["kind"] == "region":
        shared = one["shape"].intersection(other["shape"]).area
        return float((1 - shared / max(one["shape"].area + other["shape"].area - shared, 1e-9)) / (1 - IOU))
    a, b = one["ends"], other["ends"]
    apart = min(np.hypot(*(a - ends).T).max() for ends in (b, b[::-1])) / NEAR[one["kind"]]
    return float(max(apart, abs(one["width"] - other["width"]) / max(WIDTH, WIDTH_PIXELS * pixel)))


def found_again(own: list[Label], others: list[Label], pixel: float) -> int:
    """How many of the labels of a kind are the same, one to one."""
    apart = np.array([[unlike(one, other, pixel) for other in others] for one in own]).reshape(len(own), len(others))
    # No pair that is not the same is worth one that is.
    cost = np.where(apart <= 1, apart, 1e6)
    return int((cost[linear_sum_assignment(cost)] <= 1).sum())


def kept(case: tuple[str, Callable[[], Map]]) -> tuple[str, Kept]:
    """What of one map's labels is found again in each guise; nothing where the map is refused."""
    name, make = case
    try:
        map = make()
    except GroundplanError:
        return name, {}
    surveyed = {guise: placed(of) for guise, of in guises(map).items()}
    own = surveyed.pop(AS_IT_IS)
    return name, {guise: by_kind(own, others, map.resolution) for guise, others in surveyed.items()}


def by_kind(own: list[Label], others: list[Label], pixel: float) -> dict[str, tuple[int, int, int]]:
    """Of each kind the labels of one survey and of another, and those found again."""
    found = {}
    for kind in KINDS:
        one, other = ([label for label in labels if label["kind"] == kind] for labels in (own, others))
        found[kind] = len(one), len(other), found_again(one, other, pixel)
    return found


def made(seed: int, is_hard: bool) -> Map:
    """A simulated site of another make."""
    return (hard_site(seed) if is_hard else site(seed)).map


def cases(names: list[str]) -> list[tuple[str, Callable[[], Map]]]:
    """The maps by name, real ones first; with names only those."""
    paths = (path for path in sorted((SHARED / "maps").glob("**/*.yaml")) if "sources" not in path.parts)
    found: dict[str, Callable[[], Map]] = {
        path.stem: partial(groundplan.read, path) for path in paths if not path.stem.endswith((".lines", ".segments"))
    }
    found |= {f"other {seed}": partial(made, seed, is_hard=False) for seed in PLAIN}
    found |= {f"harder {seed}": partial(made, seed, is_hard=True) for seed in HARD}
    return [case for case in found.items() if not names or case[0] in names]


def share(of: list[tuple[int, int, int]]) -> float:
    """Found again, of the labels of both surveys."""
    both = sum(own + other for own, other, _ in of)
    return 2 * sum(again for *_, again in of) / both if both else 1.0


def main() -> None:
    """Survey all, print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME")
    names = parser.parse_args().names
    chosen = cases(names)
    unknown = set(names) - {name for name, _ in chosen}
    if unknown:
        such = "those of files without .yaml, 'other 9000', 'harder 9000'"
        sys.exit(f"no map is named {', '.join(sorted(unknown))}: names are {such}")
    with ProcessPoolExecutor(mp_context=get_context("spawn")) as pool:
        maps = {name: found for name, found in pool.map(kept, chosen) if found}
    print(f"{len(maps)} maps   found again   worst  all kept  counts" + "".join(f"{kind:>10}" for kind in KINDS))
    for guise in dict.fromkeys(guise for found in maps.values() for guise in found):
        of = {name: found[guise] for name, found in maps.items() if guise in found}
        shares = [share(list(kinds.values())) for kinds in of.values()]
        whole = sum(all(len(set(numbers)) == 1 for numbers in kinds.values()) for kinds in of.values())
        counts = sum(all(own == other for own, other, _ in kinds.values()) for kinds in of.values())
        by_kind = "".join(f"{share([kinds[kind] for kinds in of.values()]):10.3f}" for kind in KINDS)
        print(f"{guise:10}{statistics.mean(shares):17.3f}{min(shares):8.3f}{whole:10}{counts:8}{by_kind}")
    print("\nkeep least")
    mean = {
        name: statistics.mean(share(list(kinds.values())) for kinds in found.values()) for name, found in maps.items()
    }
    for name in sorted(mean, key=lambda name: mean[name])[:WORST]:
        lost: Counter[str] = Counter()
        for kinds in maps[name].values():
            lost.update({kind: own + other - 2 * again for kind, (own, other, again) in kinds.items()})
        kept_in = "  ".join(f"{guise} {share(list(kinds.values())):.2f}" for guise, kinds in maps[name].items())
        print(f"{name:32}{kept_in}   most of it {lost.most_common(1)[0][0]}s")


if __name__ == "__main__":
    main()
