"""What a map shows of a site of `_other_plan`, and the truth of it: drawn, or scanned from along its aisles."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from _other_plan import Box, Crossing, Face, Measures, Plan, Point, measures, plan, wide

import groundplan
from groundplan.maps import FREE, Map

Floats = npt.NDArray[np.float64]
Flags = npt.NDArray[np.bool_]

_PAD = 1.0  # metres of world around the hall ...
_BORDER = 0.5  # ... and of map around that
BEAMS = 900
_AT_ONCE = 64  # steps of a beam that are looked at together
_EVERY = 0.1  # metres between two looks along a face
_BEFORE = 0.3  # metres before it where floor must be seen ...
_GAP, _PART = 3.8, 2.0  # ... but for gaps of so much, over so much, metres
_SEEN, _OUT = 0.75, 1.5  # share of a crossing's floor, and of that so many metres out of it, that must be known
_TYPES = {2: "L", 3: "T", 4: "X"}


@dataclass(frozen=True)
class Site:
    """A map and its truth, in the format that `groundplan.evaluate.score` takes."""

    measures: Measures
    map: Map
    truth: dict[str, Any]


@dataclass(frozen=True)
class _Frame:
    """The plan's place in the map, and the map's grid: (height, width) pixels, row 0 lowest."""

    yaw: float
    low: Point
    shape: tuple[int, int]
    resolution: float

    def to_map(self, x: Floats, y: Floats) -> tuple[Floats, Floats]:
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        return x * cos - y * sin, x * sin + y * cos

    def point(self, p: Point) -> Point:
        x, y = self.to_map(np.array(p[0]), np.array(p[1]))
        return float(x), float(y)

    def pixels(self, x: Floats, y: Floats) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], Flags]:
        """Rows and columns of points of the plan, and which of them the grid has."""
        x, y = self.to_map(x, y)
        column = ((x - self.low[0]) / self.resolution).astype(np.int64)
        row = ((y - self.low[1]) / self.resolution).astype(np.int64)
        return row, column, (column >= 0) & (row >= 0) & (column < self.shape[1]) & (row < self.shape[0])


def site(seed: int, is_wide: bool = False) -> Site:
    """The site of a seed, its map and its truth; its measures from the usual or the wide ranges."""
    draw, goods = random.Random(seed), np.random.default_rng(seed)
    measured = wide(draw) if is_wide else measures(draw)
    laid_out = plan(measured, draw, goods)
    frame = _frame(measured, laid_out)
    if measured.look == "drawn":
        greys = _drawn(measured, laid_out, frame)
    else:
        greys = valued(measured.look, *_scanned(measured, laid_out, frame, goods))
    made = groundplan.from_array(np.ascontiguousarray(greys[::-1]), measured.resolution, frame.low)
    return Site(measured, made, _truth(laid_out, frame, made.states[greys] == FREE))


def _frame(measured: Measures, laid_out: Plan) -> _Frame:
    frame = _Frame(measured.yaw, (0.0, 0.0), (0, 0), measured.resolution)
    width, depth = laid_out.width, laid_out.depth
    corners = np.array([frame.point((x, y)) for x in (-_PAD, width + _PAD) for y in (-_PAD, depth + _PAD)])
    low, high = corners.min(axis=0) - _BORDER, corners.max(axis=0) + _BORDER
    columns, rows = np.ceil((high - low) / measured.resolution).astype(int).tolist()
    return _Frame(measured.yaw, (float(low[0]), float(low[1])), (rows, columns), measured.resolution)


def _drawn(measured: Measures, laid_out: Plan, frame: _Frame) -> npt.NDArray[np.uint8]:
    """As a draughtsman has it: what a pixel's middle is in or hardly beside."""
    v, u = np.mgrid[0 : frame.shape[0], 0 : frame.shape[1]] + 0.5
    x, y = frame.low[0] + u * frame.resolution, frame.low[1] + v * frame.resolution
    cos, sin = math.cos(frame.yaw), math.sin(frame.yaw)
    x, y = x * cos + y * sin, -x * sin + y * cos
    wall, near = measured.wall, frame.resolution / 4

    def within(box: Box, by: float) -> Flags:
        inside: Flags = (x > box[0] - by) & (x < box[2] + by) & (y > box[1] - by) & (y < box[3] + by)
        return inside

    greys = np.full(frame.shape, 205, dtype=np.uint8)
    greys[within((0.0, 0.0, laid_out.width, laid_out.depth), wall)] = 254
    for box in laid_out.hidden:
        greys[within(box, 0.0)] = 205
    for box in laid_out.boxes:
        greys[within(box, near)] = 0
    return greys


