"""Reading maps: real files, written by the tests themselves, and the collection of maps beside the repository."""

from __future__ import annotations

import math
import os
import struct
import warnings
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from _reading import refused, states
from PIL import Image

import groundplan
from groundplan._errors import MapError
from groundplan.maps import FREE, OCCUPIED, UNKNOWN, Map, from_array, read

Pixels = npt.NDArray[Any]

PLAIN = {
    "image": "map.pgm",
    "resolution": "0.05",
    "origin": "[-1.5, 2.0, 0.0]",
    "negate": "0",
    "occupied_thresh": "0.65",
    "free_thresh": "0.196",
}


def write_yaml(folder: Path, **fields: str | None) -> Path:
    """A map_server YAML with these fields changed, or left out where None."""
    said = {**PLAIN, **fields}
    path = folder / "map.yaml"
    path.write_text("".join(f"{key}: {value}\n" for key, value in said.items() if value is not None))
    return path


def write_pgm(path: Path, pixels: Pixels, maxval: int = 255, comment: str = "") -> Path:
    height, width = pixels.shape
    path.write_bytes(b"P5\n%s%d %d\n%d\n" % (comment.encode(), width, height, maxval) + pixels.tobytes())
    return path


def hall() -> Pixels:
    """40 x 60 pixels: unknown 205 around a room of 254 with walls of 0. Not symmetric, so that a flip shows."""
    pixels = np.full((40, 60), 205, np.uint8)
    pixels[5:30, 10:50] = 0
    pixels[6:29, 11:49] = 254
    return pixels


def with_greys(free: int, unknown: int, wall: int) -> Pixels:
    return np.choose(np.searchsorted([0, 205, 254], hall()), [wall, unknown, free]).astype(np.uint8)


def codes(of: Map) -> list[str]:
    return [warning.code for warning in of.warnings]


def message(of: Map, code: str) -> str:
    return next(warning.message for warning in of.warnings if warning.code == code)


def shares(of: Map) -> tuple[float, ...]:
    seen = states(of)
    return tuple(100 * float((seen == state).mean()) for state in (FREE, OCCUPIED, UNKNOWN))


EXPECTED = np.choose(np.searchsorted([0, 205, 254], hall()), [OCCUPIED, UNKNOWN, FREE])


# The three dialects


def as_printed(c: int, dialect: str, mode: str, *, negate: bool, occupied: float, free: float) -> int:
    """What map_server makes of an opaque grey, written out pixel by pixel after the three sources."""
    if dialect == "nav2":
        if mode == "raw":
            return c if c <= 100 else -1
        p = np.float32(c) / np.float32(255)
        p = p if negate else np.float32(1) - p
        high, low = np.float32(occupied), np.float32(free)
        if p <= low:
            return 0
        if p >= high:
            return 100
        part = (p - low) / np.float32(occupied - free) * np.float32(100)
        return -1 if mode == "trinary" else math.floor(float(part) + 0.5)
    shade = c / 255
    if mode == "raw":
        grey = 255 - c if negate and dialect == "ros1" else c
        return grey if grey <= 100 else -1
    dark = shade if negate else ((255 - c) / 255 if dialect == "ros1" else 1.0 - shade)
    if dark > occupied:
        return 100
    if dark < free:
        return 0
    if mode == "trinary":
        return -1
    ratio = (dark - free) / (occupied - free)
    return int(1 + 98 * ratio) if dialect == "ros1" else round(100 * ratio)


@pytest.mark.parametrize("negate", [False, True])
@pytest.mark.parametrize("mode", ["trinary", "scale", "raw"])
@pytest.mark.parametrize("dialect", ["nav2", "nav2-humble", "ros1"])
@pytest.mark.parametrize("thresholds", [(0.65, 0.196), (0.65, 0.25), (0.6, 0.2), (0.9, 0.1)])
def test_every_grey_means_what_the_dialect_says(
    dialect: str, mode: str, negate: bool, thresholds: tuple[float, float]
) -> None:
    occupied, free = thresholds
    picture = np.arange(256, dtype=np.uint8).reshape(16, 16)
    got = from_array(
        picture,
        0.05,
        dialect=dialect,
        mode=mode,
        negate=negate,
        occupied_thresh=occupied,
        free_thresh=free,
        unknown="none",
    )
    wanted = [as_printed(c, dialect, mode, negate=negate, occupied=occupied, free=free) for c in range(256)]
    assert got.values.tolist() == wanted
    assert got.values.dtype == np.int8
    assert got.states.dtype == np.uint8


