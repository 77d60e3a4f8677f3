"""Maps in bags, as sentences about bags that rosbags wrote."""

from __future__ import annotations

import math
import sqlite3
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from _bags import KINDS, Sent, grid, text, update, write_bag
from _program import call, files, hall, write_map
from _reading import refused, states

from groundplan import read
from groundplan.maps import FREE, OCCUPIED, UNKNOWN

Capture = pytest.CaptureFixture[str]


def occupancies() -> npt.NDArray[np.int8]:
    """The hall as a robot publishes it: lowest row first."""
    return np.select([hall() == 0, hall() == 254], [100, 0], -1).astype(np.int8)[::-1]


def made(tmp_path: Path, *sent: Sent, kind: str = "mcap") -> Path:
    return write_bag(tmp_path / ("run.bag" if kind == "bag" else "run"), kind, sent)


EXPECTED = np.select([hall() == 0, hall() == 254], [OCCUPIED, FREE], UNKNOWN)


@pytest.mark.parametrize("kind", KINDS)
def test_the_map_is_found_among_other_topics(kind: str, tmp_path: Path) -> None:
    bag = made(tmp_path, text("/chatter", 1.0, "hello"), grid("/robot/map", 2.0, occupancies(), turned=0.3), kind=kind)
    got = read(bag)
    assert np.array_equal(states(got), EXPECTED)
    # A message has the resolution in 32 bits and the yaw as a quaternion; both come back as they were meant.
    assert (got.resolution, got.origin) == (0.05, (-1.0, 2.0, 0.3))
    assert got.image == bag.name and got.warnings == ()


@pytest.mark.parametrize(("kind", "suffix"), [("sqlite3", ".db3"), ("mcap", ".mcap")])
def test_a_file_of_a_bag_is_a_bag(kind: str, suffix: str, tmp_path: Path) -> None:
    bag = made(tmp_path, grid("/map", 2.0, occupancies()), kind=kind)
    (part,) = bag.glob(f"*{suffix}")
    assert np.array_equal(states(read(part)), EXPECTED)
    assert np.array_equal(states(read(bag / "metadata.yaml")), EXPECTED)
    (bag / "metadata.yaml").unlink()
    assert np.array_equal(states(read(bag)), EXPECTED)


@pytest.mark.parametrize("kind", KINDS)
def test_the_last_map_counts_or_the_one_of_a_stamp(kind: str, tmp_path: Path) -> None:
    empty, full = np.zeros_like(occupancies()), np.full_like(occupancies(), 100)
    sent = [grid("/map", 1.5, empty), grid("/map", 2.5, full), grid("/map", 3.5, occupancies())]
    bag = made(tmp_path, *sent, kind=kind)
    assert np.array_equal(states(read(bag)), EXPECTED)
    assert (states(read(bag, stamp=2.5)) == OCCUPIED).all()
    assert (states(read(bag, stamp=2.4)) == FREE).all()
    refused(bag, "map.stamp", "1.500 to 3.500", "stamp 1", stamp=1)


@pytest.mark.parametrize("kind", KINDS)
def test_updates_are_put_in_in_order(kind: str, tmp_path: Path) -> None:
    patch = np.array([[100, 100, 100], [0, 0, -1]], np.int8)
    sent = [
        update("/map_updates", 1.0, 0, 0, np.full((3, 3), 100, np.int8)),  # of a map before the first
        grid("/map", 2.0, np.zeros((20, 30), np.int8)),
        update("/map_updates", 3.0, 4, 5, patch),
        update("/map_updates", 4.0, 5, 5, np.array([[0]], np.int8)),
        update("/map_updates", 5.0, 29, 5, patch),  # does not fit
    ]
    bag = made(tmp_path, *sent, kind=kind)
    expected = np.zeros((20, 30), np.uint8)
    expected[5, 4:7], expected[6, 6] = OCCUPIED, UNKNOWN
    assert np.array_equal(states(read(bag, stamp=3.0))[::-1], expected)
    expected[5, 5] = FREE
    got = read(bag)
    assert np.array_equal(states(got)[::-1], expected)
    assert [warning.code for warning in got.warnings] == ["update-left-out"]
    assert (states(read(bag, stamp=2.0)) == FREE).all()


def test_of_several_topics_map_is_taken_and_the_others_are_told(tmp_path: Path) -> None:
    costmap = np.tile(np.array([0, 100], np.int8), (20, 15))
    bag = made(tmp_path, grid("/costmap", 2.0, costmap), grid("/map", 1.0, occupancies()))
    got = read(bag)
    assert np.array_equal(states(got), EXPECTED)
    assert [warning.code for warning in got.warnings] == ["other-topics"] and "/costmap" in got.warnings[0].message
    chosen = read(bag, topic="costmap")
    assert (chosen.height, chosen.width) == (20, 30) and chosen.warnings == ()


def test_which_topic_is_asked_where_none_is_map(tmp_path: Path) -> None:
    small = np.zeros((2, 2), np.int8)
    bag = made(tmp_path, grid("/a/map", 1.0, small), grid("/b/map", 1.0, small), text("/chatter", 1.0, "hello"))
    refused(bag, "map.topic", "/a/map, /b/map", "--topic")
    refused(bag, "map.topic", "no topic /c", "/a/map, /b/map", topic="/c")
    refused(bag, "map.topic", "/chatter is of std_msgs/msg/String", topic="/chatter")


