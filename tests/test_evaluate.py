"""The scores: what they say of a perfect and of a poor survey, and whether they agree with the published script."""

from __future__ import annotations

import importlib.util
import json
import math
import sys
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from groundplan._errors import FormatError, GroundplanError, ParameterError
from groundplan.evaluate import score, suite, suites
from groundplan.simulate import WarehouseOptions, warehouse

SCRIPT = Path(__file__).parents[2] / "shared" / "tools" / "evaluate_survey.py"

FORMAT = {"format": "groundplan-survey", "version": 1}

PERFECT = {
    "direction_error_deg": 0.0,
    "direction_extra": 0,
    "line_recall": 1.0,
    "junction_f1": 1.0,
    "junction_typed_f1": 1.0,
    "corridor_recall": 1.0,
    "corridor_precision": 1.0,
}


@cache
def truth() -> dict[str, Any]:
    options: dict[str, Any] = {"width": 30.0, "depth": 24.0, "yaw": 21.0, "skew": 6.0, "partial": 0.35}
    return warehouse(seed=2, scan_every=0.6, beams=360, lidar_range=7.0, drift=0.0, **options).truth


def survey_of(true: dict[str, Any], random: np.random.Generator | None = None) -> dict[str, Any]:
    """A survey that says what the truth says; with `random`, one that is wrong in all ways a little."""

    def off(scale: float) -> float:
        return float(random.normal(0, scale)) if random else 0.0

    def kept() -> bool:
        return random is None or random.random() < 0.8

    directions = [{"angle": a + off(0.004), "weight": 1.0} for a in true["directions"]]
    lines, labels = [], []
    for line in true["lines"]:
        angle = math.atan2(line["normal"][1], line["normal"][0]) - math.pi / 2
        gaps = [abs((angle - d["angle"] + math.pi / 2) % math.pi - math.pi / 2) for d in directions]
        family = int(np.argmin(gaps))
        normal = (-math.sin(directions[family]["angle"]), math.cos(directions[family]["angle"]))
        middle = [(line["p"][k] + line["q"][k]) / 2 for k in (0, 1)]
        if kept():
            offset = normal[0] * middle[0] + normal[1] * middle[1] + off(0.1)
            lines.append({"direction": family, "offset": offset, "amplitude": 1.0, "width": 0.1})
    for corridor in true["corridors"]:
        a, b = np.array(corridor["a"]) + off(0.3), np.array(corridor["b"]) + off(0.3)
        across = np.array([a[1] - b[1], b[0] - a[0]]) / np.linalg.norm(b - a) * (corridor["width"] / 2 + off(0.3))
        polygon = [(a - across).tolist(), (b - across).tolist(), (b + across).tolist(), (a + across).tolist()]
        if kept():
            labels.append({"kind": "corridor", "polygon": polygon, "axis": [a.tolist(), b.tolist()]})
    for junction in true["junctions"]:
        if kept():
            kind = junction["type"] if kept() or random is None else str(random.choice(["L", "T", "X", "Y", "end"]))
            at = [junction["at"][0] + off(0.8), junction["at"][1] + off(0.8)]
            labels.append({"kind": "junction", "type": kind, "at": at})
    return {**FORMAT, "directions": directions, "lines": lines, "labels": labels}


def test_a_perfect_survey_scores_full_marks() -> None:
    scores = score(survey_of(truth()), truth())
    error = scores.pop("line_error_m")
    assert {key: scores[key] for key in PERFECT} == PERFECT
    assert error < 0.02


def test_an_empty_survey_scores_nothing() -> None:
    scores = score({**FORMAT, "directions": [], "lines": [], "labels": []}, truth())
    assert scores["direction_error_deg"] == 180.0
    assert scores["line_recall"] == 0.0 and scores["line_error_m"] is None
    assert scores["junction_typed_f1"] == 0.0
    assert scores["corridor_recall"] == 0.0 and scores["corridor_precision"] == 0.0


def test_what_was_not_observed_counts_neither_way() -> None:
    assert any(not j["observed"] for j in truth()["junctions"])
    survey = survey_of(truth())
    hidden = [j["at"] for j in truth()["junctions"] if not j["observed"]]
    survey["labels"] = [la for la in survey["labels"] if la["kind"] != "junction" or la["at"] not in hidden]
    assert score(survey, truth())["junction_typed_f1"] == 1.0
    survey["labels"].append({"kind": "junction", "type": "L", "at": hidden[0]})
    assert score(survey, truth())["junction_typed_f1"] == 1.0


def racks_of(true: dict[str, Any], moved: float = 0.0) -> dict[str, Any]:
    """A survey with the observed racks of a truth and no more, each moved along itself by a share of its length."""
    labels = []
    for rack in (rack for rack in true["racks"] if rack["observed"]):
        a, b = np.array(rack["a"]), np.array(rack["b"])
        across = np.array([a[1] - b[1], b[0] - a[0]]) / np.linalg.norm(b - a) * rack["width"] / 2
        ends = [a + moved * (b - a), b + moved * (b - a)]
        polygon = [ends[0] - across, ends[1] - across, ends[1] + across, ends[0] + across]
        axis = [end.tolist() for end in ends]
        labels.append({"kind": "rack", "polygon": [corner.tolist() for corner in polygon], "axis": axis, "pitch": None})
    return {**survey_of(true), "labels": labels}


