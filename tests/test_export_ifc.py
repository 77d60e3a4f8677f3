"""The building model, validated by IfcOpenShell with the schema's rules and measured by its geometry kernel."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import ifcopenshell
import ifcopenshell.geom
import ifcopenshell.util.element
import ifcopenshell.validate
import numpy as np
import pytest
import shapely
from _exports import GOOD, ODD, demo, jones_farms, odd_names, once

from groundplan import ParameterError


def issues(file: Path) -> list[Any]:
    """What is wrong with a file, by the schema and its rules."""
    log = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(str(file), log, express_rules=True)
    return list(log.statements)


# The validator leaves the file of its rules open.
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning", "ignore::ResourceWarning")
@pytest.mark.parametrize("which", [*GOOD, *ODD])
def test_every_model_is_valid_with_all_rules(which: str, tmp_path: Path) -> None:
    assert issues(once((GOOD | ODD)[which](), "ifc", tmp_path)) == []


def test_spaces_have_the_regions_shapes_to_a_millimetre(tmp_path: Path) -> None:
    survey = jones_farms()
    model = ifcopenshell.open(once(survey, "ifc", tmp_path, height=2.5))
    spaces: list[Any] = list(model.by_type("IfcSpace"))
    regions = survey.of_kind("region")
    assert [space.LongName for space in spaces] == [region["name"] for region in regions]
    kernel: Any = ifcopenshell.geom
    settings = kernel.settings()
    for space, region in zip(spaces, regions, strict=True):
        vertices = np.array(kernel.create_shape(settings, space).geometry.verts).reshape(-1, 3)
        corners = shapely.MultiPoint(np.unique(vertices[:, :2].round(6), axis=0))
        given = shapely.MultiPoint([*region["polygon"], *(p for hole in region.get("holes", ()) for p in hole)])
        assert shapely.hausdorff_distance(corners, given) < 1e-3
        assert vertices[:, 2].min() == 0 and vertices[:, 2].max() == pytest.approx(2.5)
        area = shapely.Polygon(region["polygon"], region.get("holes")).area
        told = ifcopenshell.util.element.get_psets(space)["Qto_SpaceBaseQuantities"]
        assert told["GrossFloorArea"] == pytest.approx(area, abs=1e-3)
        assert told["NetFloorArea"] == pytest.approx(region["area"], abs=1e-3)


def test_the_storey_holds_walls_racks_and_doors_and_says_what_is_invented(tmp_path: Path) -> None:
    survey = jones_farms()
    model = ifcopenshell.open(once(survey, "ifc", tmp_path))
    assert len(model.by_type("IfcWall")) == len(survey.walls)
    assert len(model.by_type("IfcFurniture")) == len(survey.of_kind("rack"))
    assert len(model.by_type("IfcDoor")) == len(survey.of_kind("door"))
    for element in [*model.by_type("IfcWall"), *model.by_type("IfcSpace")]:
        assert ifcopenshell.util.element.get_psets(element)["SurveyProvenance"]["HeightIsInvented"] is True
    (units,) = model.by_type("IfcUnitAssignment")
    assert {unit.Name for unit in units.Units} >= {"METRE", "RADIAN"}


def test_a_door_bounds_the_two_rooms_that_it_joins(tmp_path: Path) -> None:
    survey = GOOD["jones farms"]()
    model = ifcopenshell.open(once(survey, "ifc", tmp_path))
    names = [label.get("name") for label in survey.labels]
    joined = {frozenset(names[side] for side in door["between"]) for door in survey.of_kind("door")}
    told: dict[Any, set[str]] = {}
    for bound in model.by_type("IfcRelSpaceBoundary"):
        if bound.RelatedBuildingElement.is_a("IfcDoor"):
            told.setdefault(bound.RelatedBuildingElement.id(), set()).add(bound.RelatingSpace.LongName)
    assert {frozenset(rooms) for rooms in told.values()} == joined
    for space in model.by_type("IfcSpace"):
        kinds = {bound.RelatedBuildingElement.is_a() for bound in space.BoundedBy}
        assert kinds & {"IfcWall", "IfcDoor", "IfcVirtualElement"}, f"nothing bounds {space.LongName}"


def test_names_come_back_and_ids_do_not_change(tmp_path: Path) -> None:
    first, second = (
        ifcopenshell.open(once(odd_names(), "ifc", tmp_path, date=date)) for date in ("2026-05-01", "2027-01-01")
    )
    assert [e.GlobalId for e in first.by_type("IfcRoot")] == [e.GlobalId for e in second.by_type("IfcRoot")]
    assert first.header.file_name.time_stamp == "2026-05-01T00:00:00"


def test_a_height_that_no_room_has_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="a height of 0 m"):
        once(demo(), "ifc", tmp_path, height=0)
