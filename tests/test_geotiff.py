"""GeoTIFF: the affine transform is the frame, wherever the raster's first row lies."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from _program import call, hall, write_map
from _reading import refused, states

from groundplan import read
from groundplan.maps import FREE, OCCUPIED, UNKNOWN, _canvas

rasterio = pytest.importorskip("rasterio")

Capture = pytest.CaptureFixture[str]

#: A frame of a building's own.
LOCAL = 'ENGCRS["hall",EDATUM["floor"],CS[Cartesian,2],AXIS["x",east],AXIS["y",north],LENGTHUNIT["metre",1]]'

EXPECTED = np.select([hall() == 0, hall() == 254], [OCCUPIED, FREE], UNKNOWN)


def affine(*terms: float) -> Any:
    from rasterio.transform import Affine

    return Affine(*terms)


def upright(metres: float = 0.05) -> Any:
    """The frame of `write_map`: its lower left corner at (-1, 2)."""
    return affine(metres, 0.0, -1.0, 0.0, -metres, 2.0 + 200 * metres)


def turned(yaw: float, metres: float = 0.05) -> Any:
    """The same corner, the map turned about it."""
    cos, sin = metres * math.cos(yaw), metres * math.sin(yaw)
    return affine(cos, sin, -1.0 - 200 * sin, sin, -cos, 2.0 + 200 * cos)


def write(path: Path, pixels: npt.NDArray[Any], transform: Any = None, **profile: Any) -> Path:
    import warnings

    bands = pixels[None] if pixels.ndim == 2 else pixels
    size = {"count": len(bands), "height": bands.shape[1], "width": bands.shape[2], "dtype": bands.dtype.name}
    colours = profile.pop("colours", None)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that there is no frame
        with rasterio.open(path, "w", driver="GTiff", transform=transform, **size, **profile) as file:
            file.write(bands)
            if colours:
                file.write_colormap(1, colours)
    return path


@pytest.mark.parametrize(
    "crs",
    [
        None,
        "EPSG:25832",
        LOCAL,
    ],
)
def test_the_transform_is_the_frame_with_or_without_a_reference_system(crs: str | None, tmp_path: Path) -> None:
    got = read(write(tmp_path / "map.tif", hall(), upright(), crs=crs))
    assert (got.resolution, got.origin) == (0.05, (-1.0, 2.0, 0.0))
    assert np.array_equal(states(got), EXPECTED) and got.warnings == ()


@pytest.mark.parametrize("yaw", [0.3, -2.0, math.pi / 2])
def test_rotation_terms_are_the_yaw(yaw: float, tmp_path: Path) -> None:
    got = read(write(tmp_path / "map.tif", hall(), turned(yaw)))
    assert got.resolution == pytest.approx(0.05, abs=1e-12)
    assert got.origin == pytest.approx((-1.0, 2.0, yaw), abs=1e-9)
    assert np.array_equal(states(got), EXPECTED)


def test_a_raster_that_begins_at_the_bottom_is_not_a_mirror_image(tmp_path: Path) -> None:
    got = read(write(tmp_path / "map.tif", hall()[::-1], affine(0.05, 0.0, -1.0, 0.0, 0.05, 2.0)))
    assert (got.resolution, got.origin) == (0.05, (-1.0, 2.0, 0.0))
    assert np.array_equal(states(got), EXPECTED)


def test_pixels_that_are_not_square_are_refused(tmp_path: Path) -> None:
    refused(write(tmp_path / "wide.tif", hall(), affine(0.1, 0, 0, 0, -0.05, 0)), "map.resolution", "0.1 m by 0.05 m")
    skew = affine(0.05, 0.01, 0, 0, -math.sqrt(0.05**2 - 0.01**2), 0)
    refused(write(tmp_path / "skew.tif", hall(), skew), "map.resolution", "right angles")


def test_degrees_and_feet_are_refused(tmp_path: Path) -> None:
    degrees = write(tmp_path / "degrees.tif", hall(), upright(1e-6), crs="EPSG:4326")
    refused(degrees, "map.resolution", "degrees", "gdalwarp")
    got = read(degrees, resolution=0.05, origin=(0.0, 0.0))
    assert (got.resolution, got.origin) == (0.05, (0.0, 0.0, 0.0))
    refused(write(tmp_path / "feet.tif", hall(), upright(), crs="EPSG:2263"), "map.resolution", "0.3048")


def test_no_data_is_unknown(tmp_path: Path) -> None:
    pixels = np.where(hall() == 205, 77, hall()).astype(np.uint8)
    got = read(write(tmp_path / "map.tif", pixels, upright(), nodata=77))
    assert np.array_equal(states(got), EXPECTED) and got.warnings == ()
    white = np.where(hall() == 205, 255, hall()).astype(np.uint8)
    assert np.array_equal(states(read(write(tmp_path / "white.tif", white, upright(), nodata=255))), EXPECTED)


def test_occupancies_of_a_raster_are_those_of_a_grid(tmp_path: Path) -> None:
    grid = np.select([hall() == 0, hall() == 254], [100, 0], -1).astype(np.int8)
    assert np.array_equal(states(read(write(tmp_path / "grid.tif", grid, upright()))), EXPECTED)
    marked = np.where(grid == -1, 50, grid).astype(np.int8)
    marked[marked == 50] = 99
    assert np.array_equal(states(read(write(tmp_path / "marked.tif", marked, upright(), nodata=99))), EXPECTED)


def test_colours_palettes_and_sixteen_bits_are_greys(tmp_path: Path) -> None:
    rgb = write(tmp_path / "rgb.tif", np.stack([hall()] * 3), upright(), photometric="RGB")
    assert np.array_equal(states(read(rgb)), EXPECTED)
    wide = read(write(tmp_path / "wide.tif", hall().astype(np.uint16) * 257, upright()))
    assert np.array_equal(states(wide), EXPECTED) and [w.code for w in wide.warnings] == ["sixteen-bit"]
    index = np.select([hall() == 0, hall() == 254], [1, 2], 0).astype(np.uint8)
    table = {0: (205, 205, 205, 255), 1: (0, 0, 0, 255), 2: (254, 254, 254, 255)}
    palette = write(tmp_path / "palette.tif", index, upright(), photometric="palette", colours=table)
    assert np.array_equal(states(read(palette)), EXPECTED)


def test_an_alpha_band_hides(tmp_path: Path) -> None:
    alpha = np.where(hall() == 205, 0, 255).astype(np.uint8)
    shown = np.where(hall() == 205, 254, hall()).astype(np.uint8)
    bands = np.stack([shown, shown, shown, alpha])
    assert np.array_equal(
        states(read(write(tmp_path / "m.tif", bands, upright(), photometric="RGB", alpha="YES"))), EXPECTED
    )


def test_heights_are_no_map(tmp_path: Path) -> None:
    refused(
        write(tmp_path / "heights.tif", hall().astype(np.float32), upright()), "map.pixels", "float32", "gdal_translate"
    )


def test_a_truncated_raster_is_refused(tmp_path: Path) -> None:
    path = write(tmp_path / "map.tif", hall(), upright(), compress="deflate", tiled=True, blockxsize=64, blockysize=64)
    path.write_bytes(path.read_bytes()[:-700])
    refused(path, "map.corrupt", "map.tif is a damaged TIFF")


def test_a_header_that_promises_more_than_its_file_can_hold_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "sparse.tif"
    layout = {"tiled": True, "blockxsize": 8192, "blockysize": 8192, "SPARSE_OK": True}
    size = {"count": 1, "dtype": "uint8", "width": 60_000, "height": 60_000}
    with rasterio.open(path, "w", driver="GTiff", transform=upright(), **size, **layout):
        pass
    refused(path, "map.truncated", "60000 x 60000")


def test_a_picture_without_a_frame_needs_its_resolution(tmp_path: Path) -> None:
    path = write(tmp_path / "map.tif", hall())
    refused(path, "map.resolution", "states no resolution")
    assert np.array_equal(states(read(path, resolution=0.05)), EXPECTED)


@pytest.mark.parametrize("layout", [{"tiled": True, "blockxsize": 64, "blockysize": 64}, {"BIGTIFF": "YES"}])
def test_a_large_raster_is_read_by_blocks_into_a_file_and_is_the_same(
    layout: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write(tmp_path / "map.tif", hall(), upright(), compress="deflate", **layout)
    whole = read(path)
    monkeypatch.setattr(_canvas, "IN_MEMORY", 1000)
    monkeypatch.setattr("groundplan.maps.geotiff.AT_A_TIME", 1000)
    shares: list[float] = []
    parts = read(path, progress=shares.append)
    assert isinstance(parts.pixels, np.memmap) and parts == whole
    assert shares == sorted(shares) and len(shares) > 3 and shares[-1] == 1.0


def test_a_geotiff_and_a_yaml_give_the_same_survey(tmp_path: Path, capsys: Capture) -> None:
    path = write(tmp_path / "hall.tif", hall(), upright(), crs="EPSG:25832")
    texts = [
        call(capsys, "survey", one, "--json").out.replace("hall.tif", "hall.pgm").splitlines()
        for one in (path, write_map(tmp_path))
    ]
    assert [line for line in texts[0] if "source" not in line] == [line for line in texts[1] if "source" not in line]