def test_racks_are_right_where_their_outlines_overlap_by_half_of_their_union() -> None:
    site = truth()
    assert 0 < sum(rack["observed"] for rack in site["racks"]) < len(site["racks"])
    for moved, right in ((0.0, 1.0), (0.3, 1.0), (0.4, 0.0)):
        scores = score(racks_of(site, moved), site)
        assert scores["rack_recall"] == scores["rack_precision"] == right
    scores = score({**survey_of(site), "labels": []}, site)
    assert scores["rack_recall"] == 0.0 and scores["rack_precision"] is None


def test_dead_ends_are_not_held_against_a_survey() -> None:
    survey = survey_of(truth())
    survey["labels"].append({"kind": "junction", "type": "end", "at": [0.0, 0.0]})
    assert score(survey, truth())["junction_f1"] == 1.0


def test_a_wrong_type_counts_only_where_types_do() -> None:
    survey = survey_of(truth())
    first = next(la for la in survey["labels"] if la["kind"] == "junction" and la["type"] != "X")
    first["type"] = "X"
    scores = score(survey, truth())
    assert scores["junction_typed_f1"] < scores["junction_f1"] == 1.0


def test_scores_agree_with_the_published_script() -> None:
    if not SCRIPT.is_file():
        pytest.skip("the published script is not beside this repository")
    spec = importlib.util.spec_from_file_location("published", SCRIPT)
    assert spec is not None and spec.loader is not None
    published = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(published)
    random = np.random.default_rng(5)
    surveys = [survey_of(truth()), *(survey_of(truth(), random) for _ in range(12))]
    surveys.append({**FORMAT, "directions": [], "lines": [], "labels": []})
    for survey in surveys:
        expected = published.score(survey, truth())
        mine = score(survey, truth())
        assert {key: mine[key] for key in expected} == expected
        assert list(mine)[: len(expected)] == list(expected)


def test_files_are_read_and_what_is_wrong_with_them_is_said(tmp_path: Path) -> None:
    right, broken = tmp_path / "truth.json", tmp_path / "survey.json"
    right.write_text(json.dumps(truth()))
    assert score(survey_of(truth()), right)["line_recall"] == 1.0
    broken.write_text("{")
    for source, code in (
        (tmp_path / "none.json", "file.read"),
        (broken, "file.json"),
        ({"lines": []}, "survey.format"),
    ):
        with pytest.raises(FormatError) as caught:
            score(source, right)
        assert caught.value.code == code
    with pytest.raises(FormatError, match="offset") as caught:
        score({**FORMAT, "directions": [{"angle": 0.0}], "lines": [{"direction": 0}], "labels": []}, right)
    assert caught.value.code == "score.format"


def test_a_missing_extra_names_its_remedy(monkeypatch: pytest.MonkeyPatch) -> None:
    survey = survey_of(truth())
    monkeypatch.setitem(sys.modules, "scipy.optimize", None)
    with pytest.raises(GroundplanError) as caught:
        score(survey, truth())
    assert caught.value.code == "extra.missing"
    assert caught.value.hint is not None and "groundplan[evaluate]" in caught.value.hint


def test_the_warehouse_suite_has_forty_valid_cases_in_two_halves() -> None:
    assert "warehouses" in suites()
    cases = suite("warehouses")
    assert [case.kind for case in cases] == ["regular"] * 20 + ["hard"] * 20
    assert len({case.name for case in cases}) == len({case.options["seed"] for case in cases}) == 40
    for case in cases:
        WarehouseOptions(**{k: v for k, v in case.options.items() if k != "seed"})
    for varied in ("yaw", "skew", "clutter", "drift", "sparse", "partial", "closed_sides", "width"):
        assert any(varied in case.options for case in cases[:20])
    for varied in ("halls", "crosswise", "gap", "wing", "staggered", "uneven", "goods", "bend", "lidar_range"):
        assert any(varied in case.options for case in cases[20:])


def test_an_unknown_suite_is_named() -> None:
    with pytest.raises(ParameterError, match="castles"):
        suite("castles")


@pytest.mark.parametrize(
    ("change", "code", "said"),
    [
        ({"format": "another"}, "survey.format", "'another'"),
        ({"format": None}, "survey.format", "None"),
        ({"version": 2}, "survey.version", "version 2"),
    ],
)
def test_a_survey_of_another_format_is_refused_by_name(
    change: dict[str, Any], code: str, said: str, tmp_path: Path
) -> None:
    survey = tmp_path / "s.json"
    survey.write_text(json.dumps(survey_of(truth()) | change))
    with pytest.raises(FormatError, match=f"s.json: .*{said}") as caught:
        score(survey, truth())
    assert caught.value.code == code
