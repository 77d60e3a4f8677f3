"""Parameters of Nav2's Vector Object Server: racks and pillars as shapes to keep out of, without a raster.

Source: ros-navigation/navigation2 ``nav2_map_server/params/vector_object_server_params.yaml``.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import shapely

from groundplan._files import write_text
from groundplan.export._places import Place, places
from groundplan.export._text import slug, unique

if TYPE_CHECKING:
    from collections.abc import Iterable

    from groundplan.survey import Survey

HEAD = """\
vector_object_server:
  ros__parameters:
    map_topic: "vo_map"
    global_frame_id: "map"
    resolution: {resolution}
    default_value: -1
    overlay_type: 0
    update_frequency: 1.0
    transform_tolerance: 0.1
"""
FOOT = """\
costmap_filter_info_server:
  ros__parameters:
    type: 0
    filter_info_topic: "vo_costmap_filter_info"
    mask_topic: "vo_map"
    base: 0.0
    multiplier: 1.0
"""
POLYGON = """\
    {name}:
      type: "polygon"
      frame_id: "map"
      closed: true
      value: 100
      points: [{points}]
"""
CIRCLE = """\
    {name}:
      type: "circle"
      frame_id: "map"
      fill: true
      value: 100
      center: [{x}, {y}]
      radius: {radius}
"""


def write(survey: Survey, path: Path) -> list[Path]:
    """Write the outlines of racks, and pillars as circles; to a millimetre."""
    kept = [place for place in places(survey) if place.kind in ("rack", "pillar")]
    kept = [place for place in kept if place.kind == "pillar" or place.shape is not None]
    listed = list(zip(unique(_name(place) for place in kept), kept, strict=True))
    text = HEAD.format(resolution=_number(survey.map.resolution, 6))
    if listed:  # ROS takes no empty list for a parameter
        text += "    shapes: [" + ", ".join(f'"{name}"' for name, _ in listed) + "]\n"
    for name, place in listed:
        if place.kind == "rack":
            ring = shapely.orient_polygons(place.shape).exterior.coords[:-1]
            text += POLYGON.format(name=name, points=_numbers(value for point in ring for value in point))
        else:
            # A pillar of which nothing says how thick it is has a pixel around its middle.
            radius = (place.width or 2 * survey.map.resolution) / 2
            x, y = (_number(value) for value in place.centre)
            text += CIRCLE.format(name=name, x=x, y=y, radius=_number(radius))
    write_text(path, text + FOOT)
    return [path]


def _name(place: Place) -> str:
    """A parameter's name: letters, digits, underscores, the first a letter; no YAML reader takes it for a number."""
    return f"{place.kind}_{slug(place.id)}".replace("-", "_")


def _numbers(values: Iterable[Any]) -> str:
    return ", ".join(_number(float(value)) for value in values)


def _number(value: float, digits: int = 3) -> str:
    """With a point and without an exponent, since ROS takes a list for what its first number looks like."""
    return f"{round(value, digits) + 0.0:.{digits}f}"
