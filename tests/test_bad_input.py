"""Bad input: a sentence, an exit code, and nothing left behind."""

from __future__ import annotations

import json
import os
import struct
import sys
import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from _program import Ran, call, files, hall, start, write_map, write_pgm
from PIL import Image

Capture = pytest.CaptureFixture[str]

BARE = ("--resolution", "0.05")


@pytest.fixture(autouse=True)
def _in_a_directory_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def one_error(ran: Ran) -> str:
    """The one error sentence of a run."""
    said = [line for line in ran.err.splitlines() if not line.startswith("hint: ")]
    assert ran.out == "" and len(said) == 1 and said[0].startswith("error: "), ran
    return said[0].removeprefix("error: ")


def lying_png(path: Path) -> None:
    """A PNG of a kilobyte whose header promises 30,000 x 30,000 pixels."""
    Image.fromarray(hall()).save(path)
    data = path.read_bytes()
    head = b"IHDR" + struct.pack(">IIBBBBB", 30000, 30000, 8, 0, 0, 0, 0)
    path.write_bytes(data[:12] + head + struct.pack(">I", zlib.crc32(head)) + data[33:1024])


def truncated_png(path: Path) -> None:
    """A PNG that ends early."""
    noise = np.random.default_rng(0).integers(0, 255, (90, 90), dtype=np.uint8)
    Image.fromarray(noise).save(path)
    path.write_bytes(path.read_bytes()[:3000])


def text(path: Path, content: str) -> int:
    """A text file."""
    return path.write_text(content)


UNREADABLE: dict[str, tuple[str, Callable[[Path], object], list[str]]] = {
    "missing": ("gone.pgm", lambda path: None, ["gone.pgm does not exist"]),
    "missing image": (
        "map.yaml",
        lambda path: text(path, "image: gone.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n"),
        ["map.yaml", "gone.pgm"],
    ),
    "truncated": ("cut.pgm", lambda path: write_pgm(path, hall()[:90], (280, 200)), ["truncated", "56000", "25200"]),
    "lying header": ("lie.pgm", lambda path: write_pgm(path, hall(), (2800, 2000)), ["2800 x 2000", "56000"]),
    "huge header, PGM": (
        "huge.pgm",
        lambda path: write_pgm(path, hall()[:3], (30000, 30000)),
        ["30000 x 30000", "900000000"],
    ),
    "huge header, PNG": ("huge.png", lying_png, ["30000 x 30000"]),
    "truncated PNG": ("cut.png", truncated_png, ["cut.png"]),
    "negative size": ("minus.pgm", lambda path: path.write_bytes(b"P5\n-3 4\n255\n" + bytes(12)), ["minus.pgm"]),
    "directory": ("folder", lambda path: path.mkdir(), ["folder is a directory"]),
    "directory named as a map": ("folder.yaml", lambda path: path.mkdir(), ["folder.yaml is a directory"]),
    "image that is a directory": (
        "map.yaml",
        lambda path: text(path, "image: .\nresolution: 0.05\norigin: [0, 0, 0]\n"),
        ["map.yaml names the image ., which is a directory"],
    ),
    "no map": ("notes.txt", lambda path: text(path, "hello"), ["notes.txt is not a map"]),
    "empty": ("empty.pgm", lambda path: path.touch(), ["empty.pgm is empty"]),
    "no YAML": ("broken.yaml", lambda path: text(path, "image: [a\n"), ["broken.yaml is not YAML"]),
    "no origin": (
        "origin.yaml",
        lambda path: text(path, f"image: {write_pgm(path.with_name('i.pgm'), hall()).name}\nresolution: 0.05\n"),
        ["origin.yaml states no origin"],
    ),
    "resolution": (
        "zero.yaml",
        lambda path: write_map(path.parent).rename(path).write_text("image: hall.pgm\nresolution: 0.0\n"),
        ["zero.yaml", "resolution 0.0"],
    ),
}


@pytest.mark.parametrize("case", UNREADABLE)
def test_a_map_that_cannot_be_read_is_named_with_its_value(case: str, tmp_path: Path, capsys: Capture) -> None:
    name, make, values = UNREADABLE[case]
    make(tmp_path / name)
    before = files(tmp_path)
    flags = () if name.endswith("yaml") else BARE
    ran = call(capsys, "survey", name, *flags, "-o", "out", "--figures")
    assert ran.code == 3
    sentence = one_error(ran)
    assert all(value in sentence for value in values), sentence
    assert "\nhint: " in ran.err
    assert files(tmp_path) == before and not (tmp_path / "out").exists()


