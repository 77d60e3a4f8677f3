"""The drawing, read by ezdxf and by GDAL, and printed by LibreCAD."""

from __future__ import annotations

import math
import os
import shutil
import subprocess
from collections import Counter
from pathlib import Path
from typing import Any

import ezdxf.filemanagement
import numpy as np
import pyogrio
import pytest
import shapely
from _exports import GOOD, ODD, demo, odd_names, once, shifted
from conftest import ROOT
from ezdxf.document import Drawing
from PIL import Image

import groundplan
from groundplan import FormatError, ParameterError
from groundplan.export._layers import LAYERS
from groundplan.roadmap import road_map


def read(path: Path) -> Drawing:
    """The drawing, in which ezdxf finds no fault."""
    drawing = ezdxf.filemanagement.readfile(path)
    auditor = drawing.audit()
    assert auditor.errors == [] and auditor.fixes == []
    return drawing


def on_layer(drawing: Drawing, what: str, kind: str = "*") -> list[Any]:
    """Entities of a kind on the layer of what is drawn."""
    return list(drawing.modelspace().query(f'{kind}[layer=="{LAYERS[what].name}"]'))


def apart(a: Any, b: Any) -> float:
    """How far two geometries are apart at most."""
    return float(shapely.hausdorff_distance(a, b))


@pytest.mark.parametrize("which", GOOD)
@pytest.mark.parametrize(("units", "scale", "number"), [("m", 1.0, 6), ("mm", 1000.0, 4)])
def test_what_was_found_is_drawn_to_a_millimetre(
    which: str, units: str, scale: float, number: int, tmp_path: Path
) -> None:
    survey = GOOD[which]()
    drawing = read(once(survey, "dxf", tmp_path, units=units))
    assert drawing.dxfversion == "AC1024"
    assert (drawing.header["$INSUNITS"], drawing.header["$MEASUREMENT"]) == (number, 1)
    walls = [*on_layer(drawing, "wall", "LINE"), *on_layer(drawing, "freestanding", "LINE")]
    ids = [int(wall.get_xdata("GROUNDPLAN")[0].value.split()[1]) for wall in walls]
    assert sorted(ids) == list(range(len(survey.walls)))
    expected = survey.walls.points.reshape(-1, 4)[ids] * scale
    drawn = np.array([[*w.dxf.start.vec2, *w.dxf.end.vec2] for w in walls]).reshape(-1, 4)
    assert np.abs(drawn - expected).max(initial=0) < 1e-3 * scale
    for what, kind in (("rack", "rack"), ("corridor", "corridor")):
        rings = on_layer(drawing, what, "LWPOLYLINE")
        labels = [shapely.Polygon(np.array(label["polygon"]) * scale) for label in survey.of_kind(kind)]
        assert len(rings) == len(labels) and all(ring.closed for ring in rings)
        for ring, label in zip(rings, labels, strict=True):
            assert apart(shapely.Polygon(ring.get_points("xy")), label) < 1e-3 * scale
    axes = on_layer(drawing, "axis", "LINE")
    for line, label in zip(axes, survey.of_kind("corridor"), strict=True):
        assert np.allclose([line.dxf.start.vec2, line.dxf.end.vec2], np.array(label["axis"]) * scale, atol=1e-3 * scale)


@pytest.mark.parametrize("which", GOOD)
def test_the_lines_of_the_directions_run_across_the_map(which: str, tmp_path: Path) -> None:
    survey = GOOD[which]()
    for line in on_layer(read(once(survey, "dxf", tmp_path)), "line", "LINE"):
        number = int(line.get_xdata("GROUNDPLAN")[0].value.split()[1])
        angle = survey.directions.angles[survey.lines.directions[number]]
        for end in (line.dxf.start, line.dxf.end):
            offset = -end.x * math.sin(angle) + end.y * math.cos(angle)
            assert offset == pytest.approx(survey.lines.offsets[number], abs=1e-3)


