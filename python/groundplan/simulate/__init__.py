"""Maps of places that never were, with exact truth: a ground plan is laid out, driven through and scanned.

    options (_options) -> halls (_hall, _uneven, _staggered, _halls) -> plan (_warehouse, _goods) -> network (_plan)
    options (_options) -> corridors and strips (_strips) -> plan (_office, _furniture) -> network (_plan)
    plan -> raster (_raster) -> drive (_drive, _drift) -> scans and map (_lidar)
    plan -> another time (_remake)
    plan, network and map -> truth (_truth, _rooms, _patterns)

All is seeded: the same options and seed give the same bytes.
"""

from __future__ import annotations

import dataclasses
import difflib
import io
import json
import math
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from groundplan._errors import ParameterError
from groundplan._files import write_bytes, write_text
from groundplan.maps import _map
from groundplan.simulate._drift import Drift
from groundplan.simulate._drive import explored, route, scan_poses
from groundplan.simulate._lidar import UNKNOWN, cast, grid_map
from groundplan.simulate._office import office_plan
from groundplan.simulate._options import OfficeOptions, WarehouseOptions
from groundplan.simulate._patterns import patterns
from groundplan.simulate._plan import GroundPlan, Point, network
from groundplan.simulate._raster import rasterise
from groundplan.simulate._remake import rearrange
from groundplan.simulate._rooms import halls, rooms
from groundplan.simulate._truth import Picture, truth
from groundplan.simulate._warehouse import warehouse_plan

__all__ = ["OfficeOptions", "Simulated", "WarehouseOptions", "office", "warehouse"]

Options = TypeVar("Options", WarehouseOptions, OfficeOptions)

_PAD = 20  # unknown pixels left round what was seen


@dataclass(frozen=True)
class Simulated:
    """A simulated map and what a survey of it should find.

    Attributes
    ----------
    map : Map
        As map_server would read it: 0 occupied, 205 unknown, 254 free.
    truth : dict
        ``directions``, ``lines``, ``corridors``, ``junctions`` as `groundplan evaluate` wants them, in the map
        frame; besides ``ends`` (dead ends), ``racks`` {a, b, width, pitch, observed}, ``pillars`` {at, width,
        observed}, ``frame`` (the ground plan's pose in the map: m, m, rad), ``options`` and ``seed``; of an office also
        ``rooms`` {polygon, holes, use, observed} and ``doors`` {at, width, a, b, state, observed}, where a and b are
        numbers of rooms.
    rooms : (height, width) uint8, or None
        Of an office, its rooms: more than 250 in a room, dark between rooms, as Bormann et al. (2016) draw theirs.
    """

    map: _map.Map
    truth: dict[str, Any]
    rooms: npt.NDArray[np.uint8] | None = None

    def write(self, directory: str | os.PathLike[str], name: str = "warehouse") -> Path:
        """Write ``<name>.pgm``, ``<name>.yaml``, ``truth.json`` and of an office ``<name>.gt.png``, each whole or not.

        Returns
        -------
        Path
            Of the YAML file.

        Raises
        ------
        FormatError
            ``file.write`` when the directory cannot be written.
        """
        place = Path(directory)
        pixels = np.ascontiguousarray(self.map.pixels)
        write_bytes(place / f"{name}.pgm", b"P5\n%d %d\n255\n" % (pixels.shape[1], pixels.shape[0]) + pixels.tobytes())
        x, y, yaw = self.map.origin
        lines = [
            f"image: {name}.pgm",
            "mode: trinary",
            f"resolution: {self.map.resolution!r}",
            f"origin: [{x!r}, {y!r}, {yaw!r}]",
            "negate: 0",
            "occupied_thresh: 0.65",
            "free_thresh: 0.196",
        ]
        if self.rooms is not None:
            write_bytes(place / f"{name}.gt.png", _png(self.rooms))
        write_text(place / "truth.json", json.dumps(self.truth, indent=1) + "\n")
        write_text(place / f"{name}.yaml", "\n".join(lines) + "\n")
        return place / f"{name}.yaml"


def warehouse(options: WarehouseOptions | None = None, seed: int = 0, **changes: Any) -> Simulated:
    """Lay out a warehouse, drive a robot through it and give the map that it makes.

    Parameters
    ----------
    options
        What it is like; by default a hall of 42 m by 28 m.
    seed
        Zero or more. The same options and seed give the same bytes.
    **changes
        Single options by name, over `options`.

    Raises
    ------
    ParameterError
        An option that is not known, out of its range, or that leaves no room.
    """
    made = _options(options or WarehouseOptions(), seed, changes)
    return _simulated(warehouse_plan(made, _stream(seed, 0)), made, seed, made.partial)


def office(options: OfficeOptions | None = None, seed: int = 0, **changes: Any) -> Simulated:
    """Lay out an office, drive a robot through it and give the map that it makes.

    Parameters
    ----------
    options
        What it is like; by default one corridor with rooms on both sides.
    seed
        Zero or more. The same options and seed give the same bytes.
    **changes
        Single options by name, over `options`.

    Raises
    ------
    ParameterError
        An option that is not known, out of its range, or that leaves no room.
    """
    made = _options(options or OfficeOptions(), seed, changes)
    return _simulated(office_plan(made, _stream(seed, 0)), made, seed)


