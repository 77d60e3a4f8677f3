"""Simulated offices: their truth against their pixels, and the scores of regions against the published script."""

from __future__ import annotations

import importlib.util
import json
import sys
import types
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from _simulated import along, states
from PIL import Image

from groundplan import read
from groundplan._errors import FormatError, MapError, ParameterError
from groundplan._polygons import fill
from groundplan.evaluate import score_regions, suite
from groundplan.evaluate._regions import region_scores, truth_labels
from groundplan.maps._map import FREE, OCCUPIED
from groundplan.simulate import OfficeOptions, Simulated, office
from groundplan.simulate._plan import inset

SCRIPTS = Path(__file__).parents[2] / "shared" / "tools"
MAPS = Path(__file__).parents[2] / "shared" / "maps" / "bormann"
SMALL: dict[str, Any] = {"width": 26.0, "depth": 22.0, "scan_every": 0.5, "beams": 400, "drift": 0.0}
SHAPES: list[dict[str, Any]] = [
    {"shape": "straight", "yaw": 12.0},
    {"shape": "L", "furniture": 0.0},
    {"shape": "T", "closed": 0.3, "yaw": -33.0},
    {"shape": "ring", "width": 30.0, "depth": 24.0, "halls": 1},
]


@cache
def small(**changes: Any) -> Simulated:
    return office(seed=3, **(SMALL | changes))


def survey_of(simulated: Simulated, wrong: np.random.Generator | None = None) -> dict[str, Any]:
    """A survey with the true regions; with `wrong`, some of them moved, left out, or joined."""
    m, labels = simulated.map, []
    for room in simulated.truth["rooms"]:
        if room["observed"] and (wrong is None or wrong.random() < 0.8):
            shift = wrong.normal(0, 0.5, 2) if wrong is not None else np.zeros(2)
            label = {"kind": "region", "use": room["use"], "polygon": (np.array(room["polygon"]) + shift).tolist()}
            labels.append(label | ({"holes": room["holes"]} if "holes" in room else {}))
    return {"map": {"origin": list(m.origin), "resolution": m.resolution}, "labels": labels}


def test_same_seed_same_bytes_and_another_seed_others() -> None:
    first, again, other = office(seed=3, **SMALL), office(seed=3, **SMALL), office(seed=4, **SMALL)
    assert first.rooms is not None and again.rooms is not None
    assert first.map.pixels.tobytes() == again.map.pixels.tobytes() != other.map.pixels.tobytes()
    assert first.rooms.tobytes() == again.rooms.tobytes()
    assert json.dumps(first.truth) == json.dumps(again.truth)


@pytest.mark.parametrize("changes", SHAPES, ids=lambda changes: str(changes["shape"]))
def test_truth_lies_where_the_map_shows_it(changes: dict[str, Any]) -> None:
    simulated = small(**changes)
    truth, rim = simulated.truth, simulated.map.pixels.copy()
    rim[1:-1, 1:-1] = 205
    assert (rim == 205).all()  # nothing is cut off
    assert truth["directions"] and len(truth["lines"]) > 40
    for corridor in truth["corridors"]:
        assert np.mean(states(simulated, along(corridor["a"], corridor["b"])) == FREE) > 0.95
    for line in truth["lines"]:
        points, normal = along(line["p"], line["q"]), np.array(line["normal"])
        looks = [states(simulated, points + off * normal) == OCCUPIED for off in np.arange(-0.15, 0.16, 0.05)]
        assert np.mean(np.any(looks, axis=0)) > 0.3
    open_doors = [door for door in truth["doors"] if door["state"] == "open" and door["observed"]]
    assert open_doors
    for door in open_doors:
        assert states(simulated, np.array([door["at"]]))[0] == FREE
    assert sum(room["use"] == "corridor" for room in truth["rooms"]) == 1
    for door in truth["doors"]:
        assert (
            door["a"] != door["b"]
            and min(door["a"], door["b"]) >= 0
            and max(door["a"], door["b"]) < len(truth["rooms"])
        )


