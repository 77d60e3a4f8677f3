"""What a map shows of a site of `_other_plan`, and the truth of it: drawn, or scanned from along its aisles."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt
from _other_hard import Hard
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
TYPES = {2: "L", 3: "T", 4: "X"}


@dataclass(frozen=True)
class Site:
    """A map and its truth, in the format that `groundplan.evaluate.score` takes."""

    measures: Measures | Hard
    map: Map
    truth: dict[str, Any]


@dataclass(frozen=True)
class Frame:
    """The plan's place in the map: bent by waves along x and y, then turned; (height, width) pixels, row 0 lowest."""

    yaw: float
    resolution: float
    bend: float = 0.0  # metres that a wave is high
    waves: tuple[Point, Point] = ((0.0, 0.0), (0.0, 0.0))  # for each of x and y a wave number and a phase
    low: Point = (0.0, 0.0)
    shape: tuple[int, int] = (0, 0)

    def around(self, corners: Iterable[Point], border: float) -> Frame:
        """With a grid that has these points of the plan and so many metres beyond them."""
        points = np.array([self.point(p) for p in corners])
        low, high = points.min(axis=0) - border, points.max(axis=0) + border
        columns, rows = np.ceil((high - low) / self.resolution).astype(int).tolist()
        return replace(self, low=(float(low[0]), float(low[1])), shape=(rows, columns))

    def to_map(self, x: Floats, y: Floats) -> tuple[Floats, Floats]:
        (kx, px), (ky, py) = self.waves
        x, y = x + self.bend * np.sin(ky * y + py), y + self.bend * np.sin(kx * x + px)
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        return x * cos - y * sin, x * sin + y * cos

    def point(self, p: Point) -> Point:
        x, y = self.to_map(np.array(p[0]), np.array(p[1]))
        return float(x), float(y)

    def pixels(self, x: Floats, y: Floats) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], Flags]:
        """Rows and columns of points of the plan, and which of them the grid has."""
        x, y = self.to_map(x, y)
        column = np.floor((x - self.low[0]) / self.resolution).astype(np.int64)
        row = np.floor((y - self.low[1]) / self.resolution).astype(np.int64)
        return row, column, (column >= 0) & (row >= 0) & (column < self.shape[1]) & (row < self.shape[0])

    def where(self, flags: Flags) -> Callable[[Floats, Floats], Flags]:
        """Whether points of the plan lie on pixels that have a flag; none outside the map has."""

        def is_so(x: Floats, y: Floats) -> Flags:
            row, column, inside = self.pixels(x, y)
            return np.array(inside & flags[row * inside, column * inside])

        return is_so


def site(seed: int, is_wide: bool = False) -> Site:
    """The site of a seed, its map and its truth; its measures from the usual or the wide ranges."""
    draw, goods = random.Random(seed), np.random.default_rng(seed)
    measured = wide(draw) if is_wide else measures(draw)
    laid_out = plan(measured, draw, goods)
    corners = [(x, y) for x in (-_PAD, laid_out.width + _PAD) for y in (-_PAD, laid_out.depth + _PAD)]
    frame = Frame(measured.yaw, measured.resolution).around(corners, _BORDER)
    if measured.look == "drawn":
        greys = _drawn(measured, laid_out, frame)
    else:
        greys = valued(measured.look, *_scanned(measured, laid_out, frame, goods))
    made = groundplan.from_array(np.ascontiguousarray(greys[::-1]), measured.resolution, frame.low)
    return Site(measured, made, _truth(laid_out, frame, made.states[greys] == FREE))


def _drawn(measured: Measures, laid_out: Plan, frame: Frame) -> npt.NDArray[np.uint8]:
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


def _scanned(measured: Measures, laid_out: Plan, frame: Frame, noise: np.random.Generator) -> tuple[Floats, Floats]:
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
    beams = Beams(frame, measured.range)
    for px, py in poses:
        if world[int((py + _PAD) / step), int((px + _PAD) / step)]:
            continue
        angles = turn + noise.uniform(0, 0.01)
        cos, sin = np.cos(angles), np.sin(angles)
        ranges = cast(world, (px + _PAD, py + _PAD), (cos, sin), step, measured.range)
        is_hit = np.isfinite(ranges)
        ranges = np.where(is_hit, ranges, measured.range) + is_hit * noise.normal(0, measured.noise, BEAMS)
        beams.put_down((px, py), (cos, sin), ranges, is_hit)
    return beams.hits, beams.passes


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


class Beams:
    """How often each pixel was hit and passed by beams that reach so far, metres."""

    def __init__(self, frame: Frame, reach: float) -> None:
        self.frame = frame
        self.hits, self.passes = np.zeros(frame.shape), np.zeros(frame.shape)
        self._looks = np.arange(0.1, reach, frame.resolution * 0.7)

    def put_down(self, at: Point, towards: tuple[Floats, Floats], ranges: Floats, is_hit: Flags) -> None:
        """Add the beams of one place of the plan: where each goes, how far, and whether something is there."""
        cos, sin = towards
        row, column, known = self.frame.pixels(at[0] + ranges * cos, at[1] + ranges * sin)
        known &= is_hit
        np.add.at(self.hits, (row[known], column[known]), 1)
        beam, look = np.nonzero(self._looks < (ranges - self.frame.resolution)[:, None])
        far = self._looks[look]
        row, column, known = self.frame.pixels(at[0] + far * cos[beam], at[1] + far * sin[beam])
        # One beam passes a pixel once.
        known[1:] &= (np.diff(row) != 0) | (np.diff(column) != 0) | (np.diff(beam) != 0)
        flat = row[known] * self.frame.shape[1] + column[known]
        self.passes += np.bincount(flat, minlength=self.passes.size).reshape(self.passes.shape)


def valued(look: str, hits: Floats, passes: Floats) -> npt.NDArray[np.uint8]:
    """Three values by the share of beams that were hits, or the greys of log-odds that are held."""
    seen = hits + passes > 0
    if look == "trinary":
        greys = np.where(seen, 254, 205)
        greys[(hits > 0) & (hits >= 0.2 * (hits + passes))] = 0
        return greys.astype(np.uint8)
    odds = np.clip(hits * 0.85 - passes * 0.4, -3.5, 3.5)
    return np.where(seen, np.round(255 / (1 + np.exp(odds))), 127).astype(np.uint8)


def _truth(laid_out: Plan, frame: Frame, free: Flags) -> dict[str, Any]:
    """What a survey should find: of walls and racks what floor was seen before, of the crossings those seen whole."""
    is_free = frame.where(free)
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
                "type": TYPES[len(crossing.arms)],
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
