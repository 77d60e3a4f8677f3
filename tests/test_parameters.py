"""Parameters: one table, and every way to set one of it comes to the same."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from _program import call, hall, write_map

import groundplan
from groundplan.parameters import parse, read_toml, resolve, table

Capture = pytest.CaptureFixture[str]

SETTINGS: dict[str, Any] = {
    "lines.snr": 4.5,
    "lines.detail": 0.25,
    "directions.angles_deg": [0.0, 90.0],
    "directions.separation_deg": 6.0,
    "labels.method": "paper",
}


@pytest.fixture(autouse=True)
def _in_a_directory_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write_map(tmp_path)


def in_force(capsys: Capture, *words: str) -> dict[str, Any]:
    """The parameters of a survey made with these flags."""
    ran = call(capsys, "survey", "hall.yaml", "--json", *words)
    assert ran.code == 0, ran.err
    parameters: dict[str, Any] = json.loads(ran.out)["parameters"]
    return parameters


def test_keywords_flags_and_file_agree(tmp_path: Path, capsys: Capture) -> None:
    keywords = {name.replace(".", "_", 1): value for name, value in SETTINGS.items()}
    expected = groundplan.survey(hall(), resolution=0.05, **keywords).parameters
    assert expected == resolve(SETTINGS)
    flags = [f"{name}={str(value).strip('[]').replace(' ', '')}" for name, value in SETTINGS.items()]
    assert in_force(capsys, *(word for flag in flags for word in ("--set", flag))) == expected
    (tmp_path / "settings.toml").write_text(
        "[lines]\nsnr = 4.5\ndetail = 'coarse'\n[directions]\nangles_deg = [0, 90]\nseparation_deg = 6\n"
        "[labels]\nmethod = 'paper'\n"
    )
    assert in_force(capsys, "--config", "settings.toml") == expected
    (tmp_path / "dotted.toml").write_text(
        "".join(f"{name} = {json.dumps(value)}\n" for name, value in SETTINGS.items())
    )
    assert in_force(capsys, "--config", "dotted.toml") == expected
    own_flags = ["--direction", "0", "90", "--detail", "coarse"]
    settings = ["lines_snr=4.5", "labels.method=paper", "directions.separation_deg=6"]
    assert in_force(capsys, *own_flags, *(word for one in settings for word in ("--set", one))) == expected


def test_a_flag_beats_the_file_and_the_file_the_default(tmp_path: Path, capsys: Capture) -> None:
    default = in_force(capsys)
    (tmp_path / "settings.toml").write_text("lines.snr = 7\nwalls.occupancy = 0.6\n")
    filed = in_force(capsys, "--config", "settings.toml")
    assert filed == default | {"lines.snr": 7.0, "walls.occupancy": 0.6}
    flagged = in_force(capsys, "--config", "settings.toml", "--set", "lines.snr=2")
    assert flagged == filed | {"lines.snr": 2.0}
    assert in_force(capsys, "--set", "lines.snr=2", "--set", "lines.snr=3")["lines.snr"] == 3.0


def test_a_flag_takes_back_what_the_file_says_of_the_same_thing(tmp_path: Path, capsys: Capture) -> None:
    (tmp_path / "settings.toml").write_text("directions.angles_deg = [1, 91]\nlines.min_amplitude = 5\n")
    got = in_force(capsys, "--config", "settings.toml", "--directions", "1", "--detail", "0.5")
    assert (got["directions.angles_deg"], got["directions.count"]) == (None, 1)
    assert (got["lines.min_amplitude"], got["lines.detail"]) == (None, 0.5)
    (tmp_path / "settings.toml").write_text("directions.count = 1\n")
    got = in_force(capsys, "--config", "settings.toml", "--direction", "-10", "80.5")
    assert (got["directions.angles_deg"], got["directions.count"]) == ([-10.0, 80.5], None)


def test_auto_gives_a_value_back_to_finding_itself(tmp_path: Path, capsys: Capture) -> None:
    (tmp_path / "settings.toml").write_text("lines.detail = 0.5\n")
    assert in_force(capsys, "--config", "settings.toml", "--set", "lines.detail=auto")["lines.detail"] is None


def test_a_fault_in_the_file_names_the_file_and_the_nearest_parameter(tmp_path: Path, capsys: Capture) -> None:
    (tmp_path / "settings.toml").write_text("[lines]\nsnrr = 3\n")
    ran = call(capsys, "survey", "hall.yaml", "--config", "settings.toml")
    assert ran.code == 2
    assert ran.err == "error: settings.toml: there is no parameter lines.snrr\nhint: did you mean lines.snr?\n"


def test_a_setting_that_is_a_flag_s_is_told_the_flag(tmp_path: Path, capsys: Capture) -> None:
    (tmp_path / "settings.toml").write_text("resolution = 0.1\n")
    ran = call(capsys, "survey", "hall.yaml", "--config", "settings.toml")
    said = "there is no parameter resolution\nhint: did you mean the flag --resolution?\n"
    assert (ran.code, ran.err) == (2, f"error: settings.toml: {said}")
    (tmp_path / "settings.toml").write_text("[map]\nresolution = 0.1\n")
    ran = call(capsys, "survey", "hall.yaml", "--config", "settings.toml")
    assert ran.err == f"error: settings.toml: {said.replace('parameter ', 'parameter map.')}"
    (tmp_path / "settings.toml").write_text("[lines]\nthreads = 3\n")
    ran = call(capsys, "survey", "hall.yaml", "--config", "settings.toml")
    assert "there is no parameter lines.threads\nhint: did you mean the flag --threads?" in ran.err
    ran = call(capsys, "survey", "hall.yaml", "--set", "lines.snr=4", "--set", "resolution=0.1", "--set", "origin=0,0")
    assert (ran.code, ran.err) == (2, f"error: {said}")


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("lines.snr=4", ("lines.snr", 4.0)),
        (" lines.snr = 4 ", ("lines.snr", 4.0)),
        ("lines.detail=fine", ("lines.detail", "fine")),
        ("directions.angles_deg=1,2.5", ("directions.angles_deg", [1.0, 2.5])),
        ("directions.angles_deg=[1]", ("directions.angles_deg", [1.0])),
        ("directions.count=auto", ("directions.count", None)),
    ],
)
def test_a_setting_as_typed(text: str, value: tuple[str, Any]) -> None:
    assert parse(text) == value


def test_every_default_is_in_its_own_range() -> None:
    defaults = {row.name: row.default for row in table()}
    assert resolve(defaults) == resolve({}) == defaults


def ends() -> list[tuple[str, float]]:
    """Every parameter that is a number, with the least value that it takes and the greatest."""
    ranges = [(row.name, re.fullmatch(r"(\S+) to (\S+?)(, .*)?", row.range)) for row in table()]
    return [(name, float(found[n])) for name, found in ranges if found for n in (1, 2)]


@pytest.mark.parametrize(("name", "value"), ends())
def test_a_survey_ends_at_either_end_of_a_range(name: str, value: float) -> None:
    settings: dict[str, Any] = {name: value}
    is_least = ".min_" in name
    mate = name.replace(".min_", ".max_") if is_least else name.replace(".max_", ".min_")
    default = resolve({}).get(mate)
    if mate != name and default is not None:
        settings[mate] = max(value, default) if is_least else min(value, default)
    survey = groundplan.survey(
        hall(), resolution=0.05, **{key.replace(".", "_", 1): own for key, own in settings.items()}
    )
    assert survey.parameters[name] == value
    assert survey.problems() == []


def test_toml_tables_and_dotted_names_are_one(tmp_path: Path) -> None:
    (tmp_path / "a.toml").write_text("[lines]\nsnr = 4\ndetail = 'auto'\n")
    (tmp_path / "b.toml").write_text("lines.snr = 4\nlines.detail = 'auto'\n")
    assert read_toml(tmp_path / "a.toml") == read_toml(tmp_path / "b.toml") == {"lines.snr": 4, "lines.detail": None}


def test_the_page_of_the_documentation_is_the_table(capsys: Capture) -> None:
    page = Path(__file__).parents[1] / "docs" / "parameters.md"
    assert page.read_text(encoding="utf-8") == call(capsys, "parameters", "--markdown").out, (
        "make the page anew: groundplan parameters --markdown > docs/parameters.md"
    )


@pytest.mark.parametrize("stage", ["labels", "lines", "pillars"])
def test_a_least_width_above_the_greatest_names_both(stage: str, capsys: Capture) -> None:
    settings: dict[str, Any] = {f"{stage}_min_width": 3.0, f"{stage}_max_width": 2.5}
    said = f"{stage}.min_width cannot be 3 where {stage}.max_width is 2.5"
    with pytest.raises(groundplan.ParameterError, match=said) as caught:
        groundplan.survey(hall(), resolution=0.05, **settings)
    assert caught.value.code == "parameter.range"
    with pytest.raises(groundplan.ParameterError, match=said):
        resolve(settings)
    flags = (word for name, value in settings.items() for word in ("--set", f"{name}={value}"))
    ran = call(capsys, "survey", "hall.yaml", "--json", *flags)
    assert ran.code == 2 and said in ran.err
    settings = dict.fromkeys(settings, 3.0)
    groundplan.survey(hall(), resolution=0.05, **settings)


def test_a_name_that_there_is_not_is_told_as_it_was_typed() -> None:
    for name, hint in (("free_thresh", "lists them all"), ("lines_snrr", "did you mean lines.snr?")):
        with pytest.raises(groundplan.ParameterError, match=f"there is no parameter {name}$") as caught:
            groundplan.survey(hall(), resolution=0.05, **{name: 0.2})  # type: ignore[arg-type]
        assert hint in str(caught.value.hint)


def test_a_name_that_there_is_not_is_told_whatever_its_value() -> None:
    with pytest.raises(groundplan.ParameterError, match="there is no parameter parameters"):
        groundplan.survey(hall(), resolution=0.05, parameters={"labels.min_width": 1.0})
