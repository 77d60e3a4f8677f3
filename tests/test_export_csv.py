"""The table of places, read by Python's csv and shapely's WKT."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest
import shapely
from _exports import GOOD, NAMES, demo, odd_names, once


def rows(path: Path) -> list[dict[str, str]]:
    """The table's rows by the names of its columns."""
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file, strict=True))


@pytest.mark.parametrize("which", GOOD)
def test_every_label_is_a_row_with_its_shape_to_a_millimetre(which: str, tmp_path: Path) -> None:
    survey = GOOD[which]()
    table = rows(once(survey, "csv", tmp_path))
    assert [row["kind"] for row in table] == [label["kind"] for label in survey.labels]
    assert len({row["id"] for row in table}) == len(table)
    for row, label in zip(table, survey.labels, strict=True):
        assert row["name"] == label.get("name", row["name"])
        if row["kind"] == "region":
            # What a region's area leaves out is too small to be a hole of its outline.
            assert float(row["area"]) == pytest.approx(label["area"], abs=1e-3)
            assert shapely.from_wkt(row["polygon"]).area == pytest.approx(float(row["area"]), rel=0.05)
        elif "polygon" in label:
            given, read = shapely.Polygon(label["polygon"]), shapely.from_wkt(row["polygon"])
            assert read.is_valid and shapely.hausdorff_distance(given, read) < 1e-3
        if "at" in label:
            assert (float(row["x"]), float(row["y"])) == pytest.approx(label["at"], abs=1e-3)
        if "width" in label:
            assert float(row["width"]) == pytest.approx(label["width"], abs=1e-3)


def test_neighbours_know_each_other_and_an_aisle_knows_its_junctions_and_racks(tmp_path: Path) -> None:
    by_id = {row["id"]: row for row in rows(once(demo(), "csv", tmp_path))}
    for row in by_id.values():
        for other in filter(None, row["neighbours"].split(";")):
            assert row["id"] in by_id[other]["neighbours"].split(";")
    beside = by_id["A03"]["neighbours"].split(";")
    assert beside[:3] == ["J04", "J05", "J06"]
    assert sorted(beside[3:]) == ["S2-03", "S2-08", "S3-03", "S3-08"]
    assert by_id["A03"]["region"] == "R3-05"
    # A rack's own ground is in no region, but its aisles are.
    assert {row["region"] for row in by_id.values() if row["kind"] == "rack"} == {"R3-05"}


def test_names_come_back_in_one_line(tmp_path: Path) -> None:
    table = rows(once(odd_names(), "csv", tmp_path))
    names = [row["name"] for row in table]
    assert names[:5] == ['The "big" one', "O'Brien & <Söhne>, 50 %", "Gang Ä; Ölüm", "冷蔵庫 🚜", "two lines and tabs"]
    assert names[10] == "null and bell" and names[11] == "half letter"
    assert len({row["id"] for row in table}) == len(table)
    assert [row["id"] for row in table[7:9]] == ["same", "same-2"] and len(NAMES) > 8
