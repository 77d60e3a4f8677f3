"""IndoorGML 1.1 (OGC 19-011r4): cells, their boundaries, and the dual graph of states and transitions.

The standard's model is the paper's: a primal space of cells and its dual. ``graph="places"`` takes the regions as cells
and doors as boundaries; ``graph="faces"`` the faces of the subdivision and their edges. Coordinates are metres of the
map frame in two dimensions. The namespace of 1.1 is still that of 1.0.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import shapely

from groundplan._errors import ParameterError
from groundplan._files import write_bytes
from groundplan.export._boundaries import boundaries
from groundplan.export._places import places
from groundplan.export._text import one_line

if TYPE_CHECKING:
    from groundplan.survey import Survey

CORE = "http://www.opengis.net/indoorgml/1.0/core"
GML = "http://www.opengis.net/gml/3.2"
XLINK = "http://www.w3.org/1999/xlink"


@dataclass(frozen=True)
class Cell:
    """A cell: a unique id (an XML name), its name, its polygon and the point of its state."""

    id: str
    name: str
    shape: Any
    at: tuple[float, float]


@dataclass(frozen=True)
class Passage:
    """A boundary between two cells (positions) and whether one gets through; `line` is None where it has no shape."""

    id: str
    name: str
    cells: tuple[int, int]
    line: Any
    open: bool


def write(survey: Survey, path: Path, graph: str = "places") -> list[Path]:
    """Write cells, boundaries, states and transitions.

    Raises
    ------
    ParameterError
        ``export.graph``.
    """
    if graph not in ("places", "faces"):
        raise ParameterError("export.graph", f"there is no graph {graph!r}", "there are places and faces")
    cells, passages = _regions(survey) if graph == "places" else _faces(survey)
    for prefix, uri in (("core", CORE), ("gml", GML), ("xlink", XLINK)):
        ElementTree.register_namespace(prefix, uri)
    root = ElementTree.Element(f"{{{CORE}}}IndoorFeatures", {f"{{{GML}}}id": "survey"})
    _gml(root, "name").text = one_line(survey.map.image) or "map"
    around: list[list[Passage]] = [[] for _ in cells]
    for passage in passages:
        for n in passage.cells:
            around[n].append(passage)
    primal = _core(_core(root, "primalSpaceFeatures"), "PrimalSpaceFeatures", "primal")
    for cell, own in zip(cells, around, strict=True):
        _cell(primal, cell, own)
    for passage in passages:
        _boundary(primal, passage)
    dual = _core(_core(root, "multiLayeredGraph"), "MultiLayeredGraph", "graph")
    layer = _core(_core(_core(dual, "spaceLayers", "layers"), "spaceLayerMember"), "SpaceLayer", "layer")
    ways = [passage for passage in passages if passage.open]
    nodes = _core(layer, "nodes", "nodes")
    for cell, own in zip(cells, around, strict=True):
        _state(nodes, cell, [way for way in own if way.open])
    if ways:
        edges = _core(layer, "edges", "edges")
        for way in ways:
            _transition(edges, way, cells)
    ElementTree.indent(root)
    write_bytes(path, ElementTree.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n")
    return [path]


def _regions(survey: Survey) -> tuple[list[Cell], list[Passage]]:
    """Regions, the doors between them, and where one goes over into another."""
    found = places(survey)
    regions = [place for place in found if place.kind == "region" and place.shape is not None]
    where = {place.label: n for n, place in enumerate(regions)}
    cells = [Cell(f"C-{place.id}", place.name, place.shape, place.centre) for place in regions]
    passages = []
    for place in found:
        sides = [where[label] for label in survey.labels[place.label].get("between", ()) if label in where]
        if place.kind == "door" and len(set(sides)) == 2:
            line = None if place.axis is None else shapely.LineString(place.axis)
            passages.append(Passage(f"B-{place.id}", place.name, (sides[0], sides[1]), line, True))
    for border in boundaries(survey, found, []):
        if border.kind == "open" and border.region < border.by:
            a, b = where[border.region], where[border.by]
            passages.append(Passage(f"B-{cells[a].id}-{cells[b].id}", "", (a, b), border.line, True))
    return cells, passages


def _faces(survey: Survey) -> tuple[list[Cell], list[Passage]]:
    """All faces, and every link between two."""
    cut, dual = survey.subdivision, survey.adjacency
    shapes = survey.to_shapely()["faces"]
    cells = [
        Cell(f"C-F{n}", f"F{n}", shape, (float(x), float(y)))
        for n, (shape, (x, y)) in enumerate(zip(shapes, cut.centres.tolist(), strict=True))
    ]
    passages = [
        Passage(f"B-E{edge}", "", (a, b), shapely.LineString(cut.vertices[cut.edge_vertices[edge]]), connected)
        for (a, b), edge, connected in zip(
            dual.faces.tolist(), dual.edges.tolist(), dual.connected.tolist(), strict=True
        )
    ]
    return cells, passages


def _cell(into: Any, cell: Cell, around: list[Passage]) -> None:
    own = _core(_core(into, "cellSpaceMember"), "CellSpace", cell.id)
    if cell.name:
        _gml(own, "name").text = cell.name
    shape = _core(_core(own, "cellSpaceGeometry"), "Geometry2D")
    polygon = _gml(shape, "Polygon", f"G-{cell.id}")
    polygon.set("srsDimension", "2")
    oriented = shapely.orient_polygons(cell.shape)
    for kind, rings in (("exterior", [oriented.exterior]), ("interior", list(oriented.interiors))):
        for ring in rings:
            _gml(_gml(_gml(polygon, kind), "LinearRing"), "posList").text = _positions(ring.coords)
    _link(own, "duality", f"S-{cell.id}")
    for passage in around:
        _link(own, "partialboundedBy", passage.id)


def _boundary(into: Any, passage: Passage) -> None:
    own = _core(_core(into, "cellSpaceBoundaryMember"), "CellSpaceBoundary", passage.id)
    if passage.name:
        _gml(own, "name").text = passage.name
    if passage.open:
        _link(own, "duality", f"T-{passage.id}")
    if passage.line is not None:
        shape = _core(_core(own, "cellSpaceBoundaryGeometry"), "geometry2D")
        _line(shape, f"G-{passage.id}", passage.line.coords)


def _state(into: Any, cell: Cell, ways: list[Passage]) -> None:
    own = _core(_core(into, "stateMember"), "State", f"S-{cell.id}")
    _link(own, "duality", cell.id)
    for way in ways:
        _link(own, "connects", f"T-{way.id}")
    point = _gml(_core(own, "geometry"), "Point", f"P-{cell.id}")
    point.set("srsDimension", "2")
    _gml(point, "pos").text = _positions([cell.at])


def _transition(into: Any, way: Passage, cells: list[Cell]) -> None:
    a, b = (cells[n] for n in way.cells)
    middle = [] if way.line is None else [way.line.interpolate(0.5, normalized=True).coords[0]]
    course = [a.at, *middle, b.at]
    own = _core(_core(into, "transitionMember"), "Transition", f"T-{way.id}")
    _core(own, "weight").text = f"{shapely.LineString(course).length:.3f}"
    for cell in (a, b):
        _link(own, "connects", f"S-{cell.id}")
    _link(own, "duality", way.id)
    _line(_core(own, "geometry"), f"L-{way.id}", course)


def _line(into: Any, id: str, coords: Any) -> None:
    line = _gml(into, "LineString", id)
    line.set("srsDimension", "2")
    _gml(line, "posList").text = _positions(coords)


def _positions(coords: Any) -> str:
    return " ".join(f"{x:.6f} {y:.6f}" for x, y, *_ in coords)


def _core(into: Any, name: str, id: str | None = None) -> Any:
    return ElementTree.SubElement(into, f"{{{CORE}}}{name}", {} if id is None else {f"{{{GML}}}id": id})


def _gml(into: Any, name: str, id: str | None = None) -> Any:
    return ElementTree.SubElement(into, f"{{{GML}}}{name}", {} if id is None else {f"{{{GML}}}id": id})


def _link(into: Any, name: str, id: str) -> None:
    ElementTree.SubElement(into, f"{{{CORE}}}{name}", {f"{{{XLINK}}}href": f"#{id}"})
