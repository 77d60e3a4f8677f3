"""From a file or an array to a Map: the door, behind which each source is a module."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from groundplan._errors import MapError, shown
from groundplan.maps._distant import Distant, distant
from groundplan.maps._interpret import Unknown, interpret, meaning_of, weigh
from groundplan.maps._map import Map
from groundplan.maps._open import Kind, kind_of
from groundplan.maps._source import Described, Occupancies, Picture, Progress, Span
from groundplan.maps._tally import Tally
from groundplan.maps._warnings import rounded
from groundplan.maps.image import read_image
from groundplan.maps.map_server import (
    SETS_ORIGIN,
    SETS_RESOLUTION,
    check_origin,
    check_resolution,
    meant,
    read_yaml,
)

#: What each kind of file is called, and what can be given for it alone.
_CALLED: dict[Kind, str] = {
    "yaml": "a map_server YAML",
    "image": "an image",
    "tiff": "an image",
    "bag": "a bag",
    "zarr": "a Zarr array",
    "points": "a point cloud",
}
#: How shares of 1 become a map.
_SHARES = "of occupancies from 0 to 1: np.where(np.isfinite(a), np.rint(100 * a), -1).astype('int8'), lowest row first"
#: How a picture of colours becomes one of greys.
_COLOURS = "of greys that are stored as colours array[..., 0] has them; groundplan.read takes a picture's file"
_ONLY: dict[str, Kind] = {"topic": "bag", "stamp": "bag", "band": "points", "min_hits": "points"}


def read(
    path: str | os.PathLike[str],
    *,
    resolution: float | None = None,
    origin: Sequence[float] | None = None,
    dialect: str = "nav2",
    unknown: Unknown = None,
    negate: bool | None = None,
    mode: str | None = None,
    occupied_thresh: float | None = None,
    free_thresh: float | None = None,
    topic: str | None = None,
    stamp: float | None = None,
    band: Sequence[float] | None = None,
    min_hits: int | None = None,
    progress: Progress | None = None,
) -> Map:
    """Read a map: a map_server YAML with its image, an image, a bag, a GeoTIFF, a Zarr array or a point cloud.

    What is given here beats what the file says. The file is never changed, and an 8-bit PGM is not even read: its
    pixels are a read-only memory map. So are those of any other map that is large, in a temporary file without a name.

    Parameters
    ----------
    path : path
        A map_server YAML; a PGM, PNG, BMP, TIFF, JPEG, PBM or PPM; a ROS 1 bag, a rosbag2 directory or file; a
        GeoTIFF; a directory with a Zarr array; a LAS, LAZ or E57 file. Which it is, its content tells.
    resolution : float, optional
        Metres per pixel. A bare image needs it; a point cloud has 0.05 without it.
    origin : (x, y) or (x, y, yaw), optional
        Pose of the lower left corner of the lower left pixel: metres, metres, radians.
    dialect : {"nav2", "nav2-humble", "ros1"}
        Whose reading of the greys to follow.
    unknown : None, "none", int or sequence of int
        Greys that mean unknown. None finds a grey that the thresholds take for free although it is most likely
        unknown, and warns; "none" follows the thresholds to the letter.
    negate : bool, optional
        White is occupied and black is free.
    mode : {"trinary", "scale", "raw"}, optional
        How greys become occupancy.
    occupied_thresh, free_thresh : float, optional
        Darkness from which a pixel is occupied and up to which it is free, 0 to 1. Where neither the YAML nor the
        caller states them and map_saver's 0.65 and 0.196 miss the picture, they are taken from its histogram. Of
        occupancies: of 100, so that 0.65 is an occupancy of 65; 0.65 and 0.25 when not given.
    topic : str, optional
        Of a bag: the topic with the map, where there are several.
    stamp : float, optional
        Of a bag: the map as it was then, by the stamps of the headers, in seconds; the last one without it.
    band : (low, high), optional
        Of a point cloud: the heights of the points that count, metres. It needs them.
    min_hits : int, optional
        Of a point cloud: how many points make a pixel occupied; 2 without it.
    progress : callable, optional
        Is told the share that was read, 0 to 1, where reading takes long.

    Returns
    -------
    Map
        With the warnings of what was odd.

    Raises
    ------
    MapError
        The file is missing, unreadable, not a map, or says what cannot be; the message names file and value.
        ``map.input`` for what is no path, such as an array: that is for `from_array`.
    GroundplanError
        ``extra.missing`` where the library for such files is not installed.
    """
    given = {"resolution": resolution, "origin": origin, "topic": topic, "stamp": stamp, "band": band}
    given |= {"dialect": dialect, "unknown": unknown, "negate": negate, "mode": mode, "min_hits": min_hits}
    given |= {"occupied_thresh": occupied_thresh, "free_thresh": free_thresh}
    return read_or_leave(path, given, None, progress)[0]


def read_or_leave(
    path: str | os.PathLike[str],
    given: dict[str, Any],
    count: Callable[[Distant], Tally] | None = None,
    progress: Progress | None = None,
) -> tuple[Map, Distant | None, Tally | None]:
    """As `read`; or where the file can be read row by row and others `count` its pixels, a map without them.

    Such a map has the right shape and stands for the file that comes with it, as does what was counted.
    """
    if not isinstance(path, str | os.PathLike):
        raise _no_path(path)
    resolution, origin, dialect = given.get("resolution"), given.get("origin"), given.get("dialect", "nav2")
    place = Path(path).expanduser() if str(path).startswith("~") else Path(path)
    kind = kind_of(place)
    own = {name: given.get(name) for name in _ONLY}
    _refuse(place, _CALLED[kind], [name for name, value in own.items() if value is not None and _ONLY[name] != kind])
    metres = None if resolution is None else check_resolution(resolution)
    luma = dialect == "nav2"
    described, content, far = _opened(place, kind, given, metres, luma=luma, leave=count is not None, progress=progress)
    warnings = list(described.warnings)
    where = str(place)
    metres = described.resolution if metres is None else metres
    if metres is None:
        hint = meant("resolution", described.misspelled) or _resolution_hint(place, kind)
        raise MapError("map.resolution", f"{where} states no resolution", hint)
    pose = described.origin
    if origin is not None:
        pose, odd = check_origin(origin)
        warnings = [warning for warning in warnings if not warning.code.startswith("yaw-")] + odd
    if pose is None:
        if kind == "yaml":
            hint = meant("origin", described.misspelled) or SETS_ORIGIN
            raise MapError("map.origin", f"{where} states no origin", hint)
        pose = (0.0, 0.0, 0.0)
    greys = {name: given.get(name) for name in ("unknown", "negate", "mode")}
    thresholds = given.get("occupied_thresh"), given.get("free_thresh")
    meaning, stated = meaning_of(described, dialect, greys["negate"], greys["mode"], *thresholds, where)
    known = None if far is None or count is None else count(far)
    if isinstance(content, Occupancies):
        _refuse(place, "made of occupancies", [name for name, value in greys.items() if value is not None])
        pixels, values, states, odd = weigh(content, meaning, stated, known)
    else:
        warnings += content.warnings
        pixels, values, states, odd = interpret(content, meaning, stated, greys["unknown"], known)
    if far is not None:
        pixels = np.broadcast_to(np.uint8(0), far.shape)
    if resolution is None and kind in ("yaml", "image"):
        warnings += rounded(metres, pixels.shape)
    return Map(pixels, values, states, metres, pose, described.image.name, tuple(warnings + odd)), far, known


def _opened(
    path: Path,
    kind: Kind,
    given: dict[str, Any],
    resolution: float | None,
    *,
    luma: bool,
    leave: bool,
    progress: Progress | None,
) -> tuple[Described, Picture | Occupancies, Distant | None]:
    """What is stated about the map, its pixels, and where they may be left: then there is a row of them at least."""
    posed = given.get("origin") is None
    rows = (0, 1) if leave else None
    described = _described(path, kind, given, resolution, rows, posed=posed, luma=luma, progress=progress)
    content = described.content or read_image(described.image, luma=luma, progress=progress)
    far = distant(described, content, luma=luma) if leave else None
    if leave and far is None and described.shape is not None:
        described = _described(path, kind, given, resolution, None, posed=posed, luma=luma, progress=progress)
        content = described.content or content
    return described, content, far


def from_array(
    array: npt.NDArray[np.generic],
    resolution: float,
    origin: Sequence[float] = (0.0, 0.0, 0.0),
    *,
    image: str = "",
    dialect: str = "nav2",
    unknown: Unknown = None,
    negate: bool | None = None,
    mode: str | None = None,
    occupied_thresh: float | None = None,
    free_thresh: float | None = None,
) -> Map:
    """A Map over an array, without copying it.

    Parameters
    ----------
    array : (height, width) uint8, int8 or bool
        uint8: the greys of an image, row 0 at the top, read as map_server does.
        int8: the data of a nav_msgs/OccupancyGrid, -1 and 0..100, row 0 at the bottom.
        bool: True is occupied, False is free, row 0 at the top.
        A masked array has to be filled first: what its masked pixels are is not for this to say.
    resolution : float
        Metres per pixel.
    origin : (x, y) or (x, y, yaw)
        Pose of the lower left corner of the lower left pixel: metres, metres, radians.
    image : str
        Name to give the map in its survey.
    dialect, unknown, negate, mode, occupied_thresh, free_thresh
        As in `read`, for uint8. For int8 the thresholds alone count, 0.65 for an occupancy of 65; 0.65 and 0.25
        when not given.

    Raises
    ------
    MapError
        ``map.pixels`` for another shape or type, or masked pixels, and those of `read` for the other arguments.
    """
    if masked(array):
        raise MapError(
            "map.pixels",
            f"{masked(array)} pixels of the array are masked, and what they are is not said",
            "where they are unknown: .filled(205) of uint8, .filled(-1) of int8",
        )
    given, array = array, np.asarray(array)
    if array.ndim == 0:
        is_path = isinstance(given, str | os.PathLike)
        hint = "groundplan.read(path) reads a file" if is_path else "height x width pixels of uint8, int8 or bool"
        raise MapError("map.pixels", f"{shown(given)} is no array", hint)
    if array.ndim != 2 or array.size == 0:
        said = f"an array of shape {array.shape} is not a map; it needs height x width pixels"
        raise MapError("map.pixels", said, _COLOURS if array.ndim == 3 else None)
    metres = check_resolution(resolution)
    pose, warnings = check_origin(origin)
    nothing = Described(Path(image), metres, pose)
    meaning, stated = meaning_of(nothing, dialect, negate, mode, occupied_thresh, free_thresh, "from_array")
    if array.dtype == np.uint8:
        pixels, values, states, odd = interpret(Picture(array.view(np.uint8)), meaning, stated, unknown)
    elif array.dtype == np.int8:
        pixels, values, states, odd = weigh(Occupancies(array.view(np.uint8)[::-1]), meaning, stated)
    elif array.dtype == np.bool_:
        pixels, values, states, odd = weigh(Occupancies(array.view(np.uint8), certain=True), meaning, (False, False))
    else:
        raise MapError(
            "map.pixels",
            f"an array of {array.dtype} is not a map; it needs uint8 greys, int8 occupancies or bool",
            _SHARES if array.dtype.kind == "f" else "convert an OccupancyGrid's data with .astype('int8')",
        )
    return Map(pixels, values, states, metres, pose, image, tuple(warnings + odd))


def _no_path(value: object) -> MapError:
    """The error for what is read and is no file's path."""
    if isinstance(value, Map):
        return MapError("map.input", f"{value} is a Map already, and no file's path", "groundplan.survey takes it")
    hint = "a path is text or a pathlib.Path"
    if hasattr(value, "__array__") or isinstance(value, list | tuple):
        hint = "groundplan.from_array(array, resolution) makes a Map of an array"
    shape = getattr(value, "shape", None)
    said = shown(value) if shape is None else f"an array of shape {shape}"
    return MapError("map.input", f"{said} is no file's path", hint)


