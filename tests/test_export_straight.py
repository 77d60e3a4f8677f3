"""The straightened map: read as any map is, surveyed again, and its transforms held against both surveys."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
import yaml
from _exports import demo, jones_farms, loads, once
from _program import call, files
from conftest import ROOT, SHARED
from PIL import Image
from scipy import ndimage
from zoo import Canvas

import groundplan
from groundplan.maps import FREE, OCCUPIED, UNKNOWN, Map

Floats = npt.NDArray[np.float64]
Case = tuple[groundplan.Survey, Map]


def example(origin: tuple[float, float, float] | None = None) -> Case:
    """The example warehouse, where it is or somewhere else."""
    map = groundplan.read(ROOT / "examples" / "warehouse.yaml", origin=origin)
    return (demo() if origin is None else groundplan.survey(map, threads=1)), map


CASES: dict[str, Callable[[], Case]] = {
    "demo": example,
    "far and turned": lambda: example((1200.5, -830.25, 0.7)),
    "jones farms": lambda: (jones_farms(), groundplan.read(SHARED / "maps" / "radish_intel_jones_farms.yaml")),
}


def transform(tree: dict[str, object], way: str, points: npt.ArrayLike) -> Floats:
    """Points by the file's matrix."""
    one = tree[way]
    assert isinstance(one, dict)
    matrix = np.array(one["matrix"])
    moved: Floats = np.asarray(points) @ matrix[:, :2].T + matrix[:, 2]
    return moved


def centres(map: Map, state: int) -> Floats:
    """Centres of all pixels of a state, (N, 2), metres in the map frame, by the rule of map_server's origin."""
    rows, columns = np.nonzero(map.states[map.pixels] == state)
    u, v = (columns + 0.5) * map.resolution, (map.height - rows - 0.5) * map.resolution
    x, y, yaw = map.origin
    return np.column_stack([x + u * math.cos(yaw) - v * math.sin(yaw), y + u * math.sin(yaw) + v * math.cos(yaw)])


def state_at(map: Map, points: Floats) -> npt.NDArray[np.uint8]:
    """The state of the pixel that each point lies in; the map has no yaw."""
    assert map.origin[2] == 0.0
    columns, rows = np.floor((points - map.origin[:2]) / map.resolution).astype(int).T
    inside = (columns >= 0) & (columns < map.width) & (rows >= 0) & (rows < map.height)
    states = np.full(len(points), UNKNOWN, np.uint8)
    states[inside] = map.states[map.pixels[map.height - 1 - rows[inside], columns[inside]]]
    return states


@pytest.mark.parametrize("which", CASES)
def test_the_straight_map_is_along_x_and_y_and_every_pixel_lies_where_the_transform_says(
    which: str, tmp_path: Path
) -> None:
    survey, map = CASES[which]()
    file = once(survey, "straight", tmp_path, map=map)
    tree, read = loads(tmp_path / "file.straight.json"), groundplan.read(file)
    assert read.warnings == () and read.origin[2] == 0.0 and read.resolution == pytest.approx(map.resolution, rel=1e-12)
    lattice = np.array(read.origin[:2]) / read.resolution
    assert np.abs(lattice - np.round(lattice)).max() < 1e-6
    again = groundplan.survey(read, threads=1)
    off = math.degrees(float(again.directions.angles[0]))
    assert abs(off - 90 * round(off / 90)) < 0.05
    # Nothing occupied is lost, and nothing grows by more than a pixel.
    there = transform(tree, "map_to_straight", centres(map, OCCUPIED))
    assert (state_at(read, there) == OCCUPIED).all()
    back = transform(tree, "straight_to_map", centres(read, OCCUPIED))
    gaps = ndimage.distance_transform_edt(map.states[map.pixels] != OCCUPIED)
    x, y, yaw = map.origin
    turn = np.array([[math.cos(yaw), -math.sin(yaw)], [math.sin(yaw), math.cos(yaw)]])
    columns, rows = np.floor((back - (x, y)) @ turn / map.resolution).astype(int).T
    inside = (columns >= 0) & (columns < map.width) & (rows >= 0) & (rows < map.height)
    assert gaps[map.height - 1 - rows[inside], columns[inside]].max() <= 1.5 and inside.mean() > 0.99
    # The unknown stays unknown, the free free, but where a wall's pixel fell.
    for state in (UNKNOWN, FREE):
        found = state_at(read, transform(tree, "map_to_straight", centres(map, state)))
        assert np.isin(found, (state, OCCUPIED)).mean() > 0.98


@pytest.mark.parametrize("which", CASES)
def test_walls_over_a_metre_come_back_where_the_transform_puts_them_to_a_pixel(which: str, tmp_path: Path) -> None:
    survey, map = CASES[which]()
    read = groundplan.read(once(survey, "straight", tmp_path, map=map))
    tree, again = loads(tmp_path / "file.straight.json"), groundplan.survey(read, threads=1)
    expected = transform(tree, "map_to_straight", survey.walls.points.reshape(-1, 2)).reshape(-1, 2, 2)
    found = again.walls.points.reshape(-1, 2, 2)
    upright = np.abs(found[:, 1] - found[:, 0]).argmax(axis=1) == 1
    length = kept = 0.0
    for wall in expected:
        middle, along = wall.mean(axis=0), np.abs(wall[1] - wall[0])
        axis = int(along[1] > along[0])  # the one that it runs along
        same = found[upright == bool(axis)]
        low, high = np.sort(same[:, :, axis], axis=1).T
        beside = same[(low <= middle[axis]) & (middle[axis] <= high)].mean(axis=1)[:, 1 - axis]
        if along.max() >= 1.0:
            length += along.max()
            near = np.abs(beside - middle[1 - axis]).min(initial=np.inf) <= read.resolution
            kept += along.max() if near else 0.0
    assert kept > 0.95 * length > 100.0


