"""Zarr arrays as maps."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from _program import call, files, hall
from _reading import refused, states

from groundplan import read
from groundplan.maps import FREE, OCCUPIED, UNKNOWN, _canvas

zarr = pytest.importorskip("zarr")

EXPECTED = np.select([hall() == 0, hall() == 254], [OCCUPIED, FREE], UNKNOWN)
FRAME: dict[str, Any] = {"resolution": 0.05, "origin": [-1.0, 2.0, 0.3]}


def write(path: Path, pixels: npt.NDArray[Any], version: int = 3, chunks: int = 64, **attributes: Any) -> Path:
    array = zarr.create_array(
        str(path), shape=pixels.shape, chunks=(chunks, chunks), dtype=pixels.dtype, zarr_format=version
    )
    array[:] = pixels
    array.attrs.update(attributes)
    return path


@pytest.mark.parametrize("version", [2, 3])
def test_an_array_with_its_frame_is_a_map(version: int, tmp_path: Path) -> None:
    got = read(write(tmp_path / "big.zarr", hall(), version, **FRAME))
    assert (got.resolution, got.origin, got.image) == (0.05, (-1.0, 2.0, 0.3), "big.zarr")
    assert np.array_equal(states(got), EXPECTED) and got.warnings == ()


def test_occupancies_begin_at_the_bottom_as_in_a_message(tmp_path: Path) -> None:
    grid = np.select([hall() == 0, hall() == 254], [100, 0], -1).astype(np.int8)[::-1]
    assert np.array_equal(states(read(write(tmp_path / "grid.zarr", grid, **FRAME))), EXPECTED)


def test_attributes_say_how_greys_are_read(tmp_path: Path) -> None:
    got = read(write(tmp_path / "dark.zarr", 255 - hall(), negate=1, occupied_thresh=0.65, free_thresh=0.196, **FRAME))
    assert np.array_equal(states(got), EXPECTED)


def test_the_only_array_of_a_group_is_found(tmp_path: Path) -> None:
    group = zarr.create_group(str(tmp_path / "site.zarr"))
    group.create_array("map", data=hall()).attrs.update(FRAME)
    group.create_array("heights", data=np.zeros(5))
    assert np.array_equal(states(read(tmp_path / "site.zarr")), EXPECTED)
    group.create_array("other", data=hall())
    refused(tmp_path / "site.zarr", "map.zarr", "map, other", "site.zarr/map")
    assert np.array_equal(states(read(tmp_path / "site.zarr" / "map")), EXPECTED)


def test_what_is_no_map_is_refused(tmp_path: Path) -> None:
    refused(write(tmp_path / "no-frame.zarr", hall()), "map.resolution", "no-frame.zarr")
    refused(write(tmp_path / "zero.zarr", hall(), resolution=0), "map.resolution", "resolution 0")
    refused(write(tmp_path / "where.zarr", hall(), resolution=0.05, origin="here"), "map.origin", "here")
    refused(write(tmp_path / "float.zarr", hall().astype(np.float32), **FRAME), "map.pixels", "float32")
    zarr.create_array(str(tmp_path / "unwritten.zarr"), shape=(10**6, 10**6), chunks=(512, 512), dtype="u1")
    refused(tmp_path / "unwritten.zarr", "map.empty", "1000000 x 1000000")
    zarr.create_group(str(tmp_path / "empty.zarr"))
    refused(tmp_path / "empty.zarr", "map.zarr", "without a two-dimensional array")
    broken = write(tmp_path / "broken.zarr", hall(), **FRAME)
    (broken / "c" / "1" / "1").write_bytes(b"no chunk")
    refused(broken, "map.corrupt", "broken.zarr")
    (broken / "zarr.json").write_text("{")
    refused(broken, "map.corrupt", "broken.zarr")


def test_a_large_array_is_read_by_chunks_into_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write(tmp_path / "big.zarr", hall(), **FRAME)
    whole, before = read(path), files(tmp_path)
    monkeypatch.setattr(_canvas, "IN_MEMORY", 1000)
    monkeypatch.setattr("groundplan.maps.zarr_array.AT_A_TIME", 1000)
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)
    shares: list[float] = []
    parts = read(path, progress=shares.append)
    assert isinstance(parts.pixels, np.memmap) and parts == whole
    assert shares == [64 / 200, 128 / 200, 192 / 200, 1.0]
    assert files(tmp_path) == before


def test_the_program_takes_a_zarr_array_with_no_flag(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write(tmp_path / "big.zarr", hall(), **FRAME)
    ran = call(capsys, "survey", path, "-o", tmp_path / "out")
    assert ran.code == 0 and (tmp_path / "out" / "survey.json").is_file()
    # The figures find the array again, though it is a directory.
    assert call(capsys, "figures", tmp_path / "out", "--format", "png").code == 0
