"""What a road map is made of. Metres and radians in the map frame throughout."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import networkx

Point = tuple[float, float]


@dataclass(frozen=True)
class Node:
    """A point at which a vehicle may turn, stop or choose.

    Attributes
    ----------
    id : str
        Unique among nodes and lanes, ASCII: ``J03`` a junction or dead end, ``A02.P05`` the fifth stop on aisle A02,
        ``D01`` a door, ``A01.D01`` the point of a lane abreast of it, ``R04`` a room; a lane through open space and
        its turn have an ``H``.
    kind : str
        ``junction``, ``end``, ``pick`` (abreast of pick faces, or at one where there are spurs), ``foot`` (where
        another way leaves a lane), ``turn``, ``door``, ``room``.
    at : (float, float)
    name : str
        As people call it.
    type : str
        A junction's type, ``L``, ``T``, ``X``, ``Y``; else empty.
    label : int or None
        The label id that it stands for.
    """

    id: str
    kind: str
    at: Point
    name: str
    type: str = ""
    label: int | None = None


@dataclass(frozen=True)
class Lane:
    """A straight way between two nodes.

    Attributes
    ----------
    id : str
        Unique among nodes and lanes, ASCII: ``A02.3`` is the third lane of aisle A02.
    start, end : int
        Positions in the road map's nodes. Lanes of a corridor run right or up, as its lanes are numbered.
    kind : str
        ``aisle``, ``spur``, ``door``, ``open`` (through a hall, where no corridor leads).
    name : str
        Of the corridor, rack or door that it belongs to.
    label : int or None
        The label id of that.
    left, right : float
        Free width on either side of it, seen from start to end.
    speed : float or None
        Greatest speed, m/s; None where no rule says.
    way : str
        ``both``, ``forward`` (start to end) or ``backward``.
    """

    id: str
    start: int
    end: int
    kind: str
    name: str
    label: int | None
    left: float
    right: float
    speed: float | None = None
    way: str = "both"


@dataclass(frozen=True)
class PickFace:
    """The open side of a rack's bay: where goods are taken.

    Attributes
    ----------
    id : str
        ``S02.L04``: the fourth bay on the left side of rack S02, seen along its numbers.
    at : (float, float)
        The middle of the face.
    heading : float
        From the lane to the face, radians.
    node : int
        Where a vehicle stands for it.
    rack : int
        The rack's label id.
    width : float
        Of the bay.
    """

    id: str
    at: Point
    heading: float
    node: int
    rack: int
    width: float


@dataclass(frozen=True)
class Zone:
    """An area with a rule. `kind`: ``keep-out``, or ``speed`` with a greatest `speed` in m/s.

    `ring` is counter-clockwise, its first point not repeated.
    """

    id: str
    kind: str
    name: str
    ring: list[Point]
    label: int | None = None
    speed: float | None = None


@dataclass(frozen=True)
class Directed:
    """A lane in one of its ways, as formats with one-way edges want it.

    `id` is the lane's, with ``r`` behind it against the lane's own way; `left` and `right` are as this way sees them.
    """

    id: str
    lane: Lane
    start: int
    end: int
    left: float
    right: float


@dataclass(frozen=True)
class Blocked:
    """A piece of lane that is left out, and the occupied pixel `at` which something stands in its way."""

    id: str
    at: Point


@dataclass(frozen=True)
class Narrow:
    """A corridor that has no lane because its `width` is less than the `least` asked for, both in metres."""

    id: str
    name: str
    label: int
    width: float
    least: float


@dataclass(frozen=True)
class RoadMap:
    """Nodes, lanes between them, pick faces and zones; the pieces of lane that something stands in the way of, and the
    corridors that are too narrow for one.
    """  # noqa: D205

    nodes: list[Node] = field(default_factory=list)
    lanes: list[Lane] = field(default_factory=list)
    faces: list[PickFace] = field(default_factory=list)
    zones: list[Zone] = field(default_factory=list)
    blocked: list[Blocked] = field(default_factory=list)
    narrow: list[Narrow] = field(default_factory=list)

    def __repr__(self) -> str:
        return f"RoadMap({', '.join(f'{len(getattr(self, part.name))} {part.name}' for part in fields(self))})"

    def length(self, lane: Lane) -> float:
        """How long a lane is."""
        return math.dist(self.nodes[lane.start].at, self.nodes[lane.end].at)

    def heading(self, lane: Lane) -> float:
        """The direction from a lane's start to its end, radians."""
        (x0, y0), (x1, y1) = self.nodes[lane.start].at, self.nodes[lane.end].at
        return math.atan2(y1 - y0, x1 - x0)

    def directed(self) -> Iterator[Directed]:
        """Every lane, once for each way in which it may be driven."""
        for lane in self.lanes:
            if lane.way != "backward":
                yield Directed(lane.id, lane, lane.start, lane.end, lane.left, lane.right)
            if lane.way != "forward":
                yield Directed(f"{lane.id}r", lane, lane.end, lane.start, lane.right, lane.left)

    def to_networkx(self) -> networkx.DiGraph[Any]:
        """The directed graph: nodes and edges by their ids, with what is known of each. Needs networkx."""
        import networkx

        graph: networkx.DiGraph[Any] = networkx.DiGraph(frame="map", units="m")
        for node in self.nodes:
            graph.add_node(node.id, kind=node.kind, name=node.name, type=node.type, x=node.at[0], y=node.at[1])
        for way in self.directed():
            lane = way.lane
            values = {"id": way.id, "kind": lane.kind, "name": lane.name, "length": self.length(lane)}
            limit = {} if lane.speed is None else {"speed": lane.speed}
            ends = (self.nodes[end].id for end in (way.start, way.end))
            graph.add_edge(*ends, **values, left=way.left, right=way.right, **limit)
        return graph