def test_there_and_back_is_the_same_place(tmp_path: Path) -> None:
    survey, map = example((1200.5, -830.25, 0.7))
    once(survey, "straight", tmp_path, map=map)
    tree = loads(tmp_path / "file.straight.json")
    points = np.array([[0.0, 0.0], [1200.5, -830.25], [-3.0, 7.0]])
    there = transform(tree, "map_to_straight", points)
    assert np.abs(transform(tree, "straight_to_map", there) - points).max() < 1e-9
    assert tree["about"] == [0.0, 0.0] and np.allclose(there[0], 0.0)
    for way in ("map_to_straight", "straight_to_map"):
        yaw = tree[way]["yaw"]
        assert np.allclose(tree[way]["matrix"], [[math.cos(yaw), -math.sin(yaw), 0], [math.sin(yaw), math.cos(yaw), 0]])
    # A heading along the strongest direction is 0 afterwards.
    assert survey.directions.angles[0] + tree["map_to_straight"]["yaw"] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("degrees", [7.0, 30.0, 45.0, 60.0])
def test_a_wall_one_pixel_thick_stays_whole_and_thin(degrees: float, tmp_path: Path) -> None:
    canvas = Canvas(300, 300, 254)
    cos, sin = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    for across in (0, 40, 80):
        canvas.bar((150 - across * sin - 100 * cos, 150 + across * cos - 100 * sin), degrees, 200, 1.0)
    map = groundplan.from_array(canvas.picture, 0.05)
    read = groundplan.read(once(groundplan.survey(map, threads=1), "straight", tmp_path, map=map))
    taken = read.states[read.pixels] == OCCUPIED
    before = ndimage.label(map.states[map.pixels] == OCCUPIED, np.ones((3, 3)))[1]
    assert before == 3 == ndimage.label(taken, np.ones((3, 3)))[1]
    assert ndimage.binary_erosion(taken, np.ones((3, 3))).sum() == 0


def test_a_map_that_is_straight_already_keeps_its_pixels(tmp_path: Path) -> None:
    map = groundplan.from_array(
        Canvas(200, 150).room(10, 10, 190, 140).box(100, 60, 101, 61).picture, 0.05, (-1.0, 2.5)
    )
    survey = groundplan.survey(map, threads=1)
    assert abs(float(survey.directions.angles[0])) < 1e-6
    read = groundplan.read(once(survey, "straight", tmp_path, map=map))
    assert read.origin[:2] == pytest.approx((-0.5, 3.0)) and (read.height, read.width) == (130, 180)
    assert np.array_equal(read.pixels, map.pixels[10:140, 10:190])


def test_the_yaml_is_map_server_s_with_the_numbers_in_full(tmp_path: Path) -> None:
    map = groundplan.read(ROOT / "examples" / "warehouse.yaml", resolution=1 / 30)
    survey = groundplan.survey(map, threads=1)
    file = once(survey, "straight", tmp_path, map=map)
    said = yaml.safe_load(file.read_text())
    assert said["resolution"] == pytest.approx(1 / 30, rel=1e-11) and said["mode"] == "trinary"
    assert isinstance(said["origin"][0], float) and said["origin"][2] == 0.0
    with Image.open(file.parent / said["image"]) as picture:
        assert picture.mode == "L" and set(np.unique(np.asarray(picture)).tolist()) <= {0, 205, 254}


def test_the_same_map_gives_the_same_bytes_and_none_is_left_of_one_without_direction(tmp_path: Path) -> None:
    survey, map = example()
    first, second = (survey.export(tmp_path / name / "x", "straight", map=map) for name in "ab")
    assert [file.read_bytes() for file in first] == [file.read_bytes() for file in second]
    empty = groundplan.from_array(np.full((20, 20), 254, np.uint8), 0.05)
    with pytest.raises(groundplan.FormatError, match="no direction") as told:
        groundplan.survey(empty, threads=1).export(tmp_path / "c", "straight", map=empty)
    assert told.value.code == "export.straight" and not any(name.startswith("c") for name in files(tmp_path))


def test_the_program_finds_the_map_by_itself(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    made = call(capsys, "survey", ROOT / "examples" / "warehouse.yaml", "-o", tmp_path, "-q")
    ran = call(capsys, "export", tmp_path, "--to", "straight")
    names = ["warehouse.straight.yaml", "warehouse.straight.pgm", "warehouse.straight.json"]
    assert (made.code, ran.code) == (0, 0)
    assert ran.out.split() == [str(tmp_path / "export" / name) for name in names]