def test_the_dialects_differ_where_p_equals_the_threshold() -> None:
    picture = np.full((4, 4), 204, np.uint8)  # p = 0.2, in float32 0.19999999 or 0.2
    options = {"occupied_thresh": 0.65, "free_thresh": 0.2, "unknown": "none"}
    states_by_dialect = {
        name: int(from_array(picture, 0.05, dialect=name, **options).states[204])  # type: ignore[arg-type]
        for name in ("nav2", "nav2-humble", "ros1")
    }
    assert states_by_dialect["nav2"] == FREE
    assert states_by_dialect["ros1"] == UNKNOWN


def test_scale_keeps_numbers_and_takes_the_state_by_percent() -> None:
    picture = np.arange(256, dtype=np.uint8).reshape(16, 16)
    got = from_array(picture, 0.05, mode="scale", occupied_thresh=0.9, free_thresh=0.1, unknown="none")
    assert got.values[128] == 50
    assert got.states[128] == UNKNOWN
    assert (got.states == np.where(got.values >= 65, OCCUPIED, np.where(got.values <= 25, FREE, UNKNOWN))).all()


# Files


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


# Alpha


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


# What the greys mean


def test_unknown_205_is_not_free_whatever_free_thresh_says(tmp_path: Path) -> None:
    write_pgm(tmp_path / "map.pgm", hall())
    yaml = write_yaml(tmp_path, free_thresh="0.25")
    got = read(yaml)
    assert (states(got) == EXPECTED).all()
    assert codes(got) == ["unknown-as-free"]
    for word in ("205", "0.196", "0.25", "%", "--unknown none", "--unknown 205"):
        assert word in message(got, "unknown-as-free")
    literal = read(yaml, unknown="none")
    assert (states(literal) == np.where(hall() == 0, OCCUPIED, FREE)).all()
    assert literal.warnings == ()
    for said in (205, [205], "205"):
        told = read(yaml, unknown=said)
        assert (states(told) == EXPECTED).all()
        assert told.warnings == ()


def test_unknown_230_and_grey_walls_without_a_yaml(tmp_path: Path) -> None:
    path = write_pgm(tmp_path / "map.pgm", with_greys(255, 230, 127))
    got = read(path, resolution=0.05)
    assert (states(got) == EXPECTED).all()
    assert codes(got) == ["limits-assumed", "unknown-as-free"]
    for word in ("--occupied-thresh", "--free-thresh", "--unknown"):
        assert word in message(got, "limits-assumed")
    stated = read(path, resolution=0.05, occupied_thresh=0.3, free_thresh=0.05)
    assert (states(stated) == EXPECTED).all()
    assert stated.warnings == ()


def test_stated_thresholds_are_kept_and_their_nonsense_is_told(tmp_path: Path) -> None:
    write_pgm(tmp_path / "map.pgm", with_greys(255, 230, 127))
    got = read(write_yaml(tmp_path))
    assert shares(got)[1] == 0
    assert codes(got) == ["unknown-as-free", "no-occupied"]
    assert "--occupied-thresh 0.3 " in message(got, "no-occupied")


def test_a_picture_without_white_without_a_yaml(tmp_path: Path) -> None:
    path = write_pgm(tmp_path / "map.pgm", np.where(hall() == 0, np.uint8(60), np.uint8(200)))
    got = read(path, resolution=0.05)
    assert (states(got) == np.where(hall() == 0, OCCUPIED, FREE)).all()
    assert codes(got) == ["limits-assumed"]


def test_furniture_grey_and_mixed_whites_stay_free(tmp_path: Path) -> None:
    pixels = hall()
    pixels[10:15, 15:25] = 211  # 2 % of the picture
    pixels[20:25, 20:40] = 255
    write_pgm(tmp_path / "map.pgm", pixels)
    got = read(write_yaml(tmp_path))
    assert (states(got) == EXPECTED).all()
    assert got.warnings == ()


