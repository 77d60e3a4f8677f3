"""Maps from pictures: formats, depths, transparency; pictures that are broken."""

from __future__ import annotations

import os
import struct
import warnings
import zlib
from pathlib import Path

import numpy as np
import pytest
from _reading import EXPECTED, Pixels, codes, hall, message, refused, states, with_greys, write_pgm, write_yaml
from PIL import Image

from groundplan._errors import MapError
from groundplan.maps import FREE, OCCUPIED, UNKNOWN, from_array, read


def test_a_raw_pgm_is_mapped_and_not_changed(tmp_path: Path) -> None:
    image = write_pgm(tmp_path / "map.pgm", hall(), comment="# CREATOR: map_saver 0.050 m/pix\n")
    before = image.read_bytes()
    got = read(write_yaml(tmp_path))
    assert isinstance(got.pixels, np.memmap)
    assert not got.pixels.flags.writeable
    assert (states(got) == EXPECTED).all()
    assert (got.resolution, got.origin, got.image) == (0.05, (-1.5, 2.0, 0.0), "map.pgm")
    assert got.warnings == ()
    assert image.read_bytes() == before


@pytest.mark.parametrize("name", ["map.png", "map.bmp", "map.tif", "map.tiff", "map.pgm"])
@pytest.mark.parametrize("mode", ["L", "RGB", "P"])
def test_every_format_and_mode_gives_the_same_map(tmp_path: Path, name: str, mode: str) -> None:
    if name == "map.pgm":
        mode = "L"
    Image.fromarray(hall()).convert(mode).save(tmp_path / name)
    got = read(write_yaml(tmp_path, image=name))
    assert (states(got) == EXPECTED).all()
    assert got.pixels.dtype == np.uint8
    assert got.warnings == ()


@pytest.mark.parametrize("mode", ["LA", "RGBA"])
def test_an_opaque_alpha_costs_nothing(tmp_path: Path, mode: str) -> None:
    Image.fromarray(hall()).convert(mode).save(tmp_path / "map.png")
    got = read(write_yaml(tmp_path, image="map.png"))
    assert (np.asarray(got.pixels) == hall()).all()
    assert (states(got) == EXPECTED).all()


def test_plain_pgm_with_comments_and_another_maxval(tmp_path: Path) -> None:
    numbers = "\n".join(" ".join(str(v) for v in row) for row in with_greys(15, 12, 0))
    (tmp_path / "map.pgm").write_text(f"P2 # plain\n60 # columns\n40\n15\n# samples\n{numbers}\n")
    got = read(write_yaml(tmp_path))
    assert (states(got) == EXPECTED).all()


def test_raw_pgm_with_another_maxval_is_read_by_the_table(tmp_path: Path) -> None:
    write_pgm(tmp_path / "map.pgm", with_greys(100, 80, 0), maxval=100)
    got = read(write_yaml(tmp_path))
    assert isinstance(got.pixels, np.memmap)
    assert (states(got) == EXPECTED).all()


def test_a_header_that_ends_in_carriage_return_and_line_feed(tmp_path: Path) -> None:
    (tmp_path / "map.pgm").write_bytes(b"P5\r\n60 40\r\n255\r\n" + hall().tobytes())
    assert (states(read(write_yaml(tmp_path))) == EXPECTED).all()


def test_sixteen_bits_are_scaled_with_a_warning(tmp_path: Path) -> None:
    wide = hall().astype(np.uint16) * 257
    Image.fromarray(wide).save(tmp_path / "map.png")
    write_pgm(tmp_path / "map.pgm", wide.astype(">u2"), maxval=65535)
    for name in ("map.png", "map.pgm"):
        got = read(write_yaml(tmp_path, image=name))
        assert (np.asarray(got.pixels) == hall()).all()
        assert codes(got) == ["sixteen-bit"]
        assert "65535" in message(got, "sixteen-bit")


def test_one_bit(tmp_path: Path) -> None:
    Image.fromarray(hall() > 100).save(tmp_path / "map.png")
    got = read(write_yaml(tmp_path, image="map.png"))
    assert (states(got) == np.where(hall() > 100, FREE, OCCUPIED)).all()
    assert got.pixels.dtype == np.uint8


def test_a_palette_is_read_by_the_table(tmp_path: Path) -> None:
    image = Image.fromarray(np.searchsorted([0, 205, 254], hall()).astype(np.uint8), mode="P")
    image.putpalette([0, 0, 0, 205, 205, 205, 254, 254, 254])
    image.save(tmp_path / "map.png")
    got = read(write_yaml(tmp_path, image="map.png"))
    assert set(np.unique(got.pixels)) == {0, 1, 2}
    assert (states(got) == EXPECTED).all()
    image.save(tmp_path / "map.png", transparency=2)
    got = read(write_yaml(tmp_path, image="map.png"))
    assert (states(got) == np.where(hall() == 0, OCCUPIED, UNKNOWN)).all()


