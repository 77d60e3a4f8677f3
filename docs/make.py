"""Make anew what the docs show: the pictures, the README's formats, and the tables of scores. Run by `make docs`.

docs/make.py [PART ...] makes some of it: pictures, formats, or a table of docs/accuracy.md by its mark's name.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import sysconfig
from collections.abc import Callable
from functools import partial
from pathlib import Path

import groundplan
from groundplan.export import FORMATS
from groundplan.figures import draw_road_map, draw_survey
from groundplan.roadmap import road_map

DOCS = Path(__file__).parent
PROGRAM = Path(sysconfig.get_path("scripts")) / "groundplan"
SUITES = ("warehouses", "offices", "roadmaps", "names", "confidence")
#: Tables that a script in bench/ prints, and its words.
BENCHES = {
    "plain halls": ("plain.py",),
    "other sites": ("other_sites.py",),
    "other hard sites": ("other_sites.py", "0", "66", "--hard"),
}


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


def table(name: str) -> None:
    """A suite's table into docs/accuracy.md, or that of halls and sites of another make."""
    if name in SUITES:
        command = [PROGRAM, "evaluate", "--suite", name]
    else:
        bench, *words = BENCHES[name]
        command = [sys.executable, DOCS.parent / "bench" / bench, *words]
    printed = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout
    _between(DOCS / "accuracy.md", name, f"```\n{printed}```")


#: What there is to make, in this order.
PARTS: dict[str, Callable[[], None]] = {"pictures": pictures, "formats": formats}
PARTS |= {name: partial(table, name) for name in (*SUITES, *BENCHES)}


def _between(page: Path, name: str, text: str) -> None:
    """Put a text between a page's two marks of a name."""
    begin, end = f"<!-- {name} -->", f"<!-- end of {name} -->"
    before, _, rest = page.read_text(encoding="utf-8").partition(begin)
    after = rest.partition(end)[2]
    page.write_text(f"{before}{begin}\n\n{text}\n\n{end}{after}", encoding="utf-8")


def main() -> None:
    """Make the parts that are named, or all."""
    parser = argparse.ArgumentParser(description=__doc__)
    names = ", ".join(repr(name) if " " in name else name for name in PARTS)
    parser.add_argument("parts", nargs="*", metavar="PART", help=f"{names}; all without one")
    words = parser.parse_args()
    unknown = [name for name in words.parts if name not in PARTS]
    if unknown:
        parser.error(f"there is no part {unknown[0]!r}: there are {names}")
    for name in words.parts or PARTS:
        PARTS[name]()
        sys.stderr.write(f"made {name}\n")


if __name__ == "__main__":
    main()
