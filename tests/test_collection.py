"""The collection of maps beside the repository is read as it was meant."""

from __future__ import annotations

from pathlib import Path

import pytest
from _reading import codes, shares

from groundplan.maps import read


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
