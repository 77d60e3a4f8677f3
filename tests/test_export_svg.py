"""The plan as SVG: parsed as XML, measured by its own transforms, and drawn by librsvg."""

from __future__ import annotations

import io
import math
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import shapely
from _exports import GOOD, ODD, demo, odd_names, once, shifted
from conftest import ROOT
from lxml import etree
from PIL import Image

import groundplan
from groundplan import ParameterError
from groundplan.maps import OCCUPIED

SVG, INKSCAPE = "{http://www.w3.org/2000/svg}", "{http://www.inkscape.org/namespaces/inkscape}"
Pixels = npt.NDArray[np.int16]
RACK, WALL, CORRIDOR = (199, 154, 43), (176, 30, 70), (0, 158, 115)


def read(file: Path) -> Any:
    """The root of a well-formed document in which no id occurs twice."""
    root = etree.parse(file).getroot()
    ids = [element.get("id") for element in root.iter() if element.get("id")]
    assert root.tag == f"{SVG}svg" and len(set(ids)) == len(ids)
    return root


def layer(root: Any, id: str) -> Any:
    """A layer, as Inkscape knows one."""
    found = [g for g in root.findall(f"{SVG}g") if g.get("id") == f"layer-{id}"]
    assert len(found) == 1 and found[0].get(f"{INKSCAPE}groupmode") == "layer" and found[0].get(f"{INKSCAPE}label")
    return found[0]


def outline(path: Any) -> shapely.Polygon:
    """A path of closed rings as a polygon."""
    rings = [re.findall(r"(-?[\d.]+),(-?[\d.]+)", part) for part in path.get("d").split("Z") if part.strip()]
    points = [[(float(x), float(y)) for x, y in ring] for ring in rings]
    return shapely.Polygon(points[0], points[1:])


class Drawn:
    """What librsvg makes of a file: the colours at places of the map frame."""

    def __init__(self, file: Path, width: int = 2400) -> None:
        program = shutil.which("rsvg-convert")
        if program is None:
            pytest.skip("needs rsvg-convert (Debian's librsvg2-bin)")
        done = subprocess.run([program, "-w", str(width), str(file)], capture_output=True, check=False, timeout=60)
        assert done.returncode == 0 and done.stderr == b"", done.stderr
        with Image.open(io.BytesIO(done.stdout)) as picture:
            self.pixels: Pixels = np.asarray(picture.convert("RGB")).astype(np.int16)
        self.left, self.up, wide, high = (float(part) for part in read(file).get("viewBox").split())
        self.dots = self.pixels.shape[1] / wide
        assert self.pixels.shape[0] == pytest.approx(high * self.dots, abs=1.5)

    def at(self, points: npt.ArrayLike) -> Pixels:
        """The colours at points, y up."""
        x, y = np.asarray(points, dtype=np.float64).reshape(-1, 2).T
        found: Pixels = self.pixels[((-y - self.up) * self.dots).astype(int), ((x - self.left) * self.dots).astype(int)]
        return found


def like(colours: Pixels, hue: tuple[int, int, int], opacity: float = 1.0) -> npt.NDArray[np.bool_]:
    """Which colours are a hue laid over white."""
    expected = 255 - opacity * (255 - np.array(hue))
    near: npt.NDArray[np.bool_] = np.abs(colours - expected).max(axis=-1) < 14
    return near


@pytest.mark.parametrize("which", GOOD)
def test_every_kind_has_its_layer_and_shapes_lie_where_they_are_to_a_millimetre(which: str, tmp_path: Path) -> None:
    survey = GOOD[which]()
    root = read(once(survey, "svg", tmp_path))
    for kind in ("region", "corridor", "rack"):
        own, labels = layer(root, kind), survey.of_kind(kind)
        assert own.get("transform") == "scale(1 -1)" and len(own) == len(labels)
        for path, label in zip(own, labels, strict=True):
            assert path.find(f"{SVG}title").text.startswith(f"{label['name']}, ")
            if kind != "region":
                assert shapely.hausdorff_distance(outline(path), shapely.Polygon(label["polygon"])) < 1e-3
            else:
                given = shapely.Polygon(label["polygon"], label.get("holes"))
                assert outline(path).area == pytest.approx(given.area, rel=1e-3)
    for kind in ("junction", "door", "pillar"):
        assert len(layer(root, kind)) == len(survey.of_kind(kind))
    for disc, label in zip(layer(root, "junction"), survey.of_kind("junction"), strict=True):
        assert (float(disc.get("cx")), float(disc.get("cy"))) == pytest.approx(label["at"], abs=1e-3)
    walls = np.array([[float(w.get(key)) for key in ("x1", "y1", "x2", "y2")] for w in layer(root, "wall")])
    assert np.abs(walls.reshape(-1, 4) - survey.walls.points.reshape(-1, 4)).max() < 1e-3


