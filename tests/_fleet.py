"""Readers of fleets' formats, written from what their loaders demand and apart from the writers."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import yaml
from _exports import loads

#: A road map as every one of these formats can say it: (x, y) by a node's id, and (start, end) of each directed edge.
Roads = tuple[dict[str, tuple[float, float]], set[tuple[str, str]]]


def route_graph(path: Path, ours: bool = True) -> tuple[Roads, dict[str, Any]]:
    """A graph as the Nav2 Route Server's GeoJSON loader takes it; and each edge's metadata by its id in them.

    Points are nodes, line strings are edges, all else is passed over. Ids are 32-bit and their own, an edge's ends
    exist, metadata are plain values or flat lists, coordinates 32-bit floats. In ours metadata have ids, and numbers
    among them are floats.
    """
    nodes: dict[int, tuple[float, float]] = {}
    names: dict[int, str] = {}
    edges: dict[int, tuple[int, int]] = {}
    told = {}
    for feature in loads(path)["features"]:
        values, shape = feature["properties"], feature["geometry"]
        number, metadata = values["id"], values.get("metadata", {})
        assert isinstance(number, int) and 0 <= number < 2**32 and number not in nodes
        assert not ours or number not in edges  # one of Nav2's graphs tells edges twice
        _plain(metadata, ours)
        metadata = metadata if ours else {"id": str(number)} | metadata
        if shape["type"] == "Point":
            x, y = (struct.unpack("f", struct.pack("f", value))[0] for value in shape["coordinates"])
            nodes[number], names[number] = (x, y), metadata["id"]
        elif shape["type"] in ("LineString", "MultiLineString"):
            edges[number] = values["startid"], values["endid"]
            told[metadata["id"]] = metadata
    assert nodes and edges and all(end in nodes for ends in edges.values() for end in ends)
    assert len(set(names.values())) == len(nodes) and len(set(edges.values())) == len(edges)
    return ({names[n]: at for n, at in nodes.items()}, {(names[a], names[b]) for a, b in edges.values()}), told


def _plain(value: Any, floats: bool, listed: bool = False) -> None:
    """What the loader's conversion to its metadata takes."""
    if isinstance(value, dict) and not listed:
        for inner in value.values():
            _plain(inner, floats)
    elif isinstance(value, list) and not listed:
        for inner in value:
            _plain(inner, floats, listed=True)
    else:
        taken = bool | float | str if floats else bool | float | str | int
        assert isinstance(value, taken), f"{value!r} stops the loader, or becomes another type"


def building(path: Path) -> tuple[Roads, dict[str, Any]]:
    """A building.yaml as building_map_tools reads it: typed parameters, positions in lists; and its one level."""
    tree = yaml.safe_load(path.read_text("utf-8"))
    assert tree["coordinate_system"] == "cartesian_meters" and isinstance(tree["name"], str)
    ((_, level),) = tree["levels"].items()
    count = len(level["vertices"])
    assert isinstance(level["elevation"], float)
    for x, y, z, name, parameters in level["vertices"]:
        assert all(isinstance(value, float) for value in (x, y, z)) and isinstance(name, str)
        _typed(parameters)
    names = [vertex[3] for vertex in level["vertices"]]
    assert len({name for name in names if name}) == sum(bool(name) for name in names), "a waypoint's name is told twice"
    for a, b, parameters in [*level["lanes"], *level["walls"], *level["doors"]]:
        assert 0 <= a < count and 0 <= b < count and a != b
        _typed(parameters)
    edges = set()
    for a, b, parameters in level["lanes"]:
        assert {"bidirectional", "graph_idx", "orientation", "speed_limit", "mutex"} <= set(parameters)
        edges |= {(a, b), (b, a)} if parameters["bidirectional"][1] else {(a, b)}
    for floor in level["floors"]:
        _typed(floor["parameters"])
        assert len(floor["vertices"]) >= 3 and all(0 <= n < count for n in floor["vertices"])
    at = {vertex[3]: (vertex[0], vertex[1]) for vertex in level["vertices"] if vertex[3]}
    return (at, {(names[a], names[b]) for a, b in edges}), level


def _typed(parameters: dict[str, Any]) -> None:
    for kind, value in parameters.values():
        assert type(value) is {1: str, 2: int, 3: float, 4: bool}[kind]


def navigation_graph(path: Path) -> tuple[Roads, dict[str, Any]]:
    """A navigation graph as rmf_fleet_adapter parses it: every lane one-way, names unique; and its one level."""
    tree = yaml.safe_load(path.read_text("utf-8"))
    assert isinstance(tree["building_name"], str)
    ((_, level),) = tree["levels"].items()
    names = [parameters["name"] for _, _, parameters in level["vertices"]]
    assert len(set(names)) == len(names), "a duplicate waypoint is fatal"
    assert all(isinstance(value, float) for x, y, _ in level["vertices"] for value in (x, y))
    for a, b, parameters in level["lanes"]:
        assert 0 <= a < len(names) and 0 <= b < len(names)
        assert set(parameters) <= {"speed_limit", "orientation_constraint", "door_name", "dock_name", "mutex"}
    at = {name: (x, y) for name, (x, y, _) in zip(names, level["vertices"], strict=True)}
    return (at, {(names[a], names[b]) for a, b, _ in level["lanes"]}), level
