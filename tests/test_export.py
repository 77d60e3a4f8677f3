"""Exporting: one table says what there is, a path is a file or a directory, and nothing is left half-written."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from _exports import GOOD, ODD, demo, same_twice
from _program import call, files, start, write_map
from conftest import ROOT, SHARED

import groundplan
from groundplan import GroundplanError, ParameterError, simulate
from groundplan.export import FORMATS, OPTIONS, export
from groundplan.export._dates import moment
from groundplan.roadmap import road_map


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The example warehouse's survey in a file."""
    file = tmp_path_factory.mktemp("saved") / "survey.json"
    demo().write(file)
    return file


@pytest.mark.parametrize("name", FORMATS)
def test_every_format_has_a_test_that_reads_it_back(name: str) -> None:
    here = Path(__file__).parent
    own = here / f"test_export_{name.replace('-', '_')}.py"
    assert own.is_file() or f'"{name}"' in (here / "test_export_fleets.py").read_text("utf-8")


@pytest.mark.parametrize("name", FORMATS)
def test_every_format_says_who_reads_it_and_takes_options_that_there_are(name: str) -> None:
    form = FORMATS[name]
    assert (
        form.readers
        and form.tested
        and form.holds
        and form.suffix.startswith(".")
        and set(form.options) <= set(OPTIONS)
    )
    assert (form.extra is None) == (not form.needs) and form.map in ("no", "may", "must")


def test_every_extra_that_is_named_installs_what_is_needed() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    holds = {
        extra: {re.split(r"[^\w-]", line)[0] for line in lines}
        for extra, lines in project["optional-dependencies"].items()
    }
    calls = re.compile(r'needed\(f?"(\w+)[^"]*", "(\w+)"\)')
    sources = (ROOT / "python").rglob("*.py")
    named = {(library, extra) for path in sources for library, extra in calls.findall(path.read_text("utf-8"))}
    assert {library for library, _ in named} >= {"cyclonedds", "distributed", "pye57", "rasterio", "zarr"}
    named |= {(library, form.extra or "") for form in FORMATS.values() for library in form.needs}
    assert all(library in holds.get(extra, ()) for library, extra in named), named


def test_the_readme_has_a_row_for_every_format() -> None:
    rows = [line for line in (ROOT / "README.md").read_text("utf-8").splitlines() if line.startswith("| `")]
    table = [f"| `{form.name}` | {form.holds} | {form.readers} | {form.tested} |" for form in FORMATS.values()]
    assert [row for row in rows if row in table] == table


def test_every_option_is_some_format_s() -> None:
    assert {option for form in FORMATS.values() for option in form.options} == set(OPTIONS)


def test_no_two_formats_have_the_same_file() -> None:
    assert len({form.suffix for form in FORMATS.values()}) == len(FORMATS)


WAREHOUSE = ROOT / "examples" / "warehouse.yaml"
WITHOUT_MAP = [name for name, form in FORMATS.items() if form.map != "must"]


@pytest.mark.parametrize("which", ODD)
@pytest.mark.parametrize("name", WITHOUT_MAP)
def test_an_odd_survey_is_written_whole_or_refused_in_clear_words(name: str, which: str, tmp_path: Path) -> None:
    try:
        written = ODD[which]().export(tmp_path / "out", name)
    except GroundplanError as fault:
        assert fault.code.startswith("export.") and str(fault)
        assert files(tmp_path) == set()
    else:
        assert {str(file.relative_to(tmp_path)) for file in written} == files(tmp_path)
        assert all(file.stat().st_size for file in written)