def test_a_light_floor_on_white_paper_stays_free_and_is_told(tmp_path: Path) -> None:
    pixels = with_greys(235, 255, 0)
    write_pgm(tmp_path / "map.pgm", pixels)
    got = read(write_yaml(tmp_path))
    assert got.states[235] == FREE
    assert codes(got) == ["grey-as-free"]
    assert "--unknown 235" in message(got, "grey-as-free")


def test_smooth_probabilities_stay_free() -> None:
    pixels = with_greys(254, 127, 0)
    room = pixels == 254
    pixels[room] = np.random.default_rng(0).integers(225, 256, int(room.sum()))
    got = from_array(pixels, 0.05)
    assert (states(got) == EXPECTED).all()
    assert got.warnings == ()


def test_a_black_outside_is_told() -> None:
    pixels = np.zeros((50, 50), np.uint8)
    pixels[20:30, 5:45] = 255
    got = from_array(pixels, 0.05)
    assert codes(got) == ["outside-occupied"]
    assert "--negate" in message(got, "outside-occupied")


def test_a_second_outside_read_as_occupied_is_told() -> None:
    pixels = hall()
    pixels[pixels == 205] = 80
    got = from_array(pixels, 0.05)
    assert "unknown-as-occupied" in codes(got)
    assert "--unknown 80" in message(got, "unknown-as-occupied")


def test_unknown_greys_that_do_not_occur_are_told() -> None:
    got = from_array(hall(), 0.05, unknown=[205, 90])
    assert codes(got) == ["unknown-absent"]
    assert "90" in message(got, "unknown-absent")


def test_negate(tmp_path: Path) -> None:
    write_pgm(tmp_path / "map.pgm", 255 - with_greys(255, 128, 0))
    for said in ("1", "true", "yes", "'true'"):
        assert (states(read(write_yaml(tmp_path, negate=said))) == EXPECTED).all()
    assert (states(read(write_yaml(tmp_path, negate="0"), negate=True)) == EXPECTED).all()
    assert read(write_yaml(tmp_path, negate="1", mode="raw", image="map.pgm")).values[90] == 90


@pytest.mark.parametrize(
    ("grey", "told"),
    [(255, ["no-occupied"]), (0, ["no-free-space"]), (205, ["no-free-space", "no-occupied"])],
)
@pytest.mark.parametrize("size", [(1, 1), (30, 20), (1, 50), (50, 1)])
def test_one_grey_is_a_valid_map(tmp_path: Path, grey: int, told: list[str], size: tuple[int, int]) -> None:
    path = write_pgm(tmp_path / "map.pgm", np.full(size, grey, np.uint8))
    for got in (read(path, resolution=0.05), read(write_yaml(tmp_path))):
        assert codes(got) == told
        assert (got.height, got.width) == size
    # Where a grey is taken as it is no threshold helps.
    raw = read(path, resolution=0.05, mode="raw")
    assert codes(raw)
    assert all("--mode trinary" in message(raw, code) for code in codes(raw))


# The YAML


def test_a_bare_image_needs_a_resolution(tmp_path: Path) -> None:
    path = write_pgm(tmp_path / "map.pgm", hall())
    error = refused(path, "map.resolution", str(path))
    assert "--resolution" in (error.hint or "")
    got = read(path, resolution=0.1, origin=(1, 2))
    assert (got.resolution, got.origin) == (0.1, (1.0, 2.0, 0.0))
    assert read(path, resolution=0.1).origin == (0.0, 0.0, 0.0)
    assert read(path, resolution=0.1, origin=(1, 2, 0.5)).origin == (1.0, 2.0, 0.5)


@pytest.mark.parametrize("yaw", ["nan", ".nan", "-nan", "-.NaN"])
def test_a_yaw_that_is_nan_is_zero(tmp_path: Path, yaw: str) -> None:
    write_pgm(tmp_path / "map.pgm", hall())
    got = read(write_yaml(tmp_path, origin=f"[1.0, 2.0, {yaw}]"))
    assert got.origin == (1.0, 2.0, 0.0)
    assert codes(got) == ["yaw-nan"]
    assert "map.yaml" in message(got, "yaw-nan")


