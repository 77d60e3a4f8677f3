"""The survey as the objects of other libraries: a graph of networkx, geometries of shapely."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from groundplan._extras import needed
from groundplan._results import STATES
from groundplan._shapes import outline

if TYPE_CHECKING:
    import networkx

    from groundplan.survey import Survey


def to_networkx(survey: Survey) -> networkx.Graph[int]:
    """As `Survey.to_networkx`."""
    nx = needed("networkx", "graph")
    graph = nx.Graph()
    for face, (centre, area) in enumerate(
        zip(survey.subdivision.centres.tolist(), survey.subdivision.areas, strict=True)
    ):
        graph.add_node(
            face,
            centre=tuple(centre),
            area=float(area),
            occupancy=float(survey.occupancy.faces[face]),
            state=STATES[survey.occupancy.states[face]],
        )
    dual = survey.adjacency
    for (a, b), edge, connected in zip(dual.faces.tolist(), dual.edges.tolist(), dual.connected.tolist(), strict=True):
        graph.add_edge(a, b, edge=edge, connected=connected)
    return graph


def to_shapely(survey: Survey) -> dict[str, npt.NDArray[np.object_]]:
    """As `Survey.to_shapely`."""
    shapely = needed("shapely", "geometry")
    cut = survey.subdivision
    rings = shapely.linearrings(
        cut.vertices[cut.face_vertices], indices=np.repeat(np.arange(len(cut.areas)), np.diff(cut.face_offsets))
    )
    return {
        "faces": shapely.polygons(rings),
        "edges": shapely.linestrings(cut.vertices[cut.edge_vertices]),
        "vertices": shapely.points(cut.vertices),
        "walls": shapely.linestrings(survey.walls.points.reshape(-1, 2, 2)),
        "labels": np.array([outline(label) for label in survey.labels], dtype=np.object_),
    }