@pytest.mark.parametrize("name", WITHOUT_MAP)
def test_exporting_twice_gives_the_same_bytes(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1777593600")
    assert same_twice(demo(), name, tmp_path)


@pytest.mark.parametrize("name", [name for name, form in FORMATS.items() if form.map != "no"])
def test_exporting_twice_with_the_map_gives_the_same_bytes(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1777593600")
    assert same_twice(demo(), name, tmp_path, map=groundplan.read(WAREHOUSE))


def test_another_process_writes_the_same_bytes(saved: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1777593600")
    for seed in "14":  # under these two, sets of the names that DXF has are in different order
        out = f"{tmp_path / seed}{os.sep}"
        ran = start("export", saved, "--to", "all", "--map", WAREHOUSE, "-o", out, PYTHONHASHSEED=seed)
        assert ran.code == 0, ran.err
    names = files(tmp_path / "1")
    assert len(names) >= len(FORMATS) and files(tmp_path / "4") == names
    assert [n for n in sorted(names) if len({(tmp_path / seed / n).read_bytes() for seed in "14"}) > 1] == []


@pytest.mark.parametrize("name", [name for name, form in FORMATS.items() if "date" in form.options])
def test_the_same_date_gives_the_same_bytes_and_another_others(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("SOURCE_DATE_EPOCH", raising=False)
    dates = ("2026-05-01T09:30:00+02:00", "2026-05-01T07:30:00Z", "2026-05-02")
    one, same, other = (
        demo().export(tmp_path / str(n) / "x", name, date=date)[0].read_bytes() for n, date in enumerate(dates)
    )
    assert one == same != other


@pytest.mark.parametrize("which", [*GOOD, *(which for which in ODD if which != "names")])
def test_a_survey_comes_back_equal_from_its_json(which: str) -> None:
    survey = (GOOD | ODD)[which]()
    assert groundplan.Survey.from_json(survey.to_json()) == survey


def test_every_published_schema_is_asked_by_a_test() -> None:
    schemas = SHARED / "schemas"
    if not schemas.is_dir():
        pytest.skip(f"needs the published schemas: no {schemas}")
    text = "".join(file.read_text("utf-8") for file in Path(__file__).parent.glob("test_*.py"))
    for file in schemas.iterdir():
        name = file.name.removeprefix("nav2-route-").removesuffix("_graph.geojson")
        assert f'"{name}"' in text or file.suffix == ".md", f"no test reads {file}"


def test_a_path_is_a_file_or_a_directory(tmp_path: Path) -> None:
    there = tmp_path / "there"
    there.mkdir()
    for path, expected in (
        (tmp_path / "plan.csv", "plan.csv"),
        (tmp_path / "deep" / "plan.csv", "deep/plan.csv"),
        (there, "there/warehouse.places.csv"),
        (tmp_path / "new", "new/warehouse.places.csv"),
        (f"{tmp_path / 'v1.2'}{os.sep}", "v1.2/warehouse.places.csv"),
    ):
        assert export(demo(), path, "csv") == [tmp_path / expected]
        assert (tmp_path / expected).is_file()


def test_a_format_may_be_told_by_the_name_s_end(tmp_path: Path) -> None:
    assert demo().export(tmp_path / "x.GRAPHML")[0].read_bytes().startswith(b"<?xml")
    with pytest.raises(ParameterError, match=r"the name 'x\.xyz' tells no format") as told:
        demo().export(tmp_path / "x.xyz")
    assert told.value.code == "export.format" and ".graphml" in str(told.value.hint)


def test_what_cannot_be_done_is_refused_before_anything_is_written(tmp_path: Path) -> None:
    for format, options, code in (
        ("cvs", {}, "export.format"),
        ("csv", {"units": "mm"}, "export.option"),
        ("graphml", {"graph": "trees"}, "export.graph"),
    ):
        with pytest.raises(ParameterError) as told:
            demo().export(tmp_path / "out", format, **options)
        assert told.value.code == code
    with pytest.raises(ParameterError, match="None is no path") as told:
        demo().export(None, "csv")  # type: ignore[arg-type]
    assert told.value.code == "export.path"
    assert files(tmp_path) == set()


def test_a_place_that_cannot_be_written_is_told(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(groundplan.FormatError, match="cannot write"):
        demo().export(tmp_path / "file" / "x.csv", "csv")


def test_a_missing_library_is_named_with_the_command_that_installs_it(
    saved: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "networkx", None)
    ran = call(capsys, "export", saved, "--to", "csv,graphml")
    assert ran.code == 2 and "networkx is not installed" in ran.err and "pip install 'groundplan[fleet]'" in ran.err
    assert not (saved.parent / "export").exists()


def test_the_program_writes_several_formats_beside_the_survey_and_prints_their_names(
    saved: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out.d"
    ran = call(capsys, "export", saved.parent, "--to", "csv,json,csv", "-o", out)
    assert (ran.code, ran.err) == (0, "")
    assert ran.out.split() == [str(out / "warehouse.places.csv"), str(out / "warehouse.graph.json")]
    beside = call(capsys, "export", saved, "--to", "csv", "-q")
    assert beside.out == "" and (saved.parent / "export" / "warehouse.places.csv").is_file()


def test_a_format_that_refuses_stops_no_other_and_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pixels = np.full((60, 60), 254, np.uint8)
    (tmp_path / "open.pgm").write_bytes(b"P5\n60 60\n255\n" + pixels.tobytes())
    yaml = "image: open.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\n"
    (tmp_path / "open.yaml").write_text(yaml + "occupied_thresh: 0.65\nfree_thresh: 0.196\n")
    ran = call(capsys, "survey", tmp_path / "open.yaml", "-o", tmp_path / "out", "--export", "all")
    assert ran.code == 3 and "refused: straight: the map has no direction" in ran.err
    assert ran.err.splitlines()[-1].startswith("error: not written: ") and "straight" in ran.err.splitlines()[-1]
    there = files(tmp_path / "out" / "export")
    refused = ran.err.splitlines()[-1].removeprefix("error: not written: ").split(", ")
    for name, form in FORMATS.items():
        assert (f"open{form.suffix}" in there) == (name not in refused)
    later = call(capsys, "export", tmp_path / "out", "--to", "straight,csv", "-o", tmp_path / "later")
    assert later.code == 3 and later.out.split() == [str(tmp_path / "later" / "open.places.csv")]
    alone = call(capsys, "export", tmp_path / "out", "--to", "straight")
    assert alone.code == 3 and "error: the map has no direction" in alone.err and "refused" not in alone.err


def test_what_stands_in_the_way_of_lanes_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    made = simulate.warehouse(seed=3, width=28, depth=22).write(tmp_path)
    wide = ("--vehicle-width", "2.6")
    assert call(capsys, "survey", made, "-o", tmp_path / "out", "-q").code == 0
    ran = call(capsys, "export", tmp_path / "out", "--to", "lif", "-o", tmp_path / "wide", *wide)
    survey = groundplan.Survey.read(tmp_path / "out" / "survey.json")
    roads = road_map(survey, vehicle_width=2.6, map=groundplan.read(made))
    out, stay = len(roads.blocked), sum(lane.kind == "aisle" for lane in roads.lanes)
    said = f"warning: {out} lanes of aisles are left out where something stands in the way, {stay} stay: A0"
    assert ran.code == 0 and said in ran.err and out > 1 and stay > 1
    ran = call(capsys, "export", tmp_path / "out", "--to", "lif", "-o", tmp_path / "wider", "--vehicle-width", "9")
    assert ran.code == 0 and "warning: the road map is empty" in ran.err
    ran = call(capsys, "export", tmp_path / "warehouse.yaml", "--to", "lif")
    assert ran.code == 3 and "hint: a map is surveyed first: groundplan survey" in ran.err


@pytest.mark.parametrize("name", [name for name, form in FORMATS.items() if "spurs" in form.options])
def test_every_format_with_lanes_tells_that_there_are_none_and_what_is_too_narrow(
    name: str, saved: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    graph = ("--graph", "roads") if "graph" in FORMATS[name].options else ()
    ran = call(capsys, "export", saved, "--to", name, "-o", tmp_path, "--vehicle-width", "99", *graph)
    if name == "nav2":
        assert ran.code == 3 and "error: the survey has no lanes" in ran.err
        return
    count = len(demo().of_kind("corridor"))
    assert ran.code == 0 and "warning: the road map is empty: no corridor, and no door" in ran.err
    assert f"{count} of {count} corridors are narrower than the 99 m asked for and have no lane: A" in ran.err


def test_corridors_that_a_vehicle_does_not_fit_are_named_with_its_width(
    saved: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    one, *others = sorted(road_map(demo(), vehicle_width=99).narrow, key=lambda corridor: corridor.width)
    wide = (one.width + others[0].width) / 2
    ran = call(capsys, "export", saved, "--to", "lif,dxf", "-o", tmp_path, "--vehicle-width", f"{wide}")
    said = f"1 of {len(others) + 1} corridors is narrower than the {wide:g} m asked for and has no lane"
    told = [line for line in ran.err.splitlines() if "narrower" in line]
    assert ran.code == 0 and told == [f"warning: {said}: {one.id} ({one.width:.2f} m)"]
    assert "narrower" not in call(capsys, "export", saved, "--to", "lif", "-o", tmp_path).err


def test_of_all_formats_those_are_written_whose_libraries_and_pixels_are_there(
    saved: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "ifcopenshell", None)
    ran = call(capsys, "export", saved, "--to", "all", "-o", tmp_path)
    assert ran.code == 2 and "refused: ifc: ifcopenshell is not installed" in ran.err
    assert (
        "pip install 'groundplan[bim]'" in ran.err and ran.err.splitlines()[-1] == "error: not written: ifc, straight"
    )
    assert {f"warehouse{form.suffix}" for form in FORMATS.values() if form.name not in ("ifc", "straight")} <= files(
        tmp_path
    )


def test_the_program_lists_every_format(capsys: pytest.CaptureFixture[str]) -> None:
    ran = call(capsys, "export", "--list")
    assert ran.code == 0
    for form in FORMATS.values():
        assert f"\n{form.name} " in f"\n{ran.out}" and form.readers in ran.out
    needs = [line.strip() for line in ran.out.splitlines() if line.strip().startswith("needs ")]
    assert needs == [f"needs {', '.join(form.needs)}, installed" for form in FORMATS.values() if form.needs]


def test_the_list_names_what_is_not_installed_and_the_command_that_installs_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for library in ("shapely", "pyproj"):
        monkeypatch.setitem(sys.modules, library, None)
    ran = call(capsys, "export", "--list")
    needs = [line.strip() for line in ran.out.splitlines() if line.strip().startswith("needs ")]
    assert len(needs) == sum(bool(form.needs) for form in FORMATS.values())
    assert "needs shapely, not installed: pip install 'groundplan[fleet]'" in needs
    assert "needs shapely, pyproj, not installed: pip install 'groundplan[gis]'" in needs
    assert not any("shapely" in line for line in needs if line.endswith(", installed"))


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--to", "cvs"], "did you mean csv?"),
        (["--to", "csv", "--graph", "faces"], "--graph says nothing"),
        ([], "error: --to FORMAT is needed"),
    ],
)
def test_the_program_refuses_what_it_cannot_do(
    saved: Path, words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    ran = call(capsys, "export", saved, *words)
    assert ran.code == 2 and said in ran.err and ran.out == ""


def test_a_survey_is_exported_as_it_is_made(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    ran = call(capsys, "survey", write_map(tmp_path), "-o", tmp_path / "out", "--export", "csv,graphml")
    assert ran.code == 0 and "hall.graphml" in ran.err
    assert (tmp_path / "out" / "export" / "hall.places.csv").is_file()
    later = call(capsys, "export", tmp_path / "out", "--to", "csv", "-o", tmp_path / "later.csv")
    assert later.code == 0
    assert (tmp_path / "later.csv").read_bytes() == (tmp_path / "out" / "export" / "hall.places.csv").read_bytes()


def test_the_map_is_found_where_a_format_shows_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert call(capsys, "survey", write_map(tmp_path), "-o", tmp_path / "out", "-q").code == 0
    ran = call(capsys, "export", tmp_path / "out", "--to", "dxf")
    assert (ran.code, ran.err) == (0, "") and ran.out.splitlines()[-1].endswith("hall.underlay.png")
    (tmp_path / "hall.pgm").unlink()
    ran = call(capsys, "export", tmp_path / "out", "--to", "dxf", "-o", tmp_path / "without")
    assert ran.code == 0 and "written without the map's pixels" in ran.err
    assert files(tmp_path / "without") == {"hall.dxf"}
    ran = call(capsys, "export", tmp_path / "out", "--to", "dxf", "--map", tmp_path / "hall.yaml")
    assert ran.code == 3


def test_the_list_of_formats_loads_no_format() -> None:
    code = "import sys, groundplan.export; print({'numpy', 'shapely', 'networkx', 'ezdxf'} & set(sys.modules))"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout.strip() == "set()"


def test_a_date_is_what_is_given_or_the_build_s_or_now(monkeypatch: pytest.MonkeyPatch) -> None:
    assert moment("2026-05-01T09:30:00+02:00").isoformat() == "2026-05-01T07:30:00+00:00"
    assert moment("2026-05-01").isoformat() == "2026-05-01T00:00:00+00:00"
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    assert moment(None).year == 1970
    monkeypatch.delenv("SOURCE_DATE_EPOCH")
    assert moment(None).year > 2025
    with pytest.raises(ParameterError, match="'soon' is no date"):
        moment("soon")


def test_the_good_surveys_have_places() -> None:
    assert all(make().labels for name, make in GOOD.items() if name not in ("jones farms", "nav2 warehouse"))
