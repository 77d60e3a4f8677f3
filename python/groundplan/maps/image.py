"""Image files as they lie: a PGM is mapped into memory, the others are decoded once by Pillow.

No pixel is converted where a table can say the same: other maximal values, palettes and one-bit pictures give their
samples, and `shades` says which grey each sample is. Only colour, 16-bit samples and partial transparency are
computed pixel by pixel.
"""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

import numpy as np

from groundplan._errors import MapError
from groundplan.maps import _canvas
from groundplan.maps._map import MapWarning
from groundplan.maps._open import FORMATS, image_format, look, open_file
from groundplan.maps._source import Bytes, Picture, Progress, bands
from groundplan.maps.pgm import eight_bits, read_pgm, sixteen_bits

if TYPE_CHECKING:
    from PIL.Image import Image
    from PIL.ImageFile import ImageFile

#: More pixels than this are refused where a file can only be decoded into memory as a whole.
LIMIT = 2**31

#: No deflate stream grows more than this (zlib's technical notes), and no sane one of another kind more than that.
DEFLATE_GROWTH, OTHER_GROWTH = 1032, 65536


def read_image(path: Path, *, luma: bool = True, progress: Progress | None = None) -> Picture:
    """Read an image file.

    Parameters
    ----------
    path : Path
        The file.
    luma : bool
        How colour becomes grey: Rec. 601 luma as GraphicsMagick computes it, else the mean of the channels.
    progress : callable or None
        Is told the share that was read, where there are so many pixels that they are read in pieces.

    Raises
    ------
    MapError
        ``map.missing``, ``map.directory``, ``map.unreadable``, ``map.empty``, ``map.format``, ``map.header``,
        ``map.truncated``, ``map.too-large``, ``map.corrupt``, ``map.pixels``, ``map.scratch``.
    """
    size, start = look(path)
    kind = image_format(start)
    if kind is None:
        raise MapError("map.format", f"{path} is not an image: it is none of {FORMATS}")
    with open_file(path) as file:
        if kind == "PGM":
            return read_pgm(path, file, size, progress)
        return _decoded(path, file, size, kind, luma=luma, progress=progress)


def _decoded(path: Path, file: BinaryIO, size: int, kind: str, *, luma: bool, progress: Progress | None) -> Picture:
    """An image by Pillow."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            image = opened(file, kind)
            _refuse_bombs(path, image, size, kind)
            if kind == "PNG" and image.width * image.height > _canvas.IN_MEMORY:
                from groundplan.maps.png import in_strips, read_strips

                if in_strips(file):
                    return read_strips(path, file, luma=luma, progress=progress)
            _refuse_large(path, image)
            image.load()
            return picture(path, image, luma=luma)
    except MapError:
        raise
    except MemoryError as fault:
        raise MapError("map.too-large", f"{path} does not fit into memory") from fault
    except Exception as fault:  # Pillow's decoders raise whatever their parsing trips over
        raise MapError("map.corrupt", f"{path} is a damaged {kind}: {_one_line(fault)}") from fault


def opened(file: BinaryIO, kind: str) -> ImageFile:
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
    refuse_growth(path, width, height, size, growth)


def refuse_growth(path: Path, width: int, height: int, size: int, growth: int = OTHER_GROWTH) -> None:
    """Refuse more pixels than a file of that size can be decoded to."""
    if width * height > growth * size:
        raise MapError(
            "map.truncated",
            f"{path} cannot be what its header says: {width} x {height} pixels in a file of {size} bytes",
        )


def _refuse_large(path: Path, image: ImageFile) -> None:
    """Refuse what fills more memory than a map may."""
    width, height = image.size
    if width * height > LIMIT:
        raise MapError(
            "map.too-large",
            f"{path} has {width} x {height} pixels, more than the {LIMIT} that are decoded into memory",
            "save it as an 8-bit PGM: that is read where it lies, whatever its size",
        )


def picture(path: Path, image: Image, *, luma: bool) -> Picture:
    """Samples and shades of a decoded Pillow image, whatever its mode."""
    lost: tuple[MapWarning, ...] = ()
    raw_mode = str([tile[3] for tile in getattr(image, "tile", [])])
    if "16" in raw_mode and not image.mode.startswith("I"):
        lost = (sixteen_bits(path),)
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
    pixels = np.asarray(red) if grey else grey_of(np.asarray(red), np.asarray(green), np.asarray(blue), luma=luma)
    return Picture(pixels, alpha=alpha, has_alpha=has_alpha, warnings=lost)


def grey_of(red: Bytes, green: Bytes, blue: Bytes, *, luma: bool) -> Bytes:
    """Grey of colours, some rows at a time, rounded to nearest.

    Luma uses GraphicsMagick's integer weights 306, 601, 117 of 1024 on samples widened to 16 bits.
    """
    grey = np.empty(red.shape, np.uint8)
    shape = red.shape if red.ndim == 2 else (red.shape[0], 1)
    for rows in bands(shape[0], shape[1]):
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
    shades = grey_of(colours[:, 0], colours[:, 1], colours[:, 2], luma=True).astype(np.float64)
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
    return Picture(eight_bits(path, samples), warnings=(sixteen_bits(path),))


def _one_line(fault: Exception) -> str:
    """The first line of a foreign error, for a sentence of ours."""
    lines = str(fault).strip().splitlines()
    return lines[0].rstrip(".") if lines else type(fault).__name__
