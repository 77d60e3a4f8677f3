"""The graph as node-link JSON, read by networkx."""

from __future__ import annotations

from pathlib import Path

import networkx
import pytest
from _exports import GOOD, ODD, loads, once


@pytest.mark.parametrize("which", GOOD)
def test_the_graph_of_faces_comes_back(which: str, tmp_path: Path) -> None:
    survey = GOOD[which]()
    read = networkx.node_link_graph(loads(once(survey, "json", tmp_path, graph="faces")), edges="edges")
    expected = survey.to_networkx()
    assert set(read) == set(expected) and set(read.edges) == set(expected.edges)
    for face, values in read.nodes(data=True):
        assert (values["x"], values["y"]) == pytest.approx(expected.nodes[face]["centre"], abs=1e-3)


@pytest.mark.parametrize("which", [*GOOD, *ODD])
def test_the_graph_of_places_comes_back(which: str, tmp_path: Path) -> None:
    survey = (GOOD | ODD)[which]()
    read = networkx.node_link_graph(loads(once(survey, "json", tmp_path)), edges="edges")
    assert sorted(label for _, label in read.nodes(data="label")) == list(range(len(survey.labels)))
    for n, label in enumerate(survey.labels):
        met = [m for m in label.get("corridors", ()) if m < len(survey.labels)]
        by_label = {number: node for node, number in read.nodes(data="label")}
        assert all(read.has_edge(by_label[n], by_label[m]) for m in met)
