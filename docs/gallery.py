"""Draw surveys and road maps of the maps in ../shared/maps and of a simulated warehouse. Run by `make gallery`.

They go into gallery/, for looking at: maps that are not ours stay out of the repository, and so do pictures over them.
Of the simulated warehouse and of some maps every format is written too, into gallery/NAME-export/, and the drawing and
the report are printed where LibreCAD and poppler are installed. Names given on the command line choose single ones:
`make gallery MAPS="svl_warehouse nav2_warehouse simulated"`.
"""

from __future__ import annotations

import argparse
import difflib
import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import groundplan
from groundplan import simulate
from groundplan.export import FORMATS
from groundplan.figures import draw_road_map, draw_survey
from groundplan.roadmap import road_map

ROOT = Path(__file__).resolve().parent.parent
SHARED = Path(os.environ.get("GROUNDPLAN_SHARED", ROOT.parent / "shared"))
GALLERY = ROOT / "gallery"
SIMULATED = "simulated"
#: Those that are written in every format.
EXPORTED = (SIMULATED, "radish_intel_jones_farms", "nav2_warehouse")


def main() -> None:
    """Draw the chosen maps, or all."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME")
    chosen = parser.parse_args().names
    for name, map in maps(chosen):
        survey = groundplan.survey(map)
        draw_survey(survey, map, GALLERY / f"{name}.png")
        roads = road_map(survey, map=map)
        if roads.lanes:
            draw_road_map(survey, map, roads, GALLERY / f"{name}-roads.png")
        kinds = ("corridor", "junction", "rack", "region")
        counts = [f"{len(survey.of_kind(kind))} {kind}s" for kind in kinds]
        counts = [f"{len(survey.directions)} directions", f"{len(survey.lines)} lines", *counts]
        print(f"{name}: {', '.join(counts)}, {len(roads.lanes)} lanes")
        if name in EXPORTED:
            export(survey, map, GALLERY / f"{name}-export")


def maps(chosen: list[str]) -> Iterator[tuple[str, groundplan.Map]]:
    """Names and maps."""
    if not chosen or SIMULATED in chosen:
        yield SIMULATED, simulate.warehouse(seed=7, yaw=12.0).map
    folder = SHARED / "maps"
    found = {"-".join(p.relative_to(folder).with_suffix("").parts): p for p in sorted(folder.rglob("*.yaml"))}
    if not found and chosen != [SIMULATED]:
        raise SystemExit(f"error: there are no maps in {folder}\nhint: GROUNDPLAN_SHARED=DIR make gallery")
    for name in chosen:
        if name not in found and name != SIMULATED:
            near = difflib.get_close_matches(name, found) or [other for other in found if name in other] or list(found)
            raise SystemExit(f"error: there is no map {name!r} in {folder}\nhint: such as {', '.join(near[:5])}")
    for name in chosen or found:
        if name == SIMULATED:
            continue
        path = found[name]
        try:
            yield name, groundplan.read(path)
        except groundplan.MapError:
            continue  # annotations lie beside some maps, as YAML too


def export(survey: groundplan.Survey, map: groundplan.Map, out: Path) -> None:
    """Write every format, and print the drawing and the report."""
    out.mkdir(parents=True, exist_ok=True)
    for name, form in FORMATS.items():
        try:
            survey.export(out, name, **({"map": map} if form.map != "no" else {}))
        except groundplan.FormatError as refused:
            print(f"  {name}: {refused}")
    (drawing,), (report,) = out.glob("*.dxf"), out.glob("*.report.pdf")
    offscreen = os.environ | {"QT_QPA_PLATFORM": "offscreen"}
    if shutil.which("librecad") and shutil.which("pdftoppm"):
        for words in (
            ["librecad", "dxf2pdf", "-a", drawing.name],
            ["pdftoppm", "-r", "150", "-png", "-singlefile", f"{drawing.stem}.pdf", f"{drawing.stem}.dxf"],
            ["pdftoppm", "-r", "100", "-png", report.name, report.stem],
        ):
            subprocess.run(
                words, cwd=out, env=offscreen, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
            )
    print(f"  wrote {out.relative_to(ROOT)}/")


if __name__ == "__main__":
    main()
