"""The GeoPackage, read as the specification has it (SQLite tables and well-known binary) and by QGIS."""

from __future__ import annotations

import json
import sqlite3
import subprocess
from contextlib import closing
from pathlib import Path
from typing import Any

import pyogrio
import pytest
import shapely
from _exports import GOOD, ODD, demo, odd_names, once

from groundplan.roadmap import road_map

#: Debian's QGIS belongs to Debian's Python, not to ours.
SYSTEM_PYTHON = Path("/usr/bin/python3")
QGIS = """
import json, os, sys
from qgis.core import QgsApplication, QgsVectorLayer
QgsApplication.setPrefixPath("/usr", True)
app = QgsApplication([], False)
app.initQgis()
told = {}
for name in sys.argv[2].split(","):
    layer = QgsVectorLayer(f"{sys.argv[1]}|layername={name}", name, "ogr")
    box = layer.extent()
    told[name] = {
        "valid": layer.isValid(), "count": layer.featureCount(), "broken": sum(
            not feature.geometry().isGeosValid() for feature in layer.getFeatures()),
        "extent": [box.xMinimum(), box.yMinimum(), box.xMaximum(), box.yMaximum()],
        "degrees": layer.crs().isGeographic(), "fields": [field.name() for field in layer.fields()],
    }
print(json.dumps(told), flush=True)
os._exit(0)  # its own way out crashes while layers are open
"""


def tables(path: Path) -> dict[str, list[tuple[Any, dict[str, Any]]]]:
    """Every layer's shapes and values, by the tables of OGC 12-128."""
    with closing(sqlite3.connect(f"file:{path}?mode=ro", uri=True)) as base:
        base.row_factory = sqlite3.Row
        named = base.execute("SELECT table_name, column_name FROM gpkg_geometry_columns").fetchall()
        return {
            table: [
                (shape_of(row[column]), {key: value for key, value in dict(row).items() if key != column})
                for row in base.execute(f'SELECT * FROM "{table}" ORDER BY fid')
            ]
            for table, column in named
        }


def shape_of(blob: bytes) -> Any:
    """A geometry behind its GeoPackage header (section 2.1.3): magic, flags, frame, envelope."""
    assert blob[:2] == b"GP" and blob[2] == 0
    assert int.from_bytes(blob[4:8], "little" if blob[3] & 1 else "big", signed=True) == -1
    envelope = (0, 32, 48, 48, 64)[blob[3] >> 1 & 7]
    return shapely.from_wkb(blob[8 + envelope :])


@pytest.mark.parametrize("which", GOOD)
def test_layers_come_back_with_their_shapes_to_a_millimetre(which: str, tmp_path: Path) -> None:
    survey = GOOD[which]()
    read = tables(once(survey, "gpkg", tmp_path))
    assert len(read["faces"]) == len(survey.subdivision.areas) and len(read["links"]) == len(survey.adjacency.edges)
    assert len(read["walls"]) == len(survey.walls) and len(read["lines"]) == len(survey.lines)
    for (shape, values), area in zip(read["faces"], survey.subdivision.areas, strict=True):
        assert shape.is_valid and shape.area == pytest.approx(area, abs=1e-3) == values["area"]
    for (shape, _), ends in zip(read["walls"], survey.walls.points.reshape(-1, 2, 2).tolist(), strict=True):
        assert list(shape.coords) == [pytest.approx(end, abs=1e-3) for end in ends]
    for layer, kind in (("corridors", "corridor"), ("racks", "rack"), ("regions", "region"), ("doors", "door")):
        labels = survey.of_kind(kind)
        assert [values["name"] for _, values in read.get(layer, [])] == [
            label.get("name", values["name"]) for label, (_, values) in zip(labels, read.get(layer, []), strict=True)
        ]