@pytest.mark.parametrize("changes", SHAPES, ids=lambda changes: str(changes["shape"]))
def test_the_picture_of_the_rooms_has_each_observed_room_once(changes: dict[str, Any]) -> None:
    simulated = small(**changes)
    assert simulated.rooms is not None
    labels = truth_labels(simulated.rooms)
    observed = [room for room in simulated.truth["rooms"] if room["observed"]]
    assert labels.max() == len(observed)
    assert score_regions(survey_of(simulated), simulated.map, simulated.rooms)["iou_1to1"] > 0.8
    if not changes.get("furniture", 0.5):
        scores = score_regions(survey_of(simulated), simulated.map, simulated.rooms)
        assert scores["iou_1to1"] > 0.95 and scores["mcc"] == 1.0


def test_what_lies_behind_closed_doors_is_not_asked_for() -> None:
    shut = small(shape="straight", closed=0.5)
    hidden = [room for room in shut.truth["rooms"] if not room["observed"]]
    assert hidden and any(door["state"] == "closed" and not door["observed"] for door in shut.truth["doors"])


def test_the_corridors_meet_as_their_shape_has_it() -> None:
    def types(shape: str) -> list[str]:
        return [j["type"] for j in small(shape=shape, width=30.0, depth=24.0).truth["junctions"]]

    assert [types(s) for s in ("straight", "L", "T", "ring")] == [[], ["L"], ["T"], ["L"] * 4]


def test_an_office_is_written_with_its_rooms(tmp_path: Path) -> None:
    simulated = small(shape="straight")
    path = simulated.write(tmp_path, "office")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["office.gt.png", "office.pgm", "office.yaml", "truth.json"]
    with Image.open(tmp_path / "office.gt.png") as image:
        assert simulated.rooms is not None and (np.array(image) == simulated.rooms).all()
    survey = survey_of(simulated)
    scores = score_regions(survey, simulated.map, simulated.rooms)
    assert score_regions(survey, read(path), tmp_path / "office.gt.png") == scores


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        ({"shape": "star"}, "simulate.shape"),
        ({"closed": 1.5}, "simulate.range"),
        ({"doors": 1}, "simulate.unknown"),
        ({"shape": "ring", "depth": 14.0}, "simulate.small"),
    ],
)
def test_wrong_options_are_named(changes: dict[str, Any], code: str) -> None:
    with pytest.raises(ParameterError) as caught:
        office(**changes)
    assert caught.value.code == code


def test_an_outline_is_inset_on_all_sides() -> None:
    ell: list[tuple[float, float]] = [(0, 0), (4, 0), (4, 1), (1, 1), (1, 3), (0, 3)]
    smaller = [(0.1, 0.1), (3.9, 0.1), (3.9, 0.9), (0.9, 0.9), (0.9, 2.9), (0.1, 2.9)]
    assert np.allclose(inset(ell, 0.1), smaller)