def _scanned(measured: Measures, laid_out: Plan, frame: _Frame, noise: np.random.Generator) -> tuple[Floats, Floats]:
    """How often each pixel was hit and passed by the beams of a lidar that stood every metre along each aisle."""
    step = min(0.025, measured.resolution / 2)
    width, depth = laid_out.width, laid_out.depth
    world = np.zeros((int((depth + 2 * _PAD) / step) + 1, int((width + 2 * _PAD) / step) + 1), dtype=bool)
    for box in laid_out.boxes:
        left, low, right, high = (round((place + _PAD) / step) for place in box)
        world[max(0, low) : max(high, low + 1), max(0, left) : max(right, left + 1)] = True
    poses = [(float(x), y) for y in laid_out.aisles for x in np.arange(0.6, width - 0.5, 1.0)]
    poses += [(x, float(y)) for x in laid_out.crosses for y in np.arange(0.6, depth - 0.5, 1.0)]
    turn = np.linspace(0, 2 * math.pi, BEAMS, endpoint=False)
    looks = np.arange(0.1, measured.range, measured.resolution * 0.7)
    hits, passes = np.zeros(frame.shape), np.zeros(frame.shape)
    for px, py in poses:
        if world[int((py + _PAD) / step), int((px + _PAD) / step)]:
            continue
        angles = turn + noise.uniform(0, 0.01)
        cos, sin = np.cos(angles), np.sin(angles)
        ranges = cast(world, (px + _PAD, py + _PAD), (cos, sin), step, measured.range)
        is_hit = np.isfinite(ranges)
        ranges = np.where(is_hit, ranges, measured.range) + is_hit * noise.normal(0, measured.noise, BEAMS)
        row, column, known = frame.pixels(px + ranges * cos, py + ranges * sin)
        known &= is_hit
        np.add.at(hits, (row[known], column[known]), 1)
        beam, look = np.nonzero(looks < (ranges - measured.resolution)[:, None])
        row, column, known = frame.pixels(px + looks[look] * cos[beam], py + looks[look] * sin[beam])
        # One beam passes a pixel once.
        known[1:] &= (np.diff(row) != 0) | (np.diff(column) != 0) | (np.diff(beam) != 0)
        flat = row[known] * frame.shape[1] + column[known]
        passes += np.bincount(flat, minlength=passes.size).reshape(passes.shape)
    return hits, passes


def cast(world: Flags, at: Point, beams: tuple[Floats, Floats], step: float, reach: float) -> Floats:
    """How far each beam goes from a point of the world, metres; infinite where it meets nothing."""
    steps = np.arange(0.1, reach, step)
    ranges = np.full(BEAMS, np.inf)
    going = np.arange(BEAMS)
    for part in np.split(steps, range(_AT_ONCE, len(steps), _AT_ONCE)):
        cos, sin = (each[going, None] for each in beams)
        columns = ((at[0] + part * cos) / step).astype(int).clip(0, world.shape[1] - 1)
        rows = ((at[1] + part * sin) / step).astype(int).clip(0, world.shape[0] - 1)
        met = world[rows, columns]
        struck = met.any(axis=1)
        ranges[going[struck]] = part[met[struck].argmax(axis=1)] + step / 2
        going = going[~struck]
    return ranges


def valued(look: str, hits: Floats, passes: Floats) -> npt.NDArray[np.uint8]:
    """Three values by the share of beams that were hits, or the greys of log-odds that are held."""
    seen = hits + passes > 0
    if look == "trinary":
        greys = np.where(seen, 254, 205)
        greys[(hits > 0) & (hits >= 0.2 * (hits + passes))] = 0
        return greys.astype(np.uint8)
    odds = np.clip(hits * 0.85 - passes * 0.4, -3.5, 3.5)
    return np.where(seen, np.round(255 / (1 + np.exp(odds))), 127).astype(np.uint8)


def _truth(laid_out: Plan, frame: _Frame, free: Flags) -> dict[str, Any]:
    """What a survey should find: of walls and racks what floor was seen before, of the crossings those seen whole."""

    def is_free(x: Floats, y: Floats) -> Flags:
        row, column, inside = frame.pixels(x, y)
        return np.array(inside & free[row * inside, column * inside])

    lines = [
        {"kind": face.kind, "p": frame.point(p), "q": frame.point(q)}
        for face in laid_out.faces
        for p, q in seen_parts(face, is_free)
    ]
    angle = (frame.yaw + math.pi / 2) % math.pi - math.pi / 2
    return {
        "directions": [angle, frame.yaw % math.pi - math.pi / 2],
        "lines": lines,
        "corridors": [{"a": frame.point(a), "b": frame.point(b), "width": width} for a, b, width in laid_out.corridors],
        "junctions": [
            {
                "at": frame.point(crossing.at),
                "type": _TYPES[len(crossing.arms)],
                "arms": len(crossing.arms),
                "observed": _is_seen(crossing, is_free),
            }
            for crossing in laid_out.crossings
        ],
    }


def seen_parts(face: Face, is_free: Callable[[Floats, Floats], Flags]) -> list[tuple[Point, Point]]:
    """The parts of a face before which floor was seen, with gaps as long as a bay; racks hide most of a wall."""
    length = math.dist(face.p, face.q)
    along = np.linspace(0, 1, round(length / _EVERY) + 1)
    x, y = (face.p[k] + along * (face.q[k] - face.p[k]) for k in (0, 1))
    seen = np.flatnonzero(is_free(x + _BEFORE * face.floor[0], y + _BEFORE * face.floor[1]))
    parts = np.split(seen, np.flatnonzero(np.diff(seen) * _EVERY > _GAP) + 1)
    ends = [(part[0], part[-1]) for part in parts if len(part) and (part[-1] - part[0]) * _EVERY >= _PART]
    return [((float(x[a]), float(y[a])), (float(x[b]), float(y[b]))) for a, b in ends]


def _is_seen(crossing: Crossing, is_free: Callable[[Floats, Floats], Flags]) -> bool:
    """True when the crossing's floor and the first metres of its ways out are known, so that its type can be told."""
    x, y = crossing.at
    places = np.linspace(-0.35, 0.35, 9)
    floors: list[tuple[Floats, Floats]] = [np.meshgrid(x + places * crossing.size[0], y + places * crossing.size[1])]
    out, side = np.meshgrid(np.linspace(0, _OUT, 16), np.linspace(-0.5, 0.5, 5))
    for ux, uy in crossing.arms:
        ahead = abs(ux * crossing.size[0] + uy * crossing.size[1]) / 2 + out
        floors.append((x + ahead * ux - side * uy, y + ahead * uy + side * ux))
    return all(float(is_free(*floor).mean()) >= _SEEN for floor in floors)
