"""What a lidar's map shows of a site of `_other_hard`, bent by the drift that is left, and the truth of it."""

from __future__ import annotations

import itertools
import math
import random
from collections.abc import Callable
from typing import Any

import numpy as np
from _other_hard import Hard, hard, layout
from _other_joined import Layout, Meeting
from _other_map import BEAMS, TYPES, Beams, Flags, Floats, Frame, Site, cast, seen_parts, valued
from _other_plan import Point

import groundplan
from groundplan.maps import FREE

_PAD = 1.0  # metres of world and of map around the site
_EVERY = 0.8  # metres between two scans
_SWAY = 0.15  # metres off a way's middle
_BENT = 0.1  # metres that a straight piece of a bent line leaves it by
_LEAST = 4.0  # metres of a direction's lines that must be seen
_FLOOR, _OUT = 0.8, 1.5  # share of a crossing's floor, and of that so many metres out of it, that must be known


def hard_site(seed: int) -> Site:
    """The site of a seed, its map and its truth."""
    draw, goods = random.Random(seed + 77_000_000), np.random.default_rng(seed + 77_000_000)
    measured = hard(seed, draw)
    made = layout(measured, draw, goods)
    corners = np.array([p for wall in made.walls for p in wall])
    low, high = corners.min(axis=0) - _PAD, corners.max(axis=0) + _PAD
    step = min(0.025, measured.common.resolution / 2)
    world = _world(made, low, high, step)
    frame = _frame(measured, low, high, draw)
    values = valued(measured.common.look, *_scanned(measured, made, (world, low, step), frame, goods))
    mapped = groundplan.from_array(np.ascontiguousarray(values[::-1]), measured.common.resolution, frame.low)
    return Site(measured, mapped, _truth(made, frame, mapped.states[values] == FREE))


def _frame(measured: Hard, low: Floats, high: Floats, draw: random.Random) -> Frame:
    """Waves of one to two of the site's lengths, and the box of it all."""
    waves = [(2 * math.pi / draw.uniform(40, 80), draw.uniform(0, 2 * math.pi)) for _ in range(2)]
    frame = Frame(measured.common.yaw, measured.common.resolution, measured.bend, (waves[0], waves[1]))
    return frame.around([(x, y) for x in (low[0], high[0]) for y in (low[1], high[1])], measured.bend)


def _world(made: Layout, low: Floats, high: Floats, step: float) -> Flags:
    """What stands, from the site's lowest corner: the walls without what is floor, and all that is in the halls."""
    columns, rows = np.ceil((high - low) / step).astype(int).tolist()
    world = np.zeros((rows, columns), dtype=bool)
    for shapes, value in ((made.walls, True), (made.floors, False), (made.stands, True)):
        for corners in shapes:
            _fill(world, (np.array(corners) - low) / step, value)
    return world


def _fill(raster: Flags, corners: Floats, value: bool) -> None:
    """Set the places whose middle lies in a convex shape; its corners are (x, y) in places, in order."""
    (ax, ay), (bx, by), (cx, cy) = corners[:3]
    if (bx - ax) * (cy - ay) < (by - ay) * (cx - ax):
        corners = corners[::-1]
    (left, bottom), (right, top) = np.floor(corners.min(axis=0)).astype(int), np.ceil(corners.max(axis=0)).astype(int)
    left, bottom = max(left, 0), max(bottom, 0)
    window = raster[bottom : top + 1, left : right + 1]
    y, x = np.ogrid[0 : window.shape[0], 0 : window.shape[1]]
    inside = np.ones(window.shape, dtype=bool)
    for (ax, ay), (bx, by) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        inside &= (bx - ax) * (y + bottom + 0.5 - ay) - (by - ay) * (x + left + 0.5 - ax) >= 0
    window[inside] = value


def _poses(measured: Hard, made: Layout, noise: np.random.Generator) -> Floats:
    """Where the lidar stood: along the ways, but for those farthest one way where the site is partly seen."""
    poses = []
    for a, b, _ in made.corridors:
        length = math.dist(a, b)
        along = np.arange(0.5, length, _EVERY)
        ux, uy = (b[0] - a[0]) / length, (b[1] - a[1]) / length
        aside = _SWAY * np.sin(along / 1.7 + noise.uniform(0, 6))
        poses.append(np.column_stack([a[0] + along * ux - aside * uy, a[1] + along * uy + aside * ux]))
    all_poses = np.concatenate(poses)
    if not measured.unseen:
        return all_poses
    angle = noise.uniform(0, 2 * math.pi)
    far = all_poses @ np.array([math.cos(angle), math.sin(angle)])
    kept: Floats = all_poses[far <= np.quantile(far, 1 - measured.unseen)]
    return kept


def _scanned(
    measured: Hard, made: Layout, world: tuple[Flags, Floats, float], frame: Frame, noise: np.random.Generator
) -> tuple[Floats, Floats]:
    """How often each pixel was hit and passed by the beams."""
    taken, low, step = world
    common = measured.common
    turn = np.linspace(0, 2 * math.pi, BEAMS, endpoint=False)
    beams = Beams(frame, common.range)
    for px, py in _poses(measured, made, noise):
        if taken[int((py - low[1]) / step), int((px - low[0]) / step)]:
            continue
        # The pose is off by a little: what is hit and passed is put down from another place.
        off, askew = noise.normal(0, 0.008, 2), noise.normal(0, 0.0007)
        angles = turn + noise.uniform(0, 0.01)
        ranges = cast(taken, (px - low[0], py - low[1]), (np.cos(angles), np.sin(angles)), step, common.range)
        cos, sin = np.cos(angles + askew), np.sin(angles + askew)
        is_hit = np.isfinite(ranges)
        ranges = np.where(is_hit, ranges, common.range) + is_hit * noise.normal(0, common.noise, BEAMS)
        beams.put_down((px + off[0], py + off[1]), (cos, sin), ranges, is_hit)
    return beams.hits, beams.passes


