"""Maps larger than memory: read in pieces into a file without a name, and nothing is left of it."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from _legs import with_a_way
from _program import call, files, hall, write_pgm
from _reading import refused
from PIL import Image

from groundplan import Map, read, survey
from groundplan.maps import _canvas, png
from groundplan.simulate import warehouse

Pixels = npt.NDArray[np.uint8]


@pytest.fixture
def small_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A computer that takes a map of a thousand pixels for large; the directory of its temporary files."""
    scratch = tmp_path / "scratch"
    scratch.mkdir()
    monkeypatch.setattr(_canvas, "IN_MEMORY", 1000)
    monkeypatch.setattr(png, "STRIP", 1500)
    monkeypatch.setattr(png, "PIECE", 777)
    monkeypatch.setenv("TMPDIR", str(scratch))
    monkeypatch.setattr("tempfile.tempdir", None)
    return scratch


def noisy() -> Pixels:
    """The hall with a little noise, so that an encoder chooses every filter that there is."""
    random = np.random.default_rng(5)
    noise = random.integers(0, 6, hall().shape, dtype=np.uint8)
    slope = np.add.outer(np.arange(200), np.arange(280)).astype(np.uint8) // 32
    return np.where(hall() == 254, 254 - noise, np.where(hall() == 205, 205, slope)).astype(np.uint8)


def pictures() -> dict[str, Image.Image]:
    grey = Image.fromarray(noisy())
    colour = Image.merge("RGB", [grey, grey.transpose(Image.Transpose.FLIP_LEFT_RIGHT), grey])
    wide = Image.fromarray((noisy().astype(np.uint16) * 257 + 3).astype(np.uint16))
    palette = grey.quantize(16)
    return {
        "grey": grey,
        "one bit": grey.point(lambda value: 255 * (value > 200)).convert("1"),
        "palette of four bits": palette,
        "palette": grey.quantize(200),
        "colour": colour,
        "grey and opaque alpha": Image.merge("LA", [grey, Image.new("L", grey.size, 255)]),
        "colour and opaque alpha": Image.merge("RGBA", [*colour.split(), Image.new("L", grey.size, 255)]),
        "sixteen bits": wide,
    }


@pytest.mark.parametrize("kind", pictures())
def test_a_png_in_strips_is_the_picture(kind: str, tmp_path: Path, small_memory: Path) -> None:
    path = tmp_path / "map.png"
    pictures()[kind].save(path)
    shares: list[float] = []
    parts = read(path, resolution=0.05, progress=shares.append)
    assert isinstance(parts.pixels, np.memmap)
    assert len(shares) > 3 and shares == sorted(shares) and shares[-1] == 1.0
    assert files(small_memory) == set()
    _canvas.IN_MEMORY = 1 << 28  # put back by the fixture
    whole = read(path, resolution=0.05)
    assert not isinstance(whole.pixels, np.memmap)
    assert parts == whole


def test_every_filter_of_a_png_is_taken_off(tmp_path: Path, small_memory: Path) -> None:
    pixels = noisy().astype(np.int32)
    left, up = np.pad(pixels, ((0, 0), (1, 0)))[:, :-1], np.pad(pixels, ((1, 0), (0, 0)))[:-1]
    corner = np.pad(pixels, ((1, 0), (1, 0)))[:-1, :-1]
    near = np.abs(np.stack([up - corner, left - corner, left + up - 2 * corner]))  # to left, up and corner
    paeth = np.choose(near.argmin(axis=0), [left, up, corner])
    guesses = [np.zeros_like(pixels), left, up, (left + up) // 2, paeth]
    rows = [bytes([y % 5]) + ((pixels - guesses[y % 5])[y] % 256).astype(np.uint8).tobytes() for y in range(200)]
    head = (280).to_bytes(4, "big") + (200).to_bytes(4, "big") + bytes([8, 0, 0, 0, 0])
    packed = zlib.compress(b"".join(rows))
    chunks = [(b"IHDR", head), *((b"IDAT", packed[k : k + 999]) for k in range(0, len(packed), 999)), (b"IEND", b"")]
    body = [len(d).to_bytes(4, "big") + n + d + zlib.crc32(n + d).to_bytes(4, "big") for n, d in chunks]
    path = tmp_path / "map.png"
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(body))
    assert np.array_equal(np.asarray(Image.open(path)), noisy())
    assert np.array_equal(read(path, resolution=0.05).pixels, noisy())


