"""The report, read and drawn by poppler."""

from __future__ import annotations

import dataclasses
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from _exports import GOOD, ODD, demo, odd_names, once
from conftest import ROOT
from PIL import Image

import groundplan
from groundplan.maps import MapWarning


def poppler(program: str, *words: str | Path) -> str:
    """What a program of poppler prints, without complaint."""
    found = shutil.which(program)
    if found is None:
        pytest.skip(f"needs {program} (Debian's poppler-utils)")
    done = subprocess.run([found, *map(str, words)], capture_output=True, check=False, timeout=60)
    assert done.returncode == 0 and done.stderr == b"", done.stderr
    return done.stdout.decode()


def text(file: Path) -> list[str]:
    """The words of each page, line by line as they lie."""
    return poppler("pdftotext", "-layout", file, "-").split("\f")[:-1]


def pages(file: Path) -> int:
    """How many pages there are, each of A4's shape, lying."""
    said = poppler("pdfinfo", "-f", "1", "-l", "999", file)
    sizes = re.findall(r"Page +\d+ size: +([\d.]+) x ([\d.]+)", said)
    assert all(float(wide) / float(high) == pytest.approx(11.69 / 8.27, abs=2e-3) for wide, high in sizes)
    return len(sizes)


def row(sheets: list[str], name: str) -> str:
    """The one row of the table of places that begins with a name."""
    lines = [line for sheet in sheets if "Neighbours" in sheet for line in sheet.splitlines()]
    found = [line for line in lines if re.match(rf" *{re.escape(name)} {{2,}}", line)]
    assert len(found) == 1
    return found[0]


@pytest.mark.parametrize("which", GOOD)
def test_every_place_is_in_the_table_with_its_sizes(which: str, tmp_path: Path) -> None:
    survey = GOOD[which]()
    sheets = text(once(survey, "pdf", tmp_path))
    for label in survey.labels:
        if "name" in label:
            line = row(sheets, label["name"])
            assert label["kind"] in line
            if label["kind"] in ("corridor", "rack"):
                assert f" {label['width']:.2f} " in line
    assert sum(f" {kind}" in sheet for sheet in sheets for kind in ("corridor", "junction")) >= 2


def test_the_first_page_says_which_map_and_when_and_the_next_ones_have_the_figures(tmp_path: Path) -> None:
    sheets = text(once(demo(), "pdf", tmp_path, date="2026-05-01T09:30Z"))
    for word in ("warehouse.pgm", "2026-05-01 09:30 UTC", "Corridor (7)", "Warnings", "unsure-labels"):
        assert word in sheets[0]
    for title in ("Feature space of edges", "Abstraction", "Connectivity", "Places"):
        assert any(title in sheet for sheet in sheets[1:])


def test_with_the_map_there_are_its_pixels_and_the_figures_over_it(tmp_path: Path) -> None:
    map = groundplan.read(ROOT / "examples" / "warehouse.yaml")
    file = once(demo(), "pdf", tmp_path, map=map)
    sheets = text(file)
    assert pages(file) == len(sheets) == 9
    for title in ("2 dominant directions", "Radiograms along each direction", "Subdivision and its dual"):
        assert any(title in sheet for sheet in sheets)
    without = once(demo(), "pdf", tmp_path / "without")
    drawn = []
    for number, one in enumerate((file, without)):
        poppler("pdftoppm", "-r", "100", "-f", "1", "-l", "1", "-png", "-singlefile", one, tmp_path / f"page{number}")
        with Image.open(tmp_path / f"page{number}.png") as picture:
            drawn.append(np.asarray(picture.convert("RGB")).astype(int))
    grounds = [(np.abs(page - (234, 230, 223)).max(axis=2) < 3).mean() for page in drawn]
    assert grounds[0] > 0.1 > 0.001 > grounds[1]  # the unknown around the warehouse
    racks = [(page[..., 2] < page[..., 0] - 60).mean() for page in drawn]
    assert min(racks) > 0.02


def test_the_same_date_gives_the_same_bytes_and_another_other_ones(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    map = groundplan.read(ROOT / "examples" / "warehouse.yaml")
    dates = ("2026-05-01", "2026-05-01", "2026-05-02")
    files = [once(demo(), "pdf", tmp_path / str(n), map=map, date=date) for n, date in enumerate(dates)]
    one, same, other = (file.read_bytes() for file in files)
    assert one == same != other
    assert "Fri May  1 00:00:00 2026" in poppler("pdfinfo", files[0])
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    assert "1970-01-01 00:00 UTC" in text(once(demo(), "pdf", tmp_path))[0]


@pytest.mark.parametrize("which", ODD)
def test_an_odd_survey_is_a_report_without_fault(which: str, tmp_path: Path) -> None:
    file = once(ODD[which](), "pdf", tmp_path)
    assert pages(file) == len(text(file)) >= 4


def test_names_come_back_as_far_as_the_type_has_letters(tmp_path: Path) -> None:
    sheets = text(once(odd_names(), "pdf", tmp_path))
    words = "\n".join(sheets)
    for name in ("O'Brien & <Söhne>, 50 %", "Gang Ä; Ölüm", "two lines and tabs"):
        assert name in words


def test_warnings_are_told_on_the_first_page_and_in_full_on_the_last(tmp_path: Path) -> None:
    long = MapWarning("unknown-as-free", "a sentence that goes on and on " * 20 + "to its end")
    survey = dataclasses.replace(demo(), warnings=[long] * 3)
    sheets = text(once(survey, "pdf", tmp_path))
    assert "a sentence that goes on" in sheets[0] and "more on the sheet of warnings" in sheets[0]
    assert " ".join(sheets[-1].split()).count("to its end") == 3 and "unknown-as-free" in sheets[-1]


def test_a_table_that_nobody_would_turn_ends_and_says_where_the_rest_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from groundplan.export import pdf

    monkeypatch.setattr(pdf, "MOST_PLACES", 20)
    sheets = text(once(demo(), "pdf", tmp_path))
    more = len(demo().labels) - 20
    assert any(f"Places; {more} more are in the table that --to csv writes" in sheet for sheet in sheets)
    assert row(sheets, "A01") and not any("S2-08  " in sheet for sheet in sheets)


def test_a_place_with_many_neighbours_has_them_all_in_as_many_rows_as_they_take(tmp_path: Path) -> None:
    sheets = text(once(demo(), "pdf", tmp_path))
    (table,) = (sheet for sheet in sheets if "Neighbours" in sheet)
    said = table[table.index("\nA03 ") : table.index("\nA04 ")]
    assert sorted(re.findall(r"[JS]\d[\d-]+", said)) == ["J04", "J05", "J06", "S2-03", "S2-08", "S3-03", "S3-08"]


def test_the_sheets_of_a_table_count_places_and_not_rows() -> None:
    from groundplan.export import _report

    rows = [[name, line] for name in map(str, range(1, 21)) for line in "abc"]
    rows = [[name if line == "a" else "", line] for name, line in rows]
    titles = [sheet.texts[0].get_text() for sheet in _report.tables("Places", ("Name", "What"), rows, (2.0, 2.0))]
    assert titles == ["Places, 1 to 12 of 20", "Places, 12 to 20 of 20"]
