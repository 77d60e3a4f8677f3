"""A survey after its map has changed: gradients around the change are found anew, all others are kept.

A pixel bears on the gradients around it as far as their window reaches: 8 to 33 pixels. What is found there takes the
place of what was there, so the gradients are those of the whole map as it is now, and with them every stage that
follows. What labels are found from is known again by keys (the core's `labels/recall.rs`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from groundplan import _core
from groundplan._errors import ParameterError
from groundplan._results import record
from groundplan.maps import Map, MapWarning
from groundplan.maps._canvas import Canvas
from groundplan.maps._read import masked
from groundplan.maps._source import Bytes, Span, bands
from groundplan.maps._warnings import MISSING
from groundplan.parameters import named
from groundplan.stages import cores, layout

if TYPE_CHECKING:
    from groundplan.survey import Survey

#: Rows of a map that are compared at a time.
ROWS = 64

#: Rows and columns from the map's lower left: from, to.
Area = tuple[Span, Span]


def update(survey: Survey, change: Any, row: int | None, column: int | None, threads: int | None) -> Survey:
    """As `Survey.update`."""
    from groundplan._pipeline import surveyed

    known = survey.__dict__
    old: Map | None = known.get("_map")
    if old is None:
        hint = "survey the map, and update what groundplan.survey returns"
        raise ParameterError("update.map", "this survey has no map: it was read from a file or copied", hint)
    parameters, own = survey.parameters, known["_own"]
    if isinstance(change, Map):
        if row is not None or column is not None:
            raise ParameterError("update.patch", "a whole map has no row and no column")
        new, alike = change, comparable(old, change)
        areas = list(differing(old.pixels, new.pixels)) if alike else []
        if alike and not areas and (old.image, old.warnings) == (new.image, new.warnings):
            return survey
    else:
        pixels, area = fitted(old, change, row, column)
        if not changes(old, pixels, area):
            return survey
        new, alike, areas = patched(old, pixels, area), True, [area]
    gradients, values = known.get("_gradients"), named(parameters)
    reach = _core.reach(new.resolution, values)
    areas = [wider(area, reach, new) for area in areas]
    looked_at = sum((top - low) * (right - left) for (low, top), (left, right) in areas)
    if not alike or gradients is None or 2 * looked_at > new.pixels.size:
        return surveyed(new, parameters, threads, own, {}, keep=True)
    before, grid, count = gradients, layout(new), cores(threads)
    for area in areas:
        fresh = _core.find_gradients_in(grid, (new.height, 0), *area, values, count)
        gradients = replaced(gradients, fresh, area)
    parts = {"gradients": gradients, "memory": known["_memory"]}
    if all(np.array_equal(before[name], gradients[name]) for name in before):
        # Nothing that is occupied has changed: the lines stay, be they on other ground.
        parts |= {"directions": record(survey.directions), "lines": record(survey.lines)}
    return surveyed(new, parameters, threads, own, parts, keep=True)


def comparable(old: Map, new: Map) -> bool:
    """Whether two maps have the same frame, and the same meaning of a pixel's value."""
    frames = old.pixels.shape == new.pixels.shape and old.resolution == new.resolution and old.origin == new.origin
    return frames and bool((old.values == new.values).all() and (old.states == new.states).all())


def differing(old: Bytes, new: Bytes) -> Iterator[Area]:
    """Where two maps differ: areas that no row is shared between."""
    height = len(old)
    found: Area | None = None
    for low in range(0, height, ROWS):
        top = min(low + ROWS, height)
        # Rows are counted from the lowest, arrays have it last.
        lies = slice(height - top, height - low)
        columns = np.flatnonzero((old[lies] != new[lies]).any(axis=0))
        if columns.size:
            across = int(columns[0]), int(columns[-1]) + 1
            if found is not None and found[0][1] == low:
                found = (found[0][0], top), (min(found[1][0], across[0]), max(found[1][1], across[1]))
            else:
                found = (low, top), across
        elif found is not None:
            yield found
            found = None
    if found is not None:
        yield found


def changes(old: Map, patch: Bytes, area: Area) -> bool:
    """Whether anything is different there."""
    (low, top), across = area
    return not np.array_equal(old.pixels[old.height - top : old.height - low, slice(*across)], patch)


