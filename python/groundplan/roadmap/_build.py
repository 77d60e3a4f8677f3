"""A survey's road map: stops of corridors, bays and doors, then nodes and lanes with ids."""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections import Counter
from typing import TYPE_CHECKING

import networkx

from groundplan.export._places import Place, main_angle, places
from groundplan.maps import Map
from groundplan.roadmap import _centre, _doors, _faces, _lanes, _open
from groundplan.roadmap._lanes import Way
from groundplan.roadmap._model import Blocked, Lane, Narrow, Node, PickFace, Point, RoadMap
from groundplan.roadmap._pixels import CLEAR_M, Pixels
from groundplan.roadmap._rules import Rule, ruled
from groundplan.roadmap._zones import zones

if TYPE_CHECKING:
    from groundplan.survey import Survey


def build(
    survey: Survey, rules: list[Rule], vehicle_width: float | None, spurs: float | None, map: Map | None
) -> RoadMap:
    """As `groundplan.roadmap.road_map`, its options checked."""
    made = _Builder(survey, rules, vehicle_width, None if map is None else Pixels(map))
    made.junctions()
    made.faces(spurs)
    regions = _doors.Regions(survey, made.places, made.ways, made.pixels, vehicle_width)
    made.doors(regions)
    made.open_space(regions)
    made.passed()
    made.aisles()
    return made.road_map()


