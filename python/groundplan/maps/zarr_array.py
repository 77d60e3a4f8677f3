"""Zarr arrays: chunked maps of any size, their frame in attributes.

uint8 are the greys of an image, row 0 at the top; int8 the data of an OccupancyGrid, row 0 at the bottom. Attributes
are those of a map_server YAML: `resolution`, `origin`, and `negate`, `mode`, `occupied_thresh`, `free_thresh`.

Source: Zarr specification, versions 2 and 3, as the library `zarr` reads it.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from groundplan._errors import GroundplanError, MapError
from groundplan._extras import needed
from groundplan.maps._canvas import Canvas
from groundplan.maps._source import Bytes, Described, Occupancies, Picture, Progress, Span
from groundplan.maps.map_server import check_mode, check_negate, check_origin, check_resolution, check_threshold

#: Pixels that are read at a time at the least, and a row of chunks at the most, in bytes.
AT_A_TIME, LARGEST_BAND = 1 << 23, 1 << 31


def read_zarr(path: Path, *, rows: Span | None = None, progress: Progress | None = None) -> Described:
    """Read a Zarr array, or the only two-dimensional one of a group; of its pixels some `rows` alone, from, to.

    Raises
    ------
    MapError
        ``map.corrupt``, ``map.pixels``, ``map.zarr``, ``map.scratch``, and those of a YAML's fields.
    GroundplanError
        ``extra.missing``.
    """
    with _opened(path) as array:
        where, fields = str(path), dict(array.attrs)
        if array.ndim != 2 or array.dtype not in (np.uint8, np.int8) or 0 in array.shape:
            said = f"{where} is an array of {array.dtype} and shape {tuple(array.shape)}"
            raise MapError("map.pixels", f"{said}; a map needs height x width of uint8 greys or int8 occupancies")
        if not array.nchunks_initialized:
            raise MapError(
                "map.empty", f"{where} is empty: no chunk of its {array.shape[1]} x {array.shape[0]} pixels is there"
            )
        block = _block(array)
        pixels = _pixels(path, array, block, progress) if rows is None else _rows(array, rows)
    origin, warnings = check_origin(fields["origin"], where) if "origin" in fields else (None, [])
    high, low = (
        check_threshold(fields[name], name, where) if name in fields else None
        for name in ("occupied_thresh", "free_thresh")
    )
    return Described(
        path,
        check_resolution(fields["resolution"], where) if "resolution" in fields else None,
        origin,
        check_negate(path, fields["negate"]) if "negate" in fields else None,
        check_mode(fields["mode"], where) if "mode" in fields else None,
        high,
        low,
        tuple(warnings),
        Picture(pixels) if array.dtype == np.uint8 else Occupancies(pixels[::-1]),
        tuple(array.shape),
        block,
    )


def read_rows(path: Path, rows: Span) -> Bytes:
    """Rows of a map, from, to, that `read_zarr` has looked at: the chunks beside them are not even listed.

    Raises
    ------
    MapError
        ``map.corrupt``.
    GroundplanError
        ``extra.missing``.
    """
    with _opened(path) as array:
        pixels = _rows(array, rows)
    return pixels if array.dtype == np.uint8 else pixels[::-1]


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    """The array, and an error of Groundplan's for whatever goes wrong with it."""
    zarr = needed("zarr", "large")
    try:
        yield _array(path, zarr.open(str(path), mode="r"))
    except (GroundplanError, MemoryError):
        raise
    except Exception as fault:  # a store can be damaged anywhere
        said = " ".join(f"{type(fault).__name__}: {fault}".split())
        raise MapError("map.corrupt", f"{path} is a damaged Zarr array: {said}") from fault


def _array(path: Path, found: Any) -> Any:
    """The array itself, or the one in a group."""
    if hasattr(found, "shape"):
        return found
    inside = {name: array for name, array in found.arrays() if array.ndim == 2}
    if len(inside) == 1:
        return next(iter(inside.values()))
    if not inside:
        raise MapError("map.zarr", f"{path} is a Zarr group without a two-dimensional array")
    names = ", ".join(sorted(inside))
    first = path / min(inside)
    raise MapError("map.zarr", f"{path} is a Zarr group with several arrays: {names}", f"name one of them: {first}")


def _block(array: Any) -> int:
    """Rows of a chunk."""
    return int(min(array.shape[0], (getattr(array, "shards", None) or array.chunks)[0]))


def _rows(array: Any, rows: Span) -> Bytes:
    """Some rows of the map, counted from its top, as they lie."""
    height, (top, end) = array.shape[0], rows
    lies = slice(top, end) if array.dtype == np.uint8 else slice(height - end, height - top)
    pixels: Bytes = np.ascontiguousarray(array[lies]).view(np.uint8)
    return pixels


def _pixels(path: Path, array: Any, chunk: int, progress: Progress | None) -> Any:
    """All pixels, a row of chunks at a time."""
    height, width = array.shape
    if chunk * width > LARGEST_BAND:
        said = f"{path} has chunks of {chunk} rows: one row of them has {chunk * width} pixels"
        raise MapError("map.too-large", said, "rechunk it, such as to 1024 x 1024")
    rows = max(1, AT_A_TIME // (chunk * width)) * chunk
    with Canvas(path, height, width, progress) as canvas:
        for top in range(0, height, rows):
            canvas.put(top, np.ascontiguousarray(array[top : top + rows]).view(np.uint8))
        return canvas.pixels()