def test_numbers_as_cpp_writes_them(tmp_path: Path) -> None:
    write_pgm(tmp_path / "map.pgm", hall())
    got = read(write_yaml(tmp_path, resolution="5e-2", origin="[-1e1, 2E0, 1.5707963]"))
    assert got.resolution == 0.05
    assert got.origin == (-10.0, 2.0, 1.5707963)


def test_missing_fields_get_what_map_saver_writes(tmp_path: Path) -> None:
    write_pgm(tmp_path / "map.pgm", hall())
    got = read(write_yaml(tmp_path, occupied_thresh=None, free_thresh=None, negate=None))
    assert (states(got) == EXPECTED).all()
    assert codes(got) == ["fields-missing"]
    for word in ("0.65", "0.196", "negate"):
        assert word in message(got, "fields-missing")


def test_arguments_beat_the_yaml(tmp_path: Path) -> None:
    write_pgm(tmp_path / "map.pgm", hall())
    yaml = write_yaml(tmp_path, resolution="0", origin=None)
    refused(yaml, "map.resolution")
    got = read(write_yaml(tmp_path, resolution=None, origin=None), resolution=0.2, origin=(3, 4, 0.1))
    assert (got.resolution, got.origin) == (0.2, (3.0, 4.0, 0.1))


def test_an_image_path_of_another_computer_is_looked_for_beside_the_yaml(tmp_path: Path) -> None:
    write_pgm(tmp_path / "map.pgm", hall())
    got = read(write_yaml(tmp_path, image="/no/such/place/map.pgm"))
    assert codes(got) == ["image-beside"]
    absolute = read(write_yaml(tmp_path, image=str(tmp_path / "map.pgm")))
    assert absolute.warnings == ()
    assert absolute.image == "map.pgm"


def test_a_rounded_resolution_is_told_where_it_matters(tmp_path: Path) -> None:
    write_pgm(tmp_path / "map.pgm", np.tile(hall(), (20, 20)))
    assert codes(read(write_yaml(tmp_path, resolution="0.033"))) == ["resolution-rounded"]
    assert codes(read(write_yaml(tmp_path, resolution="0.0333"))) == []
    assert codes(read(write_yaml(tmp_path, resolution="0.025"))) == []
    write_pgm(tmp_path / "map.pgm", hall())
    assert codes(read(write_yaml(tmp_path, resolution="0.033"))) == []


@pytest.mark.parametrize(
    ("fields", "code", "word"),
    [
        ({"resolution": "0"}, "map.resolution", "0"),
        ({"resolution": "-0.05"}, "map.resolution", "-0.05"),
        ({"resolution": "nan"}, "map.resolution", "nan"),
        ({"resolution": ".inf"}, "map.resolution", "inf"),
        ({"resolution": "1e300"}, "map.resolution", "1e300"),
        ({"resolution": "fine"}, "map.resolution", "fine"),
        ({"resolution": "[0.05]"}, "map.resolution", "[0.05]"),
        ({"resolution": "true"}, "map.resolution", "True"),
        ({"resolution": "0x" + "f" * 9000}, "map.resolution", "digits"),
        ({"resolution": None}, "map.resolution", "states no resolution"),
        ({"origin": "[1.0, 2.0]"}, "map.origin", "[1.0, 2.0]"),
        ({"origin": "[1.0, 2.0, 3.0, 4.0]"}, "map.origin", "4.0"),
        ({"origin": "[nan, 2.0, 0.0]"}, "map.origin", "nan"),
        ({"origin": "[1.0, 1e40, 0.0]"}, "map.origin", "1e40"),
        ({"origin": "[1.0, .inf, 0.0]"}, "map.origin", "inf"),
        ({"origin": "[1.0, 2.0, .inf]"}, "map.origin", "inf"),
        ({"origin": "[1.0, here, 0.0]"}, "map.origin", "here"),
        ({"origin": "{x: 1}"}, "map.origin", "x"),
        ({"origin": "5"}, "map.origin", "5"),
        ({"origin": None}, "map.origin", "states no origin"),
        ({"negate": "2"}, "map.negate", "2"),
        ({"negate": "maybe"}, "map.negate", "maybe"),
        ({"mode": "quaternary"}, "map.mode", "quaternary"),
        ({"occupied_thresh": "65"}, "map.thresholds", "65"),
        ({"free_thresh": "nan"}, "map.thresholds", "nan"),
        ({"free_thresh": "low"}, "map.thresholds", "low"),
        ({"free_thresh": "0.7"}, "map.thresholds", "0.7"),
        ({"image": None}, "map.image", "names no image"),
        ({"image": "[map.pgm]"}, "map.image", "map.pgm"),
        ({"image": "gone.pgm"}, "map.missing", "gone.pgm"),
        ({"image": "."}, "map.directory", "directory"),
        ({"image": "x" * 5000}, "map.unreadable", "too long"),
    ],
)
def test_a_yaml_that_cannot_be(tmp_path: Path, fields: dict[str, str], code: str, word: str) -> None:
    write_pgm(tmp_path / "map.pgm", hall())
    error = refused(write_yaml(tmp_path, **fields), code, word)
    assert str(tmp_path) in str(error)


