"""IndoorGML against a grammar of what OGC 19-011r4 says of these elements, and its duality link by link."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import networkx
import pytest
import shapely
from _exports import GOOD, ODD, demo, jones_farms, odd_names, once
from lxml import etree

NAMES = {
    "core": "http://www.opengis.net/indoorgml/1.0/core",
    "gml": "http://www.opengis.net/gml/3.2",
    "xlink": "http://www.w3.org/1999/xlink",
}
GRAMMAR = etree.RelaxNG(etree.parse(Path(__file__).parent / "indoorgml.rng"))
ID = f"{{{NAMES['gml']}}}id"
HREF = f"{{{NAMES['xlink']}}}href"


def read(path: Path) -> Any:
    """The document, valid, its links all leading somewhere."""
    tree = etree.parse(path)
    GRAMMAR.assertValid(tree)
    ids = tree.xpath("//@gml:id", namespaces=NAMES)
    assert len(set(ids)) == len(ids)
    assert {href.removeprefix("#") for href in tree.xpath("//@xlink:href", namespaces=NAMES)} <= set(ids)
    return tree


def found(tree: Any, path: str) -> list[Any]:
    """Elements by a path such as ``//core:State``."""
    return list(tree.xpath(path, namespaces=NAMES))


def links(element: Any, name: str) -> list[str]:
    """Where an element's links of that name lead."""
    return [child.get(HREF).removeprefix("#") for child in element.findall(f"core:{name}", NAMES)]


@pytest.mark.parametrize("graph", ["places", "faces"])
@pytest.mark.parametrize("which", [*GOOD, *ODD])
def test_primal_and_dual_are_each_other_s(which: str, graph: str, tmp_path: Path) -> None:
    tree = read(once((GOOD | ODD)[which](), "indoorgml", tmp_path, graph=graph))
    for primal, dual in (("CellSpace", "State"), ("CellSpaceBoundary", "Transition")):
        here = {e.get(ID): links(e, "duality") for e in found(tree, f"//core:{primal}")}
        there = {e.get(ID): links(e, "duality") for e in found(tree, f"//core:{dual}")}
        assert {(a, b) for a, ends in here.items() for b in ends} == {(a, b) for b, ends in there.items() for a in ends}
    for transition in found(tree, "//core:Transition"):
        for state in links(transition, "connects"):
            assert transition.get(ID) in links(found(tree, f"//core:State[@gml:id='{state}']")[0], "connects")
    for cell in found(tree, "//core:CellSpace"):
        for boundary in links(cell, "partialboundedBy"):
            assert found(tree, f"//core:CellSpaceBoundary[@gml:id='{boundary}']")


def test_the_dual_of_the_faces_is_the_survey_s(tmp_path: Path) -> None:
    survey = demo()
    tree = read(once(survey, "indoorgml", tmp_path, graph="faces"))
    made = networkx.Graph()
    for transition in found(tree, "//core:Transition"):
        made.add_edge(*(int(state.removeprefix("S-C-F")) for state in links(transition, "connects")))
    connected = [tuple(faces) for faces in survey.adjacency.faces[survey.adjacency.connected].tolist()]
    assert {frozenset(edge) for edge in made.edges} == {frozenset(edge) for edge in connected}


def test_cells_have_the_regions_shapes_to_a_millimetre(tmp_path: Path) -> None:
    survey = jones_farms()
    tree = read(once(survey, "indoorgml", tmp_path))
    cells = found(tree, "//core:CellSpace")
    assert [cell.find("gml:name", NAMES).text for cell in cells] == [r["name"] for r in survey.of_kind("region")]
    for cell, region in zip(cells, survey.of_kind("region"), strict=True):
        rings = [[float(v) for v in ring.text.split()] for ring in cell.iterfind(".//gml:posList", NAMES)]
        shell, *holes = (list(zip(ring[::2], ring[1::2], strict=True)) for ring in rings)
        shape = shapely.Polygon(shell, holes)
        assert shape.is_valid and shape.exterior.is_ccw
        assert shapely.hausdorff_distance(shape, shapely.Polygon(region["polygon"], region.get("holes"))) < 1e-3
    assert len(found(tree, "//core:Transition")) >= len(survey.of_kind("door"))


def test_names_come_back(tmp_path: Path) -> None:
    read(once(odd_names(), "indoorgml", tmp_path))