def test_a_large_png_that_is_damaged_is_refused(tmp_path: Path, small_memory: Path) -> None:
    path = tmp_path / "map.png"
    Image.fromarray(noisy()).save(path)
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2])
    refused(path, "map.truncated", "map.png", "of 200 rows", resolution=0.05)
    path.write_bytes(whole[: len(whole) // 2] + bytes(3) + whole[len(whole) // 2 + 3 :])
    refused(path, "map.corrupt", "map.png is a damaged PNG", resolution=0.05)
    hidden = Image.merge("LA", [Image.fromarray(noisy()), Image.fromarray(noisy())])
    hidden.save(path)
    refused(path, "map.too-large", "transparent", "8-bit PGM", resolution=0.05)
    assert files(small_memory) == set()


def test_sixteen_bits_of_a_large_pgm_are_scaled_in_pieces(tmp_path: Path, small_memory: Path) -> None:
    path = tmp_path / "map.pgm"
    path.write_bytes(b"P5\n280 200\n65535\n" + (hall().astype(">u2") * 257).tobytes())
    got = read(path, resolution=0.05)
    assert isinstance(got.pixels, np.memmap) and np.array_equal(got.pixels, hall())


def test_a_large_pgm_is_mapped_where_it_lies(tmp_path: Path) -> None:
    path = tmp_path / "large.pgm"
    side = 100_000
    with path.open("wb") as file:
        file.write(b"P5\n%d %d\n255\n" % (side, side))
        try:
            os.truncate(path, file.tell() + side * side)  # ten gigabytes that the disk does not hold
        except OSError:
            pytest.skip("the file system has no files with holes")
    from groundplan.maps.image import read_image

    pixels = read_image(path).pixels
    assert isinstance(pixels, np.memmap) and pixels.shape == (side, side) and not pixels.flags.writeable


def test_a_disk_without_room_is_told(
    tmp_path: Path, small_memory: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "map.png"
    Image.fromarray(hall()).save(path)
    usage = shutil.disk_usage(tmp_path)
    monkeypatch.setattr(shutil, "disk_usage", lambda where: usage._replace(free=55_999))
    ran = call(capsys, "survey", path, "--resolution", "0.05", "-o", tmp_path / "out")
    assert ran.code == 3
    assert "280 x 200" in ran.err and str(small_memory) in ran.err and "55999" in ran.err
    assert "hint: TMPDIR" in ran.err and not (tmp_path / "out").exists()


def test_the_file_is_full_before_the_reading_where_a_limit_says_so(tmp_path: Path) -> None:
    """A real limit of the system: a process that may write no file of more than 50,000 bytes."""
    path = tmp_path / "map.png"
    Image.fromarray(hall()).save(path)
    code = (
        "import resource, signal, sys; from groundplan.maps import _canvas; from groundplan import read, MapError\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, 50_000)); _canvas.IN_MEMORY = 1000\n"
        "try: read(sys.argv[1], resolution=0.05)\n"
        "except MapError as fault: print(fault.code)"
    )
    done = subprocess.run([sys.executable, "-c", code, str(path)], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "map.scratch"


#: Surveys a made map as if memory were small, slowly enough that it can be interrupted while it reads.
SLOWLY = """
import sys, time
from groundplan.maps import _canvas, png
from groundplan.simulate import warehouse
_canvas.IN_MEMORY, png.STRIP, png.PIECE = 1000, 300, 20
put = _canvas.Canvas.put
def slowly(self, top, rows):
    put(self, top, rows)
    print("reading", flush=True)
    time.sleep(10)
_canvas.Canvas.put = slowly
from groundplan.cli import main
sys.exit(main())
"""


def test_control_c_while_reading_leaves_nothing(tmp_path: Path) -> None:
    path = tmp_path / "map.png"
    Image.fromarray(noisy()).save(path)
    (tmp_path / "scratch").mkdir()
    before = files(tmp_path)
    words = [sys.executable, "-c", SLOWLY, "survey", str(path), "--resolution", "0.05", "-o", str(tmp_path / "out")]
    environment = {**os.environ, "TMPDIR": str(tmp_path / "scratch")}
    running = subprocess.Popen(words, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert running.stdout is not None and running.stdout.readline() == "reading\n"
    time.sleep(0.1)
    running.send_signal(signal.SIGINT)
    _, err = running.communicate(timeout=60)
    assert running.returncode == 130 and err == "error: interrupted\n"
    assert files(tmp_path) == before


#: Reads a map under a limit on memory that is not a file's, and prints the sum of some of its pixels.
UNDER_A_LIMIT = """
import resource, sys
import groundplan, groundplan._core, PIL.PngImagePlugin
for name in sys.argv[3:]:
    __import__(name)
def held():
    said = next(line for line in open("/proc/self/status") if line.startswith("VmData:"))
    return int(said.split()[1]) * 1024
limit = held() + int(sys.argv[2])
resource.setrlimit(resource.RLIMIT_DATA, (limit, limit))
map = groundplan.read(sys.argv[1], resolution=0.05, origin=(0, 0))
print(int((map.pixels[::97, ::89].astype("int64")).sum()))
"""


def large_file(path: Path, side: int) -> tuple[Path, list[str], int]:
    """A map of side x side pixels in one of the formats, what must be imported for it, and the sum of a sample."""
    rows = np.tile(hall(), (1, side // 280 + 1))[:, :side]
    pixels = np.tile(rows, (side // 200 + 1, 1))[:side]
    needs: list[str] = []
    if path.suffix == ".png":
        Image.fromarray(pixels).save(path, compress_level=1)
    elif path.suffix == ".pgm":
        write_pgm(path, pixels)
    elif path.suffix == ".tif":
        rasterio: Any = pytest.importorskip("rasterio")
        from rasterio.transform import Affine

        frame = Affine(0.05, 0, 0, 0, -0.05, 0)
        layout = {"tiled": True, "blockxsize": 512, "blockysize": 512, "compress": "deflate"}
        with rasterio.open(
            path, "w", driver="GTiff", width=side, height=side, count=1, dtype="uint8", transform=frame, **layout
        ) as file:
            file.write(pixels, 1)
        needs = ["rasterio", "PIL.TiffImagePlugin"]
    else:
        zarr: Any = pytest.importorskip("zarr")
        zarr.create_array(str(path), shape=pixels.shape, chunks=(512, 512), dtype="u1")[:] = pixels
        needs = ["zarr"]
    return path, needs, int(pixels[::97, ::89].astype("int64").sum())


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux limits the memory of a process so")
@pytest.mark.parametrize("suffix", [".pgm", ".png", ".tif", ".zarr"])
def test_a_map_of_more_pixels_than_there_is_memory_is_read(suffix: str, tmp_path: Path) -> None:
    # 289 megapixels under a limit of 220 megabytes beyond what the libraries take.
    path, needs, expected = large_file(tmp_path / f"large{suffix}", 17_000)
    words = [sys.executable, "-c", UNDER_A_LIMIT, str(path), str(220 * 10**6), *needs]
    done = subprocess.run(
        words, capture_output=True, text=True, check=False, env={**os.environ, "OMP_NUM_THREADS": "1"}
    )
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) == expected


def test_a_map_is_equal_wherever_its_pixels_are(tmp_path: Path, small_memory: Path) -> None:
    Image.fromarray(hall()).save(tmp_path / "map.png")
    parts: Map = read(tmp_path / "map.png", resolution=0.05)
    write_pgm(tmp_path / "map.pgm", hall())
    assert np.array_equal(parts.pixels, read(tmp_path / "map.pgm", resolution=0.05).pixels)


@pytest.mark.parametrize("made", [lambda: np.asarray(warehouse(seed=3).map.pixels), with_a_way], ids=["full", "legs"])
def test_a_large_map_surveyed_in_little_memory_has_the_survey_of_one_of_which_all_is_kept(
    made: Callable[[], Pixels],
) -> None:
    pixels, room = np.full((11_600, 11_600), 205, np.uint8), made()
    height, width = room.shape
    pixels[:height, :width] = room
    pixels[-height:, -width:] = room
    sparing = survey(pixels, resolution=0.05)
    # What the faces are was measured; what they look like is made of the lines when it is asked for.
    assert "subdivision" not in vars(sparing)
    assert f"{len(sparing.occupancy.faces)} faces" in repr(sparing) and "subdivision" not in vars(sparing)
    assert len(sparing.subdivision.areas) == len(sparing.occupancy.faces)
    assert "subdivision" in vars(sparing)
    assert not sparing.problems()
    assert sparing.to_json() == survey(pixels, resolution=0.05, keep=True, threads=1).to_json()
