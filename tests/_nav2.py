"""A grid as Nav2's map server reads it in raw mode: written from its rules, apart from what writes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
import yaml
from PIL import Image

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Grid:
    """An OccupancyGrid: data from the bottom row on, -1 or 0 to 100."""

    data: npt.NDArray[np.int8]
    resolution: float
    origin: tuple[float, float]

    def centres(self) -> tuple[Floats, Floats]:
        """x and y of every cell's centre, metres."""
        height, width = self.data.shape
        columns, rows = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
        return self.origin[0] + columns * self.resolution, self.origin[1] + rows * self.resolution

    def at(self, points: npt.ArrayLike) -> npt.NDArray[np.int8]:
        """The values where points lie; all have to lie on the grid."""
        columns, rows = np.floor((np.asarray(points) - self.origin) / self.resolution).astype(int).reshape(-1, 2).T
        assert columns.min() >= 0 and rows.min() >= 0
        values: npt.NDArray[np.int8] = self.data[rows, columns]
        return values


def load_raw(file: Path) -> Grid:
    """Every key that Nav2 asks for, in the type that it takes; a grey is its value up to 100, and unknown beyond."""
    said = yaml.safe_load(file.read_text("utf-8"))
    assert said["mode"] == "raw" and isinstance(said["resolution"], float) and said["negate"] in (0, 1)
    x, y, yaw = said["origin"]
    assert all(isinstance(value, float) for value in (x, y, yaw)) and yaw == 0.0
    assert 0 <= said["free_thresh"] < said["occupied_thresh"] <= 1
    with Image.open(file.parent / said["image"]) as picture:
        assert picture.format == "PPM" and picture.mode == "L"
        greys = np.asarray(picture)
    data = np.where(greys <= 100, greys, 255).astype(np.uint8).view(np.int8)
    return Grid(data[::-1], said["resolution"], (x, y))


def filter_info(file: Path, name: str) -> tuple[int, float, float]:
    """Type, base and multiplier from the parameters beside a mask, which name the mask and one topic."""
    tree = yaml.safe_load(file.with_suffix(".params.yaml").read_text("utf-8"))
    server, info = (
        tree[f"{name}_{what}"]["ros__parameters"] for what in ("filter_mask_server", "costmap_filter_info_server")
    )
    assert server["yaml_filename"] == file.name and server["topic_name"] == info["mask_topic"]
    assert isinstance(info["base"], float) and isinstance(info["multiplier"], float)
    return info["type"], info["base"], info["multiplier"]


def along(axis: npt.ArrayLike, count: int) -> Floats:
    """Points between the ends of an axis, (count, 2)."""
    start, end = np.asarray(axis, dtype=np.float64)
    steps = np.linspace(0, 1, count + 2)[1:-1, None]
    points: Floats = start + steps * (end - start)
    return points