def test_a_slip_of_the_pen_in_a_map_s_name_is_put_right(tmp_path: Path, capsys: Capture) -> None:
    write_map(tmp_path)
    assert call(capsys, "survey", "hal.yaml").err.endswith("hint: did you mean hall.yaml?\n")
    assert call(capsys, "survey", "attic.yaml").err.endswith(f"hint: it was sought in {tmp_path}\n")
    assert call(capsys, "route", "gone", "1,1", "2,2").err.endswith(f"hint: it was sought in {tmp_path}\n")
    assert call(capsys, "survey", "maps/hall.yaml").err.endswith("hint: there is no directory maps\n")


@pytest.mark.parametrize(
    ("image", "picture", "hint"),
    [
        ("attic.pgm", None, "copy attic.pgm into {place}, beside attic.yaml, or correct image: in it"),
        ("/there/attic.pgm", None, "copy attic.pgm into {place}, beside attic.yaml, or correct image: in it"),
        ("C:\\there\\attic.pgm", None, "copy attic.pgm into {place}, beside attic.yaml, or correct image: in it"),
        ("atic.pgm", "attic.pgm", "did you mean image: attic.pgm in attic.yaml?"),
        ("map.pgm", "map.tiff", "did you mean image: map.tiff in attic.yaml?"),
        ("map.pgm", "attic.png", "did you mean image: attic.png in attic.yaml?"),
        ("maps/map.pgm", "maps/map.png", "did you mean image: maps/map.png in attic.yaml?"),
        ("../map.pgm", "../map.png", "did you mean image: ../map.png in attic.yaml?"),
        ("maps/map.pgm", "attic.pgm", "did you mean image: attic.pgm in attic.yaml?"),
    ],
)
def test_a_yaml_whose_picture_is_not_there_names_both_and_what_it_may_have_been(
    image: str, picture: str | None, hint: str, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    place = tmp_path / "site"
    place.mkdir()
    monkeypatch.chdir(place)
    (place / "attic.yaml").write_text(f"image: {image}\nresolution: 0.05\norigin: [0, 0, 0]\n")
    if picture is not None:
        (place / picture).parent.mkdir(exist_ok=True)
        write_pgm(place / picture, hall())
    ran = call(capsys, "survey", "attic.yaml")
    said = f"error: attic.yaml names the image {image}, which does not exist\n"
    assert (ran.code, ran.err) == (3, f"{said}hint: {hint.format(place=place)}\n")


NOTHING: dict[str, tuple[npt.NDArray[np.uint8], str]] = {
    "1x1": (hall()[:1, :1], "map.png is a single pixel: there is nothing to survey"),
    "all unknown": (np.full_like(hall(), 205), "map.png: no pixel of the map is free: there is nothing to survey"),
    "all occupied": (np.zeros_like(hall()), "map.png: no pixel of the map is free: there is nothing to survey"),
}


@pytest.mark.parametrize("case", NOTHING)
def test_a_map_that_holds_nothing_is_refused(case: str, tmp_path: Path, capsys: Capture) -> None:
    pixels, sentence = NOTHING[case]
    Image.fromarray(pixels).save(tmp_path / "map.png")
    ran = call(capsys, "survey", "map.png", *BARE, "-o", "out")
    assert ran.code == 3
    assert sentence in one_error(ran)
    assert not (tmp_path / "out").exists()


def sixteen_bit(path: Path) -> None:
    """A PNG of 16 bits."""
    Image.fromarray(hall().astype(np.uint16) * 257).save(path)


POOR: dict[str, tuple[Callable[[Path], object], list[str]]] = {
    "one row": (lambda path: Image.fromarray(hall()[60:61]).save(path), ["few-edges"]),
    "all free": (lambda path: Image.fromarray(np.full_like(hall(), 254)).save(path), ["no-occupied", "few-edges"]),
    "16 bit": (sixteen_bit, ["sixteen-bit"]),
    "RGBA": (lambda path: Image.fromarray(hall()).convert("RGBA").save(path), []),
    "palette": (lambda path: Image.fromarray(hall()).convert("P").save(path), []),
}


@pytest.mark.parametrize("case", POOR)
def test_a_poor_map_is_surveyed_and_its_trouble_told(case: str, tmp_path: Path, capsys: Capture) -> None:
    import groundplan

    make, codes = POOR[case]
    make(tmp_path / "map.png")
    ran = call(capsys, "survey", "map.png", *BARE, "-o", "out")
    assert ran.code == 0 and "error" not in ran.err
    assert all(f"[{code}]" in ran.err for code in codes), ran.err
    assert files(tmp_path / "out") == {"survey.json", "survey.png"}
    assert groundplan.Survey.read("out/survey.json").problems() == []


@pytest.mark.parametrize(("resolution", "said"), [("5", "a pixel is 5 m wide"), ("0.0001", "the whole map is")])
def test_a_scale_that_is_no_site_is_told(resolution: str, said: str, tmp_path: Path, capsys: Capture) -> None:
    Image.fromarray(hall()).save(tmp_path / "map.png")
    for given, is_odd in ((resolution, True), ("0.05", False)):
        ran = call(capsys, "survey", "map.png", "--resolution", given, "-o", "out")
        assert ran.code == 0 and ("[odd-scale]" in ran.err and said in ran.err) == is_odd


def test_a_yaw_that_is_no_number_is_read_as_zero_with_a_warning(tmp_path: Path, capsys: Capture) -> None:
    import groundplan

    write_map(tmp_path, yaw=".nan")
    ran = call(capsys, "survey", "hall.yaml", "-o", "out")
    assert ran.code == 0 and "warning: the yaw of the origin in hall.yaml is nan: read as 0 [yaw-nan]" in ran.err
    assert groundplan.Survey.read("out/survey.json").map.origin == (-1.0, 2.0, 0.0)


# Files that cannot be read or written


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may read all")
def test_no_permission_to_read(tmp_path: Path, capsys: Capture) -> None:
    write_map(tmp_path)
    (tmp_path / "hall.pgm").chmod(0)
    ran = call(capsys, "survey", "hall.yaml", "-o", "out")
    assert ran.code == 3 and "hall.pgm: Permission denied" in one_error(ran)


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write all")
def test_no_permission_to_write(tmp_path: Path, capsys: Capture) -> None:
    write_map(tmp_path)
    (tmp_path / "out").mkdir(mode=0o500)
    ran = call(capsys, "survey", "hall.yaml", "-o", "out")
    assert ran.code == 3 and "survey.json: Permission denied" in one_error(ran)


@pytest.mark.parametrize("place", ["hall.pgm", "hall.pgm/below"])
def test_a_file_in_the_way_of_the_output(place: str, tmp_path: Path, capsys: Capture) -> None:
    write_map(tmp_path)
    before = files(tmp_path)
    ran = call(capsys, "survey", "hall.yaml", "-o", place)
    assert ran.code == 3 and f"cannot write {Path(place) / 'survey.json'}" in one_error(ran)
    assert one_error(ran).endswith("hall.pgm is a file and no directory")
    assert files(tmp_path) == before


@pytest.mark.skipif(sys.platform == "win32", reason="needs limits on a process's files")
@pytest.mark.parametrize(("limit", "file"), [(1000, "survey.json"), (None, "survey.png")])
def test_a_full_disk_leaves_nothing(limit: int | None, file: str, tmp_path: Path, capsys: Capture) -> None:
    # A limit on the size of a file stands for the full disk: writing fails in the middle just so.
    write_map(tmp_path)
    if limit is None:
        call(capsys, "survey", "hall.yaml", "-o", "whole")
        sizes = [(tmp_path / "whole" / name).stat().st_size for name in ("survey.json", "survey.png")]
        if sizes[0] >= sizes[1]:
            pytest.skip("no limit lets the survey through and not its picture")
        limit = sizes[0] + 1

    def full() -> None:
        import resource

        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    before = files(tmp_path)
    ran = start("survey", "hall.yaml", "-o", "out", cwd=tmp_path, before=full)
    assert ran.code == 3
    assert one_error(ran) == f"cannot write {Path('out') / file}: File too large"
    assert files(tmp_path) == before


@pytest.mark.parametrize(
    ("command", "content", "values"),
    [
        (("figures", "s.json"), None, ["s.json does not exist"]),
        (("figures", "s.json"), b"{", ["s.json", "not JSON"]),
        (("figures", "s.json"), b"\xff\xfe\x00", ["s.json", "not JSON"]),
        (("figures", "s.json"), b'{"format": "something"}', ["s.json", "'something'"]),
        (("figures", "s.json"), b'{"format": "groundplan-survey", "version": 7}', ["s.json", "version 7"]),
        (("figures", "s.json"), b'{"format": "groundplan-survey", "version": 1}', ["s.json", "map"]),
        (("evaluate", "s.json", "t.json"), None, ["s.json does not exist"]),
        (("evaluate", "s.json", "t.json"), b"[]", ["s.json is not a survey"]),
        (("survey", "hall.yaml", "--config", "s.json"), None, ["s.json does not exist"]),
        (("survey", "hall.yaml", "--config", "s.json"), b"{", ["s.json is not TOML"]),
    ],
)
def test_other_files_that_are_not_what_they_should_be(
    command: tuple[str, ...], content: bytes | None, values: list[str], tmp_path: Path, capsys: Capture
) -> None:
    write_map(tmp_path)
    if content is not None:
        (tmp_path / "s.json").write_bytes(content)
    before = files(tmp_path)
    ran = call(capsys, *command)
    assert ran.code == 3
    sentence = one_error(ran)
    assert all(value in sentence for value in values), sentence
    assert files(tmp_path) == before


@pytest.mark.parametrize(
    "label",
    [{}, 3, {"kind": "corridor"}, {"kind": "junction", "type": "T", "at": [1]}, {"kind": 7}, {"kind": "x", "at": "y"}],
)
def test_a_survey_with_a_damaged_label_is_refused(label: object, tmp_path: Path, capsys: Capture) -> None:
    write_map(tmp_path)
    call(capsys, "survey", "hall.yaml", "-o", "out")
    tree = json.loads((tmp_path / "out/survey.json").read_text()) | {"labels": [label]}
    (tmp_path / "out/survey.json").write_text(json.dumps(tree))
    ran = call(capsys, "figures", "out/survey.json")
    assert ran.code == 3 and "the survey is not whole" in one_error(ran)
    assert not (tmp_path / "out/figures").exists()


def test_a_directory_in_the_survey_s_way_leaves_no_picture(tmp_path: Path, capsys: Capture) -> None:
    write_map(tmp_path)
    (tmp_path / "out/survey.json").mkdir(parents=True)
    before = files(tmp_path)
    ran = call(capsys, "survey", "hall.yaml", "-o", "out")
    assert ran.code == 3
    assert one_error(ran) == f"cannot write {Path('out/survey.json')}: Is a directory"
    assert files(tmp_path) == before


@pytest.mark.parametrize("command", [("survey", "hall.yaml"), ("figures", "out"), ("simulate", "warehouse")])
def test_an_output_without_a_name_is_wrong_usage(command: tuple[str, ...], tmp_path: Path, capsys: Capture) -> None:
    write_map(tmp_path)
    before = files(tmp_path)
    ran = call(capsys, *command, "-o", "")
    assert ran.code == 2 and "the directory has no name" in one_error(ran)
    assert files(tmp_path) == before


@pytest.mark.parametrize(
    ("name", "start", "library", "extra"),
    [
        ("run.bag", b"#ROSBAG V2.0\n", "rosbags", "ros"),
        ("map.tif", b"II+\0 a large one", "rasterio", "gis"),
        ("big.zarr", b"", "zarr", "large"),
        ("scan.laz", b"LASF and points", "laspy", "points"),
        ("scan.e57", b"ASTM-E57 and points", "pye57", "points"),
    ],
)
def test_the_command_that_installs_what_a_map_needs_is_named(
    name: str, start: bytes, library: str, extra: str, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    if name.endswith("zarr"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "zarr.json").write_text("{}")
    else:
        (tmp_path / name).write_bytes(start)
    monkeypatch.setitem(sys.modules, library, None)
    ran = call(capsys, "survey", name, "-o", "out")
    assert ran.code == 2 and one_error(ran) == f"{library} is not installed"
    assert f"hint: pip install 'groundplan[{extra}]'" in ran.err
    assert not (tmp_path / "out").exists()