def fitted(map: Map, patch: Any, row: int | None, column: int | None) -> tuple[Bytes, Area]:
    """The patch as values of the map's pixels, its top row first, and where in the map it lies.

    Raises
    ------
    ParameterError
        ``update.patch``.
    """
    if masked(patch):
        said = f"{masked(patch)} pixels of the patch are masked, and what they are is not said"
        raise ParameterError("update.patch", said, "fill them first, with .filled(value)")
    try:
        patch = np.asarray(patch)
    except ValueError as reason:
        raise ParameterError("update.patch", f"that is no patch: {reason}", "its rows are all as long") from None
    pixels = as_pixels(map, patch)
    whole = all(isinstance(n, int | np.integer) and not isinstance(n, bool) for n in (row, column))
    if row is None or column is None or not whole:
        said = f"row {row!r} and column {column!r} are not two whole numbers"
        raise ParameterError("update.patch", said, "update(patch, row, column), or update(map) of all of it")
    (height, width), (rows, columns) = map.pixels.shape, pixels.shape
    if row < 0 or column < 0 or row + rows > height or column + columns > width:
        said = f"a patch of {rows} rows and {columns} columns from row {row} and column {column} on"
        raise ParameterError("update.patch", f"{said} does not lie in a map of {height} rows and {width} columns")
    upwards = patch.dtype == np.int8
    low, left = int(row if upwards else height - row - rows), int(column)
    return pixels, ((low, low + rows), (left, left + columns))


def patched(map: Map, patch: Bytes, area: Area) -> Map:
    """The map with the patch in it."""
    (height, width), ((low, high), across) = map.pixels.shape, area
    top, end = height - high, height - low
    with Canvas(Path(map.image), height, width) as canvas:
        for part in bands(height, width):
            own = map.pixels[part]
            first, last = max(top, part.start), min(end, part.stop)
            if first < last:
                own = own.copy()
                own[first - part.start : last - part.start, slice(*across)] = patch[first - top : last - top]
            canvas.put(part.start, own)
        return replace(map, pixels=canvas.pixels(), warnings=still_true(map, patch))


def still_true(map: Map, patch: Bytes) -> tuple[MapWarning, ...]:
    """A map's warnings but for those that a state is missing which a patch brings."""
    brought = set(np.unique(map.states[patch]).tolist())
    return tuple(warning for warning in map.warnings if MISSING.get(warning.code) not in brought)


def as_pixels(map: Map, patch: npt.NDArray[Any]) -> Bytes:
    """A patch as values of the map's pixels, its top row first."""
    if patch.ndim != 2 or patch.size == 0 or patch.dtype not in (np.uint8, np.int8, np.bool_):
        said = f"an array of {patch.dtype} and shape {patch.shape} is no patch"
        raise ParameterError("update.patch", said, "it takes rows x columns of uint8, int8 or bool")
    if patch.dtype == np.uint8:
        return patch
    means = patch[::-1] if patch.dtype == np.int8 else np.where(patch, np.int8(100), np.int8(0))
    means = np.where((means < 0) | (means > 100), np.int8(-1), means)
    pixel_of = np.zeros(256, np.uint8)
    for value in np.unique(means).tolist():
        # The value that is written so, where it means that, else the first that does.
        meaning = np.flatnonzero(map.values == value)
        if not meaning.size:
            said = f"no pixel of the map can mean {value}"
            raise ParameterError("update.patch", said, "a patch of uint8 has values of the map's own pixels")
        pixel_of[value & 255] = value & 255 if value & 255 in meaning else meaning[0]
    chosen: Bytes = pixel_of[means.view(np.uint8)]
    return chosen


def wider(area: Area, reach: int, map: Map) -> Area:
    """An area and all that a pixel of it bears on."""
    (low, top), (left, right) = area
    return (max(low - reach, 0), min(top + reach, map.height)), (max(left - reach, 0), min(right + reach, map.width))


def replaced(gradients: dict[str, Any], fresh: dict[str, Any], area: Area) -> dict[str, Any]:
    """The gradients with fresh ones of an area."""
    (low, top), (left, right) = area
    x, y = gradients["pixels"].T
    first, last = np.searchsorted(y, low), np.searchsorted(y, top)
    beside = first + np.flatnonzero((x[first:last] < left) | (x[first:last] >= right))
    columns, rows = np.concatenate([gradients["pixels"][beside], fresh["pixels"]]).T
    # Of both they are in order, which a stable sort makes use of.
    order = np.argsort(rows.astype(np.uint64) << 32 | columns, kind="stable")

    def spliced(name: str) -> npt.NDArray[Any]:
        old = gradients[name]
        return np.concatenate([old[:first], np.concatenate([old[beside], fresh[name]])[order], old[last:]])

    return {name: spliced(name) for name in gradients}
