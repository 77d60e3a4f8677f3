"""Image files as they lie: a PGM is mapped into memory, the others are decoded once by Pillow.

No pixel is converted where a table can say the same: other maximal values, palettes and one-bit pictures give their
samples, and `shades` says which grey each sample is. Only colour, 16-bit samples and partial transparency are
computed pixel by pixel.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

import numpy as np
import numpy.typing as npt

from groundplan._errors import MapError
from groundplan._files import absent
from groundplan.maps._map import MapWarning

if TYPE_CHECKING:
    from PIL.Image import Image
    from PIL.ImageFile import ImageFile

Bytes = npt.NDArray[np.uint8]

#: More pixels than this are refused in a compressed file: decoded they fill 2 GiB at the least.
LIMIT = 2**31

#: No deflate stream grows more than this (zlib's technical notes), and no sane one of another kind more than that.
DEFLATE_GROWTH, OTHER_GROWTH = 1032, 65536

#: Longest header of a PGM, comments included.
HEADER = 1 << 16

FORMATS = "PGM, PNG, BMP, TIFF, JPEG, PBM or PPM"


@dataclass(frozen=True)
class Picture:
    """A decoded image.

    Attributes
    ----------
    pixels : (height, width) uint8
        Samples as they lie, top row first.
    shades : (256,) float64
        Grey of each sample value, 0 black to 255 white.
    alphas : (256,) uint8 or None
        Alpha of each sample value, where a palette or a table has it.
    alpha : (height, width) uint8 or None
        Alpha of each pixel, where it is not 255 everywhere.
    has_alpha : bool
        Whether the file has an alpha channel at all, be it opaque.
    warnings : tuple of MapWarning
        What was lost in decoding.
    """

    pixels: Bytes
    shades: npt.NDArray[np.float64] = field(default_factory=lambda: np.arange(256, dtype=np.float64))
    alphas: Bytes | None = None
    alpha: Bytes | None = None
    has_alpha: bool = False
    warnings: tuple[MapWarning, ...] = ()


def is_image(start: bytes) -> bool:
    """Whether a file that starts with these bytes is an image this module reads."""
    return _kind(start) is not None


def read_image(path: Path, *, luma: bool = True) -> Picture:
    """Read an image file.

    Parameters
    ----------
    path : Path
        The file.
    luma : bool
        How colour becomes grey: Rec. 601 luma as GraphicsMagick computes it, else the mean of the channels.

    Raises
    ------
    MapError
        ``map.missing``, ``map.directory``, ``map.unreadable``, ``map.empty``, ``map.format``, ``map.header``,
        ``map.truncated``, ``map.too-large``, ``map.corrupt``, ``map.pixels``.
    """
    size, start = look(path)
    kind = _kind(start)
    if kind is None:
        raise MapError("map.format", f"{path} is not an image: it is none of {FORMATS}")
    with open_file(path) as file:
        if kind == "PGM":
            return _pgm(path, file, size)
        return _decoded(path, file, size, kind, luma=luma)


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
        raise MapError("map.missing", absent(path)) from fault
    except (OSError, ValueError) as fault:
        raise MapError("map.unreadable", f"cannot read {path}: {getattr(fault, 'strerror', None) or fault}") from fault


def _kind(start: bytes) -> str | None:
    """Which format a file is by its first bytes."""
    if re.match(rb"P[25][\s#]", start):
        return "PGM"
    if re.match(rb"P[1346][\s#]", start):
        return "PPM"
    signs = {b"\x89PNG\r\n\x1a\n": "PNG", b"BM": "BMP", b"II*\0": "TIFF", b"MM\0*": "TIFF", b"\xff\xd8\xff": "JPEG"}
    return next((kind for sign, kind in signs.items() if start.startswith(sign)), None)


# PGM


def _pgm(path: Path, file: BinaryIO, size: int) -> Picture:
    """A PGM, plain (P2) or raw (P5). Raw samples of one byte are mapped, not read."""
    width, height, maxval, offset, plain = _pgm_header(path, file)
    if plain:
        samples = _plain_samples(path, file, size, offset, width, height)
        if int(samples.max()) > 65535:
            raise MapError("map.corrupt", f"{path} has a sample of {int(samples.max())}; its header allows {maxval}")
        if maxval <= 255:
            return Picture(np.minimum(samples, maxval).astype(np.uint8), _shades(maxval))
        return Picture(_eight_bits(samples, maxval), warnings=(_sixteen_bits(path, maxval),))
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
    return Picture(_eight_bits(samples, maxval), warnings=(_sixteen_bits(path, maxval),))


def _pgm_header(path: Path, file: BinaryIO) -> tuple[int, int, int, int, bool]:
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


def _eight_bits(samples: npt.NDArray[np.integer], maxval: int) -> Bytes:
    """Samples scaled to 0..255, rounded to nearest, some rows at a time."""
    scaled = np.empty(samples.shape, np.uint8)
    for rows in _bands(samples.shape[0], samples.shape[1]):
        part = np.minimum(samples[rows].astype(np.uint64), maxval)
        scaled[rows] = (part * 255 + maxval // 2) // maxval
    return scaled


def _bands(height: int, width: int) -> Iterator[slice]:
    """Row bands of about a million pixels."""
    rows = max(1, (1 << 20) // width)
    return (slice(top, top + rows) for top in range(0, height, rows))


def _sixteen_bits(path: Path, maxval: int = 65535) -> MapWarning:
    return MapWarning("sixteen-bit", f"{path.name} has samples up to {maxval}; they were scaled to 8 bits")


# All other formats, by Pillow


def _decoded(path: Path, file: BinaryIO, size: int, kind: str, *, luma: bool) -> Picture:
    """An image by Pillow."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            image = _opened(file, kind)
            _refuse_bombs(path, image, size, kind)
            image.load()
            return _picture(path, image, luma=luma)
    except MapError:
        raise
    except MemoryError as fault:
        raise MapError("map.too-large", f"{path} does not fit into memory") from fault
    except Exception as fault:  # Pillow's decoders raise whatever their parsing trips over
        raise MapError("map.corrupt", f"{path} is a damaged {kind}: {_one_line(fault)}") from fault