@pytest.mark.parametrize(
    ("data", "code"),
    [
        (b"", "map.empty"),
        (b"  \n", "map.empty"),
        (b"just text", "map.yaml"),
        (b"- image: map.pgm\n", "map.yaml"),
        (b"image: [map.pgm\n", "map.yaml"),
        (b"image: m\xe4p.pgm\n", "map.yaml"),
        (b"\x89PNG\r\n\x1a\n", "map.yaml"),
        (b"image: 2024-13-45\n", "map.yaml"),
        (b"image: !!python/object:os.system x\n", "map.yaml"),
        (b"[" * 5000, "map.yaml"),
        (b"#" * (1 << 21), "map.yaml"),
    ],
)
def test_a_file_that_is_no_map_server_yaml(tmp_path: Path, data: bytes, code: str) -> None:
    path = tmp_path / "map.yaml"
    path.write_bytes(data)
    refused(path, code, str(path))


def test_a_yaml_with_a_byte_order_mark_and_windows_line_ends(tmp_path: Path) -> None:
    write_pgm(tmp_path / "map.pgm", hall())
    yaml = write_yaml(tmp_path)
    yaml.write_bytes(b"\xef\xbb\xbf" + yaml.read_bytes().replace(b"\n", b"\r\n"))
    assert (states(read(yaml)) == EXPECTED).all()


@pytest.mark.parametrize(
    ("option", "code"),
    [
        ({"dialect": "ros3"}, "map.dialect"),
        ({"unknown": "all"}, "map.unknown"),
        ({"unknown": 300}, "map.unknown"),
        ({"unknown": [1.5]}, "map.unknown"),
        ({"mode": "Trinity"}, "map.mode"),
        ({"resolution": -1}, "map.resolution"),
        ({"resolution": float("nan")}, "map.resolution"),
        ({"origin": (1,)}, "map.origin"),
        ({"origin": "1 2"}, "map.origin"),
        ({"occupied_thresh": 1.5}, "map.thresholds"),
        ({"occupied_thresh": 0.1, "free_thresh": 0.1}, "map.thresholds"),
    ],
)
def test_an_argument_that_cannot_be(tmp_path: Path, option: dict[str, object], code: str) -> None:
    write_pgm(tmp_path / "map.pgm", hall())
    refused(write_yaml(tmp_path), code, **option)


def test_one_threshold_given_alone_moves_the_other_out_of_its_way(tmp_path: Path) -> None:
    path = write_pgm(tmp_path / "map.pgm", hall())
    assert read(path, resolution=0.05, free_thresh=0.7, unknown=205).states[0] == OCCUPIED
    assert read(path, resolution=0.05, occupied_thresh=0.1, unknown=205).states[254] == FREE


# Broken images


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


# Arrays


def test_an_occupancy_grid_is_flipped_and_not_copied() -> None:
    data = np.array([[0, 100, -1], [50, 25, 65], [127, -128, 101]], np.int8)
    got = from_array(data, 0.1, (1.0, 2.0, 0.5))
    assert np.shares_memory(got.pixels, data)
    assert got.values[got.pixels].tolist() == [[-1, -1, -1], [50, 25, 65], [0, 100, -1]]
    assert states(got).tolist() == [
        [UNKNOWN, UNKNOWN, UNKNOWN],
        [UNKNOWN, FREE, OCCUPIED],
        [FREE, OCCUPIED, UNKNOWN],
    ]
    assert got.origin == (1.0, 2.0, 0.5)
    assert from_array(data, 0.1, occupied_thresh=0.5).states[50] == OCCUPIED


