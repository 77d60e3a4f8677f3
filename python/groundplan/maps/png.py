"""Large PNG files, strip by strip: what Pillow decodes at once is never more than some rows.

Each row of a PNG is filtered against the one above it. So a strip of rows, put behind the row above it, is a PNG of its
own: Pillow takes the filters off, and reads what comes out under the file's own header.

Source: W3C, Portable Network Graphics (PNG) Specification (Third Edition).
"""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import BinaryIO, cast

import numpy as np

from groundplan._errors import MapError
from groundplan.maps._canvas import Canvas
from groundplan.maps._source import Bytes, Picture, Progress

SIGNATURE = b"\x89PNG\r\n\x1a\n"

#: Bytes read, and bytes of rows decoded, at a time.
PIECE, STRIP = 1 << 20, 1 << 23

CHANNELS = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}

#: The colour type of 8-bit samples that has so many bytes a pixel: filters look at bytes, whatever these mean.
OF_BYTES = {1: 0, 2: 4, 3: 2, 4: 6}


@dataclass(frozen=True)
class Header:
    """A PNG's header; `tables` are its palette and transparency as they lie."""

    width: int
    height: int
    depth: int
    colour: int
    interlaced: bool
    tables: bytes

    @property
    def stride(self) -> int:
        """Bytes from a byte to the one that it is filtered against."""
        return max(1, CHANNELS[self.colour] * self.depth // 8)

    @property
    def row(self) -> int:
        """Bytes of a row, without that of its filter."""
        return (self.width * CHANNELS[self.colour] * self.depth + 7) // 8


def in_strips(file: BinaryIO) -> bool:
    """Whether a PNG can be read in strips: neither interlaced nor of 16-bit colours."""
    header = _header(file)
    return not header.interlaced and header.stride in OF_BYTES


def read_strips(path: Path, file: BinaryIO, *, luma: bool, progress: Progress | None = None) -> Picture:
    """Read a PNG some rows at a time.

    Raises
    ------
    MapError
        ``map.truncated``, ``map.corrupt``, ``map.scratch``; ``map.too-large`` where it is partly transparent.
    """
    header = _header(file)
    above = np.zeros((1, header.row), np.uint8)
    top, seen = 0, Picture(above)
    with Canvas(path, header.height, header.width, progress) as canvas:
        for filtered in _strips(path, file, header):
            rows = _unfiltered(above, filtered, header)
            seen = _pictured(path, rows, header, luma=luma)
            if seen.alpha is not None:
                said = f"{path} has {header.width} x {header.height} pixels and is transparent in places"
                raise MapError("map.too-large", said, "save it without transparency, or as an 8-bit PGM")
            canvas.put(top, seen.pixels)
            top, above = top + len(rows), rows[-1:]
        return replace(seen, pixels=canvas.pixels())


def _header(file: BinaryIO) -> Header:
    """What comes before the pixels."""
    file.seek(len(SIGNATURE))
    size, tables = (0, 0, 0, 0, 0, 0, 0), b""
    while True:
        length, kind = struct.unpack(">I4s", file.read(8))
        if kind in (b"IDAT", b"IEND"):
            width, height, depth, colour, _, _, interlace = size
            return Header(width, height, depth, colour, interlace != 0, tables)
        data = file.read(length + 4)[:-4]
        if kind == b"IHDR":
            size = struct.unpack(">IIBBBBB", data)
        elif kind in (b"PLTE", b"tRNS"):
            tables += _chunk(kind, data)


def _pieces(path: Path, file: BinaryIO) -> Iterator[bytes]:
    """The compressed bytes."""
    file.seek(len(SIGNATURE))
    while len(start := file.read(8)) == 8:
        left, kind = struct.unpack(">I4s", start)
        if kind == b"IEND":
            return
        if kind != b"IDAT":
            file.seek(left + 4, 1)
            continue
        check = zlib.crc32(kind)
        while left and (piece := file.read(min(left, PIECE))):
            left, check = left - len(piece), zlib.crc32(piece, check)
            yield piece
        if (said := file.read(4)) and said != struct.pack(">I", check):
            raise MapError("map.corrupt", f"{path} is a damaged PNG: a checksum is wrong at byte {file.tell() - 4}")


def _strips(path: Path, file: BinaryIO, header: Header) -> Iterator[bytes]:
    """The filtered rows, many at a time; each begins with the number of its filter."""
    row, done, held = header.row + 1, 0, bytearray()
    most = max(1, STRIP // row) * row
    inflate = zlib.decompressobj()
    try:
        for piece in _pieces(path, file):
            while piece and done < header.height:
                held += inflate.decompress(piece, most - len(held))
                piece = inflate.unconsumed_tail
                if len(held) >= most:
                    rows = min(most // row, header.height - done)
                    yield bytes(held[: rows * row])
                    held.clear()
                    done += rows
        held += inflate.flush()
    except zlib.error as fault:
        raise MapError("map.corrupt", f"{path} is a damaged PNG: {fault}") from fault
    if rows := min(len(held) // row, header.height - done):
        yield bytes(held[: rows * row])
        done += rows
    if done < header.height:
        raise MapError("map.truncated", f"{path} is truncated: it has {done} of {header.height} rows")


def _unfiltered(above: Bytes, filtered: bytes, header: Header) -> Bytes:
    """The bytes of the rows, (rows, bytes a row), given those of the row above the first."""
    from PIL.PngImagePlugin import PngImageFile

    rows = b"\0" + above.tobytes() + filtered
    count = len(filtered) // (header.row + 1) + 1
    made = _png(header.row // header.stride, count, 8, OF_BYTES[header.stride], b"", rows)
    return cast(Bytes, np.asarray(PngImageFile(made)).reshape(count, header.row)[1:])


def _pictured(path: Path, rows: Bytes, header: Header, *, luma: bool) -> Picture:
    """What rows of bytes are under the file's own header."""
    from PIL.PngImagePlugin import PngImageFile

    from groundplan.maps.image import picture

    plain = np.pad(rows, ((0, 0), (1, 0))).tobytes()
    made = _png(header.width, len(rows), header.depth, header.colour, header.tables, plain)
    return picture(path, PngImageFile(made), luma=luma)


def _png(width: int, height: int, depth: int, colour: int, tables: bytes, rows: bytes) -> io.BytesIO:
    """A PNG of filtered rows, not compressed."""
    size = struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, 0)
    data = _chunk(b"IDAT", zlib.compress(rows, 0))
    return io.BytesIO(SIGNATURE + _chunk(b"IHDR", size) + tables + data + _chunk(b"IEND", b""))


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
