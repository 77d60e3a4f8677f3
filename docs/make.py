"""Make anew what the docs show: the pictures, the README's formats, and the tables of scores. Run by `make docs`."""

from __future__ import annotations

import subprocess
import sys
import sysconfig
from pathlib import Path

import groundplan
from groundplan.export import FORMATS
from groundplan.figures import draw_road_map, draw_survey
from groundplan.roadmap import road_map

DOCS = Path(__file__).parent
PROGRAM = Path(sysconfig.get_path("scripts")) / "groundplan"
SUITES = ("warehouses", "offices", "roadmaps", "names", "confidence")


def pictures() -> None:
    """The survey of the example and its road map, small enough for a README."""
    from PIL import Image

    map = groundplan.read(DOCS.parent / "examples" / "warehouse.yaml")
    survey = groundplan.survey(map)
    roads = road_map(survey, spurs=0.6, map=map)
    for place in (
        draw_survey(survey, map, DOCS / "survey.png"),
        draw_road_map(survey, map, roads, DOCS / "roads.png"),
    ):
        with Image.open(place) as drawn:
            drawn.thumbnail((1200, 1200))
            # The median cut gives small discs the colours of the large areas beside them.
            drawn.convert("RGB").quantize(256, Image.Quantize.FASTOCTREE).save(place, optimize=True)


def formats() -> None:
    """The table of formats into the README."""
    rows = [f"| `{form.name}` | {form.holds} | {form.readers} | {form.tested} |" for form in FORMATS.values()]
    head = ["| format | what it holds | for | tested with |", "|---|---|---|---|"]
    _between(DOCS.parent / "README.md", "formats", "\n".join([*head, *rows]))


def scores() -> None:
    """The suites' tables into docs/accuracy.md, and those of the sites of another make."""
    for suite in SUITES:
        table = subprocess.run(
            [PROGRAM, "evaluate", "--suite", suite], check=True, stdout=subprocess.PIPE, text=True
        ).stdout
        _between(DOCS / "accuracy.md", suite, f"```\n{table}```")
    benches = (
        ("plain halls", ["plain.py"]),
        ("other sites", ["other_sites.py"]),
        ("other hard sites", ["other_sites.py", "0", "66", "--hard"]),
    )
    for name, (bench, *words) in benches:
        others = subprocess.run(
            [sys.executable, DOCS.parent / "bench" / bench, *words],
            check=True,
            stdout=subprocess.PIPE,
            text=True,
        ).stdout
        _between(DOCS / "accuracy.md", name, f"```\n{others}```")


def _between(page: Path, name: str, text: str) -> None:
    """Put a text between a page's two marks of a name."""
    begin, end = f"<!-- {name} -->", f"<!-- end of {name} -->"
    before, _, rest = page.read_text(encoding="utf-8").partition(begin)
    after = rest.partition(end)[2]
    page.write_text(f"{before}{begin}\n\n{text}\n\n{end}{after}", encoding="utf-8")


if __name__ == "__main__":
    pictures()
    formats()
    scores()
    sys.stderr.write("wrote docs/survey.png, docs/roads.png, README.md and docs/accuracy.md\n")