class _Builder:
    """Nodes and lanes as they are found."""

    def __init__(self, survey: Survey, rules: list[Rule], vehicle_width: float | None, pixels: Pixels | None) -> None:
        self.survey, self.rules, self.vehicle, self.pixels = survey, rules, vehicle_width, pixels
        self.places = places(survey)
        ways = _lanes.ways([p for p in self.places if self._open(p)])
        least = _lanes.narrowest(ways) if vehicle_width is None else vehicle_width
        self.ways = {corridor: way for corridor, way in ways.items() if way.width >= least}
        left = [way for way in ways.values() if way.width < least]
        self.narrow = [Narrow(w.place.id, w.place.name, w.place.label, w.width, least) for w in left]
        if pixels is not None:
            for corridor, way in self.ways.items():
                keep = pixels.keep(way.width, vehicle_width)
                self.ways[corridor] = _centre.centred(survey, self.places, way, pixels, keep)
        self.nodes: list[Node] = []
        self.lanes: list[Lane] = []
        self.picks: list[PickFace] = []
        self.blocked: list[Blocked] = []

    def _open(self, place: Place) -> bool:
        return ruled(self.rules, place.name)[1] != "closed"

    def _lane(self, id: str, start: int, end: int, kind: str, place: Place, left: float, right: float) -> None:
        speed, way = ruled(self.rules, place.name)
        if start != end:
            sides = round(left, 6), round(right, 6)
            self.lanes.append(Lane(id, start, end, kind, place.name, place.label, *sides, speed, way))

    def _node(self, id: str, kind: str, at: Point, name: str, type: str = "", label: int | None = None) -> int:
        self.nodes.append(Node(id, kind, (round(at[0], 6), round(at[1], 6)), name, type, label))
        return len(self.nodes) - 1

    def junctions(self) -> None:
        """A node at each junction, and where a corridor ends."""
        again: Counter[str] = Counter()
        for stop in _lanes.stops(self.survey, self.ways):
            if stop.junction is not None:
                place = self.places[stop.junction]
                id, name, type = place.id, place.name, place.use if stop.kind == "junction" else ""
            else:
                way = self.ways[stop.corridors[0]]
                far = "E2" if way.place_of(stop.at)[0] > way.length / 2 else "E1"
                id, name, type = f"{way.place.id}.{far}", f"{way.place.name} {far}", ""
            again[id] += 1
            if again[id] > 1:
                id, name = f"{id}.{again[id]}", f"{name}.{again[id]}"
            self._node(id, stop.kind, stop.at, name, type, stop.junction)

    def faces(self, spurs: float | None) -> None:
        """A stop abreast of each pick face, and a spur to it where these are wanted."""
        found = _faces.bays(self.survey, self.places, self.ways)
        for corridor, row in _faces.feet(found).items():
            way = self.ways[corridor]
            for number, foot in enumerate(row, 1):
                id, name = f"{way.place.id}.P{number:02}", f"{way.place.name} P{number:02}"
                ends = [self._spur(way, foot.along, bay.left, spurs) for bay in foot.bays]
                spurred = any(end is not None for end in ends)
                stop = self._node(id, "foot" if spurred else "pick", way.point(foot.along), name)
                way.add(way.point(foot.along), stop)
                for bay, at in zip(foot.bays, ends, strict=True):
                    side = math.copysign(1.0, bay.left)
                    node, rack = stop, self.places[bay.rack]
                    if at is not None:
                        node = self._node(f"{bay.id}.stop", "pick", at, bay.id, label=bay.rack)
                        self._lane(f"{bay.id}.spur", stop, node, "spur", rack, bay.width / 2, bay.width / 2)
                    heading = math.atan2(side * way.along[0], -side * way.along[1])
                    self.picks.append(PickFace(bay.id, bay.at, round(heading, 9), node, bay.rack, bay.width))

    def _spur(self, way: Way, along: float, left: float, before: float | None) -> Point | None:
        """Where a spur to a face ends; None where there is none, or something stands in its way."""
        if before is None or abs(left) - before < _faces.SHORTEST_SPUR_M:
            return None
        end = way.point(along, math.copysign(abs(left) - before, left))
        if self.pixels is None:
            return end
        keep = min(self.pixels.keep(math.inf, self.vehicle), max(before - 2 * self.pixels.half, 0.0))
        return end if self.pixels.open([way.point(along), end], keep) else None

    def doors(self, regions: _doors.Regions) -> None:
        """A node in each door, joined to the lane or the room on either side."""
        doors: dict[int, int] = {}
        rooms: dict[int, int] = {}
        found = list(_doors.branches(self.survey, self.places, regions, self.vehicle or 0.0))
        # A door that leads nowhere, or from a lane to the same lane, is none.
        sides = Counter(branch.door for branch in {b.leads_to: b for b in found}.values())
        for branch in found:
            door = self.places[branch.door]
            if not self._open(door) or sides[branch.door] < 2:
                continue
            if branch.door not in doors:
                doors[branch.door] = self._node(door.id, "door", door.centre, door.name, label=door.label)
            start, half = doors[branch.door], (door.width or 0.0) / 2
            region = self.places[branch.region]
            if branch.turn is not None:
                id = f"{region.id}.{door.id}"
                turn = self._node(id, "turn", branch.turn, f"{region.name} {door.name}")
                self._lane(f"{id}.door", start, turn, "door", door, half, half)
                start = turn
            end = rooms.get(branch.region)
            if branch.corridor is not None:
                end = self._foot(branch.corridor, branch.along, door.id, door.name)
            if end is None:
                end = self._node(region.id, "room", region.centre, region.name, region.use, region.label)
                rooms[branch.region] = end
            self._lane(f"{self.nodes[start].id}-{self.nodes[end].id}", start, end, "door", door, half, half)

    def _foot(self, corridor: int, along: float, id: str, name: str) -> int:
        """The stop at a place of a lane: one that is there, or a new one."""
        way = self.ways[corridor]
        near = way.nearest(along)
        if abs(near[0] - along) <= _doors.AT_STOP_M:
            return near[1]
        made = self._node(f"{way.place.id}.{id}", "foot", way.point(along), f"{way.place.name} {name}")
        way.add(way.point(along), made)
        return made

    def open_space(self, regions: _doors.Regions) -> None:
        """Lanes from aisles that end in a hall straight on, or to the next."""
        for corridor, way in self.ways.items():
            for side in (0, -1):
                if way.stops and self.nodes[way.stops[side][1]].kind == "end":
                    self._straight_on(regions, corridor, side)
        self._corners(regions)
        for way in self.ways.values():
            for side in (0, -1):
                stop = way.stops[side][1]
                if self.nodes[stop].kind == "end" and self.nodes[stop].label is None:
                    ahead = _open.goes_on(regions, way, side == -1)
                    if ahead is not None:
                        way.stops[side] = (ahead, stop)
                        self.nodes[stop] = dataclasses.replace(self.nodes[stop], at=way.point(ahead))
        net = _open.Net(self.nodes, self.lanes, self.ways, self._leads)
        found = list(_open.links(regions, self.ways, self.nodes, net, main_angle(self.survey)))
        for number, link in enumerate(found, 1):
            if 2 * link.half < (self.vehicle or 0.0):
                continue
            id, start, place = f"H{number:02}", link.stop, self.ways[link.corridor].place
            if link.turn is not None:
                start = self._node(f"{id}.turn", "turn", link.turn, id)
                self._lane(f"{id}.1", link.stop, start, "open", place, link.half, link.half)
            end = self._foot(link.corridor, link.along, id, id)
            self._lane(f"{id}.{1 + (link.turn is not None)}", start, end, "open", place, link.half, link.half)
            for node in (link.stop, end):
                if self.nodes[node].kind == "end":  # the way goes on
                    self.nodes[node] = dataclasses.replace(self.nodes[node], kind="turn")

    def _corners(self, regions: _doors.Regions) -> None:
        """Lead a corridor on from its last junction to the end of the next one ahead: clutter may hide a corner."""
        for corridor, way in self.ways.items():
            for side in (0, -1):
                if not way.stops or self.nodes[way.stops[side][1]].kind != "junction":
                    continue
                ahead = _open.straight_on(regions, self.ways, corridor, side == -1)
                if ahead is not None:
                    self._corner(way, self.ways[ahead[0]], ahead[1])

    def _corner(self, way: Way, other: Way, along: float) -> None:
        """Move the end of another corridor's lane to where a corridor's lane meets it, if it is near."""
        for place, stop in (other.stops[0], other.stops[-1]):
            if self.nodes[stop].kind == "end" and abs(place - along) < other.width:
                at = other.point(along)
                self.nodes[stop] = dataclasses.replace(
                    self.nodes[stop], kind="turn", at=(round(at[0], 6), round(at[1], 6))
                )
                other.stops.remove((place, stop))
                for both in (way, other):
                    both.add(at, stop)
                return

    def _straight_on(self, regions: _doors.Regions, corridor: int, side: int) -> None:
        """Lead a corridor's lane on to the next one ahead, where the way is free; its end is none then."""
        ahead = _open.straight_on(regions, self.ways, corridor, side == -1)
        if ahead is not None:
            way = self.ways[corridor]
            way.stops.pop(side)
            node = self._foot(*ahead, way.place.id, way.place.name)
            way.add(self.nodes[node].at, node)
            if self.nodes[node].kind == "end":  # the way goes on
                self.nodes[node] = dataclasses.replace(self.nodes[node], kind="turn")

    def aisles(self) -> None:
        """Lanes from each stop of a corridor to the next."""
        for way in self.ways.values():
            for number, ((_, a), (_, b)) in enumerate(itertools.pairwise(way.stops), 1):
                if not self._leads(way, a, b):
                    self._block(f"{way.place.id}.{number}", a, b)
                    continue
                off = [way.aside + way.place_of(self.nodes[n].at)[1] for n in (a, b)]
                left, right = way.width / 2 - max(*off, 0.0), way.width / 2 + min(*off, 0.0)
                self._lane(f"{way.place.id}.{number}", a, b, "aisle", way.place, max(left, 0.0), max(right, 0.0))

    def _leads(self, way: Way, a: int, b: int) -> bool:
        """Whether nothing stands in the way from one stop of a corridor to the next, as far as pixels are known."""
        if self.pixels is None:
            return True
        return self.pixels.open([self.nodes[n].at for n in (a, b)], self.pixels.keep(way.width, self.vehicle))

    def _block(self, id: str, a: int, b: int) -> None:
        if self.pixels is not None:
            reach = max(self.vehicle or 0.0, 2 * CLEAR_M) + self.pixels.half
            self.blocked.append(Blocked(id, self.pixels.nearest(self.nodes[a].at, self.nodes[b].at, reach)))

    def passed(self) -> None:
        """Junctions that only one corridor's lane runs through, because the others' are blocked, mean nothing."""
        if self.pixels is None:
            return
        ends: dict[int, list[tuple[int, int]]] = {}
        for corridor, way in self.ways.items():
            for (_, a), (_, b) in itertools.pairwise(way.stops):
                if self._leads(way, a, b):
                    ends.setdefault(a, []).append((corridor, b))
                    ends.setdefault(b, []).append((corridor, a))
        used = {end for lane in self.lanes for end in (lane.start, lane.end)}
        for stop, leads in ends.items():
            if self.nodes[stop].kind == "junction" and stop not in used and len(leads) == 2:
                (one, _), (other, _) = leads
                if one == other:
                    self.ways[one].stops = [kept for kept in self.ways[one].stops if kept[1] != stop]

    def _drop_loose(self) -> None:
        """Of a lane that is blocked on both sides nothing is left: no vehicle comes there."""
        graph: networkx.Graph[int] = networkx.Graph((lane.start, lane.end) for lane in self.lanes)
        loose: set[int] = set()
        for part in networkx.connected_components(graph):
            if all(self.nodes[node].kind in ("pick", "foot") for node in part):
                loose |= part
        self.lanes = [lane for lane in self.lanes if lane.start not in loose]

    def road_map(self) -> RoadMap:
        """What has come together: nodes that a lane joins, and the zones."""
        self._drop_loose()
        joined = {end for lane in self.lanes for end in (lane.start, lane.end)}
        kept = [n for n in range(len(self.nodes)) if n in joined]
        place = {old: new for new, old in enumerate(kept)}
        lanes = [dataclasses.replace(lane, start=place[lane.start], end=place[lane.end]) for lane in self.lanes]
        faces = [PickFace(f.id, f.at, f.heading, place[f.node], f.rack, f.width) for f in self.picks if f.node in place]
        found = list(zones(self.places, self.ways, self.rules, main_angle(self.survey)))
        return RoadMap([self.nodes[n] for n in kept], lanes, faces, found, self.blocked, self.narrow)
