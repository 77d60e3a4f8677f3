"""Bags for tests, written by rosbags: a map as ROS 1 and as ROS 2 record it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

KINDS = ("bag", "sqlite3", "mcap")

UPDATE = "std_msgs/Header header\nint32 x\nint32 y\nuint32 width\nuint32 height\nint8[] data"

Sent = tuple[str, str, float, dict[str, Any]]


def grid(
    topic: str,
    stamp: float,
    data: npt.NDArray[np.int8],
    *,
    resolution: float = 0.05,
    at: tuple[float, float] = (-1.0, 2.0),
    turned: Sequence[float] | float = 0.0,
) -> Sent:
    """An OccupancyGrid, lowest row first; `turned`: a yaw, or a quaternion x, y, z, w."""
    if isinstance(turned, float):
        turned = (0.0, 0.0, math.sin(turned / 2), math.cos(turned / 2))
    fields = {"data": data, "resolution": resolution, "at": at, "turned": turned}
    return topic, "nav_msgs/msg/OccupancyGrid", stamp, fields


def update(topic: str, stamp: float, x: int, y: int, data: npt.NDArray[np.int8]) -> Sent:
    """A part of a map."""
    return topic, "map_msgs/msg/OccupancyGridUpdate", stamp, {"x": x, "y": y, "data": data}


def text(topic: str, stamp: float, data: str) -> Sent:
    """Something that is no map."""
    return topic, "std_msgs/msg/String", stamp, {"data": data}


def write_bag(path: Path, kind: str, sent: Sequence[Sent]) -> Path:
    """Write what was sent, in this order; the path of the bag."""
    from rosbags.rosbag1 import Writer as Writer1
    from rosbags.rosbag2 import StoragePlugin
    from rosbags.rosbag2 import Writer as Writer2
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC if kind == "bag" else Stores.ROS2_HUMBLE)
    store.register(get_types_from_msg(UPDATE, "map_msgs/msg/OccupancyGridUpdate"))
    encode: Callable[..., Any] = store.serialize_ros1 if kind == "bag" else store.serialize_cdr
    plugin = StoragePlugin.SQLITE3 if kind == "sqlite3" else StoragePlugin.MCAP
    writer: Any = Writer1(path) if kind == "bag" else Writer2(path, version=9, storage_plugin=plugin)
    with writer as bag:
        open_: dict[str, Any] = {}
        for n, (topic, name, stamp, fields) in enumerate(sent):
            if topic not in open_:
                open_[topic] = bag.add_connection(topic, name, typestore=store)
            raw = encode(message(store, name, stamp, fields, ros1=kind == "bag"), name)
            # Recorded a while after the stamp, and by another clock.
            bag.write(open_[topic], 1_000_000_000 * (1000 + n), raw)
    return path


def message(store: Any, name: str, stamp: float, fields: dict[str, Any], *, ros1: bool) -> Any:
    """A message of the store's types."""
    types = store.types
    if name == "std_msgs/msg/String":
        return types[name](data=fields["data"])
    time = types["builtin_interfaces/msg/Time"](sec=int(stamp), nanosec=round(stamp % 1 * 1e9))
    head: dict[str, Any] = {"seq": 0} if ros1 else {}
    header = types["std_msgs/msg/Header"](**head, stamp=time, frame_id="map")
    data = fields["data"]
    size = {"width": data.shape[1], "height": data.shape[0]}
    if name == "map_msgs/msg/OccupancyGridUpdate":
        return types[name](header=header, x=fields["x"], y=fields["y"], **size, data=data.reshape(-1))
    point = types["geometry_msgs/msg/Point"](*fields["at"], 0.0)
    turn = types["geometry_msgs/msg/Quaternion"](*fields["turned"])
    pose = types["geometry_msgs/msg/Pose"](position=point, orientation=turn)
    info = types["nav_msgs/msg/MapMetaData"](map_load_time=time, resolution=fields["resolution"], **size, origin=pose)
    return types[name](header=header, info=info, data=data.reshape(-1))