def _opened(file: BinaryIO, kind: str) -> ImageFile:
    """Open an image lazily.

    The decoders are called by themselves: Image.open has a limit of 179 megapixels, and it can be lifted for the
    whole process only.
    """
    file.seek(0)
    if kind == "PNG":
        from PIL.PngImagePlugin import PngImageFile

        return PngImageFile(file)
    if kind == "BMP":
        from PIL.BmpImagePlugin import BmpImageFile

        return BmpImageFile(file)
    if kind == "TIFF":
        from PIL.TiffImagePlugin import TiffImageFile

        return TiffImageFile(file)
    if kind == "JPEG":
        from PIL.JpegImagePlugin import JpegImageFile

        return JpegImageFile(file)
    from PIL.PpmImagePlugin import PpmImageFile

    return PpmImageFile(file)


def _refuse_bombs(path: Path, image: ImageFile, size: int, kind: str) -> None:
    """Refuse a header that promises more than the file can hold, before anything is allocated."""
    width, height = image.size
    if width < 1 or height < 1:
        raise MapError("map.header", f"{path} is {width} x {height} pixels: it has none")
    bits = 1 if image.mode == "1" else 8  # at least; a palette may be packed
    growth = DEFLATE_GROWTH * 8 if kind == "PNG" else OTHER_GROWTH
    if kind in ("BMP", "PPM") and getattr(image, "tile", None) and image.tile[0][0] == "raw":
        growth = 8 // bits if kind == "PPM" else 8
    if width * height > growth * size:
        raise MapError(
            "map.truncated",
            f"{path} cannot be what its header says: {width} x {height} pixels in a file of {size} bytes",
        )
    if width * height > LIMIT:
        raise MapError(
            "map.too-large",
            f"{path} has {width} x {height} pixels, more than the {LIMIT} that are decoded into memory",
            "save it as an 8-bit PGM: that is read where it lies, whatever its size",
        )


