"""GraphML, as networkx, Gephi, yEd and igraph read it."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

import networkx

from groundplan._files import write_bytes
from groundplan.export import _graphs

if TYPE_CHECKING:
    from groundplan.survey import Survey


def write(survey: Survey, path: Path, graph: str = "places", **roads: Any) -> list[Path]:
    """Write the graph of places, of faces, or of roads, with the options of `road_map`."""
    made = _graphs.graph(survey, graph, roads)
    text = io.BytesIO()
    networkx.write_graphml_xml(made, text)
    write_bytes(path, text.getvalue())
    return [path]
