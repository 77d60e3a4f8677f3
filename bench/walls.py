"""How true walls are to what lies there, over the maps in ../shared/maps.

Three numbers: the share of the walls' length with nothing occupied within 0.15 m; how often a wall goes on over 0.7 m
or more of that, as over a door; and the share of the edge pixels that a wall lies within 0.15 m of. Needs scipy.
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

import numpy as np
import numpy.typing as npt
from scipy import ndimage

import groundplan
from groundplan import Map, Survey

ROOT = Path(__file__).resolve().parent.parent
SHARED = Path(os.environ.get("GROUNDPLAN_SHARED", ROOT.parent / "shared"))
#: Metres: how near is on it, and what is a door.
NEAR, DOOR = 0.15, 0.7


def pixels_under(survey: Survey, map: Map) -> list[npt.NDArray[np.int64]]:
    """For each wall the rows and columns of pixels along it, two to a pixel's width, (2, N)."""
    x, y, yaw = map.origin
    turn = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
    found = []
    for ends in (survey.walls.points - (x, y)).reshape(-1, 2, 2) @ turn / map.resolution:
        count = max(2, int(2 * np.hypot(*(ends[1] - ends[0]))))
        points = ends[0] + ((np.arange(count) + 0.5) / count)[:, None] * (ends[1] - ends[0])
        rows, columns = map.height - 1 - np.floor(points[:, 1]), np.floor(points[:, 0])
        found.append(np.stack([rows.clip(0, map.height - 1), columns.clip(0, map.width - 1)]).astype(np.int64))
    return found


def measured(map: Map) -> npt.NDArray[np.float64]:
    """Metres of wall, of them bare; bare stretches as long as a door; edge pixels, of them near a wall."""
    walls = pixels_under(groundplan.survey(map), map)
    reach, step = NEAR / map.resolution, map.resolution / 2
    far = ndimage.distance_transform_edt(map.states[map.pixels] != 1) > reach
    drawn = np.ones((map.height, map.width), dtype=bool)
    sums = np.zeros(5)
    for rows, columns in walls:
        bare = far[rows, columns]
        drawn[rows, columns] = False
        turns = np.flatnonzero(np.diff(np.concatenate([[False], bare, [False]]).astype(np.int8))).reshape(-1, 2)
        sums[:3] += len(bare) * step, bare.sum() * step, ((turns[:, 1] - turns[:, 0]) * step >= DOOR).sum()
    edges = groundplan.find_gradients(map).pixels.astype(np.int64)
    if walls:
        near = ndimage.distance_transform_edt(drawn) <= reach
        sums[4] = near[map.height - 1 - edges[:, 1], edges[:, 0]].sum()
    sums[3] = len(edges)
    return sums


def main() -> None:
    """Add up all maps."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    total, maps, crossed = np.zeros(5), 0, 0
    for path in sorted((SHARED / "maps").rglob("*.yaml")):
        try:
            map = groundplan.read(path)
        except groundplan.MapError:
            continue  # annotations lie beside some maps, as YAML too
        sums = measured(map)
        total, maps, crossed = total + sums, maps + 1, crossed + bool(sums[2])
    if not maps:
        sys.exit(f"error: there are no maps in {SHARED / 'maps'}\nhint: GROUNDPLAN_SHARED=DIR {sys.argv[0]}")
    print(f"{maps} maps, {total[0]:.0f} m of wall, {100 * total[1] / total[0]:.1f} % of it over nothing")
    print(f"{total[2]:.0f} stretches over {DOOR} m of nothing or more, in {crossed} maps")
    print(f"{100 * total[4] / total[3]:.1f} % of the edge pixels lie on a wall")


if __name__ == "__main__":
    main()
