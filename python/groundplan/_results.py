"""What each stage of the method makes: records of arrays.

Lengths are metres, angles radians, points in the map frame; an id that is none (the line of a border edge, the face
outside) is `NONE`. Section numbers are those of Gholami Shahbandi, Åstrand and Philippsen (ICARCV 2014).
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import numpy.typing as npt

from groundplan import _core
from groundplan._errors import ParameterError, shown

Floats = npt.NDArray[np.float64]
Ids = npt.NDArray[np.uint32]
SignedIds = npt.NDArray[np.int32]
Flags = npt.NDArray[np.bool_]

#: No id.
NONE = -1

STATES = ("free", "occupied", "unknown")

#: The kinds of labels.
KINDS = ("corridor", "junction", "rack", "region", "door", "pillar")

#: A label: ``kind`` and the keys that the survey's format gives that kind. Plain values, as in the JSON.
Label = dict[str, Any]
#: Labels of this confidence or less are shown and spoken of as unsure.
UNSURE = _core.UNSURE


class Stage:
    """What a stage made: a record of arrays. Equal when every array is."""

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        mine = ((getattr(self, f.name), getattr(other, f.name)) for f in fields(self))  # type: ignore[arg-type]
        return all(np.array_equal(a, b) for a, b in mine)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        parts = {f.name: getattr(self, f.name) for f in fields(self)}  # type: ignore[arg-type]
        said = (f"{name} {v:g}" if isinstance(v, int | float) else f"{len(v)} {name}" for name, v in parts.items())
        return f"{type(self).__name__}({', '.join(said)})"


@dataclass(frozen=True, eq=False, repr=False)
class Gradients(Stage):
    """II-A: edge pixels (occupied, with a 4-neighbour that is not) and the gradient at each.

    Attributes
    ----------
    pixels : (N, 2) uint32
        Column, and row from the bottom.
    angles : (N,) float32
        Direction along the wall on the grid; the gradient is perpendicular to it.
    magnitudes : (N,) uint8
        0 (no direction: a speck, a post) to 255 (a straight wall).
    """

    pixels: Ids
    angles: npt.NDArray[np.float32]
    magnitudes: npt.NDArray[np.uint8]


@dataclass(frozen=True, eq=False, repr=False)
class Directions(Stage):
    """II-A: the dominant directions, strongest first.

    Attributes
    ----------
    angles : (D,) float64
        Of the lines themselves, in [-pi/2, pi/2).
    weights : (D,) float64
        Structure that lines up along each, as a share of the strongest's.
    histogram : (B,) float64
        The evidence: histogram of oriented gradients from -pi/2 to pi/2, weighted by magnitude.
    explained : float
        Share of the edge pixels' length that lines up along the directions, 0 to 1.
    """

    angles: Floats
    weights: Floats
    histogram: Floats
    explained: float

    def __len__(self) -> int:
        return len(self.angles)

    @classmethod
    def of(cls, angles: npt.ArrayLike) -> Directions:
        """Directions of your own, angles in radians, a turn at most; they are brought into [-pi/2, pi/2).

        Raises
        ------
        ParameterError
            ``stage.input`` for what is no angle in radians, and for one direction given twice.
        """
        own = _numbers("angles", angles, "such as Directions.of([0.0, math.pi / 2])")
        for k, angle in enumerate(own.tolist()):
            if abs(angle) > 2 * np.pi:
                said = f"angles[{k}] is {angle:g}, and no angle in radians is beyond a turn"
                raise ParameterError("stage.input", said, "Directions.of(np.radians(angles)) takes degrees")
        for k, n in itertools.combinations(range(len(own)), 2):
            if abs((own[k] - own[n] + np.pi / 2) % np.pi - np.pi / 2) < _core.SAME_DIRECTION:
                said = f"angles[{k}] and angles[{n}], {own[k]:g} and {own[n]:g}, are one direction"
                raise ParameterError("stage.input", said, "each is given once; half a turn further it is the same")
        return cls((own + np.pi / 2) % np.pi - np.pi / 2, np.ones(len(own)), np.zeros(0), 1.0)


@dataclass(frozen=True, eq=False, repr=False)
class Radiogram(Stage):
    """II-B: how much structure lies at each offset across one direction.

    Attributes
    ----------
    direction : int
        Index of the direction.
    start, step : float
        Offset of the first value along the normal (-sin, cos), and from one to the next, metres.
    values : (N,) float64
        Metres of structure.
    """

    direction: int
    start: float
    step: float
    values: Floats

    @property
    def offsets(self) -> Floats:
        """Offset of each value, metres."""
        return self.start + self.step * np.arange(len(self.values), dtype=np.float64)


@dataclass(frozen=True, eq=False, repr=False)
class Response(Stage):
    """II-B: responses of a radiogram to Ricker wavelets (Du, Kibbe and Lin 2006).

    Attributes
    ----------
    widths : (W,) float64
        Sigma of each wavelet, metres.
    rows : (W, N) float64
        Response at each width and offset.
    """

    widths: Floats
    rows: Floats


@dataclass(frozen=True, eq=False, repr=False)
class Lines(Stage):
    """II-B: lines n.p = offset with n = (-sin angle, cos angle), by direction and offset.

    Attributes
    ----------
    directions : (L,) uint32
        Index of each line's direction.
    offsets : (L,) float64
        Metres.
    amplitudes : (L,) float64
        Metres of structure lying on it; along the face of a rack on legs, of the legs.
    widths : (L,) float64
        Width (sigma) of its peak, metres; along the face of a rack on legs, a pixel's.
    min_amplitude : float
        Least amplitude of a peak let through: what the resolution knob came to.
    """

    directions: Ids
    offsets: Floats
    amplitudes: Floats
    widths: Floats
    min_amplitude: float

    def __len__(self) -> int:
        return len(self.offsets)

    @classmethod
    def of(cls, directions: npt.ArrayLike, offsets: npt.ArrayLike) -> Lines:
        """Lines of your own: the index of the direction and the offset in metres of each.

        Offsets are along the normal (-sin, cos) of the direction's angle in [-pi/2, pi/2): an upright line at x has
        the angle -pi/2, the normal (1, 0) and so the offset x.

        Raises
        ------
        ParameterError
            ``stage.input`` for what is no index or no offset, and for more of the one than of the other.
        """
        own = _numbers("offsets", offsets, "metres, one for each line")
        families = _numbers("directions", directions, "indices of Directions, from 0 on, one for each line")
        for k, family in enumerate(families.tolist()):
            if family != int(family) or not 0 <= family <= np.iinfo(np.uint32).max:
                said = f"directions[{k}] is {family:g}, which is no index"
                raise ParameterError("stage.input", said, "the first direction is 0")
        if len(families) != len(own):
            said = f"directions and offsets have {len(families)} and {len(own)} values"
            raise ParameterError("stage.input", said, "each line has one of both")
        return cls(families.astype(np.uint32), own, np.ones(len(own)), np.zeros(len(own)), 0.0)


@dataclass(frozen=True, eq=False, repr=False)
class Subdivision(Stage):
    """II-C: what the lines cut the map into. Ragged lists are values with offsets.

    Attributes
    ----------
    vertices : (V, 2) float64
    edge_vertices : (E, 2) uint32
    edge_lines : (E,) int32
        `NONE` on the border.
    edge_faces : (E, 2) int32
        N(edge): left and right, seen from the first vertex to the second; `NONE` outside.
    face_vertices, face_edges : (sum of sides,) uint32
        Counter-clockwise; the n-th edge joins the n-th vertex and the next.
    face_offsets : (F + 1,) uint32
        Face f has the entries from ``face_offsets[f]`` to ``face_offsets[f + 1]``.
    centres : (F, 2) float64
    areas : (F,) float64
    map_area : float
    """

    vertices: Floats
    edge_vertices: Ids
    edge_lines: SignedIds
    edge_faces: SignedIds
    face_vertices: Ids
    face_edges: Ids
    face_offsets: Ids
    centres: Floats
    areas: Floats
    map_area: float

    def polygon(self, face: int) -> Floats:
        """Vertices of a face, (N, 2), counter-clockwise."""
        ring: Floats = self.vertices[self.face_vertices[self.face_offsets[face] : self.face_offsets[face + 1]]]
        return ring

    def problems(self) -> list[str]:
        """Every broken invariant, as sentences; an empty list when all hold."""
        return _core.problems(record(self))


@dataclass(frozen=True, eq=False, repr=False)
class Occupancy(Stage):
    """II-D: O(face), O(edge).

    Attributes
    ----------
    faces : (F,) float64
        Average occupancy of the face's pixels; unknown pixels count 0.5.
    unknown, free : (F,) float64
        Share of unknown and of free pixels.
    pixels : (F,) uint64
        Pixels with their centre in the face; together all of the map's.
    states : (F,) uint8
        0 free, 1 occupied, 2 unknown.
    edges : (E,) float64
        Share of the edge's length on which occupied pixels lie; 0 on the border.
    runs : (R, 2) float64
        Where on the edges they lie: from, to, metres from the edge's first vertex.
    run_offsets : (E + 1,) uint32
        Edge e has the runs from ``run_offsets[e]`` to ``run_offsets[e + 1]``.
    """

    faces: Floats
    unknown: Floats
    free: Floats
    pixels: npt.NDArray[np.uint64]
    states: npt.NDArray[np.uint8]
    edges: Floats
    runs: Floats
    run_offsets: Ids


@dataclass(frozen=True, eq=False, repr=False)
class Walls(Stage):
    """II-D: cogency, and the abstraction that the cogent edges make.

    Attributes
    ----------
    cogent : (E,) bool
        C(edge).
    disparity : (E,) float64
        |O(f1) - O(f2)|.
    points : (2 W, 2) float64
        Two ends of each wall, where its structure begins and ends.
    lines : (W,) uint32
    freestanding : (W,) bool
        Else separating.
    """

    cogent: Flags
    disparity: Floats
    points: Floats
    lines: Ids
    freestanding: Flags

    def __len__(self) -> int:
        return len(self.lines)


@dataclass(frozen=True, eq=False, repr=False)
class Adjacency(Stage):
    """II-D, II-E: the dual.

    Attributes
    ----------
    faces : (K, 2) uint32
        Of each link.
    edges : (K,) uint32
        That each link crosses.
    connected : (K,) bool
        C(link) = not C(edge).
    """

    faces: Ids
    edges: Ids
    connected: Flags

    def __len__(self) -> int:
        return len(self.edges)


def _numbers(name: str, values: npt.ArrayLike, hint: str) -> Floats:
    """Numbers in a row, all of them finite.

    Raises
    ------
    ParameterError
        ``stage.input``.
    """
    try:
        own: Floats = np.atleast_1d(np.asarray(values, dtype=np.float64))
    except (TypeError, ValueError, OverflowError):
        own = np.empty((0, 0))
    if own.ndim != 1 or values is None:
        raise ParameterError("stage.input", f"{name} has to be a list of numbers and is {shown(values)}", hint)
    for k in np.flatnonzero(~np.isfinite(own)).tolist():
        raise ParameterError("stage.input", f"{name}[{k}] is {own[k]}, which is not finite", hint)
    return own


def record(stage: Stage) -> dict[str, Any]:
    """A stage's arrays as the core takes them, not copied."""
    return {f.name: getattr(stage, f.name) for f in fields(stage)}  # type: ignore[arg-type]


@dataclass(frozen=True)
class MapInfo:
    """The surveyed map's block: image name, size in pixels, metres per pixel, origin (m, m, rad)."""

    image: str
    width: int
    height: int
    resolution: float
    origin: tuple[float, float, float]
