"""The method's stages, each a pure function, and what each makes.

    find_gradients -> find_directions -> find_radiograms -> find_lines -> add_rack_faces -> subdivide
        -> find_occupancy -> find_walls -> find_adjacency -> find_labels

``groundplan.survey()`` is these in a row. A researcher replaces one of them and hands its
result to ``groundplan.survey(map, directions=..., lines=...)``; what comes after the subdivision is exchanged in the
survey itself: ``dataclasses.replace(survey, walls=..., labels=...)``. What does not fit a stage is a ParameterError,
``stage.input``. Lengths are metres, angles radians, points in the map
frame; an id that is none (the line of a border edge, the face outside) is `NONE`. Section numbers are those of
Gholami Shahbandi, Åstrand and Philippsen (ICARCV 2014).
"""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np

from groundplan import _core
from groundplan._errors import ParameterError
from groundplan._results import (
    Adjacency,
    Directions,
    Gradients,
    Lines,
    Occupancy,
    Radiogram,
    Response,
    Stage,
    Subdivision,
    Walls,
    record,
)
from groundplan.maps import Map
from groundplan.parameters import named

R = TypeVar("R")
T = TypeVar("T")
S = TypeVar("S", bound=Stage)


def made(kind: type[S], arrays: dict[str, Any]) -> S:
    """A stage's record from what the core gave."""
    return kind(**arrays)


#: What makes a stage's input of one's own.
_MADE_BY = {
    "Map": "groundplan.read(path) reads one, groundplan.from_array(pixels, resolution) takes an array",
    "Directions": "groundplan.Directions.of(angles) makes them of angles in radians",
    "Lines": "groundplan.Lines.of(directions, offsets) makes them of indices and metres",
}

_SINGULAR = {"vertices": "vertex", "histogram": "value of the histogram"}


def needs(kind: type[T], name: str, value: object) -> T:
    """A stage's input, held to its type.

    Raises
    ------
    ParameterError
        ``stage.input``.
    """
    if isinstance(value, kind):
        return value
    said = f"{name} has to be {a(kind.__name__)} and is {a(type(value).__name__)}"
    hint = _MADE_BY.get(kind.__name__)
    if kind is Directions and type(value) is int:
        hint = f"directions_count={value} takes so many; {hint}"
    raise ParameterError("stage.input", said, hint)


def a(noun: str) -> str:
    """A noun with its article; a plural goes without."""
    return noun if noun[0].isupper() and noun.endswith("s") else f"{'an' if noun[0] in 'aeiouAEIO' else 'a'} {noun}"


def taken(kind: type[Stage], name: str, value: object) -> dict[str, Any]:
    """A stage's input as the core takes it, finite and of its type; ``stage.input`` where it is not."""
    arrays = record(needs(kind, name, value))
    for part, numbers in arrays.items():
        if np.asarray(numbers).dtype.kind == "f" and not np.isfinite(numbers).all():
            raise ParameterError(
                "stage.input", f"{a(_SINGULAR.get(part, part.removesuffix('s')))} of the {name} is not finite"
            )
    return arrays


def run(stage: Callable[..., R], *inputs: Any) -> R:
    """Call the core; inputs that do not fit one another are told as ``stage.input``."""
    try:
        return stage(*inputs)
    except ParameterError:
        raise
    except (ValueError, OverflowError) as fault:
        raise ParameterError("stage.input", str(fault)) from fault
    except TypeError as fault:
        raise ParameterError("stage.input", f"an array is not of the type that its stage says: {fault}") from fault


def layout(map: Map) -> _core._Layout:
    """A map as the core takes it, without copying its pixels where their rows follow one another."""
    pixels = map.pixels
    bottom_up = pixels.ndim == 2 and pixels.strides[0] < 0
    rows = pixels[::-1] if bottom_up else pixels
    return np.ascontiguousarray(rows), bottom_up, map.values, map.states, map.resolution, map.origin


def cores(asked: Any = None) -> int:
    """Threads to use: those asked for, else the cores that this process may use.

    Raises
    ------
    ParameterError
        ``parameter.range`` for less than one.
    """
    if asked is not None:
        if isinstance(asked, bool) or not isinstance(asked, int | np.integer) or asked < 1:
            hint = "threads takes a whole number from 1 on"
            raise ParameterError("parameter.range", f"threads cannot be {asked!r}", hint)
        return int(asked)
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def find_gradients(map: Map, *, threads: int | None = None, **parameters: Any) -> Gradients:
    """II-A: oriented gradients of the edge pixels.

    Parameters
    ----------
    map
        The occupancy grid.
    threads
        At most so many; all cores by default. Any number gives the same gradients.
    **parameters
        By the table's names, with an underscore for the dot, here and in all stages. Those of other stages are
        checked and change nothing.

    Raises
    ------
    ParameterError
        A parameter that is not known or out of its range, threads included; ``stage.input`` for a map that is none.
    """
    grid = layout(needs(Map, "map", map))
    return made(Gradients, run(_core.find_gradients, grid, named(parameters), cores(threads)))