def masked(array: object) -> int:
    """How many pixels of an array are masked: under the mask lies any value."""
    mask = getattr(array, "mask", None)
    return int(np.count_nonzero(mask)) if isinstance(mask, np.ndarray) else 0


def _described(
    path: Path,
    kind: Kind,
    own: dict[str, Any],
    resolution: float | None,
    rows: Span | None,
    *,
    posed: bool,
    luma: bool,
    progress: Progress | None,
) -> Described:
    """What is stated about the map, and its pixels where they come with that."""
    if kind == "yaml":
        return read_yaml(path)
    if kind == "bag":
        from groundplan.maps.bags import read_bag

        return read_bag(path, topic=own.get("topic"), stamp=own.get("stamp"), posed=posed, progress=progress)
    if kind == "tiff":
        from groundplan.maps.geotiff import is_geotiff, read_geotiff

        if is_geotiff(path):
            return read_geotiff(path, resolution, posed=posed, luma=luma, rows=rows, progress=progress)
    if kind == "zarr":
        from groundplan.maps.zarr_array import read_zarr

        return read_zarr(path, rows=rows, progress=progress)
    if kind == "points":
        from groundplan.maps.points import read_points

        return read_points(
            path, band=own.get("band"), resolution=resolution, min_hits=own.get("min_hits"), progress=progress
        )
    return Described(path)


def _resolution_hint(place: Path, kind: str) -> str:
    """What helps where no resolution is stated: the YAML beside an image, or the flag."""
    beside = place.with_suffix(".yaml")
    is_beside = kind == "image" and beside.is_file()
    return f"did you mean {beside}? Else {SETS_RESOLUTION}" if is_beside else SETS_RESOLUTION


def _refuse(path: Path, called: str, given: list[str]) -> None:
    """Refuse what says nothing about such a file, rather than pass over it."""
    if given:
        raise MapError("map.option", f"{given[0]} says nothing about {path}: it is {called}")