def _options(options: Options, seed: int, changes: dict[str, Any]) -> Options:
    """The options with single ones changed, once all is known to be right."""
    names = [item.name for item in dataclasses.fields(options)]
    for name in changes:
        if name not in names:
            near = difflib.get_close_matches(name, names, 1)
            raise ParameterError(
                "simulate.unknown", f"no option {name!r}", f"did you mean {near[0]}?" if near else None
            )
    if seed < 0:
        raise ParameterError("simulate.seed", f"seed is {seed}, not zero or more")
    return dataclasses.replace(options, **changes)


def _stream(seed: int, part: int, remake: int = 0) -> np.random.Generator:
    """One stream for each part, so that more noise does not move the racks; another one for each remake."""
    return np.random.Generator(np.random.PCG64([seed, part, remake] if remake else [seed, part]))


def _simulated(
    plan: GroundPlan, options: WarehouseOptions | OfficeOptions, seed: int, partial: float = 0.0
) -> Simulated:
    """Drive through a plan, scan it, and tell the truth about it."""
    exploration = _stream(seed, 1)
    wander, sensing, bending = (_stream(seed, part, options.remake) for part in (2, 3, 4))
    if options.remake:
        rearrange(plan, options.moved, _stream(seed, 5, options.remake))
    net = network([*plan.corridors, *plan.ways])
    world = rasterise(plan)
    roads, looks = explored(net, partial, exploration)
    points = route(net, roads, looks)
    poses = scan_poses(points, options.scan_every, world, exploration)
    ranges = cast(world, [p for p, _ in poses], options.beams, options.lidar_range, options.noise, sensing)

    drift = Drift(options.drift, plan.outline, wander, options.bend, bending)
    yaw = math.radians(options.yaw)
    c, s = math.cos(yaw), math.sin(yaw)
    start = points[0]

    def turned(p: Point) -> Point:
        """From the plan to the map frame, whose origin is where the robot set out."""
        x, y = p[0] - start[0], p[1] - start[1]
        return c * x - s * y, s * x + c * y

    believed = []
    for pose in drift.believed(poses, wander):
        x, y = turned((pose.x, pose.y))
        believed.append(dataclasses.replace(pose, x=x, y=y, heading=pose.heading + yaw))
    corners = np.array([turned(p) for p in plan.outline])
    low, high = corners.min(axis=0) - 2.0, corners.max(axis=0) + 2.0
    shape = (math.ceil((high[1] - low[1]) / options.resolution), math.ceil((high[0] - low[0]) / options.resolution))
    corner = (round(float(low[0]), 3), round(float(low[1]), 3))
    pixels = grid_map(believed, ranges, options.lidar_range, corner, shape, options.resolution)
    pixels, corner = _cropped(pixels, corner, options.resolution)
    picture = Picture(pixels[::-1], corner, options.resolution)
    facts = truth(plan, network(plan.corridors), picture, lambda p: turned(drift.bend(p)), yaw)
    facts |= patterns(plan, picture, lambda p: turned(drift.bend(p)))
    if plan.halls:
        facts |= halls(plan, picture, lambda p: turned(drift.bend(p)))
    facts["frame"] = [*(round(value, 6) for value in turned((0.0, 0.0))), round(yaw, 9)]
    shown = None
    if plan.rooms:
        facts_of_rooms, shown = rooms(plan, picture, lambda p: turned(drift.bend(p)))
        facts |= facts_of_rooms
    facts["options"] = {k: list(v) if isinstance(v, tuple) else v for k, v in dataclasses.asdict(options).items()}
    facts["seed"] = seed
    return Simulated(_trinary(pixels, options.resolution, corner), facts, shown)


def _cropped(pixels: npt.NDArray[np.uint8], corner: Point, resolution: float) -> tuple[npt.NDArray[np.uint8], Point]:
    """What was seen, with a rim of unknown round it, and the lower left corner of that."""
    rows, columns = np.flatnonzero((pixels != UNKNOWN).any(axis=1)), np.flatnonzero((pixels != UNKNOWN).any(axis=0))
    top, bottom = max(int(rows[0]) - _PAD, 0), min(int(rows[-1]) + 1 + _PAD, pixels.shape[0])
    left, right = max(int(columns[0]) - _PAD, 0), min(int(columns[-1]) + 1 + _PAD, pixels.shape[1])
    x = round(corner[0] + left * resolution, 6)
    y = round(corner[1] + (pixels.shape[0] - bottom) * resolution, 6)
    return np.ascontiguousarray(pixels[top:bottom, left:right]), (x, y)


def _trinary(pixels: npt.NDArray[np.uint8], resolution: float, corner: Point) -> _map.Map:
    """The Map that map_server makes of these pixels."""
    share = (255 - np.arange(256)) / 255
    states = np.full(256, _map.UNKNOWN, dtype=np.uint8)
    states[share > 0.65] = _map.OCCUPIED
    states[share < 0.196] = _map.FREE
    values = np.full(256, -1, dtype=np.int8)
    values[states == _map.OCCUPIED], values[states == _map.FREE] = 100, 0
    return _map.Map(pixels, values, states, resolution, (corner[0], corner[1], 0.0), "warehouse.pgm")


def _png(pixels: npt.NDArray[np.uint8]) -> bytes:
    from PIL import Image

    stream = io.BytesIO()
    Image.fromarray(pixels).save(stream, "PNG")
    return stream.getvalue()
