"""The graph as GraphML, read by networkx and checked against what XML can hold."""

from __future__ import annotations

from pathlib import Path

import networkx
import pytest
from _exports import GOOD, ODD, demo, odd_names, once
from lxml import etree


@pytest.mark.parametrize("which", GOOD)
def test_faces_and_links_come_back(which: str, tmp_path: Path) -> None:
    survey = GOOD[which]()
    read = networkx.read_graphml(once(survey, "graphml", tmp_path, graph="faces"), node_type=int)
    expected = survey.to_networkx()
    assert set(read) == set(expected) and read.number_of_edges() == expected.number_of_edges()
    for face, values in read.nodes(data=True):
        assert (values["x"], values["y"]) == pytest.approx(expected.nodes[face]["centre"], abs=1e-3)
        assert values["state"] == expected.nodes[face]["state"]
    for a, b, values in read.edges(data=True):
        assert values["connected"] is expected.edges[a, b]["connected"]


def test_places_come_back_and_aisles_hang_together(tmp_path: Path) -> None:
    read = networkx.read_graphml(once(demo(), "graphml", tmp_path))
    assert read.number_of_nodes() == len(demo().labels)
    ways = [node for node, kind in read.nodes(data="kind") if kind in ("corridor", "junction")]
    assert networkx.is_connected(read.subgraph(ways))
    assert read.nodes["A01"]["width"] == pytest.approx(demo().labels[0]["width"], abs=1e-3)
    assert read.graph["units"] == "m" and read.nodes["A01"]["name"] == "A01"


@pytest.mark.parametrize("which", ODD)
def test_an_odd_survey_is_good_xml(which: str, tmp_path: Path) -> None:
    survey = ODD[which]()
    file = once(survey, "graphml", tmp_path)
    etree.parse(file)
    assert networkx.read_graphml(file).number_of_nodes() == len(survey.labels)


def test_names_come_back(tmp_path: Path) -> None:
    read = networkx.read_graphml(once(odd_names(), "graphml", tmp_path))
    names = [name for _, name in sorted((label, read.nodes[n]["name"]) for n, label in read.nodes(data="label"))]
    assert names[1:4] == ["O'Brien & <Söhne>, 50 %", "Gang Ä; Ölüm", "冷蔵庫 🚜"]
