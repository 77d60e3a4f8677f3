"""GeoTIFF, read by `rasterio`: its affine transform is the map's frame, block after block its pixels.

Samples of 8 or 16 bits without a sign are greys, as in any other image; int8 are occupancies, -1 and 0..100.

Source: OGC 19-008r4, GeoTIFF Standard; the affine transform as GDAL gives it.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from groundplan._errors import GroundplanError, MapError
from groundplan._extras import needed
from groundplan.maps import _canvas
from groundplan.maps._canvas import Canvas
from groundplan.maps._map import MapWarning
from groundplan.maps._open import open_file
from groundplan.maps._source import Bytes, Described, Occupancies, Origin, Picture, Progress, Span
from groundplan.maps.image import grey_of, opened, refuse_growth
from groundplan.maps.map_server import check_resolution
from groundplan.maps.pgm import sixteen_bits

#: Tags of a frame, and GDAL's of no-data.
GEO_TAGS = (33550, 33922, 34264, 34735, 42113)
BITS, SAMPLE_FORMAT, SIGNED = 258, 339, 2
WORLD_FILES = (".tfw", ".tifw", ".wld")

#: How many bands of colour there may be of each type.
BANDS = {"uint8": (1, 3), "int8": (1,), "uint16": (1,)}

#: Sides of a pixel may differ by so much of their length, and its corner from a right angle in radians.
SQUARE = 1e-6

#: Memory for GDAL's own blocks, in megabytes, and pixels that are read at a time at the least.
CACHE_MB, AT_A_TIME = 64, 1 << 23


def is_geotiff(path: Path) -> bool:
    """Whether a TIFF needs more than an image reader: it has a frame, signed samples, or too many pixels."""
    if any(path.with_suffix(suffix).is_file() for suffix in WORLD_FILES):
        return True
    with open_file(path) as file, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            image: Any = opened(file, "TIFF")
        except Exception:  # whatever is wrong with it: GDAL may know the format, Pillow does not
            return file.seek(0) == 0 and file.read(3)[2:] == b"+"
        tags = image.tag_v2
        large = image.width * image.height > _canvas.IN_MEMORY
        signed = SIGNED in tags.get(SAMPLE_FORMAT, ()) and 8 in tags.get(BITS, ())
        return large or signed or any(tag in tags for tag in GEO_TAGS)


def read_geotiff(
    path: Path,
    resolution: float | None = None,
    *,
    posed: bool = True,
    luma: bool = True,
    rows: Span | None = None,
    progress: Progress | None = None,
) -> Described:
    """Read a GeoTIFF, with a coordinate reference system or without.

    Parameters
    ----------
    path : Path
        The file.
    resolution : float, optional
        Metres a pixel, where it is given beside the file.
    posed : bool
        Whether the file's own origin is wanted; where neither that nor its resolution is, its frame is not looked at.
    luma : bool
        How colour becomes grey, as in `read_image`.
    rows : (int, int), optional
        From, to: the rows of the map that are wanted, counted from its top.

    Raises
    ------
    MapError
        ``map.corrupt``, ``map.pixels``, ``map.scratch``; ``map.resolution`` where the pixels are not square or not
        measured in metres.
    GroundplanError
        ``extra.missing``.
    """
    rasterio = needed("rasterio", "gis")
    try:
        with warnings.catch_warnings(), rasterio.Env(GDAL_CACHEMAX=CACHE_MB):
            warnings.simplefilter("ignore")
            with rasterio.open(path) as data:
                refuse_growth(path, data.width, data.height, path.stat().st_size)
                metres, origin = None, None
                if (posed or resolution is None) and not data.transform.is_identity:
                    _refuse_other_units(path, data)
                    metres, origin, upwards = frame(data.transform, data.height, str(path))
                else:
                    upwards = data.transform.determinant > 0 and not data.transform.is_identity
                if rows is not None and upwards:
                    rows = data.height - rows[1], data.height - rows[0]
                content, odd = _content(path, data, rows, luma=luma, progress=progress)
                shape, block = (data.height, data.width), data.block_shapes[0][0]
    except (GroundplanError, MemoryError):
        raise
    except Exception as fault:  # GDAL's errors are of many kinds
        raise MapError("map.corrupt", f"{path} is a damaged TIFF: {' '.join(str(fault).split())}") from fault
    if upwards:
        content = _flipped(content)
    own = origin if posed else None
    return Described(path, metres, own, warnings=tuple(odd), content=content, shape=shape, block=block)


def frame(transform: Any, height: int, where: str) -> tuple[float, Origin, bool]:
    """Metres a pixel, pose of the lower left corner, and whether the first row is the lowest.

    Parameters
    ----------
    transform : affine.Affine
        From column and row to metres: its rotation terms are the yaw.
    height : int
        Rows of pixels.

    Raises
    ------
    MapError
        ``map.resolution`` where a pixel is not square.
    """
    right, down = (transform.a, transform.d), (transform.b, transform.e)
    wide, high = math.hypot(*right), math.hypot(*down)
    along = abs(right[0] * down[0] + right[1] * down[1])
    if not (wide > 0 and abs(wide - high) <= SQUARE * wide and along <= SQUARE * wide * high):
        skewed = ", its sides not at right angles" if along > SQUARE * wide * high else ""
        raise MapError(
            "map.resolution",
            f"{where}: a pixel is {wide:.9g} m by {high:.9g} m{skewed}: it is not square",
            "resample it, such as with gdalwarp -tr 0.05 0.05",
        )
    upwards = transform.determinant > 0
    rows = 0 if upwards else height
    x, y = transform.c + transform.b * rows, transform.f + transform.e * rows
    yaw = math.atan2(right[1], right[0])
    metres = check_resolution(_clean(wide), where)
    return metres, (_clean(x), _clean(y), round(yaw, 12) + 0.0), upwards


def _clean(value: float) -> float:
    """Without the last digits that sums of floats leave, a nanometre at the most."""
    return float(f"{round(value, 9):.15g}") + 0.0 if abs(value) >= 1e-3 else value + 0.0


def _refuse_other_units(path: Path, data: Any) -> None:
    """Refuse degrees and feet."""
    crs = data.crs
    if crs is None:
        return
    if crs.is_geographic:
        raise MapError(
            "map.resolution",
            f"{path} is in degrees ({crs.to_string()}); a map needs metres",
            "gdalwarp -t_srs EPSG:... brings it into metres; --resolution and --origin set its frame",
        )
    try:
        unit, factor = crs.linear_units_factor
    except Exception:  # a local system that names no unit
        return
    if abs(factor - 1.0) > 1e-12:
        raise MapError(
            "map.resolution",
            f"{path} is in units of {factor:g} m ({unit}); a map needs metres",
            "gdalwarp -t_srs EPSG:... brings it into metres; --resolution and --origin set its frame",
        )


def _content(
    path: Path, data: Any, rows: Span | None, *, luma: bool, progress: Progress | None
) -> tuple[Picture | Occupancies, list[MapWarning]]:
    """The pixels of all rows of the file, or of some, and what was lost."""
    from rasterio.enums import ColorInterp, MaskFlags
    from rasterio.windows import Window

    kinds, colours = set(data.dtypes), data.count - (ColorInterp.alpha in data.colorinterp)
    if len(kinds) > 1 or colours not in BANDS.get(data.dtypes[0], ()):
        said = f"{path} has {data.count} bands of {' and '.join(sorted(kinds))}"
        hint = "gdal_translate -ot Byte -scale makes greys of them"
        raise MapError("map.pixels", f"{said}; a map needs greys of 8 or 16 bits, or int8 occupancies", hint)
    signed = data.dtypes[0] == "int8"
    masked = MaskFlags.per_dataset in data.mask_flag_enums[0]
    if masked and not signed and data.height * data.width > _canvas.IN_MEMORY:
        said = f"{path} has {data.width} x {data.height} pixels and a mask beside them"
        raise MapError("map.too-large", said, "gdal_translate -b 1 -mask none -a_nodata 205 leaves the mask out")
    first, end = rows or (0, data.height)
    with Canvas(path, end - first, data.width, progress) as canvas:
        for window in _windows(data, first, end):
            bands = data.read(list(range(1, colours + 1)), window=window)
            if masked and signed:
                bands[0][data.read_masks(1, window=window) == 0] = -1
            canvas.put(window.row_off - first, _as_bytes(bands, luma=luma))
        pixels = canvas.pixels()
    whole = data.nodata is not None and math.isfinite(data.nodata) and data.nodata == int(data.nodata)
    nodata = int(data.nodata) if whole else None
    if signed:
        return Occupancies(pixels, absent=None if nodata is None else nodata & 255), []
    alpha = data.read_masks(1, window=Window(0, first, data.width, end - first)) if masked else None
    if alpha is not None and alpha.min() == 255:
        alpha = None
    most = 65535 if data.dtypes[0] == "uint16" else 255
    absent = np.zeros(256, np.bool_)
    if nodata is not None and 0 <= nodata <= most:
        absent[(nodata * 255 + most // 2) // most] = True
    shades, alphas = np.arange(256, dtype=np.float64), None
    if data.colorinterp[0] == ColorInterp.palette:
        table = np.array([data.colormap(1).get(k, (0, 0, 0, 255)) for k in range(256)], np.uint8)
        shades = grey_of(table[:, 0], table[:, 1], table[:, 2], luma=luma).astype(np.float64)
        alphas = None if table[:, 3].min() == 255 else table[:, 3]
    found = Picture(pixels, shades, alphas, alpha, masked or alphas is not None, absent)
    return found, [] if most == 255 else [sixteen_bits(path)]


def _windows(data: Any, first: int, end: int) -> Iterator[Any]:
    """Bands of rows, from a block's first on whole blocks, each about so many pixels that reading it is worth it."""
    from rasterio.windows import Window

    block = data.block_shapes[0][0]
    rows = max(1, AT_A_TIME // (data.width * block)) * block
    for top in range(first, end, rows):
        yield Window(0, top, data.width, min(rows, end - top))


def _as_bytes(bands: npt.NDArray[Any], *, luma: bool) -> Bytes:
    """A byte for each pixel."""
    if bands.dtype == np.uint16:
        return np.asarray((bands[0].astype(np.uint32) * 255 + 32767) // 65535, np.uint8)
    if len(bands) == 3:
        return grey_of(bands[0], bands[1], bands[2], luma=luma)
    grey: Bytes = bands[0].view(np.uint8)
    return grey


def _flipped(content: Picture | Occupancies) -> Picture | Occupancies:
    """The other way up, without copying."""
    if isinstance(content, Occupancies):
        return replace(content, pixels=content.pixels[::-1])
    return replace(content, pixels=content.pixels[::-1], alpha=None if content.alpha is None else content.alpha[::-1])
