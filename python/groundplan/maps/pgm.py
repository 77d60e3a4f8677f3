"""PGM files: raw samples of one byte are mapped into memory where they lie, whatever the size.

Source: the netpbm project's pgm(5).
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import BinaryIO

import numpy as np
import numpy.typing as npt

from groundplan._errors import MapError
from groundplan.maps._canvas import Canvas
from groundplan.maps._map import MapWarning
from groundplan.maps._source import Bytes, Picture, Progress, bands

#: Longest header of a PGM, comments included.
HEADER = 1 << 16


def read_pgm(path: Path, file: BinaryIO, size: int, progress: Progress | None = None) -> Picture:
    """A PGM, plain (P2) or raw (P5).

    Raises
    ------
    MapError
        ``map.header``, ``map.truncated``, ``map.corrupt``, ``map.scratch``.
    """
    width, height, maxval, offset, plain = _header(path, file)
    if plain:
        samples = _plain_samples(path, file, size, offset, width, height)
        if int(samples.max()) > 65535:
            raise MapError("map.corrupt", f"{path} has a sample of {int(samples.max())}; its header allows {maxval}")
        if maxval <= 255:
            return Picture(np.minimum(samples, maxval).astype(np.uint8), _shades(maxval))
        return Picture(eight_bits(path, samples, maxval, progress), warnings=(sixteen_bits(path, maxval),))
    kind = np.dtype(np.uint8) if maxval <= 255 else np.dtype(">u2")
    promised, held = width * height * kind.itemsize, size - offset
    if held == promised + 1:
        file.seek(offset - 1)
        # A header that ends in carriage return and line feed has one byte more than the format says.
        offset += file.read(2) == b"\r\n"
    if held < promised:
        raise MapError(
            "map.truncated",
            f"{path} is truncated: its header promises {width} x {height} pixels, {promised} bytes, "
            f"but {max(held, 0)} follow",
        )
    samples = np.memmap(file, kind, "r", offset, (height, width))
    if maxval <= 255:
        return Picture(samples, _shades(maxval))
    return Picture(eight_bits(path, samples, maxval, progress), warnings=(sixteen_bits(path, maxval),))


def _header(path: Path, file: BinaryIO) -> tuple[int, int, int, int, bool]:
    """Width, height, maximal value, where the samples begin, and whether they are plain text."""
    file.seek(0)
    start = file.read(HEADER)
    gap = rb"(?:\s|#[^\n\r]*[\n\r])+"
    match = re.match(rb"P([25])" + gap + rb"(\d{1,10})" + gap + rb"(\d{1,10})" + gap + rb"(\d{1,10})\s", start)
    if match is None:
        raise MapError("map.header", f"{path} has a damaged PGM header: width, height and maximal value do not follow")
    width, height, maxval = (int(match[k]) for k in (2, 3, 4))
    if width == 0 or height == 0:
        raise MapError("map.header", f"{path} is {width} x {height} pixels: it has none")
    if not 1 <= maxval <= 65535:
        raise MapError("map.header", f"{path} has a maximal value of {maxval}; a PGM allows 1 to 65535")
    return width, height, maxval, match.end(), match[1] == b"2"


def _plain_samples(
    path: Path, file: BinaryIO, size: int, offset: int, width: int, height: int
) -> npt.NDArray[np.int64]:
    """Decimal samples; each takes at least a digit and a gap, so a lying header is found out before reading."""
    promised = width * height
    if size - offset + 1 < 2 * promised:
        raise MapError(
            "map.truncated",
            f"{path} is truncated: its header promises {width} x {height} pixels, "
            f"at least {2 * promised - 1} bytes, but {size - offset} follow",
        )
    file.seek(offset)
    text = re.sub(rb"#[^\n\r]*", b"", file.read())
    if re.search(rb"[^\d\s]", text):
        raise MapError("map.corrupt", f"{path} is damaged: its samples are not all decimal numbers")
    samples = np.fromstring(text, np.int64, sep=" ")
    if samples.size < promised:
        raise MapError(
            "map.truncated",
            f"{path} is truncated: its header promises {width} x {height} pixels, {promised} numbers, "
            f"but {samples.size} follow",
        )
    return samples[:promised].reshape(height, width)


def _shades(maxval: int) -> npt.NDArray[np.float64]:
    """Grey of each sample value under another maximal value."""
    return np.minimum(np.arange(256) * 255.0 / maxval, 255.0)


def eight_bits(
    path: Path, samples: npt.NDArray[np.integer], maxval: int = 65535, progress: Progress | None = None
) -> Bytes:
    """Samples scaled to 0..255, rounded to nearest, some rows at a time."""
    height, width = samples.shape
    with Canvas(path, height, width, progress) as scaled:
        for rows in bands(height, width):
            part = np.minimum(samples[rows].astype(np.uint64), maxval)
            scaled.put(rows.start, ((part * 255 + maxval // 2) // maxval).astype(np.uint8))
        return scaled.pixels()


def sixteen_bits(path: Path, maxval: int = 65535) -> MapWarning:
    """The warning that samples were scaled."""
    return MapWarning("sixteen-bit", f"{path.name} has samples up to {maxval}; they were scaled to 8 bits")