def find_directions(
    map: Map, gradients: Gradients | None = None, *, threads: int | None = None, **parameters: Any
) -> Directions:
    """II-A: the dominant directions.

    Their number and angles are found unless ``directions_count`` or ``directions_angles_deg`` are given.

    Parameters
    ----------
    map
        The occupancy grid.
    gradients
        Its oriented gradients; found anew where none are given, here and in all stages.
    threads
        At most so many; all cores by default. Any number gives the same directions.

    Raises
    ------
    ParameterError
        A parameter that is not known or out of its range; ``stage.input`` for what is no map, or gradients of another.
    """
    grid, edges = layout(needs(Map, "map", map)), _gradients(map, gradients, parameters, threads)
    return made(Directions, run(_core.find_directions, grid, edges, named(parameters), cores(threads)))


def find_radiograms(
    map: Map,
    directions: Directions,
    gradients: Gradients | None = None,
    *,
    threads: int | None = None,
    **parameters: Any,
) -> list[Radiogram]:
    """II-B: the radiogram of each direction.

    Parameters
    ----------
    map, gradients
        As `find_directions` takes them.
    directions
        Those found, or `Directions.of` angles in radians.
    threads
        At most so many; all cores by default. Any number gives the same radiograms.

    Returns
    -------
    list of Radiogram
        One for each direction, in their order: metres of structure over offsets in metres.

    Raises
    ------
    ParameterError
        A parameter that is not known or out of its range; ``stage.input`` for directions that do not fit.
    """
    grid, along = layout(needs(Map, "map", map)), taken(Directions, "directions", directions)
    edges = _gradients(map, gradients, parameters, threads)
    found = run(_core.find_radiograms, grid, edges, along, named(parameters), cores(threads))
    return [made(Radiogram, arrays) for arrays in found]


def find_response(radiogram: Radiogram, **parameters: Any) -> Response:
    """II-B: the wavelet response that a radiogram's peaks are read from (Du, Kibbe and Lin 2006).

    Parameters
    ----------
    radiogram
        Of one direction.

    Raises
    ------
    ParameterError
        A parameter that is not known or out of its range; ``stage.input`` for what is no radiogram.
    """
    given = taken(Radiogram, "radiogram", radiogram)
    return made(Response, run(_core.find_response, given, named(parameters)))


def find_lines(radiograms: list[Radiogram], **parameters: Any) -> Lines:
    """II-B: the radiograms' peaks as lines.

    Parameters
    ----------
    radiograms
        One for each direction, in their order: a line's direction is the position of its radiogram here.

    Returns
    -------
    Lines
        Offsets, amplitudes and widths in metres.

    Raises
    ------
    ParameterError
        A parameter that is not known or out of its range; ``stage.input`` for what are no radiograms.
    """
    if not isinstance(radiograms, list | tuple):
        raise ParameterError("stage.input", f"radiograms has to be a list and is {a(type(radiograms).__name__)}")
    given = [taken(Radiogram, f"radiograms[{k}]", radiogram) for k, radiogram in enumerate(radiograms)]
    return made(Lines, run(_core.find_lines, given, named(parameters)))


def add_rack_faces(
    map: Map,
    directions: Directions,
    lines: Lines,
    gradients: Gradients | None = None,
    *,
    threads: int | None = None,
    **parameters: Any,
) -> Lines:
    """II-B: the lines, and those along the faces of racks on legs, of which a radiogram has no peak.

    A lidar that looks under the lowest beams sees no more of a rack than its legs. A line is added where those stand
    as racks' do and none that is given follows them; with ``lines_min_amplitude``, or a ``lines_detail`` that lets
    nothing through below 2 m, where as much structure is seen, and none with ``labels_method="paper"``.

    Parameters
    ----------
    map, directions, gradients
        As `find_radiograms` takes them.
    lines
        Those found, or `Lines.of` offsets in metres.
    threads
        At most so many; all cores by default. Any number gives the same lines.

    Returns
    -------
    Lines
        Those given and those added, ascending within a direction; the amplitude of one that is added is what is seen of
        the legs along it, metres.

    Raises
    ------
    ParameterError
        A parameter that is not known or out of its range; ``stage.input`` for stages that do not fit one another.
    """
    grid = layout(needs(Map, "map", map))
    cut = taken(Directions, "directions", directions), taken(Lines, "lines", lines)
    edges = _gradients(map, gradients, parameters, threads)
    return made(Lines, run(_core.add_rack_faces, grid, edges, *cut, named(parameters), cores(threads)))


