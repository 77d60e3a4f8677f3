"""The YAML of map_server, and what takes its place."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from _reading import EXPECTED, codes, hall, message, refused, states, write_pgm, write_yaml

from groundplan.maps import FREE, OCCUPIED, read


def test_a_bare_image_needs_a_resolution(tmp_path: Path) -> None:
    path = write_pgm(tmp_path / "map.pgm", hall())
    error = refused(path, "map.resolution", str(path))
    assert error.hint == "--resolution sets it, such as --resolution 0.05; in Python resolution=0.05"
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


def test_a_yaw_that_may_be_in_degrees_is_told_and_another_that_is_given_beats_it(tmp_path: Path) -> None:
    write_pgm(tmp_path / "map.pgm", hall())
    yaml = write_yaml(tmp_path, origin="[1.0, 2.0, 90]")
    assert codes(read(yaml)) == ["yaw-degrees"] and "in map.yaml is 90 rad" in message(read(yaml), "yaw-degrees")
    assert codes(read(yaml, origin=(1, 2, 1.57))) == []
    assert codes(read(yaml, origin=(1, 2, -45))) == ["yaw-degrees"]


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


def test_a_key_like_one_that_is_missing_is_named(tmp_path: Path) -> None:
    write_pgm(tmp_path / "map.pgm", hall())
    got = read(write_yaml(tmp_path, occupied_thresh=None, occupied_threshold="0.5"))
    assert "occupied_thresh (but occupied_threshold)" in message(got, "fields-missing")
    for key, slip, value in (
        ("resolution", "resolutoin", "0.05"),
        ("origin", "orign", "[0, 0, 0]"),
        ("image", "Image", "a"),
    ):
        error = refused(write_yaml(tmp_path, **{key: None, slip: value}), f"map.{key}", key)
        assert error.hint == f"it has {slip}: did you mean {key}?"
    assert read(write_yaml(tmp_path, resolution=None, resolutoin="0.05"), resolution=0.2).resolution == 0.2


def test_an_image_without_resolution_names_the_yaml_beside_it(tmp_path: Path) -> None:
    image = write_pgm(tmp_path / "map.pgm", hall())
    assert str(refused(image, "map.resolution").hint).startswith("--resolution sets it")
    yaml = write_yaml(tmp_path)
    assert str(refused(image, "map.resolution").hint).startswith(f"did you mean {yaml}? Else --resolution sets it")


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