def test_colour_is_luma_for_nav2_and_mean_for_the_others(tmp_path: Path) -> None:
    Image.new("RGB", (4, 4), (190, 190, 210)).save(tmp_path / "map.png")
    yaml = write_yaml(tmp_path, image="map.png")
    assert read(yaml).pixels[0, 0] == 192
    assert read(yaml, dialect="ros1").pixels[0, 0] == 197


def half_clear(grey: Pixels) -> Pixels:
    alpha = np.full(grey.shape, 255, np.uint8)
    alpha[:, :30] = 254
    alpha[:, :15] = 0
    return np.stack([grey, grey, grey, alpha], axis=2)


@pytest.mark.parametrize("mode", ["trinary", "scale"])
def test_what_is_not_opaque_is_unknown_in_nav2(tmp_path: Path, mode: str) -> None:
    Image.fromarray(half_clear(hall())).save(tmp_path / "map.png")
    got = read(write_yaml(tmp_path, image="map.png", mode=mode))
    assert (states(got)[:, :30] == UNKNOWN).all()
    assert (got.values[got.pixels[:, :30]] == -1).all()
    if mode == "trinary":
        assert (states(got)[:, 30:] == EXPECTED[:, 30:]).all()


def test_transparency_where_all_256_greys_are_in_use(tmp_path: Path) -> None:
    grey = np.resize(np.arange(256, dtype=np.uint8), (40, 60))
    Image.fromarray(half_clear(grey)).save(tmp_path / "map.png")
    for mode in ("trinary", "scale"):
        got = read(write_yaml(tmp_path, image="map.png", mode=mode))
        opaque = from_array(grey, 0.05, mode=mode, occupied_thresh=0.65, free_thresh=0.196)
        assert (states(got)[:, :30] == UNKNOWN).all()
        assert (states(got)[:, 30:] != states(opaque)[:, 30:]).mean() < 0.01


def test_alpha_is_averaged_in_by_the_older_dialects(tmp_path: Path) -> None:
    Image.fromarray(hall()).convert("RGBA").save(tmp_path / "map.png")
    yaml = write_yaml(tmp_path, image="map.png")
    for dialect in ("ros1", "nav2-humble"):
        # (3 * 205 + 255) / 4 = 217.5, so p = 0.147: the unknown grey becomes free, and is found out.
        assert read(yaml, dialect=dialect, unknown="none").states[205] == FREE
        got = read(yaml, dialect=dialect)
        assert (got.states[205], codes(got)) == (UNKNOWN, ["unknown-as-free"])
        assert "grey 205 (p = 0.14" in message(got, "unknown-as-free")
        assert read(yaml, dialect=dialect, unknown=205).states[205] == UNKNOWN
    Image.fromarray(half_clear(hall())).save(tmp_path / "map.png")
    got = read(yaml, dialect="ros1", unknown="none")
    assert got.pixels[15, 0] == (3 * 205 + 0 + 2) // 4
    got = read(yaml, dialect="ros1", mode="scale", unknown="none", free_thresh=0.1)
    assert (states(got)[10:20, 20:29] == FREE).all()  # alpha 254 is opaque enough
    assert (got.values[got.pixels[:4, :15]] == -1).all()
    assert (got.values[got.pixels[:4, 15:]] > 0).all()


def test_missing_empty_and_directory(tmp_path: Path) -> None:
    refused(tmp_path / "gone.yaml", "map.missing", "gone.yaml")
    refused(tmp_path / "gone.png", "map.missing", "gone.png", resolution=0.05)
    refused(tmp_path, "map.directory", str(tmp_path))
    (tmp_path / "folder.yaml").mkdir()
    refused(tmp_path / "folder.yaml", "map.directory")
    (tmp_path / "empty.pgm").write_bytes(b"")
    refused(tmp_path / "empty.pgm", "map.empty", resolution=0.05)
    (tmp_path / "text.txt").write_text("hello")
    refused(tmp_path / "text.txt", "map.format", "text.txt", resolution=0.05)
    refused(Path("bad\0name.png"), "map.unreadable", resolution=0.05)


def test_what_is_not_a_regular_file_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.pgm")
    refused(tmp_path / "pipe.pgm", "map.unreadable", "pipe.pgm", resolution=0.05)


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_no_permission(tmp_path: Path) -> None:
    path = write_pgm(tmp_path / "map.pgm", hall())
    path.chmod(0)
    refused(path, "map.unreadable", "map.pgm", "ermission", resolution=0.05)