def _picture(path: Path, image: Image, *, luma: bool) -> Picture:
    """Samples and shades of a decoded Pillow image, whatever its mode."""
    lost: tuple[MapWarning, ...] = ()
    raw_mode = str([tile[3] for tile in getattr(image, "tile", [])])
    if "16" in raw_mode and not image.mode.startswith("I"):
        lost = (_sixteen_bits(path),)
    clear = image.info.get("transparency")
    if image.mode == "1":
        # Pillow gives booleans of the bytes 0 and 255.
        return Picture(np.asarray(image).view(np.uint8), np.where(np.arange(256) > 0, 255.0, 0.0))
    if image.mode == "L":
        return Picture(np.asarray(image), alphas=_grey_alphas(clear), has_alpha=clear is not None, warnings=lost)
    if image.mode == "P":
        return _from_palette(image, clear, luma=luma)
    if image.mode.startswith("I"):
        return _from_integers(path, image)
    if image.mode in ("F", "LAB", "HSV"):
        raise MapError("map.pixels", f"{path} has pixels of mode {image.mode}; a map needs greys of 8 or 16 bits")
    if image.mode not in ("LA", "RGB", "RGBA") or clear is not None:
        image = image.convert("RGBA" if clear is not None or image.mode in ("La", "PA", "RGBa", "RGBX") else "RGB")
    return _from_bands(image, lost, luma=luma)


def _from_bands(image: Image, lost: tuple[MapWarning, ...], *, luma: bool) -> Picture:
    """Colour and alpha. Where the colours are grey anyway, one band is taken and nothing is computed."""
    from PIL import ImageChops

    has_alpha = image.mode in ("LA", "RGBA")
    alpha = None
    if has_alpha:
        band = image.getchannel("A")
        alpha = None if band.getextrema() == (255, 255) else np.asarray(band)
    if image.mode == "LA":
        return Picture(np.asarray(image.getchannel("L")), alpha=alpha, has_alpha=True, warnings=lost)
    red, green, blue = (image.getchannel(name) for name in "RGB")
    grey = all(ImageChops.difference(red, other).getbbox() is None for other in (green, blue))
    pixels = np.asarray(red) if grey else _grey_of(np.asarray(red), np.asarray(green), np.asarray(blue), luma=luma)
    return Picture(pixels, alpha=alpha, has_alpha=has_alpha, warnings=lost)


def _grey_of(red: Bytes, green: Bytes, blue: Bytes, *, luma: bool) -> Bytes:
    """Grey of colours, some rows at a time, rounded to nearest.

    Luma uses GraphicsMagick's integer weights 306, 601, 117 of 1024 on samples widened to 16 bits.
    """
    grey = np.empty(red.shape, np.uint8)
    shape = red.shape if red.ndim == 2 else (red.shape[0], 1)
    for rows in _bands(shape[0], shape[1]):
        r, g, b = (band[rows].astype(np.uint32) for band in (red, green, blue))
        grey[rows] = (
            (((306 * r + 601 * g + 117 * b) * 257 // 1024) + 128) // 257 if luma else (2 * (r + g + b) + 3) // 6
        )
    return grey


def _from_palette(image: Image, clear: object, *, luma: bool) -> Picture:
    """Indices, with the grey and the alpha of their colours in tables."""
    colours = np.zeros((256, 3), np.uint8)
    listed = np.asarray(image.getpalette("RGB") or [], np.uint8).reshape(-1, 3)[:256]
    colours[: len(listed)] = listed
    shades = _grey_of(colours[:, 0], colours[:, 1], colours[:, 2], luma=True).astype(np.float64)
    if not luma:
        shades = colours.astype(np.float64).sum(axis=1) / 3.0
    alphas = None
    if isinstance(clear, bytes):
        alphas = np.full(256, 255, np.uint8)
        alphas[: len(clear)] = np.frombuffer(clear[:256], np.uint8)
    elif isinstance(clear, int):
        alphas = _grey_alphas(clear)
    return Picture(np.asarray(image), shades, alphas=alphas, has_alpha=alphas is not None)


def _grey_alphas(clear: object) -> Bytes | None:
    """Alpha by sample where one sample value is declared transparent."""
    if not isinstance(clear, int) or not 0 <= clear <= 255:
        return None
    alphas = np.full(256, 255, np.uint8)
    alphas[clear] = 0
    return alphas


def _from_integers(path: Path, image: Image) -> Picture:
    """Samples of 16 bits, or of 32 that hold no more."""
    samples = np.asarray(image)
    low, high = int(samples.min()), int(samples.max())
    if low < 0 or high > 65535:
        raise MapError("map.pixels", f"{path} has samples from {low} to {high}; a map needs greys of 8 or 16 bits")
    return Picture(_eight_bits(samples, 65535), warnings=(_sixteen_bits(path),))


def _one_line(fault: Exception) -> str:
    """The first line of a foreign error, for a sentence of ours."""
    lines = str(fault).strip().splitlines()
    return lines[0].rstrip(".") if lines else type(fault).__name__
