"""The Survey: what every stage made of a map, as arrays, as JSON, as a graph and as geometries."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

import numpy as np
import numpy.typing as npt

from groundplan._errors import FormatError, ParameterError
from groundplan._files import unreadable, whole
from groundplan._format import check_format
from groundplan._queries import Place, Queries, Route, no_point
from groundplan._results import (
    KINDS,
    Adjacency,
    Directions,
    Label,
    Lines,
    MapInfo,
    Occupancy,
    Radiogram,
    SignedIds,
    Stage,
    Subdivision,
    Walls,
)
from groundplan._tree import LABELS, Table, from_tree, to_tree, written
from groundplan.maps import Map, MapWarning

if TYPE_CHECKING:
    import networkx

#: What is taken for many coordinates and not for one.
_MANY = (np.ndarray, list, tuple)


@dataclass(frozen=True, eq=False, repr=False)
class Survey(Stage):
    """What every stage made of a map; the evidence is kept.

    Attributes
    ----------
    map : MapInfo
    parameters : dict
        Every one in force, defaults too; None where the value found itself.
    directions, radiograms, lines, subdivision, occupancy, walls, adjacency
        As `groundplan.stages` describes them.
    labels : list of dict
        ``kind`` and the keys that docs/survey.md gives that kind; an id is a position in this list.
    patterns : list of dict
        What recurs among the labels, ``bays`` and ``pillars``: ``labels``, ``angle``, ``pitch`` and ``phase``.
    warnings : list of MapWarning
        Partial trouble, the map's own first.
    source : str or None
        The map's file, relative to the directory that the survey is written to, so that figures can be drawn over it
        later; known where the command line wrote the survey.
    reading : dict
        What was given for reading the map, by the names of `groundplan.read`; empty where the file said all.
    """

    map: MapInfo
    parameters: dict[str, Any]
    directions: Directions
    radiograms: list[Radiogram]
    lines: Lines
    subdivision: Subdivision
    occupancy: Occupancy
    walls: Walls
    adjacency: Adjacency
    labels: list[Label]
    patterns: list[Label] = field(default_factory=list)
    warnings: list[MapWarning] = field(default_factory=list)
    source: str | None = None
    reading: dict[str, Any] = field(default_factory=dict)

    def __repr__(self) -> str:
        info = self.map
        return (
            f"Survey({info.image!r}, {info.width} x {info.height} pixels of {info.resolution:g} m: "
            f"{len(self.directions)} directions, {len(self.lines)} lines, {len(self.occupancy.faces)} faces, "
            f"{len(self.walls)} walls, {self._label_table().count} labels, {len(self.warnings)} warnings)"
        )

    def problems(self) -> list[str]:
        """Every broken invariant of the subdivision and its pixels, as sentences; an empty list when all hold."""
        found = self.subdivision.problems()
        pixels, expected = int(self.occupancy.pixels.sum()), self.map.width * self.map.height
        if pixels != expected:
            found.append(f"the faces hold {pixels} pixels and the map {expected}")
        return found

    def of_kind(self, kind: str) -> list[Label]:
        """The labels of one kind: ``corridor``, ``junction``, ``rack``, ``region``, ``door`` or ``pillar``.

        Raises
        ------
        ParameterError
            ``label.kind`` for a kind that there is not.
        """
        found = [label for label in self.labels if label["kind"] == kind]
        if not found and kind not in KINDS:
            raise ParameterError("label.kind", f"no label is of kind {kind!r}", f"there are {', '.join(KINDS)}")
        return found

    def __getstate__(self) -> dict[str, Any]:
        """What is copied and pickled: the fields, and neither index nor map."""
        return {f.name: getattr(self, f.name) for f in fields(self)}

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            """What takes much memory and is not always asked for is made when it is."""
            later = self.__dict__.get("_later", {})
            if name not in later:
                raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")
            return self.__dict__.setdefault(name, later[name]())

    def _label_table(self) -> Table:
        """The labels, of which some can be had without making all."""
        labels: list[Label] | None = self.__dict__.get("labels")
        return self.__dict__["_some_labels"] if labels is None else Table(len(labels), labels.__getitem__, LABELS)

    def _each_label(self) -> Iterator[Label]:
        """The labels one after another, none of them kept."""
        found = self._label_table()
        for first in range(0, found.count, found.at_once):
            yield from found.some(slice(first, first + found.at_once))

    def _with(self, **changes: Any) -> Survey:
        """As `dataclasses.replace` has it, but what is not made yet stays so."""
        other = object.__new__(type(self))
        other.__dict__.update(self.__dict__ | changes)
        other.__dict__.pop("_index", None)
        return other

    @property
    def _queries(self) -> Queries:
        known: Queries | None = self.__dict__.get("_index")
        if known is None:
            known = self.__dict__["_index"] = Queries(self)
        return known

    @overload
    def locate(self, x: float, y: float) -> int | None: ...
    @overload
    def locate(self, x: npt.NDArray[Any] | Sequence[float], y: npt.NDArray[Any] | Sequence[float]) -> SignedIds: ...
    def locate(self, x: Any, y: Any) -> int | SignedIds | None:
        """The face that holds a point (metres, map frame), None outside the map; of arrays, an array with `NONE`.

        Every point of the map is in one face: one on a line is in the face on the side of the line's normal
        (-sin angle, cos angle), one on the map's border in the map. Points are rounded to 2^-26 of a pixel. The first
        call makes an index, the others take about a microsecond.

        Raises
        ------
        ParameterError
            ``point.finite`` for what is not, ``point.number`` for what is no number.
        """
        if isinstance(x, _MANY) or isinstance(y, _MANY):
            return self._queries.locate_all(x, y)
        try:
            face = self._queries.locator.locate(x, y)
        except (TypeError, OverflowError):
            raise no_point(x, y) from None
        if face is None and not (math.isfinite(x) and math.isfinite(y)):
            raise no_point(x, y)
        return face

    def labels_at(self, x: float, y: float) -> list[Label]:
        """The labels whose polygons hold a point (metres, map frame): region, corridor, junction, rack; by their ids.

        Raises
        ------
        ParameterError
            ``point.finite`` for what is not, ``point.number`` for what is no number.
        """
        try:
            is_finite = math.isfinite(x) and math.isfinite(y)
        except (TypeError, OverflowError):
            is_finite = False
        if not is_finite:
            raise no_point(x, y)
        return [self.labels[n] for n in self._queries.locator.labels_at(x, y)]

    def route(
        self, a: Place, b: Place, *, clearance: float = 0.3, around_racks: bool = False, map: Map | None = None
    ) -> Route | None:
        """The shortest way from one place to another, None where there is none.

        Parameters
        ----------
        a, b
            A point (x, y) in metres in the map frame, the name of a label ("A03", or "J01" as in exports) or the id of
            a face. From a label or a face the way begins near its middle, where the clearance allows.
        clearance
            What to keep from what is occupied, metres: the robot's radius and what it needs beside.
        around_racks
            Take racks as occupied. A map has what the lidar saw: under a rack that stands on legs, and in its empty
            bays, pixels are free, and the shortest way may lead there; `Route.racks` says where it does.
        map
            The surveyed map; a survey that was just made still has it.

        Returns
        -------
        Route or None
            Where the map is at hand, every point of the way lies in free pixels and is at least `clearance` from every
            occupied one. A survey that was read from a file knows less: the outlines of its regions and what lies on
            the edges of its faces. From these the clearance is kept; what is small and stands by itself (a chair, a
            bin, goods in an aisle) it does not know. The way is the shortest over steps to eight neighbouring pixels,
            pulled taut: a few percent longer than the shortest at most, as a rule. The faces are those that it passes
            through; it crosses their edges where nothing lies on them, so that a door in a long wall is a way though
            the link there is not connected.

            The first call for a clearance goes over the map once, the others search what that left.

        Raises
        ------
        ParameterError
            ``route.name``, ``route.face``, ``route.place``, ``route.outside``, ``point.finite`` for what is no place;
            ``route.blocked`` where a robot with that clearance cannot be; ``route.clearance``; ``route.map`` for a map
            of another size.
        """
        return self._queries.route(a, b, clearance, around_racks, self.__dict__.get("_map") if map is None else map)

    @overload
    def update(self, change: Map, *, threads: int | None = None) -> Survey: ...
    @overload
    def update(self, change: npt.ArrayLike, row: int, column: int, *, threads: int | None = None) -> Survey: ...
    def update(
        self, change: Any, row: int | None = None, column: int | None = None, *, threads: int | None = None
    ) -> Survey:
        """The survey of the map after a change, with the bytes that a survey of the whole map has.

        Gradients are found again around the change alone. What follows is made anew, but for what labels are found
        from where neither the map nor a line has changed. This survey and its map stay as they are.

        Parameters
        ----------
        change : (H, W) uint8, int8 or bool, or Map
            What the map has now from `row` and `column` on, its rows in the order of an array that `groundplan.survey`
            takes: uint8 are values of the map's own pixels, the top row first; int8 the data of a
            map_msgs/OccupancyGridUpdate (-1, 0..100), the lowest row first; bool is occupied or not, the top row first.
            Or the whole map anew, which is compared with the one before.
        row, column
            Where the patch's first pixel goes. Rows are counted as the patch has them: from the map's top row, of int8
            from its lowest one, as ``y`` of the message; columns from the left, as its ``x``.
        threads
            At most so many; all cores by default.

        Returns
        -------
        Survey
            To be updated in its turn; where nothing changed, this one. What `groundplan.survey` was given beside the
            map still holds. A patch does not change how pixels are read, nor the warnings of that, but for those that
            no pixel is free, or occupied, where it brings one; another map brings its own.

        Raises
        ------
        ParameterError
            ``update.map`` for a survey that has no map, because it was read from a file or copied; ``update.patch`` for
            what is no patch, does not lie in the map, or has values that no pixel of the map can have.
        """
        from groundplan._update import update

        return update(self, change, row, column, threads)

    def to_dict(self) -> dict[str, Any]:
        """The survey as the format has it: plain lists and numbers."""
        return to_tree(self)

    def to_json(self) -> str:
        """The survey as JSON, a line for each part; the same survey gives the same bytes."""
        return "".join(written(self))

    def write(self, path: str | os.PathLike[str]) -> None:
        """Write the JSON, whole or not at all."""
        with whole(path) as beside:
            self._write_to(beside)

    def _write_to(self, path: Path) -> None:
        """Write the JSON, of a large survey a little at a time."""
        with path.open("w", encoding="utf-8") as file:
            file.writelines(written(self))

    @classmethod
    def from_json(cls, text: str | bytes) -> Survey:
        """The survey that `to_json` wrote.

        Raises
        ------
        FormatError
            ``survey.json`` when it is not JSON, ``survey.format`` or ``survey.version`` when it is something else,
            ``survey.content`` when a part is missing or has the wrong shape.
        """
        try:
            tree = json.loads(text)
        except (ValueError, RecursionError) as fault:
            raise FormatError("survey.json", f"the survey is not JSON: {fault}") from fault
        check_format(tree if isinstance(tree, dict) else {})
        try:
            return cls(**from_tree(tree))
        except (KeyError, TypeError, ValueError, IndexError, AttributeError, OverflowError) as fault:
            raise FormatError("survey.content", f"the survey is not whole: {type(fault).__name__} {fault}") from fault

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Survey:
        """A survey from its file.

        Raises
        ------
        FormatError
            ``survey.read`` when the file cannot be read, else as `from_json`.
        """
        try:
            return cls.from_json(Path(path).read_bytes())
        except OSError as fault:
            raise unreadable("survey.read", path, fault) from fault

    def export(self, path: str | os.PathLike[str], format: str | None = None, **options: Any) -> list[Path]:
        """Write the survey in the format of another program, such as ``dxf``; see `groundplan.export.export`."""
        from groundplan.export import export

        return export(self, path, format, **options)

    def to_networkx(self) -> networkx.Graph[int]:
        """The adjacency graph: faces as nodes, links as edges. Needs networkx.

        A node has its ``centre``, ``area``, ``occupancy`` and ``state``, an edge the ``edge`` that it crosses and
        whether it is ``connected``. Two faces meet in one edge at most.
        """
        from groundplan._interop import to_networkx

        return to_networkx(self)

    def to_shapely(self) -> dict[str, npt.NDArray[np.object_]]:
        """Geometries in the map frame, in the order of their ids. Needs shapely.

        ``faces`` and ``labels`` are polygons, ``edges`` and ``walls`` line strings, ``vertices`` points. A label
        without a polygon, such as a door, is None.
        """
        from groundplan._interop import to_shapely

        return to_shapely(self)
