"""A map's file of which any process that can reach it reads the rows that it needs, and no others."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from groundplan._errors import MapError
from groundplan._files import absent
from groundplan.maps._source import Bytes, Described, Occupancies, Picture


@dataclass(frozen=True)
class Distant:
    """Where rows of pixels are read, the map's top row first.

    Attributes
    ----------
    path : str
        The file, or the directory of a Zarr array.
    kind : {"mapped", "zarr", "tiff"}
    shape : (int, int)
        Rows and columns.
    block : int
        Rows that are stored together, and best read so.
    offset : int
        Of a mapped file: where its pixels begin, bytes.
    luma : bool
        How colour becomes grey, as in `read_image`.
    """

    path: str
    kind: Literal["mapped", "zarr", "tiff"]
    shape: tuple[int, int]
    block: int = 1
    offset: int = 0
    luma: bool = True

    def rows(self, top: int, end: int) -> Bytes:
        """Values of pixels, the rows from `top` to before `end`.

        Raises
        ------
        MapError
            ``map.missing`` where this process has no such file, and what reading it raises.
        """
        if not os.path.exists(self.path):
            raise MapError("map.missing", absent(Path(self.path)))
        if self.kind == "mapped":
            mapped: Bytes = np.memmap(self.path, np.uint8, "r", self.offset, self.shape)[top:end]
            return mapped
        path = Path(self.path)
        if self.kind == "zarr":
            from groundplan.maps.zarr_array import read_rows

            return read_rows(path, (top, end))
        from groundplan.maps.geotiff import read_geotiff

        # The frame is known: whoever describes the map has looked at it.
        content = read_geotiff(path, 1.0, posed=False, luma=self.luma, rows=(top, end)).content
        assert content is not None
        return content.pixels


def distant(described: Described, content: Picture | Occupancies, *, luma: bool) -> Distant | None:
    """The map's file, where it can be read row by row; None where its pixels were made here."""
    if isinstance(content, Picture) and content.has_alpha and content.alphas is None:
        return None  # a mask is worked in over all pixels
    path = os.path.abspath(described.image)
    if described.shape is not None:
        kind: Literal["zarr", "tiff"] = "zarr" if os.path.isdir(path) else "tiff"
        return Distant(path, kind, described.shape, described.block, luma=luma)
    pixels = content.pixels
    if isinstance(pixels, np.memmap) and isinstance(pixels.filename, str | os.PathLike):
        height, width = pixels.shape
        return Distant(os.path.abspath(pixels.filename), "mapped", (height, width), offset=pixels.offset)
    return None
