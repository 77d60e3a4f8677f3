"""groundplan watch: real processes that talk over DDS on the loopback interface, and over nothing else."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from _bags import grid, write_bag
from _program import Ran, call, files, hall, start, write_map

from groundplan import GroundplanError, MapError, Survey
from groundplan.maps.live import dds, domain_of

#: Loopback alone, without multicast: two processes find each other by their ports.
LOOPBACK = (
    "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name='lo'/></Interfaces><AllowMulticast>false"
    "</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex><Peers><Peer address='127.0.0.1'/>"
    "</Peers></Discovery></Domain></CycloneDDS>"
)

try:
    dds()
    MISSING = ""
except GroundplanError as fault:
    MISSING = f"needs cyclonedds, which has no wheel for this Python: {fault}"

over_dds = pytest.mark.skipif(bool(MISSING), reason=MISSING)


def occupancies() -> npt.NDArray[np.int8]:
    """The hall as a robot publishes it: lowest row first."""
    return np.select([hall() == 0, hall() == 254], [100, 0], -1).astype(np.int8)[::-1]


class Robot:
    """The other process."""

    def __init__(self, environment: dict[str, str], *flags: str) -> None:
        words = [sys.executable, str(Path(__file__).with_name("_robot.py")), environment["ROS_DOMAIN_ID"], *flags]
        pipes: dict[str, Any] = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
        self.process = subprocess.Popen(words, env={**os.environ, **environment}, **pipes)
        assert self.answer() == "ready"

    def answer(self) -> str:
        assert self.process.stdout is not None
        return str(self.process.stdout.readline()).strip()

    def tell(self, **said: Any) -> str:
        assert self.process.stdin is not None
        self.process.stdin.write(json.dumps(said) + "\n")
        self.process.stdin.flush()
        return self.answer()

    def publish(self, data: npt.NDArray[np.int8], yaw: float = 0.0) -> None:
        assert self.tell(map=data.tolist(), at=[-1.0, 2.0], yaw=yaw, resolution=0.05) == "sent"

    def leave(self) -> None:
        assert self.process.stdin is not None and self.process.stdout is not None
        self.process.stdin.close()
        self.process.wait(timeout=20)
        self.process.stdout.close()


def watch(network: dict[str, str], *words: str | Path) -> Ran:
    """Run the program to its end."""
    return start("watch", *words, CYCLONEDDS_URI=network["CYCLONEDDS_URI"], ROS_DOMAIN_ID=network["ROS_DOMAIN_ID"])


@pytest.fixture
def network() -> dict[str, str]:
    """A domain of its own on the loopback interface."""
    return {"CYCLONEDDS_URI": LOOPBACK, "ROS_DOMAIN_ID": str(random.SystemRandom().randrange(20, 200))}


@pytest.fixture
def robot(network: dict[str, str]) -> Iterator[Robot]:
    made = Robot(network)
    yield made
    made.leave()


class Watch:
    """The program, running."""

    def __init__(self, environment: dict[str, str], *words: str | Path) -> None:
        code = "import sys; from groundplan.cli import main; sys.exit(main())"
        self.process = subprocess.Popen(
            [sys.executable, "-c", code, "watch", *map(str, words)],
            env={**os.environ, **environment},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def line(self, start: str) -> str:
        """The next line on standard error that begins so."""
        assert self.process.stderr is not None
        for line in self.process.stderr:
            if line.startswith(start):
                return line.strip()
        raise AssertionError(f"it ended without {start!r}")

    def interrupt(self) -> int:
        self.process.send_signal(signal.SIGINT)
        self.process.communicate(timeout=30)
        return self.process.returncode


@over_dds
def test_a_bag_a_live_topic_and_a_picture_give_the_same_survey(
    tmp_path: Path, robot: Robot, network: dict[str, str], capsys: pytest.CaptureFixture[str]
) -> None:
    yaml = write_map(tmp_path, yaw="0.25")
    sent = [grid("/map", 1.0, occupancies(), turned=0.25)]
    bags = [write_bag(tmp_path / name, kind, sent) for name, kind in (("run.bag", "bag"), ("run", "sqlite3"))]
    name = ("--name", "Hall 7")
    for n, path in enumerate([yaml, *bags]):
        assert call(capsys, "survey", path, "-q", *name, "-o", tmp_path / f"out{n}").code == 0
    robot.publish(occupancies(), yaw=0.25)
    ran = watch(network, "--once", "--timeout", "60", *name, "-o", tmp_path / "out3")
    assert ran.code == 0 and ran.out == "" and "surveyed: /map: 280 x 200 pixels" in ran.err

    def but_for_its_source(directory: Path) -> str:
        lines = (directory / "survey.json").read_text().splitlines(keepends=True)
        return "".join(line for line in lines if not line.startswith('"source":'))

    texts = {but_for_its_source(tmp_path / f"out{n}") for n in range(4)}
    assert len(texts) == 1
    assert Survey.from_json(texts.pop()).map.image == "Hall 7"


@over_dds
def test_the_survey_follows_the_map(tmp_path: Path, robot: Robot, network: dict[str, str]) -> None:
    out = tmp_path / "out"
    empty = occupancies()
    empty[60:140, 70:210] = 0
    running = Watch(network, "-o", out)
    robot.publish(empty)
    assert "280 x 200" in running.line("surveyed:")
    assert running.line("wrote:").endswith("survey.json")
    racks = len(Survey.read(out / "survey.json").walls)
    robot.publish(occupancies())
    running.line("wrote:")
    whole = Survey.read(out / "survey.json")
    assert len(whole.walls) > racks
    # What an update brings is as if the whole map had been sent.
    robot.publish(empty)
    running.line("wrote:")
    assert robot.tell(update=occupancies()[60:140, 70:210].tolist(), x=70, y=60) == "sent"
    running.line("wrote:")
    assert Survey.read(out / "survey.json").to_json() == whole.to_json()
    # A map in which nobody can stand is told, and the survey stays.
    robot.publish(np.full_like(empty, 100))
    assert "no pixel of the map is free" in running.line("warning:")
    assert Survey.read(out / "survey.json").to_json() == whole.to_json()
    assert running.interrupt() == 130
    assert files(tmp_path) == {"out/survey.json"}


@over_dds
def test_a_map_that_its_publisher_does_not_keep_is_heard_too(tmp_path: Path, network: dict[str, str]) -> None:
    robot = Robot(network, "--volatile")
    running = Watch(network, "-o", tmp_path / "out", "--once", "--timeout", "60")
    try:
        for _ in range(100):  # until the reader has been made
            robot.publish(occupancies())
            if running.process.poll() is not None:
                break
            time.sleep(0.2)
        _, err = running.process.communicate(timeout=60)
        assert running.process.returncode == 0, err
        assert (tmp_path / "out" / "survey.json").is_file()
    finally:
        robot.leave()


@over_dds
def test_the_survey_is_published_for_whoever_comes_late(tmp_path: Path, robot: Robot, network: dict[str, str]) -> None:
    robot.publish(occupancies())
    running = Watch(network, "-o", tmp_path / "out", "--publish")
    running.line("wrote:")
    heard = json.loads(robot.tell(listen="/groundplan/survey"))
    assert heard == (tmp_path / "out" / "survey.json").read_text()
    assert running.interrupt() == 130


@over_dds
def test_where_no_map_comes_it_is_told_what_is_heard(tmp_path: Path, robot: Robot, network: dict[str, str]) -> None:
    ran = watch(network, "--topic", "/other/map", "--timeout", "5", "-o", tmp_path / "out")
    assert ran.code == 3 and not (tmp_path / "out").exists()
    assert f"no map came on /other/map of domain {network['ROS_DOMAIN_ID']} within 5 s" in ran.err
    assert "/map (nav_msgs/msg/OccupancyGrid)" in ran.err and "/chatter (std_msgs/msg/String)" in ran.err


@over_dds
def test_a_network_that_is_not_there_is_told(tmp_path: Path) -> None:
    ran = start("watch", "--once", "-o", tmp_path / "out", CYCLONEDDS_URI=LOOPBACK.replace("'lo'", "'lo77'"))
    assert ran.code == 3 and "the DDS network of domain" in ran.err and "hint: CYCLONEDDS_URI" in ran.err


def test_the_domain_is_that_of_ros(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
    assert domain_of(None) == 0
    monkeypatch.setenv("ROS_DOMAIN_ID", "42")
    assert (domain_of(None), domain_of(7)) == (42, 7)
    monkeypatch.setenv("ROS_DOMAIN_ID", "many")
    with pytest.raises(MapError, match="ROS_DOMAIN_ID 'many' is not a whole number from 0 to 232"):
        domain_of(None)


def test_without_the_library_the_command_that_installs_it_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in [name for name in sys.modules if name.split(".")[0] == "cyclonedds"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "cyclonedds", None)
    ran = call(capsys, "watch", "--once", "-o", tmp_path / "out")
    assert ran.code == 2 and "error: cyclonedds is not installed" in ran.err
    assert ("pip install 'groundplan[ros]'" if sys.version_info < (3, 13) else "Python 3.11 and 3.12") in ran.err
