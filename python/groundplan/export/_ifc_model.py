"""An IFC4 file in the making: one project, site, building and storey, and what is put into it."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Any

import ifcopenshell
import ifcopenshell.guid

import groundplan

#: Of these, ids are made: the same survey gives the same ids.
NAMESPACE = uuid.uuid5(uuid.NAMESPACE_DNS, "survey.groundplan")
#: Decimals of a length: a hundredth of a millimetre.
DIGITS = 5


class Model:
    """Entities of one file; `name` seeds their ids, `height` is the storey's, metres."""

    def __init__(self, name: str, date: datetime, height: float) -> None:
        self.name, self.height = name, height
        self.file = ifcopenshell.file(schema="IFC4")
        self.made: list[Any] = []
        self._head(date)
        self._units()
        self.frame = self._frame()
        self.storey = self._building()

    def element(self, kind: str, key: str, **values: Any) -> Any:
        """A rooted entity with an id that `key` decides."""
        entity = self._rooted(
            kind, key, ObjectPlacement=self.file.createIfcLocalPlacement(self.frame, self.at), **values
        )
        self.made.append(entity)
        return entity

    def body(self, shape: Any, height: float) -> dict[str, Any]:
        """The value of Representation: a polygon, raised."""
        outline = self._polyline(shape.exterior.coords)
        holes = [self._polyline(ring.coords) for ring in shape.interiors]
        profile = (
            self.file.createIfcArbitraryProfileDefWithVoids("AREA", None, outline, holes)
            if holes
            else self.file.createIfcArbitraryClosedProfileDef("AREA", None, outline)
        )
        solid = self.file.createIfcExtrudedAreaSolid(profile, self.at, self.up, round(float(height), DIGITS))
        shown = self.file.createIfcShapeRepresentation(self.context, "Body", "SweptSolid", [solid])
        return {"Representation": self.file.createIfcProductDefinitionShape(None, None, [shown])}

    def aggregate(self, spaces: list[Any]) -> None:
        """Put spaces into the storey."""
        if spaces:
            self._rooted("IfcRelAggregates", "spaces", RelatingObject=self.storey, RelatedObjects=spaces)

    def contain(self, elements: list[Any]) -> None:
        """Put elements into the storey."""
        if elements:
            self._rooted(
                "IfcRelContainedInSpatialStructure",
                "elements",
                RelatingStructure=self.storey,
                RelatedElements=elements,
            )

    def virtual(self, key: str) -> Any:
        """What bounds a space and cannot be touched."""
        entity = self._rooted("IfcVirtualElement", key)
        self._rooted(
            "IfcRelContainedInSpatialStructure", f"in {key}", RelatingStructure=self.storey, RelatedElements=[entity]
        )
        return entity

    def boundary(self, key: str, space: Any, by: Any, line: Any, *, virtual: bool, outer: bool) -> None:
        """A piece of a space's outline, from floor to ceiling."""
        profile = self.file.createIfcArbitraryOpenProfileDef("CURVE", None, self._polyline(line.coords))
        surface = self.file.createIfcSurfaceOfLinearExtrusion(profile, self.at, self.up, self.height)
        self._rooted(
            "IfcRelSpaceBoundary",
            key,
            RelatingSpace=space,
            RelatedBuildingElement=by,
            ConnectionGeometry=self.file.createIfcConnectionSurfaceGeometry(surface, None),
            PhysicalOrVirtualBoundary="VIRTUAL" if virtual else "PHYSICAL",
            InternalOrExternalBoundary="EXTERNAL" if outer else "INTERNAL",
        )

    def quantities(self, element: Any, name: str, **values: float) -> None:
        """Quantities by name: areas end in ``Area``, the others are lengths."""
        made = [
            (self.file.createIfcQuantityArea if key.endswith("Area") else self.file.createIfcQuantityLength)(
                key, None, None, round(value, DIGITS)
            )
            for key, value in values.items()
        ]
        key = f"{name} of {element.GlobalId}"
        own = self._rooted("IfcElementQuantity", key, Name=name, Quantities=made)
        self._define(f"defines {key}", [element], own)

    def mark(self, values: dict[str, str | bool]) -> None:
        """The property set SurveyProvenance, for all elements made so far."""
        properties = [
            self.file.createIfcPropertySingleValue(
                key, None, self.file.create_entity("IfcBoolean" if isinstance(value, bool) else "IfcText", value), None
            )
            for key, value in values.items()
        ]
        own = self._rooted("IfcPropertySet", "provenance", Name="SurveyProvenance", HasProperties=properties)
        if self.made:
            self._define("has provenance", self.made, own)

    def text(self) -> str:
        """The file, ISO 10303-21."""
        return str(self.file.to_string())

    def _define(self, key: str, elements: list[Any], by: Any) -> None:
        self._rooted("IfcRelDefinesByProperties", key, RelatedObjects=elements, RelatingPropertyDefinition=by)

    def _rooted(self, kind: str, key: str, **values: Any) -> Any:
        id = ifcopenshell.guid.compress(uuid.uuid5(NAMESPACE, f"{self.name}/{kind}/{key}").hex)
        return self.file.create_entity(kind, GlobalId=id, **values)

    def _polyline(self, coords: Any) -> Any:
        rounded = [(round(x, DIGITS), round(y, DIGITS)) for x, y, *_ in coords]
        kept = [p for n, p in enumerate(rounded) if n == 0 or p != rounded[n - 1]]
        closed = len(kept) > 2 and kept[0] == kept[-1]
        points = [self.file.createIfcCartesianPoint(point) for point in (kept[:-1] if closed else kept)]
        return self.file.createIfcPolyline([*points, points[0]] if closed else points)

    def _head(self, date: datetime) -> None:
        named = self.file.header.file_name
        named.name, named.time_stamp = f"{self.name}.ifc", date.strftime("%Y-%m-%dT%H:%M:%S")
        named.preprocessor_version = named.originating_system = f"Groundplan {groundplan.__version__}"
        named.author = named.organization = ("",)
        named.authorization = ""
        self.file.header.file_description.description = ("ViewDefinition [ReferenceView_V1.2]",)

    def _units(self) -> None:
        file = self.file
        self.at = file.createIfcAxis2Placement3D(file.createIfcCartesianPoint((0.0, 0.0, 0.0)), None, None)
        self.up = file.createIfcDirection((0.0, 0.0, 1.0))
        kinds = (("LENGTHUNIT", "METRE"), ("AREAUNIT", "SQUARE_METRE"), ("PLANEANGLEUNIT", "RADIAN"))
        self.units = file.createIfcUnitAssignment(
            [file.createIfcSIUnit(None, kind, None, unit) for kind, unit in kinds]
        )
        whole = file.createIfcGeometricRepresentationContext(None, "Model", 3, 1e-5, self.at, None)
        self.whole = whole
        self.context = file.createIfcGeometricRepresentationSubContext(
            "Body", "Model", None, None, None, None, whole, None, "MODEL_VIEW", None
        )

    def _frame(self) -> Any:
        return self.file.createIfcLocalPlacement(None, self.at)

    def _building(self) -> Any:
        project = self._rooted(
            "IfcProject",
            "project",
            Name=self.name,
            Description="Made of a robot's map; heights are invented.",
            RepresentationContexts=[self.whole],
            UnitsInContext=self.units,
        )
        above = project
        for kind in ("IfcSite", "IfcBuilding", "IfcBuildingStorey"):
            extra = {"Elevation": 0.0} if kind == "IfcBuildingStorey" else {}
            entity = self._rooted(
                kind, kind, Name=kind[3:], ObjectPlacement=self.frame, CompositionType="ELEMENT", **extra
            )
            self._rooted("IfcRelAggregates", f"has {kind}", RelatingObject=above, RelatedObjects=[entity])
            above = entity
        return above
