"""The public names: those there are, no others, each documented, and none imported before it is asked for."""

from __future__ import annotations

import inspect
import subprocess
import sys
from types import ModuleType

import pytest

import groundplan

EXPECTED = {
    *("read", "from_array", "Map", "MapWarning"),
    *("survey", "Survey", "parameters"),
    *("find_gradients", "find_directions", "find_radiograms", "find_response", "find_lines"),
    "add_rack_faces",
    *("subdivide", "find_occupancy", "find_walls", "find_adjacency", "find_labels"),
    *(
        "Gradients",
        "Directions",
        "Radiogram",
        "Response",
        "Route",
        "Lines",
        "Subdivision",
        "Occupancy",
        "Walls",
        "Adjacency",
    ),
    *("GroundplanError", "MapError", "ParameterError", "FormatError"),
}


def test_all_is_exact_and_sorted() -> None:
    assert set(groundplan.__all__) == EXPECTED
    assert groundplan.__all__ == sorted(groundplan.__all__)


@pytest.mark.parametrize("name", sorted(EXPECTED))
def test_every_public_name_is_there_and_documented(name: str) -> None:
    thing = getattr(groundplan, name)
    assert not isinstance(thing, ModuleType)
    assert inspect.getdoc(thing)
    assert name in dir(groundplan)
    if inspect.isclass(thing):
        undocumented = [
            member
            for member, value in vars(thing).items()
            if not member.startswith("_") and (callable(value) or isinstance(value, property | classmethod))
            if not inspect.getdoc(getattr(thing, member))
        ]
        assert undocumented == []


def test_a_name_that_is_not_public_is_none() -> None:
    with pytest.raises(AttributeError, match="no attribute 'surveys'"):
        groundplan.surveys  # type: ignore[attr-defined]  # noqa: B018


def run(code: str) -> str:
    """What a fresh interpreter prints."""
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip()


def test_importing_the_package_imports_nothing_heavy() -> None:
    heavy = "{'numpy', 'yaml', 'PIL', 'matplotlib', 'groundplan._core'}"
    assert run(f"import sys, groundplan; print({heavy} & set(sys.modules))") == "set()"


def test_a_survey_needs_no_drawing() -> None:
    code = "import sys; from groundplan import *; print({'matplotlib', 'scipy', 'shapely'} & set(sys.modules))"
    assert run(code) == "set()"


@pytest.mark.parametrize("name", ["survey", "parameters"])
def test_the_module_of_a_function_s_name_does_not_hide_the_function(name: str) -> None:
    code = f"import groundplan.{name}, groundplan; print(callable(groundplan.{name}))"
    assert run(code) == "True"


@pytest.mark.parametrize("name", ["evaluate", "export", "figures", "maps", "roadmap", "simulate"])
def test_a_public_module_is_imported_when_it_is_asked_for(name: str) -> None:
    assert run(f"import groundplan; print(groundplan.{name}.__name__)") == f"groundplan.{name}"
    assert name in dir(groundplan)
