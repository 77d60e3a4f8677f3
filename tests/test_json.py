"""survey.json: what is written is what is read."""

from __future__ import annotations

import dataclasses
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import zoo
from zoo import ZOO

import groundplan
from groundplan import FormatError, Survey
from groundplan._tree import READING


@pytest.mark.parametrize("name", ZOO)
def test_a_survey_read_back_is_equal_and_writes_the_same_bytes(name: str) -> None:
    survey = zoo.surveyed(name)
    text = survey.to_json()
    again = Survey.from_json(text)
    assert again == survey
    assert again.to_json() == text
    assert again.problems() == []


@pytest.mark.parametrize("name", ZOO)
def test_ids_are_positions_in_their_lists(name: str) -> None:
    tree: dict[str, Any] = json.loads(zoo.surveyed(name).to_json())
    count = {key: len(tree[key]) for key in ("directions", "lines", "vertices", "edges", "faces", "labels")}

    def check(ids: list[int | None], of: str) -> None:
        assert all(n is None or 0 <= n < count[of] for n in ids)

    check([line["direction"] for line in tree["lines"]], "directions")
    for edge in tree["edges"]:
        check(edge["vertices"], "vertices")
        check([edge["line"]], "lines")
        check(edge["faces"], "faces")
        assert (edge["line"] is None) == (None in edge["faces"])
    for face in tree["faces"]:
        check(face["vertices"], "vertices")
        check(face["edges"], "edges")
        assert face["state"] in ("free", "occupied", "unknown")
        for n, edge in enumerate(face["edges"]):
            joined = {face["vertices"][n], face["vertices"][(n + 1) % len(face["vertices"])]}
            assert joined == set(tree["edges"][edge]["vertices"])
    for link in tree["links"]:
        check(link["faces"], "faces")
        check([link["edge"]], "edges")
    for wall in tree["walls"]:
        check([wall["line"]], "lines")
        assert wall["kind"] in ("separating", "freestanding")


def test_a_number_is_written_as_short_as_it_is() -> None:
    tree = json.loads(zoo.surveyed("turned_warehouse").to_json())
    for x, y in tree["vertices"]:
        assert (round(x, 6), round(y, 6)) == (x, y)
    assert "-0.0" not in json.dumps(tree["vertices"])


def test_a_file_is_written_and_read(tmp_path: Path) -> None:
    survey = zoo.surveyed("comb_of_racks")
    survey.write(tmp_path / "survey.json")
    assert Survey.read(tmp_path / "survey.json") == survey
    with pytest.raises(FormatError) as missing:
        Survey.read(tmp_path / "none.json")
    assert missing.value.code == "survey.read"


def test_a_survey_differs_when_a_part_does() -> None:
    survey = zoo.surveyed("single_room")
    tree = json.loads(survey.to_json())
    tree["faces"][0]["area"] += 1.0
    assert Survey.from_json(json.dumps(tree)) != survey


@pytest.mark.parametrize(
    ("change", "code"),
    [
        ({"format": "another"}, "survey.format"),
        ({"version": 2}, "survey.version"),
        ({"version": None}, "survey.version"),
        ({"faces": [{}]}, "survey.content"),
        ({"vertices": [[1.0, 2.0], [3.0]]}, "survey.content"),
        ({"lines": 7}, "survey.content"),
        ({"map": {}}, "survey.content"),
        ({"evidence": None}, "survey.content"),
        ({"labels": [{"kind": "pillar", "at": [float("nan"), 0.0]}]}, "survey.content"),
        ({"labels": [{"kind": "region", "at": [1.0, 0.0]}]}, "survey.content"),
        ({"labels": [{"kind": "door", "width": 0.9}]}, "survey.content"),
        ({"labels": [{"kind": "pillar", "at": [1.0, 0.0], "width": float("inf")}]}, "survey.content"),
    ],
)
def test_what_is_no_survey_is_refused_by_name(change: dict[str, Any], code: str) -> None:
    tree = json.loads(zoo.surveyed("single_room").to_json()) | change
    with pytest.raises(FormatError) as refused:
        Survey.from_json(json.dumps(tree))
    assert refused.value.code == code


