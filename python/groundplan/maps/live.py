"""Maps from a live topic of ROS 2, over DDS by Cyclone DDS, without a ROS installation.

The network is that of `CYCLONEDDS_URI`, the domain that of `ROS_DOMAIN_ID`, as ROS itself has them.
"""

from __future__ import annotations

import os
import sys
import time
from types import SimpleNamespace
from typing import Any, Self

from groundplan._errors import GroundplanError, MapError, shown
from groundplan._extras import needed
from groundplan.maps._interpret import meaning_of, weigh
from groundplan.maps._map import Map
from groundplan.maps._source import Occupancies
from groundplan.maps.occupancy_grid import UPDATES, Grid

#: How long is waited at a time, in seconds: between two waits Ctrl-C is heard.
SLICE_S = 0.2

#: Updates that are kept until they are put in, and how long a reader of the survey is waited for, in seconds.
UPDATES_KEPT, LINGER_S = 1000, 5.0

LARGEST_DOMAIN = 232


class Topic:
    """A topic with maps, and the map as it stands on it.

    Parameters
    ----------
    name : str
        Such as /map; updates are taken from the topic beside it, /map_updates.
    domain : int, optional
        By default `ROS_DOMAIN_ID`, or 0.
    occupied_thresh, free_thresh : float, optional
        As in `groundplan.read`.

    Raises
    ------
    GroundplanError
        ``extra.missing``; ``live.dds`` where the network cannot be opened.
    MapError
        ``map.domain``.
    """

    def __init__(
        self,
        name: str = "/map",
        domain: int | None = None,
        *,
        occupied_thresh: float | None = None,
        free_thresh: float | None = None,
    ) -> None:
        self.name = "/" + name.strip("/")
        self.domain = domain_of(domain)
        self._thresholds = occupied_thresh, free_thresh
        self._dds = dds()
        try:
            self._participant = self._dds.domain.DomainParticipant(self.domain)
            self._builtin = self._dds.builtin.BuiltinDataReader(
                self._participant, self._dds.builtin.BuiltinTopicDcpsPublication
            )
            self._waits, self._conditions = self._dds.core.WaitSet(self._participant), list[Any]()
            idl = self._dds.ros
            self._grids = [self._reader(self.name, idl.OccupancyGrid, 1, kept=True)]
            self._updates = [self._reader(self.name + UPDATES, idl.OccupancyGridUpdate, UPDATES_KEPT, kept=False)]
        except Exception as fault:  # a wrong CYCLONEDDS_URI, no network
            said = f"the DDS network of domain {self.domain} cannot be opened: {' '.join(str(fault).split())}"
            raise GroundplanError("live.dds", said, "CYCLONEDDS_URI says which network is used") from fault
        self._others: dict[str, str] = {}
        self._grid: Grid | None = None
        self._writers: dict[str, Any] = {}

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """Leave the network, once what was published has arrived."""
        for writer in self._writers.values():
            writer.wait_for_acks(self._dds.util.duration(seconds=LINGER_S))
        self._writers.clear()
        self._grids, self._updates, self._conditions = [], [], []
        del self._waits, self._builtin, self._participant

    def next(self, timeout: float | None = None) -> Map | None:
        """The map after what came since the last call; waits until something comes. None when it did not in time.

        Raises
        ------
        MapError
            What came is no map that can be read; the next call waits for another.
        """
        since = time.monotonic()
        while timeout is None or time.monotonic() - since < timeout:
            if self._take():
                return self._map()
            left = SLICE_S if timeout is None else since + timeout - time.monotonic()
            self._waits.wait(self._dds.util.duration(seconds=min(SLICE_S, max(left, 0.001))))
        return None

    def heard(self) -> list[str]:
        """The topics that are published on this network, and their types, as ROS names them."""
        self._look()
        return [f"{name} ({kind})" for name, kind in sorted(self._others.items())]

    def publish(self, topic: str, text: str) -> None:
        """Publish text as std_msgs/String, kept for whoever subscribes later as long as this process lives."""
        if topic not in self._writers:
            idl, policy = self._dds.ros, self._dds.qos.Policy
            qos = self._qos(1, kept=True) + self._dds.qos.Qos(
                policy.DataRepresentation(use_cdrv0_representation=True)  # what ROS reads
            )
            place = self._dds.topic.Topic(self._participant, "rt/" + topic.strip("/"), idl.String)
            self._writers[topic] = self._dds.pub.DataWriter(self._participant, place, qos)
        self._writers[topic].write(self._dds.ros.String(text))

    def _qos(self, depth: int, *, kept: bool) -> Any:
        """Reliable; `kept`: what was sent before is wanted too."""
        policy = self._dds.qos.Policy
        return self._dds.qos.Qos(
            policy.Reliability.Reliable(self._dds.util.duration(seconds=LINGER_S)),
            policy.Durability.TransientLocal if kept else policy.Durability.Volatile,
            policy.History.KeepLast(depth),
        )

    def _reader(self, name: str, kind: Any, depth: int, *, kept: bool) -> Any:
        topic = self._dds.topic.Topic(self._participant, "rt" + name, kind)
        reader = self._dds.sub.DataReader(self._participant, topic, self._qos(depth, kept=kept))
        state = self._dds.core
        new = state.ViewState.Any | state.SampleState.NotRead | state.InstanceState.Any
        self._conditions.append(state.ReadCondition(reader, new))
        self._waits.attach(self._conditions[-1])
        return reader

    def _look(self) -> None:
        """Learn who publishes what. A map that its publisher does not keep needs a reader that does not ask for it."""
        volatile = self._dds.qos.Policy.Durability.Volatile
        for found in self._builtin.take(100):
            if not getattr(found, "topic_name", "").startswith("rt/"):
                continue
            name = found.topic_name.removeprefix("rt")
            self._others[name] = found.type_name.replace("::dds_::", "::").replace("::", "/").removesuffix("_")
            if name == self.name and found.qos[self._dds.qos.Policy.Durability] == volatile and len(self._grids) == 1:
                self._grids.append(self._reader(name, self._dds.ros.OccupancyGrid, 1, kept=False))

    def _take(self) -> bool:
        """Put in what came, in the order in which it was sent."""
        self._look()
        came = [sample for reader in (*self._grids, *self._updates) for sample in reader.take(UPDATES_KEPT)]
        came = [sample for sample in came if hasattr(sample, "header")]  # others say that a publisher left
        came.sort(key=lambda sample: sample.sample_info.source_timestamp)
        changed = False
        for sample in came:
            if hasattr(sample, "info"):
                self._grid = Grid(sample, self.name)
                changed = True
            elif self._grid is not None:
                self._grid.update(sample)
                changed = True
        return changed

    def _map(self) -> Map:
        assert self._grid is not None
        described = self._grid.described(self.name.lstrip("/"))
        assert isinstance(described.content, Occupancies) and described.resolution and described.origin
        high, low = self._thresholds
        meaning, stated = meaning_of(described, "nav2", None, None, high, low, self.name)
        pixels, values, states, odd = weigh(described.content, meaning, stated)
        warnings = (*described.warnings, *odd)
        return Map(
            pixels.copy(), values, states, described.resolution, described.origin, described.image.as_posix(), warnings
        )


