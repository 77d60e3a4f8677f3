"""A robot on the network, in a process of its own: it publishes what it is told, with messages declared by itself.

Lines on standard input, JSON: {"map": [rows of occupancies, the lowest first], "at", "yaw", "resolution"},
{"update": [rows], "x", "y"}, {"text": "..."}, {"listen": "/topic"}. Each is answered by a line on standard output.
"""

# mypy: disable-error-code="type-arg,arg-type,call-arg,misc"

import json
import math
import sys
import time
from dataclasses import dataclass

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import float32, float64, int8, int32, sequence, uint32
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration


@dataclass
class Time(IdlStruct, typename="builtin_interfaces::msg::dds_::Time_"):
    sec: int32
    nanosec: uint32


@dataclass
class Header(IdlStruct, typename="std_msgs::msg::dds_::Header_"):
    stamp: Time
    frame_id: str


@dataclass
class Point(IdlStruct, typename="geometry_msgs::msg::dds_::Point_"):
    x: float64
    y: float64
    z: float64


@dataclass
class Quaternion(IdlStruct, typename="geometry_msgs::msg::dds_::Quaternion_"):
    x: float64
    y: float64
    z: float64
    w: float64


@dataclass
class Pose(IdlStruct, typename="geometry_msgs::msg::dds_::Pose_"):
    position: Point
    orientation: Quaternion


@dataclass
class MapMetaData(IdlStruct, typename="nav_msgs::msg::dds_::MapMetaData_"):
    map_load_time: Time
    resolution: float32
    width: uint32
    height: uint32
    origin: Pose


@dataclass
class OccupancyGrid(IdlStruct, typename="nav_msgs::msg::dds_::OccupancyGrid_"):
    header: Header
    info: MapMetaData
    data: sequence[int8]


@dataclass
class OccupancyGridUpdate(IdlStruct, typename="map_msgs::msg::dds_::OccupancyGridUpdate_"):
    header: Header
    x: int32
    y: int32
    width: uint32
    height: uint32
    data: sequence[int8]


@dataclass
class String(IdlStruct, typename="std_msgs::msg::dds_::String_"):
    data: str


def main() -> None:
    kept = Policy.Durability.Volatile if "--volatile" in sys.argv else Policy.Durability.TransientLocal
    qos = Qos(
        Policy.Reliability.Reliable(duration(seconds=10)),
        kept,
        Policy.History.KeepLast(1),
        Policy.DataRepresentation(use_cdrv0_representation=True),
    )
    robot = DomainParticipant(int(sys.argv[1]))

    def writer(name: str, kind: type) -> DataWriter:
        return DataWriter(robot, Topic(robot, name, kind), qos)

    maps, updates = writer("rt/map", OccupancyGrid), writer("rt/map_updates", OccupancyGridUpdate)
    texts = writer("rt/chatter", String)
    print("ready", flush=True)
    for line in sys.stdin:
        said = json.loads(line)
        header = Header(Time(int(time.time()), 0), "map")
        if "text" in said:
            texts.write(String(said["text"]))
        elif "listen" in said:
            reader = DataReader(robot, Topic(robot, "rt" + said["listen"], String), qos)
            heard = next((sample.data for sample in reader.take_iter(timeout=duration(seconds=20))), None)
            print(json.dumps(heard), flush=True)
            continue
        else:
            rows = said.get("map") or said["update"]
            data, size = [value for row in rows for value in row], (len(rows[0]), len(rows))
            if "map" in said:
                turn = Quaternion(0.0, 0.0, math.sin(said["yaw"] / 2), math.cos(said["yaw"] / 2))
                pose = Pose(Point(*said["at"], 0.0), turn)
                maps.write(OccupancyGrid(header, MapMetaData(header.stamp, said["resolution"], *size, pose), data))
            else:
                updates.write(OccupancyGridUpdate(header, said["x"], said["y"], *size, data))
        print("sent", flush=True)


main()
