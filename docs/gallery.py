"""Draw the survey and the road map of every map in ../shared/maps into gallery/, for looking at. Run by `make gallery`.

The maps are not ours, so the pictures over them stay out of the repository. Names given on the command line choose
single ones: `make gallery MAPS="svl_warehouse nav2_warehouse"`.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

import groundplan
from groundplan.figures import draw_road_map, draw_survey
from groundplan.roadmap import road_map

ROOT = Path(__file__).resolve().parent.parent
SHARED = Path(os.environ.get("GROUNDPLAN_SHARED", ROOT.parent / "shared"))


def main(chosen: list[str]) -> None:
    """Draw the chosen maps, or all."""
    maps = sorted((SHARED / "maps").rglob("*.yaml"))
    if not maps:
        raise SystemExit(f"error: there are no maps in {SHARED / 'maps'}\nhint: GROUNDPLAN_SHARED=DIR make gallery")
    for path in maps:
        name = "-".join(path.relative_to(SHARED / "maps").with_suffix("").parts)
        if chosen and name not in chosen:
            continue
        try:
            map = groundplan.read(path)
        except groundplan.MapError:
            continue  # annotations lie beside some maps, as YAML too
        survey = groundplan.survey(map)
        draw_survey(survey, map, ROOT / "gallery" / f"{name}.png")
        if survey.of_kind("corridor"):
            draw_road_map(survey, map, road_map(survey), ROOT / "gallery" / f"{name}-roads.png")
        kinds = ("corridor", "junction", "rack", "region")
        counts = ", ".join(f"{len(survey.of_kind(kind))} {kind}s" for kind in kinds)
        print(f"{name}: {len(survey.directions)} directions, {len(survey.lines)} lines, {counts}")


if __name__ == "__main__":
    main(sys.argv[1:])
