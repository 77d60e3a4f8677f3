"""Opening a map's file, and telling by its first bytes what it is."""

from __future__ import annotations

import re
from pathlib import Path
from typing import BinaryIO, Literal

from groundplan._errors import MapError
from groundplan._files import absent, nearest

Kind = Literal["yaml", "image", "tiff", "bag", "zarr", "points"]

FORMATS = "PGM, PNG, BMP, TIFF, JPEG, PBM or PPM"

#: What a rosbag2 says of itself.
METADATA = "metadata.yaml"

#: First bytes of the image formats that are told by them alone.
_IMAGES = {b"\x89PNG\r\n\x1a\n": "PNG", b"BM": "BMP", b"II*\0": "TIFF", b"MM\0*": "TIFF", b"\xff\xd8\xff": "JPEG"}
_BIG_TIFFS = (b"II+\0", b"MM\0+")
_BAGS = (b"#ROSBAG V", b"\x89MCAP0\r\n", b"SQLite format 3\0")
_POINTS = (b"LASF", b"ASTM-E57")


def kind_of(path: Path) -> Kind:
    """What the file or directory is.

    Raises
    ------
    MapError
        ``map.missing``, ``map.directory``, ``map.unreadable``, ``map.empty``; ``map.format`` where it is no map.
    """
    if path.name == METADATA and _is_bag(path.parent):
        return "bag"
    if path.is_dir():
        if any((path / name).is_file() for name in ("zarr.json", ".zarray", ".zgroup")):
            return "zarr"
        if _is_bag(path):
            return "bag"
    if path.suffix.lower() in (".yaml", ".yml"):
        return "yaml"
    _, start = look(path)
    if start.startswith(_BAGS):
        return "bag"
    if start.startswith(_POINTS):
        return "points"
    if start.startswith(_BIG_TIFFS) or image_format(start) == "TIFF":
        return "tiff"
    if image_format(start) is None:
        raise MapError(
            "map.format",
            f"{path} is not a map: it is neither a map_server YAML nor {FORMATS}, a bag, a Zarr array or a point cloud",
        )
    return "image"


def _is_bag(path: Path) -> bool:
    """Whether a directory has what a rosbag2 has."""
    return any(path.glob("*.db3*")) or any(path.glob("*.mcap*"))


def image_format(start: bytes) -> str | None:
    """Which image format a file is that starts with these bytes."""
    if re.match(rb"P[25][\s#]", start):
        return "PGM"
    if re.match(rb"P[1346][\s#]", start):
        return "PPM"
    return next((name for sign, name in _IMAGES.items() if start.startswith(sign)), None)


def look(path: Path) -> tuple[int, bytes]:
    """Size of a file and its first 16 bytes, or the error that says why there are none."""
    with open_file(path) as file:
        start = file.read(16)
        size = file.seek(0, 2)
    if size == 0:
        raise MapError("map.empty", f"{path} is empty")
    return size, start


def open_file(path: Path) -> BinaryIO:
    """Open a regular file for reading."""
    try:
        if path.is_dir():
            raise MapError("map.directory", f"{path} is a directory", "name the map's YAML or image in it")
        if path.exists() and not path.is_file():
            raise MapError("map.unreadable", f"{path} is not a regular file")
        return path.open("rb")
    except FileNotFoundError as fault:
        raise MapError("map.missing", absent(path), nearest(path)) from fault
    except (OSError, ValueError) as fault:
        raise MapError("map.unreadable", f"cannot read {path}: {getattr(fault, 'strerror', None) or fault}") from fault