def test_a_bool_array_is_true_where_occupied() -> None:
    walls = hall() == 0
    got = from_array(walls, 0.05, image="hall")
    assert np.shares_memory(got.pixels, walls)
    assert (states(got) == np.where(walls, OCCUPIED, FREE)).all()
    assert got.image == "hall"
    assert got.warnings == ()


def test_a_grey_array_is_not_copied() -> None:
    pixels = hall()
    got = from_array(pixels, 0.05, (0.0, 0.0))
    assert np.shares_memory(got.pixels, pixels)
    assert (states(got) == EXPECTED).all()


@pytest.mark.parametrize(
    "array", [np.zeros((2, 2, 3), np.uint8), np.zeros((0, 4), np.uint8), np.zeros((2, 2)), np.zeros((2, 2), np.int64)]
)
def test_arrays_that_are_no_maps(array: Pixels) -> None:
    with pytest.raises(MapError) as caught:
        from_array(array, 0.05)
    assert caught.value.code == "map.pixels"


def test_masked_pixels_are_refused_and_a_mask_of_none_is_not() -> None:
    greys = hall()
    for take in (from_array, lambda array, resolution: groundplan.survey(array, resolution=resolution)):
        with pytest.raises(MapError, match="12 pixels of the array are masked") as caught:
            take(np.ma.masked_array(greys, np.arange(greys.size).reshape(greys.shape) < 12), 0.05)
        assert caught.value.code == "map.pixels" and ".filled(205)" in str(caught.value.hint)
    none = from_array(np.ma.masked_array(greys), 0.05)
    assert type(none.pixels) is np.ndarray and (states(none) == EXPECTED).all()
    with pytest.raises(groundplan.ParameterError, match="pixels of the patch are masked"):
        survey = groundplan.survey(greys, resolution=0.05)
        survey.update(np.ma.masked_array(greys[:4, :4], np.eye(4, dtype=bool)), 0, 0)


def test_the_hint_for_shares_of_one_makes_a_map() -> None:
    shares = np.array([[0.0, 1.0], [np.nan, 0.5]])
    with pytest.raises(MapError) as caught:
        from_array(shares, 0.05)
    assert "np.where(np.isfinite(a), np.rint(100 * a), -1).astype('int8')" in str(caught.value.hint)
    got = from_array(np.where(np.isfinite(shares), np.rint(100 * shares), -1).astype("int8"), 0.05)
    assert got.values[got.pixels].tolist() == [[-1, 50], [0, 100]]


@pytest.mark.parametrize("origin", [[1.0, 2.0], (1, 2, 0.0), np.array([1.0, 2.0, 0.0])])
def test_an_origin_is_a_list_a_tuple_or_an_array(origin: Any) -> None:
    assert groundplan.survey(hall(), resolution=0.05, origin=origin).map.origin == (1.0, 2.0, 0.0)


@pytest.mark.parametrize("origin", [3, 3.5, "12", (1, 2, 3, 4), np.zeros((1, 3))])
def test_an_origin_that_is_none_is_named(origin: Any) -> None:
    with pytest.raises(MapError) as caught:
        groundplan.survey(hall(), resolution=0.05, origin=origin)
    assert caught.value.code == "map.origin"


# The collection


@pytest.fixture
def collection(shared: Path) -> Path:
    return shared / "maps"


def test_every_map_of_the_collection_is_sensible(collection: Path) -> None:
    for path in sorted(collection.glob("**/*.yaml")):
        if path.name.count(".") > 1 or path.parent.parent.name == "bags":
            continue
        got = read(path)
        free, occupied, unknown = shares(got)
        outside_is_black = path.stem.startswith(("lab_ipa", "author_octagon"))
        assert free > 1, path.name
        assert 0 < occupied < 50 or outside_is_black, path.name
        assert unknown > 4 or outside_is_black, path.name
        assert ("outside-occupied" in codes(got)) == outside_is_black, path.name
        assert "yaw-nan" not in codes(got)


