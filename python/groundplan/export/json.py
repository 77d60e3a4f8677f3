"""Node-link JSON, as networkx and D3 read it: ``nodes`` and ``edges``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import networkx

from groundplan._files import write_text
from groundplan.export import _graphs

if TYPE_CHECKING:
    from groundplan.survey import Survey


def write(survey: Survey, path: Path, graph: str = "places", **roads: Any) -> list[Path]:
    """Write the graph of places, of faces, or of roads, with the options of `road_map`."""
    tree = networkx.node_link_data(_graphs.graph(survey, graph, roads), edges="edges")
    write_text(path, json.dumps(tree, indent=1, ensure_ascii=False, allow_nan=False) + "\n")
    return [path]
