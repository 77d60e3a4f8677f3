"""A 2-D lidar in a raster world, and the log-odds grid that its scans add up to."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from groundplan.simulate._raster import World

# The log-odds that a scan adds to a pixel (probabilities 0.7 and 0.4) and where they are held (0.12 and 0.97), as
# OctoMap has them; then map_saver's thresholds, 0.65 and 0.196, as log-odds.
_HIT, _PASS, _LEAST, _MOST = 0.85, -0.41, -2.0, 3.5
_OCCUPIED, _FREE = math.log(0.65 / 0.35), math.log(0.196 / 0.804)

#: Pixel values that map_saver writes.
OCCUPIED, UNKNOWN, FREE = 0, 205, 254


@dataclass(frozen=True)
class Pose:
    """Where the lidar stands: metres, metres, radians."""

    x: float
    y: float
    heading: float


def cast(
    world: World, poses: list[Pose], beams: int, reach: float, noise: float, random: np.random.Generator
) -> npt.NDArray[np.float32]:
    """Ranges of a full turn of `beams` from each pose.

    Each ray leaps as far as the distance field allows: moving by t along (c, s) changes the city-block distance by
    at most t (|c| + |s|).

    Returns
    -------
    (len(poses), beams) float32
        Metres, with Gaussian noise of deviation `noise`; infinite where nothing was met within `reach`.
    """
    ranges = np.empty((len(poses), beams), dtype=np.float32)
    for start in range(0, len(poses), 400):
        some = poses[start : start + 400]
        ranges[start : start + 400] = _leap(world, some, beams, reach)
    return ranges + random.normal(0.0, noise, ranges.shape).astype(np.float32)


def _leap(world: World, poses: list[Pose], beams: int, reach: float) -> npt.NDArray[np.float32]:
    c, s = _directions(poses, beams)
    x = np.repeat(np.array([(p.x - world.origin[0]) / world.step for p in poses]), beams)
    y = np.repeat(np.array([(p.y - world.origin[1]) / world.step for p in poses]), beams)
    field, width = world.distance.ravel(), world.distance.shape[1]
    result = np.full(len(poses) * beams, np.inf, dtype=np.float32)
    ray, limit = np.arange(result.size), reach / world.step
    t, pace = np.zeros(result.size), 1.0 / (np.abs(c) + np.abs(s))
    while ray.size:
        near = field[y.astype(np.int64) * width + x.astype(np.int64)]
        struck = near == 0
        result[ray[struck]] = t[struck] * world.step
        leap = np.maximum(near - 1, 1) * pace
        t += leap
        going = ~struck & (t < limit)
        x, y = (x + leap * c)[going], (y + leap * s)[going]
        ray, t, pace, c, s = ray[going], t[going], pace[going], c[going], s[going]
    return result.reshape(len(poses), beams)


def _directions(poses: list[Pose], beams: int) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Unit vectors of all beams. Sines come from `math`, so that they are the same wherever NumPy was built."""
    turn = [2 * math.pi * k / beams for k in range(beams)]
    bc, bs = np.array([math.cos(a) for a in turn]), np.array([math.sin(a) for a in turn])
    hc = np.array([[math.cos(p.heading)] for p in poses])
    hs = np.array([[math.sin(p.heading)] for p in poses])
    return (hc * bc - hs * bs).ravel(), (hs * bc + hc * bs).ravel()


def grid_map(
    poses: list[Pose],
    ranges: npt.NDArray[np.float32],
    reach: float,
    origin: tuple[float, float],
    shape: tuple[int, int],
    resolution: float,
) -> npt.NDArray[np.uint8]:
    """Add the scans up in a log-odds grid and threshold it.

    Within one scan a pixel is touched once, and a hit outweighs a pass, so that a face seen at a grazing angle is
    not rubbed out by the beams beside it.

    Parameters
    ----------
    poses, ranges
        The scans, where the robot believes that they were taken, in the map frame.
    reach : float
        A beam without a return clears the floor up to this far.
    origin, shape, resolution
        The grid's lower left corner, metres; (height, width), pixels; metres per pixel.

    Returns
    -------
    (height, width) uint8
        0 occupied, 205 unknown, 254 free; row 0 is the top row.
    """
    height, width = shape
    odds = np.zeros(height * width, dtype=np.float32)
    beams = ranges.shape[1]
    beam, radius = _samples(beams, reach, resolution)
    turn = [2 * math.pi * k / beams for k in range(beams)]
    bc = np.array([math.cos(a) for a in turn], dtype=np.float32)
    bs = np.array([math.sin(a) for a in turn], dtype=np.float32)
    along, across = bc[beam] * radius / resolution, bs[beam] * radius / resolution
    radius = radius + resolution  # a beam clears up to a pixel before what it hit
    for pose, scan in zip(poses, ranges, strict=True):
        c, s = np.float32(math.cos(pose.heading)), np.float32(math.sin(pose.heading))
        x0, y0 = np.float32((pose.x - origin[0]) / resolution), np.float32((pose.y - origin[1]) / resolution)
        kept = np.flatnonzero(radius < scan[beam])
        u, v = along[kept], across[kept]
        column, row = (x0 + (c * u - s * v)).astype(np.int32), (y0 + (s * u + c * v)).astype(np.int32)
        inside = (column >= 0) & (column < width) & (row >= 0) & (row < height)
        passed = (row * width + column)[inside]
        struck = scan <= reach
        u, v = bc[struck] * scan[struck] / resolution, bs[struck] * scan[struck] / resolution
        column, row = (x0 + (c * u - s * v)).astype(np.int32), (y0 + (s * u + c * v)).astype(np.int32)
        inside = (column >= 0) & (column < width) & (row >= 0) & (row < height)
        hit = (row * width + column)[inside]
        after = np.minimum(odds[hit] + np.float32(_HIT), np.float32(_MOST))
        odds[passed] = np.maximum(odds[passed] + np.float32(_PASS), np.float32(_LEAST))
        odds[hit] = after
    pixels = np.full(height * width, UNKNOWN, dtype=np.uint8)
    pixels[odds > _OCCUPIED] = OCCUPIED
    pixels[odds < _FREE] = FREE
    return np.ascontiguousarray(pixels.reshape(shape)[::-1])


def _samples(beams: int, reach: float, resolution: float) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.float32]]:
    """Where the beams are looked at: (beam, metres) pairs, about a pixel apart, so fewer beams near the lidar."""
    beam, radius = [], []
    for k in range(int(reach / resolution)):
        r = (k + 0.5) * resolution
        every = max(1, int(0.7 * resolution * beams / (2 * math.pi * r)))
        some = np.arange(0, beams, every)
        beam.append(some)
        radius.append(np.full(some.size, r, dtype=np.float32))
    return np.concatenate(beam), np.concatenate(radius)
