"""A map in, its Survey out: what is given is checked, the core makes all stages in a row."""

from __future__ import annotations

import os
from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

from groundplan import _core
from groundplan._errors import MapError, shown
from groundplan._memory import give_back
from groundplan._results import (
    Adjacency,
    Directions,
    Lines,
    MapInfo,
    Occupancy,
    Radiogram,
    Subdivision,
    Walls,
    record,
)
from groundplan._tree import LABELS, Table, strange_reading
from groundplan.maps import Map, MapWarning, from_array, read
from groundplan.parameters import named, resolve
from groundplan.stages import cores, layout, made, run, taken
from groundplan.survey import Survey

#: In place of what is made when it is asked for.
NOT_YET: Any = None


def survey(
    map: Map | npt.ArrayLike | os.PathLike[str],
    *,
    resolution: float | None = None,
    origin: Sequence[float] | None = None,
    directions: Directions | None = None,
    lines: Lines | None = None,
    threads: int | None = None,
    keep: bool = False,
    client: Any = None,
    reading: dict[str, Any] | None = None,
    **parameters: Any,
) -> Survey:
    """Survey a map: all stages in a row.

    Parameters
    ----------
    map
        A `Map`, or an array: uint8 as a picture of a map (0 occupied, 205 unknown, 254 free, top row first), int8 as
        the data of a nav_msgs/OccupancyGrid (-1, 0..100, lowest row first), bool as occupied or not (top row first). Or
        a map's file, as `groundplan.read` takes it.
    resolution, origin
        Of an array or a file: metres per pixel, and the pose of its lower left corner (m, m, rad).
    directions, lines
        Results of your own in place of these stages'. Lines without directions are of those that are found.
    threads
        At most so many; all cores by default. Any number gives the same survey.
    keep
        Keep for `Survey.update` the gradients, 13 bytes for each edge pixel, and what was found on the way to the
        labels; the first update finds them again if not.
    client
        A ``dask.distributed.Client``: its workers do what has to be done on pixels. Of a file that is an 8-bit PGM, a
        Zarr array or a GeoTIFF they read the rows that they need by themselves.
    reading
        Of a file's path: how to read it, by the names of `groundplan.read`.
    **parameters
        By the table's names, with an underscore for the dot: ``lines_snr=4``.

    Raises
    ------
    ParameterError
        A parameter that is not known or out of its range; ``stage.input`` for directions or lines that do not fit.
    MapError
        An array that is no map; what `groundplan.read` raises for a file.
    GroundplanError
        ``cluster.client``; ``cluster.path``, ``cluster.version``, ``cluster.failed`` for what goes wrong on workers.
    """
    _check_reading(map, resolution, origin, client, reading or {})
    stages = (("directions", Directions, directions), ("lines", Lines, lines))
    own = {name: taken(kind, name, value) for name, kind, value in stages if value is not None}
    if isinstance(map, str | os.PathLike):
        resolve(parameters)
        words = {"resolution": resolution, "origin": origin, **(reading or {})}
        if client is not None:
            from groundplan import _cluster

            site = _cluster.open_map(map, {name: word for name, word in words.items() if word is not None}, client)
            return _cluster.survey_site(site, client, parameters, threads, own, keep=keep)[0]
        map = read(map, **words)
    elif not isinstance(map, Map):
        if not _is_array(map):
            raise MapError("map.input", f"{shown(map)} is no map", "a Map, an array or a file's path is one")
        if resolution is None:
            raise MapError("map.resolution", "an array needs its resolution", "survey(array, resolution=0.05)")
        try:
            pixels = np.asanyarray(map)
        except ValueError as reason:
            raise MapError("map.input", f"that is no map: {reason}", "its rows are all as long") from None
        map = from_array(pixels, resolution, (0.0, 0.0, 0.0) if origin is None else origin)
    if client is not None:
        from groundplan import _cluster

        return _cluster.survey_site(_cluster.Site(map), client, parameters, threads, own, keep=keep)[0]
    return surveyed(map, parameters, threads, own, {}, keep=keep)


def _check_reading(map: object, resolution: object, origin: object, client: object, reading: dict[str, Any]) -> None:
    """Refuse what says nothing about such a map, rather than pass over it."""
    if isinstance(map, Map):
        given = {"resolution": resolution, "origin": origin, **reading}
        said = [name for name, value in given.items() if value is not None]
        if said:
            raise MapError("map.option", f"{said[0]} says nothing about a Map", "read it anew with that")
    elif reading and _is_array(map):
        raise MapError("map.option", "reading says nothing about an array", "groundplan.from_array takes these words")
    wrong = strange_reading(reading)
    if wrong:
        raise MapError("map.option", *wrong)


def surveyed(
    map: Map,
    parameters: dict[str, Any],
    threads: int | None,
    own: dict[str, Any],
    parts: dict[str, Any],
    *,
    keep: bool,
) -> Survey:
    """The survey of a map, over stages of the caller's own and over parts that are known, both as the core has them."""
    grid, values = layout(map), named(parameters)
    if "lines" in own and "directions" not in own | parts:
        edges = parts.get("gradients") or run(_core.find_gradients, grid, values, cores(threads))
        directions = run(_core.find_directions, grid, edges, values, cores(threads))
        parts = parts | {"gradients": edges, "directions": directions}
    if run(_core.is_large, grid):
        give_back()
    found = run(_core.survey, grid, values, cores(threads), own | parts, keep)
    stages = {
        "directions": Directions,
        "lines": Lines,
        "occupancy": Occupancy,
        "walls": Walls,
    }
    survey = Survey(
        map=MapInfo(map.image, map.width, map.height, map.resolution, map.origin),
        parameters=resolve(parameters),
        radiograms=[made(Radiogram, arrays) for arrays in found["radiograms"]],
        subdivision=NOT_YET,
        adjacency=NOT_YET,
        labels=NOT_YET,
        patterns=found["patterns"],
        warnings=[*map.warnings, *(MapWarning(code, message) for code, message in found["warnings"])],
        **{name: made(kind, found[name]) for name, kind in stages.items()},
    )
    # For its routes and its updates, and no part of what it is.
    kept = {"_gradients": found["gradients"] or parts["gradients"], "_memory": found["memory"]} if keep else {}
    survey.__dict__.update(_map=map, _own=own, **kept)
    labels: _core.Labels = found["labels"]
    some = Table(len(labels), lambda some: labels.some(*some.indices(len(labels))[:2]), LABELS)
    lines, walls, cut = survey.lines, survey.walls, found["subdivision"]
    angles = survey.directions

    @cache
    def divided() -> Subdivision:
        """Of a large map it is not kept: the lines make it again."""
        if cut is not None:
            return made(Subdivision, cut)
        return made(Subdivision, _core.subdivide(grid, record(angles), record(lines), cores(threads)))

    survey.__dict__["_some_labels"] = some
    survey.__dict__["_later"] = {
        "labels": lambda: some.some(slice(None)),
        "adjacency": lambda: made(Adjacency, _core.find_adjacency(record(divided()), record(walls))),
        "subdivision": divided,
    }
    for name in survey.__dict__["_later"]:
        del survey.__dict__[name]
    return survey


def _is_array(value: object) -> bool:
    """Whether NumPy takes it for an array, and not for a single thing."""
    return hasattr(value, "__array__") or (isinstance(value, Sequence) and not isinstance(value, str | bytes))
