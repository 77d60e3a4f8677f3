"""What reading a large map costs in time and memory, format by format: bench/large.py [SIDE] [--survey].

The example warehouse is laid side by side to SIDE x SIDE pixels (20,000) and written in each format that is read in
pieces; each is read by a process of its own, which is watched. Memory is what the process holds for itself; pages of
files that are mapped are not in it, the system takes them back when it needs them. With --survey the survey is in it.

Ends with exit code 1 when reading takes more than a quarter of a byte of memory a pixel, or 256 MiB.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import numpy.typing as npt
from _maps import laid_out
from _watched import watched
from PIL import Image

from groundplan._cli.arguments import count

SIDE, LEAST_BAR = 20_000, 256 << 20

#: Says how long reading took, and keeps still until it was looked at.
CHILD = """
import sys, time
import numpy, PIL.PngImagePlugin, groundplan, groundplan._core
for name in sys.argv[3:]:
    __import__(name)
print("ready", flush=True)
sys.stdin.readline()
since = time.perf_counter()
map = groundplan.read(sys.argv[1], resolution=0.05, origin=(0, 0))
print(time.perf_counter() - since, flush=True)
if sys.argv[2] == "survey":
    since = time.perf_counter()
    groundplan.survey(map)
    print(time.perf_counter() - since, flush=True)
"""


def write_pgm(path: Path, pixels: npt.NDArray[np.uint8]) -> None:
    """A raw PGM."""
    with path.open("wb") as file:
        file.write(b"P5\n%d %d\n255\n" % pixels.shape[::-1])
        pixels.tofile(file)


def write_png(path: Path, pixels: npt.NDArray[np.uint8]) -> None:
    """A PNG of greys."""
    Image.fromarray(pixels).save(path, compress_level=1)


def write_tiff(path: Path, pixels: npt.NDArray[np.uint8]) -> None:
    """A GeoTIFF in tiles of 512 pixels."""
    import rasterio
    from rasterio.transform import Affine

    layout = {"tiled": True, "blockxsize": 512, "blockysize": 512, "compress": "deflate"}
    size = {"width": pixels.shape[1], "height": pixels.shape[0], "count": 1, "dtype": "uint8"}
    with rasterio.open(path, "w", driver="GTiff", transform=Affine(0.05, 0, 0, 0, -0.05, 0), **size, **layout) as file:
        file.write(pixels, 1)


def write_zarr(path: Path, pixels: npt.NDArray[np.uint8]) -> None:
    """A Zarr array in chunks of 1,024 pixels."""
    import zarr

    zarr.create_array(str(path), shape=pixels.shape, chunks=(1024, 1024), dtype="u1")[:] = pixels


#: A writer, and what is imported before the process is watched.
FORMATS: dict[str, tuple[Callable[[Path, npt.NDArray[np.uint8]], None], list[str]]] = {
    "pgm": (write_pgm, []),
    "png": (write_png, ["groundplan.maps.png"]),
    "tif": (write_tiff, ["rasterio", "PIL.TiffImagePlugin"]),
    "zarr": (write_zarr, ["zarr"]),
}


def measure(path: Path, modules: list[str], *, survey: bool) -> tuple[list[float], int]:
    """Seconds of reading, and of surveying, and the greatest memory on top of what was held before."""
    said, most = watched(["-c", CHILD, str(path), "survey" if survey else "read", *modules])
    return [float(line) for line in said.splitlines()], most


def main() -> int:
    """Make the maps, measure, print the table, hold it to the bar."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("side", nargs="?", type=count, default=SIDE)
    parser.add_argument("--survey", action="store_true", help="survey each map too")
    words = parser.parse_args()
    survey, side = words.survey, words.side
    if not Path("/proc/self/status").exists():
        print("the memory of a process is only measured on Linux")
        return 0
    pixels = laid_out(side).pixels
    bar = max(LEAST_BAR, side * side // 4)
    print(f"{side} x {side} pixels, {side * side / 2**20:.0f} MiB at a byte each; bar: {bar >> 20} MiB")
    print("format  MiB on disk  read s  " + ("survey s  " if survey else "") + "peak MiB")
    missed = False
    with tempfile.TemporaryDirectory() as directory:
        for suffix, (write, modules) in FORMATS.items():
            path = Path(directory) / f"map.{suffix}"
            write(path, pixels)
            parts = [part for part in path.rglob("*") if part.is_file()] if path.is_dir() else [path]
            size = sum(part.stat().st_size for part in parts)
            times, peak = measure(path, modules, survey=survey)
            over = peak > bar and not survey
            missed |= over
            shown = "  ".join(f"{value:{width}.2f}" for value, width in zip(times, (6, 8), strict=False))
            print(f"{suffix:6}  {size >> 20:11}  {shown}  {peak >> 20:8}{'  MISSED' if over else ''}", flush=True)
    return int(missed)


if __name__ == "__main__":
    sys.exit(main())
