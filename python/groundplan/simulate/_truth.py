"""What a survey of the map should find: the plan in the map frame, cut down to what the map shows."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from groundplan.simulate._lidar import FREE, OCCUPIED, UNKNOWN
from groundplan.simulate._plan import Face, GroundPlan, Network, Node, Point

Frame = Callable[[Point], Point]

_EVERY = 0.1  # metres between two looks along a line
_BENT = 0.10  # metres that a straight piece of a bent line may leave it by ...
_SHORTEST = 4.0  # ... unless it is hardly longer than this
_BAY = 1.5  # half the window, metres, in which a line must show something: a bay wide


@dataclass(frozen=True)
class Picture:
    """The map as the truth looks at it: (height, width) pixels, row 0 lowest, and where they lie."""

    pixels: npt.NDArray[np.uint8]
    origin: Point
    resolution: float

    def at(self, points: npt.NDArray[np.float64]) -> npt.NDArray[np.uint8]:
        """Pixel values at (..., 2) points; unknown outside."""
        index = np.floor((points - np.array(self.origin)) / self.resolution).astype(int)
        height, width = self.pixels.shape
        inside = (index >= 0).all(axis=-1) & (index[..., 0] < width) & (index[..., 1] < height)
        index = np.where(inside[..., None], index, 0)
        values: npt.NDArray[np.uint8] = np.where(inside, self.pixels[index[..., 1], index[..., 0]], UNKNOWN)
        return values.astype(np.uint8)


def truth(plan: GroundPlan, net: Network, picture: Picture, frame: Frame, yaw: float) -> dict[str, Any]:
    """The truth of `groundplan evaluate`'s format.

    Parameters
    ----------
    plan, net
        The site and the network of its corridors.
    picture
        The map that the robot made.
    frame
        From a point of the plan to where the map shows it: turned, moved, and bent by the drift that is left.
    yaw
        Angle of the plan in the map, radians.
    """
    pieces = [(face, piece) for face in plan.faces for piece in _seen_face(face, picture, frame)]
    directions = [_fold(a + yaw + _turned(a, yaw, pieces, frame)) for a in plan.directions]
    lines = [_line(face.kind, straight) for face, piece in pieces for straight in _straights(piece, frame)]
    corridors = []
    for corridor in plan.corridors:
        for a, b in _seen_corridor(corridor.a, corridor.b, picture, frame):
            corridors.append({"a": _point(a), "b": _point(b), "width": round(corridor.width, 4)})
    junctions: list[dict[str, Any]] = []
    ends: list[dict[str, Any]] = []
    for node in net.nodes:
        if node.kind is None:
            continue
        entry = {
            "at": _point(frame(node.at)),
            "type": node.kind,
            "arms": len(node.arms),
            "observed": _seen_node(node, picture, frame),
        }
        (ends if node.kind == "end" else junctions).append(entry)
    return {
        "directions": [round(a, 9) for a in directions],
        "lines": lines,
        "corridors": corridors,
        "junctions": junctions,
        "ends": ends,
    }


def _fold(angle: float) -> float:
    """An undirected angle, in [-pi/2, pi/2)."""
    return (angle + math.pi / 2) % math.pi - math.pi / 2


def _point(p: Point) -> list[float]:
    return [round(p[0], 4), round(p[1], 4)]


def _line(kind: str, piece: tuple[Point, Point]) -> dict[str, Any]:
    p, q = piece
    angle = _fold(math.atan2(q[1] - p[1], q[0] - p[0]))
    normal = (-math.sin(angle), math.cos(angle))
    offset = normal[0] * (p[0] + q[0]) / 2 + normal[1] * (p[1] + q[1]) / 2
    return {
        "kind": kind,
        "p": _point(p),
        "q": _point(q),
        "normal": [round(normal[0], 9), round(normal[1], 9)],
        "offset": round(offset, 4),
    }


def walk(p: Point, q: Point, every: float) -> list[Point]:
    """Points from `p` to `q`, in the middles of equal steps of about `every` metres."""
    count = max(1, round(math.dist(p, q) / every))
    return [(p[0] + (q[0] - p[0]) * (k + 0.5) / count, p[1] + (q[1] - p[1]) * (k + 0.5) / count) for k in range(count)]


def mapped(points: list[Point], frame: Frame) -> npt.NDArray[np.float64]:
    """Where the map shows points of the plan, (n, 2)."""
    return np.array([frame(p) for p in points])


def _seen_face(face: Face, picture: Picture, frame: Frame) -> list[list[Point]]:
    """The parts of a face that the map shows: floor before it is known, and it has left marks, bay for bay.

    Each part is a list of points along it, in the plan.
    """
    points = walk(face.p, face.q, _EVERY)
    nx, ny = face.outward
    known, marked = np.zeros(len(points), dtype=bool), np.zeros(len(points), dtype=bool)
    for off in (0.25, 0.4):
        known |= picture.at(mapped([(x + off * nx, y + off * ny) for x, y in points], frame)) != UNKNOWN
    for off in (-0.12, -0.08, -0.04, 0.0, 0.04, 0.08):
        marked |= picture.at(mapped([(x + off * nx, y + off * ny) for x, y in points], frame)) == OCCUPIED
    reach = round(_BAY / _EVERY)
    least = 0.3 if face.kind == "wall" else 0.04  # a wall is solid; of an empty rack only posts are seen
    seen = known & (_share(known, reach) >= 0.6) & (_share(marked, reach) >= least)
    pieces = []
    for first, last in _runs(seen, gap=round(2 * _BAY / _EVERY)):
        marks = np.flatnonzero(marked[first : last + 1])
        if marks.size < 2:
            continue
        first, last = first + int(marks[0]), first + int(marks[-1])
        # Short faces, such as a row's end, are whole or not there.
        if (last - first + 1) * _EVERY >= min(2.0, 0.7 * len(points) * _EVERY):
            pieces.append(points[first : last + 1])
    return pieces


def _turned(angle: float, yaw: float, pieces: list[tuple[Face, list[Point]]], frame: Frame) -> float:
    """How far the drift that is left turns a family of lines as a whole, radians (least squares).

    A map that bends has directions of its own: those that its lines have in the mean. Pieces that lie on one line
    of the plan count as one line.
    """
    u, n = (math.cos(angle + yaw), math.sin(angle + yaw)), (-math.sin(angle + yaw), math.cos(angle + yaw))
    groups: dict[int, list[Point]] = {}
    for face, piece in pieces:
        if abs(_fold(math.atan2(face.q[1] - face.p[1], face.q[0] - face.p[0]) - angle)) < math.radians(1):
            offset = face.p[1] * math.cos(angle) - face.p[0] * math.sin(angle)
            groups.setdefault(round(offset / 0.05), []).extend(frame(p) for p in piece)
    above, below = 0.0, 0.0
    for shown in groups.values():
        along = [p[0] * u[0] + p[1] * u[1] for p in shown]
        across = [p[0] * n[0] + p[1] * n[1] for p in shown]
        mean_along, mean_across = math.fsum(along) / len(along), math.fsum(across) / len(across)
        above += math.fsum((s - mean_along) * (d - mean_across) for s, d in zip(along, across, strict=True))
        below += math.fsum((s - mean_along) ** 2 for s in along)
    return above / below if below else 0.0


def _share(flags: npt.NDArray[np.bool_], reach: int) -> npt.NDArray[np.float64]:
    """Share of True within `reach` to both sides, cut off at the ends."""
    total = np.concatenate([[0], np.cumsum(flags)])
    index = np.arange(flags.size)
    low, high = np.maximum(index - reach, 0), np.minimum(index + reach + 1, flags.size)
    share: npt.NDArray[np.float64] = (total[high] - total[low]) / (high - low)
    return share


def _runs(flags: npt.NDArray[np.bool_], gap: int) -> list[tuple[int, int]]:
    """(first, last) of the runs of True, joined over gaps of up to `gap`."""
    runs: list[tuple[int, int]] = []
    for k in np.flatnonzero(flags).tolist():
        if runs and k - runs[-1][1] <= gap + 1:
            runs[-1] = (runs[-1][0], k)
        else:
            runs.append((k, k))
    return runs


def _straights(points: list[Point], frame: Frame) -> list[tuple[Point, Point]]:
    """The straight pieces that fit best where the map shows these points of a line: one, or more where it bends."""
    shown = [frame(p) for p in points]
    for count in range(1, max(1, round(len(points) * _EVERY / _SHORTEST)) + 1):
        stops = [round(k * len(shown) / count) for k in range(count + 1)]
        pieces = [shown[a:b] for a, b in itertools.pairwise(stops)]
        fits = [_straight(piece) for piece in pieces]
        if all(_off(fit, piece) < _BENT for fit, piece in zip(fits, pieces, strict=True)):
            break
    return fits


def _off(line: tuple[Point, Point], points: list[Point]) -> float:
    """How far the points lie off a line, at most."""
    (ax, ay), (bx, by) = line
    length = math.dist(*line) or 1.0
    return max(abs((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / length for x, y in points)


def _straight(shown: list[Point]) -> tuple[Point, Point]:
    """The straight piece that fits points of a line best."""
    n = len(shown)
    mx, my = math.fsum(p[0] for p in shown) / n, math.fsum(p[1] for p in shown) / n
    sxx = math.fsum((p[0] - mx) ** 2 for p in shown)
    syy = math.fsum((p[1] - my) ** 2 for p in shown)
    sxy = math.fsum((p[0] - mx) * (p[1] - my) for p in shown)
    angle = 0.5 * math.atan2(2 * sxy, sxx - syy)
    c, s = math.cos(angle), math.sin(angle)
    along = [(p[0] - mx) * c + (p[1] - my) * s for p in shown]
    ends = (along[0], along[-1])
    return (mx + ends[0] * c, my + ends[0] * s), (mx + ends[1] * c, my + ends[1] * s)


def _seen_corridor(a: Point, b: Point, picture: Picture, frame: Frame) -> list[tuple[Point, Point]]:
    """The parts of a centre line along which the floor is known to be free."""
    length = math.dist(a, b)
    nx, ny = -(b[1] - a[1]) / length, (b[0] - a[0]) / length
    points = walk(a, b, _EVERY)
    free = np.mean(
        [
            picture.at(mapped([(x + off * nx, y + off * ny) for x, y in points], frame)) == FREE
            for off in (-0.4, -0.2, 0.0, 0.2, 0.4)
        ],
        axis=0,
    )
    pieces = []
    for first, last in _runs((free > 0.7) & (_share(free > 0.7, 5) > 0.7), gap=10):
        if (last - first + 1) * _EVERY >= 2.0:
            p = a if first == 0 else points[first]
            q = b if last == len(points) - 1 else points[last]
            pieces.append((frame(p), frame(q)))
    return pieces


def _seen_node(node: Node, picture: Picture, frame: Frame) -> bool:
    """Is the crossing's floor known, and the beginning of every arm, so that its type can be told?"""
    half = 0.35 * node.width
    ring = [(node.at[0] + half * i / 4, node.at[1] + half * j / 4) for i in range(-4, 5) for j in range(-4, 5)]
    if node.kind != "end" and np.mean(picture.at(mapped(ring, frame)) == FREE) < 0.8:
        return False
    for ux, uy in node.arms:
        # A metre and a half beyond the crossing, over a metre's width.
        start = 0.5 if node.kind == "end" else node.width / 2
        floor = [
            (node.at[0] + t * ux - v * uy, node.at[1] + t * uy + v * ux)
            for t in np.arange(start, start + 1.6, 0.1).tolist()
            for v in (-0.5, -0.25, 0.0, 0.25, 0.5)
        ]
        if np.mean(picture.at(mapped(floor, frame)) == FREE) < 0.75:
            return False
    return True
