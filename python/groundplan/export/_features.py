"""The survey as layers of features, as geographic information systems have it: one kind of geometry, one table each."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from groundplan.export._places import Place, places
from groundplan.roadmap import RoadMap, road_map

if TYPE_CHECKING:
    from groundplan.survey import Survey

#: Layers of places by kind, with what is drawn of each.
KINDS = {
    "regions": "region",
    "corridors": "corridor",
    "junctions": "junction",
    "racks": "rack",
    "doors": "door",
    "pillars": "pillar",
}


@dataclass
class Layer:
    """Features of one kind.

    Attributes
    ----------
    name : str
    geometry : str
        ``Point``, ``LineString`` or ``Polygon``.
    shapes : list of shapely geometries
        Metres, map frame; polygons have their shell counter-clockwise.
    columns : dict of list
        Values by the column's name, in the order of the shapes. A missing number is NaN, a missing text is empty.
    """

    name: str
    geometry: str
    shapes: list[Any] = field(default_factory=list)
    columns: dict[str, list[Any]] = field(default_factory=dict)

    def add(self, shape: Any, **values: Any) -> None:
        """Append a feature; every feature of a layer has the same columns."""
        self.shapes.append(shape)
        for name, value in values.items():
            self.columns.setdefault(name, []).append(value)

    def features(self) -> Iterator[tuple[Any, dict[str, Any]]]:
        """Each shape with its values."""
        for n, shape in enumerate(self.shapes):
            yield shape, {name: values[n] for name, values in self.columns.items()}


def layers(survey: Survey, **roads: Any) -> list[Layer]:
    """All layers, from what is drawn below to what is drawn above; those without features are left out.

    ``roads`` as in `groundplan.roadmap.road_map`.
    """
    found = places(survey)
    made = [
        _faces(survey),
        *(_places(name, kind, found) for name, kind in KINDS.items() if kind not in ("door", "pillar")),
        _lines(survey),
        _walls(survey),
        _axes(found),
        *(_places(name, KINDS[name], found) for name in ("doors", "pillars")),
        *_graph(survey),
        *_roads(road_map(survey, **roads)),
    ]
    return [layer for layer in made if layer.shapes]


def _faces(survey: Survey) -> Layer:
    layer = Layer("faces", "Polygon")
    occupancy = survey.occupancy
    states = ("free", "occupied", "unknown")
    for n, shape in enumerate(survey.to_shapely()["faces"]):
        layer.add(
            shape,
            id=n,
            area=float(survey.subdivision.areas[n]),
            occupancy=float(occupancy.faces[n]),
            unknown=float(occupancy.unknown[n]),
            state=states[occupancy.states[n]],
        )
    return layer


def _walls(survey: Survey) -> Layer:
    layer = Layer("walls", "LineString")
    walls = survey.walls
    for n, ends in enumerate(walls.points.reshape(-1, 2, 2)):
        line = int(walls.lines[n])
        kind = "freestanding" if walls.freestanding[n] else "separating"
        layer.add(shapely.LineString(ends), id=n, line=line, kind=kind, width=float(survey.lines.widths[line]))
    return layer


def _lines(survey: Survey) -> Layer:
    """The lines of the directions, from border to border: as far as their edges go."""
    layer = Layer("lines", "LineString")
    cut, lines = survey.subdivision, survey.lines
    for n in range(len(lines)):
        ends = cut.vertices[np.unique(cut.edge_vertices[cut.edge_lines == n])]
        if len(ends) < 2:
            continue
        angle = survey.directions.angles[lines.directions[n]]
        along = ends @ np.array([np.cos(angle), np.sin(angle)])
        layer.add(
            shapely.LineString([ends[along.argmin()], ends[along.argmax()]]),
            id=n,
            direction=int(lines.directions[n]),
            amplitude=float(lines.amplitudes[n]),
            width=float(lines.widths[n]),
        )
    return layer


def _places(name: str, kind: str, found: list[Place]) -> Layer:
    members = [place for place in found if place.kind == kind]
    points = kind in ("door", "pillar")
    layer = Layer(name, "Point" if points else "Polygon")
    for place in members:
        shape = shapely.Point(place.centre) if points else place.shape
        if shape is not None:
            layer.add(shape if points else shapely.orient_polygons(shape), **_values(place, found))
    return layer


def _axes(found: list[Place]) -> Layer:
    """Centre lines of corridors."""
    layer = Layer("axes", "LineString")
    for place in found:
        if place.kind == "corridor" and place.axis is not None and place.axis[0] != place.axis[1]:
            layer.add(shapely.LineString(place.axis), **_values(place, found))
    return layer


def _values(place: Place, found: list[Place]) -> dict[str, Any]:
    return {
        "id": place.id,
        "name": place.name,
        "label": place.label,
        "use": place.use,
        "width": float("nan") if place.width is None else place.width,
        "area": float("nan") if place.area is None else place.area,
        "region": "" if place.region is None else found[place.region].id,
    }


def _graph(survey: Survey) -> Iterator[Layer]:
    """The dual: a node for each face and a link for each edge between two."""
    nodes, links = Layer("nodes", "Point"), Layer("links", "LineString")
    centres, dual = survey.subdivision.centres, survey.adjacency
    for n, centre in enumerate(centres):
        nodes.add(shapely.Point(centre), id=n, occupancy=float(survey.occupancy.faces[n]))
    for n, ((a, b), edge) in enumerate(zip(dual.faces.tolist(), dual.edges.tolist(), strict=True)):
        line = shapely.LineString([centres[a], centres[b]])
        links.add(line, id=n, face_a=a, face_b=b, edge=edge, connected=bool(dual.connected[n]))
    yield from (nodes, links)


def _roads(roads: RoadMap) -> Iterator[Layer]:
    """The road map: zones, lanes with their free widths, nodes, and pick faces with the node that serves them."""
    zones, lanes = Layer("road_zones", "Polygon"), Layer("road_lanes", "LineString")
    nodes, faces = Layer("road_nodes", "Point"), Layer("pick_faces", "Point")
    for zone in roads.zones:
        zones.add(shapely.Polygon(zone.ring), id=zone.id, kind=zone.kind, name=zone.name, speed=_or_nan(zone.speed))
    for lane in roads.lanes:
        start, end = roads.nodes[lane.start], roads.nodes[lane.end]
        lanes.add(
            shapely.LineString([start.at, end.at]),
            id=lane.id,
            name=lane.name,
            kind=lane.kind,
            start=start.id,
            end=end.id,
            left=lane.left,
            right=lane.right,
            speed=_or_nan(lane.speed),
            way=lane.way,
        )
    for node in roads.nodes:
        nodes.add(shapely.Point(node.at), id=node.id, name=node.name, kind=node.kind, type=node.type)
    for face in roads.faces:
        serves = {"id": face.id, "node": roads.nodes[face.node].id}
        faces.add(shapely.Point(face.at), **serves, heading=face.heading, width=face.width)
    yield from (zones, lanes, nodes, faces)


def _or_nan(value: float | None) -> float:
    return float("nan") if value is None else value
