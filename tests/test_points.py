"""Point clouds: a slice between two heights becomes a map, and says what it cannot know."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from _program import call
from _reading import refused, states

from groundplan import Map, MapError, Survey, read
from groundplan.maps import FREE, OCCUPIED

laspy = pytest.importorskip("laspy")
pye57 = pytest.importorskip("pye57")

Points = npt.NDArray[np.float64]

FORMATS = ("las", "laz", "e57")


def room() -> Points:
    """A room of 6 m by 4 m at (10, 20): walls 2.5 m high, a floor, a ceiling and a table's top at 0.75 m."""
    along, across, up = np.arange(10.005, 16, 0.01), np.arange(20.005, 24, 0.01), np.arange(0.0, 2.5, 0.1)
    south, north, west, east = (np.array([at]) for at in (20.002, 23.998, 10.002, 15.998))
    walls = [(along, south), (along, north), (west, across), (east, across)]
    parts = [np.stack(np.meshgrid(x, y, up), -1).reshape(-1, 3) for x, y in walls]
    for height, x, y in ((0.0, along, across), (2.5, along, across), (0.75, along[100:200], across[100:200])):
        parts.append(np.stack(np.meshgrid(x[::4], y[::4], np.array([height])), -1).reshape(-1, 3))
    return np.concatenate(parts)


def write(
    path: Path, points: Points, turn: tuple[float, ...] = (1, 0, 0, 0), shift: tuple[float, ...] = (0, 0, 0)
) -> Path:
    if path.suffix == ".e57":
        with pye57.E57(str(path), mode="w") as file:
            fields = dict(zip(("cartesianX", "cartesianY", "cartesianZ"), points.T, strict=True))
            file.write_scan_raw(fields, rotation=np.array(turn, float), translation=np.array(shift, float))
        return path
    header = laspy.LasHeader(point_format=3, version="1.2")
    header.scales, header.offsets = [0.001] * 3, np.floor(points.min(axis=0))
    file = laspy.LasData(header)
    file.x, file.y, file.z = points.T
    file.write(path)
    return path


def at(of: Map, x: float, y: float) -> int:
    """State of the pixel at a point."""
    column = int((x - of.origin[0]) // of.resolution)
    row = of.height - 1 - int((y - of.origin[1]) // of.resolution)
    return int(states(of)[row, column])


@pytest.mark.parametrize("kind", FORMATS)
def test_the_slice_of_a_room_is_its_walls(kind: str, tmp_path: Path) -> None:
    got = read(write(tmp_path / f"room.{kind}", room()), band=(1.0, 2.0))
    assert got.resolution == 0.05 and [w.code for w in got.warnings] == ["free-unobserved"]
    # The lattice is one of multiples of the resolution, four free pixels around the outermost points.
    assert got.origin == (9.8, 19.8, 0.0) and (got.width, got.height) == (128, 88)
    expected = np.full((88, 128), FREE)
    expected[4:84, 4:124] = OCCUPIED
    expected[5:83, 5:123] = FREE
    assert np.array_equal(states(got), expected)


def test_a_band_that_holds_the_table_shows_it(tmp_path: Path) -> None:
    path = write(tmp_path / "room.las", room())
    assert at(read(path, band=(0.5, 1.0), min_hits=1), 11.5, 21.5) == OCCUPIED
    assert at(read(path, band=(1.0, 2.0)), 11.5, 21.5) == FREE
    assert at(read(path, band=(0.5, 1.0), min_hits=20), 11.5, 21.5) == FREE
    coarse = read(path, band=(0.5, 1.0), resolution=0.2)
    assert coarse.resolution == 0.2 and at(coarse, 11.5, 21.5) == OCCUPIED and at(coarse, 13.0, 22.0) == FREE


def test_the_poses_of_scans_are_applied(tmp_path: Path) -> None:
    half = np.sqrt(0.5)
    path = write(tmp_path / "turned.e57", room(), (half, 0, 0, half), (100.0, 0.0, 5.0))  # a quarter turn
    got = read(path, band=(6.0, 7.0))
    assert got.origin == pytest.approx((100 - 24 - 0.2, 10 - 0.2, 0.0)) and (got.width, got.height) == (88, 128)


def test_points_are_read_in_chunks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for kind in FORMATS:
        path = write(tmp_path / f"room.{kind}", room())
        whole, shares = read(path, band=(1.0, 2.0)), list[float]()
        monkeypatch.setattr("groundplan.maps.points.CHUNK", 1000)
        assert read(path, band=(1.0, 2.0), progress=shares.append) == whole
        assert len(shares) > 50 and shares == sorted(shares) and shares[-1] == 1.0
        monkeypatch.undo()


@pytest.mark.parametrize("kind", FORMATS)
def test_without_a_band_the_heights_are_told(kind: str, tmp_path: Path) -> None:
    path = write(tmp_path / f"room.{kind}", room())
    refused(path, "map.band", "--band Z0 Z1", "0.00 to 2.50")
    refused(path, "map.no-points", "5 m and 6 m", "0.00 to 2.50", band=(5.0, 6.0))
    refused(path, "map.no-points", "the most that one has is", band=(1.0, 2.0), min_hits=255)
    refused(path, "map.band", "[2.0, 1.0]", band=(2.0, 1.0))
    refused(path, "map.min-hits", "0", band=(1.0, 2.0), min_hits=0)


def test_a_point_far_outside_is_refused_and_not_drawn(tmp_path: Path) -> None:
    path = write(tmp_path / "far.las", np.concatenate([room(), [[900_000.0, 900_000.0, 1.5]]]))
    refused(path, "map.too-large", "899990 m", band=(1.0, 2.0))


@pytest.mark.parametrize("kind", FORMATS)
def test_a_cloud_that_ends_early_is_refused_and_kept(kind: str, tmp_path: Path) -> None:
    path = write(tmp_path / f"room.{kind}", room())
    data = path.read_bytes()
    for share in (0.8, 0.4, 0.01):
        path.write_bytes(data[: max(16, int(share * len(data)))])
        with pytest.raises(MapError) as caught:
            read(path, band=(1.0, 2.0))
        assert caught.value.code in ("map.corrupt", "map.truncated") and path.name in str(caught.value)
        assert path.read_bytes() == data[: max(16, int(share * len(data)))]


def test_the_survey_of_a_scan_says_that_free_space_was_not_observed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(tmp_path / "room.laz", room())
    ran = call(capsys, "survey", path, "--band", "1", "2", "-o", tmp_path / "out")
    assert ran.code == 0 and "[free-unobserved]" in ran.err
    survey = Survey.read(tmp_path / "out" / "survey.json")
    assert "free-unobserved" in [warning.code for warning in survey.warnings]
    assert survey.reading == {"band": [1.0, 2.0]}
    assert len(survey.directions) == 2
    assert call(capsys, "figures", tmp_path / "out", "--format", "png").code == 0