def test_the_road_map_is_drawn_with_its_ids(tmp_path: Path) -> None:
    drawing, roads = read(once(demo(), "dxf", tmp_path)), road_map(demo())
    nodes = {insert.get_attrib_text("ID"): insert for insert in on_layer(drawing, "node", "INSERT")}
    assert set(nodes) == {node.id for node in roads.nodes}
    for node in roads.nodes:
        insert = nodes[node.id]
        assert math.dist(insert.dxf.insert.vec2, node.at) < 1e-3
        assert (insert.get_attrib_text("KIND"), insert.get_attrib_text("TYPE")) == (node.kind, node.type)
    lanes = {line.get_xdata("GROUNDPLAN")[0].value: line for line in on_layer(drawing, "lane", "LINE")}
    assert set(lanes) == {lane.id for lane in roads.lanes}
    for lane in roads.lanes:
        assert math.dist(lanes[lane.id].dxf.start.vec2, roads.nodes[lane.start].at) < 1e-3
        assert math.dist(lanes[lane.id].dxf.end.vec2, roads.nodes[lane.end].at) < 1e-3
    assert len(on_layer(drawing, "keep-out", "LWPOLYLINE")) == len(demo().of_kind("rack"))
    narrow = read(once(demo(), "dxf", tmp_path, vehicle_width=50.0))
    assert on_layer(narrow, "lane") == on_layer(narrow, "node") == []


def test_every_place_is_a_block_with_its_attributes(tmp_path: Path) -> None:
    drawing = read(once(demo(), "dxf", tmp_path))
    found = [insert.attribs for insert in on_layer(drawing, "place", "INSERT")]
    values = [{attribute.dxf.tag: attribute.dxf.text for attribute in attributes} for attributes in found]
    assert Counter(v["KIND"] for v in values) == Counter(label["kind"] for label in demo().labels)
    aisle = next(v for v in values if v["ID"] == "A01")
    assert float(aisle["WIDTH"]) == pytest.approx(demo().of_kind("corridor")[0]["width"], abs=1e-3)
    assert aisle["REGION"] in {v["ID"] for v in values if v["KIND"] == "region"}
    names = [text.plain_text() for text in on_layer(drawing, "name", "MTEXT")]
    assert sorted(names) == sorted(label["name"] for label in demo().labels if label.get("name"))


def test_gdal_reads_the_same_layers(tmp_path: Path) -> None:
    path = once(demo(), "dxf", tmp_path)
    _, _, geometry, fields = pyogrio.raw.read(path, columns=["Layer"])
    counts = Counter(fields[0].tolist())
    assert counts[LAYERS["rack"].name] == len(demo().of_kind("rack"))
    assert counts[LAYERS["axis"].name] == len(demo().of_kind("corridor"))
    assert counts[LAYERS["lane"].name] == len(road_map(demo()).lanes)
    rack = shapely.from_wkb(geometry[fields[0].tolist().index(LAYERS["rack"].name)])
    assert apart(shapely.Polygon(rack), shapely.Polygon(demo().of_kind("rack")[0]["polygon"])) < 1e-3


@pytest.mark.parametrize("yaw", [0.0, 0.7])
def test_the_map_lies_beneath_the_drawing(yaw: float, tmp_path: Path) -> None:
    map = groundplan.read(ROOT / "examples" / "warehouse.yaml", origin=(1200.5, -830.25, yaw))
    survey = shifted() if yaw else groundplan.survey(map, threads=1)
    written = survey.export(tmp_path / "plan.dxf", map=map)
    assert [file.name for file in written] == ["plan.dxf", "plan.underlay.png"]
    drawing = read(written[0])
    (image,) = on_layer(drawing, "map", "IMAGE")
    # White names on a dark sheet are read on the picture's white floor.
    assert 50 <= image.dxf.fade <= 80
    assert image.image_def.dxf.filename == "plan.underlay.png"
    assert (image.dxf.insert.x, image.dxf.insert.y) == pytest.approx((1200.5, -830.25))
    assert image.dxf.u_pixel.magnitude == pytest.approx(map.resolution)
    assert image.dxf.u_pixel.angle == pytest.approx(yaw)
    with Image.open(written[1]) as picture:
        assert picture.size == (map.width, map.height)
        greys = np.asarray(picture)
    assert np.array_equal(greys == 90, map.states[map.pixels] == 1)