def test_a_bag_without_a_map_tells_its_topics(tmp_path: Path) -> None:
    bag = made(tmp_path, text("/chatter", 1.0, "hello"))
    refused(bag, "map.topic", "/chatter (std_msgs/msg/String)")


def test_an_orientation_is_a_yaw_or_refused(tmp_path: Path) -> None:
    def turned(name: str, *quaternion: float) -> Path:
        return write_bag(tmp_path / name, "mcap", [grid("/map", 1.0, occupancies(), turned=quaternion)])

    half = math.sqrt(0.5)
    assert read(turned("quarter", 0.0, 0.0, half, half)).origin[2] == round(math.pi / 2, 12)
    assert read(turned("negative", 0.0, 0.0, half, -half)).origin[2] == -round(math.pi / 2, 12)
    assert read(turned("long", 0.0, 0.0, 3.0, 3.0)).origin[2] == round(math.pi / 2, 12)
    unset = read(turned("unset", 0.0, 0.0, 0.0, 0.0))
    assert unset.origin[2] == 0.0 and [warning.code for warning in unset.warnings] == ["orientation-unset"]
    nearly = read(turned("nearly", 0.001, 0.0, half, half))
    assert [warning.code for warning in nearly.warnings] == ["tilted"]
    tilted = turned("tilted", half, 0.0, 0.0, half)
    refused(tilted, "map.origin", "90.00 degrees", "--origin")
    assert read(tilted, origin=(1.0, 2.0, 0.5)).origin == (1.0, 2.0, 0.5)
    refused(turned("nan", math.nan, 0.0, 0.0, 1.0), "map.origin", "nan")


@pytest.mark.parametrize("kind", KINDS)
def test_a_bag_that_ends_early_is_refused(kind: str, tmp_path: Path) -> None:
    bag = made(tmp_path, grid("/map", 1.0, occupancies()), text("/chatter", 1.0, "x" * 9000), kind=kind)
    part = bag if kind == "bag" else next(path for path in bag.iterdir() if path.suffix != ".yaml")
    whole = part.read_bytes()
    for share in (0.9, 0.5, 0.1):
        part.write_bytes(whole[: int(share * len(whole))])
        assert refused(bag, "map.corrupt", str(bag)).hint
        assert part.stat().st_size == int(share * len(whole))


def test_a_map_that_says_another_size_is_refused(tmp_path: Path) -> None:
    from _bags import message
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    with Writer(tmp_path / "run", version=9, storage_plugin=StoragePlugin.SQLITE3) as bag:
        connection = bag.add_connection("/map", "nav_msgs/msg/OccupancyGrid", typestore=store)
        said = message(store, *grid("/map", 1.0, occupancies())[1:], ros1=False)
        said.info.width += 1
        bag.write(connection, 1, store.serialize_cdr(said, connection.msgtype))
    refused(tmp_path / "run", "map.truncated", "281 x 200", "56000")


def test_a_database_that_is_no_bag_is_refused(tmp_path: Path) -> None:
    with sqlite3.connect(tmp_path / "other.db3") as database:
        database.execute("CREATE TABLE numbers (n INTEGER)")
    database.close()
    refused(tmp_path / "other.db3", "map.corrupt", "other.db3")


def test_what_says_nothing_about_a_bag_is_refused(tmp_path: Path) -> None:
    bag = made(tmp_path, grid("/map", 1.0, occupancies()))
    refused(bag, "map.option", "negate", negate=True)
    refused(bag, "map.option", "band", band=(0.0, 1.0))
    refused(
        write_map(tmp_path),
        "map.option",
        "topic says nothing about",
        "hall.yaml: it is a map_server YAML",
        topic="/map",
    )


@pytest.mark.parametrize("kind", KINDS)
def test_a_bag_and_its_picture_give_the_same_survey(kind: str, tmp_path: Path, capsys: Capture) -> None:
    picture = write_map(tmp_path, yaw="0.25")
    bag = made(tmp_path, grid("/map", 1.0, occupancies(), turned=0.25), kind=kind)
    before = files(tmp_path)
    texts = []
    for path in (picture, bag):
        ran = call(capsys, "survey", path, "--json")
        assert (ran.code, ran.err) == (0, "")
        lines = ran.out.splitlines()
        assert [line[:8] for line in lines[3:5]] == ['"source"', '"map": {']
        # Both say what file they are of; all else is the same to the byte.
        texts.append([*lines[:3], lines[4].partition(',"width"')[2], *lines[5:]])
    assert texts[0] == texts[1]
    assert files(tmp_path) == before


def test_the_bags_that_others_recorded(shared: Path) -> None:
    picture = read(shared / "maps" / "aws_small_warehouse.yaml")
    bags = shared / "maps" / "bags"
    for path in (bags / "aws_small_warehouse.bag", bags / "aws_small_warehouse_ros2"):
        got = read(path)
        assert np.array_equal(states(got), picture.states[picture.pixels])
        assert (got.resolution, got.origin) == (picture.resolution, picture.origin)