def test_a_unit_is_a_metre_and_the_paper_is_to_scale(tmp_path: Path) -> None:
    for scale in (50.0, 200.0, 1000.0):
        root = read(once(demo(), "svg", tmp_path, scale=scale))
        _, _, wide, high = (float(part) for part in root.get("viewBox").split())
        assert float(root.get("width").removesuffix("mm")) == pytest.approx(wide * 1000 / scale, abs=0.01)
        assert float(root.get("height").removesuffix("mm")) == pytest.approx(high * 1000 / scale, abs=0.01)
        bar = next(line for line in root.iter(f"{SVG}line") if line.get("id") == "scale-bar")
        assert f"{float(bar.get('x2')) - float(bar.get('x1')):g} m" == bar.find(f"{SVG}title").text
    with pytest.raises(ParameterError, match="the scale is 1 : 0") as told:
        demo().export(tmp_path / "x", "svg", scale=0.0)
    assert told.value.code == "export.scale"


@pytest.mark.parametrize("which", ["demo", "shifted"])
def test_racks_walls_and_aisles_are_drawn_in_their_colours_at_their_places(which: str, tmp_path: Path) -> None:
    survey = GOOD[which]()
    drawn = Drawn(once(survey, "svg", tmp_path))
    walls = survey.walls.points.reshape(-1, 2, 2)
    long = walls[np.hypot(*(walls[:, 1] - walls[:, 0]).T) > 2.0]
    middles = long.mean(axis=1)
    near = np.stack([like(drawn.at(middles + shift), WALL) for shift in ((0, 0), (0.03, 0), (0, 0.03), (-0.03, 0))])
    assert near.any(axis=0).mean() > 0.9
    racks = shapely.union_all([shapely.Polygon(rack["polygon"]) for rack in survey.of_kind("rack")]).buffer(0.2)
    for rack in survey.of_kind("rack"):
        shape = shapely.Polygon(rack["polygon"])
        low, high = np.array(shape.bounds).reshape(2, 2)
        points = np.random.default_rng(1).uniform(low, high, (20_000, 2))
        inside = points[shapely.contains_xy(shape.buffer(-0.2), *points.T)]
        outside = points[~shapely.contains_xy(racks, *points.T)]
        plain, over = (drawn.at(where) for where in (inside, outside))
        # Less blue than anything but the names, the walls and the doors.
        assert (plain[:, 2] < plain[:, 0] - 30).mean() > 0.9 > 0.1 > (over[:, 2] < over[:, 0] - 30).mean()
    corner = [drawn.left + 0.3, -drawn.up - 0.3]
    assert (drawn.at(corner) == 255).all()


@pytest.mark.parametrize("which", ["demo", "shifted"])
def test_the_map_lies_beneath_where_it_is(which: str, tmp_path: Path) -> None:
    origin = None if which == "demo" else (1200.5, -830.25, 0.7)
    map = groundplan.read(ROOT / "examples" / "warehouse.yaml", origin=origin)
    survey = demo() if which == "demo" else shifted()
    file = once(survey, "svg", tmp_path, map=map)
    root = read(file)
    assert len(layer(root, "map")) == 1
    for other in [g for g in root.findall(f"{SVG}g") if g.get("id") != "layer-map"]:
        root.remove(other)  # the map alone
    alone = tmp_path / "alone.svg"
    etree.ElementTree(root).write(alone)
    drawn = Drawn(alone, 4800)
    rows, columns = np.nonzero(map.states[map.pixels] == OCCUPIED)
    u, v = (columns + 0.5) * map.resolution, (map.height - rows - 0.5) * map.resolution
    x, y, yaw = map.origin
    cos, sin = math.cos(yaw), math.sin(yaw)
    at = np.column_stack([x + u * cos - v * sin, y + u * sin + v * cos])
    assert (drawn.at(at).max(axis=1) < 140).mean() > 0.97
    # An error of a pixel would leave most of the walls, one or two pixels thick, off the black.
    assert (drawn.at(at + 3 * map.resolution).max(axis=1) < 140).mean() < 0.6


@pytest.mark.parametrize("which", ODD)
def test_an_odd_survey_is_drawn_without_complaint(which: str, tmp_path: Path) -> None:
    file = once(ODD[which](), "svg", tmp_path)
    read(file)
    Drawn(file, 300)


def test_names_are_escaped_and_in_one_line(tmp_path: Path) -> None:
    root = read(once(odd_names(), "svg", tmp_path))
    titles = [title.text for title in root.iter(f"{SVG}title")]
    for name in ('The "big" one', "O'Brien & <Söhne>, 50 %", "冷蔵庫 🚜", "two lines and tabs", "half letter"):
        assert any(title.startswith(name) for title in titles)
    assert all("\n" not in (text.text or "") for text in root.iter(f"{SVG}text"))


def test_the_legend_counts_what_there_is(tmp_path: Path) -> None:
    root = read(once(demo(), "svg", tmp_path))
    words = [text.text for text in layer(root, "legend-text")]
    assert {"Corridor (7)", "Rack (7)", "warehouse.pgm"} <= set(words)
    named = {text.text for text in layer(root, "name")}
    assert {"A01", "A03", "C06", "S2-03"} <= named