def test_layers_are_renamed_by_a_table(tmp_path: Path) -> None:
    toml, table = tmp_path / "layers.toml", tmp_path / "layers.csv"
    toml.write_text('[layers]\nwall = "Wände"\nrack = {name = "Q-RACK", color = 12, linetype = "dashed", on = false}\n')
    table.write_text("what,name,color,linetype,on\nwall,Wände,,,\nrack,Q-RACK,12,DASHED,no\n", encoding="utf-8")
    drawings = [read(once(demo(), "dxf", tmp_path, layers=file)) for file in (toml, table)]
    for drawing in drawings:
        rack = drawing.layers.get("Q-RACK")
        assert (rack.dxf.color, rack.dxf.linetype, rack.is_frozen()) == (12, "DASHED", True)
        assert "Wände" in drawing.layers and "A-WALL" not in drawing.layers
        assert len(drawing.modelspace().query('LWPOLYLINE[layer=="Q-RACK"]')) == len(demo().of_kind("rack"))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[layers]\nwal = 'X'", "there is no 'wal' to draw"),
        ("[layers]\nwall = 'a/b'", "the layer of .*wall is 'a/b'"),
        ("[layers]\nwall = {name = ' '}", "the layer of .*wall is ' '"),
        ("[layers]\nwall = {color = 300}", "the color of .*wall is 300"),
        ("[layers]\nwall = {linetype = 'WAVY'}", "the linetype of .*wall is 'WAVY'"),
        ("[layers]\nwall = {colour = 3}", "wall is {'colour': 3}"),
        ("[walls]", r"has no table \[layers\]"),
    ],
)
def test_a_table_of_layers_that_is_none_is_refused_by_its_value(text: str, said: str, tmp_path: Path) -> None:
    file = tmp_path / "layers.toml"
    file.write_text(text)
    with pytest.raises(ParameterError, match=said):
        once(demo(), "dxf", tmp_path, layers=file)
    assert not list(tmp_path.glob("*.dxf"))


def test_a_table_of_layers_that_cannot_be_read_is_refused(tmp_path: Path) -> None:
    for name, content in (("none.toml", None), ("bad.toml", b"[layers"), ("bytes.csv", b"\xff\xfe\x00")):
        if content is not None:
            (tmp_path / name).write_bytes(content)
        with pytest.raises(FormatError, match=name):
            once(demo(), "dxf", tmp_path, layers=tmp_path / name)
    (tmp_path / "head.csv").write_text("layer,colour\n")
    with pytest.raises(ParameterError, match="no head"):
        once(demo(), "dxf", tmp_path, layers=tmp_path / "head.csv")


@pytest.mark.parametrize("which", ODD)
def test_an_odd_survey_is_a_good_drawing(which: str, tmp_path: Path) -> None:
    survey = ODD[which]()
    assert len(on_layer(read(once(survey, "dxf", tmp_path)), "place", "INSERT")) == len(survey.labels)


def test_names_come_back_as_they_were_typed(tmp_path: Path) -> None:
    drawing = read(once(odd_names(), "dxf", tmp_path))
    names = [text.plain_text() for text in on_layer(drawing, "name", "MTEXT")]
    for name in ('The "big" one', "O'Brien & <Söhne>, 50 %", "Gang Ä; Ölüm", "冷蔵庫 🚜", "two lines and tabs", "=1+1"):
        assert name in names
    assert r"% %d \P {x}" in names  # a doubled percent sign would be a degree


def test_librecad_prints_it(tmp_path: Path) -> None:
    for program, package in (("librecad", "librecad"), ("pdftoppm", "poppler-utils")):
        if shutil.which(program) is None:
            pytest.skip(f"needs {program}: apt-get install {package}")
    map = groundplan.read(ROOT / "examples" / "warehouse.yaml")
    path = demo().export(tmp_path / "plan.dxf", map=map)[0]
    place = {"XDG_RUNTIME_DIR": str(tmp_path), "HOME": str(tmp_path), "QT_QPA_PLATFORM": "offscreen"}
    quiet: dict[str, Any] = {"cwd": tmp_path, "check": True, "capture_output": True, "timeout": 120}
    subprocess.run(["librecad", "dxf2pdf", "-a", "-m", path.name], env=os.environ | place, **quiet)
    subprocess.run(["pdftoppm", "-r", "100", "-gray", "-png", "-singlefile", "plan.pdf", "plan"], **quiet)
    with Image.open(tmp_path / "plan.png") as picture:
        ink = np.asarray(picture.convert("L")) < 250
    rows, columns = np.flatnonzero(ink.any(axis=1)), np.flatnonzero(ink.any(axis=0))
    drawing = read(path)
    wide, high = (b - a for a, b in zip(drawing.header["$EXTMIN"][:2], drawing.header["$EXTMAX"][:2], strict=True))
    # The whole drawing is on the sheet, and as large as fits it.
    assert np.ptp(columns) / np.ptp(rows) == pytest.approx(wide / high, rel=0.03)
    assert max(np.ptp(columns) / ink.shape[1], np.ptp(rows) / ink.shape[0]) > 0.85
    assert 0.02 < ink.mean() < 0.9
