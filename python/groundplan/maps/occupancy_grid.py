"""nav_msgs/OccupancyGrid and map_msgs/OccupancyGridUpdate, whoever decoded them: from a bag or from a live topic.

Source: the definitions in ros2/common_interfaces ``nav_msgs`` and ros-planning/navigation_msgs ``map_msgs``.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from groundplan._errors import MapError
from groundplan.maps._map import MapWarning
from groundplan.maps._source import Described, Occupancies, Origin
from groundplan.maps.map_server import check_origin, check_resolution

GRID, UPDATE = "nav_msgs/msg/OccupancyGrid", "map_msgs/msg/OccupancyGridUpdate"
#: Updates of a grid come on a topic beside it.
UPDATES = "_updates"

#: Tilt of the map's plane, radians, from which it is told, and from which it is refused.
TOLD_TILT, GREATEST_TILT = 1e-4, 0.01


class Grid:
    """An OccupancyGrid, and the updates that came after it.

    Parameters
    ----------
    message
        Anything with the fields of nav_msgs/OccupancyGrid.
    where : str
        The file or the topic, for what is said.
    """

    def __init__(self, message: Any, where: str) -> None:
        self._where, self._info = where, message.info
        height, width = int(message.info.height), int(message.info.width)
        if height < 1 or width < 1:
            raise MapError("map.pixels", f"{where}: the map has {width} x {height} pixels")
        self._data = as_bytes(message.data)
        if self._data.size != height * width:
            said = f"{width} x {height} pixels are promised, and {self._data.size} values follow"
            raise MapError("map.truncated", f"{where}: the map is truncated: {said}")
        self._data = self._data.reshape(height, width)
        self._left_out = 0

    def update(self, message: Any) -> None:
        """Put in the part of the map that an OccupancyGridUpdate brings; one that does not fit is left out."""
        x, y, width, height = (int(getattr(message, name)) for name in ("x", "y", "width", "height"))
        data = as_bytes(message.data)
        rows, columns = self._data.shape
        if x < 0 or y < 0 or x + width > columns or y + height > rows or data.size != width * height:
            self._left_out += 1
            return
        if not self._data.flags.writeable:
            self._data = self._data.copy()
        self._data[y : y + height, x : x + width] = data.reshape(height, width)

    def described(self, name: str, *, posed: bool = True) -> Described:
        """The map; `posed`: whether its own origin is wanted.

        Raises
        ------
        MapError
            ``map.resolution``, ``map.origin``.
        """
        warnings: list[MapWarning] = []
        if self._left_out:
            said = f"{self._left_out} updates of the map do not fit it and were left out"
            warnings.append(MapWarning("update-left-out", said))
        origin = None
        if posed:
            origin, odd = pose(self._info.origin, self._where)
            warnings += odd
        resolution = check_resolution(shortest(self._info.resolution), self._where)
        return Described(
            Path(name), resolution, origin, warnings=tuple(warnings), content=Occupancies(self._data[::-1])
        )


def as_bytes(data: Any) -> npt.NDArray[np.uint8]:
    """An int8[] as bytes, be it an array or a list."""
    return np.asarray(data, np.int8).view(np.uint8)


def shortest(value: float) -> float:
    """The shortest decimal that is this float32: the message says 0.05 in fewer bits than a YAML does."""
    return float(str(np.float32(value)))


def pose(of: Any, where: str) -> tuple[Origin, list[MapWarning]]:
    """Position and yaw of a geometry_msgs/Pose.

    Raises
    ------
    MapError
        ``map.origin`` when it is no pose, or tilts the map.
    """
    x, y, z, w = (float(getattr(of.orientation, name)) for name in "xyzw")
    at = float(of.position.x), float(of.position.y)
    length = math.sqrt(x * x + y * y + z * z + w * w)
    hint = "--origin X Y YAW sets the pose of the lower left corner; in Python origin=(x, y, yaw)"
    if not math.isfinite(length):
        raise MapError(
            "map.origin", f"{where}: the origin's orientation {x:g}, {y:g}, {z:g}, {w:g} is no rotation", hint
        )
    warnings = []
    if length == 0.0:
        warnings.append(MapWarning("orientation-unset", "the origin's orientation is all zeros: read as not turned"))
        w = length = 1.0
    x, y, z, w = (part / length for part in (x, y, z, w))
    tilt = 2.0 * math.asin(min(1.0, math.hypot(x, y)))
    if tilt > GREATEST_TILT:
        said = (
            f"{where}: the origin's orientation tilts the map by {math.degrees(tilt):.2f} degrees: it is no floor plan"
        )
        raise MapError("map.origin", said, hint)
    if tilt > TOLD_TILT:
        said = f"the origin's orientation tilts the map by {math.degrees(tilt):.3f} degrees: read as level"
        warnings.append(MapWarning("tilted", said))
    # A quaternion has the yaw but for its last digits; rounded, 0.3 is 0.3 again.
    yaw = round(math.remainder(2.0 * math.atan2(z, w), 2.0 * math.pi), 12)
    origin, odd = check_origin((*at, yaw + 0.0), where)
    return origin, warnings + odd