def _truth(made: Layout, frame: Frame, free: Flags) -> dict[str, Any]:
    """What a survey should find: of lines and corridors what was seen, of the crossings those seen whole."""
    is_free = frame.where(free)
    pieces = [(face.kind, part) for face in made.faces for part in seen_parts(face, is_free)]
    return {
        "directions": _directions([part for _, part in pieces], frame),
        "lines": [
            {"kind": kind, "p": frame.point(p), "q": frame.point(q)}
            for kind, part in pieces
            for p, q in _straight(part, frame)
        ],
        "corridors": [
            {"a": frame.point(p), "b": frame.point(q), "width": width}
            for a, b, width in made.corridors
            for part in _seen_ways(a, b, is_free)
            for p, q in _straight(part, frame)
        ],
        "junctions": [
            {
                "at": frame.point(meeting.at),
                "type": TYPES[len(meeting.arms)],
                "arms": len(meeting.arms),
                "observed": _is_seen(meeting, is_free),
            }
            for meeting in made.meetings
        ],
    }


def _directions(parts: list[tuple[Point, Point]], frame: Frame) -> list[float]:
    """The angles of the lines that were seen, each turned as the drift turns its lines in the mean (least squares)."""
    families: dict[float, list[tuple[Point, Point]]] = {}
    for p, q in parts:
        angle = math.atan2(q[1] - p[1], q[0] - p[0]) % math.pi
        key = next((other for other in families if abs(math.sin(other - angle)) < 1e-4), angle)
        families.setdefault(key, []).append((p, q))
    found = []
    for angle, lines in families.items():
        if sum(math.dist(p, q) for p, q in lines) < _LEAST:
            continue
        nominal = angle + frame.yaw
        cos, sin = math.cos(nominal), math.sin(nominal)
        above = below = 0.0
        rows: dict[int, list[Floats]] = {}  # pieces of one line are one
        for p, q in lines:
            shares = np.linspace(0, 1, max(2, round(math.dist(p, q) / 0.2)))[:, None]
            offset = (p[1] + q[1]) / 2 * math.cos(angle) - (p[0] + q[0]) / 2 * math.sin(angle)
            rows.setdefault(round(offset / 0.05), []).append(np.array(p) + shares * (np.array(q) - p))
        for row in rows.values():
            x, y = frame.to_map(*np.concatenate(row).T)
            along, across = x * cos + y * sin, -x * sin + y * cos
            above += float(((along - along.mean()) * (across - across.mean())).sum())
            below += float(((along - along.mean()) ** 2).sum())
        found.append((nominal + above / below + math.pi / 2) % math.pi - math.pi / 2)
    return found


def _straight(part: tuple[Point, Point], frame: Frame) -> list[tuple[Point, Point]]:
    """A line in as few equal parts as the drift leaves straight."""
    (ax, ay), (bx, by) = part
    for count in range(1, 20):
        stops = np.linspace(0, 1, count + 1)
        pieces = [tuple((ax + s * (bx - ax), ay + s * (by - ay)) for s in pair) for pair in itertools.pairwise(stops)]
        if max(_off(p, q, frame) for p, q in pieces) < _BENT:
            break
    return [(p, q) for p, q in pieces]


def _off(p: Point, q: Point, frame: Frame) -> float:
    """How far a line between two points leaves the straight one between where they are shown."""
    shares = np.linspace(0, 1, 21)
    x, y = frame.to_map(p[0] + shares * (q[0] - p[0]), p[1] + shares * (q[1] - p[1]))
    dx, dy = x[-1] - x[0], y[-1] - y[0]
    return float(np.abs(dx * (y - y[0]) - dy * (x - x[0])).max() / math.hypot(dx, dy))


def _seen_ways(a: Point, b: Point, is_free: Callable[[Floats, Floats], Flags]) -> list[tuple[Point, Point]]:
    """The parts of a way's middle along which floor was seen, two metres at least, over gaps of one."""
    length = math.dist(a, b)
    count = max(2, round(length / 0.1) + 1)
    shares = np.linspace(0, 1, count)
    ux, uy = (b[0] - a[0]) / length, (b[1] - a[1]) / length
    known = np.mean(
        [
            is_free(a[0] + shares * length * ux - s * uy, a[1] + shares * length * uy + s * ux)
            for s in (-0.4, -0.2, 0, 0.2, 0.4)
        ],
        axis=0,
    )
    seen = np.flatnonzero(known > 0.5)
    parts = np.split(seen, np.flatnonzero(np.diff(seen) > 10) + 1)
    ends = [(shares[part[0]], shares[part[-1]]) for part in parts if len(part) >= 20]
    return [
        ((a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])), (a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])))
        for s, t in ends
    ]


def _is_seen(meeting: Meeting, is_free: Callable[[Floats, Floats], Flags]) -> bool:
    """True when a crossing's floor and the first metres of its ways out are known, so that its type can be told."""
    (x, y), (u, v) = meeting.at, meeting.sides
    s, t = np.meshgrid(np.linspace(-0.35, 0.35, 9), np.linspace(-0.35, 0.35, 9))
    floors = [(x + s * u[0] + t * v[0], y + s * u[1] + t * v[1])]
    out, side = np.meshgrid(np.linspace(0, _OUT, 16), np.linspace(-0.5, 0.5, 5))
    for (ux, uy), start in meeting.arms:
        floors.append((x + (start + out) * ux - side * uy, y + (start + out) * uy + side * ux))
    return all(float(is_free(*floor).mean()) >= _FLOOR for floor in floors)