@pytest.mark.parametrize("text", ["", "{", "[]", "null", "7", "\x00", "[" * 100_000])
def test_what_is_not_json_is_refused(text: str) -> None:
    with pytest.raises(FormatError) as refused:
        Survey.from_json(text)
    assert refused.value.code in ("survey.json", "survey.format")


@pytest.mark.parametrize("part", ["directions", "lines", "vertices", "edges", "faces", "links", "walls", "labels"])
def test_a_survey_cut_short_is_refused(part: str) -> None:
    tree = json.loads(zoo.surveyed("single_room").to_json())
    del tree[part]
    with pytest.raises(FormatError) as refused:
        Survey.from_json(json.dumps(tree))
    assert refused.value.code == "survey.content"


def test_a_survey_with_ids_that_are_not_there_has_problems() -> None:
    tree = json.loads(zoo.surveyed("single_room").to_json())
    tree["faces"][0]["vertices"][0] = 10_000
    assert Survey.from_json(json.dumps(tree)).problems() != []


def test_arrays_have_the_types_they_say() -> None:
    again = Survey.from_json(zoo.surveyed("empty").to_json())
    assert again.adjacency.faces.shape == (0, 2)
    assert again.walls.points.shape == (0, 2)
    assert again.lines.directions.dtype == np.uint32
    assert again.adjacency.connected.dtype == np.bool_


def test_every_key_is_described() -> None:
    page = (Path(__file__).parents[1] / "docs/survey.md").read_text(encoding="utf-8")
    trees = [json.loads(dataclasses.replace(zoo.surveyed(name), source="map.yaml").to_json()) for name in ZOO]
    for part in trees[0]:
        assert f"\n| `{part}` |" in page
    for tree in trees:
        for part in tree.keys() - {"format", "version", "parameters", "vertices", "labels"}:
            described = page.partition(f"**{part}**:")[2].partition("\n\n")[0]
            records = tree[part] if isinstance(tree[part], list) else [tree[part]]
            keys = {key for entry in records for key in entry}
            assert {key for key in keys if f"`{key}`" not in described} == set(), part
        for label in tree["labels"]:
            row = page.partition(f"\n| `{label['kind']}` |")[2].partition("\n")[0]
            assert {key for key in label if key != "kind" and f"`{key}`" not in row} == set(), label["kind"]
    assert all(f"`{name}`" in page for name in READING)


def test_every_warning_is_described() -> None:
    root = Path(__file__).parents[1]
    sources = [*(root / "python").rglob("*.py"), *(root / "crates").rglob("*.rs")]
    told = r"(?:MapWarning\(|warn\(|Warning \{\s*code:)\s*\"([a-z-]+)\""
    codes = {code for path in sources for code in re.findall(told, path.read_text(encoding="utf-8"))}
    page = (root / "docs/survey.md").read_text(encoding="utf-8")
    table = page.partition("**warnings**:")[2].partition("\n\n**")[0]
    rows = [row.split("|")[1] for row in table.splitlines() if row.startswith("| `")]
    assert {code for row in rows for code in re.findall(r"`([a-z-]+)`", row)} == codes


def test_a_survey_is_written_without_making_all_labels_at_once(tmp_path: Path) -> None:
    survey = groundplan.survey(ZOO["turned_warehouse"](), resolution=zoo.RESOLUTION)
    survey.write(tmp_path / "survey.json")
    assert "labels" not in survey.__dict__
    text = survey.to_json()
    assert survey.labels and survey.labels is survey.labels
    assert survey.labels == json.loads(text)["labels"]
    assert text == survey.to_json() == (tmp_path / "survey.json").read_text(encoding="utf-8")


def test_parts_of_many_records_are_written_as_one_list(monkeypatch: pytest.MonkeyPatch) -> None:
    survey = zoo.surveyed("turned_warehouse")
    text = survey.to_json()
    monkeypatch.setattr("groundplan._tree.RECORDS", 7)
    assert survey.to_json() == text
    assert json.loads(text) == json.loads(json.dumps(survey.to_dict()))
