"""Geometries of labels, and how their names lie along them."""

from __future__ import annotations

from typing import Any

from groundplan._extras import needed


def outline(label: dict[str, Any]) -> Any:
    """A label's polygon with its holes, made valid; None where it has none or an empty one. Needs shapely."""
    shapely = needed("shapely", "geometry")
    if len(label.get("polygon") or ()) < 3:
        return None
    shape = shapely.Polygon(label["polygon"], [ring for ring in label.get("holes") or () if len(ring) >= 3])
    if not shape.is_valid:
        parts = shapely.get_parts(shapely.make_valid(shape, method="structure", keep_collapsed=False))
        shape = max(parts, key=lambda part: part.area, default=None)
    return shape if shape is not None and shape.geom_type == "Polygon" and shape.area > 0 else None


def readable(angle: float) -> float:
    """Degrees at which a name along a line is read from below or from the right, as on a drawing.

    Nearly upright lines lean either way from map to map: within 5 degrees all are read from the right.
    """
    return (angle + 85.0) % 180.0 - 85.0