def subdivide(map: Map, directions: Directions, lines: Lines, *, threads: int | None = None) -> Subdivision:
    """II-C: vertices, edges and faces of all lines taken across the map.

    Parameters
    ----------
    map
        The occupancy grid, of which the frame alone counts.
    directions, lines
        Those found, or `Directions.of` angles in radians and `Lines.of` offsets in metres.
    threads
        At most so many; all cores by default. Any number gives the same subdivision.

    Returns
    -------
    Subdivision
        In metres, in the map frame. Without lines it is one face, the map.

    Raises
    ------
    ParameterError
        ``stage.input`` for lines that are of no such direction, or values that are not finite.
    """
    grid = layout(needs(Map, "map", map))
    given = taken(Directions, "directions", directions), taken(Lines, "lines", lines)
    return made(Subdivision, run(_core.subdivide, grid, *given, cores(threads)))


def find_occupancy(
    map: Map,
    directions: Directions,
    lines: Lines,
    gradients: Gradients | None = None,
    *,
    threads: int | None = None,
    **parameters: Any,
) -> Occupancy:
    """II-D: O(face) and O(edge) of the subdivision that the lines make, shares from 0 to 1.

    Parameters
    ----------
    map, directions, lines
        As `subdivide` takes them; the faces and edges are those that it makes of them.
    gradients
        As `find_directions` takes them.
    threads
        At most so many; all cores by default. Any number gives the same occupancy.

    Raises
    ------
    ParameterError
        A parameter that is not known or out of its range; ``stage.input`` for lines that do not fit.
    """
    grid = layout(needs(Map, "map", map))
    given = taken(Directions, "directions", directions), taken(Lines, "lines", lines)
    edges = _gradients(map, gradients, parameters, threads)
    return made(Occupancy, run(_core.find_occupancy, grid, edges, *given, named(parameters), cores(threads)))


def find_walls(subdivision: Subdivision, occupancy: Occupancy, **parameters: Any) -> Walls:
    """II-D: C(edge) = disparity > t1 or O(edge) > t2, and the walls: the abstraction of Fig. 6.

    Parameters
    ----------
    subdivision, occupancy
        Of the same lines.

    Returns
    -------
    Walls
        ``walls_disparity`` is t1, ``walls_occupancy`` is t2; points in metres, in the map frame.

    Raises
    ------
    ParameterError
        A parameter that is not known or out of its range; ``stage.input`` for an occupancy of another subdivision.
    """
    given = taken(Subdivision, "subdivision", subdivision), taken(Occupancy, "occupancy", occupancy)
    return made(Walls, run(_core.find_walls, *given, named(parameters)))


def find_adjacency(subdivision: Subdivision, walls: Walls) -> Adjacency:
    """II-D, II-E: a node for each face, a link for each edge between two faces.

    Parameters
    ----------
    subdivision, walls
        Of the same lines. A link is connected where its edge is not cogent.

    Raises
    ------
    ParameterError
        ``stage.input`` for walls of another subdivision.
    """
    given = taken(Subdivision, "subdivision", subdivision), taken(Walls, "walls", walls)
    return made(Adjacency, run(_core.find_adjacency, *given))


def find_labels(
    map: Map,
    directions: Directions,
    lines: Lines,
    occupancy: Occupancy,
    walls: Walls,
    gradients: Gradients | None = None,
    *,
    threads: int | None = None,
    **parameters: Any,
) -> list[dict[str, Any]]:
    """II-E: what is what, as the survey's JSON has it: corridors, junctions, racks, regions, doors, pillars.

    Parameters
    ----------
    map, directions, lines, gradients
        As `find_occupancy` takes them.
    occupancy, walls
        Of the subdivision that those lines make.
    threads
        At most so many; all cores by default. Any number gives the same labels.

    Returns
    -------
    list of dict
        ``kind``, and the keys that docs/survey.md gives that kind: metres, square metres, radians, ids of faces, and
        ids of labels, which are positions in this list.

    Raises
    ------
    ParameterError
        A parameter that is not known or out of its range; ``stage.input`` for stages that do not fit one another.
    """
    grid = layout(needs(Map, "map", map))
    cut = taken(Directions, "directions", directions), taken(Lines, "lines", lines)
    measured = taken(Occupancy, "occupancy", occupancy), taken(Walls, "walls", walls)
    edges = _gradients(map, gradients, parameters, threads)
    found: list[dict[str, Any]] = run(
        _core.find_labels, grid, edges, *cut, *measured, named(parameters), cores(threads)
    )
    return found


def _gradients(
    map: Map, given: Gradients | None, parameters: dict[str, Any], threads: int | None = None
) -> dict[str, Any]:
    """The gradients that were given, or those of the map."""
    found = find_gradients(map, threads=threads, **parameters) if given is None else given
    return taken(Gradients, "gradients", found)