def domain_of(given: int | None) -> int:
    """The DDS domain: what is given, else `ROS_DOMAIN_ID`, else 0.

    Raises
    ------
    MapError
        ``map.domain``.
    """
    said = os.environ.get("ROS_DOMAIN_ID", "") if given is None else str(given)
    if not said.strip():
        return 0
    domain = int(said) if said.strip().isdecimal() else -1
    if not 0 <= domain <= LARGEST_DOMAIN:
        whose = "ROS_DOMAIN_ID" if given is None else "domain"
        raise MapError("map.domain", f"{whose} {shown(said)} is not a whole number from 0 to {LARGEST_DOMAIN}")
    return domain


def dds() -> SimpleNamespace:
    """The modules of Cyclone DDS by their names, and the messages as `ros`.

    Raises
    ------
    GroundplanError
        ``extra.missing``.
    """
    try:
        parts = ("builtin", "core", "domain", "pub", "qos", "sub", "topic", "util")
        found = {part: needed(f"cyclonedds.{part}", "ros") for part in parts}
    except GroundplanError as fault:
        if sys.version_info >= (3, 13):
            hint = "it has wheels for Python 3.11 and 3.12; for a later one: pip install cyclonedds, which builds it"
            raise GroundplanError(fault.code, str(fault), hint) from fault
        raise
    from groundplan.maps import _idl

    return SimpleNamespace(**found, ros=_idl)