def test_a_polygon_is_filled_where_pixels_have_their_centres() -> None:
    square = [(1.0, 1.0), (5.0, 1.0), (5.0, 4.0), (1.0, 4.0)]
    mask = fill([square, [(2.0, 2.0), (3.0, 2.0), (3.0, 3.0), (2.0, 3.0)]], (6, 8))
    expected = np.zeros((6, 8), dtype=bool)
    expected[1:4, 1:5] = True
    expected[2, 2] = False
    assert (mask == expected).all()
    assert fill([[(-9.0, -9.0), (99.0, -9.0), (99.0, 99.0), (-9.0, 99.0)]], (4, 4)).all()
    assert not fill([], (4, 4)).any()
    from matplotlib.path import Path as Outline

    star = np.random.default_rng(1).uniform(0, 40, (9, 2))
    centres = np.stack(np.meshgrid(np.arange(40) + 0.5, np.arange(40) + 0.5), axis=-1).reshape(-1, 2)
    crossed = sum(
        ((a[1] <= centres[:, 1]) != (b[1] <= centres[:, 1]))
        & (centres[:, 0] < a[0] + (centres[:, 1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
        for a, b in zip(star, np.roll(star, -1, axis=0), strict=True)
    )
    assert (fill([star], (40, 40)).ravel() == (np.asarray(crossed) % 2 == 1)).all()
    triangle = star[:3]
    assert (fill([triangle], (40, 40)).ravel() == Outline(triangle).contains_points(centres)).all()


def published() -> Any:
    """The published script, whose measures need no OpenCV: an empty module stands in for it."""
    script = SCRIPTS / "evaluate_rooms.py"
    if not script.is_file():
        pytest.skip("the published script is not beside this repository")
    spec = importlib.util.spec_from_file_location("published_rooms", script)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    present = sys.modules.get("cv2")
    sys.modules["cv2"] = present or types.ModuleType("cv2")
    try:
        spec.loader.exec_module(module)
    finally:
        if present is None:
            del sys.modules["cv2"]
    return module


def test_scores_agree_with_the_published_script() -> None:
    script = published()
    random = np.random.default_rng(8)
    for _ in range(30):
        # Blocks of labels, the second image's partly those of the first.
        first, other = (np.kron(random.integers(0, 9, (8, 8)), np.ones((12, 12), dtype=int)) for _ in range(2))
        second = np.where(np.kron(random.random((8, 8)) < 0.7, np.ones((12, 12))) > 0, first, other)
        found, true = script.drop_small(np.roll(second, 3, axis=0)), script.drop_small(first)
        expected, mine = script.evaluate(found, true), region_scores(found.astype(np.int64), true.astype(np.int64))
        assert mine["iou_1to1"] == pytest.approx(expected["iou_1to1"], abs=6e-5)
        assert mine["mcc"] == pytest.approx(expected["mcc"], abs=6e-5)
        assert (mine["rooms"], mine["regions"]) == (expected["n_gt"], expected["n_seg"])
    empty = np.zeros((96, 96), dtype=np.int64)
    assert region_scores(empty, empty) == {"iou_1to1": 0.0, "mcc": 0.0, "rooms": 0, "regions": 0}


def test_wrong_regions_score_less() -> None:
    simulated = small(shape="L", furniture=0.0)
    assert simulated.rooms is not None
    right = score_regions(survey_of(simulated), simulated.map, simulated.rooms)
    wrong = score_regions(survey_of(simulated, np.random.default_rng(2)), simulated.map, simulated.rooms)
    none = score_regions(survey_of(simulated) | {"labels": []}, simulated.map, simulated.rooms)
    assert right["iou_1to1"] > wrong["iou_1to1"] > none["iou_1to1"] == 0.0
    assert right["regions"] > wrong["regions"] > none["regions"] == 0


def test_what_cannot_be_scored_is_said(tmp_path: Path) -> None:
    simulated = small(shape="straight")
    (tmp_path / "text.png").write_text("no picture")
    with pytest.raises(MapError, match=r"text\.png"):
        score_regions(survey_of(simulated), simulated.map, tmp_path / "text.png")
    with pytest.raises(FormatError, match="4 x 3 pixels"):
        score_regions(survey_of(simulated), simulated.map, np.zeros((3, 4), dtype=np.uint8))
    with pytest.raises(FormatError) as caught:
        score_regions({"labels": [{"kind": "region"}], "map": {}}, simulated.map, np.zeros_like(simulated.map.pixels))
    assert caught.value.code == "score.format"


def test_the_office_suite_has_twenty_valid_cases() -> None:
    cases = suite("offices")
    assert [case.kind for case in cases] == ["empty"] * 10 + ["furnished"] * 10
    assert len({case.name for case in cases}) == len({case.options["seed"] for case in cases}) == 20
    for case in cases:
        OfficeOptions(**{k: v for k, v in case.options.items() if k != "seed"})
    assert {case.options.get("shape", "straight") for case in cases} == {"straight", "L", "T", "ring"}


def test_the_rooms_are_read_where_they_lie(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("GROUNDPLAN_ROOM_MAPS", str(tmp_path))
    with pytest.raises(ParameterError, match="no maps") as caught:
        suite("rooms")
    assert caught.value.code == "suite.maps" and caught.value.hint is not None and "--maps" in caught.value.hint
    if not MAPS.is_dir():
        pytest.skip("the maps of Bormann et al. are not beside this repository")
    cases = suite("rooms", MAPS)
    assert [case.kind for case in cases] == ["empty"] * 10 + ["furnished"] * 10
    map = read(cases[0].options["map"])
    nothing = {"map": {"origin": list(map.origin), "resolution": map.resolution}, "labels": []}
    assert score_regions(nothing, map, cases[0].options["truth"])["rooms"] == 10
