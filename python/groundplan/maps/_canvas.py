"""Where decoded pixels go: memory, or a file without a name where they are many."""

from __future__ import annotations

import os
import shutil
import tempfile
from pathlib import Path
from typing import IO, Self

import numpy as np
import numpy.typing as npt

from groundplan._errors import MapError
from groundplan.maps._source import Bytes, Progress

#: Up to so many pixels are decoded into memory; more go to a temporary file, which is mapped.
IN_MEMORY = 1 << 28


class Canvas:
    """An array of pixels that is filled from top to bottom, some rows at a time.

    A large one is a temporary file that has no name any more when it is written to, so that nothing is left of it
    whatever ends the process. `TMPDIR` says where; without it that is /var/tmp, because /tmp may lie in memory.

    Parameters
    ----------
    path : Path
        The map's file, for what is said.
    height, width : int
        Size in pixels.
    progress : callable or None
        Is told the share that was filled.

    Raises
    ------
    MapError
        ``map.scratch`` where there is no room for it.
    """

    def __init__(self, path: Path, height: int, width: int, progress: Progress | None = None) -> None:
        self._path, self._shape, self._progress = path, (height, width), progress
        self._file: IO[bytes] | None = None
        if height * width > IN_MEMORY:
            self._where = scratch_directory()
            self._reserve(height * width)
        else:
            # In pages of the usual size. NumPy asks for huge ones: 64 megapixels took 150 ms where a virtual machine
            # had none that were in use before, and take 30 so.
            self._array = np.ndarray(self._shape, np.uint8, bytearray(height * width))

    def _reserve(self, size: int) -> None:
        try:
            room = shutil.disk_usage(self._where).free
            if room < size:
                raise self._no_room(f"{room} bytes are free")
            self._file = tempfile.TemporaryFile(prefix="groundplan-", dir=self._where)  # noqa: SIM115
            # At once, so that a full disk is told before the reading and not after it.
            if hasattr(os, "posix_fallocate"):
                os.posix_fallocate(self._file.fileno(), 0, size)
            else:
                self._file.truncate(size)
        except OSError as fault:
            raise self._no_room(fault.strerror or str(fault)) from fault

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """Let the file go; what is mapped of it stays until the array goes."""
        if self._file is not None:
            self._file.close()

    def put(self, top: int, rows: npt.NDArray[np.uint8]) -> None:
        """Put in rows, the first of which is row `top`."""
        if self._file is None:
            self._array[top : top + len(rows)] = rows
        else:
            try:
                self._file.seek(top * self._shape[1])
                self._file.write(np.ascontiguousarray(rows).data)
            except OSError as fault:
                raise self._no_room(fault.strerror or str(fault)) from fault
        if self._progress is not None:
            self._progress((top + len(rows)) / self._shape[0])

    def pixels(self) -> Bytes:
        """The array, to be read only where it is a file."""
        if self._file is None:
            return self._array
        self._file.flush()
        return np.memmap(self._file, np.uint8, "r", 0, self._shape)

    def _no_room(self, why: str) -> MapError:
        height, width = self._shape
        return MapError(
            "map.scratch",
            f"{self._path} has {width} x {height} pixels, and {self._where} has no room for so many bytes: {why}",
            "TMPDIR names another directory for temporary files",
        )


def scratch_directory() -> str:
    """Where temporary files of the size of a map go."""
    if not any(os.environ.get(name) for name in ("TMPDIR", "TEMP", "TMP")) and os.access("/var/tmp", os.W_OK):
        return "/var/tmp"
    return tempfile.gettempdir()
