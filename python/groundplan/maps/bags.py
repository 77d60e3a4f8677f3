"""Maps in bags of ROS 1 and ROS 2 (sqlite3 and MCAP), read by `rosbags` without a ROS installation.

The types are known beforehand, so that a bag's other topics may be whatever they are. One message is held at a time.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from groundplan._errors import GroundplanError, MapError, shown
from groundplan._extras import needed
from groundplan.maps._map import MapWarning
from groundplan.maps._open import METADATA, look
from groundplan.maps._source import Described, Progress
from groundplan.maps.map_server import number
from groundplan.maps.occupancy_grid import GRID, UPDATE, UPDATES, Grid

if TYPE_CHECKING:
    from rosbags.interfaces import Connection
    from rosbags.typesys.store import Typestore

#: Header stamps are compared to the microsecond: more a number of seconds does not hold.
SLACK_NS = 1000

UPDATE_FIELDS = "std_msgs/Header header\nint32 x\nint32 y\nuint32 width\nuint32 height\nint8[] data"


def read_bag(
    path: Path,
    *,
    topic: str | None = None,
    stamp: float | None = None,
    posed: bool = True,
    progress: Progress | None = None,
) -> Described:
    """The last OccupancyGrid of a topic, with the updates that came after it.

    Parameters
    ----------
    path : Path
        A ROS 1 bag, a rosbag2 directory, or one of its sqlite3 or MCAP files.
    topic : str, optional
        Needed where several topics hold maps and none is /map.
    stamp : float, optional
        Seconds: what the header's stamp of the map and of its updates is at most.
    posed : bool
        Whether the map's own origin is wanted.

    Raises
    ------
    MapError
        ``map.topic``, ``map.stamp``, ``map.corrupt`` and those of `occupancy_grid`.
    GroundplanError
        ``extra.missing``.
    """
    path = path.parent if path.name == METADATA else path
    limit = None if stamp is None else _nanoseconds(stamp)
    with _opened(path) as (bag, decode):
        chosen, others = _topic(path, bag.connections, topic)
        name = chosen[0].topic
        updates = [c for c in bag.connections if c.topic == name + UPDATES and c.msgtype == UPDATE]
        total = sum(c.msgcount for c in [*chosen, *updates]) or 1
        where = f"{path}, {name}"
        grid: Grid | None = None
        stamps: list[int] = []
        for n, (connection, _, raw) in enumerate(bag.messages(connections=[*chosen, *updates]), 1):
            if connection.msgtype == GRID or grid is not None:
                message = decode(raw, connection.msgtype)
                at = message.header.stamp.sec * 10**9 + message.header.stamp.nanosec
                if connection.msgtype == GRID:
                    stamps = [min([*stamps, at]), max([*stamps, at])]
                if limit is not None and at > limit + SLACK_NS:
                    continue
                if connection.msgtype == GRID:
                    grid = Grid(message, where)
                elif grid is not None:
                    grid.update(message)
            if progress is not None:
                progress(n / total)
    if grid is None and not stamps:
        raise MapError("map.topic", f"{path} has the topic {name}, but no map was ever sent on it")
    if grid is None:
        first, last = (f"{at / 1e9:.3f}" for at in stamps)
        raise MapError("map.stamp", f"{where}: no map is as old as stamp {stamp}: they are of {first} to {last}")
    found = grid.described(path.name, posed=posed)
    odd: tuple[MapWarning, ...] = ()
    if others:
        odd = (MapWarning("other-topics", f"{name} was read; {', '.join(others)} have maps too: --topic takes one"),)
    return Described(
        found.image, found.resolution, found.origin, warnings=(*odd, *found.warnings), content=found.content
    )


def _nanoseconds(stamp: float) -> int:
    seconds = number(stamp)
    if seconds is None or not abs(seconds) < 1e12:
        raise MapError("map.stamp", f"stamp {shown(stamp)} is not a number of seconds")
    return round(seconds * 1e9)


@contextlib.contextmanager
def _opened(path: Path) -> Iterator[tuple[Any, Callable[[bytes, str], Any]]]:
    """A reader of the bag, and what decodes its messages."""
    needed("rosbags", "ros")
    try:
        if path.is_file() and look(path)[1].startswith(b"#ROSBAG"):
            from rosbags.rosbag1 import Reader as Reader1

            with Reader1(path) as one:
                yield one, _types("ROS1_NOETIC").deserialize_ros1
        else:
            from rosbags.rosbag2 import Reader as Reader2

            with Reader2(_storage(path)) as two:
                yield two, _types("LATEST").deserialize_cdr
    except (GroundplanError, ImportError):
        raise
    except MemoryError as fault:
        said = f"{path} has messages that do not fit into memory: it is damaged, or its map is too large"
        raise MapError("map.too-large", said) from fault
    except Exception as fault:  # a damaged bag can trip the reader anywhere
        said = " ".join(str(fault).split()).rstrip(".") or type(fault).__name__
        hint = "what was recorded can often be saved: rosbag reindex (ROS 1), ros2 bag reindex, mcap recover"
        raise MapError("map.corrupt", f"{path} is a damaged or unfinished bag: {said}", hint) from fault


def _types(store: str) -> Typestore:
    """The types of a ROS, and the one of updates."""
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    types = get_typestore(Stores[store])
    types.register(get_types_from_msg(UPDATE_FIELDS, UPDATE))
    return types


def _storage(path: Path) -> Path:
    """The directory, or the only file in one that lost its metadata."""
    if not path.is_dir():
        if path.suffix not in (".mcap", ".db3"):
            raise MapError(
                "map.format", f"{path} is a bag by its content, but not by its name", "name it .mcap or .db3"
            )
        return path
    if (path / METADATA).is_file():
        return path
    parts = sorted([*path.glob("*.mcap"), *path.glob("*.db3")])
    if len(parts) == 1:
        return parts[0]
    said = f"{path} has {len(parts)} parts of a bag, and no {METADATA} that says their order"
    raise MapError("map.corrupt", said, "ros2 bag reindex writes one; or name one of the parts")


def _topic(path: Path, connections: list[Connection], asked: str | None) -> tuple[list[Connection], list[str]]:
    """The connections of the topic to read, and the other topics with maps."""
    types = {c.topic: c.msgtype for c in connections}
    maps = sorted(name for name, kind in types.items() if kind == GRID)
    if asked is not None:
        name = "/" + asked.lstrip("/")
        if types.get(name) != GRID:
            what = f"{name} is of {types[name]}" if name in types else f"there is no topic {name}"
            hint = f"--topic takes one of: {', '.join(maps)}" if maps else None
            raise MapError("map.topic", f"{path}: {what}", hint)
        return [c for c in connections if c.topic == name], []
    if not maps:
        listed = ", ".join(f"{name} ({kind})" for name, kind in sorted(types.items())) or "none at all"
        raise MapError("map.topic", f"{path} has no topic with maps ({GRID}); its topics: {listed}")
    if len(maps) > 1 and "/map" not in maps:
        raise MapError(
            "map.topic", f"{path} has several topics with maps: {', '.join(maps)}", "--topic takes one of them"
        )
    name = "/map" if "/map" in maps else maps[0]
    return [c for c in connections if c.topic == name], [other for other in maps if other != name]
