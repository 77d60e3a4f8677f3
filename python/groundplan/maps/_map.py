"""The Map: pixels as they lie, and what each value of a pixel means."""

from __future__ import annotations

from dataclasses import dataclass, field, fields

import numpy as np
import numpy.typing as npt

#: The states a pixel value can have; the order is the binding's.
FREE, OCCUPIED, UNKNOWN = 0, 1, 2


@dataclass(frozen=True)
class MapWarning:
    """Partial trouble: a stable code and a sentence that names the value."""

    code: str
    message: str


@dataclass(frozen=True, eq=False, repr=False)
class Map:
    """An occupancy grid with its frame. Nothing is converted: a 256-entry table says what each value means.

    Two are equal when all of them is, pixel by pixel.

    Attributes
    ----------
    pixels : (height, width) uint8
        As they lie in the file; row 0 is the top row. May be a memory map or a view with negative row stride.
    values : (256,) int8
        What each pixel value means as nav_msgs/OccupancyGrid says it: 0..100 percent occupied, -1 unknown.
    states : (256,) uint8
        FREE, OCCUPIED or UNKNOWN for each pixel value.
    resolution : float
        Metres per pixel.
    origin : (float, float, float)
        Pose of the lower left corner of the lower left pixel in the map frame: metres, metres, radians.
    image : str
        Name of the image, for the survey; never a directory.
    warnings : tuple of MapWarning
        What was odd about the file and what was done about it.

    Raises
    ------
    MapError
        ``map.resolution`` and ``map.origin`` for what `groundplan.from_array` does not take either.
    """

    pixels: npt.NDArray[np.uint8]
    values: npt.NDArray[np.int8]
    states: npt.NDArray[np.uint8]
    resolution: float
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    image: str = ""
    warnings: tuple[MapWarning, ...] = field(default=())

    def __post_init__(self) -> None:
        """Hold the frame to what a file may say; what is made by hand comes through no other door."""
        from groundplan.maps.map_server import check_origin, check_resolution

        origin, odd = check_origin(self.origin)
        object.__setattr__(self, "resolution", check_resolution(self.resolution))
        object.__setattr__(self, "origin", origin)
        told = {warning.code for warning in self.warnings}
        object.__setattr__(self, "warnings", (*self.warnings, *(w for w in odd if w.code not in told)))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Map):
            return NotImplemented
        return all(np.array_equal(getattr(self, f.name), getattr(other, f.name)) for f in fields(self))

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"Map({self.image!r}, {self.width} x {self.height} pixels of {self.resolution:g} m)"

    @property
    def height(self) -> int:
        """Rows of pixels."""
        return int(self.pixels.shape[0])

    @property
    def width(self) -> int:
        """Columns of pixels."""
        return int(self.pixels.shape[1])
