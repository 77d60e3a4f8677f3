"""Grids as map_server takes them: PGM and YAML, yaw 0, written row band by row band."""

from __future__ import annotations

import contextlib
import json
import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from groundplan._files import whole
from groundplan._results import MapInfo

Bytes = npt.NDArray[np.uint8]

#: What map_saver writes; the thresholds are those with which its grey for unknown is unknown.
OCCUPIED, UNKNOWN, FREE = 0, 205, 254
BAND_ROWS = 512
#: Of a pixel: what is so near the lattice lies on it.
NEAR = 1e-6


@dataclass(frozen=True)
class Frame:
    """A grid without yaw: size in pixels, metres per pixel, lower left corner in metres."""

    width: int
    height: int
    resolution: float
    origin: tuple[float, float]

    def rings(self, shape: object) -> list[npt.NDArray[np.float64]]:
        """A shapely polygon's rings as (column, row) in pixels, the top row first."""
        rings = [shape.exterior, *shape.interiors]  # type: ignore[attr-defined]
        top = self.origin[1] + self.height * self.resolution
        placed = (np.asarray(ring.coords)[:-1, :2] - (self.origin[0], top) for ring in rings)
        return [points * (1.0, -1.0) / self.resolution for points in placed]


def covering(info: MapInfo) -> Frame:
    """The map's own frame where it has no yaw, else one along x and y that holds the map, on the pixel lattice."""
    x, y, yaw = info.origin
    if yaw == 0.0:
        return Frame(info.width, info.height, info.resolution, (x, y))
    return turned(info.width, info.height, info.resolution, (x, y), yaw)


def turned(width: int, height: int, resolution: float, at: tuple[float, float], angle: float) -> Frame:
    """The least frame on the pixel lattice that holds a grid whose lower left corner lies turned at a place."""
    cos, sin = math.cos(angle), math.sin(angle)
    u, v = np.array([0.0, width, width, 0.0]), np.array([0.0, 0.0, height, height])
    columns, rows = at[0] / resolution + u * cos - v * sin, at[1] / resolution + u * sin + v * cos
    left, bottom = math.floor(columns.min() + NEAR), math.floor(rows.min() + NEAR)
    right, top = math.ceil(columns.max() - NEAR), math.ceil(rows.max() - NEAR)
    corner = round(left * resolution, 9), round(bottom * resolution, 9)
    return Frame(max(right - left, 1), max(top - bottom, 1), resolution, corner)


def names(path: Path) -> tuple[Path, Path]:
    """The YAML and the PGM that a path stands for."""
    yaml = path.with_suffix(".yaml") if path.suffix.lower() == ".pgm" else path
    return yaml, yaml.with_suffix(".pgm")


def write(
    path: Path, frame: Frame, bands: Iterable[Bytes], mode: str = "trinary", beside: dict[Path, str] | None = None
) -> list[Path]:
    """Write a grid, its rows from the top, and texts that go with it: all or nothing.

    `mode`: ``trinary`` for the greys above, ``raw`` where a byte is the value itself.
    """
    yaml, pgm = names(path)
    texts = {yaml: _yaml(frame, pgm.name, mode), **(beside or {})}
    with contextlib.ExitStack() as stack:
        opened = {file: stack.enter_context(whole(file)) for file in (pgm, *texts)}
        with opened[pgm].open("wb") as file:
            file.write(b"P5\n%d %d\n255\n" % (frame.width, frame.height))
            for band in bands:
                file.write(np.ascontiguousarray(band).tobytes())
        for name, text in texts.items():
            opened[name].write_text(text, encoding="utf-8")
    return [yaml, pgm, *(beside or {})]


def quoted(text: str) -> str:
    """A text as JSON, which YAML reads whatever is in it."""
    return json.dumps(text, ensure_ascii=False)


def _yaml(frame: Frame, image: str, mode: str) -> str:
    """Numbers in full, since map_saver's three decimals have cost people metres."""
    x, y = frame.origin
    return (
        f"image: {quoted(image)}\n"
        f"mode: {mode}\n"
        f"resolution: {frame.resolution:.12g}\n"
        f"origin: [{x:.9f}, {y:.9f}, 0.0]\n"
        "negate: 0\n"
        "occupied_thresh: 0.65\n"
        "free_thresh: 0.196\n"
    )
