"""Masks for Nav2's costmap filters: shapes with a value each, in raw mode, where a byte is the value itself."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from groundplan._polygons import fill
from groundplan.export import _grids
from groundplan.export._grids import BAND_ROWS, Bytes, Frame

if TYPE_CHECKING:
    from groundplan.export._places import Place
    from groundplan.survey import Survey

#: A shapely polygon in metres of the map frame, and the value of the pixels whose centres lie in it.
Painted = tuple[Any, int]

PARAMETERS = """\
{name}_filter_mask_server:
  ros__parameters:
    yaml_filename: {yaml}
    topic_name: "{name}_filter_mask"
    frame_id: "map"
{name}_costmap_filter_info_server:
  ros__parameters:
    type: {type}
    filter_info_topic: "{name}_costmap_filter_info"
    mask_topic: "{name}_filter_mask"
    base: 0.0
    multiplier: {multiplier}
"""


def write(
    survey: Survey, path: Path, painted: Sequence[Painted], name: str, type: int, multiplier: float = 1.0
) -> list[Path]:
    """Write the mask, 0 where nothing is painted, and the parameters of the servers that hand it to the costmap.

    What is painted later lies above. `type` is CostmapFilterInfo's: 0 keep-out, 1 percent of the speed, 2 m/s; Nav2
    multiplies a pixel's value by `multiplier`.
    """
    yaml, _ = _grids.names(path)
    said = PARAMETERS.format(name=name, yaml=_grids.quoted(yaml.name), type=type, multiplier=multiplier)
    frame = _grids.covering(survey.map)
    return _grids.write(path, frame, bands(frame, painted), "raw", {yaml.with_suffix(".params.yaml"): said})


def bands(frame: Frame, painted: Sequence[Painted]) -> Iterator[Bytes]:
    """The mask's rows from the top, some at a time: it is never whole in memory."""
    parts = [(frame.rings(part), value) for shape, value in painted for part in polygons(shape)]
    boxes = [(rings[0].min(axis=0), rings[0].max(axis=0)) for rings, _ in parts]
    for top in range(0, frame.height, BAND_ROWS):
        band = np.zeros((min(BAND_ROWS, frame.height - top), frame.width), np.uint8)
        for (rings, value), (low, high) in zip(parts, boxes, strict=True):
            left, right = max(int(low[0]), 0), min(int(high[0]) + 1, frame.width)
            first, last = max(int(low[1]) - top, 0), min(int(high[1]) + 1 - top, len(band))
            if left < right and first < last:
                window = band[first:last, left:right]
                window[_filled([ring - (left, top + first) for ring in rings], window.shape)] = value
        yield band


def _filled(rings: list[npt.NDArray[np.float64]], shape: tuple[int, ...]) -> npt.NDArray[np.bool_]:
    """As `fill`, which goes row by row: of a wall that runs upwards there are fewer columns."""
    height, width = shape
    if height <= width:
        return fill(rings, (height, width))
    return fill([ring[:, ::-1] for ring in rings], (width, height)).T


def polygons(shape: Any) -> list[Any]:
    """The polygons that a shape is made of."""
    import shapely

    parts = shapely.get_parts(shape)
    return [part for part in parts if part.geom_type == "Polygon" and part.area > 0]


def area(place: Place) -> Any:
    """The area of a place; a door's or pillar's is a disc as wide as it is; None where nothing says how large it is."""
    import shapely

    if place.shape is not None:
        return place.shape
    return shapely.Point(place.centre).buffer(place.width / 2) if place.width else None