@pytest.mark.parametrize(
    ("data", "code", "words"),
    [
        (b"P5\n60 40\n255\n" + bytes(100), "map.truncated", ("2400", "100")),
        (b"P5\n30000 30000\n255\n" + bytes(1000), "map.truncated", ("900000000", "1000")),
        (b"P2\n30000 30000\n255\n" + b"0 " * 500, "map.truncated", ("30000", "1000")),
        (b"P2\n2 2\n255\n1   2  3\n", "map.truncated", ("4 numbers", "3")),
        (b"P2\n2 2\n255\n1 2 x 4\n", "map.corrupt", ()),
        (b"P2\n2 2\n255\n1 2 3 99999\n", "map.corrupt", ("99999",)),
        (b"P5\n0 40\n255\n", "map.header", ("0 x 40",)),
        (b"P5\n60 40\n0\n" + bytes(2400), "map.header", ("0",)),
        (b"P5\n60 40\n70000\n" + bytes(4800), "map.header", ("70000",)),
        (b"P5\n-3 40\n255\n", "map.header", ()),
        (b"P5\n" + b"9" * 5000 + b" 40\n255\n", "map.header", ()),
        (b"P5\n# " + b"x" * 100000, "map.header", ()),
        (b"P5\n60", "map.header", ()),
        (b"P6\n30000 30000\n255\n" + bytes(1000), "map.truncated", ("30000",)),
        (b"P4\n30000 30000\n" + bytes(1000), "map.truncated", ("30000",)),
        (b"BM" + bytes(40), "map.corrupt", ()),
        (b"II*\0" + bytes(20), "map.corrupt", ()),
        (b"\x89PNG\r\n\x1a\n" + bytes(20), "map.corrupt", ()),
    ],
)
def test_broken_images(tmp_path: Path, data: bytes, code: str, words: tuple[str, ...]) -> None:
    path = tmp_path / "map.pgm"
    path.write_bytes(data)
    refused(path, code, str(path), *words, resolution=0.05)
    refused(write_yaml(tmp_path), code, str(path), *words)


def png(width: int, height: int, data: bytes, *, interlaced: bool = False) -> bytes:
    """A grey PNG whose header says this size, whatever its data hold."""

    def chunk(kind: bytes, body: bytes) -> bytes:
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    header = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, interlaced)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", data) + chunk(b"IEND", b"")


def test_a_png_that_lies_about_its_size(tmp_path: Path) -> None:
    path = tmp_path / "map.png"
    path.write_bytes(png(30000, 30000, zlib.compress(bytes(1000)) + bytes(1000)))
    refused(path, "map.truncated", "30000 x 30000", resolution=0.05)


def test_a_decompression_bomb_is_refused_and_a_large_map_is_not(tmp_path: Path) -> None:
    path = tmp_path / "map.png"
    path.write_bytes(png(70000, 70000, zlib.compress(bytes(1000)) + bytes(5_000_000), interlaced=True))
    refused(path, "map.too-large", "70000 x 70000", resolution=0.05)
    path.write_bytes(png(70000, 70000, zlib.compress(bytes(1000)) + bytes(5_000_000)))
    refused(path, "map.truncated", "0 of 70000 rows", resolution=0.05)
    limit = Image.MAX_IMAGE_PIXELS
    big = Image.new("1", (13500, 13500), 1)  # 182 megapixels, beyond the 179 that Pillow opens
    big.save(path)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        got = read(path, resolution=0.05)
    assert (got.height, got.width) == (13500, 13500)
    assert limit == Image.MAX_IMAGE_PIXELS


def test_damaged_copies_give_a_map_or_one_error(tmp_path: Path) -> None:
    random = np.random.default_rng(1)
    for name in ("map.png", "map.bmp", "map.tif", "map.jpg", "map.pgm"):
        path = tmp_path / name
        Image.fromarray(hall()).save(path)
        whole = path.read_bytes()
        for k in range(60):
            data = bytearray(whole)
            if k % 2:
                data = data[: int(random.integers(1, len(data)))]
            else:
                for place in random.integers(0, min(len(data), 300), 4):
                    data[place] = int(random.integers(256))
            path.write_bytes(bytes(data))
            try:
                got = read(path, resolution=0.05)
            except MapError as error:
                assert error.code.startswith("map.")
                assert "\n" not in str(error)
            else:
                assert got.pixels.ndim == 2


def test_pixels_that_are_no_greys(tmp_path: Path) -> None:
    path = tmp_path / "map.tif"
    Image.fromarray(np.zeros((4, 4), np.float32)).save(path)
    refused(path, "map.pixels", "F", resolution=0.05)
    Image.fromarray(np.full((4, 4), 1 << 20, np.int32)).save(path)
    refused(path, "map.pixels", str(1 << 20), resolution=0.05)
