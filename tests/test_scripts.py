"""The scripts of bench/ and docs/ say what they do before they do it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
SCRIPTS = sorted(
    path.relative_to(ROOT).as_posix() for place in ("bench", "docs") for path in ROOT.glob(f"{place}/[!_]*.py")
)


def run(script: str, *words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(ROOT / script), *words]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)


@pytest.mark.parametrize("script", SCRIPTS)
def test_a_script_answers_help_and_does_nothing_else(script: str) -> None:
    ran = run(script, "--help")
    assert (ran.returncode, ran.stderr) == (0, "")
    assert ran.stdout.startswith(f"usage: {Path(script).name} [-h]")


def test_each_mark_of_a_page_is_a_part_that_can_be_made_alone() -> None:
    pages = [ROOT / "README.md", ROOT / "docs" / "accuracy.md"]
    marks = {
        line.removeprefix("<!-- end of ").removesuffix(" -->")
        for page in pages
        for line in page.read_text(encoding="utf-8").splitlines()
        if line.startswith("<!-- end of ")
    }
    ran = run("docs/make.py", "nothing")
    assert ran.returncode == 2 and ran.stdout == ""
    listed = ran.stderr.partition("there are ")[2].strip().replace("'", "").split(", ")
    assert set(listed) == marks | {"pictures"}
