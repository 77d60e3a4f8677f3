"""Point clouds of laser scanners: a slice between two heights, LAS and LAZ by `laspy`, E57 by `pye57`.

Nobody saw free space here: what no point hit is taken for free, and the survey says so.

Source: ASPRS LAS Specification 1.4; ASTM E2807 (E57).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from groundplan._errors import GroundplanError, MapError, shown
from groundplan._extras import needed
from groundplan.maps._map import MapWarning
from groundplan.maps._open import look
from groundplan.maps._source import Bytes, Described, Occupancies, Progress
from groundplan.maps.map_server import number

Floats = npt.NDArray[np.float64]

RESOLUTION, MIN_HITS = 0.05, 2

#: Points read at a time.
CHUNK = 1 << 20

#: Largest grid, pixels: a building of 1.6 km by 1.6 km at the usual resolution.
LARGEST = 1 << 30

#: Free pixels around the outermost points, so that no wall is the map's border.
MARGIN = 4


def read_points(
    path: Path,
    *,
    band: Sequence[float] | None,
    resolution: float | None = None,
    min_hits: int | None = None,
    progress: Progress | None = None,
) -> Described:
    """The occupied pixels of a height band, in the cloud's own frame.

    Parameters
    ----------
    path : Path
        A LAS, LAZ or E57 file.
    band : (low, high) or None
        Heights of the points that count, metres, both included; an error tells the cloud's own where it is None.
    resolution : float, optional
        Metres per pixel; 0.05 without it.
    min_hits : int, optional
        How many points make a pixel occupied; 2 without it.

    Raises
    ------
    MapError
        ``map.band``, ``map.min-hits``, ``map.corrupt``, ``map.too-large``; ``map.no-points`` where the band is empty.
    GroundplanError
        ``extra.missing``.
    """
    metres = RESOLUTION if resolution is None else resolution
    hits = MIN_HITS if min_hits is None else _hits(min_hits)
    low, high = (-math.inf, math.inf) if band is None else _band(band)
    read, told = _reader(path), progress or (lambda share: None)
    try:
        bounds = _bounds(read, low, high, lambda share: told(share / 2))
        if band is None:
            if bounds is None:
                raise MapError("map.no-points", f"{path} has no points")
            said = f"{path} is a point cloud, which needs the heights that count"
            raise MapError("map.band", said, f"--band Z0 Z1, in metres; {_heights(bounds)}")
        if bounds is None:
            said = f"{path} has no points between {low:g} m and {high:g} m"
            everywhere = _bounds(read, -math.inf, math.inf, lambda share: None)
            raise MapError("map.no-points", said, None if everywhere is None else _heights(everywhere))
        first, size = _lattice(path, bounds, metres)
        counts = _counted(read, low, high, metres, first, size, lambda share: told(0.5 + share / 2))
    except (GroundplanError, MemoryError):
        raise
    except Exception as fault:  # whatever the decoders trip over
        said = " ".join(str(fault).split()) or type(fault).__name__
        raise MapError("map.corrupt", f"{path} is a damaged point cloud: {said}") from fault
    most = int(counts.max())
    if most < hits:
        said = f"{path}: no pixel of {metres:g} m has {hits} points between {low:g} m and {high:g} m"
        raise MapError("map.no-points", said, f"--min-hits takes fewer; the most that one has is {most}")
    said = (
        "a point cloud has no evidence of free space: "
        f"what has fewer than {hits} points between {low:g} m and {high:g} m was read as free, be it observed or not"
    )
    origin = (round(first[0] * metres, 9), round(first[1] * metres, 9), 0.0)
    warnings = (MapWarning("free-unobserved", said),)
    np.greater_equal(counts, hits, out=counts.view(np.bool_))
    content = Occupancies(counts[::-1], certain=True)
    return Described(path, metres, origin, warnings=warnings, content=content)


def _heights(bounds: Floats) -> str:
    return f"its points have z from {bounds[0, 2]:.2f} to {bounds[1, 2]:.2f}"


def _band(band: Sequence[float]) -> tuple[float, float]:
    values = [number(value) for value in band]
    low, high = values if len(values) == 2 else (None, None)
    if low is None or high is None or not (math.isfinite(low) and math.isfinite(high) and low < high):
        raise MapError("map.band", f"band {shown(list(band))} is not two heights in metres, the lower one first")
    return low, high


def _hits(value: object) -> int:
    hits = number(value)
    if hits is None or hits != hits // 1 or not 1 <= hits <= 255:
        raise MapError("map.min-hits", f"min_hits {shown(value)} is not a number of points from 1 to 255")
    return int(hits)


#: Gives the points chunk by chunk, and the share of them that was given.
Reader = Callable[[], Iterator[tuple[Floats, float]]]


def _reader(path: Path) -> Reader:
    """What gives the points of a file as (N, 3) metres, as often as it is asked."""
    if look(path)[1].startswith(b"LASF"):
        laspy = needed("laspy", "points")
        return lambda: _las(laspy, path)
    pye57 = needed("pye57", "points")
    return lambda: _e57(pye57, path)


def _las(laspy: Any, path: Path) -> Iterator[tuple[Floats, float]]:
    with laspy.open(path) as file:
        total, done = file.header.point_count, 0
        for points in file.chunk_iterator(CHUNK):
            done += len(points)
            yield np.column_stack([points.x, points.y, points.z]).astype(np.float64), done / total
        if done < total:
            raise MapError("map.truncated", f"{path} is truncated: it has {done} of {total} points")


def _e57(pye57: Any, path: Path) -> Iterator[tuple[Floats, float]]:
    """All scans, each brought into the common frame by its pose."""
    with pye57.E57(str(path)) as file:
        headers = [file.get_header(k) for k in range(file.scan_count)]
        total, done = sum(header.point_count for header in headers) or 1, 0
        for header in headers:
            fields = [*header.point_fields]
            round_ = "cartesianX" not in fields
            names = ["sphericalRange", "sphericalAzimuth", "sphericalElevation"] if round_ else None
            names = names or ["cartesianX", "cartesianY", "cartesianZ"]
            flag = "sphericalInvalidState" if round_ else "cartesianInvalidState"
            data, buffers = file.make_buffers([*names, *([flag] if flag in fields else [])], CHUNK)
            reader = header.points.reader(buffers)
            turn = header.rotation_matrix if header.has_pose() else np.eye(3)
            shift = header.translation if header.has_pose() else np.zeros(3)
            while count := reader.read():
                done += count
                part = np.column_stack([data[name][:count] for name in names]).astype(np.float64)
                if flag in data:
                    part = part[data[flag][:count] == 0]
                yield (_cartesian(part) if round_ else part) @ np.asarray(turn).T + shift, done / total
            reader.close()


def _cartesian(of: Floats) -> Floats:
    """Range, azimuth, elevation to x, y, z."""
    far, azimuth, elevation = of.T
    flat = far * np.cos(elevation)
    return np.column_stack([flat * np.cos(azimuth), flat * np.sin(azimuth), far * np.sin(elevation)])


def _within(points: Floats, low: float, high: float) -> Floats:
    kept: Floats = points[np.isfinite(points).all(axis=1) & (points[:, 2] >= low) & (points[:, 2] <= high)]
    return kept


def _bounds(read: Reader, low: float, high: float, told: Progress) -> Floats | None:
    """Least and greatest x, y, z of the points in the band, (2, 3)."""
    bounds: Floats | None = None
    for points, share in read():
        kept = _within(points, low, high)
        if len(kept):
            ends = [kept.min(axis=0), kept.max(axis=0)]
            bounds = np.array(
                ends if bounds is None else [np.minimum(bounds[0], ends[0]), np.maximum(bounds[1], ends[1])]
            )
        told(share)
    return bounds


def _lattice(path: Path, bounds: Floats, metres: float) -> tuple[tuple[int, int], tuple[int, int]]:
    """First column and row, on multiples of the resolution, and the size in columns and rows."""
    ends = np.floor(bounds[:, :2] / metres)
    wide, high = (ends[1] - ends[0] + 1 + 2 * MARGIN).tolist()
    if wide * high > LARGEST:
        said = (
            f"{path} is {wide * metres:.0f} m by {high * metres:.0f} m: {wide:.0f} x {high:.0f} pixels of {metres:g} m"
        )
        raise MapError("map.too-large", said, "points far outside must be cut off first, or --resolution made coarser")
    x, y = (int(value) - MARGIN for value in ends[0])
    return (x, y), (int(wide), int(high))


def _counted(
    read: Reader, low: float, high: float, metres: float, first: tuple[int, int], size: tuple[int, int], told: Progress
) -> Bytes:
    """Points of the band in each pixel, at most 255, lowest row first."""
    counts = np.zeros((size[1], size[0]), np.uint8)
    flat = counts.reshape(-1)
    for points, share in read():
        kept = np.floor(_within(points, low, high)[:, :2] / metres).astype(np.int64) - first
        at, many = np.unique(kept[:, 1] * size[0] + kept[:, 0], return_counts=True)
        flat[at] = np.minimum(flat[at] + many, 255)
        told(share)
    return counts
