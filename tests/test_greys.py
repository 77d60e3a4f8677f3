"""What greys mean where the YAML does not say, or says what cannot be."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from _reading import EXPECTED, codes, hall, message, shares, states, with_greys, write_pgm, write_yaml

from groundplan.maps import FREE, OCCUPIED, Map, from_array, read


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
