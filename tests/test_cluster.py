"""Surveys on a cluster of worker processes, started here on the loopback interface: the bytes of one thread."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from _legs import with_a_way
from _program import call, files, hall, write_pgm
from zoo import FREE, OCCUPIED, RESOLUTION, UNKNOWN, ZOO

import groundplan
from groundplan import GroundplanError, MapError, Survey, _cluster
from groundplan.maps._distant import Distant
from groundplan.maps._read import read_or_leave
from groundplan.maps._tally import tally

distributed = pytest.importorskip("distributed")
zarr = pytest.importorskip("zarr")

FRAME: dict[str, Any] = {"resolution": RESOLUTION, "origin": (-1.0, 2.0, 0.3)}


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    """Four worker processes."""
    with distributed.LocalCluster(
        n_workers=4, threads_per_worker=1, processes=True, host="127.0.0.1", dashboard_address="127.0.0.1:0"
    ) as made:
        yield made


@pytest.fixture(scope="module")
def client(cluster: Any) -> Iterator[Any]:
    with distributed.Client(cluster, set_as_default=False) as made:
        yield made


def site() -> npt.NDArray[np.uint8]:
    """Higher than several bands, with structure across each cut."""
    one = ZOO["turned_warehouse"]()
    noisy = one.copy()
    noisy[np.random.default_rng(7).random(one.shape) < 0.02] = OCCUPIED
    return np.concatenate([one, noisy, one[::-1], one])


def shaded() -> npt.NDArray[np.uint8]:
    """Walls and floors in many greys, as a map in mode scale has them."""
    picture = site()
    shades = np.random.default_rng(3).integers(0, 40, picture.shape).astype(np.uint8)
    return np.select([picture == OCCUPIED, picture == FREE], [shades, 255 - shades], UNKNOWN).astype(np.uint8)


def write_zarr(path: Path, pixels: npt.NDArray[Any], **attributes: Any) -> Path:
    array = zarr.create_array(str(path), shape=pixels.shape, chunks=(100, 128), dtype=pixels.dtype)
    array[:] = pixels
    array.attrs.update(attributes)
    return path


def write_tiff(path: Path, pixels: npt.NDArray[Any], upwards: bool = False, **more: Any) -> Path:
    rasterio = pytest.importorskip("rasterio")
    from rasterio.transform import Affine

    size = {"width": pixels.shape[1], "height": pixels.shape[0], "count": 1, "dtype": pixels.dtype}
    tiles = {"tiled": True, "blockxsize": 256, "blockysize": 256}
    way = Affine(0.05, 0, 3, 0, 0.05 if upwards else -0.05, 9)
    with rasterio.open(path, "w", driver="GTiff", transform=way, **size, **tiles, **more) as file:
        file.write(pixels, 1)
    return path


def occupancies(pixels: npt.NDArray[np.uint8]) -> npt.NDArray[np.int8]:
    return np.select([pixels == OCCUPIED, pixels == FREE], [100, 0], -1).astype(np.int8)[::-1]


def same(path: Path, client: Any, reading: dict[str, Any] | None = None, **given: Any) -> Survey:
    """The survey by the cluster, held to that of one thread."""
    map = groundplan.read(path, **(reading or {}), **given)
    found = groundplan.survey(path, client=client, reading=reading, **given)
    assert found.to_json() == groundplan.survey(map, threads=1).to_json()
    return found


@pytest.mark.parametrize("name", ["site", "legs", *ZOO])
def test_a_map_in_memory_is_surveyed_to_the_bytes_of_one_thread(name: str, client: Any) -> None:
    map = groundplan.from_array({"site": site, "legs": with_a_way, **ZOO}[name](), **FRAME)
    assert groundplan.survey(map, client=client).to_json() == groundplan.survey(map, threads=1).to_json()


def test_a_map_in_memory_may_begin_at_the_bottom(client: Any) -> None:
    grid = occupancies(site())
    found = groundplan.survey(grid, resolution=RESOLUTION, client=client)
    assert found.to_json() == groundplan.survey(grid, resolution=RESOLUTION, threads=1).to_json()


def test_the_workers_read_their_own_rows(client: Any, tmp_path: Path) -> None:
    for path in (
        write_pgm(tmp_path / "site.pgm", site()),
        write_zarr(tmp_path / "site.zarr", site()),
        write_tiff(tmp_path / "site.tif", site()),
    ):
        map, far, _ = read_or_leave(path, FRAME, lambda far: tally(far.rows(0, far.shape[0])))
        assert far is not None and map.pixels.strides == (0, 0)  # of their shape alone
        assert np.array_equal(far.rows(70, 333), groundplan.read(path, **FRAME).pixels[70:333])
        found = same(path, client, **FRAME)
        # The map of three values is here in the end, though nobody sent its pixels.
        assert np.array_equal(found.__dict__["_map"].pixels, site())


def test_every_orientation_and_type_is_read_as_one_process_reads_it(client: Any, tmp_path: Path) -> None:
    same(write_zarr(tmp_path / "grid.zarr", occupancies(site()), **FRAME), client)
    same(write_zarr(tmp_path / "dark.zarr", 255 - site(), negate=1, **FRAME), client)
    same(write_tiff(tmp_path / "up.tif", site()[::-1], upwards=True), client)
    same(write_tiff(tmp_path / "signed.tif", occupancies(site())[::-1], nodata=-1), client)
    same(write_tiff(tmp_path / "deep.tif", site().astype(np.uint16) * 257), client)
    yaml = tmp_path / "site.yaml"
    write_pgm(tmp_path / "site.pgm", site())
    yaml.write_text("image: site.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\n")
    same(yaml, client)


def test_occupancy_is_by_percent_though_only_states_are_sent(client: Any, tmp_path: Path) -> None:
    path = write_zarr(tmp_path / "shaded.zarr", shaded())
    found = same(path, client, {"mode": "scale"}, **FRAME)
    assert len(set(found.occupancy.faces.round(4).tolist())) > 20
    with pytest.raises(groundplan.ParameterError, match="no map"):  # its pixels are not here
        found.update(np.zeros((3, 3), np.uint8), 0, 0)


def test_what_cannot_be_read_by_rows_is_read_here_and_sent(client: Any, tmp_path: Path) -> None:
    from PIL import Image

    Image.fromarray(site()).save(tmp_path / "site.png")
    same(tmp_path / "site.png", client, **FRAME)
    (tmp_path / "plain.pgm").write_text("P2\n4 2\n255\n0 0 254 254 0 0 254 254\n")
    same(tmp_path / "plain.pgm", client, **FRAME)


def test_what_is_odd_about_the_greys_is_found_by_counting_on_the_workers(client: Any, tmp_path: Path) -> None:
    grey = np.select([site() == OCCUPIED, site() == FREE], [90, 250], 128).astype(np.uint8)
    found = same(write_pgm(tmp_path / "grey.pgm", grey), client, **FRAME)
    assert found.warnings


def test_own_stages_and_parameters_hold_on_a_cluster_too(client: Any) -> None:
    map = groundplan.from_array(site(), **FRAME)
    lines = groundplan.Lines.of([0, 1, 1], [3.0, 5.0, 9.0])
    directions = groundplan.Directions.of([0.1, 1.2])
    cases: list[dict[str, Any]] = [
        {"lines": lines},
        {"lines": lines, "directions": directions},
        {"directions": directions, "labels_method": "paper"},
        {"gradients_radius": 1.6, "directions_count": 1},
    ]
    for own in cases:
        found = groundplan.survey(map, client=client, **own)
        assert found.to_json() == groundplan.survey(map, threads=1, **own).to_json()


def test_lines_that_do_not_fit_are_refused_as_everywhere(client: Any) -> None:
    for parallel in (None, client):
        with pytest.raises(groundplan.ParameterError, match="a direction that there is not") as caught:
            groundplan.survey(hall(), resolution=RESOLUTION, lines=groundplan.Lines.of([77], [3.0]), client=parallel)
        assert caught.value.code == "stage.input"


def test_however_the_map_is_cut_the_bytes_are_the_same(client: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    map = groundplan.from_array(ZOO["two_blocks_of_racks"](), **FRAME)
    expected = groundplan.survey(map, threads=1).to_json()
    for rows in (5, 33, 10_000):
        monkeypatch.setattr(_cluster, "PIXELS", rows * map.width)
        monkeypatch.setattr(_cluster, "ROWS", rows)
        assert groundplan.survey(map, client=client).to_json() == expected


def test_a_survey_from_a_cluster_is_updated(client: Any, tmp_path: Path) -> None:
    path = write_pgm(tmp_path / "site.pgm", site())
    patch = np.full((40, 30), OCCUPIED, np.uint8)
    now = site()
    now[100:140, 50:80] = patch
    found = groundplan.survey(path, client=client, keep=True, **FRAME).update(patch, 100, 50)
    expected = groundplan.survey(groundplan.read(write_pgm(path, now), **FRAME))
    assert found.to_json() == expected.to_json()


def test_the_program_takes_the_address_of_a_scheduler(
    cluster: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write_zarr(tmp_path / "big.zarr", hall(), **FRAME)
    assert call(capsys, "survey", path, "-q", "-o", tmp_path / "one", "--threads", "1").code == 0
    ran = call(capsys, "survey", path, "-o", tmp_path / "many", "--dask", cluster.scheduler_address)
    assert ran.code == 0, ran.err
    one, many = ((tmp_path / name / "survey.json").read_bytes() for name in ("one", "many"))
    assert one == many
    assert {name.rpartition("/")[2] for name in files(tmp_path / "many")} == {"survey.json", "survey.png"}


def test_where_no_scheduler_answers_it_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(_cluster, "TIMEOUT_S", 1)
    path = write_zarr(tmp_path / "big.zarr", hall(), **FRAME)
    for address in ("tcp://127.0.0.1:9", "nowhere"):
        ran = call(capsys, "survey", path, "-o", tmp_path / "out", "--dask", address)
        assert ran.code != 0 and f"no Dask scheduler answers at {address}" in ran.err and "hint:" in ran.err
    assert not (tmp_path / "out").exists()


def test_where_there_are_no_workers_it_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(_cluster, "TIMEOUT_S", 1)
    path = write_zarr(tmp_path / "big.zarr", hall(), **FRAME)
    with distributed.LocalCluster(n_workers=0, host="127.0.0.1", dashboard_address="127.0.0.1:0") as idle:
        ran = call(capsys, "survey", path, "-o", tmp_path / "out", "--dask", idle.scheduler_address)
    assert ran.code != 0 and "has no workers" in ran.err and "dask worker tcp://" in ran.err


def test_what_is_no_client_is_refused(cluster: Any) -> None:
    for other in ("tcp://127.0.0.1:8786", cluster):
        with pytest.raises(groundplan.ParameterError, match="the client is a ") as caught:
            groundplan.survey(hall(), resolution=RESOLUTION, client=other)
        assert caught.value.code == "cluster.client"


def test_a_worker_of_another_version_is_told(client: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("groundplan._cluster._core.version", lambda: "99.0")
    with pytest.raises(GroundplanError, match=r"and 99\.0 is asked of it") as caught:
        groundplan.survey(hall(), resolution=RESOLUTION, client=client)
    assert caught.value.code == "cluster.version"


def test_what_a_worker_cannot_read_is_told_as_one_process_tells_it(client: Any, tmp_path: Path) -> None:
    path = write_zarr(tmp_path / "broken.zarr", site(), **FRAME)
    (path / "c" / "5" / "0").write_bytes(b"no chunk")
    with pytest.raises(MapError, match=r"broken\.zarr is a damaged Zarr array") as caught:
        groundplan.survey(path, client=client)
    assert caught.value.code == "map.corrupt"
    with pytest.raises(MapError, match="does not exist"):
        groundplan.survey(tmp_path / "none.zarr", client=client)


def test_a_path_that_the_workers_do_not_have_is_told(client: Any, tmp_path: Path) -> None:
    path = write_pgm(tmp_path / "site.pgm", site())
    far = Distant(str(tmp_path / "elsewhere.pgm"), "mapped", site().shape)
    there = _cluster.Site(groundplan.read(path, **FRAME), far, np.bincount(site().ravel(), minlength=256))
    with pytest.raises(GroundplanError) as caught:
        _cluster.survey_site(there, client, {}, None, {})
    assert caught.value.code == "cluster.path" and "elsewhere.pgm" in str(caught.value)


def test_without_dask_the_command_that_installs_it_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    path = write_zarr(tmp_path / "big.zarr", hall(), **FRAME)
    ran = call(capsys, "survey", path, "--dask", "tcp://127.0.0.1:8786", "-o", tmp_path / "out")
    assert ran.code == 2 and "distributed is not installed" in ran.err and "groundplan[dask]" in ran.err