def test_the_road_map_comes_back_with_its_nodes_and_free_widths(tmp_path: Path) -> None:
    survey, rules = demo(), [{"name": "A03", "way": "forward", "speed": 0.8}]
    read = tables(once(survey, "gpkg", tmp_path, rules=rules, spurs=0.6))
    roads = road_map(survey, rules=rules, spurs=0.6)
    at = {values["id"]: shape for shape, values in read["road_nodes"]}
    assert {id: shape.coords[0] for id, shape in at.items()} == {
        node.id: pytest.approx(node.at, abs=1e-3) for node in roads.nodes
    }
    for (shape, values), lane in zip(read["road_lanes"], roads.lanes, strict=True):
        assert shape.boundary.geoms[0] == at[values["start"]] and shape.boundary.geoms[1] == at[values["end"]]
        assert (values["id"], values["left"], values["right"]) == (lane.id, lane.left, lane.right)
        assert (values["speed"], values["way"]) == (lane.speed, lane.way)
    assert {values["node"] for _, values in read["pick_faces"]} <= set(at)
    assert len(read["pick_faces"]) == len(roads.faces) and len(read["road_zones"]) == len(roads.zones)


def test_the_frame_is_an_undefined_cartesian_one_of_metres(tmp_path: Path) -> None:
    file = once(demo(), "gpkg", tmp_path, date="2026-05-01")
    with closing(sqlite3.connect(file)) as base:
        assert base.execute("PRAGMA application_id").fetchone() == (0x47504B47,)  # GPKG
        assert base.execute("PRAGMA integrity_check").fetchone() == ("ok",)
        assert {srs for (srs,) in base.execute("SELECT srs_id FROM gpkg_contents")} == {-1}
        assert {date for (date,) in base.execute("SELECT last_change FROM gpkg_contents")} == {"2026-05-01T00:00:00Z"}


def test_gdal_reads_every_layer_to_a_millimetre(tmp_path: Path) -> None:
    file = once(demo(), "gpkg", tmp_path)
    expected = tables(file)
    assert {name for name, _ in pyogrio.list_layers(file)} == set(expected)
    for name, features in expected.items():
        _, _, blobs, _ = pyogrio.raw.read(file, layer=name)
        apart = shapely.hausdorff_distance(shapely.from_wkb(blobs), [shape for shape, _ in features])
        assert len(blobs) == len(features) and apart.max() < 1e-3


def test_names_come_back_in_one_line(tmp_path: Path) -> None:
    names = [values["name"] for _, values in tables(once(odd_names(), "gpkg", tmp_path))["corridors"]]
    assert names[:4] == ['The "big" one', "O'Brien & <Söhne>, 50 %", "Gang Ä; Ölüm", "冷蔵庫 🚜"]


def test_writing_over_a_geopackage_leaves_nothing_of_it(tmp_path: Path) -> None:
    once(demo(), "gpkg", tmp_path)
    file = once(ODD["room"](), "gpkg", tmp_path)
    assert len(tables(file)["faces"]) == len(ODD["room"]().subdivision.areas)
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.parametrize("which", ["demo", "turned"])
def test_qgis_sees_every_layer_in_metres(which: str, tmp_path: Path) -> None:
    probe = [str(SYSTEM_PYTHON), "-c", "import qgis.core"]
    if not SYSTEM_PYTHON.exists() or subprocess.run(probe, capture_output=True).returncode:
        pytest.skip("needs QGIS: apt-get install python3-qgis")
    survey = GOOD[which]()
    file = once(survey, "gpkg", tmp_path)
    expected = tables(file)
    ran = subprocess.run(
        [str(SYSTEM_PYTHON), "-c", QGIS, str(file), ",".join(expected)],
        capture_output=True,
        text=True,
        env={"QT_QPA_PLATFORM": "offscreen", "HOME": str(tmp_path), "PATH": "/usr/bin:/bin"},
        timeout=120,
    )
    assert ran.returncode == 0, ran.stderr
    for name, told in json.loads(ran.stdout).items():
        assert told["valid"] and told["broken"] == 0 and not told["degrees"] and "id" in told["fields"]
        assert told["count"] == len(expected[name])
        assert told["extent"] == pytest.approx(shapely.total_bounds([s for s, _ in expected[name]]), abs=1e-3)
