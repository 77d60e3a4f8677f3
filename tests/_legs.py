"""Halls with racks of which a lidar sees the legs, drawn box by box."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

Picture = npt.NDArray[np.uint8]
Box = tuple[float, float, float, float]

RESOLUTION = 0.05


def hall(width: float, height: float, boxes: Iterator[Box], degrees: float = 0.0) -> Picture:
    """A walled hall, metres, with boxes from corner to corner, turned about its middle."""
    side = int(np.hypot(width, height) / RESOLUTION) + 40
    y, x = (np.mgrid[:side, :side] + 0.5 - side / 2) * RESOLUTION
    cos, sin = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    u, v = x * cos + y * sin + width / 2, y * cos - x * sin + height / 2
    picture = np.full((side, side), 205, np.uint8)

    def fill(box: Box, value: int) -> None:
        picture[(u >= box[0]) & (u < box[2]) & (v >= box[1]) & (v < box[3])] = value

    fill((-0.15, -0.15, width + 0.15, height + 0.15), 0)
    fill((0.0, 0.0, width, height), 254)
    for box in boxes:
        fill(box, 0)
    return picture[::-1]


def put_posts(picture: Picture, low: int, x: int, faces: tuple[int, ...]) -> None:
    """Posts two pixels thick about a column, at each of a row's faces."""
    for face in faces:
        picture[low + face : low + face + 2, x - 1 : x + 1] = 0


def legs(x: float, y: float, bays: int, depth: float, pitch: float, leg: float = 0.1) -> Iterator[Box]:
    """Legs of a rack along x, its lower corner at a place."""
    for n in range(bays + 1):
        for low in (y, y + depth - leg):
            yield x + n * pitch, low, x + n * pitch + leg, low + leg


def with_a_way() -> Picture:
    """Three racks of nine bays with goods in all but the sixth of each, through which a way leads."""

    def boxes() -> Iterator[Box]:
        for n in range(3):
            yield from legs(4.0, 3.0 + 4.1 * n, 9, 1.1, 2.7)
            for bay in set(range(9)) - {5}:
                yield 4.35 + 2.7 * bay, 3.1 + 4.1 * n, 6.45 + 2.7 * bay, 4.0 + 4.1 * n

    return hall(32.3, 15.3, boxes())