@pytest.mark.parametrize(
    ("name", "unknown_percent"),
    [
        ("aws_hospital", 24.7),
        ("svl_warehouse", 27.8),
        ("textile_factory", 8.2),
        ("textile_factory_1cm", 25.5),
        ("tugbot_warehouse_shelves", 6.8),
        ("xixian_office", 86.1),
    ],
)
def test_unknown_stays_unknown_in_the_maps_with_the_trap(collection: Path, name: str, unknown_percent: float) -> None:
    path = collection / f"{name}.yaml"
    got = read(path)
    assert "unknown-as-free" in codes(got)
    assert shares(got)[2] == pytest.approx(unknown_percent, abs=0.1)
    assert shares(read(path, unknown="none"))[2] < 0.5


def test_the_intel_lab_finds_its_limits_without_a_yaml(collection: Path) -> None:
    with_yaml = read(collection / "radish_intel_lab.yaml")
    bare = read(collection / "radish_intel_lab.png", resolution=0.05)
    assert shares(bare) == pytest.approx(shares(with_yaml), abs=2)
    assert codes(bare) == ["limits-assumed", "unknown-as-free"]
    assert with_yaml.warnings == ()


@pytest.mark.parametrize(
    ("name", "percent"),
    [
        ("radish_intel_jones_farms", (16, 1.7, 82)),
        ("torwic_slam_warehouse", (29, 1.1, 70)),
        ("radish_aces_austin", (19, 0.6, 81)),
        ("nav2_warehouse", (84, 1.8, 14)),
        ("dis_b1", (15, 1.4, 83)),
        ("diag_floor1", (15, 1.1, 83)),
        ("bormann/office_e_furnitures", (34, 2.3, 63)),
        ("halmstad/E5_layout", (28, 1.2, 71)),
    ],
)
def test_maps_without_a_trap_are_read_as_their_yaml_says(
    collection: Path, name: str, percent: tuple[float, float, float]
) -> None:
    got = read(collection / f"{name}.yaml")
    assert got.warnings == ()
    assert shares(got) == pytest.approx(percent, abs=0.6)


def test_an_occupied_outside_is_not_said_to_need_no_flag_where_the_walls_are_darker() -> None:
    picture = np.full((100, 100), 60, np.uint8)
    picture[30:70, 30:70] = 254
    picture[30:70, 30:32] = 0
    said = {warning.code: warning.message for warning in from_array(picture, 0.05).warnings}
    assert "the walls are darker" in said["unknown-as-occupied"]
    assert "needs no flag" not in said["outside-occupied"]
    assert "84.8 % of the map" in said["outside-occupied"]
    picture[picture == 60] = 0
    assert "needs no flag" in {w.code: w.message for w in from_array(picture, 0.05).warnings}["outside-occupied"]


def test_a_share_that_rounds_to_nothing_is_not_said_to_be_nothing() -> None:
    from groundplan.maps._warnings import percent

    assert [percent(share) for share in (0.0, 0.0001, 0.001, 0.5)] == ["0.0 %", "less than 0.1 %", "0.1 %", "50.0 %"]


def room_with_walls(greys: tuple[int, int], tmp_path: Path) -> Map:
    """A room whose walls are of many greys, from the one to the other, in an outside of 180."""
    pixels = np.full((200, 300), 180, np.uint8)
    random = np.random.default_rng(1)
    pixels[40:160, 40:260] = random.integers(*greys, (120, 220))
    pixels[43:157, 43:257] = 254
    # Something else is dark enough.
    pixels[170:195, 20:280] = random.integers(10, 80, (25, 260))
    write_pgm(tmp_path / "map.pgm", pixels)
    return read(write_yaml(tmp_path, occupied_thresh="0.65", free_thresh="0.02"))


def test_walls_that_count_as_unknown_are_told(tmp_path: Path) -> None:
    got = room_with_walls((95, 150), tmp_path)
    assert codes(got) == ["walls-as-unknown"]
    assert "; --occupied-thresh 0.36 would" in message(got, "walls-as-unknown")
    mended = read(tmp_path / "map.yaml", occupied_thresh=0.36)
    assert (states(mended)[41, 41:259] == OCCUPIED).all()
    assert codes(mended) == []
    assert codes(room_with_walls((10, 80), tmp_path)) == []
