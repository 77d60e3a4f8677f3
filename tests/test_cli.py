"""The command line as its user meets it."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from _program import call, files, hall, start, write_map, write_pgm

import groundplan
from groundplan._cli.arguments import COMMANDS

Capture = pytest.CaptureFixture[str]


@pytest.fixture(autouse=True)
def _in_a_directory_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")


# Help, version, wrong usage


def test_help_needs_no_heavy_import() -> None:
    code = (
        "import sys\nfrom groundplan.cli import main\n"
        "try:\n    main(['--help'])\nexcept SystemExit: pass\n"
        "sys.exit(', '.join({'numpy', 'matplotlib', 'PIL', 'groundplan._core'} & set(sys.modules)) or 0)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert all(f"\n  {command} " in done.stdout for command in COMMANDS)


@pytest.mark.parametrize("command", [*COMMANDS, "simulate warehouse"])
def test_each_command_has_help_that_fits_the_terminal(command: str, capsys: Capture) -> None:
    ran = call(capsys, *command.split(), "--help")
    assert ran.code == 0 and ran.err == ""
    assert ran.out.startswith(f"usage: groundplan {command} ")
    assert max(map(len, ran.out.splitlines())) <= 80


def test_version_is_the_package_s(capsys: Capture) -> None:
    ran = call(capsys, "--version")
    assert (ran.code, ran.out) == (0, f"groundplan {groundplan.__version__}\n")


def test_python_runs_the_program_as_a_module() -> None:
    for words in (["--version"], ["--help"], ["surve"]):
        command = [sys.executable, "-m", "groundplan", *words]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        own = start(*words)
        assert (done.returncode, done.stdout, done.stderr) == (own.code, own.out, own.err)


def test_no_command_shows_the_help_and_is_wrong_usage(capsys: Capture) -> None:
    ran = call(capsys)
    assert ran.code == 2 and ran.out == "" and "groundplan survey" in ran.err


@pytest.mark.parametrize(
    ("words", "error", "hint"),
    [
        ("surve map.yaml", "there is no command 'surve'", "did you mean groundplan survey?"),
        ("map.yaml", "there is no command 'map.yaml'", "groundplan survey map.yaml"),
        ("survey", "MAP", "groundplan survey --help"),
        ("survey hall.yaml --resoluton 0.1", "there is no flag --resoluton", "did you mean --resolution?"),
        ("survey hall.yaml --verbose", "there is no flag --verbose", "groundplan survey --help"),
        ("survey hall.yaml --figure", "there is no flag --figure", "did you mean --figures?"),
        ("survive", "there is no command 'survive'", "groundplan --help"),
        ("survey hall.yaml --resolution -1", "resolution '-1'", "groundplan survey --help"),
        ("survey hall.yaml another.yaml", "one argument too many: 'another.yaml'", "groundplan survey MAP [-o DIR]"),
        ("survey hall.yaml --origin 1", "--origin has 1 numbers", "groundplan survey --help"),
        ("survey --direction 10 hall.yaml", "'hall.yaml' is not a number", "groundplan survey --help"),
        ("survey hall.yaml --directions 2 --direction 0 90", "not allowed with", "groundplan survey --help"),
        ("survey hall.yaml --threads 0", "'0' is not a whole number from 1 on", "groundplan survey --help"),
        ("survey hall.yaml --free-thresh 2", "'2' is not between 0 and 1", "groundplan survey --help"),
        ("survey hall.yaml --unknown grey", "'grey' is neither none nor greys", "groundplan survey --help"),
        ("survey hall.yaml --mode binary", "'binary'", "groundplan survey --help"),
        ("survey hall.yaml --set lines.snrr=4", "there is no parameter lines.snrr", "did you mean lines.snr?"),
        ("survey hall.yaml --set resolution=3", "there is no parameter resolution", "mean the flag --resolution?"),
        ("survey hall.yaml --set free_thresh=.2", "there is no parameter free_thresh", "mean the flag --free-thresh?"),
        ("watch --set resolution=3", "there is no parameter resolution", "groundplan parameters lists them all"),
        ("survey hall.yaml --set lines.snr=-4", "lines.snr cannot be -4", "lines.snr takes 0 to 1000"),
        ("survey hall.yaml --set lines.snr", "'lines.snr' is not name=value", "for example --set lines.snr=4"),
        ("survey hall.yaml --set =4", "'=4' is not name=value", "for example --set lines.snr=4"),
        ("export s.json --to lif --spurs -1", "--spurs: '-1' is not a number from 0 on", "groundplan export --help"),
        ("export s.json --to csv,pdf --units mm", "--units says nothing to csv, pdf", "it is for dxf"),
        ("survey hall.yaml --detail medium", "'medium' is neither coarse nor fine nor a number", "survey --help"),
        ("survey hall.yaml --detail 7", "lines.detail cannot be 7", "coarse, fine"),
        ("figures s.json --format gif", "'gif' is none of png, svg, pdf", "groundplan figures --help"),
        ("simulate", "PLACE", "groundplan simulate --help"),
        ("simulate warehouse", "-o", "groundplan simulate warehouse --help"),
        ("simulate warehouse -o x --widht 3", "there is no flag --widht", "did you mean --width?"),
        ("simulate warehouse -o x --width 3", "width is 3.0, not in 12.0 .. 120.0", ""),
        ("simulate warehouse -o x --seed -1", "'-1' is not a whole number from 0 on", ""),
        ("evaluate", "SURVEY and its TRUTH", "groundplan evaluate --help"),
        ("evaluate s.json t.json --methods paper", "--methods goes with --suite", "groundplan evaluate --help"),
        ("evaluate s.json t.json --suite warehouses", "--suite makes its own surveys", "groundplan evaluate --help"),
        (
            "evaluate --suite castles",
            "no suite 'castles'",
            "there are: confidence, names, offices, roadmaps, rooms, warehouses",
        ),
        ("evaluate --suite rooms --maps nowhere", "no maps with a ground truth in nowhere", "--maps DIR"),
        ("simulate office -o x --shape star", "invalid choice: 'star'", "groundplan simulate office --help"),
        ("evaluate --suite warehouses --methods magic", "labels.method cannot be", "paper"),
    ],
)
def test_wrong_usage_is_told_with_what_would_help(
    words: str, error: str, hint: str, tmp_path: Path, capsys: Capture
) -> None:
    write_map(tmp_path)
    before = files(tmp_path)
    ran = call(capsys, *words.split())
    assert ran.code == 2 and ran.out == ""
    first, *rest = ran.err.splitlines()
    assert first.startswith("error: ") and error in first
    assert hint in "".join(rest) and len(rest) <= 1
    assert files(tmp_path) == before


# survey


def test_survey_writes_its_files_and_prints_a_table(tmp_path: Path, capsys: Capture) -> None:
    write_map(tmp_path)
    ran = call(capsys, "survey", "hall.yaml")
    assert ran.code == 0
    assert files(tmp_path) == {"hall.yaml", "hall.pgm", "hall-survey/survey.json", "hall-survey/survey.png"}
    lines = ran.out.splitlines()
    assert [line.split()[0] for line in lines if not line.startswith(" ")] == [
        *("map", "directions", "faces", "walls", "corridors", "junctions", "regions", "warnings")
    ]
    assert lines[0].split() == ["map", "hall.pgm"]
    assert lines[1].strip() == "14.0 x 10.0 m, 280 x 200 pixels of 0.05 m"
    assert lines[2].startswith("directions") and "0.00 deg  weight 1.00" in lines[2]
    assert max(map(len, lines)) <= 80
    assert ran.err.splitlines()[-2:] == [
        f"wrote: {os.path.join('hall-survey', name)}" for name in ("survey.json", "survey.png")
    ]


def test_a_map_that_is_narrower_than_a_decimal_has_a_width(tmp_path: Path, capsys: Capture) -> None:
    write_pgm(tmp_path / "thin.pgm", hall()[:, 100:101])
    ran = call(capsys, "survey", "thin.pgm", "--resolution", "0.05", "--no-picture")
    assert "0.05 x 10.0 m, 1 x 200 pixels of 0.05 m" in ran.out


def test_without_a_picture_the_same_survey_is_all_that_is_written(tmp_path: Path, capsys: Capture) -> None:
    write_map(tmp_path)
    call(capsys, "survey", "hall.yaml", "-o", "drawn")
    ran = call(capsys, "survey", "hall.yaml", "-o", "out", "--no-picture")
    assert ran.code == 0 and ran.err.splitlines()[-1] == f"wrote: {os.path.join('out', 'survey.json')}"
    assert files(tmp_path / "out") == {"survey.json"}
    assert (tmp_path / "out/survey.json").read_bytes() == (tmp_path / "drawn/survey.json").read_bytes()


def test_a_written_survey_says_where_its_map_is_and_is_what_python_makes(tmp_path: Path, capsys: Capture) -> None:
    yaml = write_map(tmp_path)
    call(capsys, "survey", "hall.yaml", "-o", "out")
    text = (tmp_path / "out/survey.json").read_text()
    read = groundplan.Survey.from_json(text)
    assert (read.source, read.reading) == ("../hall.yaml", {})
    assert json.loads(text)["source"] == {"file": "../hall.yaml", "reading": {}}
    assert read.to_json() == text
    own = groundplan.survey(groundplan.read(yaml))
    assert own.source is None and "source" not in own.to_dict()
    assert own.to_dict() == {key: value for key, value in read.to_dict().items() if key != "source"}


def test_json_alone_is_on_standard_output_and_no_file_is_written(tmp_path: Path, capsys: Capture) -> None:
    write_map(tmp_path)
    before = files(tmp_path)
    ran = call(capsys, "survey", "hall.yaml", "--json")
    assert ran.code == 0 and files(tmp_path) == before
    assert groundplan.Survey.from_json(ran.out).to_json() == ran.out
    ran = call(capsys, "survey", "hall.yaml", "--json", "-o", "out")
    assert (tmp_path / "out/survey.json").read_text() == ran.out


def test_quiet_says_nothing(tmp_path: Path, capsys: Capture) -> None:
    write_map(tmp_path, yaw=".nan")
    ran = call(capsys, "survey", "hall.yaml", "--quiet")
    assert (ran.code, ran.out, ran.err) == (0, "", "")
    assert (tmp_path / "hall-survey/survey.json").is_file()


def test_figures_are_drawn_on_demand_and_again_from_the_saved_survey(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_map(tmp_path)
    ran = call(capsys, "survey", "hall.yaml", "--figures")
    drawn = files(tmp_path / "hall-survey/figures")
    assert ran.code == 0 and f"({len(drawn)} files)" in ran.err
    assert {name.rpartition(".")[2] for name in drawn} == {"png", "svg"}
    # From the directory in which the survey was made, and from the survey's own.
    for here, survey in ((tmp_path, "hall-survey/survey.json"), (tmp_path / "hall-survey", "survey.json")):
        monkeypatch.chdir(here)
        ran = call(capsys, "figures", survey, "-o", tmp_path / "again", "--format", "svg")
        assert ran.code == 0 and ran.err == ""
        assert {Path(line).name for line in ran.out.splitlines()} == {n for n in drawn if n.endswith("svg")}
        assert all(Path(line).is_file() for line in ran.out.splitlines())


def test_a_survey_is_the_same_however_its_map_was_typed(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_map(tmp_path)
    (tmp_path / "below").mkdir()
    typed = ["hall.yaml", "./below/../hall.yaml", str(tmp_path / "hall.yaml")]
    assert {json.loads(call(capsys, "survey", map, "--json").out)["source"]["file"] for map in typed} == {"hall.yaml"}
    made = set()
    for map in typed:
        call(capsys, "survey", map, "-q", "-o", "below/out")
        made.add((tmp_path / "below/out/survey.json").read_text())
    monkeypatch.chdir(tmp_path / "below")
    call(capsys, "survey", "../hall.yaml", "-q", "-o", "out")
    made.add((tmp_path / "below/out/survey.json").read_text())
    assert len(made) == 1 and str(tmp_path) not in next(iter(made))


def test_figures_read_the_map_as_the_survey_did(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_map(tmp_path)
    flags = ("--unknown", "205", "--dialect", "ros1", "--resolution", "0.1", "--origin", "1", "2", "--no-negate")
    call(capsys, "survey", "hall.yaml", "-o", "out", *flags)
    text = (tmp_path / "out/survey.json").read_text()
    given = {"dialect": "ros1", "unknown": [205], "negate": False, "resolution": 0.1, "origin": [1.0, 2.0]}
    assert json.loads(text)["source"] == {"file": "../hall.yaml", "reading": given}
    assert groundplan.Survey.from_json(text).to_json() == text
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    for survey in ("../out/survey.json", "../out"):
        ran = call(capsys, "figures", survey, "--format", "svg")
        assert (ran.code, ran.err) == (0, "")
        assert (tmp_path / "out/figures").is_dir()
    assert (
        "it was read with other flags then"
        in call(capsys, "figures", "../out", "--unknown", "254", "--format", "svg").err
    )


def test_figures_refuse_a_map_that_is_gone_or_another(tmp_path: Path, capsys: Capture) -> None:
    yaml = write_map(tmp_path)
    call(capsys, "survey", "hall.yaml", "-o", "out")
    yaml.unlink()
    ran = call(capsys, "figures", "out/survey.json")
    assert ran.code == 3 and "hall.yaml, which is not there" in ran.err and "hint: --map MAP" in ran.err
    write_pgm(tmp_path / "other.pgm", hall()[:100])
    ran = call(capsys, "figures", "out/survey.json", "--map", "other.pgm")
    assert ran.code == 3 and "280 x 100 pixels" in ran.err and "280 x 200" in ran.err
    assert files(tmp_path / "out") == {"survey.json", "survey.png"}
    nameless = groundplan.survey(hall(), resolution=0.05)
    nameless.write("nameless.json")
    ran = call(capsys, "figures", "nameless.json")
    assert ran.code == 3 and "does not say which map it is of" in ran.err


def test_figures_of_a_map_read_otherwise_come_with_a_warning(tmp_path: Path, capsys: Capture) -> None:
    write_map(tmp_path)
    call(capsys, "survey", "hall.yaml", "-o", "out")
    ran = call(capsys, "figures", "out/survey.json", "--unknown", "254", "--format", "svg")
    assert ran.code == 0 and "it was read with other flags then" in ran.err


def test_a_bare_image_takes_its_frame_from_flags(tmp_path: Path, capsys: Capture) -> None:
    write_map(tmp_path)
    ran = call(capsys, "survey", "hall.pgm", "--resolution", "0.1", "--origin", "-3", "4.5", "0.25", "--json")
    info = json.loads(ran.out)["map"]
    assert (info["resolution"], info["origin"]) == (0.1, [-3.0, 4.5, 0.25])
    ran = call(capsys, "survey", "hall.pgm", "--json")
    assert ran.code == 3 and "--resolution" in ran.err


def test_threads_do_not_change_a_byte(tmp_path: Path, capsys: Capture) -> None:
    write_map(tmp_path)
    made = {call(capsys, "survey", "hall.yaml", "--json", "--threads", str(n)).out for n in (1, 2, 4)}
    assert len(made) == 1


def test_a_name_that_is_not_utf8_is_surveyed(tmp_path: Path) -> None:
    name = os.fsdecode(b"h\xe4ll.pgm")
    try:
        write_pgm(tmp_path / name, hall())
    except OSError:
        pytest.skip("the file system takes UTF-8 names only")
    ran = start("survey", name, "--resolution", "0.05", cwd=tmp_path, PYTHONIOENCODING="ascii")
    assert ran.code == 0, ran.err
    assert "h\N{REPLACEMENT CHARACTER}ll.pgm" in ran.out


# simulate, evaluate, parameters


def test_simulate_prints_what_it_wrote_and_evaluate_scores_its_survey(tmp_path: Path, capsys: Capture) -> None:
    small = ("--width", "20", "--depth", "16", "--beams", "240", "--scan-every", "1", "--closed-sides", "east")
    ran = call(capsys, "simulate", "warehouse", "-o", "sim", "--seed", "4", "--yaw", "10", *small)
    assert ran.code == 0 and ran.err == ""
    assert {str(Path(line).relative_to("sim")) for line in ran.out.splitlines()} == files(tmp_path / "sim")
    truth = json.loads((tmp_path / "sim/truth.json").read_text())
    assert (truth["seed"], truth["options"]["closed_sides"]) == (4, ["east"])
    call(capsys, "survey", "sim/warehouse.yaml", "-o", "out")
    ran = call(capsys, "evaluate", "out/survey.json", "sim/truth.json", "--json")
    scores = json.loads(ran.out)
    assert scores["direction_error_deg"] < 1
    ran = call(capsys, "evaluate", "out", "sim/truth.json")
    assert ran.code == 0 and len(ran.out.splitlines()) == len(scores)


def test_a_suite_compares_the_methods(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    from groundplan.evaluate import Case, _suite

    small = {"width": 26.0, "depth": 16.0, "beams": 240, "scan_every": 1.0, "cross_aisles": 0}
    monkeypatch.setattr(
        _suite,
        "suite",
        lambda name, maps: [
            Case(n, k, "warehouse", {"seed": s, **small}) for n, k, s in (("one", "regular", 1), ("two", "hard", 2))
        ],
    )
    ran = call(capsys, "evaluate", "--suite", "warehouses", "--workers", "1", "--json")
    result = json.loads(ran.out)
    assert ran.code == 0 and result["methods"] == list(_suite.methods()) and "paper" in result["methods"]
    assert [case["name"] for case in result["cases"]] == ["one", "two"]
    found = [case["scores"]["paper"]["junction_f1"] for case in result["cases"]]
    assert result["means"]["paper"]["junction_f1"] == pytest.approx(sum(found) / 2, abs=1e-4)
    assert result["worst"]["paper"]["junction_f1"] == min(found)
    assert result["kinds"]["hard"]["means"]["paper"]["junction_f1"] == found[1]
    assert call(capsys, "evaluate", "--suite", "warehouses", "--workers", "2", "--json").out == ran.out
    table = call(capsys, "evaluate", "--suite", "warehouses", "--workers", "1").out.splitlines()
    assert table[0].split() == list(_suite.methods())
    rule = "-" * len(table[2].split()[0])
    assert [line.split()[0] for line in table[3:]] == ["one", "two", rule, "mean", "mean", "mean", "worst"]
    assert [line.split()[1] for line in table[-4:]] == ["regular", "hard", "all", "all"]


def test_scores_without_scipy_name_the_extra(tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    for module in ("scipy.optimize", "shapely", "shapely.geometry", "shapely.ops"):
        monkeypatch.setitem(sys.modules, module, None)
    ran = call(capsys, "evaluate", "--suite", "warehouses")
    assert ran.code == 2 and "scipy" in ran.err and "pip install 'groundplan[evaluate]'" in ran.err


def test_parameters_lists_the_table(capsys: Capture) -> None:
    rows = groundplan.parameters()
    ran = call(capsys, "parameters")
    assert ran.code == 0 and max(map(len, ran.out.splitlines())) <= 80
    assert [line.split()[0] for line in ran.out.splitlines()[1:] if not line.startswith(" ")] == [r.name for r in rows]
    words = " ".join(ran.out.split())
    assert all(" ".join(row.sentence.split()) in words for row in rows)
    listed = json.loads(call(capsys, "parameters", "--json").out)
    assert [row["name"] for row in listed] == [row.name for row in rows]


# Ends


def test_ctrl_c_ends_cleanly(tmp_path: Path) -> None:
    import numpy as np

    rows = np.random.default_rng(1).integers(0, 6000, 300)
    pixels = np.full((6000, 6000), 254, np.uint8)
    pixels[rows], pixels[:, rows] = 0, 0
    write_pgm(tmp_path / "big.pgm", pixels)
    code = "import sys; from groundplan.cli import main; print('ready', flush=True); sys.exit(main())"
    words = ["survey", "big.pgm", "--resolution", "0.05", "--threads", "1", "-o", "out"]
    with subprocess.Popen(
        [sys.executable, "-c", code, *words], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None and process.stdout.readline() == "ready\n"
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
    assert (process.returncode, out, err) == (130, "", "error: interrupted\n")
    assert files(tmp_path) == {"big.pgm"}


def test_a_reader_that_leaves_gets_no_traceback(tmp_path: Path) -> None:
    code = "import sys; from groundplan.cli import main; sys.exit(main())"
    with subprocess.Popen(
        [sys.executable, "-c", code, "parameters"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None and process.stderr is not None
        process.stdout.close()
        err = process.stderr.read()
    assert (process.returncode, err) == (141, "")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_output_that_cannot_be_written_is_an_error() -> None:
    code = "import sys; from groundplan.cli import main; sys.exit(main())"
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [sys.executable, "-c", code, "parameters"], stdout=full, stderr=subprocess.PIPE, text=True, check=False
        )
    assert done.returncode == 3
    assert done.stderr == "error: cannot write to standard output: No space left on device\n"


def test_a_bug_is_one_line_and_a_traceback_only_when_asked_for(
    capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken() -> None:
        raise ZeroDivisionError("of all\nthings")

    monkeypatch.setattr("groundplan._core.table", broken)
    ran = call(capsys, "parameters")
    assert ran.code == 1
    assert ran.err.splitlines()[0] == "error: this is a bug in Groundplan: ZeroDivisionError: of all things"
    monkeypatch.setenv("GROUNDPLAN_DEBUG", "1")
    with pytest.raises(ZeroDivisionError):
        call(capsys, "parameters")


def test_too_little_memory_is_said(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    def exhausted() -> None:
        raise MemoryError

    monkeypatch.setattr("groundplan._core.table", exhausted)
    ran = call(capsys, "parameters")
    assert (ran.code, ran.err) == (3, "error: this computer has not enough memory for that\n")
